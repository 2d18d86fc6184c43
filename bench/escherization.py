"""Outlines of icons and the tiles nearest to them: ours beside the published eigenvalue method (nearest_tiles.py).

The icons are filled animals and objects of Material Design Icons, each of one piece; they were chosen by their names
and for this alone, before any of them was fitted. Of each the outer outline is taken, its longer side 60 mm. Overlap is
the area of the intersection of tile and outline over that of their union. Times are processor time, all in one process.

The peer's tiles are polygons of 120 points, beside as many points of the outline at equal steps; of all numbers of
points on their edges and all beginnings the nearest are found as the method says, and of the nearest tiles of each type
the one with the largest overlap is taken, after it has been moved, turned and scaled for it.

    python bench/escherization.py                  needs npm once, which fetches the icons into a folder of the cache
    python bench/escherization.py cat dog          these alone
    python bench/escherization.py --write          also: the tables into bench/README.md
    python bench/escherization.py --pictures DIR   also: a drawing of each outline with the peer's tile, SVG
"""

from __future__ import annotations

import argparse
import os
import shutil
import statistics
import subprocess
import sys
import tarfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
import shapely
from isohedral import Complexes
from nearest_tiles import FINEST, Tile, nearest_tiles
from report import machine, published, table
from scipy.optimize import minimize

import voronoi_tiles as vt
from voronoi_tiles.formats.reading import read_drawing
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import Paths

PACKAGE: Final = "@mdi/svg"
VERSION: Final = "7.4.47"

# fmt: off
ANIMALS: Final = (
    "bat", "bee", "bird", "bug", "cat", "cow", "dog", "dolphin", "donkey", "duck", "elephant", "fish", "horse",
    "horse-variant", "jellyfish", "kangaroo", "owl", "penguin", "pig", "pig-variant", "piggy-bank", "rabbit",
    "rabbit-variant", "rodent", "shark", "snail", "snake", "spider", "unicorn", "unicorn-variant",
)
OBJECTS: Final = (
    "airplane", "anchor", "axe-battle", "bone", "bottle-wine", "cactus", "car-side", "carrot", "cloud", "corn",
    "fruit-pear", "ghost", "hammer", "horseshoe", "kettle", "key", "leaf", "leaf-maple", "peanut", "pine-tree",
    "pumpkin", "puzzle", "saxophone", "shoe-heel", "skull", "sword", "tooth", "tshirt-crew", "violin", "wrench",
)
# fmt: on

SIZE_MM: Final = 60.0
"""The longer side of an outline's bounding box; millimetres."""

FLAT_MM: Final = 0.02
"""How far an outline's chords are off its curves; millimetres."""

LOOKED_AT: Final = 100
"""How many of the nearest tiles of each type are compared by their overlap; a count."""

PLACED: Final = 5
"""How many of all are moved, turned and scaled until their overlap is largest; a count."""


class Fitted(NamedTuple):
    """A tile that was fitted: the name of its type or group, its overlap, and the processor seconds that it took."""

    kind: str
    overlap: float
    seconds: float


def main() -> None:
    """Fit the icons and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="icons; default: all that are listed")
    parser.add_argument("--write", action="store_true", help="put the tables into bench/README.md")
    parser.add_argument("--pictures", type=Path, help="a folder for drawings of the peer's tiles")
    given = parser.parse_args()
    folder = icons()
    with published("escherization", write=given.write):
        print(machine())
        print(f"Icons: {PACKAGE} {VERSION}", flush=True)
        report(given.names or [*ANIMALS, *OBJECTS], folder, given.pictures)


def icons() -> Path:
    """The folder of the icons, fetched by npm where it is not there yet."""
    cache = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "voronoi_tiles" / f"mdi-svg-{VERSION}"
    folder = cache / "package" / "svg"
    if not folder.is_dir():
        npm = shutil.which("npm")
        if npm is None:
            sys.exit(f"npm is missing: it fetches the icons ({PACKAGE} {VERSION}) into {cache}")
        cache.mkdir(parents=True, exist_ok=True)
        done = subprocess.run(  # noqa: S603 - a fixed command
            [npm, "pack", f"{PACKAGE}@{VERSION}", "--silent"], cwd=cache, check=True, capture_output=True, text=True
        )
        with tarfile.open(cache / done.stdout.split()[-1]) as packed:
            packed.extractall(cache, filter="data")
    return folder


def outline_of(file: Path) -> Complexes:
    """The outer outline of an icon's largest part, counter-clockwise, about 0, its longer side SIZE_MM."""
    paths = Paths.concatenate([shape.paths for shape in read_drawing(file).shapes])
    low_x, low_y, high_x, high_y = paths.bounds
    scale = SIZE_MM / max(high_x - low_x, high_y - low_y)
    lines = to_lines(paths.moved(scale, -scale * complex(low_x + high_x, low_y + high_y) / 2), accuracy=FLAT_MM)
    rings = [shapely.Polygon(xy(lines.take(np.array([k])).start)) for k in range(len(lines)) if lines.counts[k] > 2]
    ring = max(rings, key=lambda ring: ring.area).exterior
    points = shapely.get_coordinates(ring if ring.is_ccw else ring.reverse())[:-1]
    return np.asarray(points[:, 0] + 1j * points[:, 1])


def xy(points: Complexes) -> Any:
    """Points as rows of two numbers."""
    return np.column_stack((points.real, points.imag))


def overlap(one: shapely.Polygon, other: shapely.Polygon) -> float:
    """The area of the intersection over that of the union."""
    common = one.intersection(other).area
    return float(common / (one.area + other.area - common))


# --- the peer ----------------------------------------------------------------------------------------------------


