"""The gradient of one tile: how its outline, its area and its lengths change with the parameters of a design."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
from scipy import sparse

from voronoi_tiles.base.arguments import whole_number
from voronoi_tiles.base.arrays import Complexes, Floats, Ints, next_in_ring
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.gradients.bending import NODES, WEIGHTS, bending_weights
from voronoi_tiles.gradients.feet import AllStrokes
from voronoi_tiles.gradients.foot_spans import FootSpans, points_at, speeds_at
from voronoi_tiles.gradients.sides import Sides
from voronoi_tiles.vector.outline import Outline

_SMOOTH: Final = 1e-7
"""Two edges go on into each other without a corner where their directions differ by less; radians. Where they meet is
then no corner of the tile, and rounding, divided by the angle, would be more than what derivatives are compared to."""

_ENTRIES_MAX: Final = 1 << 27
"""The most numbers of one result; a count. They take a gigabyte."""


class MovingPoints(NamedTuple):
    """Points of an outline, n of them, and how they move with p parameters.

    `arc` (intp, n) are the numbers of their edges in the outline, `t` (float64, n) the parameters on these from 0 to 1,
    `place` (complex128, n) the points, in units, `normal` (complex128, n) the unit vectors that point out of the tile,
    and `velocity` (float64, n x p) the derivatives of the outline's place along them by each parameter.
    """

    arc: Ints
    t: Floats
    place: Complexes
    normal: Complexes
    velocity: Floats


class _VelocityRows(NamedTuple):
    """Velocities of points as sparse rows over the rates of nodes and of the lattice, and the points' normals."""

    matrix: sparse.csr_array
    normal: Complexes


