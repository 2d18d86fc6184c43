"""Places for drawings: copies keep well apart, in all groups, whatever is drawn."""

from __future__ import annotations

import itertools
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

import voronoi_tiles as vt
from voronoi_tiles.designs.placing import CLEARANCE
from voronoi_tiles.designs.proposals import drawing_text, placed, placed_text
from voronoi_tiles.groups.wallpaper import GROUPS

LEAST = 0.8 * CLEARANCE
"""The pictures have 96 pixels for the diameter, and a place is rounded: what is left of the clearance, at the least."""

ENCLOSED = ("pmm", "p4m", "p3m1", "p6m")

SHAPES = {
    "leaf": ("path", "M10 50 C 10 20 40 5 70 8 C 72 35 45 55 10 50 Z"),
    "squiggle": ("path", "M5 30 C 15 0 25 60 35 25 S 50 5 55 40"),
    "letter": ("filled", "M5 65 L 20 5 H 30 L 45 65 H 36 L 33 50 H 17 L 14 65 Z M 19 42 H 31 L 25 18 Z"),
    "spiral": ("path", "M30 30 C 30 25 38 25 38 32 C 38 42 22 42 22 30 C 22 15 46 15 46 32 C 46 52 14 52 14 30"),
    "parts": ("path", "M3 8 a 5 5 0 1 0 10 0 a 5 5 0 1 0 -10 0 Z M44 12 h 12 v 8 Z M10 50 Q 30 30 55 55"),
    "tall": ("path", "M10 5 C 20 60 0 120 10 195"),
    "line": ("path", "M5 5 H 195"),
}


def svg(data: str, size: float = 1.0, kind: str = "path") -> str:
    """A drawing of path data, its user unit being so many millimetres."""
    paint = 'fill="black" fill-rule="evenodd"' if kind == "filled" else 'fill="none" stroke="black"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{200 * size}mm" height="{200 * size}mm" viewBox="0 0 200 200">'
        f'<path d="{data}" {paint}/></svg>'
    )


def lines(ends: np.ndarray) -> shapely.Geometry:
    """Segments, complex (n, 2), as one geometry."""
    return shapely.multilinestrings(shapely.linestrings(np.stack((ends.real, ends.imag), axis=-1)))


def clearance(design: vt.Design) -> tuple[float, float]:
    """The least distance between the strokes and their copies, and the longer side of their box."""
    ends = np.concatenate([site.ends for site in design.noded])
    own = lines(ends)
    box = own.bounds
    size = max(box[2] - box[0], box[3] - box[1])
    lattice = design.lattice
    reach = 3 * size / min(abs(lattice.a), abs(lattice.b), lattice.det / max(abs(lattice.a), abs(lattice.b)))
    around = range(-math.ceil(reach) - 1, math.ceil(reach) + 2)
    middle = complex(box[0] + box[2], box[1] + box[3]) / 2
    least = math.inf
    for operation in design.group.operations:
        base = lattice.isometry(operation)
        x, y = lattice.fractional(middle - base(middle))
        for i, j in itertools.product(around, around):
            isometry = lattice.isometry(operation.translated(round(x) + i, round(y) + j))
            same = isometry == (1.0, 0.0, False)
            if not same and abs(isometry(middle) - middle) <= 2.5 * size:
                least = min(least, shapely.distance(own, lines(isometry(ends))))
    return least, size


def proposed(group: str, file: Path) -> vt.Tiling:
    """The tiling of what is proposed for a drawing, after it has been looked at."""
    text, _ = drawing_text(group, str(file), str(file.parent / "new.toml"))
    assert tomllib.loads(text)["site"][0]["strokes"] == [{"file": file.name}]
    design = vt.Design.loads(text, folder=file.parent)
    least, size = clearance(design)
    assert least >= LEAST * size
    middle = np.mean([design.noded[0].nodes.real.min(), design.noded[0].nodes.real.max()])
    assert abs(middle) < 3 * (abs(design.lattice.a) + abs(design.lattice.b))
    tiling = design.tessellate()
    assert len(tiling[0].to_shapely(accuracy=size / 100).interiors) == 0  # in one part, without a hole
    return tiling


