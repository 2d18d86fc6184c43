"""Tiles of a colour packed on sheets of their own: none lost, changed or too near another, by shapely."""

from __future__ import annotations

import json
from collections import Counter
from typing import Any

import numpy as np
import pytest
import shapely
from helpers.cutting import SQUARES, contour_shapes, cuts, rings, squares, work
from helpers.examples import tiling
from helpers.sheets import flattened, xy
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles import Design, Tiling
from voronoi_tiles.designs.starters import starter
from voronoi_tiles.fabrication.engraving import piece_numbers
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.fabrication.packed_sheets import pack_colours
from voronoi_tiles.fabrication.packing import pack_pieces
from voronoi_tiles.fabrication.product import Product, _Plan, make_several
from voronoi_tiles.formats.presets import Format
from voronoi_tiles.preflight import preflight


def packed(tiles: Tiling, **job: Any) -> list[tuple[str, Product]]:
    """The sheets of a job that packs, each with its name."""
    return make_several(tiles.design, tiles.tessellation, Job(pack=True, **job))


def nearest(shapes: list[Any]) -> float:
    """The least distance between two shapes."""
    tree = shapely.STRtree(shapes)
    one, two = tree.query(shapes, predicate="dwithin", distance=30.0)
    apart = one < two
    found = shapely.distance(np.array(shapes)[one[apart]], np.array(shapes)[two[apart]])
    return float(found.min(initial=np.inf))


def form(shape: Any) -> tuple[float, ...]:
    """What a shape has wherever it stands, as far as chords let one see it."""
    x0, y0, x1, y1 = shape.bounds
    centre = shape.centroid
    return tuple(round(value, 1) for value in (shape.area, x1 - x0, y1 - y0, centre.x - x0, centre.y - y0))


@pytest.mark.parametrize(
    ("name", "job", "gap"),
    [
        ("p4-hook", {"colours": 3, "kerf": 0.2}, 1.0),
        ("pg-wave", {"colours": "handedness", "gap": 2.5}, 2.5),
        ("p3-puzzle", {"colours": "orientation", "stock": (170.0, 120.0), "margin": 4.0}, 1.0),
        pytest.param(
            "cmm-scroll",
            {"colours": "fewest", "stock": "6x5in", "kerf": 0.6, "rotate": 20.0},
            1.2,
            marks=pytest.mark.slow,
        ),
        pytest.param(
            "p1-heron",
            {"colours": 4, "fillet": 0.3, "gap": 0.3, "stock": (200.0, 260.0)},
            0.3,
            marks=pytest.mark.slow,
        ),
    ],
)
def test_packed_sheets_have_all_pieces_apart_and_as_they_are(name: str, job: dict[str, Any], gap: float) -> None:
    """Against the same job's colours in files, where the pieces lie in the picture, touching."""
    tiles, sheet = tiling(name), (330.0, 250.0)
    found = packed(tiles, sheet=sheet, **job)
    stock = Job(sheet=job.get("stock", sheet)).sheet
    assert isinstance(stock, tuple)
    margin = job.get("margin", 0.0)
    room = shapely.box(margin, margin, stock[0] - margin, stock[1] - margin).buffer(1e-6)
    by_colour: dict[str, Counter[tuple[float, ...]]] = {}
    for key, product in found:
        colour, number = key.removeprefix("colour").split("-")
        assert int(number) >= 1
        assert (product.drawing.width, product.drawing.height) == stock
        shapes = contour_shapes(cuts(product), 1e-3)
        assert all(room.covers(shape) for shape in shapes)
        assert nearest(shapes) >= gap - 2e-3
        assert len(shapes) == len(product.pieces.site)
        by_colour.setdefault(colour, Counter()).update(map(form, shapes))
    if "kerf" not in job:  # with one the picture is pulled apart where it is not packed
        plain = {key: value for key, value in job.items() if key not in {"stock", "gap"}}
        together = make_several(
            tiles.design, tiles.tessellation, Job(sheet=sheet, into="files", edges="pieces", **plain)
        )
        wanted = {key: Counter(map(form, contour_shapes(cuts(product), 1e-3))) for key, product in together}
        assert by_colour.keys() == wanted.keys()
        for colour, forms in by_colour.items():
            assert forms.total() == wanted[colour].total()
            assert sum((forms & wanted[colour]).values()) >= 0.8 * forms.total()  # a tenth may round either way
    else:
        whole = tiles.make(Job(sheet=sheet, margin=margin, rotate=job.get("rotate", 0.0)))
        assert sum(forms.total() for forms in by_colour.values()) == len(whole.pieces.site)


