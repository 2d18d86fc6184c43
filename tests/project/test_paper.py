"""What docs/generate measures for docs/paper.md: endless lines, shapes, chambers, and the verdicts on sentences."""

from __future__ import annotations

import colorsys
import re
import sys
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from helpers.outlines import CommandLine
from test_gallery import OTHER_PIXELS, anew

import voronoi_tiles as vt
from voronoi_tiles.groups.wallpaper import GROUPS

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs" / "generate"))

import census as measuring  # noqa: E402
import curves_in_steps  # noqa: E402
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
from curves_in_steps import KERF, STEPS, Apart, hausdorff  # noqa: E402
from random_sites import CELLS, random_design  # noqa: E402
from running import Command  # noqa: E402
from sentences import (  # noqa: E402
    Alike,
    Proved,
    Sentences,
    Tiled,
    alike,
    any_strokes,
    compared_with_a_point,
    difference,
    from_hsv,
    lab,
)
from shapes import Shape, congruent  # noqa: E402
from straight_lines import endless_lines, mirror_lines, same_line  # noqa: E402

OTHERS = Sentences(
    points={
        "pmm": [Tiled("a point", 660.0, 4, 0.0, 0.0), Tiled("a line", 660.0, 4, 0.0, 1e-12)],
        "cmm": [Tiled("a point", 330.0, 4, 0.0, 0.0), Tiled("a line", 330.0, 6, 0.3, 6.2)],
    },
    steps=[Apart(0, "p1", (2 * KERF, KERF / 2)), Apart(1, "p2", (KERF / 2, KERF / 4))],
    colours=Alike({"hue": 0.01, "all": 0.001}, 2.5, 30.0),
    strokes=[Proved("ring", 2, 2, 189, 3e-16)],
)
"""Figures of the sentences about no group, as they might have been measured."""

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
            polygon = shapely.Polygon(np.column_stack((chamber.corners.real, chamber.corners.imag)))
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


def test_censuses_are_the_same_in_other_processes() -> None:
    """Two processes measure what this one does, in the order of the groups."""
    groups = ("p4", "p2", "pgg")
    found = measuring.censuses(groups, 2, workers=2)
    assert [measuring.describe(each) for each in found] == [measuring.describe(census(group, 2)) for group in groups]


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
    text = paper.page(rows, even, [True, True], OTHERS)
    assert "$" not in text
    assert "agree in all," in text
    assert "**wrong for pgg**" in text
    assert "none of 2 random tilings" in text
    assert "for cmm it holds where a = b, else rectangles |" in text
    assert "cmm: 2 tiles form one rectangle in all 2 tilings<br>cmm with a = b: 2 tiles form one square in all" in text
    flat = next(row for row in rows if row.group == "p4")
    flat.tiles[0] = replace(flat.tiles[0], curves=0)
    uncurved = sum(tile.curves == 0 for row in rows if row.group in set(FREE) - {"pgg"} for tile in row.tiles)
    assert f"{uncurved} of 12 have curves" in " ".join(paper.page(rows, even, [True], OTHERS).split())
    assert "**wrong for cmm**" in paper.page(rows, next(row for row in rows if row.group == "cmm"), [True], OTHERS)
    pgg = next(row for row in rows if row.group == "pgg")
    pgg.tiles[:] = [replace(tile, endless=1) for tile in pgg.tiles]
    other = paper.page(rows, even, [True, False], OTHERS)
    assert "**wrong for pgg**" not in other
    assert "agree in only 1," in other
    with pytest.raises(ValueError, match="pgg"):
        paper.page([row for row in rows if row.group != "pgg"], even, [True], OTHERS)


def test_sentences_about_no_group_are_judged() -> None:
    """Each verdict is the other one where what is measured is otherwise."""
    text = OTHERS.table()
    assert "**wrong for cmm**; for pmm it holds" in text
    assert "**wrong for 12 segments**; for 24 segments it holds" in text
    assert "**wrong** in a picture of 100 tiles" in text
    points = {"pmm": OTHERS.points["cmm"], "cmm": OTHERS.points["pmm"]}
    steps = [replace(row, distance=row.distance[::-1]) for row in OTHERS.steps]
    text = replace(OTHERS, points=points, steps=steps, colours=replace(OTHERS.colours, shares={"one": 1e-5})).table()
    assert "**wrong for pmm**; for cmm it holds" in text
    assert "**wrong for 24 segments**; for 12 segments it holds" in text
    assert "| Pseudo-random colours in HSV keep neighbours apart. | holds |" in text
    moved = [replace(row, curved=0.0) for row in points["pmm"]]
    assert not replace(OTHERS, points={"cmm": moved}).like_a_point("cmm")
    assert OTHERS.colours.spoilt(0.01) == pytest.approx(1 - 0.99**250)


