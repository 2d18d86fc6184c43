"""Mending the structure of a DXF file, tag by tag, before ezdxf sees it, and keeping what the file itself states.

ezdxf reads files as CAD programs write them. Scripts, and programs that are not CAD, leave out what holds no drawing:
the ends of sections and of the file, the markers of subclasses, the end of a polyline. All of it can be put back. What
an entity needs and has not, ezdxf would fill in: a circle without a radius gets one of 1. Such an entity is renamed,
and so counted as what is not read.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import Any, Final, NamedTuple

from voronoi_tiles.base.text import counted
from voronoi_tiles.formats.dxf.drawing_unit import HEADER_VARIABLES
from voronoi_tiles.formats.shapes import DrawingError

COUNTED: Final = " (only counted)"
"""What the names of entities end on that are not taken apart."""


class Tag(NamedTuple):
    """A group code and its value: a text, or of a binary file a number or bytes."""

    code: int
    value: Any


class SecondSection(Exception):  # noqa: N818 - it is no error, but a reason to read in another way
    """A section that was there before; ezdxf would keep the last one alone."""


_ONCE: Final = frozenset({"HEADER", "TABLES", "BLOCKS", "ENTITIES"})

_NEEDED: Final[dict[str, dict[int, str]]] = {
    "LINE": {10: "beginning", 20: "beginning", 11: "end", 21: "end"},
    "CIRCLE": {10: "centre", 20: "centre", 40: "radius"},
    "ARC": {10: "centre", 20: "centre", 40: "radius", 50: "angles", 51: "angles"},
    "ELLIPSE": {10: "centre", 20: "centre", 11: "axis", 21: "axis", 40: "ratio", 41: "angles", 42: "angles"},
    "SPLINE": {71: "degree"},
    "INSERT": {2: "block", 10: "place", 20: "place"},
}
"""The group codes that an entity cannot be drawn without, and what they hold."""

_KNOWN: Final = frozenset(
    {*_NEEDED, "LWPOLYLINE", "POLYLINE", "VERTEX", "SEQEND", "ATTRIB", "ATTDEF", "BLOCK", "ENDBLK"}
)
"""What ezdxf takes apart. All else is only counted, whatever it holds."""

_POINTS: Final = frozenset({*_NEEDED, "LWPOLYLINE"})
"""Where each x has its y: ezdxf's recovery would leave out an x that has none."""

_SUBCLASSES: Final = {"LWPOLYLINE": "AcDbPolyline", "SPLINE": "AcDbSpline"}
"""The subclass of what ezdxf does not read without its markers; R12 has none."""

_VERSION: Final = (Tag(9, "$ACADVER"), Tag(1, "AC1015"))
"""What older files are said to be, and those that do not say. As R12 ezdxf would lose the layers, colours and flags of
LWPOLYLINE and SPLINE, which R12 had not, and which scripts write all the same."""

_MARKER: Final = 100
_COMMON: Final = frozenset({5, 6, 8, 48, 60, 62, 67, 330, 347, 370, 390, 410, 420, 430, 440})
"""The group codes of the first subclass of all entities."""


