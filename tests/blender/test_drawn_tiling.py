"""What is drawn in Blender is a design; what is wrong with it is said in Blender's names; designs are drawn again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import voronoi_tiles as vt
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.blender.design_splines import opened, proposed_cell
from voronoi_tiles.blender.drawn_splines import DrawnSpline, strokes_of
from voronoi_tiles.blender.drawn_tiling import DrawnTiling, decimal
from voronoi_tiles.blender.solid_meshes import placed_solids
from voronoi_tiles.blender.written_files import FORMATS, FileJob, write_file

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))

CURVE = DrawnSpline("poly", np.array([6 + 9j, 22 + 5j, 27 + 17j]))


def drawn(*sites: tuple[str, tuple[DrawnSpline, ...]], group: str = "p4", a: float = 60.0) -> DrawnTiling:
    """A tiling of some sites."""
    return DrawnTiling(group, a, 50.0, 75.0, sites)


def redrawn(design: vt.Design) -> DrawnTiling:
    """What is drawn of a design that is opened."""
    found = opened(design)
    return DrawnTiling(found.group, found.a, found.b, found.angle, found.sites)


@pytest.mark.parametrize("group", vt.GROUPS)
def test_a_starter_that_is_opened_has_its_tiles(group: str) -> None:
    """Drawn as Blender draws it, and read again, it has the same outlines."""
    design = vt.starter(group)
    for tile, exact in zip(redrawn(design).tiles(), design.tessellate(), strict=True):
        assert tile.name == exact.name
        assert tile.outline.area == pytest.approx(exact.area, rel=1e-9)
        assert tile.outline.bounds == pytest.approx(exact.outline.bounds, abs=0.02)


def rounded(splines: tuple[DrawnSpline, ...], by: complex) -> tuple[DrawnSpline, ...]:
    """Splines in single precision, as they come back from where they are drawn `by` farther on."""

    def single(points: Complexes) -> Complexes:
        return np.asarray((points + by).astype(np.complex64).astype(np.complex128) - by)

    return tuple(
        one._replace(points=single(one.points), left=single(one.left), right=single(one.right)) for one in splines
    )


@pytest.mark.parametrize("by", [0j, 70 + 30j])
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_what_is_symmetric_stays_so_in_single_precision(path: Path, by: complex) -> None:
    """A site that the group maps onto itself is one site still, and no copy touches it; others move not at all."""
    design = vt.Design.load(path)
    exact = redrawn(design)
    sites = tuple((name, rounded(splines, by)) for name, splines in exact.sites)
    single = DrawnTiling(exact.group, exact.a, exact.b, exact.angle, sites)
    tiles = single.tiles()
    assert [len(tile.symmetry) for tile in tiles] == [len(tile.symmetry) for tile in exact.tiles()]
    for tile, site, (_, before) in zip(tiles, single.design().sites, sites, strict=True):
        if len(tile.symmetry) == 1:
            assert site.strokes == tuple(strokes_of(before, 0.0))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_can_be_opened(path: Path) -> None:
    """All kinds of strokes, placements, scales and units: the tiles are as large as the design's."""
    design = vt.Design.load(path)
    for tile, exact in zip(redrawn(design).tiles(), design.tessellate(), strict=True):
        assert tile.outline.area == pytest.approx(exact.area, rel=2e-3)


def test_numbers_are_those_that_people_wrote() -> None:
    """Blender keeps single precision: 60.1 is 60.099998 there, and 60.1 in a file."""
    assert decimal(float(np.float32(60.1))) == 60.1
    assert decimal(float(np.float32(1 / 3))) == pytest.approx(1 / 3, rel=1e-7)
    assert decimal(75.0) == 75.0


def test_the_proof_is_that_of_the_design() -> None:
    """What is shown after a pause is proved, and as it was shown before."""
    tiling = drawn(("Bird", (CURVE,)))
    proved = tiling.proved()
    assert proved.proof.passed
    assert proved["Bird"].outline.start.tolist() == tiling.tiles()[0].outline.start.tolist()


def test_touching_copies_are_said_with_the_object() -> None:
    """And where they touch, for the marker."""
    tiling = drawn(("Bird.001", (CURVE,)), a=20.0)
    with pytest.raises(vt.TouchingCopiesError) as caught:
        tiling.tiles()
    assert tiling.said(caught.value).startswith("Bird.001 touches its own copy at (")


