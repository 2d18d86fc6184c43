"""Sweeps as they are described: how numbers vary, and what is refused."""

from __future__ import annotations

import json
import math
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import voronoi_tiles as vt
from voronoi_tiles.designs.parameters import chosen_parameters, values_of
from voronoi_tiles.sweeps.sweep import Sweep

STROKE = "site[0].strokes[0]"


def value(design: vt.Design, name: str) -> float:
    """A number of a design."""
    return values_of(design, chosen_parameters(design, [name]))[0]


def test_a_grid_has_every_combination_once_the_last_number_fastest() -> None:
    """Without a count the designs are all combinations, in the order of the file."""
    vary = {"group": ["p4", "p3"], "cell.a": {"from": 60, "to": 80, "steps": 3}, "site[0].rotate": [0, 5]}
    sweep = Sweep(vt.starter("p4"), vary)
    assert len(sweep) == 12
    made = [sweep.variant(k) for k in range(12)]
    found = [(one.group.name, value(one, "cell.a"), value(one, "site[0].rotate")) for one in made]
    assert found == [(g, a, r) for g in ("p4", "p3") for a in (60.0, 70.0, 80.0) for r in (0.0, 5.0)]


def test_random_designs_have_their_numbers_from_where_they_may_be() -> None:
    """Each kind of variation keeps to its bounds and reaches them nearly, and normal ones have their deviation."""
    vary = {
        "cell.a": {"from": 50, "to": 80},
        f"{STROKE}.catmull_rom[0]": {"around": 2},
        f"{STROKE}.catmull_rom[1]": {"deviation": 3},
        "site[0].rotate": [0, 90, 180],
        "scale": {"from": 1, "to": 2, "steps": 3},
    }
    sweep = Sweep(vt.starter("p4"), vary, count=1000, seed=3)
    assert sweep.varied == (
        "cell.a",
        *(f"{STROKE}.catmull_rom[{k}][{j}]" for k in (0, 1) for j in (0, 1)),
        "site[0].rotate",
        "scale",
    )
    drawn = np.array([sweep.values(k)[1] for k in range(1000)])
    assert drawn[:, 0].min() >= 50
    assert drawn[:, 0].max() <= 80
    assert np.ptp(drawn[:, 0]) > 29
    assert np.abs(drawn[:, 1] - 6).max() <= 2
    assert np.abs(drawn[:, 2] - 9).max() <= 2
    assert np.ptp(drawn[:, 1]) > 3.9
    assert drawn[:, 3].mean() == pytest.approx(22, abs=0.4)
    assert drawn[:, 4].std() == pytest.approx(3, abs=0.3)
    assert set(drawn[:, 5]) == {0, 90, 180}
    assert set(drawn[:, 6]) == {1, 1.5, 2}
    assert abs(np.corrcoef(drawn[:, 1], drawn[:, 2])[0, 1]) < 0.15
    assert value(sweep.variant(17), "cell.a") == drawn[17, 0]


def test_a_design_is_the_same_however_many_there_are() -> None:
    """The seed and the number of a design say all: more designs are others on top, another seed gives others."""
    vary = {"cell.a": {"from": 50, "to": 80}}
    few, many, other = (Sweep(vt.starter("p4"), vary, count=n, seed=s) for n, s in ((5, 1), (50, 1), (5, 2)))
    assert [few.values(k) for k in range(5)] == [many.values(k) for k in range(5)]
    assert few.values(0) != other.values(0)


def test_in_another_group_strokes_stay_and_the_cell_keeps_what_is_free() -> None:
    """The cell keeps its sides and angle as far as the group leaves them free; other numbers of it are left out."""
    design = vt.starter("p1")
    sweep = Sweep(design, {"group": "all", "cell.a": [66], "cell.b": [40], "cell.angle": [70]})
    assert len(sweep) == 17
    for number, (name, group) in enumerate(vt.GROUPS.items()):
        made = sweep.variant(number)
        assert made.group.name == name
        free = {"a": 66.0, "b": 40.0, "angle": 70.0}
        dropped = ({"b"} if group.fixes_b else set()) | ({"angle"} if group.fixed_angle is not None else set())
        assert made.cell == {key: free[key] for key in free if key not in dropped}
        assert made.sites == design.sites
        assert [each is None for each in sweep.values(number)[1]] == [key in dropped for key in free]
    oblique = Sweep(vt.starter("p3"), {"group": ["p1", "pg"]})
    assert oblique.variant(0).cell == pytest.approx({"a": 60.0, "b": 60.0, "angle": 120.0})
    assert oblique.variant(1).cell == pytest.approx({"a": 60.0, "b": 60.0})


