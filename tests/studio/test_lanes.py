"""Lanes of work: the newest request wins, nothing takes too long, and no worker outlives whoever it works for."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import time
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from voronoi_tiles.studio import lanes
from voronoi_tiles.studio.lanes import DIED, TOO_LONG, Answer, Lane, Worker

TESTS = Path(__file__).parents[1]
TOYS = (str(TESTS), "helpers.toy_worker")


def lane(**options: Any) -> Lane:
    """A lane whose worker has toys for tasks."""
    return Lane(Worker(*TOYS), **options)


def in_lane(story: Callable[[Lane], Awaitable[None]], **options: Any) -> int | None:
    """Run a story with a lane that is served; the process of its last worker, which has ended."""

    async def run() -> int | None:
        served = lane(**options)
        task = asyncio.create_task(served.run())
        try:
            await asyncio.wait_for(story(served), 120)
            return served.worker.pid
        finally:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)
            assert served.worker.pid is None

    return asyncio.run(run())


def is_alive(pid: int) -> bool:
    """Whether a process runs; one that has ended and was not asked for its exit code does not."""
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    status = Path(f"/proc/{pid}/stat")
    return not status.exists() or status.read_text().rpartition(")")[2].split()[0] != "Z"


def is_gone(pid: int) -> bool:
    """Whether a process ends, now or in the next seconds: the machine may be busy."""
    end = time.monotonic() + 30
    while is_alive(pid) and time.monotonic() < end:
        time.sleep(0.02)
    return not is_alive(pid)


def test_what_is_asked_is_answered() -> None:
    """Bytes of any number come and go unchanged; errors are for people; what is printed is no answer."""

    async def story(served: Lane) -> None:
        for body in (b"", b"\0\xff", os.urandom(3 << 20)):
            answer = await served.ask({"task": "echo", "say": "grüezi"}, body)
            assert (answer.head["said"], answer.body, answer.error) == ("grüezi", body, None)
        assert (await served.ask({"task": "chatter"})).head["said"] == "printed"
        wrong = (await served.ask({"task": "fail"})).error
        assert wrong == {"message": "the `kerf` is wrong.", "remedy": "Mend it.", "key": "kerf"}
        bug = (await served.ask({"task": "fail", "bug": True})).error
        assert bug is not None
        assert "bug in voronoi-tiles" in bug["remedy"]
        assert (await served.ask({"task": "echo", "say": 1})).head["said"] == 1

    pid = in_lane(story)
    assert pid is not None
    assert is_gone(pid)


def test_an_answer_comes_in_parts() -> None:
    """Each part is delivered as it comes, an error as the last; then the worker does the next thing."""

    async def story(served: Lane) -> None:
        heard: list[object] = []

        async def deliver(answer: Answer) -> None:
            heard.append(answer.head["said"] if answer.error is None else answer.error["key"])

        served.put("right", {"task": "count", "to": 3}, deliver)
        served.put("wrong", {"task": "count", "to": 2, "wrong": True}, deliver)
        assert (await served.ask({"task": "echo", "say": "next"}, urgent=False)).head["said"] == "next"
        assert heard == [0, 1, 2, 3, 0, 1, "kerf"]

    in_lane(story)


def test_the_newest_wins() -> None:
    """Of what comes for a slot while the worker is busy the last alone is done; other slots do not suffer."""

    async def story(served: Lane) -> None:
        heard: list[object] = []

        async def deliver(answer: Answer) -> None:
            heard.append(answer.head["said"])

        await served.ask({"task": "echo"})
        busy = asyncio.create_task(served.ask({"task": "nap", "seconds": 0.3}))
        await asyncio.sleep(0.1)
        served.put("other", {"task": "echo", "say": "other"}, deliver)
        for k in range(50):
            served.put("drag", {"task": "echo", "say": k}, deliver)
            served.put("gone", {"task": "echo", "say": "gone"}, deliver)
        served.put("later", {"task": "echo", "say": "later"}, deliver, urgent=False)
        served.put("last", {"task": "echo", "say": "last"}, deliver)
        served.forget("gone")
        await busy
        await served.ask({"task": "echo"}, urgent=False)
        assert heard == ["other", 49, "last", "later"]

    in_lane(story)


def test_what_is_given_up_is_not_done() -> None:
    """Whoever does not wait any more has the worker ended that does it, and no other; the next is served."""

    async def story(served: Lane) -> None:
        before = (await served.ask({"task": "echo"})).head["pid"]
        spinning = asyncio.create_task(served.ask({"task": "spin"}))
        waiting = asyncio.create_task(served.ask({"task": "spin"}))
        asked = asyncio.create_task(served.ask({"task": "echo"}))
        await asyncio.sleep(0.1)
        waiting.cancel()
        await asyncio.sleep(0.1)
        assert is_alive(before)
        spinning.cancel()
        answer = await asyncio.wait_for(asked, 30)
        assert answer.error is None
        assert answer.head["pid"] != before
        assert not is_alive(before)

    in_lane(story, limit_s=60)


def test_what_is_replaced_is_done_for_a_while_alone() -> None:
    """A newer request has the worker ended when the one before takes longer than it may; only for the same slot."""

    async def story(served: Lane) -> None:
        heard: list[tuple[object, bool]] = []
        before = (await served.ask({"task": "echo"})).head["pid"]

        async def deliver(answer: Answer) -> None:
            heard.append((answer.head["said"], is_alive(before)))

        served.put("job", {"task": "nap", "seconds": 0.2, "say": "quick"}, deliver)
        await asyncio.sleep(0.1)
        served.put("job", {"task": "nap", "seconds": 1.0, "say": "alone"}, deliver)
        await asyncio.sleep(0.3)
        served.put("other", {"task": "echo", "say": "other"}, deliver)
        await served.ask({"task": "echo"}, urgent=False)
        served.put("job", {"task": "spin"}, deliver)
        await asyncio.sleep(0.1)
        served.put("job", {"task": "echo", "say": "newest"}, deliver)
        await served.ask({"task": "echo"}, urgent=False)
        assert heard == [("quick", True), ("alone", True), ("other", True), ("newest", False)]

    in_lane(story, limit_s=60, replaced_s=0.6)


@pytest.mark.parametrize(("task", "error"), [("spin", TOO_LONG), ("die", DIED)])
def test_a_worker_that_does_not_answer_is_replaced(task: str, error: dict[str, str]) -> None:
    """One that takes too long is ended, one that dies is replaced; whoever asked is told, and the next is served."""

    async def story(served: Lane) -> None:
        before = (await served.ask({"task": "echo"})).head["pid"]
        answer = await served.ask({"task": task})
        assert answer.error == error
        assert is_gone(before)
        assert (await served.ask({"task": "echo"})).head["pid"] != before

    in_lane(story, limit_s=0.5)


def test_a_worker_takes_no_more_memory_than_it_may() -> None:
    """What needs more is refused, and the worker goes on."""

    async def story(served: Lane) -> None:
        answer = await served.ask({"task": "hoard", "bytes": 5 << 30})
        assert answer.error is not None
        assert "memory" in answer.error["message"]
        assert (await served.ask({"task": "hoard", "bytes": 1 << 20})).head["said"] == 1 << 20

    in_lane(story)


def test_a_worker_that_cannot_start_is_said() -> None:
    """There is an answer for everyone, and no end of waiting."""

    async def story(served: Lane) -> None:
        served.worker = Worker(str(TESTS), "helpers.no_such_worker")
        assert (await served.ask({"task": "echo"})).error == DIED

    in_lane(story)


def test_a_worker_that_is_slow_to_start_gives_no_wrong_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One that is not ready in time is ended: that it is ready would be taken for the first answer. No files stay."""
    monkeypatch.setattr(lanes, "_STARTING_S", 0.001)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))

    async def story(served: Lane) -> None:
        await asyncio.sleep(0.05)  # the first start is given up
        monkeypatch.setattr(lanes, "_STARTING_S", 60.0)
        for k in range(3):
            assert (await served.ask({"task": "echo", "say": k})).head["said"] == k

    in_lane(story, early=True)
    assert list(tmp_path.iterdir()) == []


