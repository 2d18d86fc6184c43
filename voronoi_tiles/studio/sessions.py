"""The page's end of the live connection: what it asks for, and what it is told."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Coroutine, Mapping
from contextlib import suppress
from typing import Any, Final

from starlette.websockets import WebSocket, WebSocketDisconnect

from voronoi_tiles.base.errors import VoronoiTilesError
from voronoi_tiles.studio.design_document import Document
from voronoi_tiles.studio.fit_searches import FitSearches
from voronoi_tiles.studio.lanes import Answer, Deliver, Lane
from voronoi_tiles.studio.messages import (
    ByeMessage,
    DesignMessage,
    JobMessage,
    Message,
    NewMessage,
    ReloadMessage,
    SaveMessage,
    SolidMessage,
    Table,
    ThumbnailMessage,
    check_files,
    named_files,
    read_message,
    read_object,
)
from voronoi_tiles.studio.refusals import error_document, refusal

TAKEN_OVER: Final = 4001
"""The code that a page's connection is closed with when another page takes its place."""

_NOTED_EVERY_S: Final = 0.8
"""How often the newest design is noted for recovery, and the file looked at; seconds."""

_STUCK_S: Final = 5.0
"""A page that takes nothing for so long is left: browsers freeze pages, and whoever tells them waits; seconds."""


class Desk:
    """What all pages of a studio share: the document and the lanes. One page at a time is at it.

    Two pages at one document would overwrite each other's work: a new one takes the place of the one before.
    """

    def __init__(self, document: Document, outlines: Lane, jobs: Lane, fits: FitSearches) -> None:
        self.document, self.outlines, self.jobs, self.fits = document, outlines, jobs, fits
        self._own: set[str] = set()
        self._keeper = asyncio.Lock()
        self._page: Session | None = None
        self._newest: Table | None = None
        self._opened: dict[str, Any] = {}

    async def keeper(self, call: Callable[..., Any], *arguments: Any) -> Any:
        """Have the document do something, in a thread, and one thing at a time, also where nobody waits any more."""

        async def kept() -> Any:
            async with self._keeper:
                return await asyncio.to_thread(call, *arguments)

        return await asyncio.shield(kept())

    async def opened(self, *, again: str = "", recover: bool = True) -> dict[str, Any]:
        """The message "opened": the file as it is now, with what can be recovered.

        To a page that comes `again` with this file, and has what it has drawn, the file stays as it was read last: what
        others have made of it meanwhile is still a change. Raises VoronoiTilesError.
        """
        same = bool(again) and again == "{folder}/{file}".format_map({"folder": "", "file": "", **self._opened})
        if not same:
            call = self.document.opened if recover else self.document.reload
            self._opened = await self.keeper(call)
            self.know(self._opened.get("design"))
        return {"type": "opened", **self._opened, "again": same}

    async def begin(self, name: str, design: Table) -> dict[str, Any]:
        """Begin a new design beside this one, which is closed; what is not saved of it is noted. The message "opened".

        `design` is what the page has drawn. Raises VoronoiTilesError, after which nothing has changed: also where
        that is not saved, and no copy of it can be kept.
        """
        self.note(design)
        await self.note_now()
        await self.keeper(self.document.check_kept, design)
        new = await self.keeper(self.document.beside, name)
        try:
            opened = await self.keeper(new.opened)  # somebody may have put a broken file there meanwhile
        except BaseException:
            await self.keeper(new.close)
            raise
        old, self.document, self._opened = self.document, new, opened
        self._newest, self._own = None, set()
        self.know(opened.get("design"))
        await self.keeper(old.close)
        return {"type": "opened", **opened, "again": False}

    def know(self, design: Table | None) -> None:
        """Remember what files the design on disk names: these may be read, wherever they are.

        What a page has sent is not asked, nor a recovery copy of it.
        """
        if design is not None:
            self._own |= named_files(design)

    def check_files(self, design: Table, job: Table) -> None:
        """Refuse what names files that are not the design's. Raises DesignError."""
        check_files(design, job, self.document.folder, self._own)

    def note(self, design: Table) -> None:
        """Keep the newest design, for the recovery copy."""
        self._newest = design

    async def note_now(self) -> None:
        """Write the recovery copy, where there is something new."""
        newest = self._newest
        if newest is not None:
            await self.keeper(self.document.note, newest)
            if self._newest is newest:  # no newer one has come meanwhile
                self._newest = None

    async def serve(self, websocket: WebSocket) -> None:
        """Serve a page until it is gone."""
        before, self._page = self._page, (page := Session(self, websocket))
        if before is not None:
            await before.close()
        try:
            await page.run()
        finally:
            if self._page is page:
                self._page = None
            with suppress(VoronoiTilesError):  # it was told, while there was somebody to tell
                await self.note_now()

    async def watch(self) -> None:
        """Note what is new, and tell the page what others do to the file, again and again; trouble is told once.

        Neither waits for the other: on a full disk nothing can be noted, and others' changes are told all the same.
        """
        told = {self.note_now: "", self._tell_changes: ""}
        while True:
            await asyncio.sleep(_NOTED_EVERY_S)
            for step, before in told.items():
                try:
                    await step()
                    told[step] = ""
                except Exception as error:  # noqa: BLE001 - whatever it is, the next time may be right
                    told[step] = str(error)
                    if told[step] != before:
                        await self.tell({"type": "trouble", **error_document(error)})

    async def _tell_changes(self) -> None:
        """Tell the page what others have made of the file, where it is new; without a page it is not looked for."""
        changed = await self.keeper(self.document.changed) if self._page is not None else None
        if changed is not None:
            self.know(changed.get("design"))
            await self.tell({"type": "changed", **changed})

    async def tell(self, message: Mapping[str, Any]) -> None:
        """Tell the page, where there is one."""
        if self._page is not None:
            await self._page.send(message)


