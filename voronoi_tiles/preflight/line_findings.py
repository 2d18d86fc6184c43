"""What concerns the lines that are cut: how they end, meet, face each other and turn, as findings."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from voronoi_tiles.preflight.chords import chords_of, counts_of
from voronoi_tiles.preflight.contacts import Meeting, crossings, find_contacts, overlaps
from voronoi_tiles.preflight.cut_lines import CutLines
from voronoi_tiles.preflight.ends import PathEnds, find_ends
from voronoi_tiles.preflight.findings import Finding, Limits
from voronoi_tiles.preflight.necks import find_necks

SLIT: Final = 3.0
"""An open path is an open contour when its ends are nearer than its length over this, else a slit; no unit."""

TAB_SHARE: Final = 0.05
"""How far the width of a gap may be from that of a tab, relative to it: lines bend across it."""

NECK_ACCURACY: Final = 0.005
"""How far the chords between which necks are measured lie from the curves; relative to the limit."""


def line_findings(subject: CutLines, limits: Limits) -> Iterator[Finding]:
    """All findings on the lines of a subject that has at least one piece."""
    yield from _ends(subject, limits)
    contacts = find_contacts(subject.chords, limits.tolerance)
    twice, part = overlaps(subject.chords, contacts, limits.tolerance)
    crossed, touched = crossings(subject.chords, subject.paths, contacts.take(~part), limits.tolerance)
    yield from (_twice(subject, meeting) for meeting in twice)
    yield from (_crossing(subject, meeting) for meeting in crossed)
    yield from (_touch(subject, meeting) for meeting in touched)
    yield from _necks(subject, limits)
    yield from _features(subject, limits)
    yield from _short(subject, limits)
    yield from _corners(subject, limits)


def _ends(subject: CutLines, limits: Limits) -> Iterator[Finding]:
    """Ends that do not meet, short of another line or with nothing near."""
    chords = subject.chords
    tabs = limits.tabs or 0.0
    ends = find_ends(chords, limits.tolerance, max(limits.gap, (1 + TAB_SHARE) * tabs))
    named: set[tuple[int, int]] = set()
    wide: set[int] = set()
    for k in np.flatnonzero(ends.free).tolist():
        path = int(ends.path[k])
        if math.isfinite(ends.distance[k]):
            finding = _gap(subject, ends, k, named, tabs)
            if finding is not None:
                yield finding
            continue
        partner = k ^ 1
        apart = abs(ends.point[k] - ends.point[partner])
        both = bool(ends.free[partner]) and not math.isfinite(ends.distance[partner])
        if both and apart * SLIT < chords.total[path]:
            if path not in wide:
                wide.add(path)
                x, y = subject.place(complex(ends.point[partner]))
                yield Finding(
                    "open",
                    "error",
                    f"open contour: its ends are {apart:.4g} mm apart, the other at ({x:.3f}, {y:.3f})",
                    "Close the contour: its piece would not come out.",
                    subject.place(complex(ends.point[k])),
                    float(apart),
                    subject.sources(path),
                )
        else:
            yield Finding(
                "loose end",
                "warning",
                "a line ends with nothing near",
                "Join it to the next line, unless it is meant as a slit.",
                subject.place(complex(ends.point[k])),
                None,
                subject.sources(path),
            )


def _gap(subject: CutLines, ends: PathEnds, k: int, named: set[tuple[int, int]], tabs: float) -> Finding | None:
    """The gap between an end and the nearest line; None where it was named from its other side."""
    path, other = int(ends.path[k]), int(subject.chords.path[ends.chord[k]])
    near = complex(ends.near[k])
    # The ends are in the order of their paths.
    first, after = np.searchsorted(ends.path, (other, other + 1)).tolist()
    facing = [m for m in range(first, after) if abs(ends.point[m] - near) < 1e-9 and m != k]
    key = (min(k, facing[0]), max(k, facing[0])) if facing else (k, k)
    if key in named:
        return None
    named.add(key)
    place = subject.place((complex(ends.point[k]) + near) / 2)
    width = float(ends.distance[k])
    # A tab where another line ends is narrower: what ends there hangs on it as well.
    if width <= (1 + TAB_SHARE) * tabs:
        return Finding(
            "tab", "info", f"tab of {width:.4g} mm", "Break it out by hand.", place, width, subject.sources(path, other)
        )
    what = "two ends" if facing else "an end and the line that it should meet"
    return Finding(
        "gap",
        "error",
        f"gap of {width:.4g} mm between {what}",
        f"Join them: the piece would hang on what is not cut. If they are tabs: `tabs={width:.3g}`.",
        place,
        width,
        subject.sources(path, other),
    )


def _twice(subject: CutLines, meeting: Meeting) -> Finding:
    return Finding(
        "duplicate",
        "error",
        f"cut twice along {meeting.length:.4g} mm",
        "Remove one of the lines, or move the pieces apart: a line that is cut twice burns.",
        subject.place(meeting.place),
        meeting.length,
        subject.sources(*meeting.paths),
    )


def _crossing(subject: CutLines, meeting: Meeting) -> Finding:
    closed = any(bool(subject.chords.ring[path]) for path in meeting.paths)
    own = meeting.paths[0] == meeting.paths[1]
    return Finding(
        "crossing",
        "error" if closed or own else "warning",
        "a line crosses itself" if own else "two lines cross",
        "Unite or separate them: the pieces would be cut apart.",
        subject.place(meeting.place),
        None,
        subject.sources(*meeting.paths),
    )


def _touch(subject: CutLines, meeting: Meeting) -> Finding:
    own = meeting.paths[0] == meeting.paths[1]
    return Finding(
        "touch",
        "warning",
        "a line touches itself" if own else "two lines touch",
        "Move them apart: what is between them hangs on a point.",
        subject.place(meeting.place),
        0.0,
        subject.sources(*meeting.paths),
    )


def _necks(subject: CutLines, limits: Limits) -> Iterator[Finding]:
    if limits.neck <= 0.0:
        return
    accuracy = max(NECK_ACCURACY * limits.neck, limits.tolerance / 4)
    chords = chords_of(subject.paths, counts_of(subject.paths, accuracy), limits.tolerance)
    for neck in find_necks(chords, 2 * accuracy + limits.tolerance, limits.neck):
        common = subject.place(neck.place), neck.width, subject.sources(*neck.paths)
        if neck.material:
            message = f"neck of {neck.width:.3g} mm"
            yield Finding("neck", "warning", message, "Widen it: it may break or burn.", *common)
        else:
            message = f"{neck.width:.3g} mm of waste between two lines"
            yield Finding("narrow waste", "info", message, "Move the lines apart if the waste may burn.", *common)


def _features(subject: CutLines, limits: Limits) -> Iterator[Finding]:
    """Contours that are smaller than the limit, both ways."""
    chords = subject.chords
    first = chords.first[:-1]
    x, y = chords.start.real, chords.start.imag
    across = np.maximum.reduceat(x, first) - np.minimum.reduceat(x, first)
    down = np.maximum.reduceat(y, first) - np.minimum.reduceat(y, first)
    size = np.maximum(across, down)
    for path in np.flatnonzero(chords.ring & (size < limits.feature)).tolist():
        some = slice(int(first[path]), int(chords.first[path + 1]))
        middle = complex((x[some].min() + x[some].max()) / 2, (y[some].min() + y[some].max()) / 2)
        yield Finding(
            "feature",
            "warning",
            f"contour of {across[path]:.3g} x {down[path]:.3g} mm",
            "Enlarge or remove it: it may burn away.",
            subject.place(middle),
            float(size[path]),
            subject.sources(path),
        )


def _short(subject: CutLines, limits: Limits) -> Iterator[Finding]:
    paths = subject.paths
    for piece in np.flatnonzero(paths.lengths < limits.shortest).tolist():
        yield Finding(
            "short",
            "warning",
            f"segment of {paths.lengths[piece]:.3g} mm",
            "Simplify the path: machines stutter on segments that are shorter than their steps.",
            subject.place(complex(paths.start[piece])),
            float(paths.lengths[piece]),
            subject.sources(int(paths.owner[piece])),
        )


def _corners(subject: CutLines, limits: Limits) -> Iterator[Finding]:
    """Nodes at which a path turns by nearly half a circle."""
    chords = subject.chords
    one = np.arange(len(chords.start))
    two = chords.next(one)
    node = np.flatnonzero((two >= 0) & (two != one))
    node = node[(chords.piece[node] != chords.piece[two[node]]) | (two[node] <= node)]
    into = chords.end[node] - chords.start[node]
    out = chords.end[two[node]] - chords.start[two[node]]
    moving = (np.abs(into) > 0) & (np.abs(out) > 0)
    node, into, out = node[moving], into[moving], out[moving]
    inner = 180.0 - np.abs(np.degrees(np.angle(out * into.conj())))
    for k in np.flatnonzero(inner < limits.corner).tolist():
        yield Finding(
            "corner",
            "info",
            f"corner of {inner[k]:.3g} degrees",
            "Round it if it must not burn.",
            subject.place(complex(chords.end[node[k]])),
            float(inner[k]),
            subject.sources(int(chords.path[node[k]])),
        )
