"""The properties of CSS that decide what is drawn and where, and which values of them are understood."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from enum import Enum
from functools import lru_cache
from typing import Final

from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.formats.svg.colours import parse_colour
from voronoi_tiles.formats.svg.css_text import components, function_of, words
from voronoi_tiles.formats.svg.lengths import Measure, parse_measure
from voronoi_tiles.formats.svg.transforms import (
    Box,
    css_rotate,
    css_scale,
    css_transform,
    css_translate,
    parse_transform,
    transform_origin,
)

INITIAL: Final = frozenset({"initial", "unset", "revert"})
"""Words that any property takes; of properties that are inherited, `unset` and `revert` mean `inherit`."""

WIDE: Final = INITIAL | {"inherit", "revert-layer"}

_INHERITED_TEXT: Final = """
    color color-scheme fill fill-opacity font-size marker-end marker-mid marker-start stroke stroke-dasharray
    stroke-opacity stroke-width visibility
"""
INHERITED: Final = frozenset(_INHERITED_TEXT.split())
GEOMETRY: Final = frozenset({"x", "y", "width", "height", "cx", "cy", "r", "rx", "ry", "d"})
EFFECTS: Final = ("clip-path", "mask", "filter", "offset-path", "animation", "zoom")
"""What changes how an object looks or where it is, and is not followed."""

MOVING: Final = frozenset({"transform", "translate", "rotate", "scale"})
TRANSFORMS: Final = MOVING | {"transform-box", "transform-origin"}
MARKERS: Final = ("marker-start", "marker-mid", "marker-end")

PROPERTIES: Final = INHERITED | GEOMETRY | TRANSFORMS | {*EFFECTS, "display", "opacity", "overflow"}
ATTRIBUTES: Final = PROPERTIES - {"animation", "offset-path", "rotate", "scale", "transform-box", "translate", "zoom"}
"""The properties that may be written as attributes."""

# Other names of properties, and shorthands of which one value matters here.
_ALIASES: Final = {
    "-webkit-transform": "transform",
    "-webkit-transform-origin": "transform-origin",
    "-webkit-clip-path": "clip-path",
    "-webkit-mask": "mask",
    "-webkit-mask-image": "mask",
    "-webkit-filter": "filter",
    "-webkit-opacity": "opacity",
    "-webkit-animation": "animation",
    "-webkit-animation-name": "animation",
    "animation-name": "animation",
    "mask-image": "mask",
    "offset": "offset-path",
    "overflow-x": "overflow",
}

SIZES: Final = {
    "xx-small": 9.0,
    "x-small": 10.0,
    "small": 13.0,
    "medium": 16.0,
    "large": 18.0,
    "x-large": 24.0,
    "xx-large": 32.0,
    "xxx-large": 48.0,
}
"""Sizes of a font that have names; CSS pixels, as browsers have them."""


class Origin(Enum):
    """Where a value is written: what may be written without a unit differs."""

    ATTRIBUTE = 0
    STYLE = 1
    SHEET = 2


class Verdict(Enum):
    """What a value is: one of the property's, none (CSS passes over it), or one that a browser might understand."""

    VALID = 0
    INVALID = 1
    UNKNOWN = 2


def expanded(name: str, value: str) -> Iterator[tuple[str, str]]:
    """The properties that a declaration sets, of those that matter here; custom ones are `--name`."""
    name = _ALIASES.get(name, name)
    if name in PROPERTIES or name.startswith("--"):
        yield name, value
    elif name == "marker":
        yield from ((part, value) for part in MARKERS)
    elif name == "font":
        if value.lower() in WIDE or "var(" in value:
            yield "font-size", value
            return
        sizes = (word.partition("/")[0] for word in words(value))
        yield from (("font-size", size) for size in sizes if _font_size(size, Origin.SHEET) == Verdict.VALID)
    elif name == "all" and value.lower() in WIDE:
        yield from ((part, value) for part in sorted(PROPERTIES))


def verdict(name: str, value: str, origin: Origin) -> Verdict:
    """What a value of one of PROPERTIES is; var() has to be replaced before.

    Raises DrawingError for numbers beyond COORDINATE_MAX, and brackets nested too deep.
    """
    return _verdict(name, value, origin) if len(value) <= 100 else _judged(name, value, origin)


def _judged(name: str, value: str, origin: Origin) -> Verdict:
    if name in GEOMETRY and origin == Origin.ATTRIBUTE:
        return Verdict.VALID  # what is wrong with it is said where it is drawn
    return _JUDGES[name](value, origin) if value.strip() else Verdict.INVALID


_verdict = lru_cache(maxsize=8192)(_judged)


def _said(valid: bool, value: str) -> Verdict:
    """A verdict: functions that are not understood may be newer than this program."""
    return Verdict.VALID if valid else Verdict.UNKNOWN if "(" in value else Verdict.INVALID


def _colour(value: str, _origin: Origin) -> Verdict:
    if parse_colour(value) is not None:
        return Verdict.VALID
    plain = _COLOURS.fullmatch(value.strip().lower())
    return Verdict.INVALID if plain and not plain[1].strip().startswith("from ") else _said(False, value)


_COLOURS: Final = re.compile(r"(?:rgba?|hsla?|hwb|(?:ok)?(?:lab|lch))\(([^()]*)\)")
"""The colour functions that are read in full, but for those that begin "from"."""


