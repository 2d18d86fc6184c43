"""The example designs: their names, their tiles, and which of them the quick tests take.

Tests that run over all examples promise something of each; the quick run takes the first of every wallpaper group, and
the slow one the others.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.starters import starter_text
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.tiling import Tiling

FOLDER = Path(__file__).parents[2] / "examples"

EXAMPLES = sorted(path.stem for path in FOLDER.glob("*.toml"))
"""By name, which begins with the group's."""

NAMES = [*EXAMPLES, *GROUPS]
"""All designs that there are: the examples by name, the starters by group."""


def path_of(name: str) -> Path:
    """The file of an example."""
    return FOLDER / f"{name}.toml"


@cache
def tiling(name: str) -> Tiling:
    """The tiles of an example by its name, or of the starter of a group; made once for all tests."""
    design = Design.loads(starter_text(name)) if name in GROUPS else Design.load(path_of(name))
    return design.tessellate()


def is_first(name: str) -> bool:
    """Whether a design is the first example of its group, or none of these examples."""
    group = name.partition("-")[0]
    return name not in EXAMPLES or name == next(other for other in EXAMPLES if other.partition("-")[0] == group)


each_example = pytest.mark.parametrize(
    "name", [name if is_first(name) else pytest.param(name, marks=pytest.mark.slow) for name in EXAMPLES]
)
"""For tests of every example."""

each_design = pytest.mark.parametrize(
    "name", [name if is_first(name) else pytest.param(name, marks=pytest.mark.slow) for name in NAMES]
)
"""For tests of every example and every starter."""
