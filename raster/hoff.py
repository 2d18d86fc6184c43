"""The paper's own method: cones over points, tents over segments, seen from below through a depth test.

Source: Hoff, Keyser, Lin, Manocha, Culver, "Fast computation of generalized Voronoi diagrams using graphics hardware",
SIGGRAPH 1999. A tent is exact. A cone of n sides is too high between its edges by a factor of 1/cos(pi/n); scaled by
2c/(1 + c), c = cos(pi/n), it is wrong by a factor of 1 +- tan^2(pi/2n) at most.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.raster.block_lists import BlockLists
from voronoi_tiles.raster.frame import WINDOW, Frame
from voronoi_tiles.raster.gl import Device, Floats32, gl_errors
from voronoi_tiles.raster.scene import Labels

SIDES = 128
"""Sides of a cone; a multiple of 4."""


def cone_error(sides: int = SIDES) -> float:
    """The relative error of a cone's height."""
    return math.tan(math.pi / (2 * sides)) ** 2


def mesh_error(distance: Floats | float, frame: Frame, *, farthest: float, sides: int = SIDES) -> Any:
    """A bound for the error of a distance rendered from meshes by OpenGL, in units.

    The cones' own error. Corners that the rasteriser puts on a grid of 1/256 pixel (GL_SUBPIXEL_BITS is 8): where two
    planes meet, the one may be taken for the other so far beyond, and their slopes differ by 2 at most. Positions in
    float32, up to the frame's size, and a depth buffer of 24 bits over `farthest`.
    """
    snapping = (abs(frame.u) + abs(frame.v)) / 128
    window = min(frame.radius, frame.half_diagonal(WINDOW))
    return cone_error(sides) * distance + snapping + 16 * 2.0**-24 * (farthest + 2 * window)


def heights(along: Floats, across: Floats, sides: int = SIDES) -> Floats:
    """The heights of the mesh of an element, float64, at points `along` beyond its ends (0 beside it) and `across`."""
    distance = np.hypot(along, across)
    wedge = 2 * math.pi / sides
    turn = np.abs(np.remainder(np.arctan2(np.abs(across), along), wedge) - wedge / 2)
    cosine = math.cos(wedge / 2)
    return np.where(along > 0.0, distance * np.cos(turn) * (2.0 / (1.0 + cosine)), np.abs(across))


def reaches(candidates: BlockLists) -> tuple[NDArray[np.intp], Floats]:
    """The elements that matter anywhere in the frame, and how far from each: cones need be no wider."""
    reach = np.full(len(candidates.scene), -1.0)
    np.maximum.at(reach, candidates.element, candidates.from_centres() + candidates.radius)
    used = np.flatnonzero(reach > 0.0)
    return used, reach[used]


