"""The strokes of a site as segments, and how their ends move with parameters of the design.

Distances from a site are those from the segments of its strokes, noded or not: here they are not, because where strokes
cross each other, the crossing is no point that moves with one of them.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from scipy import sparse

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.base.maps import Placement
from voronoi_tiles.base.tolerance import FLATTENING_MM
from voronoi_tiles.base.units import UNIT_MM
from voronoi_tiles.designs import strokes as curves
from voronoi_tiles.designs.control_weights import (
    ControlWeights,
    bezier_weights,
    bspline_weights,
    catmull_rom_weights,
    hermite_weights,
)
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.noding import merged
from voronoi_tiles.designs.parameters import Parameter
from voronoi_tiles.designs.schema import KINDS, placement, stroke
from voronoi_tiles.designs.site import merging

DEGREE: Final = math.pi / 180.0
"""One degree in radians."""

_PLACING: Final = (("scale", ()), ("rotate", ()), ("translate", (0,)), ("translate", (1,)))
"""The numbers of a placement, each its key and the index below it."""


class MovingSite(NamedTuple):
    """The strokes of a site as segments: `nodes` complex128 (n,), `segments` intp (m, 2), both ends equal for points.

    `rates` (2n, p), sparse, are the derivatives of x and y of node k by the parameters, in rows 2k and 2k + 1. Points
    of strokes that coincide are one node, which moves by the mean of what these strokes say: each has its share.
    """

    nodes: Complexes
    segments: Ints
    rates: sparse.csr_array


def moving_sites(design: Design, parameters: Sequence[Parameter]) -> list[MovingSite]:
    """The sites of a design, in its order, and how they move with the parameters, in theirs; the cell moves none."""
    columns = {parameter: k for k, parameter in enumerate(parameters)}
    whole = Placement(design.scale)
    default = FLATTENING_MM / UNIT_MM[design.units]
    return [
        _moving_site(_SiteTable(index, table, whole, table.get("tolerance", default)), columns)
        for index, table in enumerate(json.loads(design.source)["site"])
    ]


def moving_lattice(design: Design, parameters: Sequence[Parameter]) -> Floats:
    """The derivatives of the lattice's vectors by the parameters, float64 (4, p): of a's x and y, then of b's."""
    a, b = design.lattice.a, design.lattice.b
    rates = np.zeros((2, len(parameters)), complex)
    for column, parameter in enumerate(parameters):
        match str(parameter):
            case "cell.a":
                rates[0, column] = design.scale
                if design.group.fixes_b:
                    rates[1, column] = design.scale * b / abs(a)
            case "cell.b":
                rates[1, column] = design.scale * b / abs(b)
            case "cell.angle":
                rates[1, column] = 1j * DEGREE * b
            case "scale":
                rates[:, column] = a / design.scale, b / design.scale
    return np.stack([rates.real, rates.imag], axis=1).reshape(4, -1)


class _SiteTable(NamedTuple):
    """A site's table, with what its strokes are read by."""

    number: int
    table: Mapping[str, Any]
    whole: Placement
    accuracy: float

    @property
    def placement(self) -> Placement:
        return self.whole @ placement(self.table)


class _StrokePoints(NamedTuple):
    """Points of a stroke where it is placed, complex128 (n,), and segments between them, intp (m, 2).

    A point moves by the sum of direct * dp + conjugate * conj(dp) over the points p of the stroke in its `stencil`, as
    the stroke has them before it is placed. `radial` is what of it turns with no placement, complex128 (n,): a circle's
    polygon about its centre.
    """

    points: Complexes
    segments: Ints
    stencil: Ints
    direct: Complexes
    conjugate: Complexes
    radial: Complexes


