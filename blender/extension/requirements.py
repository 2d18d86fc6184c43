# SPDX-License-Identifier: GPL-3.0-or-later
"""What the extension needs of what it brings and of Blender's Python, and what of that is not there."""

from __future__ import annotations

import sys
from functools import cache
from importlib import import_module
from pathlib import Path

REMEDY = "Install the extension's file for this platform from the project's releases, for this Blender."

LIBRARIES = (
    ("shapely", "solids, sheets and tiles with holes"),
    ("svgwrite", "SVG files"),
    ("tinycss2", "sheets drawn in SVG"),
    ("cssselect2", "sheets drawn in SVG"),
    ("coloraide", "sheets drawn in SVG"),
)


@cache
def engine_missing() -> tuple[str, ...]:
    """Why the engine cannot be used, in sentences; none where it can."""
    try:
        numpy = import_module("numpy")
    except ImportError as error:
        return (f"Blender's Python has no numpy: {error}.",)
    if sys.platform == "win32" and int(numpy.__version__.partition(".")[0]) < 2:
        return (f"On Windows numpy 2 is needed, and this Blender has {numpy.__version__}: use Blender 5.1 or later.",)
    try:
        found = import_module("voronoi_tiles").__version__
        import_module("voronoi_tiles.blender.drawn_tiling")
    except ImportError as error:
        return (f"The engine voronoi_tiles is missing: {error}.", REMEDY)
    wanted = _own_version()
    if found != wanted:
        return (f"voronoi_tiles {found} is loaded, and this extension brings {wanted}: restart Blender.",)
    return ()


@cache
def missing() -> tuple[str, ...]:
    """What cannot be done for want of a library, in sentences, beside `engine_missing`."""
    found = []
    for name, what in LIBRARIES:
        try:
            import_module(name)
        except ImportError as error:
            found.append(f"No {what}: {name} is missing ({error}).")
    return (*found, REMEDY) if found else ()


def usable() -> bool:
    """Whether the engine can be used."""
    return not engine_missing()


def _own_version() -> str:
    """The version in the manifest."""
    import tomllib

    manifest = Path(__file__).with_name("blender_manifest.toml").read_text(encoding="utf-8")
    return str(tomllib.loads(manifest)["version"])
