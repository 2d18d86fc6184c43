"""Where copies touch or cross: asked only when a result looks like it, and answered by another library."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.base.maps import move
from voronoi_tiles.base.tolerance import EPSILON, TOUCHING
from voronoi_tiles.vector.copies import Placed, copies_near, translation
from voronoi_tiles.vector.motions import Action, compose, to_operation

if TYPE_CHECKING:
    from shapely import Geometry


def refuse_touching(action: Action, names: tuple[str, ...], placed: list[Placed]) -> None:
    """Raise TouchingCopiesError if two copies touch or cross, naming the nearest such pair; else return."""
    import shapely

    # Sites drawn far from the origin are known to fewer digits.
    far = max(abs(complex(action.cartesian(*site.shift))) for site in placed)
    nearest = max(TOUCHING * action.size, 4 * EPSILON * far)
    found = None
    for i, base in enumerate(placed):
        here = _geometry(base.nodes, base.segments)
        shapely.prepare(here)
        for j in range(i, len(placed)):
            copies = copies_near(action, base, placed[j])
            for k in range(1 if i == j else 0, len(copies)):
                nodes = move(placed[j].nodes, copies.unit[k], copies.shift[k], copies.conj[k])
                there = _geometry(nodes, placed[j].segments)
                gap = float(shapely.distance(here, there))
                if gap <= nearest and (found is None or gap < nearest):
                    nearest = gap
                    found = (i, j, tuple(copies.motions[k].tolist()), here, there)
    if found is None:
        return
    i, j, motion, here, there = found
    place = complex(*shapely.shortest_line(here, there).coords[0]) + complex(action.cartesian(*placed[i].shift))
    drawn = compose(compose(translation(placed[i], 1), motion), translation(placed[j], -1))
    raise TouchingCopiesError(site=names[i], other=names[j], operation=to_operation(drawn), place=place)


def _geometry(nodes: Complexes, segments: Ints) -> Geometry:
    """A site as a shapely geometry."""
    import shapely

    ends = nodes[segments]
    lines = shapely.linestrings(np.stack((ends.real, ends.imag), axis=-1))
    isolated = nodes[np.setdiff1d(np.arange(len(nodes)), segments)]
    points = shapely.points(isolated.real, isolated.imag)
    return shapely.geometrycollections(np.concatenate((np.atleast_1d(lines), np.atleast_1d(points))))
