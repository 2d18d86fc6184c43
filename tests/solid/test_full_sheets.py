"""Sheets that are full of stacks: each has the same copies in the same places, read from the files as they are."""

from __future__ import annotations

import re
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely

from voronoi_tiles import GROUPS, Design, JobError, Stack, StackJob, stack
from voronoi_tiles.base.arrays import Complexes, plane
from voronoi_tiles.fabrication.lettering import lettering

HEIGHT, SHEETS, DOWEL, TURN = 30.0, 3, 2.0, 50.0
# Ends of a segment in a general position, and the point about which it turns.
DRAWN = {
    "p4g": ((6 + 9j, 16 + 8j), 11 + 8.5j, {"a": 60.0}),  # mirrors, glides and rotations
    "pg": ((8 + 10j, 24 + 17j), 15 + 14j, {"a": 44.0, "b": 52.0}),
    "p31m": ((16 + 3j, 25 + 7j), 20 + 5j, {"a": 66.0}),
}


def design(group: str) -> Design:
    """A design that stands, whose segment turns."""
    ends, about, cell = DRAWN[group]
    sides = ", ".join(f"{name} = {value}" for name, value in cell.items())
    points = [[z.real, z.imag] for z in ends]
    return Design.loads(
        f'schema = 1\ngroup = "{group}"\ncell = {{ {sides} }}\n'
        f"site = [{{ strokes = [{{ segment = {points} }}] }}]\n"
        f"solid = {{ height = {HEIGHT}, turn = {TURN}, about = [{about.real}, {about.imag}] }}\n"
    )


def at_sheet(group: str, sheet: int) -> Complexes:
    """The segment in the middle of a sheet's height, turned by hand."""
    ends, about, _ = DRAWN[group]
    turn = np.exp(1j * np.radians(TURN) * (sheet - 0.5) / SHEETS)
    return np.asarray(about + (np.array(ends) - about) * turn, np.complex128)


def copies(group: str, points: Complexes, reach: int = 5) -> Complexes:
    """The images of points under all operations of the group near the origin, that under the identity first: n x m."""
    made = design(group)
    isometries = [made.lattice.isometry(operation) for operation in GROUPS[group].operations]
    steps = [(i, j) for i in range(-reach, reach + 1) for j in range(-reach, reach + 1)]
    found = [
        one.a * (points.conj() if one.conj else points) + one.b + i * made.lattice.a + j * made.lattice.b
        for i, j in sorted(steps, key=lambda step: step != (0, 0))
        for one in isometries
    ]
    return np.array(found)


class Cut:
    """A file as others read it: points on the curves of each path of its layers, y up."""

    def __init__(self, path: Path) -> None:
        text = path.read_text()
        self.layers: dict[str, list[Complexes]] = {}
        for name, body in re.findall(r'<g [^>]*?id="(\w+)".*?>(.*?)</g>', text, re.DOTALL):
            self.layers[name] = [_points(data) for data in re.findall(r' d="([^"]*)"', body)]
        self.pieces = [shapely.Polygon(plane(points)) for points in self.layers["cut"]]
        self.holes = np.array([_middle(points) for points in self.layers.get("inner", [])])

    def texts(self) -> list[Complexes]:
        """The points of the label in each piece."""
        found: list[list[Complexes]] = [[] for _ in self.pieces]
        tree = shapely.STRtree(self.pieces)
        for stroke in self.layers["engrave"]:
            (piece,) = tree.query(shapely.Point(stroke[0].real, stroke[0].imag), predicate="within")
            found[piece].append(stroke)
        return [np.concatenate(strokes) for strokes in found]


def _middle(points: Complexes) -> complex:
    """The middle of the box around points."""
    return complex(points.real.min() + points.real.max(), points.imag.min() + points.imag.max()) / 2


def _points(data: str) -> Complexes:
    """The points on the curves of path data."""
    found: list[complex] = []
    for command, numbers in re.findall(r"([MLHVQCZ])([^A-Z]*)", data):
        values = [float(number) for number in numbers.split()]
        if command == "Z":
            found.append(found[0])
            continue
        assert command in "MLQC"
        size = {"M": 2, "L": 2, "Q": 4, "C": 6}[command]
        found += [complex(values[k - 2], -values[k - 1]) for k in range(size, len(values) + 1, size)]
    return np.array(found)


def normalised(points: Complexes) -> Complexes:
    """Points in a box in the corner of which 0 is, and the sides of which are 1 together."""
    corner = complex(points.real.min(), points.imag.min())
    return np.asarray((points - corner) / (np.ptp(points.real) + np.ptp(points.imag)))


@cache
def letters(text: str) -> Complexes:
    """The points of a text's strokes."""
    strokes = lettering(text, height=1.0)
    return normalised(np.concatenate((strokes.start, strokes.end)))


def same(points: Complexes, text: str) -> bool:
    """Whether points of strokes are those of a text, wherever they are and however large."""
    one, other = normalised(points), letters(text)
    if abs(np.ptp(one.real) - np.ptp(other.real)) > 1e-4:
        return False
    apart = np.abs(one[:, None] - other)
    return bool(max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-4)


