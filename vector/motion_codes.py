"""Motions in arrays: each is one integer, so that thousands are composed, compared and sorted at once.

A code holds the linear part in its highest bits, then twice the translation, both coordinates made positive. Codes are
in the order of the motions that they stand for. They are made of translations by up to 2^26 cells; motions farther away
are held as tuples of integers only.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from voronoi_tiles.base.arrays import Bools, Complexes, Ints
from voronoi_tiles.base.kernels import COMPLEXES, FLOAT, FLOATS, INT, INTS, kernel
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.vector.motions import IDENTITY, LINEAR_PARTS, Action, Motion, compose, inverse, to_operation

Codes = npt.NDArray[np.int64]
"""Motions, one integer each."""

_BITS = 29
_HALF = 1 << (_BITS - 1)
_MASK = (1 << _BITS) - 1

_TRANSLATION = (1 << 2 * _BITS) - 1
# The code of a motion is its linear part's, this, and twice its translation times these.
_ORIGIN = (_HALF << _BITS) + _HALF
_PLACES = np.array([1 << _BITS, 1])

_NUMBER = {linear: k for k, linear in enumerate(LINEAR_PARTS)}
_A, _B, _C, _D = np.array(LINEAR_PARTS, np.int64).T.copy()
_REVERSES = _A * _D - _B * _C < 0
# What each linear part makes of a translation's two coordinates, as part of a code.
_ALONG = np.array(((_A << _BITS) + _C, (_B << _BITS) + _D))
_ALONG_A, _ALONG_B = _ALONG
# The code of each product, row by row, < 0 where the two are of no common group.
_PRODUCT = np.array(
    [
        _NUMBER.get(compose((*outer, 0, 0), (*inner, 0, 0))[:4], -1) << 2 * _BITS
        for outer in LINEAR_PARTS
        for inner in LINEAR_PARTS
    ]
)
# The code of each inverse, and what that makes of a translation's two coordinates.
_INVERSE = np.array([_NUMBER[inverse((*linear, 0, 0))[:4]] for linear in LINEAR_PARTS])
_BACK, _ALONG_BACK = (_INVERSE << 2 * _BITS) + _ORIGIN, np.ascontiguousarray(_ALONG[:, _INVERSE])

# What the compiled kernels take, as in motion_codes.c.
TABLES = len(LINEAR_PARTS), _PRODUCT, _ALONG
"""What compiled kernels take of linear parts: how many there are, their products, what they make of translations."""
OF_TABLES, OF_PLANE = (INT, INTS, INTS), (COMPLEXES, FLOATS, *[FLOAT] * 4)
_IMAGES = kernel("codes_images", INT, INTS, COMPLEXES, *OF_PLANE, INT, INT, COMPLEXES)
_COMPOSED = kernel("codes_composed", INT, INTS, INTS, *OF_TABLES, INTS)
_INVERTED = kernel("codes_inverted", INT, INTS, INT, INTS, INTS, INTS)
_LEAST = kernel("codes_least", INT, INTS, INTS, INT, INTS, *OF_TABLES, INTS)

# The codes of linear parts, by their digits in base 3.
_DIGITS = np.array([27, 9, 3, 1])
_BY_KEY = np.full(81, -1, np.int64)
for _linear, _k in _NUMBER.items():
    _BY_KEY[_DIGITS @ _linear + 40] = _k << 2 * _BITS


TOO_FAR = "a translation that no cell is skew enough for"
"""What is said where a motion has no code."""


def encode(motions: npt.ArrayLike) -> Codes:
    """The codes of motions, given as rows of six integers."""
    rows = np.asarray(motions, np.int64).reshape(-1, 6)
    shift = rows[:, 4:]
    assert not len(rows) or np.abs(shift).max() <= _HALF // 2, TOO_FAR
    return np.asarray(_BY_KEY[rows[:, :4] @ _DIGITS + 40] + (shift @ _PLACES + _ORIGIN))


def code_of(motion: Motion) -> int:
    """The code of one motion."""
    return (_NUMBER[motion[:4]] << 2 * _BITS) + (motion[4] << _BITS) + motion[5] + _ORIGIN


@lru_cache(maxsize=4096)
def motion_of(code: int) -> Motion:
    """The motion of a code."""
    return (*LINEAR_PARTS[code >> 2 * _BITS], ((code >> _BITS) & _MASK) - _HALF, (code & _MASK) - _HALF)


def operation_of(code: int) -> Operation:
    """The operation of a code."""
    return to_operation(motion_of(code))


IDENTITY_CODE = code_of(IDENTITY)
"""The code of the identity."""


def decode(codes: Codes) -> tuple[Codes, Codes, Codes]:
    """The numbers of the linear parts, and twice the translation in both coordinates."""
    return codes >> 2 * _BITS, ((codes >> _BITS) & _MASK) - _HALF, (codes & _MASK) - _HALF


def composed(outer: Codes | int, inner: Codes | int) -> Codes:
    """The motions that apply `inner` first and `outer` to its result; the two broadcast.

    Where they have the same shape, a compiled kernel gives the same.
    """
    outer, inner = np.asarray(outer), np.asarray(inner)
    compiled = _COMPOSED()
    if compiled is not None and outer.shape == inner.shape:
        result = np.empty(outer.shape, np.int64)
        compiled(outer.size, outer, inner, *TABLES, result)
        return result
    one, (two, u, v) = outer >> 2 * _BITS, decode(inner)
    linear = _PRODUCT[one * len(LINEAR_PARTS) + two]
    return np.asarray(linear + (outer & _TRANSLATION) + _ALONG_A[one] * u + _ALONG_B[one] * v)


def moved(codes: Codes, i: Ints, j: Ints) -> Codes:
    """The motions that apply these first, and then translations by i and j along the lattice's vectors."""
    steps = np.array((i, j))
    assert not steps.size or np.abs(steps).max() <= _HALF // 4, TOO_FAR
    return np.asarray(codes + 2 * (_PLACES @ steps))


