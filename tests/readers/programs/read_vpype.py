"""vpype: `vpype read` of SVG; it makes lines of all curves, here 0.01 mm long."""

import sys

import vpype
from answer import PX, answer

document = vpype.read_multilayer_svg(sys.argv[1], quantization=0.01 / PX)
lines = [line for layer in document.layers.values() for line in layer]
contours = [((PX * line.conjugate()).tolist(), bool(line[0] == line[-1])) for line in lines]
answer(contours, distribution="vpype", entities=("segment" for line in lines for _ in line[1:]))
