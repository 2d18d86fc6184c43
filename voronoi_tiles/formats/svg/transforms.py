"""SVG's transform lists and CSS's transforms as affine maps."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Final, NamedTuple

from voronoi_tiles.base.maps import IDENTITY_MAP, Affine, from_matrix, unit_at
from voronoi_tiles.base.text import NUMBER
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.formats.svg.css_text import arguments_of, components, function_of, words
from voronoi_tiles.formats.svg.lengths import UNITS, Measure, Units, parse_measure

_FUNCTION = re.compile(r"[\s,]*([A-Za-z]+)\s*\(([^()]*)\)[\s,]*")
_NUMBER = re.compile(NUMBER)
_COUNTS = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3), "skewX": (1,), "skewY": (1,)}

_ANGLE: Final = re.compile(rf"({NUMBER})(deg|grad|rad|turn)", re.IGNORECASE)
_DEGREES: Final = {"deg": 1.0, "grad": 0.9, "rad": 180.0 / math.pi, "turn": 360.0}
_SHARE: Final = re.compile(rf"({NUMBER})(%?)")
_SIDES: Final = {"left": 0.0, "top": 0.0, "center": 0.5, "right": 1.0, "bottom": 1.0}


class Box(NamedTuple):
    """What the lengths of a transform refer to: the box of its percentages, and the sizes of its units."""

    corner: complex = 0j
    across: float = 0.0
    down: float = 0.0
    units: Units = UNITS


def parse_transform(text: str) -> Affine | None:
    """The map of a transform attribute, "translate(3 4) rotate(30)"; None where it is broken.

    Raises DrawingError where a number is beyond COORDINATE_MAX.
    """
    result = IDENTITY_MAP
    if text.strip().lower() == "none":
        return result
    position = 0
    while position < len(text):
        match = _FUNCTION.match(text, position)
        if match is None:
            if not text[position:].strip(" \t\r\n,"):
                break
            return None
        position = match.end()
        v = numbers(match[2])
        if v is None or len(v) not in _COUNTS.get(match[1], ()):
            return None
        result = result @ _function(match[1], v)
    return _bounded(result)


def numbers(text: str) -> list[float] | None:
    """The numbers of a list that is separated by spaces or commas; None where anything else is in it."""
    rest = _NUMBER.sub(" ", text)
    if rest.strip(" \t\r\n\f,"):
        return None
    return [float(number) for number in _NUMBER.findall(text)]


def css_transform(text: str, box: Box) -> Affine | None:
    """The map of CSS's property `transform`; None where it is broken, or turns the drawing out of its plane.

    Raises DrawingError where a number is beyond COORDINATE_MAX.
    """
    result = IDENTITY_MAP
    if text.strip().lower() == "none":
        return result
    for function in words(text):
        part = _css_function(function_of(function), arguments_of(function), box)
        if part is None:
            return None
        result = result @ part
    return _bounded(result)


def css_translate(text: str, box: Box) -> Affine | None:
    """The map of CSS's property `translate`; None where it is broken."""
    parts = [] if text.strip().lower() == "none" else words(text)
    return _translation(parts[:2], box) if len(parts) <= 3 else None


def css_rotate(text: str) -> Affine | None:
    """The map of CSS's property `rotate`; None where it is broken, or about another axis than z."""
    parts = [] if text.strip().lower() == "none" else words(text)
    if parts and (parts[0].lower() == "z" or parts[:3] == ["0", "0", "1"]):
        parts = parts[-1:]
    degrees = angle(parts[0]) if len(parts) == 1 else None
    if not parts:
        return IDENTITY_MAP
    return None if degrees is None else Affine(unit_at(degrees), 0j, 0j)


def css_scale(text: str) -> Affine | None:
    """The map of CSS's property `scale`; None where it is broken."""
    parts = [] if text.strip().lower() == "none" else words(text)
    return _scaling(parts[:2]) if len(parts) <= 3 else None


def transform_origin(text: str, box: Box, *, unitless: bool = False) -> complex | None:
    """The point that a transform leaves where it is; None where the text is broken.

    As an attribute it may be written `unitless`, in user units.
    """
    parts = [part.lower() for part in words(text)]
    if len(parts) == 3:
        parts.pop()  # in depth
    if not 1 <= len(parts) <= 2:
        return None
    if parts[0] in {"top", "bottom"} or (len(parts) == 2 and parts[1] in {"left", "right"}):
        parts = ["center", *parts] if len(parts) == 1 else parts[::-1]
    if len(parts) == 1:
        parts.append("center")
    if parts[0] in {"top", "bottom"} or parts[1] in {"left", "right"}:
        return None
    read = parse_measure if unitless else _css_length
    measures = [Measure(0.0, _SIDES[part]) if part in _SIDES else read(part, box.units) for part in parts]
    x, y = measures
    if x is None or y is None:
        return None
    return box.corner + complex(x.of(box.across), y.of(box.down))


