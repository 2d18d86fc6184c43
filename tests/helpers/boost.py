"""The second oracle: pyvoronoi (Boost.Polygon) on a block of copies, rounded to integers.

It reads an outline document. Copies are placed by the brute-force oracle's table. Boost works on 32-bit integers, so
the tile that it gives is that of sites which are off by up to half a unit of its grid.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pyvoronoi
from numpy.typing import NDArray

from helpers import brute

Complexes = NDArray[np.complex128]

SPAN = 2**29
"""Half the width of the block, in units of Boost's grid."""


class BlockTile:
    """The tile of one site as Boost sees it: outer edges only, with the copy beyond each.

    Attributes:
        unit: one unit of Boost's grid, in units of the design.
        area: signed, of all rings.
        vertices: where outer edges meet.
    """

    def __init__(self, plane: brute.Plane, site: int) -> None:
        """Take the number of the base site."""
        centre = plane.centres[site]
        # No point of the tile is farther from the site than any point from a lattice: the circumradius of the acute
        # triangle of short lattice vectors. A copy that shapes the tile comes as near to such a point.
        p, q = plane.reduced
        third = min(abs(p - q), abs(p + q))
        rim = plane.radii[site] + abs(p) * abs(q) * third / abs((p.conjugate() * q).imag)
        copies = _copies(plane, site, rim)
        extent = max(float(np.abs(np.concatenate(ends) - centre).max()) for _, *ends in copies)
        self.unit = extent / SPAN
        grid = pyvoronoi.Pyvoronoi(1)
        owners: list[list[int]] = [[], []]
        for k, (_, start, end) in enumerate(copies):
            for p, q in zip(_round(start - centre, self.unit), _round(end - centre, self.unit), strict=True):
                if p == q:
                    grid.AddPoint([p.real, p.imag])
                else:
                    grid.AddSegment([[p.real, p.imag], [q.real, q.imag]])
                owners[p != q].append(k)
        grid.Construct()
        owner = np.array(owners[0] + owners[1])
        cells, edges = grid.GetCells(), grid.GetEdges()
        spots = np.array([complex(v.X, v.Y) for v in grid.GetVertices()])
        terms, ends = [], set()
        for cell in cells:
            if owner[cell.site] != 0:
                continue
            for number in cell.edges:
                edge = edges[number]
                other = cells[edges[edge.twin].cell]
                if owner[other.site] == 0:
                    continue
                assert min(edge.start, edge.end) >= 0, "the tile reaches the block's border"
                p, q = complex(spots[edge.start]), complex(spots[edge.end])
                terms.append((p.conjugate() * q).imag / 2)
                ends |= {edge.start, edge.end}
                if not edge.is_linear:
                    terms.append(_bulge(grid, cell, other, p, q))
        self.area = math.fsum(terms) * self.unit**2
        self.vertices = centre + spots[sorted(ends)] * self.unit


def _bulge(grid: Any, cell: Any, other: Any, p: complex, q: complex) -> float:
    """The signed area between a parabolic edge from p to q and its chord, in units of the grid.

    About the directrix as x axis the curve is y = x^2 / 2f + f / 2, so the area is dx^3 / 12 f, f the focus's distance.
    """
    held, line = (cell, other) if cell.contains_point else (other, cell)
    focus = _corner(grid, held)
    a, b = (complex(*end) for end in _segment(grid, line))
    axis = (b - a) / abs(b - a)
    height = (axis.conjugate() * (focus - a)).imag
    step = (axis.conjugate() * (q - p)).real
    # The curve bulges away from the focus: to the right of an edge round it, that is outward.
    return step**3 / (12 * height) if height else 0.0


def _segment(grid: Any, cell: Any) -> Any:
    """The two ends of a cell's segment."""
    return grid.RetrieveScaledSegment(cell)


def _corner(grid: Any, cell: Any) -> complex:
    """The point of a cell: a lone one or the end of a segment."""
    return complex(*grid.RetrieveScaledPoint(cell))


def _round(z: Complexes, unit: float) -> list[complex]:
    """Points on the grid."""
    return [complex(round(p.real / unit), round(p.imag / unit)) for p in z.tolist()]


def _copies(plane: brute.Plane, site: int, rim: float) -> list[tuple[int, Complexes, Complexes]]:
    """Site, start and end points of every copy that comes within `rim` of a site's centre, itself first."""
    centre, (p, q) = plane.centres[site], plane.reduced
    det = abs((np.conj(p) * q).imag)
    found: list[tuple[int, Complexes, Complexes]] = [(site, plane.starts[site], plane.ends[site])]
    known = {(site, *_key(plane, plane.starts[site], plane.ends[site]))}
    for s in range(len(plane.names)):
        bound = rim + plane.radii[s]
        m, n = (int(bound * abs(v) / det + 1.5) for v in (q, p))
        for motion in brute.motions(plane.group):
            away = centre - complex(plane.push(motion, np.array([plane.centres[s]]))[0])
            i0 = round((away.conjugate() * q).imag / (np.conj(p) * q).imag)
            j0 = round((np.conj(p) * away).imag / (np.conj(p) * q).imag)
            for i, j in np.ndindex(2 * m + 1, 2 * n + 1):
                extra = (i0 + i - m) * p + (j0 + j - n) * q
                if abs(extra - away) > bound:
                    continue
                start, end = plane.push(motion, plane.starts[s]) + extra, plane.push(motion, plane.ends[s]) + extra
                key = (s, *_key(plane, start, end))
                if key not in known:
                    known.add(key)
                    found.append((s, start, end))
    return found


def _key(plane: brute.Plane, start: Complexes, end: Complexes) -> tuple[float, ...]:
    """Numbers by which images of a site that coincide can be told, whatever the order of the elements."""
    unit = 1e-7 * plane.size
    marks = np.concatenate([start, end])
    moments = [complex(marks.mean()), complex(np.abs(marks - plane.centres[0]).mean())]
    moments.append(complex(np.abs(marks - plane.centres[0] - plane.a / math.pi).mean()))
    return tuple(round(part / unit) for z in moments for part in (z.real, z.imag))


def complaints(document: Mapping[str, Any]) -> list[str]:
    """Say where the tiles differ from Boost's by more than its grid explains; nothing, if nowhere."""
    plane = brute.Plane.of(document)
    found = []
    for s, tile in enumerate(document["tiles"]):
        shape = brute.Shape(tile)
        other = BlockTile(plane, s)
        perimeter = float(np.abs(shape.end - shape.start).sum())
        # The border moves with the sites, and faster where a bisector is at a sharp angle to the line of sight.
        slack = 100 * other.unit * perimeter
        area = math.fsum(shape.ring_areas())
        if not abs(other.area - area) <= slack:
            found.append(f"{tile['site']}: the area is {area}, Boost's {other.area}, off by {area - other.area:.3g}")
        gaps = np.abs(shape.start[:, None] - other.vertices).min(axis=1)
        lost = gaps > 1e4 * other.unit
        if lost.any():
            found.append(f"{tile['site']}: {lost.sum()} corners are not among Boost's; {gaps.max():.3g} off")
    return found
