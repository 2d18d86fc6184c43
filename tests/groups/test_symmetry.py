"""Symmetry elements: against the International Tables, and against the groups' operations in both directions."""

from __future__ import annotations

import cmath
import math
from collections import Counter
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.groups.symmetry_elements import Centre, Line, SymmetryElements, placed, symmetry_elements
from voronoi_tiles.groups.wallpaper import GROUPS, Lattice, WallpaperGroup

HALVES = "0,0 1/2,0 0,1/2 1/2,1/2"
QUARTERS = "1/4,1/4 3/4,1/4 1/4,3/4 3/4,3/4"
THIRDS = "1/3,2/3 2/3,1/3"
P4 = {4: "0,0 1/2,1/2", 2: "1/2,0 0,1/2"}
P6 = {6: "0,0", 3: THIRDS, 2: "1/2,0 0,1/2 1/2,1/2"}

UPRIGHT, UPRIGHT_BETWEEN = "x=0 x=1/2", "x=1/4 x=3/4"
LEVEL, LEVEL_BETWEEN = "y=0 y=1/2", "y=1/4 y=3/4"
DIAGONALS, DIAGONALS_BETWEEN = "x+y=0 x-y=0", "x+y=1/2 x-y=1/2"

# International Tables, vol. A: the diagrams of the plane groups' symmetry elements in the conventional cell.
# Name: rotation centres by order, mirror lines, glide lines (all glides are by half a lattice vector).
TABLES: dict[str, tuple[dict[int, str], str, str]] = {
    "p1": ({}, "", ""),
    "p2": ({2: HALVES}, "", ""),
    "pm": ({}, UPRIGHT, ""),
    "pg": ({}, "", UPRIGHT),
    "cm": ({}, UPRIGHT, UPRIGHT_BETWEEN),
    "pmm": ({2: HALVES}, f"{UPRIGHT} {LEVEL}", ""),
    "pmg": ({2: HALVES}, UPRIGHT_BETWEEN, LEVEL),
    "pgg": ({2: HALVES}, "", f"{UPRIGHT_BETWEEN} {LEVEL_BETWEEN}"),
    "cmm": ({2: f"{HALVES} {QUARTERS}"}, f"{UPRIGHT} {LEVEL}", f"{UPRIGHT_BETWEEN} {LEVEL_BETWEEN}"),
    "p4": (P4, "", ""),
    "p4m": (P4, f"{UPRIGHT} {LEVEL} {DIAGONALS}", DIAGONALS_BETWEEN),
    "p4g": (P4, DIAGONALS_BETWEEN, f"{UPRIGHT_BETWEEN} {LEVEL_BETWEEN} {DIAGONALS}"),
    "p3": ({3: f"0,0 {THIRDS}"}, "", ""),
    "p3m1": ({3: f"0,0 {THIRDS}"}, "x+y=0 2x-y=0 x-2y=0", "x+y=1/2 2x-y=1/2 x-2y=1/2"),
    "p31m": ({3: f"0,0 {THIRDS}"}, "x=0 y=0 x-y=0", "x=1/2 y=1/2 x-y=1/2"),
    "p6": (P6, "", ""),
    "p6m": (
        P6,
        "x=0 y=0 x-y=0 x+y=0 2x-y=0 x-2y=0",
        "x=1/2 y=1/2 x-y=1/2 x+y=1/2 2x-y=1/2 x-2y=1/2",
    ),
}

every_group = pytest.mark.parametrize("group", GROUPS.values(), ids=GROUPS)

LatticePoint = tuple[Fraction, Fraction]


def lattice_of(group: WallpaperGroup) -> Lattice:
    """A lattice of the group's system with no symmetry beyond it."""
    return group.lattice(7.0, None if group.fixes_b else 4.3, 71.3)


def equation(line: Line) -> str:
    """Write a line as the Tables do, up to lattice translations: "x=1/4", "2x-y=1/2"."""
    (p, q), (x, y) = line.direction, line.point
    a, b = (q, -p) if q > 0 else (-q, p)
    left = str(Operation((a, b, 0, 0), (Fraction(0), Fraction(0)))).split(",")[0]
    return f"{left}={(a * x + b * y) % 1}"


