"""Other makers' programs read our files as docs/readers.md says, and what judges them sees each kind of fault."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import pytest
from helpers.programs import ACCURACY, DIGITS, FILES, PROGRAMS, Program
from helpers.readers import Exact, Files, MissingProgramError, Reading, judge

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs" / "generate"))

import readers as page  # noqa: E402 - a script of the documentation, in no package

MEASURED: dict[str, Any] = json.loads(page.MEASURED.read_text(encoding="utf-8"))

COARSE = {"LibreCAD", "resvg", "svg-to-gcode"}
"""Programs that are measured on a raster, or make chords of 0.01 mm of whatever they are sent."""


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Files:
    """The files, written once."""
    return Files(tmp_path_factory.mktemp("files"))


def missing(program: Program, reason: str) -> NoReturn:
    """Leave a test out, with the reason; VORONOI_TILES_REQUIRE_READERS=1 makes it fail, but for what is too large."""
    if os.environ.get("VORONOI_TILES_REQUIRE_READERS") == "1" and not program.heavy:
        pytest.fail(reason)
    pytest.skip(reason)


def test_the_page_is_what_was_measured() -> None:
    """Every program has its row, made of the figures that are kept."""
    assert list(MEASURED) == sorted(program.name for program in PROGRAMS)
    assert page.PAGE.read_text(encoding="utf-8") == page.page(MEASURED)


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda program: program.name)
def test_what_is_to_be_sent_arrives(program: Program) -> None:
    """The file that the page says to send comes in with all contours, closed, in its size, within the accuracy."""
    for name in program.recommended:
        found = MEASURED[program.name]["files"][name]
        assert found["deviation"] <= (0.02 if program.name in COARSE else ACCURACY + DIGITS)
        assert found["contours"] in (None, found["drawn"])
        assert not found["loose"]
        assert not found["mirrored"]


@pytest.mark.slow
@pytest.mark.parametrize("program", PROGRAMS, ids=lambda program: program.name)
def test_the_program_reads_what_the_page_says(program: Program, files: Files) -> None:
    """The first file that is to be sent, read anew."""
    name = program.recommended[0]
    try:
        version, verdict = files.judged(program, name)
    except MissingProgramError as error:
        missing(program, str(error))
    kept = MEASURED[program.name]
    if version != kept["version"]:
        missing(
            program, f"{program.name} is {version} here, the page has {kept['version']}: `make readers` measures it"
        )
    found = kept["files"][name]
    assert (verdict.contours, verdict.loose, verdict.mirrored) == (found["contours"], found["loose"], found["mirrored"])
    assert verdict.deviation == pytest.approx(found["deviation"], rel=0.05, abs=1e-4)
    assert verdict.scale == pytest.approx(found["scale"], abs=1e-4)


# --- what judges ---------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def exact(files: Files) -> Exact:
    """The outlines of two pieces."""
    return files.exact("SVG")


def as_read(exact: Exact) -> Reading:
    """A program that has read all as it is, somewhere else on its page."""
    contours = tuple(points + 20 - 7j for points in exact.contours)
    return Reading("1", contours, (True,) * len(contours), True, {}, None, exact.area)


def test_what_is_right_is_found_right(exact: Exact) -> None:
    """Wherever it is on the page."""
    verdict = judge(as_read(exact), exact)
    assert verdict.deviation < 1e-9
    assert verdict.scale == pytest.approx(1.0)
    assert (verdict.contours, verdict.loose, verdict.mirrored, verdict.area) == (3, 0, False, 0.0)


def test_the_area_of_the_outlines_is_that_of_the_cell(exact: Exact) -> None:
    """A quarter of a cell of 60 mm in p4, by the exact tiles and by the sampled outlines that they are judged by."""
    x, y = (np.concatenate([getattr(points, part) for points in exact.contours]) for part in ("real", "imag"))
    assert exact.area == pytest.approx(900.0)
    assert len(x) == len(y)
    areas = [abs((points[:-1].conjugate() * points[1:]).imag.sum()) / 2 for points in exact.contours]
    ring, *stones = sorted(areas, reverse=True)
    assert stones[0] == pytest.approx(stones[1])  # the hole, and what lies in it
    assert ring - stones[0] + stones[1] == pytest.approx(900.0, abs=1e-3)


@pytest.mark.parametrize(
    ("broken", "seen"),
    [
        (lambda points: points * 25.4, lambda verdict: verdict.scale == pytest.approx(25.4)),
        (lambda points: points.conjugate(), lambda verdict: verdict.mirrored),
        (lambda points: points * 1.001, lambda verdict: 0.02 < verdict.deviation < 0.04),
        (lambda points: points + 0.02j * np.sin(points.real), lambda verdict: 0.015 < verdict.deviation < 0.021),
    ],
    ids=["inches", "mirror", "scale", "bent"],
)
def test_a_fault_is_seen(exact: Exact, broken: Callable[[Any], Any], seen: Callable[[Any], bool]) -> None:
    """Another unit, a mirror image, a scale that is a thousandth off, bent curves."""
    reading = as_read(exact)
    assert seen(judge(replace(reading, contours=tuple(broken(points) for points in reading.contours)), exact))


def test_lost_and_open_contours_are_counted(exact: Exact) -> None:
    """A contour that is missing, one that is open, a file that comes in empty."""
    reading = as_read(exact)
    assert judge(replace(reading, contours=reading.contours[1:], closed=reading.closed[1:]), exact).contours == 2
    assert judge(replace(reading, closed=(True, False, True)), exact).loose == 1
    assert judge(replace(reading, contours=(), closed=()), exact).scale == 0.0


def test_presets_are_tried_in_what_they_read() -> None:
    """A file for each preset that is named after a program."""
    presets = {file.job["preset"] for file in FILES.values() if "preset" in file.job}
    assert presets == {name.split()[0] for program in PROGRAMS for name in program.files if name.split()[0] in presets}
