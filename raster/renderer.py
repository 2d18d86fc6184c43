"""Rendering: by which renderer, on which device, with which method; falling back, spot-checked, window by window."""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import product
from random import Random
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Ints
from voronoi_tiles.base.errors import ArgumentError, RenderError, TouchingCopiesError
from voronoi_tiles.base.values import shown
from voronoi_tiles.raster import cpu, hoff
from voronoi_tiles.raster.block_lists import BlockLists, find_candidates
from voronoi_tiles.raster.frame import BLOCK, WINDOW, Frame
from voronoi_tiles.raster.gl import Device, GlError, float32_error, forget, gl_errors
from voronoi_tiles.raster.gl import device as find_device
from voronoi_tiles.raster.scene import Labels, Pattern, Scene, gather, merge_copies

Method = Literal["exact", "hoff"]
Choice = Literal["auto", "gl", "cpu"]
Floating = NDArray[np.floating[Any]]

_SPOT_WORK = 10_000_000
"""Distances that a spot check computes; a count."""


@dataclass(frozen=True)
class Provenance:
    """Who made an image: renderer ("gl" or "cpu"), device, precision, method, and why it was not OpenGL ("" if it was).

    `spots` is how many samples of OpenGL's image were compared with float64; `touching` says which copies touch in a
    picture that was drawn although they do.
    """

    renderer: str
    device: str
    precision: str
    method: str
    fallback: str = ""
    spots: int = 0
    touching: TouchingCopiesError | None = None

    def __str__(self) -> str:
        return f"{self.method} on {self.renderer} ({self.device}), {self.precision}"


class Window(NamedTuple):
    """A part of an image that was rendered at once, and its candidate lists."""

    frame: Frame
    candidates: BlockLists


@dataclass(frozen=True, eq=False)
class LabelImage:
    """Who owns each sample of a frame.

    `first` and `second` (int32, height x width) are labels: rows of `copies` (intp, n x 3), which are (placement, i, j)
    as in Pattern; `d1` and `d2` their distances in units. `error` bounds what is wrong with a distance d. `windows` are
    the parts that it was rendered in.
    """

    pattern: Pattern
    frame: Frame
    first: Labels
    second: Labels
    d1: Floating
    d2: Floating
    copies: Ints
    provenance: Provenance
    error: Callable[[Any], Any]
    windows: tuple[Window, ...]


