"""Directions that leave walls: the widest, those that slide along some, and none."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import voronoi_tiles as vt
from voronoi_tiles import TriangleMesh
from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.solid.free_directions import contacts, reliable, widest
from voronoi_tiles.solid.loft import lofted
from voronoi_tiles.vector.motion_codes import operation_of

X, Y, Z = np.eye(3)


def clearance(normals: Floats, direction: Floats) -> float:
    """By the sine of which angle a direction leaves the nearest wall."""
    return float(-(normals @ direction).max())


def test_a_corner_is_left_along_its_diagonal() -> None:
    """Three walls at right angles."""
    assert widest(-np.eye(3), floor=False) == pytest.approx(np.ones(3) / np.sqrt(3))


def test_between_walls_a_direction_slides() -> None:
    """Along what they have in common; where nothing is left, none does."""
    assert widest(np.array([X, -X, Y, -Y]), floor=True) == pytest.approx(Z)
    assert widest(np.array([X, -X]), floor=True) is not None
    slot = widest(np.array([X, -X, Z, -Z, -Y]), floor=True)
    assert slot == pytest.approx(Y)
    assert widest(np.array([X, -X, Y, -Y, Z]), floor=True) is None
    assert widest(np.array([X, -X, Y, -Y, Z]), floor=False) == pytest.approx(-Z)
    assert widest(np.array([X, -X, Y, -Y, Z, -Z]), floor=False) is None


def test_a_wedge_is_left_upward_and_a_dovetail_is_not() -> None:
    """Walls that lean out let a tile up, by as much as they lean; those that lean in let it down, where no floor is."""
    lean = np.radians(5)
    out = np.array([side * np.cos(lean) - Z * np.sin(lean) for side in (X, -X, Y, -Y)])
    best = widest(out, floor=True)
    assert best == pytest.approx(Z)
    assert best is not None
    assert clearance(out, best) == pytest.approx(np.sin(lean))
    assert widest(out * [1, 1, -1], floor=True) is None
    assert widest(out * [1, 1, -1], floor=False) == pytest.approx(-Z)


@pytest.mark.parametrize("seed", range(20))
def test_no_other_direction_is_wider(seed: int) -> None:
    """Of 20,000 random ones none leaves random walls by a wider angle, and where one leaves all, one is found."""
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(40, 3)) * rng.uniform(0.1, 1, 3) - [1.2, 0, 0]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    others = rng.normal(size=(20000, 3))
    others /= np.linalg.norm(others, axis=1, keepdims=True)
    for floor in (False, True):
        allowed = others[others[:, 2] >= 0] if floor else others
        most = float((-(normals @ allowed.T).max(axis=0)).max())
        found = widest(normals, floor=floor)
        if found is None:
            assert most < 1e-8
        else:
            assert clearance(normals, found) >= most - 1e-9
            assert np.linalg.norm(found) == pytest.approx(1)
            assert not floor or found[2] >= -1e-12


def test_a_turn_turns_the_direction() -> None:
    """Walls that are turned are left in the direction that is turned."""
    rng = np.random.default_rng(3)
    normals = np.concatenate((rng.normal(size=(9, 3)) * 0.3 - X, [Y, -Y]))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    best = widest(normals, floor=False)
    assert best is not None
    assert abs(best[1]) < 1e-9
    turn = Rotation.from_euler("xyz", [10, 120, 40], degrees=True).as_matrix()
    assert widest(normals @ turn.T, floor=False) == pytest.approx(turn @ best)


def test_contacts_are_all_walls_and_no_caps() -> None:
    """Each wall triangle of a loft is one copy's as well, and no other one's; bottoms and tops are nobody's."""
    solid = vt.Solid(20, layers=5, turn=60, about=9.5 + 5.5j)
    loft = lofted(vt.Design("p3", 40, vt.Site(vt.segment(5 + 3j, 14 + 8j)), solid=solid))
    (mesh,) = loft.meshes
    names = {name for level in loft.levels for ring in level.core.rings[0] for name in ring}
    touched = contacts(mesh, [loft.image(site, operation_of(code)) for site, code in names])
    flat = np.ptp(mesh.corners[:, :, 2], axis=1) == 0.0
    assert (np.sum(touched, axis=0) == np.where(flat, 0, 1)).all()
    apart = TriangleMesh(mesh.vertices + np.array([0, 0, 1e-12]), mesh.triangles)
    assert not contacts(mesh, [apart])[0].any()


def test_slivers_have_no_normal() -> None:
    """A triangle of a nanometre beside one of a millimetre."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 1e-9, 0]])
    assert reliable(TriangleMesh(points, np.array([[0, 1, 2], [0, 1, 3]]))).tolist() == [True, False]
