"""Solids that move along a line: whether they meet what stands, beside manifold3d at many distances."""

from __future__ import annotations

from typing import Any

import manifold3d
import numpy as np
import pytest
from helpers.swept import solid_of
from scipy.spatial.transform import Rotation

from voronoi_tiles import TriangleMesh
from voronoi_tiles.solid.sweeping import CONTACT, Sweeping

X, Z = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


def mesh_of(solid: Any) -> TriangleMesh:
    """The mesh of a solid of manifold3d."""
    mesh = solid.to_mesh64()
    return TriangleMesh(np.array(mesh.vert_properties[:, :3]), np.array(mesh.tri_verts, np.intp))


def block(low: list[float], high: list[float]) -> Any:
    """A box between two corners."""
    return manifold3d.Manifold.cube(tuple(np.subtract(high, low))).translate(tuple(low))


CUBE = mesh_of(block([0, 0, 0], [1, 1, 1]))


@pytest.mark.parametrize(
    ("low", "high", "met"),
    [
        ([2, 0, 0], [3, 1, 1], True),  # ahead
        ([-2, 0, 0], [-1, 1, 1], False),  # behind
        ([2, 1, 0], [3, 2, 1], False),  # beside: it slides past
        ([2, 1 - 1e-6, 0], [3, 2, 1], True),  # beside, but for a micrometre
        ([2, 1 - 1e-14, 0], [3, 2, 1], False),  # beside, but for rounding
        ([-1, 0, 0], [0, 1, 1], False),  # behind, touching
        ([1, 0, 0], [2, 1, 1], True),  # ahead, touching
        ([0, 0, 1], [9, 1, 2], False),  # above, touching
        ([900, 0.4, 0.4], [901, 0.6, 0.6], True),  # small, and far away
    ],
)
def test_a_cube_meets_what_is_ahead_of_it(low: list[float], high: list[float], met: bool) -> None:
    """At any distance; what it touches, or slides along, it does not meet."""
    assert Sweeping(CUBE, X).meets(mesh_of(block(low, high))) == met


def test_a_hook_is_caught() -> None:
    """A hook comes out of the ring that it is in upward alone; a wall that narrows lets it out as well."""
    hook = mesh_of(block([0, 0, 0], [4, 1, 2]) + block([3, 0, 0], [4, 4, 2]))
    bar = mesh_of(block([0, 1, 0], [3, 2, 2]))
    assert not Sweeping(hook, Z).meets(bar)
    assert Sweeping(hook, -X).meets(bar)
    assert not Sweeping(hook, X).meets(bar)
    assert Sweeping(hook, np.array([0.0, 1.0, 0.0])).meets(bar)
    leaning = np.array([0.001, 0.0, 1.0])
    assert not Sweeping(hook, leaning / np.linalg.norm(leaning)).meets(bar)
    assert Sweeping(hook, leaning * [-1, 1, 1] / np.linalg.norm(leaning)).meets(bar)


def jagged(rng: np.random.Generator) -> Any:
    """A solid of a few boxes that overlap, turned at random."""
    parts = [block(low.tolist(), (low + rng.uniform(0.5, 2.5, 3)).tolist()) for low in rng.uniform(0, 1, (4, 3))]
    whole = parts[0] + parts[1] + parts[2] + parts[3]
    return whole.rotate(tuple(rng.uniform(0, 360, 3)))


@pytest.mark.parametrize("seed", range(4))
def test_random_solids_meet_as_manifold3d_says(seed: int) -> None:
    """What is free has nothing in common with the other at 160 distances; what meets it has somewhere."""
    rng = np.random.default_rng(seed)
    one = jagged(rng)
    verdicts: list[bool] = []
    while len(verdicts) < 8:
        other = jagged(rng).translate(tuple(rng.uniform(-4, 4, 3)))
        if float((one ^ other).volume()) > 0.0:
            continue
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        met = Sweeping(mesh_of(one), direction).meets(mesh_of(other))
        common = (float((one.translate(tuple(direction * far)) ^ other).volume()) for far in np.linspace(0, 16, 160))
        assert met == any(volume > 1e-9 for volume in common)
        verdicts.append(met)
    assert len(set(verdicts)) == 2


@pytest.mark.parametrize("seed", range(6))
def test_turning_all_changes_nothing(seed: int) -> None:
    """Nor does a larger scale."""
    rng = np.random.default_rng(seed)
    one, other = (mesh_of(jagged(rng)) for _ in range(2))
    other = TriangleMesh(other.vertices + np.array([4, 0, 0]), other.triangles)
    turn, factor = Rotation.random(random_state=seed).as_matrix(), 37.0
    some = rng.normal(size=(12, 3))
    for direction in some / np.linalg.norm(some, axis=1, keepdims=True):
        met = Sweeping(one, direction).meets(other)
        turned = [TriangleMesh(factor * mesh.vertices @ turn.T, mesh.triangles) for mesh in (one, other)]
        assert Sweeping(turned[0], turn @ direction).meets(turned[1]) == met


def test_contact_is_what_rounding_leaves() -> None:
    """A slot as wide as what slides in it lets it out, in whatever direction it is cut; a narrower one does not."""
    turn = Rotation.from_euler("xyz", [20, 50, 70], degrees=True).as_matrix()
    bar = block([0, 0, 0], [1, 5, 1])
    for narrower, met in ((0.0, False), (1e-4 * CONTACT, False), (1e4 * CONTACT, True)):
        slot = block([-1, 0, -1], [2, 5, 2]) - block([narrower, -1, 0], [1, 6, 1])
        one, other = (TriangleMesh(mesh.vertices @ turn.T, mesh.triangles) for mesh in (mesh_of(bar), mesh_of(slot)))
        assert Sweeping(one, turn @ [0.0, 1.0, 0.0]).meets(other) == met
        assert Sweeping(one, turn @ [0.0, -1.0, 0.0]).meets(other) == met


def test_the_oracle_has_64_bits() -> None:
    """What has a millionth of a millionth in common with another solid is seen by manifold3d."""
    other = solid_of(mesh_of(block([1 - 1e-12, 0, 0], [2, 1, 1])))
    assert float((solid_of(CUBE) ^ other).volume()) == pytest.approx(1e-12, rel=1e-3)
