"""Pictures of solids: what is seen in each pixel, how it is shaded, and that they show the neighbours."""

from __future__ import annotations

import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from helpers.examples import tiling

from voronoi_tiles import ArgumentError, Design, SolidJob, SolidPiece, TriangleMesh, extrude
from voronoi_tiles.solid import solid_picture
from voronoi_tiles.solid.extrusion import surrounded
from voronoi_tiles.solid.solid_picture import picture
from voronoi_tiles.solid.visible import NOTHING, barycentric, seen


def test_the_nearest_triangle_is_seen() -> None:
    """Against shapely, which says what covers a pixel's middle, and the planes' depths; random triangles."""
    rng = np.random.default_rng(3)
    corners = rng.uniform(-5, 35, (40, 3, 3))
    found = seen(corners, 30, range(24))
    y, x = np.mgrid[:24, :30] + 0.5
    middles = shapely.points(x, y)
    shapes = shapely.polygons(corners[:, :, :2])
    best = np.full((24, 30), -np.inf)
    expected = np.full((24, 30), NOTHING)
    for k, shape in enumerate(shapes):
        weights = np.linalg.solve(np.vstack((corners[k, :, :2].T, np.ones(3))), [x.ravel(), y.ravel(), np.ones(x.size)])
        depth = (corners[k, :, 2] @ weights).reshape(24, 30)
        nearer = shapely.contains(shape, middles) & (depth > best)
        best[nearer], expected[nearer] = depth[nearer], k
    assert (found == expected).all()
    assert set(np.unique(found)) > {NOTHING, 0}


def test_triangles_side_by_side_leave_no_gap() -> None:
    """A square of 2,000 slivers is covered, and nothing beside it."""
    x = np.linspace(2.0, 18.0, 1001)
    low, high = np.column_stack((x, np.full(1001, 3.0))), np.column_stack((x, np.full(1001, 17.0)))
    flat = np.concatenate([np.stack((low[:-1], low[1:], high[1:]), 1), np.stack((low[:-1], high[1:], high[:-1]), 1)])
    found = seen(np.dstack((flat, np.zeros(flat.shape[:2]))), 20, range(20))
    covered = np.zeros((20, 20), bool)
    covered[3:17, 2:18] = True
    assert ((found != NOTHING) == covered).all()


def test_weights_are_those_of_the_corners() -> None:
    """They give the place back; a triangle that is a line has the same for all."""
    corners = np.array([[[0.0, 0, 1], [10, 0, 2], [0, 10, 4]], [[0, 0, 1], [1, 1, 1], [2, 2, 1]]])
    weights = barycentric(corners, np.array([0, 0, 1]), np.array([2.0, 0.0, 1.0]), np.array([3.0, 10.0, 1.0]))
    assert weights == pytest.approx(np.array([[0.5, 0.2, 0.3], [0, 0, 1], [1 / 3, 1 / 3, 1 / 3]]))


BOX = TriangleMesh(
    np.array([[x, y, z] for z in (0.0, 4.0) for y in (0.0, 10.0) for x in (0.0, 10.0)]),
    np.array(
        [
            *([0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4]),
            *([1, 3, 7], [1, 7, 5], [3, 2, 6], [3, 6, 7], [2, 0, 4], [2, 4, 6]),
        ]
    ),
)


