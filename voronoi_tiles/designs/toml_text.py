"""A design as TOML, as people write it: a stroke a line, points wrapped."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from datetime import date, time
from itertools import pairwise
from numbers import Integral
from typing import Any, Final

from voronoi_tiles.base.errors import DesignError

_WIDTH: Final = 110
"""Where the points of a stroke are wrapped; characters."""

_TEXT_OR_GAP: Final = re.compile(r'"(?:[^"\\]|\\.)*+"|(?<=\],) (?=\[)')
"""A text in quotes, within which no line is broken, or the blank between two points, where it may be."""

_WHOLE_MAX: Final = 2.0**53
"""Above this all floats are whole numbers, and TOML's integers, of 64 bits, soon too short."""


def toml_text(design: Mapping[str, Any]) -> str:
    """The table of a design, checked, as TOML.

    Raises DesignError for texts that UTF-8 does not have, as names of files may be.
    """
    lines = [f"{key} = {toml_value(design[key])}" for key in ("schema", "group", "units", "scale") if key in design]
    lines += ["", "[cell]", *(f"{key} = {toml_value(value)}" for key, value in design["cell"].items())]
    for site in design["site"]:
        lines += ["", "[[site]]"]
        lines += [toml_pair(key, value) for key, value in site.items() if key != "strokes"]
        lines.append(toml_pair("strokes", site["strokes"]))
    if "solid" in design:
        lines += ["", "[solid]", *(toml_pair(key, value) for key, value in design["solid"].items())]
    for key_drawing in design.get("key", ()):
        lines += ["", "[[key]]", *(toml_pair(key, value) for key, value in key_drawing.items())]
    return "\n".join(lines) + "\n"


def toml_pair(key: str, value: Any) -> str:
    """A key and its value as TOML."""
    return f"{toml_key(key)} = {toml_lines(value)}"


def toml_lines(value: Any) -> str:
    """A value as TOML: a list of tables has a line for each, wrapped where it is long."""
    if isinstance(value, list | tuple) and value and all(isinstance(item, Mapping) for item in value):
        return "\n".join(("[", *(f"  {wrapped(toml_value(item))}," for item in value), "]"))
    return toml_value(value)


def toml_key(key: str) -> str:
    """A key as TOML, in quotes where it needs them."""
    return key if re.fullmatch("[A-Za-z0-9_-]+", key) else _text(key)


def toml_value(value: Any) -> str:
    """A value as TOML, on one line."""
    match value:
        case bool():
            return "true" if value else "false"
        case str():
            return _text(value)
        case Mapping():
            return f"{{ {', '.join(f'{toml_key(key)} = {toml_value(item)}' for key, item in value.items())} }}"
        case list() | tuple():
            return f"[{', '.join(map(toml_value, value))}]"
    return _scalar(value)


def _scalar(value: Any) -> str:
    """A date or a time, or a number, without a fraction where it is whole."""
    if isinstance(value, date | time):
        return value.isoformat()
    if isinstance(value, Integral):
        return repr(int(value))
    number = float(value)
    if number.is_integer() and abs(number) < _WHOLE_MAX:
        return repr(int(number))
    return repr(number)  # which has the digits that give the same bits


def _text(text: str) -> str:
    """A text in quotes: what JSON escapes TOML does too, and DEL."""
    try:
        text.encode()
    except UnicodeEncodeError:
        raise DesignError(
            f"{text!r} is no text that a file can hold", key="file", remedy="Rename the drawing."
        ) from None
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def wrapped(stroke: str) -> str:
    """A stroke with line breaks between its points, where it is long; TOML allows them inside an array."""
    if len(stroke) <= _WIDTH:
        return stroke
    cuts = [found.start() for found in _TEXT_OR_GAP.finditer(stroke) if found[0] == " "]
    first, *others = (stroke[a:b].lstrip() for a, b in pairwise([0, *cuts, len(stroke)]))
    lines = [first]
    for part in others:
        if len(lines[-1]) + 1 + len(part.removesuffix("],")) > _WIDTH:
            lines.append(part)
        else:
            lines[-1] += f" {part}"
    return "\n    ".join(lines)
