"""DXF files as others read them: ezdxf, Inkscape's importer, LibreCAD."""

from __future__ import annotations

import io
import json
import re
import time
from collections import defaultdict
from itertools import pairwise
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
from ezdxf import options
from ezdxf.document import Drawing as Document
from ezdxf.path import make_path
from helpers import cad
from scipy.spatial import cKDTree

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.formats.dxf.writer import nearest_index, write_dxf
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.formats.presets import DxfCurves, DxfVersion
from voronoi_tiles.paths.biarcs import to_arcs
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths

KINDS: list[tuple[DxfCurves, int]] = [
    ("arc", ARC),
    ("arc", LINE),
    ("spline", QUAD),
    ("spline", CUBIC),
    ("spline", LINE),
    ("polyline", LINE),
]
TILES = ["p4-key", "p3-puzzle", "pg-elephant"]


def written(drawing: Drawing, curves: DxfCurves, **options: Any) -> bytes:
    """Write a drawing."""
    file = io.BytesIO()
    write_dxf(drawing, file, curves=curves, accuracy=0.01, **options)
    return file.getvalue()


def read(data: bytes) -> Document:
    """Read a file and audit it."""
    document = ezdxf.read(io.StringIO(data.decode("ascii")))
    auditor = document.audit()
    assert not auditor.errors
    assert not auditor.fixes
    return document


def flattened(entity: Any) -> Complexes:
    """Points of an entity, chords at most 1e-5 mm from it."""
    if entity.dxftype() not in {"LWPOLYLINE", "POLYLINE"}:
        return np.array([complex(v.x, v.y) for v in make_path(entity).flattening(1e-5)])
    # A path of ezdxf has cubic curves for arcs; the entities that a polyline explodes to are arcs.
    points = []
    bulges = [vertex.dxf.bulge if entity.dxftype() == "POLYLINE" else vertex[4] for vertex in entity]
    for bulge, part in zip(bulges, entity.virtual_entities(), strict=False):
        piece = [part.dxf.start, part.dxf.end] if part.dxftype() == "LINE" else list(part.flattening(1e-5))
        points += [complex(v.x, v.y) for v in (reversed(piece) if bulge < 0 else piece)]
    return np.array(points)


def by_layer(document: Document) -> dict[str, list[Complexes]]:
    """The curves of a document."""
    found = defaultdict(list)
    for entity in document.modelspace():
        found[entity.dxf.layer].append(flattened(entity))
    return found


def one_layer(paths: Paths) -> Drawing:
    """A drawing with one layer of cuts."""
    return Drawing(200.0, 200.0, (Layer.of_paths("cut", "cut", "#000000", 0.025, paths),))


def form(paths: Paths, curves: DxfCurves) -> Paths:
    """A tile in the pieces that a kind of curve takes."""
    if curves == "arc":
        return to_arcs(paths, accuracy=0.005)
    return cad.as_lines(paths) if curves == "polyline" else paths


@pytest.mark.parametrize(
    ("curves", "kind", "version"),
    [*((curves, kind, "R2000") for curves, kind in KINDS), ("arc", ARC, "R12"), ("polyline", LINE, "R12")],
)
def test_ezdxf_reads_the_same_curves(curves: DxfCurves, kind: int, version: DxfVersion) -> None:
    """Holes, open paths and many layers: same layers in the same order, curves to the rounding, nothing else."""
    drawing = cad.drawing(kind)
    document = read(written(drawing, curves, version=version))
    found = by_layer(document)
    assert list(found) == ["ENGRAVE", "SCORE", "CUT"]
    for layer in drawing.layers:
        ours = cad.sampled(layer.paths, 400)
        theirs = found[layer.name.upper()]
        assert len(theirs) == len(ours)
        for a, b in zip(ours, theirs, strict=True):
            assert cad.deviation([a], [b]) < 1e-4
            assert np.abs(b[[0, -1]] - a[[0, -1]]).max() < 2e-6


