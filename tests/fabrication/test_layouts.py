"""Sheets filled with tiles: every line once, in the fewest trails; whole, clipped, framed; pulled apart; tabs."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import shapely
from helpers.cutting import (
    FINE,
    SQUARES,
    contour_shapes,
    cuts,
    dense,
    farthest,
    lines_of,
    made,
    odd_vertices,
    plane,
    squares,
    true_lengths,
    whole,
)
from helpers.examples import tiling
from helpers.sheets import check_apart, shape

from voronoi_tiles.base.text import counted
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_fields import Fit
from voronoi_tiles.fabrication.job_limits import FRAME_MM
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.fabrication.product import Product
from voronoi_tiles.paths.paths import LINE, Paths

DESIGNS = ["p4-hook", "pg-wave", "cmm-scroll", "pmm", "p31m"]
FITS = ["whole", "clip", "frame"]


def sheet_of(name: str, cells: float = 3.1) -> tuple[float, float]:
    """A sheet of some cells each way."""
    design = tiling(name).design
    side = cells * max(abs(design.lattice.a), abs(design.lattice.b)) * design.unit_mm
    return round(side, 2), round(0.8 * side, 2)


def split_closed(paths: Paths) -> tuple[Paths, Paths]:
    """The open paths, and the closed ones."""
    return paths.take(np.flatnonzero(~paths.closed)), paths.take(np.flatnonzero(paths.closed))


def check_once(once: Paths, pieces: Paths, border: float) -> None:
    """The inner lines are half of what the pieces have beside the border, to 1e-9; none lies on another."""
    total, around = float(true_lengths(once).sum()), float(true_lengths(pieces).sum())
    wanted = (around - border) / 2 + border
    assert abs(total / wanted - 1) <= 1e-9, f"the lines are {total - wanted:.2e} mm too long"
    check_apart(once)


@pytest.mark.parametrize("fit", FITS)
@pytest.mark.parametrize("name", DESIGNS)
def test_every_line_is_cut_once_in_the_fewest_trails(name: str, fit: str) -> None:
    """Against the contours of the pieces, whose inner edges are cut twice; trails by the odd vertices."""
    size = sheet_of(name)
    once = cuts(made(name, sheet=size, fit=fit))
    product = made(name, sheet=size, fit=fit, edges="pieces")
    pieces = cuts(product)
    trails, rings = split_closed(once)
    border = 2 * sum(size) if fit != "whole" else float(true_lengths(rings).sum())
    check_once(once, pieces, border)
    _, least = odd_vertices(trails)
    assert len(trails) == least
    tiles = plane(name, *size)
    inside = whole(tiles, *size)
    if fit == "frame":  # whose frame has a width everywhere
        room = shapely.box(FRAME_MM, FRAME_MM, size[0] - FRAME_MM, size[1] - FRAME_MM)
        inside = [copy for copy in inside if room.covers(copy.shape)]
    assert int(product.pieces.whole.sum()) == len(inside)
    if fit == "whole":
        shapes = contour_shapes(pieces, 1e-3)
        assert len(shapes) == len(inside)
        around = shapely.union_all([shapely.set_precision(one, 1e-5) for one in shapes])
        assert border == pytest.approx(around.length, rel=1e-4)
        # The inner lines alone: half the tiles' own perimeters, which are exact, less what is around.
        unit = tiling(name).design.unit_mm
        perimeters = sum(tiling(name).tiles[copy.site].perimeter * unit for copy in inside)
        assert float(true_lengths(trails).sum()) == pytest.approx((perimeters - border) / 2, rel=1e-9)
    else:
        assert product.pieces.area.sum() == pytest.approx(size[0] * size[1], rel=1e-9)
        x0, y0, x1, y1 = once.bounds
        assert (x0, y0, x1, y1) == (0.0, 0.0, *size)


def test_a_missing_or_doubled_line_is_seen() -> None:
    """The oracles of the test above fail for a path less, a path twice, and a trail in two."""
    size = sheet_of("p4-hook")
    once, pieces = cuts(made("p4-hook", sheet=size)), cuts(made("p4-hook", sheet=size, edges="pieces"))
    trails, rings = split_closed(once)
    border = float(true_lengths(rings).sum())
    check_once(once, pieces, border)
    for wrong in (trails, Paths.concatenate([once, trails.take(np.array([0]))])):
        with pytest.raises(AssertionError):
            check_once(wrong, pieces, border)
    moved = Paths.concatenate([trails.take(np.array([0])).moved(1.0, 1e-7), once])
    with pytest.raises(AssertionError, match="lies near"):
        check_apart(moved)
    parts, least = odd_vertices(trails)
    assert parts <= least < len(trails) + 1
    _, more = odd_vertices(trails.take(np.arange(1, len(trails))))
    assert more <= least


@pytest.mark.parametrize("name", [pytest.param("p4-hook", marks=pytest.mark.slow), "p1-fish", "pg-wave"])
def test_lines_are_the_exact_tiles(name: str) -> None:
    """Turned by a quarter and moved: the lines of the sheet are those of the copies by the group's operations."""
    size = sheet_of(name, 2.5)
    product = made(name, sheet=size, fit="clip", margin=3.0)
    lines = shapely.multilinestrings(lines_of(cuts(product)))
    page = shapely.box(3, 3, size[0] - 3, size[1] - 3)
    exact = shapely.union_all([copy.shape.boundary.intersection(page) for copy in plane(name, *size)])
    exact = exact.union(page.boundary)
    assert farthest(dense(lines, 0.2), exact) <= 2e-3
    assert farthest(dense(exact, 0.2), lines) <= 2e-3
    moved = made(name, sheet=size, fit="clip", margin=3.0, offset=1 + 2j)
    assert farthest(dense(shapely.multilinestrings(lines_of(cuts(moved))), 0.2), exact) > 0.1


