"""MeerK40t: SVG, DXF and LightBurn's files, opened without a window and with the settings that it is installed with."""

import sys

from answer import answer, sampled
from meerk40t.core import core
from meerk40t.core.units import UNITS_PER_MM
from meerk40t.device import dummydevice
from meerk40t.dxf.plugin import plugin as dxf
from meerk40t.extra import lbrn
from meerk40t.kernel import Kernel

kernel = Kernel("MeerK40t", "", "MeerK40t", ansi=False, ignore_settings=True)
for plugin in (dummydevice.plugin, core.plugin, dxf, lbrn.plugin):
    kernel.add_plugin(plugin)
kernel(partial=True)
kernel.console("service device start dummy 0\n")
kernel.elements.load(sys.argv[1])
contours = []
for element in kernel.elements.elems():
    for part in element.as_geometry().as_contiguous():
        points = [part.segments[0][0]]
        for index in range(part.index):
            points += sampled(lambda t, part=part, index=index: complex(part.position(index, t)))
        contours.append(([point.conjugate() / UNITS_PER_MM for point in points], bool(part.is_closed())))
used_for = [operation.type.split()[-1] for operation in kernel.elements.ops() for _ in operation.children]
answer(contours, distribution="meerk40t", entities=used_for)
