"""What the page knows and does not compute: groups, kinds of strokes, options of jobs, presets, and the starters."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, Final, Literal, get_args

from voronoi_tiles.base.units import UNIT_MM
from voronoi_tiles.base.version import __version__
from voronoi_tiles.designs.drawn_strokes import StrokeKind
from voronoi_tiles.designs.solid_checking import LAYERS
from voronoi_tiles.designs.starters import GROUP_NAMES, starter, symmetry_of
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_options import OptionTable
from voronoi_tiles.formats.presets import FORMATS as DRAWINGS
from voronoi_tiles.formats.presets import load_preset, preset_names
from voronoi_tiles.groups.symmetry_elements import Line, symmetry_elements
from voronoi_tiles.groups.wallpaper import GROUPS, WallpaperGroup
from voronoi_tiles.pictures.picture_size import DEFAULT_SIZE
from voronoi_tiles.solid.solid_job import SolidJob
from voronoi_tiles.solid.solid_model import SOLID_FORMATS
from voronoi_tiles.studio.messages import LIMITS
from voronoi_tiles.studio.outlining import thumbnail_tiles
from voronoi_tiles.tiling import FORMATS, FileFormat

_SQUARE: Final = "0,0 1/2,0 1/2,1/2 0,1/2"
_KITE: Final = "0,0 1/2,0 2/3,1/3 1/2,1/2"

REGIONS: Final[Mapping[str, str]] = {
    "p1": "0,0 1,0 1,1 0,1",
    "p2": "0,0 1/2,0 1/2,1 0,1",
    "pm": "0,0 1/2,0 1/2,1 0,1",
    "pg": "0,0 1/2,0 1/2,1 0,1",
    "cm": _SQUARE,
    "pmm": _SQUARE,
    "pmg": "0,0 1/4,0 1/4,1 0,1",
    "pgg": _SQUARE,
    "cmm": "0,0 1/4,0 1/4,1/2 0,1/2",
    "p4": _SQUARE,
    "p4m": "0,0 1/2,0 1/2,1/2",
    "p4g": "0,0 1/2,0 0,1/2",
    "p3": "0,0 1/2,0 2/3,1/3 1/3,2/3 0,1/2",
    "p3m1": "0,0 2/3,1/3 1/3,2/3",
    "p31m": _KITE,
    "p6": _KITE,
    "p6m": "0,0 1/2,0 2/3,1/3",
}
"""The corners of an asymmetric unit of each group, fractional coordinates (International Tables, vol. A)."""

Form = FileFormat | Literal["png"]
FORMS: Final[tuple[Form, ...]] = (*FORMATS, "png")
"""What a job can be downloaded as."""

HIDDEN: Final = ("only_colour",)
"""Options of a job that are for the program's own use."""


def page_tables() -> dict[str, Any]:
    """What the page needs to know, in the types of JSON: coordinates are fractional, angles in degrees."""
    return {
        "version": __version__,
        "groups": [group_document(group) for group in GROUPS.values()],
        "kinds": list(get_args(StrokeKind)),
        "job": job_options(Job),
        "solid": job_options(SolidJob),
        "presets": [{"name": name, "title": load_preset(name).title} for name in preset_names()],
        "formats": list(FORMS),
        "solids": list(SOLID_FORMATS),
        "layers": LAYERS,
        "coupon": list(DRAWINGS),
        "units": dict(UNIT_MM),
        "limits": {**LIMITS, "picture": DEFAULT_SIZE},
    }


def starter_designs() -> list[dict[str, Any]]:
    """The starter of every group: what the group does, its design, and the tiles of that, for a picture."""
    designs = {name: starter(name) for name in GROUP_NAMES}
    return [
        {"group": name, "title": symmetry_of(name), "design": design.to_dict(), "tiles": thumbnail_tiles(design)}
        for name, design in designs.items()
    ]


def group_document(group: WallpaperGroup) -> dict[str, Any]:
    """A group: what its cell leaves free, its operations on columns of coordinates, its elements in one cell."""
    elements = symmetry_elements(group)
    return {
        "name": group.name,
        "title": symmetry_of(group.name),
        "order": group.order,
        "system": group.system,
        "free": ["a", *([] if group.fixes_b else ["b"]), *([] if group.fixed_angle is not None else ["angle"])],
        "angle": group.fixed_angle,
        "operations": [
            {"name": str(operation), "w": list(operation.linear), "t": list(map(float, operation.translation))}
            for operation in group.operations
        ],
        "centres": [{"at": [float(centre.x), float(centre.y)], "order": centre.order} for centre in elements.centres],
        "mirrors": list(map(_line_document, elements.mirrors)),
        "glides": list(map(_line_document, elements.glides)),
        "region": [[float(Fraction(part)) for part in corner.split(",")] for corner in REGIONS[group.name].split()],
    }


def job_options(job: type[OptionTable]) -> list[dict[str, Any]]:
    """The options of a kind of job: for each what it takes, its default and what it means."""
    return [
        {
            "name": name,
            "kind": option.kind,
            "default": option.default,
            "help": option.help,
            "words": list(option.words),
            "shown": option.shown,
        }
        for name, option in job.options().items()
        if name not in HIDDEN
    ]


def _line_document(line: Line) -> dict[str, Any]:
    """A mirror or glide line: a point on it, and its direction."""
    return {"through": [float(part) for part in line.point], "along": list(line.direction)}
