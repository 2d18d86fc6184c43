"""Designs made in Python: what goes in, what is refused and by which name, and that a file says the same."""

from __future__ import annotations

import copy
import json
import math
import pickle
from collections.abc import Callable, Mapping
from dataclasses import FrozenInstanceError
from pathlib import Path as FilePath
from typing import Any, get_args

import numpy as np
import pytest
import shapely
import svgpathtools
from helpers import strategies
from hypothesis import given, settings
from hypothesis import strategies as st

import voronoi_tiles as vt
from voronoi_tiles.designs import schema
from voronoi_tiles.designs.drawn_strokes import StrokeKind
from voronoi_tiles.designs.starters import GROUP_NAMES, starter_text

ROOT = FilePath(__file__).parents[2]
EXAMPLES = sorted(path for path in ROOT.glob("examples/**/*.toml") if path.parent.name != "sweeps")


def places(points: Any) -> list[complex]:
    """Points of a file as complex numbers."""
    return [complex(x, y) for x, y in points]


def drawn(table: Mapping[str, Any]) -> vt.Stroke:  # noqa: PLR0911 - one for each kind
    """A stroke of a file, made by the function of its name."""
    keys: dict[str, Any] = {
        name: value for name, value in table.items() if name in ("scale", "rotate", "closed", "alpha")
    }
    if "translate" in table:
        keys["translate"] = complex(*table["translate"])
    match table:
        case {"point": place}:
            return vt.point(complex(*place), **keys)
        case {"segment": ends}:
            return vt.segment(*places(ends), **keys)
        case {"polyline": points}:
            return vt.polyline(places(points), **keys)
        case {"bezier": points}:
            return vt.bezier(np.array(places(points)), **keys)
        case {"hermite": points, "tangents": tangents}:
            return vt.hermite(places(points), np.array(tangents, float), **keys)
        case {"catmull_rom": points}:
            return vt.catmull_rom(np.array(points, float), **keys)
        case {"bspline": points}:
            return vt.bspline([tuple(point) for point in points], **keys)
        case {"circle": centre, "radius": radius}:
            return vt.circle(np.complex128(complex(*centre)), radius, **keys)
        case {"path": data}:
            return vt.path(data, **keys)
    raise AssertionError(table)


def made(table: Mapping[str, Any]) -> vt.Design:
    """A design of a file, made in Python."""
    sites = []
    for site in table["site"]:
        art = site.get("art")
        if isinstance(art, Mapping):
            art = vt.Art(**art)
        strokes = [drawn(stroke) for stroke in site["strokes"]]
        sites.append(vt.Site(strokes, name=site.get("name"), tolerance=site.get("tolerance"), art=art))
    solid = None
    if "solid" in table:
        keys = [
            vt.Key(key["z"], list(map(drawn, key["strokes"])), site=key.get("site")) for key in table.get("key", ())
        ]
        solid = vt.Solid(**table["solid"], keys=keys)
    return vt.Design(table["group"], table["cell"], sites, units=table.get("units", "mm"), solid=solid)


def same_bits(one: vt.Design, other: vt.Design) -> bool:
    """Whether the geometry of two designs is the same to the bit."""
    return (one.lattice, one.units, len(one.noded)) == (other.lattice, other.units, len(other.noded)) and all(
        a.name == b.name and a.nodes.tobytes() == b.nodes.tobytes() and a.segments.tolist() == b.segments.tolist()
        for a, b in zip(one.noded, other.noded, strict=True)
    )


def texts() -> dict[str, str]:
    """All examples and starters."""
    files = {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in EXAMPLES}
    return files | {f"starter {group}": starter_text(group) for group in GROUP_NAMES}


@pytest.mark.parametrize("text", texts().values(), ids=texts().keys())
def test_python_and_a_file_say_the_same(text: str) -> None:
    """Every example, made in Python of complex numbers and arrays, is the design of its file; so is its TOML."""
    read = vt.Design.loads(text)
    assert len(read.source) > 50
    for other in (made(json.loads(read.source)), vt.Design.loads(read.to_toml()), vt.Design.from_dict(read.to_dict())):
        assert other == read
        assert hash(other) == hash(read)
        assert same_bits(other, read)


