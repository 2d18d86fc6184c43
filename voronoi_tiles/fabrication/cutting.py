"""What is cut: every line once, or closed contours; in a short order, with bridges that hold the pieces."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints, offsets_of, ranges
from voronoi_tiles.fabrication.clipping import OUTSIDE, Strands
from voronoi_tiles.fabrication.edge_tabs import bridged
from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.layout import Contours, Layout
from voronoi_tiles.fabrication.tile_colouring import TileColouring
from voronoi_tiles.fabrication.tour import short_tour
from voronoi_tiles.fabrication.trails import find_trails, joined
from voronoi_tiles.formats.burns import Role
from voronoi_tiles.paths.areas import ring_areas
from voronoi_tiles.paths.contour_tabs import with_tabs
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.paths.winding import item_winding


@dataclass(frozen=True, eq=False)
class Cut:
    """The cuts of one layer: `suffix` is added to the name of its role; `colour` is a number of the palette.

    With `items` the paths from items[k] up to items[k + 1] are the outlines of a shape that is to be filled.
    """

    role: Role
    suffix: str
    colour: int | None
    paths: Paths
    items: Ints | None = None


def of_colour(contours: Contours, colouring: TileColouring, job: Job) -> Contours:
    """The pieces of the only colour that is asked for."""
    if job.only_colour is None:
        return contours
    chosen = np.flatnonzero(colouring.of_copies(contours.copy) == job.only_colour)
    if not len(chosen):
        raise JobError(
            f"no piece has the `only_colour` {job.only_colour}",
            remedy=f"Colours are 0 to {colouring.count - 1}, a sheet has perhaps not all of them, and -1 is its frame.",
        )
    rings = ranges(contours.items[chosen], np.diff(contours.items)[chosen])
    items = offsets_of(np.diff(contours.items)[chosen])
    loose = None if contours.loose is None else contours.loose[rings]
    return Contours(contours.paths.take(rings), items, contours.copy[chosen], contours.area[chosen], loose)


def cut_lines(layout: Layout, job: Job) -> list[Cut]:
    """Every line once, after holes that are bored."""
    bores = [Cut("inner", "", None, toured(layout.bores))] if len(layout.bores) else []
    return [*bores, Cut("cut", "", None, cut_once(layout, job))]


def cut_once(layout: Layout, job: Job) -> Paths:
    """Every line once: what lies between tiles in the fewest trails, then the rings around them."""
    strands = layout.lines()
    outer = (strands.left == OUTSIDE) | (strands.right == OUTSIDE) | strands.border
    inner = np.flatnonzero(~outer)
    paths, first, last, node = strands.paths.take(inner), strands.first[inner], strands.last[inner], strands.node
    if job.tabs > 0.0:
        paths, first, last, node = bridged(paths, first, last, node, strands, inner, job.tabs)
    trails = joined(paths, find_trails(first, last, node))
    around = _outer_rings(layout, strands, outer)
    if job.tabs > 0.0:
        around = _tabbed(around, job.tabs)
    return Paths.concatenate([trails, around])


def _outer_rings(layout: Layout, strands: Strands, outer: Bools) -> Paths:
    """The rings around the tiles, closed, in a short order; the border of the sheet comes last."""
    kept = np.flatnonzero(outer & ~strands.border)
    rings = joined(strands.paths.take(kept), find_trails(strands.first[kept], strands.last[kept], strands.node))
    if layout.region is None or layout.job.fit == "whole":
        return toured(rings)
    return Paths.concatenate([toured(rings), toured(layout.region.border)])


def toured(paths: Paths) -> Paths:
    """Put paths into an order with short ways between them."""
    if len(paths) < 2:
        return paths
    order, turned = short_tour(paths.start[paths.offsets[:-1]], paths.end[paths.offsets[1:] - 1])
    return paths.take(order).reversed(turned)


def _tabbed(paths: Paths, width: float) -> Paths:
    """Leave bridges in closed paths; those that are shorter than four bridges stay closed, if any is longer."""
    length = paths.path_lengths
    long = length >= 4 * width
    if not long.any():
        long[:] = True
    try:
        tabbed = with_tabs(paths.take(np.flatnonzero(long)), width)
    except ValueError as error:
        raise JobError(str(error), remedy="Use narrower `tabs`.") from error
    return Paths.concatenate([tabbed, paths.take(np.flatnonzero(~long))])


def cut_pieces(contours: Contours, colouring: TileColouring, job: Job) -> list[Cut]:
    """The contours of pieces, holes first, each colour on its own.

    Pieces that are nested in holes come before these, which fall out.
    """
    depth = _depths(contours.paths, nested=job.nests)
    outer = depth == 0
    loose = np.zeros(len(depth), np.bool_) if contours.loose is None else contours.loose
    of = np.repeat(np.arange(len(contours.copy)), np.diff(contours.items))
    colour = colouring.of_copies(contours.copy)
    cuts = []
    roles: tuple[tuple[Role, Bools], ...] = (("inner", ~outer), ("cut", outer))
    for role, chosen in roles:
        for group, suffix, in_group in _groups(colour, job):
            picked = np.flatnonzero(chosen & in_group[of])
            if not len(picked):
                continue
            bored, held = picked[loose[picked]], picked[~loose[picked]]
            by_depth = [held[depth[held] == n] for n in np.unique(depth[held])[::-1].tolist()]
            paths = Paths.concatenate([toured(contours.paths.take(own)) for own in by_depth])
            if job.tabs > 0.0 and len(paths):
                # The beam takes half a kerf from either end of a bridge.
                paths = _tabbed(paths, job.tabs + job.kerf)
            if len(bored):
                paths = Paths.concatenate([toured(contours.paths.take(bored)), paths])
            cuts.append(Cut(role, suffix, group, paths))
    return cuts


def _depths(rings: Paths, *, nested: bool) -> Ints:
    """In how many other rings each lies: 0 around pieces, 1 around holes; more where pieces are `nested` in holes."""
    hole = ring_areas(rings) <= 0
    depth = hole.astype(np.intp)
    if nested and hole.any():
        holes = rings.take(np.flatnonzero(hole))
        around = item_winding(holes, holes.offsets, rings.start[rings.offsets[:-1]]) != 0
        around[np.arange(len(holes)), np.flatnonzero(hole)] = False
        depth += 2 * around.sum(axis=0)
    return depth


def cut_shapes(contours: Contours, colouring: TileColouring, job: Job) -> list[Cut]:
    """The pieces as shapes, each with its holes, each colour on its own."""
    cuts = []
    for group, suffix, in_group in _groups(colouring.of_copies(contours.copy), job):
        picked = np.flatnonzero(in_group)
        counts = np.diff(contours.items)[picked]
        paths = contours.paths.take(ranges(contours.items[picked], counts))
        cuts.append(Cut("cut", suffix, group, paths, offsets_of(counts)))
    return cuts


def _groups(colour: Ints, job: Job) -> Iterator[tuple[int | None, str, Bools]]:
    """What goes on a layer of its own: a colour, the end of the layer's name, and which pieces have it."""
    if job.split != "layers":
        yield None, "", np.ones(len(colour), np.bool_)
        return
    for group in np.unique(colour).tolist():
        yield group, f"-{group + 1}" if group >= 0 else "-frame", colour == group