def test_a_box_shows_three_faces_lines_and_a_shadow() -> None:
    """The top is the brightest and of the colour asked for; the ground is darker beside it, and not at the corners."""
    assert BOX.is_closed
    image = picture([SolidPiece("box", "box", 0, BOX)], ["#4080c0"], 300).astype(int)
    assert max(image.shape[:2]) == 300
    middle = image[image.shape[0] // 2 - 20, image.shape[1] // 2 - 10]
    assert middle == pytest.approx([64, 128, 192], abs=12)
    blue = image[(image[:, :, 2] > image[:, :, 0] + 40)]
    shades, counts = np.unique(blue, axis=0, return_counts=True)
    assert len(shades[counts > 400]) == 3
    assert (image.sum(axis=2) < 200).sum() > 150
    assert (image[[0, 0, -1, -1], [0, -1, 0, -1]] > 240).all()
    grey = (np.ptp(image, axis=2) < 12) & (image[:, :, 0] < 215) & (image[:, :, 0] > 120)
    assert grey.sum() > 500


def test_a_picture_is_drawn_in_strips(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is the same whatever their height, and takes less memory than all its points."""
    whole = picture([SolidPiece("box", "box", 0, BOX)], ["#4080c0"], 240)
    monkeypatch.setattr(solid_picture, "_STRIP", 40_000)
    tracemalloc.start()
    parts = picture([SolidPiece("box", "box", 0, BOX)], ["#4080c0"], 240)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert (parts == whole).all()
    assert peak < 3 * 8 * 9 * whole[:, :, 0].size


@pytest.mark.parametrize("name", ["p3", "pgg-crane"])
def test_the_neighbours_are_shown_apart(name: str) -> None:
    """One tile and all around it in three colours; none covers another, though they hook into each other."""
    model = surrounded(tiling(name), SolidJob(height=4))
    assert len(model.pieces) > 4
    assert len(model.colours) == 3
    boxes = [shapely.union_all(shapely.polygons(piece.mesh.corners[:, :, :2])) for piece in model.pieces]
    one, other = np.triu_indices(len(boxes), 1)
    assert shapely.distance(np.array(boxes)[one], np.array(boxes)[other]).min() > 0.5


HOLED = """
schema = 1
group = "p4"
cell = { a = 80 }
site = [
  { name = "egg", strokes = [{ segment = [[11, 14], [17, 18]] }] },
  { name = "bird", strokes = [{ catmull_rom = [[30, 4], [36, 12], [30, 20], [37, 30]] }] },
  { name = "moth", strokes = [{ circle = [14, 16], radius = 11 }] },
]
"""
"""A moth with an egg in it, beside a bird."""


@pytest.mark.parametrize(("first", "count"), [("egg", 9), ("bird", 10), ("moth", 9)])
def test_what_lies_in_a_hole_stays_there(first: str, count: int) -> None:
    """Each moth has its egg, whichever is the first tile; the others are as near as they can be."""
    design = Design.loads(HOLED)
    sites = sorted(design.sites, key=lambda site: site.name != first)
    model = surrounded(design.replace(sites=sites).tessellate(), SolidJob(height=4))
    assert len(model.pieces) == count
    faces: dict[str, list[Any]] = {name: [] for name in ("egg", "bird", "moth")}
    for piece in model.pieces:
        faces[piece.site].append(shapely.union_all(shapely.polygons(piece.mesh.corners[:, :, :2])))
    filled = [shapely.Polygon(moth.exterior) for moth in faces["moth"]]
    assert [sum(moth.contains(egg) for moth in filled) for egg in faces["egg"]] == [1] * len(filled)
    assert all(moth.intersection(egg).area < 1e-6 for moth in faces["moth"] for egg in faces["egg"])
    others = np.array([*filled, *faces["bird"]])
    one, other = np.triu_indices(len(others), 1)
    assert 0.5 < shapely.distance(others[one], others[other]).min() < 5
    assert np.ptp(model.bounds, axis=0).max() < 150


def test_a_picture_is_a_file(tmp_path: Path) -> None:
    """The same bytes each time."""
    model = extrude(tiling("p4m"), SolidJob(height=4))
    model.save(tmp_path / "a.png", size=150)
    model.save(tmp_path / "b.png", size=150)
    data = (tmp_path / "a.png").read_bytes()
    assert data == (tmp_path / "b.png").read_bytes()
    assert data.startswith(b"\x89PNG")
    assert int.from_bytes(data[16:20], "big") == 150


def test_a_size_is_for_a_picture(tmp_path: Path) -> None:
    """Elsewhere it is not passed over."""
    with pytest.raises(ArgumentError, match="`size` 77 is for a picture"):
        extrude(tiling("p4m")).save(tmp_path / "a.stl", size=77)
    assert not list(tmp_path.iterdir())


def test_the_smallest_picture_is_a_pixel() -> None:
    """The shorter side has one, too."""
    flat = TriangleMesh(BOX.vertices * np.array([1.0, 1.0, 0.1]), BOX.triangles)
    assert picture([SolidPiece("box", "box", 0, flat)], ["#000000"], 1).shape == (1, 1, 3)


@pytest.mark.parametrize("size", [0, 5000, 3.5, True, float("nan"), float("inf")])
def test_a_size_that_cannot_be_is_refused(size: Any) -> None:
    """With what to give."""
    with pytest.raises(ArgumentError, match="Give a number of pixels"):
        picture([SolidPiece("box", "box", 0, BOX)], ["#000000"], size)
