"""A design: the wallpaper group, the cell and the sites, from a TOML or JSON file or from Python."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, get_args

from voronoi_tiles.base import values
from voronoi_tiles.base.arguments import path_name
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.files import refuse_overwriting, write_whole
from voronoi_tiles.base.units import UNIT_MM, Units
from voronoi_tiles.designs.art import Art
from voronoi_tiles.designs.checking import CheckedDesign, checked
from voronoi_tiles.designs.coordinates import PointLike
from voronoi_tiles.designs.drawn_site import Site, site_of
from voronoi_tiles.designs.drawn_strokes import ARGUMENTS, StrokeKind
from voronoi_tiles.designs.load import parse, read_text
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.designs.toml_text import toml_text
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup

if TYPE_CHECKING:
    from voronoi_tiles.tiling import Tiling

Cell: TypeAlias = float | Sequence[float] | Mapping[str, float]
"""The conventional cell: the side a, (a, b), (a, b, angle), or a mapping of those that the group leaves free."""


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Design:
    """A wallpaper group, its cell and its sites, checked: what is refused in a file is refused here.

    `cell` is the side along x; or (a, b) or (a, b, angle) where the group leaves them free, the angle from a to b in
    degrees; or a mapping {"a": 60, "b": 50, "angle": 75}. `sites` are Site objects, or one. Lengths are in `units`,
    "mm", "cm" or "in"; the origin is the group's, x runs along a, y up. `name` is what files say of the design, and
    `folder` is where the drawings of art are looked for.

    Derived are the `lattice`; `noded`, the geometry of each site that tiles are computed from; `art`, the drawing of
    each site or None; and `source`, the design as JSON (ASCII, sorted keys), which files hold as their recipe
    and `loads` reads again.

    Designs are equal, and hash alike, where the group, the cell, the units and the sites are equal, whatever their
    names and folders. Raises DesignError, which names the argument: "sites[0].strokes[1].points[2]".

    >>> import voronoi_tiles as vt
    >>> bird = vt.Site([vt.segment(5 + 3j, 25 + 11j), vt.catmull_rom([6 + 9j, 22 + 5j, 27 + 17j])], name="bird")
    >>> design = vt.Design("p4", cell=60, sites=[bird])
    >>> design
    <Design 'design': p4, 1 site (bird)>
    >>> design == vt.Design.loads(design.to_toml())
    True
    >>> vt.Design("p4", 60, [vt.Site([vt.polyline([1j, 1j])])])
    Traceback (most recent call last):
    voronoi_tiles.base.errors.DesignError: sites[0].strokes[0].points[1]: zero length: the point is the same as the one
    before. Take it out, or draw an isolated point, a stroke of the kind "point".
    """

    group: WallpaperGroup
    lattice: Lattice
    units: Units
    noded: tuple[NodedSite, ...]
    art: tuple[Art | None, ...]
    source: str
    name: str
    folder: str
    file: str

    def __init__(
        self,
        group: str | WallpaperGroup,
        cell: Cell,
        sites: Site | Iterable[Site],
        *,
        units: Units = "mm",
        name: str = "design",
        folder: str | os.PathLike[str] = "",
    ) -> None:
        table = {
            "schema": 1,
            "group": group.name if isinstance(group, WallpaperGroup) else group,
            "units": units,
            "cell": _cell_table(cell),
            "site": [site.table for site in _listed(sites)],
        }
        try:
            parts = checked(table)
        except DesignError as error:
            raise error.with_key(_argument(error.key or "")) from None
        _fill(self, parts, name, path_name("folder", folder))

    def __repr__(self) -> str:
        sites = ", ".join(site.name for site in self.noded[:3]) + (", ..." if len(self.noded) > 3 else "")
        many = "site" if len(self.noded) == 1 else "sites"
        return f"<Design {self.name!r}: {self.group.name}, {len(self.noded)} {many} ({sites})>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Design) and self._content == other._content

    def __hash__(self) -> int:
        return hash(self._content)

    @property
    def _parts(self) -> CheckedDesign:
        """What was checked."""
        return CheckedDesign(*(getattr(self, field) for field in CheckedDesign._fields))

    @property
    def _content(self) -> tuple[object, ...]:
        return self.group.name, self.lattice, self.units, self.sites

    def _repr_svg_(self) -> str:
        """Draw the cell and the sites with their copies: notebooks show this."""
        from voronoi_tiles.pictures.notebook import design_picture

        return design_picture(self)

    @property
    def unit_mm(self) -> float:
        """One unit of the design in millimetres."""
        return UNIT_MM[self.units]

    @cached_property
    def sites(self) -> tuple[Site, ...]:
        """The sites as they are drawn, each with its name; `noded` has their geometry."""
        listed = json.loads(self.source)["site"]
        return tuple(site_of(table, noded.name) for table, noded in zip(listed, self.noded, strict=True))

    @property
    def files(self) -> tuple[str, ...]:
        """The files that it was made from, which nothing overwrites: its own, and the drawings of its art."""
        return (self.file, *self._drawings) if self.file else self._drawings

    @property
    def _drawings(self) -> tuple[str, ...]:
        """The drawings of its art."""
        return tuple(os.path.join(self.folder, art.file) for art in self.art if art is not None)  # noqa: PTH118 - any name

    @property
    def cell(self) -> dict[str, float]:
        """The cell as it was given: the side a, and b and the angle where the group leaves them free."""
        cell: dict[str, float] = json.loads(self.source)["cell"]
        return cell

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Design:
        """Read a design file, TOML or JSON by its suffix (else by its content); "-" is standard input.

        Raises DesignError where the file cannot be read or used.
        """
        file = path_name("path", path)
        shown = "standard input" if file == "-" else file or repr(file)
        text = read_text(file, shown)
        suffix = Path(file).suffix.lower()
        read = cls.loads(text, format=suffix[1:] if suffix in (".toml", ".json") else None, file=shown)
        if file == "-":
            return read
        return _fill(read, read._parts, Path(file).stem, str(Path(file).parent), file)  # noqa: SLF001 - it is one of us

    @classmethod
    def loads(
        cls,
        text: str,
        *,
        format: str | None = None,  # noqa: A002 - the word that scripts expect
        file: str | None = None,
        name: str = "design",
    ) -> Design:
        """Read a design from text in "toml" or "json", None to see which; `file` is what messages call it.

        Raises DesignError.
        """
        return cls.from_dict(parse(text, format, file), file=file, name=name)

    @classmethod
    def from_dict(cls, mapping: Mapping[str, Any], *, file: str | None = None, name: str = "design") -> Design:
        """Read a design from nested mappings and sequences, as TOML and JSON give them. Raises DesignError."""
        try:
            return _fill(cls.__new__(cls), checked(mapping), name)
        except DesignError as error:
            raise error.with_file(file) from None

    def to_dict(self) -> dict[str, Any]:
        """The design as nested dictionaries, in the keys of a design file: what `from_dict` reads as an equal one."""
        return {
            "schema": 1,
            "group": self.group.name,
            "units": self.units,
            "cell": self.cell,
            "site": [site.table for site in self.sites],
        }

    def to_toml(self) -> str:
        """The design as a design file, which is read as an equal one.

        Raises DesignError where the name of a drawing is no text that can be written.
        """
        return toml_text(self.to_dict())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the design file whole or not at all; the drawings of art are named as seen from its folder.

        It is JSON where the name ends in .json, else TOML. Raises OutputError where the file cannot be written.
        """
        table = self.to_dict()
        name = path_name("path", path)
        refuse_overwriting([name], self._drawings)
        folder = os.path.realpath(os.path.dirname(name))  # noqa: PTH120 - the name may be any
        for site in table["site"]:
            if "art" in site:
                file = site["art"]["file"]
                if not os.path.isabs(file):  # noqa: PTH117 - same
                    site["art"]["file"] = os.path.relpath(os.path.realpath(os.path.join(self.folder, file)), folder)  # noqa: PTH118
        as_json = Path(name).suffix.lower() == ".json"
        write_whole(name, (json.dumps(table, indent=1) + "\n" if as_json else toml_text(table)).encode())

    def replace(
        self,
        *,
        group: str | WallpaperGroup | None = None,
        cell: Cell | None = None,
        sites: Site | Iterable[Site] | None = None,
        units: Units | None = None,
        name: str | None = None,
        folder: str | os.PathLike[str] | None = None,
    ) -> Design:
        """The design with some of its parts changed, checked again; None leaves a part as it is. Raises DesignError."""
        name = self.name if name is None else name
        folder = self.folder if folder is None else folder
        if group is None and cell is None and sites is None and units is None:
            return _fill(Design.__new__(Design), self._parts, name, path_name("folder", folder), self.file)
        made = Design(
            self.group if group is None else group,
            self.cell if cell is None else cell,
            self.sites if sites is None else sites,
            units=self.units if units is None else units,
        )
        return _fill(made, made._parts, name, path_name("folder", folder), self.file)

    __replace__ = replace

    def scaled(self, factor: float) -> Design:
        """The design with its cell and strokes times a factor above 0; tolerances stay as they are.

        Raises DesignError for another factor.
        """
        with values.within("factor"):
            factor = values.positive(factor)
        cell = {name: value if name == "angle" else value * factor for name, value in self.cell.items()}
        return self.replace(cell=cell, sites=self._moved(lambda site: site.moved(scale=factor)))

    def moved(
        self, *, mirror: bool = False, scale: float = 1.0, rotate: float = 0.0, translate: PointLike = 0j
    ) -> Design:
        """The design with all strokes and art moved in its cell, in the order of the arguments, about the origin.

        `mirror` is x -> -x, `rotate` in degrees counter-clockwise. The group and its origin stay, so that the tiles
        are others, but for the motions that map the group onto itself. Raises DesignError, also where a path or art is
        to be mirrored.
        """
        return self.replace(
            sites=self._moved(lambda site: site.moved(mirror=mirror, scale=scale, rotate=rotate, translate=translate))
        )

    def _moved(self, move: Callable[[Site], Site]) -> list[Site]:
        """All sites moved; errors name the argument that a stroke was made of."""
        try:
            with values.within("site"):
                return values.each(self.sites, move)
        except DesignError as error:
            raise error.with_key(_argument(error.key or "")) from None

    def tessellate(self) -> Tiling:
        """Compute the tiles, proved.

        Raises TouchingCopiesError where copies of sites touch, ProofError where the result fails its proof.
        """
        from voronoi_tiles.tiling import tessellate

        return tessellate(self)


