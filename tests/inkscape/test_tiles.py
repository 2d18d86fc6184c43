"""Tiles of what is selected: those of the command line, in a layer that changes nothing else of the drawing."""

from __future__ import annotations

import gzip
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from helpers.inkscape_drawings import (
    LINE,
    OBJECTS,
    PAGES,
    Page,
    difference,
    edges_of_document,
    edges_of_path,
    paths_of,
    run,
)
from helpers.outlines import CommandLine

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.base.errors import VoronoiTilesError
from voronoi_tiles.formats.reading import read_drawing
from voronoi_tiles.formats.recipe import recipe_of

EXACT_MM = 1e-9
"""How near the tile is to the command line's; millimetres."""

CELL = ("--group=p1", "--cell=numbers", "--side_a=120", "--side_b=110", "--angle=80", "--origin_x=13", "--origin_y=7.5")
DESIGN = {"schema": 1, "group": "p1", "cell": {"a": 120, "b": 110, "angle": 80}}
ORIGIN = 13 + 7.5j

MM = PAGES[0]


def edges_on(page: Page, drawing: bytes) -> Complexes:
    """The edges of the only tile in a drawing, millimetres."""
    (data,) = paths_of(drawing).values()
    return page.user_mm(edges_of_path(data))


def exported(designs: dict[str, dict[str, object]], folder: Path, voronoi_tiles: CommandLine) -> dict[str, Complexes]:
    """The edges of the tiles that the command line makes of designs of one site, on the page."""
    for name, design in designs.items():
        (folder / f"{name}.json").write_text(json.dumps(design), encoding="utf-8")
    files = [f"{name}.json" for name in designs]
    done = voronoi_tiles("export", *files, "-o", "out/", "--format", "json", "-q", cwd=folder)
    assert done.returncode == 0, done.stderr
    found = {}
    for name in designs:
        (tile,) = json.loads((folder / "out" / f"{name}.json").read_text(encoding="utf-8"))["tiles"]
        found[name] = edges_of_document(tile["rings"]) + ORIGIN
    return found


def site(strokes: list[dict[str, Any]]) -> dict[str, Any]:
    """A design in the cell of the tests."""
    return {**DESIGN, "site": [{"strokes": strokes}]}


def from_origin(points: list[list[float]]) -> list[list[float]]:
    """Points of the page from the group's origin."""
    return [[x - ORIGIN.real, y - ORIGIN.imag] for x, y in points]


