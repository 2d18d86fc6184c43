"""resvg by its Python binding: SVG as a picture, drawn at 2,540 pixels an inch; its dark pixels."""

import io
import sys
from pathlib import Path

import numpy as np
import resvg_py
from answer import answer
from PIL import Image

DPI = 2540
picture = resvg_py.svg_to_bytes(svg_string=Path(sys.argv[1]).read_text(encoding="utf-8"), dpi=DPI)
image = Image.open(io.BytesIO(bytes(picture)))
rows, columns = np.nonzero(np.asarray(image)[:, :, 3] >= 128)
points = (columns + 0.5 - 1j * (rows + 0.5)) * 25.4 / DPI
size = tuple(25.4 / DPI * side for side in image.size)
answer([(points.tolist(), False)], distribution="resvg_py", entities=("picture",), size=size, counted=False)
