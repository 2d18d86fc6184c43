"""Scan conversion: owners of samples against ray crossing and winding numbers, every sample exactly once."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from helpers import brute
from helpers.examples import each_example, tiling
from helpers.outlines import ABOVE, RIGHT, polygon, winding_number

from voronoi_tiles.base.maps import UNITS, Isometry
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.tiling import Tiling
from voronoi_tiles.vector.arcs import Arc, LineArc, ParabolaArc
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.scan import Grid, crossings, owners, scan_spans

IDENTITY = Isometry(1 + 0j, 0j, conj=False)
MIRROR = Isometry(-1 + 0j, 10 + 0j, conj=True)
UNIT_GRID = Grid(0j, 20 + 0j, 20j, 20, 20, (0.0, 0.0))

Copies = list[tuple[Outline, Isometry]]


def copies_of(tiles: Tiling) -> tuple[Copies, list[tuple[int, Operation]]]:
    """One cell's copies, and the site and operation of each: one operation of every coset of the symmetry."""
    copies, names = [], []
    for site, tile in enumerate(tiles.tiles):
        seen: set[Operation] = set()
        for operation in tiles.design.group.operations:
            if operation not in seen:
                seen |= {(operation @ own).reduced() for own in tile.symmetry}
                copies.append((tile.outline, tiles.design.lattice.isometry(operation)))
                names.append((site, operation))
    return copies, names


def grid_of(tiles: Tiling, nx: int, ny: int, phase: tuple[float, float]) -> Grid:
    """A grid of the cell at the origin."""
    return Grid(0j, tiles.design.lattice.a, tiles.design.lattice.b, nx, ny, phase)


def tangle(seed: int) -> Outline:
    """Two rings of lines and wild parabolas that cross themselves and each other; some arcs are level."""
    rng = np.random.default_rng(seed)
    rings = []
    for count in (5, 3):
        points = (rng.uniform(-9, 9, count) + 1j * rng.integers(-9, 9, count)).tolist()
        bends = (rng.uniform(-20, 20, count) + 1j * rng.uniform(-20, 20, count)).tolist()
        arcs: list[Arc] = [
            ParabolaArc(a, (a + b) / 2 + bend, b, 0j, (0j, 1j), RIGHT) if k % 3 else LineArc(a, b, ABOVE)
            for k, (a, b, bend) in enumerate(zip(points, [*points[1:], points[0]], bends, strict=True))
        ]
        rings.append(arcs)
    return Outline.from_rings(rings)


def painted(copies: Copies, grid: Grid, low: int, high: int) -> np.ndarray:
    """The winding number of each sample low <= i, j < high, row by row, from the spans."""
    image = np.zeros((high - low, high - low), int)
    spans = scan_spans(copies, grid)
    for row, first, stop, winding in zip(spans.row, spans.first, spans.stop, spans.winding, strict=True):
        if low <= row < high:
            image[row - low, max(first - low, 0) : max(stop - low, 0)] += winding
    return image


@each_example
def test_owners_contain_their_samples(name: str) -> None:
    """The owner of a random sample contains it by counting crossings of a ray: the oracle, with its own groups."""
    tiles = tiling(name)
    copies, names = copies_of(tiles)
    grid = grid_of(tiles, 211, 173, (0.37, 0.61))
    image = owners(copies, grid)
    assert (image.count == 1).all()
    document = tiles.document()
    plane = brute.Plane.of(document)
    shapes = [brute.Shape(tile) for tile in document["tiles"]]
    rng = np.random.default_rng(1)
    i, j = rng.integers(grid.nx, size=600), rng.integers(grid.ny, size=600)
    label = image.label[j, i]
    for number in np.unique(label).tolist():
        k, m, n = image.labels[number].tolist()
        site, operation = names[k]
        motion = brute.read_operation(plane.group, str(operation)).then(m, n)
        chosen = label == number
        assert shapes[site].contains(plane.pull(motion, grid.at(i[chosen], j[chosen]))).all()


