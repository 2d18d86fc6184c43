"""The budget: what steps spend adds up to what the caller gave."""

from __future__ import annotations

from typing import Any

import pytest

from voronoi_tiles.fabrication.accuracy import AccuracyBudget
from voronoi_tiles.fabrication.job import Job


@pytest.mark.parametrize("accuracy", [1e-5, 0.005, 1.0])
@pytest.mark.parametrize("curves", ["exact", "arc", "cubic", "spline", "polyline"])
@pytest.mark.parametrize("job", [{}, {"kerf": 0.15}, {"fillet": 1.0}, {"kerf": 0.15, "fillet": 1.0}])
def test_all_is_spent_and_no_more(job: dict[str, Any], curves: str, accuracy: float) -> None:
    """The parts add up to the whole; nothing is kept for steps that are not taken."""
    budget = AccuracyBudget.of(Job(accuracy=accuracy, **job), curves)
    assert budget.whole == accuracy
    assert budget.arcs + budget.short + budget.chords + budget.cubics == pytest.approx(accuracy, rel=1e-12)
    assert budget.arcs > 0.0
    assert (budget.short > 0.0) == bool(job)
    assert (budget.chords > 0.0) == (curves == "polyline")
    assert (budget.cubics > 0.0) == (curves == "cubic")
    assert 0.0 < budget.measured < accuracy


def test_more_than_there_is_cannot_be_spent() -> None:
    """A budget that is made by hand, and a thousandth too large."""
    AccuracyBudget(whole=0.01, arcs=0.005, short=0.003, chords=0.001, cubics=0.001)
    with pytest.raises(AssertionError, match="more is spent"):
        AccuracyBudget(whole=0.01, arcs=0.005, short=0.00301, chords=0.001, cubics=0.001)
