"""Starter designs: for every wallpaper group a commented design file that exports as it is.

One table of cells and strokes under one template. In the groups whose mirrors enclose the domain of a copy (pmm,
p4m, p3m1, p6m) a lone site's tile would be that polygon whatever the strokes: there two sites share it.
"""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from pathlib import PurePath
from typing import TYPE_CHECKING, NamedTuple

from voronoi_tiles.designs.toml_text import toml_value

if TYPE_CHECKING:
    from voronoi_tiles.designs.design import Design


class StarterStroke(NamedTuple):
    """One stroke: its TOML table, and what it is."""

    toml: str
    comment: str


class Starter(NamedTuple):
    """One starter: what the group does, the cell's sides and angle, and the strokes by site.

    Sites are flattened within `tolerance`, and moved by `translate` where it is given.
    """

    symmetry: str
    cell: tuple[float, ...]
    sites: Mapping[str, tuple[StarterStroke, ...]]
    tolerance: float = 0.01
    translate: complex | None = None


def _curve(points: str) -> StarterStroke:
    return StarterStroke(f"{{ catmull_rom = [{points}] }}", "a smooth curve through these points")


def _bezier(points: str) -> StarterStroke:
    return StarterStroke(f"{{ bezier = [{points}] }}", "a cubic Bézier curve: ends and two control points")


def _segment(points: str, comment: str) -> StarterStroke:
    return StarterStroke(f"{{ segment = [{points}] }}", comment)


_STAR = (
    _segment("[-10, 0], [10, 0]", "a cross about the origin: the group"),
    _segment("[0, -10], [0, 10]", "maps it onto itself, and its tile too"),
)
_DISC = (StarterStroke("{ circle = [0, 0], radius = 6 }", "a circle about the origin: the group maps it onto itself"),)

_TABLE: dict[str, Starter] = {
    "p1": Starter(
        "translations only",
        (60.0, 50.0, 75.0),
        {
            "bird": (
                _bezier("[2, 8], [16, 34], [30, -12], [46, 14]"),
                _segment("[24, 11], [33, 28]", "a wing; strokes of one site may meet and cross"),
            )
        },
    ),
    "p2": Starter(
        "half turns",
        (60.0, 44.0, 80.0),
        {"fish": (_curve("[8, 5], [22, 7], [25, 20], [15, 33]"),)},
    ),
    "pm": Starter(
        "mirrors",
        (60.0, 40.0),
        {"vase": (_curve("[5, 6], [24, 11], [9, 24], [23, 33]"),)},
    ),
    "pg": Starter(
        "glide reflections",
        (60.0, 50.0),
        {"leaf": (_bezier("[4, 4], [40, 2], [-6, 34], [28, 28]"),)},
    ),
    "cm": Starter(
        "mirrors, with glide reflections between them",
        (60.0, 60.0),
        {"flame": (_curve("[5, 5], [24, 11], [8, 21], [21, 29]"),)},
    ),
    "pmm": Starter(
        "mirrors in two directions",
        (60.0, 50.0),
        {"star": _STAR, "leaf": (_bezier("[7, 20], [20, 24], [27, 18], [24, 5]"),)},
    ),
    "pmg": Starter(
        "mirrors in one direction, half turns between them",
        (60.0, 50.0),
        {"wave": (_curve("[-11, 5], [2, 8], [11, 15], [-3, 19]"),)},
    ),
    "pgg": Starter(
        "glide reflections in two directions, and half turns",
        (60.0, 50.0),
        {"lizard": (_curve("[5, 5], [21, 3], [26, 15], [10, 20]"),)},
    ),
    "cmm": Starter(
        "mirrors in two directions, half turns between them",
        (70.0, 60.0),
        {"wing": (_curve("[5, 7], [16, 4], [29, 8], [23, 13]"),)},
    ),
    "p4": Starter(
        "quarter turns",
        (60.0,),
        {"bird": (_curve("[6, 9], [22, 5], [27, 17], [13, 25]"),)},
    ),
    "p4m": Starter(
        "quarter turns and mirrors",
        (60.0,),
        {"star": _STAR, "leaf": (_bezier("[15, 3], [28, 2], [18, 12], [27, 23]"),)},
    ),
    "p4g": Starter(
        "quarter turns, and mirrors that pass them by",
        (60.0,),
        {"propeller": (_curve("[5, 4], [19, 3], [13, 12], [4, 21]"),)},
    ),
    "p3": Starter(
        "thirds of a turn",
        (60.0,),
        {"horn": (_curve("[5, 6], [21, 4], [22, 20], [7, 25]"),)},
    ),
    "p3m1": Starter(
        "thirds of a turn, every centre on mirrors",
        (60.0,),
        {"disc": _DISC, "leaf": (_curve("[4, 14], [7, 25], [15, 18], [24, 18]"),)},
    ),
    "p31m": Starter(
        "thirds of a turn, some of the centres off the mirrors",
        (60.0,),
        {"fin": (_curve("[10, 3], [24, 4], [31, 10], [45, 5]"),)},
    ),
    "p6": Starter(
        "sixths of a turn",
        (60.0,),
        {"hook": (_curve("[9, 4], [21, 2], [26, 9], [16, 17]"),)},
    ),
    "p6m": Starter(
        "sixths of a turn and mirrors",
        (60.0,),
        {"disc": _DISC, "leaf": (_curve("[12, 3], [20, 2], [21, 9], [28, 13]"),)},
    ),
}

