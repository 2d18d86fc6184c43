"""Writing results, at once or as a stream: a file is written whole or not at all, and `-` is standard output."""

from __future__ import annotations

import errno
import io
import os
import re
import stat
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from voronoi_tiles.base.errors import OutputError, why_not_opened

if TYPE_CHECKING:
    from _typeshed import ReadableBuffer

STDOUT = "-"

_STDOUTS = {STDOUT, "/dev/stdout"}
_PIECE = 2**20  # bytes that are copied at a time

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
    with _reporting(_label(name)):
        replaced = _is_replaced(name)
        if not replaced:
            _send(name, (data,))
    if replaced:
        with writing(name) as file:
            file.write(data)


@contextmanager
def writing(path: str | os.PathLike[str]) -> Iterator[io.RawIOBase]:
    """A binary file to write, in any number of portions, that is as whole as one of `write_whole`.

    The file takes its place when the block ends, and is gone when an exception leaves it. What goes to standard output,
    a device or a pipe is kept in a temporary file until then, so that nothing half done is sent. Each write takes all
    that it is given, straight to the system, without a buffer.

    Raises OutputError: at the beginning for a place that cannot be written, in the block for a write that fails, at
    its end when the file cannot take its place or a write had failed. Exceptions of the block's own stay as they are.
    """
    name = os.fspath(path)
    with _reporting(_label(name)):
        output = _Replacement(name) if _is_replaced(name) else _Spool(name)
    try:
        with _Writer(output.descriptor, output.label) as file:
            yield file
            file.check()
        with _reporting(_label(name)):
            output.commit()
    except BaseException:
        output.discard()
        raise


def require_suffix(path: str | os.PathLike[str], suffixes: tuple[str, ...]) -> None:
    """Raise OutputError where a file's name has none of the suffixes, but for standard output and devices."""
    name = os.fspath(path)
    if name != STDOUT and not is_special(name) and not str(name).lower().endswith(suffixes):
        wanted = " or ".join(suffixes)
        raise OutputError(
            f"cannot write {name!r}: it is no {wanted} file", path=path, remedy=f"Give it the suffix {wanted}."
        )


def output_error(path: str, error: Exception) -> OutputError:
    """Say why a file could not be written, and what to do."""
    remedy = _REMEDIES.get(error.errno) if isinstance(error, OSError) and error.errno is not None else None
    return OutputError(
        f"cannot write {path or repr(path)}: {why_not_opened(path, error)}",
        path=path,
        remedy=remedy or "Choose another name or place.",
    )


def refuse_existing(path: str | os.PathLike[str]) -> None:
    """Refuse to overwrite a file that people work on. Raises OutputError."""
    name = os.fspath(path)
    if name != STDOUT and not is_special(name) and os.path.lexists(name):
        raise OutputError(f"{name} exists already", path=name, remedy="Choose another name, or remove it first.")


def refuse_overwriting(targets: Iterable[str], read: Iterable[str]) -> None:
    """Refuse to write over what is read. Raises OutputError."""
    with suppress(ValueError):  # a null byte in a name: no such file is read, and none is written
        known = {os.path.realpath(name) for name in read}
        for target in targets:
            if target != STDOUT and os.path.realpath(target) in known:
                raise OutputError(
                    f"{target} is read for this, and would be overwritten", path=target, remedy="Choose another name."
                )


def is_special(name: str) -> bool:
    """Whether a file is a device, a pipe or an open descriptor, which writing does not replace."""
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
    """The open descriptor that a name stands for, None for other files."""
    numbered = _DESCRIPTOR.fullmatch(name)
    return int(numbered[1]) if numbered else _DESCRIPTORS.get(name)


def _status(name: str) -> os.stat_result | None:
    """The status of a file, None when there is none."""
    try:
        return os.stat(name)  # noqa: PTH116 - Path takes an empty name for the folder
    except FileNotFoundError:
        return None


def _target(name: str) -> Path:
    """The file that a name leads to through symbolic links."""
    if not name:
        raise ValueError("the name is empty")
    return Path(os.path.realpath(name))


def _is_replaced(name: str) -> bool:
    """Whether a file is written beside its place and renamed, as plain and new files are."""
    if name in _STDOUTS or _descriptor(name) is not None:
        return False
    old = _status(name)
    return old is None or stat.S_ISREG(old.st_mode)


def _label(name: str) -> str:
    """What messages call a file."""
    return "standard output" if name in _STDOUTS else name


@contextmanager
def _reporting(label: str) -> Iterator[None]:
    """Turn the system's errors into OutputErrors."""
    try:
        yield
    except OutputError:
        raise
    except (OSError, ValueError) as error:  # ValueError: a null byte in the name, a standard output that is closed
        raise output_error(label, error) from error