def test_a_worker_hears_requests_alone() -> None:
    """Who names standard input in a design reads nothing, and takes no request from those that come."""

    async def story(served: Lane) -> None:
        assert (await served.ask({"task": "listen"})).head["said"] == ["", ""]
        assert (await served.ask({"task": "echo", "say": 1})).head["said"] == 1

    in_lane(story)


def test_what_is_half_done_is_removed(tmp_path: Path) -> None:
    """The temporary files of a worker that takes too long."""
    where = tmp_path / "where.txt"

    async def story(served: Lane) -> None:
        assert (await served.ask({"task": "leave", "say": str(where)})).error == TOO_LONG

    in_lane(story, limit_s=0.5)
    assert not Path(where.read_text()).exists()


def test_what_waits_is_bounded() -> None:
    """Of a flood of files that are asked for all are answered, and most by a refusal; drags go on."""

    async def story(served: Lane) -> None:
        await served.ask({"task": "echo"})
        asked = [served.ask({"task": "nap", "seconds": 0.01, "say": k}) for k in range(100)]
        answers = await asyncio.gather(*asked)
        assert 1 < sum(answer.error is None for answer in answers) < 20
        assert all(answer.error in (None, lanes.BUSY) for answer in answers)
        assert (await served.ask({"task": "echo", "say": 1})).head["said"] == 1

    in_lane(story)


SERVER = """
import asyncio, sys
sys.path.insert(0, {tests!r})
from test_lanes import lane

async def main():
    served = lane(early=True)
    running = asyncio.create_task(served.run())
    pid = (await served.ask({{"task": "echo"}})).head["pid"]
    asking = asyncio.create_task(served.ask({{"task": {task!r}, "seconds": 60, "say": {where!r}}}))
    await asyncio.sleep(0.1)
    print(pid, flush=True)
    await asking

asyncio.run(main())
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="the system has no SIGKILL")
@pytest.mark.parametrize("task", ["nap", "spin", "leave"])
def test_no_worker_outlives_the_server(task: str, tmp_path: Path) -> None:
    """However it dies, and whatever the worker does: a pipe closes, and there is nothing to clean up."""
    where = tmp_path / "where.txt"
    script = SERVER.format(tests=str(Path(__file__).parent), task=task, where=str(where))
    environment = {**os.environ, "PYTHONPATH": str(TESTS)}
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, env=environment) as server:
        assert server.stdout is not None
        pid = int(server.stdout.readline())
        assert is_alive(pid)
        server.kill()
    assert is_gone(pid)
    assert not where.exists() or not Path(where.read_text()).exists()
