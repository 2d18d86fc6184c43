"""CSS in others' SVG: every notation of a value, from every place where it may be written, as a browser takes it."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Callable

import pytest
from helpers.svg_text import svg
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.formats.reading import DrawingError, ReadDrawing
from voronoi_tiles.formats.svg.cascade import style_attribute
from voronoi_tiles.formats.svg.colours import parse_colour
from voronoi_tiles.formats.svg.properties import Origin
from voronoi_tiles.formats.svg.style_sheets import read_declarations
from voronoi_tiles.preflight import judge

LINE = "<path id='p' class='c' d='M0 0h1' {}/>"

# A line's stroke in every place, and what Chromium's getComputedStyle makes of it.
STROKES = {
    'stroke="hsl(120, 50%, 50%)"': "#40bf40",
    'stroke="hsl(0,80%,40%)"': "#b81414",
    'stroke="rgb(1e2 50% none)"': "#648000",
    'stroke="oklch(70% 0.1 200)"': "#40b1b7",
    'stroke="lab(50% 40 -20)"': "#ab5a9a",
    'stroke="color(display-p3 0 .5 0)"': "#008200",
    'stroke="color-mix(in srgb, red, blue 25%)"': "#bf0040",
    'stroke="CanvasText"': "#000000",
    'stroke="light-dark(red, blue)"': "#ff0000",
    'stroke="light-dark(red, blue)" style="color-scheme: dark"': "#0000ff",
    'stroke="#000" style="stroke: nocolour"': "#000000",
    'stroke="#000" style="stroke: rgb(1,2)"': "#000000",
    'style="fill:none;/* cut: */stroke:#f00"': "#ff0000",
    'stroke="blue" style="STROKE: Red"': "#ff0000",
    'style="stroke: red !important; stroke: blue"': "#ff0000",
    'style="stroke: red; stroke: nocolour"': "#ff0000",
    'style="--a: red; stroke: var(--a)"': "#ff0000",
    'style="--a: var(--b); --b: red; stroke: var(--a)"': "#ff0000",
    'style="stroke: var(--none, rgb(255 0 0))"': "#ff0000",
    'style="--a: var(--b); --b: var(--a); stroke: var(--a, red)"': "#ff0000",
    'style="--a: 255 0; stroke: rgb(var(--a) 0)"': "#ff0000",
    'color="red" stroke="currentColor"': "#ff0000",
    'color="red" stroke="CURRENTCOLOR"': "#ff0000",
    'stroke="inherit"': "#00ff00",
    'stroke="red" style="stroke: unset"': "#00ff00",
    'stroke="url(#gone) red"': "#ff0000",
}


@pytest.mark.parametrize("said", STROKES)
def test_paint_is_read_in_all_notations(said: str) -> None:
    """Colours, variables and keywords; a value that is none leaves what is below it, and nothing is said of that."""
    drawing = svg(f'<g stroke="#00ff00">{LINE.format(said)}</g>')
    assert [shape.stroke for shape in drawing.shapes] == [STROKES[said]]
    assert not drawing.ignored


def test_hexadecimal_colours_need_no_library() -> None:
    """The library of colours is loaded for names and functions alone: that takes as long as all else of the reader."""
    file = "<svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0h1' stroke='{}'/></svg>"
    code = (
        "import sys; from voronoi_tiles.formats.svg.reader import svg_drawing;"
        f"read = lambda stroke: svg_drawing({file!r}.format(stroke).encode(), 't.svg').shapes[0].stroke;"
        "assert (read('#F00'), 'coloraide' in sys.modules) == ('#ff0000', False);"
        "assert (read('red'), 'coloraide' in sys.modules) == ('#ff0000', True)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize(
    ("said", "name"),
    [
        ('stroke="xyz(1 2 3)"', "paint 'xyz(1 2 3)'"),
        ('stroke="nocolour"', "paint 'nocolour'"),
        ('stroke="none" style="stroke: device-cmyk(0 1 1 0)"', "paint 'device-cmyk(0 1 1 0)'"),
        ('style="stroke: var(--gone)"', "paint 'var(--gone)'"),
        ('style="--a: var(--a); stroke: var(--a)"', "paint 'var(--a)'"),
        ('style="stroke: rgb(from red r g b)"', "paint 'rgb(from red r g b)'"),
        ('stroke="url(#gone)"', "paint 'url(#gone)'"),
    ],
)
def test_paint_that_is_not_understood_is_visible_and_named(said: str, name: str) -> None:
    """The line is there in grey, and the report of a preflight has its paint."""
    drawing = svg(LINE.format(f'fill="none" {said}'))
    assert [shape.stroke for shape in drawing.shapes] == ["#808080"]
    assert drawing.ignored == {name: 1}
    assert any(name in finding.message for finding in judge(drawing, "t.svg").findings)


def test_newer_paint_over_paint_that_is_known_is_named_and_the_known_one_is_taken() -> None:
    """A file's author gives both for that case."""
    drawing = svg(LINE.format('style="stroke: red; stroke: contrast-color(white)"'))
    assert [shape.stroke for shape in drawing.shapes] == ["#ff0000"]
    assert drawing.ignored == {"paint 'contrast-color(white)'": 1}


