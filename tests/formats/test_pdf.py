"""PDF files, read by a small reader of our own and by Inkscape."""

from __future__ import annotations

import io
import json
import re
import zlib
from pathlib import Path

import numpy as np
import pytest
from helpers import cad
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.formats.pdf import write_pdf
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths

MM = 25.4 / 72

Object = tuple[list[tuple[Complexes, bool]], str]


def written(drawing: Drawing) -> bytes:
    """Write a drawing."""
    file = io.BytesIO()
    write_pdf(drawing, file)
    return file.getvalue()


def objects(data: bytes) -> list[bytes]:
    """The objects of a file, each found by its place in the table."""
    table = int(re.search(rb"startxref\n(\d+)\n%%EOF\n$", data)[1])  # type: ignore[index]
    head = re.match(rb"xref\n0 (\d+)\n0000000000 65535 f \n", data[table:])
    assert head
    count = int(head[1])
    rows = data[table + head.end() : table + head.end() + 20 * (count - 1)]
    places = [int(rows[20 * k : 20 * k + 10]) for k in range(count - 1)]
    for number, place in enumerate(places, start=1):
        assert data[place:].startswith(b"%d 0 obj\n" % number)
    ends = [*places[1:], table]
    return [data[a:b] for a, b in zip(places, ends, strict=True)]


def content(data: bytes) -> str:
    """The content stream."""
    last = objects(data)[-1]
    head = re.search(rb"/Length (\d+) /Filter /FlateDecode >>\nstream\n", last)
    assert head
    packed = last[head.end() : head.end() + int(head[1])]
    assert last[head.end() + len(packed) :] == b"\nendstream\nendobj\n"
    return zlib.decompress(packed).decode("ascii")


def draw(curves: list[tuple[list[complex], bool]], operator: str, numbers: NDArray[np.float64]) -> None:
    """Take one operator of a path."""
    assert len(numbers) == {"m": 2, "l": 2, "c": 6, "h": 0}[operator]
    points = numbers[::2] + 1j * numbers[1::2]
    t = np.linspace(0, 1, 65)[1:]
    match operator:
        case "m":
            curves.append((points.tolist(), False))
        case "l":
            curves[-1][0].extend(points.tolist())
        case "c":
            a, (b, c, d) = curves[-1][0][-1], points
            curve = a * (1 - t) ** 3 + 3 * b * t * (1 - t) ** 2 + 3 * c * t * t * (1 - t) + d * t**3
            curves[-1][0].extend(curve.tolist())
        case _:
            curves[-1] = (curves[-1][0], True)


def painted(data: bytes) -> dict[str, tuple[str, float, list[Object]]]:
    """What is painted: for each layer its colour, its width in millimetres, and objects of curves with the operator."""
    found: dict[str, tuple[str, float, list[Object]]] = {}
    scale, layer, colour, width = 1.0, "", "", 0.0
    curves: list[tuple[list[complex], bool]] = []
    stack: list[str] = []
    for token in content(data).split():
        if not token[0].isalpha() or token.startswith("/"):
            stack.append(token)
            continue
        match token, stack:
            case "cm", [a, "0", "0", d, "0", "0"]:
                assert a == d
                scale = float(a) * MM
            case "BDC", ["/OC", name]:
                layer = name[1:]
            case "RG", [*parts]:
                colour = " ".join(parts)
            case "rg", [*parts]:
                assert colour == " ".join(parts)
            case "w", [text]:
                width = float(text) * scale
                found[layer] = (colour, width, [])
            case (("m" | "l" | "c" | "h"), [*numbers]):
                draw(curves, token, np.array(numbers, float) * scale)
            case (("S" | "f"), []):
                found[layer][2].append(([(np.array(points), closed) for points, closed in curves], token))
                curves = []
            case (("q" | "Q" | "EMC" | "J" | "j"), _):
                pass
            case _:
                raise AssertionError(f"{stack} {token}")
        stack = []
    assert not curves
    return found


@pytest.mark.parametrize("kind", [LINE, QUAD, CUBIC, ARC])
def test_the_curves_are_those_of_the_drawing(kind: int) -> None:
    """Same layers, objects, curves and flags, in the same order, within 2 nm; colours and widths."""
    drawing = cad.drawing(kind)
    found = painted(written(drawing))
    assert list(found) == ["L0", "L1", "L2"]
    for layer, (colour, width, parts) in zip(drawing.layers, found.values(), strict=True):
        assert colour == {"engrave": "1 0 0", "score": "0 0 1", "cut": "0 0 0"}[layer.name]
        assert width == pytest.approx(layer.stroke, rel=1e-9)
        assert [len(curves) for curves, _ in parts] == np.diff(layer.items).tolist()
        assert {operator for _, operator in parts} == {"S"}
        curves = [curve for part, _ in parts for curve in part]
        for points, closed, (theirs, is_closed) in zip(
            cad.sampled(layer.paths), layer.paths.closed, curves, strict=True
        ):
            assert is_closed == closed
            assert cad.deviation([theirs], [points]) < (2e-6 if kind != ARC else 1e-3)
            assert abs(theirs[0] - points[0]) < 2e-6


