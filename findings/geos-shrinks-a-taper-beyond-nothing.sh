#!/usr/bin/env bash
# GEOS 3.14.1, through shapely 2.2.0, leaves something of a polygon that is shrunk by more than its largest disc.
#
# Expected: what `buffer(-d)` leaves of a polygon are the points that are at least d from its edge. Where d is more than the radius of the
# largest disc inside it, there are none; for a convex polygon with straight edges nothing is approximated.
# Seen: of a taper 1 wide and 50 long, cut off at the tip, whose largest disc has the radius 0.495, a triangle is left for each d up to a hundredth
# more. It grows with d, and its middle is a third nearer to the edge than d; beyond that it is gone.
# In voronoi_tiles preflight measures how wide a sliver is: what is left counts only where it is as deep inside as it was shrunk by.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check shapely==2.2.0
cd "$folder"
venv/bin/python - <<'PYTHON'
import shapely

taper = shapely.Polygon([(0, 0), (1, 0), (0.001, 50), (0, 50)])
radius = shapely.length(shapely.maximum_inscribed_circle(taper, tolerance=1e-7))
print("shapely", shapely.__version__, "GEOS", shapely.geos_version_string)
print(f"valid: {taper.is_valid}, radius of the largest disc: {radius:.6f}")
found = {}
for share in (1.002, 1.006, 1.0095, 1.012):
    left = taper.buffer(-share * radius)
    deep = 0.0 if left.is_empty else taper.boundary.distance(left.centroid) / (share * radius)
    found[share] = left.area
    print(f"shrunk by {share} of that: {left.geom_type} of the area {left.area:.3g}, its middle at {deep:.3f} of the distance from the edge")
    assert left.is_empty or deep < 0.98, "what is left lies as deep as it should now"
assert taper.is_valid
assert 0 < found[1.002] < found[1.006] < found[1.0095], "nothing is left beyond the largest disc now"
assert found[1.012] == 0
PYTHON
echo "as described"
