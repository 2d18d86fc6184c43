"""The vertices of solids: images of representatives under exact motions, each at a height.

What an operation maps onto each other is one representative, and a vertex is named by integers: its number and the
motion that leads there. So which triangles share a vertex is known without a tolerance, and it has the same bits in
whatever tile it is.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.vector.complex.representatives import Builder, Points, Representatives, fixed
from voronoi_tiles.vector.motion_codes import motion_of
from voronoi_tiles.vector.motions import Action


@dataclass
class VertexTable:
    """The representatives of vertices that are being collected, with their heights."""

    action: Action
    builder: Builder = field(init=False)
    _heights: list[Floats] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.builder = Builder(self.action)

    def add(self, positions: Complexes, z: float) -> Ints:
        """Add representatives at a height; the result are their numbers."""
        self._heights.append(np.full(len(positions), z))
        return self.builder.add(positions)

    def add_fixed(self, position: complex, z: float, stabilizer: Iterable[int]) -> int:
        """Add a representative that motions, given by their codes, leave where it is; its number."""
        motions = sorted(motion_of(code) for code in stabilizer)
        number = int(self.add(np.array([fixed(self.action, position, motions)]), z)[0])
        self.builder.fix(number, motions)
        return number

    def snapshot(self) -> Vertices:
        """The vertices so far."""
        return Vertices(self.builder.snapshot(), np.concatenate(self._heights))


@dataclass(frozen=True, eq=False)
class Vertices:
    """Representatives of vertices with their `heights`, float64 (m,)."""

    representatives: Representatives
    heights: Floats

    def indexed(self, points: Points, label: Ints) -> tuple[Points, Ints]:
        """Points without those that are there twice with one label, and the number among them of each given one."""
        distinct, which = np.unique(self.representatives.canonical(points), return_inverse=True)
        key = (label * (int(points.index.max()) + 1) + points.index) * len(distinct) + which
        _, first, number = np.unique(key, return_index=True, return_inverse=True)
        return Points(points.index[first], distinct[which[first]]), number

    def located(self, points: Points) -> Floats:
        """The positions of points in space, float64 (n, 3), in the design's units."""
        plane = self.representatives.locate(points)
        return np.column_stack((plane.real, plane.imag, self.heights[points.index]))
