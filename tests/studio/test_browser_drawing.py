"""Drawing and editing in a real browser: every tool by the mouse, nodes, snapping, sites, groups, and fingers."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from contextlib import contextmanager
from math import atan2, degrees, hypot, sin, sqrt
from typing import Any

import pytest
from helpers.studio import Studio, Window, opened, running

from voronoi_tiles.designs.starters import symmetry_of
from voronoi_tiles.groups.wallpaper import GROUPS

WING = [[6.0, 9.0], [20.0, 4.0], [25.0, 18.0]]
DESIGN = {"schema": 1, "group": "p4", "cell": {"a": 60}, "site": [{"name": "bird", "strokes": [{"polyline": WING}]}]}
PENS = {"schema": 1, "group": "p1", "cell": {"a": 60, "b": 60, "angle": 90}, "site": [{"strokes": []}]}

SMALL = {"width": 900, "height": 640}
"""The size of the window, for few pixels to draw without a graphics processor."""

NUMBERS_CHANGED = """old => {
    const fields = [...document.querySelectorAll("[data-key^=picture]")];
    return fields.some((field, k) => Number(field.value) !== old[k]);
}"""
"""Whether the panel has other numbers of the picture to trace."""

NEAR = 0.25
"""How near to the pointer a coordinate is, that is a pixel and its rounding; mm."""


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    """A studio on a new design."""
    with running(tmp_path_factory.mktemp("drawing")) as found:
        yield found


@pytest.fixture(scope="module")
def page(chromium: Any, studio: Studio) -> Iterator[Window]:
    """Its page, for all tests."""
    with opened(chromium, studio, viewport=SMALL) as found:
        yield found


@pytest.fixture
def window(page: Window) -> Window:
    """The page with the polyline of three points."""
    page.begin(DESIGN)
    return page


@pytest.fixture
def empty(page: Window) -> Window:
    """The page with nothing drawn, in a group without rotation centres but the origin to snap to."""
    page.begin(PENS, "refused")
    return page


@contextmanager
def held(window: Window, key: str) -> Iterator[None]:
    """Hold a key."""
    window.page.keyboard.down(key)
    yield
    window.page.keyboard.up(key)


def chosen(window: Window) -> list[str]:
    """The names of the strokes that are selected."""
    found: list[str] = window.page.locator(".stroke[aria-expanded=true]").all_inner_texts()
    return found


def near(*expected: float) -> Any:
    """Numbers that are as near as a pointer places them."""
    return pytest.approx(list(expected), abs=NEAR)


def short(point: list[float], digits: int) -> bool:
    """Whether numbers have so few digits behind the point."""
    return point == [round(value, digits) for value in point]


def turn(vector: list[float]) -> float:
    """How far the direction of a vector is from a multiple of 15 degrees; degrees."""
    angle = degrees(atan2(vector[1], vector[0])) % 15
    return min(angle, 15 - angle)


# Tools


def test_copies_of_strokes_are_drawn_wherever_these_are(page: Window) -> None:
    """A stroke ten cells away has its copies in the window, faint, and none beside them."""
    page.begin({**DESIGN, "site": [{"strokes": [{"segment": [[610, 10], [620, 22]]}]}]})
    alpha = (
        "([x, y]) => { const canvas = document.getElementById('overlay'); const box = canvas.getBoundingClientRect();"
        " return canvas.getContext('2d').getImageData(x - box.left - 1, y - box.top - 1, 3, 3).data"
        ".filter((_, k) => k % 4 === 3).reduce((one, other) => Math.max(one, other)); }"
    )
    on, beside = (page.page.evaluate(alpha, list(page.at(*at))) for at in ((15, 16), (20, 10)))
    assert on > 40
    assert beside == 0


def test_pen_with_tangents(empty: Window) -> None:
    """What is dragged is half of a tangent's handles, a third of the tangent: the paper's Hermite curves."""
    empty.page.keyboard.press("p")
    empty.drag((6, 22), (10, 26))
    empty.drag((20, 22), (24, 20))
    empty.page.keyboard.press("Enter")
    [stroke] = empty.strokes
    assert stroke["hermite"] == [near(6, 22), near(20, 22)]
    assert stroke["tangents"] == [pytest.approx([12, 12], abs=1), pytest.approx([12, -6], abs=1)]
    assert chosen(empty) == ["Pen curve 1"]


def test_alt_breaks_a_tangent(empty: Window) -> None:
    """The handle before stays where it was, and the curve is a Bezier curve from then on."""
    page = empty.page
    page.keyboard.press("p")
    empty.drag((6, 22), (10, 26))
    page.mouse.move(*empty.at(20, 22))
    page.mouse.down()
    page.mouse.move(*empty.at(24, 22), steps=4)
    with held(empty, "Alt"):
        page.mouse.move(*empty.at(20, 30), steps=4)
        page.mouse.up()
    empty.click(36, 22)
    page.keyboard.press("Enter")
    [stroke] = empty.strokes
    _, out, before, middle, after, _, last = stroke["bezier"]
    assert (out, before, middle, after, last) == (near(10, 26), near(16, 22), near(20, 22), near(20, 30), near(36, 22))


def test_shift_keeps_to_fifteen_degrees(empty: Window) -> None:
    """Tangents of the pen, and the points of a line."""
    page = empty.page
    page.keyboard.press("p")
    with held(empty, "Shift"):
        empty.drag((6, 22), (10.3, 26.9))
    empty.click(30, 30)
    page.keyboard.press("Enter")
    tangent = empty.strokes[0]["hermite" if "hermite" in empty.strokes[0] else "bezier"]
    assert tangent
    handle = empty.strokes[0].get("tangents", [[b - a for a, b in zip(*tangent[:2], strict=True)]])[0]
    assert hypot(*handle) > 1
    assert turn(handle) < 1e-6

    page.keyboard.press("l")
    empty.click(6, 40)
    with held(empty, "Shift"):
        empty.click(27, 47)
    page.keyboard.press("Enter")
    start, end = empty.strokes[1]["segment"]
    assert end == pytest.approx([27, 47], abs=2)
    assert turn([b - a for a, b in zip(start, end, strict=True)]) < 0.01


def test_space_moves_the_point_that_the_pen_places(empty: Window) -> None:
    """Its tangent goes with it."""
    page = empty.page
    page.keyboard.press("p")
    page.mouse.move(*empty.at(10, 20))
    page.mouse.down()
    page.mouse.move(*empty.at(14, 20), steps=4)
    with held(empty, " "):
        page.mouse.move(*empty.at(16, 26), steps=4)
    page.mouse.up()
    empty.click(36, 22)
    page.keyboard.press("Enter")
    [stroke] = empty.strokes
    points = stroke.get("hermite") or stroke["bezier"][::3]
    assert points == [near(12, 26), near(36, 22)]


def test_a_click_on_the_first_point_closes(empty: Window) -> None:
    """With the pen, and with every tool that places points; where too few points are, nothing is closed or lost."""
    page = empty.page
    corners = [(10.0, 10.0), (40.0, 10.0), (36.0, 40.0)]
    for key, kind in (("p", "Pen curve"), ("c", "Curve through points"), ("s", "B-spline"), ("l", "Line")):
        before = len(empty.strokes)
        page.keyboard.press(key)
        for corner in corners:
            empty.click(*corner)
        empty.click(*corners[0])
        stroke = empty.strokes[-1]
        assert len(empty.strokes) == before + 1
        assert chosen(empty) == [f"{kind} {before + 1}"]
        [points] = [value for key, value in stroke.items() if key not in ("closed", "tangents")]
        assert stroke.get("closed") or points[0] == points[-1], stroke
    page.keyboard.press("l")
    empty.click(10, 50)
    empty.click(40, 50)
    empty.click(10, 50)
    empty.click(40, 58)
    page.keyboard.press("Enter")
    assert len(empty.strokes[-1]["polyline"]) == 3


def test_a_double_click_ends_a_stroke(empty: Window) -> None:
    """And is one point."""
    page = empty.page
    for key in "pcl":
        page.keyboard.press(key)
        empty.click(10, 10)
        empty.click(40, 10)
        page.mouse.dblclick(*empty.at(36, 40))
        page.mouse.move(*empty.at(20, 50))
    assert [len(next(iter(stroke.values()))) for stroke in empty.strokes] == [3, 3, 3]


def test_circles_points_freehand_and_splines(empty: Window) -> None:
    """A circle by a drag and by two clicks, points, a line that is dragged, few curves of a hand's many points."""
    page = empty.page
    page.keyboard.press("o")
    empty.drag((20, 20), (24, 22))
    empty.click(40, 20)
    empty.click(44, 20)
    for key, x in (("d", 10), (".", 14)):
        page.keyboard.press(key)
        empty.click(x, 50)
    page.keyboard.press("l")
    empty.drag((5, 5), (15, 8))
    page.keyboard.press("Enter")
    page.keyboard.press("s")
    for at in ((20, 40), (24, 48), (30, 40), (36, 48)):
        empty.click(*at)
    page.keyboard.press("Enter")
    page.keyboard.press("b")
    page.mouse.move(*empty.at(5, 30))
    page.mouse.down()
    for k in range(1, 41):
        page.mouse.move(*empty.at(5 + k, 30 + 4 * sin(k / 6)))
    page.mouse.up()
    one, other, point, dot, line, spline, freehand = empty.strokes
    assert (one["circle"], one["radius"]) == (near(20, 20), pytest.approx(hypot(4, 2), abs=NEAR))
    assert short([one["radius"], other["radius"]], 2)
    assert (other["circle"], other["radius"]) == (near(40, 20), pytest.approx(4, abs=NEAR))
    assert (point["point"], dot["point"]) == (near(10, 50), near(14, 50))
    assert line["segment"] == [near(5, 5), near(15, 8)]
    assert len(spline["bspline"]) == 4
    curves = (len(freehand["bezier"]) - 1) / 3
    assert curves <= 8
    assert freehand["bezier"][-1] == near(45, 30 + 4 * sin(40 / 6))


