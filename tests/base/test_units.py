"""Units of length: one table, whoever reads them."""

from __future__ import annotations

from fractions import Fraction

import ezdxf.units
import pytest

from voronoi_tiles.base.units import MILLIMETRES, UNIT_MM
from voronoi_tiles.formats.dxf.drawing_unit import unit_of
from voronoi_tiles.formats.svg.lengths import length


def test_the_inch_is_exact() -> None:
    """By the agreement of 1959, and CSS has 96 pixels, 72 points and 6 picas to it."""
    assert MILLIMETRES["in"] == Fraction(254, 10)
    assert [MILLIMETRES["in"] / MILLIMETRES[unit] for unit in ("px", "pt", "pc", "mil")] == [96, 72, 6, 1000]
    assert MILLIMETRES["microinch"] * 10**6 == MILLIMETRES["in"]
    assert [MILLIMETRES[unit] / MILLIMETRES["in"] for unit in ("ft", "yd", "mi")] == [12, 36, 5280 * 12]
    assert UNIT_MM == {"mm": 1.0, "cm": 10.0, "in": 25.4}


@pytest.mark.parametrize("number", [*range(1, 8), *range(10, 19)])
def test_units_of_dxf_are_those_of_another_reader(number: int) -> None:
    """By $INSUNITS, as ezdxf converts them, in some eight digits; others it does not know, or in three digits."""
    factor = ezdxf.units.conversion_factor(ezdxf.units.InsertUnits(number), ezdxf.units.InsertUnits.Millimeters)
    assert float(unit_of({"$INSUNITS": str(number)}).millimetres) == pytest.approx(factor, rel=1e-7)


@pytest.mark.parametrize(
    ("text", "pixels"), [("1in", 96), (" 2.54 cm ", 96), ("25.4MM", 96), ("101.6q", 96), ("6e0pc", 96)]
)
def test_lengths_of_svg(text: str, pixels: float) -> None:
    """In any unit, in either case, with spaces around and before it."""
    assert length(text, 0.0) == pytest.approx(pixels, rel=1e-15)


def test_long_lengths_take_no_time() -> None:
    """A number of a million digits and a million spaces are looked at once."""
    assert length("0." + "0" * 1_000_000 + " " * 1_000_000 + "mm", 0.0) == 0.0
    with pytest.raises(ValueError, match="no length"):
        length("1" * 1_000_000 + " " * 1_000_000 + "?", 0.0)
