"""Reading values and strokes from the tables of a design: every value is checked before it is used.

Whatever is passed, only DesignError comes out. Its key is relative to the value that was read ("[1]" for
the second item); callers put their own key before it with `within`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Placement
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.base.values import Table, each, flag, number, positive, required, sequence, table, text, within
from voronoi_tiles.designs import strokes as curves
from voronoi_tiles.designs.keys import PLACEMENT

PathDataOf = Callable[[Table], str]
"""What gives the path data of a stroke that names a drawing."""


def point(value: object) -> complex:
    """Read a point [x, y]."""
    remedy = "Write a point as [x, y]."
    pair = sequence(value, remedy)
    if len(pair) != 2:
        raise DesignError(f"a point has 2 coordinates, not {len(pair)}", remedy=remedy)
    return complex(*each(pair, lambda coordinate: number(coordinate, remedy)))


def points(value: object, least: int, most: int | None = None) -> Complexes:
    """Read an array of at least (and at most) so many points; shape (n,)."""
    remedy = "Write points as [[x, y], [x, y]]."
    listed = sequence(value, remedy)
    if len(listed) < least or (most is not None and len(listed) > most):
        wanted = f"{least}" if most == least else f"at least {least}"
        raise DesignError(f"needs {wanted} points, not {len(listed)}", remedy=remedy)
    return np.array(each(listed, point), np.complex128)


# --- strokes --------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _StrokeKind:
    """A stroke's table with what its reader needs: `accuracy` in the units of the design, and its placement.

    `path_data` is that of the drawing that the stroke names.
    """

    table: Table
    accuracy: float
    placement: Placement
    path_data: PathDataOf

    def points(self, name: str, least: int, most: int | None = None) -> Complexes:
        with within(name):
            return points(self.table[name], least, most)

    @property
    def closed(self) -> bool:
        with within("closed"):
            return flag(self.table.get("closed", False), "Write closed = true, or leave it out.")


def _point(stroke: _StrokeKind) -> Complexes:
    with within("point"):
        return stroke.placement(np.array([point(stroke.table["point"])]))


def _segment(stroke: _StrokeKind) -> Complexes:
    ends = stroke.points("segment", 2, 2)
    curves.refuse_repeats(ends, False, "segment")
    return stroke.placement(ends)


def _polyline(stroke: _StrokeKind) -> Complexes:
    line = stroke.points("polyline", 3 if stroke.closed else 2)
    curves.refuse_repeats(line, stroke.closed, "polyline")
    return stroke.placement(np.append(line, line[0]) if stroke.closed else line)


def _bezier(stroke: _StrokeKind) -> Complexes:
    return stroke.placement(curves.bezier_pieces(stroke.points("bezier", 0)))


def _hermite(stroke: _StrokeKind) -> Complexes:
    required(stroke.table, "tangents", "Give one tangent [x, y] for every point.")
    through = stroke.points("hermite", 2)
    return stroke.placement(curves.hermite_pieces(through, stroke.points("tangents", 0)))


def _catmull_rom(stroke: _StrokeKind) -> Complexes:
    with within("alpha"):
        alpha = number(stroke.table.get("alpha", 0.5))
        if not 0.0 <= alpha <= 1.0:
            raise DesignError(
                f"must be from 0 to 1, not {alpha:g}",
                remedy="Write 0 (uniform), 0.5 (centripetal) or 1 (chordal).",
            )
    through = stroke.points("catmull_rom", 3 if stroke.closed else 2)
    return stroke.placement(curves.catmull_rom_pieces(through, alpha, stroke.closed))


def _bspline(stroke: _StrokeKind) -> Complexes:
    return stroke.placement(curves.bspline_pieces(stroke.points("bspline", 0), stroke.closed))


def _circle(stroke: _StrokeKind) -> Complexes:
    with within("circle"):
        center = complex(stroke.placement(np.array([point(stroke.table["circle"])]))[0])
    radius = required(stroke.table, "radius", "Write the circle's radius.")
    with within("radius"):
        # The polygon is not turned with its centre: its vertices have to fit the mirrors of the group.
        radius = positive(radius) * abs(stroke.placement.scale)
    return curves.circle_polyline(center, radius, stroke.accuracy)


def _path(stroke: _StrokeKind) -> Complexes:
    with within("path"):
        return _pieces(stroke, text(stroke.table["path"], 'Write path = "M 1 1 L 5 3".'))


def _file(stroke: _StrokeKind) -> Complexes:
    data = stroke.path_data(stroke.table)
    with within("file"):
        return _pieces(stroke, data)


def _pieces(stroke: _StrokeKind, data: str) -> Complexes:
    return stroke.placement(curves.path_pieces(data, stroke.accuracy / abs(stroke.placement.scale)))


# kind: (reader, the keys it takes beside its own and the placement, whether it gives cubic pieces, not a polyline)
_KINDS: dict[str, tuple[Callable[[_StrokeKind], Complexes], tuple[str, ...], bool]] = {
    "point": (_point, (), False),
    "segment": (_segment, (), False),
    "polyline": (_polyline, ("closed",), False),
    "bezier": (_bezier, (), True),
    "hermite": (_hermite, ("tangents",), True),
    "catmull_rom": (_catmull_rom, ("alpha", "closed"), True),
    "bspline": (_bspline, ("closed",), True),
    "circle": (_circle, ("radius",), False),
    "path": (_path, (), True),
    "file": (_file, ("layer", "id"), True),
}
KINDS: Final = tuple(_KINDS)
"""The kinds of strokes."""

_KEYS = tuple(dict.fromkeys([*_KINDS, *(name for row in _KINDS.values() for name in row[1]), *PLACEMENT]))
_EXAMPLE = "Write a stroke such as { segment = [[5, 3], [25, 11]] }."


_NOWHERE = Placement()


def _no_drawing(_stroke: Table) -> str:
    raise DesignError("no drawing can be read here", key="file", remedy="Write the stroke itself.")


def stroke(
    value: object, accuracy: float, by: Placement = _NOWHERE, path_data: PathDataOf = _no_drawing
) -> tuple[Complexes, bool]:
    """Read one stroke, place it, and move it by what its site and its design say.

    Gives a polyline, shape (n,), and False; or cubic Bezier pieces, shape (k, 4), and True. Circles and
    the arcs of paths keep to `accuracy` (in the units of the design); all else is exact. `path_data` reads the drawing
    that a stroke names.
    """
    of = table(value, _KEYS, _EXAMPLE)
    kinds = [name for name in of if name in _KINDS]
    if len(kinds) != 1:
        what = f"is two, {kinds[0]} and {kinds[1]}" if kinds else "has no kind"
        raise DesignError(f"the stroke {what}", remedy=f"Write one of {', '.join(_KINDS)} between each pair of braces.")
    kind = kinds[0]
    read, options, curved = _KINDS[kind]
    for name in of:
        if name not in (kind, *options, *PLACEMENT):
            raise DesignError(
                f"does not go with {kind}",
                key=name,
                remedy=f"Leave it out; beside {kind} stand {', '.join((*options, *PLACEMENT))}.",
            )
    placed = read(_StrokeKind(of, accuracy, by @ placement(of), path_data))
    if not (np.abs(placed.real).max() <= COORDINATE_MAX and np.abs(placed.imag).max() <= COORDINATE_MAX):
        raise DesignError(
            f"the stroke reaches beyond {COORDINATE_MAX:g}", remedy="Draw it smaller, or nearer to the origin."
        )
    if kind != "point" and (placed == placed.flat[0]).all():
        raise DesignError(
            "the stroke has zero length where it is placed", remedy="Draw it larger, or nearer to the origin."
        )
    return placed, curved


def placement(of: Table) -> Placement:
    """Read `mirror`, `scale`, `rotate` and `translate`, those that are there."""
    mirror, scale, rotate, translate = False, 1.0, 0.0, 0j
    if "mirror" in of:
        with within("mirror"):
            mirror = flag(of["mirror"], "Write mirror = true, or leave it out.")
    if "scale" in of:
        with within("scale"):
            scale = factor(of["scale"])
    if "rotate" in of:
        with within("rotate"):
            rotate = number(of["rotate"], "Write the angle in degrees.")
    if "translate" in of:
        with within("translate"):
            translate = point(of["translate"])
    return Placement(scale, rotate, translate, mirror)


def factor(value: object) -> float:
    """Read a factor, any number but 0."""
    result = number(value, tiny="Write a factor such as 0.5.")
    if result == 0.0:
        raise DesignError("must not be 0", remedy="Write a factor such as 0.5.")
    return result
