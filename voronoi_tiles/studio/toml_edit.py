"""The text of a TOML file with the least change so that it reads as something else.

Spelling, layout and comments stay; only what differs is written anew. A comment that belongs to what is removed goes
with it (`voronoi_tiles.studio.toml_syntax` says which do), and what is moved takes its comments along. Whatever
happens, the result is read once more and compared with what it is to say.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import date, time
from numbers import Real
from typing import Any, Final, NamedTuple

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.values import shown
from voronoi_tiles.designs.toml_text import toml_key, toml_pair, toml_text
from voronoi_tiles.studio.matching import matched, same
from voronoi_tiles.studio.toml_syntax import Section, TomlSyntax, has_comment, syntax_of
from voronoi_tiles.studio.toml_values import REWRITTEN, Names, NotEditedError, Table, ValueEditor, is_tables

DEPTH_MAX: Final = 50
"""How deeply a design may be nested; a count. One that can be tiled has five levels."""


class Edit(NamedTuple):
    """A text that reads as it was meant to; `notes` are sentences on what could not be kept of the one before."""

    text: str
    notes: tuple[str, ...] = ()


def edited(text: str, meant: Table) -> Edit:
    """The text of a TOML file with the least change so that it reads as `meant`; see `same` for when it does.

    Raises DesignError where `meant` holds what TOML cannot.
    """
    _check(meant, "")
    before = tomllib.loads(text)
    if same(before, meant):
        return Edit(text)
    try:
        editor = _Editor(syntax_of(text))
        editor.table(editor.root, before, meant, ())
        result = Edit(editor.syntax.text, tuple(editor.notes))
        if same(tomllib.loads(result.text), meant):
            return result
    except (NotEditedError, tomllib.TOMLDecodeError, RecursionError):
        pass
    return Edit(written(meant), ("The file was written anew: its layout and its comments are gone.",))


def written(meant: Table) -> str:
    """A TOML text that reads as `meant`. Raises DesignError where `meant` holds what TOML cannot."""
    _check(meant, "")
    with suppress(LookupError, TypeError, AttributeError):  # a table that is not what a design is
        text = toml_text(meant)
        if same(tomllib.loads(text), meant):
            return text
    return "".join(f"{toml_pair(*pair)}\n" for pair in meant.items())


def _check(value: Any, key: str, depth: int = 0) -> None:
    """Refuse what TOML does not have, or Python cannot read again. Raises DesignError."""
    if depth > DEPTH_MAX:
        raise DesignError("is nested too deeply", key=key, remedy="Take it out.")
    match value:
        case Mapping():
            for name, item in value.items():
                if not isinstance(name, str):
                    raise DesignError(f"{shown(name)} is no name of a key", key=key, remedy="Use a text.")
                _check(item, f"{key}.{name}" if key else name, depth + 1)
        case list() | tuple():
            for k, item in enumerate(value):
                _check(item, f"{key}[{k}]", depth + 1)
        case str() | bool() | Real() | date() | time():
            pass
        case _:
            raise DesignError(f"{shown(value)} is nothing that TOML has", key=key, remedy="Leave it out.")


@dataclass(eq=False)
class _Table:
    """A table that has a header, or only tables below it that have one (`section` is None)."""

    section: Section | None
    below: dict[str, _Table | list[_Table]] = field(default_factory=dict)

    def sections(self) -> list[Section]:
        """Its section, and all below it."""
        found = [] if self.section is None else [self.section]
        for child in self.below.values():
            for table in child if isinstance(child, list) else [child]:
                found += table.sections()
        return found


_GONE: Final = object()


class _Editor:
    """Changes a tree in place: each method makes a part of it read as `new`, which now reads as `old`."""

    def __init__(self, syntax: TomlSyntax) -> None:
        self.syntax = syntax
        self._newline = syntax.newline
        self._values = ValueEditor(syntax.newline)
        self.root = _Table(syntax.sections[0])
        for section in syntax.sections[1:]:
            at = self.root
            for name in section.names[:-1]:
                child = at.below.setdefault(name, _Table(None))
                at = child[-1] if isinstance(child, list) else child
            name = section.names[-1]
            if section.is_array:
                listed = at.below.setdefault(name, [])
                assert isinstance(listed, list), "tomllib has refused a table that is an array as well"
                listed.append(_Table(section))
            else:
                child = at.below.setdefault(name, _Table(section))
                assert isinstance(child, _Table), "the same"
                child.section = section

    @property
    def notes(self) -> list[str]:
        """Sentences on what could not be kept."""
        return self._values.notes

    def table(self, table: _Table, old: Table, new: Table, names: Names) -> None:
        """Edit a table at `names`: the tables below it, and its own pairs."""
        pairs_old, pairs_new = dict(old), dict(new)
        for name in list(table.below):
            if self._below(table, name, old[name], new.get(name, _GONE), (*names, name)):
                del pairs_new[name]
            del pairs_old[name]
        if same(pairs_old, pairs_new):
            return
        if table.section is None:
            raise NotEditedError
        if table is self.root:
            for name in [name for name in pairs_new if name not in pairs_old]:
                if isinstance(pairs_new[name], Mapping) or is_tables(pairs_new[name]):
                    self._append_sections((name,), pairs_new.pop(name))
        self._values.pairs(table.section, (), pairs_old, pairs_new)

    def _below(self, table: _Table, name: str, old: Any, new: Any, names: Names) -> bool:
        """Edit what has headers below a table; whether it reads as `new` then, and is not just gone."""
        if same(old, new):
            return True
        if table.section is not None and any(item.names[0] == name for item in table.section.items):
            raise NotEditedError  # by dotted keys there, and by headers
        child = table.below[name]
        if isinstance(child, list) and is_tables(new):
            self._tables(child, old, new, names)
            return True
        if isinstance(child, _Table) and isinstance(new, Mapping):
            self.table(child, old, new, names)
            return True
        for each in child if isinstance(child, list) else [child]:
            for section in each.sections():
                self._remove_section(section)
        del table.below[name]
        if new is not _GONE:
            self.notes.append(REWRITTEN)
        return False

    def _tables(self, tables: list[_Table], old: Sequence[Table], new: Sequence[Table], names: Names) -> None:
        """Edit an array of tables."""
        match = matched(old, new)
        kept = [i for i in match if i is not None]
        if kept != sorted(kept):
            blocks = {i: self._block(tables[i]) for i in kept}
            if not all(blocks.values()):
                raise NotEditedError  # an element that has others between its parts is not moved
            self._permute([blocks[i] for i in sorted(kept)], [blocks[i] for i in kept])
        for gone in set(range(len(old))) - set(kept):
            for section in tables[gone].sections():
                self._remove_section(section)
        made = [_Table(None) if i is None else tables[i] for i in match]
        for table, i, value in zip(made, match, new, strict=True):
            if i is not None and not same(old[i], value):
                self.table(table, old[i], value, names)
        tables[:] = made
        for j, i in enumerate(match):
            if i is None:
                section = self._made_sections(names, [new[j]])[0]
                self._place(section, made[:j], made[j + 1 :])
                made[j].section = section

    def _place(self, section: Section, before: Sequence[_Table], after: Sequence[_Table]) -> None:
        """Put a new section behind those of the tables before it, or above those of the tables after it."""
        sections = self.syntax.sections
        if before:
            at = max(map(sections.index, before[-1].sections())) + 1
        else:
            places = [sections.index(each) for table in after for each in table.sections()]
            at = min(places, default=len(sections))
            if places:  # comments that stand apart stay above what comes first
                section.gap, sections[at].gap = sections[at].gap, section.gap
        if at == len(sections):
            self._end_line()
        sections.insert(at, section)

    def _block(self, table: _Table) -> list[Section]:
        """The sections of an element of an array of tables in their order; none where others stand between them."""
        sections = self.syntax.sections
        places = sorted(map(sections.index, table.sections()))
        return [sections[k] for k in places] if places[-1] - places[0] == len(places) - 1 else []

    def _permute(self, places: list[list[Section]], blocks: list[list[Section]]) -> None:
        """Put other blocks into the places of blocks; the gaps above them stay where they are."""
        self._end_line()
        sections = self.syntax.sections
        starts = [sections.index(place[0]) for place in places]
        gaps = [place[0].gap for place in places]
        for start, place, block, gap in reversed(list(zip(starts, places, blocks, gaps, strict=True))):
            block[0].gap = gap
            sections[start : start + len(place)] = block

    def _made_sections(self, names: Names, values: Sequence[Table] | Table) -> list[Section]:
        """New sections at `names`: of a table, or of each table in a list, with a blank line above."""
        path = ".".join(map(toml_key, names))
        header = f"[{path}]" if isinstance(values, Mapping) else f"[[{path}]]"
        texts = [
            "".join(("\n", header, "\n", *(f"{toml_pair(*pair)}\n" for pair in table.items())))
            for table in ([values] if isinstance(values, Mapping) else values)
        ]
        return syntax_of("".join(texts).replace("\n", self._newline)).sections[1:]

    def _append_sections(self, names: Names, values: Sequence[Table] | Table) -> None:
        """Add a new table, or array of tables, below all others."""
        self._end_line()
        self.syntax.sections += self._made_sections(names, values)

    def _end_line(self) -> None:
        """End the last line of the sections, that others can come below."""
        last = self.syntax.sections[-1]
        text = "".join(last.pieces())
        if text and not text.endswith("\n"):
            last.end += self._newline

    def _remove_section(self, section: Section) -> None:
        """Remove a section with its comments; those in the gap above it stay."""
        sections = self.syntax.sections
        k = sections.index(section)
        del sections[k]
        if has_comment(section.gap):
            apart = section.gap.rstrip() + self._newline
            if k < len(sections):
                sections[k].gap = apart + (sections[k].gap or self._newline)
            else:
                self.syntax.end = apart + self.syntax.end
