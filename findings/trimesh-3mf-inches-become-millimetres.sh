#!/usr/bin/env bash
# trimesh 5.2.0 reads the unit of a 3MF file, and writes another one with the same numbers.
#
# Expected: a 3MF file carries its unit, trimesh keeps it as `units`, so what is loaded and exported again is as large as
# before.
# Seen: a cube of one inch is loaded with the edge 1 and the units "inch"; its export says unit="millimeter" and keeps the
# number 1, so the cube is 25.4 times smaller for every reader. No warning, also for meshes whose `units` are set by hand.
# Whoever passes prints in inches through trimesh calls `convert_units("millimeters")` first. voronoi_tiles uses trimesh in
# its tests alone, to read.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    trimesh==5.2.0 numpy==2.4.6 lxml==6.1.1 networkx==3.6.1
cd "$folder"
"$folder/venv/bin/python" - <<'PYTHON'
import re
import zipfile
from importlib.metadata import version
from itertools import product

import trimesh

print("trimesh", version("trimesh"))
MODEL = "3D/3dmodel.model"
OPEN = "http://schemas.openxmlformats.org/package/2006"
corners = list(product((0, 1), repeat=3))
sides = ((1, 3, 2, 0), (6, 7, 5, 4), (4, 5, 1, 0), (3, 7, 6, 2), (2, 6, 4, 0), (5, 7, 3, 1))
faces = [triangle for a, b, c, d in sides for triangle in ((a, b, c), (a, c, d))]
vertices = "".join('<vertex x="{}" y="{}" z="{}"/>'.format(*corner) for corner in corners)
triangles = "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*face) for face in faces)
with zipfile.ZipFile("cube.3mf", "w") as package:
    package.writestr(
        "[Content_Types].xml",
        f'<Types xmlns="{OPEN}/content-types">'
        '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
        '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>',
    )
    package.writestr(
        "_rels/.rels",
        f'<Relationships xmlns="{OPEN}/relationships"><Relationship Target="/{MODEL}" Id="model" '
        'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>',
    )
    package.writestr(
        MODEL,
        '<model unit="inch" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
        f'<object id="1" type="model"><mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>'
        '</object></resources><build><item objectid="1"/></build></model>',
    )
scene = trimesh.load("cube.3mf")
print(f"loaded:   units {scene.units}, extents {scene.extents.tolist()}, volume {scene.to_mesh().volume:g}")
scene.export("again.3mf")
unit = re.search(rb'unit="(\w+)"', zipfile.ZipFile("again.3mf").read(MODEL))[1].decode()
again = trimesh.load("again.3mf")
print(f"exported: units {unit}, extents {again.extents.tolist()}")
assert (scene.units, scene.extents.tolist()) == ("inch", [1.0, 1.0, 1.0])
assert (unit, again.extents.tolist()) == ("millimeter", [1.0, 1.0, 1.0]), "the unit or the size is kept now"
scene.convert_units("millimeters").export("converted.3mf")
converted = trimesh.load("converted.3mf")
print(f"after convert_units: extents {converted.extents.round(6).tolist()}")
assert abs(converted.extents - 25.4).max() < 1e-6
PYTHON
echo "as described"
