"""A folder of fits: designs with their art, pictures, a table and a contact sheet."""

from __future__ import annotations

import cmath
import csv
import io
import json
import math
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.files import write_whole
from voronoi_tiles.base.folders import filling
from voronoi_tiles.designs.art import GUIDE, Art
from voronoi_tiles.designs.drawn_site import Site
from voronoi_tiles.escherization.carried_art import CarriedArt, carried_art
from voronoi_tiles.escherization.carrying import Carrying
from voronoi_tiles.escherization.drawn_outline import DrawnOutline
from voronoi_tiles.escherization.fits import Fit
from voronoi_tiles.escherization.goal_outline import ring_corners
from voronoi_tiles.escherization.outline_distance import nearest_on
from voronoi_tiles.formats.reading import drawing_of
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.pictures.contact_sheet import (
    INK,
    SITE_INK,
    TILE_FILL,
    ContactSheet,
    DrawnPaths,
    SheetPicture,
    square_around,
)
from voronoi_tiles.pictures.rendering import render

TABLE: Final = "fits.csv"
INDEX: Final = "index.json"
"""The table for programs: a list, the best first."""

SHEETS: Final = ("sheet.html", "sheet.png")

_PICTURE: Final = 800
"""The longer side of a design's picture; pixels."""

_AROUND: Final = 3.5
"""The side of what it shows; relative to the larger side of the tile."""

_SAMPLES: Final = 0.02
"""The distance of the points of the outline whose displacement is carried; relative to its size."""

_GIVEN: Final = "#2060c0"
"""The colour of the given outline on the contact sheet."""


class FittedArt(NamedTuple):
    """What else is drawn, as it is carried to the tile of a fit, and where it lies in the design."""

    placed: Art
    carried: CarriedArt


def write_fits(
    folder: str,
    fits: Sequence[Fit],
    source: str,
    drawn: DrawnOutline,
    scale: float,
    progress: Callable[[float, float], None] | None = None,
) -> tuple[str, ...]:
    """Write fits of a drawing's outline, all or none, into a new or an empty folder; sentences on their art.

    `source` is the drawing's name, `scale` how many times as large as drawn the outline is. Raises OutputError for a
    folder that holds anything, and what cannot be written.
    """
    with filling(folder) as made:
        return _write_all(made, fits, source, drawn, scale, progress)


