"""Reading designs: what is accepted, and the message for everything that is not."""

from __future__ import annotations

import io
import json
import math
import re
import subprocess
import sys
from collections.abc import Mapping
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.designs.design import Design
from voronoi_tiles.groups.wallpaper import GROUPS

BIRD = """\
schema = 1
group = "p4"
units = "mm"

[cell]
a = 60.0

[[site]]
name = "bird"
strokes = [
  { segment = [[5, 3], [25, 11]] },
]
"""

CELLS: dict[str, dict[str, float]] = {
    "oblique": {"a": 60.0, "b": 50.0, "angle": 75.0},
    "rectangular": {"a": 60.0, "b": 50.0},
    "square": {"a": 60.0},
    "hexagonal": {"a": 60.0},
}

STROKES: list[dict[str, Any]] = [
    {"point": [5, 3]},
    {"segment": [[5, 3], [25, 11]]},
    {"polyline": [[5, 3], [9, 9], [25, 11]], "closed": False},
    {"polyline": [[5, 3], [9, 9], [25, 11]], "closed": True},
    {"bezier": [[0, 0], [1, 2], [3, 2], [4, 0]]},
    {"hermite": [[0, 0], [4, 0]], "tangents": [[3, 6], [3, -6]]},
    {"catmull_rom": [[0, 0], [4, 1], [6, 5]], "alpha": 0.5, "closed": False},
    {"catmull_rom": [[0, 0], [4, 1], [6, 5]], "closed": True},
    {"bspline": [[0, 0], [4, 1], [6, 5], [8, 2]], "closed": False},
    {"bspline": [[0, 0], [4, 1], [6, 5]], "closed": True},
    {"circle": [5, 3], "radius": 2},
    {"path": "M 1 1 C 2 3 4 3 5 1"},
]


def design(*strokes: Mapping[str, Any], group: str = "p4", **site: Any) -> dict[str, Any]:
    """A design of one site, as plain dictionaries."""
    cell = dict(CELLS[GROUPS[group].system])
    drawn = list(strokes) or [{"segment": [[5, 3], [25, 11]]}]
    return {"schema": 1, "group": group, "cell": cell, "site": [{"strokes": drawn, **site}]}


