#!/usr/bin/env bash
# svgpathtools 1.8.0 writes a closed path without its closepath command.
#
# Expected: a path read from "M 0,0 L 10,0 L 10,10 Z" is written with its Z, since `isclosed()` says True: without it a
# viewer joins nothing at the start (the corner has two butt ends), and CAD programs take it for an open polyline.
# Seen: `d()` writes a line back to the start and no Z, and so do the files of `wsvg`; `d(use_closed_attrib=True)` has it.
# In voronoi_tiles the strokes of a site are the same either way, and preflight goes by the ends' places.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check svgpathtools==1.8.0
cd "$folder"
venv/bin/python - <<'PYTHON'
from importlib.metadata import version
from pathlib import Path
from xml.etree import ElementTree

from svgpathtools import parse_path, wsvg

data = "M 0,0 L 10,0 L 10,10 Z"
path = parse_path(data)
print("svgpathtools", version("svgpathtools"))
print("read:", data, "| isclosed():", path.isclosed())
written = path.d()
print("d():", written, "| d(use_closed_attrib=True):", path.d(use_closed_attrib=True))
wsvg([path], filename="triangle.svg")
found = [node.get("d") for node in ElementTree.parse(Path("triangle.svg")).iter() if node.tag.endswith("path")]
print("wsvg():", *found)
assert path.isclosed()
assert "Z" not in written.upper(), "d() closes paths now"
assert path.d(use_closed_attrib=True).endswith("Z")
assert len(found) == 1, found
assert "Z" not in found[0].upper(), "wsvg() closes paths now"
PYTHON
echo "as described"
