"""The pipeline: from a design to its tiles, proved, and on to files and pictures."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal, Unpack, get_args, overload

import numpy as np

from voronoi_tiles.base.arguments import instance, of_site, path_name
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.files import refuse_overwriting, write_whole
from voronoi_tiles.base.maps import Placement
from voronoi_tiles.base.text import counted
from voronoi_tiles.designs.design import Design
from voronoi_tiles.tile import Tile, TileCopy
from voronoi_tiles.vector.proof import ProofReport
from voronoi_tiles.vector.tessellation import Tessellation

if TYPE_CHECKING:
    from voronoi_tiles.crosscheck.check_report import CheckReport
    from voronoi_tiles.designs.art import Art
    from voronoi_tiles.fabrication.exporting import Exported
    from voronoi_tiles.fabrication.job import Job
    from voronoi_tiles.fabrication.job_fields import Edges
    from voronoi_tiles.fabrication.product import Product
    from voronoi_tiles.gradients.shape_gradient import ShapeGradient
    from voronoi_tiles.pictures.rendered import Rendering
    from voronoi_tiles.pictures.rendering import RenderOptions
    from voronoi_tiles.raster.renderer import Choice, Method, Provenance

FileFormat = Literal["svg", "json", "dxf", "pdf", "lbrn2", "gcode"]
FORMATS: tuple[FileFormat, ...] = get_args(FileFormat)


@dataclass(frozen=True, eq=False, repr=False)
class Tiling:
    """The tiles of a design, one for each site in the design's order, with the proof that they are right.

    A tiling is a sequence of its tiles, which are found by their sites' names as well. `tessellation` is the engine's
    result that they are taken from, without the proof.

    >>> import voronoi_tiles as vt
    >>> tiling = vt.starter("p4m").tessellate()
    >>> tiling
    <Tiling 'p4m': p4m, 2 tiles>
    >>> [tile.name for tile in tiling], tiling["leaf"] is tiling[1], tiling.proof.passed
    (['star', 'leaf'], True, True)
    """

    design: Design
    tiles: tuple[Tile, ...]
    proof: ProofReport

    def __repr__(self) -> str:
        return f"<Tiling {self.design.name!r}: {self.design.group.name}, {counted(len(self), 'tile')}>"

    def __len__(self) -> int:
        """Count the tiles."""
        return len(self.tiles)

    def __iter__(self) -> Iterator[Tile]:
        return iter(self.tiles)

    def __contains__(self, item: object) -> bool:
        """Whether there is such a tile, or one of this name."""
        return any(item is tile or item == tile.name for tile in self.tiles)

    @overload
    def __getitem__(self, key: int | str) -> Tile: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[Tile, ...]: ...
    def __getitem__(self, key: int | str | slice) -> Tile | tuple[Tile, ...]:
        """The tile of a number, or of the name of its site. Raises UnknownNameError, IndexError."""
        if not isinstance(key, str):
            return self.tiles[key]
        return of_site(self.tiles, key)

    @property
    def tessellation(self) -> Tessellation:
        """All tiles in terms of exact motions: what sheets are made from."""
        return self.tiles[0]._record.tessellation  # noqa: SLF001 - the tiling owns its tiles

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        """The tiles as a FeatureCollection of GeoJSON, each within its `outline.display_accuracy`."""
        features = [
            {
                "type": "Feature",
                "geometry": tile.__geo_interface__,
                "properties": {"site": tile.name, "area": tile.area, "copies_per_cell": tile.copies_per_cell},
            }
            for tile in self.tiles
        ]
        return {"type": "FeatureCollection", "features": features}

    def copies(self, region: Any) -> list[TileCopy]:
        """The copies of all tiles that meet a region: a rectangle (x0, y0, x1, y1), or a geometry of shapely's.

        Copies that miss it by less than their `outline.display_accuracy` are among them; none that meets it is left
        out. Operations are those that outlines name neighbours by. Raises ArgumentError for what is no region,
        and for one whose box holds more than 100,000 copies.

        >>> import voronoi_tiles as vt
        >>> tiling = vt.starter("p4").tessellate()
        >>> copies = tiling.copies((0, 0, 60, 60))
        >>> len(copies), copies[0]
        (16, TileCopy(site='bird', operation=Operation.parse('x,y'), outline=<Outline: 223 edges in 1 ring>))
        """
        from voronoi_tiles.vector.region_copies import copies_in_region, read_region

        found = copies_in_region(self.tessellation, read_region(region))
        return [
            TileCopy(self.tiles[tile].name, operation, self.tiles[tile].copy(operation)) for tile, operation in found
        ]

    def shape_gradient(self, parameters: str | Iterable[str] | None = None) -> ShapeGradient:
        """How the tiles move with numbers of the design: derivatives of outlines, areas and lengths, in closed form.

        `parameters` are places in the design file, such as "cell.a" and "site[0].strokes[1].bezier[2][0]"; "cell" and
        "site[0].strokes[1]" are all that are drawn below them, and None all that are drawn: the cell, points and radii.
        What places strokes and sites is named in full: "site[0].rotate". Raises ArgumentError for what is none.

        >>> import voronoi_tiles as vt
        >>> vt.starter("p4").tessellate().shape_gradient("site[0]")["bird"].along(400).velocity.shape
        (400, 8)
        """
        from voronoi_tiles.gradients.shape_gradient import shape_gradient

        return shape_gradient(self.design, [(tile.outline, tile.symmetry) for tile in self.tiles], parameters)

    def figures(self) -> dict[str, Any]:
        """What there is to know about the tiles in numbers, as `voronoi-tiles info --json` prints it."""
        lattice, group = self.design.lattice, self.design.group
        return {
            "design": self.design.name,
            "units": self.design.units,
            "group": group.name,
            "order": group.order,
            "cell": {
                "a": [lattice.a.real, lattice.a.imag],
                "b": [lattice.b.real, lattice.b.imag],
                "area": lattice.det,
            },
            "tiles": [tile.figures() for tile in self.tiles],
            "proof": self.proof.document(),
        }

    def check(
        self,
        *,
        samples: int | None = None,
        renderer: Choice = "auto",
        device: int | None = None,
        method: Method = "exact",
        notice: Callable[[str], None] | None = None,
    ) -> CheckReport:
        """Compare the outlines with an image that the raster stage renders of the same design.

        `samples` along the side of the cell, None for 1024; the others are those of `render`. Raises RenderError.
        """
        from voronoi_tiles.crosscheck import DEFAULT_SAMPLES, crosscheck

        count = DEFAULT_SAMPLES if samples is None else samples
        outlines = [tile.outline for tile in self.tiles]
        return crosscheck(
            self.design, outlines, samples=count, renderer=renderer, device=device, method=method, notice=notice
        )

    def difference(self, check: CheckReport) -> Rendering:
        """The picture of where a cross-check has found differences, and by how much: white where they agree.

        Raises ArgumentError for the report of another design.
        """
        from voronoi_tiles.pictures.rendering import difference

        self._require_own(check)
        return difference(self.design, [tile.outline for tile in self.tiles], check)

    def _require_own(self, check: CheckReport) -> None:
        """Raise ArgumentError for a cross-check of another design, which is evidence of nothing here."""
        from voronoi_tiles.crosscheck.check_report import CheckReport

        source = instance("check", check, CheckReport).source
        if source != self.design.source and Design.loads(source) != self.design:
            raise ArgumentError("the `check` is of another design", remedy="Give the report of this tiling's check().")

    def evidence(self, check: CheckReport) -> dict[str, Any]:
        """What was proved and checked, in the types of JSON, as `voronoi-tiles check --json` prints it.

        Raises ArgumentError for the report of another design.
        """
        self._require_own(check)
        return {
            "design": self.design.name,
            "group": self.design.group.name,
            "proof": self.proof.document(),
            "check": check.document(),
        }

    def document(self, check: CheckReport | None = None) -> dict[str, Any]:
        """The outline document (schema 1): coordinates in the design's units, y up.

        With a cross-check's report a last key, "evidence", holds what was proved and checked.
        """
        from voronoi_tiles.vector.document import outline_document, tile_record

        document = outline_document(
            self.design.units,
            self.design.group.name,
            self.design.lattice,
            (
                tile_record(tile.name, tile.site.elements, tile.outline, tile.copies_per_cell, tile.symmetry)
                for tile in self.tiles
            ),
        )
        return document if check is None else {**document, "evidence": self.evidence(check)}

    def json(self, check: CheckReport | None = None) -> str:
        """The outline document as JSON text, floats with 17 significant digits."""
        from voronoi_tiles.vector.document import document_text

        return document_text(self.document(check))

    def svg(self, check: CheckReport | None = None) -> str:
        """The tiles, where they lie in the plane, as an SVG file in millimetres: one path per tile.

        With a cross-check's report the metadata hold what was proved and checked.
        """
        from voronoi_tiles.fabrication.exact import exact_svg

        tiles = [(tile.name, tile.outline) for tile in self.tiles]
        return exact_svg(self.design, tiles, None if check is None else self.evidence(check))

    def text(self, file_format: str, check: CheckReport | None = None) -> str:
        """The exact tiles as a text, "svg" or "json". Raises ArgumentError for another format."""
        match file_format:
            case "svg":
                return self.svg(check)
            case "json":
                return self.json(check)
            case _:
                raise ArgumentError(f"no text can be made as {file_format!r}", remedy="Use svg or json.")

    def make(self, job: Job | None = None, file_format: str = "svg") -> Product:
        """The drawing of a job for a format of files ("svg", "dxf", "pdf", "lbrn2", "gcode").

        Raises JobError where the job cannot be done.

        >>> import voronoi_tiles as vt
        >>> vt.starter("p4").tessellate().make(vt.Job(sheet="300x200mm", margin=5, kerf=0.15))
        <Product svg: 43 pieces, 64.5% of 300 x 200 mm, 5.26 m of cuts in 43 paths>
        """
        from voronoi_tiles.fabrication.job import Job
        from voronoi_tiles.fabrication.product import make

        return make(self.design, self.tessellation, Job() if job is None else instance("job", job, Job), file_format)

    def report(
        self, job: Job | None = None, *, speeds: Mapping[str, float] | None = None, pierce_s: float | None = None
    ) -> dict[str, Any]:
        """What a job comes to, as `voronoi-tiles report --json` prints it: pieces, sheet use, cut length, time.

        Lengths are millimetres, times seconds. `speeds` are those of "cut", "score", "engrave" and "travel" in mm/s,
        and `pierce_s` the seconds of a pierce. Raises JobError where the job cannot be done, ArgumentError for speeds
        that are none.

        >>> import voronoi_tiles as vt
        >>> report = vt.starter("p4").tessellate().report(vt.Job(sheet=(300, 200), margin=5))
        >>> report["pieces"]["count"], round(report["cut"]["length"]), report["cut"]["pierces"]
        (54, 3769, 34)
        """
        from voronoi_tiles.fabrication.job import Job
        from voronoi_tiles.fabrication.job_report import report_figures
        from voronoi_tiles.fabrication.product import make_reported

        job = Job() if job is None else instance("job", job, Job)
        # What goes into a file of its own is on a layer of its own in the one drawing that is reported of.
        product, packing = make_reported(self.design, self.tessellation, job)
        return report_figures(self.design, product, packing=packing, speeds=speeds, pierce_s=pierce_s)

    def template(self, path: str | os.PathLike[str], site: str | None = None) -> Art:
        """Write a page to draw a site's art on, an SVG file, and give the art that the site gets when it is drawn.

        The tile and the site's strokes are on a layer "guide"; draw in the layer "engrave", or in one called "score".
        `site` is a name, None the first. Raises OutputError where the file is there already, or cannot be written.
        """
        from voronoi_tiles.fabrication.art_template import write_template

        tile = self[0 if site is None else instance("site", site, str)]
        art = write_template(path, self.design.folder, tile.site, tile.outline, self.design.unit_mm)
        # Where the site is placed, its art is placed once more.
        place = Placement(self.design.scale) @ self.design.sites[self.tiles.index(tile)].placement
        return art if place.is_identity else art.placed(place.inverse)

    @overload
    def render(self, path: None = None, **options: Unpack[RenderOptions]) -> Rendering: ...
    @overload
    def render(self, path: str | os.PathLike[str], **options: Unpack[RenderOptions]) -> Provenance: ...
    def render(
        self, path: str | os.PathLike[str] | None = None, **options: Unpack[RenderOptions]
    ) -> Rendering | Provenance:
        """Render the coloured tessellation, into memory or as a PNG file: see `render`, whose options it takes."""
        from voronoi_tiles.pictures.rendering import paint

        records = [tile._record for tile in self.tiles]  # noqa: SLF001 - the tiling owns its tiles
        return paint(self.design, path, records=records, **options)

    def plot(self, ax: Any = None, *, region: Any = None) -> Any:
        """Draw the tiles and their sites on axes of matplotlib (None: the current ones), which it gives back.

        With a region, as in `copies`, all copies that meet it are drawn. Raises MissingLibraryError where matplotlib is
        not installed.
        """
        from voronoi_tiles.pictures.plotting import plot_copies

        tiles = {tile.name: (tile.outline, tile.site.ends) for tile in self}
        copies = () if region is None else ((copy.site, copy.outline) for copy in self.copies(region))
        return plot_copies(ax, tiles, copies)

    def _repr_svg_(self) -> str:
        """Draw the tiles over the copies about them: notebooks show this."""
        from voronoi_tiles.pictures.notebook import tiling_picture

        bounds = np.array([tile.outline.bounds for tile in self])
        copies = self.copies((*bounds[:, :2].min(axis=0), *bounds[:, 2:].max(axis=0)))
        return tiling_picture([(tile.outline, tile.site.ends) for tile in self], [copy.outline for copy in copies])

    def export(
        self,
        path: str | os.PathLike[str],
        *,
        edges: Edges | None = None,
        job: Job | None = None,
        check: CheckReport | None = None,
        file_format: FileFormat | None = None,
        progress: Callable[[float, float], None] | None = None,
    ) -> tuple[Exported, ...]:
        """Write a file whole or not at all, and say what was written.

        `job` says what is to be made of the tiles (sheet, kerf, ...), `edges` is a short way to a job that says only
        this; with neither, SVG and JSON hold the exact tiles where they lie in the plane. The format is that of the
        suffix (.svg, .dxf, .pdf, .lbrn2, .gcode or .nc, .json), or `file_format`. With `colours="files"` there is a
        file for each colour: name-1.svg, name-2.svg, ... A cross-check's report goes into the file. `progress`
        is called with how many seconds of how many a search for places has taken.

        Raises OutputError where the suffix is another, the file cannot be written, or is one that the job reads;
        JobError for a job that cannot be done, or that comes with JSON; and CheckError, before anything is written,
        where the report has failures.
        """
        from voronoi_tiles.fabrication.exporting import Exported, format_of, write_products
        from voronoi_tiles.fabrication.job import Job
        from voronoi_tiles.fabrication.job_options import JobError

        name = path_name("path", path)
        form = format_of(path, FORMATS) if file_format is None else file_format
        if check is not None:
            from voronoi_tiles.crosscheck.check_report import require_passed

            self._require_own(check)
            require_passed(check)
        if job is not None:
            instance("job", job, Job)
        if edges is not None:
            job = Job(edges=edges) if job is None else replace(job, edges=edges)
        drawn = any(art is not None for art in self.design.art)
        if job is None and (form == "json" or (form == "svg" and not drawn)):
            refuse_overwriting([name], self.design.files)
            write_whole(name, self.text(form, check).encode())
            return (Exported(name, None),)
        if form == "json":
            raise JobError(
                "a JSON document holds the exact outlines of one of each tile, and no sheet",
                remedy="Write svg, dxf, pdf, lbrn2 or gcode, or leave the other options out.",
            )
        evidence = None if check is None else self.evidence(check)
        return write_products(self.design, self.tessellation, name, form, job or Job(), evidence, progress)


def tessellate(design: Design) -> Tiling:
    """Compute the tiles of a design and prove them.

    Raises TouchingCopiesError where two copies touch, ProofError where the result fails its proof.
    """
    from voronoi_tiles.vector.proof import proved_tiles

    records, proof = proved_tiles(design.noded, design.group, design.lattice)
    tiles = tuple(
        Tile(site, record.outline, design.group.order // len(record.symmetry), record.symmetry, record)
        for site, record in zip(design.noded, records, strict=True)
    )
    return Tiling(design, tiles, proof)