def test_the_pen_undoes_the_point_in_the_hand(empty: Window) -> None:
    """Ctrl+Z while the button is held takes that point back, and no other."""
    page = empty.page
    page.keyboard.press("p")
    for at in ((6, 22), (20, 26)):
        empty.click(*at)
    text = empty.text
    page.mouse.move(*empty.at(34, 22))
    page.mouse.down()
    page.mouse.move(*empty.at(38, 26), steps=4)
    page.keyboard.press("Control+z")
    page.mouse.up()
    page.keyboard.press("Enter")
    assert empty.text == text


# Editing


def test_double_clicks_insert_and_smooth(window: Window) -> None:
    """On a stroke a point is put in, on a point the corner becomes smooth; each is a step."""
    page = window.page
    before = window.text
    page.mouse.dblclick(*window.at(13, 6.5))
    assert window.strokes[0]["polyline"] == [WING[0], near(13, 6.5), *WING[1:]]
    assert short(window.strokes[0]["polyline"][1], 4)
    inserted = window.text
    page.mouse.dblclick(*window.at(20, 4))
    assert "bezier" in window.strokes[0]
    page.keyboard.press("Control+z")
    assert window.text == inserted
    page.keyboard.press("Control+z")
    assert window.text == before


def test_alt_pulls_handles(window: Window) -> None:
    """Out of a corner, both alike; then one alone."""
    window.choose("Line 1")
    with held(window, "Alt"):
        window.drag((20, 4), (26, 6))
    assert window.strokes[0]["bezier"][2:5] == [near(14, 2), near(20, 4), near(26, 6)]
    assert all(short(point, 2) for point in window.strokes[0]["bezier"])
    with held(window, "Alt"):
        window.drag((26, 6), (20, 10))
    assert window.strokes[0]["bezier"][2:5] == [near(14, 2), near(20, 4), near(20, 10)]


