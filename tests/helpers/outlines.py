"""Outlines made by hand, and how tests call the command line."""

from __future__ import annotations

import subprocess
from collections.abc import Callable

from voronoi_tiles.base.operations import Operation
from voronoi_tiles.vector.arcs import Arc, LineArc, Neighbour

RIGHT = Neighbour("bird", Operation.parse("x+1,y"))
ABOVE = Neighbour("bird", Operation.parse("-x,-y+1"))

CommandLine = Callable[..., subprocess.CompletedProcess[str]]


def polygon(*points: complex, neighbour: Neighbour = RIGHT) -> list[Arc]:
    """Make a ring of straight edges."""
    ends = [*points[1:], points[0]]
    return [LineArc(start, end, neighbour) for start, end in zip(points, ends, strict=True)]
