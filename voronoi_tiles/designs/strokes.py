"""Strokes: curves as cubic Bezier pieces, and their flattening into polylines.

Every kind of curve is converted exactly to cubic Bezier pieces, complex128 of shape (k, 4), where one piece
ends at the very number at which the next starts; `flatten` then bisects all pieces at once until a proven
bound holds. Functions take points that are already checked (finite, of sane size) and raise DesignError,
with keys relative to the stroke, for what cannot be drawn.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import unit_at
from voronoi_tiles.base.tolerance import PIECES_MAX
from voronoi_tiles.paths.paths import LINE, QUAD, halves

ARC_SHARE = 1e-3
"""The share of the accuracy that the step from an elliptical arc to cubics may use."""

_PATH_REMEDY = 'Write SVG path data such as "M 1 1 C 2 3 4 3 5 1"'


def bezier_pieces(points: Complexes) -> Complexes:
    """A chain of cubic Bezier curves from its 3n + 1 control points, shape (n, 4).

    Raises DesignError for another count of points, and for a piece whose four points are all the same.
    """
    if len(points) < 4 or len(points) % 3 != 1:
        raise DesignError(
            f"a Bezier chain has 4, 7, 10, ... points, not {len(points)}",
            key="bezier",
            remedy="Give 3 n + 1 points: start, two controls, end, and three more for every further piece.",
        )
    pieces: Complexes = points[3 * np.arange(len(points) // 3)[:, None] + np.arange(4)]
    still = np.flatnonzero(~are_moving(pieces))
    if len(still):
        raise _zero_length(f"bezier[{3 * still[0]}]", "its four points are the same")
    return pieces


def hermite_pieces(points: Complexes, tangents: Complexes) -> Complexes:
    """The cubic Hermite curve through n points with n tangents, shape (n - 1, 4).

    A tangent is the derivative where the parameter runs from 0 to 1 over each piece. Raises DesignError
    where counts differ or where a piece stands still.
    """
    if len(points) != len(tangents):
        raise DesignError(
            f"{len(points)} points but {len(tangents)} tangents",
            key="tangents",
            remedy="Give one tangent for every point.",
        )
    start, end = points[:-1], points[1:]
    still = np.flatnonzero((start == end) & (tangents[:-1] == 0) & (tangents[1:] == 0))
    if len(still):
        raise _zero_length(f"hermite[{still[0] + 1}]", "the point is repeated without tangents")
    return np.stack([start, start + tangents[:-1] / 3.0, end - tangents[1:] / 3.0, end], axis=1)


def catmull_rom_pieces(points: Complexes, alpha: float = 0.5, closed: bool = False) -> Complexes:
    """The Catmull-Rom curve through n points: shape (n - 1, 4), or (n, 4) where closed.

    The knots are |distance|^alpha apart: 0 is uniform, 0.5 centripetal (no cusps or loops), 1 chordal. An
    open curve gets one more point at each end, the reflection of the second in the first. Source: Barry and
    Goldman 1988; Yuksel et al., "Parameterization and applications of Catmull-Rom curves", 2011. Raises
    DesignError where neighbouring points are the same (with the closing one, where closed).
    """
    refuse_repeats(points, closed, "catmull_rom")
    if closed:
        ring = np.concatenate([points[-1:], points, points[:2]])
    else:
        ring = np.concatenate([[2.0 * points[0] - points[1]], points, [2.0 * points[-1] - points[-2]]])
    legs = np.diff(ring)
    steps = np.abs(legs) ** alpha
    before, after = steps[:-1], steps[1:]
    # The sum of the outer terms first: the tangent of the reversed curve is then the same number with the other sign.
    tangents = (legs[:-1] / before + legs[1:] / after) - (ring[2:] - ring[:-2]) / (before + after)
    start, end, step = ring[1:-2], ring[2:-1], steps[1:-1]
    return np.stack([start, start + tangents[:-1] * step / 3.0, end - tangents[1:] * step / 3.0, end], axis=1)


def bspline_pieces(points: Complexes, closed: bool = False) -> Complexes:
    """The uniform cubic B-spline of n control points: shape (n - 3, 4), or (n, 4) where closed.

    The open curve is not clamped: it starts near the second control point, at (p0 + 4 p1 + p2) / 6, and
    ends near the last but one; repeat an end point three times to reach it. Raises DesignError for fewer
    than 4 points (3 where closed).
    """
    least = 3 if closed else 4
    if len(points) < least:
        raise DesignError(
            f"a{' closed' if closed else 'n open'} B-spline needs at least {least} points, not {len(points)}",
            key="bspline",
            remedy="Add control points.",
        )
    pieces = bspline_controls(points, closed)
    moving = are_moving(pieces)
    if not moving.any():
        raise _zero_length("bspline", "all points are the same")
    kept: Complexes = pieces[moving]
    return kept


def bspline_controls(points: Complexes, closed: bool) -> Complexes:
    """The pieces of `bspline_pieces`, those that stand still among them."""
    ring = np.concatenate([points, points[:3]]) if closed else points
    knots = ((ring[:-2] + ring[2:]) + 4.0 * ring[1:-1]) / 6.0
    first = (2.0 * ring[1:-2] + ring[2:-1]) / 3.0
    second = (ring[1:-2] + 2.0 * ring[2:-1]) / 3.0
    if closed:
        knots[-1] = knots[0]
    return np.stack([knots[:-1], first, second, knots[1:]], axis=1)


def are_moving(pieces: Complexes) -> NDArray[np.bool_]:
    """Whether the four points of each piece are not all the same: bool (k,)."""
    moving: NDArray[np.bool_] = (pieces != pieces[:, :1]).any(axis=1)
    return moving


def path_pieces(data: str, accuracy: float) -> Complexes:
    """The drawn pieces of SVG path data, in drawing order: shape (k, 4).

    Coordinates are taken as they are: y runs up, as everywhere in a design file, so that data copied from an SVG file
    show their mirror image. Straight pieces have their inner control points on their ends (p, p, q, q); quadratic
    curves are raised exactly; elliptical arcs are replaced by cubics within ARC_SHARE * `accuracy` of them. Raises
    DesignError, naming the character, where the data break the grammar, and where nothing, or a mere dot, is drawn.
    """
    from voronoi_tiles.formats.pen import PathPen
    from voronoi_tiles.formats.shapes import DrawingError
    from voronoi_tiles.formats.svg.pathdata import draw_path

    pen = PathPen(ARC_SHARE * accuracy)
    try:
        draw_path(pen, data, remedy=f"{_PATH_REMEDY}.")
    except DrawingError as error:
        raise DesignError(error.message, remedy=error.remedy) from None
    curves = pen.curves()
    if not len(curves.kind):
        raise DesignError(
            "the path draws nothing", remedy=f"{_PATH_REMEDY}; an isolated point is a stroke {{ point = [x, y] }}."
        )
    _, dots = pen.dots(curves)
    if len(dots):
        place = f"[{dots[0].real:g}, {dots[0].imag:g}]"
        raise DesignError(
            f"zero length: the path goes nowhere at {place}",
            remedy=f"Take it out, or draw an isolated point, a stroke {{ point = {place} }}.",
        )
    straight, bent = curves.kind == LINE, curves.kind == QUAD
    inner = []
    for point, control in zip((curves.start, curves.end), curves.control, strict=True):
        sums = point + 2.0 * curves.control[0]
        # Part by part: a complex quotient is rounded twice.
        raised = (sums.view(np.float64) / 3.0).view(np.complex128)
        inner.append(np.where(straight, point, np.where(bent, raised, control)))
    return np.stack((curves.start, *inner, curves.end), axis=1)


def circle_polyline(center: complex, radius: float, accuracy: float) -> Complexes:
    """A circle as a closed regular polygon with its vertices on it, the first (and last) at angle 0.

    The number of sides is the smallest multiple of 12 with a sagitta of at most `accuracy`: the rotations
    and mirrors of every wallpaper group, at multiples of 30 degrees, map such a polygon onto itself. Raises
    DesignError where that needs more than PIECES_MAX sides.
    """
    half = math.asin(min(1.0, math.sqrt(accuracy / (2.0 * radius))))  # sagitta = 2 r sin(pi / 2n)^2
    if not half > math.pi / (2.0 * PIECES_MAX):
        raise _too_fine(accuracy)
    twelfths = max(1, math.ceil(math.pi / (24.0 * half)))
    # The division may round across a whole number: settle the count by the sagitta itself.
    while twelfths > 1 and _sagitta(radius, 12 * (twelfths - 1)) <= accuracy:
        twelfths -= 1
    while _sagitta(radius, 12 * twelfths) > accuracy:
        twelfths += 1
    return regular_polygon(center, radius, 12 * twelfths)


def regular_polygon(center: complex, radius: float, sides: int) -> Complexes:
    """A closed regular polygon, its first vertex, which is its last, at angle 0; `sides` is a multiple of 12."""
    unit = _unit_polygon(sides)
    polygon = np.empty(len(unit) + 1, dtype=np.complex128)
    polygon[:-1] = center + radius * unit
    polygon[-1] = polygon[0]
    return polygon


def _sagitta(radius: float, sides: int) -> float:
    return 2.0 * radius * math.sin(math.pi / (2.0 * sides)) ** 2


def _unit_polygon(sides: int) -> Complexes:
    """The vertices of a regular polygon, sides a multiple of 12: exactly symmetric about axes and diagonals."""
    quarter = sides // 4
    k = np.arange(sides)
    within = k % quarter
    # The first 45 degrees, then the mirror at 45 degrees, then quarter turns.
    mirrored = 2 * within > quarter
    angle = np.where(mirrored, quarter - within, within) * (2.0 * math.pi / sides)
    c, s = np.cos(angle), np.sin(angle)
    third = 3 * np.where(mirrored, quarter - within, within) == quarter  # 30 degrees, where the sine is 1/2
    c[third], s[third] = unit_at(30.0).real, unit_at(30.0).imag
    diagonal = 2 * within == quarter
    c[diagonal] = s[diagonal] = math.sqrt(0.5)
    x, y = np.where(mirrored, s, c), np.where(mirrored, c, s)
    turn = k // quarter
    unit = np.empty(sides, dtype=np.complex128)
    unit.real = np.choose(turn, [x, -y, -x, y])
    unit.imag = np.choose(turn, [y, x, -y, -x])
    return unit + 0.0  # no negative zeros


def refuse_repeats(points: Complexes, closed: bool, key: str) -> None:
    """Raise DesignError, at "key[3]", where two neighbouring points of a stroke are the same."""
    same = np.flatnonzero(points[1:] == points[:-1])
    if len(same):
        raise _zero_length(f"{key}[{same[0] + 1}]", "the point is the same as the one before")
    if closed and points[0] == points[-1]:
        raise DesignError(
            "a closed stroke repeats its first point at the end",
            key=f"{key}[{len(points) - 1}]",
            remedy="Leave the last point out; closed = true joins the ends.",
        )


def _zero_length(key: str, why: str) -> DesignError:
    return DesignError(
        f"zero length: {why}", key=key, remedy='Take it out, or draw an isolated point, a stroke of the kind "point".'
    )


def _too_fine(accuracy: float) -> DesignError:
    """The error for an accuracy that would need more than PIECES_MAX segments."""
    return DesignError(
        f"flattening to within {accuracy:g} would take more than {PIECES_MAX:,} segments",
        remedy="Write a larger tolerance for the site, or check the size of the stroke.",
    )


class Flattening(NamedTuple):
    """Chords of cubic Bezier pieces, in order along them.

    `ends` is complex128 (n, 2), `counts` the number of chords of each piece, intp (k,), and `places` the parameter at
    which each chord begins on its piece, from 0 up to, not including, 1: float64 (n,). It ends where the next begins.
    """

    ends: Complexes
    counts: NDArray[np.intp]
    places: NDArray[np.float64]


def flatten(pieces: Complexes, accuracy: float) -> Flattening:
    """Flatten cubic Bezier pieces to chords within `accuracy` of the curve, and the curve within it of them.

    A site's segments cost time, so each part of a curve takes as few as it needs; `paths.conversion` cuts a curve into
    equal steps, whose points depend on nothing but their count.

    `pieces` is complex128 of shape (k, 4), `accuracy` positive and in the same units. All pieces are bisected together
    (de Casteljau at 1/2, whose rounding is the same from both ends: a reversed curve gives the reversed points) until
    each satisfies the bound of `is_flat`. Raises DesignError beyond PIECES_MAX.
    """
    leaves = [pieces[:0, [0, 3]]]
    owners = [np.empty(0, dtype=np.intp)]
    places = [np.empty(0)]
    total = len(pieces)
    owner = np.arange(total, dtype=np.intp)
    place = np.zeros(len(pieces))
    width = 1.0
    count = 0
    while len(pieces):
        flat = is_flat(pieces, accuracy)
        leaves.append(pieces[flat][:, [0, 3]])
        owners.append(owner[flat])
        places.append(place[flat])
        bent = ~flat
        pieces, owner, place = pieces[bent], owner[bent], place[bent]
        count += len(leaves[-1])
        if count + 2 * len(pieces) > PIECES_MAX or width < 2.0**-50:
            raise _too_fine(accuracy)
        pieces = halves(pieces.T).reshape(4, -1).T  # all first halves, then all second ones
        width /= 2.0
        owner = np.concatenate([owner, owner])
        place = np.concatenate([place, place + width])
    owner = np.concatenate(owners)
    begin = np.concatenate(places)
    order = np.lexsort((begin, owner))
    return Flattening(np.concatenate(leaves)[order], np.bincount(owner, minlength=total), begin[order])


def is_flat(pieces: Complexes, accuracy: float) -> NDArray[np.bool_]:
    """Whether each piece and its chord are proven to be within `accuracy` of each other.

    With d1 = p1 - (2 p0 + p3) / 3 and d2 = p2 - (p0 + 2 p3) / 3 the curve leaves the evenly run chord by
    exactly 3 t (1 - t) ((1 - t) d1 + t d2), hence by at most 3/4 max(|d1|, |d2|). Where both inner control
    points project into the chord, the curve does too, and only the parts of d1 and d2 across the chord
    count: 3/4 max(|h1|, |h2|), or 4/9 of it where they lie on different sides. A piece that starts where it
    ends is never flat: it would vanish.
    """
    p0, p1, p2, p3 = pieces.T
    chord = p3 - p0
    d1 = p1 - (2.0 * p0 + p3) / 3.0
    d2 = p2 - (2.0 * p3 + p0) / 3.0
    off = 0.75 * np.maximum(np.abs(d1), np.abs(d2))

    length = np.abs(chord)
    start, end = p1 - p0, p2 - p3
    h1 = start.real * chord.imag - start.imag * chord.real
    h2 = end.real * chord.imag - end.imag * chord.real
    factor = np.where(h1 * h2 < 0.0, 4.0 / 9.0, 0.75)
    across = factor * np.maximum(np.abs(h1), np.abs(h2))
    inside = (
        (_dot(start, chord) >= 0.0)
        & (_dot(end, chord) <= 0.0)
        & (_dot(p2 - p0, chord) >= 0.0)
        & (_dot(p3 - p1, chord) >= 0.0)
    )
    still = (p0 == p1) & (p1 == p2) & (p2 == p3)
    flat: NDArray[np.bool_] = ((off <= accuracy) | (inside & (across <= accuracy * length))) & (chord != 0) | still
    return flat


def _dot(u: Complexes, v: Complexes) -> NDArray[np.float64]:
    product: NDArray[np.float64] = u.real * v.real + u.imag * v.imag
    return product


def polylines(pieces: Complexes, accuracy: float) -> list[Complexes]:
    """Flatten pieces (as `flatten`) and join them: one polyline per run of pieces that continue each other."""
    chords, counts, _ = flatten(pieces, accuracy)
    breaks = np.flatnonzero(pieces[1:, 0] != pieces[:-1, 3]) + 1
    ends = np.cumsum(counts)
    runs: Sequence[Complexes] = np.split(chords, ends[breaks - 1])
    return [np.append(run[:, 0], run[-1, 1]) for run in runs]
