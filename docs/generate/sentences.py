"""The paper's sentences that are about no group: python docs/generate/sentences.py prints what each is judged by."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from curves_in_steps import KERF, STEPS, Apart, curves_in_steps, hausdorff
from numpy.typing import NDArray
from random_sites import CELLS
from running import ROOT

import voronoi_tiles as vt
from voronoi_tiles.groups.periodic_colouring import palette
from voronoi_tiles.raster.image_colouring import colour, neighbours
from voronoi_tiles.raster.scene import Pattern

CURVES = 1000
"""Random curves that are drawn in steps; a count."""

DRAWS = 1_000_000
"""Pairs of random colours; a count."""

NOTICEABLE = 2.3
"""The just noticeable difference of two colours, their distance in CIELAB (Mahy, Van Eycken and Oosterlinck 1994)."""

TILES = 100
"""Tiles of a picture that is thought of; a count."""

SAME = 1e-3
"""Within what outlines count as the same; mm. They are flattened to be compared."""

SEED = 2028

SITES: dict[str, list[dict[str, object]]] = {
    "a point": [{"point": [9, 7]}],
    "a line": [{"segment": [[4, 4], [13, 8]]}],
    "three lines": [{"segment": [[9, 7], end]} for end in ([4, 4], [14, 8], [7, 15])],
    "a cubic curve": [{"bezier": [[4, 4], [10, 1], [14, 6], [6, 16]]}],
    "a circle": [{"circle": [8, 8], "radius": 4}],
}
"""Sites in one piece within one chamber of pmm and cmm, in their cell; mm."""

ANY_STROKES = "examples/paper/claim-any-strokes.toml"
"""The design with strokes that branch, cross and close."""


@dataclass(frozen=True)
class Tiled:
    """The tile of one of SITES: area (mm²), edges, the share that is curved, how far it is from the point's (mm)."""

    name: str
    area: float
    edges: int
    curved: float
    apart: float


def compared_with_a_point(group: str) -> list[Tiled]:
    """The tiles of SITES in a group, each beside that of the point."""
    tiles = [
        vt.Design.from_dict({"schema": 1, "group": group, "cell": CELLS["rectangular"], "site": [{"strokes": strokes}]})
        .tessellate()
        .tiles[0]
        for strokes in SITES.values()
    ]
    return [
        Tiled(
            name,
            tile.area,
            len(tile.outline),
            tile.outline.curved_length / tile.perimeter,
            hausdorff(tile.outline, tiles[0].outline),
        )
        for name, tile in zip(SITES, tiles, strict=True)
    ]


@dataclass(frozen=True)
class Alike:
    """Pseudo-random colours of neighbours, and those of a proper colouring.

    `shares` are the shares of pairs that differ by less than NOTICEABLE, by what is random; `pairs` is how many pairs
    of neighbours there are for each tile; `least` the least difference of neighbours' colours as they are drawn.
    """

    shares: dict[str, float]
    pairs: float
    least: float

    def spoilt(self, share: float) -> float:
        """The share of pictures of TILES tiles with a pair of neighbours that look alike, at least."""
        return float(1.0 - (1.0 - share) ** (self.pairs * TILES))


def alike(draws: int = DRAWS) -> Alike:
    """Draw colours, and look at how the 17 starter designs are coloured."""
    random = np.random.default_rng(SEED).random((2, draws, 3))
    hues = np.concatenate((random[..., :1], np.broadcast_to((0.6, 0.9), (2, draws, 2))), axis=2)
    shares = {
        name: float((difference(*map(from_hsv, pair)) < NOTICEABLE).mean())
        for name, pair in (("hue, saturation and value", random), ("the hue alone", hues))
    }
    least, beside, tiles = np.inf, 0, 0
    for name in vt.GROUPS:
        design = vt.starter(name)
        pattern = Pattern(design.noded, design.group, design.lattice)
        colouring, (pairs, _) = colour(pattern), neighbours(pattern)
        rgb = palette(colouring.count) / 255
        here = colouring.of(np.insert(np.zeros((len(pairs), 2), np.intp), 0, pairs[:, 0], axis=1))
        least = min(least, float(difference(rgb[here], rgb[colouring.of(pairs[:, 1:])]).min()))
        for tile in design.tessellate():
            beside += tile.copies_per_cell * len(tile.outline.neighbours)
            tiles += tile.copies_per_cell
    return Alike(shares, beside / tiles / 2, least)


