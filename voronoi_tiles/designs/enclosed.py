"""The groups in which the tile of a single site is the same polygon whatever is drawn, and what to say then."""

from __future__ import annotations

from typing import Final

ENCLOSED: Final = ("pmm", "p4m", "p3m1", "p6m")
"""The groups whose mirrors enclose one copy of a site in one piece."""


def enclosed_note(group: str) -> str:
    """A sentence on what the tile of a site in one of these groups is, without a full stop."""
    return (
        f"in {group} the tile of a single site is the polygon between the mirrors, whatever is drawn; "
        "in p1, p2, p3, p4, p6, pg and pgg it follows the drawing"
    )
