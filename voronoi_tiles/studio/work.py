"""What a worker does: reads requests from its standard input until it ends, and answers each on its standard output.

A request is a frame: an object with a "task", which names the function that does it, and what that needs.
An answer is frames, too: a head has an "error", or else what there is to say of its body, and "more" where it is not
the last.
"""

from __future__ import annotations

import json
import os
import queue
import shutil
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cache
from typing import TYPE_CHECKING, Any, BinaryIO, Final

from voronoi_tiles.studio.frames import FRAME_START, pack, sizes_of
from voronoi_tiles.studio.refusals import error_document

if TYPE_CHECKING:
    from voronoi_tiles.studio.modelling import Modeller
    from voronoi_tiles.studio.outlining import Outliner

Request = Mapping[str, Any]
Done = tuple[Mapping[str, Any], bytes]

_MEMORY: Final = 4 << 30
"""How much memory a worker may have; bytes. What takes more is refused, and the machine lives on."""

_AHEAD_S: Final = 0.001
"""How much of a start an outline has before its proof is begun: where processors are few, it would wait; seconds."""

_AFTER_OTHERS: Final = 5
"""By how many ranks a worker stands back behind the studio, whose own may be any: a third of its share."""


def text_of(message: Mapping[str, Any] | Sequence[Any]) -> Done:
    """An answer that is text: a message."""
    return {}, json.dumps(message, separators=(",", ":"), allow_nan=False).encode()


def tables(_request: Request, _body: bytes) -> Done:
    """What the page knows of groups, strokes, jobs and presets."""
    from voronoi_tiles.studio.tables import page_tables

    return text_of(page_tables())


def examples(_request: Request, _body: bytes) -> Done:
    """The starter designs."""
    from voronoi_tiles.studio.tables import starter_designs

    return text_of(starter_designs())


def outline(request: Request, _body: bytes) -> Iterator[Done]:
    """The outlines of a design, and their proof."""
    asked = {name: request[name] for name in ("rev", "design", "rest", "tolerance")}
    for message, more in _outliner().outlines(**asked):
        yield {"more": more}, text_of(message)[1]
        if more:
            time.sleep(_AHEAD_S)


def product(request: Request, _body: bytes) -> Done:
    """What a job makes of a design."""
    from voronoi_tiles.studio.making import product as made

    return text_of(made(**{name: request[name] for name in ("rev", "design", "job", "limits", "name")}))


def solid(request: Request, _body: bytes) -> Iterator[Done]:
    """The solids of a design: each answer a frame of their message and meshes, the last without "more" to come."""
    asked = {name: request[name] for name in ("rev", "design", "job", "name")}
    for frame, more in _modeller().solids(**asked):
        yield {"binary": True, "more": more}, frame


def solid_file(request: Request, _body: bytes) -> Done:
    """The file of a design's solids."""
    from voronoi_tiles.studio.modelling import solid_file as made

    return _file(*made(request["design"], request["job"], request["name"]))


def thumbnail(request: Request, _body: bytes) -> Done:
    """The tiles of a design for a small picture."""
    from voronoi_tiles.designs.design import Design
    from voronoi_tiles.studio.outlining import thumbnail_tiles

    tiles = thumbnail_tiles(Design.from_dict(request["design"]))
    return text_of({"type": "thumbnail", "rev": request["rev"], "tiles": tiles})


def export(request: Request, _body: bytes) -> Done:
    """The file that a job makes of a design."""
    from voronoi_tiles.studio.making import exported

    return _file(*exported(request["design"], request["job"], request["name"]))


def coupon(request: Request, _body: bytes) -> Done:
    """The file of a coupon."""
    from voronoi_tiles.studio.making import coupon_file

    return _file(*coupon_file(request["options"]))


def drop(request: Request, body: bytes) -> Done:
    """What a drawing, a design, or a file of ours that is dropped onto the page holds."""
    from voronoi_tiles.base.units import UNIT_MM
    from voronoi_tiles.studio.drop import dropped

    return text_of(dropped(body, request["name"], UNIT_MM[request["units"]], request["folder"]))


