"""What others' SVG draws and where: nested drawings, switches, clones, transforms of CSS, units, effects."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from helpers.svg_text import svg
from hypothesis import assume, given
from hypothesis import strategies as st

from voronoi_tiles import Design, Job
from voronoi_tiles.base.maps import Affine
from voronoi_tiles.formats.reading import DrawingError, ReadDrawing
from voronoi_tiles.formats.svg.reader import drawing_of_tree, svg_drawing, svg_tree
from voronoi_tiles.preflight import judge

RECT = '<rect {} class="w" width="20" height="10" fill="none" stroke="red"/>'
HEIGHT = 50.0  # of the page, whose units are millimetres


def extents(drawing: ReadDrawing) -> list[tuple[float, float, float, float]]:
    """The extents of every shape, y down: left, top, right, bottom."""
    bounds = (shape.paths.bounds for shape in drawing.shapes)
    return [(left, HEIGHT - top, right, HEIGHT - bottom) for left, bottom, right, top in bounds]


# What Chromium's getBoundingClientRect says of the rectangle, in user units.
PLACES = {
    'style="transform: translate(30px, 20px)"': (30, 20, 50, 30),
    'style="transform: translate(10%, 10%)"': (10, 5, 30, 15),
    'transform="translate(1 1)" style="transform: none"': (0, 0, 20, 10),
    'transform="translate(1 1)" style="transform: rotate(90)"': (1, 1, 21, 11),
    'style="transform: rotate(90deg)"': (-10, 0, 0, 20),
    'style="transform: rotate(.25turn) translate(1px)"': (-10, 1, 0, 21),
    'style="transform: skewX(45deg)"': (0, 0, 30, 10),
    'style="transform: scale(200%)"': (0, 0, 40, 20),
    'style="transform: translate3d(1px, 2px, 3px) rotateZ(0)"': (1, 2, 21, 12),
    'style="TRANSFORM: TRANSLATEX(1CM)"': (96 / 2.54, 0, 20 + 96 / 2.54, 10),
    'style="transform: rotate(90deg); transform-origin: center"': (65, -25, 75, -5),
    'transform="rotate(90)" transform-origin="50% 50%"': (65, -25, 75, -5),
    'transform="rotate(90)" transform-origin="20 15"': (25, -5, 35, 15),
    'style="transform: scale(2); transform-box: fill-box; transform-origin: 50% 50%"': (-10, -5, 30, 15),
    'x="10" style="transform: scale(2); transform-box: fill-box"': (10, 0, 50, 20),
    'style="rotate: 90deg; translate: 10px 20px; scale: 2"': (-10, 20, 10, 60),
    'transform="translate(5 5)" style="translate: 1px"': (6, 5, 26, 15),
    'style="x: 3px; y: 10%; width: calc(5px + 5px); height: 2em"': (3, 5, 13, 37),
    'style="width: auto" x="1"': None,
}


@pytest.mark.parametrize("said", PLACES)
def test_transforms_and_geometry_of_css_are_applied(said: str) -> None:
    """As a browser applies them, to the last bit of what a picture shows; nothing is said of what was read."""
    drawing = svg(RECT.format(said))
    place = PLACES[said]
    assert extents(drawing) == ([] if place is None else [pytest.approx(place, abs=1e-9)])
    assert not drawing.ignored


def test_what_is_passed_over_is_said_once() -> None:
    """A transform out of the plane above one that is read, and an origin that is none."""
    style = "transform: rotate(90deg); transform: rotateX(60deg); transform-origin: 20 15"
    drawing = svg(RECT.format(f'style="{style}"'))
    assert extents(drawing) == [pytest.approx((-10, 0, 0, 20), abs=1e-9)]
    assert dict(drawing.ignored) == {"transform 'rotateX(60deg)'": 1, "transform-origin '20 15'": 1}


number = st.floats(-50, 50).map(lambda x: round(x, 3))
FUNCTIONS = st.one_of(
    st.builds(lambda x, y: (f"translate({x} {y})", f"translate({x}px, {y}px)"), number, number),
    st.builds(lambda x: (f"translate({x})", f"translateX({x}px)"), number),
    st.builds(lambda x: (f"scale(1 {x})", f"scaleY({x})"), number),
    st.builds(lambda x, y: (f"scale({x},{y})", f"scale({x}, {y * 100:.1f}%)"), number, number),
    st.builds(lambda x: (f"rotate({x})", f"rotate({x}deg)"), number),
    st.builds(lambda x: (f"rotate({x})", f"rotateZ({x / 360:.12f}turn)"), number),
    st.builds(lambda x: (f"skewX({x})", f"skew({math.radians(x):.15f}rad)"), number),
    st.builds(lambda x: (f"skewY({x})", f"skewY({x / 0.9:.12f}grad)"), number),
    st.builds(lambda x, y: (f"matrix(1 .5 -.5 1 {x} {y})", f"matrix(1, .5, -.5, 1, {x}, {y})"), number, number),
)


@given(st.lists(FUNCTIONS, min_size=1, max_size=4))
def test_transforms_of_css_are_those_of_the_attribute(functions: list[tuple[str, str]]) -> None:
    """With CSS's units the same functions make the same map, also over another attribute."""
    attribute, style = (" ".join(each) for each in zip(*functions, strict=True))
    one = extents(svg(RECT.format(f'transform="{attribute}"')))
    two = extents(svg(RECT.format(f'transform="rotate(7)" style="transform: {style}"')))
    assert len(one) == len(two)
    for a, b in zip(one, two, strict=True):
        assert a == pytest.approx(b, abs=1e-6 * (1 + max(map(abs, a))))