class _Writer(io.RawIOBase):
    """Writes to a descriptor, which it leaves open."""

    def __init__(self, descriptor: int, label: str) -> None:
        super().__init__()
        self._descriptor = descriptor
        self._label = label
        self._failure: OutputError | None = None

    def writable(self) -> bool:
        return True

    def write(self, data: ReadableBuffer, /) -> int:
        """Write all bytes, and give their number."""
        if self.closed:
            raise ValueError("the file is closed")
        self.check()
        try:
            return _write_all(self._descriptor, data)
        except OSError as error:
            self._failure = output_error(self._label, error)
            raise self._failure from error

    def check(self) -> None:
        """Raise the OutputError of a write that did not succeed, which the caller may have caught."""
        if self._failure is not None:
            raise self._failure


class _Replacement:
    """A temporary file beside a plain or new file: `commit` renames it over that, `discard` removes it."""

    def __init__(self, name: str) -> None:
        self.label = name
        self._target = _target(name)
        old = _status(name)
        if old is not None and not os.access(self._target, os.W_OK):
            raise PermissionError(13, "the file is read-only")
        self._temporary = self._target.with_name(f".voronoi-tiles-{os.urandom(8).hex()}.tmp")
        # The mode is what a plain open() asks for: the system takes the umask off.
        self.descriptor = os.open(self._temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
        try:
            if old is not None:
                os.fchmod(self.descriptor, stat.S_IMODE(old.st_mode))
        except BaseException:
            self.discard()
            raise

    def commit(self) -> None:
        """Put the file into its place."""
        os.fsync(self.descriptor)
        self._close()
        self._temporary.replace(self._target)
        _sync_folder(self._target.parent)

    def discard(self) -> None:
        """Leave nothing behind; the old file was never touched."""
        with suppress(OSError):
            self._close()
        with suppress(OSError):
            self._temporary.unlink()

    def _close(self) -> None:
        """Close the descriptor, once: its number may soon be another file's."""
        descriptor, self.descriptor = self.descriptor, -1
        os.close(descriptor)


class _Spool:
    """An anonymous temporary file for what no rename replaces: `commit` copies it there, `discard` drops it."""

    def __init__(self, name: str) -> None:
        import tempfile

        _check(name)
        with _reporting("a temporary file"):
            self._file = tempfile.TemporaryFile(buffering=0)  # noqa: SIM115 - commit and discard close it
            self.label = f"a temporary file in {tempfile.gettempdir()}"
        self._name = name
        self.descriptor = self._file.fileno()

    def commit(self) -> None:
        """Send all that was written."""
        with self._file as file:
            file.seek(0)
            _send(self._name, iter(lambda: file.read(_PIECE), b""))

    def discard(self) -> None:
        """Send nothing."""
        self._file.close()


def _sync_folder(folder: Path) -> None:
    """Make the rename last; file systems that cannot sync a folder have still renamed."""
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def _check(name: str) -> None:
    """Raise what `_send` would, where that can be seen before there is anything to send."""
    descriptor = _descriptor(name)
    if name in _STDOUTS:
        if sys.stdout is None:
            raise OSError(errno.EBADF, "it is closed")
    elif descriptor is not None:
        os.fstat(descriptor)
    elif os.path.isdir(name):  # noqa: PTH112 - Path takes an empty name for the folder
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))


def _send(name: str, pieces: Iterable[bytes]) -> None:
    """Write to standard output, an open descriptor, a device or a pipe; a folder is an error of the system's."""
    if name in _STDOUTS:
        _send_to_stdout(pieces)
        return
    descriptor = _descriptor(name)
    if descriptor is not None:
        _write_pieces(descriptor, pieces)
        return
    opened = os.open(name, os.O_WRONLY)
    try:
        _write_pieces(opened, pieces)
    finally:
        os.close(opened)


def _send_to_stdout(pieces: Iterable[bytes]) -> None:
    """Write to standard output without its buffer, so that a full disk shows here and not at exit."""
    if sys.stdout is None:
        raise OSError(errno.EBADF, "it is closed")
    sys.stdout.flush()
    try:
        descriptor = sys.stdout.fileno()
    except (AttributeError, OSError):  # standard output is an object in memory
        data = b"".join(pieces)
        buffer = getattr(sys.stdout, "buffer", None)
        if buffer is None:
            sys.stdout.write(data.decode())
        else:
            buffer.write(data)
        sys.stdout.flush()
    else:
        _write_pieces(descriptor, pieces)


def _write_pieces(descriptor: int, pieces: Iterable[bytes]) -> None:
    """Write all pieces."""
    for piece in pieces:
        _write_all(descriptor, piece)


def _write_all(descriptor: int, data: ReadableBuffer) -> int:
    """Write all bytes, and give their number; one call to the system may take fewer."""
    view = memoryview(data)
    if view.nbytes:  # an empty array's view cannot be cast
        rest = view.cast("B")
        while rest:
            rest = rest[os.write(descriptor, rest) :]
    return view.nbytes
