"""Sweeps that are run: every design has its row, whatever it does, and a run that was ended goes on where it was."""

from __future__ import annotations

import csv
import io
import json
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest
from helpers.outlines import CommandLine

import voronoi_tiles as vt
from voronoi_tiles.parallel.block_runner import LostBlock
from voronoi_tiles.sweeps import design_rows, sweep_folder, sweep_run
from voronoi_tiles.sweeps.design_figures import design_figures

TEXT = """
design = "p4"
count = 40
seed = 7
filter = "neck > 10"
sort = "-curved_share"
keep = 5

[vary]
group = ["p4", "p3", "p6"]
"site[0].strokes[0]" = { deviation = 5 }
"cell.a" = { from = 50, to = 80 }
"""


@pytest.fixture(scope="module")
def sweep(tmp_path_factory: pytest.TempPathFactory) -> vt.Sweep:
    """A small sweep, some of whose designs have copies that touch."""
    file = tmp_path_factory.mktemp("sweep") / "sweep.toml"
    file.write_text(TEXT)
    return vt.Sweep.load(file)


@pytest.fixture(scope="module")
def whole(sweep: vt.Sweep, tmp_path_factory: pytest.TempPathFactory) -> tuple[vt.SweepResult, Path]:
    """What came of it, in one go and in this process, and its folder."""
    folder = tmp_path_factory.mktemp("whole") / "out"
    return vt.sweep(sweep, folder, workers=1), folder


def files(folder: Path) -> dict[str, bytes]:
    """All that a sweep has made, by its names, but for how its rows were cut into blocks."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.parent.name != "rows"
    }


def test_every_design_has_a_row_with_what_it_measures(sweep: vt.Sweep, whole: tuple[vt.SweepResult, Path]) -> None:
    """The figures are those of the tile of the design with these numbers; what fails has its sentence alone."""
    result, folder = whole
    rows = list(csv.DictReader(io.StringIO((folder / "table.csv").read_text())))
    assert [int(row["number"]) for row in rows] == list(range(40))
    assert tuple(rows[0]) == sweep.columns
    failed = 0
    for row in rows:
        design = sweep.variant(int(row["number"]))
        assert row["group"] == design.group.name
        assert float(row["cell.a"]) == design.cell["a"]
        if row["error"]:
            failed += 1
            with pytest.raises(vt.TouchingCopiesError) as raised:
                design.tessellate()
            assert row["error"] == str(raised.value)
            assert row["area"] == row["neck"] == ""
            continue
        tile = design.tessellate()[0]
        figures = tile.figures()
        assert float(row["area"]) == tile.area
        assert float(row["perimeter"]) == tile.perimeter
        assert float(row["width"]) == figures["width"]
        assert float(row["height"]) == figures["height"]
        assert float(row["curved_share"]) == figures["curved_share"]
        assert int(row["edges"]) == sum(figures["edges"].values())
        assert int(row["neighbours"]) == len(figures["neighbours"])
        assert int(row["vertices"]) >= int(row["neighbours"])
        assert 0 < float(row["neck"]) <= min(float(row["width"]), float(row["height"]))
    assert failed == result.failed > 0


def test_the_best_are_kept_in_order(sweep: vt.Sweep, whole: tuple[vt.SweepResult, Path]) -> None:
    """Kept are the good ones for which the filter holds, the first by the sorting: as a table, designs and pictures."""
    result, folder = whole
    rows = [row for row in csv.DictReader(io.StringIO((folder / "table.csv").read_text())) if not row["error"]]
    best = sorted((row for row in rows if float(row["neck"]) > 10), key=lambda row: -float(row["curved_share"]))[:5]
    assert list(csv.DictReader(io.StringIO((folder / "kept.csv").read_text()))) == best
    numbers = [int(row["number"]) for row in best]
    assert result.kept == tuple(numbers)
    names = [f"{number:06d}.toml" for number in numbers]
    assert sorted(path.name for path in (folder / "kept").iterdir()) == sorted(names)
    for number, name, design in zip(numbers, names, result.designs(), strict=True):
        assert vt.Design.load(folder / "kept" / name) == sweep.variant(number) == design
    page = (folder / "sheet.html").read_text()
    places = [page.index(f'<a href="kept/{name}">') for name in names]
    assert places == sorted(places)
    assert all(f"no. {number}<br>" in page for number in numbers)
    assert (folder / "sheet.png").read_bytes().startswith(b"\x89PNG")
    assert (folder / "sheet.svg").read_text().count("<a ") == 5


def test_captions_say_what_was_sorted_by() -> None:
    """A picture has the values that brought it there: without the minus before all of it, and with large ones whole."""
    sweep = vt.Sweep(vt.starter("p4"), {"cell.a": [60]}, sort=["-(area*100)", "-area + number"])
    page = sweep_run.contact_sheet(vt.sweep(sweep, workers=1)).html
    assert "<br>area * 100 90,000<br>-area + number -900</figcaption>" in page


def test_the_number_of_workers_is_in_no_result(
    sweep: vt.Sweep, whole: tuple[vt.SweepResult, Path], tmp_path: Path
) -> None:
    """However many processes there are, every file has the same bytes."""
    vt.sweep(sweep, tmp_path / "out", workers=3)
    assert files(tmp_path / "out") == files(whole[1])


@contextmanager
def counted(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[int]]:
    """The numbers of the designs that are made in this process."""
    made: list[int] = []
    original = design_rows.design_row

    def row(sweep: vt.Sweep, number: int) -> list[Any]:
        made.append(number)
        return original(sweep, number)

    with monkeypatch.context() as patched:
        patched.setattr(design_rows, "design_row", row)
        yield made


def test_what_is_there_is_not_made_again(
    sweep: vt.Sweep, whole: tuple[vt.SweepResult, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rows that are lost, or that nobody can read, are made again and no others, and the result is the same."""
    folder = tmp_path / "out"
    shutil.copytree(whole[1], folder)
    first, second, *_ = sorted((folder / "rows").iterdir())
    first.unlink()
    second.write_text(second.read_text()[:-20])
    (folder / "table.csv").unlink()
    spans = [range(int(path.stem[:7]), int(path.stem[8:]) + 1) for path in (first, second)]
    with counted(monkeypatch) as made:
        vt.sweep(sweep, folder, workers=1)
    assert made == [number for span in spans for number in span]
    assert files(folder) == files(whole[1])
    with counted(monkeypatch) as made:
        vt.sweep(sweep, folder, workers=1)
    assert made == []


