"""Oracles for what is cut: the exact tiles all over a sheet by operations of the group, and drawings flattened."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import shapely

from helpers.examples import tiling
from helpers.sheets import flattened, points_on, xy
from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.product import Product
from voronoi_tiles.paths.paths import ARC, LINE, Paths
from voronoi_tiles.tiling import Tiling
from voronoi_tiles.vector.outline import Outline

FINE = 1e-4
"""How far the oracles' chords may be from exact outlines, in millimetres."""

SQUARES = 'schema = 1\ngroup = "p1"\n[cell]\na = 20\nb = 20\nangle = 90\n[[site]]\nstrokes = [{ point = [10, 10] }]\n'
"""Tiles that are squares of 20 mm, from 0 to 20."""

RINGS = """
schema = 1
group = "p1"
[cell]
a = 40
b = 40
angle = 90
[[site]]
name = "ring"
strokes = [{ circle = [20, 20], radius = 12 }]
[[site]]
name = "island"
strokes = [{ point = [20, 20] }]
"""
"""A tile with a hole about (20, 20), of about 6 mm radius, and the tile that fills it."""


def squares() -> Tiling:
    """The tiling of SQUARES."""
    return Design.loads(SQUARES).tessellate()


def rings() -> Tiling:
    """The tiling of RINGS."""
    return Design.loads(RINGS).tessellate()


def made(name: str, form: str = "svg", **job: Any) -> Product:
    """What a job makes of an example or a starter; on a sheet the design's origin is in the middle."""
    if job.get("sheet") is not None:
        job.setdefault("offset", 0j)
    return tiling(name).make(Job(**job), form)


# --- exact tiles ------------------------------------------------------------------------------------------------


def outline_lines(outline: Outline, unit: float, accuracy: float = FINE) -> list[Complexes]:
    """The rings of an outline as points, by the formula of the quadratic curve."""
    lines = []
    for first, stop in pairwise(outline.ring_offsets.tolist()):
        parts = []
        for k in range(first, stop):
            a, m, b = (complex(z) * unit for z in (outline.start[k], outline.control[k], outline.end[k]))
            if not outline.curved[k]:
                parts.append(np.array([a]))
                continue
            t = np.arange(n := max(2, int(np.ceil(np.sqrt(abs(a - 2 * m + b) / (4 * accuracy)))))) / n
            parts.append((1 - t) ** 2 * a + 2 * t * (1 - t) * m + t**2 * b)
        lines.append(np.concatenate(parts))
    return lines


def exact_shape(outline: Outline, unit: float, accuracy: float = FINE) -> Any:
    """The area of an outline in millimetres, as shapely sees it."""
    outer, *holes = outline_lines(outline, unit, accuracy)
    return shapely.Polygon(xy(outer), [xy(hole) for hole in holes])


@dataclass(frozen=True)
class Copy:
    """A tile of the plane: its site, the operation that takes the drawn site there, and its area on the page."""

    site: int
    operation: Operation
    shape: Any


@cache
def plane(name: str, width: float, height: float, accuracy: float = 1e-3) -> tuple[Copy, ...]:
    """All tiles that meet a sheet about the design's origin, each once; on the sheet's page."""
    tiles, design = tiling(name), tiling(name).design
    unit, lattice = design.unit_mm, design.lattice
    sheet = shapely.box(0, 0, width, height)
    centre = complex(width, height) / 2
    found: dict[tuple[int, float, float], Copy] = {}
    reach = int(np.hypot(width, height) / unit * max(abs(lattice.a), abs(lattice.b)) / lattice.det / 2) + 3
    for site, tile in enumerate(tiles.tiles):
        for operation in design.group.operations:
            base = exact_shape(tile.copy(operation), unit, accuracy)
            x0, y0, x1, y1 = base.bounds
            for i in range(-reach, reach + 1):
                for j in range(-reach, reach + 1):
                    place = unit * lattice.cartesian(i, j) + centre
                    if x1 + place.real < 0 or x0 + place.real > width:
                        continue
                    if y1 + place.imag < 0 or y0 + place.imag > height:
                        continue
                    shape = shapely.transform(base, lambda xy, at=place: xy + np.array([at.real, at.imag]))
                    if shape.intersection(sheet).area > FINE:
                        key = (site, round(shape.centroid.x, 3), round(shape.centroid.y, 3))
                        found.setdefault(key, Copy(site, operation.translated(i, j), shape))
    return tuple(found.values())


