"""Commands that write pictures: how a page shows them, how they are run, and the tables that hold what they wrote.

A page shows what a reader types in the repository's root; what is run is the same command with the interpreter of the
environment and, for tests, with another folder for the result. So a page cannot show a command that was not run.
"""

from __future__ import annotations

import shlex
import subprocess
import sys
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
"""The repository: commands run there, and designs and results are named from there."""

PROCESSES = 2
"""How many commands run at a time; a count. One of them takes up to 300 MB."""


@dataclass(frozen=True, slots=True)
class Command:
    """A command that writes one file: `program` and its subcommand, the design, the file, further arguments.

    `design` and `output` are paths from the repository's root.
    """

    program: tuple[str, ...]
    design: str
    output: str
    options: tuple[str, ...] = ()

    @property
    def shown(self) -> str:
        """The command as a page shows it."""
        return shlex.join((*self.program, self.design, "-o", self.output, *self.options))

    def run(self, folder: Path | None = None) -> None:
        """Run it; with `folder` the result goes there, under its own name. Raises RuntimeError where it fails."""
        output = ROOT / self.output if folder is None else folder / Path(self.output).name
        words = (*_installed(self.program), self.design, "-o", str(output), *self.options)
        result = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=False)
        if result.returncode:
            raise RuntimeError(f"{self.shown}\nended with {result.returncode}: {result.stderr.strip()}")


def run_all(commands: Iterable[Command], folder: Path | None = None) -> None:
    """Run commands, two at a time. Raises RuntimeError for the first that fails."""
    with ThreadPoolExecutor(PROCESSES) as pool:
        for _ in pool.map(lambda command: command.run(folder), commands):
            pass


def image_table(pictures: Sequence[tuple[str, str, str]], columns: int) -> str:
    """Markdown tables of pictures, `columns` in a row, each its alternative text, its address and its caption."""
    tables = []
    for start in range(0, len(pictures), columns):
        row = pictures[start : start + columns]
        images = " | ".join(f"![{text}]({address})" for text, address, _ in row)
        captions = " | ".join(caption for *_, caption in row)
        tables.append(f"| {images} |\n|{' :-: |' * len(row)}\n| {captions} |\n")
    return "\n".join(tables)


def command_block(commands: Iterable[Command]) -> str:
    """A Markdown block of commands, one a line."""
    return "```sh\n" + "".join(f"{command.shown}\n" for command in commands) + "```\n"


def _installed(program: tuple[str, ...]) -> tuple[str, ...]:
    """Put the environment's own programs in the place of the names that a reader types."""
    first, *rest = program
    own = {"python": sys.executable, "voronoi-tiles": str(Path(sys.executable).with_name("voronoi-tiles"))}
    return own[first], *rest
