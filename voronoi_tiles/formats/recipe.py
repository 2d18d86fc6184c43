"""The recipe in files of our own: which job made them."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping
from typing import Any, Final

_HEAD: Final = 4 * 2**20
"""How much of a file is looked through; bytes. The recipe stands before the paths."""

_SVG: Final = re.compile(rb'<vt:recipe\b[^>]*?\bjob="([^"]*)"')
_DXF: Final = re.compile(rb"^999\r?\nrecipe (.*?)\r?$", re.MULTILINE)


def job_of(data: bytes) -> Mapping[str, Any]:
    """What a file of ours says of its job (see voronoi_tiles.fabrication.job); nothing for files of others."""
    head = data[:_HEAD]
    try:
        svg = _SVG.search(head)
        if svg is not None:
            job = json.loads(html.unescape(svg[1].decode()))
        else:
            recipe = json.loads(b"".join(_DXF.findall(head)).decode())
            job = json.loads(recipe["job"])
    except (ValueError, LookupError, TypeError, RecursionError):
        return {}
    return job if isinstance(job, Mapping) else {}


def tab_width(job: Mapping[str, Any]) -> float:
    """How far the lines of a job stop beside each tab, millimetres; 0 where it has none."""
    tabs, kerf = job.get("tabs", 0.0), job.get("kerf", 0.0)
    numbers = all(isinstance(value, int | float) and not isinstance(value, bool) for value in (tabs, kerf))
    return float(tabs + kerf) if numbers and tabs > 0 else 0.0
