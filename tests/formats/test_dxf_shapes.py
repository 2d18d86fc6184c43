"""Shapes of others' DXF and SVG: what has no size, splines with breaks, clipped blocks."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import ezdxf
import numpy as np
import pytest
import shapely
from ezdxf.xclip import XClip
from helpers import sheets
from helpers.dxf_text import LINE, Tags, file_of, read, written
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from voronoi_tiles.formats.dxf.splines import fitted_cubics
from voronoi_tiles.formats.reading import DrawingError, ReadDrawing
from voronoi_tiles.formats.svg.reader import svg_drawing
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import CUBIC, Paths
from voronoi_tiles.preflight import judge

# --- dots -------------------------------------------------------------------------------------------------------


def dots_of(drawing: ReadDrawing) -> list[complex]:
    """All places of no length."""
    return [place for dots in drawing.dots for place in dots.places.tolist()]


@pytest.mark.parametrize(
    "draw",
    [
        lambda space, z: space.add_circle(z, 0),
        lambda space, z: space.add_arc(z, 0, 0, 90),
        lambda space, z: space.add_line(z, z),
        lambda space, z: space.add_lwpolyline([z]),
        lambda space, z: space.add_lwpolyline([(*z, 0, 0, 1), z, z], close=True),
        lambda space, z: space.add_polyline2d([z, z]),
        lambda space, z: space.add_polyline3d([z]),
        lambda space, z: space.add_open_spline([z] * 4),
    ],
)
def test_what_has_no_size_is_a_dot_and_the_rest_is_judged(draw: Any) -> None:
    """Circles of radius 0, lines of no length, polylines of one place: the place is named, in blocks too."""
    document = ezdxf.new("R2000", units=4)
    space = document.modelspace()
    draw(space, (20, 30))
    draw(document.blocks.new("B"), (1, 2))
    space.add_blockref("B", (50, 60))
    space.add_lwpolyline([(0, 0), (90, 0), (90, 90), (0, 90)], close=True)
    drawing = read(written(document))
    assert dots_of(drawing) == [20 + 30j, 51 + 62j]
    assert len(drawing.shapes) == 1
    report = judge(drawing, "t.dxf")
    assert [finding.place for finding in report.findings if finding.kind == "dot"] == [(20, 30), (51, 62)]
    assert report.passed


@pytest.mark.parametrize(
    "body",
    [
        "<path d='M30 20h0'/>",
        "<path d='M30 20z'/>",
        "<path d='M30 20l0 0'/>",
        "<path d='M10 10H20M30 20C30 20 30 20 30 20M5 5H9'/>",
        "<line x1='30' y1='20' x2='30' y2='20'/>",
        "<polyline points='30,20'/>",
        "<polyline points='30,20 30,20'/>",
        "<polygon points='30,20'/>",
        "<circle cx='30' cy='20' r='0'/>",
        "<ellipse cx='30' cy='20' rx='0' ry='0'/>",
        "<rect x='30' y='20' width='0' height='0'/>",
        "<g transform='translate(10 0) scale(2)'><path d='M10 10h0'/></g>",
    ],
)
def test_dots_of_svg_are_named_with_their_place(body: str) -> None:
    """As of DXF; on layers that are engraved they are left alone."""
    svg = "<svg xmlns='http://www.w3.org/2000/svg' xmlns:i='http://www.inkscape.org/namespaces/inkscape' "
    svg += "width='200mm' height='150mm' viewBox='0 0 200 150'><path d='M0 0H9' stroke='red'/>"
    svg += "<g stroke='red' {}>{}</g></svg>"
    drawing = svg_drawing(svg.format("", body).encode(), "t.svg")
    assert dots_of(drawing) == [30 + 130j]
    (finding,) = [finding for finding in judge(drawing, "t.svg").findings if finding.kind == "dot"]
    assert finding.place == pytest.approx((30, 20))
    assert "burns a point" in finding.message
    engraved = svg_drawing(svg.format("i:groupmode='layer' i:label='engrave'", body).encode(), "t.svg")
    assert dots_of(engraved) == [30 + 130j]
    assert "dot" not in {finding.kind for finding in judge(engraved, "t.svg").findings}


@pytest.mark.parametrize("data", ["M30 20", "M30 20H40zz", "M30 20H40zM5 5", "M30 20h0h5", "M30 20h5h0z"])
def test_what_is_only_moved_to_is_no_dot(data: str) -> None:
    """Browsers draw nothing there, and no machine stops."""
    svg = f"<svg xmlns='http://www.w3.org/2000/svg' width='9mm' height='9mm'><path d='{data}' stroke='red'/></svg>"
    assert dots_of(svg_drawing(svg.encode(), "t.svg")) == []


# --- splines ----------------------------------------------------------------------------------------------------


@st.composite
def splines(draw: Any) -> tuple[int, list[float], list[complex], list[float] | None]:
    """A spline with knots of any multiplicity up to one more than its degree, clamped or not, rational or not."""
    degree = draw(st.integers(1, 5))
    inner = draw(st.lists(st.integers(1, degree + 1), max_size=4))
    clamped = draw(st.booleans())
    knots: list[float] = [0.0] * (degree + 1) if clamped else [float(k - degree) for k in range(degree + 1)]
    for place, count in enumerate(inner, start=1):
        knots += [float(place)] * count
    last = float(len(inner) + 1)
    knots += [last] * (degree + 1) if clamped else [last + k for k in range(degree + 1)]
    count = len(knots) - degree - 1
    part = st.integers(-40, 40)
    points = [complex(draw(part), draw(part)) for _ in range(count)]
    weights = None
    if draw(st.booleans()):
        weights = draw(st.lists(st.sampled_from([0.5, 1.0, 2.0, 3.0]), min_size=count, max_size=count))
    return degree, knots, points, weights


@settings(max_examples=25, deadline=None)
@given(splines())
def test_splines_with_breaks_are_scipys(spline: tuple[int, list[float], list[complex], list[float] | None]) -> None:
    """As many curves as there are jumps and one, each where scipy has it, from the limit on the right to the left."""
    degree, knots, points, weights = spline
    tags: Tags = [(0, "SPLINE"), (100, "AcDbEntity"), (8, "0"), (100, "AcDbSpline"), (70, 0), (71, degree)]
    tags += [(40, knot) for knot in knots] + [(41, weight) for weight in weights or ()]
    tags += [tag for p in points for tag in ((10, p.real), (20, p.imag))]
    drawing = read(file_of(tags))
    heavy = np.array(points) * (weights or 1.0)
    top, below = BSpline(knots, heavy, degree), BSpline(knots, np.array(weights or [1.0] * len(points)), degree)
    starts = sorted({*knots[degree : len(points) + 1]})
    eps = 1e-9
    jumps = [
        k
        for k in starts[1:-1]
        if abs(top(k) / below(k) - top(k - eps) / below(k - eps)) > 1e-3 and knots.count(k) > degree
    ]
    runs = [starts[0], *jumps, starts[-1]]
    curves = [paths for shape in drawing.shapes for paths in (shape.paths,)]
    found = [lines for paths in curves for lines in sheets.flattened(with_arcs(paths), 1e-4)]
    expected = []
    for low, high in pairwise(runs):
        t = np.unique(np.concatenate([np.linspace(low, high - eps, 400), np.nextafter(starts, -9), starts]))
        t = t[(t >= low) & (t <= high - eps)]
        curve = top(t) / below(t)
        if np.abs(curve - curve[0]).max() > 1e-6:
            expected.append(curve)
    assert len(found) == len(expected)
    for ours, theirs in zip(found, expected, strict=True):
        one, two = (shapely.LineString(np.column_stack((z.real, z.imag))) for z in (ours, theirs))
        assert abs(ours[0] - theirs[0]) < 1e-3
        assert shapely.distance(shapely.Point(theirs[-1].real, theirs[-1].imag), one) < 1e-3
        assert shapely.hausdorff_distance(one, two) < 0.35
        assert max(shapely.distance(shapely.points(theirs.real, theirs.imag), one)) < 2e-3


def with_arcs(paths: Paths) -> Paths:
    """The same, cubic curves as chords of themselves, for helpers that have no cubics."""
    if not (paths.kind == CUBIC).any():
        return paths
    return to_lines(paths, accuracy=1e-4)


# --- clipped blocks ---------------------------------------------------------------------------------------------


@st.composite
def polygons(draw: Any) -> list[tuple[float, float]]:
    """Star-shaped polygons, or two corners of an upright rectangle."""
    if draw(st.booleans()):
        low, high = st.integers(-300, -1), st.integers(1, 300)
        # No side on a line that is drawn: what rounding makes of that is shapely's affair.
        return [(draw(part) / 10 + 0.0123, draw(part) / 10 + 0.0321) for part in (low, high)]
    radii = draw(st.lists(st.floats(5, 30), min_size=3, max_size=9))
    turn = draw(st.floats(0, 6))
    corners = [r * np.exp(1j * (turn + 2 * np.pi * k / len(radii))) for k, r in enumerate(radii)]
    return [(float(z.real), float(z.imag)) for z in corners]


def block_content(target: Any) -> None:
    """Draw curves of every kind."""
    target.add_line((-40, 1), (40, 3))
    target.add_circle((2, 1), 14)
    target.add_arc((-5, 3), 12, 300, 100)
    target.add_ellipse((0, 0), (22, 4), 0.4)
    target.add_lwpolyline([(-12, -9, 0, 0, 0.7), (13, -9), (13, 11, 0, 0, -0.3), (-12, 11)], close=True)
    target.add_open_spline([(-30, 0), (-10, 30), (0, -30), (10, 30), (30, 0)], degree=3)
    target.add_open_spline([(-30, 5), (0, -30), (30, 5)], degree=2)
    target.add_lwpolyline([(-2, -2), (2, -2), (2, 2), (-2, 2)], close=True)


@settings(max_examples=6, deadline=None)
@given(polygons(), st.sampled_from([1.0, -1.0, 2.0]), st.floats(0, 360), st.booleans())
def test_clipped_blocks_are_shapelys_intersection(
    corners: list[tuple[float, float]], scale: float, turn: float, nested: bool
) -> None:
    """What is drawn is what lies in the polygon, in blocks that are turned, mirrored and nested too."""
    drawings = []
    for clip in (False, True):
        document = ezdxf.new("R2000", units=4)
        block_content(document.blocks.new("B"))
        space: Any = document.blocks.new("OUTER") if nested else document.modelspace()
        insert = space.add_blockref("B", (3, 4), dxfattribs={"rotation": turn, "xscale": scale})
        if nested:
            document.modelspace().add_blockref("OUTER", (-1, 2), dxfattribs={"rotation": 15})
        if clip:
            XClip(insert).set_block_clipping_path(corners)
        drawings.append(read(written(document)))
    whole, clipped = drawings
    block = shapely.box(*corners[0], *corners[1]) if len(corners) == 2 else shapely.Polygon(corners)
    z = shapely.get_coordinates(block.exterior)
    points = (scale * z[:, 0] + 1j * z[:, 1]) * np.exp(1j * np.radians(turn)) + 3 + 4j
    points = points * np.exp(1j * np.radians(15)) - 1 + 2j if nested else points
    area = shapely.Polygon(np.column_stack((points.real, points.imag)))
    wanted = shapely.intersection(lines_of(whole), area)
    assert lines_of(clipped).length == pytest.approx(wanted.length, abs=0.02)
    if not wanted.is_empty:
        assert shapely.hausdorff_distance(lines_of(clipped), wanted) < 0.6
        assert lines_of(clipped).difference(area.buffer(2e-3)).is_empty
    assert any("XCLIP" in remark for remark in clipped.remarks)


def lines_of(drawing: ReadDrawing) -> Any:
    """All curves of a drawing as shapely's lines."""
    lines: list[Sequence[complex]] = []
    for shape in drawing.shapes:
        for k, points in enumerate(sheets.flattened(with_arcs(shape.paths), 1e-4)):
            lines.append([*points, points[0]] if shape.paths.closed[k] else list(points))
    return shapely.MultiLineString([np.column_stack((np.real(z), np.imag(z))) for z in lines])


