"""Exact tiles at one height: the quotient complex of a layer, named so that those of other layers can be compared."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.groups.wallpaper import Lattice, WallpaperGroup
from voronoi_tiles.solid.loops import with_whole_loops
from voronoi_tiles.vector.complex.quotient import Quotient
from voronoi_tiles.vector.copies import symmetrized, translation
from voronoi_tiles.vector.motion_codes import Codes, code_of, composed, encode, least_products, motion_of
from voronoi_tiles.vector.motions import Action, Motion, compose
from voronoi_tiles.vector.proof import ProofReport, proved_tiles
from voronoi_tiles.vector.tessellation import TileRecord

_ROUNDING: Final = 1e-9
"""How far from being symmetric a site is at most that is made so; relative to the cell's size."""

Name = tuple[int, int]
"""What lies beyond an edge: the number of a site, and the code of the motion that takes its drawn place there."""


@dataclass(frozen=True, eq=False)
class ExactLayer:
    """The tiles of the `sites` of a design at the height `z`, proved.

    Motions are on the sites where they are drawn. Edge use u is the image of edge `edge[u]` (intp) of the quotient
    complex under `motion[u]` (int64), run through `backwards[u]` (bool) by the boundary of its tile; beyond it lies the
    copy `names[u]`. The uses of ring r are those from `ring_offsets[r]` up to, not including, `ring_offsets[r + 1]`,
    the rings of tile t those from `tile_offsets[t]` up to `tile_offsets[t + 1]`.
    """

    z: float
    sites: Sequence[NodedSite]
    records: Sequence[TileRecord]
    proof: ProofReport
    quotient: Quotient
    edge: Ints
    motion: Codes
    backwards: Bools
    names: tuple[Name, ...]
    ring_offsets: Ints
    tile_offsets: Ints

    @classmethod
    def of(
        cls,
        z: float,
        sites: Sequence[NodedSite],
        group: WallpaperGroup,
        lattice: Lattice,
        stabilizers: Sequence[tuple[int, ...]] = (),
    ) -> ExactLayer:
        """The layer of these sites, which motions, the codes of which are given for each, map onto themselves.

        Raises TouchingCopiesError and ProofError, as for any design.
        """
        if any(len(own) > 1 for own in stabilizers):
            action = Action(group, lattice)
            sites = [_symmetric(action, site, own) for site, own in zip(sites, stabilizers, strict=True)]
        records, proof = proved_tiles(sites, group, lattice)
        tessellation = records[0].tessellation
        quotient, placed = with_whole_loops(tessellation.quotient), tessellation.placed
        uses = quotient.uses
        there = encode([translation(p, 1) for p in placed])
        back = encode([translation(p, -1) for p in placed])
        tile = np.repeat(np.arange(len(placed)), np.diff(uses.ring_offsets[uses.tile_offsets]))
        beyond = composed(composed(there[tile], uses.beyond), back[uses.site])
        special = [k for k, p in enumerate(placed) if len(p.stabilizer) > 1]
        if special:
            beyond = least_products(beyond, *_fixing(uses.site, {k: _stabilizer(records[k]) for k in special}))
        return cls(
            z=z,
            sites=sites,
            records=records,
            proof=proof,
            quotient=quotient,
            edge=uses.edge,
            motion=composed(there[tile], uses.motion),
            backwards=uses.backwards,
            names=tuple(zip(uses.site.tolist(), beyond.tolist(), strict=True)),
            ring_offsets=uses.ring_offsets,
            tile_offsets=uses.tile_offsets,
        )

    @property
    def action(self) -> Action:
        """The group over the lattice."""
        return self.records[0].tessellation.action

    @property
    def stabilizers(self) -> tuple[tuple[int, ...], ...]:
        """For each site the codes of the motions that map it onto itself, ascending."""
        return tuple(_stabilizer(record) for record in self.records)

    @cached_property
    def lengths(self) -> Floats:
        """The length of each edge, float64 (edges,)."""
        paths = self.quotient.paths()
        return np.asarray(np.bincount(paths.owner, weights=paths.lengths, minlength=len(paths)), np.float64)

    @cached_property
    def ring(self) -> Ints:
        """The ring of each use."""
        return np.repeat(np.arange(len(self.ring_offsets) - 1), np.diff(self.ring_offsets))

    @cached_property
    def starts(self) -> Complexes:
        """Where each use begins on the boundary of its tile, complex128 (uses,)."""
        quotient, at = self.quotient, self.edge
        first = quotient.offsets[at] + at
        last = quotient.offsets[at + 1] + at
        points = quotient.vertex.take(np.where(self.backwards, last, first)).moved(self.motion)
        return quotient.representatives.locate(points)

    @cached_property
    def rings(self) -> tuple[tuple[tuple[Name, ...], ...], ...]:
        """For each tile its rings, as the names of what lies beyond their edges."""
        bounds = self.ring_offsets.tolist()
        rings = [self.names[a:b] for a, b in pairwise(bounds)]
        return tuple(tuple(rings[a:b]) for a, b in pairwise(self.tile_offsets.tolist()))


def _symmetric(action: Action, site: NodedSite, stabilizer: tuple[int, ...]) -> NodedSite:
    """A site made symmetric that is so up to rounding, which is more where strokes cross at a small angle."""
    nodes = symmetrized(action, site.nodes, tuple(map(motion_of, stabilizer)))
    return replace(site, nodes=nodes) if np.abs(nodes - site.nodes).max() <= _ROUNDING * action.size else site


def _stabilizer(record: TileRecord) -> tuple[int, ...]:
    """The codes of the motions that map a site onto itself, where it is drawn."""
    placed = record.tessellation.placed[record._index]  # noqa: SLF001 - it is read, and belongs to the same result
    there, back = translation(placed, 1), translation(placed, -1)
    return tuple(sorted(code_of(_conjugated(there, motion, back)) for motion in placed.stabilizer))


def _conjugated(there: Motion, motion: Motion, back: Motion) -> Motion:
    return compose(compose(there, motion), back)


def _fixing(site: Ints, stabilizers: dict[int, tuple[int, ...]]) -> tuple[Ints, Codes]:
    """For each use the row of the stabilizer of the site beyond, -1 where it has none; the rows, filled up."""
    width = max(map(len, stabilizers.values()))
    row = np.full(int(site.max()) + 1, -1)
    rows: list[tuple[int, ...]] = []
    for site_number, codes in stabilizers.items():
        if site_number < len(row):
            row[site_number] = len(rows)
        rows.append(codes + codes[:1] * (width - len(codes)))
    return row[site], np.array(rows, np.int64)
