"""Files of solids: what their bytes say, what other readers make of them, and that nothing is left half done."""

from __future__ import annotations

import io
import json
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import numpy as np
import pytest
from helpers.examples import tiling

from voronoi_tiles import ArgumentError, Design, OutputError, SolidJob, SolidModel, extrude
from voronoi_tiles.formats.recipe import recipe_of

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"


@pytest.fixture(scope="module")
def model() -> SolidModel:
    """A sheet of two kinds of tiles, parted."""
    return extrude(tiling("p4m"), SolidJob(sheet="130x130mm", clearance=0.2, height=2))


@pytest.fixture(scope="module")
def coloured() -> SolidModel:
    """A sheet in three colours; neighbours touch."""
    return extrude(tiling("p3"), SolidJob(sheet="120x120mm", colours="fewest"))


def test_an_stl_file_holds_every_triangle(model: SolidModel, tmp_path: Path) -> None:
    """In single precision, with normals of length 1 that belong to the corners' order."""
    model.save(tmp_path / "a.stl")
    data = (tmp_path / "a.stl").read_bytes()
    assert not data.startswith(b"solid")
    assert data[:80].rstrip().decode() == f"voronoi-tiles 0.2.0: {model.title}"
    rows = np.frombuffer(data[84:], np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")]))
    assert len(rows) == int.from_bytes(data[80:84], "little") == sum(len(one.mesh.triangles) for one in model.pieces)
    corners = np.concatenate([one.mesh.corners for one in model.pieces])
    assert (rows["corners"] == corners.astype(np.float32)).all()
    assert np.linalg.norm(rows["normal"], axis=1) == pytest.approx(1.0, abs=1e-6)
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(cross, axis=1)
    assert (cross * rows["normal"]).sum(axis=1) == pytest.approx(areas, rel=1e-5, abs=1e-9)


def parts(data: bytes) -> dict[str, str]:
    """The texts in a 3MF file."""
    with zipfile.ZipFile(io.BytesIO(data)) as package:
        assert package.testzip() is None
        return {name: package.read(name).decode() for name in package.namelist()}


def saved(model: SolidModel, path: Path) -> bytes:
    """The bytes of a file."""
    model.save(path)
    return path.read_bytes()


def test_a_3mf_file_holds_an_object_for_each_piece(model: SolidModel, tmp_path: Path) -> None:
    """In millimetres with all digits, each with its name and the colour of its site."""
    root = ET.fromstring(parts(saved(model, tmp_path / "a.3mf"))["3D/3dmodel.model"])
    assert root.get("unit") == "millimeter"
    bases = [base.get("displaycolor") for base in root.iter(f"{CORE}base")]
    objects = list(root.iter(f"{CORE}object"))
    assert [one.get("name") for one in objects] == [piece.name for piece in model.pieces]
    assert len(set(bases)) == 2
    for one, piece in zip(objects, model.pieces, strict=True):
        rows = [[float(v.get(axis, "")) for axis in "xyz"] for v in one.iter(f"{CORE}vertex")]
        assert (np.array(rows) == piece.mesh.vertices).all()
        triangles = [[int(t.get(name, "")) for name in ("v1", "v2", "v3")] for t in one.iter(f"{CORE}triangle")]
        assert (np.array(triangles) == piece.mesh.triangles).all()
        assert bases[int(one.get("pindex", ""))] == model.colours[piece.colour].upper()
    assert [item.get("objectid") for item in root.iter(f"{CORE}item")] == [one.get("id") for one in objects]


def test_the_pieces_of_a_colour_are_one_object(coloured: SolidModel, tmp_path: Path) -> None:
    """Three are built, of components that have all pieces."""
    root = ET.fromstring(parts(saved(coloured, tmp_path / "a.3mf"))["3D/3dmodel.model"])
    objects = {one.get("id"): one for one in root.iter(f"{CORE}object")}
    built = [objects[item.get("objectid")] for item in root.iter(f"{CORE}item")]
    assert [one.get("name") for one in built] == ["colour 1", "colour 2", "colour 3"]
    found = [[objects[part.get("objectid")] for part in one.iter(f"{CORE}component")] for one in built]
    assert [{part.get("pindex") for part in group} for group in found] == [{"0"}, {"1"}, {"2"}]
    assert sum(map(len, found)) == len(coloured.pieces)


def test_a_3mf_file_can_be_made_again(coloured: SolidModel, tmp_path: Path) -> None:
    """From its metadata, to the byte."""
    data = saved(coloured, tmp_path / "a.3mf")
    recipe = recipe_of(data)
    assert (recipe["program"], recipe["version"]) == ("voronoi-tiles", "0.2.0")
    tiles = Design.loads(recipe["design"]).tessellate()
    assert saved(extrude(tiles, SolidJob(**json.loads(recipe["solid"]))), tmp_path / "b.3mf") == data


@pytest.mark.parametrize("cut", [10, 100, 2000])
def test_a_3mf_file_that_is_broken_has_no_recipe(cut: int, model: SolidModel, tmp_path: Path) -> None:
    """Nor has another zip archive."""
    assert recipe_of(saved(model, tmp_path / "a.3mf")[:cut]) == {}
    with zipfile.ZipFile(tmp_path / "b.zip", "w") as other:
        other.writestr("3D/3dmodel.txt", "vt:design")
    assert recipe_of((tmp_path / "b.zip").read_bytes()) == {}


@pytest.mark.parametrize("way", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
@pytest.mark.parametrize("wrong", ["encrypted", "broken"])
def test_a_zip_archive_that_cannot_be_read_has_no_recipe(way: int, wrong: str, tmp_path: Path) -> None:
    """Whatever it is packed by: the bit that says encrypted is set, or bytes in the middle are others."""
    with zipfile.ZipFile(path := tmp_path / "a.3mf", "w", way) as package:
        package.writestr("3D/3dmodel.model", '<metadata name="vt:design">schema = 1</metadata>' + "padding " * 40)
        begin = len("3D/3dmodel.model") + 30
    assert recipe_of(path.read_bytes()) == {"design": "schema = 1"}
    data = bytearray(path.read_bytes())
    if wrong == "encrypted":
        for head, at in ((b"PK\3\4", 6), (b"PK\1\2", 8)):
            data[data.index(head) + at] |= 1
    else:
        data[begin : begin + 40] = b"\xff" * 40
    assert recipe_of(bytes(data)) == {}


def test_a_name_may_hold_anything(tmp_path: Path) -> None:
    """It is a text of XML."""
    design = tiling("p4").design
    odd = extrude(Design.loads(design.source.replace("bird", "a<b>&c'd")).tessellate())
    root = ET.fromstring(parts(saved(odd, tmp_path / "a.3mf"))["3D/3dmodel.model"])
    assert [one.get("name") for one in root.iter(f"{CORE}object")] == ["a<b>&c'd"]


@pytest.mark.parametrize("name", ["a.step", "a", "a.3mf.txt"])
def test_another_format_is_refused(name: str, model: SolidModel, tmp_path: Path) -> None:
    """And nothing is written."""
    with pytest.raises(OutputError, match=r"give it the suffix \.3mf or \.stl"):
        model.save(tmp_path / name)
    with pytest.raises(ArgumentError, match="no solid can be written as 'step'"):
        model.save(tmp_path / name, "step")  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("form", ["3mf", "stl"])
def test_a_full_disk_is_an_error(form: str, model: SolidModel) -> None:
    """One message."""
    with pytest.raises(OutputError, match="No space left on device"):
        model.save("/dev/full", form)  # type: ignore[arg-type]


def missing(reason: str) -> None:
    """Leave the test out, with a reason; VORONOI_TILES_REQUIRE_SLICER=1 makes it fail."""
    if os.environ.get("VORONOI_TILES_REQUIRE_SLICER") == "1":
        pytest.fail(reason)
    pytest.skip(reason)


def slicer(*arguments: object) -> str:
    """What PrusaSlicer says."""
    if shutil.which("prusa-slicer") is None:
        missing("prusa-slicer is not installed")
    done = subprocess.run(
        ["prusa-slicer", *map(str, arguments)],  # noqa: S607 - found on the path
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("form", ["3mf", "stl"])
@pytest.mark.parametrize("which", ["model", "coloured"])
def test_a_slicer_takes_it_as_it_is(form: str, which: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    """All parts, no hole, the volume; pieces that touch are parts of their own as well."""
    model: SolidModel = request.getfixturevalue(which)
    model.save(tmp_path / f"a.{form}")
    said = slicer("--info", tmp_path / f"a.{form}")
    assert set(re.findall(r"manifold = (\w+)", said)) == {"yes"}
    assert sum(map(int, re.findall(r"number_of_parts =\s+(\d+)", said))) == len(model.pieces)
    assert sum(map(float, re.findall(r"volume = ([\d.]+)", said))) == pytest.approx(model.volume, rel=1e-5)


@pytest.mark.slow
def test_a_slicer_slices_it(tmp_path: Path) -> None:
    """As much filament as the solid takes, at full density."""
    model = extrude(tiling("p4"), SolidJob(clearance=0.2, chamfer=0.3))
    model.save(tmp_path / "a.3mf")
    full = ("--fill-density", "100%", "--fill-pattern", "rectilinear", "--skirts", "0", "--filament-diameter", "1.75")
    slicer("-g", *full, "-o", tmp_path / "a.gcode", tmp_path / "a.3mf")
    used = re.search(r"filament used \[cm3\] = ([\d.]+)", (tmp_path / "a.gcode").read_text())
    assert used
    assert float(used[1]) * 1000 == pytest.approx(model.volume, rel=0.1)