def test_delete_heals_and_shift_delete_cuts(window: Window) -> None:
    """A point out of the middle: the line goes on without it, or ends there; the stroke is never gone as a whole."""
    page = window.page
    before = window.text
    window.choose("Line 1")
    window.click(20, 4)
    page.keyboard.press("Delete")
    [healed] = window.strokes
    assert healed == {"polyline": [WING[0], WING[2]]}
    page.keyboard.press("Control+z")
    page.mouse.dblclick(*window.at(13, 6.5))
    window.click(13, 6.5)
    page.keyboard.press("Shift+Delete")
    assert len(window.strokes) == 1
    assert window.strokes[0] == {"polyline": [WING[1], WING[2]]}
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    assert window.text == before
    window.choose("Line 1")
    page.locator("#overlay").focus()
    page.keyboard.press("Delete")
    assert window.strokes == []
    page.keyboard.press("Control+z")
    assert window.text == before


def test_an_end_that_is_dragged_onto_another_joins_it(window: Window) -> None:
    """Its own stroke is closed, with another stroke it becomes one, and the place says so; each is one step back."""
    page = window.page
    page.evaluate(
        "() => { window.written = []; const { fillText } = CanvasRenderingContext2D.prototype;"
        " CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {"
        " window.written.push(text); return fillText.call(this, text, ...rest); }; }"
    )
    page.mouse.dblclick(*window.at(13, 6.5))
    line = window.strokes[0]["polyline"]
    before = window.text
    window.drag((25, 18), (6.2, 8.9))
    assert window.strokes == [{"polyline": line[:3], "closed": True}]
    assert "joins" in page.evaluate("() => window.written")
    assert chosen(window) == ["Line 1"]
    page.keyboard.press("Control+z")
    assert window.text == before

    window.choose("Line 1")
    with held(window, "Control"):
        window.drag((25, 18), (6.2, 8.9))
    assert window.strokes == [{"polyline": [*line[:3], near(6.2, 8.9)]}]
    page.keyboard.press("Control+z")
    window.choose("Line 1")
    window.drag(tuple(line[1]), (19.8, 4.1))
    assert window.strokes[0] == {"polyline": WING}

    page.keyboard.press("p")
    for place in ((30, 12), (32, 20)):
        window.click(*place)
    page.keyboard.press("Enter")
    page.keyboard.press("v")
    pen = window.strokes[1]["hermite"]
    two = window.text
    window.drag(tuple(pen[0]), (25.1, 17.8))
    [joined] = window.strokes
    assert joined["bezier"][::3] == [*WING, pen[1]]
    page.keyboard.press("Control+z")
    assert window.text == two


