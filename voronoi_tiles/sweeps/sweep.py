"""A sweep: a design, how its numbers vary, and which of its variants are kept."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final, NamedTuple, Self

import numpy as np

from voronoi_tiles.base import values
from voronoi_tiles.base.arguments import path_name
from voronoi_tiles.base.documents import parse_document, read_document
from voronoi_tiles.base.errors import ArgumentError, DesignError
from voronoi_tiles.base.text import counted
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.parameters import Parameter, chosen_parameters, is_free, values_of, with_values
from voronoi_tiles.designs.starters import GROUP_NAMES, starter
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.groups.wallpaper import GROUPS, WallpaperGroup
from voronoi_tiles.sweeps.design_figures import figure_names
from voronoi_tiles.sweeps.expression import Column, evaluate
from voronoi_tiles.sweeps.variation import Choices, Variation, read_groups, read_variation

COUNT_MAX: Final = 1_000_000
"""Most designs of a sweep; a count."""

KEEP: Final = 24
"""How many designs are kept where nobody says; a count."""

KEEP_MAX: Final = 1_000
"""Most designs that are kept; a count."""

_SEED_MAX: Final = 2**63 - 1

_JOB: Final = (
    "sheet",
    "margin",
    "fit",
    "frame",
    "rotate",
    "offset",
    "edges",
    "gap",
    "kerf",
    "fillet",
    "tabs",
)
"""The options of a job that say how many pieces there are and how long cuts are, and that take no search for places."""

_KEYS: Final = ("schema", "design", "vary", "count", "seed", "job", "filter", "sort", "keep")

_DESIGN: Final = 'Write design = "bird.toml", the name of a group for its starter, or a table [design].'


class Varied(NamedTuple):
    """A number of the design and how it varies; `own` is its value in the design."""

    parameter: Parameter
    variation: Variation
    own: float


@dataclass(frozen=True, init=False, eq=False, repr=False)
class Sweep:
    """A design and how its numbers vary, checked.

    `vary` maps numbers of the design, by their places in its file as in `Tiling.shape_gradient`, and "group", to how
    they vary: a list of values; {"from": 40, "to": 80}; {"around": 2} or {"deviation": 2}, evenly or normally about the
    value that the design has. A name of several numbers, "site[0].strokes[0]", is all of them, each by itself. With a
    `count` there are so many designs at random, the same for the same `seed`, and each the same whatever their number;
    without one there are all combinations of values and of "steps", the last name's the fastest.

    `job` is a mapping of options of `Job` with a sheet, on which pieces and cuts are counted. `filter` and `sort` are
    expressions over the columns of the table: which designs are kept, `keep` at most, and in what order; "-area" begins
    with the largest. `len()` is the number of designs. Raises DesignError, which names the key.

    >>> import voronoi_tiles as vt
    >>> sweep = vt.Sweep(vt.starter("p4"), {"site[0].strokes[0]": {"deviation": 2}}, count=100, seed=7)
    >>> sweep
    <Sweep of 'p4': 100 designs at random, 8 numbers vary>
    >>> sweep.variant(3)
    <Design 'p4-000003': p4, 1 site (bird)>
    """

    design: Design
    vary: Mapping[str, Any]
    count: int | None
    seed: int
    job: Mapping[str, Any]
    filter: str
    sort: tuple[str, ...]
    keep: int
    _numbers: tuple[Varied, ...]
    _groups: Choices | None

    def __init__(
        self,
        design: Design,
        vary: Mapping[str, Any],
        *,
        count: int | None = None,
        seed: int = 0,
        job: Mapping[str, Any] | None = None,
        filter: str = "",  # noqa: A002 - the key of the file
        sort: str | Sequence[str] = (),
        keep: int = KEEP,
    ) -> None:
        if not isinstance(design, Design):
            raise DesignError(f"must be a design, not {values.shown(design)}", key="design", remedy=_DESIGN)
        if count is not None:
            count = _whole("count", count, 1, COUNT_MAX)
        groups, numbers = _read_vary(design, vary)
        given = {
            "design": design,
            "vary": _plain(dict(vary)),
            "count": count,
            "seed": _whole("seed", seed, 0, _SEED_MAX),
            "job": _read_job(job),
            "filter": _text("filter", filter),
            "sort": _read_sort(sort),
            "keep": _whole("keep", keep, 0, KEEP_MAX),
            "_numbers": numbers,
            "_groups": groups,
        }
        for name, value in given.items():
            object.__setattr__(self, name, value)
        if len(self) > COUNT_MAX:
            remedy = f"Take fewer, or a `count` of random ones; {COUNT_MAX:,} are the most."
            raise DesignError(f"the values make {len(self):,} designs", key="vary", remedy=remedy)
        self._check_expressions()

    def __repr__(self) -> str:
        how = "in a grid" if self.count is None else "at random"
        vary = f"{counted(len(self._numbers), 'number')} {'varies' if len(self._numbers) == 1 else 'vary'}"
        groups = "" if self._groups is None else f", {counted(len(self._groups.values), 'group')}"
        return f"<Sweep of {self.design.name!r}: {counted(len(self), 'design')} {how}, {vary}{groups}>"

    def __len__(self) -> int:
        return math.prod(self._sizes) if self.count is None else self.count

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a sweep file, TOML or JSON by its suffix; a design that it names lies beside it. Raises DesignError."""
        file = path_name("path", path)
        shown = "standard input" if file == "-" else file or repr(file)
        try:
            text = read_document(file, "sweep", missing="Check the path and its permissions.")
            form = "json" if text.lstrip()[:1] == "{" else "toml"
            table = parse_document(text, form, remedy="docs/sweeps.md has sweeps to start from.")
        except DesignError as error:
            raise error.with_file(shown) from None
        return cls.from_dict(table, file=shown, folder=Path(file).parent if file != "-" else "")

    @classmethod
    def from_dict(
        cls, mapping: Mapping[str, Any], *, file: str | None = None, folder: str | os.PathLike[str] = ""
    ) -> Self:
        """Read a sweep from nested mappings, as TOML and JSON give them. Raises DesignError."""
        try:
            table = values.table(mapping, _KEYS, "docs/sweeps.md has sweeps to start from.")
            _require_schema(table.get("schema", 1))
            named = values.required(table, "design", _DESIGN)
            vary = values.required(
                table, "vary", 'Write [vary], and below it numbers: "cell.a" = { from = 40, to = 80 }.'
            )
            rest = {name: table[name] for name in ("count", "seed", "job", "filter", "sort", "keep") if name in table}
            return cls(_read_design(named, os.fspath(folder)), vary, **rest)
        except DesignError as error:
            raise error.with_file(file) from None

    def replaced(self, **arguments: Any) -> Self:
        """The sweep with some of its arguments changed, checked again; those that are None stay. Raises DesignError."""
        names = ("count", "seed", "job", "filter", "sort", "keep")
        given = {name: getattr(self, name) for name in names}
        given |= {name: value for name, value in arguments.items() if value is not None}
        return type(self)(self.design, self.vary, **given)

    @property
    def varied(self) -> tuple[str, ...]:
        """The names of all numbers that vary, as the table has them."""
        return tuple(str(each.parameter) for each in self._numbers)

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the columns of its table."""
        return ("number", "group", *self.varied, *figure_names(len(self.design.noded), job=bool(self.job)), "error")

    @cached_property
    def identity(self) -> dict[str, Any]:
        """What its designs and their figures depend on, in the types of JSON."""
        found = {"design": json.loads(self.design.source), "vary": [[name, self.vary[name]] for name in self.vary]}
        return found | {"job": dict(self.job)} | ({} if self.count is None else {"seed": self.seed})

    @classmethod
    def of_identity(cls, identity: Mapping[str, Any], count: int) -> Self:
        """The sweep of an identity, as far as its designs go."""
        design = Design.from_dict(identity["design"])
        number = count if "seed" in identity else None
        return cls(design, dict(identity["vary"]), count=number, seed=identity.get("seed", 0), job=identity["job"])

    def values(self, number: int) -> tuple[WallpaperGroup, list[Any]]:
        """The group of a design, and the values of all varying numbers; None where its group leaves one no freedom."""
        group = self.design.group
        drawn: list[Any] = []
        if self.count is None:
            rest = number
            for size, steps in zip(reversed(self._sizes), reversed(self._steps), strict=True):
                rest, place = divmod(rest, size)
                drawn.insert(0, steps[place])
        else:
            random = np.random.default_rng([self.seed, number])
            drawn = [variation.drawn(own, random) for variation, own in self._ways]
        if self._groups is not None:
            group = GROUPS[drawn.pop(0)]
        pairs = zip(self._numbers, drawn, strict=True)
        return group, [value if is_free(each.parameter, group) else None for each, value in pairs]

    def variant(self, number: int) -> Design:
        """One of its designs, by its number from 0. Raises DesignError for a variant that can be no design."""
        if not (type(number) is int and 0 <= number < len(self)):
            raise ArgumentError(
                f"`number` {values.shown(number)} cannot be", remedy=f"Designs are 0 to {len(self) - 1}."
            )
        group, found = self.values(number)
        chosen = [
            (each.parameter, value) for each, value in zip(self._numbers, found, strict=True) if value is not None
        ]
        made = with_values(self.design, [one for one, _ in chosen], [value for _, value in chosen], group)
        return made.replace(name=f"{self.design.name}-{number:06d}")

    @cached_property
    def made_job(self) -> Job | None:
        """The job that pieces and cuts are counted of, None where there is none."""
        return Job(**self.job, art="none") if self.job else None

    @property
    def _ways(self) -> list[tuple[Variation, float]]:
        """How the group varies, where it does, and all numbers, in the order in which they are drawn."""
        group: list[tuple[Variation, float]] = [] if self._groups is None else [(self._groups, 0.0)]
        return group + [(each.variation, each.own) for each in self._numbers]

    @cached_property
    def _steps(self) -> list[tuple[Any, ...]]:
        """The values of each in a grid. Raises DesignError where one has none."""
        found = [] if self._groups is None else [self._groups.values]
        for each in self._numbers:
            with values.within(f"vary.{each.parameter}"):
                found.append(each.variation.steps(each.own))
        return found

    @cached_property
    def _sizes(self) -> list[int]:
        """How many they are."""
        return [len(steps) for steps in self._steps]

    def _check_expressions(self) -> None:
        """Refuse expressions that cannot be, on a table without rows. Raises DesignError."""
        none: dict[str, Column] = {}
        for name in self.columns:
            text = name in ("group", "error")
            none[name] = Column("text", np.zeros(0, str)) if text else Column("number", np.zeros(0))
        if self.filter:
            with values.within("filter"):
                kind = evaluate(self.filter, none).kind
                if kind != "truth":
                    raise DesignError(f"is a {kind}, not a condition", remedy="Write one, such as neck > 3.")
        with values.within("sort"):
            for each in self.sort:
                evaluate(each, none)


def _require_schema(version: object) -> None:
    """Raise DesignError for a version of the format that is not known."""
    if type(version) is not int or version != 1:
        raise DesignError(f"schema {values.shown(version)} is not supported", key="schema", remedy="Write schema = 1.")


def _read_vary(design: Design, vary: object) -> tuple[Choices | None, tuple[Varied, ...]]:
    """Read what varies, and how: the groups, and numbers, each once. Raises DesignError."""
    remedy = 'Write [vary], and below it numbers: "cell.a" = { from = 40, to = 80 }.'
    if not isinstance(vary, Mapping) or not vary:
        raise DesignError("must be a table of numbers that vary", key="vary", remedy=remedy)
    groups: Choices | None = None
    found: dict[Parameter, Varied] = {}
    for name, way in vary.items():
        key = f"vary.{name}"
        with values.within(key):
            if name == "group":
                groups = read_groups(way)
                continue
            variation = read_variation(way)
            parameters = _named(design, name)
        for parameter, own in zip(parameters, values_of(design, parameters), strict=True):
            if parameter in found:
                raise DesignError(f"{parameter} varies already", key=key, remedy="Name each number once.")
            found[parameter] = Varied(parameter, variation, own)
    if groups is not None and next(iter(vary)) != "group":
        # What is drawn first depends on nothing that is named later.
        raise DesignError("comes first", key="vary.group", remedy="Write it above the other numbers.")
    return groups, tuple(found.values())


def _named(design: Design, name: str) -> list[Parameter]:
    """The numbers of a name. Raises DesignError where there are none."""
    try:
        return chosen_parameters(design, [name])
    except ArgumentError as error:
        raise DesignError("is no number of the design", remedy=error.remedy) from None


def _read_design(named: object, folder: str) -> Design:
    """The design of a sweep file: a table, a file beside it, or the name of a group for its starter."""
    with values.within("design"):
        if isinstance(named, Mapping):
            return Design.from_dict(named, folder=folder)
        name = values.file_name(named, _DESIGN)
        if name in GROUP_NAMES:
            return starter(name)
        return Design.load(os.path.join(folder, name))  # noqa: PTH118 - any name


def _read_job(job: object) -> Mapping[str, Any]:
    """Read the options of a job, {} for none. Raises DesignError."""
    if job is None:
        return {}
    remedy = 'Write [job] and, below it, sheet = "600x300mm".'
    with values.within("job"):
        table = dict(values.table(job, _JOB, remedy))
        if not table:
            return {}
        sheet = values.required(table, "sheet", remedy)
        try:
            made = Job(**table)
        except ArgumentError as error:
            raise DesignError(error.message, remedy=error.remedy) from None
        except TypeError:
            raise DesignError("has a value of another type than its option takes", remedy=remedy) from None
        if not isinstance(made.sheet, tuple):
            raise DesignError(f"{values.shown(sheet)} is no size", key="sheet", remedy='Write sheet = "600x300mm".')
    return _plain(table)


def _read_sort(sort: object) -> tuple[str, ...]:
    """Read one expression or several."""
    with values.within("sort"):
        listed = [sort] if isinstance(sort, str) else values.sequence(sort, 'Write one, "-area", or several.')
    return tuple(_text("sort", each) for each in listed)


def _plain(table: dict[str, Any]) -> dict[str, Any]:
    """A table in the types of JSON: other numbers, and arrays, become Python's."""
    text = json.dumps(table, default=lambda each: each.tolist() if hasattr(each, "tolist") else float(each))
    return dict(json.loads(text))


def _whole(key: str, value: object, least: int, most: int) -> int:
    """Read a whole number."""
    if type(value) is not int or not least <= value <= most:
        raise DesignError(
            f"must be a whole number from {least} to {most:,}, not {values.shown(value)}",
            key=key,
            remedy=f"Write {key} = {max(least, 10)}.",
        )
    return value


def _text(key: str, value: object) -> str:
    """Read an expression's text."""
    with values.within(key):
        return values.text(value, 'Write an expression, such as "neck > 3".').strip()
