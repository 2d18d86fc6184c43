"""What is judged: the shapes of a drawing that are cut, as one set of paths, with the way back to each object."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Final, Self

import numpy as np

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.formats.reading import DrawingError, ReadDrawing, Shape
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.preflight.chords import Chords, chords_of, counts_of
from voronoi_tiles.preflight.findings import LayerUse, Limits

NOT_CUT: Final = re.compile(
    r"engrav|grav(?:ur|ier)|etch|scor|mark|crease|fold|raster|label|text|note|guide|comment", re.IGNORECASE
)
"""Names of layers that are not cut. A colour says nothing: what is cut in one workshop is engraved in another."""

_SHARE: Final = 4.0  # chords are this much nearer to the curves than the tolerance
_CHORDS_MAX: Final = 6_000_000


@dataclass(frozen=True, eq=False)
class CutLines:
    """What is cut: its paths, and their shapes; `height` turns places into the file's own."""

    paths: Paths
    shape: Ints
    shapes: Sequence[Shape]
    svg: bool
    height: float

    def place(self, point: complex) -> tuple[float, float]:
        """A point as the file's own program shows it."""
        y = self.height - point.imag if self.svg else point.imag
        return round(point.real, 6) + 0.0, round(y, 6) + 0.0

    def source(self, path: int) -> str:
        """The object that a path is of."""
        return self.shapes[int(self.shape[path])].source

    def sources(self, *paths: int) -> tuple[str, ...]:
        """The objects that paths are of, each once."""
        return tuple(dict.fromkeys(self.source(path) for path in paths))


@dataclass(frozen=True, eq=False)
class JudgedLines:
    """Paths that are judged, and their chords."""

    paths: Paths
    chords: Chords

    @classmethod
    def of(cls, paths: Paths, limits: Limits) -> Self:
        """The paths with chords that are near enough to them.

        Raises DrawingError where the curves take too many chords at this tolerance.
        """
        counts = counts_of(paths, limits.tolerance / _SHARE)
        if counts.sum() > _CHORDS_MAX:
            raise DrawingError(
                f"its curves take {counts.sum():,} chords at a tolerance of {limits.tolerance:g} mm",
                remedy="Allow a larger `tolerance`, or check the size of the drawing.",
            )
        return cls(paths, chords_of(paths, counts, limits.tolerance))


def cut_shapes(drawing: ReadDrawing, layers: Collection[str]) -> list[bool]:
    """Which shapes are cut: those of the named layers or colours; without names, all strokes but on layers by NOT_CUT.

    Where nothing has a stroke the outlines of what is filled are. Raises DrawingError for a name that the file has not.
    """
    shapes = drawing.shapes
    known = {shape.layer for shape in shapes} | {shape.stroke for shape in shapes if shape.stroke}
    for name in layers:
        if name not in known:
            listed = ", ".join(sorted(repr(each) for each in known if each)[:20]) or "none"
            raise DrawingError(f"no layer or colour {name!r}", remedy=f"The file has {listed}.")
    stroked = any_stroke(drawing)
    return [is_cut(shape.layer, shape.stroke, layers, stroked) for shape in shapes]


def any_stroke(drawing: ReadDrawing) -> bool:
    """Whether a shape of the drawing has a stroke."""
    return any(shape.stroke is not None for shape in drawing.shapes)


def is_cut(layer: str, stroke: str | None, layers: Collection[str], stroked: bool) -> bool:
    """Whether what has this layer and stroke is cut, see `cut_shapes`; `stroked` is what `any_stroke` says."""
    if layers:
        return layer in layers or stroke in layers
    return (stroke is not None or not stroked) and not NOT_CUT.search(layer)


def subject_of(drawing: ReadDrawing, drawn: Paths, cut: Sequence[bool]) -> CutLines:
    """What is cut of a drawing, of which `drawn` are all paths."""
    shape = _shape_of_paths(drawing)
    chosen = np.flatnonzero(np.array(cut, np.bool_)[shape])
    # The same paths keep what was measured of them.
    paths = drawn if len(chosen) == len(drawn) else drawn.take(chosen)
    return CutLines(paths, shape[chosen], drawing.shapes, drawing.format == "svg", drawing.height or 0.0)


def layer_uses(drawing: ReadDrawing, drawn: Paths, cut: Sequence[bool]) -> tuple[LayerUse, ...]:
    """The layers and colours of a drawing, in the order of the file; `drawn` are all its paths."""
    shape = _shape_of_paths(drawing)
    lengths = np.bincount(shape, drawn.path_lengths, len(drawing.shapes)).tolist()
    groups: dict[tuple[str, str | None, bool], list[int]] = {}
    for number, (one, is_cut) in enumerate(zip(drawing.shapes, cut, strict=True)):
        groups.setdefault((one.layer, one.stroke, is_cut), []).append(number)
    return tuple(
        LayerUse(
            layer,
            colour,
            len(numbers),
            sum(len(drawing.shapes[k].paths.start) for k in numbers),
            sum(lengths[k] for k in numbers),
            is_cut,
        )
        for (layer, colour, is_cut), numbers in groups.items()
    )


def _shape_of_paths(drawing: ReadDrawing) -> Ints:
    """The number of each path's shape."""
    return np.repeat(np.arange(len(drawing.shapes)), [len(shape.paths) for shape in drawing.shapes]).astype(np.intp)
