"""A design: the wallpaper group, the cell and the sites, from a TOML or JSON file or from Python."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

from voronoi_tiles.base import values
from voronoi_tiles.base.arguments import path_name
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.files import refuse_overwriting, write_whole
from voronoi_tiles.base.maps import Placement
from voronoi_tiles.base.text import counted
from voronoi_tiles.base.units import UNIT_MM, Units
from voronoi_tiles.designs.art import Art
from voronoi_tiles.designs.checking import CheckedDesign, checked
from voronoi_tiles.designs.coordinates import PointLike, pair
from voronoi_tiles.designs.design_arguments import argument_of, cell_table, listed_sites, scale_table
from voronoi_tiles.designs.drawn_site import Site, site_of
from voronoi_tiles.designs.drawn_solid import Solid, solid_of, solid_tables
from voronoi_tiles.designs.load import parse, read_table
from voronoi_tiles.designs.schema import placement
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.designs.solid_checking import CheckedSolid
from voronoi_tiles.designs.toml_text import toml_text
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup

if TYPE_CHECKING:
    from voronoi_tiles.tiling import Tiling

Cell: TypeAlias = float | Sequence[float] | Mapping[str, float]
"""The conventional cell: the side a, (a, b), (a, b, angle), or a mapping of those that the group leaves free."""

_FITTED: Final = 1e-9
"""How near a tile's size is to the one that was asked for; relative to it."""

