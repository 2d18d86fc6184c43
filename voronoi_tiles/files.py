"""Writing results: a file is written whole or not at all, and `-` is standard output."""

from __future__ import annotations

import os
import secrets
import stat
import sys
from contextlib import suppress
from pathlib import Path

from voronoi_tiles.errors import OutputError

STDOUT = "-"


def write_whole(path: str | os.PathLike[str], data: bytes) -> None:
    """Write a file whole or not at all: into a temporary file beside it, synced, then renamed over it.

    An existing file keeps its permissions, and stays untouched when anything fails; a symbolic link stays a link.
    `-` is standard output; devices and pipes are written directly. Raises OutputError.
    """
    name = os.fspath(path)
    if name == STDOUT:
        _write_stdout(data)
        return
    try:
        target = Path(os.path.realpath(name))
        old = _status(target)
        if old is None or stat.S_ISREG(old.st_mode):
            _replace(target, data, old)
        else:
            _write_special(target, data)
    except (OSError, ValueError) as error:  # ValueError: a null byte in the name
        raise output_error(name, error) from error


def output_error(path: str, error: Exception) -> OutputError:
    """Say in one sentence why a file could not be written."""
    reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return OutputError(f"cannot write {path}: {reason}", path=path)


def _status(target: Path) -> os.stat_result | None:
    """Give the target's status, None when there is no such file."""
    try:
        return target.stat()
    except FileNotFoundError:
        return None


def _replace(target: Path, data: bytes, old: os.stat_result | None) -> None:
    """Write beside the target and rename over it, with the permissions of the old file."""
    if old is not None and not os.access(target, os.W_OK):
        raise PermissionError(13, "the file is read-only")
    temporary = target.with_name(f".voronoi-tiles-{secrets.token_hex(8)}.tmp")
    # The mode is what a plain open() asks for: the system takes the umask off.
    descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    try:
        try:
            if old is not None:
                os.fchmod(descriptor, stat.S_IMODE(old.st_mode))
            _write_all(descriptor, data)
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
        temporary.replace(target)
    except BaseException:
        with suppress(OSError):
            temporary.unlink()
        raise
    _sync_folder(target.parent)


def _sync_folder(folder: Path) -> None:
    """Make the rename last; file systems that cannot sync a folder have still renamed."""
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def _write_special(target: Path, data: bytes) -> None:
    """Write to a device or a pipe, which a rename would replace; a folder is an error of the system's."""
    descriptor = os.open(target, os.O_WRONLY)
    try:
        _write_all(descriptor, data)
    finally:
        os.close(descriptor)


def _write_stdout(data: bytes) -> None:
    """Write to standard output without its buffer, so that a full disk shows here and not at exit."""
    try:
        sys.stdout.flush()
        try:
            descriptor = sys.stdout.fileno()
        except (AttributeError, OSError):  # standard output is an object in memory
            sys.stdout.write(data.decode())
            sys.stdout.flush()
        else:
            _write_all(descriptor, data)
    except (OSError, ValueError) as error:  # ValueError: it is closed
        raise output_error("standard output", error) from error


def _write_all(descriptor: int, data: bytes) -> None:
    """Write all bytes; one call to the system may take fewer."""
    rest = memoryview(data)
    while rest:
        rest = rest[os.write(descriptor, rest) :]
