"""Writing folders, new or empty ones: with all that belongs into them, or not at all."""

from __future__ import annotations

import errno
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from voronoi_tiles.base.errors import OutputError
from voronoi_tiles.base.files import output_error


def refuse_filled(folder: str) -> None:
    """Raise OutputError for a folder that holds anything, for what is none, and where none can be made."""
    try:
        path = _real(folder)
        taken = path.exists() and (not path.is_dir() or any(path.iterdir()))
        there = next(each for each in (path, *path.parents) if each.exists())
        if not taken and not there.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
        if not taken and not os.access(there, os.W_OK | os.X_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    except (OSError, ValueError) as error:
        raise output_error(folder, error) from error
    if taken:
        raise OutputError(f"{folder} exists already", path=folder, remedy="Give a folder that is new, or empty.")


@contextmanager
def filling(folder: str) -> Iterator[Path]:
    """A temporary folder to write into, whose files are those of `folder` when the block ends.

    A new folder comes with all of them, in one step; one that is there, and empty, stays the same: somebody may stand
    in it, and it may be a disk of its own. Nothing is left when an exception leaves the block. Raises OutputError.
    """
    refuse_filled(folder)
    path = _real(folder)
    kept = path.is_dir()
    missing = [each for each in path.parents if not each.exists()]
    made = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        made = Path(tempfile.mkdtemp(prefix=".voronoi-tiles-", dir=path if kept else path.parent))
        yield made
        if not kept:
            made.chmod(0o777 & ~_umask())
            made.rename(path)
        else:
            _move_up(made)
    except OSError as error:
        raise output_error(folder, error) from error
    finally:
        if made is not None:
            shutil.rmtree(made, ignore_errors=True)
        for each in missing:
            with suppress(OSError):  # it holds what was made
                each.rmdir()


def _move_up(made: Path) -> None:
    """Move the files of a folder into the one that it lies in, alone."""
    if [*made.parent.iterdir()] != [made]:
        raise OSError(errno.ENOTEMPTY, os.strerror(errno.ENOTEMPTY))
    for each in [*made.iterdir()]:
        each.rename(made.parent / each.name)


def _real(folder: str) -> Path:
    """Where a folder is, or will be, through symbolic links."""
    if not folder:
        raise ValueError("the name is empty")
    return Path(os.path.realpath(folder))


def _umask() -> int:
    """What the process takes from the rights of new files."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask
