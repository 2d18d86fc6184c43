"""The text of a design: read from a file or standard input, and parsed as TOML or JSON."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

from voronoi_tiles.base import values
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.tolerance import FILE_BYTES_MAX

STARTER = 'Run "voronoi-tiles new p4" for a design to start from.'
"""The remedy where there is nothing to mend."""


def read_text(file: str, shown: str) -> str:
    """Read the text of a file, or of standard input, "-"; `shown` is what messages call it. Raises DesignError."""
    if not file:
        raise DesignError(
            "the name of the design is empty", file=shown, remedy="Name a TOML or JSON file, or - for standard input."
        )
    if file == "-" and sys.stdin is None:
        raise DesignError(
            "cannot read the design: it is closed", file=shown, remedy="Send a design to it, or name a file."
        )
    try:
        if file == "-":
            data = sys.stdin.buffer.read(FILE_BYTES_MAX + 1)
        else:
            with Path(file).open("rb") as stream:
                data = stream.read(FILE_BYTES_MAX + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise DesignError(
            f"cannot read the design: {reason}", file=shown, remedy="Check the path and its permissions."
        ) from None
    if len(data) > FILE_BYTES_MAX:
        raise DesignError(f"larger than {FILE_BYTES_MAX // 2**20} MiB", file=shown, remedy=f"Is it a design? {STARTER}")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise DesignError(
            "not a text in UTF-8", file=shown, line=line, remedy=f"Save it as UTF-8 text. {STARTER}"
        ) from None


def parse(text: str, form: str, file: str | None) -> Mapping[str, Any]:
    """Read a text in "toml" or "json"; `file` is what messages call it. Raises DesignError."""
    if not isinstance(text, str):
        raise DesignError(f"a design is text, not {values.shown(text)}", file=file, remedy="Pass a str.")
    if form not in ("toml", "json"):
        raise DesignError(f"unknown format {values.shown(form)}", file=file, remedy='Use "toml" or "json".')
    try:
        try:
            return _parse_as(form, text)
        except (DesignError, json.JSONDecodeError):
            raise
        except ValueError:
            # Python refuses integers of thousands of digits without a place. No key takes one, so a shorter one that
            # is still too large for all gives the message with the key.
            return _parse_as(form, _shorter(text))
    except DesignError as error:
        raise error.with_file(file) from None
    except json.JSONDecodeError as error:
        raise DesignError(
            f"not JSON: {error.msg} (column {error.colno})", file=file, line=error.lineno, remedy="Correct the line."
        ) from None
    except (ValueError, RecursionError) as error:
        why = "nested too deeply" if isinstance(error, RecursionError) else str(error).partition(";")[0]
        raise DesignError(f"not {form.upper()}: {why}", file=file, remedy=STARTER) from None


def _parse_as(form: str, text: str) -> Mapping[str, Any]:
    if form == "toml":
        return _parse_toml(text)
    return cast("Mapping[str, Any]", json.loads(text, object_pairs_hook=_without_repeats))


def _shorter(text: str) -> str:
    """The text with integers of thousands of digits cut to 401, which Python always takes."""
    return re.sub(rf"\d(?:_?\d){{{sys.get_int_max_str_digits()},}}", "1" + "0" * 400, text)


def _parse_toml(text: str) -> Mapping[str, Any]:
    import tomllib

    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        what = str(error)
        place = re.search(r" \(at line (\d+), column (\d+)\)$", what)
        if place:
            line, what = int(place[1]), f"{what[: place.start()]} (column {place[2]})"
        else:
            line, what = text.count("\n") + 1, what.removesuffix(" (at end of document)") + " at the end"
        raise DesignError(
            f"not TOML: {what[:1].lower()}{what[1:]}", line=line, remedy=f"Correct the line. {STARTER}"
        ) from None


def _without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    table = dict(pairs)
    if len(table) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise DesignError(f"key {values.shown(twice)} occurs twice in one object", remedy="Keep one of them.")
    return table
