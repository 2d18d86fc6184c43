"""Blender as a Python module in an environment of its own, and the extension that it is given."""

from __future__ import annotations

import fcntl
import json
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final, NoReturn

import pytest

ROOT: Final = Path(__file__).parents[2]

PROGRAMS: Final = ROOT / "tests" / "blender" / "programs"

OWN: Final = ROOT / "tests" / "readers" / ".venv-blender" / "bin" / "python"
"""The Python of the environment that `make blender-programs` makes; VORONOI_TILES_BLENDER in the environment names
another with Blender in it."""

PLATFORM: Final = "linux-x64"


def missing(reason: str) -> NoReturn:
    """Leave a test out, with the reason; VORONOI_TILES_REQUIRE_BLENDER=1 makes it fail."""
    if os.environ.get("VORONOI_TILES_REQUIRE_BLENDER") == "1":
        pytest.fail(reason)
    pytest.skip(reason)


@cache
def blender_python() -> Path:
    """The Python that has Blender; leaves the test out where there is none."""
    found = Path(os.environ.get("VORONOI_TILES_BLENDER", OWN))
    if not found.exists():
        missing(f"no Blender: {found} is not there, `make blender-programs` installs it")
    return found


@dataclass(frozen=True)
class Extension:
    """The extension's file, and a folder in which each program has its own."""

    file: Path
    folder: Path

    def run(self, program: str, *arguments: str, name: str = "") -> tuple[dict[str, Any], Path]:
        """What a program of PROGRAMS finds that installs the extension, and the folder it had for itself."""
        own = self.folder / (name or program)
        own.mkdir()
        command = [str(blender_python()), str(PROGRAMS / f"{program}.py"), str(self.file), str(own), *arguments]
        environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=600)
        assert done.returncode == 0, done.stdout + done.stderr
        found: dict[str, Any] = json.loads((own / "found.json").read_text())
        return found, own


def make_extension(shared: Path, own: Path) -> Extension:
    """The extension of the checkout, made once for all processes that run tests and share a folder."""
    blender_python()
    with (shared / "extension.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        target = shared / "extension"
        if not target.exists():
            target.mkdir()
            _make(target)
        files = [*target.glob("*.zip")]
    if len(files) != 1:
        missing("the extension could not be made: see the first test that failed")
    return Extension(files[0], own)


def _make(target: Path) -> None:
    """Build our wheel of a copy of the sources, and the extension for this platform.

    The kernels are those of the checkout, which the build leaves as they are where they are of these sources.
    """
    source, built = target / "source", target / "source" / "built"
    for folder in ("voronoi_tiles", "vector", "raster"):
        shutil.copytree(ROOT / folder, source / folder, ignore=shutil.ignore_patterns("__pycache__", "kernels.*.*"))
    for file in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / file, source / file)
    (source / "setup.cfg").write_text(f"[build]\nbuild_lib = {built}\n")
    for library in (ROOT / "voronoi_tiles" / "base").glob("kernels.compiled.*"):
        place = built / library.relative_to(ROOT)
        place.parent.mkdir(parents=True)
        shutil.copy(library, place)
    options = ["--quiet", "--no-deps", "--no-build-isolation"]
    for command in (
        ["-m", "pip", "wheel", *options, "--wheel-dir", str(target), str(source)],
        [str(ROOT / "blender" / "build.py"), PLATFORM, "--wheels", str(target), "--output", str(target)],
    ):
        environment = os.environ | {"VORONOI_TILES_TARGET": "linux-x86_64"}
        done = subprocess.run([sys.executable, *command], env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
