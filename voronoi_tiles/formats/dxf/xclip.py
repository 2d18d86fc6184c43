"""XCLIP: the polygon that CAD programs clip a block by where it is inserted."""

from __future__ import annotations

from itertools import groupby, pairwise
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes, offsets_of
from voronoi_tiles.formats.polygon_clip import CLIP_MAX, clipped_by, dots_within
from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.paths.paths import Paths

Clip = tuple[complex, ...]
"""The corners of a polygon, in the drawing's units."""

_CORNERS_MAX: Final = 1000


def clip_of(insert: Any) -> tuple[Clip | None, str]:
    """The polygon by which an INSERT is clipped, None for none, and what is not read of it, "" for nothing."""
    from ezdxf.xclip import XClip

    if insert.extension_dict is None:
        return None, ""
    xclip = XClip(insert)
    if not xclip.has_clipping_path or not xclip.is_clipping_enabled:
        return None, ""
    if insert.mcount > 1:
        return None, "XCLIP of an INSERT in rows"
    path = xclip.get_wcs_clipping_path()
    if path.is_inverted_clip:
        return None, "XCLIP turned inside out"
    corners = tuple(complex(corner.x, corner.y) for corner in path.vertices)
    if not 3 <= len(corners) <= _CORNERS_MAX or not _is_simple(corners):
        return None, "XCLIP that is no polygon"
    return corners, ""


def _is_simple(corners: Clip) -> bool:
    """Whether a polygon does not cross itself, and is finite."""
    import shapely

    points = np.array(corners)
    return bool(
        np.isfinite(points).all() and shapely.is_valid(shapely.Polygon(np.column_stack((points.real, points.imag))))
    )


def clipped_shapes(
    drawn: list[tuple[Paths, Complexes]], clips: list[tuple[Clip, ...]], scale: float
) -> list[tuple[Paths, Complexes]]:
    """Clip what was drawn, paths and places of no length, by the polygons of each, which `scale` makes millimetres.

    Raises DrawingError where that takes too long.
    """
    result = []
    budget = CLIP_MAX
    for polygons, group in groupby(zip(drawn, clips, strict=True), key=lambda pair: pair[1]):
        parts = [part for part, _ in group]
        for polygon in polygons:
            corners = scale * np.array(polygon, np.complex128)
            budget -= len(corners) * sum(len(paths.start) for paths, _ in parts)
            if budget < 0:
                raise DrawingError(
                    "too much is clipped by XCLIP", remedy="Explode the blocks, and trim what they draw."
                )
            whole, owner = clipped_by(Paths.concatenate([paths for paths, _ in parts]), corners)
            bounds = np.searchsorted(owner, offsets_of([len(paths) for paths, _ in parts])).tolist()
            within = dots_within(np.concatenate([dots for _, dots in parts]), corners)
            places = offsets_of([len(dots) for _, dots in parts]).tolist()
            parts = [
                (whole.part(low, high), dots[within[first:last]])
                for (low, high), (first, last), (_, dots) in zip(pairwise(bounds), pairwise(places), parts, strict=True)
            ]
        result += parts
    return result
