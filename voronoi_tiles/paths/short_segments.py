"""Segments that are hardly any: too short to be seen, and arcs too flat to be told from lines. Offsets leave both.

Where two edges meet at a small angle, their offsets are joined by a short arc about the corner. Did both go on along
their tangents instead, they would meet at a tip. From an arc of the radius d that turns by a it is
d (1 / cos(a / 2) - 1) away, about d a^2 / 8: a sixth of a micrometre, where the arc is 10 micrometres long and turns by
0.13. So short arcs go, and the edges beside them are led to tips.

What this moves: let T be the triangle of the short segment's ends and the tip. The segment is convex and lies in T. So
the sides of T at the tip are nowhere further from it, nor it from them, than the tip is, which is h: Hausdorff
distances of convex sets are those of their boundaries, and the distance from one is a convex function. An edge of the
curvature k that is led along its tangent by s ends k s^2 / 2 off its circle. It keeps its other end and the point that
was its middle, and two circles through two points are apart, to first order, in proportion to the distance from the
line through these: the new edge leaves the old circle by no more than at the tip, and the side of T by k s^2 / 2 too.
Together nothing moves by more than h + k s^2.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, next_in_ring, offsets_of
from voronoi_tiles.base.components import components
from voronoi_tiles.paths.paths import ARC, LINE, Paths
from voronoi_tiles.paths.segments import Circles, tangent_at

_INSIDE: Final = 1e-6
"""How far a short segment may stick out of its triangle, radians: it joins edges smoothly but for rounding, and may go
on straight from one of them."""

_LED: Final = 2.0
"""Half of what an arc may turn by to be led to a tip; radians. Up to 2 pi / 3 no other point of it is as far from the
line through its start and its middle as its end is."""


def without_short_segments(rings: Paths, length: float, deviation: float) -> Paths:
    """The same closed paths without segments shorter than `length` whose loss moves nothing by more than `deviation`.

    One whose neighbours are longer goes where these, led along their tangents, meet at a tip that is near enough. Of
    the others, those go that are shorter than `deviation`, several in a row where they are so together: what they
    joined meets in their middle, so that ends move by half of it at most. One that then has longer neighbours goes to
    a tip for which the other half is enough. What was the middle of an arc stays on it.
    What a ring loses depends neither on where it starts nor on its direction. One that would keep fewer than two
    segments stays. Raises ValueError for open paths.
    """
    if not rings.closed.all():
        raise ValueError("only closed paths can lose short segments")
    length = max(length, deviation)
    left = _shortened(rings, length, tip=deviation, middle=deviation)
    return _shortened(left, length, tip=deviation / 2, middle=0.0)


def _shortened(rings: Paths, length: float, *, tip: float, middle: float) -> Paths:
    """Rings without what goes at once: to tips that move nothing by more than `tip`, to middles below `middle`."""
    lengths = rings.lengths
    short = lengths < length
    if not short.any():
        return rings
    everything, after = np.arange(len(short)), next_in_ring(rings.offsets)
    before = np.empty_like(after)
    before[after] = everything
    alone = np.flatnonzero(short & ~short[before] & ~short[after])
    place, moved = _tips(rings, before[alone], alone, after[alone])
    led = np.zeros(len(short), np.bool_)
    led[alone] = moved <= tip
    tiny = lengths < middle
    together = np.flatnonzero(tiny & tiny[after])
    row = components(len(short), together, after[together])
    gone = led | (tiny & (np.bincount(row, lengths, len(short))[row] < middle))
    gone &= (np.bincount(rings.owner[~gone], minlength=len(rings)) >= 2)[rings.owner]
    first, last = np.flatnonzero(gone & ~gone[before]), np.flatnonzero(gone & ~gone[after])
    first, last = first[np.argsort(row[first])], last[np.argsort(row[last])]
    meeting = (rings.start + rings.end) / 2
    meeting[first] = (rings.start[first] + rings.end[last]) / 2
    meeting[alone] = np.where(led[alone], place, meeting[alone])
    start, end = rings.start.copy(), rings.end.copy()
    start[after[last]] = end[before[first]] = meeting[first]
    bent = np.unique(np.concatenate((before[first], after[last])))
    bent = bent[rings.kind[bent] == ARC]
    control = rings.control.copy()
    control[bent, 0] = _middles(start[bent], control[bent, 0], end[bent])
    return straightened(_of_segments(replace(rings, start=start, end=end, control=control), ~gone), 0.0)


def without_points(paths: Paths) -> Paths:
    """The same paths of LINEs and ARCs without segments of no length; a path that has no others is left out."""
    long = paths.start != paths.end
    return paths if long.all() else _of_segments(paths, long)


def _of_segments(paths: Paths, which: Bools) -> Paths:
    """The paths, of some of their segments; those that have some."""
    counts = np.bincount(paths.owner[which], minlength=len(paths))
    return Paths(
        start=paths.start[which],
        end=paths.end[which],
        control=paths.control[which],
        kind=paths.kind[which],
        offsets=offsets_of(counts[counts > 0]),
        closed=paths.closed[counts > 0],
    )


def straightened(paths: Paths, tolerance: float) -> Paths:
    """The same paths, with ARCs that leave their chord by no more than `tolerance`, or have no length, as LINEs."""
    sagitta = np.abs(paths.control[:, 0] - (paths.start + paths.end) / 2)
    flat = (paths.kind == ARC) & ((sagitta <= tolerance) | (paths.start == paths.end))
    kind = np.where(flat, LINE, paths.kind).astype(np.uint8)
    return replace(paths, control=np.where(flat[:, None], 0, paths.control), kind=kind)


def _tips(rings: Paths, before: Ints, short: Ints, after: Ints) -> tuple[Complexes, Floats]:
    """Where the tangents of what short segments join meet, and how far edges led there move; infinite for no tip."""
    here, there = rings.end[before], rings.start[after]
    count = len(short)
    arriving, leaving = tangent_at(rings, before, np.ones(count)), tangent_at(rings, after, np.zeros(count))
    chord = there - here
    # The angles at the ends of the chord, > 0 on the side of the tip, and of the segment.
    turn = np.angle(leaving * arriving.conj())
    side = np.where(turn < 0, -1.0, 1.0)
    first, last = side * np.angle(chord * arriving.conj()), side * np.angle(leaving * chord.conj())
    edges = [Circles.of(rings, segments) for segments in (before, short, after)]
    bulge = side * edges[1].half
    usable = (np.minimum(first, last) > -_INSIDE) & (first + last > 0) & (first + last < np.pi / 2)
    usable &= (bulge > -_INSIDE) & (bulge < np.minimum(first, last) + _INSIDE)
    usable &= np.maximum(np.abs(edges[0].half), np.abs(edges[2].half)) <= _LED
    with np.errstate(divide="ignore", invalid="ignore"):
        # The law of sines, in the triangle of the ends and the tip.
        ahead, back = (np.abs(chord) * np.sin(angle) / np.sin(np.abs(turn)) for angle in (last, first))
        place = here + arriving * ahead
        led = np.maximum(np.abs(edges[0].curvature) * ahead**2, np.abs(edges[2].curvature) * back**2)
        moved = edges[1].distance(place) + led
    return place, np.where(usable, moved, np.inf)


def _middles(start: Complexes, over: Complexes, end: Complexes) -> Complexes:
    """The middles of the arcs from `start` to `end` over other points of them."""
    # The angle at the circumference is half of that at the centre.
    bulge = np.tan(np.angle((end - over) * (over - start).conj()) / 2)
    return np.asarray((start + end) / 2 - 0.5j * bulge * (end - start), np.complex128)
