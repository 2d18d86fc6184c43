"""Edges of the tiling: maximal runs of arcs between two tiles, each paired with all its images.

Seen from the tile beyond, and wherever a site's own symmetry maps it, an edge is an edge of some base tile again. All
of these are found, and which motion takes which to which: so they form orbits, of which one edge each is needed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, counting, counts_of, next_in_ring, offsets_of
from voronoi_tiles.base.kernels import BOOLS, COMPLEXES, FLOAT, INT, INTS, kernel
from voronoi_tiles.base.tolerance import PROOF_LIMIT
from voronoi_tiles.vector.complex.edge_cuts import Cuts, cut_further
from voronoi_tiles.vector.complex.left_out_edges import without
from voronoi_tiles.vector.complex.site_symmetry import SiteSymmetry
from voronoi_tiles.vector.complex.traced import Traced
from voronoi_tiles.vector.motion_codes import (
    IDENTITY_CODE,
    OF_PLANE,
    Codes,
    composed,
    images,
    inverted,
    plane_of,
    reversing,
)
from voronoi_tiles.vector.motions import Action

# How far an edge may be from the image of its counterpart, relative to the cell's size. Where copies nearly touch,
# vertices are known to far fewer digits along their edges; the proof judges what comes of it.
PAIRING = 1e-3
# An edge this short, on the same scale, may have come out in one tile only.
_ONE_SIDED = 1e-6
# What the compiled kernel takes, as in edges.c.
_AGREE = kernel("complex_agree", INT, *[INTS] * 4, BOOLS, *[INTS] * 4, COMPLEXES, *OF_PLANE, FLOAT, BOOLS)


@dataclass(frozen=True, eq=False)
class Edges:
    """The edges of all tiles: m maximal runs of arcs that face one copy, ring after ring.

    A ring that faces one copy all round is cut at one vertex or several. Edge k are the arcs
    `arcs[offsets[k] : offsets[k + 1]]` (intp) of the boundaries `traced`, the first of them `start[k]`; the edge
    `following[k]` (intp) starts where it ends. It is part of the boundary of the tile `tile[k]`, and beyond it lies the
    copy of the site `site[k]` (intp) under `motion[k]` (int64). The edges of ring r are those from `ring_offsets[r]` up
    to, not including, `ring_offsets[r + 1]` (intp).

    Link j says that `by[j]` maps the edge `source[j]` onto the edge `image[j]` (intp), whose arcs then come `backwards`
    (bool). The links from edge k are those from `links[k]` up to, not including, `links[k + 1]` (intp, m + 1), that
    under the identity first.
    """

    traced: Traced
    arcs: Ints
    offsets: Ints
    start: Ints
    following: Ints
    ring_offsets: Ints
    tile: Ints
    site: Ints
    motion: Codes
    links: Ints
    image: Ints
    by: Codes
    backwards: Bools

    def __len__(self) -> int:
        """The number of edges."""
        return len(self.following)

    @property
    def last(self) -> Ints:
        """The arc at the end of each edge."""
        return self.arcs[self.offsets[1:] - 1]

    @property
    def counts(self) -> Ints:
        """The number of arcs of each edge."""
        return counts_of(self.offsets)

    @cached_property
    def source(self) -> Ints:
        """The edge that each link comes from."""
        return np.arange(len(self)).repeat(counts_of(self.links))

    @cached_property
    def around(self) -> Ints:
        """The arcs of each edge, and behind them the one that starts where it ends, intp (n + m).

        Those of edge k begin at `offsets[k] + k`.
        """
        edge = np.arange(len(self))
        around = np.empty(len(self.arcs) + len(self), np.intp)
        around[np.arange(len(self.arcs)) + edge.repeat(self.counts)] = self.arcs
        around[self.offsets[1:] + edge] = self.start[self.following]
        return around

    @cached_property
    def orbits(self) -> tuple[Ints, Ints]:
        """The edges that stand for their orbits, the first of each; and for each edge the link that leads to it."""
        bounds, image = self.links.tolist(), self.image.tolist()
        link_to = [-1] * len(self)
        kept = []
        for edge in range(len(self)):
            if link_to[edge] < 0:
                kept.append(edge)
                for link in range(bounds[edge], bounds[edge + 1]):
                    if link_to[image[link]] < 0:
                        link_to[image[link]] = link
        return np.array(kept), np.array(link_to)

    @cached_property
    def symmetries(self) -> Ints:
        """The links of edges to themselves under other motions than the identity."""
        return np.flatnonzero((self.image == self.source) & (self.by != IDENTITY_CODE))

    def arcs_around(self, edge: int) -> Ints:
        """The arcs of one edge, and the one that starts where it ends."""
        first, last = (self.offsets[edge : edge + 2] + edge).tolist()
        return self.around[first : last + 1]

    def course(self, edge: int) -> Complexes:
        """The points at the ends of an edge's arcs, and between these one of each arc, halfway by its parameter."""
        around = self.arcs_around(edge)
        course = np.empty(2 * len(around) - 1, complex)
        course[::2], course[1::2] = self.traced.vertex[around], self.traced.middles[around[:-1]]
        return course


