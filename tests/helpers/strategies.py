"""All random designs: one set of generators, drawn from by Hypothesis and by numpy's generator (`make fuzz`).

A generator takes a `Chance`, the source of its decisions, and a `Canvas`, the cell to draw in, and gives the sites
of a design. Most draw within the domain of one copy, so that few designs touch their copies; some cross its border
on purpose.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol, TypeVar

import numpy as np

from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.groups.wallpaper import GROUPS, Lattice

T = TypeVar("T")
Stroke = dict[str, Any]
Sites = list[list[Stroke]]

DOMAINS: dict[str, str] = {
    # Corners of one copy's domain, in twelfths of the cell.
    "p1": "0,0 12,0 12,12 0,12",
    "p2": "0,0 6,0 6,12 0,12",
    "pm": "0,0 6,0 6,12 0,12",
    "pg": "0,0 12,0 12,6 0,6",
    "cm": "0,0 6,0 6,6 0,6",
    "pmm": "0,0 6,0 6,6 0,6",
    "pmg": "0,0 3,0 3,12 0,12",
    "pgg": "0,0 6,0 6,6 0,6",
    "cmm": "0,0 3,0 3,6 0,6",
    "p4": "0,0 6,0 6,6 0,6",
    "p4m": "0,0 6,0 6,6",
    "p4g": "0,0 6,0 0,6",
    "p3": "0,0 6,0 8,4 4,8 0,6",
    "p3m1": "0,0 8,4 4,8",
    "p31m": "0,0 6,0 8,4 6,6",
    "p6": "0,0 6,0 8,4 6,6",
    "p6m": "0,0 6,0 8,4",
}
SPECIAL = (0.0, 1 / 4, 1 / 3, 1 / 2, 2 / 3, 3 / 4)
"""Fractional coordinates of rotation centres and mirrors."""


class Chance(Protocol):
    """Where the generators' decisions come from."""

    def real(self, low: float, high: float) -> float:
        """A number between two."""
        ...

    def whole(self, low: int, high: int) -> int:
        """An integer, both ends included."""
        ...

    def pick(self, options: Sequence[T]) -> T:
        """Choose one."""
        ...


class Dice:
    """Decisions of numpy's generator: many per second."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng

    def real(self, low: float, high: float) -> float:
        """A number between two."""
        return float(low + (high - low) * self._rng.random())

    def whole(self, low: int, high: int) -> int:
        """An integer, both ends included."""
        return int(self._rng.integers(low, high, endpoint=True))

    def pick(self, options: Sequence[T]) -> T:
        """Choose one."""
        return options[int(self._rng.integers(len(options)))]


class Drawn:
    """Decisions of Hypothesis, which shrinks them: numbers are millionths of the way, so that simple ones are round."""

    def __init__(self, draw: Callable[[Any], Any]) -> None:
        self._draw = draw

    def real(self, low: float, high: float) -> float:
        """A number between two."""
        return low + (high - low) * float(self.whole(0, 10**6)) / 1e6

    def whole(self, low: int, high: int) -> int:
        """An integer, both ends included."""
        from hypothesis import strategies as st

        return int(self._draw(st.integers(low, high)))

    def pick(self, options: Sequence[T]) -> T:
        """Choose one."""
        return options[self.whole(0, len(options) - 1)]


@dataclass(frozen=True)
class Canvas:
    """A group and the cell to draw in; lengths are in the design's units."""

    group: str
    cell: dict[str, float]

    @property
    def lattice(self) -> Lattice:
        """The lattice of the cell."""
        return GROUPS[self.group].lattice(self.cell["a"], self.cell.get("b"), self.cell.get("angle"))

    @property
    def size(self) -> float:
        """The side of a square as large as the cell: the scale to draw at."""
        return math.sqrt(self.lattice.det)

    def corners(self) -> list[complex]:
        """The corners of the domain of one copy."""
        pairs = (pair.split(",") for pair in DOMAINS[self.group].split())
        return [self.lattice.cartesian(float(x) / 12, float(y) / 12) for x, y in pairs]

    def centre(self) -> complex:
        """The middle of the domain."""
        corners = self.corners()
        return sum(corners) / len(corners)

    def inradius(self) -> float:
        """How far the middle is from the domain's border."""
        corners, centre = self.corners(), self.centre()
        sides = zip(corners, corners[1:] + corners[:1], strict=True)
        return min(abs(((q - p).conjugate() * (centre - p)).imag) / abs(q - p) for p, q in sides)

    def spot(self, chance: Chance, fill: float = 0.9) -> complex:
        """A point of the domain, shrunk by `fill` about its middle."""
        corners = self.corners()
        k = chance.whole(1, len(corners) - 2)
        u, v = chance.real(0.0, 1.0), chance.real(0.0, 1.0)
        if u + v > 1.0:
            u, v = 1.0 - u, 1.0 - v
        z = corners[0] + u * (corners[k] - corners[0]) + v * (corners[k + 1] - corners[0])
        return self.centre() + fill * (z - self.centre())

    def stabilizer(self, place: complex) -> list[Isometry]:
        """The isometries of the group that leave a place where it is, the identity first."""
        lattice, found = self.lattice, []
        for operation in GROUPS[self.group].operations:
            away = place - lattice.isometry(operation)(place)
            x = (away.real * lattice.b.imag - away.imag * lattice.b.real) / lattice.det
            y = (lattice.a.real * away.imag - lattice.a.imag * away.real) / lattice.det
            if abs(x - round(x)) + abs(y - round(y)) < 1e-9:
                found.append(lattice.isometry(operation.translated(round(x), round(y))))
        return found


