"""Expressions over columns: what Python says of each row, and nothing that runs code."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import voronoi_tiles as vt
from voronoi_tiles.sweeps.expression import Column, evaluate, without_sign

ROWS: list[dict[str, Any]] = [
    {"area": 900.0, "neck": 3.5, "group": "p3", "cell.a": 60.0, "site[0].strokes[0].bezier[1][0]": -2.0},
    {"area": 400.0, "neck": 0.5, "group": "p6", "cell.a": 50.0, "site[0].strokes[0].bezier[1][0]": 8.0},
    {"area": 900.0, "neck": math.nan, "group": "p6m", "cell.a": 70.0, "site[0].strokes[0].bezier[1][0]": 0.0},
]
COLUMNS = {
    name: Column("text" if name == "group" else "number", np.array([row[name] for row in ROWS])) for name in ROWS[0]
}


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("neck > 3", [True, False, False]),
        ("not neck > 3", [False, True, True]),
        ("area == 900 and neck < 10 or group == 'p6'", [True, True, False]),
        ("400 < area <= 900", [True, False, True]),
        ("group in ('p3', 'p6')", [True, True, False]),
        ("group not in ['p3']", [False, True, True]),
        ("cell.a in (50, 70)", [False, True, True]),
        ("cell.a * 2 - 20 > area / 9", [False, True, True]),
        ("site[0].strokes[0].bezier[1][0] >= 0", [False, True, True]),
        ("site[0] . strokes[ 0 ].bezier[1][0] < 0", [True, False, False]),
        ("sqrt(area) == 30", [True, False, True]),
        ("max(cell.a, 55) == cell.a", [True, False, True]),
        ("abs(-area) % 500 == 400", [True, True, True]),
        ("True", [True, True, True]),
        ("\tneck > 3\n", [True, False, False]),
    ],
)
def test_conditions_hold_where_they_do(text: str, found: list[bool]) -> None:
    """A condition is true for the rows of which it is; comparisons with a number that is missing are false."""
    kind, values = evaluate(text, COLUMNS)
    assert kind == "truth"
    assert values.tolist() == found


@pytest.mark.parametrize(
    ("text", "found"), [("-area", [-900, -400, -900]), ("area / cell.a ** 2", [0.25, 0.16, 900 / 4900])]
)
def test_arithmetic_gives_numbers(text: str, found: list[float]) -> None:
    """What is no condition is a number, by which rows are sorted."""
    kind, values = evaluate(text, COLUMNS)
    assert kind == "number"
    assert values == pytest.approx(found)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("nek > 3", 'there is no column nek. Did you mean "neck"? Columns are area, neck, group, cell.a'),
        ("cell.b > 3", "there is no column cell.b"),
        ("site[0].strokes[0].bezier[1][1] > 3", "there is no column site[0].strokes[0].bezier[1][1]"),
        ("group > 3", "'3' is a number, and a text is needed there"),
        ("-group", "'group' is a text, and a number is needed there"),
        ("area and neck", "'area' is a number, and a truth is needed there"),
        ("neck > 3 > group", "is a text, and a number is needed"),
        ("median(area)", 'there is no function median. Did you mean "min"? Functions are abs, sqrt'),
        ("abs(area, neck)", "abs takes one number"),
        ("max()", "max takes numbers"),
        ("area if neck else 3", "is not known here"),
        ("[x for x in area]", "is not known here"),
        ("lambda: 3", "is not known here"),
        ("area.real", "there is no column area.real"),
        ("().__class__", "there is no column ().__class__"),
        ("__import__('os').system('true')", "is not known here"),
        ("f'{area}' == 'x'", "is not known here"),
        ("b'x' == group", "is not known here"),
        ("area in cell", "'cell' is no list of values"),
        ("area is 3", "cannot be compared so"),
        ("(area := 3)", "is not known here"),
        ("area <", "is no expression: invalid syntax (column"),
        ("area; neck", "is no expression"),
        ("", "is no expression"),
        ("1" * 400, "number"),
        ("(" * 900 + "area" + ")" * 900, "is no expression"),
        ("-" * 1500 + "area", "is no expression"),
        ("a" * 3000, "is longer than 2,000 characters"),
        ("area\0", "is no expression"),
    ],
)
def test_what_is_no_expression_is_refused(text: str, message: str) -> None:
    """One message says what is wrong, and which columns and functions there are; no code of others runs."""
    with pytest.raises(vt.DesignError) as raised:
        evaluate(text, COLUMNS)
    assert message in str(raised.value)
    assert len(str(raised.value)) < 600


@pytest.mark.parametrize(
    ("text", "rest"),
    [("-area", "area"), ("- (area+neck)", "area + neck"), ("-area + neck", "-area + neck"), ("area", "area")],
)
def test_a_minus_before_all_is_taken_off(text: str, rest: str) -> None:
    """The minus that only says that the greatest comes first is no part of what is shown; any other minus is."""
    assert without_sign(text) == rest


NUMBERS = st.one_of(st.sampled_from(["area", "cell.a", "2", "0.5"]))
EXPRESSIONS = st.recursive(
    NUMBERS, lambda inner: st.builds("({} {} {})".format, inner, st.sampled_from(["+", "-", "*"]), inner), max_leaves=8
)


@given(EXPRESSIONS, st.sampled_from(["<", "<=", ">", ">=", "==", "!="]), EXPRESSIONS, st.sampled_from(["", "not "]))
def test_python_says_the_same_of_every_row(one: str, sign: str, other: str, negation: str) -> None:
    """Arithmetic and comparisons are those of Python, row by row, with its precedence."""
    text = f"{negation}{one} {sign} {other}"
    spelt = text.replace("cell.a", "cell_a")
    expected = [eval(spelt, {}, {"area": row["area"], "cell_a": row["cell.a"]}) for row in ROWS]  # noqa: S307 - the oracle
    assert evaluate(text, COLUMNS).values.tolist() == expected
