"""How far the vertices and edges of tiles are from the true ones: the engine, Boost.Polygon and CGAL, in 50 digits.

exact.py says what a true vertex is. All errors are relative to the cell's longer side. The designs are random cubic
curves in 24 and in 100 segments; those of one kind are bent by a millionth of the cell only, so that their segments are
nearly parallel, those of another end a millionth of the cell from a copy.

Boost.Polygon and CGAL get the copies beyond the tile's edges, which suffice. Their vertices are those between a cell of
the base site and one of a copy. They are measured against the true vertices, and against those of their *own input*,
solved the same way. README.md says what the columns count; no vertex is left out. What the engine misses is found among
the peers' extra vertices.

    python bench/accuracy.py                   all designs: a few minutes
    python bench/accuracy.py --write           the same, into bench/README.md
    python bench/accuracy.py --groups p4 --segments 24
"""

from __future__ import annotations

import argparse
import math
import sys
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import cgal
import numpy as np
import peer
from compiled import MissingError
from exact import Label, Plane, Vertex, as_given, distance, exact_images, longer_side, true_vertices
from mpmath import mpc, mpf
from report import machine, published, table

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.errors import TouchingCopiesError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.site import NodedSite, build_site
from voronoi_tiles.groups.wallpaper import GROUPS, Lattice, WallpaperGroup
from voronoi_tiles.vector.outline import Outline
from voronoi_tiles.vector.tessellation import TileRecord, tessellate

SIZES = (24, 100)
CHOSEN = ("p1", "pgg", "cmm", "p4", "p31m", "p6")
KINDS = ("curve", "nearly straight", "nearly touching")
GAP = 1e-6
"""How much the nearly straight are bent, and how near the nearly touching come; relative to the cell's longer side."""
NEAR_END = 1e-3
"""Where on an arc its elements are taken that meet at its end."""
NEAR_END_ON_MIRROR = 1e-6
"""The same on a mirror, where one straight edge may have many elements one after the other."""
PROMISE = 1e-12
"""The engine's limit for the difference of the two distances along an edge; relative to the cell's longer side."""
WHO = ("engine", "Boost.Polygon", "CGAL")


# What the engine and the peers found


@dataclass
class Score:
    """What was found of one design: errors of vertices, relative to the cell, and counts of those without one."""

    errors: list[float] = field(default_factory=list)
    own: list[float] = field(default_factory=list)
    edges: list[float] = field(default_factory=list)
    missing: int = 0
    merged: int = 0
    dividing: int = 0
    extra: int = 0
    untrue: int = 0


def elements_at(
    plane: Plane, outline: Outline, number: dict[Operation, int], share: float | Floats
) -> list[tuple[int, int]]:
    """The two elements that each arc is equally far from at a parameter: the base site's, the neighbour's.

    They are the same all along an arc, but for a straight edge on a mirror, where two can give way to two others.
    """
    ends = (1 - share) ** 2 * outline.start + share**2 * outline.end
    points = ends + 2 * share * (1 - share) * outline.control
    pairs = []
    for z, k in zip(points.tolist(), outline.neighbour.tolist(), strict=True):
        away = plane.distances(z).reshape(len(plane.nodes), -1)
        beyond = number[outline.neighbours[k].operation]
        pairs.append((int(away[0].argmin()), beyond * plane.per_copy + int(away[beyond].argmin())))
    return pairs


def score_engine(plane: Plane, outline: Outline, number: dict[Operation, int]) -> tuple[Score, list[Vertex]]:
    """Measure the engine's outline; give the true vertices too."""
    score, true = Score(), []
    on_mirror = np.array([number[other.operation] in plane.mirrored for other in outline.neighbours])
    near = np.where(on_mirror[outline.neighbour], NEAR_END_ON_MIRROR, NEAR_END)
    after, before = (elements_at(plane, outline, number, share) for share in (near, 1 - near))
    for low, high in zip(outline.ring_offsets[:-1].tolist(), outline.ring_offsets[1:].tolist(), strict=True):
        for k in range(low, high):
            start = complex(outline.start[k])
            found = true_vertices(plane, frozenset((*before[k - 1 if k > low else high - 1], *after[k])), start)
            score.untrue += not found
            score.merged += max(0, len(found) - 1)
            score.errors += [float(abs(vertex.point - start) / plane.size) for vertex in found]
            true += found
    score.edges = edge_errors(plane, outline, elements_at(plane, outline, number, 0.5))
    return score, true


