"""How far tiles are drawn in at each height."""

from __future__ import annotations

from typing import Final, NamedTuple, Self

from voronoi_tiles.designs.design import Design
from voronoi_tiles.solid.loft import ACCURACY_MM
from voronoi_tiles.solid.motion import Motion
from voronoi_tiles.solid.solid_job import SolidJob

_FINER: Final = 8
"""How many times finer than a clearance or a chamfer the accuracy is where nobody says; a count."""


class InsetDepth(NamedTuple):
    """By how much tiles are drawn in, in millimetres: by `half` a clearance, and by a `chamfer` more at both ends.

    What has a clearance is half the `accuracy` further in, and walls are within as much of there: nothing is nearer
    than asked. Without one walls are within the `accuracy`. The solid is `height` high.
    """

    half: float
    chamfer: float
    accuracy: float
    height: float

    @classmethod
    def of(cls, design: Design, job: SolidJob) -> Self:
        """What a job asks of a design that stands. Raises JobError where rims leave nothing of it."""
        height = Motion.of(design).height * design.unit_mm
        job.refuse_rims(height)
        widths = [width for width in (job.clearance, job.chamfer) if width > 0.0]
        finest = min(ACCURACY_MM, *(width / _FINER for width in widths))
        return cls(job.clearance / 2, job.chamfer, finest if job.accuracy is None else job.accuracy, height)

    def rim(self, z: float) -> float:
        """By how much the rims are further in at a height: they run at 45 degrees."""
        return max(self.chamfer - z, self.chamfer - (self.height - z), 0.0)

    def at(self, z: float) -> float:
        """How far from the exact tile's edge walls are meant to be at a height."""
        return self.half + self.rim(z) + (self.slack if self.half > 0.0 else 0.0)

    @property
    def slack(self) -> float:
        """How far walls may be from there."""
        return self.accuracy / 2 if self.half > 0.0 else self.accuracy
