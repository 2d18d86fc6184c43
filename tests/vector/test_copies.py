"""The copies that can shape a tile: the compiled kernel against numpy. What they are is asked in test_search.py."""

from __future__ import annotations

import pytest
from helpers import fuzz

from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.starters import starter
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.vector import copies
from voronoi_tiles.vector.copies import Copies, bundles, copies_near, place
from voronoi_tiles.vector.motions import Action


def same_copies(design: Design, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both paths give the same copies, bit for bit, as arrays of the same types."""
    action = Action(design.group, design.lattice)
    placed, union = place(action, design.noded)
    found = []
    for chosen in ("", "numpy"):
        monkeypatch.setenv("VORONOI_TILES_KERNELS", chosen)
        near = copies_near(action, placed, union.nodes, bundles(placed)[union.node_site])
        assert near.bundles == max(bundles(placed)) + 1
        found.append([(array.dtype, array.tobytes()) for array in (getattr(near, k) for k in Copies.__slots__)])
    assert found[0] == found[1]


@pytest.mark.parametrize("room", [1, 1000])
@pytest.mark.parametrize("group", GROUPS)
@pytest.mark.usefixtures("compiled")
def test_kernel_finds_the_copies_of_numpy(group: str, room: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the starters, however little room it has at first."""
    monkeypatch.setattr(copies, "_ROOM", room)
    same_copies(starter(group), monkeypatch)


@pytest.mark.parametrize("number", range(60))
@pytest.mark.usefixtures("compiled")
def test_kernel_finds_the_copies_of_numpy_for_any_design(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Fuzzed designs: of several bundles, in skew cells, far from the origin."""
    same_copies(Design.from_dict(fuzz.design_of(2028, number)[1]), monkeypatch)