@pytest.mark.parametrize(("curves", "kind"), KINDS)
def test_closed_paths_have_the_flag(curves: DxfCurves, kind: int) -> None:
    """The first flag of polylines; open paths have it not, nor have splines, which end where they begin."""
    drawing = cad.drawing(kind)
    entities: list[Any] = list(read(written(drawing, curves)).modelspace())
    closed = np.concatenate([layer.paths.closed for layer in drawing.layers]).tolist()
    for entity, whole in zip(entities, closed, strict=True):
        if entity.dxftype() == "SPLINE":
            points = entity.control_points
            assert entity.dxf.flags == 8
            assert bool((points[0] == points[-1]).all()) == whole
        else:
            assert bool(entity.dxf.flags & 1) == whole


@pytest.mark.parametrize("closed", [True, False])
def test_the_numbers_are_those_of_the_paths(closed: bool) -> None:
    """Vertices and control points to half a nanometre, bulges to twelve digits, knots in Bezier form."""
    arcs, quads = cad.ring(ARC, closed=closed), cad.ring(QUAD, closed=closed)
    polyline: Any
    (polyline,) = read(written(one_layer(arcs), "arc")).modelspace().query("LWPOLYLINE")
    rows = np.array(polyline.get_points("xyb"))
    corners = arcs.start if closed else np.append(arcs.start, arcs.end[-1])
    assert np.abs(rows[:, 0] - corners.real).max() <= 0.51e-6
    assert np.abs(rows[:, 1] - corners.imag).max() <= 0.51e-6
    # The middle of an arc from its bulge: half a chord times the bulge to the right of its middle.
    chord = arcs.end - arcs.start
    middle = (arcs.start + arcs.end) / 2 - 0.5j * chord * rows[: len(chord), 2]
    assert np.abs(middle - arcs.control[:, 0]).max() < 1e-10

    spline: Any
    (spline,) = read(written(one_layer(quads), "spline")).modelspace().query("SPLINE")
    points = np.array([complex(x, y) for x, y, _ in spline.control_points])
    assert np.abs(points[:-1:3] - quads.start).max() <= 0.75e-6
    assert np.abs(points[1::3] - (quads.start + 2 * quads.control[:, 0]) / 3).max() <= 0.75e-6
    assert np.abs(points[2::3] - (quads.end + 2 * quads.control[:, 0]) / 3).max() <= 0.75e-6
    assert abs(points[-1] - quads.end[-1]) <= 0.75e-6
    count = len(quads.start)
    assert list(spline.knots) == sorted([0, count, *(3 * list(range(count + 1)))])
    assert spline.dxf.degree == 3


def test_each_edge_is_one_spline_or_line_where_it_is_asked_for() -> None:
    """In the order of the paths, each where the last one ends: OpenCASCADE misjudges what has corners inside."""
    paths = Paths.concatenate([cad.ring(QUAD), cad.ring(LINE, centre=60 + 20j), cad.ring(CUBIC, centre=90 + 20j)])
    entities: list[Any] = list(read(written(one_layer(paths), "spline", spline_edges=True)).modelspace())
    assert [entity.dxftype() for entity in entities] == ["SPLINE"] * 6 + ["LINE"] * 6 + ["SPLINE"] * 6
    assert {len(entity.control_points) for entity in entities if entity.dxftype() == "SPLINE"} == {4}
    found = [flattened(entity) for entity in entities]
    assert cad.deviation(found, cad.sampled(paths, 400)) < 1e-4
    for ring in (found[:6], found[6:12], found[12:]):
        assert [piece[-1] for piece in ring] == [piece[0] for piece in (*ring[1:], ring[0])]


def test_straight_paths_are_polylines_among_splines() -> None:
    """A path of lines needs no spline; the order of the paths stays."""
    paths = Paths.concatenate([cad.ring(QUAD), cad.ring(LINE, centre=60 + 20j), cad.ring(CUBIC, centre=90 + 20j)])
    kinds = [entity.dxftype() for entity in read(written(one_layer(paths), "spline")).modelspace()]
    assert kinds == ["SPLINE", "LWPOLYLINE", "SPLINE"]


