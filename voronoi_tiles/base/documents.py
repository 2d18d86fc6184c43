"""Documents that users write: read from a file or standard input, and parsed as TOML or JSON. Raises DesignError."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Mapping
from typing import Any, cast

from voronoi_tiles.base.errors import DesignError, why_not_opened
from voronoi_tiles.base.tolerance import FILE_BYTES_MAX
from voronoi_tiles.base.values import shown


def read_bytes(file: str, most: int) -> bytes:
    """The first bytes of a file, or of standard input, "-". Raises OSError, and ValueError for what is no name."""
    if file == "-":
        return sys.stdin.buffer.read(most)
    with open(file, "rb") as stream:  # noqa: PTH123 - Path takes an empty name for the folder
        return stream.read(most)


def read_document(file: str, what: str, *, missing: str, remedy: str = "") -> str:
    """The text of a file, or of standard input, "-"; `what` it is to be, for messages.

    The remedies are `missing`, where it cannot be read, and `remedy` after others.
    """
    try:
        data = read_bytes(file, FILE_BYTES_MAX + 1)
    except (OSError, ValueError) as error:
        raise DesignError(f"cannot read the {what}: {why_not_opened(file, error)}", remedy=missing) from None
    return document_text(data, what, remedy=remedy)


def document_text(data: bytes, what: str, *, remedy: str = "") -> str:
    """The text of a file's bytes, which is to be `what`; without the byte order mark that it may begin with."""
    if len(data) > FILE_BYTES_MAX:
        raise DesignError(f"larger than {FILE_BYTES_MAX // 2**20} MiB", remedy=_joined(f"Is it a {what}?", remedy))
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise DesignError("not a text in UTF-8", line=line, remedy=_joined("Save it as UTF-8 text.", remedy)) from None


def parse_document(text: str, form: str, *, remedy: str) -> Mapping[str, Any]:
    """The values of a text in "toml" or "json"; `remedy` is where there is nothing to mend."""
    try:
        try:
            return _parse_as(form, text, remedy)
        except (DesignError, json.JSONDecodeError):
            raise
        except ValueError:
            # Python refuses integers of thousands of digits without a place. No key takes one, so a shorter one that
            # is still too large for all gives the message with the key.
            return _parse_as(form, _shorter(text), remedy)
    except DesignError:
        raise
    except json.JSONDecodeError as error:
        raise DesignError(
            f"not JSON: {error.msg} (column {error.colno})", line=error.lineno, remedy="Correct the line."
        ) from None
    except (ValueError, RecursionError) as error:
        why = "nested too deeply" if isinstance(error, RecursionError) else str(error).partition(";")[0]
        raise DesignError(f"not {form.upper()}: {why}", remedy=remedy) from None


def _parse_as(form: str, text: str, remedy: str) -> Mapping[str, Any]:
    if form == "toml":
        return _parse_toml(text, remedy)
    return cast("Mapping[str, Any]", json.loads(text, object_pairs_hook=_without_repeats))


def _shorter(text: str) -> str:
    """The text with integers of thousands of digits cut to 401, which Python always takes."""
    return re.sub(rf"\d(?:_?\d){{{sys.get_int_max_str_digits()},}}", "1" + "0" * 400, text)


def _parse_toml(text: str, remedy: str) -> Mapping[str, Any]:
    import tomllib

    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        what = str(error)
        place = re.search(r" \(at line (\d+), column (\d+)\)$", what)
        if place:
            line, column = int(place[1]), int(place[2])
            if what.startswith(("Unclosed inline table", "Invalid initial character for a key part")):
                broken = _broken_inline_table(text, line, column)
                if broken is not None:
                    raise broken from None
            what = f"{what[: place.start()]} (column {column})"
        else:
            line, what = text.count("\n") + 1, what.removesuffix(" (at end of document)") + " at the end"
        raise DesignError(
            f"not TOML: {what[:1].lower()}{what[1:]}", line=line, remedy=_joined("Correct the line.", remedy)
        ) from None


def _broken_inline_table(text: str, line: int, column: int) -> DesignError | None:
    """The error where an inline table goes on in the next line, or ends in a comma, which TOML does not allow.

    Python's parser stops there at a key, or at a comma or brace, that it does not find; None where it is another error.
    """
    row = text.split("\n")[line - 1]
    before, after = row[: column - 1].rstrip(), row[column - 1 :].lstrip()
    if after[:1] in ("", "#") and not before.endswith((".", "[")):
        return DesignError(
            f"not TOML: an inline table is broken over lines (column {column})",
            line=line,
            remedy="Write all from { to } in one line; only inside [ ] may a line be broken.",
        )
    if after.startswith("}") and before.endswith(","):
        return DesignError(
            f"not TOML: an inline table ends in a comma (column {column})", line=line, remedy="Leave the comma out."
        )
    return None


def _without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    table = dict(pairs)
    if len(table) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise DesignError(f"key {shown(twice)} occurs twice in one object", remedy="Keep one of them.")
    return table


def _joined(sentence: str, remedy: str) -> str:
    return f"{sentence} {remedy}".rstrip()
