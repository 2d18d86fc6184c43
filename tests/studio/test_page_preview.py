"""The life of the page's live picture: at once and at rest, lost and restored contexts, browsers without WebGL2."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from helpers.page_scenes import pattern_of, scene_of
from helpers.page_server import PageServer

from voronoi_tiles.raster.image_colouring import colour

OPEN = """async (scene) => {
    const { Preview, watchSize } = await import("/gl/preview.js");
    const text = await (await fetch("/gl/exact.glsl")).text();
    const canvas = document.createElement("canvas");
    document.body.replaceChildren(canvas);
    const states = [];
    const preview = new Preview(canvas, text, { changed: (state) => states.push([state, performance.now()]) });
    scene.sites = scene.sites.map((site) => ({ ...site, segments: Float64Array.from(site.segments) }));
    const gl = canvas.getContext("webgl2");
    const pixels = () => {
        const found = new Uint8Array(4 * canvas.width * canvas.height);
        gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, found);
        return found.join();
    };
    const until = async (state) => {
        const start = performance.now();
        while (!states.some(([name]) => name === state)) {
            if (performance.now() - start > 8_000) throw new Error(`not ${state} after 8 seconds`);
            await new Promise((done) => setTimeout(done, 5));
        }
    };
    window.test = { Preview, watchSize, text, canvas, states, preview, scene, gl, pixels, until };
}"""


@contextmanager
def opened(chromium: Any, url: str) -> Iterator[Any]:
    """A page with a preview of a p4 design, and what the script needs, as window.test."""
    context = chromium.new_context(device_scale_factor=1.5)
    page = context.new_page()
    page.goto(url)
    pattern = pattern_of("p4", [[{"bezier": [[5, 9], [25, 2], [30, 22], [13, 27]]}]], {"a": 60.0})
    page.evaluate(OPEN, scene_of(pattern, 20 + 9j, 1.5, colour(pattern)))
    yield page
    context.close()


@pytest.fixture(scope="module")
def kept(chromium: Any, page_server: PageServer) -> Iterator[Any]:
    """A page for tests that leave its preview as it was: to compile the shaders takes a second."""
    with opened(chromium, page_server.url) as page:
        yield page


@pytest.fixture
def page(kept: Any) -> Any:
    """That page, at rest, with nothing told yet."""
    kept.evaluate("() => { window.test.preview.settle(); window.test.states.length = 0; }")
    return kept


@pytest.fixture
def fresh(chromium: Any, page_server: PageServer) -> Iterator[Any]:
    """A page of the test's own."""
    with opened(chromium, page_server.url) as page:
        yield page


def test_the_exact_picture_follows_when_nothing_changes(page: Any) -> None:
    """Fewer pixels while pictures follow each other, however long that takes, and all of them at rest."""
    found = page.evaluate(
        """async () => {
            const { preview, scene, states, canvas, until } = window.test;
            const start = performance.now();
            while (performance.now() - start < 400) {
                preview.draw(scene);
                await new Promise(requestAnimationFrame);
            }
            preview.draw(scene);
            const [moving, size] = [states.map(([state]) => state), [canvas.width, canvas.height]];
            await until("settled");
            await new Promise((done) => setTimeout(done, 300));
            const [[last], rest] = [states.slice(-1), states.filter(([state]) => state === "drawn").pop()];
            return { software: preview.software, moving, size, all: states.map(([state]) => state),
                     settled: [canvas.width, canvas.height], waited: last[1] - rest[1] };
        }"""
    )
    assert found["software"]
    assert set(found["moving"]) == {"drawn"}
    assert found["all"] == [*found["moving"], "settled"]
    assert found["waited"] >= 119
    assert found["size"] == [40, 27]
    assert found["settled"] == [120, 80]


