"""Outlines made by hand, and how tests call the command line."""

from __future__ import annotations

import subprocess
from collections.abc import Callable

import numpy as np

from voronoi_tiles.base.operations import Operation
from voronoi_tiles.vector.all_arcs import AllArcs
from voronoi_tiles.vector.arcs import Arc, LineArc, Neighbour
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.strayed import winding_numbers

RIGHT = Neighbour("bird", Operation.parse("x+1,y"))
ABOVE = Neighbour("bird", Operation.parse("-x,-y+1"))

CommandLine = Callable[..., subprocess.CompletedProcess[str]]


def polygon(*points: complex, neighbour: Neighbour = RIGHT) -> list[Arc]:
    """Make a ring of straight edges."""
    ends = [*points[1:], points[0]]
    return [LineArc(start, end, neighbour) for start, end in zip(points, ends, strict=True)]


def winding_number(outline: Outline, point: complex) -> int:
    """How often an outline runs counter-clockwise around a point that is not on it."""
    return int(winding_numbers(AllArcs.of([outline]), np.array([point]), np.zeros(1, np.intp))[0])