def test_a_file_is_the_same_as_python(tmp_path: Path) -> None:
    """A sweep file with its design beside it, in it, or a starter's name, is the sweep that Python makes."""
    vt.starter("p4").save(tmp_path / "bird.toml")
    rest = 'count = 10\nseed = 4\nfilter = "neck > 3"\nsort = ["-area", "neck"]\nkeep = 5\n'
    tables = '[vary]\n"cell.a" = { from = 50, to = 80 }\n[job]\nsheet = "30x20cm"\nmargin = 5\n'
    (tmp_path / "named.toml").write_text(f'schema = 1\ndesign = "bird.toml"\n{rest}{tables}')
    (tmp_path / "starter.toml").write_text(f'design = "p4"\n{rest}{tables}')
    within: dict[str, Any] = {
        "design": vt.starter("p4").to_dict(),
        "count": 10,
        "seed": 4,
        "vary": {"cell.a": {"from": 50, "to": 80}},
    }
    within |= {"filter": "neck > 3", "sort": ["-area", "neck"], "keep": 5, "job": {"sheet": "30x20cm", "margin": 5}}
    (tmp_path / "within.json").write_text(json.dumps(within))
    job = {"sheet": "30x20cm", "margin": 5}
    made = Sweep(
        vt.starter("p4"), within["vary"], count=10, seed=4, job=job, filter="neck > 3", sort=["-area", "neck"], keep=5
    )
    for name in ("named.toml", "starter.toml", "within.json"):
        read = Sweep.load(tmp_path / name)
        assert read.identity == made.identity
        assert (len(read), read.filter, read.sort, read.keep) == (10, "neck > 3", ("-area", "neck"), 5)
        assert read.variant(3) == made.variant(3)
    again = Sweep.of_identity(json.loads(json.dumps(made.identity)), 10)
    assert again.variant(7) == made.variant(7)
    assert again.columns == made.columns


def test_numbers_of_other_libraries_are_those_of_python() -> None:
    """Numbers and arrays of numpy's, and fractions, make the sweep of plain ones, also in another process."""
    vary = {
        "group": np.array(["p4", "p3"]),
        "cell.a": np.linspace(50, 80, 4),
        "site[0].rotate": {"from": np.int64(1), "to": Fraction(5, 2), "steps": np.int8(3)},
    }
    plain = {
        "group": ["p4", "p3"],
        "cell.a": [50.0, 60.0, 70.0, 80.0],
        "site[0].rotate": {"from": 1, "to": 2.5, "steps": 3},
    }
    sheet = {"sheet": (600, 300), "kerf": np.float32(0.25)}
    one, other = Sweep(vt.starter("p4"), vary, job=sheet), Sweep(vt.starter("p4"), plain, job=sheet | {"kerf": 0.25})
    assert json.dumps(one.identity) == json.dumps(other.identity)
    assert one.made_job == other.made_job
    again = Sweep.of_identity(json.loads(json.dumps(one.identity)), len(one))
    assert [again.values(k) for k in range(len(one))] == [other.values(k) for k in range(len(other))]


