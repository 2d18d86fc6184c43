"""From a design and a job of the page to the solids that it shows, and to the files of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from math import inf
from operator import itemgetter
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any, Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.base.errors import ArgumentError, VoronoiTilesError
from voronoi_tiles.base.values import shown
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.solid.extrusion import extrude, surrounded
from voronoi_tiles.solid.pieces import SolidPiece
from voronoi_tiles.solid.solid_job import SolidJob
from voronoi_tiles.solid.solid_model import SOLID_FORMATS, SolidModel
from voronoi_tiles.solid.solid_picture import smooth_normals
from voronoi_tiles.solid.standing import stand
from voronoi_tiles.studio.frames import pack
from voronoi_tiles.studio.making import stem_of, tiling_of

SHOWN_MAX: Final = 1_500_000
"""Most triangles that are sent to be shown; a count. They take 60 MB on their way, and a browser hardly turns more."""

SLOW_S: Final = 0.7
"""A loft that takes longer has a coarse one before it; seconds."""

_COARSE: Final = 0.005
"""How far the walls of a coarse loft are from the true ones; a share of the square root of the cell's area."""


class ShownSolid(NamedTuple):
    """The frame of a message "solid" with its meshes, and whether there is more to come of the same design."""

    frame: bytes
    more: bool = False


@dataclass
class Modeller:
    """Solids of one design after the other; `seconds` is what the last loft took, and the next is taken to take."""

    seconds: float = inf

    def solids(self, rev: int, design: Mapping[str, Any], job: Mapping[str, Any], name: str) -> Iterator[ShownSolid]:
        """The message "solid" of a design; before that of a slow loft there is one of a coarse one.

        Raises VoronoiTilesError.
        """
        begun = perf_counter()
        asked = read_solid_job(job)
        read = Design.from_dict(design, name=name)
        if read.standing is None:
            yield ShownSolid(
                _frame(rev, _prisms(design, name, asked, apart=False), begun, sheet=asked.sheet is not None)
            )
            return
        if self.seconds > SLOW_S:
            # Where it has no walls there is none.
            with suppress(VoronoiTilesError):
                yield ShownSolid(_frame(rev, _coarse(design, name, asked), begun, coarse=True), more=True)
        start = perf_counter()
        made = stand(read, asked, around=True, apart=False)
        self.seconds = perf_counter() - start
        yield ShownSolid(_frame(rev, made, begun))


def solid_file(design: Mapping[str, Any], job: Mapping[str, Any], name: str) -> tuple[str, bytes]:
    """The name and the bytes of the file that `voronoi-tiles solid` writes of a design: 3MF, STL, or a picture.

    The job names the "format", and may name the "size" of a picture: its longer side in pixels. Raises
    VoronoiTilesError.
    """
    given = dict(job)
    asked, size = given.pop("format", SOLID_FORMATS[0]), given.pop("size", None)
    form = next((form for form in SOLID_FORMATS if form == asked), None)
    if form is None:
        raise ArgumentError(f"unknown `format` {shown(asked)}", remedy=f"Use one of {', '.join(SOLID_FORMATS)}.")
    options = read_solid_job(given)
    read = Design.from_dict(design, name=name)
    around = form == "png" and options.sheet is None
    if read.standing is not None:
        made = stand(read, options, around=around)
    else:
        made = _prisms(design, name, options, apart=True) if around else extrude(tiling_of(design, name), options)
    with TemporaryDirectory(prefix="voronoi-tiles-") as folder:
        path = Path(folder) / f"{stem_of(name)}.{form}"
        made.save(path, size=size)
        return path.name, path.read_bytes()


def read_solid_job(job: Mapping[str, Any]) -> SolidJob:
    """The job of the page's options. Raises JobError."""
    known = SolidJob.options()
    for name in job:
        if name not in known:
            raise JobError(f"a solid has no option {shown(name)}", remedy="Load the page again.")
    return SolidJob(**job)


def _prisms(design: Mapping[str, Any], name: str, job: SolidJob, *, apart: bool) -> SolidModel:
    """The prisms of a flat design: those of its sheet, or one and its neighbours."""
    tiling = tiling_of(design, name)
    return surrounded(tiling, job, apart=apart) if job.sheet is None else extrude(tiling, job)


def _coarse(design: Mapping[str, Any], name: str, job: SolidJob) -> SolidModel:
    """A loft of few layers and long chords, that fills the slab."""
    few = Design.from_dict(
        {**design, "solid": {key: value for key, value in design["solid"].items() if key != "layers"}}, name=name
    )
    accuracy = _COARSE * few.lattice.det**0.5 * few.unit_mm
    accuracy = min(max(accuracy, job.accuracy or 0.0), 1.0)
    return stand(few, replace(job, accuracy=accuracy, clearance=0.0, chamfer=0.0), around=True, apart=False)


def _frame(rev: int, model: SolidModel, begun: float, *, coarse: bool = False, sheet: bool = False) -> bytes:
    """The message "solid" and, behind it, the meshes of its pieces, one after the other, in millimetres.

    Each has its vertices less the "centre" as float32 (n, 3), triangles as uint32 (m, 3) and the normals at their
    corners as int8 (m, 3, 4), times 127 with a zero behind them: all little-endian. The "middle" of a piece is where
    the middle of its box is; the centre is that of the first piece, or of all on a sheet.
    """
    boxes = np.array([(p.mesh.vertices.min(axis=0), p.mesh.vertices.max(axis=0)) for p in model.pieces])
    centre = model.bounds.mean(axis=0) if sheet else boxes[0].mean(axis=0)
    counts = np.cumsum([len(piece.mesh.triangles) for piece in model.pieces])
    pieces = model.pieces[: max(int(np.searchsorted(counts, SHOWN_MAX, side="right")), 1)]
    first = {piece.site: k for k, piece in reversed(list(enumerate(model.pieces)))}
    message = {
        "type": "solid",
        "rev": rev,
        "coarse": coarse,
        "colours": list(model.colours),
        "centre": centre.tolist(),
        "pieces": [
            {
                "site": piece.site,
                "colour": piece.colour,
                "vertices": len(piece.mesh.vertices),
                "triangles": len(piece.mesh.triangles),
                "middle": middle,
            }
            for piece, middle in zip(pieces, (boxes.mean(axis=1) - centre).tolist(), strict=False)
        ],
        "tiles": [
            {
                "site": site,
                "size": (boxes[k, 1] - boxes[k, 0]).tolist(),
                "volume": model.pieces[k].mesh.volume,
                "triangles": len(model.pieces[k].mesh.triangles),
            }
            for site, k in sorted(first.items(), key=itemgetter(1))
        ],
        "count": len(model.pieces),
        "proved": model.proved,
        "notes": list(model.notes),
        "ms": round(1000 * (perf_counter() - begun), 3),
    }
    return pack(message, b"".join(_buffers(piece, centre) for piece in pieces))


def _buffers(piece: SolidPiece, centre: Floats) -> bytes:
    """Vertices, triangles and normals of a piece."""
    mesh = piece.mesh
    normals = np.zeros((len(mesh.triangles), 3, 4), np.int8)
    normals[:, :, :3] = np.round(127 * smooth_normals(mesh))
    return b"".join(
        (
            (mesh.vertices - centre).astype("<f4").tobytes(),
            mesh.triangles.astype("<u4").tobytes(),
            normals.tobytes(),
        )
    )
