"""Motions in arrays: what they do is what tuples of integers do, one by one."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

import voronoi_tiles as vt
from voronoi_tiles.vector.motion_codes import (
    IDENTITY_CODE,
    code_of,
    composed,
    encode,
    images,
    inverted,
    least_products,
    modulo,
    motion_of,
    reversing,
)
from voronoi_tiles.vector.motions import (
    IDENTITY,
    Action,
    Motion,
    compose,
    inverse,
    modulo_lattice,
    reverses_orientation,
)

FAR = 2**26 - 2


def some(action: Action) -> list[Motion]:
    """The general positions of a group, where they stand and moved by short and by long lattice vectors."""
    steps = [(0, 0), (-1, 2), (FAR, -FAR)]
    return [(*m[:4], m[4] + 2 * i, m[5] + 2 * j) for m, (i, j) in product(action.motions, steps)]


@pytest.fixture(params=vt.GROUPS)
def action(request: pytest.FixtureRequest) -> Action:
    """Each group on the lattice of its starter."""
    design = vt.starter(request.param)
    return Action(design.group, design.lattice)


@pytest.fixture(params=["compiled", "numpy"])
def kernels(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """The compiled kernels, and numpy alone."""
    if request.param == "compiled":
        request.getfixturevalue("compiled")
    else:
        monkeypatch.setenv("VORONOI_TILES_KERNELS", "numpy")


def test_codes_stand_for_motions_in_their_order(action: Action) -> None:
    """There and back, one by one and as rows; sorted codes are sorted motions."""
    motions = some(action)
    codes = encode(motions)
    assert codes.tolist() == [code_of(motion) for motion in motions]
    assert [motion_of(code) for code in codes.tolist()] == motions
    assert [motion_of(code) for code in np.sort(codes).tolist()] == sorted(motions)
    assert motion_of(IDENTITY_CODE) == IDENTITY


@pytest.mark.usefixtures("kernels")
def test_codes_compose_and_invert_as_motions_do(action: Action) -> None:
    """Every pair of a group's operations, and what turns the plane over."""
    motions = [motion for motion in some(action) if abs(motion[4]) < FAR]
    codes = encode(motions)
    pairs = composed(codes[:, None], codes).ravel()
    assert [motion_of(code) for code in pairs.tolist()] == [compose(a, b) for a, b in product(motions, motions)]
    outer, inner = codes.repeat(len(codes)), np.concatenate([codes] * len(codes))
    assert (composed(outer, inner) == pairs).all()
    assert [motion_of(code) for code in inverted(codes).tolist()] == [inverse(motion) for motion in motions]
    assert reversing(codes).tolist() == [reverses_orientation(motion) for motion in motions]


def test_motions_of_one_name_modulo_the_lattice_differ_by_a_lattice_vector(action: Action) -> None:
    """As many names as operations, and equal ones for the same operation moved."""
    motions = some(action)
    named = set(zip(modulo(encode(motions)).tolist(), map(modulo_lattice, motions), strict=True))
    assert len(named) == len({name for name, _ in named}) == len(action.motions)


@pytest.mark.usefixtures("kernels")
def test_least_products_are_those_of_tuples(action: Action) -> None:
    """Of each motion with one row of motions or another, or with none."""
    motions = [motion for motion in some(action) if abs(motion[4]) < FAR]
    rows = [[IDENTITY, motions[-1]], [motions[1], motions[len(motions) // 2]]]
    row = [k % 3 - 1 for k in range(len(motions))]
    found = least_products(encode(motions), np.array(row), encode([*rows[0], *rows[1]]).reshape(2, 2))
    expected = [min(compose(m, other) for other in rows[k]) if k >= 0 else m for m, k in zip(motions, row, strict=True)]
    assert [motion_of(code) for code in found.tolist()] == expected


@pytest.mark.usefixtures("kernels")
def test_images_have_the_bits_of_single_points(action: Action) -> None:
    """Whatever the place in the array; translations that come after may be of any length."""
    motions = [motion for motion in some(action) if abs(motion[4]) < FAR]
    points = np.random.default_rng(5).normal(0.0, 50.0, (len(motions), 2)) @ np.array([1, 1j])
    found = images(action, encode(motions), points).tolist()
    assert found == [action.apply_to_point(m, z) for m, z in zip(motions, points.tolist(), strict=True)]
    beyond = [(*m[:4], m[4] + 2**40, m[5]) for m in motions]
    found = images(action, encode(motions), points, (2**40, 0)).tolist()
    assert found == [action.apply_to_point(m, z) for m, z in zip(beyond, points.tolist(), strict=True)]
    # One motion of all points, and one point under all motions.
    code, point = encode(motions[-1:])[0], points[0]
    assert images(action, code, points).tolist() == [action.apply_to_point(motions[-1], z) for z in points.tolist()]
    assert images(action, encode(motions), point).tolist() == [action.apply_to_point(m, point) for m in motions]