@every_group
def test_the_international_tables(group: WallpaperGroup) -> None:
    """Kinds, numbers and places of all elements of the 17 groups."""
    centres, mirrors, glides = TABLES[group.name]
    elements = symmetry_elements(group)
    assert sorted((f"{c.x},{c.y}", c.order) for c in elements.centres) == sorted(
        (point, order) for order, points in centres.items() for point in points.split()
    )
    assert sorted(map(equation, elements.mirrors)) == sorted(mirrors.split())
    assert sorted(map(equation, elements.glides)) == sorted(glides.split())
    assert {line.glide for line in elements.mirrors} <= {Fraction(0)}
    assert {line.glide for line in elements.glides} <= {Fraction(1, 2)}


def test_the_tables_are_all_there() -> None:
    """No two groups have the same elements, so no row stands for another."""
    assert list(TABLES) == list(GROUPS)
    assert len({symmetry_elements(group) for group in GROUPS.values()}) == 17


@every_group
def test_the_canonical_form(group: WallpaperGroup) -> None:
    """Coordinates in [0, 1), primitive directions of one sign, points on an axis, nothing twice, high orders first."""
    elements = symmetry_elements(group)
    for centre in elements.centres:
        assert 0 <= centre.x < 1
        assert 0 <= centre.y < 1
    lines = elements.mirrors + elements.glides
    for line in lines:
        p, q = line.direction
        x, y = line.point
        assert math.gcd(p, q) == 1
        assert (p, q) > (0, 0)
        on_axis, other = (x, y) if q else (y, x)
        assert 0 <= on_axis < 1
        assert other == 0
        assert line.offset == q * x - p * y
        assert 0 <= line.glide < 1
    assert len({(c.x, c.y) for c in elements.centres}) == len(elements.centres)
    assert len({(line.direction, line.offset % 1) for line in lines}) == len(lines)
    orders = [centre.order for centre in elements.centres]
    assert orders == sorted(orders, reverse=True)


def as_operation(lattice: Lattice, unit: complex, conj: bool, fixed: LatticePoint, shift: LatticePoint) -> Operation:
    """The operation whose Cartesian linear part is z -> unit z or unit conj(z), and which moves `fixed` by `shift`.

    Raises ValueError where the linear part does not preserve the lattice.
    """
    columns = []
    for vector in (lattice.a, lattice.b):
        image = unit * (vector.conjugate() if conj else vector)
        x = (image.real * lattice.b.imag - image.imag * lattice.b.real) / lattice.det
        y = (lattice.a.real * image.imag - lattice.a.imag * image.real) / lattice.det
        if max(abs(x - round(x)), abs(y - round(y))) > 1e-9:
            raise ValueError("not an operation of the lattice")
        columns.append((round(x), round(y)))
    (a, c), (b, d) = columns
    x0, y0 = fixed
    return Operation((a, b, c, d), (x0 - a * x0 - b * y0 + shift[0], y0 - c * x0 - d * y0 + shift[1]))


def operations_of(elements: SymmetryElements, lattice: Lattice) -> list[Operation]:
    """The rotation by 1/order of a turn about each centre, and the reflection with the glide of each line."""
    found = []
    for centre in elements.centres:
        turn = cmath.exp(2j * math.pi / centre.order)
        found.append(as_operation(lattice, turn, False, (centre.x, centre.y), (Fraction(0), Fraction(0))))
    for line in elements.mirrors + elements.glides:
        p, q = line.direction
        along = p * lattice.a + q * lattice.b
        shift = (p * line.glide, q * line.glide)
        found.append(as_operation(lattice, along / along.conjugate(), True, line.point, shift))
    return found


def strangers(elements: SymmetryElements, group: WallpaperGroup) -> int:
    """Count the elements whose operation is none of the group's."""
    known = {operation.reduced() for operation in group.operations}
    return sum(operation.reduced() not in known for operation in operations_of(elements, lattice_of(group)))


def moved(operation: Operation, x: Fraction, y: Fraction) -> LatticePoint:
    """The image of a point."""
    a, b, c, d = operation.linear
    return a * x + b * y + operation.translation[0], c * x + d * y + operation.translation[1]


