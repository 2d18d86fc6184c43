"""The coloured tessellation as a picture, band by band: tiles in HSV colours, borders by Sobel, sites on top.

Source of the look: Panchal, Akleman et al., "Curved Space-Filling Tiles Using Voronoi Decomposition with Line, and
Curve Segments Closed Under Wallpaper Symmetries".
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.groups.periodic_colouring import PeriodicColouring, palette
from voronoi_tiles.raster.frame import rectangle_frame
from voronoi_tiles.raster.image_colouring import colour
from voronoi_tiles.raster.line_coverage import coverage
from voronoi_tiles.raster.renderer import LabelImage, Provenance, Renderer
from voronoi_tiles.raster.scene import Pattern

Pixels = NDArray[np.uint8]
Region = tuple[float, float, float, float]

INK = (38, 34, 42)
"""The colour of borders and sites: red, green, blue."""

_BAND = 1 << 21
"""Samples that are rendered at once, at most or in one row of pixels; a count. A band takes some 250 MB."""


@dataclass(frozen=True, eq=False)
class Overlay:
    """Lines to draw on top: `segments` complex128 (n, 2), Cartesian; `width` in pixels; red, green, blue.

    `opacity` is the share of the colour where a line covers a pixel, 1 where nothing shows through.
    """

    segments: Complexes
    width: float
    colour: tuple[int, int, int]
    opacity: float = 1.0


@dataclass(frozen=True)
class PictureStyle:
    """How a picture is drawn: widths in pixels.

    `border` is the width of the tiles' borders, `site` that of the sites' strokes, 0 for none; every pixel is the mean
    of `supersampling` x `supersampling` samples.
    """

    border: float
    site: float
    supersampling: int

    @classmethod
    def of_size(cls, width: int, height: int) -> PictureStyle:
        """The widths that suit a picture of so many pixels; large ones are not supersampled."""
        side = math.sqrt(width * height)
        return cls(max(1.0, side / 600), max(2.0, side / 220), 2 if side <= 4096 else 1)


class Picture:
    """A picture of a rectangle of the plane, `width` x `height` pixels; `bands` renders it from top to bottom."""

    def __init__(
        self,
        pattern: Pattern,
        region: Region,
        width: int,
        height: int,
        *,
        renderer: Renderer,
        overlays: Sequence[Overlay] = (),
        style: PictureStyle | None = None,
        colouring: PeriodicColouring | None = None,
        nobody: tuple[int, int, int] | None = None,
    ) -> None:
        """Prepare a picture; without a `colouring` no neighbours are alike.

        `nobody` is the colour of what is as far from two copies as distances are known: regions, where copies touch.
        Raises ValueError where the region or the picture is empty.
        """
        self.pattern, self.renderer, self.overlays = pattern, renderer, tuple(overlays)
        self.width, self.height, self._nobody = width, height, nobody
        self.style = style or PictureStyle.of_size(width, height)
        self.fine = self.style.supersampling
        self.grid = rectangle_frame(region, width, height)
        self.frame = rectangle_frame(region, width * self.fine, height * self.fine)
        self.provenance: Provenance = renderer.provenance()
        self.renderers: dict[str, None] = {}
        """Who has rendered, in turn: more than one where OpenGL has failed between two bands."""
        self.distinct: PeriodicColouring = colour(pattern)
        """Tells neighbours apart, of which the borders are seen."""
        self.colouring: PeriodicColouring = self.distinct if colouring is None else colouring

    def bands(self) -> Iterator[Pixels]:
        """Render from the top: pixels (rows, width, 3), red, green, blue; `provenance` says by whom, in the end."""
        rows = max(1, _BAND // (self.frame.width * self.fine))
        for top in range(0, self.height, rows):
            yield self._band(top, min(rows, self.height - top))

    def _band(self, top: int, rows: int) -> Pixels:
        """Render some rows of pixels."""
        fine = self.fine
        grow = max(0, round(self.style.border * fine / 2) - 1)  # Sobel's own border is two samples wide
        halo = 1 + grow
        frame = self.frame.window(-halo, top * fine - halo, self.width * fine + 2 * halo, rows * fine + 2 * halo)
        image = self.renderer.render(self.pattern, frame)
        self.provenance = image.provenance
        self.renderers.setdefault(str(image.provenance))
        colours = palette(self.colouring.count)
        index = self.colouring.of(image.copies)[image.first]
        flat = colours[index]
        alike = self.colouring is not self.distinct
        apart = palette(self.distinct.count)[self.distinct.of(image.copies)[image.first]] if alike else flat
        if self._nobody is not None:
            unowned = image.d2 - image.d1 <= 2 * image.error(image.d2)
            flat[unowned] = apart[unowned] = self._nobody
        ink = _borders(apart, grow)
        inner = (slice(halo, -halo), slice(halo, -halo))
        cover = np.maximum(ink.astype(np.float32), self._sites(image))[inner]
        pixels = flat[inner].astype(np.float32)
        pixels += cover[..., None] * (np.array(INK, np.float32) - pixels)
        pixels = _mean(pixels, fine)
        shown = self.grid.window(0, top, self.width, rows)
        for overlay in self.overlays:
            strength = overlay.opacity * coverage(overlay.segments, overlay.width, shown)[..., None]
            pixels += strength * (np.array(overlay.colour, np.float32) - pixels)
        return np.rint(pixels).astype(np.uint8)

    def _sites(self, image: LabelImage) -> NDArray[np.float32]:
        """How much of each sample the sites' strokes cover."""
        if not self.style.site:
            return np.zeros(image.d1.shape, np.float32)
        beyond = image.d1 / self.frame.pixel - self.style.site * self.fine / 2
        return np.asarray(np.clip(0.5 - beyond, 0.0, 1.0), np.float32)