def test_rotate_and_offset() -> None:
    """Both are about the middle of the sheet: rotate first, then move."""
    product = squares().make(Job(sheet=(100.0, 80.0), fit="clip", rotate=30.0, offset=2 - 3j, edges="pieces"))
    corners = cuts(product).start
    inner = corners[(np.abs(corners.real - 50) < 49) & (np.abs(corners.imag - 40) < 39)]
    lattice = (inner - (50 + 40j) - (2 - 3j)) * np.exp(-1j * np.pi / 6) / 20
    assert len(inner) > 10
    assert np.abs(lattice - np.round(lattice.real) - 1j * np.round(lattice.imag)).max() < 1e-9


# --- regions of a drawing ---------------------------------------------------------------------------------------

HEART = "M 50 90 C 10 60 10 20 35 20 C 45 20 50 30 50 35 C 50 30 55 20 65 20 C 90 20 90 60 50 90 Z"
SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="{w}" height="{h}" viewBox="{box}">{body}</svg>'


def write_svg(path: Any, body: str, *, w: str = "100mm", h: str = "100mm", box: str = "0 0 100 100") -> str:
    """Write a drawing; its name."""
    path.write_text(SVG.format(w=w, h=h, box=box, body=body))
    return str(path)


@pytest.mark.parametrize("fit", ["clip", "frame"])
def test_a_heart_with_a_hole(tmp_path: Any, fit: Fit) -> None:
    """Pieces fill the region of the drawing's curves, to the accuracy; the hole is free."""
    body = f'<path d="{HEART}" fill="none" stroke="black"/><circle cx="50" cy="50" r="8" stroke="black"/>'
    name = write_svg(tmp_path / "heart.svg", body)
    tiles = Design.loads(SQUARES.replace("20", "8").replace("10", "4")).tessellate()
    product = tiles.make(Job(sheet=name, fit=fit, edges="pieces", offset=3 + 1j))
    t = np.linspace(0, 1, 2001)

    def cubic(a: complex, b: complex, c: complex, d: complex) -> Any:
        return a * (1 - t) ** 3 + 3 * b * t * (1 - t) ** 2 + 3 * c * t**2 * (1 - t) + d * t**3

    left = [cubic(50 + 90j, 10 + 60j, 10 + 20j, 35 + 20j), cubic(35 + 20j, 45 + 20j, 50 + 30j, 50 + 35j)]
    right = [cubic(50 + 35j, 50 + 30j, 55 + 20j, 65 + 20j), cubic(65 + 20j, 90 + 20j, 90 + 60j, 50 + 90j)]
    points = np.concatenate([*left, *right])
    heart = shapely.Polygon(np.column_stack((points.real, 100 - points.imag))).buffer(0)
    region = heart.difference(shapely.Point(50, 50).buffer(8, quad_segs=500))
    pieces = contour_shapes(cuts(product), 1e-3)
    filled = shapely.union_all(pieces, grid_size=1e-6)
    assert filled.symmetric_difference(region).buffer(-0.006).is_empty
    assert sum(piece.area for piece in pieces) == pytest.approx(region.area, abs=0.01 * region.length)
    assert product.drawing.width == product.drawing.height == pytest.approx(100.0)
    once = tiles.make(Job(sheet=name, fit=fit, offset=3 + 1j))
    assert cuts(once).closed.sum() >= 2