def is_among(operation: Operation, elements: SymmetryElements) -> bool:
    """Whether an operation has its element; translations have none.

    A rotation leaves the mean of a point's images where it is: the centre, whose order is a multiple. The others leave
    the midpoints of points and their images on their line, and move them by the glide and whole lattice vectors.
    """
    if operation.linear == (1, 0, 0, 1):
        return True
    points = [(Fraction(0), Fraction(0)), (Fraction(1), Fraction(0)), (Fraction(1, 3), Fraction(5, 7))]
    if operation.determinant == 1:
        images = points[-1:]
        while (image := moved(operation, *images[-1])) != images[0]:
            images.append(image)
        x, y = (sum(values, Fraction(0)) / len(images) % 1 for values in zip(*images, strict=True))
        return any((c.x, c.y) == (x, y) and c.order % len(images) == 0 for c in elements.centres)
    middles = []
    for x, y in points:
        u, v = moved(operation, x, y)
        middles.append(((x + u) / 2, (y + v) / 2))
    (x, y), (u, v) = middles[0], moved(operation, *middles[0])
    for line in elements.mirrors + elements.glides:
        p, q = line.direction
        glide = (u - x) / p if p else (v - y) / q
        if (
            len({q * s - p * t for s, t in middles}) == 1
            and (q * x - p * y - line.offset).denominator == 1
            and (u - x, v - y) == (p * glide, q * glide)
            and (glide - line.glide).denominator == 1
        ):
            return True
    return False


def lacking(elements: SymmetryElements, group: WallpaperGroup) -> int:
    """Count the group's operations, with small lattice translations, that have no element."""
    return sum(
        not is_among(operation.translated(i, j), elements)
        for operation in group.operations
        for i, j in product(range(-2, 3), repeat=2)
    )


@every_group
def test_every_element_is_an_operation(group: WallpaperGroup) -> None:
    """Turning about each centre, reflecting in each mirror and gliding along each glide line are in the group."""
    assert strangers(symmetry_elements(group), group) == 0


@every_group
def test_every_operation_has_its_element(group: WallpaperGroup) -> None:
    """No rotation, reflection or glide of the group, translated by lattice vectors, lacks its centre or line."""
    assert lacking(symmetry_elements(group), group) == 0


def test_wrong_elements_are_noticed() -> None:
    """Both checks see elements of another group, a wrong order, a moved line, a wrong glide, and missing ones."""
    p4g = symmetry_elements(GROUPS["p4g"])
    assert strangers(symmetry_elements(GROUPS["p4m"]), GROUPS["p4g"]) > 0
    assert lacking(symmetry_elements(GROUPS["p4m"]), GROUPS["p4g"]) > 0
    half = Fraction(1, 2)
    too_high = SymmetryElements((Centre(half, Fraction(0), 4),), (), ())
    assert strangers(too_high, GROUPS["p4g"]) == 1
    for line in p4g.mirrors + p4g.glides:
        x, y = line.point
        for wrong in (
            Line((x + Fraction(1, 3), y + Fraction(1, 5)), line.direction, line.glide),
            Line(line.point, line.direction, line.glide + half),
        ):
            assert strangers(SymmetryElements((), (wrong,), ()), GROUPS["p4g"]) == 1
    for k in range(4):
        fewer = SymmetryElements(p4g.centres[:k] + p4g.centres[k + 1 :], p4g.mirrors, p4g.glides)
        assert lacking(fewer, GROUPS["p4g"]) > 0
    assert lacking(SymmetryElements(p4g.centres, p4g.mirrors[1:], p4g.glides), GROUPS["p4g"]) > 0
    assert lacking(SymmetryElements(p4g.centres, p4g.mirrors, p4g.glides[1:]), GROUPS["p4g"]) > 0


@pytest.mark.parametrize("basis", [(1, 0, 3, 1), (2, 1, 1, 1), (0, -1, 1, 0), (5, 2, 2, 1), (3, 4, 2, 3)])
@pytest.mark.parametrize("name", ["cmm", "pgg", "p4g", "p6m"])
def test_other_bases_of_the_same_lattice(name: str, basis: tuple[int, int, int, int]) -> None:
    """Nothing depends on the conventional cell: steep lines and moved origins have as many elements, and the same."""
    origin = (Fraction(1, 7), Fraction(-3, 5))
    change = Operation(basis, origin)
    group = GROUPS[name]
    operations = tuple(change @ operation @ change.inverse() for operation in group.operations)
    elements = symmetry_elements(WallpaperGroup(name, group.system, operations))
    usual = symmetry_elements(group)
    assert Counter(c.order for c in elements.centres) == Counter(c.order for c in usual.centres)
    assert {(c.x, c.y) for c in elements.centres} == {
        (x % 1, y % 1) for x, y in (moved(change, c.x, c.y) for c in usual.centres)
    }
    for lines, usual_lines in ((elements.mirrors, usual.mirrors), (elements.glides, usual.glides)):
        expected = set()
        for line in usual_lines:
            p, q = (
                int(new - old) for new, old in zip(moved(change, *map(Fraction, line.direction)), origin, strict=True)
            )
            p, q = (p, q) if (p, q) > (0, 0) else (-p, -q)
            x, y = moved(change, *line.point)
            expected.add(((p, q), (q * x - p * y) % 1, line.glide))
        assert {(line.direction, line.offset % 1, line.glide) for line in lines} == expected
        assert len(lines) == len(expected)


