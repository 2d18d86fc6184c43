"""The gallery: every example as a tile, a tessellation and a sheet, with the commands that made them.

    python docs/generate/gallery.py            writes docs/gallery.md and the pictures in docs/gallery/

What an example is says the comment at its head; what its sheet shows says the table here. The pictures are what the
commands of the page write, byte for byte.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from running import ROOT, Command, command_block, image_table, run_all

from voronoi_tiles import GROUPS

FOLDER = ROOT / "docs/gallery"
INPUTS = frozenset({"screen.toml", "heart.svg"})
"""What lies in docs/gallery and is read by the commands, not written."""

SCREEN = ("--preset", "docs/gallery/screen.toml")
SIZE = ("--sheet", "240x160mm")
MARGIN = ("--margin", "4mm")
# A sheet is shown 240 mm wide at most, and arcs within 0.02 mm make a tenth of the exact curves' file.
ARCS = ("--curves", "arc", "--accuracy", "0.02mm")


@dataclass(frozen=True, slots=True)
class Sheet:
    """What an example's sheet shows: a caption, and the options of `export` that make it."""

    caption: str
    options: tuple[str, ...]

    @property
    def arguments(self) -> tuple[str, ...]:
        """All options: the sheet is 240 x 160 mm unless it says another."""
        size = () if "--sheet" in self.options else SIZE
        return (*size, *self.options, *ARCS, *SCREEN)


ONCE = Sheet("whole tiles, shared edges cut once", MARGIN)
CLIP = Sheet("tiles clipped at the sheet's edge", ("--fit", "clip"))
FRAME = Sheet("whole tiles and the frame around them", ("--fit", "frame"))
KERF = Sheet("pieces of their true size, for a kerf of 0.2 mm", (*MARGIN, "--kerf", "0.2mm"))
FILLET = Sheet("pieces 1.5 mm apart with rounded corners", (*MARGIN, "--gap", "1.5mm", "--fillet", "1mm"))
COLOURS = Sheet("pieces by colour, a layer for each", (*MARGIN, "--gap", "0.8mm", "--colours", "layers"))
NUMBERS = Sheet("pieces with numbers", (*MARGIN, "--labels", "number", "--label-height", "5mm"))
NAMES = Sheet("pieces with the names of their sites", (*MARGIN, "--labels", "site", "--label-height", "4mm"))
TABS = Sheet(
    "clipped and cut once, with tabs of 1.5 mm that hold the pieces", ("--fit", "clip", "--tabs", "1.5mm", *MARGIN)
)
MARKS = Sheet(
    "marks for aligning, and a bar of 100 mm to measure the scale by", ("--margin", "14mm", "--marks", "--bar")
)
HEART = Sheet("clipped to a shape of one's own", ("--sheet", "docs/gallery/heart.svg", "--fit", "clip"))
TURNED = Sheet("turned by 30 degrees and clipped", ("--fit", "clip", "--rotate", "30"))

SHEETS: dict[str, Sheet] = {
    "cm-moth": FRAME,
    "cmm-scroll": CLIP,
    "p1-fish": CLIP,
    "p1-heron": ONCE,
    "p1-leaf": HEART,
    "p2-anchor": NUMBERS,
    "p2-drop": FILLET,
    "p2-lizard": FRAME,
    "p3-crescent": ONCE,
    "p3-mitten": KERF,
    "p3-puzzle": FRAME,
    "p3-trefoil": HEART,
    "p31m-gem": COLOURS,
    "p3m1-tripod": FRAME,
    "p4-hook": ONCE,
    "p4-key": TABS,
    "p4-mill": NAMES,
    "p4-pinwheel": TURNED,
    "p4g-fan": COLOURS,
    "p4m-rosette": CLIP,
    "p6-manta": CLIP,
    "p6-propeller": HEART,
    "p6-rosette": COLOURS,
    "p6-triskele": KERF,
    "p6m-flower": NAMES,
    "pg-elephant": ONCE,
    "pg-swallow": MARKS,
    "pg-wave": FILLET,
    "pgg-crane": CLIP,
    "pm-goblet": NAMES,
    "pmg-tulip": FRAME,
    "pmm-lantern": KERF,
    "art/swallow": Sheet("the art on every piece, clipped sheet", ("--fit", "clip")),
}
"""The sheet of every example, by its path in examples/ without the suffix; a missing one is an error."""


