"""The documentation is right: its commands run, print what it shows, and nothing that the code takes is left out.

In the pages a comment before a block says how it is tested:

- `<!-- file: NAME -->` writes the block to a file for the commands that follow;
- `<!-- exit: 2 -->` says that the last command of the block fails with this exit code;
- `<!-- varies: 1.2 | llvmpipe -->`, before a ```text block, names what differs from machine to machine. A number stands
  for any number, a text for any text on the line.

A ```text block straight after commands is what they print, standard output and standard error together. Each page's
commands run in order, in an empty folder of the page's own, with a copy of examples/.
"""

from __future__ import annotations

import json
import os
import random
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import click
import pytest
from helpers.outlines import CommandLine

import voronoi_tiles as vt
from voronoi_tiles.cli.main import COMMANDS, cli
from voronoi_tiles.designs import schema as reading
from voronoi_tiles.formats.presets import load_preset, preset_names
from voronoi_tiles.groups.symmetry_elements import symmetry_elements

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]

OURS = {name: command for name in COMMANDS if (command := cli.get_command(click.Context(cli), name))}
"""The commands of the command line."""


def parameters(command: click.Command) -> Iterator[click.Parameter]:
    """The parameters of a command, and of those that stand below it."""
    yield from command.params
    for below in command.commands.values() if isinstance(command, click.Group) else ():
        yield from parameters(below)


NOT_RUN = {
    "pip install -e .": "needs the index for the dependencies; the tests run in such an environment already",
    "python3 -m venv .venv": "the tests run in an environment already",
    ". .venv/bin/activate": "the tests run in an environment already",
    ".ci/run": "runs these tests",
    "voronoi-tiles watch bird.toml": "runs until it is interrupted; test_watch.py does",
    "voronoi-tiles studio bird.toml": "serves until it is interrupted; the tests of the studio do",
    "voronoi-tiles inkscape install": "would change what who runs the tests has; test_installing.py does it aside",
    'xvfb-run -a inkscape --batch-process --actions="select-by-id:path1,path2;voronoi-tiles.tiles.noprefs;'
    'export-filename:out.svg;export-do" drawing.svg': "takes a quarter of a minute; test_within_inkscape.py does",
}
"""Commands of the pages that no test runs, each with the reason. Those of make are checked by their targets."""

SUBSTITUTES = {
    "--size 8000 --region": ("--size 400 --region", "a picture of 64 million pixels takes half a minute"),
}
"""What is made smaller before it is run, and why."""

PATHS = re.compile(r'<path d="([^"]*)"')
"""The paths of a drawing, their letters and numbers apart."""

RUN_BY_MAKE = {
    "gallery.md": "test_gallery.py runs them all, and compares what they write",
    "paper.md": "test_paper.py runs them all, and compares what they write",
}
"""Pages of so many commands that here they are only read, as the command line reads them."""

LONG = {"README.md", "laser.md", "readers.md", "start.md"}
"""Pages with so many commands that they take a quarter of a minute and more; the others are quickly run."""