@pytest.mark.parametrize(
    ("said", "name"),
    [
        ('style="clip-path: url(#c)"', "clip-path"),
        ('clip-path="url(#c)"', "clip-path"),
        ('style="-webkit-clip-path: inset(1px)"', "clip-path"),
        ('style="mask: url(#c)"', "mask"),
        ('style="mask-image: url(#c)"', "mask"),
        ('style="filter: blur(1px)"', "filter"),
        ('style="stroke-dasharray: 1px"', "stroke-dasharray"),
        ('stroke-dasharray="1 0"', "stroke-dasharray"),
        ('style="animation: spin 1s"', "animation"),
        ('style="offset-path: path(&quot;M0 0h9&quot;)"', "offset-path"),
        ('style="transform: rotateX(60deg)"', "transform 'rotateX(60deg)'"),
        ('transform="rotate(9"', "transform 'rotate(9'"),
        ('transform="translate(3px, 4px)"', "transform 'translate(3px, 4px)'"),
        ('style="transform: scale(2); transform-box: stroke-box"', "transform-box"),
        ('stroke-width="thick"', "stroke-width 'thick'"),
    ],
)
def test_effects_that_are_not_followed_are_named(said: str, name: str) -> None:
    """From an attribute, a style, a rule; the object itself is drawn, and the preflight says what was left out."""
    rule = said.removeprefix('style="').removesuffix('"').replace("&quot;", '"')
    bodies = [RECT.format(said)]
    if said.startswith("style"):
        bodies.append(f"<style>rect {{ {rule} }}</style>{RECT.format('')}")
    for body in bodies:
        drawing = svg(body)
        assert len(drawing.shapes) == 1
        assert drawing.ignored == {name: 1}
        assert any(f"1 {name}" in finding.message for finding in judge(drawing, "t.svg").findings)


@pytest.mark.parametrize(
    "said",
    [
        'stroke-dasharray=""',
        'stroke-dasharray="none"',
        'stroke-dasharray="0 0"',
        'style="stroke-dasharray: 0px"',
        'clip-path="none"',
        'mask=""',
        'style="filter: none; animation: none; mask: none; clip-path: none; marker: none; zoom: 1"',
        'marker-start="url(#m)"',  # rectangles have no markers
        'stroke-width="hairline"',
        'style="opacity: .5; mix-blend-mode: multiply; paint-order: stroke; -inkscape-stroke: hairline"',
    ],
)
def test_effects_that_are_none_say_nothing(said: str) -> None:
    """Empty values, zeros and the words for nothing."""
    drawing = svg(RECT.format(said))
    assert len(drawing.shapes) == 1
    assert not drawing.ignored


def test_markers_and_dashes_count_on_the_lines_that_have_them() -> None:
    """By inheritance, and not on what gives them up or has no stroke."""
    drawing = svg(
        """<g stroke="red" fill="none" style="marker: url(#m)" stroke-dasharray="3 1"><path d="M0 0h9"/>
        <path d="M0 1h9" style="marker: none" stroke-dasharray="none"/><rect width="1" height="2" stroke="none"/></g>"""
    )
    assert drawing.ignored == {"marker-start": 1, "marker-mid": 1, "marker-end": 1, "stroke-dasharray": 1}


