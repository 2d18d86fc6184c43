"""What the wallpaper groups do to tiles, measured over random sites: python docs/generate/census.py pgg --sites 9."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from chambers import Chamber, chamber_about, chamber_numbers
from in_blocks import add_options, in_blocks
from numpy.typing import NDArray
from random_sites import CELLS, random_design
from shapes import Shape, congruent
from straight_lines import endless_lines, mirror_lines, same_line

import voronoi_tiles as vt
from voronoi_tiles.groups.symmetry_elements import symmetry_elements
from voronoi_tiles.groups.wallpaper import GROUPS, Lattice, WallpaperGroup
from voronoi_tiles.raster.scene import Pattern, distances, gather
from voronoi_tiles.tiling import Tiling
from voronoi_tiles.vector.outline import Outline

Complexes = NDArray[np.complex128]
Bools = NDArray[np.bool_]

SEED = 2026

EVEN = {"a": 60.0, "b": 60.0}
"""A cell with equal sides, in mm: what some rectangular groups make of it is more regular."""

POINTS = 400
"""Points of the first tile's outline that are asked whether they lie on edges for every other site too; a count."""

NEAR = 1e-9
"""What counts as nothing beside the cell's longer side: a thousand times what outlines may be off."""


@dataclass(frozen=True)
class Measured:
    """One tile: arcs of parabolas, shares of its perimeter, endless lines per cell, its chamber.

    `beyond` is how far the tile leaves the chamber, beside the cell's longer side; `filling` the chamber's area beside
    the tile's.
    """

    curves: int
    straight: float
    on_mirrors: float
    endless: int
    endless_off_mirrors: int
    mirrors_missing: int
    beyond: float
    filling: float
    left_and_right: bool
    area_error: float


@dataclass
class Census:
    """A group's tiles, one for each random site within one chamber, and those of sites `scattered` over several.

    `refused` sites were drawn where copies touch, `unproved` ones failed their proof. `shapes` counts the shapes among
    the tiles of all sites, where turning over is allowed. `survived` and `expected` count points of the first tile's
    outline: those on edges for every site, and those on mirrors; `strangers` those in one of the two but not in both.
    """

    group: str
    cell: dict[str, float]
    tiles: list[Measured] = field(default_factory=list)
    scattered: list[Measured] = field(default_factory=list)
    refused: int = 0
    unproved: int = 0
    shapes: int = 0
    survived: int = 0
    expected: int = 0
    strangers: int = 0

    def values(self, name: str) -> NDArray[np.float64]:
        """One figure of all tiles."""
        return np.array([getattr(tile, name) for tile in self.tiles], np.float64)

    @property
    def mirrors(self) -> int:
        """How many mirrors there are, up to translations."""
        return len(symmetry_elements(GROUPS[self.group]).mirrors)

    @property
    def lattice(self) -> Lattice:
        """The lattice of the cell."""
        return GROUPS[self.group].lattice(self.cell["a"], self.cell.get("b"), self.cell.get("angle"))

    @property
    def chamber(self) -> Chamber:
        """A chamber; all of them are congruent, for every mirror maps chambers to chambers."""
        return chamber_about(GROUPS[self.group], self.lattice, self.lattice.cartesian(0.0312, 0.0171))

    @property
    def in_chamber(self) -> int:
        """How many tiles fill a chamber; 0 where chambers are not bounded."""
        chamber = self.chamber
        return round(chamber.area / self.lattice.det * GROUPS[self.group].order) if chamber.bounded else 0


def census(group: str, sites: int, cell: dict[str, float] | None = None) -> Census:
    """Measure the tiles of so many random sites of a group, each within one chamber; others come on top."""
    row = GROUPS[group]
    rng = np.random.default_rng([SEED, *group.encode()])
    result = Census(group, cell or CELLS[row.system])
    shapes, points = _Shapes(), _Points()
    while len(result.tiles) < sites:
        design = vt.Design.from_dict(random_design(group, len(result.tiles), rng, result.cell))
        site = design.noded[0]
        where = chamber_numbers(row, design.lattice, site.nodes)
        try:
            if np.any(where[site.segments[:, 0]] != where[site.segments[:, 1]]):
                result.refused += 1  # it crosses a mirror, and meets its image there
                continue
            tiling = design.tessellate()
        except vt.TouchingCopiesError:
            result.refused += 1
            continue
        except vt.ProofError:
            result.unproved += 1
            continue
        outline = tiling.tiles[0].outline
        shape = Shape.of(outline)
        measured = _measure(tiling, shape, chamber_about(row, design.lattice, complex(site.nodes[0])))
        if np.any(where != where[0]):
            result.scattered.append(measured)
            continue
        result.tiles.append(measured)
        shapes.add(shape, outline.perimeter)
        points.see(tiling)
    result.shapes = len(shapes)
    result.survived, result.expected, result.strangers = points.counts()
    return result