def canvas(chance: Chance, group: str, size: float = 60.0, aspect: float = 2.0, tilt: float = 50.0) -> Canvas:
    """A cell for a group: sides up to `aspect` apart, the angle up to `tilt` degrees from a right one."""
    kind = GROUPS[group]
    cell = {"a": size}
    if not kind.fixes_b:
        cell["b"] = size * chance.pick((1.0, aspect ** chance.real(-1.0, 1.0)))
    if kind.fixed_angle is None:
        cell["angle"] = chance.pick((90.0, 60.0, 90.0 + chance.real(-tilt, tilt), 90.0 + chance.real(-tilt, tilt)))
    return Canvas(group, cell)


# --- strokes -------------------------------------------------------------------------------------------------


def xy(z: complex) -> list[float]:
    """A point as the design file writes it."""
    return [float(z.real), float(z.imag)]


def _apart(points: Sequence[complex], least: float) -> list[complex]:
    """Move points that are too near to an earlier one a little, each another way."""
    kept: list[complex] = []
    for k, z in enumerate(points):
        moved = z
        for attempt in range(1, 50):
            if all(abs(moved - other) >= least for other in kept):
                break
            moved = z + least * attempt * cmath.rect(1.3, 2.4 * (attempt + k))
        kept.append(moved)
    return kept


def segment(*ends: complex) -> Stroke:
    """A segment, or a polyline where there are more than two points."""
    return {"segment" if len(ends) == 2 else "polyline": [xy(z) for z in ends]}


def closed(corners: Sequence[complex]) -> Stroke:
    """A closed polyline."""
    return {"polyline": [xy(z) for z in corners], "closed": True}


def path(points: Sequence[complex], size: float) -> Stroke:
    """SVG path data through four points or more: every command of it once in a while."""
    p = [f"{z.real!r},{z.imag!r}" for z in points]
    more = [
        f"C {p[1]} {p[2]} {p[3]}",
        f"Q {p[1]} {p[2]} T {p[3]}",
        f"L {p[1]} Q {p[2]} {p[3]}",
        f"H {points[1].real!r} V {points[2].imag!r} L {p[3]}",
        f"S {p[1]} {p[2]} L {p[3]} Z",
        f"A {0.2 * size!r} {0.1 * size!r} 30 0 1 {p[3]}",
    ]
    return {"path": f"M {p[0]} {more[int(abs(points[0]) * 1e3 / size) % len(more)]}"}


STROKES = ("segment", "polyline", "closed", "bezier", "hermite", "catmull_rom", "bspline", "circle", "path", "point")


