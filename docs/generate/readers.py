"""Make docs/readers.md: what other programs make of our files, measured with those that are here.

`make readers` installs the programs and runs this. What is measured stands in readers.json beside this script, program
by program, each with its date: a program that is missing keeps the row that it has.
"""

from __future__ import annotations

import argparse
import datetime as dt
import json
import math
import sys
import tempfile
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from string import Template
from typing import Any

ROOT = Path(__file__).parents[2]
sys.path.append(str(ROOT / "tests"))

from helpers.programs import (  # noqa: E402 - from the tests
    ACCURACY,
    DIGITS,
    FILES,
    PIECES,
    PLAIN,
    PROGRAMS,
    Program,
)
from helpers.readers import Files, MissingProgramError, ReadingError  # noqa: E402 - from the tests

MEASURED = Path(__file__).with_suffix(".json")
TEMPLATE = Path(__file__).with_name("readers-template.md")
PAGE = ROOT / "docs" / "readers.md"

PROCESSES = 2
"""How many programs run at a time; a count."""

REMARKS = {
    "Blender": "its importer bends every `Q` into a lopsided curve; `C` is right. In files in millimetres its y is"
    " 0.02 % short, 0.1 mm on 600.",
    "build123d": "without a fill outlines are wires, and holes no holes; the preset fills them.",
    "CadQuery": "makes faces of each layer by itself: a hole on INNER becomes a face; the preset has it on CUT.",
    "dxf-parser": "hands on what stands in the file: bulges of polylines, control points of splines.",
    "ezdxf": "",
    "FreeCAD": "`Shape.BoundBox` is that of the control points: ask `optimalBoundingBox(False)`. DXF comes as"
    " loose edges: `Part.sortEdges`. Where one spline is a whole border, area and volume of its face are wrong by up to"
    " 30 %.",
    "Inkscape": "DXF is read by its extension, with the unit of the file.",
    "JSCAD, DXF": "arcs under 45 degrees become chords, splines are left out, polylines of R12 come in open.",
    "JSCAD, SVG": '`target: "path"`, then `geom2.fromPoints`: with `target: "geom2"` a path has one side. Curves become'
    " chords, `segments` of them a turn.",
    "LibreCAD": "printed, and measured on its raster of 0.02 mm; prints are 0.02 % too large.",
    "Maker.js": "fits arcs to curves with an error relative to their size, and others to a curve run backwards: set"
    " `bezierAccuracy: 0.005`.",
    "MeerK40t": "black is rastered, only `#ff0000` is cut, as the preset has it. Holes come first only after"
    " `set -p planner opt_effect_combine False`. Files for LightBurn come in as their mirror image.",
    "OpenSCAD": "closed paths are filled each by itself, so that a hole in a path of its own is lost, and what touches"
    " is united; the preset avoids both. Curves become 20 chords, whatever `$fn`.",
    "Paper.js": "user units, which are millimetres here.",
    "resvg": "refuses a size in millimetres unless `dpi` is given; measured on a raster of 0.01 mm, with half the width"
    " of the line.",
    "svg-to-gcode": "lines within its own 0.01 mm. Let no optimiser run before it: it misreads `S`.",
    "svgelements": "`ppi=25.4` gives millimetres.",
    "SVGO": "not for files that are cut: shared curves part by 0.001 mm, layers go, and where the size is shorter in"
    " pixels it writes pixels, of which OpenSCAD counts 72 to the inch: parts are 4/3 as large.",
    "svgpathtools": "leaves the page's size to the caller.",
    "three.js": "user units, which are millimetres here.",
    "trimesh": "its extents are those of the control points. Curved outlines that touch are mixed up; the preset pulls"
    " them apart.",
    "vpype": "crops at the page's edge: leave a margin. For G-code take the profile `gcodemm`; `gcode` is in inches.",
}
"""What one has to know of a program besides the figures."""


def measure(program: Program, files: Files) -> dict[str, Any]:
    """What a program makes of the files that one may send it. Raises MissingProgramError."""
    found: dict[str, Any] = {}
    version = ""
    for name in program.files:
        try:
            version, verdict = files.judged(program, name)
        except ReadingError as error:
            found[name] = {"error": error.kind}
        else:
            found[name] = {key: _kept(value) for key, value in verdict._asdict().items()}
    today = dt.datetime.now(tz=dt.UTC).date().isoformat()
    return {"version": version, "date": today, "files": found}


def _kept(value: Any) -> Any:
    """A figure as it is kept: six digits; the distance of what has not arrived at all is None."""
    if not isinstance(value, float):
        return value
    return float(f"{value:.6g}") if math.isfinite(value) else None


