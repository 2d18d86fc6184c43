"""What is handed to the writers of files: a page in millimetres with layers of paths, in the order of cutting."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from voronoi_tiles.vector.curves.paths import Ints, Paths

Work = Literal["cut", "score", "engrave"]
"""What a laser does along a path: through the sheet, along its surface, or to mark it."""


@dataclass(frozen=True, eq=False)
class Layer:
    """Paths that are worked alike, in the order in which a machine takes them.

    `paths` are in millimetres from the page's lower left corner, y up. Item k, one object of the file, are the paths
    from `items[k]` up to, not including, `items[k + 1]` (intp). `labels`, one for each item, name them; empty where
    they have no names. `colour` is "#rrggbb", `stroke` the width to draw it with, in millimetres. With `filled` the
    target takes what is filled, not what is drawn, for this work.
    """

    name: str
    work: Work
    colour: str
    stroke: float
    paths: Paths
    items: Ints
    labels: tuple[str, ...] = ()
    filled: bool = False

    @classmethod
    def of_paths(cls, name: str, work: Work, colour: str, stroke: float, paths: Paths) -> Layer:
        """A layer in which every path is an item of its own."""
        return cls(name, work, colour, stroke, paths, np.arange(len(paths) + 1))


@dataclass(frozen=True, eq=False)
class Drawing:
    """A page of `width` times `height` millimetres, its layers in the order of work.

    `recipe` says how it was made ("program", "version", "design", ...): the same drawing gives the same bytes.
    """

    width: float
    height: float
    layers: tuple[Layer, ...]
    title: str = ""
    recipe: Mapping[str, str] = field(default_factory=dict)
