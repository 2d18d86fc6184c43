"""PNG files in bands: what they hold is read back by a decoder of the test's own."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from helpers.png import Pixels, chunks_of, decoded
from hypothesis import given
from hypothesis import strategies as st

from voronoi_tiles.formats.png import SIGNATURE, PngStream


def encoded(picture: Pixels, cuts: Iterable[int] = (), **options: Any) -> bytes:
    """Write a picture in bands that end at the given rows."""
    file = io.BytesIO()
    with PngStream(file, picture.shape[1], picture.shape[0], **options) as png:
        for band in np.split(picture, sorted(cuts)):
            png.write(band)
    return file.getvalue()


def noise(height: int, width: int) -> Pixels:
    """Pixels that no compressor makes smaller."""
    return np.random.default_rng(height).integers(0, 256, (height, width, 3), dtype=np.uint8)


def cells(height: int, width: int) -> Pixels:
    """Flat colours with thin lines."""
    y, x = np.mgrid[:height, :width]
    picture = np.stack((x // 9 * 20, y // 7 * 30, (x + y) // 11 * 25), axis=2).astype(np.uint8)
    picture[(x + 2 * y) % 13 == 0] = 0
    return picture


@pytest.mark.parametrize("filter_type", range(5))
def test_the_decoder_knows_all_filters(filter_type: int) -> None:
    """Rows that numpy has filtered by the formulas of the specification come back; another filter is noticed."""
    picture = noise(6, 5)
    wide = np.pad(picture.astype(int), ((1, 0), (1, 0), (0, 0)))
    a, b, c = wide[1:, :-1], wide[:-1, 1:], wide[:-1, :-1]
    near_a = (abs(b - c) <= abs(a - c)) & (abs(b - c) <= abs(a + b - 2 * c))
    paeth = np.where(near_a, a, np.where(abs(a - c) <= abs(a + b - 2 * c), b, c))
    filtered = (picture - (np.zeros_like(a), a, b, (a + b) // 2, paeth)[filter_type]) % 256

    def file(kind: int) -> bytes:
        rows = b"".join(bytes([kind, *row.ravel()]) for row in filtered)
        chunks = [
            (b"IHDR", struct.pack(">IIBBBBB", 5, 6, 8, 2, 0, 0, 0)),
            (b"IDAT", zlib.compress(rows)),
            (b"IEND", b""),
        ]
        return SIGNATURE + b"".join(
            struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
            for kind, body in chunks
        )

    assert np.array_equal(decoded(file(filter_type)), picture)
    assert not np.array_equal(decoded(file((filter_type + 1) % 5)), picture)


@pytest.mark.parametrize("picture", [noise(1, 1), noise(37, 23), noise(200, 150), cells(60, 90), cells(1, 40)])
def test_pictures_come_back(picture: Pixels) -> None:
    """Every pixel, from the top left corner on."""
    assert np.array_equal(decoded(encoded(picture)), picture)


@given(st.sets(st.integers(0, 120)))
def test_bands_do_not_show(cuts: set[int]) -> None:
    """Whatever the bands, empty ones too, the bytes are the same."""
    picture = np.concatenate((noise(60, 300), cells(60, 300)))
    assert encoded(picture, cuts) == encoded(picture)


def test_a_band_may_be_a_view() -> None:
    """Mirrored and cropped arrays are written as what they show; what happens to them later does not matter."""
    whole = cells(40, 50)
    view = whole[::-1, 5:45, ::-1]
    file = io.BytesIO()
    with PngStream(file, 40, 40) as png:
        png.write(view[:7])
        png.write(band := view[7:20].copy())
        band[:] = 77
        png.write(view[20:])
    assert np.array_equal(decoded(file.getvalue()), view)


def test_chunks_are_bounded() -> None:
    """Data that cannot be compressed come in chunks of 64 KiB, as they arise."""
    file = io.BytesIO()
    with PngStream(file, 400, 300) as png:
        for band in np.split(noise(300, 400), 30):
            png.write(band)
            assert file.tell() > png.rows * 1200 - 2**17
    sizes = [len(body) for kind, body in chunks_of(file.getvalue()) if kind == b"IDAT"]
    assert sum(sizes) > 300 * 400 * 3
    assert set(sizes[:-1]) == {2**16}
    assert 0 < sizes[-1] <= 2**16


def test_flat_colours_become_small() -> None:
    """The filter and the compressor do their work: one colour takes a five-hundredth, cells a fiftieth."""
    assert len(encoded(np.full((1000, 1000, 3), 200, dtype=np.uint8))) < 6_000
    assert len(encoded(cells(100, 100).repeat(10, axis=0).repeat(10, axis=1))) < 60_000


def test_resolution_and_texts() -> None:
    """They stand before the pixels, in their order; what is not ASCII is UTF-8."""
    text = {"Title": "Vögel", "Software": "voronoi-tiles\n0.1", "Empty": "", "Comment": "\u2600"}
    chunks = chunks_of(encoded(cells(4, 4), pixels_per_metre=300 / 0.0254, text=text))
    assert chunks[1:6] == [
        (b"pHYs", struct.pack(">IIB", 11811, 11811, 1)),
        (b"iTXt", b"Title\0\0\0\0\0V\xc3\xb6gel"),
        (b"tEXt", b"Software\0voronoi-tiles\n0.1"),
        (b"tEXt", b"Empty\0"),
        (b"iTXt", b"Comment\0\0\0\0\0\xe2\x98\x80"),
    ]
    assert [kind for kind, _ in chunks] == [b"IHDR", b"pHYs", b"iTXt", b"tEXt", b"tEXt", b"iTXt", b"IDAT", b"IEND"]
    assert [kind for kind, _ in chunks_of(encoded(cells(4, 4)))] == [b"IHDR", b"IDAT", b"IEND"]


@pytest.mark.parametrize(
    "options",
    [
        {"width": 0},
        {"height": -3},
        {"width": 2**31},
        {"pixels_per_metre": 0.0},
        {"pixels_per_metre": float("nan")},
        {"pixels_per_metre": 1e12},
        {"text": {"": "no keyword"}},
        {"text": {"k" * 80: "a long one"}},
        {"text": {" k": "a space before"}},
        {"text": {"a  b": "two spaces"}},
        {"text": {"a\nb": "a line break"}},
        {"text": {"é": "not ASCII"}},
        {"text": {"Title": "null \0"}},
        {"text": {"Title": "half a character \ud800"}},
    ],
)
def test_what_png_cannot_hold_is_refused(options: dict[str, Any]) -> None:
    """Sizes, resolutions and texts are checked before a byte is written."""
    file = io.BytesIO()
    with pytest.raises(ValueError, match=r"width|height|pixels_per_metre|text|surrogates"):
        PngStream(file, **{"width": 4, "height": 4, **options})
    assert file.getvalue() == b""


@pytest.mark.parametrize(
    "band",
    [
        np.zeros((2, 4), dtype=np.uint8),
        np.zeros((2, 5, 3), dtype=np.uint8),
        np.zeros((2, 4, 4), dtype=np.uint8),
        np.zeros((4, 3), dtype=np.uint8),
        np.zeros((2, 4, 3), dtype=np.int64),
        np.zeros((2, 4, 3)),
    ],
)
def test_wrong_bands_are_refused(band: Any) -> None:
    """Another shape or type is a ValueError that names both, and the stream goes on as if it had not been."""
    picture = cells(4, 4)
    file = io.BytesIO()
    with PngStream(file, 4, 4) as png:
        png.write(picture[:2])
        with pytest.raises(ValueError, match=r"not a band of uint8 \(rows, 4, 3\): "):
            png.write(band)
        png.write(picture[2:])
    assert file.getvalue() == encoded(picture)


def test_missing_rows_and_rows_too_many() -> None:
    """Both are errors; a file that lacks rows has no end."""
    file = io.BytesIO()
    png = PngStream(file, 4, 6)
    png.write(cells(5, 4))
    with pytest.raises(ValueError, match="7 rows for a PNG of 6"):
        png.write(cells(2, 4))
    with pytest.raises(ValueError, match="5 rows for a PNG of 6"):
        png.close()
    assert b"IEND" not in file.getvalue()
    png.write(cells(6, 4)[5:])
    png.close()
    assert file.getvalue() == encoded(cells(6, 4))
    with pytest.raises(ValueError, match="0 rows for a PNG of 6"), PngStream(io.BytesIO(), 4, 6):
        pass


def test_closing() -> None:
    """A second close does nothing; a closed stream takes nothing; an error in the block is not covered by another."""
    file = io.BytesIO()
    with PngStream(file, 4, 2) as png:
        png.write(cells(2, 4))
        png.close()
    assert file.getvalue() == encoded(cells(2, 4))
    with pytest.raises(ValueError, match="closed"):
        png.write(cells(0, 4))
    with pytest.raises(KeyError, match="mine"), PngStream(io.BytesIO(), 4, 2):
        raise KeyError("mine")