_BLOCK = re.compile(
    r"^(?P<comments>(?:<!--[^\n]*-->\n\n?)*)```(?P<language>[\w{}-]*)[^\n]*\n(?P<body>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
_COMMENT = re.compile(r"<!-- (\w+): (.*?) -->")
_SIMPLE = re.compile(r"voronoi-tiles [^|&;<>()$`\\*?\[\]{}~#]*")
_NUMBER = re.compile(r"[-+]?[\d,]*\.?\d+(?:e[-+]?\d+)?")


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, its text, the comments before it by name, and whether it follows the last one."""

    language: str
    body: str
    comments: dict[str, str]
    follows: bool


def blocks(text: str) -> Iterator[Block]:
    """The fenced blocks of a page, in order."""
    last = -1
    for found in _BLOCK.finditer(text):
        follows = not text[last : found.start()].strip() if last >= 0 else False
        last = found.end()
        yield Block(found["language"], found["body"], dict(_COMMENT.findall(found["comments"])), follows)


def commands(body: str) -> Iterator[str]:
    """The commands of a ```sh block: one a line, but for lines that a backslash continues."""
    for line in body.replace("\\\n", " ").splitlines():
        words = line.strip()
        if words and not words.startswith("#"):
            yield words


def bare(command: str) -> str:
    """A command without its comment."""
    return re.sub(r"\s+#\s.*$", "", command)


def is_make(command: str) -> bool:
    """Whether make runs it: then its target is looked up, and no more."""
    return command.split(maxsplit=1)[0] == "make"


# --- running pages ------------------------------------------------------------------------------------------


class PageError(AssertionError):
    """A page that says what does not hold."""


class Runner:
    """Runs a page's blocks in a folder, and compares what they print with what the page shows."""

    def __init__(self, folder: Path, voronoi_tiles: CommandLine) -> None:
        self.folder = folder
        self.voronoi_tiles = voronoi_tiles
        self.printed = ""
        self.environment = os.environ | {
            "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
            "COLUMNS": "140",
            "NO_COLOR": "1",
            "PYTHONWARNINGS": "error",
        }

    def run(self, text: str) -> None:
        """Run all blocks of a page. Raises PageError."""
        for block in blocks(text):
            if "file" in block.comments:
                (self.folder / block.comments["file"]).write_text(block.body, encoding="utf-8")
            elif block.language == "sh":
                self.printed = "".join(self._shell(block))
            elif block.language == "python":
                self.printed = self._call([sys.executable, "-c", block.body], 0)
            elif block.language == "text" and block.follows:
                compare(block, self.printed)

    def _shell(self, block: Block) -> Iterator[str]:
        lines = [bare(line) for line in commands(block.body)]
        for k, line in enumerate(lines):
            if is_make(line) or line in NOT_RUN:
                continue
            last = k == len(lines) - 1
            for long, (short, _) in SUBSTITUTES.items():
                line = line.replace(long, short)  # noqa: PLW2901 - the same command, made smaller
            code = int(block.comments.get("exit", "0")) if last else 0
            yield self._call(["bash", "-o", "pipefail", "-c", line], code)

    def _call(self, command: list[str], code: int) -> str:
        if _SIMPLE.fullmatch(command[-1]):  # no pipe, no pattern: the shell would do no more
            words = shlex.split(command[-1])[1:]
            result = self.voronoi_tiles(*words, cwd=self.folder, environment=self.environment, merged=True, timeout=300)
        else:
            result = subprocess.run(
                command,
                cwd=self.folder,
                env=self.environment,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                timeout=300,
                check=False,
            )
        if result.returncode != code:
            raise PageError(f"{command[-1]}\nexit code {result.returncode}, not {code}:\n{result.stdout}")
        return result.stdout


def compare(block: Block, printed: str) -> None:
    """Compare a block with what was printed, but for what varies and for the widths of tables. Raises PageError."""
    varies = [part.strip() for part in block.comments.get("varies", "").split("|") if part.strip()]
    for part in varies:
        if part not in block.body:
            raise PageError(f"the block does not hold what is said to vary: {part}")
    pattern = re.escape(_even(block.body))
    for part in sorted(varies, key=len, reverse=True):
        anything = _NUMBER.pattern if _NUMBER.fullmatch(part) else r"[^\n]+?"
        pattern = pattern.replace(re.escape(_even(part)), f"(?:{anything})")
    if not re.fullmatch(pattern, _even(printed)):
        raise PageError(f"shown:\n{block.body}\nprinted:\n{printed}")


def _even(text: str) -> str:
    """A text with runs of spaces and rules of one length, without spaces at the ends of lines."""
    text = re.sub(r" {2,}", " ", re.sub(r"─+", "─", text.strip()))
    return re.sub(r" +$", "", text, flags=re.MULTILINE)


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, id=page.name, marks=[pytest.mark.slow] if page.name in LONG else [])
        for page in PAGES
        if page.name not in RUN_BY_MAKE
    ],
)
def test_the_commands_run_and_print_what_the_page_shows(page: Path, tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """All of a page's shell and Python blocks, in order."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    Runner(tmp_path, voronoi_tiles).run(page.read_text(encoding="utf-8"))


def read(command: str) -> None:
    """Have the command line read a command, without doing it. Raises PageError."""
    program, *words = shlex.split(command)
    script = Path(words[0]) if words else Path()
    if program == "python" and script.suffix == ".py":
        if not (ROOT / script).is_file():
            raise PageError(f"{command}\nthere is no such script")
        return
    if is_make(command):
        return
    if program != "voronoi-tiles" or not words or words[0] not in OURS:
        raise PageError(f"{command}\nno command of ours")
    try:
        OURS[words[0]].make_context(words[0], words[1:])
    except click.ClickException as error:
        raise PageError(f"{command}\n{error.format_message()}") from error
    for word in words[1:]:
        if word.startswith("examples/") and not (ROOT / word).is_file():
            raise PageError(f"{command}\nthere is no {word}")


@pytest.mark.parametrize("page", [page for page in PAGES if page.name in RUN_BY_MAKE], ids=lambda page: page.name)
def test_the_commands_are_as_the_command_line_takes_them(page: Path) -> None:
    """Commands, options, their values and the designs that they name."""
    shown = [
        line
        for block in blocks(page.read_text(encoding="utf-8"))
        if block.language == "sh"
        for line in commands(block.body)
    ]
    assert shown
    for command in shown:
        read(bare(command))


@pytest.mark.parametrize(
    "command",
    [
        "voronoi-tiles fly examples/p4-mill.toml",
        "voronoi-tiles render examples/p4-mill.toml -o a.png --tall",
        "voronoi-tiles export examples/p4-mill.toml -o a.svg --fit tightly",
        "voronoi-tiles export examples/none.toml -o a.svg",
        "python docs/generate/none.py",
        "rm -r examples",
    ],
)
def test_a_wrong_command_is_not_read(command: str) -> None:
    """Whatever the command line would refuse."""
    read("voronoi-tiles render examples/p4-mill.toml -o a.png --size 480")
    with pytest.raises(PageError):
        read(command)


# --- the machinery fails ------------------------------------------------------------------------------------

FAILING = {
    "a command that fails": ("```sh\nvoronoi-tiles export missing.toml -o out.svg\n```\n", "exit code 2, not 0"),
    "a command that there is not": ("```sh\nvoronoi-tiles fly\n```\n", "exit code 2, not 0"),
    "one that fails before the last": ("```sh\nfalse\ntrue\n```\n", "exit code 1, not 0"),
    "one that fails in a pipe": ("```sh\nfalse | true\n```\n", "exit code 1, not 0"),
    "an exit code other than shown": ("<!-- exit: 2 -->\n```sh\ntrue\n```\n", "exit code 0, not 2"),
    "other output": ("```sh\necho 3 mm\n```\n\n```text\n4 mm\n```\n", "shown:"),
    "more output": ("```sh\necho 3 mm; echo 4 mm\n```\n\n```text\n3 mm\n```\n", "shown:"),
    "less output": ("```sh\necho 3 mm\n```\n\n```text\n3 mm\n4 mm\n```\n", "shown:"),
    "a text for a number": ("```sh\necho x mm\n```\n\n<!-- varies: 3 -->\n```text\n3 mm\n```\n", "shown:"),
    "varying what is not there": ("```sh\necho 3\n```\n\n<!-- varies: 5 -->\n```text\n3\n```\n", "said to vary: 5"),
    "Python that raises": ("```python\nimport voronoi_tiles\nvoronoi_tiles.nothing\n```\n", "AttributeError"),
    "Python that prints something else": ("```python\nprint(1)\n```\n\n```text\n2\n```\n", "shown:"),
    "Python that warns": ("```python\nimport warnings\nwarnings.warn('old')\n```\n", "UserWarning"),
}


@pytest.mark.parametrize(("text", "reason"), FAILING.values(), ids=FAILING.keys())
def test_a_wrong_page_fails(text: str, reason: str, tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """Whatever is wrong with a page, the runner says so."""
    with pytest.raises(PageError, match=reason):
        Runner(tmp_path, voronoi_tiles).run(text)


def test_a_right_page_passes(tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """Files, continued lines, exit codes and varying figures are read as meant."""
    Runner(tmp_path, voronoi_tiles).run(
        "<!-- file: a.txt -->\n```toml\nx = 1\n```\n\n```sh\n# a comment\ncat \\\n  a.txt   # another\n```\n\n"
        "```text\nx = 1\n```\n\n<!-- exit: 3 -->\n```sh\necho took 1.25 s on gl; exit 3\n```\n\n"
        "<!-- varies: 7.5 | a device -->\n```text\ntook 7.5 s on a device\n```\n"
    )


