"""The paper's sentences about groups, each with the measurement that it stands or falls with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from census import POINTS, Census

from voronoi_tiles.groups.wallpaper import GROUPS

ROUNDING = 1e-12
"""How far from its chamber, beside the cell's longer side, a tile may reach that lies in it: what outlines are off."""

WRONG = "**wrong**"
"""How a sentence that does not hold is marked."""


@dataclass(frozen=True)
class Verdict:
    """Whether a sentence holds in a group, and in a few words why."""

    holds: bool
    because: str


@dataclass(frozen=True)
class Claim:
    """A sentence of the paper in substance, the groups that it speaks of, and how it is judged.

    `condition` is what it needs beyond what it says, which the measured sites fulfil.
    """

    key: str
    sentence: str
    groups: tuple[str, ...]
    judge: Callable[[Census], Verdict]
    condition: str = ""


def fills_the_plane(found: Census) -> Verdict:
    """Judge "copies of the tile fill the plane": by the areas; that outlines close and do not cross is proved."""
    error = float(found.values("area_error").max())
    return Verdict(error <= ROUNDING, "the tiles of a cell add up to its area" if error <= ROUNDING else f"{error:.1e}")


def endless_lines_always(found: Census) -> Verdict:
    """Judge "always produces straight infinite lines"."""
    lines = found.values("endless")
    count, having = len(lines), int((lines > 0).sum())
    if having == count and not found.values("mirrors_missing").any():
        return Verdict(True, f"in all {count:,} tilings all mirrors are edges from end to end")
    return Verdict(False, f"{having:,} of {count:,} tilings have such a line; {found.mirrors} mirrors")


def copies_form(name: str) -> Callable[[Census], Verdict]:
    """Judge "copies of the tile form squares", or triangles: what the name of the polygon must contain."""

    def judge(found: Census) -> Verdict:
        if not fills_chamber(found):
            return Verdict(False, "the tiles form no polygon")
        kind = found.chamber.name
        return Verdict(name in kind, f"{found.in_chamber} tiles form one {kind} in all {len(found.tiles):,} tilings")

    return judge


def fills_chamber(found: Census) -> bool:
    """Whether all tiles lie in their chambers, and have a whole part of its area: then its copies there fill it."""
    many = found.in_chamber
    if not many:
        return False
    inside = bool(found.values("beyond").max() <= ROUNDING)
    return inside and bool(np.allclose(found.values("filling"), many, rtol=ROUNDING * many, atol=0.0))


def fixed_polygon(found: Census) -> Verdict:
    """Judge "the tile is a fixed polygon"."""
    if found.in_chamber == 1 and fills_chamber(found) and found.shapes == 1 and not found.values("curves").any():
        return Verdict(True, f"every tile is the same {found.chamber.name}")
    return Verdict(False, f"{found.shapes:,} shapes; {int((found.values('curves') > 0).sum()):,} tiles with curves")


def curved(found: Census) -> Verdict:
    """Judge "gives tiles with curved edges": for most sites, with no straight line that the group enforces."""
    lines, curves = found.values("endless"), found.values("curves")
    count, bent = len(lines), int((curves > 0).sum())
    because = f"{bent:,} of {count:,} tiles have curves, {int((lines > 0).sum()):,} tilings an endless straight line"
    return Verdict(not lines.any() and 2 * bent > count and found.survived == 0, because)


CLAIMS = (
    Claim("filling", "Copies of the tile fill the plane, in every group.", tuple(GROUPS), fills_the_plane),
    Claim(
        "curved",
        "Lines under p1, p2, pg, p4, p3 and p6 give tiles with curved edges.",
        ("p1", "p2", "pg", "p4", "p3", "p6"),
        curved,
    ),
    Claim(
        "endless",
        "The groups with mirrors, among which it lists pm, cm, pmg and pgg, always produce straight infinite lines.",
        ("pm", "cm", "pmg", "pgg", "cmm", "p4g", "p31m", "p4m", "pmm", "p3m1", "p6m"),
        endless_lines_always,
        "no site is its own mirror image",
    ),
    Claim(
        "squares",
        "Under cmm and p4g copies of the tile form squares.",
        ("cmm", "p4g"),
        copies_form("square"),
        "there is one site, and it lies in one chamber",
    ),
    Claim(
        "triangles",
        "Under p31m copies of the tile form triangles.",
        ("p31m",),
        copies_form("triangle"),
        "there is one site, and it lies in one chamber",
    ),
    Claim(
        "fixed",
        "Under p4m, pmm, p3m1 and p6m the tile is a polygon that does not depend on the site.",
        ("p4m", "pmm", "p3m1", "p6m"),
        fixed_polygon,
        "there is one site, and it lies in one chamber",
    ),
)


def verdicts(found: Census) -> list[tuple[Claim, Verdict]]:
    """Judge the sentences that speak of a group."""
    return [(claim, claim.judge(found)) for claim in CLAIMS if found.group in claim.groups]


def outcome(claim: Claim, found: Census, even: Census | None) -> str:
    """Say what is found of a sentence in a group: it holds, or where, or it is wrong.

    `even` is the census of the group in a cell with a = b, None where none was taken: then the sentence is judged by
    `found` alone.
    """
    if claim.judge(found).holds:
        return "holds"
    if even is not None and claim.judge(even).holds:
        return f"holds where a = b, else {found.chamber.name}s"
    return WRONG


def table(rows: Sequence[Census], even: dict[str, Census]) -> str:
    """The figures of all groups as a Markdown table; `even` are the censuses in cells with a = b, by group."""
    head = (
        "group",
        "straight",
        "on mirrors",
        "endless lines",
        "never moved",
        "shapes in a tiling",
        "shapes in all",
        "copies form",
        "the paper",
    )
    lines = ["| " + " | ".join(head) + " |", "|---|---:|---:|---:|---:|---:|---:|---|---|"]
    lines += ["| " + " | ".join(_cells(found, even.get(found.group))) + " |" for found in rows]
    return "\n".join(lines)


def _cells(found: Census, even: Census | None) -> list[str]:
    """The cells of one row."""
    both = int(found.values("left_and_right").sum())
    shapes = {0: "1", len(found.tiles): "2: left and right"}.get(both, f"2 in {both:,} tilings, else 1")
    judged = [
        f"{claim.key}: {outcome(claim, found, even)}"
        for claim in CLAIMS
        if found.group in claim.groups and len(claim.groups) < len(GROUPS)
    ]
    return [
        found.group,
        _spread(found, "straight"),
        _spread(found, "on_mirrors") if found.mirrors else "0",
        f"{int((found.values('endless') > 0).sum()):,}",
        f"{found.survived / POINTS:.0%}".replace("%", " %"),
        shapes,
        f"{found.shapes:,}",
        _form(found),
        "<br>".join(judged),
    ]


def _form(found: Census) -> str:
    """What copies of the tile form."""
    if fills_chamber(found):
        return f"{found.in_chamber}: {found.chamber.name}"
    return "strips" if len(found.chamber.sides) else "-"


def _spread(found: Census, name: str) -> str:
    """The median, the least and the greatest of a share."""
    low, middle, high = np.quantile(found.values(name), (0.0, 0.5, 1.0)) * 100
    return f"{middle:.0f} % ({low:.0f}-{high:.0f})" if high - low > 0.5 else f"{middle:.0f} %"


def groups_of(rows: Sequence[Census]) -> dict[str, Census]:
    """The censuses by group; all groups must be there."""
    found = {row.group: row for row in rows}
    missing = set(GROUPS) - set(found)
    if missing:
        raise ValueError(f"no census of {', '.join(sorted(missing))}")
    return found
