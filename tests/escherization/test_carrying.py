"""Displacements that an outline's points are given, carried to what lies about it: points, paths, and drawings."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
import shapely
from helpers.curves import arc, chain, sampled
from helpers.svg_text import svg
from scipy.spatial import cKDTree

from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.escherization.carried_art import carried_art
from voronoi_tiles.escherization.carried_paths import carried_paths
from voronoi_tiles.escherization.carrying import Carrying
from voronoi_tiles.formats.reading import ReadDrawing, drawing_of
from voronoi_tiles.paths.paths import ARC, LINE, Paths

REACH = 12.0


def blob(seed: int, count: int = 120) -> Complexes:
    """A closed curve with bays, some 60 units wide, as points."""
    rng = np.random.default_rng(seed)
    t = np.arange(count) / count * 2 * np.pi
    radius = 30 * (1 + sum(rng.uniform(-0.4, 0.4) / k * np.sin(k * t + rng.uniform(0, 6)) for k in range(2, 6)))
    return np.asarray(radius * np.exp(1j * t))


def anywhere(rng: np.random.Generator, size: float, count: int) -> Complexes:
    """So many points of a square about 0."""
    return np.asarray(rng.uniform(-size, size, count) + 1j * rng.uniform(-size, size, count))


def moved(seed: int, count: int = 120, size: float = 2.0) -> Complexes:
    """Displacements that change smoothly along an outline, the longest of them `size` long."""
    rng = np.random.default_rng(seed)
    t = np.arange(count) / count * 2 * np.pi
    found = sum(factor * np.exp(1j * k * t) for k, factor in enumerate(anywhere(rng, 1.0, 9).tolist(), -4))
    return np.asarray(found * (size / np.abs(found).max()))


def carrying(seed: int) -> Carrying:
    """A blob and its displacements."""
    return Carrying.of(blob(seed), moved(seed), REACH)


def shift_by_definition(outline: Complexes, displacement: Complexes, point: complex) -> complex:
    """The displacement in 40 digits: weights of tangents of half the angles, which arguments give, and a cubic."""
    with mpmath.workdps(40):
        seen = [mpmath.mpc(z) - mpmath.mpc(point) for z in outline.tolist()]
        count = len(seen)
        angles = [mpmath.arg(seen[(j + 1) % count] / seen[j]) for j in range(count)]
        weights = [(mpmath.tan(angles[j - 1] / 2) + mpmath.tan(angles[j] / 2)) / abs(seen[j]) for j in range(count)]
        total = sum(weights)
        mean = sum(w * mpmath.mpc(d) for w, d in zip(weights, displacement.tolist(), strict=True)) / total
        s = min(2 / abs(total) / REACH, mpmath.mpf(1))
        return complex(mean * (1 - 3 * s**2 + 2 * s**3))


@pytest.mark.parametrize("seed", range(3))
def test_points_are_displaced_as_the_definition_says(seed: int) -> None:
    """Within and without, beside the outline and far from it; whichever way round the outline runs."""
    rng = np.random.default_rng(seed)
    field = carrying(seed)
    points = anywhere(rng, 60.0, 20)
    points = np.concatenate((points, field.outline[:9] + rng.normal(0, 1e-6, 9), field.outline[9:20] * 0.97))
    right = np.array([shift_by_definition(field.outline, field.displacement, z) for z in points.tolist()])
    back = Carrying.of(field.outline[::-1], field.displacement[::-1], REACH)
    assert np.abs(field.shift(points) - right).max() < 1e-11
    assert np.abs(back.shift(points) - right).max() < 1e-11
    assert np.abs(right).max() > 0.5
    assert field.shift(points[:6].reshape(2, 3)).shape == (2, 3)


def test_what_is_left_is_the_mean_of_reciprocal_distances() -> None:
    """By the crossings of rays with the outline, in all directions: what the sum of the weights stands for."""
    outline = blob(5, 40)
    field = Carrying.of(outline, np.ones(40, complex), REACH)
    ring = shapely.LinearRing(np.column_stack((outline.real, outline.imag)))
    t = (np.arange(4000) + 0.5) / 4000 * 2 * np.pi
    for point in (3 + 4j, -8 + 0j, outline[3] * 0.9):
        origin = (point.real, point.imag)
        total = 0.0
        for angle in t.tolist():
            ray = shapely.LineString([origin, (origin[0] + 99 * math.cos(angle), origin[1] + 99 * math.sin(angle))])
            met = sorted(abs(complex(*xy) - point) for xy in shapely.get_coordinates(ring.intersection(ray)).tolist())
            total += sum((-1) ** k / distance for k, distance in enumerate(met)) * (2 * np.pi / len(t))
        s = min(1.0, 2.0 / total / REACH)
        assert complex(field.shift(np.array([point]))[0]) == pytest.approx(1 - 3 * s**2 + 2 * s**3, abs=1e-4)


def test_the_outline_moves_as_it_is_told() -> None:
    """Its corners exactly, its edges linearly, and what is a nanometre beside it by a nanometre's difference."""
    field = carrying(1)
    corners, beyond = field.outline, np.roll(field.outline, -1)
    assert (field.shift(corners) == field.displacement).all()
    across = 1j * (beyond - corners) / np.abs(beyond - corners)
    for share in (0.5, 0.1, 0.999):
        right = field.displacement * (1 - share) + np.roll(field.displacement, -1) * share
        edges = corners * (1 - share) + beyond * share
        assert np.abs(field.shift(edges) - right).max() < 1e-12
        for off in (1e-12, 1e-9, 1e-6):
            assert np.abs(field.shift(edges + off * across) - right).max() < 1e3 * off + 1e-12


