"""DXF's lines and curves, drawn by a pen in the drawing's units."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from ezdxf.math import Vec2, Vec3

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.maps import Affine
from voronoi_tiles.formats.dxf.splines import bezier_spans, fitted_cubics, smooth_runs
from voronoi_tiles.formats.pen import Pen
from voronoi_tiles.formats.shapes import CURVE_ACCURACY, DrawingError
from voronoi_tiles.paths.ellipses import EllipticalArc
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD

_MIRRORED: Final = Affine(0j, -1 + 0j, 0j)  # seen from below, x runs to the left
_UPRIGHT: Final = 1e-9  # how far an axis may lean; relative. Programs write axes with 10 digits or more.
_NUMBER_MAX: Final = 1e100
"""Largest knot and weight of a spline, whose differences and products are to be numbers."""

_DEGREE_MAX: Final = 25


class NotDrawn(Exception):  # noqa: N818 - it is no error, but a reason to leave something out
    """An entity that is left out; the words go on from its name: "tilted in space"."""


def draw_entity(pen: Pen, entity: Any, to_page: Affine) -> Sequence[str]:
    """Draw a LINE, ARC, CIRCLE, ELLIPSE, LWPOLYLINE, POLYLINE or SPLINE.

    What has no size becomes a line of no length. `to_page` is the map with which the pen has begun the shape. The value
    are sentences on what had to be guessed. Raises NotDrawn for what stands in space and for what says too little to be
    drawn, DrawingError for what is broken.
    """
    dxf = entity.dxf
    _check_numbers(dxf)
    match entity.dxftype():
        case "LINE":
            pen.move(_point(dxf.start))
            pen.line(_point(dxf.end))
        case "ARC":
            turn = math.radians(dxf.end_angle - dxf.start_angle) % math.tau or math.tau
            _draw_arc(pen, entity, to_page, math.radians(dxf.start_angle), turn)
        case "CIRCLE":
            _draw_arc(pen, entity, to_page, 0.0, math.tau)
        case "ELLIPSE":
            _draw_ellipse(pen, dxf)
        case "LWPOLYLINE":
            begin_seen(pen, entity, to_page)
            _draw_bulges(pen, [(complex(x, y), b) for x, y, b in entity.get_points("xyb")], bool(entity.closed))
        case "POLYLINE":
            _draw_polyline(pen, entity, to_page)
        case _:
            return _draw_spline(pen, entity, to_page)
    return ()


def _check_numbers(dxf: Any) -> None:
    """Refuse what is infinite or no number among the attributes of an entity."""
    for name, value in dxf.all_existing_dxf_attribs().items():
        parts = value if isinstance(value, (Vec2, Vec3)) else (value,)
        for part in parts:
            if isinstance(part, float) and not math.isfinite(part):
                raise DrawingError(f"its {name.replace('_', ' ')} is {part}, no number", remedy="Remove it.")


def begin_seen(pen: Pen, entity: Any, to_page: Affine) -> None:
    """Begin a shape whose coordinates are those of its own plane, seen from above or from below."""
    axis = entity.dxf.get("extrusion")
    if axis is None:
        return
    _check_upright(axis)
    if axis.z < 0:
        pen.cancel()
        pen.begin(to_page @ _MIRRORED)


def _check_upright(axis: Any) -> None:
    """Refuse what is seen neither from above nor from below."""
    if not math.hypot(axis.x, axis.y) <= _UPRIGHT * abs(axis.z):
        raise NotDrawn("tilted in space")


def _point(vector: Any) -> complex:
    return complex(vector.x, vector.y)


def _draw_arc(pen: Pen, entity: Any, to_page: Affine, begin: float, turn: float) -> None:
    """An ARC or a CIRCLE."""
    begin_seen(pen, entity, to_page)
    dxf = entity.dxf
    if dxf.radius < 0.0:
        raise NotDrawn("of a negative radius")
    if dxf.radius == 0.0:
        pen.dot(_point(dxf.center))
    else:
        _draw_about(pen, _point(dxf.center), Affine(complex(dxf.radius), 0j, 0j), begin, turn)


def _draw_about(pen: Pen, centre: complex, to_ellipse: Affine, begin: float, turn: float) -> None:
    """An arc about its centre; a whole turn is closed."""
    whole = turn >= math.tau - 1e-9
    start = centre + to_ellipse(cmath.rect(1.0, begin))
    pen.move(start)
    if whole:
        pen.elliptical(EllipticalArc.about(start, start, to_ellipse, begin, math.tau))
        pen.close()
    else:
        end = centre + to_ellipse(cmath.rect(1.0, begin + turn))
        pen.elliptical(EllipticalArc.about(start, end, to_ellipse, begin, turn))


def _draw_ellipse(pen: Pen, dxf: Any) -> None:
    axis = dxf.extrusion
    _check_upright(axis)
    major = _point(dxf.major_axis)
    if major == 0j:
        pen.dot(_point(dxf.center))
        return
    if dxf.ratio == 0.0:
        raise NotDrawn("without a width")
    minor = 1j * major * dxf.ratio * math.copysign(1.0, axis.z)
    to_ellipse = Affine((major - 1j * minor) / 2, (major + 1j * minor) / 2, 0j)
    turn = (dxf.end_param - dxf.start_param) % math.tau or math.tau
    if abs(dxf.end_param - dxf.start_param) >= math.tau - 1e-9:
        turn = math.tau
    _draw_about(pen, _point(dxf.center), to_ellipse, dxf.start_param, turn)


def _draw_bulges(pen: Pen, vertices: list[tuple[complex, float]], closed: bool) -> None:
    """Lines and arcs through vertices; a vertex's bulge, the tangent of a quarter of the angle, is of what follows."""
    if not vertices:
        raise NotDrawn("without vertices")
    if len(vertices) == 1:
        pen.dot(vertices[0][0])
        return
    pen.move(vertices[0][0])
    following = [*vertices[1:], *(vertices[:1] if closed else [])]
    for (start, bulge), (end, _) in zip(vertices, following, strict=False):
        if bulge:
            pen.curve(ARC, (start + end) / 2 - 0.5j * (end - start) * bulge, end)
        else:
            pen.line(end)
    if closed:
        pen.close()


