"""The studio in a real browser: how old exact outlines are when they are drawn, what frames cost, when reports come.

    python bench/studio.py               two minutes; needs the test extra and Debian's chromium
    python bench/studio.py --write       the table into bench/README.md

Without a GPU, the browser draws by the processor; a real GPU is measured by opening the studio with ?bench. Ages are
wall clock, so the machine has to be idle; what can be is processor time of the processes in question. Points are
dragged by the browser's own mouse events, and the page takes the times itself.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import shutil
import statistics
import sys
import tempfile
import time
import urllib.request
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from report import machine, published, table
from websockets.sync.client import connect

sys.path.append(str(Path(__file__).parents[1] / "tests"))
from helpers.page import PAGE, SOFTWARE_GL
from helpers.studio import Studio, Window, opened, running

TICK = os.sysconf("SC_CLK_TCK")

MOVES = 125
"""How often a mouse says where it is; times a second."""

DEVTOOLS = 9333
"""The port on which the browser is told what the mouse does."""


def zigzag(segments: int, group: str) -> dict[str, Any]:
    """A design of one stroke, a wave of so many segments, in a cell of 60 mm."""
    points = [
        [round(5 + 22 * k / segments, 4), round(16 + 9 * math.sin(2 * math.pi * k / segments), 4)]
        for k in range(segments + 1)
    ]
    return {"schema": 1, "group": group, "cell": {"a": 60.0}, "site": [{"strokes": [{"polyline": points}]}]}


def processor_time(processes: Sequence[int]) -> float:
    """The processor time of processes so far; seconds."""
    total = 0.0
    for process in processes:
        try:
            fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
        except OSError:
            continue
        total += (int(fields[11]) + int(fields[12])) / TICK
    return total


def of_session(session: int) -> list[int]:
    """The processes of a session."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            fields = (folder / "stat").read_text(encoding="utf-8").rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[3]) == session:
            found.append(int(folder.name))
    return found


