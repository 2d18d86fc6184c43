"""Which elements a selector of CSS means.

Selectors are parsed by cssselect2. They are matched here: its own matcher makes Python code of them, and looks at
ancestors again and again, which a hostile style sheet makes endless. Here work is counted.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from cssselect2 import SelectorError, parser
from tinycss2.ast import Node as Token
from tinycss2.nth import parse_nth

from voronoi_tiles.formats.shapes import DrawingError
from voronoi_tiles.formats.svg.xml_tree import Node

WORK_MAX: Final = 1_000_000
"""Most comparisons of elements with parts of selectors; a count. Some seconds' work."""

TOKENS_MAX: Final = 200
"""Longest selector; tokens. Matching one calls itself once for every part."""

_NEVER_TEXT: Final = """
    hover active focus focus-within focus-visible target target-within visited checked indeterminate
    current past future playing paused
"""
_NEVER: Final = frozenset(_NEVER_TEXT.split())  # on paper
# How often a kind of element or a place among siblings comes, and the numbers of places.
_PLACES: Final = {
    "first-child": (False, False, (0, 1)),
    "last-child": (True, False, (0, 1)),
    "first-of-type": (False, True, (0, 1)),
    "last-of-type": (True, True, (0, 1)),
}
_COUNTED: Final = {
    "nth-child": (False, False),
    "nth-last-child": (True, False),
    "nth-of-type": (False, True),
    "nth-last-of-type": (True, True),
}

Test = Callable[[Node], bool]


def parse_selectors(tokens: list[Token], namespaces: dict[str | None, str]) -> list[Any]:
    """The selectors of a list. Raises SelectorError for what is no selector, or too long a one."""
    if len(tokens) > TOKENS_MAX:
        raise SelectorError(tokens[0], "selector too long")
    return list(parser.parse(tokens, namespaces))


