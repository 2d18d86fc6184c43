"""Edges of the tiling: maximal runs of arcs between two tiles, and the orbits that they form.

Seen from the tile beyond, an edge is the image of an edge of some base tile. One edge of each orbit is computed, and
the others are its images.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints
from voronoi_tiles.vector.arcs import parabola_controls
from voronoi_tiles.vector.copies import Copies, Placed
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, compose, inverse, reverses_orientation


@dataclass(frozen=True, slots=True)
class Traced:
    """The traced boundary of a tile.

    Attributes:
        vertex: (n,) where each arc starts, ring after ring.
        ring: (n,) index of the ring.
        target, copy: (n,) the site beyond each arc, and the index of its copy.
        curved: (n,) whether the arc lies on a parabola; else on a line.
        focus: (n,) of the parabola.
        directrix: (n, 2) two points of its directrix.
        nodes: (n, 2) the nodes between which an arc is the bisector, NaN where they are not two.
        copies: for each site, its copies around this tile.
    """

    vertex: Complexes
    ring: Ints
    target: Ints
    copy: Ints
    curved: Bools
    focus: Complexes
    directrix: Complexes
    nodes: Complexes
    copies: list[Copies]

    def take(self, index: Ints) -> Traced:
        """The boundary of these arcs only, each ending where the next one starts."""
        arrays = {name: getattr(self, name)[index] for name in self.__slots__ if name != "copies"}
        return Traced(**arrays, copies=self.copies)

    def rings(self) -> list[Ints]:
        """The indices of each ring's arcs."""
        opening = np.flatnonzero(np.append(True, self.ring[1:] != self.ring[:-1]))
        return np.split(np.arange(len(self.ring)), opening[1:])

    def middles(self) -> Complexes:
        """The point of each arc halfway between its ends, by its parameter."""
        following = np.arange(1, len(self.vertex) + 1)
        for ring in self.rings():
            following[ring[-1]] = ring[0]
        start, end = self.vertex, self.vertex[following]
        middle = (start + end) / 2
        bent = np.flatnonzero(self.curved)
        control = parabola_controls(start[bent], end[bent], self.focus[bent], self.directrix[bent])
        middle[bent] = (middle[bent] + control) / 2
        return middle


# How near vertices must be to count as one, relative to the cell's size: far above rounding.
_SAME = 1e-6
# How far an edge may be from the image of its counterpart, on the same scale. Where copies nearly touch, vertices are
# known to far fewer digits along their edges; the proof judges what comes of it.
PAIRING = 1e-3
# Turns the plane so that no mirror and no row of copies is upright.
_SLANT = np.exp(1j)

Corner = tuple[int, int]
"""Tile and index of the arc that starts there."""


@dataclass(eq=False, slots=True)
class Edge:
    """A maximal run of arcs that face one copy; where it is a whole ring, it is cut at one vertex or several.

    Attributes:
        tile: whose boundary it is part of.
        arcs: (k,) indices into the traced boundary, in order.
        target, motion: the copy on the other side.
        start, end: its corners.
        vertex: (k + 1,) the points between and at the ends of its arcs.
        course: (2k + 1,) the same with a point of each arc between its ends, halfway by its parameter.
        images: all edges of base tiles that it is mapped to, each with the motion and whether that reverses its
            direction; itself under the identity comes first.
    """

    tile: int
    arcs: Ints
    target: int
    motion: Motion
    start: Corner
    end: Corner
    vertex: Complexes
    course: Complexes
    images: list[tuple[Motion, Edge, bool]]


class UnpairedEdgeError(ArithmeticError):
    """An edge has no counterpart on the other side.

    Attributes:
        edge: the edge.
    """

    def __init__(self, edge: Edge) -> None:
        super().__init__("an edge has no counterpart on the other side")
        self.edge = edge


