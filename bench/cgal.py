"""The other yardstick: CGAL's segment Delaunay graph, by cgal.cpp, on the same block of copies as Boost.Polygon.

It takes doubles as they are, and its predicates are exact; its vertices are computed in doubles. cgal.cpp says which
traits it takes. Compiled when it is first needed, half a minute.
"""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
from compiled import MissingError, program_of, version_of
from numpy.typing import NDArray
from peer import Reading

from voronoi_tiles.designs.site import NodedSite

SOURCE = Path(__file__).with_name("cgal.cpp")
FLAGS = ("-std=c++17", "-O3", "-DNDEBUG", "-frounding-math")
_PROBE = "#include <CGAL/version.h>\n#include <gmp.h>\n#include <mpfr.h>\nCGAL_VERSION_STR\n"


@cache
def version() -> str:
    """CGAL's version; raises MissingError where there is no compiler or no CGAL."""
    return version_of(
        _PROBE,
        without_compiler="g++ is missing: install g++, libcgal-dev, libgmp-dev and libmpfr-dev to compare with CGAL",
        without_library="CGAL is missing: install libcgal-dev, libgmp-dev and libmpfr-dev to compare with it",
    )


def described() -> str:
    """CGAL's name and version, or what is missing."""
    try:
        return f"CGAL {version()}"
    except MissingError as error:
        return str(error)


def run_cgal(site: NodedSite, nodes: NDArray[np.complex128]) -> tuple[float, Reading]:
    """Build the graph and read the cells of the base site back.

    Args:
        site: the base site.
        nodes: complex128 (copies, m), the nodes of the site and of its copies, the site itself first.

    Returns:
        the seconds that building and reading took, without process, input and output; and what was read, in the terms
        of peer.py.
    """
    version()
    program = program_of(SOURCE, FLAGS, ("-lgmp", "-lmpfr"))
    text = _input_text(site, nodes)
    finished = subprocess.run([str(program)], input=text, capture_output=True, text=True, check=True)  # noqa: S603
    first, *lines = finished.stdout.splitlines()
    table = np.array([line.split() for line in lines], dtype=float).reshape(-1, 6)
    owner = _owners(site, len(nodes))
    cells: dict[int, list[tuple[complex, complex, bool, int]]] = {}
    for cell, beyond, *ends in zip(*table[:, :2].astype(int).T.tolist(), *table[:, 2:].T.tolist(), strict=True):
        # A side of the cell whose neighbour is the infinite vertex is no edge.
        if beyond >= 0:
            start, end = complex(*ends[:2]), complex(*ends[2:])
            straight = _straight(site, owner, cell, beyond)
            cells.setdefault(cell, []).append((start, end, straight, beyond))
    return float(first), Reading(list(cells.items()), owner)


def _input_text(site: NodedSite, nodes: NDArray[np.complex128]) -> str:
    """Write what cgal.cpp reads; repr gives back the very same doubles."""
    copies, count = nodes.shape
    shifts = count * np.arange(copies)[:, None, None]
    segments = (site.segments + shifts).reshape(-1, 2)
    rows = [f"{nodes.size} {len(segments)} {count} {len(site.segments)}"]
    rows += [f"{z.real!r} {z.imag!r}" for z in nodes.ravel().tolist()]
    rows += [f"{i} {j}" for i, j in segments.tolist()]
    return "\n".join(rows)


def _owners(site: NodedSite, copies: int) -> list[tuple[int, int]]:
    """The segment and the category of each cell as Boost.Polygon numbers them: 1 start, 2 end, 3 open segment."""
    of_node: list[tuple[int, int]] = [(-1, 0)] * len(site.nodes)
    for k, ends in enumerate(site.segments.tolist()):
        for category, node in enumerate(ends, start=1):
            of_node[node] = (k, category)
    assert (-1, 0) not in of_node, "the bench has no isolated points"
    count = len(site.segments)
    points = [(copy * count + k, category) for copy in range(copies) for k, category in of_node]
    return points + [(k, 3) for k in range(copies * count)]


def _straight(site: NodedSite, owner: Sequence[tuple[int, int]], cell: int, beyond: int) -> bool:
    """Whether two cells have a straight edge: two points, two segments, or a segment and an end of its own."""
    (one, first), (two, second) = owner[cell], owner[beyond]
    if (first == 3) == (second == 3):
        return True
    point, category, line = (one, first, two) if second == 3 else (two, second, one)
    count = len(site.segments)
    node = site.segments[point % count, category - 1]
    return point // count == line // count and node in site.segments[line % count]
