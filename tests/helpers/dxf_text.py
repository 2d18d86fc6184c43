"""DXF files written tag by tag, as scripts write them, and read as ours are."""

from __future__ import annotations

import io
from typing import Any

from ezdxf.document import Drawing as Document

from voronoi_tiles.formats.dxf.reader import dxf_drawing
from voronoi_tiles.formats.reading import ReadDrawing

Tags = list[tuple[int, Any]]

LINE: Tags = [(0, "LINE"), (8, "0"), (10, 0.0), (20, 0.0), (11, 3.0), (21, 2.0)]


def text_of(tags: Tags) -> str:
    """Write tags as DXF does."""
    return "".join(f"{code:>3}\n{value}\n" for code, value in tags)


def file_of(*entities: Tags, header: Tags | None = None) -> str:
    """Write a file of a header, where one is given, and entities."""
    head = [] if header is None else [(0, "SECTION"), (2, "HEADER"), *header, (0, "ENDSEC")]
    body = [tag for entity in entities for tag in entity]
    return text_of([*head, (0, "SECTION"), (2, "ENTITIES"), *body, (0, "ENDSEC"), (0, "EOF")])


def read(text: str | bytes) -> ReadDrawing:
    """Read a file."""
    return dxf_drawing(text.encode() if isinstance(text, str) else text, "t.dxf")


def written(document: Document) -> str:
    """Write a document of ezdxf's."""
    text = io.StringIO()
    document.write(text)
    return text.getvalue()
