"""The art of designs, as the page is told of it: where it lies, and why it is not shown."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import voronoi_tiles as vt
from voronoi_tiles.studio import page_art
from voronoi_tiles.studio.outlining import Outliner

DOT = '<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="10mm" viewBox="0 0 20 10">{}</svg>'
LINE = '<path d="M 4 2 H 14 V 5" fill="none" stroke="black"/>'
"""In millimetres, y up: from (4, 8) to (14, 8) and (14, 5)."""


@pytest.fixture(autouse=True)
def beside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A drawing in the folder that a worker runs in."""
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "face.svg"
    file.write_text(DOT.format(LINE), encoding="utf-8")
    return file


def told(art: Any, rest: bool = True, **more: Any) -> Mapping[str, Any] | None:
    """What is said of a design's art."""
    design = vt.starter("p4").to_dict()
    site = {**design["site"][0], "art": art}
    message = next(Outliner().outlines(1, {**design, **more, "site": [site]}, rest=rest, tolerance=None)).message
    return message.get("art")


def points(document: Mapping[str, Any] | None) -> np.ndarray:
    """The points that the path data of the first site go through."""
    assert document is not None
    assert document["trouble"] is None
    numbers = np.array(re.findall(r"-?\d[\d.e-]*", document["paths"]["0"]), float)
    return np.asarray(numbers.reshape(-1, 2) @ np.array([1.0, 1j]))


@pytest.mark.parametrize("scale", [1.0, 2.5])
def test_art_lies_where_the_design_lays_it(scale: float) -> None:
    """Turned by a quarter and moved, in the units of the tiles beside it, which have the design's scale."""
    corners = np.array([4 + 8j, 14 + 8j, 14 + 5j])
    assert points(told("face.svg", scale=scale)) == pytest.approx(scale * corners)
    art = {"file": "face.svg", "scale": 2, "rotate": 90, "translate": [3, -1]}
    assert points(told(art, scale=scale)) == pytest.approx(scale * (2j * corners + 3 - 1j))


def test_only_at_rest(beside: Path) -> None:
    """While the pointer moves the page keeps what it has; a file that has changed is read again at rest."""
    assert told("face.svg", rest=False) is None
    before = points(told("face.svg"))
    beside.write_text(DOT.format(LINE.replace("M 4 2", "M 5 2")), encoding="utf-8")
    os.utime(beside, ns=(1, 1))
    assert points(told("face.svg")) == pytest.approx(before + np.array([1, 0, 0]))


def test_designs_without_art_have_none() -> None:
    """And nothing is wrong with them."""
    said = next(Outliner().outlines(1, vt.starter("p4").to_dict(), rest=True, tolerance=None)).message
    assert said["art"] == {"paths": {}, "trouble": None}


def test_what_cannot_be_shown_is_said(beside: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By its file, with what to do; the tiles are there all the same."""
    missing = told("eye.svg")
    assert missing is not None
    assert missing["paths"] == {}
    assert "eye.svg" in missing["trouble"]["message"] or "eye.svg" in str(missing["trouble"])
    assert missing["trouble"]["message"].startswith("Sheets will refuse this drawing")
    beside.write_text("<svg", encoding="utf-8")
    os.utime(beside, ns=(2, 2))
    broken = told("face.svg")
    assert broken is not None
    assert broken["trouble"]["remedy"]
    beside.write_text(DOT.format(LINE), encoding="utf-8")
    os.utime(beside, ns=(3, 3))
    monkeypatch.setattr(page_art, "SHOWN_MAX", 1)
    large = told("face.svg")
    assert large is not None
    assert "face.svg has 2 pieces" in large["trouble"]["message"]
