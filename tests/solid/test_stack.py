"""Stacks: sheets to cut, each the exact tile at its height, with holes for dowels and a number; and as a solid."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
import pytest

from voronoi_tiles import ArgumentError, Design, JobError, Product, Stack, StackJob, VoronoiTilesError, stack
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.fabrication.lettering import lettering
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import Paths

CELL, HEIGHT, ABOUT = 60.0, 40.0, 15 + 14j
ENDS = np.array([8 + 10j, 22 + 17j])
TWIST = f"""
schema = 1
group = "p4"
cell = {{ a = {CELL} }}
site = [{{ name = "bird", strokes = [{{ segment = [[8, 10], [22, 17]] }}] }}]
solid = {{ height = {HEIGHT}, turn = 90, about = [15, 14] }}
"""
SHEETS, DOWEL, KERF = 3, 4.0, 0.2


@pytest.fixture(scope="module")
def made() -> Stack:
    """Three sheets with dowels."""
    return stack(Design.loads(TWIST), StackJob(sheets=SHEETS, dowel=DOWEL))


@pytest.fixture(scope="module")
def products(made: Stack) -> list[Product]:
    """Their drawings."""
    return made.products()


def _layer(product: Product, name: str) -> Paths:
    """The paths of a layer."""
    (found,) = [layer.paths for layer in product.drawing.layers if layer.name == name]
    return found


def _centres(product: Product) -> Complexes:
    """The centres of the circles of a sheet's inner cuts, from the top of the page down."""
    rings = _layer(product, "inner")
    boxes = np.array([rings.take(np.array([k])).bounds for k in range(len(rings))])
    centres = (boxes[:, 0] + boxes[:, 2]) / 2 + 1j * (boxes[:, 1] + boxes[:, 3]) / 2
    return np.asarray(centres[np.argsort(-centres.imag)])


def _shift(made: Stack, product: Product) -> complex:
    """How far the page of a sheet is from the plane of the design, by its holes."""
    told = np.array([complex(x, y) for x, y in made.report()["holes"]["bird"]])
    apart = _centres(product) - told[np.argsort(-told.imag)]
    assert abs(apart[0] - apart[1]) < 1e-9
    return complex(apart.mean())


def _distance(points: Complexes, ends: Complexes) -> np.ndarray[Any, Any]:
    """How far points are from a segment."""
    along = ends[1] - ends[0]
    t = np.clip(((points - ends[0]) * along.conjugate()).real / abs(along) ** 2, 0.0, 1.0)
    return np.asarray(np.abs(points - ends[0] - t * along))


def test_each_sheet_is_the_exact_tile_of_its_middle(made: Stack, products: list[Product]) -> None:
    """Its outline is as far from the segment, turned by hand, as from the nearest of its copies; holes tell where."""
    steps = [CELL * (i + 1j * j) for i in range(-2, 3) for j in range(-2, 3)]
    for k, product in enumerate(products):
        turned = ABOUT + (ENDS - ABOUT) * np.exp(0.5j * np.pi * (k + 0.5) / SHEETS)
        points = to_lines(_layer(product, "cut"), accuracy=0.01).start - _shift(made, product)
        others = [turned * 1j**q + step for q in range(4) for step in steps if q or step]
        nearest = np.min([_distance(points, other) for other in others], axis=0)
        assert np.abs(nearest - _distance(points, turned)).max() < 1e-9


def test_holes_keep_their_walls_in_every_sheet(products: list[Product]) -> None:
    """Half a diameter of wood is around each of them, and they are as wide as they should be."""
    for product in products:
        outline = to_lines(_layer(product, "cut"), accuracy=0.001).start
        for centre in _centres(product):
            assert np.abs(outline - centre).min() >= DOWEL
        rings = to_lines(_layer(product, "inner"), accuracy=0.001)
        radius = np.abs(rings.start - _centres(product)[:, None]).reshape(2, -1)
        assert radius.min(axis=0) == pytest.approx(DOWEL / 2, abs=1e-3)
        assert product.pieces.tile_area == pytest.approx(900.0 - 2 * np.pi * DOWEL**2 / 4)
    one, other = _centres(products[0]).tolist()
    assert abs(one - other) > 20.0