def changed(path: str, value: Any, base: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """A good design with one value changed; `...` takes the key out."""
    result = deepcopy(dict(base or design()))
    *parents, last = path.replace("]", "").replace("[", ".").split(".")
    here: Any = result
    for parent in parents:
        here = here[int(parent)] if parent.isdigit() else here[parent]
    key: Any = int(last) if last.isdigit() else last
    if value is ...:
        del here[key]
    else:
        here[key] = value
    return result


def refusal(mapping: Any) -> DesignError:
    """The error that a design raises."""
    with pytest.raises(DesignError) as caught:
        Design.from_dict(mapping, file="bird.toml")
    error = caught.value
    assert error.file == "bird.toml"
    assert str(error).startswith("bird.toml")
    assert error.remedy
    assert "\n" not in str(error)
    return error


# --- what is accepted -----------------------------------------------------------------------------------------------


def test_the_bird() -> None:
    """The design of the README, every part of it."""
    bird = Design.loads(BIRD)
    assert bird.group is GROUPS["p4"]
    assert (bird.lattice.a, bird.lattice.b) == (60 + 0j, 60j)
    assert (bird.units, bird.unit_mm, bird.name) == ("mm", 1.0, "design")
    (site,) = bird.noded
    assert site.name == "bird"
    assert site.nodes.tolist() == [5 + 3j, 25 + 11j]
    assert site.segments.tolist() == [[0, 1]]


@pytest.mark.parametrize("group", GROUPS)
def test_every_group_reads_its_cell(group: str) -> None:
    """With what the system leaves free, and with the fixed values written out."""
    plain = Design.from_dict(design(group=group))
    full = changed("cell.b", CELLS[GROUPS[group].system].get("b", 60.0), design(group=group))
    full = changed("cell.angle", GROUPS[group].fixed_angle or 75.0, full)
    assert Design.from_dict(full).lattice == plain.lattice
    assert abs(plain.lattice.a) == 60.0
    assert math.degrees(np.angle(plain.lattice.b)) == pytest.approx(GROUPS[group].fixed_angle or 75.0)


@pytest.mark.parametrize("stroke", STROKES, ids=["-".join(stroke) for stroke in STROKES])
def test_every_kind_of_stroke(stroke: dict[str, Any]) -> None:
    """Each is read, flattened and placed; its canonical source reads as the same design."""
    plain = Design.from_dict(design(stroke)).noded[0]
    placed = Design.from_dict(design({**stroke, "scale": 2, "rotate": 90, "translate": [1, -4]}, tolerance=0.02))
    if "circle" not in stroke:
        assert np.abs(placed.noded[0].nodes - (2j * plain.nodes + 1 - 4j)).max() < 1e-14
        assert placed.noded[0].segments.tolist() == plain.segments.tolist()
    again = Design.loads(placed.source, format="json")
    assert again.source == placed.source
    assert again.noded[0].nodes.tolist() == placed.noded[0].nodes.tolist()


def test_strokes_are_where_they_are_drawn() -> None:
    """One value of each kind, in closed form."""

    def ends(stroke: dict[str, Any]) -> set[complex]:
        nodes = Design.from_dict(design(stroke, tolerance=10.0)).noded[0].nodes
        return {complex(round(z.real, 9), round(z.imag, 9)) for z in nodes.tolist()}

    assert ends(STROKES[0]) == {5 + 3j}
    assert ends(STROKES[4]) == {0j, 4 + 0j}
    assert ends({"path": "M 1 1 h 4 v 2 z"}) == {1 + 1j, 5 + 1j, 5 + 3j}
    # (p0 + 4 p1 + p2) / 6 and (p1 + 4 p2 + p3) / 6
    assert ends(STROKES[8]) == {complex(round(22 / 6, 9), round(9 / 6, 9)), 6 + round(23 / 6, 9) * 1j}
    assert 7 + 3j in ends({"circle": [5, 3], "radius": 2})
    assert 11 + 6j in ends({"circle": [5, 3], "radius": 2, "scale": 0.5, "translate": [7.5, 4.5]})
    turned = {"circle": [5, 3], "radius": 2, "rotate": 45}
    centre = (5 + 3j) * complex(math.sqrt(0.5), math.sqrt(0.5))
    assert min(abs(z - (centre + 2)) for z in ends(turned)) < 1e-8


def test_tolerance_is_in_units() -> None:
    """The default is 0.01 mm in every unit."""
    stroke = {"circle": [0, 0], "radius": 1}

    def sides(units: str, **site: Any) -> int:
        return len(Design.from_dict({**design(stroke, **site), "units": units}).noded[0].segments)

    assert sides("mm") == sides("cm", tolerance=0.01) == 24
    assert sides("cm") == sides("mm", tolerance=0.001) == 72
    assert sides("in") == sides("mm", tolerance=0.01 / 25.4)
    assert [Design.from_dict({**design(), "units": u}).unit_mm for u in ("mm", "cm", "in")] == [1.0, 10.0, 25.4]


def test_strokes_of_a_site_are_noded() -> None:
    """Strokes of one site may cross: they share a node."""
    cross = Design.from_dict(design({"segment": [[0, 0], [4, 4]]}, {"segment": [[0, 4], [4, 0]]})).noded[0]
    assert len(cross.segments) == 4
    assert 2 + 2j in cross.nodes.tolist()


def test_names_and_numpy() -> None:
    """Sites without a name are counted; numpy values and tuples are as good as lists."""
    base = design()
    base["site"] = [
        {"strokes": ({"polyline": np.array([[0, 0], [1, 2.0]])},)},
        {"strokes": [{"point": (np.int64(7), 9)}]},
    ]
    read = Design.from_dict(base)
    assert [site.name for site in read.noded] == ["site1", "site2"]
    assert Design.loads(read.source, format="json").source == read.source


def test_source_is_canonical() -> None:
    """TOML, JSON, key order and 60 or 60.0 make no difference."""
    bird = Design.loads(BIRD)
    shuffled = json.dumps(dict(reversed(json.loads(bird.source).items())))
    assert Design.loads(shuffled, format="json").source == bird.source
    assert Design.loads(BIRD.replace("60.0", "60")).source == bird.source
    assert bird.source.isascii()


def test_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """TOML and JSON by suffix, else by content; a byte order mark; standard input."""
    toml, unnamed, other = tmp_path / "bird.toml", tmp_path / "fish", tmp_path / "cat.json"
    toml.write_text(BIRD)
    source = Design.load(toml).source
    assert Design.load(str(toml)).name == "bird"
    unnamed.write_text(source)
    assert Design.load(unnamed).source == source
    other.write_bytes(b"\xef\xbb\xbf" + source.encode())
    assert Design.load(other).source == source
    toml.write_bytes(b"\xef\xbb\xbf" + BIRD.replace("\n", "\r\n").encode())
    assert Design.load(toml).source == source
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(BIRD.encode())))
    piped = Design.load("-")
    assert (piped.name, piped.source) == ("design", source)


