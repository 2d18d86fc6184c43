"""Whether drawings are read as Chromium draws them: icons of others, and drawings made at random.

Icons come from packages of npm, pinned, fetched into a temporary folder. Each is opened in Chromium, through
playwright; of every shape that it draws points are taken at equal steps (getTotalLength, getPointAtLength,
getScreenCTM) and compared with what `read_drawing` makes of the same file: how far they lie from its curves, whether
these are longer than the points tell, and the colours. Drawings made at random (drawings.py) declare paint, transforms
and geometry in attributes, styles and style sheets, in nested drawings and switches; there too every shape is compared.

    python bench/chromium.py                    300 icons, 100 drawings, 1,000 colours
    python bench/chromium.py --write            the same, into bench/README.md
    python bench/chromium.py --seed 7 --icons 0 --drawings 2000

It needs `pip install playwright`, `apt-get install chromium`, and npm. Where one of them is missing it says so and
ends; with VORONOI_TILES_REQUIRE_CHROMIUM=1 that is a failure. So is a shape farther away than 0.01 user units.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import random
import shutil
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import shapely
from drawings import any_colour, any_drawing
from report import machine, published, table

from voronoi_tiles.formats.reading import DrawingError, read_drawing
from voronoi_tiles.formats.svg.lengths import PIXEL
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths

PACKAGES = (
    "lucide-static@1.62.0",
    "@tabler/icons@3.52.0",
    "bootstrap-icons@1.13.2",
    "@mdi/svg@7.4.47",
    "simple-icons@16.37.0",
    "feather-icons@4.29.2",
)
NEAR = 0.01
"""How far the curves may lie apart; user units, those of the shape where its transforms enlarge it."""

POINTS = 250
"""How many points of a shape Chromium is asked for, at equal steps of its length; it counts anew each time."""

# Every shape that is drawn: its colours in eight bits, whether a user can see it, and its points on the screen.
SHAPES = """(count) => {
    const pixel = document.createElementNS('http://www.w3.org/1999/xhtml', 'canvas').getContext('2d');
    const shown = (paint) => {
        if (paint === 'none') return null;
        if (paint.startsWith('url') || paint.startsWith('context')) return paint;
        pixel.clearRect(0, 0, 1, 1);
        pixel.fillStyle = paint;
        pixel.fillRect(0, 0, 1, 1);
        const [r, g, b, a] = pixel.getImageData(0, 0, 1, 1).data;
        return a === 0 ? null : [r, g, b];
    };
    const root = document.documentElement;
    const toUser = root.getScreenCTM().inverse();
    const found = [];
    for (const element of root.querySelectorAll('path, rect, circle, ellipse, line, polyline, polygon')) {
        const style = getComputedStyle(element);
        if (element.closest('defs, symbol, clipPath, mask, marker, pattern') || !element.checkVisibility()) continue;
        if (style.visibility !== 'visible') continue;
        const stroke = shown(style.stroke), fill = shown(style.fill);
        const total = element.getTotalLength();
        const matrix = element.getScreenCTM();
        if ((stroke === null && fill === null) || !(total > 0) || matrix === null) continue;
        const map = toUser.multiply(matrix);
        if (map.a * map.d - map.b * map.c === 0) continue;
        const points = [];
        for (let k = 0; k <= count; k++) {
            const point = element.getPointAtLength(total * k / count).matrixTransform(map);
            points.push(point.x, point.y);
        }
        const scale = Math.max(1, Math.hypot(map.a, map.b, map.c, map.d));
        found.push({name: element.id, stroke, fill, scale, points});
    }
    return found;
}"""
BOX = """() => {
    const box = document.documentElement.viewBox.baseVal;
    return box && [box.x, box.y, box.width, box.height];
}"""
COLOURS = """(texts) => {
    const pixel = document.createElement('canvas').getContext('2d', {willReadFrequently: true});
    const style = document.body.style;
    return texts.map((text) => {
        style.color = '';
        style.color = text;
        if (!style.color) return null;
        pixel.clearRect(0, 0, 1, 1);
        pixel.fillStyle = getComputedStyle(document.body).color;
        pixel.fillRect(0, 0, 1, 1);
        return [...pixel.getImageData(0, 0, 1, 1).data];
    });
}"""


class Difference(NamedTuple):
    """What two readers of a file make of it."""

    shapes: int
    far: float  # user units
    reason: str  # "" where they agree


def main() -> None:
    """Compare, and print the tables; a failure where anything differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--icons", type=int, default=300, help="icons in all")
    parser.add_argument("--drawings", type=int, default=100, help="drawings made at random")
    parser.add_argument("--colours", type=int, default=1000, help="colours made at random")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--write", action="store_true", help="put the tables into README.md")
    arguments = parser.parse_args()
    missing = [name for name in ("chromium", "npm") if shutil.which(name) is None]
    if importlib.util.find_spec("playwright") is None:
        missing.append("playwright")
    if missing:
        print(f"{', '.join(missing)} missing: nothing is compared with Chromium.", file=sys.stderr)
        sys.exit(os.environ.get("VORONOI_TILES_REQUIRE_CHROMIUM") == "1")
    with published("chromium", write=arguments.write), tempfile.TemporaryDirectory() as folder:
        wrong = compare(Path(folder), arguments)
    for line in wrong[:40]:
        print(line, file=sys.stderr)
    sys.exit(bool(wrong))


