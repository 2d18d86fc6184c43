"""A loft beside an implicit construction: scikit-image's marching cubes of d_other - d_own on a grid.

The design is a curve of 24 segments in p4 that makes a quarter turn. How far a mesh is from the true walls is measured
at points that are spread evenly over its walls: |d_other - d_own| / 2 is no more than the distance from where both are
alike. The peer's grid is refined until nearly all of its walls, NEAR, is within the accuracy of our loft. The peer's
distances are written here, in numpy, for the nearest copies; they share nothing with the engine. Times are processor
time, ours with the proof.

    pip install scikit-image
    python bench/lofts.py                     the comparison, and the cost of more layers
    python bench/lofts.py --write             also: the tables into bench/README.md
"""

from __future__ import annotations

import argparse
import time
from typing import Any, Final

import numpy as np
from report import machine, published, table

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import Complexes, Floats, Ints
from voronoi_tiles.solid.solid_proof import proved_loft

A: Final = 60.0
HEIGHT: Final = 40.0
TURN: Final = 90.0
CENTRE: Final = 21 + 19j
ACCURACY: Final = 0.05
"""Millimetres."""

STEPS: Final = (1.0, 0.5, 0.25, 0.18)
"""Distances between the points of the peer's grids; millimetres."""

NEAR: Final = 0.999
"""How much of the peer's walls has to be within the accuracy; a share."""

POINTS: Final = 50_000
"""How many points of a mesh are looked at; a count."""

LAYERS: Final = (25, 50, 100, 200, 400)
CURVE: Final[Complexes] = CENTRE + np.linspace(-11, 11, 25) + 1j * 4 * np.sin(np.linspace(0, 2 * np.pi, 25))
"""The stroke at the bottom."""


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="put the tables into bench/README.md")
    with published("solids", write=parser.parse_args().write):
        print(machine())
        loft(25)  # what is imported at the first is not counted
        compared()
        grown()


def compared() -> None:
    """Print a row for our lofts, and for each grid of the peer until one is near."""
    table(
        "A quarter turn of a curve of 24 segments:", "construction", "CPU s", "triangles", "within 0.05 mm", "99 %, mm"
    )
    row("loft of 100 layers at least", *loft(100))
    row("loft", *loft(2))
    for step in STEPS:
        begun = time.process_time()
        vertices, triangles = marching_cubes(step)
        seconds = time.process_time() - begun
        if row(f"marching cubes, {step:g} mm", vertices, triangles, seconds) >= NEAR:
            return
    print("\nNo grid is near.")


def grown() -> None:
    """Print the cost of lofts by their layers."""
    table("\nOurs, by layers, of which there are so many at least:", "layers", "CPU s", "triangles")
    for layers in LAYERS:
        _, triangles, seconds = loft(layers)
        print(f"| {layers} | {seconds:.2f} | {len(triangles)} |", flush=True)


def row(name: str, vertices: Floats, triangles: Ints, seconds: float) -> float:
    """Print how near a mesh is; the share of its walls that is within the accuracy."""
    corners = vertices[triangles]
    middle = corners.mean(axis=1)[:, 2]
    corners = corners[(middle > 1e-6) & (middle < HEIGHT - 1e-6)]
    a, b, c = np.moveaxis(corners, 1, 0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    rng = np.random.default_rng(1)
    chosen = rng.choice(len(area), POINTS, p=area / area.sum())
    walls = (rng.dirichlet((1.0, 1.0, 1.0), POINTS)[:, :, None] * corners[chosen]).sum(axis=1)
    off = np.concatenate([np.abs(difference(part[:, 0] + 1j * part[:, 1], part[:, 2])) / 2 for part in parts(walls)])
    share = float((off <= ACCURACY).mean())
    print(f"| {name} | {seconds:.2f} | {len(triangles)} | {share:.2%} | {np.quantile(off, 0.99):.3f} |", flush=True)
    return share


def parts(rows: Floats) -> list[Floats]:
    """Rows in portions whose distances fit into memory."""
    return np.array_split(rows, len(rows) // 20_000 + 1)


def loft(layers: int) -> tuple[Floats, Ints, float]:
    """Vertices, triangles, and seconds of processor time."""
    begun = time.process_time()
    solid = vt.Solid(HEIGHT, layers=layers, turn=TURN, about=CENTRE)
    made, _ = proved_loft(vt.Design("p4", A, vt.Site([vt.polyline(CURVE)]), solid=solid), accuracy=ACCURACY)
    (mesh,) = made.meshes
    return mesh.vertices, mesh.triangles, time.process_time() - begun


def difference(place: Complexes, z: Floats) -> Floats:
    """How much nearer the stroke is than the nearest of its copies, at points and heights: float64 (n,)."""
    # The same in the frame that turns with the stroke; copies are turned the same way, about centres of their own.
    turned = np.exp(1j * np.radians(TURN) * z / HEIGHT)
    own = distance((place - CENTRE) / turned)
    others = np.full(len(place), np.inf)
    for quarter in range(4):
        for m in range(-1, 3):
            for n in range(-1, 3):
                centre = 1j**quarter * CENTRE + A * (m + 1j * n)
                if centre != CENTRE and abs(centre - CENTRE) < 1.5 * A:
                    np.minimum(others, distance((place - centre) / (turned * 1j**quarter)), out=others)
    return np.asarray(others - own)


def distance(place: Complexes) -> Floats:
    """Distances from the stroke about 0, as it is at the bottom: float64 (n,)."""
    least = np.full(len(place), np.inf)
    line = CURVE - CENTRE
    for start, end in zip(line[:-1].tolist(), line[1:].tolist(), strict=True):
        along = np.clip(((place - start) * (end - start).conjugate()).real / abs(end - start) ** 2, 0.0, 1.0)
        np.minimum(least, np.abs(place - start - along * (end - start)), out=least)
    return least


def marching_cubes(step: float) -> tuple[Floats, Ints]:
    """The peer's mesh of the tile's walls; its ends, at which it is open, are left out."""
    from skimage import measure

    surface: Any = measure.marching_cubes
    side = np.arange(-0.75 * A, 0.75 * A, step)
    heights = np.linspace(0.0, HEIGHT, round(HEIGHT / step) + 1)
    plane = (CENTRE + side[:, None] + 1j * side).ravel()
    field = np.stack([difference(plane, np.full(len(plane), z)).reshape(len(side), -1) for z in heights], axis=-1)
    spacing = (step, step, HEIGHT / (len(heights) - 1))
    vertices, triangles, _, _ = surface(field, 0.0, spacing=spacing)
    return vertices + np.array([CENTRE.real + side[0], CENTRE.imag + side[0], 0.0]), triangles.astype(np.intp)


if __name__ == "__main__":
    main()