def test_what_is_far_stays() -> None:
    """Beside a straight edge beyond the reach, elsewhere beyond pi times it; and half of it moves half as much."""
    long = Carrying.of(np.array([-9e6, 9e6, 9e6 + 5e6j, -9e6 + 5e6j]), np.ones(4, complex), REACH)
    beside = long.shift(1j * REACH * np.array([0.0, 0.25, 0.5, 0.75, 0.999, 1.01]))
    assert np.abs(beside - [1, 0.84375, 0.5, 0.15625, 3e-6, 0]).max() < 1e-5
    field = Carrying.of(2 * blob(2), moved(2), 3.0)
    points = anywhere(np.random.default_rng(2), 90.0, 4000)
    ring = shapely.LinearRing(np.column_stack((field.outline.real, field.outline.imag)))
    far = shapely.distance(ring, shapely.points(points.real, points.imag)) > math.pi * field.reach
    assert 500 < np.count_nonzero(far) < 3500
    assert (field.shift(points[far]) == 0.0).all()
    assert (field(points[far]) == points[far]).all()


@pytest.mark.parametrize("seed", range(8))
def test_nothing_is_folded_by_displacements_small_beside_the_reach(seed: int) -> None:
    """A quarter of the reach, along bays and tongues: a fine net of triangles, each keeps its sense."""
    field = Carrying.of(blob(seed), moved(seed, size=REACH / 4), REACH)
    line = np.linspace(-55, 55, 100)
    net = line[:, None] + 1j * line
    image = field(net)
    right, up = np.diff(image, axis=0), np.diff(image, axis=1)
    for along, across in ((right[:, :-1], up[:-1]), (right[:, 1:], up[1:])):
        assert ((along.conj() * across).imag > 0).all()
    assert field.keeps_orientation(net).all()


def test_what_is_folded_is_seen() -> None:
    """A side that is pushed further than it reaches passes over what lies behind it."""
    square = np.array([0, 60, 60 + 60j, 60j])
    field = Carrying.of(square, np.array([20j, 20j, 0, 0]), 10.0)
    points = np.asarray(30 + 1j * np.linspace(0.5, 30, 60))
    flips = np.diff(field(points).imag) < 0
    found = ~field.keeps_orientation(points)
    assert flips.sum() > 5
    assert np.count_nonzero(found[:-1] != flips) <= 2


