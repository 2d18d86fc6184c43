"""Each figure of the proof is able to fail: results are tampered with, and the figure that should see it does."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from voronoi_tiles.base.errors import ProofError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.design import Design
from voronoi_tiles.vector import proof
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.proof import ProofReport, prove
from voronoi_tiles.vector.tessellation import LocalTile, Tessellation, TileRecord, tessellate

Change = Callable[[Outline], Outline]

UNIT = 60.0
DESIGN = {
    "schema": 1,
    "group": "p4",
    "cell": {"a": UNIT},
    "site": [
        {"name": "ring", "strokes": [{"polyline": [[5, 4], [24, 9], [21, 25], [8, 22]], "closed": True}]},
        {"name": "core", "strokes": [{"segment": [[12, 14], [17, 16]]}]},
    ],
}
BEYOND_THE_MIRROR = {
    # The right half of the site's last segment lies beyond the mirror x = 15: its tile has a bite and an island there.
    "schema": 1,
    "group": "pmg",
    "cell": {"a": UNIT, "b": UNIT},
    "site": [
        {"strokes": [{"point": p} for p in ([45.8457, 18.375], [36.625, 20.8457], [34.1543, 11.625], [43.375, 9.1543])]}
    ],
}


@dataclass(frozen=True)
class _LocalTampered:
    """What the proof reads of a tile, with a changed outline; the copies stay good."""

    good: LocalTile
    outline: Outline

    @property
    def name(self) -> str:
        return self.good.name

    @property
    def nodes(self) -> NDArray[np.complex128]:
        return self.good.nodes

    @property
    def segments(self) -> NDArray[np.intp]:
        return self.good.segments


@dataclass(frozen=True)
class _Tampered:
    """A record whose outline is changed."""

    record: TileRecord
    change: Change

    @property
    def name(self) -> str:
        return self.record.name

    @property
    def symmetry(self) -> tuple[Operation, ...]:
        return self.record.symmetry

    @property
    def tessellation(self) -> Tessellation:
        return self.record.tessellation

    def local(self) -> Any:
        good = self.record.local()
        return _LocalTampered(good, self.change(good.outline))


def _report(change: Change, design: dict[str, Any] | None = None, tiles: Sequence[int] = (0, 1)) -> ProofReport:
    """The proof's report of a design some of whose tiles are changed."""
    read = Design.from_dict(design or DESIGN)
    records: list[Any] = list(tessellate(read.noded, read.group, read.lattice))
    records = [_Tampered(record, change) if k in tiles else record for k, record in enumerate(records)]
    return prove(read.group, read.lattice, records)


def _failed(report: ProofReport) -> set[str]:
    return {name for name, _, _, holds in report.rows() if not holds}


def _joint(outline: Outline) -> int:
    """An arc after a long one in the outer ring, itself long."""
    count = int(outline.ring_offsets[1])
    lengths = outline.lengths[:count]
    return int(np.argmax(np.minimum(lengths, np.roll(lengths, 1))))


def _moved(by: complex) -> Change:
    """Move a vertex, keeping the ring closed."""

    def change(outline: Outline) -> Outline:
        k, count = _joint(outline), int(outline.ring_offsets[1])
        start, end, control = outline.start.copy(), outline.end.copy(), outline.control.copy()
        start[k] += by
        end[(k - 1) % count] = start[k]
        straight = ~outline.curved
        control[straight] = (start[straight] + end[straight]) / 2
        return replace(outline, start=start, end=end, control=control)

    return change


def _scaled(factor: float) -> Change:
    def change(outline: Outline) -> Outline:
        centre = outline.start.mean()
        start, control, end = (centre + (z - centre) * factor for z in (outline.start, outline.control, outline.end))
        return replace(outline, start=start, control=control, end=end)

    return change


