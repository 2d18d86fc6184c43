"""The proof that lofts are drawn in as asked: figures from the finished meshes, not from the steps that made them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.errors import ProofError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.solid.cross_sections import section
from voronoi_tiles.solid.face_triangles import filled
from voronoi_tiles.solid.inset_depth import InsetDepth
from voronoi_tiles.solid.inset_loft import InsetLoft
from voronoi_tiles.solid.inset_making import inset_loft
from voronoi_tiles.solid.layers import ExactLayer
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.sections import crossed_sections
from voronoi_tiles.solid.solid_proof import SolidProof, proved_loft
from voronoi_tiles.vector.motion_codes import motion_of

_ROUNDING: Final = 1e-9
"""By how much less than the clearance neighbours may be apart; relative."""

_SHARES: Final = (0.25, 0.5, 0.75)
"""Where between two levels neighbours are compared; of their distance."""

_ROUNDS: Final = 4
"""How often a solid is made again with more levels, at most; a count."""

_FINE: Final = 1 / 100
"""How far chords, which stand for an exact tile, may be from it; of the accuracy."""


class InsetProof(NamedTuple):
    """The figures of a proof; lengths are millimetres.

    `apart` is how far neighbours are from each other at least, in level sections a quarter, a half, and three quarters
    of the way from each level to the next. At the levels and half way between them `near` is how much nearer than half
    of the clearance, and the chamfer, points of the solid are to the exact tile's edge, and `far` how much farther.

    The others are counts: of such points that are outside of the tile, of meshes that are not closed, of meshes that
    have not as many handles as before they were drawn in, of sections that cross themselves. `wanted` are heights, in
    millimetres, at which another level might mend what does not hold.
    """

    clearance: float
    accuracy: float
    apart: float
    near: float
    far: float
    outside: int
    open_meshes: int
    handles: int
    crossings: int
    wanted: tuple[float, ...]

    def rows(self) -> list[tuple[str, float, float, bool]]:
        """For each figure its name, value, limit and whether it holds; neighbours have to be farther than the limit."""
        nearest = 0.0 if self.clearance > 0.0 else self.accuracy
        figures = [
            ("nearer to the tile's edge", self.near, nearest),
            ("farther from the tile's edge", self.far, self.accuracy),
            ("points outside of the tile", self.outside, 0),
            ("open meshes, drawn in", self.open_meshes, 0),
            ("handles, drawn in", self.handles, 0),
            ("crossings, drawn in", self.crossings, 0),
        ]
        # Written so that NaN fails.
        rows = [(name, float(value), float(limit), bool(value <= limit)) for name, value, limit in figures]
        least = self.clearance * (1 - _ROUNDING)
        return [*rows, ("neighbours apart", self.apart, self.clearance, bool(self.apart >= least))]

    @property
    def failures(self) -> tuple[str, ...]:
        """One sentence for each figure that does not hold."""
        return tuple(
            f"{name} is {value:.4g}, the limit {limit:.4g}" for name, value, limit, holds in self.rows() if not holds
        )

    def document(self) -> list[dict[str, Any]]:
        """The figures in the types of JSON, as those of a loft's proof."""
        return [
            {"name": name, "value": value, "limit": limit, "passed": passed}
            for name, value, limit, passed in self.rows()
        ]

    def __str__(self) -> str:
        if self.clearance == 0.0:
            off = max(self.far, self.near)
            return (
                f"closed; rims within {off:.2g} mm of the exact ones; between them walls are neighbours', bit for bit"
            )
        far = max(self.far, 0.0)
        return (
            f"closed; neighbours at least {self.apart:.4g} mm apart; walls at most {far:.2g} mm farther in than needed"
        )


def prove_inset(inset: InsetLoft) -> InsetProof:
    """The figures of a loft that is drawn in."""
    meshes = inset.meshes
    crossed = [crossed_sections(mesh) for mesh in meshes]
    clearance = 2 * inset.depth.half
    gaps = list(_gaps(inset)) if clearance else []
    depths = [found for tile in range(len(meshes)) for found in _depths(inset, tile)]
    return InsetProof(
        clearance=clearance,
        accuracy=inset.depth.accuracy,
        apart=min((gap for _, gap in gaps), default=np.inf),
        near=-min(float(off.min()) for off, _ in depths),
        far=max(float(off.max()) for off, _ in depths),
        outside=sum(outside for _, outside in depths),
        open_meshes=sum(not mesh.is_closed for mesh in meshes),
        handles=sum(_euler(one) != _euler(other) for one, other in zip(meshes, inset.loft.meshes, strict=True)),
        crossings=sum(sum(map(len, sections)) for sections in crossed),
        wanted=tuple(
            sorted({z for sections in crossed for z in sections.between} | {z for z, gap in gaps if gap < clearance})
        ),
    )


