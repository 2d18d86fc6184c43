"""A design as TOML, as people write it: a stroke a line, points wrapped."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any, Final

from voronoi_tiles.base.errors import DesignError

_WIDTH: Final = 110
"""Where the points of a stroke are wrapped; characters."""


def toml_text(design: Mapping[str, Any]) -> str:
    """The table of a design, checked, as TOML.

    Raises DesignError for texts that UTF-8 does not have, as names of files may be.
    """
    lines = [f"{key} = {toml_value(design[key])}" for key in ("schema", "group", "units", "scale") if key in design]
    lines += ["", "[cell]", *(f"{key} = {toml_value(value)}" for key, value in design["cell"].items())]
    for site in design["site"]:
        lines += ["", "[[site]]"]
        lines += [f"{key} = {toml_value(value)}" for key, value in site.items() if key != "strokes"]
        lines += ["strokes = [", *(f"  {_wrapped(toml_value(stroke))}," for stroke in site["strokes"]), "]"]
    return "\n".join(lines) + "\n"


def toml_value(value: Any) -> str:
    """A value as TOML, on one line."""
    match value:
        case bool():
            return "true" if value else "false"
        case str():
            return _text(value)
        case Mapping():
            return f"{{ {', '.join(f'{key} = {toml_value(item)}' for key, item in value.items())} }}"
        case list() | tuple():
            return f"[{', '.join(map(toml_value, value))}]"
    number = float(value)
    return repr(int(number)) if number.is_integer() else repr(number)  # repr has the digits that give the same bits


def _text(text: str) -> str:
    """A text in quotes: what JSON escapes TOML does too, and DEL."""
    try:
        text.encode()
    except UnicodeEncodeError:
        raise DesignError(
            f"{text!r} is no text that a file can hold", key="file", remedy="Rename the drawing."
        ) from None
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _wrapped(stroke: str) -> str:
    """A stroke with line breaks between its points, where it is long; TOML allows them inside an array."""
    if len(stroke) <= _WIDTH:
        return stroke
    first, *others = re.split(r"(?<=\],) (?=\[)", stroke)
    lines = [first]
    for part in others:
        if len(lines[-1]) + 1 + len(part.removesuffix("],")) > _WIDTH:
            lines.append(part)
        else:
            lines[-1] += f" {part}"
    return "\n    ".join(lines)
