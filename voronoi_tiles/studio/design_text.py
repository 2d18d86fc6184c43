"""The text of design files: in which form it is, and JSON in the layout of another text."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any


def form_of(path: str, text: str) -> str:
    """Whether a file is "toml" or "json": by its suffix, else by its content."""
    suffix = Path(path).suffix.lower()
    return suffix[1:] if suffix in (".toml", ".json") else "json" if text.lstrip()[:1] == "{" else "toml"


def json_text(design: Mapping[str, Any], like: str = "{\n ") -> str:
    """A design as JSON, indented as another text is, with the same line ends."""
    indent = re.match(r"\s*\{\r?\n([ \t]+)", like)
    newline = "\r\n" if "\r\n" in like else "\n"
    text = json.dumps(design, indent=indent[1] if indent else None, ensure_ascii=like.isascii())
    try:
        text.encode()
    except UnicodeEncodeError:  # what only an escape can say
        text = json.dumps(design, indent=indent[1] if indent else None)
    return text.replace("\n", newline) + newline
