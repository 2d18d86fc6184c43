"""Files dropped onto the page: drawings as strokes, and files of ours as the design and the job that made them."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import ezdxf
import pytest
import svgpathtools
from hypothesis import given, settings
from hypothesis import strategies as st

import voronoi_tiles as vt
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.studio.drop import SEGMENTS_MAX, STROKES_MAX, dropped

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
PAGE = f'{HEAD} width="100mm" height="80mm" viewBox="0 0 100 80">'
LEAF = f"""{PAGE}
<path d="M 20 60 H 50 V 30" fill="#ff0000"/>
<circle cx="60" cy="20" r="5" stroke="black" fill="none"/>
<g inkscape:groupmode="layer" inkscape:label="Guide"><path d="M 0 0 H 90" stroke="#00ff00" fill="none"/></g>
<text x="5" y="5">leaf</text>
</svg>"""

JOBS: dict[str, dict[str, Any]] = {
    "piece": {"kerf": 0.1},
    "sheet": {"sheet": (123.5, 80), "fit": "frame", "frame": 5, "rotate": 12.5},
    "moved": {"sheet": "12x8cm", "offset": (1.25, -3e-7), "kerf": 0.15, "colours": 3, "into": "layers"},
    "exact": {},
}


@pytest.mark.parametrize("suffix", ["svg", "dxf", "pdf", "lbrn2", "gcode"])
@pytest.mark.parametrize("name", JOBS)
def test_files_of_ours_open_again(tmp_path: Path, name: str, suffix: str) -> None:
    """As the design and the job that made them, whatever the format; a drawing that was a stroke is its path."""
    (tmp_path / "leaf.svg").write_text(f'{PAGE}<path d="M 0 0 L 9 4" stroke="black"/></svg>')
    site = vt.Site([vt.drawing("leaf.svg", translate=(12, 12)), vt.point(3 + 7j)], name="<\"é'&>")
    design = vt.Design("p4", 60, site, folder=tmp_path, units="cm" if name == "piece" else "mm")
    burn: dict[str, Any] = {"feed": 300, "power": "cut=800"} if suffix == "gcode" else {}
    job = vt.Job(**JOBS[name], **burn)
    file = tmp_path / f"result.{suffix}"
    tiling = design.tessellate()
    tiling.export(file, job=job) if JOBS[name] or suffix in ("pdf", "lbrn2", "gcode") else tiling.export(file)
    answer = dropped(file.read_bytes(), file.name, 1.0)
    assert vt.Design.from_dict(answer["design"]) == vt.Design.loads(design.source)
    assert all(isinstance(value, str | int | float) for value in answer["job"].values())
    assert vt.Job(**answer["job"]) == job
    assert answer["job"].get("sheet") in (None, "120x80mm", "123.5x80mm")  # as one types them
    assert answer["notes"] == []


@pytest.mark.parametrize("name", ["bird.toml", "BIRD.JSON"])
def test_a_design_opens(tmp_path: Path, name: str) -> None:
    """As it is, without a job; the files that it names are looked for beside the design that is drawn."""
    text = """schema = 1
group = "p4"  # by hand
cell = { a = 60 }
[[site]]
name = "bird"
strokes = [{ polyline = [[6.0, 9.0], [20, 4.0]] }, { file = "leaf.svg" }]
art = "eye.svg"
"""
    (tmp_path / "eye.svg").write_text(LEAF)
    design = tomllib.loads(text)
    data = text if name.endswith("toml") else json.dumps(design)
    answer = dropped(data.encode(), f"folder/{name}", 1.0, str(tmp_path))
    assert answer["design"] == design
    assert "job" not in answer
    [note] = answer["notes"]
    assert note == f"{name} names 'leaf.svg', not to be found from {tmp_path}: copy it there."
    (tmp_path / "leaf.svg").write_text(LEAF)
    assert dropped(data.encode(), name, 1.0, str(tmp_path)) == {"design": design, "notes": []}


def test_a_drawing_becomes_strokes() -> None:
    """A stroke an object: in its real size in the design's unit, y up, the lower left corner of all at the origin."""
    answer = dropped(LEAF.encode(), "leaf.svg", 10.0)
    triangle, circle = (svgpathtools.parse_path(stroke["path"]) for stroke in answer["strokes"])
    assert all(set(stroke) == {"path"} for stroke in answer["strokes"])
    corners = [0, 3, 3 + 3j]
    assert [segment.start for segment in triangle] == pytest.approx(corners)
    assert triangle.isclosed()
    assert circle.bbox() == pytest.approx((3.5, 4.5, 3.5, 4.5))
    assert [note.partition(": ")[0] for note in answer["notes"]] == ["leaf.svg"] * 3
    assert [word for word in ("text", "guide", "closed") if not any(word in note for note in answer["notes"])] == []


