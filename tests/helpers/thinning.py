"""Which cases of a numeric test are run with --thin, which is for another Python than that which runs all."""

from __future__ import annotations

from typing import Final

THINNED: Final = 4
"""With --thin a numeric test has one case of so many, and at least one."""


def is_left_out(number: int, count: int, minor: int) -> bool:
    """Whether a case of so many is left out with --thin; other minor versions of Python take other cases.

    Which one is taken of THINNED cases moves on from these to the next: every version takes all values of a parameter
    that come again and again, also where these are two or four.
    """
    return (number - number // THINNED) % THINNED != minor % min(count, THINNED)
