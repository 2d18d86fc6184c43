"""From the bytes of a DXF file to ezdxf's document, mended where programs leave out what holds no drawing."""

from __future__ import annotations

import io
import logging
import re
from collections.abc import Iterator, Mapping
from itertools import chain
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from voronoi_tiles.formats.dxf.mending import Tag, TagMender
from voronoi_tiles.formats.shapes import DXF_BYTES_MAX, ELEMENTS_MAX, DrawingError

if TYPE_CHECKING:
    from ezdxf.document import Drawing

REMEDY: Final = "Save it again as DXF (R2000 or newer) in the program that made it."
"""What helps with most broken files."""

_BINARY: Final = b"AutoCAD Binary DXF"
_HEAD: Final = 2**20  # bytes that are searched for the two
_ACADVER: Final = re.compile(r"\$ACADVER\s*\n\s*1\s*\n\s*(\S+)")
_DWGCODEPAGE: Final = re.compile(r"\$DWGCODEPAGE\s*\n\s*3\s*\n\s*(\S+)")
_LOST: Final = re.compile(r"^(?:Removed|Deleted) entity|floating point|integer value")
_FLAWS_SHOWN: Final = 3


class LoadedDxf(NamedTuple):
    """A document, the header variables that the file states itself, and what was mended, in sentences."""

    document: Drawing
    stated: Mapping[str, str]
    remarks: tuple[str, ...]


def load_dxf(data: bytes) -> LoadedDxf:
    """Load a DXF file, text or binary. Raises DrawingError for what is none, is beyond the limits or cannot be mended.

    Others' errors come out as they are.
    """
    # Without a handler of its own, ezdxf's warnings would go to standard error.
    log = logging.getLogger("ezdxf")
    if not log.handlers:
        log.addHandler(logging.NullHandler())
    if not data.strip():
        raise DrawingError("the file is empty", remedy=REMEDY)
    if data.startswith(b"AC10"):
        raise DrawingError("a DWG file, not DXF", remedy=REMEDY)
    if len(data) > DXF_BYTES_MAX:
        raise DrawingError(f"larger than {DXF_BYTES_MAX >> 20} MiB", remedy="Split the drawing.")
    remarks: list[str] = []
    text = None if data.startswith(_BINARY) else _text(data, remarks)
    try:
        mender = TagMender()
        document = _document(mender.mended(_tags(data, text)))
    except DrawingError:
        raise
    except Exception as error:  # noqa: BLE001 - ezdxf raises what its parts raise, whatever that is
        mender = TagMender()
        try:
            document, lost = _recovered(mender.mended(_tags(data, text), again=True))
        except DrawingError:
            raise
        except Exception:  # noqa: BLE001 - the same
            # What ezdxf said first is about the file as it is.
            raise error from None
        remarks.append(f"the file is broken ({reason_of(error)}), and was read by ezdxf's recovery{lost}")
    if "ENTITIES" not in mender.sections:
        raise DrawingError("no DXF file: it has no section ENTITIES", remedy=REMEDY)
    return LoadedDxf(document, mender.stated, (*remarks, *mender.remarks))


def entity_count(data: bytes) -> int:
    """How many entities, and table entries, the text of a DXF file has: they are the values of group code 0.

    Counted before they are parsed, which takes thousands of times as long. Codes and values take turns, a line each.
    """
    text = np.frombuffer(data, np.uint8)
    begins = np.append(0, np.flatnonzero(text[:-1] == ord("\n")) + 1)
    # A code is 0 however it is written: " 0", "00".
    zero = np.logical_or.reduceat(text == ord("0"), begins)[::2]
    more = np.logical_or.reduceat((text >= ord("1")) & (text <= ord("9")), begins)[::2]
    return int(np.count_nonzero(zero & ~more))


def reason_of(error: Exception) -> str:
    """What went wrong, in the words of others, shortened."""
    text = " ".join(str(error).split()).rstrip(".")
    name = type(error).__name__
    return text[:200] if text.startswith(name) else f"{name}{': ' if text else ''}{text[:200]}"


def _refuse_many(count: int) -> None:
    if count > ELEMENTS_MAX:
        raise DrawingError(f"more than {ELEMENTS_MAX:,} entities", remedy="Split the drawing.")


