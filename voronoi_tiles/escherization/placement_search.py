"""The placements of a silhouette in a group whose copies come nearest to covering the plane once.

Copies cover the plane once if their sum, which has the periods of the lattice, is constant: if its Fourier coefficients
at all reciprocal vectors but 0 vanish. These are sums over the operations of the transform of one copy, so that
looking at a placement takes some dozen looks at a table, and the sum of their squares is a smooth function of the
placement: least squares find its minima from many starts at a time, first of low frequencies, whose valleys are wide.
That translates of a figure tile if its transform vanishes so is as old as Fuglede, Journal of Functional Analysis 16
(1974).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.stats import qmc

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.escherization.area_transform import FREQUENCY_MAX, AreaTransform
from voronoi_tiles.escherization.placement_rows import PlacementRows, sides
from voronoi_tiles.groups.wallpaper import WallpaperGroup

_FIRST_FREQUENCY: Final = 1.8
"""What is looked at first; in the unit of FREQUENCY_MAX. Details that are finer than a quarter of the size make
valleys of their own, some hundred of them for each good one."""

_LOOKS: Final = 4096
"""How many placements are looked at, at most; a count."""

_STARTS: Final = 128
"""How many of them at most, the best, are led into their valleys, and half of these to the bottom; a count."""

_LOOKS_EACH: Final = 32
_STARTS_EACH: Final = 4
"""Where one or two numbers are free fewer placements fill the space: so many to the power of how many are free, and
twice as many starts; counts."""

_ROUGH_STEPS: Final = 12
_FINE_STEPS: Final = 16
"""How many steps of least squares are made for each, at low and at all frequencies; counts."""

_DIFFERENCE: Final = 1e-5
"""The step of differences that stand for derivatives; radians, fractions, logarithms."""

_STEP_MAX: Final = 0.3
"""The longest step of a number of a row; in the same."""

_SAME: Final = 1e-3
"""Two minima whose values differ by less, relative to the larger, are one, found again; symmetric ones have the same
value."""

_NEARLY: Final = 1e-2
"""The same after the steps at low frequencies, which do not reach the bottom."""


class _Waves(NamedTuple):
    """Reciprocal vectors of a group, one of each orbit, n of them, and their images under its k operations.

    `images` (intp, n x k x 2) are in integers, `phase` (complex128, n x k) what the operations' translations turn them
    by, and `weight` (float64, n) the square root of how many vectors there are in the orbit.
    """

    images: Ints
    phase: Complexes
    weight: Floats


def _different(values: Floats, share: float) -> list[int]:
    """The numbers of values that differ by more than a share of them, the least first."""
    kept: list[int] = []
    for k in np.argsort(values, kind="stable").tolist():
        if not kept or values[k] - values[kept[-1]] > share * values[k] + 1e-9:
            kept.append(k)
    return kept


@dataclass(frozen=True, eq=False)
class PlacementSearch:
    """Placements of a silhouette, of area 1, among some of a group."""

    among: PlacementRows
    transform: AreaTransform

    @property
    def _group(self) -> WallpaperGroup:
        """The group."""
        return self.among.group

    def found(self, seed: int = 0) -> list[Floats]:
        """The free numbers of minima, each once, the best first; the same for the same seed, from 0."""
        low, high = self.among.low, self.among.high
        count = min(_LOOKS, _LOOKS_EACH ** len(low))
        free = low + (high - low) * qmc.Sobol(len(low), seed=seed).random(count)
        waves = self._waves(_FIRST_FREQUENCY)
        values = (self._residuals(free, waves, _FIRST_FREQUENCY) ** 2).sum(axis=1)
        starts = min(_STARTS, 2 * _STARTS_EACH ** len(low))
        free = free[np.argsort(values, kind="stable")[:starts]]
        free, values = self._led_down(free, waves, _FIRST_FREQUENCY, _ROUGH_STEPS)
        free = free[_different(values, _NEARLY)[: starts // 2]]
        free, values = self._led_down(free, self._waves(FREQUENCY_MAX), FREQUENCY_MAX, _FINE_STEPS)
        return list(free[_different(values, _SAME)])

    def _led_down(self, free: Floats, waves: _Waves, highest: float, steps: int) -> tuple[Floats, Floats]:
        """Free numbers led towards minima by Levenberg's and Marquardt's method, all at a time, and their values."""
        count = free.shape[1]
        damping = np.full(len(free), 1e-2)
        residuals = self._residuals(free, waves, highest)
        values = (residuals**2).sum(axis=1)
        for _ in range(steps):
            slopes = np.empty((*residuals.shape, count))
            for k in range(count):
                moved = free.copy()
                moved[:, k] += _DIFFERENCE
                slopes[:, :, k] = (self._residuals(moved, waves, highest) - residuals) / _DIFFERENCE
            matrix = np.einsum("nij,nik->njk", slopes, slopes)
            diagonal = np.einsum("njj->nj", matrix)
            damped = matrix + np.eye(count) * (damping[:, None] * (diagonal + 1e-9))[:, None, :]
            right = np.einsum("nij,ni->nj", slopes, residuals)
            step = np.clip(-np.linalg.solve(damped, right[..., None])[..., 0], -_STEP_MAX, _STEP_MAX)
            tried = self.among.clipped(free + step)
            new = self._residuals(tried, waves, highest)
            new_values = (new**2).sum(axis=1)
            better = new_values < values
            free = np.where(better[:, None], tried, free)
            residuals = np.where(better[:, None], new, residuals)
            values = np.where(better, new_values, values)
            damping = np.clip(np.where(better, damping * 0.3, damping * 5.0), 1e-7, 1e4)
        return free, values

    def _waves(self, highest: float) -> _Waves:
        """The reciprocal vectors that may be as low as a frequency, for some cell within the bounds."""
        # A vector's integers are its products with the cell's sides, which are longest at the bounds.
        bounds = self.among.rows(np.stack((self.among.low, self.among.high)))
        a, b = (math.floor(highest * float(np.abs(side).max())) for side in sides(self._group, bounds))
        i, j = np.arange(-a, a + 1), np.arange(-b, b + 1)
        vectors = np.stack(np.meshgrid(i, j, indexing="ij"), axis=-1).reshape(-1, 2)
        # Of operations that differ by a centring one is enough: the others say which vectors there are.
        operations = {operation.linear: operation for operation in reversed(self._group.operations)}
        linear = np.array([*operations]).reshape(-1, 2, 2)
        shifts = np.array([[float(t) for t in operation.translation] for operation in operations.values()])
        # Vectors are mapped by transposes; the orbit's representative is its greatest, as conjugates are one as well.
        images = np.einsum("kji,hj->hki", linear, vectors)
        both = np.concatenate((images, -images), axis=1)
        order = both[..., 0] * (4 * len(j)) + both[..., 1]
        own = vectors[:, 0] * (4 * len(j)) + vectors[:, 1]
        first = (own == order.max(axis=1)) & (own > 0)
        if len(operations) < self._group.order:  # centred by x + 1/2, y + 1/2
            first &= vectors.sum(axis=1) % 2 == 0
        sizes = np.array([len(np.unique(row)) for row in order[first]])
        phase = np.exp(-2j * np.pi * (vectors[first] @ shifts.T))
        return _Waves(images[first], phase, np.sqrt(sizes))

    def _residuals(self, free: Floats, waves: _Waves, highest: float) -> Floats:
        """The Fourier coefficients of the sum of all copies, real and imaginary parts: float64 (m, 2 n).

        They fade out towards the highest frequency: none comes in with a step as the cell changes.
        """
        rows = self.among.rows(free)
        a, b = sides(self._group, rows)
        along, across = waves.images[..., 0], waves.images[..., 1]
        # The reciprocal vectors of a, along +x, and b.
        a_x, a_y, b_y = 1.0 / a.real, -b.real / (a.real * b.imag), 1.0 / b.imag
        x0 = along[None, :, 0] * a_x[:, None]
        y0 = along[None, :, 0] * a_y[:, None] + across[None, :, 0] * b_y[:, None]
        length = np.hypot(x0, y0)
        row, wave = np.nonzero(length < highest)
        h, k = along[wave], across[wave]
        x, y = h * a_x[row, None], h * a_y[row, None] + k * b_y[row, None]
        cos, sin = np.cos(rows[row, :1]), np.sin(rows[row, :1])
        copies = self.transform(cos * x + sin * y, cos * y - sin * x) * waves.phase[wave]
        if self._group.name != "p1":
            copies *= np.exp(-2j * np.pi * (h * rows[row, 1:2] + k * rows[row, 2:3]))
        fading = np.cos(0.5 * np.pi * length[row, wave] / highest) * waves.weight[wave] / h.shape[1]
        sums = np.zeros((len(rows), len(waves.weight)), complex)
        sums[row, wave] = copies.sum(axis=1) * fading
        return np.concatenate((sums.real, sums.imag), axis=1)
