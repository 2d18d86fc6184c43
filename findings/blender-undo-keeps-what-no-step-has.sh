#!/usr/bin/env bash
# Blender 5.0.1 (as the module bpy): undo takes back what was changed after the last step in one object, and keeps it in
# another.
#
# Expected: two objects are moved by a script after the last undo step; `ed.undo` goes to the step before, in which both
# have places of their own, and both are there.
# Seen: the object that differs between the two steps is read anew, and is where that step has it; the other one, which is
# equal in both steps, is not read, and keeps where the script has put it. So what an extension has changed by a timer,
# after the last step, is partly undone and partly not: its results may belong to another state than the drawing that they
# were made of. voronoi_tiles' extension makes all results anew after an undo.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3.11 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bpy==5.0.1
cd "$folder"
HOME="$folder" "$folder/venv/bin/python" - <<'PYTHON'
import bpy

print("Blender", bpy.app.version_string)
bpy.ops.wm.read_factory_settings(use_empty=True)
for name in ("still", "moved"):
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, None))


def step(name):
    """An undo step of what is there."""
    bpy.context.view_layer.update()
    bpy.ops.ed.undo_push(message=name)


step("one")
bpy.data.objects["moved"].location.x = 1
step("two")
# In no step:
bpy.data.objects["still"].location.x = 5
bpy.data.objects["moved"].location.y = 7
bpy.context.view_layer.update()
bpy.ops.ed.undo()
places = {name: tuple(bpy.data.objects[name].location) for name in ("still", "moved")}
print("after undo, both at (0, 0, 0) in step one:", places)
assert places == {"still": (5.0, 0.0, 0.0), "moved": (0.0, 0.0, 0.0)}, "undo treats both alike now"
PYTHON
echo "as described"
