"""What places strokes, sites, art and whole designs: against maps of the plane that are composed independently."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import voronoi_tiles as vt
from voronoi_tiles.base.maps import Placement

POINTS = [(5.0, 3.0), (25.0, 11.0), (14.0, 22.0)]
CURVE = "M 5 3 C 12 20 20 -4 25 11 A 7 4 30 0 1 14 22"

PLACEMENTS = st.fixed_dictionaries(
    {},
    optional={
        "mirror": st.booleans(),
        "scale": st.sampled_from([0.5, -1.0, 0.8, 1.25]),
        "rotate": st.sampled_from([90.0, 30.0, -17.0, 200.0]),
        "translate": st.sampled_from([(1.0, -2.0), (-0.5, 0.25)]),
    },
)


def matrix(keys: dict[str, Any]) -> np.ndarray:
    """The affine map of placement keys as a 3 x 3 matrix: mirror, then scale, rotate, translate."""
    turn = math.radians(keys.get("rotate", 0.0))
    dx, dy = keys.get("translate", (0.0, 0.0))
    steps = [
        np.diag([-1.0 if keys.get("mirror") else 1.0, 1.0, 1.0]),
        np.diag([keys.get("scale", 1.0)] * 2 + [1.0]),
        np.array([[math.cos(turn), -math.sin(turn), 0.0], [math.sin(turn), math.cos(turn), 0.0], [0.0, 0.0, 1.0]]),
        np.array([[1.0, 0.0, dx], [0.0, 1.0, dy], [0.0, 0.0, 1.0]]),
    ]
    whole = np.eye(3)
    for step in steps:
        whole = step @ whole
    return whole


def image(whole: np.ndarray, points: Any) -> np.ndarray:
    """Points, float (n, 2), under a map."""
    found: np.ndarray = np.column_stack((np.asarray(points), np.ones(len(points)))) @ whole[:2].T
    return found


def plane(z: np.ndarray) -> np.ndarray:
    """Complex numbers as pairs."""
    return np.column_stack((z.real, z.imag))


@settings(max_examples=20, deadline=None)
@given(stroke=PLACEMENTS, site=PLACEMENTS, factor=st.sampled_from([1.0, 1.5]), form=st.sampled_from(["toml", "json"]))
def test_strokes_are_placed_by_their_own_keys_their_site_and_the_scale(
    stroke: dict[str, Any], site: dict[str, Any], factor: float, form: str
) -> None:
    """Every point is where the three maps take it, one after the other; files and Python agree; nothing is lost."""
    table = {
        "schema": 1,
        "group": "p1",
        "scale": factor,
        "cell": {"a": 900, "b": 900, "angle": 90},
        "site": [{"strokes": [{"polyline": POINTS, **stroke}], "art": {"file": "face.svg", **stroke}, **site}],
    }
    design = vt.Design.from_dict(table)
    whole = matrix({"scale": factor}) @ matrix(site) @ matrix(stroke)
    assert np.abs(plane(design.noded[0].nodes) - image(whole, POINTS)).max() < 1e-12
    assert design.lattice.a == 900 * factor
    (art,) = design.art
    assert art is not None
    assert np.abs(plane(art.placement(np.array([complex(*z) for z in POINTS]))) - image(whole, POINTS)).max() < 1e-12
    built = vt.Design(
        "p1",
        (900, 900, 90),
        vt.Site([vt.polyline(POINTS, **stroke)], art=vt.Art("face.svg", **stroke), **site),
        scale=factor,
    )
    assert built.sites[0].strokes == design.sites[0].strokes
    text = design.to_toml() if form == "toml" else json.dumps(design.to_dict())
    again = vt.Design.loads(text, format=form)
    assert design == built.replace(sites=vt.Site(built.sites[0].strokes, name="site1", art=built.sites[0].art, **site))
    assert again == design
    assert hash(again) == hash(design)
    assert again.noded[0].nodes.tobytes() == design.noded[0].nodes.tobytes()


@settings(max_examples=20, deadline=None)
@given(outer=PLACEMENTS, inner=PLACEMENTS)
def test_placements_compose_and_invert(outer: dict[str, Any], inner: dict[str, Any]) -> None:
    """P @ Q is Q and then P; the inverse brings every point back."""

    def placement(keys: dict[str, Any]) -> Placement:
        return Placement(
            keys.get("scale", 1.0),
            keys.get("rotate", 0.0),
            complex(*keys.get("translate", (0.0, 0.0))),
            keys.get("mirror", False),
        )

    z = np.array([complex(*point) for point in POINTS])
    both = placement(outer) @ placement(inner)
    assert np.abs(plane(both(z)) - image(matrix(outer) @ matrix(inner), POINTS)).max() < 1e-12
    assert np.abs(both.inverse(both(z)) - z).max() < 1e-12
    factor, shift, mirrored = both.similarity
    assert np.abs(factor * (z.conj() if mirrored else z) + shift - both(z)).max() < 1e-12


@pytest.mark.parametrize(("group", "factor"), [("p4", 1.5), ("pg", 0.25), ("p6", 3)])
def test_the_scale_of_a_design_is_scaled_numbers(group: str, factor: float) -> None:
    """The key, `scaled`, and a file with all numbers multiplied by hand give one outline document."""
    curve = [(8.0, 4.0), (12.0, 16.0), (18.0, -2.0), (24.0, 6.0)]
    cell = {"a": 60.0, "b": 52.0} if group == "pg" else {"a": 60.0}

    def table(by: float, **more: float) -> dict[str, Any]:
        return {
            "schema": 1,
            "group": group,
            **more,
            "cell": {name: by * side for name, side in cell.items()},
            "site": [{"strokes": [{"bezier": [[by * x, by * y] for x, y in curve]}]}],
        }

    keyed = vt.Design.from_dict(table(1.0, scale=factor)).tessellate()
    assert keyed.json() == vt.Design.from_dict(table(1.0)).scaled(factor).tessellate().json()
    by_hand = vt.Design.from_dict(table(factor)).tessellate()
    assert keyed.document()["cell"] == by_hand.document()["cell"]
    assert np.allclose(keyed[0].site.elements, by_hand[0].site.elements, rtol=1e-14, atol=1e-13)
    assert keyed[0].area == pytest.approx(by_hand[0].area, rel=1e-13)
    assert vt.Design.from_dict(table(1.0, scale=factor)) == vt.Design.from_dict(table(1.0)).scaled(factor)
    assert vt.Design.from_dict(table(1.0, scale=factor)) != vt.Design.from_dict(table(1.0))


def test_equal_designs_are_moved_alike() -> None:
    """By lengths in the design's units, whether its size stands in its numbers or in its scale."""
    keyed = vt.Design("p4", 60, vt.Site([vt.polyline(POINTS)], rotate=20, translate=4), scale=1.5)
    written = vt.Design("p4", 90, vt.Site([vt.polyline(POINTS, scale=1.5)], rotate=20, translate=6))
    assert keyed == written
    moves: dict[str, Any] = {"mirror": True, "scale": 0.5, "rotate": 30, "translate": (10, -4)}
    moved = keyed.moved(**moves)
    assert moved == written.moved(**moves)
    assert np.abs(plane(moved.noded[0].nodes) - image(matrix(moves), plane(keyed.noded[0].nodes))).max() < 1e-12


