"""The outlines of examples/fit: what the README there promises of them."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import shapely
from helpers.curves import sampled

from voronoi_tiles.base.arrays import plane
from voronoi_tiles.formats.reading import read_drawing

FOLDER = Path(__file__).parents[2] / "examples" / "fit"
FILES = sorted(FOLDER.glob("*.svg"))


def test_the_table_has_every_file() -> None:
    """With the size of its page, and something drawn within where there is."""
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\w+\.svg)` \| (\d+) x (\d+) mm \| (.+) \|$", text, re.MULTILINE)
    assert [row[0] for row in rows] == [file.name for file in FILES]
    for name, width, height, within in rows:
        drawing = read_drawing(FOLDER / name)
        assert (drawing.width, drawing.height) == pytest.approx((float(width), float(height)))
        assert (len(drawing.shapes) > 1) == (within != "-")


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_an_outline_is_one_closed_curve_around_all_else(file: Path) -> None:
    """It crosses nowhere, is on the page, and what is drawn within is within; nothing of the file is left out."""
    drawing = read_drawing(file)
    assert not drawing.ignored
    assert drawing.width is not None
    assert drawing.height is not None
    outline, *rest = drawing.shapes
    assert outline.source.startswith("path 'outline'")
    assert (len(outline.paths), bool(outline.paths.closed[0])) == (1, True)
    ring = shapely.Polygon(plane(sampled(outline.paths, 0.05)))
    assert ring.is_valid
    assert shapely.box(0, 0, drawing.width, drawing.height).contains(ring)
    assert ring.area > 0.2 * drawing.width * drawing.height
    for shape in rest:
        assert shapely.contains_xy(ring.buffer(0.1), *plane(sampled(shape.paths, 0.2)).T).all()
    assert np.count_nonzero(outline.paths.kind) == len(outline.paths.start)
