"""Inkscape's descriptions of extensions, .inx files: written from the entries and their options."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Final
from xml.etree import ElementTree as ET

from voronoi_tiles.designs.starters import GROUP_NAMES, symmetry_of
from voronoi_tiles.fabrication.job_options import Option
from voronoi_tiles.formats.presets import preset_names
from voronoi_tiles.inkscape.dialog_fields import CELL_LABEL
from voronoi_tiles.inkscape.entries import MENU, Entry

_NAMESPACE: Final = "http://www.inkscape.org/namespace/inkscape/extension"

_PRECISION: Final = 4
"""Digits after the point of numbers in a dialog; a count. A tenth of a micrometre."""

_ARGUMENT = re.compile(r"`(\w+)(?:=([^`]*))?`")


def in_dialog(text: str) -> str:
    """A text with names of a dialog in the place of the arguments of Python that it has in backquotes."""

    def named(found: re.Match[str]) -> str:
        name, value = found.groups()
        said = "" if value in {None, "True"} else f": {value.strip(chr(39) + '[]')}"
        return f'"{_label(name)}{said}"'

    return _ARGUMENT.sub(named, text)


def _label(name: str) -> str:
    """What a dialog calls an option."""
    return name.replace("_", " ")


def inx_text(entry: Entry, launcher: str, mark: str) -> str:
    """The .inx file of an entry that is run by a launcher, the name of a Python file beside it; `mark` is a comment."""
    root = ET.Element("inkscape-extension", xmlns=_NAMESPACE)
    _child(root, "name", entry.title)
    _child(root, "id", f"voronoi-tiles.{entry.name}")
    if entry.pages:
        book = _child(root, "param", name="page", type="notebook")
        for title, names in entry.pages.items():
            page = _child(book, "page", name=title.lower(), **{"gui-text": title})
            for name in names:
                _add_parameter(page, name, entry.options[name])
        page = _child(book, "page", name="help", **{"gui-text": "Help"})
        for paragraph in entry.help.splitlines():
            _child(page, "label", paragraph)
    if entry.suffix:
        reads = _child(root, "input")
        _child(reads, "extension", entry.suffix)
        _child(reads, "mimetype", f"application/{entry.suffix.removeprefix('.')}")
        _child(reads, "filetypename", entry.title)
        _child(reads, "filetypetooltip", entry.tip)
    else:
        effect = _child(root, "effect", **{"needs-live-preview": "true" if entry.live else "false"})
        _child(effect, "object-type", "all")
        _child(_child(effect, "effects-menu"), "submenu", name=MENU)
        _child(effect, "menu-tip", entry.tip)
    script = _child(root, "script")
    _child(script, "command", launcher, location="inx", interpreter="python")
    ET.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n<!-- {mark} -->\n{ET.tostring(root, encoding="unicode")}\n'


def _child(parent: ET.Element, tag: str, text: str = "", **attributes: str) -> ET.Element:
    """A new element in another."""
    child = ET.SubElement(parent, tag, attributes)
    child.text = text or None
    return child


def _add_parameter(page: ET.Element, name: str, option: Option[Any, Any]) -> None:
    """Add the widget of an option. What is left empty is not said."""
    words = _words(name, option)
    common = {
        "name": name,
        "gui-text": f"{_label(name).capitalize()}{_taken(option, words)}",
        "gui-description": in_dialog(option.help),
    }
    if option.limits is not None and option.default is not None:
        least, most = (f"{limit:.12g}" for limit in option.limits)
        kind = {"type": "float", "precision": str(_PRECISION), "min": least, "max": most}
        _child(page, "param", f"{option.default:.12g}", **common, **kind)
        return
    if option.kind == "flag":
        _child(page, "param", "false", **common, type="bool")
        return
    if not words:
        text = "" if option.default is None else f"{option.default:g}" if option.kind != "text" else str(option.default)
        _child(page, "param", text, **common, type="string")
        return
    box = _child(page, "param", **common, type="optiongroup", appearance="combo")
    for word, shown in words.items():
        _child(box, "option", shown, value=word)


def _taken(option: Option[Any, Any], words: Mapping[str, str]) -> str:
    """What is behind the name of an option: what its numbers are, or what may be written; `words` are its choices."""
    if option.kind == "flag" or words:
        return "" if option.kind == "flag" else ":"
    units = {"length": "mm", "angle": "degrees"}
    return f" ({units.get(option.kind, option.shown.replace('|', ', '))}):"


def _words(name: str, option: Option[Any, Any]) -> dict[str, str]:
    """The words of an option with what they mean, its default first: Inkscape begins with the first."""
    if name == "group":
        words = {word: f"{word}: {symmetry_of(word)}" for word in GROUP_NAMES}
    elif name == "cell":
        rectangle = f'the rectangle "{CELL_LABEL}"'
        words = {"fitted": f"{rectangle}, or fitted to the strokes", "numbers": f"{rectangle}, or the numbers below"}
    else:
        words = {word: word for word in (preset_names() if name == "preset" else option.words)}
    if not words:
        return {}
    usual = "" if option.default is None else option.default
    return {usual: words.get(usual, "as usual"), **words}
