"""The tiles of a period as they are cut: where they lie on the page, with kerf and fillets applied."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.fabrication.kerf import Compensation
from voronoi_tiles.fabrication.spacing import Spacing
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.symmetric_halves import moved
from voronoi_tiles.vector.complex.period import Period
from voronoi_tiles.vector.motions import Action, Motion, compose, inverse


@dataclass(frozen=True, slots=True)
class PageMap:
    """What takes the design's plane to the page: z -> `factor` z + `shift`."""

    action: Action
    factor: complex
    shift: complex

    def moved(self, shift: complex) -> PageMap:
        """The same, followed by a shift on the page."""
        return replace(self, shift=self.shift + shift)

    def after(self, motion: Motion) -> tuple[complex, complex, bool]:
        """A motion of the design's plane followed by this: factor, shift, and whether z is conjugated first."""
        unit, place, conj = self.action.isometry(motion)
        return self.factor * unit, self.factor * place + self.shift, conj

    def isometry(self, motion: Motion) -> Isometry:
        """What a motion of the design's plane is on the page."""
        unit, place, conj = self.action.isometry(motion)
        factor = unit * (self.factor / self.factor.conjugate()) if conj else unit
        base = self.shift.conjugate() if conj else self.shift
        return Isometry(factor, self.factor * place + self.shift - factor * base, conj)


@dataclass(frozen=True, eq=False)
class DressedTiles:
    """The rings of a period's tiles on the page, as they are cut; the tiles of one site are images of the first.

    `pulled_by` are the points by which tiles are pulled apart, None for the middles of their boxes.
    """

    period: Period
    page: PageMap
    compensation: Compensation
    pulled_by: Complexes | None = None
    _rings: dict[int, Paths] = field(default_factory=dict)
    _spacing: dict[float, Spacing] = field(default_factory=dict)

    def moved(self, shift: complex) -> DressedTiles:
        """The same elsewhere on the page."""
        rings = {tile: rings.moved(1.0, shift) for tile, rings in self._rings.items()}
        by = None if self.pulled_by is None else self.pulled_by + shift
        period, page = self.period.placed(1.0, shift), self.page.moved(shift)
        return replace(self, period=period, page=page, pulled_by=by, _rings=rings)

    def pulled(self, points: Complexes) -> DressedTiles:
        """The same that are pulled apart by other points, one for each tile of the period."""
        return replace(self, pulled_by=points, _spacing={})

    def compensated(self, compensation: Compensation) -> DressedTiles:
        """The same tiles with another compensation."""
        return DressedTiles(self.period, self.page, compensation)

    def rings(self, tile: int) -> Paths:
        """The rings of a tile where it stands in the period. Raises JobError where it does not survive."""
        if tile not in self._rings:
            first = int(np.flatnonzero(self.period.site == self.period.site[tile])[0])
            if tile == first:
                rings, items = self.period.own_outlines
                self._rings[tile] = self.compensation.tile(rings.take(np.arange(items[tile], items[tile + 1])))
            else:
                image = self.page.isometry(compose(self.period.motion[tile], inverse(self.period.motion[first])))
                rings = moved(self.rings(first), image)
                # The material stays on the left.
                self._rings[tile] = rings.reversed() if image.conj else rings
        return self._rings[tile]

    def all_rings(self) -> list[Paths]:
        """The rings of all tiles."""
        return [self.rings(tile) for tile in range(len(self.period.site))]

    def spacing(self, accuracy: float) -> Spacing:
        """How the tiles are pulled apart, by chords within an accuracy; wherever they are moved together."""
        if accuracy not in self._spacing:
            contours = [to_lines(rings, accuracy=accuracy) for rings in self.all_rings()]
            self._spacing[accuracy] = Spacing(contours, self.centres(), self.period.basis)
        return self._spacing[accuracy]

    def centres(self) -> Complexes:
        """The points by which tiles are pulled apart."""
        return self._centres if self.pulled_by is None else self.pulled_by

    @cached_property
    def _centres(self) -> Complexes:
        """The middles of the tiles' boxes, found once."""
        boxes = np.array([rings.bounds for rings in self.all_rings()])
        return np.asarray((boxes[:, 0] + boxes[:, 2]) / 2 + 1j * (boxes[:, 1] + boxes[:, 3]) / 2)
