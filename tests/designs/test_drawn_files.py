"""Strokes that are drawings: SVG and DXF files beside the design."""

from __future__ import annotations

import html
import json
import os
from pathlib import Path

import ezdxf
import numpy as np
import pytest
import svgpathtools
from hypothesis import given, settings
from hypothesis import strategies as st

import voronoi_tiles as vt

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
PAGE = f'{HEAD} width="100mm" height="80mm" viewBox="0 0 100 80">'
LAYERS = f"""{PAGE}
<g inkscape:groupmode="layer" inkscape:label="leaf">
<path id="rim" d="M 20 60 H 50 V 30 Z" stroke="#000000" fill="none"/></g>
<g inkscape:groupmode="layer" inkscape:label="Guide"><path d="M 0 0 H 90" stroke="#00ff00" fill="none"/></g>
<path id="vein" d="M 10 70 L 60 20" stroke="#ff0000" fill="none"/>
<text x="5" y="5">leaf</text>
</svg>"""


def write(folder: Path, name: str, text: str) -> Path:
    """A file in a folder."""
    (folder / name).write_text(text)
    return folder / name


def of(folder: Path, *strokes: vt.Stroke, **more: object) -> vt.Design:
    """A design in p1 with a cell that holds everything."""
    return vt.Design("p1", (900, 900, 90), vt.Site(strokes, name="leaf"), folder=folder, **more)  # type: ignore[arg-type]


def box(design: vt.Design) -> list[float]:
    """The bounding box of the first site."""
    nodes = design.noded[0].nodes
    return [nodes.real.min(), nodes.imag.min(), nodes.real.max(), nodes.imag.max()]


NUMBERS = st.integers(0, 400).map(lambda n: n / 8)


