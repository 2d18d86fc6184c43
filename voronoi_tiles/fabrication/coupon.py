"""A test piece that shows the kerf of a laser in a sheet: plugs and holes, slots, strips to measure, a reference bar.

Each plug and its hole are drawn compensated for one kerf k, the plug larger by k, the hole smaller by k. With the true
kerf K the hole is wider than the plug by 2 (K - k): smaller numbers are loose, larger ones do not go in, and
the right one fits exactly. Plug i in hole j tests (k_i + k_j) / 2. Slots are t - k + K wide, for the edge of the
sheet of thickness t, and show whether t is right, too. The strips are not compensated: n of them side by side are
n K shorter than drawn, which is the most precise measure.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import Final

import numpy as np

from voronoi_tiles.base.arguments import path_name
from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.units import UNIT_MM
from voronoi_tiles.base.version import __version__
from voronoi_tiles.fabrication.exporting import drawing_format, save_drawing
from voronoi_tiles.fabrication.job_options import Rates, read_number, read_rates, read_text
from voronoi_tiles.fabrication.lettering import fitting_height, lettering, place_labels, text_width
from voronoi_tiles.fabrication.marks import BAR_MM, bar_height, reference_bar, rounded_square
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.formats.writing import recoloured
from voronoi_tiles.paths.paths import Paths

KERFS_MAX: Final = 20
"""Most kerfs on one coupon; it is 30 cm wide then, as much as small lasers take."""

THICKNESS_MAX_MM: Final = 30.0
"""Thickest sheet that a laser cuts, generously; millimetres. More is a slip of the unit."""

PLUG_MM: Final = 10.0
STRIPS: Final = 10
STRIP_MM: Final = 10.0

_STRIP_LENGTH_MM: Final = 20.0
_PLUG_MIN_MM: Final = 8.0
_PLUG_MAX_MM: Final = 100.0
_MARGIN_MM: Final = 5.0
_LETTERS_MM: Final = 2.5
_HAIRLINE_MM: Final = 0.025
_ENGRAVE_COLOUR: Final = "#ff0000"
_INSIDE_COLOUR: Final = "#0000ff"
_CUT_COLOUR: Final = "#000000"

_LENGTH: Final = re.compile(rf"\s*([+-]?(?:\d+\.?\d*|\.\d+))\s*({'|'.join(UNIT_MM)})?\s*", re.ASCII)
KERFS: Final = "0.05:0.4:0.05"
"""The kerfs that are tested where the caller does not say; millimetres."""


def kerf_range(text: str) -> tuple[float, ...]:
    """Read kerfs in millimetres: "0.05:0.4:0.05mm" (first, last, step) or "0.1,0.15,0.2" (a list, or one of them).

    Units are mm (default), cm and in; a number without one takes that of the last number. The last kerf of a
    range is in it when a whole number of steps leads there. The arithmetic is decimal: 0.15 is the float 0.15. Raises
    ArgumentError for what is none of these, and for ranges that are empty or have more than KERFS_MAX kerfs.
    """
    ranged = ":" in text
    parts = [_LENGTH.fullmatch(part) for part in text.split(":" if ranged else ",")]
    matches = [match for match in parts if match]
    if len(matches) < len(parts) or (ranged and len(parts) != 3):
        raise ArgumentError(
            f'"{text[:60]}" is no range of kerfs', remedy="Write first:last:step, 0.05:0.4:0.05mm, or 0.1,0.15,0.2."
        )
    default = matches[-1][2] or "mm"
    sizes: dict[str, Decimal] = {unit: Decimal(str(size)) for unit, size in UNIT_MM.items()}
    values = [Decimal(match[1]) * sizes[match[2] or default] for match in matches]
    if ranged:
        first, last, step = values
        if step <= 0 or last < first:
            raise ArgumentError(
                f'the range of kerfs "{text[:60]}" is empty', remedy="Write the smallest kerf first and a step above 0."
            )
        if last - first >= KERFS_MAX * step:
            raise _too_many()
        values = [first + k * step for k in range(int((last - first) // step) + 1)]
    return tuple(float(value) for value in values)


def coupon(
    path: str | os.PathLike[str] | None = None,
    *,
    thickness: float | str,
    kerfs: str | float | Iterable[float | str] = KERFS,
    plug: float | str = PLUG_MM,
    preset: str | os.PathLike[str] = "plain",
    feed: Rates = None,
    power: Rates = None,
) -> Drawing:
    """A test piece that shows the kerf: numbered plugs and holes for each of a range of kerfs, slots, and strips.

    Cut it, and try which plug just holds in its hole: its number is the kerf. `thickness` is the sheet's and `plug` the
    plugs' size, in millimetres or as texts with a unit; `kerfs` are a range, "0.05:0.4:0.05", or the kerfs, one or
    several. With a path the drawing is written, in the format of its suffix and with the names and colours of the
    preset; for G-code `feed` and `power` are those of a Job. Raises ArgumentError for sizes that cannot be, DesignError
    for an unusable preset, and OutputError.

    >>> import voronoi_tiles as vt
    >>> vt.coupon(thickness="3mm", kerfs=[0.1, 0.15, 0.2])
    <Drawing 'kerf coupon, 3 mm': 138.8 x 126.5 mm, layers engrave, inner, cut>
    """
    sheet, width = read_number("thickness", thickness), read_number("plug", plug)
    if not isinstance(kerfs, Iterable):
        kerfs = [kerfs]
    widths = kerf_range(kerfs) if isinstance(kerfs, str) else [read_number("kerfs", kerf) for kerf in kerfs]
    drawing = coupon_drawing(widths, thickness=sheet, plug=width)
    path = None if path is None else path_name("path", path)
    form = "svg" if path is None else drawing_format(path)
    burn = read_rates("feed", feed), read_rates("power", power)
    drawing = recoloured(drawing, read_text("preset", preset), form, *burn)
    if path is not None:
        save_drawing(drawing, path)
    return drawing


def coupon_drawing(kerfs: Sequence[float], *, thickness: float, plug: float = PLUG_MM) -> Drawing:
    """The test piece for some kerfs, all lengths in millimetres, for a sheet of the given thickness.

    `plug` is the width of the square plugs and the diameter of the round ones. The layers are "engrave"; "inside", the
    holes; "cut", plugs, strips and, last, the plate. All cuts are closed, none meet, and pieces are at least half
    the thickness apart. Raises ArgumentError for no kerf or more than KERFS_MAX, kerfs that are
    alike to 0.001 mm, negative or too large for the plugs or slots, and sizes that are none.
    """
    values = np.sort(np.asarray(kerfs, np.float64))
    _check(values, thickness, plug)
    plan = _plan(values, thickness, plug)
    recipe = {
        "program": "voronoi-tiles",
        "version": __version__,
        "kerfs": ",".join(repr(float(kerf)) for kerf in values),
        "thickness": repr(float(thickness)),
        "plug": repr(float(plug)),
    }
    cuts = Paths.concatenate([_strips(plan), _squares(plan, plan.plug_rows, 0.5), _plate(plan)])
    layers = (
        Layer.of_paths("engrave", "engrave", _ENGRAVE_COLOUR, _HAIRLINE_MM, _engraving(plan)),
        Layer.of_paths("inside", "cut", _INSIDE_COLOUR, _HAIRLINE_MM, _squares(plan, plan.hole_rows, -0.5)),
        Layer.of_paths("cut", "cut", _CUT_COLOUR, _HAIRLINE_MM, cuts),
    )
    title = f"kerf coupon, {thickness:g} mm"
    return Drawing(plan.width, plan.height, layers, title=title, recipe=recipe)


@dataclass(frozen=True, eq=False)
class _Coupon:
    """Where everything lies, in millimetres; y runs up from the page's lower left corner.

    `columns` are the columns' middles, one for each kerf; `plug_rows` and `hole_rows` the middles of the rows of square
    and round ones; `plate` is the plate's lower left and upper right corner.
    """

    kerfs: Floats
    thickness: float
    plug: float
    gap: float
    width: float
    height: float
    columns: Floats
    plug_rows: tuple[float, float]
    hole_rows: tuple[float, float]
    plate: tuple[complex, complex]
    slot_depth: float
    numbers: float
    bar: complex
    captions: tuple[complex, ...]
    number_height: float


def _plan(kerfs: Floats, thickness: float, plug: float) -> _Coupon:
    """Stack, from below: strips, round plugs, square plugs, and the plate with slots, holes, numbers, bar, captions."""
    # What is left between two pieces, and between two cuts in one piece, whatever the kerf is.
    gap = max(3.0, thickness / 2) + float(kerfs[-1])
    pitch = max(plug, thickness * 1.5) + gap
    plate_width = max(
        len(kerfs) * pitch + gap,
        BAR_MM + 2 * _MARGIN_MM,
        *(text_width(line, height=_LETTERS_MM) + 2 * _MARGIN_MM for line in _captions(thickness)),
    )
    width = max(plate_width, STRIPS * (STRIP_MM + gap) - gap) + 2 * _MARGIN_MM
    columns = np.array([width / 2 + (k - (len(kerfs) - 1) / 2) * pitch for k in range(len(kerfs))])

    step = plug + gap
    round_plugs = _MARGIN_MM + _STRIP_LENGTH_MM + gap + plug / 2
    bottom = round_plugs + step + plug / 2 + gap
    slot_depth = min(max(thickness, 8.0), 15.0)
    round_holes = bottom + slot_depth + gap + plug / 2
    numbers = round_holes + step + plug / 2 + _LETTERS_MM / 2 + 1.5
    bar = numbers + _LETTERS_MM / 2 + 3.0
    lines = (
        bar
        + bar_height(_LETTERS_MM)
        + 1.6 * _LETTERS_MM
        + 1.8 * _LETTERS_MM * np.arange(len(_captions(thickness)))[::-1]
    )
    top = float(lines[0]) + _LETTERS_MM + _MARGIN_MM
    left = (width - plate_width) / 2
    labels = _labels(kerfs)
    return _Coupon(
        kerfs=kerfs,
        thickness=thickness,
        plug=plug,
        gap=gap,
        width=width,
        height=top + _MARGIN_MM,
        columns=columns,
        plug_rows=(round_plugs + step, round_plugs),
        hole_rows=(round_holes + step, round_holes),
        plate=(complex(left, bottom), complex(left + plate_width, top)),
        slot_depth=slot_depth,
        numbers=numbers,
        bar=complex((width - BAR_MM) / 2, bar),
        captions=tuple(complex(left + _MARGIN_MM, y) for y in lines),
        number_height=min(fitting_height(label, plug / 2 - 0.8, _LETTERS_MM) for label in labels),
    )


def _captions(thickness: float) -> tuple[str, ...]:
    total = STRIPS * STRIP_MM
    return (
        f"Kerf coupon, sheet {thickness:g} mm",
        "Plug in hole, sheet in slot: the tight one is the kerf",
        f"{STRIPS} strips side by side, W mm: kerf = ({total:g} - W) / {STRIPS}",
    )


def _labels(kerfs: Floats) -> list[str]:
    """The kerfs as they are written on the coupon, to a micrometre."""
    return [f"{round(float(kerf), 3):g}" for kerf in kerfs]


def _engraving(plan: _Coupon) -> Paths:
    """The captions, the bar, and each kerf above its column and on its plugs."""
    lines = [
        lettering(text, height=_LETTERS_MM).moved(1.0, place)
        for text, place in zip(_captions(plan.thickness), plan.captions, strict=True)
    ]
    bar = reference_bar(_LETTERS_MM).moved(1.0, plan.bar)
    rows = np.array([plan.numbers, *plan.plug_rows])
    places = (plan.columns + 1j * rows[:, None]).ravel()
    numbers = place_labels(_labels(plan.kerfs) * len(rows), places, height=plan.number_height)
    return Paths.concatenate([*lines, bar, numbers])


def _squares(plan: _Coupon, rows: tuple[float, float], share: float) -> Paths:
    """A row of rounded squares and a row of circles, their outlines moved outwards by a share of their kerfs.

    The squares' corners are round, in plugs and holes alike: a beam leaves no sharp corner in a hole.
    """
    radius = max(1.0, float(plan.kerfs[-1]))
    found = []
    for row, rounding in zip(rows, (radius, plan.plug / 2), strict=True):
        for column, kerf in zip(plan.columns.tolist(), plan.kerfs.tolist(), strict=True):
            side = plan.plug + 2 * share * kerf
            corner = side / 2 if rounding == plan.plug / 2 else rounding + share * kerf
            found.append(rounded_square(complex(column, row), side, radius=corner))
    return Paths.concatenate(found)


def _strips(plan: _Coupon) -> Paths:
    """The strips side by side, exactly STRIP_MM wide as drawn."""
    first = (plan.width - STRIPS * (STRIP_MM + plan.gap) + plan.gap) / 2
    strip = np.array([0, STRIP_MM, STRIP_MM + 1j * _STRIP_LENGTH_MM, 1j * _STRIP_LENGTH_MM])
    places = first + np.arange(STRIPS) * (STRIP_MM + plan.gap) + 1j * _MARGIN_MM
    return Paths.polylines([place + strip for place in places], closed=True)


def _plate(plan: _Coupon) -> Paths:
    """The plate's outline, with a slot for each kerf in its lower edge, compensated on both sides."""
    low, high = plan.plate
    half = (plan.thickness - plan.kerfs) / 2
    roof = low.imag + plan.slot_depth
    corners = [
        (plan.columns - half) + 1j * low.imag,
        (plan.columns - half) + 1j * roof,
        (plan.columns + half) + 1j * roof,
        (plan.columns + half) + 1j * low.imag,
    ]
    ends = [complex(high.real, low.imag), high, complex(low.real, high.imag)]
    return Paths.polylines([np.concatenate(([low], np.column_stack(corners).ravel(), ends))], closed=True)


