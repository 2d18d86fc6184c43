"""Where copies touch or cross, marked in a picture: the two copies that do, the place, and all its images."""

from __future__ import annotations

import math

import numpy as np

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.groups.symmetry_elements import images_in
from voronoi_tiles.groups.wallpaper import Lattice
from voronoi_tiles.raster.picture import Overlay, Region
from voronoi_tiles.vector.cells.touching import refuse_touching
from voronoi_tiles.vector.copies import place
from voronoi_tiles.vector.motions import Action

_PAPER = (255, 255, 255)
_SITE, _OTHER, _PLACE = (214, 20, 40), (20, 60, 214), (230, 0, 140)
"""The colours of the site, of the copy that touches it, and of the rings about the place: red, green, blue."""

_DOT = 2.0
"""How wide an isolated point is drawn; widths of strokes."""

_IMAGES_MAX = 2000
"""Cells in a picture up to which all images of the place are marked; a count. In more they would be a blot."""


def find_clash(design: Design) -> TouchingCopiesError | None:
    """The error that says which copies touch, None where all keep apart: without the tiles, which take longer."""
    action = Action(design.group, design.lattice)
    placed, _ = place(action, design.noded)
    try:
        refuse_touching(action, tuple(site.name for site in design.noded), placed)
    except TouchingCopiesError as error:
        return error
    return None


def touching_pair(error: TouchingCopiesError, design: Design) -> tuple[Complexes, Complexes]:
    """The segments (n, 2) of the site that an error names, and those (m, 2) of the copy that touches it."""
    ends = {site.name: site.ends for site in design.noded}
    return ends[error.site], design.lattice.isometry(error.operation)(ends[error.other])


def clash_marks(error: TouchingCopiesError, design: Design, region: Region, width: int, height: int) -> list[Overlay]:
    """The two copies that touch in strong colours, a ring about the place, and small ones about its images.

    The pair is where the error names it; where that lies outside the region, the translates of both that are nearest to
    the region's middle. `width` and `height` are the picture's, pixels.
    """
    x0, y0, x1, y1 = region
    pixel = (x1 - x0) / width
    side = math.sqrt(width * height)
    line = max(1.0, side / 500)
    own, other = touching_pair(error, design)
    spot = error.place
    if not (x0 <= spot.real <= x1 and y0 <= spot.imag <= y1):
        shift = _nearest_vector(design.lattice, complex(x0 + x1, y0 + y1) / 2 - spot)
        own, other, spot = own + shift, other + shift, spot + shift
    found = []
    # The other one is wider, so that it shows where both lie on each other.
    for segments, colour, wide, halo in ((other, _OTHER, 7.0, 2.0), (own, _SITE, 3.0, 1.0)):
        point = segments[:, 0] == segments[:, 1]
        for part, dot in ((segments[~point], 1.0), (segments[point], _DOT)):
            found += [Overlay(part, (dot * wide + halo) * line, _PAPER), Overlay(part, dot * wide * line, colour)]
    radius = max(8.0, side / 45) * pixel
    images = _images(error.place, design, region)
    small = rings_about(images[np.abs(images - spot) > radius], 0.4 * radius)
    for rings, wide in ((small, 2.0), (rings_about(np.array([spot]), radius), 4.0)):
        found += [Overlay(rings, (wide + 2.5) * line, _PAPER), Overlay(rings, wide * line, _PLACE)]
    return found


def rings_about(places: Complexes, radius: float) -> Complexes:
    """The sides of polygons that look like circles about places (n,): complex128 (m, 2)."""
    corners = places[:, None] + radius * np.exp(2j * np.pi * np.arange(41) / 40)
    return np.stack((corners[:, :-1], corners[:, 1:]), axis=-1).reshape(-1, 2)


def _images(spot: complex, design: Design, region: Region) -> Complexes:
    """The images of a spot, under all operations of the group, in a region: complex128 (n,); none if too many."""
    x0, y0, x1, y1 = region
    lattice = design.lattice
    if (x1 - x0) * (y1 - y0) > _IMAGES_MAX * lattice.det:
        return np.zeros(0, complex)
    own = [lattice.isometry(operation)(spot) for operation in design.group.operations]
    return np.concatenate([images_in(complex(image), lattice, region) for image in own])


def _nearest_vector(lattice: Lattice, z: complex) -> complex:
    """A lattice vector near z: the nearest of the four about it, in the reduced basis."""
    reduced = lattice.reduced
    s, t = (math.floor(part) for part in reduced.fractional(z))
    return min((reduced.cartesian(s + i, t + j) for i in (0, 1) for j in (0, 1)), key=lambda vector: abs(vector - z))
