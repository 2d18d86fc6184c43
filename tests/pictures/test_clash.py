"""Pictures of designs whose copies touch: the two that do and the place are marked, and what belongs to nobody."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
import shapely
from helpers.png import chunks_of, decoded
from helpers.strategies import Dice, make_design
from numpy.typing import NDArray

import voronoi_tiles as vt
from voronoi_tiles.pictures.clash import clash_marks, find_clash
from voronoi_tiles.raster.renderer import Choice

SITE, OTHER, RING, PAPER = (214, 20, 40), (20, 60, 214), (230, 0, 140), (255, 255, 255)


def touching_design(number: int) -> vt.Design:
    """A random design whose copies touch."""
    for attempt in itertools.count():
        kind, document = make_design(Dice(np.random.default_rng([29, number, attempt])))
        if kind in {"long", "dense", "skew", "bent"}:
            continue
        design = vt.Design.from_dict(document)
        try:
            design.tessellate()
        except vt.TouchingCopiesError:
            return design
    raise AssertionError


def corner_design() -> vt.Design:
    """In p4, four segments that make a square about the origin: each ends where the next begins."""
    return vt.Design("p4", 60, vt.Site([vt.segment(5 + 3j, -3 + 5j)], name="bird"))


def image(design: vt.Design, operation: vt.Operation, ends: NDArray[np.complex128]) -> list[shapely.LineString]:
    """The segments of a copy, by the operation's matrix over the cell's vectors."""
    a, b = design.lattice.a, design.lattice.b
    basis = np.array([[a.real, b.real], [a.imag, b.imag]])
    w, t = operation.linear, operation.translation
    matrix = basis @ np.array([[float(w[0]), float(w[1])], [float(w[2]), float(w[3])]]) @ np.linalg.inv(basis)
    shift = basis @ np.array([float(part) for part in t])
    return [shapely.LineString([matrix @ (z.real, z.imag) + shift for z in pair]) for pair in ends]


def shows(pixels: NDArray[np.uint8], colour: tuple[int, int, int]) -> bool:
    """Whether some pixel has a colour, or nearly."""
    return bool((np.abs(pixels.astype(int) - colour).max(axis=-1) <= 12).any())


@pytest.mark.parametrize("number", range(12))
def test_the_pair_that_touches_is_marked_where_it_does(number: int) -> None:
    """In every group: both copies and a ring about the place, which lies on both of them."""
    design = touching_design(number)
    size = max(abs(design.lattice.a), abs(design.lattice.b))
    with pytest.raises(vt.TouchingCopiesError) as caught:
        design.tessellate()
    found = find_clash(design)
    assert found is not None
    assert str(found) == str(caught.value)
    ends = {site.name: site.ends for site in design.noded}
    spot = shapely.Point(found.place.real, found.place.imag)
    far = 1e-9 * (size + abs(found.place))
    for site, operation in ((found.site, vt.Operation.parse("x,y")), (found.other, found.operation)):
        assert min(shapely.distance(spot, part) for part in image(design, operation, ends[site])) <= far
    extent = max(np.ptp(ends[found.site].real), np.ptp(ends[found.site].imag))
    x, y, side = found.place.real, found.place.imag, min(size / 3, extent or size)
    picture = vt.render(design, size=96, region=(x - side, y - side, x + side, y + side), renderer="cpu")
    assert str(picture.touching) == str(found)
    assert shows(picture.pixels, RING)
    assert shows(picture.pixels[32:64, 32:64], SITE)
    assert shows(picture.pixels, OTHER)
    assert "touch" in repr(picture)


def test_a_design_that_can_be_tiled_has_no_mark() -> None:
    """Nothing of it touches."""
    design = vt.starter("p4")
    assert find_clash(design) is None
    picture = vt.render(design, size=200, renderer="cpu")
    assert picture.touching is None
    assert not any(shows(picture.pixels, colour) for colour in (RING, PAPER))
    assert "#e6008c" not in design._repr_svg_()


@pytest.mark.parametrize("region", [(-10, -10, 10, 10), (590, 6590, 610, 6610)], ids=["named", "far"])
@pytest.mark.parametrize("renderer", ["cpu", "auto"])
def test_what_belongs_to_nobody_is_white(renderer: Choice, region: tuple[float, ...]) -> None:
    """The wedge beyond a common end is as far from both copies; wherever one looks, as the pattern repeats."""
    x0, y0, x1, y1 = region
    picture = vt.render(corner_design(), size=400, region=(x0, y0, x1, y1), renderer=renderer)

    def pixel(x: float, y: float) -> tuple[int, ...]:
        return tuple(picture.pixels[int((10 - y) * 20), int((10 + x) * 20)].tolist())

    for turn in (1, 1j, -1, -1j):
        beyond, within = turn * (-4.4 + 7.3j), turn * (-1.5 + 2.5j)
        assert pixel(beyond.real, beyond.imag) == PAPER
        assert pixel(within.real, within.imag) != PAPER
    assert shows(picture.pixels, SITE)
    assert shows(picture.pixels, OTHER)


@pytest.mark.parametrize("overlay", [(), ("outline",), ("cell", "symmetry", "outline", "grid")])
def test_the_file_says_what_its_picture_shows(overlay: tuple[str, ...], tmp_path: Path) -> None:
    """A picture of the asked size, with the message in its texts; there is no outline that could lie on top."""
    path = tmp_path / "x.png"
    result = vt.render(corner_design(), path, size=(90, 60), overlay=overlay, renderer="cpu")
    assert isinstance(result.touching, vt.TouchingCopiesError)
    data = path.read_bytes()
    assert decoded(data).shape == (60, 90, 3)
    (text,) = (body for kind, body in chunks_of(data) if kind == b"tEXt" and body.startswith(b"Warning\0"))
    assert text.split(b"\0", 1)[1].decode() == str(result.touching)


def test_there_are_no_tiles_to_colour_where_copies_touch() -> None:
    """A picture in the colours of woods shows the clash as any other does; what is no such colour is refused still."""
    plain, woods = (
        vt.render(corner_design(), size=60, colours=colours, renderer="cpu") for colours in ("none", "handedness")
    )
    assert isinstance(woods.touching, vt.TouchingCopiesError)
    assert np.array_equal(plain.pixels, woods.pixels)
    with pytest.raises(vt.JobError, match="`colours` 'blue' is unknown"):
        vt.render(corner_design(), size=60, colours="blue", renderer="cpu")


def test_images_of_the_place_are_marked_as_well() -> None:
    """The place turned by the group; in a picture of very many cells only the pair is."""
    design = corner_design()
    alone = vt.render(design, size=300, region=(-64, 55, -56, 63), renderer="cpu")  # 59 beyond: an image, not the pair
    assert shows(alone.pixels, RING)
    error = find_clash(design)
    assert error is not None
    marks = [clash_marks(error, design, (-side, -side, side, side), 64, 64) for side in (1300, 1400)]
    assert [max(len(mark.segments) for mark in some) > 50_000 for some in marks] == [True, False]


def test_a_notebook_shows_the_clash() -> None:
    """The design's picture has the copy that touches, and a ring, in a colour of their own."""
    text = corner_design()._repr_svg_()
    assert text.count('stroke="#e6008c"') == 2
