/** Lengths as people write them. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { evaluate, shown } from "../../../voronoi_tiles/studio/page/model/lengths.js";

test("sums, products, brackets and units", () => {
    for (const [text, mm, inches] of [
        ["12.5", 12.5, 12.5],
        ["12.5mm + 1/4in", 18.85, 18.85 / 25.4],
        ["60 - 2*3.5", 53, 53],
        ["(60 - 2*3.5) mm", 53, 53 / 25.4],
        ["1in + 1", 26.4, 2],
        ["-2,5 cm", -25, -2.5 / 2.54],
        ["2 × 1″", 50.8, 2],
        ["3 cm ÷ 4", 7.5, 7.5 / 25.4],
        ["1e2 − .5", 99.5, 99.5],
        ["0.1 + 0.2", 0.3, 0.3],
        ["2*(1 + 1/2)in", 76.2, 3],
    ]) {
        assert.equal(evaluate(text, "mm"), mm, text);
        assert.ok(Math.abs(evaluate(text, "in") - inches) < 1e-14, text);
    }
});

test("what is no length is refused in words, with what to write", () => {
    for (const [text, said] of [
        ["", "Write a length"],
        ["2 *", "number is missing"],
        ["4ft", "no unit “ft”"],
        ["1 1/2", "does not go on with “1”"],
        ["(3mm", "not closed"],
        ["3mm)", "does not go on with “)”"],
        ["3mm * 2mm", "multiplied"],
        ["3 / (2mm)", "divided by a length"],
        ["3mm mm", "does not go on"],
        ["1/0", "no number"],
        ["3 $ 4", "“$” has no meaning"],
        ["constructor", "A number is missing"],
        ["3 constructor", "no unit"],
    ]) {
        const wanted = ({ message }) => message.includes(said) && message.includes("Write a length such as");
        assert.throws(() => evaluate(text, "mm"), wanted, text);
    }
});

test("lengths are shown short", () => {
    assert.deepEqual(
        [100, 12.5, 0.12345, -0.0001, 1000].map((value) => shown(value, "mm")),
        ["100", "12.5", "0.123", "0", "1000"],
    );
    assert.deepEqual(
        [0.25, 1 / 3].map((value) => shown(value, "in")),
        ["0.25", "0.3333"],
    );
});
