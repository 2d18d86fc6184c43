"""Copies of work that is not saved yet, to find it again after a crash; and who has a file open.

They are kept in a folder of the user's own (XDG_STATE_HOME), not beside the design: there the copy can be written when
the design's folder is read-only, nobody else can put a link or another design in its place, and no folder that is
shared, synchronised or under version control fills with them. The price is that they are found by the design's path: a
file that is moved while its studio is dead has lost its copy.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import sys
import time
from collections.abc import Mapping
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, NamedTuple

from voronoi_tiles.base.errors import OutputError
from voronoi_tiles.base.files import write_whole

if sys.platform != "win32":
    import fcntl


class RecoveryCopy(NamedTuple):
    """A copy that was found: the design in its JSON form, and when it was written, in seconds since 1970.

    `of` is when the file had been written by then, in nanoseconds since 1970; None where there was none.
    """

    design: Mapping[str, Any]
    at: float
    of: int | None

    @property
    def when(self) -> str:
        """When it was written, as ISO 8601 says it, in UTC."""
        return datetime.fromtimestamp(self.at, UTC).isoformat(timespec="seconds")


def state_folder() -> Path:
    """The folder of the studio's own files; it need not be there."""
    home = os.environ.get("XDG_STATE_HOME", "")
    base = Path(home) if os.path.isabs(home) else Path("~/.local/state").expanduser()  # noqa: PTH117 - as XDG says
    return base / "voronoi-tiles" / "studio"


class Recovery:
    """The recovery copies of one file, and the lock that says that a studio has it open.

    `holder` says which other studio has it, "" where none has; `trouble` why no copies can be kept, "" where they can.
    """

    def __init__(self, path: str) -> None:
        real = os.path.realpath(path)
        stem = re.sub(r"[^\w.-]", "_", Path(real).stem)[:40]
        self._name = f"{stem}-{hashlib.sha256(os.fsencode(real)).hexdigest()[:16]}"
        self._path = real
        self._lock = -1
        self._number = 0
        self.holder = ""
        self.trouble = ""
        try:
            self._folder = state_folder()
            self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            self._acquire()
        except (OSError, RuntimeError) as error:  # RuntimeError: nobody knows where home is
            self.trouble = str(getattr(error, "strerror", None) or error)
        self._current: Path | None = None

    def write(self, design: Mapping[str, Any], of: int | None) -> None:
        """Write the copy of this session anew, whole or not at all; `of` is that of the copy. Raises OutputError."""
        if self.trouble:
            return
        if self._current is None:
            self._number += 1
            stamp = f"{time.time_ns():020d}-{os.getpid()}-{self._number}"
            self._current = self._folder / f"{self._name}-{stamp}.json"
        copy = {"file": self._path, "at": time.time(), "of": of, "design": design}
        try:
            with suppress(OSError):  # it may have been cleared away; what cannot be made cannot be written to
                self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            write_whole(self._current, json.dumps(copy).encode())
        except OutputError as error:
            raise OutputError(
                f"the recovery copy cannot be written: {error.message}",
                error.path,
                remedy=f"{error.remedy} Save the design until then.",
            ) from error

    def drop(self) -> None:
        """Remove the copy of this session, as what it holds is saved."""
        if self._current is not None:
            with suppress(OSError):
                self._current.unlink()
            self._current = None

    def found(self) -> list[RecoveryCopy]:
        """All copies of the file, the newest first; from now on the session writes another one.

        There are none where another studio has the file open, still: they may be its own.
        """
        self._current = None
        if self.holder:
            self.holder = ""
            with suppress(OSError):
                self._acquire()
        copies = []
        for path in self._copies():
            with suppress(OSError, ArithmeticError, ValueError, LookupError, TypeError, RecursionError):
                copy = json.loads(path.read_bytes())
                found = RecoveryCopy(copy["design"], float(copy["at"]), copy.get("of"))
                if isinstance(found.design, dict) and found.when:
                    copies.append(found)
        return sorted(copies, key=lambda copy: copy.at, reverse=True)

    def forget(self) -> None:
        """Remove all copies of the file, as it is saved."""
        self.drop()
        for path in self._copies():
            with suppress(OSError):
                path.unlink()

    def close(self) -> None:
        """Let others have the file; what was copied stays."""
        if self._lock >= 0:
            with suppress(OSError):
                self._lock_path.unlink()
            os.close(self._lock)
            self._lock = -1

    @property
    def _lock_path(self) -> Path:
        return self._folder / f"{self._name}.lock"

    def _copies(self) -> list[Path]:
        """The files of all copies, but for those of another studio that has the file open."""
        if self.trouble or self.holder:
            return []
        pattern = re.compile(re.escape(self._name) + r"-[0-9-]+\.json")
        try:
            return [path for path in self._folder.iterdir() if pattern.fullmatch(path.name)]
        except OSError:  # the folder was removed
            return []

    def _acquire(self) -> None:
        """Take the lock, or find out who has it; the system lets it go when we end, however that is."""
        if sys.platform == "win32":
            return
        while True:
            lock = os.open(self._lock_path, os.O_RDWR | os.O_CREAT, 0o600)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                self.holder = os.read(lock, 200).decode(errors="replace") or "another studio"
                os.close(lock)
                return
            except OSError:  # a file system without locks
                os.close(lock)
                return
            with suppress(FileNotFoundError):
                if os.path.samestat(os.fstat(lock), self._lock_path.stat()):
                    break
            os.close(lock)  # who had it has removed it just now
        now = datetime.now().astimezone().isoformat(sep=" ", timespec="minutes")
        os.ftruncate(lock, 0)
        os.write(lock, f"process {os.getpid()}, since {now[:16]}".encode())
        self._lock = lock