def default_region(pattern: Pattern) -> Region:
    """Two cells each way, that at the origin in the middle, as a rectangle: edges match, unless the cell is oblique."""
    a, b = pattern.lattice.a, pattern.lattice.b
    middle = (a + b) / 2
    # In the hexagonal cell b + a/2 is at right angles to a, and two such rows are a period.
    return middle.real - abs(a), middle.imag - b.imag, middle.real + abs(a), middle.imag + b.imag


def _borders(colours: Pixels, grow: int) -> NDArray[np.bool_]:
    """Where the Sobel operator finds an edge of colours, grown by so many samples to every side."""
    # As numbers of 24 bits different colours are different; of their brightness that would not be sure.
    values = colours.astype(np.int32) @ np.array([1 << 16, 1 << 8, 1], np.int32)
    return _grown(_sobel(values) | _sobel(values.T).T, grow)


def _sobel(values: NDArray[np.int32]) -> NDArray[np.bool_]:
    """Where the Sobel operator finds a change along the rows; beyond the borders values go on as they are there."""
    padded = np.pad(values, 1, mode="edge")
    smooth = padded[:-2] + 2 * padded[1:-1] + padded[2:]
    return np.asarray(smooth[:, 2:] != smooth[:, :-2])


def _grown(mask: NDArray[np.bool_], radius: int) -> NDArray[np.bool_]:
    """Grow what is True by a disc.

    Row by row of the disc, from its ends to its middle, where it is wider: the mask is widened step by step, and each
    width is moved up and down.
    """
    grown = np.zeros_like(mask)
    wide = mask.copy()
    reached = 0
    for up in range(radius, -1, -1):
        for _ in range(math.isqrt(radius * radius + radius - up * up) - reached):
            wider = wide.copy()
            wider[:, 1:] |= wide[:, :-1]
            wider[:, :-1] |= wide[:, 1:]
            wide = wider
            reached += 1
        grown[up:] |= wide[: len(wide) - up]
        grown[: len(wide) - up] |= wide[up:]
    return grown


def _mean(pixels: NDArray[np.float32], fine: int) -> NDArray[np.float32]:
    """The means of squares of fine x fine samples."""
    if fine == 1:
        return pixels
    rows, columns = pixels.shape[0] // fine, pixels.shape[1] // fine
    return np.asarray(pixels.reshape(rows, fine, columns, fine, 3).mean(axis=(1, 3), dtype=np.float32))
