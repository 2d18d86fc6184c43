"""What is found on all lines of a drawing: what repeats is judged once, and its findings hold wherever it is."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from voronoi_tiles.preflight.chord_distance import distinct
from voronoi_tiles.preflight.cut_lines import CutLines, JudgedLines
from voronoi_tiles.preflight.findings import Finding, Limits
from voronoi_tiles.preflight.line_findings import TAB_SHARE, LineFinding, find_on_lines
from voronoi_tiles.preflight.surroundings import Repetition, surroundings

SAME: Final = 1e-3
"""By how much paths may differ that count as the same one, shifted; in tolerances. Files round to a tenth of that."""

_TWO_SIDES: Final = frozenset({"gap", "tab"})
"""What is found from the ends of two paths that face each other."""


def findings_everywhere(subject: CutLines, limits: Limits) -> Iterator[Finding]:
    """All findings on the lines of a subject that has at least one piece."""
    # Twice what is looked at: what is between lines that are near to each other is near to both.
    reach = 2 * max(limits.neck, limits.gap, (1 + TAB_SHARE) * (limits.tabs or 0.0), limits.feature)
    repeated = surroundings(subject.paths, reach, SAME * limits.tolerance)
    if repeated is None:
        found = list(find_on_lines(JudgedLines.of(subject.paths, limits), limits))
    else:
        part = JudgedLines.of(subject.paths.take(repeated.judged), limits)
        found = [image for one in find_on_lines(part, limits) for image in _images(subject, repeated, one)]
        found.sort(key=lambda one: one.value or 0.0 if one.mutual else 0.0)
    return (_finding(subject, one) for one in _once(found, limits))


def _images(subject: CutLines, repeated: Repetition, one: LineFinding) -> Iterator[LineFinding]:
    """A finding on the part that is judged, wherever it holds.

    It repeats with its first path, a mutual one with any of its paths that all others are near to: the first of these
    in the drawing leads.
    """
    paths = list(dict.fromkeys(repeated.judged[list(one.paths)].tolist()))
    leaders = paths[:1]
    if one.mutual:
        beside = [sum(other in repeated.beside(path) for other in paths) for path in paths]
        leaders = [path for path, count in zip(paths, beside, strict=True) if count == max(beside)]
    begin = subject.paths.start[subject.paths.offsets[:-1]]
    for leader in filter(repeated.is_judged, leaders):
        kept = [path for path in paths if path == leader or path in repeated.beside(leader)]
        for image in repeated.images(leader, *kept):
            there = dict(zip(kept, image[1:], strict=True))
            if there[leader] == min(there[path] for path in leaders if path in there):
                shift = complex(begin[there[leader]] - begin[leader])
                other = None if one.other is None else one.other + shift
                yield one._replace(place=one.place + shift, paths=image[1:], other=other)


def _once(found: list[LineFinding], limits: Limits) -> Iterator[LineFinding]:
    """The findings, gaps that are found from both sides once."""
    gaps = [k for k, one in enumerate(found) if one.kind in _TWO_SIDES]
    pairs = [(min(found[k].paths), max(found[k].paths)) for k in gaps]
    kept = distinct(pairs, np.array([found[k].place for k in gaps]), SAME * limits.tolerance)
    again = set(gaps) - {gaps[k] for k in kept}
    return (one for k, one in enumerate(found) if k not in again)


def _finding(subject: CutLines, one: LineFinding) -> Finding:
    """A finding as the file's own program shows it."""
    message = one.message
    if one.other is not None:
        x, y = subject.place(one.other)
        message = message.format(f"({x:.3f}, {y:.3f})")
    place, sources = subject.place(one.place), subject.sources(*one.paths)
    return Finding(one.kind, one.severity, message, one.remedy, place, one.value, sources)
