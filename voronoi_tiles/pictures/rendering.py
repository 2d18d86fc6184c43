"""Pictures of tessellations: the raster stage's image, with what the other stages know drawn on top."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import TypedDict, Unpack, overload

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arguments import function, instance, path_name
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import ArgumentError, DesignError, ProofError, TouchingCopiesError
from voronoi_tiles.base.files import refuse_overwriting, require_suffix, writing
from voronoi_tiles.base.text import printable
from voronoi_tiles.base.values import shown
from voronoi_tiles.base.version import __version__
from voronoi_tiles.crosscheck import CheckReport
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.job_options import read_colours
from voronoi_tiles.formats.png import PngStream
from voronoi_tiles.groups.symmetry_elements import placed, symmetry_elements
from voronoi_tiles.pictures import difference as diff
from voronoi_tiles.pictures.clash import clash_marks
from voronoi_tiles.pictures.coordinate_grid import coordinate_grid
from voronoi_tiles.pictures.picture_region import fitted_region
from voronoi_tiles.pictures.picture_size import DEFAULT_SIZE
from voronoi_tiles.pictures.rendered import Rendering
from voronoi_tiles.raster.line_coverage import dashed
from voronoi_tiles.raster.picture import INK, Overlay, Picture, PictureStyle, Pixels, Region, default_region
from voronoi_tiles.raster.renderer import Choice, Method, Provenance, Renderer
from voronoi_tiles.raster.scene import Pattern
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.proof import proved_tiles
from voronoi_tiles.vector.tessellation import TileRecord

OVERLAYS = ("symmetry", "cell", "outline", "art", "grid")
"""What can be drawn on top: mirrors, glides and rotation centres; the cell; the exact outlines; the sites' art, in the
place of their strokes; a grid of coordinates."""

CELLS_MAX = 1_000_000
"""Most cells whose symmetry elements are drawn."""

SEGMENTS_MAX = 20_000_000
"""Most segments of a site's copies that are drawn on top; a count. They take a gigabyte."""

PIXELS_MAX = 2**28
"""Most pixels of a picture in memory, where they take 800 MB."""

_DOT = 3.0
"""How wide an isolated point is drawn; widths of strokes."""

_MIRROR = (178, 24, 43)
_GLIDE = (33, 102, 172)
_CENTRE = (120, 20, 110)
_CELL = (255, 255, 255)
_OUTLINE = (255, 0, 255)
_PAPER = (255, 255, 255)


class RenderOptions(TypedDict, total=False):
    """How a picture is rendered; see `render`."""

    size: int | tuple[int, int]
    region: Region | None
    overlay: str | Sequence[str]
    colours: str | int
    method: Method
    renderer: Choice
    device: int | None
    notice: Callable[[str], None] | None
    progress: Callable[[int, int], None] | None


@overload
def render(design: Design, path: None = None, **options: Unpack[RenderOptions]) -> Rendering: ...
@overload
def render(design: Design, path: str | os.PathLike[str], **options: Unpack[RenderOptions]) -> Provenance: ...
def render(
    design: Design, path: str | os.PathLike[str] | None = None, **options: Unpack[RenderOptions]
) -> Rendering | Provenance:
    """Render the coloured tessellation of a design: into memory, or as a PNG file, whole or not at all.

    Where copies touch or cross there are no tiles, and the picture shows why: the two copies and the place are marked,
    and `touching` of the result is the TouchingCopiesError that tessellate() raises, else None.

    Without a path the result holds the pixels and knows its PNG; a file of any size is written in bands, and the
    result says who rendered it. The options, all keywords:

    - `size`: the longer side in pixels, or width and height; default 1600;
    - `region`: the rectangle x0, y0, x1, y1 in the design's units, grown where `size` has another shape; default two
      cells each way;
    - `overlay`: what is drawn on top, of "symmetry" (mirrors, glides and rotation centres), "cell", "outline" (the
      exact ones, where there are any), "art" (in the place of the strokes) and "grid" (coordinates, with numbers);
    - `colours`: those that tiles get when they are cut, as `Job` takes them: a number, "fewest", "site", "handedness",
      "orientation";
    - `method`: "exact", or "hoff" for cones and tents with a depth test; `renderer`: "auto", "gl" or "cpu"; `device`:
      the number of OpenGL's device;
    - `notice` is called with one line when OpenGL is given up, `progress` with how many rows, of how many, are done.

    Raises ArgumentError for a size, a region or a word that cannot be, DesignError for art that is not there,
    RenderError where OpenGL fails and is insisted on, OutputError, with the overlay "outline" or `colours` ProofError,
    and JobError for `colours` that cannot be.

    >>> import voronoi_tiles as vt
    >>> picture = vt.render(vt.starter("p4"), size=(120, 80), renderer="cpu")
    >>> picture
    <Rendering 120 x 80: exact on cpu (numpy), float64>
    >>> picture.pixels.shape, picture.png[1:4]
    ((80, 120, 3), b'PNG')
    """
    return paint(design, path, **options)


