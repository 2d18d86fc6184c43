"""Fabrication presets: colours, line widths, layers and curves, as the programs of cutters take them.

They stand in presets.toml; a user's own is a TOML file with the same keys, those that it leaves out taken from the
preset that it extends. A preset says nothing of the design: the same design goes to any target.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final, Literal, NamedTuple, TypeVar, cast, get_args

from voronoi_tiles.base.documents import parse_document, read_document
from voronoi_tiles.base.errors import ArgumentError, DesignError
from voronoi_tiles.base.values import each, flag, number, shown, suggestion, table, within
from voronoi_tiles.formats.burns import ROLES, Burn, Role, rate, rates_of

Format = Literal["svg", "dxf", "pdf", "lbrn2", "gcode"]
_Value = TypeVar("_Value")

SvgCurves = Literal["exact", "arc", "cubic", "polyline"]
DxfCurves = Literal["arc", "spline", "polyline"]
DxfVersion = Literal["R2000", "R12"]
ContourUse = Literal["shared", "closed", "apart"]

FORMATS: Final[tuple[Format, ...]] = get_args(Format)
DEFAULT: Final = "plain"
R12: Final = "R12"

SUFFIXES: Final[Mapping[str, Format]] = {"nc": "gcode"}
"""Other suffixes that files of a format have."""

_EXAMPLES: Final[Mapping[str, Mapping[Role, int]]] = {
    "feed": {"cut": 300, "inner": 300, "score": 1500, "engrave": 3000},
    "power": {"cut": 800, "inner": 800, "score": 300, "engrave": 150},
}
"""What feeds and powers may look like."""

_KEYS: Final = (
    "title",
    "colours",
    "stroke",
    "stroke_kerf",
    "layers",
    "dxf_layers",
    "curves",
    "spline_edges",
    "contours",
    "solid",
    "unread",
    "misread",
    "fill_engraving",
    "feed",
    "power",
    "power_max",
)
_TABLES: Final = ("colours", "layers", "dxf_layers", "curves", "feed", "power")
_STROKE_MAX: Final = 10.0  # a line of more millimetres hides what it draws


class DxfStyle(NamedTuple):
    """How DXF files are written: their version, and whether each spline is one edge, not a whole contour."""

    version: DxfVersion = "R2000"
    spline_edges: bool = False


USUAL_DXF: Final = DxfStyle()


@dataclass(frozen=True)
class Preset:
    """What a fabrication target takes; `title` says in a line which one that is.

    `colours` ("#rrggbb"), `layers` and `dxf_layers` (names) have an entry for each of ROLES: cuts around pieces, cuts
    inside them, scores, engraving. `palette` are the colours of further layers of cuts; where there are none, all have
    that of cuts. `stroke` is the width of lines in millimetres; with `stroke_kerf` a wider kerf takes its place.
    `svg_curves` and `dxf_curves` say what curves become; with `spline_edges` each spline of DXF is one edge. `contours`
    is what the target takes of pieces: "shared", also edges that are cut once; "closed" ones alone; or "apart", since
    it unites what touches. With `solid` a piece is one filled shape with its holes, where a format fills shapes.
    `unread` gives, for a format that the target does not read, the one to use instead, `misread` what of a format it
    gets wrong: curves, and R12. With `fill_engraving` the target engraves what is filled. `feed` in mm/min and `power`,
    up to `power_max`, are for files that drive a laser themselves; they have entries for those of ROLES that the preset
    knows them for.
    """

    name: str
    title: str
    colours: Mapping[Role, str]
    palette: tuple[str, ...]
    stroke: float
    stroke_kerf: bool
    layers: Mapping[Role, str]
    dxf_layers: Mapping[Role, str]
    svg_curves: SvgCurves
    dxf_curves: DxfCurves
    spline_edges: bool
    contours: ContourUse
    solid: bool
    unread: Mapping[Format, Format]
    misread: Mapping[Format, tuple[str, ...]]
    fill_engraving: bool
    feed: Mapping[Role, float]
    power: Mapping[Role, float]
    power_max: float

    @property
    def first_format(self) -> Format:
        """The first of FORMATS that the target reads."""
        return next(form for form in FORMATS if form not in self.unread)

    def stroke_width(self, kerf: float = 0.0) -> float:
        """The width of lines for a kerf; both in millimetres."""
        return max(self.stroke, kerf) if self.stroke_kerf else self.stroke

    def cut_colour(self, number: int) -> str:
        """The colour of a layer of cuts, "#rrggbb": that of the first is for all where there is no palette."""
        colours = (self.colours["cut"], *self.palette)
        if number < len(colours) or not self.palette:
            return colours[min(number, len(colours) - 1)]
        from voronoi_tiles.groups.periodic_colouring import palette

        return f"#{bytes(palette(number + 1)[number]).hex()}"

    def layer_name(self, role: Role, form: Format) -> str:
        """What a layer is called in a format."""
        return self.dxf_layers[role] if form == "dxf" else self.layers[role]

    def burns(self, roles: Collection[Role], feed: str | None, power: str | None) -> dict[Role, Burn]:
        """How a laser goes along each of `roles`, by texts that `rates_of` reads or else by the preset.

        Cuts inside are worked as those around, unless they have rates of their own. Raises ArgumentError where a rate
        of one of the roles is nowhere given, and where a power is beyond the machine's.
        """
        feeds = {**self.feed, **rates_of(feed)}
        powers = {**self.power, **rates_of(power)}
        for rates in (feeds, powers):
            if "cut" in rates:
                rates.setdefault("inner", rates["cut"])
        lacking = [role for role in dict.fromkeys(roles) if role not in feeds or role not in powers]
        if "cut" in lacking:
            lacking = [role for role in lacking if role != "inner"]
        if lacking:
            raise ArgumentError(
                f"G-code drives the laser: it needs `feed` and `power` of {' and '.join(lacking)}",
                remedy=f"Give {_example('feed', lacking)} in mm/min and {_example('power', lacking)} of the machine's "
                "$30, with your own numbers, or put them into a preset: feed = { cut = 300 }.",
            )
        for role in roles:
            if powers[role] > self.power_max:
                raise ArgumentError(
                    f"a `power` of {powers[role]:g} for {role} is more than the machine's {self.power_max:g}",
                    remedy="Give at most as much, or put the machine's setting $30 into a preset: power_max = 10000.",
                )
        return {role: Burn(feeds[role], powers[role], self.power_max) for role in roles}

    def require(self, form: Format) -> None:
        """Raise DesignError, with the format to use instead, where the target does not read this one."""
        if form in self.unread:
            raise DesignError(
                f"{self.name} does not read {form} files",
                key="preset",
                remedy=f"Write {self.unread[form]}, or take another preset.",
            )


def load_preset(name_or_path: str) -> Preset:
    """The preset of a name, or the one in a TOML file, whose path ends in .toml.

    A file has the keys of presets.toml, any of them, and `extends`, the name of the preset that has the others (without
    it, "plain"). A table in it changes only the keys that it names. Raises DesignError with file, key and remedy.
    """
    if name_or_path.lower().endswith(".toml"):
        return _load_file(name_or_path)
    return _read(name_or_path, _whole(name_or_path, "preset"))


def preset_names() -> tuple[str, ...]:
    """The names of the presets that are built in."""
    return tuple(_built_in())


@cache
def _built_in() -> dict[str, Any]:
    """The table of presets; each has the keys that differ from the one that it extends."""
    from importlib import resources

    text = resources.files("voronoi_tiles.formats").joinpath("presets.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def _whole(name: str, key: str) -> Mapping[str, Any]:
    """All keys of one preset, its own and those of the one that it extends; `key` is where its name was written."""
    presets = _built_in()
    if name in presets:
        own = cast("Mapping[str, Any]", presets[name])
        return own if name == DEFAULT else _merged(_whole(own.get("extends", DEFAULT), "extends"), own)
    listed = f"Presets are {', '.join(presets)}, or the path of a file that ends in .toml."
    raise DesignError(f"unknown preset {shown(name)}", key=key, remedy=suggestion(name, presets) + listed)


# --- a user's file ----------------------------------------------------------------------------------------------


def _load_file(path: str) -> Preset:
    """Read a user's preset."""
    try:
        remedy = 'Write extends = "lightburn" and what is different.'
        text = read_document(path, "preset", missing=f"Check the path, or take one of {', '.join(_built_in())}.")
        own = table(parse_document(text, "toml", remedy=remedy), ("extends", *_KEYS), remedy)
        base = _at("extends", _text, own.get("extends", DEFAULT))
        return _read(Path(path).stem, _merged(_whole(base, "extends"), own))
    except DesignError as error:
        raise error.with_file(path) from None


