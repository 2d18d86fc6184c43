"""The Fourier transform of a silhouette's area: what its copies sum to at a lattice's reciprocal vectors."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy import ndimage

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.escherization.goal_outline import GoalOutline

FREQUENCY_MAX: Final = 4.0
"""The highest frequency that is looked at; relative to one over the square root of the area. Parts of the outline
that are thinner than an eighth of that do not count until areas themselves are compared."""

_STEPS: Final = 10.0
"""How many steps the table has for the reach of the outline, in each direction: cubic splines between them are within
5e-5 of the transform."""

_CHUNK: Final = 1 << 21
"""How many products are held in memory at a time; a count."""


def transform(silhouette: GoalOutline, x: Floats, y: Floats) -> Complexes:
    """The integrals of exp(-2 pi i (x u + y v)) over the silhouette's points (u, v), exact: complex128, shaped as x.

    By Green's theorem a sum over the sides of the polygon, each the transform of a segment. The frequency 0, where it
    is the area, has no such form: it must not be among them.
    """
    start = silhouette.points
    side = np.roll(start, -1) - start
    middle = start + side / 2.0
    flat_x, flat_y = x.ravel(), y.ravel()
    result = np.empty(len(flat_x), complex)
    rows = max(_CHUNK // len(start), 1)
    for first in range(0, len(flat_x), rows):
        u, v = flat_x[first : first + rows, None], flat_y[first : first + rows, None]
        across = u * side.imag - v * side.real
        phase = -2j * np.pi * (u * middle.real + v * middle.imag)
        sums = (across * np.exp(phase) * np.sinc(u * side.real + v * side.imag)).sum(axis=1)
        result[first : first + rows] = sums / (-2j * np.pi * (u * u + v * v)[:, 0])
    return result.reshape(x.shape)


@dataclass(frozen=True, eq=False)
class AreaTransform:
    """The transform of a silhouette of area 1 about its centroid, up to FREQUENCY_MAX, as a table of splines."""

    _step: float
    _zero: int
    _real: Floats
    _imag: Floats

    @classmethod
    def of(cls, silhouette: GoalOutline) -> AreaTransform:
        """The table of a silhouette, which is moved and scaled to its unit."""
        unit = silhouette.unit
        step = 1.0 / (_STEPS * unit.reach)
        zero = math.ceil(FREQUENCY_MAX / step) + 3
        # Off the frequency 0, whose value is the area, 1.
        frequencies = (np.arange(2 * zero + 1) - zero) * step
        x, y = np.meshgrid(frequencies, frequencies, indexing="ij")
        x[zero, zero] = 1.0
        table = transform(unit, x, y)
        table[zero, zero] = 1.0
        return cls(step, zero, ndimage.spline_filter(table.real), ndimage.spline_filter(table.imag))

    def __call__(self, x: Floats, y: Floats) -> Complexes:
        """The transform at frequencies (x, y), not beyond FREQUENCY_MAX: complex128, shaped as x."""
        places = np.stack((x / self._step + self._zero, y / self._step + self._zero)).reshape(2, -1)
        result = np.empty(places.shape[1], complex)
        result.real = ndimage.map_coordinates(self._real, places, prefilter=False)
        result.imag = ndimage.map_coordinates(self._imag, places, prefilter=False)
        return result.reshape(x.shape)
