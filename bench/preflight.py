"""What a preflight of a large sheet costs in this checkout, beside an older commit: time and memory.

The older commit writes the sheets, and both judge the same files, each command in a process of its own, in turns. What
counts is processor time, user and system, of the whole process, and its memory at the peak. The sheets are 600 x 300 mm
of some 8,000 tiles with kerf, of the design of sheets.py, near each other and 1 mm apart; and an example on 4250 x 4250
mm.

    python bench/preflight.py                       against 1e5cef8
    python bench/preflight.py COMMIT --rounds 5     also: --write, the table into bench/README.md
    python bench/preflight.py --keep FOLDER         leaves the environments there, and takes those that it finds
"""

from __future__ import annotations

import json
import statistics
import tempfile
from functools import partial
from pathlib import Path
from typing import NamedTuple

from against import Checkout, checkouts, in_turns, run
from processes import usage_of
from report import machine, table
from sheets import design_text

TILES = 10_000


class Cost(NamedTuple):
    """The processor seconds of a process, and the megabytes at its peak."""

    seconds: float
    megabytes: float


def cost(checkout: Checkout, file: Path) -> tuple[Cost, bytes]:
    """What the preflight of a file costs, and the report that it prints."""
    with tempfile.TemporaryFile() as printed:
        command = [str(checkout.environment / "bin" / "voronoi-tiles"), "preflight", str(file), "--json"]
        usage = usage_of(command, stdout=printed, fine=(0, 1))
        printed.seek(0)
        return Cost(usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1000), printed.read()


def sheets(old: Checkout, folder: Path) -> dict[str, Path]:
    """The files that are judged, by what they are."""
    design = folder / "tiles.toml"
    design.write_text(design_text(TILES), encoding="utf-8")
    hook = old.source / "examples" / "p4-hook.toml"
    found: dict[str, Path] = {}
    for name, made, size, more in (
        ("600 x 300 mm, kerf 0.1, gap 0.3", design, "600x300mm", ("--kerf", "0.1mm", "--gap", "0.3mm")),
        ("600 x 300 mm, kerf 0.15", design, "600x300mm", ("--kerf", "0.15mm")),
        ("p4-hook, 4250 x 4250 mm, kerf 0.15", hook, "4250x4250mm", ("--kerf", "0.15mm")),
    ):
        found[name] = folder / f"{len(found)}.svg"
        old.command("export", str(made), "-o", str(found[name]), "--sheet", size, *more)
    return found


def compare(commit: str, rounds: int, keep: Path) -> None:
    """Print the table."""
    old, new = checkouts(commit, keep)
    with tempfile.TemporaryDirectory() as name:
        print(f"{machine()}\n\nAgainst {commit}: medians of {rounds} processes each.")
        heads = "ratio, time", "ratio, memory", "this, CPU s", f"{commit}, CPU s", "this, MB", f"{commit}, MB"
        table("Ratio = this checkout / the commit:", *heads, "paths", "segments", "file")
        for what, file in sheets(old, Path(name)).items():
            before, after = in_turns(old, new, rounds, partial(cost, file=file))
            said = json.loads(after[-1][1])
            paths = sum(layer["shapes"] for layer in said["layers"])
            (s, m), (t, n) = (
                (statistics.median(spent.seconds for spent, _ in some), max(spent.megabytes for spent, _ in some))
                for some in (after, before)
            )
            print(
                f"| {s / t:.2f} | {m / n:.2f} | {s:.2f} | {t:.2f} | {m:.0f} | {n:.0f} | {paths:,} | "
                f"{said['pieces']:,} | {what} |",
                flush=True,
            )


def main() -> None:
    """Compare."""
    run("preflight", __doc__, 3, compare)


if __name__ == "__main__":
    main()