def _slid(by: float) -> Change:
    """Prolong a straight edge beyond its end: its points are still as far from both, but others are nearer."""

    def change(outline: Outline) -> Outline:
        count = int(outline.ring_offsets[1])
        k = int(np.argmax(np.where(outline.curved[:count], 0.0, outline.lengths[:count])))
        start, end = outline.start.copy(), outline.end.copy()
        start[k] += by * (start[k] - end[k])
        end[(k - 1) % count] = start[k]
        return replace(outline, start=start, end=end)

    return change


def _bent(outline: Outline) -> Outline:
    k = int(np.argmax(np.where(outline.curved, outline.lengths, 0.0)))
    control = outline.control.copy()
    control[k] += 1e-9 * UNIT
    return replace(outline, control=control)


def _renamed(outline: Outline) -> Outline:
    return replace(outline, neighbours=outline.neighbours[1:] + outline.neighbours[:1])


def _opened(outline: Outline) -> Outline:
    end = outline.end.copy()
    end[0] = complex(np.nextafter(end[0].real, np.inf), end[0].imag)
    return replace(outline, end=end)


def _twisted(outline: Outline) -> Outline:
    """Exchange two neighbouring vertices of the outer ring, straight edges all round: a bow tie."""
    count = int(outline.ring_offsets[1])
    corner = outline.start[:count].copy()
    k = _joint(outline)
    after = (k + 1) % count
    corner[k], corner[after] = corner[after], corner[k]
    start, end = outline.start.copy(), outline.end.copy()
    start[:count], end[:count] = corner, np.roll(corner, -1)
    return replace(outline, start=start, end=end, control=(start + end) / 2, curved=np.zeros(len(start), bool))


def _one_ulp(outline: Outline) -> Outline:
    control = outline.control.copy()
    k = int(np.flatnonzero(outline.curved)[0])
    control[k] = complex(np.nextafter(control[k].real, np.inf), control[k].imag)
    return replace(outline, control=control)


def _rings(outline: Outline, chosen: Sequence[int]) -> Outline:
    """Some of the rings."""
    offsets = outline.ring_offsets.tolist()
    parts = [np.arange(offsets[k], offsets[k + 1]) for k in chosen]
    arcs = np.concatenate(parts)
    names = ("start", "control", "end", "curved", "focus", "directrix", "neighbour")
    columns = {name: getattr(outline, name)[arcs] for name in names}
    lengths = [len(part) for part in parts]
    return replace(outline, **columns, ring_offsets=np.array([0, *np.cumsum(lengths)], dtype=np.intp))


def _without_hole(outline: Outline) -> Outline:
    return _rings(outline, range(max(1, len(outline.ring_offsets) - 2)))


def _mirrored_ring(outline: Outline) -> Outline:
    """Turn the outer ring over about the line x = its middle: equal area, another place."""
    middle = complex((outline.start.real.max() + outline.start.real.min()) / 2)
    start, control, end = (2 * middle.real - z.conj() for z in (outline.start, outline.control, outline.end))
    order = np.arange(len(start))[::-1]
    return replace(outline, start=end[order], control=control[order], end=start[order])


def _nothing(outline: Outline) -> Outline:
    return outline


CASES: dict[str, tuple[Change, set[str]]] = {
    "nothing": (_nothing, set()),
    "a vertex moved by 1e-10 of the cell": (
        _moved(1e-10 * UNIT * (1 + 1j)),
        {"area", "equidistance", "unshared edges"},
    ),
    "a vertex moved by 4e-12 of the cell": (_moved(4e-12 * UNIT * (1 + 1j)), {"equidistance", "unshared edges"}),
    "scaled by 1 + 1e-11": (_scaled(1 + 1e-11), {"area", "equidistance", "unshared edges"}),
    "an edge prolonged": (_slid(0.01), {"emptiness", "unshared edges"}),
    "a curve bent": (_bent, {"equidistance", "unshared edges"}),
    "neighbours exchanged": (_renamed, {"equidistance"}),
    "a ring opened by one ulp": (_opened, {"open joints", "unshared edges"}),
    "a bow tie": (_twisted, {"crossings", "area", "equidistance", "unshared edges"}),
    "a control point moved by one ulp": (_one_ulp, {"unshared edges"}),
    "the hole dropped": (_without_hole, {"area"}),
    "turned over": (_mirrored_ring, {"equidistance"}),
}