@settings(max_examples=25, deadline=None)
@given(points=st.lists(st.tuples(NUMBERS, NUMBERS), min_size=8, max_size=8, unique=True), closed=st.booleans())
def test_a_drawing_is_its_path_upside_up(
    points: list[tuple[float, float]], closed: bool, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """Lines, curves and arcs are those written out by hand, y turned up, the lower left corner at the origin."""
    folder = tmp_path_factory.mktemp("drawing")

    def data(up: bool) -> str:
        p = [f"{x:g} {80 - y if up else y:g}" for x, y in points]
        end = "Z" if closed else ""
        return f"M {p[0]} L {p[1]} C {p[2]} {p[3]} {p[4]} Q {p[5]} {p[6]} A 30 22 0 0 {int(up)} {p[7]} {end}"

    write(folder, "leaf.svg", f'{PAGE}<path d="{data(up=False)}" stroke="black" fill="none"/></svg>')
    drawn = of(folder, vt.drawing("leaf.svg"), units="cm")
    left, _, bottom, _ = svgpathtools.parse_path(data(up=True)).bbox()
    by_hand = of(folder, vt.path(data(up=True), translate=(-left, -bottom)), units="mm")
    assert len(drawn.noded[0].nodes) > 1
    assert drawn.notes == ()
    # Flattened within the same tolerance, at the same size, in other units.
    for a, b in ((drawn.noded[0].nodes * 10, by_hand.noded[0]), (by_hand.noded[0].nodes, drawn.noded[0])):
        scale = 0.1 if b is drawn.noded[0] else 1.0
        ends = b.ends / scale
        assert max(np.abs(_nearest(z, ends) - z) for z in a) < 0.03
    assert np.allclose(np.array(box(drawn)) * 10, box(by_hand), atol=0.02)


def _nearest(z: complex, ends: np.ndarray) -> complex:
    """The point of segments that is nearest to a point."""
    start, along = ends[:, 0], ends[:, 1] - ends[:, 0]
    with np.errstate(invalid="ignore"):
        t = np.clip(np.nan_to_num(((z - start) * along.conj()).real / np.abs(along) ** 2), 0.0, 1.0)
    feet = start + t * along
    found: complex = feet[np.abs(feet - z).argmin()]
    return found


def test_the_recipe_needs_no_drawing(tmp_path: Path) -> None:
    """It has the path in the place of the file: the same tiles, bit for bit, when the drawing is gone."""
    write(tmp_path, "leaf.svg", LAYERS)
    design = of(tmp_path, vt.drawing("leaf.svg", rotate=20, mirror=True), scale=1.25)
    outlines = design.tessellate().json()
    design.tessellate().export(tmp_path / "tile.svg")
    (tmp_path / "leaf.svg").unlink()
    assert "leaf.svg" not in design.source
    again = vt.Design.loads(design.source)
    assert again.tessellate().json() == outlines
    assert again == design
    assert hash(again) == hash(design)
    assert design.source in html.unescape((tmp_path / "tile.svg").read_text())


def test_what_the_drawing_holds_counts(tmp_path: Path) -> None:
    """Designs are equal where their drawings hold the same, wherever they are."""
    for name, end in (("a.svg", 60), ("b.svg", 60), ("c.svg", 61)):
        write(tmp_path, name, f'{PAGE}<path d="M 10 70 L {end} 20" stroke="black"/></svg>')
    a, b, c = (of(tmp_path, vt.drawing(f"{name}.svg")) for name in "abc")
    assert a == b != c
    assert hash(a) == hash(b)
    assert a.sites[0] != b.sites[0]
    write(tmp_path, "a.svg", (tmp_path / "c.svg").read_text())
    assert a == b
    assert a.replace(folder=tmp_path) == c


def test_saving_elsewhere_finds_the_drawing(tmp_path: Path) -> None:
    """Names are relative to the file that names them; what is read is not overwritten."""
    (tmp_path / "drawings").mkdir()
    (tmp_path / "designs").mkdir()
    write(tmp_path / "drawings", "leaf.svg", LAYERS)
    design = of(tmp_path, vt.drawing("drawings/leaf.svg", id="rim"))
    for name in ("designs/leaf.toml", "designs/leaf.json", "here.toml"):
        design.save(tmp_path / name)
        again = vt.Design.load(tmp_path / name)
        assert again == design
        assert "leaf.svg" in again.to_toml()
        assert [Path(file).resolve() for file in again.files] == [tmp_path / name, tmp_path / "drawings/leaf.svg"]
    with pytest.raises(vt.OutputError, match=r"leaf\.svg"):
        design.tessellate().export(tmp_path / "drawings/leaf.svg")


@pytest.mark.parametrize(
    ("chosen", "expected"),
    [
        ({}, [0, 0, 50, 50]),
        ({"layer": "leaf"}, [0, 0, 30, 30]),
        ({"layer": "#ff0000"}, [0, 0, 50, 50]),
        ({"layer": "Guide"}, [0, 0, 90, 0]),
        ({"id": "rim"}, [0, 0, 30, 30]),
        ({"id": "vein", "scale": 2}, [0, 0, 100, 100]),
    ],
)
def test_a_part_of_a_drawing(tmp_path: Path, chosen: dict[str, str], expected: list[float]) -> None:
    """A layer, a colour or an object; the corner is that of what is chosen; guides only when they are asked for."""
    write(tmp_path, "leaf.svg", LAYERS)
    assert box(of(tmp_path, vt.drawing("leaf.svg", **chosen))) == pytest.approx(expected, abs=1e-12)  # type: ignore[arg-type]


def test_dxf_files_are_drawings_too(tmp_path: Path) -> None:
    """In their units, arcs within the tolerance; an entity by its handle, a layer by its name."""
    document = ezdxf.new(units=ezdxf.units.CM)
    space = document.modelspace()
    line = space.add_line((2, 2), (5, 2), dxfattribs={"layer": "rim"})
    space.add_arc((3.5, 2), 1.5, 0, 180, dxfattribs={"layer": "rim"})
    space.add_line((0, 0), (0, 1))
    document.saveas(tmp_path / "part.dxf")
    assert box(of(tmp_path, vt.drawing("part.dxf"))) == pytest.approx([0, 0, 50, 35], abs=1e-12)
    rim = of(tmp_path, vt.drawing("part.dxf", layer="rim"), units="in")
    assert box(rim) == pytest.approx([0, 0, 30 / 25.4, 15 / 25.4], abs=1e-12)
    nodes = rim.noded[0].nodes * 25.4
    on_arc = nodes[nodes.imag > 1e-9]
    assert len(on_arc) > 20
    assert np.abs(np.abs(on_arc - 15) - 15).max() < 0.01
    assert box(of(tmp_path, vt.drawing("part.dxf", id=line.dxf.handle))) == pytest.approx([0, 0, 30, 0])


def test_fills_are_closed(tmp_path: Path) -> None:
    """An open path with a fill has an outline that ends where it began, and that is said; lines stay open."""
    write(tmp_path, "filled.svg", f'{PAGE}<path d="M 10 10 H 40 V 30"/></svg>')
    write(tmp_path, "line.svg", f'{PAGE}<path d="M 10 10 H 40 V 30" fill="none" stroke="black"/></svg>')
    filled, line = (of(tmp_path, vt.drawing(name)) for name in ("filled.svg", "line.svg"))
    assert [len(design.noded[0].segments) for design in (filled, line)] == [3, 2]
    assert "closed by a straight line" in filled.notes[0]
    assert line.notes == ()


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.svg", LAYERS, ["text (1)", 'layer "guide"']),
        ("a.svg", f'{HEAD}><path d="M 1 1 h 9" stroke="red"/></svg>', ["no size"]),
        ("a.svg", f'{HEAD} width="90" height="9"><path d="M 1 1 h 9" stroke="red"/></svg>', ["no unit"]),
        (
            "a.dxf",
            "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n0\n10\n0\n20\n0\n11\n3\n21\n2\n0\nENDSEC\n0\nEOF\n",
            ["no unit"],
        ),
    ],
)
def test_what_is_left_out_or_guessed_is_said(tmp_path: Path, name: str, text: str, said: list[str]) -> None:
    """Once for each file, in notes that begin with its name."""
    write(tmp_path, name, text)
    notes = of(tmp_path, vt.drawing(name), vt.drawing(name)).notes
    assert len(notes) == len(set(notes))
    assert all(note.startswith(f"{name}: ") for note in notes)
    for words in said:
        assert any(words in note for note in notes), notes


