"""Drawings as Inkscape hands them over, in many units and under many transforms, and what they draw by our own sums.

No sum here shares code with the reader: a point goes to the page by 3 x 3 matrices and the size of the page.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.inkscape.extension import answer

Matrix = NDArray[np.float64]

NS: Final = (
    'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
)

LINE: Final = 'style="fill:none;stroke:#000000;stroke-width:0.5"'


def matrix(a: float, b: float, c: float, d: float, e: float, f: float) -> Matrix:
    """The matrix of SVG's function of this name."""
    return np.array([[a, c, e], [b, d, f], [0.0, 0.0, 1.0]])


def turn(degrees: float) -> Matrix:
    """SVG's rotate."""
    t = np.radians(degrees)
    return matrix(np.cos(t), np.sin(t), -np.sin(t), np.cos(t), 0.0, 0.0)


@dataclass(frozen=True)
class Page:
    """A page: the attributes of its root, and of a group and of each object in it, with what they do to a point."""

    name: str
    root: str
    group: str
    own: str
    to_page: Matrix  # of user units to millimetres from the upper left corner, y down
    within: Matrix  # of an object's coordinates to user units
    height: float  # millimetres

    def svg(self, body: str, outside: str = "") -> bytes:
        """A drawing with objects in the group."""
        return (
            f'<?xml version="1.0" encoding="UTF-8"?>\n<svg {NS} {self.root}>\n<g id="layer1" {self.group}>\n'
            f"{body.replace('OWN', self.own)}\n</g>\n{outside}</svg>\n"
        ).encode()

    def mm(self, points: Complexes) -> Complexes:
        """Points in an object's coordinates in millimetres from the lower left corner of the page, y up."""
        return self.user_mm(_mapped(self.within, points))

    def user_mm(self, points: Complexes) -> Complexes:
        """Points in user units, likewise."""
        return np.asarray(_mapped(self.to_page, points).conj() + 1j * self.height)


def _mapped(by: Matrix, points: Complexes) -> Complexes:
    x, y = points.real, points.imag
    return np.asarray((by[0, 0] * x + by[0, 1] * y + by[0, 2]) + 1j * (by[1, 0] * x + by[1, 1] * y + by[1, 2]))


_PX = 25.4 / 96

PAGES: Final = (
    Page("mm", 'width="210mm" height="297mm" viewBox="0 0 210 297"', "", "", np.eye(3), np.eye(3), 297.0),
    Page(
        "px, no viewBox",
        'width="900" height="700"',
        'transform="scale(3) translate(20 30)"',
        "",
        np.diag([_PX, _PX, 1.0]),
        np.diag([3.0, 3.0, 1.0]) @ matrix(1, 0, 0, 1, 20, 30),
        700 * _PX,
    ),
    Page(
        "hundredths of a millimetre",
        'width="210mm" height="297mm" viewBox="0 0 21000 29700"',
        'transform="matrix(90 0 0 90 4000 5000)"',
        'transform="rotate(33)"',
        np.diag([0.01, 0.01, 1.0]),
        matrix(90, 0, 0, 90, 4000, 5000) @ turn(33),
        297.0,
    ),
    Page(
        "inches, another shape of the viewBox",
        'width="8in" height="10in" viewBox="10 -20 400 300"',
        'transform="translate(150 100) rotate(-70)"',
        "",
        # As wide as the page, 8 in over 400 units; what is left of the height is halved.
        matrix(0.508, 0, 0, 0.508, 0, (254.0 - 152.4) / 2) @ matrix(1, 0, 0, 1, -10, 20),
        matrix(1, 0, 0, 1, 150, 100) @ turn(-70),
        254.0,
    ),
    Page(
        "cm, sheared",
        'width="30cm" height="20cm" viewBox="0 0 30 20"',
        'transform="matrix(.08 .02 -.03 .11 9 7)"',
        'transform="translate(5 -4)"',
        np.diag([10.0, 10.0, 1.0]),
        matrix(0.08, 0.02, -0.03, 0.11, 9, 7) @ matrix(1, 0, 0, 1, 5, -4),
        200.0,
    ),
    Page(
        "stretched and mirrored",
        'width="200mm" height="300mm" viewBox="0 0 100 100" preserveAspectRatio="none"',
        'transform="translate(60 40) scale(-0.5 0.4)"',
        'transform="rotate(-20)"',
        np.diag([2.0, 3.0, 1.0]),
        matrix(1, 0, 0, 1, 60, 40) @ np.diag([-0.5, 0.4, 1.0]) @ turn(-20),
        300.0,
    ),
)
"""Six combinations of unit, viewBox and transform."""


@dataclass(frozen=True)
class Object:
    """An object: its element, and the strokes that it draws as points in its own coordinates, None where it has arcs.

    Each stroke is a polyline or, of 3n + 1 points, cubic Bezier curves.
    """

    element: str
    polylines: tuple[Complexes, ...] | None = None
    curves: tuple[Complexes, ...] = ()

    def strokes(self, page: Page) -> list[dict[str, Any]]:
        """The same as strokes of a design, in millimetres."""
        assert self.polylines is not None
        listed = [("polyline", page.mm(points)) for points in self.polylines]
        listed += [("bezier", page.mm(points)) for points in self.curves]
        return [{kind: [[p.real, p.imag] for p in points.tolist()]} for kind, points in listed]


def _points(*places: complex) -> Complexes:
    return np.array(places, np.complex128)


