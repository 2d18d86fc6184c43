"""What the page downloads is what the command line writes, and what it is shown of a job is what would be cut."""

from __future__ import annotations

import io
import itertools
import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest
from helpers.outlines import CommandLine

from voronoi_tiles.base.errors import ArgumentError, DesignError, VoronoiTilesError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.starters import starter, starter_text
from voronoi_tiles.fabrication.arc_fitting import edge_arcs
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.studio.making import _kept, coupon_file, exported, product, read_options
from voronoi_tiles.studio.tables import page_tables

JOBS: dict[str, dict[str, Any]] = {
    "exact": {},
    "sheet": {"sheet": "90x90mm", "margin": 5, "kerf": "0.15mm"},
    "frame": {"sheet": [150, 100], "margin": 6, "frame": 4.0, "marks": True, "bar": True},
    "lightburn": {"preset": "lightburn", "labels": "number", "rotate": 30},
}


def flags(job: Mapping[str, Any]) -> list[str]:
    """The options of the command line that say the same as those of the page."""
    found = []
    for name, value in job.items():
        text = "x".join(map(str, value)) if isinstance(value, list) else str(value)
        found += [f"--{name.replace('_', '-')}"] if value is True else [f"--{name.replace('_', '-')}", text]
    return found


QUICK = {("exact", "json"), ("exact", "svg"), ("lightburn", "lbrn2"), ("lightburn", "dxf"), ("lightburn", "gcode")}
"""What the quick tests compare, of all jobs and formats."""


@pytest.mark.parametrize(
    ("name", "form"),
    [
        case if case in QUICK else pytest.param(*case, marks=pytest.mark.slow)
        for case in [("exact", "json"), *itertools.product(JOBS, ("svg", "dxf", "pdf", "lbrn2", "gcode"))]
    ],
)
def test_downloads_are_what_the_command_line_writes(
    name: str, form: str, tmp_path: Path, voronoi_tiles: CommandLine
) -> None:
    """Byte for byte, of the design that is saved, whatever its numbers look like on their way to the page and back."""
    (tmp_path / "my bird.toml").write_text(starter_text("p4"), encoding="utf-8")
    sent = json.loads(json.dumps(Design.load(tmp_path / "my bird.toml").to_dict()))
    burn = {"feed": "300,engrave=3000", "power": "800,engrave=150"} if form == "gcode" else {}
    job = {**JOBS[name], **burn}
    file, data = exported(sent, {**job, "format": form}, "my bird")
    assert file == f"my-bird.{form}"
    call = ["export", "my bird.toml", "-o", f"cut.{form}", *flags(job)]
    assert voronoi_tiles(*call, cwd=tmp_path).returncode == 0
    assert data == (tmp_path / f"cut.{form}").read_bytes()


def test_gcode_without_feed_and_power_names_their_fields() -> None:
    """So that the page can show where they are missing."""
    with pytest.raises(ArgumentError) as caught:
        exported(starter("p4").to_dict(), {"format": "gcode"}, "bird")
    assert caught.value.fields == ("feed", "power")


