"""What is declared for an element, wherever it is written, and which of it counts: CSS's cascade.

An attribute yields to the rules of style sheets, these to the style attribute, and all of them to what is important, in
the same order. A value that is none of the property's is passed over, so that the one below it counts.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Final

import tinycss2
from tinycss2.ast import Node as Token

from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.formats.svg.css_text import check_nesting, split
from voronoi_tiles.formats.svg.properties import (
    ATTRIBUTES,
    GEOMETRY,
    INHERITED,
    WIDE,
    Origin,
    Verdict,
    expanded,
    path_of,
    verdict,
)
from voronoi_tiles.formats.svg.style_sheets import NOTHING, Declared, StyleSheets, read_declarations, shortened
from voronoi_tiles.formats.svg.xml_tree import Node

CUSTOM_MAX: Final = 1_000
"""Most custom properties of an element, inherited ones counted; a count."""

VALUE_MAX: Final = 20_000
"""Longest value that var() may make; characters."""

_SPECIAL: Final = re.compile(r"""[\\"'(){}\[\]@!/]""")
_NAME: Final = re.compile(r"\s*(-?[A-Za-z][A-Za-z0-9-]*|--[A-Za-z0-9_-]+)\s*")

Note = Callable[[str], None]
"""Takes the name of what is not read."""


class Cascade:
    """What is declared for elements."""

    def __init__(self, root: Node) -> None:
        self._sheets = StyleSheets(root)

    @property
    def unread(self) -> int:
        """How many rules of style sheets are not read."""
        return self._sheets.unread

    def add_sheet(self, node: Node) -> None:
        """Read a style element."""
        self._sheets.add(node.text, node.attributes.get("media", ""))

    def declared(self, node: Node) -> Declarations:
        """All that is declared for an element. Raises DrawingError for styles beyond the limits."""
        style = node.attributes.get("style")
        return Declarations(
            node.attributes, self._sheets.declared(node), NOTHING if style is None else style_attribute(style)
        )


def style_attribute(style: str) -> Declared:
    """What a style attribute declares."""
    return _known_style(style) if len(style) <= _SHORT else _read_style(style)


_SHORT: Final = 1_000
"""Longer style attributes are not kept; characters."""


def _read_style(style: str) -> Declared:
    """What a style attribute declares; it is split at its semicolons where there is nothing that could hide one."""
    if _SPECIAL.search(style):
        return read_declarations(style, Origin.STYLE)[0]
    declared = Declared({}, {})
    for part in style.split(";"):
        before, colon, value = part.partition(":")
        match = _NAME.fullmatch(before)
        if colon and match:
            name = match[1] if match[1].startswith("--") else match[1].lower()
            for each, text in expanded(name, value.strip()):
                lower = declared.normal.get(each, ())
                declared.normal[each] = shortened(each, (*lower, text), Origin.STYLE) if lower else (text,)
    return declared


_known_style = lru_cache(maxsize=1024)(_read_style)


class Declarations:
    """What is declared for one element."""

    __slots__ = ("_attributes", "_sheet", "_style", "custom", "names", "note")

    def __init__(self, attributes: Mapping[str, str], sheet: Declared, style: Declared) -> None:
        self._attributes = attributes
        self._sheet = sheet
        self._style = style
        self.custom: Mapping[str, str] = {}
        self.note: Note = _ignore
        self.names = ATTRIBUTES.intersection(attributes)
        if sheet is not NOTHING or style is not NOTHING:
            self.names = self.names.union(*self._css())

    def _css(self) -> tuple[dict[str, tuple[str, ...]], ...]:
        """What styles declare, what wins last."""
        return self._sheet.normal, self._style.normal, self._sheet.important, self._style.important

    def paint_key(self) -> tuple[object, ...]:
        """What the inherited properties of an element depend on, beside its parent's."""
        attributes = self._attributes
        return id(self._sheet), id(self._style), *((name, attributes.get(name)) for name in self.names & INHERITED)

    def is_attribute(self, name: str) -> bool:
        """Whether a property is written as an attribute, and nowhere else."""
        return name in self._attributes and not any(name in part for part in self._css())

    def attribute(self, name: str) -> str:
        """The text of an attribute."""
        return self._attributes[name]

    def value(self, name: str) -> str | None:
        """The value of a property that counts, which may be one of WIDE; None where there is none.

        What is passed over and might matter is noted.
        """
        return self.found(name)[0]

    def own(self, name: str) -> str | None:
        """The value of a property that is not inherited; None for its initial value."""
        return self.own_written(name)[0]

    def own_written(self, name: str) -> tuple[str | None, Origin]:
        """The same, and where it is written."""
        value, origin, _ = self.found(name)
        if value is None or value.lower() not in WIDE:
            return value, origin
        if value.lower() == "inherit":
            self.note(called(name, value))
        return None, origin

    def found(self, name: str) -> tuple[str | None, Origin, bool]:
        """The value that counts, where it is written, and whether something of it was not understood."""
        if name not in self.names:
            return None, Origin.ATTRIBUTE, False
        passed = ""
        unknown = False
        for value, origin in self._candidates(name):
            text = substituted(value, self.custom.get) if "var(" in value.lower() else value
            word = "unset" if text is None else text.strip().lower()
            if text is None or word in WIDE:
                if word == "revert-layer":
                    continue
                if text is None:
                    self.note(called(name, value))
                if unknown:
                    self.note(called(name, passed))
                return word, origin, unknown or text is None
            judged = verdict(name, text, origin)
            if judged == Verdict.VALID:
                if unknown:
                    self.note(called(name, passed))
                return text, origin, unknown
            if not passed or (judged == Verdict.UNKNOWN and not unknown):
                passed = text
            unknown |= judged == Verdict.UNKNOWN
            if text is not value:  # what var() made counts, or nothing
                break
        if passed.strip():
            self.note(called(name, passed))
        return None, Origin.ATTRIBUTE, bool(passed.strip())

    def _candidates(self, name: str) -> list[tuple[str, Origin]]:
        """The values of a property, what wins first."""
        origins = Origin.SHEET, Origin.STYLE, Origin.SHEET, Origin.STYLE
        found = [
            (value, origin) for part, origin in zip(self._css(), origins, strict=True) for value in part.get(name, ())
        ]
        if name in self._attributes and name in ATTRIBUTES:
            found.insert(0, (self._attributes[name], Origin.ATTRIBUTE))
        return found[::-1]

    def geometry(self) -> Mapping[str, str]:
        """The attributes, with the geometry properties that styles declare in their place."""
        declared = GEOMETRY.intersection(set[str]().union(*self._css())) if self.names else ()
        if not declared:
            return self._attributes
        attributes = dict(self._attributes)
        for name in declared:
            value = self.own(name)
            if value is None:
                attributes.pop(name, None)
            else:
                attributes[name] = path_of(value) or "" if name == "d" else value
        return attributes

    def inherit_custom(self, before: Mapping[str, str]) -> Mapping[str, str]:
        """The custom properties of the element; `before` are its parent's.

        Raises DrawingError where there are more than CUSTOM_MAX, or where one stands for another too often in turn.
        """
        own = {name: self._candidates(name)[0][0] for name in self.names if name.startswith("--")}
        try:
            self.custom = _Custom(before, own).resolved() if own else before
        except RecursionError:
            raise DrawingError(
                "custom properties that stand for each other in a long chain", remedy="Save it as plain SVG."
            ) from None
        return self.custom