def _raised(*places: complex) -> Complexes:
    """A quadratic curve as a cubic one."""
    a, c, b = places
    return _points(a, (a + 2 * c) / 3, (b + 2 * c) / 3, b)


OBJECTS: Final = {
    "lines": Object(
        f'<path id="lines" OWN {LINE} d="M 3 4 l 20 5 h -4 V 22 L 9 17"/>',
        (_points(3 + 4j, 23 + 9j, 19 + 9j, 19 + 22j, 9 + 17j),),
    ),
    "closed": Object(
        f'<path id="closed" OWN {LINE} d="m 3 4 20 5 -10 14 z"/>', (_points(3 + 4j, 23 + 9j, 13 + 23j, 3 + 4j),)
    ),
    "cubics": Object(
        f'<path id="cubics" OWN {LINE} d="M 2 3 C 8 -4 15 14 24 6 s 9 3 4 14"/>',
        (),
        (_points(2 + 3j, 8 - 4j, 15 + 14j, 24 + 6j, 33 - 2j, 33 + 9j, 28 + 20j),),
    ),
    "quadratics": Object(
        f'<path id="quadratics" OWN {LINE} d="M 2 3 Q 12 -9 20 8 t 6 12"/>',
        (),
        (_raised(2 + 3j, 12 - 9j, 20 + 8j), _raised(20 + 8j, 28 + 25j, 26 + 20j)),
    ),
    "line": Object(f'<line id="line" OWN {LINE} x1="2" y1="3" x2="25" y2="14"/>', (_points(2 + 3j, 25 + 14j),)),
    "polyline": Object(
        f'<polyline id="polyline" OWN {LINE} points="2,3 25,14 12,21"/>', (_points(2 + 3j, 25 + 14j, 12 + 21j),)
    ),
    "polygon": Object(
        f'<polygon id="polygon" OWN {LINE} points="2,3 25,14 12,21"/>',
        (_points(2 + 3j, 25 + 14j, 12 + 21j, 2 + 3j),),
    ),
    "rect": Object(
        f'<rect id="rect" OWN {LINE} x="2" y="3" width="21" height="13"/>',
        (_points(2 + 3j, 23 + 3j, 23 + 16j, 2 + 16j, 2 + 3j),),
    ),
    "filled": Object(
        '<path id="filled" OWN style="fill:#c00;stroke:none" d="M 3 4 L 23 9 L 13 23"/>',
        (_points(3 + 4j, 23 + 9j, 13 + 23j, 3 + 4j),),
    ),
    "clone": Object(
        '<use id="clone" OWN xlink:href="#line" x="3" y="5"/>',
    ),
    "arcs": Object(f'<path id="arcs" OWN {LINE} d="M 2 3 A 12 7 30 0 1 20 9 a 5 5 0 0 0 6 8"/>'),
    "circle": Object(f'<circle id="circle" OWN {LINE} cx="12" cy="9" r="8"/>'),
    "ellipse": Object(f'<ellipse id="ellipse" OWN {LINE} cx="12" cy="9" rx="11" ry="6"/>'),
    "rounded": Object(f'<rect id="rounded" OWN {LINE} x="2" y="3" width="21" height="13" rx="4" ry="3"/>'),
}
"""Every kind of stroke, by its id."""


def run(drawing: bytes, *words: str, entry: str = "tiles", folder: Path) -> bytes:
    """What an entry makes of a drawing."""
    file = folder / "drawing.svg"
    file.write_bytes(drawing)
    return answer(entry, [*words, str(file)])


def paths_of(drawing: bytes, role: str = "tiles") -> dict[str, str]:
    """The path data of the tiles in a drawing by their labels."""
    label = "{http://www.inkscape.org/namespaces/inkscape}label"
    (layer,) = ET.fromstring(drawing).iterfind(f".//*[@{{urn:voronoi-tiles:recipe}}role='{role}']")
    return {path.get(label, ""): path.get("d", "") for path in layer.iter("{http://www.w3.org/2000/svg}path")}


def edges_of_path(data: str) -> Complexes:
    """The edges of path data of M, L, Q and Z: start, control (the middle of lines) and end, (n, 3)."""
    found = []
    here = start = 0j
    for letter, text in re.findall(r"([MLQZ])([^MLQZ]*)", data):
        numbers = [float(word) for word in text.split()]
        points = [complex(x, y) for x, y in zip(numbers[::2], numbers[1::2], strict=True)]
        if letter == "M":
            here = start = points[0]
            continue
        end = start if letter == "Z" else points[-1]
        if end != here:
            found.append((here, points[0] if letter == "Q" else (here + end) / 2, end))
        here = end
    return np.array(found, np.complex128)


def edges_of_document(rings: list[list[dict[str, Any]]]) -> Complexes:
    """The same of the rings in an outline document."""
    found = []
    for ring in rings:
        for edge in ring:
            points = [complex(*point) for point in edge["points"]]
            middle = points[1] if edge["kind"] == "parabola" else (points[0] + points[-1]) / 2
            found.append((points[0], middle, points[-1]))
    return np.array(found, np.complex128)


def difference(edges: Complexes, others: Complexes) -> float:
    """The farthest that a point of an edge lies from that of its counterpart, whichever way they run.

    Infinite where there are more of the ones than of the others.
    """
    if edges.shape != others.shape:
        return float("inf")
    there = np.abs(edges[:, None] - others[None]).max(axis=2)
    back = np.abs(edges[:, None] - others[None, :, ::-1]).max(axis=2)
    each = np.minimum(there, back)
    return float(max(each.min(axis=0).max(), each.min(axis=1).max()))
