"""The cells of all elements: against plain distances to every copy, and the compiled kernel against numpy."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import pytest
from helpers import fuzz
from helpers.examples import EXAMPLES, path_of
from numpy.typing import NDArray

from voronoi_tiles.base import kernels
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.starters import starter
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.vector.cells import cells
from voronoi_tiles.vector.cells.bisectors import TouchingElementsError
from voronoi_tiles.vector.cells.cells import Parts, UnboundedCellError, bound_cells
from voronoi_tiles.vector.cells.half_edges import Contour, trace_contour
from voronoi_tiles.vector.cells.pencils import Rows, make_rows
from voronoi_tiles.vector.copies import Copies, bundles, copies_near, place
from voronoi_tiles.vector.motions import Action

Complexes = NDArray[np.complex128]
Floats = NDArray[np.float64]
Ints = NDArray[np.intp]


@dataclass(frozen=True)
class Case:
    """What `bound_cells` takes."""

    rows: Rows
    contour: Contour
    copies: Copies
    node_bundle: Ints
    covering_radius: float

    @property
    def parts(self) -> Parts:
        """What it gives."""
        return bound_cells(self.rows, self.contour, self.copies, self.node_bundle, self.covering_radius)


def case(design: Design) -> Case:
    """The rows of all half-edges and corners of a design's sites."""
    action = Action(design.group, design.lattice)
    placed, union = place(action, design.noded)
    node_bundle = bundles(placed)[union.node_site]
    contour = trace_contour(union.nodes, union.segments)
    rows = make_rows(contour, action.covering_radius, np.zeros(len(contour.source), bool))
    return Case(
        rows, contour, copies_near(action, placed, union.nodes, node_bundle), node_bundle, action.covering_radius
    )


def drawn(group: str, cell: tuple[float, float], *sites: list[dict[str, Any]]) -> Design:
    """A design of sites with these strokes; cells are rectangular."""
    a, b = cell
    size = {"a": a, "b": b, "angle": 90.0} if group in ("p1", "p2") else {"a": a} if a == b else {"a": a, "b": b}
    named = [{"name": f"s{k}", "strokes": strokes} for k, strokes in enumerate(sites)]
    return Design.from_dict({"schema": 1, "group": group, "cell": size, "site": named})


def zigzag(count: int) -> Design:
    """Long strokes side by side: slivers of cells between them, which reach as far as the next copy."""
    points = [[5 + 50 * k / count, 5 if k % 2 == 0 else 45] for k in range(count + 1)]
    return drawn("p1", (60.0, 60.0), [{"polyline": points}])


def scattered(count: int) -> Design:
    """Points, each a site."""
    places = np.random.default_rng(count).uniform(0, 30, (count, 2)).tolist()
    return drawn("p4", (60.0, 60.0), *([{"point": at}] for at in places))


def spiral(count: int) -> Design:
    """A fine curve."""
    t = np.linspace(0.0, 5.0, count + 1)
    points = np.stack((15 + (2 + 2 * t) * np.cos(2 * t), 15 + (2 + 2 * t) * np.sin(2 * t)), axis=1)
    return drawn("p2", (80.0, 70.0), [{"polyline": points.tolist()}])


def beside(gap: float) -> Design:
    """A stroke that nearly touches its own images in two mirrors, a point near it and one near a mirror."""
    stroke = {"polyline": [[gap, 3.0], [20.0, 12.0], [12.0, gap]]}
    return drawn("pmm", (60.0, 50.0), [stroke], [{"point": [20.0, 12.0 + gap]}], [{"point": [28.0, 25.0 - gap]}])


def hardly_apart() -> Design:
    """Two points so near to each other that rounding would turn the line through their images."""
    places = [[49.48681022747338, 34.8566672422334], [49.486810283309666, 34.8566672422334]]
    cell = {"a": 60.0, "b": 60.0, "angle": 60.0}
    strokes = [{"point": at} for at in places]
    return Design.from_dict({"schema": 1, "group": "p1", "cell": cell, "site": [{"strokes": strokes}]})


def in_starter(group: str) -> Case:
    """The starter of a group."""
    return case(starter(group))


CASES: dict[str, Callable[[], Case]] = {
    "zigzag": lambda: case(zigzag(150)),
    "points": lambda: case(scattered(60)),
    "spiral": lambda: case(spiral(400)),
    "thin": lambda: case(drawn("p1", (600.0, 1.0), [{"segment": [[3.0, 0.4], [9.0, 0.6]]}])),
    "long": lambda: case(drawn("p1", (600.0, 9.0), [{"segment": [[3.0, 0.4], [590.0, 5.6]]}])),
    "point": lambda: case(drawn("p4", (10.0, 10.0), [{"point": [1.0, 2.0]}])),
    "hardly-apart": lambda: case(hardly_apart()),
    "near": lambda: case(beside(1e-7)),
    "nearer": lambda: case(beside(1e-11)),
    **{f"starter-{group}": partial(in_starter, group) for group in GROUPS},
}


