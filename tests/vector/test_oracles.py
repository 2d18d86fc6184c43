"""Each oracle agrees with good results, and is seen to fail on broken ones."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import shapely
from helpers import boost, brute, fuzz, strategies
from helpers.designs import tampered

from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.design import Design
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.tiling import Tiling

Document = dict[str, Any]
Break = Callable[[Document], None]


def _design(group: str, *sites: list[dict[str, Any]], **cell: float) -> dict[str, Any]:
    cell = {"a": 60.0, **cell}
    return {"schema": 1, "group": group, "cell": cell, "site": [{"strokes": strokes} for strokes in sites]}


RING = {"circle": [30, 20], "radius": 12}
DESIGNS = {
    "p1 curve": _design("p1", [{"bezier": [[2, 8], [16, 34], [30, -12], [46, 14]]}], b=50.0, angle=75.0),
    "p4 segment": _design("p4", [{"segment": [[5, 3], [25, 11]]}]),
    "pg branches": _design("pg", [{"segment": [[5, 4], [40, 16]]}, {"segment": [[20, 18], [24, 2]]}], b=44.0),
    "p31m points": _design("p31m", [{"point": [20, 7]}, {"point": [22, 3]}]),
    "p6m mirror": _design("p6m", [{"segment": [[8, 0], [20, 0]]}]),
    "p2 ring and core": _design("p2", [RING], [{"segment": [[26, 18], [33, 24]]}], b=90.0, angle=80.0),
    "cmm far": _design("cmm", [{"segment": [[60005, -89995], [60011, -89979]]}], b=90.0),
    "pmm skew": _design("pmm", [{"segment": [[4, 100], [20, 400]]}], b=900.0),
}


@pytest.fixture(scope="module", params=list(DESIGNS))
def document(request: pytest.FixtureRequest) -> Document:
    """The outline document of each design."""
    return Design.from_dict(DESIGNS[request.param]).tessellate().document()


@pytest.fixture
def ring_document() -> Document:
    """A tile with a hole, and the tile in it."""
    return Design.from_dict(DESIGNS["p2 ring and core"]).tessellate().document()


def _brute(document: Document) -> list[str]:
    return brute.complaints(document, np.random.default_rng(1), points=300, edges=400)


# --- the brute-force oracle ---------------------------------------------------------------------------------


def test_brute_force_agrees(document: Document) -> None:
    """It finds nothing wrong with a right result."""
    assert _brute(document) == []


def _unit(document: Document) -> float:
    return float(max(abs(complex(*v)) for v in document["cell"]))


def _move_vertex(by: float) -> Break:
    def change(document: Document) -> None:
        ring = document["tiles"][0]["rings"][0]
        longest = max(
            range(len(ring)), key=lambda k: abs(complex(*ring[k]["points"][0]) - complex(*ring[k]["points"][-1]))
        )
        x, y = ring[longest]["points"][0]
        ring[longest]["points"][0] = ring[longest - 1]["points"][-1] = [
            x + by * _unit(document),
            y + by * _unit(document),
        ]

    return change


def _scale(factor: float) -> Break:
    def change(document: Document) -> None:
        for tile in document["tiles"]:
            for edge in (edge for ring in tile["rings"] for edge in ring):
                edge["points"] = [[x * factor, y * factor] for x, y in edge["points"]]

    return change


def _swap_neighbours(document: Document) -> None:
    edges = [edge for ring in document["tiles"][0]["rings"] for edge in ring]
    other = next(edge for edge in edges if edge["neighbour"] != edges[0]["neighbour"])
    edges[0]["neighbour"], other["neighbour"] = other["neighbour"], edges[0]["neighbour"]


def _foreign_neighbour(document: Document) -> None:
    document["tiles"][0]["rings"][0][0]["neighbour"]["operation"] = "x+1/3,y"


def _bend(document: Document) -> None:
    edges = [edge for tile in document["tiles"] for ring in tile["rings"] for edge in ring]
    curve = max(
        (edge for edge in edges if edge["kind"] == "parabola"),
        key=lambda edge: abs(complex(*edge["points"][0]) - complex(*edge["points"][2])),
    )
    curve["points"][1][0] += 1e-9 * _unit(document)


def _straighten(document: Document) -> None:
    edges = [edge for tile in document["tiles"] for ring in tile["rings"] for edge in ring]
    for edge in edges:
        if edge["kind"] == "parabola":
            edge.update(kind="line", points=[edge["points"][0], edge["points"][2]])


def _wrong_focus(document: Document) -> None:
    edges = [edge for tile in document["tiles"] for ring in tile["rings"] for edge in ring]
    for edge in edges:
        if edge["kind"] == "parabola":
            edge["focus"][0] += 1e-8


def _open_ring(document: Document) -> None:
    point = document["tiles"][0]["rings"][0][0]["points"][0]
    point[0] = float(np.nextafter(point[0], np.inf))


def _other_symmetry(document: Document) -> None:
    document["tiles"][0]["symmetry"] = ["x,y", "-x,-y"]


def _more_copies(document: Document) -> None:
    document["tiles"][0]["copies_per_cell"] *= 2


def _wrong_area(document: Document) -> None:
    document["tiles"][0]["area"] *= 1 + 1e-9


def _drop_hole(document: Document) -> None:
    tile = max(document["tiles"], key=lambda tile: len(tile["rings"]))
    tile["rings"].pop()


def _reverse_hole(document: Document) -> None:
    tile = max(document["tiles"], key=lambda tile: len(tile["rings"]))
    tile["rings"][-1] = [{**edge, "points": edge["points"][::-1]} for edge in reversed(tile["rings"][-1])]


def _exchange_tiles(document: Document) -> None:
    one, two = document["tiles"]
    one["rings"], two["rings"] = two["rings"], one["rings"]
    one["area"], two["area"] = two["area"], one["area"]


BREAKS: dict[str, tuple[Break, str]] = {
    "a vertex moved by 1e-9 of the cell": (_move_vertex(1e-9), "off from"),
    "scaled by 1 + 1e-9": (_scale(1 + 1e-9), "area"),
    "neighbours swapped": (_swap_neighbours, "off from"),
    "a neighbour that is no operation": (_foreign_neighbour, "no operation"),
    "a control point bent": (_bend, "off from"),
    "curves made straight": (_straighten, "area"),
    "a wrong focus": (_wrong_focus, "focus"),
    "a ring open by one ulp": (_open_ring, "not closed"),
    "a symmetry that is none": (_other_symmetry, "symmetries"),
    "too many copies": (_more_copies, "copies per cell"),
    "a wrong area": (_wrong_area, "the area is"),
    "the hole dropped": (_drop_hole, "not its own"),
    "the hole reversed": (_reverse_hole, "area"),
    "the tiles exchanged": (_exchange_tiles, "nearest site"),
}


@pytest.mark.parametrize("name", list(BREAKS))
def test_brute_force_sees(name: str, ring_document: Document) -> None:
    """It complains about a broken result, and says what is wrong."""
    change, word = BREAKS[name]
    assert _brute(ring_document) == []
    change(ring_document)
    assert any(word in line for line in _brute(ring_document)), _brute(ring_document)


@pytest.mark.parametrize("by", [1e-6, 1e-9, 1e-11])
def test_brute_force_sees_a_moved_vertex_in_every_design(document: Document, by: float) -> None:
    """A vertex that is a little off shows, in any group."""
    broken = copy.deepcopy(document)
    _move_vertex(by * (1 if "6000" not in str(document["tiles"][0]["elements"]) else 1e3))(broken)
    assert _brute(broken) != []


def test_brute_force_has_the_17_groups() -> None:
    """Its groups, made from rotations and mirrors, are those of the International Tables' triplets."""
    assert list(brute.GENERATORS) == list(GROUPS)
    for name, group in GROUPS.items():
        theirs = {brute.read_operation(name, str(operation)) for operation in group.operations}
        assert theirs == set(brute.motions(name))


