"""What is drawn beside the tiles: a bar to measure the file's scale by, and marks to lay sheets on each other."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from voronoi_tiles.fabrication.lettering import lettering
from voronoi_tiles.paths.paths import ARC, LINE, Paths

BAR_MM: Final = 100.0
TICK_STEP_MM: Final = 10.0


def reference_bar(letters: float) -> Paths:
    """A bar of BAR_MM with end ticks, a tick every 10 mm and its length as a caption, its lower left at 0.

    The distance of the two end ticks is the length. `letters` is the height of the caption's capitals, which scales the
    ticks too; the whole is `bar_height(letters)` high. All paths are open; ticks touch the bar, and nothing crosses.
    Raises ValueError for letters that are not more than 0 mm high.
    """
    caption = lettering(f"{BAR_MM:g} mm", height=letters, align="centre")
    bar = np.array([1j * letters, 0, BAR_MM, BAR_MM + 1j * letters])
    ticks = [np.array([x, x + 0.5j * letters]) for x in np.arange(TICK_STEP_MM, BAR_MM, TICK_STEP_MM)]
    return Paths.concatenate([Paths.polylines([bar, *ticks]), caption.moved(1.0, BAR_MM / 2 + 1j * letters)])


def bar_height(letters: float) -> float:
    """The height of a reference bar with these letters, in millimetres."""
    return 2 * letters


def registration_marks(width: float, height: float, *, size: float, inset: float) -> Paths:
    """Crosses at three corners of a page of `width` times `height` millimetres, to align passes or sheets.

    Their centres are `inset` from the page's edges, their arms reach `size / 2` from there. Those at the lower left
    and lower right have a circle about them, that at the upper left a square: a sheet that is turned or flipped in any
    way shows it, square ones too. Each mark is two open lines and one closed path. Raises ValueError where the marks
    would leave the page or meet.
    """
    if not (0 < size < math.inf and size / 2 <= inset < math.inf):
        raise ValueError(
            f"marks of {size:g} mm do not fit {inset:g} mm from the edge. The inset is half the size or more."
        )
    if not (2 * inset + size <= width < math.inf and 2 * inset + size <= height < math.inf):
        raise ValueError(
            f"three marks of {size:g} mm do not fit on a page of {width:g} x {height:g} mm. "
            "Take a larger page or smaller marks."
        )
    lower_left = complex(inset, inset)
    lower_right = complex(width - inset, inset)
    upper_left = complex(inset, height - inset)
    parts = []
    for centre in (lower_left, lower_right, upper_left):
        arms = [np.array([-1, 1]), np.array([-1j, 1j])]
        parts.append(Paths.polylines([np.asarray(centre + size / 2 * arm, np.complex128) for arm in arms]))
        square = centre == upper_left
        parts.append(rounded_square(centre, size / 2, radius=0.0 if square else size / 4))
    return Paths.concatenate(parts)


def rounded_square(centre: complex, side: float, *, radius: float) -> Paths:
    """A square as one closed counter-clockwise path, its corners rounded; with a radius of side / 2 a circle.

    Raises ValueError for a side that is not more than 0 and a radius that is not between 0 and half the side.
    """
    if not (0 < side < math.inf and 0 <= radius <= side / 2):
        raise ValueError(f"a square of {side:g} mm has no corners of radius {radius:g} mm")
    half = side / 2
    corners = half * np.array([1 + 1j, -1 + 1j, -1 - 1j, 1 - 1j])
    if radius == 0:
        return Paths.polylines([np.asarray(centre + corners, np.complex128)], closed=True)
    quarter = np.array([1, 1j, -1, -1j])
    # About each corner's centre a quarter of a circle, and a straight line to the next one, where there is room.
    hubs = centre + (1 - radius / half) * corners
    start = np.column_stack((hubs + radius * quarter, hubs + radius * 1j * quarter))
    middle = np.column_stack((hubs + radius * np.sqrt(0.5) * (1 + 1j) * quarter, np.zeros(4)))
    kind = np.tile(np.array([ARC, LINE], np.uint8), (4, 1))
    pieces = 1 if radius == half else 2
    begin = np.asarray(start[:, :pieces], np.complex128).ravel()
    control = np.zeros((len(begin), 2), np.complex128)
    control[:, 0] = middle[:, :pieces].ravel()
    return Paths(
        start=begin,
        end=np.roll(begin, -1),
        control=control,
        kind=kind[:, :pieces].ravel(),
        offsets=np.array([0, len(begin)], np.intp),
        closed=np.array([True]),
    )
