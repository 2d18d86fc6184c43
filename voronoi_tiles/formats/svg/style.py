"""What CSS says of an object's strokes and fill: presentation attributes, simple style sheets, style attributes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.formats.svg.colours import parse_colour
from voronoi_tiles.formats.svg.xml_tree import Node

WORK_MAX: Final = 2_000_000
"""Most rules that are looked at for all elements; a count. Two seconds' work."""

PROPERTIES: Final = frozenset({"stroke", "fill", "stroke-width", "display", "visibility", "color"})

_COMMENT: Final = re.compile(r"/\*.*?(?:\*/|\Z)", re.DOTALL)
_SELECTOR: Final = re.compile(r"(\*|[A-Za-z][\w-]*)?((?:[.#][\w-]+)*)")
_NONE: Final = frozenset({"none", "transparent"})


class Style(NamedTuple):
    """The inherited properties: colours "#rrggbb" or None, `width` as text in the object's own units."""

    stroke: str | None = None
    fill: str | None = "#000000"
    width: str = "1"
    visible: bool = True
    colour: str = "#000000"


class _Selector(NamedTuple):
    tag: str
    names: frozenset[str]  # ".class" and "#id"


@dataclass
class StyleSheet:
    """The rules of all style sheets; `unread` counts those with selectors or at-rules that are not understood."""

    rules: list[tuple[tuple[int, int, int], _Selector, dict[str, str]]] = field(default_factory=list)
    unread: int = 0
    _keyed: dict[str, list[int]] = field(default_factory=dict)
    _known: dict[tuple[str, frozenset[str]], dict[str, str]] = field(default_factory=dict)
    _named: set[str] = field(default_factory=set)
    _work: int = 0

    def add(self, text: str) -> None:
        """Read a style sheet: rules for elements, classes and ids, and lists of them."""
        text = _COMMENT.sub(" ", text).replace("<!--", " ").replace("-->", " ")
        for rule in text.split("}"):
            selectors, brace, body = rule.partition("{")
            declarations = dict(_declarations(body.rpartition("{")[2]))
            if not brace or not declarations:
                continue
            if "{" in body:  # a condition, such as @media, about the rule
                self.unread += 1
                continue
            for part in selectors.rpartition(";")[2].split(","):
                selector = _SELECTOR.fullmatch(part.strip())
                if selector is None or not part.strip():
                    self.unread += 1
                    continue
                tag = "" if selector[1] in {None, "*"} else selector[1]
                names = frozenset(re.findall(r"[.#][\w-]+", selector[2]))
                ids = sum(name.startswith("#") for name in names)
                weight = (ids, len(names) - ids, int(bool(tag)))
                # Rules are found by one of their names, so that many rules and many objects are no product.
                self._keyed.setdefault(min(names, default=tag), []).append(len(self.rules))
                self.rules.append((weight, _Selector(tag, names), declarations))
                self._named |= names

    def declared(self, tag: str, attributes: dict[str, str]) -> dict[str, str]:
        """What the rules declare for an element.

        Raises DrawingError when more than WORK_MAX rules have been looked at for all elements.
        """
        if not self.rules:
            return {}
        names = {f".{name}" for name in attributes.get("class", "").split()}
        if "id" in attributes:
            names.add(f"#{attributes['id']}")
        key = tag, frozenset(names & self._named)
        if key not in self._known:
            found = [number for name in (*key[1], tag, "") for number in self._keyed.get(name, ())]
            self._work += len(found)
            if self._work > WORK_MAX:
                raise DrawingError("its style sheets are too large", remedy="Save it as plain SVG.")
            result: dict[str, str] = {}
            for number in sorted(found, key=lambda n: (self.rules[n][0], n)):
                _, selector, declarations = self.rules[number]
                if selector.tag in {"", tag} and selector.names <= names:
                    result.update(declarations)
            self._known[key] = result
        return self._known[key]


def properties(node: Node, tag: str, sheet: StyleSheet) -> dict[str, str]:
    """What is said of an element itself, by the order of CSS; the keys are those of PROPERTIES."""
    attributes = node.attributes
    said = {name: value for name, value in attributes.items() if name in PROPERTIES}
    said.update(sheet.declared(tag, attributes))
    if "style" in attributes:
        said.update(_declarations(attributes["style"]))
    return said


def _declarations(text: str) -> Iterator[tuple[str, str]]:
    """The declarations "name: value; ..." of PROPERTIES."""
    for part in text.split(";"):
        name, colon, value = part.partition(":")
        if colon and name.strip() in PROPERTIES:
            yield name.strip(), value.replace("!important", "").strip()


def inherited(parent: Style, said: dict[str, str]) -> Style:
    """The style of an element from its parent's and from what is said of itself."""
    if not said:
        return parent
    colour = _paint(said.get("color"), parent.colour, parent.colour) or parent.colour
    return Style(
        stroke=_paint(said.get("stroke"), parent.stroke, colour),
        fill=_paint(said.get("fill"), parent.fill, colour),
        width=said.get("stroke-width", "inherit").replace("inherit", parent.width),
        visible=_visible(said.get("visibility"), parent.visible),
        colour=colour,
    )


def _paint(text: str | None, before: str | None, current: str) -> str | None:
    """A stroke or fill; what is no colour leaves that of the parent, as CSS says. A gradient or pattern is grey."""
    if text is None or text == "inherit":
        return before
    word = text.lower()
    if word in _NONE:
        return None
    if word == "currentcolor":
        return current
    if word.startswith("url("):
        rest = text.rpartition(")")[2].strip()
        return None if rest.lower() in _NONE else parse_colour(rest) or "#808080"
    return parse_colour(text) or before


def _visible(text: str | None, before: bool) -> bool:
    if text in {"visible", "hidden", "collapse"}:
        return text == "visible"
    return before
