"""Colours of tiles by every scheme: by shapely on what is cut, and by what the exact tiles are."""

from __future__ import annotations

from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest
import shapely
from helpers.cutting import FINE, Copy, contour_shapes, made, plane, whole
from helpers.examples import tiling
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles import Design, DesignError
from voronoi_tiles.designs.starters import starter
from voronoi_tiles.fabrication import tile_colouring
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.fabrication.product import make_several
from voronoi_tiles.fabrication.tile_colouring import colour_tiles
from voronoi_tiles.groups.periodic_colouring import colour_pairs, palette

NAMES = [
    "p1-heron",
    "p2-anchor",
    "pg-wave",
    "cmm-scroll",
    "p3-puzzle",
    "p4-mill",
    "p6-rosette",
    "p4m-rosette",
    "pm-goblet",
]


def coloured(name: str, side: float, **job: Any) -> list[tuple[Any, str]]:
    """The shapes of the pieces on a sheet, each with the name of its layer."""
    product = made(name, sheet=(side, side), edges="pieces", **job)
    layers = [layer for layer in product.drawing.layers if layer.name.startswith("cut")]
    return [(one, layer.name) for layer in layers for one in contour_shapes(layer.paths, 1e-3)]


def alike_neighbours(pieces: list[tuple[Any, str]]) -> int:
    """How many pairs of pieces of one colour share a side."""
    shapes = [one for one, _ in pieces]
    one, two = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=0.01)
    pairs = [(i, j) for i, j in zip(one.tolist(), two.tolist(), strict=True) if i < j and pieces[i][1] == pieces[j][1]]
    return sum(shapes[i].buffer(0.01).intersection(shapes[j].buffer(0.01)).length > 1.0 for i, j in pairs)


@pytest.mark.parametrize("name", ["p1-heron", "p4-mill", pytest.param("p6-rosette", marks=pytest.mark.slow)])
@pytest.mark.parametrize("colours", [4, 5])
def test_so_many_colours_and_no_neighbours_alike(name: str, colours: int) -> None:
    """On clipped sheets, by shapely; all colours come out."""
    design = tiling(name).design
    pieces = coloured(name, round(3.2 * abs(design.lattice.a) * design.unit_mm), fit="clip", colours=colours)
    assert {layer for _, layer in pieces} == {f"cut-{k + 1}" for k in range(colours)}
    assert alike_neighbours(pieces) == 0
    assert alike_neighbours([(one, "cut") for one, _ in pieces]) > len(pieces) / 2  # the measure sees them


@given(st.sampled_from(NAMES), st.integers(1, 12))
@settings(max_examples=25)
def test_colours_are_balanced_or_too_few(name: str, colours: int) -> None:
    """A count is refused below the least that works alone; counts over a repeat differ by a tenth of it at most."""
    tessellation = tiling(name).tessellation
    least = colour_tiles(tessellation, "fewest").count
    if colours < least:
        with pytest.raises(JobError, match=f"with `colours={colours}` neighbours would be alike") as caught:
            colour_tiles(tessellation, colours)
        assert f"Give {least} or more" in str(caught.value)
        return
    found = colour_tiles(tessellation, colours)
    counts = np.bincount(found.colour.ravel(), minlength=colours)
    assert counts.min() > 0
    # Where a site's tile meets all others of a site they cannot be equal: p4m's squares and octagons in three colours.
    uneven = 0.25 if (name, colours) == ("p4m-rosette", 3) else 1 / 16
    assert counts.max() - counts.min() <= uneven * counts.sum()


def test_the_fewest_colours_are_found_once_for_the_same_neighbours(monkeypatch: pytest.MonkeyPatch) -> None:
    """A design that is changed a little has the colours that it had, without another search."""
    monkeypatch.setattr(tile_colouring, "colour_pairs", calls := Mock(wraps=colour_pairs))
    tile_colouring._fewest.cache_clear()
    design = starter("p6").to_dict()
    wide = {**design, "cell": {"a": 1.01 * design["cell"]["a"]}}
    one, two = (
        colour_tiles(Design.from_dict(table).tessellate().tessellation, "fewest").colour for table in (design, wide)
    )
    assert calls.call_count == 1
    assert np.array_equal(one, two)


def kinds(name: str, scheme: str, copy: Copy) -> Any:
    """What a copy is for a scheme, by the exact operation that takes the drawn site there."""
    design = tiling(name).design
    own = tiling(name).tiles[copy.site].symmetry
    images = [copy.operation @ inner for inner in own]
    match scheme:
        case "site":
            return copy.site
        case "handedness":
            return all(design.lattice.isometry(image).conj for image in images)
        case _:
            return frozenset(image.linear for image in images)


