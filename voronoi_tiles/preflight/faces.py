"""The regions that lines of their own bound: where their ends meet, and where they end on other lines or cross them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, owned_ranges, plane
from voronoi_tiles.base.components import components
from voronoi_tiles.preflight.chord_distance import foot_share
from voronoi_tiles.preflight.chords import Chords

_AROUND = 4.0  # how far along its path from its end a chord is still met as that end; in tolerances


class Faces(NamedTuple):
    """Regions as shapely's polygons, and the parts of paths between crossings, with the path of each (intp, n)."""

    polygons: NDArray[np.object_]
    parts: NDArray[np.object_]
    path: Ints


class _Cuts(NamedTuple):
    """Where paths are divided: the path, the length along it and the point, each (n,)."""

    path: Ints
    at: Floats
    point: Complexes


def faces_of(chords: Chords, crossed: Complexes, touching: float) -> Faces:
    """The regions that paths which are no rings bound, with each other and with rings that they meet.

    What is nearer than `touching` is one place; `crossed` (complex128, n) are places where paths cross.
    """
    line = np.flatnonzero(~chords.ring)
    first, last = chords.first[line], chords.first[line + 1] - 1
    nodes = np.concatenate((chords.start[first], chords.end[last], crossed))
    points = shapely.points(plane(nodes))
    place = components(len(nodes), *_pairs(shapely.STRtree(points), points, touching))
    ends = np.full((2, len(chords.total)), -1, np.intp)
    ends[:, line] = place[: 2 * len(line)].reshape(2, -1)
    near, chord = _pairs(chords.tree, points, touching)
    cuts = _cuts(chords, nodes, place[near], chord, ends, touching)
    return _divided(chords, np.union1d(line, cuts.path), line, nodes[place[: 2 * len(line)]], cuts)


def _pairs(tree: shapely.STRtree, points: NDArray[np.object_], touching: float) -> tuple[Ints, Ints]:
    """The points, and what is near to each."""
    one, two = tree.query(points, predicate="dwithin", distance=touching).astype(np.intp)
    return one, two


def _cuts(chords: Chords, nodes: Complexes, node: Ints, chord: Ints, ends: Ints, touching: float) -> _Cuts:
    """Where paths pass by nodes, but not at their own ends: `ends` (intp, (2, paths)) are their nodes, -1 for rings.

    A node beside an end is another one: there a line crosses the path, which runs a hair past it.
    """
    path = chords.path[chord]
    at = chords.before[chord] + foot_share(nodes[node], chords.start[chord], chords.end[chord]) * chords.lengths[chord]
    at = np.minimum(at, chords.total[path])  # a sum may round beyond it
    inner = np.ones(len(path), np.bool_)
    for end, far in zip(ends[:, path], (at, chords.total[path] - at), strict=True):
        inner &= (end != node) | (far > _AROUND * touching)
    path, at, node = path[inner], at[inner], node[inner]
    # Neighbouring chords meet a node in one place.
    order = np.lexsort((at, node, path))
    path, at, node = path[order], at[order], node[order]
    new = np.append(True, (np.diff(path) != 0) | (np.diff(node) != 0) | (np.diff(at) > _AROUND * touching))[: len(path)]
    return _Cuts(path[new], at[new], nodes[node[new]])


def _divided(chords: Chords, paths: Ints, line: Ints, ends: Complexes, cuts: _Cuts) -> Faces:
    """The faces of these paths, of which `line` are no rings and have these ends, beginnings first."""
    # The points of paths and the cuts, in the order in which they follow each other.
    chord, _ = owned_ranges(chords.first[paths], chords.first[paths + 1])
    begin, end = chords.start[chords.first[:-1]].copy(), chords.start[chords.first[:-1]].copy()
    begin[line], end[line] = np.split(ends, 2)
    points = chords.start.copy()
    points[chords.first[:-1]] = begin
    path = np.concatenate((chords.path[chord], paths, cuts.path))
    at = np.concatenate((chords.before[chord], chords.total[paths], cuts.at))
    point = np.concatenate((points[chord], end[paths], cuts.point))
    # A cut stands behind the beginning and before the end of its path.
    rank = np.repeat((0, 2, 1), (len(chord), len(paths), len(cuts.path)))
    order = np.lexsort((rank, at, path))
    path, point, is_cut = path[order], point[order], rank[order] == 1
    # Each cut ends a part and begins the next one.
    twice = np.repeat(np.arange(len(path)), np.where(is_cut, 2, 1))
    begins = np.append(True, np.diff(path[twice]) != 0)
    begins[1:] |= twice[1:] == twice[:-1]
    part = np.cumsum(begins) - 1
    parts = shapely.linestrings(plane(point[twice]), indices=part)
    # Drawn to a node, a part may cross another one beside it, and a ring that crosses itself bounds no polygon: all are
    # divided where they cross now. An edge is of the part, or parts, that it lies on.
    edges = shapely.get_parts(shapely.union_all(parts))
    middles = shapely.line_interpolate_point(edges, 0.5, normalized=True)
    edge, part = shapely.STRtree(parts).query_nearest(middles)
    return Faces(shapely.get_parts(shapely.polygonize(edges)), edges[edge], path[twice][begins][part])
