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
    """A finding on the part that is judged, wherever it holds: each pair of paths from the first of them."""
    paths = repeated.judged[list(one.paths)].tolist()
    begin = subject.paths.start[subject.paths.offsets[:-1]]
    for turned in (paths, paths[::-1]) if one.mutual and len(set(paths)) > 1 else (paths,):
        if not repeated.is_judged(turned[0]):
            continue
        for image in repeated.images(*turned):
            if one.mutual and image[0] > image[-1]:
                continue
            shift = complex(begin[image[0]] - begin[turned[0]])
            other = None if one.other is None else one.other + shift
            yield one._replace(place=one.place + shift, paths=image, other=other)


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