@given(
    st.lists(st.tuples(st.floats(2.0, 20.0), st.floats(2.0, 20.0), st.floats(0.0, 6.2)), min_size=1, max_size=4),
    st.lists(st.integers(0, 3), min_size=1, max_size=30),
    st.floats(0.1, 4.0),
)
@settings(max_examples=25)
def test_any_pieces_keep_the_gap(triangles: list[tuple[float, float, float]], kinds: list[int], gap: float) -> None:
    """Hooks of any form, turned, anywhere: within the sheets, the gap between all, no sheet without a piece."""
    hook = shapely.Polygon([(0, 0), (1, 0), (1, 0.2), (0.2, 0.2), (0.2, 0.8), (0.7, 0.8), (0.7, 1), (0, 1)])
    shapes = []
    for across, up, turn in triangles:
        one = shapely.affinity.scale(hook, across, up, origin=(0, 0))
        shapes.append(shapely.affinity.translate(shapely.affinity.rotate(one, turn, use_radians=True), 100 * turn, -7))
    kind = np.array(kinds) % len(shapes)
    size = (70.0, 50.0)
    found = pack_pieces(shapes, kind, size, gap)
    room = shapely.box(0, 0, *size).buffer(1e-9)
    for number in range(int(found.sheet.max()) + 1):
        here = np.flatnonzero(found.sheet == number)
        assert len(here)
        moved = [shapely.affinity.translate(shapes[kind[k]], *found.shift[k]) for k in here.tolist()]
        assert all(room.covers(one) for one in moved)
        assert nearest(moved) >= gap - 1e-9


def test_pieces_that_are_nearer_are_seen() -> None:
    """The measure of the tests above, for two squares."""
    assert nearest([shapely.box(0, 0, 1, 1), shapely.box(1.5, 0, 2, 1), shapely.box(9, 9, 10, 10)]) == 0.5


def test_squares_are_packed_as_many_as_fit() -> None:
    """Five by three of 20 mm with a gap of 1 mm on 105 x 65 mm; sheets are used in turn."""
    found = packed(squares(), sheet=(200.0, 200.0), stock=(105.0, 65.0), colours=2)
    assert [name for name, _ in found] == [f"colour{c}-{k}" for c in (1, 2) for k in (1, 2, 3, 4)]
    assert [len(product.pieces.site) for _, product in found] == [15, 15, 15, 5] * 2
    assert [product.notes[:1] for _, product in found][::4] == [
        (f"colour {c}: 50 pieces on 4 sheets, 73.3% of them",) for c in (1, 2)
    ]


def test_labels_and_art_move_with_the_pieces(tmp_path: Any) -> None:
    """Each number once, as in the picture; every piece holds its own label and the art of its site."""
    (tmp_path / "dot.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="20mm" viewBox="0 0 20 20">'
        '<path d="M 8 3 H 12 V 5 H 8 Z" id="score" fill="none" stroke="red"/></svg>'
    )
    text = SQUARES.replace("strokes", 'art = { file = "dot.svg" }\nstrokes')
    (tmp_path / "squares.toml").write_text(text)
    tiles = Design.load(tmp_path / "squares.toml").tessellate()
    job = {"sheet": (125.0, 85.0), "colours": 2, "stock": (70.0, 70.0), "label_height": 2.0}
    for labels in ("none", "number"):
        for _, product in packed(tiles, labels=labels, **job):
            shapes = contour_shapes(cuts(product))
            lines = [shapely.LineString(xy(line)) for line in flattened(work(product, "engrave"))]
            per_piece = [sum(shape.covers(line) for line in lines) for shape in shapes]
            assert sum(per_piece) == len(lines)
            assert min(per_piece) == 1 if labels == "none" else min(per_piece) >= 2
            for shape in shapes:
                marks = [line for line in lines if shape.covers(line) and line.is_ring]
                at = [(line.centroid.x - shape.bounds[0], line.centroid.y - shape.bounds[1]) for line in marks]
                assert any(place == pytest.approx((10.0, 16.0), abs=1e-6) for place in at)