@pytest.mark.parametrize("said", ['stroke="none"', 'stroke="transparent"', 'stroke="rgba(9,9,9,0)"', 'stroke="#1230"'])
def test_what_has_no_paint_is_not_drawn(said: str) -> None:
    """None, and colours that are wholly transparent, in silence: programs draw boxes round icons so."""
    drawing = svg(LINE.format(f'fill="none" {said}'))
    assert not drawing.shapes
    assert not drawing.ignored


@pytest.mark.parametrize(
    "said", ['stroke-opacity="0"', 'style="stroke-opacity: 0%"', 'opacity="0"', 'style="opacity:0;stroke-width:3"']
)
def test_what_an_opacity_hides_is_left_out_and_counted(said: str) -> None:
    """A browser does not show it, and many cutters cut it."""
    drawing = svg(LINE.format(f'fill="none" stroke="red" {said}'))
    assert not drawing.shapes
    assert drawing.ignored == {"invisible object": 1}
    inside = svg('<g opacity="0">' + LINE.format('stroke="red"') + "</g>")
    assert inside.ignored == {"invisible object": 1}


def channel(value: float) -> int:
    """A channel from 0 to 1 in eight bits."""
    return round(min(max(value, 0.0), 1.0) * 255)


def hsl(hue: float, saturation: float, light: float) -> list[float]:
    """CSS Color 4, 7.1: hsl to sRGB, by its closed form."""
    a = saturation * min(light, 1 - light)
    turns = [(n + hue / 30) % 12 for n in (0, 8, 4)]
    return [light - a * max(-1.0, min(k - 3, 9 - k, 1.0)) for k in turns]


def oklab(light: float, a: float, b: float) -> list[float]:
    """CSS Color 4, 10: OKLab to linear light by Ottosson's matrices, then sRGB's transfer."""
    long = (light + 0.3963377774 * a + 0.2158037573 * b) ** 3
    medium = (light - 0.1055613458 * a - 0.0638541728 * b) ** 3
    short = (light - 0.0894841775 * a - 1.2914855480 * b) ** 3
    linear = (
        4.0767416621 * long - 3.3077115913 * medium + 0.2309699292 * short,
        -1.2684380046 * long + 2.6097574011 * medium - 0.3413193965 * short,
        -0.0041960863 * long - 0.7034186147 * medium + 1.7076147010 * short,
    )
    return [12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055 for x in linear]


share = st.floats(0, 1).map(lambda x: round(x, 4))
hue = st.floats(-720, 720).map(lambda x: round(x, 3))
ANGLES: dict[str, float] = {"": 1.0, "deg": 1.0, "DEG": 1.0, "turn": 1 / 360, "rad": math.pi / 180, "grad": 400 / 360}


