"""The order in which separate strokes are taken, so that the way between them is short."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.vector.curves.paths import Bools, Complexes, Ints

_NEAR = 10
"""Neighbours of each end that are looked up at once."""


def short_tour(start: Complexes, end: Complexes) -> tuple[Ints, Bools]:
    """Order strokes from `start[k]` to `end[k]`, so that the ways from each one's end to the next are short.

    Returns the order and, for each in it, whether it is to be run backwards. It begins with the stroke that reaches
    nearest to the lower left corner, and always takes the nearest end of those that are left. A closed stroke starts
    where it ends.
    """
    from scipy.spatial import cKDTree

    count = len(start)
    if not count:
        return np.zeros(0, np.intp), np.zeros(0, np.bool_)
    ends = np.concatenate((start, end))
    points = np.column_stack((ends.real, ends.imag))
    closed = start == end
    corner = (points - points.min(axis=0)).sum(axis=1)
    left = np.ones(count, np.bool_)
    order = np.empty(count, np.intp)
    turned = np.zeros(count, np.bool_)
    choice = int(corner.argmin())
    members = np.flatnonzero(np.concatenate((left, left & ~closed)))
    tree = cKDTree(points[members])
    near = _neighbours(tree, points, members)
    for step in range(count):
        stroke = choice % count
        order[step], turned[step] = stroke, choice >= count
        left[stroke] = False
        if step == count - 1:
            break
        here = stroke if turned[step] else stroke + count
        choice = next((k for k in near[here].tolist() if left[k % count]), -1)
        if choice < 0:
            # All near ones are taken: look farther, in a tree that is made anew when half of it is gone.
            if 2 * (count - step) < len(members) // 2:
                members = np.flatnonzero(np.concatenate((left, left & ~closed)))
                tree = cKDTree(points[members])
            choice = _nearest_left(tree, members, points[here], left)
    return order, turned


def _neighbours(tree: object, points: np.ndarray[tuple[int, int], np.dtype[np.float64]], members: Ints) -> Ints:
    """The nearest ends of each end, its own among them."""
    number = min(_NEAR, len(members))
    _, near = tree.query(points, k=number)  # type: ignore[attr-defined]
    return np.asarray(members[near.reshape(len(points), number)], np.intp)


def _nearest_left(tree: object, members: Ints, place: object, left: Bools) -> int:
    """The nearest end of a stroke that is left."""
    number = 4 * _NEAR
    while True:
        number = min(number, len(members))
        _, near = tree.query(place, k=number)  # type: ignore[attr-defined]
        for k in members[np.atleast_1d(near)].tolist():
            if left[k % len(left)]:
                return int(k)
        number *= 4
