"""The oracle of gradients: designs changed by hand, tessellated anew, and what that did to the tiles.

It shares no code with what it judges: numbers are changed in the tables of designs, points of an outline and how far
another one is from them along their normals are its own formulas.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.designs.design import Design
from voronoi_tiles.tiling import Tiling
from voronoi_tiles.vector.outline import Outline

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Ints = NDArray[np.intp]

KINK = 0.01
"""By how much derivatives forth and back may differ where there is one: far more than what curvature does to them."""

UNSTEADY = 3e-7
"""Differences over a step and over twice of it that differ by more say nothing to six digits, nor do such corners;
relative."""

Step = Sequence[tuple[str, float]]
"""Places of numbers in a design file, and by how much each changes."""


def _holder(table: dict[str, Any], name: str) -> tuple[Any, Any]:
    """What holds a number of a table, and its key or index there."""
    holder: Any = table
    *path, last = [int(part) if part.isdigit() else part for part in re.findall(r"\w+", name)]
    for part in path:
        holder = holder[part]
    return holder, last


def value_at(table: dict[str, Any], name: str) -> float:
    """A number of the table of a design."""
    holder, last = _holder(table, name)
    return float(holder[last])


def changed(table: dict[str, Any], step: Step, share: float) -> dict[str, Any]:
    """The table of a design with a share of a step added to its numbers."""
    result: dict[str, Any] = json.loads(json.dumps(table))  # a point that is in it twice is two
    for name, amount in step:
        holder, last = _holder(result, name)
        holder[last] += share * amount
    return result


def tilings_about(table: dict[str, Any], step: Step, share: float) -> tuple[Tiling, Tiling] | None:
    """The tilings of a design a share of a step forth and back; None where a curve is flattened otherwise there."""
    here = Design.from_dict(table)
    found = [Design.from_dict(changed(table, step, sign * share)) for sign in (1.0, -1.0)]
    if any(
        len(mine.segments) != len(its.segments)
        for other in found
        for mine, its in zip(here.noded, other.noded, strict=True)
    ):
        return None
    forth, back = (design.tessellate() for design in found)
    return forth, back


def derivative(table: dict[str, Any], step: Step, measured: Callable[[Tiling], Floats], share: float) -> Floats | None:
    """The derivatives of some measures by a step, to the fourth order; None as in `tilings_about`.

    NaN for a measure that has none: what it does forth is another thing than what it does back, in the first order or,
    as for areas where an edge vanishes, in the second.
    """
    here = measured(Design.from_dict(table).tessellate())
    slopes, bends = [], []
    for part in (share, 2.0 * share):
        pair = tilings_about(table, step, part)
        if pair is None:
            return None
        forth, back = (measured(tiling) for tiling in pair)
        slopes.append((forth - back) / (2.0 * part))
        bends.append((forth - 2.0 * here + back) / part)
    near, far = slopes
    # What is bent is so twice as much over twice the step; where it has a corner, as much.
    corner = 2.0 * bends[0] - bends[1]
    unsteady = np.maximum(np.abs(near - far), np.abs(corner))
    exists = (np.abs(bends[1]) < KINK) & (unsteady <= UNSTEADY * (1.0 + np.abs(near)))
    return np.asarray(np.where(exists, (4.0 * near - far) / 3.0, np.nan))


def points_of(outline: Outline, arc: Ints, t: Floats) -> tuple[Complexes, Complexes]:
    """Points of an outline and the normals that point out of it there."""
    start, control, end = outline.start[arc], outline.control[arc], outline.end[arc]
    place = (1 - t) ** 2 * start + 2 * t * (1 - t) * control + t**2 * end
    along = (1 - t) * (control - start) + t * (end - control)
    return place, -1j * along / np.abs(along)


def along_normals(outline: Outline, place: Complexes, normal: Complexes) -> Floats:
    """How far an outline is from points along their normals, where it is nearest: (n,), NaN for one that misses it."""
    start, control, end = outline.start, outline.control, outline.end
    result = np.empty(len(place))
    for k, (z, n) in enumerate(zip(place.tolist(), normal.tolist(), strict=True)):
        # In the frame of the normal, the curve's coordinate across it is a quadratic with roots where they cross.
        p, q, r = ((w - z) / n for w in (start, control, end))
        a, b, c = (p - 2 * q + r).imag, 2 * (q - p).imag, p.imag
        with np.errstate(divide="ignore", invalid="ignore"):
            root = np.sqrt(b * b - 4 * a * c)
            half = -(b + np.where(b < 0, -1.0, 1.0) * root) / 2
            t = np.concatenate([half / a, c / half])
        p, q, r = (np.tile(w.real, 2) for w in (p, q, r))
        met = (t > -1e-9) & (t < 1 + 1e-9)
        t, p, q, r = (part[met] for part in (t, p, q, r))
        s = (1 - t) ** 2 * p + 2 * t * (1 - t) * q + t**2 * r
        result[k] = s[np.abs(s).argmin()] if len(s) else np.nan
    return result


def shared_lengths(outline: Outline, like: Outline) -> Floats:
    """How long the edges are that each neighbour of another outline shares with one: float64 (k,)."""
    own = dict(zip(outline.neighbours, np.bincount(outline.neighbour, outline.lengths), strict=True))
    return np.array([own.get(neighbour, 0.0) for neighbour in like.neighbours])


def judged(found: Floats, right: Floats, limit: float = 1e-6) -> float:
    """Require derivatives to be right, and give the share of them that exist."""
    exists = np.isfinite(right)
    wrong = np.abs(found - right)[exists] > limit * (1.0 + np.abs(right[exists]))
    assert not wrong.any(), (found[exists][wrong], right[exists][wrong])
    return float(exists.mean()) if len(exists) else 1.0