@given(hue, share, share, st.sampled_from(sorted(ANGLES)), st.booleans())
def test_hsl_and_hwb_are_the_colours_of_their_formulas(
    turn: float, one: float, two: float, unit: str, commas: bool
) -> None:
    """Against CSS's closed forms, within a step of the last bit, in every unit of angle, with commas and without."""
    angle = f"{turn * ANGLES[unit]:.9f}{unit}"
    sign = ", " if commas else " "
    found = parse_colour(f"hsl({sign.join((angle, f'{one:.2%}', f'{two:.2%}'))})")
    assert found is not None
    expected = hsl(turn, round(one, 4), round(two, 4))
    assert all(abs(a - channel(b)) <= 1 for a, b in zip(bytes.fromhex(found.rgb[1:]), expected, strict=True))
    white, black = one / 2, two / 2
    found = parse_colour(f"hwb({angle} {white:.3%} {black:.3%})")
    assert found is not None
    expected = [x * (1 - white - black) + white for x in hsl(turn, 1.0, 0.5)]
    assert all(abs(a - channel(b)) <= 1 for a, b in zip(bytes.fromhex(found.rgb[1:]), expected, strict=True))


@given(st.floats(0.2, 0.9), st.floats(0, 0.06), hue)
def test_oklch_and_oklab_are_the_colours_of_their_formulas(light: float, chroma: float, turn: float) -> None:
    """Against Ottosson's formulas, for colours that a screen shows."""
    a, b = (chroma * f(math.radians(turn)) for f in (math.cos, math.sin))
    expected = oklab(light, a, b)
    for text in (f"oklch({light:.6f} {chroma:.6f} {turn:.6f})", f"OKLAB({light:.4%} {a:.6f} {b:.6f} / 1)"):
        found = parse_colour(text)
        assert found is not None
        assert all(abs(x - channel(y)) <= 1 for x, y in zip(bytes.fromhex(found.rgb[1:]), expected, strict=True))


PROPERTIES = {
    "stroke": (["red", "hsl(9 9% 9%)", "none", "currentColor"], "blue"),
    "fill": (["red", "NONE", "#abc"], "blue"),
    "display": (["none", "inline", "block"], "inline"),
    "visibility": (["hidden", "visible", "COLLAPSE"], "visible"),
    "stroke-width": (["3px", "1mm", "5%"], "7px"),
    "stroke-dasharray": (["none", "0 0px", "3px 1px", "0"], "9px"),
    "clip-path": (["none", "url(#x)"], "none"),
    "cx": (["10px", "5%", "3mm"], "1px"),
    "r": (["10px", "5%", "calc(1px + 2px)"], "1px"),
    "transform-origin": (["3px 4px", "50% 50%", "right"], "1px 1px"),
    "marker": (["none", "url(#m)"], "none"),
}
SOURCES: dict[str, Callable[[str, str, str], str]] = {
    "style": lambda name, value, low: f'<circle class="c" id="i" {low} style="{name}: {value}"/>',
    "important": lambda name, value, low: (
        f'<style>#i {{ {name}: {value} !important }}</style><circle class="c" id="i" {low}/>'
    ),
    "class": lambda name, value, low: f'<style>.c {{ {name}: {value} }}</style><circle class="c" id="i" {low}/>',
    "element": lambda name, value, low: (
        f"<style>circle{{{name.upper()}:{value}}}</style><circle class='c' id='i' {low}/>"
    ),
    "id": lambda name, value, low: (
        f"<style>#i {{ {name}: {value} }} .c {{ {name}: unset }}</style><circle class='c' id='i' {low}/>"
    ),
    "descendant": lambda name, value, low: (
        f"<style>@media screen {{ svg > circle[id=i]:first-of-type {{ {name}: {value}; }} }}</style>"
        f"<circle class='c' id='i' {low}/>"
    ),
    "layer": lambda name, value, low: (
        f"<style>@layer a {{ circle {{ {name}: {value} !important }} }} #i {{ {name}: unset !important }}</style>"
        f"<circle class='c' id='i' {low}/>"
    ),
    "variable": lambda name, value, low: f"<circle class='c' id='i' {low} style='--v: {value}; {name}: var(--v)'/>",
    "broken above": lambda name, value, low: (
        f"<style>circle {{ {name}: {value}; {name}: ] }}</style><circle class='c' id='i' {low} style='{name}:'/>"
    ),
}


