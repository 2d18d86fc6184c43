"""How far from a tiling the copies of a silhouette are: what they leave uncovered."""

from __future__ import annotations

import shapely
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from voronoi_tiles.base.arrays import plane
from voronoi_tiles.escherization.goal_outline import GoalOutline
from voronoi_tiles.escherization.group_placement import GroupPlacement


def laid_out(silhouette: GoalOutline, placement: GroupPlacement, further: float = 0.0) -> tuple[Polygon, list[Polygon]]:
    """The silhouette in its place, and its copies nearer to it than `further` and a little more, in millimetres."""
    points = placement.laid(silhouette.points, silhouette.centroid)
    own = Polygon(plane(points))
    copies = [Polygon(plane(copy(points))) for copy in placement.copies(2.0 * silhouette.reach + further)]
    return own, copies


def gap(silhouette: GoalOutline, placement: GroupPlacement) -> float:
    """The share of the plane that no copy of the silhouette covers, exact; from 0, where it tiles, to below 1.

    Copies have the area of the cell together, so that the share is what they cover more than once, counted as often as
    that is too much: the area of a copy less that of its points, each divided by the number of copies that cover it.
    """
    own, copies = laid_out(silhouette, placement)
    shapely.prepare(own)
    # What at least one other copy covers, at least two, and so on.
    covered: list[BaseGeometry] = []
    for copy in copies:
        common = own.intersection(copy)
        if not common.area > 0.0:
            continue
        for k in range(len(covered)):
            covered[k], common = covered[k].union(common), covered[k].intersection(common)
            if not common.area > 0.0:
                break
        else:
            covered.append(common)
    # A point that n others cover has lost 1 - 1 / (n + 1), the sum of 1 / k - 1 / (k + 1) over k from 1 to n.
    lost = sum(part.area / (k * (k + 1)) for k, part in enumerate(covered, 1))
    return float(lost / own.area)


def overlap_bound(uncovered: float) -> float:
    """The most that a tile of a placement can have in common with the silhouette, by the share left uncovered.

    It is the area of the intersection over that of the union. A point that copies cover can go to one of them alone,
    and one that none covers to one that does not: a tile has at most the covered share in common with its silhouette,
    which has its area. Voronoi tiles of silhouettes that are drawn apart come near to that.
    """
    return (1.0 - uncovered) / (1.0 + uncovered)
