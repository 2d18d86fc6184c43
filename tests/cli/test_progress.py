"""What is shown on a terminal while a command works, and nowhere else."""

from __future__ import annotations

import io
import sys
import time

import pytest

from voronoi_tiles.cli import progress_bar
from voronoi_tiles.cli.common import say


class Screen(io.StringIO):
    """Standard error that is a terminal, or says so."""

    def __init__(self, *, terminal: bool) -> None:
        super().__init__()
        self.terminal = terminal

    def isatty(self) -> bool:
        """Whether it is one."""
        return self.terminal


def shown(monkeypatch: pytest.MonkeyPatch, *, terminal: bool, quiet: bool, patience: float = 0.05) -> str:
    """What is written while something takes half a second, in the middle of which a message is said."""
    screen = Screen(terminal=terminal)
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(progress_bar, "_PATIENCE", patience)
    with progress_bar.waiting("solids", quiet=quiet):
        time.sleep(0.25)
        say("a message")
        time.sleep(0.25)
    return screen.getvalue()


def test_a_terminal_shows_what_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the time; what is said in between is there, too."""
    text = shown(monkeypatch, terminal=True, quiet=False)
    assert "solids" in text
    assert "0:00:00" in text
    assert "a message" in text


@pytest.mark.parametrize(
    ("terminal", "quiet", "patience"), [(False, False, 0.05), (True, True, 0.05), (True, False, 9)]
)
def test_nothing_else_does(monkeypatch: pytest.MonkeyPatch, *, terminal: bool, quiet: bool, patience: float) -> None:
    """No file, nobody who wants quiet, and nothing that is soon done."""
    assert shown(monkeypatch, terminal=terminal, quiet=quiet, patience=patience) == "a message\n"


def fail() -> None:
    """Go wrong after a while."""
    with progress_bar.waiting("solids", quiet=False):
        time.sleep(0.2)
        raise ValueError("it went wrong")


def test_it_ends_with_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """The terminal is as it was: the cursor is shown again."""
    screen = Screen(terminal=True)
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(progress_bar, "_PATIENCE", 0.0)
    with pytest.raises(ValueError, match="it went wrong"):
        fail()
    assert sys.stderr is screen
    hidden, shown_again = screen.getvalue().rfind("\x1b[?25l"), screen.getvalue().rfind("\x1b[?25h")
    assert 0 <= hidden < shown_again