@pytest.mark.parametrize("group", list(GROUPS))
def test_brute_force_moves_points_as_the_operations_say(group: str) -> None:
    """Its motions take fractional coordinates where the triplets take them."""
    lattice = GROUPS[group].lattice(7.0, None if GROUPS[group].fixes_b else 5.0, 70.0)
    plane = brute.Plane(group, lattice.a, lattice.b, {"s": [[0, 0, 1, 1]]})
    for operation in GROUPS[group].operations:
        shifted = operation.translated(2, -3)
        motion = brute.read_operation(group, str(shifted))
        z = np.array([1.3 + 0.7j, -4 + 2j])
        assert plane.push(motion, z) == pytest.approx(lattice.isometry(shifted)(z), abs=1e-13)
        assert plane.pull(motion, plane.push(motion, z)) == pytest.approx(z, abs=1e-13)


@pytest.mark.parametrize("text", ["x+1/3,y", "y,x", "-x,y", "2x,y", "x,-y+1/2"])
def test_brute_force_knows_what_does_not_belong(text: str) -> None:
    """An operation of another group is refused."""
    with pytest.raises(ValueError, match="no operation of p4"):
        brute.read_operation("p4", text)


def test_brute_force_looks_at_enough_copies() -> None:
    """Its block of copies is generous: it finds the nearest copy of a far larger block, on long and skew cells too."""
    rng = np.random.default_rng(3)
    for group, cell in (("p2", (1.0, 300.0, 7.0)), ("p1", (1.0, 1.0, 175.0)), ("p3", (1.0, None, None))):
        lattice = GROUPS[group].lattice(*cell)
        ends = lattice.cartesian(0.1, 0.2), lattice.cartesian(0.3, 0.35)
        plane = brute.Plane(
            group, lattice.a, lattice.b, {"s": [[ends[0].real, ends[0].imag, ends[1].real, ends[1].imag]]}
        )
        z = rng.uniform(-1, 1, 20) * lattice.a + rng.uniform(-1, 1, 20) * lattice.b
        block = plane.around(z)
        nearest = np.full(20, np.inf)
        np.minimum.at(nearest, block.point, block.distance)
        p, q = plane.reduced
        best = np.full(20, np.inf)
        for motion in brute.motions(group):
            for j in range(-9, 10):
                extra = (np.arange(-400, 401)[:, None] * p + j * q).astype(np.complex128)
                distances = plane.distance(0, plane.pull(motion, z, extra).ravel()).reshape(-1, 20)
                best = np.minimum(best, distances.min(axis=0))
        assert nearest == pytest.approx(best, rel=1e-12)