Rectangle = tuple[float, float, float, float]


def is_inside(z: complex, rectangle: Rectangle) -> bool:
    """Whether a point is in a rectangle or within rounding of it."""
    x0, y0, x1, y1 = rectangle
    return x0 - 1e-9 <= z.real <= x1 + 1e-9 and y0 - 1e-9 <= z.imag <= y1 + 1e-9


def all_centres(elements: SymmetryElements, lattice: Lattice, rectangle: Rectangle, reach: int) -> list[list[float]]:
    """Centres and orders by trying every lattice vector with coefficients up to `reach`."""
    tried = [
        (lattice.cartesian(centre.x + i, centre.y + j), centre.order)
        for centre in elements.centres
        for i, j in product(range(-reach, reach + 1), repeat=2)
    ]
    return [[z.real, z.imag, order] for z, order in tried if is_inside(z, rectangle)]


def all_pieces(lines: tuple[Line, ...], lattice: Lattice, rectangle: Rectangle, reach: int) -> list[list[float]]:
    """The pieces of lines by trying every image up to `reach`: between crossings with the rectangle's sides."""
    x0, y0, x1, y1 = rectangle
    pieces = []
    for line in lines:
        (p, q), (x, y) = line.direction, line.point
        along = p * lattice.a + q * lattice.b
        for k in range(-reach, reach + 1):
            start = lattice.cartesian(x + Fraction(k * q, p * p + q * q), y - Fraction(k * p, p * p + q * q))
            crossings = []
            if abs(along.real) > 1e-9:
                crossings += [start + (side - start.real) / along.real * along for side in (x0, x1)]
            if abs(along.imag) > 1e-9:
                crossings += [start + (side - start.imag) / along.imag * along for side in (y0, y1)]
            inside = [(z.real, z.imag) for z in crossings if is_inside(z, rectangle)]
            if inside and math.dist(min(inside), max(inside)) > 1e-6:
                pieces.append([*min(inside), *max(inside)])
    return pieces


def as_rows(pieces: Complexes) -> list[list[float]]:
    """The pieces with their ends in order, sorted."""
    assert pieces.shape == (len(pieces), 2)
    ends = [sorted((z.real, z.imag) for z in piece) for piece in pieces.tolist()]
    return sorted([*first, *last] for first, last in ends)


def assert_same(rows: list[list[float]], expected: list[list[float]]) -> None:
    """Compare rows of numbers, in any order, up to rounding, which may exchange the ends of upright pieces."""
    assert len(rows) == len(expected)
    if not rows:
        return
    one, other = np.array(rows), np.array(expected)
    apart = abs(one[:, None] - other).max(axis=2)
    if one.shape[1] == 4:
        apart = np.minimum(apart, abs(one[:, None] - other[:, [2, 3, 0, 1]]).max(axis=2))
    assert (apart < 1e-8).sum(axis=0).tolist() == (apart < 1e-8).sum(axis=1).tolist() == [1] * len(rows)


