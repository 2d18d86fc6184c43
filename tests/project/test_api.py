"""The public names: which there are, that types cover them, that errors and reprs are as promised."""

from __future__ import annotations

import inspect
import io
import subprocess
import sys
import types
import typing
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import voronoi_tiles as vt
from voronoi_tiles.base import errors
from voronoi_tiles.cli.common import as_options

ROOT = Path(__file__).parents[2]

NAMES = """
Arc ArgumentError Art Burn CheckError CheckReport Design DesignError Dots Drawing DrawingError Exported Figure Finding
Fit Frame GROUPS GoalOutline GroupPlacement Inventory Isometry Job JobError Key Lattice Layer LayerUse Limits LineArc
Marks MissingLibraryError MovingPoints Neighbour NodedSite Operation Outline OutputError ParabolaArc Paths Placement
PreflightReport Product ProofError ProofReport Provenance ReadDrawing RenderError RenderOptions Rendering
SchedulerError Shape ShapeGradient Site Solid SolidJob SolidModel SolidPiece Stack StackJob StackSheet Stroke Sweep
SweepResult SweepTable Tile TileCopy TileGradient Tiling TouchingCopiesError TriangleMesh UnknownNameError
VoronoiTilesError WallpaperGroup __version__ bezier bspline catmull_rom circle coupon drawing extrude fit hermite path
placed point polyline preflight render segment stack stand starter starter_text sweep
"""

INTERNAL = {
    "Tessellation": "the engine's own form of a tiling: what Tiling.tessellation gives, for the package's own use",
    "CheckedSolid": "the geometry of a solid at its keys: what lofts are computed from; Design.solid is what was drawn",
    "Job": "its options are descriptors, and Option is their type to a class, not to a job",
}
"""What public objects give that is no public name, and why."""


def test_the_public_names() -> None:
    """A name more or less is a decision, made here."""
    assert sorted(vt.__all__) == sorted(NAMES.split())


LOCAL: dict[str, Any] = {}
"""Names that annotations take from imports for types alone."""


def members(cls: type) -> Iterator[tuple[str, Any]]:
    """The type hints of what a public class gives: its fields, properties, and the results of its methods."""
    if not issubclass(cls, BaseException):
        yield from (pair for pair in typing.get_type_hints(cls, localns=LOCAL).items() if not pair[0].startswith("_"))
    for name, member in vars(cls).items():
        if name.startswith("_"):
            continue
        function = member.fget if isinstance(member, property) else getattr(member, "func", member)
        function = getattr(function, "__func__", function)
        if inspect.isfunction(function):
            hints = typing.get_type_hints(function, localns=LOCAL)
            yield name, hints.get("return")


def own_types(hint: Any) -> Iterator[type]:
    """The classes of ours in a type hint."""
    if isinstance(hint, type) and hint.__module__.startswith("voronoi_tiles"):
        yield hint
    for part in typing.get_args(hint):
        yield from own_types(part)


def test_what_public_objects_give_is_public() -> None:
    """Every class of ours that a field, a property or a method gives is a public name."""
    import shapely

    LOCAL.update({name: getattr(vt, name) for name in vt.__all__})
    LOCAL.update({"MultiPolygon": shapely.MultiPolygon, "Polygon": shapely.Polygon})
    LOCAL.update({"Choice": str, "Method": str, "Edges": str})  # words that are taken, not given
    public = {id(getattr(vt, name)) for name in vt.__all__}
    hidden = {
        (name, member, given.__name__)
        for name in vt.__all__
        if inspect.isclass(cls := getattr(vt, name)) and name not in ("Job", "StackJob")
        for member, hint in members(cls)
        for given in own_types(hint)
        if id(given) not in public and given.__name__ not in INTERNAL
    }
    assert hidden == set()
    assert "Tessellation" in {t.__name__ for _, hint in members(vt.Tiling) for t in own_types(hint)}


# --- types ----------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def tree(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The package as it is installed, of links: vector/ and raster/ lie beside it in the checkout."""
    root = tmp_path_factory.mktemp("tree")
    package = root / "voronoi_tiles"
    package.mkdir()
    for part in (*(ROOT / "voronoi_tiles").iterdir(), ROOT / "vector", ROOT / "raster"):
        (package / part.name).symlink_to(part)
    return root