def test_light_imports() -> None:
    """Reading a design of one segment imports neither scipy nor shapely nor an SVG library."""
    code = (
        "import sys; from voronoi_tiles.designs.design import Design;"
        f"Design.loads({BIRD!r});"
        "heavy = {'scipy', 'shapely', 'svgelements', 'svgwrite', 'rich', 'click', 'difflib'} & set(sys.modules);"
        "assert not heavy, heavy"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


# --- what is refused ------------------------------------------------------------------------------------------------

LINE = "site[0].strokes[0]"


@pytest.mark.parametrize(
    ("path", "value", "key", "message"),
    [
        ("schema", ..., "schema", "missing"),
        ("schema", 2, "schema", "schema 2 is not supported"),
        ("schema", "1", "schema", "not supported"),
        ("schema", True, "schema", "schema true"),
        ("group", ..., "group", "missing"),
        ("group", "p5", "group", "unknown wallpaper group 'p5'"),
        ("group", "p4mm", "group", 'Did you mean "p4m"'),
        ("group", "P31M", "group", 'Did you mean "p31m"'),
        ("group", 4, "group", "unknown wallpaper group 4"),
        ("group", ["p4"], "group", "unknown wallpaper group"),
        ("units", "furlong", "units", "unknown units 'furlong'"),
        ("units", 1, "units", "unknown units"),
        ("colour", "red", None, "unknown key 'colour'"),
        ("sites", [], None, 'Did you mean "site"'),
        ("cell", ..., "cell", "missing"),
        ("cell", 60, "cell", "must be a table, not 60"),
        ("cell", [], "cell", "must be a table"),
        ("cell.a", ..., "cell.a", "missing"),
        ("cell.a", 0, "cell.a", "greater than 0, not 0"),
        ("cell.a", -60.0, "cell.a", "greater than 0, not -60"),
        ("cell.a", math.nan, "cell.a", "finite number, not nan"),
        ("cell.a", math.inf, "cell.a", "finite number, not inf"),
        ("cell.a", -math.inf, "cell.a", "finite number, not -inf"),
        ("cell.a", "60", "cell.a", "must be a number, not '60'"),
        ("cell.a", True, "cell.a", "must be a number, not true"),
        ("cell.a", [60], "cell.a", "must be a number, not [60]"),
        ("cell.a", None, "cell.a", "must be a number, not nothing"),
        ("cell.a", 1e308, "cell.a", "beyond 1e+12"),
        ("cell.a", 10**400, "cell.a", "beyond 1e+12"),
        ("cell.a", 1e-10, "cell.a", "smaller than 1e-09"),
        ("cell.a", 5e-324, "cell.a", "below 1e-100"),
        ("cell.a", 1 + 1j, "cell.a", "must be a number"),
        ("cell.b", 50.0, "cell.b", "b is as long as a"),
        ("cell.angle", 60.0, "cell.angle", "its angle is 90 degrees"),
        ("cell.c", 60.0, "cell", "unknown key 'c'"),
        ("site", ..., "site", "missing"),
        ("site", [], "site", "there is no site"),
        ("site", {"strokes": []}, "site", "must be an array, not a table"),
        ("site[0]", "bird", "site[0]", "must be a table, not 'bird'"),
        ("site[0].stroke", [], "site[0]", 'Did you mean "strokes"'),
        ("site[0].name", "", "site[0].name", "'' is no name"),
        ("site[0].name", "a\nb", "site[0].name", "is no name"),
        ("site[0].name", "\ud800", "site[0].name", "is no name"),
        ("site[0].name", 5, "site[0].name", "must be a text, not 5"),
        ("site[0].tolerance", 0, "site[0].tolerance", "greater than 0"),
        ("site[0].tolerance", math.nan, "site[0].tolerance", "finite"),
        ("site[0].tolerance", "fine", "site[0].tolerance", "must be a number"),
        ("site[0].strokes", ..., "site[0].strokes", "missing"),
        ("site[0].strokes", [], "site[0].strokes", "there is no stroke"),
        ("site[0].strokes", {}, "site[0].strokes", "must be an array"),
        (LINE, [], LINE, "must be a table"),
        (LINE, {}, LINE, "has no kind"),
        (LINE, {"closed": True}, LINE, "has no kind"),
        (LINE, {"segmnt": []}, LINE, 'Did you mean "segment"'),
        (LINE, {"point": [0, 0], "circle": [1, 1]}, LINE, "is two, point and circle"),
        (LINE, {"point": [0, 0], "closed": True}, f"{LINE}.closed", "does not go with point"),
        (LINE, {"point": [0]}, f"{LINE}.point", "2 coordinates, not 1"),
        (LINE, {"point": [0, math.nan]}, f"{LINE}.point[1]", "finite number, not nan"),
        (LINE, {"point": 5}, f"{LINE}.point", "must be an array"),
        (LINE, {"segment": [[1, 1], [1, 1]]}, f"{LINE}.segment[1]", "zero length"),
        (LINE, {"segment": [[1, 1]]}, f"{LINE}.segment", "needs 2 points, not 1"),
        (LINE, {"segment": [[1, 1], [2, 2], [3, 3]]}, f"{LINE}.segment", "needs 2 points, not 3"),
        (LINE, {"segment": [[1, 1], [2, "x"]]}, f"{LINE}.segment[1][1]", "must be a number, not 'x'"),
        (LINE, {"segment": [[1, 1], [2, 1e308]]}, f"{LINE}.segment[1][1]", "beyond 1e+12"),
        (LINE, {"polyline": [[1, 1], [2, 2], [2, 2]]}, f"{LINE}.polyline[2]", "zero length"),
        (LINE, {"polyline": [[1, 1]]}, f"{LINE}.polyline", "at least 2 points"),
        (LINE, {"polyline": [[1, 1], [2, 2]], "closed": True}, f"{LINE}.polyline", "at least 3"),
        (LINE, {"polyline": [[1, 1], [2, 2]], "closed": 1}, f"{LINE}.closed", "true or false, not 1"),
        (LINE, {"polyline": [[0, 0], [1, 0], [0, 1], [0, 0]], "closed": True}, f"{LINE}.polyline[3]", "repeats"),
        (LINE, {"bezier": [[0, 0], [1, 1], [2, 2]]}, f"{LINE}.bezier", "4, 7, 10, ... points, not 3"),
        (LINE, {"bezier": [[0, 0]] * 4}, f"{LINE}.bezier[0]", "zero length"),
        (LINE, {"hermite": [[0, 0], [1, 1]]}, f"{LINE}.tangents", "missing"),
        (LINE, {"hermite": [[0, 0], [1, 1]], "tangents": [[1, 0]]}, f"{LINE}.tangents", "2 points but 1"),
        (LINE, {"hermite": [[0, 0], [0, 0]], "tangents": [[0, 0]] * 2}, f"{LINE}.hermite[1]", "zero length"),
        (LINE, {"catmull_rom": [[0, 0], [1, 1]], "alpha": 1.5}, f"{LINE}.alpha", "from 0 to 1"),
        (LINE, {"catmull_rom": [[0, 0], [1, 1], [1, 1]]}, f"{LINE}.catmull_rom[2]", "zero length"),
        (LINE, {"bspline": [[0, 0], [1, 1], [2, 0]]}, f"{LINE}.bspline", "at least 4 points, not 3"),
        (LINE, {"bspline": [[1, 1]] * 4}, f"{LINE}.bspline", "zero length"),
        (LINE, {"bspline": []}, f"{LINE}.bspline", "at least 4 points, not 0"),
        (LINE, {"bspline": [], "closed": True}, f"{LINE}.bspline", "at least 3 points, not 0"),
        (LINE, {"bezier": []}, f"{LINE}.bezier", "4, 7, 10, ... points, not 0"),
        ("cell.a", 1e-308, "cell.a", "number below 1e-100. Write a larger number, or use smaller units."),
        ("site[0].tolerance", 1e-300, "site[0].tolerance", "Write a larger number"),
        (LINE, {"point": [1, 1e-300]}, f"{LINE}.point[1]", "Write 0, or use smaller units."),
        (LINE, {"point": [1, 1], "scale": 1e-300}, f"{LINE}.scale", "Write a factor such as 0.5."),
        (LINE, {"circle": [1, 1]}, f"{LINE}.radius", "missing"),
        (LINE, {"circle": [1, 1], "radius": 0}, f"{LINE}.radius", "greater than 0"),
        (LINE, {"circle": [1, 1], "radius": 1e12}, LINE, "1,000,000 segments"),
        (LINE, {"path": "M 1 1 L 2"}, f"{LINE}.path", "character 10"),
        (LINE, {"path": "1 1"}, f"{LINE}.path", "M or m expected"),
        (LINE, {"path": 5}, f"{LINE}.path", "must be a text"),
        (LINE, {"path": ""}, f"{LINE}.path", "draws nothing"),
        (LINE, {"point": [1, 1], "scale": 0}, f"{LINE}.scale", "must not be 0"),
        (LINE, {"point": [1, 1], "scale": "2"}, f"{LINE}.scale", "must be a number"),
        (LINE, {"point": [1, 1], "rotate": math.inf}, f"{LINE}.rotate", "finite"),
        (LINE, {"point": [1, 1], "translate": 5}, f"{LINE}.translate", "must be an array"),
        (LINE, {"point": [1e12, 1], "scale": 1e12}, LINE, "reaches beyond"),
        (
            LINE,
            {"segment": [[1, 1], [2, 1]], "scale": 1e-30, "translate": [1, 1]},
            LINE,
            "zero length where it is placed",
        ),
        (LINE, {"segment": [[0, 0], [1e9, 0]]}, "site[0]", "100 times larger than the cell"),
        (LINE, {"bezier": [[0, 0], [0, 1e12], [1e12, 1e12], [1e12, 0]]}, "site[0]", "1,000,000 segments"),
    ],
)
def test_bad_values(path: str, value: Any, key: str | None, message: str) -> None:
    """Each is one DesignError that names file, key and remedy."""
    error = refusal(changed(path, value))
    assert error.key == key
    assert message in str(error)


@pytest.mark.parametrize("angle", [0, 180, 0.0, 180.0, -10, 270, 1e-7, 180 - 1e-7])
def test_flat_angles(angle: float) -> None:
    """0 and 180 degrees, and what is next to them, make no cell."""
    error = refusal(changed("cell.angle", angle, design(group="p2")))
    assert error.key == "cell.angle"
    assert "between 0 and 180" in error.message


@pytest.mark.parametrize("group", GROUPS)
def test_cells_that_contradict_the_group(group: str) -> None:
    """Missing and contradicting sides and angles, for every system."""
    base, system = design(group=group), GROUPS[group].system
    if system in ("oblique", "rectangular"):
        assert refusal(changed("cell.b", ..., base)).key == "cell.b"
    else:
        assert "as long as a" in refusal(changed("cell.b", 50.0, base)).message
    if system == "oblique":
        assert refusal(changed("cell.angle", ..., base)).key == "cell.angle"
    else:
        assert "its angle is" in refusal(changed("cell.angle", 60.0, base)).message


def test_needles_are_refused() -> None:
    """Cells and lattices of absurd proportions."""
    assert "longer than wide" in refusal(changed("cell.b", 1e-5, design(group="pm"))).message
    assert "longer than wide" in refusal(changed("cell.angle", 1e-5, design(group="p1"))).message


def test_duplicate_names() -> None:
    """Also where a name that was given is the default of another site."""
    base = design(name="site2")
    base["site"].append({"strokes": [{"point": [1, 1]}]})
    error = refusal(base)
    assert error.key == "site[1].name"
    assert '"site2" is already the name of site[0]' in error.message


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ('schema = 1\ngroup = p4"', 2, "not TOML: invalid value (column 9)"),
        ("schema = 1\nschema = 1\n", 2, "not TOML"),
        ("schema = 1\n[cell", 2, "not TOML"),
        ("schema = " + "1" * 5000, None, "schema: schema 1000"),
        (BIRD.replace("60.0", "6" * 6000), None, "cell.a: number beyond 1e+12"),
        (BIRD.replace("60.0", "-1_" + "0" * 6000), None, "cell.a: number beyond 1e+12"),
        ("schema = " + "[" * 100_000, None, "nested too deeply"),
        ("\x00\x01\x02", 1, "not TOML"),
        ("%PDF-1.4", 1, "not TOML"),
        ("", None, "missing"),
        ("\n\n", None, "missing"),
    ],
)
def test_broken_toml(text: str, line: int | None, message: str) -> None:
    """Syntax errors carry the line."""
    with pytest.raises(DesignError) as caught:
        Design.loads(text, file="bird.toml")
    assert caught.value.line == line
    assert message in str(caught.value)
    assert str(caught.value).startswith(f"bird.toml, line {line}: " if line else "bird.toml")


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ('{"schema": 1,\n "group" "p4"}', 2, "not JSON"),
        ('{"schema": 1, "schema": 1}', None, "'schema' occurs twice"),
        ("[" * 100_000, None, "nested too deeply"),
        ('{"schema": ' + "1" * 5000 + "}", None, "schema: schema 1000"),
        ('{"schema": 1, "group": "p4", "cell": {"a": ' + "6" * 6000 + "}}", None, "cell.a: number beyond 1e+12"),
        ("[]", None, "must be a table, not []"),
        ("null", None, "must be a table, not nothing"),
        ("", 1, "not JSON"),
    ],
)
def test_broken_json(text: str, line: int | None, message: str) -> None:
    """The same for JSON; a key that occurs twice is not dropped in silence."""
    with pytest.raises(DesignError) as caught:
        Design.loads(text, format="json", file="bird.json")
    assert caught.value.line == line
    assert message in str(caught.value)
    assert str(caught.value).startswith("bird.json")


