"""What docs/generate measures for docs/paper.md: endless lines, shapes, chambers, and the verdicts on sentences."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers.outlines import CommandLine
from shapely import Polygon
from test_gallery import OTHER_PIXELS, anew

import voronoi_tiles as vt
from voronoi_tiles.groups.wallpaper import GROUPS

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs" / "generate"))

import census as measuring  # noqa: E402
import paper  # noqa: E402 - a script of the documentation, in no package
from census import Census, Measured, census  # noqa: E402
from chambers import chamber_about, chamber_numbers  # noqa: E402
from claims import (  # noqa: E402
    CLAIMS,
    WRONG,
    curved,
    endless_lines_always,
    fills_chamber,
    fills_the_plane,
    fixed_polygon,
    outcome,
    table,
    verdicts,
)
from random_sites import CELLS, random_design  # noqa: E402
from running import Command  # noqa: E402
from shapes import Shape, congruent  # noqa: E402
from straight_lines import endless_lines, mirror_lines, same_line  # noqa: E402

FREE = ("p1", "p2", "pg", "pgg", "p4", "p3", "p6")


def tiling_of(group: str, strokes: Sequence[object], **cell: float) -> vt.Tiling:
    """The tiles of one site."""
    design = {"schema": 1, "group": group, "cell": cell, "site": [{"strokes": strokes}]}
    return vt.Design.from_dict(design).tessellate()


def random_tiling(group: str, seed: int) -> vt.Tiling:
    """The tiles of a random site whose copies keep apart."""
    rng = np.random.default_rng(seed)
    while True:
        try:
            return vt.Design.from_dict(random_design(group, seed, rng)).tessellate()
        except vt.TouchingCopiesError:
            continue


def lines_of(tiling: vt.Tiling) -> set[tuple[tuple[int, int], float]]:
    """The endless lines, offsets rounded."""
    return {(line.direction, round(line.offset, 6) % 1) for line in endless_lines(tiling)}


def test_endless_lines_of_points() -> None:
    """A grid of rectangles has two lines, or one for each column of a cell; hexagons none, diamonds two diagonals."""
    point = [{"point": [3, 4]}]
    assert lines_of(tiling_of("p1", point, a=30, b=20, angle=90)) == {((1, 0), 0.3), ((0, 1), 0.6)}
    assert lines_of(tiling_of("p1", point, a=30, b=20, angle=75)) == set()
    columns = {"schema": 1, "group": "p1", "cell": {"a": 40, "b": 20, "angle": 90}}
    sites = [{"name": name, "strokes": [{"point": place}]} for name, place in (("u", [10, 10]), ("v", [30, 10]))]
    assert lines_of(vt.Design.from_dict({**columns, "site": sites}).tessellate()) == {
        ((1, 0), 0.0),
        ((0, 1), 0.0),
        ((0, 1), 0.5),
    }
    diamonds = [{"name": name, "strokes": [{"point": place}]} for name, place in (("u", [0, 0]), ("v", [20, 20]))]
    square = {"schema": 1, "group": "p1", "cell": {"a": 40, "b": 40, "angle": 90}}
    assert lines_of(vt.Design.from_dict({**square, "site": diamonds}).tessellate()) == {((1, 1), 0.5), ((1, -1), 0.5)}


def test_an_endless_line_that_is_broken_is_none() -> None:
    """With one edge a little shorter the line is not covered; with a wrong offset it is no mirror."""
    tiling = tiling_of("pm", [{"segment": [[5, 3], [20, 11]]}], a=60, b=44)
    assert all(any(same_line(line, mirror) for line in endless_lines(tiling)) for mirror in mirror_lines(GROUPS["pm"]))
    tile = tiling.tiles[0]
    edge = int(np.argmax(np.where(tile.outline.curved, 0.0, tile.outline.lengths)))
    end = tile.outline.end.copy()
    end[edge] = 0.9 * end[edge] + 0.1 * tile.outline.start[edge]
    broken = replace(tile, outline=replace(tile.outline, end=end))
    assert len(endless_lines(replace(tiling, tiles=(broken,)))) == 1
    line = endless_lines(tiling)[0]
    assert same_line(line, line._replace(offset=line.offset - 1))
    assert not same_line(line, line._replace(offset=line.offset + 0.01))


@pytest.mark.parametrize("group", list(GROUPS))
def test_shapes_are_known_again(group: str) -> None:
    """A tile is congruent with itself moved and turned, its mirror image with the mirrored copy; not when changed."""
    tiling = random_tiling(group, 3)
    outline = tiling.tiles[0].outline
    shape = Shape.of(outline)
    turn = np.exp(0.7j)
    start, control, end = (turn * points + (31 - 12j) for points in shape[:3])
    moved = Shape(start, control, end, shape.curved)
    assert congruent(shape, moved)
    assert congruent(shape.mirrored, moved.mirrored)
    for operation in GROUPS[group].operations:
        copy = Shape.of(tiling.tiles[0].copy(operation))
        assert congruent(copy, shape if operation.determinant > 0 else shape.mirrored)
    start = shape.start.copy()
    start[0] += 1e-6
    assert not congruent(shape, shape._replace(start=start))


def test_mirror_images_differ_unless_the_shape_is_symmetric() -> None:
    """The tile of a crane is no mirror image of itself; a rectangle, and a triangle of 45 degrees, are."""
    for name, same in (("pgg-crane", False), ("p4-hook", False)):
        shape = Shape.of(vt.Design.load(ROOT / f"examples/{name}.toml").tessellate().tiles[0].outline)
        assert congruent(shape, shape.mirrored) == same
    for group in ("pmm", "p4m", "p3m1", "p6m"):
        rng = np.random.default_rng(1)
        while True:
            try:
                design = vt.Design.from_dict(random_design(group, 0, rng))
                shape = Shape.of(design.tessellate().tiles[0].outline)
                break
            except vt.TouchingCopiesError:
                continue
        assert congruent(shape, shape.mirrored) == (group != "p6m")


def test_chambers() -> None:
    """Names, areas and numbers of tiles as the mirrors of the International Tables make them."""
    expected = {
        "pm": ("strip", None), "cm": ("strip", None), "pmg": ("strip", None),
        "pmm": ("rectangle", 4), "cmm": ("rectangle", 4), "p4g": ("square", 2), "p4m": ("45-45-90 triangle", 8),
        "p31m": ("equilateral triangle", 2), "p3m1": ("equilateral triangle", 6), "p6m": ("30-60-90 triangle", 12),
    }  # fmt: skip
    for group, row in GROUPS.items():
        cell = CELLS[row.system]
        lattice = row.lattice(cell["a"], cell.get("b"), cell.get("angle"))
        point = lattice.cartesian(0.031, 0.017)
        chamber = chamber_about(row, lattice, point)
        name, parts = expected.get(group, ("plane", None))
        assert chamber.name == name
        if parts is not None:
            assert chamber.area == pytest.approx(lattice.det / parts, rel=1e-12)
            polygon = Polygon(np.column_stack((chamber.corners.real, chamber.corners.imag)))
            assert polygon.area == pytest.approx(chamber.area)
            assert chamber.beyond(np.array([point])) < 0
            far = chamber.corners[0] * 2 - point
            assert chamber.beyond(np.array([far])) > 0
            numbers = chamber_numbers(row, lattice, np.array([point, polygon_middle(chamber.corners), far]))
            assert (numbers[0] == numbers[1]).all()
            assert (numbers[0] != numbers[2]).any()
    square = GROUPS["cmm"].lattice(60.0, 60.0)
    assert chamber_about(GROUPS["cmm"], square, 3 + 2j).name == "square"


def polygon_middle(corners: np.ndarray) -> complex:
    """The mean of some corners."""
    return complex(corners.mean())


@pytest.mark.parametrize("group", list(GROUPS))
def test_a_small_census(group: str) -> None:
    """Eight sites a group: mirrors are edges throughout, and nothing else is for every site; chambers are kept to."""
    found = census(group, 8)
    assert len(found.tiles) == 8
    assert found.unproved == 0
    assert found.strangers == 0
    assert not found.values("mirrors_missing").any()
    assert found.values("beyond").max() < 1e-12
    assert found.values("area_error").max() < 1e-12
    assert (found.mirrors > 0) == (group not in FREE)
    assert found.shapes == (1 if group in ("pmm", "p4m", "p3m1", "p6m") else 8)
    wrong = {(claim.key, group) for claim, verdict in verdicts(found) if not verdict.holds}
    assert wrong == ({("endless", "pgg")} if group == "pgg" else {("squares", "cmm")} if group == "cmm" else set())
    if group == "pgg":
        assert curved(found).holds
    assert group in table([found], {})


def test_the_verdicts_can_be_otherwise() -> None:
    """Each judge says no where one tile of eight is otherwise; squares hold in cmm where a = b."""
    found = census("p4m", 8)
    tile = found.tiles[3]

    def with_tile(**changed: Any) -> Census:
        return replace(found, tiles=[*found.tiles[:3], replace(tile, **changed), *found.tiles[4:]])

    assert fixed_polygon(found).holds
    assert not fixed_polygon(with_tile(curves=1)).holds
    assert not fixed_polygon(replace(found, shapes=2)).holds
    assert not fixed_polygon(with_tile(beyond=1e-9)).holds
    assert fills_chamber(found)
    assert not fills_chamber(with_tile(filling=1.001))
    assert fills_the_plane(found).holds
    assert not fills_the_plane(with_tile(area_error=1e-9)).holds
    assert endless_lines_always(found).holds
    assert not endless_lines_always(with_tile(endless=0)).holds
    assert not endless_lines_always(with_tile(mirrors_missing=1)).holds
    free = census("p2", 8)
    assert curved(free).holds
    assert not curved(replace(free, survived=1)).holds
    assert not curved(replace(free, tiles=[replace(free.tiles[0], endless=1)] * 8)).holds


def test_cmm_makes_squares_where_the_sides_are_equal() -> None:
    """And rectangles else; where the cell with a = b does not give squares either, the sentence is wrong."""
    squares = next(claim for claim in CLAIMS if claim.key == "squares")
    found, even = census("cmm", 4), census("cmm", 4, measuring.EVEN)
    assert outcome(squares, found, even) == "holds where a = b, else rectangles"
    assert "squares: holds where a = b, else rectangles" in table([found], {"cmm": even})
    assert outcome(squares, even, None) == "holds"
    broken = replace(even, tiles=[replace(even.tiles[0], beyond=1e-9), *even.tiles[1:]])
    for other in (None, found, broken):
        assert outcome(squares, found, other) == WRONG


def test_points_that_survive_are_seen_to_die() -> None:
    """In p4m the points on mirrors outlive every site; those of a group without mirrors do not outlive the second."""
    points = measuring._Points()
    points.see(random_tiling("p4", 1))
    points.see(random_tiling("p4", 2))
    assert points.counts()[0] < 4
    points.see(random_tiling("p4", 5))
    assert points.counts() == (0, 0, 0)


def test_pgg_has_no_mirror() -> None:
    """No reflection of pgg, with any translation of the lattice, has a fixed point: it moves along its line."""
    for operation in GROUPS["pgg"].operations:
        if operation.determinant > 0:
            continue
        along = 1 if operation.linear[0] == -1 else 0
        assert operation.linear in {(-1, 0, 0, 1), (1, 0, 0, -1)}
        assert operation.translation[along] % 1 == Fraction(1, 2)


@pytest.mark.parametrize(
    ("name", "lines", "curves"),
    [("pgg-grid", 4, False), ("pm-on-mirrors", 0, True), ("p4m-scattered", 6, True), ("p4m-two-sites", 6, True)],
)
def test_the_designs_against_the_word_always(name: str, lines: int, curves: bool) -> None:
    """Each shows what its comment says."""
    tiling = vt.Design.load(ROOT / f"examples/paper/claim-{name}.toml").tessellate()
    assert len(endless_lines(tiling)) == lines
    assert any(tile.outline.curved.any() for tile in tiling.tiles) == curves


@pytest.mark.parametrize(
    ("point", "lines"),
    [
        ((15, 0), {(1, 0), (0, 1)}),
        ((16, 0), {(0, 1)}),
        ((15, 0.5), set()),
        ((15, 1), set()),
        ((14, 2), set()),
    ],
)
def test_a_move_in_y_ends_the_lines_of_the_grid(point: tuple[float, float], lines: set[tuple[int, int]]) -> None:
    """In pgg; a move along y = 0 keeps those along b, on x = 0 and x = a/2."""
    found = endless_lines(tiling_of("pgg", [{"point": list(point)}], a=60, b=44))
    assert {line.direction for line in found} == lines
    across = sorted(round(line.offset, 6) % 1 for line in found if line.direction == (0, 1))
    assert across == pytest.approx([0.0, 0.5] if lines else [])


def test_a_measured_tile_has_all_figures() -> None:
    """No figure of a tile is left at a default."""
    assert not any(field.default is not field.default_factory for field in Measured.__dataclass_fields__.values())
    for group, between in (("p4", "no mirrors"), ("pm", "strip, not bounded"), ("p4g", "square, 4 tiles in each")):
        text = measuring.describe(census(group, 2))
        assert re.match(rf"{group}\n  sites: 2; ", text)
        assert f"\n  between mirrors: {between}\n" in text


def test_the_page_is_written_from_the_measurements() -> None:
    """Other measurements give another page, with other verdicts; a group that is not measured is an error."""
    rows = [census(group, 2) for group in GROUPS]
    even = census("cmm", 2, measuring.EVEN)
    text = paper.page(rows, even, [True, True])
    assert "$" not in text
    assert "agree in all," in text
    assert "**wrong for pgg**" in text
    assert "none of 2 random tilings" in text
    assert "for cmm it holds where a = b, else rectangles |" in text
    assert "cmm: 2 tiles form one rectangle in all 2 tilings<br>cmm with a = b: 2 tiles form one square in all" in text
    flat = next(row for row in rows if row.group == "p4")
    flat.tiles[0] = replace(flat.tiles[0], curves=0)
    uncurved = sum(tile.curves == 0 for row in rows if row.group in set(FREE) - {"pgg"} for tile in row.tiles)
    assert f"{uncurved} of 12 have curves" in " ".join(paper.page(rows, even, [True]).split())
    assert "**wrong for cmm**" in paper.page(rows, next(row for row in rows if row.group == "cmm"), [True])
    pgg = next(row for row in rows if row.group == "pgg")
    pgg.tiles[:] = [replace(tile, endless=1) for tile in pgg.tiles]
    other = paper.page(rows, even, [True, False])
    assert "**wrong for pgg**" not in other
    assert "agree in only 1," in other
    with pytest.raises(ValueError, match="pgg"):
        paper.page([row for row in rows if row.group != "pgg"], even, [True])


def case(command: Command) -> Any:
    """A command as a parameter; a picture in perspective takes seconds."""
    slow = command.program[0] != "voronoi-tiles"
    return pytest.param(command, id=Path(command.output).name, marks=[pytest.mark.slow] if slow else [])


@pytest.mark.parametrize("command", [case(command) for command in paper.commands()])
def test_pictures_made_anew_are_the_same(command: Command, tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """The committed file is what its command writes; versions of matplotlib differ a little."""
    assert anew(command, tmp_path, voronoi_tiles) <= OTHER_PIXELS


def test_the_page_is_there() -> None:
    """docs/paper.md has 17 rows of a thousand sites, all sentences and figures, and no picture that is not there."""
    text = (ROOT / "docs/paper.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (p\w+|c\w+) \| [\d ]", text, re.MULTILINE)
    assert rows == list(GROUPS)
    assert "17,000 tilings" in text
    for claim in CLAIMS:
        assert claim.sentence in text
    assert all(f"### Figure {number}" in text for number in range(1, 10))
    assert all(command.shown in text for command in paper.commands())
    pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", text)
    assert len(pictures) > 40
    assert all((ROOT / "docs" / picture).is_file() for picture in pictures)
