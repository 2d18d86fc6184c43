"""CSS colours as they are shown on a screen: all notations of CSS Color 4, and those of 5 that need no other file."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import TYPE_CHECKING, Final, NamedTuple

from voronoi_tiles.formats.svg.css_text import arguments_of, function_of

if TYPE_CHECKING:
    from coloraide import Color

LENGTH_MAX: Final = 400
"""Longest text that is looked at as a colour; characters. Mixtures of mixtures would be longer."""


class Colour(NamedTuple):
    """A colour "#rrggbb" and its opacity from 0 to 1."""

    rgb: str
    alpha: float = 1.0


BLACK: Final = Colour("#000000")

# What Chromium shows for the system's colours in a light scheme; any visible colour would do.
_SYSTEM: Final = """
accentcolor:0075ff accentcolortext:ffffff activetext:ff0000 buttonborder:000000 buttonface:efefef buttontext:000000
canvas:ffffff canvastext:000000 field:ffffff fieldtext:000000 graytext:808080 highlight:3367d1 highlighttext:ffffff
linktext:0000ee mark:ffff00 marktext:000000 selecteditem:1967d2 selecteditemtext:ffffff visitedtext:551a8b
activeborder:000000 activecaption:ffffff appworkspace:ffffff background:ffffff buttonhighlight:efefef
buttonshadow:efefef captiontext:000000 inactiveborder:000000 inactivecaption:ffffff inactivecaptiontext:808080
infobackground:ffffff infotext:000000 menu:ffffff menutext:000000 scrollbar:ffffff threeddarkshadow:000000
threedface:efefef threedhighlight:000000 threedlightshadow:000000 threedshadow:000000 window:ffffff
windowframe:000000 windowtext:000000
"""
_SYSTEM_COLOURS: Final = {name: f"#{rgb}" for name, _, rgb in (entry.partition(":") for entry in _SYSTEM.split())}

_HEX: Final = re.compile(r"#[0-9a-f]{3,8}")
_PERCENTAGE: Final = re.compile(r"[+]?([0-9]+(?:\.[0-9]+)?|\.[0-9]+)%")
_SPACES: Final = frozenset(
    {"srgb", "srgb-linear", "display-p3", "a98-rgb", "prophoto-rgb", "rec2020", "lab", "oklab", "xyz", "xyz-d50"}
    | {"xyz-d65", "hsl", "hwb", "lch", "oklch"}
)
_HUES: Final = re.compile(r"(shorter|longer|increasing|decreasing) hue")


def parse_colour(text: str, current: Colour = BLACK, dark: bool = False) -> Colour | None:
    """The colour that a text stands for; None where it is none that is known here.

    `current` is what currentColor stands for, `dark` chooses the second of light-dark(). A colour beyond what screens
    show is clipped channel by channel, as browsers do.
    """
    return _parsed(text.strip().lower(), current, dark) if len(text) <= LENGTH_MAX else None


@lru_cache(maxsize=4096)
def _parsed(word: str, current: Colour, dark: bool) -> Colour | None:
    """The colour of a text in small letters."""
    if _HEX.fullmatch(word):
        return _hexadecimal(word[1:])
    match function_of(word):
        case "light-dark":
            both = [parse_colour(part, current, dark) for part in arguments_of(word)]
            return both[int(dark)] if len(both) == 2 and None not in both else None
        case "color-mix":
            return _mixed(arguments_of(word), current, dark)
        case "" if word == "currentcolor":
            return current
        case "" if word in _SYSTEM_COLOURS:
            return Colour(_SYSTEM_COLOURS[word])
    return _written(word)


def _written(word: str) -> Colour | None:
    """The colour of a name, or of a function that says its channels; None where it is none."""
    from coloraide import Color

    try:
        found = Color.match(word, fullmatch=True)
        return None if found is None else _shown(found.color)
    except (ArithmeticError, ValueError):  # the powers of large numbers are beyond all bounds
        return None


def _hexadecimal(digits: str) -> Colour | None:
    """The colour of three, four, six or eight hexadecimal digits."""
    if len(digits) in {3, 4}:
        digits = "".join(2 * digit for digit in digits)
    return Colour(f"#{digits[:6]}", int(digits[6:] or "ff", 16) / 255) if len(digits) in {6, 8} else None


def _shown(colour: Color) -> Colour:
    """A colour in eight bits a channel; what is missing ("none") is 0."""
    shown = colour.convert("srgb").fit("srgb", method="clip")
    alpha = shown.alpha(nans=False)
    return Colour(shown.set("alpha", 1.0).to_string(hex=True, fit=False), min(max(alpha, 0.0), 1.0))


def _mixed(parts: list[str], current: Colour, dark: bool) -> Colour | None:
    """The mixture that color-mix(in space, colour share, colour share) stands for."""
    from coloraide import Color

    space, hue = "oklab", "shorter"
    if parts and parts[0].startswith("in "):
        space, _, rest = parts[0].removeprefix("in ").strip().partition(" ")
        match = _HUES.fullmatch(" ".join(rest.split()))
        if space not in _SPACES or (rest and match is None):
            return None
        hue = match[1] if match else hue
        parts = parts[1:]
    colours, shares = [], []
    for part in parts:
        words = part.split()
        share = next((word for word in (words[0], words[-1]) if _PERCENTAGE.fullmatch(word)), None) if words else None
        colour = parse_colour(part if share is None else part.replace(share, "", 1), current, dark)
        if colour is None:
            return None
        colours.append(Color(colour.rgb).set("alpha", colour.alpha))
        shares.append(None if share is None else float(share[:-1]) / 100)
    if len(colours) != 2 or any(share is not None and share > 1.0 for share in shares):
        return None
    one, two = shares
    if one is None:
        one = 1.0 - two if two is not None else 0.5
    two = 1.0 - one if two is None else two
    if one + two == 0.0:
        return None
    mixture = colours[0].mix(
        colours[1], two / (one + two), space={"xyz": "xyz-d65"}.get(space, space), hue=hue, powerless=True
    )
    shown = _shown(mixture)
    return shown._replace(alpha=shown.alpha * min(1.0, one + two))
