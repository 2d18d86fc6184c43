"""What the command line prints for people: tables, and names that are safe to print."""

from __future__ import annotations

import io
import sys
from collections.abc import Iterable, Sequence
from typing import Any

from voronoi_tiles.base.text import counted, printable


def info_text(figures: dict[str, Any]) -> str:
    """Write the figures of a tiling (Tiling.figures) as tables."""
    units = figures["units"]
    cell = figures["cell"]
    page = _TextTable()
    page.head(
        {
            "design": printable(figures["design"]),
            "group": f"{figures['group']}, {counted(figures['order'], 'copy', 'copies')} per cell",
            "cell": f"a = {_vector(cell['a'])}, b = {_vector(cell['b'])} {units}, area {_entry(cell['area'])} {units}²",
        }
    )
    page.table(
        "Tiles",
        [
            "site",
            f">size {units}",
            f">area {units}²",
            f">perimeter {units}",
            ">lines",
            ">parabolas",
            ">curved",
            ">copies",
            "symmetry",
        ],
        [
            (
                tile["site"],
                f"{tile['width']:.4g} x {tile['height']:.4g}",
                tile["area"],
                tile["perimeter"],
                tile["edges"]["line"],
                tile["edges"]["parabola"],
                f"{tile['curved_share']:.1%}",
                tile["copies_per_cell"],
                "  ".join(tile["symmetry"]),
            )
            for tile in figures["tiles"]
        ],
    )
    page.table(
        "Neighbours",
        ["tile", "neighbour", "operation", ">edges", f">length {units}"],
        [
            (tile["site"], other["site"], other["operation"], other["edges"], other["length"])
            for tile in figures["tiles"]
            for other in tile["neighbours"]
        ],
    )
    _proof(page, figures["proof"])
    return page.text()


def report_text(figures: dict[str, Any]) -> str:
    """Write the figures of a job (fabrication.report_figures) as tables."""
    page = _TextTable()
    sheet, use, cut, pieces = figures["page"], figures["use"], figures["cut"], figures["pieces"]
    accuracy = "" if figures["curves"] == "exact" else f", within {figures['accuracy']:g} mm"
    framed = " and a frame" if pieces["frame"] else ""
    match figures["colouring"]:
        case None | "fewest":
            coloured = "suffice for the whole tessellation"
        case int():
            coloured = "on as many tiles each, or nearly, no neighbours alike"
        case scheme:
            coloured = f"by {scheme}"
    it = "the sheet drawn there" if use["sheet"] < sheet["area"] else "it"
    page.head(
        {
            "design": f"{printable(figures['design'])}, {figures['group']}",
            "page": f"{sheet['width']:.6g} x {sheet['height']:.6g} mm, {use['share']:.1%} of {it} tiles, "
            f"{use['whole_share']:.1%} whole ones",
            "pieces": f"{pieces['count']:,}{framed}, {pieces['whole']:,} of them whole tiles, "
            f"{pieces['turned_over']:,} turned over",
            "colours": f"{figures['colours']} {coloured}",
            "cut": f"{cut['length'] / 1000:.3f} m, {counted(cut['pierces'], 'pierce')}, "
            f"{cut['travel'] / 1000:.3f} m of travel",
            "curves": f"{figures['curves']}{accuracy}; the shortest segment is {figures['shortest_piece']:.3g} mm",
            "time": f"{figures['time'] / 60:.1f} min, acceleration not counted",
        }
    )
    page.table(
        "Pieces",
        ["site", "turned over", "whole", ">colour", ">count"],
        [
            (
                row["site"],
                "yes" if row["turned_over"] else "no",
                "yes" if row["whole"] else "no",
                "-" if row["colour"] is None else row["colour"],
                f"{row['count']:,}",
            )
            for row in pieces["kinds"]
        ],
    )
    if figures["packing"]:
        page.table(
            "Packed",
            [">colour", ">pieces", ">sheets", ">use"],
            [(row["colour"], row["pieces"], row["sheets"], f"{row['share']:.1%}") for row in figures["packing"]],
        )
    page.table(
        "Layers in the order of work",
        ["layer", "work", "colour", ">paths", ">closed", ">length m", ">travel m", ">minutes"],
        [
            (
                row["name"],
                row["work"],
                row["colour"],
                f"{row['paths']:,}",
                f"{row['closed']:,}",
                f"{row['length'] / 1000:.3f}",
                f"{row['travel'] / 1000:.3f}",
                f"{row['time'] / 60:.1f}",
            )
            for row in figures["layers"]
        ],
    )
    return page.text()


