"""The strokes of a design as a function of height: interpolated between keys, scaled, turned and moved."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import ceil, radians
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.maps import Isometry, unit_at
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.site import NodedSite, build_site
from voronoi_tiles.designs.solid_checking import CheckedSolid, DrawnInHeight, DrawnStroke, like
from voronoi_tiles.designs.strokes import ARC_SHARE, is_flat
from voronoi_tiles.groups.wallpaper import Lattice
from voronoi_tiles.paths.paths import halves

_FARTHEST: Final = 0.25
"""How far a point moves at most between two layers; relative to the cell's shorter vector."""


@dataclass(frozen=True, eq=False)
class SiteMotion:
    """The strokes of a site at the heights of its keys, flattened alike.

    `lines` are its polylines, each complex128 (keys, n): the same parameters of curves at all heights, so that points
    move along straight lines between keys. `heights` are those of the keys, float64 (keys,), ascending from 0.
    """

    name: str
    heights: Floats
    lines: tuple[Complexes, ...]

    def drawn(self, z: float) -> list[Complexes]:
        """The polylines at a height, before they are turned; beyond the last key they are as they are there."""
        if len(self.heights) == 1:
            return [line[0] for line in self.lines]
        k = int(np.clip(np.searchsorted(self.heights, z, side="right") - 1, 0, len(self.heights) - 2))
        low, high = self.heights[k : k + 2].tolist()
        t = min((z - low) / (high - low), 1.0)
        if t in (0.0, 1.0):
            return [line[k + int(t)] for line in self.lines]
        return [line[k] * (1.0 - t) + line[k + 1] * t for line in self.lines]


@dataclass(frozen=True, eq=False)
class Motion:
    """The strokes of all sites as a function of the height z, from 0 to `height`, in the design's units.

    They are interpolated, then scaled and turned about a point, by a factor that runs from 1 and an angle that runs
    from 0 to those at the top, and moved: all linear in z.
    """

    solid: CheckedSolid
    moving: tuple[SiteMotion, ...]
    lattice: Lattice

    @classmethod
    def of(cls, design: Design) -> Motion:
        """The motion of a design. Raises ArgumentError where it has no solid."""
        solid = design.standing
        if solid is None:
            raise ArgumentError(
                "the design is flat", remedy="Write [solid] and, below it, height = 20 and what moves on the way up."
            )
        finest = max(1.0, solid.scale)
        moving = (
            SiteMotion(site.name, np.array([key.z for key in drawn.keys]), _lines(drawn, finest))
            for site, drawn in zip(design.noded, solid.sites, strict=True)
        )
        return cls(solid, tuple(moving), design.lattice)

    @property
    def height(self) -> float:
        """The height of the solid."""
        return self.solid.height

    @cached_property
    def layers(self) -> Floats:
        """The heights that have exact tiles at least, ascending: equally spaced, and those of keys among them.

        Between two of them no point moves farther than a share of the cell: strokes that come round to where they have
        been are seen on their way.
        """
        equal = np.linspace(0.0, self.height, self.solid.layers)
        keys = np.concatenate([site.heights for site in self.moving])
        near = np.abs(equal[:, None] - keys).min(axis=1) < 1e-6 * self.height
        kept = np.unique(np.concatenate((equal[~near | (equal == 0.0) | (equal == self.height)], keys)))
        far = _FARTHEST * abs(self.lattice.reduced_basis[0])
        parts = [
            np.linspace(low, high, max(ceil(self.travel(low, high) / far), 1) + 1)
            for low, high in pairwise(kept.tolist())
        ]
        return np.unique(np.concatenate(parts))

    def heights_with(self, asked: Iterable[float]) -> list[float]:
        """The heights of `layers` and others that are asked for, ascending; those close by give way to these.

        Raises ArgumentError for heights that are outside of the solid.
        """
        wanted = np.unique(np.array([*asked, 0.0, self.height], np.float64))
        if not (0.0 <= wanted[0] <= wanted[-1] <= self.height):  # not a number is the last one
            raise ArgumentError(f"a layer is asked for outside of the solid, which is {self.height:g} high")
        near = np.abs(self.layers[:, None] - wanted).min(axis=1) < 1e-6 * self.height
        found: list[float] = np.unique(np.concatenate((self.layers[~near], wanted))).tolist()
        return found

    def at(self, z: float) -> list[NodedSite]:
        """The sites at a height."""
        return [build_site(site.name, [self._moved(z, line) for line in site.drawn(z)]) for site in self.moving]

    def points(self, z: float) -> list[Complexes]:
        """The points of each site's polylines at a height: the same ones, in the same order, at all heights."""
        return [self._moved(z, np.concatenate(site.drawn(z))) for site in self.moving]

    def _moved(self, z: float, points: Complexes) -> Complexes:
        """Points of the interpolated drawing where they are at a height."""
        solid, t = self.solid, z / self.height
        factor, degrees = 1.0 + (solid.scale - 1.0) * t, solid.turn * t
        if degrees == 0.0:  # and no bit changes
            return (
                points
                if factor == 1.0 and not solid.shift
                else (points - solid.about) * factor + (solid.about + solid.shift * t)
            )
        turned = Isometry(unit_at(degrees), solid.about + solid.shift * t, conj=False)
        return turned((points - solid.about) * factor)

    def travel(self, low: float, high: float) -> float:
        """No point goes a longer way from one height to another, which is above it; a length."""
        inner = {z for site in self.moving for z in site.heights.tolist() if low < z < high}
        return sum(self._way(below, above) for below, above in pairwise([low, *sorted(inner), high]))

    def _way(self, low: float, high: float) -> float:
        """The same between two heights that have no key between them."""
        solid, longest, share = self.solid, 0.0, (high - low) / self.height
        grown = max(abs(1.0 + (solid.scale - 1.0) * z / self.height) for z in (low, high))
        turning, growing = radians(abs(solid.turn)) * share, abs(solid.scale - 1.0) * share
        for site in self.moving:
            before, after = (np.concatenate(site.drawn(z)) for z in (low, high))
            away = max(float(np.abs(points - solid.about).max()) for points in (before, after))
            along = float(np.abs(after - before).max())
            longest = max(longest, grown * along + away * (growing + grown * turning))
        return longest + abs(solid.shift) * share


