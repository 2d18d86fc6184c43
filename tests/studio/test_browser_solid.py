"""The solid in a real browser: seen, turned, changed, refused, downloaded; and where there is no WebGL."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers.outlines import CommandLine
from helpers.studio import Studio, Window, opened, running
from numpy.typing import NDArray
from PIL import Image

import voronoi_tiles as vt
from voronoi_tiles.solid.standing import stand

TEXT = """\
schema = 1
group = "p2"
cell = { a = 40, b = 40, angle = 90 }

[[site]]
name = "bird"
strokes = [{ polyline = [[6.0, 9.0], [12.0, 6.0], [16.0, 13.0]] }]  # its wing

[solid]
height = 25   # of the box
layers = 11
turn = 30
about = [10, 10]
"""
NO_WEBGL = """
const own = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
    return kind.startsWith("webgl") ? null : own.call(this, kind, ...more);
};
"""


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    """A studio on a design that stands."""
    folder = tmp_path_factory.mktemp("solids")
    (folder / "bird.toml").write_text(TEXT, encoding="utf-8")
    with running(folder, "bird.toml") as found:
        yield found


@pytest.fixture(scope="module")
def window(chromium: Any, studio: Studio) -> Iterator[Window]:
    """Its page."""
    options: dict[str, Any] = {"viewport": {"width": 1000, "height": 700}, "device_scale_factor": 2, "has_touch": True}
    with opened(chromium, studio, **options) as found:
        found.wait()
        yield found


@pytest.fixture(autouse=True)
def solid(request: pytest.FixtureRequest) -> None:
    """The design as it is in the file, and its solid, seen as at first; but where a test has a page of its own."""
    if "window" in request.fixturenames:
        window: Window = request.getfixturevalue("window")
        window.begin(json.loads(json.dumps(vt.Design.loads(TEXT).to_dict())))
        window.page.get_by_role("tab", name="Drawing").click()
        window.page.locator("#overlay").focus()
        window.page.keyboard.press("3")
        seen(window)
        window.page.get_by_role("button", name="At an angle").click()


def seen(window: Window) -> None:
    """Wait until what is drawn has its solid, proved."""
    window.page.wait_for_function(
        "() => document.querySelector('.proof')?.dataset.state === 'proved'"
        " && document.querySelector('.proof').textContent.startsWith('proved: closed')",
        timeout=40_000,
    )


def look(window: Window) -> dict[str, Any]:
    """How the solid is looked at."""
    found: dict[str, Any] = window.page.evaluate("() => window.studio.solid().look")
    return found


def photograph(window: Window) -> NDArray[np.uint8]:
    """The window of the solid, without what lies above it: uint8 (height, width, 3)."""
    window.page.evaluate("() => { document.querySelector('.zooms').style.visibility = 'hidden'; }")
    window.page.evaluate("() => document.activeElement.blur()")
    window.page.wait_for_function(
        "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
    )
    shot = window.page.locator("#solid").screenshot()
    window.page.evaluate("() => { document.querySelector('.zooms').style.visibility = ''; }")
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB"))


def test_what_is_seen_is_the_solid(window: Window) -> None:
    """Its box on the screen is that of the program's own mesh and neighbours, to a pixel of CSS; figures are said."""
    window.page.locator("#panel-solid").get_by_label("Apart").fill("0")
    picture = photograph(window)
    ground = picture[0, 0]
    rows, columns = np.nonzero((picture != ground).any(axis=2))
    view = look(window)
    model = stand(vt.Design.loads(TEXT), around=True, apart=False)
    first = model.pieces[0].mesh.vertices
    points = np.concatenate([piece.mesh.vertices for piece in model.pieces])
    points = points - (first.min(axis=0) + first.max(axis=0)) / 2
    turn, tilt = np.radians(view["turn"]), np.radians(view["tilt"])
    x = points[:, 0] * np.cos(turn) + points[:, 1] * np.sin(turn)
    away = points[:, 1] * np.cos(turn) - points[:, 0] * np.sin(turn)
    y = away * np.sin(tilt) + points[:, 2] * np.cos(tilt)
    ratio, (height, width) = view["ratio"], picture.shape[:2]
    assert ratio == 2
    scale = view["scale"] * ratio
    expected = [x.min() * scale + width / 2, height / 2 - y.max() * scale, x.max() * scale + width / 2]
    expected.append(height / 2 - y.min() * scale)
    found = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
    assert np.abs(np.array(found) - expected).max() <= ratio
    assert max(expected[2] - expected[0], expected[3] - expected[1]) > 0.6 * min(width, height)
    said = window.page.locator("solid-panel").inner_text()
    alone = stand(vt.Design.loads(TEXT))
    size = " x ".join(f"{side:.2f}" for side in alone.bounds[1] - alone.bounds[0])
    assert f"{size} mm" in said
    assert f"{alone.volume / 1000:.4g}" in said
    assert f"proved: {alone.proved}" in said


