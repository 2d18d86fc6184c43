"""Sheets that are drawn: what loose lines and arcs bound, and what is said of the drawing they come from."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
import shapely
from helpers import sheets as shapes
from helpers.dxf_text import written
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles import Job
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.job import JobError
from voronoi_tiles.fabrication.sheet_outline import MEETING, SheetOutline, sheet_outline
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.tiling import Tiling

SQUARES = """
schema = 1
group = "p1"
[cell]
a = 8.0
b = 8.0
angle = 90
[[site]]
strokes = [{ polyline = [[4, 2], [4, 3]] }]
"""


@pytest.fixture(scope="module")
def tiles() -> Tiling:
    """Tiles of 8 x 8 mm or so."""
    return Design.loads(SQUARES).tessellate()


def svg(path: Path, body: str, size: str = 'width="100mm" height="100mm"') -> str:
    """Write an SVG file."""
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="0 0 100 100"><g stroke="red">{body}</g></svg>'
    )
    return str(path)


def dxf(path: Path, draw: Any, units: int = 4) -> str:
    """Write a DXF file of what a function draws."""
    document = ezdxf.new("R2000", units=units)
    draw(document.modelspace())
    path.write_text(written(document))
    return str(path)


def lines(*points: tuple[float, float]) -> str:
    """A path for each line from point to point."""
    return "".join(f"<path d='M{a[0]} {a[1]}L{b[0]} {b[1]}'/>" for a, b in pairwise(points))


def area(product: Any) -> float:
    """The area that pieces fill; millimetres squared."""
    return float(product.pieces.area.sum())


SQUARE = ((10, 10), (90, 10), (90, 90), (10, 90), (10, 10))


@st.composite
def parted_rings(draw: Any) -> tuple[Paths, Paths]:
    """Disjoint rings of lines and arcs, and the same parted at corners, shuffled, turned about, ends moved a little."""
    rings = []
    for k in range(draw(st.integers(1, 4))):
        corners = draw(st.lists(st.floats(0.3, 1.0), min_size=3, max_size=8))
        angles = np.arange(len(corners)) * 2 * np.pi / len(corners)
        ring = Paths.polylines([100 * k + 20 * np.array(corners) * np.exp(1j * angles)], closed=True)
        bulge = draw(st.lists(st.sampled_from([0.0, 0.1, -0.1]), min_size=len(corners), max_size=len(corners)))
        chord = ring.end - ring.start
        control = ring.control.copy()
        control[:, 0] = np.where(bulge, (ring.start + ring.end) / 2 - 0.5j * chord * bulge, 0)
        kind = np.where(bulge, 3, 0).astype(np.uint8)
        rings.append(Paths(ring.start, ring.end, control, kind, ring.offsets, ring.closed))
    whole = Paths.concatenate(rings)
    parts = []
    for number in range(len(whole)):
        first, count = int(whole.offsets[number]), int(whole.counts[number])
        cuts = sorted(draw(st.sets(st.integers(0, count - 1), min_size=1, max_size=count)))
        for low, high in zip(cuts, [*cuts[1:], cuts[0] + count], strict=True):
            some = first + np.arange(low, high) % count
            parts.append(
                Paths(
                    whole.start[some],
                    whole.end[some],
                    whole.control[some],
                    whole.kind[some],
                    np.array([0, len(some)]),
                    np.zeros(1, np.bool_),
                )
            )
    order = draw(st.permutations(range(len(parts))))
    backwards = np.array(draw(st.lists(st.booleans(), min_size=len(parts), max_size=len(parts))))
    loose = Paths.concatenate([parts[k] for k in order]).reversed(backwards)
    shift = draw(st.sampled_from([0.0, 0.4 * MEETING]))
    end = loose.end.copy()
    end[loose.offsets[1:] - 1] += shift
    return whole, Paths(loose.start, end, loose.control, loose.kind, loose.offsets, loose.closed)


@settings(max_examples=60, deadline=None)
@given(parted_rings())
def test_rings_are_found_in_any_order_and_direction(drawn: tuple[Paths, Paths]) -> None:
    """As many as were parted, over the same area by shapely, closed to the bit; nothing is left."""
    whole, loose = drawn
    found = sheet_outline(loose)
    assert len(found.left) == len(found.forks) == 0
    assert len(found.rings) == len(whole)
    assert found.rings.closed.all()
    assert np.array_equal(found.rings.start[found.rings.offsets[:-1]], found.rings.end[found.rings.offsets[1:] - 1])
    for k in range(len(found.rings)):
        inner = slice(int(found.rings.offsets[k]), int(found.rings.offsets[k + 1]))
        assert np.array_equal(found.rings.start[inner][1:], found.rings.end[inner][:-1])
    union = [shapely.union_all([polygon(paths, k) for k in range(len(paths))]) for paths in (whole, found.rings)]
    assert union[0].symmetric_difference(union[1]).area < 0.05 * MEETING * 1000 + 1e-9


def polygon(paths: Paths, number: int) -> Any:
    """A ring as shapely's polygon."""
    points = shapes.flattened(paths.take(np.array([number])), 1e-4)[0]
    return shapely.Polygon(shapes.xy(points))


