"""Designs opened as drawings: their strokes, cell and tiles, such that the selected strokes give the same tiles."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from helpers.examples import path_of
from helpers.inkscape_drawings import PAGES, difference, edges_of_path, paths_of, run

from voronoi_tiles import Design, Job
from voronoi_tiles.base.errors import VoronoiTilesError
from voronoi_tiles.designs.starters import starter_text
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.inkscape.extension import answer

KINDS = """
schema = 1
group = "p1"
units = "cm"
scale = 1.5

[cell]
a = 6.0
b = 5.0
angle = 80.0

[[site]]
name = "all kinds"
rotate = 10
strokes = [
  { point = [0.5, 2.5] },
  { segment = [[0.5, 0.3], [2.5, 1.1]] },
  { bezier = [[0.6, 0.9], [1.2, 1.6], [1.4, 0.2], [2.0, 0.6]] },
  { bspline = [[0.3, 1.2], [0.9, 1.9], [1.5, 1.4], [2.2, 2.0]], closed = true },
  { catmull_rom = [[2.4, 1.4], [2.8, 1.9], [2.2, 2.2]] },
  { path = "M 0.2 3 h 0.8 q 0.5 0.5 1 0 v -0.4 z" },
  { polyline = [[2.6, 0.4], [3.0, 0.5], [2.9, 0.9]], closed = true },
]

[[site]]
strokes = [{ segment = [[1.2, 4.2], [2.4, 4.3]] }]
"""


def groups_of(drawing: bytes) -> list[str]:
    """The ids of the groups of strokes."""
    (layer,) = ET.fromstring(drawing).iterfind("./*[@id='voronoi-strokes']")
    return [group.get("id", "") for group in layer.iterfind("{http://www.w3.org/2000/svg}g")]


def far(one: bytes, other: bytes) -> dict[str, float]:
    """How far the tiles of two drawings are apart, by their labels; millimetres."""
    first, second = paths_of(one), paths_of(other)
    assert list(first) == list(second)
    return {label: difference(edges_of_path(first[label]), edges_of_path(second[label])) for label in first}


def in_segments(design: Design) -> Design:
    """The design with its strokes flattened: by a rounding a curve may take one chord more or less."""
    table = design.to_dict()
    for site, noded in zip(table["site"], design.noded, strict=True):
        ends = noded.nodes[noded.segments]
        site["strokes"] = [{"segment": [[a.real, a.imag], [b.real, b.imag]]} for a, b in ends.tolist()]
    return Design.from_dict(table)


@pytest.mark.parametrize("name", ["kinds", *GROUPS])
def test_a_design_can_be_opened_and_made_again(name: str, tmp_path: Path) -> None:
    """Its selected strokes give the tiles that it has, in its cell, for all kinds of strokes and in all groups."""
    file = tmp_path / "design.toml"
    if name == "kinds":
        file.write_text(KINDS, encoding="utf-8")
    else:
        in_segments(Design.loads(starter_text(name))).save(file)
    drawing = answer("open", [str(file)])
    group = Design.load(file).group.name
    words = [f"--id={home}" for home in groups_of(drawing)]
    made = run(drawing, *words, f"--group={group}", folder=tmp_path)
    assert max(far(drawing, made).values()) < 1e-9


def test_the_tiles_are_the_designs_and_lie_on_the_page(tmp_path: Path) -> None:
    """In millimetres, in the place about the cell's rectangle that they have about the cell; all is on the page."""
    file = tmp_path / "design.toml"
    file.write_text(KINDS, encoding="utf-8")
    drawing = answer("open", [str(file)])
    root = ET.fromstring(drawing)
    (rectangle,) = root.iterfind(".//{http://www.w3.org/2000/svg}rect")
    numbers = [float(word) for word in rectangle.get("transform", "").removeprefix("matrix(").rstrip(")").split(",")]
    sides = [float(rectangle.get(name, "nan")) for name in ("width", "height")]
    assert sides == pytest.approx([90, 75])
    assert numbers[:4] == pytest.approx([1, 0, -np.cos(np.radians(80)), np.sin(np.radians(80))])
    origin = complex(numbers[4] + numbers[2] * sides[1], numbers[5] + numbers[3] * sides[1])
    _, _, width, height = (float(word) for word in root.get("viewBox", "").split())
    for tile in Design.load(file).tessellate():
        found = edges_of_path(paths_of(drawing)[tile.name])
        x, y = (found.real - origin.real) / 10, (origin.imag - found.imag) / 10
        assert [x[:, ::2].min(), x[:, ::2].max()] == pytest.approx([tile.bounds[0], tile.bounds[2]], abs=1e-2)
        assert y[:, ::2].min() == pytest.approx(tile.bounds[1], abs=1e-2)
        assert found[:, ::2].real.min() > 9
        assert found[:, ::2].real.max() < width - 9
        assert found[:, ::2].imag.min() > 9
        assert found[:, ::2].imag.max() < height - 9


@pytest.mark.parametrize("kind", ["exact", "sheet", "drawing"])
def test_the_design_of_a_drawing_is_laid_beside_it(kind: str, tmp_path: Path) -> None:
    """Of files of ours, and of what was made in Inkscape; nothing else changes, and the strokes give its tiles."""
    design = in_segments(Design.load(path_of("p4-hook")))
    tiling = design.tessellate()
    file = tmp_path / "a.svg"
    match kind:
        case "exact":
            tiling.export(file)
        case "sheet":
            tiling.export(file, job=Job(sheet=(200, 150), kerf=0.2))
        case _:
            body = '<path id="p" d="M 2 3 C 8 -4 15 14 24 6" style="stroke:#000"/>'
            file.write_bytes(run(PAGES[5].svg(body), "--id=p", "--group=p1", "--cell=numbers", folder=tmp_path))
    data = file.read_bytes()
    made = answer("strokes", [str(file)])
    words = [f"--id={home}" for home in groups_of(made)]
    cell = next(one.get("id") for one in ET.fromstring(made).iter() if one.get("id", "").startswith("voronoi-cell-"))
    group = "p1" if kind == "drawing" else "p4"
    again = run(made, *words, f"--id={cell}", f"--group={group}", folder=tmp_path)
    assert max(far(made, again).values()) < 1e-9
    if kind == "drawing":
        assert made.startswith(data[: data.index(b'<g xmlns="')])
    else:
        at = data.rindex(b"</svg>")
        assert made.startswith(data[:at])
        assert made.endswith(data[at:])
        width = float(ET.fromstring(data).get("width", "").removesuffix("mm"))
        assert min(edges_of_path(path).real.min() for path in paths_of(made).values()) > width


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.toml", "schema = 1\ngroup = 'p4'", "a.toml, cell: is missing."),
        ("a.toml", "schema = ", "a.toml, line 1: not TOML"),
        ("a.svg", "<svg/>", "a.svg: is a drawing, not a design. Make a design of it: voronoi-tiles new p4"),
        ("none.toml", None, "none.toml: cannot read the design: No such file or directory. Check the path"),
    ],
)
def test_what_is_no_design_is_refused(name: str, content: str | None, message: str, tmp_path: Path) -> None:
    """With the file, its line and key."""
    if content is not None:
        (tmp_path / name).write_text(content, encoding="utf-8")
    with pytest.raises(VoronoiTilesError) as refused:
        answer("open", [str(tmp_path / name)])
    assert str(refused.value).removeprefix(f"{tmp_path}/").startswith(message), refused.value
