"""What a release is made of: the source distribution, and wheels that hold everything, with or without the kernels."""

from __future__ import annotations

import os
import shutil
import struct
import subprocess
import sys
import venv
import zipfile
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[2]
HOMES = {"voronoi_tiles": "voronoi_tiles", "vector": "voronoi_tiles/vector", "raster": "voronoi_tiles/raster"}
NO_ZIG = "import sys\nsys.exit('this zig compiles nothing')\n"


def sources(*suffixes: str) -> set[str]:
    """The files of some kinds that the source folders hold, and py.typed, by their place in the wheel."""
    return {
        f"{home}/{path.relative_to(ROOT / folder).as_posix()}"
        for folder, home in HOMES.items()
        for path in (ROOT / folder).rglob("*")
        if path.suffix in suffixes or path.name == "py.typed"
    }


PACKAGED = (".py", ".glsl", ".toml", ".html", ".css", ".js", ".svg")
"""The suffixes of the sources."""


class Wheel(NamedTuple):
    """A wheel: its file, the names in it, and what pip said while it was built."""

    file: Path
    names: set[str]
    said: str

    @property
    def tags(self) -> str:
        """The Python, ABI and platform in the file's name, which must be those within."""
        (name,) = (name for name in self.names if name.endswith(".dist-info/WHEEL"))
        with zipfile.ZipFile(self.file) as archive:
            lines = archive.read(name).decode().splitlines()
        tags = self.file.stem.split("-", 2)[2]
        assert f"Tag: {tags}" in lines
        return tags

    def library(self) -> tuple[str, bytes]:
        """The suffix and the content of the compiled kernels."""
        (name,) = self.names - sources(*PACKAGED) - {n for n in self.names if ".dist-info/" in n}
        assert name.startswith("voronoi_tiles/base/kernels.compiled.")
        with zipfile.ZipFile(self.file) as archive:
            return Path(name).suffix, archive.read(name)


