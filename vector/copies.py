"""The copies of a site that can shape a tile, as exact motions and as isometries of the plane."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np
import numpy.typing as npt

from voronoi_tiles.tolerance import SAME_POINT
from voronoi_tiles.vector.contour import Bools, Complexes, Ints
from voronoi_tiles.wallpaper import Lattice, Operation, WallpaperGroup

Motion = tuple[int, int, int, int, int, int]
"""An operation held in integers: the linear part, row by row, and twice the translation (fractional coordinates)."""

IDENTITY: Motion = (1, 0, 0, 1, 0, 0)


def compose(outer: Motion, inner: Motion) -> Motion:
    """Return the motion that applies `inner` first and `outer` to its result."""
    a, b, c, d, s, t = outer
    e, f, g, h, u, v = inner
    return (a * e + b * g, a * f + b * h, c * e + d * g, c * f + d * h, a * u + b * v + s, c * u + d * v + t)


def inverse(motion: Motion) -> Motion:
    """Return the motion that undoes `motion`."""
    a, b, c, d, s, t = motion
    det = a * d - b * c  # 1 or -1
    a, b, c, d = det * d, -det * b, -det * c, det * a
    return (a, b, c, d, -(a * s + b * t), -(c * s + d * t))


def reverses_orientation(motion: Motion) -> bool:
    """Tell whether a motion turns the plane over."""
    return motion[0] * motion[3] - motion[1] * motion[2] < 0


def to_motion(operation: Operation) -> Motion:
    """Return an operation as a motion.

    Raises ValueError where its translation does not consist of halves, as in all plane groups it does.
    """
    x, y = (2 * part for part in operation.translation)
    if x.denominator != 1 or y.denominator != 1:
        raise ValueError(f"{operation} is an operation of no wallpaper group")
    return (*operation.linear, x.numerator, y.numerator)


def to_operation(motion: Motion) -> Operation:
    """Return a motion as an operation."""
    return Operation((motion[0], motion[1], motion[2], motion[3]), (Fraction(motion[4], 2), Fraction(motion[5], 2)))


@dataclass(frozen=True)
class Action:
    """A wallpaper group acting on the plane over a given lattice."""

    group: WallpaperGroup
    lattice: Lattice

    @cached_property
    def motions(self) -> tuple[Motion, ...]:
        """The general positions, the identity first."""
        return tuple(to_motion(operation) for operation in self.group.operations)

    @cached_property
    def linear(self) -> dict[tuple[int, ...], tuple[complex, bool]]:
        """The linear part of each motion as (unit complex number, whether it conjugates)."""
        isometries = (self.lattice.isometry(operation) for operation in self.group.operations)
        return {m[:4]: (i.a, i.conj) for m, i in zip(self.motions, isometries, strict=True)}

    @cached_property
    def reduced(self) -> tuple[tuple[int, int], tuple[int, int]]:
        """The shortest basis of the lattice, in integer coordinates over (a, b)."""
        (m, n), (i, j) = (self.fractional(vector) for vector in self.lattice.reduced_basis)
        return (round(m), round(n)), (round(i), round(j))

    def cartesian(self, x: npt.ArrayLike, y: npt.ArrayLike) -> Complexes:
        """Return fractional coordinates as points."""
        x, y = np.asarray(x, float), np.asarray(y, float)
        a, b = self.lattice.a, self.lattice.b
        result = np.empty(x.shape, complex)
        result.real = x * a.real + y * b.real
        result.imag = x * a.imag + y * b.imag
        return result

    def fractional(self, z: complex) -> tuple[float, float]:
        """Return a point in fractional coordinates."""
        return self.lattice.fractional(z)

    @cached_property
    def covering_radius(self) -> float:
        """The largest distance of any point from a lattice: no tile reaches farther from its site."""
        p, q = (complex(self.cartesian(*v)) for v in self.reduced)
        if (p.conjugate() * q).real < 0:
            q = -q
        area = abs((p.conjugate() * q).imag)
        return abs(p) * abs(q) * abs(p - q) / (2 * area)

    @cached_property
    def size(self) -> float:
        """The longer side of the cell: the scale that accuracies are relative to."""
        return max(abs(self.lattice.a), abs(self.lattice.b))

    def apply(self, motion: Motion, z: Complexes) -> Complexes:
        """Return the images of points under one motion."""
        unit, conj = self.linear[motion[:4]]
        return move(z, unit, self._shift(motion), conj)

    def apply_to_point(self, motion: Motion, z: complex) -> complex:
        """Return the image of one point: the same bits as `apply` gives, without an array's overhead."""
        unit, conj = self.linear[motion[:4]]
        shift = self._shift(motion)
        x, y = z.real, (-z.imag if conj else z.imag)
        return complex(unit.real * x - unit.imag * y + shift.real, unit.imag * x + unit.real * y + shift.imag)

    def _shift(self, motion: Motion) -> complex:
        """Return the translation of a motion."""
        s, t, a, b = motion[4] / 2, motion[5] / 2, self.lattice.a, self.lattice.b
        return complex(s * a.real + t * b.real, s * a.imag + t * b.imag)


