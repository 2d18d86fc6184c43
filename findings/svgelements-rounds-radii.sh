#!/usr/bin/env bash
# svgelements 1.9.6 writes the coordinates of path data with 12 digits, but the radii of arcs with 6.
#
# Expected: a path that is read and written again is the same to the digits of its coordinates, in its radii too.
# Seen: between end points that keep all their digits the radius 500.06172835 comes out as 500.062. An arc is fixed by
# both, and a half circle is sensitive: its middle moves by half a millimetre on a chord of a metre.
# Files that pass through svgelements lose that much. voronoi_tiles writes circular arcs as cubic curves into SVG files, and
# uses svgelements in its tests alone, to read.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check svgelements==1.9.6
"$folder/venv/bin/python" - <<'PYTHON'
import math
import re
from importlib.metadata import version

from svgelements import Path

print("svgelements", version("svgelements"))
chord = 1000.1234567
radius = chord / 2
written = Path(f"M 0 0 A {radius} {radius} 0 0 1 {chord} 0").d()
print(f"read:    radius {radius}, chord {chord}")
print("written:", written)
rounded = float(re.search(r"A ([\d.]+),", written)[1])
moved = radius - (rounded - math.sqrt(rounded**2 - radius**2))
print(f"the middle of the arc has moved by {moved:.3f}")
assert str(chord) in written, "coordinates have fewer digits now"
assert rounded == 500.062, "radii have other digits now"
assert 0.5 < moved < 0.6
PYTHON
echo "as described"
