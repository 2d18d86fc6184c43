"""Where copies touch or cross: asked only when a result looks like it, and answered by another library."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from voronoi_tiles.base.arrays import Complexes, Ints, starts
from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.base.tolerance import EPSILON, TOUCHING
from voronoi_tiles.vector.cells.images import Images
from voronoi_tiles.vector.copies import Placed, SiteUnion, bundles, copies_near, translation
from voronoi_tiles.vector.motion_codes import motion_of
from voronoi_tiles.vector.motions import Action, compose, to_operation

if TYPE_CHECKING:
    from shapely import Geometry


def refuse_touching(action: Action, names: tuple[str, ...], placed: list[Placed]) -> None:
    """Raise TouchingCopiesError if two copies touch or cross, naming the nearest such pair; else return."""
    import shapely

    # Sites drawn far from the origin are known to fewer digits.
    far = max(abs(complex(action.cartesian(*site.shift))) for site in placed)
    nearest = max(TOUCHING * action.size, 4 * EPSILON * far)
    union = SiteUnion.of(placed)
    node_bundle = bundles(placed)[union.node_site]
    copies = copies_near(action, placed, union.nodes, node_bundle)
    # The nodes of every site in every copy of its bundle: run after run.
    images = Images.of(node_bundle, copies)
    nodes, site = images.moved(union.nodes, copies), union.node_site[images.thing]
    runs = np.append(starts(images.copy * len(placed) + site), len(nodes))
    copy, site = images.copy[runs[:-1]], site[runs[:-1]]
    tree = shapely.STRtree(_boxes(union.nodes, union.first, nearest))
    run, base = tree.query(_boxes(nodes, runs, 0.0))
    kept = (site[run] > base) | ((site[run] == base) & (copy[run] >= copies.bundles))
    run, base = run[kept], base[kept]
    if not len(run):
        return
    order = np.lexsort((copy[run], site[run], base))
    run, base = run[order], base[order]
    looked_at, which = np.unique(run, return_inverse=True)
    here = np.array([_geometry(own.nodes, own.segments) for own in placed])
    there = np.array([_geometry(nodes[runs[r] : runs[r + 1]], placed[site[r]].segments) for r in looked_at])
    gaps = shapely.distance(here[base], there[which])
    least = int(gaps.argmin())
    if gaps[least] > nearest:
        return
    i, j = int(base[least]), int(site[run[least]])
    line = shapely.shortest_line(here[i], there[which[least]])
    place = complex(*line.coords[0]) + complex(action.cartesian(*placed[i].shift))
    motion = motion_of(int(copies.motions[copy[run[least]]]))
    drawn = compose(compose(translation(placed[i], 1), motion), translation(placed[j], -1))
    raise TouchingCopiesError(site=names[i], other=names[j], operation=to_operation(drawn), place=place)


def _boxes(nodes: Complexes, runs: Ints, margin: float) -> npt.NDArray[np.object_]:
    """The boxes around runs of nodes, from `runs[k]` up to, not including, `runs[k + 1]`, widened by a margin."""
    import shapely

    x, y = nodes.real, nodes.imag
    least = (np.minimum.reduceat(part, runs[:-1]) - margin for part in (x, y))
    most = (np.maximum.reduceat(part, runs[:-1]) + margin for part in (x, y))
    boxes: npt.NDArray[np.object_] = shapely.box(*least, *most)
    return boxes


def _geometry(nodes: Complexes, segments: Ints) -> Geometry:
    """A site as a shapely geometry."""
    import shapely

    ends = nodes[segments]
    lines = shapely.linestrings(np.stack((ends.real, ends.imag), axis=-1))
    isolated = nodes[np.setdiff1d(np.arange(len(nodes)), segments)]
    points = shapely.points(isolated.real, isolated.imag)
    return shapely.geometrycollections(np.concatenate((np.atleast_1d(lines), np.atleast_1d(points))))