Cell = dict[str, float] | None


def censuses(
    groups: Iterable[str],
    sites: int,
    cell: Cell = None,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
) -> list[Census]:
    """Measure several groups, on all processors or on Dask (see `in_blocks`); in their order."""
    return in_blocks(census_of, [(group, sites, cell) for group in groups], workers=workers, scheduler=scheduler)


def census_of(block: tuple[str, int, Cell]) -> Census:
    """The census of a group, as a block."""
    return census(*block)


class _Shapes:
    """The different shapes seen so far, where turning over is allowed."""

    def __init__(self) -> None:
        self._known: list[tuple[float, Shape]] = []

    def __len__(self) -> int:
        return len(self._known)

    def add(self, shape: Shape, perimeter: float) -> None:
        """Count a shape, if it is new."""
        alike = [old for length, old in self._known if abs(length - perimeter) <= NEAR * perimeter]
        if not any(congruent(shape, old) or congruent(shape.mirrored, old) for old in alike):
            self._known.append((perimeter, shape))


class _Points:
    """Points of the first outline that have been on edges ever since, by the distances alone."""

    def __init__(self) -> None:
        self._points: Complexes = np.zeros(0, complex)
        self._mirrored: Bools = np.zeros(0, np.bool_)
        self._alive: Bools = np.zeros(0, np.bool_)

    def see(self, tiling: Tiling) -> None:
        """Keep the points that are as far from two copies of this site, and no farther from any."""
        if not len(self._points):
            outline = tiling.tiles[0].outline
            self._points, edge = _spread(outline, POINTS)
            self._mirrored = _on_mirrors(tiling, outline)[edge]
            self._alive = np.ones(POINTS, np.bool_)
            return
        alive = np.flatnonzero(self._alive)
        if not len(alive):
            return
        design = tiling.design
        here = self._points[alive]
        middle = complex(here.mean())
        radius = float(np.abs(here - middle).max())
        scene = gather(Pattern(design.noded, design.group, design.lattice), 0j, middle, radius)
        away = distances(here[:, None], scene.middle, scene.half)
        away = np.partition(np.minimum.reduceat(away, scene.copy_start, axis=1), 1, axis=1)
        self._alive[alive] = away[:, 1] - away[:, 0] <= NEAR * abs(design.lattice.a)

    def counts(self) -> tuple[int, int, int]:
        """How many are left, how many lie on mirrors, and how many do one but not the other."""
        strangers = int(np.count_nonzero(self._alive != self._mirrored))
        return int(self._alive.sum()), int(self._mirrored.sum()), strangers


def _measure(tiling: Tiling, shape: Shape, chamber: Chamber) -> Measured:
    """Measure one tile."""
    design, outline = tiling.design, tiling.tiles[0].outline
    scale = max(abs(design.lattice.a), abs(design.lattice.b))
    lines, mirrors = endless_lines(tiling), mirror_lines(design.group)
    off = sum(not any(same_line(line, mirror) for mirror in mirrors) for line in lines)
    missing = sum(not any(same_line(line, mirror) for line in lines) for mirror in mirrors)
    points = np.concatenate((outline.start, outline.control))
    return Measured(
        curves=int(outline.curved.sum()),
        straight=float(outline.lengths[~outline.curved].sum()) / outline.perimeter,
        on_mirrors=float(outline.lengths[_on_mirrors(tiling, outline)].sum()) / outline.perimeter,
        endless=len(lines),
        endless_off_mirrors=off,
        mirrors_missing=missing,
        beyond=max(chamber.beyond(points), 0.0) / scale,
        filling=chamber.area / outline.area,
        left_and_right=_turns_over(design.group) and not congruent(shape, shape.mirrored),
        area_error=_area_error(tiling),
    )


