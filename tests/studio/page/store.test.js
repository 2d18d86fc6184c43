/** Who is told of changes, and when. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { NOTHING, Store } from "../../../voronoi_tiles/studio/page/store.js";

const DESIGN = { schema: 1, group: "p4", cell: { a: 60 }, site: [{ strokes: [{ point: [1, 2] }] }] };

/**
 * What lets time pass in a test: what runs meanwhile has run.
 * @param {import("node:test").TestContext} context
 */
function clock({ mock: { timers } }) {
    timers.enable({ apis: ["setTimeout"] });
    return async (ms = 0) => {
        await null;
        timers.tick(ms);
        await null;
    };
}

/** A store, and what its listeners were told: each revision that they saw. */
function watched() {
    const store = new Store({ design: DESIGN, revision: 0, selection: NOTHING, dragging: false });
    const told = { quick: [], calm: [] };
    store.subscribe(["design"], ({ design }) => told.quick.push(design.cell.a));
    store.subscribe(["design"], ({ design }) => told.calm.push(design.cell.a), { calm: true });
    return { store, told };
}

/** @param {number} a */
const wide = (a) => (design) => ({ ...design, cell: { a } });

test("while something is dragged calm listeners are told of the newest a few times a second", async (context) => {
    const later = clock(context);
    const { store, told } = watched();
    for (let a = 61; a <= 70; a++) {
        store.preview(wide(a));
        await later(10);
    }
    assert.deepEqual(told.quick, [60, 61, 62, 63, 64, 65, 66, 67, 68, 69, 70]);
    assert.deepEqual(told.calm, [60]);
    await later(200);
    assert.deepEqual(told.calm, [60, 70]);
});

test("calm listeners are told at once of what is no drag, and of a drag's end", async (context) => {
    const later = clock(context);
    const { store, told } = watched();
    store.edit(wide(61));
    await later();
    store.preview(wide(62));
    await later();
    store.edit(wide(63));
    await later();
    assert.deepEqual(told.calm, [60, 61, 63]);
    store.preview(wide(64));
    await later();
    store.cancel();
    await later();
    assert.deepEqual(told.calm, [60, 61, 63, 63]);
    await later(200);
    assert.deepEqual(told.calm, [60, 61, 63, 63]);
});