def test_animations_are_counted() -> None:
    """A browser moves the object; where it begins is drawn."""
    drawing = svg('<circle r="3" stroke="red"><animate attributeName="r" to="9"/></circle><set/>')
    assert len(drawing.shapes) == 1
    assert drawing.ignored == {"animate": 1, "set": 1}


def test_an_element_without_a_box_hands_on_its_children() -> None:
    """display: contents takes a group's transform away, and a shape altogether."""
    group = f'<g style="display: contents" transform="translate(9)">{RECT.format("")}</g>'
    assert extents(svg(group)) == [pytest.approx((0, 0, 20, 10))]
    assert not svg(RECT.format('display="contents"')).shapes


NESTED = {
    '<svg x="10" y="5" width="40" height="40" viewBox="0 0 20 20">{}</svg>': (10, 5, 50, 25),
    '<svg x="10%" y="5">{}</svg>': (10, 5, 30, 15),
    '<svg width="50%" viewBox="0 0 20 20">{}</svg>': (0, 0, 50, 25),
    '<svg width="40" height="40" viewBox="0 0 20 10" preserveAspectRatio="none">{}</svg>': (0, 0, 40, 40),
    '<svg x="1" transform="translate(2 3)">{}</svg>': (3, 3, 23, 13),
    '<svg width="0">{}</svg>': None,
    '<svg viewBox="0 0 0 0">{}</svg>': None,
    '<svg display="none">{}</svg>': None,
    '<svg x="2"><svg x="3"><g>{}</g></svg></svg>': (5, 0, 25, 10),
    '<defs><svg id="s" width="9" height="9">{}</svg></defs><use href="#s" x="4" width="40" height="40"/>': (
        4,
        0,
        24,
        10,
    ),
    '<symbol id="s" x="3" y="4" viewBox="0 0 20 10">{}</symbol><use href="#s" width="10" height="5"/>': (3, 4, 13, 9),
}


@pytest.mark.parametrize("text", NESTED)
def test_nested_drawings_are_read(text: str) -> None:
    """In their own viewports, as Chromium places them."""
    place = NESTED[text]
    drawing = svg(text.format(RECT.format("")))
    assert extents(drawing) == ([] if place is None else [pytest.approx(place)])
    assert not drawing.ignored


def test_percentages_are_of_the_viewport_around() -> None:
    """Not of the page."""
    drawing = svg('<svg width="30" height="40"><circle r="10%" cx="50%" cy="50%" stroke="red"/></svg>')
    radius = math.hypot(30, 40) / math.sqrt(2) / 10
    assert extents(drawing) == [pytest.approx((15 - radius, 20 - radius, 15 + radius, 20 + radius))]


@pytest.mark.parametrize(
    ("said", "shapes", "clips"),
    [
        ('width="20" height="10"', 1, 0),
        ('width="19" height="10"', 1, 1),
        ('width="19" height="10" overflow="visible"', 1, 0),
        ('width="19" height="10" style="overflow: auto"', 1, 0),
        ('width="9" height="9" viewBox="30 0 9 9"', 0, 1),
        ('width="9" height="9" viewBox="30 0 9 9" transform="rotate(30)"', 0, 1),
    ],
)
def test_what_a_nested_drawing_cuts_off_is_said(said: str, shapes: int, clips: int) -> None:
    """Shapes are never cut; what lies wholly outside is not drawn."""
    drawing = svg(f"<svg {said}>{RECT.format('')}</svg>")
    assert len(drawing.shapes) == shapes
    assert drawing.ignored == ({"clip of a nested svg": 1} if clips else {})


@pytest.mark.parametrize(
    ("first", "drawn"),
    [
        ("", True),
        ('systemLanguage="en"', True),
        ('systemLanguage="de, en-GB"', True),
        ('systemLanguage="EN-us"', True),
        ('requiredFeatures="http://www.w3.org/TR/SVG11/feature#Shape"', True),
        ('requiredExtensions="http://www.w3.org/1999/xhtml"', True),
        ('systemLanguage="de"', False),
        ('systemLanguage=""', False),
        ('requiredExtensions=""', False),
        ('requiredExtensions="http://ns.adobe.com/AdobeIllustrator/10.0/"', False),
    ],
)
def test_a_switch_draws_the_first_child_that_applies(first: str, drawn: bool) -> None:
    """And no other; outside of a switch an element that does not apply is not drawn."""
    second = '<g><rect x="50" width="20" height="10" stroke="red"/></g>'
    drawing = svg(f"<switch><a xmlns='http://x'/>{RECT.format(first)}{second}</switch>")
    assert extents(drawing) == [pytest.approx((0, 0, 20, 10) if drawn else (50, 0, 70, 10))]
    assert len(svg(RECT.format(first)).shapes) == drawn
    assert not svg(f'<switch><g display="none"/>{second}</switch>').shapes