def test_four_lines_bound_a_sheet_as_one_path_does(tiles: Tiling, tmp_path: Path) -> None:
    """In SVG and in DXF, with a hole of two arcs, drawn anyhow."""
    edges = [SQUARE[k : k + 2] for k in range(4)]
    body = "".join(lines(*(edge if k % 2 else edge[::-1])) for k, edge in enumerate(edges))
    hole = "<path d='M40 50A10 10 0 0 0 60 50'/><path d='M40 50A10 10 0 0 1 60 50'/>"

    def draw(space: Any) -> None:
        for number in (2, 0, 3, 1):
            space.add_line(*edges[number][:: (-1) ** number])
        space.add_arc((50, 50), 10, 0, 180)
        space.add_arc((50, 50), 10, 180, 360)

    once = svg(tmp_path / "once.svg", "<path d='M10 10H90V90H10Z'/><circle cx='50' cy='50' r='10'/>")
    wanted = area(tiles.make(Job(sheet=once, fit="clip", edges="pieces")))
    for name in (svg(tmp_path / "s.svg", body + hole), dxf(tmp_path / "s.dxf", draw)):
        product = tiles.make(Job(sheet=name, fit="clip", edges="pieces", offset=0j))
        assert area(product) == pytest.approx(80 * 80 - 100 * np.pi, rel=2e-5)
        assert area(product) == pytest.approx(wanted, rel=2e-5)
        assert not any("left out" in note for note in product.notes)


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (lines(*SQUARE[:4]), r"no closed path: a line ends 80 mm from the nearest other end at \(10, (10|90)\) mm"),
        (lines(*SQUARE[:4], (10, 10.3)), r"no closed path: a line ends 0\.3 mm .* at \(10, 10(\.3)?\) mm"),
        (lines((5, 10), (95, 10)) + lines((90, 5), (90, 95)), r"run across each other .* at \(90, 10\) mm"),
        (lines(*SQUARE) + lines((10, 10), (50, 50)), r"three ends or more meet at \(10, 10\) mm"),
        (lines(*SQUARE) + lines((10, 90), (90, 90)), r"three ends or more meet at \(\d0, 90\) mm"),
        (lines(*SQUARE) + lines((90, 90), (10, 10)) + "<circle cx='50' cy='40' r='5'/>", "bounds no sheet: three ends"),
        ("<path d='M10 10h0'/>", "no closed path$"),
    ],
)
def test_loose_lines_that_bound_nothing_are_refused_with_the_place(
    tiles: Tiling, tmp_path: Path, body: str, message: str
) -> None:
    """Gaps, ends that run past each other, ends that meet three times: the place is as Inkscape shows it."""
    with pytest.raises(JobError) as caught:
        tiles.make(Job(sheet=svg(tmp_path / "s.svg", body)))
    assert re.search(message, caught.value.message)
    assert caught.value.remedy


def test_what_lies_on_a_sheet_is_left_out_and_said(tiles: Tiling, tmp_path: Path) -> None:
    """Open lines, forks within the outline, texts, dots and a guessed unit: each in a note, the sheet the same."""
    body = f"<path d='M10 10H90V90H10Z'/>{lines((30, 30), (50, 30), (50, 50), (30, 30))}{lines((30, 30), (20, 20))}"
    clean = tiles.make(Job(sheet=svg(tmp_path / "clean.svg", "<path d='M10 10H90V90H10Z'/>"), fit="clip"))
    assert not any("clean.svg" in note for note in clean.notes)
    name = svg(tmp_path / "s.svg", f"{body}<path d='M20 20z'/><text>a</text>", size='width="377.95" height="377.95"')
    product = tiles.make(Job(sheet=name, fit="clip"))
    said = [note.removeprefix(f"{name}: ") for note in product.notes if note.startswith(name)]
    assert [note.split(";")[0].split(",")[0] for note in said] == [
        "the page's size has no unit",
        "left out what is no path: text (1)",
        "left out 1 line of no length",
        "4 loose lines bound nothing and were left out",
    ]
    assert product.pieces.tile_area == pytest.approx(clean.pieces.tile_area, rel=1e-3)


def test_a_sheet_of_a_guessed_unit_says_so_or_is_refused(tiles: Tiling, tmp_path: Path) -> None:
    """DXF without a unit; where the size is senseless, the guess is the reason."""

    def draw(size: float) -> Any:
        return lambda space: space.add_lwpolyline([(0, 0), (size, 0), (size, size), (0, size)], close=True)

    product = tiles.make(Job(sheet=dxf(tmp_path / "s.dxf", draw(40), units=0), fit="clip"))
    assert f"{tmp_path / 's.dxf'}: the file declares no unit; millimetres were taken" in product.notes
    with pytest.raises(JobError, match="declares no unit; millimetres were taken"):
        tiles.make(Job(sheet=dxf(tmp_path / "s.dxf", draw(1e6), units=0), fit="clip"))


def test_the_property_sees_a_ring_that_is_missing() -> None:
    """Three sides of four are no ring, and all three are left."""
    found: SheetOutline = sheet_outline(Paths.polylines([[0j, 9 + 0j], [9 + 0j, 9 + 9j], [9 + 9j, 9j]]))
    assert (len(found.rings), len(found.left), len(found.forks)) == (0, 3, 0)
