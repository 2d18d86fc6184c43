"""What the examples of docs/design-file.md and docs/start.md make: drawn from the pages' own text.

An example is a TOML block under `<!-- picture: NAME -->`. Where it is no whole design it is the end of the frame below.
"""

from __future__ import annotations

import re
import tempfile
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from diagrams_style import FIELDS, GREY, INK, PALE, TILE, Complexes, bare, drawing, edges, fill, strokes
from matplotlib.axes import Axes

from voronoi_tiles import Design, Tile, Tiling

PAGES = [Path(__file__).parents[1] / name for name in ("design-file.md", "start.md")]

FRAME = 'schema = 1\ngroup = "p4"\n\n[cell]\na = 60.0\n\n[[site]]\n'
"""What stands before an example that is no whole design."""

_TOLERANCE = 0.06  # of curves, in millimetres: a fifth of a line's width here, and a fifth of the bytes

_EXAMPLE = re.compile(r"<!-- picture: (\S+) -->\n+```toml\n(.*?)```", re.DOTALL)
_FILE = re.compile(r"<!-- file: (\S+\.svg) -->\n+```xml\n(.*?)```", re.DOTALL)


def examples(page: str) -> Iterator[tuple[str, str]]:
    """The examples of a page: the name of the picture, and the whole design."""
    for name, text in _EXAMPLE.findall(page):
        yield name, text if "schema" in text else FRAME + text


def write() -> None:
    """Write the pictures of all examples."""
    for page in PAGES:
        content = page.read_text(encoding="utf-8")
        with tempfile.TemporaryDirectory() as folder:
            for name, text in _FILE.findall(content):
                (Path(folder) / name).write_text(text, encoding="utf-8")
            for name, text in examples(content):
                _draw(name, text, folder)


def _draw(name: str, text: str, folder: str) -> None:
    source = tomllib.loads(text)
    for site in source["site"]:
        site.setdefault("tolerance", _TOLERANCE)
    design = Design.from_dict(source, folder=folder)
    tiling = design.tessellate()
    tiles = tiling.tiles
    with drawing(f"{name}.svg", (2.5, 2.5)) as (_, axes):
        window = _window(tiles)
        _neighbours(axes, tiling, window)
        for k, tile in enumerate(tiles):
            fill(axes, tile.outline, fc=TILE if len(tiles) == 1 else FIELDS[k], ec="none")
        for tile in tiles:
            edges(axes, tile.outline, 1.6)
            strokes(axes, tile.site.elements, INK, 2.0, 5.0)
        for site in source["site"]:
            for stroke in site["strokes"]:
                _given(axes, stroke)
        bare(axes, window)


def _window(tiles: tuple[Tile, ...]) -> Complexes:
    """The corners of a square around all tiles."""
    boxes = np.array([tile.outline.bounds for tile in tiles])
    low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    middle, half = (low + high) / 2, 0.56 * (high - low).max()
    return np.array([complex(*(middle - half)), complex(*(middle + half))])


def _neighbours(axes: Axes, tiling: Tiling, window: Complexes) -> None:
    """Draw the copies around in grey."""
    for tile in tiling.tiles:
        for operation in tiling.design.group.operations:
            for i in range(-2, 3):
                for j in range(-2, 3):
                    copy = tile.copy(operation.translated(i, j))
                    x0, y0, x1, y1 = copy.bounds
                    low, high = window
                    if x0 < high.real and x1 > low.real and y0 < high.imag and y1 > low.imag:
                        fill(axes, copy, fc=PALE, lw=1.0)


def _given(axes: Axes, stroke: Mapping[str, Any]) -> None:
    """Draw the points that an unplaced stroke gives, with the polygon of what only guides the curve."""
    if {"scale", "rotate", "translate"} & stroke.keys():
        return
    for kind in ("bezier", "bspline", "catmull_rom", "hermite", "polyline", "segment"):
        if kind in stroke:
            x, y = np.array(stroke[kind], float).T
            if kind in ("bezier", "bspline"):
                axes.plot(x, y, color=GREY, lw=0.8, dashes=(3, 2), zorder=4)
            if kind == "hermite":
                u, v = np.array(stroke["tangents"], float).T / 3
                axes.quiver(x, y, u, v, color=GREY, angles="xy", scale_units="xy", scale=1, width=0.009, zorder=4)
            axes.plot(x, y, "o", color="white", mec=INK, mew=0.8, ms=3.6, zorder=6)