def of_browser() -> list[int]:
    """The processes below ours that are Chromium's."""
    parents, lines = {}, {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            fields = (folder / "stat").read_text(encoding="utf-8").rpartition(")")[2].split()
            lines[int(folder.name)] = (folder / "cmdline").read_bytes().decode(errors="replace")
        except OSError:
            continue
        parents[int(folder.name)] = int(fields[1])
    found = []
    for process, line in lines.items():
        above: int | None = process
        while above is not None and above != os.getpid():
            above = parents.get(above)
        if above is not None and "chromium" in line:
            found.append(process)
    return found


@contextmanager
def studio_of(chromium: Any, design: dict[str, Any], **options: Any) -> Iterator[tuple[Studio, Window, float]]:
    """A studio of a design, its page, and the processor time of its processes until the first outline was there."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "design.json").write_text(json.dumps(design), encoding="utf-8")
        with running(Path(folder), "design.json") as studio, opened(chromium, studio, **options) as window:
            window.wait()
            started = processor_time(of_session(studio.process.pid))
            window.page.goto(f"http://127.0.0.1:{studio.port}/?bench")
            window.page.wait_for_function("() => window.studio?.bench")
            window.wait()
            yield studio, window, started


@contextmanager
def mouse_of(page: Any) -> Iterator[Callable[[float, float], None]]:
    """A page's mouse, its left button down, which waits for the page as little as a hand does."""
    with urllib.request.urlopen(f"http://127.0.0.1:{DEVTOOLS}/json") as found:
        targets = {target["url"]: target["webSocketDebuggerUrl"] for target in json.load(found)}
    moves = 0
    with connect(targets[page.url]) as socket:

        def move(x: float, y: float) -> None:
            nonlocal moves
            moves += 1
            event = {"type": "mouseMoved", "x": x, "y": y, "button": "left", "buttons": 1}
            socket.send(json.dumps({"id": moves, "method": "Input.dispatchMouseEvent", "params": event}))

        yield move
        while json.loads(socket.recv(timeout=20)).get("id") != moves:
            pass


def dragged(window: Window, seconds: float) -> dict[str, Any]:
    """What the page measures while the middle point of the stroke is dragged to and fro, and after it rests."""
    page = window.page
    points = window.design["site"][0]["strokes"][0]["polyline"]
    x, y = points[len(points) // 2]
    page.keyboard.press("v")
    window.click(*points[len(points) // 4])
    at = window.at(x, y)
    page.mouse.move(*at)
    page.mouse.down()
    page.mouse.move(at[0] + 5, at[1])
    page.wait_for_timeout(300)
    page.evaluate("() => window.studio.bench.reset()")
    processes = of_browser()
    with mouse_of(page) as move:
        before = processor_time(processes)
        start = time.monotonic()
        while (now := time.monotonic() - start) < seconds:
            move(at[0] + 14 * math.sin(7 * now), at[1] + 10 * math.sin(9 * now))
            time.sleep(1 / MOVES)
    took = time.monotonic() - start
    cost = processor_time(processes) - before
    figures: dict[str, Any] = page.evaluate("() => window.studio.bench.figures()")
    page.evaluate("() => window.studio.bench.reset()")
    page.mouse.up()
    window.wait()
    page.wait_for_timeout(300)
    rests = page.evaluate("() => window.studio.bench.figures().rests")
    page.keyboard.press("Control+z")
    window.wait()
    return {**figures, "took": took, "frame cost": 1e3 * cost / max(figures["frames"], 1), "rests": rests}


def share(values: Sequence[float], part: float) -> float:
    """The value below which a part of them lies."""
    return sorted(values)[int(part * (len(values) - 1))] if values else math.nan


def row(name: str, asked: str, value: float, reached: bool) -> None:
    """Print one line."""
    print(f"| {'yes' if reached else '**no**'} | {value:.3g} | {asked} | {name} |")


def measure(chromium: Any, seconds: float) -> None:
    """Print the table."""
    table("What was asked of the studio, and what is reached:", "reached", "value", "asked", "what")
    for group in ("p4", "p6"):
        with studio_of(chromium, zigzag(24, group), viewport={"width": 1000 + 51 + 340, "height": 700 + 78}) as found:
            _, window, started = found
            if group == "p4":
                row("processor time from the command to the first exact outline, s", "<= 1.0", started, started <= 1)
            drag = dragged(window, seconds)
            ages = drag["ages"]
            rate = len(ages) / drag["took"]
            row(
                f"24 segments, {group}: age of the exact outline, median, ms",
                "<= 12",
                share(ages, 0.5),
                share(ages, 0.5) <= 12,
            )
            row(f"24 segments, {group}: the same, 95 %", "<= 30", share(ages, 0.95), share(ages, 0.95) <= 30)
            row(f"24 segments, {group}: exact outlines a second", ">= 45", rate, rate >= 45)
            proved = drag["proved"] / drag["took"]
            row(f"24 segments, {group}: proved ones a second", ">= 45", proved, proved >= 45)
            cost = drag["frame cost"]
            row(f"24 segments, {group}: processor time of the whole browser a frame, ms", "<= 16", cost, cost <= 16)
            picture = window.page.evaluate("() => window.studio.bench.preview()")["dragged"]["median"]
            row(f"24 segments, {group}: a picture by WebGL while it is dragged, ms", "<= 16", picture, picture <= 16)
            if group == "p4":
                reports(window)
    with studio_of(chromium, zigzag(300, "p4")) as (_, window, _started):
        drag = dragged(window, seconds)
        rate = len(drag["ages"]) / drag["took"]
        row("300 segments: exact outlines a second", ">= 30", rate, rate >= 30)
        rest = statistics.median(drag["rests"] or [math.nan])
        row("300 segments: proved at full tolerance after rest, ms", "<= 150", rest, rest <= 150)
    size = sum(path.stat().st_size for path in PAGE.rglob("*") if path.is_file() and path.name != "package.json") / 1e3
    row("the page, unpacked, kB", "<= 150", size, size <= 150)


def reports(window: Window) -> None:
    """When report, preflight and kerf of a sheet of 300 x 200 mm are there after a change."""
    page = window.page
    page.get_by_role("tab", name="Job").click()
    page.get_by_label("Sheet", exact=True).fill("300x200mm")
    page.keyboard.press("Enter")
    page.get_by_label("Kerf, mm").fill("0.15")
    page.keyboard.press("Enter")
    page.wait_for_timeout(3000)
    page.evaluate("() => window.studio.bench.reset()")
    for k in range(6):
        page.get_by_role("tab", name="Drawing").click()
        page.locator("#overlay").focus()
        page.keyboard.press("Control+a")
        page.keyboard.press("ArrowLeft" if k % 2 else "ArrowRight")
        page.get_by_role("tab", name="Report").click()
        page.wait_for_timeout(2500)
    jobs = page.evaluate("() => window.studio.bench.figures().jobs")
    middle = share(jobs, 0.5)
    row(
        "sheet 300 x 200 mm: report, preflight and kerf after a change, ms",
        "<= 200 + 150 of rest",
        middle,
        middle <= 350,
    )
    page.get_by_role("tab", name="Drawing").click()


def main() -> None:
    """Parse the arguments and measure."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=6.0, help="of each drag [default: 6]")
    parser.add_argument("--write", action="store_true", help="put the table into bench/README.md")
    options = parser.parse_args()
    from playwright.sync_api import sync_playwright

    with published("studio", write=options.write), sync_playwright() as playwright:
        chromium = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=[*SOFTWARE_GL, f"--remote-debugging-port={DEVTOOLS}"]
        )
        print(machine())
        measure(chromium, options.seconds)


if __name__ == "__main__":
    main()
