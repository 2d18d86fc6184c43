"""The pictures of docs/inkscape.md, made by the real Inkscape without a screen: `make inkscape-pictures`.

It takes Debian's inkscape, xvfb, xauth and xdotool.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Final

from PIL import Image, ImageGrab

from voronoi_tiles.inkscape.installation import FOLDER, own_files

PICTURES: Final = Path(__file__).parents[1] / "pictures"

COLOURS: Final = 32
"""How many colours the pictures have."""

WAIT_S: Final = 120
"""How long a program may take; seconds."""

DISPLAY: Final = ":78"

WINDOW: Final = (0, 0, 1000, 640)

KEYS: Final = '<keys name="own"><bind gaction="app.voronoi-tiles.tiles" keys="F10"/></keys>'
"""A key that shows the dialog."""

DRAWING: Final = f"""\
<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"
  xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"
  width="148mm" height="105mm" viewBox="0 0 148 105">
<sodipodi:namedview inkscape:window-width="{WINDOW[2]}" inkscape:window-height="{WINDOW[3]}" inkscape:window-x="0"
  inkscape:window-y="0" inkscape:window-maximized="0" inkscape:document-units="mm"/>
<g id="strokes" inkscape:groupmode="layer" inkscape:label="strokes" style="fill:none;stroke:#c0392b;stroke-width:0.7">
<path id="back" d="M 98 52 C 100 44 111 43 117 49"/>
<path id="wing" d="M 104 46.5 C 102 54 106 59 112 60"/>
</g></svg>
"""

SHEET: Final = {"group": "p3", "kerf": "0.15", "colours": "fewest", "stroke": "0.4mm", "margin": "3"}


def home(folder: Path) -> dict[str, str]:
    """A home with the entries installed, and the environment of somebody who lives there."""
    user = folder / ".config" / "inkscape"
    (user / "extensions" / FOLDER).mkdir(parents=True)
    (user / "keys").mkdir()
    for name, data in own_files(sys.executable, {}).items():
        (user / "extensions" / FOLDER / name).write_bytes(data)
    (user / "keys" / "default.xml").write_text(KEYS, encoding="utf-8")
    values = {"voronoi-tiles.tiles.group": "p3", **{f"voronoi-tiles.sheet.{name}": v for name, v in SHEET.items()}}
    said = " ".join(f'{name}="{value}"' for name, value in values.items())
    (user / "preferences.xml").write_text(
        f'<inkscape version="1"><group id="extensions" {said}/></inkscape>', encoding="utf-8"
    )
    (folder / "drawing.svg").write_text(DRAWING, encoding="utf-8")
    return {**os.environ, "HOME": str(folder), "PATH": "/usr/bin:/bin", "DISPLAY": DISPLAY}


def main() -> None:
    """Start a screen of our own, and go through the entries on it."""
    screen = subprocess.Popen(["/usr/bin/Xvfb", DISPLAY, "-screen", "0", f"{WINDOW[2]}x{WINDOW[3]}x24"])
    try:
        with tempfile.TemporaryDirectory() as folder:
            pictures(Path(folder), home(Path(folder)))
    finally:
        screen.terminate()


def pictures(folder: Path, there: dict[str, str]) -> None:
    """Make all of them."""

    def run(*words: str) -> None:
        subprocess.run(words, check=True, env=there, cwd=folder, timeout=WAIT_S, capture_output=True)

    chosen = "select-by-id:back,wing"
    for entry in ("tiles", "sheet"):
        actions = f"{chosen};voronoi-tiles.{entry}.noprefs;export-filename:{entry}.svg;export-do"
        run("inkscape", "--batch-process", f"--actions={actions}", "drawing.svg" if entry == "tiles" else "tiles.svg")
        assert f'vt:role="{entry}"' in (folder / f"{entry}.svg").read_text(encoding="utf-8")
        only = ("--export-id=voronoi-sheet", "--export-id-only") if entry == "sheet" else ()
        run("inkscape", f"--export-filename={entry}.png", "-d", "110", *only, "--export-area-page", f"{entry}.svg")
        keep(Image.open(folder / f"{entry}.png"), entry)
    with subprocess.Popen(
        ["/usr/bin/inkscape", "drawing.svg"], env=there, cwd=folder, stderr=subprocess.DEVNULL
    ) as window:
        try:
            run("xdotool", "search", "--sync", "--onlyvisible", "--name", "drawing.svg")
            time.sleep(5)
            for key in ("5", "ctrl+a", "F10"):
                run("xdotool", "mousemove", "700", "500", *(["click", "1"] if key == "5" else []), "key", key)
                time.sleep(3)
            run(
                "xdotool",
                "search",
                "--sync",
                "--onlyvisible",
                "--name",
                "Tiles from Selection",
                "windowmove",
                "8",
                "90",
            )
            time.sleep(2)
            run("xdotool", "mousemove", "24", "540", "click", "1")
            time.sleep(12)
            run("xdotool", "mousemove", "700", "600")
            time.sleep(2)
            keep(ImageGrab.grab(WINDOW, xdisplay=DISPLAY), "dialog")
        finally:
            window.terminate()


def keep(picture: Image.Image, name: str) -> None:
    """Save a picture, in so few colours that the file is small."""
    white = Image.new("RGB", picture.size, "white")
    white.paste(picture, mask=picture.getchannel("A") if picture.mode == "RGBA" else None)
    white.quantize(COLOURS).save(PICTURES / f"inkscape-{name}.png", optimize=True)


if __name__ == "__main__":
    main()
