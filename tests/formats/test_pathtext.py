"""Numbers as texts against Python's decimals, and path data read back by svgelements and by a strict reader."""

from __future__ import annotations

import re
from dataclasses import replace
from decimal import ROUND_HALF_EVEN, Decimal

import numpy as np
import pytest
import svgelements
from helpers.sheets import period
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.formats.decimals import LARGEST, PLACES, decimals
from voronoi_tiles.formats.svg import path_text as pathtext
from voronoi_tiles.formats.svg.path_text import path_texts
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths

SETTINGS = settings(max_examples=300, deadline=None, derandomize=True)
HALF = 0.5 * 10.0**-PLACES
NUMBER = re.compile(r"-?(?:0|[1-9][0-9]{0,5})(?:\.[0-9]{0,5}[1-9])?")
NUMBER_WITH_POINT = re.compile(r"-?(?:0|[1-9][0-9]{0,5})\.(?:0|[0-9]{0,5}[1-9])")
COMMAND = re.compile(r"(M|L|Q|C) (-?[0-9.]+(?: -?[0-9.]+)*)|(Z)")


def texts(values: list[float], *, point: bool = False) -> list[str]:
    """The texts of numbers."""
    data, used = decimals(np.array(values, np.float64), point=point)
    return [row[chosen].tobytes().decode() for row, chosen in zip(data, used, strict=True)]


def check_text(text: str, value: float) -> None:
    """A number is within half a unit of its last place, without exponent, needless zeros or the sign of zero."""
    assert NUMBER.fullmatch(text), text
    assert text != "-0"
    scaled = value * 10.0**PLACES
    wanted = Decimal(scaled).quantize(Decimal(1), rounding=ROUND_HALF_EVEN).scaleb(-PLACES)
    assert Decimal(text) == wanted, f"{text} for {value!r}"
    # The product rounds once more, by half an ulp of it.
    assert (
        abs(Decimal(text) - Decimal(value))
        <= Decimal(HALF) * Decimal("1.000001") + Decimal(abs(value)) * Decimal(2) ** -53
    )


numbers = st.one_of(
    st.floats(-LARGEST, LARGEST),
    st.floats(-1e-5, 1e-5),
    st.integers(-999_999, 999_999).map(float),
    st.builds(lambda m, d: m / 10.0**d, st.integers(-999_999, 999_999), st.integers(0, 9)),
    st.builds(lambda m: (m + 0.5) * 10.0**-PLACES, st.integers(-(10**9), 10**9)),
)


@SETTINGS
@given(st.lists(numbers, min_size=1, max_size=20))
def test_numbers_against_decimals(values: list[float]) -> None:
    """Every size, ties and zeros; with a point the same value, and always a digit after it."""
    for text, pointed, value in zip(texts(values), texts(values, point=True), values, strict=True):
        check_text(text, value)
        assert NUMBER_WITH_POINT.fullmatch(pointed), pointed
        assert Decimal(pointed) == Decimal(text)


def test_numbers_by_hand() -> None:
    """What they look like."""
    values = [
        0.0,
        -0.0,
        -4e-7,
        1.0,
        -1.5,
        0.000001,
        -0.00001,
        10.0,
        100.25,
        999_999.0,
        123456.123456,
        1000.0,
        99.999999,
    ]
    wanted = "0 0 0 1 -1.5 0.000001 -0.00001 10 100.25 999999 123456.123456 1000 99.999999"
    assert texts(values) == wanted.split()
    assert texts([3.0, 0.0, 20.5], point=True) == ["3.0", "0.0", "20.5"]
    assert texts([]) == []


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 999_999.1, -1e300])
def test_numbers_that_cannot_be_written_are_refused(value: float) -> None:
    """They are not silently changed."""
    with pytest.raises(ValueError, match="not a number, or beyond"):
        decimals(np.array([1.0, value]))


def test_the_oracle_of_numbers_sees_what_is_wrong() -> None:
    """Another digit, an exponent, a zero too many, a signed zero."""
    for text in ("1.234568", "1.234567e0", "1.2345670", "+1.234567", "01.234567"):
        with pytest.raises(AssertionError):
            check_text(text, 1.234567)
    with pytest.raises(AssertionError):
        check_text("-0", -1e-9)


# --- path data -----------------------------------------------------------------------------------------------------


def random_paths(rng: np.random.Generator, count: int) -> Paths:
    """Paths of lines, quadratic and cubic curves, open and closed, some closed by a line."""
    lines = [rng.uniform(-99, 999, (2, int(rng.integers(2, 7)))) for _ in range(count)]
    parts = [Paths.polylines([line[0] + 1j * line[1]], closed=bool(rng.integers(2))) for line in lines]
    paths = Paths.concatenate(parts)
    kind = rng.choice([LINE, QUAD, CUBIC], len(paths.start)).astype(np.uint8)
    control = rng.uniform(-99, 999, (len(kind), 2)) + 1j * rng.uniform(-99, 999, (len(kind), 2))
    control[kind == LINE] = 0
    control[kind != CUBIC, 1] = 0
    return replace(paths, kind=kind, control=control)


def strict(data: str, height: float) -> list[tuple[bool, list[tuple[int, list[complex]]]]]:
    """Read path data that has nothing but what is promised: paths as closed or not, with kinds and points."""
    paths: list[tuple[bool, list[tuple[int, list[complex]]]]] = []
    at = 0
    while at < len(data):
        found = COMMAND.match(data, at)
        assert found, data[at : at + 40]
        at = found.end()
        assert data[at : at + 1] in {"", " "}
        at += 1
        if found[3]:
            paths[-1] = (True, paths[-1][1])
            continue
        fields = found[2].split(" ")
        assert all(NUMBER.fullmatch(field) for field in fields)
        values = [float(field) for field in fields]
        points = [complex(x, height - y) for x, y in zip(values[::2], values[1::2], strict=True)]
        assert len(points) == {"M": 1, "L": 1, "Q": 2, "C": 3}[found[1]]
        if found[1] == "M":
            paths.append((False, [(-1, points)]))
        else:
            paths[-1][1].append(("LQC".index(found[1]), points))
    return paths