class UnpairedEdgeError(ArithmeticError):
    """The edge number `edge` of `edges` has no counterpart in the tile beyond, or no image there."""

    def __init__(self, edges: Edges, edge: int) -> None:
        super().__init__("an edge has no counterpart in the tile beyond")
        self.edges, self.edge = edges, edge


def find_edges(action: Action, symmetry: SiteSymmetry, traced: Traced, *, without_short: bool) -> Edges:
    """The edges of all base tiles, each with its images.

    Edges that rounding has made, where many tiles meet, are left out of the boundaries. `without_short` leaves out all
    that may be such; this is tried as well where the edges cannot be paired otherwise. Raises UnpairedEdgeError where
    they cannot be paired at all.
    """
    edges = _without_short_edges(traced, (_ONE_SIDED if without_short else PROOF_LIMIT) * action.size)
    pinched = True
    while True:
        try:
            return _paired(action, symmetry, edges, pinched=pinched)
        except UnpairedEdgeError as error:
            traced, arcs = error.edges.traced, error.edges.arcs_around(error.edge)
            vertex, rest = traced.vertex[arcs], np.ones(len(traced), bool)
            rest[arcs[:-1]] = False
            # Where two beyond nearly touch, it does not show on this side how far apart rounding has put the ends.
            last_resort = without_short and not pinched
            limit = max((PAIRING if last_resort else _ONE_SIDED) * action.size, _spread(traced, arcs))
            short = np.abs(vertex - vertex[0]).max() <= limit
            if short and (rest & (traced.tile == error.edges.tile[error.edge])).any():
                edges = _between(without(traced, np.flatnonzero(rest)))
            elif pinched:
                pinched = False
            elif not without_short:
                return find_edges(action, symmetry, traced, without_short=True)
            else:
                raise


def _spread(traced: Traced, around: Ints) -> float:
    """How far apart rounding may have put the ends of an edge, where what meets there nearly touches.

    `around` are its arcs and the one after them.
    """
    before = np.flatnonzero(traced.following == around[0])
    return 16 * float(traced.uncertainty[np.append(before, around)].max())


def _without_short_edges(traced: Traced, limit: float) -> Edges:
    """The edges of boundaries without those that extend no farther than a limit; of rings with no other, all.

    They are not paired yet, and end only where the copy beyond changes.
    """
    edges = _between(traced)
    chord = traced.vertex[traced.following[edges.start]] - traced.vertex[edges.start]
    if (np.abs(chord) > limit).all():  # nearly always: the first arcs alone go farther
        return edges
    counts = edges.counts + 1
    extent = np.abs(traced.vertex[edges.around] - traced.vertex[edges.start].repeat(counts))
    long = np.maximum.reduceat(extent, edges.offsets[:-1] + np.arange(len(edges))) > limit
    if long.all():
        return edges
    long |= np.repeat(~np.logical_or.reduceat(long, edges.ring_offsets[:-1]), counts_of(edges.ring_offsets))
    if long.all():
        return edges
    return _between(without(traced, np.sort(edges.arcs[np.repeat(long, edges.counts)])))


