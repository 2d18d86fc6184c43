"""Outlines that come near to each other: as shapely measures them, with the compiled kernel and without."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from voronoi_tiles.base.arrays import Complexes, offsets_of, plane
from voronoi_tiles.paths.clearance import Outlines

STEPS = (1, 7, 8, 9, 60, 200)
"""Segments of the outlines; a count. Eight share a box."""


def walk(steps: int, rng: np.random.Generator) -> Complexes:
    """A random line; now and then it stays where it is."""
    ways = rng.standard_normal(steps) + 1j * rng.standard_normal(steps)
    ways[rng.uniform(size=steps) < 0.05] = 0.0
    return np.cumsum(np.append(0.0, ways))


def outlines(lines: list[Complexes]) -> Outlines:
    """Lines through points."""
    start, end = (np.concatenate([line[part] for line in lines]) for part in (slice(-1), slice(1, None)))
    return Outlines(start, end, offsets_of([len(line) - 1 for line in lines]))


def pairs(seed: int) -> tuple[list[Complexes], Complexes]:
    """Random lines, and for each pair of them, in the order of both numbers, a shift of the second."""
    rng = np.random.default_rng(seed)
    lines = [walk(steps, rng) for steps in STEPS]
    return lines, 10 * (rng.standard_normal(len(lines) ** 2) + 1j * rng.standard_normal(len(lines) ** 2))


@pytest.mark.usefixtures("compiled")
@pytest.mark.parametrize("seed", range(2))
def test_both_ways_give_the_same_bits(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """The kernel and numpy find the same pair, and the same way, down to the last bit."""
    lines, shift = pairs(seed)
    one, two = np.divmod(np.arange(len(shift)), len(lines))
    given = [(one[k:], two[k:], shift[k:], reach) for k in range(0, len(shift), 5) for reach in (0.5, 10.0)]
    given.append((one, two, shift + 1000.0, 10.0))
    found = [outlines(lines).first_near(*each) for each in given]
    monkeypatch.setenv("VORONOI_TILES_KERNELS", "numpy")
    assert repr([outlines(lines).first_near(*each) for each in given]) == repr(found)
    assert found.pop() is None
    assert any(found)


@pytest.mark.parametrize("kernels", ["compiled", "numpy"])
@pytest.mark.parametrize("seed", range(2))
def test_a_pair_is_near_where_shapely_says_so(
    kernels: str, seed: int, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Within a reach a little above the distance, not a little below it; and the way is as long as the distance."""
    if kernels == "compiled":
        request.getfixturevalue(kernels)
    else:
        monkeypatch.setenv("VORONOI_TILES_KERNELS", kernels)
    lines, shift = pairs(seed)
    subject = outlines(lines)
    crossed = 0
    for k, (one, two) in enumerate(np.ndindex(len(lines), len(lines))):
        here, there = (shapely.LineString(plane(line)) for line in (lines[one], lines[two] + shift[k]))
        distance = float(here.distance(there))
        asked = np.array([one]), np.array([two]), shift[k : k + 1]
        near = subject.first_near(*asked, distance + 1e-9)
        assert near is not None
        assert abs(near.way) == pytest.approx(distance, abs=1e-9)
        if distance > 0.0:
            assert subject.first_near(*asked, distance - 1e-9) is None
        crossed += distance == 0.0
    assert 0 < crossed < len(shift)