# --- what is not run ----------------------------------------------------------------------------------------


def shown_commands() -> set[str]:
    """All commands in the ```sh blocks of all pages."""
    texts = [page.read_text(encoding="utf-8") for page in PAGES]
    return {
        bare(line)
        for text in texts
        for block in blocks(text)
        if block.language == "sh"
        for line in commands(block.body)
    }


def test_what_is_not_run_is_still_shown() -> None:
    """An exception that no page needs any more is taken out."""
    shown = shown_commands()
    assert not set(NOT_RUN) - shown
    for long in SUBSTITUTES:
        assert any(long in command for command in shown)


def test_commands_in_sentences_and_tables_are_run_as_well() -> None:
    """What writes a file stands in a block too, so that it is run."""
    shown = shown_commands()
    for page in PAGES:
        for command in re.findall(r"`(voronoi-tiles [^`]*? -o [^`]*)`", page.read_text(encoding="utf-8")):
            assert command in shown, f"{page.name}: {command}"


def test_makes_targets_exist() -> None:
    """What the pages make, in blocks and in sentences, is in the Makefile."""
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = set(re.findall(r"^([a-z-]+):", makefile, re.MULTILINE))
    asked = {command for command in shown_commands() if is_make(command)}
    for page in PAGES:
        asked |= set(re.findall(r"`(make [^`]*)`", page.read_text(encoding="utf-8")))
    assert asked
    for command in asked:
        named = [word for word in shlex.split(command)[1:] if "=" not in word and not word.startswith("-")]
        assert set(named) <= targets, command