def stroke(chance: Chance, at: Callable[[], complex], size: float, kind: str | None = None) -> Stroke:
    """A stroke of a kind through points that `at` gives, which lie some `size` apart."""
    kind = kind or chance.pick(STROKES)
    counts = {"segment": (2, 2), "circle": (1, 1), "point": (1, 1), "polyline": (2, 6), "closed": (3, 6)}
    few, many = counts.get(kind, (4, 6))
    points = _apart([at() for _ in range(chance.whole(few, many))], 0.02 * size)
    shown = [xy(z) for z in points]
    more: dict[str, Any] = {}
    match kind:
        case "point":
            return {kind: shown[0]}
        case "path":
            return path(points, size)
        case "closed":
            return closed(points)
        case "bezier":
            # A chain that ends where it begins, or one piece.
            shown = [*shown, shown[0]] if len(shown) == 6 else shown[:4]
        case "hermite":
            more["tangents"] = [xy((z - points[0]) * 1.5) for z in points[2:4]]
            shown = shown[:2]
        case "catmull_rom":
            more = {"alpha": chance.pick((0.0, 0.5, 1.0)), "closed": chance.pick((False, True))}
        case "bspline":
            more["closed"] = chance.pick((False, True))
        case "circle":
            return {kind: shown[0], "radius": size * chance.pick((0.2, 0.1, 0.01))}
    return {kind: shown, **more}


def carried(chance: Chance, drawn: Stroke) -> Stroke:
    """A stroke drawn elsewhere, with the scale, rotation and translation that bring it back."""
    scale, turn = chance.pick((1.0, 2.0, -0.5, 1.7)), chance.pick((0.0, 90.0, 60.0, -17.0))
    shift = complex(chance.whole(-9, 9), chance.whole(-9, 9))
    kind = next(iter(drawn))
    if kind == "path":
        return {**drawn, "translate": [0.0, 0.0], "scale": 1.0}
    back = cmath.rect(1 / scale, -math.radians(turn))
    lone = kind in {"point", "circle"}
    points = [drawn[kind]] if lone else drawn[kind]
    moved = [xy((complex(*point) - shift) * back) for point in points]
    more: dict[str, Any] = {"scale": scale, "rotate": turn, "translate": xy(shift)}
    if kind == "hermite":
        more["tangents"] = [xy(complex(*tangent) * back) for tangent in drawn["tangents"]]
    if kind == "circle":
        more["radius"] = drawn["radius"] / abs(scale)
    return {**drawn, kind: moved[0] if lone else moved, **more}


# --- what is drawn -------------------------------------------------------------------------------------------


def plain(chance: Chance, on: Canvas, fill: float | None = None) -> Sites:
    """One to three strokes of any kind."""
    filled = chance.pick((0.95, 0.8, 0.4, 0.1)) if fill is None else fill
    strokes = []
    for _ in range(chance.pick((1, 1, 2, 3))):
        drawn = stroke(chance, lambda: on.spot(chance, filled), filled * on.inradius())
        strokes.append(carried(chance, drawn) if chance.whole(0, 4) == 0 else drawn)
    return [strokes]


def wild(chance: Chance, on: Canvas) -> Sites:
    """Strokes that leave the domain: long ones, and such as touch their copies."""
    return plain(chance, on, chance.pick((1.3, 1.8, 3.0)))


