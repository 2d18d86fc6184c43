"""Paths as straight chords: what every check measures, with the way back to the path, its pieces and its length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import shapely
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, plane, ranges
from voronoi_tiles.base.box_index import BoxIndex
from voronoi_tiles.paths.conversion import chord_counts, chords
from voronoi_tiles.paths.paths import Paths

CHORDS_MAX: Final = 2_000
"""Most chords of one piece; a count. A circle of a kilometre has them at a tenth of a millimetre."""


@dataclass(frozen=True, eq=False)
class Chords:
    """The chords of some paths, in their order.

    `start` and `end` are complex128 (n,), `piece` and `path` (intp, n) tell what each is of, `before` (float64, n) is
    the length of its path before it. `first` (intp, p + 1) is where the chords of each path begin, `total` (float64, p)
    the length of each path by its chords, and `ring` (bool, p) says whether it comes back to its beginning.
    """

    start: Complexes
    end: Complexes
    piece: Ints
    path: Ints
    before: Floats
    first: Ints
    total: Floats
    ring: Bools

    @cached_property
    def lengths(self) -> Floats:
        """The length of each chord."""
        return np.abs(self.end - self.start)

    @cached_property
    def index(self) -> BoxIndex:
        """The chords' boxes, to look for those that meet others."""
        return BoxIndex(*self.corners)

    @cached_property
    def tree(self) -> shapely.STRtree:
        """The chords by their boxes."""
        return shapely.STRtree(lines(self.start, self.end))

    @cached_property
    def corners(self) -> tuple[Complexes, Complexes]:
        """The lower left and the upper right corner of each chord's box."""
        low, high = np.empty_like(self.start), np.empty_like(self.start)
        for part in ("real", "imag"):
            one, other = getattr(self.start, part), getattr(self.end, part)
            setattr(low, part, np.minimum(one, other))
            setattr(high, part, np.maximum(one, other))
        return low, high

    @cached_property
    def sides(self) -> tuple[Floats, Floats]:
        """The left and the right sides of the chords' boxes, each in rising order."""
        low, high = self.corners
        return np.sort(low.real), np.sort(high.real)

    @cached_property
    def levels(self) -> tuple[Floats, Floats]:
        """Their lower and their upper sides."""
        low, high = self.corners
        return np.sort(low.imag), np.sort(high.imag)

    @cached_property
    def boxes(self) -> tuple[Complexes, Complexes]:
        """The lower left and the upper right corner of each path's box."""
        first = self.first[:-1]
        low, high = (
            least.reduceat(corner.real, first) + 1j * least.reduceat(corner.imag, first)
            for least, corner in zip((np.minimum, np.maximum), self.corners, strict=True)
        )
        return low, high

    @property
    def sizes(self) -> Floats:
        """The longer side of each path's box."""
        low, high = self.boxes
        return np.maximum((high - low).real, (high - low).imag)

    def next(self, chords: Ints) -> Ints:
        """The chord that follows each on its path; -1 after the last one of a path that is no ring."""
        path = self.path[chords]
        after = chords + 1
        over = after == self.first[path + 1]
        return np.where(over, np.where(self.ring[path], self.first[path], -1), after)

    def where(self, path: Ints, at: Floats) -> tuple[Ints, Floats, Bools]:
        """The chords at these lengths along paths, the shares of them that lie before, and which are on the path.

        Rings go on from their beginning.
        """
        total = self.total[path]
        turned = np.where(self.ring[path], np.mod(at, np.where(total > 0, total, 1.0)), at)
        on = (turned >= 0.0) & (turned <= total)
        place = np.clip(turned, 0.0, total)
        chord = np.searchsorted(self._running, self._base[path] + place, side="right") - 1
        chord = np.clip(chord, self.first[path], self.first[path + 1] - 1)
        length = self.lengths[chord]
        share = np.clip((place - self.before[chord]) / np.where(length > 1e-200, length, 1.0), 0.0, 1.0)
        return chord, share, on

    def along(self, path: Ints, at: Floats) -> tuple[Complexes, Bools]:
        """The points of paths at these lengths from their beginnings, and which of them are on the path; as `where`."""
        chord, share, on = self.where(path, at)
        return self.start[chord] + share * (self.end[chord] - self.start[chord]), on

    def on_pieces(self, chords: Ints, share: Floats) -> tuple[Ints, Floats]:
        """The pieces of chords, and the parameters of pieces at these shares of the chords, which take equal steps."""
        piece = self.piece[chords]
        first = np.searchsorted(self.piece, piece)
        count = np.searchsorted(self.piece, piece, side="right") - first
        return piece, (chords - first + share) / count

    def apart(self, path: Ints, one: Floats, other: Floats) -> Floats:
        """From one length along a path to another, the shorter way round a ring; signed."""
        way = other - one
        total = np.where(self.ring[path] & (self.total[path] > 0), self.total[path], np.inf)
        with np.errstate(invalid="ignore", over="ignore"):
            turns = np.where(np.isfinite(total), np.round(way / total), 0.0)
            return way - np.where(turns != 0.0, turns * total, 0.0)

    @cached_property
    def _base(self) -> Floats:
        """The length of all paths before each."""
        return np.append(0.0, np.cumsum(self.total))

    @cached_property
    def _running(self) -> Floats:
        """The length of all chords before each."""
        return self._base[self.path] + self.before


def lines(start: Complexes, end: Complexes) -> NDArray[np.object_]:
    """Segments as shapely's lines."""
    return np.asarray(shapely.linestrings(plane(np.stack((start, end), axis=1))), dtype=object)


def polygons(chords: Chords, paths: Ints) -> NDArray[np.object_]:
    """What paths of three or more chords enclose, as shapely's polygons; they may be invalid."""
    counts = np.diff(chords.first)[paths]
    points = plane(chords.start[ranges(chords.first[paths], counts)])
    rings = shapely.linearrings(points, indices=np.repeat(np.arange(len(paths)), counts))
    return np.asarray(shapely.polygons(rings), dtype=object)


def counts_of(paths: Paths, accuracy: float) -> Ints:
    """How many chords each piece takes that are within `accuracy` of it, at most CHORDS_MAX.

    Unlike `to_lines` it refuses nothing: files of others may be huge beside the accuracy.
    """
    return np.ceil(np.clip(chord_counts(paths, accuracy), 1.0, CHORDS_MAX)).astype(np.intp)


def chords_of(paths: Paths, counts: Ints, meeting: float) -> Chords:
    """The chords of paths, so many of each piece; a path whose ends are nearer than `meeting` is a ring."""
    cut = chords(paths, counts)
    first, path = cut.offsets, cut.owner
    lengths = np.abs(cut.end - cut.start)
    running = np.append(0.0, np.cumsum(lengths))
    total = np.diff(running[first])
    # Sums are taken anew for each path, so that the millionth is as exact as the first.
    before = running[:-1] - running[first[:-1]][path]
    ring = paths.closed | (np.abs(paths.end[paths.offsets[1:] - 1] - paths.start[paths.offsets[:-1]]) <= meeting)
    piece = np.repeat(np.arange(len(counts)), counts)
    return Chords(cut.start, cut.end, piece, path, before, first, total, ring)
