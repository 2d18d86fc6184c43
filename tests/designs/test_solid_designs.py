"""Designs that stand: what a solid's keys and motion are read as, what is refused, and that nothing gets lost."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path

import pytest

import voronoi_tiles as vt
from voronoi_tiles.studio.design_document import Document
from voronoi_tiles.studio.outlining import Outliner

FLAT = """\
schema = 1
group = "p4"

[cell]
a = 60

[[site]]
name = "bird"
strokes = [
  { segment = [[5, 3], [25, 11]] },
  { circle = [15, 14], radius = 2 },
]
"""

SOLID = """
[solid]
height = 20 # of a coaster
turn = 30
about = [15, 7]

[[key]] # half way up
z = 10
strokes = [
  { segment = [[5, 3], [25, 13]] },
  { circle = [15, 16], radius = 3 },
]
"""


def test_a_solid_is_read() -> None:
    """Height, motion and keys are there, and what is not written has its default."""
    design = vt.Design.loads(FLAT + SOLID)
    assert design.solid is not None
    assert (design.solid.height, design.solid.layers, design.solid.turn) == (20, 5, 30)
    assert (design.solid.shift, design.solid.scale, design.solid.about) == (0j, 1.0, 15 + 7j)
    (key,) = design.solid.keys
    assert (key.z, key.site, len(key.strokes)) == (10, None, 2)


@pytest.mark.parametrize("how", ["toml", "json", "source", "dict"])
def test_a_solid_comes_back_from_every_form(how: str) -> None:
    """What is written of a design is read as an equal one, and a flat one is another."""
    design = vt.Design.loads(FLAT + SOLID)
    back = {
        "toml": lambda: vt.Design.loads(design.to_toml()),
        "json": lambda: vt.Design.loads(json.dumps(design.to_dict())),
        "source": lambda: vt.Design.loads(design.source),
        "dict": lambda: vt.Design.from_dict(design.to_dict()),
    }[how]()
    assert back == design
    assert hash(back) == hash(design)
    assert back.solid == design.solid
    assert back != vt.Design.loads(FLAT)


def test_a_solid_from_python_is_that_of_the_file() -> None:
    """Solid and Key say what the tables say."""
    keys = [vt.Key(10, [vt.segment(5 + 3j, 25 + 13j), vt.circle(15 + 16j, 3)])]
    site = vt.Site([vt.segment(5 + 3j, 25 + 11j), vt.circle(15 + 14j, 2)], name="bird")
    made = vt.Design("p4", 60, site, solid=vt.Solid(20, turn=30, about=(15, 7), keys=keys))
    assert made == vt.Design.loads(FLAT + SOLID)


def test_the_tiles_of_a_solid_design_are_those_of_its_drawing() -> None:
    """What is above the drawing changes nothing of what is cut."""
    flat, solid = (vt.Design.loads(text).tessellate() for text in (FLAT, FLAT + SOLID))
    assert flat.text("svg").partition("<path")[2].partition("/>")[0]
    assert flat["bird"].svg_path() == solid["bird"].svg_path()


def test_scaling_a_design_scales_its_solid() -> None:
    """A design twice as large stands twice as high, whether its numbers are scaled or its scale is set."""
    design = vt.Design.loads(FLAT + SOLID)
    twice = design.scaled(2)
    assert twice == design.replace(scale=2.0)
    assert twice.standing is not None
    assert design.standing is not None
    assert (twice.standing.height, twice.standing.about) == (40.0, 30 + 14j)
    assert twice.standing.sites[0].keys[1].z == 20.0
    low, high = (solid.sites[0].keys[1].strokes[0][0] for solid in (design.standing, twice.standing))
    assert high.tolist() == (2 * low).tolist()


def test_moving_a_design_moves_its_solid() -> None:
    """Keys go where strokes go, a mirror turns the motion round, and the height stays."""
    moved = vt.Design.loads(FLAT + SOLID).moved(mirror=True, rotate=90, translate=(1, 2))
    assert moved.solid is not None
    assert (moved.solid.height, moved.solid.turn) == (20, -30)
    assert abs(moved.solid.about - (1j * (-15 + 7j) + 1 + 2j)) < 1e-12
    assert moved.standing is not None
    own, key = (keys.strokes[0][0] for keys in moved.standing.sites[0].keys)
    for points, drawn in ((own, (5 + 3j, 25 + 11j)), (key, (5 + 3j, 25 + 13j))):
        for point, z in zip(points.tolist(), drawn, strict=True):
            assert abs(point - (1j * -z.conjugate() + 1 + 2j)) < 1e-12


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("height = 20", "height = 0", "solid.height: must be greater than 0"),
        ("height = 20", "layers = 20", "solid.height: is missing"),
        ("turn = 30", "turns = 30", "solid: unknown key 'turns'. Did you mean \"turn\"?"),
        ("turn = 30", "layers = 1", "solid.layers: must be a whole number from 2"),
        ("turn = 30", "scale = -1", "solid.scale: must be greater than 0"),
        ("z = 10", "z = 21", "key[0].z: the height 21 is not above 0 and up to 20, the solid's. Write a lower one"),
        ("z = 10", "z = 0", "key[0].z: the height 0 is not above 0 and up to 20, the solid's. The drawing at 0"),
        ("z = 10", "site = 'bird'", "key[0].z: is missing"),
        ("z = 10", "z = 10\nsite = 'fish'", "key[0].site: there is no site 'fish'. Name one of bird."),
        ("z = 10", "zz = 10", "key[0]: unknown key 'zz'"),
        ("z = 10\n", "z = 10\n[[key]]\nz = 12\n", 'key[0].strokes: is missing. Write those of site "bird"'),
        (
            "{ segment = [[5, 3], [25, 13]] }",
            "{ polyline = [[5, 3], [9, 9], [25, 13]] }",
            'key[0].strokes[0]: a polyline of 3 points at the height 10, and site "bird" has a segment of 2 points',
        ),
        (
            "{ circle = [15, 16], radius = 3 },",
            "",
            'key[0].strokes: 1 strokes at the height 10, and site "bird" has 2',
        ),
        ("[solid]\nheight = 20 # of a coaster\nturn = 30\nabout = [15, 7]", "", "key: there are keys, and no solid"),
    ],
)
def test_what_is_refused(old: str, new: str, said: str) -> None:
    """One message names the key, and the height."""
    assert SOLID.count(old) == 1
    with pytest.raises(vt.DesignError) as caught:
        vt.Design.loads(FLAT + SOLID.replace(old, new))
    assert said in str(caught.value)


def test_heights_must_ascend() -> None:
    """A key below the one before it is refused, with both heights."""
    below = SOLID + SOLID[SOLID.index("[[key]]") :].replace("z = 10", "z = 5")
    with pytest.raises(vt.DesignError, match=r"key\[1\].z: the height 5 comes after 10"):
        vt.Design.loads(FLAT + below)


@pytest.mark.parametrize(
    ("below", "message"),
    [
        ("height = 1e-90", r"solid.height: 1e-90 mm is no height from 0.01 to 100,000 mm"),
        ("height = 1e12", r"solid.height: 1e\+12 mm is no height"),
        ("height = 20\nscale = 1e9", r"solid.scale: a site becomes more than 100 times larger than the cell"),
        ("height = 20\nturn = 1e9", r"solid: a site moves by more than 100 times the cell"),
        ("height = 20\nshift = [1e9, 0]", r"solid: a site moves by more than 100 times the cell"),
        ("height = 20\nturn = 90\nabout = [1e12, 1e12]", r"solid: a site moves by more than 100 times the cell"),
    ],
)
def test_what_no_solid_can_be_is_refused_at_once(below: str, message: str) -> None:
    """Each limit is met before anything is computed; with less of the same the design is read."""
    with pytest.raises(vt.DesignError, match=message):
        vt.Design.loads(f"{FLAT}\n[solid]\n{below}\n")
    assert vt.Design.loads(f"{FLAT}\n[solid]\nheight = 20\nturn = 3600\nshift = [200, 0]\nscale = 0.5\n").standing


def test_errors_of_keys_name_arguments_in_python() -> None:
    """A design made in Python is told of its own argument."""
    with pytest.raises(vt.DesignError, match=r"solid.keys\[0\].z: the height 30"):
        vt.Design("p4", 60, vt.Site([vt.segment(5, 9)]), solid=vt.Solid(20, keys=[vt.Key(30, [vt.segment(5, 9)])]))


def test_the_studio_keeps_a_solid(tmp_path: Path) -> None:
    """A stroke that is moved in the page is all that changes in the file; outlines are those of the drawing."""
    file = tmp_path / "bird.toml"
    file.write_text(FLAT + SOLID)
    document = Document(str(file))
    design = document.opened()["design"]
    design["site"][0]["strokes"][0]["segment"][1][0] = 26
    document.save(design)
    document.close()
    assert file.read_text() == (FLAT + SOLID).replace("[25, 11]", "[26, 11]")
    (said,) = Outliner().outlines(1, design, rest=True, tolerance=None)
    assert said.message["unfit"] is None
    del design["site"][0]["strokes"][1]  # a key no longer fits: drawing goes on, and it is said
    first, *_ = Outliner().outlines(1, design, rest=False, tolerance=0.1)
    assert first.message["unfit"]
    (said,) = Outliner().outlines(1, design, rest=True, tolerance=None)
    assert said.message["unfit"]["message"].startswith("Commands will refuse this drawing with its key[0]")
    assert said.message["unfit"]["remedy"]
    tiles = said.message["tiles"]
    assert math.isclose(
        tiles[0]["width"],
        vt.Design.loads(FLAT.replace("[25, 11]", "[26, 11]").replace("  { circle = [15, 14], radius = 2 },\n", ""))
        .tessellate()["bird"]
        .figures()["width"],
    )


def test_drawings_of_keys_are_files_of_the_design(tmp_path: Path) -> None:
    """A key may name a drawing: it is among the files, is looked for beside the design, and in the recipe as a path."""
    for name, end in (("low.svg", 8), ("high.svg", 12)):
        (tmp_path / name).write_text(
            f'<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="20mm" viewBox="0 0 20 20">'
            f'<path d="M 2 2 L {end} 9"/></svg>'
        )
    text = FLAT[: FLAT.index("strokes")] + 'strokes = [{ file = "low.svg" }]\n'
    text += '[solid]\nheight = 5\n[[key]]\nz = 5\nstrokes = [{ file = "high.svg" }]\n'
    (tmp_path / "d.toml").write_text(text)
    design = vt.Design.load(tmp_path / "d.toml")
    assert {Path(file).name for file in design.files} == {"d.toml", "low.svg", "high.svg"}
    assert "svg" not in design.source
    assert vt.Design.loads(design.source) == design
    below = tmp_path / "below"
    below.mkdir()
    design.save(below / "e.toml")
    assert vt.Design.load(below / "e.toml") == design


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: vt.Solid(20, about="here"), "about"),  # type: ignore[arg-type]
        (lambda: vt.Solid(20, shift=(1, 2, 3)), "shift"),
        (lambda: vt.Solid(20, keys=[3]), r"keys\[0\]: must be a Key, not 3"),  # type: ignore[list-item]
        (lambda: vt.Solid(20, keys=3), "keys: must be keys, not 3"),  # type: ignore[arg-type]
        (lambda: vt.Key(5, [7]), "strokes: must be a stroke, not 7"),  # type: ignore[list-item]
        (lambda: vt.Design("p4", 60, vt.Site(vt.segment(5, 9)), solid=5), "solid: must be a Solid, not 5"),  # type: ignore[arg-type]
    ],
)
def test_wrong_arguments_are_named(made: Callable[[], object], said: str) -> None:
    """What is passed is refused with the argument's name, and nothing but a DesignError comes out."""
    with pytest.raises(vt.DesignError, match=said):
        made()