def test_errors_name_the_object_and_the_stroke() -> None:
    """Not the key of a file that nobody has seen."""
    far = DrawnSpline("poly", np.array([0j, 1e300 + 0j]))
    tiling = drawn(("Bird", (CURVE,)), ("Fish", (CURVE, far)))
    with pytest.raises(vt.DesignError) as caught:
        tiling.tiles()
    said = tiling.said(caught.value)
    assert said.startswith("Fish, stroke 2: ")
    assert "sites[" not in said


@pytest.mark.parametrize("shape", [CURVE.points, np.array([-8 + 1j, 8 - 1j]), np.array([-6, -1 + 4j, 1 - 4j, 6])])
@pytest.mark.parametrize("group", vt.GROUPS)
def test_a_cell_is_proposed_about_what_is_drawn(group: str, shape: Complexes) -> None:
    """As large as it needs, with its origin where a starter's is: tiles come of a drawing anywhere.

    Of one as well whose middle is its own centre of rotation.
    """
    points = 3.0 * shape + (500 - 200j)
    cell = proposed_cell(group, points)
    box = complex(np.ptp(points.real), np.ptp(points.imag))
    assert max(box.real, box.imag) < cell.a < 12 * max(box.real, box.imag)
    assert abs(points.mean() - cell.origin) < cell.a
    for grown in 1.25 ** np.arange(13):
        middle = (points.real.min() + points.real.max() + 1j * (points.imag.min() + points.imag.max())) / 2
        origin = middle + grown * (cell.origin - middle)
        seen = DrawnSpline("poly", points - origin)
        try:
            tiles = DrawnTiling(group, cell.a * grown, cell.b * grown, cell.angle, (("Bird", (seen,)),)).tiles()
        except vt.TouchingCopiesError:
            continue
        assert tiles[0].outline.area > 0
        return
    pytest.fail("copies touch in every cell")


def test_solids_stand_where_their_tiles_are() -> None:
    """Prisms drawn in and lofts alike, whatever a unit is in millimetres: each within its tile and near its edge."""
    tiling = drawn(("Bird", (CURVE,)))
    left, bottom, right, top = tiling.tiles()[0].outline.bounds
    for unit_mm in (1.0, 10.0):
        for job, solid, room in (
            (vt.SolidJob(height=3), None, 0.0),
            (vt.SolidJob(height=3, clearance=0.4, chamfer=0.3), None, 2.0),
            (vt.SolidJob(), vt.Solid(20, turn=5, about=15 + 15j, layers=5), 0.0),
        ):
            found = placed_solids(tiling, unit_mm, job, solid)
            vertices = found.meshes[0].vertices
            base = vertices[vertices[:, 2] == 0.0]
            assert found.names == ("Bird",)
            assert (base.min(axis=0)[:2] >= np.array([left, bottom]) - 1e-4).all()
            assert (base.max(axis=0)[:2] <= np.array([right, top]) + 1e-4).all()
            assert base.min(axis=0)[:2] == pytest.approx([left, bottom], abs=0.06 + room)
            assert vertices[:, 2].max() == pytest.approx(20.0 if solid else 3.0 / unit_mm, rel=1e-6)


def test_all_files_are_written_in_their_size(tmp_path: Path) -> None:
    """A unit of 2 mm: what the design says, the outline document has, and solids come to."""
    tiling = drawn(("Bird", (CURVE,)))
    job = FileJob(2.0, vt.Job(sheet="300x200mm", feed=300, power=800), vt.SolidJob(height=4))
    for suffix in FORMATS:
        said = write_file(tiling, str(tmp_path / f"a{suffix}"), job)
        assert said.startswith(f"wrote a{suffix}")
        assert (tmp_path / f"a{suffix}").stat().st_size > 100
    design = vt.Design.load(tmp_path / "a.toml")
    assert design.lattice.a == 120.0
    assert design.tessellate()[0].area == pytest.approx(4 * 900)
    assert "14.4 cm" in write_file(tiling, str(tmp_path / "a.stl"), job)
    loft = FileJob(2.0, solid=vt.Solid(20, turn=5, about=15 + 15j))
    assert "x 40 mm, 144 cm" in write_file(tiling, str(tmp_path / "a.3mf"), loft)


def test_another_suffix_is_refused_with_those_that_are_ours(tmp_path: Path) -> None:
    """Nothing is written."""
    with pytest.raises(vt.OutputError, match=r"a.dxf has no suffix of ours. Use one of \.svg, "):
        write_file(drawn(("Bird", (CURVE,))), str(tmp_path / "a.dxf"), FileJob())
    assert not [*tmp_path.iterdir()]