def pair_edges(action: Action, placed: list[Placed], traced: list[Traced], *, pinched: bool = False) -> list[Edge]:
    """The edges of all tiles, ring after ring, each with its images.

    Args:
        pinched: look for vertices at which a boundary touches itself, and end edges there. Such a tile may have the
            same neighbour on both sides of the vertex, while an edge on the other side ends.

    Raises:
        UnpairedEdgeError: as it says.
    """
    cuts = [_cuts(boundary) for boundary in traced]
    _cut_further(action, placed, traced, cuts, pinched)
    edges = [edge for tile, boundary in enumerate(traced) for edge in _edges(tile, boundary, cuts[tile])]
    faces: defaultdict[tuple[int, int, Motion], list[Edge]] = defaultdict(list)
    for edge in edges:
        faces[edge.tile, edge.target, edge.motion].append(edge)
    limit = PAIRING * action.size
    for edge in edges:
        for motion, tile, target, beyond, flips in _images(placed, edge.tile, edge.target, edge.motion):
            if motion == IDENTITY and not flips:
                edge.images.append((motion, edge, False))
                continue
            image = action.apply(motion, edge.course)
            candidates = faces.get((tile, target, beyond), [])
            if flips:
                image = image[::-1]
            gaps = [_gap(image, other.course, limit) for other in candidates]
            best = int(np.argmin(gaps)) if gaps else -1
            if best < 0 or gaps[best] > limit:
                raise UnpairedEdgeError(edge)
            edge.images.append((motion, candidates[best], flips))
    return edges


def long_edges(boundary: Traced, limit: float) -> Ints:
    """The arcs of the edges that extend farther than a limit; all, where no other would be left of a ring."""
    kept = []
    for ring, cut in zip(boundary.rings(), _cuts(boundary), strict=True):
        long = [
            arcs
            for arcs, end in _runs(ring, cut)
            if np.abs(boundary.vertex[np.append(arcs, end)] - boundary.vertex[arcs[0]]).max() > limit
        ]
        kept.append(np.sort(np.concatenate(long)) if len(cut) > 1 and long else ring)
    return np.concatenate(kept)


def _gap(one: Complexes, other: Complexes, limit: float) -> float:
    """How far the courses of two edges are from being the same.

    Where they do not agree one by one, points at equal shares of their lengths are compared: rounding may split a
    vertex, on one side only, into several.
    """
    if len(one) == len(other):
        gap = float(np.abs(one - other).max())
        if gap <= limit:
            return gap
    shares = np.linspace(0.0, 1.0, 9)
    places = []
    for course in (one, other):
        run = np.append(0.0, np.cumsum(np.abs(np.diff(course))))
        places.append(
            np.interp(shares * run[-1], run, course.real) + 1j * np.interp(shares * run[-1], run, course.imag)
        )
    return float(np.abs(places[0] - places[1]).max())


def _cuts(boundary: Traced) -> list[list[int]]:
    """For each ring the places in it where the copy beyond changes."""
    result = []
    for ring in boundary.rings():
        target, copy = boundary.target[ring], boundary.copy[ring]
        changes = (target != np.roll(target, 1)) | (copy != np.roll(copy, 1))
        result.append(np.flatnonzero(changes).tolist())
    return result


def _motion(boundary: Traced, arc: int) -> Motion:
    """The copy beyond an arc."""
    a, b, c, d, s, t = boundary.copies[boundary.target[arc]].motions[boundary.copy[arc]].tolist()
    return (a, b, c, d, s, t)


def _images(
    placed: list[Placed], tile: int, target: int, beyond: Motion
) -> Iterator[tuple[Motion, int, int, Motion, bool]]:
    """Every way to move an edge onto a base tile: (motion, tile, target, copy beyond, whether it reverses)."""
    for element in placed[tile].stabilizer:
        motion = compose(element, beyond)
        yield element, tile, target, placed[target].canonical(motion), reverses_orientation(element)
    back = inverse(beyond)
    for element in placed[target].stabilizer:
        motion = compose(element, back)
        yield motion, target, tile, placed[tile].canonical(motion), not reverses_orientation(motion)


