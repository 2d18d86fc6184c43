"""The compiled kernels: the shared library that the build makes of the C files, where it could.

A kernel does what numpy code beside it does, with the same bits; without the library numpy does the work. The variable
VORONOI_TILES_KERNELS=numpy in the environment leaves the library aside; any other value is an error.
"""

from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, cast
from zlib import crc32

import numpy as np
from numpy.typing import DTypeLike, NDArray

from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.values import shown

_VARIABLE = "VORONOI_TILES_KERNELS"
_SUFFIX = {"darwin": ".dylib", "win32": ".dll"}.get(sys.platform, ".so")
_LIBRARY = Path(__file__).with_suffix(f".compiled{_SUFFIX}")  # the second dot keeps it from being taken for a module
_ROOT = Path(__file__).parents[2]

# That an array is a buffer its type does not say.
_memory_of = cast(Callable[[NDArray[Any]], "ctypes.Array[ctypes.c_char]"], (ctypes.c_char * 0).from_buffer)


class Array:
    """The type of a kernel's argument that is a C-contiguous array of one dtype; ctypes asks `from_param`.

    What a kernel writes into must be writeable, which is for the caller to see to.
    """

    def __init__(self, dtype: DTypeLike) -> None:
        self.dtype = np.dtype(dtype)

    def from_param(self, array: NDArray[Any]) -> ctypes.Array[ctypes.c_char] | ctypes.c_void_p:
        """The array's address. Raises TypeError where it has another dtype, gaps, or stands between two addresses."""
        flags = array.flags
        if array.dtype is self.dtype or array.dtype == self.dtype:
            if flags.carray:  # and can be written into
                # ctypes' own view of the memory goes to C as its address; numpy takes ten times as long to tell that.
                return _memory_of(array)
            if flags.c_contiguous and flags.aligned:
                return ctypes.c_void_p(array.ctypes.data)
        raise TypeError(f"the kernel takes aligned, contiguous arrays of {self.dtype}, not {array.dtype}")


COMPLEXES, FLOATS, INTS = Array(np.complex128), Array(np.float64), Array(np.int64)
LABELS, BOOLS = Array(np.int32), Array(np.bool_)
FLOAT, INT = ctypes.c_double, ctypes.c_int64


def library() -> ctypes.CDLL | None:
    """The library of compiled kernels; None where numpy does their work.

    Raises ArgumentError where VORONOI_TILES_KERNELS is neither numpy nor empty, here and below.
    """
    return _chosen(os.environ.get(_VARIABLE))[0]


def in_use() -> str:
    """Which kernels are in use, for people: "compiled", or "numpy" with the reason."""
    loaded, reason = _chosen(os.environ.get(_VARIABLE))
    return "compiled" if loaded else f"numpy ({reason})"


def kernel(name: str, *kinds: Any) -> Callable[[], Callable[..., int] | None]:
    """What gives a function of the library, whose arguments are of these kinds; None where numpy does its work.

    It is asked each time, as the environment may choose anew. The function's result is an int64. ctypes raises
    ArgumentError where an argument is of another kind.
    """

    @cache
    def bound(choice: str | None) -> Callable[..., int] | None:
        loaded, _ = _chosen(choice)
        if loaded is None:
            return None
        function = loaded[name]
        function.argtypes = kinds
        function.restype = ctypes.c_int64
        return function

    return lambda: bound(os.environ.get(_VARIABLE))


def _chosen(choice: str | None) -> tuple[ctypes.CDLL | None, str]:
    """The library as the variable's value, None where it is not set, chooses it; or None and why."""
    if choice == "numpy":
        return None, f"{_VARIABLE}=numpy"
    if choice:
        raise ArgumentError(
            f"{_VARIABLE}={shown(choice)} in the environment chooses nothing", remedy="Set it to numpy, or not at all."
        )
    return _load(_LIBRARY, _ROOT)


@cache
def _load(path: Path, root: Path) -> tuple[ctypes.CDLL | None, str]:
    """The library at a path, or None and why; where its sources are below `root`, it must be made of them."""
    if not path.exists():
        return None, "they were not compiled when this was installed"
    try:
        loaded = ctypes.CDLL(str(path))
        loaded.voronoi_tiles_manifest.restype = ctypes.c_char_p
        manifest = loaded.voronoi_tiles_manifest().decode()
    except (OSError, AttributeError) as error:
        return None, f"{path.name} cannot be loaded: {' '.join(str(error).split())}"
    checksums = dict(entry.rsplit(":", 1) for entry in manifest.split()[1:])
    if all((root / name).exists() for name in checksums):  # in the checkout, where they may have changed since
        for name, checksum in checksums.items():
            if f"{crc32((root / name).read_bytes()):08x}" != checksum:
                return None, f"{path.name} was compiled from another {name}; install anew"
    return loaded, ""