def template(sides: int = SIDES) -> Floats32:
    """The triangles of an element's mesh for a reach of 1: rows end (-1 or 1), along, across, gradient of height."""
    half = math.pi / sides
    rim = 1.0 / math.cos(half)  # so that the polygon contains the circle
    slope = 2.0 / (1.0 + math.cos(half))
    angle = np.linspace(-math.pi / 2, math.pi / 2, sides // 2 + 1)
    # Cones and tents share the corners of their common edges to the bit: no sample falls between them.
    cosines, sines = rim * np.cos(angle), rim * np.sin(angle)
    cosines[[0, -1]] = 0.0
    rows = []
    for end in (-1.0, 1.0):
        edge = list(zip((end * cosines).tolist(), sines.tolist(), strict=True))
        for p, q, t in zip(edge[:-1], edge[1:], (angle[:-1] + half).tolist(), strict=True):
            plane = (slope * end * math.cos(t), slope * math.sin(t))
            rows += [(end, *corner, *plane) for corner in ((0.0, 0.0), p, q)]
    for side in (-1.0, 1.0):
        foot = [(end, 0.0, 0.0) for end in (-1.0, 1.0)]
        top = [(end, 0.0, side * rim) for end in (-1.0, 1.0)]
        rows += [(*corner, 0.0, side) for corner in (*foot, top[0], foot[1], top[1], top[0])]
    return np.array(rows, np.float32)


def render_hoff(
    device: Device, candidates: BlockLists, frame: Frame, *, sides: int = SIDES
) -> tuple[Labels, Labels, Floats32, Floats32, float]:
    """The owner of every sample, the nearest different copy, both distances, and the farthest distance drawn.

    Arrays (height, width); distances are wrong by at most `mesh_error`. The candidates must have been found with a
    looseness of cone_error(sides). Raises GlError.
    """
    with gl_errors(), device.current():
        used, reach = reaches(candidates)
        farthest = 1.01 / math.cos(math.pi / sides) * float(reach.max())
        draw = _Meshes(device, candidates, frame, used, reach, farthest, sides)
        try:
            first, d1 = draw.layer(second=False)
            second, d2 = draw.layer(second=True)
        finally:
            draw.release()
    return first, second, d1, d2, farthest


class _Meshes:
    """All elements' meshes on the device, and the target that they are drawn to."""

    def __init__(
        self,
        device: Device,
        candidates: BlockLists,
        frame: Frame,
        used: NDArray[np.intp],
        reach: Floats,
        farthest: float,
        sides: int,
    ) -> None:
        device.check()
        self.device, self.frame = device, frame
        context, scene, pixel = device.context, candidates.scene, frame.pixel
        det = frame.u.real * frame.v.imag - frame.u.imag * frame.v.real
        middle = scene.middle[used] - complex(frame.offsets(-0.5, -0.5))
        grid = np.stack(
            (
                (middle.real * frame.v.imag - middle.imag * frame.v.real) / det,
                (frame.u.real * middle.imag - frame.u.imag * middle.real) / det,
                scene.half[used].real / pixel,
                scene.half[used].imag / pixel,
                reach / pixel,
            ),
            axis=1,
        )
        instances = np.zeros(len(used), [("element", "f4", 4), ("reach", "f4"), ("label", "i4")])
        instances["element"], instances["reach"], instances["label"] = grid[:, :4], grid[:, 4], scene.label[used]
        self.program = device.mesh_program
        # Column by column, as OpenGL reads matrices.
        matrix = np.array([frame.v.imag, -frame.u.imag, -frame.v.real, frame.u.real]) * (pixel / det)
        self.program["to_grid"] = tuple(matrix.tolist())
        self.program["u"] = frame.u.real / pixel, frame.u.imag / pixel
        self.program["v"] = frame.v.real / pixel, frame.v.imag / pixel
        self.program["size"] = frame.width, frame.height
        self.program["farthest"] = farthest / pixel
        self.program["owner"] = 0
        corners, rows = context.buffer(template(sides).tobytes()), context.buffer(instances.tobytes())
        self.count = len(used)
        self.array = context.vertex_array(
            self.program, [(corners, "3f 2f", "corner", "slope"), (rows, "4f 1f 1i /i", "element", "reach", "label")]
        )
        shape = (frame.width, frame.height)
        self.layers = [context.texture(shape, 2, dtype="i4") for _ in range(2)]
        self.depth = context.depth_renderbuffer(shape)
        self.targets = [context.framebuffer([layer], self.depth) for layer in self.layers]
        self._held = [corners, rows, self.array, *self.targets, *self.layers, self.depth]
        device.check()

    def layer(self, *, second: bool) -> tuple[Labels, Floats32]:
        """Draw one layer: labels and distances."""
        context, frame = self.device.context, self.frame
        target = self.targets[second]
        target.use()
        target.viewport = (0, 0, frame.width, frame.height)
        target.clear(depth=1.0)
        self.program["second_layer"] = second
        self.layers[0].use(0)
        context.enable_only(context.DEPTH_TEST)
        try:
            self.array.render(mode=context.TRIANGLES, instances=self.count)
        finally:
            context.enable_only(context.NOTHING)
        data = self.layers[second].read()
        self.device.check()
        image = np.frombuffer(data, np.int32).reshape(frame.height, frame.width, 2)
        distance = np.ascontiguousarray(image[..., 1]).view(np.float32) * np.float32(frame.pixel)
        return np.ascontiguousarray(image[..., 0]), distance

    def release(self) -> None:
        """Give everything back."""
        self.device.idle.use()
        for item in self._held:
            item.release()