def _text(data: bytes, remarks: list[str]) -> str:
    """The text from its first tag on, its lines ended as on Unix.

    Raises DrawingError for what is no text, and for too many entities.
    """
    encoding = None
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        remarks.append("the file is UTF-16 text, which is not usual in DXF")
        data, encoding = data.decode("utf-16", errors="replace").encode(), "utf-8"
    elif data.startswith(b"\xef\xbb\xbf"):
        remarks.append("the file begins with a byte order mark, which is not usual in DXF")
        data, encoding = data.removeprefix(b"\xef\xbb\xbf"), "utf-8"
    if b"\x00" in data[:4096]:
        raise DrawingError("not a DXF file: it holds binary data", remedy=REMEDY)
    data = data.rstrip(b"\x1a")  # the end of a file on old systems
    # Without any \n, lines end as on old Macs; \r\r\n comes of a conversion done twice.
    data = data.replace(b"\r\r\n", b"\n").replace(b"\r\n", b"\n") if b"\n" in data else data.replace(b"\r", b"\n")
    start = re.match(rb"(?:[ \t]*\n)+", data)
    if start is not None:
        remarks.append("the file begins with empty lines, which are not usual in DXF")
        data = data[start.end() :]
    _refuse_many(entity_count(data))
    return data.decode(encoding or _encoding(data), errors="surrogateescape")


def _encoding(data: bytes) -> str:
    """The encoding that the header of a text names; UTF-8 from R2007 on."""
    from ezdxf.tools.codepage import toencoding

    head = data[:_HEAD].decode("latin-1")
    version, codepage = (found and found[1] for found in (_ACADVER.search(head), _DWGCODEPAGE.search(head)))
    return "utf-8" if version and version >= "AC1021" else toencoding(codepage or "ANSI_1252")


def _tags(data: bytes, text: str | None) -> Iterator[Any]:
    """The tags of a file; `text` is None for a binary one, whose entities are counted as they come."""
    from ezdxf.lldxf.tagger import ascii_tags_loader, binary_tags_loader

    if text is not None:
        yield from ascii_tags_loader(io.StringIO(text))
        return
    count = 0
    for tag in binary_tags_loader(data):
        count += tag.code == 0
        if count > ELEMENTS_MAX:
            _refuse_many(count)
        if tag.code != 999:
            yield tag


def _document(tags: Iterator[Tag]) -> Drawing:
    from ezdxf.document import Drawing

    return Drawing.load(tags)  # type: ignore[arg-type]


def _recovered(tags: Iterator[Tag]) -> tuple[Drawing, str]:
    """The document as ezdxf recovers it, and what was lost. Raises DrawingError where that are numbers."""
    from ezdxf import recover

    document, auditor = recover.read(io.BytesIO(b"".join(_written(tags))))
    flaws = [entry.message for entry in chain(auditor.errors, auditor.fixes)]
    broken = [flaw for flaw in flaws if "floating point" in flaw]
    if broken:
        raise DrawingError(f"broken DXF: {broken[0].removeprefix('recovered ')[:200]}", remedy=REMEDY)
    lost = [flaw for flaw in flaws if _LOST.search(flaw)]
    shown = "; ".join(flaw.rstrip(".")[:100] for flaw in lost[:_FLAWS_SHOWN])
    more = f", and {len(lost) - _FLAWS_SHOWN:,} more" if len(lost) > _FLAWS_SHOWN else ""
    return document, f": {shown}{more}" if shown else ""


def _written(tags: Iterator[Tag]) -> Iterator[bytes]:
    """The tags as text for the recovery: a handle that was there before is dropped, as its entity would be."""
    handles: set[str] = set()
    for code, value in tags:
        text = value.hex().upper() if isinstance(value, bytes) else str(value)
        if code == 5:
            key = text.strip().upper()
            if key in handles:
                continue
            handles.add(key)
        ascii_text = re.sub(r"[^\x00-\x7f]", lambda found: f"\\U+{ord(found[0]) & 0xFFFF:04X}", text)
        yield f"{code}\n{ascii_text}\n".encode()
