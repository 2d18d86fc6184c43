#!/usr/bin/env bash
# ezdxf 1.4.5 says that a DXF file without a header is drawn in metres.
#
# Expected: where a file states no unit, the reader says that none is stated: 0, "unitless", which $INSUNITS has for that.
# Seen: ezdxf.read of a file that has no section HEADER gives a document whose header holds $INSUNITS = 6 (metres), with no
# sign that the file did not say so; with a header that lacks the variable, its `units` are 0. Many scripts, and OpenSCAD,
# write files without a header, and mean millimetres: whoever asks the document for its unit makes them a thousand times
# too large.
# voronoi_tiles reads the header's own tags, and says "the file declares no unit".
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
line = "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n0\n10\n0\n20\n0\n11\n3\n21\n2\n0\nENDSEC\n0\nEOF\n"
header = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n0\nENDSEC\n"
found = {}
for name, text in (("no header", line), ("a header without $INSUNITS", header + line)):
    document = ezdxf.read(io.StringIO(text))
    found[name] = (document.header.get("$INSUNITS"), document.units)
    print(f"{name}: $INSUNITS {found[name][0]}, units {found[name][1]}")
assert found["no header"] == (6, 6), "a file without a header has another unit now"
assert found["a header without $INSUNITS"] == (None, 0)
PYTHON
echo "as described"
