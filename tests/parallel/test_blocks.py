"""Blocks of work on several processors: each is done once, whatever dies on the way, and nothing is left running."""

from __future__ import annotations

import errno
import itertools
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest
from helpers import toy_blocks

import voronoi_tiles as vt
from voronoi_tiles.parallel import blocks, child_processes, dask_blocks
from voronoi_tiles.parallel.block_runner import LostBlock
from voronoi_tiles.parallel.blocks import run_blocks

TESTS = Path(__file__).parents[1]


def runs(number: object) -> bool:
    """Whether a process is there, and no mere entry of one that has ended."""
    with suppress(OSError):
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    return False


def wait_until(what: Callable[[], bool], seconds: float = 20.0) -> None:
    """Wait for something; fails where it does not come."""
    end = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end, "it did not come"
        time.sleep(0.02)


@pytest.mark.parametrize("workers", [1, 2, 5])
def test_every_block_is_done_once(workers: int) -> None:
    """The results are those of calling the function in a loop, by the blocks' numbers, whatever the workers."""
    found = list(run_blocks(toy_blocks.square, range(3, 14), workers=workers))
    assert sorted(found) == [(k, (k + 3) ** 2) for k in range(11)]


def test_no_blocks_are_no_results() -> None:
    """Nothing to do is done at once."""
    assert list(run_blocks(toy_blocks.square, [], workers=2)) == []


def test_one_worker_is_this_process_and_several_are_others() -> None:
    """With one worker no process is started; with several as many are, and none of them is this one."""
    assert {found for _, found in run_blocks(toy_blocks.pid, range(3), workers=1)} == {os.getpid()}
    others = {found for _, found in run_blocks(toy_blocks.pid, range(12), workers=3)}
    assert len(others) == 3
    assert os.getpid() not in others
    assert not any(map(runs, others))


def test_a_block_that_kills_its_process_is_lost_and_no_other() -> None:
    """The block whose process dies is lost, with how it died; its neighbours have their results."""
    found = dict(run_blocks(toy_blocks.deadly, range(20), workers=2))
    assert found.pop(13) == LostBlock("its process was ended by SIGKILL, as where there is no memory left")
    assert found == {k: k for k in range(20) if k != 13}


def test_a_block_whose_process_dies_once_is_tried_again(tmp_path: Path) -> None:
    """What dies beside others, of memory for example, has its result when it is alone."""
    name = str(tmp_path / "died")
    assert dict(run_blocks(toy_blocks.dies_once, ["", name, ""], workers=2)) == {0: "", 1: name, 2: ""}
    assert Path(name).exists()


def test_how_a_process_ends_is_told() -> None:
    """A process that leaves by itself is told by its status."""
    assert dict(run_blocks(toy_blocks.leaves, [7, 0, 0], workers=2))[0] == LostBlock("its process ended with status 7")


@pytest.mark.parametrize("workers", [1, 2])
def test_what_a_function_raises_ends_all(workers: int) -> None:
    """An error of the function comes out of the iterator, as it was raised."""
    with pytest.raises(ZeroDivisionError, match="two"):
        list(run_blocks(toy_blocks.fails, range(5), workers=workers))


def test_an_error_says_where_it_was_raised() -> None:
    """An error from another process carries the traceback from there; one that cannot be read again is told."""
    with pytest.raises(ZeroDivisionError) as raised:
        list(run_blocks(toy_blocks.fails, range(5), workers=2))
    assert "toy_blocks.py" in raised.value.__notes__[0]
    with pytest.raises(RuntimeError, match=r"toy_blocks\._OddError: 1 and 1"):
        list(run_blocks(toy_blocks.fails_oddly, [1, 1], workers=2))


def test_what_a_function_prints_is_no_answer(capfd: pytest.CaptureFixture[str]) -> None:
    """What functions print goes to standard error, and they have no standard input to read."""
    assert sorted(run_blocks(toy_blocks.chatters, range(2), workers=2)) == [(0, 0), (1, 1)]
    said = capfd.readouterr()
    assert said.out == ""
    assert said.err.count("hello") == 4


def test_results_of_many_megabytes_come_whole() -> None:
    """Pipes are read while they are written."""
    found = dict(run_blocks(toy_blocks.big, [5_000_000] * 3, workers=2))
    assert found == dict.fromkeys(range(3), bytes(5_000_000))


def test_results_come_as_they_finish(tmp_path: Path) -> None:
    """A block that takes long holds back none of the others."""
    slow, quick = (str(tmp_path / "slow"), 1.5), (str(tmp_path / "quick"), 0.0)
    assert [number for number, _ in run_blocks(toy_blocks.naps, [slow, quick, quick], workers=2)] == [1, 2, 0]


def test_leaving_the_iterator_ends_the_processes(tmp_path: Path) -> None:
    """Where nobody waits for results any more, the processes end, whatever they do."""
    naps = [(str(tmp_path / str(k)), 0.0 if k == 0 else 60.0) for k in range(4)]
    found = run_blocks(toy_blocks.naps, naps, workers=2)
    next(found)
    wait_until(lambda: any((tmp_path / str(k)).exists() for k in (1, 2, 3)))
    begun = time.monotonic()
    found.close()
    assert time.monotonic() - begun < 20
    assert not any(runs(int(path.read_text() or 0)) for path in tmp_path.iterdir())


