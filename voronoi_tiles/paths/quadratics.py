"""Quadratic Bezier curves in closed form."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats


def quadratic_lengths(start: Complexes, control: Complexes, end: Complexes) -> Floats:
    """The lengths of quadratic Bezier curves, float64 (n,), to a few units in the last place.

    Half the derivative runs linearly from p = control - start to q = end - control. With coordinates x along q - p
    and y across it, the length is (|p| + |q|)/2 + (x_p + x_q)^2 / (2 (|p| + |q|)) + y^2 (asinh(x_q/y) - asinh(x_p/y)) /
    |q - p|: three terms that are never negative, so nothing cancels. Degenerate: q = p (no bend) is a segment, y = 0
    (folded upon itself) drops the last term.

    Source: the integral of sqrt(x^2 + y^2), with asinh b - asinh a = asinh(b sqrt(1 + a^2) - a sqrt(1 + b^2)).
    """
    p, q = control - start, end - control
    bend = np.abs(q - p)
    length_p, length_q = np.abs(p), np.abs(q)
    total = length_p + length_q
    straight = bend <= 0.0
    safe_bend = np.where(straight, 1.0, bend)
    along = (q - p) / safe_bend
    x_p = p.real * along.real + p.imag * along.imag
    x_q = q.real * along.real + q.imag * along.imag
    # Across: the same for p and q; the shorter one gives it with the smaller error.
    short = np.where(length_p < length_q, p, q)
    y = np.abs(along.real * short.imag - along.imag * short.real)
    folded = straight | (y <= 1e-100 * total)  # then the last term is below 1e-197 of the length
    safe_y = np.where(folded, 1.0, y)
    one_side = x_p * x_q > 0.0
    denominator = np.where(one_side, x_q * length_p + x_p * length_q, 1.0)
    near = np.arcsinh((x_p + x_q) * bend / denominator)
    across = np.arcsinh(x_q / safe_y) - np.arcsinh(x_p / safe_y)
    turn = np.where(folded, 0.0, y * y * np.where(one_side, near, across) / safe_bend)
    safe_total = np.where(total == 0.0, 1.0, total)
    curve = total / 2 + (x_p + x_q) ** 2 / (2 * safe_total) + turn
    lengths: Floats = np.where(straight, total, curve)
    return lengths