def _merged(base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    """The base with the user's keys over it; in the tables that have fixed keys, key by key."""
    merged = dict(base)
    for key, value in own.items():
        if key in _TABLES and isinstance(value, Mapping):
            value = {**merged[key], **value}  # noqa: PLW2901 - the user's part with the rest of the table
        if key != "extends":
            merged[key] = value
    return merged


def _example(name: str, roles: Collection[Role]) -> str:
    """An option with rates for some roles, as messages name it."""
    return f"`{name}='{','.join(f'{role}={_EXAMPLES[name][role]}' for role in roles)}'`"


# --- values -----------------------------------------------------------------------------------------------------


def _read(name: str, values: Mapping[str, Any]) -> Preset:
    """Check every value of a complete table."""
    colours = _table(values, "colours", (*ROLES, "palette"))
    curves = _table(values, "curves", ("svg", "dxf"))
    with within("colours"):
        palette = _palette(colours["palette"])
        chosen = {role: _at(role, _colour, colours[role]) for role in ROLES}
    with within("curves"):
        svg = _at("svg", lambda value: _choice(value, get_args(SvgCurves)), curves["svg"])
        dxf = _at("dxf", lambda value: _choice(value, get_args(DxfCurves)), curves["dxf"])
    return Preset(
        name=name,
        title=_at("title", _text, values["title"]),
        colours=chosen,
        palette=palette,
        stroke=_at("stroke", _width, values["stroke"]),
        stroke_kerf=_at("stroke_kerf", _flag, values["stroke_kerf"]),
        layers=_names(values, "layers"),
        dxf_layers=_names(values, "dxf_layers"),
        svg_curves=cast("SvgCurves", svg),
        dxf_curves=cast("DxfCurves", dxf),
        spline_edges=_at("spline_edges", _flag, values["spline_edges"]),
        contours=cast("ContourUse", _at("contours", _contours, values["contours"])),
        solid=_at("solid", _flag, values["solid"]),
        unread=_unread(values),
        misread=_misread(values),
        fill_engraving=_at("fill_engraving", _flag, values["fill_engraving"]),
        feed=_rates(values, "feed"),
        power=_rates(values, "power"),
        power_max=_at("power_max", rate, values["power_max"]),
    )


def _at(key: str, read: Callable[[object], _Value], value: object) -> _Value:
    """Read the value of a key; errors name the key."""
    with within(key):
        return read(value)


def _table(values: Mapping[str, Any], key: str, known: Collection[str]) -> Mapping[str, Any]:
    """A table of known keys."""
    with within(key):
        return table(values[key], known, f"Write a table with keys of {', '.join(known)}.")


def _names(values: Mapping[str, Any], key: str) -> dict[Role, str]:
    """The names of layers."""
    names = _table(values, key, ROLES)
    with within(key):
        return {role: _at(role, _text, names[role]) for role in ROLES}


def _rates(values: Mapping[str, Any], key: str) -> dict[Role, float]:
    """Numbers for some roles."""
    rates = _table(values, key, ROLES)
    with within(key):
        return {cast("Role", role): _at(role, rate, value) for role, value in rates.items()}


def _unread(values: Mapping[str, Any]) -> dict[Format, Format]:
    """Formats that are not read, and those to use instead, which are read."""
    unread = _table(values, "unread", FORMATS)
    with within("unread"):
        read = [form for form in FORMATS if form not in unread]
        return {
            cast("Format", form): cast("Format", _at(form, lambda value: _choice(value, read), unread[form]))
            for form in unread
        }


def _misread(values: Mapping[str, Any]) -> dict[Format, tuple[str, ...]]:
    """What of each format is read wrong."""
    misread = _table(values, "misread", FORMATS)
    with within("misread"):
        return {
            cast("Format", form): _at(form, lambda value: _array(value, _misreading, '["spline"]'), value)
            for form, value in misread.items()
        }


def _contours(value: object) -> str:
    return _choice(value, get_args(ContourUse))


def _misreading(value: object) -> str:
    return _choice(value, dict.fromkeys((*get_args(SvgCurves), *get_args(DxfCurves), R12)))


def _palette(value: object) -> tuple[str, ...]:
    """A list of colours."""
    with within("palette"):
        return _array(value, _colour, '["#0000ff", "#00ff00"]')


def _array(value: object, read: Callable[[object], str], example: str) -> tuple[str, ...]:
    """A list of texts, each as it is read."""
    if not isinstance(value, list):
        raise DesignError(f"must be an array, not {shown(value)}", remedy=f"Write {example}.")
    return tuple(each(value, read))


def _colour(value: object) -> str:
    if not isinstance(value, str) or not re.fullmatch(r"#[0-9a-fA-F]{6}", value):
        raise DesignError(f"must be a colour, not {shown(value)}", remedy='Write six hexadecimal digits: "#ff0000".')
    return value.lower()


def _width(value: object) -> float:
    result = number(value, "Write a width in millimetres, such as 0.025.")
    if not 0.0 < result <= _STROKE_MAX:
        raise DesignError(
            f"must be greater than 0 and at most {_STROKE_MAX:g}, not {result:g}",
            remedy="Write a width in millimetres, such as 0.025.",
        )
    return result


def _flag(value: object) -> bool:
    return flag(value, "Write true or false, without quotes.")


def _text(value: object) -> str:
    if not isinstance(value, str) or not value.strip() or not value.isprintable():
        raise DesignError(f"must be a text, not {shown(value)}", remedy="Write one line between double quotes.")
    return value


def _choice(value: object, known: Collection[str]) -> str:
    if not isinstance(value, str) or value not in known:
        remedy = f"{suggestion(value, known)}Write one of {', '.join(known)}."
        raise DesignError(f"must not be {shown(value)}", remedy=remedy)
    return value
