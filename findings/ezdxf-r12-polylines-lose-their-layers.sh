#!/usr/bin/env bash
# ezdxf 1.4.5 reads an LWPOLYLINE of a DXF file of version R12, or of none, without its layer, colour and closed flag.
#
# Expected: R12 has no LWPOLYLINE; a reader that takes one all the same takes all of it, or says that it does not.
# Seen: with the version AC1015 the entity is closed, red and on the layer CUT. The same tags in a file that says AC1009, or
# nothing, are read as an open, uncoloured polyline on the layer 0: its points are all there, and neither the reader nor
# audit() says anything. Scripts write such files, with the newer entity under the older number.
# voronoi_tiles hands ezdxf such files as R2000.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check ezdxf==1.4.5
"$folder/venv/bin/python" - <<'PYTHON'
import io
from importlib.metadata import version

import ezdxf

print("ezdxf", version("ezdxf"))
header = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\n{}\n0\nENDSEC\n"
polyline = (
    "0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n5\n2A\n100\nAcDbEntity\n8\nCUT\n62\n1\n100\nAcDbPolyline\n90\n3\n70\n1\n"
    "10\n0\n20\n0\n10\n30\n20\n0\n10\n0\n20\n20\n0\nENDSEC\n0\nEOF\n"
)
found = {}
for name, text in (("AC1015", header.format("AC1015")), ("AC1009", header.format("AC1009")), ("none", "")):
    document = ezdxf.read(io.StringIO(text + polyline))
    (entity,) = document.modelspace()
    complaints = len(document.audit().errors) + len(document.audit().fixes)
    found[name] = (entity.dxf.layer, entity.dxf.get("color"), entity.closed, len(entity), complaints)
    print("version {}: layer {}, colour {}, closed {}, {} points, {} complaints".format(name, *found[name]))
assert found["AC1015"][:4] == ("CUT", 1, True, 3)
for name in ("AC1009", "none"):
    assert found[name][3] == 3, "points are lost now"
    assert found[name][:3] == ("0", None, False), "layer, colour or flag are kept now"
PYTHON
echo "as described"