def test_it_is_turned_moved_and_made_larger(window: Window) -> None:
    """By the pointer, the wheel, two fingers and keys; buttons look from sides, and fit it again."""
    page = window.page
    box = page.locator("#solid").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    first = look(window)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 50, y - 25, steps=4)
    page.mouse.up()
    turned = look(window)
    assert (turned["turn"], turned["tilt"]) == (pytest.approx(first["turn"] - 20), pytest.approx(first["tilt"] - 10))
    assert turned["pan"] == [0, 0]
    page.keyboard.down("Shift")
    page.mouse.down()
    page.mouse.move(x + 80, y - 25 + 10, steps=4)
    page.mouse.up()
    page.keyboard.up("Shift")
    moved = look(window)
    assert moved["pan"] == [30, -10]
    assert (moved["turn"], moved["scale"]) == (turned["turn"], turned["scale"])
    page.mouse.wheel(0, -200)
    page.wait_for_function(f"() => window.studio.solid().look.scale > {1.1 * moved['scale']}")
    page.keyboard.press("Control+0")
    page.wait_for_function("() => window.studio.solid().look.pan[0] === 0")
    page.locator("#solid").focus()
    for key in ("ArrowRight", "ArrowUp", "Shift+ArrowLeft", "+"):
        before = look(window)
        page.keyboard.press(key)
        page.wait_for_function(
            "before => JSON.stringify(window.studio.solid().look) !== before",
            arg=json.dumps(before, separators=(",", ":")),
        )
    after = look(window)
    assert after["turn"] == pytest.approx(turned["turn"] - 7.5)
    assert after["tilt"] == pytest.approx(turned["tilt"] - 7.5)
    assert after["pan"][0] == pytest.approx(-40 * 1.4)
    for name, view in (("From above", (0, 90)), ("From the front", (0, 0)), ("At an angle", (-24, 42))):
        page.get_by_role("button", name=name).click()
        found = look(window)
        assert (found["turn"], found["tilt"]) == view
    fingers = page.context.new_cdp_session(page)

    def touch(kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": x + dx, "y": y + dy, "id": k} for k, (dx, dy) in enumerate(places)]
        fingers.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    still = look(window)
    touch("touchStart", (-20, 0))
    touch("touchMove", (-60, 0))
    touch("touchStart", (-60, 0), (60, 0))
    one = look(window)
    assert one["turn"] != still["turn"]
    touch("touchMove", (-60, 30), (60, 30))
    touch("touchMove", (-120, 30), (120, 30))
    touch("touchEnd")
    two = look(window)
    assert two["scale"] == pytest.approx(2 * one["scale"], rel=0.05)
    assert two["pan"][1] == pytest.approx(-30, abs=31)
    assert (two["turn"], two["tilt"]) == (one["turn"], one["tilt"])


def test_the_slider_pulls_neighbours_apart(window: Window) -> None:
    """Without asking the server; at its end one sees between them."""
    page = window.page
    page.get_by_role("button", name="From above").click()
    slider = page.locator("#panel-solid").get_by_label("Apart")
    shares = []
    for apart in ("0", "0.6"):
        slider.fill(apart)
        picture = photograph(window)
        middle = picture[picture.shape[0] // 3 : -picture.shape[0] // 3, picture.shape[1] // 3 : -picture.shape[1] // 3]
        shares.append((middle == picture[0, 0]).all(axis=2).mean())
    assert shares[0] == 0.0
    assert shares[1] > 0.05
    slider.fill("0.2")


def test_what_moves_is_part_of_the_design(window: Window, studio: Studio) -> None:
    """Height and turn are edited, undone and saved, with the file's comments; and the solid follows."""
    page = window.page
    panel = page.locator("#panel-solid")
    height = panel.get_by_label("Height, mm")
    height.fill("1in + 4.6mm")
    height.press("Enter")
    turn = panel.get_by_label("Turn at the top, degrees")
    turn.fill("45")
    turn.press("Enter")
    page.locator("solid-panel dd").get_by_text(" x 30.00 mm").wait_for()
    assert window.design["solid"] == {"height": 30, "layers": 11, "turn": 45, "about": [10, 10]}
    page.keyboard.press("Control+z")
    assert window.design["solid"]["turn"] == 30
    page.wait_for_function("() => document.querySelector('[data-key=turn]').value === '30'")
    seen(window)
    window.save()
    written = (studio.folder / "bird.toml").read_text(encoding="utf-8")
    assert re.search(r"height = 30(\.0)?   # of the box", written)
    assert "# its wing" in written
    solid = vt.Design.load(studio.folder / "bird.toml").standing
    assert solid is not None
    assert (solid.height, solid.turn) == (30.0, 30.0)


def test_what_cannot_stand_is_said(window: Window, tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """In the command line's words; the last solid stays, greyed, until there is one again."""
    page = window.page
    meeting = {"segment": [[3.0, 3.0], [17.0, 17.0]]}
    window.begin({**window.design, "site": [{"strokes": [meeting]}], "solid": {"height": 20.0}})
    page.locator("#overlay").focus()
    page.keyboard.press("3")
    seen(window)
    turn = page.locator("#panel-solid").get_by_label("Turn at the top, degrees")
    turn.fill("90")
    turn.press("Enter")
    alert = page.locator("solid-panel").get_by_role("alert")
    alert.first.wait_for()
    (tmp_path / "bird.json").write_text(json.dumps(window.design), encoding="utf-8")
    done = voronoi_tiles("solid", "bird.json", "-o", "bird.stl", cwd=tmp_path)
    assert done.returncode == 2
    assert alert.first.inner_text() in done.stderr
    assert "at the height" in alert.first.inner_text()
    page.locator("#solid.old").wait_for()
    picture = photograph(window)
    assert len({*map(tuple, picture.reshape(-1, 3).tolist())}) > 50
    assert np.ptp(picture.astype(int), axis=2).max() < 30  # the drawing's colours do not shine through
    page.keyboard.press("Control+z")
    seen(window)
    page.locator("#solid:not(.old)").wait_for()
    assert alert.count() == 0


def test_straight_walls_and_clearance(window: Window, tmp_path: Path) -> None:
    """A design lies flat and stands again by buttons; a prism has a clearance; what is wrong is said by its field."""
    page = window.page
    page.get_by_role("button", name="Straight walls").click()
    page.wait_for_function("() => !('solid' in window.studio.design())")
    panel = page.locator("#panel-solid")
    for label, value in (("Height, mm", "6"), ("Clearance, mm", "0.5")):
        panel.get_by_label(label).fill(value)
        panel.get_by_label(label).press("Enter")
    page.locator("solid-panel dd").get_by_text(" x 6.00 mm").wait_for()
    seen(window)
    assert "neighbours at least 0.5" in page.locator(".proof").inner_text()
    panel.get_by_label("Chamfer, mm").fill("3")
    panel.get_by_label("Chamfer, mm").press("Enter")
    wrong = page.locator("#panel-solid [data-key=solid-chamfer][aria-invalid=true]")
    wrong.wait_for()
    panel.get_by_label("Chamfer, mm").fill("0.5")
    panel.get_by_label("Chamfer, mm").press("Enter")
    seen(window)
    job = vt.SolidJob(height=6, clearance=0.5, chamfer=0.5)
    design = vt.Design.from_dict(window.design, name="bird")
    vt.extrude(design.tessellate(), job).save(tmp_path / "bird.3mf")
    page.locator("solid-panel").get_by_role("button", name="Download").click()
    with page.expect_download() as found:
        page.get_by_role("dialog").get_by_role("button", name="Download").click()
    assert found.value.suggested_filename.endswith(".3mf")
    assert Path(found.value.path()).read_bytes() == (tmp_path / "bird.3mf").read_bytes()
    page.locator("dialog").wait_for(state="detached")
    page.locator("solid-panel").get_by_role("button", name="Reset").click()
    page.get_by_role("button", name="Let the strokes move").click()
    page.wait_for_function("() => window.studio.design().solid?.turn === 30")
    layers = page.locator("#panel-solid").get_by_label("Layers", exact=True)
    assert layers.input_value() == str(vt.Solid(20).layers)
    layers.fill("41")
    layers.press("Enter")
    page.wait_for_function("() => window.studio.design().solid?.layers === 41")


def test_the_key_shows_and_hides_it(window: Window) -> None:
    """The drawing is there again, as is every tool, which leads back to it."""
    page = window.page
    page.keyboard.press("3")
    assert page.locator("#solid").is_hidden()
    assert page.evaluate("() => document.activeElement.id") == "overlay"
    page.keyboard.press("3")
    assert page.evaluate("() => document.activeElement.id") == "solid"
    page.keyboard.press("p")
    assert page.locator("#solid").is_hidden()
    assert page.locator("#panel-drawing").is_visible()


def test_the_job_is_there_again(chromium: Any, tmp_path: Path) -> None:
    """When the page is loaded again: what is printed keeps its height and clearance."""
    (tmp_path / "bird.toml").write_text(TEXT.partition("[solid]")[0], encoding="utf-8")
    with running(tmp_path, "bird.toml") as studio, opened(chromium, studio) as window:
        for _ in range(2):
            window.wait()
            window.page.keyboard.press("3")
            seen(window)
            height = window.page.locator("#panel-solid").get_by_label("Height, mm")
            if not height.input_value():
                height.fill("7")
                height.press("Enter")
                window.page.locator("solid-panel dd").get_by_text(" x 7.00 mm").wait_for()
                window.page.reload()
                window.load()
        assert height.input_value() == "7"
        window.page.locator("solid-panel dd").get_by_text(" x 7.00 mm").wait_for()


def test_without_webgl(chromium: Any, tmp_path: Path) -> None:
    """The page says so, and shows the program's own picture, which follows."""
    (tmp_path / "bird.toml").write_text(TEXT, encoding="utf-8")
    with running(tmp_path, "bird.toml") as studio, opened(chromium, studio, script=NO_WEBGL) as window:
        page = window.page
        window.wait()
        page.keyboard.press("3")
        seen(window)
        panel = page.locator("#panel-solid")
        panel.get_by_text("This browser has no WebGL").wait_for()
        loaded = "before => { const one = document.getElementById('solid-picture');"
        loaded += " return one.complete && one.naturalWidth > 300 && one.src !== before && one.src; }"
        before = page.wait_for_function(loaded, arg="").json_value()
        assert page.locator("#solid").is_hidden()
        height = panel.get_by_label("Height, mm")
        height.fill("40")
        height.press("Enter")
        page.wait_for_function(loaded, arg=before)
        page.keyboard.press("Escape")
        page.get_by_role("tab", name="Drawing").click()
        assert page.locator("#solid-picture").is_hidden()
