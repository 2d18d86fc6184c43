"""How lofts are drawn in: exactly at their levels, and at as many more as the walls between take to be within slack."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.fabrication.job import JobError
from voronoi_tiles.paths.offset import OffsetError
from voronoi_tiles.solid.assembly import LoftLevel, levels_of, matching, refuse_many
from voronoi_tiles.solid.events import Event, events_between
from voronoi_tiles.solid.inset_depth import InsetDepth
from voronoi_tiles.solid.inset_loft import InsetLevel, InsetLoft, InsetSlab
from voronoi_tiles.solid.inset_rings import InsetRing, LayerOutlines, faces_one
from voronoi_tiles.solid.inset_walls import InsetWall, UsePlaces
from voronoi_tiles.solid.layering import Layering
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.loft import Loft
from voronoi_tiles.solid.loft_middle import LoftMiddle
from voronoi_tiles.vector.outline import Outline

_LOSSES: Final = {"ring": "nothing is left", "neck": "a neck breaks", "gap": "a gap closes"}

_ROUNDS: Final = 9
"""How often levels are put between others, at most; a count: what is left is a five-hundredth of a layer."""

_OUTLINE: Final = 0.1
_CHORDS: Final = 0.3
"""Parts of the slack that a level's outlines and its chords take; the rest is for what lies between levels."""

_FINER: Final = (1.0, 0.25)
"""Parts of these, tried in turn: where sides of two levels lie across each other, walls are four times as far off."""

_SURE: Final = 0.6
"""Half way between levels that are within this part of the slack nothing else is looked at; the levels take 0.4."""

_FINE: Final = 1 / 30
"""How far chords, which stand for an exact tile, may be from it when it is seen; of the slack."""

_ROUNDING: Final = 1e-9
"""A chamfer that is this deep is none; relative to the solid's height."""

_SHARES: Final = (0.5, 0.25, 0.75)
"""Where between two levels it is seen how far walls are from the exact tile; of their distance."""


def inset_loft(loft: Loft, depth: InsetDepth) -> InsetLoft:
    """Draw the tiles of a loft in: exactly at its levels, and at others that are put between until all is within slack.

    Raises JobError, with the site and the height, where that is too much for a tile, or walls do not come within slack,
    ArgumentError where that takes too many triangles.
    """
    for part in _FINER:
        work = _Work(loft, depth, part)
        try:
            return work.whole()
        except _WallsOffError as error:
            off = error
    raise JobError(str(off), remedy="Give a coarser `accuracy`, or draw strokes that move less there.")


class _WallsOffError(Exception):
    """Walls are not within slack, however near to each other levels are; the text says where."""


