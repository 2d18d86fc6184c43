"""The extension in Blender, from its file to its removal: what users do, without a window."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers.blender import Extension, blender_python, make_extension

import voronoi_tiles as vt
from voronoi_tiles.base import kernels
from voronoi_tiles.base.arrays import Complexes

pytestmark = pytest.mark.slow

ULP = 2.0**-23
"""The spacing of single precision at 1."""


@pytest.fixture(scope="session")
def extension(tmp_path_factory: pytest.TempPathFactory) -> Extension:
    """The extension's file, made once of the checkout; its tests are left out where Blender is not installed."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    return make_extension(shared, tmp_path_factory.mktemp("blender"))


def test_blender_accepts_the_file(extension: Extension) -> None:
    """Its own check of extensions says nothing against it."""
    code = "import bpy; print(bpy.utils.resource_path('LOCAL'))"
    said = subprocess.run([blender_python(), "-c", code], capture_output=True, text=True, check=True)
    checker = Path(said.stdout.splitlines()[-1]) / "scripts" / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py"
    done = subprocess.run(
        [blender_python(), checker, "validate", extension.file], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Success" in done.stdout


def test_it_is_installed_used_saved_opened_and_removed(extension: Extension) -> None:
    """As a user does it: its own engine, compiled; tiles are saved, opened and followed; nothing stays when it goes."""
    found, folder = extension.run("life")
    assert Path(found["library"]).is_relative_to(folder / "home" / "extensions")
    assert (found["kernels"] == "compiled") == (kernels.library() is not None)
    assert found["same"]
    assert found["proved"]
    assert found["copies"] == [36, 36]
    assert found["follows"]
    assert found["listening"] == 1
    left = {"handlers": 0, "settings": False, "operators": False, "panels": False, "objects": found["objects"]}
    assert found["left"] == left
    assert found["remain"] == ["lizard"]
    assert found["collections"] == 0


def test_without_its_engine_the_panel_says_so(extension: Extension) -> None:
    """It is enabled, with that sentence and what to do, and offers nothing that it cannot do."""
    found, _ = extension.run("lacking")
    said = " ".join(found["lines"])
    assert said.startswith("The engine voronoi_tiles is missing: ")
    assert "Install the extension's file for this platform" in said
    assert found["shown"] == ["VORONOI_TILES_PT_tiles"]
    assert found["listening"] == 0
    assert found["left"] is False


def places(matrices: Any, vertices: Any) -> Complexes:
    """Where matrices of Blender take the vertices of a mesh, in double precision."""
    points = np.column_stack((vertices.astype(np.float64), np.ones(len(vertices))))
    moved = points @ matrices.astype(np.float64).T
    return np.asarray(moved[:, 0] + 1j * moved[:, 1])


def test_instances_are_our_copies_in_all_groups(extension: Extension) -> None:
    """Within a unit in the last place of single precision; their meshes are closed, and as large as the tiles.

    The unit is that of the copy's largest coordinate, in which Blender adds. Tiles of several sites have chords that
    their neighbours have as well: together they have the area of the cell.
    """
    found, folder = extension.run("groups", ",".join(vt.GROUPS))
    assert list(found["groups"]) == list(vt.GROUPS)
    for group, drawn in found["groups"].items():
        # As it was drawn, in single precision.
        tiling = vt.Design.load(folder / f"{group}.toml").tessellate()
        arrays = np.load(folder / f"{group}.npz")
        sites = [tile.name for tile in tiling]
        assert len(set(drawn["names"])) == len(drawn["names"]) == 6 * sum(tile.copies_per_cell for tile in tiling)
        areas = dict.fromkeys(sites, 0.0)
        for name, matrix, (mesh, closed, area, volume) in zip(
            drawn["names"], arrays["matrices"], drawn["meshes"], strict=True
        ):
            site, operation = name.rsplit(" ", 1)
            tile = tiling[site]
            exact = tile.copy(operation)
            limit = ULP * 2.0 ** np.floor(np.log2(np.abs(np.array(exact.bounds)).max()))
            there = places(matrix, arrays[mesh])
            away = there[:, None] - exact.start
            nearest = away[np.abs(away).argmin(axis=0), np.arange(len(exact))]
            assert max(np.abs(nearest.real).max(), np.abs(nearest.imag).max()) <= limit, (group, name)
            assert closed, (group, name)
            assert volume == pytest.approx(drawn["height"] * area, rel=1e-6)
            areas[site] += area
        for tile in tiling:
            if len(tiling) == 1:
                assert areas[tile.name] / (6 * tile.copies_per_cell) == pytest.approx(tile.area, rel=1e-6)
        assert sum(areas.values()) == pytest.approx(6 * tiling.design.lattice.det, rel=1e-6)


def test_what_is_shown_is_what_is_drawn_through_undo(extension: Extension) -> None:
    """After each of 200 steps of dragging, undo, redo, settings and the edit mode; with no exception and no crash."""
    found, _ = extension.run("drags", "0")
    assert found["wrong"] == []
    assert sum(found["steps"].values()) == 200 == found["shown"] + found["refused"]
    assert found["shown"] > 100
    assert found["steps"]["undo"] > 20


def test_what_is_shown_outlasts_what_users_do_to_it(extension: Extension) -> None:
    """Copies of it, deletions, new names, other modes, undo and files: it is right again with Update, which is said.

    No two tilings share what they show. Solids stay until the drawing changes.
    """
    found, _ = extension.run("hands")
    assert found["copy of the empty"].startswith("No site is left: ")
    assert found["copy of all"] == ["There are other tiles to show now: press Update.", "", 18]
    assert found["the other stays"] == [True] * 3
    assert found["tile as site"] == ["", True]
    assert found["left of it"] == ["bird", "bird tile", "bird.004"]
    assert all("finite number" in said for said in found["no place"][:4])
    assert [said.rpartition(": ")[2] for said in found["no place"][4:]] == ["number beyond 1e+12."] * 2 + [""]
    for key in ("back", "mended", "marked"):
        assert found[key], key
    assert found["converted"] == found["copy of the empty"]
    assert found["renamed"] == ["", True]
    assert found["lifted"] == [True]
    assert found["called"] == [True] * (1 + 24)
    assert found["solids"][:2] == [True, True]
    assert found["solids"][2].startswith("closed; ")
    assert found["dragged"] == [False, ""]
    assert found["modes"] == []
    assert found["frames"] == [True, True]
    assert found["linked"][:2] == [True, [False] * 4]
    assert "is of another file" in found["linked"][2]


def test_copies_that_touch_are_marked_and_the_tile_stays(extension: Extension) -> None:
    """A sentence and a marker at the place; when they part the marker goes. So it is where nothing is drawn."""
    found, _ = extension.run("touching")
    assert found["said"].startswith("bird touches its own copy at (")
    said = [float(number) for number in re.findall(r"-?\d+\.?\d*", found["said"])[:2]]
    assert found["place"] == pytest.approx([*said, 0.0], abs=1e-2)
    for key in ("stays", "shown", "back", "hidden", "proved"):
        assert found[key], key
    assert found["nothing"].startswith("Nothing is drawn: ")


def test_all_kinds_of_drawings_are_read(extension: Extension) -> None:
    """NURBS as Blender draws them, grease pencil, its Bezier strokes exactly, objects that are moved and turned.

    Hidden layers are left out, and one that is deleted goes.
    """
    found, _ = extension.run("kinds")
    for away, ends in found["nurbs"].values():
        assert away < 1e-3  # of Blender's own chords; 4.2 cuts corners by 4e-4
        assert ends < 1e-6
    assert found["tile"] == ["", True, ["hand", "line"]]
    assert np.array(found["seen"]) == pytest.approx(np.array([[40.0, 9.0], [24.0, 9.0]]), abs=1e-5)
    assert found["strokes"] == 100
    if found["bezier"]:
        assert found["bezier"] == ["bezier", pytest.approx(2**0.5), pytest.approx(8**0.5), 100, 0]
    assert found["resized"]
    assert found["left"] == ["", True]
    assert found["tiles"] == ["hand"]
    assert found["gone"]
    assert found["another"] == ["pg", True]


def test_the_panel_asks_for_what_the_group_needs(extension: Extension) -> None:
    """Sides and angle by the group; a cell fits in each; solids and files are made, drawn sheets filled.

    A design that is opened brings its solid. What is missing is said, and not offered.
    """
    found, folder = extension.run("asking")
    assert {"Tile", "Starter", "Open a Design"} <= set(found["nothing"])
    assert {"Proved", "a", "b", "Angle", "Make Solids", "Export Tiles"} <= set(found["oblique"])
    assert not {"b", "Angle"} & set(found["hexagonal"])
    assert ["Smoothing" in found[key] for key in ("oblique", "smoothed")] == [False, True]
    assert list(found["fitted"]) == list(vt.GROUPS)
    for group, (message, proved, flat) in found["fitted"].items():
        assert (message, proved) == ("", True), group
        assert flat == pytest.approx(20.0)
    assert found["prisms"][0] == found["lofts"][0] == "FINISHED"
    assert found["prisms"][1].startswith("closed; ")
    assert all(closed and volume > 0 for closed, volume in found["closed"])
    assert found["volumes"] == pytest.approx([20.0 * 900.0], rel=1e-5)
    assert min(found["files"].values()) > 100
    assert vt.Design.load(folder / "out.toml").lattice.a == 120.0
    assert vt.Design.load(folder / "inch.toml").lattice.a == 60 * 25.4
    assert "0.15000" not in (folder / "inch.svg").read_text()
    assert (folder / "out.gcode").read_text().count("F300") > 0
    for said, what in zip(found["refused"], ("out.dxf has no suffix of ours", "No module named 'ezdxf'"), strict=True):
        assert what in said
        assert "Traceback" not in said
    assert not {"out.dxf", "other.svg"} & {file.name for file in folder.iterdir()}
    assert found["opened"] == ["fish", "p4", 120.0, 1.0, True, 40.0, 10.0, [30.0, 30.0], 5]
    assert found["lacking"][0].startswith("No solids")
    assert found["solids"] is False
    assert found["other"][0].startswith("voronoi_tiles 0.0.1 is loaded")
    assert found["old"][0].startswith("On Windows numpy 2 is needed")
    assert " ".join(found["said"]) == found["old"][0]
