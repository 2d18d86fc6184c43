"""Designs whose tiles come near to an outline: `fit`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Final, Literal

from shapely.geometry import Polygon

from voronoi_tiles.base.arguments import number, texts
from voronoi_tiles.base.arrays import plane
from voronoi_tiles.base.errors import ArgumentError, SchedulerError
from voronoi_tiles.base.values import shown
from voronoi_tiles.designs.design import Design
from voronoi_tiles.escherization.closed_design import closed_design, tiled
from voronoi_tiles.escherization.covering import overlap_bound
from voronoi_tiles.escherization.drawn_apart import drawn_apart
from voronoi_tiles.escherization.fewer_corners import DISTANCE_STEP, fewer_corners
from voronoi_tiles.escherization.goal_outline import GoalOutline
from voronoi_tiles.escherization.group_placement import GroupPlacement
from voronoi_tiles.escherization.outline_distance import largest_distance, overlap
from voronoi_tiles.escherization.polishing import Found, found_placements, polished
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.parallel.block_runner import Block, LostBlock, Result
from voronoi_tiles.parallel.blocks import run_blocks
from voronoi_tiles.tiling import Tiling

Strokes = Literal["few", "outline"]

POLYGONS: Final = ("pmm", "p4m", "p3m1", "p6m")
"""The groups whose tile is a polygon whatever is drawn: they are left out, unless they are asked for."""

_EACH: Final = 2
"""How many designs of one group there are at most, where more groups are looked in than designs are kept; a count."""

_WIDE: Final = 6
"""Twice as many placements are led on at least, however few designs are kept; a count."""

_SAME: Final = 2e-4
"""Placements of a group whose bounds differ by less are one, or images of each other; a share."""

_GAIN: Final = 0.015
"""How much less a placement may leave uncovered once it is led on by areas; a share of the plane. Of the placements of
30 animals the most was 0.013."""

WITHIN: Final = 0.005
"""How far the tile of few strokes may be from that of the whole outline, where nothing else is said; relative to the
side of a square of its area."""


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """A design whose tile comes near to an outline.

    `overlap` is the area that tile and outline have in common over that of their union, and `bound` the most that any
    tile of the group has in its place; `distance` is how far they are from each other at most, in millimetres.
    `outline` is the given one where the design has it, and `placement` how it came there.
    """

    tiling: Tiling
    silhouette: GoalOutline
    placement: GroupPlacement
    overlap: float
    bound: float
    distance: float

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


def fit(
    outline: Any,
    *,
    groups: str | Iterable[str] | None = None,
    keep: int = 8,
    mirrored: bool = True,
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
    `mirrored` False only those are, whose copies are never mirror images. `strokes` are an "outline" drawn a little
    smaller, or "few": a closed stroke of fewer corners, whose tile is within `within` millimetres of that one's
    (without it, a two-hundredth of the side of a square of the outline's area). The same `seed`, from 0, gives the same
    designs, whatever the number of `workers`; None takes all processors. `found` is told each design as soon as it is
    made, in any order.

    Raises ArgumentError for an outline that crosses itself, has holes or no area, and for groups that are none.
    """
    silhouette = GoalOutline.of(outline)
    names = _groups(groups, mirrored=mirrored)
    count = int(number("keep", keep, "Give a number of designs.", least=1))
    if strokes not in ("few", "outline"):
        raise ArgumentError(f"`strokes` {shown(strokes)} cannot be", remedy='Give "few" or "outline".')
    near = WITHIN * silhouette.size if within is None else number("within", within, "Give millimetres.", least=1e-6)
    seed = int(number("seed", seed, "Give a whole number from 0.", least=0))
    phases = _Phases(workers, scheduler, progress)
    seen = phases.run(partial(found_placements, silhouette.unit, seed), names, 0.5)
    ordered = sorted((each for row in seen for each in row), key=lambda each: each.uncovered)
    best = _best(phases, partial(_made, silhouette, name), ordered, count, len(names))
    if strokes == "few":
        best = phases.run(partial(_with_fewer_corners, near), best, 1.0, found)
    elif found is not None:
        for each in best:
            found(each)
    if progress is not None:
        progress(1.0, 1.0)
    return sorted(best, key=lambda each: -each.overlap)


def _best(
    phases: _Phases, making: Callable[[Found], Fit | None], found: list[Found], count: int, groups: int
) -> list[Fit]:
    """So many different fits of whole outlines, those that overlap most first; `found` are in their order."""
    most = max(_EACH, math.ceil(count / groups))
    made: list[Fit] = []
    best: list[Fit] = []
    while found and len(best) < count:
        # Those that may be among the best, once they are led on, and more where many of them were the same.
        wide = max(count, _WIDE)
        limit = found[min(wide, len(found)) - 1].uncovered + _GAIN
        tried = [each for each in found if each.uncovered <= limit][: 2 * wide]
        found = found[len(tried) :]
        made += [each for each in phases.run(making, tried, 0.75) if each is not None]
        best = _different(made, most)[:count]
    return best


def _different(fits: list[Fit], most: int) -> list[Fit]:
    """Fits whose placements are not images of each other, those that overlap most first, so many of a group at most."""
    kept: list[Fit] = []
    for each in sorted(fits, key=lambda each: -each.overlap):
        others = [other for other in kept if other.group == each.group]
        if len(others) < most and all(abs(each.bound - other.bound) > _SAME for other in others):
            kept.append(each)
    return kept


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
        names = [name for name in GROUPS if groups == "all" or name not in POLYGONS]
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


def _made(silhouette: GoalOutline, name: str, found: Found) -> Fit | None:
    """The fit of the whole outline in a placement that is led on; None where its tile is not one piece."""
    placed = polished(silhouette.unit, found)
    placement = placed.placement.scaled(silhouette.size)
    corners = drawn_apart(silhouette, placement)
    if len(corners) < 3:
        return None
    tiling = tiled(closed_design(placement.group, placement.cell, corners, name, silhouette.size))
    return None if tiling is None else _measured(tiling, silhouette, placement, overlap_bound(placed.uncovered))


def _with_fewer_corners(within: float, fit: Fit) -> Fit:
    """The fit with a stroke of fewer corners, if there is one."""
    tiling = fewer_corners(fit.tiling, fit.silhouette.size, within)
    return fit if tiling is None else _measured(tiling, fit.silhouette, fit.placement, fit.bound)


def _measured(tiling: Tiling, silhouette: GoalOutline, placement: GroupPlacement, bound: float) -> Fit:
    """A fit with its figures."""
    given = _outline(silhouette, placement)
    tile = tiling[0].to_shapely(accuracy=1e-4 * silhouette.size)
    distance = largest_distance(tile.exterior, given.exterior, DISTANCE_STEP * silhouette.size)
    return Fit(tiling, silhouette, placement, overlap(tile, given), bound, distance)