def build(source: Path, target: Path, *options: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Build a wheel, whether it succeeds or not."""
    inherited = {name: value for name, value in os.environ.items() if not name.startswith("VORONOI_TILES_")}
    command = [sys.executable, "-m", "pip", "wheel", "--verbose", "--no-deps", *options, "--wheel-dir"]
    return subprocess.run(
        [*command, str(target), str(source)],
        env=inherited | environment,
        check=False,
        capture_output=True,
        text=True,
        timeout=600,
    )


def built(source: Path, target: Path, *options: str, **environment: str) -> Wheel:
    """Build a wheel."""
    result = build(source, target, *options, **environment)
    assert result.returncode == 0, result.stdout + result.stderr
    (file,) = target.glob("*.whl")
    with zipfile.ZipFile(file) as archive:
        return Wheel(file, set(archive.namelist()), result.stdout + result.stderr)


@pytest.fixture(scope="module")
def sdist(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The source distribution, of a copy of the sources, so that no build folder of the checkout gets into it."""
    source = tmp_path_factory.mktemp("source")
    for folder in HOMES:
        ignored = shutil.ignore_patterns("__pycache__", "kernels.compiled.*")
        shutil.copytree(ROOT / folder, source / folder, ignore=ignored)
    for name in ("pyproject.toml", "setup.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source / name)
    script = "from setuptools.build_meta import build_sdist; build_sdist('dist')"
    subprocess.run([sys.executable, "-c", script], cwd=source, check=True, capture_output=True, timeout=300)
    (file,) = (source / "dist").glob("*.tar.gz")
    return file


@pytest.fixture(scope="module")
def no_zig(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """An environment whose compiler fails."""
    folder = tmp_path_factory.mktemp("no zig")
    (folder / "ziglang.py").write_text(NO_ZIG)
    return {"PYTHONPATH": str(folder)}


@pytest.fixture(scope="module")
def wheel(sdist: Path, no_zig: dict[str, str], tmp_path_factory: pytest.TempPathFactory) -> Wheel:
    """The wheel that is built where the kernels cannot be compiled."""
    return built(sdist, tmp_path_factory.mktemp("wheel"), "--no-build-isolation", **no_zig)


def test_the_only_top_level_package_is_ours(wheel: Wheel) -> None:
    """`vector` and `raster` belong to others: installing over them would break those."""
    tops = {name.split("/")[0] for name in wheel.names}
    assert {top for top in tops if not top.endswith(".dist-info")} == {"voronoi_tiles"}


def test_every_source_file_is_inside(wheel: Wheel) -> None:
    """A package that pyproject.toml does not list would be missing."""
    packaged = {name for name in wheel.names if name.startswith("voronoi_tiles/")}
    assert packaged == sources(*PACKAGED)
    assert {"voronoi_tiles/py.typed", "voronoi_tiles/vector/outline.py", "voronoi_tiles/raster/__init__.py"} <= packaged


def test_the_licence_and_the_command_are_inside(wheel: Wheel) -> None:
    """What a distribution owes its users."""
    assert any(name.endswith("licenses/LICENSE") for name in wheel.names)
    assert any(name.endswith("entry_points.txt") for name in wheel.names)


def test_without_a_compiler_the_wheel_is_for_every_platform(wheel: Wheel) -> None:
    """It is whole but for the kernels, and one line says why."""
    assert wheel.tags == "py3-none-any"
    (line,) = (line for line in wheel.said.splitlines() if "no compiled kernels" in line)
    assert "numpy does their work" in line


def test_a_release_cannot_lack_the_kernels(sdist: Path, no_zig: dict[str, str], tmp_path: Path) -> None:
    """VORONOI_TILES_REQUIRE_KERNELS=1 makes it an error that they were not compiled; so is a target that is none."""
    required = no_zig | {"VORONOI_TILES_REQUIRE_KERNELS": "1"}
    result = build(sdist, tmp_path, "--no-build-isolation", **required)
    assert result.returncode != 0
    assert "zig could not compile them" in result.stdout + result.stderr
    result = build(sdist, tmp_path, "--no-build-isolation", VORONOI_TILES_TARGET="amiga-m68k")
    assert result.returncode != 0
    assert "amiga-m68k is none of linux-x86_64, " in result.stdout + result.stderr
    assert not [*tmp_path.iterdir()]


USED = """
import voronoi_tiles as vt
from voronoi_tiles.base import kernels
vt.Design("p4", cell=60, sites=[vt.Site([vt.segment(5 + 3j, 25 + 11j)])]).tessellate().check(samples=64, renderer="cpu")
loaded = kernels._load.cache_info().currsize > 0  # by whoever asked for a kernel
print(kernels.in_use(), loaded, kernels.__file__)
"""


@pytest.mark.slow
def test_the_wheel_brings_its_kernels(sdist: Path, tmp_path: Path) -> None:
    """Built as pip builds it, and installed into an empty environment, it computes with its own library."""
    wheel = built(sdist, tmp_path, VORONOI_TILES_REQUIRE_KERNELS="1")
    python, abi, platform = wheel.tags.split("-")
    assert (python, abi) == ("py3", "none")
    assert platform != "any"
    wheel.library()
    venv.create(tmp_path / "empty", with_pip=True)
    installed = tmp_path / "empty" / "bin" / "python"
    subprocess.run([installed, "-m", "pip", "install", "--quiet", "--no-compile", wheel.file], check=True, timeout=600)
    said = subprocess.run(
        [installed, "-c", USED], cwd=tmp_path, capture_output=True, text=True, check=True, timeout=300
    )
    compiled, used, place = said.stdout.split()
    assert (compiled, used) == ("compiled", "True")
    assert Path(place).is_relative_to(tmp_path / "empty")


@pytest.mark.slow
def test_wheels_for_other_platforms_are_built_here(sdist: Path, tmp_path: Path) -> None:
    """A library in the format of macOS, for its processor, in a wheel that pip takes there."""
    required = {"VORONOI_TILES_REQUIRE_KERNELS": "1", "VORONOI_TILES_TARGET": "macos-arm64"}
    wheel = built(sdist, tmp_path, **required)
    assert wheel.tags == "py3-none-macosx_11_0_arm64"
    suffix, content = wheel.library()
    assert suffix == ".dylib"
    assert struct.unpack("<II", content[:8]) == (0xFEEDFACF, 0x0100000C)  # 64 bits; ARM of 64 bits
