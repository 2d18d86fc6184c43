"""STL files: triangles with their normals, binary, single precision, all pieces in one.

Normals are true: a file that has none, of coordinates that are round and positive, PrusaSlicer takes for a text and
refuses. STL has no unit; everybody reads millimetres. Source: StereoLithography Interface Specification, 3D Systems
(1989).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from voronoi_tiles.base.version import __version__
from voronoi_tiles.formats.png import Sink
from voronoi_tiles.solid.pieces import SolidPiece

_HEADER: Final = 80
"""How long the text at the beginning is; bytes."""

_FACET: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(pieces: Sequence[SolidPiece], title: str, file: Sink) -> None:
    """Write all pieces; a reader has to find out from their triangles what belongs together."""
    # It must not begin with "solid": that is how texts do.
    header = f"voronoi-tiles {__version__}: {title}".encode("ascii", "replace")
    file.write(header[:_HEADER].ljust(_HEADER))
    file.write(np.array([sum(len(piece.mesh.triangles) for piece in pieces)], "<u4").tobytes())
    for piece in pieces:
        facets = np.zeros(len(piece.mesh.triangles), _FACET)
        normals = piece.mesh.normals
        # A triangle of no area lies in a level face: those are what points on one line occur in.
        normals[~normals.any(axis=1), 2] = 1.0
        facets["normal"] = normals
        facets["corners"] = piece.mesh.corners
        file.write(facets.tobytes())