class Selectors:
    """Matches elements of a tree with selectors.

    Raises DrawingError when more than WORK_MAX comparisons have been made in all.
    """

    def __init__(self, root: Node) -> None:
        self._root = root
        self._family: dict[int, tuple[Node | None, int]] = {}
        self._known: dict[tuple[int, int], bool] = {}
        self._work = 0

    def matches(self, node: Node, selector: Any) -> bool:
        """Whether an element is meant. Raises SelectorError for selectors that are not understood."""
        self.count()
        return self._matches(node, selector.parsed_tree)

    def _matches(self, node: Node, tree: Any) -> bool:
        """Whether an element is meant by a part of a selector; every pair is looked at once."""
        if isinstance(tree, parser.CompoundSelector):
            return all(self._is(node, part) for part in tree.simple_selectors)
        if not isinstance(tree, parser.CombinedSelector):
            raise SelectorError(tree, "unknown selector")
        key = id(tree), id(node)
        if key not in self._known:
            self._known[key] = self._matches(node, tree.right) and self._is_related(node, tree)
        return self._known[key]

    def _is_related(self, node: Node, tree: Any) -> bool:
        """Whether the element that the left part of a combination means is there."""
        parent, place = self._place(node)
        if parent is None:
            return False
        if tree.combinator in " >":
            above: Node | None = parent
            while above is not None:
                if self._matches(above, tree.left):
                    return True
                above = None if tree.combinator == ">" else self._place(above)[0]
            return False
        first = max(place - 1, 0) if tree.combinator == "+" else 0
        return any(self._matches(parent.children[k], tree.left) for k in range(first, place))

    def _is(self, node: Node, part: Any) -> bool:  # noqa: PLR0911 - one answer for each kind of selector
        """Whether an element is meant by a simple selector."""
        self.count()
        attributes = node.attributes
        match part:
            case parser.LocalNameSelector():
                return bool(node.tag.rpartition(" ")[2] == part.local_name)
            case parser.NamespaceSelector():
                return bool(node.tag.rpartition(" ")[0] == part.namespace)
            case parser.IDSelector():
                return bool(attributes.get("id") == part.ident)
            case parser.ClassSelector():
                return part.class_name in attributes.get("class", "").split()
            case parser.AttributeSelector():
                return _has_attribute(attributes, part)
            case parser.NegationSelector():
                return not any(self._matches(node, inner.parsed_tree) for inner in part.selector_list)
            case parser.MatchesAnySelector() | parser.SpecificityAdjustmentSelector():
                return any(self._matches(node, inner.parsed_tree) for inner in part.selector_list)
            case parser.PseudoClassSelector():
                return self._is_such(node, part.name)
            case parser.FunctionalPseudoClassSelector() if part.name in _COUNTED:
                nth = parse_nth(part.arguments)
                if nth is not None:
                    return self._is_at(node, *_COUNTED[part.name], nth)
        raise SelectorError(part, "unknown selector")

    def _is_such(self, node: Node, name: str) -> bool:
        """Whether an element is of a class that needs no name."""
        if name in {"root", "scope"}:
            return node is self._root
        if name in _NEVER:
            return False
        if name in _PLACES:
            return self._is_at(node, *_PLACES[name])
        if name in {"only-child", "only-of-type"}:
            kind = name.removeprefix("only-")
            return self._is_such(node, f"first-{kind}") and self._is_such(node, f"last-{kind}")
        raise SelectorError(name, "unknown class")

    def _is_at(self, node: Node, backwards: bool, typed: bool, nth: tuple[int, int]) -> bool:
        """Whether an element is the (step k + first)-th of its parent's children, or of those that are called alike."""
        parent, place = self._place(node)
        if parent is None:
            number = 1
        elif typed:
            self.count(len(parent.children))
            among = parent.children[place:] if backwards else parent.children[: place + 1]
            number = sum(sibling.tag == node.tag for sibling in among)
        else:
            number = len(parent.children) - place if backwards else place + 1
        step, first = nth
        return number == first if step == 0 else (number - first) % step == 0 and (number - first) // step >= 0

    def _place(self, node: Node) -> tuple[Node | None, int]:
        """An element's parent, and its number among the children."""
        if not self._family:
            self._family[id(self._root)] = None, 0
            todo = [self._root]
            while todo:
                parent = todo.pop()
                self._family.update((id(child), (parent, place)) for place, child in enumerate(parent.children))
                todo.extend(parent.children)
        self.count()
        return self._family[id(node)]

    def count(self, work: int = 1) -> None:
        """Count comparisons, or other work."""
        self._work += work
        if self._work > WORK_MAX:
            raise DrawingError("its style sheets are too large", remedy="Save it as plain SVG.")


def is_understood(selector: Any) -> bool:
    """Whether a selector can be matched: it is tried at an element that has no kin."""
    probe = Node("", {}, 0)
    parts = [selector.parsed_tree]
    try:
        while parts:
            part = parts.pop()
            if isinstance(part, parser.CombinedSelector):
                parts += [part.left, part.right]
                continue
            for simple in part.simple_selectors:
                Selectors(probe)._is(probe, simple)  # noqa: SLF001 - its own class
                parts += [inner.parsed_tree for inner in getattr(simple, "selector_list", ())]
    except SelectorError:
        return False
    return True


def _has_attribute(attributes: dict[str, str], part: Any) -> bool:  # noqa: PLR0911 - one for each operator
    """Whether an element has an attribute, with the value that a selector asks for."""
    if part.namespace is None:
        raise SelectorError(part, "attribute of any namespace")
    name = f"{part.namespace} {part.name}".strip()
    if name not in attributes:
        return False
    if part.operator is None:
        return True
    value, asked = attributes[name], part.value
    if part.case_sensitive is False:
        value, asked = value.lower(), asked.lower()
    match part.operator:
        case "=":
            return bool(value == asked)
        case "~=":
            return asked in value.split()
        case "|=":
            return bool(value == asked) or value.startswith(f"{asked}-")
        case "^=":
            return bool(asked) and value.startswith(asked)
        case "$=":
            return bool(asked) and value.endswith(asked)
        case _:
            return bool(asked) and asked in value
