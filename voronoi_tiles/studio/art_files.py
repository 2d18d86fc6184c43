"""Files of art that the studio lays beside the design."""

from __future__ import annotations

import os
from itertools import count
from pathlib import Path
from typing import Final

from voronoi_tiles.base.files import write_whole

_SAME_MAX: Final = 100
"""How many files of art are looked at, whether one of them is the same already; a count."""


def lay_beside(folder: str, name: str, data: bytes) -> str:
    """Write the art of a design of this name into its folder, whole; the file's name, which no other had.

    Where a file of that kind holds the same already, that is it. Raises OutputError.
    """
    for number in count(1):
        file = f"{name}-art.svg" if number == 1 else f"{name}-art-{number}.svg"
        path = Path(folder, file)
        if not os.path.lexists(path):
            write_whole(path, data)
            return file
        if number <= _SAME_MAX and _holds(path, data):
            return file
    raise AssertionError("numbers do not end")


def _holds(path: Path, data: bytes) -> bool:
    """Whether a file is there and has these bytes."""
    try:
        return path.is_file() and path.stat().st_size == len(data) and path.read_bytes() == data
    except OSError:
        return False