@settings(max_examples=80, deadline=None)
@given(design=strategies.designs(), units=st.sampled_from(["mm", "cm", "in"]))
def test_toml_gives_the_design_back(design: dict[str, Any], units: str) -> None:
    """Any design, written as TOML and read, is equal to the bit, and so is one made in Python."""
    read = vt.Design.from_dict({**design, "units": units})
    for other in (vt.Design.loads(read.to_toml()), made(json.loads(read.source))):
        assert other == read
        assert same_bits(other, read)
    assert vt.Design.loads(read.to_toml()).to_toml() == read.to_toml()


def test_the_tiles_are_the_same_to_the_bit() -> None:
    """From the file, from its TOML, from Python: one outline document."""
    read = vt.Design.load(ROOT / "examples" / "p6m-flower.toml")
    documents = {
        design.tessellate().json()
        for design in (read, vt.Design.loads(read.to_toml()), made(json.loads(read.source)), copy.deepcopy(read))
    }
    assert len(documents) == 1


def bird(*strokes: Any, **site: Any) -> vt.Design:
    """A design of one site."""
    return vt.Design("p4", 60, vt.Site(strokes or [vt.segment(5 + 3j, 25 + 11j)], **{"name": "bird", **site}))


def test_the_recipe_is_that_of_a_file() -> None:
    """What a design made in Python writes into its files is what a file of it would."""
    design = bird(vt.circle((5, 3), 2, rotate=30), vt.catmull_rom([6 + 9j, 22 + 5j, 27 + 17j], closed=True))
    assert design.source == vt.Design.loads(design.to_toml()).source
    assert design.source in design.tessellate().svg().replace("&quot;", '"')
    assert design.to_toml() == (
        'schema = 1\ngroup = "p4"\nunits = "mm"\n\n[cell]\na = 60\n\n[[site]]\nname = "bird"\nstrokes = [\n'
        "  { circle = [5, 3], radius = 2, rotate = 30 },\n"
        "  { catmull_rom = [[6, 9], [22, 5], [27, 17]], closed = true },\n]\n"
    )


# --- points ---------------------------------------------------------------------------------------------------------

POINTS = [(5.0, 3.0), (9.0, 9.5), (25.0, 11.0)]


@pytest.mark.parametrize(
    "points",
    [
        [5 + 3j, 9 + 9.5j, 25 + 11j],
        POINTS,
        [list(point) for point in POINTS],
        [5 + 3j, (9, 9.5), np.array([25, 11])],
        np.array([5 + 3j, 9 + 9.5j, 25 + 11j]),
        np.array(POINTS),
        np.array(POINTS, np.float32),
        [shapely.Point(x, y) for x, y in POINTS],
        shapely.LineString(POINTS),
        {"type": "LineString", "coordinates": POINTS},
        (complex(x, y) for x, y in POINTS),
    ],
    ids=[
        "complex",
        "pairs",
        "lists",
        "mixed",
        "complex array",
        "rows",
        "float32",
        "Points",
        "LineString",
        "GeoJSON",
        "generator",
    ],
)
def test_points_in_every_form(points: Any) -> None:
    """Whatever holds points, the stroke is the same."""
    if isinstance(points, dict):
        points = type("Line", (), {"__geo_interface__": points})()
    assert vt.polyline(points) == vt.polyline(POINTS)


@pytest.mark.parametrize(
    "place",
    [5 + 3j, (5, 3), [5, 3], np.array([5, 3]), np.complex128(5 + 3j), np.complex64(5 + 3j), shapely.Point(5, 3)],
    ids=repr,
)
def test_one_point_in_every_form(place: Any) -> None:
    """Where one point goes in, also as the shift of a placement."""
    assert vt.point(place) == vt.point(5 + 3j)
    assert vt.segment(place, 0) == vt.segment(5 + 3j, 0j)
    assert vt.circle(0, 2, translate=place) == vt.circle(0, 2, translate=(5, 3))