class Renderer:
    """Renders frames of a pattern; what OpenGL has failed at once is rendered by the processor from then on.

    `choice` "auto" takes OpenGL where there is any, "gl" insists, "cpu" does without; `device` is OpenGL's device
    number. `notice` is called with one line when OpenGL is given up.
    """

    def __init__(
        self,
        choice: Choice = "auto",
        *,
        device: int | None = None,
        method: Method = "exact",
        compute: bool | None = None,
        sides: int = hoff.SIDES,
        notice: Callable[[str], None] | None = None,
    ) -> None:
        """Find the device. Raises RenderError where `choice` is "gl" and there is none, ArgumentError for bad words."""
        for name, value, known in (("renderer", choice, get_args(Choice)), ("method", method, get_args(Method))):
            if value not in known:
                raise ArgumentError(f"`{name}` {value!r} is unknown", remedy=f"Use one of {', '.join(known)}.")
        if sides < 4 or sides % 4:
            raise ValueError(f"cones have 4, 8, 12, ... sides, not {sides}")
        if device is not None and not (hasattr(device, "__index__") and operator.index(device) >= 0):
            raise ArgumentError(f"`device` {shown(device)} is no number of a device", remedy="Count them from 0.")
        self._choice, self._method, self._compute, self._sides = choice, method, compute, sides
        self._notice = notice or (lambda _: None)
        self._fallback = ""
        self._device: Device | None = None
        if choice != "cpu":
            try:
                self._device = find_device(device)
            except GlError as error:
                self._give_up(error)

    def render(self, pattern: Pattern, frame: Frame) -> LabelImage:
        """Render a frame, however large, window by window.

        Raises RenderError where OpenGL fails and `choice` is "gl", DesignError where too many copies lie about it.
        """
        limit = WINDOW if self._device is None else min(WINDOW, self._device.largest_image // BLOCK * BLOCK)
        height, width = frame.height, frame.width
        whole: list[NDArray[Any]] = []
        windows: list[Window] = []
        farthest, spots = 0.0, 0
        for y, x in product(range(0, height, limit), range(0, width, limit)):
            window = self._window(pattern, frame, x, y, limit)
            before = self._device
            images, far, checked = self._images(pattern, window)
            if self._device is not before and whole:
                return self.render(pattern, frame)  # one image, one renderer
            if not whole:
                whole = [np.empty((height, width), part.dtype) for part in images]
            for image, part in zip(whole, images, strict=True):
                image[y : y + limit, x : x + limit] = part
            windows.append(window)
            farthest, spots = max(farthest, far), spots + checked
        copies, names = merge_copies([window.candidates.scene.copies for window in windows])
        if len(windows) > 1:
            for window, new in zip(windows, names, strict=True):
                y, x = window.frame.row - frame.row, window.frame.column - frame.column
                for image in whole[:2]:
                    labels = image[y : y + limit, x : x + limit]
                    labels[...] = new[labels]
        first, second, d1, d2 = whole
        error = self._error(pattern, frame, farthest)
        by = self.provenance(spots)
        return LabelImage(pattern, frame, first, second, d1, d2, copies, by, error, tuple(windows))

    def provenance(self, spots: int = 0) -> Provenance:
        """Who renders, as things stand."""
        method = self._method if self._method == "exact" else f"hoff, cones of {self._sides} sides"
        if self._device is None:
            return Provenance("cpu", "numpy", "float64", method, self._fallback)
        return Provenance("gl", self._device.name, "float32", method, spots=spots)

    def _window(self, pattern: Pattern, frame: Frame, x: int, y: int, limit: int) -> Window:
        """A part of a frame, with its lists."""
        part = frame.window(x, y, min(limit, frame.width - x), min(limit, frame.height - y))
        scene = gather(pattern, part.origin, part.middle, part.radius)
        looseness = hoff.cone_error(self._sides) if self._method == "hoff" else 0.0
        return Window(part, find_candidates(scene, part, looseness=looseness))

    def _images(self, pattern: Pattern, window: Window) -> tuple[list[NDArray[Any]], float, int]:
        """Render one window: the four images, the farthest distance that was drawn, the samples that were checked."""
        if self._device is not None:
            try:
                return self._by_device(self._device, pattern, window)
            except GlError as error:
                self._give_up(error)
        mesh = partial(hoff.heights, sides=self._sides) if self._method == "hoff" else None
        return [*cpu.render(window.candidates, window.frame, heights=mesh)], 0.0, 0

    def _by_device(self, device: Device, pattern: Pattern, window: Window) -> tuple[list[NDArray[Any]], float, int]:
        """Render one window with OpenGL, and compare some samples with float64."""
        candidates, frame = window.candidates, window.frame
        farthest = 0.0
        if self._method == "exact":
            first, second, d1, d2 = device.render_exact(candidates, frame, compute=self._compute)
        else:
            first, second, d1, d2, farthest = hoff.render_hoff(device, candidates, frame, sides=self._sides)
        with gl_errors():
            error = self._error(pattern, frame, farthest)
            spots = spot_check(candidates.scene, frame, (first, second, d1, d2), error)
        return [first, second, d1, d2], farthest, spots

    def _error(self, pattern: Pattern, frame: Frame, farthest: float) -> Callable[[Any], Any]:
        """The bound for a distance's error."""
        rounding = pattern.rounding(frame)
        if self._method == "hoff" and self._device is None:
            relative = hoff.cone_error(self._sides)
            return lambda distance: relative * distance + rounding
        if self._method == "hoff":
            return lambda d: hoff.mesh_error(d, frame, farthest=farthest, sides=self._sides) + rounding
        if self._device is None:
            return lambda _: rounding
        return lambda distance: float32_error(distance, frame) + rounding

    def _give_up(self, error: GlError) -> None:
        """Do without OpenGL from now on, and say why."""
        what = "not available" if self._device is None else "failed"
        if self._device is not None:
            forget(self._device)
        self._device = None
        if self._choice == "gl":
            raise RenderError(
                f"OpenGL failed: {error}", remedy="Use `renderer='cpu'`, or `renderer='auto'`."
            ) from error
        self._fallback = str(error)
        self._notice(f"OpenGL {what} ({error}). Using the CPU renderer.{_remedy(str(error))}")


def _remedy(reason: str) -> str:
    """Say what to install, where something is missing."""
    if "moderngl" in reason:
        return " Install it with: pip install moderngl"
    if any(word in reason for word in ("not loaded", "eglInitialize", "libGL", "libEGL")):
        return " On Debian/Ubuntu: apt-get install libegl1 libgl1"
    return ""


def spot_check(
    scene: Scene, frame: Frame, images: tuple[Labels, Labels, Floating, Floating], error: Callable[[Any], Any]
) -> int:
    """Compare random samples of an image with float64 over all elements; give how many.

    Raises GlError where a distance is off by more than its bound, or a label names a copy that is farther by more than
    the bounds explain.
    """
    count = int(np.clip(_SPOT_WORK // len(scene), 16, 256))
    chance = Random(frame.width * 1_000_003 + frame.height)  # noqa: S311 - samples, not secrets
    i, j = (np.array(chance.choices(range(side), k=count)) for side in (frame.width, frame.height))
    first, second, d1, d2 = (image[j, i] for image in images)
    if min(first.min(), second.min()) < 0 or max(first.max(), second.max()) >= len(scene.copies):
        raise GlError("the spot check found labels of no copy")
    points = frame.offsets(i.astype(float), j.astype(float))
    for k, point in enumerate(points.tolist()):
        nearest = scene.copy_distances(point)
        true1, true2 = np.partition(nearest, 1)[:2].tolist()
        allowed = float(error(true2))
        where = f"sample ({i[k]}, {j[k]})"
        if not (abs(d1[k] - true1) <= allowed and abs(d2[k] - true2) <= allowed):
            raise GlError(f"the spot check found {where} off by more than {allowed:.3g} from float64")
        behind = nearest[first[k]] - true1, nearest[second[k]] - true2
        if not max(behind) <= 2 * allowed or first[k] == second[k]:
            raise GlError(f"the spot check found {where} with the wrong owner")
    return count