def compare(folder: Path, arguments: argparse.Namespace) -> list[str]:
    """Print the tables; gives what differs."""
    from playwright.sync_api import sync_playwright

    generator = random.Random(arguments.seed)
    wrong: list[str] = []
    with sync_playwright() as play:
        browser = play.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1000, "height": 1000})
        print(f"{machine()}; Chromium {browser.version}")
        table("Drawings, as Chromium draws them:", "files", "shapes", "farthest, user units", "differ", "from")
        each = -(-arguments.icons // len(PACKAGES))
        for package in PACKAGES if each else ():
            files = icons(package, folder, generator, each)
            wrong += row(package, [(file, difference(page, file, strict=True)) for file in files])
        made = []
        for number in range(arguments.drawings):
            file = folder / f"{number}.svg"
            file.write_text(any_drawing(generator), encoding="utf-8")
            made.append((file, difference(page, file, strict=False)))
        wrong += row(f"made at random, seed {arguments.seed}", made)
        wrong += colours(page, [any_colour(generator) for _ in range(arguments.colours)])
        browser.close()
    return wrong


def icons(package: str, folder: Path, generator: random.Random, count: int) -> list[Path]:
    """Some icons of a package of npm, unpacked."""
    npm = shutil.which("npm") or "npm"
    done = subprocess.run([npm, "pack", "--silent", package], cwd=folder, check=True, capture_output=True, text=True)  # noqa: S603 - packages of PACKAGES
    target = folder / package.replace("/", "-")
    with tarfile.open(folder / done.stdout.split()[-1]) as archive:
        members = [member for member in archive.getmembers() if member.isfile() and member.name.endswith(".svg")]
        # Sprites hold thousands.
        chosen = generator.sample(sorted((m for m in members if m.size < 20_000), key=lambda m: m.name), count)
        archive.extractall(target, chosen, filter="data")
    return [target / member.name for member in chosen]


def row(name: str, results: Sequence[tuple[Path, Difference]]) -> list[str]:
    """Print a row; gives what differs."""
    differing = [f"{file}: {result.reason}" for file, result in results if result.reason]
    shapes = sum(result.shapes for _, result in results)
    far = max((result.far for _, result in results), default=0.0)
    print(f"| {len(results)} | {shapes} | {far:.1g} | {len(differing)} | {name} |")
    return differing


def difference(page: Any, file: Path, *, strict: bool) -> Difference:
    """Chromium's shapes beside ours."""
    page.goto(file.as_uri())
    theirs = page.evaluate(SHAPES, POINTS)
    box = page.evaluate(BOX)
    try:
        drawing = read_drawing(file)
    except DrawingError as error:
        return Difference(len(theirs), 0.0, str(error))
    if drawing.ignored and strict:
        return Difference(len(theirs), 0.0, f"not read: {drawing.ignored}")
    assert drawing.width is not None
    assert drawing.height is not None
    x, y, across, down = box if box and box[2] else (0.0, 0.0, drawing.width / PIXEL, drawing.height / PIXEL)
    unit = min(drawing.width / across, drawing.height / down)  # of the user, by xMidYMid
    left = (drawing.width - unit * across) / 2
    top = (drawing.height - unit * down) / 2
    ours = []
    for shape in drawing.shapes:
        lines = [
            complex(x, y) + ((line.real - left) + 1j * (drawing.height - top - line.imag)) / unit
            for line in sampled(shape.paths, NEAR * unit)
        ]
        ours.append((shape.stroke, shape.fill, lines))
    if len(ours) != len(theirs):
        return Difference(len(theirs), 0.0, f"{len(ours)} shapes, Chromium draws {len(theirs)}")
    worst = 0.0
    for number, ((stroke, fill, lines), their) in enumerate(zip(ours, theirs, strict=True)):
        for name, mine in (("stroke", stroke), ("fill", fill)):
            if not alike(mine, their[name]):
                return Difference(len(theirs), worst, f"shape {number}: {name} {mine}, Chromium {their[name]}")
        points = np.array(their["points"]).reshape(-1, 2)
        far = apart(lines, points) / their["scale"]
        worst = max(worst, far)
        if far > NEAR:
            return Difference(len(theirs), worst, f"shape {number}: {far:.3g} user units apart")
    return Difference(len(theirs), worst, "")


def alike(mine: str | None, theirs: Any) -> bool:
    """Whether two colours are the same, but for one step of rounding a channel."""
    if mine is None or theirs is None or isinstance(theirs, str):
        return (mine is None) == (theirs is None)
    channels = bytes.fromhex(mine[1:])
    return all(abs(a - b) <= 1 for a, b in zip(channels, theirs, strict=True))


def apart(lines: Sequence[Any], points: Any) -> float:
    """How far Chromium's points lie from our curves; infinite where our curves are longer than its points tell.

    Hardly any two neighbours of its points are farther apart than `between`. Paths shorter than that may have none.
    """
    ours = [np.column_stack((line.real, line.imag)) for line in lines]
    tree = shapely.STRtree(shapely.linestrings(np.concatenate([np.stack((p[:-1], p[1:]), axis=1) for p in ours])))
    there = tree.query_nearest(shapely.points(points), return_distance=True, all_matches=False)[1].max()
    between = float(np.quantile(np.hypot(*np.diff(points, axis=0).T), 0.98))
    cloud = shapely.STRtree(shapely.points(points))
    for line in ours:
        here = cloud.query_nearest(shapely.points(line), return_distance=True, all_matches=False)[1]
        if np.hypot(*np.diff(line, axis=0).T).sum() > 2 * between and here.max() > 2 * between + NEAR:
            return float("inf")
    return float(there)


def sampled(paths: Paths, step: float) -> Iterator[Any]:
    """Points of every path, `step` apart at most, by the definitions of its curves."""
    for first, last in zip(paths.offsets[:-1].tolist(), paths.offsets[1:].tolist(), strict=True):
        parts = []
        for k in range(first, last):
            p, q, (c, d) = paths.start[k], paths.end[k], paths.control[k]
            corners = {LINE: (p, q), CUBIC: (p, c, d, q)}.get(int(paths.kind[k]), (p, c, q))
            rough = float(np.abs(np.diff(corners)).sum())
            t = np.linspace(0.0, 1.0, min(max(int(2 * rough / step), 2), 100_000))
            match int(paths.kind[k]):
                case kind if kind == LINE:
                    points = p + t * (q - p)
                case kind if kind == QUAD:
                    points = (1 - t) ** 2 * p + 2 * t * (1 - t) * c + t**2 * q
                case kind if kind == CUBIC:
                    points = (1 - t) ** 3 * p + 3 * t * (1 - t) ** 2 * c + 3 * t**2 * (1 - t) * d + t**3 * q
                case _:
                    assert paths.kind[k] == ARC
                    w = (q - p) / (c - p)
                    centre = p + (c - p) * (w - abs(w) ** 2) / (2j * w.imag)
                    points = centre + (p - centre) * np.exp(2j * np.angle((c - centre) / (p - centre)) * t)
            parts.append(points)
        yield np.concatenate(parts)


def colours(page: Any, texts: list[str]) -> list[str]:
    """Print how many colours differ, each the stroke of a line; gives those."""
    from voronoi_tiles.formats.svg.reader import svg_drawing

    page.goto("about:blank")
    theirs = page.evaluate(COLOURS, texts)
    wrong, known = [], 0
    for text, colour in zip(texts, theirs, strict=True):
        known += colour is not None
        data = f'<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><path d="M0 0h1" stroke="{text}"/></svg>'
        drawing = svg_drawing(data.encode(), "t.svg")
        (shape,) = drawing.shapes or (None,)
        mine = None if shape is None else shape.stroke
        said = bool(drawing.ignored)
        if colour is None:
            fine = mine is not None and said  # visible, and named
        else:
            fine = alike(mine, colour[:3] if colour[3] else None) and not said
        if not fine:
            wrong.append(f"{text}: {mine} {'(said)' if said else ''}, Chromium {colour}")
    table("Colours:", "colours", "known to Chromium", "differ")
    print(f"| {len(texts)} | {known} | {len(wrong)} |")
    return wrong


if __name__ == "__main__":
    main()