def test_ends_are_joined_without_dragging(window: Window) -> None:
    """By the list and J alone: the nearest ends of two strokes, by a line, and a stroke with itself; or the button."""
    page = window.page
    page.keyboard.press("l")
    for place in ((30, 12), (26, 20)):
        window.click(*place)
    page.keyboard.press("Enter")
    [start, end] = window.strokes[1]["segment"]
    two = window.text
    rows = page.locator(".stroke")
    rows.nth(0).focus()
    page.keyboard.press("Enter")
    rows.nth(1).focus()
    page.keyboard.press("Shift+Enter")
    page.locator("#overlay").focus()
    page.keyboard.press("j")
    assert window.strokes == [{"polyline": [*WING, end, start]}]
    page.locator("#panel-drawing").get_by_role("button", name="Close", exact=True).click()
    assert window.strokes == [{"polyline": [*WING, end, start], "closed": True}]
    refused = page.get_by_text("Nothing here can be joined.")
    page.locator("#overlay").focus()
    for key in ("Escape", "Control+z"):
        page.keyboard.press("j")
        refused.wait_for()
        page.keyboard.press(key)
        refused.wait_for(state="detached")
    page.keyboard.press("Control+z")
    assert window.text == two


def test_the_ends_that_are_chosen_are_joined(window: Window) -> None:
    """Those far from each other, by two clicks and one with Shift; the list's strokes stay chosen at another click."""
    page = window.page
    page.keyboard.press("l")
    for place in ((30, 12), (26, 20)):
        window.click(*place)
    page.keyboard.press("Enter")
    start, end = window.strokes[1]["segment"]
    page.keyboard.press("v")
    window.click(13, 6.5)
    window.click(6, 9)
    with held(window, "Shift"):
        window.click(30, 12)
    page.locator(".point.chosen").nth(1).wait_for()
    page.keyboard.press("j")
    [joined] = window.strokes
    assert joined == {"polyline": [WING[2], WING[1], WING[0], start, end]}
    # A row that is chosen has the colour of the tool in hand, under the pointer as well.
    alike = """is => {
        const places = [".stroke:hover", "[data-tool][aria-pressed=true]"];
        const [row, tool] = places.map((place) => document.querySelector(place));
        return row && (getComputedStyle(row).backgroundColor === getComputedStyle(tool).backgroundColor) === is;
    }"""
    for modifier, names in (
        (None, ["Line 1"]),
        ("Shift", []),
        ("Shift", ["Line 1"]),
        ("Control", []),
        (None, ["Line 1"]),
    ):
        page.locator(".stroke").click(modifiers=[modifier] if modifier else [])
        page.locator(f".stroke[aria-expanded={'true' if names else 'false'}]").wait_for()
        page.wait_for_function(alike, arg=bool(names))
        assert chosen(window) == names


def test_a_rubber_band_takes_strokes_and_then_points(window: Window) -> None:
    """What it surrounds is moved together."""
    window.drag((2, 26), (28, 1))
    assert chosen(window) == ["Line 1"]
    with held(window, "Shift"):
        window.drag((16, 22), (28, 1))
    assert window.page.locator(".point.chosen").count() == 2
    window.page.keyboard.press("Shift+ArrowUp")
    assert window.strokes[0]["polyline"] == [WING[0], [20, 5], [25, 19]]


def test_tab_and_nudges(window: Window) -> None:
    """Tab goes from point to point; nudges that follow each other are one step."""
    page = window.page
    before = window.text
    window.click(13, 6.5)
    page.keyboard.press("Tab")
    page.keyboard.press("Tab")
    for _ in range(3):
        page.keyboard.press("ArrowRight")
    assert window.strokes[0]["polyline"] == [WING[0], [20.3, 4], WING[2]]
    page.keyboard.press("Control+z")
    assert window.text == before
    page.keyboard.press("Control+y")
    window.click(13, 6.5)
    page.keyboard.press("Control+Shift+ArrowUp")
    assert window.strokes[0]["polyline"] == [[6, 19], [20.3, 14], [25, 28]]


def test_escape_restores_what_is_dragged(window: Window) -> None:
    """The drag is over: what the pointer does then moves nothing, and there is no step to undo."""
    page = window.page
    before = window.text
    window.choose("Line 1")
    page.mouse.move(*window.at(20, 4))
    page.mouse.down()
    page.mouse.move(*window.at(15, 12), steps=4)
    assert window.text != before
    page.keyboard.press("Escape")
    assert window.text == before
    page.mouse.move(*window.at(10, 20), steps=2)
    page.mouse.up()
    assert window.text == before


