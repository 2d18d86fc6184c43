"""The check of a design: the one place that designs from files and from Python come to.

Checked by hand because the import of a validation library costs more than most commands; every message names the path
of the key and the remedy, and whatever the input is, only DesignError comes out.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from voronoi_tiles.base import values
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Placement
from voronoi_tiles.base.tolerance import ANGLE_MIN, CELL_ASPECT_MAX, CELL_MIN, FLATTENING_MM, SITE_EXTENT_MAX
from voronoi_tiles.base.units import UNIT_MM, Units
from voronoi_tiles.designs import schema
from voronoi_tiles.designs.art import Art
from voronoi_tiles.designs.drawn_files import DrawnFiles
from voronoi_tiles.designs.keys import PLACEMENT
from voronoi_tiles.designs.load import STARTER
from voronoi_tiles.designs.site import NodedSite, build_site
from voronoi_tiles.designs.solid_checking import CheckedSolid, DrawnStroke, SiteDrawing, read_solid, refuse_far
from voronoi_tiles.designs.strokes import ARC_SHARE, polylines
from voronoi_tiles.groups.wallpaper import GROUPS, Lattice, WallpaperGroup

# The full symbols of the International Tables, for those who write them.
_FULL_SYMBOLS = {"p1m1": "pm", "p11m": "pm", "p1g1": "pg", "p11g": "pg", "c1m1": "cm", "p2mm": "pmm", "p2mg": "pmg"}
_FULL_SYMBOLS |= {"p2gg": "pgg", "c2mm": "cmm", "p4mm": "p4m", "p4gm": "p4g", "p6mm": "p6m", "p211": "p2", "p111": "p1"}


_KEYS = ("schema", "group", "units", "scale", "cell", "site", "solid", "key")


class CheckedDesign(NamedTuple):
    """What a checked design is.

    `noded` and `art`, placed as its site is, have an entry for each site. `drawn` is the design as it is written, as
    canonical JSON, and `source` the same with the paths of drawings in the place of their names, which are `drawings`.
    `notes` are sentences on what of these is left out or guessed. `standing` is the solid, None where there is none.
    """

    group: WallpaperGroup
    lattice: Lattice
    units: Units
    noded: tuple[NodedSite, ...]
    art: tuple[Art | None, ...]
    source: str
    drawn: str
    drawings: tuple[str, ...]
    notes: tuple[str, ...]
    standing: CheckedSolid | None


def checked(value: object, folder: str) -> CheckedDesign:
    """Check the table of a design, as TOML and JSON give it; its drawings are in `folder`. Raises DesignError."""
    table = values.table(value, _KEYS, STARTER)
    version = values.required(table, "schema", "Write schema = 1.")
    if isinstance(version, bool) or not isinstance(version, int) or version != 1:
        raise DesignError(f"schema {values.shown(version)} is not supported", key="schema", remedy="Write schema = 1.")
    group = read_group(values.required(table, "group", f"Write one of {', '.join(GROUPS)}."))
    units = _read_units(table.get("units", "mm"))
    cell = values.required(table, "cell", "Write [cell] and, below it, a = 60.0 and what else the group leaves free.")
    with values.within("scale"):
        scale = values.positive(table.get("scale", 1.0))
    with values.within("cell"):
        lattice = _read_cell(cell, group, scale)
    listed = values.required(table, "site", "Write [[site]] and, below it, its strokes.")
    reading = _Reading(FLATTENING_MM / UNIT_MM[units], lattice, Placement(scale), DrawnFiles(folder, UNIT_MM[units]))
    sites = reading.sites(listed)
    standing, keys = read_solid(table, scale, [site.drawing for site in sites])
    if standing is not None:
        refuse_far(standing, math.sqrt(lattice.det), UNIT_MM[units])
    drawn = _text(table)
    source = _text({**table, "site": [site.table for site in sites], **keys}) if reading.files.names else drawn
    return CheckedDesign(
        group,
        lattice,
        units,
        tuple(site.noded for site in sites),
        tuple(site.art for site in sites),
        source,
        drawn,
        tuple(dict.fromkeys(reading.files.names)),
        tuple(reading.files.notes),
        standing,
    )


def _text(table: Mapping[str, Any]) -> str:
    """A checked table as canonical JSON."""
    return json.dumps(_canonical(table), sort_keys=True, separators=(",", ":"), allow_nan=False)


def _read_units(value: object) -> Units:
    for units in UNIT_MM:
        if isinstance(value, str) and value == units:
            return units
    raise DesignError(f"unknown units {values.shown(value)}", key="units", remedy='Write "mm", "cm" or "in".')


def read_group(value: object) -> WallpaperGroup:
    """Read the name of a wallpaper group. Raises DesignError."""
    word = value
    if isinstance(value, str):
        if value in GROUPS:
            return GROUPS[value]
        word = _FULL_SYMBOLS.get(value.lower(), value)
    remedy = f"{values.suggestion(word, GROUPS)}Write one of {', '.join(GROUPS)}."
    raise DesignError(f"unknown wallpaper group {values.shown(value)}", key="group", remedy=remedy)


def _read_cell(value: object, group: WallpaperGroup, scale: float) -> Lattice:
    """The lattice of a cell whose sides are times `scale`."""
    table = values.table(value, ("a", "b", "angle"), "Write [cell] and, below it, a = 60.0.")
    needs = f"{group.name} needs the cell's"
    a = _read_side(table, "a", f"{needs} side along x: write a = 60.0.")
    b = None
    angle = None
    if group.fixes_b:
        _refuse_other(table, "b", a, f"{group.name} has a {group.system} cell: b is as long as a")
    else:
        b = _read_side(table, "b", f"{needs} second side: write b = 50.0.")
    fixed = group.fixed_angle
    if fixed is not None:
        what = f"{group.name} has a {group.system} cell: its angle is {fixed:g} degrees"
        _refuse_other(table, "angle", fixed, what)
    else:
        given = values.required(table, "angle", f"{needs} angle from a to b: write angle = 75.0.")
        with values.within("angle"):
            angle = values.number(given)
            if not ANGLE_MIN <= angle <= 180.0 - ANGLE_MIN:
                raise DesignError(
                    f"must be between 0 and 180 degrees, not {angle:g}",
                    remedy="Write the angle from a to b, such as 75.0.",
                )
    lattice = group.lattice(a * scale, None if b is None else b * scale, angle)
    short, long = lattice.reduced_basis
    if not abs(long) <= CELL_ASPECT_MAX * abs(short):
        raise DesignError(
            f"the cell is more than {CELL_ASPECT_MAX:,.0f} times longer than wide",
            remedy="Choose sides, and an angle, that are nearer to a square.",
        )
    return lattice


def _read_side(table: values.Table, name: str, remedy: str) -> float:
    value = values.required(table, name, remedy)
    with values.within(name):
        side = values.positive(value)
        if side < CELL_MIN:
            raise DesignError(f"the cell is smaller than {CELL_MIN:g}", remedy="Use smaller units.")
        return side


def _refuse_other(table: values.Table, name: str, fixed: float, what: str) -> None:
    """Refuse a value other than the one that the group fixes."""
    with values.within(name):
        if name in table and values.number(table[name]) != fixed:
            raise DesignError(what, remedy=f"Leave {name} out.")


class _ReadSite(NamedTuple):
    """A site that has been checked: its table, with paths in the place of drawings, its geometry and its art.

    `drawing` is what keys of a solid need of it.
    """

    table: Mapping[str, Any]
    noded: NodedSite
    art: Art | None
    drawing: SiteDrawing


class _Reading(NamedTuple):
    """How sites are read: flattened within `accuracy` where they do not say, and placed by the whole design's scale."""

    accuracy: float
    lattice: Lattice
    scale: Placement
    files: DrawnFiles

    def sites(self, value: object) -> list[_ReadSite]:
        """Read the sites of a design."""
        remedy = "Write [[site]], in double brackets, above the keys of each site."
        with values.within("site"):
            listed = values.sequence(value, remedy)
            if not listed:
                raise DesignError("there is no site", remedy=remedy)
        taken: dict[str, int] = {}
        sites = []
        for k, item in enumerate(listed):
            with values.within(f"site[{k}]"):
                table = values.table(item, ("name", "tolerance", "strokes", "art", *PLACEMENT), remedy)
                with values.within("name"):
                    name = _read_name(table.get("name", f"site{k + 1}"), taken)
                taken[name] = k
                sites.append(self._site(table, name))
        return sites

    def _site(self, table: values.Table, name: str) -> _ReadSite:
        """Read one site."""
        accuracy = self.accuracy
        if "tolerance" in table:
            with values.within("tolerance"):
                accuracy = values.positive(table["tolerance"])
        by = self.scale @ schema.placement(table)
        remedy = "Write strokes = [{ segment = [[5, 3], [25, 11]] }]."
        listed = values.required(table, "strokes", remedy)

        def read(listed: object) -> tuple[list[values.Table], tuple[DrawnStroke, ...]]:
            return self._strokes(values.sequence(listed, remedy), accuracy, by)

        with values.within("strokes"):
            strokes, drawn = read(listed)
        lines, pieces = ([points for points, curved in drawn if curved is bent] for bent in (False, True))
        if pieces:
            # What the step from arcs to cubics may have used is taken off.
            lines += polylines(np.concatenate(pieces), accuracy * (1.0 - ARC_SHARE))
        site = build_site(name, lines)
        if not site.extent <= SITE_EXTENT_MAX * math.sqrt(self.lattice.det):
            raise DesignError(
                f"the site is more than {SITE_EXTENT_MAX:,.0f} times larger than the cell",
                remedy="Make the cell larger, or the strokes smaller.",
            )
        with values.within("art"):
            art = _read_art(table["art"]) if "art" in table else None
        drawing = SiteDrawing(name, strokes, drawn, accuracy, read)
        return _ReadSite({**table, "strokes": strokes}, site, None if art is None else art.placed(by), drawing)

    def _strokes(
        self, listed: Sequence[Any], accuracy: float, by: Placement
    ) -> tuple[list[values.Table], tuple[DrawnStroke, ...]]:
        """Read strokes and place them: their tables, with paths in the place of drawings, and what they draw."""
        if not listed:
            raise DesignError("there is no stroke", remedy="Write strokes = [{ segment = [[5, 3], [25, 11]] }].")
        strokes: list[values.Table] = []
        drawn = []
        for k, item in enumerate(listed):
            with values.within(f"[{k}]"):
                drawn.append(schema.stroke(item, accuracy, by, self.files.path_data))
            if "file" in item:
                item = {"path": self.files.texts[-1], **_but(item, "file", "layer", "id")}  # noqa: PLW2901 - the same
            strokes.append(item)
        return strokes, tuple(drawn)


