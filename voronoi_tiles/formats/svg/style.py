"""How an object is painted: the properties that elements hand on to what they hold."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final, Literal, NamedTuple

from voronoi_tiles.formats.svg.cascade import Declarations
from voronoi_tiles.formats.svg.colours import BLACK, Colour, parse_colour
from voronoi_tiles.formats.svg.css_text import words
from voronoi_tiles.formats.svg.lengths import Measure, Units, parse_measure
from voronoi_tiles.formats.svg.properties import INHERITED, MARKERS, SIZES, opacity, paint_fallback

SUBSTITUTE: Final = Colour("#808080")
"""What stands for gradients, patterns, and paint that is not understood."""

Paint = Colour | Literal["current"] | None
"""A colour, that of the property `color`, or no paint."""


class Style(NamedTuple):
    """The inherited properties; `width` may be a share, `used` is the paint of the clone around: fill, stroke."""

    stroke: Paint = None
    fill: Paint = BLACK
    stroke_opacity: float = 1.0
    fill_opacity: float = 1.0
    width: Measure = Measure(1.0)
    dashed: bool = False
    markers: tuple[bool, bool, bool] = (False, False, False)
    visible: bool = True
    colour: Colour = BLACK
    dark: bool = False
    units: Units = Units()
    custom: Mapping[str, str] = {}
    used: tuple[Paint, Paint] | None = None

    def shown(self, paint: Paint, share: float) -> Colour | None:
        """A paint as it is seen; None where it is not."""
        colour = self.colour if paint == "current" else paint
        return None if colour is None or colour.alpha * share == 0.0 else colour

    @property
    def stroke_shown(self) -> Colour | None:
        """The stroke's colour, None where there is none or it cannot be seen."""
        return self.shown(self.stroke, self.stroke_opacity)

    @property
    def fill_shown(self) -> Colour | None:
        """The fill's colour, None where there is none or it cannot be seen."""
        return self.shown(self.fill, self.fill_opacity)


class Styles:
    """The styles of elements; those that say the same in the same place share one.

    `is_server` tells whether the file has a gradient or pattern of a name.
    """

    def __init__(self, is_server: Callable[[str], bool]) -> None:
        self._is_server = is_server
        # With each style what was noted; its parent and declarations are kept, so that no other has their id.
        self._known: dict[tuple[object, ...], tuple[Style, list[str], Style, Declarations]] = {}

    def inherited(self, parent: Style, said: Declarations) -> Style:
        """The style of an element from its parent's and from what is declared for it.

        Raises DrawingError for styles beyond the limits.
        """
        if not said.names:
            return parent
        key = id(parent), *said.paint_key()
        found = self._known.get(key)
        if found is None:
            if len(self._known) >= _KNOWN_MAX:
                self._known.clear()
            note, notes = said.note, list[str]()
            said.note = notes.append
            found = self._known[key] = _computed(parent, said, self._is_server), notes, parent, said
            said.note = note
        style, notes, *_ = found
        said.custom = style.custom
        for name in notes:
            said.note(name)
        return style


_KNOWN_MAX: Final = 4096
"""Most styles that are kept; a count."""


def _computed(parent: Style, said: Declarations, is_server: Callable[[str], bool]) -> Style:
    """The style of an element, see Styles."""
    custom = said.inherit_custom(parent.custom)
    names = said.names & INHERITED
    if not names:
        return parent if custom is parent.custom else parent._replace(custom=custom)
    style = parent._replace(custom=custom)
    # The size of the font and the colour come first: others refer to them.
    style = style._replace(units=_with_font(style, said))
    scheme = said.value("color-scheme")
    if scheme is not None and scheme != "inherit":
        style = style._replace(dark=scheme.lower().split()[:1] == ["dark"])
    style = style._replace(colour=_colour(style, said))
    stroke = _paint("stroke", parent.stroke, Style().stroke, style, said, is_server)
    fill = _paint("fill", parent.fill, Style().fill, style, said, is_server)
    return style._replace(
        stroke=stroke,
        fill=fill,
        stroke_opacity=_opacity("stroke-opacity", parent.stroke_opacity, said),
        fill_opacity=_opacity("fill-opacity", parent.fill_opacity, said),
        width=_width(style, said),
        dashed=_dashed(style, said),
        markers=_markers(parent.markers, said),
        visible=_visible(parent.visible, said),
    )


