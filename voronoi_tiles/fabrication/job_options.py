"""What the options of a job are: what each takes, its default, and what it means, for Python and the command line.

An option is a field of a Job, as a descriptor: whatever it is given is read when the job is made, so that the job holds
numbers of millimetres, whatever texts it was made of. `help` is what `voronoi-tiles export --help` says of it.
"""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import KW_ONLY, dataclass, fields
from inspect import getattr_static
from numbers import Integral
from typing import Any, Final, Generic, Literal, TypeAlias, TypeVar, cast, get_args

from voronoi_tiles.base.errors import ArgumentError, DesignError
from voronoi_tiles.base.units import parse_length, parse_size
from voronoi_tiles.base.values import is_number, shown
from voronoi_tiles.formats.burns import ROLES, rates_of
from voronoi_tiles.formats.presets import FORMATS, SUFFIXES

SHEET_MAX: Final = 100_000.0
"""Largest side of a sheet, and largest length of an option; millimetres."""

SHEET_MIN: Final = 0.1
"""Smallest side of a sheet; millimetres."""

COUNT_MAX: Final = 10_000
"""Most pieces that a scale or a sheet is looked for; a count."""

SHEETS_MOST: Final = 1_000
"""Most sheets that pieces are nested on; a count."""

COLOURS_MAX: Final = 32
"""Most colours that are asked for; a count."""

SCHEMES: Final = ("none", "fewest", "site", "handedness", "orientation", "layers", "files")
"""What colours of tiles can be called, beside their number."""

LAYOUTS: Final = ("tessellated", "nested", "auto")
"""How pieces can be laid, beside where a file has them."""

EFFORT_S: Final = 30.0
"""How long places are looked for where the caller does not say; seconds."""

EFFORT_MAX: Final = 86_400.0
"""Longest search for places; seconds."""

LAID: Final = tuple(f".{name}" for name in (*FORMATS, *SUFFIXES))
"""The suffixes of files that have places."""

Given = TypeVar("Given")
Kept = TypeVar("Kept")
Kind = Literal["length", "angle", "word", "flag", "text", "number"]

SheetSize: TypeAlias = tuple[float, float] | str | os.PathLike[str] | None
Rates: TypeAlias = float | str | Mapping[str, float] | None
Quantities: TypeAlias = int | str | Mapping[str, int] | Sequence[tuple[str, int]] | None
Offset: TypeAlias = complex | tuple[float | str, float | str] | str | None


class JobError(ArgumentError):
    """A job that cannot be done; `message` without a full stop, `remedy` a sentence, `fields` names its options."""


@dataclass(eq=False)
class Option(Generic[Given, Kept]):
    """An option of a job: `read` makes what is kept of what is given under a name; `words` are those that it takes.

    `limits` are the least and the greatest number, where there are any.
    """

    default: Kept
    read: Callable[[str, Any], Kept]
    help: str
    _: KW_ONLY
    kind: Kind
    shown: str = ""
    words: tuple[str, ...] = ()
    limits: tuple[float, float] | None = None

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, job: object | None, owner: type | None = None) -> Kept:
        return self.default if job is None else cast("Kept", job.__dict__[self.name])

    def __set__(self, job: object, value: Given) -> None:
        job.__dict__[self.name] = self.read(self.name, value)


class OptionTable:
    """The base of dataclasses whose fields are options: they say what differs from its default."""

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in self._said())})"

    @classmethod
    def options(cls) -> dict[str, Option[Any, Any]]:
        """The options by their names, in the order of the fields."""
        return {field.name: getattr_static(cls, field.name) for field in fields(cast("Any", cls))}

    def _said(self) -> Iterator[tuple[str, Any]]:
        """The options that differ from their defaults."""
        for name, option in self.options().items():
            value = getattr(self, name)
            if value != option.default:
                yield name, value

    def recipe(self) -> dict[str, Any]:
        """What differs from the defaults, in the types of JSON."""
        return {
            name: [value.real, value.imag]
            if isinstance(value, complex)
            else list(value)
            if isinstance(value, tuple)
            else value
            for name, value in self._said()
        }


def explained(job: type[OptionTable]) -> str:
    """The docstring of a job, and a line of each option."""
    return "\n".join((job.__doc__ or "", *(f"    - `{name}`: {one.help}" for name, one in job.options().items())))


Length: TypeAlias = Option[float | str, float]
Choice: TypeAlias = Option[Kept, Kept]
Flag: TypeAlias = Option[bool, bool]


def length(
    default: Kept,
    help: str,  # noqa: A002 - as in Option
    *,
    least: float = 0.0,
    most: float = SHEET_MAX,
    shown: str = "LENGTH",
) -> Option[float | str | Kept, float | Kept]:
    """An option that takes a length from `least` to `most`, or None where that is the default."""

    def read(name: str, value: object) -> float | Kept:
        if value is None and default is None:
            return default
        size = read_number(name, value)
        if not least <= size <= most:
            raise JobError(f"`{name}` {size:g} mm cannot be", remedy=f"Give a length from {least:g} to {most:,.0f} mm.")
        return size

    return Option(default, read, help, kind="length", shown=shown, limits=(least, most))


