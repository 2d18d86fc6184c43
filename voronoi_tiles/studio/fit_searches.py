"""Searches for designs whose tiles come near to an outline: one at a time, the newest."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Mapping
from itertools import count
from typing import Any, Final, NamedTuple

from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.studio.lanes import TOO_LONG, Answer, Lane
from voronoi_tiles.studio.messages import FIT_SECONDS_MAX

LOOKED_TOO_LONG: Final = {
    "message": f"The search takes longer than {FIT_SECONDS_MAX // 60} minutes, and was given up.",
    "remedy": "Look in fewer groups; the command voronoi-tiles fit has no such limit.",
}
REPLACED: Final = {"message": "The search was given up for another one.", "remedy": "Look again."}


class FoundArt(NamedTuple):
    """The art of a design that was found: where it lies in it, as in a design file, and its drawing."""

    table: Mapping[str, Any]
    svg: bytes


class FitSearches:
    """Searches in a lane of their own, which nothing else waits for. The art of the newest one's designs is kept."""

    def __init__(self, lane: Lane) -> None:
        self.lane = lane
        self._asking: asyncio.Future[Answer] | None = None
        self._arts: dict[int, FoundArt] = {}
        self._numbers = count(1)

    async def messages(self, asked: Mapping[str, Any], data: bytes) -> AsyncGenerator[dict[str, Any], None]:
        """What a search for designs says, in the place of the one before; the last is "done", or "failed".

        A design with art has a "number". Where the messages are not taken any more the search is ended.
        """
        if self._asking is not None:
            self._asking.cancel()
        said: asyncio.Queue[Answer | None] = asyncio.Queue()
        asking = asyncio.ensure_future(self.lane.ask({"task": "fits", **asked}, data, part=said.put))
        asking.add_done_callback(lambda _: said.put_nowait(None))
        self._asking, self._arts = asking, {}
        try:
            while (answer := await said.get()) is not None:
                message = dict(answer.head["message"])
                if message.get("art") is not None:
                    message["number"] = next(self._numbers)
                    if self._asking is asking:
                        self._arts[message["number"]] = FoundArt(message["art"], answer.body)
                yield message
            error = REPLACED if asking.cancelled() else asking.result().error
            if error is None:
                yield {"type": "done"}
            else:
                yield {"type": "failed", "error": LOOKED_TOO_LONG if error == TOO_LONG else error}
        finally:
            asking.cancel()

    def art(self, number: object) -> FoundArt:
        """The art of a design of the newest search, by its number. Raises ArgumentError where there is none."""
        if not (isinstance(number, int) and number in self._arts):
            raise ArgumentError("its art is gone: another search has begun", remedy="Look for designs again.")
        return self._arts[number]
