"""The examples in the docstrings of the public names run, and print what they show."""

from __future__ import annotations

import doctest
import inspect

import pytest

import voronoi_tiles as vt

FLAGS = doctest.NORMALIZE_WHITESPACE


def examples(name: str) -> list[doctest.DocTest]:
    """The examples in the docstrings of a public name and of its members."""
    value = getattr(vt, name)
    if inspect.ismodule(value):  # that of preflight can be called, and has the function's name
        value = getattr(value, name)
    if not (inspect.isclass(value) or inspect.isfunction(value)):
        return []
    found = doctest.DocTestFinder(exclude_empty=True).find(value, name, module=False, globs={})
    return [test for test in found if test.examples]


TESTS = {test.name: test for name in vt.__all__ for test in examples(name)}


@pytest.mark.parametrize("test", TESTS.values(), ids=TESTS.keys())
def test_examples_print_what_they_show(test: doctest.DocTest) -> None:
    """Each docstring by itself: it imports what it uses."""
    output: list[str] = []
    result = doctest.DocTestRunner(optionflags=FLAGS).run(test, out=output.append)
    assert result.attempted
    assert not result.failed, "".join(output)


def test_what_one_begins_with_has_an_example() -> None:
    """The names that a script starts from, and the ways to make a design and a file."""
    for name in ("Design", "Site", "Stroke", "Art", "Tile", "Tiling", "Tiling.copies", "Tiling.make", "Tiling.report"):
        assert name in TESTS, name
    for name in ("Job", "coupon", "preflight", "render", "starter"):
        assert name in TESTS, name


def test_a_wrong_example_fails() -> None:
    """The runner sees another result, and another error."""
    for text in (">>> 1 + 1\n3\n", ">>> 1 / 0\nTraceback (most recent call last):\nZeroDivisionError: other\n"):
        test = doctest.DocTestParser().get_doctest(text, {}, "wrong", None, None)
        assert doctest.DocTestRunner(optionflags=FLAGS, verbose=False).run(test, out=lambda _: None).failed == 1
