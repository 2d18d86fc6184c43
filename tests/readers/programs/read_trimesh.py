"""trimesh: `trimesh.load_path` of SVG and DXF."""

import sys

import trimesh
from answer import answer

path = trimesh.load_path(sys.argv[1])
if path.units is not None:
    path.convert_units("millimeters")
# Splines are drawn through fewer points than other curves.
fine = 0.02 if any(isinstance(entity, trimesh.path.entities.BSpline) for entity in path.entities) else 0.2
flip = sys.argv[1].endswith("svg")
contours = []
for index in range(len(path.paths)):
    x, y = trimesh.path.traversal.discretize_path(path.entities, path.vertices, path.paths[index], scale=fine).T
    contours.append(((x + 1j * (-y if flip else y)).tolist(), bool(path.path_valid[index])))
answer(
    contours,
    distribution="trimesh",
    entities=(type(entity).__name__ for entity in path.entities),
    size=tuple(path.extents.tolist()),
    area=float(path.area),
)
