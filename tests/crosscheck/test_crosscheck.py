"""The cross-check: what is sound passes, and what is broken fails by name, be it in the outlines or in the image."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache, partial
from typing import Any, assert_never

import numpy as np
import numpy.typing as npt
import pytest
from helpers import strategies
from helpers.examples import each_example
from helpers.examples import tiling as example
from hypothesis import HealthCheck, assume, given, settings

from voronoi_tiles.base.errors import DesignError, TouchingCopiesError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.tolerance import EPSILON, PROOF_LIMIT
from voronoi_tiles.crosscheck import CheckReport, comparison, crosscheck
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.starters import starter_text
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.raster import renderer as render
from voronoi_tiles.raster.frame import Frame, cell_frame
from voronoi_tiles.raster.renderer import LabelImage, Renderer
from voronoi_tiles.raster.scene import Pattern
from voronoi_tiles.tiling import Tiling
from voronoi_tiles.vector.all_arcs import AllArcs
from voronoi_tiles.vector.arcs import Arc, LineArc, Neighbour, ParabolaArc
from voronoi_tiles.vector.crossings import count_crossings
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.proof import open_joints
from voronoi_tiles.vector.scan import QUANTUM

Complexes = npt.NDArray[np.complex128]
Change = Callable[[Outline, float], Outline]
"""Break an outline, given the step between samples."""

FIGURES = ["labels", "coverage", "area", "crossings", "neighbours", "edges", "equidistance"]
SAMPLES = 256
KEY = "p4-key"  # 15 edges, all longer than ten steps, eight of them curved

RING = {
    "schema": 1,
    "group": "p4",
    "cell": {"a": 60.0},
    "site": [
        {"name": "ring", "strokes": [{"polyline": [[5, 4], [24, 9], [21, 25], [8, 22]], "closed": True}]},
        {"name": "core", "strokes": [{"segment": [[12, 14], [17, 16]]}]},
    ],
}
CROSS = {
    "schema": 1,
    "group": "p4",
    "cell": {"a": 60.0},
    "site": [{"strokes": [{"segment": [[-10, 0], [10, 0]]}, {"segment": [[0, -10], [0, 10]]}]}],
}


@cache
def ring() -> Tiling:
    """A tile with a hole, and the tile in it."""
    return Design.from_dict(RING).tessellate()


def check(tiling: Tiling, **options: Any) -> CheckReport:
    """Cross-check on the processor."""
    outlines = [tile.outline for tile in tiling.tiles]
    return crosscheck(tiling.design, outlines, **{"samples": SAMPLES, "renderer": "cpu", **options})


def step(tiling: Tiling, samples: int = SAMPLES) -> float:
    """The distance between samples."""
    return float(cell_frame(tiling.design.lattice, samples).pixel)


def broken(tiling: Tiling, change: Change, number: int = 0) -> Tiling:
    """Change the outline of one of the tiles."""
    tiles = list(tiling.tiles)
    tiles[number] = replace(tiles[number], outline=change(tiles[number].outline, step(tiling)))
    return replace(tiling, tiles=tuple(tiles))


def assert_sound(report: CheckReport) -> None:
    """Nothing is wrong, and nothing is marked; what is measured keeps its limit."""
    assert report.passed, [(figure.name, figure.wrong, figure.worst, figure.limit) for figure in report.figures]
    assert report.failures == ()
    assert [figure.name for figure in report.figures] == FIGURES
    for figure in report.figures:
        assert figure.passed
        assert figure.wrong == 0 < figure.checked
        assert len(figure.marks.place) == len(figure.marks.excess) == 0
        assert figure.limit is None or (figure.worst is not None and 0.0 <= figure.worst <= figure.limit)


# --- what is sound -------------------------------------------------------------------------------------------


@each_example
def test_examples_agree(name: str) -> None:
    """No sample, no crossing and no edge is wrong, and all samples are looked at."""
    report = check(example(name), samples=512)
    assert_sound(report)
    assert report.figure("labels").checked == report.frame.width * report.frame.height
    assert report.figure("labels").checked == pytest.approx(512**2, rel=0.01)
    tiles = example(name).tiles
    assert report.figure("equidistance").checked == 4 * sum(len(tile.outline) for tile in tiles)
    assert report.figure("edges").checked == sum(len(tile.outline) * tile.copies_per_cell for tile in tiles)
    area = report.figure("area")
    assert area.checked == len(tiles)
    assert area.limit is None
    assert area.worst is not None
    assert area.worst < 0.01


@pytest.mark.parametrize("group", list(GROUPS))
def test_starters_agree(group: str) -> None:
    """All 17 groups, with sites that lie on centres and mirrors among them."""
    assert_sound(check(Design.loads(starter_text(group, None)).tessellate()))


@pytest.mark.parametrize("kind", list(strategies.KINDS))
def test_random_designs_agree(kind: str) -> None:
    """All kinds of designs, as those are drawn that are tried by the thousand."""
    tiled = 0
    for seed in range(1 if kind in {"long", "dense"} else 5):
        chance = strategies.Dice(np.random.default_rng([list(strategies.KINDS).index(kind), seed]))
        design = Design.from_dict(strategies.make_design(chance, kind)[1])
        try:
            tiling = design.tessellate()
        except TouchingCopiesError:
            continue
        tiled += 1
        assert_sound(check(tiling, samples=chance.pick((20, 90, 130))))
    assert tiled


@given(strategies.designs("plain", "grid", "polygon", "special", "points", "several"))
@settings(
    max_examples=12,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much, HealthCheck.data_too_large],
)
def test_drawn_designs_agree(design: dict[str, Any]) -> None:
    """Round numbers: ties, collinear and cocircular points."""
    read = Design.from_dict(design)
    try:
        tiling = read.tessellate()
    except TouchingCopiesError:
        assume(False)
        raise
    assert_sound(check(tiling, samples=64))


@pytest.mark.parametrize("exponent", [-9, -6, -4])
@pytest.mark.parametrize("twist", [1e-1, 1e-6, 1e-8, 1e-9, 1e-10])
def test_samples_near_corners_agree(twist: float, exponent: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A sample beside a corner, whatever meets there: also copies that nearly are the same, far from which none tells.

    The site is a pair of strokes that a rotation maps onto each other, but for this twist, relative to the cell. The
    sample is 10 to the power of the exponent from the corner, on the same scale.
    """
    rng = np.random.default_rng([round(-np.log10(twist)), -exponent])
    compared = 0
    for number in range(2):
        first, second = (complex(p, q) for p, q in rng.uniform([4, -8], [16, 8], (2, 2)).tolist())
        away = 60.0 * twist * np.exp(1j * rng.uniform(0.0, 6.0))
        strokes = [
            {"segment": [[z.real, z.imag] for z in ends]} for ends in ((first, second), (away - first, away - second))
        ]
        group = ("p2", "pgg")[number % 2]
        cell = {"a": 60.0, "b": 50.0} | ({"angle": 80.0} if group == "p2" else {})
        try:
            tiling = Design.from_dict(
                {"schema": 1, "group": group, "cell": cell, "site": [{"strokes": strokes}]}
            ).tessellate()
        except TouchingCopiesError:
            continue
        compared += check_beside_corners(tiling, 60.0 * 10.0**exponent, rng, monkeypatch)
    assert compared >= 3


