"""What drives a laser along the lines of each kind of work: feed and power."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, get_args

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.values import number

Role = Literal["cut", "inner", "score", "engrave"]
ROLES: Final[tuple[Role, ...]] = get_args(Role)

_CUTS: Final[tuple[Role, ...]] = ("cut", "inner")
_RATE_MIN: Final = 1e-3
_RATE_MAX: Final = 1e6  # more millimetres a minute, and more of S, is a slip
_REMEDY: Final = "Write millimetres a minute, or a number up to the machine's $30, such as 800."


@dataclass(frozen=True, slots=True)
class Burn:
    """How a laser goes along paths: `feed` in mm/min, and `power` of `power_max`, in the units of the machine's S."""

    feed: float
    power: float
    power_max: float


def rate(value: object) -> float:
    """Read a feed or a power. Raises DesignError."""
    result = number(value, _REMEDY)
    if not _RATE_MIN <= result <= _RATE_MAX:
        raise DesignError(f"must be from {_RATE_MIN:g} to {_RATE_MAX:,.0f}, not {result:g}", remedy=_REMEDY)
    return result


def rates_of(text: str | None) -> dict[Role, float]:
    """Read feeds or powers, "cut=300,engrave=3000"; a number alone is that of all cuts, and of nothing else.

    None has none. Raises ValueError, of which DesignError is one.
    """
    rates: dict[Role, float] = {}
    for part in () if text is None else text.split(","):
        before, equals, value = part.rpartition("=")
        for role in (before.strip(),) if equals else _CUTS:
            if role not in ROLES or role in rates:
                raise ValueError(f"{part!r} is no work, or stands twice")
            rates[role] = rate(float(value))
    return rates