def _check(kerfs: Floats, thickness: float, plug: float) -> None:
    """Refuse what cannot be drawn; `kerfs` are in rising order."""
    if not kerfs.size:
        raise ArgumentError("there is no kerf to test", remedy="Give `kerfs='0.05:0.4:0.05mm'`, or the like.")
    if kerfs.size > KERFS_MAX:
        raise _too_many()
    if not 0 < thickness <= THICKNESS_MAX_MM:
        raise ArgumentError(
            f"a sheet of {thickness:g} mm cannot be cut",
            remedy=f"Give its `thickness`, up to {THICKNESS_MAX_MM:g} mm, as in 3mm.",
        )
    if not _PLUG_MIN_MM <= plug <= _PLUG_MAX_MM:
        raise ArgumentError(
            f"plugs of {plug:g} mm are not drawn", remedy=f"Take `plug` from {_PLUG_MIN_MM:g} to {_PLUG_MAX_MM:g} mm."
        )
    if not (np.isfinite(kerfs).all() and kerfs[0] >= 0):
        raise ArgumentError(f"a kerf of {kerfs[0]:g} mm is none", remedy="Kerfs are 0 mm or more.")
    most = min(plug / 4, thickness)
    if not (kerfs[-1] <= plug / 4 and kerfs[-1] < thickness):
        raise ArgumentError(
            f"a kerf of {kerfs[-1]:g} mm is too much for slots of {thickness:g} mm and plugs of {plug:g} mm",
            remedy=f"Stay below {most:g} mm.",
        )
    labels = _labels(kerfs)
    if len(set(labels)) < len(labels):
        raise ArgumentError("two kerfs are alike to a thousandth of a millimetre", remedy="Take a larger step.")


def _too_many() -> ArgumentError:
    return ArgumentError(
        f"more than {KERFS_MAX} kerfs are too many for a coupon", remedy="Take a larger step or a shorter range."
    )
