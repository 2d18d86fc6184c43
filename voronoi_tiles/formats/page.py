"""What is handed to the writers of files: a page in millimetres with layers of paths, in the order of cutting."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from decimal import ROUND_CEILING, Decimal
from typing import Any, Literal, Self

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.formats.burns import Burn
from voronoi_tiles.paths.paths import Paths

Work = Literal["cut", "score", "engrave"]
"""What a laser does along a path: through the sheet, along its surface, or to mark it."""


@dataclass(frozen=True, eq=False, repr=False)
class Layer:
    """Paths that are worked alike, in the order in which a machine takes them.

    `paths` are in millimetres from the page's lower left corner, y up. Item k, one object of the file, are the paths
    from `items[k]` up to, not including, `items[k + 1]` (intp). `labels`, one for each item, name them; empty where
    they have no names. `colour` is "#rrggbb", `stroke` the width to draw it with, in millimetres. With `filled` the
    target takes what is filled, not what is drawn, for this work. `burn` is for files that drive the machine
    themselves, None for all others.
    """

    name: str
    work: Work
    colour: str
    stroke: float
    paths: Paths
    items: Ints
    labels: tuple[str, ...] = ()
    filled: bool = False
    burn: Burn | None = None

    def __repr__(self) -> str:
        return f"<Layer {self.name!r}: {self.work}, {len(self.paths)} paths>"

    @classmethod
    def of_paths(cls, name: str, work: Work, colour: str, stroke: float, paths: Paths) -> Layer:
        """A layer in which every path is an item of its own."""
        return cls(name, work, colour, stroke, paths, np.arange(len(paths) + 1))


@dataclass(frozen=True, eq=False, repr=False)
class Drawing:
    """A page of `width` times `height` millimetres, its layers in the order of work.

    Its lower left corner is at the ordinate `bottom`: 0, but for exact tiles, whose coordinates keep all their bits.
    `recipe` says how it was made ("program", "version", "design", ...): the same drawing gives the same bytes.
    """

    width: float
    height: float
    layers: tuple[Layer, ...]
    title: str = ""
    recipe: Mapping[str, str] = field(default_factory=dict)
    bottom: float = 0.0

    def __repr__(self) -> str:
        layers = ", ".join(layer.name for layer in self.layers)
        return f"<Drawing {self.title!r}: {self.width:.6g} x {self.height:.6g} mm, layers {layers}>"

    def with_evidence(self, evidence: Mapping[str, Any]) -> Self:
        """The same with what was proved and checked in the recipe."""
        return replace(self, recipe={**self.recipe, "evidence": json.dumps(evidence, sort_keys=True)})


def fitting_page(left: float, bottom: float, right: float, top: float) -> tuple[float, float, complex]:
    """The sides of a page with a box in its middle, and where its lower left corner lies; millimetres.

    Sides are rounded up to a tenth, or to two digits below a millimetre. Short decimals keep their unit in programs
    that look for the shortest text: SVGO makes pixels of 44.6331mm, whose size readers do not agree on.
    """
    width, height = _short(right - left), _short(top - bottom)
    return width, height, complex(left + right - width, bottom + top - height) / 2


def _short(length: float) -> float:
    """A positive length rounded up; an excess under 1e-12 of it is noise."""
    step = Decimal(10) ** min(math.floor(math.log10(length)) - 1, -1)
    steps = (Decimal(length) * Decimal("0.999999999999") / step).to_integral_value(ROUND_CEILING)
    return float(steps * step)
