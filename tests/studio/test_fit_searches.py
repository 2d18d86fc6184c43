"""Searches for designs that fit an outline: the newest one goes on, and ends with whoever takes what it says."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import aclosing
from typing import Any

import pytest
from test_lanes import in_lane, is_alive, is_gone

from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.studio.fit_searches import LOOKED_TOO_LONG, REPLACED, FitSearches
from voronoi_tiles.studio.lanes import Lane


def searching(story: Callable[[FitSearches], Awaitable[None]], **options: Any) -> None:
    """Run a story with searches of a toy that says its process, finds so many designs and has art for every other."""

    async def run(served: Lane) -> None:
        await story(FitSearches(served))

    in_lane(run, **options)


async def all_of(searches: FitSearches, **asked: Any) -> list[dict[str, Any]]:
    """All that a search says."""
    return [message async for message in searches.messages(asked, b"drawn")]


def test_art_is_kept_until_the_next_search() -> None:
    """Under the number that was said of it; designs without art have none."""

    async def story(searches: FitSearches) -> None:
        first, *found, last = await all_of(searches, count=3)
        assert (first["type"], last) == ("outline", {"type": "done"})
        assert ["number" in message for message in found] == [True, False, True]
        arts = [searches.art(found[k]["number"]) for k in (0, 2)]
        assert [(art.table, art.svg) for art in arts] == [({"scale": 0}, b"drawn 0"), ({"scale": 2}, b"drawn 2")]
        again = await all_of(searches, count=1)
        assert searches.art(again[1]["number"]).svg == b"drawn 0"
        for gone in (found[0]["number"], found[2]["number"], -1, None, "1"):
            with pytest.raises(ArgumentError, match="another search"):
                searches.art(gone)

    searching(story)


def test_a_newer_search_takes_the_place() -> None:
    """The one before is told, its process ended, and nothing of it is kept."""

    async def story(searches: FitSearches) -> None:
        heard: list[dict[str, Any]] = []

        async def listen() -> None:
            async for message in searches.messages({"count": 1, "spin": True}, b"old"):
                heard.append(message)  # noqa: PERF401 - what was heard so far is looked at

        listening = asyncio.create_task(listen())
        while len(heard) < 2:  # noqa: ASYNC110 - what is waited for knows of no event
            await asyncio.sleep(0.01)
        newer = await all_of(searches, count=1)
        await listening
        assert heard[-1] == {"type": "failed", "error": REPLACED}
        assert is_gone(heard[0]["pid"])
        assert searches.art(newer[1]["number"]).svg == b"drawn 0"
        with pytest.raises(ArgumentError):
            searches.art(heard[1]["number"])

    searching(story, limit_s=60)


def test_a_search_that_nobody_listens_to_ends() -> None:
    """Whoever has heard enough has its process ended; the designs that were found can be taken."""

    async def story(searches: FitSearches) -> None:
        async with aclosing(searches.messages({"count": 1, "spin": True}, b"drawn")) as messages:
            pid = (await anext(messages))["pid"]
            number = (await anext(messages))["number"]
            assert is_alive(pid)
        await asyncio.sleep(0.1)
        assert is_gone(pid)
        assert searches.art(number).svg == b"drawn 0"

    searching(story, limit_s=60)


def test_what_goes_wrong_is_the_last() -> None:
    """A refusal in its own words; a search that takes too long in minutes of its own limit."""

    async def story(searches: FitSearches) -> None:
        assert [message["type"] for message in await all_of(searches, count=0)] == ["outline", "done"]
        wrong = await all_of(searches, count=2, wrong=True)
        assert wrong[-1] == {
            "type": "failed",
            "error": {"message": "the `kerf` is wrong.", "remedy": "Mend it.", "key": "kerf"},
        }
        slow = await all_of(searches, count=1, spin=True)
        assert slow[-1] == {"type": "failed", "error": LOOKED_TOO_LONG}
        assert "5 minutes" in LOOKED_TOO_LONG["message"]

    searching(story, limit_s=3.0)
