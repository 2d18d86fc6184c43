"""Reading values of tables, as TOML and JSON give them: every value is checked before it is used.

Whatever is passed, only DesignError comes out. Its key is relative to the value that was read ("[1]" for
the second item); callers put their own key before it with `within`.
"""

from __future__ import annotations

import math
import reprlib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from numbers import Real
from typing import Any, TypeVar

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.text import printable
from voronoi_tiles.base.tolerance import COORDINATE_MAX, NUMBER_MIN

Table = Mapping[str, Any]
Read = TypeVar("Read")

_LARGER = "Write a larger number, or use smaller units."  # where 0 is refused too


@contextmanager
def within(key: str) -> Iterator[None]:
    """Put `key` before the keys of the errors that come out of the block."""
    try:
        yield
    except DesignError as error:
        raise error.under(key) from None


def shown(value: object) -> str:
    """A short form of any value, for messages."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Mapping):
        return "a table"
    if value is None:
        return "nothing"
    try:
        return " ".join(printable(reprlib.repr(value)).split())[:200]
    except Exception:  # noqa: BLE001 - a value whose own repr fails, as an int of 5,000 digits does
        return f"this {type(value).__name__}"


def table(value: object, known: Collection[str], remedy: str) -> Table:
    """Read a table that has no other than the known keys."""
    if not isinstance(value, Mapping):
        raise DesignError(f"must be a table, not {shown(value)}", remedy=remedy)
    for name in value:
        if not (isinstance(name, str) and name in known):
            listed = f"{suggestion(name, known)}The keys here are {', '.join(known)}."
            raise DesignError(f"unknown key {shown(name)}", remedy=listed)
    return value


def suggestion(word: object, known: Collection[str]) -> str:
    """The question whether a known word was meant, for the beginning of a remedy; nothing where none is near."""
    if not isinstance(word, str) or len(word) > 40:
        return ""
    import difflib

    return "".join(f'Did you mean "{close}"? ' for close in difflib.get_close_matches(word.lower(), known, n=1))


def required(of: Table, name: str, remedy: str) -> Any:
    """The value of a key that has to be there."""
    if name not in of:
        raise DesignError("is missing", key=name, remedy=remedy)
    return of[name]


def is_number(value: object) -> bool:
    """Whether a value is a real number, Python's or numpy's; true and false are none, nor are numpy's times."""
    # Told without numpy, whose import would take most of the time of `--help`; plain ones in a tenth of the time.
    if type(value) in (float, int):
        return True
    return isinstance(value, Real) and type(value).__name__ not in ("bool", "timedelta64")


def number(
    value: Any, remedy: str = "Write a number, such as 60.0.", tiny: str = "Write 0, or use smaller units."
) -> float:
    """Read a finite number of sane size; true and false are none. `tiny` is the remedy for one too near to 0."""
    if not is_number(value):
        raise DesignError(f"must be a number, not {shown(value)}", remedy=remedy)
    try:
        result = float(value)
    except OverflowError:  # of a whole number
        result = COORDINATE_MAX * 2
    if not abs(result) <= COORDINATE_MAX:
        if math.isfinite(result):
            raise DesignError(f"number beyond {COORDINATE_MAX:g}", remedy="Use units that keep the numbers small.")
        raise DesignError(f"must be a finite number, not {result}", remedy=remedy)
    if result != 0.0 and abs(result) < NUMBER_MIN:
        raise DesignError(f"number below {NUMBER_MIN:g}", remedy=tiny)
    return result


def positive(value: object) -> float:
    """Read a number greater than 0."""
    result = number(value, tiny=_LARGER)
    if result <= 0.0:
        raise DesignError(f"must be greater than 0, not {result:g}", remedy="Write a positive number.")
    return result


def text(value: object, remedy: str) -> str:
    """Read a text."""
    if not isinstance(value, str):
        raise DesignError(f"must be a text, not {shown(value)}", remedy=remedy)
    return value


def file_name(value: object, remedy: str) -> str:
    """Read the name of a file."""
    if not isinstance(value, str) or not value or "\0" in value:
        raise DesignError(f"must be a file's name, not {shown(value)}", remedy=remedy)
    return value


def flag(value: object, remedy: str) -> bool:
    """Read true or false."""
    if not isinstance(value, bool):
        raise DesignError(f"must be true or false, not {shown(value)}", remedy=remedy)
    return value


def sequence(value: object, remedy: str) -> list[Any] | tuple[Any, ...]:
    """Read an array."""
    if type(value) is list:
        return value
    value = getattr(value, "tolist", lambda: value)()  # of an array
    if not isinstance(value, list | tuple):
        raise DesignError(f"must be an array, not {shown(value)}", remedy=remedy)
    return value


def each(items: Iterable[Any], read: Callable[[Any], Read]) -> list[Read]:
    """Read every item; the keys of errors begin with its number."""
    found: list[Read] = []
    try:
        for item in items:
            found.append(read(item))  # noqa: PERF401 - their number is the key
    except DesignError as error:
        raise error.under(f"[{len(found)}]") from None
    return found
