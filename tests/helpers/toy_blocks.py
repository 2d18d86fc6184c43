"""Functions of blocks that are toys: they sleep, die, print and fail as they are told."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path


def square(block: int) -> int:
    """The square of a number."""
    return block * block


def pid(_block: int) -> int:
    """The process that does a block."""
    time.sleep(0.05)
    return os.getpid()


def deadly(block: int) -> int:
    """End the process where the number is 13; others take a while."""
    if block == 13:
        os.kill(os.getpid(), signal.SIGKILL)
    time.sleep(0.02)
    return block


def leaves(block: int) -> int:
    """End the process with a status that is not 0."""
    if block:
        os._exit(block)
    return block


def dies_once(block: str) -> str:
    """End the process unless it has been ended by this block before, which is told by a file of that name."""
    if block and not Path(block).exists():
        Path(block).touch()
        os._exit(3)
    return block


def fails(block: int) -> int:
    """Raise an error where the number is 2."""
    if block == 2:
        raise ZeroDivisionError("two")
    return block


class _OddError(Exception):
    """An error that cannot be read again."""

    def __init__(self, one: int, two: int) -> None:
        super().__init__(f"{one} and {two}")


def fails_oddly(block: int) -> int:
    """Raise an error that cannot be pickled."""
    raise _OddError(block, block)


def chatters(block: int) -> int:
    """Print, from Python and past it, and read standard input."""
    print("hello", flush=True)  # noqa: T201 - that is what it is for
    os.write(1, b"hello")
    return block + len(sys.stdin.read())


def naps(block: tuple[str, float]) -> int:
    """Write the number of the process into a file, and sleep for so many seconds."""
    name, seconds = block
    Path(name).write_text(str(os.getpid()))
    time.sleep(seconds)
    return os.getpid()


def big(block: int) -> bytes:
    """So many bytes."""
    return bytes(block)
