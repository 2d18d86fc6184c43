"""XML as a tree of small nodes, read by expat with everything refused that reaches outside or grows inside.

Entities that a file declares are refused whatever they hold: no bomb, no file. Nesting and the number of elements are
limited, and nothing here recurses.
"""

from __future__ import annotations

import zlib
from typing import Final, Never
from xml.parsers import expat

from voronoi_tiles.formats.shapes import BYTES_MAX, DEPTH_MAX, ELEMENTS_MAX, DrawingError

_GZIP: Final = b"\x1f\x8b"
# Older expats read a token again with every chunk that it spans, so chunks are few.
_CHUNK: Final = 2**24


class Node:
    """An element: `tag` and `attributes` are "namespace name", or the bare name where there is no namespace."""

    __slots__ = ("attributes", "children", "line", "tag", "text")

    def __init__(self, tag: str, attributes: dict[str, str], line: int) -> None:
        self.tag = tag
        self.attributes = attributes
        self.line = line
        self.children: list[Node] = []
        self.text = ""


def parse_tree(data: bytes, file: str, keeps_text: frozenset[str]) -> tuple[Node, int]:
    """The root of an XML file, plain or compressed by gzip, and how many style sheets of other files it asks for.

    Text is kept for the tags in `keeps_text` alone.

    Raises DrawingError for what is no XML, for files that declare entities, and beyond the limits.
    """
    reader = _Reader(file, keeps_text)
    data = _inflated(data, file) if data.startswith(_GZIP) else data
    try:
        for first in range(0, len(data), _CHUNK):
            reader.parser.Parse(data[first : first + _CHUNK], False)
        reader.parser.Parse(b"", True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        raise DrawingError(
            f"broken XML: {reason}",
            file=file,
            line=error.lineno,
            remedy="Open it in the program that made it, and save it again: it may have been cut off.",
        ) from error
    except (LookupError, ValueError) as error:
        if isinstance(error, DrawingError):
            raise
        raise DrawingError(f"unknown encoding: {error}", file=file, remedy="Save it as UTF-8.") from error
    assert reader.root is not None  # expat reports a file without an element itself
    return reader.root, reader.sheets


def _inflated(data: bytes, file: str) -> bytes:
    """The content of a gzip file, as long as it is within BYTES_MAX."""
    inflater = zlib.decompressobj(wbits=31)
    try:
        content = inflater.decompress(data, BYTES_MAX + 1)
    except zlib.error as error:
        raise DrawingError(f"broken compressed file: {error}", file=file, remedy="Save it as plain SVG.") from error
    if len(content) > BYTES_MAX:
        raise DrawingError(
            f"more than {BYTES_MAX >> 20} MiB when inflated", file=file, remedy="Split it, or simplify its curves."
        )
    if not inflater.eof:
        raise DrawingError("the compressed file is cut off", file=file, remedy="Save it again as plain SVG.")
    return content


class _Reader:
    """The handlers that expat calls."""

    def __init__(self, file: str, keeps_text: frozenset[str]) -> None:
        self.root: Node | None = None
        self.sheets = 0
        self._file = file
        self._keeps_text = keeps_text
        self._open: list[Node] = []
        self._count = 0
        self._text: list[str] = []
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._characters
        self.parser.ProcessingInstructionHandler = self._instruction
        self.parser.EntityDeclHandler = self._refuse_entity
        self.parser.UnparsedEntityDeclHandler = self._refuse_entity
        self.parser.ExternalEntityRefHandler = self._refuse_reference
        self.parser.SkippedEntityHandler = self._refuse_reference

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        line = self.parser.CurrentLineNumber
        if self._count > ELEMENTS_MAX:
            raise DrawingError(
                f"more than {ELEMENTS_MAX:,} elements", file=self._file, line=line, remedy="Split the drawing."
            )
        if len(self._open) >= DEPTH_MAX:
            raise DrawingError(
                f"elements nested more than {DEPTH_MAX:,} deep", file=self._file, line=line, remedy="Ungroup it."
            )
        node = Node(tag, attributes, line)
        if self._open:
            self._open[-1].children.append(node)
        else:
            self.root = node
        self._open.append(node)

    def _end(self, tag: str) -> None:
        node = self._open.pop()
        if tag in self._keeps_text:
            node.text = "".join(self._text)
            self._text.clear()

    def _characters(self, text: str) -> None:
        if self._open[-1].tag in self._keeps_text:
            self._text.append(text)

    def _instruction(self, target: str, _data: str) -> None:
        self.sheets += target == "xml-stylesheet"

    def _refuse_entity(self, *_details: object) -> Never:
        raise DrawingError(
            "declares entities, which can hide anything",
            file=self._file,
            line=self.parser.CurrentLineNumber,
            remedy="Save it as plain SVG (Inkscape: Save as, Plain SVG).",
        )

    def _refuse_reference(self, *_details: object) -> Never:
        raise DrawingError(
            "refers to an entity that it does not declare",
            file=self._file,
            line=self.parser.CurrentLineNumber,
            remedy="Save it as plain SVG (Inkscape: Save as, Plain SVG).",
        )
