"""What is to be made of a tiling: the sheet, how its edges are cut, what is engraved. All lengths are millimetres."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any, Literal, get_args

from voronoi_tiles.base.errors import DesignError, VoronoiTilesError
from voronoi_tiles.base.units import parse_length, parse_size

Fit = Literal["whole", "clip", "frame"]
Edges = Literal["once", "pieces"]
Curves = Literal["exact", "arc", "spline", "polyline"]
Art = Literal["whole", "clip", "none"]
Labels = Literal["none", "number", "site"]
Colours = Literal["none", "layers", "files"]

ACCURACY_MM = 0.005
"""How far approximated curves may be from the exact ones, where the caller does not say; a twentieth of a kerf."""

ACCURACY_MIN = 1e-5
"""Finest accuracy; millimetres. A hundredth of a micrometre; files hold nanometres."""

APART_MM = 1.0
"""How far contours with a kerf are kept apart where the caller does not say; millimetres: no sliver is left to burn."""

SHEET_MAX = 100_000.0
"""Largest side of a sheet, and largest length of an option; millimetres."""

SHEET_MIN = 0.1
"""Smallest side of a sheet; millimetres."""

LABEL_MIN = 0.5
"""Smallest height of a label; millimetres. What is smaller nobody reads."""


class JobError(VoronoiTilesError, ValueError):
    """A job that cannot be done; `message` without a full stop, `remedy` a sentence."""

    def __init__(self, message: str, *, remedy: str) -> None:
        super().__init__(message)
        self.message = message
        self.remedy = remedy

    def __str__(self) -> str:
        return f"{self.message}. {self.remedy}"


@dataclass(frozen=True, kw_only=True)
class Job:
    """What is to be made of a tiling; lengths in millimetres, angles in degrees.

    `sheet` is its width and height, or the path of a drawing whose closed paths bound it; without it one of each tile
    is made. `margin` stays free inside its edge (without a sheet, around the tiles). `fit`: whole tiles only, tiles
    clipped at the edge, or whole tiles and the frame around them. The design's origin lies in the middle of
    the sheet, turned by `rotate` counter-clockwise and moved by `offset`; None moves whole tiles to where most of them
    fit, and clipped ones not at all. `edges`: every shared edge cut once,
    or every tile a closed contour of its own; None takes once for sheets and pieces without, or where an option needs
    them. `gap` is the least distance between contours, for which pieces are pulled apart (None: none, but
    with a kerf APART_MM or twice the kerf, lest a cut hurts the next piece); `kerf` the width of the cut, half of which
    contours keep from the pieces; `fillet` the radius of corners; `tabs` the width of the bridges that hold
    pieces. `curves` (None: what the preset wants for the format) are the exact curves, or arcs, splines or
    polylines within `accuracy` (SVG has arcs as cubic curves, a nanometre off). `preset` is the name of a fabrication
    preset, or a TOML file. `labels` of `label_height` number the pieces; `marks` are for aligning, `bar` is 100 mm
    long. `colours` puts each colour of a proper colouring on a layer, or into a file, of its own; `only_colour` leaves
    out all others, -1 all but a frame.
    `art` of sites is drawn whole, clipped to the tile, or not at all.

    Lengths may also be texts with a unit, "0.15mm" or "600x300mm". Raises JobError for values that cannot be, and that
    contradict each other.
    """

    sheet: tuple[float, float] | str | None = None
    margin: float = 0.0
    fit: Fit = "whole"
    rotate: float = 0.0
    offset: complex | None = None
    edges: Edges | None = None
    gap: float | None = None
    kerf: float = 0.0
    fillet: float = 0.0
    tabs: float = 0.0
    accuracy: float = ACCURACY_MM
    curves: Curves | None = None
    preset: str = "plain"
    labels: Labels = "none"
    label_height: float = 3.0
    marks: bool = False
    bar: bool = False
    colours: Colours = "none"
    only_colour: int | None = None
    art: Art = "whole"

    def __post_init__(self) -> None:
        self._read_lengths()
        for name, kind in (
            ("fit", Fit),
            ("art", Art),
            ("labels", Labels),
            ("colours", Colours),
        ):
            _require_one_of(name, getattr(self, name), get_args(kind))
        if self.edges is not None:
            _require_one_of("edges", self.edges, get_args(Edges))
        if self.curves is not None:
            _require_one_of("curves", self.curves, get_args(Curves))
        for name in ("margin", "gap", "kerf", "fillet", "tabs"):
            value = getattr(self, name) or 0.0
            if not 0.0 <= value <= SHEET_MAX:
                raise JobError(f"{name} {value:g} mm cannot be", remedy=f"Give a length from 0 to {SHEET_MAX:,.0f} mm.")
        if not (math.isfinite(self.rotate) and abs(self.offset or 0j) <= SHEET_MAX):
            raise JobError("the turn or the offset is not a number, or too large", remedy="Give finite numbers.")
        if not ACCURACY_MIN <= self.accuracy <= 1.0:
            raise JobError(
                f"an accuracy of {self.accuracy:g} mm cannot be",
                remedy=f"Give one from {ACCURACY_MIN:g} to 1 mm; the default is {ACCURACY_MM:g} mm.",
            )
        if not LABEL_MIN <= self.label_height <= 1000.0:
            raise JobError(
                f"labels of {self.label_height:g} mm cannot be", remedy=f"Give a height from {LABEL_MIN:g} to 1000 mm."
            )
        for name in ("marks", "bar"):
            if not isinstance(getattr(self, name), bool):
                raise JobError(f"{name} {getattr(self, name)!r} cannot be", remedy="Use True or False.")
        if not isinstance(self.preset, str):
            raise JobError(f"a preset {self.preset!r} cannot be", remedy="Give a name, or the path of a TOML file.")
        if self.only_colour is not None and (
            isinstance(self.only_colour, bool) or not isinstance(self.only_colour, int)
        ):
            raise JobError(f"a colour {self.only_colour!r} cannot be", remedy="Give its number, from 0.")
        self._check_sheet()
        self._check_edges()

    @property
    def moves_contours(self) -> bool:
        """Whether contours differ from the tiles' outlines: by half a kerf, or by round corners."""
        return self.kerf > 0.0 or self.fillet > 0.0

    @property
    def apart(self) -> float | None:
        """How far contours are kept apart; None where they may stay where they are."""
        if self.gap is None:
            return max(APART_MM, 2 * self.kerf) if self.kerf > 0.0 else None
        return self.gap if self.gap > 0.0 or self.kerf > 0.0 else None

    @property
    def pieces(self) -> bool:
        """Whether every tile is a closed contour of its own."""
        if self.edges is not None:
            return self.edges == "pieces"
        return self.sheet is None or self._needs_pieces() is not None

    def recipe(self) -> dict[str, Any]:
        """What differs from the defaults, in the types of JSON."""
        plain = asdict(Job())
        mine = {key: value for key, value in asdict(self).items() if value != plain[key]}
        return {
            key: [value.real, value.imag]
            if isinstance(value, complex)
            else list(value)
            if isinstance(value, tuple)
            else value
            for key, value in mine.items()
        }

    def _read_lengths(self) -> None:
        """Make numbers of lengths that are texts or whole numbers."""
        for name in ("margin", "gap", "kerf", "fillet", "tabs", "accuracy", "label_height", "rotate"):
            value = getattr(self, name)
            if name != "gap" or value is not None:
                object.__setattr__(self, name, _number(name, value))
        if self.offset is not None:
            if isinstance(self.offset, bool) or not isinstance(self.offset, int | float | complex):
                raise JobError(f"an offset of {self.offset!r} cannot be", remedy="Give a number, 3 - 2j.")
            object.__setattr__(self, "offset", complex(self.offset))
        object.__setattr__(self, "sheet", _sheet(self.sheet))

    def _needs_pieces(self) -> str | None:
        """Name an option that needs closed pieces."""
        for name in ("kerf", "gap", "fillet"):
            if (getattr(self, name) or 0.0) > 0.0:
                return name
        return "colours" if self.colours != "none" or self.only_colour is not None else None

    def _check_edges(self) -> None:
        name = self._needs_pieces()
        if self.edges == "once" and name is not None:
            raise JobError(
                f"--{name} needs pieces: an edge that is cut once belongs to two of them",
                remedy=f"Use --edges pieces, or leave --{name} out.",
            )
        if self.tabs > 0.0 and self.sheet is not None and self.pieces and self.apart is None:
            raise JobError(
                "--tabs hold nothing where the contours of two pieces lie on each other",
                remedy="Pull the pieces apart, --gap 1mm, or use --edges once.",
            )
        if self.fit == "frame" and self.apart is not None:
            raise JobError(
                f"--{'gap' if self.gap else 'kerf'} pulls the tiles apart, and --fit frame leaves them no room",
                remedy="Cut the frame without it, or use --fit whole.",
            )

    def _check_sheet(self) -> None:
        if self.sheet is None:
            for name, default in (("fit", "whole"), ("offset", None), ("marks", False)):
                if getattr(self, name) != default:
                    raise JobError(f"--{name} is about a sheet, and there is none", remedy="Add --sheet 600x300mm.")
            return
        if isinstance(self.sheet, str):
            return
        width, height = self.sheet
        if not (SHEET_MIN <= width <= SHEET_MAX and SHEET_MIN <= height <= SHEET_MAX):
            raise JobError(
                f"a sheet of {width:g} x {height:g} mm cannot be",
                remedy=f"Write --sheet 600x300mm, with sides from {SHEET_MIN:g} to {SHEET_MAX:,.0f} mm.",
            )
        if 2.0 * self.margin >= min(width, height):
            raise JobError(
                f"a margin of {self.margin:g} mm leaves nothing of a sheet of {width:g} x {height:g} mm",
                remedy="Make the margin smaller, or the sheet larger.",
            )


