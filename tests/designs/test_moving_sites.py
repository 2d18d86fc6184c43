"""How strokes move with the numbers of a design: against the strokes of designs with other numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from helpers.finite_differences import changed, value_at

import voronoi_tiles as vt
from voronoi_tiles.designs.moving_sites import MovingSite, moving_lattice, moving_sites
from voronoi_tiles.designs.parameters import (
    Parameter,
    chosen_parameters,
    drawn_parameters,
    placing_parameters,
    values_of,
    with_values,
)

STROKES: list[dict[str, Any]] = [
    {"catmull_rom": [[6, 9], [22, 5], [27, 17], [13, 25]], "alpha": 0.5, "rotate": 10, "scale": 1.2},
    {"catmull_rom": [[6, 29], [22, 35], [27, 57], [13, 45]], "alpha": 0.7, "closed": True, "mirror": True},
    {"catmull_rom": [[6, 29], [22, 36], [27, 57]], "alpha": 0.0},
    {"catmull_rom": [[6, 9], [22, 16]], "alpha": 1.0, "closed": False},
    {"bspline": [[60, 9], [72, 5], [77, 17], [63, 25]], "closed": True, "translate": [1, 2]},
    {"bspline": [[60, -9], [71, -12], [77, -17], [63, -25], [50, -30]]},
    {"bspline": [[60, -9], [71, -12], [77, -17]], "closed": True},
    {"bezier": [[1, 1], [3, 2], [5, -3], [7, 0], [9, 3], [6, 6], [0, 8]]},
    {"hermite": [[-10, 0], [-14, 5], [-3, 9]], "tangents": [[3, 6], [3, -6], [4, 4]], "mirror": True, "rotate": 40},
    {"circle": [-5, -13], "radius": 2, "scale": -1.2, "rotate": 30},
    {"point": [4, -13], "translate": [3, 3]},
    {"segment": [[4, -20], [9, -23]]},
    {"polyline": [[4, -30], [9, -33], [8, -36]], "closed": True},
    {"polyline": [[4, -30], [9, -33], [8, -36], [20, -2]]},
    {"path": "M -30 -30 C -20 -20 -10 -25 -9 -40 A 5 3 20 0 1 -3 -44 L 2 5", "scale": 0.7},
]


def design_of(strokes: list[dict[str, Any]], **site: Any) -> vt.Design:
    """A design in which everything is placed, and mirrored."""
    placed = {"scale": 0.9, "rotate": 20.0, "translate": [1.0, 2.0], "mirror": True}
    table = {"schema": 1, "group": "p1", "scale": 1.5, "cell": {"a": 2000.0, "b": 2100.0, "angle": 80.0}}
    return vt.Design.from_dict({**table, "site": [{**placed, **site, "strokes": strokes}]})


def rates(site: MovingSite) -> np.ndarray[Any, np.dtype[np.complex128]]:
    """The rates of nodes by each parameter: complex128 (n, p)."""
    both = site.rates.toarray()
    return np.asarray(both[0::2] + 1j * both[1::2])


@pytest.mark.parametrize("stroke", STROKES, ids=lambda stroke: f"{next(iter(stroke))}{len(str(stroke))}")
def test_strokes_move_as_those_of_changed_designs(stroke: dict[str, Any]) -> None:
    """By every point, tangent and radius, and by all that places the stroke, its site and the design."""
    design = design_of([stroke])
    parameters = drawn_parameters(design) + placing_parameters(design)
    here = moving_sites(design, parameters)[0]
    table, values = design.to_dict(), values_of(design, parameters)
    judged = 0
    for k, parameter in enumerate(parameters):
        share = 1e-5
        forth, back = (
            moving_sites(with_values(design, [parameter], [values[k] + sign * share]), [])[0].nodes for sign in (1, -1)
        )
        assert len(forth) == len(back) == len(here.nodes)
        np.testing.assert_allclose(rates(here)[:, k], (forth - back) / (2 * share), rtol=0, atol=1e-7)
        judged += 1
    assert judged == len(parameters) >= 12
    # What moves nothing is what it was.
    assert table == design.to_dict()


def test_the_segments_are_those_of_the_design() -> None:
    """Every segment of the strokes is one that the engine has, where strokes neither meet nor cross."""
    design = design_of(STROKES[:1])
    site, noded = moving_sites(design, [])[0], design.noded[0]
    ends = {frozenset(pair) for pair in site.nodes[site.segments].tolist()}
    assert ends == {frozenset(pair) for pair in noded.nodes[noded.segments].tolist()}


def test_points_that_meet_have_a_share_each() -> None:
    """Of each stroke alike, however often it comes by."""
    design = design_of(
        [{"segment": [[1, 1], [5, 1]]}, {"bezier": [[0, 3], [0, 2], [0, 1], [1, 1], [2, 1], [2, 3], [3, 3]]}]
    )
    names = ["site[0].strokes[0].segment[0][0]", "site[0].strokes[1].bezier[3][0]"]
    site = moving_sites(design, chosen_parameters(design, names))[0]
    both = np.abs(rates(site)).min(axis=1)
    assert (both > 0).sum() == 1
    shares = np.abs(rates(site))[both > 0][0]
    np.testing.assert_allclose(shares, [0.675, 0.675], rtol=1e-12)  # half of 1.5 times 0.9


@pytest.mark.parametrize("group", vt.GROUPS)
def test_the_lattice_moves_with_the_cell(group: str) -> None:
    """Both of its vectors, by the numbers that the group leaves free and by the scale."""
    design = vt.starter(group).replace(scale=1.25)
    parameters = chosen_parameters(design, ["cell", "scale"])
    found = moving_lattice(design, parameters)
    for k, parameter in enumerate(parameters):
        share = 1e-6
        other = [
            vt.Design.from_dict(changed({"scale": 1.25, **design.to_dict()}, [(str(parameter), share)], sign)).lattice
            for sign in (1, -1)
        ]
        a, b = ((getattr(other[0], name) - getattr(other[1], name)) / (2 * share) for name in "ab")
        np.testing.assert_allclose(found[:, k], [a.real, a.imag, b.real, b.imag], rtol=0, atol=1e-7)


# --- names ----------------------------------------------------------------------------------------------------------


def test_names_are_places_in_the_file() -> None:
    """Every parameter that is drawn is the number at that place of the design's table."""
    design = design_of(STROKES)
    parameters = drawn_parameters(design)
    table = design.to_dict()
    assert values_of(design, parameters) == [value_at(table, str(parameter)) for parameter in parameters]
    # All numbers but alpha and what places strokes, and those of paths.
    assert (
        len(parameters)
        == 3
        + sum(
            2 * len(s[k]) for s in STROKES for k in list(s)[:2] if isinstance(s[k], list) and isinstance(s[k][0], list)
        )
        + 5
    )