def test_shift_drags_along_an_axis(window: Window) -> None:
    """The other coordinate stays to the digit."""
    window.choose("Line 1")
    with held(window, "Shift"):
        window.drag((25, 18), (26, 23))
    assert window.strokes[0]["polyline"][2] == [25, pytest.approx(23, abs=NEAR)]


def test_points_snap_to_rotation_centres(window: Window) -> None:
    """Exactly; with Ctrl they do not."""
    page = window.page
    x, y = window.at(30, 30)
    window.choose("Line 1")
    page.mouse.move(*window.at(25, 18))
    page.mouse.down()
    page.mouse.move(x + 4, y - 3, steps=4)
    page.mouse.up()
    assert window.strokes[0]["polyline"][2] == [30, 30]
    page.keyboard.press("Control+z")
    window.choose("Line 1")
    page.mouse.move(*window.at(25, 18))
    page.mouse.down()
    with held(window, "Control"):
        page.mouse.move(x + 4, y - 3, steps=4)
        page.mouse.up()
    moved = window.strokes[0]["polyline"][2]
    assert moved != [30, 30]
    assert moved == pytest.approx([30, 30], abs=2)
    window.begin({**DESIGN, "group": "p3"})
    window.choose("Line 1")
    window.drag((20, 4), (30.3, 17.2))
    assert window.strokes[0]["polyline"][1] == pytest.approx([30, 10 * sqrt(3)], abs=1e-12)


def test_wheel_space_and_middle_button(window: Window) -> None:
    """The wheel zooms at the pointer; Space or the middle button and a drag move the window, and no stroke."""
    page = window.page
    before = window.text
    x, y = window.at(20, 4)
    size = hypot(*(b - a for a, b in zip(window.at(0, 0), window.at(60, 0), strict=True)))
    page.mouse.move(x, y)
    page.mouse.wheel(0, -240)
    page.wait_for_function(
        "([at, size]) => studio.toPage([60, 0])[0] - studio.toPage([0, 0])[0] > 1.2 * size", arg=[[0, 0], size]
    )
    assert window.at(20, 4) == pytest.approx((x, y), abs=1)
    page.locator("#overlay").focus()
    with held(window, " "):
        page.mouse.down()
        page.mouse.move(x + 50, y + 30, steps=3)
        page.mouse.up()
    assert window.at(20, 4) == pytest.approx((x + 50, y + 30), abs=1)
    page.mouse.down(button="middle")
    page.mouse.move(x, y, steps=3)
    page.mouse.up(button="middle")
    assert window.at(20, 4) == pytest.approx((x, y), abs=1)
    page.keyboard.press("Control+0")
    assert window.at(60, 0)[0] - window.at(0, 0)[0] == pytest.approx(size)
    assert window.text == before


# Sites, groups, cells


def test_several_sites(window: Window) -> None:
    """A second site is drawn into, named, and taken out; undo leads back through all of it."""
    page = window.page
    before = window.text
    page.get_by_role("button", name="Add a site").click()
    page.keyboard.press("l")
    window.click(8, 24)
    window.click(22, 25)
    page.keyboard.press("Enter")
    window.wait()
    assert page.locator("#measure").inner_text().startswith("bird: ")
    sites = window.design["site"]
    assert [len(site["strokes"]) for site in sites] == [1, 1]
    name = page.get_by_label("Name of site 2")
    name.fill("bird")
    name.press("Enter")
    assert window.design["site"] == sites
    assert name.get_attribute("aria-invalid") == "true"
    said = "field => document.getElementById(field.getAttribute('aria-describedby')).textContent"
    assert "bird" in name.evaluate(said)
    # What is refused stays to be mended while the list is made anew.
    page.get_by_label("Draw into site bird").check()
    page.locator("#overlay").focus()
    page.keyboard.press("Control+a")
    page.locator(".stroke[aria-expanded=true]").nth(1).wait_for()
    assert name.input_value() == "bird"
    assert (name.get_attribute("aria-invalid"), "bird" in name.evaluate(said)) == ("true", True)
    name.press("Escape")
    assert (name.input_value(), name.get_attribute("aria-invalid")) == ("site2", "false")
    name.fill("fish")
    name.press("Enter")
    assert window.design["site"][1]["name"] == "fish"
    page.get_by_role("button", name="Take out site fish").click()
    assert window.text == before
    for _ in range(4):
        page.get_by_role("button", name="Undo").click()
    assert window.text == before
    page.keyboard.press("l")
    window.click(8, 24)
    window.click(22, 25)
    page.keyboard.press("Enter")
    assert len(window.strokes) == 2


