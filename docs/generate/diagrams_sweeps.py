"""The designs that the sweep of docs/sweeps.md keeps, as its contact sheet."""

from __future__ import annotations

import diagrams_style

import voronoi_tiles as vt
from voronoi_tiles.sweeps.sweep import Sweep

SWEEP = diagrams_style.PICTURES.parents[1] / "examples" / "sweeps" / "birds.toml"


def write() -> None:
    """Write the picture."""
    vt.sweep(Sweep.load(SWEEP)).save_sheet(diagrams_style.PICTURES / "sweep.svg")
