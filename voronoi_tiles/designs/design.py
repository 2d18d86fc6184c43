"""A design: the wallpaper group, the cell and the sites, read from a TOML or JSON file and checked by hand.

Checked by hand because the import of a validation library costs more than most commands; every message
names the file, the path of the key and the remedy, and whatever the input is, only DesignError comes out.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from voronoi_tiles.base import values
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Placement
from voronoi_tiles.base.tolerance import ANGLE_MIN, CELL_ASPECT_MAX, CELL_MIN, FLATTENING_MM, SITE_EXTENT_MAX
from voronoi_tiles.base.units import UNIT_MM, Units
from voronoi_tiles.designs import schema
from voronoi_tiles.designs.load import STARTER, parse, read_text
from voronoi_tiles.designs.site import Site, build_site
from voronoi_tiles.designs.strokes import ARC_SHARE, polylines
from voronoi_tiles.groups.wallpaper import GROUPS, Lattice, WallpaperGroup

if TYPE_CHECKING:
    from voronoi_tiles.tiling import Tiling


# The full symbols of the International Tables, for those who write them.
_FULL_SYMBOLS = {"p1m1": "pm", "p11m": "pm", "p1g1": "pg", "p11g": "pg", "c1m1": "cm", "p2mm": "pmm", "p2mg": "pmg"}
_FULL_SYMBOLS |= {"p2gg": "pgg", "c2mm": "cmm", "p4mm": "p4m", "p4gm": "p4g", "p6mm": "p6m", "p211": "p2", "p111": "p1"}


@dataclass(frozen=True)
class Art:
    """A drawing that belongs to a site: its strokes are engraved or scored on every copy of the tile.

    `file` is its path as written in the design; `placement` moves it, after its lower left corner has been laid
    on the design's origin and its millimetres have become the design's units.
    """

    file: str
    placement: Placement


@dataclass(frozen=True, eq=False)
class Design:
    """A design that has been read and checked.

    Lengths are in `units`; `source` is the design as canonical JSON (ASCII, sorted keys), which `loads` reads
    again; `name` is the stem of the file it came from, or "design". `art` has an entry for each site, None where it has
    none; files are looked for in `folder`, that of the design.
    """

    group: WallpaperGroup
    lattice: Lattice
    units: Units
    sites: tuple[Site, ...]
    source: str
    art: tuple[Art | None, ...] = ()
    name: str = "design"
    folder: str = ""

    def __repr__(self) -> str:
        sites = ", ".join(site.name for site in self.sites[:3]) + (", ..." if len(self.sites) > 3 else "")
        many = "site" if len(self.sites) == 1 else "sites"
        return f"<Design {self.name!r}: {self.group.name}, {len(self.sites)} {many} ({sites})>"

    @property
    def unit_mm(self) -> float:
        """One unit of the design in millimetres."""
        return UNIT_MM[self.units]

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Design:
        """Read a design file, TOML or JSON by its suffix (else by its content); "-" is standard input.

        Raises DesignError where the file cannot be read or used.
        """
        file = os.fspath(path)
        shown = "standard input" if file == "-" else file or repr(file)
        text = read_text(file, shown)
        suffix = Path(file).suffix.lower()
        if suffix not in (".toml", ".json"):
            suffix = ".json" if text.lstrip()[:1] == "{" else ".toml"
        if file == "-":
            return cls.loads(text, format=suffix[1:], file=shown)
        design = cls.loads(text, format=suffix[1:], file=shown, name=Path(file).stem)
        return replace(design, folder=str(Path(file).parent))

    @classmethod
    def loads(
        cls,
        text: str,
        *,
        format: str = "toml",  # noqa: A002 - the word that scripts expect
        file: str | None = None,
        name: str = "design",
    ) -> Design:
        """Read a design from text in "toml" or "json"; `file` is what messages call it. Raises DesignError."""
        return cls.from_dict(parse(text, format, file), file=file, name=name)

    @classmethod
    def from_dict(cls, mapping: Mapping[str, Any], *, file: str | None = None, name: str = "design") -> Design:
        """Read a design from nested mappings and sequences, as TOML and JSON give them. Raises DesignError."""
        try:
            return cls(*_read_design(mapping), name=name or "design")
        except DesignError as error:
            raise error.with_file(file) from None

    def tessellate(self) -> Tiling:
        """Compute the tiles, proved.

        Raises TouchingCopiesError where copies of sites touch, ProofError where the result fails its proof.
        """
        from voronoi_tiles.tiling import tessellate

        return tessellate(self)


# --- the design ---------------------------------------------------------------------------------------------

_Parts = tuple[WallpaperGroup, Lattice, Units, tuple[Site, ...], str, tuple[Art | None, ...]]


def _read_design(value: object) -> _Parts:
    table = values.table(value, ("schema", "group", "units", "cell", "site"), STARTER)
    version = values.required(table, "schema", "Write schema = 1.")
    if isinstance(version, bool) or not isinstance(version, int) or version != 1:
        raise DesignError(f"schema {values.shown(version)} is not supported", key="schema", remedy="Write schema = 1.")
    group = _read_group(values.required(table, "group", f"Write one of {', '.join(GROUPS)}."))
    units = _read_units(table.get("units", "mm"))
    cell = values.required(table, "cell", "Write [cell] and, below it, a = 60.0 and what else the group leaves free.")
    with values.within("cell"):
        lattice = _read_cell(cell, group)
    listed = values.required(table, "site", "Write [[site]] and, below it, its strokes.")
    sites = _read_sites(listed, FLATTENING_MM / UNIT_MM[units], lattice)
    art = _read_art(listed)
    source = json.dumps(_canonical(table), sort_keys=True, separators=(",", ":"), allow_nan=False)
    return group, lattice, units, sites, source, art


def _read_units(value: object) -> Units:
    for units in UNIT_MM:
        if isinstance(value, str) and value == units:
            return units
    raise DesignError(f"unknown units {values.shown(value)}", key="units", remedy='Write "mm", "cm" or "in".')


def _read_group(value: object) -> WallpaperGroup:
    close = None
    if isinstance(value, str):
        if value in GROUPS:
            return GROUPS[value]
        close = _FULL_SYMBOLS.get(value.lower()) or values.closest(value, GROUPS)
    remedy = f"Write one of {', '.join(GROUPS)}."
    raise DesignError(
        f"unknown wallpaper group {values.shown(value)}",
        key="group",
        remedy=f'Did you mean "{close}"? {remedy}' if close else remedy,
    )


def _read_cell(value: object, group: WallpaperGroup) -> Lattice:
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
    lattice = group.lattice(a, b, angle)
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


def _read_sites(value: object, accuracy: float, lattice: Lattice) -> tuple[Site, ...]:
    remedy = "Write [[site]], in double brackets, above the keys of each site."
    with values.within("site"):
        listed = values.sequence(value, remedy)
        if not listed:
            raise DesignError("there is no site", remedy=remedy)
    taken: dict[str, int] = {}
    sites = []
    for k, item in enumerate(listed):
        with values.within(f"site[{k}]"):
            table = values.table(item, ("name", "tolerance", "strokes", "art"), remedy)
            name = table.get("name", f"site{k + 1}")
            with values.within("name"):
                _check_name(name, taken)
            taken[name] = k
            sites.append(_read_site(table, name, accuracy, lattice))
    return tuple(sites)


def _read_art(listed: Sequence[Any]) -> tuple[Art | None, ...]:
    """The art of sites that have been read."""
    result: list[Art | None] = []
    for k, item in enumerate(listed):
        if "art" not in item:
            result.append(None)
            continue
        with values.within(f"site[{k}]"), values.within("art"):
            result.append(_one_art(item["art"]))
    return tuple(result)


def _one_art(value: object) -> Art:
    remedy = 'Write art = "face.svg", or art = { file = "face.svg", translate = [5, 3] }.'
    if isinstance(value, str):
        value = {"file": value}
    if not isinstance(value, Mapping):
        raise DesignError(f"must be a file's name or a table, not {values.shown(value)}", remedy=remedy)
    table = values.table(value, ("file", *schema.PLACEMENT), remedy)
    file = values.required(table, "file", remedy)
    with values.within("file"):
        if not isinstance(file, str) or not file or "\0" in file:
            raise DesignError(f"must be a file's name, not {values.shown(file)}", remedy=remedy)
    return Art(file, schema.placement(table))


def _check_name(name: object, taken: Mapping[str, int]) -> None:
    if not isinstance(name, str):
        raise DesignError(f"must be a text, not {values.shown(name)}", remedy='Write name = "bird".')
    if not 0 < len(name) <= 100 or not name.isprintable() or name != name.strip():
        raise DesignError(
            f"{values.shown(name)} is no name",
            remedy="Use 1 to 100 printable characters, without spaces at the ends.",
        )
    if name in taken:
        raise DesignError(
            f'"{name}" is already the name of site[{taken[name]}]', remedy="Give each site a name of its own."
        )


def _read_site(table: values.Table, name: str, accuracy: float, lattice: Lattice) -> Site:
    if "tolerance" in table:
        with values.within("tolerance"):
            accuracy = values.positive(table["tolerance"])
    remedy = "Write strokes = [{ segment = [[5, 3], [25, 11]] }]."
    listed = values.required(table, "strokes", remedy)
    with values.within("strokes"):
        listed = values.sequence(listed, remedy)
        if not listed:
            raise DesignError("there is no stroke", remedy=remedy)
    lines: list[Complexes] = []
    pieces: list[Complexes] = []
    for k, item in enumerate(listed):
        with values.within(f"strokes[{k}]"):
            drawn, curved = schema.stroke(item, accuracy)
        (pieces if curved else lines).append(drawn)
    if pieces:
        # What the step from arcs to cubics may have used is taken off.
        lines += polylines(np.concatenate(pieces), accuracy * (1.0 - ARC_SHARE))
    site = build_site(name, lines)
    if not site.extent <= SITE_EXTENT_MAX * math.sqrt(lattice.det):
        raise DesignError(
            f"the site is more than {SITE_EXTENT_MAX:,.0f} times larger than the cell",
            remedy="Make the cell larger, or the strokes smaller.",
        )
    return site


def _canonical(value: Any) -> Any:
    """A checked value in the types of JSON; whole numbers without a fraction, so that 60 and 60.0 are one design."""
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
