"""Random jobs on all groups and examples, made, written and preflighted.

In tests/: `python -m helpers.fuzz_sheets 100 --seed 5`.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

from voronoi_tiles import GROUPS, Design, Job, JobError, Tiling
from voronoi_tiles.designs.starters import starter_text
from voronoi_tiles.preflight import preflight

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))


def random_job(dice: random.Random) -> dict[str, Any]:
    """The options of a job, none of which contradict each other."""
    job: dict[str, Any] = {
        "sheet": (dice.choice([150.0, 200.0, 233.3]), dice.choice([110.0, 160.0])),
        "fit": dice.choice(["whole", "clip", "frame"]),
        "margin": dice.choice([0.0, 5.0]),
        "rotate": dice.choice([0.0, 0.0, 90.0, 17.0]),
    }
    kind = dice.choice(["once", "kerf", "gap", "tabs"])
    if kind in {"kerf", "gap"}:
        job["fit"] = dice.choice(["whole", "clip"])
    if kind == "kerf":
        job |= {"kerf": dice.choice([0.1, 0.3]), "fillet": dice.choice([0.0, 0.3])}
    if kind == "gap":
        job["gap"] = dice.choice([0.5, 2.0])
    if kind == "tabs":
        job["tabs"] = 0.4
    return job


def fault_of(tiling: Tiling, options: dict[str, Any], form: str, file: Path) -> str | None:
    """What is wrong with what a job makes; "" where the job is refused, None where nothing is wrong."""
    try:
        product = tiling.make(Job(**options), form)
    except JobError:
        return ""
    with file.open("wb") as stream:
        product.write(stream)
    errors = [finding for finding in preflight(file).findings if finding.severity == "error"]
    return f"{errors[0].kind} at {errors[0].place}, {len(errors)} in all" if errors else None


def main() -> int:
    """Run so many jobs; the exit code is 1 where one fails."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("jobs", type=int)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    warnings.simplefilter("error")
    dice = random.Random(options.seed)  # noqa: S311 - random input, not secrets
    tilings: dict[str, Tiling] = {}
    refused = failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(options.jobs):
            name = dice.choice([*GROUPS, *map(str, EXAMPLES)])
            job, form = random_job(dice), dice.choice(["svg", "dxf"])
            if name not in tilings:
                design = Design.load(name) if name.endswith(".toml") else Design.loads(starter_text(name))
                tilings[name] = design.tessellate()
            try:
                fault = fault_of(tilings[name], job, form, Path(folder, f"sheet.{form}"))
            except Exception as error:  # noqa: BLE001 - whatever it is, it is what is looked for
                fault = f"{type(error).__name__}: {error}"
            if fault:
                print(f"{Path(name).stem} {job} {form}: {fault}", flush=True)  # noqa: T201 - the result
                failed += 1
            refused += fault == ""
    print(f"{options.jobs} jobs: {refused} refused, {failed} failed")  # noqa: T201 - the result
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