def test_numbers_are_those_of_the_picture() -> None:
    """The labels of all packed sheets together are the numbers of all tiles, each once."""
    tiles = tiling("p4-hook")
    job = Job(sheet=(200.0, 150.0), colours=3, pack=True, labels="number")
    plan = _Plan.of(tiles.design, tiles.tessellation, job, "svg")
    sheets = [sheet for one in pack_colours(plan.layout, plan.colouring) for sheet in one.sheets]
    numbers = np.concatenate([sheet.numbers for sheet in sheets if sheet.numbers is not None])
    assert sorted(numbers.tolist()) == list(range(1, len(plan.layout.copies.tile) + 1))


@pytest.mark.parametrize(
    ("group", "job", "form"),
    [
        ("p4", {}, "svg"),
        ("p4m", {}, "svg"),
        ("p6", {"rotate": 20.0, "fillet": 0.5}, "dxf"),
        ("p2", {"frame": 8.0}, "svg"),
        ("p4", {"pieces": 20}, "svg"),
    ],
)
def test_the_picture_without_a_kerf_draws_the_numbers(group: str, job: dict[str, Any], form: Format) -> None:
    """The same job without `pack` and `kerf` has the same tiles in the same places, by the same numbers."""
    tiles = starter(group).tessellate()
    job = {"sheet": (200.0, 150.0) if form == "dxf" else (300.0, 200.0), "labels": "number", **job}

    def numbered(**more: Any) -> dict[int, tuple[int, ...]]:
        """Which tile of the tessellation has which number."""
        layout = _Plan.of(tiles.design, tiles.tessellation, Job(**job, **more), form).layout
        numbers = layout.numbers if layout.numbers is not None else piece_numbers(layout, layout.contours)
        rows = zip(layout.copies.tile.tolist(), layout.copies.step.tolist(), strict=True)
        return {number: (tile, *step) for number, (tile, step) in zip(numbers.tolist(), rows, strict=True)}

    drawn = numbered()
    assert len(drawn) > 10
    assert numbered(pack=True, kerf=0.3) == numbered(pack=True, kerf=0.0) == drawn


@pytest.mark.parametrize("name", ["p4-hook", pytest.param("cmm-scroll", marks=pytest.mark.slow)])
def test_packed_files_pass_the_preflight(tmp_path: Any, name: str) -> None:
    """Every sheet, the frame's too; the same bytes twice."""
    job = Job(sheet="200x150mm", colours=3, kerf=0.15, frame=6.0, pack=True, stock="120x120mm", labels="number")
    written = tiling(name).export(tmp_path / "k.svg", job=job)
    again = tiling(name).export(tmp_path / "again.svg", job=job)
    assert [path for path, _ in written][-1].endswith("k-frame.svg")
    for (path, _), (other, _) in zip(written, again, strict=True):
        report = preflight(path)
        assert report.passed
        assert not report.findings
        with open(path, "rb") as one, open(other, "rb") as two:  # noqa: PTH123 - names as the product gives them
            assert one.read() == two.read()


def test_the_report_says_how_many_sheets() -> None:
    """For each colour, and the use of them."""
    job = Job(sheet=(200.0, 200.0), stock=(105.0, 65.0), colours=2, pack=True)
    figures = squares().report(job)
    assert [(row["colour"], row["pieces"], row["sheets"]) for row in figures["packing"]] == [(1, 50, 4), (2, 50, 4)]
    assert figures["packing"][0]["share"] == pytest.approx(50 * 400 / (4 * 105 * 65))
    assert figures["pieces"]["count"] == 100
    assert squares().report(Job())["packing"] == []


