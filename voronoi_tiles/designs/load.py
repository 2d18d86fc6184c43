"""The text of a design: read from a file or standard input, and parsed as TOML or JSON."""

from __future__ import annotations

import os
import shlex
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from voronoi_tiles.base import values
from voronoi_tiles.base.documents import parse_document, read_document
from voronoi_tiles.base.errors import DesignError

STARTER = 'Run "voronoi-tiles new p4" for a design to start from.'
"""The remedy where there is nothing to mend."""


def read_table(file: str, shown: str) -> Mapping[str, Any]:
    """Read a design file, TOML or JSON by its suffix (else by its content); "-" is standard input.

    `shown` is what messages call it. Raises DesignError.
    """
    text = _read_text(file, shown)
    suffix = Path(file).suffix.lower()
    return parse(text, suffix[1:] if suffix in (".toml", ".json") else None, shown)


def _read_text(file: str, shown: str) -> str:
    """Read the text of a file, or of standard input, "-"; `shown` is what messages call it. Raises DesignError."""
    if not file:
        raise DesignError(
            "the name of the design is empty", file=shown, remedy="Name a TOML or JSON file, or - for standard input."
        )
    if file == "-" and sys.stdin is None:
        raise DesignError(
            "cannot read the design: it is closed", file=shown, remedy="Send a design to it, or name a file."
        )
    refuse_drawing(file, shown)
    try:
        text = read_document(file, "design", missing="Check the path and its permissions.", remedy=STARTER)
    except DesignError as error:
        raise error.with_file(shown) from None
    if text.lstrip()[:1] == "<" or text.split(maxsplit=2)[:2] == ["0", "SECTION"]:
        raise _drawing_error(file, shown)
    return text


def refuse_drawing(file: str, shown: str) -> None:
    """Refuse a file that is a drawing by its name. Raises DesignError."""
    if _is_drawing(file):
        raise _drawing_error(file, shown)


def _is_drawing(file: str) -> bool:
    """Whether a file is a drawing by its name, and is there."""
    return file.lower().endswith((".svg", ".svgz", ".dxf")) and os.path.exists(file)  # noqa: PTH110 - any name


def _drawing_error(file: str, shown: str) -> DesignError:
    """The error for a drawing in the place of a design."""
    name, stem = (file, os.path.splitext(os.path.basename(file))[0]) if file != "-" else ("leaf.svg", "leaf")  # noqa: PTH119, PTH122 - same
    new = f"voronoi-tiles new p4 --from {shlex.quote(name)} -o {shlex.quote(f'{stem}.toml')}"
    return DesignError("is a drawing, not a design", file=shown, remedy=f"Make a design of it: {new}")


def parse(text: str, form: str | None, file: str | None) -> Mapping[str, Any]:
    """Read a text in "toml" or "json", None for what it looks like; `file` is its name in messages.

    Raises DesignError.
    """
    if not isinstance(text, str):
        raise DesignError(f"a design is text, not {values.shown(text)}", file=file, remedy="Pass a str.")
    if form is None:
        form = "json" if text.lstrip()[:1] == "{" else "toml"
    if form not in ("toml", "json"):
        raise DesignError(f"unknown format {values.shown(form)}", file=file, remedy='Use "toml" or "json".')
    try:
        return parse_document(text, form, remedy=STARTER)
    except DesignError as error:
        raise error.with_file(file) from None
