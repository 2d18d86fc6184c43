"""Vertices where two nearly parallel segments of a stroke hand over: as sharp as others, seen in 40 digits."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest

from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.design import Design

CELL = 64.0
Element = tuple[Any, Any]
"""A segment of exact copies, its first point and its last one; or a node, twice."""


def bent(group: str, bend: float) -> Design:
    """A stroke along a gentle wave, whose joints turn by about `bend` either way, and another one on which it ends."""
    x = np.linspace(0.0, 1.0, 17)
    wave = [[8 + 40 * t, 12 + 6 * t + 16 * bend * np.sin(9 * t)] for t in x.tolist()]
    strokes = [{"polyline": wave}, {"segment": [wave[-1], [40, 26]]}]
    cell = {"a": CELL, "b": CELL} | ({"angle": 90.0} if group == "p2" else {})
    return Design.from_dict({"schema": 1, "group": group, "cell": cell, "site": [{"strokes": strokes}]})


def segments_of(design: Design, operation: Operation) -> list[Element]:
    """The segments of the site's image under an operation, exactly: the cell is a square along the axes."""
    a, b, c, d = operation.linear
    s, t = (mpmath.mpf(part.numerator) / part.denominator * CELL for part in operation.translation)
    site = design.noded[0]
    nodes = [mpmath.mpc(a * z.real + b * z.imag + s, c * z.real + d * z.imag + t) for z in site.nodes.tolist()]
    return [(nodes[first], nodes[last]) for first, last in site.segments.tolist()]


def distance(element: Element, z: Any) -> Any:
    """The distance of a point from a node, or from a segment's line."""
    first, last = element
    return abs(z - first) if first == last else abs(((z - first) * mpmath.conj(last - first)).imag) / abs(last - first)


def nearest(segments: list[Element], z: Any) -> Element:
    """The segment or node nearest to a point."""
    seen = [(p, q) for p, q in segments if 0 < ((z - p) * mpmath.conj(q - p)).real < abs(q - p) ** 2]
    nodes = [(end, end) for segment in segments for end in segment]
    return min(seen + nodes, key=lambda element: distance(element, z))


def true_vertex(elements: list[Element], start: complex) -> Any:
    """The point equally far from three elements, near a start."""

    def gaps(x: Any, y: Any) -> tuple[Any, Any]:
        first, second, third = (distance(element, mpmath.mpc(x, y)) for element in elements)
        return first - second, first - third

    return mpmath.mpc(*mpmath.findroot(gaps, (start.real, start.imag)))


@pytest.mark.parametrize("group", ["p2", "pg"])
@pytest.mark.parametrize("bend", [1e-6, 1e-8])
def test_segments_hand_over_where_three_elements_are_equally_far(group: str, bend: float) -> None:
    """Within 1e-14 of the cell, on this side of an edge and on the other, however small the angle between them."""
    design = bent(group, bend)
    outline = design.tessellate().tiles[0].outline
    errors: list[list[float]] = [[], []]
    with mpmath.workdps(40):
        here = segments_of(design, Operation.parse("x,y"))
        copies = [segments_of(design, neighbour.operation) for neighbour in outline.neighbours]
        middle = [mpmath.mpc(z) for z in ((outline.start + 2 * outline.control + outline.end) / 4).tolist()]
        facing = outline.neighbour.tolist()
        pairs = [(nearest(here, z), nearest(copies[k], z)) for k, z in zip(facing, middle, strict=True)]
        for k, vertex in enumerate(outline.start.tolist()[1:]):
            for side in (0, 1):
                turning = pairs[k][side], pairs[k + 1][side]
                staying = pairs[k][1 - side], pairs[k + 1][1 - side]
                straight = all(first != last for first, last in turning) and turning[0] != turning[1]
                if facing[k] == facing[k + 1] and straight and staying[0] == staying[1]:
                    errors[side].append(float(abs(true_vertex([*turning, staying[0]], vertex) - vertex)))
    assert min(map(len, errors)) > 3
    assert max(map(max, errors)) < 1e-14 * CELL
