"""The pictures of the paper's figures, with our own sites: which there are, what makes them, how a page shows them.

Every picture is written by one command that the page prints under it: `voronoi-tiles render` draws the exact outline
over the raster picture, docs/generate/perspective.py the cones and tents from the raster stage's numbers. The figures
in the captions are those of `voronoi-tiles info`. The paper: Panchal, Akleman, Krishnamurthy, Yildiz, Grover, "Curved
Space-Filling Tiles Using Voronoi Decomposition with Line, and Curve Segments Closed Under Wallpaper Symmetries".
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from running import ROOT, Command, command_block, image_table

from voronoi_tiles import Design, Tiling
from voronoi_tiles.base.text import counted

RENDER = ("voronoi-tiles", "render")
PERSPECTIVE = ("python", "docs/generate/perspective.py")
OUTLINE = ("--size", "480", "--overlay", "outline", "--renderer", "cpu")
"""How most pictures are drawn. The processor alone: then the pixels are the same on every machine."""
NEAR = "--region=-36,-36,36,36"
"""What Figs. 8 and 9 show of a cell so large that the copies in other cells are out of sight."""


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture: the design (its name in examples/paper), the file in docs/paper, a caption, what is measured in it.

    `measure` is "outline" for the edges and the curved share of the tile's whole outline, "boundary" for the edges
    between the two sites in view, "" for nothing; the caption is followed by what is measured.
    """

    design: str
    file: str
    caption: str
    arguments: tuple[str, ...] = OUTLINE
    program: tuple[str, ...] = RENDER
    measure: str = "outline"

    @property
    def command(self) -> Command:
        """The command that writes it."""
        return Command(self.program, f"examples/paper/{self.design}.toml", f"docs/paper/{self.file}", self.arguments)


@dataclass(frozen=True, slots=True)
class Family:
    """A figure of the paper, or several of one kind: its number, a title, what it shows, what we found, the pictures.

    `columns` is how many pictures stand beside each other.
    """

    number: str
    title: str
    shows: str
    found: str
    pictures: tuple[Picture, ...]
    columns: int = 2


def _tiles(figure: str, *rows: tuple[str, str]) -> tuple[Picture, ...]:
    """The pictures of tessellations, each from a design's name after the figure's, and a caption."""
    return tuple(Picture(f"{figure}-{name}", f"{figure}-{name}.png", caption) for name, caption in rows)


def _swimming(file: str, caption: str, region: str) -> Picture:
    """A picture of the tile with its art."""
    arguments = ("--size", "400", "--overlay", "art", f"--region={region}", "--renderer", "cpu")
    return Picture("fig01-fish", file, caption, arguments, measure="")


def _boundary(name: str, caption: str) -> Picture:
    """A picture of two sites and what lies between them."""
    return Picture(f"fig08-{name}", f"fig08-{name}.png", caption, (*OUTLINE, NEAR), measure="boundary")


def _envelope(name: str, what: str) -> tuple[Picture, Picture]:
    """The two pictures of cones and tents: in perspective, and from above by the depth test."""
    above = ("--size", "480", NEAR, "--method", "hoff", "--renderer", "cpu")
    return (
        Picture(f"fig09-{name}", f"fig09-{name}-side.png", f"{what}, seen from the side", (NEAR,), PERSPECTIVE, ""),
        Picture(f"fig09-{name}", f"fig09-{name}-top.png", f"{what}, seen from above", above, measure=""),
    )


def _curves(figure: str, group: str) -> tuple[Picture, Picture]:
    """The pictures of one and of two cubic curves in a group."""
    one, two = _tiles(figure, (group, f"{group}, one curve"), (f"{group}-two", f"{group}, two curves"))
    return one, two