def numbers(cut: Cut, sheet: int) -> dict[int, int]:
    """The piece that each stack has in a file, by the stack's number, read from what is engraved."""
    found = {}
    for piece, points in enumerate(cut.texts()):
        names = [(n, f"{sheet}.{n}{stop}") for n in range(1, len(cut.pieces) + 1) for stop in ("", ".")]
        read = [n for n, name in names if same(points, name)]
        assert len(read) == 1
        found[read[0]] = piece
    assert sorted(found) == list(range(1, len(cut.pieces) + 1))
    return found


def written(made: Stack, folder: Path) -> list[Cut]:
    """The files of a stack."""
    return [Cut(Path(path)) for path, _ in made.export(folder / "a.svg")]


def distance(points: Complexes, ends: Complexes) -> Complexes:
    """How far points are from a segment."""
    along = ends[1] - ends[0]
    t = np.clip(((points - ends[0]) * along.conjugate()).real / abs(along) ** 2, 0.0, 1.0)
    return np.asarray(np.abs(points - ends[0] - t * along))


@pytest.mark.parametrize("group", DRAWN)
def test_a_number_is_one_copy_in_all_sheets(group: str, tmp_path: Path) -> None:
    """Pieces of a stack are the tiles of one copy of the segment, turned over or not, whose holes lie on each other."""
    made = stack(design(group), StackJob(sheets=SHEETS, dowel=DOWEL, sheet=(150, 120), edges="pieces", margin=2))
    cuts = written(made, tmp_path)
    told = np.array([complex(x, y) for x, y in made.report()["holes"]["site1"]])
    pieces = [numbers(cut, k + 1) for k, cut in enumerate(cuts)]
    assert made.stacks() == {"site1": len(pieces[0])}
    handed = set()
    for number in pieces[0]:
        own = [cut.pieces[found[number]] for cut, found in zip(cuts, pieces, strict=True)]
        bored = [
            cut.holes[shapely.contains_xy(piece, cut.holes.real, cut.holes.imag)]
            for cut, piece in zip(cuts, own, strict=True)
        ]
        for holes in bored:
            assert sorted(holes.tolist(), key=str) == sorted(bored[0].tolist(), key=str)
        one, other = bored[0]
        placed = []
        for first, second in ((one, other), (other, one)):
            for over in (False, True):
                base = told.conj() if over else told
                turn = (second - first) / (base[1] - base[0])
                assert abs(abs(turn) - 1.0) < 1e-5
                placed.append((turn, first - turn * base[0], over))
        errors = np.zeros((len(placed), SHEETS))
        for k, (turn, shift, over) in enumerate(placed):
            for sheet, piece in enumerate(own):
                images = copies(group, at_sheet(group, sheet + 1), 2)
                images = turn * (images.conj() if over else images) + shift
                points = shapely.get_coordinates(piece).copy().view(np.complex128)[:, 0]
                nearest = np.min([distance(points, ends) for ends in images[1:]], axis=0)
                errors[k, sheet] = np.abs(nearest - distance(points, images[0])).max()
        right = errors.max(axis=1) < 1e-4
        assert right.sum() == 1
        handed.add(placed[int(right.argmax())][2])
        assert all(piece.bounds[0] > 2 - 1e-6 and piece.bounds[2] < 148 + 1e-6 for piece in own)
        assert all(piece.bounds[1] > -118 - 1e-6 and piece.bounds[3] < -2 + 1e-6 for piece in own)
    assert handed == {False, True}


@pytest.mark.parametrize("group", DRAWN)
def test_pieces_that_are_pulled_apart_lie_alike_in_all_sheets(group: str, tmp_path: Path) -> None:
    """With a kerf all are a millimetre apart in each sheet, and the holes of all files are one pattern."""
    made = stack(design(group), StackJob(sheets=SHEETS, dowel=DOWEL, sheet=(200, 160), kerf=0.2))
    cuts = written(made, tmp_path)
    for k, cut in enumerate(cuts):
        assert sorted(cut.holes.tolist(), key=str) == sorted(cuts[0].holes.tolist(), key=str)
        assert len(cut.holes) == 2 * len(cut.pieces)
        assert len(numbers(cut, k + 1)) == len(cuts[0].pieces)
        one, other = shapely.STRtree(cut.pieces).query(cut.pieces, predicate="dwithin", distance=0.99)
        assert (one == other).all()


def test_a_panel_is_clipped_to_its_sheet(tmp_path: Path) -> None:
    """Pieces fill it to the edge in all sheets; each hole that has its wall there is in all of them, and no other."""
    made = stack(design("p4g"), StackJob(sheets=SHEETS, dowel=DOWEL, sheet=(150, 100), fit="clip", edges="pieces"))
    cuts = written(made, tmp_path)
    told = np.array([complex(x, y) for x, y in made.report()["holes"]["site1"]])
    page = copies("p4g", told).ravel() + 75 - 50j  # the design's origin is in the middle of the sheet
    wall = DOWEL / 2 + 1.0
    within = (page.real >= wall) & (page.real <= 150 - wall) & (-page.imag >= wall) & (-page.imag <= 100 - wall)
    assert 20 < within.sum() < 200
    for cut in cuts:
        assert len(cut.holes) == within.sum()
        assert np.abs(cut.holes[:, None] - page[within]).min(axis=1).max() < 1e-5
        assert sum(piece.area for piece in cut.pieces) == pytest.approx(150 * 100, rel=1e-2)  # chords of long arcs
    assert {len(cut.pieces) for cut in cuts} != {0}


