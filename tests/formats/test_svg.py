"""The SVG writer: exact numbers, the right size, one closed path per tile, nothing that cutters do not read."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Sequence
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from helpers.outlines import RIGHT

from voronoi_tiles.base.maps import Isometry
from voronoi_tiles.fabrication.exact import exact_drawing
from voronoi_tiles.formats.page import fitting_page
from voronoi_tiles.formats.svg.path_text import decimal_text, path_data
from voronoi_tiles.formats.svg.writer import write_svg
from voronoi_tiles.pictures.notebook import tiling_picture
from voronoi_tiles.vector.arcs import LineArc, ParabolaArc
from voronoi_tiles.vector.outline import Outline

SVG = "{http://www.w3.org/2000/svg}"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
RECIPE = "{urn:voronoi-tiles:recipe}"


def subpaths(data: str) -> list[list[tuple[str, list[float]]]]:
    """Read path data of M, L, Q and Z back, strictly."""
    assert re.fullmatch(r"[MLQZ0-9. -]+", data)
    result: list[list[tuple[str, list[float]]]] = []
    for command, numbers in re.findall(r"([MLQZ])([^MLQZ]*)", data):
        values = [float(number) for number in numbers.split()]
        assert len(values) == {"M": 2, "L": 2, "Q": 4, "Z": 0}[command]
        if command == "M":
            result.append([])
        result[-1].append((command, values))
    return result


def parse(text: str) -> ET.Element:
    """Parse an SVG file."""
    return ET.fromstring(text)


def write(tiles: Sequence[tuple[str, Outline]], unit_mm: float = 1.0, design: str = "{}") -> str:
    """Write the file of tiles."""
    file = io.BytesIO()
    recipe = {"program": "voronoi-tiles", "version": "1.2.3", "design": design}
    write_svg(exact_drawing(tiles, unit_mm, recipe), file, exact=True)
    return file.getvalue().decode()


def make(outline: Outline, unit_mm: float = 1.0, design: str = "{}", name: str = "bird") -> str:
    """Write the file of one tile."""
    return write([(name, outline)], unit_mm, design)


def test_the_path_is_the_outline_bit_for_bit(mixed: Outline) -> None:
    """Reading the numbers back gives the same floats, y turned; the last straight edge is Z's."""
    (ring,) = subpaths(path_data(mixed.paths))
    assert [command for command, _ in ring] == ["M", "Q", "L", "L", "Z"]
    assert ring[0][1] == [10.0, 0.0]
    assert ring[1][1] == [14.0, -5.0, 10.0, -10.0]
    third = mixed.transformed(Isometry(1 + 0j, complex(1 / 3, 1e-7), conj=False))
    (ring,) = subpaths(path_data(third.paths))
    assert [complex(values[-2], -values[-1]) for _, values in ring if values] == third.start.tolist()


def test_holes_are_subpaths_of_the_same_path(ring: Outline) -> None:
    """A tile with a hole is one path of two closed subpaths."""
    outer, hole = subpaths(path_data(ring.paths))
    assert outer == [("M", [0.0, 0.0]), ("L", [10.0, 0.0]), ("L", [10.0, -10.0]), ("L", [0.0, -10.0]), ("Z", [])]
    assert hole[0] == ("M", [4.0, -4.0])
    root = parse(make(ring))
    assert len(root.findall(f".//{SVG}path")) == 1


def test_a_last_curve_is_drawn_before_closing(lens: Outline) -> None:
    """Z can only draw a straight line."""
    (ring,) = subpaths(path_data(lens.paths))
    assert [command for command, _ in ring] == ["M", "Q", "Q", "Z"]
    assert ring[2][1][2:] == ring[0][1]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1.0, "1"),
        (-0.0, "0"),
        (0.1, "0.1"),
        (1e-7, "0.0000001"),
        (-1.5e-9, "-0.0000000015"),
        (1e22, "10000000000000000000000"),
        (123456.789, "123456.789"),
        (0.1 + 0.2, "0.30000000000000004"),
    ],
)
def test_numbers_are_decimals_without_exponent(value: float, text: str) -> None:
    """The shortest decimal that reads back as the same float."""
    assert decimal_text(value) == text
    assert float(decimal_text(value)) == value


def test_random_numbers_read_back_as_the_same_float() -> None:
    """Over all exponents that designs may have."""
    rng = np.random.default_rng(3)
    for value in (rng.normal(size=500) * 10.0 ** rng.integers(-30, 30, 500)).tolist():
        text = decimal_text(value)
        assert float(text) == value
        assert "e" not in text


@pytest.mark.parametrize(
    ("length", "text"),
    [
        (60.0, "60"),
        (60.000000000000014, "60"),
        (59.99999999999999, "60"),
        (33.46892311, "33.5"),
        (33.5, "33.5"),
        (0.3, "0.3"),
        (1234567.21, "1234567.3"),
        (0.00012345678, "0.00013"),
    ],
)
def test_pages_are_tenths_of_a_millimetre_with_the_tiles_in_the_middle(length: float, text: str) -> None:
    """Short decimals, the smallest that hold the tiles; as much is free on the left as on the right."""
    for low in (0.0, -17.3, 1000.1):
        width, height, corner = fitting_page(low, 5.0, low + length, 6.0)
        if low == 0.0:
            assert (decimal_text(width), height, corner.imag) == (text, 1.0, 5.0)
        assert corner.real + width / 2 == pytest.approx(low + length / 2, abs=1e-9)


