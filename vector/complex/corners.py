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
from voronoi_tiles.vector.complex.sharpening import sharpened, tangent
from voronoi_tiles.vector.motion_codes import IDENTITY_CODE, Codes, code_of, composed, inverted, motion_of
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, compose, inverse, reverses_orientation

# For each corner, corners that edges' motions take it to, and those motions.
_Related = defaultdict[int, list[tuple[int, Motion]]]


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
    # Where two ways lead to one corner, it may be that a motion fixes it.
    careful = np.zeros(len(edges), bool)
    careful[least[one[composed(by, motion[one]) != motion[two]]]] = True
    if edges.traced.nearly_touching:
        careful[least[_near_touching(edges)]] = True
    first = (least == np.arange(len(edges))).nonzero()[0]
    where = edges.traced.vertex[edges.start[first]]
    numbers = np.empty(len(edges), np.intp)
    numbers[first] = builder.add(where)
    if careful.any():
        # From corner to corner the identity leads as well, to a tile beside.
        asked = careful[least[one]] & ((one != two) | (by != IDENTITY_CODE))
        related = _related(one[asked], two[asked], by[asked])
        ends = _Ends(edges)
        for place in careful[first].nonzero()[0].tolist():
            corner = int(first[place])
            reached, fixing = _orbit(corner, related)
            at = complex(where[place])
            if edges.traced.nearly_touching:
                for other, taken in reached.items():
                    at = ends.sharpened(builder.action, at, taken, other)
            stabilizer = _generated(fixing)
            mirror = len(stabilizer) == 2 and any(map(reverses_orientation, stabilizer))
            along = ends.across(corner) if mirror else None
            action = builder.action
            where[place] = on_mirror(action, at, stabilizer, along) if along else fixed(action, at, stabilizer)
            builder.fix(int(numbers[corner]), stabilizer)
            motion[list(reached)] = [code_of(taken) for taken in reached.values()]
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


def _related(one: Ints, two: Ints, by: Codes) -> _Related:
    """The links between corners, by the corner that they come from, in their order, there and back."""
    related: _Related = defaultdict(list)
    for corner, other, code in zip(one.tolist(), two.tolist(), by.tolist(), strict=True):
        motion = motion_of(code)
        related[corner].append((other, motion))
        related[other].append((corner, inverse(motion)))
    return related


def _orbit(first: int, related: _Related) -> tuple[dict[int, Motion], set[Motion]]:
    """The corners that a corner is taken to, each with a motion that does it; and motions that generate its stabilizer.

    Where two ways lead to one corner, to go there and back is a motion that fixes the first.
    """
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
    return reached, fixing


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
            arc = int((self.edges.start if place == 0 else self.edges.last)[edge])
            if edge in self._kept and arc in self.edges.traced.nearly_touching:
                here = action.apply_to_point(motion, where)
                others = [self.tangent(e, p) for e, p in ends if e != edge]
                there = sharpened(self.edges.traced, arc, here, others)
                if there != here:
                    where = action.apply_to_point(inverse(motion), there)
        return where

    def across(self, corner: int) -> complex | None:
        """The direction of an edge at a corner, of one that does not lie on a mirror."""
        for edge, place in self.at(corner):
            if edge not in self._on_mirror:
                return self.tangent(edge, place)
        return None

    def tangent(self, edge: int, place: int) -> complex:
        """The direction of an edge at its start (place 0) or end (place -1)."""
        traced = self.edges.traced
        arc = int((self.edges.start if place == 0 else self.edges.last)[edge])
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