def test_a_part_of_a_name_is_all_below_it() -> None:
    """A stroke, a point, a site, the cell; each number once, in the order that is asked for."""
    design = design_of([STROKES[11], STROKES[9]])

    def chosen(*names: str) -> list[str]:
        return [str(parameter) for parameter in chosen_parameters(design, names)]

    assert chosen("site[0].strokes[0].segment[1]") == [f"site[0].strokes[0].segment[1][{axis}]" for axis in (0, 1)]
    assert len(chosen("site[0].strokes[0]")) == 4
    assert len(chosen("site[0]")) == len(chosen("site")) == 7
    assert chosen("cell.b", "cell") == ["cell.b", "cell.a", "cell.angle"]
    assert chosen("site[0].translate") == ["site[0].translate[0]", "site[0].translate[1]"]
    assert chosen("site[0].strokes[1].rotate", "scale") == ["site[0].strokes[1].rotate", "scale"]
    assert [str(p) for p in chosen_parameters(design, None)] == chosen("cell", "site")
    assert str(Parameter("radius", (), 0, 1)) in chosen("site[0].strokes[1]")


@pytest.mark.parametrize("name", ["", "cell.c", "site[1]", "site[0].strokes[0].circle[0]", "sit", "site[0].mirror"])
def test_a_name_of_nothing_is_refused(name: str) -> None:
    """With what names are like."""
    with pytest.raises(vt.ArgumentError, match=r"is no number of the design\. Numbers are cell\.a, cell\.b"):
        chosen_parameters(design_of([STROKES[11]]), [name])


def test_a_cell_that_is_written_in_full_keeps_its_shape() -> None:
    """The side of a square cell moves the other one along, though both are in the file."""
    table = {"schema": 1, "group": "p4", "cell": {"a": 60.0, "b": 60.0, "angle": 90.0}}
    design = vt.Design.from_dict({**table, "site": [{"strokes": [{"segment": [[5, 3], [25, 11]]}]}]})
    parameters = chosen_parameters(design, "cell")
    assert [str(parameter) for parameter in parameters] == ["cell.a"]
    assert with_values(design, parameters, [61.0]).cell == {"a": 61.0}