def check_read(data: str, paths: Paths, height: float) -> None:
    """What the strict reader finds is what was written, in its order, each number rounded once."""
    found = strict(data, height)
    assert len(found) == len(paths), "all paths"
    for k, (closed, pieces) in enumerate(found):
        first, stop = int(paths.offsets[k]), int(paths.offsets[k + 1])
        assert closed == paths.closed[k]
        near(pieces[0][1][0], paths.start[first])
        drawn = pieces[1:]
        if closed and paths.kind[stop - 1] == LINE:
            stop -= 1
        assert [kind for kind, _ in drawn] == paths.kind[first:stop].tolist(), "all pieces"
        for j, (kind, points) in zip(range(first, stop), drawn, strict=True):
            for point, wanted in zip(points, [*paths.control[j, :kind], paths.end[j]], strict=True):
                near(point, wanted)


def near(point: complex, wanted: complex) -> None:
    """Within half a unit of the last place, and what rounding adds."""
    limit = HALF * 1.001 + 1e-12
    assert abs(point.real - wanted.real) <= limit, f"{point} is not {wanted}"
    assert abs(point.imag - wanted.imag) <= limit, f"{point} is not {wanted}"


@pytest.mark.parametrize("rows", [1, 7, 1 << 16])
def test_path_data_read_back(rows: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """However many are written at a time: item for item, path for path, number for number."""
    monkeypatch.setattr(pathtext, "_ROWS", rows)
    rng = np.random.default_rng(rows)
    paths = random_paths(rng, 30)
    items = np.array([0, 1, 4, 5, 17, 30])
    data = list(path_texts(paths, items, 300.0))
    assert len(data) == 5
    for text, a, b in zip(data, items[:-1], items[1:], strict=True):
        check_read(text.decode("ascii"), paths.take(np.arange(a, b)), 300.0)


def test_path_data_read_by_svgelements() -> None:
    """Another reader sees the same points, on outlines and on random paths."""
    here = period("p6-rosette")
    outlines, _ = here.outlines(np.arange(len(here.site)), np.zeros((len(here.site), 2), np.intp))
    for paths in (outlines, random_paths(np.random.default_rng(1), 40)):
        (data,) = path_texts(paths, np.array([0, len(paths)]), 250.0)
        points: list[complex] = []
        for segment in svgelements.Path(data.decode()):
            match segment:
                case svgelements.Move():
                    points.append(read(segment.end))
                case svgelements.Line():
                    points.append(read(segment.end))
                case svgelements.QuadraticBezier():
                    points += [read(segment.control), read(segment.end)]
                case svgelements.CubicBezier():
                    points += [read(segment.control1), read(segment.control2), read(segment.end)]
                case svgelements.Close():
                    assert read(segment.end) == points[-1] or segment.end is not None
        wanted = np.concatenate([written(paths, k) for k in range(len(paths))])
        assert len(points) == len(wanted)
        assert np.abs(np.array(points) - (wanted.conj() + 250j)).max() < 1e-6


def read(point: svgelements.Point) -> complex:
    """A point of svgelements."""
    return complex(point.x, point.y)


def written(paths: Paths, k: int) -> Complexes:
    """The points of one path that its data name."""
    first, stop = int(paths.offsets[k]), int(paths.offsets[k + 1])
    points = [paths.start[first]]
    for j in range(first, stop - int(paths.closed[k] and paths.kind[stop - 1] == LINE)):
        points += [*paths.control[j, : int(paths.kind[j])], paths.end[j]]
    return np.array(points)


def test_path_data_by_hand() -> None:
    """What it looks like."""
    paths = replace(
        Paths.concatenate(
            [Paths.polylines([[0j, 3 + 0j, 3 + 4j]], closed=True), Paths.polylines([[1 + 1j, 2 + 2.5j]])]
        ),
        kind=np.array([LINE, QUAD, LINE, LINE], np.uint8),
        control=np.array([[0, 0], [5 + 2j, 0], [0, 0], [0, 0]], np.complex128),
    )
    assert list(path_texts(paths, np.array([0, 2]), 10)) == [b"M 0 10 L 3 10 Q 5 8 3 6 Z M 1 9 L 2 7.5"]
    assert list(path_texts(Paths.empty(), np.array([0]), 10)) == []


def test_arcs_are_refused() -> None:
    """They have to become curves before."""
    paths = Paths.polylines([[0j, 1 + 0j]])
    with pytest.raises(ValueError, match="circular arcs"):
        list(path_texts(replace(paths, kind=np.array([ARC], np.uint8)), np.array([0, 1]), 10))


def test_the_oracle_of_path_data_sees_what_is_wrong() -> None:
    """A path lost, another order, a digit, another letter."""
    paths = Paths.polylines([[0j, 3 + 1j], [5j, 7 + 0j]])
    (data,) = path_texts(paths, np.array([0, 2]), 10)
    text = data.decode()
    check_read(text, paths, 10)
    for wrong in (
        text.split(" M")[0],
        "M 0 5 L 7 10 M 0 10 L 3 9",
        text.replace("3 9", "3.000002 9"),
        text + " Z",
        text.replace("3", "3e0"),
        text.replace("L", "l"),
    ):
        with pytest.raises(AssertionError):
            check_read(wrong, paths, 10)
