"""Random designs that stand, of all groups: strokes that turn, move, grow or become others on the way up."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.maps import Isometry

Random = np.random.Generator

HEIGHT: Final = 20.0
SPECIAL: Final = (0.0, 0.5, 1 / 3, 2 / 3, 0.25, 0.75)
"""Fractional coordinates of points that operations leave where they are, in some group."""


def _cell(rng: Random, group: vt.WallpaperGroup) -> dict[str, float]:
    cell = {"a": 40.0}
    if not group.fixes_b:
        cell["b"] = 40.0 * rng.uniform(0.7, 1.5)
    if group.fixed_angle is None:
        cell["angle"] = rng.uniform(60, 120)
    return cell


def _wave(rng: Random, centre: complex, size: float, segments: int) -> Complexes:
    """A wavy polyline about a point."""
    t = np.linspace(0, 1, segments + 1)
    high, phase = rng.uniform(-0.3, 0.3, 3), rng.uniform(0, 2 * np.pi, 3)
    bent = sum(high[k] * np.sin(3 * (k + 1) * t + phase[k]) for k in range(3))
    return np.asarray(centre + size * (t - 0.5 + 0.5j * bent) * np.exp(1j * rng.uniform(0, 2 * np.pi)))


def _within(rng: Random, size: float) -> complex:
    return size * complex(*rng.uniform(-1, 1, 2))


def one_stroke(rng: Random, lattice: vt.Lattice, group: vt.WallpaperGroup) -> tuple[list[vt.Site], dict[str, Any]]:
    """One site of 1 to 24 segments in a general position, which turns, moves, becomes another, or all but this."""
    base = np.sqrt(lattice.det / group.order) * rng.uniform(0.1, 0.8)
    centre = complex(rng.random() * lattice.a + rng.random() * lattice.b)
    segments = int(rng.integers(1, 25)) if rng.random() < 0.7 else 1
    site = vt.Site([vt.polyline(_wave(rng, centre, base, segments))])
    kind = rng.integers(4)
    if kind == 0:
        return [site], {"turn": float(rng.choice([45, 90, 180, -90, 30])), "about": centre}
    if kind == 1:
        return [site], {"shift": _within(rng, base)}
    if kind == 2:
        return [site], {"keys": [vt.Key(HEIGHT / rng.integers(1, 3), vt.polyline(_wave(rng, centre, base, segments)))]}
    grown = {"scale": float(rng.uniform(0.5, 1.5)), "turn": float(rng.uniform(-90, 90))}
    return [site], {**grown, "shift": _within(rng, base / 2), "about": centre}


def several_sites(rng: Random, lattice: vt.Lattice, group: vt.WallpaperGroup) -> tuple[list[vt.Site], dict[str, Any]]:
    """Two or three sites, some of which become others, while all may turn about a point."""
    base = np.sqrt(lattice.det / group.order)
    sites, keys = [], []
    for k in range(rng.integers(2, 4)):
        centre = complex(rng.random() * lattice.a + rng.random() * lattice.b)
        segments = int(rng.integers(1, 8))
        sites.append(vt.Site(vt.polyline(_wave(rng, centre, base * rng.uniform(0.05, 0.4), segments)), name=f"s{k}"))
        if rng.random() < 0.6:
            other = _wave(rng, centre + _within(rng, base / 5), base * rng.uniform(0.05, 0.4), segments)
            keys.append(vt.Key(HEIGHT, vt.polyline(other), site=f"s{k}"))
    turn = {"turn": float(rng.uniform(-60, 60)), "about": lattice.a / 3} if rng.random() < 0.4 else {}
    return sites, {"keys": keys, **turn}


def fixing(lattice: vt.Lattice, group: vt.WallpaperGroup, point: complex) -> list[Isometry]:
    """The isometries of a group that leave a point where it is."""
    found = []
    for operation in group.operations:
        isometry = lattice.isometry(operation)
        for i in range(-2, 3):
            for j in range(-2, 3):
                moved = Isometry(isometry.a, isometry.b + i * lattice.a + j * lattice.b, isometry.conj)
                if abs(moved(point) - point) < 1e-9 * abs(lattice.a):
                    found.append(moved)
    return found


def special_position(
    rng: Random, lattice: vt.Lattice, group: vt.WallpaperGroup
) -> tuple[list[vt.Site], dict[str, Any]]:
    """A site that operations map onto itself, at all heights; in groups that leave no point, any."""
    base = np.sqrt(lattice.det / group.order) * rng.uniform(0.1, 0.7)
    for _ in range(50):
        centre = complex(rng.choice(SPECIAL) * lattice.a + rng.choice(SPECIAL) * lattice.b)
        own = fixing(lattice, group, centre)
        if len(own) > 1:
            break
    segments = int(rng.integers(1, 6))
    low, high = (_wave(rng, centre + base * rng.uniform(0, 0.5), base, segments) for _ in range(2))
    site = vt.Site([vt.polyline(move(low)) for move in own])
    if rng.random() < 0.3 and not any(move.conj for move in own):
        return [site], {"turn": float(rng.choice([30, 45, 60, 90])), "about": centre}
    return [site], {"keys": [vt.Key(HEIGHT, [vt.polyline(move(high)) for move in own])]}


def apart(rng: Random, lattice: vt.Lattice, group: vt.WallpaperGroup) -> tuple[list[vt.Site], dict[str, Any]]:
    """A site of two or three strokes that do not meet: its tile may be in parts."""
    base = 0.6 * np.sqrt(lattice.det / group.order)
    centre = complex(rng.random() * lattice.a + rng.random() * lattice.b)
    segments = int(rng.integers(1, 4))
    middles = [centre + _within(rng, base / 2) for _ in range(rng.integers(2, 4))]
    site = vt.Site([vt.polyline(_wave(rng, at, 0.3 * base, segments)) for at in middles])
    if rng.random() < 0.5:
        return [site], {"turn": float(rng.uniform(-60, 60)), "about": centre}
    others = [vt.polyline(_wave(rng, at + _within(rng, base / 5), 0.3 * base, segments)) for at in middles]
    return [site], {"keys": [vt.Key(HEIGHT, others)]}


def ring(rng: Random, lattice: vt.Lattice, group: vt.WallpaperGroup) -> tuple[list[vt.Site], dict[str, Any]]:
    """A closed site with another one inside: the tile of the first has a hole."""
    radius = np.sqrt(lattice.det / group.order) * rng.uniform(0.15, 0.4)
    centre = complex(rng.random() * lattice.a + rng.random() * lattice.b)
    corners = int(rng.integers(4, 9))
    around = centre + radius * np.exp(1j * (2 * np.pi * np.arange(corners) / corners + rng.random()))
    sites = [
        vt.Site(vt.polyline(around, closed=True), name="ring"),
        vt.Site(vt.polyline(_wave(rng, centre, 0.4 * radius, 2)), name="inside"),
    ]
    return sites, {"turn": float(rng.uniform(-90, 90)), "about": centre + _within(rng, 0.3 * radius)}


KINDS: Final = (one_stroke, several_sites, special_position, apart, ring)


def random_solid(seed: int, kind: int, group: str | None = None) -> vt.Design:
    """The design of a number and a kind, 0 to 4; of any group, or of this one. Raises DesignError for some."""
    rng = np.random.default_rng([seed, kind])
    chosen = vt.GROUPS[group or rng.choice(sorted(vt.GROUPS))]
    cell = _cell(rng, chosen)
    lattice = chosen.lattice(cell["a"], cell.get("b"), cell.get("angle"))
    sites, motion = KINDS[kind](rng, lattice, chosen)
    return vt.Design(chosen, cell, sites, solid=vt.Solid(HEIGHT, layers=int(rng.choice([2, 11])), **motion))
