"""Partial quadratics: functions of a row's variable, each a quadratic on an interval and undefined outside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Floats, Ints

Quadratics = tuple[Floats, Floats, Floats, Floats]
"""Coefficients a, b, c and m of quadratics a (x - m)^2 + b (x - m) + c, float64 (k,) each."""


@dataclass(frozen=True, slots=True)
class PartialQuadratics:
    """Functions a (x - m)^2 + b (x - m) + c on [low, high], the bisectors of a row's element with another one.

    Function k belongs to the row `row[k]` (intp), on the interval from `low[k]` to `high[k]`; `a`, `b`, `c` and `m` are
    its coefficients (float64, k). The other element is one of the copy `copy[k]`: `item[k]` (intp) is its half-edge i,
    or its corner c as h + c, where there are h half-edges.
    """

    row: Ints
    low: Floats
    high: Floats
    a: Floats
    b: Floats
    c: Floats
    m: Floats
    copy: Ints
    item: Ints

    @classmethod
    def concatenate(cls, parts: Sequence[PartialQuadratics]) -> PartialQuadratics:
        """All functions of several, in their order; there is at least one part."""
        return cls(*(np.concatenate([getattr(part, name) for part in parts]) for name in cls.__slots__))

    def take(self, index: Ints) -> PartialQuadratics:
        """The functions at the given indices."""
        return PartialQuadratics(*(getattr(self, name)[index] for name in self.__slots__))

    def value(self, index: Ints, x: Floats) -> Floats:
        """The values at x of the functions at the given indices."""
        step = x - self.m[index]
        return self.c[index] + step * (self.b[index] + step * self.a[index])

    def differences(self, pair: Ints, x: Floats) -> tuple[Floats, Floats, Floats]:
        """The first less the second of pairs of functions, intp (2, k): differences of values and slopes at x, of a."""
        a, b = self.a[pair], self.b[pair]
        step = x - self.m[pair]
        value, slope = self.c[pair] + step * (b + step * a), b + 2.0 * a * step
        return value[0] - value[1], slope[0] - slope[1], a[0] - a[1]

    def slope(self, index: Ints, x: Floats) -> Floats:
        """The derivatives at x of the functions at the given indices."""
        return self.b[index] + 2.0 * self.a[index] * (x - self.m[index])