def paint(
    design: Design,
    path: str | os.PathLike[str] | None,
    *,
    records: Sequence[TileRecord] | None = None,
    size: int | tuple[int, int] = DEFAULT_SIZE,
    region: Region | None = None,
    overlay: str | Sequence[str] = (),
    colours: str | int = "none",
    method: Method = "exact",
    renderer: Choice = "auto",
    device: int | None = None,
    notice: Callable[[str], None] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Rendering | Provenance:
    """Render as `render` does; `records` are the design's tiles, where they are known."""
    instance("design", design, Design)
    for name, call in (("notice", notice), ("progress", progress)):
        function(name, call)
    if path is not None:
        path = path_name("path", path)
        require_suffix(path, (".png",))
        refuse_overwriting([path], design.files)
    if not isinstance(overlay, Iterable):
        raise ArgumentError(f"`overlay` {shown(overlay)} is unknown", remedy=f"Use some of {', '.join(OVERLAYS)}.")
    overlay = [overlay] if isinstance(overlay, str) else list(overlay)
    for word in overlay:
        if word not in OVERLAYS:
            raise ArgumentError(f"`overlay` {shown(word)} is unknown", remedy=f"Use {', '.join(OVERLAYS)}.")
    scheme = read_colours("colours", colours)
    pattern = Pattern(design.noded, design.group, design.lattice)
    region, width, height = fitted_region(default_region(pattern) if region is None else region, size)
    touching: TouchingCopiesError | None = None
    if records is None:
        records, touching = _records(design, needed="outline" in overlay or scheme != "none")
    outlines = None if records is None else [record.outline for record in records]
    style = PictureStyle.of_size(width, height)
    if "art" in overlay:
        style = replace(style, site=0.0)
    colouring = None
    if scheme != "none" and records is not None:
        from voronoi_tiles.pictures.wood_colouring import wood_colouring

        colouring = wood_colouring(records[0].tessellation, pattern, scheme)
    picture = Picture(
        pattern,
        region,
        width,
        height,
        renderer=Renderer(renderer, device=device, method=method, notice=notice),
        overlays=[
            *_dots(pattern, region, style),
            *_overlays(design, outlines, pattern, region, width, overlay),
            *(clash_marks(touching, design, region, width, height) if touching else []),
        ],
        style=style,
        colouring=colouring,
        nobody=_PAPER if touching else None,
    )
    text = {
        "Software": f"voronoi-tiles {__version__}",
        "Title": printable(f"{design.name} ({design.group.name})"),
        "Source": design.source,
    }
    if touching is not None:
        text["Warning"] = printable(str(touching))
    per_metre = min(max(width / ((region[2] - region[0]) * design.unit_mm / 1000), 1.0), 2.0**31 - 1)
    if path is None:
        if width * height > PIXELS_MAX:
            raise ArgumentError(
                f"a picture of {width:,} x {height:,} pixels takes too much memory",
                remedy=f"Give a `path` to write it to; in memory {PIXELS_MAX:,} are the most.",
            )
        bands = list(_told(picture, progress))
        trailer, by = _trailer(picture), replace(picture.provenance, touching=touching)
        return Rendering(np.concatenate(bands), text, per_metre, trailer, by, design.files)
    with writing(path) as file, PngStream(file, width, height, pixels_per_metre=per_metre, text=text) as png:
        for band in _told(picture, progress):
            png.write(band)
        png.trailer.update(_trailer(picture))
    return replace(picture.provenance, touching=touching)


def _told(picture: Picture, progress: Callable[[int, int], None] | None) -> Iterator[Pixels]:
    """The bands of a picture; `progress` is told of each when it has been taken."""
    rows = 0
    for band in picture.bands():
        yield band
        rows += len(band)
        if progress is not None:
            progress(rows, picture.height)


def _trailer(picture: Picture) -> dict[str, str]:
    """What a PNG says at its end: who rendered it, in turn."""
    return {"Renderer": ", then ".join(picture.renderers)}


def difference(design: Design, outlines: Sequence[Outline], report: CheckReport) -> Rendering:
    """Draw where a cross-check has found differences, and by how much: white where there is none."""
    pattern = Pattern(design.noded, design.group, design.lattice)
    around = diff.region(report, design.lattice)
    segments = np.zeros((0, 2), complex)
    if not report.passed:
        segments = outline_segments(outlines, pattern, around, accuracy=(around[2] - around[0]) / 10_000)
    text = {"Software": f"voronoi-tiles {__version__}", "Report": json.dumps(report.document())}
    pixels = diff.difference_pixels(report, design.lattice, segments)
    return Rendering(pixels, text, provenance=report.provenance, files=design.files)


def _overlays(
    design: Design,
    outlines: Sequence[Outline] | None,
    pattern: Pattern,
    region: Region,
    width: int,
    wanted: Iterable[str],
) -> list[Overlay]:
    """The lines to be drawn on top: all lengths that are no widths in the design's units."""
    wanted = set(wanted)
    pixel = (region[2] - region[0]) / width
    side = math.sqrt(width * (region[3] - region[1]) / pixel)
    line = max(1.0, side / 500)
    found = []
    if "cell" in wanted:
        a, b = design.lattice.a, design.lattice.b
        middle = complex(region[0] + region[2], region[1] + region[3]) / 2
        x, y = design.lattice.fractional(middle - (a + b) / 2)
        corner = round(x) * a + round(y) * b
        corners = corner + np.array([0, a, a + b, b, 0])
        segments = np.stack((corners[:-1], corners[1:]), axis=1)
        found += [Overlay(segments, 3.0 * line, (60, 60, 60)), Overlay(segments, 1.5 * line, _CELL)]
    if "symmetry" in wanted:
        cells = (region[2] - region[0]) * (region[3] - region[1]) / design.lattice.det
        if cells > CELLS_MAX:
            raise ArgumentError(
                f"the `region` has {cells:,.0f} cells, whose symmetry is drawn as a blot",
                remedy=f"Take a smaller one, up to {CELLS_MAX:,} cells, or leave the overlay out.",
            )
        elements = placed(symmetry_elements(design.group), design.lattice, region)
        glides = dashed(elements.glides, 10 * line * pixel, 6 * line * pixel)
        found += [Overlay(elements.mirrors, 1.4 * line, _MIRROR), Overlay(glides, 1.4 * line, _GLIDE)]
        symbols = _symbols(elements.centres, elements.orders, 7 * line * pixel)
        found += [Overlay(symbols, 5.0 * line, _PAPER), Overlay(symbols, 2.4 * line, _CENTRE)]
    if "outline" in wanted and outlines is not None:
        segments = outline_segments(outlines, pattern, region, accuracy=pixel / 10)
        found.append(Overlay(segments, line, _OUTLINE))
    if "art" in wanted:
        found.append(Overlay(_art_segments(design, pattern, region, accuracy=pixel / 10), 1.5 * line, INK))
    if "grid" in wanted:
        found += coordinate_grid(region, width, round((region[3] - region[1]) / pixel), design.units)
    return found


def _records(design: Design, *, needed: bool) -> tuple[list[TileRecord] | None, TouchingCopiesError | None]:
    """The tiles, None where they fail their proof or copies touch, and the error that says where these do.

    A picture is drawn all the same. Raises ProofError where the tiles are `needed`.
    """
    try:
        return proved_tiles(design.noded, design.group, design.lattice)[0], None
    except ProofError:
        if needed:
            raise
        return None, None
    except TouchingCopiesError as error:
        return None, error.with_file(design.file or None)


def _symbols(centres: Complexes, orders: NDArray[np.intp], radius: float) -> Complexes:
    """The sides of the symbols of rotation centres: a lens for 2, else regular polygons; complex128 (n, 2)."""
    sides = []
    for order in (2, 3, 4, 6):
        count = 4 if order == 2 else order
        turn = np.exp(2j * np.pi * (np.arange(count + 1) / count + 0.25))
        if order == 2:
            turn = turn.real * 0.5 + 1j * turn.imag
        corners = centres[orders == order, None] + radius * turn
        sides.append(np.stack((corners[:, :-1], corners[:, 1:]), axis=-1).reshape(-1, 2))
    return np.concatenate(sides)


def _dots(pattern: Pattern, region: Region, style: PictureStyle) -> list[Overlay]:
    """Draw isolated points larger than strokes are wide, or they would not be seen; nothing where strokes are not."""
    if not style.site:
        return []
    flat = [site.ends[site.ends[:, 0] == site.ends[:, 1]] for site in pattern.sites]
    return [Overlay(on_all_copies(flat, pattern, region), _DOT * style.site, INK)]


def outline_segments(outlines: Sequence[Outline], pattern: Pattern, region: Region, *, accuracy: float) -> Complexes:
    """The outlines of all copies that may show in a region as chords, within `accuracy` (in units): (n, 2)."""
    flat = [
        np.concatenate([np.stack((ring, np.roll(ring, -1)), axis=1) for ring in outline.flatten(accuracy=accuracy)])
        for outline in outlines
    ]
    return on_all_copies(flat, pattern, region)


def _art_segments(design: Design, pattern: Pattern, region: Region, *, accuracy: float) -> Complexes:
    """The art on all copies that may show in a region as chords, within `accuracy` (in units): (n, 2).

    Raises DesignError where the design has none, or it cannot be read.
    """
    from voronoi_tiles.fabrication.artwork import read_art
    from voronoi_tiles.paths.conversion import to_lines

    flat = [np.zeros((0, 2), complex) for _ in design.noded]
    for site, art in enumerate(design.art):
        if art is not None:
            works = read_art(art, design.folder, site, design.unit_mm, fills=False)
            lines = [to_lines(paths, accuracy=accuracy) for paths in (works.engraved, works.scored)]
            flat[site] = np.concatenate([np.stack((paths.start, paths.end), axis=1) for paths in lines])
    if not any(map(len, flat)):
        raise DesignError(
            "there is no art to draw",
            key="site[0].art",
            remedy='Give a site its drawing, as art = "face.svg" (voronoi-tiles template makes one to draw in).',
        )
    return on_all_copies(flat, pattern, region)


def on_all_copies(flat: Sequence[Complexes], pattern: Pattern, region: Region) -> Complexes:
    """The segments (n, 2) of every site on all its copies that may show in a region: (m, 2)."""
    lattice = pattern.lattice
    corners = np.array([complex(x, y) for x in region[::2] for y in region[1::2]])
    found = []
    for placement in pattern.placements:
        segments = placement.isometry(flat[placement.site])
        if not len(segments):
            continue
        # The translates whose box, in lattice coordinates, meets that of the region.
        ranges = [
            range(math.ceil(shown.min() - own.max()), math.floor(shown.max() - own.min()) + 1)
            for shown, own in zip(lattice.fractional(corners), lattice.fractional(segments.ravel()), strict=True)
        ]
        if len(ranges[0]) * len(ranges[1]) * len(segments) > SEGMENTS_MAX:
            raise ArgumentError(
                "the `region` holds too many copies to draw", remedy="Take a smaller one, or leave the overlay out."
            )
        i, j = (part.ravel() for part in np.meshgrid(*ranges))
        found.append((segments[None] + (i * lattice.a + j * lattice.b)[:, None, None]).reshape(-1, 2))
    return np.concatenate([np.zeros((0, 2), complex), *found])