@pytest.mark.parametrize("name", list(CASES))
def test_tampering_is_seen(name: str) -> None:
    """The figures named fail; where nothing was done, none does."""
    change, expected = CASES[name]
    report = _report(change, tiles=(0,))
    assert expected <= _failed(report)
    assert report.passed == (name == "nothing")
    assert len(report.failures) == len(_failed(report))


def test_the_smallest_tampering_is_seen_by_one_figure_alone() -> None:
    """One ulp of a control point is no error of place or area: only the bits differ."""
    assert _failed(_report(_one_ulp, tiles=(0,))) == {"unshared edges"}


def test_every_figure_is_seen_to_fail() -> None:
    """A figure that is added needs a case here."""
    named = {name for name, *_ in _report(_nothing).rows()}
    seen = set().union(*(expected for _, expected in CASES.values())) | SEEN_ELSEWHERE
    assert named == seen


SEEN_ELSEWHERE: set[str] = {"strayed strokes"}


@pytest.mark.parametrize("field", [field.name for field in fields(ProofReport)])
@pytest.mark.parametrize("value", [float("nan"), float("inf"), 2e-12, 1])
def test_a_figure_beyond_its_limit_fails_by_name(field: str, value: float) -> None:
    """Not-a-number is no pass; the sentence tells figure and limit."""
    good = _report(_nothing)
    changed: dict[str, Any] = {field: value}
    report = replace(good, **changed)
    assert not report.passed
    (sentence,) = report.failures
    assert sentence.startswith(field.split("_", maxsplit=1)[0])
    assert "limit" in sentence


def test_the_limits_are_those_promised() -> None:
    """1e-12 of the cell for measures, none for counts."""
    limits = {name: limit for name, _, limit, _ in _report(_nothing).rows()}
    assert limits["area"] == limits["equidistance"] == limits["emptiness"] == 1e-12
    assert limits["open joints"] == limits["crossings"] == limits["unshared edges"] == 0


def test_a_failed_proof_is_an_error_with_the_report(monkeypatch: pytest.MonkeyPatch) -> None:
    """The pipeline gives no tiles then."""
    bad = replace(_report(_nothing), equidistance=1e-9)
    monkeypatch.setattr(proof, "prove", lambda *_: bad)
    with pytest.raises(ProofError, match="equidistance is 1e-09") as caught:
        Design.from_dict(DESIGN).tessellate()
    assert caught.value.report is bad
    assert caught.value.exit_code == 1


def test_a_lost_island_is_a_stroke_that_strayed() -> None:
    """With one of two islands left out the figure says so, whatever the rings that are left have of points."""
    strokes = [{"segment": [[0.5, 10], [7, 19]]}, {"point": [-2.5, 14]}]
    strokes += [{"segment": [[0.5, 40], [7, 49]]}, {"point": [-2.5, 44]}]
    design = {"schema": 1, "group": "pm", "cell": {"a": 60, "b": 80}, "site": [{"strokes": strokes}]}
    read = Design.from_dict(design)
    (record,) = tessellate(read.noded, read.group, read.lattice)
    assert len(record.local().outline.ring_offsets) == 4
    assert prove(read.group, read.lattice, [record]).passed
    assert "strayed strokes" in _failed(_report(partial(_rings, chosen=[0, 1]), design))


@dataclass(frozen=True)
class _WithOneMore(_LocalTampered):
    """A tile whose site has one more node, of which the engine knew nothing."""

    node: complex

    @property
    def nodes(self) -> NDArray[np.complex128]:
        return np.append(self.good.nodes, self.node)


@dataclass(frozen=True)
class _WithOneMoreRecord(_Tampered):
    node: complex

    def local(self) -> Any:
        good = self.record.local()
        return _WithOneMore(good, good.outline, self.node)


