"""Which tests are run with --thin, which is for another Python than that which runs all."""

from __future__ import annotations

from typing import Final

THINNED: Final = 4
"""With --thin each file has one test of so many, and at least one."""


def is_left_out(number: int, count: int, minor: int) -> bool:
    """Whether a test of so many is left out with --thin; the next minor versions of Python take others.

    Which one is taken moves on from each THINNED tests to the next: every version takes all values of a parameter that
    come again and again, also where these are two or four.
    """
    return (number - number // THINNED) % THINNED != minor % min(count, THINNED)
