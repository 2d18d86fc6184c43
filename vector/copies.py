"""The copies of a site that can shape a tile, as exact motions and as isometries of the plane."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, counts_of, offsets_of, starts
from voronoi_tiles.base.kernels import BOOLS, COMPLEXES, INT, INTS, kernel
from voronoi_tiles.base.neighbours import Neighbours
from voronoi_tiles.base.tolerance import EPSILON, SAME_POINT
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.vector.motion_codes import IDENTITY_CODE, TOO_FAR, Codes, code_of, decode, moved
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, compose, modulo_lattice

# How much of a site's distance from the origin its images may be off by the rounding of coordinates there.
_ROUNDING = 4 * EPSILON
# Copies for which the compiled kernel has room at first, and what it takes, as in copies.c.
_ROOM = 100
_COMPILED = kernel(
    "copies_near",
    *(INT, INTS, COMPLEXES, BOOLS, INTS, INT, COMPLEXES, INTS, COMPLEXES, INTS),
    *(INT, INTS, COMPLEXES, COMPLEXES, BOOLS, INTS),
)


@dataclass(frozen=True, slots=True)
class Placed:
    """A base site moved by a lattice vector to near the origin, with what its copies depend on.

    What was drawn far away is known to fewer digits: there a site that is symmetric up to these is made symmetric.
    `nodes` (complex128, m) and `segments` (intp, n x 2) are as in a site; `shift` are the integer coordinates of the
    vector that leads back to the site as it was drawn. `stabilizer` are the motions that map the site onto itself, the
    identity first; `representatives` has one motion for each copy in a cell, modulo translations.
    """

    nodes: Complexes
    segments: Ints
    shift: tuple[int, int]
    stabilizer: tuple[Motion, ...]
    representatives: tuple[Motion, ...]

    def canonical(self, motion: Motion) -> Motion:
        """The motion that names the copy onto which `motion` takes the site."""
        if len(self.stabilizer) == 1:
            return motion
        return next(
            m for m in (compose(motion, s) for s in self.stabilizer) if modulo_lattice(m) in self.representatives
        )


@dataclass(frozen=True, slots=True)
class SiteUnion:
    """All sites in one: the nodes of one after those of the other, and so the segments.

    `nodes` (complex128, m) are positions, `segments` (intp, n x 2) indices of them. The nodes of site k, all with the
    number k in `node_site` (intp, m), are those from `first[k]` up to, not including, `first[k + 1]` (intp, sites + 1).
    """

    nodes: Complexes
    segments: Ints
    node_site: Ints
    first: Ints

    @classmethod
    def of(cls, sites: Sequence[NodedSite] | Sequence[Placed]) -> SiteUnion:
        """The union of some sites."""
        counts = [len(site.nodes) for site in sites]
        first, nodes = offsets_of(counts), np.concatenate([site.nodes for site in sites])
        segments = np.concatenate([site.segments for site in sites])
        if len(sites) > 1:
            segments = segments + np.repeat(first[:-1], [len(site.segments) for site in sites])[:, None]
        return cls(nodes, segments, np.repeat(np.arange(len(sites)), counts), first)


def place(action: Action, sites: Sequence[NodedSite]) -> tuple[list[Placed], SiteUnion]:
    """Sites moved near the origin, each with its stabilizer; and all in one."""
    union = SiteUnion.of(sites)
    nodes, first = union.nodes, union.first[:-1]
    sides = nodes.real, nodes.imag
    (left, low), (right, high) = ([bound.reduceat(side, first) for side in sides] for bound in (np.minimum, np.maximum))
    x, y = action.lattice.fractional((left + right) / 2 + (low + high) * 0.5j)
    # A site within a cell of the origin stays where it was drawn.
    far = np.maximum(np.abs(x), np.abs(y)) > 2
    shifts, rounding = [(0, 0)] * len(sites), [0.0] * len(sites)
    if far.any():
        shifts = [(round(s), round(t)) if moved else (0, 0) for s, t, moved in zip(x, y, far, strict=True)]
        away = action.cartesian(*np.transpose(shifts))
        nodes = np.where(far[union.node_site], nodes - away[union.node_site], nodes)
        rounding = (_ROUNDING * np.abs(away)).tolist()
    own = [nodes[begin:end] for begin, end in pairwise(union.first.tolist())]
    scale = max(action.size, float((right - left).max()), float((high - low).max()))
    centroid = np.asarray(np.add.reduceat(nodes, first) / counts_of(union.first), complex)
    stabilizers: list[tuple[Motion, ...]] = [(IDENTITY,)] * len(sites)
    for k in _nearly_fixed(action, centroid, 4 * max(SAME_POINT * scale, *rounding)):
        stabilizers[k] = _stabilizer(action, own[k], sites[k].segments, rounding[k])
        if far[k]:
            own[k] = symmetrized(action, own[k], stabilizers[k])
    representatives = {stabilizer: _representatives(action, stabilizer) for stabilizer in set(stabilizers)}
    placed = [
        Placed(own[k], site.segments, shifts[k], stabilizers[k], representatives[stabilizers[k]])
        for k, site in enumerate(sites)
    ]
    return placed, replace(union, nodes=np.concatenate(own)) if far.any() else union


def _nearly_fixed(action: Action, points: Complexes, within: float) -> list[int]:
    """The numbers of all points that some motion and a translation of the lattice may leave within a distance."""
    (turns, shifts), places = action.fractional_maps, np.array(action.lattice.fractional(points))
    steps = turns @ places + shifts - places
    # How far the distance is at most in fractional coordinates.
    limit = within / action.lattice.det * np.array([[abs(action.lattice.b)], [abs(action.lattice.a)]])
    near = np.asarray((np.abs(steps - np.rint(steps)) <= limit).all(axis=1))
    return np.flatnonzero(near[1:].any(axis=0)).tolist()


def _representatives(action: Action, stabilizer: tuple[Motion, ...]) -> tuple[Motion, ...]:
    """One motion for each copy in a cell, modulo translations, of a site with this stabilizer."""
    if len(stabilizer) == 1:
        return action.motions
    representatives: list[Motion] = []
    covered: set[Motion] = set()
    for motion in action.motions:
        if motion not in covered:
            representatives.append(motion)
            covered |= {modulo_lattice(compose(motion, element)) for element in stabilizer}
    return tuple(representatives)


def translation(placed: Placed, sign: int) -> Motion:
    """The lattice translation from the placed site to the drawn one, or back."""
    return (*IDENTITY[:4], 2 * sign * placed.shift[0], 2 * sign * placed.shift[1])


def symmetrized(action: Action, nodes: Complexes, stabilizer: tuple[Motion, ...]) -> Complexes:
    """The nodes of a site that motions map nearly onto itself, made symmetric: each the mean of what is taken there."""
    images = [action.apply(motion, nodes) for motion in stabilizer]
    return np.asarray(np.mean([image[Neighbours(image).nearest(nodes)[1][:, 0]] for image in images], axis=0), complex)


def _stabilizer(action: Action, nodes: Complexes, segments: Ints, rounding: float) -> tuple[Motion, ...]:
    """The motions that map a site onto itself, the identity first, where nodes are known up to `rounding`."""
    if len(segments):
        ends = nodes[segments]
        length = np.abs(ends[:, 1] - ends[:, 0])
        centroid = complex((ends.mean(axis=1) * length).sum() / length.sum())
    else:
        centroid = complex(nodes.mean())
    extent = float(np.abs(nodes - centroid).max())
    close = max(SAME_POINT * max(action.size, extent), rounding)
    found = [IDENTITY]
    for motion in action.motions[1:]:
        image = action.apply_to_point(motion, centroid)
        x, y = action.fractional(centroid - image)
        candidate = (*motion[:4], motion[4] + 2 * round(x), motion[5] + 2 * round(y))
        if candidate[:4] == IDENTITY[:4]:
            continue  # a pure translation, from the centring
        if abs(action.apply_to_point(candidate, centroid) - centroid) <= close and _maps_onto_itself(
            action.apply(candidate, nodes), nodes, segments, close
        ):
            found.append(candidate)
    return tuple(found)


def _maps_onto_itself(images: Complexes, nodes: Complexes, segments: Ints, close: float) -> bool:
    """Whether nodes moved to `images` are the same nodes, joined by the same segments."""
    distance, partner = Neighbours(nodes).nearest(images)
    if distance.max() > close:
        return False
    pairs = np.sort(segments, axis=1)
    moved = np.sort(partner[:, 0][segments], axis=1)
    return bool(np.array_equal(np.unique(pairs, axis=0), np.unique(moved, axis=0)))


@dataclass(frozen=True, slots=True)
class Copies:
    """Copies of bundles of sites: unit[k] z + shift[k], or where `conj[k]` (bool) unit[k] conj(z) + shift[k].

    A bundle is the sites that are copied by the same motions; copy k is one of all sites of the bundle `bundle[k]`
    (intp, n). `unit` and `shift` are complex128 (n,); `motions` (int64, n) are the same as exact motions. The first
    copies are the identities: copy k is the bundle k where it was placed.
    """

    motions: Codes
    unit: Complexes
    shift: Complexes
    conj: Bools
    bundle: Ints

    def __len__(self) -> int:
        return len(self.unit)

    @property
    def bundles(self) -> int:
        """The number of bundles."""
        return int(self.bundle.max()) + 1


def bundles(placed: list[Placed]) -> Ints:
    """The bundle of each site, numbered in the order of their first sites: intp (sites,)."""
    known: dict[tuple[Motion, ...], int] = {}
    return np.array([known.setdefault(site.representatives, len(known)) for site in placed], np.intp)


def copies_near(action: Action, placed: list[Placed], nodes: Complexes, node_bundle: Ints) -> Copies:
    """Every copy that can shape the tile of any of the sites: the identities, then bundle after bundle.

    `nodes` (complex128, m) are those of all sites, `node_bundle` (intp, m) is the bundle of each. A point x of a tile,
    its nearest point y of the base site and its nearest point z of any copy satisfy x - y and x - z in V, the Voronoi
    cell of the lattice about 0: otherwise a translated copy would be nearer. So z - y lies in 2 V: few copies are left,
    however long or skew the cell. It is asked of what sites and copies extend over across the sides of V.
    """
    named = [*dict.fromkeys(site.representatives for site in placed)]
    linear = [action.linear[motion[:4]] for some in named for motion in some]
    motions = _Motions(
        np.array([code_of(motion) for some in named for motion in some]),
        np.array([unit for unit, _ in linear]),
        np.array([conj for _, conj in linear]),
        np.repeat(np.arange(len(named)), [len(some) for some in named]),
    )
    compiled = _COMPILED()
    near = _copies_near if compiled is None else partial(_copies_near_compiled, compiled)
    return near(action, motions, nodes, node_bundle)


class _Motions(NamedTuple):
    """The motions of which copies are translates, bundle after bundle, the identity first in each.

    `motion` (int64, n) is z -> unit z, or unit conj(z) where `conj`, and a translation, of the bundle `bundle`
    (complex128, bool and intp, n).
    """

    motion: Codes
    unit: Complexes
    conj: Bools
    bundle: Ints


def _copies_near(action: Action, motions: _Motions, nodes: Complexes, node_bundle: Ints) -> Copies:
    """The copies of the sites with these nodes; `node_bundle` (intp, m) is the bundle of each."""
    p, q = action.lattice.reduced_basis
    across = np.array([p, q, p + q if (p.conjugate() * q).real < 0 else p - q])[:, None]
    motion, unit, conj, of = motions
    # A moved point is along r where the point itself is along r moved back: r / unit, or its mirror image.
    along = across * unit.conj()
    along.imag[:, conj] *= -1.0
    low, high = np.empty((2, *along.shape))
    still = starts(of)
    for number in of[still].tolist():
        chosen = of == number
        low[:, chosen], high[:, chosen] = _extents(nodes[node_bundle == number], along[:, chosen])
    least, most = low[:, still].min(axis=1, keepdims=True), high[:, still].max(axis=1, keepdims=True)
    bound = np.abs(across) ** 2 * (1 + 1e-9) + (high - low + most - least) / 2
    shift = _shift(action, motion)
    away = _inner(across, shift) + (low + high - least - most) / 2
    # By the inverse of the Gram matrix: how many steps along p and q lead near, and how many there are to try.
    product = p.conjugate() * q
    inverse = np.array([[abs(q) ** 2, -product.real], [-product.real, abs(p) ** 2]]) / product.imag**2
    near = np.round(inverse @ away[:2])
    i, j = np.ceil(np.abs(inverse) @ bound[:2].max(axis=1)).astype(int) + 1
    steps = np.stack(np.divmod(np.arange((2 * i + 1) * (2 * j + 1)), 2 * j + 1)) - [[i], [j]]
    vectors = _inner(across, across[:2, 0])
    offset = (away - vectors @ near)[:, :, None] + (vectors @ steps)[:, None]
    which, step = np.nonzero((np.abs(offset) <= bound[:, :, None]).all(axis=0))
    steps = np.array(action.reduced).T @ (steps[:, step] - near[:, which].astype(int))
    motion = moved(motion[which], *steps)
    order = np.argsort(motion != IDENTITY_CODE, kind="stable")
    motion, which = motion[order], which[order]
    return Copies(motion, unit[which], _shift(action, motion), conj[which], of[which])


def _shift(action: Action, motion: Codes) -> Complexes:
    """The translations of motions, as vectors."""
    _, s, t = decode(motion)
    return action.cartesian(s / 2, t / 2)


def _copies_near_compiled(
    compiled: Callable[..., int], action: Action, motions: _Motions, nodes: Complexes, node_bundle: Ints
) -> Copies:
    """The same by the compiled kernel."""
    lattice = np.array([action.lattice.a, action.lattice.b, *action.lattice.reduced_basis])
    given = len(motions.motion), *motions, len(nodes), nodes, node_bundle, lattice, np.array(action.reduced)
    count, room = _ROOM, 0
    while room < count:
        room = count
        motion, bundle = np.empty(room, np.int64), np.empty(room, np.intp)
        unit, shift, conj = np.empty(room, complex), np.empty(room, complex), np.empty(room, bool)
        count = compiled(*given, room, motion, unit, shift, conj, bundle)
        assert count >= 0, TOO_FAR
    return Copies(motion[:count], unit[:count], shift[:count], conj[:count], bundle[:count])


def _inner(one: Complexes, other: Complexes) -> Floats:
    """The inner products of vectors in the plane."""
    return one.real * other.real + one.imag * other.imag


def _extents(points: Complexes, along: Complexes) -> tuple[Floats, Floats]:
    """The least and the greatest inner product of some points with each vector of an array, of that array's shape."""
    product = _inner(along[..., None], points)
    return product.min(axis=-1), product.max(axis=-1)
