"""A picture that was rendered into memory."""

from __future__ import annotations

import io
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from voronoi_tiles.base.arguments import path_name
from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.base.files import refuse_overwriting, require_suffix, write_whole
from voronoi_tiles.formats.png import PngStream
from voronoi_tiles.raster.picture import Pixels
from voronoi_tiles.raster.renderer import Provenance


@dataclass(frozen=True, eq=False, repr=False)
class Rendering:
    """A picture: `pixels` is uint8 (rows, columns, 3), red, green, blue, the first row the upper one.

    `text` and `trailer` are what its PNG says, and `pixels_per_metre` its scale; `provenance` tells who rendered it;
    `files` are those that the design was made from, which `save` does not overwrite.
    """

    pixels: Pixels
    text: Mapping[str, str] = field(default_factory=dict)
    pixels_per_metre: float | None = None
    trailer: Mapping[str, str] = field(default_factory=dict)
    provenance: Provenance | None = None
    files: tuple[str, ...] = ()

    def __repr__(self) -> str:
        rows, columns, _ = self.pixels.shape
        touching = "; copies touch" if self.touching else ""
        return f"<Rendering {columns} x {rows}: {self.provenance}{touching}>"

    @property
    def touching(self) -> TouchingCopiesError | None:
        """What keeps the design from being tiled, which the picture marks; None where nothing does."""
        return None if self.provenance is None else self.provenance.touching

    @cached_property
    def png(self) -> bytes:
        """The picture as a PNG file."""
        rows, columns, _ = self.pixels.shape
        buffer = io.BytesIO()
        with PngStream(buffer, columns, rows, pixels_per_metre=self.pixels_per_metre, text=self.text) as png:
            png.write(self.pixels)
            png.trailer.update(self.trailer)
        return buffer.getvalue()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the PNG file, whole or not at all. Raises OutputError, also for one that the design was made from."""
        name = path_name("path", path)
        require_suffix(name, (".png",))
        refuse_overwriting([name], self.files)
        write_whole(name, self.png)

    def _repr_png_(self) -> bytes:
        """Show the picture: notebooks do."""
        return self.png
