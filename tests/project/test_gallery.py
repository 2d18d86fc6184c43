"""The gallery and the figures of the paper: complete, with the commands that made them, the same when made anew."""

from __future__ import annotations

import re
import shutil
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers.examples import is_first
from helpers.outlines import CommandLine
from helpers.png import decoded

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs/generate"))

import figures  # noqa: E402
import gallery  # noqa: E402
from running import Command, command_block, image_table  # noqa: E402

PICTURE = re.compile(r"!\[[^\]]*\]\(([^)]+)\)")
BLOCK = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)
VERSION = re.compile(r' version="[^"]*" job=')
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")

# How many pixels may differ from the committed picture: another libm may round a distance to the other side.
OTHER_PIXELS = 1e-3

# How far a number of an SVG may be from the committed one, in mm, for the same reason: a thousandth of a micrometre.
OTHER_NUMBERS = 1e-6

GROUPS = {
    "1": {"pg"},
    "2": {"p1", "p2", "pg", "p4"},
    "3": {"p3", "p6"},
    "4": {"p2", "p4", "p3"},
    "5": {"pm", "cm", "pmg", "pgg"},
    "6": {"cmm", "p4g", "p31m"},
    "7": {"p4m", "pmm", "p3m1", "p6m"},
    "8": {"p1", "pm"},
    "9": {"p1"},
    "10": {"p1"},
    "11": {"pg"},
    "12": {"p3"},
    "13": {"p6"},
}
"""The paper's figures and the groups that each shows; in figures 8 and 9 the group only keeps other copies away."""


def sections(text: str) -> dict[str, str]:
    """Split a page by its headings of the second level."""
    _, *parts = re.split(r"^## ", text, flags=re.MULTILINE)
    return {part.partition("\n")[0]: part for part in parts}


def shown(text: str) -> list[str]:
    """The commands of a page's blocks."""
    return [line for block in BLOCK.findall(text) for line in block.splitlines()]


def faults_of_page(text: str, docs: Path) -> list[str]:
    """Say what a gallery page lacks: sections, pictures, commands; and what nothing asks for."""
    found = sections(text)
    names = [example.stem for example in gallery.examples()]
    faults = [f"sections {sorted(set(found) ^ set(names))}"] if list(found) != names else []
    for example in gallery.examples():
        part = found.get(example.stem, "")
        outputs = [Path(command.output).relative_to("docs").as_posix() for command in example.commands]
        if PICTURE.findall(part) != outputs:
            faults.append(f"{example.stem}: pictures {PICTURE.findall(part)}")
        if shown(part) != [command.shown for command in example.commands]:
            faults.append(f"{example.stem}: commands {shown(part)}")
        if f"Group {example.group}. " not in part or example.about not in part:
            faults.append(f"{example.stem}: the group, or what it is")
    return faults + faults_of_folder(docs / "gallery", list(gallery.commands()), gallery.INPUTS)


def faults_of_folder(
    folder: Path, commands: list[Command], inputs: frozenset[str] = frozenset(), pattern: str = "*"
) -> list[str]:
    """Say which files are missing in a folder, empty, or written by no command."""
    wanted = {Path(command.output).name for command in commands} | inputs
    there = {path.name for path in folder.glob(pattern)}
    faults = [f"missing: {name}" for name in sorted(wanted - there)]
    faults += [f"of no use: {name}" for name in sorted(there - wanted)]
    return faults + [f"empty: {path.name}" for path in folder.glob(pattern) if not path.stat().st_size]


def difference(first: Path, second: Path) -> float:
    """The share of pixels that differ between two PNGs; of two SVGs 0 or 1, but for the version and rounding."""
    if first.suffix == ".svg":
        one, other = (VERSION.sub(" job=", path.read_text(encoding="utf-8")) for path in (first, second))
        if NUMBER.sub("", one) != NUMBER.sub("", other):
            return 1.0
        pairs = zip(NUMBER.findall(one), NUMBER.findall(other), strict=True)
        return float(any(abs(float(a) - float(b)) > OTHER_NUMBERS for a, b in pairs))
    old, new = decoded(first.read_bytes()), decoded(second.read_bytes())
    return 1.0 if old.shape != new.shape else float(np.any(old != new, axis=-1).mean())


