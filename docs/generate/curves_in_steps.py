"""How good 12 or 24 segments are for a curve: python docs/generate/curves_in_steps.py --curves 40.

A cubic is drawn within 1e-6 mm, and once more with as many segments as the paper takes, equal in the parameter; how far
the outlines of the two tiles lie apart is measured.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from itertools import count

import numpy as np
import shapely
from in_blocks import in_blocks
from numpy.typing import NDArray
from random_sites import random_design

import voronoi_tiles as vt
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.tessellation import tessellate

STEPS = (12, 24)
"""Segments that a curve is drawn with; counts."""

FINE = 1e-6
"""Within what the curve is drawn that they are compared with; mm."""

KERF = 0.1
"""What a laser takes away, or less: what is more than this apart can be seen in the wood; mm."""

SEED = 2027

GROUPS = ("p2", "pgg", "p4", "p6")
"""Groups that leave the outline free, in turns."""

_CHORDS, _SPACING = 1e-4, 0.1
"""Within what outlines are flattened to be compared, and how far the points are apart that are; mm."""


@dataclass(frozen=True)
class Apart:
    """A random curve: its number, its group, and how far its tile's outline is from those of STEPS; mm."""

    number: int
    group: str
    distance: tuple[float, ...]


def measure(number: int) -> Apart:
    """The distances for a random curve, one that keeps apart from its copies, in steps as well."""
    group = GROUPS[number % len(GROUPS)]
    for attempt in count():
        design = random_design(group, 2, np.random.default_rng([SEED, number, attempt]))
        (stroke,) = design["site"][0]["strokes"]
        control = np.array(stroke["bezier"]) @ (1, 1j)
        try:
            stepped = [_outline(design, [{"polyline": _in_steps(control, steps)}]) for steps in STEPS]
            exact = _outline(design, [stroke])  # the last, as it takes longest
        except vt.TouchingCopiesError:
            continue
        return Apart(number, group, tuple(hausdorff(exact, outline) for outline in stepped))
    raise AssertionError


def curves_in_steps(curves: int) -> list[Apart]:
    """The distances of so many random curves, on all cores; the same whatever their number."""
    return in_blocks(measure, range(curves))


def hausdorff(one: Outline, other: Outline) -> float:
    """How far a point of either outline is from the other one, at most (Hausdorff's distance); mm."""
    rings = [shapely.segmentize(outline.to_shapely(accuracy=_CHORDS).boundary, _SPACING) for outline in (one, other)]
    farthest = 0.0
    for here, there in (rings, rings[::-1]):
        corners = shapely.get_coordinates(there)
        sides = np.stack((corners[:-1], corners[1:]), axis=1)
        parts = np.cumsum([len(ring.coords) for ring in getattr(there, "geoms", [there])])[:-1]
        tree = shapely.STRtree(shapely.linestrings(np.delete(sides, parts - 1, axis=0)))
        points = shapely.points(shapely.get_coordinates(here))
        farthest = max(farthest, float(tree.query_nearest(points, return_distance=True, all_matches=False)[1].max()))
    return farthest


def _outline(design: dict[str, object], strokes: list[dict[str, object]]) -> Outline:
    """The outline of the tile of other strokes, without the proof, which takes seconds for thousands of segments."""
    site = {"tolerance": FINE, "strokes": strokes}
    made = vt.Design.from_dict({**design, "site": [site]})
    (tile,) = tessellate(made.noded, made.group, made.lattice)
    return tile.outline


def _in_steps(control: NDArray[np.complex128], steps: int) -> list[list[float]]:
    """A cubic at equal steps of its parameter (Bernstein's polynomials)."""
    t = np.linspace(0.0, 1.0, steps + 1)[:, None]
    points = (np.hstack(((1 - t) ** 3, 3 * (1 - t) ** 2 * t, 3 * (1 - t) * t**2, t**3)) * control).sum(axis=1)
    return [[z.real, z.imag] for z in points.tolist()]


def describe(found: list[Apart]) -> str:
    """The figures as lines, for each number of steps; mm."""
    lines = []
    for steps, distance in zip(STEPS, np.array([row.distance for row in found]).T, strict=True):
        worst = found[int(distance.argmax())]
        lines.append(
            f"{steps} segments: the outlines of {len(found):,} curves are {np.median(distance):.4f} mm apart in the "
            f"median, {np.quantile(distance, 0.95):.4f} mm at 95 %, {distance.max():.3f} mm at most (curve "
            f"{worst.number}, {worst.group}); more than {KERF} mm in {int((distance > KERF).sum()):,}"
        )
    return "\n".join(lines)


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--curves", type=int, default=1000, help="random curves (default: 1000)")
    print(describe(curves_in_steps(parser.parse_args().curves)))


if __name__ == "__main__":
    main()
