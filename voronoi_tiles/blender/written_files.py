"""A drawn tiling as files of ours: cut sheets, solids, the design."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from voronoi_tiles.base.errors import OutputError
from voronoi_tiles.blender.drawn_tiling import DrawnTiling
from voronoi_tiles.blender.solid_meshes import solid_model
from voronoi_tiles.designs.drawn_solid import Solid
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.solid.solid_job import SolidJob

FORMATS: Final = {
    ".svg": ("SVG", "A drawing to cut"),
    ".pdf": ("PDF", "A drawing to cut or print"),
    ".lbrn2": ("LightBurn", "A drawing to cut"),
    ".gcode": ("G-code", "The way of a laser with GRBL: give Feed and Power"),
    ".3mf": ("3MF", "Solids to print, in millimetres"),
    ".stl": ("STL", "Solids to print"),
    ".json": ("JSON", "The exact outlines"),
    ".toml": ("Design", "For the command line, and to be opened again"),
}
"""The suffixes of files, and for each a name and what it is, in words."""


@dataclass(frozen=True)
class FileJob:
    """What a file is to hold: millimetres in a unit, and the jobs of drawings and of solids; `solid` is in units."""

    unit_mm: float = 1.0
    flat: Job | None = None
    prisms: SolidJob | None = None
    solid: Solid | None = None


def write_file(drawn: DrawnTiling, path: str, job: FileJob) -> str:
    """Write a file, proved, in the format of its suffix, whole or not at all; say what was written.

    Raises VoronoiTilesError where it cannot be made, OutputError for another suffix.
    """
    name = Path(path)
    match name.suffix.lower():
        case ".toml":
            design = drawn.design(job.unit_mm, job.solid, name.stem)
            design.save(path)
            return f"wrote {name.name}"
        case ".3mf" | ".stl":
            model = solid_model(drawn, job.unit_mm, job.prisms, job.solid)
            model.save(path)
            return f"wrote {name.name}: {model.summary()}"
        case ".svg" | ".pdf" | ".lbrn2" | ".gcode" | ".json" as suffix:
            tiling = drawn.design(job.unit_mm, name=name.stem).tessellate()
            written = tiling.export(path, job=None if suffix == ".json" else job.flat)
            product = written[0].product
            return f"wrote {name.name}" + (f": {product.summary()}" if product else "")
        case suffix:
            raise OutputError(
                f"{name.name or 'this name'} has no suffix of ours", path, remedy=f"Use one of {', '.join(FORMATS)}."
            )
