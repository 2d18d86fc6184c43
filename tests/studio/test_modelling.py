"""The solids that the page shows are those that are written: every triangle, the neighbours where they stand."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers.outlines import CommandLine
from helpers.solid_frames import FramePiece, read_frame

import voronoi_tiles as vt
from voronoi_tiles.base.errors import ArgumentError, VoronoiTilesError
from voronoi_tiles.solid.events import LoftError
from voronoi_tiles.studio import modelling
from voronoi_tiles.studio.modelling import Modeller, read_solid_job, solid_file
from voronoi_tiles.studio.refusals import error_document

FLAT: dict[str, Any] = {
    "schema": 1,
    "group": "p3",
    "cell": {"a": 60.0},
    "site": [{"name": "bird", "strokes": [{"polyline": [[8.0, 9.0], [21.0, 6.0], [24.0, 17.0]]}]}],
}
LOFT: dict[str, Any] = {
    **FLAT,
    "group": "pgg",
    "cell": {"a": 44.0, "b": 36.0},
    "site": [{"name": "bird", "strokes": [{"point": [7.0, 4.0]}]}],
    "solid": {"height": 30.0, "layers": 21},
    "key": [{"z": 30.0, "strokes": [{"point": [15.0, 12.0]}]}],
}
MEETING: dict[str, Any] = {
    **FLAT,
    "group": "p2",
    "cell": {"a": 40.0, "b": 40.0, "angle": 90.0},
    "site": [{"strokes": [{"segment": [[3.0, 3.0], [17.0, 17.0]]}]}],
    "solid": {"height": 20.0, "shift": [-12.0, -12.0]},
}


def shown(design: dict[str, Any], **job: Any) -> tuple[dict[str, Any], list[FramePiece]]:
    """What is said last of a design, and its pieces."""
    *_, last = Modeller().solids(7, design, job, "bird")
    assert not last.more
    return read_frame(last.frame)


def volume_of(piece: FramePiece) -> float:
    """The volume within a piece's triangles, in float64."""
    a, b, c = np.moveaxis(piece.vertices.astype(np.float64)[piece.triangles], 1, 0)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize("design", [FLAT, LOFT], ids=["prism", "loft"])
def test_the_buffers_are_the_model(design: dict[str, Any]) -> None:
    """The tile's vertices, rounded once, and all its triangles in their order; its figures and its proof are said."""
    message, pieces = shown(design)
    read = vt.Design.from_dict(design)
    model = vt.extrude(read.tessellate()) if read.standing is None else vt.stand(read)
    own = model.pieces[0].mesh
    assert (message["type"], message["rev"], message["coarse"]) == ("solid", 7, False)
    assert message["count"] == len(pieces) > 3
    assert np.array_equal(pieces[0].triangles, own.triangles)
    # The file's mesh has been moved to where no coordinate is negative.
    away = pieces[0].vertices - (own.vertices - own.vertices.mean(axis=0))
    assert np.ptp(away, axis=0).max() < 1e-5
    middle = (pieces[0].vertices.min(axis=0) + pieces[0].vertices.max(axis=0)) / 2
    assert np.abs(middle).max() < 1e-5
    (tile,) = message["tiles"]
    assert tile["volume"] == pytest.approx(model.volume, rel=1e-12)
    assert tile["size"] == pytest.approx((model.bounds[1] - model.bounds[0]).tolist(), rel=1e-12)
    assert tile["triangles"] == len(own.triangles)
    assert message["proved"].startswith("closed; volume")
    assert all(volume_of(piece) == pytest.approx(tile["volume"], rel=1e-5) for piece in pieces)