def rates(help: str, *, shown: str) -> Option[Rates, str | None]:  # noqa: A002 - as in Option
    """An option that takes a rate for cuts, or one for each kind of work; None as the preset says."""
    return Option(None, read_rates, help, kind="text", shown=shown)


def choice(default: Any, kind: Any, help: str) -> Option[Any, Any]:  # noqa: A002 - as in Option
    """An option that takes one of some words, those of a Literal; None where that is the default."""
    words = get_args(kind)

    def read(name: str, value: object) -> object:
        if not ((isinstance(value, str) and value in words) or (value is None and default is None)):
            raise JobError(f"`{name}` {shown(value)} is unknown", remedy=f"Use one of {', '.join(words)}.")
        return value

    return Option(default, read, help, kind="word", words=words)


def flag(help: str) -> Flag:  # noqa: A002 - as in Option
    """An option that is given or not."""

    def read(name: str, value: object) -> bool:
        if not isinstance(value, bool):
            raise JobError(f"`{name}` {shown(value)} cannot be", remedy="Use True or False.")
        return value

    return Option(False, read, help, kind="flag")


def read_text(name: str, value: object) -> str:
    """Read a name, or the path of a file. Raises JobError."""
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if not isinstance(value, str):
        raise JobError(f"`{name}` {shown(value)} cannot be", remedy="Give a name, or the path of a TOML file.")
    return value


def read_angle(name: str, value: Any) -> float:
    """Read an angle; degrees. Raises JobError."""
    if not (is_number(value) and abs(value) <= sys.float_info.max):  # which math.isfinite refuses to say of 10**400
        raise JobError(f"`{name}` {shown(value)} cannot be", remedy="Give a finite number of degrees.")
    return float(value)


def read_colour(name: str, value: object) -> int | None:
    """Read the number of a colour. Raises JobError."""
    if value is not None and (isinstance(value, bool) or not isinstance(value, Integral)):
        raise JobError(f"`{name}` {shown(value)} cannot be", remedy="Give the number of a colour, from 0.")
    return None if value is None else int(value)


def read_colours(name: str, value: object, schemes: Sequence[str] = SCHEMES) -> str | int:
    """Read what colours tiles have: a number of them, or one of some words, the first for none. Raises JobError."""
    if isinstance(value, str) and value.isascii() and value.isdigit() and len(value) < 5:
        value = int(value)
    if not isinstance(value, bool) and isinstance(value, Integral) and 1 <= int(value) <= COLOURS_MAX:
        return int(value)
    if not (isinstance(value, str) and value in schemes):
        raise JobError(
            f"`{name}` {shown(value)} is unknown",
            remedy=f"Use a number up to {COLOURS_MAX}, or one of {', '.join(schemes[1:])}.",
        )
    return value


def read_count(name: str, value: object) -> int | None:
    """Read how many pieces there shall be. Raises JobError."""
    if isinstance(value, str) and value.isascii() and value.isdigit() and len(value) < 9:
        value = int(value)
    if value is None:
        return None
    if not isinstance(value, bool) and isinstance(value, Integral) and 1 <= int(value) <= COUNT_MAX:
        return int(value)
    raise JobError(f"`{name}` {shown(value)} cannot be", remedy=f"Give a whole number from 1 to {COUNT_MAX:,}.")


def read_sheet(name: str, value: Any) -> tuple[float, float] | str | None:
    """Read a sheet: two numbers, the text of a size, or the name of a drawing. Raises JobError."""
    remedy = 'Give two numbers of millimetres, "600x300mm", or the name of an SVG or DXF file.'
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
        if isinstance(value, str):
            return value
    if value is None or (isinstance(value, str) and value.lower().endswith((".svg", ".svgz", ".dxf"))):
        return value
    try:
        width, height = parse_size(value) if isinstance(value, str) else value
    except DesignError as error:
        raise JobError(f"`{name}`: {error.message}", remedy=remedy) from error
    except (TypeError, ValueError) as error:
        raise JobError(f"`{name}` {shown(value)} cannot be", remedy=remedy) from error
    width, height = read_number(name, width), read_number(name, height)
    if not (SHEET_MIN <= width <= SHEET_MAX and SHEET_MIN <= height <= SHEET_MAX):
        raise JobError(
            f"`{name}`: {width:g} x {height:g} mm cannot be",
            remedy=f"Give a size such as 600x300mm, with sides from {SHEET_MIN:g} to {SHEET_MAX:,.0f} mm.",
        )
    return width, height


def read_size(name: str, value: Any) -> tuple[float, float] | None:
    """Read the size of a sheet, and no drawing. Raises JobError."""
    size = read_sheet(name, value)
    if isinstance(size, str):
        raise JobError(f"`{name}` {shown(size)} is no size", remedy="Give a size such as 600x300mm.")
    return size


def read_layout(name: str, value: object) -> str:
    """Read how pieces are laid: a word, or the name of a file that has their places. Raises JobError."""
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str) and (value in LAYOUTS or value.lower().endswith(LAID)):
        return value
    raise JobError(
        f"`{name}` {shown(value)} is unknown", remedy=f"Use one of {', '.join(LAYOUTS)}, or name a file of pieces."
    )