def test_derivatives_are_those_of_the_map() -> None:
    """Against differences of another step, along any direction, of any length; of none it is none."""
    field = carrying(3)
    rng = np.random.default_rng(3)
    points, directions = 0.8 * field.outline[:40], anywhere(rng, 4.0, 40)
    found = field.derivative(points, directions)
    step = 1e-4
    assert (
        np.abs((field(points + step * directions) - field(points - step * directions)) / (2 * step) - found).max()
        < 1e-6
    )
    assert (field.derivative(points, np.zeros(40, complex)) == 0.0).all()


@pytest.mark.parametrize(
    ("outline", "displacement", "reach", "said"),
    [
        ([0, 1], [0, 0], 1.0, "shape"),
        ([0, 1, 1j], [0, 0], 1.0, "shape"),
        ([0, 1, math.nan], [0, 0, 0], 1.0, "finite"),
        ([0, 1, 1j], [0, 0, math.inf], 1.0, "finite"),
        ([0, 1, 1j], [0, 0, 0], 0.0, "reach"),
        ([0, 1, 1j], [0, 0, 0], math.nan, "reach"),
    ],
)
def test_what_cannot_be_carried_is_refused(
    outline: list[complex], displacement: list[complex], reach: float, said: str
) -> None:
    """Too few points, other numbers of them, and what is no number."""
    with pytest.raises(ArgumentError, match=said):
        Carrying.of(np.array(outline, complex), np.array(displacement, complex), reach)


# --- paths -------------------------------------------------------------------------------------------------------


def apart(first: Complexes, second: Complexes) -> float:
    """The Hausdorff distance of two dense sets of points."""
    one, other = (np.column_stack((points.real, points.imag)) for points in (first, second))
    return float(max(cKDTree(one).query(other)[0].max(), cKDTree(other).query(one)[0].max()))


def drawing_lines() -> Paths:
    """Lines, curves and arcs across a blob; one closed, one far away."""
    return Paths.concatenate(
        [
            chain((-50 + 3j, 50 - 4j), (50 - 4j, 20 + 10j, 10 + 30j)),
            chain((0j, 10 + 20j, -20 + 20j, -5 - 20j), (-5 - 20j, -9 - 9j), (-9 - 9j, 0j), closed=True),
            arc(25 + 0j, 25j, -25 + 0j),
            chain((200 + 0j, 300 + 10j), (300 + 10j, 310 + 0j, 320 + 40j), (320 + 40j, 300j, 200j, 100j)),
        ]
    )


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("accuracy", [0.3, 0.02])
def test_paths_follow_the_map(seed: int, accuracy: float) -> None:
    """Dense points of the images lie on images of dense points, both ways, and few curves do; what moves is seen."""
    field = carrying(seed)
    paths = drawing_lines().take(np.arange(3))
    image = carried_paths(paths, field, accuracy=accuracy)
    step = accuracy / 4
    found = sampled(image, step)
    assert apart(found, field(sampled(paths, step))) < accuracy + step
    assert apart(found, sampled(paths, step)) > 0.5
    assert len(image.start) < 300


def test_a_finer_accuracy_has_more_curves_and_keeps_it() -> None:
    """Where the displacement turns within a few millimetres: points of each are as near to the other's chords."""
    line = chain((0.9 * blob(0)[3], 0.95 * blob(0)[17]), (0.95 * blob(0)[17], 0j, 0.9 * blob(0)[60]))
    field = Carrying.of(blob(0), moved(0) * np.exp(0.9j * np.sin(np.arange(120))), REACH)
    right = field(sampled(line, 5e-3))
    counts = []
    for accuracy in (1e-1, 1e-3, 1e-4):
        image = carried_paths(line, field, accuracy=accuracy)
        found = sampled(image, 5e-3)
        for points, others in ((found[::23], right), (right[::23], found)):
            chords = shapely.LineString(plane(others))
            shapely.prepare(chords)
            assert shapely.distance(chords, shapely.points(plane(points))).max() < accuracy + 1e-5
        counts.append(len(image.start))
    assert counts[0] < counts[1] < counts[2]