# --- nothing is left out ------------------------------------------------------------------------------------


def test_what_the_demo_says_in_the_end_can_be_done(tmp_path: Path) -> None:
    """The lines that it shows, typed as they are, in a shell that knows no more than where the environment is."""
    plan = subprocess.run(
        ["/usr/bin/env", "make", "--dry-run", "demo", f"VENV={sys.prefix}"],
        capture_output=True,
        text=True,
        check=True,
        cwd=ROOT,
    )
    shown = re.findall(r'^echo "    (.*)"$', plan.stdout, re.MULTILINE)
    assert len(shown) == 3
    if not (Path(sys.prefix) / "bin/activate").exists():
        pytest.skip("the tests run in no environment of venv's")
    bare_shell = {"PATH": "/usr/bin:/bin"}
    subprocess.run(["/bin/sh", "-ec", "\n".join(shown)], check=True, cwd=tmp_path, env=bare_shell, capture_output=True)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bird.svg", "bird.toml"]
    assert "voronoi-tiles watch bird.toml" in plan.stdout


def text_of(name: str) -> str:
    """The text of a page."""
    return (DOCS / name).read_text(encoding="utf-8")


def keys_at(*path: str) -> list[str]:
    """The keys that a table of a design takes: the reader lists them where one is unknown."""
    design: dict[str, object] = {
        "schema": 1,
        "group": "p1",
        "cell": {"a": 1, "b": 1, "angle": 90},
        "site": [{"strokes": [{"point": [0, 0]}], "art": {"file": "x.svg"}}],
        "solid": {"height": 1},
        "key": [{"z": 1, "strokes": [{"point": [0, 0]}]}],
    }
    table: dict[str, object] = design
    for name in path:
        inner = table[name]
        table = inner[0] if isinstance(inner, list) else inner  # type: ignore[assignment]
    table["nonsense"] = 1
    with pytest.raises(vt.DesignError) as caught:
        vt.Design.from_dict(design)
    found = re.search(r"The keys here are (.*)\.", str(caught.value))
    assert found
    return found[1].split(", ")


@pytest.mark.parametrize(
    "path", [(), ("cell",), ("site",), ("site", "strokes"), ("site", "art"), ("solid",), ("key",)], ids=str
)
def test_every_key_is_documented(path: tuple[str, ...]) -> None:
    """Each key of a design file begins a row of a table of the reference."""
    keys = keys_at(*path)
    assert len(keys) > 2
    rows = set(re.findall(r"^\| `(\w+)`", text_of("design-file.md"), re.MULTILINE))
    assert set(keys) <= rows


def keys_of(value: object) -> Iterator[str]:
    """All keys of a JSON value."""
    if isinstance(value, dict):
        yield from value
    for item in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        yield from keys_of(item)


def test_every_key_of_the_outline_document_is_documented() -> None:
    """Each key of a document with evidence begins a row of a table, and no row is about another."""
    tiling = vt.starter("p4m").tessellate()
    keys = set(keys_of(json.loads(tiling.json(tiling.check(samples=64, renderer="cpu")))))
    assert len(keys) > 30
    assert set(re.findall(r"^\| `(\w+)`", text_of("outline-document.md"), re.MULTILINE)) == keys


