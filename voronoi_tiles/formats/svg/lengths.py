"""SVG's and CSS's lengths, with what their units and percentages stand for."""

from __future__ import annotations

import math
import re
from typing import Final, NamedTuple

import tinycss2
from tinycss2.ast import Node as Token

from voronoi_tiles.base.text import NUMBER
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.base.units import MILLIMETRES, RELATIVE
from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.formats.svg.css_text import check_nesting, split

PIXEL: Final = float(MILLIMETRES["px"])
"""One CSS pixel; millimetres."""

_ABSOLUTE: Final = {"": 1.0} | {
    unit: float(MILLIMETRES[unit] / MILLIMETRES["px"]) for unit in ("px", "mm", "cm", "in", "pt", "pc", "q")
}
_LENGTH: Final = re.compile(rf"({NUMBER})\s*([a-z]*|%)", re.IGNORECASE)
_MATH: Final = frozenset({"calc", "min", "max", "clamp"})
_IS_MATH: Final = re.compile(r"\s*(?:calc|min|max|clamp)\(", re.IGNORECASE)


class Units(NamedTuple):
    """What the relative units are in user units: the font's size, here and at the root, and the window's size.

    Of a font no more than the size is known: x height and width of a digit are half of it, a line is 1.2 of it.
    """

    em: float = 16.0
    rem: float = 16.0
    window: tuple[float, float] = (0.0, 0.0)

    def of(self, unit: str) -> float | None:
        """A unit in user units; None for what is no unit of length."""
        if unit in _ABSOLUTE:
            return _ABSOLUTE[unit]
        if unit not in RELATIVE:
            return None
        if unit.startswith("v"):
            across, down = self.window
            sides = {"vw": across, "vh": down, "vmin": min(self.window), "vmax": max(self.window)}
            return sides[unit] / 100
        font = self.rem if unit.startswith("r") else self.em
        return font * {"ex": 0.5, "ch": 0.5, "cap": 0.7, "lh": 1.2}.get(unit.removeprefix("r"), 1.0)


UNITS: Final = Units()


class Measure(NamedTuple):
    """A length: so many user units, and so large a share of the whole that percentages refer to."""

    pixels: float
    share: float = 0.0

    def of(self, whole: float) -> float:
        """The length in user units."""
        return self.pixels + self.share * whole if self.share else self.pixels


def length(text: str, whole: float, units: Units = UNITS) -> float:
    """A length in user units (CSS pixels); percentages are of `whole`.

    Raises DrawingError for what is no length or is beyond COORDINATE_MAX.
    """
    measure = parse_measure(text, units)
    if measure is None:
        raise DrawingError(
            f"{text[:40]!r} is no length", remedy="Write a number with mm, cm, in, pt, pc, px or no unit."
        )
    value = measure.of(whole)
    if not abs(value) <= COORDINATE_MAX:
        raise DrawingError(f"length beyond {COORDINATE_MAX:g}", remedy="Draw in units that keep the numbers small.")
    return value


def parse_measure(text: str, units: Units = UNITS) -> Measure | None:
    """A length, a percentage, a number of user units, or a calculation with them; None for what is none of these."""
    match = _LENGTH.fullmatch(text.strip())
    if match is None:
        return _calculated(text, units) if _IS_MATH.match(text) else None
    value, unit = float(match[1]), match[2].lower()
    if unit == "%":
        return Measure(0.0, value / 100)
    size = units.of(unit)
    return None if size is None else Measure(value * size)


class _Term(NamedTuple):
    """A part of a calculation: a plain number, which is `pixels`, or a length."""

    pixels: float
    share: float
    is_length: bool


def _calculated(text: str, units: Units) -> Measure | None:
    """The value of calc(), min(), max() or clamp()."""
    check_nesting(text)
    term = _term(tinycss2.parse_one_component_value(text, skip_comments=True), units)
    return None if term is None or not math.isfinite(term.pixels + term.share) else Measure(term.pixels, term.share)


def _term(token: Token, units: Units) -> _Term | None:
    """One operand."""
    match token.type:
        case "number":
            return _Term(token.value, 0.0, False)
        case "percentage":
            return _Term(0.0, token.value / 100, True)
        case "dimension":
            size = units.of(token.lower_unit)
            return None if size is None else _Term(token.value * size, 0.0, True)
        case "() block" | "function" if token.type == "() block" or token.lower_name == "calc":
            return _sum(token.content if token.type == "() block" else token.arguments, units)
        case "function" if token.lower_name in _MATH:
            parts = [_sum(part, units) for part in split(token.arguments, ",")]
            return _chosen(token.lower_name, [part for part in parts if part is not None], len(parts))
    return None


def _chosen(name: str, terms: list[_Term], count: int) -> _Term | None:
    """The least, the greatest, or the one between two bounds; None where percentages leave that open."""
    alike = len({term.is_length for term in terms}) == 1
    if len(terms) != count or not alike or any(term.share for term in terms) or (name == "clamp" and count != 3):
        return None
    values = [term.pixels for term in terms]
    if name == "clamp":
        value = max(values[0], min(values[1], values[2]))
    else:
        value = min(values) if name == "min" else max(values)
    return _Term(value, 0.0, terms[0].is_length)


def _sum(tokens: list[Token], units: Units) -> _Term | None:
    """A sum of products; None where it is none, or adds numbers and lengths."""
    items = [token for token in tokens if token.type not in {"whitespace", "comment"}]
    terms = [_term(token, units) for token in items[::2]]
    signs = ["+", *(token.value if token in ("+", "-", "*", "/") else "" for token in items[1::2])]
    if len(terms) != len(signs):
        return None
    products: list[_Term] = []
    for sign, term in zip(signs, terms, strict=True):
        if term is None or not sign:
            return None
        if sign in "+-":
            factor = -1.0 if sign == "-" else 1.0
            products.append(_Term(factor * term.pixels, factor * term.share, term.is_length))
            continue
        product = _multiplied(products.pop(), term, sign)
        if product is None:
            return None
        products.append(product)
    if len({product.is_length for product in products}) != 1:
        return None
    return _Term(
        math.fsum(product.pixels for product in products),
        math.fsum(product.share for product in products),
        products[0].is_length,
    )


def _multiplied(one: _Term, two: _Term, sign: str) -> _Term | None:
    """A product with a number, or a quotient by one."""
    if sign == "/":
        if two.is_length or two.pixels == 0.0:
            return None
        return _Term(one.pixels / two.pixels, one.share / two.pixels, one.is_length)
    if two.is_length:
        one, two = two, one
    return None if two.is_length else _Term(one.pixels * two.pixels, one.share * two.pixels, one.is_length)
