"""Owner by distance against owner by scan conversion, sample by sample."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from voronoi_tiles.base.arrays import Floats, Ints, first_least
from voronoi_tiles.crosscheck.check_report import Figure, Marks
from voronoi_tiles.crosscheck.subject import Codes, Subject
from voronoi_tiles.raster.reference import decode, encode
from voronoi_tiles.vector.scan import QUANTUM, owners


class Owners(NamedTuple):
    """The copy that owns each sample by distance, settled in float64 where the image's precision does not decide it.

    `identity` (height, width) indexes `codes`.
    """

    identity: NDArray[np.int32]
    codes: Codes


def compare_labels(subject: Subject) -> tuple[Owners, list[Figure]]:
    """The owners by distance, and the figures "labels", "coverage" and "area"."""
    image, pattern = subject.image, subject.pattern
    placed = [(subject.outlines[row.site], row.isometry) for row in pattern.placements]
    scanned = owners(placed, subject.grid)
    table = scanned.labels.copy()
    table[:, 1:] = scanned.labels[:, 1:] @ pattern.basis

    codes, inverse = np.unique(np.concatenate((encode(image.copies), encode(table))), return_inverse=True)
    names: NDArray[np.int32] = inverse.reshape(-1).astype(np.int32)
    raster: NDArray[np.int32] = names[: len(image.copies)][image.first]
    # A sample that no outline, or more than one, covers has the label -1: the last entry.
    vector: NDArray[np.int32] = np.append(names[len(image.copies) :], np.int32(-1))[scanned.label]

    limit = 2 * (subject.accuracy + subject.rounding) + 2 * QUANTUM * (abs(subject.frame.u) + abs(subject.frame.v))
    bound = 2 * image.error(image.d2)
    gap = image.d2 - image.d1
    open_question = gap <= np.maximum(bound, limit)
    row, column = np.nonzero(open_question | (raster != vector))
    undecided = open_question[row, column]
    wrong = raster[row, column] != vector[row, column]
    excess = np.where(wrong, gap[row, column], 0.0).astype(float)
    # The others are settled as well, for what follows: if the image is wrong, it is wrong here alone.
    settled, behind = _settle(subject, column, row, codes, vector[row, column])
    raster[row, column] = settled
    excess[undecided] = behind[undecided]
    wrong[undecided] = behind[undecided] > limit

    labels = Figure(
        "labels",
        "samples whose owner by distance is not the owner by outline",
        raster.size,
        int(wrong.sum()),
        float(excess[np.isfinite(excess)].max(initial=0.0)),
        limit,
        subject.units,
        "2 (accuracy + rounding), and 2^-23 of a sample for the scan; where the image's distances are within this, or "
        f"twice its error ({float(np.max(bound)):.2g} at most), float64 decides: {int(undecided.sum()):,} times",
        _marks(subject, column[wrong], row[wrong], excess[wrong]),
    )
    strays = np.flatnonzero((scanned.count != 1).ravel() | (scanned.label < 0).ravel())
    y, x = np.divmod(strays, subject.frame.width)
    coverage = Figure(
        "coverage",
        "samples that the copies' outlines do not cover exactly once",
        raster.size,
        len(strays),
        None,
        None,
        "",
        "winding numbers add up to 1",
        _marks(subject, x, y, np.full(len(x), np.inf)),
    )
    return Owners(raster, codes), [labels, coverage, _area(subject, raster, codes)]


def _settle(
    subject: Subject, column: Ints, row: Ints, codes: Codes, claimed: NDArray[np.int32]
) -> tuple[NDArray[np.int32], Floats]:
    """Find the owner of samples in float64, and how much farther the copy is that the outlines claim."""
    owner = np.full(len(column), -1, np.int32)
    behind = np.full(len(column), np.inf)
    for judge, index in subject.split(column, row):
        x, y = column[index] - judge.frame.column, row[index] - judge.frame.row
        near = judge.near(x.astype(float), y.astype(float))
        first = first_least(near.distance, near.point, len(index))
        owner[index] = np.searchsorted(codes, near.copy[first])
        claim = np.where(claimed[index] >= 0, codes[claimed[index]], -1)
        theirs = near.copy == claim[near.point]
        point = near.point[theirs]
        behind[index[point]] = near.distance[theirs] - near.distance[first[point]]
    return owner, behind


def _area(subject: Subject, owner: NDArray[np.int32], codes: Codes) -> Figure:
    """The area of each tile by counting samples: too coarse to decide anything, and so it never does."""
    pattern = subject.pattern
    site_of = np.array([placement.site for placement in pattern.placements])
    counts = np.bincount(owner.ravel(), minlength=len(codes))
    by_site = np.bincount(site_of[decode(codes)[:, 0]], weights=counts, minlength=len(pattern.sites))
    deviations = []
    copies = np.bincount(site_of, minlength=len(pattern.sites)).tolist()
    for outline, per_cell, count in zip(subject.outlines, copies, by_site.tolist(), strict=True):
        true = outline.area * per_cell
        deviations.append(abs(count * subject.frame.area_per_sample - true) / true)
    return Figure(
        "area",
        "tiles whose area differs from the number of their samples (for information)",
        len(deviations),
        0,
        max(deviations),
        None,
        "of the area",
        "no limit: a border of p samples moves it by about sqrt(p) samples",
    )


def _marks(subject: Subject, column: Ints, row: Ints, excess: Floats) -> Marks:
    return Marks(subject.frame.points(column.astype(float), row.astype(float)), excess)
