"""Jobs as a whole: what cannot be, curves in all formats read back, colours, the report's figures, the same bytes."""

from __future__ import annotations

import io
import json
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import ezdxf
import ezdxf.path
import numpy as np
import pytest
import shapely
from helpers.cutting import (
    contour_shapes,
    cuts,
    dense,
    exact_shape,
    farthest,
    lines_of,
    made,
    plane,
    squares,
    true_lengths,
    whole,
    work,
)
from helpers.examples import tiling
from svgelements import SVG
from svgelements import Path as SvgPath

from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.fabrication.job_report import report_figures
from voronoi_tiles.fabrication.layout import FRAME
from voronoi_tiles.fabrication.product import Product, make_several
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths


def written(product: Product) -> bytes:
    """The bytes of a product's file."""
    file = io.BytesIO()
    product.write(file)
    return file.getvalue()


# --- jobs that cannot be ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("job", "message"),
    [
        ({"kerf": 0.2, "edges": "once"}, "`kerf` needs `edges='pieces'`"),
        ({"gap": 1.0, "edges": "once"}, "`gap` needs `edges='pieces'`"),
        ({"fillet": 1.0, "edges": "once"}, "`fillet` needs `edges='pieces'`"),
        ({"colours": "layers", "edges": "once"}, "`colours` needs `edges='pieces'`"),
        ({"sheet": (100.0, 100.0), "fit": "frame", "kerf": 0.2}, "no room"),
        ({"sheet": (100.0, 100.0), "fit": "frame", "gap": 1.0}, "no room"),
        ({"sheet": (0.0, 100.0)}, "0 x 100 mm cannot be"),
        ({"sheet": (-5.0, 100.0)}, "-5 x 100 mm cannot be"),
        ({"sheet": (float("nan"), 100.0)}, "nan x 100 mm cannot be"),
        ({"sheet": (1e9, 100.0)}, "cannot be"),
        ({"sheet": (100.0, 100.0), "margin": 50.0}, "leaves nothing"),
        ({"kerf": -0.1}, "`kerf` -0.1 mm cannot be"),
        ({"kerf": float("nan")}, "`kerf` nan mm cannot be"),
        ({"tabs": float("inf")}, "`tabs` inf mm cannot be"),
        ({"accuracy": 0.0}, "`accuracy` 0 mm cannot be"),
        ({"accuracy": 1e-7}, "`accuracy` 1e-07 mm cannot be"),
        ({"rotate": float("nan")}, "`rotate` nan cannot be"),
        ({"rotate": 10**400}, r"`rotate` 1000.* cannot be. Give a finite number of degrees"),
        ({"offset": complex(float("inf"), 0)}, "not a number"),
        ({"label_height": 0.0}, "`label_height` 0 mm cannot be"),
        ({"fit": "clip"}, "`fit` is about a sheet"),
        ({"marks": True}, "`marks` is about a sheet"),
        ({"fit": "half", "sheet": (100.0, 100.0)}, "`fit` 'half' is unknown"),
        ({"edges": "twice"}, "`edges` 'twice' is unknown"),
        ({"curves": "nurbs"}, "`curves` 'nurbs' is unknown"),
        ({"labels": "names"}, "`labels` 'names' is unknown"),
        ({"colours": "red"}, "`colours` 'red' is unknown"),
        ({"art": "some"}, "`art` 'some' is unknown"),
    ],
)
def test_jobs_that_cannot_be(job: dict[str, Any], message: str) -> None:
    """Each is refused with one message and a remedy."""
    with pytest.raises(JobError, match=message) as caught:
        Job(**job)
    assert caught.value.remedy
    assert caught.value.remedy.endswith(".")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("job", "message"),
    [
        ({"sheet": (15.0, 100.0)}, "no whole tile fits on the sheet: one takes 20 x 20 mm"),
        ({"sheet": (15.0, 15.0), "fit": "frame"}, "no whole tile fits"),
        ({"sheet": (100.0, 100.0), "marks": True}, "`marks` need room"),
        ({"sheet": (100.0, 100.0), "bar": True, "margin": 8.0}, "no room at the sheet's edge"),
        ({"sheet": (200.0, 100.0), "bar": True}, "no room at the sheet's edge"),
        ({"sheet": (100.0, 100.0), "colours": "files"}, "several drawings"),
        ({"sheet": (100.0, 100.0), "kerf": 0.2, "only_colour": 7}, "no piece has the `only_colour` 7"),
        ({"sheet": (1.0, 100.0), "kerf": 0.9, "margin": 0.1}, "leaves nothing of a sheet"),
    ],
)
def test_jobs_that_a_tiling_cannot_do(job: dict[str, Any], message: str) -> None:
    """Each is refused with one message and a remedy."""
    with pytest.raises(JobError, match=message) as caught:
        squares().make(Job(**job))
    assert caught.value.remedy
    assert caught.value.remedy.endswith(".")
    with pytest.raises(JobError, match="no drawing can be made as 'stl'"):
        squares().make(Job(), "stl")