def test_every_stroke_has_a_picture() -> None:
    """Each kind of stroke is drawn in an example of the reference, and the picture is shown."""
    text = text_of("design-file.md")
    drawn = [(block.comments["picture"], block.body) for block in blocks(text) if "picture" in block.comments]
    for kind in reading._KINDS:
        assert any(re.search(rf"\b{kind} = ", body) for _, body in drawn), kind
    for name, _ in drawn:
        assert f"(pictures/{name}.svg)" in text, name


def test_the_examples_of_the_reference_are_designs(tmp_path: Path) -> None:
    """Each example of the reference gives tiles: alone, or as the end of the frame that the page shows."""
    text = text_of("design-file.md")
    frame = next(block.body for block in blocks(text) if "frame" in block.comments)
    examples = [block.body for block in blocks(text) if "picture" in block.comments]
    assert len(examples) > len(reading._KINDS)
    for block in blocks(text):
        if "file" in block.comments:
            (tmp_path / block.comments["file"]).write_text(block.body, encoding="utf-8")
    for body in examples:
        assert vt.Design.loads(body if "schema" in body else frame + body, folder=tmp_path).tessellate().tiles


def test_every_command_and_option_is_documented() -> None:
    """Each option stands in a page of the documentation that names the command as well."""
    texts = [page.read_text(encoding="utf-8") for page in PAGES]
    missing = [
        f"{name} {flag}"
        for name, command in OURS.items()
        for parameter in parameters(command)
        if isinstance(parameter, click.Option)
        for flag in ["|".join(parameter.opts)]
        if not any(
            f"voronoi-tiles {name}" in text and re.search(rf"(?<![\w-])({flag})(?![\w-])", text) for text in texts
        )
    ]
    assert not missing
    assert not [name for name in OURS if not any(f"voronoi-tiles {name}" in text for text in texts)]


def test_no_option_is_invented() -> None:
    """Each option in the pages is one of some command."""
    known = {flag for command in OURS.values() for parameter in parameters(command) for flag in parameter.opts}
    foreign = {"--help", "--version", "--verbose", "--no-build-isolation", "--strict", "--cov"}
    foreign |= {"--nthreads"}  # of dask worker
    foreign |= {"--sites", "--even"}  # of docs/generate/census.py
    foreign |= {"--actions", "--batch-process", "--export-type"}  # of Inkscape
    for page in PAGES:
        named = set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", page.read_text(encoding="utf-8")))
        assert named <= known | foreign, page.name


def test_every_preset_and_public_name_is_documented() -> None:
    """The presets have a row each, and what the package exports is in the Python page."""
    laser, python = text_of("laser.md"), text_of("python.md")
    assert len(preset_names()) > 5
    for name in preset_names():
        row = re.search(rf"^\| `{name}` \|.*\| (.*) \|$", laser, re.MULTILINE)
        assert row, name
        assert set(re.findall("dxf|pdf|lbrn2|svg|gcode", row[1])) == set(load_preset(name).unread), name
    for name in vt.__all__:
        assert re.search(rf"\bvoronoi_tiles\.{name}\b", python), name


def test_the_tables_of_the_groups_are_computed() -> None:
    """docs/groups.md holds what docs/generate/diagrams.py makes of the groups' operations."""
    script = (
        "import sys; sys.path.insert(0, 'docs/generate'); import diagrams_tables as d; "
        "page = d.PAGE.read_text(encoding='utf-8'); sys.exit(d.with_tables(page) != page)"
    )
    subprocess.run([sys.executable, "-c", script], cwd=ROOT, check=True, timeout=60)


