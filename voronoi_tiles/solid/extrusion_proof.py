"""The proof of prisms, from the finished meshes: closed, of the right volume, beside their neighbours, as written."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import fsum
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints, plane
from voronoi_tiles.base.errors import ProofError
from voronoi_tiles.base.tolerance import EPSILON
from voronoi_tiles.fabrication.tile_colouring import neighbour_pairs
from voronoi_tiles.solid.face_triangles import filled
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.prism import Face, Prism
from voronoi_tiles.solid.solid_job import SolidJob
from voronoi_tiles.vector.complex.period import Period

VOLUME_TOLERANCE: Final = 1e-12
"""How far the volume of tiles that fill a slab may be from the slab's; relative: what rounding leaves."""

_MOVED: Final = 64 * EPSILON
"""By how much moving a solid may change it; relative to how far from the origin it is: what rounding leaves."""

_ROUNDING: Final = 1e-9
"""By how much less than the clearance neighbours may be apart; relative."""


@dataclass(frozen=True)
class PrismProof:
    """What was proved of the prisms over the tiles of a period.

    `shared` is how many points the outlines have, each of them, bit for bit, a neighbour's as well; None where they are
    drawn in. Then `apart` is the least distance between neighbours in millimetres. What is `pulled` apart has its
    neighbours so in the tessellation alone.

    `volume_error` is None with a chamfer, whose volume is between those over the larger and over the smaller face. Else
    it is relative: where points are shared, how far the tiles of a cell are from its area times the height; where they
    are drawn in, how far one is from the exact offset's volume at most.
    """

    volume_error: float | None
    shared: int | None
    apart: float | None
    pulled: bool = False

    def __str__(self) -> str:
        if self.volume_error is None:
            volume = "volumes below those without a chamfer, and above those of the smaller face all the way"
        elif self.shared is not None:
            volume = f"volume of a cell's tiles = its area x height (relative error {self.volume_error:.1g})"
        else:
            volume = f"volumes within {self.volume_error:.1g} of the exact offset's"
        shared = "" if self.shared is None else f"; all {self.shared:,} points of outlines are neighbours', bit for bit"
        apart = "" if self.apart is None else f"; neighbours at least {self.apart:.4g} mm apart"
        pulled = ", before they are pulled apart" if self.pulled else ""
        return f"closed; {volume}{shared}{apart}{pulled}"

    def document(self) -> dict[str, Any]:
        """The figures, in the types of JSON."""
        return {
            "closed": True,
            "volume_error": self.volume_error,
            "shared_points": self.shared,
            "least_distance": self.apart,
            "pulled_apart": self.pulled,
        }


def prove_prisms(prisms: Sequence[Prism], period: Period, job: SolidJob) -> PrismProof:
    """Prove the prisms over the tiles of a period. Raises ProofError where they are not what the job asks for."""
    meshes = [prism.mesh() for prism in prisms]
    if not all(mesh.is_closed for mesh in meshes):
        raise ProofError("a solid is not closed")
    volumes = [mesh.volume for mesh in meshes]
    filled = job.clearance == 0.0
    shared = _shared(prisms, period) if filled else None
    apart = None if filled else _apart(prisms, period)
    if apart is not None and apart < job.clearance * (1 - _ROUNDING):
        raise ProofError(f"neighbours are {apart:.4g} mm apart, and not the clearance of {job.clearance:g} mm")
    if filled and not job.chamfer:
        slab = period.lattice.det * job.thickness
        error = abs(fsum(volumes) - slab) / slab
        if error > VOLUME_TOLERANCE:
            raise ProofError(f"the volume of the solids is {error:.1g} off, relative to the cell's")
        return PrismProof(error, shared, None)
    error = max(_excess(prism, volume, job) for prism, volume in zip(prisms, volumes, strict=True))
    return PrismProof(None if job.chamfer else error, shared, apart)


