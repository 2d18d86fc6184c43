"""Keys of a design file as values that compare and hash: those that say no more than their default are left out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from voronoi_tiles.base.maps import Placement

Keys = tuple[tuple[str, Any], ...]
"""Keys and values, a stroke's own key first and its placement last; arrays are tuples."""

DEFAULTS: Final[Mapping[str, Any]] = {
    "closed": False,
    "alpha": 0.5,
    "mirror": False,
    "scale": 1.0,
    "rotate": 0.0,
    "translate": (0.0, 0.0),
}
"""What the keys of strokes, art and sites mean where they are not written."""

PLACEMENT: Final = ("mirror", "scale", "rotate", "translate")
"""The keys that place strokes, art and sites, in the order in which they are applied."""

_LAST: Final = ("tangents", "radius", "alpha", "closed", "layer", "id", *PLACEMENT)


def keys_of(table: Mapping[str, Any]) -> Keys:
    """The keys of a table that say something."""
    ordered = sorted(table, key=lambda name: _LAST.index(name) if name in _LAST else -1)
    frozen = ((name, _frozen(table[name])) for name in ordered)
    return tuple((name, value) for name, value in frozen if not _is_default(name, value))


def _is_default(name: str, value: object) -> bool:
    default = DEFAULTS.get(name)
    return default is not None and isinstance(value, bool) == isinstance(default, bool) and bool(value == default)


def _frozen(value: Any) -> Any:
    """A value with tuples in the place of lists and arrays."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    return tuple(map(_frozen, value)) if isinstance(value, list | tuple) else value


def keys_of_placement(placement: Placement) -> dict[str, Any]:
    """A placement as keys."""
    shift = placement.translate
    return {
        "mirror": placement.mirror,
        "scale": placement.scale,
        "rotate": placement.rotate,
        "translate": (shift.real, shift.imag),
    }
