"""Single-stroke lettering: texts as lines for a laser or a pen to follow, and where a label goes in a tile.

The glyphs are A. V. Hershey's, from the package Hershey-Fonts. The font is one Paths of all its strokes with a table
of characters, so that ten thousand labels are a few operations on arrays.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, plane, ranges
from voronoi_tiles.paths.paths import Paths

Align = Literal["left", "centre"]
Vertical = Literal["baseline", "middle"]

FONT: Final = "futural"
"""The font of Hershey-Fonts that is used: the plain one of single strokes."""

_CODES: Final = 0x7F
"""The font has the printable characters of ASCII; what its file holds beyond is a sign here, a blot there."""

_ALIKE: Final[Mapping[str, str]] = {
    **dict.fromkeys("\u2018\u2019\u201a\u2032", "'"),
    **dict.fromkeys("\u201c\u201d\u201e\u2033\u00ab\u00bb", '"'),
    "\u2212": "-",
    "\u00d7": "x",
    "\u00b7": ".",
    "ß": "ss",
    "Æ": "AE",
    "æ": "ae",
    "Œ": "OE",
    "œ": "oe",
    "Ø": "O",
    "ø": "o",
    "Ł": "L",
    "ł": "l",
    "Đ": "D",
    "đ": "d",
    "\u0131": "i",
}
"""What stands for characters that Unicode does not decompose; dashes are known by their category."""


@dataclass(frozen=True, eq=False)
class Font:
    """The strokes of the font, in its own units, which are whole numbers, so that sums of them are exact.

    Capitals are `capital` high, y is up, the base line is y = 0, a glyph's advance begins at x = 0. By code (ASCII, 0
    to 126): `known` (bool); `first` and `count` (intp), the glyph's paths in `strokes`; `advance`
    (float64); `left` and `right` (float64), the ends of its ink along x, inf and -inf where it has none.
    """

    capital: float
    strokes: Paths
    known: Bools
    first: Ints
    count: Ints
    advance: Floats
    left: Floats
    right: Floats

    def codes(self, text: str) -> Ints:
        """The codes of a text's characters; raises ValueError for one that the font lacks, naming it."""
        codes = np.frombuffer(text.encode("utf-32-le", "surrogatepass"), np.uint32).astype(np.intp)
        missing = (codes >= _CODES) | ~self.known[np.minimum(codes, _CODES - 1)]
        if missing.any():
            character = text[int(np.argmax(missing))]
            name = unicodedata.name(character, "no printable character")
            raise ValueError(
                f"the font {FONT} has no {character!r} (U+{ord(character):04X}, {name}). "
                "Write the text in ASCII, or pass it through printable()."
            )
        return codes


@cache
def load_font() -> Font:
    """The font; its capitals are as high as its H."""
    from HersheyFonts import HersheyFonts

    library = HersheyFonts(load_default_font=FONT)
    glyphs = library.all_glyphs
    base = float(library.render_options.base_line)
    capital = base - min(y for stroke in glyphs["H"].strokes for _, y in stroke)

    lines: list[Complexes] = []
    known = np.zeros(_CODES, np.bool_)
    first, count = np.zeros((2, _CODES), np.intp)
    advance = np.zeros(_CODES)
    left, right = np.full(_CODES, np.inf), np.full(_CODES, -np.inf)
    for code in range(ord(" "), _CODES):
        glyph = glyphs.get(chr(code))
        if glyph is None:
            continue
        # The library's y runs down.
        strokes = [np.array([complex(x - glyph.left_offset, base - y) for x, y in stroke]) for stroke in glyph.strokes]
        known[code], first[code], count[code] = True, len(lines), len(strokes)
        advance[code] = glyph.char_width
        if strokes:
            ink = np.concatenate(strokes).real
            left[code], right[code] = ink.min(), ink.max()
        lines += strokes
    return Font(capital, Paths.polylines(lines), known, first, count, advance, left, right)


def lettering(text: str, *, height: float, align: Align = "left", vertical: Vertical = "baseline") -> Paths:
    """A line of text as open paths of LINE pieces, y up, its capitals `height` millimetres high.

    The ink begins or has its middle at x = 0 (`align`), and y = 0 is the base line or half the height of
    the capitals (`vertical`). Raises ValueError for a character that the font lacks and a height that is not > 0.
    """
    return _set([text], np.zeros(1, np.complex128), height, align, vertical)


def place_labels(texts: Sequence[str], positions: Complexes, *, height: ArrayLike) -> Paths:
    """A text about each of the positions (complex128, n): centred along x, and by half the height of capitals along y.

    `height` is the height of the capitals in millimetres, one for all or one for each (float64, n). The paths are in
    the order of the texts. Raises ValueError like `lettering`, and where texts, positions and heights differ in number.
    """
    return _set(texts, np.asarray(positions, np.complex128), height, "centre", "middle")


def text_width(text: str, *, height: float) -> float:
    """The width of a text's ink in millimetres, from its leftmost to its rightmost point; 0 without ink."""
    font = load_font()
    _check_heights(np.array(height, np.float64))
    codes = font.codes(text)
    _, left, right = _extents(font, codes, np.array([len(codes)]))
    return float(right[0] - left[0]) * (height / font.capital)


