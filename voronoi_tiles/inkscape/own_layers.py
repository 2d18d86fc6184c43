"""Layers of ours in a drawing: written into it, and replaced by the next run. Every other byte stays as it is."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from html import escape
from typing import Final, Literal, NamedTuple
from xml.parsers import expat

from voronoi_tiles.base.maps import Affine
from voronoi_tiles.base.text import xml_text
from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.formats.svg.path_text import decimal_text
from voronoi_tiles.formats.svg.writer import INKSCAPE_NAMESPACE, RECIPE_NAMESPACE

Role = Literal["tiles", "sheet", "cell"]

ROLE: Final = f"{RECIPE_NAMESPACE} role"
"""The attribute by which layers of ours are known, as the reader of XML has it."""

_SVG: Final = "http://www.w3.org/2000/svg"


class OwnGroup(NamedTuple):
    """A group within a layer: its label, its style, and for each path its data (in the page's user units) and label."""

    label: str
    style: str
    paths: Iterable[tuple[bytes, str]]


def layer_text(
    role: Role | None,
    label: str,
    name: str,
    groups: Iterable[OwnGroup] = (),
    *,
    recipe: Mapping[str, str] | None = None,
    notes: Sequence[str] = (),
    more: str = "",
) -> bytes:
    """A layer as XML that means the same wherever it is put, in ASCII. `name` begins its ids.

    `recipe` goes into its metadata, `notes`, sentences, into its description, and `more` is XML already.
    """
    parts = [
        f'<g xmlns="{_SVG}" xmlns:inkscape="{INKSCAPE_NAMESPACE}" xmlns:vt="{RECIPE_NAMESPACE}" id="{name}" '
        f'inkscape:groupmode="layer" inkscape:label={_quoted(label)}'
        + (f' vt:role="{role}">' if role is not None else ">")
    ]
    if notes:
        parts.append(f"<desc>{_escaped('. '.join(notes))}.</desc>")
    if recipe is not None:
        parts.append(f"<metadata>{recipe_text(recipe)}</metadata>")
    for number, group in enumerate(groups):
        parts.append(f'<g id="{name}-{number}" inkscape:label={_quoted(group.label)} style={_quoted(group.style)}>')
        for count, (data, text) in enumerate(group.paths):
            called = f" inkscape:label={_quoted(text)}" if text else ""
            parts.append(f'<path id="{name}-{number}-{count}"{called} d="{data.decode()}"/>')
        parts.append("</g>")
    parts.append(f"{more}</g>")
    return "\n".join(parts).encode("ascii", "xmlcharrefreplace")


def free_id(wanted: str, names: Collection[str]) -> str:
    """An id that none of some names begins with: as it is wanted, or with a number."""
    name, number = wanted, 1
    while any(known.startswith(name) for known in names):
        number += 1
        name = f"{wanted}-{number}"
    return name


def drawn_style(colour: str, line: float, to_page: Affine) -> str:
    """The style of lines of some millimetres, in user units that `to_page` maps to the page."""
    return f"fill:none;stroke:{colour};stroke-width:{decimal_text(float(f'{line / to_page.scale:.9g}'))}"


def _escaped(text: str) -> str:
    """A text as the content of an element of XML, or of an attribute."""
    return escape(xml_text(text))


def _quoted(text: str) -> str:
    """A text as the value of an attribute of XML, in double quotes: by these recipes are found."""
    return f'"{_escaped(text)}"'.replace("\n", "&#10;")


def recipe_text(recipe: Mapping[str, str]) -> str:
    """A recipe as the element of XML that files of ours have: the design, and the rest as its attributes."""
    said = "".join(f" {name}={_quoted(text)}" for name, text in recipe.items() if name != "design")
    return f"<vt:recipe{said}>{_escaped(recipe['design'])}</vt:recipe>"


def with_layers(data: bytes, role: Role, layers: bytes, names: Collection[str] | None = None) -> bytes:
    """A drawing with layers in the place of the one that has this role, or above all others.

    With `names` only those of these ids are replaced. Raises DrawingError for a drawing without any element, and for
    one whose bytes are not as in UTF-8.
    """
    places = _Places(data, role, names)
    new = bytearray(data)
    at = places.end
    for first, last, is_layer in reversed(places.found):
        del new[first:last]
        # Within a group it could lie anywhere.
        at = first if is_layer else at - (last - first)
    new[at:at] = layers
    return bytes(new)


class _Places:
    """Where layers of a role begin and end in a file, and where its outermost element's end tag begins; bytes.

    `found` also says whether a layer stands in the outermost element itself; one within another is not in it.
    """

    def __init__(self, data: bytes, role: Role, names: Collection[str] | None) -> None:
        self.found: list[tuple[int, int, bool]] = []
        self.end = -1
        self._data = data
        self._role = role
        self._names = names
        self._open: list[tuple[int, bool]] = []
        self._fresh = False
        self._parser = expat.ParserCreate(namespace_separator=" ")
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._finish
        self._parser.DefaultHandler = self._other
        with suppress(expat.ExpatError):  # what is read as a drawing and is no XML is compressed
            self._parser.Parse(data, True)
        if self.end < 0 or not data.startswith(b"</", self.end):
            raise DrawingError(
                "the drawing is empty, compressed, or in another encoding than UTF-8",
                remedy="Draw something, and save it as plain SVG.",
            )

    def _start(self, _tag: str, attributes: dict[str, str]) -> None:
        inside = bool(self._open) and self._open[-1][1]
        is_named = self._names is None or attributes.get("id") in self._names
        own = inside or (is_named and attributes.get(ROLE) == self._role)
        if own and not inside:
            self.found.append((self._parser.CurrentByteIndex, -1, len(self._open) == 1))
        self._open.append((self._parser.CurrentByteIndex, own))
        self._fresh = True

    def _other(self, _text: str) -> None:
        self._fresh = False

    def _finish(self, _tag: str) -> None:
        at = self._parser.CurrentByteIndex
        first, _ = self._open.pop()
        # Of an element without an end tag expat gives the place behind it.
        empty = self._fresh and self._data[at - 2 : at] == b"/>"
        self._fresh = False
        if not self._open and not empty:
            self.end = at
        if self.found and self.found[-1][:2] == (first, -1):
            last = at if empty else self._data.index(b">", at) + 1
            self.found[-1] = (first, last, self.found[-1][2])