def _ignore(_name: str) -> None:
    """Note nothing."""


def called(name: str, value: str) -> str:
    """What a value that is not read is called."""
    text = " ".join(value.split())
    shown = text if len(text) <= 40 else f"{text[:37]}..."
    return f"{'paint' if name in {'fill', 'stroke', 'color'} else name} {shown!r}"


class _Circle(Exception):  # noqa: N818 - it is none of the file
    """Custom properties that stand for each other; `first` is the one that is asked for again."""

    def __init__(self, first: str) -> None:
        super().__init__()
        self.first = first


class _Custom:
    """The custom properties of an element, replaced in each other as they are asked for."""

    def __init__(self, before: Mapping[str, str], own: Mapping[str, str]) -> None:
        if len({*before, *own}) > CUSTOM_MAX:
            raise DrawingError(f"more than {CUSTOM_MAX:,} custom properties", remedy="Save it as plain SVG.")
        self._before = before
        self._own = own
        self._known: dict[str, str | None] = {}
        self._active: list[str] = []

    def resolved(self) -> dict[str, str]:
        """All of them that have a value."""
        every = {name: self.get(name) for name in {**self._before, **self._own}}
        return {name: value for name, value in every.items() if value is not None}

    def get(self, name: str) -> str | None:
        """The value of one; None where it has none, as in a circle."""
        if name not in self._own:
            return self._before.get(name)
        if name in self._active:
            raise _Circle(name)
        if name not in self._known:
            self._active.append(name)
            try:
                self._known[name] = self._value(name)
            except _Circle as circle:
                self._known[name] = None
                if circle.first != name:
                    raise
            finally:
                self._active.pop()
        return self._known[name]

    def _value(self, name: str) -> str | None:
        text = self._own[name]
        word = text.strip().lower()
        if word in WIDE:
            return None if word == "initial" else self._before.get(name)
        return substituted(text, self.get)


def substituted(text: str, lookup: Callable[[str], str | None]) -> str | None:
    """A value with what var() stands for; None where that is nothing, or longer than VALUE_MAX.

    Raises DrawingError where brackets are nested too deep.
    """
    if "var(" not in text.lower():
        return text
    check_nesting(text)
    return _replaced(tinycss2.parse_component_value_list(text, skip_comments=True), lookup)


def _replaced(tokens: list[Token], lookup: Callable[[str], str | None]) -> str | None:
    """The text of tokens, without var()."""
    parts: list[str] = []
    for token in tokens:
        if token.type not in {"function", "() block"}:
            part: str | None = tinycss2.serialize([token])
        elif token.type == "function" and token.lower_name == "var":
            part = _of_variable(token, lookup)
        else:
            name, inside = (token.name, token.arguments) if token.type == "function" else ("", token.content)
            inner = _replaced(inside, lookup)
            part = None if inner is None else f"{name}({inner})"
        if part is None:
            return None
        parts.append(part)
    text = "".join(parts)
    return text if len(text) <= VALUE_MAX else None


def _of_variable(token: Token, lookup: Callable[[str], str | None]) -> str | None:
    """What var(--name, otherwise) stands for."""
    name, *otherwise = split(token.arguments, ",")
    words = [word for word in name if word.type != "whitespace"]
    if len(words) != 1 or words[0].type != "ident" or not words[0].value.startswith("--"):
        return None
    value = lookup(words[0].value)
    if value is None and otherwise:
        return ", ".join(_replaced(part, lookup) or "" for part in otherwise)
    return value