@every_group
@pytest.mark.parametrize("turn", [0.0, 0.3, math.pi / 2])
def test_elements_in_a_rectangle(group: WallpaperGroup, turn: float) -> None:
    """All images that trying every lattice vector finds, in cells that lie askew too, and no others."""
    usual, unit = lattice_of(group), cmath.rect(1.0, turn)
    lattice = Lattice(usual.a * unit, usual.b * unit)
    elements = symmetry_elements(group)
    for rectangle in ((-11.3, -9.1, 17.2, 8.7), (20.1, -33.3, 23.9, -12.9), (0.2, 0.3, 0.4, 0.5)):
        found = placed(elements, lattice, rectangle)
        assert found.centres.shape == found.orders.shape
        rows = [[z.real, z.imag, order] for z, order in zip(found.centres.tolist(), found.orders, strict=True)]
        assert_same(rows, all_centres(elements, lattice, rectangle, 12))
        assert_same(as_rows(found.mirrors), all_pieces(elements.mirrors, lattice, rectangle, 40))
        assert_same(as_rows(found.glides), all_pieces(elements.glides, lattice, rectangle, 40))


@given(st.floats(1.0, 30.0), st.floats(8.0, 172.0), st.tuples(*[st.floats(-20.0, 20.0)] * 2), st.floats(0.5, 30.0))
@settings(max_examples=50, deadline=None)
def test_flat_and_steep_cells(b: float, angle: float, corner: tuple[float, float], width: float) -> None:
    """Rows of lattice points that hardly meet the rectangle are no trouble: each has its whole range."""
    lattice = GROUPS["p2"].lattice(5.0, b, angle)
    x0, y0 = corner
    x1, y1 = x0 + width, y0 + 3.0
    found = placed(symmetry_elements(GROUPS["p2"]), lattice, (x0, y0, x1, y1)).centres
    rows = np.arange(math.floor(y0 / lattice.b.imag * 2) - 1, math.ceil(y1 / lattice.b.imag * 2) + 2)
    columns = np.arange(-1000, 1001)
    tried = (rows[:, None] * (lattice.b / 2) + columns * (lattice.a / 2)).ravel()
    for margin, least in ((-1e-9, True), (1e-9, False)):
        wide = (abs(tried.real - (x0 + x1) / 2) <= width / 2 + margin) & (abs(tried.imag - y0 - 1.5) <= 1.5 + margin)
        assert (len(found) >= wide.sum()) if least else (len(found) <= wide.sum())
    if len(found):
        apart = abs(found[:, None] - tried)
        assert apart.min(axis=1).max() < 1e-8
        assert len(set(apart.argmin(axis=1).tolist())) == len(found)


@pytest.mark.parametrize(("a", "b"), [(60.0, 40.0), (0.1, 7.3), (1e6 / 3.0, 0.7)])
@pytest.mark.parametrize(("i", "j"), [(0, 0), (-1, -2), (1000, -777)])
def test_the_border_belongs_to_the_rectangle(a: float, b: float, i: int, j: int) -> None:
    """A sheet of 3 x 2 cells shows the elements on its sides, exactly there, however its corners are rounded."""
    group = GROUPS["pmm"]
    x0, y0, x1, y1 = i * a, j * b, (i + 3) * a, (j + 2) * b
    found = placed(symmetry_elements(group), group.lattice(a, b), (x0, y0, x1, y1))
    assert len(found.centres) == 7 * 5
    assert (found.centres.real.min(), found.centres.real.max()) == (x0, x1)
    assert (found.centres.imag.min(), found.centres.imag.max()) == (y0, y1)
    upright = found.mirrors[found.mirrors[:, 0].real == found.mirrors[:, 1].real]
    level = found.mirrors[found.mirrors[:, 0].imag == found.mirrors[:, 1].imag]
    assert (len(upright), len(level), len(found.mirrors), len(found.glides)) == (7, 5, 12, 0)
    assert set(upright.imag.ravel().tolist()) == {y0, y1}
    assert set(level.real.ravel().tolist()) == {x0, x1}
    assert {x0, x1} <= set(upright.real.ravel().tolist())
    assert {y0, y1} <= set(level.imag.ravel().tolist())


@pytest.mark.parametrize("quarters", [1, 2, 3])
def test_the_border_of_a_turned_sheet(quarters: int) -> None:
    """Lines that run along the sides but for rounding are there in full, whatever they are turned by."""
    group, unit = GROUPS["pmm"], cmath.rect(1.0, quarters * math.pi / 2)
    usual = group.lattice(0.7, 4.1)
    lattice = Lattice(usual.a * unit, usual.b * unit)
    corners = [0.0, 30 * lattice.a + 20 * lattice.b]
    x0, x1 = sorted(round(corner.real, 12) for corner in corners)
    y0, y1 = sorted(round(corner.imag, 12) for corner in corners)
    found = placed(symmetry_elements(group), lattice, (x0, y0, x1, y1))
    assert len(found.centres) == 61 * 41
    lengths = abs(found.mirrors[:, 1] - found.mirrors[:, 0])
    sides = (82.0, 21.0)
    assert [np.count_nonzero(abs(lengths - side) < 1e-11) for side in sides] == [61, 41]
    assert len(found.mirrors) == 61 + 41


