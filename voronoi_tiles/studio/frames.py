"""What goes between the server and its workers: an object of JSON and some bytes, with their sizes before them."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any, Final

_SIZES: Final = struct.Struct("!II")

FRAME_START: Final = _SIZES.size
"""How long the sizes are; bytes."""


def pack(head: Mapping[str, Any], body: bytes = b"") -> bytes:
    """A frame of a head and a body."""
    text = json.dumps(head, separators=(",", ":"), allow_nan=False).encode()
    return _SIZES.pack(len(text), len(body)) + text + body


def sizes_of(start: bytes) -> tuple[int, int]:
    """The sizes of head and body by the first FRAME_START bytes of a frame."""
    head, body = _SIZES.unpack(start)
    return head, body