@pytest.mark.parametrize(
    "text",
    [
        "",
        "null",
        "3",
        '{"0": 1}',
        "[3, null]",
        '["%s"]' % ("x" * 13),
        "[" * 100_000,
        "[[{number}, {cells}, 0]]",
        '[["{number}", {cells}, ""]]',
        '[[null, {cells}, ""]]',
        '[[false, {cells}, ""]]',
        '[[{number}.5, {cells}, ""]]',
        '[[{number}, "p9", {rest}, ""]]',
        '[[{number}, {group}, ["p4"], {less}, ""]]',
        '[[{number}, {group}, "wide", {less}, ""]]',
        '[[{number}, {group}, true, {less}, ""]]',
        '[[{number}, {group}, NaN, {less}, ""]]',
        '[[{number}, {group}, 1e999, {less}, ""]]',
        '[[{number}, {group}, 1%s, {less}, ""]]' % ("0" * 400),
        '[[{number}, {cells}, "", ""]]',
    ],
)
def test_what_is_no_row_is_made_again(text: str, tmp_path: Path) -> None:
    """Whatever stands in a file of rows, the table is that of designs: what is no row of the sweep's is made again."""
    sweep = vt.Sweep(vt.starter("p4"), {"cell.a": [60, 70]}, keep=0)
    vt.sweep(sweep, tmp_path, workers=1)
    before = files(tmp_path)
    file = min((tmp_path / "rows").iterdir())
    row = [json.dumps(cell) for cell in json.loads(file.read_text())[0][:-1]]
    parts = {"cells": row[1:], "rest": row[2:], "less": row[3:]}
    for name, cells in {"number": row[:1], "group": row[1:2], **parts}.items():
        text = text.replace(f"{{{name}}}", ", ".join(cells))
    file.write_text(text)
    vt.sweep(sweep, tmp_path, workers=1)
    assert files(tmp_path) == before
    assert len(json.loads(file.read_text())) == 1


