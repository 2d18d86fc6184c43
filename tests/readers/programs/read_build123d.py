"""build123d: `import_svg`; closed paths are wires, or faces where the file fills them."""

import sys

from answer import answer, sampled
from build123d import Face, Vector, import_svg


def plane(point: Vector) -> complex:
    """A point without its height."""
    return complex(point.X, point.Y)


shapes = list(import_svg(sys.argv[1]))
contours = []
for shape in shapes:
    for wire in shape.wires():
        points = [plane(wire @ 0)]
        for edge in wire.order_edges():
            points += sampled(lambda t, edge=edge: plane(edge @ t))
        contours.append((points, wire.is_closed))
areas = [shape.area if isinstance(shape, Face) else Face(shape).area for shape in shapes]
answer(
    contours,
    distribution="build123d",
    entities=(type(shape).__name__ for shape in shapes),
    area=sum(areas),
)
