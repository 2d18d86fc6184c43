"""Reading others' SVG and DXF: the same geometry as other readers see, and nothing hostile gets through."""

from __future__ import annotations

import gzip
import io
import math
import random
import time
from pathlib import Path
from typing import Any

import ezdxf
import ezdxf.path
import numpy as np
import pytest
import shapely
import svgelements
from ezdxf.entities import Insert
from helpers.dxf_text import read, written
from helpers.svg_text import NS, PAGE, svg

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.units import parse_length, parse_size
from voronoi_tiles.formats.dxf.loading import entity_count
from voronoi_tiles.formats.dxf.reader import dxf_drawing
from voronoi_tiles.formats.reading import DrawingError, ReadDrawing, read_drawing
from voronoi_tiles.formats.svg.reader import svg_drawing
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths


def dxf(draw: Any, version: str = "R2000", units: int = 4) -> ReadDrawing:
    """Read what a function draws with ezdxf."""
    document = ezdxf.new(version)
    document.header["$INSUNITS"] = units
    draw(document, document.modelspace())
    return read(written(document))


def sampled(paths: Paths, count: int = 64) -> shapely.MultiLineString:
    """Points of every piece, by the definitions of the curves alone."""
    t = np.linspace(0.0, 1.0, count)
    lines = []
    for p, q, (c, d), kind in zip(paths.start, paths.end, paths.control, paths.kind, strict=True):
        match int(kind):
            case kind if kind == LINE:
                points = p + t * (q - p)
            case kind if kind == QUAD:
                points = (1 - t) ** 2 * p + 2 * t * (1 - t) * c + t**2 * q
            case kind if kind == CUBIC:
                points = (1 - t) ** 3 * p + 3 * t * (1 - t) ** 2 * c + 3 * t**2 * (1 - t) * d + t**3 * q
            case _:
                # The circle through three points, then the angle from p over c to q.
                w = (q - p) / (c - p)
                centre = p + (c - p) * (w - abs(w) ** 2) / (2j * w.imag)
                turn = np.angle((c - centre) / (p - centre)) * 2
                points = centre + (p - centre) * np.exp(1j * turn * t)
        lines.append(np.stack((points.real, points.imag), axis=1))
    return shapely.MultiLineString(lines)


ELEMENTS = [
    "<path d='M5 5L30 5 30 20H10V12z'/>",
    "<path d='m5 5l30 5-30 20h10v-12zm30 0q5 5 10 0t10 0 10 0'/>",
    "<path d='M5 5C10 0 20 20 30 5S40 9 45 5c1 1 2 2 3 0s3 3 4 1'/>",
    "<path d='M10 20A8 8 0 0116 20 8 5 30 1 0 30 25a3 3 0 1 1 1 1zl5 5'/>",
    "<path d='M1.5.5-.5.25e1'/>",
    "<rect x='5' y='6' width='20' height='10'/>",
    "<rect x='5' y='6' width='20' height='10' rx='3'/>",
    "<rect x='5' y='6' width='20' height='10' rx='2' ry='5'/>",
    "<circle cx='20' cy='15' r='7'/>",
    "<ellipse cx='20' cy='15' rx='9' ry='4'/>",
    "<line x1='3' y1='4' x2='30' y2='20'/>",
    "<polyline points='1,2 3,4 10,2'/>",
    "<polygon points='1,2 13,4 10,12'/>",
]
TRANSFORMS = [
    "",
    "translate(3 4)",
    "rotate(30) scale(.5)",
    "rotate(90 10 10)",
    "scale(-1 1) translate(-40)",
    "matrix(.7 .2 -.3 .9 4 1)",
    "skewX(20) skewY(-10)",
]


@pytest.mark.parametrize("transform", TRANSFORMS)
@pytest.mark.parametrize("element", ELEMENTS)
def test_shapes_are_where_another_reader_sees_them(element: str, transform: str) -> None:
    """Every element under every transform lies where svgelements puts it, and the other way round."""
    body = f'<g transform="{transform}"><g transform="translate(1 2)">{element}</g></g>'
    ours = shapely.union_all([sampled(shape.paths) for shape in svg(body).shapes])
    # Its own transformed arcs are wrong under a skew, so that points are transformed instead.
    to_page = svgelements.Matrix(f"{transform} translate(1 2)")
    read = svgelements.SVG.parse(io.StringIO(f"<svg {NS} {PAGE}>{element}</svg>"), ppi=25.4, reify=True)
    lines = []
    for shape in read.elements():
        if not isinstance(shape, svgelements.Shape):
            continue
        for segment in svgelements.Path(shape).segments():
            if isinstance(segment, svgelements.Move) or segment.start is None or segment.start == segment.end:
                continue
            points = [to_page.point_in_matrix_space(segment.point(t)) for t in np.linspace(0, 1, 400)]
            lines.append([(point.x, 50 - point.y) for point in points])
    theirs = shapely.MultiLineString(lines)
    assert shapely.hausdorff_distance(ours, theirs) < 0.02


