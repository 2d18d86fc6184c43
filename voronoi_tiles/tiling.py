"""The pipeline: from a design to its tiles, proved, and on to files."""

from __future__ import annotations

import io
import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from voronoi_tiles.base.errors import CheckError, OutputError
from voronoi_tiles.base.files import write_whole, writing
from voronoi_tiles.designs.site import Site

if TYPE_CHECKING:
    from shapely import MultiPolygon, Polygon

    from voronoi_tiles.base.operations import Operation
    from voronoi_tiles.crosscheck import CheckReport
    from voronoi_tiles.designs.design import Design
    from voronoi_tiles.fabrication import Job, Product
    from voronoi_tiles.vector.outline import Outline
    from voronoi_tiles.vector.proof import ProofReport
    from voronoi_tiles.vector.tessellation import Tessellation, TileRecord

FORMATS = ("svg", "json", "dxf", "pdf", "lbrn2")


@dataclass(frozen=True, eq=False)
class Tile:
    """The tile of one site: every point that is nearer to this site than to any other copy.

    Lengths are in the design's units. `symmetry` holds the operations that map the site, and so the tile, onto itself,
    the identity first; `copies_per_cell` is the group's order divided by their number.
    """

    site: Site
    outline: Outline
    copies_per_cell: int
    symmetry: tuple[Operation, ...]
    _record: TileRecord

    def __repr__(self) -> str:
        return f"<Tile {self.site.name!r}: {len(self.outline)} edges, {self.copies_per_cell} copies per cell>"

    @property
    def area(self) -> float:
        """The area in square units."""
        return self.outline.area

    @property
    def perimeter(self) -> float:
        """The length of the outline, holes included, in units."""
        return self.outline.perimeter

    def copy(self, operation: Operation) -> Outline:
        """Give the outline of a copy, the image under an operation of the group.

        An edge that two copies share has the same numbers in both, bit for bit.
        """
        return self._record.copy(operation)

    def to_shapely(self, *, accuracy: float) -> Polygon | MultiPolygon:
        """Give the tile as a shapely polygon whose chords stay within `accuracy` (in units) of the outline."""
        return self.outline.to_shapely(accuracy=accuracy)

    def svg_path(self) -> str:
        """Write the outline as exact SVG path data in units about the design's origin, y turned to run down."""
        from voronoi_tiles.formats.svg.path_text import path_data

        return path_data(self.outline.paths)

    def _repr_svg_(self) -> str:
        """Draw the tile and its site: notebooks show this."""
        from voronoi_tiles.pictures.notebook import tile_picture

        return tile_picture(self.outline, self.site.elements)