def _inherits(value: str) -> bool:
    return value.lower() in {"inherit", "unset", "revert"}


def _with_font(style: Style, said: Declarations) -> Units:
    """The units, `em` being the size of the element's font."""
    value = said.value("font-size")
    em = style.units.em
    if value is None or _inherits(value):
        return style.units
    word = value.strip().lower()
    if word in {"larger", "smaller"}:
        size = em * 1.2 if word == "larger" else em / 1.2
    elif word in SIZES or word == "initial":
        size = SIZES.get(word, SIZES["medium"])
    else:
        measure = parse_measure(value, style.units)
        size = measure.of(em) if measure is not None else em
    return style.units._replace(em=size)


def _colour(style: Style, said: Declarations) -> Colour:
    value = said.value("color")
    if value is None or _inherits(value):
        return style.colour
    found = BLACK if value.lower() == "initial" else parse_colour(value, style.colour, style.dark)
    return found or style.colour


def _paint(
    name: Literal["stroke", "fill"],
    before: Paint,
    initial: Paint,
    style: Style,
    said: Declarations,
    is_server: Callable[[str], bool],
) -> Paint:
    """A stroke or fill. What is not understood is never invisible: SUBSTITUTE stands for it."""
    value, _, doubtful = said.found(name)
    word = "inherit" if value is None else value.strip().lower()
    paint: Paint
    if _inherits(word):
        paint = before
    elif word == "initial":
        paint = initial
    elif word == "none":
        paint = None
    elif word == "currentcolor":
        paint = "current"
    elif word in {"context-fill", "context-stroke"}:
        paint = None if style.used is None else style.used[word == "context-stroke"]
    elif word.startswith("url("):
        paint = _server(value or "", style, said, is_server)
    else:
        paint = parse_colour(word, style.colour, style.dark)
    return SUBSTITUTE if doubtful and style.shown(paint, 1.0) is None else paint


def _server(value: str, style: Style, said: Declarations, is_server: Callable[[str], bool]) -> Paint:
    """What stands for a gradient or a pattern; where there is none, the colour that is given for that case."""
    url, rest = words(value)[0], paint_fallback(value)
    name = url[4:-1].strip("\"' ")
    if is_server(name.removeprefix("#")):
        return SUBSTITUTE
    if rest is None:
        said.note(f"paint {url[:40]!r}")
        return SUBSTITUTE
    return None if rest.lower() == "none" else parse_colour(rest, style.colour, style.dark)


def _opacity(name: str, before: float, said: Declarations) -> float:
    value = said.value(name)
    if value is None or _inherits(value):
        return before
    share = opacity(value)
    return 1.0 if share is None else share


def _width(style: Style, said: Declarations) -> Measure:
    value = said.value("stroke-width")
    if value is None or _inherits(value):
        return style.width
    if value.lower() == "hairline":
        return Measure(0.0)
    return parse_measure(value, style.units) or Measure(1.0)


def _dashed(style: Style, said: Declarations) -> bool:
    """Whether a stroke has gaps; dashes of no length at all mean none."""
    value = said.value("stroke-dasharray")
    if value is None or _inherits(value):
        return style.dashed
    if value.lower() in {"none", "initial"}:
        return False
    measures = [parse_measure(word, style.units) for word in words(value)]
    return any(measure is not None and (measure.pixels > 0.0 or measure.share > 0.0) for measure in measures)


def _markers(before: tuple[bool, bool, bool], said: Declarations) -> tuple[bool, bool, bool]:
    found = list(before)
    for k, name in enumerate(MARKERS):
        value = said.value(name)
        if value is not None and not _inherits(value):
            found[k] = value.lower() not in {"none", "initial"}
    return found[0], found[1], found[2]


def _visible(before: bool, said: Declarations) -> bool:
    value = said.value("visibility")
    return before if value is None or _inherits(value) else value.lower() in {"visible", "initial"}
