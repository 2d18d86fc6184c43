"""Which line of a drawing is its outline, and what becomes of the others."""

from __future__ import annotations

from pathlib import Path

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
    with pytest.raises(vt.DrawingError, match="'zz'"):
        read_outline(path, element="zz")


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