RING = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0)]
HOLE = [(2.0, 0.5), (3.0, 0.5), (3.0, 1.5)]


@pytest.mark.parametrize(
    ("geometry", "lines"),
    [
        (shapely.MultiLineString([POINTS, RING]), [(POINTS, False), (RING, False)]),
        (shapely.LinearRing(RING), [(RING, True)]),
        (shapely.Polygon(RING), [(RING, True)]),
        (shapely.Polygon(RING, [HOLE]), [(RING, True), (HOLE, True)]),
        (shapely.MultiPolygon([(RING, [HOLE]), (np.array(RING) + 9, [])]), [(RING, True), (HOLE, True), (None, True)]),
        (
            shapely.GeometryCollection([shapely.LineString(POINTS), shapely.Polygon(RING)]),
            [(POINTS, False), (RING, True)],
        ),
    ],
    ids=lambda value: getattr(value, "geom_type", ""),
)
@pytest.mark.parametrize("draw", [vt.polyline, vt.catmull_rom], ids=lambda draw: draw.__name__)
def test_a_geometry_is_a_stroke_for_each_line(
    geometry: Any, lines: list[tuple[list[tuple[float, float]] | None, bool]], draw: Callable[..., vt.Stroke]
) -> None:
    """Lines are open, rings closed without their first point once more, each a stroke of its own in a site."""
    parts = vt.Site([draw(geometry, rotate=30)]).strokes
    assert len(parts) == len(lines)
    for part, (points, closed) in zip(parts, lines, strict=True):
        if points is not None:
            assert part == draw(points, closed=closed, rotate=30)
    assert all(not part.parts[1:] for part in parts)
    if draw is vt.polyline:
        assert vt.Site(geometry).strokes == vt.Site([draw(geometry)]).strokes


class Geometry:
    """What another library may hand over."""

    def __init__(self, geometry: Any) -> None:
        self.__geo_interface__ = geometry


def test_rings_and_coordinates_as_others_have_them() -> None:
    """A ring that leaves its last point out keeps all of them; coordinates may be arrays."""
    square = [(0, 0), (9, 0), (9, 9), (0, 9)]
    closed = vt.polyline(square, closed=True)
    for ring in (square, [*square, square[0]], np.array([*square, square[0]], float)):
        assert vt.polyline(Geometry({"type": "Polygon", "coordinates": [ring]})) == closed


@pytest.mark.parametrize(
    "geometry",
    [
        None,
        [],
        {"type": "Polygon"},
        {"type": "Polygon", "coordinates": None},
        {"type": "LineString", "coordinates": 5},
        {"type": "Feature"},
        {"type": "GeometryCollection", "geometries": 5},
        {"type": "Blob", "coordinates": []},
    ],
)
def test_broken_geometries_are_refused(geometry: Any) -> None:
    """With an error of ours, whatever they lack."""
    with pytest.raises(vt.DesignError, match="geometry"):
        vt.polyline(Geometry(geometry))


def test_a_geometry_within_itself_is_refused() -> None:
    """However deep."""
    endless: dict[str, Any] = {"type": "GeometryCollection"}
    endless["geometries"] = [endless]
    with pytest.raises(vt.DesignError, match="geometry"):
        vt.Site([Geometry(endless)])


def test_a_ring_can_be_left_open_and_a_line_closed() -> None:
    """`closed` overrules the geometry."""
    assert vt.bspline(shapely.LinearRing(RING), closed=False) == vt.bspline(RING)
    assert vt.bspline(shapely.LineString(RING), closed=True) == vt.bspline(RING, closed=True)
    assert dict(vt.bezier(shapely.LinearRing(RING)).keys)["bezier"] == (*RING, RING[0])


def test_points_of_a_geometry_are_points() -> None:
    """Of one or of several."""
    several = shapely.MultiPoint(POINTS)
    assert vt.Site([several]).strokes == tuple(vt.point(place) for place in POINTS)
    assert vt.Site([vt.point(several, scale=2)]).strokes == tuple(vt.point(place, scale=2) for place in POINTS)
    assert vt.Site([shapely.Point(5, 3)]).strokes == (vt.point((5, 3)),)