@pytest.mark.slow
@pytest.mark.parametrize("part", ["strokes", "method", "gradients", "sweeps"])
def test_the_drawings_are_made_anew(part: str, tmp_path: Path) -> None:
    """docs/pictures hold what docs/generate draws of the engine's answers: the same paths, to 0.02 of a point."""
    script = (
        "import sys; sys.path.insert(0, 'docs/generate'); import pathlib, diagrams, diagrams_style; "
        f"diagrams_style.PICTURES = pathlib.Path({str(tmp_path)!r}); diagrams.PARTS[{part!r}]()"
    )
    subprocess.run([sys.executable, "-c", script], cwd=ROOT, check=True, timeout=300, stdout=subprocess.DEVNULL)
    drawn = sorted(tmp_path.glob("*.svg"))
    assert drawn
    for path in drawn:
        made, kept = (
            [part for path in PATHS.findall(file.read_text(encoding="utf-8")) for part in path.split()]
            for file in (path, ROOT / "docs/pictures" / path.name)
        )
        places = [k for k, part in enumerate(kept) if not part.isalpha()]
        assert places, path.name
        assert [part for part in made if part.isalpha()] == [part for part in kept if part.isalpha()], path.name
        assert [float(made[k]) for k in places] == pytest.approx([float(kept[k]) for k in places], abs=0.02), path.name


def test_the_sweep_of_its_page_is_the_example() -> None:
    """docs/sweeps.md shows examples/sweeps/birds.toml, of which its picture is made, and every key and column."""
    text = text_of("sweeps.md")
    shown = next(block.body for block in blocks(text) if block.comments.get("file") == "birds.toml")
    assert shown == (ROOT / "examples/sweeps/birds.toml").read_text(encoding="utf-8")
    sweep = vt.Sweep(vt.starter("p4"), {"cell.a": [60]}, job={"sheet": "30x20cm"})
    with pytest.raises(vt.DesignError) as raised:
        vt.Sweep.from_dict({"nonsense": 1})
    keys = re.search(r"The keys here are (.*)\.", str(raised.value))
    assert keys
    rows = "\n".join(re.findall(r"^\| ([^|]*) \|", text, re.MULTILINE))
    for name in (*keys[1].split(", "), *sweep.columns):
        assert name == "cell.a" or f"`{name}`" in rows, name


def general_tile(group: str, seed: int) -> tuple[vt.Tile, vt.Lattice]:
    """The tile of a random segment in general position, in a cell of 60."""
    dice = random.Random(f"{group} {seed}")  # noqa: S311 - random input, not secrets
    cell = {"a": 60.0} | ({} if vt.GROUPS[group].fixes_b else {"b": dice.uniform(40.0, 80.0)})
    cell |= {"angle": dice.uniform(60.0, 80.0)} if vt.GROUPS[group].system == "oblique" else {}
    while True:
        ends = [[dice.uniform(0.0, 60.0), dice.uniform(0.0, 60.0)]]
        ends.append([ends[0][0] + dice.uniform(-6.0, 6.0), ends[0][1] + dice.uniform(-6.0, 6.0)])
        site = {"strokes": [{"segment": ends}]}
        design = vt.Design.from_dict({"schema": 1, "group": group, "cell": cell, "site": [site]})
        try:
            return design.tessellate().tiles[0], design.lattice
        except vt.TouchingCopiesError:
            continue


def is_mirror(operation: vt.Operation) -> bool:
    """Whether an operation is a reflection without a glide: done twice it is nothing."""
    return operation.determinant == -1 and (operation @ operation).is_identity


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("group", [name for name, group in vt.GROUPS.items() if symmetry_elements(group).mirrors])
def test_mirrors_take_the_length_that_the_page_says(group: str, seed: int) -> None:
    """Twice the mirrors' length in a cell over the copies, in every tile of a site in general position."""
    tile, lattice = general_tile(group, seed)
    outline = tile.outline
    on = [k for k, neighbour in enumerate(outline.neighbours) if is_mirror(neighbour.operation)]
    measured = sum(outline.lengths[outline.neighbour == k].sum() for k in on)
    lines = symmetry_elements(vt.GROUPS[group]).mirrors
    said = sum(2.0 * abs(p * lattice.a + q * lattice.b) for p, q in (line.direction for line in lines))
    assert measured == pytest.approx(said / vt.GROUPS[group].order, rel=1e-9)


def corners_at(tile: vt.Tile, lattice: vt.Lattice, group: str, place: complex) -> int:
    """How many copies of a tile have a vertex at a place of the cell."""
    copies = [
        tile.copy(operation.translated(i, j))
        for operation in vt.GROUPS[group].operations
        for i in range(-2, 3)
        for j in range(-2, 3)
    ]
    return sum(bool((abs(copy.start - place) < 1e-9 * abs(lattice.a)).any()) for copy in copies)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("group", [name for name, group in vt.GROUPS.items() if symmetry_elements(group).centres])