def test_a_script_type_checks(tree: Path) -> None:
    """mypy --strict finds nothing in typed_script.py but what its comments say is wrong."""
    script = Path(__file__).with_name("typed_script.py")
    call = ["-m", "mypy", "--strict", "--follow-imports=silent", "--cache-dir", str(tree / "cache"), str(script)]
    environment = {"MYPYPATH": str(tree), "PATH": "", "PYTHONPATH": ""}
    result = subprocess.run(
        [sys.executable, *call, "--config-file", str(ROOT / "pyproject.toml")],
        cwd=tree,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    found = {
        (int(line.split(":")[1]), line.rsplit("[", 1)[1].rstrip("]"))
        for line in result.stdout.splitlines()
        if ": error:" in line
    }
    expected = {
        (number, line.split("# wrong: ")[1])
        for number, line in enumerate(script.read_text().splitlines(), 1)
        if "# wrong: " in line
    }
    assert len(expected) > 5
    assert found == expected, result.stdout + result.stderr


def test_the_script_runs(tmp_path: Path) -> None:
    """What type-checks also works: the part of the script that is not wrong."""
    script = Path(__file__).with_name("typed_script.py")
    subprocess.run([sys.executable, "-W", "error", str(script)], cwd=tmp_path, check=True)
    assert {path.name for path in tmp_path.iterdir()} >= {"bird.toml", "bird.svg", "sheet.dxf", "bird.png"}


# --- errors ---------------------------------------------------------------------------------------------------------


def pair() -> vt.Tiling:
    """Two tiles."""
    return vt.starter("p4m").tessellate()


WRONG: list[Callable[[], object]] = [
    lambda: vt.Design("p5", 60, []),
    lambda: vt.Design.load("missing.toml"),
    lambda: vt.Design.loads("schema = 2"),
    lambda: vt.Site(5),  # type: ignore[arg-type]
    lambda: vt.starter("p5"),
    lambda: vt.starter_text("p5"),
    lambda: vt.Design("pm", (20, 20), vt.Site([vt.segment(-1, 1 + 1j)])).tessellate(),
    lambda: vt.Job(kerf=-1),
    lambda: vt.Job(kerf=[1]),  # type: ignore[arg-type]
    lambda: vt.Job(fit="half"),  # type: ignore[arg-type]
    lambda: vt.Job(sheet="15"),
    lambda: vt.Job(offset="3", sheet=(50, 50)),
    lambda: vt.Operation.parse("x"),
    lambda: vt.Operation.parse("2x,y"),
    lambda: vt.Lattice(1, -1j),
    lambda: vt.GROUPS["pm"].lattice(60),
    lambda: vt.GROUPS["p1"].lattice(60, 50),
    lambda: vt.Lattice(1, 2j).isometry(vt.Operation.parse("-y,x")),
    lambda: vt.Limits(neck=-1),
    lambda: vt.coupon(thickness=0),
    lambda: vt.coupon("c.png", thickness=3),
    lambda: vt.coupon(thickness=3, preset="laserjet"),
    lambda: vt.preflight("missing.svg"),
    lambda: vt.render(vt.starter("p4"), overlay="tea"),
    lambda: vt.render(vt.starter("p4"), method="magic"),  # type: ignore[call-overload]
    lambda: vt.render(vt.starter("p4"), renderer="cpu", size=0),
    lambda: vt.render(vt.starter("p4"), renderer="cpu", region=(1, 1, 0, 0)),
    lambda: vt.render(vt.starter("p4"), renderer="cpu", region=(1, 1, 0)),  # type: ignore[call-overload]
    lambda: vt.render(vt.starter("p4"), renderer="cpu", size=(1, 1, 0)),  # type: ignore[call-overload]
    lambda: vt.coupon(thickness=3, kerfs=["a"]),
    lambda: vt.starter("p4").moved(translate="x"),  # type: ignore[arg-type]
    lambda: vt.starter("p4").moved(scale=0),
    lambda: vt.Paths.empty().bounds,
    lambda: pair().check(renderer="cpu", samples=0),
    lambda: pair()["tree"],
    lambda: pair().copies(5),
    lambda: pair().text("png"),
    lambda: pair().export("a.png"),
    lambda: pair().export("a.json", job=vt.Job()),
    lambda: pair().make(file_format="stl"),
    lambda: pair().make(vt.Job(sheet=(5, 5))),
    lambda: pair().report(speeds={"cut": 0}),
    lambda: pair().check(renderer="magic"),  # type: ignore[arg-type]
    lambda: pair().check(renderer="cpu", samples=64).figure("none"),
    lambda: pair()[0].copy("x+1/3,y"),
    lambda: pair()[0].to_shapely(accuracy=0),
    lambda: pair()[0].outline.flatten(accuracy=float("nan")),
    lambda: pair().make((300, 200)),  # type: ignore[arg-type]
    lambda: vt.SolidJob(height=0),
    lambda: vt.extrude(pair(), vt.SolidJob(clearance=90)),
    lambda: vt.extrude(pair(), {"height": 3}),  # type: ignore[arg-type]
    lambda: vt.extrude(vt.starter("p4")),  # type: ignore[arg-type]
    lambda: vt.extrude(pair()).save("a.step"),
    lambda: vt.stand(vt.starter("p4")),
    lambda: vt.stack(vt.starter("p4"), vt.StackJob(sheets=3)),
    lambda: vt.StackJob(sheets=1.5),  # type: ignore[arg-type]
    lambda: pair().report({"kerf": 1}),  # type: ignore[arg-type]
    lambda: pair().export("a.svg", job=5),  # type: ignore[arg-type]
    lambda: pair().export("a\0.svg"),
    lambda: pair().export(b"a.svg"),  # type: ignore[arg-type]
    lambda: pair().export("a.svg", check=True),  # type: ignore[arg-type]
    lambda: pair().difference(None),  # type: ignore[arg-type]
    lambda: pair().report(speeds={"cut": "fast"}),  # type: ignore[dict-item]
    lambda: pair().report(pierce_s="5"),  # type: ignore[arg-type]
    lambda: pair().check(renderer="cpu", samples="5"),  # type: ignore[arg-type]
    lambda: pair().check(renderer="cpu", samples=32.5),  # type: ignore[arg-type]
    lambda: pair()[0].copy(None),  # type: ignore[arg-type]
    lambda: pair()[0].to_shapely(accuracy="1"),  # type: ignore[arg-type]
    lambda: pair().copies((0, 0, 10**400, 1)),
    lambda: vt.render(pair()),  # type: ignore[call-overload]
    lambda: vt.render(vt.starter("p4"), "a.jpg"),
    lambda: vt.render(vt.starter("p4"), size=True),
    lambda: vt.render(vt.starter("p4"), size=(32,)),  # type: ignore[arg-type]
    lambda: vt.render(vt.starter("p4"), size=10**400),
    lambda: vt.render(vt.starter("p4"), overlay=[5, "x"]),  # type: ignore[list-item]
    lambda: vt.render(vt.starter("p4"), region=(0, 0, 10**400, 5)),
    lambda: vt.Operation.parse("x+" + "9" * 5000 + ",y"),
    lambda: vt.Operation.parse("x+\u0663,y"),
    lambda: vt.Operation.parse(5),  # type: ignore[arg-type]
    lambda: vt.GROUPS["p1"].lattice(4, 5, float("nan")),
    lambda: vt.Lattice(float("inf"), 1j),
    lambda: vt.Limits(neck="2mm"),  # type: ignore[arg-type]
    lambda: vt.Limits(neck=True),
    lambda: vt.Limits(tolerance=1e300),
    lambda: vt.Job(kerf=np.zeros((2, 2))),  # type: ignore[arg-type]
    lambda: vt.Job(kerf=10**5000),
    lambda: vt.Job(rotate="30deg"),  # type: ignore[arg-type]
    lambda: vt.Job(fit=np.zeros(3)),  # type: ignore[arg-type]
    lambda: vt.starter("p4").save("a\0.toml"),
    lambda: vt.Design("p4", 60, vt.Site([vt.polyline(np.array(5))])),
    lambda: vt.coupon(5, thickness=3),  # type: ignore[arg-type]
    lambda: vt.coupon(thickness=3, preset=5),  # type: ignore[arg-type]
    lambda: vt.coupon(thickness=3, preset=Path("laserjet")),
    lambda: pair().template(5),  # type: ignore[arg-type]
    lambda: pair().template("a.svg", site=9),  # type: ignore[arg-type]
    lambda: pair().make().save(5),  # type: ignore[arg-type]
    lambda: pair().render(size=20, renderer="cpu").save(5),  # type: ignore[arg-type]
    lambda: pair().report(speeds=5),  # type: ignore[arg-type]
    lambda: pair().render(overlay=5),  # type: ignore[call-overload]
    lambda: pair().make(vt.Job(sheet=(200, 100), colours="layers", only_colour=9)),
    lambda: vt.starter([]),  # type: ignore[arg-type]
    lambda: vt.Design("p4", 60, vt.Site([vt.polyline(5)]).moved(mirror=True)),  # type: ignore[arg-type]
    lambda: vt.Design("p4", 60, vt.Site([vt.hermite([0, 5], [1, "x"])]).moved(mirror=True)),  # type: ignore[list-item]
    lambda: vt.Design("p4", 60, vt.Site([vt.drawing("none.svg")])),
    lambda: vt.starter("p4").scaled(tile_width=-1),
    lambda: vt.starter("p4").scaled(2, tile_width=9),
    lambda: vt.starter("p4").scaled(),
    lambda: vt.Design("p4", 60, vt.Site([vt.point(0)]), folder=5),  # type: ignore[arg-type]
    lambda: vt.starter("p4").save(b"a.toml"),  # type: ignore[arg-type]
    lambda: vt.starter("p4").replace(name=5),  # type: ignore[arg-type]
    lambda: vt.starter("p4").replace(group=""),
    lambda: vt.starter("p4").scaled(float("inf")),
    lambda: vt.Design.loads(vt.starter("p4").to_toml(), name="a\0b"),
    lambda: vt.Design.load(5),  # type: ignore[arg-type]
    lambda: vt.render(vt.starter("p4"), device="first"),  # type: ignore[call-overload]
    lambda: vt.render(vt.starter("p4"), notice=3),  # type: ignore[call-overload]
    lambda: vt.render(vt.starter("p4"), progress="bar"),  # type: ignore[call-overload]
    lambda: vt.Design("p4", 60, vt.Site([vt.point(10**400)])),
    lambda: vt.Design("p4", 60, vt.Site([vt.segment(0, 1, rotate=np.float16("inf"))])),  # type: ignore[arg-type]
    lambda: vt.Design("p4", 60, vt.Site([vt.point(0)], tolerance=np.timedelta64(1, "s"))),  # type: ignore[arg-type]
]


@pytest.mark.parametrize("call", WRONG, ids=range(len(WRONG)))
def test_every_error_is_one_of_ours(
    call: Callable[[], object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And a built-in one as well, with a message of one line that speaks of arguments, not of options."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(vt.VoronoiTilesError) as caught:
        call()
    builtin = ValueError, OSError, ArithmeticError, LookupError, RuntimeError, ImportError
    assert isinstance(caught.value, builtin)
    message = str(caught.value)
    assert message.endswith(".")
    assert "\n" not in message
    assert "--" not in message
    assert list(tmp_path.iterdir()) == []


def test_every_error_has_two_roots() -> None:
    """Each leaf is a VoronoiTilesError and a built-in error, and is public."""
    leaves = [
        value
        for name, value in vars(errors).items()
        if isinstance(value, type) and issubclass(value, errors.VoronoiTilesError) and not name.startswith("_")
    ]
    assert len(leaves) > 8
    for leaf in leaves:
        assert getattr(vt, leaf.__name__) is leaf
        if leaf is not errors.VoronoiTilesError:
            assert any(base.__module__ == "builtins" and base is not Exception for base in leaf.__mro__[:-3]), leaf


def test_messages_name_fields_and_the_command_line_makes_options_of_them() -> None:
    """The error carries the names; other words in backquotes stay what they are not."""
    with pytest.raises(vt.JobError) as caught:
        vt.Job(kerf=0.15, edges="once")
    assert caught.value.fields == ("kerf", "edges")
    assert str(caught.value) == (
        "`kerf` needs `edges='pieces'`: an edge that is cut once belongs to two of them. Use that, or leave `kerf` out."
    )
    assert as_options(str(caught.value)) == (
        "--kerf needs --edges pieces: an edge that is cut once belongs to two of them. Use that, or leave --kerf out."
    )
    assert as_options("`label_height=3`, `marks=True`, `layers=['NAME']`, `a b`") == (
        "--label-height 3, --marks, --layer NAME, `a b`"
    )


# --- reprs ----------------------------------------------------------------------------------------------------------


def test_reprs_are_short() -> None:
    """One line for a terminal, whatever arrays an object holds."""
    tiling = pair()
    product = tiling.make(vt.Job(sheet=(200, 200), kerf=0.2))
    report = tiling.check(samples=64, renderer="cpu")
    layer = product.drawing.layers[0]
    buffer = io.BytesIO()
    product.write(buffer)
    shown = [
        tiling,
        *tiling,
        tiling.design,
        *tiling.design.sites,
        *tiling.design.sites[0].strokes,
        *tiling.design.noded,
        tiling[0].outline,
        tiling[0].outline.rings[0][0],
        tiling[0].outline.neighbours[0],
        tiling.proof,
        tiling.copies((0, 0, 1, 1))[0],
        tiling.design.lattice,
        tiling.design.group,
        *tiling.design.group.operations,
        report,
        report.figures[0].marks,
        report.frame,
        report.provenance,
        product,
        product.pieces,
        product.drawing,
        layer,
        layer.paths,
        vt.Job(),
        vt.Job(sheet=(200, 200)),
        vt.Art("face.svg", rotate=3),
        vt.Placement(2.0),
        vt.Limits(),
        vt.render(tiling.design, size=20, renderer="cpu"),
    ]
    for value in shown:
        text = repr(value)
        assert "\n" not in text
        assert "array(" not in text
        assert len(text) <= 330, text
    assert repr(vt.Job()) == "Job()"
    assert repr(tiling.design.group) == "<WallpaperGroup p4m: square, of order 8>"
    assert repr(tiling.design.group.operations[1]) == "Operation.parse('-x,-y')"
    assert isinstance(vt.preflight, types.ModuleType | types.FunctionType)
    assert np.all(np.isfinite(layer.paths.lengths))
