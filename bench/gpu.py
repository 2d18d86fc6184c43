"""Part of gpu.sh: whether there is a GPU, which it ends with 3 without, and the cross-check of all examples on it."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from report import machine, table

from voronoi_tiles import Design
from voronoi_tiles.raster.gl import Device, GlError

EXAMPLES = Path(__file__).parents[1] / "examples"
NO_GPU = 3

SAMPLES = 2048


def find_device(*, allow_software: bool) -> Device:
    """The device; exits where there is none, or none but the processor, which must be allowed."""
    try:
        found = Device()
    except GlError as error:
        print(f"no OpenGL: {error}", file=sys.stderr)
        sys.exit(NO_GPU)
    if found.is_software and not allow_software:
        print(f"no GPU: {found.name} is the processor; --allow-software takes it all the same", file=sys.stderr)
        sys.exit(NO_GPU)
    return found


def check_examples(samples: int) -> list[str]:
    """Cross-check all examples by OpenGL, and print the slowest and the sum: the names of those that fail."""
    failed, taken = [], []
    for path in sorted([*EXAMPLES.glob("*.toml"), *EXAMPLES.glob("paper/*.toml")]):
        tiling = Design.load(path).tessellate()
        begun = time.perf_counter()
        report = tiling.check(samples=samples, renderer="gl")
        taken.append((time.perf_counter() - begun, path.stem))
        if not report.passed:
            failed.append(path.stem)
    seconds, slowest = max(taken)
    table(f"Cross-checks by OpenGL at {samples} samples:", "designs", "failed", "seconds", "slowest", "which")
    print(
        f"| {len(taken)} | {len(failed)} | {sum(row[0] for row in taken):.1f} | {seconds:.2f} | {slowest} |", flush=True
    )
    return failed


def main() -> None:
    """Print the tables; exit with 1 where a cross-check fails."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=("device",), help="say which device there is, no more")
    parser.add_argument("--allow-software", action="store_true", help="take the processor for a GPU")
    parser.add_argument("--samples", type=int, default=SAMPLES, help="samples along the side of a cell")
    options = parser.parse_args()
    device = find_device(allow_software=options.allow_software)
    if options.only:
        print(f"{machine()}; OpenGL: {device.name}", flush=True)
        return
    failed = check_examples(options.samples)
    if failed:
        sys.exit(f"the cross-check fails: {', '.join(failed)}")


if __name__ == "__main__":
    main()
