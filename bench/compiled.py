"""Peers in C++, compiled from the sources beside this file into folders that are removed at the end."""

from __future__ import annotations

import atexit
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path


class MissingError(Exception):
    """A peer cannot be compiled here; the message says what is missing."""


def version_of(probe: str, *, without_compiler: str, without_library: str) -> str:
    """The last word of a source after the preprocessor: the version that a library's header defines.

    Raises MissingError with one of the messages where there is no compiler or no library.
    """
    if shutil.which("g++") is None:
        raise MissingError(without_compiler)
    command = ["g++", "-E", "-P", "-x", "c++", "-"]
    finished = subprocess.run(command, input=probe, capture_output=True, text=True, check=False)  # noqa: S603 ours
    if finished.returncode:
        raise MissingError(without_library)
    return finished.stdout.split()[-1].strip('"')


@cache
def program_of(source: Path, flags: tuple[str, ...], libraries: tuple[str, ...] = ()) -> Path:
    """The program that a source compiles to."""
    folder = tempfile.mkdtemp(prefix=f"{source.stem}-")
    atexit.register(shutil.rmtree, folder)
    program = Path(folder, source.stem)
    command = ["g++", *flags, "-o", str(program), str(source), *libraries]
    subprocess.run(command, check=True)  # noqa: S603 our own source
    return program
