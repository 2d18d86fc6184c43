"""The table of the 17 groups, coordinate triplets, lattices and isometries."""

from __future__ import annotations

import cmath
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from voronoi_tiles.base.maps import UNITS, unit_at
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.groups.wallpaper import GROUPS, Lattice, WallpaperGroup

# Orders, and how many of the operations have which determinant and rotation order: International Tables, vol. A.
ORDERS = {
    "p1": 1, "p2": 2, "pm": 2, "pg": 2, "cm": 4, "pmm": 4, "pmg": 4, "pgg": 4, "cmm": 8,
    "p4": 4, "p4m": 8, "p4g": 8, "p3": 3, "p3m1": 6, "p31m": 6, "p6": 6, "p6m": 12,
}  # fmt: skip

every_group = pytest.mark.parametrize("group", GROUPS.values(), ids=GROUPS)


def lattice_of(group: WallpaperGroup) -> Lattice:
    """A lattice of the group's system with no symmetry beyond it."""
    return group.lattice(7.0, None if group.fixes_b else 4.3, 71.3)


def residues(group: WallpaperGroup) -> set[Operation]:
    """The group's operations up to lattice translations."""
    return {operation.reduced() for operation in group.operations}


def test_the_seventeen_in_their_order() -> None:
    """All names are there, in the order of the design file's documentation, with the orders of the tables."""
    assert " ".join(GROUPS) == "p1 p2 pm pg cm pmm pmg pgg cmm p4 p4m p4g p3 p3m1 p31m p6 p6m"
    assert {name: group.order for name, group in GROUPS.items()} == ORDERS


@every_group
def test_group_axioms(group: WallpaperGroup) -> None:
    """Identity first, no operation twice, closed under products and inverses."""
    assert group.operations[0].is_identity
    known = residues(group)
    assert len(known) == group.order
    for g in group.operations:
        assert g.inverse().reduced() in known
        assert (g @ g.inverse()).is_identity
        assert (g.inverse() @ g).is_identity
        for h in group.operations:
            assert (g @ h).reduced() in known


@every_group
def test_operations_preserve_the_lattice_and_distances(group: WallpaperGroup) -> None:
    """Each operation maps lattice points to lattice points (up to its own translation) and keeps distances."""
    lattice = lattice_of(group)
    for operation in group.operations:
        isometry = lattice.isometry(operation)
        assert isometry.a in UNITS
        assert isometry.conj == (operation.determinant == -1)
        w0, w1, w2, w3 = operation.linear
        for i, j in ((1, 0), (0, 1), (3, -2)):
            image = isometry(lattice.cartesian(i, j)) - isometry(0j)
            assert image == pytest.approx(lattice.cartesian(w0 * i + w1 * j, w2 * i + w3 * j), abs=1e-13)
        assert abs(isometry(1 + 2j) - isometry(4 - 1j)) == pytest.approx(abs(-3 + 3j), rel=1e-14)


def test_a_wrong_row_is_noticed() -> None:
    """The closure test is not vacuous: a table with one wrong sign fails it."""
    wrong = WallpaperGroup("p4", "square", tuple(map(Operation.parse, ("x,y", "-x,-y", "-y,x", "y,x"))))
    known = residues(wrong)
    assert any((g @ h).reduced() not in known for g in wrong.operations for h in wrong.operations)


def test_no_two_groups_are_the_same() -> None:
    """Groups of one system and order differ in their rotations, mirrors or glides."""

    def mirror(operation: Operation) -> bool:
        return operation.determinant == -1 and (operation @ operation).is_identity

    def fingerprint(group: WallpaperGroup) -> tuple[object, ...]:
        # A reflection has a mirror line if some lattice translation makes it an involution.
        shifts = [(i, j) for i in (-2, -1, 0, 1, 2) for j in (-2, -1, 0, 1, 2)]
        mirrors = sum(any(mirror(op.translated(*shift)) for shift in shifts) for op in group.operations)
        axes = sorted(op.linear for op in group.operations)
        return group.system, group.order, mirrors, tuple(axes)

    assert len({fingerprint(group) for group in GROUPS.values()}) == 17


@every_group
def test_triplets_round_trip(group: WallpaperGroup) -> None:
    """What an operation prints is what it is parsed from."""
    for operation in group.operations:
        for moved in (operation, operation.translated(3, -1), operation.inverse()):
            assert Operation.parse(str(moved)) == moved


@given(
    st.sampled_from([g for group in GROUPS.values() for g in group.operations]),
    st.fractions(max_denominator=60),
    st.fractions(max_denominator=60),
)
def test_any_translation_round_trips(operation: Operation, s: Fraction, t: Fraction) -> None:
    """Triplets hold every fraction exactly."""
    moved = Operation(operation.linear, (s, t))
    assert Operation.parse(str(moved)) == moved


@pytest.mark.parametrize(
    ("text", "canonical"),
    [
        ("x,y", "x,y"),
        (" -y , x - y ", "-y,x-y"),
        ("-x+1/2,y+1", "-x+1/2,y+1"),
        ("x-y+3/2,-y", "x-y+3/2,-y"),
        ("1/2+x, -1/4+y", "x+1/2,y-1/4"),
        ("y+x,-x", "x+y,-x"),
        ("x+2/4,y+0", "x+1/2,y"),
        ("-y+x,x", "x-y,x"),
    ],
)
def test_triplets_are_printed_canonically(text: str, canonical: str) -> None:
    """Variables first, x before y, fractions in lowest terms, no spaces."""
    assert str(Operation.parse(text)) == canonical


