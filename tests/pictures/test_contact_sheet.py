"""Contact sheets: pictures, captions and links are all there, the same in SVG, in a PNG and on a page."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from PIL import Image

import voronoi_tiles as vt
from voronoi_tiles.pictures.contact_sheet import ContactSheet, DrawnPaths, SheetPicture, square_about

SVG = "{http://www.w3.org/2000/svg}"
XHTML_BREAK = "<br>"
TITLE = "Cats & <dogs>"


def picture(group: str, caption: tuple[str, ...] = (), link: str = "") -> SheetPicture:
    """A picture of a starter."""
    tiling = vt.starter(group).tessellate()
    region = square_about(tile.outline for tile in tiling)
    tiles = [(tile.outline, tile.site.ends) for tile in tiling]
    return SheetPicture.of_tiles(tiles, [copy.outline for copy in tiling.copies(region)], caption=caption, link=link)


@pytest.fixture(scope="module")
def sheet() -> ContactSheet:
    """A sheet of three pictures in two rows."""
    pictures = (
        picture("p4", ("p4 < p6 & so on", "0.995"), "designs/a b.toml"),
        picture("p6m", ("a caption of many more words than can stand below a picture of this size " * 3,)),
        picture("pg"),
    )
    return ContactSheet(pictures, TITLE, columns=2)


def test_svg_has_the_pictures_their_captions_and_links(sheet: ContactSheet) -> None:
    """The SVG file is well-formed: a drawing for each picture, each line of text, and a link where there is one."""
    root = ET.fromstring(sheet.svg)
    assert len(root.findall(f".//{SVG}svg")) == 3
    assert [text.text for text in root.iter(f"{SVG}text")] == [
        TITLE,
        *(line for one in sheet.pictures for line in one.caption),
    ]
    links = [one.get("{http://www.w3.org/1999/xlink}href") or one.get("href") for one in root.iter(f"{SVG}a")]
    assert links == ["designs/a b.toml"]
    drawn = [len(one.findall(f"{SVG}path")) for one in root.iter(f"{SVG}svg") if one is not root]
    assert drawn == [len(one.drawn) for one in sheet.pictures]


def test_the_page_has_the_same(sheet: ContactSheet) -> None:
    """The page is complete in itself, with the same paths as the SVG file, captions escaped, and the links."""
    page = sheet.html
    assert page.count("<figure>") == 3
    assert "p4 &lt; p6 &amp; so on<br>0.995" in page
    assert '<a href="designs/a b.toml">' in page
    assert "http" not in page.replace("http-equiv", "")
    body = ET.fromstring(page[page.index("<body>") : page.index("</html>")].replace(XHTML_BREAK, "<br/>"))
    figures = [[path.get("d") for path in figure.iter("path")] for figure in body.iter("figure")]
    drawings = [
        [path.get("d") for path in one.iter(f"{SVG}path")]
        for one in ET.fromstring(sheet.svg).iter(f"{SVG}svg")
        if one.get("overflow")
    ]
    assert figures == drawings


def test_the_png_shows_the_tiles_and_their_captions(sheet: ContactSheet) -> None:
    """The image is as large as the drawing; the middle of a tile has its colour, and text has ink."""
    image = np.asarray(Image.open(io.BytesIO(sheet.png)))
    root = ET.fromstring(sheet.svg)
    assert image.shape == (int(root.get("height", "")), int(root.get("width", "")), 3)
    assert np.array_equal(image, sheet.pixels)
    assert (image[0] == 255).all()
    bare = replace(sheet, pictures=tuple(replace(one, caption=()) for one in sheet.pictures), title="")
    assert (bare.pixels < 128).sum() < (image < 128).sum()
    place = next(one for one in root.iter(f"{SVG}svg") if one.get("overflow"))
    x, y, side = (int(float(place.get(key, ""))) for key in ("x", "y", "width"))
    outline = sheet.pictures[0].drawn[1]
    assert tuple(image[y + side // 4, x + side // 2]) == tuple(bytes.fromhex(outline.fill[1:]))


def test_pictures_in_the_png_are_where_the_svg_has_them() -> None:
    """A square that fills a quarter of its picture covers those pixels, and no others."""
    corners = np.array([0, 1, 1 + 1j, 1j])
    square = DrawnPaths(vt.Paths.polylines([corners], closed=True), fill="#ff0000")
    image = ContactSheet((SheetPicture((square,), (0.0, 0.0, 2.0, 2.0)),)).pixels
    red = (image == [255, 0, 0]).all(axis=2)
    rows, columns = np.nonzero(red)
    side = 220
    assert red.sum() == (side // 2) ** 2
    assert columns.min() == 16
    assert rows.max() == 16 + side - 1


def test_a_site_that_is_a_point_is_a_dot() -> None:
    """A point has no length, and is drawn all the same, in SVG and in the PNG."""
    tiling = vt.Design("p1", (60, 50, 75), vt.Site(vt.point(20 + 20j))).tessellate()
    tile = tiling[0]
    sheet = ContactSheet((SheetPicture.of_tiles([(tile.outline, tile.site.ends)]),))
    red = bytes.fromhex("b03020")
    assert (sheet.pixels == list(red)).all(axis=2).any()
    assert [path.get("stroke") for path in ET.fromstring(sheet.svg).iter(f"{SVG}path")][-1] == "#b03020"
    assert len([path for path in ET.fromstring(sheet.svg).iter(f"{SVG}path") if path.get("d")]) == 2


def test_a_long_caption_keeps_to_its_picture(sheet: ContactSheet) -> None:
    """A line that would not fit has smaller letters: no ink between the columns."""
    only = ContactSheet((SheetPicture((), (0, 0, 1, 1), sheet.pictures[1].caption),) * 2, columns=2)
    dark = np.nonzero((only.pixels < 200).any(axis=(0, 2)))[0]
    assert len(dark)
    assert not ((dark < 14) | ((dark > 238) & (dark < 250))).any()


@pytest.mark.parametrize("suffix", ["svg", "png", "html"])
def test_a_sheet_is_written_whole_and_the_same_each_time(suffix: str, sheet: ContactSheet, tmp_path: Path) -> None:
    """The same sheet gives the same bytes."""
    one, other = (tmp_path / f"{name}.{suffix}" for name in ("one", "other"))
    sheet.save(one)
    sheet.save(str(other))
    assert one.read_bytes() == other.read_bytes()
    assert len(one.read_bytes()) > 1000


def test_another_suffix_is_refused(sheet: ContactSheet, tmp_path: Path) -> None:
    """The message says which files there are."""
    with pytest.raises(vt.OutputError, match=r"\.svg or \.png or \.html"):
        sheet.save(tmp_path / "sheet.pdf")
    assert not any(tmp_path.iterdir())


def test_a_sheet_of_nothing_is_blank() -> None:
    """No picture is a sheet, too, with its title."""
    empty = ContactSheet((), "Nothing was kept")
    assert "Nothing was kept" in empty.svg
    assert "Nothing was kept" in empty.html
    assert (empty.pixels < 255).any()
