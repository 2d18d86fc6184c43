"""Drawings of outlines, as people drop them onto the studio's page: SVG files, and such as have none."""

from __future__ import annotations

WIDTH, HEIGHT = 40.0, 30.0
"""Of the fish's outline; millimetres."""

EYE = (10.0, 19.0)
"""Where the fish's eye is, y up, the lower left corner of the outline's box at 0."""

_HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="50mm" viewBox="0 0 60 50">'
_FISH = "M 10 25 L 20 12 L 34 10 L 42 20 L 50 14 V 36 L 42 29 L 33 40 L 18 36 Z"

FISH = f"""{_HEAD}
<path d="{_FISH}" fill="#d8d8d8"/>
<circle cx="20" cy="21" r="1.5" fill="none" stroke="#ff0000"/></svg>
"""
"""A fish of nine corners with an eye."""

KITE = f'{_HEAD}<path d="M 30 6 L 48 22 L 38 26 L 30 44 L 22 26 L 12 22 Z"/></svg>'
"""An outline that is its own mirror image."""

OPEN = f'{_HEAD}<path d="{_FISH.removesuffix(" Z")}" fill="none" stroke="black"/></svg>'
CROSSING = f'{_HEAD}<path d="M 10 10 L 40 40 L 40 10 L 10 40 Z" stroke="black"/></svg>'
TWO = f'{_HEAD}<circle cx="15" cy="25" r="10"/><circle cx="45" cy="25" r="9"/></svg>'
PIXELS = b"\x89PNG\r\n\x1a\n" + bytes(20)

SEARCH_MS = 120_000
"""How long a search in a group may take: 3 s of a processor, which it leaves to others; milliseconds."""
