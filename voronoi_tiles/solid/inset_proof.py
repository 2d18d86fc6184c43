"""The proof that lofts are drawn in as asked: figures from the finished meshes, not from the steps that made them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
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
from voronoi_tiles.solid.loft import ACCURACY_MM, lofted
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.sections import crossed_sections
from voronoi_tiles.solid.solid_proof import SolidProof, prove_loft
from voronoi_tiles.vector.motion_codes import motion_of
from voronoi_tiles.vector.proof import figures_document

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
    `approach` is how near copies of strokes come to each other at least, as is proved.

    The others are counts: of such points that are outside of the tile, of meshes that are not closed, of meshes that
    have not as many handles as before they were drawn in, of sections that cross themselves. `wanted` are heights at
    which another level might mend what does not hold. Without a clearance walls of the loft are kept: `kept` is the
    proof of that, and neighbours are not `apart`.
    """

    clearance: float
    accuracy: float
    apart: float
    near: float
    far: float
    approach: float
    outside: int
    open_meshes: int
    handles: int
    crossings: int
    wanted: tuple[float, ...]
    kept: SolidProof | None

    def rows(self) -> list[tuple[str, float, float, bool]]:
        """For each figure its name, value, limit and whether it holds; the last two have to be above theirs."""
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
        if self.kept is not None:
            return [*self.kept.rows(), *rows]
        least = self.clearance * (1 - _ROUNDING)
        return [
            *rows,
            ("neighbours apart", self.apart, self.clearance, bool(self.apart >= least)),
            ("approach", self.approach, 0.0, bool(self.approach > 0.0)),
        ]

    @property
    def failures(self) -> tuple[str, ...]:
        """One sentence for each figure that does not hold."""
        return tuple(
            f"{name} is {value:.4g}, the limit {limit:.4g}" for name, value, limit, holds in self.rows() if not holds
        )

    def document(self) -> list[dict[str, Any]]:
        """The figures in the types of JSON, as those of a loft's proof."""
        return figures_document(self.rows())

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
    loft, depth, meshes = inset.loft, inset.depth, inset.meshes
    crossed = [crossed_sections(mesh) for mesh in meshes]
    heights = np.array([level.z for level in inset.levels])
    parts = [_by_slab(mesh, heights) for mesh in meshes]
    depths = [found for tile, own in enumerate(parts) for found in _depths(inset, tile, own)]
    off = np.concatenate([found for found, _ in depths])
    at, gap = np.array(list(_gaps(inset, parts)) if depth.half else [(0.0, np.inf)]).T
    wanted = {*at[gap < 2 * depth.half].tolist(), *(z for sections in crossed for z in sections.between.tolist())}
    return InsetProof(
        clearance=2 * depth.half,
        accuracy=depth.accuracy,
        apart=float(gap.min()),
        near=-float(off.min()),
        far=float(off.max()),
        approach=loft.approach.proved * loft.design.unit_mm,
        outside=sum(outside for _, outside in depths),
        open_meshes=sum(not mesh.is_closed for mesh in meshes),
        handles=sum(
            one.euler_characteristic != other.euler_characteristic
            for one, other in zip(meshes, loft.meshes, strict=True)
        ),
        crossings=sum(sum(map(len, sections)) for sections in crossed),
        wanted=tuple(sorted(wanted)),
        kept=prove_loft(loft) if inset.kept else None,
    )


def proved_inset(design: Design, depth: InsetDepth) -> tuple[InsetLoft, InsetProof]:
    """The loft of a design, drawn in, and the proof that it is so.

    Where sections cross or come too near, there are more levels. Raises as `lofted` and `inset_loft`, and ProofError
    where the result fails its proof.
    """
    unit = design.unit_mm
    heights = {depth.chamfer / unit, (depth.height - depth.chamfer) / unit} if depth.chamfer else set()
    # Of what is drawn in all along only the levels are the loft's, and these are exact.
    accuracy = max(depth.accuracy, ACCURACY_MM) if depth.half else depth.accuracy
    for _ in range(_ROUNDS):
        inset = inset_loft(lofted(design, accuracy=accuracy, heights=heights), depth)
        proof = prove_inset(inset)
        if not proof.wanted:
            break
        heights |= {z / unit for z in proof.wanted}
    if proof.failures:
        raise ProofError("the solid failed its proof: " + "; ".join(proof.failures), proof)
    return inset, proof


def _by_slab(mesh: TriangleMesh, heights: Floats) -> list[TriangleMesh]:
    """The walls of a mesh between each of its levels and the next, as a mesh each."""
    lowest = mesh.vertices[:, 2][mesh.triangles].min(axis=1)
    order = np.argsort(lowest, kind="stable")
    bounds = np.searchsorted(lowest[order], heights).tolist()
    return [TriangleMesh(mesh.vertices, mesh.triangles[order[a:b]]) for a, b in pairwise(bounds)]


def _gaps(inset: InsetLoft, parts: Sequence[Sequence[TriangleMesh]]) -> Iterator[tuple[float, float]]:
    """Heights, and how far a solid and one beside it are from each other there; `parts` are by site and by slab."""
    import shapely
    from shapely.affinity import affine_transform

    action, unit = inset.loft.levels[0].core.action, inset.loft.design.unit_mm
    for k, (low, high) in enumerate(pairwise(inset.levels)):
        layers = [*low.level.layers, *high.level.layers]
        for share in _SHARES:
            z = low.z + (high.z - low.z) * share
            rings = [section(part[k], z) for part in parts]
            shapes = [filled(ring.start, ring.offsets) for ring in rings]
            for tile, own in enumerate(shapes):
                for site, code in {name for layer in layers for ring in layer.rings[tile] for name in ring}:
                    turn, shift, conj = action.isometry(motion_of(code))
                    flip = -1.0 if conj else 1.0
                    matrix = [turn.real, -flip * turn.imag, turn.imag, flip * turn.real]
                    beside = affine_transform(shapes[site], [*matrix, shift.real * unit, shift.imag * unit])
                    yield z, float(shapely.distance(own, beside))


def _depths(inset: InsetLoft, tile: int, parts: Sequence[TriangleMesh]) -> Iterator[tuple[Floats, int]]:
    """How much farther from the exact tile's edge than they have to be points of a solid are, and how many are outside.

    At levels these are its vertices and the middles of its walls' sides, half way between levels those of its section.
    """
    mesh, depth, unit = inset.meshes[tile], inset.depth, inset.loft.design.unit_mm
    heights = mesh.vertices[:, 2]
    walls = mesh.triangles[np.ptp(heights[mesh.triangles], axis=1) > 0.0]
    sides = np.concatenate([walls[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
    ends = mesh.vertices[sides[heights[sides[:, 0]] == heights[sides[:, 1]]]]
    order = np.argsort(ends[:, 0, 2], kind="stable")
    at, lines = ends[order, 0, 2], ends[order, :, :2].copy().view(np.complex128)[..., 0]
    for level in inset.levels:
        if level.rings[tile][0].number is None:  # others are the loft's own
            own = lines[slice(*np.searchsorted(at, [level.z, np.nextafter(level.z, np.inf)]).tolist())]
            yield _off(own, level.level.core, tile, level.z, depth, unit)
    for slab, part in zip(inset.slabs, parts, strict=True):
        if slab.middle is not None:
            z = slab.middle.z * unit
            ring = section(part, z)
            yield _off(np.column_stack((ring.start, ring.end)), slab.middle, tile, z, depth, unit)


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
