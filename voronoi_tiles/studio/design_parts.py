"""What a page needs to open a design: its parts, whatever is in them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.values import each, required, sequence, shown, text, within
from voronoi_tiles.designs.load import STARTER
from voronoi_tiles.studio.toml_edit import DEPTH_MAX

_STROKES: Final = "Write strokes = [{ segment = [[5, 3], [25, 11]] }]."


def require_parts(design: object) -> Mapping[str, Any]:
    """The table of a design that has a group, a cell, and sites with strokes; raises DesignError for any other.

    The numbers and names in them are not looked at: a design that cannot be tiled can be opened, and mended.
    """
    table = _table(design)
    _require_depth(table, 0)
    for key, require in (("group", _text), ("cell", _table), ("site", _sites)):
        value = required(table, key, STARTER)
        with within(key):
            require(value)
    return table


def _require_depth(value: object, depth: int) -> None:
    """Refuse what is nested too deeply for all that is done with it."""
    if depth > DEPTH_MAX:
        raise DesignError("is nested too deeply", remedy="Write it flatter: a design has five levels.")
    for item in value.values() if isinstance(value, Mapping) else value if isinstance(value, list) else ():
        _require_depth(item, depth + 1)


def _text(value: object) -> None:
    """Refuse what is no text."""
    text(value, 'Write a name, such as "p4".')


def _sites(value: object) -> None:
    """Refuse what is no list of sites."""
    each(sequence(value, "Write [[site]], in double brackets, above the keys of each site."), _site)


def _site(value: object) -> None:
    """Refuse what is no site, or has no list of strokes."""
    strokes = required(_table(value), "strokes", _STROKES)
    with within("strokes"):
        each(sequence(strokes, _STROKES), _table)


def _table(value: object) -> Mapping[str, Any]:
    """A table. Raises DesignError for anything else."""
    if not isinstance(value, Mapping):
        raise DesignError(f"must be a table, not {shown(value)}", remedy=STARTER)
    return value