@pytest.mark.parametrize("scheme", ["site", "handedness", "orientation"])
@pytest.mark.parametrize("name", ["pg-wave", "cmm-scroll", "p4-mill", "pm-goblet", "p4m-rosette"])
def test_colours_say_what_tiles_are(name: str, scheme: str) -> None:
    """Pieces of a colour are those that the exact operations call alike."""
    design = tiling(name).design
    side = float(round(3.2 * max(abs(design.lattice.a), abs(design.lattice.b)) * design.unit_mm))
    tiles = whole(plane(name, side, side), side, side)
    centres = shapely.STRtree([copy.shape.centroid for copy in tiles])
    found: dict[str, set[Any]] = {}
    pieces = coloured(name, side, colours=scheme)
    assert len(pieces) == len(tiles)
    for one, layer in pieces:
        copy = tiles[int(centres.nearest(one.centroid))]
        assert one.centroid.distance(copy.shape.centroid) < 20 * FINE
        found.setdefault(layer, set()).add(kinds(name, scheme, copy))
    if scheme == "orientation":
        # Tiles of two sites with different symmetry are alike where they can be turned alike.
        assert all(frozenset.intersection(*alike) for alike in found.values())
    else:
        assert all(len(alike) == 1 for alike in found.values())
    assert sum(map(len, found.values())) == len(set.union(*found.values()))  # what is alike has one colour


@pytest.mark.parametrize("colours", ["layers", "fewest"])
def test_files_and_layers_of_any_scheme(colours: str) -> None:
    """`layers` is the fewest on layers, `files` the same in files; `into` says it for every scheme."""
    assert Job(colours=colours).scheme == "fewest"
    assert Job(colours=colours).split == "layers"
    assert (Job(colours="files").scheme, Job(colours="files").split) == ("fewest", "files")
    assert (Job(colours="5", into="files").scheme, Job(colours=5, into="files").split) == (5, "files")
    tiles, job = tiling("pg-wave"), Job(sheet=(170.0, 150.0), kerf=0.3, colours="handedness", into="files")
    products = make_several(tiles.design, tiles.tessellation, job)
    assert [name for name, _ in products] == ["1", "2"]
    assert [set(product.pieces.turned_over.tolist()) for _, product in products] == [{False}, {True}]
    assert tiles.report(job)["colouring"] == "handedness"
    assert tiles.report(Job())["colouring"] is None
    alone = tiling("p4-hook").make(Job(sheet=(170.0, 150.0), kerf=0.3, colours="handedness"))
    assert alone.notes == ("by handedness all tiles are alike: there is one colour",)


@pytest.mark.parametrize(
    ("job", "message"),
    [
        ({"colours": "layers", "into": "files"}, "contradict each other"),
        ({"into": "files"}, "`into` is about colours"),
        ({"colours": "blue"}, "'blue' is unknown"),
        ({"colours": 0}, "0 is unknown"),
        ({"colours": 1000}, "1000 is unknown"),
        ({"colours": True}, "true is unknown"),
        ({"colours": 2.0}, "is unknown"),
    ],
)
def test_colours_that_cannot_be(job: dict[str, Any], message: str) -> None:
    """One message each, with a remedy."""
    with pytest.raises(JobError, match=message) as caught:
        Job(**job)
    assert caught.value.remedy
    assert not isinstance(caught.value, DesignError)


@pytest.mark.parametrize(
    ("name", "colours"),
    [("pg-wave", "handedness"), ("p3-puzzle", 5), ("p4-mill", "orientation"), ("p1-heron", 3)],
)
def test_pictures_show_the_colours_that_are_cut(name: str, colours: int | str) -> None:
    """Wherever a piece of a layer lies, the picture has the colour of that layer."""
    tiles, side = tiling(name), 150.0
    pieces = [(one, layer) for one, layer in coloured(name, side, colours=colours, fit="clip") if one.area > 20]
    half = side / 2 / tiles.design.unit_mm
    picture = tiles.render(size=450, region=(-half, -half, half, half), colours=colours, renderer="cpu").pixels
    woods = [tuple(row) for row in palette(len({layer for _, layer in pieces})).tolist()]
    found = 0
    for one, layer in pieces:
        point = one.representative_point()
        colour = tuple(picture[round(449 - point.y * 3), round(point.x * 3)].tolist())
        if colour in woods:  # no border, and no stroke
            assert colour == woods[int(layer.removeprefix("cut-")) - 1]
            found += 1
    assert found > len(pieces) / 2


def test_colours_of_a_picture_that_cannot_be() -> None:
    """They are refused as those of a job."""
    with pytest.raises(JobError, match="'blue' is unknown"):
        tiling("pg-wave").render(size=8, colours="blue", renderer="cpu")