def edge_errors(plane: Plane, outline: Outline, pairs: Sequence[tuple[int, int]]) -> list[float]:
    """For each arc, how much its points' distances from its two elements differ at most, relative to the cell.

    Taken at the parameters 0, 0.1, ..., 1, in 50 digits from the control points as they are.
    """
    errors = []
    for k, (here, there) in enumerate(pairs):
        start, control, end = (mpc(complex(z[k])) for z in (outline.start, outline.control, outline.end))
        if not outline.curved[k]:
            control = (start + end) / 2
        worst = mpf(0)
        for step in range(11):
            t = mpf(step) / 10
            z = (1 - t) ** 2 * start + 2 * t * (1 - t) * control + t * t * end
            worst = max(worst, abs(distance(plane, here, z)[0] - distance(plane, there, z)[0]))
        errors.append(float(worst / plane.size))
    return errors


def outline_vertices(plane: Plane, reading: peer.Reading) -> list[tuple[complex, Label]]:
    """The ends of the edges between the base site's cells and others, with all elements that meet there."""
    count, m = len(plane.site.segments), len(plane.site.nodes)
    elements = []
    for segment, category in reading.owner:
        copy, k = divmod(segment, count)
        local = m + k if category > 2 else int(plane.site.segments[k, category - 1])
        elements.append(copy * plane.per_copy + local)
    labels: dict[complex, set[int]] = defaultdict(set)
    outer: dict[complex, None] = {}
    for cell, edges in reading.cells:
        for start, end, _, beyond in edges:
            for z in (start, end):
                labels[z] |= {elements[cell], elements[beyond]}
                if plane.copy_of(elements[beyond]):
                    outer[z] = None
    return [(z, frozenset(labels[z])) for z in outer]


def _divides(plane: Plane, label: Label) -> bool:
    """Whether no copy but one mirror image is involved: then the edge is on the mirror, straight, and goes on."""
    copies = {plane.copy_of(element) for element in label} - {0}
    return len(copies) == 1 and copies <= plane.mirrored


def score_peer(plane: Plane, given: Plane, true: Sequence[Vertex], reading: peer.Reading) -> tuple[Score, list[Vertex]]:
    """Measure a peer's vertices against the true ones, and against those of the input that it was given.

    A vertex is that of a true one with which it has three elements in common, the nearest if there are several; two
    that have become one are counted as merged. Gives also the true vertices that only the peer has.
    """
    score, more = Score(), []
    found = outline_vertices(given, reading)
    reached: dict[int, list[float]] = defaultdict(list)
    nearby: dict[int, list[float]] = defaultdict(list)
    for z, label in found:
        divides = _divides(plane, label)
        off = {
            k: float(abs(vertex.point - z) / plane.size)
            for k, vertex in enumerate(true)
            if len(vertex.label & label) > 2 and not divides
        }
        for k, error in off.items():
            nearby[k].append(error)
        if off:
            reached[min(off, key=off.__getitem__)].append(min(off.values()))
        elif divides:
            score.dividing += 1
        else:
            score.extra += 1
            more += true_vertices(plane, label, z)
        # A vertex that is far off is no good start for Newton's method: then the true one is.
        others = [complex(true[min(off, key=off.__getitem__)].point)] if off else []
        own = next((known for start in (z, *others) if (known := true_vertices(given, label, start))), [])
        score.untrue += not own
        score.own += [float(abs(vertex.point - z) / plane.size) for vertex in own]
    for k in range(len(true)):
        score.merged += k in nearby and k not in reached
        score.missing += k not in nearby
        score.errors += [max(reached[k])] if k in reached else [min(nearby[k])] if k in nearby else []
    return score, more


class Drawing(NamedTuple):
    """A design: its group, and the site's one curve cut into segments."""

    group: WallpaperGroup
    site: NodedSite
    lattice: Lattice


def draw(group: WallpaperGroup, kind: str, segments: int, rng: np.random.Generator) -> tuple[Drawing, TileRecord]:
    """Draw random cubic curves until the copies of one do not touch, and tessellate it."""
    b = None if group.fixes_b else float(rng.uniform(40.0, 80.0))
    lattice = group.lattice(60.0, b, float(rng.uniform(60.0, 85.0)))
    for _ in range(10_000):
        p = _controls(group, lattice, kind, rng)
        t = np.linspace(0.0, 1.0, segments + 1)
        curve = (1 - t) ** 3 * p[0] + 3 * t * (1 - t) ** 2 * p[1] + 3 * t**2 * (1 - t) * p[2] + t**3 * p[3]
        site = build_site("curve", [curve])
        if len(site.segments) == segments:
            try:
                return Drawing(group, site, lattice), tessellate([site], group, lattice)[0]
            except TouchingCopiesError:
                continue
    raise AssertionError(f"no {kind} in {group.name} whose copies do not touch")


