"""Whole sheets through others' readers: the same size, the same contours, open and closed, nothing dropped."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import ezdxf
import numpy as np
import pytest
import svgelements
from ezdxf.entities import LWPolyline
from helpers.cad import (
    EXAMPLES,
    MM_PER_PX,
    curves_of_svg,
    deviation,
    inkscape_reads_dxf,
    librecad_reads_dxf,
    run,
    sampled,
)

from voronoi_tiles import Design, Job, Product
from voronoi_tiles.base.arrays import Complexes
from voronoi_tiles.fabrication.job_fields import Curves
from voronoi_tiles.paths.paths import ARC, Paths

ACCURACY = 0.005  # of a job, where it says nothing else; millimetres
DIGITS = 2e-6  # what the sixth digit of a file is worth, both coordinates
LIBRECAD_DOT = 25.4 / 1200  # it prints on a raster
LIBRECAD_SCALE = 2.2e-4  # and by so much too large, whatever it prints: 110.024 mm for 110, 191.029 for 190.991

JOBS = {
    "once": Job(sheet=(120.0, 90.0), margin=5.0, fit="clip"),
    "frame": Job(sheet=(160.0, 120.0), margin=5.0, fit="frame", rotate=12.0),
    "kerf": Job(sheet=(200.0, 160.0), margin=5.0, kerf=0.2, fillet=0.3),
    "tabs": Job(sheet=(160.0, 120.0), margin=5.0, tabs=0.4),
}
NAMES = ("p4-key", "pg-swallow")


class Written(NamedTuple):
    """A product in a file."""

    product: Product
    file: Path

    @property
    def text(self) -> str:
        """The content of the file."""
        return self.file.read_text(encoding="utf-8")

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of what is drawn."""
        left, bottom, right, top = Paths.concatenate([layer.paths for layer in self.product.drawing.layers]).bounds
        return right - left, top - bottom

    @property
    def resolution(self) -> float:
        """How far the sampled curves may be from the curves themselves, and twice: two sets of samples are compared."""
        # Lines and Bezier curves come back as they are, sampled in the same places; arcs as cubic curves.
        round_ = [layer.paths for layer in self.product.drawing.layers if (layer.paths.kind == ARC).any()]
        return 2 * max((deviation(sampled(paths), sampled(paths, 320)) for paths in round_), default=0.0)

    @property
    def curves(self) -> dict[str, tuple[list[Complexes], list[bool]]]:
        """For each layer its paths, sampled, and whether they are closed."""
        layers = self.product.drawing.layers
        return {layer.name: (sampled(layer.paths), layer.paths.closed.tolist()) for layer in layers}


def written(folder: Path, name: str, job: Job, form: str) -> Written:
    """Make and write a sheet."""
    product = Design.load(EXAMPLES / f"{name}.toml").tessellate().make(job, form)
    file = folder / f"{name}.{form}"
    with file.open("wb") as stream:
        product.write(stream)
    return Written(product, file)


def svg_curves(text: str, height: float) -> dict[str, list[tuple[Complexes, bool]]]:
    """What svgelements reads in a page's user units, which are millimetres."""
    read = curves_of_svg(text.replace('mm"', '"'), height * MM_PER_PX)
    return {layer: [(points / MM_PER_PX, closed) for points, closed in curves] for layer, curves in read.items()}


def compare(
    read: dict[str, list[tuple[Complexes, bool]]], sheet: Written, tolerance: float, shift: complex = 0j
) -> None:
    """Hold what was read against what was drawn: layers, numbers of paths, closed flags in order, and curves."""
    assert set(read) == set(sheet.curves)
    for layer, (curves, closed) in sheet.curves.items():
        assert [flag for _, flag in read[layer]] == closed
        assert deviation([points + shift for points, _ in read[layer]], curves) <= tolerance


@pytest.fixture(params=[(name, job) for name in NAMES for job in JOBS], ids="-".join)
def case(request: pytest.FixtureRequest) -> tuple[str, Job]:
    """A design and a job."""
    name, job = request.param
    return name, JOBS[job]


def test_svgelements_reads_the_same_svg(case: tuple[str, Job], tmp_path: Path) -> None:
    """The page in millimetres, every path with its flag."""
    sheet = written(tmp_path, *case, "svg")
    drawing = sheet.product.drawing
    document = svgelements.SVG.parse(io.StringIO(sheet.text), reify=True, ppi=96)
    # Its own millimetre has seven digits.
    assert document.width * MM_PER_PX == pytest.approx(drawing.width, rel=1e-6)
    assert document.height * MM_PER_PX == pytest.approx(drawing.height, rel=1e-6)
    compare(svg_curves(sheet.text, drawing.height), sheet, DIGITS + sheet.resolution)


