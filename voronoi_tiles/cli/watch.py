"""The command `watch`: a design's picture and files, written anew whenever it is saved."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import click

from voronoi_tiles.base.errors import DesignError, TouchingCopiesError
from voronoi_tiles.cli.common import PATH, as_options, load, report_error, say
from voronoi_tiles.cli.options import with_job, with_renderer, with_scale
from voronoi_tiles.cli.render import with_picture

if TYPE_CHECKING:
    from voronoi_tiles.fabrication.job import Job
    from voronoi_tiles.pictures.rendering import RenderOptions
    from voronoi_tiles.raster.renderer import Choice, Method

_PICTURE = ".png"

_HEAD = 2**16
"""How much of a file is looked through for what says that it is ours; bytes."""


@click.command()
@click.argument("design", type=PATH)
@click.option(
    "-o",
    "--output",
    "outputs",
    multiple=True,
    metavar="FILE",
    type=PATH,
    help="A file to write, a picture (.png) or tiles (.svg, .dxf, .pdf, .lbrn2, .gcode, .json); may be repeated "
    "[default: DESIGN.png and DESIGN.svg, beside it, unless there are others of this name].",
)
@with_picture
@with_scale
@with_renderer
@with_job
def watch(
    design: str,
    outputs: tuple[str, ...],
    size: int | tuple[int, int] | None,
    region: tuple[float, float, float, float] | None,
    overlay: tuple[str, ...],
    method: Method,
    renderer: Choice,
    device: int | None,
    job: Job | None,
) -> None:
    """Write a picture and the tiles of a DESIGN, and write them anew whenever it is saved, until Ctrl-C.

    The drawings that the design names are watched as well. What is wrong with it is said, and the files stay as they
    were; copies that touch are shown in the picture. The other options are those of render and export.
    """
    from voronoi_tiles.base.watching import FileWatch
    from voronoi_tiles.pictures.picture_size import DEFAULT_SIZE

    _refuse_design(design)
    targets = outputs or _beside(design)
    _refuse_targets(design, targets)
    options: RenderOptions = {
        "size": DEFAULT_SIZE if size is None else size,
        "region": region,
        "overlay": overlay,
        "colours": "none" if job is None or job.colours == "none" else job.scheme,
        "method": method,
        "renderer": renderer,
        "device": device,
        "notice": cache(say),  # that there is no OpenGL is said once
    }
    sheet = (job.sheet,) if job is not None and isinstance(job.sheet, str) else ()
    files: tuple[str, ...] = ()
    watched = FileWatch()
    say(f"watching {design}; Ctrl-C ends it")
    try:
        while True:
            files = _files(design, files)
            watched.follow((design, *files, *sheet))  # before they are read: what is saved meanwhile is not missed
            _write(design, targets, options, job)
            watched.wait()
    except KeyboardInterrupt:
        say(f"no longer watching {design}")


def _beside(design: str) -> tuple[str, ...]:
    """The picture and the tiles beside a design; refuse files that are there and that we have not made."""
    targets = tuple(str(Path(design).with_suffix(suffix)) for suffix in (_PICTURE, ".svg"))
    for target in targets:
        if os.path.lexists(target) and not _is_ours(target):
            named = " ".join(f"-o {Path(design).with_suffix('')}-tile{Path(path).suffix}" for path in targets)
            raise click.UsageError(
                f"{target} is there already, and was not made by this program, or not left as it was. "
                f"Say what to write: {named}, or other names."
            )
    return targets


def _is_ours(path: str) -> bool:
    """Whether a file was written by this program, and by no other after it."""
    from voronoi_tiles.formats.svg.writer import RECIPE_NAMESPACE

    try:
        with Path(path).open("rb") as file:
            head = file.read(_HEAD)
    except OSError:
        return False
    if path.endswith(_PICTURE):
        return b"Software\0voronoi-tiles" in head
    return RECIPE_NAMESPACE.encode() in head and b"sodipodi:" not in head  # Inkscape keeps our recipe


def _refuse_design(design: str) -> None:
    """Refuse what cannot be watched."""
    from voronoi_tiles.base.files import STDOUT, is_special
    from voronoi_tiles.designs.load import refuse_drawing

    refuse_drawing(design, design)
    if design == STDOUT or is_special(design):
        raise click.UsageError("Only a file can be watched, which is read whenever it is saved.")
    if not os.path.isfile(design):  # noqa: PTH113 - a name that the system refuses is no file, and no error here
        raise click.UsageError(
            f"There is no file {design!r} to watch. Make one to begin with: voronoi-tiles new p4 -o bird.toml."
        )


def _refuse_targets(design: str, targets: Sequence[str]) -> None:
    """Refuse what cannot be written again and again."""
    from voronoi_tiles.base.files import STDOUT, is_special
    from voronoi_tiles.formats.presets import SUFFIXES
    from voronoi_tiles.tiling import FORMATS

    suffixes = (_PICTURE, *(f".{name}" for name in (*FORMATS, *SUFFIXES)))
    for target in targets:
        if target == STDOUT or is_special(target):
            raise click.UsageError(f"{target} cannot be written again and again: give a file, -o FILE.")
        if not target.lower().endswith(suffixes):
            raise click.UsageError(f"The format of {target} is not clear: give it the suffix {' or '.join(suffixes)}.")
        if os.path.realpath(target) == os.path.realpath(design):
            raise click.UsageError(f"{target} is what is watched, and would be overwritten.")


def _files(design: str, known: tuple[str, ...]) -> tuple[str, ...]:
    """The drawings that a design names; those of before where it cannot be read, which is said later."""
    from voronoi_tiles.designs.named_files import named_files

    try:
        return named_files(design)
    except DesignError:
        return known


def _write(design: str, targets: Sequence[str], options: RenderOptions, job: Job | None) -> None:
    """Write all files of a design: one line says what was written, one message what went wrong."""
    begun = time.monotonic()
    written: list[str] = []
    failure: Exception | None = None
    try:
        written.extend(_written(design, targets, options, job))  # what comes before a failure is kept
    except Exception as error:  # noqa: BLE001 - whatever it is, the next version may be right
        failure = error
    if written:
        say(f"{time.strftime('%H:%M:%S')} wrote {', '.join(written)} in {time.monotonic() - begun:.1f} s")
    if failure is not None:
        report_error(design, failure)


def _written(design: str, targets: Sequence[str], options: RenderOptions, job: Job | None) -> Iterator[str]:
    """Write one file after the other, and give what to say of each. Raises what keeps the others from being written."""
    from voronoi_tiles.pictures.rendering import render

    pictures = [target for target in targets if target.lower().endswith(_PICTURE)]
    read = load(design)
    try:
        tiling = read.tessellate()
    except TouchingCopiesError:
        for target in pictures:
            render(read, target, **options)
            yield target
        raise
    for target in targets:
        if target in pictures:
            tiling.render(target, **options)
            yield target
            continue
        for path, product in tiling.export(target, job=job):
            for note in () if product is None else product.notes:
                say(as_options(note))
            yield path if product is None else f"{path} ({as_options(product.summary())})"