def test_paths_of_svgpathtools() -> None:
    """A path is its data, curve by curve: Bezier curves and lines are exact."""
    data = "M 5 3 C 6 9 12 9 14 3 Q 20 0 25 11 L 25 13 A 6 4 30 0 1 20 16"
    parsed = svgpathtools.parse_path(data)
    plain, other = bird(vt.path(data)), bird(vt.path(parsed))
    assert bird(parsed) == other
    assert plain.noded[0].nodes.tobytes() == other.noded[0].nodes.tobytes()


# --- what is refused ------------------------------------------------------------------------------------------------


def one(*strokes: Any, **site: Any) -> Callable[[], object]:
    """A design of one site."""
    return lambda: bird(*strokes, **site)


@pytest.mark.parametrize(
    ("make", "key", "message"),
    [
        (lambda: vt.Design("p5", 60, [vt.Site([vt.point(1j)])]), "group", "unknown wallpaper group 'p5'"),
        (lambda: vt.Design(4, 60, [vt.Site([vt.point(1j)])]), "group", "unknown wallpaper group 4"),  # type: ignore[arg-type]
        (lambda: vt.Design("p4", "60", [vt.Site([vt.point(1j)])]), "cell", "must be a side"),  # type: ignore[arg-type]
        (lambda: vt.Design("p4", (), [vt.Site([vt.point(1j)])]), "cell", "must be a side"),
        (lambda: vt.Design("p4", (1, 2, 3, 4), [vt.Site([vt.point(1j)])]), "cell", "must be a side"),
        (lambda: vt.Design("p4", {"c": 2}, [vt.Site([vt.point(1j)])]), "cell", "unknown key 'c'"),
        (lambda: vt.Design("p4", -60, [vt.Site([vt.point(1j)])]), "cell.a", "greater than 0"),
        (lambda: vt.Design("p4", (60, 50), [vt.Site([vt.point(1j)])]), "cell.b", "b is as long as a"),
        (lambda: vt.Design("p2", 60, [vt.Site([vt.point(1j)])]), "cell.b", "missing"),
        (lambda: vt.Design("p2", (60, 50), [vt.Site([vt.point(1j)])]), "cell.angle", "missing"),
        (lambda: vt.Design("p4", True, [vt.Site([vt.point(1j)])]), "cell.a", "not true"),
        (lambda: vt.Design("p4", 60, []), "sites", "there is no site"),
        (lambda: vt.Design("p4", 60, 5), "sites", "must be Site objects"),  # type: ignore[arg-type]
        (lambda: vt.Design("p4", 60, [vt.segment(0, 1)]), "sites[0]", "must be a Site"),  # type: ignore[list-item]
        (lambda: vt.Design("p4", 60, vt.Site([])), "sites[0].strokes", "there is no stroke"),
        (lambda: vt.Design("p4", 60, vt.Site([vt.point(1j)]), units="furlong"), "units", "furlong"),  # type: ignore[arg-type]
        (lambda: vt.Design("p4", 60, vt.Site([vt.point(1j)]), name=5), "name", "5 is no name"),  # type: ignore[arg-type]
        (lambda: vt.Design("p4", 60, [vt.Site([vt.point(1j)], name="a")] * 2), "sites[1].name", "already the name"),
        (one(vt.point(1j), name="a\nb"), "sites[0].name", "is no name"),
        (one(vt.point(1j), tolerance=0), "sites[0].tolerance", "greater than 0"),
        (one(vt.point(1j), art=5), "sites[0].art.file", "must be a file's name"),
        (one(vt.point(1j), art=vt.Art("a.svg", scale=0)), "sites[0].art.scale", "must not be 0"),
        (one(vt.point("x")), "sites[0].strokes[0].place", "must be an array, not 'x'"),  # type: ignore[arg-type]
        (one(vt.point(True)), "sites[0].strokes[0].place", "must be an array, not true"),
        (one(vt.point((1, 2, 3))), "sites[0].strokes[0].place", "2 coordinates, not 3"),
        (one(vt.point(shapely.Point(1, 2, 3))), "sites[0].strokes[0].place", "2 coordinates, not 3"),
        (one(vt.segment(1, 1)), "sites[0].strokes[0].end", "zero length"),
        (one(vt.segment(math.inf, 1)), "sites[0].strokes[0].start[0]", "finite number, not inf"),
        (one(vt.segment(shapely.LineString(POINTS), 1)), "sites[0].strokes[0].start", "must be an array"),
        (one(vt.point(1j), vt.polyline([1, 2j, 2j])), "sites[0].strokes[1].points[2]", "zero length"),
        (one(vt.polyline([1, "x"])), "sites[0].strokes[0].points[1]", "must be an array, not 'x'"),  # type: ignore[list-item]
        (one(vt.polyline(np.array([1.0, 2.0]))), "sites[0].strokes[0].points[0]", "must be an array, not 1.0"),
        (one(vt.polyline(np.array([[1.0, 2, 3]] * 2))), "sites[0].strokes[0].points[0]", "not 3"),
        (one(vt.polyline(5)), "sites[0].strokes[0].points", "must be an array, not 5"),  # type: ignore[arg-type]
        (one(vt.polyline([0, 1], closed=True)), "sites[0].strokes[0].points", "at least 3 points"),
        (one(vt.polyline([0, 1, 1j], closed=1)), "sites[0].strokes[0].closed", "true or false, not 1"),  # type: ignore[arg-type]
        (one(vt.bezier([0, 1, 2j])), "sites[0].strokes[0].points", "4, 7, 10"),
        (one(vt.hermite([0, 1], [1])), "sites[0].strokes[0].tangents", "2 points but 1"),
        (one(vt.catmull_rom([0, 1, math.nan])), "sites[0].strokes[0].points[2][0]", "finite number, not nan"),
        (one(vt.catmull_rom([0, 1], alpha=2)), "sites[0].strokes[0].alpha", "from 0 to 1"),
        (one(vt.bspline([0, 1])), "sites[0].strokes[0].points", "at least 4"),
        (one(vt.circle("x", 2)), "sites[0].strokes[0].centre", "must be an array"),  # type: ignore[arg-type]
        (one(vt.circle(0, -2)), "sites[0].strokes[0].radius", "greater than 0"),
        (one(vt.path("M 1 1 L 2")), "sites[0].strokes[0].data", "character 10"),
        (one(vt.path(5)), "sites[0].strokes[0].data", "must be a text"),  # type: ignore[arg-type]
        (one(vt.point(1j, scale=0)), "sites[0].strokes[0].scale", "must not be 0"),
        (one(vt.point(1j, rotate="x")), "sites[0].strokes[0].rotate", "must be a number"),  # type: ignore[arg-type]
        (one(vt.point(1j, translate="x")), "sites[0].strokes[0].translate", "must be an array"),  # type: ignore[arg-type]
        (one(vt.point(9e11, scale=9)), "sites[0].strokes[0]", "reaches beyond"),
        (one(vt.segment(0, 7000)), "sites[0]", "times larger than the cell"),
        (lambda: vt.Site(5), "strokes", "must be a sequence of strokes"),  # type: ignore[arg-type]
        (lambda: vt.Site([vt.point(0), 5]), "strokes[1]", "must be a stroke or a geometry"),  # type: ignore[list-item]
        (lambda: vt.Site([vt.point(0), shapely.Point()]), "strokes[1]", "the geometry is empty"),
        (lambda: vt.polyline(shapely.MultiLineString()), None, "the geometry is empty"),
        (lambda: bird().scaled(0), "factor", "greater than 0"),
        (one(vt.point(1j, mirror=1)), "sites[0].strokes[0].mirror", "true or false, not 1"),  # type: ignore[arg-type]
        (one(vt.point(1j), scale=0), "sites[0].scale", "must not be 0"),
        (one(vt.point(1j), mirror="x"), "sites[0].mirror", "true or false"),
        (one(vt.drawing("no.svg")), "sites[0].strokes[0].file", "no.svg: cannot be read"),
        (one(vt.drawing(5)), "sites[0].strokes[0].file", "must be a file's name"),  # type: ignore[arg-type]
        (one(vt.drawing("a.svg", layer="")), "sites[0].strokes[0].layer", "is empty"),
        (lambda: vt.Design("p4", 60, vt.Site([vt.point(1j)]), scale=0), "scale", "greater than 0"),
        (lambda: vt.Site([vt.point(1j, rotate="x")]).moved(), "strokes[0].rotate", "must be a number"),  # type: ignore[arg-type]
    ],
)
def test_what_is_refused_is_named_as_the_argument(make: Callable[[], object], key: str | None, message: str) -> None:
    """One DesignError, with the name of the argument, and a remedy."""
    with pytest.raises(vt.DesignError) as caught:
        make()
    assert caught.value.key == key
    assert message in str(caught.value)
    assert caught.value.remedy
    assert "[[" not in str(caught.value).replace("[[x, y]", "")


