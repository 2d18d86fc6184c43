"""A decoder of PNG files that shares no code with the product's writer."""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.formats.png import SIGNATURE

Pixels = NDArray[np.uint8]
Chunks = list[tuple[bytes, bytes]]


def chunks_of(data: bytes) -> Chunks:
    """The chunks of a PNG by kind, after checking each one's CRC."""
    assert data.startswith(SIGNATURE)
    chunks, at = [], len(SIGNATURE)
    while at < len(data):
        (length,) = struct.unpack_from(">I", data, at)
        kind, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        assert struct.unpack_from(">I", data, at + 8 + length) == (zlib.crc32(kind + body),)
        chunks.append((kind, body))
        at += 12 + length
    return chunks


def decoded(data: bytes) -> Pixels:
    """Read an 8-bit RGB picture of any filters, byte by byte as the specification puts it."""
    chunks = chunks_of(data)
    assert chunks[0][0] == b"IHDR"
    assert chunks[-1] == (b"IEND", b"")
    width, height, *rest = struct.unpack(">IIBBBBB", chunks[0][1])
    assert rest == [8, 2, 0, 0, 0]
    stream = zlib.decompress(b"".join(body for kind, body in chunks if kind == b"IDAT"))
    size = 3 * width
    assert len(stream) == height * (1 + size)
    lines = np.frombuffer(stream, dtype=np.uint8).reshape(height, 1 + size)
    if (lines[:, 0] == 2).all():  # each row is the difference from the one above
        return np.add.accumulate(lines[:, 1:], axis=0, dtype=np.uint8).reshape(height, width, 3)
    above, rows = bytes(size), []
    for start in range(0, len(stream), 1 + size):
        row = bytearray(stream[start + 1 : start + 1 + size])
        for k in range(size):
            a, b, c = (row[k - 3], above[k], above[k - 3]) if k >= 3 else (0, above[k], 0)
            paeth = min((a, b, c), key=lambda value: abs(a + b - c - value))
            row[k] = (row[k] + (0, a, b, (a + b) // 2, paeth)[stream[start]]) % 256
        rows.append(bytes(row))
        above = rows[-1]
    return np.frombuffer(b"".join(rows), dtype=np.uint8).reshape(height, width, 3)
