"""Other makers' programs that read our files, each run by a script of its own, and the oracle of what they have read.

The scripts are in tests/readers/programs; each runs in the environment of its program, reads one file with it and
prints the contours that the program has then. What judges them are the exact outlines, sampled from their definition.
"""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock
from typing import Any, Final, NamedTuple

import numpy as np
import shapely
from scipy.optimize import linprog

from helpers.cad import sampled
from helpers.programs import FILES, PIECES, Environment, File, Program
from voronoi_tiles import Design, Job, Tiling
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.paths.paths import Paths

FOLDER: Final = Path(__file__).parents[1] / "readers"
"""Where the programs' scripts and environments are."""

SAMPLES: Final = 256
"""Points for each exact curve; a count. The longest, 10 mm, is 1e-5 mm off its chords."""


class MissingProgramError(Exception):
    """A program, or what runs it, that is not here; says how to get it."""


class ReadingError(Exception):
    """A program that ends with an error; its message is the program's."""

    @property
    def kind(self) -> str:
        """The name of the program's own error."""
        return str(self).strip().splitlines()[-1].partition(":")[0]


@dataclass(frozen=True, eq=False)
class Reading:
    """What a program has read: millimetres, y up.

    `contours` are points, complex128 (n,) each, and `closed` whether the program takes them for closed; with `counted`
    they are the program's own contours, else pieces of a drawing. `entities` counts what it calls what it read. `size`
    (mm) and `area` (mm2) are what it says itself, None where it was not asked.
    """

    version: str
    contours: tuple[Complexes, ...]
    closed: tuple[bool, ...]
    counted: bool
    entities: Mapping[str, int]
    size: tuple[float, float] | None
    area: float | None


def interpreter(environment: Environment) -> list[str]:
    """What runs the scripts of an environment. Raises MissingProgramError."""
    if environment == "own":
        return [sys.executable]
    if environment == "freecad":
        return ["/usr/bin/python3"]
    if environment == "node":
        if not (FOLDER / "node_modules").exists():
            raise MissingProgramError("tests/readers/node_modules is not here: `make readers` installs it")
        return ["node"]
    python = FOLDER / f".venv-{environment}" / "bin" / "python"
    if not python.exists():
        raise MissingProgramError(
            f"{python.parents[1].relative_to(FOLDER.parents[1])} is not here: `make readers` makes it"
        )
    return [str(python)]


def read(program: Program, file: Path) -> Reading:
    """What a program reads of a file.

    Raises MissingProgramError where the program is not here, and ReadingError where it ends with an error.
    """
    words = [*interpreter(program.environment), str(FOLDER / "programs" / program.script), str(file)]
    with TemporaryDirectory() as home:  # as just installed, without anybody's settings
        environment = {**os.environ, "HOME": home, "XDG_RUNTIME_DIR": home}
        done = subprocess.run(
            words, capture_output=True, text=True, check=False, timeout=300, stdin=subprocess.DEVNULL, env=environment
        )
    if done.returncode:
        last = (done.stderr.strip().splitlines() or [""])[-1]
        if last.startswith(("ModuleNotFoundError", "FileNotFoundError", "Skipped")):
            raise MissingProgramError(f"{program.name}: {last}")
        raise ReadingError(f"{program.name}: {done.stderr}")
    found = json.loads(done.stdout.splitlines()[-1])
    contours = (np.array(points, np.float64).reshape(-1, 2) for points in found["contours"])
    return Reading(
        version=found["version"],
        contours=tuple(points[:, 0] + 1j * points[:, 1] for points in contours),
        closed=tuple(found["closed"]),
        counted=found["counted"],
        entities=found["entities"],
        size=None if found["size"] is None else tuple(found["size"]),
        area=found["area"],
    )


@dataclass(frozen=True, eq=False)
class Exact:
    """The exact outlines: points along closed contours, complex128 (n,) each (mm), and the tiles' area (mm2)."""

    contours: tuple[Complexes, ...]
    area: float

    @classmethod
    def of(cls, tiling: Tiling, file: File) -> Exact:
        """The outlines where a file has them: pulled apart, pieces lie as their approximations do, to micrometres."""
        exact = _drawn(tiling, {**file.job, "curves": "exact", "preset": "plain"}, "svg")
        there = _drawn(tiling, file.job, file.suffix)
        contours = []
        for points in sampled(exact, SAMPLES):
            shifts = there.start - _sharpest(points)  # no approximation moves the corners of a tile
            contours.append(points + shifts[np.abs(shifts).argmin()])
        return cls(tuple(contours), sum(tile.area for tile in tiling.tiles))


def _sharpest(points: Complexes) -> complex:
    """The corner of a closed contour at which it turns the most."""
    ring = points[points != np.roll(points, -1)]
    turn = np.angle((np.roll(ring, -1) - ring) / (ring - np.roll(ring, 1)))
    return complex(ring[np.abs(turn).argmax()])


def _drawn(tiling: Tiling, job: Mapping[str, Any], form: str) -> Paths:
    """The paths of a product."""
    drawing = tiling.make(Job(**job), form).drawing
    return Paths.concatenate([layer.paths for layer in drawing.layers])


