"""How a number of a design varies in a sweep: among values, between two, or about its own."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from voronoi_tiles.base import values
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.groups.wallpaper import GROUPS

STEPS_MAX: Final = 100_000
"""Most steps of a range; a count."""

_REMEDY: Final = "Write { from = 40, to = 80 }, { around = 2 }, { deviation = 2 }, or values, [1, 2, 3]."
_STEPS: Final = "Write { from = 40, to = 80, steps = 5 } or values, or a `count` of random designs."

Random = np.random.Generator


@dataclass(frozen=True, slots=True)
class Choices:
    """Some values, each as often as any other."""

    values: tuple[Any, ...]

    def drawn(self, _own: float, random: Random) -> Any:
        """One of them."""
        return self.values[int(random.random() * len(self.values))]

    def steps(self, _own: float) -> tuple[Any, ...]:
        """All of them."""
        return self.values


@dataclass(frozen=True, slots=True)
class Span:
    """All that lies from `low` to `high`, evenly, about the number's own value where `about_own`; or so many steps."""

    low: float
    high: float
    about_own: bool = False
    count: int | None = None

    def drawn(self, own: float, random: Random) -> float:
        """A value in between, or one of the steps."""
        base = own if self.about_own else 0.0
        if self.count is not None:
            return base + self._step(int(random.random() * self.count), self.count)
        return base + self.low + random.random() * (self.high - self.low)

    def steps(self, own: float) -> tuple[float, ...]:
        """The steps, both ends among them. Raises DesignError where there are none."""
        if self.count is None:
            raise DesignError("has no steps, which a grid needs", remedy=_STEPS)
        base = own if self.about_own else 0.0
        return tuple(base + self._step(k, self.count) for k in range(self.count))

    def _step(self, k: int, count: int) -> float:
        """One of so many steps; the last is the upper end to the last digit."""
        return self.high if k == count - 1 else self.low + k * ((self.high - self.low) / (count - 1))


@dataclass(frozen=True, slots=True)
class Spread:
    """A normal distribution about the number's own value."""

    deviation: float

    def drawn(self, own: float, random: Random) -> float:
        """A value."""
        return own + self.deviation * float(random.standard_normal())

    def steps(self, _own: float) -> tuple[float, ...]:
        """No steps: raises DesignError."""
        raise DesignError("has no steps, which a grid needs", remedy=_STEPS)


Variation = Choices | Span | Spread


def read_variation(value: object) -> Variation:
    """Read how a number varies. Raises DesignError."""
    if not isinstance(value, dict):
        listed = values.sequence(value, _REMEDY)
        if not listed:
            raise DesignError("has no values", remedy=_REMEDY)
        return Choices(tuple(values.each(listed, values.number)))
    table = values.table(value, ("from", "to", "around", "deviation", "steps"), _REMEDY)
    kinds = {"from", "to"} & table.keys(), {"around"} & table.keys(), {"deviation"} & table.keys()
    if sum(map(bool, kinds)) != 1:
        raise DesignError("must say one way to vary", remedy=_REMEDY)
    if "deviation" in table:
        if "steps" in table:
            raise DesignError("a normal distribution has no steps", key="steps", remedy="Leave them out.")
        return Spread(_positive(table, "deviation"))
    count = _read_steps(table)
    if "around" in table:
        reach = _positive(table, "around")
        return Span(-reach, reach, about_own=True, count=count)
    ends = []
    for name in ("from", "to"):
        end = values.required(table, name, _REMEDY)
        with values.within(name):
            ends.append(values.number(end))
    if not ends[0] < ends[1]:
        raise DesignError(f"must be greater than {ends[0]:g}", key="to", remedy="Write the smaller number first.")
    return Span(ends[0], ends[1], count=count)


def read_groups(value: object) -> Choices:
    """Read the groups that a sweep chooses from: names, or "all". Raises DesignError."""
    if isinstance(value, str) and value == "all":
        return Choices(tuple(GROUPS))
    remedy = f'Write groups, such as ["p3", "p6"], or "all"; they are {", ".join(GROUPS)}.'
    listed = values.sequence(value, remedy)
    for number, name in enumerate(listed):
        if not (isinstance(name, str) and name in GROUPS):
            raise DesignError(f"unknown group {values.shown(name)}", key=f"[{number}]", remedy=remedy)
    if not listed:
        raise DesignError("has no groups", remedy=remedy)
    return Choices(tuple(listed))


def _positive(table: values.Table, name: str) -> float:
    with values.within(name):
        return values.positive(table[name])


def _read_steps(table: values.Table) -> int | None:
    """The number of steps, None where there are none."""
    steps = table.get("steps")
    if steps is None:
        return None
    if not (values.is_number(steps) and 2 <= steps <= STEPS_MAX and steps == math.floor(steps)):
        raise DesignError(
            f"must be a whole number from 2 to {STEPS_MAX:,}, not {values.shown(steps)}",
            key="steps",
            remedy="Write steps = 5.",
        )
    return int(steps)
