"""The Voronoi cells of a site's elements: row by row, what bounds them and where."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.base.kernels import BOOLS, COMPLEXES, FLOAT, FLOATS, INT, INTS, kernel
from voronoi_tiles.base.tolerance import EPSILON
from voronoi_tiles.vector.cells.bisectors import TouchingElementsError, find_bisectors
from voronoi_tiles.vector.cells.candidates import TooManyPairsError, find_candidates, move_levels, seeds_of, uncertainty
from voronoi_tiles.vector.cells.envelope import lower_envelope
from voronoi_tiles.vector.cells.half_edges import Contour
from voronoi_tiles.vector.cells.hierarchy import Hierarchy, build_hierarchy
from voronoi_tiles.vector.cells.images import surround
from voronoi_tiles.vector.cells.partial_quadratics import PartialQuadratics
from voronoi_tiles.vector.cells.pencils import Rows
from voronoi_tiles.vector.copies import Copies

# Rows that are worked on at once: enough for numpy's overhead to vanish, few enough for some 100 MB.
_CHUNK = 1024
# Pairs of rows and elements held at once; where there are more, the rows are halved. A pair takes some 500 bytes.
_PAIRS = 1_000_000
# Parts for which the compiled kernel has room at first: of each row, and besides.
_PER_ROW, _ROOM = 4, 1000
# What the compiled kernel takes of a contour, and of everything, as in cells.c; what it answers.
_OF_CONTOUR = (
    "nodes",
    "source",
    "target",
    "direction",
    "length",
    "corner_node",
    "arriving",
    "leaving",
    "turn",
    "bounding",
)
_COMPILED = kernel(
    "cells_bound",
    *(INT, INTS, INTS, COMPLEXES, COMPLEXES, FLOATS, FLOATS, *[COMPLEXES] * 6, FLOATS),
    *(INT, COMPLEXES, INTS, INTS, COMPLEXES, FLOATS, INTS, COMPLEXES, COMPLEXES, FLOATS, BOOLS),
    *(INT, INT, COMPLEXES, COMPLEXES, BOOLS, INTS),
    *(INT, COMPLEXES, COMPLEXES, FLOATS, COMPLEXES, COMPLEXES, INTS, INTS, INTS, INTS, FLOAT),
    *(INT, INT, INTS, INTS, INTS, COMPLEXES, COMPLEXES, INTS),
)
_UNBOUNDED, _TOUCHING = -1, -2


@dataclass(frozen=True, slots=True)
class Parts:
    """What bounds the rows' cells: the parts of their lower envelopes, by row and along each row's variable.

    Part k belongs to the row `row[k]` (intp). Beyond it lies an element of the copy `copy[k]` (intp): `item[k]` (intp)
    is its half-edge i, or its corner c as h + c, where there are h half-edges. It runs from `begin[k]` to `end[k]`
    (complex128). No part is empty, and consecutive ones of a row share their ends, bit for bit.
    """

    row: Ints
    copy: Ints
    item: Ints
    begin: Complexes
    end: Complexes


class UnboundedCellError(ArithmeticError):
    """A cell came out unbounded, which happens only where copies touch or cross."""


def bound_cells(rows: Rows, contour: Contour, copies: Copies, node_bundle: Ints, covering_radius: float) -> Parts:
    """What bounds every cell of the sites.

    `rows` and `contour` are those of all sites, `copies` of all their bundles; `node_bundle` (intp, m) is the bundle of
    each of the contour's nodes, `covering_radius` the lattice's. Raises UnboundedCellError where a cell comes out
    unbounded, TouchingElementsError where a node lies on another copy.
    """
    hierarchy = build_hierarchy(contour, node_bundle)
    compiled = _COMPILED()
    if compiled is not None:
        return _bound_compiled(compiled, rows, contour, copies, hierarchy, covering_radius)
    around, levels = surround(contour, copies, node_bundle), move_levels(hierarchy, copies)
    rounding, seeds, found = uncertainty(levels[0]), seeds_of(rows, contour, hierarchy), []
    waiting = [(start, min(start + _CHUNK, len(rows))) for start in range(0, len(rows), _CHUNK)][::-1]
    while waiting:
        start, stop = waiting.pop()
        chunk = rows.slice(start, stop)
        most = _PAIRS if stop - start > 1 else inf
        try:
            candidates, bounds = find_candidates(chunk, levels, seeds[start:stop], covering_radius, rounding, most)
        except TooManyPairsError:
            middle = (start + stop) // 2
            waiting += [(middle, stop), (start, middle)]
            continue
        functions = find_bisectors(chunk, around, hierarchy.element, candidates, bounds)
        parts = _locate(chunk, functions, *lower_envelope(functions, chunk.low, chunk.high))
        found.append(Parts(parts.row + start, parts.copy, parts.item, parts.begin, parts.end))
    return _joined(found)


def _bound_compiled(
    compiled: Callable[..., int],
    rows: Rows,
    contour: Contour,
    copies: Copies,
    hierarchy: Hierarchy,
    covering_radius: float,
) -> Parts:
    """The same by the compiled kernel, row by row."""
    of_rows = [getattr(rows, name) for name in Rows.__slots__]
    of_contour = [getattr(contour, name) for name in _OF_CONTOUR]
    of_copies = copies.bundles, copies.unit, copies.shift, copies.conj, copies.bundle
    of_hierarchy = [getattr(hierarchy, name) for name in Hierarchy.__slots__]
    found, first, progress, more = [], 0, np.zeros(2, np.intp), _ROOM
    while first < len(rows):
        room = _PER_ROW * (len(rows) - first) + more
        row, copy, item = (np.empty(room, np.intp) for _ in range(3))
        begin, end = np.empty(room, complex), np.empty(room, complex)
        status = compiled(
            *(len(rows), *of_rows, len(contour.source), *of_contour, len(copies), *of_copies),
            *(len(hierarchy.level) - 1, *of_hierarchy, covering_radius),
            *(first, room, row, copy, item, begin, end, progress),
        )
        if status:
            raise {_UNBOUNDED: UnboundedCellError, _TOUCHING: TouchingElementsError}.get(status, MemoryError)
        first, count = progress.tolist()
        if not count:  # the next row alone has more parts
            more = 2 * room
            continue
        found.append(Parts(row[:count], copy[:count], item[:count], begin[:count], end[:count]))
    return _joined(found)


def _joined(found: list[Parts]) -> Parts:
    """All parts of several, in their order."""
    if len(found) == 1:
        return found[0]
    return Parts(*(np.concatenate([getattr(parts, name) for parts in found]) for name in Parts.__slots__))


def _locate(rows: Rows, functions: PartialQuadratics, row: Ints, start: Floats, end: Floats, function: Ints) -> Parts:
    """The parts of envelopes with their ends in the plane.

    They are given as `lower_envelope` gives them. Raises UnboundedCellError where one has no function, or a row no
    part.
    """
    # Where three functions meet, rounding may leave one of them an interval of an ulp: a break would be located by it.
    null = 4.0 * EPSILON * np.maximum(np.abs(rows.low), np.abs(rows.high))
    kept = (end - start > null[row]).nonzero()[0]
    row, start, end, function = row[kept], start[kept], end[kept], function[kept]
    first = np.append(True, row[1:] != row[:-1])
    start[first] = rows.low[row[first]]
    end[:-1] = np.where(first[1:], end[:-1], start[1:])
    last = np.append(first[1:], True)
    end[last] = rows.high[row[last]]
    if np.count_nonzero(first) < len(rows) or (function < 0).any():
        raise UnboundedCellError
    # Each break is located once, with the flatter of the two functions that meet there: an error in x then moves
    # the point by no more than itself.
    inner = (~first[1:]).nonzero()[0]
    before, after, at = function[inner], function[inner + 1], end[inner]
    at_start = function.copy()
    at_start[inner + 1] = np.where(
        np.abs(functions.slope(before, at)) <= np.abs(functions.slope(after, at)), before, after
    )
    by, x = np.concatenate((at_start, function[last])), np.concatenate((start, end[last]))
    point = _point(rows, np.concatenate((row, row[last])), x, functions.value(by, x))
    begin, finish = point[: len(row)], np.empty(len(row), complex)
    finish[inner], finish[last] = begin[inner + 1], point[len(row) :]
    return Parts(row, functions.copy[function], functions.item[function], begin, finish)


def _point(rows: Rows, row: Ints, x: Floats, value: Floats) -> Complexes:
    """The points of rows at x where the function has this value."""
    straight = rows.straight[row]
    if (value[~straight] >= 0.0).any():
        raise UnboundedCellError
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.where(straight, x, (1.0 - x) * (1.0 + x) / -value)
        # Where two strokes of the site meet, rounding may put the height below 0.
        left = np.where(straight, np.maximum(value, 0.0), 2.0 * x / -value)
    axis, result = rows.axis[row], rows.origin[row]
    result.real += axis.real * along - axis.imag * left
    result.imag += axis.real * left + axis.imag * along
    return result