def _between(traced: Traced, cuts: Cuts | None = None) -> Edges:
    """The edges between cuts, not paired yet; a ring without a cut is cut at its start.

    Without `cuts` they end where the copy beyond changes.
    """
    if cuts is None:
        cuts = traced.changes
    offsets = traced.offsets
    whole = ~np.logical_or.reduceat(cuts, offsets[:-1])
    if whole.any():
        cuts = cuts.copy()
        cuts[offsets[:-1][whole]] = True
    # Edges start at the cuts, and each ring begins with its first one.
    start = cuts.nonzero()[0]
    ring_offsets = start.searchsorted(offsets)
    skipped, sizes = start[ring_offsets[:-1]] - offsets[:-1], counts_of(offsets)
    arcs = np.arange(len(traced)) + skipped.repeat(sizes)
    arcs -= np.where(arcs >= offsets[1:].repeat(sizes), sizes.repeat(sizes), 0)
    begins = start - skipped.repeat(counts_of(ring_offsets))
    none = np.zeros(0, np.intp)
    return Edges(
        traced=traced,
        arcs=arcs,
        offsets=np.concatenate((begins, offsets[-1:])),
        start=start,
        following=next_in_ring(ring_offsets),
        ring_offsets=ring_offsets,
        tile=traced.tile[start],
        site=traced.site[start],
        motion=traced.motion[start],
        links=none,
        image=none,
        by=none,
        backwards=none.astype(bool),
    )


def _paired(action: Action, symmetry: SiteSymmetry, edges: Edges, *, pinched: bool) -> Edges:
    """The edges of boundaries, ring after ring, each with its images.

    `edges` end where the copy beyond changes, and at one place in each ring that faces one copy only. `pinched` looks
    for vertices at which a boundary touches itself, and ends edges there: such a tile may have the same neighbour
    before and after the vertex, while an edge of that neighbour ends. Raises UnpairedEdgeError.
    """
    traced = edges.traced
    cuts = cut_further(action, symmetry, traced, pinched=pinched)
    if cuts is not traced.changes:
        edges = _between(traced, cuts)
    count = len(edges)
    # Every way to move an edge between a base tile and the copy of a site onto a base tile: by what maps the tile's
    # site onto itself, and by what takes the copy beyond to its own base tile.
    if symmetry.general:
        links, source = np.arange(0, 2 * count + 1, 2), np.repeat(np.arange(count), 2)
        by = np.full(2 * count, IDENTITY_CODE)
        under = inverted(edges.motion)
        by[1::2] = under
        wanted, on, facing = links[:-1] + 1, edges.site, edges.tile
        backwards = np.zeros(2 * count, bool)
        backwards[1::2] = ~reversing(under)
    else:
        own, theirs = symmetry.order[edges.tile], symmetry.order[edges.site]
        links = offsets_of(own + theirs)
        k, source = counting(own + theirs)
        tile, site, motion = edges.tile[source], edges.site[source], edges.motion[source]
        back = k >= own[source]
        first = np.where(back, symmetry.offsets[site] - own[source], symmetry.offsets[tile])
        element = symmetry.stabilizer[first + k]
        by = np.where(back, composed(element, inverted(motion)), element)
        under = np.where(back, by, composed(element, motion))
        under = symmetry.canonical(np.where(back, tile, site), under)
        backwards = reversing(by) != back
        wanted = np.flatnonzero(k > 0)
        on, facing, under = np.where(back, site, tile)[wanted], np.where(back, tile, site)[wanted], under[wanted]
    # The identity's links lead back; of the others, those edges may be the images that face the right copy.
    image = np.empty(len(source), np.intp)
    image[links[:-1]] = np.arange(count)
    edges = replace(edges, links=links, image=image, by=by, backwards=backwards)
    key, asked, sites = edges.motion, under, len(symmetry.order)
    if sites > 1:
        motions = np.unique(np.concatenate((key, asked)), return_inverse=True)[1]
        key = (edges.tile * sites + edges.site) * len(motions) + motions[:count]
        asked = (on * sites + facing) * len(motions) + motions[count:]
    order = np.argsort(key, kind="stable")
    key = key[order]
    low, high = key.searchsorted(asked), key.searchsorted(asked, "right")
    if (low == high).any():
        raise UnpairedEdgeError(edges, int(source[wanted[np.flatnonzero(low == high)[0]]]))
    edges.image[wanted] = order[low]
    several = high - low > 1
    unsure = several | ~_agree(action, edges, wanted)
    for row in np.flatnonzero(unsure).tolist():
        edges.image[wanted[row]] = _nearest(action, edges, int(wanted[row]), order[low[row] : high[row]])
    if several.any():
        _refuse_shared(edges)
    return edges


