"""Other makers' programs that read our files, and the files that they are sent."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal, NamedTuple

Environment = Literal["python", "cadquery", "build123d", "blender", "node", "freecad", "own"]
"""Which interpreter runs a script: of an environment in FOLDER, node, the distribution's, or that of the tests."""

PIECES: Final = """\
schema = 1
group = "p4"

[cell]
a = 60.0

[[site]]
name = "ring"
strokes = [
  { polyline = [[8, 9], [21, 7], [23, 20], [9, 22]], closed = true },
  { segment = [[21, 7], [27, 12]] },
]

[[site]]
name = "stone"
strokes = [{ polyline = [[14, 13], [17, 16], [14, 17]] }]
"""
"""The design of all files: a tile with a hole, and the tile that lies in it; lines and parabolas."""

ACCURACY: Final = 0.005
"""How far curves may be off in a file, where the command does not say; millimetres."""

DIGITS: Final = 0.0005
"""What a program may add by its own digits; millimetres."""


@dataclass(frozen=True)
class Program:
    """A program: where it comes from, the script that asks it, the formats that it reads, what to send it.

    `sends` are keys of FILES: the file to send it, then those that one might try as well. `heavy` is what is too large
    to be installed for every run of the tests.
    """

    name: str
    source: str
    script: str
    environment: Environment
    sends: tuple[str, ...]
    heavy: bool = False

    @property
    def files(self) -> list[str]:
        """The files, each once: the one to send comes first."""
        return list(dict.fromkeys(self.sends))

    @property
    def recommended(self) -> list[str]:
        """Those to send: made for the program, or the first."""
        return [name for name in self.files if name not in PLAIN] or self.files[:1]


class File(NamedTuple):
    """A file of ours: its suffix and the job."""

    suffix: str
    job: Mapping[str, Any]

    @property
    def options(self) -> str:
        """The job as options of the command line."""
        return " ".join(f"--{key.replace('_', '-')} {value}" for key, value in self.job.items())

    @property
    def command(self) -> str:
        """The command that makes it."""
        return f"voronoi-tiles export pieces.toml -o a.{self.suffix} {self.options}"

    @property
    def shown(self) -> str:
        """The format and the options that are its own."""
        own = self.options.replace("--gap 1mm", "").strip()
        return f"`.{self.suffix}`" + (f", `{own}`" if own else "")


_APART: Final = {"gap": "1mm"}
_TOUCHING: Final = {"sheet": "150x150mm", "edges": "pieces"}

PLAIN: Final[Mapping[str, File]] = {
    "SVG": File("svg", _APART),
    "SVG, cubics": File("svg", {**_APART, "curves": "spline"}),
    "SVG, arcs": File("svg", {**_APART, "curves": "arc"}),
    "SVG, chords": File("svg", {**_APART, "curves": "polyline"}),
    "DXF": File("dxf", _APART),
    "DXF, splines": File("dxf", {**_APART, "curves": "spline"}),
    "DXF, chords": File("dxf", {**_APART, "curves": "polyline"}),
    "DXF, R12": File("dxf", {**_APART, "curves": "polyline", "dxf_version": "R12"}),
    "PDF": File("pdf", _APART),
    "LightBurn": File("lbrn2", _APART),
    "SVG, touching": File("svg", _TOUCHING),
    "DXF, touching": File("dxf", _TOUCHING),
}
"""What is tried without a preset, by its name in the page."""

PRESETS: Final = {
    "svg": ("blender", "build123d", "freecad", "inkscape", "jscad", "meerk40t", "openscad"),
    "dxf": ("cadquery", "freecad", "inkscape", "jscad", "openscad", "trimesh"),
}
"""The presets of programs, by the formats that they are tried in."""

FILES: Final[Mapping[str, File]] = {
    **PLAIN,
    **{
        f"{name} {suffix}": File(suffix, {**_APART, "preset": name})
        for suffix, names in PRESETS.items()
        for name in names
    },
    "SVG, margin": File("svg", {**_APART, "margin": "1mm"}),
}
"""All that is sent."""

_SVG = tuple(name for name, file in PLAIN.items() if file.suffix == "svg")
_DXF = tuple(name for name, file in PLAIN.items() if file.suffix == "dxf")

PROGRAMS: Final = (
    Program("Blender", "PyPI: bpy", "read_blender.py", "blender", ("blender svg", *_SVG), heavy=True),
    Program("build123d", "PyPI", "read_build123d.py", "build123d", ("build123d svg", *_SVG), heavy=True),
    Program("CadQuery", "PyPI", "read_cadquery.py", "cadquery", ("cadquery dxf", *_DXF), heavy=True),
    Program("dxf-parser", "npm", "read_dxf_parser.mjs", "node", _DXF),
    Program("ezdxf", "PyPI", "read_ezdxf.py", "python", _DXF),
    Program(
        "FreeCAD", "Debian", "read_freecad.py", "freecad", ("freecad svg", "freecad dxf", *_SVG, *_DXF), heavy=True
    ),
    Program("Inkscape", "Debian", "read_inkscape.py", "own", ("inkscape svg", "inkscape dxf", *_SVG, *_DXF, "PDF")),
    Program("JSCAD, DXF", "npm: @jscad/dxf-deserializer", "read_jscad_dxf.mjs", "node", ("jscad dxf", *_DXF)),
    Program("JSCAD, SVG", "npm: @jscad/svg-deserializer", "read_jscad_svg.mjs", "node", ("jscad svg", *_SVG)),
    Program("LibreCAD", "Debian", "read_librecad.py", "own", _DXF),
    Program("Maker.js", "npm: makerjs", "read_makerjs.mjs", "node", _SVG),
    Program("MeerK40t", "PyPI", "read_meerk40t.py", "python", ("meerk40t svg", *_SVG, *_DXF, "LightBurn")),
    Program("OpenSCAD", "Debian", "read_openscad.py", "own", ("openscad svg", "openscad dxf", *_SVG, *_DXF)),
    Program("Paper.js", "npm: paper", "read_paper.mjs", "node", _SVG),
    Program("resvg", "PyPI: resvg_py", "read_resvg.py", "python", ("SVG",)),
    Program("svg-to-gcode", "PyPI", "read_svg_to_gcode.py", "python", _SVG),
    Program("svgelements", "PyPI", "read_svgelements.py", "python", _SVG),
    Program("SVGO", "npm", "read_svgo.mjs", "node", _SVG),
    Program("svgpathtools", "PyPI", "read_svgpathtools.py", "python", _SVG),
    Program("three.js", "npm: three", "read_three.mjs", "node", _SVG),
    Program("trimesh", "PyPI", "read_trimesh.py", "python", ("trimesh dxf", *_DXF, *_SVG)),
    Program("vpype", "PyPI", "read_vpype.py", "python", ("SVG, margin", *_SVG)),
)