@each_example
@pytest.mark.parametrize("phase", [(0.0, 0.0), (0.5, 0.5), (0.25, 0.75)])
def test_every_sample_has_one_owner(name: str, phase: tuple[float, float]) -> None:
    """Also where samples lie on rotation centres, on corners and along straight edges, in whatever cell."""
    tiles = tiling(name)
    image = owners(copies_of(tiles)[0], grid_of(tiles, 240, 240, phase))
    assert (image.count == 1).all()
    assert (image.label >= 0).all()


@each_example
def test_copies_own_as_many_samples_as_their_area(name: str) -> None:
    """Each copy has its share, but for at most half a sample where its outline passes one."""
    tiles = tiling(name)
    copies, _ = copies_of(tiles)
    grid = grid_of(tiles, 1021, 1013, (0.37, 0.61))
    image = owners(copies, grid)
    seen = np.bincount(image.labels[image.label.ravel(), 0], minlength=len(copies))
    sample = abs(grid.det) / (grid.nx * grid.ny)
    for count, (outline, _) in zip(seen.tolist(), copies, strict=True):
        assert abs(count * sample - outline.area) < 0.5 * outline.perimeter * sample**0.5


def test_a_finer_grid_and_another_origin_show_the_same() -> None:
    """Every second sample of a grid is one of a coarser grid; one that begins cells further on has other labels."""
    tiles = tiling("cm-moth")
    copies, _ = copies_of(tiles)
    fine, coarse = (grid_of(tiles, n, n, (0.3 * n / 100, 0.7 * n / 100)) for n in (200, 100))
    far = replace(coarse, origin=3 * coarse.a - 2 * coarse.b)
    whose, same, moved = (image.labels[image.label] for image in (owners(copies, g) for g in (fine, coarse, far)))
    assert (whose[::2, ::2] == same).all()
    assert (moved - same == [0, 3, -2]).all()


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(
    ("isometry", "b"),
    [(IDENTITY, 18j), (MIRROR, 7 + 15j), (Isometry(UNITS[5], 2 - 3j, conj=True), -4 - 13j)],
    ids=["plain", "mirrored", "mirrored grid"],
)
def test_winding_numbers(seed: int, isometry: Isometry, b: complex) -> None:
    """Rings that cross themselves: rows and columns both have the winding numbers that the angles add up to."""
    outline = tangle(seed)
    grid = Grid(0.1 + 0.2j, 16 + 1j, b, 23, 19, (0.21, 0.43))
    low, high = -60, 60
    found = painted([(outline, isometry)], grid, low, high)
    rng = np.random.default_rng(seed)
    image = outline.transformed(isometry)
    for i, j in rng.integers(-20, 20, (60, 2)).tolist():
        assert found[j - low, i - low] == winding_number(image, complex(grid.at(i, j)))
    by_columns = np.zeros_like(found)
    for _, column, y, direction in zip(*crossings(outline, isometry, grid, axis=1), strict=True):
        by_columns[max(int(np.ceil(y)) - low, 0) :, column - low] += direction
    assert (by_columns == found).all()


def test_crossings_lie_on_their_arcs() -> None:
    """Each position is a point of its arc."""
    outline = tangle(3)
    grid = Grid(0j, 16 + 1j, 3 + 15j, 23, 19)
    arc, row, x, _ = crossings(outline, IDENTITY, grid)
    point = grid.at(x, row)
    t = np.linspace(0.0, 1.0, 20001)[:, None]
    a, c, b = outline.start[arc], outline.control[arc], outline.end[arc]
    off = np.abs((1 - t) ** 2 * a + 2 * t * (1 - t) * c + t * t * b - point).min(axis=0)
    assert off.max() < 1e-2


