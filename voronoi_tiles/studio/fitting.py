"""Designs for an outline that is dropped onto the page, as the search finds them."""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable, Iterator
from typing import Any, Final, TypeVar

from voronoi_tiles.base.text import printable
from voronoi_tiles.escherization.drawn_outline import DrawnOutline, outline_of
from voronoi_tiles.escherization.fit_folder import fit_picture, fitted_art
from voronoi_tiles.escherization.fits import Fit, fit
from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.parallel.blocks import processors
from voronoi_tiles.studio.messages import DROP_MAX

PROCESSES_MAX: Final = 4
"""How many processes look at most; a count. Each is as large as a worker, and few outlines have more work than that."""

_ART: Final = "art.svg"
"""What a design's art is called until somebody takes the design."""

Said = TypeVar("Said")


def fitted(
    data: bytes, name: str, groups: str, *, mirrored: bool, symmetric: bool = False
) -> Iterator[tuple[dict[str, Any], bytes]]:
    """Designs whose tiles come near to the outline of an SVG or DXF file: messages, each with the bytes of its art.

    The first is "outline", with "notes" on what was taken for what; then there are "progress", the share that is
    `done`, and "fit", a design in its JSON form, in millimetres, with its picture as SVG and, where there is art, the
    table of that. `groups` are names between commas, "" for those that the command looks in without any. Raises
    DrawingError, ArgumentError.
    """
    name = printable(os.path.basename(name)) or "drawing"  # noqa: PTH119 - any name
    if len(data) > DROP_MAX:
        raise DrawingError(f"larger than {DROP_MAX >> 20} MiB", file=name, remedy="Take the outline alone.")
    drawn = outline_of(data, name)
    names = [each.strip() for each in groups.split(",")] if groups.strip() else None
    yield {"type": "outline", "notes": drawn.notes}, b""

    def look(say: Callable[[tuple[dict[str, Any], bytes]], None]) -> None:
        fit(
            drawn.silhouette.polygon,
            groups=names,
            mirrored=mirrored,
            symmetric=symmetric,
            name=drawn.name,
            workers=min(processors(), PROCESSES_MAX),
            progress=lambda done, _: say(({"type": "progress", "done": done}, b"")),
            found=lambda each: say(_message(each, drawn, name)),
        )

    yield from _said_by(look)


def _message(found: Fit, drawn: DrawnOutline, name: str) -> tuple[dict[str, Any], bytes]:
    """What the page is told of a design, and its art."""
    art = fitted_art(found, _ART, name, drawn, 1.0)
    message = {
        "type": "fit",
        "group": found.group,
        "overlap": round(found.overlap, 5),
        "distance": round(found.distance, 4),
        "corners": found.corners,
        "symmetric": found.symmetric,
        "design": found.design.to_dict(),
        "picture": fit_picture(found, art).svg,
        "art": None if art is None else art.placed.table,
        "notes": () if art is None else art.carried.notes,
    }
    return message, b"" if art is None else art.carried.svg


def _said_by(work: Callable[[Callable[[Said], None]], object]) -> Iterator[Said]:
    """What a function says while it works, in a thread of its own; what it raises comes last."""
    said: queue.SimpleQueue[tuple[Said] | None] = queue.SimpleQueue()
    failed: list[BaseException] = []

    def run() -> None:
        try:
            work(lambda message: said.put((message,)))
        except BaseException as error:  # noqa: BLE001 - it is raised where it is asked for
            failed.append(error)
        finally:
            said.put(None)

    threading.Thread(target=run, daemon=True).start()
    while (message := said.get()) is not None:
        yield message[0]
    for error in failed:
        raise error
