"""Node, and what npm installs beside the tests of the studio's page."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Final, NoReturn

import pytest

TESTS: Final = Path(__file__).parents[1] / "studio"
PAGE: Final = Path(__file__).parents[2] / "voronoi_tiles" / "studio" / "page"
TOOLS: Final = TESTS / "node_modules"


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
