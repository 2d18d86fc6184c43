#!/usr/bin/env bash
# tomlkit 0.15.2 keeps every comment, but after an edit they stand at other things than before.
#
# Expected: a comment on a line of its own is about what follows it. An item that is removed from an array takes the comment above it along; a key that
# is added to a table stands behind the table's last key.
# Seen: the comment above the removed item stays, now above the next item, which has one of its own. A key added to a table stands at the very end of
# what belongs to the table by TOML's rules: below the comment that the user wrote for the next table, right above its header.
# In voronoi_tiles the studio edits designs by a syntax tree of its own (voronoi_tiles/studio/toml_syntax.py), in which a comment belongs to what it
# stands beside or directly above; the text is read by tomllib before and after each edit.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check tomlkit==0.15.2
cd "$folder"
venv/bin/python - <<'PYTHON'
import tomlkit

print("tomlkit", tomlkit.__version__)

document = tomlkit.parse("""\
strokes = [
  # the wing
  { point = [1, 2] },
  # the tail
  { point = [3, 4] },
  # the eye
  { point = [5, 6] },
]
""")
del document["strokes"][1]
text = tomlkit.dumps(document)
print(text)
assert len(document.unwrap()["strokes"]) == 2
assert "  # the tail\n  # the eye\n  { point = [5, 6] },\n" in text, "the comment goes with its item now"

document = tomlkit.parse("""\
[cell]
a = 60

# the bird
[[site]]
name = "bird"
""")
document["cell"]["b"] = 50
text = tomlkit.dumps(document)
print(text)
assert document.unwrap()["cell"] == {"a": 60, "b": 50}
assert "a = 60\n\n# the bird\nb = 50\n" in text, "the key stands in its table now"
PYTHON
echo "as described"
