"""The first oracle: brute force. It reads an outline document and shares no code with voronoi_tiles.

Its groups come from generators that are written as rotations and mirrors of the plane, not from coordinate triplets;
distances are measured from sampled points to every copy in a generous block; outlines are tested by counting
crossings of a ray with the exact quadratic curves.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Ints = NDArray[np.intp]

EPS = 2.0**-52
LIMIT = 1e-12
"""What the project promises, relative to the cell's longer side."""

_HALF = Fraction(1, 2)
_SQRT = math.sqrt(0.75)
_TURNS = [1, _SQRT + 0.5j, 0.5 + _SQRT * 1j, 1j, -0.5 + _SQRT * 1j, -_SQRT + 0.5j]
TURNS = np.array(_TURNS + [-u for u in _TURNS])
"""Unit numbers at multiples of 30 degrees."""

_ANGLE = {"oblique": None, "square": 3, "hexagonal": 4}
# group: (system, generators). A generator is (k, mirrored, shift of x, of y in half cells): z -> TURNS[k] z, or
# TURNS[k] conj(z) where mirrored, and then the shift. A mirror at angle t has k = 2 t / 30 degrees.
_TURN2, _MIRROR_X, _MIRROR_Y, _CENTRE = (6, 0, 0, 0), (6, 1, 0, 0), (0, 1, 0, 0), (0, 0, 1, 1)
GENERATORS: dict[str, tuple[str, tuple[tuple[int, int, int, int], ...]]] = {
    "p1": ("oblique", ()),
    "p2": ("oblique", (_TURN2,)),
    "pm": ("square", (_MIRROR_X,)),
    "pg": ("square", ((6, 1, 0, 1),)),
    "cm": ("square", (_MIRROR_X, _CENTRE)),
    "pmm": ("square", (_MIRROR_X, _MIRROR_Y)),
    "pmg": ("square", (_TURN2, (6, 1, 1, 0))),
    "pgg": ("square", (_TURN2, (6, 1, 1, 1))),
    "cmm": ("square", (_MIRROR_X, _MIRROR_Y, _CENTRE)),
    "p4": ("square", ((3, 0, 0, 0),)),
    "p4m": ("square", ((3, 0, 0, 0), _MIRROR_X)),
    "p4g": ("square", ((3, 0, 0, 0), (6, 1, 1, 1))),
    "p3": ("hexagonal", ((4, 0, 0, 0),)),
    "p3m1": ("hexagonal", ((4, 0, 0, 0), (2, 1, 0, 0))),  # mirrors at 30, 90, 150 degrees
    "p31m": ("hexagonal", ((4, 0, 0, 0), (4, 1, 0, 0))),  # mirrors at 0, 60, 120 degrees
    "p6": ("hexagonal", ((2, 0, 0, 0),)),
    "p6m": ("hexagonal", ((2, 0, 0, 0), (0, 1, 0, 0))),
}


@dataclass(frozen=True)
class Motion:
    """z -> TURNS[turn] z + shift, or TURNS[turn] conj(z) + shift; the shift in fractions of the cell."""

    turn: int
    mirrored: bool
    matrix: tuple[int, int, int, int]
    shift: tuple[Fraction, Fraction]

    def then(self, x: int, y: int) -> Motion:
        """Follow by a lattice translation."""
        return Motion(self.turn, self.mirrored, self.matrix, (self.shift[0] + x, self.shift[1] + y))


def _matrix(turn: int, mirrored: int, system: str) -> tuple[int, int, int, int]:
    """The integer matrix of a rotation or mirror on the ideal cell of a system."""
    b = complex(TURNS[_ANGLE[system] or 3])
    columns = [complex(TURNS[turn]) * (v.conjugate() if mirrored else v) for v in (1 + 0j, b)]
    ys = [z.imag / b.imag for z in columns]
    xs = [z.real - y * b.real for z, y in zip(columns, ys, strict=True)]
    return round(xs[0]), round(xs[1]), round(ys[0]), round(ys[1])


@cache
def motions(group: str) -> tuple[Motion, ...]:
    """The motions of a group up to lattice translations: all products of its generators."""
    system, generators = GENERATORS[group]
    start = Motion(0, False, (1, 0, 0, 1), (Fraction(0), Fraction(0)))
    found = {start}
    fresh = [start]
    while fresh:
        inner = fresh.pop()
        for turn, mirrored, x, y in generators:
            p, q, r, s = _matrix(turn, mirrored, system)
            u, v = inner.shift
            shift = ((p * u + q * v + x * _HALF) % 1, (r * u + s * v + y * _HALF) % 1)
            k = (turn - inner.turn if mirrored else turn + inner.turn) % 12
            flipped = bool(mirrored) != inner.mirrored
            product = Motion(k, flipped, _matrix(k, flipped, system), shift)
            if product not in found:
                found.add(product)
                fresh.append(product)
    return tuple(sorted(found, key=lambda m: (m != start, m.mirrored, m.turn, m.shift)))


