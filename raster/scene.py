"""The copies of the sites, found anew from sites and group: which there are, where they lie, what each is called."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, Floats, Ints, counting, starts
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.base.neighbours import Neighbours
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.tolerance import EPSILON, SAME_POINT
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup
from voronoi_tiles.raster.frame import Frame

Labels = NDArray[np.int32]

_ELEMENTS_MAX = 8_000_000
"""Most copies of elements about one image; a count. They take some 60 bytes each."""


class Coset(NamedTuple):
    """One of the copies of a site in a cell: all others like it are its translates."""

    site: int
    operation: Operation
    isometry: Isometry


@dataclass(frozen=True, eq=False)
class Pattern:
    """The sites of a design under a wallpaper group, over a lattice."""

    sites: tuple[NodedSite, ...]
    group: WallpaperGroup
    lattice: Lattice

    @cached_property
    def symmetries(self) -> tuple[tuple[Operation, ...], ...]:
        """For each site the operations that map it onto itself, the identity first."""
        return tuple(self._symmetry(site) for site in self.sites)

    @cached_property
    def placements(self) -> tuple[Coset, ...]:
        """The different copies up to lattice translations: one operation for each coset of a site's symmetries."""
        found = []
        for number, symmetry in enumerate(self.symmetries):
            seen: set[Operation] = set()
            for operation in self.group.operations:
                if operation.reduced() not in seen:
                    found.append(Coset(number, operation, self.lattice.isometry(operation)))
                    seen.update((operation @ inner).reduced() for inner in symmetry)
        return tuple(found)

    def locate(self, site: int, operation: Operation) -> tuple[int, int, int]:
        """The copy of a site under an operation as (placement, i, j): the placement moved by i a + j b.

        Raises KeyError where the operation does not belong to the group.
        """
        for inner in self.symmetries[site]:
            same = operation @ inner
            k = self._placement_of.get((site, same.reduced()))
            if k is not None:
                i, j = (p - q for p, q in zip(same.translation, self.placements[k].operation.translation, strict=True))
                return k, int(i), int(j)
        raise KeyError(str(operation))

    @cached_property
    def _placement_of(self) -> dict[tuple[int, Operation], int]:
        return {(row.site, row.operation.reduced()): k for k, row in enumerate(self.placements)}

    @cached_property
    def scale(self) -> float:
        """The largest length that distances are computed from: the cell's, or a site's farthest coordinate."""
        a, b = self.lattice.reduced_basis
        return max(abs(a), abs(b), *(float(np.abs(site.nodes).max()) for site in self.sites))

    def rounding(self, frame: Frame) -> float:
        """A bound for the rounding of float64 distances in a frame, in units.

        A coordinate goes through a rotation, two translations and a difference, each rounded at the size of `scale` or
        of the frame's farthest coordinate: less than 16 ulps of it in all.
        """
        return 16 * EPSILON * max(self.scale, abs(frame.origin + frame.middle) + frame.radius)

    def _symmetry(self, site: NodedSite) -> tuple[Operation, ...]:
        """The operations that map a site onto itself: they map its nodes' centre to itself."""
        nodes = site.nodes
        middle = nodes[len(nodes) // 2]
        local = nodes - middle
        centre = complex(local.mean())
        neighbours = Neighbours(local)
        near = SAME_POINT * max(abs(self.lattice.a), abs(self.lattice.b), site.extent) + 8 * EPSILON * self.scale
        segments = {(min(s), max(s)) for s in site.segments.tolist()}
        found = []
        for operation in self.group.operations:
            x, y = self.lattice.fractional(middle + centre - self.lattice.isometry(operation)(middle + centre))
            moved = operation.translated(round(x), round(y))
            isometry = self.lattice.isometry(moved)
            turned = isometry.a * (local.conj() if isometry.conj else local) + (isometry(complex(middle)) - middle)
            distance, image = (nearest[:, 0] for nearest in neighbours.nearest(turned))
            if float(distance.max()) > near or len(np.unique(image)) < len(nodes):
                continue
            ends = np.sort(image[site.segments], axis=1).tolist()
            if all((p, q) in segments for p, q in ends):
                found.append(moved)
        return tuple(found)

    @cached_property
    def basis(self) -> Ints:
        """The reduced basis in integers over the conventional one, a row for each vector."""
        x, y = self.lattice.fractional(np.array(self.lattice.reduced_basis))
        return np.round(np.stack((x, y), axis=1)).astype(np.intp)


@dataclass(frozen=True, eq=False)
class Scene:
    """Copies of elements about an image, from a common `origin`: those of one copy are neighbours, labels ascend.

    `middle` and `half` are complex128 (n,): element k is the segment middle[k] +- half[k], or a point where half is 0.
    `label` int32 (n,) indexes `copies`, intp (m, 3): rows placement, i, j.
    """

    origin: complex
    middle: Complexes
    half: Complexes
    label: Labels
    copies: Ints

    def __len__(self) -> int:
        return len(self.middle)

    @cached_property
    def copy_start(self) -> Ints:
        """The first element of each copy."""
        return starts(self.label)

    def copy_distances(self, point: complex) -> Floats:
        """The distance of each copy from a point, which counts from the origin."""
        return np.minimum.reduceat(distances(point, self.middle, self.half), self.copy_start)

    @cached_property
    def length(self) -> Floats:
        """Half the length of each element."""
        return np.abs(self.half)

    @cached_property
    def unit(self) -> Complexes:
        """The direction of each element; 1 for points."""
        point = self.length == 0.0
        unit: Complexes = np.where(point, 1.0 + 0.0j, self.half)
        unit /= np.where(point, 1.0, self.length)
        return unit


def gather(pattern: Pattern, origin: complex, middle: complex, radius: float, *, most: int | None = None) -> Scene:
    """The copies of elements that may be nearest, or nearest of another copy, somewhere in a disc.

    The disc lies about `origin + middle`. With `most`, only so many elements of each site, evenly chosen, are taken;
    distances to them are upper bounds. Raises DesignError where they are too many.

    Every point has a copy of any given node within the lattice's covering radius, at most the half diagonal of the
    reduced cell, and another one within a shortest vector of that one.
    """
    a, b = pattern.lattice.reduced_basis
    reach = radius + abs(complex(abs(a), abs(b))) / 2 + abs(a)
    if most is None and any(len(site.elements) > _FEW for site in pattern.sites):
        # With some of the elements a better bound than the lattice's is found.
        some = gather(pattern, origin, middle, radius, most=_FEW)
        second = float(np.partition(some.copy_distances(middle), 1)[1])
        reach = min(reach, second + 2 * radius)
    parts = [_images(pattern, k, origin, middle, reach, most) for k in range(len(pattern.placements))]
    shifts = np.concatenate([np.insert(part[2], 0, k, axis=1) for k, part in enumerate(parts)])
    half = np.concatenate([part[1] for part in parts])
    position = np.concatenate([part[0] for part in parts])
    low = shifts.min(axis=0)
    span = shifts.max(axis=0) - low + 1
    key = (shifts - low) @ np.array([span[1] * span[2], span[2], 1])
    order = np.argsort(key, kind="stable")
    key = key[order]
    fresh = np.append(True, key[1:] != key[:-1])
    label = (np.cumsum(fresh) - 1).astype(np.int32)
    return Scene(origin, position[order], half[order], label, shifts[order][fresh])


_FEW = 48
"""Elements of each site that a first bound is taken from; a count."""


def _images(
    pattern: Pattern, number: int, origin: complex, middle: complex, reach: float, most: int | None
) -> tuple[Complexes, Complexes, Ints]:
    """The translates of one placement's elements within `reach` of a point: middles, halves, (i, j)."""
    placement = pattern.placements[number]
    ends = pattern.sites[placement.site].ends
    if most is not None and len(ends) > most:
        ends = ends[np.linspace(0, len(ends) - 1, most).astype(np.intp)]
    start, end = ends.T
    # About one of the site's own points: differences of a site's coordinates are exact, or nearly.
    own = complex(start[0])
    unit, conj = placement.isometry.a, placement.isometry.conj
    home = placement.isometry(own) - origin
    mid: Complexes = ((start - own) + (end - own)) / 2
    half: Complexes = (end - start) / 2
    if conj:
        mid, half = mid.conj(), half.conj()
    mid, half = unit * mid + home, unit * half

    reduced = pattern.lattice.reduced
    p, q, det = reduced.a, reduced.b, reduced.det
    s, t = reduced.fractional(middle - mid)
    room = reach + np.abs(half)
    width, height = room * (abs(q) / det), room * (abs(p) / det)
    low_s, low_t = np.ceil(s - width), np.ceil(t - height)
    count_s = np.maximum(np.floor(s + width) - low_s + 1, 0.0)
    count_t = np.maximum(np.floor(t + height) - low_t + 1, 0.0)
    # Still floats: what is too much may be too much for integers as well.
    total = float((count_s * count_t).sum()) * len(pattern.placements)
    if not total <= _ELEMENTS_MAX:
        raise DesignError(
            f"about {total:.3g} copies of elements lie about the image, more than {_ELEMENTS_MAX:,}",
            remedy="Take a smaller region, a cell that is less elongated, or larger tolerances.",
        )
    count_t = count_t.astype(np.intp)
    count = count_s.astype(np.intp) * count_t
    inside, element = counting(count)
    i = low_s[element].astype(np.intp) + inside // count_t[element]
    j = low_t[element].astype(np.intp) + inside % count_t[element]
    position: Complexes = mid[element] + (i * p + j * q)
    near = distances(middle, position, half[element]) <= reach
    element, i, j = element[near], i[near], j[near]
    # From the reduced basis to (a, b), the one that operations are written in.
    return position[near], half[element], np.stack((i, j), axis=1) @ pattern.basis


def from_feet(z: Complexes | complex, middle: Complexes, half: Complexes) -> Complexes:
    """The vectors that lead to points from the nearest points of elements middle +- half; all broadcast."""
    away = z - middle
    across, up = half.real, half.imag
    share = away.real * across
    share += away.imag * up
    share /= np.maximum(across * across + up * up, _TINY)
    np.clip(share, -1.0, 1.0, out=share)
    away.real -= share * across
    away.imag -= share * up
    return np.asarray(away)


_TINY = 1e-300
"""Stands for 0 where it divides 0."""


def lengths(vectors: Complexes) -> Floats:
    """The lengths of vectors; faster than np.abs, which guards against lengths beyond those of designs."""
    square = vectors.real * vectors.real
    square += vectors.imag * vectors.imag
    return np.sqrt(square, out=square)


def distances(z: Complexes | complex, middle: Complexes, half: Complexes) -> Floats:
    """The distances of points from elements middle +- half; all broadcast."""
    return lengths(from_feet(z, middle, half))


def merge_copies(tables: Sequence[Ints]) -> tuple[Ints, list[Labels]]:
    """Unite the copies of several scenes: the common table, and for each scene the new label of each old one."""
    table, inverse = np.unique(np.concatenate(tables), axis=0, return_inverse=True)
    sizes = np.cumsum([len(rows) for rows in tables])[:-1]
    return table.astype(np.intp), np.split(inverse.reshape(-1).astype(np.int32), sizes)
