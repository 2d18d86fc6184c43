"""The regions that a site's strokes enclose, and that belong to it whole."""

from __future__ import annotations

import numpy as np

from voronoi_tiles.base.arrays import Bools, Ints, starts
from voronoi_tiles.base.box_join import points_in_boxes
from voronoi_tiles.vector.cells.half_edges import Contour
from voronoi_tiles.vector.cells.images import Images
from voronoi_tiles.vector.copies import Copies

# A walk around the outside of open strokes encloses nothing, but for rounding; relative to its length squared.
_AREA = 1e-9


def enclosed(contour: Contour, copies: Copies, node_site: Ints, node_bundle: Ints) -> Bools:
    """Which half-edges look into a region that their site encloses, and in which nothing else lies.

    Such a region belongs to the site, whatever its elements share of it. A copy of a connected site cannot lie in one
    of its regions without touching it: it would have to be smaller. `copies` are those of all bundles; `node_site` and
    `node_bundle` (intp, m) are the site and the bundle of each of the contour's nodes. The result is bool (h,).
    """
    face = contour.faces()
    if not len(face):
        return np.zeros(0, bool)
    order = np.argsort(face, kind="stable")
    first = starts(face[order])
    start, end = contour.nodes[contour.source], contour.nodes[contour.target]
    origin = start[order[first]][face]
    x, y, u, v = (part - at for z in (start, end) for part, at in ((z.real, origin.real), (z.imag, origin.imag)))
    # Walks around the inside of a closed stroke run counter-clockwise, around the outside of all others clockwise.
    area = np.bincount(face, x * v - y * u)
    inside = area > _AREA * np.bincount(face, contour.length) ** 2
    region = inside.nonzero()[0]
    if len(region):
        site = node_site[contour.source[order[first]]]
        lone = node_site[contour.corner_node[len(face) :: 4]]
        connected = np.bincount(np.concatenate((site[~inside], lone)), minlength=node_site[-1] + 1) == 1
        if len(connected) > 1 or not connected[0]:
            x, y = start.real[order], start.imag[order]
            low, high = (
                reduce.reduceat(x, first)[region] + 1j * reduce.reduceat(y, first)[region]
                for reduce in (np.minimum, np.maximum)
            )
            nodes = Images.of(node_bundle, copies)
            within, box = points_in_boxes(nodes.moved(contour.nodes, copies), low, high)
            guest, host = node_site[nodes.thing[within]], site[region[box]]
            own = (guest == host) & (connected[host] | (nodes.copy[within] < copies.bundles))
            inside[region[box[~own]]] = False
    return inside[face]
