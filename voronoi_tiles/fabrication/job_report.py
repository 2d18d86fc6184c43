"""What a job comes to: pieces by shape, colour and handedness, sheet use, lengths, pierces, travel, time."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from math import fsum
from typing import TYPE_CHECKING, Any

import numpy as np

from voronoi_tiles.base.arguments import number
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.values import is_number, shown
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.layout import FRAME
from voronoi_tiles.fabrication.trails import travel

if TYPE_CHECKING:
    from voronoi_tiles.fabrication.product import Product

SPEEDS = {"cut": 10.0, "score": 60.0, "engrave": 60.0, "travel": 200.0}
"""Speeds where the caller gives none; millimetres a second. A CO2 laser of 60 W in 3 mm of plywood."""

PIERCE_S = 0.3
"""Time for a pierce where the caller gives none; seconds."""


def report_figures(
    design: Design,
    product: Product,
    *,
    packing: Sequence[dict[str, Any]] = (),
    speeds: Mapping[str, float] | None = None,
    pierce_s: float | None = None,
) -> dict[str, Any]:
    """The figures of a product in the types of JSON: lengths in millimetres, areas in mm^2, times in seconds.

    `packing` is what each colour takes of the sheets that it is packed on. `speeds` are those of "cut", "score",
    "engrave" and "travel" (mm/s). The time counts no acceleration. Raises ArgumentError for speeds and times that are
    none.
    """
    if not isinstance(speeds, Mapping | None):
        raise ArgumentError(f"`speeds` {shown(speeds)} cannot be", remedy='Give a mapping, such as {"cut": 12}.')
    speed = {**SPEEDS, **(speeds or {})}
    pierce_s = PIERCE_S if pierce_s is None else pierce_s
    for name, value in speed.items():
        if name not in SPEEDS or not (is_number(value) and 0.0 < value < math.inf):
            raise ArgumentError(
                f"`speeds`: {shown(name)} {shown(value)} cannot be",
                remedy=f"Give mm/s above 0 for {', '.join(SPEEDS)}.",
            )
    pierce_s = number("pierce_s", pierce_s, "Give seconds, 0 or more.", least=0.0)
    drawing, pieces = product.drawing, product.pieces
    layers: list[dict[str, Any]] = []
    before = 0j
    for layer in drawing.layers:
        paths = layer.paths
        length = fsum(paths.lengths.tolist())
        there = abs(complex(paths.start[0]) - before) if len(paths) else 0.0
        way = travel(paths) + there
        before = complex(paths.end[-1]) if len(paths) else before
        layers.append(
            {
                "name": layer.name,
                "work": layer.work,
                "colour": layer.colour,
                "paths": len(paths),
                "closed": int(paths.closed.sum()),
                "pieces": len(paths.start),
                "length": length,
                "travel": way,
                "time": length / speed[layer.work]
                + way / speed["travel"]
                + (len(paths) * pierce_s if layer.work == "cut" else 0.0),
            }
        )
    cuts = [row for row in layers if row["work"] == "cut"]
    names = [site.name for site in design.noded]
    counted = Counter(
        zip(
            pieces.site.tolist(),
            pieces.turned_over.tolist(),
            pieces.whole.tolist(),
            pieces.colour.tolist(),
            strict=True,
        )
    )
    area = product.sheet_area
    used = pieces.tile_area
    whole = fsum(pieces.area[pieces.whole].tolist())
    return {
        "design": design.name,
        "group": design.group.name,
        "page": {"width": drawing.width, "height": drawing.height, "area": drawing.width * drawing.height},
        "pieces": {
            "count": pieces.count,
            "frame": pieces.frame,
            "whole": int(pieces.whole.sum()),
            "turned_over": int(pieces.turned_over.sum()),
            "kinds": [
                {
                    "site": "frame" if site == FRAME else names[site],
                    "turned_over": over,
                    "whole": complete,
                    "colour": colour + 1 if colour >= 0 else None,
                    "count": count,
                }
                for (site, over, complete, colour), count in sorted(counted.items())
            ],
        },
        "colours": product.colours,
        "colouring": product.scheme,
        "packing": list(packing),
        "use": {"sheet": area, "tiles": used, "share": used / area, "whole_tiles": whole, "whole_share": whole / area},
        "cut": {
            "length": fsum(row["length"] for row in cuts),
            "pierces": sum(row["paths"] for row in cuts),
            "travel": fsum(row["travel"] for row in cuts),
        },
        "layers": layers,
        "speeds": {**speed, "pierce": pierce_s},
        "time": fsum(row["time"] for row in layers),
        "curves": product.curves,
        "accuracy": product.accuracy,
        "shortest_piece": float(
            min((float(np.min(layer.paths.lengths)) for layer in drawing.layers if len(layer.paths)), default=0.0)
        ),
        "notes": list(product.notes),
    }
