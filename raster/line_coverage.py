"""Lines drawn over an image: how much of each sample a stroke covers, antialiased by distance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, counting
from voronoi_tiles.raster.frame import Frame
from voronoi_tiles.raster.scene import from_feet

Floats32 = NDArray[np.float32]

_PIECE = 12.0
"""Longest piece that a line is cut to; samples. The squares about pieces hold few samples far from the line."""

_PORTION = 2_000_000
"""Samples that are handled at once; a count."""


def coverage(segments: Complexes, width: float, frame: Frame) -> Floats32:
    """How much of each sample lines of a width cover: float32 (height, width), 0 to 1.

    `segments` complex128 (n, 2) are Cartesian, `width` in samples. The frame's steps must be at right angles and equal.
    """
    image = np.zeros((frame.height, frame.width), np.float32)
    # Onto the grid of samples, where sample (i, j) is i + 1j j.
    away = segments - (frame.origin + complex(frame.offsets(0.0, 0.0)))
    ends: Complexes = np.empty(segments.shape, complex)
    ends.real = (away.real * frame.u.real + away.imag * frame.u.imag) / abs(frame.u) ** 2
    ends.imag = (away.real * frame.v.real + away.imag * frame.v.imag) / abs(frame.v) ** 2
    margin = width / 2 + 1.0
    start, end = _clipped(ends, -margin, frame.width + margin, -margin, frame.height + margin)
    count = np.maximum(np.ceil(np.abs(end - start) / _PIECE), 1).astype(np.intp)
    number, of = counting(count)
    step = ((end - start) / count)[of]
    middle, half = start[of] + (number + 0.5) * step, step / 2
    side = int(_PIECE + 2 * margin + 2)
    offsets = np.arange(side)
    for k in range(0, len(middle), max(1, _PORTION // side**2)):
        part = slice(k, k + max(1, _PORTION // side**2))
        m, h = middle[part, None, None], half[part, None, None]
        i = np.floor(m.real - side / 2 + 1).astype(np.intp) + offsets[None, None, :]
        j = np.floor(m.imag - side / 2 + 1).astype(np.intp) + offsets[None, :, None]
        distance = np.abs(from_feet(i + 1j * j, m, h))
        cover = np.clip(width / 2 + 0.5 - distance, 0.0, 1.0).astype(np.float32)
        i, j = np.broadcast_arrays(i, j)
        inside = (cover > 0) & (i >= 0) & (i < frame.width) & (j >= 0) & (j < frame.height)
        np.maximum.at(image, (j[inside], i[inside]), cover[inside])
    return image


def dashed(segments: Complexes, dash: float, gap: float) -> Complexes:
    """Cut segments (n, 2) into dashes of a length, with gaps between them; ends are full dashes as far as they fit."""
    length = np.abs(segments[:, 1] - segments[:, 0])
    count = np.maximum(np.round((length + gap) / (dash + gap)), 1).astype(np.intp)
    number, of = counting(count)
    period = (length + gap) / count
    low = number * period[of]
    high = low + (period - gap)[of]
    unit = (segments[:, 1] - segments[:, 0]) / np.where(length > 0, length, 1.0)
    start = segments[of, 0]
    return np.stack((start + low * unit[of], start + high * unit[of]), axis=1)


def _clipped(ends: Complexes, left: float, right: float, low: float, high: float) -> tuple[Complexes, Complexes]:
    """The parts of segments (n, 2) in a rectangle (Liang and Barsky 1984)."""
    start, chord = ends[:, 0], ends[:, 1] - ends[:, 0]
    first, last = np.zeros(len(ends)), np.ones(len(ends))
    for at, step, least, most in (
        (start.real, chord.real, left, right),
        (start.imag, chord.imag, low, high),
    ):
        with np.errstate(divide="ignore", invalid="ignore"):
            one, other = (least - at) / step, (most - at) / step
        flat = step == 0.0
        outside = flat & ((at < least) | (at > most))
        one, other = np.where(flat, -np.inf, one), np.where(flat, np.inf, other)
        first = np.maximum(first, np.minimum(one, other))
        last = np.where(outside, -1.0, np.minimum(last, np.maximum(one, other)))
    hit = last >= first
    start, chord, first, last = start[hit], chord[hit], first[hit], last[hit]
    return start + first * chord, start + last * chord