def _fill(design: Design, parts: CheckedDesign, name: str, folder: str = "", file: str = "") -> Design:
    """Fill an empty design with what was checked; the same design."""
    _check_name(name)
    for field, value in {**parts._asdict(), "name": name or "design", "folder": folder, "file": file}.items():
        object.__setattr__(design, field, value)
    return design


def _check_name(name: object) -> None:
    if not isinstance(name, str) or "\0" in name:
        raise DesignError(f"{values.shown(name)} is no name", key="name", remedy="Write a text.")


def _cell_table(cell: object) -> object:
    """A cell as a design file has it."""
    if isinstance(cell, Mapping):
        return cell
    sides = getattr(cell, "tolist", lambda: cell)()
    if isinstance(sides, int | float):
        sides = [sides]
    if isinstance(sides, list | tuple) and 1 <= len(sides) <= 3:
        return dict(zip(("a", "b", "angle"), sides, strict=False))
    raise DesignError(
        f"must be a side, (a, b), (a, b, angle) or a mapping, not {values.shown(cell)}",
        key="cell",
        remedy="Write cell=60, or what else the group leaves free.",
    )


def _listed(sites: object) -> list[Site]:
    """The sites that a design is given."""
    remedy = "Write sites=[Site([segment(5+3j, 25+11j)])]."
    if isinstance(sites, Site):
        sites = [sites]
    if isinstance(sites, str | Mapping) or not isinstance(sites, Iterable):
        raise DesignError(f"must be Site objects, not {values.shown(sites)}", key="sites", remedy=remedy)
    listed = list(sites)
    if not listed:
        raise DesignError("there is no site", key="sites", remedy=remedy)
    for k, site in enumerate(listed):
        if not isinstance(site, Site):
            raise DesignError(f"must be a Site, not {values.shown(site)}", key=f"sites[{k}]", remedy=remedy)
        if not site.strokes:
            raise DesignError("there is no stroke", key=f"sites[{k}].strokes", remedy=remedy)
    return listed


_OWN = re.compile(rf"(site\[\d+\]\.strokes\[\d+\])\.({'|'.join(get_args(StrokeKind))})\b(?:\[([01])\])?")


def _argument(key: str) -> str:
    """The argument of Design that a key of the table came from: "sites[0].strokes[1].points[2]"."""

    def own(found: re.Match[str]) -> str:
        stroke, kind, index = found.groups()
        names = ARGUMENTS.get(kind, ("points",))
        if len(names) == 2 and index is not None:
            return f"{stroke}.{names[int(index)]}"
        return f"{stroke}.{names[0]}{'' if index is None else f'[{index}]'}"

    return re.sub(r"^site\b", "sites", _OWN.sub(own, key))
