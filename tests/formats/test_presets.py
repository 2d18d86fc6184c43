"""The table of presets, and presets of users' own."""

from __future__ import annotations

import io
import re
from pathlib import Path

import pytest
from helpers.cutting import squares

from voronoi_tiles import Job, starter
from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.formats.burns import ROLES
from voronoi_tiles.formats.presets import FORMATS, load_preset, preset_names

SQUARES = squares()


def test_the_presets_are_there() -> None:
    """By their names, the neutral one first."""
    cutters = ("lightburn", "redcut", "ponoko", "boxes", "glowforge", "cnc", "meerk40t")
    others = ("inkscape", "blender", "openscad", "freecad", "cadquery", "build123d", "jscad", "trimesh")
    assert preset_names() == ("plain", *cutters, *others)
    assert ", ".join(preset_names()) in Job.options()["preset"].help


@pytest.mark.parametrize("name", preset_names())
def test_every_preset_is_whole(name: str) -> None:
    """Colours and names for every role; what is read instead of an unread format is read."""
    preset = load_preset(name)
    assert preset.name == name
    assert tuple(preset.colours) == tuple(preset.layers) == tuple(preset.dxf_layers) == ROLES
    assert all(layer == layer.upper() for layer in preset.dxf_layers.values())
    assert 0 < preset.stroke < 0.1
    for form in FORMATS:
        if form in preset.unread:
            assert preset.unread[form] not in preset.unread
    # A machine tells works apart by the layer, by the colour or by both.
    assert len(set(preset.layers.values())) == len(ROLES)
    assert len(set(preset.palette)) == len(preset.palette)
    if name != "plain":
        assert preset.colours["cut"] not in (preset.colours["score"], preset.colours["engrave"], *preset.palette)


@pytest.mark.parametrize(
    ("name", "cut", "engrave", "stroke"),
    [
        ("plain", "#000000", "#ff0000", 0.025),
        ("lightburn", "#000000", "#ff0000", 0.025),
        ("redcut", "#ff0000", "#000000", 0.025),
        ("ponoko", "#0000ff", "#ff0000", 0.01),
        ("boxes", "#000000", "#ff0000", 0.05),
    ],
)
def test_the_colours_are_those_of_the_targets(name: str, cut: str, engrave: str, stroke: float) -> None:
    """What the targets' users expect."""
    preset = load_preset(name)
    assert (preset.colours["cut"], preset.colours["engrave"], preset.stroke_width()) == (cut, engrave, stroke)


def test_the_lines_of_boxes_are_as_wide_as_the_kerf() -> None:
    """Twice the burn, at least 0.05 mm; elsewhere the kerf changes nothing."""
    assert load_preset("boxes").stroke_width(0.2) == 0.2
    assert load_preset("boxes").stroke_width(0.01) == 0.05
    assert load_preset("plain").stroke_width(0.2) == 0.025


def test_glowforge_reads_no_dxf_and_engraves_what_is_filled() -> None:
    """The message names what to write instead."""
    preset = load_preset("glowforge")
    assert preset.fill_engraving
    preset.require("svg")
    with pytest.raises(DesignError, match=r"preset: glowforge does not read dxf files\. Write svg"):
        preset.require("dxf")
    assert preset.layer_name("cut", "dxf") == "CUT"
    assert preset.layer_name("cut", "pdf") == "cut"


def test_a_users_preset_changes_single_keys(tmp_path: Path) -> None:
    """What a file leaves out comes from the preset that it extends; without one, from the neutral one."""
    file = tmp_path / "lab.toml"
    file.write_text(
        'extends = "redcut"\nstroke = 0.1\ncolours = { cut = "#FF00FE" }\ncurves = { dxf = "spline" }\n'
        'unread = { dxf = "svg" }\ntitle = "The laser of our lab"\n'
    )
    preset, base = load_preset(str(file)), load_preset("redcut")
    assert (preset.name, preset.title) == ("lab", "The laser of our lab")
    assert preset.colours == {**base.colours, "cut": "#ff00fe"}
    assert preset.palette == base.palette
    assert (preset.stroke, preset.svg_curves, preset.dxf_curves) == (0.1, base.svg_curves, "spline")
    assert preset.unread == {"dxf": "svg"}
    assert (preset.feed, preset.power, preset.power_max) == ({}, {}, 1000)
    file.write_text("")
    assert load_preset(str(file)).colours == load_preset("plain").colours


@pytest.mark.parametrize("name", ["lightbrun", "", "LightBurn ", "x" * 100, "plain.json"])
def test_an_unknown_name_is_refused(name: str) -> None:
    """With the names that there are."""
    with pytest.raises(DesignError, match=r"preset: unknown preset .* Presets are plain, lightburn") as caught:
        load_preset(name)
    assert ('Did you mean "lightburn"?' in str(caught.value)) == name.lower().startswith("light")