def test_json_not_a_number() -> None:
    """NaN is no JSON, but Python's parser takes it: it is refused by its key."""
    with pytest.raises(DesignError, match=r"cell\.a: must be a finite number"):
        Design.loads('{"schema": 1, "group": "p4", "cell": {"a": NaN}, "site": []}', format="json")


def test_unreadable_files(tmp_path: Path) -> None:
    """Missing, a folder, binary, a name with a zero byte, an endless device: one message with the file."""
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"schema = 1\n\xff\xfe\x00")
    utf16 = tmp_path / "utf16.toml"
    utf16.write_bytes(BIRD.encode("utf-16"))
    for path, message in (
        (tmp_path / "missing.toml", "No such file"),
        (tmp_path, "Is a directory"),
        (binary, "not a text in UTF-8"),
        (utf16, "not a text in UTF-8"),
        (Path("a\0b"), "cannot read the design: its name has a null byte"),
        (Path("/dev/zero"), "larger than 64 MiB"),
    ):
        with pytest.raises(DesignError, match=message) as caught:
            Design.load(path)
        assert caught.value.file == str(path)
    with pytest.raises(DesignError) as caught:
        Design.load(binary)
    assert caught.value.line == 2


def test_the_largest_site() -> None:
    """A hundred times the cell is read, more is refused."""
    assert Design.from_dict(changed(LINE, {"segment": [[0, 0], [5990, 0]]})).noded
    assert refusal(changed(LINE, {"segment": [[0, 0], [6010, 0]]})).key == "site[0]"


