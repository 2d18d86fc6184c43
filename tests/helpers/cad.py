"""Others' programs that read our files, headless, and what judges the curves that they read.

Nothing here shares code with the writers: a path is sampled from its definition, an arc from the circle through its
three points.
"""

from __future__ import annotations

import io
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
import shapely
import svgelements

from voronoi_tiles import Design
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths

EXAMPLES = Path(__file__).parents[2] / "examples"

MM_PER_PX = 25.4 / 96
A4_HEIGHT = 297.0  # Inkscape's importer places a drawing upon a page of this height

# Debian's own interpreter, which has the modules of Inkscape's extensions, comes first.
_ENVIRONMENT = {**os.environ, "PATH": "/usr/bin:/bin", "QT_QPA_PLATFORM": "offscreen"}


def missing(reason: str) -> None:
    """Leave the test out, with a reason; VORONOI_TILES_REQUIRE_CAD=1 makes it fail."""
    if os.environ.get("VORONOI_TILES_REQUIRE_CAD") == "1":
        pytest.fail(reason)
    pytest.skip(reason)


def run(*command: str, cwd: Path | None = None, home: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run a program of the system, at most a minute."""
    if shutil.which(command[0], path=_ENVIRONMENT["PATH"]) is None:
        missing(f"{command[0]} is not installed")
    environment = _ENVIRONMENT if home is None else {**_ENVIRONMENT, "HOME": str(home), "XDG_RUNTIME_DIR": str(home)}
    return subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
        cwd=cwd,
        env=environment,
        stdin=subprocess.DEVNULL,
    )


def inkscape_reads_dxf(file: Path) -> dict[str, list[tuple[Complexes, bool]]]:
    """What Inkscape's importer makes of a DXF file: for each layer its curves in millimetres, and whether closed.

    The importer is run by itself: Inkscape would open a window to ask for its options.
    """
    folder = run("inkscape", "--system-data-directory").stdout.strip()
    importer = Path(folder) / "extensions" / "dxf_input.py"
    done = run("python3", str(importer), str(file))
    if "ModuleNotFoundError" in done.stderr:
        missing(f"Inkscape's importer of DXF lacks a module: {done.stderr.splitlines()[-1]}")
    assert done.returncode == 0, done.stderr
    return curves_of_svg(done.stdout, A4_HEIGHT)


def inkscape_reads_pdf(file: Path, height: float) -> dict[str, list[tuple[Complexes, bool]]]:
    """What Inkscape makes of a PDF file, in millimetres from the lower left corner of a page of this height."""
    target = file.with_suffix(".inkscape.svg")
    done = run(
        "inkscape", "--pdf-poppler", "--export-type=svg", f"--export-filename={target}", str(file), home=file.parent
    )
    assert target.exists(), done.stderr
    return curves_of_svg(target.read_text(encoding="utf-8"), height)


def librecad_reads_dxf(file: Path) -> list[Complexes]:
    """The polylines that LibreCAD prints of a DXF file, millimetres from the lower left corner.

    It prints in full size, on a raster of 1200 dots per inch whatever its options say.
    """
    settings = file.parent / ".config" / "LibreCAD" / "LibreCAD.conf"
    settings.parent.mkdir(parents=True, exist_ok=True)
    # Without these it waits for an answer, and takes a drawing without a unit for a point.
    settings.write_text("[Startup]\nFirstLoad=false\n[Defaults]\nUnit=Millimeter\n")
    done = run("librecad", "dxf2pdf", file.name, cwd=file.parent, home=file.parent)
    printed = file.with_suffix(".pdf")
    assert printed.exists(), done.stderr
    picture = file.with_suffix(".librecad.svg")
    run("pdftocairo", "-svg", str(printed), str(picture))
    document = svgelements.SVG.parse(str(picture), reify=True, ppi=96)
    height = float(document.height) * MM_PER_PX
    return [points for points, _ in _curves(document, height)]


def curves_of_svg(text: str, height: float) -> dict[str, list[tuple[Complexes, bool]]]:
    """The curves of each layer (Inkscape's label) of an SVG text, millimetres, y up from the bottom of the page."""
    document = svgelements.SVG.parse(io.StringIO(text), reify=True, ppi=96)
    found: dict[str, list[tuple[Complexes, bool]]] = {}

    def visit(group: svgelements.Group, layer: str) -> None:
        for element in group:
            if isinstance(element, svgelements.Group) and not isinstance(element, svgelements.Use):
                label = element.values.get("{http://www.inkscape.org/namespaces/inkscape}label", layer)
                visit(element, label or layer)
            elif isinstance(element, svgelements.Path):
                found.setdefault(layer, []).extend(_curve(element, height))

    visit(document, "")
    return found


def _curves(document: svgelements.SVG, height: float) -> list[tuple[Complexes, bool]]:
    return [
        curve
        for element in document.elements(lambda e: isinstance(e, svgelements.Path))
        for curve in _curve(element, height)
    ]


def _curve(path: svgelements.Path, height: float) -> list[tuple[Complexes, bool]]:
    """The subpaths of a path, sampled."""
    curves = []
    for part in path.as_subpaths():
        pieces = [piece for piece in part if not isinstance(piece, svgelements.Move)]
        if not pieces:
            continue
        closed = isinstance(pieces[-1], svgelements.Close)
        points = [_complex(part[0].end)]
        for piece in pieces:
            if isinstance(piece, svgelements.Line | svgelements.Close):
                points.append(_complex(piece.end))
            else:
                points += [_complex(piece.point(k / 64)) for k in range(1, 65)]
        array = np.array(points) * MM_PER_PX
        curves.append((array.real + 1j * (height - array.imag), closed))
    return curves


def _complex(point: svgelements.Point) -> complex:
    return complex(point.x, point.y)


def sampled(paths: Paths, count: int = 64) -> list[Complexes]:
    """Points along every path, `count` and the end for each curve."""
    t = np.linspace(0.0, 1.0, count + 1)
    found = []
    for first, last in zip(paths.offsets[:-1].tolist(), paths.offsets[1:].tolist(), strict=True):
        parts = [paths.start[first : first + 1]]
        for k in range(first, last):
            a, b, (c, d) = paths.start[k], paths.end[k], paths.control[k]
            match int(paths.kind[k]):
                case 0:
                    part = np.array([a, b])
                case 1:
                    part = a * (1 - t) ** 2 + 2 * c * t * (1 - t) + b * t**2
                case 2:
                    part = a * (1 - t) ** 3 + 3 * c * t * (1 - t) ** 2 + 3 * d * t**2 * (1 - t) + b * t**3
                case _:
                    part = arc_points(a, c, b, t)
            parts.append(part[1:])
        found.append(np.concatenate(parts))
    return found


def arc_points(a: complex, middle: complex, b: complex, t: np.ndarray[tuple[int], np.dtype[np.float64]]) -> Complexes:
    """Points of the arc through three points, the second in the middle of it."""
    turn = 2 * np.angle((b - middle) / (middle - a))
    radius = abs(middle - a) / (2 * np.sin(abs(turn) / 4))
    centre = middle + 1j * np.sign(turn) * radius * (b - a) / abs(b - a)
    return np.asarray(centre + (middle - centre) * np.exp(1j * turn * (t - 0.5)))


def distance(points: Sequence[Complexes], others: Sequence[Complexes]) -> float:
    """The greatest distance of points of the first curves from the other curves."""
    corners = [np.column_stack((line.real, line.imag)) for line in others]
    segments = np.concatenate([np.stack((line[:-1], line[1:]), axis=1) for line in corners])
    tree = shapely.STRtree(shapely.linestrings(segments))
    every = np.concatenate(list(points))
    _, found = tree.query_nearest(shapely.points(every.real, every.imag), return_distance=True, all_matches=False)
    return float(found.max())


def deviation(curves: Sequence[Complexes], others: Sequence[Complexes]) -> float:
    """The greatest distance between two sets of curves, either way."""
    return max(distance(curves, others), distance(others, curves))


def tile(name: str) -> Paths:
    """The outline of an example's first tile, LINE and QUAD pieces, its lower left corner at (5, 5)."""
    outline = Design.load(EXAMPLES / f"{name}.toml").tessellate().tiles[0].outline
    control = np.zeros((len(outline.start), 2), np.complex128)
    control[outline.curved, 0] = outline.control[outline.curved]
    paths = Paths(
        start=outline.start,
        end=outline.end,
        control=control,
        kind=np.where(outline.curved, QUAD, LINE).astype(np.uint8),
        offsets=outline.ring_offsets,
        closed=np.ones(len(outline.ring_offsets) - 1, np.bool_),
    )
    left, bottom, _, _ = paths.bounds
    return paths.moved(1, 5 + 5j - complex(left, bottom))


def as_lines(paths: Paths) -> Paths:
    """The chords of all pieces."""
    return Paths(
        start=paths.start,
        end=paths.end,
        control=np.zeros_like(paths.control),
        kind=np.full(len(paths.start), LINE, np.uint8),
        offsets=paths.offsets,
        closed=paths.closed,
    )


def as_arcs(paths: Paths) -> Paths:
    """Circular arcs in the place of quadratic curves: over the same chords, as high as these at their middle."""
    curved = paths.kind == QUAD
    control = np.zeros_like(paths.control)
    start, end = paths.start[curved], paths.end[curved]
    high = paths.control[curved, 0] - (start + end) / 2
    across = 1j * (end - start) / np.abs(end - start)
    control[curved, 0] = (start + end) / 2 + across * (high / across).real / 2
    return Paths(
        start=paths.start,
        end=paths.end,
        control=control,
        kind=np.where(curved, ARC, LINE).astype(np.uint8),
        offsets=paths.offsets,
        closed=paths.closed,
    )


def ring(kind: int, *, centre: complex = 30 + 20j, radius: float = 10.0, count: int = 6, closed: bool = True) -> Paths:
    """A wavy ring of pieces of one kind, or all but the last of them as an open path."""
    corners = centre + radius * np.exp(2j * np.pi * np.arange(count) / count)
    start, end = corners, np.roll(corners, -1)
    sign = np.where(np.arange(count) % 3 == 0, -0.3, 0.2)
    bulge = (start + end) / 2 - 1j * (end - start) * sign
    control = np.zeros((count, 2), np.complex128)
    if kind == CUBIC:
        control[:, 0], control[:, 1] = bulge, (bulge + end) / 2
    elif kind != LINE:
        control[:, 0] = bulge
    kept = count if closed else count - 1
    return Paths(
        start=start[:kept],
        end=end[:kept],
        control=control[:kept],
        kind=np.full(kept, kind, np.uint8),
        offsets=np.array([0, kept]),
        closed=np.array([closed]),
    )


def drawing(kind: int) -> Drawing:
    """Two pieces, one with a hole, scores that are open, engraving: paths of straight lines and of one other kind."""
    with_hole = Paths.concatenate([ring(kind), ring(kind, radius=4.0, count=5).reversed()])
    cuts = Paths.concatenate([with_hole, ring(kind, centre=70 + 30j, count=9), ring(LINE, centre=50 + 60j)])
    scores = Paths.concatenate(
        [ring(kind, centre=20 + 60j, closed=False), Paths.polylines([[1 + 1j, 99 + 1j, 99 + 79j], [2j, 3 + 2.5j]])]
    )
    return Drawing(
        100.0,
        80.0,
        (
            Layer.of_paths("engrave", "engrave", "#ff0000", 0.025, ring(kind, centre=80 + 60j, radius=5.0)),
            Layer.of_paths("score", "score", "#0000ff", 0.025, scores),
            Layer("cut", "cut", "#000000", 0.025, cuts, np.array([0, 2, 3, 4]), ("a", "b", "c")),
        ),
        title="Türme",
        recipe={"program": "voronoi-tiles", "version": "1.2", "design": '{"name": "<ü>"}'},
    )
