"""Designs whose tiles come near to an outline: `fit`."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, Final, Literal, NamedTuple

from shapely.geometry import Polygon

from voronoi_tiles.base.arguments import flag, function, number, texts, whole_number
from voronoi_tiles.base.arrays import plane
from voronoi_tiles.base.errors import ArgumentError, SchedulerError
from voronoi_tiles.base.values import shown
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.enclosed import ENCLOSED
from voronoi_tiles.escherization.area_transform import AreaTransform
from voronoi_tiles.escherization.closed_design import DIGITS, MIRRORED_DIGITS, closed_design, tiled
from voronoi_tiles.escherization.covering import overlap_bound
from voronoi_tiles.escherization.drawn_apart import drawn_apart
from voronoi_tiles.escherization.fewer_corners import DISTANCE_STEP, fewer_corners
from voronoi_tiles.escherization.goal_outline import GoalOutline, ring_corners
from voronoi_tiles.escherization.group_placement import GroupPlacement
from voronoi_tiles.escherization.mirror_axis import MIRRORED, MirrorAxis, likeness, mirrored_outlines
from voronoi_tiles.escherization.mirror_placements import mirror_lines, mirror_rows
from voronoi_tiles.escherization.outline_distance import largest_distance, overlap
from voronoi_tiles.escherization.placement_rows import PlacementRows
from voronoi_tiles.escherization.polishing import FoundPlacement, found_placements, polished
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.parallel.block_runner import Block, LostBlock, Result
from voronoi_tiles.parallel.blocks import run_blocks
from voronoi_tiles.tiling import Tiling

Strokes = Literal["few", "outline"]

_EACH: Final = 2
"""How many designs of one group there are at most, where more groups are looked in than designs are kept; a count."""

_WIDE: Final = 6
"""So many placements are led on at least, and up to twice as many at a time, however few designs are kept; a count."""

_SAME: Final = 2e-4
"""Placements of a group whose bounds differ by less are one, or images of each other; a share."""

_GAIN: Final = 0.03
"""How much more a tile may overlap once its placement is led on by areas. In 26 of 30 animals none gained more."""

_ALIKE: Final = 0.98
"""Tiles that lie so much over each other, in the outline, are one for the eye; an overlap. Those of other placements
seldom have more than 0.97."""

_AS_GOOD: Final = 1e-3
"""A tile that is its own mirror image stands for others that are alike and overlap by so much more."""

_MIRRORED: Final = 4
"""How many placements with such tiles are led on at least, where the outline is its own mirror image; a count."""

WITHIN: Final = 0.005
"""How far the tile of few strokes may be from that of the whole outline, where nothing else is said; relative to the
side of a square of its area."""


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """A design whose tile comes near to an outline.

    `overlap` is the area that tile and outline have in common over that of their union, and `bound` the most that any
    tile of the group has in this cell and place; `distance` is how far they are from each other at most, in
    millimetres. `silhouette` is the given outline without corners that make no difference, `outline` the same where the
    design has it, and `placement` how it came there.
    """

    tiling: Tiling
    silhouette: GoalOutline
    placement: GroupPlacement
    overlap: float
    bound: float
    distance: float
    _axis: MirrorAxis | None = None

    def __repr__(self) -> str:
        return f"<Fit in {self.group}: overlap {self.overlap:.4f}, within {self.distance:.3g} mm>"

    @property
    def design(self) -> Design:
        """The design, in millimetres."""
        return self.tiling.design

    @property
    def group(self) -> str:
        """The name of its wallpaper group."""
        return self.design.group.name

    @property
    def symmetric(self) -> bool:
        """Whether stroke and tile are their own mirror images, to the digits of the stroke's corners."""
        return self._axis is not None

    @property
    def corners(self) -> int:
        """How many corners its stroke has."""
        return len(self.design.noded[0].segments)

    @property
    def neighbours(self) -> int:
        """How many copies share an edge with the tile."""
        return len(self.tiling[0].outline.neighbours)

    @property
    def outline(self) -> Polygon:
        """The given outline where it lies in the design, as a shapely polygon."""
        return _outline(self.silhouette, self.placement)

    @cached_property
    def tile_as_drawn(self) -> Polygon:
        """The tile where it lies in the outline as that was given, as a shapely polygon."""
        corners = ring_corners(self.tiling[0].to_shapely(accuracy=1e-3 * self.silhouette.size).exterior)
        return Polygon(plane(self.placement.taken_back(corners, self.silhouette.centroid)))

    def with_fewer_corners(self, within: float) -> Fit:
        """The fit with a stroke of fewer corners, its tile nowhere further than `within` millimetres from this one's.

        It is this one where there is no such stroke.
        """
        tiling = fewer_corners(self.tiling, self.silhouette.size, within, self._axis)
        return self if tiling is None else _measured(tiling, self.silhouette, self.placement, self.bound, self._axis)


