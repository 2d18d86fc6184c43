"""Paths whose surroundings repeat, as on a sheet of tiles: one of each kind is judged in the place of all."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, owned_ranges, ranges, starts
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, Paths

PATHS_MIN: Final = 200
"""Fewer paths are all judged; a count. They take less time than looking for what repeats."""

NEIGHBOURS_MAX: Final = 60
"""Where paths have more neighbours on average, all are judged; a count. A tile has some ten."""

_PAIRS_MAX: Final = 3_000_000  # neighbours altogether, at some fifty bytes each
_ASKED: Final = 50  # paths whose neighbours are counted before all are looked for
_SPREAD: Final = 20.0
"""How far apart vectors that count as one may be; in accuracies. What is rounded differs by less than two."""


@dataclass(frozen=True, eq=False)
class Repetition:
    """The kinds of surroundings of paths, and which paths are to be judged.

    `kind` (intp, p) is the number of each path's kind: paths of one kind, and all that is near to them, are each
    other's images under shifts. `first` (intp, kinds) is the path of each kind that is judged, and `judged` are these
    with what is near to them, in their order. Paths `near[offsets[k]:offsets[k + 1]]` are near to path k, in the same
    order for all paths of its kind.
    """

    kind: Ints
    first: Ints
    judged: Ints
    near: Ints
    offsets: Ints

    def is_judged(self, path: int) -> bool:
        """Whether what is found of a path holds for all of its kind."""
        return int(self.first[self.kind[path]]) == path

    def beside(self, path: int) -> list[int]:
        """The paths that are near to one."""
        here: list[int] = self.near[self.offsets[path] : self.offsets[path + 1]].tolist()
        return here

    def images(self, path: int, *others: int) -> Iterator[tuple[int, ...]]:
        """A judged path with others that are near to it, or itself, and the same for each path of its kind."""
        here = self.beside(path)
        ranks = [None if other == path else here.index(other) for other in others]
        for image in np.flatnonzero(self.kind == self.kind[path]).tolist():
            there = self.offsets[image]
            yield image, *(image if rank is None else int(self.near[there + rank]) for rank in ranks)


def surroundings(paths: Paths, reach: float, accuracy: float) -> Repetition | None:
    """What repeats of paths, when things are near that are within `reach`; None where little does.

    Paths repeat where all their points are shifted by the same vector, within `accuracy`.
    """
    count = len(paths)
    if count < PATHS_MIN:
        return None
    shape = _shapes(paths, accuracy)
    if len(np.unique(shape)) > count / 2:
        return None
    pairs = _near(paths, reach)
    if pairs is None:
        return None
    one, two = pairs
    begin = paths.start[paths.offsets[:-1]]
    label = _clusters(shape[one] * (int(shape.max()) + 1) + shape[two], begin[two] - begin[one], accuracy)
    order = np.lexsort((label, one))
    one, two, label = one[order], two[order], label[order]
    offsets = np.searchsorted(one, np.arange(count + 1))
    known: dict[tuple[int, bytes], int] = {}
    bounds = offsets.tolist()
    kind = np.array(
        [
            known.setdefault((what, label[low:high].tobytes()), len(known))
            for what, low, high in zip(shape.tolist(), bounds[:-1], bounds[1:], strict=True)
        ],
        np.intp,
    )
    _, first = np.unique(kind, return_index=True)
    beside, _ = owned_ranges(offsets[first], offsets[first + 1])
    judged = np.union1d(first, two[beside])
    if len(judged) > count / 2:
        return None
    return Repetition(kind, first, judged, two, offsets)


def _shapes(paths: Paths, accuracy: float) -> Ints:
    """Numbers that are the same for paths which a shift maps onto each other."""
    counts = paths.counts
    begin = paths.start[paths.offsets[:-1]]
    sums = np.add.reduceat(paths.end - np.repeat(begin, counts), paths.offsets[:-1])
    known: dict[tuple[bool, bytes], int] = {}
    bounds = paths.offsets.tolist()
    build = [
        known.setdefault((closed, paths.kind[low:high].tobytes()), len(known))
        for closed, low, high in zip(paths.closed.tolist(), bounds[:-1], bounds[1:], strict=True)
    ]
    shape = _clusters(np.array(build, np.intp), np.asarray(sums / counts, np.complex128), accuracy)
    # What has the same mean is compared with the first of it point by point; what differs is taken as like no other.
    _, model, which = np.unique(shape, return_index=True, return_inverse=True)
    model = model[which]
    like = ranges(paths.offsets[model], counts)
    shift = np.repeat(begin - begin[model], counts)
    off = np.zeros(len(like))
    for points, used in (
        (paths.start, None),
        (paths.end, None),
        (paths.control[:, 0], paths.kind != LINE),
        (paths.control[:, 1], paths.kind == CUBIC),
    ):
        away = np.abs(points - shift - points[like])
        off = np.maximum(off, away if used is None else np.where(used, away, 0.0))
    odd = np.maximum.reduceat(off, paths.offsets[:-1]) > accuracy
    return np.where(odd, int(shape.max()) + 1 + np.arange(len(shape)), shape)


def _clusters(key: Ints, place: Complexes, accuracy: float) -> Ints:
    """Numbers that are the same where the keys are, and places nearer than the accuracy, or joined by such.

    Where these spread out they are all different.
    """
    label = key
    for value in (place.real, place.imag, place.real):
        order = np.lexsort((value, label))
        new = np.append(True, (np.diff(label[order]) != 0) | (np.diff(value[order]) > accuracy))
        label = np.empty(len(order), np.intp)
        label[order] = np.cumsum(new) - 1
    order = np.argsort(label, kind="stable")
    first = starts(label[order])
    spread = np.zeros(len(first))
    for value in (place.real[order], place.imag[order]):
        spread = np.maximum(spread, np.maximum.reduceat(value, first) - np.minimum.reduceat(value, first))
    return np.where(spread[label] > _SPREAD * accuracy, len(first) + np.arange(len(label)), label)


def _near(paths: Paths, reach: float) -> tuple[Ints, Ints] | None:
    """All pairs of different paths, both ways round, whose boxes are within reach; None where they are too many."""
    low, high = path_boxes(paths)
    boxes = shapely.box(low.real, low.imag, high.real, high.imag)
    wide = shapely.box(low.real - reach, low.imag - reach, high.real + reach, high.imag + reach)
    tree = shapely.STRtree(boxes)
    asked = wide[:: max(1, len(wide) // _ASKED)]
    if tree.query(asked).shape[1] > min(NEIGHBOURS_MAX, _PAIRS_MAX / len(wide)) * len(asked):
        return None
    one, two = tree.query(wide).astype(np.intp)
    apart = one != two
    return one[apart], two[apart]


def path_boxes(paths: Paths) -> tuple[Complexes, Complexes]:
    """The lower left and upper right corners of boxes that hold the paths, complex128 (p,) each."""
    corners = []
    curved, cubic, arc = paths.kind != LINE, paths.kind == CUBIC, paths.kind == ARC
    # Every point of an arc is as near to its middle as one of its ends.
    around = np.where(arc, np.abs(paths.start - paths.control[:, 0]), 0.0)
    for sign, least in ((-1.0, np.minimum), (1.0, np.maximum)):
        parts: list[Floats] = []
        for side in (np.real, np.imag):
            start, end, control = side(paths.start), side(paths.end), side(paths.control)
            bound = least(start, end)
            bound = np.where(curved, least(bound, control[:, 0] + sign * around), bound)
            bound = np.where(cubic, least(bound, control[:, 1]), bound)
            parts.append(least.reduceat(bound, paths.offsets[:-1]))
        corners.append(parts[0] + 1j * parts[1])
    return corners[0], corners[1]
