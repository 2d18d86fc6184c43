"""The same bytes on other processors: files that numpy makes with fewer of this one's instructions."""

from __future__ import annotations

import os
import subprocess
import sys
from inspect import getsource
from typing import Any

import numpy as np
import pytest
from helpers.examples import path_of


def digests(names: list[str]) -> list[str]:
    """What tells the files of designs from others: their contours as exact curves, arcs and cubic ones."""
    import hashlib
    import io

    from voronoi_tiles import Design, Job

    found = []
    for name in names:
        made = Design.load(name).tessellate()
        for curves in ("exact", "arc", "cubic"):
            for kerf in (0.0, 0.15):
                buffer = io.BytesIO()
                made.make(Job(curves=curves, kerf=kerf)).write(buffer)
                found.append(f"{name} {curves} {kerf} {hashlib.sha256(buffer.getvalue()).hexdigest()}")
    return found


SCRIPT = f"import sys\n\n{getsource(digests)}\nprint(*digests(sys.argv[1:]), sep='\\n')"


def levels() -> dict[str, dict[str, str]]:
    """Variables of the environment by which numpy, BLAS and the C library leave instructions aside."""
    config: Any = np.show_config(mode="dicts")
    found = config["SIMD Extensions"].get("found", [])
    some, none = " ".join(found[1:]), " ".join(found)
    return {
        "a few": {"NPY_DISABLE_CPU_FEATURES": some, "OPENBLAS_CORETYPE": "Haswell"},
        "none": {
            "NPY_DISABLE_CPU_FEATURES": none,
            "OPENBLAS_CORETYPE": "Prescott",
            "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F",
        },
        "kernels of numpy": {"VORONOI_TILES_KERNELS": "numpy"},
    }


def assert_alike(names: list[str], others: list[str]) -> None:
    """Every file of designs has the same bytes here and in processes with some instructions only."""
    paths = [str(path_of(name)) for name in names]
    here = digests(paths)
    assert len(set(here)) == 6 * len(names)
    for level in others:
        command = [sys.executable, "-c", SCRIPT, *paths]
        there = subprocess.run(command, check=True, capture_output=True, text=True, env=os.environ | levels()[level])
        assert there.stdout.splitlines() == here, level


needs_others = pytest.mark.skipif(
    "found" not in np.show_config(mode="dicts").get("SIMD Extensions", {}),
    reason="numpy uses no instructions here that it could leave aside",
)


@needs_others
def test_files_are_the_same_without_this_processors_instructions() -> None:
    """Exact curves, arcs and cubic curves, with a kerf and without."""
    assert_alike(["p31m-gem"], ["none"])


@needs_others
@pytest.mark.slow
@pytest.mark.parametrize(
    ("names", "level"),
    [
        (["cm-moth", "cmm-scroll", "p3-mitten", "pgg-crane"], "none"),
        (["p3-mitten"], "a few"),
        (["cmm-scroll"], "kernels of numpy"),
    ],
)
def test_long_curves_are_the_same_without_this_processors_instructions(names: list[str], level: str) -> None:
    """Designs of flattened curves, whose runs have up to hundreds of pieces."""
    assert_alike(names, [level])