def test_a_lost_context_comes_back(page: Any) -> None:
    """What is drawn while it is lost appears when it is restored, as if nothing had been."""
    found = page.evaluate(
        """async () => {
            const { preview, scene, states, gl, pixels, until } = window.test;
            const paint = () => {
                preview.draw(scene);
                const quick = pixels();
                preview.settle();
                return [quick, pixels()];
            };
            const before = paint();
            const lose = gl.getExtension("WEBGL_lose_context");
            lose.loseContext();
            await until("lost");
            preview.draw(scene);
            preview.settle();
            const labels = preview.labels(scene, "exact");
            lose.restoreContext();
            await until("restored");
            return { same: JSON.stringify(paint()) === JSON.stringify(before), error: gl.getError(), labels,
                     varied: new Set(before[1].split(",")).size, states: states.map(([state]) => state) };
        }"""
    )
    assert found["same"]
    assert found["varied"] > 5
    assert found["error"] == 0
    assert found["labels"] is None
    assert found["states"] == ["drawn", "settled", "lost", "restored", "drawn", "drawn", "settled"]


def test_nothing_is_drawn_of_nothing(page: Any) -> None:
    """No strokes, a cell without area: the background alone, and the next design as ever."""
    found = page.evaluate(
        """() => {
            const { preview, scene, gl, pixels } = window.test;
            const seen = [];
            const broken = { a: [60, 0], b: [120, 0] };
            const empty = [{ segments: new Float64Array(0), cosets: [0, 1, 2, 3] }];
            for (const part of [{ sites: [] }, { sites: empty }, { lattice: broken }, {}]) {
                preview.draw({ ...scene, ...part });
                const [quick, none] = [pixels(), preview.labels({ ...scene, ...part }, "cell")];
                preview.settle();
                seen.push([new Set(quick.split(",")).size, new Set(pixels().split(",")).size, none === null]);
            }
            return { seen, error: gl.getError() };
        }"""
    )
    assert found["error"] == 0
    assert found["seen"][:3] == [[1, 1, True]] * 3
    assert found["seen"][3][0] > 5
    assert not found["seen"][3][2]


def test_too_many_strokes_are_refused(page: Any) -> None:
    """Then the page is told, the background is drawn, no exact picture follows, and fewer strokes are drawn again."""
    states = page.evaluate(
        """async () => {
            const { preview, scene, states, pixels } = window.test;
            const segments = Float64Array.from({ length: 800000 }, (_, k) => 20 + (k % 977) / 100);
            preview.draw({ ...scene, sites: [{ ...scene.sites[0], segments }] });
            states.push([new Set(pixels().split(",")).size]);
            await new Promise((done) => setTimeout(done, 300));
            preview.draw(scene);
            return states.map(([state]) => state);
        }"""
    )
    assert states == ["refused", 1, "drawn"]


@pytest.mark.parametrize("scale", [0.2, 0.01, 1e-5])
def test_cells_smaller_than_a_pixel_are_drawn(page: Any, scale: float) -> None:
    """Far away there is one mixed colour, and nothing is refused."""
    states, colours = page.evaluate(
        """(scale) => {
            const { preview, scene, states, pixels } = window.test;
            preview.draw({ ...scene, camera: { ...scene.camera, scale }, style: {} });
            preview.settle();
            return [states.map(([state]) => state), new Set(pixels().split(",")).size];
        }""",
        scale,
    )
    assert states == ["drawn", "settled"]
    assert colours > 1


@pytest.mark.parametrize("ratio", [1, 2])
def test_borders_have_their_width(page: Any, ratio: int) -> None:
    """Along a border the ink is as wide as asked, also where the nearest feet lie in nearly one direction."""
    widths = page.evaluate(
        """(ratio) => {
            const { preview, gl } = window.test;
            // Two points a tile's width apart, and two that are near each other: both borders are upright lines.
            const found = {};
            const [width, height] = [60 * ratio, 8 * ratio];
            for (const [name, gap] of [["apart", 30], ["slanted", 4]]) {
                const sites = [0, gap].map((x) => ({ segments: Float64Array.of(x, 0, x, 0), cosets: [0] }));
                const camera = { centre: [gap / 2, 25], scale: 4, size: [60, 8], ratio };
                const motions = [{ a: [1, 0], b: [0, 0], conj: false }];
                const lattice = { a: [60, 0], b: [0, 60] };
                const style = { border: 6, borderColour: [0, 0, 0] };
                preview.draw({ lattice, motions, sites, camera, style, colouring: null });
                preview.settle();
                const pixels = new Uint8Array(4 * width * height);
                gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
                const row = [...Array(width).keys()].map((x) => pixels[4 * (width * (height / 2) + x)]);
                // Each side has one colour, and the window's middle is the border's.
                found[name] = row.reduce((sum, red, x) => sum + 1 - red / row[x < width / 2 ? 0 : width - 1], 0);
            }
            return found;
        }""",
        ratio,
    )
    assert widths["apart"] == pytest.approx(6 * ratio, abs=0.6)
    assert widths["slanted"] == pytest.approx(6 * ratio, abs=0.6)


