"""The .inx files: what Inkscape takes, made of the options themselves: dialogs and command line cannot differ."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from helpers.cad import missing
from helpers.cad import run as run_program

from voronoi_tiles import Job
from voronoi_tiles.base.errors import VoronoiTilesError
from voronoi_tiles.cli.export import export
from voronoi_tiles.fabrication.job_fields import JobFields
from voronoi_tiles.inkscape.call import Call
from voronoi_tiles.inkscape.dialog_fields import DesignFields, TilesFields
from voronoi_tiles.inkscape.entries import ELSEWHERE, ENTRIES, Entry
from voronoi_tiles.inkscape.inx import in_dialog, inx_text

INX = "{http://www.inkscape.org/namespace/inkscape/extension}"

TILES, SHEET, *OPENING = ENTRIES


def widgets(entry: Entry) -> dict[str, ET.Element]:
    """The widgets of an entry's dialog by their names, without the notebook."""
    root = ET.fromstring(inx_text(entry, "run.py", "a test").encode())
    return {found.get("name", ""): found for found in root.iter(f"{INX}param") if found.get("type") != "notebook"}


def first_value(widget: ET.Element) -> str:
    """What Inkscape hands over where nobody has touched a widget: of a choice the first."""
    options = widget.findall(f"{INX}option")
    return options[0].get("value", "") if options else widget.text or ""


def test_every_option_of_a_job_is_in_the_dialog_or_has_a_reason() -> None:
    """None is forgotten, none is there twice."""
    on_pages = [name for page in SHEET.pages.values() for name in page]
    assert sorted(on_pages) == sorted({*DesignFields.options(), *JobFields.options()} - {*ELSEWHERE})
    assert set(ELSEWHERE) < set(JobFields.options())
    assert [name for page in TILES.pages.values() for name in page] == list(TilesFields.options())


def test_an_untouched_dialog_says_nothing() -> None:
    """Its values are the defaults."""
    words = [f"--{name}={first_value(widget)}" for name, widget in widgets(SHEET).items()]
    fields, job = Call.of([*words, "--page=cell", "a.svg"]).arguments(DesignFields, JobFields)
    assert repr(DesignFields(**fields)) == "DesignFields()"
    # What says how pieces are made is about a sheet, which is the page's: no default of it may stand in the way.
    assert repr(Job(sheet=(300, 200), **job)) == "Job(sheet=(300.0, 200.0))"
    words = [f"--{name}={first_value(widget)}" for name, widget in widgets(TILES).items()]
    (fields,) = Call.of([*words, "a.svg"]).arguments(TilesFields)
    assert repr(TilesFields(**fields)) == "TilesFields()"


def test_choices_are_those_of_the_command_line() -> None:
    """Word by word; beside them only what means that nothing is said."""
    flags = {option.name: option for option in export.params}
    for name, widget in widgets(SHEET).items():
        words = [option.get("value", "") for option in widget.iterfind(f"{INX}option")]
        choices = getattr(getattr(flags.get(name), "type", None), "choices", None)
        if choices is not None:
            usual = JobFields.options()[name].default
            assert set(words) - {"", usual} == set(choices) - {usual}, name
        if words and name in JobFields.options():
            for word in words:
                _, job = Call.of([f"--{name}={word}", "a.svg"]).arguments(DesignFields, JobFields)
                assert JobFields.options()[name].read(name, job.get(name, JobFields.options()[name].default)) is not ...


def test_names_say_what_may_be_written_where_there_is_no_choice() -> None:
    """The unit of a length, the forms of a text; behind a choice or a tick nothing."""
    for name, widget in widgets(SHEET).items():
        text = widget.get("gui-text", "")
        assert ("(" in text) == (widget.get("type") in {"float", "string"}), name


def test_numbers_keep_within_the_limits_of_their_options() -> None:
    """The least and the greatest value of a spin button are read, and no others."""
    for entry in (TILES, SHEET):
        for name, widget in widgets(entry).items():
            if widget.get("type") != "float":
                continue
            for limit in (widget.get("min", ""), widget.get("max", "")):
                kept = entry.options[name].read(name, float(limit))
                assert float(kept) == pytest.approx(float(limit))
            for beyond in (float(widget.get("min", "")) - 1, float(widget.get("max", "")) * 1.1 + 1):
                with pytest.raises(VoronoiTilesError):
                    entry.options[name].read(name, beyond)


def test_messages_speak_of_the_dialog() -> None:
    """Names as they stand there, no words of Python."""
    text = "`kerf` needs `edges='pieces'`. Leave `label_height` out, or `grain=True`"
    assert in_dialog(text) == '"kerf" needs "edges: pieces". Leave "label height" out, or "grain"'


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.name)
def test_files_are_such_as_inkscape_reads(entry: Entry, tmp_path: Path) -> None:
    """By the schema that comes with Inkscape; no dependency that would hide an entry without a word."""
    text = inx_text(entry, "run.py", "a test")
    assert "dependency" not in text
    (tmp_path / "a.inx").write_text(text, encoding="utf-8")
    schema = Path(
        run_program("inkscape", "--system-data-directory").stdout.strip(), "extensions/inkscape.extension.rng"
    )
    if not schema.exists():
        missing("Inkscape's schema of extensions is not here")
    script = (
        "import sys; from lxml import etree\n"
        "schema = etree.RelaxNG(etree.parse(sys.argv[1])); schema.assertValid(etree.parse(sys.argv[2]))"
    )
    done = run_program("python3", "-c", script, str(schema), str(tmp_path / "a.inx"))
    assert done.returncode == 0, done.stderr