def test_nothing_to_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """No name, and a standard input that was closed."""
    with pytest.raises(DesignError, match=r"^'': the name of the design is empty\. Name a TOML or JSON file"):
        Design.load("")
    monkeypatch.setattr(sys, "stdin", None)
    with pytest.raises(DesignError, match=r"^standard input: cannot read the design: it is closed\. "):
        Design.load("-")


def test_a_design_shows_itself_in_a_line() -> None:
    """No arrays: the name, the group, the first sites."""
    base = design()
    base["site"] = [{"strokes": [{"point": [k, 1]}]} for k in range(5)]
    assert repr(Design.from_dict(base, name="bird")) == "<Design 'bird': p4, 5 sites (site1, site2, site3, ...)>"


def test_values_that_cannot_be_shown() -> None:
    """Integers of thousands of digits, endless and deep lists are named without being printed."""
    endless: list[Any] = []
    endless.append(endless)
    deep: list[Any] = []
    for _ in range(100_000):
        deep = [deep]
    for value in (10**5000, [10**5000], endless, deep, "x" * 10**6):
        for path in ("group", "cell.a", "site[0].name", LINE, "schema"):
            assert len(str(refusal(changed(path, value)))) < 400


def test_wrong_arguments() -> None:
    """Scripts get the same kind of error for a wrong format or a text that is none."""
    with pytest.raises(DesignError, match="unknown format 'yaml'"):
        Design.loads(BIRD, format="yaml")
    with pytest.raises(DesignError, match="a design is text"):
        Design.loads(b"schema = 1")  # type: ignore[arg-type]


