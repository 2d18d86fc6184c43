"""The page's modules without a DOM: their own tests under node, and their curves and groups against Python's."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import pytest
from helpers.page import TESTS, node
from helpers.page_vectors import vectors

SUITES = sorted(path for path in (TESTS / "page").glob("*.test.js") if path.name != "vectors.test.js")


@pytest.fixture(scope="module")
def expected() -> dict[str, Any]:
    """What Python has."""
    return vectors()


def run(suite: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a file of tests under node."""
    return subprocess.run(
        [node(), "--test", "--test-reporter=spec", suite],
        env={**os.environ, **environment},
        capture_output=True,
        encoding="utf-8",
        timeout=600,
        check=False,
    )


def run_vectors(folder: Path, expected: dict[str, Any]) -> subprocess.CompletedProcess[str]:
    """Compare the page's model with vectors."""
    file = folder / "vectors.json"
    file.write_text(json.dumps(expected), encoding="utf-8")
    return run(TESTS / "page" / "vectors.test.js", VORONOI_TILES_VECTORS=str(file))


@pytest.mark.parametrize("suite", SUITES, ids=lambda path: path.name)
def test_page_modules(suite: Path) -> None:
    """Each file of tests passes, with none left out."""
    done = run(suite)
    assert done.returncode == 0, done.stdout
    assert "skipped 0" in done.stdout


@pytest.mark.slow
def test_ten_thousand_stories() -> None:
    """10,000 random sequences of edits, undo and redo come back to the same bytes."""
    done = run(TESTS / "page" / "history.test.js", VORONOI_TILES_STORIES="10000")
    assert done.returncode == 0, done.stdout
    assert "10000 random stories" in done.stdout


@pytest.mark.slow
def test_lists_at_many_samples() -> None:
    """The candidate lists hold all that matters at 12 samples of each frame, where the quick test looks at 2."""
    done = run(TESTS / "page" / "lists.test.js", VORONOI_TILES_SAMPLES="12")
    assert done.returncode == 0, done.stdout
    assert "at 12 samples" in done.stdout


def test_model_is_pythons(tmp_path: Path, expected: dict[str, Any]) -> None:
    """Curves, lattices, motions, symmetry elements and copies are the same numbers to 1e-12 of their size."""
    done = run_vectors(tmp_path, expected)
    assert done.returncode == 0, done.stdout
    assert "pass 6" in done.stdout


def test_broken_vectors_are_seen(tmp_path: Path, expected: dict[str, Any]) -> None:
    """A number that is off by 1e-11 of its size, or one copy too few, fails the test that it belongs to."""
    broken = json.loads(json.dumps(expected))
    off = 1.0 + 1e-11
    broken["strokes"][40]["cubics"][-1] *= off
    broken["flattened"][7]["segments"][-1] *= off
    broken["groups"][14]["motions"][1]["a"][1] *= off
    broken["groups"][13]["elements"][0]["mirrors"][-1][1][0] *= off
    broken["groups"][-1]["sites"][-1]["operations"].pop()
    done = run_vectors(tmp_path, broken)
    assert done.returncode == 1
    assert "pass 1" in done.stdout
    assert "fail 5" in done.stdout
