"""The cross-check of lofts: slices of the finished meshes, between levels, against images of the strokes there.

What a loft is between its levels follows from no outline: walls are straight from one to the next. Images of the raster
stage say whose each sample is at such a height; it has to lie in the slice of that solid.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np
import shapely

from voronoi_tiles.base.arrays import Bools, Complexes, Floats
from voronoi_tiles.crosscheck.check_report import Figure, Marks
from voronoi_tiles.crosscheck.subject import Subject
from voronoi_tiles.raster.frame import cell_frame
from voronoi_tiles.raster.reference import decode, encode
from voronoi_tiles.raster.renderer import Choice, Method, Renderer
from voronoi_tiles.raster.scene import Pattern
from voronoi_tiles.solid.cross_sections import filled_section
from voronoi_tiles.solid.loft import Loft

SLICES: Final = 8
"""At how many heights a loft is looked at where nobody says; a count."""

SAMPLES: Final = 256
"""Samples of each along the side of the cell; a count."""

_NEAR: Final = 0.25
"""So near to a level no slice is; a share of the way to the next one."""

_AREA: Final = 1e-9
"""By how much the areas of slices may differ from the cell's; relative. It is rounding, of points and of sections."""


class _Slice(NamedTuple):
    """Samples at a height `z`: where they are `outside` of their solids, by how much in millimetres, and their places.

    `open` is how many are left out, because they are as near to another copy as far as the image's distances tell,
    `area` the relative error of the slices' areas.
    """

    z: float
    place: Complexes
    outside: Floats
    open: int
    area: float


def check_slices(
    loft: Loft,
    *,
    slices: int = SLICES,
    samples: int = SAMPLES,
    renderer: Choice = "auto",
    device: int | None = None,
    method: Method = "exact",
    notice: Callable[[str], None] | None = None,
) -> tuple[Figure, Figure]:
    """The figures "slices" and "slice areas" of a loft, between levels at heights all the way up.

    A sample may be outside the solid that it belongs to by the accuracy within which the loft was made.
    `renderer`, `device`, `method` and `notice` are those of Renderer. Raises RenderError, and ProofError where a solid
    is open.
    """
    accuracy, render = loft.accuracy, Renderer(renderer, device=device, method=method, notice=notice)
    found = [_slice(loft, z, render, samples) for z in between_levels(loft, slices)]
    worst = max(found, key=lambda one: float(one.outside.max(initial=0.0)))
    wrong = [one.outside > accuracy for one in found]
    left_out = sum(one.open for one in found)
    figure = Figure(
        "slices",
        "samples between levels that are outside the solid of the nearest strokes",
        sum(len(one.place) + one.open for one in found),
        sum(int(bad.sum()) for bad in wrong),
        float(worst.outside.max(initial=0.0)),
        accuracy,
        "mm",
        f"the accuracy of walls; worst of {len(found)} heights is z = {worst.z:.6g} mm; {left_out:,} samples are "
        "as near to another copy and left out",
        Marks(
            np.concatenate([one.place[bad] for one, bad in zip(found, wrong, strict=True)]),
            np.concatenate([one.outside[bad] for one, bad in zip(found, wrong, strict=True)]),
        ),
    )
    area = max(one.area for one in found)
    areas = Figure(
        "slice areas",
        "heights at which the slices of the solids of a cell have not its area together",
        len(found),
        sum(not one.area <= _AREA for one in found),
        area,
        _AREA,
        "of the cell",
        "rounding: with this, solids that hold their samples do not overlap",
    )
    return figure, areas


def between_levels(loft: Loft, count: int) -> Floats:
    """Heights between levels of a loft's meshes, ascending, all the way up; millimetres, float64 (n,).

    There are `count`, equally spaced but for those near a level, which are moved away from it; what falls together is
    one.
    """
    levels = np.unique(np.concatenate([mesh.vertices[:, 2] for mesh in loft.meshes]))
    aimed = levels[0] + (np.arange(count) + 0.5) / count * (levels[-1] - levels[0])
    below = np.searchsorted(levels, aimed, side="right") - 1
    near = _NEAR * np.diff(levels)[below]
    return np.unique(np.clip(aimed, levels[below] + near, levels[below + 1] - near))


def _slice(loft: Loft, z: float, render: Renderer, samples: int) -> _Slice:
    """The samples at a height in millimetres."""
    design, unit = loft.design, loft.design.unit_mm
    pattern = Pattern(tuple(loft.motion.at(z / unit)), design.group, design.lattice)
    image = render.render(pattern, cell_frame(design.lattice, samples))
    subject = Subject(design.units, (), pattern, image)
    decided: Bools = image.d2 - image.d1 > 2 * image.error(image.d2)
    row, column = np.nonzero(decided)
    codes = encode(image.copies[image.first[row, column]])
    place = image.frame.offsets(column.astype(float), row.astype(float))
    home = subject.pull_back(place, codes) * unit
    site_of = np.array([placement.site for placement in pattern.placements])
    site, copies = site_of[decode(codes)[:, 0]], np.bincount(site_of).tolist()
    outside, total = np.zeros(len(home)), 0.0
    for k, mesh in enumerate(loft.meshes):
        solid = filled_section(mesh, z)
        total += solid.area * copies[k]
        own = np.flatnonzero(site == k)
        points = home[own]
        shapely.prepare(solid)
        away = own[~shapely.contains_xy(solid, points.real, points.imag)]
        outside[away] = shapely.distance(solid, shapely.points(home[away].real, home[away].imag))
    cell = design.lattice.det * unit**2
    return _Slice(z, image.frame.origin + place, outside, int((~decided).sum()), abs(total - cell) / cell)
