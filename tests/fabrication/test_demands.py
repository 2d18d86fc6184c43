"""What presets of programs demand of a job: contours that are closed, or apart, and curves that are read right."""

from __future__ import annotations

import io
import re
from itertools import combinations
from typing import Any

import ezdxf
import pytest
import shapely
import svgelements
from helpers.cutting import rings, squares

import voronoi_tiles as vt
from voronoi_tiles.fabrication.product import Product
from voronoi_tiles.formats.presets import load_preset, preset_names
from voronoi_tiles.paths.conversion import to_lines

SHEET = (90.0, 60.0)
SQUARES, RINGS = squares(), rings()
APART = [name for name in preset_names() if load_preset(name).contours == "apart"]
CLOSED = [name for name in preset_names() if load_preset(name).contours != "shared"]


def text_of(product: Product) -> str:
    """The file of a product."""
    file = io.BytesIO()
    product.write(file)
    return file.getvalue().decode()


def made(tiling: vt.Tiling, preset: str, **job: Any) -> Product:
    """What a job makes for a preset, in the first format that it reads."""
    return tiling.make(vt.Job(preset=preset, **job), load_preset(preset).first_format)


@pytest.mark.parametrize("name", CLOSED)
def test_contours_are_closed_and_apart_where_a_program_unites_what_touches(name: str) -> None:
    """Every tile of a sheet, or one of each, is a contour of its own; a millimetre, or the gap, lies between them."""
    for job, gap in (
        ({"sheet": SHEET}, 1.0),
        ({"sheet": SHEET, "gap": 0.4}, 0.4),
        ({"sheet": SHEET, "kerf": 0.1}, 1.0),
    ):
        (layer,) = made(SQUARES, name, **job).drawing.layers
        assert layer.paths.closed.all()
        lines = to_lines(layer.paths, accuracy=0.001)
        shapes = [shapely.Polygon([(z.real, z.imag) for z in lines.part(k, k + 1).start]) for k in range(len(lines))]
        nearest = min(a.distance(b) for a, b in combinations(shapes, 2))
        if name in APART:
            assert gap - 1e-6 < nearest < gap + 0.02
        elif len(job) == 1:
            assert nearest == 0.0


def test_pieces_of_other_presets_touch() -> None:
    """The last test would see it."""
    drawing = SQUARES.make(vt.Job(sheet=SHEET)).drawing
    assert not drawing.layers[0].paths.closed.all()


@pytest.mark.parametrize(
    ("name", "job", "message"),
    [
        ("blender", {"edges": "once"}, "`edges='once'` cuts lines that are open. Leave `edges` out"),
        ("freecad", {"tabs": 0.5, "gap": 1.0}, "`tabs` leave them open. Leave `tabs` out"),
        ("openscad", {"gap": 0.0}, "with `gap=0` they do. Use `gap='0.5mm'`"),
        ("trimesh", {"fit": "frame"}, "with `fit='frame'` they do. Use `fit='whole'`"),
    ],
)
def test_what_leaves_contours_open_or_together_is_refused(name: str, job: dict[str, Any], message: str) -> None:
    """One message, which names the option and what to do."""
    with pytest.raises(vt.JobError, match=re.escape(message)):
        made(SQUARES, name, sheet=SHEET, **job)


@pytest.mark.parametrize(
    ("name", "form", "job", "message"),
    [
        ("openscad", "dxf", {"curves": "spline"}, "openscad does not read `curves='spline'` of dxf files right. Leave"),
        ("openscad", "dxf", {"curves": "exact"}, "openscad does not read `curves='spline'` of dxf"),
        ("openscad", "dxf", {"dxf_version": "R12"}, "openscad does not read `dxf_version='R12'` right. Leave"),
        ("jscad", "dxf", {"curves": "arc"}, "jscad does not read `curves='arc'`"),
        ("blender", "svg", {"curves": "exact"}, "blender does not read `curves='exact'` of svg"),
        ("plain", "dxf", {"dxf_version": "R12", "curves": "spline"}, "R12 has no splines. Use `curves='arc'` or"),
    ],
)
def test_what_a_program_gets_wrong_is_refused(name: str, form: str, job: dict[str, Any], message: str) -> None:
    """Curves that it bends, flattens or drops, and R12; what it reads right is written."""
    with pytest.raises(vt.JobError, match=re.escape(message)):
        SQUARES.make(vt.Job(preset=name, **job), form)
    assert SQUARES.make(vt.Job(preset=name), form).drawing.layers


@pytest.mark.parametrize("name", ["blender", "openscad", "build123d"])
def test_filled_shapes_have_their_holes(name: str) -> None:
    """A piece is one path that is filled, not stroked; its hole runs against its outline: any rule leaves it empty."""
    tiling = RINGS
    document = svgelements.SVG.parse(io.StringIO(text_of(made(tiling, name))), ppi=25.4)
    paths = [element for element in document.elements() if isinstance(element, svgelements.Path)]
    areas = []
    for path in paths:
        assert (path.values["fill"], path.values["stroke"]) == ("#000000", "none")
        parts = [
            shapely.LinearRing([tuple(piece.point(k / 64)) for piece in list(part)[1:] for k in range(64)])
            for part in path.as_subpaths()
        ]
        assert [ring.is_ccw for ring in parts] == [parts[0].is_ccw, *[not parts[0].is_ccw] * (len(parts) - 1)]
        areas.append(shapely.Polygon(parts[0], parts[1:]).area)
    assert areas == pytest.approx([tile.area for tile in tiling], rel=1e-3)
    assert sorted(len(list(path.as_subpaths())) for path in paths) == [1, 2]


@pytest.mark.parametrize("name", ["cadquery", "openscad", "trimesh", "jscad"])
def test_holes_are_on_the_layer_of_their_pieces(name: str) -> None:
    """CadQuery makes faces of each layer for itself; the layer has the colour of cuts. Others have holes on INNER."""
    for preset, layers in ((name, {"CUT"}), ("plain", {"CUT", "INNER"})):
        document = ezdxf.read(io.StringIO(text_of(RINGS.make(vt.Job(preset=preset), "dxf"))))
        assert len(document.modelspace()) == 3
        assert {entity.dxf.layer for entity in document.modelspace()} == layers
        assert document.layers.get("CUT").dxf.color == 7


def test_meerk40t_cuts_what_is_red() -> None:
    """Holes, pieces, and pieces of all colours; nothing else is red, and nothing black, which it rasters."""
    coloured: dict[str, Any] = {"colours": "layers", "sheet": SHEET, "labels": "number", "label_height": 1.0}
    for job in ({}, coloured):
        layers = RINGS.make(vt.Job(preset="meerk40t", **job)).drawing.layers
        assert {layer.colour for layer in layers if layer.work == "cut"} == {"#ff0000"}
        assert not {layer.colour for layer in layers if layer.work != "cut"} & {"#ff0000", "#000000"}
        assert len(layers) > 1


@pytest.mark.parametrize("name", ["freecad", "cadquery"])
def test_splines_are_edges_for_opencascade(name: str) -> None:
    """One entity for each, where splines are asked for."""
    document = ezdxf.read(io.StringIO(text_of(RINGS.make(vt.Job(preset=name, curves="spline", gap=1.0), "dxf"))))
    assert len(document.modelspace()) == sum(len(tile.outline.start) for tile in RINGS)
    assert {entity.dxftype() for entity in document.modelspace()} == {"LINE", "SPLINE"}


def test_reports_need_no_format() -> None:
    """A preset that does not read SVG has a report all the same."""
    assert RINGS.report(vt.Job(preset="cadquery"))["curves"] == "arc"