# --- whatever is passed ---------------------------------------------------------------------------------------

scalars = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.just(10**400),
    st.floats(),
    st.text(max_size=5),
    st.binary(max_size=3),
    st.complex_numbers(),
    st.dates(),
    st.sampled_from(["p1", "p6m", "mm", "M 0 0 L 1 1", 1, 60.0, 1e308, -1e12, 5e-324]),
)
words = st.sampled_from(
    [
        "schema",
        "group",
        "units",
        "cell",
        "site",
        "a",
        "b",
        "angle",
        "name",
        "tolerance",
        "strokes",
        "closed",
        "alpha",
        "point",
        "segment",
        "polyline",
        "bezier",
        "hermite",
        "tangents",
        "catmull_rom",
        "bspline",
        "circle",
        "radius",
        "path",
        "scale",
        "rotate",
        "translate",
    ]
)
junk = st.recursive(
    scalars,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.tuples(inner, inner),
        st.dictionaries(st.one_of(words, scalars.filter(lambda key: not isinstance(key, list))), inner, max_size=4),
    ),
    max_leaves=12,
)


def attempt(mapping: Any) -> Design | None:
    """The design, or None where it is refused as it should be; any other error comes through."""
    try:
        return Design.from_dict(mapping)
    except DesignError as error:
        refused = error
    assert str(refused)
    assert refused.remedy
    return None