def test_paths_stay_whole() -> None:
    """Each segment begins where the one before ends, bit for bit, and closed paths stay closed."""
    image = carried_paths(drawing_lines(), carrying(0), accuracy=0.01)
    assert image.closed.tolist() == [False, True, False, False]
    for first, last, closed in zip(image.offsets[:-1], image.offsets[1:], image.closed, strict=True):
        assert (image.end[first : last - 1] == image.start[first + 1 : last]).all()
        assert not closed or image.end[last - 1] == image.start[first]


def test_joints_stay_smooth() -> None:
    """Where two curves have one tangent, their images have one too, wherever they were cut."""
    smooth = chain((-20 + 0j, -10 + 10j, 0 + 10j), (0 + 10j, 10 + 10j, 20 - 10j, 24 - 20j))
    image = carried_paths(smooth, carrying(4), accuracy=1e-3)
    assert len(image.start) > 8
    arriving, leaving = image.end - image.control[:, 1], image.control[:, 0] - image.start
    turn = np.angle(leaving[1:] / arriving[:-1])
    assert np.abs(turn).max() < 1e-6


def test_what_does_not_move_stays_as_it_is() -> None:
    """Bit for bit, kinds too; a line whose image is straight stays a line, and nothing of nothing is nothing."""
    paths = drawing_lines()
    far = paths.take(np.array([3]))
    image = carried_paths(far, carrying(0), accuracy=0.01)
    for name in ("start", "end", "control", "kind", "offsets", "closed"):
        assert (getattr(image, name) == getattr(far, name)).all()
    still = Carrying.of(blob(0), np.zeros(120, complex), REACH)
    image = carried_paths(paths, still, accuracy=0.01)
    assert len(image.start) == len(paths.start) - 1 + np.count_nonzero(image.owner == 2)
    assert not (image.kind == ARC).any()
    assert apart(sampled(image, 0.05), sampled(paths, 0.05)) < 0.06
    whole = Carrying.of(np.array([-9e3 - 9e3j, 9e3 - 9e3j, 9e3 + 9e3j, -9e3 + 9e3j]), np.full(4, 2 + 1j), 1e9)
    image = carried_paths(chain((0j, 5 + 5j), (5 + 5j, 9 + 0j)), whole, accuracy=1e-3)
    assert image.kind.tolist() == [LINE, LINE]
    assert np.abs(image.start - [2 + 1j, 7 + 6j]).max() < 1e-6
    assert len(carried_paths(Paths.empty(), still, accuracy=0.01)) == 0


# --- drawings ----------------------------------------------------------------------------------------------------

DRAWN = """
<path id="outline" d="M 20 10 H 80 V 40 H 20 Z" fill="#123456"/>
<g inkscape:groupmode="layer" inkscape:label="score" fill="none" stroke="#00a000" stroke-width="0.4">
  <path d="M 22 12 L 40 30"/><circle cx="30" cy="20" r="2" stroke="#ff0000" stroke-width="1"/></g>
<g inkscape:groupmode="layer" inkscape:label="Guide"><path d="M 0 0 H 9" stroke="#000"/></g>
<path d="M 60 20 h 4 v 4 h -4 z m 1 1 h 1 v 1 h -1 z" fill="#0000ff" stroke="#00ff00"/>
"""
CORNERS = np.array([20 + 10j, 80 + 10j, 80 + 40j, 20 + 40j])