def test_inches_and_a_margin(tmp_path: Any) -> None:
    """A circle of two inches, less a margin of 5 mm; no page in the file gives one that fits."""
    name = write_svg(tmp_path / "c.svg", '<circle cx="2" cy="2" r="2"/>', w="4in", h="4in", box="0 0 4 4")
    product = squares().make(Job(sheet=name, fit="clip", margin=5.0, edges="pieces"))
    assert product.pieces.area.sum() == pytest.approx(np.pi * (50.8 - 5) ** 2, rel=1e-3)
    assert product.drawing.width == pytest.approx(101.6)
    x0, _, x1, _ = cuts(product).bounds
    assert (x0, x1) == pytest.approx((5, 96.6), abs=0.01)


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ('<path d="M 0 0 L 50 50"/>', "no closed path"),
        ("", "no closed path"),
        ('<path d="M 0 0 L 50 50 L 50 0 L 0 50 Z"/>', "cross themselves"),
        ('<path d="M 0 0 L 50 50 L 50 0 L 0 20 Z"/>', "cross or touch"),
        ('<path d="M 0 0 H 50 V 50 H 0 Z"/><path d="M 25 25 H 75 V 75 H 25 Z"/>', "cross or touch"),
        ('<path d="M 0 0 H 50 V 50 H 0 Z"/><path d="M 0 0 H 50 V 50 H 0 Z"/>', "cross or touch"),
        ('<path d="M 0 0 L 50 50 Z"/>', "enclose nothing"),
        ('<path d="M 0 0 H 4 V 4 H 0 Z"/>', "no whole tile fits"),
        ("<path d='M 0 0 H 1 V 1 H 0 Z'/>" * 1001, "1001 closed paths"),
    ],
)
def test_drawings_that_are_no_sheet(tmp_path: Any, body: str, message: str) -> None:
    """One message each, with the file's name where it is about the file."""
    name = write_svg(tmp_path / "sheet.svg", body)
    with pytest.raises(JobError, match=message) as caught:
        squares().make(Job(sheet=name))
    assert caught.value.remedy
    assert caught.value.remedy.endswith(".")


def test_margins_that_leave_nothing_of_a_drawing(tmp_path: Any) -> None:
    """The message names the margin."""
    name = write_svg(tmp_path / "s.svg", '<circle cx="50" cy="50" r="20"/>')
    with pytest.raises(JobError, match="margin of 25 mm leaves nothing"):
        squares().make(Job(sheet=name, margin=25.0, fit="clip"))


# --- pulled apart -----------------------------------------------------------------------------------------------


def least_gap(shapes: list[Any]) -> float:
    """The least distance between two of the shapes."""
    tree = shapely.STRtree(shapes)
    one, two = tree.query(shapes, predicate="dwithin", distance=50.0)
    apart = one < two
    return float(shapely.distance(np.array(shapes)[one[apart]], np.array(shapes)[two[apart]]).min())