GROUP_NAMES: tuple[str, ...] = tuple(_TABLE)

_CELL_COMMENTS = (
    ("a", "side along x"),
    ("b", "the other side"),
    ("angle", "degrees from a to b"),
)

_HEAD = """\
{comment}
# Export it:  voronoi-tiles export {file} -o {result}

schema = 1
group = "{group}"
units = "mm"          # mm, cm or in
"""

_CELL_HEAD = """
[cell]                # the cell that repeats; the group decides the rest of its shape
"""

_SITE_HEAD = """
[[site]]              # one tile shape: all that is nearer to these strokes than to their copies
name = {name}
{tolerance:<22}# curves are flattened to within this distance
{translate}strokes = [           # x runs right, y up, from the group's origin
"""

_MOVED = "moves the whole site, after its strokes have been placed"

_TAIL = """
# Other strokes to try, also several in one site:
#   {{ point = [5, 3] }}
#   {{ polyline = [[5, 3], [9, 9], [25, 11]], closed = false }}
#   {{ hermite = [[0, 0], [4, 0]], tangents = [[3, 6], [3, -6]] }}
#   {{ bspline = [[0, 0], [4, 1], [6, 5], [8, 2]], closed = false }}
#   {{ circle = [5, 3], radius = 2 }}
#   {{ path = "M 1 1 C 2 3 4 3 5 1" }}        SVG path data
#   {{ file = "leaf.svg" }}                   a drawing, SVG or DXF
# Each may carry mirror = true, scale = 0.5, rotate = 30, translate = [4, 2], applied in this order about
# the origin; so may a whole site.
{comment}
"""

_MIRRORED = ("pm", "cm", "pmm", "pmg", "cmm", "p4m", "p4g", "p3m1", "p31m", "p6m")
_TURNED = ("p2", "pmm", "pmg", "pgg", "cmm", "p4", "p4m", "p4g", "p3", "p3m1", "p31m", "p6", "p6m")


def starter(group: str) -> Design:
    """The starter design of a group, which exports as it is; `starter_text` is its file. Raises DesignError.

    >>> import voronoi_tiles as vt
    >>> vt.starter("p4m")
    <Design 'p4m': p4m, 2 sites (star, leaf)>
    """
    from voronoi_tiles.designs.design import Design

    return Design.loads(starter_text(group), name=group)


def starter_text(group: str, file: str | None = None) -> str:
    """The commented design file of a group's starter, with the command that exports it from `file` (GROUP.toml).

    Raises DesignError for an unknown group.
    """
    if group not in GROUP_NAMES:
        from voronoi_tiles.designs.checking import read_group

        read_group(group)
    return written(group, _TABLE[group], file)


def symmetry_of(group: str) -> str:
    """What a group does, in words."""
    return _TABLE[group].symmetry


def group_comments(group: str) -> tuple[str, str]:
    """The two lines of a starter's file that are about its group: what that does, and what strokes keep clear of."""
    places = ["mirrors"] * (group in _MIRRORED) + ["centres of rotation"] * (group in _TURNED)
    clear = "keep the strokes clear of those in the next cells"
    if places:
        clear = f"keep clear of {' and '.join(places)}, or lay a whole site evenly about them"
    return (
        f"# A tile design in the wallpaper group {group}: {symmetry_of(group)}.",
        f"# Copies must not touch: {clear}.",
    )


def with_group_comments(text: str, group: str) -> str:
    """The text of a design file whose group has become another one, with that one's comments.

    Only lines that are word for word those of a starter are replaced: what anybody has written stays.
    """
    places = {line: k for name in GROUP_NAMES for k, line in enumerate(group_comments(name))}
    own = group_comments(group)
    lines = [(line, line.rstrip("\r\n")) for line in text.splitlines(keepends=True)]
    return "".join(own[places[bare]] + line[len(bare) :] if bare in places else line for line, bare in lines)


def written(group: str, starter: Starter, file: str | None, result: str | None = None) -> str:
    """A starter as the text of a design file; see `starter_text`. `result` is what its export is called."""
    path = PurePath(file or "")
    if not (path.name and path.name.isprintable()):  # a comment cannot show it
        path = PurePath(f"{group}.toml")
    about, clear = group_comments(group)
    parts = [
        _HEAD.format(
            comment=about,
            group=group,
            file=shlex.quote(path.name),
            result=shlex.quote(result or f"{path.stem}.svg"),
        ),
        _CELL_HEAD,
    ]
    parts += [
        f"{f'{key} = {value}':<22}# {comment}\n"
        for value, (key, comment) in zip(starter.cell, _CELL_COMMENTS, strict=False)
    ]
    for name, strokes in starter.sites.items():
        moved = None if starter.translate is None else (starter.translate.real, starter.translate.imag)
        parts.append(
            _SITE_HEAD.format(
                name=toml_value(name),
                tolerance=f"tolerance = {starter.tolerance:g} ",
                translate="" if moved is None else f"{f'translate = {toml_value(moved)}':<21} # {_MOVED}\n",
            )
        )
        parts += [f"  # {stroke.comment}\n  {stroke.toml},\n" for stroke in strokes]
        parts.append("]\n")
    parts.append(_TAIL.format(comment=clear))
    return "".join(parts)
