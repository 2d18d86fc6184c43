"""An outline drawn apart from its copies: a stroke whose Voronoi tile is as near to it as tiles can be."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Final, NamedTuple

import numpy as np
import shapely
from shapely.geometry import Polygon

from voronoi_tiles.base.arrays import Complexes, from_plane, plane
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.escherization.goal_outline import GoalOutline, largest_part, ring_corners
from voronoi_tiles.escherization.group_placement import GroupPlacement
from voronoi_tiles.escherization.mirror_axis import MirrorAxis

APART: Final = 5e-3
"""How far the stroke keeps from the outline, and from copies; relative to the size. Less makes tiles of more and
smaller edges, and brings them nearer by less than a thousandth."""

_CORNERS: Final = 0.3
"""How far corners that are left out of the stroke may lie from it; relative to APART."""

_LEAST: Final = 2e-3
"""What is cut off, or kept, counts from this area on; relative to the outline's."""

_CONTESTED_MAX: Final = 24
"""How many of the areas that copies have in common are decided on, the largest; a count."""


class _Lens(NamedTuple):
    """An area that the outline has in common with a copy, by the copy's number; `back` is the same of that copy.

    What is the outline's there is the copy's `back`, the lens's image under the inverse: one of the two goes to the
    outline, the other is lost, or both are halved.
    """

    copy: int
    area: Polygon
    back: Polygon


def drawn_apart(silhouette: GoalOutline, placement: GroupPlacement, axis: MirrorAxis | None = None) -> Complexes:
    """The corners of a closed stroke inside the placed outline, whose copies keep apart: complex128 (n,).

    What the outline has in common with copies is taken from both, so that the edge between their tiles is the middle
    line of it, as it is that of what lies between them: all share alike. Where that would cut off a leg or a head, the
    outline has all of it, and loses all of what the copy has the same way, if more hangs together so. Of several parts
    the largest is the stroke; there is none where nothing is left. Where outline and copies are their own mirror images
    about an axis, in its place in the cell, so is the stroke: see MirrorAxis.completed.
    """
    apart = APART * silhouette.size
    points = placement.laid(silhouette.points, silhouette.centroid)
    own = Polygon(plane(points))
    maps = placement.copies(2.0 * silhouette.reach + 2.0 * apart)
    copies = [Polygon(plane(each(points))) for each in maps]
    near = [k for k, copy in enumerate(copies) if copy.distance(own) <= 2.0 * apart]
    around = {k: copies[k].buffer(apart) for k in near}
    inner = own.buffer(-apart)

    def left(kept: Iterable[_Lens]) -> Polygon:
        """The largest part of what is left where the outline has all of some lenses."""
        taken = dict(around)
        for lens in kept:
            taken[lens.copy] = taken[lens.copy].difference(lens.area.buffer(apart))
        return largest_part(inner.difference(shapely.union_all([*taken.values()])))

    stroke = left(())
    if inner.area - stroke.area > _LEAST * own.area:
        stroke = _decided(stroke, _lenses(own, [(k, maps[k], copies[k]) for k in near]), left, _LEAST * own.area, axis)
    if axis is None:
        return ring_corners(Polygon(stroke.exterior).simplify(_CORNERS * apart).exterior)
    half = axis.left_half(stroke)
    return np.zeros(0, complex) if half is None else axis.completed(half, _CORNERS * apart)


def _lenses(own: Polygon, copies: list[tuple[int, Isometry, Polygon]]) -> list[_Lens]:
    """All areas that the outline has in common with copies, the largest first; not those that are their own `back`."""
    lenses = []
    for number, copy, polygon in copies:
        for part in shapely.get_parts(own.intersection(polygon)):
            if part.area > _LEAST * own.area and part.geom_type == "Polygon":
                corners = from_plane(shapely.get_coordinates(part.exterior))
                # The inverse of a z + b, or of a conj(z) + b.
                moved = (corners - copy.b) / copy.a
                back = Polygon(plane(np.conj(moved) if copy.conj else moved))
                if part.intersection(back).area < 0.5 * part.area:
                    lenses.append(_Lens(number, part, back))
    return sorted(lenses, key=lambda lens: -lens.area.area)[:_CONTESTED_MAX]


def _decided(
    stroke: Polygon,
    lenses: list[_Lens],
    left: Callable[[Iterable[_Lens]], Polygon],
    least: float,
    axis: MirrorAxis | None,
) -> Polygon:
    """The stroke where the outline has all of those lenses that hold on to more, decided one after the other.

    About an axis a lens and its mirror image are decided on together.
    """
    kept: list[_Lens] = []
    for lens in lenses:
        both = _with_image(lens, lenses, axis)
        # Of a lens and the one that goes with it the copy can have one alone.
        if any(each in kept or _covers(other.back, each.area) for each in both for other in (*kept, *both)):
            continue
        larger = left([*kept, *both])
        # The lenses themselves are no gain: others are lost for them. What they hold on to is.
        if larger.area > stroke.area + sum(each.area.area for each in both) + least:
            kept, stroke = [*kept, *both], larger
    return stroke


def _with_image(lens: _Lens, lenses: list[_Lens], axis: MirrorAxis | None) -> list[_Lens]:
    """A lens and, where there is an axis, the one that is its mirror image, unless that is the same."""
    if axis is None:
        return [lens]
    image = Polygon(plane(axis.mirrored(ring_corners(lens.area.exterior))))
    return [lens, *(other for other in lenses if other is not lens and _covers(image, other.area))]


def _covers(one: Polygon, other: Polygon) -> bool:
    """Whether an area has more than half of another one."""
    return bool(one.intersection(other).area > 0.5 * other.area)
