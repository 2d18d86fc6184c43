"""Blender's splines and freehand strokes, as strokes of a site."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Final, Literal, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats
from voronoi_tiles.designs.drawn_strokes import Stroke, bezier, catmull_rom, point, polyline

SplineKind = Literal["bezier", "poly", "nurbs", "freehand"]

NURBS_STEPS: Final = 16
"""Points of a NURBS curve for each of its control points; a count: Blender's own default is 12."""


class DrawnSpline(NamedTuple):
    """A spline or a freehand stroke in the plane of the group.

    `points` are complex128 (n,), `left` and `right` the handles of a Bezier spline, else empty. A NURBS spline has an
    `order`, `weights` (n,) and `knots`; what is drawn by hand is a row of many points.
    """

    kind: SplineKind
    points: Complexes
    closed: bool = False
    left: Complexes = np.zeros(0, np.complex128)
    right: Complexes = np.zeros(0, np.complex128)
    order: int = 0
    weights: Floats = np.zeros(0)
    knots: Floats = np.zeros(0)


def strokes_of(splines: Iterable[DrawnSpline], smoothing: float) -> list[Stroke]:
    """The strokes that splines are: Bezier splines exactly, polylines without repeated points.

    What is drawn by hand, and NURBS from corner to corner, are Catmull-Rom curves through some of their points: the
    others are within `smoothing` (in units) of the chords between these. NURBS of order 2 are polylines.
    """
    return [stroke for spline in splines for stroke in _stroke(spline, smoothing)]


def _stroke(spline: DrawnSpline, smoothing: float) -> list[Stroke]:
    """The stroke of a spline; none where it has no points."""
    points, closed = spline.points, spline.closed
    if spline.kind == "bezier":
        return _bezier(spline)
    if spline.kind == "nurbs":
        pieces = _along_nurbs(spline) if len(points) >= spline.order else []  # Blender draws nothing of less
        return [stroke for piece in pieces for stroke in _smooth(piece, closed and len(pieces) == 1, smoothing)]
    if spline.kind == "freehand":
        return _smooth(points, closed, smoothing)
    points, closed = _without_repeats(points, closed)
    return [polyline(points, closed=closed)] if len(points) > 1 else [point(complex(place)) for place in points]


def _smooth(points: Complexes, closed: bool, smoothing: float) -> list[Stroke]:
    """A smooth curve through some of many points."""
    points, closed = _without_repeats(points, closed)
    if len(points) < 2:
        return [point(complex(place)) for place in points]
    kept = points[_simplified(points, closed, smoothing)]
    return [catmull_rom(kept, closed=closed)] if len(kept) > 2 else [polyline(kept)]


def _bezier(spline: DrawnSpline) -> list[Stroke]:
    """A Bezier spline: its own control points, without the curves that are a single point."""
    starts = spline.points if spline.closed else spline.points[:-1]
    ends = np.roll(spline.points, -1) if spline.closed else spline.points[1:]
    curves = np.column_stack((starts, spline.right[: len(starts)], np.roll(spline.left, -1)[: len(starts)], ends))
    curves = curves[(curves != curves[:, :1]).any(axis=1)]
    if not len(curves):
        return [point(complex(place)) for place in spline.points[:1]]
    return [bezier(np.append(curves[:, :3].ravel(), curves[-1, 3]))]


def _without_repeats(points: Complexes, closed: bool) -> tuple[Complexes, bool]:
    """Points none of which is the one before, and whether they still close a curve."""
    if not len(points):
        return points, False
    kept = points[np.append(True, points[1:] != points[:-1])]
    if closed and len(kept) > 1 and kept[0] == kept[-1]:
        kept = kept[:-1]
    return kept, closed and len(kept) > 2