def _write_all(
    folder: Path,
    fits: Sequence[Fit],
    source: str,
    drawn: DrawnOutline,
    scale: float,
    progress: Callable[[float, float], None] | None,
) -> tuple[str, ...]:
    """Write all files into a folder of their own."""
    notes, pictures, rows = [], [], []
    for number, each in enumerate(fits, 1):
        stem = f"{number:0{len(str(len(fits)))}d}-{each.group}"
        art = fitted_art(each, f"{stem}-art.svg", source, drawn, scale)
        design = each.design
        if art is not None:
            write_whole(folder / art.placed.file, art.carried.svg)
            site = design.sites[0]
            design = design.replace(sites=Site(site.strokes, name=site.name, art=art.placed), folder=folder)
            notes += [note for note in art.carried.notes if note not in notes]
        design.save(folder / f"{stem}.toml")
        overlays = ("art",) if design.art[0] is not None else ()
        region = square_around(each.tiling[0].bounds, _AROUND)
        render(design, folder / f"{stem}.png", size=_PICTURE, region=region, overlay=overlays, renderer="cpu")
        caption = (
            f"{each.group}: overlap {each.overlap:.3f}{', symmetric' if each.symmetric else ''}",
            f"within {each.distance:.2g} mm, {each.corners} corners",
        )
        pictures.append(fit_picture(each, art, caption, f"{stem}.toml"))
        rows.append(_row(each, f"{stem}.toml"))
        if progress is not None:
            progress(number, len(fits))
    table = io.StringIO()
    writer = csv.DictWriter(table, [*rows[0]], lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    write_whole(folder / TABLE, table.getvalue().encode())
    write_whole(folder / INDEX, (json.dumps(rows, indent=2) + "\n").encode())
    sheet = ContactSheet(tuple(pictures), f"Tiles near to {os.path.basename(source)}")  # noqa: PTH119 - any name
    for name in SHEETS:
        sheet.save(folder / name)
    return tuple(notes)


def _row(fit: Fit, file: str) -> dict[str, str | float]:
    """A row of the table."""
    left, bottom, right, top = fit.tiling[0].bounds
    return {
        "design": file,
        "group": fit.group,
        "overlap": round(fit.overlap, 5),
        "bound": round(fit.bound, 5),
        "distance_mm": round(fit.distance, 4),
        "strokes": len(fit.design.sites[0].strokes),
        "corners": fit.corners,
        "neighbours": fit.neighbours,
        "symmetric": "yes" if fit.symmetric else "no",
        "width_mm": round(right - left, 3),
        "height_mm": round(top - bottom, 3),
    }


def fitted_art(fit: Fit, file: str, source: str, drawn: DrawnOutline, scale: float) -> FittedArt | None:
    """What else is drawn, carried to the tile of a fit, as the art of its site in a `file`; None where nothing is.

    `source` is the drawing's name, `scale` how many times as large as drawn the outline is.
    """
    if not drawn.rest.shapes:
        return None
    given, size = fit.silhouette, drawn.silhouette.size

    def as_drawn(points: Complexes) -> Complexes:
        return (fit.placement.taken_back(points, given.centroid) - given.centroid) / scale + drawn.silhouette.centroid

    ring = fit.tiling[0].to_shapely(accuracy=1e-3 * given.size).exterior
    outline = ring_corners(shapely.segmentize(fit.outline.exterior, _SAMPLES * given.size))
    moved = as_drawn(nearest_on(ring, outline)) - as_drawn(outline)
    reach = float(np.clip(4.0 * np.abs(moved).max(), 0.15 * size, 0.5 * size))
    guide = Paths.polylines([as_drawn(ring_corners(ring))], closed=True)
    art = carried_art(drawn.rest, source, None, Carrying.of(as_drawn(outline), moved, reach), guide=guide)
    shift = fit.placement.centre + scale * (art.corner - drawn.silhouette.centroid) * cmath.exp(1j * fit.placement.turn)
    return FittedArt(Art(file, scale=scale, rotate=math.degrees(fit.placement.turn), translate=shift), art)


def fit_picture(fit: Fit, art: FittedArt | None, caption: tuple[str, ...] = (), link: str = "") -> SheetPicture:
    """A tile with its stroke, its neighbours and its art, as upright as the outline is drawn, which lies over it."""
    back, centre = cmath.exp(-1j * fit.placement.turn), fit.placement.centre

    def upright(paths: Paths) -> Paths:
        return paths.moved(back, -centre * back)

    tile = fit.tiling[0]
    copies = fit.tiling.copies(square_around(tile.bounds, _AROUND))
    given = upright(Paths.polylines([ring_corners(fit.outline.exterior)], closed=True))
    drawn = [
        DrawnPaths(upright(Paths.concatenate([copy.outline.paths for copy in copies])), "", INK, 0.5),
        DrawnPaths(upright(tile.outline.paths), TILE_FILL, INK),
        DrawnPaths(upright(Paths.polylines(list(tile.site.ends))), "", SITE_INK, 1.0),
    ]
    if art is not None:
        shapes = [shape for shape in drawing_of(art.carried.svg, art.placed.file).shapes if GUIDE not in shape.layer]
        unit, shift, _ = art.placed.placement.similarity
        drawn += [DrawnPaths(upright(shape.paths.moved(unit, shift)), "", shape.stroke or INK) for shape in shapes]
    drawn.append(DrawnPaths(given, "", _GIVEN, 1.5))
    return SheetPicture(tuple(drawn), square_around(given.bounds, 1.2), caption, link)
