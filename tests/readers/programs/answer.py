"""What the script of every program prints: what that program has read of a file, in millimetres, y up."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from importlib.metadata import version
from itertools import pairwise

SAMPLES = 128
"""Points for each curve; a count. One that is bent by 1 mm is 1 / 128^2 = 0.00006 mm off its chords."""

PX = 25.4 / 96
"""A pixel of CSS, the user unit of a page without a size; millimetres."""

Contour = tuple[list[complex], bool]
"""The points of a contour, and whether the program takes it for closed."""


def sampled(curve: Callable[[float], complex], knots: Sequence[float] = (0.0, 1.0)) -> list[complex]:
    """Points along a curve whose parameter goes from the first knot to the last, without its start."""
    return [curve(low + (high - low) * k / SAMPLES) for low, high in pairwise(knots) for k in range(1, SAMPLES + 1)]


def answer(
    contours: Iterable[Contour],
    *,
    distribution: str = "",
    program_version: str = "",
    entities: Iterable[str] = (),
    size: tuple[float, float] | None = None,
    area: float | None = None,
    counted: bool = True,
) -> None:
    """Print what a program has read.

    Its version is given, or found by the name of its distribution. Where `counted` is false the contours are only parts
    of a picture. `entities` are the names that it has for what it read, one each; `size` (mm) and `area` (mm2) are what
    it says itself where one asks it.
    """
    kept = [(points, closed) for points, closed in contours if points]
    print(
        json.dumps(
            {
                "version": program_version or version(distribution),
                "contours": [[[point.real, point.imag] for point in points] for points, _ in kept],
                "closed": [closed for _, closed in kept],
                "entities": Counter(entities),
                "size": size,
                "area": area,
                "counted": counted,
            }
        )
    )
