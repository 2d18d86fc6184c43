"""ezdxf: the entities of a DXF file, in the unit that its header names."""

import sys

import ezdxf
from answer import answer
from ezdxf import path, units

document = ezdxf.readfile(sys.argv[1])
scale = units.conversion_factor(document.units, units.MM) if document.units else 1.0
entities = list(document.modelspace())
contours = [
    ([scale * complex(point.x, point.y) for point in curve.flattening(1e-5 / scale)], curve.is_closed)
    for curve in map(path.make_path, entities)
]
answer(contours, distribution="ezdxf", entities=(entity.dxftype() for entity in entities))
