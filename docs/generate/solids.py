"""The pictures of docs/solids.md, by the commands that stand there.

python docs/generate/solids.py             writes docs/pictures/solid-*.png
"""

from __future__ import annotations

from typing import Final

from running import Command, run_all


def _picture(name: str, design: str, *options: str, size: int = 330) -> Command:
    """The command that draws one."""
    words = (*options, "--size", str(size))
    return Command(("voronoi-tiles", "solid"), design, f"docs/pictures/solid-{name}.png", words)


LOFTS: Final = {"scutoid": "pgg-scutoid", "noodle": "p1-noodle", "abeille": "p4-abeille", "twist": "p2-twist"}
"""Those of designs that stand, and the examples that they are of."""

PICTURES: Final = (
    _picture("puzzle", "examples/p3-puzzle.toml", "--height", "10mm", "--chamfer", "0.6mm"),
    _picture(
        "bed",
        "examples/solid/p4-two.toml",
        *("--sheet", "160x160mm", "--height", "6mm", "--clearance", "0.3mm", "--chamfer", "0.5mm"),
        *("--gap", "1.5mm", "--colours", "site"),
    ),
    *(_picture(name, f"examples/solid/{design}.toml", size=272) for name, design in LOFTS.items()),
    _picture("stack", "examples/solid/p3-steps.toml", "--sheets", "9"),
)
"""In the order of the page."""


if __name__ == "__main__":
    run_all(PICTURES)
