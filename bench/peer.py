"""The yardstick: Boost.Polygon's Voronoi diagram of segments, through pyvoronoi, on a block of copies.

Boost.Polygon knows no symmetry: it needs the base site with enough copies about it that the cells of the base site's
segments and end points are those of the whole plane; which they are is found here, for all peers. Its input is rounded
to whole numbers, here a ten-millionth of a unit apart.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvoronoi
from numpy.typing import NDArray

from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.groups.wallpaper import Lattice
from voronoi_tiles.vector.tessellation import TileRecord

if TYPE_CHECKING:
    from engine import Case

SCALE = 1e7
AGREEMENT = 1e-6
"""How well the areas of a tile have to agree, relative to it."""
# Larger diagrams are not built again and again to find the smallest block: that of a smaller one is tried first.
SEARCHED = 300

Segment = list[list[float]]
Complexes = NDArray[np.complex128]


@dataclass(frozen=True, slots=True)
class Reading:
    """What an outline needs of a diagram: the numbers and edges of the base site's cells.

    An edge is its start, its end, whether it is straight, and the cell beyond; `owner` tells every cell's segment and
    category.
    """

    cells: list[tuple[int, list[tuple[complex, complex, bool, int]]]]
    owner: list[tuple[int, int]]


def block_nodes(site: NodedSite, lattice: Lattice, copies: Iterable[Operation]) -> Complexes:
    """The nodes of the site and then of its copies, complex128 (copies + 1, m)."""
    return np.array([site.nodes, *(lattice.isometry(operation)(site.nodes) for operation in copies)])


def block_segments(site: NodedSite, nodes: Complexes) -> list[Segment]:
    """The segments of a block of copies, which has these nodes, as pyvoronoi takes them."""
    ends = nodes[:, site.segments].reshape(-1, 2)
    segments: list[Segment] = np.stack((ends.real, ends.imag), axis=-1).tolist()
    return segments


def run_peer(segments: Sequence[Segment], base: int, scale: float = SCALE) -> tuple[float, Reading]:
    """Build the diagram and read it back; `base` is the number of the base site's segments, which come first.

    Coordinates are rounded to multiples of 1 / `scale`.

    Returns the processor seconds that the building and the reading took, and what was read. Handing over the segments
    is not timed. Read are all cells, for there is no other way to find the base site's, and of these the edges and
    vertices.
    """
    diagram = pyvoronoi.Pyvoronoi(scale)
    for segment in segments:
        diagram.AddSegment(segment)
    begin = time.process_time()
    diagram.Construct()
    cells, owner = [], []
    for number, cell in diagram.EnumerateCells():
        owner.append((cell.site, cell.source_category))
        if cell.site < base:
            cells.append((number, [_edge(diagram, edge) for edge in cell.edges]))
    return time.process_time() - begin, Reading(cells, owner)


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


def _point(ends: Complexes, segment: int, category: int) -> complex:
    """The end of a segment that a cell belongs to."""
    return complex(ends[segment, category - 1])


# Blocks of copies


def neighbours(record: TileRecord) -> list[Operation]:
    """List the copies beyond the edges of a tile, those with the longest common edges first."""
    outline = record.outline
    lengths = np.bincount(outline.neighbour, np.abs(outline.end - outline.start), len(outline.neighbours))
    return [outline.neighbours[k].operation for k in np.argsort(-lengths)]


def block_error(case: Case, copies: Sequence[Operation], area: float) -> float:
    """The relative error of the tile's area that the peer finds with these copies."""
    segments = block_segments(case.site, block_nodes(case.site, case.lattice, copies))
    _, reading = run_peer(segments, len(case.site.segments))
    error = abs(tile_area(reading, segments) - area) / area
    return error if error == error else float("inf")  # noqa: PLR0124 NaN: an unbounded cell


def smallest_block(case: Case, record: TileRecord, known: Sequence[Operation] | None) -> list[Operation]:
    """Find copies with which the peer gives the same tile, and of which none can be left out.

    The copies beyond the tile's edges come first, with rings of further ones until the area is right; then those that
    do not matter leave, the least important first.
    """
    area = record.outline.area
    if known is not None and len(case.site.segments) > SEARCHED and block_error(case, known, area) <= AGREEMENT:
        return list(known)
    first = neighbours(record)
    block = list(first)
    for _ in range(3):
        if block_error(case, block, area) <= AGREEMENT:
            break
        block += [q for p in list(block) for n in first if not (q := p @ n).is_identity and q not in block]
    else:
        raise AssertionError(f"the peer's area is off by {block_error(case, block, area):.2g}")
    for copy in reversed(list(block)):
        rest = [other for other in block if other != copy]
        if block_error(case, rest, area) <= AGREEMENT:
            block = rest
    return block


def block_of_cells(case: Case, record: TileRecord, known: Sequence[Operation] | None) -> list[Operation]:
    """Find the smallest square of whole cells with which the peer gives the same tile; all its copies but the site."""
    area = record.outline.area
    if known is not None and len(case.site.segments) > SEARCHED and block_error(case, known, area) <= AGREEMENT:
        return list(known)
    for reach in range(1, 5):
        steps = range(-reach, reach + 1)
        block = [
            copy
            for operation in case.group.operations
            for i in steps
            for j in steps
            if not (copy := operation.translated(i, j)).is_identity
        ]
        if block_error(case, block, area) <= AGREEMENT:
            return block
    raise AssertionError("no block of cells gives the tile")
