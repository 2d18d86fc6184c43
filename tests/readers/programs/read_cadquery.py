"""CadQuery: `cadquery.importers.importDXF`, and the faces that it makes of the contours."""

import sys

from answer import answer, sampled
from cadquery import importers

faces = importers.importDXF(sys.argv[1]).faces().vals()
contours = []
for face in faces:
    for wire in (face.outerWire(), *face.innerWires()):
        points = []
        for edge in wire.Edges():
            curve = edge._geomAdaptor()
            knots = (curve.FirstParameter(), curve.LastParameter())
            if edge.geomType() == "BSPLINE":
                spline = curve.BSpline()
                knots = [spline.Knot(k) for k in range(1, spline.NbKnots() + 1)]
            along = [complex(curve.Value(knots[0]).X(), curve.Value(knots[0]).Y())]
            along += sampled(lambda t, curve=curve: complex(curve.Value(t).X(), curve.Value(t).Y()), knots)
            points.append(along if edge.wrapped.Orientation() == 0 else along[::-1])
        contours.append(([point for along in points for point in along], wire.IsClosed()))
answer(
    contours,
    distribution="cadquery",
    entities=(f"face with {len(face.innerWires())} holes" for face in faces),
    area=sum(face.Area() for face in faces),
)