def test_tiles_meet_at_centres_as_the_page_says(group: str, seed: int) -> None:
    """As many as the order, twice with mirrors, each with a corner; none at half turns without mirrors."""
    tile, lattice = general_tile(group, seed)
    elements = symmetry_elements(vt.GROUPS[group])
    for centre in elements.centres:
        place = lattice.cartesian(float(centre.x), float(centre.y))
        mirrored = any(
            (line.direction[1] * centre.x - line.direction[0] * centre.y - line.offset) % 1 == 0
            for line in elements.mirrors
        )
        expected = 2 * centre.order if mirrored else centre.order if centre.order > 2 else 0
        assert corners_at(tile, lattice, group, place) == expected, centre


REGULAR = {
    "p3 point": ("p3", {"a": 60.0}, [{"point": [30, 0]}], 0j, 6),
    "p4 segment": ("p4", {"a": 60.0}, [{"segment": [[15, 10], [15, 20]]}], 30 + 0j, 4),
    "p2 rectangle, a corner": ("p2", {"a": 60.0, "b": 60.0, "angle": 90}, [{"segment": [[15, -10], [15, 10]]}], 30j, 4),
    "p2 rectangle, a side": ("p2", {"a": 60.0, "b": 60.0, "angle": 90}, [{"segment": [[15, -10], [15, 10]]}], 0j, 0),
}
"""The regular sites that docs/groups.md names, a centre, and how many tiles have a corner there."""


@pytest.mark.parametrize(("group", "cell", "strokes", "place", "corners"), REGULAR.values(), ids=REGULAR.keys())
def test_regular_sites_have_more_tiles_about_a_centre(
    group: str, cell: dict[str, float], strokes: list[dict[str, object]], place: complex, corners: int
) -> None:
    """What the page names as otherwise is so."""
    design = vt.Design.from_dict({"schema": 1, "group": group, "cell": cell, "site": [{"strokes": strokes}]})
    assert corners_at(design.tessellate().tiles[0], design.lattice, group, place) == corners


@pytest.mark.parametrize(("strokes", "sides"), [([[10, 10], [10, 90]], 2), ([[10, 10]], 1)])
def test_a_site_in_two_pieces_has_more_sides_on_a_mirror(strokes: list[list[float]], sides: int) -> None:
    """In pm a site in one piece has one of length b on either; one of two points has two of half of it."""
    site = {"strokes": [{"point": place} for place in strokes]}
    cell = {"a": 60.0, "b": 60.0}
    outline = (
        vt.Design.from_dict({"schema": 1, "group": "pm", "cell": cell, "site": [site]}).tessellate().tiles[0].outline
    )
    for x in (0.0, 30.0):
        on = (abs(outline.start.real - x) < 1e-9) & (abs(outline.end.real - x) < 1e-9)
        assert outline.lengths[on] == pytest.approx([60.0 / sides] * sides)


def test_pictures_are_there_small_and_shown() -> None:
    """Every picture that a page shows exists; every drawing is shown, and small."""
    shown = set()
    for page in PAGES:
        for target in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).is_file(), f"{page.name}: {target}"
            shown.add((page.parent / target).resolve())
    drawn = list((DOCS / "pictures").iterdir())
    assert len(drawn) > 30
    for picture in drawn:
        assert picture.resolve() in shown, picture.name
        assert picture.stat().st_size <= {".svg": 60_000, ".png": 40_000}[picture.suffix], picture.name


def test_every_option_of_a_job_has_its_row() -> None:
    """In the table of the page on Python, in the order of the fields, with the words that it takes and its default."""
    page = (ROOT / "docs" / "python.md").read_text(encoding="utf-8").split("### What a job takes")[1].split("\n#")[0]
    rows = [row.split(" | ") for row in re.findall(r"^\| (`\w+` \| .*) \|$", page, re.MULTILINE)]
    options = vt.Job.options()
    assert [row[0].strip("`") for row in rows] == list(options)
    for (_, takes, default, what), (name, option) in zip(rows, options.items(), strict=True):
        if option.words:
            assert takes == ", ".join(f'`"{word}"`' for word in option.words), name
        if option.default is not None and f"`{option.default!r}`".replace("'", '"') != default:
            assert default == option.help.split("[default: ")[1].rstrip("]."), name
        assert what.rstrip(".") in option.help, name
