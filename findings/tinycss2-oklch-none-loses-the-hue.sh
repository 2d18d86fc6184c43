#!/usr/bin/env bash
# tinycss2 1.5.1 (color4, color5) sets the hue of lch() and oklch() to none where their lightness is none.
#
# Expected: `none` stands for the one component that it is written for: oklch(none 0.1 120) has the hue 120.
# Seen: the parsed colour has the hue none beside the lightness none. With the lightness given, `none` for the hue itself is
# read as a hue of 0. A drawing's green has no hue then.
# voronoi_tiles takes tinycss2 for the tokens and coloraide for the colours.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check tinycss2==1.5.1
"$folder/venv/bin/python" - <<'PYTHON'
from importlib.metadata import version

from tinycss2 import color4

print("tinycss2", version("tinycss2"))
found = {}
for text in ("oklch(0.5 0.1 120)", "oklch(none 0.1 120)", "oklch(0.5 0.1 none)", "lch(none 40 120)"):
    colour = color4.parse_color(text)
    found[text] = tuple(colour)
    print(text, "->", found[text])
assert found["oklch(0.5 0.1 120)"][2] == 120.0
assert found["oklch(none 0.1 120)"][2] is None, "the hue is kept now"
assert found["lch(none 40 120)"][2] is None, "the hue is kept now"
assert found["oklch(0.5 0.1 none)"][2] == 0.0, "a hue of none is none now"
PYTHON
echo "as described"
