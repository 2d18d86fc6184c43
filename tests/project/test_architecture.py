"""The documentation tells the truth about the tree: what its pages name exists, and every package has a line."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from test_layering import RANKS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
PAGES = ["README.md", "CONTRIBUTING.md", "bench/README.md", *(f"docs/{page.name}" for page in ROOT.glob("docs/*.md"))]


def named_in(page: str) -> set[str]:
    """The modules, packages and tests that a page names."""
    return set(re.findall(r"`((?:voronoi_tiles|vector|raster|tests)/[\w./]*)`", page))


@pytest.mark.parametrize("page", PAGES)
def test_every_file_that_a_page_names_exists(page: str) -> None:
    """Modules, packages, tests."""
    named = named_in((ROOT / page).read_text(encoding="utf-8"))
    assert {name for name in named if not (ROOT / name).exists()} == set()


def test_the_page_names_much() -> None:
    """It is the map of the tree."""
    assert len(named_in(PAGE)) > 40


def test_every_package_has_its_line_in_the_order_of_ranks() -> None:
    """The table of ranks is that of the test of layers."""
    rows = re.findall(r"^\| (\d+) \| `(?:voronoi_tiles/)?(\w+?)(?:\.py)?/?` \|", PAGE, re.MULTILINE)
    packages = {name: int(rank) for rank, name in rows}
    expected = {name: rank for rank, names in enumerate(RANKS) for name in names}
    assert {name: packages.get(name) for name in expected} == expected