@pytest.mark.parametrize(
    ("curves", "kind", "version", "number"),
    [
        ("arc", ARC, "R2000", "AC1015"),
        ("polyline", LINE, "R2000", "AC1015"),
        ("polyline", LINE, "R12", "AC1009"),
        ("arc", ARC, "R12", "AC1009"),
    ],
)
def test_unit_extents_and_layers(curves: DxfCurves, kind: int, version: DxfVersion, number: str) -> None:
    """Millimetres, the bounds of all paths, layers with colour and linetype that are in the tables.

    Inkscape asks for $MEASUREMENT alone, trimesh for $INSUNITS, in R12 as well, which knows neither.
    """
    drawing = cad.drawing(kind)
    data = written(drawing, curves, version=version)
    document = read(data)
    assert document.dxfversion == number
    header = data[: data.index(b"ENDSEC")]
    assert header.count(b"  9\n$INSUNITS\n 70\n4\n") == header.count(b"$INSUNITS") == 1
    assert header.count(b"  9\n$MEASUREMENT\n 70\n1\n") == header.count(b"$MEASUREMENT") == 1
    if version != "R12":
        assert document.header["$PSVPSCALE"] == 1
    boxes = [layer.paths.bounds for layer in drawing.layers]
    low, high = np.min(boxes, axis=0)[:2], np.max(boxes, axis=0)[2:]
    for name, corner in (("EXTMIN", low), ("LIMMIN", low), ("EXTMAX", high), ("LIMMAX", high)):
        assert document.header[f"${name}"][:2] == pytest.approx(corner, abs=1e-6)
    colours = {layer.dxf.name: layer.dxf.color for layer in document.layers}
    assert {name: colours[name] for name in ("CUT", "SCORE", "ENGRAVE")} == {"CUT": 7, "SCORE": 5, "ENGRAVE": 1}
    for layer in document.layers:
        assert layer.dxf.linetype in document.linetypes
    for entity in document.modelspace():
        assert entity.dxf.color == 256
        assert entity.dxf.linetype.upper() == "BYLAYER"


@pytest.mark.parametrize(("curves", "kind", "edges"), [("arc", ARC, False), ("spline", QUAD, True)])
def test_every_handle_is_one_and_below_the_seed(curves: DxfCurves, kind: int, edges: bool) -> None:
    """The header's seed is the next free handle."""
    data = written(cad.drawing(kind), curves, spline_edges=edges).decode()
    seed = re.search(r"\$HANDSEED\n  5\n(\w+)\n", data)
    assert seed
    # Group 5 names a handle, but for the variable in the header and the dimension styles, which use 105.
    body = data[data.index("TABLES") :]
    handles = [int(text, 16) for code, text in pairwise(body.split("\n")) if code == "  5"]
    assert len(handles) == len(set(handles))
    assert max(handles) < int(seed[1], 16)


