"""The solid in the page, by WebGL: its pixels against a projection of the tests, and its context's life."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pytest
from helpers.page_server import PageServer
from helpers.solid_frames import FramePiece, read_frame
from numpy.typing import NDArray

from voronoi_tiles.studio.modelling import Modeller

LOFT: dict[str, Any] = {
    "schema": 1,
    "group": "p2",
    "cell": {"a": 40.0, "b": 40.0, "angle": 90.0},
    "site": [{"strokes": [{"catmull_rom": [[2.0, 10.0], [7.0, 6.0], [13.0, 14.0], [18.0, 10.0]]}]}],
    "solid": {"height": 30.0, "layers": 9, "turn": 60.0, "about": [10.0, 10.0]},
}
SIZE = (300, 220)
"""Of the window, in pixels of CSS."""
RATIO = 1.5
"""Device pixels a pixel of CSS."""

OPEN = """async ([data, width, height, ratio]) => {
    const { SolidPainter } = await import("/gl/solid.js");
    const { Look, unpacked } = await import("/model/solids.js");
    const frame = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)).buffer;
    const canvas = Object.assign(document.createElement("canvas"), { width, height });
    document.body.append(canvas);
    let restored = 0;
    const painter = SolidPainter.of(canvas, () => { restored += 1; });
    const gl = canvas.getContext("webgl2");
    const pixels = () => {
        const found = new Uint8Array(4 * canvas.width * canvas.height);
        gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, found);
        return btoa(Array.from(found, (byte) => String.fromCharCode(byte)).join(""));
    };
    const painted = (view, apart) => {
        painter.paint(Object.assign(new Look(), view), apart, ratio);
        return pixels();
    };
    const solid = unpacked(frame);
    painter.show(solid);
    window.test = { painter, solid, canvas, gl, painted, pixels, unpacked, restored: () => restored };
}"""


@pytest.fixture(scope="module")
def frame() -> bytes:
    """The frame of a loft with its neighbours."""
    *_, last = Modeller().solids(1, LOFT, {"accuracy": 0.3}, "twist")
    return last.frame


@pytest.fixture(scope="module")
def page(chromium: Any, page_server: PageServer, frame: bytes) -> Iterator[Any]:
    """A page with a painter that has this solid, and what the script needs, as window.test."""
    context = chromium.new_context()
    page = context.new_page()
    page.goto(page_server.url)
    page.evaluate(OPEN, [base64.b64encode(frame).decode(), SIZE[0] * RATIO, SIZE[1] * RATIO, RATIO])
    yield page
    context.close()


def image(page: Any, view: dict[str, Any], apart: float) -> NDArray[np.uint8]:
    """What is painted: uint8 (height, width, 4), from the bottom up."""
    found = page.evaluate("([view, apart]) => window.test.painted(view, apart)", [view, apart])
    width, height = (round(side * RATIO) for side in SIZE)
    return np.frombuffer(base64.b64decode(found), np.uint8).reshape(height, width, 4)


def projected(pieces: Sequence[NDArray[np.float64]], view: dict[str, Any]) -> list[NDArray[np.float64]]:
    """Points in device pixels from the lower left, with their depth towards the eye: float64 (n, 3) a piece.

    By rotations in turn, as a camera is set up that goes round the solid: about the vertical, then down.
    """
    turn, tilt = np.radians(view["turn"]), np.radians(view["tilt"])
    about = np.array([[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    # y runs away from the eye before it is tilted.
    down = np.array([[1, 0, 0], [0, np.sin(tilt), np.cos(tilt)], [0, -np.cos(tilt), np.sin(tilt)]])
    found = []
    for points in pieces:
        seen = points @ (down @ about).T
        flat = seen[:, :2] * view["scale"] + np.array(view["pan"]) + np.array(SIZE) / 2
        found.append(np.column_stack((flat * RATIO, seen[:, 2])))
    return found


def shifted(frame: bytes, apart: float) -> tuple[dict[str, Any], list[FramePiece], list[NDArray[np.float64]]]:
    """The message, its pieces, and their vertices pulled apart."""
    message, pieces = read_frame(frame)
    away = [np.array([*piece["middle"][:2], 0.0]) * apart for piece in message["pieces"]]
    return message, pieces, [piece.vertices + by for piece, by in zip(pieces, away, strict=True)]


VIEWS: list[tuple[dict[str, Any], float]] = [
    ({"turn": -24, "tilt": 42, "scale": 1.4, "pan": [0, 0]}, 0.0),
    ({"turn": 130, "tilt": -35, "scale": 1.1, "pan": [12, -7]}, 0.3),
    ({"turn": 0, "tilt": 90, "scale": 1.2, "pan": [-20, 5]}, 0.2),
    ({"turn": 77, "tilt": 0, "scale": 1.3, "pan": [0, 0]}, 0.1),
]


@pytest.mark.parametrize(("view", "apart"), VIEWS, ids=["angle", "below", "above", "front"])
def test_the_drawn_box_is_that_of_the_vertices(page: Any, frame: bytes, view: dict[str, Any], apart: float) -> None:
    """To a pixel and a half, from above, below and the side; beside it nothing is drawn."""
    drawn = image(page, view, apart)
    rows, columns = np.nonzero(drawn[:, :, 3])
    _, _, points = shifted(frame, apart)
    seen = np.concatenate(projected(points, view))
    expected = [*seen[:, :2].min(axis=0), *seen[:, :2].max(axis=0)]
    assert expected[0] > 0
    assert expected[2] < SIZE[0] * RATIO
    found = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
    assert np.abs(np.array(found) - expected).max() <= 1.5


@pytest.mark.parametrize(("view", "apart"), VIEWS, ids=["angle", "below", "above", "front"])
def test_what_is_nearest_is_seen(page: Any, frame: bytes, view: dict[str, Any], apart: float) -> None:
    """At random points inside triangles the pixel has the hue of the piece that is nearest there, lit."""
    drawn = image(page, view, apart).astype(np.float64)
    message, pieces, points = shifted(frame, apart)
    seen = projected(points, view)
    corners = np.concatenate([all_[piece.triangles] for all_, piece in zip(seen, pieces, strict=True)])
    owner = np.repeat(np.arange(len(pieces)), [len(piece.triangles) for piece in pieces])
    base = [[int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)] for colour in message["colours"]]
    colours = np.array([base[piece["colour"]] for piece in message["pieces"]])
    chance = np.random.default_rng(5)
    rows, columns = np.nonzero(drawn[:, :, 3] == 255)
    right = total = 0
    for k in chance.choice(len(rows), 100, replace=False):
        at = np.array([columns[k] + 0.5, rows[k] + 0.5])
        near = _owners(corners, owner, at)
        if len(set(near)) != 1:  # at an edge
            continue
        total += 1
        pixel = drawn[rows[k], columns[k], :3] / 255
        light = pixel / colours[near[0]]
        right += bool(np.ptp(light) < 0.04 and 0.3 < light.mean() <= 1.05)
    assert total > 50
    assert right == total


def _owners(corners: NDArray[np.float64], owner: NDArray[np.intp], at: NDArray[np.float64]) -> list[int]:
    """The nearest pieces at a point of the image and a pixel and a half about it, -1 where there is none."""
    found = []
    for by in ((0, 0), (1.5, 0), (-1.5, 0), (0, 1.5), (0, -1.5)):
        a, b, c = (corners[:, k, :2] - (at + by) for k in range(3))

        def cross(p: NDArray[np.float64], q: NDArray[np.float64]) -> NDArray[np.float64]:
            return p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]

        u, v, w = cross(b, c), cross(c, a), cross(a, b)
        area = u + v + w
        inside = (np.minimum(np.minimum(u, v), w) >= 0) & (area > 1e-9)  # counter-clockwise: it faces the eye
        if not inside.any():
            found.append(-1)
            continue
        depth = (corners[inside, :, 2] * np.stack((u, v, w), axis=1)[inside]).sum(axis=1) / area[inside]
        found.append(int(owner[inside][depth.argmax()]))
    return found


def test_pieces_part(page: Any) -> None:
    """Pulled apart one sees between them from above; where they fill the slab one does not."""
    view = {"turn": 0, "tilt": 90, "scale": 1.2, "pan": [0, 0]}
    middle = [image(page, view, apart)[120:210, 180:270, 3] for apart in (0.0, 0.4)]
    assert (middle[0] == 255).all()
    assert (middle[1] == 0).mean() > 0.05


def test_buffers_are_unpacked_as_they_were_sent(page: Any, frame: bytes) -> None:
    """Every number of positions and triangles, and each corner of what is drawn."""
    sums = page.evaluate(
        """async () => {
            const { cornersOf } = await import("/model/solids.js");
            return window.test.solid.pieces.map((piece) => {
                const corners = cornersOf(piece);
                const [places, bytes] = [new Float32Array(corners), new Int8Array(corners)];
                return {
                    positions: [...piece.positions],
                    triangles: [...piece.triangles],
                    drawn: [...piece.triangles].map((_, k) => [...places.slice(4 * k, 4 * k + 3)]),
                    normals: [...piece.triangles].map((_, k) => [...bytes.slice(16 * k + 12, 16 * k + 16)]),
                };
            });
        }"""
    )
    _, pieces = read_frame(frame)
    for sent, found in zip(pieces, sums, strict=True):
        assert np.array_equal(np.array(found["positions"], np.float32), sent.vertices.ravel())
        assert np.array_equal(np.array(found["triangles"], np.uint32), sent.triangles.ravel())
        assert np.array_equal(np.array(found["drawn"], np.float32), sent.vertices[sent.triangles.ravel()])
        assert np.array_equal(np.array(found["normals"], np.int8), sent.normals.reshape(-1, 4))


def test_a_lost_context_comes_back(page: Any) -> None:
    """What was shown is drawn again, as if nothing had been; meanwhile nothing fails."""
    found = page.evaluate(
        """async ([view]) => {
            const { gl, painted, restored } = window.test;
            const before = painted(view, 0.2);
            const lose = gl.getExtension("WEBGL_lose_context");
            lose.loseContext();
            await new Promise((done) => setTimeout(done, 50));
            painted(view, 0.2);
            lose.restoreContext();
            const start = performance.now();
            while (!restored() && performance.now() - start < 8000) await new Promise((done) => setTimeout(done, 10));
            return { same: painted(view, 0.2) === before, restored: restored(), error: gl.getError(),
                     varied: new Set(atob(before)).size };
        }""",
        [VIEWS[0][0]],
    )
    assert found["same"]
    assert found["restored"] == 1
    assert found["error"] == 0
    assert found["varied"] > 20


def test_no_solid_is_an_empty_picture(page: Any) -> None:
    """Nothing of the last one stays."""
    found = page.evaluate(
        """([view]) => {
            const { painter, painted, solid } = window.test;
            painter.show(null);
            const none = painted(view, 0.2);
            painter.show(solid);
            return [none, painted(view, 0.2)].map((picture) => new Set(atob(picture)).size > 1);
        }""",
        [VIEWS[0][0]],
    )
    assert found == [False, True]
