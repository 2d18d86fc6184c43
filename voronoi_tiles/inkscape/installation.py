"""The files of our entries in Inkscape's folder of extensions: written, looked after, and removed again."""

from __future__ import annotations

import ast
import os
import sys
from collections.abc import Iterable, Mapping
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Final

from voronoi_tiles.base.errors import OutputError
from voronoi_tiles.base.files import output_error, writing
from voronoi_tiles.base.version import __version__
from voronoi_tiles.inkscape import launcher
from voronoi_tiles.inkscape.entries import ENTRIES
from voronoi_tiles.inkscape.inx import inx_text

FOLDER: Final = "voronoi-tiles"
"""The folder of ours in that of extensions."""

_MARK: Final = "written by voronoi-tiles inkscape install"
"""What stands in each of our files, so that nobody else's is written over or removed."""


def own_files(python: str, libraries: Mapping[str, str]) -> dict[str, bytes]:
    """The files of all entries by their names, for an interpreter and where that finds libraries."""
    mark = f"{_MARK} {__version__}"
    files = {f"{entry.name}.inx": inx_text(entry, f"run_{entry.name}.py", mark).encode() for entry in ENTRIES}
    source = Path(launcher.__file__).read_text(encoding="utf-8")
    for entry in ENTRIES:
        filled = source
        for name, value in (("ENTRY", entry.name), ("PYTHON", python), ("LIBRARIES", dict(libraries))):
            empty = f"\n{name} = {getattr(launcher, name)!r}".replace("'", '"')
            assert filled.count(empty) == 1, name
            filled = filled.replace(empty, f"\n{name} = {value!r}")
        files[f"run_{entry.name}.py"] = f"# {mark}\n{filled}".encode()
    return files


def current_files() -> dict[str, bytes]:
    """The files as this interpreter writes them."""
    found = {name: os.environ[name] for name in launcher.SEARCHED if name in os.environ}
    return own_files(sys.executable, found)


def install(extensions: Path) -> list[Path]:
    """Write the files into a folder of extensions, all or none, and give them.

    Raises OutputError where one cannot be written, or is somebody else's.
    """
    folder, files = extensions / FOLDER, current_files()
    foreign = [name for name in files if (folder / name).exists() and not _is_ours(folder / name)]
    if foreign:
        raise OutputError(
            f"{folder / foreign[0]} was not written by voronoi-tiles", folder, remedy="Move it away first."
        )
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        raise output_error(str(folder), error) from error
    with ExitStack() as stack:
        for name, data in files.items():
            stack.enter_context(writing(folder / name)).write(data)
    _remove(path for path in _found(folder) if path.name not in files)
    return [folder / name for name in files]


def state(extensions: Path) -> tuple[list[Path], list[str]]:
    """The files of ours that are there, and sentences on what is wrong with them: none where all is as it is to be."""
    folder, files = extensions / FOLDER, current_files()
    found = _found(folder)
    if not found:
        return [], []
    wrong = [f"{name} is missing" for name in files if not (folder / name).exists()]
    for path in found:
        data = path.read_bytes()
        if path.name in files and data != files[path.name]:
            python = _python_of(path)
            if python is not None and python != sys.executable:
                gone = "" if os.access(python, os.X_OK) else ", which is not there"
                wrong.append(f"{path.name} starts {python}{gone}; this is {sys.executable}")
            else:
                wrong.append(f"{path.name} is not as this version writes it")
    return found, wrong


def remove(extensions: Path) -> list[Path]:
    """Remove the files of ours from a folder of extensions, and give them. Raises OutputError."""
    folder = extensions / FOLDER
    found = _found(folder)
    _remove(found)
    with suppress(OSError):  # somebody keeps things there
        folder.rmdir()
    return found


def _found(folder: Path) -> list[Path]:
    """The files of ours in a folder."""
    with suppress(OSError):
        return sorted(path for path in folder.iterdir() if path.is_file() and _is_ours(path))
    return []


def _is_ours(path: Path) -> bool:
    """Whether a file was written here."""
    with suppress(OSError):
        return _MARK.encode() in path.read_bytes()[:500]
    return False


def _remove(paths: Iterable[Path]) -> None:
    """Remove files. Raises OutputError."""
    for path in paths:
        try:
            path.unlink()
        except OSError as error:
            raise OutputError(
                f"cannot remove {path}: {error.strerror}", path, remedy="Check its permissions."
            ) from error


def _python_of(path: Path) -> str | None:
    """The interpreter that a launcher starts, None of other files."""
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        name, _, value = line.partition(" = ")
        if name == "PYTHON":
            with suppress(ValueError, SyntaxError):
                return str(ast.literal_eval(value))
    return None
