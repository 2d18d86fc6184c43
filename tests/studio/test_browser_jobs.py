"""A job in a real browser: from the sheet to the files, which are the command line's to the byte, and back again."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from helpers.studio import Studio, Window, opened, running

import voronoi_tiles as vt

if TYPE_CHECKING:
    from playwright.sync_api import Download, Page

TEXT = """\
schema = 1
group = "p4"
cell = { a = 60 }

[[site]]
name = "bird"
strokes = [{ polyline = [[6.0, 9.0], [20.0, 4.0], [25.0, 18.0]] }]
"""
JOB: dict[str, Any] = {"sheet": "300x200mm", "kerf": 0.15, "preset": "lightburn", "edges": "pieces"}


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    """A studio on a design."""
    folder = tmp_path_factory.mktemp("jobs")
    (folder / "bird.toml").write_text(TEXT, encoding="utf-8")
    with running(folder, "bird.toml") as found:
        yield found


@pytest.fixture(scope="module")
def window(chromium: Any, studio: Studio) -> Iterator[Window]:
    """Its page with the job set up."""
    with opened(chromium, studio, viewport={"width": 1000, "height": 700}) as found:
        found.wait()
        page = found.page
        page.get_by_role("tab", name="Job").click()
        panel = page.locator("#panel-job")
        for label, value in (("Sheet", "300x200mm"), ("Kerf, mm", "0.1mm + 0.05")):
            panel.get_by_label(label, exact=True).fill(value)
            page.keyboard.press("Enter")
        for label, value in (("Preset", JOB["preset"]), ("Edges", JOB["edges"])):
            panel.get_by_label(label, exact=True).select_option(value)
        yield found


def download(window: Window, form: str) -> Download:
    """The file of a format, by the dialog."""
    page = window.page
    page.keyboard.press("Control+e")
    page.get_by_label("Format").select_option(form)
    return downloaded(page)


def downloaded(page: Page) -> Download:
    """What the button of the dialog that is open gives; the dialog closes."""
    with page.expect_download() as found:
        page.get_by_role("button", name="Download").click()
    page.locator("dialog").wait_for(state="detached")
    return found.value


def test_report_and_findings(window: Window) -> None:
    """The report says the sheet's size and the pieces; each finding shows its place; an option out of range is said."""
    page = window.page
    page.get_by_role("tab", name="Report").click()
    page.get_by_text("300 mm x 200 mm").wait_for()
    report = vt.Design.loads(TEXT).tessellate().report(vt.Job(**JOB))
    assert page.locator(".figures:not(.old)").get_by_text(str(report["pieces"]["count"])).count()
    page.get_by_role("tab", name="Job").click()
    fit = page.get_by_label("Fit", exact=True)
    fit.select_option("clip")
    page.get_by_role("tab", name="Report").click()
    finding = page.locator(".finding").first
    finding.wait_for()
    before = page.locator("#sheet").screenshot()
    finding.get_by_role("button", name="Show").click()
    page.wait_for_function("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert page.locator("#sheet").screenshot() != before
    page.get_by_role("tab", name="Job").click()
    fit.select_option("whole")


def test_errors_stand_by_their_fields(window: Window) -> None:
    """The field is marked and names its error, whatever heading it is under; others stand above all fields.

    What is being typed elsewhere when the error comes stays.
    """
    page = window.page
    page.get_by_role("tab", name="Job").click()
    panel = page.locator("#panel-job")
    alert, marked = panel.get_by_role("alert"), panel.locator("[aria-invalid=true]")
    for label, value in (("Margin, mm", "400"), ("Rotate", "around")):
        field = panel.get_by_label(label)
        heading = panel.locator("details", has=page.get_by_label(label))
        if not field.is_visible():
            heading.locator("summary").click()
        good = field.input_value()
        field.fill(value)
        field.press("Enter")
        alert.wait_for()
        heading.locator("summary").click()
        for unit in ("in", "mm"):
            page.locator("#unit").select_option(unit)
            alert.wait_for()  # the panel is made anew, and its heading open
        assert label.partition(",")[0] in alert.inner_text()
        assert "`" not in alert.inner_text()
        assert marked.evaluate_all("all => all.map((one) => one.id)") == [field.get_attribute("id")]
        assert alert.get_attribute("id") in (field.get_attribute("aria-describedby") or "").split()
        field.fill(good)
        field.press("Enter")
        alert.wait_for(state="detached")
        assert marked.count() == 0
    sheet, gap = panel.get_by_label("Sheet", exact=True), panel.get_by_label("Gap, mm")
    sheet.fill("20x20mm")
    sheet.press("Enter")
    gap.fill("1 +")
    page.wait_for_function("() => document.querySelector('report-panel [role=alert]')")
    assert gap.input_value() == "1 +"
    gap.blur()
    wrong = panel.locator("[data-key=job-gap]:invalid")
    wrong.wait_for()
    sheet.fill(JOB["sheet"])
    sheet.press("Enter")
    panel.get_by_text("no whole tile fits on the sheet").wait_for(state="detached")
    assert wrong.input_value() == "1 +"  # also in the panel that was made anew
    assert "Write a length such as 12.5mm" in alert.inner_text()
    assert alert.get_attribute("id") in (wrong.get_attribute("aria-describedby") or "").split()
    assert marked.evaluate_all("all => all.map((one) => one.id)") == [gap.get_attribute("id")]
    borders = [field.evaluate("one => getComputedStyle(one).borderColor") for field in (gap, sheet)]
    assert borders[0] != borders[1]
    page.keyboard.press("Control+e")
    page.locator("#banner").get_by_text("Gap, mm, under Job, cannot be read: 1 +").wait_for()
    assert page.get_by_role("dialog").count() == 0
    page.locator("#banner").get_by_role("button", name="Close").click()
    gap.fill("")
    gap.blur()
    alert.wait_for(state="detached")
    assert marked.count() == 0


def test_every_field_is_explained(window: Window) -> None:
    """By what the command line says of the option, with the fields' names in the place of options."""
    page = window.page
    page.get_by_role("tab", name="Job").click()
    said = page.locator("#panel-job").evaluate("""(panel) => Object.fromEntries(
        [...panel.querySelectorAll("input, select")].map((field) => [
            field.dataset.key.replace("job-", ""),
            document.getElementById(field.getAttribute("aria-describedby")).textContent,
        ]),
    )""")
    options = {name: option.help for name, option in vt.Job.options().items() if name != "only_colour"}
    assert said.keys() == options.keys()
    assert {name: text for name, text in said.items() if "`" not in options[name]} == {
        name: text for name, text in options.items() if "`" not in text
    }
    assert said["frame"] == "The least width of the frame; means Fit: frame [default: 2mm]."
    assert "Colours: layers and Colours: files are the fewest there" in said["colours"]
    assert page.locator("#panel-job").get_by_text("The width of the cut: contours keep half of it").is_visible()


def test_files_are_those_of_the_command_line(window: Window, studio: Studio, tmp_path: Path) -> None:
    """SVG and DXF with the job are the same bytes; an SVG that is opened again gives the design and the job."""
    page = window.page
    window.save()
    tiling = vt.Design.load(studio.folder / "bird.toml").tessellate()
    for form in ("svg", "dxf", "pdf", "lbrn2"):
        found = download(window, form)
        assert found.suggested_filename == f"bird.{form}"
        tiling.export(tmp_path / f"ours.{form}", job=vt.Job(**JOB))
        assert Path(found.path()).read_bytes() == (tmp_path / f"ours.{form}").read_bytes(), form
        if form == "svg":
            found.save_as(tmp_path / "bird.svg")

    before = window.design
    fillet = page.get_by_label("Fillet, mm")
    page.get_by_role("tab", name="Job").click()
    # One after the other, sooner than the panel is made anew.
    fillet.evaluate(
        """(input) => ["1", "0"].forEach((text) => {
            input.value = text;
            input.dispatchEvent(new Event("change"));
        })"""
    )
    page.keyboard.press("Control+e")
    said = page.get_by_role("dialog").get_by_text("The job: ").inner_text()
    assert "sheet 300x200mm" in said
    assert "fillet" not in said
    page.keyboard.press("Escape")
    page.get_by_role("tab", name="Drawing").click()
    window.choose("Line 1")
    page.locator("#overlay").focus()
    page.keyboard.press("Delete")
    page.get_by_role("tab", name="Job").click()
    page.get_by_role("button", name="Reset").click()
    page.wait_for_function("() => document.querySelector('[data-key=job-sheet]').value === ''")
    page.get_by_role("button", name="Open").click()
    page.get_by_label("File", exact=True).set_input_files(tmp_path / "bird.svg")
    page.locator("dialog").wait_for(state="detached")
    assert window.design == before
    assert page.get_by_label("Sheet", exact=True).input_value() == "300x200mm"
    again = download(window, "svg")
    assert Path(again.path()).read_bytes() == (tmp_path / "bird.svg").read_bytes()


def test_an_export_can_be_given_up(window: Window) -> None:
    """What it is bounded by is said before; while it is made the dialog says so, and Cancel ends it without a file."""
    page = window.page
    page.evaluate("""() => {
        const own = window.fetch;
        window.fetch = (address, { signal } = {}) => new Promise((done, refuse) => {
            window.fetch = own;
            signal.addEventListener("abort", () => { window.given = address; refuse(signal.reason); });
        });
    }""")
    page.keyboard.press("Control+e")
    dialog = page.get_by_role("dialog")
    dialog.get_by_text("What takes longer than 10 s is given up").wait_for()
    assert "LightBurn (lbrn2)" in page.get_by_label("Format").inner_text()
    page.get_by_label("Format").select_option("png")
    dialog.get_by_text("A picture of the plane, 1600 pixels on its longer side").wait_for()
    page.get_by_role("button", name="Download").click()
    dialog.get_by_role("status").get_by_text("Working").wait_for()
    dialog.get_by_role("button", name="Cancel").click()
    page.wait_for_function("() => window.given === 'export'")
    dialog.wait_for(state="detached")
    assert download(window, "svg").suggested_filename == "bird.svg"


def test_coupon_picture_and_parts(window: Window) -> None:
    """A test piece, a picture, and a zip of one file a colour under its own name."""
    page = window.page
    picture = Path(download(window, "png").path()).read_bytes()
    assert picture.startswith(b"\x89PNG")
    page.get_by_role("tab", name="Job").click()
    page.get_by_role("button", name="Test piece for the kerf").click()
    page.get_by_label("Thickness of the material").fill("a lot")
    page.get_by_role("button", name="Download").click()
    page.get_by_role("dialog").get_by_role("alert").get_by_text("a lot").wait_for()
    page.get_by_label("Thickness of the material").fill("4mm")
    piece = downloaded(page)
    assert piece.suggested_filename.endswith(".svg")
    assert b"<svg" in Path(piece.path()).read_bytes()
    page.get_by_role("button", name="Test piece for the kerf").click()
    page.get_by_label("Format").select_option("gcode")
    page.get_by_role("button", name="Download").click()
    page.get_by_role("dialog").get_by_role("alert").get_by_text("it needs Feed and Power").wait_for()
    page.get_by_label("Format").select_option("lbrn2")
    piece = downloaded(page)
    assert piece.suggested_filename == "coupon.lbrn2"
    assert b"<LightBurnProject" in Path(piece.path()).read_bytes()
    page.locator("#panel-job summary", has_text="Colours").click()
    page.get_by_label("Into", exact=True).select_option("files")
    page.get_by_label("Colours", exact=True).fill("3")
    page.keyboard.press("Enter")
    assert download(window, "svg").suggested_filename.endswith(".zip")