def read_effort(name: str, value: Any) -> float:
    """Read how long places are looked for; seconds. Raises JobError."""
    try:
        seconds = float(value) if isinstance(value, str) or is_number(value) else math.nan
    except (ValueError, OverflowError):
        seconds = math.nan
    if not 1.0 <= seconds <= EFFORT_MAX:
        raise JobError(f"`{name}` {shown(value)} cannot be", remedy=f"Give seconds, from 1 to {EFFORT_MAX:,.0f}.")
    return seconds


def read_seed(name: str, value: Any) -> int:
    """Read the seed of a search. Raises JobError."""
    if isinstance(value, str) and value.isascii() and value.isdigit() and len(value) < 10:
        value = int(value)
    if not isinstance(value, bool) and isinstance(value, Integral) and 0 <= int(value) < 2**31:
        return int(value)
    raise JobError(f"`{name}` {shown(value)} cannot be", remedy=f"Give a whole number below {2**31:,}, 0 or more.")


def read_rates(name: str, value: Any) -> str | None:
    """Read what drives a laser, a number for cuts or numbers by the kind of work; a text. Raises JobError."""
    if value is None:
        return None
    try:
        # Not repr, which says of numpy's numbers what they are.
        text = ",".join(f"{role}={rate}" for role, rate in value.items()) if isinstance(value, Mapping) else str(value)
        rates_of(text)
    except ValueError as error:
        why = f": {error.message}" if isinstance(error, DesignError) else ""
        raise JobError(
            f"`{name}` {shown(value)} cannot be{why}",
            remedy=f"Give a number for cuts, 300, or several, cut=300,engrave=3000, of {', '.join(ROLES)}.",
        ) from error
    return text


def read_quantities(name: str, value: Any) -> int | tuple[tuple[str, int], ...] | None:
    """Read how many pieces there shall be of every site, or of some, by their names. Raises JobError."""
    if value is None:
        return None
    asked: int | tuple[tuple[str, int], ...] = 0
    with suppress(TypeError, ValueError):
        asked = _quantities(value)
    if not asked:
        raise JobError(
            f"`{name}` {shown(value)} cannot be",
            remedy=f"Give a number for every site, 40, or for some, bird=40,moth=12, up to {COUNT_MAX:,}.",
        )
    return asked


def _quantities(value: Any) -> int | tuple[tuple[str, int], ...]:
    """A number for all, or names with numbers, of a text, a mapping or pairs. Raises TypeError, ValueError."""
    if isinstance(value, Integral) or (isinstance(value, str) and "=" not in value):
        return _quantity(value)
    rows = _named(value) if isinstance(value, str) else value.items() if isinstance(value, Mapping) else value
    asked = {str(site): _quantity(count) for site, count in rows}
    if len(asked) < len(rows) or "" in asked or not any(asked.values()):
        raise ValueError
    return tuple(asked.items())


def _named(text: str) -> list[tuple[str, str]]:
    """The names and numbers of a text; names may hold the signs that part them. Raises ValueError."""
    rows, begun = [], ""
    for part in text.split(","):
        site, _, count = (begun + part).rpartition("=")
        begun = "" if count.strip().isdigit() else f"{begun}{part},"
        if not begun:
            rows.append((site.strip(), count))
    if begun:
        raise ValueError
    return rows


def _quantity(value: object) -> int:
    """A number of pieces, also none. Raises ValueError."""
    if isinstance(value, str) and value.isascii() and value.strip().isdigit() and len(value) < 9:
        value = int(value)
    if isinstance(value, bool) or not isinstance(value, Integral) or not 0 <= int(value) <= COUNT_MAX:
        raise ValueError
    return int(value)


def read_offset(name: str, value: Any) -> complex | None:
    """Read an offset: a complex number, two lengths, or a text of two, "3mm,-2mm". Raises JobError."""
    if value is None:
        return None
    if isinstance(value, complex):
        value = (value.real, value.imag)
    elif is_number(value):
        value = (value, 0.0)
    try:
        x, y = value.split(",") if isinstance(value, str) else value
    except (TypeError, ValueError, AttributeError) as error:
        raise JobError(f"`{name}` {shown(value)} cannot be", remedy="Give two lengths, such as 3mm,-2mm.") from error
    place = complex(read_number(name, x), read_number(name, y))
    if not abs(place) <= SHEET_MAX:
        raise JobError(f"`{name}` {shown(value)} is not a number, or too large", remedy="Give finite numbers.")
    return place


def read_number(name: str, value: Any) -> float:
    """Read a length, or an angle, that is a number or a text. Raises JobError."""
    remedy = 'Give a number of millimetres, or a text: "0.15mm".'
    try:
        if isinstance(value, str):
            return parse_length(value)
        if is_number(value):
            return float(value)
    except (DesignError, OverflowError) as error:
        raise JobError(f"`{name}` {shown(value)} cannot be", remedy=remedy) from error
    raise JobError(f"`{name}` {shown(value)} cannot be", remedy=remedy)
