"""The cell of what is selected: a rectangle's, the numbers of the dialog, or one that is fitted and drawn."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from helpers.inkscape_drawings import LINE, PAGES, Page, difference, edges_of_path, paths_of, run

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import VoronoiTilesError
from voronoi_tiles.formats.svg.reader import svg_tree
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.inkscape.dialog_fields import TilesFields
from voronoi_tiles.inkscape.selected_strokes import selected
from voronoi_tiles.inkscape.selection_design import design_of

MM = PAGES[0]

CURVE = f'<path id="p" d="M 52 60 C 60 48 66 70 76 58" {LINE}/>'

SMALL = 'width="5" height="5"'


def rectangle(where: str, label: str = "cell", name: str = "r") -> str:
    """A rectangle with a label."""
    return f'<rect id="{name}" inkscape:label="{label}" {LINE} {where}/>'


def tile(drawing: bytes, page: Page, *words: str, folder: Path) -> Complexes:
    """The edges of the tile of the curve, millimetres."""
    (data,) = paths_of(run(drawing, "--id=p", *words, folder=folder)).values()
    return page.user_mm(edges_of_path(data))


@pytest.mark.parametrize(
    ("group", "where", "numbers"),
    [
        ("p4", 'x="40" y="20" width="60" height="60"', ("--side_a=60", "--origin_x=40", "--origin_y=217")),
        ("p4", 'x="40" y="20" width="60" height="60.00001"', ("--side_a=60", "--origin_x=40", "--origin_y=216.99999")),
        (
            "pgg",
            'x="40" y="20" width="80" height="60"',
            ("--side_a=80", "--side_b=60", "--origin_x=40", "--origin_y=217"),
        ),
        ("p3", 'x="40" y="20" width="60" height="9"', ("--side_a=60", "--origin_x=40", "--origin_y=268")),
        (
            "p2",
            'width="80" height="60" transform="matrix(1 0 .3 1 40 20)"',
            (
                "--side_a=80",
                f"--side_b={60 * np.hypot(1, 0.3)}",
                f"--angle={90 + np.degrees(np.arctan(0.3))}",
                "--origin_x=58",
                "--origin_y=217",
            ),
        ),
        (
            "pm",
            'x="40" y="20" width="80" height="60" transform="matrix(-1 0 0 1 160 0)"',
            ("--side_a=80", "--side_b=60", "--origin_x=40", "--origin_y=217"),
        ),
    ],
)
def test_a_rectangle_is_the_cell(group: str, where: str, numbers: tuple[str, ...], tmp_path: Path) -> None:
    """As where its numbers stand in the dialog, its lower left corner the origin."""
    found = tile(MM.svg(CURVE + rectangle(where)), MM, f"--group={group}", folder=tmp_path)
    same = tile(MM.svg(CURVE), MM, f"--group={group}", "--cell=numbers", *numbers, folder=tmp_path)
    assert difference(found, same) < 1e-4 if "00001" in where else difference(found, same) < 1e-9


@pytest.mark.parametrize("group", ["p1", "p4", "pgg", "p6"])
def test_the_cell_turns_with_its_rectangle(group: str, tmp_path: Path) -> None:
    """A drawing that is turned as a whole has its tile turned with it."""
    where = f'x="40" y="40" width="70" height="{70 if group == "p4" else 64}"'
    upright = tile(MM.svg(CURVE + rectangle(where)), MM, f"--group={group}", folder=tmp_path)
    body = f'<g transform="rotate(31 60 70)">{CURVE}{rectangle(where)}</g>'
    turned = tile(MM.svg(body), MM, f"--group={group}", folder=tmp_path)
    about, by = 60 + (297 - 70) * 1j, np.exp(-1j * np.radians(31))
    assert difference(turned, about + by * (upright - about)) < 1e-9


@pytest.mark.parametrize(
    ("group", "page"),
    [("p1", MM), ("pgg", PAGES[1]), *(("p3", page) for page in PAGES)],
    ids=lambda one: getattr(one, "name", one),
)
def test_a_fitted_cell_is_drawn_and_taken_again(group: str, page: Page, tmp_path: Path) -> None:
    """Copies keep apart in it; the next run takes it from the rectangle, makes the same tile, and no second cell."""
    body = f'<path id="p" d="M 2 3 C 8 -4 15 14 24 6" {LINE}/>'
    made = run(page.svg(body), "--id=p", f"--group={group}", folder=tmp_path)
    theirs = re.sub(rb' vt:fitted="[^"]*"', b"", made)
    assert theirs != made
    again = run(theirs, "--id=p", f"--group={group}", "--cell=numbers", folder=tmp_path)
    first, second = (page.user_mm(edges_of_path(*paths_of(one).values())) for one in (made, again))
    assert difference(first, second) < 1e-9
    assert made.count(b'inkscape:label="cell"') == again.count(b'inkscape:label="cell"') == 2  # a layer, a rectangle


def test_numbers_go_before_a_fitted_cell_and_not_before_a_drawn_one(tmp_path: Path) -> None:
    """The drawing is then as if it had never been fitted; what is drawn counts, which the layer's description says."""
    numbers = ("--cell=numbers", "--side_a=90", "--side_b=70", "--origin_x=20")
    fitted = run(MM.svg(CURVE), "--id=p", "--group=p2", folder=tmp_path)
    fresh = run(MM.svg(CURVE), "--id=p", "--group=p2", *numbers, folder=tmp_path)
    assert run(fitted, "--id=p", "--group=p2", *numbers, folder=tmp_path) == fresh
    assert b"were not read" not in fresh
    drawn = MM.svg(CURVE + rectangle('x="40" y="40" width="70" height="64"'))
    with_numbers, without = (run(drawn, "--id=p", "--group=p2", *more, folder=tmp_path) for more in (numbers, ()))
    first, second = (edges_of_path(*paths_of(one).values()) for one in (with_numbers, without))
    assert difference(first, second) == 0.0
    assert b"the numbers of the dialog were not read" in with_numbers
    assert b"were not read" not in without


