"""STL files: triangles with their normals, binary, single precision, all pieces in one.

What rounding leaves is proved to be the solid (`single_precision`) before it is written.

Normals are true: a file that has none, of coordinates that are round and positive, PrusaSlicer takes for a text and
refuses. STL has no unit; everybody reads millimetres. Source: StereoLithography Interface Specification, 3D Systems
(1989).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import numpy.typing as npt

from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.version import __version__
from voronoi_tiles.formats.png import Sink
from voronoi_tiles.solid.pieces import SolidPiece
from voronoi_tiles.solid.single_precision import RoundedAwayError, kept_triangles

_HEADER: Final = 80
"""How long the text at the beginning is; bytes."""

_FACET: Final = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write_stl(pieces: Sequence[SolidPiece], title: str, file: Sink) -> None:
    """Write all pieces; a reader has to find out from their triangles what belongs together.

    Raises ArgumentError where single precision makes something else of a piece, before anything is written.
    """
    every = [_facets(piece) for piece in pieces]
    # It must not begin with "solid": that is how texts do.
    header = f"voronoi-tiles {__version__}: {title}".encode("ascii", "replace")
    file.write(header[:_HEADER].ljust(_HEADER))
    file.write(np.array([sum(map(len, every))], "<u4").tobytes())
    for facets in every:
        file.write(facets.tobytes())


def _facets(piece: SolidPiece) -> npt.NDArray[np.void]:
    """The triangles of a piece that single precision leaves, as they are written."""
    try:
        kept = kept_triangles(piece.mesh)
    except RoundedAwayError as error:
        raise ArgumentError(
            f'the single precision of STL makes no solid of "{piece.name}": {error}',
            remedy="Write 3MF, which has all digits.",
        ) from None
    facets = np.zeros(int(kept.sum()), _FACET)
    normals = piece.mesh.normals[kept]
    # A triangle of no area lies in a level face: those are what points on one line occur in.
    normals[~normals.any(axis=1), 2] = 1.0
    facets["normal"] = normals
    facets["corners"] = piece.mesh.corners[kept]
    return facets
