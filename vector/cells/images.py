"""The half-edges and corners of all copies of the sites, as seen from the sites whose cells are sought."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, offsets_of, ranges
from voronoi_tiles.base.maps import move
from voronoi_tiles.vector.cells.half_edges import Contour
from voronoi_tiles.vector.copies import Copies


@dataclass(frozen=True, slots=True)
class Images:
    """What each copy has of some things: the images of those in its bundle, copy after copy, flat.

    Image k is that of the thing `thing[k]` in the copy `copy[k]` (intp, k). In copy c the thing t, of its bundle, has
    the place `first[c] + rank[t]` (intp; copies and things).
    """

    thing: Ints
    copy: Ints
    first: Ints
    rank: Ints

    @classmethod
    def of(cls, bundle: Ints, copies: Copies) -> Images:
        """The images of things of these bundles, intp (k,), in the order of the things in each copy."""
        things, several = len(bundle), len(copies)
        if copies.bundles == 1:
            rank, number = np.arange(things), np.arange(several)
            return cls(np.tile(rank, several), np.repeat(number, things), number * things, rank)
        order = np.argsort(bundle, kind="stable")
        offsets = offsets_of(np.bincount(bundle, minlength=copies.bundles))
        count = np.diff(offsets)[copies.bundle]
        rank = np.empty_like(order)
        rank[order] = np.arange(len(order)) - np.repeat(offsets[:-1], np.diff(offsets))
        thing = order[ranges(offsets[copies.bundle], count)]
        return cls(thing, np.repeat(np.arange(several), count), offsets_of(count)[:-1], rank)

    def place(self, copy: Ints, thing: Ints) -> Ints:
        """Where the images of things in copies stand, intp (k,)."""
        return self.first[copy] + self.rank[thing]

    def moved(self, values: Complexes, copies: Copies) -> Complexes:
        """The images of points, complex128 (..., things), in the plane."""
        unit, shift, conj = copies.unit[self.copy], copies.shift[self.copy], copies.conj[self.copy]
        return move(values.take(self.thing, axis=-1), unit, shift, conj)

    def turned(self, values: Complexes, unit: Complexes, conj: Bools) -> Complexes:
        """The images of directions, complex128 (..., things), that copies turn by `unit`, mirrored where `conj`."""
        return move(values.take(self.thing, axis=-1), unit[self.copy], 0j, conj[self.copy])


@dataclass(frozen=True, slots=True)
class Surroundings:
    """The half-edges and corners of all copies, the face on the left of each.

    A copy that is turned over has its half-edges run through backwards: from their `target` to their `source`. `node`,
    `arriving` and `leaving` (complex128, flat over the copies) are the positions of nodes, and the unit vectors of the
    half-edges before and after a corner; their places are in `nodes` and `corners`. `direction` (complex128) are the
    unit vectors of half-edges, in the places of the corners at their ends.
    """

    contour: Contour
    copies: Copies
    nodes: Images
    corners: Images
    node: Complexes
    arriving: Complexes
    leaving: Complexes
    direction: Complexes

    def ends(self, copy: Ints, half_edge: Ints) -> tuple[Ints, Ints]:
        """The nodes from and to which half-edges run in copies."""
        source, target, turned = self.contour.source[half_edge], self.contour.target[half_edge], self.copies.conj[copy]
        return np.where(turned, target, source), np.where(turned, source, target)

    def position(self, copy: Ints, node: Ints) -> Complexes:
        """The positions of nodes in copies."""
        return self.node[self.nodes.place(copy, node)]


def surround(contour: Contour, copies: Copies, node_bundle: Ints) -> Surroundings:
    """All copies of the sites; `node_bundle` (intp, m) is the bundle of each of the contour's nodes."""
    nodes, corners = Images.of(node_bundle, copies), Images.of(node_bundle[contour.corner_node], copies)
    # Run through backwards, the two half-edges at a corner change places.
    beside, turned = np.array((contour.arriving, contour.leaving)), copies.conj[corners.copy]
    before, after = corners.turned(beside, np.where(copies.conj, -copies.unit, copies.unit), copies.conj)
    return Surroundings(
        contour=contour,
        copies=copies,
        nodes=nodes,
        corners=corners,
        node=nodes.moved(contour.nodes, copies),
        arriving=np.where(turned, after, before),
        leaving=np.where(turned, before, after),
        direction=before,
    )