def test_sites_beside_a_point() -> None:
    """In pmm all tiles are the rectangle of the mirrors; in cmm half of it, with curves but for the point's."""
    for group, area in (("pmm", 660.0), ("cmm", 330.0)):
        found = compared_with_a_point(group)
        assert [row.area for row in found] == pytest.approx([area] * 5, rel=1e-12)
        assert [row.curved > 0 for row in found] == [group == "cmm" and row.name != "a point" for row in found]
        assert all((row.apart > 1) == (row.curved > 0) for row in found)


def test_how_far_outlines_are_apart() -> None:
    """As shapely's own measure says, to what chords and spacing leave open; nothing for the same outline."""
    one, other = (random_tiling("p4", seed).tiles[0].outline for seed in (3, 6))
    rings = [outline.to_shapely(accuracy=1e-2).boundary for outline in (one, other)]
    far = shapely.hausdorff_distance(*(shapely.segmentize(ring, 0.5) for ring in rings))
    assert hausdorff(one, other) == pytest.approx(far, abs=0.3)
    assert hausdorff(one, one) < 1e-9
    rectangles = [tiling_of("p1", [{"point": [x, 4]}], a=30, b=20, angle=90).tiles[0].outline for x in (3, 5.5)]
    assert hausdorff(*rectangles) == pytest.approx(2.5, abs=1e-9)


def test_colours_and_their_differences() -> None:
    """HSV as the standard library has it; CIELAB of the primaries as tables do (B. Lindbloom)."""
    hsv = np.random.default_rng(1).random((50, 3))
    expected = [colorsys.hsv_to_rgb(*row) for row in hsv.tolist()]
    assert from_hsv(hsv) == pytest.approx(np.array(expected), abs=1e-12)
    tables = {
        (1, 0, 0): (53.2408, 80.0925, 67.2032),
        (0, 1, 0): (87.7347, -86.1827, 83.1793),
        (0, 0, 1): (32.2970, 79.1875, -107.8602),
        (1, 1, 1): (100, 0, 0),
        (0, 0, 0): (0, 0, 0),
    }
    assert lab(np.array(list(tables), float)) == pytest.approx(np.array(list(tables.values())), abs=2e-3)
    assert difference(np.ones((1, 3)), np.zeros((1, 3))) == pytest.approx(100)


@pytest.mark.slow
def test_the_page_has_what_is_measured() -> None:
    """The tables of the sentences about no group, made anew; of the random curves the worst ones."""
    text = (ROOT / "docs/paper.md").read_text(encoding="utf-8")
    points = {group: compared_with_a_point(group) for group in ("pmm", "cmm")}
    found = Sentences(points, OTHERS.steps, alike(), any_strokes())
    for part in (found.points_table(), found.colours_table(), found.strokes_table(), found.table()):
        assert part in text
    worst = re.findall(r"^\| (12|24) \| [\d.]+ \| [\d.]+ \| ([\d.]+) \(curve (\d+), (\w+)\) \|", text, re.MULTILINE)
    assert [int(steps) for steps, *_ in worst] == list(STEPS)
    for k, (_, distance, number, group) in enumerate(worst):
        row = curves_in_steps.measure(int(number))
        assert row.group == group
        assert f"{row.distance[k]:.3f}" == distance


def cases() -> list[Any]:
    """The commands as parameters: slow where a picture is in perspective, or not the first of its figure."""
    figures: set[str] = set()
    found = []
    for command in paper.commands():
        name = Path(command.output).name
        figure = name.partition("-")[0]
        slow = command.program[0] != "voronoi-tiles" or figure in figures
        figures.add(figure)
        found.append(pytest.param(command, id=name, marks=[pytest.mark.slow] if slow else []))
    return found


@pytest.mark.parametrize("command", cases())
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
