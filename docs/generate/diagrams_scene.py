"""The engine's own bisectors and envelopes of a few elements, with and without a group, for drawing.

A scene has a site whose cells are looked at and other sites, or the copies of one site under a group. Its rows, their
bisectors and their lower envelopes come from voronoi_tiles.vector; here they are only put into the plane, as
voronoi_tiles.vector.cells.pencils says.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from diagrams_style import Complexes
from numpy.typing import NDArray

from voronoi_tiles import Design
from voronoi_tiles.base.arrays import offsets_of
from voronoi_tiles.vector.cells.bisectors import find_bisectors
from voronoi_tiles.vector.cells.candidates import Candidates
from voronoi_tiles.vector.cells.envelope import NOTHING, lower_envelope
from voronoi_tiles.vector.cells.half_edges import Contour, trace_contour
from voronoi_tiles.vector.cells.images import Surroundings, surround
from voronoi_tiles.vector.cells.partial_quadratics import PartialQuadratics
from voronoi_tiles.vector.cells.pencils import Rows, make_rows
from voronoi_tiles.vector.cells.provisional import Bounds
from voronoi_tiles.vector.copies import Copies, bundles, copies_near, place
from voronoi_tiles.vector.motions import IDENTITY, Action

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_FAR = 1e6  # farther than anything that is drawn


@dataclass(frozen=True)
class Scene:
    """Rows of a site, all bisectors that bound them, and the lower envelope of each row.

    `row`, `start`, `end`, `lowest` are the envelope's parts: `lowest` is -1 where nothing bounds the row. `contour` is
    that of all sites; `site` (intp) is the site beyond each function.
    """

    contour: Contour
    site: Ints
    rows: Rows
    functions: PartialQuadratics
    row: Ints
    start: Floats
    end: Floats
    lowest: Ints

    def points(self, row: int, x: Floats, value: Floats) -> Complexes:
        """The points of a row at x where its function has this value: h, or -(1 + x^2) / r; NaN at infinity."""
        rows = self.rows
        if rows.straight[row]:
            return np.asarray(rows.origin[row] + (x + 1j * value) * rows.axis[row])
        # A ray that no bisector meets: its value is not below 0.
        inverse = np.divide(-1.0, value, out=np.full(len(x), np.nan), where=value < -1.0 / _FAR)
        return np.asarray(rows.origin[row] + rows.axis[row] * (1.0 + 1j * x) ** 2 * inverse)

    def curve(self, part: int, samples: int = 24) -> Complexes:
        """The stretch of a bisector that a part of an envelope is, (samples,) points."""
        x = np.linspace(self.start[part], self.end[part], samples)
        return self.points(self.row[part], x, self.functions.value(np.full(samples, self.lowest[part]), x))

    def feet(self, part: int) -> Complexes:
        """The points of the row's element nearest to the two ends of a part."""
        rows, row = self.rows, self.row[part]
        x = np.array([self.start[part], self.end[part]])
        return np.asarray(rows.origin[row] + (x * rows.axis[row] if rows.straight[row] else 0.0 * x))

    def parabola(self, part: int) -> bool:
        """Whether a part lies on a parabola: between a point and a segment."""
        of_segment = self.functions.item[self.lowest[part]] < len(self.contour.source)
        return bool(self.rows.straight[self.row[part]] != of_segment)

    @property
    def bounded(self) -> Ints:
        """The parts where something bounds the row."""
        return np.flatnonzero(self.lowest != NOTHING)

    def inner(self, part: int) -> bool:
        """Whether the element beyond a part belongs to the site itself."""
        lowest = self.lowest[part]
        return bool(self.site[lowest] == 0 and self.functions.copy[lowest] == 0)


def lone_scene(sites: Sequence[tuple[Complexes, Ints]]) -> Scene:
    """A scene without a group: the first site against the others; the nodes and segments of each are given."""
    one = Copies(np.array([IDENTITY]), np.ones(1, complex), np.zeros(1, complex), np.zeros(1, bool), np.zeros(1, int))
    return _scene(sites, one, _FAR)


def group_scene(design: Design) -> Scene:
    """A scene of the first and only site of a design among all its copies near it."""
    action = Action(design.group, design.lattice)
    placed, union = place(action, design.noded)
    copies = copies_near(action, placed, union.nodes, bundles(placed)[union.node_site])
    return _scene([(union.nodes, union.segments)], copies, action.covering_radius)


def _scene(sites: Sequence[tuple[Complexes, Ints]], copies: Copies, covering_radius: float) -> Scene:
    first = offsets_of([len(nodes) for nodes, _ in sites])
    node_site = np.repeat(np.arange(len(sites)), np.diff(first))
    contour = trace_contour(
        np.concatenate([nodes for nodes, _ in sites]),
        np.concatenate([segments + k for (_, segments), k in zip(sites, first[:-1], strict=True)]),
    )
    around = surround(contour, copies, np.zeros_like(node_site))
    rows = make_rows(contour, covering_radius, node_site[contour.source] > 0)
    # Isolated nodes have their corners in any case.
    node = np.concatenate((contour.source, contour.corner_node))
    of_first = node_site[node[np.where(rows.straight, rows.half_edge, len(contour.source) + rows.corner)]] == 0
    rows = Rows(*(getattr(rows, name)[of_first] for name in Rows.__slots__))
    pairs, elements = _all_pairs(len(rows), around)
    functions = find_bisectors(rows, around, elements, pairs, Bounds.none(rows, _FAR, 1e-12))
    envelope = lower_envelope(functions, rows.low, rows.high)
    return Scene(contour, node_site[node[functions.item]], rows, functions, *envelope)


def _all_pairs(rows: int, around: Surroundings) -> tuple[Candidates, Ints]:
    """Every row with every element of every copy; and all elements."""
    half_edges, corners = len(around.contour.source), len(around.contour.corner_node)
    elements = np.arange(half_edges // 2 + (corners - half_edges) // 4)
    row, copy, place = (index.reshape(-1) for index in np.indices((rows, len(around.copies), len(elements))))
    return Candidates(row, copy, place), elements