def test_strokes_are_those_of_a_named_file(tmp_path: Path) -> None:
    """A site of the dropped strokes is the site of one stroke that names the file."""
    document = ezdxf.new()
    document.modelspace().add_line((3, 4), (13, 4))
    document.modelspace().add_circle((20, 20), 3)
    document.units = ezdxf.units.CM
    document.saveas(tmp_path / "a.dxf")
    (tmp_path / "a.svg").write_text(LEAF)
    for name in ("a.svg", "a.dxf"):
        answer = dropped((tmp_path / name).read_bytes(), f"folder/{name}", 25.4)
        table = {"schema": 1, "group": "p1", "units": "in", "cell": {"a": 90, "b": 90, "angle": 90}}
        ours = vt.Design.from_dict({**table, "site": [{"strokes": answer["strokes"]}]})
        named = vt.Design.from_dict({**table, "site": [{"strokes": [{"file": name}]}]}, folder=tmp_path)
        assert sorted(map(str, ours.noded[0].nodes)) == sorted(map(str, named.noded[0].nodes))
        assert len(ours.noded[0].segments) == len(named.noded[0].segments) > 10
        assert list(named.notes) == answer["notes"]


def test_many_objects_are_one_stroke() -> None:
    """A page cannot list thousands of strokes: that is said."""
    paths = "".join(f'<path d="M {k} 0 V 1" stroke="black"/>' for k in range(STROKES_MAX + 1))
    answer = dropped(f"{PAGE}{paths}</svg>".encode(), "many.svg", 1.0)
    assert len(answer["strokes"]) == 1
    assert answer["strokes"][0]["path"].count("M") == STROKES_MAX + 1
    assert f"{STROKES_MAX + 1} objects are one stroke" in answer["notes"][0]


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "neither an SVG nor a DXF file"),
        (b"\x89PNG\r\n", "neither an SVG nor a DXF file"),
        (b"<svg", "not well-formed|broken"),
        (f"{PAGE}</svg>".encode(), "nothing is drawn"),
        (f"{PAGE}<path d='M 0 0{' L 1 1 L 2 2' * SEGMENTS_MAX}'/></svg>".encode(), "10,001 lines and curves"),
        (b"<vt:recipe job=''>{}</vt:recipe>", "unbound prefix"),
        (b"<vt:recipe>{&quot;group&quot;: &quot;p1&quot;, &quot;cell&quot;: 5}</vt:recipe>", "cell: must be a table"),
        (b'<vt:recipe>{"group": "p1", "cell": {}, "site": [{}]}</vt:recipe>', r"site\[0\].strokes: is missing"),
        (b" " * (16 * 2**20 + 1), "larger than 16 MiB"),
    ],
)
def test_what_is_nothing_to_draw_with_is_refused(data: bytes, said: str) -> None:
    """With the file's name, made safe to show."""
    with pytest.raises(DesignError, match=said) as error:
        dropped(data, "../x\x07y", 1.0)
    assert error.value.file == "x\\x07y"


@pytest.mark.parametrize(
    ("data", "name", "said"),
    [
        (b"group = 'p1'\ncell = {", "a.toml", "line|not valid|TOML"),
        (b"group = 'p1'\ncell = 5", "a.toml", "cell: must be a table"),
        (b'{"schema": 1, "group": "p4", "tiles": []}', "tiles.json", "the outlines of tiles, not their design"),
        (b"\xff", "a.json", "not a text in UTF-8"),
    ],
)
def test_designs_that_cannot_be_opened_are_refused(data: bytes, name: str, said: str) -> None:
    """As the command line refuses them, by their name."""
    with pytest.raises(DesignError, match=said) as error:
        dropped(data, name, 1.0)
    assert error.value.file == name


@pytest.mark.parametrize(
    "piece", [b"<vt:recipe ", b"<Notes ", b"<Notes Notes='", b"/Subject <FEFF00", b"999\nrecipe {\n"]
)
def test_beginnings_of_recipes_end(piece: bytes) -> None:
    """A file of nothing but beginnings is looked through once: megabytes take milliseconds, not hours."""
    with pytest.raises(DesignError):
        dropped(piece * (2**22 // len(piece)), "x.bin", 1.0)


@settings(max_examples=40)
@given(data=st.data())
def test_spoilt_files_are_one_message(data: st.DataObject) -> None:
    """Whatever is in a file: strokes, a design, or a DesignError."""
    recipe = json.dumps({"group": "p1", "cell": {"a": 1}, "site": [{"strokes": []}]})
    text = (
        f'{PAGE}<metadata><vt:recipe job="{{}}">{recipe}</vt:recipe></metadata><path d="M 0 0 L 9 4"/></svg>'.encode()
    )
    at = data.draw(st.integers(0, len(text)))
    spoilt = text[:at] + data.draw(st.binary(max_size=4)) + text[at + data.draw(st.integers(0, 8)) :]
    try:
        answer = dropped(spoilt, "a.svg", 1.0)
    except DesignError:
        return
    assert set(answer) in ({"strokes", "notes"}, {"design", "job", "notes"})