def _draw_polyline(pen: Pen, entity: Any, to_page: Affine) -> None:
    """A POLYLINE in the plane, or one in space seen from above; meshes are none."""
    if not (entity.is_2d_polyline or entity.is_3d_polyline):
        raise NotDrawn("mesh")
    if entity.is_2d_polyline:
        begin_seen(pen, entity, to_page)
    frame = 16  # the control points of a spline that the other vertices follow
    vertices = [
        (_point(vertex.dxf.location), float(vertex.dxf.get("bulge", 0.0)))
        for vertex in entity.vertices
        if not int(vertex.dxf.get("flags", 0)) & frame
    ]
    _draw_bulges(pen, vertices, bool(entity.is_closed))


def _draw_spline(pen: Pen, entity: Any, to_page: Affine) -> Sequence[str]:
    """A SPLINE: by its control points, or, where it has none, through its fit points."""
    by_fit = not entity.control_point_count()
    if by_fit and entity.fit_point_count() < 2:
        raise NotDrawn("without points")
    if by_fit and entity.closed and entity.fit_points[0] != entity.fit_points[-1]:
        raise NotDrawn("that is closed and has fit points alone")
    curve = entity.construction_tool() if by_fit else entity
    degree = int(curve.degree if by_fit else entity.dxf.degree)
    points = np.array([complex(x, y) for x, y, _ in curve.control_points], np.complex128)
    # Not the knots of the construction tool, which makes some up where there are none.
    knots = np.array(curve.knots() if by_fit else entity.knots, np.float64)
    if not len(knots):
        raise NotDrawn("without knots")
    if not 1 <= degree <= _DEGREE_MAX or len(points) <= degree or len(knots) != len(points) + degree + 1:
        raise NotDrawn("of which degree, knots and points do not fit")
    if not ((np.abs(knots) <= _NUMBER_MAX).all() and np.isfinite(points).all() and (np.diff(knots) >= 0.0).all()):
        raise NotDrawn("of which the knots fall, or are no numbers")
    weights = np.ones(1) if by_fit or not len(entity.weights) else np.array(entity.weights, np.float64)
    if len(weights) not in {1, len(points)} or not ((weights > 0.0) & (weights <= _NUMBER_MAX)).all():
        raise NotDrawn("of which a weight is missing, or not greater than 0")
    tolerance = CURVE_ACCURACY / to_page.largest
    if degree <= 3 and np.ptp(weights) == 0.0:
        runs = smooth_runs(bezier_spans(points, knots, degree), tolerance)
    else:
        heavy = bezier_spans(weights * points, knots, degree)
        weight = bezier_spans((weights * np.ones(len(points))).astype(np.complex128), knots, degree)
        runs = smooth_runs(fitted_cubics(heavy, weight, tolerance), tolerance)
    for run in runs:
        _draw_spans(pen, run, tolerance)
    if by_fit:
        return ("the curves of splines that have fit points alone are a guess, the usual one",)
    whole = len(runs) == 1 and abs(pen.here - pen.origin) <= tolerance
    return () if whole or not entity.closed else ("splines that are said to be closed have ends, and were left open",)


def _draw_spans(pen: Pen, spans: Complexes, tolerance: float) -> None:
    """Bezier curves of one degree, one after the other, closed where they end at their beginning."""
    pen.move(complex(spans[0, 0]))
    kind = {2: LINE, 3: QUAD, 4: CUBIC}[spans.shape[1]]
    pen.draw(kind, np.ascontiguousarray(spans[:, 1:]).view(np.float64).ravel().tolist())
    if abs(pen.here - pen.origin) <= tolerance:
        pen.close()
