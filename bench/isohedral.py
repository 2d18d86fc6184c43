"""Isohedral types without reflections: how the edges of a tile are mapped onto each other.

Sources: Heesch's 28 types; Gruenbaum and Shephard, Tilings and Patterns (1987), whose numbers the names are; the nine
most general ones as in Nagata and Imahori (see nearest_tiles.py). The others are these with edges of no length.
"""

from __future__ import annotations

import cmath
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

Complexes = NDArray[np.complex128]
Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

Kind = Literal["T", "C2", "C3", "C4", "C6", "G", "H"]
"""How an edge is mapped onto another: a translation, a rotation about the corner between both (C2: about the middle of
the edge, onto itself), a glide along x or along y."""


class Pairing(NamedTuple):
    """An edge, and the one that the tile has of it, both by their numbers along the tile."""

    kind: Kind
    edge: int
    onto: int


# Heesch's types, in the same order: TTTTTT, TGGTGG, TG1G2TG2G1, TCCTCC, TCCTGG, CG1CG2G1G2, C3C3C3C3C3C3, CC3C3C6C6 and
# its mirror image, CC4C4C4C4.
TEMPLATES: dict[str, tuple[Pairing, ...]] = {
    name: tuple(Pairing(kind, edge, onto) for kind, edge, onto in pairings)  # type: ignore[arg-type]
    for name, pairings in {
        "IH1": (("T", 0, 3), ("T", 1, 4), ("T", 2, 5)),
        "IH2": (("T", 0, 3), ("G", 1, 2), ("G", 4, 5)),
        "IH3": (("T", 0, 3), ("G", 1, 5), ("G", 2, 4)),
        "IH4": (("T", 0, 3), ("C2", 1, 1), ("C2", 2, 2), ("C2", 4, 4), ("C2", 5, 5)),
        "IH5": (("T", 0, 3), ("C2", 1, 1), ("C2", 2, 2), ("G", 4, 5)),
        "IH6": (("C2", 0, 0), ("C2", 2, 2), ("G", 1, 4), ("H", 3, 5)),
        "IH7": (("C3", 0, 1), ("C3", 2, 3), ("C3", 4, 5)),
        "IH21": (("C2", 0, 0), ("C3", 1, 2), ("C6", 3, 4)),
        "IH21 mirrored": (("C2", 0, 0), ("C6", 1, 2), ("C3", 3, 4)),
        "IH28": (("C2", 0, 0), ("C4", 1, 2), ("C4", 3, 4)),
    }.items()
}


class _Map(NamedTuple):
    """A map x -> linear x + shift t of the plane, float64 2 x 2 and 2 x 2g, t being all pairings' translations."""

    linear: Floats
    shift: Floats

    def after(self, first: _Map) -> _Map:
        """First the other, then this one."""
        return _Map(self.linear @ first.linear, self.linear @ first.shift + self.shift)

    @property
    def inverse(self) -> _Map:
        """The map that undoes this one."""
        back = np.asarray(np.linalg.inv(self.linear), np.float64)
        return _Map(back, -back @ self.shift)


