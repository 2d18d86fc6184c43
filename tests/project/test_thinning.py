"""--thin: no test is left out on every Python, and no value of a parameter that comes often enough on one of them."""

from __future__ import annotations

import pytest
from helpers.thinning import THINNED, is_left_out

MINORS = range(11, 11 + THINNED)


def run(count: int, minor: int) -> list[int]:
    """Those of so many tests that are run."""
    return [number for number in range(count) if not is_left_out(number, count, minor)]


@pytest.mark.parametrize("count", range(1, 70))
def test_every_case_is_run_on_one_of_so_many_pythons(count: int) -> None:
    """And each Python runs at least one, and hardly more than its part."""
    for first in range(12, 16):
        cases = [run(count, minor) for minor in range(first, first + THINNED)]
        assert set().union(*cases) == set(range(count))
        assert all(1 <= len(some) <= -(-count // THINNED) for some in cases)


@pytest.mark.parametrize("minor", MINORS)
@pytest.mark.parametrize(("values", "count"), [(2, 8), (3, 24), (4, 16)])
def test_every_python_runs_all_values_of_a_parameter(values: int, count: int, minor: int) -> None:
    """Of the last one, whose values come again and again, and of the first one, which has each in one stretch."""
    cases = run(count, minor)
    assert {number % values for number in cases} == set(range(values))
    assert {number // (count // values) for number in cases} == set(range(values))