def alone(name: str, page: Page) -> bytes:
    """A drawing with one object, and with what it is a clone of."""
    return page.svg("\n".join(OBJECTS[one].element for one in dict.fromkeys(("line",) * (name == "clone") + (name,))))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_a_tile_is_that_of_the_command_line(page: Page, tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """For every kind of stroke and every unit, viewBox and transform, from the strokes' points by other sums."""
    names = [name for name, drawn in OBJECTS.items() if drawn.polylines is not None]
    designs = {
        name: site([{kind: from_origin(points)} for one in OBJECTS[name].strokes(page) for kind, points in one.items()])
        for name in names
    }
    expected = exported(designs, tmp_path, voronoi_tiles)
    made = {name: run(alone(name, page), f"--id={name}", *CELL, folder=tmp_path) for name in names}
    far = {name: difference(edges_on(page, made[name]), expected[name]) for name in names}
    assert {name: value for name, value in far.items() if value > EXACT_MM} == {}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_a_tile_is_that_of_the_drawing_as_a_stroke(page: Page, tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """Arcs, circles, ellipses and clones too: as where a design names the drawing, and the object in it."""
    made, designs = {}, {}
    for name in OBJECTS:
        made[name] = run(alone(name, page), f"--id={name}", *CELL, folder=tmp_path)
        (tmp_path / "drawing.svg").rename(tmp_path / f"{name}.svg")
        shapes = read_drawing(tmp_path / f"{name}.svg", element=name).shapes
        corner = complex(*shapes[0].paths.bounds[:2]) - ORIGIN
        designs[name] = site([{"file": f"{name}.svg", "id": name, "translate": [corner.real, corner.imag]}])
    expected = exported(designs, tmp_path, voronoi_tiles)
    far = {name: difference(edges_on(page, made[name]), expected[name]) for name in OBJECTS}
    assert {name: value for name, value in far.items() if value > EXACT_MM} == {}


def test_another_tile_is_seen() -> None:
    """The comparison of edges can fail: by a micrometre, by an edge too many."""
    edges = edges_of_path("M 0 0 L 10 0 Q 12 5 10 10 L 0 10 Z")
    assert difference(edges, edges[::-1, ::-1]) == 0.0
    assert difference(edges, edges_of_path("M 0 0 L 10 0 Q 12 5.001 10 10 L 0 10 Z")) == pytest.approx(0.001)
    assert difference(edges, edges[1:]) == np.inf


def test_nothing_else_of_the_drawing_changes(tmp_path: Path) -> None:
    """Every byte about the layer stays, comments and digits of paths too; the next run puts the same in its place."""
    head = '<path id="odd" d="m1.2345678901234567,2 3.5,1e-7"/><!-- é --><text id="t">a &lt; b/></text>'
    head += '<g id="e"/>'
    drawing = MM.svg(OBJECTS["cubics"].element, head)
    made = run(drawing, "--id=cubics", *CELL, folder=tmp_path)
    at = drawing.rindex(b"</svg>")
    assert made.startswith(drawing[:at])
    assert made.endswith(drawing[at:])
    assert run(made, "--id=cubics", *CELL, folder=tmp_path) == made
    other = run(made, "--id=cubics", *CELL, "--side_a=130", folder=tmp_path)
    assert other != made
    assert run(other, "--id=cubics", *CELL, folder=tmp_path) == made


@pytest.mark.parametrize(
    "moved",
    [
        lambda layer: b'<g id="home" transform="scale(2)">' + layer + b"</g>",
        lambda layer: b'<g id="home" transform="scale(2)">' + layer + b"</g>" + layer.replace(b"voronoi-tiles-", b"x-"),
        lambda layer: re.sub(rb">.*</g>", b"/>", layer, flags=re.DOTALL),
    ],
    ids=["into a group", "twice", "emptied"],
)
def test_a_layer_is_replaced_wherever_it_is(moved: Callable[[bytes], bytes], tmp_path: Path) -> None:
    """Moved into a group, doubled, or emptied by hand: after the next run there is one, where the page's units hold."""
    drawing = MM.svg(OBJECTS["cubics"].element)
    made = run(drawing, "--id=cubics", *CELL, folder=tmp_path)
    at = drawing.rindex(b"</svg>")
    layer = made[at : len(made) - len(drawing) + at]
    again = run(drawing[:at] + moved(layer) + drawing[at:], "--id=cubics", *CELL, folder=tmp_path)
    assert paths_of(again) == paths_of(made)
    assert len(ET.fromstring(again).findall("./*[@{urn:voronoi-tiles:recipe}role]")) == 1


def test_tiles_that_were_moved_to_another_layer_stay(tmp_path: Path) -> None:
    """They are drawings like others then: kept, and no id is there twice."""
    drawing = MM.svg(OBJECTS["cubics"].element, '<g id="kept">KEPT</g>')
    made = run(drawing, "--id=cubics", *CELL, folder=tmp_path)
    path = re.search(rb'<path id="voronoi-tiles-0-0".*?/>', made)
    assert path is not None
    kept = made.replace(path[0], b"").replace(b"KEPT", path[0])
    again = run(kept, "--id=cubics", *CELL, "--side_a=130", folder=tmp_path)
    assert path[0] in again
    ids = [found.get("id") for found in ET.fromstring(again).iter() if found.get("id")]
    assert len(ids) == len(set(ids))
    assert len(paths_of(again)) == 1


@pytest.mark.parametrize("encoding", ["utf-16", "latin-1", "utf-8-sig", "gzip"])
def test_other_encodings_are_kept_or_refused(encoding: str, tmp_path: Path) -> None:
    """Nothing is put into bytes that it does not fit."""
    text = MM.svg(OBJECTS["cubics"].element.replace('id="cubics"', 'id="cubics" inkscape:label="Küche"')).decode()
    drawing = gzip.compress(text.encode())
    if encoding != "gzip":
        drawing = text.replace("UTF-8", encoding.removesuffix("-sig")).encode(encoding)
    if encoding in {"utf-16", "gzip"}:
        with pytest.raises(VoronoiTilesError, match="in another encoding than UTF-8"):
            run(drawing, "--id=cubics", *CELL, folder=tmp_path)
        return
    made = run(drawing, "--id=cubics", *CELL, folder=tmp_path)
    assert made.startswith(drawing[: drawing.rindex(b"</svg>")])
    assert len(paths_of(made)) == 1


def test_each_group_is_a_site(tmp_path: Path) -> None:
    """Named as it is called; what is in no group is one site together; together they fill the cell."""
    body = (
        f'<g id="g1" inkscape:label="bird"><path id="p1" d="M 20 20 L 40 30" {LINE}/></g>'
        f'<g id="g2"><path id="p2" d="M 60 20 L 80 40" {LINE}/><g><circle id="c" cx="70" cy="50" r="4" {LINE}/></g></g>'
        f'<path id="p3" d="M 25 70 L 45 60" {LINE}/><path id="p4" d="M 60 75 l 9 1" {LINE}/>'
        f'<path id="p5" d="M 0 0 l 9 1" {LINE}/>'
    )
    words = [f"--id={name}" for name in ("p4", "g2", "g1", "p3")]
    made = run(MM.svg(body), *words, *CELL, folder=tmp_path)
    found = paths_of(made)
    assert set(found) == {"bird", "g2", "site1"}
    area = 0.0
    for data in found.values():
        for start, control, end in MM.user_mm(edges_of_path(data)).tolist():
            # Of a quadratic curve: the chord's triangle and a third of the control polygon's.
            area += (start.conjugate() * end).imag / 2
            area += ((control - start).conjugate() * (end - start)).imag / -3
    assert area == pytest.approx(120 * 110 * np.sin(np.radians(80)), rel=1e-12)


def test_what_is_in_a_selected_layer_of_strokes_is_one_site(tmp_path: Path) -> None:
    """A layer is a group."""
    body = f'<path id="p1" d="M 20 20 L 40 30" {LINE}/><path id="p2" d="M 60 20 L 80 40" {LINE}/>'
    assert list(paths_of(run(MM.svg(body), "--id=layer1", *CELL, folder=tmp_path))) == ["layer1"]


def test_each_group_in_a_selected_layer_is_a_site(tmp_path: Path) -> None:
    """As where the groups were selected; in layers within it too, and what is in no group is one site of its layer."""
    stroke = f'<path id="%s" d="M %d %d l 15 9" {LINE}/>'
    group = '<g id="%s"><g><path d="M %d 20 l 5 9" style="stroke:#000"/></g></g>'
    inner = f'<g id="inner" inkscape:groupmode="layer">{group % ("g2", 50)}{stroke % ("p2", 80, 30)}</g>'
    mode = 'id="layer1" inkscape:groupmode="layer"'
    drawing = MM.svg(group % ("g1", 20) + stroke % ("p1", 30, 60) + inner).replace(b'id="layer1"', mode.encode())
    found = paths_of(run(drawing, "--id=layer1", *CELL, folder=tmp_path))
    assert list(found) == ["layer1", "g1", "inner", "g2"]
    single = paths_of(run(drawing, *[f"--id={name}" for name in ("g1", "g2", "p1", "p2")], *CELL, folder=tmp_path))
    assert list(single) == ["site1", "g1", "g2"]


def test_only_what_is_selected_counts(tmp_path: Path) -> None:
    """A clone of what is selected is not, nor is what lies beside it."""
    single = run(alone("line", MM), "--id=line", *CELL, folder=tmp_path)
    body = OBJECTS["line"].element + OBJECTS["clone"].element + OBJECTS["rect"].element
    assert paths_of(run(MM.svg(body), "--id=line", *CELL, folder=tmp_path)) == paths_of(single)


def test_texts_and_images_that_are_hidden_are_not_refused(tmp_path: Path) -> None:
    """Nobody sees them: by their own style, by a group's, or in what clips others."""
    hidden = '<text id="t" style="display:none">T</text><g display="none"><image id="i"/></g>'
    hidden += '<clipPath id="k"><text id="u">T</text></clipPath>'
    group = f'<g id="g">{OBJECTS["line"].element}%s</g>'
    expected, made = (run(MM.svg(group % more), "--id=g", *CELL, folder=tmp_path) for more in ("", hidden))
    assert paths_of(made) == paths_of(expected)


def test_lines_of_no_length_are_points(tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """A dot is the stroke of an isolated point."""
    body = f'<g id="g"><path id="p" d="M 40 50 L 40 50" {LINE}/><path id="q" d="M 60 50 L 80 60" {LINE}/></g>'
    made = run(MM.svg(body), "--id=g", *CELL, folder=tmp_path)
    strokes: list[dict[str, Any]] = [{"point": [27, 239.5]}, {"segment": [[47, 239.5], [67, 229.5]]}]
    expected = exported({"dot": site(strokes)}, tmp_path, voronoi_tiles)["dot"]
    assert difference(edges_on(MM, made), expected) <= EXACT_MM


def test_the_layer_holds_its_design(tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """What the tiles were made from, as files of ours do: the command line makes the same of it."""
    made = run(MM.svg(OBJECTS["cubics"].element), "--id=cubics", *CELL, folder=tmp_path)
    design = json.loads(recipe_of(made)["design"])
    assert difference(edges_on(MM, made), exported({"it": design}, tmp_path, voronoi_tiles)["it"]) <= EXACT_MM


def test_what_is_not_followed_is_said_in_the_layer(tmp_path: Path) -> None:
    """Clones, dashes, open paths that are filled: sentences in its description."""
    body = OBJECTS["line"].element + OBJECTS["clone"].element
    body += '<path id="dashed" d="M 60 9 l 9 30 l 3 -9" style="fill:#c00;stroke:#000;stroke-dasharray:1,2"/>'
    made = run(MM.svg(body), "--id=clone", "--id=dashed", *CELL, folder=tmp_path)
    note = ET.fromstring(made).find(".//{http://www.w3.org/2000/svg}desc")
    assert note is not None
    assert note.text == (
        "taken as what they show: clones (1). not followed: stroke-dasharray (1). the fill of an open path is closed "
        "by a straight line; give lines a fill of none."
    )


@pytest.mark.parametrize(
    ("body", "ids", "message"),
    [
        ("", [], "nothing is selected. Select the strokes of a tile: paths, shapes, or groups."),
        ("", ["none"], "what is selected is not drawn: none. Select paths, shapes, or groups of them."),
        ('<defs><path id="p" d="M 0 0 L 9 9"/></defs>', ["p"], "what is selected is not drawn: p. Select paths"),
        (
            '<text id="t" inkscape:label="Hi">Hi</text>',
            ["t"],
            'the text "Hi" is no path. Convert it by Path > Object to',
        ),
        (
            '<g id="g"><g><image id="i" href="a.png"/></g></g>',
            ["g"],
            'the image "i" is no path. Trace it by Path > Trace',
        ),
        ('<use id="u" href="#t"/><text id="t">Hi</text>', ["u"], "a clone in the selection shows a text. Convert it"),
        ('<use id="u" href="#gone"/>', ["u"], "the selection has a use of nothing. Unlink the clone, or leave it out"),
        (
            '<path id="p" d="M 0 0 L 9 9" style="fill:none"/>',
            ["p"],
            "nothing of the selection is drawn. Give it a stroke",
        ),
        ('<path id="p" d="M 0 0 L 9 9 X 3"/>', ["p"], "the drawing, line 4, d: "),
        ('<rect id="r" inkscape:label="cell" width="9" height="9"/>', ["r"], "only the cell is selected. Select the"),
    ],
)
def test_what_makes_no_tile_is_refused(body: str, ids: list[str], message: str, tmp_path: Path) -> None:
    """A sentence that names the object, or the place on the page, and says what to do."""
    with pytest.raises(VoronoiTilesError) as refused:
        run(MM.svg(body), *[f"--id={name}" for name in ids], *CELL, folder=tmp_path)
    assert str(refused.value).startswith(message), refused.value


def test_tiles_are_no_strokes(tmp_path: Path) -> None:
    """The tiles of an earlier run are left out where all is selected, and refused where nothing else is."""
    made = run(MM.svg(OBJECTS["line"].element), "--id=line", *CELL, folder=tmp_path)
    all_of_it = ("--id=line", "--id=voronoi-tiles-0-0", "--id=voronoi-tiles")
    assert run(made, *all_of_it, *CELL, folder=tmp_path) == made
    with pytest.raises(VoronoiTilesError, match="what is selected are tiles that were made before"):
        run(made, "--id=voronoi-tiles-0-0", *CELL, folder=tmp_path)


def test_the_place_where_copies_touch_is_on_the_page(tmp_path: Path) -> None:
    """In millimetres from the upper left corner of the page, as Inkscape's rulers have it."""
    body = f'<path id="p" d="M 30 90 L 30 130" {LINE}/>'
    words = ("--group=p1", "--cell=numbers", "--side_a=80", "--side_b=40", "--angle=90", "--origin_x=3", "--origin_y=5")
    with pytest.raises(VoronoiTilesError) as refused:
        run(MM.svg(body), "--id=p", *words, folder=tmp_path)
    found = re.search(r", ([\d.]+) mm to the right and ([\d.]+) mm down from", str(refused.value))
    assert found is not None
    assert float(found[1]) == pytest.approx(30, abs=0.01)
    down = float(found[2])
    assert min(abs(down - 90), abs(down - 130)) < 0.1