@dataclass(frozen=True, eq=False, repr=False)
class TileGradient:
    """The derivatives of a tile by the parameters of its design, p of them, in the order of `ShapeGradient.parameters`.

    `name` is that of the tile's site, and derivatives are of the edges and neighbours of its `outline`. Where four
    tiles or more meet by chance, not by symmetry, a vertex becomes an edge one way or the other: what the neighbours
    there share has no derivative, and the result is that of the edges that are there.

    >>> import voronoi_tiles as vt
    >>> gradient = vt.starter("p4").tessellate().shape_gradient("cell")
    >>> tile = gradient["bird"]
    >>> tile.area.round(9), tile.velocities([0, 1], [0.5, 0.5]).velocity.shape
    (array([30.]), (2, 1))
    """

    name: str
    outline: Outline
    _sides: Sides
    _strokes: AllStrokes
    _rates: sparse.csr_array

    def __repr__(self) -> str:
        return f"<TileGradient {self.name!r}: {len(self.outline)} edges by {self._rates.shape[1]} parameters>"

    def velocities(self, arc: Sequence[int] | Ints, t: Sequence[float] | Floats) -> MovingPoints:
        """How points of the outline move: on edges of the numbers `arc`, at parameters `t` from 0 to 1 of each.

        An edge is the quadratic Bezier curve of its start, control and end. At a corner, t = 0 and t = 1 give how the
        edge moves there; `vertices` has how the corner does. Raises ArgumentError for what is on no edge, and where
        the result would not fit into memory.
        """
        arc, t = self._checked(arc, t)
        self._refuse_large(len(arc), "points")
        rows = self._rows(arc, t)
        velocity = (rows.matrix @ self._rates).toarray()
        return MovingPoints(arc, t, points_at(self.outline, arc, t), rows.normal, velocity)

    def along(self, count: int) -> MovingPoints:
        """So many points, spread over the outline by its length; evenly along lines, by their parameters along curves.

        Raises ArgumentError for a count below 1.
        """
        wanted = whole_number("count", count, "Give a number of points.", least=1)
        self._refuse_large(wanted, "points")
        ends = np.cumsum(self.outline.lengths)
        place = (np.arange(wanted) + 0.5) / wanted * ends[-1]
        arc = np.minimum(np.searchsorted(ends, place, side="right"), len(ends) - 1)
        t = 1.0 - (ends[arc] - place) / self.outline.lengths[arc]
        return self.velocities(arc, np.clip(t, 0.0, 1.0))

    @cached_property
    def vertices(self) -> Complexes:
        """How the start of each edge moves: complex128 (n, p), for the n edges of the outline.

        Where two edges go on into each other without a corner, it is the velocity along the normal alone.
        """
        self._refuse_large(2 * len(self.outline), "vertices")
        x, y = (part @ self._rates for part in self._vertex_rows)
        return np.asarray(x.toarray() + 1j * y.toarray())

    @cached_property
    def area(self) -> Floats:
        """The derivatives of the tile's area, in units: float64 (p,)."""
        speed, rows = self._quadrature
        spans = self._spans
        weights = WEIGHTS[None, :] / 2.0 * (spans.end - spans.begin)[:, None]
        return self._functional((weights.ravel() * speed) @ rows)

    @cached_property
    def perimeter(self) -> Floats:
        """The derivatives of the length of the outline: float64 (p,)."""
        return self._functional(np.ones(len(self.outline)) @ self._length_rows)

    @cached_property
    def neighbour_lengths(self) -> Floats:
        """The derivatives of the length of what each neighbour shares: float64 (k, p), in the outline's order."""
        outline = self.outline
        count = len(outline.neighbours)
        self._refuse_large(count, "neighbours")
        edges = np.arange(len(outline))
        sums = sparse.csr_array((np.ones(len(edges)), (outline.neighbour, edges)), shape=(count, len(edges)))
        return np.asarray((sums @ self._length_rows @ self._rates).toarray())

    def _functional(self, row: Floats) -> Floats:
        """The derivatives of what is a sum of velocities, as a row over the rates."""
        return np.asarray(self._rates.T @ row)

    def _checked(self, arc: Sequence[int] | Ints, t: Sequence[float] | Floats) -> tuple[Ints, Floats]:
        try:
            arcs, places = np.broadcast_arrays(np.atleast_1d(arc), np.atleast_1d(np.asarray(t, float)))
        except (TypeError, ValueError):
            raise ArgumentError("`arc` and `t` cannot be", remedy="Give two arrays of one length.") from None
        if arcs.ndim != 1 or not (np.issubdtype(arcs.dtype, np.integer) or not len(arcs)):
            raise ArgumentError("`arc` must be numbers of edges", remedy="Give integers, an array of shape (n,).")
        if len(arcs) and not (arcs.min() >= 0 and arcs.max() < len(self.outline)):
            raise ArgumentError(f"`arc` must be from 0 to {len(self.outline) - 1}", remedy="Give numbers of edges.")
        if not ((places >= 0.0) & (places <= 1.0)).all():
            raise ArgumentError("`t` must be from 0 to 1", remedy="Give parameters on the edges.")
        return arcs.astype(np.intp), places

    def _refuse_large(self, rows: int, what: str) -> None:
        columns = self._rates.shape[1]
        if rows * max(columns, 1) > _ENTRIES_MAX:
            raise ArgumentError(
                f"{rows:,} {what} by {columns:,} `parameters` are too many numbers",
                remedy="Choose some of the parameters.",
            )

    @cached_property
    def _spans(self) -> FootSpans:
        return FootSpans.of(self.outline, self._sides, self._strokes)

    def _rows(self, arc: Ints, t: Floats, span: Ints | None = None) -> _VelocityRows:
        """The velocities of points: (d own / dp - d other / dp) / |grad own - grad other|, inwards.

        A distance falls by what the foot moves towards the point; outwards the signs are the other way round.
        """
        spans, sides = self._spans, self._sides
        lines = spans.lines[spans.at(arc, t) if span is None else span]
        neighbour = self.outline.neighbour[arc]
        feet = self._strokes.feet(sides.back(points_at(self.outline, arc, t), neighbour), lines)
        away = sides.forth(feet.away, neighbour)
        slope = away[:, 0] - away[:, sides.own]
        pull = sides.weight[neighbour] / np.abs(slope)[:, None]
        parts = []
        for node, share in ((lines[..., 0], 1.0 - feet.share), (lines[..., 1], feet.share)):
            force = pull * share * feet.away
            parts += [(2 * node, force.real), (2 * node + 1, force.imag)]
        last = 2 * len(self._strokes.nodes)
        for k in (0, 1):
            # The images are moved by the lattice: what of it comes into each is in fractions of the cell.
            force = pull * sides.translation[neighbour][..., k] * away
            parts += [(last + 2 * k + np.zeros_like(lines[..., 0]), force.real)]
            parts += [(last + 2 * k + np.ones_like(lines[..., 0]), force.imag)]
        columns, entries = (np.concatenate(part, axis=1) for part in zip(*parts, strict=True))
        row = np.repeat(np.arange(len(arc)), columns.shape[1])
        shape = (len(arc), self._rates.shape[0])
        matrix = sparse.csr_array((entries.ravel(), (row, columns.ravel())), shape=shape)
        return _VelocityRows(matrix, slope / np.abs(slope))

    @cached_property
    def _quadrature(self) -> tuple[Floats, sparse.csr_array]:
        """The speeds of the edges' points at four Gauss nodes of each span, float64 (4 n,), and the velocities there.

        Velocity times speed is a cubic along a span: four nodes hold all of it.
        """
        spans = self._spans
        half = (spans.end - spans.begin)[:, None] / 2.0
        t = ((spans.begin + spans.end)[:, None] / 2.0 + half * NODES).ravel()
        span = np.repeat(np.arange(len(spans.arc)), len(NODES))
        arc = spans.arc[span]
        return speeds_at(self.outline, arc, t), self._rows(arc, t, span).matrix

    @cached_property
    def _ends(self) -> tuple[_VelocityRows, _VelocityRows]:
        """The velocities at the starts and at the ends of the edges."""
        arcs = np.arange(len(self.outline))
        return self._rows(arcs, np.zeros(len(arcs))), self._rows(arcs, np.ones(len(arcs)))

    @cached_property
    def _vertex_rows(self) -> tuple[sparse.csr_array, sparse.csr_array]:
        """The velocities of the starts of edges in x and in y: what both edges there say of it together."""
        (here, normal), (ends, end_normal) = self._ends
        count = len(self.outline)
        previous = np.empty(count, np.intp)
        previous[next_in_ring(self.outline.ring_offsets)] = np.arange(count)
        before, normal_before = ends[previous], end_normal[previous]
        corner = normal_before.real * normal.imag - normal_before.imag * normal.real
        smooth = np.abs(corner) < _SMOOTH
        turn = np.where(smooth, 1.0, corner)
        of_before = np.where(smooth, normal_before / 2.0, -1j * normal / turn)
        of_here = np.where(smooth, normal / 2.0, 1j * normal_before / turn)
        x = _times(of_before.real, before) + _times(of_here.real, here)
        y = _times(of_before.imag, before) + _times(of_here.imag, here)
        return x, y

    @cached_property
    def _length_rows(self) -> sparse.csr_array:
        """The derivatives of the edges' lengths: what curvature makes of the velocity, and how the ends move."""
        speed, rows = self._quadrature
        spans, outline = self._spans, self.outline
        weights = bending_weights(outline, spans.arc, spans.begin, spans.end)
        arc = np.repeat(spans.arc, len(NODES))
        gather = sparse.csr_array((weights.ravel() * speed, (arc, np.arange(len(arc)))), shape=(len(outline), len(arc)))
        (_, start), (_, end) = self._ends
        x, y = self._vertex_rows
        following = next_in_ring(outline.ring_offsets)
        # The direction of an edge is its outer normal, a quarter turn on.
        grown = _times(-end.imag, x[following]) + _times(end.real, y[following])
        shrunk = _times(-start.imag, x) + _times(start.real, y)
        return sparse.csr_array(gather @ rows + grown - shrunk)


def _times(factor: Floats, rows: sparse.csr_array) -> sparse.csr_array:
    """Rows, each times a factor."""
    return sparse.csr_array(rows.multiply(factor[:, None]))