def carried(drawing: ReadDrawing, displacement: complex) -> tuple[ReadDrawing, complex, tuple[str, ...]]:
    """The art of a drawing whose first shape, the outline, is moved as a whole; read again."""
    field = Carrying.of(CORNERS, np.full(4, displacement), 6.0)
    art = carried_art(drawing, "bird.svg", drawing.shapes[0], field)
    assert art == carried_art(drawing, "bird.svg", drawing.shapes[0], field)
    again = drawing_of(art.svg, "art.svg")
    assert again.unit_known
    assert len(again.shapes) == art.shapes
    return again, art.corner, art.notes


def test_art_has_all_but_the_outline_and_guides() -> None:
    """Their order, layers, colours and widths are those of the drawing, and nothing moves where nothing is moved."""
    drawing = svg(DRAWN)
    art, corner, notes = carried(drawing, 0j)
    kept = [shape for shape in drawing.shapes[1:] if shape.layer != "Guide"]
    assert (corner, notes, art.width, art.height) == (0j, (), 100.0, 50.0)
    assert len(kept) == 3
    for before, after in zip(kept, art.shapes, strict=True):
        for name in ("layer", "stroke", "fill"):
            assert getattr(before, name) == getattr(after, name)
        assert after.stroke is None or after.stroke_width == pytest.approx(before.stroke_width)
        assert len(before.paths) == len(after.paths)
        assert apart(sampled(before.paths, 0.02), sampled(after.paths, 0.02)) < 0.02


def test_art_is_carried() -> None:
    """Each curve goes where the map takes it, by samples; those in the middle of the outline least."""
    drawing = svg(DRAWN)
    art, _, _ = carried(drawing, 2 - 1j)
    field = Carrying.of(CORNERS, np.full(4, 2 - 1j), 6.0)
    for k, (before, after) in enumerate(zip([drawing.shapes[k] for k in (1, 2, 4)], art.shapes, strict=True)):
        right = field(sampled(before.paths, 0.01))
        assert apart(sampled(after.paths, 0.01), right) < 0.015
        assert k == 2 or apart(sampled(before.paths, 0.01), right) > 0.1


def test_art_that_leaves_the_page_moves_its_corner() -> None:
    """The page grows by whole millimetres, and the corner says where it begins now."""
    drawing = svg(DRAWN.replace("M 22 12 L 40 30", "M 20 10 L -3.5 70"))
    art, corner, _ = carried(drawing, 0j)
    assert (corner, art.width, art.height) == (-4 - 20j, 104.0, 70.0)
    assert art.shapes[0].paths.end[0] + corner == pytest.approx(drawing.shapes[1].paths.end[0], abs=1e-6)


def test_what_is_not_carried_is_said() -> None:
    """Texts and images are counted with the file's name, and shapes that come out folded are named; else nothing is."""
    drawing = svg(DRAWN + '<text x="1" y="9">a</text><image href="a.png" width="5" height="5"/>')
    assert any("bird.svg" in note and "text (1)" in note and "image (1)" in note for note in carried(drawing, 0j)[2])
    folding = Carrying.of(CORNERS, np.array([20j, 20j, 0, 0]), 6.0)
    drawing = svg('<path d="M 20 10 H 80 V 40 H 20 Z"/><path id="eye" d="M 50 38 L 50 36" stroke="#000"/>')
    notes = carried_art(drawing, "bird.svg", drawing.shapes[0], folding).notes
    assert len(notes) == 1
    assert "1 shape" in notes[0]
    assert "'eye'" in notes[0]


def test_the_tile_is_a_guide() -> None:
    """On a layer of its own, which designs leave out of the art."""
    drawing = svg(DRAWN)
    field = Carrying.of(CORNERS, np.zeros(4, complex), 6.0)
    tile = Paths.polylines([CORNERS], closed=True)
    art = drawing_of(carried_art(drawing, "b", drawing.shapes[0], field, guide=tile).svg, "art.svg")
    assert art.shapes[0].layer == "guide"
    assert np.abs(art.shapes[0].paths.start - CORNERS).max() < 1e-6
