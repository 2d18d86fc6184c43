"""What a cross-check has found: figures with their limits, and the places of what failed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from voronoi_tiles.base.arrays import Complexes, Floats
from voronoi_tiles.base.errors import CheckError, UnknownNameError
from voronoi_tiles.raster.frame import Frame
from voronoi_tiles.raster.renderer import Provenance


class Marks(NamedTuple):
    """Where something is wrong: places in the plane (n,), and by how much (n,), both in units; inf: unknown."""

    place: Complexes
    excess: Floats

    def __repr__(self) -> str:
        return f"<Marks: {len(self.place)} places>"


NO_MARKS = Marks(np.zeros(0, complex), np.zeros(0))


@dataclass(frozen=True, eq=False, slots=True)
class Figure:
    """One result: of `checked` things, `wrong` failed; `marks` says where.

    `worst` is the largest deviation, and `limit` what it may reach, both in `unit`; where every place has a limit of
    its own, they are those of the place that comes nearest to its limit. None: nothing is measured. `basis` is what the
    limit follows from.
    """

    name: str
    what: str
    checked: int
    wrong: int
    worst: float | None
    limit: float | None
    unit: str
    basis: str
    marks: Marks = NO_MARKS

    @property
    def passed(self) -> bool:
        """Whether nothing is wrong."""
        return self.wrong == 0

    def document(self) -> dict[str, Any]:
        """The figure in the types of JSON, with the ten worst places."""
        order = np.argsort(-self.marks.excess, kind="stable")[:10]
        return {
            "name": self.name,
            "what": self.what,
            "checked": self.checked,
            "wrong": self.wrong,
            "worst": _finite(self.worst),
            "limit": _finite(self.limit),
            "unit": self.unit,
            "basis": self.basis,
            "passed": self.passed,
            "places": [[z.real, z.imag] for z in self.marks.place[order].tolist()],
        }


@dataclass(frozen=True, eq=False, slots=True, repr=False)
class CheckReport:
    """The figures of a cross-check, and who made the image.

    `frame` is the image's, over one cell; `source` is that of the design that was checked.
    """

    provenance: Provenance
    frame: Frame
    units: str
    source: str
    figures: tuple[Figure, ...]

    def __repr__(self) -> str:
        return f"<CheckReport: {'passed' if self.passed else 'failed ' + ', '.join(self.failures)}; {self.provenance}>"

    @property
    def passed(self) -> bool:
        """Whether the two stages agree."""
        return all(figure.passed for figure in self.figures)

    @property
    def failures(self) -> tuple[str, ...]:
        """The names of the figures that failed."""
        return tuple(figure.name for figure in self.figures if not figure.passed)

    def figure(self, name: str) -> Figure:
        """The figure of a name. Raises UnknownNameError."""
        for figure in self.figures:
            if figure.name == name:
                return figure
        names = ", ".join(figure.name for figure in self.figures)
        raise UnknownNameError(f"there is no figure {name!r}", remedy=f"Figures are {names}.")

    def document(self) -> dict[str, Any]:
        """The report in the types of JSON, as `voronoi-tiles check --json` prints it."""
        return {
            "passed": self.passed,
            "samples": [self.frame.width, self.frame.height],
            "sample_size": self.frame.pixel,
            "units": self.units,
            "renderer": self.provenance.renderer,
            "device": self.provenance.device,
            "precision": self.provenance.precision,
            "method": self.provenance.method,
            "fallback": self.provenance.fallback or None,
            "spot_checks": self.provenance.spots,
            "figures": [figure.document() for figure in self.figures],
        }


def _finite(value: float | None) -> float | None:
    """JSON knows no infinity."""
    return None if value is None or not math.isfinite(value) else value


def require_passed(check: CheckReport) -> None:
    """Raise CheckError where a cross-check has failed."""
    if not check.passed:
        raise CheckError(f"the outlines failed the cross-check: {', '.join(check.failures)}", check)
