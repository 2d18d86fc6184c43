"""The compiled kernels' loader: it takes a library that is right, says why it takes none, and never fails."""

from __future__ import annotations

import ctypes
import shutil
from pathlib import Path

import numpy as np
import pytest

from voronoi_tiles.base import kernels
from voronoi_tiles.base.errors import ArgumentError

ROOT = Path(__file__).parents[2]


def test_numpy_can_be_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """VORONOI_TILES_KERNELS=numpy leaves the library aside, whether there is one or not."""
    monkeypatch.setenv("VORONOI_TILES_KERNELS", "numpy")
    assert kernels.library() is None
    assert kernels.kernel("raster_keep", kernels.INT)() is None
    assert kernels.in_use() == "numpy (VORONOI_TILES_KERNELS=numpy)"


@pytest.mark.parametrize("value", ["junk", "Numpy", "numpy ", "compiled", "0"])
def test_what_is_no_choice_of_kernels_is_refused(value: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever misspells it would take the compiled kernels for numpy; an empty value is none."""
    monkeypatch.setenv("VORONOI_TILES_KERNELS", value)
    for ask in (kernels.library, kernels.in_use, kernels.kernel("raster_keep", kernels.INT)):
        with pytest.raises(ArgumentError, match=f"VORONOI_TILES_KERNELS='{value}' .* Set it to numpy"):
            ask()
    monkeypatch.setenv("VORONOI_TILES_KERNELS", "")
    chosen = kernels.in_use()
    monkeypatch.delenv("VORONOI_TILES_KERNELS")
    assert kernels.in_use() == chosen


@pytest.mark.parametrize("content", [None, b"", b"\x7fELF, but no more of it"])
def test_a_library_that_cannot_be_loaded_is_passed_over(
    content: bytes | None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """None at all, an empty file, a broken one: numpy does the work, and one line says why."""
    monkeypatch.delenv("VORONOI_TILES_KERNELS", raising=False)
    library = tmp_path / "kernels.so"
    if content is not None:
        library.write_bytes(content)
    monkeypatch.setattr(kernels, "_LIBRARY", library)
    assert kernels.library() is None
    (line,) = kernels.in_use().splitlines()
    assert line.startswith("numpy (")
    assert ("not compiled" in line) if content is None else ("kernels.so cannot be loaded" in line)


def test_another_librarys_functions_are_not_ours(monkeypatch: pytest.MonkeyPatch) -> None:
    """A shared library that is none of ours has no manifest."""
    other = np.linalg._umath_linalg.__file__
    monkeypatch.delenv("VORONOI_TILES_KERNELS", raising=False)
    monkeypatch.setattr(kernels, "_LIBRARY", Path(other))
    assert kernels.library() is None
    assert "cannot be loaded" in kernels.in_use()


def sources() -> list[str]:
    """The files that the library was compiled from, by its own manifest."""
    library = kernels.library()
    assert library is not None
    return [entry.partition(":")[0] for entry in library.voronoi_tiles_manifest().decode().split()[1:]]


@pytest.mark.usefixtures("compiled")
def test_every_c_file_is_in_the_library() -> None:
    """A file that setup.py does not list would not be compiled."""
    folders = ("voronoi_tiles", "vector", "raster")
    found = {path.relative_to(ROOT).as_posix() for folder in folders for path in (ROOT / folder).rglob("*.c")}
    assert {*sources()} == {"setup.py", *found}


@pytest.mark.usefixtures("compiled")
def test_a_library_of_other_sources_is_passed_over(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """In a checkout the library must be made from the files as they are; elsewhere, without the files, it is taken."""
    monkeypatch.setattr(kernels, "_LIBRARY", Path(shutil.copy(kernels._LIBRARY, tmp_path)))
    monkeypatch.setattr(kernels, "_ROOT", tmp_path)
    assert kernels.in_use() == "compiled"
    names = sources()
    for name in names:
        copy = tmp_path / name
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, copy)
    kernels._load.cache_clear()
    assert kernels.in_use() == "compiled"
    for name in names:
        kernels._load.cache_clear()
        content = (ROOT / name).read_bytes()
        (tmp_path / name).write_bytes(content + b"\n")
        assert kernels.library() is None
        assert f"was compiled from another {name}" in kernels.in_use()
        (tmp_path / name).write_bytes(content)


@pytest.mark.parametrize(
    "wrong",
    [
        np.zeros(4, np.float32),
        np.zeros(4, np.int64),
        np.zeros(8)[::2],
        np.zeros((2, 3)).T,
        np.zeros(4, ">f8"),
        np.frombuffer(bytes(33), np.float64, offset=1),
    ],
)
def test_a_kernel_takes_only_the_arrays_that_it_is_made_for(wrong: np.ndarray) -> None:
    """An array of another type, or with gaps, would be read as what it is not."""
    with pytest.raises(TypeError, match="contiguous arrays of float64"):
        kernels.FLOATS.from_param(wrong)
    right = np.array([1.0, 2.0, 4.0])
    for right.flags.writeable in (True, False):
        address = kernels.FLOATS.from_param(right)
        assert [*ctypes.cast(address, ctypes.POINTER(ctypes.c_double))[0:3]] == [1.0, 2.0, 4.0]