def solid_text(figures: dict[str, Any]) -> str:
    """Write the figures of solids (solid.solid_report) as tables."""
    page = _TextTable()
    page.head(
        {
            "volume": f"{figures['volume'] / 1000:.4g} cm³",
            "mass": f"{figures['mass']:.4g} g, solid, at {figures['density']:g} g/cm³",
        }
    )
    page.table(
        "Solids",
        ["site", ">count", ">size mm", ">volume cm³", ">mass g", ">neck mm", ">overhang", ">steepest", "print it"],
        [
            (
                row["site"],
                f"{row['count']:,}",
                " x ".join(f"{side:.4g}" for side in row["size"]),
                f"{row['volume'] / 1000:.4g}",
                f"{row['mass']:.3g}",
                "-" if row["neck"] is None else f"{row['neck']:.3g}",
                f"{row['overhang']:.1%}",
                f"{row['steepest']:.0f}°",
                row["up"],
            )
            for row in figures["solids"]
        ],
    )
    page.line("The neck is the narrowest at seven levels; overhang is the surface that leans out by more than 45°.")
    _laying(page, figures["assembly"])
    return page.text()


def _laying(page: _TextTable, found: dict[str, Any]) -> None:
    """Add how solids go together."""
    best = found["best"]
    if best is not None:
        page.table(
            f"Laid tile by tile, in rows towards {best['towards']:g}°",
            ["site", "copies", ">comes in from x", ">y", ">z", ">clear of walls by"],
            [
                (
                    row["site"],
                    "all" if row["operations"] is None else "  ".join(row["operations"]),
                    *(f"{round(part, 3) + 0.0:.3f}" for part in row["from"]),
                    f"{row['clearance']:.1f}°",
                )
                for row in best["tiles"]
            ],
        )
    count = len(found["orders"])
    page.line(f"Rows can be laid so in {count or 'none'} of {found['tried']} directions, with no room between tiles.")
    for site, out in found["out"].items():
        way = "is locked" if out is None else f"comes out towards ({', '.join(f'{part + 0.0:.3g}' for part in out)})"
        page.line(f"A single tile of {printable(site)} {way} while all others stand.")


def stack_text(figures: dict[str, Any]) -> str:
    """Write the figures of a stack (solid.stack) as tables."""
    page = _TextTable()
    page.head(
        {
            "stack": f"{figures['height']:.5g} mm high, of sheets of {figures['thickness']:.5g} mm",
            "stacks": ", ".join(f"{count:,} {printable(name)}" for name, count in figures["stacks"].items()),
            "volume": f"{figures['volume'] / 1000:.4g} cm³",
            "mass": f"{figures['mass']:.4g} g, at {figures['density']:g} g/cm³",
        }
    )
    page.table(
        "Sheets",
        [">sheet", ">exact at mm", "site", ">area cm²"],
        [
            (str(row["sheet"]), f"{row['middle']:.5g}", row["site"], f"{row['area'] / 100:.4g}")
            for row in figures["sheets"]
        ],
    )
    if figures["holes"]:
        page.table(
            f"Holes of {figures['dowel']:g} mm",
            ["site", ">x mm", ">y mm"],
            [(site, f"{x:.3f}", f"{y:.3f}") for site, holes in figures["holes"].items() for x, y in holes],
        )
    return page.text()


