"""A shaded picture of solids, by numpy alone: seen from above at an angle, with lines at their edges and a shadow."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Bools, Floats, Ints, counting, offsets_of
from voronoi_tiles.base.errors import ArgumentError
from voronoi_tiles.base.values import is_number
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.pieces import SolidPiece
from voronoi_tiles.solid.visible import NOTHING, barycentric, seen

SIZE: Final = 1200
"""The longer side of a picture where nobody says; pixels."""

SIZE_MAX: Final = 4000
"""Largest side; pixels. What is computed is three times as wide and as high."""

_STRIP: Final = 2_000_000
"""So many points are computed at once, a strip of the picture; a count. Bounds the memory whatever its size."""

_FINER: Final = 3
"""Points along each side of a pixel, whose mean it shows."""

_TURN: Final = np.radians(-24.0)
_TILT: Final = np.radians(42.0)
"""Where one looks from: turned about the vertical, and so much above the horizon; radians."""

_LIGHT: Final = np.array([-0.45, -0.35, 0.82]) / np.linalg.norm([-0.45, -0.35, 0.82])
"""Where the light comes from, as seen: from the left, the front and above."""

_AMBIENT: Final = 0.44
_DIFFUSE: Final = 0.67
"""Light from everywhere and from the light: what lies level has its own colour, nearly."""

_CREASE: Final = np.cos(np.radians(32.0))
"""Faces that meet at a smaller angle are shaded as one."""

_LINE: Final = 0.45
"""How dark lines at edges are; 1 is no line."""

_SHADOW: Final = 0.30
"""How dark the shadow on the ground is where it is darkest."""

_BLUR: Final = 0.012
"""How far the edge of the shadow runs; a share of the picture's longer side."""

_MEANS: Final = 3
"""So many running means make the edge of the shadow soft; a count."""

_MARGIN: Final = 0.06
"""What stays free around solids; a share of the picture's longer side."""

_GROUND: Final = np.array([0.985, 0.982, 0.972])
"""The colour of the ground."""


class _Camera(NamedTuple):
    """An orthographic view: `axes` are right, down and toward the eye; pixels are `scale` ((x, y) - `corner`)."""

    axes: Floats
    scale: float
    corner: Floats
    width: int
    height: int

    @classmethod
    def of(cls, points: Floats, size: int) -> Self:
        """The view of all points whose longer side has so many pixels."""
        c, s = np.cos(_TURN), np.sin(_TURN)
        right = np.array([c, s, 0.0])
        away = np.array([-s, c, 0.0])
        toward = -away * np.cos(_TILT) + np.array([0.0, 0.0, np.sin(_TILT)])
        down = -np.cross(toward, right)
        axes = np.stack((right, down, toward))
        flat = points @ axes[:2].T
        low, high = flat.min(axis=0), flat.max(axis=0)
        margin = _MARGIN * float((high - low).max())
        low, high = low - margin, high + margin
        scale = size / float((high - low).max())
        width, height = np.maximum(np.ceil((high - low) * scale), _FINER).astype(int).tolist()
        return cls(axes, scale, low, width, height)

    def __call__(self, corners: Floats) -> Floats:
        """Corners of triangles as seen: x and y in pixels, and depth."""
        seen_from = corners @ self.axes.T
        seen_from[:, :, :2] = (seen_from[:, :, :2] - self.corner) * self.scale
        return np.asarray(seen_from)