def grid(chance: Chance, on: Canvas) -> Sites:
    """Points of a grid: collinear, cocircular, parallel, at equal distances; some of them on centres and mirrors."""
    count, lattice = chance.pick((4, 6, 8, 12, 24, 60)), on.lattice
    inside = chance.pick((1.0, 1.0, 1.0001, 0.9))
    corners, centre = on.corners(), on.centre()
    sides = list(zip(corners, corners[1:] + corners[:1], strict=True))
    turn = 1.0 if ((corners[1] - corners[0]).conjugate() * (corners[2] - corners[0])).imag > 0 else -1.0
    spots = []
    for i in range(count + 1):
        for j in range(count + 1):
            z = lattice.cartesian(i / count, j / count)
            shrunk = centre + (z - centre) / inside
            depths = [turn * ((q - p).conjugate() * (shrunk - p)).imag / abs(q - p) for p, q in sides]
            if min(depths) > (-1e-6 if inside > 1.0 else 1e-6) * on.size:
                spots.append(z)
    if len(spots) < 4:
        return plain(chance, on)
    strokes = []
    for _ in range(chance.pick((1, 1, 2, 3, 4))):
        kind = chance.pick(("segment", "segment", "polyline", "closed", "point"))
        few, many = {"segment": (2, 2), "point": (1, 1), "polyline": (3, 5), "closed": (3, 4)}[kind]
        points: list[complex] = []
        for _ in range(chance.whole(few, many)):
            z = chance.pick(spots)
            if z not in points:
                points.append(z)
        if len(points) >= (3 if kind == "closed" else 2):
            strokes.append(closed(points) if kind == "closed" else segment(*points))
        else:
            strokes.append({"point": xy(points[0])})
    return [strokes]


def regular(centre: complex, radius: float, count: int, turn: float = 0.0) -> list[complex]:
    """The corners of a regular polygon, the first at `turn` degrees."""
    return [centre + cmath.rect(radius, math.radians(turn) + 2 * math.pi * k / count) for k in range(count)]


def polygon(chance: Chance, on: Canvas) -> Sites:
    """Regular polygons, stars and circles, about centres of symmetry and elsewhere."""
    special = on.lattice.cartesian(chance.pick(SPECIAL), chance.pick(SPECIAL))
    centre = chance.pick((special, on.centre(), on.spot(chance, 0.3)))
    radius = chance.pick((0.3, 0.6, 0.9)) * on.inradius()
    count, turn = chance.pick((3, 4, 5, 6, 8, 12)), chance.pick((0.0, 15.0, 30.0, 45.0, chance.real(0.0, 90.0)))
    corners = regular(centre, radius, count, turn)
    shape = chance.pick(("polygon", "star", "corners", "circle", "ring", "comb"))
    match shape:
        case "polygon":
            return [[closed(corners)]]
        case "star":
            return [[segment(centre, z) for z in corners]]
        case "corners":
            return [[{"point": xy(z)} for z in corners]]
        case "circle":
            return [[{"circle": xy(centre), "radius": radius}]]
        case "ring":
            return [[closed(corners), closed(regular(centre, radius / 2, count, turn))]]
        case _:
            return [[segment(z, z + (z - centre) / 2) for z in corners]]


def _about(chance: Chance, on: Canvas) -> tuple[list[Isometry], complex, float]:
    """The symmetries of a special place, the place, and how far to draw from it."""
    places = [on.lattice.cartesian(x, y) for x in SPECIAL for y in SPECIAL]
    place = chance.pick([z for z in places if len(on.stabilizer(z)) > 1] or places[:1])
    return on.stabilizer(place), place, on.size * chance.pick((0.05, 0.15, 0.3))


def special(chance: Chance, on: Canvas, error: float = 0.0) -> Sites:
    """Strokes with all their images about a centre or on a mirror: the group maps the site onto itself."""
    symmetries, place, reach = _about(chance, on)
    strokes: list[Stroke] = []
    for _ in range(chance.pick((1, 1, 2))):
        first = chance.pick((place, place + cmath.rect(reach * chance.real(0.1, 1.0), chance.real(0.0, 6.2))))
        points = [first]
        points += [place + cmath.rect(reach * chance.real(0.1, 1.0), chance.real(0.0, 6.2)) for _ in range(2)]
        points = _apart(points, 0.02 * reach)[: chance.pick((2, 2, 3))]
        strokes += [segment(*(symmetry(z) for z in points)) for symmetry in symmetries]
    if error:
        kind = next(iter(strokes[-1]))
        strokes[-1] = {kind: [[x + error, y] for x, y in strokes[-1][kind]]}
    return [strokes]


def nearly_special(chance: Chance, on: Canvas) -> Sites:
    """A symmetric site with one stroke a little out of place."""
    return special(chance, on, on.size * chance.pick((1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-11)))


