"""Edges and their images: that both paths, compiled and numpy, know those that plainly agree."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from voronoi_tiles import GROUPS, starter
from voronoi_tiles.vector.complex import edges as module
from voronoi_tiles.vector.complex.edges import find_edges
from voronoi_tiles.vector.complex.site_symmetry import SiteSymmetry
from voronoi_tiles.vector.copies import place
from voronoi_tiles.vector.motion_codes import IDENTITY_CODE
from voronoi_tiles.vector.motions import Action
from voronoi_tiles.vector.tessellation import _trace


@pytest.mark.parametrize("group", GROUPS)
@pytest.mark.usefixtures("compiled")
def test_edges_agree_with_their_images_but_for_those_at_a_vertex_that_is_moved(
    group: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each vertex in turn, by more than rounding and by less."""
    design = starter(group)
    action = Action(design.group, design.lattice)
    placed, union = place(action, design.noded)
    traced, _ = _trace(action, placed, union)
    edges = find_edges(action, SiteSymmetry.of(placed), traced, without_short=False)
    links = np.flatnonzero(edges.by != IDENTITY_CODE)
    for k in range(0, len(traced), 3):
        for step, by_all in ((1e-3 + 2e-3j, False), (1e-9j, True)):
            vertex = traced.vertex.copy()
            vertex[k] += step * action.size
            moved = replace(edges, traced=replace(traced, vertex=vertex))
            found = []
            for chosen in ("", "numpy"):
                monkeypatch.setenv("VORONOI_TILES_KERNELS", chosen)
                found.append(module._agree(action, moved, links).tolist())
            assert found[0] == found[1]
            assert all(found[0]) == by_all
