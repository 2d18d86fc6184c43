"""The gradient of a design's tiles by its parameters."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from voronoi_tiles.base.arguments import of_site
from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.text import counted
from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.moving_sites import moving_lattice, moving_sites
from voronoi_tiles.designs.parameters import Parameter, chosen_parameters, values_of, with_values
from voronoi_tiles.gradients.feet import AllStrokes
from voronoi_tiles.gradients.sides import Sides, TileOfSite
from voronoi_tiles.gradients.tile_gradient import TileGradient
from voronoi_tiles.vector.outline import Outline


@dataclass(frozen=True, eq=False, repr=False)
class ShapeGradient:
    """The derivatives of all tiles of a design by p of its numbers, its parameters.

    `parameters` are their places in the design file, as messages name them: "cell.a", "site[0].strokes[1].bezier[2][0]"
    for the x of a point, "site[0].rotate"; `values` (float64, p) are what they are, lengths in the design's units,
    angles in degrees. `tiles` are the derivatives of each tile; a gradient is a sequence of them, which are found by
    their sites' names as well.

    Two things keep a number from being free. Where the group maps a site onto itself, strokes that are images of each
    other can only move together, else copies touch; and where strokes meet in a point, one that leaves the others moves
    the tile to one side alone. There the derivative by one number is that of its share: of the change's symmetric part,
    and of the mean of the points that meet. The sum over all that move together is the derivative of their motion. A
    site that lies on a mirror or a centre goes with it when the cell changes.

    >>> import voronoi_tiles as vt
    >>> tiling = vt.starter("p4m").tessellate()
    >>> gradient = tiling.shape_gradient(["cell", "site[1].strokes[0].bezier[0]"])
    >>> gradient
    <ShapeGradient of 2 tiles by 3 parameters>
    >>> gradient.parameters
    ('cell.a', 'site[1].strokes[0].bezier[0][0]', 'site[1].strokes[0].bezier[0][1]')
    >>> gradient["leaf"].area.round(3)
    array([15.   , -6.587,  1.808])
    """

    design: Design
    parameters: tuple[str, ...]
    values: Floats
    tiles: tuple[TileGradient, ...]
    _places: tuple[Parameter, ...]

    def __repr__(self) -> str:
        tiles, parameters = counted(len(self), "tile"), counted(len(self.parameters), "parameter")
        return f"<ShapeGradient of {tiles} by {parameters}>"

    def __len__(self) -> int:
        """Count the tiles."""
        return len(self.tiles)

    def __iter__(self) -> Iterator[TileGradient]:
        return iter(self.tiles)

    def __getitem__(self, key: int | str) -> TileGradient:
        """The derivatives of the tile of a number, or of a site's name. Raises UnknownNameError, IndexError."""
        if not isinstance(key, str):
            return self.tiles[key]
        return of_site(self.tiles, key)

    def stepped(self, step: Sequence[float] | Floats | Mapping[str, float]) -> Design:
        """The design with its parameters changed by a step, as many numbers or those of some names, checked again.

        Raises ArgumentError for a step that is none, DesignError where there is no such design.
        """
        if isinstance(step, Mapping):
            unknown = next((name for name in step if name not in self.parameters), None)
            if unknown is not None:
                raise ArgumentError(f"`step` names {unknown!r}", remedy="Name `parameters` of this gradient.")
            step = [step.get(name, 0.0) for name in self.parameters]
        try:
            change = np.asarray(step, float)
        except (TypeError, ValueError):
            raise ArgumentError("`step` cannot be", remedy="Give a number for each parameter.") from None
        if change.shape != self.values.shape:
            raise ArgumentError(
                f"`step` has the shape {change.shape}, not {self.values.shape}",
                remedy="Give a number for each parameter.",
            )
        return with_values(self.design, self._places, (self.values + change).tolist())


def shape_gradient(
    design: Design,
    tiles: Sequence[tuple[Outline, tuple[Operation, ...]]],
    names: str | Iterable[str] | None,
) -> ShapeGradient:
    """The gradient of tiles, each an outline and the operations that map its site onto itself, in the design's order.

    Raises ArgumentError for names of no parameters.
    """
    places = tuple(chosen_parameters(design, names))
    moving = moving_sites(design, places)
    lattice = sparse.csr_array(moving_lattice(design, places))
    rates = sparse.vstack([*(site.rates for site in moving), lattice], format="csr")
    strokes = AllStrokes.of(moving)
    sites = [TileOfSite(site.name, symmetry) for site, (_, symmetry) in zip(design.noded, tiles, strict=True)]
    return ShapeGradient(
        design,
        tuple(map(str, places)),
        np.array(values_of(design, places)),
        tuple(
            TileGradient(site.name, outline, Sides.of(k, sites, outline.neighbours, design.lattice), strokes, rates)
            for k, (site, (outline, _)) in enumerate(zip(sites, tiles, strict=True))
        ),
        places,
    )
