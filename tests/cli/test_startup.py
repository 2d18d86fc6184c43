"""What commands load: an import that is not needed is most of what a small design costs."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

HEAVY = {
    *("numpy", "numpy.random", "scipy", "shapely", "svgwrite", "ezdxf", "moderngl", "rich", "tinycss2", "coloraide"),
    *("http.client", "importlib.resources", "asyncio", "multiprocessing", "unittest"),
}
"""Modules that take more than 3 ms to import."""

DESIGN = """
schema = 1
group = "p4"
cell = { a = 60 }
site = [{ strokes = [{ bezier = [[6, 9], [30, 2], [30, 20], [13, 25]] }] }]
"""


@pytest.mark.parametrize(
    ("command", "needed"),
    [
        ("export DESIGN -o x.json", "numpy"),
        ("export DESIGN -o x.svg", "numpy svgwrite http.client"),
        ("export DESIGN -o x.svg --sheet 200x100mm", "numpy shapely svgwrite http.client importlib.resources"),
        ("export DESIGN -o x.dxf", "numpy shapely importlib.resources ezdxf unittest"),
        ("info DESIGN --json", "numpy"),
        ("info DESIGN", "numpy rich"),
        ("check DESIGN --json --size 64 --renderer cpu", "numpy shapely importlib.resources"),
        ("render DESIGN -o x.png --size 64 --renderer cpu", "numpy shapely importlib.resources"),
    ],
)
def test_a_command_loads_what_it_needs(command: str, needed: str, tmp_path: Path) -> None:
    """And nothing else that is heavy."""
    (tmp_path / "design.toml").write_text(DESIGN, encoding="utf-8")
    script = (
        "import sys\nfrom voronoi_tiles.cli.main import run\n"
        f"sys.argv[1:] = {command.replace('DESIGN', 'design.toml').split()!r}\n"
        "try:\n    run()\nexcept SystemExit as exit:\n    assert not exit.code, exit.code\n"
        "print(*sys.modules, file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True, cwd=tmp_path)
    loaded = HEAVY & set(done.stderr.splitlines()[-1].split())
    assert "numpy" in loaded
    assert loaded <= set(needed.split()), loaded - set(needed.split())


def test_tiles_within_inkscape_load_little(tmp_path: Path) -> None:
    """A live preview starts anew with every change of a number: numpy, and what reads styles."""
    (tmp_path / "a.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="9in" height="9in"><path id="p" d="M 9 9 Q 99 0 70 80"/></svg>',
        encoding="utf-8",
    )
    script = (
        "import sys\nfrom voronoi_tiles.inkscape.extension import run\n"
        "sys.argv[1:] = ['tiles', '--id=p', '--cell=numbers', '--side_a=99', '--group=p4', 'a.svg']\n"
        "try:\n    run()\nexcept SystemExit as exit:\n    assert not exit.code, exit.code\n"
        "print(*sys.modules, file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True, cwd=tmp_path)
    assert (HEAVY | {"click"}) & set(done.stderr.splitlines()[-1].split()) == {"numpy", "tinycss2"}


SERVER = {"starlette", "uvicorn", "websockets"}
"""What the studio's server is made of."""


@pytest.mark.parametrize("command", ["--help", "studio --help", "export --help"])
def test_help_loads_nothing_heavy(command: str) -> None:
    """It is read before anything is done: neither numpy nor the studio's server is loaded for it."""
    script = (
        "import sys\nfrom voronoi_tiles.cli.main import run\n"
        f"sys.argv[1:] = {command.split()!r}\n"
        "try:\n    run()\nexcept SystemExit as exit:\n    assert not exit.code, exit.code\n"
        "print(*sys.modules, file=sys.stderr)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert not (HEAVY | SERVER) & set(done.stderr.split())


def test_openblas_starts_no_threads() -> None:
    """Its threads would take half as long as numpy's import; who sets their number is heard."""
    script = "import os\nfrom voronoi_tiles.cli import main\nmain._run = lambda: print(os.environ['{0}'])\nmain.run()"
    name = "OPENBLAS_NUM_THREADS"
    for environment, expected in (({}, "1"), ({name: "3"}, "3")):
        run = [sys.executable, "-c", script.format(name)]
        assert (
            subprocess.run(run, check=True, capture_output=True, text=True, env=environment).stdout == f"{expected}\n"
        )
