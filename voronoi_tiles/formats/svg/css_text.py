"""Pieces of CSS values: functions, their arguments, and lists, split where CSS would split them."""

from __future__ import annotations

import re
from typing import Final

import tinycss2
from tinycss2.ast import Node as Token

from voronoi_tiles.formats.shapes import DrawingError

NESTING_MAX: Final = 64
"""Deepest nesting of brackets in a style; a count. What reads CSS calls itself once a level."""

_FUNCTION: Final = re.compile(r"(-?-?[a-z][a-z0-9-]*)\(.*\)", re.DOTALL | re.IGNORECASE)
_BRACKET: Final = re.compile(r"[()\[\]{}]")


def function_of(text: str) -> str:
    """The name of the function that a value is, in small letters, or ""."""
    match = _FUNCTION.fullmatch(text.strip())
    return match[1].lower() if match else ""


def arguments_of(text: str) -> list[str]:
    """The arguments of a function, between its commas, without spaces around them."""
    tokens = components(text)
    if len(tokens) != 1 or tokens[0].type != "function":
        return []
    return [tinycss2.serialize(part).strip() for part in split(tokens[0].arguments, ",")]


def components(text: str) -> list[Token]:
    """The tokens of a value, without comments and spaces at the outermost level.

    Raises DrawingError where brackets are nested more than NESTING_MAX deep.
    """
    check_nesting(text)
    return [
        token for token in tinycss2.parse_component_value_list(text, skip_comments=True) if token.type != "whitespace"
    ]


def words(text: str) -> list[str]:
    """The parts of a value that spaces or commas separate, functions being whole."""
    if "(" not in text and "/*" not in text:
        return text.replace(",", " ").split()
    return [tinycss2.serialize([part]) for part in components(text) if part != ","]


def split(tokens: list[Token], sign: str) -> list[list[Token]]:
    """The parts between the signs; one, empty or not, where there is no sign."""
    parts: list[list[Token]] = [[]]
    for token in tokens:
        if token == sign:
            parts.append([])
        else:
            parts[-1].append(token)
    return parts


def check_nesting(text: str) -> None:
    """Raise DrawingError where brackets are nested more than NESTING_MAX deep."""
    depth = 0
    for match in _BRACKET.finditer(text):
        depth += 1 if match[0] in "([{" else -min(depth, 1)
        if depth > NESTING_MAX:
            raise DrawingError(
                f"brackets nested more than {NESTING_MAX} deep in its styles", remedy="Save it as plain SVG."
            )