# --- what is made of a design ---------------------------------------------------------------------------------------


def test_designs_cannot_be_changed() -> None:
    """Their parts are frozen; pickling and copying keep them."""
    design = bird()
    with pytest.raises(FrozenInstanceError):
        design.units = "cm"  # type: ignore[misc]
    with pytest.raises(FrozenInstanceError):
        design.sites[0].name = "cat"  # type: ignore[misc]
    for other in (pickle.loads(pickle.dumps(design)), copy.deepcopy(design)):  # noqa: S301 - our own bytes
        assert other == design
        assert {other, design} == {design}
        assert other.tessellate().json() == design.tessellate().json()


def test_equality_is_by_content() -> None:
    """Names and folders are no content, and defaults are the same written or not; all else counts."""
    design = bird(vt.polyline(POINTS))
    assert design == design.replace(name="cat", folder="/tmp")  # noqa: S108 - a name only
    assert design == bird(vt.polyline(POINTS, closed=False, scale=1, rotate=0.0, translate=(0, 0)))
    assert design != "bird"
    others = [
        design.replace(cell=61),
        design.replace(group="p4g"),
        design.replace(units="cm"),
        bird(vt.polyline(POINTS), tolerance=0.02),
        bird(vt.polyline(POINTS[::-1])),
        bird(vt.polyline(POINTS, closed=True)),
        bird(vt.polyline(POINTS, rotate=1)),
        design.replace(sites=vt.Site([vt.polyline(POINTS)], name="cat")),
    ]
    assert len({design, *others}) == 1 + len(others)