@pytest.mark.parametrize(
    ("name", "job", "wanted"),
    [
        ("p1-leaf", {"gap": 2.0}, 2.0),
        ("pg-wave", {"kerf": 0.2}, 1.0),
        pytest.param("p3-puzzle", {"kerf": 0.8}, 1.6, marks=pytest.mark.slow),
        pytest.param("p6-rosette", {"gap": 3.0, "fillet": 0.3}, 3.0, marks=pytest.mark.slow),
        ("cmm-scroll", {"gap": 1.0}, 1.0),
        ("p4g-fan", {"gap": 2.0, "rotate": 20.0, "fit": "clip"}, 2.0),
        pytest.param("p31m", {"gap": 0.0, "kerf": 0.3}, 0.0, marks=pytest.mark.slow),
    ],
)
def test_contours_are_as_far_apart_as_asked_and_no_farther(name: str, job: dict[str, Any], wanted: float) -> None:
    """The least distance of any two is the gap; the pieces are no others than without it."""
    design = tiling(name).design
    side = 3.3 * abs(design.lattice.a) * design.unit_mm * (3 if name == "cmm-scroll" else 1)
    product = made(name, sheet=(side, side), **job)
    shapes = contour_shapes(cuts(product), FINE)
    assert len(shapes) > 3
    apart = least_gap(shapes)
    assert apart >= wanted - 2 * FINE
    assert apart <= wanted + 0.02 * max(wanted, 0.1)


def test_contours_that_touch_are_said() -> None:
    """A kerf without a gap, and pieces without both, cut twice where contours lie on each other; a gap says nothing."""

    def note(kerf: float, gap: float | None) -> str:
        """What is said of a sheet of squares."""
        return " ".join(squares().make(Job(sheet=(100.0, 90.0), edges="pieces", kerf=kerf, gap=gap)).notes)

    assert "contours touch, and are cut twice where they lie on each other: `gap='1mm'`" in note(0.15, 0.0)
    assert "contours lie on each other, and are cut twice" in note(0.0, None)
    assert note(0.15, 0.1) == note(0.15, None) == ""


@pytest.mark.parametrize("kerf", [0.0, 0.4])
def test_clipped_tiles_stay_on_the_sheet_when_pulled_apart(kerf: float) -> None:
    """What is cut at the border is cut where the border is, not where it was before the tiles were pulled."""
    size, margin = (100.0, 90.0), 3.0
    product = squares().make(Job(sheet=size, fit="clip", gap=2.0, kerf=kerf, margin=margin))
    bounds = cuts(product).bounds
    assert bounds == pytest.approx((margin, margin, size[0] - margin, size[1] - margin), abs=1e-9)
    pitch = 22.0 + kerf
    m = margin + kerf / 2

    def parts(side: float) -> list[float]:
        """The widths of squares of 20 at this pitch, about the middle, that lie on a sheet of this side."""
        places = (np.arange(-9, 9) * pitch) + side / 2 + (pitch - 20) / 2
        # The square whose lower left corner is the origin is pulled from the middle by its centre's place.
        low, high = np.maximum(places, m), np.minimum(places + 20, side - m)
        return [float(width) for width in high - low if width > 1e-9]

    wanted = sorted(w * h for w in parts(size[0]) for h in parts(size[1]))
    assert sorted(product.pieces.area.tolist()) == pytest.approx(wanted, abs=0.1)
    assert least_gap(contour_shapes(cuts(product))) == pytest.approx(2.0, abs=1e-2)


def test_a_gap_that_is_too_small_is_seen() -> None:
    """The measure sees contours that stand nearer."""
    shapes = contour_shapes(cuts(squares().make(Job(sheet=(100.0, 100.0), gap=2.0))))
    assert least_gap(shapes) == pytest.approx(2.0, abs=2e-3)
    assert least_gap([one.buffer(0.1) for one in shapes]) == pytest.approx(1.8, abs=5e-3)


# --- tabs -------------------------------------------------------------------------------------------------------


def bridges(plain: Product, tabbed: Product, width: float) -> list[Any]:
    """What of the lines of a product is left uncut by another."""
    kept = shapely.union_all([line.buffer(1e-5) for line in lines_of(cuts(tabbed), 1e-6)])
    lines = shapely.union_all(lines_of(cuts(plain), 1e-6)).difference(kept)
    merged = shapely.line_merge(lines)
    parts = list(getattr(merged, "geoms", [merged]))
    return [part for part in parts if part.length > width / 10]


