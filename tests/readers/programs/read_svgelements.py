"""svgelements: the paths of an SVG file, in pixels of 1/96 inch as the page says."""

import sys

import svgelements
from answer import PX, answer, sampled

document = svgelements.SVG.parse(sys.argv[1], reify=True, ppi=96)
paths = list(document.elements(lambda element: isinstance(element, svgelements.Path)))
contours = []
for path in paths:
    for part in path.as_subpaths():
        segments = [segment for segment in part if not isinstance(segment, svgelements.Move)]
        along = [point for segment in segments for point in sampled(lambda t, s=segment: complex(*s.point(t)))]
        points = [complex(*part[0].end), *along]
        contours.append(([PX * point.conjugate() for point in points], isinstance(segments[-1], svgelements.Close)))
answer(
    contours,
    distribution="svgelements",
    entities=(type(segment).__name__ for path in paths for segment in path),
)
