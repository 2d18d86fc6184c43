"""By which straight way a tile can leave, and so come in, while copies around it stand."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import cached_property
from math import asin, degrees, inf, pi, sqrt
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Floats, Ints, plane
from voronoi_tiles.solid.free_directions import SLIDING, contacts, reliable, widest
from voronoi_tiles.solid.layers import Name
from voronoi_tiles.solid.loft import Loft
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.sweeping import Sweeping
from voronoi_tiles.vector.motion_codes import code_of, composed, moved, operation_of
from voronoi_tiles.vector.motions import Action, to_operation

UP: Final = (0.0, 0.0, 1.0)
"""Straight up."""

_REACH: Final = 6.0
"""A tile must have left all others when it has come so far to the side; relative to the largest tile's radius."""

_TRIALS: Final = 96
"""How many directions are tried where the widest leads into something that stands farther away; a count."""

_TIE: Final = 1e-9
"""What is no farther along an order of laying than this stands already; relative to the tile's radius."""


class WayOut(NamedTuple):
    """A way out: its `direction`, a unit vector, and the angle at which it leaves the nearest wall, in degrees."""

    direction: tuple[float, float, float]
    clearance: float


class _NearbyTiles(NamedTuple):
    """Copies of tiles as seen from above: their `names`, `places` and `boxes` around them.

    Places are float64 (n, 2), boxes float64 (n, 2, 2): the lower and the upper corner; in millimetres.
    """

    names: tuple[Name, ...]
    places: Floats
    boxes: Floats


class TileWays:
    """The ways out of the solid of one site of a loft, where it is drawn.

    Ways that are straight are looked for, without a turn, to any distance: the contact of walls that slide along each
    other is allowed (see `sweeping.CONTACT`). The place of a copy is the centre of its volume, seen from above.
    """

    def __init__(self, loft: Loft, site: int) -> None:
        self._loft, self._site = loft, site
        self._mesh = loft.meshes[site]
        self._places = np.array([mesh.centroid[:2] for mesh in loft.meshes])
        self._radii = [
            float(np.linalg.norm(mesh.vertices[:, :2] - place, axis=1).max())
            for mesh, place in zip(loft.meshes, self._places, strict=True)
        ]
        self._sweeps: dict[tuple[float, ...], tuple[Sweeping, dict[int, bool]]] = {}
        self._widest: dict[tuple[int, ...], Floats | None] = {}
        self._blocking = Counter[int]()

    def way(self, towards: complex | None) -> WayOut | None:
        """The way out while all copies stand whose places are behind its own `towards` a direction, a unit vector.

        It leads up, or aside on the floor. With None all copies stand, and it may lead down as well. Straight up, or
        down, is preferred, then what leaves the walls that the tile touches at the widest angle. None where the tile is
        locked: where each direction enters one of them, or where none that was tried leads past what is farther away.
        """
        standing = self._standing(towards)
        touched = tuple(k for k in self._walls if standing[k])
        normals = np.concatenate([np.zeros((0, 3)), *(self._walls[k] for k in touched)])
        if touched not in self._widest:
            self._widest[touched] = widest(normals, floor=towards is not None)
        best = self._widest[touched]
        if best is None:
            return None
        for direction in _candidates(normals, best, down=towards is None):
            if self._leaves(direction, standing, towards):
                sine = -float((normals @ direction).max(initial=-1.0))
                x, y, z = (direction + 0.0).tolist()  # no -0
                return WayOut((x, y, z), degrees(asin(min(max(0.0, sine), 1.0))))
        return None

    def _standing(self, towards: complex | None) -> Bools:
        """Which copies stand: what is in the same place as the tile counts as well."""
        if towards is None:
            return np.ones(len(self._copies.names), np.bool_)
        along = (self._copies.places - self._places[self._site]) @ [towards.real, towards.imag]
        return np.asarray(along <= _TIE * self._radii[self._site])

    def _leaves(self, direction: Floats, standing: Bools, towards: complex | None) -> bool:
        """Whether the tile comes out in a direction, past all that stand, and within reach."""
        radius = max(self._radii)
        forward = 0.0 if towards is None else float(direction[:2] @ [towards.real, towards.imag])
        rise = abs(float(direction[2]))
        far = min(
            float(np.ptp(self._mesh.vertices[:, 2])) / rise if rise > 0.0 else inf,
            (self._radii[self._site] + radius) / forward if forward > 0.0 else inf,
        )
        if far * float(np.hypot(*direction[:2])) > _REACH * radius:
            return False
        low, high = self._mesh.vertices.min(axis=0), self._mesh.vertices.max(axis=0)
        low, high = np.minimum(low, low + far * direction), np.maximum(high, high + far * direction)
        boxes = self._copies.boxes
        passed = standing & (boxes[:, 0] < high[:2]).all(axis=1) & (boxes[:, 1] > low[:2]).all(axis=1)
        key = tuple(direction.tolist())
        if key not in self._sweeps:
            self._sweeps[key] = Sweeping(self._mesh, direction), {}
        sweep, met = self._sweeps[key]
        # What was in the way of others is asked first.
        for k in sorted(np.flatnonzero(passed).tolist(), key=lambda k: -self._blocking[k]):
            if k not in met:
                met[k] = sweep.meets(self._image(k))
            if met[k]:
                self._blocking[k] += 1
                return False
        return True

    def _image(self, copy: int) -> TriangleMesh:
        site, code = self._copies.names[copy]
        return self._loft.image(site, operation_of(code))

    @cached_property
    def _walls(self) -> dict[int, Floats]:
        """The normals of the walls that the tile shares with each copy that it touches, float64 (m, 3)."""
        layers = [layer for level in self._loft.levels for layer in level.layers]
        beside = {name for layer in layers for ring in layer.rings[self._site] for name in ring}
        number = {name: k for k, name in enumerate(self._copies.names)}
        found = sorted(number[name] for name in beside)
        shared = contacts(self._mesh, [self._image(k) for k in found])
        wide, normals = reliable(self._mesh), self._mesh.normals
        return {k: normals[touched & wide] for k, touched in zip(found, shared, strict=True)}

    @cached_property
    def _copies(self) -> _NearbyTiles:
        """All copies that the tile may come near to within reach."""
        core, unit = self._loft.levels[0].core, self._loft.design.unit_mm
        here, within = complex(*self._places[self._site]), (_REACH + 2.0) * max(self._radii)
        sites, codes, places, boxes = [], [], [], []
        for site, own in enumerate(core.stabilizers):
            for motion in core.action.motions:
                image = self._loft.image(site, to_operation(motion))
                place = complex(*image.centroid[:2])
                steps = _steps(core.action, (here - place) / unit, within / unit)
                shifts = core.action.cartesian(*steps.T) * unit
                near = np.abs(place + shifts - here) <= within
                steps, shift = steps[near], plane(shifts[near])
                box = np.stack((image.vertices.min(axis=0), image.vertices.max(axis=0)))[None, :, :2]
                # A copy has the least of all names that it goes by.
                named = composed(moved(np.array([code_of(motion)]), *steps.T)[:, None], np.array(own)).min(axis=1)
                sites.append(np.full(len(named), site))
                codes.append(named)
                places.append(plane(np.array([place])) + shift)
                boxes.append(box + shift[:, None])
        owner, code = np.concatenate(sites), np.concatenate(codes)
        other = (owner != self._site) | (code != min(core.stabilizers[self._site]))
        _, first = np.unique(np.stack((owner, code))[:, other], axis=1, return_index=True)
        kept = np.flatnonzero(other)[first]
        names = tuple(zip(owner[kept].tolist(), code[kept].tolist(), strict=True))
        return _NearbyTiles(names, np.concatenate(places)[kept], np.concatenate(boxes)[kept])


