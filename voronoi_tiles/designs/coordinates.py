"""Points as callers have them, made pairs as a design file has them: complex numbers, arrays, geometries of others.

Nothing is checked here: what is no point stays as it is, and the check of the design refuses it, with its place.
Geometries are recognised by `__geo_interface__` (shapely and its kin), paths of svgpathtools by their method `d`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, Final, Protocol, TypeAlias, runtime_checkable

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.errors import DesignError


@runtime_checkable
class GeoInterface(Protocol):
    """A geometry that tells its type and coordinates, as those of shapely do."""

    @property
    def __geo_interface__(self) -> Mapping[str, Any]:
        """The geometry as GeoJSON names it."""


@runtime_checkable
class PathData(Protocol):
    """A path that writes itself as SVG path data, as those of svgpathtools do."""

    def d(self) -> str:
        """The path data."""


PointLike: TypeAlias = complex | Sequence[float] | Floats | GeoInterface
"""A point: a complex number, a pair of numbers, a geometry of one point."""

PointsLike: TypeAlias = Iterable[PointLike] | Complexes | Floats | GeoInterface
"""Points: a sequence of them, an array complex (n,) or float (n, 2), or a geometry of points or lines."""


def pair(point: object) -> object:
    """A point as (x, y); what is none as it is."""
    if isinstance(point, GeoInterface):
        listed = [line for line, _ in lines(point)]
        return listed[0][0] if len(listed) == 1 and len(listed[0]) == 1 else point
    if isinstance(point, np.ndarray):
        point = point.tolist()
    if isinstance(point, int | float | complex | np.number) and not isinstance(point, bool):
        return _coordinate(point.real), _coordinate(point.imag)
    return tuple(point) if isinstance(point, list | tuple) else point


def _coordinate(value: float) -> float:
    """A number as a float; a whole one that is too large for that as it is."""
    return value if isinstance(value, int) and abs(value) > 2**1000 else float(value)


def pairs(points: object) -> object:
    """Points as a tuple of pairs; what is no sequence of points as it is."""
    if isinstance(points, np.ndarray) and points.ndim:
        # The numbers of a real array are coordinates: one without rows of two is no array of points.
        listed = points.tolist()
        return tuple(map(pair, listed)) if np.iscomplexobj(points) else tuple(map(_row, listed))
    if isinstance(points, str | bytes | Mapping | np.ndarray) or not isinstance(points, Iterable):
        return points
    return tuple(map(pair, points))


def _row(row: Any) -> Any:
    return tuple(row) if isinstance(row, list) else row


def lines(points: object) -> list[tuple[Any, bool]]:
    """The lines of a geometry as pairs, and whether each is a ring, whose first point is not repeated at its end.

    What is no geometry is one line. Raises DesignError for a geometry that is empty, or of an unknown type.
    """
    if not isinstance(points, GeoInterface):
        return [(pairs(points), False)]
    try:
        found = list(_lines(points.__geo_interface__))
    except DesignError:
        raise
    except Exception as error:  # whatever a geometry of others is made of, and however deep
        raise DesignError("the geometry cannot be read", remedy="Pass points or lines, as GeoJSON has them.") from error
    if not found:
        raise DesignError("the geometry is empty", remedy="Leave it out.")
    return found


_LINES: Final[Mapping[str, Callable[[Any], Iterable[Any]]]] = {
    "Point": lambda point: [[point]] if len(point) else [],
    "MultiPoint": lambda points: [[point] for point in points],
    "LineString": lambda line: [line],
    "MultiLineString": lambda lines: lines,
    "LinearRing": lambda ring: [ring],
    "Polygon": lambda rings: rings,
    "MultiPolygon": lambda polygons: [ring for rings in polygons for ring in rings],
}
"""The lines of each type of geometry, from its coordinates."""

_RINGS: Final = {"LinearRing", "Polygon", "MultiPolygon"}


def _lines(geometry: Mapping[str, Any]) -> Iterator[tuple[Any, bool]]:
    """The lines of a geometry as GeoJSON has it."""
    kind = str(geometry.get("type"))
    if kind == "Feature":
        inner = [geometry["geometry"]]
    elif kind in ("GeometryCollection", "FeatureCollection"):
        inner = geometry["geometries" if kind == "GeometryCollection" else "features"]
    elif kind in _LINES:
        ring = kind in _RINGS
        for line in _LINES[kind](geometry["coordinates"]):
            points: Any = pairs(line)
            # A ring ends where it began; some leave that point out.
            if len(points):
                yield points[:-1] if ring and len(points) > 1 and points[-1] == points[0] else points, ring
        return
    else:
        raise DesignError(f"unknown type of geometry {kind!r}", remedy="Pass points or lines.")
    for part in inner:
        yield from _lines(part)