def test_brute_force_tells_inside_from_outside(document: Document) -> None:
    """Its ray test agrees with shapely's polygons away from the border."""
    rng = np.random.default_rng(4)
    for tile, outline in zip(document["tiles"], _outlines(document), strict=True):
        shape = brute.Shape(tile)
        x0, x1, y0, y1 = shape.box
        z = rng.uniform(x0, x1, 2000) + 1j * rng.uniform(y0, y1, 2000)
        where = shapely.points(z.real, z.imag)
        clear = shapely.distance(outline.boundary, where) > 1e-4 * _unit(document)
        assert clear.sum() > 1000
        assert (shape.contains(z[clear]) == shapely.contains(outline, where[clear])).all()
        assert sum(shape.ring_areas()) == pytest.approx(outline.area, rel=1e-6)


def _outlines(document: Document) -> list[Any]:
    polygons = []
    for tile in document["tiles"]:
        shape = brute.Shape(tile)
        t = np.linspace(0, 1, 200, endpoint=False)
        points = np.split(
            shape.at(np.repeat(np.arange(len(shape.edges)), 200), np.tile(t, len(shape.edges))),
            np.cumsum(shape.sizes)[:-1] * 200,
        )
        polygon = shapely.Polygon()
        for ring in points:
            polygon = polygon.symmetric_difference(shapely.Polygon(np.stack([ring.real, ring.imag], axis=-1)))
        polygons.append(polygon)
    return polygons


def test_brute_force_finds_symmetries() -> None:
    """It counts the motions that map a site onto itself."""
    square = [[1, 0, 0, 1], [0, 1, -1, 0], [-1, 0, 0, -1], [0, -1, 1, 0]]
    assert len(brute.Plane("p4m", 9, 9j, {"s": square}).symmetries(0)) == 8
    assert len(brute.Plane("p4m", 9, 9j, {"s": square[:3]}).symmetries(0)) == 2
    nearly = [[1 + 1e-10, 0, 0, 1], *square[1:]]
    assert len(brute.Plane("p4m", 9, 9j, {"s": nearly}).symmetries(0)) == 1


# --- Boost --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [name for name in DESIGNS if name != "pmm skew"])
def test_boost_agrees(name: str) -> None:
    """Areas and corners are Boost's, as far as its integers go."""
    assert boost.complaints(Design.from_dict(DESIGNS[name]).tessellate().document()) == []


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (_move_vertex(1e-4), "corners"),
        (_scale(1 + 1e-5), "area"),
        (_straighten, "area"),
        (_drop_hole, "area"),
        (_exchange_tiles, "area"),
    ],
)
def test_boost_sees(change: Break, word: str, ring_document: Document) -> None:
    """It complains about what is broken by more than its resolution."""
    change(ring_document)
    assert any(word in line for line in boost.complaints(ring_document))


@pytest.mark.parametrize("kind", ["plain", "grid", "polygon", "special", "points", "several"])
def test_boost_agrees_on_random_designs(kind: str) -> None:
    """Designs of several kinds, drawn by numpy's generator."""
    done = 0
    for number in range(40):
        _, design = strategies.make_design(strategies.Dice(np.random.default_rng([5, number])), kind)
        try:
            found = Design.from_dict(design).tessellate().document()
        except TouchingCopiesError:
            continue
        # Where sites nearly touch, Boost's rounding makes them touch.
        plane = brute.Plane.of(found)
        if fuzz.contact(plane, 1e-5 * plane.size):
            continue
        assert boost.complaints(found) == [], design
        done += 1
        if done == 12:
            return
    pytest.fail("most designs were refused")