def _number(name: str, value: object) -> float:
    """Read a length, or an angle, that is a number or a text. Raises JobError."""
    try:
        if isinstance(value, str):
            return parse_length(value)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise JobError(f"{name} {value!r} cannot be", remedy='Give a number of millimetres, or a text: "0.15mm".')
        return float(value)
    except (DesignError, OverflowError) as error:
        raise JobError(f"{name} {value!r} cannot be", remedy='Give a number of millimetres, or "0.15mm".') from error


def _sheet(value: Any) -> tuple[float, float] | str | None:
    """Read a sheet: two numbers, the text of a size, or the name of a drawing. Raises JobError."""
    remedy = 'Give two numbers of millimetres, "600x300mm", or the name of an SVG or DXF file.'
    if value is None or (isinstance(value, str) and value.lower().endswith((".svg", ".svgz", ".dxf"))):
        return value
    try:
        if isinstance(value, str):
            return parse_size(value)
        width, height = value
    except (DesignError, TypeError, ValueError) as error:
        raise JobError(f"a sheet of {value!r} cannot be", remedy=remedy) from error
    return _number("sheet", width), _number("sheet", height)


def _require_one_of(name: str, value: object, allowed: tuple[str, ...]) -> None:
    """Raise JobError for a word that is none of those allowed."""
    if value not in allowed:
        raise JobError(f"{name} {value!r} is unknown", remedy=f"Use one of {', '.join(allowed)}.")
