"""Every tolerance and limit of voronoi_tiles: frozen numbers, each with its unit, its scale and its reason.

Exact stages take no tolerance; what stands here serves the borders: reading designs, flattening curves,
joining the ends of strokes, and the figures that a proof must reach.
"""

from __future__ import annotations

from typing import Final

EPSILON: Final = 2.0**-52
"""Spacing of float64 at 1; no unit. The unit of all rounding arguments ("an ulp")."""

PROOF_LIMIT: Final = 1e-12
"""Largest error that a proof accepts; relative to the cell size (areas: to the cell's area). The goal of
the project: four orders above the rounding of one operation, far below what any machine can cut."""

FLATTENING_MM: Final = 0.01
"""Default distance between a curve and its flattened stroke; millimetres. A tenth of a laser's kerf."""

NODE_MERGE: Final = 1e-13
"""Nodes of a site that are nearer than this are one, and a node this near to a segment lies on it; relative
to the site's extent. Hundreds of ulps, so that rounded intersections meet, and ten times below
PROOF_LIMIT."""

NODE_MERGE_ULPS: Final = 4.0
"""The same in ulps of the largest coordinate; it rules far from the origin, where coordinates are no finer."""

STRAIGHT_ULPS: Final = 4.0
"""A joint between two segments is no node when it deviates from the straight line by at most this; ulps of
the site's extent. It is what rounding leaves of a point that was computed on a straight line."""

COORDINATE_MAX: Final = 1e12
"""Largest number in a design; in its units. Beyond it even millimetres are no longer resolved to a micrometre."""

NUMBER_MIN: Final = 1e-100
"""Smallest number but 0 in a design; in its units. Squares of smaller ones vanish in float64."""

CELL_MIN: Final = 1e-9
"""Smallest side of a cell; in the units of the design. Smaller is a slip of the unit, not a drawing."""

CELL_ASPECT_MAX: Final = 1e4
"""Longest over shortest vector of the reduced lattice basis; no unit. The number of copies that can shape a
tile grows with it."""

SITE_EXTENT_MAX: Final = 100.0
"""Largest extent of a site; relative to the square root of the cell's area. Beyond it copies overlap by the thousand,
and the time grows with the square."""

ANGLE_MIN: Final = 1e-6
"""Smallest distance of a cell's angle from 0 and 180; degrees."""

UNIT_SNAP: Final = 1e-9
"""How near the linear part of an operation must be to a rotation or reflection of the lattice; no unit.
Lattices are built exactly, to a few ulps; an operation of another lattice is wrong by far more."""

PIECES_MAX: Final = 1_000_000
"""Most segments that the curves of one site are flattened to; a count. More means a wrong tolerance."""

PAIRS_MAX: Final = 2_000_000
"""Most pairs of segments with overlapping boxes in one site; a count. Their work arrays take some 600 MB."""

FILE_BYTES_MAX: Final = 64 * 2**20
"""Largest design file; bytes. A device or a wrong file is refused before it fills the memory."""

SAME_POINT: Final = 1e-13
"""How near the image of a node must be to a node for an operation to map a site onto itself; relative to
the cell or the site, whichever is larger. Hundreds of ulps, as flattened curves are symmetric only up to
rounding. Far from the origin the rounding of coordinates may be more, and counts instead."""

TOUCHING: Final = 1e-11
"""Copies that are nearer than this touch; relative to the cell's longer side. Ten times PROOF_LIMIT: at less, the
width of the neck between them would be lost in the accuracy that is promised."""