def survives(mapping: Any) -> None:
    """Either a design, or a DesignError with a message and a remedy."""
    read = attempt(mapping)
    if read is not None:
        assert Design.loads(read.source, format="json").source == read.source


@settings(deadline=None, max_examples=300)
@given(junk)
def test_junk(value: Any) -> None:
    """Any nested value at all."""
    survives(value)


PATHS = ["schema", "group", "units", "cell", "cell.a", "cell.b", "site", "site[0]", "site[0].name", "site[0].strokes"]
PATHS += ["site[0].tolerance", LINE]


@settings(deadline=None, max_examples=500)
@given(st.sampled_from(PATHS), junk)
def test_junk_in_a_good_design(path: str, value: Any) -> None:
    """A good design with any value in one place."""
    survives(changed(path, value))


OPTIONS = ["closed", "alpha", "tangents", "radius", "scale", "rotate", "translate"]


@settings(deadline=None, max_examples=500)
@given(st.sampled_from(STROKES), st.sampled_from(OPTIONS), junk, st.booleans())
def test_junk_in_a_stroke(stroke: dict[str, Any], option: str, value: Any, in_kind: bool) -> None:
    """A good stroke with any value in its kind, or in one of its options."""
    name = next(iter(stroke)) if in_kind else option
    survives(design({**stroke, name: value}))