def angle(text: str) -> float | None:
    """An angle of CSS in degrees; None for what is none."""
    match = _ANGLE.fullmatch(text.strip())
    if match is None:
        return 0.0 if text.strip() in {"0", "+0", "-0"} else None
    degrees = float(match[1]) * _DEGREES[match[2].lower()]
    return degrees if math.isfinite(degrees) else None


def _css_function(  # noqa: PLR0911 - one for each function
    name: str, arguments: Sequence[str], box: Box
) -> Affine | None:
    """One function of CSS's transforms; None for what is broken or spatial."""
    count = len(arguments)
    match name:
        case "translate" if count <= 2:
            return _translation(arguments, box)
        case "translate3d" if count == 3:
            return _translation(arguments[:2], box)
        case "translatex" if count == 1:
            return _translation(arguments, box)
        case "translatey" if count == 1:
            return _translation(["0", *arguments], box)
        case "scale" if count <= 2:
            return _scaling(arguments)
        case "scale3d" if count == 3:
            return _scaling(arguments[:2])
        case "scalex" if count == 1:
            return _scaling([*arguments, "1"])
        case "scaley" if count == 1:
            return _scaling(["1", *arguments])
        case "translatez" | "scalez" if count == 1:
            return IDENTITY_MAP
        case "matrix" if count == 6:
            v = [number for number in map(_number, arguments) if number is not None]
            return _function("matrix", v) if len(v) == 6 else None
        case "rotate" | "rotatez" | "skewx" | "skewy" | "skew" if 1 <= count <= (2 if name == "skew" else 1):
            angles = [degrees for degrees in map(angle, arguments) if degrees is not None]
            return _turned(name, angles) if len(angles) == count else None
    return None


def _turned(name: str, degrees: Sequence[float]) -> Affine:
    """A rotation or a shear."""
    if name.startswith("rotate"):
        return Affine(unit_at(degrees[0]), 0j, 0j)
    if name != "skew":
        return _function({"skewx": "skewX", "skewy": "skewY"}[name], degrees)
    across, down = (math.tan(math.radians(value)) for value in (degrees[0], degrees[1] if len(degrees) > 1 else 0.0))
    return from_matrix(1.0, down, across, 1.0, 0.0, 0.0)


def _translation(parts: Sequence[str], box: Box) -> Affine | None:
    """A translation by one or two lengths; by none none."""
    measures = [_css_length(part, box.units) for part in parts]
    shift = [0.0, 0.0]
    for k, (measure, whole) in enumerate(zip(measures, (box.across, box.down), strict=False)):
        if measure is None:
            return None
        shift[k] = measure.of(whole)
    return Affine(1 + 0j, 0j, complex(*shift))


def _scaling(parts: Sequence[str]) -> Affine | None:
    """A scaling by one or two numbers or percentages; by none none."""
    factors = [number for number in map(_number, parts) if number is not None]
    if len(factors) != len(parts):
        return None
    return from_matrix(factors[0], 0.0, 0.0, factors[-1], 0.0, 0.0) if factors else IDENTITY_MAP


def _number(text: str) -> float | None:
    """A number or a percentage."""
    match = _SHARE.fullmatch(text.strip())
    if match is not None:
        return float(match[1]) * (0.01 if match[2] else 1.0)
    tokens = components(text)
    measure = parse_measure(text) if len(tokens) == 1 and tokens[0].type == "function" else None
    return None if measure is None or measure.share else measure.pixels


def _css_length(text: str, units: Units) -> Measure | None:
    """A length that has a unit, unless it is 0."""
    measure = parse_measure(text, units)
    return measure if measure is None or not text.strip()[-1:].isdigit() or measure.pixels == 0.0 else None


def _function(name: str, v: Sequence[float]) -> Affine:
    """One function of a transform list."""
    if not all(abs(value) <= COORDINATE_MAX for value in v):
        raise _beyond()
    match name:
        case "matrix":
            return from_matrix(v[0], v[1], v[2], v[3], v[4], v[5])
        case "translate":
            return Affine(1 + 0j, 0j, complex(v[0], v[1] if len(v) > 1 else 0.0))
        case "scale":
            return from_matrix(v[0], 0.0, 0.0, v[-1], 0.0, 0.0)
        case "rotate":
            turn = unit_at(v[0])
            centre = complex(v[1], v[2]) if len(v) > 1 else 0j
            return Affine(turn, 0j, centre - turn * centre)
        case "skewX":
            return from_matrix(1.0, 0.0, math.tan(math.radians(v[0])), 1.0, 0.0, 0.0)
        case _:
            return from_matrix(1.0, math.tan(math.radians(v[0])), 0.0, 1.0, 0.0, 0.0)


def _bounded(result: Affine) -> Affine:
    """The map, if its numbers are within COORDINATE_MAX."""
    if not max(abs(result.a), abs(result.b), abs(result.c)) <= COORDINATE_MAX:
        raise _beyond()
    return result


def _beyond() -> DrawingError:
    return DrawingError(f"transform beyond {COORDINATE_MAX:g}", remedy="Draw in units that keep numbers small.")
