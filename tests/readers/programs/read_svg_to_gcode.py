"""svg-to-gcode: the lines that it makes of SVG, as its G-code has them."""

import re
import sys
import tempfile
from pathlib import Path

from answer import answer
from svg_to_gcode.compiler import Compiler, interfaces
from svg_to_gcode.svg_parser import parse_file

compiler = Compiler(interfaces.Gcode, movement_speed=1000, cutting_speed=300, pass_depth=0)
compiler.append_curves(parse_file(sys.argv[1]))
with tempfile.TemporaryDirectory() as folder:
    made = Path(folder, "made.gcode")
    compiler.compile_to_file(str(made))
    text = made.read_text(encoding="utf-8")
contours: list[list[complex]] = []
burning = False
for line in text.splitlines():
    if line.startswith("M"):
        burning = line.startswith("M3")
    elif line.startswith("G1"):
        x, y = (float(re.search(rf"{axis}(\S+?);?(?: |$)", line)[1]) for axis in "XY")
        if burning:
            contours[-1:] = [[*contours[-1], complex(x, y)]]
        else:
            contours.append([complex(x, y)])
answer(
    ((points, points[0] == points[-1]) for points in contours),
    distribution="svg-to-gcode",
    entities=("G1" for points in contours for _ in points[1:]),
)
