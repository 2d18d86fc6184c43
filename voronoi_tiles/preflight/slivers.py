"""Slivers: pieces, and holes, that are narrow everywhere, though no neck may be narrower than the rest."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, plane
from voronoi_tiles.preflight.chords import Chords, polygons
from voronoi_tiles.preflight.faces import faces_of

_STEPS: Final = 12
"""Halvings of the interval in which it is looked for how far a sliver can be shrunk; a count. They leave a
four-thousandth."""

_DEEP: Final = 0.99
"""What is left of a shape that was shrunk is so deep inside it at least, in distances that it was shrunk by."""


class Sliver(NamedTuple):
    """A region in which no disc of a size fits: the greatest that does and where it is, and the paths around it.

    The first of them is its outline, the others are its holes. `material` tells a piece from a hole that falls out.
    """

    place: complex
    width: float
    paths: tuple[int, ...]
    material: bool


def find_slivers(chords: Chords, crossed: Complexes, limit: float, touching: float) -> list[Sliver]:
    """The regions inside closed paths, and between lines that meet, in which no disc of this diameter fits.

    `crossed` (complex128, n) are places where lines that are no rings cross others.
    A region that is no wider than `touching` is none: its edges are one line, drawn twice. Nor is one that is smaller
    than the limit both ways.

    Most regions are wide by their area and their perimeter, for the points within a distance r of the edge cover no
    more than r times the perimeter, and a disc more for each hole. The others are shrunk.
    """
    if limit <= 0.0:
        return []
    # Discs fit between curves, not their chords: what is as wide as the limit is wide enough.
    radius = (limit - touching) / 2
    found = list(_in_rings(chords, limit, radius))
    # What lines divide a sliver into are slivers, too.
    said = {sliver.paths[0] for sliver in found if sliver.material}
    between = _between_lines(chords, crossed, limit, radius, touching)
    found += [sliver for sliver in between if said.isdisjoint(sliver.paths)]
    return [sliver for sliver in found if sliver.width > touching]


def _in_rings(chords: Chords, limit: float, radius: float) -> Iterator[Sliver]:
    """The slivers inside rings, without the rings in these."""
    counts = np.diff(chords.first)
    ring = np.flatnonzero(chords.ring & (counts >= 3))
    if not len(ring):
        return
    # About each ring's beginning, so that a small ring far from the origin has its area.
    begin = np.repeat(chords.start[chords.first[:-1]], counts)
    twice = ((chords.start - begin).conj() * (chords.end - begin)).imag
    area = np.abs(np.add.reduceat(twice, chords.first[:-1])[ring]) / 2
    inside, outside = _nested(chords, ring, area)
    depth = np.bincount(inside, minlength=len(ring))
    # The holes of a region are the rings one level deeper.
    direct = depth[inside] == depth[outside] + 1
    inside, outside = inside[direct], outside[direct]
    lengths = chords.total[ring]
    holes = np.bincount(outside, minlength=len(ring))
    region = area - np.bincount(outside, area[inside], len(ring))
    edge = lengths + np.bincount(outside, lengths[inside], len(ring))
    large = chords.sizes[ring] >= limit
    for k in np.flatnonzero(large & (region <= radius * edge + np.pi * radius**2 * holes)).tolist():
        paths = (int(ring[k]), *ring[inside[outside == k]].tolist())
        widest = _widest(_region(chords, paths), radius)
        if widest is not None:
            yield Sliver(*widest, paths, bool(depth[k] % 2 == 0))


def _between_lines(
    chords: Chords, crossed: Complexes, limit: float, radius: float, touching: float
) -> Iterator[Sliver]:
    """The slivers between lines that are no rings, and what they meet."""
    if chords.ring.all():
        return
    faces = faces_of(chords, crossed, touching)
    box = shapely.bounds(faces.polygons)
    large = np.maximum(box[:, 2] - box[:, 0], box[:, 3] - box[:, 1]) >= limit
    holes = shapely.get_num_interior_rings(faces.polygons)
    narrow = shapely.area(faces.polygons) <= radius * shapely.length(faces.polygons) + np.pi * radius**2 * holes
    parts = shapely.STRtree(faces.parts)
    for face in faces.polygons[large & narrow]:
        widest = _widest(face, radius)
        if widest is not None:
            around = parts.query(shapely.boundary(face).buffer(touching), predicate="covers")
            yield Sliver(*widest, tuple(np.unique(faces.path[around]).tolist()), True)


def _nested(chords: Chords, ring: Ints, area: Floats) -> tuple[Ints, Ints]:
    """Pairs of rings, by their places in `ring`, of which the first lies inside the second."""
    middle = (chords.start[chords.first[ring]] + chords.end[chords.first[ring]]) / 2
    tree = shapely.STRtree(polygons(chords, ring))
    inside, outside = tree.query(shapely.points(plane(middle)), predicate="within").astype(np.intp)
    # A ring that crosses another one is not in it, and none is in a smaller one.
    smaller: Bools = area[inside] < area[outside]
    return inside[smaller], outside[smaller]


def _region(chords: Chords, paths: tuple[int, ...]) -> shapely.Geometry:
    """The inside of the first path without that of the others."""
    shape, *holes = shapely.make_valid(polygons(chords, np.array(paths, np.intp)))
    for hole in holes:
        shape = shape.difference(hole)
    return shape


def _widest(shape: shapely.Geometry, radius: float) -> tuple[complex, float] | None:
    """The middle and the diameter of the largest disc in a region; None where one of this radius fits."""
    if shape.is_empty or not shape.buffer(-radius).is_empty:
        return None
    edges = shapely.boundary(shapely.get_parts(shape))

    def deep(core: shapely.Geometry) -> tuple[shapely.Point, float]:
        """A point of a region, and how far it is from the edge of the shape."""
        point = core.representative_point()
        # Lines beside the polygons, where the shape is not all of polygons, may have no boundary.
        return point, float(np.nanmin(shapely.distance(edges, point)))

    low, high = 0.0, radius
    point, far = deep(shape)
    for _ in range(_STEPS):
        middle = (low + high) / 2
        left = shape.buffer(-middle)
        # What is left of a shape is known to half a hundredth of the distance; how far a point is from the edge,
        # exactly. Crumbs that are left of a taper beyond its largest disc lie nearer to the edge.
        found = None if left.is_empty else deep(left)
        if found is None or found[1] < _DEEP * middle:
            high = middle
        else:
            low = middle
            point, far = max((point, far), found, key=lambda one: one[1])
    return complex(point.x, point.y), 2 * far