@pytest.mark.parametrize(("curves", "kind"), KINDS)
def test_the_same_drawing_gives_the_same_bytes(
    curves: DxfCurves, kind: int, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """No dates and no random identifiers, whatever the day is; ezdxf's options are left alone, and it is silent."""
    first = written(cad.drawing(kind), curves)
    before = options.write_fixed_meta_data_for_testing
    now = time.time()
    monkeypatch.setattr("ezdxf.document.juliandate", lambda _: 2460000.5 + now)
    assert written(cad.drawing(kind), curves) == first
    assert options.write_fixed_meta_data_for_testing == before
    assert b"2460" not in first
    assert not re.search(rb"@ \d{4}-\d\d-\d\d", first)
    assert capfd.readouterr().err == ""


def test_numbers_have_no_exponents() -> None:
    """Tiny coordinates, nearly straight arcs, arcs of more than half a circle."""
    points = np.array([1e-7 + 5e-5j, 40 + 0j, 40 + 30j])
    end = np.roll(points, -1)
    bulges = np.array([1e-9, 3.7, -2e-4])
    control = np.stack(((points + end) / 2 - 0.5j * (end - points) * bulges, np.zeros(3)), axis=1)
    paths = Paths(points, end, control, np.full(3, ARC, np.uint8), np.array([0, 3]), np.array([True]))
    data = written(one_layer(paths), "arc").decode()
    entities = data[data.index("ENTITIES") : data.index("OBJECTS")]
    assert not re.search(r"\d[eE][+-]?\d", entities)
    assert not re.search(r"\n (?:10|20|42)\n-?\d+\n", entities)
    entity: Any
    (entity,) = read(data.encode()).modelspace()
    assert [row[2] for row in entity.get_points("xyb")] == pytest.approx(bulges, rel=1e-6, abs=1e-16)


def test_the_recipe_is_in_the_comments() -> None:
    """Long and odd recipes come back, whatever characters they hold."""
    drawing = cad.drawing(LINE)
    recipe = {"design": 'x\n0\nSECTION "ü"\U0001f426' * 100}
    data = written(Drawing(10.0, 10.0, drawing.layers, "t", recipe), "polyline").decode("ascii")
    assert max(map(len, data.split("\n"))) < 255
    parts = re.findall(r"^999\nrecipe (.*)\n", data, flags=re.MULTILINE)
    assert json.loads("".join(parts)) == {**recipe, "title": "t", "curves": "polyline", "accuracy_mm": 0.01}
    read(data.encode())


def test_any_name_gives_a_legal_layer() -> None:
    """Names are upper case, short and different where they were; those of one name are one layer."""
    names = ["cut", "CUT", "Ré/sumé: 1", "", "鳥", "0", "x" * 50, "X" * 60, "CUT"]
    layers = tuple(Layer.of_paths(name, "score", "#00ff00", 0.1, cad.ring(LINE)) for name in names)
    document = read(written(Drawing(9.0, 9.0, layers), "polyline", version="R12"))
    found = [entity.dxf.layer for entity in document.modelspace()]
    assert found == ["CUT", "CUT-2", "RE_SUME_1", "SCORE", "LAYER", "0-2", "X" * 31, "X" * 29 + "-2", "CUT-2"]


def test_a_drawing_without_paths_has_the_pages_extents() -> None:
    """Nothing to cut is a file all the same; paths without pieces are left out."""
    none = Paths.concatenate([Paths.empty(), cad.ring(ARC).take(np.array([], np.intp))])
    document = read(written(one_layer(none), "arc"))
    assert len(document.modelspace()) == 0
    assert document.header["$EXTMAX"][:2] == (200, 200)


@pytest.mark.parametrize(
    ("colour", "index"),
    [("#000000", 7), ("#ffffff", 7), ("#ff0000", 1), ("#0000ff", 5), ("#00ff00", 3), ("#808080", 8), ("#fd0202", 1)],
)
def test_colours_go_to_the_nearest_index(colour: str, index: int) -> None:
    """Black is 7, which is drawn black on white."""
    assert nearest_index(colour) == index


@pytest.mark.parametrize(
    ("curves", "kind", "named"), [("arc", QUAD, "QUAD"), ("spline", ARC, "ARC"), ("polyline", CUBIC, "CUBIC")]
)
def test_pieces_that_do_not_fit_are_refused(curves: DxfCurves, kind: int, named: str) -> None:
    """The kind is named, and nothing is written."""
    file = io.BytesIO()
    with pytest.raises(ValueError, match=f"has {named}"):
        write_dxf(cad.drawing(kind), file, curves=curves, accuracy=0.01)
    assert file.getvalue() == b""


def test_what_cannot_be_kept_is_refused() -> None:
    """An accuracy beyond the last decimal, a kind of curves that is none, coordinates that are none."""
    with pytest.raises(ValueError, match="finer"):
        write_dxf(cad.drawing(LINE), io.BytesIO(), curves="arc", accuracy=1e-7)
    with pytest.raises(ValueError, match="R12 has no splines"):
        written(cad.drawing(QUAD), "spline", version="R12")
    with pytest.raises(ValueError, match="one of arc, spline, polyline"):
        write_dxf(cad.drawing(LINE), io.BytesIO(), curves="bezier", accuracy=0.1)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="not a number"):
        written(one_layer(Paths.polylines([[0j, complex(np.nan, 1)]])), "arc")