@pytest.mark.parametrize("design", [FLAT, LOFT], ids=["prism", "loft"])
def test_neighbours_fill_the_slab(design: dict[str, Any]) -> None:
    """They stand where they do: each triangle of the tile's walls is, turned round, one of exactly one neighbour."""
    _, (tile, *others) = shown(design)

    def walls(piece: FramePiece, *, back: bool) -> list[bytes]:
        """The corners of triangles that are not level, the same for each that has them in this order."""
        corners = (piece.vertices + np.float32(0.0))[piece.triangles]
        steep = corners[np.ptp(corners[:, :, 2], axis=1) > 0.0]
        ordered = steep[:, ::-1] if back else steep
        first = np.lexsort(np.moveaxis(ordered, 2, 0)[::-1], axis=1)[:, 0]
        turned = np.take_along_axis(ordered, ((first[:, None] + np.arange(3)) % 3)[:, :, None], axis=1)
        return [np.ascontiguousarray(one).tobytes() for one in turned]

    beyond = [one for piece in others for one in walls(piece, back=True)]
    own = walls(tile, back=False)
    assert len(own) > 20
    counts = [beyond.count(one) for one in own]
    assert counts == [1] * len(own)
    assert [beyond.count(one) for one in walls(tile, back=True)] == [0] * len(own)


def test_the_first_site_is_said_first() -> None:
    """Figures are of the drawn tile, with which the model begins, and then of the others."""
    sites = [{"name": f"s{k}", "strokes": [{"point": [8.0 + 9.0 * k, 9.0 + 5.0 * k]}]} for k in range(2)]
    flat = {"schema": 1, "group": "p2", "cell": {"a": 40, "b": 40, "angle": 90}, "site": sites}
    message, _ = shown({**flat, "solid": {"height": 10}})
    assert [tile["site"] for tile in message["tiles"]] == ["s0", "s1"]


@pytest.mark.parametrize("design", [FLAT, LOFT], ids=["prism", "loft"])
def test_colours_and_normals(design: dict[str, Any]) -> None:
    """Neighbours of the tile have other colours than it; normals point outward, and level faces up or down."""
    message, pieces = shown(design)
    colours = [piece["colour"] for piece in message["pieces"]]
    assert colours[0] not in colours[1:]
    assert max(colours) < len(message["colours"])
    for piece in pieces:
        corners = piece.vertices.astype(np.float64)[piece.triangles]
        faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        size = np.linalg.norm(faces, axis=1)
        sound = size > 1e-3
        normals = piece.normals[:, :, :3] / 127.0
        assert np.abs(np.linalg.norm(normals, axis=2) - 1.0).max() < 0.02
        along = np.einsum("ij,ikj->ik", faces, normals)[sound] / size[sound, None]
        assert along.min() > np.cos(np.radians(33.0))  # creases are sharper
        level = np.abs(faces[:, 2]) > 0.999 * size
        assert np.array_equal(
            normals[level & sound][:, :, 2] > 0.99, np.repeat(faces[level & sound, 2:] > 0, 3, axis=1)
        )
    assert not any(piece.normals[:, :, 3].any() for piece in pieces)


def test_a_clearance_and_a_bed() -> None:
    """What the job asks is shown: tiles that are drawn in, and all pieces of a bed about its middle."""
    plain, _ = shown(FLAT, height="5mm")
    (tile,) = plain["tiles"]
    assert tile["size"][2] == 5.0
    drawn, pieces = shown(FLAT, clearance=1.0, height=5.0)
    assert drawn["tiles"][0]["volume"] < 0.97 * tile["volume"]
    assert volume_of(pieces[1]) == pytest.approx(drawn["tiles"][0]["volume"], rel=1e-5)
    bed, pieces = shown(FLAT, sheet="200x150mm", colours="fewest")
    model = vt.extrude(vt.Design.from_dict(FLAT).tessellate(), vt.SolidJob(sheet="200x150mm", colours="fewest"))
    assert bed["count"] == len(pieces) == len(model.pieces)
    points = np.concatenate([piece.vertices for piece in pieces])
    assert np.abs(points.min(axis=0) + points.max(axis=0)).max() < 1e-4