def near(chance: Chance, on: Canvas) -> Sites:
    """Strokes that almost reach a centre, a mirror or their own copy: the gap is 1e-2 to 1e-9 of the cell."""
    symmetries, place, reach = _about(chance, on)
    gap = on.size * 10.0 ** -chance.whole(2, 9)
    toward = cmath.rect(1.0, chance.real(0.0, 6.2))
    if chance.whole(0, 2) or len(symmetries) == 1:
        # To a copy of its own start.
        lattice, operation = on.lattice, chance.pick(GROUPS[on.group].operations)
        if operation.is_identity:
            operation = operation.translated(1, 0)
        start = on.spot(chance)
        return [[segment(start, lattice.isometry(operation)(start) + gap * toward)]]
    first = place + gap * toward
    along = place + reach * cmath.rect(1.0, chance.real(0.0, 6.2))
    mirror = next((s for s in symmetries if s.conj), None)
    if mirror is not None and chance.whole(0, 1):
        # Along a mirror, on one side of it.
        axis = cmath.sqrt(mirror.a)
        first, along = (place + axis * (k * reach + 1j * gap) for k in (0.1, 1.0))
    return [[segment(first, along)]]


def scattered(chance: Chance, on: Canvas) -> Sites:
    """Strokes and a point beside their image under an operation: tiles with islands that touch them, or holes."""
    lattice, operation = on.lattice, chance.pick(GROUPS[on.group].operations)
    reach = 0.4 * on.inradius()
    first = on.spot(chance)
    strokes = [segment(first, first + reach * cmath.rect(chance.real(0.3, 2.0), chance.real(0.0, 6.2)))]
    away = reach * cmath.rect(chance.real(0.01, 1.0), chance.real(0.0, 6.2))
    return [[*strokes, {"point": xy(lattice.isometry(operation)(first + away))}]]


def parallel(chance: Chance, on: Canvas) -> Sites:
    """Segments that are nearly parallel or nearly in line."""
    p, q = _apart([on.spot(chance, 0.8), on.spot(chance, 0.8)], 0.1 * on.inradius())
    tilt = cmath.rect(1.0, 10.0 ** -chance.whole(2, 13))
    across = 1j * (q - p) * 10.0 ** -chance.whole(1, 8)
    match chance.whole(0, 3):
        case 0:
            return [[segment(p, q), segment(p + across, p + across + (q - p) * tilt)]]
        case 1:
            return [[segment(p, (p + q) / 2, (p + q) / 2 + (q - p) / 2 * tilt)]]
        case 2:
            middle = (p + q) / 2
            return [[segment(p, middle), segment(middle + (q - middle) / 8 * tilt, q)]]
        case _:
            return [[segment(p, q), {"point": xy((p + q) / 2 + across)}]]


def points(chance: Chance, on: Canvas) -> Sites:
    """Points alone: the ordinary Voronoi diagram."""
    count = chance.pick((1, 1, 2, 3, 8, 20))
    arrangement = chance.pick(("random", "grid", "special", "near"))
    if arrangement == "special":
        places = [on.lattice.cartesian(chance.pick(SPECIAL), chance.pick(SPECIAL)) for _ in range(1)]
    elif arrangement == "grid":
        places = [on.lattice.cartesian(chance.whole(1, 11) / 12, chance.whole(1, 11) / 12) for _ in range(count)]
    else:
        places = _apart([on.spot(chance) for _ in range(count)], 1e-3 * on.size)
    if arrangement == "near":
        places.append(places[0] + on.size * 10.0 ** -chance.whole(3, 9))
    places = list(dict.fromkeys(places))
    if chance.whole(0, 3) == 0:
        return [[{"point": xy(z)}] for z in places[:4]]
    return [[{"point": xy(z)} for z in places]]


def _within(chance: Chance, middle: complex, reach: float) -> complex:
    """A point in a ring about another."""
    return middle + cmath.rect(reach * chance.real(0.2, 1.0), chance.real(0.0, 6.2))


