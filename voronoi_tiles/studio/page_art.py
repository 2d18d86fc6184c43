"""The art of a design as the page draws it, beside the strokes: path data, and what is wrong with it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.text import counted
from voronoi_tiles.designs.art import Art
from voronoi_tiles.designs.design import Design
from voronoi_tiles.formats.svg.path_text import path_data
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.studio.refusals import error_document

SHOWN_MAX: Final = 20_000
"""Art of more pieces is not shown; a count. A canvas draws as many on some dozen copies in a frame or two."""


def art_document(design: Design) -> dict[str, Any]:
    """What the page is told of a design's art.

    `paths` are path data in units, y up, by the numbers of sites that have some. `trouble` is why one of them is not
    shown, None where all are.
    """
    paths: dict[str, str] = {}
    trouble: Mapping[str, Any] | None = None
    for site, art in enumerate(design.art):
        if art is None:
            continue
        file = Path(design.folder) / art.file
        try:
            changed = file.stat().st_mtime_ns
        except OSError:
            changed = 0
        found = _path_of(art, design.folder, site, design.unit_mm, changed)
        if isinstance(found, str):
            paths[str(site)] = found
        else:
            trouble = trouble or found
    return {"paths": paths, "trouble": trouble}


@lru_cache(maxsize=64)
def _path_of(art: Art, folder: str, site: int, unit_mm: float, _changed: int) -> str | dict[str, Any]:
    """The path data of a site's art, or why there are none; read anew where its file has changed."""
    from voronoi_tiles.fabrication.artwork import read_art

    try:
        works = read_art(art, folder, site, unit_mm, fills=False)
    except DesignError as error:
        said = error_document(error)
        return {**said, "message": f"Sheets will refuse this drawing: {said['message']}"}
    paths = Paths.concatenate([works.engraved, works.scored])
    if len(paths.start) > SHOWN_MAX:
        what = f"{art.file} has {counted(len(paths.start), 'piece')}: it is engraved with the tiles, and not shown here"
        return {"message": what, "remedy": "Nothing is wrong with it.", "key": f"site[{site}].art"}
    return path_data(paths, top=None)
