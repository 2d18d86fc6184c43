"""From the bounds of single cells to the closed boundaries of tiles."""

from __future__ import annotations

import cmath
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, next_in_ring, starts
from voronoi_tiles.base.kernels import BOOLS, COMPLEXES, FLOAT, INT, INTS, kernel
from voronoi_tiles.base.neighbours import Neighbours
from voronoi_tiles.vector.cells.cells import Parts
from voronoi_tiles.vector.cells.half_edges import Contour
from voronoi_tiles.vector.cells.pencils import Rows

# What the compiled kernels take, as in trace.c; what they answer.
_LINKS = kernel(
    "trace_links",
    *(INTS, INTS, INT, INTS, INTS, INTS, COMPLEXES, COMPLEXES, INT, INTS, INTS, INT, INTS, INTS, INT),
    *(FLOAT, FLOAT, INTS, BOOLS, BOOLS, COMPLEXES, COMPLEXES, INTS),
)
_RINGS = kernel("trace_rings", INT, INTS, BOOLS, COMPLEXES, INTS, INT, FLOAT, INTS, COMPLEXES, INTS)
_OPEN = -1
# Turns the plane so that no mirror and no row of copies is upright.
_SLANT = cmath.exp(1j)


@dataclass(frozen=True, slots=True)
class Boundary:
    """The closed boundaries of all tiles, n arcs ring after ring: a tile lies to the left of every arc of its own.

    Arc k is the part `part[k]` (intp) of some row. It starts at `vertex[k]` (complex128) and ends where the next arc of
    the ring `ring[k]` (intp) starts.
    """

    part: Ints
    vertex: Complexes
    ring: Ints


class OpenBoundaryError(ArithmeticError):
    """The parts do not close to rings, which happens only where copies touch or cross."""


class _Links(NamedTuple):
    """How the parts chain up; one entry for each.

    `following` (intp) is the next part where that is plain, else -1; `inner` tells which face their own site, and
    `entered` (bool) which are the next one of some part. `start` and `end` (complex128) are the ends counter-clockwise
    around the tile, `site` (intp) is whose tile that is.
    """

    following: Ints
    inner: Bools
    entered: Bools
    start: Complexes
    end: Complexes
    site: Ints


def trace_boundary(rows: Rows, contour: Contour, parts: Parts, node_site: Ints, bundles: int, null: float) -> Boundary:
    """The rings to which those parts chain up that face another site or copy.

    `rows`, `contour` and `parts` are those of all sites; `node_site` (intp, m) is the site of each of the contour's
    nodes, and the first `bundles` copies are the sites where they were placed. Arcs whose ends are no farther apart
    than `null` are left out. Raises OpenBoundaryError where the parts do not close to rings, or a tile has none.
    """
    links = _links(rows, contour, parts, node_site, bundles)
    if (~links.inner & ((links.following < 0) | ~links.entered)).any():
        _close(links)
    return _rings(links, int(node_site[-1]) + 1, null)


def _close(links: _Links) -> None:
    """Chain up what is left, in place: ends and starts of a site that are each other's nearest, then those still left.

    Raises OpenBoundaryError where a site has not as many starts as ends.
    """
    following, inner, entered, start, end, site = links
    loose, entries = np.flatnonzero(~inner & (following < 0)), np.flatnonzero(~inner & ~entered)
    if not np.array_equal(np.sort(site[loose]), np.sort(site[entries])):
        raise OpenBoundaryError
    for tile in np.unique(site[loose]).tolist():
        some, others = loose[site[loose] == tile], entries[site[entries] == tile]
        following[some] = others[_nearest(end[some], start[others])]


