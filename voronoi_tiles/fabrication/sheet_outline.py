"""The rings that bound a sheet: closed paths, and loose lines and curves whose ends meet."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Ints, plane
from voronoi_tiles.base.components import components
from voronoi_tiles.base.neighbours import Neighbours
from voronoi_tiles.paths.conversion import to_lines
from voronoi_tiles.paths.paths import Paths

MEETING: Final = 0.005
"""How far apart ends may be that meet; millimetres. What preflight takes for one place."""

_JUDGED: Final = 1000
"""Most loose paths that are searched for a crossing, to say why nothing is closed; a count."""

_CHORD: Final = 0.01
"""How far chords may be from the curves in that search; millimetres."""


@dataclass(frozen=True, eq=False)
class SheetOutline:
    """What bounds a sheet: `rings` are closed to the bit, `left` are the loose paths that bound nothing.

    Of these, `forks` (complex128) are the places where three ends or more meet around something.
    """

    rings: Paths
    left: Paths
    forks: Complexes


def sheet_outline(paths: Paths) -> SheetOutline:
    """Find the rings among paths: those that are closed, and those that loose paths make, in any order and direction.

    Ends meet within MEETING, and two of them make a joint; paths whose ends all have one other end make rings.
    """
    first, last = paths.start[paths.offsets[:-1]], paths.end[paths.offsets[1:] - 1]
    alone = paths.closed | (np.abs(first - last) <= MEETING)
    # A line that is shorter than that joins nothing, and is no ring.
    short = ~paths.closed & (paths.path_lengths <= MEETING)
    rings = _closed_up(paths.take(np.flatnonzero(alone & ~short)), None)
    loose = paths.take(np.flatnonzero(~alone & ~short))
    if not len(loose):
        return SheetOutline(rings, loose, np.zeros(0, np.complex128))
    ends = np.stack((loose.start[loose.offsets[:-1]], loose.end[loose.offsets[1:] - 1]), axis=1)
    node = _nodes(ends.ravel()).reshape(-1, 2)
    meeting = np.bincount(node.ravel())
    group = _groups(node)
    joint = np.ones(group.max() + 1, np.bool_)
    np.logical_and.at(joint, np.repeat(group, 2), (meeting == 2)[node].ravel())
    chosen = np.flatnonzero(joint[group])
    order, turned, begins = _walked(node[chosen])
    rings = Paths.concatenate([rings, _closed_up(loose.take(chosen[order]).reversed(turned), begins)])
    other = ~joint[group]
    # A tree has one path less than it has nodes; with as many, there is a way around.
    nodes = np.zeros(group.max() + 1, np.intp)
    np.add.at(nodes, group[np.unique(node.ravel(), return_index=True)[1] // 2], 1)
    around = other & (np.bincount(group, minlength=len(nodes)) >= nodes)[group]
    forked = np.flatnonzero((meeting[node] > 2) & around[:, None])
    return SheetOutline(rings, loose.take(np.flatnonzero(other)), ends.ravel()[forked])


def _nodes(points: Complexes) -> Ints:
    """The number of the place of each point; points within MEETING are one place, as are those linked by others."""
    places, place = np.unique(points, return_inverse=True)
    count = len(places)
    # The three nearest are enough: where more are near, too many ends meet in any case.
    distance, near = Neighbours(places).nearest(places, min(4, count))
    row, column = np.nonzero(distance <= MEETING)
    return components(count, row, near[row, column])[place]


def _groups(node: Ints) -> Ints:
    """The number of the connected set that each path (n, 2) between nodes belongs to."""
    return components(int(node.max()) + 1, node[:, 0], node[:, 1])[node[:, 0]]


def _walked(node: Ints) -> tuple[Ints, Bools, list[int]]:
    """The order of paths (n, 2) along their rings, between nodes with two ends each.

    With it come which are run through backwards, and where in this order each ring begins.
    """
    at: dict[int, list[int]] = {}
    for end, place in enumerate(node.ravel().tolist()):
        at.setdefault(place, []).append(end)
    places = node.ravel().tolist()
    order: list[int] = []
    turned: list[bool] = []
    begins: list[int] = []
    done = [False] * len(node)
    for first in range(len(node)):
        if done[first]:
            continue
        begins.append(len(order))
        into = 2 * first
        while not done[into // 2]:
            done[into // 2] = True
            order.append(into // 2)
            turned.append(into % 2 == 1)
            out = into ^ 1
            one, two = at[places[out]]
            into = two if one == out else one
    return np.array(order, np.intp), np.array(turned, np.bool_), begins


def _closed_up(paths: Paths, begins: list[int] | None) -> Paths:
    """The rings of paths of which each ends where the next one begins; one path each without `begins`.

    What ends where something else begins gets its bits.
    """
    firsts = np.arange(len(paths)) if begins is None else np.array(begins, np.intp)
    if not len(firsts):
        return Paths.empty()
    bounds = np.append(firsts, len(paths))
    following = np.arange(1, len(paths) + 1)
    following[bounds[1:] - 1] = firsts
    end = paths.end.copy()
    end[paths.offsets[1:] - 1] = paths.start[paths.offsets[following]]
    return replace(paths, end=end, offsets=paths.offsets[bounds], closed=np.ones(len(firsts), np.bool_))


def reason_open(outline: SheetOutline) -> tuple[str, complex | None]:
    """Why loose paths bound nothing, in words that go on from "because", and the place; "" where there are none."""
    left = outline.left
    if not len(left):
        return "", None
    if len(outline.forks):
        return "three ends or more meet", complex(outline.forks[0])
    crossing = _crossing(left) if len(left) <= _JUDGED else None
    if crossing is not None:
        return "lines run across each other instead of ending there", crossing
    ends = np.stack((left.start[left.offsets[:-1]], left.end[left.offsets[1:] - 1]), axis=1).ravel()
    gap, place = _widest(ends)
    return (f"a line ends {gap:.3g} mm from the nearest other end" if np.isfinite(gap) else "a line ends alone"), place


def _widest(ends: Complexes) -> tuple[float, complex]:
    """The end that is the nearest to another one, but does not meet it: how far that is, and where."""
    distance, _ = Neighbours(ends).nearest(ends, 2)
    apart = np.where(distance[:, 1] > MEETING, distance[:, 1], np.inf)
    nearest = int(np.argmin(apart))
    return float(apart[nearest]), complex(ends[nearest])


def _crossing(paths: Paths) -> complex | None:
    """A point where two paths cross, None where none do."""
    import shapely

    chords = to_lines(paths, accuracy=_CHORD)
    lines = []
    for path in range(len(chords)):
        some = slice(int(chords.offsets[path]), int(chords.offsets[path + 1]))
        points = np.append(chords.start[some], chords.end[some][-1:])
        lines.append(shapely.LineString(plane(points)))
    one, two = shapely.STRtree(lines).query(lines, predicate="crosses")
    if not len(one):
        return None
    point = shapely.get_coordinates(lines[one[0]].intersection(lines[two[0]]))[0]
    return complex(*point.tolist())
