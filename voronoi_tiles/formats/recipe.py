"""The recipe in files of our own: which design and which job made them."""

from __future__ import annotations

import html
import json
import re
import zlib
from collections.abc import Mapping
from io import BytesIO
from lzma import LZMAError
from typing import Any, Final
from zipfile import BadZipFile, ZipFile

_HEAD: Final = 4 * 2**20
"""How much of a file is looked through, at its beginning and at its end; bytes. No recipe stands between paths."""

# Between < and the end of a tag is no other <: so a file of nothing but beginnings is looked through once.
_SVG: Final = re.compile(rb"<vt:recipe\b([^<>]*)>([^<]*)")
_SVG_FACT: Final = re.compile(r'([\w-]+)="([^"]*)"')
_DXF: Final = re.compile(rb"^999\r?\nrecipe (.*?)\r?$", re.MULTILINE)
_GCODE: Final = re.compile(rb"^; recipe (.*?)\r?$", re.MULTILINE)
_PDF: Final = re.compile(rb"/Subject <FEFF([0-9A-F]+)>")
_THREEMF: Final = re.compile(rb'<metadata name="vt:(\w+)">([^<]*)<')

THREEMF_MODEL: Final = "3D/3dmodel.model"
"""The part of a 3MF file, a zip archive, that holds what it is about."""

_LIGHTBURN: Final = re.compile(rb"<Notes\b[^<>]*?\bNotes=(?:\"([^\"]*)\"|'([^']*)')")


def recipe_of(data: bytes) -> Mapping[str, str]:
    """What an SVG, DXF, PDF, LightBurn, G-code or 3MF file of ours says of how it was made; nothing for others' files.

    "design", and "job" or "solid", are JSON, where there are any.
    """
    head, tail = data[:_HEAD], data[-_HEAD:]
    try:
        if data.startswith(b"PK"):
            with ZipFile(BytesIO(data)) as package, package.open(THREEMF_MODEL) as model:
                head = model.read(_HEAD)
        if threemf := _THREEMF.findall(head):
            return {name.decode(): html.unescape(text.decode()) for name, text in threemf}
        if svg := _SVG.search(head):
            facts = {name: html.unescape(text) for name, text in _SVG_FACT.findall(svg[1].decode())}
            return {**facts, "design": html.unescape(svg[2].decode())}
        if lines := _DXF.findall(head) or _GCODE.findall(head):
            return _texts(b"".join(lines).decode())
        if pdf := _PDF.search(tail) or _PDF.search(head):
            return _texts(bytes.fromhex(pdf[1].decode()).decode("utf-16-be"))
        if notes := _LIGHTBURN.search(tail):
            lines = html.unescape((notes[1] or notes[2] or b"").decode()).splitlines()
            return dict(line.split(": ", 1) for line in lines if ": " in line)
    except (ValueError, KeyError, RuntimeError, OSError, EOFError, BadZipFile, zlib.error, LZMAError):
        pass  # of zip archives: what is encrypted, broken, or packed by a way that is not known
    return {}


def _texts(text: str) -> Mapping[str, str]:
    """The texts of a JSON object. Raises ValueError where it is none."""
    facts = json.loads(text)
    return {key: value for key, value in facts.items() if isinstance(value, str)} if isinstance(facts, dict) else {}


def job_of(data: bytes) -> Mapping[str, Any]:
    """What a file of ours says of its job (see voronoi_tiles.fabrication.job); nothing for files of others."""
    return json_object(recipe_of(data).get("job", ""))


def json_object(text: str) -> Mapping[str, Any]:
    """A JSON object, empty where the text is none."""
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        return {}
    return value if isinstance(value, Mapping) else {}


def tab_width(job: Mapping[str, Any]) -> float:
    """How far the lines of a job stop beside each tab, millimetres; 0 where it has none."""
    tabs, kerf = job.get("tabs", 0.0), job.get("kerf", 0.0)
    numbers = all(isinstance(value, int | float) and not isinstance(value, bool) for value in (tabs, kerf))
    return float(tabs + kerf) if numbers and tabs > 0 else 0.0
