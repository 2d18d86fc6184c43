"""The files that a design names, whether it can be used or not: what it waits for as well as what it is made of."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import Any

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.designs.load import read_table


def named_files(path: str) -> tuple[str, ...]:
    """The drawings that a design file names, as seen from where we are; they need not be there.

    Raises DesignError where the design cannot be read, or is neither TOML nor JSON.
    """
    table = read_table(path, path)
    folder = os.path.dirname(path)  # noqa: PTH120 - any name
    try:
        return tuple(dict.fromkeys(os.path.join(folder, name) for name in _names(table)))  # noqa: PTH118 - any name
    except RecursionError as error:
        raise DesignError("is nested too deeply", file=path) from error


def _names(part: Any) -> Iterator[str]:
    """The texts of the keys "file", and of "art" where it is short for a table with one."""
    if isinstance(part, Mapping):
        for key, value in part.items():
            if isinstance(value, str):
                if key in ("file", "art"):
                    yield value
            else:
                yield from _names(value)
    elif isinstance(part, list):
        for value in part:
            yield from _names(value)
