"""PNG files written in bands: 8-bit RGB, a part of the rows at a time, with the standard library's zlib alone.

Why our own: Pillow wants the whole picture in memory, and a sheet at a cutter's resolution has billions of bytes; pypng
takes rows, but filters none of them (see below what that costs) and writes no texts. Here the memory is that of the
band. Source: Portable Network Graphics (PNG) Specification, W3C.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping
from types import TracebackType
from typing import Protocol, Self

import numpy as np
from numpy.typing import NDArray

SIGNATURE = b"\x89PNG\r\n\x1a\n"

_INTEGER_MAX = 2**31 - 1  # PNG's integers have four bytes, and the first bit is not used
_DATA_BYTES = 2**16  # of compressed data in one IDAT chunk

# Every row is filtered with Up, the difference from the row above. Measured with zlib level 6 on a Voronoi picture of
# 16000 x 600 pixels, cells of 200 pixels, lines of 2; kilobytes, of 28800, for the filters None, Sub, Up:
#     flat colours, hard lines   412   653   379
#     flat, antialiased         1046  1205  1169
#     shaded by the distance   10225  4246  4318
# None is no choice once there is shading, and Sub loses on hard lines. The filter takes 20 ms, zlib 200. To choose
# between Sub and Up row by row, by the fewest nonzero bytes or the least sum, makes the first of these a fifth larger
# and the others a hundredth or two smaller; level 9 takes five to eleven times as long, for less than 3 %.
_LEVEL = 6
_UP = 2


class Sink(Protocol):
    """What takes bytes, all that it is given: a file opened for binary writing, or the like."""

    def write(self, data: bytes, /) -> object:
        """Take all the bytes."""


class PngStream:
    """A PNG file that is written from top to bottom, in bands of any number of rows.

    `file` takes the bytes as they come, and stays open; `width` and `height` are in pixels. `pixels_per_metre` is the
    resolution, rounded to a whole number (PNG has no other); `text` maps keywords ("Title", "Software", ...) to texts,
    which are written in its order. The file is complete after `close()`, which a `with` block calls when it ends well.
    The same pixels give the same bytes, however they are divided into bands.

    Raises ValueError for numbers that PNG cannot hold, and for keywords that are not 1 to 79 printable ASCII
    characters without a space at either end or two in a row.
    """

    def __init__(
        self,
        file: Sink,
        width: int,
        height: int,
        *,
        pixels_per_metre: float | None = None,
        text: Mapping[str, str] | None = None,
    ) -> None:
        for name, value in (("width", width), ("height", height), ("pixels_per_metre", pixels_per_metre)):
            if value is not None and not 0.5 < value <= _INTEGER_MAX:  # NaN neither
                raise ValueError(f"{name} is not between 1 and {_INTEGER_MAX}: {value}")
        chunks = [(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))]  # 8 bits, RGB, not interlaced
        if pixels_per_metre is not None:
            density = round(pixels_per_metre)
            chunks.append((b"pHYs", struct.pack(">IIB", density, density, 1)))
        chunks += [_text_chunk(keyword, value) for keyword, value in (text or {}).items()]
        self.width = width
        self.height = height
        self.rows = 0
        """How many rows have been written."""
        self._file = file
        self._closed = False
        self._above = np.zeros(3 * width, dtype=np.uint8)
        self.trailer: dict[str, str] = {}
        """Texts that are known only when the picture is done: they are written after it."""
        self._compressor = zlib.compressobj(_LEVEL)
        self._compressed = bytearray()
        file.write(SIGNATURE)
        for kind, data in chunks:
            self._chunk(kind, data)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if kind is None:
            self.close()

    def write(self, band: NDArray[np.uint8]) -> None:
        """Write the next rows: uint8 of shape (rows, width, 3), red, green, blue; the first row is the upper one.

        Raises ValueError, and writes nothing, for another type or shape, for more rows than are missing, and when the
        stream is closed.
        """
        if self._closed:
            raise ValueError("the PNG is closed")
        if band.dtype != np.uint8 or band.ndim != 3 or band.shape[1:] != (self.width, 3):
            raise ValueError(f"not a band of uint8 (rows, {self.width}, 3): {band.dtype} {band.shape}")
        if len(band) > self.height - self.rows:
            raise ValueError(f"{self.rows + len(band)} rows for a PNG of {self.height}")
        if not len(band):
            return
        pixels = band.reshape(len(band), -1)
        filtered = np.empty((len(pixels), 1 + pixels.shape[1]), dtype=np.uint8)
        filtered[:, 0] = _UP
        np.subtract(pixels[0], self._above, out=filtered[0, 1:])
        np.subtract(pixels[1:], pixels[:-1], out=filtered[1:, 1:])
        self._above = pixels[-1].copy()
        # Row by row: what zlib makes of its input may depend on the portions, and those must not be the bands.
        for row in filtered:
            self._compressed += self._compressor.compress(row.data)
            self._flush(_DATA_BYTES)
        self.rows += len(pixels)

    def close(self) -> None:
        """Write the end of the file; a second call does nothing.

        Raises ValueError when rows are missing: the file is then not complete, and the rows may still be written.
        """
        if self._closed:
            return
        if self.rows < self.height:
            raise ValueError(f"{self.rows} rows for a PNG of {self.height}")
        self._closed = True
        self._compressed += self._compressor.flush()
        self._flush(_DATA_BYTES)
        self._flush(1)
        for keyword, value in self.trailer.items():
            self._chunk(*_text_chunk(keyword, value))
        self._chunk(b"IEND", b"")

    def _flush(self, least: int) -> None:
        """Write compressed data as chunks of the full size, as long as there are `least` bytes."""
        while len(self._compressed) >= least:
            self._chunk(b"IDAT", bytes(self._compressed[:_DATA_BYTES]))
            del self._compressed[:_DATA_BYTES]

    def _chunk(self, kind: bytes, data: bytes) -> None:
        length, check = len(data), zlib.crc32(data, zlib.crc32(kind))
        self._file.write(struct.pack(">I", length) + kind + data + struct.pack(">I", check))


def _text_chunk(keyword: str, text: str) -> tuple[bytes, bytes]:
    """Make the chunk of a text: tEXt, which every reader knows, where it is ASCII, else iTXt, which is UTF-8."""
    printable = keyword.isascii() and keyword.isprintable()
    if not (printable and 1 <= len(keyword) <= 79 and keyword == " ".join(keyword.split())):
        raise ValueError(f"not a keyword of a PNG's text: {keyword!r}")
    if "\0" in text:
        raise ValueError(f"the text of {keyword} has a null character")
    name = keyword.encode("ascii")
    if text.isascii():
        return b"tEXt", name + b"\0" + text.encode("ascii")
    # Not compressed (flag and method are 0); no language, no translated keyword.
    return b"iTXt", name + b"\0\0\0\0\0" + text.encode()
