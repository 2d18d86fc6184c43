"""The page on architecture tells the truth: what it names exists, and every package has a line."""

from __future__ import annotations

import re
from pathlib import Path

from test_layering import RANKS

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")


def test_every_file_that_the_page_names_exists() -> None:
    """Modules, packages, tests."""
    named = set(re.findall(r"`((?:voronoi_tiles|vector|raster|tests)/[\w./]*)`", PAGE))
    assert len(named) > 40
    assert {name for name in named if not (ROOT / name).exists()} == set()


def test_every_package_has_its_line_in_the_order_of_ranks() -> None:
    """The table of ranks is that of the test of layers."""
    rows = re.findall(r"^\| (\d) \| `(?:voronoi_tiles/)?(\w+?)(?:\.py)?/?` \|", PAGE, re.MULTILINE)
    packages = {name: int(rank) for rank, name in rows}
    expected = {name: rank for rank, names in enumerate(RANKS) for name in names}
    assert {name: packages.get(name) for name in expected} == expected
