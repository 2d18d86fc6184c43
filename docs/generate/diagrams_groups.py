"""The 17 wallpaper groups: one picture each, of one motif in tiles of one area."""

from __future__ import annotations

import numpy as np
from diagrams_style import INK, Complexes, bare, drawing, fill, strokes
from diagrams_tables import cell_of, determinant
from matplotlib.axes import Axes

from voronoi_tiles import GROUPS, Design, Lattice, Operation, Tiling, WallpaperGroup
from voronoi_tiles.designs.strokes import catmull_rom_pieces
from voronoi_tiles.groups.symmetry_elements import placed, symmetry_elements

_MOTIF = 1.15 * np.array([-2.6 + 0.8j, 1.2 - 0.7j, 3.6 + 0.5j, 2.5 + 2.6j])
_WINDOW = 44.0
_DIRECT = ("#f2a541", "#f6c177", "#e98a3a", "#f9d8a3", "#d9772b", "#fbe4c0")
_MIRRORED = ("#3f9c9c", "#7dbcb8", "#2c7f86", "#a5d1cc", "#5aaeb0", "#c4e3de")
_MIRROR, _GLIDE, _CENTRE = "#b2182b", "#2166ac", "#4b1248"


def place_motif(group: WallpaperGroup, lattice: Lattice) -> Complexes:
    """The motif where it keeps farthest from its copies, of a grid of places in the cell and of directions."""
    motif = _MOTIF - _MOTIF.mean()
    pieces = catmull_rom_pieces(motif)
    t = np.linspace(0.0, 1.0, 5)[:, None]
    curve = (
        (1 - t) ** 3 * pieces[:, 0]
        + 3 * t * (1 - t) ** 2 * pieces[:, 1]
        + 3 * t**2 * (1 - t) * pieces[:, 2]
        + t**3 * pieces[:, 3]
    ).reshape(-1)
    steps = (np.arange(16) + 0.5) / 16
    places = (steps[:, None] * lattice.a + steps * lattice.b).reshape(-1)
    turns = np.exp(1j * np.radians(np.arange(0, 360, 30)))
    moved = (places[:, None, None] + turns[:, None] * curve).reshape(-1, len(curve))
    nearest = np.full(len(moved), np.inf)
    for operation in group.operations:
        for i in range(-2, 3):
            for j in range(-2, 3):
                motion = operation.translated(i, j)
                if motion.is_identity:
                    continue
                image = lattice.isometry(motion)(moved)
                apart = np.abs(moved[:, :, None] - image[:, None, :]).min(axis=(1, 2))
                nearest = np.minimum(nearest, apart)
    place, turn = divmod(int(nearest.argmax()), len(turns))
    return np.asarray(places[place] + turns[turn] * motif)


def design_of(name: str) -> Design:
    """The design of a group's picture."""
    group = GROUPS[name]
    cell = cell_of(group)
    motif = place_motif(group, group.lattice(**cell))
    through = [[float(z.real), float(z.imag)] for z in np.round(motif, 3)]
    site = {"name": "motif", "tolerance": 0.06, "strokes": [{"catmull_rom": through}]}
    return Design.from_dict({"schema": 1, "group": name, "cell": cell, "site": [site]})


def draw_group(name: str) -> None:
    """Write the picture of a group: its tiles, coloured by how they lie, its motifs and its symmetry elements."""
    tiling = design_of(name).tessellate()
    box = tiling.tiles[0].outline.bounds
    corner = complex(box[0] + box[2] - _WINDOW, box[1] + box[3] - _WINDOW) / 2
    window = (corner.real, corner.imag, corner.real + _WINDOW, corner.imag + _WINDOW)
    with drawing(f"group-{name}.svg", (2.6, 2.6)) as (_, axes):
        bare(axes, np.array([complex(*window[:2]), complex(*window[2:])]))
        _tiles(axes, tiling, window)
        _symmetry(axes, tiling, window)


def _tiles(axes: Axes, tiling: Tiling, window: tuple[float, float, float, float]) -> None:
    design, tile = tiling.design, tiling.tiles[0]
    elements = tile.site.elements
    ends = elements[:, ::2] + 1j * elements[:, 1::2]
    lies: dict[tuple[int, int, int, int], int] = {}
    for operation in design.group.operations:
        kinds = [linear for linear in lies if determinant(linear) == operation.determinant]
        lies.setdefault(operation.linear, len(kinds))
        colour = (_DIRECT if operation.determinant == 1 else _MIRRORED)[lies[operation.linear]]
        for motion in _shown(operation, tiling, window):
            fill(axes, tile.copy(motion), fc=colour)
            image = design.lattice.isometry(motion)(ends)
            own = motion.is_identity
            lines = np.stack([image.real[:, 0], image.imag[:, 0], image.real[:, 1], image.imag[:, 1]], axis=1)
            strokes(axes, lines, INK if own else "#5b4a3a", 2.0 if own else 0.9)


def _shown(operation: Operation, tiling: Tiling, window: tuple[float, float, float, float]) -> list[Operation]:
    """The operation with all lattice translations that put the tile into the window."""
    outline, lattice = tiling.tiles[0].outline, tiling.design.lattice
    reach = range(-8, 9)
    result = []
    box = outline.bounds
    corners = np.array([complex(x, y) for x in box[::2] for y in box[1::2]])
    for i in reach:
        for j in reach:
            image = lattice.isometry(operation.translated(i, j))(corners)
            apart = image.real.max() < window[0] or image.real.min() > window[2]
            if not (apart or image.imag.max() < window[1] or image.imag.min() > window[3]):
                result.append(operation.translated(i, j))
    return result


def _symmetry(axes: Axes, tiling: Tiling, window: tuple[float, float, float, float]) -> None:
    design = tiling.design
    found = placed(symmetry_elements(design.group), design.lattice, window)
    for ends in found.glides:
        axes.plot(ends.real, ends.imag, color=_GLIDE, lw=0.9, dashes=(4, 2.5), zorder=6)
    for ends in found.mirrors:
        axes.plot(ends.real, ends.imag, color=_MIRROR, lw=1.1, zorder=6)
    # A lens would be the usual sign of a half turn; a rhombus is what matplotlib has.
    for order, marker, size in ((2, "d", 4.6), (3, "^", 5.2), (4, "s", 4.6), (6, "h", 6.0)):
        at = found.centres[found.orders == order]
        axes.plot(at.real, at.imag, marker, color=_CENTRE, ms=size, mec="white", mew=0.5, zorder=7)


def write() -> None:
    """Write the groups' pictures."""
    for name in GROUPS:
        draw_group(name)
