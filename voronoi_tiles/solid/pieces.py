"""The pieces of solids: what the writers of files are given."""

from __future__ import annotations

from dataclasses import dataclass

from voronoi_tiles.solid.mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class SolidPiece:
    """A piece: its name, the name of its tile's site, the index of its colour, and its mesh."""

    name: str
    site: str
    colour: int
    mesh: TriangleMesh