def distances(case: Case, points: Complexes, row: Ints) -> tuple[Floats, Floats]:
    """The distances of points from the elements of their rows, and from the nearest of all others, of all copies."""
    contour, copies = case.contour, case.copies
    lone = contour.corner_node[len(contour.source) :: 4]
    source, target = np.append(contour.source[::2], lone), np.append(contour.target[::2], lone)
    rows = case.rows
    half_edge, corner = rows.half_edge[row], rows.corner[row]
    node = np.where(corner >= 0, contour.corner_node[corner], -1)
    own = np.full(len(points), np.inf)
    others = np.full(len(points), np.inf)
    for k in range(len(copies)):
        for element in np.flatnonzero(case.node_bundle[source] == copies.bundle[k]).tolist():
            ends = contour.nodes[[source[element], target[element]]]
            start, end = copies.unit[k] * (ends.conj() if copies.conj[k] else ends) + copies.shift[k]
            chord = end - start
            t = np.clip(((points - start) * chord.conjugate()).real / (abs(chord) ** 2 or 1.0), 0.0, 1.0)
            distance = np.abs(points - start - t * chord)
            mine = np.zeros(len(points), bool)
            if k < copies.bundles:
                mine = np.where(
                    corner < 0, half_edge >> 1 == element, (source[element] == node) | (target[element] == node)
                )
                own = np.where(mine, np.minimum(own, distance), own)
            others = np.where(mine, others, np.minimum(others, distance))
    return own, others


@pytest.mark.parametrize(
    "name", ["zigzag", "points", "spiral", "thin", "long", "point", "near", "hardly-apart", "starter-p6m"]
)
def test_every_end_of_a_part_is_a_point_of_the_cell(name: str) -> None:
    """It is as far from the row's element as from the nearest of all others."""
    made = CASES[name]()
    parts = made.parts
    some = np.unique(np.linspace(0, len(parts.row) - 1, 400).astype(int))
    points, row = np.concatenate((parts.begin[some], parts.end[some])), np.tile(parts.row[some], 2)
    own, others = distances(made, points, row)
    size = np.abs(made.contour.nodes).max() + made.covering_radius
    assert np.abs(own - others).max() <= 1e-11 * size


@pytest.mark.parametrize("name", CASES)
@pytest.mark.usefixtures("compiled")
def test_kernel_gives_the_bits_of_numpy(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same parts, in the same order."""
    same_bits(CASES[name](), monkeypatch)


@pytest.mark.parametrize("name", ["points", "spiral"])
@pytest.mark.usefixtures("compiled")
def test_kernel_that_runs_out_of_room_goes_on(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """However little room it is given, less than one row takes included, the parts are the same."""
    monkeypatch.setattr(cells, "_PER_ROW", 0)
    monkeypatch.setattr(cells, "_ROOM", 1)
    same_bits(CASES[name](), monkeypatch)


@pytest.mark.usefixtures("compiled")
def test_threads_do_not_disturb_each_other() -> None:
    """The kernel runs without Python's lock: in four threads at once every case gives the bits that it gives alone."""

    def bits(made: Case) -> list[bytes]:
        return [getattr(made.parts, name).tobytes() for name in Parts.__slots__]

    made = [CASES[name]() for name in ("zigzag", "points", "spiral", "thin", "long", "starter-p6m")]
    alone = [bits(one) for one in made]
    with ThreadPoolExecutor(4) as pool:
        assert [*pool.map(bits, made * 5)] == alone * 5


@pytest.mark.slow
@pytest.mark.parametrize("name", EXAMPLES)
@pytest.mark.usefixtures("compiled")
def test_kernel_gives_the_bits_of_numpy_for_examples(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of every example, the first site's cells among the copies of all."""
    same_bits(case(Design.load(path_of(name))), monkeypatch)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(300))
@pytest.mark.usefixtures("compiled")
def test_kernel_gives_the_bits_of_numpy_for_any_design(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Fuzzed designs of all kinds, near ones included."""
    _, design = fuzz.design_of(2027, number)
    same_bits(case(Design.from_dict(design)), monkeypatch)


def same_bits(case: Case, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both paths give the same bits, or refuse the same."""
    assert kernels.library() is not None
    results: list[list[Any]] = []
    for chosen in ("", "numpy"):
        monkeypatch.setenv("VORONOI_TILES_KERNELS", chosen)
        try:
            parts = case.parts
        except (TouchingElementsError, UnboundedCellError):
            results.append(["refused"])
        else:
            results.append([getattr(parts, name).tobytes() for name in Parts.__slots__])
    assert results[0] == results[1]