def test_samples_on_edges_and_corners_count_once(square: Outline) -> None:
    """A square with whole corners holds its lower and left edge, not the others: each sample belongs to one square."""
    image = owners([(square, IDENTITY)], UNIT_GRID)
    assert np.flatnonzero(image.count.any(axis=0)).tolist() == list(range(10))
    assert np.flatnonzero(image.count.any(axis=1)).tolist() == list(range(10))
    assert image.count.sum() == 100
    assert image.labels.tolist() == [[0, 0, 0]]
    assert ((image.label == 0) == (image.count == 1)).all()
    shifts = [0j, 10 + 0j, 10j, 10 + 10j]
    four: Copies = [(square, Isometry(1 + 0j, shift, conj=False)) for shift in shifts]
    assert (owners(four, UNIT_GRID).count == 1).all()
    turned: Copies = [(square, Isometry(unit, 0j, conj=conj)) for unit, conj in ((1, False), (1j, False), (-1, False))]
    assert (owners([*turned, (square, Isometry(1 + 0j, 0j, conj=True))], UNIT_GRID).count == 1).all()


def test_copies_billions_of_cells_apart_keep_their_names(square: Outline) -> None:
    """Which translate of a copy has a sample: all translates there are, together, would not fit in 64 bits."""
    far = 4_000_000_000
    cells = [(far, -far, 0j), (-far, far, 10 + 0j), (7, 0, 10j), (0, 7, 10 + 10j)]
    copies: Copies = [(square, Isometry(1 + 0j, shift + m * 20 + n * 20j, conj=False)) for m, n, shift in cells]
    image = owners(copies, UNIT_GRID)
    assert (image.count == 1).all()
    for k, (m, n, shift) in enumerate(cells):
        assert image.labels[image.label[int(shift.imag), int(shift.real)]].tolist() == [k, -m, -n]


def test_a_mirrored_square_is_the_square(square: Outline) -> None:
    """A reflection turns the rings round, and with them what is inside; it still counts once."""
    mirrored = Isometry(1 + 0j, 10j, conj=True)
    plain, image = (owners([(square, isometry)], UNIT_GRID) for isometry in (IDENTITY, mirrored))
    assert (plain.count == image.count).all()
    assert (owners([(square, IDENTITY)], replace(UNIT_GRID, b=-20j)).count >= 0).all()


def test_a_hole_belongs_to_what_fills_it(ring: Outline) -> None:
    """The samples in a hole are not the ring's, and those of an island are the island's."""
    island = Outline.from_rings([polygon(4 + 4j, 6 + 4j, 6 + 6j, 4 + 6j)])
    hole = owners([(ring, IDENTITY)], UNIT_GRID)
    assert hole.count.sum() == 96
    assert (hole.count[4:6, 4:6] == 0).all()
    image = owners([(ring, IDENTITY), (island, IDENTITY)], UNIT_GRID)
    assert image.count.sum() == 100
    assert (image.labels[image.label[4:6, 4:6]] == [1, 0, 0]).all()


@pytest.mark.parametrize("shift", [0.0, 1e-6, -1e-6, 1e-13])
def test_turning_points_on_rows(lens: Outline, shift: float) -> None:
    """Rows through both tips and the ends of two parabolas, or a hair beside them: they go out as often as in."""
    grid = Grid(1j * shift, 8 + 0j, 8j, 16, 16, (0.0, 0.0))
    steps = np.arange(-8, 8) / 2
    seen = round(shift, 9)
    inside = np.abs(steps + seen)[:, None] < 1 - steps**2 / 4
    if seen == 0.0:
        # The left end belongs to what is on its right.
        inside[8, 4] = True
    image = owners([(lens, IDENTITY)], grid)
    assert (np.roll(image.count, (8, 8), (0, 1)) == inside).all()
    _, row, _, direction = crossings(lens, IDENTITY, grid)
    assert not np.bincount(row + 8, direction).any()


def test_an_arc_and_its_reverse_cross_at_the_same_places() -> None:
    """Bit for bit, and a whole number of cells away too."""
    outline = tangle(5)
    grid = Grid(0.1j, 17 + 0j, 3 + 13j, 1024, 800)
    arc, row, x, direction = crossings(outline, IDENTITY, grid)
    back = replace(outline, start=outline.end, end=outline.start)
    again = crossings(back, IDENTITY, grid)
    assert (again.position == x).all()
    assert (again.line == row).all()
    assert (again.direction == -direction).all()
    far = crossings(outline, Isometry(1 + 0j, 3 * grid.a - 5 * grid.b, conj=False), grid)
    assert (far.arc == arc).all()
    assert (far.position == x + 3 * grid.nx).all()
    assert (far.line == row - 5 * grid.ny).all()


