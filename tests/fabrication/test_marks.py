"""The reference bar and the marks that align sheets: true lengths, inside the page, no symmetry left."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from voronoi_tiles.fabrication.lettering import lettering
from voronoi_tiles.fabrication.marks import bar_height, reference_bar, registration_marks, rounded_square
from voronoi_tiles.paths.paths import ARC, LINE, Paths


def lines_of(paths: Paths) -> list[np.ndarray]:
    """The corners of each path, (k, 2)."""
    pairs = zip(paths.offsets[:-1], paths.offsets[1:], strict=True)
    return [np.array([(z.real, z.imag) for z in (*paths.start[a:b], paths.end[b - 1])]) for a, b in pairs]


def test_the_bar_is_as_long_as_it_says() -> None:
    """The end ticks are 100 mm apart, a tick stands every 10 mm, and the caption says so."""
    bar = reference_bar(2.0)
    caption = lettering("100 mm", height=2.0)
    lines = lines_of(bar)
    assert len(lines) == 10 + len(caption)
    ends = lines[0]
    assert ends.tolist() == [[0, 2], [0, 0], [100, 0], [100, 2]]
    for number, tick in enumerate(lines[1:10], start=1):
        assert tick.tolist() == [[10 * number, 0], [10 * number, 1]]
    letters = bar.take(np.arange(10, len(lines)))
    assert np.allclose(letters.lengths, caption.lengths)
    x0, y0, x1, y1 = letters.bounds
    assert (x0 + x1) / 2 == pytest.approx(50)
    assert y0 > 1
    assert y1 == pytest.approx(bar_height(2.0))
    assert not bar.closed.any()


def test_nothing_of_the_bar_crosses() -> None:
    """Ticks touch the bar, the caption keeps away from both."""
    bar = reference_bar(3.0)
    lines = [shapely.LineString(line) for line in lines_of(bar)]
    ruler, letters = shapely.union_all(lines[:10]), shapely.union_all(lines[10:])
    assert shapely.distance(ruler, letters) > 1
    assert not any(lines[0].crosses(tick) for tick in lines[1:10])
    assert all(lines[0].touches(tick) for tick in lines[1:10])
    assert bar.bounds == pytest.approx((0, 0, 100, bar_height(3.0)))


@pytest.mark.parametrize("letters", [0, -1, float("nan")])
def test_bars_that_are_none(letters: float) -> None:
    """Letters are higher than nothing."""
    with pytest.raises(ValueError, match="more than 0 mm"):
        reference_bar(letters)


def samples(paths: Paths) -> np.ndarray:
    """Points of all pieces: ends, middles and those of arcs."""
    middle = np.where(paths.kind == ARC, paths.control[:, 0], (paths.start + paths.end) / 2)
    return np.concatenate((paths.start, paths.end, middle))


def alike(first: np.ndarray, second: np.ndarray) -> bool:
    """Whether two sets of points are one, to a micrometre."""
    apart = np.abs(first[:, None] - second[None, :])
    return bool(apart.min(axis=0).max() < 1e-3 and apart.min(axis=1).max() < 1e-3)


@pytest.mark.parametrize("page", [(200.0, 200.0), (300.0, 200.0)])
def test_a_sheet_that_is_turned_or_flipped_shows_it(page: tuple[float, float]) -> None:
    """Of the eight ways to lay a square on itself only the identity keeps the marks."""
    points = samples(registration_marks(*page, size=6, inset=6)) - complex(*page) / 2
    kept = [
        (turn, flip)
        for turn in (1, 1j, -1, -1j)
        for flip in (False, True)
        if alike(points, turn * (points.conj() if flip else points))
    ]
    assert kept == [(1, False)]
    # The comparison sees the symmetry that the square at one corner breaks.
    centres = np.array([-94 - 94j, 94 - 94j, -94 + 94j])
    assert alike(centres, 1j * centres.conj())


@pytest.mark.parametrize("inset", [2.0, 4.0, 10.0])
def test_marks_stay_on_the_page(inset: float) -> None:
    """Three marks of the asked size, their centres the inset away from the edges."""
    marks = registration_marks(300, 200, size=4, inset=inset)
    assert len(marks) == 9
    assert marks.closed.tolist() == [False, False, True] * 3
    assert marks.bounds == pytest.approx((inset - 2, inset - 2, 300 - inset + 2, 200 - inset + 2))
    crosses = marks.take(np.array([0, 3, 6]))
    middles = (crosses.start + crosses.end) / 2
    assert middles.tolist() == pytest.approx(
        [complex(inset, inset), complex(300 - inset, inset), complex(inset, 200 - inset)]
    )


@pytest.mark.parametrize(
    ("width", "height", "size", "inset"),
    [(10, 200, 6, 6), (200, 10, 6, 6), (200, 200, 0, 6), (200, 200, 6, 2), (float("nan"), 200, 6, 6)],
)
def test_marks_that_do_not_fit(width: float, height: float, size: float, inset: float) -> None:
    """Marks neither leave the page nor meet."""
    with pytest.raises(ValueError, match="fit"):
        registration_marks(width, height, size=size, inset=inset)


@pytest.mark.parametrize("radius", [0.0, 1.0, 4.9, 5.0])
def test_a_rounded_square_is_one(radius: float) -> None:
    """Its length is that of four straight sides and a circle, its bounds are the square's, it is closed."""
    square = rounded_square(3 + 4j, 10.0, radius=radius)
    assert len(square) == 1
    assert square.closed.all()
    assert np.array_equal(square.end, np.roll(square.start, -1))
    assert square.lengths.sum() == pytest.approx(4 * (10 - 2 * radius) + 2 * np.pi * radius)
    assert square.bounds == pytest.approx((-2, -1, 8, 9))
    assert sorted(set(square.kind.tolist())) == ([LINE] if radius == 0 else [LINE, ARC] if radius < 5 else [ARC])
    arcs = np.flatnonzero(square.kind == ARC)
    if len(arcs):
        found, turn = square.arc_radius_and_turn(arcs)
        assert found == pytest.approx(radius)
        assert turn == pytest.approx(np.pi / 2)


@pytest.mark.parametrize(("side", "radius"), [(0, 0), (-1, 0), (10, 5.1), (10, -1), (float("nan"), 0)])
def test_squares_that_are_none(side: float, radius: float) -> None:
    """A side is more than 0, and corners leave room for each other."""
    with pytest.raises(ValueError, match="square"):
        rounded_square(0j, side, radius=radius)
