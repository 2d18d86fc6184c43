"""The vertices of tiles in 50 digits.

A vertex is the point that is equally far from its elements, found by Newton's method on the distances to the segments
and points of the exact copies: the exact operation, applied to the doubles of the base site. In hexagonal groups the
square root of 3 has 50 digits too. It counts as true only when no element of any copy is nearer, in 50 digits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any, NamedTuple

import mpmath
import numpy as np
import peer
from mpmath import mpc, mpf
from numpy.typing import NDArray

from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup

# So that 50 are left where the elements are nearly parallel: they take up to 25.
mpmath.mp.dps = 80
# Distances that agree to this, relative to the cell, are one.
SAME = mpf(10) ** -35
# Elements that are farther than the nearest by more than this, in doubles, are farther in 50 digits too.
FILTER = 1e-9
# Elements whose distances differ by no more than this, in doubles, may be equally far.
BLUR = 1e-14
# A vertex farther from where it was said to be than this is another one; relative to the cell.
REACH = 1e-2
Complexes = NDArray[np.complex128]
Label = frozenset[int]
"""Elements: copy * (m + n) + node, or + m + segment, where a copy has m nodes and n segments."""


class Vertex(NamedTuple):
    """A vertex and the elements that are equally far from it."""

    point: Any
    label: Label


# Planes: a site's copies, in doubles and in 50 digits


@dataclass
class Plane:
    """A site and copies of it: `nodes` complex128 (copies, m), the site first; `exact` gives a node in 50 digits.

    `mirrored` are the numbers of the copies that are the site's images in a mirror.
    """

    site: NodedSite
    nodes: Complexes
    size: float
    exact: Callable[[int, int], Any]
    mirrored: frozenset[int] = frozenset()
    _known: dict[tuple[int, int], Any] = field(default_factory=dict)

    @property
    def per_copy(self) -> int:
        """Count the elements of a copy."""
        return len(self.site.nodes) + len(self.site.segments)

    def node(self, copy: int, node: int) -> Any:
        """A node in 50 digits."""
        key = copy, node
        if key not in self._known:
            self._known[key] = self.exact(copy, node)
        return self._known[key]

    def copy_of(self, element: int) -> int:
        """The number of an element's copy."""
        return element // self.per_copy

    def node_of(self, element: int) -> int | None:
        """An element's node; None for a segment."""
        local = element % self.per_copy
        return local if local < len(self.site.nodes) else None

    def nodes_of(self, element: int) -> tuple[int, ...]:
        """The nodes of an element: one, or a segment's two."""
        local = element % self.per_copy
        m = len(self.site.nodes)
        return (local,) if local < m else tuple(self.site.segments[local - m].tolist())

    def points_of(self, element: int) -> list[Any]:
        """The nodes of an element in 50 digits."""
        return [self.node(self.copy_of(element), node) for node in self.nodes_of(element)]

    def distances(self, z: complex) -> NDArray[np.float64]:
        """The distances of a point from all elements, in doubles: float64 (elements,)."""
        ends = self.nodes[:, self.site.segments]
        first, chord = ends[..., 0], ends[..., 1] - ends[..., 0]
        along = ((z - first) * chord.conj()).real / np.abs(chord) ** 2
        ending = np.abs(z - self.nodes)
        # The very number of the end where the foot is beyond it: then the end, which comes first, is the nearest.
        lines = np.where(along > 0.0, np.abs(z - first - along * chord), ending[:, self.site.segments[:, 0]])
        lines = np.where(along < 1.0, lines, ending[:, self.site.segments[:, 1]])
        return np.concatenate((ending, lines), axis=1).ravel()


def exact_images(site: NodedSite, lattice: Lattice, group: WallpaperGroup, copies: Sequence[Operation]) -> Plane:
    """The plane of exact copies: the operation in 50 digits, applied to the doubles of the site."""
    a, b = mpc(lattice.a), mpc(lattice.b)
    if group.system == "hexagonal":
        b = a * mpmath.expjpi(mpf(2) / 3)
    steps: list[tuple[Any, Any, bool]] = []
    for operation in copies:
        isometry = lattice.isometry(operation)
        turn = round(math.degrees(math.atan2(isometry.a.imag, isometry.a.real)) / 30.0)
        unit = mpmath.expjpi(mpf(turn) / 6)
        assert abs(unit - isometry.a) < 1e-12
        x, y = (mpf(part.numerator) / part.denominator for part in operation.translation)
        steps.append((unit, x * a + y * b, isometry.conj))

    def image(copy: int, node: int) -> Any:
        unit, shift, conj = steps[copy]
        z = mpc(complex(site.nodes[node]))
        return unit * (mpmath.conj(z) if conj else z) + shift

    mirrored = frozenset(k for k, copy in enumerate(copies) if copy.determinant < 0 and (copy @ copy).is_identity)
    return Plane(site, peer.block_nodes(site, lattice, copies[1:]), longer_side(lattice), image, mirrored)


def as_given(site: NodedSite, nodes: Complexes, size: float) -> Plane:
    """The plane of copies whose nodes are these very doubles."""
    return Plane(site, nodes, size, lambda copy, node: mpc(complex(nodes[copy, node])))


