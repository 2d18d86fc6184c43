"""The wheel: one top-level package, and everything in it."""

from __future__ import annotations

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HOMES = {"voronoi_tiles": "voronoi_tiles", "vector": "voronoi_tiles/vector", "raster": "voronoi_tiles/raster"}


def expected() -> set[str]:
    """The files that the source folders hold, by their place in the wheel."""
    return {
        f"{home}/{path.relative_to(ROOT / folder).as_posix()}"
        for folder, home in HOMES.items()
        for path in (ROOT / folder).rglob("*")
        if path.suffix in {".py", ".glsl", ".toml"} or path.name == "py.typed"
    }


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    """Build the wheel from a copy of the sources, so that no build folder of the checkout gets into it."""
    source = tmp_path_factory.mktemp("source")
    for folder in HOMES:
        shutil.copytree(
            ROOT / folder, source / folder, ignore=shutil.ignore_patterns("__pycache__", "kernels.compiled.*")
        )
    for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source / name)
    target = tmp_path_factory.mktemp("wheel")
    command = ["-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir"]
    subprocess.run([sys.executable, *command, str(target), str(source)], check=True, timeout=300)
    (file,) = target.glob("*.whl")
    with zipfile.ZipFile(file) as archive:
        return set(archive.namelist())


def test_the_only_top_level_package_is_ours(wheel: set[str]) -> None:
    """`vector` and `raster` belong to others: installing over them would break those."""
    tops = {name.split("/")[0] for name in wheel}
    assert {top for top in tops if not top.endswith(".dist-info")} == {"voronoi_tiles"}


def test_every_source_file_is_inside(wheel: set[str]) -> None:
    """A package that pyproject.toml does not list would be missing."""
    packaged = {name for name in wheel if name.startswith("voronoi_tiles/")}
    assert packaged == expected()
    assert {"voronoi_tiles/py.typed", "voronoi_tiles/vector/outline.py", "voronoi_tiles/raster/__init__.py"} <= packaged


def test_the_licence_and_the_command_are_inside(wheel: set[str]) -> None:
    """What a distribution owes its users."""
    assert any(name.endswith("licenses/LICENSE") for name in wheel)
    assert any(name.endswith("entry_points.txt") for name in wheel)