def move(z: Complexes, unit: complex | Complexes, shift: complex | Complexes, conj: bool | Bools = False) -> Complexes:
    """Return unit * z + shift, or unit * conj(z) + shift where `conj`; all arguments broadcast.

    The arithmetic is spelt out in real numbers: numpy's complex product may round an element differently with
    its place in the array, and the same point must have the same bits from wherever it is reached.
    """
    x, y = z.real, np.where(conj, -z.imag, z.imag)
    real = unit.real * x - unit.imag * y + shift.real
    result = np.empty(real.shape, complex)
    result.real = real
    result.imag = unit.imag * x + unit.real * y + shift.imag
    return result


@dataclass(frozen=True, slots=True)
class Placed:
    """A base site in its place, with what its copies depend on.

    Attributes:
        nodes, segments: as in a site, translated by a lattice vector to near the origin.
        shift: that vector's integer coordinates: the given site is the placed one moved by it.
        centre, radius: a circle around all nodes.
        stabilizer: the motions that map the site onto itself, the identity first.
        representatives: one motion of the group modulo translations for each copy in a cell.
    """

    nodes: Complexes
    segments: Ints
    shift: tuple[int, int]
    centre: complex
    radius: float
    stabilizer: tuple[Motion, ...]
    representatives: tuple[Motion, ...]

    def canonical(self, motion: Motion) -> Motion:
        """Return the motion that names the copy onto which `motion` takes the site."""
        if len(self.stabilizer) == 1:
            return motion
        return next(
            m for m in (compose(motion, s) for s in self.stabilizer) if modulo_lattice(m) in self.representatives
        )


def modulo_lattice(motion: Motion) -> Motion:
    """Return the one of a motion's lattice translates that stands for all."""
    return (*motion[:4], motion[4] % 2, motion[5] % 2)


def place(action: Action, nodes: Complexes, segments: Ints) -> Placed:
    """Return a site moved near the origin, with its stabilizer."""
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
    """Return the lattice translation from the placed site to the drawn one, or back."""
    return (*IDENTITY[:4], 2 * sign * placed.shift[0], 2 * sign * placed.shift[1])


def _stabilizer(action: Action, nodes: Complexes, segments: Ints) -> tuple[Motion, ...]:
    """Return the motions that map a site onto itself, the identity first."""
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
    """Tell whether nodes moved to `images` are the same nodes, joined by the same segments."""
    from scipy.spatial import cKDTree

    distance, partner = cKDTree(np.stack((nodes.real, nodes.imag), axis=1)).query(
        np.stack((images.real, images.imag), axis=1)
    )
    if distance.max() > close:
        return False
    pairs = np.sort(segments, axis=1)
    moved = np.sort(partner[segments], axis=1)
    return bool(np.array_equal(np.unique(pairs, axis=0), np.unique(moved, axis=0)))


@dataclass(frozen=True, slots=True)
class Copies:
    """Copies of a site, as arrays: copy k is unit * z + shift, or unit * conj(z) + shift."""

    motions: npt.NDArray[np.int64]
    unit: Complexes
    shift: Complexes
    conj: Bools

    def __len__(self) -> int:
        return len(self.unit)


def copies_near(action: Action, base: Placed, other: Placed) -> Copies:
    """Return every copy of `other` that can shape the tile of `base`; where they are the same site, itself first.

    A point x of the tile, its nearest point y of the base site and its nearest point z of any copy satisfy
    x - y and x - z in V, the Voronoi cell of the lattice about 0: otherwise a translated copy would be nearer.
    So z - y lies in 2 V: few copies are left, however long or skew the cell.
    """
    p, q = (complex(action.cartesian(*v)) for v in action.reduced)
    (p0, p1), (q0, q1) = action.reduced
    relevant = np.array([p, q, p + q if (p.conjugate() * q).real < 0 else p - q])
    reach = base.radius + other.radius
    bound = np.abs(relevant) ** 2 * (1 + 1e-9) + reach * np.abs(relevant)
    gram = np.linalg.inv([[abs(p) ** 2, (p.conjugate() * q).real], [(p.conjugate() * q).real, abs(q) ** 2]])
    n, m = (np.ceil(np.abs(gram) @ bound[:2]) + 1).astype(int)
    steps = np.stack(np.meshgrid(np.arange(-n, n + 1), np.arange(-m, m + 1), indexing="ij"), axis=-1).reshape(-1, 2)
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
    return Copies(motions=motions, unit=unit[which], shift=shift, conj=conj[which])