def test_clips_that_are_not_read_are_named() -> None:
    """Clips in rows, and those that are turned off draw all."""
    for off in (False, True):
        document = ezdxf.new("R2000", units=4)
        block_content(document.blocks.new("B"))
        rows = {} if off else {"row_count": 2, "row_spacing": 90}
        insert = document.modelspace().add_blockref("B", (0, 0), dxfattribs=rows)
        XClip(insert).set_block_clipping_path([(0, 0), (5, 5)])
        if off:
            XClip(insert).disable_clipping()
        drawing = read(written(document))
        assert drawing.ignored == ({} if off else {"XCLIP of an INSERT in rows": 1})
        assert len(drawing.shapes) == (8 if off else 16)


def test_many_spans_are_fitted_as_few_are() -> None:
    """Rational spans that take more and less halvings: the cubics are those of some spans after the others."""
    random = np.random.default_rng(1)
    size = np.exp(random.uniform(-8.0, 8.0, (1_100, 1)))
    weights = np.exp(random.normal(size=(1_100, 4))).astype(np.complex128)
    points = (random.normal(size=(1_100, 4)) + 1j * random.normal(size=(1_100, 4))) * size * weights
    together = fitted_cubics(points, weights, 1e-3)
    few = [fitted_cubics(points[k : k + 11], weights[k : k + 11], 1e-3) for k in range(0, 1_100, 11)]
    one = fitted_cubics(points[-1:], weights[-1:], 1e-3)
    assert len(set(map(len, few))) > 5
    assert (np.concatenate(few) == together).all()
    assert (one == together[-len(one) :]).all()


