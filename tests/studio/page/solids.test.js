/** Solids as the page looks at them, when they are asked for, and designs that come to stand. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { flat, setSolid, setUnits, standing } from "../../../voronoi_tiles/studio/page/model/design.js";
import { Look, pulled, reachOf } from "../../../voronoi_tiles/studio/page/model/solids.js";
import { SolidLink } from "../../../voronoi_tiles/studio/page/solids.js";
import { Store } from "../../../voronoi_tiles/studio/page/store.js";
import { assertNear, frozen } from "./helpers.js";

const DESIGN = frozen({ schema: 1, group: "p4", cell: { a: 60 }, site: [{ strokes: [{ point: [1, 2] }] }] });

test("axes are square to each other whatever one looks from, and right-handed", () => {
    const look = new Look();
    const dot = (p, q) => p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    for (let k = 0; k < 50; k++) {
        look.roll(37 * k, 13 * (k % 9) - 50);
        assert(Math.abs(look.tilt) <= 90);
        const [right, up, toward] = look.axes;
        const cross = [0, 1, 2].map((i) => {
            const [a, b] = [(i + 1) % 3, (i + 2) % 3];
            return right[a] * up[b] - right[b] * up[a];
        });
        assertNear(cross, toward, 1e-12);
        assertNear([dot(right, right), dot(right, up), dot(right, [0, 0, 1])], [1, 0, 0], 1e-12);
    }
});

test("what the pointer is at stays there when it is zoomed", () => {
    const look = new Look();
    Object.assign(look, { scale: 3, pan: [10, -4] });
    const at = /** @type {[number, number]} */ ([33, 21]);
    const place = () => [0, 1].map((axis) => (at[axis] - look.pan[axis]) / look.scale);
    const before = place();
    look.zoomAt(2.5, at);
    assertNear(place(), before, 1e-12);
    assertNear([look.scale], [7.5], 1e-12);
    look.zoomAt(1e-9, at);
    assert(look.scale > 0);
});

test("pieces are pulled away from the middle alone, and level", () => {
    assert.deepEqual(pulled({ middle: [10, -4, 3] }, 0.5), [5, -2, 0]);
    assert.deepEqual(pulled({ middle: [10, -4, 3] }, 0), [0, -0, 0]);
    const piece = { middle: [3, 4, 0], positions: Float32Array.of(3, 4, 0, 0, 0, 2) };
    assert.deepEqual(reachOf([piece], 0), [5, 2]);
    assert.deepEqual(reachOf([piece], 1), [10, 2]);
    assert.deepEqual(reachOf([], 1), [0, 0]);
});

test("a design comes to stand, and lies flat again", () => {
    const stood = standing(DESIGN, 30, [5, 6]);
    assert.deepEqual(stood.solid, { height: 30, turn: 30, about: [5, 6] });
    const higher = setSolid(stood, { height: 50, turn: undefined });
    assert.deepEqual(higher.solid, { height: 50, about: [5, 6] });
    assert.deepEqual(flat({ ...higher, key: [] }), DESIGN);
});

test("in other units what stands keeps its size", () => {
    const key = [{ z: 20, site: "a", strokes: [{ circle: [10, 20], radius: 5 }] }];
    const solid = { height: 30, turn: 30, shift: [10, 5], scale: 2, layers: 9 };
    const inches = setUnits(setUnits({ ...DESIGN, solid, key }, "cm", true), "in", true);
    assertNear(
        [inches.solid.height, ...inches.solid.shift, inches.key[0].z],
        [30, 10, 5, 20].map((x) => x / 25.4),
        1e-9,
    );
    assertNear(
        [...inches.key[0].strokes[0].circle, inches.key[0].strokes[0].radius],
        [10, 20, 5].map((x) => x / 25.4),
        1e-9,
    );
    assert.deepEqual([inches.solid.turn, inches.solid.scale, inches.solid.layers, inches.key[0].site], [30, 2, 9, "a"]);
    assert.deepEqual(setUnits({ ...DESIGN, solid, key }, "cm", false).solid, solid);
});

/** A store at an open design, what is sent for it, and a way to be told. */
function connected() {
    const sent = [];
    const heard = new Map();
    const link = { send: (message) => sent.push(message) > 0, on: (type, tell) => heard.set(type, tell) };
    const store = new Store({
        design: DESIGN,
        revision: 0,
        begun: 0,
        tables: {},
        file: "bird.toml",
        solidJob: {},
        connected: true,
        dragging: false,
        solid: null,
        solidRefusal: null,
        solidPending: false,
    });
    const solids = new SolidLink(store, /** @type {any} */ (link));
    return { store, solids, sent, come: (message) => heard.get(message.type)(message) };
}

test("a solid is asked for once the design rests, and while it is looked at", async (context) => {
    const { timers } = context.mock;
    timers.enable({ apis: ["setTimeout"] });
    Object.assign(globalThis, { window: globalThis });
    const { store, solids, sent, come } = connected();
    const after = async (ms) => {
        await null;
        timers.tick(ms);
        await null;
    };
    const change = () => store.edit((design) => ({ ...design, cell: { a: design.cell.a + 1 } }));

    change();
    await after(1000);
    assert.equal(sent.length, 0);
    solids.ask(true);
    await after(1000);
    assert.deepEqual(
        sent.map(({ type, design }) => [type, design.cell.a]),
        [["solid", 61]],
    );
    assert(store.state.solidPending);
    for (let k = 0; k < 5; k++) {
        change();
        await after(100);
    }
    assert.equal(sent.length, 1);
    await after(1000);
    assert.equal(sent.length, 2);
    assert.equal(sent[1].design.cell.a, 66);

    come({ type: "solid", rev: sent[0].rev, coarse: false });
    assert.equal(store.state.solid, null); // it is of an earlier design
    come({ type: "solid", rev: sent[1].rev, coarse: true });
    assert(store.state.solid.coarse && store.state.solidPending);
    come({ type: "solid", rev: sent[1].rev, coarse: false });
    assert(!store.state.solidPending);

    change();
    await after(10);
    assert(store.state.solidPending);
    store.undo();
    await after(1000);
    assert.equal(sent.length, 2); // it is what there is
    assert(!store.state.solidPending);

    store.preview((design) => ({ ...design }));
    await after(1000);
    assert.equal(sent.length, 2);
    store.cancel();
    store.set({ solidJob: { height: 5 } });
    await after(1000);
    assert.equal(sent.length, 3);
    come({ type: "refused", lane: "solid", rev: sent[2].rev, error: { message: "No.", remedy: "" } });
    assert(store.state.solidRefusal && store.state.solid && !store.state.solidPending);

    store.set({ connected: false });
    await after(0);
    store.set({ connected: true });
    await after(1000);
    assert.equal(sent.length, 4); // what was asked may have been lost
    store.open({ ...DESIGN }, {});
    await after(0);
    assert.equal(store.state.solid, null);
    come({ type: "solid", rev: sent[3].rev, coarse: false });
    assert.equal(store.state.solid, null);
    solids.ask(false);
    change();
    await after(1000);
    assert.equal(sent.length, 4);
});