def anew(command: Command, folder: Path, voronoi_tiles: CommandLine) -> float:
    """Run a command anew, and compare its file with the committed one."""
    output = folder / Path(command.output).name
    program, *words = command.program
    if program == "voronoi-tiles":
        done = voronoi_tiles(*words, command.design, "-o", output, *command.options, cwd=ROOT)
        assert done.returncode == 0, done.stderr
    else:
        command.run(folder)
    return difference(ROOT / command.output, output)


def test_the_gallery_is_complete() -> None:
    """Every example has its section, its three pictures and their commands, and no file is left over."""
    assert faults_of_page((ROOT / "docs/gallery.md").read_text(encoding="utf-8"), ROOT / "docs") == []


def test_the_page_is_what_the_generator_writes() -> None:
    """Nobody has written into it by hand, and the examples have not changed since."""
    assert (ROOT / "docs/gallery.md").read_text(encoding="utf-8") == gallery.page()


def test_every_group_has_an_example() -> None:
    """All 17 groups are in the gallery, and sheets of all three fits."""
    assert len({example.group for example in gallery.examples()}) == 17
    fits = [words[words.index("--fit") + 1] for sheet in gallery.SHEETS.values() if "--fit" in (words := sheet.options)]
    assert {"clip", "frame"} <= set(fits)
    assert len(fits) < len(gallery.SHEETS)
    assert set(gallery.SHEETS) == {example.name for example in gallery.examples()}


def test_faults_of_a_page_are_found(tmp_path: Path) -> None:
    """A section, a picture, a command that is wrong or missing, a file too many: each is named."""
    text = gallery.page()
    shutil.copytree(ROOT / "docs/gallery", tmp_path / "gallery")
    assert faults_of_page(text, tmp_path) == []
    assert faults_of_page(text.replace("## p4-hook\n", "## p4-hooks\n"), tmp_path)
    assert faults_of_page(text.replace("(gallery/p4-hook.png)", "(gallery/p4-key.png)"), tmp_path)
    assert faults_of_page(text.replace("p4-hook.png --size 480", "p4-hook.png --size 481"), tmp_path)
    assert faults_of_page(text.replace("Group p4. Three segments", "Group p4. Two segments"), tmp_path)
    stray = tmp_path / "gallery/p4-hooks.png"
    stray.touch()
    assert faults_of_page(text, tmp_path) == ["of no use: p4-hooks.png", "empty: p4-hooks.png"]
    stray.unlink()
    (tmp_path / "gallery/p4-hook.png").unlink()
    assert faults_of_page(text, tmp_path) == ["missing: p4-hook.png"]


def test_the_papers_figures_are_complete() -> None:
    """All thirteen, with their groups; every design is shown, every picture has a file, no file is left over."""
    groups = {
        family.number: {
            tomllib.loads((ROOT / picture.command.design).read_text(encoding="utf-8"))["group"]
            for picture in family.pictures
        }
        for family in figures.FAMILIES
    }
    assert groups == GROUPS
    assert list(groups) == list(GROUPS)
    used = {picture.design for family in figures.FAMILIES for picture in family.pictures}
    assert used == {path.stem for path in (ROOT / "examples/paper").glob("fig*.toml")}
    assert faults_of_folder(ROOT / "docs/paper", list(figures.commands()), pattern="fig*") == []


@pytest.mark.parametrize("family", figures.FAMILIES, ids=lambda family: f"figure{family.number}")
def test_a_figures_section_has_its_pictures_and_commands(family: figures.Family) -> None:
    """In the page's order, with the captions and what is measured."""
    text = figures.markdown(family)
    assert text.startswith(f"### Figure {family.number}: {family.title}\n")
    assert PICTURE.findall(text) == [f"paper/{picture.file}" for picture in family.pictures]
    assert shown(text) == [picture.command.shown for picture in family.pictures]
    for picture in family.pictures:
        assert figures.caption(picture) in text
        assert picture.caption in text


