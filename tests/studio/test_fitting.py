"""Designs for an outline that is dropped onto the page: what is said of them, their art, and what has no outline."""

from __future__ import annotations

import cmath
import math
import xml.etree.ElementTree as ET
from typing import Any

import pytest
import shapely
import svgpathtools
from helpers.outline_drawings import CROSSING, EYE, FISH, HEIGHT, OPEN, PIXELS, TWO, WIDTH

import voronoi_tiles as vt
from voronoi_tiles.studio.fitting import fitted

SVG = "{http://www.w3.org/2000/svg}"
GIVEN, EYE_INK = "#2060c0", "#ff0000"


@pytest.fixture(scope="module")
def said() -> list[tuple[dict[str, Any], bytes]]:
    """What is said of a fish in two groups."""
    return list(fitted(FISH.encode(), "work/fish.svg", "p1, p3", mirrored=True))


def test_designs_come_as_they_are_found(said: list[tuple[dict[str, Any], bytes]]) -> None:
    """First the outline, then progress that never goes back, and each design with figures that its tile has."""
    kinds = [message["type"] for message, _ in said]
    assert kinds[0] == "outline"
    assert set(kinds[1:]) == {"progress", "fit"}
    done = [message["done"] for message, _ in said if message["type"] == "progress"]
    assert done == sorted(done)
    assert done[-1] == 1.0
    found = [message for message, _ in said if message["type"] == "fit"]
    assert {message["group"] for message in found} == {"p1", "p3"}
    for message in found:
        design = vt.Design.from_dict(message["design"])
        assert design.group.name == message["group"]
        assert design.sites[0].name == "fish"
        assert design.tessellate()[0].outline.area == pytest.approx(shapely.Polygon(corners()).area, rel=0.15)
        assert len(design.noded[0].segments) == message["corners"]
        assert 0.7 < message["overlap"] < 1.0
        assert message["symmetric"] is False
        assert 0.0 < message["distance"] < 15.0


def corners() -> list[tuple[float, float]]:
    """The corners of the fish, read by another library."""
    (path,) = (each.get("d", "") for each in ET.fromstring(FISH).iter(f"{SVG}path"))
    return [(line.start.real, line.start.imag) for line in svgpathtools.parse_path(path)]


def drawn_in(svg: str, colour: str) -> svgpathtools.Path:
    """The one path of a colour in an SVG file."""
    (data,) = (each.get("d", "") for each in ET.fromstring(svg).iter(f"{SVG}path") if each.get("stroke") == colour)
    return svgpathtools.parse_path(data)


def test_pictures_are_as_upright_as_the_outline(said: list[tuple[dict[str, Any], bytes]]) -> None:
    """The given outline lies over each as it is drawn: as wide for its height, head to the left."""
    for message, _ in said:
        if message["type"] != "fit":
            continue
        root = ET.fromstring(message["picture"])
        assert {each.tag for each in root.iter()} == {f"{SVG}svg", f"{SVG}path"}
        given = drawn_in(message["picture"], GIVEN)
        left, right, top, bottom = given.bbox()
        assert (right - left) / (bottom - top) == pytest.approx(WIDTH / HEIGHT, rel=5e-3)
        tip = min((line.start for line in given), key=lambda z: z.real)
        assert (tip.imag - top) / (bottom - top) == pytest.approx(0.5, abs=0.01)


def test_art_lies_in_the_tile(said: list[tuple[dict[str, Any], bytes]]) -> None:
    """Laid by its table the eye is whole in its tile, and the picture has it where the outline has it."""
    for message, svg in said:
        if message["type"] != "fit":
            assert svg == b""
            continue
        art, root = message["art"], ET.fromstring(svg)
        height = float(root.get("viewBox", "").split()[3])
        turn = art.get("scale", 1.0) * cmath.exp(1j * math.radians(art.get("rotate", 0.0)))
        eye = [drawn_in(svg.decode(), EYE_INK).point(k / 40) for k in range(40)]
        placed = [turn * complex(z.real, height - z.imag) + complex(*art["translate"]) for z in eye]
        tile = vt.Design.from_dict(message["design"]).tessellate()[0].to_shapely(accuracy=1e-3)
        ring = shapely.Polygon([(z.real, z.imag) for z in placed])
        assert tile.contains(ring.buffer(1.0))
        assert ring.area == pytest.approx(math.pi * 1.5**2, rel=0.3)
        left, right, _, bottom = drawn_in(message["picture"], GIVEN).bbox()
        x0, x1, y0, y1 = drawn_in(message["picture"], EYE_INK).bbox()
        scale = WIDTH / (right - left)
        assert ((x0 + x1) / 2 - left) * scale == pytest.approx(EYE[0], abs=1.5)
        assert (bottom - (y0 + y1) / 2) * scale == pytest.approx(EYE[1], abs=1.5)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (PIXELS, "a picture of pixels has no outline.*Trace it first"),
        (OPEN.encode(), "the outline is open.*Close its path"),
        (CROSSING.encode(), "crosses itself"),
        (TWO.encode(), "two outlines beside each other"),
        (b"<svg", "broken XML"),
        (b'<svg xmlns="http://www.w3.org/2000/svg"/>', "nothing is drawn"),
    ],
)
def test_what_has_no_outline_is_refused(data: bytes, message: str) -> None:
    """At once, by the file's own name and with what to do."""
    with pytest.raises(vt.DrawingError, match=rf"(?s)^fish\.svg.*{message}"):
        next(iter(fitted(data, "../elsewhere/fish.svg", "p2", mirrored=True)))


@pytest.mark.parametrize(("groups", "mirrored", "named"), [("p2, p5", True, "p5"), ("pg", False, "mirror")])
def test_groups_that_cannot_be_are_refused(groups: str, mirrored: bool, named: str) -> None:
    """By their names, before anything is looked for."""
    with pytest.raises(vt.ArgumentError, match=named):
        list(fitted(FISH.encode(), "fish.svg", groups, mirrored=mirrored))
