/** Strokes on their way from one group to another. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { apply } from "../../../voronoi_tiles/studio/page/model/plane.js";
import { Morph, mixed } from "../../../voronoi_tiles/studio/page/view/morph.js";
import { assertNear, frozen } from "./helpers.js";

const HALF = Math.SQRT1_2;
const motion = (a, b, conj = false) => ({ a, b, conj });
const scene = (group, side, motions, at) => {
    const design = frozen({ schema: 1, group, cell: { a: side }, site: [{ strokes: [{ segment: [at, [9, 9]] }] }] });
    const cubics = Float64Array.of(...at, ...at, 9, 9, 9, 9);
    return { design, lattice: { a: [side, 0], b: [0, side] }, motions, entries: [{ kind: "segment", cubics }] };
};
const P2 = scene("p2", 60, [motion([1, 0], [0, 0]), motion([-1, 0], [60, 60])], [2, 3]);
const P4 = scene(
    "p4",
    40,
    [
        [1, 0],
        [0, 1],
        [-1, 0],
        [0, -1],
    ].map((a) => motion(a, [0, 0])),
    [4, 5],
);
const PM = scene("pm", 60, [motion([1, 0], [0, 0]), motion([-1, 0], [60, 0], true)], [2, 3]);

/** Where the copies of a scene's first point are. */
const places = ({ motions, entries }) => motions.map((one) => apply(one, [...entries[0].cubics.subarray(0, 2)]));

/** Run with what a browser says of motion. */
function asked(matches, run) {
    globalThis.matchMedia = () => ({ matches });
    try {
        run();
    } finally {
        delete globalThis.matchMedia;
    }
}

test("copies begin at copies of the group before and end at those of the new one", () => {
    for (const [from, to] of [
        [P2, P4],
        [P4, P2],
        [P2, PM],
        [PM, P4],
    ]) {
        const before = places(from).map(String);
        for (const place of places(mixed(from, to, 0))) assert.ok(before.includes(String(place)), place);
        assertNear(places(mixed(from, to, 1)).flat(), places(to).flat());
        assert.deepEqual(mixed(from, to, 0).lattice, from.lattice);
        assert.deepEqual(mixed(from, to, 1).lattice, to.lattice);
    }
    const half = mixed(P2, P4, 0.5);
    assert.deepEqual([...half.entries[0].cubics], [3, 4, 3, 4, 9, 9, 9, 9]);
    assertNear(half.motions[2].a, [0, 1], 1e-9, "from the copy of the same number, as often as there are");
    assertNear(half.motions[1].a, [-HALF, HALF], 1e-9, "turned by the shorter way");
});

test("it takes a quarter of a second, and any other edit ends it", () => {
    asked(false, () => {
        const morph = new Morph();
        const at = (what, now) => {
            const { moves, ...seen } = morph.at(what, now);
            return [moves, places(seen)[0]];
        };
        assert.deepEqual(at(P2, 0), [false, [2, 3]]);
        assert.deepEqual(at(P4, 1000), [true, [2, 3]]);
        assert.deepEqual(at(P4, 1125), [true, [3, 4]]);
        assert.deepEqual(at(P4, 1250), [false, [4, 5]]);
        assert.equal(at(P2, 2000)[0], true);
        const edited = { ...P2, design: { ...P2.design, site: [] } };
        assert.deepEqual(at(edited, 2100), [false, [2, 3]]);
        assert.equal(morph.at({ ...P4, entries: [] }, 3000).moves, false, "other strokes do not come from these");
    });
});

test("who asks for less motion sees the new group at once", () => {
    asked(true, () => {
        const morph = new Morph();
        morph.at(P2, 0);
        assert.deepEqual(morph.at(P4, 1000), { ...P4, moves: false });
    });
});
