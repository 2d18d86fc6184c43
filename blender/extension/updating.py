# SPDX-License-Identifier: GPL-3.0-or-later
"""From what is drawn to what is shown: the engine's tiles at once, or proved.

What the timer does is in no step of undo, and undo keeps what differs from no step: an object that the timer had made
to point at a new one would point at nothing then, and Blender would crash. So objects come and go, and point at others,
only in operators and where a setting is changed (`built`); the timer changes numbers in those that are there.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from voronoi_tiles.base.errors import TouchingCopiesError, VoronoiTilesError
from voronoi_tiles.blender.drawn_tiling import DrawnTiling
from voronoi_tiles.blender.field import lay_field, pivot_of
from voronoi_tiles.blender.polygon_mesh import polygon_prism
from voronoi_tiles.vector.tessellation import TileRecord

from . import reading, showing

NOTHING_DRAWN = "Nothing is drawn: give the curve a spline, or the grease pencil a stroke in this frame."

NO_SITE = "No site is left: select curves or grease pencils beside the tiling, and press Add Selected."

NOT_BUILT = "There are other tiles to show now: press Update."


def update(tiling: Any, *, proof: bool = False, built: bool = False, anew: bool = False) -> None:
    """Show the tiles of what is drawn, proved or not; where it has none, say why, and leave what is shown as it is.

    What is shown already is not computed again, but `anew`. Only where it is `built` do objects come and go.
    """
    settings = tiling.voronoi_tiles
    drawn = reading.drawn_tiling(tiling)
    structure = _structure(tiling)
    now = f"{drawing_of(tiling, drawn)} {structure}"
    is_built = structure == settings.built and not showing.is_copied(tiling)
    known = settings.drawn == now and not anew and (is_built or not built)
    if known and (settings.proved or settings.message or not proof):
        return
    settings.message, place = "", None
    try:
        if not drawn.sites:
            settings.message = NO_SITE
        elif not any(parts for _, parts in drawn.sites):
            settings.message = NOTHING_DRAWN
        elif not is_built and not built:
            settings.message = NOT_BUILT
        else:
            tiles = [tile._record for tile in drawn.proved()] if proof else drawn.tiles()  # noqa: SLF001
            if not is_built:
                _build(tiling, tiles)
                settings.built = structure
            _show(tiling, tiles, drawing_of(tiling, drawn), anew=anew, settled=proof)
    except VoronoiTilesError as error:
        settings.message = drawn.said(error)
        place = error.place if isinstance(error, TouchingCopiesError) else None
    showing.mark_place(tiling, place)
    settings.proved = proof and not settings.message
    settings.drawn = now


def rebuild(tiling: Any) -> None:
    """Build what is shown once more, colours too, and prove it."""
    tiling.voronoi_tiles.built = ""
    update(tiling, proof=True, built=True, anew=True)


def drawing_of(tiling: Any, drawn: DrawnTiling) -> str:
    """What tells a drawing and its height from others."""
    return f"{reading.digest(drawn)} {tiling.voronoi_tiles.height!r}"


def _structure(tiling: Any) -> str:
    """What it depends on which objects there are."""
    settings = tiling.voronoi_tiles
    drawn = reading.drawn_sites(tiling)
    numbers = [number for number, site in enumerate(settings.sites) if site in drawn]
    cells = [settings.columns, settings.rows, settings.colours] if settings.field else []
    return repr([numbers, settings.group, *cells])


def _build(tiling: Any, tiles: Sequence[TileRecord]) -> None:
    """Make the objects of tiles and their copies, and remove those that are not wanted any more."""
    settings = tiling.voronoi_tiles
    copies = None
    if settings.field:
        pivots = [pivot_of(tile.outline) for tile in tiles]
        copies = lay_field(tiles, pivots, settings.columns, settings.rows, settings.colours)
    showing.build_tiles(tiling, reading.drawn_sites(tiling))
    showing.build_field(tiling, copies, [tile.name for tile in tiles])
    settings.placed = ""


def _show(tiling: Any, tiles: Sequence[TileRecord], drawing: str, *, anew: bool, settled: bool) -> None:
    """Show tiles by the objects that are there; what copies are drawn about stays where it can, until it is `settled`.

    Solids of the same drawing stay.
    """
    settings = tiling.voronoi_tiles
    sites = reading.drawn_sites(tiling)
    for site, tile in zip(sites, tiles, strict=True):
        left, bottom, right, top = tile.outline.bounds
        site.size = (right - left, top - bottom)
    showing.show_tiles(sites, [tile.outline for tile in tiles])
    if not settings.field:
        return
    lattice = tiles[0].tessellation.action.lattice
    placed = repr([lattice.a, lattice.b, [[str(own) for own in tile.symmetry] for tile in tiles]])
    pivots = [pivot_of(tile.outline) for tile in tiles]
    moved = settled and pivots != [complex(*site.pivot) for site in sites]
    if anew or moved or settings.placed != placed:
        for site, pivot in zip(sites, pivots, strict=True):
            site.pivot = (pivot.real, pivot.imag)
        showing.place_copies(tiling, lay_field(tiles, pivots, settings.columns, settings.rows, "none"))
        settings.placed = placed
    if showing.proved_solids(tiling, drawing):
        return
    # One for all: so neighbours have the same chords along the edge between them.
    accuracy = min(tile.outline.display_accuracy for tile in tiles)
    for (number, mirrored), mesh in showing.sources(tiling).items():
        outline, pivot = tiles[number].outline, complex(*sites[number].pivot)
        mesh_now = polygon_prism(outline, pivot, settings.height, accuracy, mirrored=mirrored)
        showing.set_mesh(mesh, mesh_now)
