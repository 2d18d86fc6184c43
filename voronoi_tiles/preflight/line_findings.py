"""What concerns the lines that are cut: how they end, meet, face each other and turn."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints
from voronoi_tiles.paths.paths import Paths
from voronoi_tiles.preflight.chords import chords_of, counts_of
from voronoi_tiles.preflight.contacts import AROUND, Meeting, crossings, find_contacts, overlaps
from voronoi_tiles.preflight.cut_lines import JudgedLines
from voronoi_tiles.preflight.ends import PathEnds, find_ends
from voronoi_tiles.preflight.findings import Limits, Severity
from voronoi_tiles.preflight.necks import find_necks
from voronoi_tiles.preflight.slivers import Sliver, find_slivers

SLIT: Final = 3.0
"""An open path is an open contour when its ends are nearer than its length over this, else a slit; no unit."""

TAB_SHARE: Final = 0.05
"""How far the width of a gap may be from that of a tab, relative to it: lines bend across it."""

NECK_ACCURACY: Final = 0.005
"""How far the chords between which necks are measured lie from the curves; relative to the limit."""


STUTTER: Final = 4
"""From so many short segments in a row on a machine stutters; a count."""

SHORT_REMEDY: Final = (
    "Simplify the path: machines stutter on segments that are shorter than their steps. "
    "In a file of ours: `curves='arc'` and a larger `accuracy`."
)


class LineFinding(NamedTuple):
    """A finding on paths, by their numbers, with its place as it is drawn.

    The message names a second place, `other`, as `{}`. A finding is one of its first path, as with an end of it, or a
    `mutual` one, which does not depend on the order of its paths.
    """

    kind: str
    severity: Severity
    message: str
    remedy: str
    place: complex
    value: float | None
    paths: tuple[int, ...]
    other: complex | None = None
    mutual: bool = False


def find_on_lines(lines: JudgedLines, limits: Limits) -> Iterator[LineFinding]:
    """All findings on lines of at least one piece."""
    contacts = find_contacts(lines.chords, limits.tolerance)
    ends = find_ends(lines.chords, contacts, limits.tolerance, max(limits.gap, (1 + TAB_SHARE) * (limits.tabs or 0.0)))
    yield from _ends(lines, ends, limits)
    along = overlaps(lines.chords, lines.paths, contacts, limits.tolerance)
    crossed, touched = crossings(lines.chords, lines.paths, contacts.take(~along.part), limits.tolerance)
    yield from map(_twice, along.twice)
    over = _overshoots(ends, limits)
    yield from (_crossing(lines, meeting) for meeting in along.crossed + crossed if not over(meeting))
    yield from (_touch(meeting, limits) for meeting in along.touched + touched)
    met = _met(lines, ends, along.crossed + crossed)
    slivers = find_slivers(lines.chords, met, limits.feature, limits.tolerance)
    yield from _necks(lines, limits, slivers)
    yield from (_sliver(sliver, limits) for sliver in slivers)
    yield from _features(lines, limits)
    yield from _short(lines, limits)
    yield from _corners(lines, limits)


def _ends(lines: JudgedLines, ends: PathEnds, limits: Limits) -> Iterator[LineFinding]:
    """Ends that do not meet, short of another line or with nothing near, and those that run past one."""
    chords = lines.chords
    tabs = limits.tabs or 0.0
    wide: set[int] = set()
    for k in np.flatnonzero(ends.free).tolist():
        path = int(ends.path[k])
        if math.isfinite(ends.past[k]):
            yield LineFinding(
                "overshoot",
                "info",
                f"a line runs {ends.past[k]:.3g} mm past another one",
                "Shorten it if that must not burn.",
                complex(ends.point[k]),
                float(ends.past[k]),
                (path,),
            )
            continue
        if math.isfinite(ends.distance[k]):
            yield _gap(lines, ends, k, tabs)
            continue
        partner = k ^ 1
        apart = abs(ends.point[k] - ends.point[partner])
        both = bool(ends.free[partner]) and not math.isfinite(ends.distance[partner])
        if both and apart * SLIT < chords.total[path]:
            if path not in wide:
                wide.add(path)
                yield LineFinding(
                    "open",
                    "error",
                    f"open contour: its ends are {apart:.4g} mm apart, the other at {{}}",
                    "Close the contour: its piece would not come out.",
                    complex(ends.point[k]),
                    float(apart),
                    (path,),
                    complex(ends.point[partner]),
                )
        else:
            yield LineFinding(
                "loose end",
                "warning",
                "a line ends and meets no other",
                "Join it to the next line, unless it is meant as a slit.",
                complex(ends.point[k]),
                None,
                (path,),
            )


def _overshoots(ends: PathEnds, limits: Limits) -> Callable[[Meeting], bool]:
    """Whether lines cross where one of them ends at the other, or past it by no more than a gap."""
    past = np.flatnonzero(np.isfinite(ends.past))
    places: dict[int, list[complex]] = {}
    for path, place in zip(ends.path[past].tolist(), ends.met[past].tolist(), strict=True):
        places.setdefault(path, []).append(place)

    def is_past(meeting: Meeting) -> bool:
        near = (place for path in meeting.paths for place in places.get(path, ()))
        return any(abs(place - meeting.place) <= AROUND * limits.tolerance for place in near)

    return is_past


def _met(lines: JudgedLines, ends: PathEnds, crossed: list[Meeting]) -> Complexes:
    """Where lines that are no rings cross others, or run past them."""
    places = [meeting.place for meeting in crossed if not lines.chords.ring[list(meeting.paths)].all()]
    return np.append(ends.met[ends.free & np.isfinite(ends.past)], np.array(places, np.complex128))


def _gap(lines: JudgedLines, ends: PathEnds, k: int, tabs: float) -> LineFinding:
    """The gap between an end and the nearest line."""
    path, other = int(ends.path[k]), int(lines.chords.path[ends.chord[k]])
    near = complex(ends.near[k])
    # The ends are in the order of their paths.
    first, after = np.searchsorted(ends.path, (other, other + 1)).tolist()
    facing = any(abs(ends.point[m] - near) < 1e-9 and m != k for m in range(first, after))
    place = (complex(ends.point[k]) + near) / 2
    width = float(ends.distance[k])
    # A tab where another line ends is narrower: what ends there hangs on it as well.
    if width <= (1 + TAB_SHARE) * tabs:
        return LineFinding(
            "tab", "info", f"tab of {width:.4g} mm", "Break it out by hand.", place, width, (path, other)
        )
    what = "two ends" if facing else "an end and the line that it should meet"
    return LineFinding(
        "gap",
        "error",
        f"gap of {width:.4g} mm between {what}",
        f"Join them: the piece would hang on what is not cut. If they are tabs: `tabs={width:.3g}`.",
        place,
        width,
        (path, other),
    )


def _twice(meeting: Meeting) -> LineFinding:
    return LineFinding(
        "duplicate",
        "error",
        f"cut twice along {meeting.length:.4g} mm",
        "Remove one of the lines, or move the pieces apart: a line that is cut twice burns.",
        meeting.place,
        meeting.length,
        meeting.paths,
        mutual=True,
    )


def _crossing(lines: JudgedLines, meeting: Meeting) -> LineFinding:
    closed = any(bool(lines.chords.ring[path]) for path in meeting.paths)
    own = meeting.paths[0] == meeting.paths[1]
    return LineFinding(
        "crossing",
        "error" if closed or own else "warning",
        "a line crosses itself" if own else "two lines cross",
        "Unite or separate them: the pieces would be cut apart.",
        meeting.place,
        None,
        meeting.paths,
        mutual=True,
    )


def _touch(meeting: Meeting, limits: Limits) -> LineFinding:
    own = meeting.paths[0] == meeting.paths[1]
    within = f", within {limits.tolerance:g} mm along {meeting.length:.3g} mm" if meeting.length else ""
    return LineFinding(
        "touch",
        "warning",
        f"a line touches itself{within}" if own else f"two lines touch{within}",
        "Move them apart: what is between them hangs on a point.",
        meeting.place,
        0.0,
        meeting.paths,
        mutual=True,
    )


def _necks(lines: JudgedLines, limits: Limits, slivers: list[Sliver]) -> Iterator[LineFinding]:
    """Narrow places; those between the lines of a sliver only where it is less than half as wide as elsewhere."""
    if limits.neck <= 0.0:
        return
    slim: dict[int, list[tuple[frozenset[int], float]]] = {}
    for sliver in slivers:
        for path in sliver.paths if sliver.material else ():
            slim.setdefault(path, []).append((frozenset(sliver.paths), sliver.width))
    accuracy = max(NECK_ACCURACY * limits.neck, limits.tolerance / 4)
    chords = chords_of(lines.paths, counts_of(lines.paths, accuracy), limits.tolerance)
    for neck in find_necks(chords, 2 * accuracy + limits.tolerance, limits.neck):
        common = neck.place, neck.width, neck.paths, None, True
        if neck.material:
            around = slim.get(neck.paths[0], ())
            if any(paths.issuperset(neck.paths) and neck.width > width / 2 for paths, width in around):
                continue
            beside = f"two lines side by side, {neck.width:.3g} mm apart"
            message = beside if neck.loose else f"neck of {neck.width:.3g} mm"
            yield LineFinding("neck", "warning", message, "Widen it: it may break or burn.", *common)
        else:
            message = f"{neck.width:.3g} mm of waste between two lines"
            yield LineFinding("narrow waste", "info", message, "Move the lines apart if the waste may burn.", *common)


def _sliver(sliver: Sliver, limits: Limits) -> LineFinding:
    common = sliver.place, sliver.width, sliver.paths, None, True
    message = f"of {sliver.width:.3g} mm at most: narrower than {limits.feature:g} mm everywhere"
    if sliver.material:
        return LineFinding("sliver", "warning", f"piece {message}", "Widen it: it may break or burn.", *common)
    remedy = "Move the lines apart if the waste may burn."
    return LineFinding("narrow waste", "info", f"hole {message}", remedy, *common)


def _features(lines: JudgedLines, limits: Limits) -> Iterator[LineFinding]:
    """Contours that are smaller than the limit, both ways."""
    chords = lines.chords
    low, high = chords.boxes
    for path in np.flatnonzero(chords.ring & (chords.sizes < limits.feature)).tolist():
        size = high[path] - low[path]
        yield LineFinding(
            "feature",
            "warning",
            f"contour of {size.real:.3g} x {size.imag:.3g} mm",
            "Enlarge or remove it: it may burn away.",
            complex(low[path] + high[path]) / 2,
            float(chords.sizes[path]),
            (path,),
        )


def _short(lines: JudgedLines, limits: Limits) -> Iterator[LineFinding]:
    """Segments below the limit: machines stutter where many follow each other, and hardly notice one among longer.

    A path that is shorter as a whole is no better than a dot, or one of many.
    """
    paths = lines.paths
    short = paths.lengths < limits.shortest
    serious = _in_a_row(paths, short) >= STUTTER
    serious |= paths.path_lengths[paths.owner[short]] < limits.shortest
    for piece, many in zip(np.flatnonzero(short).tolist(), serious, strict=True):
        yield LineFinding(
            "short",
            "warning" if many else "info",
            f"segment of {paths.lengths[piece]:.3g} mm",
            SHORT_REMEDY,
            complex(paths.start[piece]),
            float(paths.lengths[piece]),
            (int(paths.owner[piece]),),
        )


def _in_a_row(paths: Paths, which: Bools) -> Ints:
    """How many segments follow each other, round closed paths as well, at each of those that are chosen."""
    some = np.flatnonzero(which)
    owner = paths.owner[some]
    begins = np.append(True, (np.diff(some) != 1) | (np.diff(owner) != 0))[: len(some)]
    row = np.cumsum(begins) - 1
    counts = np.bincount(row)
    # On a closed path the last row goes on as the first one.
    heads = np.flatnonzero((some == paths.offsets[owner]) & paths.closed[owner])
    for head in heads.tolist():
        last = int(np.searchsorted(owner, owner[head], "right")) - 1
        if some[last] == paths.offsets[owner[head] + 1] - 1 and row[last] != row[head]:
            counts[[row[head], row[last]]] = counts[row[head]] + counts[row[last]]
    return np.asarray(counts[row])


def _corners(lines: JudgedLines, limits: Limits) -> Iterator[LineFinding]:
    """Nodes at which a path turns by nearly half a circle."""
    chords = lines.chords
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
        yield LineFinding(
            "corner",
            "info",
            f"corner of {inner[k]:.3g} degrees",
            "Round it if it must not burn.",
            complex(chords.end[node[k]]),
            float(inner[k]),
            (int(chords.path[node[k]]),),
        )
