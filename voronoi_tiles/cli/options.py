"""Options that several commands share: the renderer and its method, lengths, and what is to be made of a design."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, TypeVar

import click

from voronoi_tiles.cli.common import SCALE, as_options
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_options import JobError, Option

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


def with_method(command: Command) -> Command:
    """Add the option that chooses the method."""
    return click.option(
        "--method",
        type=click.Choice(("exact", "hoff")),
        default="exact",
        help="Exact distances, or the cones and tents of Hoff et al. with a depth test [default: exact].",
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


class Factor(click.ParamType[float]):
    """A number above 0."""

    name = "factor"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Read a factor."""
        try:
            factor = float(value)
        except ValueError:
            factor = math.nan
        if not 0.0 < factor < math.inf:
            self.fail(f"{value!r} is no factor. Write a number above 0, such as 1.5.", param, ctx)
        return factor


def _note_scale(ctx: click.Context, parameter: click.Parameter, value: float | None) -> None:
    """Keep an option for `load`; refuse a second one of them."""
    if value is None:
        return
    scale = ctx.meta.setdefault(SCALE, {})
    if scale:
        raise click.UsageError(
            "Give one of --scale, --tile-width and --tile-height: each says how large the design is."
        )
    if value == 0.0:
        raise click.BadParameter("0 is no size. Write a length such as 95mm.")
    scale["factor" if parameter.name == "scale" else str(parameter.name)] = value


def with_scale(command: Command) -> Command:
    """Add the options that scale the design, which `load` takes into account."""
    for flag, kind, metavar, what in reversed(
        (
            ("--scale", Factor(), "FACTOR", "Scale the design: its cell, strokes and art."),
            ("--tile-width", LENGTH, "LENGTH", "Scale it until its tile, the widest of several, is so wide: 95mm."),
            ("--tile-height", LENGTH, "LENGTH", "Scale it until its tile, the highest of several, is so high."),
        )
    ):
        command = click.option(flag, type=kind, metavar=metavar, help=what, callback=_note_scale, expose_value=False)(
            command
        )
    return command


_TYPES: dict[str, click.ParamType[Any] | type] = {"length": LENGTH, "angle": float, "text": str, "number": str}

# A second spelling, and an option that is for the program's own use.
_SPELLINGS = {"colours": ("--colours", "--colors")}
_HIDDEN = ("only_colour",)


_OPTIONS = {name: option for name, option in Job.options().items() if name not in _HIDDEN}


def _settings(option: Option[Any, Any]) -> dict[str, Any]:
    """What click is told of an option of a job."""
    match option.kind:
        case "word":
            # "none" is what the option means when it is left out; for art it is what one may want.
            return {"type": click.Choice([w for w in option.words if w != option.default or w != "none"])}
        case "flag":
            return {"is_flag": True, "default": None}
        case kind:
            return {"type": _TYPES[kind], "metavar": option.shown}


def _refuse_scale() -> None:
    """Refuse options that scale the design beside a number of pieces on a sheet, which would undo them."""
    for name in click.get_current_context().meta.get(SCALE, ()):
        flag = "--scale" if name == "factor" else f"--{name.replace('_', '-')}"
        raise click.UsageError(
            f"--pieces scales the design until so many fill the sheet. Leave out {flag}, or --pieces."
        )


def with_job(command: Command) -> Command:
    """Add the options of a job; the command gets `job`, None where none of them is given."""

    @wraps(command)
    def run(**arguments: Any) -> Any:
        given = {name: value for name in _OPTIONS if (value := arguments.pop(name)) is not None}
        job = Job(**given) if given else None
        if job is not None and job.pieces is not None and job.sheet is not None:
            _refuse_scale()
        return command(job=job, **arguments)

    added: Command = _with_options(run, _OPTIONS)
    return added


def with_solid_job(command: Command) -> Command:
    """Add the options of solids and of stacks; the command gets `job`, of a stack where there are sheets."""
    from voronoi_tiles.solid.solid_job import SolidJob
    from voronoi_tiles.solid.stack_job import StackJob

    solids, stacks = SolidJob.options(), StackJob.options()
    options = {**stacks, **solids}

    @wraps(command)
    def run(**arguments: Any) -> Any:
        given = {name: value for name in options if (value := arguments.pop(name)) is not None}
        kind, known = (StackJob, stacks) if "sheets" in given else (SolidJob, solids)
        for name in (name for name in given if name not in known):
            if kind is StackJob:
                raise JobError(f"`{name}` is for printing, and `sheets` for stacks", remedy="Leave one of them out.")
            raise JobError(f"`{name}` is for sheets that are cut, and there are none", remedy="Add `sheets=7`.")
        return command(job=kind(**given), **arguments)

    added: Command = _with_options(run, options)
    return added


def _with_options(command: Callable[..., Any], options: Mapping[str, Option[Any, Any]]) -> Any:
    """Add options to a command, in their order."""
    for name, option in reversed(list(options.items())):
        flags = _SPELLINGS.get(name, (f"--{name.replace('_', '-')}",))
        command = click.option(*flags, help=as_options(option.help), **_settings(option))(command)
    return command
