"""The arguments of a design as keys of its table, and keys of the table as arguments, for messages."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import get_args

from voronoi_tiles.base import values
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.designs.drawn_site import Site
from voronoi_tiles.designs.drawn_strokes import ARGUMENTS, StrokeKind


def scale_table(scale: object) -> dict[str, object]:
    """The key of a scale, where it says something."""
    return {} if values.is_number(scale) and scale == 1.0 else {"scale": scale}


def cell_table(cell: object) -> object:
    """A cell as a design file has it."""
    if isinstance(cell, Mapping):
        return cell
    sides = getattr(cell, "tolist", lambda: cell)()
    if isinstance(sides, int | float):
        sides = [sides]
    if isinstance(sides, list | tuple) and 1 <= len(sides) <= 3:
        return dict(zip(("a", "b", "angle"), sides, strict=False))
    raise DesignError(
        f"must be a side, (a, b), (a, b, angle) or a mapping, not {values.shown(cell)}",
        key="cell",
        remedy="Write cell=60, or what else the group leaves free.",
    )


def listed_sites(sites: object) -> list[Site]:
    """The sites that a design is given."""
    remedy = "Write sites=[Site([segment(5+3j, 25+11j)])]."
    if isinstance(sites, Site):
        sites = [sites]
    if isinstance(sites, str | Mapping) or not isinstance(sites, Iterable):
        raise DesignError(f"must be Site objects, not {values.shown(sites)}", key="sites", remedy=remedy)
    listed = list(sites)
    if not listed:
        raise DesignError("there is no site", key="sites", remedy=remedy)
    for k, site in enumerate(listed):
        if not isinstance(site, Site):
            raise DesignError(f"must be a Site, not {values.shown(site)}", key=f"sites[{k}]", remedy=remedy)
        if not site.strokes:
            raise DesignError("there is no stroke", key=f"sites[{k}].strokes", remedy=remedy)
    return listed


_OWN = re.compile(rf"((?:site|key)\[\d+\]\.strokes\[\d+\])\.({'|'.join(get_args(StrokeKind))})\b(?:\[([01])\])?")


def argument_of(key: str) -> str:
    """The argument of Design that a key of the table came from: "sites[0].strokes[1].points[2]"."""

    def own(found: re.Match[str]) -> str:
        stroke, kind, index = found.groups()
        names = ARGUMENTS.get(kind, ("points",))
        if len(names) == 2 and index is not None:
            return f"{stroke}.{names[int(index)]}"
        return f"{stroke}.{names[0]}{'' if index is None else f'[{index}]'}"

    return re.sub(r"^key\b", "solid.keys", re.sub(r"^site\b", "sites", _OWN.sub(own, key)))