@pytest.mark.parametrize("side", ["1em", "1EM", "2rem", "3ex", "calc(10px + 1em)", "10vw", "big"])
def test_a_page_in_relative_units_is_read_its_size_being_unknown(side: str) -> None:
    """Its geometry is clear by the viewBox; the preflight says that its size is not."""
    text = f'<svg xmlns="http://www.w3.org/2000/svg" width="{side}" height="{side}" viewBox="0 0 24 24">'
    drawing = svg_drawing(f'{text}<path d="M4 12L20 14" stroke="red"/></svg>'.encode(), "t.svg")
    assert len(drawing.shapes) == 1
    assert not drawing.unit_known
    assert drawing.ignored == ({"width 'big'": 1, "height 'big'": 1} if side == "big" else {})
    assert any(finding.kind == "unit" for finding in judge(drawing, "t.svg").findings)


def test_a_page_may_have_its_size_from_a_style() -> None:
    """In a style attribute or a rule, over the attribute."""
    text = '<svg xmlns="http://www.w3.org/2000/svg" width="9" viewBox="0 0 20 10" style="width: 40mm; height: 20mm"/>'
    drawing = svg_drawing(text.encode(), "t.svg")
    assert (drawing.width, drawing.height) == pytest.approx((40, 20))
    assert drawing.unit_known


SIZES = {"px": 1.0, "mm": 96 / 25.4, "cm": 96 / 2.54, "in": 96.0, "pt": 96 / 72, "pc": 16.0, "q": 96 / 101.6}
RELATIVE = {"": 1.0, "em": 20.0, "rem": 8.0, "vw": 2.0, "vh": 1.0, "vmin": 1.0, "%": 0.5}


@given(st.sampled_from(sorted(SIZES | RELATIVE)), st.floats(0.01, 100).map(lambda x: round(x, 4)), st.booleans())
def test_lengths_are_read_in_every_unit(unit: str, number: float, upper: bool) -> None:
    """Of a line's end: absolute units are CSS's, relative ones those of the font, the page, and the viewport."""
    shown = unit.upper() if upper else unit
    text = (
        '<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100" viewBox="0 0 50 25" font-size="8">'
        f'<g font-size="20"><line x2="{number}{shown}" stroke="red"/></g></svg>'
    )
    (shape,) = svg_drawing(text.encode(), "t.svg").shapes
    pixels = number * (SIZES | RELATIVE)[unit] * 4  # 4 of a pixel in a user unit
    assert shape.paths.bounds[2] == pytest.approx(pixels * 25.4 / 96, rel=1e-9)


def test_what_only_a_browser_has_is_said() -> None:
    """Style sheets of other files, and shares of a page that has no size."""
    head = '<svg xmlns="http://www.w3.org/2000/svg">'
    text = f'<?xml-stylesheet href="a.css" type="text/css"?>{head}<rect width="50%" height="9" stroke="red"/></svg>'
    drawing = svg_drawing(text.encode(), "t.svg")
    assert drawing.ignored == {"percentage of a page without a size": 1, "style sheet of another file": 1}
    messages = [finding.message for finding in judge(drawing, "t.svg").findings]
    assert "1 style sheet of another file: other files are not opened" in messages


def test_paint_of_a_clone_is_that_of_the_clone() -> None:
    """Inherited, and as context-stroke, also where the original stands in no paint."""
    drawing = svg(
        """<defs><path id="a" d="M0 0h1" stroke="context-stroke" fill="none"/><path id="b" d="M0 0h1"/></defs>
        <use href="#a" stroke="red"/><use href="#b" stroke="blue"/><use href="#a" stroke="none" fill="none"/>"""
    )
    assert [shape.stroke for shape in drawing.shapes] == ["#ff0000", "#0000ff"]