def longer_side(lattice: Lattice) -> float:
    """The cell's longer side."""
    return max(abs(lattice.a), abs(lattice.b))


# True vertices


def line_of(plane: Plane, segment: int) -> tuple[Any, Any]:
    """A segment's first point and its unit direction, in 50 digits."""
    first, second = plane.points_of(segment)
    return first, (second - first) / abs(second - first)


def distance(plane: Plane, element: int, z: Any) -> tuple[Any, Any]:
    """The distance of a point from an element's node or line, and its gradient, in 50 digits."""
    if plane.node_of(element) is not None:
        away = z - plane.points_of(element)[0]
        return abs(away), away / abs(away)
    first, along = line_of(plane, element)
    across = ((z - first) * mpmath.conj(along)).imag
    return abs(across), mpmath.sign(across) * mpc(0, 1) * along


def true_distance(plane: Plane, element: int, z: Any) -> Any:
    """The distance of a point from a node or a segment, in 50 digits."""
    if plane.node_of(element) is None:
        first, along = line_of(plane, element)
        reach = ((z - first) * mpmath.conj(along)).real
        if 0 <= reach <= abs(plane.points_of(element)[1] - first):
            return distance(plane, element, z)[0]
    return min(abs(z - point) for point in plane.points_of(element))


def equations(plane: Plane, label: Label, z: Any) -> list[tuple[Any, Any]]:
    """Residuals and gradients that vanish at the vertex of these elements.

    A segment and an end of its own touch along the normal there: the difference of their distances has a double root,
    so the condition is that the foot on the segment is that end.
    """
    rows, single = [], []
    for element in sorted(label):
        node, copy = plane.node_of(element), plane.copy_of(element)
        hosts = [other for other in label if other != element and plane.copy_of(other) == copy]
        hosts = [other for other in hosts if plane.node_of(other) is None and node in plane.nodes_of(other)]
        if node is not None:
            lines = [line_of(plane, host)[1] for host in hosts]
            rows += [(((z - plane.node(copy, node)) * mpmath.conj(along)).real, along) for along in lines]
        if node is None or not hosts:
            single.append(distance(plane, element, z))
    here, slope = single[0]
    return rows + [(there - here, steep - slope) for there, steep in single[1:]]


def solve(plane: Plane, label: Label, start: complex) -> Any | None:
    """The point equally far from these elements, by Gauss and Newton from a start; None where there is none."""
    z = mpc(start)
    for _ in range(60):
        rows = equations(plane, label, z)
        p = sum(g.real**2 for _, g in rows)
        q = sum(g.real * g.imag for _, g in rows)
        s = sum(g.imag**2 for _, g in rows)
        u, v = sum(r * g.real for r, g in rows), sum(r * g.imag for r, g in rows)
        det = p * s - q * q
        if det <= mpf(10) ** -60 * (p + s) ** 2 or abs(z - start) > plane.size:
            return None
        step = mpc(s * u - q * v, p * v - q * u) / det
        z -= step
        if abs(step) < mpf(10) ** -45 * plane.size:
            return z if all(abs(r) < SAME * plane.size for r, _ in equations(plane, label, z)) else None
    return None


def confirm(plane: Plane, label: Label, z: Any) -> Vertex | None:
    """The vertex with all its elements if none is nearer; None otherwise."""
    near = plane.distances(complex(z))
    close = np.flatnonzero(near < near.min() + FILTER * plane.size).tolist()
    exact = {element: true_distance(plane, element, z) for element in {*close, *label}}
    least = min(exact.values())
    full = frozenset(element for element, r in exact.items() if r - least < SAME * plane.size)
    return Vertex(z, full) if label <= full and len({plane.copy_of(e) for e in full}) > 1 else None


def true_vertices(plane: Plane, label: Label, start: complex) -> list[Vertex]:
    """The vertex of these elements; where they have none in common, the vertices that three of them have.

    Where there is none of these either, what is as near to the start as rounding can tell is tried, three by three: an
    edge between two vertices may be so short that doubles know no point of it.
    """
    vertex = _vertex_of(plane, label, start)
    if vertex is not None:
        return [vertex]
    near = plane.distances(start)
    close = frozenset(np.flatnonzero(near < near.min() + BLUR * plane.size).tolist())
    return _vertices_among(plane, label, start) or _vertices_among(plane, close, start)


def _vertex_of(plane: Plane, label: Label, start: complex) -> Vertex | None:
    """The vertex of these elements, if they have one near to the start."""
    z = solve(plane, label, start)
    if z is None or abs(z - start) > REACH * plane.size:
        return None
    return confirm(plane, label, z)


def _vertices_among(plane: Plane, elements: Label, start: complex) -> list[Vertex]:
    """The vertices that three of some elements have, of different copies."""
    found: list[Vertex] = []
    for three in combinations(sorted(elements), 3):
        if len({plane.copy_of(element) for element in three}) > 1:
            vertex = _vertex_of(plane, frozenset(three), start)
            if vertex is not None and all(vertex.label != other.label for other in found):
                found.append(vertex)
    return found
