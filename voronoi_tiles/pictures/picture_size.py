"""How large pictures are, for those also who draw none: what draws them is heavy to import."""

from __future__ import annotations

DEFAULT_SIZE = 1600
"""The longer side of a picture; pixels."""

SIDE_MAX = 100_000
"""The largest side of a picture; pixels. It has 300 MB a band, and takes hours."""