@pytest.mark.parametrize("gone", ["rows", "kept", "both"])
def test_folders_that_are_not_there_are_made(gone: str, tmp_path: Path) -> None:
    """A run that was ended as it began, or whose folders somebody has removed, goes on."""
    sweep = vt.Sweep(vt.starter("p4"), {"cell.a": [60, 70]}, keep=1)
    vt.sweep(sweep, tmp_path, workers=1)
    before = files(tmp_path)
    for name in ("rows", "kept") if gone == "both" else (gone,):
        shutil.rmtree(tmp_path / name)
    vt.sweep(sweep, tmp_path, workers=1)
    assert files(tmp_path) == before


def test_a_folder_is_marked_before_anything_is_in_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Wherever a run ends while it makes its folder, the same command goes on: nothing looks like somebody else's."""
    sweep = vt.Sweep(vt.starter("p4"), {"cell.a": [60]}, keep=1)
    original = Path.mkdir
    for most in range(4):
        left, folder = [most], tmp_path / str(most)

        def mkdir(path: Path, *arguments: Any, left: list[int] = left, **options: Any) -> None:
            if not left[0]:
                raise KeyboardInterrupt
            left[0] -= 1
            original(path, *arguments, **options)

        with monkeypatch.context() as patched, suppress(KeyboardInterrupt):
            patched.setattr(Path, "mkdir", mkdir)
            vt.sweep(sweep, folder, workers=1)
        assert (folder / "table.csv").exists() == (most == 3)
        assert len(vt.sweep(sweep, folder, workers=1).table) == 1


