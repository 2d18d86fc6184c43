"""What the page sends, read and checked: whatever comes is a message that can be done, or one error for people.

A message is JSON text of at most MESSAGE_MAX bytes, an object with a "type". A design is checked here only as far as it
keeps the server safe: its size, and that it names no file outside its folder. Whether it can be used is found where it
is used, in a worker.
"""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from voronoi_tiles.base.errors import ArgumentError, DesignError
from voronoi_tiles.base.values import is_number, shown
from voronoi_tiles.fabrication.job_options import LAID

MESSAGE_MAX: Final = 1 << 20
"""Largest message and largest body of a request; bytes. A design of a thousand strokes has a tenth of it."""

DROP_MAX: Final = 16 << 20
"""Largest file that is dropped onto the page; bytes. Some five seconds' work, of which the page waits for the end."""

STROKES_MAX: Final = 2_000
"""Most strokes of a design in the studio; a count."""

POINTS_MAX: Final = 20_000
"""Most points of a design in the studio; a count. Such a design takes seconds."""

SECONDS_MAX: Final = 10
"""For how long a worker may work at one thing; seconds."""

FIT_SECONDS_MAX: Final = 300
"""For how long one may look for designs that fit an outline; seconds. All groups take some 45 s of a processor."""

LIMITS: Final = {
    "message": MESSAGE_MAX,
    "drop": DROP_MAX,
    "strokes": STROKES_MAX,
    "points": POINTS_MAX,
    "seconds": SECONDS_MAX,
}
"""What the page is told of them."""

DEPTH_MAX: Final = 16
"""How deeply messages are nested at most; a count. A point of a stroke of a site of a design is the eighth level."""

FILES_MAX: Final = 200
"""Most files that a design names, beside those that it had on disk; a count."""

_NAME_MAX: Final = 1_000
"""Longest name of a file; characters. Each folder on the way is looked at."""

_DIGITS_MAX: Final = 25
_REVISION_MAX: Final = 2**53
_NUMBERS: Final = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)")

Table = Mapping[str, Any]


@dataclass(frozen=True)
class DesignMessage:
    """A design to be shown: at rest proved, in its full tolerance; else flattened within `tolerance`, where given.

    `tolerance` is in the coordinates of the drawing, before the design's scale.
    """

    rev: int
    design: Table
    rest: bool
    tolerance: float | None


@dataclass(frozen=True)
class JobMessage:
    """A job to be reported of: the options of a Job by their names, and what a preflight measures against."""

    rev: int
    design: Table
    job: Table
    limits: Table


@dataclass(frozen=True)
class SolidMessage:
    """A design to be shown as solids: the options of a SolidJob by their names."""

    rev: int
    design: Table
    job: Table


@dataclass(frozen=True)
class ThumbnailMessage:
    """A design to be shown as a small picture, as soon as nothing else is to be done."""

    rev: int
    design: Table


@dataclass(frozen=True)
class SaveMessage:
    """A design to be saved; with `over` also where the file was changed by others."""

    rev: int
    design: Table
    over: bool


@dataclass(frozen=True)
class ReloadMessage:
    """The design's file to be read again."""


@dataclass(frozen=True)
class NewMessage:
    """A new design to be begun, in a file of this name beside that of the design, which is kept as it is drawn."""

    rev: int
    design: Table
    name: str


@dataclass(frozen=True)
class ByeMessage:
    """The page is closing."""


_KEYS: Final[Mapping[str, tuple[str, ...]]] = {
    "design": ("rev", "design", "rest", "tolerance"),
    "job": ("rev", "design", "job", "limits"),
    "solid": ("rev", "design", "job"),
    "thumbnail": ("rev", "design"),
    "save": ("rev", "design", "over"),
    "reload": (),
    "new": ("rev", "design", "name"),
    "bye": (),
}
"""The types of messages, and the keys that each has beside its type."""

Message = (
    DesignMessage | JobMessage | SolidMessage | ThumbnailMessage | SaveMessage | ReloadMessage | NewMessage | ByeMessage
)


