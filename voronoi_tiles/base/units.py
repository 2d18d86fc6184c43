"""Units of length, and lengths as people write them: "600mm", "3cm", "1in", "0.15", and sizes such as "600x300mm"."""

from __future__ import annotations

import math
import re
from fractions import Fraction
from typing import Final, Literal, get_args

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.text import NUMBER
from voronoi_tiles.base.tolerance import COORDINATE_MAX

Units = Literal["mm", "cm", "in"]

_METRE, _INCH = Fraction(1000), Fraction("25.4")

MILLIMETRES: Final[dict[str, Fraction]] = {
    "mm": _METRE / 1000,
    "cm": _METRE / 100,
    "in": _INCH,
    # CSS
    "px": _INCH / 96,
    "pt": _INCH / 72,
    "pc": _INCH / 6,
    "q": _METRE / 4000,
    # DXF
    "ft": _INCH * 12,
    "mi": _INCH * 63360,
    "m": _METRE,
    "km": _METRE * 1000,
    "microinch": _INCH / 10**6,
    "mil": _INCH / 1000,
    "yd": _INCH * 36,
    "angstrom": _METRE / 10**10,
    "nm": _METRE / 10**9,
    "um": _METRE / 10**6,
    "dm": _METRE / 10,
    "dam": _METRE * 10,
    "hm": _METRE * 100,
}
"""Millimetres in each unit of length, exactly."""

RELATIVE: Final = ("em", "rem", "ex", "ch", "rex", "rch", "cap", "ic", "lh", "rlh", "vw", "vh", "vmin", "vmax")
"""CSS's units of length that depend on the font or on the window."""

UNIT_MM: Final[dict[Units, float]] = {unit: float(MILLIMETRES[unit]) for unit in get_args(Units)}
"""Millimetres in each unit that designs and options take."""

_LENGTH = re.compile(rf"({NUMBER})\s*([^\W\d_]*)")
_REMEDY = "Write a length as 600mm, 3cm, 1in or 0.15; a plain number is millimetres."
_SIZE_REMEDY = "Write a size as 600x300mm, 60cmx30cm or 600x300; plain numbers are millimetres."


def parse_length(text: str) -> float:
    """Read a length; millimetres.

    A number with the unit mm, cm or in, or with none, which means millimetres; a sign is allowed. Raises DesignError
    for anything else, and for numbers beyond COORDINATE_MAX.
    """
    number, unit = _split(text.strip(), text, _REMEDY)
    return _millimetres(number, unit, text, _REMEDY)


def parse_size(text: str) -> tuple[float, float]:
    """Read a width and a height, "600x300mm"; millimetres.

    Where only the second carries a unit, it is the unit of both. Raises DesignError as `parse_length` does, and where
    one of them is not greater than 0.
    """
    parts = re.split(r"[x\u00d7]", text.strip(), flags=re.IGNORECASE)
    if len(parts) != 2:
        raise DesignError(f"{text!r} is no size", remedy=_SIZE_REMEDY)
    (width, width_unit), (height, height_unit) = (_split(part.strip(), text, _SIZE_REMEDY) for part in parts)
    sides = (
        _millimetres(width, width_unit or height_unit, text, _SIZE_REMEDY),
        _millimetres(height, height_unit, text, _SIZE_REMEDY),
    )
    if min(sides) <= 0.0:
        raise DesignError(f"{text!r} is no size: both sides must be greater than 0", remedy=_SIZE_REMEDY)
    return sides


def _split(part: str, text: str, remedy: str) -> tuple[str, str]:
    """The number and the unit of a length."""
    match = _LENGTH.fullmatch(part)
    if match is None:
        raise DesignError(f"{text!r} is no {'size' if remedy is _SIZE_REMEDY else 'length'}", remedy=remedy)
    return match[1], match[2].lower()


def _millimetres(number: str, unit: str, text: str, remedy: str) -> float:
    """The length in millimetres."""
    unit = unit or "mm"
    if unit not in UNIT_MM:
        raise DesignError(f"unknown unit {unit!r} in {text!r}", remedy=f"Use {', '.join(UNIT_MM)}. {remedy}")
    length = float(number)
    if unit != "mm" and abs(length) <= COORDINATE_MAX:
        length = float(Fraction(number) * MILLIMETRES[unit])  # rounded once: 12in are 304.8
    if not math.isfinite(length) or abs(length) > COORDINATE_MAX:
        raise DesignError(f"{text!r} is beyond {COORDINATE_MAX:g} mm", remedy=remedy)
    return length
