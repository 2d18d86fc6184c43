"""Options that several commands share: the renderer, and what is to be made of a design."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

if TYPE_CHECKING:
    from voronoi_tiles.fabrication.job import Job

Command = TypeVar("Command", bound=Callable[..., Any])


def with_renderer(command: Command) -> Command:
    """Add the options that choose the renderer."""
    command = click.option(
        "--device", type=click.IntRange(min=0), metavar="N", help="The number of OpenGL's device [default: the first]."
    )(command)
    return click.option(
        "--renderer",
        type=click.Choice(("auto", "gl", "cpu")),
        default="auto",
        help="OpenGL or the processor; auto takes OpenGL where there is any [default: auto].",
    )(command)


class Length(click.ParamType[float]):
    """A length such as 3mm, 2.5cm or 0.5in; a plain number is millimetres."""

    name = "length"

    def __init__(self, least: float = 0.0) -> None:
        """Take lengths from `least` on; millimetres."""
        self.least = least

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Read a length; millimetres."""
        from voronoi_tiles.base.errors import DesignError
        from voronoi_tiles.base.units import parse_length

        if isinstance(value, float):
            return value
        try:
            length = parse_length(value)
        except DesignError as error:
            self.fail(str(error), param, ctx)
        if length < 0.0:
            self.fail(f"{value!r} is negative. Write 0 or more.", param, ctx)
        if length < self.least:
            self.fail(f"{value!r} is too small. Write {self.least:f}mm or more.", param, ctx)
        return length


LENGTH = Length()


def _read_sheet(
    _context: click.Context, _parameter: click.Parameter, text: str | None
) -> tuple[float, float] | str | None:
    """Read a size, or leave the name of a file as it is."""
    from voronoi_tiles.base.errors import DesignError
    from voronoi_tiles.base.units import parse_size

    if text is None:
        return None
    if text.lower().endswith((".svg", ".dxf")):
        return text
    try:
        return parse_size(text)
    except DesignError as error:
        raise click.BadParameter(f"{error} Or name an .svg file whose closed paths bound the sheet.") from None


def _read_offset(_context: click.Context, _parameter: click.Parameter, text: str | None) -> complex | None:
    """Read two lengths: "3mm,-2mm"."""
    from voronoi_tiles.base.errors import DesignError
    from voronoi_tiles.base.units import parse_length

    if text is None:
        return None
    try:
        x, y = (parse_length(part) for part in text.split(","))
    except (ValueError, DesignError):
        raise click.BadParameter(f"{text!r} is no offset. Write X,Y, such as 3mm,-2mm.") from None
    return complex(x, y)


_OPTIONS: tuple[tuple[tuple[str, ...], dict[str, Any]], ...] = (
    (
        ("--sheet",),
        {
            "metavar": "WxH|FILE",
            "callback": _read_sheet,
            "help": "Fill a sheet, 600x300mm, or the closed paths of an SVG or DXF file [default: one of each tile].",
        },
    ),
    (("--margin",), {"type": LENGTH, "metavar": "LENGTH", "help": "What stays free inside the sheet's edge."}),
    (
        ("--fit",),
        {
            "type": click.Choice(("whole", "clip", "frame")),
            "help": "Whole tiles only, tiles clipped at the edge, or whole tiles and the frame around them "
            "[default: whole].",
        },
    ),
    (("--rotate",), {"type": float, "metavar": "DEGREES", "help": "Turn the tiles counter-clockwise."}),
    (
        ("--offset",),
        {
            "metavar": "X,Y",
            "callback": _read_offset,
            "help": "Move the design's origin from the middle of the sheet [default: to where most whole tiles fit, "
            "or not at all with --fit clip].",
        },
    ),
    (
        ("--edges",),
        {
            "type": click.Choice(("once", "pieces")),
            "help": "Cut every shared edge once, or every tile as a closed piece [default: once on a sheet, unless an "
            "option needs pieces].",
        },
    ),
    (("--gap",), {"type": LENGTH, "metavar": "LENGTH", "help": "Pull pieces apart until they keep this distance."}),
    (
        ("--kerf",),
        {
            "type": LENGTH,
            "metavar": "LENGTH",
            "help": "The width of the cut: contours keep half of it from the pieces, which then have their true size.",
        },
    ),
    (("--fillet",), {"type": LENGTH, "metavar": "RADIUS", "help": "Round the corners of pieces."}),
    (("--tabs",), {"type": LENGTH, "metavar": "LENGTH", "help": "Leave bridges of this width, two a piece or more."}),
    (
        ("--accuracy",),
        {
            "type": LENGTH,
            "metavar": "LENGTH",
            "help": "How far approximated curves may be from the exact ones [default: 0.005mm].",
        },
    ),
    (
        ("--curves",),
        {
            "type": click.Choice(("exact", "arc", "spline", "polyline")),
            "help": "Exact curves, circular arcs, cubic splines or chords [default: as the preset says].",
        },
    ),
    (
        ("--preset",),
        {
            "metavar": "NAME|FILE",
            "help": "Colours, layers and curves for a target: plain, lightburn, redcut, ponoko, boxes, glowforge, cnc, "
            "or a .toml file [default: plain].",
        },
    ),
    (("--labels",), {"type": click.Choice(("number", "site")), "help": "Engrave a label on every piece."}),
    (
        ("--label-height",),
        {"type": LENGTH, "metavar": "LENGTH", "help": "The height of labels, at most [default: 3mm]."},
    ),
    (("--marks",), {"is_flag": True, "default": None, "help": "Engrave marks for aligning at the sheet's corners."}),
    (("--bar",), {"is_flag": True, "default": None, "help": "Engrave a bar of 100 mm, to measure the scale by."}),
    (
        ("--colours", "--colors"),
        {
            "type": click.Choice(("layers", "files")),
            "help": "Colour the tiles so that no neighbours are alike: a layer, or a file, for each colour.",
        },
    ),
    (
        ("--art",),
        {
            "type": click.Choice(("whole", "clip", "none")),
            "help": "The art of the design's sites: whole, clipped to the tiles, or left out [default: whole].",
        },
    ),
)

_NAMES = tuple(flags[0].removeprefix("--").replace("-", "_") for flags, _ in _OPTIONS)


def with_job(command: Command) -> Command:
    """Add the options of a job; the command gets `job`, None where none of them is given."""

    @wraps(command)
    def run(**arguments: Any) -> Any:
        given = {name: value for name in _NAMES if (value := arguments.pop(name)) is not None}
        return command(job=_job(given) if given else None, **arguments)

    for flags, settings in reversed(_OPTIONS):
        run = click.option(*flags, **settings)(run)
    return run  # type: ignore[return-value]


def _job(given: dict[str, Any]) -> Job:
    """Make a job of the options that were given."""
    from voronoi_tiles.fabrication.job import Job

    return Job(**given)
