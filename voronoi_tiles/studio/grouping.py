"""A drawing in another wallpaper group: where it is, if its copies keep apart there, else where they do."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from voronoi_tiles.base.errors import ProofError, TouchingCopiesError
from voronoi_tiles.designs.checking import read_group
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.proposals import placed
from voronoi_tiles.groups.wallpaper import WallpaperGroup
from voronoi_tiles.studio.outlining import cosets, path_of
from voronoi_tiles.vector.tessellation import TileRecord, tessellate


def group_message(rev: int, design: Mapping[str, Any], group: str) -> dict[str, Any]:
    """The message "group": a design in another group, and its tiles as a thumbnail draws them.

    Raises DesignError where the design cannot be used, TouchingCopiesError where no place is found.
    """
    found, tiles = regrouped(Design.from_dict(design), read_group(group))
    lattice = found.lattice
    return {
        "type": "group",
        "rev": rev,
        "group": group,
        "design": found.to_dict(),
        "scale": found.scale,
        "lattice": {"a": [lattice.a.real, lattice.a.imag], "b": [lattice.b.real, lattice.b.imag]},
        "tiles": [{"path": path_of(tile.outline), "operations": cosets(found.group, tile.symmetry)} for tile in tiles],
    }


def regrouped(design: Design, group: WallpaperGroup) -> tuple[Design, list[TileRecord]]:
    """A design in another group, and its tiles, not proved.

    The cell keeps its sides and its angle where the group leaves them free, and the strokes stay; where their copies
    would touch, cell and place are found anew. Raises DesignError, TouchingCopiesError.
    """
    try:
        kept = design.replace(group=group, cell=cell_in(group, design))
        return kept, _tiles(kept)
    except (TouchingCopiesError, ProofError):
        moved = placed(design, group)
        return moved, _tiles(moved)


def cell_in(group: WallpaperGroup, design: Design) -> dict[str, float]:
    """The cell of a design as another group takes it, before the design's scale: what it leaves free, as it was."""
    cell = design.cell
    side = cell["a"]
    angle = cell.get("angle", design.group.fixed_angle or 90.0)
    free = {"a": side, "b": cell.get("b", side), "angle": angle}
    if group.fixes_b:
        del free["b"]
    if group.fixed_angle is not None:
        del free["angle"]
    return free


def _tiles(design: Design) -> list[TileRecord]:
    """The tiles of a design, not proved."""
    return tessellate(design.noded, design.group, design.lattice)