@dataclass(frozen=True)
class Template:
    """A type: its pairings, and what follows from them."""

    name: str
    pairings: tuple[Pairing, ...]

    @cached_property
    def edges(self) -> tuple[int, ...]:
        """The pairing that each edge along the tile belongs to."""
        of = {edge: g for g, pairing in enumerate(self.pairings) for edge in pairing[1:]}
        return tuple(of[edge] for edge in range(len(of)))

    @cached_property
    def multiplicity(self) -> tuple[int, ...]:
        """The number of edges of each pairing."""
        return tuple(len({edge, onto}) for _, edge, onto in self.pairings)

    @cached_property
    def factors(self) -> tuple[complex, ...]:
        """The factor of each pairing's linear part: z -> factor z, or factor conj(z) for glides."""
        # The interior is on the left: about a corner an edge goes to the next one clockwise.
        values = {kind: cmath.exp(-2j * math.pi / order) for kind, order in (("C3", 3), ("C4", 4), ("C6", 6))}
        values |= {"T": 1 + 0j, "C2": -1 + 0j, "G": 1 + 0j, "H": -1 + 0j}
        return tuple(values[kind] for kind, _, _ in self.pairings)

    @cached_property
    def relations(self) -> list[tuple[int, int, int]]:
        """Which corner goes to which other one by which pairing; corner k is where edge k begins."""
        count = len(self.edges)
        found = []
        for g, (kind, edge, onto) in enumerate(self.pairings):
            if kind in "GH":
                found += [(g, edge, onto), (g, (edge + 1) % count, (onto + 1) % count)]
            elif kind == "T":
                found += [(g, edge, (onto + 1) % count), (g, (edge + 1) % count, onto)]
            else:
                found.append((g, edge, (onto + 1) % count))
        return found

    @cached_property
    def consistent(self) -> Floats:
        """A basis of the translations, 2 real numbers for each pairing, with which three tiles meet at each corner."""
        maps = [self._map(g) for g in range(len(self.pairings))]
        rows = []
        for corners in itertools.combinations(range(len(self.edges)), 3):
            steps = [(g, a, b) for g, a, b in self.relations if a in corners and b in corners]
            if len(steps) == len(corners):
                (way_a, way_b), direct = self._ways(steps, maps)
                around = way_b.after(way_a)
                assert np.allclose(around.linear, direct.linear), "three tiles fit around a corner"
                rows.append(around.shift - direct.shift)
        _, values, basis = np.linalg.svd(np.vstack(rows))
        return np.asarray(basis[np.count_nonzero(values > 1e-9) :].T)

    @staticmethod
    def _ways(steps: Sequence[tuple[int, int, int]], maps: Sequence[_Map]) -> tuple[tuple[_Map, _Map], _Map]:
        """From one of three corners to another, over the third and straight."""
        ways = {(a, b): maps[g] for g, a, b in steps}
        ways |= {(b, a): maps[g].inverse for g, a, b in steps}
        a, b, c = sorted({corner for way in ways for corner in way})
        return (ways[a, b], ways[b, c]), ways[a, c]

    def _map(self, g: int) -> _Map:
        """A pairing as a map of the translations."""
        factor, shift = self.factors[g], np.zeros((2, 2 * len(self.pairings)))
        shift[:, 2 * g : 2 * g + 2] = np.eye(2)
        sign = -1.0 if self.pairings[g].kind in "GH" else 1.0
        linear = np.array([[factor.real, -sign * factor.imag], [factor.imag, sign * factor.real]])
        return _Map(linear, shift)

    def weights(self, g: int) -> tuple[float, float, float]:
        """What a pair of points counts within an edge, at its beginning, and at its end.

        Two points that are one on the tile leave half the square of their distance, and three corners a third of all
        three; a centre of rotation leaves the square of its own. Half turns see each pair twice.
        """
        kind = self.pairings[g].kind
        if kind == "C2":
            return 1 / 4, 1 / 6, 1 / 6
        centre = 1 / abs(1 - self.factors[g]) ** 2 if kind in {"C3", "C4", "C6"} else 1 / 3
        return 1 / 2, 1 / 3, centre

    def numbers(self, points: int) -> Ints:
        """All numbers of steps along the edges, one for each pairing, of polygons with so many points: intp (m, g)."""
        free = [range(1, points // m + 1) for m in self.multiplicity[:-1]]
        rows = np.array(list(itertools.product(*free[:2])), np.intp)
        for values in free[2:]:
            rows = np.column_stack((np.repeat(rows, len(values), 0), np.tile(np.array(values), len(rows))))
            rows = rows[rows @ self.multiplicity[: rows.shape[1]] < points]
        rest = points - rows @ self.multiplicity[:-1]
        last = self.multiplicity[-1]
        right = (rest >= last) & (rest % last == 0)
        return np.asarray(np.column_stack((rows, rest // last))[right], np.intp)

    @cached_property
    def moves(self) -> Ints:
        """All changes of the numbers by one at most that keep their sum, each with changes of the beginning."""
        steps = np.array(list(itertools.product((-1, 0, 1), repeat=len(self.pairings) + 1)), np.intp)
        return np.asarray(steps[steps[:, :-1] @ self.multiplicity == 0])

    def solving(self, numbers: Ints) -> Floats:
        """What gives the best translations from sums of differences: float64 (m, 2g, 2g), symmetric."""
        weight = np.empty(numbers.shape)
        for g in range(len(self.pairings)):
            inner, first, last = self.weights(g)
            weight[:, g] = inner * (numbers[:, g] - 1) + first + last
        basis = self.consistent
        gram = np.einsum("ia,mi,ib->mab", basis, np.repeat(weight, 2, axis=1), basis)
        return np.asarray(basis @ np.linalg.inv(gram) @ basis.T)