def test_recipes_say_what_differs() -> None:
    """A job's recipe is JSON, and makes the job again."""
    job = Job(sheet=(100.0, 80.0), kerf=0.2, offset=1 + 2j, gap=0.5, colours="layers")
    recipe = json.loads(json.dumps(job.recipe()))
    assert set(recipe) == {"sheet", "kerf", "offset", "gap", "colours"}
    again = {**recipe, "sheet": tuple(recipe["sheet"]), "offset": complex(*recipe["offset"])}
    assert Job(**again) == job
    assert Job().recipe() == {}
    product = squares().make(job)
    assert json.loads(product.drawing.recipe["job"]) == recipe


# --- curves -----------------------------------------------------------------------------------------------------


def exact_boundary(name: str, size: tuple[float, float]) -> Any:
    """The boundaries of the whole tiles on a sheet, from the group's operations, ten micrometres fine at most."""
    return shapely.union_all([copy.shape.boundary for copy in whole(plane(name, *size, 2e-4), *size)])


KINDS = {
    "exact": {LINE, QUAD},
    "arc": {LINE, ARC},
    "cubic": {LINE, CUBIC},
    "polyline": {LINE},
    "spline": {LINE, CUBIC},
}
FITTED = {"arc", "cubic", "polyline"}


@pytest.mark.parametrize("curves", sorted(KINDS))
@pytest.mark.parametrize(
    ("name", "edges"),
    [("p1-leaf", "once"), ("p1-leaf", "pieces"), pytest.param("pg-swallow", "once", marks=pytest.mark.slow)],
)
def test_curves_are_within_the_accuracy(name: str, edges: str, curves: str) -> None:
    """Of the exact tiles both ways, with fewer pieces where the accuracy is coarser."""
    size = (round(2.6 * abs(tiling(name).design.lattice.a), 1),) * 2
    exact = exact_boundary(name, size)
    counts = []
    for accuracy in (0.02, 0.2):
        paths = cuts(made(name, sheet=size, edges=edges, curves=curves, accuracy=accuracy))
        assert set(paths.kind.tolist()) <= KINDS[curves]
        bound = (accuracy if curves in FITTED else 1e-5) + 4e-4
        lines = shapely.multilinestrings(lines_of(paths))
        assert farthest(dense(lines, 0.5), exact) <= bound
        assert farthest(dense(exact, 0.5), lines) <= bound
        counts.append(len(paths.start))
    assert counts[1] < counts[0] if curves in FITTED else counts[1] == counts[0]


@pytest.mark.parametrize("curves", ["arc", "cubic", "polyline"])
def test_a_drawn_border_is_within_the_accuracy(tmp_path: Path, curves: str) -> None:
    """Of the waves that bound a sheet, as they were drawn: the errors of all that is done to them add up to no more."""
    corners = 10 + 10j + 60 * np.array([0, 1, 1 + 1j, 1j])
    t, waves, data = np.linspace(0.0, 1.0, 2000), [], f"M {corners[0].real} {corners[0].imag}"
    for a, d in zip(corners, np.roll(corners, -1), strict=True):
        b, c = a + (d - a) * (0.4 + 0.4j), a + (d - a) * (0.6 - 0.4j)
        data += f" C {b.real} {b.imag} {c.real} {c.imag} {d.real} {d.imag}"
        waves.append((1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t * t * (1 - t) * c + t**3 * d)
    sheet = tmp_path / "waves.svg"
    sheet.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="80mm" height="80mm" viewBox="0 0 80 80">'
        f'<path d="{data} Z" fill="none" stroke="#000"/></svg>'
    )
    drawn = np.concatenate(waves)
    paths = cuts(made("p1-leaf", sheet=str(sheet), fit="clip", curves=curves, accuracy=0.05))
    assert farthest(shapely.points(drawn.real, 80.0 - drawn.imag), shapely.multilinestrings(lines_of(paths))) <= 0.0502


