#!/usr/bin/env bash
# svgpathtools 1.8.0 refuses an arc that ends where it begins, which SVG says to leave out.
#
# Expected: SVG 1.1, F.6.2, says that an arc whose end points are identical is left out. Zero radii, the other special
# case of that section, are read as a line.
# Seen: an AssertionError without a text, that names neither the file nor the place; the path is not read at all.
# Rounding in drawing programs makes such arcs. voronoi_tiles reads them as nothing, in designs and in drawings.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check svgpathtools==1.8.0
"$folder/venv/bin/python" -W ignore - <<'PYTHON'
from importlib.metadata import version

from svgpathtools import parse_path

print("svgpathtools", version("svgpathtools"))
line = parse_path("M 0 0 A 0 5 0 0 0 3 3 L 9 9").d()
print("radius 0:", line)
assert "L 3.0,3.0" in line
data = "M 0 0 A 5 5 0 0 0 0 0 L 9 9"
try:
    print("no length:", parse_path(data).d())
except AssertionError as error:
    print("no length: AssertionError", repr(str(error)))
else:
    raise SystemExit("it is read now")
PYTHON
echo "as described"
