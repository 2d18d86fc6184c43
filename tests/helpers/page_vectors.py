"""What the page's model must give: strokes, groups and their elements as the product's own Python has them, as JSON.

`tests/studio/page/vectors.test.js` compares. Curves are compared by their control points; the 12 joints of a circle by
the vertices of the coarsest polygon that is drawn for one; arcs of ellipses by cubics of the same count for an arc.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final
from unittest import mock

import numpy as np

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.designs import schema, strokes
from voronoi_tiles.groups.symmetry_elements import placed, symmetry_elements
from voronoi_tiles.groups.wallpaper import GROUPS, Lattice, WallpaperGroup
from voronoi_tiles.paths.ellipses import EllipticalArc
from voronoi_tiles.studio.tables import group_document
from voronoi_tiles.vector.copies import place
from voronoi_tiles.vector.motions import Action, to_motion

ARC_SHARE: Final = 1e-6
"""As in the page: how far cubics may be from an arc; relative to its larger radius."""

CELLS: Final = {"oblique": {"a": 60.0, "b": 44.0, "angle": 77.0}, "rectangular": {"a": 60.0, "b": 50.0}}
"""Cells by system; square and hexagonal ones have a side alone."""

BOXES: Final = [(-71.5, -43.25, 96.75, 88.5), (0.0, 0.0, 120.0, 60.0)]
"""Boxes to look for symmetry elements in; many of these run along the sides of the second, or touch its corners."""

PLACEMENTS: Final[list[tuple[dict[str, Any], dict[str, Any]]]] = [
    ({}, {}),
    ({"translate": [4, -2.5]}, {"rotate": 30}),
    ({"rotate": 17.3, "scale": 0.8}, {"mirror": True, "translate": [3, 1]}),
    ({"mirror": True, "rotate": -90}, {"mirror": True, "scale": -1.7, "rotate": 405.5, "translate": [-6, 2.25]}),
    ({"mirror": True, "scale": 2.0, "rotate": 210.0, "translate": [1e3, -1e3]}, {"scale": 1e-3, "rotate": -720.125}),
]
"""The keys of a site and of a stroke that place it."""

PATHS: Final = (
    "M 1 2 L 3 4 H 7 V -2 Z",
    "m1,2 3,4-5 .5e1h2v-3zl1 1",
    "M0 0C1 2 3 4 5 0S9-4 10 0 12 3 14 1s1 1 2-2",
    "M0 0C1 2 3 4 5 0T9 1 10 3S11 4 12 0q1 1 2 0s1 2 3 1",
    "M0 0Q2 4 4 0T8 0t4 0 2 2M20,20q1 1 2 0L30 30",
    "M 0 0 A 5 3 20 0 1 8 1 A 5 3 20 1 0 8 9 a 4 4 0 0 0 1 1 a 0 3 0 0 0 1 1",
    "M 0 0 a 1 1 0 0 1 30 0 a25 25 -30 01 50 -25 z m 5 5 a 9 9 90 1 1 1e-3 0",
    "M5 5C5 5 5 5 5 5L6 6ZM7 7",
)
"""Path data: all commands, absolute and relative, repeated, smooth ones after others, radii too small or none."""


def vectors(seed: int = 14) -> dict[str, Any]:
    """All that is compared."""
    chance = np.random.default_rng(seed)
    return {
        "tables": {"groups": [group_document(group) for group in GROUPS.values()]},
        "strokes": list(_strokes(chance)),
        "flattened": list(_flattened(chance)),
        "groups": [_group(group, chance) for group in GROUPS.values()],
    }


def xy(z: complex) -> list[float]:
    """A point as the page has it."""
    return [z.real, z.imag]


def numbers(z: Complexes) -> list[float]:
    """Points as their coordinates, one after the other."""
    return [float(part) for part in np.ascontiguousarray(z).ravel().view(np.float64)]


# --- strokes --------------------------------------------------------------------------------------------------


def _points(chance: np.random.Generator, count: int) -> list[list[float]]:
    return [[chance.uniform(-30, 30), chance.uniform(-30, 30)] for _ in range(count)]


def drawn_strokes(chance: np.random.Generator) -> Iterator[dict[str, Any]]:
    """Strokes of all kinds, closed and open."""
    yield {"point": [3, 4.5]}
    yield {"segment": _points(chance, 2)}
    yield {"polyline": _points(chance, 5)}
    yield {"polyline": _points(chance, 3), "closed": True}
    yield {"bezier": _points(chance, 7)}
    yield {"hermite": _points(chance, 4), "tangents": _points(chance, 4)}
    for closed in (False, True):
        for alpha in (0.0, 0.5, 1.0, 0.3):
            yield {"catmull_rom": _points(chance, 5), "alpha": alpha, "closed": closed}
        yield {"catmull_rom": _points(chance, 3), "closed": closed}
        yield {"bspline": _points(chance, 6), "closed": closed}
    yield {"bspline": _points(chance, 3), "closed": True}
    yield {"catmull_rom": _points(chance, 2)}
    yield {"circle": [3, -2], "radius": 7.5}
    for data in PATHS:
        yield {"path": data}
        yield {"file": "drawing.svg"}


def _strokes(chance: np.random.Generator) -> Iterator[dict[str, Any]]:
    """Each stroke in each placement with the cubic pieces that it is; a file is the path data before it."""
    count = EllipticalArc.cubic_count
    with mock.patch.object(EllipticalArc, "cubic_count", lambda arc, _share: count(arc, ARC_SHARE)):
        for site, keys in PLACEMENTS:
            resolved = ""
            for drawn in drawn_strokes(chance):
                stroke = {**drawn, **keys}
                resolved = drawn.get("path", resolved)
                # So coarse that a circle is a polygon of 12 sides.
                line, curved = schema.stroke(stroke, 1e6, schema.placement(site), _drawing(resolved))
                cubics = line if curved else _straight(line)
                yield {"site": site, "stroke": stroke, "resolved": resolved, "cubics": numbers(cubics)}


def _drawing(data: str) -> schema.PathDataOf:
    """What reads a drawing in a file: always these path data."""
    return lambda _table: data


def _straight(line: Complexes) -> Complexes:
    """The pieces of a polyline, shape (n, 4); of a point, one."""
    starts, ends = (line, line) if len(line) == 1 else (line[:-1], line[1:])
    return np.stack((starts, starts, ends, ends), axis=1)


def _flattened(chance: np.random.Generator) -> Iterator[dict[str, Any]]:
    """Curves with their segments, for several tolerances."""
    for drawn in drawn_strokes(chance):
        if "file" not in drawn:
            line, curved = schema.stroke(drawn, 1e-2)
            for tolerance in (3.0, 0.11, 1e-3) if curved else ():
                chords, _, _ = strokes.flatten(line, tolerance)
                yield {"cubics": numbers(line), "tolerance": tolerance, "segments": numbers(chords)}


# --- groups ---------------------------------------------------------------------------------------------------


def cell_of(group: WallpaperGroup) -> dict[str, float]:
    """A cell of a group, before it is a lattice."""
    return CELLS.get(group.system, {"a": 60.0})


def _group(group: WallpaperGroup, chance: np.random.Generator) -> dict[str, Any]:
    """A group over a cell: its lattice, its motions, its elements in a box, and sites in special positions."""
    cell = cell_of(group)
    lattice = group.lattice(**cell)
    return {
        "group": group.name,
        "cell": cell,
        "lattice": {"a": xy(lattice.a), "b": xy(lattice.b)},
        "motions": [motion_table(lattice.isometry(operation)) for operation in group.operations],
        "elements": [_elements(group, lattice, box) for box in BOXES],
        "sites": list(_sites(group, lattice, chance)),
    }


def _elements(group: WallpaperGroup, lattice: Lattice, box: tuple[float, float, float, float]) -> dict[str, Any]:
    """The symmetry elements of a group in a box."""
    found = placed(symmetry_elements(group), lattice, box)
    return {
        "box": box,
        "centres": [{"at": xy(z), "order": int(n)} for z, n in zip(found.centres, found.orders, strict=True)],
        "mirrors": [[xy(start), xy(end)] for start, end in found.mirrors],
        "glides": [[xy(start), xy(end)] for start, end in found.glides],
    }


def motion_table(motion: Isometry) -> dict[str, Any]:
    """A motion as the page has it."""
    return {"a": xy(motion.a), "b": xy(motion.b), "conj": motion.conj}


def _sites(group: WallpaperGroup, lattice: Lattice, chance: np.random.Generator) -> Iterator[dict[str, Any]]:
    """Sites in general position and about every centre and mirror, with the operations that make their copies."""
    elements = symmetry_elements(group)
    places = [lattice.cartesian(centre.x, centre.y) for centre in elements.centres]
    places += [lattice.cartesian(*line.point) + 0.13 * lattice.cartesian(*line.direction) for line in elements.mirrors]
    for place_of_site in (3.7 + 5.1j, *places, *(at - 7 * lattice.a + 4 * lattice.b for at in places[:1])):
        maps = _stabilizer(group, lattice, place_of_site)
        for kind, count in (("segment", 2), ("bezier", 4), ("polyline", 4), ("circle", 1)):
            points = [complex(*point) * 0.1 for point in _points(chance, count)]
            images = [[motion(place_of_site + point) for point in points] for motion in maps]
            drawn = [_drawn(kind, image) for image in images]
            yield {"strokes": drawn, "operations": _copies(group, lattice, drawn)}


def _drawn(kind: str, points: Sequence[complex]) -> dict[str, Any]:
    """A stroke of a kind with these points."""
    listed = [xy(point) for point in points]
    return {"circle": listed[0], "radius": 0.75} if kind == "circle" else {kind: listed}


def _stabilizer(group: WallpaperGroup, lattice: Lattice, place_of_site: complex) -> list[Isometry]:
    """The motions that leave a point where it is."""
    found = []
    for operation in group.operations:
        x, y = lattice.fractional(place_of_site - lattice.isometry(operation)(place_of_site))
        motion = lattice.isometry(operation.translated(round(x), round(y)))
        if abs(motion(place_of_site) - place_of_site) < 1e-9:
            found.append(motion)
    return found


def _copies(group: WallpaperGroup, lattice: Lattice, drawn: list[dict[str, Any]]) -> list[int]:
    """The numbers of the operations that make the copies of a site in one cell, as the engine has them."""
    design = vt.Design.from_dict(
        {"schema": 1, "group": group.name, "cell": cell_of(group), "site": [{"strokes": drawn}]}
    )
    action = Action(group, lattice)
    (site,), _ = place(action, design.noded)
    numbers_of = {to_motion(operation): number for number, operation in enumerate(group.operations)}
    return [numbers_of[motion] for motion in site.representatives]