class Verdict(NamedTuple):
    """How what was read differs from the exact outlines.

    `deviation` is the Hausdorff distance of the curves in millimetres, wherever on the page they are, infinite where
    contours are lost or the size is another; `scale` the size of what was read over the true one, 0 for nothing;
    `mirrored` whether it is the mirror image. `drawn` contours are in the file, `contours` are those read, None where a
    program has none, and `loose` how many of them are not closed. `size` (mm) and `area` (of the true one) are by how
    much what the program says of them is too large, None where it says nothing.
    """

    deviation: float
    scale: float = 0.0
    mirrored: bool = False
    drawn: int = 0
    contours: int | None = 0
    loose: int = 0
    size: float | None = None
    area: float | None = None


def judge(reading: Reading, exact: Exact) -> Verdict:
    """Hold what was read against the exact outlines."""
    if not reading.contours:
        return Verdict(math.inf, drawn=len(exact.contours))
    found = [
        np.append(points, points[:1]) if closed else points
        for points, closed in zip(reading.contours, reading.closed, strict=True)
    ]
    size, true_size = _size(found), _size(exact.contours)
    scale = abs(size) / abs(true_size)
    # Where contours are lost or everything is of another size, a distance would say nothing.
    alike = abs(scale - 1) < 0.01 and (not reading.counted or len(found) == len(exact.contours))
    straight = _deviation(found, exact.contours) if alike else math.inf
    excess = None if reading.size is None else np.subtract(reading.size, (true_size.real, true_size.imag))
    return Verdict(
        deviation=straight,
        scale=scale,
        mirrored=0.1 < straight < math.inf
        and _deviation([points.conjugate() for points in found], exact.contours) < 0.1,
        drawn=len(exact.contours),
        contours=len(found) if reading.counted else None,
        loose=len(found) - sum(reading.closed) if reading.counted else 0,
        size=None if excess is None else float(excess[np.abs(excess).argmax()]),
        area=None if reading.area is None else reading.area / exact.area - 1,
    )


class Files:
    """The files of FILES, written into a folder when they are asked for, and the outlines to hold them against."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._tiling = Design.loads(PIECES).tessellate()
        self._exact: dict[str, Exact] = {}
        self._lock = Lock()

    def exact(self, name: str) -> Exact:
        """The outlines of a file, which is written with them."""
        with self._lock:
            if name not in self._exact:
                self._tiling.export(self._place(name), job=Job(**FILES[name].job))
                self._exact[name] = Exact.of(self._tiling, FILES[name])
            return self._exact[name]

    def judged(self, program: Program, name: str) -> tuple[str, Verdict]:
        """The version of a program, and what it makes of a file. Raises MissingProgramError and ReadingError."""
        exact = self.exact(name)
        reading = read(program, self._place(name))
        return reading.version, judge(reading, exact)

    def _place(self, name: str) -> Path:
        return self._folder / f"{list(FILES).index(name)}.{FILES[name].suffix}"


def _deviation(found: Sequence[Complexes], exact: Sequence[Complexes]) -> float:
    """The Hausdorff distance of curves, moved onto each other so that it is the least."""
    moved = [points - _corner(found) for points in found]
    true = [points - _corner(exact) for points in exact]
    reached = math.inf
    for _ in range(3):
        there, across = _differences(moved, true)
        back, across_back = _differences(true, moved)
        differences, normal = np.concatenate((there, -back)), np.concatenate((across, across_back))
        reached = min(reached, float(np.abs(differences).max()))
        # The least t such that no signed distance r, less the share of the shift that goes that way, is beyond t.
        # Every eighth will do: it is the shift that is sought.
        r = (differences * normal.conjugate()).real[::8]
        rows = np.column_stack((normal.real, normal.imag))[::8]
        ones = np.ones((len(rows), 1))
        above, below = np.hstack((-rows, -ones)), np.hstack((rows, -ones))
        solved = linprog((0.0, 0.0, 1.0), np.vstack((above, below)), np.concatenate((-r, r)), bounds=(None, None))
        moved = [points - complex(*solved.x[:2]) for points in moved]
    return reached


def _corner(curves: Sequence[Complexes]) -> complex:
    """The lower left corner of curves."""
    points = np.concatenate(curves)
    return complex(points.real.min(), points.imag.min())


def _size(curves: Sequence[Complexes]) -> complex:
    """The width and height of curves."""
    points = np.concatenate(curves)
    return complex(points.real.max(), points.imag.max()) - _corner(curves)


def _differences(points: Sequence[Complexes], curves: Sequence[Complexes]) -> tuple[Complexes, Complexes]:
    """From the nearest place of the curves to each point, and the unit normal of the curve there."""
    dots = np.concatenate(points)
    ends = [np.column_stack((curve[:-1], curve[1:])) if len(curve) > 1 else curve[[[0, 0]]] for curve in curves]
    start, end = np.concatenate(ends).T
    chords = shapely.STRtree(shapely.linestrings(np.stack((start, end), axis=1).view(np.float64).reshape(-1, 2, 2)))
    _, nearest = chords.query_nearest(shapely.points(dots.real, dots.imag), all_matches=False)
    along = (end - start)[nearest]
    length = np.maximum(np.abs(along), np.finfo(float).tiny)
    along /= length
    from_start = dots - start[nearest]
    share = np.clip((from_start * along.conjugate()).real, 0.0, length)
    return from_start - share * along, 1j * along
