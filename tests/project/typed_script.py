"""A script as users write them, for mypy --strict and to be run: what is wrong says so, and is not run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import voronoi_tiles as vt


def design() -> vt.Design:
    """Points in all forms."""
    points = np.array([[6.0, 9.0], [22.0, 5.0], [27.0, 17.0]])
    strokes = [
        vt.segment(5 + 3j, (25, 11)),
        vt.polyline([0.5 + 20j, (1.5, 21), 3 + 22j], rotate=5),
        vt.catmull_rom(points, alpha=0.5, closed=False),
        vt.bspline(points[:, 0] + 1j * points[:, 1], closed=True, scale=0.5, translate=12 + 20j),
        vt.bezier([9 + 20j, 10 + 21j, 11 + 21j, 12 + 20j]),
        vt.hermite([14 + 20j, 15 + 21j], [1, 1j]),
        vt.circle((20, 20), 1),
        vt.point(9j, translate=(1, 0)),
        vt.path("M 1 1 C 2 3 4 3 5 1", scale=0.1, translate=20 + 14j),
    ]
    site = vt.Site(strokes, name="bird", tolerance=0.02, art=None)
    made = vt.Design("p4", cell=60, sites=[site], units="mm", name="bird")
    made.save("bird.toml")
    same: vt.Design = vt.Design.load(Path("bird.toml")).replace(name="bird").scaled(1.0).moved(rotate=0)
    assert same == made
    return vt.Design("p1", {"a": 60, "b": 50.0, "angle": 75}, site).replace(group="p4", cell=(60,), sites=made.sites)


def jobs() -> list[vt.Job]:
    """Lengths as numbers and texts, sheets as pairs, texts and paths, offsets as complex numbers and pairs."""
    return [
        vt.Job(),
        vt.Job(sheet=(300, 200), margin=5, kerf=0.15, fillet="0.5mm", tabs="0.02in"),
        vt.Job(sheet="30x20cm", offset=3 - 2j, rotate=15, fit="clip", edges="once"),
        vt.Job(sheet="300x200mm", offset=(3, "2mm"), gap=None, labels="number", marks=True, margin=8),
        vt.Job(sheet=Path("outline.svg"), preset="lightburn", colours="files", art="none"),
    ]


def run() -> None:
    """From a design to files, copies, figures and pictures."""
    tiling: vt.Tiling = design().tessellate()
    tile: vt.Tile = tiling["bird"]
    area: float = tile.area + sum(arc.end.real - arc.start.real for ring in tile.outline.rings for arc in ring)
    assert area > 0
    copies: list[vt.TileCopy] = tiling.copies((0, 0, 60, 60))
    names: set[tuple[str, vt.Operation]] = {(copy.site, copy.operation) for copy in copies}
    assert ("bird", vt.Operation.parse("x,y")) in names
    for written in tiling.export("bird.svg"):
        assert written.product is None
    job = jobs()[1]
    kerf: float = job.kerf
    gap: float | None = job.gap
    sheet: tuple[float, float] | str | None = job.sheet
    assert (kerf, gap, sheet) == (0.15, None, (300.0, 200.0))
    (exported,) = tiling.export("sheet.dxf", job=job)
    product: vt.Product | None = exported.product
    assert product is not None
    layers: tuple[vt.Layer, ...] = product.drawing.layers
    paths: vt.Paths = layers[0].paths
    assert len(paths) > 0
    assert tiling.report(job, speeds={"cut": 12.5})["time"] > 0
    findings: tuple[vt.Finding, ...] = vt.preflight("sheet.dxf", limits=vt.Limits(neck=0.0)).findings
    assert all(finding.severity != "error" for finding in findings)
    picture: vt.Rendering = tiling.render(size=(60, 40), renderer="cpu")
    provenance: vt.Provenance = vt.render(tiling.design, "bird.png", size=40, renderer="cpu", overlay=["cell"])
    assert picture.pixels.shape == (40, 60, 3)
    assert provenance.renderer == "cpu"
    report: vt.CheckReport = tiling.check(renderer="cpu", samples=64)
    figures: tuple[vt.Figure, ...] = report.figures
    assert all(figure.passed for figure in figures)
    drawing: vt.Drawing = vt.coupon(thickness="3mm", kerfs=[0.1, 0.2])
    assert drawing.width > 0
    try:
        tiling["tree"]
    except vt.UnknownNameError as error:
        remedy: str | None = error.remedy
    else:
        remedy = None
    assert remedy == "Sites are bird."


if TYPE_CHECKING:
    vt.Design("p4", cell="60", sites=[])  # wrong: arg-type
    vt.Design("p4", cell=60, sites=[vt.segment(0, 1)])  # wrong: list-item
    vt.Design("p4", cell=60, sites=[], units="furlong")  # wrong: arg-type
    vt.Site([vt.segment(0, 1)], title="bird")  # wrong: call-arg
    vt.circle(0, "2")  # wrong: arg-type
    vt.polyline(5)  # wrong: arg-type
    vt.Job(kerf=[0.15])  # wrong: arg-type
    vt.Job(fit="half")  # wrong: arg-type
    vt.Job(sheet=300)  # wrong: arg-type
    vt.Job(marks="yes")  # wrong: arg-type
    vt.render(design(), sise=40)  # wrong: call-overload
    design().tessellate().export("a.svg", edges="twice")  # wrong: arg-type
    jobs()[0].kerf = 0.1  # wrong: misc

if __name__ == "__main__":
    run()