def test_the_comparison_sees_a_wrong_shape() -> None:
    """A radius that is wrong by a tenth of a millimetre is no match."""
    one, two = (sampled(svg(f"<circle cx='20' cy='15' r='{r}'/>").shapes[0].paths) for r in (7, 7.1))
    assert shapely.hausdorff_distance(one, two) > 0.02


def test_curves_keep_their_kind() -> None:
    """Quadratics stay quadratic, circles are arcs where no transform flattens them."""
    path = "<path d='M0 0Q1 1 2 0C3 0 4 1 5 0A5 5 0 0 1 10 5z'/>"
    assert svg(path).shapes[0].paths.kind.tolist() == [QUAD, CUBIC, ARC, LINE]
    flat = svg(f"<g transform='scale(2 1)'>{path}</g>").shapes[0].paths.kind
    assert set(flat.tolist()) == {QUAD, CUBIC, LINE}
    assert flat[0] == QUAD
    turned = svg(f"<g transform='rotate(25) scale(-3 3)'>{path}</g>").shapes[0].paths
    assert turned.kind.tolist() == [QUAD, CUBIC, ARC, LINE]
    radius, _ = turned.arc_radius_and_turn(np.flatnonzero(turned.kind == ARC))
    assert radius[0] == pytest.approx(15.0, rel=1e-12)


@pytest.mark.parametrize(("size", "millimetres"), [("96", 25.4), ("96px", 25.4), ("1in", 25.4), ("72pt", 25.4)])
def test_units(size: str, millimetres: float) -> None:
    """All units of CSS, and what declares none, or pixels, which other programs take for 1/72 or 1/90 inch."""
    drawing = svg("<path d='M0 0H5V10'/>", f'width="{size}" height="{size}" viewBox="0 0 10 10"')
    assert drawing.width == pytest.approx(millimetres)
    assert drawing.shapes[0].paths.bounds == pytest.approx((0, 0, millimetres / 2, millimetres))
    assert drawing.unit_known == (size not in {"96", "96px"})


def test_pages_keep_their_proportions() -> None:
    """A viewBox of another shape is centred, as preserveAspectRatio says."""
    shape = svg("<path d='M0 0L10 10'/>", 'width="20mm" height="40mm" viewBox="0 0 10 10"').shapes[0]
    assert shape.paths.bounds == pytest.approx((0, 10, 20, 30))
    top = 'width="20mm" height="40mm" viewBox="0 0 10 10" preserveAspectRatio="xMinYMin meet"'
    assert svg("<path d='M0 0L10 10'/>", top).shapes[0].paths.bounds == pytest.approx((0, 20, 20, 40))


def test_styles_layers_and_what_is_not_drawn() -> None:
    """Style sheets, attributes and inheritance; layers; hidden things; what is counted."""
    drawing = svg(
        """<style>.a{stroke:#0f0;stroke-width:2} #c{stroke:blue} rect{fill:none}</style>
        <defs><path id="d" d="M0 0h1"/></defs><clipPath><path d="M0 0h1"/></clipPath>
        <g inkscape:groupmode="layer" inkscape:label="cut" stroke="red">
          <path class="a" d="M0 0h1"/><path id="c" class="a" d="M0 0h1"/><path style="stroke:rgb(1,2,3)" d="M0 0h1"/>
          <path d="M0 0h1"/><path display="none" d="M0 0h1"/><path style="visibility:hidden" d="M0 0h1"/>
          <use href="#d" x="5"/><use href="other.svg#d"/><rect width="1" height="1"/>
        </g><text>hello</text><image/><svg/>"""
    )
    assert [shape.stroke for shape in drawing.shapes] == [
        "#00ff00", "#0000ff", "#010203", "#ff0000", "#ff0000", "#ff0000",
    ]  # fmt: skip
    assert {shape.layer for shape in drawing.shapes} == {"cut"}
    assert drawing.shapes[0].stroke_width == 2.0
    assert drawing.shapes[4].paths.bounds == (5.0, 50.0, 6.0, 50.0)
    assert drawing.shapes[5].fill is None
    assert drawing.ignored == {"image": 1, "text": 1, "use of another file": 1}
    assert drawing.clones == 1


