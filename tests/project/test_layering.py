"""The arrows between packages run one way: a package imports lower ranks only, and the two stages never each other."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

RANKS = (
    ("base",),
    ("groups", "parallel", "paths"),
    ("formats",),
    ("designs",),
    ("vector", "raster"),
    ("fabrication", "preflight", "crosscheck", "pictures", "gradients"),
    ("tile",),
    ("tiling",),
    ("escherization", "solid", "sweeps"),
    ("blender", "inkscape", "studio"),
    ("cli",),
)
"""Every package and module below the root package; those of one rank do not import each other, but for BESIDE."""

BESIDE = {("pictures", "crosscheck"), ("pictures", "fabrication")}
"""Within a rank: pictures show what the cross-check found, and the art of sites."""

FACE = ("__init__", "__main__")
"""The modules of the root package itself: they hand on what users ask for, and may import anything."""

UPWARDS = {
    ("voronoi_tiles.designs.design", "Design.tessellate", "voronoi_tiles.tiling"),
    ("voronoi_tiles.designs.design", "TYPE_CHECKING", "voronoi_tiles.tiling"),
    ("voronoi_tiles.designs.design", "Design._repr_svg_", "voronoi_tiles.pictures"),
}
"""(module, scope, what is imported): conveniences for users, deferred; the type of a result."""

RANK = {name: rank for rank, names in enumerate(RANKS) for name in names}
STAGES = ("vector", "raster")


@cache
def modules() -> dict[str, Path]:
    """Every module of the product by its installed name; looked for once."""
    homes = {"voronoi_tiles": "voronoi_tiles", "vector": "voronoi_tiles.vector", "raster": "voronoi_tiles.raster"}
    return {
        ".".join((package, *path.relative_to(ROOT / folder).with_suffix("").parts)): path
        for folder, package in homes.items()
        for path in (ROOT / folder).rglob("*.py")
    }


def imports(tree: ast.Module, package: str) -> Iterator[tuple[str, str]]:
    """Every imported module or name of one, with what is around it: "Design.tessellate", "TYPE_CHECKING", ""."""

    def visit(node: ast.AST, scope: str) -> Iterator[tuple[str, str]]:
        match node:
            case ast.Import(names):
                yield from ((name.name, scope) for name in names)
            case ast.ImportFrom(module, names, level):
                parts = package.split(".")[: len(package.split(".")) + 1 - level] if level else []
                base = ".".join([*parts, *([module] if module else [])])
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


def place(module: str) -> str | None:
    """The package below the root that a module belongs to; None for the root package and what is no module."""
    parts = module.split(".")
    return parts[1] if len(parts) > 1 and parts[1] in RANK else None


def violations(source: str, module: str) -> list[str]:
    """The imports of a module that break the rules."""
    package, _, name = module.rpartition(".")
    own = place(module)
    found = []
    for imported, scope in imports(ast.parse(source), package):
        top, *_ = imported.split(".")
        if top in STAGES:
            found.append(f"{module} imports {imported}: the bare name is another package")
        if top != "voronoi_tiles" or (package == "voronoi_tiles" and name in FACE):
            continue
        other = place(imported)
        if own is None:
            found.append(f"{module} has no rank")
        elif other is None:
            found.append(f"{module} imports {imported}: the face of the package stands above it")
        elif not (
            own == other
            or RANK[other] < RANK[own]
            or (own, other) in BESIDE
            or any((module, scope) == allowed[:2] and imported.startswith(allowed[2]) for allowed in UPWARDS)
        ):
            found.append(f"{module} imports {imported}: {other} is not below {own}")
    return found


def cycle(arrows: dict[str, set[str]]) -> list[str]:
    """A cycle of a directed graph, empty where there is none."""
    done: set[str] = set()

    def visit(node: str, path: list[str]) -> list[str]:
        if node in path:
            return path[path.index(node) :]
        if node in done:
            return []
        for other in sorted(arrows.get(node, ())):
            found = visit(other, [*path, node])
            if found:
                return found
        done.add(node)
        return []

    return next((found for node in sorted(arrows) if (found := visit(node, []))), [])


def arrows_between_modules() -> dict[str, set[str]]:
    """For each module those that it imports, deferred and for types alike, without UPWARDS."""
    files = modules()
    names = {name.removesuffix(".__init__"): name for name in files}
    arrows: dict[str, set[str]] = {module: set() for module in files}
    for module, path in files.items():
        for imported, scope in imports(ast.parse(path.read_text(encoding="utf-8")), module.rpartition(".")[0]):
            home = names.get(imported) or names.get(imported.rpartition(".")[0])
            upwards = any((module, scope) == allowed[:2] and imported.startswith(allowed[2]) for allowed in UPWARDS)
            if home is not None and not upwards:
                arrows[module].add(home)
    return arrows


@pytest.mark.parametrize("module", sorted(modules()))
def test_imports_follow_the_ranks(module: str) -> None:
    """No module imports what stands above it, or beside it in the other stage."""
    assert violations(modules()[module].read_text(encoding="utf-8"), module) == []


def test_every_package_has_a_rank_and_every_rank_is_there() -> None:
    """The table is about packages that exist, and about all of them."""
    found = {name.split(".")[1] for name in modules()} - set(FACE)
    assert found == set(RANK)


def test_no_module_imports_itself_round_a_corner() -> None:
    """There is no cycle of imports, deferred ones and those for types included."""
    assert cycle(arrows_between_modules()) == []


def test_a_cycle_is_found() -> None:
    """The search for cycles can fail."""
    assert cycle({"a": {"b"}, "b": {"c"}, "c": {"b"}}) == ["b", "c"]
    assert cycle({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == []


TWIN_FILES = {
    "reader": {"formats.svg", "formats.dxf", "formats.gcode"},
    "writer": {"formats.svg", "formats.dxf", "formats.gcode"},
}
"""Names of modules that may occur more than once: one format's reader or writer each."""


