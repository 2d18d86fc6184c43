"""The tables: their heads, the machine they were measured on, and their places in README.md."""

from __future__ import annotations

import datetime as dt
import io
import os
import platform
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path

import numpy as np

from voronoi_tiles import __version__

REPORT = Path(__file__).with_name("README.md")


def table(title: str, *heads: str) -> None:
    """Print the head of a table."""
    print(f"\n{title}\n\n| {' | '.join(heads)} |\n|{'---:|' * len(heads)}")


def machine() -> str:
    """Describe the machine and the versions."""
    model = platform.processor() or platform.machine()
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        lines = cpuinfo.read_text(encoding="utf-8").splitlines()
        model = next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), model)
    today = dt.datetime.now(tz=dt.UTC).date().isoformat()
    return (
        f"{today}, {model}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}; Python {platform.python_version()}, "
        f"numpy {np.__version__}, voronoi_tiles {__version__}"
    )


@contextmanager
def published(name: str, *, write: bool) -> Iterator[None]:
    """With `write`, put what is printed between the marks of this name in README.md too, once all of it is there."""
    if not write:
        yield
        return
    text = io.StringIO()
    with redirect_stdout(text):
        yield
    sys.stdout.write(text.getvalue())
    publish(name, text.getvalue())


def publish(name: str, text: str) -> None:
    """Put a text between the marks of this name in README.md; raises ValueError where there are none."""
    first, last = f"<!-- {name} -->", f"<!-- end of {name} -->"
    report = REPORT.read_text(encoding="utf-8")
    before, opening, rest = report.partition(first)
    _, closing, after = rest.partition(last)
    if not (opening and closing):
        raise ValueError(f"{REPORT.name} has no marks {first} and {last}")
    REPORT.write_text(f"{before}{first}\n\n{text.strip()}\n\n{last}{after}", encoding="utf-8")
