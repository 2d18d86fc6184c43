"""The folder of a sweep: rows that are there are not made again, whatever ended the run that made them."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from voronoi_tiles.base.errors import OutputError
from voronoi_tiles.base.files import output_error, write_whole
from voronoi_tiles.base.values import is_number
from voronoi_tiles.base.version import __version__
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.sweeps.design_rows import Row
from voronoi_tiles.sweeps.sweep import Sweep

MARK: Final = "sweep.json"
"""The file that says which sweep a folder is of."""

ROWS, KEPT = "rows", "kept"
TABLE, KEPT_TABLE, PARQUET = "table.csv", "kept.csv", "table.parquet"
SHEETS: Final = ("sheet.html", "sheet.svg", "sheet.png")
"""The contact sheet of what was kept."""

_OURS: Final = (ROWS, KEPT, TABLE, KEPT_TABLE, PARQUET, *SHEETS)
_BLOCK: Final = re.compile(r"(\d{7})-(\d{7})\.json")
_ANOTHER: Final = "Give it a folder of its own."


class SweepFolder:
    """Where the rows of a sweep are kept, and what is made of them.

    Raises OutputError where the folder cannot be made, holds another sweep or one of another version, or files that
    would be overwritten.
    """

    def __init__(self, path: str, sweep: Sweep) -> None:
        self.path = Path(path)
        self._name = path
        if not path:
            raise output_error(path, ValueError("the name is empty"))
        self._make("")
        mark = {"program": f"voronoi-tiles {__version__}", **sweep.identity}
        self._require_own(mark)
        # The mark comes first: what a run leaves that ends here is known as its own.
        write_whole(self.path / MARK, (json.dumps(mark, indent=1) + "\n").encode())
        self._make(ROWS)
        self._make(KEPT)

    def rows(self, width: int) -> dict[int, Row]:
        """The rows that are there, by the numbers of their designs; what cannot be read is made again."""
        found: dict[int, Row] = {}
        for file in sorted((self.path / ROWS).iterdir()):
            if not _BLOCK.fullmatch(file.name):
                continue
            with suppress(OSError, ValueError, TypeError, RecursionError):
                rows = json.loads(file.read_bytes())
                found |= {row[0]: row for row in rows if _is_row(row, width)}
        return found

    def keep_rows(self, rows: Sequence[Row]) -> None:
        """Write the rows of a block, whole or not at all. Raises OutputError."""
        name = f"{rows[0][0]:07d}-{rows[-1][0]:07d}.json"
        lines = ",\n".join(json.dumps(row, separators=(",", ":")) for row in rows)
        write_whole(self.path / ROWS / name, f"[{lines}]\n".encode())

    def keep_designs(self, designs: Mapping[str, str], unchanged: Iterable[tuple[str, str]]) -> None:
        """Write designs, by the names of their files, that are not there yet; those of an earlier choice are removed.

        What somebody has changed stays: `unchanged` are the names and the texts of files as we would have written them.
        Raises OutputError.
        """
        for name, text in designs.items():
            path = self.path / KEPT / name
            if not path.exists():
                write_whole(path, text.encode())
        for name, text in unchanged:
            path = self.path / KEPT / name
            with suppress(OSError):
                if path.read_bytes() == text.encode():
                    path.unlink()

    @property
    def kept(self) -> list[str]:
        """The names of the designs that are there."""
        return sorted(path.name for path in (self.path / KEPT).glob("*.toml"))

    def write(self, name: str, data: bytes) -> None:
        """Write a file, whole or not at all. Raises OutputError."""
        write_whole(self.path / name, data)

    def _make(self, name: str) -> None:
        """Make a folder where there is none. Raises OutputError."""
        path = self.path / name
        try:
            path.mkdir(parents=True, exist_ok=True)
        except (OSError, ValueError) as error:
            raise output_error(str(path), error) from error

    def _require_own(self, mark: Mapping[str, Any]) -> None:
        """Raise OutputError where the folder is another sweep's, or nobody knows whose."""
        path = self.path / MARK
        if not path.exists():
            there = [name for name in _OURS if (self.path / name).exists()]
            if there:
                message = f"{self.path / there[0]} exists already, and is of no sweep"
                raise OutputError(message, path=self._name, remedy=_ANOTHER)
            return
        try:
            other = json.loads(path.read_bytes())
            assert isinstance(other, dict)
        except (OSError, ValueError, RecursionError, AssertionError):
            raise OutputError(f"{path} cannot be read", path=self._name, remedy=_ANOTHER) from None
        if other == json.loads(json.dumps(mark)):
            return
        if other.get("program") != mark["program"]:
            message = f"{self._name} holds a sweep by {other.get('program')}, and this is {mark['program']}"
        else:
            differ = [name for name in {**mark, **other} if mark.get(name) != other.get(name)]
            message = f"{self._name} holds another sweep, with other values of {', '.join(differ)}"
        raise OutputError(message, path=self._name, remedy=_ANOTHER)


def _is_row(row: Any, width: int) -> bool:
    """Whether a value is a row of so many cells: a number, a group, numbers or nothing, and what went wrong."""
    if not (isinstance(row, list) and len(row) == width):
        return False
    number, group, *cells, error = row
    numbers = [cell for cell in cells if cell is not None]
    return (
        type(number) is int
        and group in GROUPS
        and isinstance(error, str)
        and all(is_number(cell) and abs(cell) <= sys.float_info.max for cell in numbers)
    )
