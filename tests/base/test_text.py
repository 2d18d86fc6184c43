"""Texts for people."""

from __future__ import annotations

import pytest

from voronoi_tiles.base.text import counted


@pytest.mark.parametrize(
    ("count", "nouns", "text"),
    [
        (1, ("error",), "1 error"),
        (0, ("error",), "0 errors"),
        (2_000, ("error",), "2,000 errors"),
        (1, ("copy", "copies"), "1 copy"),
        (12, ("copy", "copies"), "12 copies"),
    ],
)
def test_a_count_has_its_noun(count: int, nouns: tuple[str, ...], text: str) -> None:
    """One is one, and all others are many."""
    assert counted(count, *nouns) == text