def test_replace_checks_again() -> None:
    """What does not fit together is refused; what is left out stays."""
    design = bird()
    assert design.replace(cell={"a": 30.0}).cell == {"a": 30}
    assert design.replace(group="p2", cell=(60, 50, 75)).cell == {"a": 60, "b": 50, "angle": 75}
    assert design.replace(group=vt.GROUPS["p6"]).group is vt.GROUPS["p6"]
    assert design.replace(name="cat").name == "cat"
    assert design.replace(name="cat").source == design.source
    with pytest.raises(vt.DesignError, match=r"cell\.b: is missing"):
        design.replace(group="pg")


@settings(max_examples=100, deadline=None)
@given(
    design=strategies.designs(),
    mirror=st.booleans(),
    scale=st.sampled_from([1.0, 0.5, -1.0, 0.8]),
    rotate=st.sampled_from([0.0, 90.0, 30.0, -17.0]),
    shift=st.sampled_from([0j, 1 - 2j]),
)
def test_moved_is_the_image_of_the_strokes(
    design: dict[str, Any], mirror: bool, scale: float, rotate: float, shift: complex
) -> None:
    """Every control point goes where the map takes it, whatever placements the strokes have already."""
    turn = scale * np.exp(1j * math.radians(rotate))
    for site in vt.Design.from_dict(design).sites:
        strokes = [stroke for stroke in site.strokes if stroke.kind != "circle"]
        moved = vt.Site(strokes).moved(mirror=mirror, scale=scale, rotate=rotate, translate=shift)
        for before, after in zip(strokes, moved.strokes, strict=True):
            z, image = (schema.stroke(stroke.table, 1.0)[0] for stroke in (before, after))
            expected = turn * (-z.conj() if mirror else z) + shift
            assert np.abs(image - expected).max() <= 1e-13 * max(1.0, np.abs(z).max())