@pytest.mark.parametrize(
    "text",
    ["", "x", "x,y,z", "x,x", "x,0", "x y", "x,,y", "a,b", "x+1/0,y", "x+,y", "--x,y", "x*y,y", "x,2y", "x+.5,y"],
)
def test_other_texts_are_refused(text: str) -> None:
    """What is no triplet, or no operation of a lattice, is a ValueError."""
    with pytest.raises(ValueError, match="not a"):
        Operation.parse(text)


@given(st.text("xy+-,/0123 ", max_size=12))
def test_parsing_raises_nothing_else(text: str) -> None:
    """Near misses either parse or raise ValueError, and what parses prints and parses to the same."""
    try:
        operation = Operation.parse(text)
    except ValueError:
        return
    assert Operation.parse(str(operation)) == operation


def test_products_apply_the_right_factor_first() -> None:
    """g @ h is h, then g, in fractional coordinates and in the plane."""
    group = GROUPS["p4g"]
    lattice = lattice_of(group)
    for g in group.operations:
        for h in group.operations:
            one, two = lattice.isometry(g @ h)(0.3 + 2j), lattice.isometry(g)(lattice.isometry(h)(0.3 + 2j))
            assert one == pytest.approx(two, abs=1e-13)


def test_scalars_and_arrays_get_the_same_bits() -> None:
    """An isometry rounds a point in the same way whether it comes alone or in an array."""
    rng = np.random.default_rng(7)
    z = rng.normal(size=200) + 1j * rng.normal(size=200)
    for group in GROUPS.values():
        for operation in group.operations:
            isometry = lattice_of(group).isometry(operation.translated(5, -3))
            image = isometry(z)
            assert image.dtype == np.complex128
            assert [isometry(complex(point)) for point in z] == image.tolist()
            assert isometry(z[0]) == image[0]


def test_hexagonal_lattice_turns_by_120_degrees() -> None:
    """b is a turned by 120 degrees to the left; the cell's area is sqrt(3)/2 a^2."""
    lattice = GROUPS["p6"].lattice(2.0)
    assert (lattice.a, lattice.b) == (2 + 0j, complex(-1.0, math.sqrt(3.0)))
    assert lattice.det == pytest.approx(2.0 * math.sqrt(3.0), rel=1e-15)
    assert GROUPS["pm"].lattice(3.0, 7.0).det == 21.0
    oblique = GROUPS["p2"].lattice(3.0, 5.0, 30.0)
    assert oblique.det == pytest.approx(7.5, rel=1e-15)


def test_rotated_and_wrong_lattices() -> None:
    """A basis off the x axis is served too; an operation of another lattice is refused."""
    turn = cmath.rect(1.0, 0.7)
    lattice = Lattice(2.0 * turn, 2.0j * turn)
    mirror = lattice.isometry(Operation.parse("-x,y"))
    assert mirror(lattice.a) == pytest.approx(-lattice.a)
    assert mirror(lattice.b) == pytest.approx(lattice.b)
    with pytest.raises(ValueError, match="no isometry"):
        GROUPS["p1"].lattice(2.0, 3.0, 80.0).isometry(Operation.parse("-y,x"))
    with pytest.raises(ValueError, match="basis"):
        Lattice(1 + 0j, 2 + 0j)


@given(
    st.floats(0.01, 100.0),
    st.floats(0.01, 100.0),
    st.floats(1.0, 179.0),
)
def test_the_reduced_basis_is_a_shortest_basis(a: float, b: float, angle: float) -> None:
    """It spans the same lattice (same area, integer coordinates) and no combination of it is shorter."""
    lattice = GROUPS["p1"].lattice(a, b, angle)
    u, v = lattice.reduced_basis
    area = u.real * v.imag - u.imag * v.real
    assert area == pytest.approx(lattice.det, rel=1e-9)
    for w in (u, v):
        x = (w.real * lattice.b.imag - w.imag * lattice.b.real) / lattice.det
        y = (lattice.a.real * w.imag - lattice.a.imag * w.real) / lattice.det
        assert abs(x - round(x)) < 1e-6
        assert abs(y - round(y)) < 1e-6
    shortest = min(abs(i * u + j * v) for i in range(-3, 4) for j in range(-3, 4) if (i, j) != (0, 0))
    assert abs(u) <= shortest * (1 + 1e-12)
    assert abs(v) <= min(abs(v + k * u) for k in range(-3, 4)) * (1 + 1e-12)


def test_units() -> None:
    """Multiples of 30 degrees are exact, others to an ulp; whole turns do not matter."""
    for k, unit in enumerate(UNITS):
        assert unit_at(30.0 * k) == unit == unit_at(30.0 * k - 360.0) == unit_at(30.0 * k + 720.0)
        assert abs(unit - cmath.rect(1.0, math.radians(30.0 * k))) < 1e-15
        assert UNITS[(k + 6) % 12] == -unit
    assert unit_at(17.0) == pytest.approx(cmath.rect(1.0, math.radians(17.0)), rel=1e-15)