def test_arcs_are_within_a_nanometre() -> None:
    """Points of the cubic curves lie on the circle."""
    ring = cad.ring(ARC, radius=100.0, count=3)
    found = painted(written(Drawing(9, 9, (Layer.of_paths("c", "cut", "#000000", 1, ring),))))
    points = found["L0"][2][0][0][0][0]
    centre, radius, _, _ = ring.circles(np.arange(3))
    assert np.abs(np.abs(points[:, None] - centre) - radius).min(axis=1).max() < 3e-6


def test_the_page_has_the_exact_size() -> None:
    """A point is 25.4/72 mm."""
    page = objects(written(cad.drawing(LINE)))[2].decode()
    box = re.search(r"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", page)
    assert box
    assert float(box[1]) * MM == pytest.approx(100.0, abs=1e-6)
    assert float(box[2]) * MM == pytest.approx(80.0, abs=1e-6)


def test_layers_are_groups_that_can_be_switched() -> None:
    """An optional content group for each layer, by its name, in the catalogue and in the page's resources."""
    parts = [part.decode("latin-1") for part in objects(written(cad.drawing(LINE)))]
    groups = re.search(r"/OCGs \[([^]]*)\]", parts[0])
    assert groups
    assert groups[1] == "4 0 R 5 0 R 6 0 R"
    assert "/L0 4 0 R /L1 5 0 R /L2 6 0 R" in parts[2]
    names = [re.search(r"/Name <FEFF([0-9A-F]+)>", part) for part in parts[3:6]]
    assert [bytes.fromhex(name[1]).decode("utf-16-be") for name in names if name] == ["engrave", "score", "cut"]


def test_filled_layers_are_filled() -> None:
    """By the even-odd rule, without a line; a tile and its hole are one object."""
    paths = Paths.concatenate([cad.ring(QUAD), cad.ring(QUAD, radius=4.0)])
    layer = Layer("engrave", "engrave", "#336699", 0.1, paths, np.array([0, 2]), filled=True)
    text = content(written(Drawing(50, 50, (layer,))))
    assert text.count("f*\n") == 1
    assert "S\n" not in text
    assert "0.2 0.4 0.6 rg" in text


def test_title_and_recipe_are_in_the_information() -> None:
    """Any text; the same drawing gives the same bytes."""
    odd = "<&()\\ \ud800 鳥\n"
    drawing = Drawing(9, 9, (Layer.of_paths(odd, "cut", "#000000", 1, cad.ring(LINE)),), odd, {"design": odd})
    data = written(drawing)
    texts = re.findall(rb"/(Title|Subject) <FEFF([0-9A-F]+)>", objects(data)[-2])
    found = {key: bytes.fromhex(text.decode()).decode("utf-16-be") for key, text in texts}
    assert found[b"Title"] == odd.replace("\ud800", "?")
    assert json.loads(found[b"Subject"]) == {"design": odd}
    assert written(drawing) == data


def test_many_paths_are_all_there() -> None:
    """Blocks lose nothing; a layer without paths and paths without pieces do no harm."""
    ring = Paths.concatenate([cad.ring(QUAD, count=40), cad.ring(LINE, closed=False)])
    paths = Paths.concatenate([ring] * 1700)
    layers = (
        Layer("cut", "cut", "#000000", 1, paths, np.arange(0, 3401, 2)),
        Layer.of_paths("none", "score", "#000000", 1, Paths.empty()),
    )
    found = painted(written(Drawing(9, 9, layers)))
    assert [len(curves) for curves, _ in found["L0"][2]] == [2] * 1700
    assert found["L1"][2] == []


def test_inkscape_reads_the_same_contours(tmp_path: Path) -> None:
    """Every contour in its place and size, closed where it was."""
    drawing = cad.drawing(QUAD)
    file = tmp_path / "tile.pdf"
    file.write_bytes(written(drawing))
    found = [curve for curves in cad.inkscape_reads_pdf(file, drawing.height).values() for curve in curves]
    ours = [points for layer in drawing.layers for points in cad.sampled(layer.paths)]
    closed = [flag for layer in drawing.layers for flag in layer.paths.closed.tolist()]
    assert [flag for _, flag in found] == closed
    assert cad.deviation([points for points, _ in found], ours) < 1e-3


def test_the_reader_sees_a_wrong_file() -> None:
    """A place in the table that is off by one; a missing number."""
    data = written(cad.drawing(LINE))
    with pytest.raises(AssertionError):
        objects(data.replace(b"%PDF-1.5\n", b"%PDF-1.5\n\n"))
    short = zlib.compress(b"q 1 0 0 1 0 0 cm\n/OC /L0 BDC\nq 0 0 0 RG 0 0 0 rg 1 w\n1 m\n")
    with pytest.raises(AssertionError):
        painted(
            re.sub(
                rb"/Length \d+ (.*stream\n).*(\nendstream)",
                lambda m: b"/Length %d %s%s%s" % (len(short), m[1], short, m[2]),
                data,
                flags=re.DOTALL,
            )
        )
