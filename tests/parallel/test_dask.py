"""Blocks and sweeps on Dask: a scheduler and workers as processes of their own give the same, and what dies is told."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from helpers import toy_blocks

import voronoi_tiles as vt
from voronoi_tiles.parallel import dask_blocks
from voronoi_tiles.parallel.block_runner import LostBlock
from voronoi_tiles.parallel.blocks import run_blocks

pytest.importorskip("distributed")

TESTS = Path(__file__).parents[1]


def started(*words: str, folder: Path) -> subprocess.Popen[bytes]:
    """A process of Dask's, the first of a group, that finds the tests' helpers and condemns a task at once."""
    quiet: dict[str, Any] = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": folder}
    env = {**os.environ, "PYTHONPATH": str(TESTS), "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "0"}
    return subprocess.Popen([sys.executable, "-m", "dask", *words], env=env, start_new_session=True, **quiet)


def end(processes: list[subprocess.Popen[bytes]]) -> None:
    """End processes of Dask's, and those that they have started."""
    for process in processes:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def address_in(file: Path) -> str:
    """The address that a scheduler writes when it is there."""
    end = time.monotonic() + 60
    while not file.exists():
        assert time.monotonic() < end
        time.sleep(0.05)
    return str(json.loads(file.read_text())["address"])


def scheduler(folder: Path) -> tuple[subprocess.Popen[bytes], str]:
    """A scheduler without workers."""
    file = folder / "scheduler.json"
    words = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--no-show", "--scheduler-file", str(file))
    return started("scheduler", *words, folder=folder), address_in(file)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A scheduler and two workers of one thread, which are started again when they die: the scheduler's address."""
    from distributed import Client

    folder = tmp_path_factory.mktemp("dask")
    processes = []
    try:
        process, address = scheduler(folder)
        processes = [process]
        words = ("--nworkers", "2", "--nthreads", "1", "--no-dashboard", "--host", "127.0.0.1")
        processes.append(started("worker", address, *words, folder=folder))
        with Client(address, set_as_default=False) as client:
            client.wait_for_workers(2, timeout=60)
        yield address
    finally:
        end(processes)


def test_workers_elsewhere_do_every_block_once(cluster: str) -> None:
    """The results are those of calling the function in a loop, by processes that are none of ours."""
    assert sorted(run_blocks(toy_blocks.square, range(40), scheduler=cluster)) == [(k, k * k) for k in range(40)]
    pids = {pid for _, pid in run_blocks(toy_blocks.pid, range(20), scheduler=cluster)}
    assert len(pids) == 2
    assert os.getpid() not in pids


def test_equal_blocks_are_done_each(cluster: str) -> None:
    """Nothing is remembered from one block to an equal one, or to another run."""
    found = [pid for _, pid in run_blocks(toy_blocks.pid, [0] * 10, scheduler=cluster)]
    assert len(found) == 10
    assert len(set(found)) == 2


def test_a_sweep_on_dask_has_the_same_bytes(cluster: str, tmp_path: Path) -> None:
    """Tables, designs and pictures are those of a sweep by this process alone."""
    sweep = vt.Sweep(
        vt.starter("p4"), {"site[0].strokes[0]": {"deviation": 6}}, count=30, seed=5, sort="-curved_share", keep=2
    )
    vt.sweep(sweep, tmp_path / "dask", scheduler=cluster)
    vt.sweep(sweep, tmp_path / "own", workers=1)
    dask, own = (
        {
            path.name: path.read_bytes()
            for path in (tmp_path / name).rglob("*")
            if path.is_file() and path.parent.name != "rows"
        }
        for name in ("dask", "own")
    )
    assert dask == own
    assert len(own) >= 8


def test_what_a_function_raises_on_a_worker_ends_all(cluster: str) -> None:
    """An error of the function comes out of the iterator."""
    with pytest.raises(ZeroDivisionError, match="two"):
        list(run_blocks(toy_blocks.fails, range(5), scheduler=cluster))


def test_a_block_that_kills_its_worker_is_lost_and_no_other(cluster: str) -> None:
    """Dask condemns it, after a try of its own; its neighbours have their results."""
    found = dict(run_blocks(toy_blocks.deadly, range(9, 18), scheduler=cluster))
    assert found.pop(4) == LostBlock("its worker died")
    assert found == {k: k + 9 for k in range(9) if k != 4}


@pytest.mark.slow
def test_a_cluster_of_dasks_own_on_this_machine() -> None:
    """It starts as many processes as it is asked to, does every block once, and leaves none of them."""
    found = list(run_blocks(toy_blocks.pid, range(12), scheduler="local", workers=2))
    assert sorted(number for number, _ in found) == list(range(12))
    pids = {pid for _, pid in found}
    assert len(pids) == 2
    assert os.getpid() not in pids
    for pid in pids:
        with pytest.raises(ProcessLookupError):
            os.kill(int(str(pid)), 0)


def test_workers_of_another_version_are_refused(cluster: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Their results might be others: one message names both versions."""
    monkeypatch.setattr(dask_blocks, "__version__", "9.9")
    with pytest.raises(vt.SchedulerError, match=r"have voronoi_tiles .*, not 9\.9"):
        list(run_blocks(toy_blocks.square, range(3), scheduler=cluster))


def test_a_scheduler_without_workers_and_one_that_goes_away_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One message says what to start, at the beginning and in the middle; nothing waits for ever."""
    processes = []
    try:
        process, address = scheduler(tmp_path)
        processes = [process]
        with monkeypatch.context() as patched:
            patched.setattr(dask_blocks, "PATIENCE_S", 2.0)
            with pytest.raises(vt.SchedulerError, match=f"the scheduler at {address} has no workers"):
                list(run_blocks(toy_blocks.square, range(3), scheduler=address))
        words = ("--nthreads", "1", "--no-dashboard", "--no-nanny", "--host", "127.0.0.1")
        processes.append(started("worker", address, *words, folder=tmp_path))
        monkeypatch.setattr(dask_blocks, "PATIENCE_S", 60.0)
        naps = [(str(tmp_path / "nap"), 0.05)] * 3 + [(str(tmp_path / "long"), 60.0)]
        found = run_blocks(toy_blocks.naps, naps, scheduler=address)
        next(found)
        process.kill()
        with pytest.raises(vt.SchedulerError, match=f"the scheduler at {address} went away"):
            list(found)
    finally:
        end(processes)