@pytest.mark.parametrize("group", ["p3m1", "p4m", "p31m"])
def test_samples_near_centres_agree(group: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where six or eight tiles meet, far from two that nearly touch, and so also from their images.

    The last tie with the first, as far as rounding tells, though they share no edge.
    """
    compared = 0
    for number in range(8):
        rng = np.random.default_rng(number)
        design = strategies.make_design(strategies.Dice(rng), "beside a mirror", group)[1]
        try:
            tiling = Design.from_dict(design).tessellate()
        except TouchingCopiesError:
            continue
        compared += check_beside_corners(tiling, 10.0 ** rng.uniform(-6, -2), rng, monkeypatch)
    assert compared >= 3


def check_beside_corners(
    tiling: Tiling, distance: float, rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> int:
    """Cross-check with a sample at a distance from a corner, for three corners of the first tile; their number."""
    outline = tiling.tiles[0].outline
    still = cell_frame(tiling.design.lattice, 12)
    corners = np.flatnonzero(outline.neighbour != np.roll(outline.neighbour, 1))
    chosen = rng.permutation(outline.start[corners])[:3]
    for corner in chosen.tolist():
        beside = corner + distance * np.exp(1j * rng.uniform(0.0, 6.0))
        frame = replace(still, origin=still.origin + beside - complex(still.points(6, 6)))
        monkeypatch.setattr(comparison, "cell_frame", lambda *_, frame=frame, **__: frame)
        assert_sound(check(tiling, samples=12))
    return len(chosen)


@pytest.mark.usefixtures("opengl")
@pytest.mark.parametrize("name", ["p1-fish", "p3-puzzle", "p4g-fan", "p6-rosette"])
def test_opengl_agrees(name: str) -> None:
    """With float32 more samples are left open, and settled; the figures are the same."""
    report = check(example(name), renderer="gl")
    assert_sound(report)
    assert report.provenance.renderer == "gl"
    assert report.provenance.precision == "float32"
    assert report.provenance.spots > 0
    assert report.provenance.fallback == ""
    by_cpu = check(example(name))
    assert [figure.checked for figure in report.figures] == [figure.checked for figure in by_cpu.figures]
    assert [figure.worst for figure in report.figures[2:]] == [figure.worst for figure in by_cpu.figures[2:]]


def test_meshes_agree() -> None:
    """Hoff's cones and tents are coarse, so that many samples are left open; none of them is wrong."""
    report = check(ring(), method="hoff")
    assert_sound(report)
    assert report.provenance.method.startswith("hoff")
    assert report.figure("labels").basis != check(ring()).figure("labels").basis


@pytest.mark.usefixtures("opengl")
def test_meshes_by_opengl_agree() -> None:
    """The same on the device."""
    report = check(example(KEY), method="hoff", renderer="gl")
    assert_sound(report)
    assert report.provenance.renderer == "gl"


@pytest.mark.parametrize("samples", [1, 2, 3, 15, 16, 17, 100])
def test_few_samples_agree(samples: int) -> None:
    """Images of less than a block, with blocks that are not full, and with samples beside their own next copy."""
    for tiling in (ring(), example("pg-wave")):
        assert_sound(check(tiling, samples=samples))


@pytest.mark.parametrize("name", ["cmm-scroll", "p6-rosette", "pg-wave"])
def test_windows_agree(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """An image that is put together from windows gives the figures of the whole one."""
    whole = check(example(name), samples=129)
    monkeypatch.setattr(render, "WINDOW", 64)
    parts = check(example(name), samples=129)
    assert_sound(parts)
    assert [figure.checked for figure in parts.figures] == [figure.checked for figure in whole.figures]
    assert [figure.wrong for figure in parts.figures] == [figure.wrong for figure in whole.figures]


def test_a_site_far_from_the_origin_agrees() -> None:
    """A half turn about the origin takes a site half a million cells away to a place a million cells from it."""
    stroke = {"segment": [[4, 3], [17, 9]], "translate": [3e7, 6e7]}
    design = {"schema": 1, "group": "p2", "cell": {"a": 60, "b": 60, "angle": 90}, "site": [{"strokes": [stroke]}]}
    assert_sound(check(Design.from_dict(design).tessellate(), samples=100))


@pytest.mark.parametrize("group", ["p2", "p4", "p6"])
@pytest.mark.parametrize("cells", [1e7, 1e9])
def test_a_site_too_far_from_the_origin_is_refused(group: str, cells: float) -> None:
    """Whose copies cannot be numbered, however far it is, and however far they are from each other."""
    cell = {"a": 60, "b": 60, "angle": 90} if group == "p2" else {"a": 60}
    stroke = {"segment": [[4, 3], [17, 9]], "translate": [60 * cells, 0]}
    tiling = Design.from_dict({"schema": 1, "group": group, "cell": cell, "site": [{"strokes": [stroke]}]}).tessellate()
    with pytest.raises(DesignError, match="cells from the origin"):
        check(tiling, samples=20)


def halves(arc: Arc) -> list[Arc]:
    """Divide an arc in its middle (de Casteljau)."""
    match arc:
        case LineArc(start, end, neighbour):
            middle = (start + end) / 2
            return [LineArc(start, middle, neighbour), LineArc(middle, end, neighbour)]
        case ParabolaArc(start, control, end, focus, directrix, neighbour):
            first, second = (start + control) / 2, (control + end) / 2
            middle = (first + second) / 2
            return [
                ParabolaArc(start, first, middle, focus, directrix, neighbour),
                ParabolaArc(middle, second, end, focus, directrix, neighbour),
            ]
        case _:
            assert_never(arc)


def with_arc(outline: Outline, k: int, arcs: Sequence[Arc]) -> Outline:
    """Put other arcs in the place of arc k of the first ring."""
    rings = [list(arcs) for arcs in outline.rings]
    rings[0][k : k + 1] = arcs
    return Outline.from_rings(rings)


def divided(outline: Outline, _: float) -> Outline:
    """Divide every arc."""
    return Outline.from_rings([half for arc in arcs for half in halves(arc)] for arcs in outline.rings)


def begun_elsewhere(outline: Outline, _: float) -> Outline:
    """Begin each ring at another vertex, and list the neighbours in the order in which they appear."""
    return Outline.from_rings([*arcs[3:], *arcs[:3]] for arcs in outline.rings)


def renumbered(outline: Outline, _: float) -> Outline:
    """List the neighbours the other way round, and one more that has no edge."""
    stray = Neighbour("nobody", Operation.parse("x+1/2,y"))
    count = len(outline.neighbours)
    return replace(outline, neighbours=(*outline.neighbours[::-1], stray), neighbour=count - 1 - outline.neighbour)


@pytest.mark.parametrize("change", [divided, begun_elsewhere, renumbered])
def test_the_same_outline_written_otherwise_agrees(change: Change) -> None:
    """No other choice of arcs, first arcs and numbers is an error."""
    for tiling in (example(KEY), ring()):
        assert_sound(check(broken(tiling, change)))


def test_a_neighbour_has_many_names() -> None:
    """Where a symmetry maps a site onto itself, two operations give the same copy."""
    tiling = Design.from_dict(CROSS).tessellate()
    (tile,) = tiling.tiles
    assert len(tile.symmetry) == 4

    def change(outline: Outline, _: float) -> Outline:
        names = (Neighbour(site, operation @ tile.symmetry[1]) for site, operation in outline.neighbours)
        return replace(outline, neighbours=tuple(names))

    assert_sound(check(tiling))
    assert_sound(check(broken(tiling, change)))


def test_the_precision_of_the_image_does_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where an image leaves everything open, everything is settled in float64."""
    tamper(monkeypatch, lambda image: replace(image, first=image.second, error=lambda distance: 0.0 * distance + 1e9))
    report = check(example(KEY), samples=100)
    assert_sound(report)
    assert "10,000 times" in report.figure("labels").basis


# --- what is broken: the outlines ----------------------------------------------------------------------------


def before(outline: Outline, k: int) -> int:
    """The arc that leads to arc k."""
    place = int(np.searchsorted(outline.ring_offsets, k, side="right")) - 1
    first, stop = outline.ring_offsets[place : place + 2].tolist()
    return int(stop - 1 if k == first else k - 1)


def moved(outline: Outline, k: int, by: complex) -> Outline:
    """Move the vertex where arc k begins."""
    start, control, end = outline.start.copy(), outline.control.copy(), outline.end.copy()
    start[k] += by
    end[before(outline, k)] = start[k]
    control[~outline.curved] = ((start + end) / 2)[~outline.curved]
    return replace(outline, start=start, control=control, end=end)


def longest(outline: Outline, *, curved: bool) -> int:
    """The longest straight, or curved, arc."""
    return int(np.argmax(np.where(outline.curved == curved, outline.lengths, 0.0)))


def bent(outline: Outline, size: float) -> Outline:
    """Move a control point by a millionth of a step."""
    control = outline.control.copy()
    control[longest(outline, curved=True)] += 1e-6 * size
    return replace(outline, control=control)


def straightened(outline: Outline, _: float) -> Outline:
    """Put its chord in the place of a parabola."""
    curved = outline.curved.copy()
    curved[longest(outline, curved=True)] = False
    return replace(outline, curved=curved, control=np.where(curved, outline.control, (outline.start + outline.end) / 2))


def bulging(outline: Outline, size: float) -> Outline:
    """Divide a straight edge a millionth of a step beside it."""
    k = longest(outline, curved=False)
    start, end = complex(outline.start[k]), complex(outline.end[k])
    middle = (start + end) / 2 + 1e-6j * size * (end - start) / abs(end - start)
    name = outline.neighbours[outline.neighbour[k]]
    return with_arc(outline, k, [LineArc(start, middle, name), LineArc(middle, end, name)])


def badly_divided(outline: Outline, _: float) -> Outline:
    """Divide a parabola, and leave both halves the control point of the whole."""
    k = longest(outline, curved=True)
    control = complex(outline.control[k])
    parts = [replace(half, control=control) for half in halves(outline.rings[0][k]) if isinstance(half, ParabolaArc)]
    return with_arc(outline, k, parts)


def exchanged(outline: Outline, _: float) -> Outline:
    """Exchange two neighbours."""
    first, second, *others = outline.neighbours
    return replace(outline, neighbours=(second, first, *others))


def renamed(outline: Outline, _: float, *, site: str | None = None, operation: str | None = None) -> Outline:
    """The outline with another name or operation of a neighbour; without either, that of the copy in the next cell."""
    (name, there), *others = outline.neighbours
    other = Operation.parse(operation) if operation else there if site else there.translated(1, 0)
    return replace(outline, neighbours=(Neighbour(site or name, other), *others))


def shifted(outline: Outline, size: float, *, by: complex) -> Outline:
    """Move an outline by some steps."""
    start, control, end = (z + by * size for z in (outline.start, outline.control, outline.end))
    return replace(outline, start=start, control=control, end=end)


def scaled(outline: Outline, _: float) -> Outline:
    """Enlarge an outline about its middle."""
    middle = outline.start.mean()
    start, control, end = (middle + (1 + 1e-9) * (z - middle) for z in (outline.start, outline.control, outline.end))
    return replace(outline, start=start, control=control, end=end)


def turned_back(outline: Outline, _: float) -> Outline:
    """Walk around a ring the other way; the names stay with their edges."""
    columns = {name: getattr(outline, name)[::-1] for name in ("control", "curved", "focus", "directrix", "neighbour")}
    return replace(outline, start=outline.end[::-1], end=outline.start[::-1], **columns)


def spurred(outline: Outline, size: float, *, by: complex) -> Outline:
    """Go astray at a vertex, some steps out and back."""
    arc = outline.rings[0][3]
    tip = arc.start + by * size
    return with_arc(outline, 3, [LineArc(arc.start, tip, arc.neighbour), LineArc(tip, arc.start, arc.neighbour), arc])


def overshot(outline: Outline, size: float) -> Outline:
    """Follow a straight edge three steps beyond the corner of three copies, and back: equally far from two of them."""
    corner = outline.neighbour != np.roll(outline.neighbour, -1)
    k = int(np.argmax(np.where(corner & ~outline.curved, outline.lengths, 0.0)))
    arc = outline.rings[0][k]
    tip = arc.end + 3 * size * (arc.end - arc.start) / abs(arc.end - arc.start)
    return with_arc(outline, k, [arc, LineArc(arc.end, tip, arc.neighbour), LineArc(tip, arc.end, arc.neighbour)])


def without_ring(outline: Outline, _: float, *, number: int = 1) -> Outline:
    """Leave out a ring."""
    return Outline.from_rings(arcs for k, arcs in enumerate(outline.rings) if k != number)


BORDER = {"crossings", "equidistance"}
REGION = {"labels", "coverage"}

CASES: dict[str, tuple[Change, set[str], set[str]]] = {
    # What is done, the figures that must fail, and those that may.
    "a vertex moved": (lambda o, size: moved(o, 6, 1e-6j * size), BORDER, {"edges"}),
    "a vertex moved by a step": (lambda o, size: moved(o, 6, 1j * size), BORDER, {*REGION, "edges"}),
    "a control point moved": (bent, BORDER, {"edges"}),
    "a chord for a parabola": (straightened, BORDER | REGION, {"edges"}),
    "an edge divided beside it": (bulging, BORDER, {"edges"}),
    "a parabola divided badly": (badly_divided, BORDER | REGION, {"edges"}),
    "neighbours exchanged": (exchanged, {"neighbours", "edges", "equidistance"}, set()),
    "a neighbour in the next cell": (renamed, {"neighbours", "edges", "equidistance"}, set()),
    "no operation of the group": (
        partial(renamed, operation="x+1/2,y"),
        {"neighbours", "edges", "equidistance"},
        set(),
    ),
    "no site of the design": (partial(renamed, site="nobody"), {"neighbours", "edges", "equidistance"}, set()),
    "shifted a little": (partial(shifted, by=1e-6 + 0j), BORDER, {"edges"}),
    "shifted by three steps": (partial(shifted, by=3j), BORDER | REGION, {"edges"}),
    "scaled": (scaled, BORDER, {"edges"}),
    "turned back": (turned_back, REGION, set()),
    "a spur": (partial(spurred, by=20 + 0j), {"equidistance"}, {"edges"}),
    "an edge too long, and back": (overshot, {"equidistance"}, set()),
    "a spur of a millionth": (partial(spurred, by=1e-6 + 0j), {"equidistance"}, {"edges"}),
}


@pytest.mark.parametrize("name", list(CASES))
def test_a_broken_outline_is_seen(name: str) -> None:
    """The figures named fail, with marks, and no others but such as follow."""
    change, must, may = CASES[name]
    report = check(broken(example(KEY), change))
    assert not report.passed
    assert must <= set(report.failures) <= must | may
    for figure in report.figures:
        assert (figure.name in report.failures) == (figure.wrong > 0)
        assert len(figure.marks.place) > 0 or figure.wrong == 0
        if figure.wrong and figure.limit is not None:
            assert figure.worst is not None
            assert figure.worst > figure.limit


RING_CASES: dict[str, tuple[Change, int, set[str], set[str]]] = {
    "the hole dropped": (without_ring, 0, {*REGION, "crossings"}, set()),
    "the border dropped": (partial(without_ring, number=0), 0, {*REGION, "crossings"}, set()),
    "one of two sites shifted a little": (partial(shifted, by=1e-6j), 1, BORDER, {"edges"}),
    "one of two sites shifted": (partial(shifted, by=3 + 0j), 1, BORDER | REGION, {"edges"}),
    "the other's name": (partial(renamed, site="core"), 0, {"neighbours", "edges", "equidistance"}, set()),
}


@pytest.mark.parametrize("name", list(RING_CASES))
def test_a_broken_tile_of_two_is_seen(name: str) -> None:
    """The same, for a design of two sites, one around the other."""
    change, number, must, may = RING_CASES[name]
    failures = set(check(broken(ring(), change, number)).failures)
    assert must <= failures <= must | may


def test_exchanged_tiles_are_seen() -> None:
    """Each site with the tile of the other: the plane is covered, but by the wrong ones."""
    failures = check(replace(ring(), tiles=ring().tiles[::-1])).failures
    assert {"labels", "crossings", "neighbours", "equidistance"} <= set(failures)
    assert "coverage" not in failures


def test_every_figure_is_seen_to_fail() -> None:
    """A figure that is added needs a case here; areas are no figure to fail."""
    seen = set().union(*(case[1] for case in CASES.values()))
    assert seen == set(FIGURES) - {"area"}


@pytest.mark.parametrize("k", range(15))
def test_every_vertex_counts(k: int) -> None:
    """Each is moved by a millionth of a step, wherever to."""
    assert len(example(KEY).tiles[0].outline) == 15
    away = np.exp(2j * np.pi * np.random.default_rng(k).random())
    failures = check(broken(example(KEY), lambda o, size: moved(o, k, 1e-6 * size * away))).failures
    assert {"crossings", "equidistance"} <= set(failures) <= {"crossings", "equidistance", "edges"}


@pytest.mark.parametrize("k", range(0, 300, 37))
def test_vertices_of_short_edges_count(k: int) -> None:
    """Edges that are shorter than a step meet no line of samples; their own points tell."""
    tiling = example("p6-rosette")
    failures = check(broken(tiling, lambda o, size: moved(o, k % len(o), 1e-6j * size), k % 2), samples=40).failures
    assert "equidistance" in failures
    assert set(failures) <= {"crossings", "equidistance", "edges"}


def test_strangers_beyond_short_edges_are_seen() -> None:
    """An edge between two samples that names nobody's copy."""

    def change(outline: Outline, _: float) -> Outline:
        neighbour = outline.neighbour.copy()
        neighbour[outline.lengths.argmin()] = len(outline.neighbours)
        stranger = Neighbour(outline.neighbours[0].site, Operation.parse("x+1/3,y"))
        return replace(outline, neighbours=(*outline.neighbours, stranger), neighbour=neighbour)

    report = check(broken(example("p6-rosette"), change), samples=20)
    assert report.failures == ("neighbours", "equidistance")
    assert report.figure("neighbours").wrong == 1


@pytest.mark.parametrize("k", [0, 4, 8, 12])
def test_how_small_a_break_is_seen(k: int) -> None:
    """A vertex that is moved by more than a hundred-millionth of a step, and in fact by far less: see the limit."""
    tiling = example(KEY)
    away = np.exp(2j * np.pi * np.random.default_rng(100 + k).random())

    def seen(size: float) -> bool:
        return not check(broken(tiling, lambda o, pixel: moved(o, k, size * pixel * away)), samples=100).passed

    low, high = 1e-13, 1e-8
    assert not seen(low)
    assert seen(high)
    while high / low > 2.0:
        middle = (low * high) ** 0.5
        low, high = (low, middle) if seen(middle) else (middle, high)
    limit = check(tiling, samples=100).figure("equidistance").limit
    assert limit is not None
    assert 0.25 * limit < high * step(tiling, 100) < 10 * limit


@pytest.mark.usefixtures("opengl")
def test_a_broken_outline_is_seen_by_opengl() -> None:
    """The smallest break and a large one."""
    for name in ("a vertex moved", "a chord for a parabola"):
        change, must, may = CASES[name]
        failures = set(check(broken(example(KEY), change), renderer="gl").failures)
        assert must <= failures <= must | may


@pytest.mark.parametrize("by", [1e-6, 1e-3, 1.0])
def test_sites_moved_between_the_stages_are_seen(by: float) -> None:
    """The outline is that of another design, one of whose strokes begins a little farther on."""
    changed = json.loads(json.dumps(RING))
    changed["site"][1]["strokes"][0]["segment"][0][0] += by * step(ring())
    failures = set(check(replace(ring(), design=Design.from_dict(changed))).failures)
    assert {"crossings", "equidistance"} <= failures
    assert ("labels" in failures) == (by == 1.0)
    assert "coverage" not in failures


def test_a_lost_symmetry_is_seen() -> None:
    """The outline is that of a site that its group maps onto itself; the site drawn is none."""
    changed = json.loads(json.dumps(CROSS))
    changed["site"][0]["strokes"][0]["segment"][1][0] += 1e-3
    tiling = Design.from_dict(CROSS).tessellate()
    failures = check(replace(tiling, design=Design.from_dict(changed))).failures
    assert {"labels", "coverage", "neighbours", "equidistance"} <= set(failures)


def test_an_outline_elsewhere_is_seen() -> None:
    """An outline that has moved by a cell covers the plane, but no edge is near its site."""
    tiling = example(KEY)
    across = tiling.design.lattice.a / step(tiling)
    failures = check(broken(tiling, partial(shifted, by=across))).failures
    assert {"labels", "crossings", "equidistance"} <= set(failures)
    assert "coverage" not in failures


@pytest.mark.parametrize("by", [1.0, 3j])
def test_an_open_ring_is_refused(by: complex) -> None:
    """It has no inside."""

    def change(outline: Outline, size: float) -> Outline:
        end = outline.end.copy()
        end[3] += by * size
        return replace(outline, end=end)

    with pytest.raises(ValueError, match="is open: it has a gap"):
        check(broken(example(KEY), change))


# --- where the cross-check is blind, and the proof is not ----------------------------------------------------


def test_a_retraced_edge_is_seen_by_the_proof() -> None:
    """Along an edge, back and along it again: no sample, no crossing and no distance differs."""

    def change(outline: Outline, _: float) -> Outline:
        k = longest(outline, curved=False)
        arc = outline.rings[0][k]
        return with_arc(outline, k, [arc, LineArc(arc.end, arc.start, arc.neighbour), arc])

    tiling = broken(example(KEY), change)
    assert check(tiling).passed
    assert count_crossings(AllArcs.of([tiling.tiles[0].outline]), abs(tiling.design.lattice.a)) > 0


def test_a_gap_along_an_edge_is_seen_by_the_proof() -> None:
    """An edge that ends a millionth of a step too early is where it should be."""

    def change(outline: Outline, size: float) -> Outline:
        k = longest(outline, curved=False)
        end = outline.end.copy()
        end[k] += 1e-6 * size * (outline.start[k] - end[k]) / abs(outline.start[k] - end[k])
        return replace(outline, end=end)

    tiling = broken(example(KEY), change)
    assert check(tiling).passed
    assert open_joints(AllArcs.of([tiling.tiles[0].outline])) == 1


def test_a_hole_between_samples_is_seen_by_the_proof() -> None:
    """A hole that is dropped goes unseen only where no sample lies in it: finer samples do."""
    strokes = [{"circle": [20, 20], "radius": 0.2}], [{"point": [20, 20]}]
    sites = [{"strokes": part, "tolerance": 0.005} for part in strokes]
    cell = {"a": 60, "b": 60, "angle": 90}
    whole = Design.from_dict({"schema": 1, "group": "p1", "cell": cell, "site": sites}).tessellate()
    tiling = broken(whole, without_ring)
    assert_sound(check(whole, samples=1000))
    assert check(tiling, samples=100).passed
    assert {"labels", "coverage", "crossings"} <= set(check(tiling, samples=1000).failures)
    assert abs(sum(tile.area for tile in tiling.tiles) / 3600 - 1) > 1e6 * PROOF_LIMIT


# --- what is broken: the image -------------------------------------------------------------------------------


def tamper(monkeypatch: pytest.MonkeyPatch, change: Callable[[LabelImage], LabelImage]) -> None:
    """Change every image that is rendered."""
    sound = Renderer.render

    def rendered(renderer: Renderer, pattern: Pattern, frame: Frame) -> LabelImage:
        return change(sound(renderer, pattern, frame))

    monkeypatch.setattr(Renderer, "render", rendered)


def test_a_coarse_image_hides_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where an image decides nothing, the wrong samples of a broken outline are the same."""
    tiling = broken(example(KEY), straightened)
    fine = check(tiling)
    tamper(monkeypatch, lambda image: replace(image, error=lambda distance: 0.0 * distance + 1e9))
    coarse = check(tiling)
    assert coarse.failures == fine.failures
    for name in REGION:
        assert (coarse.figure(name).marks.place == fine.figure(name).marks.place).all()


def test_wrong_labels_beside_an_edge_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Samples a hundredth of a step from an edge are given to the copy beyond: each is marked, and nothing else."""
    wrong = []

    def change(image: LabelImage) -> LabelImage:
        gap = image.d2 - image.d1
        chosen = (gap < 0.01 * image.frame.pixel) & (gap > 2 * image.error(image.d2))
        row, column = np.nonzero(chosen)
        wrong.append(image.frame.points(column.astype(float), row.astype(float)))
        return replace(image, first=np.where(chosen, image.second, image.first).astype(np.int32))

    tamper(monkeypatch, change)
    report = check(example(KEY))
    assert len(wrong[0]) > 3
    assert "labels" in report.failures
    assert not {"coverage", "neighbours", "equidistance"} & set(report.failures)
    assert report.figure("labels").wrong == len(wrong[0])
    assert np.sort(report.figure("labels").marks.place) == pytest.approx(np.sort(wrong[0]))


@pytest.mark.parametrize("kind", ["a sample", "a block", "a corner", "other copies", "moved by a sample"])
def test_a_broken_image_is_seen(monkeypatch: pytest.MonkeyPatch, kind: str) -> None:
    """Labels of the copy beyond, in the middle of a tile and at the cell's corner; a wrong table; a shifted image."""

    def change(image: LabelImage) -> LabelImage:
        first, copies = image.first.copy(), image.copies
        match kind:
            case "other copies":
                copies = copies + np.array([0, 1, 0])
            case "moved by a sample":
                first = np.roll(first, 1, axis=1)
            case _:
                at = {"a sample": (100, 1), "a block": (100, 8), "a corner": (250, 6)}[kind]
                part = slice(at[0], at[0] + at[1])
                first[part, part] = image.second[part, part]
        return replace(image, first=first, copies=copies)

    tamper(monkeypatch, change)
    report = check(example(KEY))
    assert "labels" in report.failures
    assert not {"coverage", "equidistance"} & set(report.failures)


# --- what a report says --------------------------------------------------------------------------------------


def distance_to_images(tiling: Tiling, places: Complexes, points: Complexes) -> npt.NDArray[np.float64]:
    """The distance of each place from the nearest image of any of the points under the whole group."""
    lattice = tiling.design.lattice
    least = np.full(len(places), np.inf)
    for operation in tiling.design.group.operations:
        away = places[:, None] - lattice.isometry(operation)(points)
        x = np.round((away.real * lattice.b.imag - away.imag * lattice.b.real) / lattice.det)
        y = np.round((lattice.a.real * away.imag - lattice.a.imag * away.real) / lattice.det)
        least = np.minimum(least, np.abs(away - (x * lattice.a + y * lattice.b)).min(axis=1))
    return least


def points_of(outline: Outline, arcs: Sequence[int]) -> Complexes:
    """Many points of some arcs."""
    t = np.linspace(0.0, 1.0, 500)[:, None]
    start, control, end = outline.start[arcs], outline.control[arcs], outline.end[arcs]
    return np.asarray(((1 - t) ** 2 * start + 2 * t * (1 - t) * control + t * t * end).ravel())


@pytest.mark.parametrize("k", [1, 6, 12])
@pytest.mark.parametrize("size", [1e-6, 2.0])
def test_marks_lie_where_the_break_is(k: int, size: float) -> None:
    """On the edges that meet in the vertex, or beside them by no more than it was moved, in whichever copy."""
    tiling = example(KEY)
    outline = tiling.tiles[0].outline
    report = check(broken(tiling, lambda o, pixel: moved(o, k, size * pixel * 1j)))
    about = points_of(outline, [before(outline, k), k])
    assert set(report.failures) >= BORDER
    for name in report.failures:
        marks = report.figure(name).marks
        assert distance_to_images(tiling, marks.place, about).max() < (size + 1.5) * step(tiling)
        assert len(marks.excess) == len(marks.place) > 0
        assert not np.isnan(marks.excess).any()


def test_marks_of_a_region_lie_in_it() -> None:
    """Samples in the dropped hole, and all of them."""
    tiling = ring()
    report = check(broken(tiling, without_ring))
    hole = tiling.tiles[1]
    samples = hole.area * hole.copies_per_cell / report.frame.area_per_sample
    for name in ("labels", "coverage"):
        marks = report.figure(name).marks
        assert len(marks.place) == report.figure(name).wrong
        assert len(marks.place) == pytest.approx(samples, rel=0.05)
        around = np.abs(hole.outline.start - hole.outline.start.mean()).max()
        near = distance_to_images(tiling, marks.place, np.array([hole.outline.start.mean()]))
        assert near.max() < around + step(tiling)


def test_limits_follow_from_precision() -> None:
    """From what the outlines promise, float64's rounding, and for labels the scan's quantum; none from trial."""
    tiling = example(KEY)
    design = tiling.design
    accuracy = PROOF_LIMIT * abs(design.lattice.a)
    rounding = 16 * EPSILON * abs(design.lattice.a)
    assert rounding < accuracy / 100
    for options in ({}, {"method": "hoff"}, {"samples": 100}):
        report = check(tiling, **options)
        limits = {figure.name: figure.limit for figure in report.figures}
        quantum = QUANTUM * (abs(report.frame.u) + abs(report.frame.v))
        assert limits["labels"] == pytest.approx(2 * (accuracy + rounding + quantum), rel=1e-12)
        assert limits["equidistance"] == pytest.approx(accuracy + 4 * rounding, rel=1e-12)
        # The gradients of two distances are at most 2 apart.
        assert limits["crossings"] is not None
        assert (accuracy + 4 * rounding) / 2 <= limits["crossings"] <= (accuracy + 4 * rounding) * 1e3
        assert limits["edges"] == 2.0
        assert limits["coverage"] is limits["area"] is limits["neighbours"] is None
        for figure in report.figures:
            assert figure.what
            assert figure.basis
            assert figure.unit or figure.worst is None


def test_limits_scale_with_the_unit() -> None:
    """The same design 1024 times as large has the same report, but for the lengths."""
    large = json.loads(json.dumps(RING))
    large["cell"]["a"] *= 1024
    for site in large["site"]:
        for stroke in site["strokes"]:
            stroke["scale"] = 1024
    one, other = check(ring()), check(Design.from_dict(large).tessellate())
    for small, big in zip(one.figures, other.figures, strict=True):
        assert (small.checked, small.wrong) == (big.checked, big.wrong)
        if small.limit is not None and small.unit == one.units:
            assert big.limit == pytest.approx(1024 * small.limit, rel=0.5 if small.name == "crossings" else 1e-9)


@pytest.mark.parametrize("change", [None, exchanged, partial(shifted, by=3j)])
def test_a_report_is_a_document(change: Change | None) -> None:
    """JSON without infinities, whatever has failed, under names that stay."""
    tiling = broken(example(KEY), change) if change else example(KEY)
    report = check(tiling)
    document = json.loads(json.dumps(report.document(), allow_nan=False))
    assert " ".join(document) == (
        "passed samples sample_size units renderer device precision method fallback spot_checks figures"
    )
    assert document["passed"] == report.passed == (change is None)
    assert document["samples"] == [report.frame.width, report.frame.height] == [256, 256]
    assert document["sample_size"] == step(tiling)
    assert (document["units"], document["renderer"], document["precision"]) == ("mm", "cpu", "float64")
    assert (document["method"], document["fallback"], document["spot_checks"]) == ("exact", None, 0)
    assert document["device"] == "numpy"
    assert [row["name"] for row in document["figures"]] == FIGURES
    for row, figure in zip(document["figures"], report.figures, strict=True):
        assert " ".join(row) == "name what checked wrong worst limit unit basis passed places"
        assert row["passed"] == figure.passed == (row["wrong"] == 0)
        assert row["worst"] == figure.worst or (row["worst"] is None and figure.worst == np.inf)
        assert len(row["places"]) == min(len(figure.marks.place), 10)
        shown = np.array([complex(*place) for place in row["places"]])
        assert np.isin(shown, figure.marks.place).all()
        if len(figure.marks.place) > 10:
            excess = figure.marks.excess[np.isin(figure.marks.place, shown)]
            assert excess.max() == figure.marks.excess.max()


def test_figures_are_found_by_name() -> None:
    """One that does not exist is an error."""
    report = check(example(KEY), samples=20)
    assert [report.figure(name).name for name in FIGURES] == FIGURES
    with pytest.raises(KeyError, match="colour"):
        report.figure("colour")