def _rings(links: _Links, sites: int, null: float) -> Boundary:
    """The rings to which the parts of so many sites chain up, each with its arcs that are longer than `null`."""
    following, inner, _, start, _, site = links
    compiled = _RINGS()
    if compiled is None:
        return _walk(links, sites, null)
    part, vertex, ring = np.empty(len(site), np.intp), np.empty(len(site), complex), np.empty(len(site), np.intp)
    count = compiled(len(site), following, inner.copy(), start, site, sites, null, part, vertex, ring)
    if count < 0:
        raise OpenBoundaryError if count == _OPEN else MemoryError
    return Boundary(part[:count], vertex[:count], ring[:count])


def _walk(links: _Links, sites: int, null: float) -> Boundary:
    """The same without the kernel."""
    following, inner, _, start, _, site = links
    # A walk along a permutation is a loop of look-ups: a list is quicker at it than any array trick.
    successor = following.tolist()
    seen = inner.tolist()
    order: list[int] = []
    ring: list[int] = []
    number = 0
    for first in np.flatnonzero(~inner).tolist():
        if seen[first]:
            continue
        k = first
        while not seen[k]:
            seen[k] = True
            order.append(k)
            ring.append(number)
            k = successor[k]
        number += 1
    part = np.array(order, np.intp)
    boundary = _without_null(part, start[part], np.array(ring, np.intp), null)
    if not np.bincount(site[boundary.part], minlength=sites).all():
        raise OpenBoundaryError
    return boundary


def _links(rows: Rows, contour: Contour, parts: Parts, node_site: Ints, bundles: int) -> _Links:
    """How the parts chain up, as far as it is plain from the order of the contour and from where they start and end."""
    compiled = _LINKS()
    if compiled is None:
        return _plain_links(rows, contour, parts, node_site, bundles)
    count = len(parts.row)
    (following, site), (inner, entered) = np.empty((2, count), np.intp), np.empty((2, count), np.bool_)
    start, end = np.empty((2, count), complex)
    links = _Links(following, inner, entered, start, end, site)
    of_parts = (getattr(parts, name) for name in Parts.__slots__)
    of_contour = len(contour.source), contour.source, contour.following, len(contour.corner_node), contour.corner_node
    sites = node_site, bundles, _SLANT.real, _SLANT.imag
    if compiled(rows.half_edge, rows.corner, count, *of_parts, *of_contour, *sites, *links):
        raise MemoryError
    return links


def _plain_links(rows: Rows, contour: Contour, parts: Parts, node_site: Ints, bundles: int) -> _Links:
    """The same without the kernel."""
    count = len(parts.row)
    straight = rows.straight[parts.row]
    # Counter-clockwise around the tile, x falls along half-edges and rises along corners.
    start, end = np.where(straight, parts.end, parts.begin), np.where(straight, parts.begin, parts.end)
    node = np.concatenate((contour.source, contour.corner_node))
    site = node_site[node[np.where(rows.straight, rows.half_edge, len(contour.source) + rows.corner)]][parts.row]
    inner = (parts.copy < bundles) & (node_site[node[parts.item]] == site)
    following = np.full(count, -1)
    same = np.flatnonzero(parts.row[1:] == parts.row[:-1])
    falling, rising = same[straight[same]], same[~straight[same]]
    following[falling + 1] = falling
    following[rising] = rising + 1
    first = np.searchsorted(parts.row, np.arange(len(rows)))
    last = np.append(first[1:], count) - 1
    # Rows of one half-edge or corner follow each other by ascending x.
    again = (rows.half_edge[1:] == rows.half_edge[:-1]) & (rows.corner[1:] == rows.corner[:-1])
    before = np.flatnonzero(again)
    falling, rising = before[rows.straight[before]], before[~rows.straight[before]]
    following[first[falling + 1]] = last[falling]
    following[last[rising]] = first[rising + 1]
    # The first and last row of each half-edge and corner.
    opening, closing = np.flatnonzero(np.append(True, ~again)), np.flatnonzero(np.append(~again, True))
    half_edges = len(contour.source)
    half_edge_first, half_edge_last = _ends(rows.half_edge, half_edges, opening, closing, first, last)
    corner_first, corner_last = _ends(rows.corner, len(contour.corner_node), opening, closing, first, last)
    # The corner between half-edges a and b = following[a]: counter-clockwise around the tile, from b over it to a.
    b = contour.following
    present, round_corner = half_edge_first >= 0, corner_first[:half_edges] >= 0
    has, bare = np.flatnonzero(present & round_corner), np.flatnonzero(present & ~round_corner)
    following[half_edge_first[b[has]]] = corner_first[has]
    following[corner_last[has]] = half_edge_last[has]
    following[half_edge_first[b[bare]]] = half_edge_last[bare]
    # An isolated node's four corners are numbered clockwise.
    lone = np.arange(half_edges, len(contour.corner_node))
    following[corner_last[lone]] = corner_first[lone - 1 + 4 * ((lone - half_edges) % 4 == 0)]
    following[inner | inner[following]] = -1
    entered = np.zeros(count, bool)
    entered[following[following >= 0]] = True
    links = _Links(following, inner, entered, start, end, site)
    _match(links)
    return links


