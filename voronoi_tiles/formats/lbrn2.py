"""LightBurn's own project format, .lbrn2: XML, millimetres, y up, lines and exact cubic curves.

The format has no public description; what is written here is what LightBurn 1.x writes itself: a CutSetting for each
layer, whose index is its colour, and a Shape for each path with a list of vertices, each with the control points before
and after it, and a list of the segments between them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import BinaryIO, Final

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.text import xml_attribute
from voronoi_tiles.formats.cubics import cubic_blocks
from voronoi_tiles.formats.decimals import decimal_texts
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.paths.paths import CUBIC, Paths

# LightBurn's layers C00 to C29 have fixed colours.
PALETTE: Final = (
    *("#000000", "#0000ff", "#ff0000", "#00e000", "#d0d000", "#ff8000", "#00e0e0", "#ff00ff", "#b4b4b4", "#0000a0"),
    *("#a00000", "#00a000", "#a0a000", "#c08000", "#00a0ff", "#a000a0", "#808080", "#7d87b9", "#bb7784", "#4a6fe3"),
    *("#d33f6a", "#8cd78c", "#f0b98d", "#f6c4e1", "#fa9ed4", "#500a78", "#b45a00", "#004754", "#86fa88", "#ffdb66"),
)
"""The colours of LightBurn's layers, in the order of their numbers."""

_USUAL: Final = {"cut": 0, "engrave": 2, "score": 3}
_XFORM: Final = "<XForm>1 0 0 1 0 0</XForm>"


def write_lbrn2(drawing: Drawing, file: BinaryIO) -> None:
    """Write a drawing as a project of LightBurn, layers and paths in the order of the drawing.

    A layer takes the number of its colour where LightBurn has that colour; else the first free one from 0 for cuts, 2
    for engraving and 3 for scores. A filled layer is scanned, any other one cut along its lines. Power is 0: what a
    machine and a sheet need is set in LightBurn, and nothing burns before that. The paths of one item are a group.
    Quadratic curves become cubic ones exactly, circular arcs within 1e-6 mm; coordinates are rounded to a
    nanometre. The recipe stands in the notes. The same drawing gives the same bytes.

    Raises ValueError for more layers than LightBurn has.
    """
    indices = layer_numbers(drawing.layers)
    file.write(b'<?xml version="1.0" encoding="UTF-8"?>\n')
    file.write(b'<LightBurnProject AppVersion="1.7.00" FormatVersion="1" MaterialHeight="0" MirrorX="False" ')
    file.write(b'MirrorY="False">\n')
    settings = (_setting(layer, indices[k], k) for k, layer in enumerate(drawing.layers))
    file.write("".join(settings).encode())
    number = 0
    for layer, index in zip(drawing.layers, indices, strict=True):
        for cubics, items in cubic_blocks(layer):
            texts = _shapes(cubics, index, number)
            number += len(texts)
            file.write("".join(_grouped(texts, items.tolist(), index)).encode("ascii"))
    notes = "".join(f"{key}: {value}\n" for key, value in {"title": drawing.title, **drawing.recipe}.items() if value)
    file.write(f'    <Notes ShowOnLoad="0" Notes={xml_attribute(notes)}/>\n</LightBurnProject>\n'.encode())


def layer_numbers(layers: Sequence[Layer]) -> list[int]:
    """The number of each layer in LightBurn, from 0 to 29; no two alike.

    Of several layers of one colour a cut has the first claim on it, a score the next. Raises ValueError for more than
    30 layers.
    """
    if len(layers) > len(PALETTE):
        raise ValueError(f"LightBurn has {len(PALETTE)} layers, not {len(layers)}")
    numbers: dict[int, int] = {}
    order = sorted(range(len(layers)), key=lambda k: ("cut", "score", "engrave").index(layers[k].work))
    for k in order:
        colour = layers[k].colour.lower()
        if colour in PALETTE and PALETTE.index(colour) not in numbers.values():
            numbers[k] = PALETTE.index(colour)
    for k in order:
        first = _USUAL[layers[k].work]
        if k not in numbers:
            free = (index for index in (*range(first, len(PALETTE)), *range(first)) if index not in numbers.values())
            numbers[k] = next(free)
    return [numbers[k] for k in range(len(layers))]


