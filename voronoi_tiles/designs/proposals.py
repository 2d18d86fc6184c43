"""Designs that are proposed: a drawing, or the strokes of another design, in a cell where copies keep well apart."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np
import shapely
from shapely import affinity

from voronoi_tiles.base.arrays import plane
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Placement
from voronoi_tiles.base.tolerance import FLATTENING_MM
from voronoi_tiles.base.units import Units
from voronoi_tiles.designs.checking import read_group
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.drawn_files import DrawnFiles
from voronoi_tiles.designs.drawn_site import Site
from voronoi_tiles.designs.drawn_strokes import path
from voronoi_tiles.designs.enclosed import ENCLOSED, enclosed_note
from voronoi_tiles.designs.keys import keys_of_placement
from voronoi_tiles.designs.placing import CLEARANCE, find_place
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.designs.starters import Starter, StarterStroke, symmetry_of, written
from voronoi_tiles.designs.toml_text import toml_value
from voronoi_tiles.groups.wallpaper import WallpaperGroup

_FINE: Final = 2e3
_COARSE: Final = 1e5
"""A drawing is flattened to within 0.01 mm, but by no more than 1 / _FINE of its size, and no less than 1 / _COARSE."""

_ROOM: Final = (1e9, 1e9, 90.0)
"""A cell for drawings of any size."""


def drawing_text(
    group: str,
    file: str,
    output: str | None = None,
    *,
    layer: str | None = None,
    id: str | None = None,  # noqa: A002 - the word of SVG
) -> tuple[str, tuple[str, ...]]:
    """The commented design file of a drawing in a group, as it is to be written to `output`, None for nowhere.

    Its cell is made for it, and its tiles have been computed. Also gives the notes of the design, with its size. Raises
    DesignError where the drawing cannot be read.
    """
    kind = read_group(group)
    files = DrawnFiles("", 1.0)
    chosen = {key: value for key, value in (("layer", layer), ("id", id)) if value is not None}
    try:
        lines = path(files.path_data({"file": file, **chosen}))
    except DesignError as error:
        raise error.with_key(error.key if error.key in chosen else "") from None
    tolerance = min(max(FLATTENING_MM, _one_digit(files.size / _COARSE)), _one_digit(files.size / _FINE))
    try:
        noded = Design("p1", _ROOM, Site(lines, tolerance=tolerance)).noded
        place = find_place(noded, kind)
    except DesignError as error:
        raise DesignError(
            error.message, file=file, remedy="Draw less, or choose a part of it by layer or id."
        ) from None
    folder = os.path.realpath(os.path.dirname(output or ""))  # noqa: PTH120 - any name
    beside, base = os.path.split(file)
    stroke = {"file": os.path.relpath(os.path.join(os.path.realpath(beside), base), folder), **chosen}  # noqa: PTH118
    stem = os.path.splitext(base)[0].strip()  # noqa: PTH122 - same
    name = stem if stem.isprintable() and 0 < len(stem) <= 100 else "site1"
    comment = "the drawing in its real size, upside up, its lower left corner at the origin"
    text = written(
        group,
        Starter(
            symmetry_of(group),
            tuple(place.cell.values()),
            {name: (StarterStroke(toml_value(stroke), comment),)},
            tolerance,
            place.translate,
        ),
        output,
        result=f"{name}-tile.svg",
    )
    Design.loads(text, folder=folder).tessellate()
    # A unit that is a slip, or was guessed, is seen by the size.
    nodes = noded[0].nodes
    cell = ", ".join(f"{key} = {value:g}" for key, value in place.cell.items())
    notes = [*files.notes, f"{file} is {np.ptp(nodes.real):.4g} x {np.ptp(nodes.imag):.4g} mm, in a cell of {cell}"]
    return text, (*notes, enclosed_note(group)) if group in ENCLOSED else tuple(notes)


def _one_digit(value: float) -> float:
    """A number rounded to one digit."""
    return float(f"{value:.0e}")


def placed(
    drawn: Design | Site | Iterable[Site],
    group: str | WallpaperGroup,
    *,
    units: Units = "mm",
    folder: str | os.PathLike[str] = "",
) -> Design:
    """The sites of a design, or others, in a group, in a cell and at a place where their copies keep well apart.

    Sites stay as they lie to each other; those that are too near to others are laid beside them. `units` and `folder`
    are those of a design of the sites. Raises DesignError as Design does.

    >>> import voronoi_tiles as vt
    >>> vt.placed(vt.Site([vt.segment(-9 + 1j, 25 + 4j)]), "p4").cell
    {'a': 42.8}
    """
    kind = group if isinstance(group, WallpaperGroup) else read_group(group)
    design = drawn if isinstance(drawn, Design) else Design("p1", _ROOM, drawn, units=units, folder=folder)
    moves = _apart(design.noded)
    moved = [
        NodedSite(site.name, site.nodes + move, site.segments) for site, move in zip(design.noded, moves, strict=True)
    ]
    place = find_place(moved, kind)
    sites = []
    for site, move in zip(design.sites, moves, strict=True):
        by = Placement(translate=place.translate + move) @ Placement(design.scale) @ site.placement
        keys = keys_of_placement(by)
        keys["translate"] = tuple(float(f"{number:.12g}") for number in keys["translate"])
        sites.append(Site(site.strokes, name=site.name, tolerance=site.tolerance, art=site.art, **keys))
    return design.replace(group=kind, cell=place.cell, sites=sites, scale=1.0)


def placed_text(group: str, file: str, output: str | None = None) -> tuple[str, tuple[str, ...]]:
    """The design file of the strokes of a design in a group, as it is to be written to `output`, None for nowhere.

    Its tiles have been computed. Also gives the notes of the design. Raises DesignError where it cannot be read.
    """
    design = placed(Design.load(file), group)
    design.tessellate()
    return design.text_for(output or "design.toml"), design.notes


def _apart(sites: Sequence[NodedSite]) -> list[complex]:
    """By what each site is moved to keep from those before it: not at all, or to the right of them."""
    shapes = [shapely.union_all(_shape(site)) for site in sites]
    gap = CLEARANCE * max(site.extent for site in sites)
    moves, before = [0j], shapes[0]
    for shape in shapes[1:]:
        move = 0.0
        if shapely.distance(shape, before) < gap:
            move = before.bounds[2] + 2.0 * gap - shape.bounds[0]
        moves.append(complex(move))
        before = shapely.union(before, affinity.translate(shape, move))
    return moves


def _shape(site: NodedSite) -> list[shapely.Geometry]:
    """The lines and points of a site."""
    lines = shapely.linestrings(plane(site.nodes[site.segments]))
    return [*lines, *shapely.points(plane(site.nodes[site.isolated]))]
