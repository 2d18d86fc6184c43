"""Hand-made outlines that need no engine, OpenGL and a browser where there are any, the command line's entry point."""

from __future__ import annotations

import os
import shutil
import signal
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from helpers.forking import ForkServer
from helpers.outlines import ABOVE, RIGHT, CommandLine, polygon
from helpers.page import SOFTWARE_GL, missing
from helpers.page_server import PageServer
from helpers.thinning import THINNED, is_left_out
from hypothesis import settings

from voronoi_tiles.base import kernels
from voronoi_tiles.raster import gl
from voronoi_tiles.vector.arcs import ParabolaArc
from voronoi_tiles.vector.outline import Outline

# How long an example takes says how busy the machine is; timings live in bench/.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")


_LEFT_OUT = pytest.StashKey[Counter[str]]()
"""How many "slow" tests and "other" cases are not run."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add --thin, for another Python than that which runs all."""
    parser.addoption("--thin", action="store_true", help=f"of each file one test of {THINNED}, and at least one")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave cases out where --thin says so."""
    if not config.getoption("thin"):
        return
    files: dict[Path, list[pytest.Item]] = {}
    for item in items:
        files.setdefault(item.path, []).append(item)
    left_out = {
        item
        for each in files.values()
        for number, item in enumerate(each)
        if is_left_out(number, len(each), sys.version_info.minor)
    }
    config.hook.pytest_deselected(items=[*left_out])
    items[:] = [item for item in items if item not in left_out]


def pytest_deselected(items: Sequence[pytest.Item]) -> None:
    """Count what is not run."""
    for item in items:
        kind = "slow" if item.get_closest_marker("slow") else "other"
        item.config.stash.setdefault(_LEFT_OUT, Counter())[kind] += 1


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Hand the counts to the process that prints, where this is one of several that run tests."""
    if hasattr(session.config, "workeroutput"):
        counts = session.config.stash.get(_LEFT_OUT, Counter())
        session.config.workeroutput["left out"] = dict(counts)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    """Take them; every such process has looked at all tests."""
    node.config.stash[_LEFT_OUT] = Counter(getattr(node, "workeroutput", {}).get("left out", {}))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Say how many tests were left out, and how they are run."""
    counts = config.stash.get(_LEFT_OUT, Counter())
    if counts["slow"]:
        say = "slow tests were left out: `make test-slow` runs them, or pytest -m slow."
        terminalreporter.write_line(f"{counts['slow']} {say}")
    if counts["other"] and config.getoption("thin"):
        say = "tests were left out, by --thin."
        terminalreporter.write_line(f"{counts['other']} {say}")


@pytest.fixture
def heard_signals() -> Iterator[None]:
    """Signals reach the processes that a test starts, also where ours is to ignore them, which they would inherit."""
    numbers = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    ignored = [number for number in numbers if signal.getsignal(number) is signal.SIG_IGN]
    for number in ignored:
        signal.signal(number, signal.SIG_DFL)
    yield
    for number in ignored:
        signal.signal(number, signal.SIG_IGN)


@pytest.fixture
def square() -> Outline:
    """A square of side 10 with its lower left corner at the origin."""
    return Outline.from_rings([polygon(0j, 10 + 0j, 10 + 10j, 10j)])


@pytest.fixture
def ring() -> Outline:
    """A square of side 10 with a square hole of side 2."""
    return Outline.from_rings(
        [polygon(0j, 10 + 0j, 10 + 10j, 10j), polygon(4 + 4j, 4 + 6j, 6 + 6j, 6 + 4j, neighbour=ABOVE)]
    )


@pytest.fixture
def lens() -> Outline:
    """The region -1 + x^2/4 <= y <= 1 - x^2/4, both boundaries parabolas with the focus at the origin."""
    lower = ParabolaArc(-2 + 0j, -2j, 2 + 0j, 0j, (-2 - 2j, 2 - 2j), RIGHT)
    upper = ParabolaArc(2 + 0j, 2j, -2 + 0j, 0j, (-2 + 2j, 2 + 2j), ABOVE)
    return Outline.from_rings([[lower, upper]])


@pytest.fixture
def mixed() -> Outline:
    """A square whose right side is a parabola that bulges by 2."""
    bulge = ParabolaArc(10 + 0j, 14 + 5j, 10 + 10j, 8.875 + 5j, (15.125 + 0j, 15.125 + 10j), RIGHT)
    sides = polygon(10 + 10j, 10j, 0j, 10 + 0j, neighbour=ABOVE)[:3]
    return Outline.from_rings([[bulge, *sides]])


@pytest.fixture(scope="session")
def opengl() -> None:
    """OpenGL, or the reason why a test is left out; VORONOI_TILES_REQUIRE_GL=1 makes that reason an error."""
    try:
        gl.device()
    except gl.GlError as error:
        if os.environ.get("VORONOI_TILES_REQUIRE_GL") == "1":
            raise
        pytest.skip(f"no OpenGL: {error}")


@pytest.fixture
def device(opengl: None) -> Iterator[gl.Device]:  # noqa: ARG001  (it only has to be there)
    """The device that renderers take; no error flag is up before the test or after it."""
    found = gl.device()
    with found.current():
        yield found
        found.check()


@pytest.fixture(scope="session")
def compiled() -> None:
    """The compiled kernels, or the reason why a test is left out; VORONOI_TILES_REQUIRE_KERNELS=1 makes it an error."""
    if kernels.library() is None:
        reason = f"no compiled kernels: {kernels.in_use()}"
        if os.environ.get("VORONOI_TILES_REQUIRE_KERNELS") == "1":
            pytest.fail(reason)
        pytest.skip(reason)


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """Chromium through playwright, WebGL by software; or the reason why a test is left out.

    VORONOI_TILES_REQUIRE_STUDIO=1 makes that reason an error. Each module has one of its own: while there is one, an
    event loop runs in this thread, and tests of other modules that run theirs could not.
    """
    path = shutil.which("chromium")
    if path is None or find_spec("playwright") is None:
        missing(f"{'chromium' if path is None else 'playwright'} is not installed")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=SOFTWARE_GL)
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def page_server() -> Iterator[PageServer]:
    """A server of the page's files alone, without the studio's own."""
    with PageServer() as server:
        yield server


@pytest.fixture(scope="session")
def command() -> str:
    """The path of the installed console script."""
    script = Path(sys.executable).with_name("voronoi-tiles")
    assert script.exists(), "install the project first: pip install -e ."
    return str(script)


@pytest.fixture(scope="session")
def voronoi_tiles() -> Iterator[CommandLine]:
    """Run `voronoi-tiles` with the given arguments in a process of its own, forked from one that has all imports."""
    with ForkServer() as server:
        yield server.call
