"""svgpathtools: the paths of an SVG file; it leaves the page's size to the caller."""

import sys

from answer import PX, answer, sampled
from svgpathtools import svg2paths2

paths, _, page = svg2paths2(sys.argv[1])
width = float(page["viewBox"].split()[2])
scale = {"mm": 1.0, "px": PX, "": PX}[page["width"].lstrip("0123456789.")] * float(page["width"].rstrip("mpx")) / width
contours, area = [], 0.0
for path in paths:
    for part in path.continuous_subpaths():
        points = [part[0].start, *(point for segment in part for point in sampled(segment.point))]
        contours.append(([scale * point.conjugate() for point in points], part.isclosed()))
        area += part.area() * scale**2
answer(
    contours,
    distribution="svgpathtools",
    entities=(type(segment).__name__ for path in paths for segment in path),
    area=abs(area),
)
