"""How fast the raster stage and the cross-check are. Run it with `make bench`, or on a machine with a GPU.

The picture is one cell, 2048 x 2048 and 4096 x 4096 samples, of a curve in p4 (that of engine.py) cut into so many
segments. Each row is the fastest of some runs, so that a busy machine matters less; every image is compared with the
CPU's: the number of samples with another owner is printed, of which none may be unexplained.

    python bench/raster.py                    everything
    python bench/raster.py --write            the same, into bench/README.md
    python bench/raster.py --only frame       the frame alone, its lists on the device: draw and finish
    python bench/raster.py --only frame --sizes 512x24 1024x1000
"""

from __future__ import annotations

import argparse
import resource
import sys
import time
from collections.abc import Callable, Sequence

import numpy as np
from engine import case_of
from report import machine, published

from voronoi_tiles import Design
from voronoi_tiles.raster.block_lists import find_candidates
from voronoi_tiles.raster.frame import Frame, cell_frame
from voronoi_tiles.raster.gl import Device, GlError, Prepared
from voronoi_tiles.raster.renderer import LabelImage, Method, Renderer
from voronoi_tiles.raster.scene import Pattern, gather

SIZES = ((2048, 24), (2048, 1000), (4096, 1000), (4096, 10_000))
HOFF = ((512, 24), (512, 1000), (1024, 1000))
RUNS = 3


def pattern_of(segments: int) -> Pattern:
    """The curve of so many segments, in p4."""
    case = case_of("p4", segments)
    return Pattern((case.site,), case.group, case.lattice)


def frame_of(pattern: Pattern, samples: int) -> Frame:
    """One cell."""
    return cell_frame(pattern.lattice, samples, centre=complex(pattern.sites[0].nodes.mean()))


def fastest(action: Callable[[], object], runs: int = RUNS) -> float:
    """The seconds of the fastest of some runs."""
    seconds = []
    for _ in range(runs):
        begin = time.perf_counter()
        action()
        seconds.append(time.perf_counter() - begin)
    return min(seconds)


def wrong(image: LabelImage, exact: LabelImage) -> str:
    """Count the samples with another owner than the CPU's, and those that the error does not explain."""
    other = image.first != exact.first
    unexplained = other & (exact.d2 - exact.d1 > 2 * image.error(exact.d2))
    assert not unexplained.any()
    return f"{int(other.sum()):,}"


def row(*cells: object) -> None:
    """Print a row of a table."""
    print(
        "| " + " | ".join(f"{cell:.3f}" if isinstance(cell, float) else str(cell) for cell in cells) + " |", flush=True
    )


def images(device: Device | None, sizes: tuple[tuple[int, int], ...], method: Method) -> None:
    """Whole images: lists, upload, rendering, reading back, spot check."""
    print(f"\nWhole images, {method} (seconds: lists, upload, both layers, reading back, spot check):\n")
    row("size", "segments", "CPU", "OpenGL, fragment", "OpenGL, compute", "other owners")
    row("---:", "---:", "---:", "---:", "---:", "---:")
    for samples, segments in sizes:
        pattern = pattern_of(segments)
        frame = frame_of(pattern, samples)
        exact = Renderer("cpu").render(pattern, frame)
        cells: list[object] = [fastest(lambda: Renderer("cpu", method=method).render(pattern, frame))]  # noqa: B023
        count = ""
        for compute in (False, True):
            if device is None or (compute and (method == "hoff" or not device.has_compute)):
                cells.append("-")
                continue
            renderer = Renderer("gl", method=method, compute=compute)
            count = wrong(renderer.render(pattern, frame), exact)
            cells.append(fastest(lambda: renderer.render(pattern, frame)))  # noqa: B023
        row(samples, segments, *cells, count)


def fits_compute(device: Device, samples: int) -> bool:
    """Whether a device has compute shaders, and buffers for a frame as large as this."""
    return device.has_compute and 16 * samples**2 <= int(device.info["GL_MAX_SHADER_STORAGE_BLOCK_SIZE"])


