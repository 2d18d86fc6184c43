"""Make the extension for Blender: for each platform a file to install, with our wheel and those that it needs.

Our own wheels are those in dist, which `make wheels` makes; the others come by pip. Blender takes an extension whose
wheels fit none of its Pythons, or another platform, without a word, and lacks the library then: so it is looked here
whether each package has a wheel for each Python of each platform, and none that is of another.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final, NamedTuple

from voronoi_tiles.base.version import __version__

HERE = Path(__file__).parent
DIST = HERE.parent / "dist"

LIBRARIES: Final = (
    "shapely==2.1.2",
    "svgwrite==1.4.3",
    "tinycss2==1.5.1",
    "webencodings==0.6.1",
    "cssselect2==0.10.1",
    "coloraide==8.13.1",
)
"""What the panel needs beside the engine: solids and sheets, SVG files, and with the last four sheets that are drawn in
them. They run with the numpy that Blender has, which must never be brought along: other extensions would get it too.
DXF would need 11 MB more for two Pythons, and as much for what ezdxf needs."""

PACKAGES: Final = ("voronoi_tiles", *(library.partition("==")[0] for library in LIBRARIES))


class Platform(NamedTuple):
    """A platform as Blender names it: the tags that its wheels may have, its Pythons, and the first Blender."""

    tags: tuple[str, ...]
    pythons: tuple[str, ...]
    blender: str


BOTH: Final = ("3.11", "3.13")
"""The Pythons of Blender: that of 4.2 to 5.0, and that of 5.1 and later."""

PLATFORMS: Final = {
    "linux-x64": Platform(("manylinux_2_17_x86_64", "manylinux2014_x86_64"), BOTH, "4.2.0"),
    "macos-arm64": Platform(("macosx_11_0_arm64",), BOTH, "4.2.0"),
    "macos-x64": Platform(("macosx_10_13_x86_64", "macosx_10_9_x86_64"), BOTH, "4.2.0"),
    # numpy 1 has integers of 32 bits there, and Blender brings numpy 2 from 5.1 on.
    "windows-x64": Platform(("win_amd64",), ("3.13",), "5.1.0"),
}


class HoleError(Exception):
    """A package that has no wheel for a Python of a platform, or one of another."""


def fits(wheel: str, python: str, tags: Iterable[str]) -> bool:
    """Whether a wheel of this file name runs on a Python of a platform with these tags."""
    pythons, abis, platforms = (part.split(".") for part in wheel.removesuffix(".whl").split("-")[-3:])
    own = "cp" + python.replace(".", "")
    right = (own in pythons and own in abis) or ("py3" in pythons and abis == ["none"])
    return right and (platforms == ["any"] or bool(set(platforms) & set(tags)))


def check(name: str, platform: Platform, wheels: Sequence[str]) -> None:
    """Raise HoleError unless each package has one wheel for each Python of a platform, and no other is there."""
    wanted = set()
    for package in PACKAGES:
        for python in platform.pythons:
            found = [w for w in wheels if w.partition("-")[0].lower() == package and fits(w, python, platform.tags)]
            if len(found) != 1:
                raise HoleError(f"{name}, Python {python}: {len(found)} wheels of {package}, and there must be one")
            wanted.update(found)
    if set(wheels) != wanted:
        raise HoleError(f"{name}: {', '.join(sorted(set(wheels) - wanted))} is of another Python or platform")


def fetch(platform: Platform, folder: Path) -> None:
    """Have pip put the libraries' wheels for all Pythons of a platform into a folder."""
    for python in platform.pythons:
        where = [option for tag in platform.tags for option in ("--platform", tag)]
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
        only = ["--only-binary", ":all:", "--python-version", python]
        subprocess.run([*command, *only, *where, "--dest", str(folder), *LIBRARIES], check=True)


def manifest(name: str, platform: Platform, wheels: Iterable[str]) -> str:
    """What Blender reads first of the extension."""
    listed = "".join(f'  "./wheels/{wheel}",\n' for wheel in sorted(wheels))
    return f"""\
schema_version = "1.0.0"
id = "voronoi_tiles"
version = "{__version__}"
name = "Voronoi Tiles"
tagline = "Exact tiles of curves in the 17 wallpaper groups"
maintainer = "voronoi_tiles contributors"
type = "add-on"
tags = ["Add Curve", "Mesh", "Import-Export"]
blender_version_min = "{platform.blender}"
license = ["SPDX:GPL-3.0-or-later"]
copyright = ["2026 voronoi_tiles contributors"]
platforms = ["{name}"]
wheels = [
{listed}]

[permissions]
files = "Write tiles, solids and designs, and open designs"
"""


def build(name: str, own: Path, target: Path) -> Path:
    """The extension for a platform, with the wheel of ours in the folder `own` that fits it. Raises HoleError."""
    platform = PLATFORMS[name]
    with tempfile.TemporaryDirectory() as folder:
        fetch(platform, Path(folder))
        wheels = [*Path(folder).glob("*.whl")]
        wheels += [w for w in own.glob("voronoi_tiles-*.whl") if fits(w.name, platform.pythons[0], platform.tags)]
        check(name, platform, [wheel.name for wheel in wheels])
        files = {f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels}
    files["blender_manifest.toml"] = manifest(name, platform, (Path(key).name for key in files)).encode()
    for source in (*HERE.glob("extension/*.py"), HERE / "extension" / "LICENSE"):
        files[source.name] = source.read_bytes()
    made = target / f"voronoi_tiles-{__version__}-{name.replace('-', '_')}.zip"
    target.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for key in sorted(files):  # the same bytes whenever it is made
            archive.writestr(zipfile.ZipInfo(key), files[key], zipfile.ZIP_DEFLATED)
    return made


def main() -> None:
    """Make the extension for all platforms, or for some."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("platforms", nargs="*", metavar="PLATFORM", help=", ".join(PLATFORMS))
    parser.add_argument("--wheels", type=Path, default=DIST, help="where our wheels are [default: dist]")
    parser.add_argument("--output", type=Path, default=DIST, help="where the files go [default: dist]")
    given = parser.parse_args()
    for name in given.platforms or PLATFORMS:
        if name not in PLATFORMS:
            parser.error(f"{name} is none of {', '.join(PLATFORMS)}")
        try:
            print(build(name, given.wheels, given.output))
        except HoleError as error:
            sys.exit(f"{error}. `make wheels` makes ours.")


if __name__ == "__main__":
    main()