def fits(request: Request, body: bytes) -> Iterator[Done]:
    """Designs whose tiles come near to an outline: messages, the first without art, and the art of each design.

    Whatever else is to be done on the machine goes first.
    """
    from voronoi_tiles.studio.fitting import fitted

    _stand_back()
    asked = (request["name"], request["groups"])
    for message, art in fitted(body, *asked, mirrored=request["mirrored"], symmetric=request["symmetric"]):
        yield {"more": True, "message": message}, art
    yield text_of({"type": "done"})


def _file(name: str, data: bytes) -> Done:
    """An answer that is a file."""
    return {"file": name}, data


@cache  # ranks add up
def _stand_back() -> None:
    """Let others have the processors first, from now on."""
    with suppress(AttributeError):  # where there are no such ranks, processors are shared evenly
        os.nice(_AFTER_OTHERS)


@cache
def _outliner() -> Outliner:
    """What outlines designs in this worker."""
    from voronoi_tiles.studio.outlining import Outliner

    return Outliner()


@cache
def _modeller() -> Modeller:
    """What makes solids of designs in this worker."""
    from voronoi_tiles.studio.modelling import Modeller

    return Modeller()


Tasks = Mapping[str, Callable[[Request, bytes], Done | Iterator[Done]]]

TASKS: Final[Tasks] = {
    "tables": tables,
    "examples": examples,
    "outline": outline,
    "product": product,
    "solid": solid,
    "solid_file": solid_file,
    "thumbnail": thumbnail,
    "export": export,
    "coupon": coupon,
    "drop": drop,
    "fits": fits,
}


def do(request: Request, body: bytes, tasks: Tasks = TASKS) -> Iterator[bytes]:
    """Do what is asked for; the frames of the answer. Whatever goes wrong becomes an error for people, the last."""
    try:
        done = tasks[request["task"]](request, body)
        for head, data in (done,) if isinstance(done, tuple) else done:
            yield pack(head, data)
    except Exception as error:  # noqa: BLE001 - a worker goes on
        scale = request.get("design", {}).get("scale", 1.0)
        yield pack({"error": error_document(error, scale if isinstance(scale, float | int) and scale > 0 else 1.0)})


def run(tasks: Tasks = TASKS, warm: Callable[[], object] | None = None) -> None:
    """Do what is asked for until nobody is there to ask; `warm` does what makes the first time as quick as others.

    Temporary files go into the folder that is named on the command line, which goes with us.
    """
    _bound_memory()
    asked, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)  # a design that names standard input, "-", reads nothing
    os.dup2(2, 1)  # what some library prints is no answer
    scratch = tempfile.tempdir = sys.argv[1] if len(sys.argv) > 1 else None
    requests: queue.SimpleQueue[tuple[Request, bytes]] = queue.SimpleQueue()
    threading.Thread(target=_read, args=(asked, requests, scratch), daemon=True).start()
    if warm is not None:
        warm()
    frames: Iterable[bytes] = (pack({"ready": True}),)
    while True:
        for frame in frames:
            answers.write(frame)
            answers.flush()
        frames = do(*requests.get(), tasks)


def _read(file: BinaryIO, requests: queue.SimpleQueue[tuple[Request, bytes]], scratch: str | None) -> None:
    """Read requests, and end the process with the last, whatever it is doing: the server is gone.

    What it has half done is in the folder `scratch`, where it has one, which is removed.
    """
    with suppress(Exception):
        while len(start := file.read(FRAME_START)) == FRAME_START:
            head, body = sizes_of(start)
            request = json.loads(file.read(head))
            requests.put((request, file.read(body)))
    if scratch is not None:
        shutil.rmtree(scratch, ignore_errors=True)
    os._exit(0)


def warm_up() -> None:
    """Import what the first design needs, and run through it."""
    from voronoi_tiles.designs.starters import starter

    starter("p4").tessellate()


def _bound_memory() -> None:
    """Let the system refuse more memory than a design should take, where it can."""
    with suppress(ImportError, OSError, ValueError):
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (_MEMORY, _MEMORY))


if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    run(warm=warm_up)