def test_group_and_cell_by_the_keyboard(window: Window) -> None:
    """Arrow keys go through the groups, Enter takes one, and the one before is as it was.

    The cell's sides take units; the file's units leave the size as it is.
    """
    page = window.page
    before = window.text
    page.get_by_role("tab", name="Symmetry").click()
    for group in GROUPS:
        radio = page.get_by_role("radio", name=f"{group}: {symmetry_of(group)}", exact=True)
        assert radio.get_attribute("data-group") == group
    page.get_by_role("heading", name="Group p4: quarter turns").wait_for()
    page.locator("[data-group=p4]").focus()
    page.keyboard.press("ArrowRight")
    assert window.text == before
    page.keyboard.press("Enter")
    assert window.design["group"] != "p4"
    assert page.evaluate("() => document.activeElement.dataset.group") == window.design["group"]
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("Enter")
    assert window.text == before
    side = page.get_by_label("Side a, mm")
    side.fill("2.5in")
    side.press("Enter")
    assert window.design["cell"]["a"] == pytest.approx(63.5)
    page.get_by_label("Units of the file").select_option("in")
    assert window.design["units"] == "in"
    assert window.design["cell"]["a"] == pytest.approx(2.5)
    assert window.strokes[0]["polyline"][1] == pytest.approx([20 / 25.4, 4 / 25.4])
    page.wait_for_function("() => document.querySelector('[data-key=a]').value === '63.5'")
    window.wait()
    page.locator("#unit").select_option("in")
    assert "in, " in page.locator("#measure").inner_text()
    page.locator("#unit").select_option("mm")
    for _ in range(4):
        page.get_by_role("button", name="Undo").click()
    assert window.text == before
    # What was moved is said of what is there alone.
    note = page.locator("symmetry-panel").get_by_text("in p4m its copies would touch")
    page.locator("[data-group=p4m]").click()
    note.wait_for()
    page.get_by_role("button", name="Undo").click()
    note.wait_for(state="detached")
    page.get_by_role("button", name="Redo").click()
    note.wait_for()
    page.get_by_role("button", name="Undo").click()
    assert window.text == before


def test_strokes_come_from_the_group_before(window: Window) -> None:
    """After a change of the group they are drawn on their way, then where they are; at once for who asks for that."""
    page = window.page
    window.begin({**DESIGN, "group": "p3"})
    page.evaluate(
        "() => { const now = performance.now.bind(performance); performance.now = () => window.frozen ?? now(); }"
    )

    def again() -> str:
        """What is drawn after the group is changed again, at the beginning of the way."""
        page.evaluate("() => { window.frozen = null; }")
        page.get_by_role("button", name="Undo").click()
        window.wait()
        page.evaluate("() => { window.frozen = performance.now(); }")
        page.get_by_role("button", name="Redo").click()
        window.wait()
        seen: str = page.evaluate(
            "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() =>"
            " done(document.getElementById('overlay').toDataURL()))))"
        )
        return seen

    page.emulate_media(reduced_motion="reduce")
    there = again()
    page.emulate_media(reduced_motion="no-preference")
    assert again() != there
    page.evaluate("() => { window.frozen = null; }")
    page.wait_for_function("there => document.getElementById('overlay').toDataURL() === there", arg=there)


OVERHEAR = """() => {
    const [send, heard] = [WebSocket.prototype.send, []];
    window.heard = heard;
    WebSocket.prototype.send = function (text) {
        heard.length || this.addEventListener("message", (event) => heard.push(JSON.parse(event.data)));
        heard.push(JSON.parse(text));
        send.call(this, text);
    };
    window.deaf = () => { WebSocket.prototype.send = send; };
}"""
"""What the page and the server say to each other from now on goes into `heard`."""


def test_pictures_of_groups_are_what_a_click_gives(window: Window) -> None:
    """In all 17 the design that is pictured is the one that is there after the click, and has the same outlines."""
    page = window.page
    page.evaluate(OVERHEAR)
    window.begin({**DESIGN, "cell": {"a": 61}})
    page.get_by_role("tab", name="Symmetry").click()
    page.wait_for_function("""() => {
        const heard = window.heard.filter(({ type }) => type === "thumbnail");
        window.asked = heard.filter(({ design }) => design?.cell.a === 61);
        window.pictures = heard.filter(({ tiles, rev }) => tiles && window.asked.some((one) => one.rev === rev));
        return window.pictures.length === 17;
    }""")
    designs = {message["rev"]: message["design"] for message in page.evaluate("() => window.asked")}
    pictures = {designs[picture["rev"]]["group"]: picture for picture in page.evaluate("() => window.pictures")}
    assert set(pictures) == set(GROUPS)
    moved = 0
    for group, picture in pictures.items():
        page.locator(f"[data-group={group}]").click()
        assert window.design == designs[picture["rev"]]
        moved += window.design["site"] != DESIGN["site"]
        window.wait()
        tiles = page.evaluate("() => window.heard.findLast(({ type }) => type === 'outline').tiles")
        for tile, pictured in zip(tiles, picture["tiles"], strict=True):
            assert (tile["path"], tile["operations"]) == (pictured["path"], pictured["operations"])
    assert 3 < moved < 17
    page.evaluate("() => window.deaf()")