def _simplified(points: Complexes, closed: bool, tolerance: float) -> Bools:
    """Which points are kept so that all are within a tolerance of the chords (Ramer 1972, Douglas and Peucker 1973)."""
    kept = np.zeros(len(points), np.bool_)
    kept[[0, -1]] = True
    if closed:
        kept[np.abs(points - points[0]).argmax()] = True
    ends = np.flatnonzero(kept).tolist()
    spans = list(pairwise(ends))
    while spans:
        first, last = spans.pop()
        if last - first < 2:
            continue
        chord = points[last] - points[first]
        inner = points[first + 1 : last] - points[first]
        square = abs(chord) ** 2
        t = (inner * chord.conjugate()).real / square if square > 0.0 else np.zeros(len(inner))
        away = np.abs(inner - np.clip(t, 0.0, 1.0) * chord)
        k = int(away.argmax())
        if away[k] > tolerance:
            kept[first + 1 + k] = True
            spans += [(first, first + 1 + k), (first + 1 + k, last)]
    return kept


def _along_nurbs(spline: DrawnSpline) -> list[Complexes]:
    """Points along a NURBS curve, by the recursion of Cox and de Boor for rational splines.

    There is one at each knot: a row of points from one to the next of those at which the curve may have a corner. Of a
    closed curve that has none, it is one row without its end, which is where it begins.
    """
    degree = spline.order - 1
    points, weights = spline.points, spline.weights
    if spline.closed:
        points, weights = np.append(points, points[:degree]), np.append(weights, weights[:degree])
    knots, count = spline.knots, len(points)
    breaks, repeats = np.unique(knots[degree : count + 1], return_counts=True)
    steps = -(-NURBS_STEPS * len(spline.points) // (len(breaks) - 1))
    t = np.append(np.linspace(breaks[:-1], breaks[1:], steps, endpoint=False, axis=1), breaks[-1])
    # The end is that of the last span that is longer than nothing.
    last = int(np.searchsorted(knots, breaks[-1])) - 1
    span = np.clip(np.searchsorted(knots, t, side="right") - 1, degree, last)
    index = span[:, None] + np.arange(-degree, 1)
    homogeneous = np.stack((points * weights, weights.astype(np.complex128)), axis=-1)[index]
    for level in range(1, degree + 1):
        for j in range(degree, level - 1, -1):
            low, high = knots[index[:, j]], knots[index[:, j] + degree + 1 - level]
            part = (t - low) / np.where(high > low, high - low, 1.0)
            homogeneous[:, j] = (1 - part)[:, None] * homogeneous[:, j - 1] + part[:, None] * homogeneous[:, j]
    along = homogeneous[:, degree, 0] / homogeneous[:, degree, 1]
    corners = (np.flatnonzero(repeats[1:-1] >= degree) + 1) * steps
    pieces = [along[first : last + 1] for first, last in pairwise([0, *corners.tolist(), len(along) - 1])]
    if not spline.closed:
        return pieces
    if len(pieces) == 1:
        return [along[:-1]]
    if np.count_nonzero(knots == knots[degree]) < degree:  # it begins within a piece
        return [*pieces[1:-1], np.concatenate((pieces[-1], pieces[0][1:]))]
    return pieces


def nurbs(points: Complexes, weights: Floats, order: int, *, closed: bool, clamped: bool, bezier: bool) -> DrawnSpline:
    """A NURBS spline as Blender draws it.

    It is the row of its control points where it is of order 2 (or has one point), where these do not make whole pieces
    of a closed Bezier curve, and where they make none at all.
    """
    row = DrawnSpline("poly", points, closed)
    if order < 3 or (closed and bezier and len(points) % (order - 1)):
        return row
    knots = nurbs_knots(len(points), order, closed=closed, clamped=clamped, bezier=bezier)
    if knots[order - 1] == knots[len(points)]:
        return row
    return DrawnSpline("nurbs", points, closed, order=order, weights=weights, knots=knots)


def nurbs_knots(count: int, order: int, *, closed: bool, clamped: bool, bezier: bool) -> Floats:
    """The knots that Blender gives a NURBS spline of so many points; `clamped` and `bezier` are its two options."""
    inner = order - 1 if bezier else 1
    head = order - closed if clamped else min(2, inner) if bezier else 1
    tail = order - closed if clamped else 0
    total = count + order + (order - 1 if closed else 0)
    values: list[float] = [0.0] if clamped and closed else []
    current, left = float(len(values)), head
    while len(values) < total - tail:
        values.append(current)
        left -= 1
        if left == 0:
            current, left = current + 1.0, inner
    return np.array(values + [current] * tail)