def inverted(codes: Codes) -> Codes:
    """The motions that undo these. A compiled kernel gives the same."""
    compiled = _INVERTED()
    if compiled is not None:
        result = np.empty_like(codes)
        compiled(codes.size, codes, len(LINEAR_PARTS), _BACK, _ALONG_BACK, result)
        return result
    linear, s, t = decode(codes)
    return np.asarray(_BACK[linear] - _ALONG_BACK[0, linear] * s - _ALONG_BACK[1, linear] * t)


def reversing(codes: Codes) -> Bools:
    """Whether motions turn the plane over."""
    return np.asarray(_REVERSES[codes >> 2 * _BITS])


def modulo(codes: Codes) -> Ints:
    """What names motions modulo the lattice, from 0 to 63."""
    return np.asarray((codes >> 2 * _BITS) * 4 + ((codes >> _BITS) & 1) * 2 + (codes & 1))


def plane_of(action: Action) -> tuple[Any, ...]:
    """What compiled kernels take of an action: the isometries of linear parts, and the lattice's vectors."""
    a, b = action.lattice.a, action.lattice.b
    return *action.isometries, a.real, a.imag, b.real, b.imag


def least_products(codes: Codes, row: Ints, rows: Codes) -> Codes:
    """The least of each motion's products with the motions `rows[row[k]]`, applied before it; itself where row is -1.

    `codes` and `row` are (n,), `rows` (m, w). A compiled kernel gives the same.
    """
    compiled = _LEAST()
    if compiled is not None:
        result = np.empty_like(codes)
        compiled(len(codes), codes, row, rows.shape[1], rows, *TABLES, result)
        return result
    result = codes.copy()
    some = (row >= 0).nonzero()[0]
    result[some] = composed(codes[some, None], rows[row[some]]).min(axis=1)
    return result


def images(action: Action, codes: Codes, z: Complexes, further: tuple[int, int] = (0, 0)) -> Complexes:
    """The images of points, each under its motion: the same bits as `Action.apply` gives.

    `codes` and `z` broadcast; `further` is twice a translation that comes after the motions, of any length. A compiled
    kernel gives the same bits.
    """
    compiled = _IMAGES()
    if compiled is not None:
        if codes.shape != z.shape:
            codes, z = map(np.array, np.broadcast_arrays(codes, z))
        result = np.empty(z.shape, complex)
        compiled(z.size, codes, z, *plane_of(action), *further, result)
        return result
    linear, s, t = decode(codes)
    if further != (0, 0):
        s, t = s + further[0], t + further[1]
    # Spelt out as in `maps.move`, without the arrays between.
    units, signs = action.isometries
    unit, x, y = units[linear], z.real, signs[linear] * z.imag
    i, j, a, b = s / 2, t / 2, action.lattice.a, action.lattice.b
    real = unit.real * x - unit.imag * y + (i * a.real + j * b.real)
    result = np.empty(real.shape, complex)
    result.real = real
    result.imag = unit.imag * x + unit.real * y + (i * a.imag + j * b.imag)
    return result
