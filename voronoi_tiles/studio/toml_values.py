"""Pairs and values of a TOML text, edited so that all that is not meant to change stays as it is spelled."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from numbers import Integral, Real
from typing import Any, Final, TypeAlias

from voronoi_tiles.designs.toml_text import toml_key, toml_lines, toml_value, wrapped
from voronoi_tiles.studio.matching import matched, same
from voronoi_tiles.studio.toml_syntax import Group, Item, Node, Scalar, Section, has_comment, parted

Table: TypeAlias = Mapping[str, Any]
Names: TypeAlias = tuple[str, ...]

REWRITTEN: Final = "A part of the file was written anew: the comments within it are gone."
"""What is said where comments could not be kept."""

_FLOAT: Final = re.compile(r"[+-]?[0-9_]+(?:\.|[eE])")


class NotEditedError(Exception):
    """A way of writing tables that is not edited in place."""


class ValueEditor:
    """Changes values and pairs in place: each method makes what now reads as `old` read as `new`.

    `newline` ends new lines; `notes` are sentences on what could not be kept.
    """

    def __init__(self, newline: str) -> None:
        self._newline = newline
        self.notes: list[str] = []

    def pairs(self, holder: Section | Group, prefix: Names, old: Table, new: Table) -> None:
        """Edit the pairs of a table whose keys begin with `prefix`."""
        depth = len(prefix)
        first = holder.items[0].lead if holder.items else " "
        for name in old:
            path = (*prefix, name)
            own = [item for item in holder.items if item.names[: depth + 1] == path]
            if name not in new:
                for item in own:
                    self._remove(holder, item)
            elif same(old[name], new[name]):
                continue
            elif [item.names for item in own] == [path]:
                self._set(own[0], old[name], new[name])
            elif new[name] and isinstance(new[name], Mapping):
                self.pairs(holder, path, old[name], new[name])
            else:
                raise NotEditedError
        for name in new:
            if name not in old:
                self._insert(holder, (*prefix, name), new[name])
        if isinstance(holder, Group):
            self._settle(holder, first, comma=False)

    def _set(self, item: Item, old: Any, new: Any) -> None:
        """Give an item another value; a comment that stands apart beside it stays in its column where it can."""
        blanks = len(item.trail) - len(item.trail.lstrip(" "))
        if blanks < 2 or not has_comment(item.trail):
            item.value = self._value(item.value, old, new)
            return
        before = "".join(item.value.pieces())
        item.value = self._value(item.value, old, new)
        after = "".join(item.value.pieces())
        grown = len(after) - max(after.rfind("\n"), 0) - (len(before) - max(before.rfind("\n"), 0))
        item.trail = " " * max(1, blanks - grown) + item.trail[blanks:]

    def _value(self, node: Node, old: Any, new: Any) -> Node:
        """The node of a value that is another one; the same node where parts of it can stay."""
        if same(old, new):
            return node
        if isinstance(node, Group):
            if isinstance(old, Mapping) and isinstance(new, Mapping):
                self.pairs(node, (), old, new)
                return node
            if isinstance(old, list) and isinstance(new, list | tuple):
                self._array(node, old, new)
                return node
            if any(map(has_comment, _trivia(node))):
                self.notes.append(REWRITTEN)
        return Scalar(_spelled(new, node.text if isinstance(node, Scalar) else ""))

    def _array(self, group: Group, old: Sequence[Any], new: Sequence[Any]) -> None:
        """Edit an array."""
        layout = _layout(group)
        match = matched(old, new)
        was = list(group.items)
        first = was[0].lead if was else ""
        for gone in set(range(len(was))) - set(match):
            self._remove(group, was[gone])
        numbers = next((item.value.text for item in was if isinstance(item.value, Scalar)), "")
        made = []
        for j, i in enumerate(match):
            if i is None:
                made.append(Item(layout, (), "", self._made(new[j], numbers, layout)))
                continue
            self._set(was[i], old[i], new[j])
            if i == 0 and j > 0 and _is_plain(first):
                was[i].lead = layout
            made.append(was[i])
        group.items = made
        self._settle(group, first, comma=was[-1].comma if was else "\n" in layout)

    def _made(self, value: Any, like: str, layout: str) -> Scalar:
        """The node of a new value in an array; long ones are broken over lines where the array is."""
        text = _spelled(value, like)
        if "\n" in layout:
            text = wrapped(text).replace("\n    ", layout + "  ")
        return Scalar(text)

    def _insert(self, holder: Section | Group, names: Names, value: Any) -> None:
        """Add a pair behind the last one of its table."""
        prefix = names[:-1]
        places = [k for k, item in enumerate(holder.items) if item.names[: len(prefix)] == prefix]
        at = places[-1] + 1 if places else len(holder.items)
        before = holder.items[at - 1] if at else None
        head = ".".join(map(toml_key, names)) + " = "
        like = before.value.text if before is not None and isinstance(before.value, Scalar) else ""
        if isinstance(holder, Group):
            holder.items.insert(at, Item(" ", names, head, Scalar(_spelled(value, like))))
            return
        if before is None:
            if holder.header and not holder.header.endswith("\n"):
                holder.header += self._newline
        elif not before.trail.endswith("\n"):
            before.trail += self._newline
        indent = parted(before.lead)[1].rpartition("\n")[2] if before is not None else ""
        text = toml_lines(value).replace("\n", self._newline) if is_tables(value) else _spelled(value, like)
        holder.items.insert(at, Item(indent, names, head, Scalar(text), trail=self._newline))

    def _remove(self, holder: Section | Group, item: Item) -> None:
        """Remove an item with its comments; those that stand apart above it stay."""
        k = holder.items.index(item)
        del holder.items[k]
        apart = parted(item.lead)[0]
        if not has_comment(apart):
            return
        if isinstance(holder, Group):
            apart = apart.rstrip()
        if k < len(holder.items):
            holder.items[k].lead = apart + self._on_new_line(holder.items[k].lead, holder)
        else:
            holder.end = apart + self._on_new_line(holder.end, holder)

    def _on_new_line(self, trivia: str, holder: Section | Group) -> str:
        """What comes behind a comment: in an array it has to begin with the end of the line."""
        ends = isinstance(holder, Section) or trivia.lstrip(" \t\r").startswith("\n")
        return trivia if ends else self._newline + trivia

    def _settle(self, group: Group, first: str, *, comma: bool) -> None:
        """See to it that a group is TOML: commas between its items, and comments that end where lines do.

        `first` is what stood before the first item; `comma` is whether there is one behind the last.
        """
        for item in group.items:
            item.comma = True
        if group.items:
            group.items[-1].comma = comma
            if _is_plain(group.items[0].lead) and not has_comment(first):
                group.items[0].lead = first  # as "[1, 2]" has no blank there
        ends_in_comment = has_comment(group.opening)
        for item in group.items:
            if ends_in_comment:
                item.lead = self._on_new_line(item.lead, group)
            ends_in_comment = has_comment(item.trail)
        if ends_in_comment:
            group.end = self._on_new_line(group.end, group)


def is_tables(value: Any) -> bool:
    """Whether a value is a list of tables, one at least."""
    return isinstance(value, list | tuple) and len(value) > 0 and all(isinstance(item, Mapping) for item in value)


def _is_plain(trivia: str) -> bool:
    """Whether there are blanks and nothing else."""
    return not trivia.strip(" \t")


def _trivia(node: Node) -> Iterator[str]:
    """All that stands between the values of a node."""
    if isinstance(node, Group):
        yield from (node.opening, node.end)
        for item in node.items:
            yield from (item.lead, item.after, item.trail)
            yield from _trivia(item.value)


def _layout(group: Group) -> str:
    """What stands before an item that is new in an array: a blank, or the line end and the indent of the others."""
    if not group.items:
        return group.end + "  " if "\n" in group.end and not has_comment(group.end) else ""
    others = group.items[1:] or group.items
    broken = [item.lead for item in others if "\n" in item.lead]
    if 2 * len(broken) <= len(others):
        return " "
    line_end = "\r\n" if "\r\n" in broken[-1] else "\n"
    return line_end + broken[-1].rpartition("\n")[2]


def _spelled(value: Any, like: str) -> str:
    """A value on one line; a number that is whole has a point where another that is spelled `like` this has one."""
    if isinstance(value, bool) or not isinstance(value, Real):
        return toml_value(value)
    number = int(value) if isinstance(value, Integral) else float(value)
    if number != number // 1 or abs(number) >= 2**53:
        return toml_value(number)
    if _FLOAT.match(like) or (number == 0.0 and math.copysign(1.0, number) < 0.0):
        return repr(float(number))
    return repr(int(number))