def check_text(document: dict[str, Any]) -> str:
    """Write what `check --json` prints as tables."""
    page = _TextTable()
    check = document["check"]
    across, down = check["samples"]
    spots = f", {check['spot_checks']:,} samples compared with float64" if check["spot_checks"] else ""
    page.head(
        {
            "design": f"{printable(document['design'])}, {document['group']}",
            "image": f"{across} x {down} samples of {check['sample_size']:.4g} {check['units']} over one cell",
            "by": f"{check['method']} on {check['renderer']} ({check['device']}), {check['precision']}{spots}",
        }
    )
    _proof(page, document["proof"])
    page.table(
        "Cross-check: outlines against the image",
        ["figure", ">checked", ">wrong", ">worst", ">limit", "unit", ""],
        [
            (
                row["name"],
                f"{row['checked']:,}",
                f"{row['wrong']:,}",
                _short(row["worst"]),
                _short(row["limit"]),
                row["unit"],
                "ok" if row["passed"] else "FAILED",
            )
            for row in check["figures"]
        ],
    )
    for row in check["figures"]:
        page.line(f"{row['name']:<14}{row['what']}")
        page.line(f"{'':<14}limit: {row['basis']}")
        if row["places"]:
            places = ", ".join(f"({x:.6g}, {y:.6g})" for x, y in row["places"][:3])
            page.line(f"{'':<14}wrong at {places}" + (" and elsewhere" if row["wrong"] > 3 else ""))
    failed = [row["name"] for row in check["figures"] if not row["passed"]]
    page.line(f"\nThe outlines and the image {'differ: ' + ', '.join(failed) if failed else 'agree'}.")
    return page.text()


def _proof(page: _TextTable, rows: Iterable[dict[str, Any]]) -> None:
    """Add the table of a proof's figures."""
    page.table(
        "Proof",
        ["figure", ">value", ">limit", ""],
        [
            (row["name"], f"{row['value']:.3g}", f"{row['limit']:.3g}", "ok" if row["passed"] else "FAILED")
            for row in rows
        ],
    )


class _TextTable:
    """Tables and lines on the way to standard output, in its width and with its colours where it is a terminal."""

    def __init__(self) -> None:
        from rich.console import Console

        terminal = sys.stdout.isatty()
        self._output = io.StringIO()
        self._console = Console(
            file=self._output, width=None if terminal else 110, force_terminal=terminal, legacy_windows=False
        )

    def head(self, entries: dict[str, str]) -> None:
        """Add named lines."""
        for key, value in entries.items():
            self.line(f"{key:<8}{value}")

    def line(self, text: str) -> None:
        """Add one line, as long as it is."""
        from rich.text import Text

        self._console.print(Text(text), soft_wrap=True)

    def table(self, title: str, columns: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
        """Add a table; the columns whose names begin with > are flush right."""
        from rich import box
        from rich.table import Table
        from rich.text import Text

        table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD, title_style="bold")
        for column in columns:
            table.add_column(column.lstrip(">"), justify="right" if column.startswith(">") else "left")
        for row in rows:
            table.add_row(*(Text(_entry(item)) for item in row))
        self._console.print(table)

    def text(self) -> str:
        """The page."""
        return "\n".join(line.rstrip() for line in self._output.getvalue().splitlines()) + "\n"


def _entry(item: object) -> str:
    """Write one entry of a table: ten digits are enough to read."""
    return f"{item:.10g}" if isinstance(item, float) else str(item)


def _short(value: float | None) -> str:
    """Write a deviation, or a limit; three digits are enough to compare."""
    return "" if value is None else f"{value:.3g}"


def _vector(vector: Sequence[float]) -> str:
    """Write a vector."""
    return f"({', '.join(_entry(float(part)) for part in vector)})"
