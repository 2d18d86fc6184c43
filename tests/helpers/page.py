"""Where the studio's page and its tests are, node with what npm installs beside them, and how Chromium is started."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Final, NoReturn

import pytest

TESTS: Final = Path(__file__).parents[1] / "studio"
PAGE: Final = Path(__file__).parents[2] / "voronoi_tiles" / "studio" / "page"
TOOLS: Final = TESTS / "node_modules"

SOFTWARE_GL: Final = ("--enable-unsafe-swiftshader", "--no-sandbox")
"""Chromium's options: WebGL by the processor, which it refuses by itself; as root there is no sandbox.

Not --use-angle=swiftshader: pages would be put together by it too, which no machine without a GPU does, at four times
the processor time.
"""


def node() -> str:
    """The path of node."""
    found = shutil.which("node")
    return found or missing("node is not here")


def tool(name: str) -> str:
    """The path of what npm has installed, by its place in node_modules."""
    node()
    found = TOOLS / name
    return str(found) if found.exists() else missing(f"{name} is not here: `make page-tools` installs it")


def missing(reason: str) -> NoReturn:
    """Leave a test out, with the reason; VORONOI_TILES_REQUIRE_STUDIO=1 makes that an error."""
    if os.environ.get("VORONOI_TILES_REQUIRE_STUDIO") == "1":
        pytest.fail(reason)
    pytest.skip(reason)
