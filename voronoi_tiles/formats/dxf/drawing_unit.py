"""The unit of a DXF file, by what its header says and by nothing else.

$INSUNITS names the unit. Where it is missing the file declares none, and what is taken is a guess: $LUNITS shows
lengths in feet and inches only where a unit is an inch, and $MEASUREMENT tells drawings in English units from metric
ones. It is no unit: where $INSUNITS says that there is none, it is not asked. Source: Autodesk, "AutoCAD DXF
Reference", and its system variables INSUNITS, LUNITS and MEASUREMENT.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Final, NamedTuple

from voronoi_tiles.base.units import MILLIMETRES

_METRE: Final = MILLIMETRES["m"]
_SURVEY_FOOT: Final = Fraction(1200, 3937) * _METRE  # the United States' law of 1893
_AU: Final = 149_597_870_700 * _METRE

_COMMON: Final = (
    *("in", "ft", "mi", "mm", "cm", "m", "km", "microinch", "mil", "yd"),
    *("angstrom", "nm", "um", "dm", "dam", "hm"),
)
_INSUNITS: Final[dict[int, tuple[str, Fraction]]] = {
    **{code: (name, MILLIMETRES[name]) for code, name in enumerate(_COMMON, start=1)},
    17: ("gigametre", 10**9 * _METRE),
    18: ("au", _AU),
    19: ("light-year", 9_460_730_472_580_800 * _METRE),
    20: ("parsec", Fraction("206264.80624709636") * _AU),  # 648000 / pi
    21: ("US survey ft", _SURVEY_FOOT),
    22: ("US survey in", _SURVEY_FOOT / 12),
    23: ("US survey yd", _SURVEY_FOOT * 3),
    24: ("US survey mi", _SURVEY_FOOT * 5280),
}
"""The name of the unit and its millimetres, exactly, by $INSUNITS."""

_FEET_AND_INCHES: Final = (3, 4)
"""$LUNITS: engineering and architectural."""

HEADER_VARIABLES: Final = ("$INSUNITS", "$MEASUREMENT", "$LUNITS")
"""What `unit_of` reads."""


class DxfUnit(NamedTuple):
    """The unit of a file: `name` as it is declared, "" where none is; then `guess` says what was taken for it."""

    name: str
    millimetres: Fraction
    guess: str = ""


def unit_of(stated: Mapping[str, str]) -> DxfUnit:
    """The unit by the variables that the header states, each by its value's text."""
    code = _whole(stated.get("$INSUNITS"))
    if code in _INSUNITS:
        return DxfUnit(*_INSUNITS[code])
    none = "the file declares no unit" if code in (None, 0) else f"$INSUNITS {code} is no unit"
    if _whole(stated.get("$LUNITS")) in _FEET_AND_INCHES:
        return DxfUnit("", MILLIMETRES["in"], f"{none}; inches were taken, as $LUNITS shows feet and inches")
    english = _whole(stated.get("$MEASUREMENT")) == 0
    if english and code is None:
        return DxfUnit("", MILLIMETRES["in"], f"{none}; inches were taken, as $MEASUREMENT says English units")
    doubt = ", though $MEASUREMENT says English units" if english else ""
    return DxfUnit("", MILLIMETRES["mm"], f"{none}; millimetres were taken{doubt}")


def _whole(text: str | None) -> int | None:
    """The whole number that a text holds, None where it holds none."""
    try:
        value = float(text or "")
    except ValueError:
        return None
    return int(value) if value.is_integer() else None
