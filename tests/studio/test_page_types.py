"""The page's modules have the types that their comments declare, by TypeScript, and the layout of Prettier."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest
from helpers.page import PAGE, TESTS, node, tool


def check(config: Path) -> subprocess.CompletedProcess[str]:
    """Check what a jsconfig.json names."""
    command = [node(), tool("typescript/bin/tsc"), "--project", str(config), "--pretty", "false"]
    return subprocess.run(command, capture_output=True, encoding="utf-8", timeout=300, check=False)


def test_types_of_the_page() -> None:
    """All modules pass the strict check."""
    done = check(TESTS / "jsconfig.json")
    assert done.returncode == 0, done.stdout


def test_every_module_is_checked() -> None:
    """None is left out by the configuration, and each asks editors for the check."""
    listed = subprocess.run(
        [node(), tool("typescript/bin/tsc"), "--project", TESTS / "jsconfig.json", "--listFilesOnly"],
        capture_output=True,
        encoding="utf-8",
        timeout=300,
        check=True,
    ).stdout.splitlines()
    modules = {str(path) for path in PAGE.rglob("*.js")}
    assert modules
    assert modules <= set(listed)
    assert [path for path in modules if not Path(path).read_text(encoding="utf-8").startswith("// @ts-check\n")] == []


def laid_out(*files: Path) -> subprocess.CompletedProcess[str]:
    """Check the layout of files."""
    prettier = tool("prettier/bin/prettier.cjs")
    command = [node(), prettier, "--config", str(TESTS / "package.json"), "--check", *map(str, files)]
    return subprocess.run(command, capture_output=True, encoding="utf-8", timeout=300, check=False)


def test_layout_of_the_page(tmp_path: Path) -> None:
    """All modules, and the tests' scripts, are as `make page-format` writes them; what is not is found."""
    programs = sorted((TESTS.parent / "readers/programs").glob("*.mjs"))
    assert programs
    done = laid_out(*sorted(PAGE.rglob("*.js")), *sorted((TESTS / "page").glob("*.js")), *programs)
    assert done.returncode == 0, done.stderr
    spoilt = tmp_path / "spoilt.js"
    spoilt.write_text("export const two = [ 1,2 ]\n", encoding="utf-8")
    done = laid_out(spoilt)
    assert done.returncode == 1
    assert "spoilt.js" in done.stderr


@pytest.mark.parametrize(
    ("mistake", "message"),
    [
        ("export const edited = addStroke(design, 0, { circel: [0, 0] });", "circel"),
        ("export const moved = moveStrokes(design, [{ site: 0 }], [1, 2]);", "stroke"),
        ("design.group = 'p4';", "read-only"),
        ("export function untyped(value) { return value; }", "implicitly has an 'any' type"),
    ],
)
def test_mistakes_are_found(tmp_path: Path, mistake: str, message: str) -> None:
    """A key that there is not, one that is missing, a design changed in place, an untyped argument."""
    module = tmp_path / "mistaken.js"
    model = (PAGE / "model" / "design.js").as_posix()
    module.write_text(
        f"// @ts-check\nimport {{ addStroke, moveStrokes }} from '{model}';\n"
        f"/** @type {{import('{model}').Design}} */\n"
        "const design = { schema: 1, group: 'p1', cell: { a: 1 }, site: [] };\n"
        f"{mistake}\nvoid [addStroke, moveStrokes, design];\n",
        encoding="utf-8",
    )
    options = {"extends": str(TESTS / "jsconfig.json"), "include": [str(module)]}
    (tmp_path / "jsconfig.json").write_text(json.dumps(options), encoding="utf-8")
    done = check(tmp_path / "jsconfig.json")
    assert done.returncode != 0
    assert message in done.stdout
    assert "mistaken.js" in done.stdout
