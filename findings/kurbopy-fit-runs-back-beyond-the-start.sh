#!/usr/bin/env bash
# kurbopy 0.13.1 (kurbo's fit_to_bezpath) fits a short bend and the straight line behind it by one cubic that runs back, far beyond the start.
#
# Expected: kurbo's documentation says that the result should in general be within the accuracy by the Frechet distance, that its error metric is
# approximate and no guarantee; so an excess of some percent. The run is smooth, with true tangents: a parabola of 0.02 that turns by a hundredth of
# a radian, and a line of 1 in the direction in which it ends. (kurbo's issue 604 has the like for fit_to_bezpath_opt and runs of lines.)
# Seen: one cubic, for an accuracy of 0.005 as for 0.001, whose second handle is 36 long and which runs back to 15 in front of the start; its
# ends and their directions are right. Where the line is no longer than the bend the fit is within the accuracy.
# Such runs are usual in outlines that are near a straight edge. voronoi_tiles has a fit of its own, with bounds; bench/cubics.py counts both.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check kurbopy==0.13.1
"$folder/venv/bin/python" - <<'PYTHON'
from importlib.metadata import version

import kurbopy

print("kurbopy", version("kurbopy"))
BEND = (0j, 0.01 + 0j, 0.02 + 0.0001j)


class Run:
    """A parabola, and a line of a length in its last direction; t from 0 to 1, in proportion to length."""

    def __init__(self, length):
        self.end = BEND[2] + length * (BEND[2] - BEND[1]) / abs(BEND[2] - BEND[1])
        self.share = abs(BEND[2]) / (abs(BEND[2]) + length)

    def at(self, t):
        a, b, c = BEND
        if t < self.share:
            u = t / self.share
            return a * (1 - u) ** 2 + 2 * b * u * (1 - u) + c * u**2, 2 * ((b - a) * (1 - u) + (c - b) * u) / self.share
        u = (t - self.share) / (1 - self.share)
        return c + (self.end - c) * u, (self.end - c) / (1 - self.share)

    def sample_pt_tangent(self, t, sign):
        return self.sample_pt_deriv(t)

    def sample_pt_deriv(self, t):
        point, along = self.at(t)
        return kurbopy.Point(point.real, point.imag), kurbopy.Vec2(along.real, along.imag)

    def break_cusp(self, start, end):
        return None


def off(length, accuracy):
    """How many cubics there are, and how far the farthest of their points is from the run."""
    run = Run(length)
    of_run = [run.at(k / 1000)[0] for k in range(1001)]
    worst, count = 0.0, 0
    for cubic in kurbopy.fit_to_bezpath(run, accuracy).segments():
        count += 1
        a, b, c, d = (complex(p.x, p.y) for p in (cubic.p0, cubic.p1, cubic.p2, cubic.p3))
        for k in range(201):
            t = k / 200
            s = 1 - t
            point = a * s**3 + 3 * b * s * s * t + 3 * c * s * t * t + d * t**3
            worst = max(worst, min(abs(point - other) for other in of_run))
    return count, worst


for length, accuracy in ((0.02, 0.005), (1.0, 0.005), (1.0, 0.001)):
    count, worst = off(length, accuracy)
    print(f"a line of {length:g}, accuracy {accuracy:g}: {count} cubic(s), {worst:.3g} off")
    assert (worst <= accuracy) == (length < 1.0) and (length < 1.0 or worst > 10.0), "no longer so"
PYTHON
echo "as described"