@pytest.mark.parametrize("basis", [(1, 0, 3, 1), (2, 1, 1, 1), (0, -1, 1, 0), (5, 2, 2, 1), (3, 4, 2, 3)])
@pytest.mark.parametrize("name", ["cmm", "pgg", "p4g", "p6m"])
def test_other_bases_have_their_elements_at_the_same_places(name: str, basis: tuple[int, int, int, int]) -> None:
    """What is in a rectangle does not depend on the basis that the group is written in."""
    group, (a, b, c, d) = GROUPS[name], basis
    change = Operation(basis, (Fraction(0), Fraction(0)))
    operations = tuple(change @ operation @ change.inverse() for operation in group.operations)
    usual = lattice_of(group)
    lattice = Lattice(d * usual.a - c * usual.b, a * usual.b - b * usual.a)
    rectangle = (-7.3, -5.1, 9.2, 11.9)
    one = placed(symmetry_elements(group), usual, rectangle)
    other = placed(symmetry_elements(WallpaperGroup(name, group.system, operations)), lattice, rectangle)
    assert_same([[z.real, z.imag] for z in other.centres], [[z.real, z.imag] for z in one.centres])
    assert_same(as_rows(other.mirrors), as_rows(one.mirrors))
    assert_same(as_rows(other.glides), as_rows(one.glides))


def test_lines_through_a_corner_have_no_piece() -> None:
    """Of the diagonals of a square cell those in it show, not those that touch its corners from outside."""
    group = GROUPS["p4m"]
    found = placed(symmetry_elements(group), group.lattice(60.0), (0.0, 0.0, 60.0, 60.0))
    sides = [[0, 0, 0, 60], [0, 0, 60, 0], [0, 60, 60, 60], [60, 0, 60, 60]]
    inside = [[0, 30, 60, 30], [30, 0, 30, 60], [0, 0, 60, 60], [0, 60, 60, 0]]
    assert as_rows(found.mirrors) == sorted(sides + inside)
    assert as_rows(found.glides) == [[0, 30, 30, 0], [0, 30, 30, 60], [30, 0, 60, 30], [30, 60, 60, 30]]


@every_group
def test_many_cells(group: WallpaperGroup) -> None:
    """A sheet of 100 x 100 cells has 10000 times the centres of one."""
    lattice, elements = lattice_of(group), symmetry_elements(group)
    side = 100.0 * math.sqrt(lattice.det)
    found = placed(elements, lattice, (-0.3 * side, -0.2 * side, 0.7 * side, 0.8 * side))
    for order in (2, 3, 4, 6):
        expected = 10_000 * sum(centre.order == order for centre in elements.centres)
        assert np.count_nonzero(found.orders == order) == pytest.approx(expected, rel=0.02)


def test_no_elements() -> None:
    """p1 has none: arrays of the usual shapes and types, without entries."""
    found = placed(symmetry_elements(GROUPS["p1"]), lattice_of(GROUPS["p1"]), (0.0, 0.0, 100.0, 100.0))
    assert (found.centres.shape, found.orders.shape) == ((0,), (0,))
    assert (found.mirrors.shape, found.glides.shape) == ((0, 2), (0, 2))
    assert {str(part.dtype) for part in (found.centres, found.mirrors, found.glides)} == {"complex128"}
    assert found.orders.dtype == np.intp


@pytest.mark.parametrize(
    "rectangle",
    [(0.0, 0.0, 0.0, 1.0), (0.0, 1.0, 1.0, 0.0), (0.0, math.nan, 1.0, 1.0), (-math.inf, 0.0, 1.0, 1.0)],
)
def test_what_is_no_rectangle_is_refused(rectangle: Rectangle) -> None:
    """Corners that coincide or are exchanged, and numbers that are none."""
    with pytest.raises(ValueError, match="not a rectangle"):
        placed(symmetry_elements(GROUPS["p4m"]), GROUPS["p4m"].lattice(1.0), rectangle)
