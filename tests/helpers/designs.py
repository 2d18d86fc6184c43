"""Designs that no constructor makes: parts exchanged behind its back, for tests of what comes after it."""

from __future__ import annotations

from copy import copy
from typing import Any

from voronoi_tiles.designs.design import Design


def tampered(design: Design, **parts: Any) -> Design:
    """A design with some parts exchanged and nothing checked: `noded`, `lattice`, `units`, ..."""
    result = copy(design)
    for name, part in parts.items():
        assert hasattr(result, name), name
        object.__setattr__(result, name, part)
    return result