def read_operation(group: str, text: str) -> Motion:
    """Read a coordinate triplet, which must belong to the group. Raises ValueError where it does not."""
    rows = []
    for row in text.split(","):
        sums = {"x": Fraction(0), "y": Fraction(0), "": Fraction(0)}
        for term in filter(None, row.replace("-", "+-").split("+")):
            name = term[-1] if term[-1] in "xy" else ""
            factor = term.removesuffix(name)
            sums[name] += Fraction(factor + "1" if name and factor in {"", "-"} else factor)
        rows.append(sums)
    first, second = rows
    matrix = [first["x"], first["y"], second["x"], second["y"]]
    shift = (first[""], second[""])
    for motion in motions(group):
        offsets = [x - y for x, y in zip(shift, motion.shift, strict=True)]
        if list(motion.matrix) == matrix and all(offset.denominator == 1 for offset in offsets):
            return Motion(motion.turn, motion.mirrored, motion.matrix, shift)
    raise ValueError(f"{text} is no operation of {group}")


class Plane:
    """The sites of a design with all their copies."""

    def __init__(self, group: str, a: complex, b: complex, sites: Mapping[str, Any]) -> None:
        """Take the lattice vectors, and for each site its elements, rows of x0, y0, x1, y1."""
        self.group, self.a, self.b = group, a, b
        self.det = (a.conjugate() * b).imag
        self.size = max(abs(a), abs(b))
        self.names = list(sites)
        self.starts: list[Complexes] = []
        self.ends: list[Complexes] = []
        for rows in sites.values():
            e = np.asarray(rows, float).reshape(-1, 4)
            self.starts.append(e[:, 0] + 1j * e[:, 1])
            self.ends.append(e[:, 2] + 1j * e[:, 3])
        corners = [np.concatenate(pair) for pair in zip(self.starts, self.ends, strict=True)]
        self.centres = [complex((z.real.min() + z.real.max()) / 2, (z.imag.min() + z.imag.max()) / 2) for z in corners]
        self.radii = [float(np.abs(z - c).max()) for z, c in zip(corners, self.centres, strict=True)]
        # Coordinates of sites drawn far from the origin are no finer than this.
        self.slack = LIMIT * self.size + 16 * EPS * max(float(np.abs(z).max()) for z in corners)

    @classmethod
    def of(cls, document: Mapping[str, Any]) -> Plane:
        """Take the cell and the sites of an outline document."""
        a, b = (complex(*v) for v in document["cell"])
        return cls(document["group"], a, b, {tile["site"]: tile["elements"] for tile in document["tiles"]})

    @cached_property
    def reduced(self) -> tuple[complex, complex]:
        """A short basis of the lattice."""
        p, q = self.a, self.b
        while True:
            if abs(q) < abs(p):
                p, q = q, p
            n = round((p.conjugate() * q).real / abs(p) ** 2)
            if n == 0 or abs(q - n * p) >= abs(q) * (1 - 1e-12):
                return p, q
            q -= n * p

    def shift(self, motion: Motion) -> complex:
        """A motion's translation as a vector."""
        return float(motion.shift[0]) * self.a + float(motion.shift[1]) * self.b

    def pull(self, motion: Motion, z: Complexes, extra: Complexes | complex = 0.0) -> Complexes:
        """The points that a motion, followed by the translation `extra`, takes to z."""
        back = TURNS[motion.turn].conjugate() * (z - (self.shift(motion) + extra))
        return np.asarray(np.conj(back) if motion.mirrored else back)

    def push(self, motion: Motion, z: Complexes) -> Complexes:
        """The images of points."""
        return np.asarray(TURNS[motion.turn] * (np.conj(z) if motion.mirrored else z) + self.shift(motion))

    def distance(self, site: int, z: Complexes) -> Floats:
        """The distance of each point from a base site, over all its elements."""
        start, chord = self.starts[site], self.ends[site] - self.starts[site]
        square = np.maximum(np.abs(chord) ** 2, 1e-300)
        result = np.empty(len(z))
        step = max(1, 2_000_000 // len(start))
        for k in range(0, len(z), step):
            away = z[k : k + step, None] - start
            foot = np.clip((np.conj(chord) * away).real / square, 0.0, 1.0)
            result[k : k + step] = np.abs(away - foot * chord).min(axis=1)
        return result

    def around(self, z: Complexes, reach: list[float] | None = None) -> Block:
        """For points, every copy that may be nearest; with `reach`, also those that lie so near (by site)."""
        p, q = self.reduced
        det = (np.conj(p) * q).imag
        rows = []
        # No point is farther from the sites than the nearest of these copies.
        enough = np.full(len(z), np.inf)
        for tested in (False, True):
            for s, (centre, radius) in enumerate(zip(self.centres, self.radii, strict=True)):
                bound = radius + float(enough.max()) if tested else 0.0
                if tested and reach is not None:
                    bound = max(bound, reach[s])
                m, n = (int(np.ceil(0.51 + bound * abs(v) / abs(det))) if tested else 0 for v in (q, p))
                i, j = (k.ravel() for k in np.meshgrid(np.arange(-m, m + 1), np.arange(-n, n + 1)))
                for number, motion in enumerate(motions(self.group)):
                    away = z - self.push(motion, np.array([centre]))[0]
                    near_p = np.round((np.conj(away) * q).imag / det)
                    near_q = np.round((np.conj(p) * away).imag / det)
                    extra = (near_p[:, None] + i) * p + (near_q[:, None] + j) * q
                    gap = np.abs(away[:, None] - extra)
                    limit = np.maximum(enough + radius, reach[s] if reach is not None else 0.0)
                    k, copy = np.nonzero(gap <= limit[:, None] * (1 + 1e-9) + self.slack)
                    moved = self.pull(motion, z[k], extra[k, copy])
                    d = self.distance(s, moved)
                    if tested:
                        rows.append((k, np.full(len(k), s), np.full(len(k), number), moved, d))
                    np.minimum.at(enough, k, d)
        return Block(*(np.concatenate(column) for column in zip(*rows, strict=True)))

    def symmetries(self, site: int) -> list[Motion]:
        """The motions that map a site onto itself, compared as point sets by their elements' ends and middles."""
        marks = np.concatenate([self.starts[site], self.ends[site], (self.starts[site] + self.ends[site]) / 2])
        weight = np.abs(self.ends[site] - self.starts[site])
        middle = (self.starts[site] + self.ends[site]) / 2
        mean = complex((middle * weight).sum() / weight.sum()) if weight.any() else complex(middle.mean())
        slack = self.slack * (1 + self.radii[site] / self.size)
        found = []
        for motion in motions(self.group):
            away = mean - complex(self.push(motion, np.array([mean]))[0])
            x = (away.real * self.b.imag - away.imag * self.b.real) / self.det
            y = (self.a.real * away.imag - self.a.imag * away.real) / self.det
            moved = motion.then(round(x), round(y))
            both = np.concatenate([self.pull(moved, marks), self.push(moved, marks)])
            if float(self.distance(site, both).max()) <= slack:
                found.append(moved)
        return found


@dataclass(frozen=True)
class Block:
    """Pairs of points and copies.

    `point` is the number of the point, `site` and `motion` (up to translations) name the copy, `moved` is the point as
    the copy's base site sees it, `distance` the distance between the two.
    """

    point: Ints
    site: Ints
    motion: Ints
    moved: Complexes
    distance: Floats


class Shape:
    """A tile of an outline document: its arcs as arrays."""

    def __init__(self, tile: Mapping[str, Any]) -> None:
        """Read the rings; the control point of a line is its middle."""
        edges = [edge for ring in tile["rings"] for edge in ring]
        ends = [[complex(*p) for p in edge["points"]] for edge in edges]
        self.edges = edges
        self.start = np.array([p[0] for p in ends])
        self.end = np.array([p[-1] for p in ends])
        self.control = np.array([p[1] if len(p) == 3 else (p[0] + p[1]) / 2 for p in ends])
        self.curved = np.array([edge["kind"] == "parabola" for edge in edges])
        self.sizes = [len(ring) for ring in tile["rings"]]
        hull = np.concatenate([self.start, self.control, self.end])
        self.box = hull.real.min(), hull.real.max(), hull.imag.min(), hull.imag.max()
        self.middle = complex(hull.mean())

    def reach(self, centre: complex) -> float:
        """How far the outline's hull reaches from a point."""
        return float(np.abs(np.concatenate([self.start, self.control, self.end]) - centre).max())

    def at(self, arc: Ints, t: Floats) -> Complexes:
        """Points of arcs."""
        curve = (1 - t) ** 2 * self.start[arc] + 2 * t * (1 - t) * self.control[arc] + t * t * self.end[arc]
        return np.asarray(np.where(self.curved[arc], curve, (1 - t) * self.start[arc] + t * self.end[arc]))

    def ring_areas(self) -> list[float]:
        """The signed area of each ring, by the shoelace formula and two thirds of each arc's triangle."""
        start, control, end = self.start - self.middle, self.control - self.middle, self.end - self.middle
        sector = (np.conj(start) * end).imag / 2
        bulge = (np.conj(control - start) * (end - start)).imag / 3
        parts = sector + np.where(self.curved, bulge, 0.0)
        return [math.fsum(part) for part in np.split(parts, np.cumsum(self.sizes)[:-1])]

    def contains(self, z: Complexes) -> NDArray[np.bool_]:
        """For each point whether it is inside: a ray to the right meets the outline an odd number of times."""
        x0, x1, y0, y1 = self.box
        inside = np.zeros(len(z), bool)
        near = np.flatnonzero((z.real >= x0) & (z.real <= x1) & (z.imag >= y0) & (z.imag <= y1))
        step = max(1, 1_000_000 // len(self.start))
        for k in range(0, len(near), step):
            chosen = near[k : k + step]
            inside[chosen] = self._crossings(z[chosen]) % 2 == 1
        return inside

    def _crossings(self, z: Complexes) -> Ints:
        """Count the crossings of the ray from each point to the right with all arcs."""
        p, c, e = (w[None, :] - z[:, None] for w in (self.start, self.control, self.end))
        bend = (p - 2 * c + e) * self.curved
        slope = np.where(self.curved, 2 * (c - p), e - p)
        # Where the arc turns back in y; each of its two pieces is monotone and crosses at most once.
        with np.errstate(divide="ignore", invalid="ignore"):
            turn = np.where(bend.imag != 0, -slope.imag / (2 * bend.imag), 2.0)
            turn = np.where((turn > 0) & (turn < 1), turn, 1.0)
            peak = p + turn * (slope + turn * bend)
            peak_y = np.where(turn < 1, peak.imag, e.imag)
            root = np.sqrt(np.maximum(slope.imag**2 - 4 * bend.imag * p.imag, 0.0))
            half = -0.5 * (slope.imag + np.copysign(root, slope.imag))
            roots = np.stack((half / bend.imag, p.imag / half))
        total = np.zeros(len(z), np.intp)
        for low, high, y0, y1 in ((0.0, turn, p.imag, peak_y), (turn, 1.0, peak_y, e.imag)):
            crossed = (y0 > 0) != (y1 > 0)
            # The root that lies in the piece, or next to it.
            off = np.maximum(np.maximum(low - roots, roots - high), 0.0)
            off[~np.isfinite(off)] = np.inf
            t = np.take_along_axis(roots, off.argmin(axis=0)[None], axis=0)[0]
            t = np.clip(np.where(np.isfinite(t), t, 0.5), low, high)
            x = (p + t * (slope + t * bend)).real
            total += (crossed & (x > 0)).sum(axis=1)
        return total


def complaints(
    document: Mapping[str, Any], rng: np.random.Generator, *, points: int = 40, edges: int = 40
) -> list[str]:
    """Say all that is wrong with an outline document; nothing, if it is right.

    `points` random points of the cell are tested for their owner, `edges` random points of the tiles' edges for their
    distances.
    """
    plane = Plane.of(document)
    shapes = [Shape(tile) for tile in document["tiles"]]
    found = _rings(plane, document, shapes)
    reach = [shape.reach(centre) for shape, centre in zip(shapes, plane.centres, strict=True)]
    z = plane.centres[0] + rng.uniform(-0.5, 0.5, points) * plane.a + rng.uniform(-0.5, 0.5, points) * plane.b
    found += _owners(plane, shapes, z, reach)
    for s, shape in enumerate(shapes):
        found += _edges(plane, s, shape, rng, edges)
    return found


def _rings(plane: Plane, document: Mapping[str, Any], shapes: list[Shape]) -> list[str]:
    """Test closure, orientation, areas and symmetry."""
    found, total = [], []
    order = len(motions(plane.group))
    for s, (tile, shape) in enumerate(zip(document["tiles"], shapes, strict=True)):
        following = np.concatenate([np.roll(part, -1) for part in np.split(shape.start, np.cumsum(shape.sizes)[:-1])])
        if (following != shape.end).any():
            found.append(f"{tile['site']}: a ring is not closed")
        areas = shape.ring_areas()
        if abs(math.fsum([*areas, -tile["area"]])) > 4 * LIMIT * plane.det + 64 * EPS * abs(shape.middle) * plane.size:
            found.append(f"{tile['site']}: the area is {math.fsum(areas)}, not {tile['area']}")
        if areas != sorted(areas, key=lambda area: area <= 0) or areas[0] <= 0:
            found.append(f"{tile['site']}: the outer rings do not come first")
        total.append(math.fsum(areas) * tile["copies_per_cell"])
        symmetries = {(m.turn, m.mirrored, m.shift) for m in plane.symmetries(s)}
        named = [read_operation(plane.group, text) for text in tile["symmetry"]]
        if {(m.turn, m.mirrored, m.shift) for m in named} != symmetries or len(named) != len(symmetries):
            found.append(f"{tile['site']}: {len(symmetries)} symmetries, not {tile['symmetry']}")
        if tile["copies_per_cell"] * len(symmetries) != order:
            found.append(f"{tile['site']}: {tile['copies_per_cell']} copies per cell")
    slack = LIMIT * plane.det + 64 * EPS * max(abs(shape.middle) for shape in shapes) * plane.size * order
    if abs(math.fsum([*total, -plane.det])) > slack:
        found.append(f"the tiles' areas make {math.fsum(total)}, the cell {plane.det}")
    return found


def _owners(plane: Plane, shapes: list[Shape], z: Complexes, reach: list[float]) -> list[str]:
    """Test that points are inside the copy of a tile whose site is nearest, and in no other."""
    block = plane.around(z, reach)
    nearest = np.full(len(z), np.inf)
    np.minimum.at(nearest, block.point, block.distance)
    inside = np.zeros(len(block.point), bool)
    for s, shape in enumerate(shapes):
        chosen = np.flatnonzero(block.site == s)
        inside[chosen] = shape.contains(block.moved[chosen])
    tied = block.distance <= nearest[block.point] + plane.slack
    strangers = np.unique(block.point[inside & ~tied]).tolist()
    found = [f"the point {z[k]} is in a tile that is not its own" for k in strangers]
    owned = np.zeros(len(z), bool)
    owned[block.point[inside & tied]] = True
    found += [f"the point {z[k]} is not in the tile of the nearest site" for k in np.flatnonzero(~owned).tolist()]
    return found


def _edges(plane: Plane, site: int, shape: Shape, rng: np.random.Generator, count: int) -> list[str]:
    """Test that points of edges are as far from the site as from the neighbour, and nothing is nearer."""
    found = []
    # Every edge once, as far as the count goes, and then again.
    number = len(shape.edges)
    arc = np.concatenate([rng.permutation(number) for _ in range(-(-count // number))])[:count]
    z = shape.at(arc, rng.random(count))
    here = plane.distance(site, z)
    for k in np.unique(arc).tolist():
        chosen = arc == k
        edge = shape.edges[k]
        name, text = edge["neighbour"]["site"], edge["neighbour"]["operation"]
        try:
            motion = read_operation(plane.group, text)
        except ValueError as error:
            found.append(str(error))
            continue
        there = plane.distance(plane.names.index(name), plane.pull(motion, z[chosen]))
        off = float(np.abs(there - here[chosen]).max())
        slack = plane.slack + 32 * EPS * abs(plane.shift(motion))
        if not off <= slack:
            found.append(f"edge {k} of {plane.names[site]} is {off / plane.size:.3g} off from {name} {text}")
        if edge["kind"] == "parabola":
            p, q = (complex(*v) for v in edge["directrix"])
            focus = np.abs(z[chosen] - complex(*edge["focus"]))
            line = np.abs((np.conj(q - p) * (z[chosen] - p)).imag) / abs(q - p)
            off = float(max(np.abs(focus - here[chosen]).max(), np.abs(line - here[chosen]).max()))
            if not off <= slack:
                found.append(f"edge {k} of {plane.names[site]}: focus or directrix is {off / plane.size:.3g} off")
    block = plane.around(z)
    nearest = np.full(len(z), np.inf)
    np.minimum.at(nearest, block.point, block.distance)
    short = float((here - nearest).max())
    if short > plane.slack:
        found.append(f"a copy is {short / plane.size:.3g} nearer to an edge of {plane.names[site]} than its site")
    return found
