"""The nearest of all copies of all sites, of many points at once: what says that nothing is nearer than an edge claims.

The points, in bundles of neighbouring ones, go down a tree of oriented boxes together. Of each copy of the tree a
bundle keeps the boxes that can hold the nearest element of one of its points. Two inequalities say which those are, for
a bundle of radius r about c, a point e of an element at the distance R of c, and a box at the distance D of c:

- no point of the bundle is farther from e than R + r, none is nearer to the box than D - r;
- with the unit vectors u from e to c and v from the box to c, a point c + d of the bundle is no farther from e than
  R + u d + r^2 / 2R (a square root lies below its tangents), and no nearer to the box than D + v d (the distance from a
  convex set lies above its tangents). So the box is out of the question if D > R + |u - v| r + r^2 / 2R.

The second leaves a handful of elements where the first leaves hundreds: the elements beside the nearest of a fine curve
are hardly farther, but they are so in nearly the same direction. Nothing here is approximate: what is kept are all
elements that are no farther than the nearest one and `slack`, and rounding is far below the slack.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, ranges
from voronoi_tiles.base.maps import Isometry, move
from voronoi_tiles.groups.wallpaper import Lattice
from voronoi_tiles.vector.box_tree import WIDTH, Boxes, BoxTree, combination

_BUNDLE = 8  # points of a bundle, and bundles of a large bundle
_AT_ONCE = 1 << 14  # points whose search goes on at once: a multiple of the large bundles
# Where the border of the lattice's Voronoi cell is only all but reached, either of two copies may be the nearest; in
# coordinates of the reduced basis.
_MARGIN = 0.02
_TINY = 1e-200  # in the place of 0 below a fraction: no distance of a design is as small


Motions = tuple[Complexes, Complexes, Bools]
"""Isometries: z -> unit z + shift, or unit conj(z) + shift where `conj`; unit, shift and conj, (g,) each."""


class NearestCopies(NamedTuple):
    """Of n points the distance from the nearest copy of any element, and m pairs of a point and an element.

    `distance` is float64 (n,). The pairs are all those whose element has a copy that is no farther from the point than
    the nearest one and the slack: `point` and `element`, intp (m,). A pair may be there more than once.
    """

    distance: Floats
    point: Ints
    element: Ints


def inverses(isometries: Sequence[Isometry]) -> Motions:
    """The isometries that undo others."""
    units, shifts, mirrored = map(np.array, zip(*isometries, strict=True))
    unit = np.where(mirrored, units, units.conj())
    return unit, move(shifts, -unit, 0j, mirrored), mirrored


def nearest_copies(lattice: Lattice, motions: Motions, tree: BoxTree, points: Complexes, slack: float) -> NearestCopies:
    """The nearest of all images of the tree's elements: under the inverses of `motions` and all lattice translations.

    `points` is complex128 (n,), best in an order in which points beside each other lie near each other; `slack` > 0 is
    in units, and above the rounding of coordinates.
    """
    found = []
    for first in range(0, len(points), _AT_ONCE):
        search = _CopySearch(lattice, motions, tree, points[first : first + _AT_ONCE], slack)
        distance, point, element = search.run()
        found.append((distance, point + first, element))
    return NearestCopies(*(np.concatenate(part) for part in zip(*found, strict=True)))


@dataclass(slots=True)
class _Frontier:
    """What is left to be looked at: in each of g groups the boxes of one copy of the tree for one bundle.

    `row` (intp, g) is the row of the bundle's centre among the images of all, `shift` (complex128, g) the vector that
    is taken from it; group after group has `count` (intp, g) of the boxes `box`.
    """

    row: Ints
    shift: Complexes
    count: Ints
    box: Ints

    @property
    def first(self) -> Ints:
        """Where the boxes of each group begin."""
        return self.count.cumsum() - self.count

    @property
    def of(self) -> Ints:
        """The group of each box."""
        return np.arange(len(self.count)).repeat(self.count)


class _CopySearch:
    """The search of one portion of points."""

    def __init__(self, lattice: Lattice, motions: Motions, tree: BoxTree, points: Complexes, slack: float) -> None:
        self.lattice, self.tree, self.slack = lattice, tree, slack
        self.count = len(points)
        levels = 2 if len(points) >= _BUNDLE**2 else 1
        # The last bundle is filled up with its last point.
        points = np.concatenate((points, np.repeat(points[-1:], -len(points) % _BUNDLE**levels)))
        self.radii, centres = [np.zeros(len(points))], [points]
        for level in range(1, levels + 1):
            bundles = points.reshape(-1, _BUNDLE**level)
            centres.append(bundles.mean(axis=1))
            self.radii.append(np.abs(bundles - centres[level][:, None]).max(axis=1))
        unit, shift, conj = motions
        unit, shift, conj = unit[:, None], shift[:, None], conj[:, None]
        # The images of a bundle under all motions stand side by side: row k m + j is bundle k's under motion j.
        self.images = [move(centre, unit, shift, conj).T.ravel() for centre in centres]
        self.motions = len(motions[0])

    def run(self) -> tuple[Floats, Ints, Ints]:
        """The distances, and the pairs."""
        bundle, level = len(self.radii) - 1, len(self.tree.levels) - 1
        frontier = self._prune(bundle, self.tree.levels[level], self._begin())
        sizes = [_middle(boxes.half_length) for boxes in self.tree.levels]
        while level or bundle > 1:
            # Whichever is larger is divided.
            if level and (bundle == 1 or sizes[level] >= _middle(self.radii[bundle])):
                level -= 1
                self._descend(frontier, len(self.tree.levels[level]))
            else:
                bundle -= 1
                self._divide(frontier)
            frontier = self._prune(bundle, self.tree.levels[level], frontier)
        self._divide(frontier)
        return self._measure(frontier)

    def _begin(self) -> _Frontier:
        """The largest bundles with all copies of the tree that may hold their nearest elements."""
        image, top = self.images[-1], len(self.tree.levels[-1])
        p, q = self.lattice.reduced_basis
        middle = self.lattice.reduced.fractional(image)
        away = [np.round(share) for share in middle]
        # How far points of a bundle are from its middle: they stand motion by motion, as the bundles do.
        parts = (-1, _BUNDLE ** (len(self.radii) - 1), self.motions)
        spread = tuple(
            float(np.abs(share.reshape(parts) - mean.reshape(-1, 1, self.motions)).max())
            for share, mean in zip(self.lattice.reduced.fractional(self.images[0]), middle, strict=True)
        )
        m, n = steps_around(self.lattice, self.tree, spread)
        i, j = np.indices((2 * m + 1, 2 * n + 1)).reshape(2, -1) - np.array([[m], [n]])
        shift = combination(p, q, away[0][:, None] + i, away[1][:, None] + j).ravel()
        row = np.repeat(np.arange(len(image)), len(i))
        return _Frontier(row, shift, np.full(len(row), top), np.tile(np.arange(top), len(row)))

    def _descend(self, frontier: _Frontier, below: int) -> None:
        """Replace each box by those that it holds; there are so many on the level below."""
        held = np.minimum(below - WIDTH * frontier.box, WIDTH)
        frontier.box = ranges(WIDTH * frontier.box, held)
        frontier.count = np.add.reduceat(held, frontier.first)

    def _divide(self, frontier: _Frontier) -> None:
        """Replace each bundle by those, or the points, that it holds."""
        count = frontier.count.repeat(_BUNDLE)
        frontier.box = frontier.box[ranges(frontier.first.repeat(_BUNDLE), count)]
        bundle, motion = np.divmod(frontier.row, self.motions)
        parts = _BUNDLE * bundle[:, None] + np.arange(_BUNDLE)
        frontier.row = (parts * self.motions + motion[:, None]).ravel()
        frontier.shift, frontier.count = frontier.shift.repeat(_BUNDLE), count

    def _prune(self, bundle: int, boxes: Boxes, frontier: _Frontier) -> _Frontier:
        """The groups without the boxes that can hold the nearest element of no point of their bundles."""
        of, owner = frontier.of, frontier.row // self.motions
        radius = self.radii[bundle][owner]
        centre = (self.images[bundle][frontier.row] - frontier.shift)[of]
        x, y = _from_box(boxes, frontier.box, centre)
        distance = np.sqrt(x * x + y * y)
        if boxes is not self.tree.levels[0]:
            inside = centre - boxes.inside[frontier.box]
            x_inside, y_inside = inside.real, inside.imag
            from_inside = np.sqrt(x_inside * x_inside + y_inside * y_inside)
        else:
            x_inside, y_inside, from_inside = x, y, distance
        # Of each group the nearest among the known points of elements.
        least = np.minimum.reduceat(from_inside, frontier.first)
        best = (from_inside == least[of]).nonzero()[0]
        best = best[of[best].searchsorted(np.arange(len(least)))]
        least_of_all = np.full(len(self.radii[bundle]), np.inf)
        np.minimum.at(least_of_all, owner, least)
        keep = np.flatnonzero(distance <= (least_of_all[owner] + 2 * radius + 2 * self.slack)[of])
        of, distance = of[keep], distance[keep]
        safe = np.maximum(least, _TINY)
        u_x, u_y = x_inside[best] / safe, y_inside[best] / safe
        over = np.maximum(distance, _TINY)
        apart = (x[keep] / over - u_x[of]) ** 2 + (y[keep] / over - u_y[of]) ** 2
        bound = least + radius * radius / (2 * safe) + 2 * self.slack
        possible = distance <= bound[of] + np.sqrt(apart) * radius[of]
        keep, of = keep[possible], of[possible]
        count = np.bincount(of, minlength=len(owner))
        alive = count.nonzero()[0]
        return _Frontier(frontier.row[alive], frontier.shift[alive], count[alive], frontier.box[keep])

    def _measure(self, frontier: _Frontier) -> tuple[Floats, Ints, Ints]:
        """The distances of points from elements, and the pairs that are near enough."""
        of, owner = frontier.of, frontier.row // self.motions
        where = (self.images[0][frontier.row] - frontier.shift)[of]
        start, chord = self.tree.start[frontier.box], self.tree.chord[frontier.box]
        distance = distances(where, start, chord)
        nearest = np.full(len(self.radii[0]), np.inf)
        np.minimum.at(nearest, owner, np.minimum.reduceat(distance, frontier.first))
        point = owner[of]
        # Without the points with which the last bundle was filled up.
        keep = np.flatnonzero((distance <= nearest[point] + self.slack) & (point < self.count))
        return nearest[: self.count], point[keep], self.tree.element[frontier.box[keep]]


def _middle(values: Floats) -> float:
    """The value that half of the others do not exceed."""
    return float(np.sort(values)[len(values) // 2])


def steps_around(lattice: Lattice, tree: BoxTree, spread: Sequence[float]) -> tuple[int, int]:
    """How many steps along each vector of the reduced basis the copies are away that may hold a nearest element.

    They are counted from the lattice point nearest to a place; the points are up to `spread` beside it, in coordinates
    of the reduced basis. A point's nearest translate of an element lies with its nearest point in the lattice's Voronoi
    cell about it.
    """
    (x, y), (m, n) = spread, cell_reach(lattice)
    return int(0.5 + x + tree.reach + m + _MARGIN), int(0.5 + y + tree.reach + n + _MARGIN)


def cell_reach(lattice: Lattice) -> tuple[float, float]:
    """How far the lattice's Voronoi cell about 0 reaches, in coordinates of its reduced basis.

    Its corners are the centre of the circle through 0 and the two vectors at an acute angle, this centre as seen from
    those two, and what lies opposite.
    """
    p, q = lattice.reduced_basis
    product = abs(p.real * q.real + p.imag * q.imag)
    first, second, square = abs(p) ** 2, abs(q) ** 2, 2 * lattice.reduced.det**2
    return 1 - second * (first - product) / square, 1 - first * (second - product) / square


def _from_box(boxes: Boxes, box: Ints, points: Complexes) -> tuple[Floats, Floats]:
    """The vectors to points from the nearest points of boxes, as x and y."""
    away, axis = points - boxes.centre[box], boxes.axis[box]
    along = away.real * axis.real + away.imag * axis.imag
    across = away.imag * axis.real - away.real * axis.imag
    length, width = boxes.half_length[box], boxes.half_width[box]
    along -= np.minimum(np.maximum(along, -length), length)
    across -= np.minimum(np.maximum(across, -width), width)
    return along * axis.real - across * axis.imag, along * axis.imag + across * axis.real


def distances(points: Complexes, start: Complexes, chord: Complexes) -> Floats:
    """The distances of points from segments, each from `start` to start + chord, or where that is 0 a point; (n,)."""
    x, y = points.real - start.real, points.imag - start.imag
    along, up = chord.real, chord.imag
    square = along * along + up * up
    share = (x * along + y * up) / np.where(square > 0.0, square, 1.0)
    foot = np.minimum(np.maximum(share, 0.0), 1.0)
    x, y = x - foot * along, y - foot * up
    return np.asarray(np.sqrt(x * x + y * y))