def test_another_choice_of_the_same_designs_makes_none(
    sweep: vt.Sweep, whole: tuple[vt.SweepResult, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another filter, order or number of designs uses the rows that are there; what is not kept any more goes."""
    folder = tmp_path / "out"
    shutil.copytree(whole[1], folder)
    kept = sorted((folder / "kept").iterdir())
    kept[0].write_text(kept[0].read_text() + "# mine\n")
    with counted(monkeypatch) as made:
        result = vt.sweep(sweep.replaced(filter="area > 0", sort="area", keep=3), folder, workers=1)
    assert made == []
    assert {path.name for path in (folder / "kept").iterdir()} == {f"{k:06d}.toml" for k in result.kept} | {
        kept[0].name
    }
    assert "# mine" in kept[0].read_text()
    with counted(monkeypatch) as made:
        more = vt.sweep(sweep.replaced(count=45), folder, workers=1)
    assert made == [40, 41, 42, 43, 44]
    assert len(more.table) == 45
    assert len(vt.sweep(sweep.replaced(count=10), folder, workers=1).table) == 10


COMMAND = [sys.executable, "-m", "voronoi_tiles", "sweep"]


@pytest.mark.usefixtures("heard_signals")
def test_a_run_that_was_ended_goes_on_to_the_same_result(tmp_path: Path) -> None:
    """After Ctrl-C, and after a kill, the same command makes what is missing: all files are as of a run in one go."""
    file, folder = tmp_path / "sweep.toml", tmp_path / "ended"
    file.write_text(TEXT.replace("count = 40", "count = 160").replace("keep = 5", "keep = 2"))
    command = [*COMMAND, str(file), "--workers", "2", "-o", str(folder)]
    times: dict[Path, int] = {}
    for number, told in ((signal.SIGINT, "Interrupted."), (signal.SIGKILL, "")):
        before = dict(times)
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
            end = time.monotonic() + 60
            while len(list(folder.glob("rows/[0-9]*"))) < len(before) + 2:
                assert time.monotonic() < end
                assert process.poll() is None
                time.sleep(0.01)
            process.send_signal(number)
            assert process.communicate(timeout=30)[1].strip() == told
        times = {path: path.stat().st_mtime_ns for path in folder.glob("rows/[0-9]*")}
        assert before.items() <= times.items()
        assert sum(len(json.loads(path.read_bytes())) for path in times) < 160
        assert not (folder / "table.csv").exists()
    again = subprocess.run(command, capture_output=True, text=True, check=True)
    assert again.stderr.startswith(f"wrote {folder}: 160 designs, ")
    assert times.items() <= {path: path.stat().st_mtime_ns for path in folder.glob("rows/[0-9]*")}.items()
    vt.sweep(file, tmp_path / "whole", workers=1)
    assert files(folder) == files(tmp_path / "whole")


def test_a_design_that_ends_its_process_is_a_row(sweep: vt.Sweep, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a block whose process dies every design is tried by itself: the one that ends it has a row that says so."""

    def run(function: Callable[[Any], Any], blocks: Sequence[Any], **_: Any) -> Iterator[tuple[int, Any]]:
        for number, block in enumerate(blocks):
            dies = block.first <= 17 < block.stop
            yield number, LostBlock("its process was ended by SIGKILL") if dies else function(block)

    monkeypatch.setattr(sweep_run, "run_blocks", run)
    table = vt.sweep(sweep, workers=1).table
    assert table.error(17) == "Its process was ended by SIGKILL."
    assert len(table) == 40
    assert table["number"] == list(range(40))
    assert table["area"][17] is None


def test_what_goes_wrong_with_a_design_is_in_its_row(sweep: vt.Sweep, monkeypatch: pytest.MonkeyPatch) -> None:
    """Memory that is not enough, and a bug of ours, are rows as well, and not the end."""
    errors = {3: MemoryError(), 4: KeyError("bug"), 5: vt.ProofError("the areas are wrong")}

    def figures(tiling: vt.Tiling, job: vt.Job | None) -> list[float]:
        error = errors.get(int(tiling.design.name[-6:]) if tiling.design.name[-6:].isdecimal() else -1)
        if error is not None:
            raise error
        return design_figures(tiling, job)

    monkeypatch.setattr("voronoi_tiles.sweeps.design_rows.design_figures", figures)
    monkeypatch.setattr(vt.Sweep, "variant", lambda self, number: self.design.replace(name=f"x-{number:06d}"))
    table = vt.sweep(sweep.replaced(count=7), workers=1).table
    assert [bool(table.error(k)) for k in range(7)] == [k in errors for k in range(7)]
    assert table.error(3) == "There is not enough memory for this design."
    assert table.error(4) == "KeyError: 'bug'. This is a bug in voronoi-tiles: please report it."
    assert table.error(5) == "the areas are wrong."


def test_a_sheet_gives_pieces_and_cuts(tmp_path: Path) -> None:
    """With a job the table has what `report` says; a design that does not fit has its sentence."""
    job: dict[str, Any] = {"sheet": "300x200mm", "margin": 5}
    sweep = vt.Sweep(vt.starter("p4"), {"cell.a": [60, 80, 2000], "scale": [1]}, job=job)
    table = vt.sweep(sweep, tmp_path / "out", workers=1).table
    for number in (0, 1):
        report = sweep.variant(number).tessellate().report(vt.Job(**job))
        assert (table["pieces"][number], table["cut"][number]) == (report["pieces"]["count"], report["cut"]["length"])
    with pytest.raises(vt.JobError) as raised:
        sweep.variant(2).tessellate().report(vt.Job(**job))
    assert table.error(2) == str(raised.value)


def test_several_sites_have_figures_each_and_lengths_are_millimetres() -> None:
    """The columns of several tiles begin with their sites' places; figures are millimetres whatever the units."""
    design = vt.starter("p4m").replace(units="in")
    sweep = vt.Sweep(design, {"cell.a": [60, 61]}, filter="site[1].area > site[0].area", sort="-site[1].neck")
    table = vt.sweep(sweep, workers=1).table
    tiling = sweep.variant(0).tessellate()
    assert [table[f"site[{k}].area"][0] for k in (0, 1)] == [tile.area * 25.4**2 for tile in tiling]
    assert table["site[1].perimeter"][0] == tiling[1].perimeter * 25.4
    assert table["site[0].curved_share"][0] == tiling[0].figures()["curved_share"]


def test_parquet_has_the_same_table(whole: tuple[vt.SweepResult, Path], sweep: vt.Sweep, tmp_path: Path) -> None:
    """The Parquet file has the columns of the CSV, counts as whole numbers, and nothing where there is no value."""
    parquet = pytest.importorskip("pyarrow.parquet")
    folder = shutil.copytree(whole[1], tmp_path / "out")
    vt.sweep(sweep, folder, workers=1, parquet=True)
    table = parquet.read_table(folder / "table.parquet")
    assert table.column_names == list(sweep.columns)
    for name in sweep.columns:
        assert table[name].to_pylist() == whole[0].table[name]
    assert str(table.schema.field("edges").type) == "int64"


def test_without_pyarrow_parquet_is_refused_before_anything_is_made(
    sweep: vt.Sweep, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The message says what to install; no folder is left."""
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(vt.MissingLibraryError, match="pip install pyarrow"):
        vt.sweep(sweep, tmp_path / "out", parquet=True)
    assert not (tmp_path / "out").exists()


def test_a_folder_of_another_sweep_is_refused(sweep: vt.Sweep, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another sweep, another version's, and files of somebody else are never mixed with ours, nor overwritten."""
    folder = tmp_path / "out"
    vt.sweep(sweep.replaced(count=2, keep=0), folder, workers=1)
    before = files(folder)
    with pytest.raises(vt.OutputError, match=r"holds another sweep, with other values of seed\. Give it a folder"):
        vt.sweep(sweep.replaced(seed=8), folder, workers=1)
    with monkeypatch.context() as patched:
        patched.setattr(sweep_folder, "__version__", "9.9")
        with pytest.raises(vt.OutputError, match=r"holds a sweep by voronoi-tiles .*, and this is voronoi-tiles 9\.9"):
            vt.sweep(sweep, folder, workers=1)
    assert files(folder) == before
    (folder / "sweep.json").write_text("{")
    with pytest.raises(vt.OutputError, match=r"sweep\.json cannot be read"):
        vt.sweep(sweep, folder, workers=1)
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    (theirs / "table.csv").write_text("mine")
    with pytest.raises(vt.OutputError, match=r"table\.csv exists already, and is of no sweep"):
        vt.sweep(sweep, theirs, workers=1)
    assert files(theirs) == {"table.csv": b"mine"}
    for name in ("", theirs / "table.csv", folder / "sweep.json" / "x", "a\0b"):
        with pytest.raises(vt.OutputError, match="cannot write"):
            vt.sweep(sweep, name, workers=1)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--workers", "0"], "--workers 0 cannot be. Give a number from 1 to 1024."),
        (["--count", "0"], "count: must be a whole number from 1 to 1,000,000, not 0"),
        (["--keep", "x"], "Invalid value for '--keep'"),
        (["--filter", "nek > 3"], 'filter: there is no column nek. Did you mean "neck"?'),
        (["--filter", "__import__('os').remove('sweep.toml')"], "filter: "),
        (["--sort", "group + 1"], "sort: 'group' is a text"),
        (["--workers", "2", "--scheduler", "tcp://127.0.0.1:1"], "a --scheduler has --workers of its own"),
        (["--scheduler", "nonsense"], "cannot reach a scheduler at nonsense"),
    ],
)
def test_the_command_says_what_cannot_be(
    arguments: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, voronoi_tiles: CommandLine
) -> None:
    """One message, exit code 2, and no table."""
    monkeypatch.chdir(tmp_path)
    Path("sweep.toml").write_text(TEXT)
    result = voronoi_tiles("sweep", "sweep.toml", "-o", "out", *arguments)
    assert result.returncode == 2
    assert message in result.stderr
    assert result.stderr.count("\n") == 1
    assert not Path("out/table.csv").exists()


def test_progress_is_told(sweep: vt.Sweep) -> None:
    """A function is told how many designs of how many there are, up to all."""
    told: list[tuple[int, int]] = []
    vt.sweep(sweep.replaced(count=9), workers=1, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (9, 9)
    assert [done for done, _ in told] == sorted({done for done, _ in told})