def svg_lines(data: bytes) -> list[Any]:
    """The lines of an SVG file by svgelements, in millimetres, y up."""
    document = SVG.parse(io.BytesIO(data), ppi=25.4)
    found = []
    for element in document.elements():
        if isinstance(element, SvgPath):
            for part in element.as_subpaths():
                points = [
                    segment.point(t)
                    for segment in SvgPath(part)
                    for t in np.linspace(0, 1, 2 if "Line" in type(segment).__name__ else 200)
                ]
                found.append(shapely.LineString([(z.x, float(document.height) - z.y) for z in points if z is not None]))
    return found


def dxf_lines(data: bytes) -> list[Any]:
    """The lines of a DXF file by ezdxf."""
    document = ezdxf.read(io.StringIO(data.decode()))
    assert not document.audit().errors
    paths = [ezdxf.path.make_path(entity) for entity in document.modelspace()]
    return [shapely.LineString([(p.x, p.y) for p in path.flattening(1e-4)]) for path in paths]


@pytest.mark.parametrize(
    ("form", "curves", "read"),
    [
        ("svg", "exact", svg_lines),
        ("svg", "arc", svg_lines),
        ("svg", "cubic", svg_lines),
        ("svg", "polyline", svg_lines),
        ("dxf", "arc", dxf_lines),
        ("dxf", "spline", dxf_lines),
        ("dxf", "polyline", dxf_lines),
    ],
)
@pytest.mark.parametrize("job", [{}, {"kerf": 0.3}])
def test_files_hold_the_drawing(
    form: str, curves: str, read: Callable[[bytes], list[Any]], job: dict[str, float]
) -> None:
    """Read by others: as many contours, all closed, within the accuracy of the drawing, and of the exact tile."""
    product = made("p4-hook", form, curves=curves, edges="pieces", **job)
    lines = read(written(product))
    assert len(lines) == len(cuts(product))
    assert all(shapely.Point(line.coords[0]).distance(shapely.Point(line.coords[-1])) < 1e-5 for line in lines)
    (contour,) = (shapely.Polygon(line.coords) for line in lines)
    (drawn,) = contour_shapes(cuts(product))
    assert farthest(dense(contour.boundary, 0.2), drawn.boundary) <= 5e-4
    tile = exact_shape(tiling("p4-hook").tiles[0].outline, 1.0)
    grown = tile.buffer(job.get("kerf", 0.0) / 2, quad_segs=32)
    there = shapely.affinity.translate(
        grown, contour.centroid.x - grown.centroid.x, contour.centroid.y - grown.centroid.y
    )
    assert farthest(dense(contour.boundary, 0.2), there.boundary) <= 0.005 + 1e-3
    wrong = shapely.affinity.scale(there, 1.001, 1.001)
    assert farthest(dense(contour.boundary, 0.2), wrong.boundary) > 0.01


def test_dxf_has_no_cubic_curves() -> None:
    """The message says what to take instead."""
    with pytest.raises(JobError, match=r"no `curves='cubic'`\. Use arc, the fewest arcs, or spline"):
        squares().make(Job(curves="cubic"), "dxf")


def test_both_sides_of_an_edge_are_one_cubic_curve() -> None:
    """Pieces side by side: every segment within the sheet is there twice, bit for bit, in both senses."""
    paths = cuts(made("p1-leaf", sheet=(260.0, 260.0), edges="pieces", curves="cubic"))
    assert (paths.kind == CUBIC).any()
    forward = list(zip(paths.start, *paths.control.T, paths.end, strict=True))
    back = [(b, d, c, a) if c or d else (b, c, d, a) for a, c, d, b in forward]
    shared = len(set(forward) & set(back))
    assert shared > len(forward) / 2
    ends = {frozenset((a, b)) for a, _, _, b in forward}
    assert len(ends) == len(forward) - shared / 2


@pytest.mark.parametrize("form", ["svg", "dxf", "pdf", "lbrn2", "gcode"])
def test_files_are_written_in_all_formats(form: str) -> None:
    """The same bytes again, and others for another job."""
    job = Job(sheet=(90.0, 90.0), kerf=0.2, labels="number", preset="lightburn", colours="layers")
    job = replace(job, feed="300,engrave=3000", power="800,engrave=150")
    data = written(squares().make(job, form))
    head = {"svg": b"<?xml", "dxf": b"999\nrecipe", "pdf": b"%PDF", "lbrn2": b"<?xml", "gcode": b"; title"}[form]
    assert data.startswith(head)
    assert written(squares().make(job, form)) == data
    assert written(squares().make(replace(job, kerf=0.21), form)) != data


