"""The pictures of docs/blender.md, as Blender renders them by the processor: some minutes.

python docs/generate/blender_pictures.py    writes docs/pictures/blender-*.png; Blender by `make blender-programs`
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Final

from PIL import Image, ImageFilter

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from helpers.blender import ROOT, make_extension

TWIST: Final = """\
schema = 1
group = "p4"

[cell]
a = 60.0

[[site]]
name = "twist"
strokes = [{ segment = [[8, 10], [22, 17]] }]
"""

SIZE: Final = (420, 280)
"""The width and height of a picture; pixels."""

COLOURS: Final = 64
"""Colours of a picture; a count: they are small so, and look the same."""


def main() -> None:
    """Render, and write the pictures."""
    with tempfile.TemporaryDirectory() as folder:
        twist = Path(folder) / "twist.toml"
        twist.write_text(TWIST)
        puzzle = ROOT / "examples" / "p3-puzzle.toml"
        _, own = make_extension(Path(folder), Path(folder)).run("pictures", str(puzzle), str(twist))
        for picture in own.glob("*.png"):
            smooth = Image.open(picture).convert("RGB").filter(ImageFilter.MedianFilter(3))
            small = smooth.resize(SIZE, Image.Resampling.LANCZOS)
            small.quantize(COLOURS, dither=Image.Dither.NONE).save(
                ROOT / "docs" / "pictures" / f"blender-{picture.name}", optimize=True
            )


if __name__ == "__main__":
    main()