GOOD: dict[str, Any] = {"design": "p4", "count": 3, "vary": {"cell.a": {"from": 50, "to": 80}}}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"design": None}, "sweep.toml, design: must be a file's name, not nothing. Write design = "),
        ({"design": "p5"}, "p5, design: cannot read the design"),
        ({"design": {"schema": 1, "group": "p9"}}, "design.group: "),
        ({"schema": 2}, "schema: schema 2 is not supported"),
        ({"sead": 3}, "unknown key 'sead'. Did you mean \"seed\"?"),
        ({"count": 0}, "count: must be a whole number from 1 to 1,000,000, not 0"),
        ({"count": 2.5}, "count: must be a whole number"),
        ({"seed": -1}, "seed: must be a whole number from 0"),
        ({"keep": 1001}, "keep: must be a whole number from 0 to 1,000"),
        ({"vary": {}}, "vary: must be a table of numbers that vary"),
        ({"vary": {"cell.c": [1]}}, "vary.cell.c: is no number of the design. Numbers are cell.a, "),
        ({"vary": {"cell.b": [1]}}, "vary.cell.b: is no number of the design"),
        ({"vary": {"cell.a": 60}}, "vary.cell.a: must be an array, not 60. Write { from = 40, to = 80 }"),
        ({"vary": {"cell.a": []}}, "vary.cell.a: has no values"),
        ({"vary": {"cell.a": ["p4"]}}, "vary.cell.a[0]: must be a number"),
        ({"vary": {"cell.a": {"from": 80, "to": 50}}}, "vary.cell.a.to: must be greater than 80"),
        ({"vary": {"cell.a": {"from": 80}}}, "vary.cell.a.to: is missing"),
        ({"vary": {"cell.a": {}}}, "vary.cell.a: must say one way to vary"),
        ({"vary": {"cell.a": {"from": 1, "to": 2, "around": 3}}}, "vary.cell.a: must say one way to vary"),
        ({"vary": {"cell.a": {"deviation": 0}}}, "vary.cell.a.deviation: must be greater than 0"),
        ({"vary": {"cell.a": {"deviation": 1, "steps": 3}}}, "steps: a normal distribution has no steps"),
        ({"vary": {"cell.a": {"around": 1, "steps": 1}}}, "vary.cell.a.steps: must be a whole number from 2"),
        ({"vary": {"cell.a": {"around": 1, "spteps": 1}}}, 'Did you mean "steps"?'),
        ({"vary": {"cell.a": {"around": 1, "steps": math.inf}}}, "vary.cell.a.steps: must be a whole number from 2"),
        ({"vary": {"cell.a": {"around": 1, "steps": math.nan}}}, "vary.cell.a.steps: must be a whole number from 2"),
        ({"vary": {"group": "p4"}}, "vary.group: must be an array, not 'p4'"),
        ({"vary": {"group": ["p5"]}}, "vary.group[0]: unknown group 'p5'"),
        ({"vary": {"cell.a": [50], "group": ["p3"]}}, "vary.group: comes first"),
        ({"vary": {"cell": [50], "cell.a": [50]}}, "vary.cell.a: cell.a varies already"),
        ({"count": None}, "vary.cell.a: has no steps, which a grid needs"),
        (
            {"count": None, "vary": {"site[0]": {"around": 1, "steps": 100}}},
            "vary: the values make 10,000,000,000,000,000",
        ),
        ({"job": {"margin": 5}}, "job.sheet: is missing"),
        ({"job": {"sheet": "leaf.svg"}}, "job.sheet: 'leaf.svg' is no size"),
        ({"job": {"sheet": "30x20cm", "layout": "nested"}}, "job: unknown key 'layout'"),
        ({"job": {"sheet": "30x20cm", "margin": 500}}, "job: a `margin` of 500 mm leaves nothing"),
        ({"filter": "nek > 3"}, 'filter: there is no column nek. Did you mean "neck"?'),
        ({"filter": "area"}, "filter: is a number, not a condition"),
        ({"filter": 3}, "filter: must be a text, not 3"),
        ({"sort": "pieces"}, "sort: there is no column pieces"),
        ({"sort": 3}, "sort: must be an array, not 3"),
        ({"sort": {"area": 3}}, "sort: must be an array, not a table"),
        ({"sort": ["area", 3]}, "sort: must be a text, not 3"),
    ],
)
def test_what_can_be_no_sweep_is_refused(change: dict[str, Any], message: str) -> None:
    """One message names the file, the key and the remedy."""
    table = {key: found for key, found in {**GOOD, **change}.items() if found is not None or key == "design"}
    with pytest.raises(vt.DesignError) as raised:
        Sweep.from_dict(table, file="sweep.toml")
    assert message in str(raised.value)
    assert str(raised.value).startswith(("sweep.toml", "p5"))


@pytest.mark.parametrize("text", ["", "design = \n", "\xff", "count = 3", "[1]"])
def test_what_is_no_sweep_file_is_refused(text: str, tmp_path: Path) -> None:
    """One message names the file."""
    (tmp_path / "sweep.toml").write_bytes(text.encode("latin-1"))
    with pytest.raises(vt.DesignError, match=r"sweep\.toml"):
        Sweep.load(tmp_path / "sweep.toml")


@pytest.mark.parametrize("number", [-1, 3, 1.0, "1"])
def test_designs_that_are_not_there_are_refused(number: Any) -> None:
    """The message says which numbers there are."""
    with pytest.raises(vt.ArgumentError, match="Designs are 0 to 2"):
        Sweep.from_dict(GOOD).variant(number)