def cell(found: Mapping[str, Any]) -> str:
    """What became of a file, in a word or a number of millimetres; bold where it is not as it should be."""
    fault = _fault(found)
    if fault:
        return f"**{fault}**"
    off = found["deviation"]
    text = "< 0.0001" if off < 1e-4 else f"{off:.2g}"
    return f"**{text}**" if off > ACCURACY + DIGITS else text


def _fault(found: Mapping[str, Any]) -> str:
    """What is wrong besides the curves; empty if nothing is."""
    if "error" in found:
        return f"`{found['error']}`"
    faults = {
        "nothing": not found["scale"],
        f"{found['scale']:.3g} x": abs(found["scale"] - 1) > 0.01,
        f"{found['contours']} of {found['drawn']} contours": found["contours"] not in (None, found["drawn"]),
        f"{found['loose']} open": found["loose"],
        "mirrored": found["mirrored"],
    }
    return next((name for name, present in faults.items() if present), "")


def says(found: Mapping[str, Any]) -> str:
    """What a program says itself of size and area, where that is not so."""
    parts = []
    if abs(found.get("size") or 0.0) > 2 * ACCURACY:
        parts.append(f"size {found['size']:+.2f} mm")
    if abs(found.get("area") or 0.0) > 1e-3:
        parts.append(f"area {found['area']:+.1%}".replace("%", " %"))
    return ", ".join(parts)


def to_send(measured: Mapping[str, Any]) -> str:
    """The table of what to send to which program."""
    lines = [
        "| program | version | send | off by, mm | contours | it says | to know |",
        "|---|---|---|---|---|---|---|",
    ]
    for program in PROGRAMS:
        row = measured[program.name]
        about, remark = f"{program.name}<br>{program.source}", REMARKS[program.name]
        for name in program.recommended:
            found = row["files"][name]
            contours = "" if found["contours"] is None else f"{found['contours']} of {found['drawn']}"
            cells = (about, row["version"], FILES[name].shown, cell(found), contours, says(found), remark)
            lines.append(f"| {' | '.join(cells)} |")
            about = remark = ""
    return "\n".join(lines)


def all_files(measured: Mapping[str, Any]) -> str:
    """The table of what becomes of each file in each program."""
    lines = [f"| program | {' | '.join(PLAIN)} |", f"|---|{'---|' * len(PLAIN)}"]
    for program in PROGRAMS:
        files = measured[program.name]["files"]
        cells = (cell(files[name]) if name in files else "" for name in PLAIN)
        lines.append(f"| {program.name} | {' | '.join(cells)} |")
    return "\n".join(lines)


def commands(names: Sequence[str]) -> str:
    """The commands of files, each once."""
    return "```sh\n" + "\n".join(dict.fromkeys(FILES[name].command for name in names)) + "\n```"


def page(measured: Mapping[str, Any]) -> str:
    """The page, of what was measured."""
    dates = sorted({row["date"] for row in measured.values()})
    return Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        dates=f"on {dates[0]}" if len(dates) == 1 else f"from {dates[0]} to {dates[-1]}",
        pieces=PIECES,
        accuracy=ACCURACY,
        to_send=to_send(measured),
        commands=commands([name for program in PROGRAMS for name in program.recommended]),
        all_files=all_files(measured),
        all_commands=commands(list(PLAIN)),
    )


def main() -> None:
    """Measure what is here, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", nargs="*", help="programs to measure again (default: all)")
    parser.add_argument("--write-only", action="store_true", help="write the page of what was measured before")
    options = parser.parse_args()
    measured = json.loads(MEASURED.read_text(encoding="utf-8")) if MEASURED.exists() else {}
    chosen = [program for program in PROGRAMS if not options.programs or program.name in options.programs]
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(PROCESSES) as pool:
        files = Files(Path(folder))
        tasks = {program: pool.submit(measure, program, files) for program in chosen if not options.write_only}
        for program, task in tasks.items():
            try:
                measured[program.name] = task.result()
            except MissingProgramError as error:
                print(f"left as it was: {error}", flush=True)
            else:
                found = measured[program.name]["files"].items()
                print(program.name, *(f"{name}: {cell(one)}" for name, one in found), sep="\n    ", flush=True)
                MEASURED.write_text(json.dumps(dict(sorted(measured.items())), indent=1) + "\n", encoding="utf-8")
    PAGE.write_text(page(measured), encoding="utf-8")


if __name__ == "__main__":
    main()