def test_module_names_are_unique() -> None:
    """No two modules share a name, but readers and writers of formats, and commands named as what they run."""
    by_stem: dict[str, set[str]] = {}
    for module in modules():
        package, _, stem = module.removeprefix("voronoi_tiles.").rpartition(".")
        if not stem.startswith("__") and package != "cli":
            by_stem.setdefault(stem, set()).add(package)
    assert {stem: homes for stem, homes in by_stem.items() if len(homes) > 1 and homes != TWIN_FILES.get(stem)} == {}


def test_class_names_are_unique() -> None:
    """No two classes share a name, private ones included."""
    names = Counter(
        node.name.lstrip("_")
        for path in modules().values()
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef)
    )
    assert {name: count for name, count in names.items() if count > 1} == {}


def test_no_module_is_long() -> None:
    """A module beyond 400 lines holds two ideas."""
    lengths = {name: len(path.read_text(encoding="utf-8").splitlines()) for name, path in modules().items()}
    assert {name: length for name, length in lengths.items() if length > 400} == {}


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("voronoi_tiles.designs.site", "from voronoi_tiles.vector.outline import Outline"),
        ("voronoi_tiles.designs.site", "def f():\n    import voronoi_tiles.raster"),
        ("voronoi_tiles.designs.site", "from voronoi_tiles import vector"),
        ("voronoi_tiles.designs.site", "from ..vector import outline"),
        ("voronoi_tiles.designs.site", "from voronoi_tiles import Tiling"),
        ("voronoi_tiles.designs.design", "from voronoi_tiles.tiling import tessellate"),
        (
            "voronoi_tiles.designs.design",
            "class Design:\n    def load(self):\n        from voronoi_tiles.tiling import Tiling",
        ),
        ("voronoi_tiles.paths.paths", "from voronoi_tiles.groups.wallpaper import Lattice"),
        ("voronoi_tiles.base.errors", "if TYPE_CHECKING:\n    from voronoi_tiles.groups.wallpaper import GROUPS"),
        ("voronoi_tiles.formats.page", "from voronoi_tiles import cli"),
        ("voronoi_tiles.vector.scan", "from voronoi_tiles.raster import frame"),
        ("voronoi_tiles.vector.scan", "import voronoi_tiles.raster.frame as s"),
        ("voronoi_tiles.vector.scan", "from voronoi_tiles.tiling import Tile"),
        ("voronoi_tiles.vector.scan", "from .. import tiling"),
        ("voronoi_tiles.vector.scan", "from importlib import import_module\nimport_module('voronoi_tiles.cli')"),
        ("voronoi_tiles.raster.frame", "if TYPE_CHECKING:\n    from voronoi_tiles.vector.outline import Outline"),
        ("voronoi_tiles.raster.frame", "from voronoi_tiles.crosscheck import Figure"),
        ("voronoi_tiles.fabrication.job", "from voronoi_tiles.crosscheck import Figure"),
        ("voronoi_tiles.fabrication.job", "from voronoi_tiles.tiling import Tiling"),
        ("voronoi_tiles.new", "from voronoi_tiles.base import errors"),
        ("voronoi_tiles.cli.main", "import vector"),
        ("voronoi_tiles.cli.main", "from raster.frame import Frame"),
    ],
)
def test_a_violation_is_caught(module: str, source: str) -> None:
    """The checker sees every way to import, at the top of a module and inside functions."""
    assert violations(source, module) != []


@pytest.mark.parametrize(
    ("module", "source"),
    [
        (
            "voronoi_tiles.designs.design",
            "class Design:\n    def tessellate(self):\n        from voronoi_tiles.tiling import f",
        ),
        (
            "voronoi_tiles.vector.scan",
            "from . import arcs\nfrom voronoi_tiles.designs.site import NodedSite\nimport numpy",
        ),
        ("voronoi_tiles.raster.frame", "from voronoi_tiles.base.arrays import Floats"),
        ("voronoi_tiles.tiling", "from voronoi_tiles.vector.outline import Outline"),
        ("voronoi_tiles.cli.main", "from voronoi_tiles.tiling import Tiling"),
        ("voronoi_tiles.__init__", "from voronoi_tiles.cli.main import main"),
    ],
)
def test_what_is_allowed_passes(module: str, source: str) -> None:
    """The checker does not cry wolf."""
    assert violations(source, module) == []
