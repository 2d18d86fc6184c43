"""Which copies of tiles fill a field of cells: where each is, whether it is turned over, and its colour."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.fabrication.tile_colouring import colour_tiles
from voronoi_tiles.groups.periodic_colouring import palette
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup
from voronoi_tiles.vector.copies import translation
from voronoi_tiles.vector.motions import compose, modulo_lattice, to_motion
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.tessellation import TileRecord

FIELD_MAX: Final = 5_000
"""Most copies of a field; a count. Each is an object, of which Blender's views take no more at ease."""

_PIVOT_STEPS: Final = 64
"""Pivots are multiples of a part of the power of two below a tile's size; a count. So they are exact in float32."""


_CELL_BEGINS: Final = -0.25
"""Where cells begin that sites are counted in; a share of the cell. Few tiles have their middle there."""


_IDENTITY: Final = Operation.parse("x,y")


class FieldCopies(NamedTuple):
    """Copies of tiles, one a row: z -> unit z + shift of the tile's mesh about its pivot, turned over where `mirrored`.

    There is one for each operation of the group, site and cell, whatever maps the site onto itself: where several give
    the same copy, one is `shown`. `tile` is the number of the site, `colour` an index of `colours`, "#rrggbb"; `names`
    say site and operation.
    """

    tile: Ints
    mirrored: Bools
    shown: Bools
    unit: Complexes
    shift: Complexes
    colour: Ints
    names: tuple[str, ...]
    colours: tuple[str, ...]

    def matrices(self) -> Floats:
        """The maps as Blender has them, float64 (n, 4, 4): rotations and shifts alone."""
        found = np.zeros((len(self.tile), 4, 4))
        found[:, 0, 0] = found[:, 1, 1] = self.unit.real
        found[:, 1, 0], found[:, 0, 1] = self.unit.imag, -self.unit.imag
        found[:, 2, 2] = found[:, 3, 3] = 1.0
        found[:, 0, 3], found[:, 1, 3] = self.shift.real, self.shift.imag
        return found


def pivot_of(outline: Outline) -> complex:
    """The middle of a tile, rounded so that single precision holds it: what its mesh is drawn about."""
    left, bottom, right, top = outline.bounds
    step = 2.0 ** math.floor(math.log2(max(right - left, top - bottom))) / _PIVOT_STEPS
    return complex(round((left + right) / 2 / step) * step, round((bottom + top) / 2 / step) * step)


def copies_in_cell(group: WallpaperGroup, symmetry: Sequence[Operation]) -> list[bool]:
    """Of each operation of a group whether it is the one by which a copy of a site is shown.

    `symmetry` are the operations that map the site onto itself: as many give one copy. One that does not turn the site
    over comes before those that do.
    """
    shown: set[Operation] = set()
    covered: set[Operation] = set()
    for operation in sorted(group.operations, key=lambda one: -one.determinant):
        if operation not in covered:
            shown.add(operation)
            covered |= {(operation @ own).reduced() for own in symmetry}
    return [operation in shown for operation in group.operations]


def lay_field(
    tiles: Sequence[TileRecord], pivots: Sequence[complex], columns: int, rows: int, scheme: str
) -> FieldCopies:
    """The copies of all tiles in so many cells along a and along b, each tile about its pivot.

    The first site is in the middle one of the cells, wherever it is drawn; colours are by `scheme`, as of
    `colour_tiles`. Raises ArgumentError for more copies than FIELD_MAX.
    """
    tessellation = tiles[0].tessellation
    group, lattice = tessellation.action.group, tessellation.action.lattice
    count = columns * rows * len(tiles) * group.order
    if count > FIELD_MAX:
        raise ArgumentError(
            f"a field of {columns} x {rows} cells has {count:,} tiles",
            remedy=f"Take fewer cells: {FIELD_MAX:,} tiles are the most.",
        )
    i, j = (steps.ravel() for steps in np.meshgrid(_middle(columns), _middle(rows), indexing="ij"))
    colouring = colour_tiles(tessellation, scheme)
    period = tessellation.period
    place = {
        (site, modulo_lattice(motion)): (k, motion)
        for k, (site, motion) in enumerate(zip(period.site.tolist(), period.motion, strict=True))
    }
    cells = [_cell_of(lattice, pivot) for pivot in pivots]
    parts = []
    for k, tile in enumerate(tiles):
        for modulo, shown in zip(group.operations, copies_in_cell(group, tile.symmetry), strict=True):
            # From the site's own cell to that of the first.
            operation = modulo @ _IDENTITY.translated(*(-step for step in cells[k]))
            operation = operation.translated(*cells[0])
            isometry = lattice.isometry(operation)
            shift = tessellation.action.cartesian(
                float(operation.translation[0]) + i, float(operation.translation[1]) + j
            )
            # Colours are of tiles near the origin, where their sites are placed.
            placed = tessellation.placed[k]
            motion = placed.canonical(compose(to_motion(operation), translation(placed, 1)))
            at, stands = place[k, modulo_lattice(motion)]
            steps = np.column_stack(
                (
                    np.full(len(i), at),
                    i + (motion[4] - stands[4]) // 2,
                    j + (motion[5] - stands[5]) // 2,
                )
            )
            names = [f"{tile.name} {operation.translated(*step)}" for step in zip(i.tolist(), j.tolist(), strict=True)]
            turned = isometry._replace(b=0j)(pivots[k])
            parts.append((k, isometry.conj, shown, isometry.a, shift + turned, colouring.of(steps), names))
    sizes = [len(i)] * len(parts)
    return FieldCopies(
        tile=np.repeat([part[0] for part in parts], sizes),
        mirrored=np.repeat([part[1] for part in parts], sizes),
        shown=np.repeat([part[2] for part in parts], sizes),
        unit=np.repeat([part[3] for part in parts], sizes),
        shift=np.concatenate([part[4] for part in parts]),
        colour=np.concatenate([part[5] for part in parts]),
        names=tuple(name for part in parts for name in part[6]),
        colours=tuple(f"#{bytes(shade).hex()}" for shade in palette(colouring.count)),
    )


def _middle(count: int) -> Ints:
    """So many whole numbers, 0 in their middle."""
    return np.arange(count) - (count - 1) // 2


def _cell_of(lattice: Lattice, place: complex) -> tuple[int, int]:
    """The cell that a place is in."""
    x, y = lattice.fractional(place)
    return math.floor(x - _CELL_BEGINS), math.floor(y - _CELL_BEGINS)