def several(chance: Chance, on: Canvas) -> Sites:
    """Two to four sites; sometimes one inside a closed curve of another."""
    count = chance.whole(2, 4)
    middles = [on.spot(chance, 0.8) for _ in range(count)]
    if chance.whole(0, 1):
        radius = 0.8 * on.inradius()
        ring = chance.pick(
            (closed(regular(on.centre(), radius, 5, 9.0)), {"circle": xy(on.centre()), "radius": radius})
        )
        inner = 0.5 * radius
        held = stroke(chance, lambda: on.centre() + cmath.rect(inner, chance.real(0.0, 6.2)), inner)
        return [[ring], [held]] if chance.whole(0, 1) else [[held], [ring]]
    middles = _apart(middles, 0.1 * on.inradius())
    least = min(abs(p - q) for k, p in enumerate(middles) for q in middles[:k])
    reach = 0.45 * min(least, on.inradius())
    return [[stroke(chance, partial(_within, chance, middle, reach), reach)] for middle in middles]


def long(chance: Chance, on: Canvas) -> Sites:
    """A polyline of 100 to 1,000 segments."""
    count, centre, radius = chance.pick((100, 200, 400, 1000)), on.centre(), 0.9 * on.inradius()
    t = np.linspace(0.0, 1.0, count + 1)
    match chance.whole(0, 3):
        case 0:
            z = centre + radius * (0.05 + t) / 1.05 * np.exp(2j * math.pi * chance.whole(2, 8) * t)
        case 1:
            z = centre + radius * 0.7 * ((2 * t - 1) + 1j * np.where(np.arange(count + 1) % 2, 1.0, -1.0))
        case 2:
            wave, wander = chance.real(1.0, 9.0), chance.real(0.1, 0.7)
            z = centre + radius * (0.7 * (2 * t - 1) + 1j * wander * np.sin(wave * 2 * math.pi * t))
        case _:
            walk = np.cumsum(np.exp(1j * np.cumsum(np.sin((np.arange(count + 1) + chance.real(0.0, 9.0)) ** 2))))
            walk -= walk.mean()
            z = centre + radius * walk / np.abs(walk).max()
    return [[segment(*(complex(p) for p in z))]]


def dense(chance: Chance, on: Canvas) -> Sites:
    """A curve that is flattened finely."""
    kind = chance.pick(("bezier", "catmull_rom", "bspline", "circle", "hermite"))
    return [[stroke(chance, lambda: on.spot(chance, 0.8), on.inradius(), kind)]]


def _mirror(chance: Chance, on: Canvas) -> tuple[Isometry, complex, complex] | None:
    """One of the group's reflections, a point on its axis and the direction of that; None where it has none."""
    places = [on.lattice.cartesian(x, y) for x in SPECIAL for y in SPECIAL]
    mirrors = [(found, place) for place in places for found in on.stabilizer(place) if found.conj]
    if not mirrors:
        return None
    mirror, place = chance.pick(mirrors)
    return mirror, place, cmath.sqrt(mirror.a)


def beside_mirror(chance: Chance, on: Canvas) -> Sites:
    """A segment that begins next to a mirror, or runs along it: the gap is 1e-4 to 1e-10 of the cell.

    Where another edge meets the mirror four copies meet, and two of them nearly touch.
    """
    chosen = _mirror(chance, on)
    if chosen is None:
        return near(chance, on)
    _, place, axis = chosen
    start = place + axis * on.size * complex(chance.real(-0.5, 0.5), 10.0 ** chance.real(-10.0, -4.0))
    along = chance.pick((axis, cmath.rect(1.0, chance.real(0.0, 6.2))))
    return [[segment(start, start + along * on.size * chance.real(0.05, 0.3))]]


def twins(chance: Chance, on: Canvas) -> Sites:
    """A site that the group maps nearly onto itself: its copies are pairs, or more, that are next to each other.

    By 1e-3 to 2e-11 of the cell: far away their distances do not differ, as far as rounding tells.
    """
    return special(chance, on, on.size * 10.0 ** chance.real(-10.7, -3.0))


