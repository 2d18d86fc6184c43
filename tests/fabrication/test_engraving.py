"""Art on every copy, labels in every piece, marks and the bar, the page to draw on."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from helpers.cutting import SQUARES, contour_shapes, cuts, dense, exact_shape, lines_of, squares, true_lengths, work
from helpers.sheets import xy

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.art_template import art_template
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_fields import Fit
from voronoi_tiles.fabrication.lettering import lettering
from voronoi_tiles.formats.writing import write_drawing
from voronoi_tiles.tiling import Tiling

EXAMPLES = Path(__file__).parents[2] / "examples"
PAGE = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
PAGE += 'width="30mm" height="20mm" viewBox="0 0 30 20">{body}</svg>'
STROKE = 'fill="none" stroke="black"'


def drawn(folder: Path, body: str, name: str = "pg-wave", placed: str = "translate = [4, 7], rotate = 30") -> Tiling:
    """An example with art on its first site."""
    (folder / "face.svg").write_text(PAGE.format(body=body))
    text = (EXAMPLES / f"{name}.toml").read_text()
    art = f'art = {{ file = "face.svg", {placed} }}\n'
    (folder / "design.toml").write_text(text.replace("[[site]]\n", f"[[site]]\n{art}", 1))
    return Design.load(folder / "design.toml").tessellate()


def on_copies(tiles: Tiling, points: Any, size: tuple[float, float]) -> dict[Any, Any]:
    """The images of points of the first tile (in units) on all copies that are whole on a sheet, and the copies' areas.

    By the operations of the group alone.
    """
    design = tiles.design
    unit, lattice = design.unit_mm, design.lattice
    room = shapely.box(-1e-6, -1e-6, size[0] + 1e-6, size[1] + 1e-6)
    found = {}
    for operation in design.group.operations:
        for i in range(-6, 7):
            for j in range(-6, 7):
                here = operation.translated(i, j)
                area = shapely.affinity.translate(
                    exact_shape(tiles.tiles[0].copy(here), unit, 1e-3), size[0] / 2, size[1] / 2
                )
                if room.covers(area):
                    image = lattice.isometry(here)(points) * unit + complex(*size) / 2
                    found[here] = (image, area)
    return found


def check_copies(lines: Any, images: list[Any]) -> None:
    """Every image is drawn, and nothing else is."""
    wanted = shapely.multilinestrings([xy(image) for image in images])
    assert lines.length == pytest.approx(wanted.length, rel=1e-6)
    assert float(shapely.distance(lines, dense(wanted)).max()) < 1e-6
    assert float(shapely.distance(wanted, dense(lines)).max()) < 1e-6


@pytest.mark.parametrize("name", ["pg-wave", pytest.param("p4g-fan", marks=pytest.mark.slow), "p1-leaf"])
def test_art_moves_with_every_copy(tmp_path: Path, name: str) -> None:
    """Turned and mirrored where the copy is; only on tiles that are there."""
    tiles = drawn(tmp_path, f'<path d="M 2 3 L 9 4 L 5 12" {STROKE}/>', name)
    side = 2.6 * abs(tiles.design.lattice.a) * tiles.design.unit_mm
    size = (side, side)
    # The page's lower left corner lies on the origin; y runs up.
    art = np.array([2 + 17j, 9 + 16j, 5 + 8j]) * np.exp(1j * np.pi / 6) / tiles.design.unit_mm + 4 + 7j
    images = [image for image, _ in on_copies(tiles, art, size).values()]
    product = tiles.make(Job(sheet=size, offset=0j))
    lines = shapely.multilinestrings(lines_of(work(product, "engrave")))
    check_copies(lines, images)
    if tiles.design.group.name != "p1":
        assert any(operation.determinant < 0 for operation in on_copies(tiles, art, size))
    with pytest.raises(AssertionError):
        check_copies(lines, images[1:])
    with pytest.raises(AssertionError):
        check_copies(lines, [image + 1e-3 for image in images])
    assert not len(work(tiles.make(Job(sheet=size, art="none")), "engrave"))


def test_art_goes_with_tiles_that_are_pulled_apart(tmp_path: Path) -> None:
    """By as much as their contours."""
    tiles = drawn(tmp_path, f'<path d="M 2 3 L 9 4 L 5 12" {STROKE}/>', "p1-leaf")
    size = (250.0, 250.0)
    product = tiles.make(Job(sheet=size, gap=3.0))
    areas = contour_shapes(cuts(product), 1e-3)
    lines = lines_of(work(product, "engrave"))
    assert len(areas) == len(lines) > 4
    # The tiles are translates of one another: so is what is drawn on them.
    corners = np.array([complex(*area.bounds[:2]) for area in areas])
    starts = np.array([complex(line.centroid.x, line.centroid.y) for line in lines])
    apart = [np.abs(starts[:, None] - corners - (start - corners[0])).min(axis=0).max() for start in starts]
    assert min(apart) < 1e-3


@pytest.mark.parametrize("fit", ["whole", "clip"])
def test_clipped_art_stays_inside_its_tile(tmp_path: Path, fit: Fit) -> None:
    """What of long lines lies in each tile is drawn, and no more; on the sheet alone where that cuts the tile."""
    outline = Design.load(EXAMPLES / "pg-wave.toml").tessellate().tiles[0].outline
    inner = exact_shape(outline, 1.0).representative_point()
    z = (complex(inner.x, inner.y) - (4 + 7j)) * np.exp(-1j * np.pi / 6)
    body = f'<path d="M -60 3 L 90 4" {STROKE}/><circle cx="{z.real}" cy="{20 - z.imag}" r="0.2" {STROKE}/>'
    tiles = drawn(tmp_path, body)
    size = (150.0, 150.0)
    product = tiles.make(Job(sheet=size, offset=0j, art="clip", fit=fit))
    lines = shapely.multilinestrings(lines_of(work(product, "engrave")))
    art = np.array([-60 + 17j, 90 + 16j]) * np.exp(1j * np.pi / 6) + 4 + 7j
    inside = [
        shapely.LineString(xy(image)).intersection(area).length for image, area in on_copies(tiles, art, size).values()
    ]
    straight = [line for line in lines.geoms if len(line.coords) == 2]
    if fit == "whole":
        assert sum(line.length for line in straight) == pytest.approx(sum(inside), abs=0.01 * len(inside))
        assert len(lines.geoms) - len(straight) == len(inside)
        for line in straight:
            areas = [area for _, area in on_copies(tiles, art[:1], size).values()]
            assert any(area.buffer(6e-3).covers(line) for area in areas)
    else:
        assert sum(line.length for line in straight) > sum(inside)
        assert shapely.box(-1e-6, -1e-6, 150 + 1e-6, 150 + 1e-6).covers(lines)
    free = shapely.multilinestrings(lines_of(work(tiles.make(Job(sheet=size, offset=0j)), "engrave")))
    assert free.length > 1.5 * lines.length


def test_layers_of_the_art(tmp_path: Path) -> None:
    """What is on a layer "score" is scored, what is on "guide" is no art, nor is what has neither line nor filling."""
    layer = '<g inkscape:groupmode="layer" inkscape:label="{0}"><path d="M {1} 3 h 4" {2}/></g>'
    body = "".join(
        layer.format(name, x, look)
        for name, x, look in (
            ("Engrave", 2, STROKE),
            ("Scores", 4, STROKE),
            ("Guide", 6, STROKE),
            ("x", 8, 'fill="none" stroke="none"'),
        )
    )
    tiles = drawn(tmp_path, body + '<path d="M 1 1 h 5 v 5 Z" fill="black"/>')
    product = tiles.make(Job())
    assert len(work(product, "score")) == 1
    assert sorted(work(product, "engrave").counts.tolist()) == [1, 3]
    assert [layer.work for layer in product.drawing.layers] == ["engrave", "score", "cut"]


def test_targets_that_engrave_what_is_filled(tmp_path: Path) -> None:
    """Closed shapes with a filling are filled, with their holes; all lines are scored, labels too."""
    body = f'<path d="M 1 1 h 5 v 5 h -5 Z M 2 2 h 2 v 2 h -2 Z" fill="black"/><path d="M 8 8 h 4" {STROKE}/>'
    tiles = drawn(tmp_path, body)
    job = Job(sheet=(150.0, 150.0), labels="number", preset="glowforge", edges="pieces")
    product = tiles.make(job)
    filled = [layer for layer in product.drawing.layers if layer.filled]
    assert [layer.work for layer in filled] == ["engrave"]
    assert np.diff(filled[0].items).tolist() == [2] * len(product.pieces.site)
    assert true_lengths(filled[0].paths).sum() == pytest.approx(28 * len(product.pieces.site))
    assert [layer.work for layer in product.drawing.layers] == ["engrave", "score", "cut"]
    product.write(file := (tmp_path / "out.svg").open("wb"))
    file.close()
    text = (tmp_path / "out.svg").read_text()
    assert text.count('fill="#ff0000"') == 1
    assert not any(layer.filled for layer in tiles.make(Job(sheet=(150.0, 150.0))).drawing.layers)


def test_filled_shapes_are_clipped_as_areas(tmp_path: Path) -> None:
    """What of a shape lies in the tile is filled, with the tile's edge as its own."""
    (tmp_path / "face.svg").write_text(PAGE.format(body='<path d="M 5 5 h 30 v 10 h -30 Z" fill="black"/>'))
    text = SQUARES.replace("[[site]]", '[[site]]\nart = "face.svg"')
    (tmp_path / "d.toml").write_text(text)
    tiles = Design.load(tmp_path / "d.toml").tessellate()
    product = tiles.make(Job(preset="glowforge", art="clip"))
    (filled,) = (layer for layer in product.drawing.layers if layer.filled)
    (area,) = contour_shapes(filled.paths)
    assert area.area == pytest.approx(150.0, abs=0.01)
    assert area.bounds == pytest.approx((5, 5, 20, 15), abs=0.006)
    (tmp_path / "face.svg").write_text(PAGE.format(body='<path d="M 5 5 L 35 15 V 5 L 5 12 Z" fill="black"/>'))
    with pytest.raises(DesignError, match="crosses itself"):
        tiles.make(Job(preset="glowforge", art="clip"))


