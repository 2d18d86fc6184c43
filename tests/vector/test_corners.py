"""Corners as images of the first of their orbit: the motions that links between corners lead along."""

from __future__ import annotations

import numpy as np

import voronoi_tiles as vt
from voronoi_tiles.vector.complex.corners import _motions
from voronoi_tiles.vector.motion_codes import code_of, motion_of
from voronoi_tiles.vector.motions import IDENTITY, Action, compose, inverse


def test_links_lead_either_way() -> None:
    """Corner 1 is linked to 0 and to 2, and 3 to 2; from 0 the way to 1 and to 3 is against these links."""
    design = vt.starter("p6")
    turns = [(*motion[:4], 2 * k, -4) for k, motion in enumerate(Action(design.group, design.lattice).motions)]
    one, two, three = turns[1:4]
    codes = np.array([code_of(motion) for motion in (one, two, three)])
    found = _motions(np.zeros(4, np.intp), np.array([1, 1, 3]), np.array([0, 2, 2]), codes)
    to_one = inverse(one)
    to_two = compose(two, to_one)
    assert [motion_of(code) for code in found.tolist()] == [IDENTITY, to_one, to_two, compose(inverse(three), to_two)]
