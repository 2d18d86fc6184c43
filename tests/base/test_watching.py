"""Watching files: in whatever way they are saved it is noticed, once they are whole, and nothing is missed."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import pytest

from voronoi_tiles.base.watching import PATIENCE, SETTLED, FileWatch


class Clock:
    """A time that passes while one sleeps, at which things happen; what is beyond its end is no longer slept."""

    def __init__(self, events: Sequence[tuple[float, Callable[[], object]]]) -> None:
        self.now = 0.0
        self.events = sorted(events, key=lambda event: event[0])

    def sleep(self, seconds: float) -> None:
        """Let time pass."""
        self.now += seconds
        assert self.now < 100, "nothing was noticed"
        while self.events and self.events[0][0] <= self.now:
            self.events.pop(0)[1]()

    def watch(self, *paths: Path) -> FileWatch:
        """A watch of files."""
        watch = FileWatch(self.sleep, lambda: self.now)
        watch.follow(map(str, paths))
        return watch


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A file that is there."""
    file = tmp_path / "a.toml"
    file.write_text("one")
    os.utime(file, (1e9, 1e9))
    return file


def renamed(path: Path, text: str) -> None:
    """Save as many editors do: a new file takes the place of the old one, here with its time and size as well."""
    new = path.with_suffix(".new")
    new.write_text(text)
    os.utime(new, (1e9, 1e9))
    new.replace(path)


def lengthened(path: Path) -> None:
    """Write more, and keep the time."""
    path.write_text("three")
    os.utime(path, (1e9, 1e9))


WAYS: dict[str, Callable[[Path], object]] = {
    "written": lambda path: path.write_text("two"),
    "longer": lengthened,
    "renamed": lambda path: renamed(path, "two"),
    "removed": lambda path: path.unlink(),
    "touched": lambda path: os.utime(path, (2e9, 2e9)),
}


@pytest.mark.parametrize("way", WAYS)
def test_a_saved_file_is_noticed(way: str, path: Path) -> None:
    """Soon after it was saved, not before; then the next time is waited for."""
    clock = Clock([(3.0, lambda: WAYS[way](path)), (30.0, lambda: path.write_text("next"))])
    watch = clock.watch(path)
    watch.wait()
    assert 3.0 + SETTLED <= clock.now < 3.5 + PATIENCE
    watch.wait()
    assert 30.0 < clock.now < 31.0


def test_a_file_that_is_half_written_is_waited_for(path: Path) -> None:
    """Emptied, then written in portions, or removed and made anew: one notice, when all is there."""
    portions = [(1.0 + 0.15 * k, lambda k=k: path.write_text("two" * k)) for k in range(6)]
    clock = Clock([*portions, (5.0, path.unlink), (5.6, lambda: path.write_text("three"))])
    watch = clock.watch(path)
    watch.wait()
    assert path.read_text() == "two" * 5
    assert clock.now < 2.5
    watch.wait()
    assert path.read_text() == "three"
    assert 5.6 < clock.now < 6.5


def test_what_is_saved_while_one_works_is_not_missed(path: Path) -> None:
    """What changes between two waits ends the next one; also for a file that was not there, and one that joins."""
    clock = Clock([])
    other, third = path.with_name("other.svg"), path.with_name("third.svg")
    watch = clock.watch(path, other)
    path.write_text("two")
    watch.wait()
    other.write_text("new")
    watch.wait()
    watch.follow([str(path), str(other), str(third)])
    third.write_text("new")
    watch.wait()
    clock.events = [(clock.now + 5.0, lambda: path.write_text("three"))]
    watch.follow([str(path)])
    other.write_text("no longer watched")
    watch.wait()
    assert path.read_text() == "three"


def test_a_file_that_never_settles_is_no_reason_to_wait_forever(path: Path) -> None:
    """Something may write to it again and again."""
    clock = Clock([(0.1 * k, partial(path.write_text, "x" * k)) for k in range(900)])
    clock.watch(path).wait()
    assert clock.now < 20