def fit(
    outline: Any,
    *,
    groups: str | Iterable[str] | None = None,
    keep: int = 8,
    mirrored: bool = True,
    symmetric: bool = False,
    strokes: Strokes = "few",
    within: float | None = None,
    name: str = "fit",
    seed: int = 0,
    workers: int | None = 1,
    scheduler: str | None = None,
    progress: Callable[[float, float], None] | None = None,
    found: Callable[[Fit], object] | None = None,
) -> list[Fit]:
    """Designs whose tiles come nearest to an outline, in millimetres: the nearest first, `keep` of them at most.

    `outline` is a shapely polygon, anything with its interface, such as a Tile, or the corners of a closed line.
    `groups` are those to look in; without them all whose tiles are not the same polygon whatever is drawn. With
    `mirrored` False only those are, whose copies are never mirror images. Where the outline is its own mirror image, or
    nearly, at least one of several tiles is so exactly, if there is one in the groups; with `symmetric` all are, and
    other outlines are refused.

    `strokes` are an "outline" drawn a little smaller, or "few": a closed stroke of fewer corners, whose tile is within
    `within` millimetres of that one's (without it, a two-hundredth of the side of a square of the outline's area). The
    same `seed`, from 0, gives the same designs, whatever the number of `workers`; None takes all processors. `found` is
    told each design as soon as it is made, in any order.

    Raises ArgumentError for an outline that crosses itself, has holes or no area, and for groups that are none.
    """
    function("progress", progress)
    function("found", found)
    silhouette = GoalOutline.of(outline)
    names = _groups(groups, mirrored=flag("mirrored", mirrored))
    goals = [_Goal(*each) for each in mirrored_outlines(silhouette)]
    if flag("symmetric", symmetric):
        _check_symmetric(silhouette, goals, names)
    else:
        goals = [_Goal(silhouette), *goals]
    count = whole_number("keep", keep, "Give a number of designs.", least=1)
    if strokes not in ("few", "outline"):
        raise ArgumentError(f"`strokes` {shown(strokes)} cannot be", remedy='Give "few" or "outline".')
    near = WITHIN * silhouette.size if within is None else number("within", within, "Give millimetres.", least=1e-6)
    seed = whole_number("seed", seed, "Give a whole number from 0.", least=0)
    phases = _Phases(workers, scheduler, progress)
    seen = phases.run(partial(_looked, seed), [(goal, group) for goal in goals for group in names], 0.5)
    ordered = sorted((each for row in seen for each in row), key=lambda each: -each.found.bound)
    axes = [goal.axis for goal in goals if goal.axis is not None]
    best = _best(phases, partial(_made, silhouette, name), ordered, count, len(names), axes)
    if strokes == "few":
        best = phases.run(partial(_with_fewer_corners, near), best, 1.0, found)
    elif found is not None:
        for each in best:
            found(each)
    if progress is not None:
        progress(1.0, 1.0)
    return sorted(best, key=lambda each: -each.overlap)


class _Goal(NamedTuple):
    """What is placed: the outline, or one that is nearly that and its own mirror image about an axis."""

    silhouette: GoalOutline
    axis: MirrorAxis | None = None


class _Found(NamedTuple):
    """A placement that was found for it."""

    goal: _Goal
    found: FoundPlacement