def prove_copies(meshes: Sequence[TriangleMesh], tiles: Ints, prisms: Sequence[Prism], job: SolidJob) -> None:
    """Prove what is written: each mesh is closed, `height` high, and the prism over its tile, moved in the plane.

    `tiles` intp (n,) are the tiles of the n meshes. Raises ProofError where one is not.
    """
    own = [prism.mesh() for prism in prisms]
    volumes = [mesh.volume for mesh in own]
    for mesh, tile in zip(meshes, tiles.tolist(), strict=True):
        low, high = mesh.vertices[:, 2].min(), mesh.vertices[:, 2].max()
        if (low, high) != (0.0, job.thickness):
            raise ProofError(f"a solid stands from {low:.6g} to {high:.6g} mm, and not from 0 to {job.thickness:g} mm")
        if not mesh.is_closed:
            raise ProofError("a solid is not closed")
        size = float(np.abs(mesh.vertices).max()) + float(np.abs(own[tile].vertices).max())
        if abs(mesh.volume - volumes[tile]) > _MOVED * size**3:
            raise ProofError(f"a solid has {mesh.volume:.6g} cubic millimetres, and its tile's {volumes[tile]:.6g}")
        if np.ptp(mesh.vertices - own[tile].vertices, axis=0).max() > _MOVED * size:
            raise ProofError("a solid is not that of its tile")


def _excess(prism: Prism, volume: float, job: SolidJob) -> float:
    """How far a volume is from that of the exact prism, relative to it. Raises ProofError where that is too much.

    Chords within a distance of the exact edge lose as much times its length at most. Between the two faces of a
    chamfer the volume is that of neither, but bounded by both.
    """
    outer, slack = prism.outer.area, _slack(prism.outer, job.chords)
    inner = outer if prism.inner is None else prism.inner.area
    most = outer * job.thickness
    least = most - 2 * job.chamfer * (outer - inner)
    if not least - slack * job.thickness <= volume <= most + slack * job.thickness:
        raise ProofError(f"a solid has {volume:.6g} cubic millimetres, and not {least:.6g} to {most:.6g}")
    return max(volume - most, least - volume, 0.0) / most


def _slack(face: Face, accuracy: float) -> float:
    """How far the area of a face's chords may be from that of the exact region; square millimetres."""
    rings = np.split(face.points, face.offsets[1:-1])
    length = sum(float(np.abs(ring - np.roll(ring, 1)).sum()) for ring in rings)
    return length * accuracy + 64 * EPSILON * length**2


def _shared(prisms: Sequence[Prism], period: Period) -> int:
    """How many points outlines have. Raises ProofError where one is no neighbour's as well, bit for bit."""
    around: list[list[Complexes]] = [[] for _ in prisms]
    for p, q, i, j in neighbour_pairs(period).tolist():
        for one, other, sign in ((p, q, 1), (q, p, -1)):
            step = np.array([[sign * i, sign * j]], np.intp)
            around[one].append(period.outlines(np.array([other]), step)[0].start)
    for prism, beside in zip(prisms, around, strict=True):
        lone = ~np.isin(prism.outer.points, np.concatenate(beside))
        if lone.any():
            place = prism.outer.points[lone][0]
            raise ProofError(f"neighbours do not share the point ({place.real:.6g}, {place.imag:.6g})")
    return sum(len(prism.outer.points) for prism in prisms)


def _apart(prisms: Sequence[Prism], period: Period) -> float:
    """The least distance between the faces of neighbours; millimetres."""
    import shapely

    shapes = [filled(prism.outer.points, prism.outer.offsets) for prism in prisms]
    pairs = neighbour_pairs(period)
    shifts = plane(period.shifts(pairs[:, 2:]))
    return min(
        float(shapely.distance(shapes[p], shapely.transform(shapes[q], lambda z, shift=shift: z + shift)))
        for (p, q), shift in zip(pairs[:, :2].tolist(), shifts, strict=True)
    )