@pytest.mark.parametrize("unit_mm", [1.0, 10.0, 25.4])
def test_the_file_has_the_physical_size(square: Outline, unit_mm: float) -> None:
    """One user unit is one millimetre, width and viewBox are the same decimals, the tile fills the page."""
    root = parse(make(square, unit_mm))
    size = {1.0: "10", 10.0: "100", 25.4: "254"}[unit_mm]
    assert root.get("width") == f"{size}mm"
    assert root.get("height") == f"{size}mm"
    assert root.get("viewBox") == f"0 0 {size} {size}"
    path = root.find(f".//{SVG}path")
    assert path is not None
    (ring,) = subpaths(path.get("d", ""))
    points = np.array([values for _, values in ring if values])
    assert points.min(axis=0).tolist() == [0, 0]
    assert points.max(axis=0).tolist() == [float(size), float(size)]


def test_the_picture_looks_the_same(mixed: Outline) -> None:
    """What is up in the design is up on the page: y is turned, and only y."""
    up = Outline.from_rings([[LineArc(0j, 4 + 0j, RIGHT), LineArc(4 + 0j, 3j, RIGHT), LineArc(3j, 0j, RIGHT)]])
    path = parse(make(up)).find(f".//{SVG}path")
    assert path is not None
    assert path.get("d") == "M 0 3 L 4 3 L 0 0 Z"
    assert "Q 14 5 10 0" in make(mixed)


def test_only_what_cutters_read(mixed: Outline, ring: Outline) -> None:
    """Paths in a layer: no clones, transforms, text, styles, and no fill."""
    text = write([("a", mixed), ("b", ring)])
    root = parse(text)
    tags = [element.tag.removeprefix(SVG) for element in root.iter()]
    assert tags == ["svg", "metadata", f"{RECIPE}recipe", "defs", "g", "path", "path"]
    assert "transform" not in text
    assert "style" not in text
    layer = root.find(f"{SVG}g")
    assert layer is not None
    assert layer.get(f"{INKSCAPE}groupmode") == "layer"
    assert layer.get(f"{INKSCAPE}label") == "cut"
    assert (layer.get("fill"), layer.get("stroke"), layer.get("stroke-width")) == ("none", "#000000", "0.025")
    assert [path.get(f"{INKSCAPE}label") for path in layer] == ["a", "b"]


def test_the_recipe_is_in_the_metadata(square: Outline) -> None:
    """Version and design come back from the file, whatever characters they hold."""
    design = json.dumps({"name": '<bird> & "ünïcode" \u0001'}, ensure_ascii=False)
    recipe = parse(make(square, design=design)).find(f"{SVG}metadata/{RECIPE}recipe")
    assert recipe is not None
    assert recipe.get("version") == "1.2.3"
    assert recipe.text == design


@pytest.mark.parametrize("name", ['"<&>"', "\x00\x1b[31m", "\ud800", "鳥"])
def test_any_name_gives_a_well_formed_file(square: Outline, name: str) -> None:
    """Characters that XML cannot carry are replaced."""
    root = parse(make(square, name=name, design=name).encode().decode())
    assert root.find(f".//{SVG}path") is not None


def test_the_same_recipe_gives_the_same_bytes(mixed: Outline) -> None:
    """No dates, no counters."""
    assert make(mixed) == make(mixed)


def test_a_preview_is_a_picture(lens: Outline) -> None:
    """Notebooks get the tile and its site, at a size to look at."""
    text = tiling_picture([(lens, np.array([[-1, 1], [0.5 + 0.25j, 0.5 + 0.25j]]))])
    root = parse(text)
    tile, site = root.findall(f"{SVG}path")
    assert root.get("width") == "312"
    assert tile.get("d", "").count("Q") == 2
    assert site.get("d", "").count("M") == 2


def test_the_reader_of_the_tests_sees_a_wrong_file() -> None:
    """Exponents and missing numbers are caught."""
    for broken in ("M 1e-7 0 Z", "M 0 Z", "M 0 0 C 1 1 2 2 3 3 Z"):
        with pytest.raises(AssertionError):
            subpaths(broken)


def test_tiny_and_far_tiles_keep_their_shape() -> None:
    """A tile of 1e-9 units, and one a million units away."""
    for shift, size in ((0j, 1e-9), (1e6 + 1e6j, 1.0)):
        a, b, c = shift, shift + size, shift + 1j * size
        outline = Outline.from_rings(
            [
                [
                    LineArc(a, b, RIGHT),
                    ParabolaArc(b, shift + size * (1 + 1j), c, 0j, (0j, 1j), RIGHT),
                    LineArc(c, a, RIGHT),
                ]
            ]
        )
        path = parse(make(outline)).find(f".//{SVG}path")
        assert path is not None
        (ring,) = subpaths(path.get("d", ""))
        assert ring[0][1] == pytest.approx([0, size], rel=1e-9)
        assert ring[2][1] == pytest.approx([size, 0, 0, 0], rel=1e-9, abs=size * 1e-9)
