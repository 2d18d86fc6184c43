"""Drawings written as files, and in the names and colours of a preset."""

from __future__ import annotations

from dataclasses import replace
from io import RawIOBase
from typing import BinaryIO, cast, get_args

from voronoi_tiles.formats.burns import Role
from voronoi_tiles.formats.cubics import CUBIC_ACCURACY_MM
from voronoi_tiles.formats.page import Drawing
from voronoi_tiles.formats.presets import FORMATS, USUAL_DXF, DxfCurves, DxfStyle, Format, load_preset
from voronoi_tiles.paths.conversion import to_cubics
from voronoi_tiles.paths.paths import ARC


def write_drawing(
    drawing: Drawing,
    file: BinaryIO | RawIOBase,
    form: str,
    *,
    accuracy: float,
    curves: str = "arc",
    dxf: DxfStyle = USUAL_DXF,
) -> None:
    """Write a drawing as one of FORMATS; DXF with these curves, in a style. Raises ValueError for another format."""
    # Writers only write, portions of bytes.
    out = cast("BinaryIO", file)
    match form:
        case "svg":
            from voronoi_tiles.formats.svg.writer import write_svg

            write_svg(without_arcs(drawing), out)
        case "dxf":
            from voronoi_tiles.formats.dxf.writer import write_dxf

            assert curves in get_args(DxfCurves)
            write_dxf(drawing, out, curves=cast("DxfCurves", curves), accuracy=accuracy, **dxf._asdict())
        case "pdf":
            from voronoi_tiles.formats.pdf import write_pdf

            write_pdf(drawing, out)
        case "lbrn2":
            from voronoi_tiles.formats.lbrn2 import write_lbrn2

            write_lbrn2(drawing, out)
        case "gcode":
            from voronoi_tiles.formats.gcode.writer import write_gcode

            write_gcode(drawing, out)
        case _:
            raise ValueError(f"no drawing can be written as {form!r}: use one of {', '.join(FORMATS)}")


def recoloured(
    drawing: Drawing, preset_name: str, form: Format, feed: str | None = None, power: str | None = None
) -> Drawing:
    """A drawing whose layers "engrave", "inside" and "cut" have the names and colours of a preset.

    In G-code they are burnt with `feed` and `power`, texts that `rates_of` reads, or as the preset says. Raises
    DesignError where the preset is broken or does not read the format, ArgumentError where neither says how to burn.
    """
    preset = load_preset(preset_name)
    preset.require(form)
    roles: dict[str, Role] = {"engrave": "engrave", "inside": "inner", "cut": "cut"}
    used = [roles[layer.name] for layer in drawing.layers]
    burns = preset.burns(used, feed, power) if form == "gcode" else {}
    layers = []
    for layer in drawing.layers:
        role = roles[layer.name]
        name, burn = preset.layer_name(role, form), burns.get(role)
        layers.append(replace(layer, name=name, colour=preset.colours[role], stroke=preset.stroke_width(), burn=burn))
    return replace(drawing, layers=tuple(layers))


def without_arcs(drawing: Drawing) -> Drawing:
    """The same drawing with cubic curves in the place of circular arcs."""
    layers = [
        replace(layer, paths=to_cubics(layer.paths, accuracy=CUBIC_ACCURACY_MM))
        if (layer.paths.kind == ARC).any()
        else layer
        for layer in drawing.layers
    ]
    return replace(drawing, layers=tuple(layers))
