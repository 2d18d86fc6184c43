"""The copies of a site that can shape a tile, as exact motions and as isometries of the plane."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from voronoi_tiles.base.arrays import Bools, Complexes, Ints
from voronoi_tiles.base.maps import move
from voronoi_tiles.base.neighbours import Neighbours
from voronoi_tiles.base.tolerance import SAME_POINT
from voronoi_tiles.groups.wallpaper import Lattice
from voronoi_tiles.vector.motions import IDENTITY, Action, Motion, compose, modulo_lattice


@dataclass(frozen=True, slots=True)
class Placed:
    """A base site moved by a lattice vector to near the origin, with what its copies depend on.

    `nodes` (complex128, m) and `segments` (intp, n x 2) are as in a site; `shift` are the integer coordinates of the
    vector that leads back to the site as it was drawn. A circle about `centre` with this `radius` holds all nodes.
    `stabilizer` are the motions that map the site onto itself, the identity first; `representatives` has one motion for
    each copy in a cell, modulo translations.
    """

    nodes: Complexes
    segments: Ints
    shift: tuple[int, int]
    centre: complex
    radius: float
    stabilizer: tuple[Motion, ...]
    representatives: tuple[Motion, ...]

    def canonical(self, motion: Motion) -> Motion:
        """The motion that names the copy onto which `motion` takes the site."""
        if len(self.stabilizer) == 1:
            return motion
        return next(
            m for m in (compose(motion, s) for s in self.stabilizer) if modulo_lattice(m) in self.representatives
        )


def place(action: Action, nodes: Complexes, segments: Ints) -> Placed:
    """A site moved near the origin, with its stabilizer."""
    box = complex(nodes.real.min(), nodes.imag.min()), complex(nodes.real.max(), nodes.imag.max())
    x, y = action.fractional((box[0] + box[1]) / 2)
    # A site within a cell of the origin stays where it was drawn.
    shift = (0, 0) if abs(x) <= 2 and abs(y) <= 2 else (round(x), round(y))
    if shift != (0, 0):
        nodes = nodes - action.cartesian(*shift)
        box = complex(nodes.real.min(), nodes.imag.min()), complex(nodes.real.max(), nodes.imag.max())
    centre = (box[0] + box[1]) / 2
    stabilizer = _stabilizer(action, nodes, segments)
    representatives: list[Motion] = []
    covered: set[Motion] = set()
    for motion in action.motions:
        if motion not in covered:
            representatives.append(motion)
            covered |= {modulo_lattice(compose(motion, element)) for element in stabilizer}
    return Placed(
        nodes=nodes,
        segments=segments,
        shift=shift,
        centre=centre,
        radius=float(np.abs(nodes - centre).max()),
        stabilizer=stabilizer,
        representatives=tuple(representatives),
    )


def translation(placed: Placed, sign: int) -> Motion:
    """The lattice translation from the placed site to the drawn one, or back."""
    return (*IDENTITY[:4], 2 * sign * placed.shift[0], 2 * sign * placed.shift[1])


def _stabilizer(action: Action, nodes: Complexes, segments: Ints) -> tuple[Motion, ...]:
    """The motions that map a site onto itself, the identity first."""
    if len(segments):
        ends = nodes[segments]
        length = np.abs(ends[:, 1] - ends[:, 0])
        centroid = complex((ends.mean(axis=1) * length).sum() / length.sum())
    else:
        centroid = complex(nodes.mean())
    extent = float(np.abs(nodes - centroid).max())
    close = SAME_POINT * max(action.size, extent)
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
    (intp, n). `unit` and `shift` are complex128 (n,); `motions` (int64, n x 6) are the same as exact motions. Where the
    copies are those of several bundles, the first are the identities: copy k is the bundle k where it was placed.
    """

    motions: npt.NDArray[np.int64]
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


def copies_near(action: Action, base: Placed, other: Placed) -> Copies:
    """Every copy of `other` that can shape the tile of `base`; where they are the same site, itself first.

    A point x of the tile, its nearest point y of the base site and its nearest point z of any copy satisfy
    x - y and x - z in V, the Voronoi cell of the lattice about 0: otherwise a translated copy would be nearer.
    So z - y lies in 2 V: few copies are left, however long or skew the cell.
    """
    p, q = (complex(action.cartesian(*v)) for v in action.reduced)
    (p0, p1), (q0, q1) = action.reduced
    relevant = np.array([p, q, p + q if (p.conjugate() * q).real < 0 else p - q])
    reach = base.radius + other.radius
    bound = np.abs(relevant) ** 2 * (1 + 1e-9) + reach * np.abs(relevant)
    # How many steps along p and q: by the inverse of the Gram matrix, without signs.
    first, second, product = float(bound[0]), float(bound[1]), p.conjugate() * q
    n = math.ceil((abs(q) ** 2 * first + abs(product.real) * second) / product.imag**2) + 1
    m = math.ceil((abs(product.real) * first + abs(p) ** 2 * second) / product.imag**2) + 1
    steps = np.indices((2 * n + 1, 2 * m + 1)).reshape(2, -1).T - (n, m)
    base_motions = np.array(other.representatives)
    linear = [action.linear[m[:4]] for m in other.representatives]
    unit, conj = np.array([u for u, _ in linear]), np.array([c for _, c in linear])
    origin = move(
        np.asarray(other.centre), unit, action.cartesian(base_motions[:, 4] / 2, base_motions[:, 5] / 2), conj
    )
    away = origin - base.centre
    near = np.round(np.stack(Lattice(p, q).fractional(away), axis=1))
    grid = steps[None, :, :] - near[:, None, :].astype(int)
    vector = away[:, None] + grid[..., 0] * p + grid[..., 1] * q
    inside = np.ones(vector.shape, bool)
    for r, limit in zip(relevant, bound, strict=True):
        inside &= np.abs(vector.real * r.real + vector.imag * r.imag) <= limit
    which, step = np.nonzero(inside)
    i, j = grid[which, step].T
    motions = base_motions[which]
    motions[:, 4] += 2 * (i * p0 + j * q0)
    motions[:, 5] += 2 * (i * p1 + j * q1)
    if base is other:
        identity = np.flatnonzero((motions == IDENTITY).all(axis=1))
        order = np.concatenate((identity, np.delete(np.arange(len(motions)), identity)))
        motions, which = motions[order], which[order]
    shift = action.cartesian(motions[:, 4] / 2, motions[:, 5] / 2)
    return Copies(
        motions=motions, unit=unit[which], shift=shift, conj=conj[which], bundle=np.zeros(len(motions), np.intp)
    )
