"""Frames of solids, read as their documentation says, by nothing of ours."""

from __future__ import annotations

import json
import struct
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


class FramePiece(NamedTuple):
    """The buffers of a piece: float32 (n, 3), uint32 (m, 3), and int8 (m, 3, 4)."""

    vertices: NDArray[np.float32]
    triangles: NDArray[np.uint32]
    normals: NDArray[np.int8]


def read_frame(frame: bytes) -> tuple[dict[str, Any], list[FramePiece]]:
    """The message of a frame, and the pieces behind it; nothing is left over."""
    size, rest = struct.unpack("!II", frame[:8])
    message: dict[str, Any] = json.loads(frame[8 : 8 + size])
    body = frame[8 + size :]
    assert len(body) == rest
    pieces = []
    for piece in message["pieces"]:
        parts = []
        for kind, shape in (
            ("<f4", (piece["vertices"], 3)),
            ("<u4", (piece["triangles"], 3)),
            ("i1", (piece["triangles"], 3, 4)),
        ):
            length = int(np.prod(shape)) * np.dtype(kind).itemsize
            parts.append(np.frombuffer(body[:length], kind).reshape(shape))
            body = body[length:]
        pieces.append(FramePiece(*parts))
    assert not body
    return message, pieces
