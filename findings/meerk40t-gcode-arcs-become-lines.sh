#!/usr/bin/env bash
# MeerK40t 0.9.9100 runs every arc of a G-code file as the straight line between its ends.
#
# Expected: G2 and G3 with I and J, or R, lead along a circle to X and Y.
# Seen: X and Y are scaled to its own unit, of which 2,580 make a millimetre, I and J are not, and R is not looked at: the
# circle is 2,580 times too small, a dot at the start, from which one line leads to the end. A quarter of a circle of
# 10 mm is cut 2.9 mm inside of itself, and nothing is said.
# voronoi_tiles writes lines unless arcs are asked for; its documentation says to keep to them there.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check meerk40t==0.9.9100 numpy==2.4.6 pillow==12.3.0
HOME=$folder "$folder/venv/bin/python" -W ignore - <<'PYTHON'
import math
from importlib.metadata import version

from meerk40t.core.units import UNITS_PER_MM
from meerk40t.grbl.gcodejob import GcodeJob

print("meerk40t", version("meerk40t"))


class Recorder(GcodeJob):
    """What is cut, in millimetres."""

    def plot_location(self, x, y, power):
        self.x, self.y = x, y
        cut.append((x / UNITS_PER_MM, y / UNITS_PER_MM))


for arc in ("G2 X20 Y0 I0 J-10", "G2 X20 Y0 R10"):
    cut = []
    job = Recorder()
    for line in ("G21 G90", "G1 X10 Y10 S300 F600", arc):
        job.write(line + "\n")
    while not job.execute():  # a line at a time
        pass
    assert cut[0] == (10, 10), cut
    longest = max(math.dist(one, other) for one, other in zip(cut, cut[1:]))
    print(f"{arc} from 10,10: {len(cut) - 1} points; the longest line between them {longest:.3f} mm, of 14.142 in all")
    if longest < 14:
        raise SystemExit("it is another curve now")
PYTHON
echo "as described"
