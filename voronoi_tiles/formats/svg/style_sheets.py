"""Style sheets: their rules for the elements of a drawing, in the order of CSS's cascade.

Read are rules with any selector that selectors.py matches, in @layer and in @media for a light screen. What else there
is, is counted.
"""

from __future__ import annotations

import re
from typing import Any, Final, NamedTuple

import tinycss2
from cssselect2 import SelectorError, parser
from tinycss2.ast import Node as Token

from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.formats.svg.css_text import NESTING_MAX, check_nesting, split
from voronoi_tiles.formats.svg.properties import PROPERTIES, WIDE, Origin, Verdict, expanded, verdict
from voronoi_tiles.formats.svg.selectors import Selectors, is_understood, parse_selectors
from voronoi_tiles.formats.svg.xml_tree import Node

SHEETS_MAX: Final = 4 * 2**20
"""Longest style sheets, all together; characters. Some seconds' work."""

_SILENT: Final = frozenset(
    {"charset", "font-face", "font-feature-values", "page", "keyframes", "-webkit-keyframes", "property"}
)
"""At-rules that draw nothing by themselves: an animation counts where it is used."""

_LAST: Final = (1 << 30,)
"""What is in a layer but in none of its layers comes after these."""


Values = dict[str, tuple[str, ...]]
"""For each property the values that are declared for it, what wins last."""


class Declared(NamedTuple):
    """What a rule or a style attribute declares."""

    normal: Values
    important: Values


NOTHING: Final = Declared({}, {})


class _Rule(NamedTuple):
    selector: Any
    simple: bool  # whether the element's name, classes and id decide
    layer: tuple[int, ...]
    declared: Declared


class StyleSheets:
    """The rules of all style sheets; `unread` counts what was not understood of them."""

    def __init__(self, root: Node) -> None:
        self.unread = 0
        self._root = root
        self._rules: list[_Rule] = []
        self._keyed: dict[str, list[int]] = {}
        self._layers: dict[tuple[str, ...], int] = {}
        self._namespaces: dict[str | None, str] = {}
        self._selectors = Selectors(root)
        self._known: dict[tuple[str, ...], Declared] = {}
        self._size = 0

    def add(self, text: str, media: str = "") -> None:
        """Read a style sheet, if it is for a light screen.

        Raises DrawingError where all of them are longer than SHEETS_MAX, or too deep.
        """
        self._size += len(text)
        if self._size > SHEETS_MAX:
            raise DrawingError("its style sheets are too large", remedy="Save it as plain SVG.")
        check_nesting(text)
        if not self._is_shown(tinycss2.parse_component_value_list(media, skip_comments=True)):
            return
        self._read(tinycss2.parse_stylesheet(text, skip_comments=True, skip_whitespace=True), ())

    def declared(self, node: Node) -> Declared:
        """What the rules declare for an element.

        Raises DrawingError when more has been compared than selectors allow.
        """
        if not self._rules:
            return NOTHING
        attributes = node.attributes
        tag = node.tag.rpartition(" ")[2]
        names = [f".{name}" for name in attributes.get("class", "").split()]
        if "id" in attributes:
            names.append(f"#{attributes['id']}")
        keys = tuple(sorted(name for name in {*names, tag, ""} if name in self._keyed))
        known = self._known.get((tag, *keys))
        if known is not None:
            return known
        numbers = [number for key in keys for number in self._keyed[key]]
        found = [number for number in numbers if self._selectors.matches(node, self._rules[number].selector)]
        rules = [(self._rules[number], number) for number in found]
        rules.sort(key=lambda pair: (pair[0].layer, pair[0].selector.specificity, pair[1]))
        normal = self._united([rule.declared.normal for rule, _ in rules])
        # Of important ones the first layer wins.
        rules.sort(key=lambda pair: ([-step for step in pair[0].layer], pair[0].selector.specificity, pair[1]))
        result = Declared(normal, self._united([rule.declared.important for rule, _ in rules]))
        if all(self._rules[number].simple for number in numbers):
            self._known[(tag, *keys)] = result
        return result

    def _united(self, parts: list[Values]) -> Values:
        """The values of several rules, the winning one last."""
        result: Values = {}
        for part in parts:
            self._selectors.count(len(part))
            for name, values in part.items():
                result[name] = shortened(name, result.get(name, ()) + values, Origin.SHEET)
        return result

    def _read(self, rules: list[Token], layer: tuple[str, ...]) -> None:
        """Read the rules of a sheet or a block."""
        for rule in rules:
            if rule.type == "qualified-rule":
                self._read_rule(rule, layer)
            elif rule.type == "at-rule":
                self._read_at_rule(rule, layer)
            elif rule.type == "error":
                self.unread += 1

    def _read_at_rule(self, rule: Token, layer: tuple[str, ...]) -> None:
        name = rule.lower_at_keyword
        if name in {"media", "layer"} and rule.content is not None:
            if name == "media":
                inner, shown = layer, self._is_shown(rule.prelude)
            else:
                named = tinycss2.serialize(rule.prelude).strip()
                inner, shown = (*layer, *(named.split(".") if named else (f" {len(self._layers)}",))), True
                self._layer(inner)
            if shown:
                content = tinycss2.parse_rule_list(rule.content, skip_comments=True, skip_whitespace=True)
                self._read(content, inner)
        elif name == "layer":
            for part in split(rule.prelude, ","):
                self._layer((*layer, *tinycss2.serialize(part).strip().split(".")))
        elif name == "namespace":
            self._read_namespace(rule)
        elif name not in _SILENT:
            self.unread += 1

    def _layer(self, names: tuple[str, ...]) -> tuple[int, ...]:
        """The place of a layer among all; layers come in the order in which they are first named.

        Raises DrawingError where layers are nested more than NESTING_MAX deep.
        """
        if len(names) > NESTING_MAX:
            raise DrawingError(
                f"layers nested more than {NESTING_MAX} deep in its styles", remedy="Save it as plain SVG."
            )
        return (
            *(self._layers.setdefault(names[:count], len(self._layers)) for count in range(1, len(names) + 1)),
            *_LAST,
        )

    def _read_namespace(self, rule: Token) -> None:
        words = [token for token in rule.prelude if token.type != "whitespace"]
        prefix = words[0].value if len(words) == 2 else None
        uri = words[-1] if words else None
        if uri is not None and uri.type == "function":  # url("...") with quotes
            uri = uri.arguments[0] if uri.arguments else None
        if uri is None or uri.type not in {"string", "url"}:
            self.unread += 1
        else:
            self._namespaces[prefix] = uri.value

    def _read_rule(self, rule: Token, layer: tuple[str, ...]) -> None:
        """Take in a rule for each of its selectors."""
        declared, unread = read_declarations(rule.content, Origin.SHEET)
        self.unread += unread
        if declared == NOTHING:
            return
        try:
            selectors = [each for part in split(rule.prelude, ",") for each in parse_selectors(part, self._namespaces)]
        except (SelectorError, IndexError):
            self.unread += 1
            return
        for selector in selectors:
            if selector.pseudo_element is not None:
                continue
            if not is_understood(selector):
                self.unread += 1
                continue
            key, simple = _key(selector.parsed_tree)
            # Rules are found by one of their names, so that many rules and many objects are no product.
            self._keyed.setdefault(key, []).append(len(self._rules))
            self._rules.append(_Rule(selector, simple, self._layer(layer), declared))

    def _is_shown(self, prelude: list[Token]) -> bool:
        """Whether a list of media queries holds for a light screen; those with other conditions count as unread."""
        queries = [tinycss2.serialize(part).strip().lower() for part in split(prelude, ",")]
        if queries == [""]:
            return True
        answers = [_answer(query) for query in queries]
        if True not in answers and None in answers:
            self.unread += 1
        return True in answers


