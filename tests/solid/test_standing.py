"""Designs that stand as models: their lofts, the copies around one, and what only prisms have."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from helpers.examples import FOLDER

from voronoi_tiles import ArgumentError, Design, JobError, SolidJob, SolidModel, extrude, stand
from voronoi_tiles.solid.cross_sections import section

TWIST = """
schema = 1
group = "p4"
cell = { a = 60 }
site = [{ name = "bird", strokes = [{ segment = [[8, 10], [22, 17]] }] }]
solid = { height = 20, layers = 5, turn = 40, about = [15, 14] }
"""


@pytest.fixture(scope="module")
def around() -> SolidModel:
    """One and the copies around it."""
    return stand(Design.loads(TWIST), around=True)


def test_a_design_that_stands_is_a_model() -> None:
    """At the origin, with the volume of the cell's share, made again from its recipe."""
    model = stand(Design.loads(TWIST))
    (piece,) = model.pieces
    assert piece.mesh.is_closed
    assert piece.mesh.volume == pytest.approx(60 * 60 * 20 / 4, rel=1e-12)
    assert model.bounds[0] == pytest.approx([0.0, 0.0, 0.0])
    assert all(figure["passed"] for figure in model.proof["figures"])
    again = stand(Design.loads(model.recipe["design"]), SolidJob(**json.loads(model.recipe["solid"])))
    assert (again.pieces[0].mesh.vertices == piece.mesh.vertices).all()


def test_the_accuracy_that_is_asked_for_is_taken() -> None:
    """Also that which prisms have where nobody says: finer chords are more triangles than the loft's own accuracy."""
    unsaid, coarse, fine = (
        len(stand(Design.loads(TWIST), SolidJob(accuracy=accuracy)).pieces[0].mesh.triangles)
        for accuracy in (None, 0.05, "0.01mm")
    )
    assert unsaid == coarse < fine


def test_copies_around_one_are_apart_and_of_other_colours(around: SolidModel) -> None:
    """At all heights; they are the same solid."""
    assert len(around.pieces) > 4
    assert {round(piece.mesh.volume, 6) for piece in around.pieces} == {18000.0}
    for z in (0.1, 7.3, 19.9):
        rings = [section(piece.mesh, z) for piece in around.pieces]
        shapes = [shapely.Polygon(np.column_stack((ring.start.real, ring.start.imag))) for ring in rings]
        one, other = np.triu_indices(len(shapes), 1)
        assert shapely.distance(np.array(shapes)[one], np.array(shapes)[other]).min() > 2.0
    assert around.pieces[0].colour not in {piece.colour for piece in around.pieces[1:]}
    assert around.notes == ("neighbours and the room between them are for the picture alone",)


def test_copies_around_one_stand_where_they_do_where_asked(around: SolidModel) -> None:
    """They are those of the picture, moved back; each shares with the one, bit for bit, a part of its walls."""
    closed = stand(Design.loads(TWIST), around=True, apart=False)
    assert not closed.notes
    own = {tuple(point) for point in closed.pieces[0].mesh.vertices.tolist()}
    for moved, piece in zip(around.pieces, closed.pieces, strict=True):
        assert moved.colour == piece.colour
        away = moved.mesh.vertices - piece.mesh.vertices
        assert np.ptp(away, axis=0) == pytest.approx(0.0, abs=1e-12)
        assert len(own & {tuple(point) for point in piece.mesh.vertices.tolist()}) > 10


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"height": 5}, "`height` is that of [solid]"),
        ({"height": 3}, "`height` is that of [solid]"),
        ({"chamfer": 10}, "two rims with `chamfer='10mm'` leave nothing of a `height` of 20 mm"),
        ({"gap": 1}, "`gap` is for prisms"),
        ({"sheet": "200x200mm"}, "`sheet` is for prisms"),
        ({"colours": "fewest"}, "`colours` is for prisms"),
    ],
)
def test_what_only_prisms_have_is_refused(options: dict[str, Any], message: str) -> None:
    """Before anything is computed."""
    with pytest.raises(JobError) as refusal:
        stand(Design.loads(TWIST), SolidJob(**options))
    assert str(refusal.value).startswith(message)
    assert refusal.value.remedy


@pytest.mark.parametrize("job", [SolidJob(), SolidJob(clearance=0.2, chamfer=0.5)], ids=["filling", "to print"])
@pytest.mark.parametrize("path", sorted(FOLDER.glob("solid/*.toml")), ids=lambda path: path.stem)
def test_the_examples_are_solids(path: Path, job: SolidJob) -> None:
    """Each is proved as it is, and as it is printed."""
    design = Design.load(path)
    model = extrude(design.tessellate(), job) if design.standing is None else stand(design, job)
    assert all(piece.mesh.is_closed for piece in model.pieces)
    assert model.notes == ()


def test_neighbours_stay_in_sight() -> None:
    """Small pieces beside a large one do not drive all others out of the picture."""
    pieces = """
schema = 1
group = "p31m"
cell = { a = 60 }
site = [
  { name = "claw", strokes = [{ segment = [[13, 8], [25, 6]] }] },
  { name = "peg", strokes = [{ point = [30, 15] }] },
]
solid = { height = 30, scale = 1.3, shift = [1, 1], about = [19, 7] }
"""
    near, far = (stand(Design.loads(pieces), around=True, apart=apart) for apart in (False, True))
    widths = [(model.bounds[1] - model.bounds[0])[:2] for model in (near, far)]
    assert (widths[1] <= 2 * widths[0]).all()


def test_a_design_is_made_flat() -> None:
    """By False; None leaves its solid as it is."""
    design = Design.loads(TWIST)
    assert design.replace(solid=None).solid is not None
    flat = design.replace(solid=False)
    assert (flat.solid, flat.standing) == (None, None)
    assert flat == Design.loads(TWIST.split("solid =", maxsplit=1)[0])


@pytest.mark.parametrize("design", [None, "design.toml", 3])
def test_what_is_no_design_does_not_stand(design: Any) -> None:
    """The argument is named."""
    with pytest.raises(ArgumentError, match=r"`design` .* cannot be. Give a Design"):
        stand(design)


def test_a_flat_design_does_not_stand() -> None:
    """The message says what to write."""
    with pytest.raises(ArgumentError, match=r"\[solid\]"):
        stand(Design.loads(TWIST.split("solid =", maxsplit=1)[0]))
