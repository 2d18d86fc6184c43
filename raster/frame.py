"""Where an image's samples lie: a grid of points over a cell of the lattice or over a rectangle."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.groups.wallpaper import Lattice

BLOCK = 16
"""Samples along the side of a block, the part of an image that shares one list of candidates."""

WINDOW = 128 * BLOCK
"""Largest side of what is rendered at once; samples. 2048 x 2048 of them take some 200 MB."""

PHASE = (0.381966, 0.276393)
"""Where in its pixel a sample lies: no simple fraction, or the samples of a group with mirrors would lie on these."""


@dataclass(frozen=True)
class Frame:
    """A grid of `width` x `height` samples; sample (i, j) lies at origin + (i + phase[0]) u + (j + phase[1]) v.

    `origin`, `u` and `v` are Cartesian, in the design's units; i counts columns, j rows. `column` and `row` are the
    first sample of a window of a larger grid (see `window`).
    """

    origin: complex
    u: complex
    v: complex
    width: int
    height: int
    phase: tuple[float, float] = PHASE
    column: int = 0
    row: int = 0

    def __post_init__(self) -> None:
        if self.width < 1 or self.height < 1:
            raise ArgumentError(f"an image of {self.width} x {self.height} samples is empty")

    @property
    def pixel(self) -> float:
        """The longer of the two steps between samples, in units."""
        return max(abs(self.u), abs(self.v))

    @property
    def area_per_sample(self) -> float:
        """The area that one sample stands for, in square units."""
        return abs(self.u.real * self.v.imag - self.u.imag * self.v.real)

    def steps(self, i: Floats | float, j: Floats | float) -> Complexes:
        """The vectors i u + j v; i and j may be fractions and broadcast."""
        x, y = np.asarray(i, float), np.asarray(j, float)
        vectors = np.empty(np.broadcast_shapes(x.shape, y.shape), np.complex128)
        vectors.real = x * self.u.real + y * self.v.real
        vectors.imag = x * self.u.imag + y * self.v.imag
        return vectors

    def offsets(self, i: Floats | float, j: Floats | float) -> Complexes:
        """The positions, from `origin`, of samples of this window; i and j may be fractions, and broadcast."""
        return self.steps(np.asarray(i) + (self.column + self.phase[0]), np.asarray(j) + (self.row + self.phase[1]))

    def points(self, i: Floats | float, j: Floats | float) -> Complexes:
        """The Cartesian positions of samples; i and j may be fractions, and broadcast."""
        return self.origin + self.offsets(i, j)

    @property
    def middle(self) -> complex:
        """The middle of the window, from `origin`."""
        return complex(self.offsets(self.width / 2, self.height / 2))

    @property
    def radius(self) -> float:
        """How far the window's samples, and one more on every side, are from the middle at most."""
        x, y = (self.width / 2 + 1) * self.u, (self.height / 2 + 1) * self.v
        return max(abs(x + y), abs(x - y))

    def half_diagonal(self, side: float) -> float:
        """How far the corners of side x side steps are from their middle."""
        return side / 2 * max(abs(self.u + self.v), abs(self.u - self.v))

    def window(self, column: int, row: int, width: int, height: int) -> Frame:
        """A part of the grid, which may reach beyond it: its samples lie where they lay, up to rounding."""
        return replace(self, column=self.column + column, row=self.row + row, width=width, height=height)


def cell_frame(lattice: Lattice, samples: int, *, centre: complex = 0j) -> Frame:
    """The frame of one cell of the reduced basis: about `samples` x `samples` steps, nearly as long as wide.

    Sample (i + width, j) is sample (i, j) moved by a lattice vector: this is an image of the whole plane.
    """
    a, b = lattice.reduced_basis
    shape = (abs(a) / abs(b)) ** 0.5
    width, height = max(1, round(samples * shape)), max(1, round(samples / shape))
    return Frame(centre - (a + b) / 2, a / width, b / height, width, height)


def rectangle_frame(region: tuple[float, float, float, float], width: int, height: int) -> Frame:
    """The frame of a picture of the rectangle x0, y0, x1, y1: the first row at the top, samples at pixels' middles."""
    x0, y0, x1, y1 = region
    if not (x1 > x0 and y1 > y0):
        raise ArgumentError(f"the region {region} is empty")
    if width < 1 or height < 1:
        raise ArgumentError(f"an image of {width} x {height} samples is empty")
    return Frame(
        complex(x0, y1), complex((x1 - x0) / width), complex(0.0, (y0 - y1) / height), width, height, (0.5, 0.5)
    )