def test_groups_whose_tile_is_a_polygon_are_said_to_be_such(tmp_path: Path) -> None:
    """In the layer's description, where one site is selected; of two the edge between them follows the drawing."""
    group = f"<g id='g1'><path d='M 50 50 L 60 52' {LINE}/></g><g id='g2'><path d='M 52 60 L 60 62' {LINE}/></g>"
    words = ("--cell=numbers", "--side_a=150", "--side_b=160", "--origin_y=150")
    for ids, name, said in ((["g1"], "pmm", True), (["g1", "g2"], "pmm", False), (["g1"], "pgg", False)):
        made = run(MM.svg(group), *(f"--id={one}" for one in ids), f"--group={name}", *words, folder=tmp_path)
        assert (b"polygon between the mirrors" in made) == said


@pytest.mark.parametrize("page", [MM, PAGES[3]], ids=lambda page: page.name)
def test_a_fitted_cell_that_nobody_has_moved_is_fitted_anew(page: Page, tmp_path: Path) -> None:
    """For another group, and to other strokes: the drawing is as if it had been the first run, hidden layer or not."""
    body = f'<path id="p" d="M 2 3 C 8 -4 15 14 24 6" {LINE}/>'
    for group, other in (("p4", "p3"), ("p3", "pmm"), ("pmm", "p4")):
        first = run(page.svg(body), "--id=p", f"--group={group}", folder=tmp_path)
        assert run(first, "--id=p", f"--group={group}", folder=tmp_path) == first
        fresh = run(page.svg(body), "--id=p", f"--group={other}", folder=tmp_path)
        again = run(first, "--id=p", f"--group={other}", folder=tmp_path)
        assert again == fresh
        hidden = first.replace(b'id="voronoi-cell"', b'style="display:none" id="voronoi-cell"')
        assert run(hidden, "--id=p", "--id=voronoi-cell-0", f"--group={other}", folder=tmp_path) == fresh
    with pytest.raises(VoronoiTilesError, match="only the cell is selected"):
        run(first, "--id=voronoi-cell-0", "--group=pmm", folder=tmp_path)
    longer = page.svg(body.replace("24 6", "34 16"))
    moved = first.replace(b"24 6", b"34 16")
    assert run(moved, "--id=p", "--group=pmm", folder=tmp_path) == run(longer, "--id=p", "--group=pmm", folder=tmp_path)