@pytest.mark.slow
def test_a_file_for_each_colour_comes_in_one(tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """A zip with the files that the command line writes; the same job gives the same zip."""
    job = {"sheet": "200x150mm", "colours": "files"}
    design = starter("p4").to_dict()
    file, data = exported(design, {**job, "format": "svg"}, "bird")
    assert (file, data) == exported(design, {**job, "format": "svg"}, "bird")
    (tmp_path / "bird.toml").write_text(starter_text("p4"), encoding="utf-8")
    assert voronoi_tiles("export", "bird.toml", "-o", "bird.svg", *flags(job), cwd=tmp_path).returncode == 0
    with ZipFile(io.BytesIO(data)) as zipped:
        files = {name: zipped.read(name) for name in zipped.namelist()}
    assert file == "bird.zip"
    assert files == {path.name: path.read_bytes() for path in tmp_path.glob("*.svg")}
    assert len(files) > 1


@pytest.mark.slow
def test_a_picture_can_be_had() -> None:
    """As a PNG file, in the job's colours."""
    file, data = exported(starter("p4").to_dict(), {"format": "png"}, "../odd/name")
    assert file == "odd-name.png"
    assert data.startswith(b"\x89PNG")


@pytest.mark.parametrize("name", ["\u65e5" * 100, "a" * 200, "\u00e9" * 100 + "."])
def test_long_names_are_cut(name: str) -> None:
    """Where letters take several bytes, too: the file can be written, and kept by whoever downloads it."""
    file, data = exported(starter("p4").to_dict(), {"format": "json"}, name)
    stem = file.removesuffix(".json")
    assert name.startswith(stem)
    assert 100 < len(file.encode()) < 200
    assert json.loads(data)


def test_a_coupon_is_that_of_the_command_line(tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """Byte for byte."""
    options = {"thickness": "3mm", "kerfs": "0.1:0.3:0.1", "plug": "12mm", "preset": "lightburn"}
    assert voronoi_tiles("coupon", "-o", "coupon.dxf", *flags(options), cwd=tmp_path).returncode == 0
    assert coupon_file({**options, "format": "dxf"}) == ("coupon.dxf", (tmp_path / "coupon.dxf").read_bytes())


@pytest.mark.parametrize(
    ("form", "sign"),
    [
        ("svg", b"<svg "),
        ("dxf", b"\nENTITIES\n"),
        ("pdf", b"%PDF-"),
        ("lbrn2", b"<LightBurnProject "),
        ("gcode", b"\nG1 "),
    ],
)
def test_a_coupon_in_every_format_of_the_page(form: str, sign: bytes) -> None:
    """For G-code with the job's feed and power, which it needs."""
    assert form in page_tables()["coupon"]
    burn = {"preset": "lightburn", "feed": "cut=300,engrave=3000", "power": "cut=800,engrave=150"}
    name, data = coupon_file({"thickness": "3mm", "kerfs": "0.1", "format": form, **burn})
    assert name == f"coupon.{form}"
    assert sign in data


def test_the_page_is_shown_what_is_cut() -> None:
    """Layers, report and findings of one and the same drawing, y down from the upper left corner."""
    design = starter("p4").to_dict()
    job: dict[str, Any] = {"sheet": "120x100mm", "margin": 5, "edges": "pieces"}
    shown = json.loads(json.dumps(product(3, design, job, {}, "bird"), allow_nan=False))
    expected = starter("p4").tessellate().report(Job(**job))
    assert (shown["type"], shown["rev"]) == ("product", 3)
    assert shown["sheet"] == shown["page"] == {"width": 120.0, "height": 100.0}
    assert {key: value for key, value in shown["report"].items() if key != "design"} == {
        key: value for key, value in json.loads(json.dumps(expected)).items() if key != "design"
    }
    (layer,) = shown["layers"]
    assert (layer["name"], layer["kind"], layer["closed"], layer["filled"]) == ("cut", "cut", True, False)
    assert layer["path"].count("M") == layer["path"].count("Z") == shown["report"]["pieces"]["count"]
    numbers = [float(number) for number in re.findall(r"-?[\d.]+", layer["path"])]
    assert all(5 - 1e-6 <= x <= 115 + 1e-6 for x in numbers[::2])
    assert all(5 - 1e-6 <= y <= 95 + 1e-6 for y in numbers[1::2])
    # Pieces that lie on each other are cut twice.
    kinds = {finding["kind"] for finding in shown["findings"]}
    assert "duplicate" in kinds
    assert shown["found"] == len(shown["findings"])
    assert all(0 <= x <= 120 and 0 <= y <= 100 for x, y in (f["at"] for f in shown["findings"] if f["at"]))
    assert shown["findings"][0]["severity"] == "error"
    assert any("twice" in note for note in shown["notes"])
    apart = {**job, "gap": 2}
    assert "duplicate" not in {finding["kind"] for finding in product(3, design, apart, {}, "bird")["findings"]}
    tight = product(3, design, {**job, "gap": 20}, {}, "bird")["notes"]
    assert [note for note in tight if re.fullmatch(r"With a gap of 10 mm \d+ tiles would fit", note)]
    few, many = (product(3, design, apart, {"neck": neck}, "bird")["found"] for neck in (0, "3mm"))
    assert few < many


def test_arcs_are_fitted_once_while_the_design_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half the time of a job with a kerf goes into them; whatever changes, what is shown is of that design and job."""
    fits: list[object] = []

    def counted(*given: Any, **more: Any) -> Any:
        fits.append(given)
        return edge_arcs(*given, **more)

    monkeypatch.setattr("voronoi_tiles.fabrication.arc_fitting.edge_arcs", counted)
    job: dict[str, Any] = {"kerf": 0.15, "accuracy": 0.02}
    designs = [moved(by) for by in (0.0, 1e-6, 0.0)]
    jobs = [job, {**job, "accuracy": 0.05}, {**job, "kerf": 0.2}]
    for changed in designs:
        for asked in jobs:
            shown = product(1, changed, asked, {}, "bird")
            _kept.cache_clear()
            assert comparable(shown) == comparable(product(1, changed, asked, {}, "bird"))
    _kept.cache_clear()
    fits.clear()
    for margin in (1, 2, 3):
        product(1, designs[0], {**job, "margin": margin}, {}, "bird")
    assert len(fits) == 1


def moved(by: float) -> dict[str, Any]:
    """A starter with a point moved."""
    design: dict[str, Any] = json.loads(json.dumps(starter("p4").to_dict()))
    design["site"][0]["strokes"][0]["catmull_rom"][0][0] += by
    return design


def comparable(shown: dict[str, Any]) -> dict[str, Any]:
    """What is shown, but for how long it took."""
    return {key: value for key, value in shown.items() if key != "ms"}


def test_one_of_each_has_a_page_and_no_sheet() -> None:
    """Without a sheet the page is what holds the tiles."""
    shown = product(3, starter("p4m").to_dict(), {}, {}, "pair")
    assert shown["sheet"] is None
    assert shown["page"]["width"] > 10
    assert shown["report"]["pieces"]["count"] == 2


@pytest.mark.parametrize(
    ("job", "key"),
    [
        ({"kerf": "x"}, "kerf"),
        ({"kerf": -1}, "kerf"),
        ({"fit": "tight"}, "fit"),
        ({"frame": 4}, "frame"),
        ({"format": "doc"}, "format"),
        ({"format": "dxf", "preset": "glowforge"}, "preset"),
        ({"preset": "nobody"}, "preset"),
        ({"only_colour": 1}, None),
        ({"nothing": 1}, None),
        ({"sheet": "10x10mm"}, None),
        ({"sheet": "missing.svg"}, None),
        ({"sheet": "99x99mm", "layout": "nested"}, "layout"),
    ],
)
def test_jobs_that_cannot_be_are_refused(job: dict[str, Any], key: str | None) -> None:
    """By an error that names the option."""
    with pytest.raises(VoronoiTilesError) as caught:
        product(1, starter("p4").to_dict(), job, {}, "bird")
    if key is not None:
        error = caught.value
        assert key in (error.fields if isinstance(error, ArgumentError) else (getattr(error, "key", None),))


def test_other_options_and_limits_are_refused() -> None:
    """There is no option that the page does not know of."""
    with pytest.raises(ArgumentError, match="no limit 'width'"):
        product(1, starter("p4").to_dict(), {}, {"width": 3}, "bird")
    with pytest.raises(ArgumentError, match="'path'"):
        coupon_file({"thickness": 3, "path": "elsewhere/x.svg"})
    with pytest.raises(ArgumentError, match="thickness"):
        coupon_file({})
    with pytest.raises(ArgumentError, match="'stl'"):
        coupon_file({"thickness": 3, "format": "stl"})
    with pytest.raises(DesignError):
        coupon_file({"thickness": 3, "preset": "nobody"})
    assert read_options({"kerf": 0.1, "format": "pdf"}) == (Job(kerf=0.1), "pdf")