def picture(pieces: Sequence[SolidPiece], colours: Sequence[str], size: int = SIZE) -> NDArray[np.uint8]:
    """The picture of solids in their colours, "#rrggbb": uint8 (height, width, 3); its longer side has `size` pixels.

    Raises ArgumentError for a size that cannot be.
    """
    if not is_number(size) or not 1 <= size <= SIZE_MAX or size != int(size):
        raise ArgumentError(f"`size` {size!r} cannot be", remedy=f"Give a number of pixels from 1 to {SIZE_MAX}.")
    corners = np.concatenate([piece.mesh.corners for piece in pieces])
    owner = np.repeat(np.arange(len(pieces)), [len(piece.mesh.triangles) for piece in pieces])
    light = _light()
    shadow = corners - light * (corners[:, :, 2:] - corners[:, :, 2].min()) / light[2]
    view = _Camera.of(np.concatenate([corners, shadow]).reshape(-1, 3), size * _FINER)
    normals = np.concatenate([piece.mesh.normals for piece in pieces])
    front = np.flatnonzero(normals @ view.axes[2] > 0.0)
    base = np.array([[int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)] for colour in colours])
    lit = _LitTriangles(
        view,
        view(corners[front]),
        view(shadow[front]),
        normals[front],
        np.concatenate([smooth_normals(piece.mesh) for piece in pieces])[front],
        owner[front],
        base[[piece.colour for piece in pieces]],
    )
    step = max(_STRIP // (_FINER * view.width), 1) * _FINER
    return np.concatenate([_coarser(lit.strip(top, top + step)) for top in range(0, view.height, step)])


class _LitTriangles(NamedTuple):
    """What is drawn, m triangles that face the eye, and their shadows, `at` and `shadow` as seen (float64, m x 3 x 3).

    `normals` (m, 3) are theirs, `smooth` (m, 3, 3) those at their corners; `owner` is the number of the piece, and
    `hues` (k, 3) are the colours of these.
    """

    view: _Camera
    at: Floats
    shadow: Floats
    normals: Floats
    smooth: Floats
    owner: Ints
    hues: Floats

    def strip(self, top: int, bottom: int) -> Floats:
        """The rows from `top` to `bottom`, or the last, in full resolution: float64 (rows, width, 3) from 0 to 1."""
        # Lines at edges reach into the next row.
        some = self._rows(top, bottom, 1)
        own = slice(top - some.start, bottom - some.start)
        found = seen(self.at, self.view.width, some)
        image = np.broadcast_to(_GROUND, (*found[own].shape, 3)).copy()
        image *= 1.0 - _SHADOW * self._shade(top, bottom)[:, :, None]
        y, x = np.nonzero(found[own] != NOTHING)
        triangle = found[own][y, x]
        weights = barycentric(self.at, triangle, x.astype(np.float64) + 0.5, y.astype(np.float64) + (top + 0.5))
        normal = (weights[:, :, None] * self.smooth[triangle]).sum(axis=1)
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
        light = _AMBIENT + _DIFFUSE * np.clip(normal @ _light(), 0.0, None)
        image[y, x] = np.clip(self.hues[self.owner[triangle]] * light[:, None], 0.0, 1.0)
        image[_edges(found, self.owner, self.normals)[own]] *= _LINE
        return image

    def _shade(self, top: int, bottom: int) -> Floats:
        """How dark the shadow is in some rows: float64 (rows, width) from 0 to 1."""
        reach = max(round(_BLUR * max(self.view.width, self.view.height)), 1)
        some = self._rows(top, bottom, _MEANS * reach)
        mask = seen(self.shadow, self.view.width, some) != NOTHING
        return _blurred(mask, reach)[top - some.start : bottom - some.start]

    def _rows(self, top: int, bottom: int, more: int) -> range:
        """Some rows and `more` on either side, those that there are."""
        return range(max(top - more, 0), min(bottom + more, self.view.height))


def _light() -> Floats:
    """The direction to the light in space."""
    c, s = np.cos(_TURN), np.sin(_TURN)
    x, y, z = _LIGHT.tolist()
    return np.array([c * x - s * y, s * x + c * y, z])


def smooth_normals(mesh: TriangleMesh) -> Floats:
    """The normals at the corners of triangles, float64 (m, 3, 3): the mean of the faces there that meet softly."""
    normals, areas = mesh.normals, mesh.areas
    order = np.argsort(mesh.triangles.ravel(), kind="stable")
    start = offsets_of(np.bincount(mesh.triangles.ravel(), minlength=len(mesh.vertices)))
    vertex = mesh.triangles.ravel()
    number, corner = counting(np.diff(start)[vertex])
    other = order[start[:-1][vertex[corner]] + number] // 3
    soft = np.einsum("ij,ij->i", normals[corner // 3], normals[other]) > _CREASE
    weight = np.where(soft, areas[other], 0.0)
    total = np.stack([np.bincount(corner, weight * normals[other, k], len(vertex)) for k in range(3)], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.asarray(
        np.where(length > 0.0, total / np.maximum(length, 1e-300), normals[np.arange(len(vertex)) // 3])
    ).reshape(-1, 3, 3)


def _edges(found: Ints, owner: Ints, normals: Floats) -> Bools:
    """Where lines are drawn: where one piece ends before another, and where faces meet sharply."""
    piece = np.where(found == NOTHING, NOTHING, owner[found])
    lines = np.zeros(found.shape, np.bool_)
    for axis in (0, 1):
        a, b = np.moveaxis(found, axis, 0)[:-1], np.moveaxis(found, axis, 0)[1:]
        p, q = np.moveaxis(piece, axis, 0)[:-1], np.moveaxis(piece, axis, 0)[1:]
        differ = a != b
        sharp = np.zeros(a.shape, np.bool_)
        sharp[differ] = (p[differ] != q[differ]) | (
            np.einsum("ij,ij->i", normals[a[differ]], normals[b[differ]]) < _CREASE
        )
        np.moveaxis(lines, axis, 0)[:-1] |= sharp
        np.moveaxis(lines, axis, 0)[1:] |= sharp
    return lines


def _blurred(mask: Bools, reach: int) -> Floats:
    """A mask with soft edges: three running means over `reach` on either side, which come near a Gaussian."""
    soft = mask.astype(np.float64)
    for _ in range(_MEANS):
        for axis in (0, 1):
            padded = np.concatenate([np.zeros_like(np.take(soft, range(1), axis)), soft], axis=axis).cumsum(axis=axis)
            n = soft.shape[axis]
            low, high = np.clip(np.arange(n) - reach, 0, n), np.clip(np.arange(n) + reach + 1, 0, n)
            soft = (np.take(padded, high, axis) - np.take(padded, low, axis)) / (2 * reach + 1)
    return soft


def _coarser(image: Floats) -> NDArray[np.uint8]:
    """The means of _FINER x _FINER points, in linear light."""
    height, width = (side // _FINER * _FINER for side in image.shape[:2])
    linear = image[:height, :width] ** 2.2
    mean = linear.reshape(height // _FINER, _FINER, width // _FINER, _FINER, 3).mean(axis=(1, 3))
    return np.asarray(np.round(255 * mean ** (1 / 2.2)), np.uint8)
