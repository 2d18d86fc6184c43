"""Edits of TOML files: they read as they are meant to; all else is as it was, comments with what they are of."""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Sequence
from copy import deepcopy
from datetime import date
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.designs.starters import GROUP_NAMES, starter_text
from voronoi_tiles.studio.matching import json_form, matched
from voronoi_tiles.studio.toml_edit import edited, written
from voronoi_tiles.studio.toml_syntax import syntax_of

ROOT = Path(__file__).parents[2]
TEXTS = {
    **{
        path.stem: path.read_bytes().decode()
        for path in sorted((ROOT / "examples").rglob("*.toml"))
        if path.parent.name != "sweeps"
    },
    **{f"starter-{group}": starter_text(group) for group in GROUP_NAMES},
}

ODD = """\
# All ways of writing a design.

"schema" = 1
group = 'p1'
cell . a = 6_0.0   # side
cell.b = 1e3
extra = { x = 0x1F, "y z" = [ 1,2 ,3 ], on = 1979-05-27 07:32:00, deep.er = inf }   # extra
text = \"\"\"
# no comment, "quoted\"\"\"\"\"
[[site]] # one
name = "a"
  [[ site . strokes ]]
  # first
  point = [1, 2] # beside
  [[site.strokes]]
  segment = [[1, 2]
    , # after a comma
    [3, 4]
  ] # end
[site.art]
file = 'x#.svg'
# below the art

# of the job
[job]
x = nan
# two
[[site]]
name = "b"
strokes = [{point=[5,6]}, # p
  {circle = [1, 2], radius = 6_0.5}]"""


def lines_changed(before: str, after: str) -> tuple[int, int]:
    """How many lines were taken out, and how many put in."""
    changes = [line[:1] for line in difflib.ndiff(before.splitlines(), after.splitlines())]
    return changes.count("-"), changes.count("+")


