"""Boost.Polygon itself, by boost.cpp: the yardstick of peer.py without what reading back in Python adds to it.

Compiled when it is first needed.
"""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
from compiled import MissingError, program_of, version_of
from peer import SCALE, Reading, Segment

SOURCE = Path(__file__).with_name("boost.cpp")
FLAGS = ("-std=c++17", "-O3", "-DNDEBUG")
_PROBE = "#include <boost/version.hpp>\n#include <boost/polygon/voronoi.hpp>\nBOOST_LIB_VERSION\n"


@cache
def version() -> str:
    """Boost's version; raises MissingError where there is no compiler or no Boost."""
    found = version_of(
        _PROBE,
        without_compiler="g++ is missing: install g++ and libboost-dev to compare with Boost.Polygon itself",
        without_library="Boost is missing: install libboost-dev to compare with Boost.Polygon itself",
    )
    return found.replace("_", ".")


def described() -> str:
    """Boost's name and version, or what is missing."""
    try:
        return f"Boost.Polygon {version()}, g++ -O3"
    except MissingError as error:
        return str(error)


def run_boost(
    segments: Sequence[Segment], base: int, runs: int = 1, scale: float = SCALE
) -> tuple[list[float], Reading]:
    """Build the diagram so many times; `base` is the number of the base site's segments, which come first.

    Coordinates are rounded to multiples of 1 / `scale`.

    Returns the processor seconds of each time, without input and output, and what was read, as peer.run_peer does.
    """
    whole = np.rint(np.array(segments).reshape(-1, 4) * scale)
    if np.abs(whole).max() >= 2**31:
        raise ValueError("the coordinates are too large for 32 bits")
    rows = [f"{runs} {len(whole)} {base}", *(f"{a} {b} {c} {d}" for a, b, c, d in whole.astype(int).tolist())]
    version()
    program = program_of(SOURCE, FLAGS)
    done = subprocess.run([str(program)], input="\n".join(rows), capture_output=True, text=True, check=True)  # noqa: S603
    first, *lines = done.stdout.splitlines()
    owner: list[tuple[int, int]] = []
    cells: dict[int, list[tuple[complex, complex, bool, int]]] = {}
    for kind, *words in map(str.split, lines):
        if kind == "C":
            owner.append((int(words[0]), int(words[1])))
        else:
            start, end = (complex(float(words[k]), float(words[k + 1])) / scale for k in (3, 5))
            cells.setdefault(int(words[0]), []).append((start, end, words[2] == "1", int(words[1])))
    return [float(seconds) for seconds in first.split()], Reading(list(cells.items()), owner)