def test_ezdxf_finds_nothing_to_mend(case: tuple[str, Job], tmp_path: Path) -> None:
    """No error, no repair, millimetres, as many polylines as paths, and their extents."""
    sheet = written(tmp_path, *case, "dxf")
    document = ezdxf.readfile(sheet.file)
    audit = document.audit()
    assert not audit.errors
    assert not audit.fixes
    assert document.units == ezdxf.units.MM
    paths = Paths.concatenate([layer.paths for layer in sheet.product.drawing.layers])
    entities = [entity for entity in document.modelspace() if isinstance(entity, LWPolyline)]
    assert len(entities) == len(document.modelspace()) == len(paths)
    assert [entity.closed for entity in entities] == paths.closed.tolist()
    low, high = document.header["$EXTMIN"], document.header["$EXTMAX"]
    assert np.allclose((low[0], low[1], high[0], high[1]), paths.bounds, atol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("job", JOBS)
def test_inkscape_keeps_the_svg(job: str, tmp_path: Path) -> None:
    """Opened and saved by Inkscape, headless: the same page and curves, exact ones as well."""
    sheet = written(tmp_path, "pg-swallow", JOBS[job], "svg")
    target = tmp_path / "saved.svg"
    done = run("inkscape", "--export-type=svg", f"--export-filename={target}", str(sheet.file), home=tmp_path)
    assert target.exists(), done.stderr
    text = target.read_text(encoding="utf-8")
    drawing = sheet.product.drawing
    document = svgelements.SVG.parse(io.StringIO(text), reify=True, ppi=96)
    assert document.width * MM_PER_PX == pytest.approx(drawing.width, rel=1e-6)  # as above
    # It writes eight digits, each point relative to the one before.
    compare(svg_curves(text, drawing.height), sheet, 1e-5 + sheet.resolution)


@pytest.mark.slow
@pytest.mark.parametrize("curves", ["arc", "spline"])
@pytest.mark.parametrize("job", JOBS)
def test_inkscape_imports_the_dxf(job: str, curves: Curves, tmp_path: Path) -> None:
    """By its own importer: one path for each of ours; those of splines are open, and end where they begin."""
    sheet = written(tmp_path, "p4-key", replace(JOBS[job], curves=curves), "dxf")
    read = inkscape_reads_dxf(sheet.file)
    if curves == "spline":
        read = {
            layer: [(points, closed or abs(points[0] - points[-1]) < 1e-9) for points, closed in own]
            for layer, own in read.items()
        }
    # It puts the drawing's lower left corner where it likes: at the corner of what it has read.
    everything = np.concatenate([points for layer in read.values() for points, _ in layer])
    ours = np.concatenate([points for layer, _ in sheet.curves.values() for points in layer])
    corner = complex(everything.real.min(), everything.imag.min())
    shift = complex(ours.real.min(), ours.imag.min()) - corner
    compare(read, sheet, 1e-4, shift)


@pytest.mark.slow
@pytest.mark.parametrize("job", ["once", "kerf"])
def test_librecad_draws_the_dxf(job: str, tmp_path: Path) -> None:
    """Printed in full size: within two dots of its raster and what its prints are too large, and nothing is missing."""
    sheet = written(tmp_path, "p4-key", JOBS[job], "dxf")
    read = librecad_reads_dxf(sheet.file)
    ours = [points for layer, _ in sheet.curves.values() for points in layer]
    corner = [complex(np.concatenate(c).real.min(), np.concatenate(c).imag.min()) for c in (read, ours)]
    limit = 2 * LIBRECAD_DOT + LIBRECAD_SCALE * abs(complex(*sheet.size))
    assert deviation([points - corner[0] + corner[1] for points in read], ours) <= limit


@pytest.mark.parametrize("form", ["svg", "dxf"])
def test_the_comparison_sees_what_is_missing(form: str, tmp_path: Path) -> None:
    """A path left out, one opened, one moved by a hundredth of a millimetre."""
    sheet = written(tmp_path, "p4-key", JOBS["once"], form)
    good = {layer: list(zip(curves, closed, strict=True)) for layer, (curves, closed) in sheet.curves.items()}
    compare(good, sheet, DIGITS)
    (layer,) = good
    first, *rest = good[layer]
    broken = [rest, [(first[0], not first[1]), *rest], [(first[0] + 0.01, first[1]), *rest]]
    for rows in broken:
        with pytest.raises(AssertionError):
            compare({layer: rows}, sheet, DIGITS)