@pytest.mark.parametrize(
    ("chosen", "message"),
    [
        ({"file": "none.svg"}, "none.svg: cannot be read: No such file"),
        ({"file": ""}, "must be a file's name"),
        ({"file": 5}, "must be a file's name"),
        ({"file": "-"}, "-: cannot be read"),
        ({"file": "pipe.svg"}, "pipe.svg: is a pipe or a device"),
        ({"file": "/dev/zero"}, "/dev/zero: is a pipe or a device"),
        ({"file": "text.svg"}, "text.svg: nothing is drawn. Draw lines or curves, and show their layer"),
        ({"file": "dot.svg"}, "dot.svg: nothing is drawn"),
        ({"file": "broken.svg"}, "broken.svg, line 1, d: broken SVG path data"),
        ({"file": "design.toml"}, "design.toml: neither an SVG nor a DXF file"),
        ({"file": "leaf.svg", "layer": "rim"}, "there is no layer or colour 'rim'. The drawing has '#000000'"),
        ({"file": "leaf.svg", "layer": "Sketch"}, "'leaf'; hidden layers do not count."),
        ({"file": "leaf.svg", "id": "leaf"}, "has no element with the id 'leaf'"),
        ({"file": "leaf.svg", "radius": 2}, "does not go with file"),
        ({"file": "leaf.svg", "path": "M 0 0 L 1 1"}, "is two, "),
        ({"file": "leaf.svg", "id": 5}, "must be a text, not 5"),
        ({"path": "M 0 0 L 1 1", "layer": "a"}, "does not go with path"),
    ],
)
def test_what_cannot_be_drawn_is_refused(tmp_path: Path, chosen: dict[str, object], message: str) -> None:
    """By the name of the design, the key and the drawing, and with a remedy."""
    write(tmp_path, "leaf.svg", LAYERS)
    write(tmp_path, "text.svg", f"{PAGE}<text>leaf</text></svg>")
    write(tmp_path, "dot.svg", f'{PAGE}<path d="M 1 1 z" stroke="red"/></svg>')
    write(tmp_path, "broken.svg", f'{PAGE}<path d="M 1"/></svg>')
    table = {"schema": 1, "group": "p4", "cell": {"a": 90}, "site": [{"strokes": [{"point": [1, 1]}, chosen]}]}
    write(tmp_path, "design.json", json.dumps(table))
    write(tmp_path, "design.toml", "schema = 1")
    os.mkfifo(tmp_path / "pipe.svg")
    with pytest.raises(vt.DesignError) as caught:
        vt.Design.load(tmp_path / "design.json")
    assert str(caught.value).startswith(f"{tmp_path / 'design.json'}, site[0].strokes[1]")
    assert message in str(caught.value)
    assert caught.value.remedy


def test_dots_in_paths_are_refused() -> None:
    """As other strokes of no length are; they would be dropped in silence. A mere move draws nothing in any program."""
    for data in ("M20 30L40 35M60 60h0", "M1 1h2v2z M 60 60 z", "M 0 0 L 9 9 M 60 60 A 3 3 0 0 1 60 60"):
        with pytest.raises(vt.DesignError, match=r"strokes\[0\]\.data: zero length: .* at \[60, 60\]"):
            vt.Design("p4", 90, vt.Site([vt.path(data)]))
    for data in ("M 5 5 L 5 5 L 9 7 L 9 7 Z", "M 9 9 M 5 5 L 9 7 M 3 3", "M 5 5 L 9 7 Z Z"):
        assert len(vt.Design("p4", 90, vt.Site([vt.path(data)])).noded[0].segments) == 1