@pytest.mark.parametrize("curves", ["arc", "spline", "polyline"])
@pytest.mark.parametrize("name", TILES)
def test_inkscape_reads_the_same_contours(curves: DxfCurves, name: str, tmp_path: Path) -> None:
    """Inkscape's importer: every contour, in its place and size, within a hundredth of a millimetre.

    Closed are those with a flag; a spline, which has none, ends where it begins.
    """
    tile = cad.tile(name)
    paths = form(tile, curves)
    file = tmp_path / "tile.dxf"
    file.write_bytes(written(one_layer(paths), curves))
    found = cad.inkscape_reads_dxf(file)
    assert set(found) == {"CUT"}
    assert [closed for _, closed in found["CUT"]] == [curves != "spline"] * len(paths)
    assert all(points[0] == points[-1] for points, _ in found["CUT"])
    exact = cad.sampled(paths if curves == "polyline" else tile)
    assert cad.deviation([points for points, _ in found["CUT"]], exact) < (0.01 if curves == "arc" else 2e-6)


def test_inkscape_keeps_layers_and_open_paths(tmp_path: Path) -> None:
    """What is open stays open; holes and layers are there."""
    drawing = cad.drawing(ARC)
    file = tmp_path / "many.dxf"
    file.write_bytes(written(drawing, "arc"))
    found = cad.inkscape_reads_dxf(file)
    for layer in drawing.layers:
        curves = found[layer.name.upper()]
        assert [closed for _, closed in curves] == layer.paths.closed.tolist()
        assert cad.deviation([points for points, _ in curves], cad.sampled(layer.paths)) < 0.01


@pytest.mark.parametrize("curves", ["arc", "spline", "polyline"])
@pytest.mark.parametrize("name", TILES)
def test_librecad_reads_the_same_contours(curves: DxfCurves, name: str, tmp_path: Path) -> None:
    """LibreCAD prints every contour in its place and size, within the accuracy and two of its dots.

    It prints splines as chords, up to a third of a millimetre off. Closed ones it would take for periodic ones,
    whatever their knots are, and round all corners: 2.8 and 0.85 mm off for the first two.
    """
    tile = cad.tile(name)
    paths = form(tile, curves)
    file = tmp_path / "tile.dxf"
    file.write_bytes(written(one_layer(paths), curves))
    found = cad.librecad_reads_dxf(file)
    allowed = 0.4 if curves == "spline" else 0.005 + 2 * 25.4 / 1200
    assert cad.deviation(found, cad.sampled(paths if curves == "polyline" else tile)) < allowed
    # Closed contours: every end of a printed line is the end of another one.
    ends = np.concatenate([points[[0, -1]] for points in found]).view(np.float64).reshape(-1, 2)
    _, others = cKDTree(ends).query(ends, 2)[0].T
    assert others.max() < 0.005


def test_the_comparison_sees_a_wrong_curve() -> None:
    """A tile that is moved by a fiftieth of a millimetre, and one with a bulge that is lost."""
    paths = cad.tile("p4-key")
    right = cad.sampled(paths)
    assert cad.deviation(cad.sampled(paths.moved(1, 0.02)), right) > 0.01
    assert cad.deviation(cad.sampled(cad.as_lines(paths)), right) > 0.1
    assert cad.deviation([*right, *cad.sampled(cad.ring(LINE))], right) > 1