def whole(copies: Iterable[Copy], width: float, height: float, margin: float = 0.0) -> list[Copy]:
    """Those that lie within a rectangle's margin."""
    room = shapely.box(margin - FINE, margin - FINE, width - margin + FINE, height - margin + FINE)
    return [copy for copy in copies if room.covers(copy.shape)]


# --- drawings ---------------------------------------------------------------------------------------------------


def cuts(product: Product) -> Paths:
    """All that a product cuts."""
    return Paths.concatenate([layer.paths for layer in product.drawing.layers if layer.work == "cut"])


def work(product: Product, kind: str) -> Paths:
    """All that a product engraves, or scores."""
    return Paths.concatenate([layer.paths for layer in product.drawing.layers if layer.work == kind])


def contour_shapes(paths: Paths, accuracy: float = FINE) -> list[Any]:
    """The areas within closed contours that run counter-clockwise, the clockwise ones in them taken off."""
    loops = [shapely.Polygon(xy(line)) for line in flattened(paths, accuracy)]
    outer = [loop for loop in loops if shapely.is_ccw(loop.exterior)]
    holes = [loop for loop in loops if not shapely.is_ccw(loop.exterior)]
    tree = shapely.STRtree(outer)
    for hole in holes:
        # The smallest that holds it is the one that it is a hole of.
        around = [k for k in tree.query(hole, predicate="within").tolist() if outer[k] is not hole]
        k = min(around, key=lambda number: outer[number].area)
        outer[k] = outer[k].difference(hole)
    return outer


def lines_of(paths: Paths, accuracy: float = FINE) -> list[Any]:
    """Paths as shapely's lines."""
    return [shapely.LineString(xy(line)) for line in flattened(paths, accuracy)]


def dense(lines: Any, step: float = 0.05) -> Any:
    """Points along lines, their corners among them."""
    return shapely.points(shapely.get_coordinates(shapely.segmentize(lines, step)))


def farthest(points: Any, lines: Any) -> float:
    """The largest distance of points from lines."""
    shapely.prepare(lines)
    return float(shapely.distance(lines, points).max())


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(32)


def true_lengths(paths: Paths) -> Floats:
    """The length of each piece: arcs by their angle, curves by quadrature of the speed over sixteen parts."""
    lengths = np.abs(paths.end - paths.start)
    for k in np.flatnonzero(paths.kind != LINE).tolist():
        a, b, (m, n) = paths.start[k], paths.end[k], paths.control[k]
        if paths.kind[k] == ARC:
            t = np.array([0.0, 0.5, 1.0])
            p = points_on(paths, k, t)
            u, v = p[1] - p[0], p[2] - p[0]
            cross = 2 * (u.conjugate() * v).imag
            radius = abs(u) * abs(v) * abs(u - v) / abs(cross)
            first, second = (2 * np.arcsin(min(1.0, abs(w) / (2 * radius))) for w in (u, p[2] - p[1]))
            lengths[k] = radius * (first + second)
            continue
        t = ((np.arange(16)[:, None] + (_NODES + 1) / 2) / 16).ravel()
        if n == 0:
            speed = 2 * np.abs((m - a) * (1 - t) + (b - m) * t)
        else:
            speed = 3 * np.abs((m - a) * (1 - t) ** 2 + 2 * (n - m) * t * (1 - t) + (b - n) * t**2)
        lengths[k] = float((speed.reshape(16, -1) @ _WEIGHTS).sum()) / 32
    return np.asarray(lengths, np.float64)


def odd_vertices(paths: Paths) -> tuple[int, int]:
    """Of the graph of all pieces: the connected parts, and the least number of trails that run through all of it."""
    ends: dict[complex, complex] = {}
    degree: dict[complex, int] = {}

    def root(z: complex) -> complex:
        while ends.setdefault(z, z) != z:
            ends[z] = ends[ends[z]]
            z = ends[z]
        return z

    for a, b in zip(paths.start.tolist(), paths.end.tolist(), strict=True):
        ends[root(a)] = root(b)
        degree[a] = degree.get(a, 0) + 1
        degree[b] = degree.get(b, 0) + 1
    odd: dict[complex, int] = {root(z): 0 for z in degree}
    for z, count in degree.items():
        odd[root(z)] += count % 2
    return len(odd), sum(max(1, count // 2) for count in odd.values())
