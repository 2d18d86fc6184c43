"""Which tests are run with --thin, which is for another Python than that which runs all."""

from __future__ import annotations

from typing import Final

THINNED: Final = 4
"""With --thin a numeric test has one case of so many, and at least one."""

HALVED: Final = 2
"""Of all other tests each file has one of so many."""


def is_left_out(number: int, count: int, minor: int, parts: int) -> bool:
    """Whether a case of so many is left out with --thin; the next minor versions of Python take the other parts.

    Which one is taken moves on from each THINNED cases to the next: every version takes all values of a parameter that
    come again and again, also where these are two or four.
    """
    return (number - number // THINNED) % parts != minor % min(count, parts)