def _controls(group: WallpaperGroup, lattice: Lattice, kind: str, rng: np.random.Generator) -> Complexes:
    """Four control points: of any curve, of one that is bent by a millionth, or of one that ends near a copy."""
    reach = 0.5 * math.sqrt(lattice.det / group.order)
    place = lattice.cartesian(*rng.uniform(0.0, 1.0, 2))
    p: Complexes = place + reach * rng.uniform(0.2, 1.0, 4) * np.exp(2j * np.pi * rng.uniform(0.0, 1.0, 4))
    if kind == "nearly straight":
        normal = 1j * (p[3] - p[0]) / abs(p[3] - p[0])
        p[1], p[2] = ((2 * p[0] + p[3]) / 3, (p[0] + 2 * p[3]) / 3) + normal * longer_side(lattice) * np.array(
            [GAP, -GAP]
        )
    if kind == "nearly touching":
        operation = group.operations[int(rng.integers(len(group.operations)))]
        step = (1, 0) if operation.is_identity else tuple(rng.integers(-1, 2, 2).tolist())
        image = lattice.isometry(operation.translated(*step))(complex(p[0]))
        p[3] = image + GAP * longer_side(lattice) * np.exp(2j * np.pi * rng.uniform())
    return p


def surroundings(drawing: Drawing, record: TileRecord) -> list[Operation]:
    """List the site, the copies beyond its tile's edges, and then all others that could come near to the tile."""
    outline, lattice = record.outline, drawing.lattice
    beyond = [Operation.parse("x,y"), *(neighbour.operation for neighbour in outline.neighbours)]
    nodes = drawing.site.nodes
    centre = complex(nodes.mean())
    radius = float(np.abs(nodes - centre).max())
    # A copy that is as near to a vertex as the site has its centre within this.
    rim = 2 * float(np.abs(outline.start - centre).max()) + 2 * radius
    short = abs(lattice.reduced_basis[0])
    low = lattice.det / max(abs(lattice.a), abs(lattice.b))
    most = math.ceil((rim + abs(centre)) / min(low, short)) + 2
    others = []
    for operation in drawing.group.operations:
        for i in range(-most, most + 1):
            for j in range(-most, most + 1):
                copy = operation.translated(i, j)
                if copy not in beyond and abs(lattice.isometry(copy)(centre) - centre) <= rim:
                    others.append(copy)
    return beyond + others


class Row(NamedTuple):
    """What was measured of a design: a score for the engine, for Boost.Polygon and for CGAL (None: not there)."""

    group: str
    kind: str
    segments: int
    vertices: int
    scores: tuple[Score, Score | None, Score | None]


def measure(task: tuple[str, str, int, int]) -> Row:
    """Draw a design and measure it: group, kind, number of segments, number of the design."""
    name, kind, segments, number = task
    rng = np.random.default_rng([list(GROUPS).index(name), KINDS.index(kind), segments, number])
    drawing, record = draw(GROUPS[name], kind, segments, rng)
    copies = surroundings(drawing, record)
    plane = exact_images(drawing.site, drawing.lattice, drawing.group, copies)
    engine, true = score_engine(plane, record.outline, {copy: k for k, copy in enumerate(copies)})
    peers: list[Score | None] = []
    for run in (_run_boost, _run_cgal):
        given, reading = run(plane, plane.nodes[: len(record.outline.neighbours) + 1])
        if reading is None:
            peers.append(None)
            continue
        score, more = score_peer(plane, given, true, reading)
        engine.missing += len({vertex.label for vertex in more})
        peers.append(score)
    print(f"{name}, {kind}, {segments} segments: {len(true)} vertices", file=sys.stderr)
    return Row(name, kind, segments, len(true), (engine, peers[0], peers[1]))


def _run_boost(plane: Plane, nodes: Complexes) -> tuple[Plane, peer.Reading]:
    """Run Boost.Polygon on nodes rounded to the finest grid, a power of two, that 32 bits allow."""
    scale = 2.0 ** math.floor(math.log2((2**31 - 1) / max(np.abs(nodes.real).max(), np.abs(nodes.imag).max())))
    rounded: Complexes = np.asarray((np.round(nodes.real * scale) + 1j * np.round(nodes.imag * scale)) / scale)
    segments = peer.block_segments(plane.site, rounded)
    given = as_given(plane.site, rounded, plane.size)
    return given, peer.run_peer(segments, len(plane.site.segments), scale)[1]