def test_circles_and_paths_move_with_the_rest() -> None:
    """The centre and the radius of a circle, the points of a path."""
    design = bird(vt.circle(5 + 3j, 2), vt.path("M 9 9 L 12 14"))
    moved = design.moved(scale=0.5, rotate=90, translate=1)
    assert moved.sites[0].strokes[0] == vt.circle(5 + 3j, 2, scale=0.5, rotate=90, translate=(1, 0))
    assert abs(moved.noded[0].nodes - (1 + 0.5j * (12 + 14j))).min() < 1e-14
    assert abs(abs(moved.noded[0].nodes - (1 + 0.5j * (5 + 3j))) - 1.0).min() < 1e-14
    assert moved.moved(translate=-1).moved(rotate=-90).moved(scale=2).noded[0].nodes.tolist() == pytest.approx(
        design.noded[0].nodes.tolist()
    )
    flipped = bird(vt.circle(5 + 3j, 2, translate=2j, rotate=30), art="face.svg").moved(mirror=True)
    assert flipped.sites[0].strokes[0] == vt.circle(5 + 3j, 2, mirror=True, translate=2j, rotate=-30)
    assert flipped.sites[0].art == vt.Art("face.svg", mirror=True)
    assert flipped.moved(mirror=True) == bird(vt.circle(5 + 3j, 2, translate=2j, rotate=30), art="face.svg")


def test_scaled_scales_the_tiles() -> None:
    """Twice the size is four times the area, in the same file."""
    design = vt.Design("p1", (30, 20, 75), [vt.Site([vt.segment(5 + 3j, 15 + 7j)], art="face.svg")])
    twice = design.scaled(2)
    assert twice.cell == {"a": 60, "b": 40, "angle": 75}
    assert twice.tessellate().tiles[0].area == pytest.approx(4 * design.tessellate().tiles[0].area, rel=1e-14)
    assert twice.sites[0].art == vt.Art("face.svg", scale=2)
    assert twice.scaled(0.5) == design


@pytest.mark.parametrize("factor", [np.int8(5), np.uint8(10), np.float16(1.1), np.float32(1.1), np.int64(3), 7])
def test_scaled_takes_all_numbers_alike(factor: Any) -> None:
    """Cell and strokes grow by the same, without the overflow of small integers."""
    design = bird(vt.segment(5 + 3j, 25 + 11j))
    big = design.scaled(factor)
    assert big.cell["a"] == 60 * float(factor)
    assert big.sites[0].strokes[0].table["scale"] == float(factor)


def test_art_moves_with_its_strokes() -> None:
    """Its placement is that of the strokes."""
    design = bird(art=vt.Art("face.svg", rotate=30, translate=(1, 2)))
    (site,) = design.moved(rotate=60, translate=3j).sites
    assert site.art is not None
    assert site.art.placement.rotate == 90
    assert site.art.placement.translate == pytest.approx((1 + 2j) * np.exp(1j * math.pi / 3) + 3j)


def test_save_writes_a_design_file(tmp_path: FilePath) -> None:
    """It is read as an equal design, whose art is found from its new place."""
    drawings, designs = tmp_path / "drawings", tmp_path / "designs"
    drawings.mkdir()
    designs.mkdir()
    design = bird(art="face.svg").replace(folder=drawings)
    design.save(designs / "bird.toml")
    read = vt.Design.load(designs / "bird.toml")
    assert read.name == "bird"
    assert read.replace(sites=vt.Site(read.sites[0].strokes, name="bird", art="face.svg")) == design
    art = read.sites[0].art
    assert art is not None
    assert (designs / art.file).resolve() == (drawings / "face.svg").resolve()
    design.save(drawings / "bird.toml")
    assert vt.Design.load(drawings / "bird.toml") == design
    with pytest.raises(vt.OutputError):
        design.save(tmp_path / "none" / "bird.toml")


