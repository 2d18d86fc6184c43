"""The yardstick: Boost.Polygon's Voronoi diagram of segments, through pyvoronoi, on a block of copies.

Boost.Polygon knows no symmetry: it needs the base site with enough copies about it that the cells of the base site's
segments and end points are those of the whole plane. Its input is rounded to whole numbers, here a ten-millionth of a
unit apart.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvoronoi

from voronoi_tiles.site import Site
from voronoi_tiles.wallpaper import Lattice, Operation

SCALE = 1e7

Segment = list[list[float]]


@dataclass(frozen=True, slots=True)
class Reading:
    """What an outline needs of a diagram: the numbers and edges of the base site's cells.

    An edge is its start, its end, whether it is straight, and the cell beyond; `owner` tells every cell's segment and
    category.
    """

    cells: list[tuple[int, list[tuple[complex, complex, bool, int]]]]
    owner: list[tuple[int, int]]


def block_segments(site: Site, lattice: Lattice, copies: Iterable[Operation]) -> list[Segment]:
    """Give the segments of the site and then of its copies, as pyvoronoi takes them."""
    segments = []
    for isometry in [None, *(lattice.isometry(operation) for operation in copies)]:
        nodes = site.nodes if isometry is None else isometry(site.nodes)
        ends = nodes[site.segments]
        segments += np.stack((ends.real, ends.imag), axis=-1).tolist()
    return segments


def run_peer(segments: Sequence[Segment], base: int) -> tuple[float, Reading]:
    """Build the diagram and read it back; `base` is the number of the base site's segments, which come first.

    Returns the seconds that the building and the reading took, and what was read. Handing over the segments is not
    timed. Read are all cells, for there is no other way to find the base site's, and of these the edges and vertices.
    """
    diagram = pyvoronoi.Pyvoronoi(SCALE)
    for segment in segments:
        diagram.AddSegment(segment)
    begin = time.perf_counter()
    diagram.Construct()
    cells, owner = [], []
    for number, cell in diagram.EnumerateCells():
        owner.append((cell.site, cell.source_category))
        if cell.site < base:
            cells.append((number, [_edge(diagram, edge) for edge in cell.edges]))
    return time.perf_counter() - begin, Reading(cells, owner)


def _edge(diagram: Any, number: int) -> tuple[complex, complex, bool, int]:
    """Read an edge with its two vertices; one without an end gets NaN there."""
    edge = diagram.GetEdge(number)
    start, end = (
        complex(float("nan"), 0.0) if vertex < 0 else _vertex(diagram, vertex) for vertex in (edge.start, edge.end)
    )
    return start, end, edge.is_linear, diagram.GetEdge(edge.twin).cell


def _vertex(diagram: Any, number: int) -> complex:
    """Read a vertex."""
    vertex = diagram.GetVertex(number)
    return complex(vertex.X, vertex.Y)


def tile_area(reading: Reading, segments: Sequence[Segment]) -> float:
    """Sum up the areas of the base site's cells: NaN where one is unbounded.

    Between a parabola and its chord lies d^3 / 12q, for a chord of length d along a directrix at the distance q of the
    focus; the cell of the point is larger by it, that of the segment smaller.
    """
    ends = np.array(segments).reshape(-1, 4).view(complex)
    total = 0.0
    for number, edges in reading.cells:
        origin = edges[0][0]
        is_segment = _is_segment(reading.owner[number][1])
        for start, end, straight, beyond in edges:
            u, v = start - origin, end - origin
            total += (u.real * v.imag - u.imag * v.real) / 2
            if not straight:
                point_cell, line_cell = (beyond, number) if is_segment else (number, beyond)
                focus = _point(ends, *reading.owner[point_cell])
                first, second = ends[reading.owner[line_cell][0]]
                along = (second - first) / abs(second - first)
                away = (focus - first) * along.conjugate()
                chord = abs(((end - start) * along.conjugate()).real)
                total += (-1.0 if is_segment else 1.0) * chord**3 / (12.0 * abs(away.imag))
    return total


def _is_segment(category: int) -> bool:
    """Whether a cell is that of an open segment; 1 and 2 are the cells of its first and second end."""
    return category in {3, 4}


def _point(ends: np.ndarray[Any, np.dtype[np.complex128]], segment: int, category: int) -> complex:
    """Give the end of a segment that a cell belongs to."""
    return complex(ends[segment, category - 1])
