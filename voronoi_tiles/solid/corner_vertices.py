"""The vertices at corners, where several tiles meet: those that short edges join are one."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools
from voronoi_tiles.solid.events import LoftError
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.vertices import VertexTable
from voronoi_tiles.vector.complex.representatives import Points
from voronoi_tiles.vector.motion_codes import IDENTITY_CODE, composed, inverted


@dataclass(frozen=True)
class CornerVertex:
    """Where a corner's representative is in a solid: the vertex `number` under the motion `code`."""

    number: int
    code: int

    def seen(self, by: int) -> Points:
        """The vertex of the corner's image under a motion, one point."""
        return Points(np.array([self.number]), np.array([product(by, self.code)]))

    def from_(self, by: int) -> CornerVertex:
        """Where the representative is, if the corner's image under a motion is here."""
        return CornerVertex(self.number, product(inverse(by), self.code))


def product(outer: int, inner: int) -> int:
    """The code of the motion that applies `inner` first."""
    return int(composed(np.array([outer]), np.array([inner]))[0])


def inverse(code: int) -> int:
    """The code of the motion that undoes another."""
    return int(inverted(np.array([code]))[0])


def corner_vertices(table: VertexTable, layer: ExactLayer, short: Bools) -> dict[int, CornerVertex]:
    """For the representatives of corners the vertices that they become; those about short edges become one."""
    quotient, z = layer.quotient, layer.z
    places, stabilizer = quotient.representatives.position, quotient.representatives.stabilizer
    ends = edge_ends(layer)
    used = sorted({end[0] for pair in ends for end in pair})
    found: dict[int, CornerVertex] = {}
    beside = defaultdict(list)
    for k in np.flatnonzero(short).tolist():
        (i, a), (j, b) = ends[k]
        beside[i].append((a, j, b))
        beside[j].append((b, i, a))
    for start in used:
        if start in found:
            continue
        if start not in beside:
            number = table.add_fixed(complex(places[start]), z, stabilizer.get(start, (IDENTITY_CODE,)))
            found[start] = CornerVertex(number, IDENTITY_CODE)
            continue
        cluster = _cluster(start, beside, stabilizer, z)
        same = [code for i, code in cluster if i == start]
        fixing = sorted({product(code, own) for code in same for own in stabilizer.get(start, (IDENTITY_CODE,))})
        at = quotient.representatives.locate(
            Points(np.array([i for i, _ in cluster]), np.array([code for _, code in cluster]))
        )
        number = table.add_fixed(complex(at.mean()), z, fixing)
        for i, code in cluster:
            found.setdefault(i, CornerVertex(number, inverse(code)))
    return found


def edge_ends(layer: ExactLayer) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """The two corners of each edge: numbers of representatives and codes of motions."""
    vertex, offsets = layer.quotient.vertex, layer.quotient.offsets
    first, last = offsets[:-1] + np.arange(len(offsets) - 1), offsets[1:] + np.arange(len(offsets) - 1)
    rows = (vertex.index[first], vertex.motion[first], vertex.index[last], vertex.motion[last])
    return [((i, a), (j, b)) for i, a, j, b in zip(*(row.tolist() for row in rows), strict=True)]


def _cluster(
    start: int, beside: dict[int, list[tuple[int, int, int]]], stabilizer: dict[int, tuple[int, ...]], z: float
) -> list[tuple[int, int]]:
    """The corners that short edges join to a representative: numbers and motions, each corner once."""

    def named(i: int, code: int) -> tuple[int, int]:
        return i, min(product(code, own) for own in stabilizer.get(i, (IDENTITY_CODE,)))

    seen = {named(start, IDENTITY_CODE)}
    waiting = list(seen)
    while waiting:
        i, code = waiting.pop()
        for own in stabilizer.get(i, (IDENTITY_CODE,)):
            for a, j, b in beside[i]:
                other = named(j, product(product(product(code, own), inverse(a)), b))
                if other not in seen:
                    seen.add(other)
                    waiting.append(other)
        if len(seen) > 1000:
            raise LoftError("tiles shrink to nothing", z)
    return sorted(seen)