@pytest.mark.parametrize("nearer", [1e-11, 1e-8, 1e-3])
def test_a_copy_that_is_a_hair_too_near_is_seen(nearer: float) -> None:
    """At a vertex the copy that is not beyond the arc is nearer than the arc claims: by so much of the cell."""
    read = Design.from_dict(DESIGN)
    records: list[Any] = list(tessellate(read.noded, read.group, read.lattice))
    outline = records[0].local().outline
    # Where two arcs with different neighbours meet, the copy beyond the one that ends there is as near as the others.
    k = int(np.flatnonzero(outline.neighbour[1:] != outline.neighbour[:-1])[0]) + 1
    name, operation = outline.neighbours[outline.neighbour[k - 1]]
    other = next(number for number, record in enumerate(records) if record.name == name)
    site = records[other].local()
    place = read.lattice.isometry(operation.inverse())(complex(outline.start[k]))
    feet = site.nodes[site.segments]
    along = feet[:, 1] - feet[:, 0]
    share = np.clip(((place - feet[:, 0]) * along.conj()).real / np.abs(along) ** 2, 0.0, 1.0)
    foot = complex(min(feet[:, 0] + share * along, key=lambda z: abs(z - place)))
    node = foot + (place - foot) / abs(place - foot) * nearer * UNIT
    records[other] = _WithOneMoreRecord(records[other], _nothing, node)
    report = prove(read.group, read.lattice, records)
    assert report.emptiness == pytest.approx(nearer, rel=1e-3)
    assert "emptiness" in _failed(report)


def test_a_far_site_is_proved_where_it_was_computed() -> None:
    """Thousands of cells away the figures are as small as near the origin."""
    far = {**DESIGN, "site": [{"strokes": [{"circle": [3e5 + 15, 15 - 9e5], "radius": 9}]}]}
    report = _report(_nothing, far)
    assert report.passed
    assert report.equidistance < 1e-14


def test_a_tile_with_bite_and_island() -> None:
    """A site across a mirror is proved with all its rings; without some of them it is not."""
    read = Design.from_dict(BEYOND_THE_MIRROR)
    (record,) = tessellate(read.noded, read.group, read.lattice)
    outline = record.local().outline
    assert prove(read.group, read.lattice, [record]).passed
    for k in range(len(outline.ring_offsets) - 1):
        rest = [other for other in range(len(outline.ring_offsets) - 1) if other != k]
        if rest:
            assert not _report(partial(_rings, chosen=rest), BEYOND_THE_MIRROR).passed


def _shortcut(outline: Outline) -> Outline:
    """Leave out the island, and the way round the bite: go straight along the mirror instead."""
    offsets = outline.ring_offsets.tolist()
    island = min(range(len(offsets) - 1), key=lambda k: offsets[k + 1] - offsets[k])
    arcs = np.delete(np.arange(len(outline)), np.arange(offsets[island], offsets[island + 1]))
    on_mirror = (outline.start[arcs].real == 45.0) & (outline.end[arcs].real == 45.0)
    bite = (outline.start[arcs].real != 45.0) & (outline.start[arcs].imag > 13) & (outline.start[arcs].imag < 16)
    arcs, on_mirror = arcs[~bite], on_mirror[~bite]
    end = np.roll(outline.start[arcs], -1)
    assert on_mirror.any()
    names = ("start", "control", "curved", "focus", "directrix", "neighbour")
    columns = {name: getattr(outline, name)[arcs] for name in names}
    columns["control"] = (columns["start"] + end) / 2
    return replace(outline, **columns, end=end, ring_offsets=np.array([0, len(arcs)], dtype=np.intp))


def test_a_wrong_region_with_right_area_and_edges_is_seen() -> None:
    """Every edge is a true bisector and the area is right, by the mirror; but a part of the site is outside.

    The bits alone would not do: an engine that makes this mistake makes it for the neighbour too.
    """
    report = _report(_shortcut, BEYOND_THE_MIRROR)
    assert report.area < 1e-12
    assert report.equidistance < 1e-12
    assert report.emptiness < 1e-12
    assert _failed(report) - {"unshared edges"}