def test_the_kerf_is_taken_from_holes() -> None:
    """The beam's path is half of it within a hole, and as far outside the tile."""
    plain, cut = (
        stack(Design.loads(TWIST), StackJob(sheets=1, dowel=DOWEL, kerf=kerf)).products()[0] for kerf in (0.0, KERF)
    )
    wide, narrow = (np.ptp(_layer(product, "inner").take(np.array([0])).start.real) for product in (plain, cut))
    assert wide - narrow == pytest.approx(KERF, abs=1e-9)
    assert cut.drawing.width - plain.drawing.width == pytest.approx(KERF, abs=0.11)


def test_holes_go_with_their_tiles() -> None:
    """Tiles of two sites, turned, and apart for the beam: each has its holes where it would have them in its place."""
    moth = '{ name = "moth", strokes = [{ segment = [[20, 25], [26, 23]] }] }'
    design = Design.loads(TWIST.replace("}] }]", f"}}] }}, {moth}]").replace("90", "8"))
    made = stack(design, StackJob(sheets=2, dowel=1.5, rotate=33, kerf=0.02))
    turn = complex(np.exp(1j * np.radians(33)))
    for sheet, product in zip(made.sheets, made.products(), strict=True):
        page = _layer(product, "cut")
        boxes = np.array([page.take(np.array([k])).bounds for k in range(2)]).reshape(2, 2, 2)
        for own, outline in zip(made.report()["holes"].values(), sheet.outlines, strict=True):
            box = np.reshape(outline.moved(turn, 0j).bounds, (2, 2))
            (k,) = np.flatnonzero(np.abs(np.ptp(boxes - box, axis=1)).max(axis=1) < 0.1)
            placed = np.array([complex(x, y) for x, y in own]) * turn + complex(*(boxes[k] - box)[0])
            assert np.abs(_centres(product)[:, None] - placed).min(axis=0).max() < 0.1


def test_sheets_are_numbered(products: list[Product]) -> None:
    """From the lowest up, each by the strokes of its number."""
    for k, product in enumerate(products):
        drawn, digit = _layer(product, "engrave"), lettering(str(k + 1), height=1.0)
        (x0, y0, _, y1), (u0, v0, _, v1) = drawn.bounds, digit.bounds
        placed = (drawn.start - complex(x0, y0)) / (y1 - y0)
        assert placed == pytest.approx((digit.start - complex(u0, v0)) / (v1 - v0), abs=1e-9)


def test_the_stack_is_a_solid() -> None:
    """Closed sheets upon each other, each with the cell's share, in one place and not each in its own."""
    made = stack(Design.loads(TWIST), StackJob(sheets=SHEETS, accuracy=0.02))
    model = made.model
    assert [piece.name for piece in model.pieces] == ["bird 1", "bird 2", "bird 3"]
    shifts = []
    for k, (piece, sheet) in enumerate(zip(model.pieces, made.sheets, strict=True)):
        assert piece.mesh.is_closed
        assert piece.mesh.volume == pytest.approx(CELL**2 * HEIGHT / 4 / SHEETS, rel=1e-12)
        low, high = piece.mesh.vertices.min(axis=0), piece.mesh.vertices.max(axis=0)
        assert (low[2], high[2]) == pytest.approx((HEIGHT * k / SHEETS, HEIGHT * (k + 1) / SHEETS))
        (outline,) = sheet.outlines
        shifts.append(np.concatenate((low[:2] - outline.bounds[:2], high[:2] - outline.bounds[2:])))
    assert np.ptp(np.array(shifts).reshape(-1, 2), axis=0).max() < 2 * 0.02  # chords lie in and out
    assert model.bounds[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


def test_files_are_written_all_or_none(made: Stack, tmp_path: Path) -> None:
    """With their numbers; where one cannot be, there is none."""
    written = made.export(tmp_path / "a.lbrn2")
    assert [Path(path).name for path, _ in written] == ["a-1.lbrn2", "a-2.lbrn2", "a-3.lbrn2"]
    (tmp_path / "b-2.svg").mkdir()
    with pytest.raises(VoronoiTilesError):
        made.export(tmp_path / "b.svg")
    assert sorted(path.name for path in tmp_path.iterdir() if path.name[0] == "b") == ["b-2.svg"]


IN_PARTS = """
schema = 1
group = "p1"
cell = { a = 60, b = 60, angle = 90 }
site = [{ strokes = [{ point = [0, 0] }, { point = [90, 0] }] }]
solid = { height = 20, shift = [5, 5] }
"""
CROSSING = TWIST.replace("turn = 90, about = [15, 14]", "shift = [-30, -27]")


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        (TWIST.partition("solid =")[0], {"sheets": 7}, "the design is flat"),
        (TWIST, {"sheets": 0}, "`sheets` 0 cannot be"),
        (TWIST.replace("40.0, t", "1, t"), {"sheets": 120}, "with `sheets=120` each of them is 0.00833 mm thick"),
        (TWIST, {"sheets": 2, "dowel": 1, "kerf": 1}, "a `kerf` of 1 mm leaves nothing to cut of holes"),
        (TWIST, {"sheets": 2, "dowel": 30}, "two holes with `dowel='30mm'` have no room"),
        (IN_PARTS, {"sheets": 1, "dowel": 1}, 'the tile of "site1" is in parts'),
        (CROSSING, {"sheets": 1}, 'site "bird" touches its own copy under -y,x at (0, 0) in sheet 1 at the height 20'),
    ],
)
def test_what_cannot_be_is_refused(text: str, options: dict[str, Any], message: str) -> None:
    """With the reason, and what to do."""
    with pytest.raises((ArgumentError, VoronoiTilesError)) as refusal:
        stack(Design.loads(text), StackJob(**options))
    assert str(refusal.value).startswith(message)


