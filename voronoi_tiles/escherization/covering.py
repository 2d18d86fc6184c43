"""How much of the plane the copies of a silhouette cover, and what tiles can have in common with it at most."""

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


def covered_area(silhouette: GoalOutline, placement: GroupPlacement) -> float:
    """The area that copies of the silhouette cover, for each of them, exact; in square millimetres.

    It is that of a copy less what copies cover more than once, counted as often as that is too much: the area of a
    copy's points, each divided by the number of copies that cover it.
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
    return float(own.area - lost)


def overlap_bound(silhouette: GoalOutline, placement: GroupPlacement) -> float:
    """The most that a tile of a placement can have in common with the silhouette: intersection over union, to 1.

    A point that copies cover can go to one of them alone: the intersection has at most the area c that is covered, for
    each copy; and the union is what outline and tile have together, less that. Where both have the same area and a
    share g of the plane is not covered, that is (1 - g) / (1 + g). Voronoi tiles of silhouettes that are drawn apart
    come near to it.
    """
    tile = placement.lattice.det / placement.group.order
    covered = min(covered_area(silhouette, placement), tile)
    return covered / (tile + silhouette.area - covered)