def test_one_element_of_a_file_can_be_read(tmp_path: Path) -> None:
    """An object or a group of an SVG, an entity of a DXF by its handle; the rest is neither drawn nor counted."""
    drawing = tmp_path / "d.svg"
    body = """<text>T</text><path id="one" d="M 1 1 H 9"/><g id="two"><g><path d="M 2 2 V 9"/></g>
    <text>T</text><path id="inner" d="M 3 3 V 9"/></g>"""
    drawing.write_text(f"<svg {NS} {PAGE}>{body}</svg>")
    counts = {name: read_drawing(drawing, element=name) for name in ("one", "two", "inner", None)}
    assert [len(found.shapes) for found in counts.values()] == [1, 2, 1, 3]
    assert [dict(found.ignored) for found in counts.values()] == [{}, {"text": 1}, {}, {"text": 2}]
    with pytest.raises(DrawingError, match=r"no element with the id 'three'.*'one', 'two'"):
        read_drawing(drawing, element="three")
    document = ezdxf.new("R2000")
    lines = [document.modelspace().add_line((0, k), (5 + k, k)) for k in range(3)]
    document.saveas(tmp_path / "d.dxf")
    (shape,) = read_drawing(tmp_path / "d.dxf", element=str(lines[1].dxf.handle).lower()).shapes
    assert shape.source == f"LINE {lines[1].dxf.handle}"
    with pytest.raises(DrawingError, match="no entity with the handle 'NONE'"):
        read_drawing(tmp_path / "d.dxf", element="none")


def doubling(levels: int, inner: str) -> str:
    """Clones of clones, twice as many at every level."""
    groups = "".join(f'<g id="u{k}"><use href="#u{k - 1}"/><use href="#u{k - 1}"/></g>' for k in range(1, levels))
    return f'<defs>{inner}{groups}</defs><use href="#u{levels - 1}"/>'