@settings(max_examples=3, deadline=None)
@given(
    group=st.sampled_from(sorted(GROUPS)), name=st.sampled_from(sorted(SHAPES)), size=st.sampled_from([1.0, 0.002, 90])
)
def test_a_drawing_gets_a_place_in_every_group(
    group: str, name: str, size: float, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Closed, open, tall, tiny, huge, of many parts: copies keep apart, and the tile is in one part."""
    kind, data = SHAPES[name]
    file = tmp_path_factory.mktemp("place") / "leaf.svg"
    file.write_text(svg(data, size, kind))
    proposed(group, file)


@pytest.mark.slow
@settings(max_examples=12, deadline=None)
@given(
    group=st.sampled_from(sorted(GROUPS)),
    points=st.lists(st.tuples(st.integers(0, 200), st.integers(0, 200)), min_size=3, max_size=9, unique=True),
    letters=st.lists(st.sampled_from("LLLQM"), min_size=8, max_size=8),
    closed=st.booleans(),
)
def test_random_drawings_get_places_in_all_groups(
    group: str,
    points: list[tuple[int, int]],
    letters: list[str],
    closed: bool,
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    """Polygons, open lines and several parts, as they come; in groups without mirrors the tile follows the drawing."""
    words = [f"M {points[0][0]} {points[0][1]}", "L {} {}".format(*points[1])]
    for (x, y), (u, v), letter in zip(points[2:], points[1:], letters, strict=False):
        words.append(f"Q {u + 20} {v} {x} {y}" if letter == "Q" else f"{letter} {x} {y}")
    last = "" if words[-1].startswith("M") else "Z" * closed
    file = tmp_path_factory.mktemp("place") / "any.svg"
    file.write_text(svg(" ".join([*words, last])))
    tiling = proposed(group, file)
    if group not in ENCLOSED:
        # The border is near the strokes: a tile is not much larger than the drawing's hull with a rim.
        ends = tiling.design.noded[0].ends
        hull = shapely.MultiPoint(np.stack((ends.real, ends.imag), axis=-1).reshape(-1, 2)).convex_hull
        _, size = clearance(tiling.design)
        assert tiling[0].area < 3.5 * hull.buffer(0.25 * size).area


def test_a_place_is_the_same_every_time(tmp_path: Path) -> None:
    """Nothing is left to chance; the numbers are short."""
    (tmp_path / "leaf.svg").write_text(svg(SHAPES["leaf"][1]))
    texts = {drawing_text("p3", str(tmp_path / "leaf.svg"), str(tmp_path / "a.toml"))[0] for _ in range(2)}
    assert len(texts) == 1
    table = tomllib.loads(texts.pop())
    for number in (table["cell"]["a"], *table["site"][0]["translate"]):
        assert len(repr(number).strip("-").replace(".", "")) <= 4


def test_touching_strokes_get_a_place(tmp_path: Path) -> None:
    """Strokes that touch their copies, of two sites that cross each other, keep apart; nothing else has changed."""
    design = vt.Design(
        "p4",
        60,
        [
            vt.Site([vt.segment(-9 + 1j, 25 + 4j)], name="bar", tolerance=0.02, rotate=30),
            vt.Site([vt.catmull_rom([0, 9 + 5j, 22j])], name="bow", art="face.svg"),
        ],
        units="cm",
        scale=1.5,
    )
    with pytest.raises(vt.TouchingCopiesError):
        design.tessellate()
    design.save(tmp_path / "touching.toml")
    text, notes = placed_text("p31m", str(tmp_path / "touching.toml"))
    assert notes == ()
    (tmp_path / "placed.toml").write_text(text)
    made = vt.Design.load(tmp_path / "placed.toml")
    tiling = made.tessellate()
    assert [tile.name for tile in tiling] == ["bar", "bow"]
    assert (made.group.name, made.units, made.scale) == ("p31m", "cm", 1.0)
    assert [site.strokes for site in made.sites] == [site.strokes for site in design.sites]
    assert [site.tolerance for site in made.sites] == [0.02, None]
    for before, after in zip(design.noded, made.noded, strict=True):
        shift = after.nodes - before.nodes
        assert np.abs(shift - shift[0]).max() < 1e-11
    art = made.art[1]
    assert art is not None
    assert art.placement.scale == 1.5
    least, size = clearance(made)
    assert least >= LEAST * size
    apart = shapely.distance(*(shapely.LineString(tile.site.elements.reshape(-1, 2)) for tile in tiling))
    assert apart >= 0.05 * size


def test_a_point_gets_a_place() -> None:
    """It has no size, and any cell will do."""
    assert placed(vt.Design("p4", 60, vt.Site([vt.point(0)])), "p3").tessellate()[0].area > 0


@pytest.mark.parametrize("size", [1e-50, 1e-11])
def test_strokes_too_small_for_any_cell_are_refused(size: float) -> None:
    """With a sentence on the strokes, for there is no cell to speak of."""
    with pytest.raises(vt.DesignError, match="the strokes are smaller than 1e-09"):
        placed(vt.Site([vt.segment(0j, size)]), "p3")


def test_a_drawing_that_no_site_can_be_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is wrong with a drawing, and not with a design or a stroke that nobody has written."""
    monkeypatch.setattr("voronoi_tiles.base.box_join.PAIRS_MAX", 50)
    (tmp_path / "hatch.svg").write_text(svg("".join(f"M0 {k}H100M{k} 0V100" for k in range(20))))
    with pytest.raises(vt.DesignError) as caught:
        drawing_text("p3", str(tmp_path / "hatch.svg"))
    assert str(caught.value).startswith(f"{tmp_path / 'hatch.svg'}: the strokes cross")