@pytest.mark.parametrize(
    "change",
    [
        lambda cell: re.sub(rb' width="([\d.]+)"', lambda found: b' width="%.9f"' % (float(found[1]) * 1.2), cell),
        lambda cell: cell.replace(b'id="voronoi-cell"', b'transform="translate(1)" id="voronoi-cell"'),
        lambda cell: cell.replace(b"<rect", b'<rect transform="rotate(1)"'),
        lambda cell: cell.replace(b"</g>", b'<path id="mine" d="M 0 0 L 9 9"/></g>'),
    ],
    ids=["resized", "its layer moved", "turned", "drawn beside"],
)
def test_a_fitted_cell_that_somebody_has_changed_stays(change: Callable[[bytes], bytes], tmp_path: Path) -> None:
    """It is theirs now, and so is what else is in its layer."""
    first = run(MM.svg(CURVE), "--id=p", "--group=pgg", folder=tmp_path)
    found = re.search(rb'<g [^>]*id="voronoi-cell".*?</g>', first, re.DOTALL)
    assert found is not None
    theirs = change(found[0])
    assert theirs != found[0]
    made = run(first.replace(found[0], theirs), "--id=p", "--group=pgg", folder=tmp_path)
    assert theirs in made
    assert made.count(b"<rect") == 1
    before, after = (edges_of_path(*paths_of(one).values()) for one in (first, made))
    assert (difference(before, after) < 1e-9) == (b"mine" in theirs)


def test_what_is_drawn_in_the_layer_of_a_cell_that_is_gone_stays(tmp_path: Path) -> None:
    """A new cell has a layer of its own then."""
    first = run(MM.svg(CURVE), "--id=p", folder=tmp_path)
    mine = re.sub(rb"<rect.*?/>", b'<path id="mine" d="M 0 0 L 9 9"/>', first)
    made = run(mine, "--id=p", folder=tmp_path)
    assert b'<path id="mine" d="M 0 0 L 9 9"/></g>' in made.replace(b"\n", b"")
    assert made.count(b"<rect") == 1
    ids = [found.get("id") for found in ET.fromstring(made).iter() if found.get("id")]
    assert len(ids) == len(set(ids))


def test_every_group_takes_what_it_leaves_free_of_the_numbers() -> None:
    """Of the dialog's three numbers those that the group's cell has; the others are passed over."""
    root, _ = svg_tree(MM.svg(CURVE), "t")
    selection = selected(root, "t", ["p"])
    for name, group in GROUPS.items():
        fields = TilesFields(group=name, cell="numbers", side_a=300.0, side_b=200.0, angle=80.0)
        lattice = design_of(selection, fields).design.lattice
        assert abs(lattice.a) == 300.0
        assert abs(lattice.b) == pytest.approx(300.0 if group.fixes_b else 200.0), name
        angle = np.degrees(np.angle(lattice.b / lattice.a))
        assert angle == pytest.approx(80.0 if group.fixed_angle is None else group.fixed_angle), name


def test_the_rectangle_is_no_stroke(tmp_path: Path) -> None:
    """Selected or not; in a group that is selected, too."""
    cell = rectangle('x="40" y="40" width="70" height="70"')
    made = paths_of(run(MM.svg(f'<g id="g">{CURVE}</g>{cell}'), "--id=g", folder=tmp_path))
    assert paths_of(run(MM.svg(f'<g id="g">{CURVE}</g>{cell}'), "--id=g", "--id=r", folder=tmp_path)) == made
    assert paths_of(run(MM.svg(f'<g id="g">{CURVE}{cell}</g>'), "--id=g", folder=tmp_path)) == made


