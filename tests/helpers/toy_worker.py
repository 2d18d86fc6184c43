"""A worker of the studio's own kind whose tasks are toys: they sleep, die, spin, print and fail as they are told."""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.studio.work import Done, run


def echo(request: Mapping[str, Any], body: bytes) -> Done:
    """Give back what came."""
    return {"said": request.get("say"), "pid": os.getpid()}, body


def count(request: Mapping[str, Any], _body: bytes) -> Iterator[Done]:
    """Count up to a number, an answer each, the last with an error where it is `wrong`."""
    for k in range(request["to"]):
        yield {"said": k, "more": True}, b""
    if request.get("wrong"):
        raise ArgumentError("the `kerf` is wrong", remedy="Mend it.")
    yield {"said": request["to"]}, b"end"


def nap(request: Mapping[str, Any], _body: bytes) -> Done:
    """Sleep for so many seconds."""
    time.sleep(request["seconds"])
    return {"said": request.get("say")}, b""


def spin(_request: Mapping[str, Any], _body: bytes) -> Done:
    """Never come to an end, and keep the interpreter busy."""
    while True:
        pass


def listen(_request: Mapping[str, Any], _body: bytes) -> Done:
    """Read the standard input to its end, as it is and as a file."""
    return {"said": [sys.stdin.read(), os.read(0, 100).decode()]}, b""


def leave(request: Mapping[str, Any], _body: bytes) -> Done:
    """Begin a temporary file, and never come to an end; say in a file where it is."""
    scratch = tempfile.mkdtemp()
    Path(scratch, "half").write_text("done")
    Path(request["say"]).write_text(scratch)
    while True:
        time.sleep(60)


def die(_request: Mapping[str, Any], _body: bytes) -> Done:
    """End without a word."""
    os._exit(3)


def chatter(_request: Mapping[str, Any], _body: bytes) -> Done:
    """Print, as some libraries do, from Python and past it."""
    print("hello", flush=True)  # noqa: T201 - that is what it is for
    os.write(1, b"hello")
    return {"said": "printed"}, b""


def fail(request: Mapping[str, Any], _body: bytes) -> Done:
    """Raise an error for people, or a bug."""
    if request.get("bug"):
        raise KeyError("bug")
    raise ArgumentError("the `kerf` is wrong", remedy="Mend it.")


def hoard(request: Mapping[str, Any], _body: bytes) -> Done:
    """Take so many bytes of memory."""
    return {"said": len(bytearray(request["bytes"]))}, b""


def fits(request: Mapping[str, Any], body: bytes) -> Iterator[Done]:
    """Find so many designs, every other with art; then go on for ever, or fail, where that is asked for."""
    yield {"more": True, "message": {"type": "outline", "pid": os.getpid()}}, b""
    for k in range(request["count"]):
        art = None if k % 2 else {"scale": k}
        yield {"more": True, "message": {"type": "fit", "art": art}}, b"" if art is None else body + b" %d" % k
    while request.get("spin"):
        pass
    if request.get("wrong"):
        raise ArgumentError("the `kerf` is wrong", remedy="Mend it.")
    yield {}, b""


if __name__ == "__main__":
    run({task.__name__: task for task in (echo, count, nap, spin, listen, leave, die, chatter, fail, hoard, fits)})
