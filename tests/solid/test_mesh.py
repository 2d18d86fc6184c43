"""Triangle meshes: what they measure, and what is no solid."""

from __future__ import annotations

import numpy as np
import pytest

from voronoi_tiles.solid.mesh import TriangleMesh

CORNERS = np.array([[0.0, 0, 0], [3, 0, 0], [0, 4, 0], [0, 0, 5]])
TETRAHEDRON = TriangleMesh(CORNERS, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))


def test_a_tetrahedron_is_measured() -> None:
    """A sixth of the box, the areas of its faces, normals of length 1 that point outward."""
    assert TETRAHEDRON.volume == pytest.approx(10.0, rel=1e-15)
    assert TETRAHEDRON.areas == pytest.approx([6.0, 7.5, np.sqrt(36 + 56.25 + 100), 10.0])
    middle = CORNERS.mean(axis=0)
    outward = np.einsum("ij,ij->i", TETRAHEDRON.normals, TETRAHEDRON.corners.mean(axis=1) - middle)
    assert (outward > 0).all()
    assert np.linalg.norm(TETRAHEDRON.normals, axis=1) == pytest.approx(1.0)
    assert TETRAHEDRON.is_closed


def test_the_volume_keeps_its_digits_far_away() -> None:
    """It is measured from a vertex, not from the origin."""
    moved = TriangleMesh(CORNERS + 2.0**30, TETRAHEDRON.triangles)
    assert moved.volume == pytest.approx(10.0, rel=1e-15)


@pytest.mark.parametrize(
    "triangles",
    [
        TETRAHEDRON.triangles[:3],
        np.concatenate([TETRAHEDRON.triangles, TETRAHEDRON.triangles]),
        np.concatenate([TETRAHEDRON.triangles[:3], TETRAHEDRON.triangles[3:, ::-1]]),
        np.concatenate([TETRAHEDRON.triangles, [[0, 0, 1]]]),
        np.zeros((0, 3), np.intp),
    ],
    ids=["open", "twice", "one face turned over", "a triangle that is a line", "nothing"],
)
def test_what_is_not_closed_is_seen(triangles: np.ndarray) -> None:
    """Every side has to be there once in each direction."""
    assert not TriangleMesh(CORNERS, triangles).is_closed
