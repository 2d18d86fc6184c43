"""From parts to closed boundaries: the compiled kernels against numpy. test_tessellation.py asks what comes out."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from helpers import fuzz

from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.starters import starter
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.vector.cells.cells import Parts, bound_cells
from voronoi_tiles.vector.cells.enclosures import enclosed
from voronoi_tiles.vector.cells.half_edges import trace_contour
from voronoi_tiles.vector.cells.pencils import make_rows
from voronoi_tiles.vector.cells.trace import Boundary, OpenBoundaryError, trace_boundary
from voronoi_tiles.vector.complex.traced import with_curves
from voronoi_tiles.vector.copies import bundles, copies_near, place
from voronoi_tiles.vector.motions import Action

# Fuzzed designs that are refused for copies that touch.
TOUCHING = (17, 23, 33)


def same_boundary(design: Design, null: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Both paths give the same rings and curves, bit for bit, or refuse the same; also where a part is amiss."""
    action = Action(design.group, design.lattice)
    placed, union = place(action, design.noded)
    contour, node_bundle = trace_contour(union.nodes, union.segments), bundles(placed)[union.node_site]
    near = copies_near(action, placed, union.nodes, node_bundle)
    rows = make_rows(contour, action.covering_radius, enclosed(contour, near, union.node_site, node_bundle))
    parts = bound_cells(rows, contour, near, node_bundle, action.covering_radius)
    amiss = parts.copy.copy()
    amiss[0] = 0 if amiss[0] else near.bundles
    for copy in (parts.copy, amiss):
        some = Parts(parts.row, copy, parts.item, parts.begin, parts.end)
        found: list[list[Any]] = []
        for chosen in ("", "numpy"):
            monkeypatch.setenv("VORONOI_TILES_KERNELS", chosen)
            try:
                boundary = trace_boundary(rows, contour, some, union.node_site, near.bundles, null)
            except OpenBoundaryError:
                found.append(["refused"])
            else:
                arrays = [np.asarray(getattr(boundary, name)) for name in Boundary.__slots__]
                traced = with_curves(boundary, rows, contour, some, near, union.node_site)
                arrays += [value for value in vars(traced).values() if isinstance(value, np.ndarray)]
                found.append([(array.dtype, array.tobytes()) for array in arrays])
        assert found[0] == found[1]


@pytest.mark.parametrize("null", [0.0, 3.0, 1e9])
@pytest.mark.parametrize("group", GROUPS)
@pytest.mark.usefixtures("compiled")
def test_kernel_traces_the_rings_of_numpy(group: str, null: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the starters, without short arcs, and without any."""
    same_boundary(starter(group), null, monkeypatch)


@pytest.mark.parametrize("number", [number for number in range(60) if number not in TOUCHING])
@pytest.mark.usefixtures("compiled")
def test_kernel_traces_the_rings_of_numpy_for_any_design(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Fuzzed designs: isolated points, holes and several sites among them."""
    design = Design.from_dict(fuzz.design_of(2029, number)[1])
    same_boundary(design, 1e-9, monkeypatch)
