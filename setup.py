"""The build of the compiled kernels; all else that setuptools is to know stands in pyproject.toml.

All C files become one shared library beside voronoi_tiles/base/kernels.py, which loads it. The compiler is zig, which
pip fetches for the time of the build; it needs neither another compiler nor headers, and compiles for other platforms
as well: VORONOI_TILES_TARGET names one of TARGETS. Where there is no zig, or it fails, the build goes on without the
library, and numpy does the work; with VORONOI_TILES_REQUIRE_KERNELS=1 that is an error. `make wheels` builds them all.
"""

from __future__ import annotations

import importlib.util
import os
import platform
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import NamedTuple
from zlib import crc32

from setuptools import Extension, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_ext import build_ext
from setuptools.errors import CompileError, OptionError

SOURCES = [
    "voronoi_tiles/base/kernels.c",
    "voronoi_tiles/base/box_index.c",
    "voronoi_tiles/fabrication/next_rows.c",
    "voronoi_tiles/fabrication/separation.c",
    "voronoi_tiles/paths/biarc_bounds.c",
    "voronoi_tiles/paths/clearance.c",
    "voronoi_tiles/paths/cubic_fit.c",
    "raster/block_lists.c",
    "vector/cells/cells.c",
    "vector/cells/hierarchy.c",
    "vector/cells/trace.c",
    "vector/complex/boundary.c",
    "vector/complex/edges.c",
    "vector/complex/traced.c",
    "vector/copies.c",
    "vector/crossings.c",
    "vector/motion_codes.c",
    "vector/nearest_copies.c",
    "vector/strayed.c",
]
"""The C files, each beside what it computes in numpy; a new one is a line here."""

# Results depend neither on the machine (zig compiles for the processors that a platform begins with) nor on how the
# compiler groups a formula: no fused multiply-add, and nothing of -ffast-math.
FLAGS = ["-O3", "-std=c11", "-Wall", "-Werror", "-ffp-contract=off", "-fno-math-errno", "-shared", "-fPIC", "-s"]


class Target(NamedTuple):
    """What a library is compiled for: zig's name, the wheel's tag, the suffix of its file."""

    zig: str
    tag: str
    suffix: str


# As old a glibc and macOS as those who have our Python and numpy may have.
TARGETS = {
    "linux-x86_64": Target("x86_64-linux-gnu.2.17", "manylinux_2_17_x86_64", ".so"),
    "linux-aarch64": Target("aarch64-linux-gnu.2.17", "manylinux_2_17_aarch64", ".so"),
    "macos-arm64": Target("aarch64-macos.11.0", "macosx_11_0_arm64", ".dylib"),
    "macos-x86_64": Target("x86_64-macos.10.13", "macosx_10_13_x86_64", ".dylib"),
    "windows-x86_64": Target("x86_64-windows-gnu", "win_amd64", ".dll"),
}


def target() -> Target:
    """What to compile for: what is asked for, or else the platform that this Python runs on."""
    system = {"darwin": "macos", "win32": "windows"}.get(sys.platform, sys.platform)
    name = f"{system}-{platform.machine()}".lower().replace("amd64", "x86_64")
    if "musl" in str(sysconfig.get_config_var("SOABI")):
        name = "another"  # than its name says
    asked = os.environ.get("VORONOI_TILES_TARGET")
    if asked:
        if asked not in TARGETS:
            raise OptionError(f"VORONOI_TILES_TARGET={asked} is none of {', '.join(TARGETS)}")
        return TARGETS[asked]
    suffix = {"macos": ".dylib", "windows": ".dll"}.get(system, ".so")
    return TARGETS.get(name, Target("native", "", suffix))


def compile_library(library: Path, scratch: Path) -> None:
    """Compile the C files into a library, whose manifest names target and sources with the CRC-32 of each.

    A library that has this manifest already is left as it is. Raises CompileError.
    """
    files = ["setup.py", *SOURCES]
    manifest = " ".join([target().zig, *(f"{file}:{crc32(Path(file).read_bytes()):08x}" for file in files)])
    if library.exists() and manifest.encode() in library.read_bytes():
        return
    for old in library.parent.glob("kernels.compiled.*"):
        old.unlink()
    if sys.maxsize < 2**32:
        raise CompileError("they need a Python of 64 bits")
    if importlib.util.find_spec("ziglang") is None:
        raise CompileError("ziglang is not here")
    made = scratch.resolve() / library.name
    made.parent.mkdir(parents=True, exist_ok=True)
    where = ["-mcpu=baseline"] if target().zig == "native" else ["-target", target().zig]
    caches = {name: str(made.parent / "zig") for name in ("ZIG_GLOBAL_CACHE_DIR", "ZIG_LOCAL_CACHE_DIR")}
    command = [sys.executable, "-m", "ziglang", "cc", *FLAGS, *where, f'-DMANIFEST="{manifest}"', *SOURCES, "-lm"]
    try:
        subprocess.run([*command, "-o", str(made)], check=True, env=caches | os.environ)
        # Whole or not at all: another process may be loading it.
        library.parent.mkdir(parents=True, exist_ok=True)
        beside = Path(shutil.copy(made, library.with_suffix(".new")))
        beside.replace(library)
    except (OSError, subprocess.CalledProcessError) as error:
        raise CompileError(f"zig could not compile them: {error}") from error


class BuildKernels(build_ext):
    """Compiles the one library where setuptools would compile extension modules."""

    def get_ext_filename(self, fullname: str) -> str:
        """The library's place: it uses nothing of Python's, so its name is the same for all, and no module's."""
        return str(Path(*fullname.split("."))) + f".compiled{target().suffix}"

    def run(self) -> None:
        """Compile, in the tree for an editable install; or say in one line that it could not be done."""
        (extension,) = self.extensions
        try:
            compile_library(Path(self.get_ext_fullpath(extension.name)), Path(self.build_temp))
        except CompileError as error:
            if os.environ.get("VORONOI_TILES_REQUIRE_KERNELS") == "1":
                raise
            self.warn(f"no compiled kernels, numpy does their work: {error}")


class Wheel(bdist_wheel):
    """Tags the wheel by what its library runs on, on any Python 3."""

    def get_tag(self) -> tuple[str, str, str]:
        """The wheel's tag; that of every platform where there is no library."""
        *_, native = super().get_tag()
        (library,) = self.get_finalized_command("build_ext").get_outputs()
        return "py3", "none", (target().tag or native) if Path(library).exists() else "any"


if __name__ == "__main__":
    setup(
        ext_modules=[Extension("voronoi_tiles.base.kernels", SOURCES, optional=True)],
        cmdclass={"build_ext": BuildKernels, "bdist_wheel": Wheel},
    )