_FITS: Final = 6
"""How often a design is scaled to reach it, at most; a count. Two or three are enough, but where flattening jumps."""


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Design:
    """A wallpaper group, its cell and its sites, checked: what is refused in a file is refused here.

    `cell` is the side along x; or (a, b) or (a, b, angle) where the group leaves them free, the angle from a to b in
    degrees; or a mapping {"a": 60, "b": 50, "angle": 75}. `sites` are Site objects, or one. Lengths are in `units`,
    "mm", "cm" or "in"; the origin is the group's, x runs along a, y up. Cell, strokes and art are times `scale`;
    tolerances are not. `solid` says how the strokes move above the drawing, None that the design is flat. `name` is
    what files say of the design, and drawings are looked for in `folder`.

    Derived are the `lattice`; `noded`, the geometry of each site that tiles are computed from; `art`, the drawing of
    each site where it is placed, or None; `standing`, the geometry of the solid, or None; `notes`, sentences on what
    is left out of drawings; and `source`, the design as JSON (ASCII, sorted keys), which files hold as their recipe and
    `loads` reads again: it has the paths of drawings that are strokes in the place of their names.

    Designs are equal, and hash alike, where the group, the cell, the units and the sites are equal, as they are placed
    and with what drawings hold, whatever their names and folders. Raises DesignError, which names the argument:
    "sites[0].strokes[1].points[2]".

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
    drawn: str
    drawings: tuple[str, ...]
    notes: tuple[str, ...]
    standing: CheckedSolid | None
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
        scale: float = 1.0,
        solid: Solid | None = None,
        name: str = "design",
        folder: str | os.PathLike[str] = "",
    ) -> None:
        folder = path_name("folder", folder)
        table = {
            "schema": 1,
            "group": group.name if isinstance(group, WallpaperGroup) else group,
            "units": units,
            **scale_table(scale),
            "cell": cell_table(cell),
            "site": [site.table for site in listed_sites(sites)],
            **solid_tables(solid),
        }
        try:
            parts = checked(table, folder)
        except DesignError as error:
            raise error.with_key(argument_of(error.key or "")) from None
        _fill(self, parts, name, folder)

    def __repr__(self) -> str:
        sites = ", ".join(site.name for site in self.noded[:3]) + (", ..." if len(self.noded) > 3 else "")
        return f"<Design {self.name!r}: {self.group.name}, {counted(len(self.noded), 'site')} ({sites})>"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Design) and self._content == other._content

    def __hash__(self) -> int:
        return hash(self._content)

    @property
    def _parts(self) -> CheckedDesign:
        """What was checked."""
        return CheckedDesign(*(getattr(self, field) for field in CheckedDesign._fields))

    @cached_property
    def _content(self) -> tuple[object, ...]:
        by = Placement(self.scale)
        sites = tuple(site.placed(by) for site in self._sites_of(self.source))
        solid = solid_of(json.loads(self.source))
        solid = None if solid is None else solid.placed(by, self._sites_of(self.source), self.scale)
        return self.group.name, self.lattice, self.units, sites, solid

    def _sites_of(self, text: str) -> tuple[Site, ...]:
        """The sites in a text of this design, `drawn` or `source`, each with its name."""
        listed = json.loads(text)["site"]
        return tuple(site_of(table, noded.name) for table, noded in zip(listed, self.noded, strict=True))

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
        return self._sites_of(self.drawn)

    @cached_property
    def solid(self) -> Solid | None:
        """How it stands, as it is drawn, None where it is flat; `standing` has its geometry."""
        return solid_of(json.loads(self.drawn))

    @property
    def scale(self) -> float:
        """What cell, strokes and art are times."""
        return float(json.loads(self.drawn).get("scale", 1.0))

    @property
    def files(self) -> tuple[str, ...]:
        """The files that it was made from, which nothing overwrites: its own, and its drawings."""
        return (self.file, *self._paths) if self.file else self._paths

    @property
    def _paths(self) -> tuple[str, ...]:
        """The drawings of its strokes and its art."""
        art = (art.file for art in self.art if art is not None)
        return tuple(os.path.join(self.folder, name) for name in dict.fromkeys((*self.drawings, *art)))  # noqa: PTH118 - any name

    @property
    def cell(self) -> dict[str, float]:
        """The cell as it was given, before `scale`: side a, and b and the angle where the group leaves them free."""
        cell: dict[str, float] = json.loads(self.drawn)["cell"]
        return cell

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Design:
        """Read a design file, TOML or JSON by its suffix (else by its content); "-" is standard input.

        Raises DesignError where the file cannot be read or used.
        """
        file = path_name("path", path)
        shown = "standard input" if file == "-" else file or repr(file)
        table = read_table(file, shown)
        if file == "-":
            return cls.from_dict(table, file=shown)
        read = cls.from_dict(table, file=shown, folder=Path(file).parent)
        return _fill(read, read._parts, Path(file).stem, read.folder, file)  # noqa: SLF001 - it is one of us

    @classmethod
    def loads(
        cls,
        text: str,
        *,
        format: str | None = None,  # noqa: A002 - the word that scripts expect
        file: str | None = None,
        name: str = "design",
        folder: str | os.PathLike[str] = "",
    ) -> Design:
        """Read a design from text in "toml" or "json", None to see which; `file` is what messages call it.

        Drawings are looked for in `folder`. Raises DesignError.
        """
        return cls.from_dict(parse(text, format, file), file=file, name=name, folder=folder)

    @classmethod
    def from_dict(
        cls,
        mapping: Mapping[str, Any],
        *,
        file: str | None = None,
        name: str = "design",
        folder: str | os.PathLike[str] = "",
    ) -> Design:
        """Read a design from nested mappings and sequences, as TOML and JSON give them. Raises DesignError."""
        folder = path_name("folder", folder)
        try:
            return _fill(cls.__new__(cls), checked(mapping, folder), name, folder)
        except DesignError as error:
            raise error.with_file(file) from None

    def to_dict(self) -> dict[str, Any]:
        """The design as nested dictionaries, in the keys of a design file: what `from_dict` reads as an equal one."""
        return {
            "schema": 1,
            "group": self.group.name,
            "units": self.units,
            **scale_table(self.scale),
            "cell": self.cell,
            "site": [site.table for site in self.sites],
            **solid_tables(self.solid),
        }

    def to_toml(self) -> str:
        """The design as a design file, which is read as an equal one.

        Raises DesignError where the name of a drawing is no text that can be written.
        """
        return toml_text(self.to_dict())

    def text_for(self, path: str | os.PathLike[str]) -> str:
        """The design as a file of this name, TOML or JSON: its drawings are named as seen from its folder."""
        table = self.to_dict()
        name = path_name("path", path)
        folder = os.path.realpath(os.path.dirname(name))  # noqa: PTH120 - the name may be any
        for site in (*table["site"], *table.get("key", ())):
            for item in (*site["strokes"], site.get("art", {})):
                file = item.get("file")
                if file is not None and not os.path.isabs(file):  # noqa: PTH117 - same
                    item["file"] = os.path.relpath(os.path.realpath(os.path.join(self.folder, file)), folder)  # noqa: PTH118
        return json.dumps(table, indent=1) + "\n" if Path(name).suffix.lower() == ".json" else toml_text(table)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the design file whole or not at all; drawings are named as seen from its folder.

        It is JSON where the name ends in .json, else TOML. Raises OutputError where the file cannot be written.
        """
        refuse_overwriting([path_name("path", path)], self._paths)
        write_whole(path_name("path", path), self.text_for(path).encode())

    def replace(
        self,
        *,
        group: str | WallpaperGroup | None = None,
        cell: Cell | None = None,
        sites: Site | Iterable[Site] | None = None,
        units: Units | None = None,
        scale: float | None = None,
        solid: Solid | Literal[False] | None = None,
        name: str | None = None,
        folder: str | os.PathLike[str] | None = None,
    ) -> Design:
        """The design with some of its parts changed, checked again; None leaves a part as it is, False makes it flat.

        Raises DesignError.
        """
        name = self.name if name is None else name
        if all(part is None for part in (group, cell, sites, units, scale, solid, folder)):
            return _fill(Design.__new__(Design), self._parts, name, self.folder, self.file)
        made = Design(
            self.group if group is None else group,
            self.cell if cell is None else cell,
            self.sites if sites is None else sites,
            units=self.units if units is None else units,
            scale=self.scale if scale is None else scale,
            solid=self.solid if solid is None else solid or None,
            folder=self.folder if folder is None else folder,
        )
        return _fill(made, made._parts, name, made.folder, self.file)

    __replace__ = replace

    def scaled(
        self, factor: float | None = None, *, tile_width: float | None = None, tile_height: float | None = None
    ) -> Design:
        """The design with its cell and strokes times a factor above 0; tolerances stay as they are.

        In the place of a factor the width or the height of the tile can be given, of the largest where there are
        several; in the design's units. Raises DesignError for what is not above 0, and for more than one of them.
        """
        given = {"factor": factor, "tile_width": tile_width, "tile_height": tile_height}
        asked = [(name, value) for name, value in given.items() if value is not None]
        if len(asked) != 1:
            raise DesignError("must be one of a factor, tile_width and tile_height", key="factor", remedy="Give one.")
        name, value = asked[0]
        with values.within(name):
            size = values.positive(value)
        return self._times(size) if name == "factor" else self._fitted(size, name == "tile_height")

    def _fitted(self, size: float, high: bool) -> Design:
        """The design scaled until its largest tile is so wide, or so high."""
        found = self
        for _ in range(_FITS):
            bounds = (tile.outline.bounds for tile in found.tessellate().tiles)
            now = max(box[3] - box[1] if high else box[2] - box[0] for box in bounds)
            if abs(now - size) <= _FITTED * size:
                break
            # Curves are flattened anew at every size: once is not enough.
            found = found._times(size / now)
        return found

    def _times(self, factor: float) -> Design:
        """The design scaled by a factor."""
        cell = {name: value if name == "angle" else value * factor for name, value in self.cell.items()}
        return self._replaced(Placement(factor), cell=cell, height=factor)

    def moved(
        self, *, mirror: bool = False, scale: float = 1.0, rotate: float = 0.0, translate: PointLike = 0j
    ) -> Design:
        """The design with all strokes and art moved in its cell, in the order of the arguments, about the origin.

        `mirror` is x -> -x, `rotate` in degrees counter-clockwise, `translate` in the design's units whatever its
        `scale`. The group and its origin stay, so that the tiles are others, but for the motions that map the group
        onto itself. Raises DesignError.
        """
        by = placement({"mirror": mirror, "scale": scale, "rotate": rotate, "translate": pair(translate)})
        # The design's scale comes after what places a site.
        by = Placement(by.scale, by.rotate, by.translate / self.scale, by.mirror)
        return self._replaced(by)

    def _replaced(self, by: Placement, *, cell: Cell | None = None, height: float = 1.0) -> Design:
        """The design with its sites and what they become above moved, in this cell, and its height times a factor."""
        solid = None if self.solid is None else self.solid.placed(by, self.sites, height)
        return self.replace(cell=cell, sites=self._placed(by), solid=solid)

    def _placed(self, by: Placement) -> list[Site]:
        """All sites, moved after they have been placed; errors name the argument that a stroke was made of."""
        try:
            with values.within("site"):
                return values.each(self.sites, lambda site: site.placed(by))
        except DesignError as error:
            raise error.with_key(argument_of(error.key or "")) from None

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
