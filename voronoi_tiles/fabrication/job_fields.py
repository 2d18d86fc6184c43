"""The options of a job, with what each means. All lengths are millimetres."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Literal

from voronoi_tiles.fabrication.job_limits import (
    ACCURACY_MIN,
    ACCURACY_MM,
    LABEL_MIN,
    STROKE_MIN,
)
from voronoi_tiles.fabrication.job_options import (
    EFFORT_S,
    SHEET_MIN,
    Choice,
    Flag,
    Length,
    Offset,
    Option,
    OptionTable,
    Quantities,
    Rates,
    SheetSize,
    choice,
    flag,
    length,
    rates,
    read_angle,
    read_colour,
    read_colours,
    read_count,
    read_effort,
    read_layout,
    read_offset,
    read_quantities,
    read_seed,
    read_sheet,
    read_size,
    read_text,
)
from voronoi_tiles.formats.presets import DxfVersion

Fit = Literal["whole", "clip", "frame"]
Edges = Literal["once", "pieces"]
Curves = Literal["exact", "arc", "cubic", "spline", "polyline"]
ArtUse = Literal["whole", "clip", "none"]
Labels = Literal["none", "number", "site"]
Into = Literal["layers", "files"]


@dataclass(frozen=True, kw_only=True, repr=False)
class JobFields(OptionTable):
    """The options of a job, each checked by itself."""

    sheet: Option[SheetSize, tuple[float, float] | str | None] = Option(
        None,
        read_sheet,
        "Fill a sheet, 600x300mm, or what the paths of an SVG or DXF file bound [default: one of each tile].",
        kind="text",
        shown="WxH|FILE",
    )
    margin: Length = length(0.0, "What stays free inside the sheet's edge; without a sheet, around the tiles.")
    fit: Choice[Fit] = choice(
        "whole",
        Fit,
        "Whole tiles only, tiles clipped at the edge, or whole tiles and the frame around them [default: whole].",
    )
    frame: Option[float | str | None, float | None] = length(
        None,
        "The least width of the frame; means `fit='frame'` [default: 2mm].",
        least=SHEET_MIN,
        shown="WIDTH",
    )
    pieces: Option[int | str | None, int | None] = Option(
        None,
        read_count,
        "So many whole tiles at least: the design is scaled to the largest at which the sheet holds them, or without a "
        "sheet the smallest one is found [default: as many as fit].",
        kind="number",
        shown="N",
    )
    rotate: Option[float, float] = Option(
        0.0, read_angle, "Turn the tiles counter-clockwise.", kind="angle", shown="DEGREES"
    )
    offset: Option[Offset, complex | None] = Option(
        None,
        read_offset,
        "Move the design's origin from the middle of the sheet [default: to where most whole tiles fit, in its "
        "middle, or not at all with `fit='clip'`].",
        kind="text",
        shown="X,Y",
    )
    edges: Choice[Edges | None] = choice(
        None,
        Edges,
        "Cut every shared edge once, or every tile as a closed piece [default: once on a sheet, unless an option needs "
        "pieces].",
    )
    gap: Option[float | str | None, float | None] = length(None, "Pull pieces apart until they keep this distance.")
    layout: Option[str | os.PathLike[str], str] = Option(
        "tessellated",
        read_layout,
        "Where pieces lie: as in the tessellation, nested anew on the sheet, nested in a second or so where that holds "
        "more, or as in a file of ours [default: tessellated].",
        kind="text",
        shown="tessellated|nested|auto|FILE",
    )
    grain: Flag = flag("Turn nested pieces against the picture by half a turn or not at all: the wood's grain stays.")
    effort: Option[float | str, float] = Option(
        EFFORT_S, read_effort, "How long a search for places takes [default: 30].", kind="number", shown="SECONDS"
    )
    seed: Option[int | str, int] = Option(0, read_seed, "Where that search begins.", kind="number", shown="N")
    count: Option[Quantities, int | tuple[tuple[str, int], ...] | None] = Option(
        None,
        read_quantities,
        "Nest so many pieces of each site, bird=40,moth=12, or of every one [default: as many as fit].",
        kind="text",
        shown="N|SITE=N,...",
    )
    sheets: Option[int | str | None, int | None] = Option(
        None,
        read_count,
        "Lay them on as many sheets as they take, and on so many at most, a file each [default: 1].",
        kind="number",
        shown="N",
    )
    kerf: Length = length(
        0.0, "The width of the cut: contours keep half of it from the pieces, which then have their true size."
    )
    fillet: Length = length(0.0, "Round the corners of pieces.", shown="RADIUS")
    tabs: Length = length(0.0, "Leave bridges of this width, two a piece or more.")
    accuracy: Length = length(
        ACCURACY_MM,
        "How far approximated curves may be from the exact ones [default: 0.005mm].",
        least=ACCURACY_MIN,
        most=1.0,
    )
    curves: Choice[Curves | None] = choice(
        None,
        Curves,
        "Exact curves, the fewest circular arcs or cubic curves, splines, or chords [default: as the preset says].",
    )
    dxf_version: Choice[DxfVersion] = choice(
        "R2000",
        DxfVersion,
        "The version of DXF files; R12 is for the oldest readers, and has arcs or chords, no splines [default: R2000].",
    )
    preset: Option[str | os.PathLike[str], str] = Option(
        "plain",
        read_text,
        "Colours, layers and curves for a target: plain, lightburn, redcut, ponoko, boxes, glowforge, cnc, meerk40t, "
        "inkscape, blender, openscad, freecad, cadquery, build123d, jscad, trimesh, or a .toml file [default: plain].",
        kind="text",
        shown="NAME|FILE",
    )
    stroke: Option[float | str | None, float | None] = length(
        None,
        "The width of lines in SVG and PDF files, 0.3mm to see them on a screen; cutters may want the preset's "
        "[default: as the preset says].",
        least=STROKE_MIN,
        most=10.0,
        shown="WIDTH",
    )
    feed: Option[Rates, str | None] = rates(
        "For G-code, how fast the laser moves: millimetres a minute for cuts, or for each kind of work, "
        "cut=300,engrave=3000 [default: as the preset says].",
        shown="MM/MIN",
    )
    power: Option[Rates, str | None] = rates(
        "For G-code, how strong the laser is: the value of S for cuts, or for each kind of work, cut=800,engrave=150 "
        "[default: as the preset says].",
        shown="S",
    )
    labels: Choice[Labels] = choice("none", Labels, "Engrave a label on every piece.")
    label_height: Length = length(3.0, "The height of labels, at most [default: 3mm].", least=LABEL_MIN, most=1000.0)
    marks: Flag = flag("Engrave marks for aligning at the sheet's corners.")
    bar: Flag = flag("Engrave a bar of 100 mm, to measure the scale by.")
    colours: Option[str | int, str | int] = Option(
        "none",
        read_colours,
        "Colour the tiles, a wood each: by N colours or the fewest, so that no neighbours are alike; by site, "
        "handedness or orientation. `colours='layers'` and `colours='files'` are the fewest there.",
        kind="text",
        shown="N|fewest|site|handedness|orientation",
    )
    into: Choice[Into | None] = choice(
        None, Into, "Put each colour on a layer, or in a file, of its own [default: layers]."
    )
    pack: Flag = flag(
        "Lay the tiles of each colour side by side on sheets of their own, a file each; they are turned as in the "
        "picture that fills the sheet."
    )
    stock: Option[SheetSize, tuple[float, float] | None] = Option(
        None, read_size, "The size of the sheets for packing [default: that of the sheet].", kind="text", shown="WxH"
    )
    only_colour: Option[int | None, int | None] = Option(
        None, read_colour, "Leave out all colours but this, from 0; -1 all but a frame.", kind="number"
    )
    art: Choice[ArtUse] = choice(
        "whole", ArtUse, "The art of the design's sites: whole, clipped to the tiles, or left out [default: whole]."
    )

    def __post_init__(self) -> None:
        self._refuse_contradictions()

    def _refuse_contradictions(self) -> None:
        """Refuse options that cannot be together: none as far as fields go."""
