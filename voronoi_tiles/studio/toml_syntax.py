"""A TOML text as a tree that gives back the text byte for byte, and says which comment belongs to what.

A comment belongs to what it stands beside, or directly above; after a blank line it stands for itself. Python's own
parser says what a text means, and is asked before this one: here only valid texts come, and only places matter.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final, TypeAlias

_COMMENT: Final = re.compile(r"[ \t]*+#[^\r\n]*+")
_BLANK: Final = re.compile(r"[ \t\r]*+")
_TRIVIA: Final = re.compile(r"(?:[ \t\r\n]++|#[^\n]*+)*+")
_LINES: Final = re.compile(r"(?:[ \t\r]*+(?:#[^\n]*+)?\n)*+(?:[ \t]*+#[^\n]*+\Z)?+[ \t]*+")
"""Whole lines that are blank or comments, and the indent of the next one."""
_LINE_END: Final = re.compile(r"[ \t\r]*+(?:#[^\n]*+)?(?:\n|\Z)")
_NAME: Final = r"(?:[A-Za-z0-9_-]++|\"(?:[^\"\\\n]|\\.)*+\"|'[^'\n]*+')"
_KEY: Final = re.compile(rf"{_NAME}(?:[ \t]*+\.[ \t]*+{_NAME})*+")
_SIGN: Final = re.compile(r"[ \t]*+=[ \t]*+")
_SCALAR: Final = re.compile(
    r'"""(?:[^"\\]|\\[\s\S]|"{1,2}(?!"))*+"{3,5}'  # up to two quotes may stand before the three that end it
    r"|'''(?:[^']|'{1,2}(?!'))*+'{3,5}"
    r'|"(?:[^"\\\n]|\\.)*+"'
    r"|'[^'\n]*+'"
    r"|\d{4}-\d\d-\d\d \d\d:[^\s,\]}#]++"  # a date and a time, with a blank between them
    r"|[^\s,\]}#]++"
)


@dataclass(eq=False, slots=True)
class Scalar:
    """A value without parts, as it is spelled."""

    text: str

    def pieces(self) -> Iterator[str]:
        """The parts of the text."""
        yield self.text


@dataclass(eq=False, slots=True)
class Item:
    """An item of an array, or a pair of a table, and all that belongs to it.

    `lead` are blanks, line ends and comments before it; `names` those of its key, () in an array, and `head` that key
    as it is spelled with its equals sign; `after` stands between the value and its comma. `trail` is the comment beside
    it; of a pair on a line of its own also the end of the line.
    """

    lead: str
    names: tuple[str, ...]
    head: str
    value: Node
    after: str = ""
    comma: bool = False
    trail: str = ""

    def pieces(self) -> Iterator[str]:
        """The parts of the text."""
        yield self.lead
        yield self.head
        yield from self.value.pieces()
        yield self.after
        if self.comma:
            yield ","
        yield self.trail


@dataclass(eq=False, slots=True)
class Group:
    """An array or an inline table: `opening` is its bracket with the comment beside it, `end` is before the other."""

    opening: str
    items: list[Item]
    end: str

    def pieces(self) -> Iterator[str]:
        """The parts of the text."""
        yield self.opening
        for item in self.items:
            yield from item.pieces()
        yield self.end
        yield "]" if self.opening.startswith("[") else "}"


Node: TypeAlias = Scalar | Group


@dataclass(eq=False, slots=True)
class Section:
    """A header with the lines below it; the first section of a text has none.

    `gap` is what stands before it and does not belong to it: blank lines, and comments with a blank line around them.
    `lead` are the comments directly above the header, `header` is its whole line, and `end` are comments directly below
    the last pair.
    """

    gap: str = ""
    lead: str = ""
    header: str = ""
    names: tuple[str, ...] = ()
    is_array: bool = False
    items: list[Item] = field(default_factory=list)
    end: str = ""

    def pieces(self) -> Iterator[str]:
        """The parts of the text."""
        yield from (self.gap, self.lead, self.header)
        for item in self.items:
            yield from item.pieces()
        yield self.end


@dataclass(eq=False, slots=True)
class TomlSyntax:
    """A whole text: its sections, what stands below the last one, and how its lines end."""

    sections: list[Section]
    end: str
    newline: str

    @property
    def text(self) -> str:
        """The text."""
        return "".join((*(piece for section in self.sections for piece in section.pieces()), self.end))


def syntax_of(text: str) -> TomlSyntax:
    """The tree of a text that is TOML, which tomllib has said."""
    return _Scanner(text).document()


def has_comment(trivia: str) -> bool:
    """Whether there is a comment in what stands between values."""
    return "#" in trivia


def parted(lead: str) -> tuple[str, str]:
    """What stands above an item: first what does not belong to it, as far as a line's end, then what does."""
    lines = lead.splitlines(keepends=True)
    k = len(lines)
    if lines and not lead.endswith("\n"):  # the indent of the item
        k -= 1
    while k > 0 and has_comment(lines[k - 1]):
        k -= 1
    return "".join(lines[:k]), "".join(lines[k:])


class _Scanner:
    """Reads a text from one end to the other; `_at` is where it is."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0

    def _take(self, pattern: re.Pattern[str]) -> str:
        """What a pattern matches here, "" where it does not."""
        match = pattern.match(self._text, self._at)
        if match is None:
            return ""
        self._at = match.end()
        return match[0]

    def document(self) -> TomlSyntax:
        """Read the whole text."""
        section = Section()
        sections = [section]
        while True:
            lead = self._take(_LINES)
            if self._at == len(self._text):
                section.end, end = _directly_below(section, lead)
                return TomlSyntax(sections, end, "\r\n" if "\r\n" in self._text else "\n")
            if self._text[self._at] != "[":
                section.items.append(self._pair(lead))
                section.items[-1].trail = self._take(_LINE_END)
                continue
            apart, own = parted(lead)
            section.end, gap = _directly_below(section, apart)
            section = self._header(gap, own)
            sections.append(section)

    def _header(self, gap: str, lead: str) -> Section:
        """Read the line of a header."""
        begin = self._at
        is_array = self._text.startswith("[[", begin)
        self._at += 1 + is_array
        self._take(_BLANK)
        names = self._key()[0]
        self._take(_BLANK)
        self._at += 1 + is_array
        self._take(_LINE_END)
        return Section(gap, lead, self._text[begin : self._at], names, is_array)

    def _key(self) -> tuple[tuple[str, ...], str]:
        """Read a key: its names, and how it is spelled."""
        spelled = self._take(_KEY)
        names = re.findall(_NAME, spelled)
        return tuple(tomllib.loads(f"k = {name}")["k"] if name[0] in "\"'" else name for name in names), spelled

    def _pair(self, lead: str) -> Item:
        """Read a key and its value."""
        names, spelled = self._key()
        head = spelled + self._take(_SIGN)
        return Item(lead, names, head, self._value())

    def _value(self) -> Node:
        """Read a value."""
        bracket = self._text[self._at]
        if bracket not in "[{":
            return Scalar(self._take(_SCALAR))
        self._at += 1
        group = Group(bracket + self._take(_COMMENT), [], "")
        closing = "]" if bracket == "[" else "}"
        while True:
            lead = self._take(_TRIVIA)
            if self._text[self._at] == closing:
                group.end = lead
                break
            item = Item(lead, (), "", self._value()) if bracket == "[" else self._pair(lead)
            group.items.append(item)
            begin = self._at
            item.after = self._take(_TRIVIA)
            if self._text[self._at] == ",":
                item.comma = True
                self._at += 1
                item.trail = self._take(_COMMENT)
                continue
            # What is beside the last item, without a comma, is its own; what comes then is the bracket's.
            self._at, item.after = begin, ""
            item.trail = self._take(_COMMENT)
        self._at += 1
        return group


def _directly_below(section: Section, text: str) -> tuple[str, str]:
    """The comments directly below the last line of a section, and what comes after them."""
    if not (section.header or section.items):
        return "", text
    lines = text.splitlines(keepends=True)
    k = 0
    while k < len(lines) and has_comment(lines[k]):
        k += 1
    return "".join(lines[:k]), "".join(lines[k:])
