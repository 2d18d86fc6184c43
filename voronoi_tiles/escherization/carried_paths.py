"""Paths carried by a map that is not affine: each curve becomes as many cubic ones as its image asks for."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints, offsets_of
from voronoi_tiles.escherization.carrying import Carrying
from voronoi_tiles.paths.conversion import to_cubics
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths, halves

_LOOKED_AT: Final = np.array([0.25, 0.5, 0.75])
"""Where the image of a curve is compared with the map's; shares of the curve's parameter."""

_PIECE: Final = 0.25
"""Curves are cut into pieces shorter than this part of the reach first: none leaps over what is moved."""

_DEPTH: Final = 12
"""How often a piece is halved at most; where the map has a kink, on the outline, the last ones are nanometres."""


class _Pieces(NamedTuple):
    """Pieces of cubics (4, n), the segment of each, and where on it each begins: its order."""

    curves: Complexes
    segment: Ints
    begin: Floats
    length: Floats  # of the parameter

    def take(self, which: Bools) -> _Pieces:
        """Some of them."""
        return _Pieces(self.curves[:, which], self.segment[which], self.begin[which], self.length[which])

    def halved(self) -> _Pieces:
        """Both halves of each."""
        half = self.length / 2
        return _Pieces(
            halves(self.curves).reshape(4, -1),
            np.tile(self.segment, 2),
            np.concatenate((self.begin, self.begin + half)),
            np.tile(half, 2),
        )

    @staticmethod
    def joined(parts: list[_Pieces]) -> _Pieces:
        """All of several."""
        return _Pieces(
            np.concatenate([part.curves for part in parts], axis=1),
            *(np.concatenate([part[k] for part in parts]) for k in (1, 2, 3)),
        )


def carried_paths(paths: Paths, carrying: Carrying, *, accuracy: float) -> Paths:
    """The images of paths, as LINEs and CUBICs that keep their tangents, and QUADs where nothing moves.

    They lie within `accuracy` (in the paths' unit) of the map's image, as far as is seen at three points of every
    piece. A segment that does not move stays as it is, but for an ARC, which becomes CUBICs. Raises ValueError where
    an ARC's accuracy is not positive and finite, or finer than the coordinates' resolution.
    """
    paths = _without_arcs(paths, accuracy / 2)
    if not len(paths.start):
        return paths
    pieces = _small(_whole(paths), _PIECE * carrying.reach)
    still = _still(pieces, carrying, len(paths.start))
    moving = pieces.take(~still[pieces.segment])
    done, images = [_whole(paths).take(still)], [_kept(paths, still)]
    for depth in range(_DEPTH + 1):
        if not len(moving.segment):
            break
        image, error = _image(moving, carrying)
        right = error <= accuracy / 2 if depth < _DEPTH else np.ones(len(error), np.bool_)
        done.append(moving.take(right))
        images.append(image[:, right])
        moving = moving.take(~right).halved()
    return _assembled(paths, _Pieces.joined(done), np.concatenate(images, axis=1), still, accuracy / 2)


def _without_arcs(paths: Paths, accuracy: float) -> Paths:
    """The same with CUBICs in the place of ARCs."""
    return to_cubics(paths, accuracy=accuracy) if (paths.kind == ARC).any() else paths


def _whole(paths: Paths) -> _Pieces:
    """Every segment as one cubic."""
    start, end, (c0, c1) = paths.start, paths.end, paths.control.T
    line, quad = paths.kind == LINE, paths.kind == QUAD
    near = np.where(line, start + (end - start) / 3, np.where(quad, start + (c0 - start) * (2 / 3), c0))
    far = np.where(line, end + (start - end) / 3, np.where(quad, end + (c0 - end) * (2 / 3), c1))
    count = len(start)
    return _Pieces(np.stack((start, near, far, end)), np.arange(count), np.zeros(count), np.ones(count))


def _small(pieces: _Pieces, length: float) -> _Pieces:
    """Pieces whose control polygons are no longer than a length."""
    done = []
    while len(pieces.segment):
        small = np.abs(np.diff(pieces.curves, axis=0)).sum(axis=0) <= length
        done.append(pieces.take(small))
        pieces = pieces.take(~small).halved()
    return _Pieces.joined(done)


def _points(curves: Complexes, at: Floats) -> Complexes:
    """Points of cubics (4, n) at some parameters: complex128 (parameters, n)."""
    s, t = 1.0 - at[:, None], at[:, None]
    a, b, c, d = curves
    return np.asarray(a * s**3 + b * (3 * s * s * t) + c * (3 * s * t * t) + d * t**3)


def _still(pieces: _Pieces, carrying: Carrying, segments: int) -> Bools:
    """The segments of which nothing moves."""
    shift = carrying.shift(np.concatenate((pieces.curves[[0, 3]], _points(pieces.curves, _LOOKED_AT))))
    return np.asarray(np.bincount(pieces.segment, (shift != 0.0).any(axis=0), segments) == 0.0)


def _kept(paths: Paths, still: Bools) -> Complexes:
    """The segments of which nothing moves, as columns of an image."""
    return np.stack((paths.start, *paths.control.T, paths.end))[:, still]


def _image(pieces: _Pieces, carrying: Carrying) -> tuple[Complexes, Floats]:
    """The cubics with the image's ends and tangents there, and how far the image is from them at equal parameters."""
    curves = pieces.curves
    ends = carrying(curves[[0, 3]])
    tangents: Complexes = 3.0 * np.diff(curves, axis=0)[[0, 2]]
    leaving, arriving = carrying.derivative(curves[[0, 3]], tangents)
    image = np.stack((ends[0], ends[0] + leaving / 3, ends[1] - arriving / 3, ends[1]))
    apart = np.abs(_points(image, _LOOKED_AT) - carrying(_points(curves, _LOOKED_AT)))
    return image, apart.max(axis=0)


def _assembled(paths: Paths, pieces: _Pieces, image: Complexes, still: Bools, accuracy: float) -> Paths:
    """Paths of the images, in the order of what they are images of; each starts where the one before ends."""
    order = np.lexsort((pieces.begin, pieces.segment))
    segment, image = pieces.segment[order], image[:, order]
    offsets = offsets_of(np.bincount(paths.owner[segment], minlength=len(paths)))
    start = image[0]
    end = np.roll(start, -1)
    last = offsets[1:] - 1
    end[last] = np.where(paths.closed, start[offsets[:-1]], image[3, last])
    kind, control = np.where(still[segment], paths.kind[segment], CUBIC).astype(np.uint8), image[1:3].T.copy()
    # What was straight, and still is, stays a line.
    chord = start + (end - start) * _LOOKED_AT[:, None]
    bent = np.abs(_points(np.stack((start, image[1], image[2], end)), _LOOKED_AT) - chord).max(axis=0)
    kind[~still[segment] & (paths.kind[segment] == LINE) & (bent <= accuracy)] = LINE
    control[kind == LINE] = 0.0
    control[kind != CUBIC, 1] = 0.0
    return Paths(start=start, end=end, control=control, kind=kind, offsets=offsets, closed=paths.closed)