def test_edges_that_are_cut_once_have_holes_and_numbers() -> None:
    """Shared edges are there once, and holes on a layer of their own."""
    job = StackJob(sheets=SHEETS, dowel=DOWEL, sheet=(200, 160))
    products = stack(design("pg"), job).products()
    pieces = stack(design("pg"), StackJob(sheets=SHEETS, dowel=DOWEL, sheet=(200, 160), edges="pieces")).products()
    for once, each in zip(products, pieces, strict=True):
        holes, plain = ({layer.name: layer for layer in one.drawing.layers} for one in (once, each))
        assert len(holes["inner"].paths) == len(plain["inner"].paths) == 2 * once.pieces.count
        assert holes["cut"].paths.lengths.sum() < 0.8 * plain["cut"].paths.lengths.sum()
        assert once.pieces.tile_area == pytest.approx(each.pieces.tile_area)
        assert once.pieces.count == each.pieces.count


def test_a_frame_goes_around_the_stacks() -> None:
    """Each sheet has one, with the same tiles."""
    products = stack(design("p4g"), StackJob(sheets=SHEETS, sheet=(200, 160), frame=5)).products()
    assert {product.pieces.counted for product in products} == {f"{products[0].pieces.count} tiles and a frame"}


def test_tabs_hold_pieces_and_not_what_falls_out_of_holes() -> None:
    """Contours are open, holes are not."""
    made = stack(design("pg"), StackJob(sheets=2, dowel=DOWEL, sheet=(200, 160), gap=1, tabs=0.5))
    for product in made.products():
        layers = {layer.name: layer.paths for layer in product.drawing.layers}
        assert layers["inner"].closed.all()
        assert not layers["cut"].closed.any()


TRAVELLING = """
schema = 1
group = "p1"
cell = { a = 20, b = 20, angle = 90 }
site = [{ strokes = [{ point = [35, 5] }] }]
solid = { height = 20, shift = [60, 10] }
"""


def test_a_site_that_travels_far_stays_one_copy(tmp_path: Path) -> None:
    """Where it moves over several cells on the way up, its stack moves along; one that no sheet holds is refused."""
    travelling = Design.loads(TRAVELLING)
    cuts = written(stack(travelling, StackJob(sheets=4, sheet=(200, 100), edges="pieces")), tmp_path)
    boxes = []
    for sheet, cut in enumerate(cuts, 1):
        found = numbers(cut, sheet)
        boxes.append(np.array([cut.pieces[found[n]].bounds for n in sorted(found)]))
    assert len(boxes[0]) == 7 * 4
    for low, high in pairwise(boxes):
        assert high - low == pytest.approx(np.array([[15, 2.5, 15, 2.5]] * len(low)), abs=1e-6)
    with pytest.raises(JobError, match=r"no stack fits on the sheet as a whole: one takes 65 x 27\.5 mm"):
        stack(travelling, StackJob(sheets=4, sheet=(60, 100))).products()


def test_numbers_say_which_way_up_they_are() -> None:
    """Of sheets that are numbered 1 to 9, none has a number that is another's, or is its own, upside down."""
    made = stack(design("pg"), StackJob(sheets=9))
    labels = []
    for product in made.products():
        (layer,) = [layer.paths for layer in product.drawing.layers if layer.name == "engrave"]
        labels.append(np.concatenate((layer.start, layer.end)))
    texts = ["1", "2", "3", "4", "5", "6.", "7", "8", "9."]
    assert [[text for text in texts if same(points, text)] for points in labels] == [[text] for text in texts]
    assert not any(same(-points, text) for points in (labels[5], labels[8]) for text in (*texts, "6", "9"))


SPECIAL = """
schema = 1
group = "p2"
cell = { a = 60, b = 40, angle = 80 }
site = [{ name = "bar", strokes = [{ segment = [[-8, -4], [8, 4]] }] }]
key = [{ z = 5, strokes = [{ segment = [[-8, -4], [8, 4]] }] }, { z = 20, strokes = [{ segment = [[2, 2], [14, 9]] }] }]
solid = { height = 20 }
"""


def test_copies_that_coincide_in_some_sheets_are_no_stacks() -> None:
    """A stack needs its tile in all sheets."""
    with pytest.raises(JobError, match='copies of "bar" coincide in a sheet'):
        stack(Design.loads(SPECIAL), StackJob(sheets=4, sheet=(200, 200))).products()


def test_a_frame_needs_a_sheet() -> None:
    """As of any job, when it is asked for."""
    with pytest.raises(JobError, match="`frame` is about a sheet, and there is none"):
        StackJob(sheets=3, frame=5)