def test_tolerances_are_not_scaled() -> None:
    """They say how exact the product is: a larger design has more segments, not coarser ones."""
    design = vt.Design("p1", (900, 900, 90), vt.Site([vt.path(CURVE)], tolerance=0.01))
    assert len(design.replace(scale=100).noded[0].segments) > 5 * len(design.noded[0].segments)


@pytest.mark.parametrize(("key", "side"), [("tile_width", 0), ("tile_height", 1)])
@pytest.mark.parametrize("group", ["p4m", "p3"])
def test_a_tile_gets_the_size_that_is_asked_for(group: str, key: str, side: int) -> None:
    """The largest tile of several; in the design's units."""
    fitted = vt.starter(group).replace(units="cm").scaled(**{key: 9.5})
    sizes = [tile.outline.bounds[side + 2] - tile.outline.bounds[side] for tile in fitted.tessellate()]
    assert max(sizes) == pytest.approx(9.5, rel=1e-8)
    with pytest.raises(vt.DesignError, match=f"{key}: must be greater than 0"):
        vt.starter(group).scaled(**{key: 0.0})
    with pytest.raises(vt.DesignError, match="Give one"):
        vt.starter(group).scaled(2, **{key: 9.5})


def test_art_is_mirrored_as_strokes_are(tmp_path: Path) -> None:
    """Art that traces the strokes still does, however the site is placed, and the template says where art goes."""
    (tmp_path / "face.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="40mm" viewBox="0 0 40 40">'
        '<path d="M 5 37 L 25 29 14 18" fill="none" stroke="black"/></svg>'
    )
    placed: dict[str, Any] = {"mirror": True, "rotate": 30.0, "scale": 0.8, "translate": (40.0, 8.0)}
    site = vt.Site([vt.polyline(POINTS)], name="bird", art="face.svg", **placed)
    design = vt.Design("p4", 70, site, scale=1.5, folder=tmp_path)
    tiling = design.tessellate()
    product = tiling.make(vt.Job())
    (engraved,) = (layer for layer in product.drawing.layers if layer.work == "engrave")
    drawn = np.append(engraved.paths.start, engraved.paths.end[-1])
    # The outline's box lies in the middle of the page.
    left, bottom, right, top = tiling[0].outline.bounds
    page = product.drawing
    corner = ((left + right - page.width) / 2, (bottom + top - page.height) / 2)
    expected = image(matrix({"scale": 1.5}) @ matrix(placed), POINTS) - corner
    assert np.abs(plane(drawn) - expected).max() < 1e-6
    art = tiling.template(tmp_path / "page.svg")
    laid = vt.Site([vt.polyline(POINTS)], name="bird", art=art, **placed)
    (effective,) = design.replace(sites=laid).art
    assert effective is not None
    assert effective.placement.scale == pytest.approx(1.0)
    assert effective.placement.rotate == pytest.approx(0.0)
    assert not effective.placement.mirror
