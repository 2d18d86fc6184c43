"""The page's live picture against the raster stage's labels, in Chromium: who owns each sample, and in which colour."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from helpers import strategies
from helpers.page_scenes import HEIGHT, WIDTH, names, pattern_of, rendered, scene_of
from helpers.page_server import PageServer

from voronoi_tiles.designs.design import Design
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.raster.image_colouring import colour
from voronoi_tiles.raster.scene import Pattern

LOOK = """async ({ lattice, motions, sites, camera, colouring, ways }) => {
    const { canvas, preview, palette } = window.shown;
    sites = sites.map((site) => ({ ...site, segments: Float64Array.from(site.segments) }));
    const scene = { lattice, motions, sites, camera, colouring, style: { border: 0 } };
    const picture = () => {
        const { width, height } = canvas;
        const gl = canvas.getContext("webgl2");
        const pixels = new Uint8Array(4 * width * height);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
        return { width, height, pixels: [...pixels], error: gl.getError() };
    };
    const labels = Object.fromEntries(ways.map((how) => [how, [...preview.labels(scene, how).labels]]));
    preview.draw(scene);
    const drawn = picture();
    preview.settle();
    const settled = picture();
    return JSON.stringify({ labels, drawn, settled, palette });
}"""

OPEN = """async () => {
    const { Preview } = await import("/gl/preview.js");
    const { tileColour } = await import("/gl/colours.js");
    const text = await (await fetch("/gl/exact.glsl")).text();
    const canvas = document.createElement("canvas");
    const palette = [...Array(40).keys()].map((k) => tileColour(k, false));
    window.shown = { canvas, preview: new Preview(canvas, text), palette };
}"""


@pytest.fixture(scope="module")
def page(chromium: Any, page_server: PageServer) -> Iterator[Any]:
    """A page with a preview; what goes wrong in it fails its tests."""
    page = chromium.new_page()
    said: list[str] = []
    page.on("console", lambda message: said.append(message.text) if "GL_INVALID" in message.text else None)
    page.on("pageerror", lambda error: said.append(str(error)))
    page.goto(page_server.url)
    page.evaluate(OPEN)
    yield page
    page.close()
    assert said == []


def check(page: Any, pattern: Pattern, centre: complex, scale: float, ratio: float = 1.0) -> None:
    """Labels and pictures of a window are those of the raster stage, where an edge is not as near as they are coarse.

    There are `ratio` pixels of the screen for one of the page, of which `scale` are a unit. A sample is at least half
    of d2 - d1 away from any edge.
    """
    colouring = colour(pattern)
    scene = scene_of(pattern, centre, scale, colouring)
    scene["camera"]["ratio"] = ratio
    short, long = (abs(side) * scale * ratio for side in pattern.lattice.reduced_basis)
    # Where a cell's image is looked up, the texel's middle lies within a pixel; of cells of thousands there is none.
    ways = {"exact": 0.01} | ({"cell": 2.0} if long < 2000 else {})
    scene["ways"] = list(ways)
    across, up = round(WIDTH * ratio), round(HEIGHT * ratio)
    found = json.loads(page.evaluate(LOOK, scene))
    image = rendered(pattern, centre, scale, across, up)
    expected = names(image)
    apart = (image.d2 - image.d1) * scale * ratio
    for how, least in ways.items():
        labels = np.array(found["labels"][how]).reshape(up, across, 4)
        clear = apart > least
        assert clear.mean() > 0.4
        wrong = clear & (labels != expected).any(axis=2)
        assert not wrong.any(), (how, np.argwhere(wrong)[:3], labels[wrong][:3], expected[wrong][:3])
    for how in ("drawn", "settled"):
        picture = found[how]
        assert picture["error"] == 0
        width, height = picture["width"], picture["height"]
        image = rendered(pattern, centre, scale, width, height)
        palette = np.rint(255 * np.array(found["palette"])).astype(int)
        wanted = palette[colouring.of(image.copies)[image.first]]
        pixels = np.array(picture["pixels"]).reshape(height, width, 4)[..., :3]
        # Colours are read between texels, up to two away. Those of small cells are means, all but a trace from so near.
        exact = how == "settled" and short >= 32
        small = short * long * (width / across) ** 2 < 64**2
        clear = (image.d2 - image.d1) * scale * width / WIDTH > (0.01 if exact else 6.0 if small else 4.0)
        assert clear.any() or how == "drawn"  # in so few pixels there may be none
        wrong = clear & (abs(pixels - wanted) > (4 if small and not exact else 1)).any(axis=2)
        assert not wrong.any(), (how, np.argwhere(wrong)[:3], pixels[wrong][:3], wanted[wrong][:3])


def check_kind(page: Any, group: str, kind: str, seed: int) -> None:
    """One stroke of a kind in some window, far from the origin or near it."""
    chance = strategies.Dice(np.random.default_rng([seed, *map(ord, group + kind)]))
    on = strategies.canvas(chance, group)
    drawn = strategies.stroke(chance, lambda: on.spot(chance, 0.7), 0.7 * on.inradius(), kind)
    pattern = pattern_of(group, [[drawn]], on.cell)
    centre = on.lattice.cartesian(chance.real(-5, 5), chance.real(-5, 5)) * chance.pick((1, 100))
    check(page, pattern, centre, chance.real(1.2, 2.4))


KINDS = strategies.STROKES


@pytest.mark.parametrize("group", list(GROUPS))
def test_labels_of_the_page_are_those_of_the_raster_stage(page: Any, group: str) -> None:
    """In all groups, of strokes of two kinds each: of every kind in three groups or four."""
    number = list(GROUPS).index(group)
    for step in (0, 5):
        check_kind(page, group, KINDS[(number + step) % len(KINDS)], 1)


@pytest.mark.slow
@pytest.mark.parametrize("group", list(GROUPS))
@pytest.mark.parametrize("kind", KINDS)
def test_labels_of_all_kinds_in_all_groups(page: Any, group: str, kind: str) -> None:
    """Every kind of stroke in every group."""
    check_kind(page, group, kind, 2)


@pytest.mark.parametrize(
    ("group", "kind", "scale"),
    [
        ("p4", "special", 1.3),  # copies coincide, and have one label
        ("p6m", "special", 1.1),
        ("cmm", "special", 1.7),
        ("p3", "several", 1.2),
        ("pgg", "points", 2.0),
        ("p1", "several", 9.0),  # less than a cell
        ("p4g", "plain", 40.0),
        ("p1", "plain", 0.45),  # cells of 27 pixels
        ("p2", "far", 1.2),
    ],
)
def test_labels_of_designs(page: Any, group: str, kind: str, scale: float) -> None:
    """Sites that the group maps onto themselves, several sites, windows within a tile and of many cells."""
    chance = strategies.Dice(np.random.default_rng([5, len(kind), *map(ord, group)]))
    design = Design.from_dict(strategies.make_design(chance, kind, group)[1])
    pattern = Pattern(design.noded, design.group, design.lattice)
    check(page, pattern, complex(design.noded[0].nodes.mean()) + 3 + 1j, scale)


@pytest.mark.parametrize(("b", "angle"), [(9.0, 35.0), (600.0, 88.0)])
def test_labels_in_narrow_cells(page: Any, b: float, angle: float) -> None:
    """Cells whose shortest basis is another than the lattice's, and such as are much longer than wide."""
    chance = strategies.Dice(np.random.default_rng(9))
    on = strategies.Canvas("p2", {"a": 60.0, "b": b, "angle": angle})
    drawn = strategies.stroke(chance, lambda: on.spot(chance, 0.7), on.inradius(), "bezier")
    check(page, pattern_of("p2", [[drawn]], on.cell, 0.05), 30 + 2j, 4.0)


@pytest.mark.parametrize("ratio", [1.25, 1.5, 2.0])
def test_labels_on_fine_screens(page: Any, ratio: float) -> None:
    """Samples are those of the screen's pixels."""
    pattern = pattern_of(
        "pgg", [[{"hermite": [[6, 8], [22, 11]], "tangents": [[30, 10], [-9, 25]]}]], {"a": 60, "b": 41}
    )
    check(page, pattern, 11 - 70j, 1.7, ratio)


@pytest.mark.parametrize("cells", [0, 700])
def test_labels_deep_within_large_cells(page: Any, cells: int) -> None:
    """Cells of 30,000 pixels, far from the origin too: at a centre of rotation by half a turn, where an edge runs."""
    pattern = pattern_of("p2", [[{"bezier": [[5, 4], [25, -6], [34, 22], [9, 14]]}]], {"a": 60, "b": 47, "angle": 80})
    check(page, pattern, pattern.lattice.cartesian(cells, -cells) + 0.01, 500.0)