def mirror_twins(chance: Chance, on: Canvas) -> Sites:
    """A segment and its image in a mirror, this a little out of place: by 1e-8 to 2e-11 of the cell.

    Elsewhere on the mirror tiles meet whose sites come in pairs.
    """
    chosen = _mirror(chance, on)
    if chosen is None:
        return twins(chance, on)
    mirror, place, axis = chosen
    start = place + axis * on.size * complex(chance.real(-0.5, 0.5), chance.real(0.003, 0.03))
    end = start + axis * on.size * cmath.rect(chance.real(0.003, 0.03), chance.real(0.1, 3.0))
    off = 1j * axis * on.size * 10.0 ** chance.real(-10.7, -8.0)
    return [[segment(start, end), segment(mirror(start) + off, mirror(end) + off)]]


def near_groups(chance: Chance, on: Canvas) -> Sites:
    """Two to four strokes, of one site or of several, each of which almost reaches a copy of itself or of another."""
    starts = _apart([on.spot(chance, 0.8) for _ in range(chance.whole(2, 4))], 0.1 * on.inradius())
    strokes = []
    for start in starts:
        operation = chance.pick(GROUPS[on.group].operations)
        if operation.is_identity:
            operation = operation.translated(*chance.pick(((1, 0), (0, 1), (-1, 1))))
        gap = on.size * cmath.rect(10.0 ** chance.real(-9.5, -4.0), chance.real(0.0, 6.2))
        end = on.lattice.isometry(operation)(chance.pick((start, chance.pick(starts)))) + gap
        # As a stroke along the whole way would cross others more often than not, or only its last part.
        share = chance.pick((0.0, 0.9))
        strokes.append(segment(start, start) if end == start else segment(start + share * (end - start), end))
        if share:
            strokes.append({"point": xy(start)})
    return [[drawn] for drawn in strokes] if chance.whole(0, 1) else [strokes]


def tiny_angles(chance: Chance, on: Canvas) -> Sites:
    """Strokes bent by next to nothing, and points nearly on a line or a circle: arcs that meet at tiny angles."""
    count, bend = chance.whole(3, 12), 10.0 ** chance.real(-9.0, -2.0)
    reach, turn = on.inradius() * chance.real(0.2, 0.9), cmath.rect(1.0, chance.real(0.0, 6.2))
    along = [2.0 * k / (count - 1) - 1.0 for k in range(count)]
    match chance.whole(0, 3):
        case 0:
            bent = [complex(t, bend * chance.real(-1.0, 1.0)) for t in along]
        case 1:
            bent = [complex(t, bend * t * t) for t in along]
        case 2:
            return [
                [{"point": xy(on.centre() + reach * turn * complex(t, bend * chance.real(-1.0, 1.0)))} for t in along]
            ]
        case _:
            ring = regular(0j, 1.0, count)
            return [
                [{"point": xy(on.centre() + reach * turn * z * (1.0 + bend * chance.real(-1.0, 1.0)))} for z in ring]
            ]
    return [[segment(*(on.centre() + reach * turn * z for z in bent))]]


def large(chance: Chance, on: Canvas) -> Sites:
    """Strokes longer than the cell, between their own copies: along a row of these or nearly so, straight or bent."""
    lattice = on.lattice
    way = chance.pick([(1, 0), (0, 1), (1, 1), (1, -1), (2, 1), (1, 2), (3, -1), (2, 3)])
    row = lattice.cartesian(*way)
    length = chance.pick((0.5, 0.9, 0.99, 0.999999, 1.5, 3.0))
    across = lattice.det / abs(row) * chance.pick((0.0, 0.01, 0.3, 0.9)) * 1j * row / abs(row)
    start = on.spot(chance)
    ends = (start, start + length / 2 * row + across * chance.real(-0.5, 0.5), start + length * row + across)
    return [[segment(*(ends if chance.whole(0, 1) else ends[::2]))]]


def crowd(chance: Chance, on: Canvas) -> Sites:
    """Five to thirty sites, of a short stroke or a point each; now and then one on a special place among them."""
    count = chance.pick((5, 8, 15, 30))
    middles = _apart([on.spot(chance) for _ in range(count)], 0.3 * on.inradius() / count)
    reach = 0.4 * min(abs(p - q) for k, p in enumerate(middles) for q in middles[:k])
    sites: Sites = []
    for middle in middles:
        tip = middle + reach * cmath.rect(chance.real(0.1, 1.0), chance.real(0.0, 6.2))
        sites.append([segment(middle, tip) if chance.whole(0, 1) else {"point": xy(middle)}])
    if chance.whole(0, 3) == 0:
        _, place, _ = _about(chance, on)
        sites.append([{"point": xy(place)}])
    return sites


