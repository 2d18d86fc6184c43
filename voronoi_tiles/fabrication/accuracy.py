"""How the accuracy of a job is spent: what each step on the way to the file may move curves by."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Self

from voronoi_tiles.fabrication.job import Job, JobError
from voronoi_tiles.formats.gcode.writer import ROUNDING_MM
from voronoi_tiles.formats.presets import Format

_SHORT: Final = 0.2
"""What leaving out short segments may take of what chords leave. Fits leave joints at which tangents differ by some
hundredths of a radian; an offset by a tenth of a millimetre makes arcs of some micrometres of them. The tip beside an
arc of the length L about a corner is L^2 / 8 d off, at an offset by d: half a micrometre for 0.01 mm at 0.025 mm."""

_CHORDS: Final = 0.7
"""What chords may take, a part of the whole. They get most: their number grows with the root of it, that of arcs only
with the third root."""

_CUBICS: Final = 0.99
"""What cubic curves may take, a part of the whole. Arcs that they replace are not seen: they may be many, so near to
the exact curve that cubic curves fitted to them are as few as if they were fitted to that or to its exact offset."""

_MEASURED: Final = 0.125
"""How far chords are from contours where the distance between these is measured, a part of the whole."""


@dataclass(frozen=True, slots=True)
class AccuracyBudget:
    """What of the `whole` accuracy each step spends; millimetres.

    Curves become arcs within `arcs`: those of tiles where the job has kerf or fillets or the file holds arcs, those of
    sheets and of art where they are clipped. Kerf and fillets spend nothing: an offset of arcs is exact, and what lies
    within e of a curve lies at any distance from both within e again. Then short segments are left out, within `short`.
    Where the file holds polylines, chords within `chords` take the place of curves, and where it holds the fewest cubic
    curves, these, within `cubics`. Errors add up: the four come to the whole, or less. For G-code, whose numbers are
    coarse, the whole is what rounding leaves of the accuracy asked for. Nothing else is approximated, but that the
    cubic curves of SVG and PDF are a nanometre off circular arcs, which is the last digit of these files.
    """

    whole: float
    arcs: float
    short: float
    chords: float
    cubics: float

    def __post_init__(self) -> None:
        assert self.arcs + self.short + self.chords + self.cubics <= self.whole * (1 + 1e-12), (
            "more is spent than there is"
        )

    @classmethod
    def of(cls, job: Job, curves: str, form: Format = "svg") -> Self:
        """The budget of a job whose file has a format and holds these `curves`: exact, arc, cubic, spline or polyline.

        Raises JobError where the file's rounding leaves nothing of the accuracy.
        """
        whole = job.accuracy - (ROUNDING_MM if form == "gcode" else 0.0)
        if whole < ROUNDING_MM and form == "gcode":
            raise JobError(
                f"an `accuracy` of {job.accuracy:g} mm is finer than G-code's numbers",
                remedy=f"Give {2 * ROUNDING_MM:g} mm or more.",
            )
        chords = _CHORDS * whole if curves == "polyline" else 0.0
        cubics = 0.0 if curves != "cubic" else _CUBICS * whole
        left = whole - chords - cubics
        short = _SHORT * left if job.moves_contours else 0.0
        return cls(whole=whole, arcs=left - short, short=short, chords=chords, cubics=cubics)

    @property
    def measured(self) -> float:
        """How far chords may be from contours by which only the distances between these are measured."""
        return _MEASURED * self.whole
