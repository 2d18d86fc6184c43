/** The picture to trace: what a drag of one of its corners does to it. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { UNLAID, cornersOf, inUnits, laidOf, pulled } from "../../../voronoi_tiles/studio/page/model/tracing.js";
import { assertNear, frozen } from "./helpers.js";

const PICTURE = { width: 400, height: 200 };
const LAID = frozen({ at: [10, 20], width: 60, units: "mm", turn: 30, opacity: 0.4 });

test("the corners of a picture are as far apart as it is wide and high, and turned with it", () => {
    assert.deepEqual(cornersOf({ ...LAID, turn: 0 }, PICTURE), [
        [-20, 5],
        [40, 5],
        [40, 35],
        [-20, 35],
    ]);
    const [[x, y], [x1, y1], , [x3, y3]] = cornersOf(LAID, PICTURE);
    assertNear([Math.hypot(x1 - x, y1 - y), Math.hypot(x3 - x, y3 - y)], [60, 30]);
    assertNear([Math.atan2(y1 - y, x1 - x)], [Math.PI / 6]);
});

test("a corner that is pulled comes to the pointer, and the middle stays", () => {
    for (const turn of [0, 30, 179, -120]) {
        const laid = { ...LAID, turn };
        cornersOf(laid, PICTURE).forEach((from, k) => {
            for (const to of [
                [60, 20],
                [-3, 41],
                [10, -5],
            ]) {
                const found = pulled(laid, from, to);
                assert.deepEqual([found.at, found.opacity], [LAID.at, 0.4]);
                assertNear(cornersOf(found, PICTURE)[k], to, 0.01);
                assert.ok(Math.abs(found.turn) <= 180, found.turn);
            }
        });
    }
});

test("it can be made larger alone, and does not vanish", () => {
    const corner = cornersOf(LAID, PICTURE)[2];
    const twice = corner.map((value, axis) => 2 * value - LAID.at[axis]);
    assert.deepEqual(pulled(LAID, corner, twice, true), { ...LAID, width: 120 });
    assert.equal(pulled(LAID, corner, [60, 20], true).turn, 30);
    assert.ok(pulled(LAID, corner, LAID.at).width > 0);
});

test("it stays where it is when the design gets other units", () => {
    const laid = frozen({ ...LAID, at: [25.4, -50.8], width: 127 });
    const { at, width, ...rest } = inUnits(laid, "in");
    assertNear([...at, width], [1, -2, 5]);
    assert.deepEqual(rest, { units: "in", turn: 30, opacity: 0.4 });
    assert.equal(inUnits(laid, "mm"), laid);
    assert.equal(inUnits(UNLAID, "cm").at, null);
});

test("of what was kept of a place only what makes sense is taken", () => {
    const laid = { at: [1, 2], width: 30, units: "in", turn: 5, opacity: 0.5 };
    assert.deepEqual(laidOf({ ...laid, image: {}, moves: true }), laid);
    for (const junk of [null, 3, {}, { ...laid, at: { a: 1 } }, { ...laid, width: null }, { ...laid, units: "x" }])
        assert.deepEqual(laidOf(junk), {});
});

test("units that there are not leave a place where it is", () => {
    const laid = { ...UNLAID, at: [1, 2], width: 3 };
    assert.equal(inUnits(laid, "furlong"), laid);
});
