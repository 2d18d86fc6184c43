"""LibreCAD: a DXF file printed in full size, as in the tests of whole sheets; its raster is 1200 dots an inch."""

import re
import shutil
import sys
import tempfile
from pathlib import Path

from answer import answer

sys.path.append(str(Path(__file__).parents[2]))

from helpers.cad import librecad_reads_dxf, run

with tempfile.TemporaryDirectory() as folder:
    read = librecad_reads_dxf(Path(shutil.copy(sys.argv[1], folder)))
said = run("dpkg-query", "--show", "--showformat=${Version}", "librecad").stdout
answer(
    ((points.tolist(), bool(points[0] == points[-1])) for points in read),
    program_version=re.sub(r"-.*", "", said),
    counted=False,
)
