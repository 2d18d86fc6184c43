"""The scale, or the sheet, for a number of pieces: counted by shapely, and made again from what the file says."""

from __future__ import annotations

import io
import json
import re
from typing import Any

import pytest
import shapely
from helpers.cutting import SQUARES, contour_shapes, cuts, squares
from helpers.examples import tiling
from hypothesis import example, given, settings
from hypothesis import strategies as st

from voronoi_tiles import Design
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.fabrication.product import Product


def written(product: Product) -> bytes:
    """The bytes of a product's file."""
    buffer = io.BytesIO()
    product.write(buffer)
    return buffer.getvalue()


def scale_of(product: Product) -> float:
    """The scale that a product says it has."""
    note = next(note for note in product.notes if note.startswith("scale "))
    return float(note.split(":")[0].removeprefix("scale "))


def test_the_size_that_is_said_is_that_of_the_designs_own_tile() -> None:
    """It is what a tile's width and height mean elsewhere, not those of a turned copy in a larger box."""
    for name in ("p3-puzzle", "p4-hook"):
        design = tiling(name).design
        for job in (Job(pieces=6, sheet=(200.0, 150.0)), Job(pieces=6)):
            product = tiling(name).make(job)
            scale = scale_of(product) if job.sheet else 1.0
            left, bottom, right, top = design.scaled(scale).tessellate().tiles[0].outline.bounds
            size = f"a tile is {right - left:.1f} x {top - bottom:.1f} mm"
            assert any(note.endswith(size) for note in product.notes), (size, product.notes)


@pytest.mark.parametrize(
    ("name", "job"),
    [
        pytest.param("p4-hook", {"kerf": 0.2}, marks=pytest.mark.slow),
        ("pg-wave", {"fit": "frame", "margin": 4.0}),
        ("p3-puzzle", {"rotate": 15.0}),
        pytest.param("cmm-scroll", {"gap": 2.0}, marks=pytest.mark.slow),
    ],
)
def test_a_sheet_is_filled_at_the_scale_that_is_found(name: str, job: dict[str, Any]) -> None:
    """So many tiles lie within it; at a scale that is larger by a fiftieth there are fewer."""
    pieces, sheet = 23, (310.0, 220.0)
    product = tiling(name).make(Job(sheet=sheet, pieces=pieces, edges="pieces", **job))
    whole = contour_shapes(cuts(product), 1e-2)[: product.pieces.count]
    margin = job.get("margin", 0.0)
    room = shapely.box(margin, margin, sheet[0] - margin, sheet[1] - margin).buffer(1e-3)
    assert product.pieces.count >= pieces
    assert sum(room.covers(shape) for shape in whole) >= pieces
    scale = scale_of(product)
    larger = tiling(name).design.scaled(1.02 * scale).tessellate()
    assert larger.make(Job(sheet=sheet, edges="pieces", **job)).pieces.count < pieces
    same = tiling(name).design.scaled(scale).tessellate().make(Job(sheet=sheet, edges="pieces", **job))
    assert written(same) == written(product)