def plain(value: Any) -> Any:
    """A value in which numbers are floats, to compare: what is not a number equals itself here."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [plain(item) for item in value]
    return (
        value
        if isinstance(value, bool | str)
        else repr(float(value) + 0.0)
        if isinstance(value, int | float)
        else value
    )


def edit(text: str, meant: dict[str, Any]) -> str:
    """The edited text, which reads as it is to, and of which all could be kept."""
    result = edited(text, meant)
    assert plain(tomllib.loads(result.text)) == plain(meant)
    assert result.notes == ()
    return result.text


@pytest.mark.parametrize("name", TEXTS)
def test_an_unchanged_design_is_the_same_bytes(name: str) -> None:
    """Also after a way through JSON, where whole numbers have lost their points."""
    text = TEXTS[name]
    through_json = plain_numbers(tomllib.loads(text))
    for newline in ("\n", "\r\n"):
        ended = text.replace("\n", newline)
        for variant in (ended, ended.rstrip()):
            assert syntax_of(variant).text == variant
            assert edited(variant, through_json) == (variant, ())


def plain_numbers(value: Any) -> Any:
    """A value as JavaScript gives it back: whole numbers without a point, no -0."""
    if isinstance(value, dict):
        return {key: plain_numbers(item) for key, item in value.items()}
    if isinstance(value, list):
        return [plain_numbers(item) for item in value]
    return int(value) if isinstance(value, float) and value.is_integer() else value


@pytest.mark.parametrize("text", [ODD, ODD.replace("\n", "\r\n")], ids=["lf", "crlf"])
def test_everything_that_toml_has_is_given_back(text: str) -> None:
    """Strings with brackets and hashes, dates, dotted keys, tables in arrays, no line end at the end."""
    assert syntax_of(text).text == text
    assert edited(text, tomllib.loads(text)) == (text, ())
    assert edited(text, json_form(tomllib.loads(text))) == (text, ())


@pytest.mark.parametrize("name", TEXTS)
def test_a_moved_point_is_one_line(name: str) -> None:
    """One line goes, one comes, and comments and line ends stay."""
    text = TEXTS[name]
    meant = tomllib.loads(text)
    strokes = [stroke for site in meant["site"] for stroke in site["strokes"]]
    points = [value for stroke in strokes for value in stroke.values() if isinstance(value, list)]
    if points:
        (points[-1][0] if isinstance(points[-1][0], list) else points[-1])[0] += 0.125
    else:
        strokes[-1]["path"] = strokes[-1]["path"].replace("1", "1.125", 1)
    after = edit(text, meant)
    assert lines_changed(text, after) == (1, 1)
    assert re.findall("#.*", text) == re.findall("#.*", after)


@pytest.mark.parametrize(
    ("old", "new", "spelled"),
    [
        ("60.0", 60, "60.0"),
        ("1e3", 1000, "1e3"),
        ("6_0.0", 61.5, "61.5"),
        ("60.0", 61, "61.0"),
        ("60", 61.0, "61"),
        ("60", 61.5, "61.5"),
        ("0x1F", 32, "32"),
        ("-0.0", 0, "-0.0"),
        ("1", -0.0, "-0.0"),
        ("nan", float("nan"), "nan"),
        ("nan", "nan", "nan"),
        ("1.0", float("-inf"), "-inf"),
        ("1.0", 5e-324, "5e-324"),
        ("1.0", 0.1 + 0.2, "0.30000000000000004"),
        ("1.0", 1e300, "1e+300"),
        ("1", 2**60 + 1, "1152921504606846977"),
        ("1.0", 10**400, "1" + "0" * 400),
        ("1.0", np.float32(1.5), "1.5"),
        ("1.0", np.int64(3), "3.0"),
        ("1", np.float64(2.0), "2"),
        ("true", 1, "1"),
        ("1", True, "true"),
        ("1979-05-27", "1979-05-27", "1979-05-27"),
        ("'a'", 'b"', '"b\\""'),
    ],
)
def test_spelling(old: str, new: object, spelled: str) -> None:
    """A value that is the same keeps its spelling; a new one is spelled like the old where it can be."""
    assert edited(f"x = {old} # c\n", {"x": new}).text == f"x = {spelled} # c\n"


def test_comments_keep_their_column() -> None:
    """A comment that stands apart stays where it is, where there is room."""
    assert edit("a = 60.0   # side\nb = 5 # x\n", {"a": 60.25, "b": 55}) == "a = 60.25  # side\nb = 55 # x\n"
    assert edit("a = 60.0  # side\n", {"a": 60.125}) == "a = 60.125 # side\n"
    assert edit("a = 60.125 # side\n", {"a": 6}) == "a = 6.0 # side\n"


class Case(NamedTuple):
    """A text, what is done to what it says, and the text after that."""

    before: str
    change: str
    after: str


CASES = {
    "a key that comes stands behind the last, above the next header's comment": Case(
        "[cell] # c\na = 60.0 # side\n\n# the bird\n[[site]]\nname = 'x'\n",
        "d['cell']['b'] = 50; d['cell']['angle'] = 75.5",
        "[cell] # c\na = 60.0 # side\nb = 50.0\nangle = 75.5\n\n# the bird\n[[site]]\nname = 'x'\n",
    ),
    "a key that goes takes its comments along": Case(
        "[cell]\na = 60.0\n# other\nb = 50.0 # side\nangle = 75 # degrees\n# below\n\n[x]\n",
        "del d['cell']['b']",
        "[cell]\na = 60.0\nangle = 75 # degrees\n# below\n\n[x]\n",
    ),
    "a comment apart from what goes stays": Case(
        "[cell]\n# all\n\n# side\na = 60.0\nb = 50\n",
        "del d['cell']['a']",
        "[cell]\n# all\n\nb = 50\n",
    ),
    "a key of a text without a last line end": Case(
        "x = 1\n[cell]\na = 60.0", "d['cell']['b'] = 50", "x = 1\n[cell]\na = 60.0\nb = 50.0\n"
    ),
    "a table of an array behind a comment without a line end": Case(
        "[[site]]\na = 1 # c",
        "d['site'].append({'strokes': [{'point': [1, 2]}]})",
        "[[site]]\na = 1 # c\n\n[[site]]\nstrokes = [\n  { point = [1, 2] },\n]\n",
    ),
    "a key at the top stands above the first table": Case(
        "# head\n\nschema = 1\n\n[cell]\na = 1\n",
        "d['scale'] = 2.5",
        "# head\n\nschema = 1\nscale = 2.5\n\n[cell]\na = 1\n",
    ),
    "a site that goes takes its comments, and no others'": Case(
        "x = 1\n\n# one\n[[site]] # 1\na = 1 # a\n# under one\n\n# apart\n\n# two\n[[site]]\na = 2\n\n# tail\n",
        "del d['site'][0]",
        "x = 1\n\n# apart\n\n# two\n[[site]]\na = 2\n\n# tail\n",
    ),
    "a comment apart above a site that goes stays": Case(
        "x = 1\n\n# apart\n\n# one\n[[site]]\na = 1\n\n# two\n[[site]]\na = 2\n",
        "del d['site'][0]",
        "x = 1\n\n# apart\n\n# two\n[[site]]\na = 2\n",
    ),
    "a comment apart above the last site, which goes": Case(
        "x = 1\n\n# apart\n\n[[site]]\na = 1\n", "del d['site']", "x = 1\n\n# apart\n"
    ),
    "the last site goes": Case(
        "# one\n[[site]]\na = 1\n\n# two\n[[site]]\na = 2\n\n# tail\n",
        "del d['site'][1]",
        "# one\n[[site]]\na = 1\n\n# tail\n",
    ),
    "sites change places with their comments": Case(
        "# one\n[[site]]\na = 1 # 1\n\n\n# two\n[[site]]\na = 2",
        "d['site'].reverse()",
        "# two\n[[site]]\na = 2\n\n\n# one\n[[site]]\na = 1 # 1\n",
    ),
    "a new first site": Case(
        "x = 1\n\n# apart\n\n# one\n[[site]]\na = 1\n",
        "d['site'].insert(0, {'a': 0})",
        "x = 1\n\n# apart\n\n[[site]]\na = 0\n\n# one\n[[site]]\na = 1\n",
    ),
    "sites around another table": Case(
        "[[site]]\na = 1\n[job]\nx = 1\n[[site]]\na = 2\n",
        "d['site'].append({'a': 3}); d['site'][1]['b'] = 5",
        "[[site]]\na = 1\n[job]\nx = 1\n[[site]]\na = 2\nb = 5\n\n[[site]]\na = 3\n",
    ),
    "a stroke goes with its comments": Case(
        "s = [ # all\n  # one\n  { p = [1, 2] }, # 1\n  # two\n  { p = [3, 4] }, # 2\n\n  # end\n]\n",
        "del d['s'][0]",
        "s = [ # all\n  # two\n  { p = [3, 4] }, # 2\n\n  # end\n]\n",
    ),
    "the last stroke goes": Case(
        "s = [\n  { p = [1, 2] }, # 1\n  # apart\n\n  # two\n  { p = [3, 4] } # 2\n]\n",
        "del d['s'][1]",
        "s = [\n  { p = [1, 2] } # 1\n  # apart\n]\n",
    ),
    "a stroke comes": Case(
        "s = [\n  # one\n  { p = [1, 2] }, # 1\n  { p = [3, 4] } # 2\n]\n",
        "d['s'].insert(1, {'q': [0.5, 1]}); d['s'].append({'p': [5, 6]})",
        "s = [\n  # one\n  { p = [1, 2] }, # 1\n  { q = [0.5, 1] },\n  { p = [3, 4] }, # 2\n  { p = [5, 6] }\n]\n",
    ),
    "strokes change places with their comments": Case(
        "s = [ { p = [1, 2] }, # 1\n  # two\n  { p = [3, 4] } # 2\n]\n",
        "d['s'].reverse()",
        "s = [\n  # two\n  { p = [3, 4] }, # 2\n  { p = [1, 2] } # 1\n]\n",
    ),
    "a stroke becomes another kind where it is": Case(
        "s = [\n  # a curve\n  { c = [[1, 2]] }, # 1\n  { p = [3, 4] },\n]\n",
        "d['s'][0] = {'b': [[1, 2], [3, 4]]}",
        "s = [\n  # a curve\n  { b = [[1, 2], [3, 4]] }, # 1\n  { p = [3, 4] },\n]\n",
    ),
    "a key of a stroke": Case(
        "s = [{ p = [1, 2], w = 1.0 }, {p = [3, 4]}]\n",
        "d['s'][0]['w'] = 2; d['s'][1]['mirror'] = True",
        "s = [{ p = [1, 2], w = 2.0 }, {p = [3, 4], mirror = true}]\n",
    ),
    "a key of a stroke goes": Case("s = {a = 1, b = 2, c = 3}\n", "del d['s']['a'], d['s']['c']", "s = {b = 2}\n"),
    "points come and go": Case(
        "p = [[0, 0], [1.0, 1],\n     [2, 2]]\n",
        "d['p'].insert(1, [0.5, 0.5]); del d['p'][0]",
        "p = [[0.5, 0.5], [1.0, 1],\n     [2, 2]]\n",
    ),
    "commas at the beginning of lines": Case(
        "p = [ 1 # one\n    , 2 # two\n    ]\n", "d['p'].append(3)", "p = [ 1 # one\n    , 2, # two\n 3\n    ]\n"
    ),
    "dotted keys": Case(
        "cell.a = 60.0 # a\ncell.b = 1\nx = 1\n",
        "d['cell']['angle'] = 75; del d['cell']['b']; d['cell']['a'] = 6",
        "cell.a = 6.0 # a\ncell.angle = 75.0\nx = 1\n",
    ),
    "tables below sites": Case(
        "[[site]]\n[[site.strokes]]\n# p\np = [1, 2] # 1\n[[site.strokes]]\np = [3, 4]\n[site.art]\nfile = 'x'\n",
        "s = d['site'][0]; s['strokes'].append({'p': [5, 6]}); del s['strokes'][0]; s['art']['file'] = 'y'",
        '[[site]]\n[[site.strokes]]\np = [3, 4]\n\n[[site.strokes]]\np = [5, 6]\n[site.art]\nfile = "y"\n',
    ),
    "a table goes": Case("a = 1\n\n# b\n[b]\nx = 1\n\n# c\n[c]\n", "del d['b']", "a = 1\n\n# c\n[c]\n"),
    "a table comes": Case("a = 1\n[b]\nx = 1", "d['c'] = {'y z': 'u'}", 'a = 1\n[b]\nx = 1\n\n[c]\n"y z" = "u"\n'),
    "lines end in CR LF": Case(
        "[cell]\r\na = 1\r\n\r\n[[site]]\r\ns = [\r\n  { p = [1, 2] }, # 1\r\n]",
        "d['cell']['b'] = 2; d['site'][0]['s'].append({'p': [3, 4]}); d['site'].append({'s': [{'p': [5, 6]}]})",
        "[cell]\r\na = 1\r\nb = 2\r\n\r\n[[site]]\r\ns = [\r\n  { p = [1, 2] }, # 1\r\n  { p = [3, 4] },\r\n]\r\n\r\n"
        "[[site]]\r\ns = [\r\n  { p = [5, 6] },\r\n]\r\n",
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_edits(name: str) -> None:
    """Each edit is the one that a careful person would make."""
    case = CASES[name]
    d = tomllib.loads(case.before)
    exec(case.change, {"d": d})  # noqa: S102 - the cases above
    assert edit(case.before, d) == case.after


def test_long_strokes_are_wrapped() -> None:
    """A new stroke of many points in an array of lines is broken over lines itself."""
    points = [[k / 7, k] for k in range(20)]
    after = edit("s = [\n  { p = [1, 2] },\n]\n", {"s": [{"p": [1, 2]}, {"catmull_rom": points}]})
    assert max(map(len, after.splitlines())) <= 120
    assert len(after.splitlines()) > 5


def test_texts_are_not_wrapped() -> None:
    """However much they look like points."""
    value = [{"p": [1, 2]}, {"text": "], [" * 40, "points": [[k, k] for k in range(40)]}]
    edit("s = [\n  { p = [1, 2] },\n]\n", {"s": value})
    assert tomllib.loads(written({"s": value})) == {"s": value}


# Designs as people comment them: every comment is unlike all others, and it is known what it belongs to.


class Stroke(NamedTuple):
    """A stroke whose first point tells it from all others, with a comment above and one beside it."""

    number: int
    points: tuple[float, ...]
    above: bool
    beside: bool

    @property
    def table(self) -> dict[str, Any]:
        """What it says."""
        return {"catmull_rom": [[self.number, self.number], *([x, 1] for x in self.points)]}

    @property
    def comments(self) -> list[str]:
        """Its comments."""
        return [f"# above {self.number}."] * self.above + [f"# beside {self.number}."] * self.beside

    def text(self, comma: str) -> str:
        """Its lines."""
        above = f"  # above {self.number}.\n" if self.above else ""
        beside = f"   # beside {self.number}." if self.beside else ""
        points = ", ".join(f"[{x!r}, {y!r}]" for x, y in self.table["catmull_rom"])
        return f"{above}  {{ catmull_rom = [{points}] }}{comma}{beside}\n"


@st.composite
def strokes(draw: st.DrawFn) -> list[list[Stroke]]:
    """Strokes of some sites."""
    sites = []
    for k in range(draw(st.integers(1, 3))):
        count = draw(st.integers(1, 5))
        sites.append(
            [
                Stroke(
                    1000 * (k + 1) + n,
                    tuple(draw(st.lists(st.integers(0, 99).map(lambda x: x / 4), min_size=3, max_size=4))),
                    draw(st.booleans()),
                    draw(st.booleans()),
                )
                for n in range(count)
            ]
        )
    return sites


def document(sites: Sequence[Sequence[Stroke]], comma: str) -> str:
    """A design of these strokes, a comment at everything."""
    parts = ["# the head.\n\nschema = 1 # version.\n\n# cell above.\n[cell] # cell beside.\na = 60.0\n"]
    for site in sites:
        number = site[0].number
        parts.append(f"\n# site above {number}.\n[[site]] # site beside {number}.\n")
        parts.append(f"name = 'n{number}'\nstrokes = [ # in {number}.\n")
        parts += [stroke.text("," if stroke is not site[-1] else comma) for stroke in site]
        parts.append("]\n")
    return "".join([*parts, "\n# the tail.\n"])


def some(data: st.DataObject, items: list[Any], change: str) -> list[Any]:
    """Some of the items, or all in another order, or all of them."""
    if change == "drop":
        return [item for item in items if data.draw(st.booleans())]
    return data.draw(st.permutations(items)) if change == "shuffle" else items


@settings(max_examples=50)
@given(sites=strokes(), comma=st.sampled_from(["", ","]), data=st.data())
def test_comments_stay_with_what_they_are_of(sites: list[list[Stroke]], comma: str, data: st.DataObject) -> None:
    """Strokes and sites come, go, change and change places: each takes its comments along, and nobody else's.

    Lines that have nothing to do with it stay as they are.
    """
    text = document(sites, comma)
    meant = tomllib.loads(text)
    changes = st.sampled_from(["keep", "add", "drop", "shuffle"])
    expected = ["# the head.", "# version.", "# cell above.", "# cell beside.", "# the tail."]
    touched = 2 * len(sites)  # commas that come and go
    change = data.draw(st.sampled_from(["keep", "drop", "shuffle"]))
    bounded = change != "shuffle"
    kept = some(data, sites, change)
    meant["site"] = []
    for site in kept:
        number = site[0].number
        change = data.draw(changes)
        bounded &= change != "shuffle"
        rest = some(data, site, change)
        tables = [stroke.table for stroke in rest]
        for table in tables:
            if data.draw(st.integers(0, 2)) == 0:
                table["catmull_rom"][-1][1] += 0.5
                touched += 1
        if change == "add":
            tables.insert(data.draw(st.integers(0, len(tables))), {"point": [number / 2, 7]})
            touched += 1
        meant["site"].append({"name": f"n{number}", "strokes": tables})
        expected += [f"# site above {number}.", f"# site beside {number}.", f"# in {number}."]
        expected += [comment for stroke in rest for comment in stroke.comments]
        touched += sum(len(stroke.text("").splitlines()) for stroke in site if stroke not in rest)
    for site in sites:
        touched += 0 if site in kept else len(document([site], "").splitlines())
    if not kept:
        del meant["site"]
    after = edit(text, meant)
    assert sorted(re.findall("#.*", after)) == sorted(expected)
    lines = after.splitlines()
    for k, line in enumerate(lines):
        for stroke in (stroke for site in sites for stroke in site):
            start = f"[[{stroke.number}, {stroke.number}]"
            assert f"# beside {stroke.number}." not in line or start in line
            assert f"# above {stroke.number}." not in line or start in lines[k + 1]
    if bounded:
        assert max(lines_changed(text, after)) <= touched


NUMBERS = st.one_of(st.integers(-50, 50), st.integers(-200, 200).map(lambda n: n / 8))
VALUES = st.recursive(
    st.one_of(NUMBERS, st.booleans(), st.text(max_size=4), st.just(date(2026, 1, 2))),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.dictionaries(st.sampled_from(["a", "b", "y z", "ü", ""]), inner, max_size=3)
    ),
    max_leaves=8,
)


@settings(max_examples=70)
@given(
    text=st.sampled_from([ODD, *TEXTS.values()]),
    ending=st.sampled_from(["lf", "crlf", "stripped"]),
    data=st.data(),
)
def test_any_edit_reads_as_it_is_meant(text: str, ending: str, data: st.DataObject) -> None:
    """Values of any kind in any place, one edit after the other: the text is TOML and says what it is to."""
    text = {"lf": text, "crlf": text.replace("\n", "\r\n"), "stripped": text.rstrip()}[ending]
    for _ in range(data.draw(st.integers(1, 3))):
        meant = deepcopy(tomllib.loads(text))
        for _ in range(data.draw(st.integers(1, 3))):
            at: Any = meant
            while True:
                keys = list(at) if isinstance(at, dict) else list(range(len(at)))
                key = data.draw(st.sampled_from(keys)) if keys else None
                if key is not None and isinstance(at[key], dict | list) and data.draw(st.integers(0, 4)) > 0:
                    at = at[key]
                    continue
                break
            change = data.draw(st.sampled_from(["set", "remove", "add", "swap"]))
            if change == "add" or key is None:
                value = data.draw(VALUES)
                at.insert(0, value) if isinstance(at, list) else at.update({data.draw(st.sampled_from("abc ")): value})
            elif change == "remove":
                del at[key]
            elif change == "swap" and isinstance(at, list):
                at.reverse()
            else:
                at[key] = data.draw(VALUES)
        result = edited(text, meant)
        assert plain(tomllib.loads(result.text)) == plain(meant)
        text = result.text


def test_what_cannot_be_edited_is_said() -> None:
    """A table that is defined by dotted keys and by headers as well is written anew, with all around it."""
    text = "# head\nschema = 1\n[a]\nb.c = 1\n[a.b.d]\nx = 1\n"
    meant = {"schema": 1, "a": {"b": {"c": 1, "d": {"x": 2}}}}
    result = edited(text, meant)
    assert tomllib.loads(result.text) == meant
    assert "anew" in result.notes[0]


def test_comments_that_are_lost_are_said() -> None:
    """A list of strokes that becomes a text takes the comments within it along, and that is said."""
    result = edited("s = [ # c\n  1,\n]\nt = 1 # t\n", {"s": "x", "t": 1})
    assert result.text == 's = "x"\nt = 1 # t\n'
    assert "comments within it are gone" in result.notes[0]


@pytest.mark.parametrize("value", [None, {"a": None}, [{1: 2}], "\ud800", b"bytes"], ids=repr)
def test_what_toml_does_not_have_is_refused(value: object) -> None:
    """Nothing is written in its place."""
    with pytest.raises(DesignError):
        edited("schema = 1\n", {"schema": 1, "x": value})


def test_deep_nesting_is_refused() -> None:
    """What Python cannot write or read is no traceback."""
    deep: Any = 1
    for _ in range(5000):
        deep = [deep]
    with pytest.raises(DesignError):
        edited("schema = 1\n", {"schema": 1, "x": deep})


def test_items_are_found_again() -> None:
    """Equal ones wherever they are; changed tables by what is alike; others by their place."""
    a, b, c = {"p": [[1, 2], [3, 4]]}, {"p": [[5, 6], [7, 8]]}, {"q": 1}
    assert matched([a, b, c], [c, a, b]) == [2, 0, 1]
    assert matched([a, b, c], [{"p": [[5, 6], [7, 9]]}, c]) == [1, 2]
    assert matched([a, b], [a, {"r": 5}]) == [0, 1]
    assert matched([a, c], [a, c, {"r": 5}]) == [0, 1, None]
    assert matched([1, 2, 3], [1, 5, 3]) == [0, 1, 2]
    assert matched([True, [1]], [[1], 1]) == [1, None]