def _cut_further(
    action: Action, placed: list[Placed], traced: list[Traced], cuts: list[list[list[int]]], pinched: bool
) -> None:
    """Cut rings at more vertices, and at all images of these, in place.

    They are one vertex of each ring that faces one copy only and, where `pinched`, those where a boundary touches
    itself.
    """
    # A vertex is where its arc starts; what it is mapped to depends on the copies beyond the arcs on either side.
    waiting: list[tuple[int, int]] = []
    for tile, boundary in enumerate(traced):
        if pinched:
            waiting += [(tile, arc) for arc in _pinches(boundary, _SAME * action.size)]
        waiting += [(tile, int(r[0])) for r, cut in zip(boundary.rings(), cuts[tile], strict=True) if not cut]
    done: set[tuple[int, int]] = set()
    while waiting:
        tile, arc = waiting.pop()
        if (tile, arc) in done:
            continue
        done.add((tile, arc))
        boundary = traced[tile]
        number, ring = next((n, r) for n, r in enumerate(boundary.rings()) if r[0] <= arc <= r[-1])
        before = arc - 1 if arc > ring[0] else int(ring[-1])
        place = arc - int(ring[0])
        if place not in cuts[tile][number]:
            cuts[tile][number] = sorted([*cuts[tile][number], place])
        here = boundary.vertex[arc : arc + 1]
        for side in {arc, before}:
            target, beyond = int(boundary.target[side]), _motion(boundary, side)
            for motion, other, facing, copy, _ in _images(placed, tile, target, beyond):
                waiting += [
                    (other, k)
                    for k in _at(traced[other], action.apply(motion, here), _SAME * action.size)
                    if facing == traced[other].target[k] and copy == _motion(traced[other], k)
                ]


def _at(boundary: Traced, point: Complexes, limit: float) -> list[int]:
    """The arcs that start at a point."""
    return [int(arc) for arc in np.flatnonzero(np.abs(boundary.vertex - point) <= limit)]


def _pinches(boundary: Traced, limit: float) -> list[int]:
    """The vertices that another one coincides with."""
    # Sorted from left to right, turned by the slant, few vertices are near each other.
    along = (boundary.vertex * _SLANT).real
    order = np.argsort(along)
    vertex, along = boundary.vertex[order], along[order]
    pairs = [np.zeros((0, 2), np.intp)]
    for step in range(1, len(order)):
        near = np.flatnonzero(along[step:] - along[:-step] <= limit)
        if not len(near):
            break
        same = near[np.abs(vertex[near + step] - vertex[near]) <= limit]
        pairs.append(np.stack((order[same], order[same + step]), axis=1))
    one, two = np.concatenate(pairs).T
    # Neighbours on the boundary may be as close without touching: a short arc lies between them.
    following = np.concatenate([np.roll(ring, -1) for ring in boundary.rings()])
    apart = (following[one] != two) & (following[two] != one)
    return [int(vertex) for vertex in np.unique(np.concatenate((one[apart], two[apart])))]


def _runs(ring: Ints, cut: list[int]) -> Iterator[tuple[Ints, int]]:
    """The arcs between the places where a ring is cut, and the arc that starts where they end."""
    for first, last in zip(cut, [*cut[1:], *(place + len(ring) for place in cut[:1])], strict=True):
        yield ring[np.arange(first, last) % len(ring)], int(ring[last % len(ring)])


def _edges(tile: int, boundary: Traced, cuts: list[list[int]]) -> Iterator[Edge]:
    """The edges of a boundary whose rings are cut at these places."""
    middle = boundary.middles()
    for ring, cut in zip(boundary.rings(), cuts, strict=True):
        for arcs, end in _runs(ring, cut):
            start = int(arcs[0])
            vertex = boundary.vertex[np.append(arcs, end)]
            course = np.empty(2 * len(vertex) - 1, complex)
            course[::2], course[1::2] = vertex, middle[arcs]
            yield Edge(
                tile=tile,
                arcs=arcs,
                target=int(boundary.target[start]),
                motion=_motion(boundary, start),
                start=(tile, start),
                end=(tile, end),
                vertex=vertex,
                course=course,
                images=[],
            )
