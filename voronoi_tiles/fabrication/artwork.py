"""The art of sites on all copies of their tiles: strokes that are engraved or scored, and shapes that are filled."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, offsets_of
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.designs.art import GUIDE, Art
from voronoi_tiles.fabrication.arc_fitting import edge_arcs
from voronoi_tiles.fabrication.clipping import OUTSIDE, Strands, inner_runs, outer_strands
from voronoi_tiles.fabrication.contours import clipped_pieces
from voronoi_tiles.fabrication.job_options import SHEET_MAX
from voronoi_tiles.fabrication.layout import PIECES_MAX, Layout
from voronoi_tiles.fabrication.region import Region
from voronoi_tiles.formats.caveats import caveats
from voronoi_tiles.paths.biarcs import to_arcs
from voronoi_tiles.paths.orientation import oriented, simple
from voronoi_tiles.paths.paths import Paths

if TYPE_CHECKING:
    from voronoi_tiles.formats.reading import Shape


@dataclass(frozen=True, eq=False)
class Works:
    """Lines and shapes by what is done with them, and what is to be said of them, in sentences.

    Shape k that is `filled` are the closed paths from items[k] up to items[k + 1].
    """

    engraved: Paths
    scored: Paths
    filled: Paths
    items: Ints
    notes: tuple[str, ...] = ()

    @classmethod
    def joined(cls, parts: list[Works]) -> Works:
        """All of several."""
        counts = np.concatenate([np.zeros(0, np.intp), *(np.diff(part.items) for part in parts)])
        return cls(
            Paths.concatenate([part.engraved for part in parts]),
            Paths.concatenate([part.scored for part in parts]),
            Paths.concatenate([part.filled for part in parts]),
            offsets_of(counts),
            tuple(dict.fromkeys(line for part in parts for line in part.notes)),
        )

    def moved(self, factor: complex, shift: complex, *, conj: bool = False) -> Works:
        """The image under z -> factor z + shift, or factor conj(z) + shift."""
        return self._changed(lambda part: part.moved(factor, shift, conj=conj), self.items)

    def stamped(self, places: Complexes, units: Complexes | None = None) -> Works:
        """The same at many places, one after the other, turned about 0 before by `units`, where there are any."""
        counts = np.tile(np.diff(self.items), len(places))
        return self._changed(lambda part: _stamped(part, places, units), offsets_of(counts))

    def clipped(self, region: Region, accuracy: float) -> Works:
        """What lies in a region; curves but lines and quadratic ones become arcs within an accuracy."""
        filled, items = [], [0]
        for first, last in zip(self.items[:-1].tolist(), self.items[1:].tolist(), strict=True):
            inside = _clipped_shape(self.filled.take(np.arange(first, last)), region, accuracy)
            if len(inside):
                filled.append(inside)
                items.append(items[-1] + len(inside))
        return Works(
            _clipped_lines(self.engraved, region, accuracy),
            _clipped_lines(self.scored, region, accuracy),
            Paths.concatenate(filled),
            np.array(items, np.intp),
            self.notes,
        )

    def _changed(self, change: Callable[[Paths], Paths], items: Ints) -> Works:
        """The same with all paths changed."""
        return Works(change(self.engraved), change(self.scored), change(self.filled), items, self.notes)


def draw_art(layout: Layout, shown: Bools, *, fills: bool) -> Works:
    """The art of every copy on the page that is `shown`; `fills` as for `read_art`.

    Raises DesignError where the art of a site cannot be read, or filled shapes cannot be clipped.
    """
    design, job = layout.design, layout.job
    parts: list[Works] = []
    for site, art in enumerate(design.art):
        if art is None or job.art == "none":
            continue
        drawn = read_art(art, design.folder, site, design.unit_mm, fills=fills)
        _refuse_excess(drawn, layout, site, art)
        try:
            if job.art == "clip":
                accuracy = layout.budget.arcs / design.unit_mm
                outline = edge_arcs(layout.outline(site).paths, accuracy=accuracy, absorbed=0.0)
                drawn = drawn.clipped(Region(outline), accuracy)
            parts += _copies_of(drawn, layout, site, shown)
        except ValueError as error:
            raise DesignError(
                f"the art cannot be clipped: {error}",
                file=art.file,
                key=f"site[{site}].art",
                remedy="Unite its shapes (Path > Union in Inkscape), or use `art='whole'`.",
            ) from error
    return Works.joined(parts)


def _refuse_excess(drawn: Works, layout: Layout, site: int, art: Art) -> None:
    """Refuse art that is too large, or too much on so many tiles."""
    parts = [paths for paths in (drawn.engraved, drawn.scored, drawn.filled) if len(paths.start)]
    many = int(np.count_nonzero(layout.site == site)) * sum(len(paths.start) for paths in parts)
    reach = max((float(np.abs(paths.bounds).max()) for paths in parts), default=0.0) * layout.design.unit_mm
    if many > PIECES_MAX or reach > SHEET_MAX:
        far = reach > SHEET_MAX
        what = f"reaches {reach:.3g} mm from the design's origin" if far else f"has {many:,} lines on all tiles"
        raise DesignError(
            f"the art {what}",
            file=art.file,
            key=f"site[{site}].art",
            remedy=f"Draw at most {PIECES_MAX:,} lines in all, within {SHEET_MAX:,.0f} mm, or use `art='none'`.",
        )


def read_art(art: Art, folder: str, site: int, unit_mm: float, *, fills: bool) -> Works:
    """Read a site's art into the design's units.

    Shapes on layers with "score" in their names are scored, all others engraved. With `fills` the target engraves what
    is filled: then closed shapes with a fill are, and all lines are scored.
    """
    from voronoi_tiles.formats.reading import read_drawing

    try:
        drawing = read_drawing(Path(folder) / art.file)
    except DesignError as error:
        raise DesignError(
            f"the art cannot be used: {error.message}",
            file=error.file,
            key=f"site[{site}].art",
            line=error.line,
            remedy=error.remedy,
        ) from error
    lines: dict[str, list[Paths]] = {"engrave": [], "score": []}
    filled: list[Paths] = []
    for shape in drawing.shapes:
        work = _work(shape, fills=fills)
        if work == "fill":
            filled.append(shape.paths)
        elif work is not None:
            lines[work].append(shape.paths)
    items = offsets_of([len(paths) for paths in filled])
    engraved, scored = Paths.concatenate(lines["engrave"]), Paths.concatenate(lines["score"])
    works = Works(engraved, scored, Paths.concatenate(filled), items, caveats(drawing, art.file))
    factor, shift, mirrored = art.placement.similarity
    return works.moved(factor / unit_mm, shift, conj=mirrored)


def _work(shape: Shape, *, fills: bool) -> str | None:
    """What is done with a shape of a drawing; None where nothing is."""
    layer = shape.layer.casefold()
    if GUIDE in layer or not len(shape.paths) or (shape.stroke is None and shape.fill is None):
        return None
    if "score" in layer:
        return "score"
    if not fills:
        return "engrave"
    return "fill" if shape.fill is not None and bool(shape.paths.closed.all()) else "score"


def _clipped_lines(paths: Paths, region: Region, accuracy: float) -> Paths:
    """What of paths lies in a region; closed paths that lie in it as a whole stay closed."""
    if not len(paths):
        return paths
    arcs = to_arcs(paths, accuracy=accuracy)
    runs = inner_runs(arcs, region)
    whole = np.bincount(runs.path, minlength=len(arcs)) == 1
    whole &= np.bincount(runs.path, runs.paths.counts, len(arcs)) == arcs.counts
    whole[runs.path[runs.starts_on_border | runs.ends_on_border]] = False
    return replace(runs.paths, closed=(whole & arcs.closed)[runs.path])


def _clipped_shape(paths: Paths, region: Region, accuracy: float) -> Paths:
    """What of the area between closed paths lies in a region. Raises ValueError where the paths cross."""
    rings = oriented(to_arcs(paths, accuracy=accuracy))
    if not simple(rings):
        raise ValueError("the outline of a filled shape crosses itself")
    count = len(rings)
    if not count:
        return rings
    sides = Strands(
        paths=replace(rings, closed=np.zeros(count, np.bool_)),
        first=np.arange(count),
        last=np.arange(count),
        node=rings.start[rings.offsets[:-1]],
        left=np.zeros(count, np.intp),
        right=np.full(count, OUTSIDE),
        border=np.zeros(count, np.bool_),
        on_border=0,
    )
    return clipped_pieces(outer_strands(sides, region), np.zeros(1, np.intp), rings, np.array([0, count])).paths


def _copies_of(drawn: Works, layout: Layout, site: int, shown: Bools) -> list[Works]:
    """The images of a site's art on all copies of its tile on the page."""
    copies = layout.copies
    result: list[Works] = []
    for tile in np.flatnonzero(layout.period.site == site).tolist():
        factor, shift, conj = layout.tiles.page.after(layout.period.motion[tile])
        image = drawn.moved(factor, shift, conj=conj)
        here = np.flatnonzero((copies.tile == tile) & shown)
        place = layout.copy_shifts[here]
        whole = copies.whole[here]
        result.append(image.stamped(place[whole], None if copies.unit is None else copies.unit[here][whole]))
        if layout.region is not None:
            # On a tile that the sheet's edge cuts, art ends there too.
            at_edge = (image.moved(1.0, shift) for shift in place[~whole].tolist())
            result += [part.clipped(layout.region, layout.budget.arcs) for part in at_edge]
    return result


def _stamped(paths: Paths, places: Complexes, units: Complexes | None) -> Paths:
    """The same paths at many places, one after the other, turned about 0 before by `units`, where there are any."""
    copies = paths.take(np.tile(np.arange(len(paths)), len(places)))
    shift = np.repeat(places, len(paths.start))
    return copies.shifted(shift) if units is None else copies.turned(np.repeat(units, len(paths.start)), shift)
