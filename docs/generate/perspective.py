"""The cones and tents of a design in perspective, from the raster stage's own numbers.

    python docs/generate/perspective.py DESIGN -o PICTURE.png --region X0,Y0,X1,Y1

The height of the surface is minus the distance to the nearest copy, as the cones and tents of `--method hoff` give it:
the upper envelope that a depth test leaves. Colours are those of `voronoi-tiles render`; the strokes lie at height 0,
lines of equal distance are drawn darker.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LightSource
from matplotlib.figure import Figure
from numpy.typing import NDArray

from voronoi_tiles import Design
from voronoi_tiles.base.files import writing
from voronoi_tiles.formats.png import PngStream
from voronoi_tiles.groups.periodic_colouring import palette
from voronoi_tiles.raster.frame import rectangle_frame
from voronoi_tiles.raster.image_colouring import colour
from voronoi_tiles.raster.picture import INK, Region
from voronoi_tiles.raster.renderer import LabelImage, Renderer
from voronoi_tiles.raster.scene import Pattern

Floats = NDArray[np.float64]

SAMPLES = 241
"""Samples along a side of the surface; a count."""

LEVELS = 6.0
"""The distance between two level lines, in the design's units."""

_INCHES = (4.8, 3.6)
_DOTS = 200


def perspective(design: Design, region: Region, output: Path) -> None:
    """Draw the surface over a region as a PNG of 480 x 360 pixels, each the mean of 2 x 2."""
    pattern = Pattern(design.noded, design.group, design.lattice)
    frame = rectangle_frame(region, SAMPLES, SAMPLES)
    image = Renderer("cpu", method="hoff").render(pattern, frame)
    figure = Figure(figsize=_INCHES, dpi=_DOTS)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0), projection="3d", computed_zorder=False)
    at = frame.points(*np.meshgrid(np.arange(SAMPLES, dtype=float), np.arange(SAMPLES, dtype=float)))
    axes.plot_surface(
        at.real,
        at.imag,
        -image.d1,
        facecolors=_shaded(pattern, image),
        rcount=SAMPLES,
        ccount=SAMPLES,
        antialiased=False,  # the background would shine through between the facets
        shade=False,
    )
    ink = tuple(part / 255 for part in INK)
    for site in design.noded:
        ends = site.nodes[site.segments]
        axes.plot(site.nodes.real, site.nodes.imag, "o", zs=0.0, color=ink, markersize=3.5)
        for p, q in ends.tolist():
            axes.plot([p.real, q.real], [p.imag, q.imag], zs=0.0, color=ink, linewidth=2.0)
    axes.set_xlim(region[0], region[2])
    axes.set_ylim(region[1], region[3])
    axes.set_box_aspect((region[2] - region[0], region[3] - region[1], float(np.ptp(image.d1))), zoom=1.06)
    axes.view_init(elev=40.0, azim=-68.0)
    axes.set_axis_off()
    canvas.draw()
    fine = np.asarray(canvas.buffer_rgba())[..., :3].astype(float)
    rows, columns = fine.shape[0] // 2, fine.shape[1] // 2
    pixels = np.rint(fine.reshape(rows, 2, columns, 2, 3).mean(axis=(1, 3))).astype(np.uint8)
    with writing(output) as file, PngStream(file, columns, rows) as png:
        png.write(pixels)


def _shaded(pattern: Pattern, image: LabelImage) -> Floats:
    """The colours of the samples, lit from one side; red, green, blue from 0 to 1."""
    colouring = colour(pattern)
    flat = palette(colouring.count)[colouring.of(image.copies)[image.first]] / 255.0
    step = image.frame.pixel
    lit = LightSource(azdeg=300.0, altdeg=45.0).hillshade(np.asarray(image.d1, float), dx=step, dy=step)
    light = 0.66 + 0.46 * lit
    beyond = np.abs(image.d1 / LEVELS - np.rint(image.d1 / LEVELS)) * LEVELS / step
    light *= 1.0 - 0.25 * np.clip(1.5 - beyond, 0.0, 1.0)
    return np.asarray(np.minimum(flat * light[..., None], 1.0))


def _region(text: str) -> Region:
    """Read X0,Y0,X1,Y1."""
    x0, y0, x1, y1 = map(float, text.split(","))
    return x0, y0, x1, y1


def main() -> None:
    """Read the command line and draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("design", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--region", type=_region, required=True)
    given = parser.parse_args()
    perspective(Design.load(given.design), given.region, given.output)


if __name__ == "__main__":
    main()