def test_a_thinner_dowel_that_is_advised_has_room() -> None:
    """The refusal names the thickest, and a little more is refused."""
    design = Design.loads(TWIST)
    with pytest.raises(JobError, match="have no room") as refusal:
        stack(design, StackJob(sheets=2, dowel=30))
    advised = float(str(refusal.value).partition("Use ")[2].partition(" mm")[0])
    assert stack(design, StackJob(sheets=2, dowel=advised)).holes
    with pytest.raises(JobError, match="have no room"):
        stack(design, StackJob(sheets=2, dowel=advised + 0.02))


def test_what_is_cut_alone_is_no_solid() -> None:
    """That is said and not passed over."""
    made = stack(Design.loads(TWIST), StackJob(sheets=2, kerf=0.1))
    with pytest.raises(JobError, match="`kerf` is for sheets that are cut"):
        _ = made.model


def test_a_solid_has_the_holes_of_its_dowels() -> None:
    """A dowel goes through the sheets of a tile where the report says; holes are no wider than the accuracy allows."""
    made = stack(Design.loads(TWIST), StackJob(sheets=SHEETS, dowel=DOWEL, accuracy=0.01, rotate=33))
    turn = complex(np.exp(1j * np.radians(33)))
    told = np.array([complex(x, y) for x, y in made.report()["holes"]["bird"]]) * turn
    shifts = []
    for k, piece in enumerate(made.model.pieces):
        assert piece.mesh.is_closed
        solid = manifold3d.Manifold(manifold3d.Mesh64(piece.mesh.vertices, piece.mesh.triangles.astype(np.uint64)))
        assert (solid.status(), solid.genus()) == (manifold3d.Error.NoError, 2)
        rings = [
            ring.copy().view(np.complex128)[:, 0] for ring in solid.slice(HEIGHT * (k + 0.5) / SHEETS).to_polygons()
        ]
        holes = sorted(rings, key=lambda ring: float(np.ptp(ring.real)))[:2]
        centres = np.array([ring.mean() for ring in holes])
        centres = centres[np.argsort(centres.imag)]
        shifts += (centres - told[np.argsort(told.imag)]).tolist()
        bored = 0.0
        for ring in holes:
            sides = np.column_stack((ring, np.roll(ring, -1)))
            apothem = np.abs(sides.mean(axis=1) - ring.mean())
            assert apothem.min() >= DOWEL / 2 - 1e-9
            assert np.abs(ring - ring.mean()).max() <= DOWEL / 2 + 0.01
            bored += abs(float((sides[:, 0].conj() * sides[:, 1]).imag.sum())) / 2
        share = CELL**2 / 4 - bored
        assert solid.volume() == pytest.approx(share * HEIGHT / SHEETS, rel=1e-9)
    assert np.abs(np.array(shifts) - shifts[0]).max() < 1e-6
