"""The proof that lofts are right: figures from the finished meshes, not from the steps that made them.

Tiles that are closed, whose walls are, bit for bit, those of the copies beyond, and whose volumes add up to that of the
cell, fill the slab without a gap; where their levels and the sections between do not cross themselves, without an
overlap. That they are the right ones is shown at the levels: vertices are as far from the own strokes as from the
nearest copy's, whatever the engine says is beside them; and between levels by how far, to first order, walls are from
where these distances are alike. And between levels no copies meet.
"""

from __future__ import annotations

from math import fsum
from typing import Any, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints
from voronoi_tiles.base.errors import ProofError
from voronoi_tiles.base.tolerance import PROOF_LIMIT
from voronoi_tiles.designs.design import Design
from voronoi_tiles.solid.deviation import equidistance
from voronoi_tiles.solid.loft import ACCURACY_MM, Loft, lofted
from voronoi_tiles.solid.mesh import TriangleMesh, point_numbers
from voronoi_tiles.vector.motion_codes import operation_of
from voronoi_tiles.vector.proof import figures_document


class SolidProof(NamedTuple):
    """The figures of a proof.

    `volume` is the relative error of the tiles' volumes, which must add up to the cell's. `distance` is how far
    vertices at exact layers are from being as far from the own strokes as from the nearest copy's, and `approach` how
    near copies come to each other at least, as is proved: both relative to the cell's longer side. `deviation` is how
    far walls are, between levels, from where the strokes have them: millimetres, `accuracy` at most.

    The others are counts: of meshes that are not closed (`open_meshes`), of meshes that have not as many handles as
    their bottoms have holes (`handles`), of triangles of walls that no copy beyond has, bit for bit and turned round
    (`unshared`), of levels, and sections half way between two, that cross themselves (`crossings`).
    """

    volume: float
    distance: float
    deviation: float
    accuracy: float
    approach: float
    open_meshes: int
    handles: int
    unshared: int
    crossings: int

    def rows(self) -> list[tuple[str, float, float, bool]]:
        """For each figure its name, value, limit and whether it holds; the approach has to be above its limit."""
        figures = [
            ("volume", self.volume, PROOF_LIMIT),
            ("distance", self.distance, PROOF_LIMIT),
            ("deviation", self.deviation, self.accuracy),
            ("open meshes", self.open_meshes, 0),
            ("handles", self.handles, 0),
            ("unshared triangles", self.unshared, 0),
            ("crossings", self.crossings, 0),
        ]
        # Written so that NaN fails.
        rows = [(name, float(value), float(limit), bool(value <= limit)) for name, value, limit in figures]
        return [*rows, ("approach", self.approach, 0.0, bool(self.approach > 0.0))]

    def document(self) -> list[dict[str, Any]]:
        """The figures in the types of JSON: each with "name", "value", "limit" and "passed"."""
        return figures_document(self.rows())

    @property
    def failures(self) -> tuple[str, ...]:
        """One sentence for each figure that does not hold."""
        return tuple(
            f"{name} is {value:.3g}, the limit {limit:.3g}" for name, value, limit, holds in self.rows() if not holds
        )

    @property
    def passed(self) -> bool:
        """Whether every figure holds."""
        return not self.failures


def prove_loft(loft: Loft) -> SolidProof:
    """The figures of a loft."""
    design, core = loft.design, loft.levels[0].core
    copies = [design.group.order // len(own) for own in core.stabilizers]
    whole = design.lattice.det * loft.motion.height * design.unit_mm**3
    # But for events that were not hit, and are known by how long edges are that were made points.
    exact = [level.core.z for level in loft.levels if not level.points.any()]
    total = fsum(mesh.volume * count for mesh, count in zip(loft.meshes, copies, strict=True))
    return SolidProof(
        volume=abs(total - whole) / whole,
        distance=equidistance(loft.meshes, loft.motion, core.action, core.stabilizers, design.unit_mm, exact)
        / core.action.size,
        deviation=loft.deviation.worst,
        accuracy=loft.accuracy,
        approach=loft.approach.proved / core.action.size,
        open_meshes=sum(not mesh.is_closed for mesh in loft.meshes),
        handles=sum(mesh.euler_characteristic != _expected(loft, k) for k, mesh in enumerate(loft.meshes)),
        unshared=sum(_unshared(loft, k) for k in range(len(loft.meshes))),
        crossings=sum(sum(map(len, crossed)) for crossed in loft.crossed),
    )


def proved_loft(design: Design, *, accuracy: float = ACCURACY_MM) -> tuple[Loft, SolidProof]:
    """The loft of a design, as `lofted` makes it, and the proof that it is right.

    Raises LoftError where the design has no solid, ProofError where the result fails its proof.
    """
    loft = lofted(design, accuracy=accuracy)
    proof = prove_loft(loft)
    if not proof.passed:
        raise ProofError("the solid failed its proof: " + "; ".join(proof.failures), proof)
    return loft, proof


def _expected(loft: Loft, tile: int) -> int:
    """What that is for solids over the tile at the bottom: 2 for each part, and 2 less for each hole."""
    areas = loft.levels[0].core.records[tile].outline.ring_areas
    return 2 * sum(1 if area > 0 else -1 for area in areas)


# --- walls ----------------------------------------------------------------------------------------------------


def _unshared(loft: Loft, tile: int) -> int:
    """How many triangles of a tile's walls no copy beyond has, bit for bit and turned round, exactly once."""
    layers = [layer for level in loft.levels for layer in level.layers]
    names = sorted({name for layer in layers for ring in layer.rings[tile] for name in ring})
    own = loft.meshes[tile]
    others = [loft.image(site, operation_of(code)) for site, code in names]
    number = point_numbers(np.concatenate([mesh.vertices for mesh in (own, *others)]))
    top = own.vertices[:, 2].max()
    mine = _named(number[own.triangles[~_flat(own, top)]])
    first, theirs = len(own.vertices), []
    for mesh in others:
        turned = mesh.triangles[~_flat(mesh, top)][:, [0, 2, 1]]
        theirs.append(_named(number[first + turned]))
        first += len(mesh.vertices)
    both = np.concatenate((mine, *theirs))
    _, which = np.unique(both, axis=0, return_inverse=True)
    found = np.bincount(which.ravel()[len(mine) :], minlength=int(which.max(initial=-1)) + 1)
    return int(np.count_nonzero(found[which.ravel()[: len(mine)]] != 1))


def _flat(mesh: TriangleMesh, top: float) -> Bools:
    """Which triangles lie in the bottom or in the top."""
    heights = mesh.vertices[:, 2][mesh.triangles]
    return np.asarray((heights == 0.0).all(axis=1) | (heights == top).all(axis=1))


def _named(triangles: Ints) -> Ints:
    """Triangles with the least corner first."""
    turn = triangles.argmin(axis=1)[:, None] + np.arange(3)
    return np.take_along_axis(triangles, turn % 3, axis=1)
