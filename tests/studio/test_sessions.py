"""The desk: what is drawn is noted in time, trouble is told once, and others' changes when somebody is there."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Callable, Mapping
from typing import Any

import pytest
from starlette.websockets import WebSocket
from test_lanes import lane

from voronoi_tiles.base.errors import DesignError, OutputError
from voronoi_tiles.studio import sessions
from voronoi_tiles.studio.fit_searches import FitSearches
from voronoi_tiles.studio.sessions import Desk


def naming(file: str) -> dict[str, Any]:
    """A design whose art is a file."""
    return {"site": [{"art": file}]}


class Keeper:
    """A document that remembers what it is told, on a disk that can be full."""

    name, folder = "bird", "/nowhere/here"

    def __init__(self) -> None:
        self.noted: list[Mapping[str, Any]] = []
        self.full = False
        self.is_kept = True
        self.change: dict[str, Any] | None = None
        self.closed = False
        self.broken = False

    def opened(self) -> dict[str, Any]:
        """What is open."""
        if self.broken:
            raise DesignError("is no design", file=self.name)
        return {"file": "bird.toml", "design": naming("../on-disk.svg"), "recovery": {"design": naming("../noted.svg")}}

    def beside(self, name: str) -> Keeper:
        """Another document, under no name that is taken."""
        if name == "bird":
            raise DesignError("is there already", file=name)
        return Keeper()

    def close(self) -> None:
        """Let others have it."""
        self.closed = True

    def note(self, design: Mapping[str, Any]) -> None:
        """Take a recovery copy."""
        if self.full:
            raise OutputError("the disk is full", remedy="Make room.")
        self.noted.append(design)

    def check_kept(self, design: Mapping[str, Any]) -> None:
        """Refuse to leave what is neither saved nor noted."""
        assert design
        if not self.is_kept:
            raise OutputError("no copy of it can be kept", remedy="Save it first.")

    def changed(self) -> dict[str, Any] | None:
        """What others have done, once."""
        change, self.change = self.change, None
        return change


class Page:
    """A page: what it sends, and what it is told."""

    def __init__(self) -> None:
        self.heard: list[dict[str, Any]] = []
        self.frozen = False
        self.said: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        self.said.put_nowait({"type": "websocket.connect"})
        scope = {"type": "websocket", "headers": [], "query_string": b"", "path": "/ws"}
        self.socket = WebSocket(scope, self.said.get, self._hear)

    def say(self, **message: Any) -> None:
        """Send a message."""
        self.said.put_nowait({"type": "websocket.receive", "text": json.dumps(message)})

    def leave(self) -> None:
        """Close the connection."""
        self.said.put_nowait({"type": "websocket.disconnect", "code": 1001})

    async def _hear(self, message: Any) -> None:
        if self.frozen:
            await asyncio.Event().wait()
        if message["type"] == "websocket.send":
            self.heard.append(json.loads(message["text"]))


async def until(reached: Callable[[], bool]) -> None:
    """Wait for something, for half a minute at most."""
    async with asyncio.timeout(30):
        while not reached():  # noqa: ASYNC110 - what is waited for knows of no event
            await asyncio.sleep(0.005)


def at_desk(story: Callable[[Desk, Keeper, Page, asyncio.Task[None]], Any], monkeypatch: pytest.MonkeyPatch) -> None:
    """Run a story with a desk that is watched and a page at it, which the task serves."""
    monkeypatch.setattr(sessions, "_NOTED_EVERY_S", 0.02)

    async def run() -> None:
        keeper, page = Keeper(), Page()
        desk = Desk(keeper, lane(), lane(), FitSearches(lane()))  # type: ignore[arg-type]
        watching = asyncio.create_task(desk.watch())
        serving = asyncio.create_task(desk.serve(page.socket))
        await until(lambda: bool(page.heard))
        await story(desk, keeper, page, serving)
        watching.cancel()
        serving.cancel()
        await asyncio.gather(watching, serving, return_exceptions=True)

    asyncio.run(run())


def test_the_newest_design_is_noted(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every so often while it changes, also where it is refused, and at once when the page leaves."""

    async def story(_desk: Desk, keeper: Keeper, page: Page, serving: asyncio.Task[None]) -> None:
        for k in range(50):
            page.say(type="design", rev=k, design={"number": k})
        await until(lambda: {"number": 49} in keeper.noted)
        assert len(keeper.noted) < 25
        noted = len(keeper.noted)
        await asyncio.sleep(0.1)
        assert len(keeper.noted) == noted  # nothing is new
        page.say(type="design", rev=50, design=naming("/etc/passwd"))
        await until(lambda: keeper.noted[-1] == naming("/etc/passwd"))
        page.say(type="design", rev=51, design={"number": 51})
        page.leave()
        await serving
        assert keeper.noted[-1] == {"number": 51}

    at_desk(story, monkeypatch)


