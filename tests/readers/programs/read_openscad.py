"""OpenSCAD: `import("FILE");` of SVG and DXF, written as the polygons that it works with."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

from answer import answer

with tempfile.TemporaryDirectory() as folder:
    program, made = Path(folder, "import.scad"), Path(folder, "made.svg")
    program.write_text(f'import("{Path(sys.argv[1]).resolve()}");\n', encoding="utf-8")
    subprocess.run(
        ["openscad", "-o", made, program], capture_output=True, check=False
    )  # what it cannot read gives no file
    text = made.read_text(encoding="utf-8") if made.exists() else ""
contours = []
for ring in re.findall(r"M ([^Mz]*) z", text):
    points = [complex(*map(float, point.split(","))).conjugate() for point in ring.replace("L", " ").split()]
    contours.append((points, True))
said = subprocess.run(["openscad", "--version"], capture_output=True, text=True, check=True).stderr
answer(contours, program_version=said.split()[-1], entities=("vertex" for points, _ in contours for _ in points))
