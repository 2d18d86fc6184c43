"""The arrows between modules run one way: vocabulary <- stages <- pipeline <- command line."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

STAGES = ("vector", "raster")
PIPELINE = "voronoi_tiles.tiling"

# All other modules of voronoi_tiles are vocabulary: a new one has to keep to its rules.
ABOVE_THE_STAGES = {"__init__", "__main__", "cli", "coupon", "files", "lettering", "marks", "picture"} | {
    "starters",
    "tables",
    "tiling",
}
VOCABULARY = {path.stem for path in (ROOT / "voronoi_tiles").glob("*.py")} - ABOVE_THE_STAGES

# Design.tessellate() is a convenience of the pipeline's; its result needs a type.
DEFERRED = {"Design.tessellate", "TYPE_CHECKING"}


def imports(tree: ast.Module, package: str) -> Iterator[tuple[str, str]]:
    """Give every imported module, with what is around it: "Design.tessellate", "TYPE_CHECKING"."""

    def visit(node: ast.AST, scope: str) -> Iterator[tuple[str, str]]:
        match node:
            case ast.Import(names):
                yield from ((name.name, scope) for name in names)
            case ast.ImportFrom(module, names, level):
                parts = package.split(".")[: len(package.split(".")) + 1 - level] if level else []
                base = ".".join([*parts, *([module] if module else [])])
                yield base, scope
                yield from ((f"{base}.{name.name}", scope) for name in names)
            case ast.Call(
                ast.Name("__import__" | "import_module") | ast.Attribute(attr="import_module"),
                [ast.Constant(str(name)), *_],
            ):
                yield name, scope
            case ast.FunctionDef(name) | ast.AsyncFunctionDef(name) | ast.ClassDef(name):
                scope = f"{scope}.{name}".removeprefix(".")
            case ast.If(ast.Name("TYPE_CHECKING")):
                scope = "TYPE_CHECKING"
        for child in ast.iter_child_nodes(node):
            yield from visit(child, scope)

    return visit(tree, "")


def violations(source: str, module: str) -> list[str]:
    """Give the imports of a module that break the rules."""
    package, _, name = module.rpartition(".")
    is_vocabulary = package == "voronoi_tiles" and name in VOCABULARY
    stage = next((stage for stage in STAGES if module.startswith(f"voronoi_tiles.{stage}")), None)
    allowed = tuple(f"voronoi_tiles.{name}" for name in VOCABULARY)
    found = []
    for imported, scope in imports(ast.parse(source), package):
        top, *_ = imported.split(".")
        if top in STAGES:
            found.append(f"{module} imports {imported}: the bare name is another package")
        if top != "voronoi_tiles" or not (is_vocabulary or stage):
            continue
        own = stage is not None and f"{imported}.".startswith(f"voronoi_tiles.{stage}.")
        version = imported in {"voronoi_tiles", "voronoi_tiles.__version__"}
        deferred = module == "voronoi_tiles.design" and imported.startswith(PIPELINE) and scope in DEFERRED
        known = any(f"{imported}.".startswith(f"{word}.") for word in allowed)
        if not (own or version or deferred or known):
            found.append(f"{module} imports {imported}")
    return found


def modules() -> dict[str, Path]:
    """Give every module of the package by its installed name."""
    homes = {"voronoi_tiles": "voronoi_tiles", "vector": "voronoi_tiles.vector", "raster": "voronoi_tiles.raster"}
    return {
        f"{package}.{path.relative_to(ROOT / folder).with_suffix('').as_posix().replace('/', '.')}": path
        for folder, package in homes.items()
        for path in (ROOT / folder).rglob("*.py")
    }


@pytest.mark.parametrize("module", sorted(modules()))
def test_imports_follow_the_arrows(module: str) -> None:
    """No module imports what stands above it, or beside it in the other stage."""
    assert violations(modules()[module].read_text(encoding="utf-8"), module) == []


def test_the_vocabulary_is_all_there() -> None:
    """The rules are about modules that exist."""
    assert {"errors", "tolerance", "wallpaper", "strokes", "svgpath", "site", "design"} <= VOCABULARY
    assert {f"voronoi_tiles.{name}" for name in ABOVE_THE_STAGES | VOCABULARY} <= set(modules())
    assert {
        "voronoi_tiles.crosscheck.__init__",
        "voronoi_tiles.vector.__init__",
        "voronoi_tiles.raster.__init__",
        PIPELINE,
    } <= set(modules())


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("voronoi_tiles.site", "from voronoi_tiles.vector.outline import Outline"),
        ("voronoi_tiles.site", "def f():\n    import voronoi_tiles.raster"),
        ("voronoi_tiles.site", "from voronoi_tiles import vector"),
        ("voronoi_tiles.site", "from .vector import outline"),
        ("voronoi_tiles.design", "from voronoi_tiles.tiling import tessellate"),
        ("voronoi_tiles.design", "class Design:\n    def load(self):\n        from voronoi_tiles.tiling import Tiling"),
        ("voronoi_tiles.strokes", "from voronoi_tiles import cli"),
        ("voronoi_tiles.vector.trace", "from voronoi_tiles.raster import shaders"),
        ("voronoi_tiles.vector.trace", "import voronoi_tiles.raster.shaders as s"),
        ("voronoi_tiles.vector.trace", "from voronoi_tiles.tiling import Tile"),
        ("voronoi_tiles.vector.trace", "from .. import tiling"),
        ("voronoi_tiles.vector.trace", "from importlib import import_module\nimport_module('voronoi_tiles.cli')"),
        ("voronoi_tiles.raster.image", "if TYPE_CHECKING:\n    from voronoi_tiles.vector.outline import Outline"),
        ("voronoi_tiles.raster.image", "from voronoi_tiles.files import write_whole"),
        ("voronoi_tiles.raster.image", "from voronoi_tiles.crosscheck import Figure"),
        ("voronoi_tiles.site", "from voronoi_tiles.crosscheck import Figure"),
        ("voronoi_tiles.cli", "import vector"),
        ("voronoi_tiles.cli", "from raster.image import render"),
    ],
)
def test_a_violation_is_caught(module: str, source: str) -> None:
    """The checker sees every way to import, at the top of a module and inside functions."""
    assert violations(source, module) != []


@pytest.mark.parametrize(
    ("module", "source"),
    [
        (
            "voronoi_tiles.design",
            "class Design:\n    def tessellate(self):\n        from voronoi_tiles.tiling import f",
        ),
        ("voronoi_tiles.vector.trace", "from . import arcs\nfrom voronoi_tiles.site import Site\nimport numpy as np"),
        (
            "voronoi_tiles.raster.image",
            "from voronoi_tiles import __version__\nfrom voronoi_tiles.design import Design",
        ),
        ("voronoi_tiles.tiling", "from voronoi_tiles.vector.outline import Outline"),
    ],
)
def test_what_is_allowed_passes(module: str, source: str) -> None:
    """The checker does not cry wolf."""
    assert violations(source, module) == []
