"""From a design of the page to the exact outlines that it draws, as fast as the pointer moves."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, Final, NamedTuple

from voronoi_tiles.base.errors import DesignError, TouchingCopiesError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.base.tolerance import FLATTENING_MM
from voronoi_tiles.base.units import UNIT_MM
from voronoi_tiles.base.values import is_number
from voronoi_tiles.designs.design import Design
from voronoi_tiles.formats.svg.path_text import path_data
from voronoi_tiles.groups.wallpaper import WallpaperGroup
from voronoi_tiles.studio.page_art import art_document
from voronoi_tiles.studio.page_colouring import Colourist
from voronoi_tiles.studio.refusals import error_document
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.proof import prove, proved_tiles
from voronoi_tiles.vector.tessellation import TileRecord, tessellate

PROOF_S: Final = 0.016
"""What engine and proof may take together for outlines to be proved while the pointer moves: a frame of a display."""

_FADING: Final = 0.9
"""How what a slow proof took fades with each outline that is not proved: a busy machine may have been to blame."""


class Said(NamedTuple):
    """A message to the page, and whether there is more to be said of the same design."""

    message: dict[str, Any]
    more: bool = False


_STANDING: Final = ("solid", "key")
"""The tables of a design that say what stands above its drawing."""


@dataclass
class Outliner:
    """Outlines of one design after the other; `proof_s` is what the last proof took for each edge, in seconds."""

    proof_s: float = 0.0
    colourist: Colourist = field(default_factory=Colourist)

    def outlines(self, rev: int, design: Mapping[str, Any], *, rest: bool, tolerance: float | None) -> Iterator[Said]:
        """What is said of a design: at rest its message "outline", proved and coloured, with its art.

        While the pointer moves the outline comes before its proof, which is the message "proof", where that is quick
        enough; of an outline that failed, one that passed takes the place. Strokes are flattened within `tolerance`
        then, in the coordinates of the drawing; None is as the design says. Raises DesignError, TouchingCopiesError
        and ProofError.
        """
        begun = time.perf_counter()
        # What is above the drawing does not change its tiles, and need not fit while that is drawn; but it is said.
        unfit = _unfit(design)
        design = {key: value for key, value in design.items() if key not in _STANDING}
        if rest:
            read, tiles = _tiles(design)
            tiles, _ = self._proved(read, tiles)
            message = _message(rev, read, tiles, unfit, proved=True)
            operations = [document["operations"] for document in message["tiles"]]
            message["colouring"] = self.colourist.colour(tiles[0].tessellation, operations)
            message["art"] = art_document(read)
            yield Said(_timed(message, begun))
            return
        read, tiles = _tiles(design, tolerance)
        message = _message(rev, read, tiles, unfit, proved=False)
        edges = sum(len(tile.outline) for tile in tiles)
        if time.perf_counter() - begun + self.proof_s * edges > PROOF_S:
            self.proof_s *= _FADING
            yield Said(_timed(message, begun))
            return
        yield Said(_timed(message, begun), more=True)
        tiles, mended = self._proved(read, tiles)
        if mended:
            yield Said(_timed(_message(rev, read, tiles, unfit, proved=True), begun))
        else:
            yield Said({"type": "proof", "rev": rev})

    def _proved(self, design: Design, tiles: list[TileRecord]) -> tuple[list[TileRecord], bool]:
        """The tiles of a design, proved, and whether they are others. Raises ProofError."""
        begun = time.perf_counter()
        passed = prove(design.group, design.lattice, tiles).passed
        self.proof_s = (time.perf_counter() - begun) / sum(len(tile.outline) for tile in tiles)
        if not passed:  # once more, as designs are tessellated that are not shown but written
            tiles, _ = proved_tiles(design.noded, design.group, design.lattice)
        return tiles, not passed


def _tiles(design: Mapping[str, Any], tolerance: float | None = None) -> tuple[Design, list[TileRecord]]:
    """A design, read, and its tiles, not proved; flattened as coarsely as `tolerance` where it has tiles then."""
    if tolerance is not None:
        with suppress(TouchingCopiesError):  # perhaps as they are flattened, and not as they are drawn
            return _tiles(coarser(design, tolerance))
    read = Design.from_dict(design)
    return read, tessellate(read.noded, read.group, read.lattice)


def _unfit(design: Mapping[str, Any]) -> dict[str, Any] | None:
    """What is wrong with what stands above a drawing that is right by itself; None where nothing is."""
    if not any(key in design for key in _STANDING):
        return None
    try:
        Design.from_dict(design)
    except DesignError as error:
        if error.key is not None and error.key.startswith(_STANDING):
            said = error_document(error)
            return {**said, "message": f"Commands will refuse this drawing with its {error.key}: {said['message']}"}
    return None


def _message(
    rev: int, design: Design, tiles: list[TileRecord], unfit: Mapping[str, Any] | None, *, proved: bool
) -> dict[str, Any]:
    """The message "outline" of a design, but for its time and its colours, which the page keeps meanwhile."""
    return {
        "unfit": unfit,
        "type": "outline",
        "rev": rev,
        "proved": proved,
        "scale": design.scale,
        "tiles": [tile_document(tile, design.group) for tile in tiles],
        "resolved": resolved(design),
    }


def _timed(message: dict[str, Any], begun: float) -> dict[str, Any]:
    """A message with what it took, in milliseconds."""
    return {**message, "ms": round(1000 * (time.perf_counter() - begun), 3)}


def coarser(design: Mapping[str, Any], tolerance: float) -> Mapping[str, Any]:
    """A design, not checked yet, whose strokes are flattened within a tolerance at least; before its `scale`."""
    sites, scale = design.get("site"), design.get("scale", 1.0)
    if not (isinstance(sites, list) and is_number(scale)):
        return design
    unit_mm = {str(name): size for name, size in UNIT_MM.items()}.get(str(design.get("units")), 1.0)
    found = []
    for site in sites:
        own: Any = site.get("tolerance", FLATTENING_MM / unit_mm) if isinstance(site, Mapping) else None
        found.append({**site, "tolerance": max(own, tolerance * scale)} if is_number(own) and own > 0.0 else site)
    return {**design, "site": found}


def tile_document(tile: TileRecord, group: WallpaperGroup) -> dict[str, Any]:
    """A tile as the page draws it: its path, y up, and the operations that take it to its copies in a cell."""
    outline = tile.outline
    left, bottom, right, top = outline.bounds
    operations = cosets(group, tile.symmetry)
    return {
        "site": tile.name,
        "path": path_of(outline),
        "edges": len(outline),
        "neighbours": len(outline.neighbours),
        "width": right - left,
        "height": top - bottom,
        "copies": len(operations),
        "operations": operations,
    }


def thumbnail_tiles(design: Design) -> list[dict[str, Any]]:
    """The tiles of a design as a small picture shows them: exact, and not proved."""
    tiles = tessellate(design.noded, design.group, design.lattice)
    return [{"path": path_of(tile.outline), "operations": cosets(design.group, tile.symmetry)} for tile in tiles]


def path_of(outline: Outline) -> str:
    """The rings of an outline as SVG path data in units, y up."""
    return path_data(outline.paths, top=None)


@lru_cache(maxsize=1024)
def cosets(group: WallpaperGroup, symmetry: tuple[Operation, ...]) -> tuple[int, ...]:
    """The indices of the group's operations that give each copy of a site in a cell once, the identity first.

    `symmetry` are the operations that map the site onto itself.
    """
    found: list[int] = []
    covered: set[Operation] = set()
    for k, operation in enumerate(group.operations):
        if operation.reduced() not in covered:
            found.append(k)
            covered |= {(operation @ own).reduced() for own in symmetry}
    return tuple(found)


def resolved(design: Design) -> dict[str, str]:
    """The path data of the strokes that name drawings, by the numbers of site and stroke: "0.2"."""
    if not design.drawings:
        return {}
    drawn, source = (json.loads(text)["site"] for text in (design.drawn, design.source))
    return {
        f"{k}.{i}": source[k]["strokes"][i]["path"]
        for k, site in enumerate(drawn)
        for i, stroke in enumerate(site["strokes"])
        if "file" in stroke
    }