@dataclass(frozen=True, eq=False)
class Tiling:
    """The proved result of a design: its tiles, one for each site in the design's order, and their proof.

    `tessellation` is the engine's result that they are taken from, without the proof.
    """

    design: Design
    tiles: tuple[Tile, ...]
    proof: ProofReport

    def __repr__(self) -> str:
        return f"<Tiling {self.design.name!r}: {self.design.group.name}, {len(self.tiles)} tiles>"

    @property
    def tessellation(self) -> Tessellation:
        """All tiles in terms of exact motions: what sheets are made from."""
        return self.tiles[0]._record.tessellation  # noqa: SLF001 - the tiling owns its tiles

    def figures(self) -> dict[str, Any]:
        """Give what there is to know about the tiles in numbers, as `voronoi-tiles info --json` prints it."""
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
            "tiles": [_tile_figures(tile) for tile in self.tiles],
            "proof": self._proof_rows(),
        }

    def check(
        self,
        *,
        samples: int | None = None,
        renderer: Literal["auto", "gl", "cpu"] = "auto",
        device: int | None = None,
        method: Literal["exact", "hoff"] = "exact",
        notice: Callable[[str], None] | None = None,
    ) -> CheckReport:
        """Compare the outlines with an image that the raster stage renders of the same design.

        See `voronoi_tiles.crosscheck.crosscheck`; `samples` None is its default. Raises RenderError.
        """
        from voronoi_tiles.crosscheck import DEFAULT_SAMPLES, crosscheck

        count = DEFAULT_SAMPLES if samples is None else samples
        outlines = [tile.outline for tile in self.tiles]
        return crosscheck(
            self.design, outlines, samples=count, renderer=renderer, device=device, method=method, notice=notice
        )

    def _proof_rows(self) -> list[dict[str, Any]]:
        """Give the figures of the proof in the types of JSON."""
        return [
            {"name": name, "value": value, "limit": limit, "passed": passed}
            for name, value, limit, passed in self.proof.rows()
        ]

    def evidence(self, check: CheckReport) -> dict[str, Any]:
        """Give what was proved and checked, in the types of JSON, as `voronoi-tiles check --json` prints it."""
        return {
            "design": self.design.name,
            "group": self.design.group.name,
            "proof": self._proof_rows(),
            "check": check.document(),
        }

    def document(self, check: CheckReport | None = None) -> dict[str, Any]:
        """Give the outline document (schema 1): coordinates in the design's units, y up.

        With a cross-check's report a last key, "evidence", holds what was proved and checked.
        """
        from voronoi_tiles.vector.document import outline_document, tile_record

        document = outline_document(
            self.design.units,
            self.design.group.name,
            self.design.lattice,
            (
                tile_record(tile.site.name, tile.site.elements, tile.outline, tile.copies_per_cell, tile.symmetry)
                for tile in self.tiles
            ),
        )
        return document if check is None else {**document, "evidence": self.evidence(check)}

    def json(self, check: CheckReport | None = None) -> str:
        """Write the outline document as JSON text, floats with 17 significant digits."""
        from voronoi_tiles.vector.document import document_text

        return document_text(self.document(check))

    def svg(self, check: CheckReport | None = None) -> str:
        """Write the tiles, where they lie in the plane, as an SVG file in millimetres: one path per tile.

        With a cross-check's report the metadata hold what was proved and checked.
        """
        from voronoi_tiles.fabrication.exact import design_recipe, exact_drawing
        from voronoi_tiles.formats.svg.writer import write_svg

        tiles = [(tile.site.name, tile.outline) for tile in self.tiles]
        drawing = exact_drawing(tiles, self.design.unit_mm, design_recipe(self.design))
        if check is not None:
            drawing = drawing.with_evidence(self.evidence(check))
        buffer = io.BytesIO()
        write_svg(drawing, buffer, exact=True)
        return buffer.getvalue().decode()

    def text(self, file_format: str, check: CheckReport | None = None) -> str:
        """Give the exact tiles as a text, "svg" or "json". Raises ValueError for another format."""
        match file_format:
            case "svg":
                return self.svg(check)
            case "json":
                return self.json(check)
            case _:
                raise ValueError(f"unknown format {file_format!r}: use svg or json")

    def make(self, job: Job, file_format: str = "svg") -> Product:
        """Make the drawing of a job for a format of files ("svg", "dxf", "pdf", "lbrn2").

        Raises JobError where the job cannot be done.
        """
        from voronoi_tiles.fabrication import make

        return make(self.design, self.tessellation, job, file_format)

    def write(
        self, path: str | os.PathLike[str], file_format: str, *, job: Job | None, check: CheckReport | None = None
    ) -> Product | None:
        """Write a file whole or not at all; give the product that was written.

        Without a job SVG and JSON hold the exact tiles where they lie in the plane, and there is no product. Raises
        JobError for a job that cannot be done, or that comes with JSON.
        """
        from voronoi_tiles.fabrication import Job, JobError

        if check is not None:
            require(check)
        drawn = any(art is not None for art in self.design.art)
        if job is None and (file_format == "json" or (file_format == "svg" and not drawn)):
            write_whole(path, self.text(file_format, check).encode())
            return None
        if file_format == "json":
            raise JobError(
                "a JSON document holds the exact outlines of one of each tile, and no sheet",
                remedy="Write svg, dxf, pdf or lbrn2, or leave the other options out.",
            )
        product = self.make(job or Job(), file_format)
        if check is not None:
            product = product.with_evidence(self.evidence(check))
        with writing(path) as file:
            product.write(file)
        return product

    def export(
        self,
        path: str | os.PathLike[str],
        *,
        edges: Literal["once", "pieces"] | None = None,
        job: Job | None = None,
        check: CheckReport | None = None,
    ) -> None:
        """Write a file whole or not at all, its format by its suffix (.svg, .dxf, .pdf, .lbrn2, .json).

        `job` says what is to be made of the tiles (sheet, kerf, ...), `edges` is a short way to a job that says only
        this. A cross-check's report goes into the file. Raises OutputError where the suffix is another, or the file
        cannot be written, JobError for a job that cannot be done, and CheckError, before anything is written, where the
        report has failures.
        """
        from voronoi_tiles.fabrication import Job

        if edges is not None:
            job = Job(edges=edges) if job is None else replace(job, edges=edges)
        self.write(path, format_of(path), job=job, check=check)


def _tile_figures(tile: Tile) -> dict[str, Any]:
    """Give one tile's figures: lengths in units; the neighbours by the length of the shared edges, longest first."""
    outline = tile.outline
    count = len(outline.neighbours)
    edges = np.bincount(outline.neighbour, minlength=count).tolist()
    lengths = np.bincount(outline.neighbour, weights=outline.lengths, minlength=count).tolist()
    neighbours = [
        {"site": site, "operation": str(operation), "edges": edges[k], "length": lengths[k]}
        for k, (site, operation) in enumerate(outline.neighbours)
    ]
    curved = int(outline.curved.sum())
    return {
        "site": tile.site.name,
        "elements": len(tile.site.elements),
        "area": tile.area,
        "perimeter": tile.perimeter,
        "rings": len(outline.ring_offsets) - 1,
        "edges": {"line": len(outline) - curved, "parabola": curved},
        "curved_share": outline.curved_length / tile.perimeter,
        "copies_per_cell": tile.copies_per_cell,
        "symmetry": [str(operation) for operation in tile.symmetry],
        "neighbours": sorted(neighbours, key=lambda row: -float(row["length"])),
    }


def format_of(path: str | os.PathLike[str]) -> str:
    """Give the format that a file's suffix names. Raises OutputError where it names none."""
    suffix = Path(path).suffix.lower().removeprefix(".")
    if suffix not in FORMATS:
        suffixes = " or ".join(f".{name}" for name in FORMATS)
        raise OutputError(f"cannot tell the format of {os.fspath(path)!r}: give it the suffix {suffixes}", path=path)
    return suffix


def require(check: CheckReport) -> None:
    """Raise CheckError where a cross-check has failed."""
    if not check.passed:
        raise CheckError(f"the outlines failed the cross-check: {', '.join(check.failures)}", check)


def tessellate(design: Design) -> Tiling:
    """Compute the tiles of a design and prove them.

    Raises TouchingCopiesError where two copies touch, ProofError where the result fails its proof.
    """
    from voronoi_tiles.vector.proof import proved_tiles

    records, proof = proved_tiles(design.sites, design.group, design.lattice)
    tiles = tuple(
        Tile(site, record.outline, design.group.order // len(record.symmetry), record.symmetry, record)
        for site, record in zip(design.sites, records, strict=True)
    )
    return Tiling(design, tiles, proof)