def _steps(action: Action, away: complex, within: float) -> Ints:
    """The lattice vectors in a square about a point, and some more, intp (n, 2): integer coordinates over a and b."""
    corners = np.array([away + within * corner for corner in (1 + 1j, 1 - 1j, -1 + 1j, -1 - 1j)], np.complex128)
    u, v = (
        np.arange(np.floor(part.min()), np.ceil(part.max()) + 1) for part in action.lattice.reduced.fractional(corners)
    )
    steps = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    return np.asarray(steps @ np.array(action.reduced), np.intp)


def _candidates(normals: Floats, best: Floats, *, down: bool) -> Iterator[Floats]:
    """Directions that enter no wall: straight up or down if that is one, the best, others, first the clearest."""
    for straight in (np.array(UP), -np.array(UP))[: 1 + down]:
        if (normals @ straight).max(initial=-1.0) <= SLIDING:
            yield straight
    yield best
    # Spread evenly over the upper half of a sphere, or over all of it.
    k = np.arange(_TRIALS) + 0.5
    z = (1.0 - 2.0 * k / _TRIALS) if down else k / _TRIALS
    turn, flat = pi * (1.0 + sqrt(5.0)) * k, np.sqrt(1.0 - z * z)
    spread = np.column_stack((flat * np.cos(turn), flat * np.sin(turn), z))
    entered = (normals @ spread.T).max(axis=0, initial=-1.0)
    order = np.argsort(entered, kind="stable")
    yield from spread[order[: np.count_nonzero(entered < 0.0)]]
