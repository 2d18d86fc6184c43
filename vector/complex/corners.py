"""The corners of the tiling, where edges meet: each an image of one representative."""

from __future__ import annotations

from collections import defaultdict

from voronoi_tiles.vector.complex.edges import Corner, Edge
from voronoi_tiles.vector.complex.representatives import Builder
from voronoi_tiles.vector.complex.sharpening import sharpened, tangent
from voronoi_tiles.vector.complex.traced import Traced
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, compose, inverse

Corners = dict[Corner, tuple[int, Motion]]
"""For each corner the number of its representative, and the motion from there."""

# For each corner, corners that edges' motions take it to, and those motions.
_Related = defaultdict[Corner, list[tuple[Corner, Motion]]]


def find_corners(builder: Builder, traced: list[Traced], edges: list[Edge]) -> Corners:
    """All corners of edges as images of representatives; those on rotation centres and mirrors are put exactly there.

    The edges come with their images; what takes an edge to an image takes its ends to those of the image.
    """
    related: _Related = defaultdict(list)
    ends: defaultdict[Corner, list[tuple[Edge, int]]] = defaultdict(list)
    images: set[Edge] = set()
    for edge in edges:
        ends[edge.start].append((edge, 0))
        ends[edge.end].append((edge, -1))
        for motion, image, flips in edge.images:
            if image is not edge and edge not in images:
                images.add(image)
            there = (image.end, image.start) if flips else (image.start, image.end)
            for corner, other in zip((edge.start, edge.end), there, strict=True):
                related[corner].append((other, motion))
                related[other].append((corner, inverse(motion)))
    found: Corners = {}
    for edge in edges:
        first = edge.start
        if first in found:
            continue
        reached, fixing = _orbit(first, related)
        where = complex(edge.vertex[0])
        for corner, motion in reached.items():
            sources = [(e, place) for e, place in ends[corner] if e not in images]
            where = _sharpened(builder.action, traced[corner[0]], where, motion, sources, ends[corner])
        number = builder.add_fixed(where, _generated(fixing), _across(traced, ends[first]))
        found.update({corner: (number, motion) for corner, motion in reached.items()})
    return found


def _orbit(first: Corner, related: _Related) -> tuple[dict[Corner, Motion], set[Motion]]:
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


def _sharpened(
    action: Action,
    boundary: Traced,
    where: complex,
    motion: Motion,
    sources: list[tuple[Edge, int]],
    ends: list[tuple[Edge, int]],
) -> complex:
    """A corner's representative, put onto the bisectors of what nearly touches.

    The corner is the image of `where` under `motion`. `ends` are the edges that end there, each with the place of its
    arc there, 0 or -1; `sources` those of them that stand for their orbit.
    """
    for edge, place in sources:
        arc = int(edge.arcs[place])
        if arc in boundary.nearly_touching:
            here = action.apply_to_point(motion, where)
            there = sharpened(boundary, arc, here, [_tangent(boundary, e, p) for e, p in ends if e is not edge])
            if there != here:
                where = action.apply_to_point(inverse(motion), there)
    return where


def _across(traced: list[Traced], ends: list[tuple[Edge, int]]) -> complex | None:
    """The direction of an edge at a corner, of one that does not lie on a mirror."""
    for edge, place in ends:
        if not any(image is edge and motion != IDENTITY and not flips for motion, image, flips in edge.images):
            return _tangent(traced[edge.tile], edge, place)
    return None


def _tangent(boundary: Traced, edge: Edge, place: int) -> complex:
    """The direction of an edge at its start (place 0) or end (place -1)."""
    start, end = edge.vertex[[place, place + 1] if place == 0 else [-2, -1]].tolist()
    return tangent(boundary, int(edge.arcs[place]), start, end, at_start=place == 0)


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
