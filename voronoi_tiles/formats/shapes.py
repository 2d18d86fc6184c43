"""What a file of others is read into: shapes of lines and curves in millimetres, and what was left out.

The limits that keep hostile files from filling time or memory stand here as well.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.paths.paths import Paths

BYTES_MAX: Final = 256 * 2**20
"""Largest file; bytes. Checked before it is parsed; for compressed files also after inflating."""

DXF_BYTES_MAX: Final = 64 * 2**20
"""Largest DXF file; bytes. Twenty seconds' work; a text of tags takes some ten times its size in memory."""

GCODE_BYTES_MAX: Final = 64 * 2**20
"""Largest G-code file; bytes. A sheet of 10,000 tiles has a third of it."""

LINES_MAX: Final = 4_000_000
"""Most lines of a G-code file; a count. Half a minute's work."""

DEPTH_MAX: Final = 1_000
"""Deepest nesting of groups, clones and blocks; a count. Drawings have some ten."""

ELEMENTS_MAX: Final = 200_000
"""Most elements of an SVG file, or entities of a DXF file; a count. Ten seconds' work, of a broken DXF file that ezdxf
has to recover up to three times as long, and as much again to judge them. A sheet of 10,000 tiles has 20,000."""

VISITS_MAX: Final = 300_000
"""Most elements that are drawn, each clone counted with all it holds; a count. Nested clones double at every level."""

DXF_COPIES_MAX: Final = 200_000
"""Most entities that blocks draw, each block counted wherever it is inserted; a count. Ten seconds' work."""

DXF_INSERTS_MAX: Final = 30_000
"""Most INSERTs that are followed, those in blocks counted wherever these are inserted; a count. Five seconds' work."""

SEGMENTS_MAX: Final = 2_000_000
"""Most lines and curves of a drawing; a count. A sheet of 10,000 tiles has half a million."""

CURVE_ACCURACY: Final = 1e-4
"""How far a cubic may lie from the ellipse or spline that it stands for; millimetres. A fiftieth of what is judged."""


class DrawingError(DesignError):
    """A drawing that cannot be read; `message`, `file`, `line` and `remedy` are those of DesignError."""


@dataclass(frozen=True, eq=False)
class Shape:
    """One object of a file.

    `paths` are in millimetres, y up; of a file with a page its lower left corner is the origin. `layer` is the name of
    its layer, "" where it has none. `stroke` and `fill` are "#rrggbb", None where there is none; `stroke_width` is in
    millimetres, None where the file does not say. `source` names the object in the file, and `within` is the id of the
    element that was asked for, the innermost of several, that it is or stands in; "" where none was.
    """

    paths: Paths
    layer: str
    stroke: str | None
    fill: str | None
    stroke_width: float | None
    source: str
    within: str = ""

    def __repr__(self) -> str:
        return f"<Shape {self.source!r}: {len(self.paths)} paths on layer {self.layer!r}>"


@dataclass(frozen=True, eq=False)
class Dots:
    """Lines of no length, and shapes of no size, of one object: `places` are complex128 (n,), the rest is as in Shape.

    Some machines burn a point there, others do nothing.
    """

    places: Complexes
    layer: str
    stroke: str | None
    source: str
    within: str = ""

    def __repr__(self) -> str:
        return f"<Dots {self.source!r}: {len(self.places)} on layer {self.layer!r}>"


@dataclass(frozen=True, eq=False)
class ReadDrawing:
    """What a file draws.

    `format` is "svg", "dxf" or "gcode". `width` and `height` of the page are in millimetres, None where the file has no
    page. `unit` is the unit as the file declares it, "" where it declares none; with `unit_known` false the size is a
    guess: by CSS 96 user units to the inch (SVG), or as `unit_guess` says (DXF). `dots` have no size, and are in no
    shape. `ignored` counts what was left out, by the name of its element; `clones` counts what was drawn through
    references (use, INSERT). `remarks` are sentences on what had to be mended or guessed to read the file. `job` is
    what a file of our own says of its job, empty for all others.
    """

    format: str
    width: float | None
    height: float | None
    unit: str
    unit_known: bool
    shapes: tuple[Shape, ...]
    ignored: Mapping[str, int] = field(default_factory=dict)
    clones: int = 0
    remarks: tuple[str, ...] = ()
    dots: tuple[Dots, ...] = ()
    unit_guess: str = ""
    job: Mapping[str, Any] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<ReadDrawing {self.format}: {len(self.shapes)} shapes>"
