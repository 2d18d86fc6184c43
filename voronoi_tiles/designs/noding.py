"""Noding: segments that cross, touch or overlap made into segments that meet only at common nodes.

Why not shapely's node or set_precision: here nodes merge within a tolerance, while all else keeps its bits and its
order, on which the bits of tiles depend; and reading a design does not wait for shapely's import.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Ints
from voronoi_tiles.base.box_join import overlapping_boxes
from voronoi_tiles.base.errors import DesignError


def noded(points: Complexes, segments: Ints, near: float, deviation: float) -> tuple[Complexes, Ints]:
    """The nodes (m,) and segments (n, 2) that points (k,) and segments between them (j, 2) become.

    A point is a segment from its node to itself. Nodes within `near` of each other become one, and a segment that
    passes a node as near runs through it; joints of two segments that are straight within `deviation` are left out.
    Nodes that no segment uses may be left. Raises DesignError where no noding at this precision separates the segments,
    and where they overlap too often to be worth it.
    """
    # Distances are measured from a node in the middle: subtracting it is exact for a site far from the origin.
    origin = points[len(points) // 2]
    nodes, segments = _node(points, segments, origin, near)
    straightened = _straighten(nodes, segments, deviation)
    if straightened is not None and not len(_contacts(nodes, straightened, origin, near)[0]):
        segments = straightened
    return nodes, segments


def _node(points: Complexes, segments: Ints, origin: complex, near: float) -> tuple[Complexes, Ints]:
    """Merge near nodes and split segments at their contacts until there is none; returns nodes and segments."""
    nodes = points
    # Most drawings take two rounds, and one more that finds nothing.
    for _ in range(64):
        nodes, index = merged(nodes, origin, near)
        segments = _unique(index[segments])
        split, at, crossings = _contacts(nodes, segments, origin, near)
        if not len(split):
            return nodes, segments
        at = np.where(at < 0, len(nodes) - at - 1, at)
        nodes = np.concatenate([nodes, crossings])
        segments = _split(nodes, segments, split, at)
    raise DesignError(
        "strokes that run within rounding of each other cannot be told apart",
        key="strokes",
        remedy="Move them apart, or draw the shared part once.",
    )


def _unique(segments: Ints) -> Ints:
    """Each segment once (in either direction), in the order of first occurrence; without points that segments cover."""
    low, high = segments.min(axis=1), segments.max(axis=1)
    base = int(high.max()) + 1
    _, first = np.unique(low * base + high, return_index=True)
    if len(first) < len(segments):
        segments = segments[np.sort(first)]
    point = segments[:, 0] == segments[:, 1]
    if point.any():
        used = np.zeros(base, dtype=bool)
        used[segments[~point].ravel()] = True
        segments = segments[~(point & used[segments[:, 0]])]
    return segments


def merged(nodes: Complexes, origin: complex, near: float) -> tuple[Complexes, Ints]:
    """Make nodes within `near` of each other one: the first of them; distances are measured from `origin`.

    Returns the nodes left, and for each old node its index among them. Two nodes within `near` share a
    square of side 4 `near` in at least one of four grids that are shifted by halves.
    """
    _, first, inverse = np.unique(nodes, return_index=True, return_inverse=True)
    same = first[inverse]  # the first of the nodes that are equal to the bit
    different = same == np.arange(len(nodes))
    nodes = nodes[different]
    again = (np.cumsum(different) - 1)[same]
    if near == 0.0:  # a site that is one point
        return nodes, again

    count = len(nodes)
    label = np.arange(count, dtype=np.intp)
    local = nodes - origin
    cell = 4.0 * near
    x, y = local.real / cell, local.imag / cell
    for dx in (0.0, 0.5):
        for dy in (0.0, 0.5):
            square = np.empty(count, dtype=np.complex128)
            square.real, square.imag = np.floor(x + dx), np.floor(y + dy)
            order = np.argsort(square, kind="stable")
            run = square[order]
            follows = run[1:] == run[:-1]
            if not follows.any():
                continue
            starts = np.concatenate([[0], np.flatnonzero(~follows) + 1, [count]])
            for k in np.flatnonzero(np.diff(starts) > 1):
                _join(local, label, order[starts[k] : starts[k + 1]], near)
    # Labels point to smaller ones: follow them to the first of each set.
    while True:
        nearer = label[label]
        if (nearer == label).all():
            break
        label = nearer
    kept = label == np.arange(count)
    return nodes[kept], (np.cumsum(kept) - 1)[label][again]


def _join(local: Complexes, label: Ints, members: Ints, near: float) -> None:
    """Unite, in `label`, those members of one grid square that are within `near` of each other."""
    while len(members) > 1:
        close = abs(local[members] - local[members[0]]) <= near
        roots = label[members[close]]
        while (label[roots] != roots).any():
            roots = label[roots]
        label[roots] = roots.min()
        label[members[close]] = roots.min()
        members = members[1:] if not close.all() else members[:0]


def _contacts(nodes: Complexes, segments: Ints, origin: complex, near: float) -> tuple[Ints, Ints, Complexes]:
    """Where segments touch or cross other than at common nodes.

    Returns the segments to split, the node to split each at (-1, -2, ... stand for new nodes 0, 1, ...),
    and the new nodes: crossings. A node within `near` of a segment's inside splits it; two segments that
    then still have each other's ends on both sides cross.
    """
    none = np.empty(0, dtype=np.intp)
    if len(segments) < 2:
        return none, none, np.empty(0, dtype=np.complex128)
    local = nodes - origin
    i, j = overlapping_boxes(local[segments], near)
    z0, z1 = local[segments[:, 0]], local[segments[:, 1]]
    chord = z1 - z0
    length = np.abs(chord)

    # Both roles of a pair at once: does an end of segment j lie on segment i, and the other way round?
    host = np.concatenate([i, j])
    guest = np.concatenate([j, i])
    real = length[host] > 0.0
    host, guest = host[real], guest[real]
    sides = np.empty((2, len(host)))
    split, at = [], []
    for end in (0, 1):
        node = segments[guest, end]
        offset = local[node] - z0[host]
        c = chord[host]
        along = (offset.real * c.real + offset.imag * c.imag) / length[host]
        across = (offset.imag * c.real - offset.real * c.imag) / length[host]
        foreign = (node != segments[host, 0]) & (node != segments[host, 1])
        on = foreign & (np.abs(across) <= near) & (along > 0.0) & (along < length[host])
        sides[end] = np.where(on | ~foreign, 0.0, across)
        split.append(host[on])
        at.append(node[on])

    # A crossing has the ends strictly on both sides, for either role of the pair.
    halves = np.sign(sides[0]) * np.sign(sides[1]) < 0.0
    role = np.zeros((2, len(i)), dtype=bool)
    role.ravel()[np.flatnonzero(real)] = halves
    cross = role[0] & role[1]
    i, j = i[cross], j[cross]
    position = np.cumsum(real) - 1  # where a role went when points were taken out
    mine = sides[:, position[: len(cross)][cross]]
    # The ends of j are at signed distances s0, s1 from i: the crossing divides j in their ratio.
    ratio = mine[0] / (mine[0] - mine[1])
    nearer_start = ratio <= 0.5
    crossings = origin + np.where(nearer_start, z0[j] + ratio * chord[j], z1[j] - (1.0 - ratio) * chord[j])
    new = -1 - np.arange(len(crossings), dtype=np.intp)
    return (
        np.concatenate([*split, i, j]),
        np.concatenate([*at, new, new]),
        crossings,
    )


def _split(nodes: Complexes, segments: Ints, split: Ints, at: Ints) -> Ints:
    """Cut segment split[k] at node at[k]; the parts stand where the whole stood, in its direction."""
    whole = np.ones(len(segments), dtype=bool)
    whole[split] = False
    kept = np.flatnonzero(whole)
    cut = np.flatnonzero(~whole)
    # Every cut segment as its sorted row of nodes: start, splits, end.
    owner = np.concatenate([cut, split, cut])
    node = np.concatenate([segments[cut, 0], at, segments[cut, 1]])
    start = nodes[segments[owner, 0]]
    chord = nodes[segments[owner, 1]] - start
    offset = nodes[node] - start
    along = offset.real * chord.real + offset.imag * chord.imag
    along[: len(cut)] = -np.inf
    along[len(along) - len(cut) :] = np.inf
    order = np.lexsort((along, owner))
    owner, node = owner[order], node[order]
    joined = (owner[1:] == owner[:-1]) & (node[1:] != node[:-1])
    parts = np.stack([node[:-1][joined], node[1:][joined]], axis=1)
    place = np.concatenate([kept, owner[:-1][joined]])
    return np.concatenate([segments[kept], parts])[np.argsort(place, kind="stable")]


def _straighten(nodes: Complexes, segments: Ints, deviation: float) -> Ints | None:
    """Leave out joints of two segments that lie on a straight line; None where there is no such joint.

    A run of segments becomes one where all its joints are within `deviation` of it.
    """
    real = segments[:, 0] != segments[:, 1]
    degree = np.bincount(segments[real].ravel(), minlength=len(nodes))
    # The two segments of each joint of two: sort the segment ends by node.
    ends = np.concatenate([segments[real, 0], segments[real, 1]])
    others = np.concatenate([segments[real, 1], segments[real, 0]])
    order = np.argsort(ends, kind="stable")
    starts = np.cumsum(degree) - degree
    joints = np.flatnonzero(degree == 2)
    before, after = others[order[starts[joints]]], others[order[starts[joints] + 1]]
    u, v = nodes[joints] - nodes[before], nodes[after] - nodes[joints]
    w = nodes[after] - nodes[before]
    across = np.abs(u.real * w.imag - u.imag * w.real)
    straight = (across <= deviation * np.abs(w)) & (u.real * v.real + u.imag * v.imag > 0.0)
    if not straight.any():
        return None
    loose = {
        int(n): (int(p), int(q)) for n, p, q in zip(joints[straight], before[straight], after[straight], strict=True)
    }
    dropped: set[int] = set()
    added: list[tuple[int, int]] = []
    done: set[int] = set()
    for seed in loose:
        if seed in done:
            continue
        run = [seed]
        for side in (0, 1):  # grow the run to both sides, as far as its nodes are loose
            last, current = seed, loose[seed][side]
            while current in loose and current != seed:
                run.append(current)
                last, current = current, next(n for n in loose[current] if n != last)
            run.append(current)
            if side == 0:
                run.reverse()
        done.update(run[1:-1])
        kept = _kept_of_run(nodes[run], deviation)
        dropped.update(node for k, node in enumerate(run) if k not in kept)
        added.extend((run[p], run[q]) for p, q in pairwise(kept) if q > p + 1)
    gone = np.zeros(len(nodes), dtype=bool)
    gone[list(dropped)] = True
    rest = segments[~gone[segments].any(axis=1)]
    return np.concatenate([rest, np.array(added, dtype=np.intp).reshape(-1, 2)])


def _kept_of_run(z: Complexes, deviation: float) -> list[int]:
    """Which points of a run to keep, so that the others are within `deviation` of the chords (Douglas and Peucker)."""
    kept = {0, len(z) - 1}
    stack = [(0, len(z) - 1)]
    while stack:
        p, q = stack.pop()
        if q < p + 2:
            continue
        w, u = z[q] - z[p], z[p + 1 : q] - z[p]
        across = np.abs(u.real * w.imag - u.imag * w.real)
        worst = int(across.argmax())
        if not across[worst] <= deviation * abs(w):
            kept.add(p + 1 + worst)
            stack += [(p, p + 1 + worst), (p + 1 + worst, q)]
    return sorted(kept)
