"""What Inkscape calls an extension with: the dialog's values, the selected objects, and a copy of the drawing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from voronoi_tiles.base.errors import ArgumentError, why_not_opened
from voronoi_tiles.fabrication.job_options import Option, OptionTable
from voronoi_tiles.formats.shapes import DrawingError

INSTALL_AGAIN: Final = 'Run "voronoi-tiles inkscape install" once more, and start Inkscape again.'
"""What to do where the dialogs are of another version."""

_OWN: Final = ("page", "selected-nodes")
"""What Inkscape says that no option is: the page that is open, and nodes that are selected."""


@dataclass(frozen=True)
class Call:
    """The values by the names of options, texts as they stand in the dialog; ids in the order of selection; a file."""

    values: Mapping[str, str]
    ids: tuple[str, ...]
    file: str

    @classmethod
    def of(cls, words: Sequence[str]) -> Call:
        """Read the words of a command line. Raises ArgumentError where no file is named."""
        values: dict[str, str] = {}
        ids, files = [], []
        for word in words:
            name, _, value = word.removeprefix("--").partition("=")
            if not word.startswith("--"):
                files.append(word)
            elif name == "id":
                ids.append(value)
            elif name not in _OWN:
                values[name] = value
        if len(files) != 1:
            raise ArgumentError("this is for Inkscape to call, with one drawing", remedy="See its menu Extensions.")
        return cls(values, tuple(dict.fromkeys(ids)), files[0])

    def drawing(self) -> bytes:
        """The drawing's file. Raises DrawingError."""
        try:
            return Path(self.file).read_bytes()
        except (OSError, ValueError) as error:
            reason = why_not_opened(self.file, error)
            raise DrawingError(f"cannot be read: {reason}", file=self.file, remedy="Check the name.") from None

    def arguments(self, *tables: type[OptionTable]) -> list[dict[str, Any]]:
        """The values as arguments of tables of options; what is left empty is not said.

        Raises ArgumentError for names that no table has.
        """
        options = [table.options() for table in tables]
        for name in self.values:
            if not any(name in known for known in options):
                raise ArgumentError(f'the dialog has "{name}", which is not known here', remedy=INSTALL_AGAIN)
        said = {name: value for name, value in self.values.items() if value.strip()}
        return [{name: _typed(known[name], said[name]) for name in said if name in known} for known in options]


def _typed(option: Option[Any, Any], value: str) -> Any:
    """A value in the type that its option reads."""
    match option.kind:
        case "flag":
            return {"true": True, "false": False}.get(value, value)
        case "angle":
            try:
                return float(value)
            except ValueError:
                return value
        case _:
            return value