def test_one_of_several_rectangles_is_selected(tmp_path: Path) -> None:
    """The one that is selected is meant; without a selection they are named. One that is hidden is not meant."""
    one = rectangle('x="40" y="40" width="70" height="70"', "Cell ")
    other = rectangle('x="40" y="40" width="80" height="80"', name="s")
    alone = tile(MM.svg(CURVE + one), MM, folder=tmp_path)
    assert difference(tile(MM.svg(CURVE + one + other), MM, "--id=r", folder=tmp_path), alone) == 0.0
    hidden = f'<g style="display:none">{rectangle(SMALL, name="s")}</g>'
    assert difference(tile(MM.svg(CURVE + one + hidden), MM, folder=tmp_path), alone) == 0.0
    for body in (one + other, hidden + hidden.replace('"s"', '"r"')):
        with pytest.raises(
            VoronoiTilesError, match=r'2 rectangles have the label "cell": r, s. Select the one that is meant'
        ):
            run(MM.svg(CURVE + body), "--id=p", folder=tmp_path)


@pytest.mark.parametrize(
    ("group", "where", "message"),
    [
        ("p4", 'width="60" height="50"', 'the rectangle "cell" is 60 x 50 mm, and the cell of p4 is a square'),
        ("pm", 'width="60" height="50" transform="skewX(9)"', "with 99 degrees, and pm needs a right angle"),
        ("p6", 'width="60" height="50" transform="skewX(9)"', "and p6 needs 120 degrees between equal sides"),
        ("p1", 'width="60" height="50" rx="3"', 'the rectangle "cell" has rounded corners. Make them sharp'),
        ("p1", 'width="60" height="0"', 'the rectangle "cell" has no size'),
        ("p1", 'width="60" height="50" transform="matrix(1 1 1 1 0 0)"', 'the rectangle "cell" has no size'),
        ("p1", 'width="1e-9" height="1e-9"', 'the rectangle "cell" has no size'),
    ],
)
def test_a_rectangle_that_is_no_cell_of_the_group_is_refused(
    group: str, where: str, message: str, tmp_path: Path
) -> None:
    """With its sides and what the group needs."""
    with pytest.raises(VoronoiTilesError, match=re.escape(message)):
        run(MM.svg(CURVE + rectangle(where)), "--id=p", f"--group={group}", folder=tmp_path)


@pytest.mark.parametrize(
    ("around", "style"),
    [
        ('style="display:none"', ""),
        ('display="none"', "stroke:none;"),
        ("", "opacity:0;"),
        ('visibility="hidden" transform="translate(3 4)"', ""),
    ],
)
def test_a_cell_that_is_hidden_counts_all_the_same(around: str, style: str, tmp_path: Path) -> None:
    """As its layer is once it is in the way: the tile does not change with what is seen."""
    cell = rectangle('x="40" y="40" width="70" height="70"')
    hidden = f"<g {around}>{cell.replace('fill:none', f'{style}fill:none')}</g>"
    shown = f"<g {around[around.find('transform') :] if 'transform' in around else ''}>{cell}</g>"
    one, other = (tile(MM.svg(CURVE + body), MM, folder=tmp_path) for body in (hidden, shown))
    assert difference(one, other) == 0.0


def test_lines_have_their_width(tmp_path: Path) -> None:
    """In millimetres, whatever the page's units."""
    for page in PAGES[:4]:
        body = f'<path id="p" d="M 2 3 C 8 -4 15 14 24 6" {LINE}/>'
        made = run(
            page.svg(body),
            "--id=p",
            "--cell=numbers",
            "--side_a=120",
            "--line_width=0.4",
            "--group=p1",
            "--side_b=110",
            folder=tmp_path,
        )
        (group,) = ET.fromstring(made).iterfind(".//*[@id='voronoi-tiles-0']")
        width = float(group.get("style", "").rpartition(":")[2])
        assert abs(page.user_mm(np.array([width + 0j])) - page.user_mm(np.array([0j]))) == pytest.approx(0.4)