def _ends(owner: Ints, count: int, opening: Ints, closing: Ints, first: Ints, last: Ints) -> tuple[Ints, Ints]:
    """The first and last part of each half-edge or corner, -1 where it has no rows."""
    result = np.full((2, count), -1)
    rows = np.flatnonzero(owner[opening] >= 0)
    which = owner[opening[rows]]
    result[0, which], result[1, which] = first[opening[rows]], last[closing[rows]]
    return result[0], result[1]


def _match(links: _Links) -> None:
    """Chain up, in place, those of each site that come in the same order along one direction: nearly all do.

    They must be nearer to their partners than to others. Where a site has not as many starts as ends, nothing is done.
    """
    following, inner, entered, start, end, site = links
    loose, entries = np.flatnonzero(~inner & (following < 0)), np.flatnonzero(~inner & ~entered)
    if not len(loose) or not np.array_equal(np.sort(site[loose]), np.sort(site[entries])):
        return
    x, y = (z.real * _SLANT.real - z.imag * _SLANT.imag for z in (end[loose], start[entries]))
    left, right = np.lexsort((x, site[loose])), np.lexsort((y, site[entries]))
    loose, entries, x, y = loose[left], entries[right], x[left], y[right]
    step = end[loose] - start[entries]
    gap = np.sqrt(step.real * step.real + step.imag * step.imag)
    apart = np.minimum(x[1:] - y[:-1], y[1:] - x[:-1])
    apart[site[loose[1:]] != site[loose[:-1]]] = np.inf
    infinite = np.array([np.inf])
    sure = (gap < np.concatenate((apart, infinite))) & (gap < np.concatenate((infinite, apart)))
    following[loose[sure]] = entries[sure]
    entered[entries[sure]] = True


def _nearest(ends: Complexes, begins: Complexes) -> Ints:
    """For each of the ends one of as many begins: each other's nearest, then among those that are left."""
    partner = np.full(len(ends), -1)
    left = right = np.arange(len(ends))
    while len(left):
        there = Neighbours(begins[right]).nearest(ends[left])[1][:, 0]
        back = Neighbours(ends[left]).nearest(begins[right])[1][:, 0]
        mutual = np.flatnonzero(back[there] == np.arange(len(left)))
        partner[left[mutual]] = right[there[mutual]]
        left, right = np.delete(left, mutual), np.delete(right, there[mutual])
    return partner


def _without_null(part: Ints, vertex: Complexes, ring: Ints, null: float) -> Boundary:
    """The boundary without arcs that have no length, and without rings that have no other."""
    while len(part):
        following = next_in_ring(np.append(starts(ring), len(ring)))
        step = vertex[following] - vertex
        kept = np.sqrt(step.real * step.real + step.imag * step.imag) > null
        if kept.all():
            break
        part, vertex, ring = part[kept], vertex[kept], ring[kept]
    if not len(part):
        raise OpenBoundaryError
    return Boundary(part, vertex, ring)
