"""Arguments of public functions: what they must be, said by the argument's name."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any, Protocol, TypeVar

from voronoi_tiles.base.errors import ArgumentError, UnknownNameError
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.base.values import is_number, shown

Kind = TypeVar("Kind")


class _Named(Protocol):
    """What belongs to a site, and has its name."""

    @property
    def name(self) -> str: ...


Named = TypeVar("Named", bound=_Named)


def instance(name: str, value: Any, kind: type[Kind]) -> Kind:
    """The value of an argument that has to be of a class. Raises ArgumentError for another."""
    if not isinstance(value, kind):
        raise ArgumentError(f"`{name}` {shown(value)} cannot be", remedy=f"Give {_called(kind)}.")
    return value


def _called(kind: type) -> str:
    """A class with its article."""
    name = {"str": "text", "Operation": "Operation, or its triplet"}.get(kind.__name__, kind.__name__)
    return f"{'an' if name[0] in 'AEIOU' else 'a'} {name}"


def number(name: str, value: Any, remedy: str, *, least: float = -COORDINATE_MAX) -> float:
    """The value of an argument that has to be a number from `least` to COORDINATE_MAX. Raises ArgumentError."""
    if not is_number(value) or not least <= value <= COORDINATE_MAX:
        raise ArgumentError(f"`{name}` {shown(value)} cannot be", remedy=remedy)
    return float(value)


def whole_number(name: str, value: Any, remedy: str, *, least: int) -> int:
    """The value of an argument that has to be a whole number from `least`, such as 2 or 2.0. Raises ArgumentError."""
    found = number(name, value, remedy, least=least)
    if found != int(found):
        raise ArgumentError(f"`{name}` {shown(value)} cannot be", remedy=remedy)
    return int(found)


def flag(name: str, value: Any) -> bool:
    """The value of an argument that has to be True or False. Raises ArgumentError."""
    if not isinstance(value, bool):
        raise ArgumentError(f"`{name}` {shown(value)} cannot be", remedy="Give True or False.")
    return value


def texts(name: str, value: Any, remedy: str) -> list[str]:
    """The value of an argument that has to be texts; a single one is a list of one. Raises ArgumentError."""
    listed = [value] if isinstance(value, str) else value
    if isinstance(listed, Iterable):
        found = list(listed)
        if all(isinstance(each, str) for each in found):
            return found
    raise ArgumentError(f"`{name}` {shown(value)} cannot be", remedy=remedy)


def function(name: str, value: Any) -> None:
    """Refuse an argument that has to be a function, or None. Raises ArgumentError."""
    if value is not None and not callable(value):
        raise ArgumentError(f"`{name}` {shown(value)} cannot be called", remedy="Give a function, or leave it out.")


def path_name(name: str, value: Any) -> str:
    """The value of an argument that has to be a path, as a text. Raises ArgumentError for what is none, and bytes."""
    path = os.fspath(value) if isinstance(value, os.PathLike) else value
    if not isinstance(path, str):
        raise ArgumentError(f"`{name}` {shown(value)} is no path", remedy="Give a str or a Path.")
    return path


def of_site(items: Iterable[Named], name: str) -> Named:
    """The one of some items, one for each site, that has a site's name. Raises UnknownNameError."""
    found = {item.name: item for item in items}
    if name not in found:
        raise UnknownNameError(f'there is no site "{name}"', remedy=f"Sites are {', '.join(found)}.")
    return found[name]