def test_spans_that_no_cubics_follow_end() -> None:
    """A great many jumps, and numbers that are none: one DrawingError, and not two to the fourteenth parts of each."""
    points = np.tile(np.array([0, 1e12, -1e12j, 1], np.complex128), (50_000, 1))
    for spans in (points, np.full((50_000, 4), np.nan + 0j)):
        with pytest.raises(DrawingError, match="cannot be followed"):
            fitted_cubics(spans, np.tile([1, 1e-9, 1e9, 1], (50_000, 1)).astype(np.complex128), 1e-7)


@pytest.mark.parametrize(
    ("knots", "weights"),
    [([-1e308] * 4 + [1e308] * 4, [1] * 4), ([0] * 4 + [1] * 4, [1e308, 1, 1, 1]), ([0] * 4 + [1] * 4, [1e400] * 4)],
)
def test_splines_beyond_all_bounds_are_none(knots: list[float], weights: list[float]) -> None:
    """They are counted, as others that cannot be, and the line beside them is read."""
    tags: Tags = [(0, "SPLINE"), (8, "0"), (70, 8), (71, 3), *((40, knot) for knot in knots)]
    tags += [(41, weight) for weight in weights] + [(code, 9.0 * k**2) for k in range(4) for code in (10, 20)]
    drawing = read(file_of(tags, LINE))
    assert len(drawing.shapes) == 1
    assert any("SPLINE" in name for name in drawing.ignored)
