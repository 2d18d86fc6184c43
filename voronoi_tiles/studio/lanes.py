"""Work in processes of their own, in lanes: in each the newest request wins, and none takes longer than its limit.

A lane has one worker, which does one thing at a time. What is asked for meanwhile waits in slots, one for each kind of
work: a newer request takes the slot of an older one, which is never done. So a drag leaves no queue behind it. A worker
that dies, or takes too long, is replaced, and whoever asked is told. One that does what nobody waits for any more is
replaced, too.

Workers are told over their standard input, and end when it ends: they outlive nobody, however the server dies.
"""

from __future__ import annotations

import asyncio
import json
import shutil
import sys
import tempfile
from asyncio.subprocess import DEVNULL, PIPE, Process
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from voronoi_tiles.studio.frames import FRAME_START, pack, sizes_of
from voronoi_tiles.studio.messages import SECONDS_MAX

_STARTING_S: Final = 60.0
"""For how long a worker may take to be ready, on the slowest machine; seconds."""

_BUFFER: Final = 1 << 20
"""How much of an answer is read ahead; bytes."""

_WAITING_MAX: Final = 8
"""How much that no newer request replaces may wait in a lane; a count."""

TOO_LONG: Final = {
    "message": f"This takes longer than {SECONDS_MAX} seconds, and was given up.",
    "remedy": "Draw less, take larger tolerances, or make a smaller sheet; the command line has no such limit.",
}
DIED: Final = {
    "message": "What computes this has ended unexpectedly, and was started again.",
    "remedy": "Undo the last change if it happens again, and please report it.",
}
BUSY: Final = {
    "message": "There is too much to be done before this.",
    "remedy": "Wait until the files that were asked for are there, and ask again.",
}


class Answer(NamedTuple):
    """What a worker gives: a text or the bytes of a file, with a head; or an error, and nothing else."""

    head: Mapping[str, Any]
    body: bytes
    error: Mapping[str, Any] | None = None


Deliver = Callable[[Answer], Awaitable[None]]


class Worker:
    """A worker's process, which is started when it is needed, and does one thing at a time."""

    def __init__(self, folder: str, module: str = "voronoi_tiles.studio.work") -> None:
        """Work in a folder: what requests name is seen from there."""
        self._folder, self._module = folder, module
        self._process: Process | None = None
        self._scratch: str | None = None

    @property
    def pid(self) -> int | None:
        """The process, None where there is none."""
        return None if self._process is None else self._process.pid

    async def start(self) -> None:
        """Start the process, and wait until it is ready. Raises EOFError where it ends."""
        if self._process is not None and self._process.returncode is None:
            return
        await self.end()
        with suppress(OSError):  # without room, a worker can do much that needs no files
            self._scratch = tempfile.mkdtemp(prefix="voronoi-tiles-")
        self._process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", self._module, *([self._scratch] if self._scratch else [])),
            stdin=PIPE,
            stdout=PIPE,
            stderr=DEVNULL,
            cwd=self._folder,
            limit=_BUFFER,
            start_new_session=True,  # Ctrl-C is for the server, which ends it
        )
        try:
            await asyncio.wait_for(self._receive(), _STARTING_S)
        except BaseException:  # what it says later would be taken for an answer
            await self.end()
            raise

    async def ask(
        self, head: Mapping[str, Any], body: bytes = b"", limit_s: float = SECONDS_MAX, deliver: Deliver | None = None
    ) -> Answer:
        """Have something done; a worker that does not do it is ended. What comes before the last goes to `deliver`."""
        try:
            await self.start()
            assert self._process is not None
            assert self._process.stdin is not None
            self._process.stdin.write(pack(head, body))
            async with asyncio.timeout(limit_s):
                answer, data = await self._receive()
                while answer.get("more"):
                    if deliver is not None:
                        await deliver(Answer(answer, data))
                    answer, data = await self._receive()
        except TimeoutError:
            await self.end()
            return Answer({}, b"", TOO_LONG)
        except (EOFError, OSError, ValueError):  # it ended, or what it says makes no sense
            await self.end()
            return Answer({}, b"", DIED)
        except BaseException:  # cancelled: what it is about to answer is nobody's
            await self.end()
            raise
        error = answer.get("error")
        return Answer(answer, data) if error is None else Answer({}, b"", error)

    async def end(self) -> None:
        """End the process, whatever it does, and remove the files that it has left half done."""
        process, self._process = self._process, None
        scratch, self._scratch = self._scratch, None
        if process is not None and process.returncode is None:
            with suppress(ProcessLookupError):
                process.kill()
            await process.wait()
        if scratch is not None:
            shutil.rmtree(scratch, ignore_errors=True)

    async def _receive(self) -> tuple[Mapping[str, Any], bytes]:
        """The next frame. Raises EOFError where the worker ends instead."""
        assert self._process is not None
        assert self._process.stdout is not None
        head, body = sizes_of(await self._process.stdout.readexactly(FRAME_START))
        text = await self._process.stdout.readexactly(head)
        return json.loads(text), await self._process.stdout.readexactly(body)