def summary(drawing: ReadDrawing) -> object:
    """All that is read of a drawing, but for lines and numbers of elements."""
    shapes = [
        (shape.paths.bounds, shape.stroke, shape.fill, shape.stroke_width, shape.paths.kind.tolist())
        for shape in drawing.shapes
    ]
    return shapes, dict(drawing.ignored)


@settings(max_examples=60)
@given(st.data())
def test_a_property_means_the_same_wherever_it_is_written(data: st.DataObject) -> None:
    """In a style attribute, in rules of any kind, by a variable: the drawing is the one of the attribute."""
    name = data.draw(st.sampled_from(sorted(PROPERTIES)))
    values, other = PROPERTIES[name]
    value = data.draw(st.sampled_from(values))
    source = data.draw(st.sampled_from(sorted(SOURCES)))
    base = {"r": "4", "stroke": "#00f", "transform": "rotate(9)"}
    lower = base | ({name: other} if name != "marker" else {})

    def text(attributes: dict[str, str]) -> str:
        return " ".join(f'{key}="{each}"' for key, each in attributes.items())

    if name == "marker":
        expected = svg(f"<circle {text(base)} marker-start='{value}'/>")
    else:
        expected = svg(f"<circle {text(base | {name: value})}/>")
    assert summary(svg(SOURCES[source](name, value, text(lower)))) == summary(expected)


def test_that_comparison_sees_another_value() -> None:
    """Each property's values make different drawings of at least two kinds."""
    for name, (values, _) in PROPERTIES.items():
        if name != "marker":
            base = {"r": "4", "stroke": "#00f", "transform": "rotate(9)"}
            texts = [" ".join(f'{key}="{each}"' for key, each in (base | {name: value}).items()) for value in values]
            assert len({str(summary(svg(f"<circle {text}/>"))) for text in texts}) > 1


SIMPLE = st.text("abc-:; \t10#,.%\nfillstroke", max_size=40)


@given(SIMPLE)
def test_simple_styles_are_split_as_css_splits_them(text: str) -> None:
    """Styles without brackets and quotes are not tokenised: the declarations are those of the tokeniser."""
    whole = style_attribute(f"{text};fill:none;{text}")
    tokens, _ = read_declarations(f"{text};fill:none;{text}", Origin.STYLE)

    def squeezed(values: dict[str, tuple[str, ...]]) -> dict[str, str]:
        return {name: " ".join(each[-1].split()) for name, each in values.items()}

    assert squeezed(whole.normal) == squeezed(tokens.normal)


