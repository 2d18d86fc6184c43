"""OpenGL through moderngl, headless: contexts, shaders, and the exact renderer in float32.

Everything that can go wrong here raises GlError: no library, no device, a lost context, memory refused, an error flag.
A context belongs to the thread that made it; a process that forks after making one must not use it.
"""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from importlib.resources import files
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Floats
from voronoi_tiles.raster.block_lists import BlockLists
from voronoi_tiles.raster.frame import BLOCK, Frame
from voronoi_tiles.raster.scene import Labels

_TEXTURE_WIDTH = 4096
_ROUNDS = 65_535
"""Most rounds of loops in one run of a shader, all loops together; a count. Mesa's software renderer ends them there
in silence, and counts one more for each loop that it begins."""

_SOFTWARE = ("llvmpipe", "softpipe", "swrast", "swiftshader", "software")

Floats32 = NDArray[np.float32]


class GlError(Exception):
    """What OpenGL, or getting at it, has failed with; `str()` is one line."""


@contextmanager
def gl_errors() -> Iterator[None]:
    """Turn whatever moderngl, a driver or a library raises into a GlError of one line."""
    try:
        yield
    except GlError:
        raise
    except Exception as error:  # moderngl raises plain Exception, drivers anything
        text = " ".join(str(error).split()) or type(error).__name__
        raise GlError(text if len(text) <= 200 else text[:197] + "...") from error


_contexts = threading.local()
_makers: set[int] = set()
"""The processes that have made contexts: their number, and, after a fork, that of the parent."""


def device(index: int | None = None) -> Device:
    """The device with a given index (None: the first that answers), made once in every thread. Raises GlError."""
    known: dict[tuple[int, int | None], Device] = _contexts.__dict__.setdefault("known", {})
    key = os.getpid(), index
    if key not in known:
        known[key] = Device(index)
    return known[key]


def forget(lost: Device) -> None:
    """Make a new context the next time: this one has failed."""
    known: dict[tuple[int, int | None], Device] = _contexts.__dict__.get("known", {})
    for key in [key for key, value in known.items() if value is lost]:
        del known[key]


