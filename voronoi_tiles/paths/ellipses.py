"""Arcs of ellipses, measured from the middles of their chords, and cubic Bezier curves in their place."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import Final, NamedTuple

from voronoi_tiles.base.maps import Affine, unit_at

_RADIUS_MIN: Final = 1e-100
"""Radii that are smaller are none: a chord divided by them need not be a number; in the coordinates' unit."""

_SHARE_MIN: Final = 1e-18
"""Finest error of cubics; relative to the ellipse. It is below all rounding, and bounds their number."""


class EllipticalArc(NamedTuple):
    """The arc z(s) = (start + end) / 2 + across sin(s) + out (cos(s) - cos(half)), -half <= s <= half.

    `across` and `out` are conjugate half diameters of the ellipse, the first along the chord, the second to the middle
    of the arc; 2 `half` is the angle that the arc takes on the unit circle whose image the ellipse is, 0 < half <= pi,
    radians. `start` and `end` are the arc's ends, taken as they are. Nothing is measured from the centre, which is lost
    in rounding where the ellipse is huge beside the chord.
    """

    start: complex
    end: complex
    across: complex
    out: complex
    half: float

    @classmethod
    def between(
        cls, start: complex, end: complex, radii: tuple[float, float], degrees: float, large: bool, sweep: bool
    ) -> EllipticalArc | None:
        """The arc between two points as SVG gives it, None where it is a line; the points differ.

        The radii, 0 or more, are along axes that are turned by `degrees`; those that are too small for the chord are
        enlarged. `large` asks for more than half the ellipse, `sweep` for a turn from x to y. Source: SVG 1.1, F.6.
        """
        rx, ry = radii
        if min(rx, ry) < _RADIUS_MIN:
            return None
        turn = unit_at(degrees)
        chord = (end - start) / 2.0 * turn.conjugate()
        on_circle = complex(chord.real / rx, chord.imag / ry)
        h = abs(on_circle)  # half the chord of the unit circle, the sine of half the angle
        if h < _RADIUS_MIN:
            return None
        along = on_circle / h
        if h >= 1.0:
            rx, ry, half = rx * h, ry * h, math.pi / 2.0
        else:
            half = math.pi - math.asin(h) if large else math.asin(h)
        to_ellipse = Affine(turn * (rx + ry) / 2.0, turn * (rx - ry) / 2.0, 0j)
        return cls(start, end, to_ellipse(along), to_ellipse(along * (-1j if sweep else 1j)), half)

    @classmethod
    def about(cls, start: complex, end: complex, ellipse: Affine, begin: float, turn: float) -> EllipticalArc:
        """The arc of the image of the unit circle under the linear part of a map.

        It runs from the angle `begin` of the unit circle by `turn` (radians, > 0 from x to y), which are at `start` and
        `end`.
        """
        linear = Affine(ellipse.a, ellipse.b, 0j)
        middle = cmath.rect(1.0, begin + turn / 2.0)
        along = middle * complex(0.0, math.copysign(1.0, turn))
        return cls(start, end, linear(along), linear(middle), abs(turn) / 2.0)

    @property
    def ellipse(self) -> Affine:
        """A linear map from the unit circle to the ellipse."""
        return Affine((self.across - 1j * self.out) / 2.0, (self.across + 1j * self.out) / 2.0, 0j)

    def point(self, s: float) -> complex:
        """The point z(s)."""
        # cos(s) - cos(half) as a product, free of cancellation.
        height = 2.0 * math.sin((self.half - s) / 2.0) * math.sin((self.half + s) / 2.0)
        return (self.start + self.end) / 2.0 + (math.sin(s) * self.across + height * self.out)

    def tangent(self, s: float) -> complex:
        """The derivative of z at s."""
        return math.cos(s) * self.across - math.sin(s) * self.out

    def cubic_count(self, share: float) -> int:
        """How many cubics stay within `share` of the ellipse's larger radius.

        Source: with handles of 4/3 tan(t/4), a cubic is within 4/27 sin(t/4)^6 / cos(t/4)^2 of a unit arc of angle t:
        Goldapp, "Approximation of circular arcs by cubic polynomials", 1991.
        """
        cosine = math.cos(math.pi / 8.0)  # the least, for a quarter
        step = 4.0 * math.pow(max(share, _SHARE_MIN) * cosine**2 * 27.0 / 4.0, 1.0 / 6.0)
        return math.ceil(2.0 * self.half / min(math.pi / 2.0, step))

    def cubics(self, count: int) -> Iterator[tuple[complex, complex, complex]]:
        """So many cubic Bezier curves over equal angles: both control points and the end of each."""
        handle = 4.0 / 3.0 * math.tan(self.half / (2.0 * count))
        here, leaving = self.start, handle * self.tangent(-self.half)
        for k in range(1, count + 1):
            s = self.half * (2 * k - count) / count
            there = self.end if k == count else self.point(s)
            arriving = handle * self.tangent(s)
            yield here + leaving, there - arriving, there
            here, leaving = there, arriving