HOSTILE = {
    "brackets": '<path d="M0 0h1" stroke="red" style="fill: ' + "(" * 100_000 + '"/>',
    "sheet": f"<style>{'a{' * 100_000}</style>",
    "long sheet": f"<style>{'a{b:c}' * 1_000_000}</style>",
    "custom": "<g style='" + ";".join(f"--a{k}:1" for k in range(2000)) + "'/>",
    "a circle of many variables": LINE.format(
        "style='" + ";".join(f"--a{k}: var(--a{(k + 1) % 400})" for k in range(400)) + "'"
    ),
    "a long chain of brackets and variables": LINE.format(
        "style='" + ";".join(f"--a{k}: {'a(' * 30}var(--a{k + 1}){')' * 30}" for k in range(400)) + "'"
    ),
    "a long name of a layer": "<style>@layer " + ".".join("a" * 60_000) + " { path { fill: red } }</style>",
    "many long names of layers": "<style>" + ("@layer " + ".".join("a" * 1_000) + ";") * 100 + "</style>",
    "universal selectors": "<style>"
    + "".join(f"g g g g g g .x{k} > * {{ fill: red }}" for k in range(300))
    + "</style>"
    + '<g class="x1">' * 900
    + "</g>" * 900,
    "siblings": f"<style>g:nth-last-of-type(2n) {{ fill: red }}</style>{'<g/>' * 3_000}",
    "transform": '<path d="M0 0h1" style="transform: scale(1e300) scale(1e300)"/>',
    "scale": '<path d="M0 0h1" style="scale: 1e308%" stroke="red"/>',
    "calc": f'<circle r="calc({"(" * 1000}1px{")" * 1000})"/>',
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_styles_give_one_message(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """One DrawingError that names the file, whatever grows."""
    monkeypatch.setattr("voronoi_tiles.formats.svg.selectors.WORK_MAX", 50_000)
    with pytest.raises(DrawingError) as caught:
        svg(HOSTILE[name])
    assert str(caught.value).startswith("t.svg")
    assert "\n" not in str(caught.value)


def test_variables_in_brackets_are_replaced() -> None:
    """A variable counts wherever it stands: in a function, and in brackets in it."""
    drawing = svg("<circle stroke='red' style='--a: 2; r: calc((var(--a) + 1) * 1px)'/>")
    assert summary(drawing) == summary(svg("<circle stroke='red' r='3'/>"))
    assert not drawing.ignored


def test_variables_that_grow_are_none() -> None:
    """A bomb of variables has no value; what uses it is named."""
    doubling = ";".join(f"--a{k}: var(--a{k - 1}) var(--a{k - 1})" for k in range(1, 60))
    drawing = svg(LINE.format(f'fill="none" style="--a0: red; {doubling}; stroke: var(--a59)"'))
    assert drawing.ignored == {"paint 'var(--a59)'": 1}
    deep = "var(--a," * 60 + "red" + ")" * 60
    assert svg(LINE.format(f'style="stroke: {deep}"')).shapes[0].stroke == "#ff0000"


@given(
    st.sampled_from(["oklch({})", "oklab({})", "lab({})", "lch({})", "hsl({})", "hwb({})", "rgb({})"])
    | st.sampled_from(["srgb-linear", "display-p3", "rec2020", "prophoto-rgb", "xyz"]).map("color({} {{}})".format),
    st.lists(st.sampled_from(["1e308", "-1e308%", "1e154", "-1e103", "1e400", "0.5", "none"]), min_size=3, max_size=3),
)
def test_colours_of_numbers_beyond_all_bounds_are_seen(notation: str, numbers: list[str]) -> None:
    """A colour with numbers that nobody means is shown in some colour, or named: no line vanishes."""
    said = notation.format(" ".join(numbers))
    drawing = svg(LINE.format(f'fill="none" stroke="{said}"'))
    assert [shape.stroke is not None for shape in drawing.shapes] == [True]


def test_rules_that_are_not_read_are_counted_and_hide_nothing() -> None:
    """At-rules with conditions, selectors beyond what is matched, rules in rules; not what is for paper or a mouse."""
    drawing = svg(
        f"""<style>@import "x.css"; @supports (fill: red) {{ path {{ display: none }} }}
        @media (min-width: 3px) {{ path {{ display: none }} }} path:has(g) {{ display: none }}
        @media print {{ path {{ display: none }} }} path:hover {{ display: none }} path::before {{ display: none }}
        path {{ stroke: red; g {{ fill: red }} }}</style>{LINE.format("")}"""
    )
    assert [shape.stroke for shape in drawing.shapes] == ["#ff0000"]
    assert drawing.ignored == {"style rule": 5}
