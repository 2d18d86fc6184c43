"""The bench's peer that fits tiles of isohedral types to outlines, against its own definition, and its tables."""

from __future__ import annotations

import cmath
import math
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import shapely

# The bench is a folder of scripts beside the tests.
sys.path.append(str(Path(__file__).parents[2] / "bench"))

import escherization
import nearest_tiles
from isohedral import TEMPLATES, Complexes, Ints, Template
from nearest_tiles import Goal, Tile

import voronoi_tiles as vt

each_type = pytest.mark.parametrize("name", TEMPLATES)
TEMPLATE = {name: Template(name, pairings) for name, pairings in TEMPLATES.items()}


def numbers_of(name: str, rng: np.random.Generator, points: int) -> Ints:
    """Some numbers of steps along the edges, all of them many of a polygon's points."""
    rows = TEMPLATE[name].numbers(points)
    evenly = rows.min(axis=1) >= 2
    return np.asarray(rows[evenly][rng.integers(np.count_nonzero(evenly))])


def space(name: str, numbers: Ints) -> np.ndarray:
    """An orthonormal basis of the tiles, by conditions on the steps from point to point: x and y of n points, (2n, m).

    A translation has the steps backwards. A rotation clockwise by 360 / order degrees about the common corner, which is
    as much inside, has them backwards too; half turns have the same backwards, glides along x the same ones mirrored.
    """
    along = numbers[list(TEMPLATE[name].edges)]
    begin, count = np.cumsum(along) - along, int(along.sum())

    def step(edge: int, k: int) -> np.ndarray:
        """The rows of a step of a polygon: (2, 2n)."""
        row = np.zeros((2, count, 2))
        at = int(begin[edge]) + k
        row[0, (at + 1) % count, 0] = row[1, (at + 1) % count, 1] = 1.0
        row[0, at, 0] = row[1, at, 1] = -1.0
        return row.reshape(2, -1)

    rows = []
    for kind, edge, onto in TEMPLATES[name]:
        size = int(along[edge])
        for k in range(size):
            own = step(edge, k)
            if kind in "GH":
                mirror = np.diag([1.0, -1.0]) if kind == "G" else np.diag([-1.0, 1.0])
                rows.append(step(onto, k) - mirror @ own)
                continue
            angle = {"T": 0, "C2": 180, "C3": -120, "C4": -90, "C6": -60}[kind] * math.pi / 180
            turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
            rows.append(step(onto, size - 1 - k) + turn @ own)
    _, values, basis = np.linalg.svd(np.vstack(rows))
    return np.asarray(basis[np.count_nonzero(values > 1e-9) :].T)


def by_eigenvalue(basis: np.ndarray, goal: Complexes) -> float:
    """The least distance from a space to a goal that is turned: from the greatest eigenvalue, as is published."""
    columns = [np.column_stack((w.real, w.imag)).ravel() for w in (goal, 1j * goal)]
    taken = np.column_stack([basis.T @ column for column in columns])
    return float(np.sum(np.abs(goal) ** 2) - np.linalg.eigvalsh(taken.T @ taken)[-1])


def blob(rng: np.random.Generator, count: int) -> Complexes:
    """Points of a smooth closed curve, counter-clockwise."""
    t = np.arange(count) / count * 2 * np.pi
    radius = 1 + sum(rng.uniform(-0.25, 0.25) / k * np.cos(k * t + rng.uniform(0, 6)) for k in range(2, 7))
    return np.asarray(radius * np.exp(1j * t))


