"""The table of a sweep: a row a design, as CSV or Parquet, filtered and sorted by expressions."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arguments import instance
from voronoi_tiles.base.errors import MissingLibraryError, UnknownNameError
from voronoi_tiles.sweeps.expression import Column, evaluate

TEXTS: Final = ("group", "error")
"""The columns of texts; all others have numbers."""

COUNTS: Final = ("number", "edges", "vertices", "neighbours", "pieces")
"""The columns of whole numbers, of which figures of several sites have more to their names."""


@dataclass(frozen=True, eq=False, repr=False)
class SweepTable:
    """Rows of cells by the names of their columns; a cell without a value is None.

    >>> import voronoi_tiles as vt
    >>> table = vt.sweep(vt.Sweep(vt.starter("p4"), {"cell.a": [10, 60, 80]}), workers=1).table
    >>> table
    <SweepTable: 3 rows of 13 columns>
    >>> table["neighbours"], table.error(0)[:27]
    ([None, 5, 5], 'site "bird" touches its own')
    """

    names: tuple[str, ...]
    rows: Sequence[Sequence[Any]]

    def __repr__(self) -> str:
        return f"<SweepTable: {len(self)} rows of {len(self.names)} columns>"

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, name: str) -> list[Any]:
        """The cells of a column. Raises UnknownNameError."""
        if instance("name", name, str) not in self.names:
            raise UnknownNameError(f"there is no column {name}", remedy=f"Columns are {', '.join(self.names)}.")
        place = self.names.index(name)
        return [row[place] for row in self.rows]

    def error(self, row: int) -> str:
        """What went wrong with a design; "" where nothing did."""
        return str(self.rows[row][-1])

    @property
    def csv(self) -> str:
        """The table as CSV: a head, a line a row, numbers with all their digits."""
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.names)
        writer.writerows(self.rows)
        return text.getvalue()

    @property
    def parquet(self) -> bytes:
        """The table as a Parquet file. Raises MissingLibraryError where pyarrow is not installed."""
        pa, parquet = pyarrow()
        columns = {name: pa.array(self[name], _arrow_type(name, pa)) for name in self.names}
        file = io.BytesIO()
        parquet.write_table(pa.table(columns), file)
        return file.getvalue()

    def chosen(self, where: str, by: Sequence[str], most: int) -> list[int]:
        """The rows without an error for which a condition holds ("" for all), in the order of some expressions.

        `most` is how many there are at most. Rows that an expression tells nothing of come last, equal ones in the
        order of the table. Raises DesignError for expressions that cannot be.
        """
        good = self.values("error") == ""
        if where:
            good = good & self.values(where)
        rows = np.flatnonzero(good)
        keys = [_ranks(self.values(each)[rows]) for each in by]
        order = np.lexsort([rows, *reversed(keys)])
        return [int(row) for row in rows[order][:most]]

    def values(self, expression: str) -> NDArray[Any]:
        """The values of an expression over the columns, one for each row. Raises DesignError."""
        return evaluate(expression, self._columns).values

    @cached_property
    def _columns(self) -> dict[str, Column]:
        """The columns as arrays."""
        found = {}
        for name in self.names:
            cells = self[name]
            found[name] = (
                Column("text", np.array(cells, str))
                if name in TEXTS
                else Column("number", np.array([np.nan if cell is None else cell for cell in cells], np.float64))
            )
        return found


def _ranks(values: NDArray[Any]) -> NDArray[Any]:
    """Numbers that sort as values do, of texts too; those of NaN are the last."""
    return np.unique(values, return_inverse=True)[1]


def pyarrow() -> tuple[Any, Any]:
    """The library that writes Parquet files. Raises MissingLibraryError where it is not installed."""
    try:
        import pyarrow as pa
        from pyarrow import parquet
    except ImportError as error:
        raise MissingLibraryError(
            "Parquet files are written by pyarrow, which is not installed",
            remedy="Install it, pip install pyarrow, or take the table as CSV.",
        ) from error
    return pa, parquet


def _arrow_type(name: str, pa: Any) -> Any:
    """The type of a column in Parquet."""
    if name in TEXTS:
        return pa.string()
    return pa.int64() if name.rpartition(".")[2] in COUNTS else pa.float64()