@pytest.mark.parametrize("fit", FITS)
@pytest.mark.parametrize("name", ["p4-hook", "p2-drop"])
def test_tabs_hold_every_whole_tile_twice(name: str, fit: str) -> None:
    """Bridges have the width, every tile two of them at least, and the cut is shorter by all of them."""
    width, size = 0.5, sheet_of(name, 2.4)
    plain = made(name, sheet=size, fit=fit)
    tabbed = made(name, sheet=size, fit=fit, tabs=width)
    found = bridges(plain, tabbed, width)
    assert [part.length for part in found] == pytest.approx([width] * len(found), abs=1e-3)
    off = true_lengths(cuts(plain)).sum() - true_lengths(cuts(tabbed)).sum()
    assert off == pytest.approx(width * len(found), rel=1e-6)
    for copy in whole(plane(name, *size), *size):
        held = [part for part in found if copy.shape.boundary.distance(part.interpolate(0.5, normalized=True)) < 5e-3]
        assert len(held) >= 2
    fewer = bridges(plain, plain, width)
    assert fewer == []


@pytest.mark.parametrize(
    "job", [{"gap": 1.0}, {"kerf": 0.2, "fillet": 1.0}, {"kerf": 0.2, "fit": "clip"}, {"gap": 0.5, "curves": "arc"}]
)
def test_tabs_of_contours(job: dict[str, Any]) -> None:
    """Every contour is cut into two paths or more, and is shorter by as many widths."""
    width = 0.4
    plain = made("p4-hook", sheet=(120.0, 120.0), **job)
    tabbed = made("p4-hook", sheet=(120.0, 120.0), tabs=width, **job)
    before, after = cuts(plain), cuts(tabbed)
    assert before.closed.all()
    assert not after.closed.any()
    assert len(after) >= 2 * len(before)
    # The beam takes half a kerf from either end of a bridge.
    uncut = width + job.get("kerf", 0.0)
    off = true_lengths(before).sum() - true_lengths(after).sum()
    assert off == pytest.approx(uncut * len(after), rel=1e-4)
    found = bridges(plain, tabbed, uncut)
    assert [part.length for part in found] == pytest.approx([uncut] * len(after), abs=1e-3)


def test_tabs_that_leave_nothing() -> None:
    """A message with the contour's length."""
    with pytest.raises(JobError, match=r"tabs of 30 mm leave nothing to cut of a contour of 80 mm"):
        squares().make(Job(edges="pieces", tabs=30.0))
    with pytest.raises(JobError, match="hold nothing where the contours"):
        Job(sheet=(100.0, 100.0), edges="pieces", tabs=0.3)


def test_holes_and_corners_of_the_frame() -> None:
    """Tiles and frame have the sheet's area, the frame is one piece with a hole, its contour is cut last."""
    product = squares().make(Job(sheet=(95.0, 95.0), fit="frame", edges="pieces"))
    assert product.pieces.site.tolist().count(-1) == 1
    frame = product.pieces.area[product.pieces.site == -1]
    assert frame == pytest.approx([95.0**2 - 16 * 400])
    once = cuts(squares().make(Job(sheet=(95.0, 95.0), fit="frame")))
    last = once.take(np.array([len(once) - 1]))
    assert last.closed.all()
    assert shape(last).area == pytest.approx(95.0**2)
    assert (once.kind == LINE).all()
    for first, stop in pairwise(once.offsets.tolist()):
        assert (once.start[first + 1 : stop] == once.end[first : stop - 1]).all()


def test_slivers_have_no_tabs() -> None:
    """What the border leaves of a tile may be shorter than its bridges would be: it falls out, and that is said."""
    product = made("p3-puzzle", sheet=(160.0, 150.0), margin=5.0, fit="clip", gap=1.0, tabs=0.4)
    paths = Paths.concatenate([layer.paths for layer in product.drawing.layers])
    lengths = np.bincount(paths.owner, paths.lengths, len(paths))
    assert paths.closed.any()
    assert (lengths[paths.closed] < 4 * 0.4).all()
    said = counted(int(paths.closed.sum()), "contour")
    assert any(note.startswith(said) and "too short for tabs of 0.4 mm" in note for note in product.notes)


