"""What the page is told of what cannot be done: errors as messages, for people."""

from __future__ import annotations

from cmath import isfinite
from collections.abc import Mapping
from typing import Any, Final

from voronoi_tiles.base.errors import DesignError, TouchingCopiesError, VoronoiTilesError
from voronoi_tiles.studio.messages import Table

_LANES: Final = {
    "design": "outline",
    "job": "job",
    "solid": "solid",
    "thumbnail": "thumbnail",
    "save": "save",
    "new": "new",
}
"""The lanes of the messages that are refused; what is wrong with others is trouble."""

_BUG: Final = "This is a bug in voronoi-tiles: please report it, with the design."


def error_document(error: BaseException, scale: float = 1.0) -> dict[str, Any]:
    """An error as the page shows it: "message" and "remedy", "key" and the place "at" where it has them.

    The place is in the coordinates of the drawing, that is, before the design's `scale`.
    """
    more: dict[str, Any] = {}
    remedy: str | None
    match error:
        case TouchingCopiesError():
            message, _, remedy = str(error).partition(". ")
            at = error.place / scale
            more = {"at": [at.real, at.imag]} if isfinite(at) else {}
        case VoronoiTilesError():
            message, remedy = getattr(error, "message", str(error)), getattr(error, "remedy", None)
            if (z := getattr(error, "z", None)) is not None:  # a LoftError, whose module the server does not load
                message = f"{message} at the height {z:.6g}"
            key: str | None = next(iter(getattr(error, "fields", ())), None)
            if isinstance(error, DesignError):
                key = error.key
                line = None if error.line is None else f"line {error.line}"
                message = ": ".join((*filter(None, (error.file, line)), message))
            more = {} if key is None else {"key": key}
        case MemoryError():
            message, remedy = "There is not enough memory for this", "Draw less, or make a smaller sheet."
        case RecursionError():
            message, remedy = "The design is nested too deeply", "Undo the last change."
        case OSError():
            message, remedy = str(error.strerror or error), "Check the disk and the permissions."
        case _:
            message, remedy = f"{type(error).__name__}: {str(error)[:500]}", _BUG
    return {"message": f"{message.removesuffix('.')}.", "remedy": remedy or "", **more}


def refusal(asked: Table, error: BaseException | Mapping[str, Any]) -> dict[str, Any]:
    """What the page is told of an error about its message."""
    document = error if isinstance(error, Mapping) else error_document(error)
    kind, rev = asked.get("type"), asked.get("rev")
    if not (isinstance(kind, str) and kind in _LANES and isinstance(rev, int)):
        return {"type": "trouble", **document}
    return {"type": "failed" if kind == "save" else "refused", "rev": rev, "lane": _LANES[kind], "error": document}