ROOT = f"<svg {NS} {PAGE}>"
EMPTY = '<g id="u0"/>'
SPACES = " " * 1_000_000
GROWING = '<g transform="scale(1e9)">'
HOSTILE = {
    "entities": b'<!DOCTYPE svg [<!ENTITY a "aa"><!ENTITY b "&a;&a;">]><svg>&b;</svg>',
    "external": b'<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]><svg>&a;</svg>',
    "parameter": b'<!DOCTYPE svg [<!ENTITY % a SYSTEM "file:///etc/passwd"> %a;]><svg/>',
    "undeclared": b'<!DOCTYPE svg SYSTEM "x.dtd"><svg>&b;</svg>',
    "nested": b"<svg>" + b"<g>" * 1_000_000,
    "truncated": f"{ROOT}<path d='M0 0h1'/>".encode(),
    "garbage": random.Random(1).randbytes(10_000),  # noqa: S311 - random input, not secrets
    "empty": b"",
    "no svg": b"<html/>",
    "nan": f"{ROOT}<path d='M0 0L nan 1'/></svg>".encode(),
    "infinite": f"{ROOT}<path d='M0 0L1e999 1'/></svg>".encode(),
    "huge transform": f"{ROOT}{GROWING * 40}<path d='M0 0h1'/>{'</g>' * 40}</svg>".encode(),
    "negative radius": f"{ROOT}<circle r='-1'/></svg>".encode(),
    "negative page": b'<svg width="-1mm" height="1mm"/>',
    "empty page": b'<svg viewBox="0 0 0 1"/>',
    "circular clone": f'{ROOT}<g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g></svg>'.encode(),
    "doubling": f"{ROOT}{doubling(60, EMPTY)}</svg>".encode(),
    "gzip bomb": gzip.compress(b"<svg>" + b" " * (257 << 20), compresslevel=1),
    "cut gzip": gzip.compress(b"<svg/>" * 100)[:-9],
    "encoding": b'<?xml version="1.0" encoding="foo"?><svg/>',
    "spaces": f"{ROOT}<path d='M0 0{SPACES}x'/></svg>".encode(),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_svg_gives_one_message(name: str) -> None:
    """One DrawingError of one line that names the file, in bounded time."""
    begun = time.monotonic()
    with pytest.raises(DrawingError) as caught:
        svg_drawing(HOSTILE[name], "bad.svg")
    assert str(caught.value).startswith("bad.svg")
    assert "\n" not in str(caught.value)
    assert caught.value.exit_code == 2
    assert time.monotonic() - begun < 60


def test_broken_path_data_is_named_with_its_place() -> None:
    """The line in the file and the character in the data."""
    with pytest.raises(DrawingError, match=r"t\.svg, line 3, d: broken SVG path data: .* at character 9"):
        svg("\n\n<path d='M0 0 L 1'/>")
    for data in ("M0 0 L1 1,", "L1 1", "M0 0 A1 1 0 2 0 1 1", "M0 0 Z 1", "M0 0 L 1 2 3", "M0 0 X"):
        with pytest.raises(DrawingError):
            svg(f"<path d='{data}'/>")


def test_compressed_files_and_doctypes_are_read(tmp_path: Path) -> None:
    """Plain gzip and the usual DOCTYPE are no attack."""
    doctype = '<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd">'
    path = tmp_path / "a.svgz"
    path.write_bytes(gzip.compress(f"{doctype}{ROOT}<path d='M0 0h1'/></svg>".encode()))
    assert len(read_drawing(path).shapes) == 1
    other = tmp_path / "a.txt"
    other.write_text("hello")
    with pytest.raises(DrawingError, match="neither an SVG nor a DXF"):
        read_drawing(other)
    for name, reason in (("none.svg", "No such file"), ("a\0b", "its name has a null byte")):
        with pytest.raises(DrawingError, match=f"cannot be read: {reason}"):
            read_drawing(tmp_path / name)
    with pytest.raises(DrawingError, match="'': cannot be read: No such file"):
        read_drawing("")


def all_kinds(document: Any, space: Any) -> None:
    """Draw one of each kind, also in a block that is turned, mirrored and stretched."""
    block = document.blocks.new("B")
    for target in (space, block):
        target.add_line((0, 0), (10, 3))
        target.add_circle((5, 5), 2)
        target.add_arc((0, 0), 3, 350, 100)
        target.add_arc((5, 0), 1, 0, 90, dxfattribs={"extrusion": (0, 0, -1)})
        target.add_ellipse((0, 0), (4, 1), 0.5, 0.3, 4)
        target.add_lwpolyline([(0, 0, 0, 0, 1), (2, 0, 0, 0, -0.3), (2, 2, 0, 0, 0)], close=True)
        target.add_polyline2d([(0, 0), (1, 0), (1, 1)], close=True)
        target.add_open_spline([(0, 0), (1, 1), (2, 0), (3, 1), (4, 0)], degree=2)
        target.add_open_spline([(0, 0), (1, 1), (2, 0), (3, 1), (4, 0)], degree=3)
        target.add_open_spline([(0, 0), (1, 1), (2, 0), (3, 1), (4, 0), (5, 5)], degree=5)
        target.add_rational_spline([(0, 0), (1, 1), (2, 0), (3, 1), (4, 0)], weights=[1, 2, 1, 2, 1], degree=3)
    space.add_blockref("B", (20, 0), dxfattribs={"rotation": 30, "xscale": -1})
    space.add_blockref("B", (40, 0), dxfattribs={"yscale": 2})


def test_dxf_entities_are_where_ezdxf_sees_them() -> None:
    """Every kind of entity, directly and in blocks, against ezdxf's own flattening."""
    document = ezdxf.new("R2000", units=4)
    all_kinds(document, document.modelspace())
    lines = []
    for entity in document.modelspace():
        parts = entity.virtual_entities() if isinstance(entity, Insert) else [entity]
        for part in parts:
            points = [(p.x, p.y) for p in ezdxf.path.make_path(part, level=8).flattening(1e-3, segments=16)]
            lines.append(shapely.LineString(points))
    ours = [sampled(shape.paths, 100) for shape in dxf(all_kinds).shapes]
    assert len(ours) == len(lines)
    for mine, theirs in zip(ours, lines, strict=True):
        assert shapely.hausdorff_distance(mine, theirs) < 0.02


def test_dxf_splines_are_exact_and_arcs_are_arcs() -> None:
    """A quadratic spline is quadratic pieces, a bulge is an arc of the right radius."""

    def draw(_document: Any, space: Any) -> None:
        space.add_open_spline([(0, 0), (1, 1), (2, 0), (3, 1)], degree=2)
        space.add_lwpolyline([(0, 0, 0, 0, 1), (2, 0, 0, 0, 0)], close=True)

    spline, polyline = dxf(draw, units=1).shapes
    assert set(spline.paths.kind.tolist()) == {QUAD}
    radius, turn = polyline.paths.arc_radius_and_turn(np.array([0]))
    assert radius[0] == pytest.approx(25.4)
    assert turn[0] == pytest.approx(math.pi)
    assert polyline.paths.closed.tolist() == [True]


def test_dxf_layers_colours_and_what_is_not_drawn() -> None:
    """The unit, layers, colours by layer and by block, and what is counted."""

    def draw(document: Any, space: Any) -> None:
        document.layers.add("CUT", color=1)
        document.layers.add("OFF").off()
        space.add_line((0, 0), (1, 1), dxfattribs={"layer": "CUT"})
        space.add_line((0, 0), (1, 1), dxfattribs={"layer": "OFF"})
        space.add_line((0, 0), (1, 1), dxfattribs={"color": 5})
        space.add_text("hello")
        space.add_point((1, 1))
        space.add_circle((0, 0), 1, dxfattribs={"extrusion": (1, 0, 1)})
        document.blocks.new("B").add_line((0, 0), (1, 0), dxfattribs={"color": 0, "layer": "0"})
        space.add_blockref("B", (0, 0), dxfattribs={"color": 3, "layer": "CUT"})

    drawing = dxf(draw, units=0)
    assert not drawing.unit_known
    assert [(shape.layer, shape.stroke) for shape in drawing.shapes] == [
        ("CUT", "#ff0000"), ("0", "#0000ff"), ("CUT", "#00ff00"),
    ]  # fmt: skip
    assert drawing.ignored == {"CIRCLE tilted in space": 1, "POINT": 1, "TEXT": 1, "hidden": 1}
    assert drawing.clones == 1


def in_itself(document: Any, space: Any) -> None:
    """Draw two blocks that hold each other."""
    document.blocks.new("A").add_blockref("B", (0, 0))
    document.blocks.new("B").add_blockref("A", (0, 0))
    space.add_blockref("A", (0, 0))


def many_copies(document: Any, space: Any) -> None:
    """Draw nine hundred million copies."""
    document.blocks.new("A").add_line((0, 0), (1, 1))
    space.add_blockref(
        "A", (0, 0), dxfattribs={"row_count": 30_000, "column_count": 30_000, "row_spacing": 1, "column_spacing": 1}
    )


@pytest.mark.parametrize("draw", [in_itself, many_copies])
def test_hostile_dxf_gives_one_message(draw: Any) -> None:
    """Blocks in themselves, blocks without end."""
    with pytest.raises(DrawingError, match=r"^t\.dxf"):
        dxf(draw)


def nested_inserts(document: Any, space: Any) -> None:
    """Draw blocks of two inserts each, forty deep: a million million of them, which draw one line."""
    document.blocks.new("B0").add_line((0, 0), (1, 1))
    for k in range(1, 40):
        block = document.blocks.new(f"B{k}")
        for _ in range(2):
            block.add_blockref(f"B{k - 1}", (0, 0))
    space.add_blockref("B39", (0, 0))


def test_inserts_are_counted_wherever_they_are_visited(monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks that draw next to nothing end as well."""
    monkeypatch.setattr("voronoi_tiles.formats.dxf.reader.DXF_INSERTS_MAX", 100)
    with pytest.raises(DrawingError, match="inserts more than 100 blocks"):
        dxf(nested_inserts)
    few = dxf(lambda document, space: [space.add_blockref("A", (k, 0)) for k in range(100)] if document else None)
    assert few.ignored == {"INSERT of nothing": 100}


def test_dxf_entities_are_counted_before_they_are_parsed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The values of group code 0, however that is written, and nothing else; too many are refused unread."""
    assert entity_count(b"0\nLINE\n 0\r\nEOF\r\n") == 2
    assert entity_count(b"00\nLINE\n8\n0\n100\n0\n10\n0\n20\n0.0\n+0\n0\n  0") == 3
    assert entity_count(b"x") == 0
    document = ezdxf.new("R2000")
    for _ in range(50):
        document.modelspace().add_line((0, 0), (0, 10))
    text = written(document)
    count = sum(int(code) == 0 for code in text.splitlines()[::2])
    data = text.encode()
    assert entity_count(data) == count
    monkeypatch.setattr("voronoi_tiles.formats.dxf.loading.ELEMENTS_MAX", count)
    assert len(dxf_drawing(data, "t.dxf").shapes) == 50
    monkeypatch.setattr("voronoi_tiles.formats.dxf.loading.ELEMENTS_MAX", count - 1)
    with pytest.raises(DrawingError, match=r"^t\.dxf: more than [0-9,]+ entities\. Split"):
        dxf_drawing(data, "t.dxf")


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_dxf_numbers_that_are_none_are_named(value: float) -> None:
    """The entity and the attribute, and no word of a conversion."""
    with pytest.raises(DrawingError, match=r"t\.dxf, ARC [0-9A-F]+: its end angle is (nan|inf), no number"):
        dxf(lambda _, space: space.add_arc((0, 0), 10, 0, value))
    with pytest.raises(DrawingError, match=r"t\.dxf, CIRCLE [0-9A-F]+: its center is (nan|inf), no number"):
        dxf(lambda _, space: space.add_circle((value, 0), 10))


def test_elements_and_visits_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many as the limits are read, one more is refused."""
    monkeypatch.setattr("voronoi_tiles.formats.svg.xml_tree.ELEMENTS_MAX", 11)
    assert svg("<g/>" * 10).shapes == ()
    with pytest.raises(DrawingError, match="more than 11 elements"):
        svg("<g/>" * 11)
    monkeypatch.setattr("voronoi_tiles.formats.svg.reader.VISITS_MAX", 10)
    body = '<defs><path id="a" d="M0 0h1"/></defs>' + '<use href="#a"/>' * 4
    assert len(svg(body).shapes) == 4
    with pytest.raises(DrawingError, match="draws more than 10 elements, clones counted"):
        svg(body + '<use href="#a"/>')


def test_arcs_with_radii_of_next_to_nothing_are_arcs_or_lines() -> None:
    """A radius that is enlarged to the chord's half is a half circle; one that is 0 but for its name is a line."""
    for radius, kind in ((1e-9, ARC), (1e-310, LINE), (0.0, LINE)):
        assert svg(f"<path d='M0 0A{radius} {radius} 0 0 1 3 3'/>").shapes[0].paths.kind.tolist() == [kind]


@pytest.mark.parametrize("count", [40, pytest.param(400, marks=pytest.mark.slow)])
def test_broken_dxf_gives_one_message(count: int) -> None:
    """Whatever is broken in a file, only DrawingError comes out; most of what is broken is seen."""
    document = ezdxf.new("R2000")
    all_kinds(document, document.modelspace())
    good = written(document).encode()
    generator = random.Random(7)  # noqa: S311 - random input, not secrets
    refused = 0
    for _ in range(count):
        bad = bytearray(good)
        for _ in range(generator.randint(1, 5)):
            place = generator.randrange(len(bad))
            if generator.random() < 0.5:
                bad[place] = generator.randrange(256)
            else:
                del bad[place : place + generator.randint(1, 400)]
        try:
            dxf_drawing(bytes(bad), "bad.dxf")
        except DrawingError as error:
            assert str(error).startswith("bad.dxf")  # noqa: PT017 - what is not raised is no failure here
            refused += 1
    assert refused > count / 7
    for data in (b"", good[: len(good) // 2], b"AutoCAD Binary DXF\r\n\x1a\x00", b"AC1015", b"0\n\x00\x00"):
        with pytest.raises(DrawingError):
            dxf_drawing(data, "bad.dxf")


def test_lengths() -> None:
    """Lengths in all units, and what is none."""
    assert [parse_length(text) for text in ("600mm", "3cm", "1in", "0.15", "-1e1 mm")] == [600, 30, 25.4, 0.15, -10]
    assert parse_size("600x300mm") == (600, 300)
    assert parse_size("60cmx1in") == (600, 25.4)
    for text in ("", "nan", "1e400", "5 furlongs", "1,5", "--1"):
        with pytest.raises(DesignError):
            parse_length(text)
    for text in ("600", "1x", "0x5", "1x2x3", "-1x5"):
        with pytest.raises(DesignError):
            parse_size(text)
