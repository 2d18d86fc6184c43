"""The tables of docs/groups.md: what follows from the groups' operations and symmetry elements; nothing is measured."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from shapely import LineString, Point, Polygon
from shapely.ops import polygonize, unary_union

from voronoi_tiles import GROUPS, Lattice, WallpaperGroup
from voronoi_tiles.groups.symmetry_elements import Line, placed, symmetry_elements

PAGE = Path(__file__).parents[1] / "groups.md"

AREA = 100.0
"""The area of every tile; square units."""

_RATIO = 0.85
_ANGLE = 75.0


def cell_of(group: WallpaperGroup) -> dict[str, float]:
    """The sides, and the angle, of a cell in which a tile of a site in general position has the area AREA."""
    whole = AREA * group.order
    match group.system:
        case "square":
            return {"a": whole**0.5}
        case "hexagonal":
            return {"a": (whole / np.sqrt(0.75)) ** 0.5}
        case "rectangular":
            a = (whole / _RATIO) ** 0.5
            return {"a": a, "b": _RATIO * a}
        case "oblique":
            a = (whole / (_RATIO * np.sin(np.radians(_ANGLE)))) ** 0.5
            return {"a": a, "b": _RATIO * a, "angle": _ANGLE}


def determinant(linear: tuple[int, int, int, int]) -> int:
    """Whether a linear part turns (1) or mirrors (-1)."""
    return linear[0] * linear[3] - linear[1] * linear[2]


class Facts(NamedTuple):
    """What follows from a group's operations, for a site in general position.

    `turns` and `flips` are how many ways a piece lies unturned and turned over; `chamber` is what the mirrors cut the
    plane into (None: no mirrors, "strip", or the number of a polygon's corners) and `tiles` how many tiles it holds;
    `fixed` is the length on mirrors of each tile's outline, in sides of the cell where that is short to say.
    """

    name: str
    system: str
    order: int
    turns: int
    flips: int
    centres: dict[int, int]
    mirrors: int
    glides: int
    chamber: str | None
    tiles: int | None


def facts(name: str) -> Facts:
    """What follows from a group's operations."""
    group = GROUPS[name]
    elements = symmetry_elements(group)
    ways = {operation.linear for operation in group.operations}
    orders = [centre.order for centre in elements.centres]
    chamber, tiles = _chamber(group)
    return Facts(
        name,
        group.system,
        group.order,
        sum(determinant(w) == 1 for w in ways),
        sum(determinant(w) == -1 for w in ways),
        {order: orders.count(order) for order in sorted(set(orders), reverse=True)},
        len(elements.mirrors),
        len(elements.glides),
        chamber,
        tiles,
    )


_SHAPES = {3: "triangle", 4: "rectangle"}


def _chamber(group: WallpaperGroup) -> tuple[str | None, int | None]:
    """What the mirrors enclose, and how many tiles of general sites it holds."""
    elements = symmetry_elements(group)
    if not elements.mirrors:
        return None, None
    if len({line.direction for line in elements.mirrors}) == 1:
        return "strip", None
    lattice = group.lattice(**cell_of(group))
    side = 2.5 * abs(lattice.a)
    lines = placed(elements, lattice, (-side, -side, side, side)).mirrors
    cells = list(polygonize(unary_union([LineString([(z.real, z.imag) for z in ends]) for ends in lines])))
    chamber = min(cells, key=lambda cell: cell.distance(Point(0.31, 0.17)))
    corners = len(chamber.simplify(1e-6).exterior.coords) - 1
    return _name(chamber, corners), round(chamber.area / (lattice.det / group.order))


def _name(chamber: Polygon, corners: int) -> str:
    """The name of a triangle or a rectangle, by its sides."""
    points: NDArray[np.float64] = np.array(chamber.simplify(1e-6).exterior.coords)
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    equal = bool(np.ptp(lengths) < 1e-6 * lengths.max())
    if corners == 4:
        return "square" if equal else "rectangle"
    if equal:
        return "equilateral triangle"
    ratio = sorted(lengths / lengths.max())
    return "right triangle, 45° and 45°" if abs(ratio[0] - ratio[1]) < 1e-6 else "right triangle, 30° and 60°"


def decision_table() -> str:
    """The table for makers, as Markdown: a row for each group."""
    rows = [
        "| group | cell | copies in a cell | ways to lie | turned over | the mirrors leave | the outline |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in GROUPS:
        f = facts(name)
        rows.append(
            f"| [{name}](#{name}) | {f.system} | {f.order} | {f.turns + f.flips} | {f.flips or 'none'} | "
            f"{_left(f)} | {_free(f)} |"
        )
    return "\n".join(rows) + "\n"


def _left(f: Facts) -> str:
    if f.chamber is None:
        return "everything"
    if f.chamber == "strip":
        return "strips"
    return f"{f.chamber}s" if "," not in f.chamber else f.chamber.replace("triangle", "triangles")


def _free(f: Facts) -> str:
    if f.chamber is None:
        return "free"
    if f.chamber == "strip":
        return "straight on the mirrors, free between them"
    if f.tiles == 1:
        return "fixed: it is that polygon"
    return f"{f.tiles} copies make one of them; free where they meet inside"


def centre_table() -> str:
    """The table of rotation centres in a cell, as Markdown."""
    rows = ["| group | half turns | thirds | quarters | sixths |", "|---|---|---|---|---|"]
    for name in GROUPS:
        counts = facts(name).centres
        if counts:
            rows.append(f"| {name} | " + " | ".join(str(counts.get(order, "")) for order in (2, 3, 4, 6)) + " |")
    return "\n".join(rows) + "\n"


def mirror_table() -> str:
    """How much of each tile's outline lies on mirrors, as Markdown, for sites in general position.

    Each point of a mirror borders two tiles, and all tiles have the same share: twice the mirrors' length in a cell
    over the number of copies.
    """
    rows = ["| group | in each tile's outline, on mirrors |", "|---|---|"]
    for name, group in GROUPS.items():
        lines = symmetry_elements(group).mirrors
        if lines:
            length = " + ".join(_lengths(group, [line.direction for line in lines]))
            rows.append(f"| {name} | {length} |")
    return "\n".join(rows) + "\n"


def _lengths(group: WallpaperGroup, directions: list[tuple[int, int]]) -> list[str]:
    """Twice the lines' lengths in a cell over the copies, by their length in sides of the cell."""
    lattice = group.lattice(**cell_of(group))
    total: dict[str, Fraction] = {}
    for p, q in directions:
        along = abs(p * lattice.a + q * lattice.b)
        symbol = _symbol(along, lattice, fixes_b=group.fixes_b)
        total[symbol] = total.get(symbol, Fraction(0)) + Fraction(2, group.order)
    return [symbol if share == 1 else f"{share} {symbol}" for symbol, share in total.items()]


def _symbol(length: float, lattice: Lattice, *, fixes_b: bool) -> str:
    """A length in terms of the cell's sides."""
    a, b = abs(lattice.a), abs(lattice.b)
    known = {"a": a, "√2 a": 2**0.5 * a, "√3 a": 3**0.5 * a} if fixes_b else {"a": a, "b": b}
    return next(symbol for symbol, value in known.items() if abs(length - value) < 1e-9 * a)


_TURNS = {6: "sixths", 4: "quarters", 3: "thirds", 2: "half turns"}


def element_table() -> str:
    """Where centres, mirrors and glide lines lie in a cell, as Markdown, in fractional coordinates."""
    rows = ["| group | centres | mirrors | glide lines |", "|---|---|---|---|"]
    for name, group in GROUPS.items():
        elements = symmetry_elements(group)
        centres = []
        for order, turns in _TURNS.items():
            places = [f"({centre.x}, {centre.y})" for centre in elements.centres if centre.order == order]
            centres += [f"{turns}: {', '.join(places)}"] if places else []
        cells = ("<br>".join(centres), _equations(elements.mirrors), _equations(elements.glides))
        rows.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(rows) + "\n"


def _equations(lines: tuple[Line, ...]) -> str:
    """Equations of lines in fractional coordinates, those of one direction together."""
    found: dict[str, set[Fraction]] = {}
    for line in lines:
        p, q = line.direction
        # Of the two signs that the equation q x - p y = offset can have, the one where x, or else y, counts up.
        sign = -1 if (q, -p) < (0, 0) else 1
        found.setdefault(_linear(sign * q, -sign * p), set()).add(sign * line.offset % 1)
    return "<br>".join(f"{left} = {', '.join(map(str, sorted(offsets)))}" for left, offsets in found.items())


def _linear(m: int, n: int) -> str:
    """The term m x + n y, as it is written; m > 0, or m = 0 and n > 0."""
    terms = [(abs(k), "-" if k < 0 else "+", name) for k, name in ((m, "x"), (n, "y")) if k]
    text = " ".join(f"{sign} {'' if k == 1 else f'{k} '}{name}" for k, sign, name in terms)
    return text.removeprefix("+ ")


TABLES = {"decision": decision_table, "mirrors": mirror_table, "centres": centre_table, "elements": element_table}


def with_tables(page: str) -> str:
    """A page with its tables, between `<!-- table: NAME -->` and `<!-- end -->`, made anew."""
    for name, make in TABLES.items():
        begin, end = f"<!-- table: {name} -->\n", "<!-- end -->"
        head, found, rest = page.partition(begin)
        assert found, f"groups.md has no place for the table {name}"
        page = f"{head}{begin}\n{make()}\n{end}{rest.partition(end)[2]}"
    return page


def write() -> None:
    """Write the tables into the page."""
    PAGE.write_text(with_tables(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
