"""Meshes in single precision: what rounding takes away is left out of STL files, and what it spoils is refused."""

from __future__ import annotations

from pathlib import Path

import manifold3d
import numpy as np
import pytest
from helpers.examples import tiling

from voronoi_tiles import ArgumentError, SolidJob, SolidModel, SolidPiece, TriangleMesh, extrude
from voronoi_tiles.base.arrays import Floats


def prism(ring: list[complex], height: float, at: complex = 0j) -> TriangleMesh:
    """The prism over a convex ring, its caps fans."""
    n = len(ring)
    points = np.array(ring) + at
    vertices = np.array([[z.real, z.imag, up] for up in (0.0, height) for z in points])
    fan = [(0, k, k + 1) for k in range(1, n - 1)]
    walls = [(k, (k + 1) % n, n + (k + 1) % n) for k in range(n)] + [(k, n + (k + 1) % n, n + k) for k in range(n)]
    caps = [(a, c, b) for a, b, c in fan] + [(n + a, n + b, n + c) for a, b, c in fan]
    return TriangleMesh(vertices, np.array(caps + walls))


def model(mesh: TriangleMesh) -> SolidModel:
    """A model of one piece."""
    piece = SolidPiece("odd", "odd", 0, mesh)
    return SolidModel("odd", (piece,), ("#000000",), {}, {}, "")


def read(path: Path) -> Floats:
    """The corners of the triangles of an STL file, float64 (n, 3, 3)."""
    data = path.read_bytes()
    rows = np.frombuffer(data[84:], np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")]))
    assert len(rows) == int.from_bytes(data[80:84], "little")
    return np.asarray(rows["corners"], np.float64)


def as_solid(corners: Floats) -> manifold3d.Manifold:
    """What manifold3d makes of triangles whose equal corners are one."""
    points, number = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return manifold3d.Manifold(manifold3d.Mesh64(points, number.reshape(-1, 3).astype(np.uint64)))


# At 500 mm numbers in single precision are 3e-5 mm apart.
CLOSE = [0j, 10 + 0j, 10 + 1e-7j, 10 + 10j, 10j]


@pytest.mark.parametrize("at", [300 + 300j, 500 + 700j])
def test_triangles_that_vanish_are_left_out(at: complex, tmp_path: Path) -> None:
    """Of a side that is shorter than the numbers tell apart; the rest is closed, of the right volume, and has areas."""
    mesh = prism(CLOSE, 5.0, at)
    assert mesh.is_closed
    model(mesh).save(tmp_path / "a.stl")
    corners = read(tmp_path / "a.stl")
    assert len(corners) == len(mesh.triangles) - 4  # one of each cap, two of the wall
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.linalg.norm(crosses, axis=1).min() > 1e-3
    solid = as_solid(corners)
    assert solid.status() == manifold3d.Error.NoError
    assert solid.volume() == pytest.approx(500.0, rel=1e-5)


def test_near_the_origin_nothing_vanishes(tmp_path: Path) -> None:
    """There numbers have digits enough for the same prism, of which another corner is near the origin."""
    mesh = prism([0j, 1e-7 + 0j, 10 + 10j, 10j], 5.0)
    model(mesh).save(tmp_path / "a.stl")
    assert len(read(tmp_path / "a.stl")) == len(mesh.triangles)


@pytest.mark.parametrize(
    ("ring", "height", "at", "reason"),
    [
        ([0j, 10 + 0j, 10 + 10j, 10j], 1e-50, 0j, "it has 0 cubic millimetres"),  # a plate
        ([0j, 10 + 0j, 10 + 1e-6j, 1e-6j], 5.0, 500j, "it has 0 cubic millimetres"),  # a film
        ([0j, 10 + 0j, 10 + 1e-3j, 1e-3j], 5.0, 700j, "it has 0.048"),  # a foil
    ],
)
def test_what_is_no_solid_any_more_is_refused(
    ring: list[complex], height: float, at: complex, reason: str, tmp_path: Path
) -> None:
    """With the remedy, and nothing is written; 3MF has it."""
    odd = model(prism(ring, height, at))
    with pytest.raises(ArgumentError, match='single precision of STL makes no solid of "odd": ' + reason) as refusal:
        odd.save(tmp_path / "a.stl")
    assert refusal.value.remedy == "Write 3MF, which has all digits."
    assert list(tmp_path.iterdir()) == []
    odd.save(tmp_path / "a.3mf")


def test_what_touches_itself_by_rounding_is_refused(tmp_path: Path) -> None:
    """Two corners that come together along a side would make it one of four triangles."""
    apart = 1e-7
    left = prism([0j, 10 + 0j, 5 + 5j], 5.0, 500 + 500j)
    right = prism([5 + 5j + apart * 1j, 10 + 10j, 0 + 10j], 5.0, 500 + 500j)
    both = TriangleMesh(
        np.concatenate((left.vertices, right.vertices)),
        np.concatenate((left.triangles, right.triangles + len(left.vertices))),
    )
    assert both.is_closed
    with pytest.raises(ArgumentError, match="it touches itself where it did not"):
        model(both).save(tmp_path / "a.stl")


def test_a_sheet_is_written_as_it_is(tmp_path: Path) -> None:
    """Half a metre from the origin all triangles of a fine mesh are there, and each piece is a solid."""
    made = extrude(tiling("p3"), SolidJob(sheet="500x120mm", gap=1, accuracy=0.001))
    made.save(tmp_path / "a.stl")
    corners = read(tmp_path / "a.stl")
    ends = np.cumsum([len(piece.mesh.triangles) for piece in made.pieces])
    assert len(corners) == ends[-1]
    for piece, own in zip(made.pieces, np.split(corners, ends[:-1]), strict=True):
        solid = as_solid(own)
        assert solid.status() == manifold3d.Error.NoError
        assert solid.volume() == pytest.approx(piece.mesh.volume, rel=1e-5)
