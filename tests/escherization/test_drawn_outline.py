"""Which line of a drawing is its outline, and what becomes of the others."""

from __future__ import annotations

import math
import time
from pathlib import Path

import numpy as np
import pytest

import voronoi_tiles as vt
from voronoi_tiles.escherization.drawn_outline import read_outline

BLOB = "M20 20 C40 0 70 10 80 40 S60 90 40 80 S10 50 20 20 Z"
SQUARE = "M10 10h80v80h-80z"


def svg(folder: Path, body: str, page: str = 'width="100mm" height="100mm" viewBox="0 0 100 100"') -> Path:
    """A drawing of its own."""
    path = folder / "bird.svg"
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {page}>{body}</svg>', encoding="utf-8")
    return path


def test_the_outline_is_the_closed_line_around_all_else(tmp_path: Path) -> None:
    """In millimetres, y up; eyes within and whiskers beyond it are the rest, whatever their order."""
    whiskers = '<path d="M85 50 L99 40" stroke="#00f" fill="none"/>'
    eye = '<circle cx="50" cy="40" r="4" fill="#f00"/>'
    drawn = read_outline(svg(tmp_path, f'{whiskers}{eye}<path d="{SQUARE}" fill="none" stroke="#000"/>'))
    assert (drawn.name, drawn.notes) == ("bird", ())
    assert drawn.silhouette.polygon.bounds == pytest.approx((10.0, 10.0, 90.0, 90.0))
    assert [(shape.stroke, shape.fill) for shape in drawn.rest.shapes] == [("#0000ff", None), (None, "#ff0000")]


def test_holes_become_lines_of_art(tmp_path: Path) -> None:
    """As icons have eyes: what is cut out of the outline's shape is drawn in its colour, which a sentence says."""
    drawn = read_outline(svg(tmp_path, f'<path fill="#080808" fill-rule="evenodd" d="{SQUARE} M40 40h10v10h-10z"/>'))
    (hole,) = drawn.rest.shapes
    assert (hole.stroke, hole.fill) == ("#080808", None)
    assert hole.paths.bounds == pytest.approx((40.0, 50.0, 50.0, 60.0))
    assert drawn.silhouette.area == pytest.approx(6400.0)
    assert drawn.notes == (f"{tmp_path / 'bird.svg'}: 1 hole of the outline becomes art: a tile has none",)


def test_an_element_is_the_outline_where_it_is_named(tmp_path: Path) -> None:
    """Although another one is larger; an open path that is filled is closed."""
    path = svg(tmp_path, f'<path d="{SQUARE}"/><g id="b"><path d="M30 30h20v20h-20"/></g>')
    assert read_outline(path, element="b").silhouette.area == pytest.approx(400.0)
    assert len(read_outline(path, element="b").rest.shapes) == 1
    assert read_outline(svg(tmp_path, '<path d="M10 10 L90 10 L50 90"/>')).silhouette.area == pytest.approx(3200.0)
    with pytest.raises(vt.DrawingError, match="'zz'"):
        read_outline(path, element="zz")


def test_lines_end_to_end_are_one_outline(tmp_path: Path) -> None:
    """As CAD programs export them: lines and arcs of their own, in any order and direction."""
    sides = ["M10 10h80", "M90 90v-80", "M90 90a40 20 0 0 0 -80 0"]
    body = "".join(f'<path d="{side}" stroke="#000" fill="none"/>' for side in (*sides, "M20 20h9"))
    body += '<line x1="10" y1="90" x2="10" y2="10" stroke="#000"/>'
    drawn = read_outline(svg(tmp_path, body))
    assert drawn.silhouette.area == pytest.approx(6400.0 - math.pi * 40.0 * 20.0 / 2.0, rel=1e-3)
    assert [shape.paths.bounds for shape in drawn.rest.shapes] == [(20.0, 80.0, 29.0, 80.0)]


@pytest.mark.parametrize("more", ["M10 90v-79", "M10 90v-80 M10 10 l5 5"])
def test_lines_that_leave_a_gap_or_fork_are_no_outline(tmp_path: Path, more: str) -> None:
    """A gap of a millimetre, or a third line at a corner, that may go on either way."""
    body = "".join(f'<path d="{side}" stroke="#000" fill="none"/>' for side in ("M10 10h80", "M90 90v-80 M90 90h-80"))
    with pytest.raises(vt.DrawingError):
        read_outline(svg(tmp_path, f'{body}<path d="{more}" stroke="#000" fill="none"/>'))


