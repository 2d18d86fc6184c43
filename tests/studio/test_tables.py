"""What the page knows of groups, strokes and jobs: it is all there, in the types of JSON, and right."""

from __future__ import annotations

import itertools
import json
from typing import Any, get_args

import numpy as np
import pytest
import shapely

from voronoi_tiles.designs.design import Design
from voronoi_tiles.designs.drawn_solid import Solid
from voronoi_tiles.designs.drawn_strokes import StrokeKind
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.formats.presets import FORMATS, load_preset
from voronoi_tiles.groups.wallpaper import GROUPS
from voronoi_tiles.pictures.picture_size import DEFAULT_SIZE
from voronoi_tiles.solid.solid_job import SolidJob
from voronoi_tiles.studio.tables import page_tables, starter_designs

TABLES: dict[str, Any] = json.loads(json.dumps(page_tables(), allow_nan=False))
BY_NAME = {group["name"]: group for group in TABLES["groups"]}


def moved(operation: dict[str, Any], x: Any, y: Any) -> tuple[Any, Any]:
    """The image of fractional coordinates under an operation, as the page computes it."""
    (p, q, r, s), (u, v) = operation["w"], operation["t"]
    return p * x + q * y + u, r * x + s * y + v


@pytest.mark.parametrize("name", GROUPS)
def test_an_asymmetric_unit_is_one_of_each(name: str) -> None:
    """Of the images of any point exactly one, modulo the lattice, is in the region; and it has the right area."""
    group = BY_NAME[name]
    region = shapely.Polygon(group["region"])
    assert region.is_valid
    assert region.area * group["order"] == pytest.approx(1.0, abs=1e-12)
    x, y = np.random.default_rng(len(group["operations"])).random((2, 200))
    images = [np.array(moved(operation, x, y)) % 1.0 for operation in group["operations"]]
    shifts = itertools.product((-1, 0, 1), repeat=2)
    inside = [shapely.contains_xy(region, u + i, v + j) for (i, j), (u, v) in itertools.product(shifts, images)]
    assert (np.sum(inside, axis=0) == 1).all()


@pytest.mark.parametrize("name", GROUPS)
def test_operations_are_as_they_are_called(name: str) -> None:
    """The matrix and the translation of an operation do what its triplet says, the identity first."""
    group = BY_NAME[name]
    assert len(group["operations"]) == group["order"]
    assert group["operations"][0]["name"] == "x,y"
    for operation in group["operations"]:
        assert all(isinstance(part, int) for part in operation["w"])
        expected = eval(operation["name"].replace("/", "*1.0/"), {"x": 0.1, "y": 0.03})  # noqa: S307 - our own table
        assert moved(operation, 0.1, 0.03) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("name", GROUPS)
def test_elements_are_where_operations_leave_points(name: str) -> None:
    """Each centre and each point of a mirror is its own image under some operation, modulo the lattice."""
    group = BY_NAME[name]

    def orders(x: float, y: float) -> int:
        """How many operations leave a point where it is."""
        images = [moved(operation, x, y) for operation in group["operations"]]
        return sum(abs(u - x - round(u - x)) + abs(v - y - round(v - y)) < 1e-9 for u, v in images)

    for centre in group["centres"]:
        assert orders(*centre["at"]) % centre["order"] == 0
    for line in group["mirrors"]:
        (x, y), (p, q) = line["through"], line["along"]
        assert all(orders(x + t * p, y + t * q) >= 2 for t in (0.0, 0.1234, 0.789))
    for line in group["glides"]:
        (x, y), (p, q) = line["through"], line["along"]
        assert orders(x + 0.1234 * p, y + 0.1234 * q) == 1
        images = [moved(operation, x + 0.1234 * p, y + 0.1234 * q) for operation in group["operations"]]
        offsets = [q * (u - x) - p * (v - y) for u, v in images]
        assert sum(abs(offset - round(offset)) < 1e-9 for offset in offsets) >= 2  # it comes back to the line


def test_a_cell_has_what_its_group_leaves_free() -> None:
    """A design with just these keys in its cell can be used, and with one less it cannot."""
    strokes = [{"point": [1.0, 2.0]}]
    given = {"a": 60.0, "b": 50.0, "angle": 80.0}
    for group in TABLES["groups"]:
        cell = {key: given[key] for key in group["free"]}
        design = {"schema": 1, "group": group["name"], "site": [{"strokes": strokes}]}
        lattice = Design.from_dict({**design, "cell": cell}).lattice
        assert group["angle"] is None or "angle" not in cell
        assert lattice.det > 0
        for key in cell:
            with pytest.raises(ValueError, match=key):
                Design.from_dict({**design, "cell": {name: cell[name] for name in cell if name != key}})


def test_a_job_can_be_made_of_its_defaults() -> None:
    """Every option but the hidden one is there, and its default is one that a job takes."""
    options = {option["name"]: option for option in TABLES["job"]}
    assert set(Job.options()) - set(options) == {"only_colour"}
    assert Job(**{name: option["default"] for name, option in options.items()}) == Job()
    assert all(option["help"] for option in options.values())
    assert options["fit"]["words"] == ["whole", "clip", "frame"]
    solid = {option["name"]: option for option in TABLES["solid"]}
    assert set(SolidJob.options()) == set(solid)
    assert SolidJob(**{name: option["default"] for name, option in solid.items()}) == SolidJob()
    assert TABLES["solids"] == ["3mf", "stl", "png"]
    assert TABLES["layers"] == Solid(20).layers


def test_presets_kinds_and_formats_are_all_there() -> None:
    """The page offers what there is."""
    for preset in TABLES["presets"]:
        assert load_preset(preset["name"]).name == preset["name"]
        assert preset["title"]
    assert {"plain", "lightburn", "glowforge"} <= {preset["name"] for preset in TABLES["presets"]}
    assert TABLES["kinds"] == list(get_args(StrokeKind))
    assert set(TABLES["formats"]) == {*FORMATS, "json", "png"}
    assert TABLES["coupon"] == list(FORMATS)
    assert TABLES["limits"]["picture"] == DEFAULT_SIZE
    assert TABLES["limits"]["drop"] == 16 * 2**20  # as tests/studio/test_drop.py has it
    assert TABLES["units"] == {"mm": 1.0, "cm": 10.0, "in": 25.4}


def test_there_is_a_starter_of_every_group() -> None:
    """Each is a design of its group, with all copies of its tiles in a cell, whose rings are whole."""
    designs = json.loads(json.dumps(starter_designs()))
    assert [example["group"] for example in designs] == list(GROUPS)
    for example in designs:
        design = Design.from_dict(example["design"])
        assert design.group.name == example["group"]
        assert example["title"]
        for sent, tile in zip(example["tiles"], design.tessellate(), strict=True):
            assert len(sent["operations"]) == tile.copies_per_cell
            assert sent["path"].count("Z") == len(tile.outline.ring_areas)
