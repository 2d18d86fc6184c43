"""The file of the studio's design: read, edited in its own layout, saved without ever overwriting anybody's work.

What is answered goes to the page as it is: tables in the types of JSON.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import Any, Final, TypeAlias

from voronoi_tiles.base.documents import document_text
from voronoi_tiles.base.errors import DesignError, OutputError, why_not_opened
from voronoi_tiles.base.files import is_special, write_whole, writing
from voronoi_tiles.base.tolerance import FILE_BYTES_MAX
from voronoi_tiles.base.values import shown
from voronoi_tiles.designs.load import STARTER, parse, refuse_drawing
from voronoi_tiles.designs.starters import GROUP_NAMES, starter_text, with_group_comments
from voronoi_tiles.studio.design_parts import require_parts
from voronoi_tiles.studio.design_text import form_of, json_text
from voronoi_tiles.studio.matching import json_form, merged, same
from voronoi_tiles.studio.recovery import Recovery, RecoveryCopy
from voronoi_tiles.studio.toml_edit import edited, written

NEW: Final = "design.toml"
"""What a design is called that has no name yet; design-2.toml where that is taken."""

_GROUP: Final = "p4"
_NAME: Final = re.compile(r"""[^./\\:*?"<>|][^/\\:*?"<>|]{0,99}""")
"""The name of a file in a folder, on any system; hidden ones are left to those who know how."""

SAVES_MAX: Final = 20
"""How many texts of saves are remembered, so that one that undo leads back to is saved as it was; a count."""

_BOM: Final = b"\xef\xbb\xbf"


class _ChangedError(Exception):
    """The file has become another one while it was being saved."""


_Disk: TypeAlias = bytes | str | None
"""What is on disk: the bytes of the file, None where there is none, and why it cannot be read where it cannot."""


class Document:
    """A design file that is open in a studio; one call at a time.

    `path` and `folder` are absolute, `name` is the file's without its suffix. The file need not be there: then it is a
    starter, which the first save writes.
    """

    def __init__(self, path: str) -> None:
        """Open a file. Raises DesignError where it cannot be read, or is no design at all."""
        if path == "-":
            raise DesignError("standard input cannot be saved", file=path, remedy="Name a TOML or JSON file.")
        self.path = os.path.abspath(path)  # noqa: PTH100 - any name
        self.folder = os.path.dirname(self.path)  # noqa: PTH120 - same
        self.name = Path(path).stem or "design"
        self._shown = path
        self._look = self._state()
        self._known = self._read()
        self._recovery = Recovery(self.path)
        try:
            self._design, self._text = self._parsed(self._known)
        except DesignError as error:
            copies = self._recovery.found()
            self._recovery.close()
            if not copies:
                raise
            remedy = f"{error.remedy} Move it away to have what was drawn until {copies[0].when} and not saved."
            raise DesignError(error.message, file=error.file, key=error.key, line=error.line, remedy=remedy) from error
        self._saves: list[tuple[Mapping[str, Any], str]] = []  # designs and texts before the last save, none of others
        self._seen: _Disk = self._known  # what is on disk, as the page knows
        self._doubtful = False  # whether what is there may be half saved

    @classmethod
    def open(cls, path: str | None, *, folder: str = os.curdir) -> Document:
        """Open a design file, or for None a starter under a free name in a folder. Raises DesignError."""
        if path is not None:
            if not Path(path).parent.is_dir():  # what is drawn could not be saved
                raise DesignError("cannot be made: its folder is not there", file=path, remedy="Look at the path.")
            return cls(path)
        for free in _numbered(os.path.join(folder, NEW) if folder != os.curdir else NEW):  # noqa: PTH118 - any name
            if os.path.lexists(free):
                continue
            document = cls(free)
            if not document._recovery.holder:
                return document
            document.close()  # another studio has a new design of this name
        raise AssertionError("numbers do not end")

    def beside(self, name: str) -> Document:
        """A starter in the same folder, under a name that no file has: for "" the next one that is free.

        The suffix may be left out. Raises DesignError where the name is none, or taken.
        """
        folder, name = os.path.dirname(self._shown), name.strip()  # noqa: PTH120 - any name
        if not name:
            return Document.open(None, folder=folder or os.curdir)
        file = name if name.lower().endswith((".toml", ".json")) else f"{name}.toml"
        if not (_NAME.fullmatch(file) and file.isprintable()):
            raise DesignError("is no name of a file", file=shown(name), remedy="Give a short one without / and :.")
        path = os.path.join(folder, file)  # noqa: PTH118 - same
        if not os.path.lexists(path):
            document = Document(path)
            if not document._recovery.holder:
                return document
            document.close()  # a studio, this one it may be, has a new design of this name
            what = "is the name of a design that a studio has open"
        else:
            what = "is there already"
        raise DesignError(what, file=path, remedy="Give the new design another name.")

    def opened(self, *, recover: bool = True) -> dict[str, Any]:
        """The design as it is in the file now, which counts as read: what a page that opens is told.

        A recovery copy is offered where it is newer than the file and says something else, unless `recover` is false.
        Raises DesignError, after which nothing has changed.
        """
        look = self._state()  # before it is read: what is saved meanwhile is not missed
        known = self._read()
        design, text = self._parsed(known)
        if text != self._text:
            self._saves.clear()
        self._known, self._design, self._text = known, design, text
        self._seen, self._look, self._doubtful = known, look, False
        answer: dict[str, Any] = {
            "file": self._shown,
            "folder": self.folder,
            "design": json_form(design),
            "saved": known is not None,
        }
        copies = self._recovery.found()
        notes = self._opening_notes()
        if notes:
            answer["note"] = " ".join(notes)
        if recover:
            copy = next((copy for copy in copies if self._is_news(copy)), None)
            if copy is not None:
                answer["recovery"] = {"design": copy.design, "at": copy.when}
        return answer

    def reload(self) -> dict[str, Any]:
        """The design as it is in the file now, in the place of what the page has. Raises DesignError."""
        return self.opened(recover=False)

    def save(self, design: Mapping[str, Any], over: bool = False) -> dict[str, Any]:
        """Save a design: the file is whole, as it was or as it is to be, whatever happens.

        Where it has become another one since it was read or written last, that is answered, and nothing is done;
        with `over` what is there is kept as a backup beside it. Raises DesignError, OutputError.
        """
        there = self._there()
        backup = None
        if there != self._known:
            theirs = self._theirs(there)
            if isinstance(there, bytes) and theirs and any(same(theirs[0], ours) for ours in (self._design, design)):
                # They have changed comments alone, or have made the same change.
                self._known, (self._design, self._text) = there, theirs
                self._saves.clear()
            elif not over:
                self._seen = there
                return {"type": "conflict", **self._change(there)}
            elif isinstance(there, str):
                raise OutputError(f"cannot save over what is there: {there.rstrip('.')}", self.path)
            elif there is not None:
                backup = self._back_up(there)
        text, notes = self._written(design)
        data = text.encode()
        if self._known is not None and self._known.startswith(_BOM):
            data = _BOM + data
        if data != there and not self._replaced(there, data):
            return self.save(design, over)
        self._known = self._seen = data
        if text != self._text:
            self._saves = [*self._saves[1 - SAVES_MAX :], (self._design, self._text)]
        self._design, self._text = design, text
        self._recovery.forget()
        if backup is not None:
            notes = (*notes, f"What was there is kept as {os.path.basename(backup)}.")  # noqa: PTH119 - any name
        answer = {"type": "saved", "file": self._shown}
        return {**answer, "note": " ".join(notes)} if notes else answer

    def note(self, design: Mapping[str, Any]) -> None:
        """Keep a recovery copy of a design that is not saved. Raises OutputError where that cannot be written."""
        if same(self._design, design):
            self._recovery.drop()
        else:
            self._recovery.write(design, next(iter(self._state()), None))

    def check_kept(self, design: Mapping[str, Any]) -> None:
        """Refuse to leave a design that is neither saved nor noted. Raises OutputError."""
        if self._recovery.trouble and not same(self._design, design):
            raise OutputError(
                f"{self._shown} is not saved, and no copy of it can be kept: {self._recovery.trouble}",
                remedy="Save it first, or download it under Share.",
            )

    def changed(self) -> dict[str, Any] | None:
        """What another program has made of the file, once for each change; None where there is nothing new.

        What is gone, empty or broken may be half saved: that is said when it is the same at the next call.
        """
        look = self._state()
        settled, self._look = look == self._look, look
        if settled and not self._doubtful:
            return None
        there = self._there()
        if there in (self._seen, self._known):
            self._seen, self._doubtful = there, False
            return None
        theirs = self._theirs(there)
        if theirs is None and not (settled and self._doubtful):
            self._doubtful = True
            return None
        self._seen, self._doubtful = there, False
        if theirs is not None and same(theirs[0], self._design):
            return None
        return self._change(there)

    def toml(self, design: Mapping[str, Any]) -> str:
        """A design as the text of a TOML file: this one where it is TOML, edited. Raises DesignError."""
        return self._edited(design)[0] if self._is_toml else written(design)

    def close(self) -> None:
        """Let others have the file. A recovery copy stays: what was not saved is found again."""
        self._recovery.close()

    # The file

    @property
    def _is_toml(self) -> bool:
        """Whether the file is, or is to be, TOML."""
        return form_of(self.path, self._text) == "toml"

    def _state(self) -> tuple[int, ...]:
        """What changes when the file does; empty where there is none."""
        try:
            status = os.stat(self.path)  # noqa: PTH116 - any name
        except (OSError, ValueError):
            return ()
        return status.st_mtime_ns, status.st_ctime_ns, status.st_size, status.st_ino

    def _read(self) -> bytes | None:
        """The bytes of the file, None where there is none. Raises DesignError where it cannot be read."""
        refuse_drawing(self.path, self._shown)
        if is_special(self.path):  # to read a pipe could take for ever
            raise DesignError("is a pipe or a device", file=self._shown, remedy="Name a TOML or JSON file.")
        try:
            with open(self.path, "rb", opener=_without_waiting) as stream:
                return stream.read(FILE_BYTES_MAX + 1) or b""  # a pipe that has come meanwhile has nothing
        except FileNotFoundError:
            return None
        except (OSError, ValueError) as error:
            why = why_not_opened(self.path, error)
            raise DesignError(
                f"cannot read the design: {why}", file=self._shown, remedy="Check the path and its permissions."
            ) from None

    def _parsed(self, data: bytes | None) -> tuple[Mapping[str, Any], str]:
        """The design of the file's bytes, and its text; those of a starter where there is none. Raises DesignError."""
        if data is None:
            text = starter_text(_GROUP, self._shown)
            design = parse(text, "toml", self._shown)
            return design, text if form_of(self.path, "") == "toml" else json_text(design)
        try:
            text = document_text(data, "design", remedy=STARTER)
        except DesignError as error:
            raise error.with_file(self._shown) from None
        form = form_of(self.path, text)
        if not text.strip():
            raise DesignError("is empty", file=self._shown, remedy=STARTER)
        try:
            design = require_parts(parse(text, form, self._shown))
        except DesignError as error:
            raise error.with_file(self._shown) from None
        return design, text

    def _there(self) -> _Disk:
        """What is on disk now."""
        try:
            return self._read()
        except DesignError as error:
            return str(error)

    def _theirs(self, there: _Disk) -> tuple[Mapping[str, Any], str] | None:
        """The design that another program has put there, and its text; None where there is none."""
        try:
            return self._parsed(there) if isinstance(there, bytes) else None
        except DesignError:
            return None

    def _change(self, there: _Disk) -> dict[str, Any]:
        """What there is to say of a file that has become another one."""
        design = None
        note = f"{self._shown} was changed by another program."
        if there is None:
            note = f"{self._shown} was removed, or renamed, by another program. Save to write it again."
        else:
            try:
                if isinstance(there, bytes):
                    design = json_form(self._parsed(there)[0])
            except DesignError as error:
                there = str(error)
            if isinstance(there, str):
                note = f"What another program has left is no design: {there}"
        return {"design": design, "file": self._shown, "note": note}

    def _written(self, design: Mapping[str, Any]) -> tuple[str, tuple[str, ...]]:
        """The text of the file that says a design, with what could not be kept of it. Raises DesignError.

        Where undo has led back to what was saved before, that is it: comments and spelling of what had been removed
        since are there again.
        """
        if not same(self._design, design):
            for before, text in reversed(self._saves):
                if same(before, design):
                    return text, ()
        if self._is_toml:
            return self._edited(design)
        return self._text if same(self._design, design) else json_text(merged(self._design, design), self._text), ()

    def _edited(self, design: Mapping[str, Any]) -> tuple[str, tuple[str, ...]]:
        """The text of the TOML file that says a design, as `_written`; a starter's comments on its group stay true."""
        text, notes = edited(self._text, design)
        group = design.get("group")
        if group in GROUP_NAMES and group != self._design.get("group"):
            text = with_group_comments(text, group)
        return text, notes

    def _replaced(self, there: _Disk, data: bytes) -> bool:
        """Write the file, if there is still what was there; whether it was. Raises OutputError."""
        with suppress(_ChangedError), writing(self.path) as file:
            file.write(data)
            if self._there() != there:
                raise _ChangedError
            return True
        return False

    def _back_up(self, data: bytes) -> str:
        """Keep what another program has written beside the file; the path. Raises OutputError."""
        path = Path(self.path)
        for free in _numbered(str(path.with_stem(f"{path.stem}-backup"))):
            if not os.path.lexists(free):
                write_whole(free, data)
                return free
        raise AssertionError("numbers do not end")

    def _is_news(self, copy: RecoveryCopy) -> bool:
        """Whether a copy is newer than the file, and says something else.

        Clocks are set back: a file that is as old as it was when the copy was written has not changed since.
        """
        written_at = next(iter(self._state()), None)
        newer = written_at is None or copy.of == written_at or copy.at * 1e9 > written_at
        return newer and not same(self._design, copy.design)

    def _opening_notes(self) -> list[str]:
        """What there is to say when a design is opened."""
        notes = []
        if self._known is None:
            notes.append(f"There is no {self._shown} yet: this is a design to start from, which the first save writes.")
        if self._recovery.holder:
            notes.append(
                f"Another studio has {self._shown} open ({self._recovery.holder}). "
                "Close one of them: what one saves is a change from outside to the other."
            )
        if self._recovery.trouble:
            notes.append(f"No recovery copies can be kept ({self._recovery.trouble}): save often.")
        return notes


def _without_waiting(path: str, flags: int) -> int:
    """Open a file, and never wait for the other end of a pipe."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _numbered(path: str) -> Iterator[str]:
    """A name and those with a number: design.toml, design-2.toml, ..."""
    yield path
    for number in count(2):
        yield str(Path(path).with_stem(f"{Path(path).stem}-{number}"))
