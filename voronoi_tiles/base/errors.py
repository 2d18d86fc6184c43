"""The errors of voronoi_tiles: one root, and leaves that carry what went wrong as data.

Every leaf also inherits the built-in error that a caller would expect (ValueError, ArithmeticError,
OSError), and `exit_code` is what the command line returns for it. Messages name arguments in backquotes, with the
value to give them where they advise one: "`kerf` needs `edges='pieces'`". The command line makes options of these.
"""

from __future__ import annotations

import os
import re
from typing import Any, ClassVar, Self


class VoronoiTilesError(Exception):
    """Root of all errors that voronoi_tiles raises on purpose; `str()` is one message for the user.

    `file` is the design's file where `str()` begins with it, else None.
    """

    exit_code: ClassVar[int] = 2
    file: str | None = None


_ARGUMENT = re.compile(r"`(\w+)(?:=[^`]*)?`")


class _ExplainedError(VoronoiTilesError):
    """What cannot be done: `message` says what is wrong, without a full stop; `remedy` is a sentence, or None."""

    def __init__(self, message: str, *, remedy: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.remedy = remedy

    def __str__(self) -> str:
        return f"{self.message}. {self.remedy}" if self.remedy else f"{self.message}."

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the arguments that the message is about, in its order."""
        return tuple(dict.fromkeys(_ARGUMENT.findall(self.message)))


class DesignError(_ExplainedError, ValueError):
    """A design, or a part of it, that cannot be used.

    `message` says what is wrong, without a full stop; `remedy` is a sentence that says what to write
    instead; `key` is the path of the key ("site[0].strokes[2].segment"); `line` counts from 1 and is None
    where the parser does not know it. `str()` joins them: "bird.toml, line 7, site[0].strokes[2].segment:
    <message>. <remedy>".
    """

    def __init__(
        self,
        message: str,
        *,
        file: str | None = None,
        key: str | None = None,
        line: int | None = None,
        remedy: str | None = None,
    ) -> None:
        super().__init__(message, remedy=remedy)
        self.file = file
        self.key = key
        self.line = line

    def __str__(self) -> str:
        line = None if self.line is None else f"line {self.line}"
        place = ", ".join(part for part in (self.file, line, self.key) if part)
        return f"{place}: {super().__str__()}" if place else super().__str__()

    def with_file(self, file: str | None) -> Self:
        """A copy of this error that names `file`; a file that is already named stays."""
        return type(self)(self.message, file=self.file or file, key=self.key, line=self.line, remedy=self.remedy)

    def with_key(self, key: str) -> Self:
        """A copy of this error that names another key."""
        return type(self)(self.message, file=self.file, key=key or None, line=self.line, remedy=self.remedy)

    def under(self, key: str) -> Self:
        """A copy of this error with `key` before its own: "segment[1]" under "site[0]" is "site[0].segment[1]"."""
        own = self.key or ""
        return self.with_key(f"{key}.{own}" if own and not own.startswith("[") else key + own)


class TouchingCopiesError(VoronoiTilesError, ValueError):
    """Two different copies of sites touch or cross, so that a region would belong to nobody.

    `site` is the site of the base cell, `other` the site whose image under `operation` touches it at `place`
    (in the units of the design). The operation is an Operation.
    """

    def __init__(self, site: str, other: str, operation: Any, place: complex, *, file: str | None = None) -> None:
        super().__init__(site, other, operation, place)
        self.site = site
        self.other = other
        self.operation = operation
        self.place = complex(place)
        self.file = file

    def __str__(self) -> str:
        place = f"({self.place.real:.6g}, {self.place.imag:.6g})"
        if self.site == self.other:
            what = f'site "{self.site}" touches its own copy under {self.operation} at {place}'
        else:
            what = f'site "{self.site}" touches the copy of site "{self.other}" under {self.operation} at {place}'
        text = f"{self.file}: {what}" if self.file else what
        return f"{text}. Move or shorten the strokes there, or make the cell larger: copies must keep apart."

    def with_file(self, file: str | None) -> Self:
        """A copy of this error that names `file`; a file that is already named stays."""
        return type(self)(self.site, self.other, self.operation, self.place, file=self.file or file)


class _ResultError(_ExplainedError, ArithmeticError):
    """A result that is not right; `report` has all figures."""

    exit_code: ClassVar[int] = 1

    def __init__(self, message: str, report: Any = None) -> None:
        super().__init__(message)
        self.report = report


class ProofError(_ResultError):
    """A result that failed its proof: `message`, without a full stop; `report` is the ProofReport with all figures."""


class CheckError(_ResultError):
    """A result that failed its cross-check: `message`, without a full stop; `report` is the CheckReport."""


class ArgumentError(_ExplainedError, ValueError):
    """An argument that cannot be; `message` and `remedy` are those of DesignError, `fields` names it."""


class UnknownNameError(_ExplainedError, KeyError):
    """A name that nothing has; `message` and `remedy` are those of DesignError."""


class MissingLibraryError(_ExplainedError, ImportError):
    """A library that is not installed, and needed; `message` and `remedy` are those of DesignError."""


class RenderError(_ExplainedError, RuntimeError):
    """An image that could not be rendered; `message` and `remedy` are those of DesignError."""

    exit_code: ClassVar[int] = 1


class SchedulerError(_ExplainedError, ConnectionError):
    """A scheduler of Dask's that cannot be used; `message` and `remedy` are those of DesignError."""


class OutputError(_ExplainedError, OSError):
    """A file that could not be written; `path` is the file, which is as it was before.

    `message` and `remedy` are those of DesignError.
    """

    def __init__(self, message: str, path: str | os.PathLike[str] | None = None, *, remedy: str | None = None) -> None:
        super().__init__(message, remedy=remedy)
        self.path = path


def why_not_opened(name: str, error: Exception) -> str:
    """The reason why a file could not be opened, read or written: the system's words, where it was asked."""
    if "\0" in name:
        return "its name has a null byte"  # Python's own words for that differ from version to version
    return getattr(error, "strerror", None) or str(error)