def _run_cgal(plane: Plane, nodes: Complexes) -> tuple[Plane, peer.Reading | None]:
    """Run CGAL, if it is there."""
    given = as_given(plane.site, nodes, plane.size)
    try:
        return given, cgal.run_cgal(plane.site, nodes)[1]
    except MissingError:
        return given, None


def print_designs(rows: Sequence[Row]) -> None:
    """Print the worst errors of every design."""
    heads = [
        "ratio, Boost.Polygon",
        "ratio, CGAL",
        "group",
        "design",
        "segments",
        "vertices",
        "engine",
        "engine, edges",
    ]
    heads += ["Boost.Polygon", "own input", "CGAL", "own input"]
    table("Worst error of a vertex; ratio = the peer's worst error / the engine's worst error:", *heads)
    for row in rows:
        engine, *peers = row.scores
        worst = max(engine.errors, default=math.nan)
        ratios = [_times(max(score.errors) / worst) if score and score.errors else "-" for score in peers]
        cells = [*ratios, row.group, row.kind, str(row.segments), str(row.vertices), f"{worst:.1e}"]
        cells.append(f"{max(engine.edges):.1e}")
        for score in peers:
            cells += [f"{max(part, default=math.nan):.1e}" if score else "-" for part in _parts(score)]
        print(f"| {' | '.join(cells)} |")


def _parts(score: Score | None) -> tuple[list[float], list[float]]:
    """The errors and those against the own input."""
    return (score.errors, score.own) if score else ([], [])


def _times(ratio: float) -> str:
    """Write a ratio with two digits, large and small ones as a power of ten."""
    return f"{ratio:.1f}" if 0.1 <= ratio < 100 else f"{ratio:.1e}"


def print_quantiles(rows: Sequence[Row]) -> None:
    """Print the errors' quantiles and the counts of each kind of design."""
    heads = ["ratio of the worst", "design", "of", "vertices", "median", "90 %", "99 %", "worst"]
    table("All vertices of each kind of design:", *heads, "missing", "merged", "dividing", "extra", "untrue")
    for kind in KINDS:
        chosen = [row for row in rows if row.kind == kind]
        best = max((error for row in chosen for error in row.scores[0].errors), default=math.nan)
        for number, who in enumerate(WHO):
            scores = [score for row in chosen if (score := row.scores[number]) is not None]
            all_errors = [error for score in scores for error in score.errors]
            own_errors = [error for score in scores for error in score.own]
            for name, errors in ((who, all_errors), (f"{who}, own input", own_errors)):
                if not errors:
                    continue
                cells = [_times(max(errors) / best), kind, name, str(len(errors))]
                cells += [f"{q:.1e}" for q in np.quantile(errors, (0.5, 0.9, 0.99, 1.0))]
                counts = [(s.missing, s.merged, s.dividing, s.extra, s.untrue) for s in scores]
                cells += [str(n) for n in np.sum(counts, axis=0)] if name == who else [""] * 5
                print(f"| {' | '.join(cells)} |")


def failures(rows: Sequence[Row]) -> list[str]:
    """Say where the engine breaks its promise: an edge beyond the limit, a vertex that is missing or none."""
    found = []
    for row in rows:
        engine = row.scores[0]
        worst = max(engine.edges)
        if not worst <= PROMISE or engine.untrue or engine.missing:
            counts = f"{engine.untrue} vertices untrue, {engine.missing} missing"
            found.append(f"{row.group}, {row.kind}, {row.segments} segments: edges {worst:.1e} off, {counts}")
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the tables; 1 where the engine breaks its promise."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--groups", nargs="+", choices=list(GROUPS), default=CHOSEN)
    parser.add_argument("--segments", nargs="+", type=int, default=SIZES)
    parser.add_argument("--designs", type=int, default=1, help="designs of each group, kind and size")
    parser.add_argument("--write", action="store_true", help="put the tables into bench/README.md")
    options = parser.parse_args(arguments)
    tasks = [
        (group, kind, size, number)
        for kind in KINDS
        for group in options.groups
        for size in options.segments
        for number in range(options.designs)
    ]
    with published("accuracy", write=options.write):
        print(f"{machine()}; {cgal.described()}")
        rows = [measure(task) for task in tasks]
        print_quantiles(rows)
        print_designs(rows)
        complaints = failures(rows)
        verdict = f"broken in {len(complaints)} designs" if complaints else "kept in all designs"
        print(f"\nThe engine's limit for its edges, {PROMISE:g}, is {verdict}: {len(rows)} were drawn.")
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return int(bool(complaints))


if __name__ == "__main__":
    sys.exit(main())
