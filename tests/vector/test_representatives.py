"""Points as images of representatives: both paths, compiled and numpy, put them in the same places."""

from __future__ import annotations

import numpy as np
import pytest

from voronoi_tiles import GROUPS, starter


@pytest.mark.parametrize("group", GROUPS)
@pytest.mark.usefixtures("compiled")
def test_points_are_located_alike(group: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Bit for bit, also those that motions fix, those that a translation takes far away, and those that are none."""
    quotient = starter(group).tessellate().tessellation.quotient
    points = quotient.vertex.and_then(quotient.control)
    for further in ((0, 0), (2**40, -6)):
        found = []
        for chosen in ("", "numpy"):
            monkeypatch.setenv("VORONOI_TILES_KERNELS", chosen)
            found.append(quotient.representatives.locate(points, further))
        assert found[0].tobytes() == found[1].tobytes()
        assert not found[0][points.index < 0].any()
        assert np.isfinite(found[0]).all()