def _looked(seed: int, block: tuple[_Goal, str]) -> list[_Found]:
    """The placements that are found in a group; where there is an axis, those that keep mirror images."""
    goal, name = block
    unit, group = goal.silhouette.unit, GROUPS[name]
    if goal.axis is None:
        among = [PlacementRows.everywhere(group, unit.width)]
    else:
        among = mirror_rows(group, goal.axis.angle, unit.width)
    if not among:
        return []
    transform = AreaTransform.of(unit)
    return [_Found(goal, found) for rows in among for found in found_placements(unit, rows, transform, seed)]


def _best(
    phases: _Phases,
    making: Callable[[_Found], Fit | None],
    found: list[_Found],
    count: int,
    groups: int,
    axes: Sequence[MirrorAxis],
) -> list[Fit]:
    """So many different fits of whole outlines, those that overlap most first; `found` are in their order."""
    most = max(_EACH, math.ceil(count / groups))
    made: list[Fit] = []
    best: list[Fit] = []
    symmetric = [each for each in found if each.goal.axis is not None][:_MIRRORED]
    while found and len(best) < count:
        # Those that may be among the best, once they are led on, and more where many of them were the same.
        wide = max(count, _WIDE)
        limit = found[min(wide, len(found)) - 1].found.bound - _GAIN
        tried = [each for each in found if each.found.bound >= limit][: 2 * wide]
        found = found[len(tried) :]
        tried += [each for each in symmetric if not any(each is other for other in tried)]
        found = [each for each in found if not any(each is other for other in symmetric)]
        symmetric = []
        made += [each for each in phases.run(making, tried, 0.75) if each is not None]
        best = _different(made, most, axes)[:count]
    return _with_symmetric(best, made, count)


def _different(fits: list[Fit], most: int, axes: Sequence[MirrorAxis]) -> list[Fit]:
    """Fits whose tiles are not alike, those that overlap most first, so many of a group at most."""
    kept: list[Fit] = []
    for each in sorted(fits, key=lambda each: -(each.overlap + _AS_GOOD * each.symmetric)):
        if sum(other.group == each.group for other in kept) < most and not any(
            _stands_for(one, each, axes) for one in kept
        ):
            kept.append(each)
    return sorted(kept, key=lambda each: -each.overlap)


def _stands_for(one: Fit, other: Fit, axes: Sequence[MirrorAxis]) -> bool:
    """Whether another fit need not be kept beside one: their tiles lie over each other in the outline, or its images.

    Those of a group are the same, too, that differ by a rotation of the outline: they have the same bound. So may two
    symmetric ones be in different groups: a glide makes the same copy of what is its own mirror image as a translation
    or a rotation. For a symmetric one stands only what is that as well.
    """
    if other.symmetric and not one.symmetric:
        return False
    if abs(one.bound - other.bound) <= _SAME and (one.group == other.group or other.symmetric):
        return True
    corners = ring_corners(other.tile_as_drawn.exterior)
    images = [corners, *(axis.mirrored(corners) for axis in axes)]
    return any(overlap(one.tile_as_drawn, Polygon(plane(image))) >= _ALIKE for image in images)


def _with_symmetric(best: list[Fit], made: list[Fit], count: int) -> list[Fit]:
    """The best fits, so many at most, the last of which is symmetric where one is and no other of them."""
    symmetric = [each for each in made if each.symmetric]
    if count < 2 or not symmetric or any(each.symmetric for each in best):
        return best
    return [*best[: count - 1], max(symmetric, key=lambda each: each.overlap)]


@dataclass
class _Phases:
    """Work of several phases, each of blocks, of which progress is told."""

    workers: int | None
    scheduler: str | None
    progress: Callable[[float, float], None] | None
    _done: float = 0.0

    def run(
        self,
        function: Callable[[Block], Result],
        blocks: Sequence[Block],
        until: float,
        tell: Callable[[Result], object] | None = None,
    ) -> list[Result]:
        """What a function gives of each block, in their order; then so much of all work is done, a share.

        `tell` is told each as it comes.
        """
        results: dict[int, Result] = {}
        for k, result in run_blocks(function, blocks, workers=self.workers, scheduler=self.scheduler):
            if isinstance(result, LostBlock):
                raise SchedulerError(f"a part of the search came to nothing: {result.reason}", remedy="Try it again.")
            results[k] = result
            if tell is not None:
                tell(result)
            if self.progress is not None:
                self.progress(self._done + (until - self._done) * len(results) / len(blocks), 1.0)
        self._done = until
        return [results[k] for k in range(len(blocks))]