# --- colours ----------------------------------------------------------------------------------------------------


def sides(shapes: list[Any]) -> set[tuple[int, int]]:
    """The pairs of shapes that share more than points of their boundaries."""
    found = set()
    grown = [one.buffer(2e-3) for one in shapes]
    for one, two in zip(*shapely.STRtree(shapes).query(grown, predicate="intersects"), strict=True):
        if one < two and grown[one].intersection(grown[two]).area > 4e-3 * 0.1:
            found.add((int(one), int(two)))
    return found


def colourable(pairs: set[tuple[int, int]], count: int, colours: int) -> bool:
    """Whether there is any colouring of a graph, by trying all, the node with the fewest choices first."""
    beside: list[set[int]] = [set() for _ in range(count)]
    for one, two in pairs:
        beside[one].add(two)
        beside[two].add(one)
    chosen: dict[int, int] = {}

    def done() -> bool:
        rest = [k for k in range(count) if k not in chosen]
        if not rest:
            return True
        node = max(rest, key=lambda k: (len({chosen[n] for n in beside[k] if n in chosen}), len(beside[k])))
        used = max(chosen.values(), default=-1)
        for colour in range(min(colours, used + 2)):
            if all(chosen.get(n) != colour for n in beside[node]):
                chosen[node] = colour
                if done():
                    return True
                del chosen[node]
        return False

    return done()


@pytest.mark.parametrize("name", ["p1-leaf", "p4-hook", "pg-wave", "p3-puzzle", "pmm", "p6m", "p4g"])
def test_colours_are_proper_and_the_fewest(name: str) -> None:
    """No two tiles that share a side are alike; all the plane's tiles on a sheet cannot have a colour less."""
    design = tiling(name).design
    side = round(2.6 * max(abs(design.lattice.a), abs(design.lattice.b)) * design.unit_mm, 1)
    product = made(name, sheet=(side, side), fit="clip", edges="pieces", colours="layers")
    shapes, colours = [], []
    for layer in product.drawing.layers:
        found = contour_shapes(layer.paths, 1e-3)
        shapes += found
        colours += [layer.name] * len(found)
    assert shapely.union_all(shapes, grid_size=1e-6).area == pytest.approx(side**2, rel=1e-4)
    pairs = sides(shapes)
    assert pairs
    assert all(colours[one] != colours[two] for one, two in pairs)
    assert len(set(colours)) == product.colours
    assert colourable(pairs, len(shapes), product.colours)
    assert not colourable(pairs, len(shapes), product.colours - 1)
    assert set(product.pieces.colour.tolist()) == set(range(product.colours))


def test_files_have_all_pieces_once() -> None:
    """One drawing for each colour: together they are the drawing with layers."""
    tiles, job = tiling("pg-wave"), Job(sheet=(170.0, 150.0), kerf=0.3, colours="files", labels="number")
    at_once = make_several(tiles.design, tiles.tessellation, job)
    assert [name for name, _ in at_once] == [str(k + 1) for k in range(len(at_once))]
    parts = [tiles.make(replace(job, only_colour=number)) for number in range(len(at_once))]
    for part, (_, same) in zip(parts, at_once, strict=True):
        assert written(same) == written(part)
        assert same.notes == part.notes
    together = tiles.make(replace(job, colours="layers"))
    assert sum(len(part.pieces.site) for part in parts) == len(together.pieces.site)
    starts = [np.sort_complex(cuts(part).start) for part in parts]
    for layer, start in zip((one for one in together.drawing.layers if one.work == "cut"), starts, strict=True):
        assert np.array_equal(np.sort_complex(layer.paths.start), start)
    assert sum(len(work(part, "engrave").start) for part in parts) > 0
    tiles = squares()
    name, frame = make_several(tiles.design, tiles.tessellation, Job(sheet=(90.0, 90.0), fit="frame", colours="files"))[
        -1
    ]
    assert name == "frame"
    assert set(frame.pieces.site.tolist()) == {FRAME}