@pytest.mark.parametrize(
    ("text", "key", "message"),
    [
        ("strok = 1", None, r'unknown key .strok.\. Did you mean "stroke"\?'),
        ("title = 3", "title", "must be a text"),
        ("stroke = 0", "stroke", "must be greater than 0"),
        ("stroke = 11", "stroke", "at most 10"),
        ("stroke = true", "stroke", "must be a number, not true"),
        ("stroke = nan", "stroke", "finite"),
        ('stroke_kerf = "yes"', "stroke_kerf", "must be true or false"),
        ('colours = "red"', "colours", "must be a table"),
        ('colours = { cut = "red" }', "colours.cut", "must be a colour, not 'red'"),
        ('colours = { cut = "#ff000" }', "colours.cut", "six hexadecimal digits"),
        ('colours = { cuts = "#ff0000" }', "colours", 'Did you mean "cut"'),
        ('colours = { palette = ["#ff0000", 1] }', "colours.palette[1]", "must be a colour, not 1"),
        ('colours = { palette = "#ff0000" }', "colours.palette", "must be an array"),
        ('curves = { svg = "bezier" }', "curves.svg", "Write one of exact, arc, cubic, polyline"),
        ('curves = { dxf = "splines" }', "curves.dxf", 'Did you mean "spline"'),
        ('layers = { cut = "" }', "layers.cut", "must be a text"),
        ("layers.cut = 3", "layers.cut", "must be a text"),
        ('unread = { dxf = "dxf" }', "unread.dxf", "must not be 'dxf'"),
        ('unread = { dwg = "dxf" }', "unread", "unknown key 'dwg'"),
        ('contours = "closd"', "contours", 'Did you mean "closed"'),
        ('solid = "no"', "solid", "must be true or false"),
        ("spline_edges = 1", "spline_edges", "must be true or false"),
        ('misread = { dxf = "spline" }', "misread.dxf", r"must be an array, not 'spline'\. Write \[\"spline\"\]"),
        ('misread = { dxf = ["arc", "splin"] }', "misread.dxf[1]", 'Did you mean "spline"'),
        ('misread = { dwg = ["arc"] }', "misread", "unknown key 'dwg'"),
        ('extends = "lightbrun"', "extends", 'Did you mean "lightburn"'),
        ("extends = 1", "extends", "must be a text"),
        ("stroke = ", None, "line 1: not TOML: invalid value at the end"),
        ("a = " + "[" * 5000, None, "not TOML"),
        ("stroke = 1" + "0" * 5000, "stroke", "number beyond"),
    ],
)
def test_a_wrong_preset_is_refused(text: str, key: str | None, message: str, tmp_path: Path) -> None:
    """The message names file, key and remedy."""
    file = tmp_path / "lab.toml"
    file.write_text(text)
    with pytest.raises(DesignError, match=message) as caught:
        load_preset(str(file))
    assert caught.value.file == str(file)
    assert caught.value.key == key
    assert caught.value.remedy


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    """A missing file, a folder, bytes that are no text, a name that is none."""
    file = tmp_path / "lab.toml"
    for path in (str(file), str(tmp_path / "folder.toml"), "a\0b.toml"):
        (tmp_path / "folder.toml").mkdir(exist_ok=True)
        with pytest.raises(DesignError, match="cannot read the preset"):
            load_preset(path)
    file.write_bytes(b'\nname = "\xff"')
    with pytest.raises(DesignError, match="line 2: not a text in UTF-8"):
        load_preset(str(file))


@pytest.mark.parametrize("name", preset_names())
def test_lines_are_as_wide_as_asked_for_or_as_the_preset_says(name: str) -> None:
    """In SVG, all layers alike; a wider kerf changes nothing then."""
    own = load_preset(name).stroke_width(0.2)
    for stroke, kerf, wanted in ((None, 0.2, own), ("0.3mm", 0.2, 0.3), (0.05, 0.0, 0.05)):
        form = load_preset(name).first_format
        product = SQUARES.make(Job(preset=name, stroke=stroke, kerf=kerf, bar=True), form)
        assert {layer.stroke for layer in product.drawing.layers} == {wanted}
        if form == "svg":
            file = io.BytesIO()
            product.write(file)
            assert set(re.findall(rb'stroke-width="([^"]*)"', file.getvalue())) == {f"{wanted:g}".encode()}


def test_where_files_have_no_widths_it_is_said() -> None:
    """DXF and LightBurn's files; PDF has them."""
    tiles = starter("p4").tessellate()
    said = {form: tiles.make(Job(stroke=0.3), form).notes for form in ("svg", "pdf", "dxf", "lbrn2")}
    assert said["svg"] == said["pdf"] == ()
    for form in ("dxf", "lbrn2"):
        assert said[form] == (f"{form} files have no line widths: `stroke` changes nothing",)


def test_where_files_have_no_version_of_dxf_it_is_said() -> None:
    """In all other formats."""
    job = Job(dxf_version="R12")
    assert SQUARES.make(job, "dxf").notes == ()
    assert SQUARES.make(job, "svg").notes == ("svg files are not DXF: `dxf_version` changes nothing",)