numbers = st.one_of(st.floats(-1e13, 1e13), st.integers(-5, 5), st.sampled_from([0.0, 1e-200, 1e-12, 1e12, 1 + 2**-52]))
pairs = st.lists(st.tuples(numbers, numbers), min_size=1, max_size=7)
placements = st.fixed_dictionaries(
    {}, optional={"scale": numbers, "rotate": numbers, "translate": st.tuples(numbers, numbers)}
)


@settings(deadline=None, max_examples=200)
@given(
    st.lists(
        st.builds(
            lambda kind, points, placement: {kind: points} | placement,
            st.sampled_from(["segment", "polyline", "bezier", "catmull_rom", "bspline"]),
            pairs,
            placements,
        ),
        min_size=1,
        max_size=4,
    ),
    st.sampled_from([1e-12, 0.01, 1e9]),
)
def test_extreme_numbers(strokes: list[dict[str, Any]], tolerance: float) -> None:
    """Well-formed strokes of every size: sites are finite and noded, or refused."""
    base = changed("cell.a", 1e11, design(*strokes, tolerance=tolerance))
    read = attempt(base)
    if read is None:
        return
    (site,) = read.noded
    assert np.isfinite(site.elements).all()
    assert len(site.elements)
    lengths = np.abs(site.nodes[site.segments[:, 0]] - site.nodes[site.segments[:, 1]])
    assert (lengths > 0.0).all()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "strokes = [\n  { segment = [[1, 2], [3, 4]],\n    scale = 2 },\n]\n",
            "line 2: not TOML: an inline table is broken",
        ),
        (
            "strokes = [\n  { polyline = [[1, 2],\n  [3, 4]],\n  closed = true },\n]\n",
            "line 3: not TOML: an inline table is",
        ),
        ("cell = {\n  a = 60\n}\n", "line 1: not TOML: an inline table is broken"),
        ("cell = { a = 60 # mm\n}\n", "line 1: not TOML: an inline table is broken"),
        ("cell = { a = 60, }\n", "line 1: not TOML: an inline table ends in a comma"),
        ("cell = { a = 60 ]\n", "not TOML: unclosed inline table"),
        ("cell.\n", "not TOML: invalid initial character"),
        ('name = "{\n"\n', "not TOML: illegal character"),
    ],
)
def test_a_broken_inline_table_says_what_to_do(text: str, message: str) -> None:
    """TOML wants one on one line, which many expect otherwise; other slips are not taken for it."""
    with pytest.raises(DesignError) as caught:
        Design.loads(f"schema = 1\n{text}", format="toml")
    line = re.sub(r"line (\d)", lambda found: f"line {int(found[1]) + 1}", message)
    assert line in str(caught.value)
    assert caught.value.remedy
