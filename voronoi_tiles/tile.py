"""A tile of a design, with its outline and its copies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from voronoi_tiles.base.arguments import instance
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.text import counted
from voronoi_tiles.base.tolerance import COORDINATE_MAX
from voronoi_tiles.designs.site import NodedSite
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.tessellation import TileRecord

if TYPE_CHECKING:
    from shapely import MultiPolygon, Polygon


class TileCopy(NamedTuple):
    """A copy of a tile in its place: the site's name, the operation that takes the base tile there, and the outline."""

    site: str
    operation: Operation
    outline: Outline

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        """The outline as GeoJSON names it, Polygon or MultiPolygon, within `outline.display_accuracy`."""
        return self.outline.__geo_interface__


@dataclass(frozen=True, eq=False, repr=False)
class Tile:
    """The tile of one site: every point that is nearer to this site than to any other copy.

    Lengths are in the design's units. `symmetry` holds the operations that map the site, and so the tile, onto itself,
    the identity first; `copies_per_cell` is the group's order divided by their number.

    >>> import voronoi_tiles as vt
    >>> tile = vt.starter("p4").tessellate()["bird"]
    >>> tile
    <Tile 'bird': 223 edges, 4 copies per cell>
    >>> round(tile.area, 9), [str(operation) for operation in tile.symmetry]
    (900.0, ['x,y'])
    """

    site: NodedSite
    outline: Outline
    copies_per_cell: int
    symmetry: tuple[Operation, ...]
    _record: TileRecord

    def __repr__(self) -> str:
        copies = counted(self.copies_per_cell, "copy", "copies")
        return f"<Tile {self.site.name!r}: {counted(len(self.outline), 'edge')}, {copies} per cell>"

    @property
    def name(self) -> str:
        """The name of its site."""
        return self.site.name

    @property
    def area(self) -> float:
        """The area in square units."""
        return self.outline.area

    @property
    def perimeter(self) -> float:
        """The length of the outline, holes included, in units."""
        return self.outline.perimeter

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """The smallest upright rectangle around it: least x, least y, greatest x, greatest y, in units."""
        return self.outline.bounds

    @property
    def __geo_interface__(self) -> dict[str, Any]:
        """The outline as GeoJSON names it, Polygon or MultiPolygon, within `outline.display_accuracy`."""
        return self.outline.__geo_interface__

    def copy(self, operation: Operation | str) -> Outline:
        """The outline of a copy: the image under an operation of the group, or its coordinate triplet.

        An edge that two copies share has the same numbers in both, bit for bit. Raises ArgumentError where the group
        has no such operation.

        >>> import voronoi_tiles as vt
        >>> tile = vt.starter("p4").tessellate()["bird"]
        >>> len(set(tile.outline.start.tolist()) & set(tile.copy("-y,x").start.tolist()))
        35
        """
        if isinstance(operation, str):
            operation = Operation.parse(operation)
        group = self._record.tessellation.action.group
        if instance("operation", operation, Operation).reduced() not in {own.reduced() for own in group.operations}:
            own = "; ".join(map(str, group.operations))
            raise ArgumentError(
                f"{operation} is no operation of the group {group.name}",
                remedy=f"Take one of {own}, moved by whole numbers.",
            )
        x, y = operation.translation
        if not max(abs(x), abs(y)) * self._record.tessellation.action.size <= COORDINATE_MAX:
            raise ArgumentError(
                f"{operation} leads beyond {COORDINATE_MAX:g}, where coordinates lose their digits",
                remedy="Take a copy that is nearer.",
            )
        return self._record.copy(operation)

    def figures(self) -> dict[str, Any]:
        """The tile in numbers: lengths in units; the neighbours by the length of the shared edges, longest first."""
        outline = self.outline
        count = len(outline.neighbours)
        edges = np.bincount(outline.neighbour, minlength=count).tolist()
        lengths = np.bincount(outline.neighbour, weights=outline.lengths, minlength=count).tolist()
        neighbours = [
            {"site": site, "operation": str(operation), "edges": edges[k], "length": lengths[k]}
            for k, (site, operation) in enumerate(outline.neighbours)
        ]
        curved = int(outline.curved.sum())
        low_x, low_y, high_x, high_y = outline.bounds
        return {
            "site": self.name,
            "elements": len(self.site.elements),
            "width": high_x - low_x,
            "height": high_y - low_y,
            "area": self.area,
            "perimeter": self.perimeter,
            "rings": len(outline.ring_offsets) - 1,
            "edges": {"line": len(outline) - curved, "parabola": curved},
            "curved_share": outline.curved_length / self.perimeter,
            "copies_per_cell": self.copies_per_cell,
            "symmetry": [str(operation) for operation in self.symmetry],
            "neighbours": sorted(neighbours, key=lambda row: -float(row["length"])),
        }

    def to_shapely(self, *, accuracy: float) -> Polygon | MultiPolygon:
        """The tile as a shapely polygon whose chords stay within `accuracy` (in units) of the outline."""
        return self.outline.to_shapely(accuracy=accuracy)

    def svg_path(self) -> str:
        """The outline as exact SVG path data in units about the design's origin, y turned to run down."""
        from voronoi_tiles.formats.svg.path_text import path_data

        return path_data(self.outline.paths)

    def plot(self, ax: Any = None) -> Any:
        """Draw the tile and its site on axes of matplotlib (None: the current ones), which it gives back.

        Raises MissingLibraryError where matplotlib is not installed.
        """
        from voronoi_tiles.pictures.plotting import axes_of, plot_tiles

        ax = axes_of(ax)
        plot_tiles(ax, [(self.outline, self.site.ends)], ["#f3ead8"])
        return ax

    def _repr_svg_(self) -> str:
        """Draw the tile and its site: notebooks show this."""
        from voronoi_tiles.pictures.notebook import tiling_picture

        return tiling_picture([(self.outline, self.site.ends)])