# Fields


def test_fields_keep_the_focus_and_leave_undo_to_the_drawing(window: Window) -> None:
    """Tab goes on from a field that was changed; Ctrl+Z takes back what a field has done once it is done."""
    page = window.page
    before = window.text
    page.get_by_role("tab", name="Symmetry").click()
    side = page.get_by_label("Side a, mm")
    side.fill("90")
    side.press("Enter")
    assert window.design["cell"]["a"] == pytest.approx(90)
    page.wait_for_function("() => document.activeElement.dataset.key === 'a'")
    page.keyboard.press("Control+z")
    assert window.text == before
    page.get_by_role("tab", name="Job").click()
    page.get_by_label("Margin, mm").fill("5")
    page.keyboard.press("Tab")
    page.wait_for_function("() => document.activeElement.dataset.key === 'job-fit'")
    page.get_by_label("Kerf, mm").fill("0.2")
    page.keyboard.press("Tab")
    page.wait_for_function("() => document.activeElement.dataset.key === 'job-edges'")
    page.get_by_role("button", name="Reset").click()
    page.get_by_role("tab", name="Drawing").click()


def test_a_tile_is_made_as_wide_as_it_shall_be(window: Window) -> None:
    """The width of the tile scales the whole design, cell and strokes, and the outline has it."""
    page = window.page
    before = window.text
    page.get_by_role("tab", name="Symmetry").click()
    window.wait()
    field = page.get_by_label("Tile width, mm")
    field.fill("95")
    field.press("Enter")
    window.wait()
    assert page.locator("#measure").inner_text().startswith("95.00 x ")
    page.get_by_role("button", name="Undo").click()
    assert window.text == before
    page.get_by_role("tab", name="Drawing").click()


# Fingers


def test_a_tool_gets_another_letter(window: Window) -> None:
    """In the help, which says so: the tool that has it gets the other, tooltips follow, the browser keeps it."""
    page = window.page
    pen = page.locator("[data-tool=pen]")

    def letters() -> tuple[str | None, str | None]:
        """What the pen's button says."""
        return pen.get_attribute("title"), pen.get_attribute("aria-keyshortcuts")

    page.keyboard.press("?")
    page.keyboard.press("q")  # goes into no field
    page.get_by_label("Letter of Pen", exact=True).focus()
    page.keyboard.press("l")
    page.locator("[data-tool=line][title='Line (P)']").wait_for()
    assert letters() == ("Pen (L)", "l")
    assert page.get_by_label("Letter of Line", exact=True).input_value() == "P"
    page.get_by_text("Type over a letter to change it").wait_for()
    page.keyboard.press("Backspace")
    page.keyboard.press("g")
    page.get_by_role("alert").get_by_text("G does something else").wait_for()
    page.keyboard.press("Backspace")
    page.keyboard.press("q")
    assert page.get_by_text("does something else").count() == 0
    page.keyboard.press("Escape")
    assert letters() == ("Pen (Q)", "q")
    page.keyboard.press("p")
    page.locator("[data-tool=line][aria-pressed=true]").wait_for()
    assert pen.get_attribute("aria-pressed") == "false"
    page.keyboard.press("q")
    assert pen.get_attribute("aria-pressed") == "true"
    assert page.evaluate("() => JSON.parse(localStorage.getItem('voronoi_tiles studio')).letters") == {
        "pen": "q",
        "line": "p",
    }
    page.keyboard.press("?")
    page.get_by_role("button", name="Reset the letters").click()
    assert page.get_by_label("Letter of Pen", exact=True).input_value() == "P"
    page.keyboard.press("Escape")
    assert letters() == ("Pen (P)", "p")