def test_an_outline_that_is_drawn_twice_is_one(tmp_path: Path) -> None:
    """As fills and strokes of their own are: neither is art, which would be engraved along the cut."""
    twice = f'<path d="{BLOB}" fill="#ff0"/><path d="{BLOB}" fill="none" stroke="#000"/><circle cx="50" cy="40" r="4"/>'
    drawn = read_outline(svg(tmp_path, twice))
    assert [shape.paths.bounds for shape in drawn.rest.shapes] == [pytest.approx((46.0, 56.0, 54.0, 64.0))]
    near = f'<path d="{SQUARE}"/><path d="M11 11h78v78h-78z" fill="none" stroke="#000"/>'
    assert len(read_outline(svg(tmp_path, near)).rest.shapes) == 1


def test_a_background_that_is_taken_as_outline_is_said(tmp_path: Path) -> None:
    """The page's rectangle is the largest closed line; a rectangle that is all there is, is meant."""
    frame = '<rect width="100" height="100" fill="#fff"/>'
    (note,) = read_outline(svg(tmp_path, f'{frame}<path id="b" d="{BLOB}"/>')).notes
    assert "rectangle of the page, rect" in note
    assert "--element" in note
    assert not read_outline(svg(tmp_path, frame)).notes


def test_a_tangle_is_refused_at_once(tmp_path: Path) -> None:
    """20,000 corners of which each side crosses thousands of others: mending that takes minutes."""
    points = np.random.default_rng(1).uniform(0.0, 100.0, (20_000, 2))
    body = f'<path d="M{" ".join(f"{x:.4f} {y:.4f}" for x, y in points)} Z"/><circle cx="50" cy="50" r="9"/>'
    begun = time.process_time()
    with pytest.raises(vt.DrawingError, match="crosses itself"):
        read_outline(svg(tmp_path, body))
    assert time.process_time() - begun < 20.0


def test_what_is_left_out_is_said(tmp_path: Path) -> None:
    """A text within, and a size that is a guess."""
    notes = read_outline(
        svg(tmp_path, f'<path d="{BLOB}"/><text x="4" y="5">tit</text>', 'viewBox="0 0 100 100"')
    ).notes
    assert any("text" in note for note in notes)
    assert any("96" in note or "unit" in note for note in notes)


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ('<path d="M20 20 C40 0 70 10 80 40" fill="none" stroke="#000"/>', "the outline is open: the ends of path"),
        (
            f'<path d="{BLOB[:-2]} l-9 9" fill="none" stroke="#000"/><path d="M40 40h9v9h-9z"/>',
            "the outline is open: the ends of path",
        ),
        ('<path d="M10 10 L80 80 L80 10 L10 80 Z"/>', "it crosses itself at 45, 55, in mm"),
        ('<path id="a" d="M10 10h30v30h-30z"/><path id="b" d="M60 60h30v30h-30z"/>', "path 'a', line 1 and path 'b'"),
        ('<path d="M10 10h30v30h-30z M60 60h30v30h-30z"/>', "two outlines beside each other"),
        ("", "nothing is drawn"),
        ('<text x="4" y="5">tit</text>', "nothing is drawn"),
        ('<image width="9" height="9" href="data:image/png;base64,iVBORw0KGgo="/>', "picture of pixels"),
        ('<path d="M10 10 L50 50 L30 30 Z"/>', "the outline, path"),
        ('<path d="M10 10 L50 50" stroke="#000"/>', "nothing is drawn"),
        ('<path d="M0 50 h100 v0.1 h-100 z"/>', "too thin"),
    ],
)
def test_what_has_no_outline_is_refused(tmp_path: Path, body: str, said: str) -> None:
    """With the file, the element, and what to do."""
    with pytest.raises(vt.DrawingError) as error:
        read_outline(svg(tmp_path, body))
    assert said in str(error.value)
    assert str(error.value).startswith(str(tmp_path / "bird.svg"))
    assert error.value.remedy


def test_pixels_have_to_be_traced(tmp_path: Path) -> None:
    """A picture is refused with the way to an outline, whatever its suffix says."""
    (tmp_path / "bird.svg").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(60))
    with pytest.raises(vt.DrawingError, match="Trace Bitmap"):
        read_outline(tmp_path / "bird.svg")
