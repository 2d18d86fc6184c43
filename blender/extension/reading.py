# SPDX-License-Identifier: GPL-3.0-or-later
"""From objects of Blender to what the engine is given: splines in the plane of the group."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from voronoi_tiles.blender.drawn_splines import DrawnSpline, nurbs
from voronoi_tiles.blender.drawn_tiling import DrawnTiling, decimal

from .settings import DRAWN

BEZIER = 2
"""What a stroke of a grease pencil has as its `curve_type` where it is a Bezier curve."""


def drawn_tiling(tiling: Any) -> DrawnTiling:
    """What is drawn of a tiling; objects that are in no scene any more are left out."""
    settings = tiling.voronoi_tiles
    frame = _inverse(tiling.matrix_world)
    return DrawnTiling(
        group=settings.group,
        a=decimal(settings.a),
        b=decimal(settings.b),
        angle=decimal(settings.angle),
        sites=tuple((site.object.name, tuple(splines(site.object, frame))) for site in drawn_sites(tiling)),
        smoothing=decimal(settings.smoothing) / 100,
    )


def drawn_sites(tiling: Any) -> list[Any]:
    """The sites whose objects are in a scene: those that have been deleted are kept by their tiling alone.

    Those that have gone to another tiling, or have been converted to meshes, are left out.
    """
    return [site for site in tiling.voronoi_tiles.sites if site.object and _is_drawn(tiling, site.object)]


def _is_drawn(tiling: Any, item: Any) -> bool:
    return item.type in DRAWN and item.voronoi_tiles.of == tiling and bool(item.users_scene)


def _inverse(matrix: Any) -> Any:
    """The inverse of a matrix, float64 (4, 4); not finite where an object is scaled to nothing."""
    try:
        return np.linalg.inv(np.array(matrix, np.float64))
    except np.linalg.LinAlgError:
        return np.full((4, 4), np.nan)


def digest(drawn: DrawnTiling) -> str:
    """What tells one drawing from another."""
    found = hashlib.sha256()
    found.update(repr([drawn.group, drawn.a, drawn.b, drawn.angle, drawn.smoothing]).encode())
    for name, parts in drawn.sites:
        found.update(repr((name, len(parts))).encode())
        for spline in parts:
            for value in spline:
                found.update(value.tobytes() if isinstance(value, np.ndarray) else repr(value).encode())
    return found.hexdigest()


def splines(item: Any, frame: Any) -> Iterator[DrawnSpline]:
    """The splines of a curve, or the strokes of a grease pencil's present frames, seen from a frame."""
    to_plane = frame @ np.array(item.matrix_world, np.float64)
    if item.type == "CURVE":
        yield from (_spline(spline, to_plane) for spline in item.data.splines if spline.point_count_v <= 1)
        return
    for layer in item.data.layers:
        if _hidden(layer):
            continue
        own = to_plane @ np.array(getattr(layer, "matrix_local", None) or layer.matrix_layer, np.float64)
        old = hasattr(layer, "active_frame")  # before 4.3
        shown = layer.active_frame if old else layer.current_frame()
        if shown is None:
            continue
        if not old:
            yield from _strokes(shown.drawing, own)
            continue
        for stroke in shown.strokes:
            points = _plane(_read(stroke.points, "co", 3), own)
            yield DrawnSpline("freehand", points, bool(stroke.use_cyclic))


def _hidden(layer: Any) -> bool:
    """Whether a layer of a grease pencil, or a group that it is in, is hidden."""
    return layer.hide or (getattr(layer, "parent_group", None) is not None and _hidden(layer.parent_group))


def _strokes(drawing: Any, to_plane: Any) -> Iterator[DrawnSpline]:
    """The strokes of a drawing of a grease pencil; read all at once, for there are many points."""
    if not drawing.strokes:
        return
    there = filter(None, map(drawing.attributes.get, ("position", "handle_left", "handle_right")))
    read = [_plane(_read(attribute.data, "vector", 3), to_plane) for attribute in there]
    ends = [offset.value for offset in drawing.curve_offsets]
    for stroke, a, b in zip(drawing.strokes, ends[:-1], ends[1:], strict=True):
        parts = [points[a:b] for points in read]
        if getattr(stroke, "curve_type", None) == BEZIER and len(parts) == 3:
            yield DrawnSpline("bezier", parts[0], bool(stroke.cyclic), *parts[1:])
        else:
            yield DrawnSpline("freehand", parts[0], bool(stroke.cyclic))


def _spline(spline: Any, to_plane: Any) -> DrawnSpline:
    closed = bool(spline.use_cyclic_u)
    if spline.type == "BEZIER":
        points, left, right = (
            _plane(_read(spline.bezier_points, name, 3), to_plane) for name in ("co", "handle_left", "handle_right")
        )
        return DrawnSpline("bezier", points, closed, left, right)
    found = _read(spline.points, "co", 4)
    points, weights = _plane(found[:, :3], to_plane), found[:, 3]
    if spline.type == "POLY":
        return DrawnSpline("poly", points, closed)
    order = min(spline.order_u, len(points))
    modes = {"closed": closed, "clamped": bool(spline.use_endpoint_u), "bezier": bool(spline.use_bezier_u)}
    return nurbs(points, weights, order, **modes)


def _read(points: Any, name: str, size: int) -> Any:
    """A property of all points, float64 (n, size)."""
    found = np.empty(size * len(points), np.float32)
    points.foreach_get(name, found)
    return found.reshape(-1, size).astype(np.float64)


def _plane(points: Any, to_plane: Any) -> Any:
    """Points seen from above, complex128 (n,)."""
    x, y = (points @ row[:3] + row[3] for row in to_plane[:2])
    return x + 1j * y