class Device:
    """An OpenGL context without a window, on the device with a given index (None: the first that answers)."""

    def __init__(self, index: int | None = None) -> None:
        """Make the context. Raises GlError."""
        if _makers - {os.getpid()}:
            raise GlError("OpenGL was in use before this process was forked: start processes by spawn")
        with gl_errors():
            import moderngl

            settings: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
            if index is not None:
                settings["device_index"] = index
            self.context: Any = moderngl.create_context(standalone=True, require=330, **settings)
            self.info: dict[str, Any] = self.context.info
            # What is bound between images: moderngl binds the last framebuffer again, and would find it deleted.
            self.idle: Any = self.context.simple_framebuffer((1, 1))
            self.home = os.getpid(), threading.get_ident()
            _makers.add(os.getpid())
            self.check()

    @property
    def name(self) -> str:
        """What the driver calls the device, and the version of OpenGL."""
        version = self.context.version_code
        return f"{self.info['GL_RENDERER']}, OpenGL {version // 100}.{version // 10 % 10}"

    @property
    def is_software(self) -> bool:
        """Whether the device is a program that runs on the processor."""
        name = str(self.info["GL_RENDERER"]).lower()
        return any(word in name for word in _SOFTWARE)

    @property
    def has_compute(self) -> bool:
        """Whether there are compute shaders with storage buffers (OpenGL 4.3)."""
        return bool(self.context.version_code >= 430)

    @property
    def largest_image(self) -> int:
        """The largest side of an image; samples."""
        return min(int(self.info["GL_MAX_TEXTURE_SIZE"]), *map(int, self.info["GL_MAX_VIEWPORT_DIMS"]))

    @contextmanager
    def current(self) -> Iterator[None]:
        """Make this the context that OpenGL's calls are for: a thread may have several. Raises GlError."""
        if self.home != (os.getpid(), threading.get_ident()):
            raise GlError("the context belongs to another thread or process")
        with self.context:
            self.check()
            yield

    def check(self) -> None:
        """Raise GlError where OpenGL has raised a flag, which it does silently, or where this is no place to use it."""
        if self.home != (os.getpid(), threading.get_ident()):
            raise GlError("the context belongs to another thread or process")
        error = self.context.error
        if error != "GL_NO_ERROR":
            raise GlError(error)

    @cached_property
    def fragment_program(self) -> Any:
        """The exact renderer as a fragment shader."""
        defines = {"TEXTURE_WIDTH": _TEXTURE_WIDTH}
        return self.context.program(
            vertex_shader=source("whole_screen.glsl", 330), fragment_shader=source("exact_fragment.glsl", 330, defines)
        )

    @cached_property
    def compute_program(self) -> Any:
        """The exact renderer as a compute shader."""
        return self.context.compute_shader(source("exact_compute.glsl", 430, {"BLOCK": BLOCK}))

    @cached_property
    def mesh_program(self) -> Any:
        """The cones and tents of hoff.py."""
        return self.context.program(
            vertex_shader=source("hoff_vertex.glsl", 330), fragment_shader=source("hoff_fragment.glsl", 330)
        )

    def table(self, rows: NDArray[Any], components: int, dtype: str) -> Any:
        """A texture that holds the rows (n, components) of a list, _TEXTURE_WIDTH to a line."""
        lines = max(1, -(-len(rows) // _TEXTURE_WIDTH))
        if lines > int(self.info["GL_MAX_TEXTURE_SIZE"]):
            raise GlError(f"a list of {len(rows):,} is larger than the device's largest texture")
        padded = np.zeros((lines * _TEXTURE_WIDTH, components), rows.dtype)
        padded[: len(rows)] = rows
        return self.context.texture((_TEXTURE_WIDTH, lines), components, padded.tobytes(), dtype=dtype)

    def render_exact(
        self, candidates: BlockLists, frame: Frame, *, compute: bool | None = None
    ) -> tuple[Labels, Labels, Floats32, Floats32]:
        """The owner of every sample, the nearest different copy, and both distances: arrays (height, width).

        `compute` asks for the compute shader or refuses it; by default it is taken where it is faster: on devices that
        are no software. The distances are wrong by at most `float32_error`. Raises GlError.
        """
        if compute is None:
            compute = self.has_compute and not self.is_software
        with gl_errors(), self.current(), Prepared(self, candidates, frame, compute=compute) as prepared:
            prepared.draw()
            image = prepared.read()
        first, second = np.ascontiguousarray(image[..., 0]), np.ascontiguousarray(image[..., 1])
        distance = np.ascontiguousarray(image[..., 2:]).view(np.float32) * np.float32(frame.pixel)
        return first, second, distance[..., 0], distance[..., 1]


def float32_error(distance: Floats | float, frame: Frame) -> Any:
    """A bound for the error of a float32 distance, in units: 16 x 2^-24 (d + 2r), r the half diagonal of a block.

    All vectors in the shader are at most d + 2r long: elements are cut to what matters in the block, and measured from
    its centre. Ten roundings, each of at most 2^-24 of that, go into the result.
    """
    return 16 * 2.0**-24 * (distance + 2 * frame.half_diagonal(BLOCK))


class Prepared:
    """A frame whose lists lie on the device: `draw` renders it, `read` fetches it."""

    def __init__(self, device: Device, candidates: BlockLists, frame: Frame, *, compute: bool) -> None:
        """Upload the lists. Raises GlError."""
        device.check()
        in_elements, in_runs = np.diff(candidates.element_start[candidates.run_start]), np.diff(candidates.run_start)
        rounds = int((in_elements + 2 * in_runs).max())
        if rounds > _ROUNDS:
            raise GlError(f"the copies about one block take {rounds:,} rounds of loops, more than {_ROUNDS:,}")
        self.device, self.frame, self.compute = device, frame, compute
        self._held: list[Any] = []
        context = device.context
        starts, sizes = candidates.run_start[:-1], np.diff(candidates.run_start)
        blocks = np.stack((starts, sizes), axis=1).astype(np.int32)
        runs = np.zeros((len(candidates.run_label), 4), np.int32)
        runs[:, 0], runs[:, 1] = candidates.element_start[:-1], np.diff(candidates.element_start)
        runs[:, 2] = candidates.run_label
        elements = element_records(candidates, frame)
        if compute:
            self.program = device.compute_program
            limit = int(device.info["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"])
            if max(elements.nbytes, runs.nbytes, 16 * frame.width * frame.height) > limit:
                raise GlError(f"the lists are larger than the device's largest buffer of {limit:,} bytes")
            tables = [context.buffer(part.tobytes()) for part in (blocks, runs, elements)]
            self.result = context.buffer(reserve=16 * frame.width * frame.height)
            self._held += [*tables, self.result]
            for number, table in enumerate((*tables, self.result)):
                table.bind_to_storage_buffer(number)
            self.program["size"] = frame.width, frame.height
        else:
            self.program = device.fragment_program
            tables = [device.table(blocks, 2, "i4"), device.table(runs, 4, "i4"), device.table(elements, 4, "f4")]
            for number, (name, table) in enumerate(
                zip(("block_table", "run_table", "element_table"), tables, strict=True)
            ):
                table.use(number)
                self.program[name] = number
            self.result = context.texture((frame.width, frame.height), 4, dtype="i4")
            self.target = context.framebuffer([self.result])
            self.screen = context.vertex_array(self.program, [])
            self._held += [*tables, self.screen, self.target, self.result]
        self.program["u"] = frame.u.real / frame.pixel, frame.u.imag / frame.pixel
        self.program["v"] = frame.v.real / frame.pixel, frame.v.imag / frame.pixel
        self.program["block"] = BLOCK
        self.program["columns"] = candidates.columns
        device.check()

    def draw(self) -> None:
        """Render the frame; `finish` waits until that is done."""
        frame, context = self.frame, self.device.context
        if self.compute:
            self.program.run(-(-frame.width // BLOCK), -(-frame.height // BLOCK))
            context.memory_barrier()
        else:
            self.target.use()
            self.target.viewport = (0, 0, frame.width, frame.height)
            self.screen.render(mode=context.TRIANGLES, vertices=3)

    def finish(self) -> None:
        """Wait for the device."""
        self.device.context.finish()
        self.device.check()

    def read(self) -> Labels:
        """Fetch the image: int32 (height, width, 4), two labels and the bits of two distances in pixels."""
        data = self.result.read()
        self.device.check()
        return np.frombuffer(data, np.int32).reshape(self.frame.height, self.frame.width, 4)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.device.idle.use()
        for item in self._held:
            item.release()


def element_records(candidates: BlockLists, frame: Frame) -> Floats32:
    """The elements of all lists as the shader wants them: middle x, y from the block's centre, half x, y, in pixels.

    The points of a block have their nearest points on an element within r of the centre's nearest point: the rest of a
    long element is cut off, since its far ends would cost the digits that float32 does not have.
    """
    scene = candidates.scene
    middle = scene.middle[candidates.element] - candidates.centre[candidates.element_block]
    unit, length = scene.unit[candidates.element], scene.length[candidates.element]
    foot = np.clip(-(middle.real * unit.real + middle.imag * unit.imag), -length, length)
    room = 1.001 * candidates.radius
    low, high = np.maximum(foot - room, -length), np.minimum(foot + room, length)
    records = np.empty((len(middle), 4), np.float32)
    for column, (along, from_middle) in enumerate((((low + high) / 2, 1.0), ((high - low) / 2, 0.0))):
        records[:, 2 * column] = (from_middle * middle.real + along * unit.real) / frame.pixel
        records[:, 2 * column + 1] = (from_middle * middle.imag + along * unit.imag) / frame.pixel
    return records


def source(name: str, version: int, defines: dict[str, int] | None = None) -> str:
    """The text of a shader, with its version, constants and included files."""
    folder = files(__package__)
    lines = [f"#version {version}", *(f"#define {key} {value}" for key, value in (defines or {}).items())]
    for line in (folder / name).read_text(encoding="utf-8").splitlines():
        included = line.removeprefix("#include ").strip('"')
        lines.append(line if included == line else (folder / included).read_text(encoding="utf-8"))
    return "\n".join(lines) + "\n"