def drawn(name: str, rng: np.random.Generator, numbers: Ints) -> Complexes:
    """A tile of a type that does not cross itself: a blob's projection into the space."""
    basis = space(name, numbers)
    for _ in range(200):
        goal = blob(rng, len(basis) // 2) * cmath.exp(1j * rng.uniform(0, 6))
        near = basis @ (basis.T @ np.column_stack((goal.real, goal.imag)).ravel())
        tile = near[::2] + 1j * near[1::2]
        if shapely.Polygon(near.reshape(-1, 2)).is_valid and np.abs(np.diff(tile)).min() > 1e-3:
            return np.asarray(tile)
    raise AssertionError("no tile was drawn")


@each_type
def test_the_distance_is_the_eigenvalue_problem_s(name: str) -> None:
    """Of the tile that is given and as it is computed, for any numbers, from any point on; no distance of another."""
    rng = np.random.default_rng(1)
    for _ in range(4):
        numbers = numbers_of(name, rng, 36)
        goal = Goal(blob(rng, 36) * 7 + 3j)
        begin = int(rng.integers(36))
        right = by_eigenvalue(space(name, numbers), np.roll(goal.points, -begin))
        found = nearest_tiles.distances(TEMPLATE[name], goal, numbers[None], np.array([begin]))[0]
        tile = nearest_tiles.tile_of(TEMPLATE[name], goal, numbers, begin)
        assert found == pytest.approx(right, rel=1e-9)
        assert tile.left == pytest.approx(right, rel=1e-9)
        assert np.sum(np.abs(tile.points - goal.points) ** 2) == pytest.approx(right, rel=1e-9)
        other = nearest_tiles.distances(TEMPLATE[name], goal, numbers[None], np.array([(begin + 1) % 36]))[0]
        assert other != pytest.approx(right, rel=1e-3)


@each_type
def test_numbers_are_all_there_are(name: str) -> None:
    """Each sums up to the polygon's points, none is missing and none comes twice; nor do changes of them."""
    template = TEMPLATE[name]
    count = len(template.pairings)
    found = template.numbers(14)
    grid = np.stack(np.meshgrid(*[np.arange(1, 14)] * count, indexing="ij"), axis=-1).reshape(-1, count)
    right = grid[grid @ template.multiplicity == 14]
    assert {tuple(row) for row in found.tolist()} == {tuple(row) for row in right.tolist()}
    assert len(found) == len(right)
    assert (template.moves[:, :-1] @ template.multiplicity == 0).all()
    assert len(template.numbers(2)) == 0


@each_type
def test_an_exact_tile_is_found_back(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Turned, moved, scaled, from another of its points on: to rounding, in its own type, though not only there."""
    rng = np.random.default_rng(2)
    numbers = 4 * numbers_of(name, rng, 30)
    tile = drawn(name, rng, numbers)
    goal = np.roll(5 * cmath.exp(1j) * tile + 30 - 7j, 8)
    monkeypatch.setattr(nearest_tiles, "TEMPLATES", {name: TEMPLATES[name]})
    found = next(iter(nearest_tiles.nearest_tiles([goal[::4], goal[::2], goal], 1)))
    size = np.abs(goal - goal.mean()).max()
    assert found.left < (1e-10 * size) ** 2
    assert np.abs(found.points + goal.mean() - goal).max() < 1e-10 * size
    off = goal + 0.01 * size * np.exp(1j * rng.uniform(0, 6, len(goal)))
    assert next(iter(nearest_tiles.nearest_tiles([off[::4], off[::2], off], 1))).left > 1e-3 * size**2


def copies(tile: Tile) -> list[Complexes]:
    """The tile, and what three maps onto neighbours make of it, each once."""

    def after(
        one: tuple[complex, complex, bool], other: tuple[complex, complex, bool]
    ) -> tuple[complex, complex, bool]:
        (a, b, c), (d, e, f) = one, other
        return a * (d.conjugate() if c else d), a * (e.conjugate() if c else e) + b, c != f

    def inverse(one: tuple[complex, complex, bool]) -> tuple[complex, complex, bool]:
        a, b, c = one
        return (a, -a * b.conjugate(), True) if c else (1 / a, -b / a, False)

    steps = [*tile.maps, *map(inverse, tile.maps)]
    words: dict[tuple[float, ...], tuple[complex, complex, bool]] = {(0.0, 0.0, 1.0, 0.0, False): (1 + 0j, 0j, False)}
    for _ in range(3):
        for word in list(words.values()):
            for by in steps:
                new = after(by, word)
                key = (*(round(x, 6) + 0.0 for z in new[:2][::-1] for x in (z.real, z.imag)), new[2])
                words.setdefault(key, new)
    return [a * (tile.points.conj() if c else tile.points) + b for a, b, c in words.values()]


@each_type
def test_what_is_found_is_a_tile(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its copies cover a region around it once; those of the goal itself do not."""
    rng = np.random.default_rng(3)
    monkeypatch.setattr(nearest_tiles, "TEMPLATES", {name: TEMPLATES[name]})
    tile = None
    while tile is None:
        goal = blob(rng, 60)
        for found in nearest_tiles.nearest_tiles([goal[::2], goal], 20):
            if shapely.Polygon(np.column_stack((found.points.real, found.points.imag))).is_valid:
                tile = found
                break
    around = shapely.Polygon(np.column_stack((tile.points.real, tile.points.imag))).buffer(0.15)

    def covered(points: Complexes) -> tuple[float, float]:
        shapes = [
            shapely.Polygon(np.column_stack((z.real, z.imag))).intersection(around)
            for z in copies(tile._replace(points=points))
        ]
        return sum(shape.area for shape in shapes) / around.area, shapely.union_all(shapes).area / around.area

    assert covered(tile.points) == pytest.approx((1.0, 1.0), abs=1e-9)
    assert covered(goal - goal.mean()) != pytest.approx((1.0, 1.0), abs=1e-3)


# --- the bench ---------------------------------------------------------------------------------------------------

ICON = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 24 24"><path d="M2 2 H22 V10 L12 16 L2 14 Z
M5 5 V9 H9 V5 Z M1 20 H3 V22 H1 Z"/></svg>"""


def test_an_icon_s_outline_is_that_of_its_largest_part(tmp_path: Path) -> None:
    """Without its holes, counter-clockwise, in millimetres."""
    (tmp_path / "a.svg").write_text(ICON, encoding="utf-8")
    outline = escherization.outline_of(tmp_path / "a.svg")
    ring = shapely.LinearRing(escherization.xy(outline))
    assert ring.is_ccw
    low_x, low_y, high_x, high_y = ring.bounds
    scale = 60 / 21  # of the whole icon, the small part too
    assert high_x - low_x == pytest.approx(20 * scale)
    assert high_y - low_y == pytest.approx(14 * scale)


def test_tiles_are_placed_for_the_overlap() -> None:
    """One that is moved, turned and a little too small comes back; an overlap is 1 for the same alone."""
    shape = 20 * blob(np.random.default_rng(4), 80)
    goal = shapely.Polygon(escherization.xy(shape))
    found, share = escherization.best_placed(shape * 0.97 * cmath.exp(0.03j) + 0.5 - 0.3j, goal)
    assert share > 0.995
    assert np.abs(found - shape).max() < 0.2
    assert escherization.overlap(goal, goal) == 1.0
    assert escherization.overlap(goal, shapely.box(0, 0, 1, 1)) == pytest.approx(1 / goal.area)


def test_both_are_in_the_tables(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The icon by its name with both overlaps, and a drawing of the peer's tile; medians of those that are listed."""
    (tmp_path / "cat.svg").write_text(ICON, encoding="utf-8")
    monkeypatch.setattr(
        vt, "fit", lambda _outline, keep: [SimpleNamespace(group="p4", overlap=0.875)] * keep, raising=False
    )
    monkeypatch.setattr(nearest_tiles, "TEMPLATES", {"IH7": TEMPLATES["IH7"]})
    escherization.report(["cat"], tmp_path, tmp_path / "pictures")
    rows = [line.split(" | ") for line in capsys.readouterr().out.splitlines() if "| cat" in line or "animals" in line]
    assert rows[0][:2] == ["| animals, 1", "0.875"]
    assert rows[1][:3] == ["| cat", "p4", "0.875"]
    assert rows[1][4] == "IH7"
    assert 0.5 < float(rows[1][5]) < 1.0
    assert rows[0][2] == rows[1][5]
    assert (tmp_path / "pictures" / "cat.svg").read_text(encoding="utf-8").count("polygon") == 2


def test_all_icons_are_listed_once() -> None:
    """Fifty at least, animals and objects."""
    names = [*escherization.ANIMALS, *escherization.OBJECTS]
    assert len(names) == len(set(names)) >= 50
    assert min(len(escherization.ANIMALS), len(escherization.OBJECTS)) >= 25