@given(st.integers(1, 40), st.floats(60.0, 400.0), st.floats(60.0, 400.0), st.sampled_from([0.0, 1.0]))
@example(17, 107.25, 115.75, 0.0)  # the last digit is tried, too
@settings(max_examples=6)
def test_squares_have_the_scale_of_arithmetic(pieces: int, width: float, height: float, gap: float) -> None:
    """The largest square of which m by n fit, with m n as asked or more; four digits of it, or what a step missed."""
    product = squares().make(Job(sheet=(width, height), pieces=pieces, gap=gap, edges="pieces"))
    best = max(
        min((width + gap) / across, (height + gap) / -(-pieces // across)) - gap for across in range(1, pieces + 1)
    )
    side = 20 * scale_of(product)
    assert side <= best * (1 + 1e-9)
    assert side >= best * (0.999 if gap == 0.0 else 0.99)
    assert product.pieces.count >= pieces


@pytest.mark.slow
def test_the_file_says_what_was_found() -> None:
    """Its recipe holds the scaled design and the job without the number: made again, the bytes are the same."""
    product = tiling("pg-wave").make(Job(sheet="300x200mm", pieces=30, kerf=0.1, labels="number"))
    recipe = product.drawing.recipe
    job = json.loads(recipe["job"])
    assert "pieces" not in job
    design = Design.loads(recipe["design"], name=tiling("pg-wave").design.name)
    again = design.tessellate().make(Job(**job))
    assert written(again) == written(product)
    assert design.cell["a"] == pytest.approx(tiling("pg-wave").design.cell["a"] * scale_of(product))


@pytest.mark.parametrize(
    ("name", "job"),
    [
        ("p4-hook", {}),
        pytest.param("p1-heron", {"kerf": 0.2, "margin": 3.0}, marks=pytest.mark.slow),
        pytest.param("pg-wave", {"frame": 7.0}, marks=pytest.mark.slow),
    ],
)
def test_the_smallest_sheet_that_holds_them(name: str, job: dict[str, Any]) -> None:
    """In whole millimetres; the tiles have their size, and a sheet that is 2 mm smaller holds fewer."""
    pieces = 17
    product = tiling(name).make(Job(pieces=pieces, **job))
    width, height = product.drawing.width, product.drawing.height
    assert (width, height) == (round(width), round(height))
    assert f"sheet {width:g} x {height:g} mm" in product.notes[0]
    assert product.pieces.count >= pieces
    own = tiling(name).tiles[0].area * tiling(name).design.unit_mm ** 2
    assert product.pieces.area[0] == pytest.approx(own, rel=1e-3)
    same = tiling(name).make(Job(sheet=(width, height), **job))
    assert written(same) == written(product)
    for smaller in ((width - 2, height), (width, height - 2)):
        assert tiling(name).make(Job(sheet=smaller, **job)).pieces.count < product.pieces.count
    squarish = tiling(name).make(Job(sheet=((width * height) ** 0.5 - 3,) * 2, **job))
    assert squarish.pieces.count < pieces


def test_squares_take_the_sheet_of_arithmetic() -> None:
    """Twelve squares of 20 mm: three by four, and a margin."""
    product = squares().make(Job(pieces=12, margin=5.0))
    assert sorted((product.drawing.width, product.drawing.height)) == [70.0, 90.0]
    assert product.pieces.count == 12


@pytest.mark.parametrize(
    ("job", "message"),
    [
        ({"pieces": 0}, "`pieces` 0 cannot be"),
        ({"pieces": 2.5}, "`pieces` 2.5 cannot be"),
        ({"pieces": "many"}, "'many' cannot be"),
        ({"pieces": 10**6}, "1000000 cannot be"),
        ({"pieces": 3, "fit": "clip", "sheet": (90.0, 90.0)}, "counts whole tiles"),
        ({"pieces": 40, "sheet": (30.0, 30.0), "gap": 9.0}, "at no scale"),
    ],
)
def test_numbers_that_cannot_be(job: dict[str, Any], message: str) -> None:
    """One message each, with a remedy."""
    with pytest.raises(JobError, match=message) as caught:
        squares().make(Job(**job))
    assert caught.value.remedy


def test_a_scaled_design_has_no_check_of_another() -> None:
    """The cross-check is evidence for the design as it is."""
    tiles = Design.loads(SQUARES).tessellate()
    with pytest.raises(JobError, match="scales the design"):
        tiles.export("a.svg", job=Job(pieces=4, sheet=(90.0, 90.0)), check=tiles.check(renderer="cpu", samples=64))


# --- what a smaller gap would fit ---------------------------------------------------------------------------------

HINT = re.compile(r"[^;]*; with `gap='([\d.]+)mm'` ([\d,]+) tiles would fit(; [^;]*hold more)?")


@given(
    st.sampled_from(["p2-drop", "p3-puzzle", "p4-pinwheel", "pg-wave"]),
    st.floats(120.0, 300.0),
    st.floats(120.0, 300.0),
    st.sampled_from([{"gap": 2.0}, {"gap": 3.7, "margin": 4.0}, {"kerf": 0.12}]),
)
@settings(max_examples=5)
def test_a_smaller_gap_fits_what_is_said(name: str, width: float, height: float, job: dict[str, Any]) -> None:
    """Made with the gap that is named, the sheet has as many tiles; where nothing is said, half the gap has no more."""
    first = tiling(name).make(Job(sheet=(width, height), **job))
    found = HINT.fullmatch(first.summary())
    gap = job.get("gap", 1.0) / 2
    second = tiling(name).make(Job(sheet=(width, height), **{**job, "gap": gap})).pieces.count
    if found is not None:
        assert float(found[1]) == pytest.approx(gap, rel=0.05)
        assert first.pieces.count < int(found[2])
        if float(found[1]) == gap:
            assert int(found[2]) <= second
    elif gap == float(f"{gap:.2g}"):
        assert second <= first.pieces.count


@pytest.mark.parametrize(
    "job", [{"gap": 0.3}, {"kerf": 1.0}, {"kerf": 0.4, "gap": 0.8}, {"fit": "clip", "gap": 2.0}, {}]
)
def test_no_gap_is_named_where_there_is_no_smaller_one(job: dict[str, Any]) -> None:
    """Below 0.3 mm, or twice the kerf, cuts hurt each other; clipped tiles fill the sheet anyway."""
    product = squares().make(Job(sheet=(104.0, 104.0), **job))
    assert "would fit" not in product.summary()


def test_another_layout_is_named_where_tiles_are_hooked() -> None:
    """Scrolls that are pulled apart take over four times their room; leaves do not, nor scrolls side by side."""
    job = Job(sheet=(200.0, 150.0), kerf=0.15)
    scrolls = tiling("cmm-scroll")
    assert re.search(r"to 4\.\d times their room: `layout='auto'` may hold more$", scrolls.make(job).summary())
    for said in (tiling("p1-leaf").make(job), scrolls.make(Job(sheet=(200.0, 150.0)))):
        assert "layout" not in said.summary()
