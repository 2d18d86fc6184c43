"""Texts of others: how numbers are written in them, and how they are made safe to show."""

from __future__ import annotations

import re
from typing import Final

NUMBER: Final = r"[+-]?+(?:[0-9]++(?:\.[0-9]*+)?+|\.[0-9]++)(?:[eE][+-]?+[0-9]++)?+"
"""A decimal number, as a regular expression without groups; it takes all digits there are, and no second look."""

# What is not among the characters of XML 1.0, section 2.2: listing the others would take 5 ms to compile.
_NOT_XML: Final = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


def printable(text: str) -> str:
    """Escape control characters, and bytes that are not UTF-8, as names of files may hold them."""

    def escaped(sign: str) -> str:
        # Python keeps the byte b of such a name as U+DC00 + b.
        return f"\\x{ord(sign) - 0xDC00:02x}" if "\udc80" <= sign <= "\udcff" else repr(sign)[1:-1]

    return "".join(sign if sign.isprintable() else escaped(sign) for sign in text)


def counted(count: int, one: str, many: str | None = None) -> str:
    """A count with its noun: "1 error", "0 errors", "2,000 copies"; the plural is that with an s unless it is given."""
    return f"{count:,} {one if count == 1 else many or f'{one}s'}"


def xml_text(text: str) -> str:
    """The text with what XML 1.0 cannot carry replaced."""
    return _NOT_XML.sub("\ufffd", text)


def xml_attribute(text: str) -> str:
    """The text as the value of an attribute of XML, with its quotes; what XML cannot carry is replaced."""
    from xml.sax.saxutils import quoteattr  # 15 ms: that module opens web addresses too

    return quoteattr(xml_text(text))
