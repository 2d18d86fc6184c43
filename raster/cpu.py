"""The CPU renderer: numpy, float64, all processor cores. It serves where there is no OpenGL."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, Floats, owned_ranges
from voronoi_tiles.raster.block_lists import BlockLists
from voronoi_tiles.raster.frame import BLOCK, Frame
from voronoi_tiles.raster.scene import Labels

_RUNS = 192
"""Runs that a thread works on at once: with BLOCK^2 float64 each they stay within a core's cache."""


_Scalar = TypeVar("_Scalar", bound=np.generic)

Heights = Callable[[Floats, Floats], Floats]


def render(
    candidates: BlockLists, frame: Frame, *, heights: Heights | None = None
) -> tuple[Labels, Labels, Floats, Floats]:
    """The owner of every sample, the nearest different copy, and both distances: arrays (height, width).

    The distances are exact up to the rounding of float64 (Pattern.rounding). With `heights` they are those of a mesh:
    its height at points that lie so far beyond an element's end, and so far across from it.
    """
    count = len(candidates)
    first = np.empty((count, BLOCK * BLOCK), np.int32)
    second = np.empty_like(first)
    d1 = np.empty((count, BLOCK * BLOCK))
    d2 = np.empty_like(d1)
    bounds = np.searchsorted(candidates.run_start, np.arange(0, candidates.run_start[-1], _RUNS), side="left")
    bounds = np.unique(np.append(bounds, count))

    def work(k: int) -> None:
        part = slice(int(bounds[k]), int(bounds[k + 1]))
        first[part], second[part], d1[part], d2[part] = _two_nearest(
            candidates, _run_squares(candidates, part, frame, heights), part
        )

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(work, range(len(bounds) - 1)))
    return (
        _as_image(first, candidates.columns, frame),
        _as_image(second, candidates.columns, frame),
        _as_image(d1, candidates.columns, frame),
        _as_image(d2, candidates.columns, frame),
    )


def _run_squares(candidates: BlockLists, part: slice, frame: Frame, heights: Heights | None) -> Floats:
    """The squared distance of each run of some blocks from the blocks' samples: (runs, BLOCK^2).

    Longest runs first, step k takes the k-th element of all runs that have so many: these are the first ones.
    """
    scene = candidates.scene
    runs = np.arange(candidates.run_start[part.start], candidates.run_start[part.stop])
    block = np.repeat(np.arange(part.start, part.stop), np.diff(candidates.run_start[part.start : part.stop + 1]))
    start = candidates.element_start[runs]
    size = candidates.element_start[runs + 1] - start
    order = np.argsort(-size, kind="stable")
    active = np.searchsorted(-size[order], -np.arange(int(size.max())), side="left")
    start, block = start[order], block[order]
    # Everything that belongs to one element, for all elements of these runs at once.
    span = slice(int(candidates.element_start[runs[0]]), int(candidates.element_start[runs[-1] + 1]))
    element = candidates.element[span]
    unit, length = scene.unit[element], scene.length[element]
    home = np.repeat(candidates.centre[block], size[order])
    place = np.empty(len(element), np.intp)
    place[owned_ranges(start - span.start, start - span.start + size[order])[0]] = np.arange(len(element))
    away = home[place] - scene.middle[element]
    step = np.arange(BLOCK) - BLOCK / 2
    nearest = np.full((len(runs), BLOCK, BLOCK), np.inf)
    along = np.empty_like(nearest)
    across = np.empty_like(nearest)
    for k, count in enumerate(active.tolist()):
        index = start[:count] + k - span.start
        e: Complexes = unit[index, None]
        w: Complexes = away[index, None]
        half_length = length[index, None, None]
        a, c = along[:count], across[:count]
        rows: Floats = _dot(w, e) + step * _dot(frame.v, e)
        np.add(rows[:, :, None], (step * _dot(frame.u, e))[:, None, :], out=a)
        rows = _cross(e, w) + step * _cross(e, frame.v)
        np.add(rows[:, :, None], (step * _cross(e, frame.u))[:, None, :], out=c)
        np.abs(a, out=a)
        a -= half_length
        np.maximum(a, 0.0, out=a)
        if heights is None:
            a *= a
            c *= c
            a += c
        else:
            a[...] = heights(a, c) ** 2
        np.minimum(nearest[:count], a, out=nearest[:count])
    back = np.empty_like(order)
    back[order] = np.arange(len(order))
    return nearest.reshape(len(runs), -1)[back]


def _two_nearest(candidates: BlockLists, square: Floats, part: slice) -> tuple[Labels, Labels, Floats, Floats]:
    """The labels of the two nearest copies of some blocks' samples and their distances."""
    start = candidates.run_start[part] - candidates.run_start[part.start]
    size = np.diff(candidates.run_start[part.start : part.stop + 1])
    label = candidates.run_label[candidates.run_start[part.start] : candidates.run_start[part.stop]]
    order = np.argsort(-size, kind="stable")
    active = np.searchsorted(-size[order], -np.arange(int(size.max())), side="left")
    start = start[order]
    shape = (len(order), BLOCK * BLOCK)
    near1, near2 = np.full(shape, np.inf), np.full(shape, np.inf)
    label1, label2 = np.full(shape, -1, np.int32), np.full(shape, -1, np.int32)
    for k, count in enumerate(active.tolist()):
        new, name = square[start[:count] + k], label[start[:count] + k, None]
        d1, d2, l1, l2 = near1[:count], near2[:count], label1[:count], label2[:count]
        first = new < d1
        second = new < d2
        second &= ~first
        np.copyto(l2, l1, where=first)
        np.copyto(l2, name, where=second)
        np.copyto(l1, name, where=first)
        np.copyto(d2, d1, where=first)
        np.copyto(d2, new, where=second)
        np.copyto(d1, new, where=first)
    back = np.empty_like(order)
    back[order] = np.arange(len(order))
    return label1[back], label2[back], np.sqrt(near1)[back], np.sqrt(near2)[back]


def _dot(a: Complexes | complex, b: Complexes) -> Floats:
    return np.asarray(a.real * b.real + a.imag * b.imag)


def _cross(a: Complexes, b: Complexes | complex) -> Floats:
    return np.asarray(a.real * b.imag - a.imag * b.real)


def _as_image(blocks: NDArray[_Scalar], columns: int, frame: Frame) -> NDArray[_Scalar]:
    """Put blocks of BLOCK^2 samples together to an image (height, width)."""
    whole = blocks.reshape(-1, columns, BLOCK, BLOCK).swapaxes(1, 2).reshape(-1, columns * BLOCK)
    return np.ascontiguousarray(whole[: frame.height, : frame.width])
