"""The extension's files hold a wheel of each package for each Python of their platform, or are not made."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "blender"))

import build  # noqa: E402 - a script, in no package

OURS = "voronoi_tiles-0.2.0-py3-none-manylinux_2_17_x86_64.whl"
SHAPELY = "shapely-2.1.2-{0}-{0}-manylinux2014_x86_64.manylinux_2_17_x86_64.whl"
PURE = [f"{library.replace('==', '-')}-py3-none-any.whl" for library in build.LIBRARIES[1:]]
WHOLE = [OURS, SHAPELY.format("cp311"), SHAPELY.format("cp313"), *PURE]
LINUX = build.PLATFORMS["linux-x64"]


def test_a_whole_set_passes() -> None:
    """One wheel each for two Pythons, one that serves both, one that serves all."""
    build.check("linux-x64", LINUX, WHOLE)


@pytest.mark.parametrize(
    ("wheels", "said"),
    [
        (WHOLE[1:], "0 wheels of voronoi_tiles"),
        (WHOLE[:2] + WHOLE[3:], r"Python 3\.13: 0 wheels of shapely"),
        (WHOLE[:-1], "0 wheels of coloraide"),
        ([*WHOLE, OURS.replace("manylinux_2_17_x86_64", "any")], "2 wheels of voronoi_tiles"),
        ([*WHOLE, SHAPELY.format("cp312")], "cp312-cp312.* is of another Python or platform"),
        ([*WHOLE, "numpy-2.3.0-cp311-cp311-manylinux_2_17_x86_64.whl"], "numpy.* is of another"),
        ([WHOLE[0].replace("x86_64", "aarch64"), *WHOLE[1:]], "0 wheels of voronoi_tiles"),
        ([*WHOLE, "shapely-2.1.2-cp311-cp311-win_amd64.whl"], "win_amd64.whl is of another"),
    ],
)
def test_a_hole_is_found(wheels: list[str], said: str) -> None:
    """What is missing, doubled, of another Python or platform, and numpy, which would break other extensions."""
    with pytest.raises(build.HoleError, match=said):
        build.check("linux-x64", LINUX, wheels)


@pytest.mark.parametrize("name", build.PLATFORMS)
def test_the_manifest_says_what_blender_reads(name: str) -> None:
    """Its keys are those of the extension platform, and its wheels those that were found."""
    platform = build.PLATFORMS[name]
    found = tomllib.loads(build.manifest(name, platform, ["b.whl", "a.whl"]))
    assert found["wheels"] == ["./wheels/a.whl", "./wheels/b.whl"]
    assert found["platforms"] == [name]
    assert found["blender_version_min"] == platform.blender
    assert found["license"] == ["SPDX:GPL-3.0-or-later"]
    assert max(len(found["tagline"]), len(found["permissions"]["files"])) <= 64
    assert not found["tagline"].endswith(".")


def test_every_platform_of_the_wheels_has_its_extension() -> None:
    """But for Linux on ARM, for which there is no Blender to be had."""
    sys.path.insert(0, str(ROOT))
    import setup

    tags = {target.tag for name, target in setup.TARGETS.items() if name != "linux-aarch64"}
    assert tags == {tag for platform in build.PLATFORMS.values() for tag in platform.tags if tag in tags}


def test_modules_of_the_extension_say_their_licence() -> None:
    """What imports Blender is under its licence, the engine under ours."""
    for source in (ROOT / "blender" / "extension").glob("*.py"):
        assert source.read_text(encoding="utf-8").startswith("# SPDX-License-Identifier: GPL-3.0-or-later\n")
    assert "GNU GENERAL PUBLIC LICENSE" in (ROOT / "blender" / "extension" / "LICENSE").read_text(encoding="utf-8")
