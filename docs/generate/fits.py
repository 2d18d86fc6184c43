"""The gallery of docs/fit.md: every outline of examples/fit among copies of the tile that comes nearest to it.

python docs/generate/fits.py        writes docs/fits/*.png, and the table of the page
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from running import ROOT, image_table

import voronoi_tiles as vt
from voronoi_tiles.pictures.contact_sheet import square_around

PAGE = ROOT / "docs/fit.md"
PICTURES = ROOT / "docs/fits"
MARK = re.compile(r"(?<=<!-- gallery -->\n).*?(?=<!-- end -->)", re.DOTALL)
SIZE = 480
"""The side of a picture; pixels."""


def main() -> None:
    """Fit, draw, and write the table into the page."""
    PICTURES.mkdir(exist_ok=True)
    rows = []
    for file in sorted((ROOT / "examples/fit").glob("*.svg")):
        with tempfile.TemporaryDirectory() as folder:
            made = Path(folder) / "fits"
            command = [sys.executable, "-m", "voronoi_tiles", "fit", str(file), "-o", str(made), "--keep", "1", "-q"]
            subprocess.run(command, check=True, cwd=folder)
            (row,) = json.loads((made / "index.json").read_text(encoding="utf-8"))
            design = vt.Design.load(made / row["design"])
            region = square_around(design.tessellate()[0].bounds, 2.9)
            design.save(made / "design.toml")
            picture = PICTURES / f"{file.stem}.png"
            overlay = ("art",) if design.art[0] is not None else ("outline",)
            vt.render(design, picture, size=SIZE, region=region, overlay=overlay, renderer="cpu")
        caption = f"{file.stem}: {row['group']}, overlap {row['overlap']:.3f}"
        rows.append((file.stem, f"fits/{picture.name}", caption))
        print(caption)
    page = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(MARK.sub(lambda _: image_table(rows, 3) + "\n", page), encoding="utf-8")


if __name__ == "__main__":
    main()