def test_no_more_is_sent_than_can_be_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a bed with too many triangles the first pieces, and how many there are; never none."""
    whole, pieces = shown(FLAT, sheet="200x150mm")
    for most, count in ((2 * len(pieces[0].triangles), 2), (1, 1)):
        monkeypatch.setattr(modelling, "SHOWN_MAX", most)
        some, fewer = shown(FLAT, sheet="200x150mm")
        assert (some["count"], len(fewer)) == (whole["count"], count)


@pytest.mark.parametrize("layers", [None, 31])
def test_a_slow_loft_has_a_coarse_one_first(layers: int | None, monkeypatch: pytest.MonkeyPatch) -> None:
    """However few layers it asks for; then the exact one: by what that took it is known whether the next is alone."""
    design = {**LOFT, "solid": {"height": 30.0, **({} if layers is None else {"layers": layers})}}
    modeller = Modeller()
    first, second = (read_frame(one.frame)[0] for one in modeller.solids(1, design, {}, "bird"))
    assert (first["coarse"], second["coarse"]) == (True, False)
    assert first["tiles"][0]["triangles"] < second["tiles"][0]["triangles"]
    assert first["tiles"][0]["volume"] == pytest.approx(second["tiles"][0]["volume"], rel=1e-12)
    monkeypatch.setattr(modelling, "SLOW_S", modeller.seconds + 1e-3)
    assert [one.more for one in modeller.solids(2, design, {}, "bird")] == [False]
    monkeypatch.setattr(modelling, "SLOW_S", 0.0)
    assert [one.more for one in modeller.solids(3, design, {}, "bird")] == [True, False]
    assert [one.more for one in Modeller().solids(1, FLAT, {}, "bird")] == [False]


def test_what_is_refused_is_said_as_the_command_line_says_it(tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """Copies that meet above, with the height; nothing coarse comes before."""
    with pytest.raises(LoftError) as caught:
        list(Modeller().solids(1, MEETING, {}, "bird"))
    assert 0.0 < caught.value.z < 20.0
    said = error_document(caught.value)
    path = tmp_path / "bird.json"
    path.write_text(json.dumps(MEETING), encoding="utf-8")
    done = voronoi_tiles("solid", "bird.json", "-o", "bird.stl", cwd=tmp_path)
    assert done.returncode == 2
    assert f"{said['message']} {said['remedy']}" in done.stderr
    assert "at the height" in said["message"]
    with pytest.raises(VoronoiTilesError, match="height"):
        list(Modeller().solids(1, LOFT, {"height": 5}, "bird"))


@pytest.mark.parametrize("form", ["3mf", "stl", "png"])
@pytest.mark.parametrize(
    ("design", "job"),
    [(FLAT, {"height": "4mm", "clearance": 0.3}), pytest.param(LOFT, {}, marks=pytest.mark.slow)],
    ids=["prism", "loft"],
)
def test_downloads_are_what_the_command_line_writes(
    form: str, design: dict[str, Any], job: dict[str, Any], tmp_path: Path, voronoi_tiles: CommandLine
) -> None:
    """Byte for byte, of the design that is saved; pictures show the neighbours pulled apart."""
    (tmp_path / "my bird.json").write_text(json.dumps(design), encoding="utf-8")
    file, data = solid_file(design, {**job, "format": form}, "my bird")
    assert file == f"my-bird.{form}"
    flags = [part for name, value in job.items() for part in (f"--{name}", str(value))]
    done = voronoi_tiles("solid", "my bird.json", "-o", f"solid.{form}", *flags, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert data == (tmp_path / f"solid.{form}").read_bytes()


def test_other_options_and_formats_are_refused() -> None:
    """There is no option that the page does not know of, and no format but those of solids."""
    with pytest.raises(ArgumentError, match="no option 'kerf'"):
        read_solid_job({"kerf": 0.1})
    with pytest.raises(ArgumentError, match="unknown `format` 'svg'"):
        solid_file(FLAT, {"format": "svg"}, "bird")
    assert read_solid_job({"height": 5.0}) == vt.SolidJob(height=5)