def _lines(drawn: DrawnInHeight, grown: float) -> tuple[Complexes, ...]:
    """The polylines of a site at all its keys, each complex128 (keys, n), in the order in which a design has them."""
    strokes: list[Sequence[DrawnStroke]] = list(zip(*(key.strokes for key in drawn.keys), strict=True))
    lines = [np.array(like(stroke)) for stroke in strokes if not stroke[0][1]]
    bent = [np.stack([pieces for pieces, _ in stroke]) for stroke in strokes if stroke[0][1]]
    if bent:
        lines += _flattened(np.concatenate(bent, axis=1), drawn.accuracy * (1.0 - ARC_SHARE) / grown)
    return tuple(lines)


def _flattened(pieces: Complexes, accuracy: float) -> list[Complexes]:
    """Curves at several heights, complex128 (keys, n, 4), flattened at the same parameters; (keys, m) for each run.

    A part is halved until it is flat at all keys. Then it is so between them: how far a curve is from its chord is no
    more than what is interpolated between its distances at the keys.
    """
    keys, count = pieces.shape[:2]
    owner, place, width = np.arange(count), np.zeros(count), 1.0
    begins, owners, places = [], [], []
    rest = pieces
    while rest.shape[1]:
        flat = np.all([is_flat(rest[k], accuracy) for k in range(keys)], axis=0)
        begins.append(rest[:, flat, 0])
        owners.append(owner[flat])
        places.append(place[flat])
        rest, owner, place, width = rest[:, ~flat], owner[~flat], place[~flat], width / 2
        split = halves(rest.reshape(-1, 4).T).reshape(4, 2, keys, -1)
        rest = np.concatenate((split[:, 0], split[:, 1]), axis=2).transpose(1, 2, 0)
        owner, place = np.concatenate((owner, owner)), np.concatenate((place, place + width))
    owner = np.concatenate(owners)
    order = np.lexsort((np.concatenate(places), owner))
    begin, owner = np.concatenate(begins, axis=1)[:, order], owner[order]
    # A run ends where the next piece starts elsewhere, in the drawing of the design.
    ends = np.flatnonzero(np.append((pieces[0, 1:, 0] != pieces[0, :-1, 3]), True))
    bounds = np.searchsorted(owner, np.append(-1, ends), side="right")
    return [
        np.concatenate((begin[:, low:high], pieces[:, end, 3:]), axis=1)
        for low, high, end in zip(bounds[:-1].tolist(), bounds[1:].tolist(), ends.tolist(), strict=True)
    ]
