"""FreeCAD: its importers of SVG and DXF, without its window, run by the distribution's Python."""

import sys

sys.path[:0] = ["/usr/lib/freecad-python3/lib", "/usr/share/freecad/Ext", "/usr/share/freecad/Mod/Draft"]

import FreeCAD
import Part
from answer import answer, sampled

document = FreeCAD.newDocument()
if sys.argv[1].endswith("svg"):
    import importSVG

    importSVG.insert(sys.argv[1], document.Name)
else:
    # The older importer asks for a download.
    FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/Draft").SetBool("dxfUseLegacyImporter", False)
    import importDXF

    importDXF.insert(sys.argv[1], document.Name)
document.recompute()
shapes = [item.Shape for item in document.Objects if hasattr(item, "Shape")]
edges = [edge for shape in shapes for edge in shape.Edges]
contours = []
for chain in Part.sortEdges(edges):
    wire = Part.Wire(chain)
    points = []
    for edge in wire.OrderedEdges:
        knots = edge.Curve.getKnots() if hasattr(edge.Curve, "getKnots") else edge.ParameterRange
        along = [complex(*edge.valueAt(knots[0])[:2])]
        along += sampled(lambda t, edge=edge: complex(*edge.valueAt(t)[:2]), knots)
        points += along if edge.Orientation == "Forward" else along[::-1]
    contours.append((points, wire.isClosed()))
box = FreeCAD.BoundBox()
for shape in shapes:
    box.add(shape.BoundBox)
answer(
    contours,
    program_version=".".join(FreeCAD.Version()[:3]),
    entities=(shape.ShapeType for shape in shapes),
    size=(box.XLength, box.YLength),
)