def read_object(text: str | bytes) -> Table:
    """Read an object of JSON: numbers are finite, texts can be written, and little is nested.

    Raises ArgumentError for what is none.
    """
    try:
        value = json.loads(text, parse_constant=_finite, parse_float=_finite, parse_int=_whole)
        _check_plain(value, DEPTH_MAX)
    except RecursionError:
        raise _broken("a message is nested too deeply") from None
    except ValueError as error:
        raise _broken(f"a message is no JSON: {str(error)[:200]}") from None
    if not isinstance(value, Mapping):
        raise _broken(f"a message must be an object, not {shown(value)}")
    return value


def read_message(table: Table) -> Message:
    """The message that an object is. Raises ArgumentError for what is none, DesignError for too large a design."""
    kind = table.get("type")
    keys = _KEYS.get(kind) if isinstance(kind, str) else None
    if keys is None:
        raise _broken(f"a message has the unknown type {shown(kind)}")
    refuse_others(table, ("type", *keys))
    if not keys:
        return ReloadMessage() if kind == "reload" else ByeMessage()
    rev, design = _rev(table), read_design(table)
    found: Message
    match kind:
        case "design":
            found = DesignMessage(rev, design, _flag(table, "rest", default=True), _tolerance(table))
        case "job":
            found = JobMessage(rev, design, read_job(table), _table(table, "limits"))
        case "solid":
            found = SolidMessage(rev, design, read_job(table))
        case "thumbnail":
            found = ThumbnailMessage(rev, design)
        case "new":
            found = NewMessage(rev, design, read_text(table, "name", ""))
        case _:
            found = SaveMessage(rev, design, _flag(table, "over", default=False))
    return found


def refuse_others(table: Table, known: Collection[str]) -> None:
    """Refuse an object that has other than the known keys. Raises ArgumentError."""
    for name in table:
        if name not in known:
            raise _broken(f"a message has the unknown key {shown(name)}")


def read_design(table: Table) -> Table:
    """The design of a message, not too large. Raises ArgumentError, DesignError."""
    design = table.get("design")
    if not isinstance(design, Mapping):
        raise _broken(f"a design must be an object, not {shown(design)}")
    _check_size(design)
    return design


def read_job(table: Table) -> Table:
    """The options of a job: texts, numbers and flags by name, pairs of numbers. Raises ArgumentError."""
    job = _table(table, "job")
    for name, value in job.items():
        simple = isinstance(value, str | bool) or is_number(value)
        pair = isinstance(value, list) and len(value) == 2 and all(map(is_number, value))
        if not (value is None or simple or pair):
            raise ArgumentError(
                f"the option {shown(name)} cannot be {shown(value)}", remedy="Give a number, a text, true or false."
            )
    return {name: value for name, value in job.items() if value is not None}


def read_text(table: Table, name: str, default: str) -> str:
    """A text of a message that may be left out. Raises ArgumentError."""
    value = table.get(name, default)
    if not isinstance(value, str):
        raise _broken(f"`{name}` must be a text, not {shown(value)}")
    return value


def check_files(design: Table, job: Table, folder: str, own: Collection[str]) -> None:
    """Refuse a design and a job that name files outside the folder, but for those of its `own` that it had on disk.

    Raises DesignError, which names the key.
    """
    named: dict[str, str] = {}
    for key, name in (*_named_files(design), *_files_of_job(job)):
        if name not in own:
            named.setdefault(name, key)
    if len(named) > FILES_MAX:
        raise DesignError(
            f"the design names {len(named):,} files, and the studio takes {FILES_MAX:,}",
            key="site",
            remedy="Draw several things into one file.",
        )
    home = os.path.realpath(folder)
    for name, key in named.items():
        if len(name) > _NAME_MAX:
            raise DesignError(
                f"the name {shown(name)} of a file is too long", key=key, remedy="Give the file a shorter one."
            )
        if not _is_inside(name, home):
            raise DesignError(
                f"the file {shown(name)} is outside the design's folder",
                key=key,
                remedy="Lay it beside the design, and name it as seen from there.",
            )


def named_files(design: Table) -> frozenset[str]:
    """The files that a design names."""
    return frozenset(name for _, name in _named_files(design))


def _finite(text: str) -> float:
    """The number of a text. Raises ValueError where it is none, or too large."""
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text[:20]} is no number")
    return value


def _whole(text: str) -> int:
    """The whole number of a text. Raises ValueError where it is too long for one."""
    if len(text) > _DIGITS_MAX:
        raise ValueError(f"{text[:20]}... has too many digits")
    return int(text)


