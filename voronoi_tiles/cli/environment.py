"""What the program runs on, for reports of problems."""

from __future__ import annotations

import platform
import re
from importlib.metadata import PackageNotFoundError, requires, version

from voronoi_tiles.base.kernels import in_use


def environment() -> str:
    """The kernels in use, Python, and the versions of what is installed with the program, a line each."""
    entries = [entry for entry in requires("voronoi-tiles") or () if "extra ==" not in entry]
    # One is listed twice where a platform asks for more of it.
    names = dict.fromkeys(re.split(r"[^\w.-]", entry)[0] for entry in entries)
    lines = [
        f"kernels: {in_use()}",
        f"Python {platform.python_version()} on {platform.platform()}",
        *(f"{name} {_version(name)}" for name in names),
    ]
    return "\n".join(lines)


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "is missing"