# --- the fuzz -----------------------------------------------------------------------------------------------


SEGMENT = DESIGNS["p4 segment"]


def test_the_fuzz_passes_what_is_right() -> None:
    """A good design is tiled, one that touches its copy is refused."""
    rng = np.random.default_rng(1)
    assert fuzz.try_design(SEGMENT, rng) == "tiled"
    assert fuzz.try_design(_design("p4", [{"segment": [[0, 0], [25, 11]]}]), rng) == "refused"


def test_the_fuzz_sees_a_wrong_tile(monkeypatch: pytest.MonkeyPatch) -> None:
    """A result that passes the proof but is wrong does not get by."""
    good = Tiling.document

    def broken(self: Tiling) -> Document:
        document = good(self)
        _scale(1 + 1e-6)(document)
        return document

    monkeypatch.setattr(Tiling, "document", broken)
    assert "area" in fuzz.try_design(SEGMENT, np.random.default_rng(1))


def test_the_fuzz_sees_a_traceback_and_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever comes out of the engine is a finding."""

    def broken(_: Tiling) -> Document:
        return {"x": np.float64(1) / np.zeros(1)}

    monkeypatch.setattr(Tiling, "document", broken)
    assert "RuntimeWarning" in fuzz.try_design(SEGMENT, np.random.default_rng(1))


def test_the_fuzz_sees_a_refusal_without_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    """Copies that do not touch, or touch elsewhere, or are one, may not be the reason."""

    def refuse(operation: str, place: complex) -> Callable[[Tiling], Document]:
        def document(_: Tiling) -> Document:
            raise TouchingCopiesError("site1", "site1", Operation.parse(operation), place)

        return document

    rng = np.random.default_rng(1)
    monkeypatch.setattr(Tiling, "document", refuse("-x,-y", 5 + 3j))
    assert "apart" in fuzz.try_design(SEGMENT, rng)
    monkeypatch.setattr(Tiling, "document", refuse("x,y", 5 + 3j))
    assert "onto itself" in fuzz.try_design(SEGMENT, rng)
    touching = tampered(
        Design.from_dict(SEGMENT), noded=Design.from_dict(_design("p4", [{"segment": [[0, 0], [25, 11]]}])).noded
    )
    for place, expected in ((0j, "refused"), (25 + 11j, "apart")):
        error = TouchingCopiesError("site1", "site1", Operation.parse("-x,-y"), place)
        assert expected in fuzz._refusal(touching, error)


def test_the_fuzz_sees_copies_that_touch() -> None:
    """A design that should have been refused is noticed by shapely."""
    crossing = brute.Plane("pm", 10, 10j, {"s": [[-1, 2, 3, 5]]})
    apart = brute.Plane("pm", 10, 10j, {"s": [[1e-9, 2, 3, 5]]})
    assert "apart" in fuzz.contact(crossing, 0.0)
    assert fuzz.contact(apart, 1e-14) == ""
    assert "apart" in fuzz.contact(apart, 1e-8)
    # Two sites; copies across the far side of a skew cell; a long site over many cells.
    assert fuzz.contact(brute.Plane("p1", 10, 10j, {"s": [[0, 0, 1, 1]], "t": [[15, 15, 21, 21]]}), 0.0)
    assert fuzz.contact(brute.Plane("p1", 1, 100 + 1j, {"s": [[0, 0, 0.5, 1.5]]}), 0.0) == ""
    assert fuzz.contact(brute.Plane("p1", 1, 100 + 1j, {"s": [[0, 0, 1.0, 1.5]]}), 0.0) == ""
    assert fuzz.contact(brute.Plane("p1", 1, 100 + 1j, {"s": [[0, 0, 1.0, 2.0]]}), 0.0)


def test_a_design_of_the_fuzz_is_reproducible() -> None:
    """The seed and the number determine it."""
    assert fuzz.design_of(7, 11) == fuzz.design_of(7, 11)
    assert fuzz.design_of(7, 11) != fuzz.design_of(7, 12)
    kinds = {fuzz.design_of(1, number)[0] for number in range(600)}
    groups = {fuzz.design_of(1, number)[1]["group"] for number in range(600)}
    assert kinds == set(strategies.KINDS)
    assert groups == set(GROUPS)
