/** The letters of the tools: what they can be. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { letterOf, letterProblem, lettersOf } from "../../../voronoi_tiles/studio/page/tools/letters.js";
import { TOOLS } from "../../../voronoi_tiles/studio/page/tools/toolbox.js";

const [select, pen] = TOOLS;

test("the letters that the tools have are ones that they can have", () => {
    for (const tool of TOOLS) assert.equal(letterProblem(tool, letterOf(tool, {}), {}), null, tool.name);
});

test("a letter goes to one tool only, and none that the page has another use for", () => {
    assert.equal(letterOf(pen, { pen: "q" }), "q");
    assert.equal(letterProblem(pen, "q", {}), null);
    assert.equal(letterProblem(pen, "1", {}), null);
    assert.match(letterProblem(pen, "v", {}), /V is the letter of “Select”/);
    assert.match(letterProblem(select, "q", { pen: "q" }), /Q is the letter of “Pen”/);
    assert.equal(letterProblem(pen, "v", { select: "q" }), null, "it has become free");
    assert.equal(letterProblem(select, "p", { pen: "q" }), null);
    for (const letter of ["e", "g", "k", "j"]) assert.match(letterProblem(pen, letter, {}), /does something else/);
    for (const letter of ["", " ", "?", "+", ".", "ab", "Q"]) assert.match(letterProblem(pen, letter, {}), /Give one/);
});

test("of the letters that were kept only those that make sense are taken", () => {
    assert.deepEqual(lettersOf({ pen: "q", select: 5, hand: "e", line: "q", other: "x" }), { pen: "q" });
    for (const junk of [null, undefined, 3, "x", []]) assert.deepEqual(lettersOf(junk), {});
});