def test_a_frame_has_a_width_everywhere() -> None:
    """However the tiles are laid, none comes nearer to the sheet's edge; too small a sheet has no frame."""
    for name in ("p6-triskele", "p4-pinwheel", "pmm"):
        product = made(name, sheet=(200.0, 110.0), offset=None, fit="frame", edges="once")
        lines = [layer.paths for layer in product.drawing.layers]
        inner = Paths.concatenate([paths.take(np.arange(len(paths) - 1)) for paths in lines])  # the border comes last
        x0, y0, x1, y1 = inner.bounds
        assert min(x0, y0, 200.0 - x1, 110.0 - y1) >= FRAME_MM - 1e-9
    with pytest.raises(JobError, match="too small for a frame of 2 mm"):
        made("p4-hook", sheet=(100.0, 3.0), fit="frame")


@pytest.mark.parametrize(("name", "frame"), [("p6-triskele", 8.0), ("p4-pinwheel", 0.5), ("p31m", "1cm")])
def test_the_width_of_a_frame_can_be_chosen(name: str, frame: float | str) -> None:
    """Where it is least it has that width or more, and as much left as right, and above as below."""
    width, height = 210.0, 190.0
    job = Job(sheet=(width, height), frame=frame)
    assert job == Job(sheet=(width, height), frame=frame, fit="frame")
    product = tiling(name).make(job)
    wanted = 10.0 if isinstance(frame, str) else frame
    lines = Paths.concatenate([layer.paths for layer in product.drawing.layers])
    x0, y0, x1, y1 = lines.take(np.arange(len(lines) - 1)).bounds  # the border comes last
    assert min(x0, y0, width - x1, height - y1) >= wanted - 1e-9
    assert x0 == pytest.approx(width - x1, abs=1e-3)
    assert y0 == pytest.approx(height - y1, abs=1e-3)


def test_tiles_and_frame_are_counted_apart() -> None:
    """In the summary and in the report; a frame that is cut through is one of several pieces."""
    job = Job(sheet=(95.0, 95.0), frame=3.0)
    product = squares().make(job)
    assert product.summary().startswith("16 tiles and a frame, ")
    figures = squares().report(job)["pieces"]
    assert (figures["count"], figures["whole"], figures["frame"]) == (16, 16, 1)
    assert squares().make(Job(sheet=(95.0, 95.0))).summary().startswith("16 pieces, ")
    sites = np.array([0, -1, -1])
    assert replace(product.pieces, site=sites).counted == "1 tile and a frame of 2 pieces"
    assert replace(product.pieces, site=sites[1:2]).counted == "a frame"


@pytest.mark.parametrize(
    ("job", "message"),
    [
        ({"fit": "clip", "frame": 3.0}, "leaves no `frame`"),
        ({"frame": 0.0}, "`frame` 0 mm cannot be"),
        ({"frame": 40.0}, "too small for a frame of 40 mm"),
        ({"sheet": None, "frame": 3.0}, "`frame` is about a sheet"),
        ({"frame": 3.0, "kerf": 0.1}, "leaves them no room"),
    ],
)
def test_frames_that_cannot_be(job: dict[str, Any], message: str) -> None:
    """One message each, with a remedy."""
    with pytest.raises(JobError, match=message) as caught:
        squares().make(Job(**{"sheet": (70.0, 70.0), **job}))
    assert caught.value.remedy


@pytest.mark.parametrize("job", [{}, {"kerf": 0.1}, {"curves": "cubic"}])
def test_a_tile_that_is_larger_than_any_file_holds_is_refused(job: dict[str, Any]) -> None:
    """With its size, and before its curves are fitted."""
    large = squares().design.scaled(1e6).tessellate()
    with pytest.raises(JobError, match=r"a tile of 20,000,000 mm is larger than 100,000 mm"):
        large.make(Job(**job))
