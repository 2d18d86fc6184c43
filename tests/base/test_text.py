"""Texts for people."""

from __future__ import annotations

import re
import sys
from xml.etree import ElementTree as ET
from xml.sax.saxutils import quoteattr

import pytest

from voronoi_tiles.base.text import counted, xml_attribute, xml_text


@pytest.mark.parametrize(
    ("count", "nouns", "text"),
    [
        (1, ("error",), "1 error"),
        (0, ("error",), "0 errors"),
        (2_000, ("error",), "2,000 errors"),
        (1, ("copy", "copies"), "1 copy"),
        (12, ("copy", "copies"), "12 copies"),
    ],
)
def test_a_count_has_its_noun(count: int, nouns: tuple[str, ...], text: str) -> None:
    """One is one, and all others are many."""
    assert counted(count, *nouns) == text


@pytest.mark.parametrize(
    "text", ["", "plain", 'say "so"', "it's", '"it\'s"', "<a & b>", "one\ttwo\nthree\r", "\x00\ud800"]
)
def test_an_attribute_of_xml_is_read_as_it_was(text: str) -> None:
    """It is written as the standard library writes it, and what XML cannot carry is replaced."""
    written = xml_attribute(text)
    assert written == quoteattr(xml_text(text))
    assert ET.fromstring(f"<a b={written}/>").get("b") == re.sub("[\x00\ud800]", "\ufffd", text)


def test_the_characters_of_xml_stay() -> None:
    """All characters of XML 1.0, and no others: its own grammar is the judge."""
    everything = "".join(map(chr, (*range(0x11000), sys.maxunicode)))
    grammar = re.compile("[\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
    assert xml_text(everything) == "".join(sign if grammar.match(sign) else "\ufffd" for sign in everything)