def printable(text: str) -> str:
    """The text with what the font lacks replaced, so that `lettering` takes it.

    Blanks of all kinds become spaces, letters lose their accents ("é" is "e"), ligatures, dashes and quotation marks
    become their ASCII likenesses ("ß" is "ss"); each of the others becomes "?".
    """
    known = load_font().known
    shown = []
    for character in unicodedata.normalize("NFC", text):
        dash = "-" if unicodedata.category(character) == "Pd" else None
        plain = _ALIKE.get(character) or dash or unicodedata.normalize("NFKD", character)
        base = "".join(" " if part.isspace() else part for part in plain if not unicodedata.combining(part))
        good = base and all(ord(part) < _CODES and known[ord(part)] for part in base)
        shown.append(base if good else "?")
    return "".join(shown)


def label_position(rings: Sequence[Complexes]) -> tuple[complex, float]:
    """Where a label has the most room in a tile: the point farthest from the outline, and its distance to it.

    `rings` are the tile's flattened rings (complex128 each, the first point not repeated), the outer one first, holes
    after it. The distance is that of the returned point, exactly; no other point has one that is larger by more than a
    thousandth of the tile's extent. Raises ValueError for rings that bound no area or cross. Source: the pole of
    inaccessibility (V. Agafonkin, 2016), by shapely.
    """
    import shapely
    from shapely.ops import polylabel

    if not rings or any(len(ring) < 3 or not np.isfinite(ring).all() for ring in rings):
        raise ValueError("a tile's rings have three points at least, and finite ones")
    outer, *holes = map(plane, rings)
    polygon = shapely.Polygon(outer, holes)
    if not shapely.is_valid(polygon) or not polygon.area > 0:
        raise ValueError(f"the rings bound no tile: {shapely.is_valid_reason(polygon)}")
    x0, y0, x1, y1 = polygon.bounds
    pole = polylabel(polygon, tolerance=max(x1 - x0, y1 - y0) / 1000)
    return complex(pole.x, pole.y), float(shapely.distance(pole, polygon.boundary))


def fitting_height(text: str, radius: float, wanted: float) -> float:
    """The height of capitals, `wanted` at most, with which a text by `place_labels` stays in a circle of that radius.

    The circle is about the label's position; 0 for a radius of 0. Raises ValueError for a character that the font
    lacks, a negative radius, and a wanted height that is not > 0.
    """
    _check_heights(np.array(wanted, np.float64))
    if not radius >= 0:
        raise ValueError(f"a radius of {radius} is not one")
    strokes = lettering(text, height=1.0, align="centre", vertical="middle")
    if not len(strokes):
        return wanted
    reach = float(np.abs(np.concatenate((strokes.start, strokes.end))).max())
    return min(wanted, radius / reach)


def _set(texts: Sequence[str], positions: Complexes, height: ArrayLike, align: Align, vertical: Vertical) -> Paths:
    """Each text at its position; see `lettering` and `place_labels`."""
    if positions.shape != (len(texts),):
        raise ValueError(f"{len(texts)} texts have {positions.size} positions")
    heights = np.asarray(height, np.float64)
    _check_heights(heights)
    if heights.shape not in {(), positions.shape}:
        raise ValueError(f"{len(texts)} texts have {heights.size} heights")
    font = load_font()
    codes = font.codes("".join(texts))
    lengths = np.array([len(text) for text in texts], np.intp)
    pens, left, right = _extents(font, codes, lengths)
    origin = {"left": left, "centre": (left + right) / 2}[align]
    rise = {"baseline": 0.0, "middle": -font.capital / 2}[vertical]

    # From texts to characters, from characters to their paths, from paths to their pieces.
    text = np.repeat(np.arange(len(texts)), lengths)
    counts = font.count[codes]
    paths = font.strokes.take(ranges(font.first[codes], counts))
    character = np.repeat(np.arange(len(codes)), counts)[paths.owner]
    owner = text[character]
    across = (pens - origin[text])[character]
    scale = np.broadcast_to(heights / font.capital, positions.shape)[owner]
    shift = positions[owner]

    def placed(points: Complexes) -> Complexes:
        # In real numbers: the ends of neighbouring pieces keep the same bits.
        image = np.empty(points.shape, np.complex128)
        image.real = scale * (points.real + across) + shift.real
        image.imag = scale * (points.imag + rise) + shift.imag
        return image

    return Paths(placed(paths.start), placed(paths.end), paths.control, paths.kind, paths.offsets, paths.closed)


def _extents(font: Font, codes: Ints, lengths: Ints) -> tuple[Floats, Floats, Floats]:
    """Where each character of texts of these lengths begins, and the ends of each text's ink (0 without any)."""
    text = np.repeat(np.arange(len(lengths)), lengths)
    after = np.cumsum(font.advance[codes])
    begins = np.append(0.0, after)[np.cumsum(lengths) - lengths]
    pens = after - font.advance[codes] - begins[text]
    left, right = np.full(len(lengths), np.inf), np.full(len(lengths), -np.inf)
    np.minimum.at(left, text, pens + font.left[codes])
    np.maximum.at(right, text, pens + font.right[codes])
    blank = left > right
    return pens, np.where(blank, 0.0, left), np.where(blank, 0.0, right)


def _check_heights(heights: Floats) -> None:
    if not (np.isfinite(heights) & (heights > 0)).all():
        raise ValueError("the height of letters must be more than 0 mm")
