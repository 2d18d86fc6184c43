"""What is compared, in terms that both stages understand: outlines, copies by their codes, windows of the image."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.base.tolerance import PROOF_LIMIT
from voronoi_tiles.raster.frame import Frame
from voronoi_tiles.raster.reference import Judge, decode, encode
from voronoi_tiles.raster.renderer import LabelImage
from voronoi_tiles.raster.scene import Pattern
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.scan import Grid

Codes = NDArray[np.int64]

STRANGER = -1
"""Stands for a copy that does not exist: no code is negative."""


@dataclass(frozen=True, eq=False)
class Subject:
    """The outline of each site's tile, in `units`, and an image of the same pattern over one cell."""

    units: str
    outlines: tuple[Outline, ...]
    pattern: Pattern
    image: LabelImage

    @property
    def frame(self) -> Frame:
        """The frame of the image."""
        return self.image.frame

    @cached_property
    def accuracy(self) -> float:
        """What the vector stage promises, in units: PROOF_LIMIT of the cell's longer side."""
        lattice = self.pattern.lattice
        return PROOF_LIMIT * max(abs(lattice.a), abs(lattice.b))

    @cached_property
    def rounding(self) -> float:
        """A bound for the rounding of the raster stage's float64 distances, in units."""
        return self.pattern.rounding(self.frame)

    @cached_property
    def grid(self) -> Grid:
        """The image's samples for the scan conversion."""
        a, b = self.pattern.lattice.reduced_basis
        frame = self.frame
        return Grid(frame.origin, a, b, frame.width, frame.height, frame.phase)

    @cached_property
    def period(self) -> tuple[int, int]:
        """What is added to a copy's code when it is moved by the grid's lattice vectors."""
        rows = np.concatenate((np.zeros((2, 1), np.intp), self.pattern.basis), axis=1)
        first, second = (encode(rows) - encode(np.zeros((2, 3), np.intp))).tolist()
        return int(first), int(second)

    @cached_property
    def beyond(self) -> tuple[Codes, ...]:
        """For each tile the code of the copy beyond each of its arcs, or STRANGER."""
        numbers = {site.name: number for number, site in enumerate(self.pattern.sites)}
        found = []
        for outline in self.outlines:
            codes = np.full(len(outline.neighbours), STRANGER, np.int64)
            for k, (name, operation) in enumerate(outline.neighbours):
                try:
                    codes[k] = encode(np.array(self.pattern.locate(numbers[name], operation)))
                except KeyError:
                    continue
            found.append(codes[outline.neighbour])
        return tuple(found)

    @cached_property
    def judges(self) -> tuple[Judge, ...]:
        """The raster stage's judges of the image's windows; the image itself begins at column and row 0."""
        return tuple(Judge(self.pattern, window.frame, window.candidates) for window in self.image.windows)

    def split(self, column: Floats | Ints, row: Floats | Ints) -> Iterator[tuple[Judge, Ints]]:
        """For each window its judge, and the indices of those places, in sample coordinates, that lie in it."""
        for judge in self.judges:
            window = judge.frame
            inside = (column >= window.column) & (column < window.column + window.width)
            inside &= (row >= window.row) & (row < window.row + window.height)
            index = np.flatnonzero(inside)
            if len(index):
                yield judge, index

    def relative(self, own: Codes, other: Codes) -> tuple[Ints, Codes]:
        """For pairs of copies the site of the first, and the code of the second as the first's base site sees it."""
        pairs, inverse = np.unique(np.stack((own, other), axis=1), axis=0, return_inverse=True)
        rows = decode(pairs)
        site = np.empty(len(pairs), np.intp)
        code = np.empty(len(pairs), np.int64)
        for k, ((p, i, j), (q, m, n)) in enumerate(rows.tolist()):
            first, second = self.pattern.placements[p], self.pattern.placements[q]
            operation = first.operation.translated(i, j).inverse() @ second.operation.translated(m, n)
            site[k] = first.site
            code[k] = encode(np.array(self.pattern.locate(second.site, operation)))
        inverse = inverse.reshape(-1)
        return site[inverse], code[inverse]

    def pull_back(self, place: Complexes, copy: Codes) -> Complexes:
        """The points of the base site that copies take to places (from the frame's origin)."""
        k, i, j = decode(copy).T
        isometries = [placement.isometry for placement in self.pattern.placements]
        unit = np.array([isometry.a for isometry in isometries])[k]
        home = np.array([isometry.b - self.frame.origin for isometry in isometries])[k]
        lattice = self.pattern.lattice
        away = (place - (home + (i * lattice.a + j * lattice.b))) * unit.conj()
        mirrored = np.array([isometry.conj for isometry in isometries])[k]
        return np.asarray(np.where(mirrored, away.conj(), away))