SCRIPT = """
import sys
from helpers import toy_blocks
from voronoi_tiles.parallel.blocks import run_blocks
print("begun", flush=True)
folder = sys.argv[1]
print(list(run_blocks(toy_blocks.naps, [(f"{folder}/{k}", float(sys.argv[2])) for k in range(2)], workers=2)))
"""


@contextmanager
def running_script(folder: Path, seconds: float) -> Iterator[subprocess.Popen[str]]:
    """A script that is not guarded against being imported, and whose blocks take so many seconds."""
    script = folder / "script.py"
    script.write_text(SCRIPT)
    blocks_of = folder / "blocks"
    blocks_of.mkdir()
    command = [sys.executable, str(script), str(blocks_of), str(seconds)]
    env = {**os.environ, "PYTHONPATH": str(TESTS)}
    with subprocess.Popen(command, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


def test_a_script_needs_no_guard(tmp_path: Path) -> None:
    """A script that runs blocks at its top is run once, not once more in each process."""
    with running_script(tmp_path, 0.0) as process:
        said, wrong = process.communicate(timeout=60)
    assert said.count("begun") == 1
    assert wrong == ""
    assert process.returncode == 0


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes are looked for in /proc")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
@pytest.mark.usefixtures("heard_signals")
def test_processes_end_with_the_one_that_started_them(number: signal.Signals, tmp_path: Path) -> None:
    """After Ctrl-C, a termination or a kill no process is left, however long its block takes."""
    with running_script(tmp_path, 600.0) as process:
        files = [tmp_path / "blocks" / str(k) for k in range(2)]
        wait_until(lambda: all(path.exists() and path.read_text() for path in files))
        children = [int(path.read_text()) for path in files]
        assert all(map(runs, children))
        process.send_signal(number)
        process.wait(20)
    wait_until(lambda: not any(map(runs, children)))


def test_processes_that_cannot_be_started_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the system gives no more processes, one message says so, and those that are there end."""
    begun: list[subprocess.Popen[bytes]] = []
    asked = itertools.count()

    def popen(*arguments: Any, **options: Any) -> subprocess.Popen[bytes]:
        if next(asked):
            raise OSError(errno.EMFILE, "Too many open files")
        begun.append(subprocess.Popen(*arguments, **options))
        return begun[0]

    monkeypatch.setattr(child_processes, "Popen", popen)
    naps = [(str(tmp_path / str(k)), 20.0) for k in range(2)]
    with pytest.raises(vt.ArgumentError, match=r"started: Too many open files\. Give fewer `workers`"):
        list(run_blocks(toy_blocks.naps, naps, workers=2))
    assert all(process.poll() is not None for process in begun)


def test_functions_of_scripts_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Other processes cannot find the functions of a script: that is said at once."""

    def function(block: int) -> int:
        return block

    function.__qualname__ = function.__name__
    function.__module__ = "__main__"
    monkeypatch.setattr(sys.modules["__main__"], "function", function, raising=False)
    with pytest.raises(ValueError, match="one of a script"):
        list(run_blocks(function, range(3), workers=2))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"workers": 0}, "`workers` 0 cannot be"),
        ({"workers": True}, "`workers` true cannot be"),
        ({"workers": 2.5}, "`workers` 2.5 cannot be"),
        ({"workers": 10**6}, "Give a number from 1 to 1024"),
        ({"scheduler": ""}, "`scheduler` '' cannot be"),
        ({"scheduler": 8786}, "`scheduler` 8786 cannot be"),
        ({"scheduler": "tcp://localhost:8786", "workers": 2}, "a `scheduler` has `workers` of its own"),
    ],
)
def test_arguments_that_cannot_be_are_refused(arguments: Any, message: str) -> None:
    """One message says what is wrong, and what to give."""
    with pytest.raises(vt.ArgumentError) as raised:
        list(run_blocks(toy_blocks.square, range(3), **arguments))
    assert message in str(raised.value)


def test_as_many_processes_as_processors(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a number of workers there are as many as processors that we may use."""
    monkeypatch.setattr(blocks, "processors", lambda: 2)
    assert len({found for _, found in run_blocks(toy_blocks.pid, range(8))}) == 2


def test_without_dask_schedulers_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where Dask is not installed, one message says how to install it."""
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(vt.MissingLibraryError, match=r"pip install 'voronoi-tiles\[sweep\]'"):
        list(run_blocks(toy_blocks.square, range(3), scheduler="local"))


@pytest.mark.parametrize("listening", [False, True])
def test_a_scheduler_that_does_not_answer_is_refused(listening: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """One message after a while, whether nobody listens there or somebody who does not answer."""
    import socket

    monkeypatch.setattr(dask_blocks, "PATIENCE_S", 1.0)
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        if not listening:
            server.close()
        with pytest.raises(vt.SchedulerError) as raised:
            list(run_blocks(toy_blocks.square, range(3), scheduler=address))
    assert str(raised.value).startswith(f"cannot reach a scheduler at {address}: ")
    assert "`dask scheduler`" in str(raised.value)


@pytest.mark.parametrize("address", ["nonsense", "foo://bar:1", "tcp://127.0.0.1"])
def test_what_is_no_address_is_refused(address: str) -> None:
    """One message names it."""
    with pytest.raises(vt.SchedulerError, match=f"cannot reach a scheduler at {address}"):
        list(run_blocks(toy_blocks.square, range(3), scheduler=address))