@pytest.mark.parametrize(
    ("content", "message"),
    [(None, "cannot be read"), ("<svg", "art cannot be used"), ("hello", "art cannot be used")],
)
def test_art_that_cannot_be_read(tmp_path: Path, content: str | None, message: str) -> None:
    """The message names the file and the key."""
    tiles = drawn(tmp_path, "")
    if content is None:
        (tmp_path / "face.svg").unlink()
    else:
        (tmp_path / "face.svg").write_text(content)
    with pytest.raises(DesignError, match=message) as caught:
        tiles.make(Job())
    assert caught.value.key == "site[0].art"
    assert "face.svg" in str(caught.value)


@pytest.mark.parametrize("name", ["pg-wave", "p4-mill"])
def test_what_is_drawn_on_the_template_lands_on_the_tile(tmp_path: Path, name: str) -> None:
    """A line between two points of the tile, drawn where the page shows them."""
    plain = Design.load(EXAMPLES / f"{name}.toml").tessellate()
    unit = plain.design.unit_mm
    drawing, corner = art_template(plain.tiles[0].site, plain.tiles[0].outline, unit)
    with (tmp_path / "page.svg").open("wb") as file:
        write_drawing(drawing, file, "svg", accuracy=0.005)
    inner = exact_shape(plain.tiles[0].outline, unit).representative_point()
    points = np.array([complex(inner.x, inner.y), complex(inner.x + 1, inner.y + 0.5)])
    page = points - corner * unit
    places = " ".join(f"{z.real} {drawing.height - z.imag}" for z in page)
    line = f'<path d="M {places}" {STROKE}/>'
    text = (tmp_path / "page.svg").read_text()
    before, mark, after = text.rpartition("</g>")
    assert mark
    (tmp_path / "face.svg").write_text(f"{before}{line}</g>{after}")
    source = (EXAMPLES / f"{name}.toml").read_text()
    art = f'art = {{ file = "face.svg", translate = [{corner.real!r}, {corner.imag!r}] }}\n'
    (tmp_path / "d.toml").write_text(source.replace("[[site]]\n", f"[[site]]\n{art}", 1))
    tiles = Design.load(tmp_path / "d.toml").tessellate()
    size = (8 * abs(corner) * unit + 150, 8 * abs(corner) * unit + 150)
    product = tiles.make(Job(sheet=size, offset=0j))
    lines = shapely.multilinestrings(lines_of(work(product, "engrave")))
    here = shapely.LineString(xy(points + complex(*size) / 2))
    assert float(shapely.distance(lines, dense(here)).max()) < 1e-6
    assert len(lines.geoms) == int((product.pieces.site == 0).sum())


