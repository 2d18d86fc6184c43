"""What runs in a process of our own: it does blocks, one at a time, until nobody is there to ask."""

from __future__ import annotations

import os
import pickle
import queue
import threading
import traceback
from contextlib import suppress
from typing import Any, BinaryIO


def main() -> None:
    """Read functions with their blocks from standard input; write of each whether it went well, and what came of it."""
    asked, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)  # what reads standard input reads nothing
    os.dup2(2, 1)  # what some library prints is no answer
    requests: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_read, args=(asked, requests), daemon=True).start()
    while True:
        answers.write(_answer(requests.get()))
        answers.flush()


def _read(file: BinaryIO, requests: queue.SimpleQueue[bytes]) -> None:
    """Read requests, and end the process with the last, whatever it is doing: who asked is gone."""
    with suppress(Exception):
        while True:
            requests.put(pickle.load(file))  # noqa: S301 - of the process that has started us
    os._exit(0)


def _answer(request: bytes) -> bytes:
    """Do a block. Whatever it raises is raised once more where it was asked for, with where that was."""
    try:
        function, block = pickle.loads(request)  # noqa: S301 - as above
        return pickle.dumps((True, function(block)))
    except Exception as error:  # noqa: BLE001 - a worker goes on
        return _raised(error)


def _raised(error: Exception) -> bytes:
    """An error to be raised again; one that cannot be pickled, or not read, is told."""
    told = "".join(traceback.format_exception(error))
    error.add_note(f"In a process of its own:\n{told}")
    plain: Any = (False, error)
    with suppress(Exception):
        text = pickle.dumps(plain)
        pickle.loads(text)  # noqa: S301 - our own
        return text
    return pickle.dumps((False, RuntimeError(told)))
