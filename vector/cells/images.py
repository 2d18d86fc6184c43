"""The half-edges and corners of all copies of the sites, as seen from the sites whose cells are sought."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints, offsets_of, ranges
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
        """The images of points, complex128 (things,), in the plane."""
        return move(values[self.thing], copies.unit[self.copy], copies.shift[self.copy], copies.conj[self.copy])

    def turned(self, values: Complexes, reversed_values: Complexes, copies: Copies) -> Complexes:
        """The images of directions of half-edges; copies that are turned over run through `reversed_values` back."""
        conj, unit = copies.conj[self.copy], copies.unit[self.copy]
        chosen = np.where(conj, reversed_values[self.thing], values[self.thing])
        return move(chosen, np.where(conj, -unit, unit), np.zeros(1, complex), conj)


@dataclass(frozen=True, slots=True)
class Surroundings:
    """The half-edges and corners of all copies, the face on the left of each.

    A copy that is turned over has its half-edges run through backwards: from their `target` to their `source`. `node`,
    `direction`, `arriving` and `leaving` (complex128, flat over the copies) are the positions of nodes, the unit
    vectors of half-edges, and those of the half-edges before and after a corner; their places are in `nodes`,
    `half_edges` and `corners`.
    """

    contour: Contour
    copies: Copies
    nodes: Images
    half_edges: Images
    corners: Images
    node: Complexes
    direction: Complexes
    arriving: Complexes
    leaving: Complexes

    def ends(self, copy: Ints, half_edge: Ints) -> tuple[Ints, Ints]:
        """The nodes from and to which half-edges run in copies."""
        source, target, turned = self.contour.source[half_edge], self.contour.target[half_edge], self.copies.conj[copy]
        return np.where(turned, target, source), np.where(turned, source, target)

    def position(self, copy: Ints, node: Ints) -> Complexes:
        """The positions of nodes in copies."""
        return self.node[self.nodes.place(copy, node)]


def surround(contour: Contour, copies: Copies, node_bundle: Ints) -> Surroundings:
    """All copies of the sites; `node_bundle` (intp, m) is the bundle of each of the contour's nodes."""
    half_edge_bundle, corner_bundle = node_bundle[contour.source], node_bundle[contour.corner_node]
    nodes, corners = Images.of(node_bundle, copies), Images.of(corner_bundle, copies)
    lone = len(corner_bundle) > len(half_edge_bundle)
    half_edges = Images.of(half_edge_bundle, copies) if lone else corners
    return Surroundings(
        contour=contour,
        copies=copies,
        nodes=nodes,
        half_edges=half_edges,
        corners=corners,
        node=nodes.moved(contour.nodes, copies),
        direction=half_edges.turned(contour.direction, contour.direction, copies),
        arriving=corners.turned(contour.arriving, contour.leaving, copies),
        leaving=corners.turned(contour.leaving, contour.arriving, copies),
    )