def test_the_bench_reports_who_draws_and_how_long(page: Any) -> None:
    """Renderer and milliseconds; the graphics card's own where it tells them."""
    figures = page.evaluate("() => window.test.preview.bench(window.test.scene, 6)")
    assert "SwiftShader" in figures["renderer"]
    assert figures["software"]
    for name in ("dragged", "moved", "exact"):
        assert 0 < figures[name]["median"] <= figures[name]["p95"] < 60_000
        assert figures[name]["card"] is None or figures[name]["card"] > 0


def test_sizes_are_in_pixels_of_the_screen(fresh: Any) -> None:
    """At 1.5 pixels of the screen for one of the page: whole ones, those that the element covers."""
    sizes = fresh.evaluate(
        """async () => {
            const { canvas, watchSize } = window.test;
            canvas.style.cssText = "position: absolute; left: 0.5px; width: 101px; height: 51px";
            const sizes = [];
            const stop = watchSize(canvas, (size) => sizes.push(size));
            const wait = () => new Promise((done) => setTimeout(done, 200));
            await wait();
            canvas.style.width = "40px";
            await wait();
            stop();
            canvas.style.width = "90px";
            await wait();
            return sizes;
        }"""
    )
    assert [size["size"] for size in sizes] == [[101, 51], [40, 51]]
    assert {size["ratio"] for size in sizes} == {1.5}
    for size in sizes:
        assert all(abs(size["pixels"][k] - 1.5 * size["size"][k]) <= 0.75 for k in (0, 1))
        assert all(float(pixels).is_integer() for pixels in size["pixels"])


def test_without_webgl2_it_says_so(fresh: Any) -> None:
    """Where a browser gives no context, or its context refuses the shaders, there are words for it."""
    found = fresh.evaluate(
        """() => {
            const { Preview, text } = window.test;
            const refused = (exact) => {
                try {
                    new Preview(document.createElement("canvas"), exact);
                    return "";
                } catch (error) {
                    return error.message;
                }
            };
            const before = [Preview.available, Preview.missing(), refused(text.replace("vec2 p", "vec3 p"))];
            HTMLCanvasElement.prototype.getContext = () => null;
            const off = [Preview.available, Preview.missing(), refused(text)];
            delete window.WebGL2RenderingContext;
            return [before, off, [Preview.available, Preview.missing()]];
        }"""
    )
    before, off, none = found
    assert before[:2] == [True, ""]
    assert "does not compile" in before[2]
    assert off[0] is False
    assert "switched off" in off[1]
    assert off[2] == off[1]
    assert none == [False, "this browser has no WebGL2"]


def test_pictures_are_drawn_again_only_where_they_changed(fresh: Any) -> None:
    """A window that is moved is tiled from the image of the cell that there is; new strokes, new scales make one."""
    counts = json.loads(
        fresh.evaluate(
            """() => {
                const { preview, scene, gl } = window.test;
                const draws = [];
                const plain = gl.drawArrays.bind(gl);
                let count = 0;
                gl.drawArrays = (...rest) => { count++; plain(...rest); };
                const { camera, style } = scene;
                const near = { ...scene, camera: { ...camera, scale: 1.3 } };
                for (const next of [
                    scene,
                    { ...scene, camera: { ...camera, centre: [500, -300] } },
                    near,
                    { ...near, style: { ...style, dark: true } },
                    { ...near, style: { ...style, border: 5 } },
                    { ...near, sites: scene.sites.map((site) => ({ ...site, segments: site.segments.slice() })) },
                ]) {
                    count = 0;
                    preview.draw(next);
                    draws.push(count);
                }
                return JSON.stringify(draws);
            }"""
        )
    )
    # The cell, its colours, the window.
    assert counts == [3, 1, 3, 2, 3, 3]