def _check_plain(value: object, depth: int) -> None:
    """Raise RecursionError for what is nested deeper, ValueError for texts that no file can hold: halves of pairs."""
    if isinstance(value, str):
        value.encode()
    elif isinstance(value, list | dict):
        if not depth:
            raise RecursionError
        for item in (*value, *value.values()) if isinstance(value, dict) else value:
            _check_plain(item, depth - 1)


def _broken(message: str) -> ArgumentError:
    """The error for what no page of ours sends."""
    return ArgumentError(message, remedy="Load the page again; if that does not help, please report it.")


def _rev(table: Table) -> int:
    rev = table.get("rev")
    if isinstance(rev, bool) or not isinstance(rev, int) or not 0 <= rev <= _REVISION_MAX:
        raise _broken(f"the revision of a message cannot be {shown(rev)}")
    return rev


def _flag(table: Table, name: str, *, default: bool) -> bool:
    value = table.get(name, default)
    if not isinstance(value, bool):
        raise _broken(f"`{name}` must be true or false, not {shown(value)}")
    return value


def _table(table: Table, name: str) -> Table:
    value = table.get(name)
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise _broken(f"`{name}` must be an object, not {shown(value)}")
    return value


def _tolerance(table: Table) -> float | None:
    value = table.get("tolerance")
    if value is None:
        return None
    if not (is_number(value) and 0.0 < value < float("inf")):
        raise _broken(f"a tolerance cannot be {shown(value)}")
    return float(value)


def _check_size(design: Table) -> None:
    """Refuse designs that would take too long. Raises DesignError."""
    strokes = [stroke for _, site in _drawings(design) for _, stroke in _numbered(site, "strokes")]
    points = sum(_count_points(value) for stroke in strokes for value in stroke.values())
    for count, most, what in ((len(strokes), STROKES_MAX, "strokes"), (points, POINTS_MAX, "points")):
        if count > most:
            raise DesignError(
                f"the design has {count:,} {what}, and the studio takes {most:,}",
                key="site",
                remedy="Draw less here; voronoi-tiles export takes designs of any size.",
            )


def _count_points(value: object) -> int:
    """How many points a value of a stroke holds: pairs of numbers, also those of path data."""
    if isinstance(value, str):
        return sum(1 for _ in _NUMBERS.finditer(value)) // 2
    if isinstance(value, list):
        return sum(map(_count_points, value)) or (len(value) + 1) // 2
    return 0


def _numbered(table: Table, name: str) -> list[tuple[int, Table]]:
    """The tables in the array of a key, each with its number, and nothing else that may be there."""
    value = table.get(name)
    items = enumerate(value) if isinstance(value, list) else ()
    return [(number, item) for number, item in items if isinstance(item, Mapping)]


def _drawings(design: Table) -> list[tuple[str, Table]]:
    """The tables that have strokes, sites and keys of a solid, each after its key."""
    return [(f"{key}[{k}]", table) for key in ("site", "key") for k, table in _numbered(design, key)]


def _named_files(design: Table) -> Iterator[tuple[str, str]]:
    """The files that strokes and art name, each after its key."""
    for place, site in _drawings(design):
        art = site.get("art")
        named = [(f"strokes[{i}].file", stroke.get("file")) for i, stroke in _numbered(site, "strokes")]
        for key, name in (*named, ("art.file", art.get("file") if isinstance(art, Mapping) else art)):
            if isinstance(name, str):
                yield f"{place}.{key}", name


def _files_of_job(job: Table) -> Iterator[tuple[str, str]]:
    """The files that a job names: the drawing of a sheet, a preset, and one that has places of pieces."""
    for key, suffixes in (("sheet", (".svg", ".svgz", ".dxf")), ("preset", (".toml",)), ("layout", LAID)):
        name = job.get(key)
        if isinstance(name, str) and name.lower().endswith(suffixes):
            yield key, name


def _is_inside(name: str, home: str) -> bool:
    """Whether a name, as seen from a folder, which is no link, leads to what is in it, links and all."""
    if "\0" in name or os.path.isabs(name):  # noqa: PTH117 - any name
        return False
    try:
        return Path(os.path.realpath(os.path.join(home, name))).is_relative_to(home)  # noqa: PTH118 - same
    except (OSError, ValueError):
        return False