def _paint(value: str, origin: Origin) -> Verdict:
    word = value.strip().lower()
    if word in {"none", "context-fill", "context-stroke"}:
        return Verdict.VALID
    if word.startswith("url("):
        rest = paint_fallback(value)
        return Verdict.VALID if rest is None or rest.lower() == "none" else _colour(rest, origin)
    return _colour(value, origin)


def paint_fallback(value: str) -> str | None:
    """What follows the url of a paint, None where nothing does."""
    return " ".join(words(value)[1:]) or None


def _word(*allowed: str) -> Callable[[str, Origin], Verdict]:
    return lambda value, _: _said(value.strip().lower() in allowed, value)


def _any_word(value: str, _origin: Origin) -> Verdict:
    return _said(_WORDS.fullmatch(value.strip()) is not None, value)


_WORDS: Final = re.compile(r"[A-Za-z-]+(?:\s+[A-Za-z-]+)*")


def _share(value: str, _origin: Origin) -> Verdict:
    return _said(opacity(value) is not None, value)


def opacity(value: str) -> float | None:
    """An opacity from 0 to 1; None for what is none."""
    measure = parse_measure(value)
    if measure is None or value.strip()[-1:].isalpha():
        return None
    return min(max(measure.pixels + measure.share, 0.0), 1.0)


def _measure(value: str, origin: Origin, *, unitless: bool) -> Measure | None:
    """A length, without a unit only where that is allowed, or a percentage."""
    measure = parse_measure(value)
    if measure is None or not max(map(abs, measure)) <= COORDINATE_MAX:
        return None
    if origin == Origin.SHEET and not unitless and value.strip()[-1:] in "0123456789." and measure.pixels != 0.0:
        return None
    return measure


def _length(*allowed: str, negative: bool = False) -> Callable[[str, Origin], Verdict]:
    def judge(value: str, origin: Origin) -> Verdict:
        if value.strip().lower() in allowed:
            return Verdict.VALID
        measure = _measure(value, origin, unitless=False)
        return _said(measure is not None and (negative or min(measure) >= 0.0 or function_of(value) != ""), value)

    return judge


def _stroke_width(value: str, origin: Origin) -> Verdict:
    measure = _measure(value, origin, unitless=True)
    return _said((measure is not None and min(measure) >= 0.0) or value.strip().lower() == "hairline", value)


def _dashes(value: str, origin: Origin) -> Verdict:
    measures = [_measure(word, origin, unitless=True) for word in words(value)]
    valid = value.strip().lower() == "none" or all(measure is not None and min(measure) >= 0.0 for measure in measures)
    return _said(valid and bool(value.strip()), value)


def _font_size(value: str, origin: Origin) -> Verdict:
    measure = _measure(value, origin, unitless=False)
    word = value.strip().lower()
    return _said(word in SIZES or word in {"larger", "smaller"} or (measure is not None and min(measure) >= 0), value)


def _path(value: str, _origin: Origin) -> Verdict:
    return _said(value.strip().lower() == "none" or path_of(value) is not None, value)


def path_of(value: str) -> str | None:
    """The path data of the function path(); None for what is none."""
    tokens = components(value)
    if len(tokens) != 1 or tokens[0].type != "function" or tokens[0].lower_name != "path":
        return None
    strings = [token for token in tokens[0].arguments if token.type not in {"whitespace", "comment"}]
    return str(strings[-1].value) if strings and strings[-1].type == "string" else None


def _transform(value: str, origin: Origin) -> Verdict:
    if origin == Origin.ATTRIBUTE:
        return Verdict.VALID if parse_transform(value) is not None else Verdict.INVALID
    if css_transform(value, _BOX) is not None:
        return Verdict.VALID
    known = all(_PLANE.fullmatch(function_of(word)) for word in words(value))
    return Verdict.INVALID if known else _said(False, value)


def _transform_origin(value: str, origin: Origin) -> Verdict:
    return _said(transform_origin(value, _BOX, unitless=origin == Origin.ATTRIBUTE) is not None, value)


_EFFECT: Final = re.compile(r"[\w\s.,%+-]+|.*[\w-]+\(.*", re.DOTALL)
"""What may be the value of an effect: words and numbers, or something with a function."""

_BOX: Final = Box()
_PLANE: Final = re.compile(r"matrix|(?:translate|scale|skew)[xy]?|rotate|")
"""The transforms that are read in full, and what is no function."""

_JUDGES: Final[dict[str, Callable[[str, Origin], Verdict]]] = {
    "fill": _paint,
    "stroke": _paint,
    "color": _colour,
    "color-scheme": _any_word,
    "fill-opacity": _share,
    "stroke-opacity": _share,
    "opacity": _share,
    "stroke-width": _stroke_width,
    "stroke-dasharray": _dashes,
    "font-size": _font_size,
    "visibility": _word("visible", "hidden", "collapse"),
    "display": _any_word,
    "overflow": _any_word,
    "transform": _transform,
    "transform-box": _word("view-box", "fill-box", "stroke-box", "content-box", "border-box"),
    "transform-origin": _transform_origin,
    "translate": lambda value, _: _said(css_translate(value, _BOX) is not None, value),
    "rotate": lambda value, _: _said(css_rotate(value) is not None, value),
    "scale": lambda value, _: _said(css_scale(value) is not None, value),
    "d": _path,
    **dict.fromkeys((*EFFECTS, *MARKERS), lambda value, _: _said(_EFFECT.fullmatch(value.strip()) is not None, value)),
    **dict.fromkeys(("x", "y", "cx", "cy"), _length(negative=True)),
    **dict.fromkeys(("width", "height", "rx", "ry"), _length("auto")),
    "r": _length(),
}