def test_json_is_saved_as_json(tmp_path: FilePath) -> None:
    """By the suffix, and text is read as what it is."""
    design = bird(vt.segment(5 + 3j, 25 + 11j), vt.path("M 1 1 L 5 2"))
    design.save(tmp_path / "a.json")
    assert json.loads((tmp_path / "a.json").read_text())["group"] == "p4"
    assert vt.Design.load(tmp_path / "a.json") == design
    assert vt.Design.loads(design.source) == vt.Design.loads(design.to_toml()) == design


def test_art_is_found_through_links_of_folders(tmp_path: FilePath) -> None:
    """A design saved through one names its drawing as seen from where it lies."""
    (tmp_path / "far" / "away").mkdir(parents=True)
    (tmp_path / "link").symlink_to(tmp_path / "far" / "away")
    (tmp_path / "face.svg").touch()
    site = vt.Site([vt.segment(5 + 3j, 25 + 11j)], art="face.svg")
    vt.Design("p4", 60, site, folder=tmp_path).save(tmp_path / "link" / "a.toml")
    read = vt.Design.load(tmp_path / "link" / "a.toml")
    assert FilePath(read.files[1]).resolve() == tmp_path / "face.svg"
    assert read.files[0] == read.file == str(tmp_path / "link" / "a.toml")


@pytest.mark.parametrize("name", ['a"b\\c.svg', "\t\x7f\x01.svg", "\U0001f426.svg", "ä.svg"])
def test_any_text_is_written_as_toml_takes_it(name: str) -> None:
    """Quotes, control characters and all of Unicode; what UTF-8 has not is refused."""
    design = bird(art=name)
    assert vt.Design.loads(design.to_toml()) == design
    with pytest.raises(vt.DesignError, match="no text that a file can hold"):
        bird(art="\udc80.svg").to_toml()


def test_long_strokes_are_wrapped() -> None:
    """No line of a design file is longer than a screen, but for path data."""
    rng = np.random.default_rng(1)
    design = bird(vt.catmull_rom(rng.normal(size=(200, 2)) * 3 + [15, 9], closed=True, rotate=5), tolerance=1.0)
    assert max(map(len, design.to_toml().splitlines())) <= 115
    assert vt.Design.loads(design.to_toml()) == design


def test_the_kinds_of_strokes_are_those_of_files() -> None:
    """Each has a function of its name, in the order of the reader's table."""
    assert get_args(StrokeKind) == tuple(schema._KINDS)
    assert all(callable(getattr(vt, "drawing" if kind == "file" else kind)) for kind in get_args(StrokeKind))


def test_reprs_are_short() -> None:
    """One line each, with what tells one from another."""
    design = bird(vt.catmull_rom(POINTS), vt.polyline(shapely.Polygon(RING, [HOLE])), vt.point(0.5j))
    assert repr(design) == "<Design 'design': p4, 1 site (bird)>"
    assert repr(design.sites[0]) == "<Site 'bird': 4 strokes>"
    assert repr(design.sites[0].strokes) == (
        "(<Stroke catmull_rom: 3 points>, <Stroke polyline: 3 points>, <Stroke polyline: 3 points>, <Stroke point>)"
    )
    assert repr(vt.polyline(shapely.Polygon(RING, [HOLE]))) == "<Stroke polyline: 3 points, and 1 more>"
    assert repr(vt.polyline(5)) == "<Stroke polyline>"  # type: ignore[arg-type]


def test_a_notebook_shows_the_design() -> None:
    """The cell, the strokes and their copies."""
    picture = bird(vt.segment(5 + 3j, 25 + 11j), vt.point(9 + 20j))._repr_svg_()
    assert picture.startswith("<?xml")
    assert picture.count("<path") == 3
    assert picture.count("M ") > 3 * 4
