"""Which Inkscape is on this machine, where it looks for a user's extensions, and which of them cannot start ours."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Final, NamedTuple

from voronoi_tiles.base.errors import ArgumentError

_WAIT_S: Final = 60.0
"""How long Inkscape may take to say where its folder is; seconds. The first start of one builds its caches."""

_ELSEWHERE: Final = (
    "/Applications/Inkscape.app/Contents/MacOS/inkscape",
    r"C:\Program Files\Inkscape\bin\inkscape.com",
)
"""Where installers put it that set no PATH."""

FLATPAK: Final = "org.inkscape.Inkscape"

_SNAP_NAME: Final = "the Inkscape of Snap"
_FLATPAK_NAME: Final = "the Inkscape of Flatpak"
"""What messages call the two that run in a sandbox."""

FLATPAK_HOMES: Final = ("/var/lib/flatpak/app", "~/.local/share/flatpak/app")
SNAP_HOMES: Final = ("/snap", "/var/lib/snapd/snap")
"""Where the two keep what is installed."""

SANDBOXED: Final = (
    "{} runs in a sandbox, in which it cannot start the Python that has voronoi-tiles. Install the one of your "
    "distribution (sudo apt install inkscape), or the AppImage of inkscape.org, and run this again"
)


class FoundInkscape(NamedTuple):
    """An Inkscape that can start us, None where only a user's folder of one is there, and its folder of extensions."""

    program: str | None
    extensions: Path

    @property
    def version(self) -> str:
        """What it calls itself: "Inkscape 1.2.2 (b0a8486541, 2022-12-01)"; "" where it does not say."""
        return "" if self.program is None else _said(self.program, "--version").partition("\n")[0]


def found_inkscape() -> FoundInkscape:
    """The Inkscape on the PATH, or where installers put it; or the folder that one has left, as an AppImage does.

    Raises ArgumentError where there is none, or one in a sandbox alone.
    """
    boxed = []
    for program in _programs():
        if not _is_snap(program):
            folder = _said(program, "--user-data-directory").strip()
            name = sandbox_of(Path(folder))  # a script may start one
            if folder and name is None:
                return FoundInkscape(program, Path(folder, "extensions"))
            boxed += [name] if name is not None else []
    usual = _usual_folder()
    if usual.is_dir():
        return FoundInkscape(None, usual / "extensions")
    there = list(dict.fromkeys((*boxed, *sandboxed())))
    if there:
        raise ArgumentError(SANDBOXED.format(" and ".join(there)), remedy=INTO)
    raise ArgumentError("no Inkscape is found", remedy=f"Install it (sudo apt install inkscape). {INTO}")


INTO: Final = "Or name its folder of extensions (Edit > Preferences > System: User extensions): `into=DIR`."
"""What to do where Inkscape is somewhere else."""


def sandbox_of(folder: Path) -> str | None:
    """The Inkscape in a sandbox that keeps its things in a folder, as people call it; None of other folders."""
    parts = folder.expanduser().absolute().parts
    if FLATPAK in parts:
        return _FLATPAK_NAME
    return _SNAP_NAME if ("snap", "inkscape") in pairwise(parts) else None


def sandboxed() -> list[str]:
    """The Inkscapes on this machine that run in a sandbox, as people call them."""
    snap = any(_is_snap(program) for program in _programs()) or any(
        Path(home, "inkscape").exists() for home in SNAP_HOMES
    )
    flatpak = any(Path(home, FLATPAK).expanduser().exists() for home in FLATPAK_HOMES)
    return [_SNAP_NAME] * snap + [_FLATPAK_NAME] * flatpak


def _programs() -> Iterator[str]:
    """The programs that may be Inkscape."""
    found = shutil.which("inkscape")
    if found is not None:
        yield found
    yield from (path for path in _ELSEWHERE if os.path.isfile(path))  # noqa: PTH113 - one is Windows' name


def _is_snap(program: str) -> bool:
    """Whether a program is Snap's: a link to the one that starts them all."""
    return "snap" in Path(program).parts or Path(os.path.realpath(program)).name == "snap"


def _said(program: str, option: str) -> str:
    """What a program prints, "" where it fails."""
    try:
        done = subprocess.run(
            [program, option], capture_output=True, text=True, check=True, timeout=_WAIT_S, stdin=subprocess.DEVNULL
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return done.stdout


def _usual_folder() -> Path:
    """The folder that Inkscape keeps a user's things in, where nobody says otherwise."""
    said = os.environ.get("INKSCAPE_PROFILE_DIR")
    if said:
        return Path(said)
    home = Path.home()
    if sys.platform == "darwin":
        return home / "Library/Application Support/org.inkscape.Inkscape/config/inkscape"
    if sys.platform == "win32":
        return Path(os.environ.get("APPDATA", home), "inkscape")
    return Path(os.environ.get("XDG_CONFIG_HOME") or home / ".config", "inkscape")