def _moving_site(drawn: _SiteTable, columns: Mapping[Parameter, int]) -> MovingSite:
    points, segments, rates, owners = [], [], [], []
    first = 0
    for index, table in enumerate(drawn.table["strokes"]):
        found = _points(table, drawn)
        points.append(found.points)
        segments.append(found.segments + first)
        rates.append(_rates(found, table, drawn, index, columns))
        owners.append(np.full(len(found.points), index))
        first += len(found.points)
    every = np.concatenate(points)
    nodes, node = merged(every, complex(every[len(every) // 2]), merging(every))
    share = _shares(node, np.concatenate(owners), len(nodes))
    # From complex rates to those of x and y.
    both = share @ sparse.vstack(rates, format="csr")
    split = sparse.vstack([both.real, both.imag], format="csr")
    order = np.arange(2 * len(nodes)).reshape(2, -1).T.ravel()
    return MovingSite(nodes, node[np.concatenate(segments)], split[order])


def _shares(node: Ints, stroke_of: Ints, count: int) -> sparse.csr_array:
    """Means over the points of each node, in which every stroke that has some counts alike: sparse (count, n)."""
    pairs, pair, size = np.unique(np.stack([node, stroke_of]), axis=1, return_inverse=True, return_counts=True)
    pair = pair.reshape(-1)
    weight = 1.0 / (size[pair] * np.bincount(pairs[0], minlength=count)[node])
    return sparse.csr_array((weight, (node, np.arange(len(node)))), shape=(count, len(node)))


def _points(table: Mapping[str, Any], drawn: _SiteTable) -> _StrokePoints:
    """The points of a stroke, flattened as the design has it."""
    kind = next(name for name in KINDS if name in table)
    placed, curved = stroke(table, drawn.accuracy, drawn.placement)
    if curved:
        return _flattened(placed, _weights(kind, table), drawn.accuracy * (1.0 - curves.ARC_SHARE))
    count = len(placed)
    segments = np.stack([np.arange(count - 1), np.arange(1, count)], axis=1) if count > 1 else np.zeros((1, 2), int)
    one = np.ones((count, 1), complex)
    if kind == "circle":
        centre = (drawn.placement @ placement(table))(complex(*table["circle"]))
        return _StrokePoints(placed, segments, np.zeros((count, 1), int), one, 0 * one, placed - centre)
    drawn_count = len(table[kind]) if kind != "point" else 1
    return _StrokePoints(placed, segments, (np.arange(count) % drawn_count)[:, None], one, 0 * one, 0 * placed)


def _weights(kind: str, table: Mapping[str, Any]) -> ControlWeights | None:
    """The weights of the pieces of a curve; None where it is drawn by no points."""
    if kind in ("path", "file"):
        return None
    points = np.array(table[kind], float).view(complex)[:, 0]
    closed = table.get("closed", False)
    match kind:
        case "bezier":
            return bezier_weights(len(points))
        case "hermite":
            return hermite_weights(len(points))
        case "catmull_rom":
            return catmull_rom_weights(points, table.get("alpha", 0.5), closed=closed)
    moving = curves.are_moving(curves.bspline_controls(points, closed))
    stencil, direct, conjugate = bspline_weights(len(points), closed=closed)
    return ControlWeights(stencil[moving], direct[moving], conjugate[moving])


def _flattened(pieces: Complexes, weights: ControlWeights | None, accuracy: float) -> _StrokePoints:
    """The ends of the chords of cubic pieces."""
    chords, counts, places = curves.flatten(pieces, accuracy)
    owner = np.repeat(np.arange(len(pieces)), counts)
    last = np.append(owner[1:] != owner[:-1], True)
    t = np.stack([places, np.where(last, 1.0, np.roll(places, -1))], axis=1)
    points = chords.ravel()
    segments = np.arange(len(points)).reshape(-1, 2)
    if weights is None:
        stencil, nothing = np.zeros((len(points), 0), np.intp), np.zeros((len(points), 0), complex)
        return _StrokePoints(points, segments, stencil, nothing, nothing, 0 * points)
    u = 1.0 - t
    bernstein = np.stack([u**3, 3 * u**2 * t, 3 * u * t**2, t**3], axis=-1)
    stencil = np.repeat(weights.stencil[owner], 2, axis=0)
    direct, conjugate = (
        np.einsum("ntc,ncs->nts", bernstein, part[owner]).reshape(-1, 4) for part in (weights.direct, weights.conjugate)
    )
    return _StrokePoints(points, segments, stencil, direct, conjugate, 0 * points)


def _rates(
    found: _StrokePoints, table: Mapping[str, Any], drawn: _SiteTable, index: int, columns: Mapping[Parameter, int]
) -> sparse.csr_array:
    """The derivatives of a stroke's points by the parameters: complex, sparse (n, p)."""
    count = len(found.points)
    entries: list[tuple[Ints, Ints, Complexes]] = []
    by_placement = drawn.placement @ placement(table)
    column_of = _control_columns(table, drawn.number, index, columns)
    row, slot = (where.ravel() for where in np.indices(found.stencil.shape))
    for axis, unit in enumerate((1.0, 1j)):
        # A step of a coordinate, as the curve takes it.
        step = _turned(by_placement, found.direct * unit + found.conjugate * np.conj(unit)).ravel()
        column = column_of[found.stencil[row, slot], axis]
        chosen = column >= 0
        entries.append((row[chosen], column[chosen], step[chosen]))
    for column, rate in _whole_rates(found, table, drawn, index, columns):
        entries.append((np.arange(count), np.full(count, column), rate))
    rows, places, rates = (np.concatenate(parts) for parts in zip(*entries, strict=True))
    return sparse.csr_array((rates, (rows, places)), shape=(count, len(columns)))


def _turned(by: Placement, step: Complexes) -> Complexes:
    """A step before a placement as it is after it."""
    factor, _, mirrored = by.similarity
    return factor * (step.conj() if mirrored else step)


def _whole_rates(
    found: _StrokePoints, table: Mapping[str, Any], drawn: _SiteTable, index: int, columns: Mapping[Parameter, int]
) -> Iterator[tuple[int, Complexes]]:
    """The columns of the parameters that move a stroke as a whole, and the rates of its points by them."""
    radius = columns.get(Parameter("radius", (), drawn.number, index))
    if radius is not None:
        yield radius, found.radial / table["radius"]
    levels = (
        (placement(table), drawn.placement, (drawn.number, index)),
        (placement(drawn.table), drawn.whole, (drawn.number, None)),
        (drawn.whole, Placement(), (None, None)),
    )
    turned_about = found.points - found.radial
    for place, after, owner in levels:
        parameters = (Parameter(key, at, *owner) for key, at in _PLACING)
        for parameter in filter(columns.__contains__, parameters):
            arm = after.inverse(turned_about) - place.translate
            match parameter:
                case ("scale", *_):
                    rate = (_turned(after, arm) + found.radial) / place.scale
                case ("rotate", *_):
                    rate = _turned(after, 1j * DEGREE * arm)
                case (_, (axis,), *_):
                    rate = _turned(after, np.full(len(arm), (1.0, 1j)[axis]))
            yield columns[parameter], rate


def _control_columns(table: Mapping[str, Any], site: int, index: int, columns: Mapping[Parameter, int]) -> Ints:
    """The columns of the coordinates of a stroke's points, then of its tangents: intp (m, 2), -1 for none."""
    kind = next(name for name in KINDS if name in table)
    keys: list[tuple[str, tuple[int, ...]]] = []
    if kind in ("point", "circle"):
        keys = [(kind, ())]
    elif kind not in ("path", "file"):
        keys = [(key, (k,)) for key in (kind, "tangents") for k in range(len(table.get(key, ())))]
    found = [[columns.get(Parameter(key, (*at, axis), site, index), -1) for axis in (0, 1)] for key, at in keys]
    return np.array(found, np.intp).reshape(-1, 2)