def test_gaps_and_overlaps_show(ring: Outline) -> None:
    """The image sees a dropped hole, a moved vertex, a copy too many, and two that make up for a third."""
    tiles = tiling("cm-moth")
    copies, _ = copies_of(tiles)
    grid = grid_of(tiles, 240, 240, (0.37, 0.61))
    outline, isometry = copies[0]
    moved = outline.start[0] + 3 * abs(grid.a) / grid.nx * UNITS[1]
    start, end = outline.start.copy(), outline.end.copy()
    start[0] = end[outline.ring_offsets[1] - 1] = moved
    image = owners([(replace(outline, start=start, end=end), isometry), *copies[1:]], grid)
    assert 0 < (image.count != 1).sum() < 100
    assert ((image.label == -1) >= (image.count != 1)).all()

    square = Outline.from_rings(ring.rings[:1])
    island = Outline.from_rings([polygon(4 + 4j, 6 + 4j, 6 + 6j, 4 + 6j)])
    filled = owners([(square, IDENTITY), (island, IDENTITY)], UNIT_GRID)
    assert (filled.count[4:6, 4:6] == 2).all()
    assert (filled.label == -1).sum() == 304
    against = Outline.from_rings([polygon(0j, 10j, 10 + 10j, 10 + 0j)])
    three = owners([(square, IDENTITY), (against, IDENTITY), (square, IDENTITY)], UNIT_GRID)
    assert three.count.sum() == 100
    assert (three.label == -1).all()
    twice = owners([(Outline.from_rings([*square.rings, *square.rings]), IDENTITY)], UNIT_GRID)
    assert twice.count.max() == 2
    assert (twice.label == -1).all()


def test_an_open_ring_is_refused(square: Outline) -> None:
    """A ring that does not close has no inside."""
    start = square.start.copy()
    start[1] += 2j
    with pytest.raises(ValueError, match="copy 1 is open: it has a gap that row 0 passes"):
        owners([(square, IDENTITY), (replace(square, start=start), IDENTITY)], UNIT_GRID)


def test_without_copies_nobody_owns_anything() -> None:
    """No copies, and a copy between the samples: an image without labels."""
    tiny = Outline.from_rings([polygon(0.2 + 0.2j, 0.8 + 0.2j, 0.5 + 0.8j)])
    for copies in ([], [(tiny, IDENTITY)]):
        image = owners(copies, UNIT_GRID)
        assert image.label.shape == image.count.shape == (20, 20)
        assert image.labels.shape == (0, 3)
        assert (image.label == -1).all()
        assert not image.count.any()


@pytest.mark.parametrize(
    "change", [{"nx": 0}, {"ny": -1}, {"b": 40 + 0j}, {"a": complex("nan")}, {"origin": complex("inf")}]
)
def test_grids_without_samples_are_refused(change: dict[str, Any]) -> None:
    """No samples, no area, no place."""
    with pytest.raises(ValueError, match="a grid needs"):
        replace(UNIT_GRID, **change)


def test_grid_coordinates_of_samples() -> None:
    """Coordinates and points are each other's inverse, also far from the origin."""
    grid = Grid(1e4 + 2e4j, 60 + 1j, 25 + 40j, 640, 480, (0.5, 0.25))
    i, j = np.meshgrid(np.arange(-700, 1400, 70), np.arange(-500, 1000, 50))
    x, y = grid.to_grid(grid.at(i, j))
    assert np.abs(x - i).max() < 1e-9
    assert np.abs(y - j).max() < 1e-9
    assert complex(grid.at(0, 0)) == pytest.approx(grid.origin + 0.5 * grid.a / 640 + 0.25 * grid.b / 480, rel=1e-15)
