"""Cones over points and tents over segments, from the side and from above: the meshes of the raster stage's own method.

The heights are those of voronoi_tiles.raster.hoff, whose cones have as many sides as told; here few, so that they show.
"""

from __future__ import annotations

import numpy as np
from diagrams_style import FIELDS, INK, PICTURES, Complexes, drawing
from matplotlib.colors import LightSource, to_rgb
from numpy.typing import NDArray
from PIL import Image

from voronoi_tiles.raster.hoff import heights

Floats = NDArray[np.float64]

SIDES = 32
"""Sides of the cones; the raster stage takes 128."""

_ELEMENTS = ((-6 + 3j, 0.5 + 4.4j), (2.6 - 3.4j, 6.4 - 1j), (-4.2 - 2.8j, -4.2 - 2.8j), (4.6 + 4j, 4.6 + 4j))
_HALF = (8.0, 6.0)


def write() -> None:
    """Write the picture."""
    x, y = np.meshgrid(np.linspace(-_HALF[0], _HALF[0], 321), np.linspace(-_HALF[1], _HALF[1], 241))
    layers = np.stack([_height(x + 1j * y, *ends) for ends in _ELEMENTS])
    height, owner = layers.min(axis=0), layers.argmin(axis=0)
    colours = np.array([to_rgb(field) for field in FIELDS])[owner]
    light = LightSource(azdeg=315, altdeg=50)
    shaded = light.shade_rgb(colours, height, vert_exag=0.35, blend_mode="soft", dx=0.05, dy=0.05)
    with drawing("cones.png", (7.4, 3.3)) as (figure, axes):
        axes.remove()
        side = figure.add_subplot(1, 2, 1, projection="3d", computed_zorder=False)
        # Seen from below, as the depth test sees them: what is nearest hides the rest.
        step = (slice(None, None, 2), slice(None, None, 2))
        side.plot_surface(
            x[step], y[step], -height[step], facecolors=shaded[step], rcount=200, ccount=200, lw=0, antialiased=False
        )
        side.set_box_aspect((16, 12, 7), zoom=1.2)
        side.view_init(elev=38, azim=-62)
        side.set_axis_off()
        above = figure.add_subplot(1, 2, 2)
        above.imshow(shaded, origin="lower", extent=(-_HALF[0], _HALF[0], -_HALF[1], _HALF[1]))
        above.set_axis_off()
        for p, q in _ELEMENTS:
            style = {"marker": "o", "ms": 4} if p == q else {"lw": 2.0}
            above.plot([p.real, q.real], [p.imag, q.imag], color=INK, solid_capstyle="round", **style)
    _fewer_colours()


def _height(z: Complexes, start: complex, end: complex) -> Floats:
    """The height of the mesh of one element at points z."""
    if start == end:
        away = z - start
        return heights(np.abs(away.real), away.imag, SIDES)
    unit = (end - start) / abs(end - start)
    local = (z - (start + end) / 2) * unit.conjugate()
    return heights(np.maximum(np.abs(local.real) - abs(end - start) / 2, 0.0), local.imag, SIDES)


def _fewer_colours() -> None:
    """Write the picture once more with 96 colours, which nobody tells from all."""
    file = PICTURES / "cones.png"
    with Image.open(file) as picture:
        small = picture.convert("RGB").quantize(96, dither=Image.Dither.NONE)
    small.save(file, optimize=True)