def from_hsv(hsv: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colours as red, green and blue, from hue, saturation and value (A. R. Smith 1978); all 0 to 1, (n, 3)."""
    sector = np.clip(np.abs((hsv[:, :1] * 6 + (0, 4, 2)) % 6 - 3) - 1, 0, 1)
    return np.asarray(hsv[:, 2:] * (1 + hsv[:, 1:2] * (sector - 1)))


def lab(rgb: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colours of sRGB (IEC 61966-2-1), 0 to 1, in CIELAB under D65: (n, 3)."""
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    matrix = [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
    xyz = linear @ np.array(matrix).T / np.sum(matrix, axis=1)
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz * (29 / 6) ** 2 / 3 + 4 / 29)
    return np.stack((116 * f[:, 1] - 16, 500 * (f[:, 0] - f[:, 1]), 200 * (f[:, 1] - f[:, 2])), axis=1)


def difference(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far colours of sRGB are apart in CIELAB (CIE 1976): (n,)."""
    return np.asarray(np.linalg.norm(lab(one) - lab(other), axis=1))


@dataclass(frozen=True)
class Proved:
    """A tile of ANY_STROKES: its name, its outline's rings and edges.

    `joints` are the points where three strokes or more meet, `worst` the largest figure of the proof, beside the cell.
    """

    name: str
    joints: int
    rings: int
    edges: int
    worst: float


def any_strokes() -> list[Proved]:
    """The tiles of the design whose strokes are no simple curves, all proved."""
    tiling = vt.Design.load(ROOT / ANY_STROKES).tessellate()
    worst = max(value for _, value, limit, _ in tiling.proof.rows() if limit)
    return [
        Proved(
            tile.name,
            int((np.bincount(tile.site.segments.ravel()) > 2).sum()),
            len(tile.outline.rings),
            len(tile.outline),
            worst,
        )
        for tile in tiling
    ]


@dataclass(frozen=True)
class Sentences:
    """What the sentences are judged by; `points` by group."""

    points: Mapping[str, Sequence[Tiled]]
    steps: Sequence[Apart]
    colours: Alike
    strokes: Sequence[Proved]

    @classmethod
    def measured(cls, curves: int = CURVES, draws: int = DRAWS) -> Sentences:
        """Measure them all."""
        points = {group: compared_with_a_point(group) for group in ("pmm", "cmm")}
        return cls(points, curves_in_steps(curves), alike(draws), any_strokes())

    def like_a_point(self, group: str) -> bool:
        """Whether every site has the point's tile in a group: without curves, which no point's tile has."""
        return all(row.curved == 0.0 and row.apart < SAME for row in self.points[group])

    def fine_enough(self, steps: int) -> bool:
        """Whether 95 of 100 curves in so many steps have their tiles' outlines within KERF of the curves' own."""
        distance = [row.distance[STEPS.index(steps)] for row in self.steps]
        return float(np.quantile(distance, 0.95)) <= KERF

    def table(self) -> str:
        """The sentences with their verdicts, as a Markdown table."""
        points = {group: self.like_a_point(group) for group in self.points}
        steps = {f"{count} segments": self.fine_enough(count) for count in STEPS}
        colours = max(map(self.colours.spoilt, self.colours.shares.values())) <= 0.05
        rows = [
            (
                "points",
                "In pmm and cmm there is no difference between sites of higher dimension and single points.",
                _verdict(points, "holds if there is one site, and it lies in one chamber"),
            ),
            (
                "steps",
                "12 or 24 line segments are a good approximation of a curve.",
                _verdict(steps, "holds for cutting"),
            ),
            (
                "colours",
                "Pseudo-random colours in HSV keep neighbours apart.",
                "holds" if colours else f"**wrong** in a picture of {TILES} tiles and more",
            ),
            ("strokes", "Sites are simple 1-manifolds: curves without crossings and branches.", "not needed"),
        ]
        lines = ["| | the sentence, in substance | verdict |", "|---|---|---|"]
        return "\n".join([*lines, *(f"| {' | '.join(row)} |" for row in rows)])

    def points_table(self) -> str:
        """The tiles of SITES in each group as a Markdown table."""
        heads = (f"{group}: mm² | edges | curved | from the point's, mm" for group in self.points)
        lines = [f"| site | {' | '.join(heads)} |", "|---|" + "---:|---:|---:|---:|" * len(self.points)]
        for rows in zip(*self.points.values(), strict=True):
            cells = (f"{row.area:.0f} | {row.edges} | {_percent(row.curved)} | {row.apart:.3f}" for row in rows)
            lines.append(f"| {rows[0].name} | {' | '.join(cells)} |")
        return "\n".join(lines)

    def steps_table(self) -> str:
        """How far outlines of curves in steps are from those of the curves, as a Markdown table; mm."""
        lines = [f"| segments | median | 95 % within | the worst | more than {KERF} |", "|---:|---:|---:|---:|---:|"]
        for steps, distance in zip(STEPS, np.array([row.distance for row in self.steps]).T, strict=True):
            worst = self.steps[int(distance.argmax())]
            lines.append(
                f"| {steps} | {np.median(distance):.3f} | {np.quantile(distance, 0.95):.3f} | {distance.max():.3f} "
                f"(curve {worst.number}, {worst.group}) | {_percent(float((distance > KERF).mean()), 1)} |"
            )
        return "\n".join(lines)

    def colours_table(self) -> str:
        """How often random colours are alike, as a Markdown table."""
        lines = [
            f"| random | pairs of neighbours alike | pictures of {TILES} tiles with such a pair |",
            "|---|---:|---:|",
        ]
        lines += [
            f"| {name} | {_percent(share, 2)} | {_percent(self.colours.spoilt(share))} |"
            for name, share in self.colours.shares.items()
        ]
        return "\n".join(lines)

    def strokes_table(self) -> str:
        """The tiles of ANY_STROKES as a Markdown table."""
        lines = ["| site | joints of three strokes and more | rings of the tile | edges |", "|---|---:|---:|---:|"]
        return "\n".join(
            [*lines, *(f"| `{row.name}` | {row.joints} | {row.rings} | {row.edges} |" for row in self.strokes)]
        )


def _verdict(found: Mapping[str, bool], holding: str) -> str:
    """What is found of a sentence that speaks of several things."""
    wrong, right = ([name for name, holds in found.items() if holds is which] for which in (False, True))
    parts = [f"**wrong for {' and '.join(wrong)}**"] if wrong else []
    parts += [f"for {' and '.join(right)} it {holding}"] if right else []
    return "; ".join(parts)


def _percent(share: float, digits: int = 0) -> str:
    """A share as it is written."""
    return f"{100 * share:.{digits}f} %"


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--curves", type=int, default=CURVES, help=f"random curves (default: {CURVES})")
    found = Sentences.measured(parser.parse_args().curves)
    tables = (found.table, found.points_table, found.steps_table, found.colours_table, found.strokes_table)
    print(*(table() for table in tables), sep="\n\n")
    print(f"\n{found.colours.pairs:.2f} pairs of neighbours a tile, proper colours differ by {found.colours.least:.0f}")


if __name__ == "__main__":
    main()
