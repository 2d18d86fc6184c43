"""Writing results: a file is written whole or not at all, and `-` is standard output."""

from __future__ import annotations

import errno
import os
import re
import secrets
import stat
import sys
from contextlib import suppress
from pathlib import Path

from voronoi_tiles.errors import OutputError

STDOUT = "-"

# What the system and the shell, by >(command), call a descriptor that is open already.
_DESCRIPTOR = re.compile(r"/(?:dev|proc/self)/fd/(\d{1,6})")
_DESCRIPTORS = {"/dev/stderr": 2}

_ROOM = "Make room, or write to another disk."
_PERMISSIONS = "Choose another place, or change its permissions."
_REMEDIES = {
    errno.ENOENT: "Make its folder first, or choose another.",
    errno.ENOTDIR: "A part of its path is a file: choose another folder.",
    errno.EISDIR: "Name a file, not a folder.",
    errno.EEXIST: "Choose another name.",
    errno.EACCES: _PERMISSIONS,
    errno.EPERM: _PERMISSIONS,
    errno.EROFS: _PERMISSIONS,
    errno.ENOSPC: _ROOM,
    errno.EDQUOT: _ROOM,
    errno.EFBIG: _ROOM,
    errno.ENAMETOOLONG: "Choose a shorter name.",
    errno.EBADF: "Send it to a file or a pipe that is open.",
}


def write_whole(path: str | os.PathLike[str], data: bytes) -> None:
    """Write a file whole or not at all: into a temporary file beside it, synced, then renamed over it.

    An existing file keeps its permissions, and stays untouched when anything fails; a symbolic link stays a link.
    `-` is standard output; devices and pipes are written directly. Raises OutputError.
    """
    name = os.fspath(path)
    if name in {STDOUT, "/dev/stdout"}:
        _write_stdout(data)
        return
    try:
        descriptor = _descriptor(name)
        old = _status(name)
        if descriptor is not None:
            _write_all(descriptor, data)
        elif old is None or stat.S_ISREG(old.st_mode):
            _replace(_target(name), data, old)
        else:
            _write_special(name, data)
    except (OSError, ValueError) as error:  # ValueError: a null byte in the name
        raise output_error(name, error) from error


def output_error(path: str, error: Exception) -> OutputError:
    """Say why a file could not be written, and what to do."""
    reason, remedy = str(error), None
    if isinstance(error, OSError) and error.errno is not None:
        reason, remedy = error.strerror or reason, _REMEDIES.get(error.errno)
    return OutputError(
        f"cannot write {path or repr(path)}: {reason}", path=path, remedy=remedy or "Choose another name or place."
    )


def is_special(name: str) -> bool:
    """Tell whether a file is a device, a pipe or an open descriptor, which writing does not replace."""
    try:
        old = _status(name)
    except (OSError, ValueError):
        return False
    return old is not None and (
        name == "/dev/stdout"
        or _descriptor(name) is not None
        or not (stat.S_ISREG(old.st_mode) or stat.S_ISDIR(old.st_mode))
    )


def _descriptor(name: str) -> int | None:
    """Give the open descriptor that a name stands for, None for other files."""
    numbered = _DESCRIPTOR.fullmatch(name)
    return int(numbered[1]) if numbered else _DESCRIPTORS.get(name)


def _status(name: str) -> os.stat_result | None:
    """Give the status of a file, None when there is none."""
    try:
        return os.stat(name)  # noqa: PTH116 - Path takes an empty name for the folder
    except FileNotFoundError:
        return None


def _target(name: str) -> Path:
    """Give the file that a name leads to through symbolic links."""
    if not name:
        raise ValueError("the name is empty")
    return Path(os.path.realpath(name))


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


def _write_special(name: str, data: bytes) -> None:
    """Write to a device or a pipe, which a rename would replace; a folder is an error of the system's."""
    descriptor = os.open(name, os.O_WRONLY)
    try:
        _write_all(descriptor, data)
    finally:
        os.close(descriptor)


def _write_stdout(data: bytes) -> None:
    """Write to standard output without its buffer, so that a full disk shows here and not at exit."""
    try:
        if sys.stdout is None:
            raise OSError(errno.EBADF, "it is closed")  # noqa: TRY301 - one handler says it all
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