class _Work:
    """Draws levels in, and puts walls between."""

    def __init__(self, loft: Loft, depth: InsetDepth, part: float) -> None:
        self.loft, self.depth, self.unit, self.part = loft, depth, loft.design.unit_mm, part
        self.notes: list[str] = []
        self.lost: set[str] = set()
        self.triangles = 0
        self.layer_at = Layering(loft.design, loft.motion).layer_at
        # Without a clearance the loft stays what it is between its rims.
        plain = [z for level in loft.levels if depth.at(z := level.core.z * self.unit) <= _ROUNDING * depth.height]
        self.ends = (plain[0], plain[-1]) if plain else (np.inf, -np.inf)
        self.kept = tuple(LoftMiddle.of(mesh, *self.ends) for mesh in loft.meshes) if plain else ()

    def whole(self) -> InsetLoft:
        """All levels, and the walls between."""
        levels = [self.drawn(level) for level in self.levels()]
        found = [pair for low, high in pairwise(levels) for pair in self.up(low, high, _ROUNDS)]
        slabs, above = zip(*found, strict=True)
        return InsetLoft(self.loft, self.depth, self.kept, (levels[0], *above), slabs, tuple(self.notes))

    def levels(self) -> list[LoftLevel]:
        """The levels of the loft that are drawn in, or where a chamfer ends."""
        low, high = self.ends
        return [level for level in self.loft.levels if not low < level.core.z * self.unit < high]

    def drawn(self, level: LoftLevel) -> InsetLevel:
        """A level, drawn in."""
        core, z = level.core, level.core.z * self.unit
        outlines = LayerOutlines.of(core, self.unit, self.part * _OUTLINE * self.depth.slack)
        found = []
        for tile in range(len(core.records)):
            rings = self._kept(outlines, tile, z) if z in self.ends else self._inset(outlines, tile, z)
            own = [int(core.ring[ring.use[0]]) for ring in rings]
            if sorted(own) != list(range(*core.tile_offsets[tile : tile + 2].tolist())):
                raise self._refusal("is too much: a ring is lost", tile, z, core.sites[tile].ends[0, 0] * self.unit)
            found.append(tuple(rings[k] for k in np.argsort(own).tolist()))
            # Each side of a ring is that of a triangle below and of one above.
            self.triangles += 2 * sum(len(ring.points) for ring in rings if ring.number is None)
        refuse_many(self.triangles)
        return InsetLevel(level, z, tuple(found))

    def _kept(self, outlines: LayerOutlines, tile: int, z: float) -> list[InsetRing]:
        """The rings of a tile where a rim ends, as the loft has them."""
        kept = self.kept[tile]
        return [outlines.plain(tile, kept.points(ring), ring) for ring in (kept.bottom, kept.top)[z == self.ends[1]]]

    def _inset(self, outlines: LayerOutlines, tile: int, z: float) -> list[InsetRing]:
        """The rings of a tile, drawn in. Raises JobError where it falls apart."""
        try:
            rings, lost = outlines.inset(tile, self.depth.at(z), self.part * _CHORDS * self.depth.slack)
        except OffsetError as error:
            remedy = "Change it a little, and please report the design."
            raise self._refusal("cannot be applied", tile, z, error.place, remedy) from None
        for loss in lost:
            if loss.kind != "part":
                raise self._refusal(f"is too much: {_LOSSES[loss.kind]}", tile, z, loss.place)
            self._note(tile, z, loss.place)
        return rings

    def up(self, low: InsetLevel, high: InsetLevel, rounds: int) -> Iterator[tuple[InsetSlab, InsetLevel]]:
        """What lies above a level up to another one, from below: slabs, each with the level above it."""
        if (low.z, high.z) == self.ends:
            none: tuple[tuple[()], ...] = ((),) * len(low.rings)
            yield InsetSlab(none, none, None), high
            return
        middle = self.layer_at((low.level.core.z + high.level.core.z) / 2)
        slab = self._slab(low, high, middle)
        if self._is_good(slab, middle, low, high):
            yield slab, high
            return
        if not rounds:
            raise _WallsOffError(
                f"between the heights {low.z:.6g} and {high.z:.6g} mm walls do not come within the `accuracy` of "
                f"{self.depth.accuracy:g} mm of where they are drawn in to"
            )
        layers = [low.level.views[1].layer, middle, high.level.views[0].layer]
        line: list[ExactLayer | Event] = [layers[0]]
        for below, above in pairwise(layers):
            line += [*events_between(below, above, self.layer_at, self.loft.motion.height), above]
        levels = [low, *map(self.drawn, levels_of(line)[1:-1]), high]
        for pair in pairwise(levels):
            yield from self.up(*pair, rounds - 1)

    def _slab(self, low: InsetLevel, high: InsetLevel, middle: ExactLayer) -> InsetSlab:
        """The walls between two levels."""
        below, above = low.level.views[1], high.level.views[0]
        same = matching(below.layer, above.layer)
        places = UsePlaces.of(below.layer)
        under = places.carried(below.same.reversed, low.level.core)
        over = places.carried(same, above.layer).carried(above.same.reversed, high.level.core)
        walls: list[tuple[InsetWall, ...]] = []
        onto: list[tuple[int, ...]] = []
        for lower, upper in zip(low.rings, high.rings, strict=True):
            number = {int(over.ring[ring.use[0]]): k for k, ring in enumerate(upper)}
            onto.append(tuple(number[int(under.ring[ring.use[0]])] for ring in lower))
            pairs = [(ring, upper[k]) for ring, k in zip(lower, onto[-1], strict=True)]
            loops = [
                faces_one(low.level.core, int(one.use[0])) and faces_one(high.level.core, int(two.use[0]))
                for one, two in pairs
            ]
            walls.append(
                tuple(
                    InsetWall.between(one, under.along(one), two, over.along(two), loop=loop)
                    for (one, two), loop in zip(pairs, loops, strict=True)
                )
            )
        return InsetSlab(tuple(walls), tuple(onto), middle)

    def _is_good(self, slab: InsetSlab, middle: ExactLayer, low: InsetLevel, high: InsetLevel) -> bool:
        """Whether walls are within slack where it is seen."""
        bottom, top = low.level.core.z, high.level.core.z
        # The quarters are, to the bit, the middles of what is looked at next where this is not good.
        for share, z in zip(_SHARES, (middle.z, (bottom + middle.z) / 2, (middle.z + top) / 2), strict=True):
            layer = self.layer_at(z)
            # The exact tiles are chords here, too.
            slack = self.depth.slack * (1 - _FINE)
            off = 0.0
            for record, walls in zip(layer.records, slab.walls, strict=True):
                away = distances([wall.at(share) for wall in walls], record.outline, self.unit, _FINE * slack)
                off = max(off, float(np.abs(away - self.depth.at(z * self.unit)).max()))
            if not off <= slack:
                return False
            if share == 0.5 and off <= _SURE * slack:
                return True
        return True

    def _refusal(self, what: str, tile: int, z: float, place: complex, remedy: str | None = None) -> JobError:
        """What a tile cannot bear."""
        name, given = self._asked(z)
        site = self.loft.design.noded[tile].name
        return JobError(
            f"`{name}='{given:g}mm'` {what} at ({place.real:.4g}, {place.imag:.4g}) mm in the tile of site \"{site}\", "
            f"at the height {z:.4g} mm",
            remedy=remedy or f"Use a smaller `{name}`, or a larger design.",
        )

    def _note(self, tile: int, z: float, place: complex) -> None:
        """Say of a tile once that it loses something."""
        site = self.loft.design.noded[tile].name
        if site not in self.lost:
            self.lost.add(site)
            name, given = self._asked(z)
            self.notes.append(
                f"`{name}='{given:g}mm'`: a thin part of the tile of site \"{site}\" vanishes at ({place.real:.4g}, "
                f"{place.imag:.4g}) mm, at the height {z:.4g} mm and perhaps elsewhere"
            )

    def _asked(self, z: float) -> tuple[str, float]:
        """The option that takes most at a height, and its millimetres."""
        depth = self.depth
        return ("chamfer", depth.chamfer) if depth.rim(z) > depth.half else ("clearance", 2 * depth.half)


def distances(rings: Sequence[Complexes], outline: Outline, unit: float, accuracy: float) -> Floats:
    """How far corners and middles of sides of rings, in millimetres, are from an outline in units of `unit` of them.

    The outline is taken for chords within an accuracy.
    """
    import shapely

    points = np.concatenate([np.concatenate((ring, (ring + np.roll(ring, -1)) / 2)) for ring in rings]) / unit
    edge = outline.to_shapely(accuracy=accuracy / unit).boundary
    return np.asarray(shapely.distance(shapely.points(points.real, points.imag), edge) * unit)