@dataclass(eq=False)
class _Asked:
    """Something to be done, and who waits for it."""

    head: Mapping[str, Any]
    body: bytes
    deliver: Deliver
    urgent: bool


class _Doing(NamedTuple):
    """What is being done, for which slot, and since when by the clock of the loop; its cancellation ends the worker."""

    slot: object
    work: asyncio.Future[Answer]
    begun: float


class Lane:
    """A worker with its slots. `run` serves them until it is cancelled.

    An `early` worker is started at once, others when there is something to do. What a newer request replaces while it
    is done may take so many seconds, `replaced_s`, after which the worker is ended: more than it takes to start.
    """

    def __init__(
        self, worker: Worker, *, limit_s: float = SECONDS_MAX, replaced_s: float | None = None, early: bool = False
    ) -> None:
        self.worker = worker
        self._early = early
        self._limit_s, self._replaced_s = limit_s, replaced_s
        self._slots: dict[object, _Asked] = {}
        self._filled = asyncio.Event()
        self._doing: _Doing | None = None

    def put(
        self, slot: object, head: Mapping[str, Any], deliver: Deliver, *, body: bytes = b"", urgent: bool = True
    ) -> None:
        """Have something done as soon as the worker is free, in the place of what is in the slot.

        What is not `urgent` waits until nothing else does.
        """
        self._slots.pop(slot, None)
        self._slots[slot] = _Asked(head, body, deliver, urgent)
        self._filled.set()
        doing, loop = self._doing, asyncio.get_running_loop()
        if doing is not None and doing.slot == slot and self._replaced_s is not None:
            loop.call_at(doing.begun + self._replaced_s, doing.work.cancel)

    def forget(self, *slots: object) -> None:
        """Leave undone what waits in some slots."""
        for slot in slots:
            self._slots.pop(slot, None)

    async def ask(
        self, head: Mapping[str, Any], body: bytes = b"", *, urgent: bool = True, part: Deliver | None = None
    ) -> Answer:
        """Have something done that no newer request replaces, and wait for it; refused where too much waits already.

        What comes before the last goes to `part`.
        Where the waiting is cancelled it is not done, or no longer: the worker that does it is ended.
        """
        if sum(isinstance(slot, asyncio.Future) for slot in self._slots) >= _WAITING_MAX:
            return Answer({}, b"", BUSY)
        done: asyncio.Future[Answer] = asyncio.get_running_loop().create_future()

        async def deliver(answer: Answer) -> None:
            if answer.head.get("more"):
                if part is not None:
                    await part(answer)
            elif not done.done():
                done.set_result(answer)

        self.put(done, head, deliver, body=body, urgent=urgent)
        try:
            return await done
        finally:
            self.forget(done)
            if self._doing is not None and self._doing.slot is done:
                self._doing.work.cancel()

    async def run(self) -> None:
        """Do what is asked for, one thing after the other, urgent things first and then in the order of asking."""
        try:
            if self._early:
                with suppress(EOFError, OSError, TimeoutError):  # it is started again when it is needed
                    await self.worker.start()
            while True:
                await self._filled.wait()
                if not self._slots:
                    self._filled.clear()
                    continue
                slot = min(self._slots, key=lambda key: not self._slots[key].urgent)
                asked = self._slots.pop(slot)
                asking = self.worker.ask(asked.head, asked.body, self._limit_s, asked.deliver)
                work = asyncio.ensure_future(asking)
                self._doing = _Doing(slot, work, asyncio.get_running_loop().time())
                await asyncio.wait((work,))
                self._doing = None
                if not work.cancelled():
                    await asked.deliver(work.result())
        finally:
            if self._doing is not None:
                self._doing.work.cancel()
                await asyncio.wait((self._doing.work,))
            await self.worker.end()
