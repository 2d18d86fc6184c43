"""The numbers of a design, named by their places in its file, and designs with other ones."""

from __future__ import annotations

import cmath
import json
import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from voronoi_tiles.base.arguments import texts
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.designs.schema import KINDS

if TYPE_CHECKING:
    from voronoi_tiles.designs.design import Design
    from voronoi_tiles.groups.wallpaper import WallpaperGroup

_PLACES: Final = {"scale": 1.0, "rotate": 0.0, "translate": [0.0, 0.0]}
"""The numbers that place strokes and sites, as they are where they are not written."""

_UNDRAWN: Final = ("path", "file")
"""Kinds of strokes whose own key holds no numbers."""


class Parameter(NamedTuple):
    """A number of a design: its key and the indices `below` it, and the site and the stroke that it belongs to.

    Its text is its place in the design file, as messages name it: "cell.a", "site[0].strokes[1].bezier[2][0]" for the
    x of a point, "site[0].rotate".
    """

    key: str
    below: tuple[int, ...] = ()
    site: int | None = None
    stroke: int | None = None

    def __str__(self) -> str:
        at = "" if self.site is None else f"site[{self.site}]."
        at += "" if self.stroke is None else f"strokes[{self.stroke}]."
        return at + self.key + "".join(f"[{k}]" for k in self.below)


def drawn_parameters(design: Design) -> list[Parameter]:
    """The free numbers of the cell, then the coordinates and radii of all strokes, in the order of the file."""
    found = [Parameter(f"cell.{name}") for name in free_in_cell(design.group)]
    for i, site in enumerate(json.loads(design.drawn)["site"]):
        for k, stroke in enumerate(site["strokes"]):
            kind = next(name for name in KINDS if name in stroke)
            if kind in _UNDRAWN:
                continue
            for key in (kind, "tangents", "radius"):
                found += [Parameter(key, index, i, k) for index in _indices(stroke.get(key, []))]
    return found


def placing_parameters(design: Design) -> list[Parameter]:
    """The scale of the design, and what places its sites and strokes; mirroring is no number."""
    found = [Parameter("scale")]
    for i, site in enumerate(json.loads(design.drawn)["site"]):
        for stroke in (None, *range(len(site["strokes"]))):
            for key, value in _PLACES.items():
                found += [Parameter(key, index, i, stroke) for index in _indices(value)]
    return found


def chosen_parameters(design: Design, names: str | Iterable[str] | None) -> list[Parameter]:
    """The parameters of some names, each once, in their order; None: those of `drawn_parameters`.

    A name that is a part of others, "cell" or "site[0].strokes[1]", is all of those below it that are drawn.
    Raises ArgumentError for a name of nothing.
    """
    drawn = drawn_parameters(design)
    if names is None:
        return drawn
    by_name = {str(each): each for each in (*drawn, *placing_parameters(design))}
    chosen: dict[Parameter, None] = {}
    for name in texts("parameters", names, 'Give names, such as ["cell", "site[0].strokes[1]"].'):
        below = [each for each in drawn if str(each).startswith((f"{name}.", f"{name}["))]
        found = [by_name[name]] if name in by_name else below or _placing(by_name, name)
        if not found:
            raise ArgumentError(
                f'`parameters` names "{name}", which is no number of the design',
                remedy=f"Numbers are {', '.join(list(by_name)[:4])}, ...; the first part of a name is all below it.",
            )
        chosen.update(dict.fromkeys(found))
    return list(chosen)


def _placing(by_name: dict[str, Parameter], name: str) -> list[Parameter]:
    """The two numbers of a `translate`."""
    return [by_name[full] for full in (f"{name}[0]", f"{name}[1]") if full in by_name]


def is_free(parameter: Parameter, group: WallpaperGroup) -> bool:
    """Whether a group leaves a number free, as all do but some of the cell."""
    section, _, name = parameter.key.partition(".")
    return section != "cell" or name in free_in_cell(group)


def free_in_cell(group: WallpaperGroup) -> list[str]:
    """The numbers of the cell that a group leaves free."""
    return ["a", *([] if group.fixes_b else ["b"]), *(["angle"] if group.fixed_angle is None else [])]


def _indices(value: Any) -> list[tuple[int, ...]]:
    """Where the numbers of nested lists are."""
    if not isinstance(value, list):
        return [()]
    return [(k, *rest) for k, item in enumerate(value) for rest in _indices(item)]


def values_of(design: Design, parameters: Sequence[Parameter]) -> list[float]:
    """The values of parameters, as the design has them."""
    table = json.loads(design.drawn)
    found = []
    for parameter in parameters:
        holder, key = _holder(table, parameter)
        found.append(float(holder[key]))
    return found


def with_values(
    design: Design,
    parameters: Sequence[Parameter],
    values: Iterable[float],
    group: WallpaperGroup | None = None,
) -> Design:
    """The design with other values of parameters, in its own or another group, checked again. Raises DesignError.

    In another group strokes stay where they are, and the cell keeps its sides and its angle as far as they are free
    there; parameters of the cell that are not are left out.
    """
    table = json.loads(design.drawn)
    group = design.group if group is None else group
    free = free_in_cell(group)
    if group is not design.group:
        a, b = design.lattice.a, design.lattice.b
        own = {"b": table["cell"]["a"] * abs(b) / abs(a), "angle": math.degrees(cmath.phase(b / a))}
        table["group"], table["cell"] = (
            group.name,
            {**{name: own[name] for name in own if name in free}, **table["cell"]},
        )
    for name in table["cell"].keys() - set(free):
        del table["cell"][name]  # it has to follow the side
    for parameter, value in zip(parameters, values, strict=True):
        if is_free(parameter, group):
            holder, key = _holder(table, parameter)
            holder[key] = float(value)
    return type(design).from_dict(table, name=design.name, folder=design.folder)


def _holder(table: dict[str, Any], parameter: Parameter) -> tuple[Any, Any]:
    """What holds the number of a parameter, and its key or index there; defaults are written first."""
    holder: Any = table
    if parameter.site is not None:
        holder = holder["site"][parameter.site]
    if parameter.stroke is not None:
        holder = holder["strokes"][parameter.stroke]
    *parts, key = parameter.key.split(".")
    for part in parts:
        holder = holder[part]
    if key in _PLACES and key not in holder:
        default = _PLACES[key]
        holder[key] = list(default) if isinstance(default, list) else default
    path = (key, *parameter.below)
    for step in path[:-1]:
        holder = holder[step]
    return holder, path[-1]
