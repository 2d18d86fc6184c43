"""Our own files pass our own preflight, without a warning."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from helpers.cutting import squares
from helpers.examples import EXAMPLES, tiling

from voronoi_tiles import Job
from voronoi_tiles.preflight import preflight

SHEET = (300.0, 200.0)

CUBICS = "kerf, cubics"
"""The job whose curves DXF does not have."""

JOBS: dict[str, dict[str, Any]] = {
    "once": {},
    "once, frame": {"fit": "frame"},
    "once, tabs": {"tabs": 0.3, "edges": "once"},
    "pieces": {"gap": 1.5},
    "kerf": {"kerf": 0.15, "margin": 5.0},
    "kerf, tabs": {"kerf": 0.15, "tabs": 0.3},
    "kerf, arcs": {"kerf": 0.2, "curves": "arc", "colours": "layers"},
    CUBICS: {"kerf": 0.15, "curves": "cubic"},
    "kerf, chords": {"kerf": 0.15, "curves": "polyline"},
    "all": {
        "margin": 6.0,
        "kerf": 0.15,
        "fillet": 0.5,
        "tabs": 0.3,
        "labels": "number",
        "label_height": 4.0,
        "marks": True,
        "bar": True,
    },
}

PRESETS = {
    "svg": ("lightburn", "redcut", "ponoko", "boxes", "glowforge", "cnc", "meerk40t", "inkscape"),
    "dxf": ("lightburn", "redcut", "cnc"),
}


def serious(name: str, form: str, folder: Path, **job: Any) -> list[str]:
    """What preflight warns of in a sheet of a design."""
    path = folder / f"sheet.{form}"
    tiling(name).export(path, job=Job(sheet=SHEET, **job))
    return [f"{one.kind}: {one.message}" for one in preflight(path).findings if one.severity != "info"]


@pytest.mark.parametrize("form", ["svg", "dxf"])
@pytest.mark.parametrize("job", ["kerf", "all"])
def test_the_first_sheet_passes(form: str, job: str, tmp_path: Path) -> None:
    """The starter that README begins with, on a sheet with kerf, and with all that can be on one."""
    assert serious("p4", form, tmp_path, **JOBS[job]) == []


def test_what_optimisers_make_of_a_size_is_found(tmp_path: Path) -> None:
    """A page of ours whose size has become pixels, as SVGO writes it, though the file has its recipe yet."""
    path = tmp_path / "tile.svg"
    squares().export(path, edges="pieces")
    assert preflight(path).findings == ()
    path.write_text(re.sub(r'(width|height)="([\d.]+)mm"', r'\1="\2"', path.read_text()))
    assert [finding.kind for finding in preflight(path).findings] == ["unit"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("form", "job"), [("svg", job) for job in JOBS] + [("dxf", job) for job in JOBS if job != CUBICS]
)
def test_every_job_passes(form: str, job: str, tmp_path: Path) -> None:
    """A design that interlocks and one with mirrors."""
    for name in ("p4-hook", "pmm-lantern"):
        assert serious(name, form, tmp_path, **JOBS[job]) == []


@pytest.mark.slow
@pytest.mark.parametrize(("form", "preset"), [(form, preset) for form, some in PRESETS.items() for preset in some])
def test_every_preset_passes(form: str, preset: str, tmp_path: Path) -> None:
    """With and without kerf."""
    for job in ("once", "all"):
        assert serious("p3-puzzle", form, tmp_path, preset=preset, **JOBS[job]) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_passes(name: str, tmp_path: Path) -> None:
    """On a sheet with kerf."""
    assert serious(name, "svg", tmp_path, **JOBS["kerf"]) == []