def _area_error(tiling: Tiling) -> float:
    """How much the tiles of a cell differ from it in area, beside the cell."""
    total = sum(tile.area * tile.copies_per_cell for tile in tiling.tiles)
    return abs(total / tiling.design.lattice.det - 1)


def _turns_over(group: WallpaperGroup) -> bool:
    """Whether some copies are mirror images of others."""
    return any(operation.determinant < 0 for operation in group.operations)


def _on_mirrors(tiling: Tiling, outline: Outline) -> Bools:
    """Which edges lie on mirrors."""
    design = tiling.design
    x, y = (np.stack(design.lattice.fractional(points)) for points in (outline.start, outline.end))
    found = np.zeros(len(outline), np.bool_)
    for line in symmetry_elements(design.group).mirrors:
        (p, q), offset = line.direction, float(line.offset)
        off = [np.abs((q * s - p * t - offset + 0.5) % 1 - 0.5) for s, t in (x, y)]
        found |= ~outline.curved & (off[0] <= NEAR) & (off[1] <= NEAR)
    return found


def _spread(outline: Outline, count: int) -> tuple[Complexes, NDArray[np.intp]]:
    """Points all along an outline, away from its vertices in general, and the edges that they lie on."""
    rng = np.random.default_rng(SEED)
    ends = np.cumsum(outline.lengths)
    place = (np.arange(count) + rng.random(count)) / count * ends[-1]
    edge = np.minimum(np.searchsorted(ends, place), len(ends) - 1)
    t = rng.random(count)
    start, control, end = outline.start[edge], outline.control[edge], outline.end[edge]
    return start * (1 - t) ** 2 + 2 * t * (1 - t) * control + end * t**2, edge


def main() -> None:
    """Print the figures of some groups."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("groups", nargs="*", default=list(GROUPS), help="groups (default: all)")
    parser.add_argument("--sites", type=int, default=1000, help="random sites per group (default: 1000)")
    parser.add_argument("--even", action="store_true", help="cells with a = b, for groups with rectangular ones")
    add_options(parser)
    options = parser.parse_args()
    other = [name for name in options.groups if GROUPS[name].system != "rectangular"]
    if options.even and other:
        parser.error(f"--even is for groups with rectangular cells, not for {', '.join(other)}")
    where = {"workers": options.workers, "scheduler": options.scheduler}
    for found in censuses(options.groups, options.sites, EVEN if options.even else None, **where):
        print(describe(found))


def _between_mirrors(found: Census) -> str:
    """Say what the mirrors leave, and how many tiles it holds."""
    chamber = found.chamber
    if not len(chamber.sides):
        return "no mirrors"
    return f"{chamber.name}, {found.in_chamber} tiles in each" if chamber.bounded else f"{chamber.name}, not bounded"


def describe(found: Census) -> str:
    """A group's figures as lines of text."""

    def spread(name: str) -> str:
        low, middle, high = np.quantile(found.values(name), (0.0, 0.5, 1.0))
        return f"{middle:.1%} ({low:.1%} to {high:.1%})"

    tiles, scattered = found.tiles, found.scattered
    figures = {
        "sites": f"{len(tiles)}; {found.refused} more drawn where copies touch, {found.unproved} unproved",
        "straight share of the outline": spread("straight"),
        "share on mirrors": spread("on_mirrors"),
        "tiles without a curve": np.count_nonzero(found.values("curves") == 0),
        "tilings with an endless straight line": np.count_nonzero(found.values("endless")),
        "tilings with one that is no mirror": np.count_nonzero(found.values("endless_off_mirrors")),
        "tilings where a mirror is no edge": np.count_nonzero(found.values("mirrors_missing")),
        f"points of {POINTS} on edges for every site": found.survived,
        f"points of {POINTS} on mirrors": found.expected,
        "points in one of the two but not in both": found.strangers,
        "shapes among all tiles": found.shapes,
        "tilings with left and right tiles": np.count_nonzero(found.values("left_and_right")),
        "between mirrors": _between_mirrors(found),
        "a tile leaves it by at most, of the cell": f"{found.values('beyond').max():.1e}",
        "areas are off by at most, of the cell": f"{found.values('area_error').max():.1e}",
        "sites in several of them, and such tiles with curves": (
            f"{len(scattered)}, {sum(tile.curves > 0 for tile in scattered)}"
        ),
    }
    return "\n".join((found.group, *(f"  {name}: {value}" for name, value in figures.items())))


if __name__ == "__main__":
    main()