def test_measured_captions() -> None:
    """What is counted in the pictures follows from the groups and from what bisectors are."""
    captions = {p.file: figures.caption(p) for family in figures.FAMILIES for p in family.pictures}
    for name, edges in (("p4m", 3), ("pmm", 4), ("p3m1", 3), ("p6m", 3)):
        assert captions[f"fig07-{name}.png"].endswith(f"; {edges} edges, 0.0% curved")
    assert captions["fig08-line.png"].endswith("; boundary: 1 parabola")
    assert captions["fig08-segment.png"].endswith("; boundary: 2 lines, 1 parabola")
    assert captions["fig08-mirrored.png"].endswith("; boundary: 1 line")


def case(command: Command) -> Any:
    """A command as a parameter: slow where another example of the group is drawn in the quick run."""
    first = is_first(Path(command.design).stem)
    return pytest.param(command, id=Path(command.output).name, marks=[] if first else [pytest.mark.slow])


@pytest.mark.parametrize("command", [case(command) for command in gallery.commands()])
def test_made_anew_it_is_the_same(command: Command, tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """The committed file is what its command writes."""
    assert anew(command, tmp_path, voronoi_tiles) <= OTHER_PIXELS


def test_other_pictures_are_not_the_same(tmp_path: Path) -> None:
    """The comparison sees another size, another picture and another path."""
    svg, png = ROOT / "docs/gallery/p4-hook-tile.svg", ROOT / "docs/gallery/p4-hook.png"
    assert difference(png, ROOT / "docs/gallery/p4-mill.png") > OTHER_PIXELS
    assert difference(png, ROOT / "docs/gallery/p1-fish.png") == 1.0
    text = svg.read_text(encoding="utf-8")
    assert VERSION.search(text)
    other = tmp_path / "other.svg"
    other.write_text(VERSION.sub(' version="9.9" job=', text), encoding="utf-8")
    assert difference(svg, other) == 0.0
    other.write_text(text.replace(" Q ", " L ", 1), encoding="utf-8")
    assert difference(svg, other) == 1.0
    number = re.search(r' d="M (\S+)', text)
    assert number
    for step, expected in ((1e-9, 0.0), (1e-5, 1.0)):
        other.write_text(text.replace(number[0], f' d="M {float(number[1]) + step:.12f}'), encoding="utf-8")
        assert difference(svg, other) == expected


def test_a_command_is_run_as_it_is_shown(tmp_path: Path) -> None:
    """By the script that readers type, as `make gallery` runs it."""
    command = next(gallery.commands())
    command.run(tmp_path)
    assert difference(ROOT / command.output, tmp_path / Path(command.output).name) == 0.0


def test_a_command_is_shown_as_it_can_be_typed(tmp_path: Path) -> None:
    """With the shell's quotes; and one that fails is named with what it said."""
    command = Command(("voronoi-tiles", "export"), "examples/no such.toml", "docs/gallery/no.svg", ("--kerf", "0.2mm"))
    assert command.shown == "voronoi-tiles export 'examples/no such.toml' -o docs/gallery/no.svg --kerf 0.2mm"
    assert command_block([command]) == f"```sh\n{command.shown}\n```\n"
    with pytest.raises(RuntimeError, match=r"no such\.toml.*\nended with 2: .*no such\.toml"):
        command.run(tmp_path)


def test_tables_of_pictures() -> None:
    """Rows of so many pictures, captions under them, the last row shorter."""
    table = image_table([("a", "a.png", "one"), ("b", "b.png", "two"), ("c", "c.png", "three")], 2)
    assert table == (
        "| ![a](a.png) | ![b](b.png) |\n| :-: | :-: |\n| one | two |\n\n| ![c](c.png) |\n| :-: |\n| three |\n"
    )


def test_the_pictures_are_small() -> None:
    """A clone is no longer for them: 4 MB for the gallery, 3 MB for the paper."""
    assert sum(path.stat().st_size for path in (ROOT / "docs/gallery").iterdir()) < 4e6
    assert sum(path.stat().st_size for path in (ROOT / "docs/paper").iterdir()) < 3e6