def _groups(groups: str | Iterable[str] | None, *, mirrored: bool) -> list[str]:
    """The names of the groups to look in."""
    if groups is None or groups == "all":
        names = [name for name in GROUPS if groups == "all" or name not in ENCLOSED]
    else:
        names = list(dict.fromkeys(texts("groups", groups, "Give names of wallpaper groups.")))
        for name in names:
            if name not in GROUPS:
                raise ArgumentError(
                    f"`groups` has {shown(name)}, which is no wallpaper group", remedy=f"There are {', '.join(GROUPS)}."
                )
    chosen = [name for name in names if mirrored or all(each.determinant == 1 for each in GROUPS[name].operations)]
    if not chosen:
        raise ArgumentError("`groups` has none without mirror images", remedy="Give p1, p2, p3, p4 or p6.")
    return chosen


def _outline(silhouette: GoalOutline, placement: GroupPlacement) -> Polygon:
    """A silhouette in its place."""
    return Polygon(plane(placement.laid(silhouette.points, silhouette.centroid)))


def _check_symmetric(silhouette: GoalOutline, goals: list[_Goal], groups: list[str]) -> None:
    """Raise ArgumentError where an outline is not its own mirror image, or groups have no tiles that are."""
    if not goals:
        like = likeness(silhouette)
        if like >= MIRRORED:
            raise ArgumentError(
                "the outline's halves hardly meet on the axis about which it is its own mirror image",
                remedy="Draw it wider there, or leave out `symmetric`.",
            )
        raise ArgumentError(
            f"the outline is not its own mirror image: their overlap is {math.floor(100.0 * like) / 100.0:.2f}, "
            f"less than {MIRRORED}",
            remedy="Draw it symmetrically, or leave out `symmetric`.",
        )
    if not any(mirror_lines(GROUPS[name]) for name in groups):
        raise ArgumentError(
            "`groups` has none whose tile can be its own mirror image beside such copies",
            remedy="Give p1, p2, p3, p4, p6, pg or pgg.",
        )


def _made(given: GoalOutline, name: str, found: _Found) -> Fit | None:
    """The fit of the whole outline in a placement that is led on; None where its tile is not one piece."""
    silhouette, axis = found.goal
    unit, bound = polished(silhouette.unit, found.found)
    placement = unit.scaled(silhouette.size)
    axis = None if axis is None else axis.placed(placement)
    corners = drawn_apart(silhouette, placement, axis)
    if len(corners) < 3:
        return None
    digits = DIGITS if axis is None else MIRRORED_DIGITS
    tiling = tiled(closed_design(placement.group, placement.cell, corners, name, silhouette.size, digits))
    if tiling is None:
        return None
    # The given outline lies over the one that was placed, whose centroid is nearly the same.
    moved = (given.centroid - silhouette.centroid) * cmath.exp(1j * placement.turn)
    placement = replace(placement, centre=placement.centre + moved)
    if axis is not None:
        bound = overlap_bound(given, placement)
    return _measured(tiling, given, placement, bound, axis)


def _with_fewer_corners(within: float, fit: Fit) -> Fit:
    """The fit with a stroke of fewer corners."""
    return fit.with_fewer_corners(within)


def _measured(
    tiling: Tiling, silhouette: GoalOutline, placement: GroupPlacement, bound: float, axis: MirrorAxis | None
) -> Fit:
    """A fit with its figures."""
    given = _outline(silhouette, placement)
    tile = tiling[0].to_shapely(accuracy=1e-4 * silhouette.size)
    distance = largest_distance(tile.exterior, given.exterior, DISTANCE_STEP * silhouette.size)
    return Fit(tiling, silhouette, placement, overlap(tile, given), bound, distance, axis)