@dataclass(frozen=True, slots=True)
class Example:
    """An example design, by its path in examples/ without the suffix."""

    name: str

    @property
    def design(self) -> str:
        """Its path from the repository's root."""
        return f"examples/{self.name}.toml"

    @property
    def stem(self) -> str:
        """What the names of its pictures begin with."""
        return self.name.replace("/", "-")

    @property
    def group(self) -> str:
        """Its wallpaper group."""
        return str(self._keys["group"])

    @property
    def tile_caption(self) -> str:
        """What its first picture shows: the tiles of several sites lie side by side, as in the plane."""
        return "the tile" if len(self._keys["site"]) == 1 else "one of each tile, where they lie"

    @property
    def about(self) -> str:
        """The comment at its head, without the command."""
        lines = (ROOT / self.design).read_text(encoding="utf-8").splitlines()
        comment = [line.removeprefix("#").strip() for line in lines[: lines.index("")]]
        return " ".join(line for line in comment if not line.startswith("Export it:"))

    @property
    def sheet(self) -> Sheet:
        """What its sheet shows. Raises KeyError where SHEETS has none."""
        return SHEETS[self.name]

    @property
    def commands(self) -> tuple[Command, Command, Command]:
        """The commands that write the tile, the tessellation and the sheet."""
        export, render = ("voronoi-tiles", "export"), ("voronoi-tiles", "render")
        start = f"docs/gallery/{self.stem}"
        picture = ("--size", "480", "--renderer", "cpu")
        art = ("--overlay", "art") if self.name.startswith("art/") else ()
        return (
            Command(export, self.design, f"{start}-tile.svg", SCREEN),
            Command(render, self.design, f"{start}.png", (*picture, *art)),
            Command(export, self.design, f"{start}-sheet.svg", self.sheet.arguments),
        )

    @property
    def _keys(self) -> dict[str, Any]:
        """The keys of its design."""
        return tomllib.loads((ROOT / self.design).read_text(encoding="utf-8"))


def examples() -> list[Example]:
    """All examples: those of one site's art last."""
    folder = ROOT / "examples"
    found = [*sorted(folder.glob("*.toml")), *sorted((folder / "art").glob("*.toml"))]
    return [Example(path.relative_to(folder).with_suffix("").as_posix()) for path in found]


def commands() -> Iterator[Command]:
    """The commands of all pictures."""
    return (command for example in examples() for command in example.commands)


def section(example: Example) -> str:
    """An example's section of the page."""
    captions = (example.tile_caption, "the tessellation", example.sheet.caption)
    rows = [
        (f"{example.stem}: {caption}", Path(command.output).relative_to("docs").as_posix(), caption)
        for command, caption in zip(example.commands, captions, strict=True)
    ]
    return "\n".join(
        (
            f"## {example.stem}\n",
            f"Group {example.group}. {example.about}\n",
            image_table(rows, 2),
            command_block(example.commands),
        )
    )


_HEAD = """\
# Gallery

Every design in `examples/`: its tile, or one of each, beside the tessellation, and a sheet. Under the pictures stand
the commands that wrote them; they run in the repository's root, and `make gallery` runs them all.

The preset `docs/gallery/screen.toml` draws lines of 0.45 mm in colours that are seen on a screen. For a cutter leave it
out, or take the preset of its program: `--preset lightburn`. `--curves arc --accuracy 0.02mm` keeps the files of this
page small; without them the curves are exact. `heart.svg` is a drawing of one closed path.

{groups}

"""


def page() -> str:
    """The page."""
    found = examples()
    return _HEAD.format(groups=_by_group(found)) + "\n".join(map(section, found))


def _by_group(found: list[Example]) -> str:
    """A table of the groups, in the order of the International Tables, and their examples."""
    rows = ["| group | examples |", "| --- | --- |"]
    for group in GROUPS:
        links = ", ".join(f"[{example.stem}](#{example.stem})" for example in found if example.group == group)
        rows.append(f"| {group} | {links} |")
    return "\n".join(rows)


def write() -> None:
    """Write the page and its pictures, and remove pictures of examples that are no more."""
    text = page()
    for path in set(FOLDER.iterdir()) - {ROOT / command.output for command in commands()}:
        if path.name not in INPUTS:
            path.unlink()
    run_all(commands())
    (ROOT / "docs/gallery.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write()
