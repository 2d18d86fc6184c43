"""Conditional processing: what a file draws for readers who know a language or an extension.

The reader's language is English, whatever the machine's is: a file is read alike everywhere.
"""

from __future__ import annotations

from typing import Final

from voronoi_tiles.formats.svg.elements import is_svg
from voronoi_tiles.formats.svg.xml_tree import Node

LANGUAGE: Final = "en"

# What browsers know, though nothing of it is drawn here: a file's author counts on it.
_EXTENSIONS: Final = frozenset({"http://www.w3.org/1999/xhtml", "http://www.w3.org/1998/Math/MathML"})


def applies(node: Node) -> bool:
    """Whether an element is for a reader of English who knows what browsers know.

    SVG 2 has given up requiredFeatures.
    """
    languages = node.attributes.get("systemLanguage")
    if languages is not None:
        tags = [tag.strip().lower() for tag in languages.split(",")]
        if not any(tag.partition("-")[0] == LANGUAGE for tag in tags):
            return False
    extensions = node.attributes.get("requiredExtensions")
    return extensions is None or (bool(extensions.split()) and _EXTENSIONS.issuperset(extensions.split()))


def first_that_applies(node: Node) -> list[Node]:
    """The child that a switch draws, if any: the first element of SVG that applies."""
    return next(([child] for child in node.children if is_svg(child) and applies(child)), [])
