/** The letters of the tools: what they can be. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { letterOf, letterProblem, lettersOf, withLetter } from "../../../voronoi_tiles/studio/page/tools/letters.js";
import { TOOLS } from "../../../voronoi_tiles/studio/page/tools/toolbox.js";

const [select, pen] = TOOLS;

test("the letters that the tools have are ones that they can have", () => {
    for (const tool of TOOLS) assert.equal(letterProblem(letterOf(tool, {})), null, tool.name);
});

test("a letter is one that the page has no other use for", () => {
    for (const letter of ["q", "1", "v"]) assert.equal(letterProblem(letter), null);
    for (const letter of ["e", "g", "k", "j", "3"]) assert.match(letterProblem(letter), /does something else/);
    for (const letter of ["", " ", "?", "+", ".", "ab", "Q"]) assert.match(letterProblem(letter), /Give one/);
});

test("a letter goes to one tool only: two tools change theirs", () => {
    assert.deepEqual(withLetter(pen, "q", {}), { pen: "q" });
    const swapped = withLetter(pen, "v", {});
    assert.deepEqual([letterOf(pen, swapped), letterOf(select, swapped)], ["v", "p"]);
    assert.deepEqual(withLetter(pen, "v", swapped), swapped);
    let given = {};
    for (const [tool, letter] of [
        [pen, "q"],
        [select, "q"],
        [TOOLS[2], "v"],
        [pen, "v"],
    ]) {
        given = withLetter(tool, letter, given);
        assert.equal(letterOf(tool, given), letter);
        assert.equal(new Set(TOOLS.map((one) => letterOf(one, given))).size, TOOLS.length);
    }
});

test("of the letters that were kept only those that make sense are taken", () => {
    const swapped = withLetter(pen, "v", {});
    assert.deepEqual(lettersOf(swapped), swapped);
    const given = lettersOf({ pen: "q", select: 5, hand: "e", line: "q", other: "x" });
    assert.deepEqual(Object.keys(given).sort(), ["line", "pen"]);
    assert.equal(new Set(TOOLS.map((one) => letterOf(one, given))).size, TOOLS.length);
    for (const junk of [null, undefined, 3, "x", []]) assert.deepEqual(lettersOf(junk), {});
});
