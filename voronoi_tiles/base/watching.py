"""Noticing that files were saved, by looking at them again and again.

The system's own notices would be sooner, but network folders, containers and some editors' ways of saving send none,
or send them for a file that is not there any more; to look at ten files ten times a second costs nothing to speak of.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable

INTERVAL = 0.1
"""How often files are looked at; seconds."""

SETTLED = 0.2
"""For how long files must stay as they are before they count as saved; seconds."""

PATIENCE = 1.0
"""The same for files that are gone or empty, as they are while an editor saves them; seconds."""

_LONGEST = 10.0
"""For how long to wait for files that do not settle at all; seconds."""

_State = tuple[int, int, int] | None


class FileWatch:
    """Waits until one of some files is saved: written, replaced by renaming, removed or made.

    `sleep` and `clock` are those of the system; tests have their own.
    """

    def __init__(
        self, sleep: Callable[[float], object] = time.sleep, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._sleep, self._clock = sleep, clock
        self._paths: tuple[str, ...] = ()
        self._seen: tuple[_State, ...] = ()

    def follow(self, paths: Iterable[str]) -> None:
        """Watch these files from now on, and no others: what is read of them after this is not missed when it changes.

        Those that were watched already are compared with what they were at the end of `wait`.
        """
        known = dict(zip(self._paths, self._seen, strict=True))
        self._paths = tuple(dict.fromkeys(paths))
        self._seen = tuple(known[path] if path in known else _state(path) for path in self._paths)

    def wait(self) -> None:
        """Return when a file has been saved, as soon as all have settled."""
        while (state := self._look()) == self._seen:
            self._sleep(INTERVAL)
        begun = since = self._clock()
        while self._clock() - since < (SETTLED if all(map(_is_whole, state)) else PATIENCE):
            self._sleep(INTERVAL)
            now = self._look()
            if now != state:
                state, since = now, self._clock()
            if self._clock() - begun > _LONGEST:
                break
        self._seen = state

    def _look(self) -> tuple[_State, ...]:
        return tuple(map(_state, self._paths))


def _state(path: str) -> _State:
    """What changes when a file is saved: its time, its size, which file it is; None where there is none."""
    try:
        status = os.stat(path)  # noqa: PTH116 - any name
    except (OSError, ValueError):
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino


def _is_whole(state: _State) -> bool:
    """Whether a file is there, and not empty."""
    return state is not None and state[1] > 0
