"""Numbers as decimal texts, all at once: millimetres to the nanometre.

Python writes a few million floats a second less than a sheet of tiles needs; here digits are looked up in arrays.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Bools

Bytes = NDArray[np.uint8]

PLACES: Final = 6
"""Digits after the point: nanometres, a thousandth of what any cutter resolves."""

LARGEST: Final = 999_999.0
"""Largest number, in millimetres: a kilometre."""

WIDTH: Final = 14
"""The bytes of a number: its sign, six digits, the point, six digits."""

_TRIPLES = np.array([[48 + k // 100, 48 + k // 10 % 10, 48 + k % 10] for k in range(1000)], np.uint8)
_LEADING = np.array([0 if k >= 100 else 1 if k >= 10 else 2 if k else 3 for k in range(1000)])
_TRAILING = np.array([3 if not k else 2 if k % 100 == 0 else 1 if k % 10 == 0 else 0 for k in range(1000)])


def decimals(values: NDArray[np.float64], *, point: bool = False) -> tuple[Bytes, Bools]:
    """Write numbers, rounded to PLACES digits after the point, without exponent and without needless zeros.

    Returns the bytes (n, WIDTH) and which of them belong to the text. With `point` there is always a digit after
    the point ("3.0"), else it is left out with the zeros ("3"). Zero has no sign. Raises ValueError for numbers
    that are not finite or beyond LARGEST.
    """
    if not (np.abs(values) <= LARGEST).all():
        raise ValueError(f"a coordinate is not a number, or beyond {LARGEST:,.0f} mm")
    scaled = np.rint(values * 10.0**PLACES).astype(np.int64)
    size = np.abs(scaled)
    whole, rest = np.divmod(size, 10**PLACES)
    high, low = np.divmod(whole, 1000)
    first, second = np.divmod(rest, 1000)
    text = np.empty((len(values), WIDTH), np.uint8)
    text[:, 0] = ord("-")
    text[:, 1:4], text[:, 4:7] = _TRIPLES[high], _TRIPLES[low]
    text[:, 7] = ord(".")
    text[:, 8:11], text[:, 11:14] = _TRIPLES[first], _TRIPLES[second]
    # The first digit that counts, at least the one before the point; and the last one.
    begin = np.minimum(np.where(high > 0, _LEADING[high], 3 + _LEADING[low]), 5) + 1
    stop = np.where(second > 0, 14 - _TRAILING[second], 11 - _TRAILING[first])
    stop = np.maximum(stop, 9) if point else np.where(stop == 8, 7, stop)
    column = np.arange(WIDTH)
    used = (column >= begin[:, None]) & (column < stop[:, None])
    used[:, 0] = scaled < 0
    return text, used


def decimal_texts(values: NDArray[np.float64], *, point: bool = False) -> list[str]:
    """The texts of numbers, as `decimals` writes them."""
    text, used = decimals(values, point=point)
    breaks = np.full((len(values), 1), ord("\n"), np.uint8)
    lines = np.hstack((text, breaks))[np.hstack((used, breaks > 0))]
    return lines.tobytes().decode("ascii").split("\n")[:-1]
