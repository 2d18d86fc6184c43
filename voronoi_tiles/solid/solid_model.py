"""Solids that fill a slab: pieces, each a closed mesh with its colour, and what is said and proved of them."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal, get_args

import numpy as np

from voronoi_tiles.base.arguments import path_name
from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.files import refuse_overwriting, writing
from voronoi_tiles.base.text import counted
from voronoi_tiles.base.version import __version__
from voronoi_tiles.fabrication.exporting import format_of
from voronoi_tiles.formats.png import PngStream, Sink
from voronoi_tiles.solid.pieces import SolidPiece
from voronoi_tiles.solid.stl import write_stl
from voronoi_tiles.solid.threemf import write_threemf

SolidFormat = Literal["3mf", "stl", "png"]

SOLID_FORMATS: Final[tuple[SolidFormat, ...]] = get_args(SolidFormat)

AROUND: Final = "neighbours and the room between them are for the picture alone"
"""What is noted of a model that is a tile with its neighbours pulled apart."""


@dataclass(frozen=True, eq=False, repr=False)
class SolidModel:
    """Pieces that lie on the plane z = 0, in millimetres, and all that files say of them.

    `colours` are "#rrggbb"; where `grouped`, all pieces of a colour are one object of a file. `recipe` is what they can
    be made from again, `proof` what was proved of them, in the types of JSON, and `proved` the same in a line; `notes`
    say in sentences what they have lost. `files` are those that they were made from, which are not overwritten.
    `assembly` finds how they go together, see `solid_report`; None for prisms.
    """

    title: str
    pieces: tuple[SolidPiece, ...]
    colours: tuple[str, ...]
    recipe: Mapping[str, str]
    proof: Mapping[str, Any]
    proved: str
    grouped: bool = False
    notes: tuple[str, ...] = ()
    files: tuple[str, ...] = ()
    assembly: Callable[[], dict[str, Any]] | None = None

    def __repr__(self) -> str:
        return f"<SolidModel: {self.summary()}>"

    @property
    def bounds(self) -> Floats:
        """The lowest and the highest corner of the box around all pieces: float64 (2, 3), millimetres."""
        points = np.concatenate([piece.mesh.vertices for piece in self.pieces])
        return np.stack((points.min(axis=0), points.max(axis=0)))

    @property
    def volume(self) -> float:
        """The volume of all pieces in cubic millimetres."""
        return float(np.sum([piece.mesh.volume for piece in self.pieces]))

    def save(
        self, path: str | os.PathLike[str], file_format: SolidFormat | None = None, *, size: int | None = None
    ) -> None:
        """Write a file, whole or not at all: 3MF, STL, or a picture as PNG, by its suffix or as said.

        The longer side of a picture has `size` pixels, None for 1200.

        Raises OutputError, also where it was made from this file, and ArgumentError for another format, and a `size`
        where there is no picture.
        """
        name = path_name("path", path)
        form = format_of(name, SOLID_FORMATS) if file_format is None else file_format
        if form not in SOLID_FORMATS:
            raise ArgumentError(f"no solid can be written as {form!r}", remedy=f"Use {' or '.join(SOLID_FORMATS)}.")
        if size is not None and form != "png":
            raise ArgumentError(f"`size` {size!r} is for a picture", remedy="Write a .png, or leave it out.")
        refuse_overwriting([name], self.files)
        with writing(name) as file:
            match form:
                case "stl":
                    write_stl(self.pieces, self.title, file)
                case "3mf":
                    write_threemf(self.pieces, self.title, self.colours, self.recipe, file, grouped=self.grouped)
                case "png":
                    self._draw(file, size)

    def _draw(self, file: Sink, size: int | None) -> None:
        """Write a shaded picture."""
        from voronoi_tiles.solid.solid_picture import SIZE, picture

        pixels = picture(self.pieces, self.colours, SIZE if size is None else size)
        text = {"Title": self.title, "Software": f"voronoi-tiles {__version__}"}
        with PngStream(file, pixels.shape[1], pixels.shape[0], text=text) as png:
            png.write(pixels)

    def summary(self) -> str:
        """Say in a line what they come to."""
        x, y, z = (self.bounds[1] - self.bounds[0]).tolist()
        triangles = sum(len(piece.mesh.triangles) for piece in self.pieces)
        colours = f" in {counted(len(self.colours), 'colour')}" if self.grouped else ""
        return (
            f"{counted(len(self.pieces), 'solid')}{colours}, {x:.5g} x {y:.5g} x {z:.5g} mm, "
            f"{self.volume / 1000:.4g} cm\N{SUPERSCRIPT THREE}, {triangles:,} triangles"
        )