class TagMender:
    """Hands on the tags of a file, its structure mended.

    Afterwards `stated` has the text of each of HEADER_VARIABLES that the header states, `remarks` what was mended, in
    sentences, and `sections` the names of all sections.
    """

    def __init__(self) -> None:
        self.stated: dict[str, str] = {}
        self.sections: set[str] = set()
        self._mended: Counter[tuple[str, str]] = Counter()  # by what is counted, "" for nothing, and what was wrong
        self._section: str | None = None
        self._open = ""  # the entity whose parts follow, up to a SEQEND

    @property
    def remarks(self) -> tuple[str, ...]:
        """What was mended, in the order in which it was found."""
        return tuple(f"{counted(count, noun)} {text}" if noun else text for (noun, text), count in self._mended.items())

    def mended(self, tags: Iterable[Any], *, again: bool = False) -> Iterator[Tag]:
        """The tags, mended. Raises SecondSection, but not where sections may come `again`."""
        ended = False
        yield from (Tag(0, "SECTION"), Tag(2, "HEADER"), *_VERSION, Tag(0, "ENDSEC"))
        for entity in _entities(tags):
            name = str(entity[0].value).strip().upper()
            if self._open and name not in {"VERTEX", "ATTRIB", "SEQEND"}:
                self._mended["polyline", "did not end (no SEQEND)"] += 1
                self._open = ""
                yield Tag(0, "SEQEND")
            if name == "SECTION":
                yield from self._begun(entity, again=again)
            elif name == "ENDSEC":
                if self._section is not None:
                    yield Tag(0, "ENDSEC")
                self._section = None
            elif name == "EOF":
                ended = True
                break
            else:
                if self._section is None:
                    self._mended["", "entities stood outside of all sections"] += 1
                    yield from self._begun([Tag(0, "SECTION"), Tag(2, "ENTITIES")], again=again)
                yield from self._entity(name, entity) if self._section in {"ENTITIES", "BLOCKS"} else entity
        if self._open:
            yield Tag(0, "SEQEND")
        yield from self._closed()
        if not ended:
            self._mended["", "the file has no end (no EOF): some of it may be missing"] += 1
        yield Tag(0, "EOF")

    def _begun(self, entity: list[Tag], *, again: bool) -> Iterator[Tag]:
        """Begin a section, and keep what a header states."""
        yield from self._closed()
        title = next((tag for tag in entity if tag.code == 2), Tag(2, ""))
        name = str(title.value).strip().upper()
        if name in self.sections & _ONCE and not again:
            raise SecondSection(f"a second section {name}")
        self.sections.add(name)
        self._section = name
        if name == "HEADER":
            for tag, value in pairwise(entity):
                if tag.code == 9 and str(tag.value).strip().upper() in HEADER_VARIABLES:
                    self.stated[str(tag.value).strip().upper()] = str(value.value)
        yield Tag(0, "SECTION")
        yield Tag(2, name)
        content = [tag for tag in entity[1:] if tag is not title]
        yield from _of_r2000(content) if name == "HEADER" else content

    def _closed(self) -> Iterator[Tag]:
        """End the section that is open."""
        if self._section is not None:
            self._mended["section", "did not end (no ENDSEC)"] += 1
            yield Tag(0, "ENDSEC")
        self._section = None

    def _entity(self, name: str, entity: list[Tag]) -> Iterable[Tag]:
        """An entity with what it is missing; renamed where nobody can add that, and bare where it is only counted."""
        codes = Counter(tag.code for tag in entity)
        missing = list(dict.fromkeys(what for code, what in _NEEDED.get(name, {}).items() if not codes[code]))
        if not missing and name in _POINTS and (codes[10] != codes[20] or codes[11] != codes[21]):
            missing = ["all coordinates"]
        common = [tag for tag in entity[1:] if tag.code in _COMMON]
        if name not in _KNOWN or missing:
            title = f"{name} without {' and '.join(missing)}" if missing else name[:40]
            return [Tag(0, f"{title}{COUNTED}"), Tag(_MARKER, "AcDbEntity"), *common]
        if name == "VERTEX" and not (codes[10] and codes[20]):
            raise DrawingError("a VERTEX has no place", remedy="Draw its polyline again.")
        if name == "SEQEND":
            self._open = ""
        elif name == "POLYLINE" or (name == "INSERT" and _says(entity, 66, 1)):
            self._open = name
        entity[0] = Tag(0, name)
        if codes[_MARKER] or name not in _SUBCLASSES:
            return entity
        self._mended["object", "had no subclass markers"] += 1
        own = [tag for tag in entity[1:] if tag.code not in _COMMON]
        return [entity[0], Tag(_MARKER, "AcDbEntity"), *common, Tag(_MARKER, _SUBCLASSES[name]), *own]


def _entities(tags: Iterable[Any]) -> Iterator[list[Any]]:
    """The tags of each entity, the first of which has the group code 0; what comes before the first is no entity."""
    entity: list[Any] = []
    for tag in tags:
        if tag.code == 0 and entity:
            if entity[0].code == 0:
                yield entity
            entity = []
        entity.append(tag)
    if entity and entity[0].code == 0:
        yield entity


def _of_r2000(header: list[Any]) -> Iterator[Any]:
    """The variables of a header, the version being R13 or newer, or else R2000."""
    version = next((value for tag, value in pairwise(header) if tag.code == 9 and tag.value == "$ACADVER"), None)
    if version is not None and str(version.value).strip() >= "AC1012":
        yield from header
        return
    yield from _VERSION
    yield from (tag for tag in header if tag is not version and not (tag.code == 9 and tag.value == "$ACADVER"))


def _says(entity: list[Any], code: int, value: int) -> bool:
    """Whether an entity has a group code with this whole number."""
    return any(tag.code == code and str(tag.value).strip() == str(value) for tag in entity)
