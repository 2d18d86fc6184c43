"""Feet of points on the strokes of sites: the nearest points there, and what they lie on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, plane
from voronoi_tiles.designs.moving_sites import MovingSite


class Feet(NamedTuple):
    """Feet of points: of each, `share` of the way along `chord` from its start.

    `away` is the unit vector from the foot to the point. All arrays have one shape; a node's chord is 0.
    """

    share: Floats
    away: Complexes


@dataclass(frozen=True, eq=False)
class AllStrokes:
    """The strokes of all sites, one after the other: `nodes` complex128 (n,), those of site k from `first[k]` on."""

    nodes: Complexes
    first: Ints
    segments: tuple[Ints, ...]
    trees: tuple[shapely.STRtree, ...]

    @classmethod
    def of(cls, sites: Sequence[MovingSite]) -> AllStrokes:
        """Take the strokes of some sites."""
        first = np.cumsum([0, *(len(site.nodes) for site in sites)])
        trees = tuple(shapely.STRtree(shapely.linestrings(plane(site.nodes[site.segments]))) for site in sites)
        segments = tuple(site.segments + start for site, start in zip(sites, first[:-1].tolist(), strict=True))
        return cls(np.concatenate([site.nodes for site in sites]), first, segments, trees)

    def lines(self, points: Complexes, site: Ints, among: Bools) -> Ints:
        """The start and end node of what the foot of each point on the site of a number lies on: intp (..., 2).

        They are one node twice where that is an end of a segment. Where not `among` nothing is looked for: node 0.
        """
        found = np.zeros((*points.shape, 2), np.intp)
        for k, tree in enumerate(self.trees):
            asked = among & (site == k)
            if not asked.any():
                continue
            query = shapely.points(plane(points[asked]))
            nearest = tree.query_nearest(query, all_matches=False)[1]
            ends = self.segments[k][nearest]
            share = self.shares(points[asked], ends)
            ends = np.where((share <= 0.0)[:, None], ends[:, :1], ends)
            found[asked] = np.where((share >= 1.0)[:, None], ends[:, 1:], ends)
        return found

    def shares(self, points: Complexes, ends: Ints) -> Floats:
        """Where the feet of points are on the lines of segments: 0 at the start, 1 at the end; of a node 0."""
        start, chord = self._lines_of(ends)
        away, square = points - start, chord.real**2 + chord.imag**2
        along = away.real * chord.real + away.imag * chord.imag
        return np.divide(along, square, out=np.zeros(points.shape), where=square > 0.0)

    def feet(self, points: Complexes, ends: Ints) -> Feet:
        """The feet of points on the lines of segments, or on nodes; `ends` as `lines` gives them."""
        start, chord = self._lines_of(ends)
        share = self.shares(points, ends)
        away = points - (start + share * chord)
        return Feet(share, away / np.abs(away))

    def _lines_of(self, ends: Ints) -> tuple[Complexes, Complexes]:
        start, end = self.nodes[ends[..., 0]], self.nodes[ends[..., 1]]
        return start, end - start