# --- labels, marks, the bar -------------------------------------------------------------------------------------


def label_groups(lines: list[Any], areas: list[Any]) -> list[list[Any]]:
    """The strokes within each area; fails for one that is in none."""
    groups: list[list[Any]] = [[] for _ in areas]
    tree = shapely.STRtree(areas)
    for line in lines:
        inside = tree.query(line, predicate="within").tolist()
        assert inside, "a stroke leaves its piece"
        groups[inside[0]].append(line)
    return groups


def read_number(strokes: list[Any], count: int) -> str:
    """The number from 1 to `count` whose strokes these are, by their shapes."""
    union = shapely.multilinestrings(strokes)
    x0, y0, x1, y1 = union.bounds
    for number in range(1, count + 1):
        wanted = shapely.multilinestrings(lines_of(lettering(str(number), height=1.0)))
        a0, b0, a1, b1 = wanted.bounds
        scale = (y1 - y0) / (b1 - b0)
        placed = shapely.affinity.translate(
            shapely.affinity.scale(wanted, scale, scale, origin=(a0, b0)), x0 - a0, y0 - b0
        )
        if abs((x1 - x0) - scale * (a1 - a0)) < 1e-3 and shapely.hausdorff_distance(placed, union, 0.5) < 1e-2 * scale:
            return str(number)
    raise AssertionError("no number looks like this")