def test_a_picture_to_trace(window: Window) -> None:
    """It is moved, made larger and turned by the pointer, the arrows and as numbers, and lies there again next time."""
    page = window.page
    before = window.text
    page.get_by_role("tab", name="Symmetry").click()
    picture = page.evaluate(
        "() => Object.assign(document.createElement('canvas'), { width: 40, height: 20 }).toDataURL().split(',')[1]"
    )
    file = {"name": "bird.png", "mimeType": "image/png", "buffer": base64.b64decode(picture)}
    page.get_by_label("Picture to trace").set_input_files(file)
    move = page.get_by_role("button", name="Move picture")
    move.click()

    def numbers() -> list[float]:
        """The middle, the width and the turn, as the panel has them."""
        return [float(field.input_value()) for field in page.locator("[data-key^=picture]").all()]

    def changed(key: str, old: str) -> None:
        """Wait until a number is another one."""
        place = f"[data-key='picture {key}']"
        page.wait_for_function("([place, old]) => document.querySelector(place).value !== old", arg=[place, old])

    assert numbers() == [30, 30, 60, 0]
    window.drag((35, 28), (25, 38))
    changed("0", "30")
    assert numbers() == near(20, 40, 60, 0)
    window.drag((50, 55), (5, 70))  # a quarter turn of the corner at the upper right
    changed("turn", "0")
    assert numbers() == pytest.approx([20, 40, 60, 90], abs=1)
    turned = numbers()
    for key, back in (("Control+z", [20, 40, 60, 0]), ("Control+z", [30, 30, 60, 0]), ("Control+y", [20, 40, 60, 0])):
        old = numbers()
        page.keyboard.press(key)
        page.wait_for_function(NUMBERS_CHANGED, arg=old)
        assert numbers() == near(*back)
    page.get_by_role("button", name="Redo").click()
    changed("turn", "0")
    assert numbers() == turned
    assert window.text == before
    for label, text, key in (("Picture width, mm", "2in", "width"), ("Picture turn, degrees", "-30", "turn")):
        old = page.get_by_label(label).input_value()
        page.get_by_label(label).fill(text)
        page.get_by_label(label).press("Enter")
        changed(key, old)
    still = numbers()
    middle = page.get_by_label("Middle of the picture, x").input_value()
    move.focus()
    page.keyboard.press("ArrowUp")
    page.locator("#overlay").focus()
    page.keyboard.press("Shift+ArrowRight")
    changed("0", middle)
    laid = numbers()
    assert laid == near(21, 40.1, 50.8, -30)
    # Arrows are one step, as they are of strokes.
    for key, then in (("Control+z", still), ("Control+Shift+Z", laid)):
        old = numbers()
        page.keyboard.press(key)
        page.wait_for_function(NUMBERS_CHANGED, arg=old)
        assert numbers() == then
    page.locator("#overlay").focus()
    page.keyboard.press("Escape")
    page.locator("#move-picture[aria-pressed=false]").wait_for()
    window.drag((35, 38), (25, 48))
    assert numbers() == laid
    assert window.text == before

    page.reload()
    page.get_by_role("button", name="Begin anew").click()
    page.get_by_label("Picture to trace").set_input_files(file)
    page.get_by_label("Picture width, mm").wait_for(state="attached")
    assert numbers() == laid


def test_fingers(chromium: Any, studio: Studio) -> None:
    """A tap selects, a drag moves a point, a double tap ends a stroke, two fingers zoom and draw nothing."""
    with opened(chromium, studio, has_touch=True, viewport=SMALL) as window:
        page = window.page
        page.get_by_role("button", name="Begin anew").click()
        window.begin(DESIGN)
        session = page.context.new_cdp_session(page)

        def touch(kind: str, *points: tuple[float, float]) -> None:
            places = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(window.at(*point) for point in points)]
            session.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": places})

        page.touchscreen.tap(*window.at(13, 6.5))
        assert chosen(window) == ["Line 1"]
        touch("Start", (20, 4))
        for k in range(1, 6):
            touch("Move", (20 + k, 4 + k / 2))
        touch("End")
        assert window.strokes[0]["polyline"][1] == pytest.approx([25, 6.5], abs=0.5)

        text = window.text
        for tool in ("Line", "Pen", "Point", "Circle", "Freehand"):
            page.get_by_role("button", name=tool, exact=True).click()
            size = window.at(60, 0)[0] - window.at(0, 0)[0]
            places = [window.at(10, 30), window.at(20, 30)]
            touch("Start", (10, 30))
            touch("Start", (10, 30), (20, 30))
            for k in range(1, 6):
                spread = [
                    {"x": places[0][0] - 6 * k, "y": places[0][1], "id": 0},
                    {"x": places[1][0] + 6 * k, "y": places[1][1], "id": 1},
                ]
                session.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": spread})
            touch("End")
            assert window.at(60, 0)[0] - window.at(0, 0)[0] > 1.3 * size, tool
            page.keyboard.press("Control+0")
            assert window.text == text, tool

        page.get_by_role("button", name="Circle", exact=True).click()
        page.touchscreen.tap(*window.at(14, 26))
        page.touchscreen.tap(*window.at(17, 26))
        assert window.strokes[1]["radius"] == pytest.approx(3, abs=0.5)