# --- the report -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "job",
    [
        {"sheet": (150.0, 120.0)},
        {"sheet": (150.0, 120.0), "fit": "clip", "kerf": 0.3, "labels": "number", "margin": 4.0, "marks": True},
        {"sheet": (150.0, 120.0), "fit": "frame"},
        {"kerf": 0.2, "tabs": 0.5},
    ],
)
def test_the_reports_figures(job: dict[str, Any]) -> None:
    """Lengths, travel, pierces and time from the drawing's paths one by one; pieces from the exact tiles."""
    tiles = tiling("pg-wave")
    product = tiles.make(Job(**job))
    speeds = {"cut": 12.0, "score": 50.0, "engrave": 80.0, "travel": 150.0}
    figures = json.loads(json.dumps(report_figures(tiles.design, product, speeds=speeds, pierce_s=0.25)))
    at, time, length, travel, pierces = 0j, 0.0, 0.0, 0.0, 0
    for layer, row in zip(product.drawing.layers, figures["layers"], strict=True):
        paths, way = layer.paths, 0.0
        own = float(true_lengths(paths).sum())
        for k in range(len(paths)):
            way += abs(complex(paths.start[paths.offsets[k]]) - at)
            at = complex(paths.end[paths.offsets[k + 1] - 1])
        assert row["length"] == pytest.approx(own, rel=1e-9)
        assert row["travel"] == pytest.approx(way, rel=1e-9)
        time += own / speeds[layer.work] + way / 150.0
        if layer.work == "cut":
            length, travel, pierces = length + own, travel + way, pierces + len(paths)
            time += 0.25 * len(paths)
    assert figures["time"] == pytest.approx(time, rel=1e-9)
    assert figures["cut"]["length"] == pytest.approx(length, rel=1e-9)
    assert figures["cut"]["travel"] == pytest.approx(travel, rel=1e-9)
    assert figures["cut"]["pierces"] == pierces
    counts = [row["count"] for row in figures["pieces"]["kinds"]]
    assert figures["pieces"]["count"] + figures["pieces"]["frame"] == sum(counts)
    area = tiles.tiles[0].area * tiles.design.unit_mm**2
    assert figures["use"]["whole_tiles"] == pytest.approx(area * figures["pieces"]["whole"], rel=1e-3)
    assert figures["use"]["share"] == pytest.approx(
        product.pieces.area[product.pieces.site >= 0].sum() / figures["page"]["area"]
    )
    if "sheet" in job and "kerf" not in job and job.get("fit") != "frame":  # which keeps from the edge
        copies = whole(plane("pg-wave", *job["sheet"]), *job["sheet"])
        turned = Counter(copy.operation.determinant < 0 for copy in copies)
        assert figures["pieces"]["whole"] == len(copies)
        assert figures["pieces"]["turned_over"] == turned[True]


def test_engraving_comes_first_and_the_order_is_short() -> None:
    """Engrave, inside, outside; and much less travel than in any order."""
    product = made("p4-mill", sheet=(400.0, 400.0), kerf=0.2, labels="number")
    kinds = [layer.work for layer in product.drawing.layers]
    assert kinds == sorted(kinds, key=["engrave", "score", "cut"].index)
    paths = product.drawing.layers[-1].paths
    assert len(paths) > 15
    starts = paths.start[paths.offsets[:-1]]
    rng = np.random.default_rng(1)
    shuffled = np.abs(np.diff(rng.permutation(starts))).sum()
    assert np.abs(np.diff(starts)).sum() < 0.5 * shuffled


def test_exact_art_free_designs_are_written_without_a_job(tmp_path: Path) -> None:
    """`export` without a job writes the exact tiles; with `edges` it makes a drawing."""
    tiles = squares()
    tiles.export(tmp_path / "a.svg")
    tiles.export(tmp_path / "b.svg", edges="pieces")
    assert (tmp_path / "a.svg").read_text() == tiles.svg()
    assert (tmp_path / "b.svg").read_text() != tiles.svg()
    with pytest.raises(JobError, match="JSON document"):
        tiles.export(tmp_path / "c.json", edges="pieces")
    assert not (tmp_path / "c.json").exists()


def test_a_wrong_drawing_is_seen() -> None:
    """The oracles of curves see a drawing that is a hundredth off, and one that lacks a path."""
    size = (100.0, 100.0)
    exact = exact_boundary("p4-hook", size)
    paths = cuts(made("p4-hook", sheet=size))
    lines = shapely.multilinestrings(lines_of(paths))
    assert farthest(dense(lines, 0.2), exact) <= 1e-3
    moved = shapely.multilinestrings(lines_of(paths.moved(1.0, 0.01)))
    assert farthest(dense(moved, 0.2), exact) > 5e-3
    fewer = shapely.multilinestrings(lines_of(paths.take(np.arange(1, len(paths)))))
    assert farthest(dense(exact, 0.2), fewer) > 0.1
    assert isinstance(paths, Paths)