def test_a_new_design_takes_the_place_of_one_that_is_noted(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is not saved is noted, then the file is let go; where the new one cannot be begun, nothing has changed."""

    async def story(desk: Desk, keeper: Keeper, page: Page, _serving: asyncio.Task[None]) -> None:
        page.say(type="new", rev=1, design={"number": 0}, name="bird")
        await until(lambda: "refused" in [message["type"] for message in page.heard])
        keeper.is_kept = False
        page.say(type="new", rev=2, design={"number": 1}, name="leaf")
        await until(lambda: [message.get("lane") for message in page.heard].count("new") == 2)
        held: Any = desk.document
        assert held is keeper
        keeper.is_kept = True
        page.say(type="new", rev=3, design={"number": 1}, name="leaf")
        await until(lambda: [message["type"] for message in page.heard].count("opened") == 2)
        assert (keeper.noted[-1], keeper.closed) == ({"number": 1}, True)
        begun: Any = desk.document
        page.say(type="design", rev=2, design={"number": 2})
        await until(lambda: {"number": 2} in begun.noted)
        assert {"number": 2} not in keeper.noted

    at_desk(story, monkeypatch)


def test_nothing_has_changed_where_a_new_design_cannot_be_opened(monkeypatch: pytest.MonkeyPatch) -> None:
    """Somebody may put a broken file there after it was seen that there is none: that is let go, and said."""

    async def story(desk: Desk, keeper: Keeper, page: Page, _serving: asyncio.Task[None]) -> None:
        other = Keeper()
        other.broken = True
        monkeypatch.setattr(keeper, "beside", lambda _name: other)
        with pytest.raises(DesignError, match="is no design"):
            await desk.begin("leaf", {"number": 0})
        held: Any = desk.document
        assert held is keeper
        assert (keeper.closed, other.closed) == (False, True)
        desk.check_files(naming("../on-disk.svg"), {})
        page.say(type="design", rev=1, design={"number": 1})
        await until(lambda: {"number": 1} in keeper.noted)

    at_desk(story, monkeypatch)


def test_what_the_design_on_disk_names_may_be_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """Wherever it is; what a page has named, and a copy for recovery has, may not."""

    async def story(desk: Desk, _keeper: Keeper, _page: Page, _serving: asyncio.Task[None]) -> None:
        desk.check_files(naming("../on-disk.svg"), {})
        with pytest.raises(DesignError, match="outside"):
            desk.check_files(naming("../noted.svg"), {})

    at_desk(story, monkeypatch)


def test_a_full_disk_is_told_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """And what could not be noted is, as soon as there is room."""

    async def story(_desk: Desk, keeper: Keeper, page: Page, _serving: asyncio.Task[None]) -> None:
        keeper.full = True
        page.say(type="design", rev=1, design={"number": 1})
        await until(lambda: page.heard[-1]["type"] == "trouble")
        assert page.heard[-1] == {"type": "trouble", "message": "the disk is full.", "remedy": "Make room."}
        await asyncio.sleep(0.2)
        assert [message["type"] for message in page.heard].count("trouble") == 1
        keeper.full = False
        await until(lambda: keeper.noted == [{"number": 1}])

    at_desk(story, monkeypatch)


def test_a_full_disk_hides_no_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    """What others do to the file is told while nothing can be noted, and both go on."""

    async def story(_desk: Desk, keeper: Keeper, page: Page, _serving: asyncio.Task[None]) -> None:
        keeper.full = True
        page.say(type="design", rev=1, design={"number": 1})
        await until(lambda: page.heard[-1]["type"] == "trouble")
        keeper.change = {"design": {"number": 2}, "file": "bird.toml"}
        await until(lambda: page.heard[-1]["type"] == "changed")
        keeper.full = False
        await until(lambda: keeper.noted == [{"number": 1}])
        assert [message["type"] for message in page.heard] == ["opened", "trouble", "changed"]

    at_desk(story, monkeypatch)


def test_changes_wait_for_somebody_to_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    """What others do to the file while no page is there is told to the one that comes."""

    async def story(desk: Desk, keeper: Keeper, page: Page, serving: asyncio.Task[None]) -> None:
        keeper.change = {"design": {"number": 1}, "file": "bird.toml"}
        await until(lambda: page.heard[-1]["type"] == "changed")
        page.leave()
        await serving
        keeper.change = {"design": {"number": 2}, "file": "bird.toml"}
        await asyncio.sleep(0.1)
        other = Page()
        later = asyncio.create_task(desk.serve(other.socket))
        await until(lambda: bool(other.heard) and other.heard[-1]["type"] == "changed")
        assert other.heard[-1]["design"] == {"number": 2}
        other.leave()
        await later

    at_desk(story, monkeypatch)


def test_a_page_that_takes_nothing_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that its browser has frozen: lanes, notes and the next page do not wait for it."""
    monkeypatch.setattr(sessions, "_STUCK_S", 0.05)

    async def story(desk: Desk, keeper: Keeper, page: Page, serving: asyncio.Task[None]) -> None:
        page.frozen = True
        working = asyncio.create_task(desk.outlines.run())
        page.say(type="design", rev=1, design={"number": 1}, rest=True)
        await until(serving.done)
        assert keeper.noted == [{"number": 1}]
        other = Page()
        later = asyncio.create_task(desk.serve(other.socket))
        await until(lambda: bool(other.heard))
        assert (await desk.outlines.ask({"task": "echo", "say": "here"})).head["said"] == "here"
        other.frozen = True
        third = Page()
        last = asyncio.create_task(desk.serve(third.socket))
        await until(lambda: bool(third.heard))
        for task in (working, later, last):
            task.cancel()
        await asyncio.gather(working, later, last, return_exceptions=True)

    at_desk(story, monkeypatch)


def test_the_document_does_one_thing_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where who has asked for it is gone before it is done."""

    async def story(desk: Desk, _keeper: Keeper, _page: Page, _serving: asyncio.Task[None]) -> None:
        done: list[str] = []

        def slow() -> None:
            time.sleep(0.2)
            done.append("first")

        asked = asyncio.create_task(desk.keeper(slow))
        await asyncio.sleep(0.05)
        asked.cancel()
        await desk.keeper(done.append, "second")
        assert done == ["first", "second"]

    at_desk(story, monkeypatch)
