"""The outline document: the exact outlines of a design's tiles as JSON, schema 1.

Coordinates are in the design's units, y up; numbers are written with 17 significant digits, so that reading them
gives the same bits. The text depends on the tessellation alone.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from typing import Any, assert_never

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.operations import Operation
from voronoi_tiles.groups.wallpaper import Lattice
from voronoi_tiles.vector.arcs import Arc, LineArc, Neighbour, ParabolaArc
from voronoi_tiles.vector.outline import Outline

SCHEMA = 1

_BROKEN_LEVELS = 5  # containers above the level of an arc are written one item per line


def outline_document(units: str, group: str, lattice: Lattice, tiles: Iterable[dict[str, Any]]) -> dict[str, Any]:
    """The records of the tiles under the design's head; lengths are in `units`."""
    return {
        "schema": SCHEMA,
        "units": units,
        "group": group,
        "cell": [_point(lattice.a), _point(lattice.b)],
        "tiles": list(tiles),
    }


def tile_record(
    site: str,
    elements: NDArray[np.float64],
    outline: Outline,
    copies_per_cell: int,
    symmetry: Sequence[Operation],
) -> dict[str, Any]:
    """One tile: its site's flattened strokes, float64 (k, 4), its symmetry and its rings."""
    return {
        "site": site,
        "area": outline.area,
        "copies_per_cell": copies_per_cell,
        "symmetry": [str(operation) for operation in symmetry],
        "elements": elements.tolist(),
        "rings": [[_arc(arc) for arc in ring] for ring in outline.rings],
    }


def document_text(document: dict[str, Any]) -> str:
    """A document as JSON text: floats with 17 significant digits, one arc or element per line."""
    return _text(document, 0) + "\n"


def _arc(arc: Arc) -> dict[str, Any]:
    """One arc: its kind, points, focus and directrix, and the copy on its other side."""
    match arc:
        case LineArc(start, end, neighbour):
            return {
                "kind": "line",
                "points": [_point(start), _point(end)],
                "neighbour": _neighbour(neighbour),
            }
        case ParabolaArc(start, control, end, focus, directrix, neighbour):
            return {
                "kind": "parabola",
                "points": [_point(start), _point(control), _point(end)],
                "focus": _point(focus),
                "directrix": [_point(point) for point in directrix],
                "neighbour": _neighbour(neighbour),
            }
        case _:
            assert_never(arc)


def _neighbour(neighbour: Neighbour) -> dict[str, str]:
    """The copy on the other side of an arc: its site's name and its operation."""
    return {"site": neighbour.site, "operation": str(neighbour.operation)}


def _point(point: complex) -> list[float]:
    """A point as its two coordinates."""
    return [float(point.real), float(point.imag)]


def _text(value: Any, level: int) -> str:
    """One JSON value as text whose first line stands at `level`."""
    if isinstance(value, float):
        return f"{value + 0.0:.17g}"  # adding zero makes -0.0 a 0
    if not isinstance(value, (dict, list)):
        return json.dumps(value)
    items = value.values() if isinstance(value, dict) else value
    broken = level < _BROKEN_LEVELS and any(isinstance(item, (dict, list)) for item in items)
    texts = [_text(item, level + 1) for item in items]
    if isinstance(value, dict):
        texts = [f"{json.dumps(key)}: {text}" for key, text in zip(value, texts, strict=True)]
    opening, closing = "{}" if isinstance(value, dict) else "[]"
    if not broken:
        return f"{opening}{', '.join(texts)}{closing}"
    newline = "\n" + "  " * (level + 1)
    return f"{opening}{newline}{(',' + newline).join(texts)}{newline[:-2]}{closing}"