class Session:
    """A page at the desk."""

    def __init__(self, desk: Desk, websocket: WebSocket) -> None:
        self._desk, self._websocket = desk, websocket
        self._stay = asyncio.timeout(None)
        self._stuck = False

    async def send(self, message: Mapping[str, Any]) -> None:
        """Send a message; that the page is gone is no error."""
        await self._send_text(json.dumps(message, separators=(",", ":"), allow_nan=False))

    async def _send_text(self, text: str) -> None:
        await self._patiently(self._websocket.send_text(text))

    async def close(self) -> None:
        """Close the connection: another page is at the desk."""
        await self._patiently(self._websocket.close(TAKEN_OVER, "the studio was opened in another page"))

    async def _patiently(self, sending: Coroutine[Any, Any, None]) -> None:
        """Send something, while the page takes it; one that takes nothing is served no longer."""
        if self._stuck:
            sending.close()
            return
        with suppress(WebSocketDisconnect, RuntimeError, OSError):
            try:
                async with asyncio.timeout(_STUCK_S):
                    await sending
            except TimeoutError:
                self._stuck = True
                self._stay.reschedule(0.0)

    async def run(self) -> None:
        """Say what is open, and do what the page asks for until it is gone, or takes nothing any more."""
        with suppress(TimeoutError):
            async with self._stay:
                await self._serve()

    async def _serve(self) -> None:
        """Serve the page until it is gone."""
        await self._websocket.accept()
        try:
            await self.send(await self._desk.opened(again=self._websocket.query_params.get("again", "")))
        except VoronoiTilesError as error:
            await self.send(refusal({}, error))
        try:
            while (received := await self._websocket.receive())["type"] == "websocket.receive":
                await self._take(received.get("text"))
        finally:
            self._desk.outlines.forget(self)
            self._desk.jobs.forget(self, (self, "solid"), (self, "thumbnail"))

    async def _take(self, text: str | None) -> None:
        """Do what a message says, or say what is wrong with it."""
        table: Table = {}
        try:
            table = read_object("" if text is None else text)
            await self._answer(read_message(table), table)
        except Exception as error:  # noqa: BLE001 - whatever it is, the page is told, and the next message may be right
            await self.send(refusal(table, error))

    async def _answer(self, message: Message, table: Table) -> None:
        """Do what a message says. Raises VoronoiTilesError for what cannot be done."""
        desk = self._desk
        match message:
            case DesignMessage(rev, design, rest, tolerance):
                desk.note(design)
                desk.check_files(design, {})
                asked = {"task": "outline", "rev": rev, "design": design, "rest": rest, "tolerance": tolerance}
                desk.outlines.put(self, asked, self._deliver(table))
            case JobMessage(rev, design, job, limits):
                desk.check_files(design, job)
                asked = {"task": "product", "rev": rev, "design": design, "job": job, "limits": limits}
                desk.jobs.put(self, {**asked, "name": desk.document.name}, self._deliver(table))
            case SolidMessage(rev, design, job):
                desk.check_files(design, job)
                asked = {"task": "solid", "rev": rev, "design": design, "job": job, "name": desk.document.name}
                desk.jobs.put((self, "solid"), asked, self._deliver(table))
            case ThumbnailMessage(rev, design):
                desk.check_files(design, {})
                asked = {"task": "thumbnail", "rev": rev, "design": design}
                desk.jobs.put((self, "thumbnail"), asked, self._deliver(table), urgent=False)
            case SaveMessage(rev, design, over):
                desk.check_files(design, {})
                saved = await desk.keeper(desk.document.save, design, over)
                desk.know(saved.get("design"))
                await self.send({**saved, "rev": rev})
            case ReloadMessage():
                await self.send(await desk.opened(recover=False))
            case NewMessage(_, design, name):
                await self.send({**await desk.begin(name, design), "begun": True})
            case ByeMessage():
                await desk.note_now()

    def _deliver(self, table: Table) -> Deliver:
        """What sends the answer to a message."""

        async def deliver(answer: Answer) -> None:
            if answer.error is not None:
                await self.send(refusal(table, answer.error))
            elif answer.head.get("binary"):
                await self._patiently(self._websocket.send_bytes(answer.body))
            else:
                await self._send_text(answer.body.decode())

        return deliver