def test_broken_geometry_is_refused_with_its_place() -> None:
    """A number that is none leaves no clear geometry: the line, the attribute, and what to do."""
    for body in ('circle r="5foo"', 'rect width="-1" height="2"', 'line x2="a"', 'use x="b" href="#c"'):
        with pytest.raises(DrawingError, match=r"t\.svg, line 2"):
            svg(f'\n<{body} id="c" stroke="red"/>')


def test_sheets_and_art_read_as_the_preflight_does(tmp_path: Path) -> None:
    """A hole in hsl and one in a nested drawing are holes of a sheet, and art in hsl is engraved."""
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">'
    rim = '<rect x="5" y="5" width="90" height="90" fill="none" stroke="#f00"/>'
    holes = {
        "hsl": '<circle cx="50" cy="50" r="20" fill="none" stroke="hsl(0,80%,40%)"/>',
        "nested": '<svg viewBox="0 0 10 10"><circle cx="5" cy="5" r="2" fill="none" stroke="red"/></svg>',
        "style": '<circle style="cx: 50px; cy: 50px; r: 20px; fill: none; stroke: red"/>',
    }
    (tmp_path / "face.svg").write_text(
        f'{head}<circle cx="1" cy="1" r="1" stroke="hsl(9 9% 9%)"/>'
        "<path d='M0 0' stroke='red' style='d: path(\"M0 0h2\")'/></svg>"
    )
    design = tmp_path / "d.toml"
    design.write_text(
        """schema = 1\ngroup = "p1"\n[cell]\na = 30.0\nb = 30.0\nangle = 90
        [[site]]\nname = "s"\nart = "face.svg"\nstrokes = [{ polyline = [[8, 8], [20, 9]] }]"""
    )
    tiling = Design.load(design).tessellate()
    for name, hole in holes.items():
        sheet = tmp_path / f"{name}.svg"
        sheet.write_text(f"{head}{rim}{hole}</svg>")
        product = tiling.make(Job(sheet=str(sheet), fit="clip"))
        assert product.pieces.tile_area == pytest.approx(90**2 - 20**2 * math.pi, abs=0.05)
        assert ", 100.0% of the sheet drawn on 100 x 100 mm" in product.summary()
    (engraved,) = (layer for layer in tiling.make(Job()).drawing.layers if layer.work == "engrave")
    assert len(engraved.paths) == 2


def test_several_elements_of_a_tree_are_read() -> None:
    """Each shape says in which of them it stands, the innermost; clones of them are none of them."""
    body = (
        '<g id="a"><path d="M 1 1 H 9"/><g id="b"><path d="M 2 2 V 9"/>'
        '<path id="dot" d="M 3 3 L 3 3" stroke="red"/></g></g>'
        '<path id="c" d="M 3 3 V 9"/><use href="#c"/><path d="M 4 4 V 9"/><text>T</text>'
    )
    root, _ = svg_tree(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="9in" viewBox="0 0 9 9">{body}</svg>'.encode(), "t"
    )
    drawing, to_page = drawing_of_tree(root, "t", {"a", "b", "c"})
    assert [shape.within for shape in drawing.shapes] == ["a", "b", "c"]
    assert [dots.within for dots in drawing.dots] == ["b"]
    assert [shape.within for shape in drawing_of_tree(root, "t", {"b"}).read.shapes] == ["b"]
    assert (dict(drawing.ignored), drawing.clones) == ({}, 0)
    assert [shape.within for shape in drawing_of_tree(root, "t", None).read.shapes] == [""] * 5
    assert to_page(2 + 1j) == pytest.approx(2 * 25.4 + 8j * 25.4)


numbers = st.complex_numbers(max_magnitude=100, allow_nan=False, allow_infinity=False)


@given(numbers, numbers, numbers, numbers)
def test_the_inverse_of_a_map_undoes_it(a: complex, b: complex, c: complex, place: complex) -> None:
    """Of any map that is not nearly flat."""
    assume(abs(abs(a) - abs(b)) > 1e-3 and abs(a) + abs(b) > 1e-2)
    by = Affine(a, b, c)
    worst = (1 + abs(place) + abs(c)) * (abs(a) + abs(b) + 1) / abs(abs(a) - abs(b))
    assert abs(by.inverse(by(place)) - place) <= 1e-14 * worst
    assert abs(by(by.inverse(place)) - place) <= 1e-14 * worst
