"""trimesh reads our solids as what they are: closed bodies of the right volume, in the right place and unit."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers.examples import FOLDER, tiling
from helpers.readers import FOLDER as READERS
from helpers.readers import MissingProgramError, interpreter

from voronoi_tiles import Design, SolidJob, SolidModel, StackJob, TriangleMesh, extrude, stack, stand


def standing(name: str) -> Design:
    """An example that stands."""
    return Design.load(FOLDER / "solid" / f"{name}.toml")


def loft(name: str) -> SolidModel:
    """Its loft."""
    return stand(standing(name))


MODELS: dict[str, Callable[[], SolidModel]] = {
    "prism": lambda: extrude(tiling("p4")),
    "two sites": lambda: extrude(tiling("p4m")),
    "chamfered": lambda: extrude(tiling("p4"), SolidJob(clearance=0.2, chamfer=0.3)),
    "parted sheet": lambda: extrude(tiling("p4m"), SolidJob(sheet="130x130mm", clearance=0.2, height=2)),
    "touching sheet": lambda: extrude(tiling("p3"), SolidJob(sheet="120x120mm")),
    "coloured sheet": lambda: extrude(tiling("p3"), SolidJob(sheet="120x120mm", colours="fewest")),
    "stack": lambda: stack(standing("p3-steps"), StackJob(sheets=5)).model,
    **{name: partial(loft, name) for name in ("p1-noodle", "p2-twist", "p4-abeille", "pgg-scutoid")},
}

TOUCHING = ("two sites", "touching sheet", "coloured sheet")
"""Whose pieces touch: an STL file cannot say that they are several."""


def read(file: Path) -> Any:
    """What trimesh says of a file. Leaves the test out where trimesh is not here, as the tests of other programs."""
    try:
        words = [*interpreter("python"), str(READERS / "programs" / "read_trimesh_solids.py"), str(file)]
    except MissingProgramError as error:
        if os.environ.get("VORONOI_TILES_REQUIRE_READERS") == "1":
            pytest.fail(str(error))
        pytest.skip(str(error))
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
def test_a_3mf_file_is_read_to_the_last_digit(name: str, tmp_path: Path) -> None:
    """A closed body for each piece, in millimetres, in its place, of its volume."""
    model = MODELS[name]()
    model.save(tmp_path / "a.3mf")
    found = read(tmp_path / "a.3mf")
    assert found["units"] == "millimeter"
    assert len(found["bodies"]) == len(model.pieces)
    assert all(body["watertight"] and body["oriented"] for body in found["bodies"])
    theirs = sorted((*body["low"], *body["high"], body["volume"]) for body in found["bodies"])
    ours = sorted(
        (*piece.mesh.vertices.min(axis=0), *piece.mesh.vertices.max(axis=0), piece.mesh.volume)
        for piece in model.pieces
    )
    assert np.array(theirs) == pytest.approx(np.array(ours), rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
def test_an_stl_file_is_read_in_single_precision(name: str, tmp_path: Path) -> None:
    """Of the right volume, and closed where pieces do not touch; where they do, sides belong to four triangles."""
    model = MODELS[name]()
    model.save(tmp_path / "a.stl")
    (body,) = read(tmp_path / "a.stl")["bodies"]
    assert body["oriented"]
    assert body["watertight"] == (name not in TOUCHING)
    assert body["volume"] == pytest.approx(model.volume, rel=1e-6)
    assert np.array([body["low"], body["high"]]) == pytest.approx(model.bounds, rel=1e-6, abs=1e-5)


@pytest.mark.slow
def test_trimesh_sees_what_is_open(tmp_path: Path) -> None:
    """A solid that lacks a triangle, and one that is turned inside out."""
    (piece,) = extrude(tiling("p4")).pieces
    for triangles, closed, sign in ((piece.mesh.triangles[1:], False, 1), (piece.mesh.triangles[:, ::-1], True, -1)):
        mesh = TriangleMesh(piece.mesh.vertices, triangles)
        rows = np.zeros(len(triangles), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
        rows["normal"], rows["corners"] = mesh.normals, mesh.corners  # our own writer refuses what is open
        (tmp_path / "a.stl").write_bytes(bytes(80) + len(rows).to_bytes(4, "little") + rows.tobytes())
        (body,) = read(tmp_path / "a.stl")["bodies"]
        assert body["watertight"] == closed
        assert np.sign(body["volume"]) == sign