def _setting(layer: Layer, index: int, priority: int) -> str:
    """How a layer is worked."""
    values = {
        "index": str(index),
        "name": layer.name,
        "minPower": "0",
        "maxPower": "0",
        "maxPower2": "0",
        "speed": "10",
        "priority": str(priority),
    }
    lines = "".join(f"        <{key} Value={xml_attribute(value)}/>\n" for key, value in values.items())
    return f'    <CutSetting type="{"Scan" if layer.filled else "Cut"}">\n{lines}    </CutSetting>\n'


# --- shapes -----------------------------------------------------------------------------------------------------


def _grouped(texts: list[str], items: list[int], index: int) -> Iterator[str]:
    """The shapes, those of one item as a group."""
    for a, b in pairwise(items):
        shapes = [text for text in texts[a:b] if text]
        if len(shapes) > 1:
            yield f'    <Shape Type="Group" CutIndex="{index}">\n        {_XFORM}\n        <Children>\n'
            yield from shapes
            yield "        </Children>\n    </Shape>\n"
        else:
            yield from shapes


def _shapes(cubics: Paths, index: int, number: int) -> list[str]:
    """A Shape for each path, "" for one without segments; the lists of each have a number of their own."""
    # One vertex more than segments: the end of the last one is left out again where the path is closed.
    count = len(cubics.start) + len(cubics)
    place = np.arange(len(cubics.start)) + cubics.owner
    last = cubics.offsets[1:] + np.arange(len(cubics))
    first = cubics.offsets[:-1] + np.arange(len(cubics))
    filled = np.flatnonzero(cubics.counts > 0)
    points = np.zeros(count, np.complex128)
    points[place] = cubics.start
    points[last[filled]] = cubics.end[cubics.offsets[1:][filled] - 1]

    bent = np.flatnonzero(cubics.kind == CUBIC)
    after, before = np.full(count, "c0x1", object), np.full(count, "c1x1", object)
    after[place[bent]] = _controls(cubics.control[bent, 0], "c0")
    before[place[bent] + 1] = _controls(cubics.control[bent, 1], "c1")
    ring = filled[cubics.closed[filled]]
    before[first[ring]] = before[last[ring]]
    vertices = [
        f"V{x} {y}{a}{b}"
        for x, y, a, b in zip(*map(decimal_texts, (points.real, points.imag)), after, before, strict=True)
    ]
    letters = np.where(cubics.kind == CUBIC, "B", "L").tolist()
    return [
        _shape(vertices[a : b + (not closed)], letters[c:d], index, number + k) if c < d else ""
        for k, (a, b, c, d, closed) in enumerate(
            zip(
                *(array.tolist() for array in (first, last, cubics.offsets[:-1], cubics.offsets[1:], cubics.closed)),
                strict=True,
            )
        )
    ]


def _shape(vertices: list[str], letters: list[str], index: int, number: int) -> str:
    """One path."""
    count = len(vertices)
    segments = "".join(f"{letter}{k} {(k + 1) % count}" for k, letter in enumerate(letters))
    return (
        f'    <Shape Type="Path" CutIndex="{index}" VertID="{number}" PrimID="{number}">\n        {_XFORM}\n'
        f"        <VertList>{''.join(vertices)}</VertList>\n        <PrimList>{segments}</PrimList>\n    </Shape>\n"
    )


def _controls(points: Complexes, name: str) -> list[str]:
    """Control points; `name` is c0 for the one after a vertex, c1 for the one before it."""
    return [f"{name}x{x}{name}y{y}" for x, y in zip(*map(decimal_texts, (points.real, points.imag)), strict=True)]
