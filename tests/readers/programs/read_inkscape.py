"""Inkscape: SVG and PDF opened and saved by itself, DXF by its importer alone, as in the tests of whole sheets."""

import shutil
import sys
import tempfile
from pathlib import Path

from answer import answer

sys.path.append(str(Path(__file__).parents[2]))

from helpers.cad import A4_HEIGHT, curves_of_svg, inkscape_reads_dxf, inkscape_reads_pdf, run

with tempfile.TemporaryDirectory() as folder:
    file = Path(shutil.copy(sys.argv[1], folder))
    if file.suffix == ".dxf":
        read = inkscape_reads_dxf(file)
    elif file.suffix == ".pdf":
        read = inkscape_reads_pdf(file, A4_HEIGHT)
    else:
        made = file.with_suffix(".made.svg")
        run("inkscape", "--export-type=svg", f"--export-filename={made}", str(file), home=file.parent)
        read = curves_of_svg(made.read_text(encoding="utf-8"), A4_HEIGHT)
    said = run("inkscape", "--version", home=file.parent).stdout
answer(
    ((points.tolist(), closed) for curves in read.values() for points, closed in curves),
    program_version=said.split()[1],
    entities=(f"path on {layer}" for layer, curves in read.items() for _ in curves),
)