def test_a_frame_around_packed_tiles_is_reported_and_made_again() -> None:
    """With a kerf too: packed tiles need no room beside each other. The recipe of every file lays the same files."""
    job = Job(sheet=(120.0, 120.0), stock=(105.0, 65.0), colours=2, kerf=0.2, frame=8.0, pack=True)
    figures = squares().report(job)
    assert (figures["pieces"]["count"], figures["pieces"]["frame"]) == (25, 1)
    assert sum(row["pieces"] for row in figures["packing"]) == 25
    tiles = squares()
    files = {name: product.drawing for name, product in make_several(tiles.design, tiles.tessellation, job)}
    assert list(files)[-1] == "frame"
    for name, drawing in files.items():
        recipe = json.loads(drawing.recipe["job"])
        again = make_several(tiles.design, tiles.tessellation, Job(**recipe))
        assert [other for other, _ in again] == list(files)
        assert dict(again)[name].drawing.recipe == drawing.recipe


@pytest.mark.parametrize(
    ("job", "message"),
    [
        ({"sheet": None}, "there is none"),
        ({"colours": "layers"}, "makes files"),
        ({"into": "layers"}, "makes files"),
        ({"fit": "clip"}, "cuts them"),
        ({"gap": 0.0}, "touch twice"),
        ({"sheet": "sheet.svg"}, "this one is a drawing"),
        ({"pack": False, "stock": (90.0, 90.0)}, "`stock` is what pieces"),
        ({"stock": "sheet.svg"}, "is no size"),
        ({"stock": (15.0, 90.0)}, "one piece takes 20 x 20 mm, and a sheet has room for 15 x 90 mm"),
        ({"stock": (15.0, 90.0), "margin": 8.0}, "leaves nothing of a `stock`"),
    ],
)
def test_what_cannot_be_packed(job: dict[str, Any], message: str) -> None:
    """One message each, with a remedy."""
    with pytest.raises(JobError, match=message) as caught:
        packed(squares(), **{"sheet": (100.0, 100.0), "colours": 2, **job}) if job.get("pack", True) else Job(
            sheet=(100.0, 100.0), **job
        )
    assert caught.value.remedy


def test_tiles_with_holes_are_packed() -> None:
    """The island is not laid into the ring that it came from: pieces are pushed from outside."""
    found = packed(rings(), sheet=(200.0, 200.0), colours="fewest")
    shapes = [shape for _, product in found for shape in contour_shapes(cuts(product), 1e-3)]
    assert len(shapes) == 50
    for _, product in found:
        assert nearest(contour_shapes(cuts(product), 1e-3)) >= 1.0 - 2e-3


def test_a_frame_with_a_kerf_is_cut_beside_its_pieces() -> None:
    """Its opening is smaller by the kerf, and pieces are larger by it: both have their true size once they are cut."""
    job = Job(sheet=(90.0, 90.0), margin=4, frame=3, kerf=0.3, pack=True)
    files = make_several(squares().design, squares().tessellation, job)
    assert [name for name, _ in files] == ["1", "frame"]
    pieces, frame = (contour_shapes(cuts(product)) for _, product in files)
    assert f"a frame, {(81.7**2 - 60**2) / 90**2:.1%} of 90 x 90 mm" in files[1][1].summary()
    (around,) = frame
    (opening,) = around.interiors
    assert shapely.Polygon(opening).area == pytest.approx((3 * 20 - 0.3) ** 2, abs=0.01)
    assert len(pieces) == 9
    for piece in pieces:
        x0, y0, x1, y1 = piece.bounds
        assert (x1 - x0, y1 - y0) == pytest.approx((20.3, 20.3), abs=1e-6)
    with pytest.raises(JobError, match=r"`pack=True`: pieces beside the frame, a file each"):
        Job(sheet=(90.0, 90.0), frame=3, kerf=0.3)