def proved_inset(design: Design, depth: InsetDepth) -> tuple[InsetLoft, SolidProof, InsetProof]:
    """The loft of a design, drawn in, with the proof of the loft and that of what is drawn in.

    Where sections cross or come too near, there are more levels. Raises as `proved_loft` and `inset_loft`, and
    ProofError where the result fails its proof.
    """
    unit = design.unit_mm
    heights = {depth.chamfer / unit, (depth.height - depth.chamfer) / unit} if depth.chamfer else set()
    for _ in range(_ROUNDS):
        loft, proof = proved_loft(design, accuracy=depth.accuracy, heights=heights)
        inset = inset_loft(loft, depth)
        further = prove_inset(inset)
        heights |= {z / unit for z in further.wanted}
        if not further.wanted:
            break
    if further.failures:
        raise ProofError("the solid failed its proof: " + "; ".join(further.failures), further)
    return inset, proof, further


def _euler(mesh: TriangleMesh) -> int:
    """Vertices less sides and more triangles, where each side is that of two triangles."""
    return len(mesh.vertices) - len(mesh.triangles) // 2


def _gaps(inset: InsetLoft) -> Iterator[tuple[float, float]]:
    """Heights, and how far a solid and one beside it are from each other there."""
    import shapely
    from shapely.affinity import affine_transform

    action, unit = inset.loft.levels[0].core.action, inset.loft.design.unit_mm
    for low, high in pairwise(inset.levels):
        layers = [*low.level.layers, *high.level.layers]
        for share in _SHARES:
            z = low.z + (high.z - low.z) * share
            shapes = []
            for mesh in inset.meshes:
                rings = section(mesh, z)
                shapes.append(filled(rings.start, rings.offsets))
            for tile, own in enumerate(shapes):
                for site, code in {name for layer in layers for ring in layer.rings[tile] for name in ring}:
                    turn, shift, conj = action.isometry(motion_of(code))
                    flip = -1.0 if conj else 1.0
                    matrix = [turn.real, -flip * turn.imag, turn.imag, flip * turn.real]
                    beside = affine_transform(shapes[site], [*matrix, shift.real * unit, shift.imag * unit])
                    yield z, float(shapely.distance(own, beside))


def _depths(inset: InsetLoft, tile: int) -> Iterator[tuple[Floats, int]]:
    """How much farther from the exact tile's edge than they have to be points of a solid are, and how many are outside.

    At levels these are its vertices and the middles of its walls' sides, half way between levels those of its section.
    """
    mesh, depth, unit = inset.meshes[tile], inset.depth, inset.loft.design.unit_mm
    sides = np.concatenate([mesh.triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
    heights = mesh.vertices[:, 2]
    flat = np.ptp(heights[mesh.triangles], axis=1) == 0.0
    level = (heights[sides[:, 0]] == heights[sides[:, 1]]) & ~np.tile(flat, 3)
    ends = mesh.vertices[sides[level]]
    at, rings = ends[:, 0, 2], ends[..., :2].copy().view(np.complex128)[..., 0]
    for inset_level in inset.levels:
        own = rings[at == inset_level.z]
        if inset_level.rings[tile][0].number is not None:
            continue  # the loft's own
        yield _off(own, inset_level.level.core, tile, inset_level.z, depth, unit)
    for slab in inset.slabs:
        if slab.middle is None:
            continue
        z = slab.middle.z * unit
        lines = section(mesh, z)
        yield _off(np.column_stack((lines.start, lines.end)), slab.middle, tile, z, depth, unit)


def _off(
    sides: Complexes, layer: ExactLayer, tile: int, z: float, depth: InsetDepth, unit: float
) -> tuple[Floats, int]:
    """The same for the ends and middles of sides, complex128 (n, 2), in millimetres, at the height of a layer."""
    import shapely

    points = np.concatenate((sides[:, 0], sides.mean(axis=1))) / unit
    shape = layer.records[tile].outline.to_shapely(accuracy=_FINE * depth.accuracy / unit)
    shapely.prepare(shape)
    outside = int(np.count_nonzero(~shapely.contains_xy(shape, points.real, points.imag)))
    away = shapely.distance(shapely.points(points.real, points.imag), shape.boundary) * unit
    return np.asarray(away - (depth.half + depth.rim(z))), outside