FAMILIES: tuple[Family, ...] = (
    Family(
        "1",
        "A tile with art",
        "An Escher-like tile: the art is drawn once, on the outline that the program has computed, and goes onto "
        "every copy. Half of the fish are mirror images, as in every design in pg.",
        "The art of the copies is placed by the operations that place the outlines, so it meets the edges of every "
        "copy as it meets those of the first.",
        (
            _swimming("fig01-tile.png", "the tile, among its neighbours", "-30,-24,102,64"),
            _swimming("fig01-interlocked.png", "a few interlocked", "-54,-40,126,80"),
            _swimming("fig01-plane.png", "filling the plane", "-130,-94,206,130"),
        ),
        3,
    ),
    Family(
        "2",
        "Single lines in p1, p2, pg and p4",
        "One segment is enough for a curved tile: where the end of one copy faces the side of another, the edge "
        "between them is a piece of a parabola.",
        "All four tiles are curved; straight pieces remain where side faces side and end faces end.",
        _tiles(
            "fig02",
            ("p1", "p1, translations"),
            ("p2", "p2, half turns"),
            ("pg", "pg, glide reflections"),
            ("p4", "p4, quarter turns"),
        ),
    ),
    Family(
        "3",
        "Single lines in p3 and p6",
        "The same with thirds and sixths of a turn.",
        "Three or six tiles meet at the centres of rotation; the tiles are curved as in figure 2.",
        _tiles("fig03", ("p3", "p3, thirds of a turn"), ("p6", "p6, sixths of a turn")),
    ),
    Family(
        "4",
        "Several lines in p2, p4 and p3",
        "Segments that meet or cross are one site. Each branch pushes the outline out, so that the tiles hook into "
        "each other.",
        "Inside a site the segments' own regions meet in inner walls, which are no part of the outline: the copies "
        "share every edge that is left.",
        _tiles("fig04", ("p2", "p2, three segments"), ("p4", "p4, three segments"), ("p3", "p3, three segments")),
        3,
    ),
    Family(
        "5",
        "Lines in pm, cm, pmg and pgg",
        "Groups with reflections or glide reflections. A mirror that no site lies on becomes a straight line through "
        "the whole plane.",
        "pm, cm and pmg have mirrors, and straight lines on them. pgg has glide reflections and no mirror: there is no "
        "straight line in its picture.",
        _tiles(
            "fig05",
            ("pm", "pm, mirrors"),
            ("cm", "cm, mirrors and glide reflections"),
            ("pmg", "pmg, mirrors and half turns"),
            ("pgg", "pgg, glide reflections both ways"),
        ),
    ),
    Family(
        "6",
        "Lines in cmm, p4g and p31m",
        "Mirrors that enclose a region with one centre of rotation inside: the region is a polygon, and the copies in "
        "it share it by a curved cut.",
        "The mirrors make rectangles in cmm, squares in p4g, triangles in p31m, with two, four and three tiles "
        "in each.",
        _tiles("fig06", ("cmm", "cmm"), ("p4g", "p4g"), ("p31m", "p31m")),
        3,
    ),
    Family(
        "7",
        "Fixed polygons: p4m, pmm, p3m1 and p6m",
        "Mirrors that enclose a region without any centre of rotation inside: it holds one copy of the site, and the "
        "tile is the region.",
        "Whatever lies inside, the tile is the polygon of the mirrors, without a curved edge. Two sites, or one that "
        "lies on the mirrors, get curved tiles in these groups as well (`examples/p4m-rosette.toml`).",
        _tiles("fig07", ("p4m", "p4m"), ("pmm", "pmm"), ("p3m1", "p3m1"), ("p6m", "p6m")),
    ),
    Family(
        "8",
        "How a parabola arises",
        "Points as far from a point as from a line lie on the parabola with that focus and that directrix. A segment "
        "acts as its line where the nearest point is inside it, and as its end beyond.",
        "Every edge is either a line or one parabola, between one element of the one site and one of the other. "
        "The boundary of a segment and its mirror image is the mirror.",
        (
            _boundary("line", "a point and a line"),
            _boundary("segment", "a point and a segment"),
            _boundary("two", "two segments"),
            _boundary("mirrored", "a segment and its mirror image"),
        ),
    ),
    Family(
        "9",
        "Cones and tents",
        "The distance to a point is a cone, to a segment a tent. Turned upside down and seen from above with a depth "
        "test, what is highest is what is nearest (Hoff et al. 1999).",
        "The method `hoff` draws these meshes, cones with 128 sides; the perspective has its heights and owners, and "
        "lines of equal distance.",
        (
            *_envelope("point", "the cone of a point"),
            *_envelope("segment", "the tent of a segment"),
            *_envelope("four", "a point, a segment and two more"),
        ),
    ),
    Family(
        "10",
        "Cubic curves in p1",
        "Sites that are curves: the program flattens them to within a stated distance (`tolerance`, here 0.01 mm) and "
        "is exact from there on.",
        "The outline of a curve is a chain of many short lines and parabolas.",
        _curves("fig10", "p1"),
    ),
    Family(
        "11",
        "Cubic curves in pg",
        "One and two cubic curves with glide reflections.",
        "Two curves are one site, whether they meet, cross or keep apart.",
        _curves("fig11", "pg"),
    ),
    Family(
        "12",
        "Cubic curves in p3",
        "One and two cubic curves with thirds of a turn.",
        "A curve that is bent far enough gives tiles that hook into each other, as several lines do.",
        _curves("fig12", "p3"),
    ),
    Family(
        "13",
        "Cubic curves in p6",
        "One and two cubic curves with sixths of a turn.",
        "Six tiles meet in every six-fold centre, three in every three-fold one.",
        _curves("fig13", "p6"),
    ),
)
"""The figures of the paper in its order."""


def commands() -> Iterator[Command]:
    """The commands of all pictures."""
    return (picture.command for family in FAMILIES for picture in family.pictures)


def markdown(family: Family) -> str:
    """A family's section: what it shows, its pictures with captions, what we found, the commands."""
    pictures = [(picture.caption, f"paper/{picture.file}", caption(picture)) for picture in family.pictures]
    return "\n".join(
        (
            f"### Figure {family.number}: {family.title}\n",
            f"{family.shows}\n",
            image_table(pictures, family.columns),
            f"{family.found}\n",
            command_block(picture.command for picture in family.pictures),
        )
    )


def caption(picture: Picture) -> str:
    """A picture's caption with what is measured in it."""
    if not picture.measure:
        return picture.caption
    measured = _outline(picture.design) if picture.measure == "outline" else _between(picture.design)
    return f"{picture.caption}; {measured}"


@cache
def _tiling(design: str) -> Tiling:
    return Design.load(ROOT / f"examples/paper/{design}.toml").tessellate()


def _outline(design: str) -> str:
    """Say how many edges the tile of a design of one site has, and how much of its outline is curved."""
    (tile,) = _tiling(design).figures()["tiles"]
    return f"{sum(tile['edges'].values()):,} edges, {tile['curved_share']:.1%} curved"


def _between(design: str) -> str:
    """Say of what kinds the edges are between the first site and the other copy that is in view."""
    tiling = _tiling(design)
    other = tiling.tiles[-1].site.name
    # The other site itself, or with one site its image in the mirror x = 0.
    operation = "x,y" if len(tiling.tiles) > 1 else "-x,y"
    outline = tiling.tiles[0].outline
    shared = [(found.site, str(found.operation)) == (other, operation) for found in outline.neighbours]
    edges = outline.curved[np.array(shared)[outline.neighbour]].tolist()
    counts = ((edges.count(False), "line"), (edges.count(True), "parabola"))
    return "boundary: " + ", ".join(counted(count, what) for count, what in counts if count)
