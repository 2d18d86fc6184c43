"""Blender as a Python module: its importer of SVG, `bpy.ops.import_curve.svg`; its curves, exactly."""

import sys

import bpy
from answer import answer, sampled

bpy.ops.wm.read_factory_settings(use_empty=True)
import addon_utils

addon_utils.enable("io_curve_svg")
bpy.ops.import_curve.svg(filepath=sys.argv[1])
contours = []
for item in bpy.context.scene.objects:
    for spline in item.data.splines:
        knots = list(spline.bezier_points)
        pairs = list(zip(knots, knots[1:] + knots[:1], strict=True))
        points = [complex(*knots[0].co[:2])]
        for one, other in pairs if spline.use_cyclic_u else pairs[:-1]:
            a, b, c, d = (complex(*p[:2]) for p in (one.co, one.handle_right, other.handle_left, other.co))
            points += sampled(
                lambda t, a=a, b=b, c=c, d=d: a * (1 - t) ** 3 + 3 * t * (1 - t) * (b * (1 - t) + c * t) + d * t**3
            )
        # It works in metres.
        contours.append(([1000 * point for point in points], bool(spline.use_cyclic_u)))
answer(contours, distribution="bpy", entities=(type(item.data).__name__ for item in bpy.context.scene.objects))