def _refuse_shared(edges: Edges) -> None:
    """Raise UnpairedEdgeError for an edge whose image is taken back to another one."""
    # An edge has one link of each motion and direction, and its image the inverse of each.
    count = len(edges.by)
    motion = np.unique((edges.by, inverted(edges.by)), return_inverse=True)[1].reshape(2, count)
    here, there = np.array((edges.source, edges.image)) * (4 * count) + 2 * motion + edges.backwards
    order = here.argsort()
    back = edges.image[order[here[order].searchsorted(there)]]
    shared = edges.source[back != edges.source]
    if len(shared):
        raise UnpairedEdgeError(edges, int(shared[0]))


def _agree(action: Action, edges: Edges, links: Ints) -> Bools:
    """Whether the images of edges under links plainly have the vertices of those that they lead to.

    A compiled kernel gives the same.
    """
    compiled = _AGREE()
    if compiled is not None:
        agree = np.empty(len(links), bool)
        given = links, edges.source, edges.image, edges.by, edges.backwards, edges.offsets, edges.arcs
        vertices = edges.start, edges.following, edges.traced.vertex, *plane_of(action)
        compiled(len(links), *given, *vertices, _ONE_SIDED * action.size, agree)
        return agree
    source, image = edges.source[links], edges.image[links]
    counts, first = edges.counts, edges.offsets[:-1] + np.arange(len(edges))
    here, there = counts[source], counts[image]
    place, row = counting(here + 1)
    # Of an edge with fewer vertices the last one stands for those that it lacks.
    other = np.minimum(np.where(edges.backwards[links][row], here[row] - place, place), there[row])
    vertex = edges.traced.vertex[edges.around]
    one, two = vertex[first[source][row] + place], vertex[first[image][row] + other]
    gap = images(action, edges.by[links][row], one) - two
    limit = _ONE_SIDED * action.size
    near = gap.real * gap.real + gap.imag * gap.imag <= limit * limit
    return np.asarray((here == there) & np.logical_and.reduceat(near, offsets_of(here + 1)[:-1]))


def _nearest(action: Action, edges: Edges, link: int, candidates: Ints) -> int:
    """The one of some edges that a link's image of its edge comes nearest to. Raises UnpairedEdgeError.

    In a thin cell all is near, on the scale of the longer side: no edge is farther from its image than either extends,
    but for those that rounding may have made.
    """
    source = int(edges.source[link])
    image = images(action, edges.by[link], edges.course(source))
    if edges.backwards[link]:
        image = image[::-1]
    least, most = _ONE_SIDED * action.size, PAIRING * action.size
    courses = [edges.course(other) for other in candidates.tolist()]
    limits = [min(max(least, min(_extent(image), _extent(course))), most) for course in courses]
    gaps = [_gap(image, course, limit) for course, limit in zip(courses, limits, strict=True)]
    best = int(np.argmin(gaps))
    if gaps[best] > limits[best]:
        raise UnpairedEdgeError(edges, source)
    return int(candidates[best])


def _extent(course: Complexes) -> float:
    """How far points are from the first of them."""
    return float(np.abs(course - course[0]).max())


def _gap(one: Complexes, other: Complexes, limit: float) -> float:
    """How far the courses of two edges are from being the same.

    Where they do not agree one by one, points at equal shares of their lengths are compared: rounding may split a
    vertex, in one of the two, into several.
    """
    if len(one) == len(other):
        gap = float(np.abs(one - other).max())
        if gap <= limit:
            return gap
    shares = np.linspace(0.0, 1.0, 9)
    places = []
    for course in (one, other):
        run = np.append(0.0, np.cumsum(np.abs(np.diff(course))))
        places.append(
            np.interp(shares * run[-1], run, course.real) + 1j * np.interp(shares * run[-1], run, course.imag)
        )
    return float(np.abs(places[0] - places[1]).max())