def read_declarations(content: str | list[Token], origin: Origin) -> tuple[Declared, int]:
    """What a block or a style attribute declares, and how many rules stand in it, which are not read.

    Raises DrawingError where brackets are nested too deep.
    """
    declared = Declared({}, {})
    unread = 0
    if isinstance(content, str):
        check_nesting(content)
    for item in tinycss2.parse_blocks_contents(content, skip_comments=True, skip_whitespace=True):
        unread += item.type in {"qualified-rule", "at-rule"}
        if item.type == "declaration":
            text = _COMMENT.sub(" ", tinycss2.serialize(item.value)).strip()
            for name, value in expanded(item.name if item.name.startswith("--") else item.lower_name, text):
                part = declared.important if item.important else declared.normal
                part[name] = shortened(name, (*part.get(name, ()), value), origin)
    return declared, unread


def shortened(name: str, values: tuple[str, ...], origin: Origin) -> tuple[str, ...]:
    """The values of a property without those that cannot come into play, the winning one last."""
    if name not in PROPERTIES:
        return values[-1:]
    kept: list[str] = []
    for value in reversed(values):
        kept.append(value)
        if is_settled(name, value, origin) or len(kept) == _KEPT:
            break
    return tuple(reversed(kept))


def is_settled(name: str, value: str, origin: Origin) -> bool:
    """Whether a value wins over all that is declared before it, wherever it is used."""
    word = value.lower()
    if word in WIDE:
        return word != "revert-layer"
    return "var(" not in word and verdict(name, value, origin) == Verdict.VALID


_KEPT: Final = 8
"""Most values of a property that are kept, where browsers may understand some; a count."""

_COMMENT: Final = re.compile(r"/\*.*?\*/", re.DOTALL)

_FEATURES: Final = {
    "(prefers-color-scheme: light)": True,
    "(prefers-color-scheme: dark)": False,
    "(prefers-reduced-motion: no-preference)": True,
    "(prefers-reduced-motion: reduce)": False,
}


def _answer(query: str) -> bool | None:
    """Whether a media query holds for a light screen; None where that depends on more."""
    query = re.sub(r"\s*:\s*", ": ", " ".join(query.split()))
    negated = query.startswith("not ")
    parts = re.sub(r"^(not|only) ", "", query).split(" and ")
    answers: list[bool | None] = [
        part in {"all", "screen"} if re.fullmatch(r"[a-z-]+", part) else _FEATURES.get(part) for part in parts
    ]
    answer = False if False in answers else None if None in answers else True
    return (not answer if negated else answer) if answer is not None else None


def _key(tree: Any) -> tuple[str, bool]:
    """What an element has at least: "#id", ".class", "tag" or "", and whether a selector asks for such names alone."""
    compound = tree.right if isinstance(tree, parser.CombinedSelector) else tree
    key, simple = "", tree is compound
    for part in compound.simple_selectors:
        match part:
            case parser.IDSelector():
                key = f"#{part.ident}"
            case parser.ClassSelector():
                key = key if key.startswith("#") else f".{part.class_name}"
            case parser.LocalNameSelector():
                key = key or part.local_name
            case _:
                simple = False
    return key, simple
