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
from voronoi_tiles.vector.cells.bisectors import find_bisectors
from voronoi_tiles.vector.cells.candidates import Bounds, Candidates
from voronoi_tiles.vector.cells.envelope import NOTHING, lower_envelope
from voronoi_tiles.vector.cells.half_edges import Contour, trace_contour
from voronoi_tiles.vector.cells.images import Surroundings, surround
from voronoi_tiles.vector.cells.partial_quadratics import PartialQuadratics
from voronoi_tiles.vector.cells.pencils import Rows, make_rows
from voronoi_tiles.vector.copies import Copies, copies_near, place
from voronoi_tiles.vector.motions import IDENTITY, Action

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

_FAR = 1e6  # farther than anything that is drawn


@dataclass(frozen=True)
class Scene:
    """Rows of a site, all bisectors that bound them, and the lower envelope of each row.

    `row`, `start`, `end`, `lowest` are the envelope's parts: `lowest` is -1 where nothing bounds the row. A function's
    target is the site beyond, its copy that copy's index (0, 0: the site itself). `half_edges` counts those of each
    site.
    """

    contour: Contour
    rows: Rows
    functions: PartialQuadratics
    row: Ints
    start: Floats
    end: Floats
    lowest: Ints
    half_edges: list[int]

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
        of_segment = self.functions.item[self.lowest[part]] < self.half_edges[self.functions.target[self.lowest[part]]]
        return bool(self.rows.straight[self.row[part]] != of_segment)

    @property
    def bounded(self) -> Ints:
        """The parts where something bounds the row."""
        return np.flatnonzero(self.lowest != NOTHING)

    def inner(self, part: int) -> bool:
        """Whether the element beyond a part belongs to the site itself."""
        lowest = self.lowest[part]
        return bool(self.functions.target[lowest] == 0 and self.functions.copy[lowest] == 0)


def lone_scene(sites: Sequence[tuple[Complexes, Ints]]) -> Scene:
    """A scene without a group: the first site against the others; the nodes and segments of each are given."""
    contours = [trace_contour(nodes, segments) for nodes, segments in sites]
    one = Copies(np.array([IDENTITY]), np.ones(1, complex), np.zeros(1, complex), np.zeros(1, bool))
    around = [surround(contour, one, own=k == 0) for k, contour in enumerate(contours)]
    return _scene(contours, around, _FAR)


def group_scene(design: Design) -> Scene:
    """A scene of a design's first site among all copies near it."""
    action = Action(design.group, design.lattice)
    placed = [place(action, site.nodes, site.segments) for site in design.noded]
    contours = [trace_contour(site.nodes, site.segments) for site in placed]
    around = [
        surround(contour, copies_near(action, placed[0], other), own=k == 0)
        for k, (contour, other) in enumerate(zip(contours, placed, strict=True))
    ]
    return _scene(contours, around, action.covering_radius)


def _scene(contours: list[Contour], around: list[Surroundings], covering_radius: float) -> Scene:
    contour = contours[0]
    rows = make_rows(contour, covering_radius, np.zeros(len(contour.source), bool))
    every = [_all_pairs(len(rows), surroundings) for surroundings in around]
    none = np.full(len(rows), _FAR)
    bounds = Bounds(1e-12, none, none.copy(), np.full(len(rows), np.nan, complex))
    functions = find_bisectors(rows, contour, list(zip(around, every, strict=True)), bounds)
    envelope = lower_envelope(functions, rows.low, rows.high)
    return Scene(contour, rows, functions, *envelope, [2 * surroundings.segments for surroundings in around])


def _all_pairs(rows: int, around: Surroundings) -> Candidates:
    """Every row with every element of every copy."""
    elements = around.segments + (len(around.corner) - 2 * around.segments) // 4
    shape = (rows, len(around.node), elements)
    row, copy, element = (index.reshape(-1) for index in np.indices(shape))
    return Candidates(row, copy, element)
