"""From a tiling and a job to the drawing that is written, and to the figures of a report."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from io import BytesIO, RawIOBase
from math import fsum
from typing import Any, BinaryIO, Final

import numpy as np

from voronoi_tiles.base.arguments import path_name
from voronoi_tiles.base.files import refuse_overwriting, writing
from voronoi_tiles.base.text import counted
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.artwork import Works
from voronoi_tiles.fabrication.curve_choice import curve_converter, file_curves
from voronoi_tiles.fabrication.cutting import Cut, cut_lines, cut_pieces, cut_shapes, of_colour, toured
from voronoi_tiles.fabrication.demands import as_demanded
from voronoi_tiles.fabrication.engraving import engrave
from voronoi_tiles.fabrication.exact import design_recipe
from voronoi_tiles.fabrication.hints import hints_of
from voronoi_tiles.fabrication.inventory import Inventory, cut_free, inventory
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.job_notes import doubled, unnested, untabbed, without_effect
from voronoi_tiles.fabrication.job_options import LAYOUTS
from voronoi_tiles.fabrication.laying import laid, unplaced
from voronoi_tiles.fabrication.layout import FRAME, Layout
from voronoi_tiles.fabrication.nest_places import places_recipe
from voronoi_tiles.fabrication.nest_search import Progress
from voronoi_tiles.fabrication.nested_sheets import Nesting
from voronoi_tiles.fabrication.nesting import Arranged
from voronoi_tiles.fabrication.packed_sheets import PackedColour, nest_colours, pack_colours
from voronoi_tiles.fabrication.tile_colouring import TileColouring, colour_tiles
from voronoi_tiles.formats.burns import Burn, Role
from voronoi_tiles.formats.page import Drawing, Layer, Work, fitting_page
from voronoi_tiles.formats.presets import FORMATS, DxfStyle, DxfVersion, Format, Preset, load_preset
from voronoi_tiles.formats.writing import write_drawing
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.vector.tessellation import Tessellation

_PICTURE_MM: Final = 150.0
"""The longer side of the picture in notebooks."""

_PICTURE_LINE_MM: Final = 0.25
"""The width of its lines: a pixel."""

_SHEET_COLOUR: Final = "#c8c8c8"
"""The colour of the sheet's edge in it."""