KINDS: dict[str, tuple[Callable[[Chance, Canvas], Sites], int]] = {
    # kind: the generator and how often `make fuzz` takes it
    "plain": (plain, 14),
    "grid": (grid, 20),
    "polygon": (polygon, 10),
    "special": (special, 10),
    "nearly special": (nearly_special, 6),
    "near": (near, 8),
    "scattered": (scattered, 6),
    "parallel": (parallel, 8),
    "points": (points, 8),
    "several": (several, 8),
    "wild": (wild, 8),
    "units": (plain, 5),
    "skew": (plain, 7),
    "far": (grid, 5),
    "dense": (dense, 2),
    "long": (long, 1),
}
LATER: dict[str, tuple[Callable[[Chance, Canvas], Sites], int]] = {
    # Kinds that came later. They have numbers of their own, so that the design of a number stays what it was.
    "beside a mirror": (beside_mirror, 3),
    "twins": (twins, 3),
    "mirror twins": (mirror_twins, 2),
    "near groups": (near_groups, 3),
    "tiny angles": (tiny_angles, 3),
    "large": (large, 3),
    "thin": (plain, 2),
    "crowd": (crowd, 1),
}


def make_design(
    chance: Chance, kind: str | None = None, group: str | None = None, *, later: bool = False
) -> tuple[str, dict[str, Any]]:
    """A kind's name and a random design of this kind, or of any or any later one, as a mapping."""
    if kind is None:
        kind = chance.pick([name for name, (_, weight) in (LATER if later else KINDS).items() for _ in range(weight)])
    generate = (KINDS | LATER)[kind][0]
    skewed = [name for name, row in GROUPS.items() if not row.fixes_b]
    fitting = {"skew": skewed, "thin": skewed, "large": ["p1", "p1", "p2", "pg", "pm"]}
    group = group or chance.pick(fitting.get(kind, list(GROUPS)))
    size, aspect, tilt = 60.0, 2.0, 50.0
    if kind == "units":
        size = chance.pick((1e-6, 1e9, 10.0 ** chance.real(-6.0, 9.0)))
    if kind == "skew":
        aspect, tilt = chance.pick((10.0, 100.0, 1000.0)), 85.0
    on = canvas(chance, group, size, aspect, tilt)
    if kind in {"units", "skew"}:
        generate = chance.pick((plain, grid, points, several))
    if kind == "thin":
        on = Canvas(group, on.cell | {"b": size * chance.pick((1e-3, 1e3))})
        generate = chance.pick((plain, points, several, special, near, beside_mirror))
    sites = generate(chance, on)
    # Curves in 5 to 50 segments: most designs shall be cheap.
    fineness = 10.0 ** chance.real(-5.0, -4.0) if kind == "dense" else 10.0 ** chance.real(-3.3, -2.0)
    tolerance = fineness * min(on.size, on.inradius() * 4)
    if kind == "far":
        shift = on.lattice.cartesian(chance.whole(-5000, 5000), chance.whole(-5000, 5000))
        sites = [[{**drawn, "translate": xy(shift)} for drawn in strokes] for strokes in sites]
    design: dict[str, Any] = {"schema": 1, "group": group, "cell": on.cell}
    design["site"] = [{"tolerance": tolerance, "strokes": strokes} for strokes in sites]
    return kind, design


def designs(*kinds: str, group: str | None = None) -> Any:
    """A Hypothesis strategy of designs of some kinds (all but the slowest, if none is named)."""
    from hypothesis import strategies as st

    names = kinds or tuple(name for name in KINDS | LATER if name not in {"dense", "long"})

    @st.composite
    def build(draw: Callable[[Any], Any]) -> dict[str, Any]:
        chance = Drawn(draw)
        return make_design(chance, chance.pick(names), group)[1]

    return build()