@pytest.mark.parametrize("job", [{}, {"kerf": 0.3, "fit": "clip"}, {"fit": "frame"}])
def test_every_piece_has_its_number_once(job: dict[str, Any]) -> None:
    """Strokes lie inside their pieces; every piece but a frame has one number, and every number is there."""
    tiles = Design.load(EXAMPLES / "pg-wave.toml").tessellate()
    product = tiles.make(Job(sheet=(150.0, 120.0), labels="number", edges="pieces", **job))
    areas = contour_shapes(cuts(product), 1e-3)
    groups = label_groups(lines_of(work(product, "engrave"), 1e-3), areas)
    pieces = int((product.pieces.site >= 0).sum())
    numbers = [read_number(group, pieces) for group in groups if group]
    small = sum(int(note.split()[0]) for note in product.notes if "too small for a label" in note)
    assert len(numbers) == pieces - small
    assert len(set(numbers)) == len(numbers)
    if not small:
        assert sorted(map(int, numbers)) == list(range(1, pieces + 1))
    for group in filter(None, groups):
        bounds = shapely.total_bounds(np.array(group))
        assert 0.3 <= bounds[3] - bounds[1] <= 3.2
    stroke, (x, y) = next(group[0] for group in groups if group), areas[0].exterior.coords[0]
    with pytest.raises(AssertionError, match="leaves its piece"):
        label_groups([shapely.affinity.translate(stroke, x - stroke.centroid.x, y - stroke.centroid.y)], areas)


def test_labels_of_sites_and_small_pieces() -> None:
    """Names where asked; what is too small is counted."""
    tiles = Design.load(EXAMPLES / "p4-mill.toml").tessellate()
    product = tiles.make(Job(sheet=(400.0, 400.0), labels="site", label_height=2.0))
    assert len(work(product, "engrave"))
    tiny = Design.loads(SQUARES.replace("20", "0.3").replace("10", "0.15")).tessellate()
    product = tiny.make(Job(sheet=(1.0, 1.0), labels="number"))
    assert any("too small for a label" in note for note in product.notes)
    assert not len(work(product, "engrave"))


@pytest.mark.parametrize("job", [{"marks": True, "bar": True, "margin": 8.0}, {"bar": True, "margin": 5.0}])
def test_marks_and_the_bar_keep_out_of_the_way(job: dict[str, Any]) -> None:
    """On the page, beside the cuts; the bar is 100 mm long."""
    product = squares().make(Job(sheet=(160.0, 120.0), fit="clip", **job))
    lines = shapely.multilinestrings(lines_of(work(product, "engrave")))
    page = shapely.box(0, 0, 160, 120)
    assert page.contains(lines)
    assert lines.distance(shapely.multilinestrings(lines_of(cuts(product)))) > 0.2
    straight = Counter(
        round(float(abs(b - a)), 9)
        for a, b in zip(work(product, "engrave").start, work(product, "engrave").end, strict=True)
    )
    assert straight[100.0] == 1


def test_the_bar_below_a_single_tile() -> None:
    """Without a sheet the page grows, to tenths of a millimetre with all in the middle."""
    plain, barred = squares().make(Job()), squares().make(Job(bar=True))
    assert barred.drawing.height > plain.drawing.height
    assert barred.drawing.width >= 100.0
    lines = shapely.multilinestrings(lines_of(work(barred, "engrave")))
    assert lines.distance(shapely.multilinestrings(lines_of(cuts(barred)))) > 0.2
    x0, y0, x1, y1 = lines.union(shapely.multilinestrings(lines_of(cuts(barred)))).bounds
    assert (x0, y0) == pytest.approx((barred.drawing.width - x1, barred.drawing.height - y1), abs=1e-9)
    assert -1e-9 < min(x0, y0) <= max(x0, y0) < 0.05