def _but(table: values.Table, *keys: str) -> dict[str, Any]:
    """A table without some of its keys."""
    return {key: value for key, value in table.items() if key not in keys}


def _read_art(value: object) -> Art:
    remedy = 'Write art = "face.svg", or art = { file = "face.svg", translate = [5, 3] }.'
    if isinstance(value, str):
        value = {"file": value}
    if not isinstance(value, Mapping):
        raise DesignError(f"must be a file's name or a table, not {values.shown(value)}", remedy=remedy)
    table = values.table(value, ("file", *PLACEMENT), remedy)
    file = values.required(table, "file", remedy)
    with values.within("file"):
        values.file_name(file, remedy)
    schema.placement(table)
    return Art(**table)


def _read_name(value: object, taken: Mapping[str, int]) -> str:
    name = values.text(value, 'Write name = "bird".')
    if not 0 < len(name) <= 100 or not name.isprintable() or name != name.strip():
        raise DesignError(
            f"{values.shown(name)} is no name",
            remedy="Use 1 to 100 printable characters, without spaces at the ends.",
        )
    if name in taken:
        raise DesignError(
            f'"{name}" is already the name of site[{taken[name]}]', remedy="Give each site a name of its own."
        )
    return name


def _canonical(value: Any) -> Any:
    """A checked value in the types of JSON; whole numbers without a fraction, so that 60 and 60.0 are one design."""
    if type(value) is float:  # most are
        return int(value) if value.is_integer() else value
    if isinstance(value, Mapping):
        return {name: _canonical(item) for name, item in value.items()}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [_canonical(item) for item in value]
    if isinstance(value, str | bool):
        return value
    number = float(value)
    return int(number) if number.is_integer() else number
