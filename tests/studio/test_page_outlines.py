"""The picture without WebGL2: exact outlines of all copies, filled, against the raster stage's labels."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from helpers import strategies
from helpers.page_scenes import HEIGHT, WIDTH, rendered, scene_of
from helpers.page_server import PageServer

from voronoi_tiles.designs.design import Design
from voronoi_tiles.formats.svg.path_text import path_data
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.raster.image_colouring import colour
from voronoi_tiles.raster.scene import Pattern

DRAW = """async ([{ camera, lattice, motions, sites, colouring }, paths, style]) => {
    const { drawOutlines } = await import("/view/outlines.js");
    const { pathCubics } = await import("/model/pathdata.js");
    const { boxOf } = await import("/model/segments.js");
    const { tileColour } = await import("/gl/colours.js");
    const [width, height] = camera.size.map((side) => side * camera.ratio);
    const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
    const tiles = paths.map((path, k) => ({ path, operations: sites[k].cosets }));
    const fill = style.fill ? colouring : null;
    const count = drawOutlines(context, camera, lattice, motions, tiles, { ...style, fill });
    const { a, e } = context.getTransform();
    return JSON.stringify({
        count,
        pixels: [...context.getImageData(0, 0, width, height).data],
        palette: [...Array(40).keys()].map((k) => tileColour(k, false)),
        boxes: paths.map((path) => boxOf(pathCubics(path))),
        left: [a, e, context.globalAlpha, context.lineWidth],
    });
}"""


@pytest.fixture(scope="module")
def page(chromium: Any, page_server: PageServer) -> Iterator[Any]:
    """An empty page beside the modules."""
    page = chromium.new_page()
    page.goto(page_server.url)
    yield page
    page.close()


def picture(
    page: Any, group: str, kind: str, scale: float, ratio: float = 1.0, **style: Any
) -> tuple[dict[str, Any], Pattern, complex, list[Any]]:
    """What the page draws of a design in a window, and the design's pattern, the window's middle, the tiles."""
    chance = strategies.Dice(np.random.default_rng([8, *map(ord, group + kind)]))
    design = Design.from_dict(strategies.make_design(chance, kind, group)[1])
    tiling = design.tessellate()
    pattern = Pattern(design.noded, design.group, design.lattice)
    centre = complex(design.noded[0].nodes.mean()) + 20 - 7j
    scene = scene_of(pattern, centre, scale, colour(pattern))
    scene["camera"]["ratio"] = ratio
    paths = [path_data(tile.outline.paths.moved(1.0, 0j, conj=True)) for tile in tiling]
    return json.loads(page.evaluate(DRAW, [scene, paths, style])), pattern, centre, list(tiling)


def pixels_of(found: dict[str, Any], ratio: float = 1.0) -> np.ndarray:
    """The picture from the lowest row up: height x width x (red, green, blue, alpha)."""
    return np.array(found["pixels"]).reshape(round(HEIGHT * ratio), round(WIDTH * ratio), 4)[::-1]


@pytest.mark.parametrize(
    ("group", "kind", "scale", "ratio"),
    [
        *((group, "plain", 1.5, 1.0) for group in GROUPS),
        ("p6m", "special", 1.3, 1.0),
        ("p4", "several", 1.7, 1.5),
        ("pgg", "points", 30.0, 1.0),
    ],
)
def test_filled_outlines_are_the_picture(page: Any, group: str, kind: str, scale: float, ratio: float) -> None:
    """Each pixel that no border is near has the colour of the copy that owns it."""
    found, pattern, centre, tiles = picture(page, group, kind, scale, ratio, fill=True, line=0)
    pixels = pixels_of(found, ratio)
    height, width, _ = pixels.shape
    image = rendered(pattern, centre, scale, width, height)
    palette = np.rint(255 * np.array(found["palette"])).astype(int)
    wanted = palette[colour(pattern).of(image.copies)[image.first]]
    clear = (image.d2 - image.d1) * scale * ratio > 2.0
    assert clear.mean() > 0.3
    wrong = clear & (pixels[..., :3] != wanted).any(axis=2)
    assert not wrong.any(), (np.argwhere(wrong)[:3], pixels[wrong][:3], wanted[wrong][:3])
    for tile, (x0, y0, x1, y1) in zip(tiles, found["boxes"], strict=True):
        box = tile.outline.bounds
        assert min(box[0] - x0, box[1] - y0, x1 - box[2], y1 - box[3]) >= -1e-9
    assert found["left"] == [1, 0, 1, 1]


def test_lines_run_along_borders_alone(page: Any) -> None:
    """Lines without colours: where a border runs through a pixel's middle there is ink, away from all there is none."""
    found, pattern, centre, _ = picture(page, "p6", "plain", 2.0, line=2, colour="#ff0000")
    ink = pixels_of(found)
    image = rendered(pattern, centre, 2.0, WIDTH, HEIGHT)
    apart = (image.d2 - image.d1) * 2.0
    assert (ink[apart > 5.0, 3] == 0).all()
    assert (ink[apart < 0.3, 3] > 100).all()
    assert (ink[ink[..., 3] > 0][:, :3] == [255, 0, 0]).all()
    faint, *_ = picture(page, "p6", "plain", 2.0, line=2, colour="#ff0000", opacity=0.5)
    assert 120 <= pixels_of(faint)[..., 3].max() <= 130, "shared lines are no darker"


def test_too_many_copies_are_not_drawn(page: Any) -> None:
    """Far away there would be lines alone."""
    found, *_ = picture(page, "p4m", "plain", 0.02, line=1)
    assert found["count"] == 0
    assert not any(found["pixels"])