def frames(device: Device, sizes: Sequence[tuple[int, int]]) -> None:
    """The frame alone, once its lists lie on the device."""
    print("\nThe frame alone (milliseconds: draw and finish, lists on the device; then what is done once):\n")
    row("size", "segments", "elements per block", "fragment", "compute", "lists on the host", "upload", "reading back")
    row(*["---:"] * 8)
    for samples, segments in sizes:
        pattern = pattern_of(segments)
        frame = frame_of(pattern, samples)
        begin = time.perf_counter()
        scene = gather(pattern, frame.origin, frame.middle, frame.radius)
        lists = find_candidates(scene, frame)
        listed = time.perf_counter() - begin
        cells: list[float | str] = []
        for compute in (False, True):
            if compute and not fits_compute(device, samples):
                cells.append("-")  # the renderer takes such a frame in windows
                continue
            begin = time.perf_counter()
            with Prepared(device, lists, frame, compute=compute) as prepared:
                device.context.finish()
                upload = time.perf_counter() - begin

                def draw() -> None:
                    prepared.draw()
                    prepared.finish()

                draw()
                cells.append(1000 * fastest(draw, 10))
                reading = fastest(prepared.read)
        row(
            samples,
            segments,
            round(len(lists.element) / len(lists), 1),
            *cells,
            1000 * listed,
            1000 * upload,
            1000 * reading,
        )


def checks(device: Device | None) -> None:
    """The whole cross-check, and the tessellation before it."""
    print("\nThe whole cross-check (seconds), and the tessellation with its proof:\n")
    row("size", "segments", "tessellate", "check, CPU", "check, OpenGL")
    row(*["---:"] * 5)
    for samples, segments in ((1024, 24), (2048, 24), (2048, 1000)):
        t = np.linspace(0.0, 1.0, segments + 1)
        points = [6 + 9j, 30 + 2j, 30 + 20j, 13 + 25j]
        curve = (1 - t) ** 3 * points[0] + 3 * t * (1 - t) ** 2 * points[1] + 3 * t**2 * (1 - t) * points[2]
        curve += t**3 * points[3]
        strokes = [{"polyline": [[z.real, z.imag] for z in curve.tolist()]}]
        document = {"schema": 1, "group": "p4", "cell": {"a": 60.0}, "site": [{"strokes": strokes}]}
        design = Design.from_dict(document)
        tiling = design.tessellate()
        cells: list[object] = [fastest(design.tessellate)]
        for choice in ("cpu", "gl"):
            if choice == "gl" and device is None:
                cells.append("-")
                continue
            report = tiling.check(samples=samples, renderer=choice)
            assert report.passed
            cells.append(fastest(lambda: tiling.check(samples=samples, renderer=choice)))  # noqa: B023
        row(samples, segments, *cells)


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=("frame", "image", "hoff", "check"), help="one table alone")
    parser.add_argument("--device", type=int, help="the number of OpenGL's device")
    parser.add_argument("--write", action="store_true", help="put the tables into bench/README.md")
    parser.add_argument("--sizes", nargs="+", type=read_size, default=SIZES, help="samples and segments of the frames")
    options = parser.parse_args()
    if options.write and (options.only or options.sizes != SIZES):
        parser.error("--write needs all tables: leave --only and --sizes out")
    with published("raster", write=options.write):
        tables(options.only, options.device, options.sizes)


def read_size(text: str) -> tuple[int, int]:
    """Read "2048x1000": samples along the side, and segments."""
    samples, _, segments = text.partition("x")
    return int(samples), int(segments)


def tables(only: str | None, number: int | None, sizes: Sequence[tuple[int, int]]) -> None:
    """Print one table, or all, measured on the device of a number; the frames of these sizes."""
    try:
        device = Device(number)
    except GlError as error:
        print(f"no OpenGL: {error}")
        device = None
    print(f"{machine()}; OpenGL: {device.name if device else 'none'}")
    if only in {None, "frame"} and device is not None:
        frames(device, sizes)
    if only in {None, "image"}:
        images(device, SIZES[:3], "exact")
    if only in {None, "hoff"}:
        images(device, HOFF, "hoff")
    if only in {None, "check"}:
        checks(device)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(f"\npeak memory {peak / (1e6 if sys.platform == 'darwin' else 1e3):.0f} MB")


if __name__ == "__main__":
    main()