def steps_along(outline: Complexes, count: int) -> Complexes:
    """So many points of a closed outline, at equal steps."""
    ring = shapely.LinearRing(xy(outline))
    at = shapely.get_coordinates(shapely.line_interpolate_point(ring, np.arange(count) / count, normalized=True))
    return np.asarray(at[:, 0] + 1j * at[:, 1])


def moved(tile: Complexes, by: Iterable[float]) -> Complexes:
    """A tile that is scaled and turned by a complex number 1 + a + bi about 0, and moved by c + di."""
    a, b, c, d = by
    return tile * complex(1 + a, b) + complex(c, d)


def best_placed(tile: Complexes, goal: shapely.Polygon) -> tuple[Complexes, float]:
    """A tile moved, turned and scaled so that its overlap with the goal is largest, by Nelder and Mead."""
    size = float(np.abs(tile).max())
    start = np.array([[0, 0, 0, 0], *(np.eye(4) * [0.02, 0.02, 0.02 * size, 0.02 * size])])
    found = minimize(
        lambda by: -overlap(shapely.Polygon(xy(moved(tile, by))), goal),
        np.zeros(4),
        method="Nelder-Mead",
        options={"initial_simplex": start, "maxfev": 150},
    )
    return moved(tile, found.x), -float(found.fun)


def nearest_tile(outline: Complexes) -> tuple[Tile, Complexes, float]:
    """The peer's tile of an outline: as it was found, where it overlaps most, and that overlap.

    Polygons that cross themselves are no tiles.
    """
    finest = steps_along(outline, FINEST)
    centre = finest.mean()
    goal = shapely.Polygon(xy(outline - centre))
    tiles = list(nearest_tiles([finest[::4], finest[::2], finest], LOOKED_AT))
    shapes = [shapely.Polygon(xy(tile.points)) for tile in tiles]
    ranked = sorted(
        ((overlap(shape, goal), k) for k, shape in enumerate(shapes) if shape.is_valid and shape.area > 0), reverse=True
    )
    placed = [(tiles[k], *best_placed(tiles[k].points, goal)) for _, k in ranked[:PLACED]]
    return max(placed, key=lambda found: found[2])


def peer(outline: Complexes) -> tuple[Fitted, Complexes]:
    """The peer's result, and its tile about the mean of the outline's points."""
    begin = time.process_time()
    tile, points, share = nearest_tile(outline)
    return Fitted(tile.template, share, time.process_time() - begin), points


# --- ours --------------------------------------------------------------------------------------------------------


def ours(outline: Complexes) -> Fitted | None:
    """Our result: all groups, the best tile of all; None as long as there is no `vt.fit`."""
    fit: Callable[..., Any] | None = getattr(vt, "fit", None)
    if fit is None:
        return None
    begin = time.process_time()
    best = fit(outline, keep=1)[0]
    return Fitted(best.group, best.overlap, time.process_time() - begin)


# --- tables ------------------------------------------------------------------------------------------------------


def report(names: list[str], folder: Path, pictures: Path | None) -> None:
    """Print what was found for each icon, and the medians first."""
    rows: dict[str, tuple[Fitted | None, Fitted]] = {}
    for name in names:
        outline = outline_of(folder / f"{name}.svg")
        theirs, tile = peer(outline)
        rows[name] = ours(outline), theirs
        print(name, *rows[name], file=sys.stderr, flush=True)
        if pictures is not None:
            draw(pictures / f"{name}.svg", outline - steps_along(outline, FINEST).mean(), tile)
    columns = ("ours", "eigenvalue method")
    table("Medians of the icons:", "", "overlap, " + columns[0], "overlap, " + columns[1], "CPU s", "CPU s, its")
    for what, some in (("animals", ANIMALS), ("objects", OBJECTS), ("all", [*ANIMALS, *OBJECTS])):
        found = [rows[name] for name in some if name in rows]
        if found:
            print(f"| {what}, {len(found)} | {' | '.join(medians(found))} |")
    table("Each icon:", "icon", "group", "overlap", "CPU s", "type", "overlap", "CPU s")
    for name, (own, other) in rows.items():
        cells = ("-", "-", "-") if own is None else (own.kind, f"{own.overlap:.3f}", f"{own.seconds:.1f}")
        print(f"| {name} | {' | '.join(cells)} | {other.kind} | {other.overlap:.3f} | {other.seconds:.1f} |")


def medians(found: list[tuple[Fitted | None, Fitted]]) -> list[str]:
    """The medians of some icons, as texts: both overlaps, then both times."""
    sides = [[pair[0] for pair in found if pair[0] is not None], [pair[1] for pair in found]]
    texts = []
    for get, form in ((lambda one: one.overlap, ".3f"), (lambda one: one.seconds, ".1f")):
        texts += [format(statistics.median(map(get, side)), form) if side else "-" for side in sides]
    return texts


def draw(file: Path, outline: Complexes, tile: Complexes) -> None:
    """Draw an outline, grey, and a tile, red."""
    file.parent.mkdir(parents=True, exist_ok=True)
    rings = [" ".join(f"{z.real:.2f},{-z.imag:.2f}" for z in ring.tolist()) for ring in (outline, tile)]
    half = SIZE_MM * 0.6
    file.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * half}mm" height="{2 * half}mm" '
        f'viewBox="{-half} {-half} {2 * half} {2 * half}"><polygon points="{rings[0]}" fill="#bbb"/>'
        f'<polygon points="{rings[1]}" fill="none" stroke="red" stroke-width="0.5"/></svg>\n',
        encoding="utf-8",
    )


if __name__ == "__main__":
    main()
