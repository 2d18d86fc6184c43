"""The corners of the tiling, where edges meet: each an image of one representative.

Corner k is the one where edge k starts.
"""

from __future__ import annotations

from collections import defaultdict
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.base.components import components
from voronoi_tiles.vector.complex.edges import Edges
from voronoi_tiles.vector.complex.representatives import Builder, Points, fixed, on_mirror
from voronoi_tiles.vector.complex.sharpening import off_arc, sharpened, tangent
from voronoi_tiles.vector.motion_codes import IDENTITY_CODE, Codes, composed, inverted, motion_of
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, compose, inverse, reverses_orientation


def find_corners(builder: Builder, edges: Edges) -> Points:
    """All corners of edges as images of representatives; those on rotation centres and mirrors are put exactly there.

    What takes an edge to an image takes its ends to those of the image.
    """
    source, image, following = edges.source, edges.image, edges.following
    one, two = np.empty((2, len(source), 2), np.intp)
    one[:, 0], one[:, 1] = source, following[source]
    two[:, 0], two[:, 1] = image, following[image]
    two[edges.backwards] = two[edges.backwards, ::-1]
    one, two, by = one.reshape(-1), two.reshape(-1), edges.by.repeat(2)
    least = components(len(edges), one, two)
    motion = _motions(least, one, two, by)
    fixing = _fixing(least, one, two, by, motion)
    first = (least == np.arange(len(edges))).nonzero()[0]
    where = edges.traced.vertex[edges.start[first]]
    numbers = np.empty(len(edges), np.intp)
    numbers[first] = builder.add(where)
    near = set(least[_near_touching(edges)].tolist()) if edges.traced.nearly_touching else set()
    ends, action = _Ends(edges), builder.action
    for corner in sorted(near.union(fixing)):
        place = int(first.searchsorted(corner))
        at = complex(where[place])
        if corner in near:
            for other in (least == corner).nonzero()[0].tolist():
                at = ends.sharpened(action, at, motion_of(int(motion[other])), other)
        stabilizer = _generated(fixing[corner])
        mirror = len(stabilizer) == 2 and any(map(reverses_orientation, stabilizer))
        across = ends.across(corner) if mirror else None
        if across:
            if corner in near:  # moved far along a tangent it may have left the curve
                at = ends.onto(at, *across)
            where[place] = on_mirror(action, at, stabilizer, ends.tangent(*across))
        else:
            where[place] = fixed(action, at, stabilizer)
        builder.fix(int(numbers[corner]), stabilizer)
    return Points(numbers[least], motion)


def _motions(least: Ints, one: Ints, two: Ints, by: Codes) -> Codes:
    """For each corner a motion that takes the first of its orbit, `least`, there, by way of links between corners."""
    motion = np.full(len(least), IDENTITY_CODE)
    reached = least == np.arange(len(least))
    while not reached.all():
        link = (reached[one] & ~reached[two]).nonzero()[0]
        if len(link):
            motion[two[link]] = composed(by[link], motion[one[link]])
            reached[two[link]] = True
        else:
            one, two, by = two, one, inverted(by)  # links lead on against their direction only
    return motion


def _near_touching(edges: Edges) -> Ints:
    """The corners at the ends of arcs that are the bisectors of what nearly touches."""
    arcs = np.zeros(len(edges.traced), bool)
    arcs[list(edges.traced.nearly_touching)] = True
    return np.concatenate((np.flatnonzero(arcs[edges.start]), edges.following[arcs[edges.last]]))


def _fixing(least: Ints, one: Ints, two: Ints, by: Codes, motion: Codes) -> defaultdict[int, set[Motion]]:
    """Motions that generate the stabilizers of the first corners of orbits, by corner, of those that have others.

    Where two ways lead to one corner, to go there and back is a motion that fixes the first.
    """
    there_by = composed(by, motion[one])
    apart = (there_by != motion[two]).nonzero()[0]
    fixing: defaultdict[int, set[Motion]] = defaultdict(set)
    if len(apart):
        codes = composed(inverted(motion[two[apart]]), there_by[apart])
        for corner, code in zip(least[one[apart]].tolist(), codes.tolist(), strict=True):
            fixing[corner].add(motion_of(code))
    return fixing


class _Ends:
    """The edges that end at corners, each with the place of its arc there, 0 or -1."""

    def __init__(self, edges: Edges) -> None:
        self.edges = edges

    @cached_property
    def _before(self) -> Ints:
        """For each edge the one that ends where it starts."""
        before = np.empty(len(self.edges), np.intp)
        before[self.edges.following] = np.arange(len(self.edges))
        return before

    @cached_property
    def _on_mirror(self) -> frozenset[int]:
        """The edges that lie on mirrors."""
        same = self.edges.symmetries
        return frozenset(self.edges.source[same[~self.edges.backwards[same]]].tolist())

    @cached_property
    def _kept(self) -> frozenset[int]:
        """The edges that stand for their orbits."""
        return frozenset(self.edges.orbits[0].tolist())

    def at(self, corner: int) -> list[tuple[int, int]]:
        """The edges that end at a corner, in their order."""
        return sorted([(corner, 0), (int(self._before[corner]), -1)], key=lambda end: (end[0], -end[1]))

    def sharpened(self, action: Action, where: complex, motion: Motion, corner: int) -> complex:
        """A corner's representative, put onto the bisectors of what nearly touches.

        The corner is the image of `where` under `motion`. Of the edges there those count that stand for their orbit.
        """
        ends = self.at(corner)
        for edge, place in ends:
            arc = self.arc(edge, place)
            if edge in self._kept and arc in self.edges.traced.nearly_touching:
                here = action.apply_to_point(motion, where)
                others = [self.tangent(e, p) for e, p in ends if e != edge]
                there = sharpened(self.edges.traced, arc, here, others)
                if there != here:
                    where = action.apply_to_point(inverse(motion), there)
        return where

    def across(self, corner: int) -> tuple[int, int] | None:
        """An edge that ends at a corner and does not lie on a mirror."""
        return next((end for end in self.at(corner) if end[0] not in self._on_mirror), None)

    def onto(self, where: complex, edge: int, place: int) -> complex:
        """A point put onto the arc at the start (place 0) or end (place -1) of an edge."""
        off, normal = off_arc(self.edges.traced, self.arc(edge, place), where)
        return where + off * normal

    def arc(self, edge: int, place: int) -> int:
        """The arc at the start (place 0) or end (place -1) of an edge."""
        return int((self.edges.start if place == 0 else self.edges.last)[edge])

    def tangent(self, edge: int, place: int) -> complex:
        """The direction of an edge at its start (place 0) or end (place -1)."""
        traced, arc = self.edges.traced, self.arc(edge, place)
        start, end = traced.vertex[[arc, traced.following[arc]]].tolist()
        return tangent(traced, arc, start, end, at_start=place == 0)


def _generated(motions: set[Motion]) -> tuple[Motion, ...]:
    """The finite group that motions with a common fixed point generate, in a fixed order."""
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
