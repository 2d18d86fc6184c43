"""Outlines of which every point is the image of one representative.

A point is held as a representative and an exact motion. From whichever tile it is reached, the same representative is
moved by the same motion, and comes out as the same bits; so tiles share their edges exactly.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from voronoi_tiles.vector.contour import Bools, Complexes, Ints
from voronoi_tiles.vector.copies import IDENTITY, Action, Motion, compose, inverse
from voronoi_tiles.vector.edges import PAIRING, Corner, Edge, Traced

# How near to a vertex the image of its counterpart must be, relative to the cell's size, where some have none.
_COUNTERPART = 1e-6


@dataclass(frozen=True, slots=True)
class Points:
    """Images of representatives.

    Attributes:
        index: (n,) into the representatives.
        motion: (n,) into `motions`.
        motions: the motions that occur.
    """

    index: Ints
    motion: Ints
    motions: tuple[Motion, ...]

    def moved(self, outer: Motion) -> Points:
        """Return the images under one more motion."""
        return Points(self.index, self.motion, tuple(compose(outer, motion) for motion in self.motions))

    def take(self, places: Ints) -> Points:
        """Return the points at these places."""
        return Points(self.index[places], self.motion[places], self.motions)


@dataclass(frozen=True)
class Representatives:
    """The points that all others are images of.

    Attributes:
        action: the group.
        position: (m,).
        stabilizer: for those that motions of the group fix, these motions.
    """

    action: Action
    position: Complexes
    stabilizer: dict[int, tuple[Motion, ...]]

    @cached_property
    def _special(self) -> Bools:
        """(m,) whether a representative has a stabilizer."""
        special = np.zeros(len(self.position), bool)
        special[list(self.stabilizer)] = True
        return special

    def locate(self, points: Points) -> Complexes:
        """Return the positions of images of representatives."""
        result = np.empty(len(points.index), complex)
        for number, motion in enumerate(points.motions):
            chosen = points.motion == number
            result[chosen] = self.action.apply(motion, self.position[points.index[chosen]])
        for k in np.flatnonzero(self._special[points.index]).tolist():
            point = int(points.index[k])
            # Several motions lead to this point: the first in a fixed order stands for all.
            motion = min(compose(points.motions[points.motion[k]], s) for s in self.stabilizer[point])
            result[k] = self.action.apply_to_point(motion, complex(self.position[point]))
        return result


@dataclass(frozen=True)
class SharedOutline:
    """The outline of a tile.

    Attributes:
        representatives: of all tiles.
        start: (n,) where each arc starts; it ends where the next of its ring starts.
        control: (n,) of the quadratic Bezier; its index is -1 for a line.
        focus: (n,) and directrix: (n, 2), of the representative arc, to be moved as the control point.
        ring_offsets: (r + 1,) the arcs of ring k are ring_offsets[k] to ring_offsets[k + 1].
        beyond: (n,) into `neighbours`: site and motion of the copy beyond each arc.
    """

    representatives: Representatives
    start: Points
    control: Points
    focus: Complexes
    directrix: Complexes
    ring_offsets: Ints
    beyond: Ints
    neighbours: tuple[tuple[int, Motion], ...]


Corners = dict[Corner, tuple[int, Motion]]
"""For each corner its representative and the motion from there."""


@dataclass(frozen=True, slots=True)
class _Arcs:
    """The arcs of an edge as references to representatives, each with the index of its motion in a given pair.

    Attributes:
        inner, inner_by: (k - 1,) the vertices between the arcs.
        control, control_by: (k,) the control points, -1 for lines.
        focus, directrix: (k,) and (k, 2), to be moved as the control points.
        motions: the identity and, if the edge is symmetric, the motion that maps it onto itself.
    """

    inner: Ints
    inner_by: Ints
    control: Ints
    control_by: Ints
    focus: Complexes
    directrix: Complexes
    motions: tuple[Motion, ...]

    def reversed(self) -> _Arcs:
        """Return the same edge run through from its end."""
        arrays = {name: getattr(self, name)[::-1] for name in self.__slots__ if name != "motions"}
        return _Arcs(**arrays, motions=self.motions)


class _Builder:
    """Collects representatives."""

    def __init__(self, action: Action) -> None:
        self.action = action
        self._positions: list[Complexes] = []
        self._count = 0
        self._stabilizer: dict[int, tuple[Motion, ...]] = {}

    def add(self, positions: Complexes) -> Ints:
        """Add representatives; return their indices."""
        self._positions.append(positions)
        self._count += len(positions)
        return np.arange(self._count - len(positions), self._count)

    def add_fixed(self, position: complex, stabilizer: tuple[Motion, ...], tangent: complex | None = None) -> int:
        """Add a representative that these motions fix, put exactly where they do; return its index.

        Onto a mirror it is moved along `tangent`, if one is given.
        """
        images = [self.action.apply_to_point(motion, position) for motion in stabilizer]
        place = sum(images) / len(images)
        if tangent is not None and len(stabilizer) == 2:
            # A vertex on a mirror from which the site keeps little distance is known badly across the mirror, but is
            # exactly on the other edge that ends there.
            off = place - position
            square = (tangent.conjugate() * off).real
            if square != 0.0:
                along = tangent * (abs(off) ** 2 / square)
                if abs(along) <= 1e3 * abs(off):
                    target = position + along
                    mirrored = self.action.apply_to_point(stabilizer[1], target)
                    place = (target + mirrored) / 2
        number = int(self.add(np.array([place]))[0])
        if len(stabilizer) > 1:
            self._stabilizer[number] = stabilizer
        return number

    def finish(self) -> Representatives:
        """Return all representatives."""
        return Representatives(self.action, np.concatenate(self._positions), self._stabilizer)


def share_edges(action: Action, traced: list[Traced], edges: list[Edge]) -> list[SharedOutline]:
    """Return the outlines of all tiles, their edges and corners shared.

    Args:
        traced: for each site its tile's boundary.
        edges: of these boundaries, paired, ring after ring.
    """
    builder = _Builder(action)
    corners = _find_corners(builder, traced, edges)
    positions = builder.finish()
    sources: dict[int, tuple[Motion, bool, _Arcs]] = {}
    for edge in edges:
        if id(edge) not in sources:
            arcs = _represent(builder, positions, traced[edge.tile], edge, corners)
            for motion, image, flips in edge.images:
                sources.setdefault(id(image), (motion, flips, arcs))
    representatives = builder.finish()
    outlines = []
    for tile, boundary in enumerate(traced):
        own = [edge for edge in edges if edge.tile == tile]
        outlines.append(_assemble(representatives, boundary, own, sources, corners))
    return outlines


def _find_corners(builder: _Builder, traced: list[Traced], edges: list[Edge]) -> Corners:
    """Return all corners as images of representatives, and put those on rotation centres and mirrors there."""
    related: defaultdict[Corner, list[tuple[Corner, Motion]]] = defaultdict(list)
    ends: defaultdict[Corner, list[tuple[Edge, int]]] = defaultdict(list)
    images: set[int] = set()
    for edge in edges:
        ends[edge.start].append((edge, 0))
        ends[edge.end].append((edge, -1))
        for motion, image, flips in edge.images:
            if image is not edge and id(edge) not in images:
                images.add(id(image))
            there = (image.end, image.start) if flips else (image.start, image.end)
            for corner, other in zip((edge.start, edge.end), there, strict=True):
                related[corner].append((other, motion))
                related[other].append((corner, inverse(motion)))
    found: Corners = {}
    for edge in edges:
        first = edge.start
        if first in found:
            continue
        reached = {first: IDENTITY}
        stack = [first]
        fixing: set[Motion] = set()
        while stack:
            corner = stack.pop()
            for other, motion in related[corner]:
                there_by = compose(motion, reached[corner])
                if other not in reached:
                    reached[other] = there_by
                    stack.append(other)
                elif reached[other] != there_by:
                    fixing.add(compose(inverse(reached[other]), there_by))
        where = complex(edge.vertex[0])
        for corner, motion in reached.items():
            sources = [(e, place) for e, place in ends[corner] if id(e) not in images]
            where = _sharpened(builder.action, traced[corner[0]], where, motion, sources, ends[corner])
        stabilizer = _generated(fixing)
        number = builder.add_fixed(where, stabilizer, _across(traced, ends[first]))
        found.update({corner: (number, motion) for corner, motion in reached.items()})
    return found


# Nodes this near to each other, relative to a vertex's distance, determine it badly across their bisector.
_NEAR = 1e-4


def _sharpened(
    action: Action,
    boundary: Traced,
    where: complex,
    motion: Motion,
    sources: list[tuple[Edge, int]],
    ends: list[tuple[Edge, int]],
) -> complex:
    """Return a corner's representative, moved onto the bisector of two nodes that are near to each other.

    Copies that nearly touch leave a corner uncertain across the bisector between them: by eps R^2 / d at a distance R
    from nodes a distance d apart. Where the edge passes between these nodes this matters; along the other edge that
    ends there the corner may be moved freely.
    """
    for edge, place in sources:
        one, two = boundary.nodes[edge.arcs[place]].tolist()
        here = action.apply_to_point(motion, where)
        gap = abs(two - one)
        if not gap < _NEAR * abs(here - one):
            continue
        normal = (two - one) / gap
        off = gap / 2 - (normal.conjugate() * (here - one)).real
        tangents = [_tangent(boundary, e, p) for e, p in ends if e is not edge]
        best = max(tangents, key=lambda t: abs((normal.conjugate() * t).real) / abs(t), default=0j)
        across = (normal.conjugate() * best).real
        if abs(across) > 1e-3 * abs(best):
            where = action.apply_to_point(inverse(motion), here + best * (off / across))
    return where


def _across(traced: list[Traced], ends: list[tuple[Edge, int]]) -> complex | None:
    """Return the direction of an edge at a corner, of one that does not lie on a mirror."""
    for edge, place in ends:
        if not any(image is edge and motion != IDENTITY and not flips for motion, image, flips in edge.images):
            return _tangent(traced[edge.tile], edge, place)
    return None


def _tangent(boundary: Traced, edge: Edge, place: int) -> complex:
    """Return the direction of an edge at its start (place 0) or end (place -1)."""
    arc, (start, end) = edge.arcs[place], edge.vertex[[place, place + 1] if place == 0 else [-2, -1]]
    if not boundary.curved[arc]:
        return complex(end - start)
    this = edge.arcs[[place]]
    control = parabola_controls(np.array([start]), np.array([end]), boundary.focus[this], boundary.directrix[this])[0]
    return complex(control - start if place == 0 else end - control)


def _generated(motions: set[Motion]) -> tuple[Motion, ...]:
    """Return the finite group that motions with a common fixed point generate, in a fixed order."""
    group = {IDENTITY}
    stack = [IDENTITY]
    while stack:
        element = stack.pop()
        for motion in motions:
            product = compose(motion, element)
            if product not in group:
                group.add(product)
                stack.append(product)
                # A point of a plane pattern has a symmetry of order 12 at most.
                assert len(group) <= 12, "motions without a common fixed point"
    return tuple(sorted(group))


def _represent(builder: _Builder, positions: Representatives, boundary: Traced, edge: Edge, corners: Corners) -> _Arcs:
    """Return the arcs of an edge that stands for its orbit, symmetric under the motions that map it onto itself."""
    action = builder.action
    selfmaps = [(motion, flips) for motion, image, flips in edge.images if image is edge and motion != IDENTITY]
    if any(not flips for _, flips in selfmaps):
        # It lies on a mirror: one straight line, whatever elements take turns beside it.
        none, one = np.zeros(0, np.intp), np.zeros(1, np.intp)
        return _Arcs(none, none, one - 1, one, np.zeros(1, complex), np.zeros((1, 2), complex), (IDENTITY,))
    vertex, arcs = edge.vertex.copy(), edge.arcs
    (first, by), (last, last_by) = corners[edge.start], corners[edge.end]
    ends = Points(np.array([first, last]), np.array([0, 1]), (by, last_by))
    vertex[[0, -1]] = positions.locate(ends)
    if not selfmaps:
        inner = builder.add(vertex[1:-1])
        control = _controls(builder, boundary, arcs, vertex)
        focus, directrix = boundary.focus[arcs], boundary.directrix[arcs]
        return _Arcs(inner, 0 * inner, control, 0 * control, focus, directrix, (IDENTITY,))
    mirror = selfmaps[0][0]
    vertex, arcs = _symmetric(action, mirror, vertex, arcs)
    half, odd = divmod(len(arcs), 2)
    pair = tuple(sorted((IDENTITY, mirror)))
    inner = builder.add(vertex[1 : half + odd])
    if odd:
        vertex[half + 1 : -1] = action.apply(mirror, vertex[1 : half + 1][::-1])
        core = arcs[: half + 1]
        control = _controls(builder, boundary, core, vertex[: half + 2])
        if control[half] >= 0:
            middle = builder.finish().position[control[half]]
            control[half] = builder.add_fixed(middle, pair)
        order = np.concatenate((inner, inner[::-1]))
    else:
        centre = builder.add_fixed(vertex[half], pair)
        vertex[half] = builder.finish().position[centre]
        core = arcs[:half]
        control = _controls(builder, boundary, core, vertex[: half + 1])
        order = np.concatenate((inner, [centre], inner[::-1]))
    places = np.concatenate((np.arange(len(core)), np.arange(half)[::-1]))
    return _Arcs(
        inner=order,
        inner_by=(np.arange(len(order)) >= half).astype(np.intp),
        control=control[places],
        control_by=(np.arange(len(places)) >= len(core)).astype(np.intp),
        focus=boundary.focus[core][places],
        directrix=boundary.directrix[core][places],
        motions=(IDENTITY, mirror),
    )


def _symmetric(action: Action, mirror: Motion, vertex: Complexes, arcs: Ints) -> tuple[Complexes, Ints]:
    """Leave out vertices of a symmetric edge that have no counterpart: rounding splits a vertex on one side only."""
    image = action.apply(mirror, vertex)[::-1]
    if len(arcs) == 1 or np.abs(image - vertex).max() <= PAIRING * action.size:
        return vertex, arcs
    gaps = np.abs(image[:, None] - vertex)
    kept = [0]
    for k in range(1, len(arcs)):
        partner = int(gaps[:, k].argmin())
        if gaps[partner, k] <= _COUNTERPART * action.size and int(gaps[partner].argmin()) == k:
            kept.append(k)
    length = np.abs(np.diff(vertex))
    bounds = [*kept, len(arcs)]
    longest = [a + int(length[a:b].argmax()) for a, b in zip(kept, bounds[1:], strict=True)]
    return vertex[bounds], arcs[longest]


def parabola_controls(start: Complexes, end: Complexes, focus: Complexes, directrix: Complexes) -> Complexes:
    """Return the control points of parabolic arcs as quadratic Bezier curves.

    In the frame of its directrix a parabola is h(s) = ((s - p)^2 + q^2) / 2q, and the control point between s0 and
    s1 is at their mean, at the height of the polar form h(s0, s1).

    Args:
        start, end, focus: (n,); directrix: (n, 2) two points of it.
    """
    axis = directrix[:, 1] - directrix[:, 0]
    axis = axis / np.abs(axis)
    q = ((focus - directrix[:, 0]) * axis.conj()).imag
    s0, s1 = ((start - focus) * axis.conj()).real, ((end - focus) * axis.conj()).real
    above = (s0 * s1 / q - q) / 2.0
    return np.asarray(focus + axis * ((s0 + s1) / 2 + 1j * above))


def _controls(builder: _Builder, boundary: Traced, arcs: Ints, vertex: Complexes) -> Ints:
    """Add the control points of arcs between consecutive vertices; return their indices, -1 for lines."""
    control = np.full(len(arcs), -1)
    curved = np.flatnonzero(boundary.curved[arcs])
    bent = arcs[curved]
    control[curved] = builder.add(
        parabola_controls(vertex[curved], vertex[curved + 1], boundary.focus[bent], boundary.directrix[bent])
    )
    return control


def _assemble(
    representatives: Representatives,
    boundary: Traced,
    edges: list[Edge],
    sources: dict[int, tuple[Motion, bool, _Arcs]],
    corners: Corners,
) -> SharedOutline:
    """Return a tile's outline from its edges, ring after ring."""
    numbers: dict[Motion, int] = {}
    start, start_by, control, control_by, focus, directrix = [], [], [], [], [], []
    beyond, offsets = [], [0]
    rings = [int(boundary.ring[edge.arcs[0]]) for edge in edges]
    faces: dict[tuple[int, Motion], int] = {}
    for place, edge in enumerate(edges):
        outer, flips, arcs = sources[id(edge)]
        if flips:
            arcs = arcs.reversed()
        by = np.array([numbers.setdefault(compose(outer, motion), len(numbers)) for motion in arcs.motions])
        corner, corner_motion = corners[edge.start]
        start.append(np.append(corner, arcs.inner))
        start_by.append(np.append(numbers.setdefault(corner_motion, len(numbers)), by[arcs.inner_by]))
        control.append(arcs.control)
        control_by.append(by[arcs.control_by])
        focus.append(arcs.focus)
        directrix.append(arcs.directrix)
        count = len(arcs.control)
        beyond.append(np.full(count, faces.setdefault((edge.target, edge.motion), len(faces))))
        if place and rings[place] != rings[place - 1]:
            offsets.append(offsets[-1])
        if len(offsets) == 1:
            offsets.append(0)
        offsets[-1] += count
    motions = tuple(numbers)
    return SharedOutline(
        representatives=representatives,
        start=Points(np.concatenate(start), np.concatenate(start_by), motions),
        control=Points(np.concatenate(control), np.concatenate(control_by), motions),
        focus=np.concatenate(focus),
        directrix=np.concatenate(directrix),
        ring_offsets=np.array(offsets),
        beyond=np.concatenate(beyond),
        neighbours=tuple(faces),
    )
