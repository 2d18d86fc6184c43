"""A sheet of a stack: pieces that are labelled by their sheet and their stack, with holes for dowels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from math import pi
from typing import Final, Self

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.fabrication.contours import ClosedPieces
from voronoi_tiles.fabrication.layout import Contours, Layout
from voronoi_tiles.paths.paths import ARC, Paths
from voronoi_tiles.paths.winding import winding
from voronoi_tiles.solid.dowel_holes import wall_of

_TURNED: Final = frozenset("01689.")
"""The signs of which a text consists that is one as well when it is turned by half a turn."""


@dataclass(frozen=True, eq=False)
class StackLayout(Layout):
    """The layout of a sheet of a stack, the number of which is `level`.

    `holes` are the centres of the holes of each site's tile, where it is drawn: complex128 (n,) each, in millimetres;
    `diameter` is what they have when they are cut. Of a tile that the sheet's edge cuts, those are left out that have
    no wall there.
    """

    level: int = 1
    holes: tuple[Complexes, ...] = ()
    diameter: float = 0.0

    @classmethod
    def of(cls, layout: Layout, level: int, holes: Sequence[Complexes], diameter: float | None) -> Self:
        """A layout with holes, and the number of its sheet."""
        own = {field.name: getattr(layout, field.name) for field in fields(Layout)}
        return cls(**own, level=level, holes=tuple(holes), diameter=diameter or 0.0)

    def numbered(self, number: int) -> str:
        """The number of the sheet, and on a sheet that is full that of the stack; a full stop says which way up."""
        text = str(self.level) if self.region is None else f"{self.level}.{number}"
        return f"{text}." if set(text) <= _TURNED and set(text) & set("69") else text

    @property
    def stacks(self) -> set[tuple[int, int]]:
        """The stacks that it has pieces of: site and number."""
        numbers = np.arange(len(self.site)) if self.numbers is None else self.numbers
        return set(zip(self.site.tolist(), numbers.tolist(), strict=True))

    @cached_property
    def tile_areas(self) -> Floats:
        """The areas of the period's tiles without their holes, square millimetres."""
        bored = np.array([len(own) for own in self.holes] or [0] * (int(self.period.site.max()) + 1))
        return super().tile_areas - bored[self.period.site] * self._hole_area

    def rest_areas(self, rest: ClosedPieces) -> Floats:
        """The areas of the pieces of `rest` without their holes, square millimetres."""
        bored = [len(self._bored(rest.tile[k], rest.paths.take(_own(rest.items, k)))) for k in range(len(rest.tile))]
        return super().rest_areas(rest) - np.array(bored) * self._hole_area

    @property
    def bores(self) -> Paths:
        """The holes of all pieces."""
        contours = self.contours
        return Paths.empty() if contours.loose is None else contours.paths.take(np.flatnonzero(contours.loose))

    @cached_property
    def contours(self) -> Contours:
        """The closed contours of all pieces, the holes among them, which lose what the kerf adds."""
        plain = super().contours
        if not self.holes:
            return plain
        radius = (self.diameter - self.job.kerf) / 2
        parts, counts, loose = [], [], []
        for k, copy in enumerate(plain.copy.tolist()):
            rings = plain.paths.take(_own(plain.items, k))
            centres = self._bored(copy, rings)
            parts += [rings, circles(centres, radius)]
            counts.append(len(rings) + len(centres))
            loose += [False] * len(rings) + [True] * len(centres)
        items = np.append(0, np.cumsum(counts)).astype(np.intp)
        return Contours(Paths.concatenate(parts), items, plain.copy, plain.area, np.array(loose, np.bool_))

    @property
    def _hole_area(self) -> float:
        """The area of a hole; square millimetres."""
        return pi * self.diameter**2 / 4

    def _bored(self, copy: int, rings: Paths) -> Complexes:
        """The centres of the holes of a piece that is a copy, or part of it, with these rings."""
        if copy < 0 or not self.holes:
            return np.zeros(0, np.complex128)
        centres = self._centres[copy]
        if self.copies.whole[copy]:
            return centres
        assert self.region is not None
        room = self.diameter / 2 + wall_of(self.diameter)
        return centres[(winding(rings, centres) > 0) & (self.region.distance(centres) >= room)]

    @cached_property
    def _centres(self) -> list[Complexes]:
        """The centres of the holes of each copy, on the page."""
        return hole_centres(self, self.holes)


def hole_centres(layout: Layout, holes: Sequence[Complexes]) -> list[Complexes]:
    """The centres of the holes of each copy on the page; `holes` are those of each site's tile where it is drawn."""
    page, period, placed = layout.tiles.page, layout.period, layout.tessellation.placed
    unit = layout.design.unit_mm
    base = []
    for site, motion in zip(period.site.tolist(), period.motion, strict=True):
        factor, shift, conj = page.after(motion)
        own = holes[site] / unit - page.action.cartesian(*placed[site].shift)
        base.append(factor * (own.conj() if conj else own) + shift)
    return [base[tile] + by for tile, by in zip(layout.copies.tile.tolist(), layout.copy_shifts, strict=True)]


def circles(centres: Complexes, radius: float) -> Paths:
    """Circles as holes are: clockwise, of two arcs each."""
    start = np.column_stack((centres + radius, centres - radius)).ravel()
    end = np.column_stack((centres - radius, centres + radius)).ravel()
    control = np.zeros((len(start), 2), np.complex128)
    control[:, 0] = np.column_stack((centres - 1j * radius, centres + 1j * radius)).ravel()
    return Paths(
        start,
        end,
        control,
        np.full(len(start), ARC, np.uint8),
        2 * np.arange(len(centres) + 1),
        np.ones(len(centres), np.bool_),
    )


def _own(items: Ints, k: int) -> Ints:
    """The rings of piece k."""
    return np.arange(items[k], items[k + 1])