@dataclass(frozen=True, eq=False, repr=False)
class Product:
    """What a job makes of a tiling, for a format of files.

    `notes` say in sentences what was guessed and left out of drawings, and lost to kerf or fillet; `colours` is how
    many the whole tessellation takes by the `scheme` of the job, None where it asks for none: the fewest; `files` are
    those that it was made from, which `save` does not overwrite. `bounded` is the area of a sheet that is drawn, square
    millimetres.
    """

    form: Format
    drawing: Drawing
    pieces: Inventory
    colours: int
    scheme: str | int | None
    notes: tuple[str, ...]
    curves: str
    accuracy: float
    files: tuple[str, ...]
    dxf_version: DxfVersion
    spline_edges: bool
    hints: tuple[str, ...] = ()
    bounded: float | None = None

    @property
    def sheet_area(self) -> float:
        """The area of the sheet, what a drawing bounds or the whole page; square millimetres."""
        return self.drawing.width * self.drawing.height if self.bounded is None else self.bounded

    def __repr__(self) -> str:
        return f"<Product {self.form}: {self._outcome()}>"

    def _repr_svg_(self) -> str:
        """Draw it for a screen, on which the hairlines of files would not be seen: notebooks show this."""
        page = self.drawing
        scale = _PICTURE_MM / max(page.width, page.height)
        width, height = page.width * scale, page.height * scale
        edge = Paths.polylines([[0j, complex(width), complex(width, height), 1j * height]], closed=True)
        layers = [Layer.of_paths("sheet", "engrave", _SHEET_COLOUR, 2 * _PICTURE_LINE_MM, edge)]
        for layer in page.layers:
            paths = layer.paths.moved(1.0, complex(0.0, -page.bottom)).moved(scale, 0j)
            layers.append(replace(layer, paths=paths, stroke=_PICTURE_LINE_MM, filled=False))
        buffer = BytesIO()
        picture = Drawing(width, height, tuple(layers), page.title)
        write_drawing(picture, buffer, "svg", accuracy=_PICTURE_LINE_MM / 10)
        return buffer.getvalue().decode()

    def with_evidence(self, evidence: Mapping[str, Any]) -> Product:
        """The same with what was proved and checked in the recipe."""
        return replace(self, drawing=self.drawing.with_evidence(evidence))

    def summary(self) -> str:
        """Say in a line what it comes to, and how more tiles would fit."""
        return "; ".join((self._outcome(), *self.hints))

    def _outcome(self) -> str:
        """Say in a line what it comes to."""
        cuts = [layer.paths for layer in self.drawing.layers if layer.work == "cut"]
        length = fsum(float(paths.lengths.sum()) for paths in cuts) / 1000
        strokes = sum(map(len, cuts))
        area = self.pieces.tile_area if self.pieces.count else fsum(self.pieces.area.tolist())
        drawn = "" if self.bounded is None else "the sheet drawn on "
        colours = len(np.unique(self.pieces.colour[self.pieces.site != FRAME]))
        woods = f", {colours} colours" if self.scheme is not None and colours > 1 else ""
        return (
            f"{self.pieces.counted}, {area / self.sheet_area:.1%} of {drawn}{self.drawing.width:.5g} x "
            f"{self.drawing.height:.5g} mm, {length:.3g} m of cuts in {counted(strokes, 'path')}{woods}"
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the drawing's file, whole or not at all, in the product's format whatever the suffix.

        Raises OutputError, also where the job reads this file.
        """
        name = path_name("path", path)
        refuse_overwriting([name], self.files)
        with writing(name) as file:
            self.write(file)

    def write(self, file: BinaryIO | RawIOBase) -> None:
        """Write the drawing into a file that is open for bytes."""
        style = DxfStyle(self.dxf_version, self.spline_edges)
        write_drawing(self.drawing, file, self.form, curves=self.curves, accuracy=self.accuracy, dxf=style)


def make(
    design: Design, tessellation: Tessellation, job: Job, file_format: str = "svg", progress: Progress | None = None
) -> Product:
    """Make what a job asks for, in the curves that a format takes; `progress` is told of a search for places.

    Raises JobError where the job cannot be done, DesignError where the preset or the sheet's drawing is broken.
    """
    form = _format(file_format)
    if job.several and (job.only_colour is None or job.pack or job.sheets is not None):
        what, other = ("sheet", "leave `sheets` out") if job.sheets is not None else ("colour", "use `into='layers'`")
        raise JobError(
            f"a file for each {what} is several drawings, and one is asked for",
            remedy=f"Export it to a file's name, or {other}.",
        )
    plan = _Plan.of(design, tessellation, job, form, progress)
    return plan.product(plan.layout.job)


def make_together(
    design: Design,
    tessellations: Iterable[Tessellation],
    job: Job,
    file_format: str,
    finish: Callable[[Sequence[Layout]], Sequence[Layout]],
    progress: Progress | None = None,
) -> list[Product]:
    """Make a drawing of each of some tessellations, whose tiles `finish` places all together on their sheets.

    It is given what `unplaced` gives; `progress` is told how many are made. Raises what `make` does.
    """
    form = _format(file_format)
    plans = [_Plan.of(design, tessellation, job, form, lay=unplaced) for tessellation in tessellations]
    made = []
    for plan, sheet in zip(plans, finish([plan.layout for plan in plans]), strict=True):
        made.append(plan.on(sheet).product(sheet.job))
        if progress is not None:
            progress(len(made), len(plans))
    return made


def make_several(
    design: Design, tessellation: Tessellation, job: Job, file_format: str = "svg", progress: Progress | None = None
) -> list[tuple[str, Product]]:
    """Make a drawing for each sheet, or for each colour that a job has pieces of and for a frame.

    Each has a name for its file. `progress` is told of a search for places.

    Raises what `make` does.
    """
    plan = _Plan.of(design, tessellation, job, _format(file_format), progress)
    if len(plan.sheets) > 1 or (job.sheets is not None and not job.pack):
        return [(str(k + 1), plan.on(sheet).product(sheet.job)) for k, sheet in enumerate(plan.sheets)]
    job = plan.layout.job
    if job.pack:
        return plan.packed(job, progress)
    return [(name, plan.product(replace(job, only_colour=number))) for number, name in plan.colours()]


def make_reported(design: Design, tessellation: Tessellation, job: Job) -> tuple[Product, list[dict[str, Any]]]:
    """One drawing of all that a job asks for, each colour on a layer, and what each takes of sheets where it is packed.

    The rows, in the types of JSON, have "colour", "pieces", "sheets" and "share". Raises what `make` does.
    """
    plan = _Plan.of(design, tessellation, job, load_preset(job.preset).first_format)
    job = plan.layout.job
    if job.split != "files":
        made = plan.product(job)
        first = (f"these are the figures of the first of {len(plan.sheets)} sheets",) if len(plan.sheets) > 1 else ()
        return replace(made, notes=made.notes + first), []
    rows = [
        {
            "colour": one.colour + 1,
            "pieces": sum(len(sheet.copies.tile) for sheet in one.sheets),
            "sheets": len(one.sheets),
            "share": one.share,
        }
        for one in (plan.woods() if job.pack else ())
    ]
    # What is laid out stays; a frame and a kerf go together only where tiles are packed.
    together = replace(job, colours=job.scheme, into=None, pack=False, stock=None, fit="whole", frame=None)
    return plan.product(together), rows


@dataclass(frozen=True, eq=False)
class _Plan:
    """What the drawings of a job share: the tiles on the page, in the curves that a format takes, and their colours."""

    form: Format
    preset: Preset
    curves: str
    layout: Layout
    sheets: tuple[Layout, ...]
    nesting: Nesting | None
    colouring: TileColouring
    said: tuple[str, ...]
    hints: tuple[str, ...]
    files: tuple[str, ...]

    @classmethod
    def of(
        cls,
        design: Design,
        tessellation: Tessellation,
        job: Job,
        form: Format,
        progress: Progress | None = None,
        lay: Callable[..., Arranged] = laid,
    ) -> _Plan:
        """Lay out the tiles, of a design or on a sheet that is found for a number of pieces."""
        preset = load_preset(job.preset)
        preset.require(form)
        job = as_demanded(job, preset)
        curves = file_curves(job, preset, form)
        if form == "gcode":
            preset.burns(["cut"], job.feed, job.power)  # before anything is computed for nothing
        sheets, said, nesting = lay(design, tessellation, job, curves, form, progress)
        layout = sheets[0]
        colours = colour_tiles(layout.tessellation, job.scheme, layout.period)
        said += tuple(unnested(job))
        if job.split is not None and job.colours != "none" and colours.count == 1:
            said += (f"by {job.scheme} all tiles are alike: there is one colour",)
        colouring, files = TileColouring(colours, layout.copies), tuple(files_read(design, job))
        return cls(form, preset, curves, layout, sheets, nesting, colouring, said, hints_of(layout, job), files)

    def on(self, sheet: Layout) -> _Plan:
        """The same for another sheet of its tiles."""
        return replace(self, layout=sheet, colouring=replace(self.colouring, copies=sheet.copies))

    def colours(self) -> list[tuple[int, str]]:
        """The colours that the page has pieces of, each with a name for its file; FRAME for the frame."""
        copies = np.arange(len(self.layout.copies.tile))
        found = np.unique(self.colouring.of_copies(copies)).tolist()
        if self.layout.job.fit == "frame" and self.layout.rest() is not None:
            found.append(FRAME)
        return [(number, "frame" if number == FRAME else str(number + 1)) for number in found]

    def woods(self, progress: Progress | None = None) -> list[PackedColour]:
        """The sheets of each colour."""
        if self.nesting is None:
            return pack_colours(self.layout, self.colouring)
        return nest_colours(self.layout, self.colouring, self.nesting, progress)

    def packed(self, job: Job, progress: Progress | None) -> list[tuple[str, Product]]:
        """The sheets that the colours are packed on, and the frame, each with a name for its file."""
        job = replace(job, only_colour=None)  # which the recipe of a frame has
        found = []
        for one in self.woods(progress):
            for number, layout in enumerate(one.sheets):
                product = self.on(layout).product(job if self.nesting is None else layout.job)
                if number == 0:
                    product = replace(product, notes=(one.said(), *product.notes))
                found.append((one.name(number), product))
        frames = [
            (name, self.product(replace(job, only_colour=FRAME))) for colour, name in self.colours() if colour < 0
        ]
        return found + frames

    def product(self, job: Job) -> Product:
        """Draw what a job asks for, which is that of the plan, or one of its colours."""
        layout, colouring, preset = self.layout, self.colouring, self.preset
        if job.cuts_pieces:
            contours = of_colour(layout.contours, colouring, job)
            cuts = (cut_shapes if self.solid else cut_pieces)(contours, colouring, job)
            pieces = inventory(layout, colouring, contours.copy, contours.area)
        else:
            cuts = cut_lines(layout, job)
            contours = None
            pieces = cut_free(layout, colouring)
        shown = np.ones(len(layout.copies.tile), np.bool_)
        if job.only_colour is not None:
            shown = np.asarray(colouring.of_copies(np.arange(len(shown))) == job.only_colour)
        fills = preset.fill_engraving and self.form != "gcode"  # whose lasers go along lines
        engraving = engrave(layout, contours, layout.sheet, shown, fills=fills)
        layers = _layers(preset, self.form, job, cuts, engraving, curve_converter(self.curves, job, layout.budget))
        drawing = _page(layers, layout, job)
        said = (*self.said, *layout.sheet.notes, *layout.tiles.compensation.losses, *engraving.notes)
        twice = doubled(layout, job) if preset.contours == "shared" else []  # the others do not cut
        more = (*without_effect(self.form, job), *twice, *untabbed(cuts, job))
        return Product(
            form=self.form,
            drawing=drawing,
            pieces=pieces,
            colours=colouring.count,
            scheme=None if job.colours == "none" else job.scheme,
            notes=tuple(dict.fromkeys((*said, *more))),
            curves=self.curves,
            accuracy=job.accuracy,
            files=self.files,
            dxf_version=job.dxf_version,
            spline_edges=preset.spline_edges,
            hints=self.hints,
            bounded=None if layout.sheet.outline is None else fsum(ring_areas(layout.sheet.outline).tolist()),
        )

    @property
    def solid(self) -> bool:
        """Whether pieces are filled shapes."""
        return self.preset.solid and self.form in {"svg", "pdf"}


def files_read(design: Design, job: Job | None) -> list[str]:
    """The files that a job is made from: the design's own and its art, the sheet's drawing, the preset, the places'."""
    asked = () if job is None else (job.sheet, job.preset, job.layout if job.layout not in LAYOUTS else None)
    return [*design.files, *(name for name in asked if isinstance(name, str))]


def _format(name: str) -> Format:
    """The format of drawings that has this name. Raises JobError where none has."""
    if name not in FORMATS:
        raise JobError(f"no drawing can be made as {name!r}", remedy=f"Use one of {', '.join(FORMATS)}.")
    return name


def _layers(
    preset: Preset, form: Format, job: Job, cuts: list[Cut], engraving: Works, convert: Callable[[Paths], Paths]
) -> list[Layer]:
    """The layers in the order of work: engraving, scores, cuts inside, cuts around."""
    stroke = preset.stroke_width(job.kerf) if job.stroke is None else job.stroke

    def layer(role: Role, work: Work, paths: Paths) -> Layer:
        """A layer as the preset calls and colours it."""
        plain = Layer.of_paths(preset.layer_name(role, form), work, preset.colours[role], stroke, paths)
        return replace(plain, burn=burns.get(role))

    burns: Mapping[Role, Burn] = {}
    if form == "gcode":
        roles: list[Role] = ["engrave"] if len(engraving.engraved) else []
        roles += ["score"] if len(engraving.scored) else []
        burns = preset.burns([*roles, *(cut.role for cut in cuts)], job.feed, job.power)
    layers = []
    if len(engraving.filled):
        filled = layer("engrave", "engrave", convert(engraving.filled))
        layers.append(replace(filled, items=engraving.items, filled=True))
    if len(engraving.engraved):
        layers.append(layer("engrave", "engrave", convert(toured(engraving.engraved))))
    if len(engraving.scored):
        layers.append(layer("score", "score", convert(toured(engraving.scored))))
    for cut in cuts:
        plain = layer(cut.role, "cut", convert(cut.paths))
        if cut.items is not None:
            plain = replace(plain, items=cut.items, filled=True)
        coloured = cut.colour is not None and cut.colour >= 0 and cut.role == "cut"
        colour = preset.cut_colour(cut.colour) if cut.colour is not None and coloured else plain.colour
        layers.append(replace(plain, name=plain.name + cut.suffix, colour=colour))
    return layers


def _page(layers: list[Layer], layout: Layout, job: Job) -> Drawing:
    """Put the layers on the page; without a sheet, on one that fits them."""
    sheet, design = layout.sheet, layout.design
    width, height = sheet.width, sheet.height
    if sheet.region is None:
        boxes = np.array([layer.paths.bounds for layer in layers if len(layer.paths)])
        low, high = boxes[:, :2].min(axis=0) - job.margin, boxes[:, 2:].max(axis=0) + job.margin
        width, height, corner = fitting_page(*low.tolist(), *high.tolist())
        layers = [replace(layer, paths=layer.paths.moved(1.0, -corner)) for layer in layers]
    recipe = {**design_recipe(design), "job": json.dumps(job.recipe(), sort_keys=True), **places_recipe(layout)}
    return Drawing(width, height, tuple(layers), f"{design.name} ({design.group.name})", recipe)
