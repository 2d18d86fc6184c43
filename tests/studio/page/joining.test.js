/** Nodes laid onto others: what is closed, joined and healed, and that the rest stays as it was. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { joinNodes, joinSelected, whyNotJoined } from "../../../voronoi_tiles/studio/page/model/joining.js";
import { nearestOn, pointOn } from "../../../voronoi_tiles/studio/page/model/nearest.js";
import { nodesOf } from "../../../voronoi_tiles/studio/page/model/nodes.js";
import { cubicsOf, kindOf, placementOf } from "../../../voronoi_tiles/studio/page/model/strokes.js";
import { PLACEMENTS, STROKES, assertNear, frozen } from "./helpers.js";

const LINE = [
    [1, 2],
    [7, 5],
    [3, 9],
    [-2, 4],
];
const CURVE = [
    [20, 0],
    [22, 3],
    [25, 4],
    [27, 1],
    [29, -2],
    [32, 0],
    [33, 3],
];
/** Open strokes of every kind that joins others. */
const OPEN = [
    { segment: [LINE[0], LINE[1]] },
    { polyline: LINE },
    { bezier: CURVE },
    {
        hermite: [
            [0, 0],
            [4, 1],
            [9, -3],
        ],
        tangents: [
            [3, 3],
            [1, -4],
            [2, 2],
        ],
    },
    { path: "M 3 4 C 4 8 9 9 9 4 L 12 1" },
];

const designOf = (strokes, site = {}) =>
    frozen({ schema: 1, group: "p1", cell: { a: 60 }, site: [{ strokes: [{ point: [9, 9] }] }, { ...site, strokes }] });
const anchors = (stroke, placement) => nodesOf(stroke, placement).filter(({ role }) => role === "anchor");
const ref = (stroke, node) => ({ site: 1, stroke, node });
const pieces = (stroke, placement) => cubicsOf(stroke, placement).length / 8;

/** Fail where pieces of a curve, of so many, have points that are not on another one. */
function assertOn(cubics, which, other, what) {
    for (const piece of which) {
        for (let k = 0; k <= 4; k++) {
            const at = pointOn(cubics, piece, k / 4);
            assert.ok(nearestOn(other, at).distance <= 1e-9, `${what}: ${at}`);
        }
    }
}

test("an end laid onto that of another stroke makes one of two, whatever they are and wherever they lie", () => {
    for (const drawn of OPEN) {
        const one = { ...drawn, translate: [50, 60] };
        for (const other of OPEN) {
            for (const [site, keys] of PLACEMENTS) {
                const stays = { ...other, ...keys, unknown: 7 };
                const from = placementOf(site, one);
                const onto = placementOf(site, stays);
                for (const [k, m] of [
                    [0, 0],
                    [0, -1],
                    [-1, 0],
                    [-1, -1],
                ]) {
                    const what = JSON.stringify([one, stays, k, m]);
                    const [moving, target] = [anchors(one, from).at(k), anchors(stays, onto).at(m)];
                    const far = { polyline: LINE };
                    const design = designOf([one, far, stays], site);
                    const joined = joinNodes(design, ref(0, moving.node), ref(2, target.node));
                    assert.deepEqual(joined.ref, { site: 1, stroke: 1 }, what);
                    assert.deepEqual(joined.design.site[0], design.site[0]);
                    const [left, made, ...others] = joined.design.site[1].strokes;
                    assert.deepEqual([left, others], [far, []]);
                    assert.equal(made.unknown, 7);
                    const straight = [one, other].every((part) => "segment" in part || "polyline" in part);
                    assert.equal(kindOf(made), straight ? "polyline" : "bezier", what);
                    // All but the piece that ended at the node that was laid, and the other stroke as a whole.
                    const cubics = cubicsOf(made, onto);
                    const [count, rest] = [pieces(stays, onto), pieces(one, from)];
                    assert.equal(pieces(made, onto), count + rest, what);
                    const all = Array.from({ length: rest }, (_, n) => n);
                    assertOn(cubicsOf(stays, onto), Array(count).keys(), cubics, what);
                    assertOn(cubicsOf(one, from), k ? all.slice(0, -1) : all.slice(1), cubics, what);
                    const found = anchors(made, onto).map(({ at }) => at);
                    const ends = [anchors(one, from).at(k ? 0 : -1).at, anchors(stays, onto).at(m ? 0 : -1).at];
                    assertNear((m ? found.reverse() : found)[0], ends[0], 1e-9, what);
                    assertNear(found.at(-1), ends[1], 1e-9, what);
                }
            }
        }
    }
});

test("what stays where it is keeps its digits, and a handle goes along with its end", () => {
    const line = { segment: [LINE[0], [20.3, 0.2]] };
    const design = designOf([{ bezier: CURVE }, line]);
    const { strokes } = joinNodes(design, ref(0, 0), ref(1, 1)).design.site[1];
    const [corner, start] = [line.segment[1], LINE[0]];
    assert.deepEqual(strokes, [{ bezier: [start, start, corner, corner, [22.3, 3.2], ...CURVE.slice(2)] }]);
});

test("strokes that meet at both ends become a closed one", () => {
    const halves = [{ polyline: LINE.slice(0, 3) }, { polyline: [LINE[0], LINE[3], LINE[2]] }];
    const joined = joinNodes(designOf(halves), ref(1, 2), ref(0, 2)).design.site[1].strokes;
    assert.deepEqual(joined, [{ polyline: LINE, closed: true }]);
});

test("an end laid onto the other end of its stroke closes it", () => {
    for (const { stroke, from, onto, made } of [
        { stroke: { polyline: LINE }, from: 3, onto: 0, made: { polyline: LINE.slice(0, 3), closed: true } },
        { stroke: { catmull_rom: LINE }, from: 0, onto: 3, made: { catmull_rom: LINE.slice(1), closed: true } },
        { stroke: { bspline: LINE }, from: 3, onto: 0, made: { bspline: LINE.slice(0, 3), closed: true } },
        {
            stroke: { bezier: CURVE },
            from: 6,
            onto: 0,
            made: { bezier: [...CURVE.slice(0, 5), [19, -3], CURVE[0]] },
        },
        {
            stroke: OPEN[3],
            from: 6,
            onto: 0,
            made: {
                ...OPEN[3],
                hermite: [
                    [0, 0],
                    [4, 1],
                    [0, 0],
                ],
            },
        },
        { stroke: OPEN[4], from: 0, onto: 6, made: { path: "M 12 1 C 13 5 9 9 9 4 L 12 1" } },
    ]) {
        const joined = joinNodes(designOf([stroke]), ref(0, from), ref(0, onto));
        assert.deepEqual(joined.design.site[1].strokes, [made]);
        assert.deepEqual(joined.ref, { site: 1, stroke: 0 });
        assert.deepEqual(joinSelected(joined.design, { strokes: [joined.ref], nodes: [] }), null, "it has no ends");
    }
});

test("a node laid onto its neighbour is taken out", () => {
    for (const [stroke, from, onto, made] of [
        [{ polyline: LINE }, 1, 2, { polyline: [LINE[0], LINE[2], LINE[3]] }],
        [{ polyline: LINE }, 0, 1, { polyline: LINE.slice(1) }],
        [{ polyline: LINE, closed: true }, 3, 0, { polyline: LINE.slice(0, 3), closed: true }],
        [{ catmull_rom: LINE }, 2, 1, { catmull_rom: [LINE[0], LINE[1], LINE[3]] }],
    ]) {
        assert.deepEqual(joinNodes(designOf([stroke]), ref(0, from), ref(0, onto)).design.site[1].strokes, [made]);
    }
    const healed = joinNodes(designOf([{ bezier: CURVE }]), ref(0, 3), ref(0, 6)).design.site[1].strokes[0];
    assert.equal(healed.bezier.length, 4);
    assert.deepEqual([healed.bezier[0], healed.bezier[3]], [CURVE[0], CURVE[6]]);
});

test("what cannot be joined is not", () => {
    const design = designOf([
        { polyline: LINE },
        { polyline: LINE, closed: true },
        { catmull_rom: LINE },
        { circle: [9, 9], radius: 2 },
        { file: "leaf.svg" },
        { segment: [LINE[0], LINE[1]] },
        { polyline: LINE.slice(0, 3) },
        { path: "M 0 0 L 1 1 M 5 5 L 6 7" },
    ]);
    for (const [from, onto] of [
        [ref(0, 0), ref(0, 0)],
        [ref(0, 0), { site: 0, stroke: 0, node: 0 }], // another site
        [ref(0, 0), ref(0, 2)], // neither its neighbour nor its end
        [ref(0, 1), ref(5, 0)], // no end
        [ref(0, 0), ref(6, 1)],
        [ref(0, 0), ref(1, 0)], // closed
        [ref(0, 0), ref(2, 0)], // of a kind that cannot be joined exactly
        [ref(2, 3), ref(0, 0)],
        [ref(0, 0), ref(3, 0)],
        [ref(0, 0), ref(4, 0)],
        [ref(5, 0), ref(5, 1)], // nothing would be left
        [ref(6, 0), ref(6, 2)], // a line there and back
        [ref(0, 0), ref(7, 0)], // two curves in one stroke
        [ref(0, 0), ref(9, 0)], // not there
        [ref(9, 0), ref(0, 0)],
        [ref(5, 1), ref(6, 0)], // the end before is there already
    ]) {
        assert.equal(joinNodes(design, from, onto), null, JSON.stringify([from, onto]));
    }
    for (const stroke of STROKES) {
        const closed = joinSelected(designOf([stroke]), { strokes: [ref(0)], nodes: [] });
        if (closed)
            assert.ok(["polyline", "bezier", "hermite", "path", "catmull_rom", "bspline"].includes(kindOf(stroke)));
    }
});

test("what is selected is joined: two nodes, the ends of a stroke, the nearest ends of two", () => {
    const strokes = [
        { polyline: LINE },
        {
            segment: [
                [8, 30],
                [1, 2.5],
            ],
        },
        {
            segment: [
                [8, 32],
                [40, 40],
            ],
        },
    ];
    const design = designOf(strokes);
    const all = [ref(0), ref(1), ref(2)].map(({ site, stroke }) => ({ site, stroke }));
    const nearest = joinSelected(design, { strokes: all.slice(0, 2), nodes: [] });
    assert.deepEqual(nearest.design.site[1].strokes, [{ polyline: [[8, 30], [1, 2.5], ...LINE] }, strokes[2]]);
    const laid = joinSelected(design, { strokes: all.slice(0, 2), nodes: [] }, 0.6);
    assert.deepEqual(laid.design.site[1].strokes, [{ polyline: [[8, 30], ...LINE] }, strokes[2]], "as good as met");
    const nodes = [ref(0, 3), ref(2, 0)];
    const made = joinSelected(design, { strokes: all, nodes });
    assert.deepEqual(made.design.site[1].strokes, [
        strokes[1],
        { polyline: [[40, 40], [8, 32], ...LINE.toReversed()].toReversed() },
    ]);
    assert.deepEqual(made.ref, { site: 1, stroke: 1 });
    // An end that is selected alone is the one of its stroke, though another one is nearer.
    const chosen = joinSelected(design, { strokes: all.slice(0, 2), nodes: [ref(0, 3)] });
    assert.deepEqual(chosen.design.site[1].strokes[0], { polyline: [...LINE, [1, 2.5], [8, 30]] });
    const inner = joinSelected(design, { strokes: all.slice(0, 2), nodes: [ref(0, 1)] });
    assert.deepEqual(inner, nearest, "no end");
    for (const some of [[], all]) assert.equal(joinSelected(design, { strokes: some, nodes: [] }), null);
    assert.equal(joinSelected(design, { strokes: [all[1]], nodes: [] }), null);
});

test("ends that are apart are joined by a line, and neither stroke changes, whatever they are and wherever they lie", () => {
    for (const drawn of OPEN) {
        const one = { ...drawn, translate: [50, 60] };
        for (const other of OPEN) {
            for (const [site, keys] of PLACEMENTS) {
                const stays = { ...other, ...keys };
                const [from, onto] = [placementOf(site, one), placementOf(site, stays)];
                const design = designOf([one, stays], site);
                for (const k of [0, -1]) {
                    for (const m of [0, -1]) {
                        const what = JSON.stringify([one, stays, k, m]);
                        const ends = [anchors(one, from).at(k), anchors(stays, onto).at(m)];
                        const nodes = [ref(0, ends[0].node), ref(1, ends[1].node)];
                        const { strokes } = joinSelected(design, { strokes: [], nodes }).design.site[1];
                        assert.equal(strokes.length, 1, what);
                        const made = cubicsOf(strokes[0], placementOf(site, strokes[0]));
                        const [before, after] = [cubicsOf(one, from), cubicsOf(stays, onto)];
                        const count = (before.length + after.length) / 8;
                        assert.equal(made.length / 8, count + 1, what);
                        assertOn(before, [...Array(before.length / 8).keys()], made, what);
                        assertOn(after, [...Array(after.length / 8).keys()], made, what);
                        const line = [...ends[0].at, ...ends[0].at, ...ends[1].at, ...ends[1].at];
                        assertOn(line, [0], made, what);
                    }
                }
            }
        }
    }
});

test("a line there and back joins nothing", () => {
    const design = designOf([{ segment: [LINE[0], LINE[1]] }, { segment: [LINE[1], LINE[2]] }]);
    for (const nodes of [
        [ref(0, 0), ref(1, 0)],
        [ref(1, 1), ref(0, 1)],
    ])
        assert.equal(joinSelected(design, { strokes: [], nodes }), null);
});

test("a stroke is closed by a piece from its end to its start, and none of its points is lost", () => {
    const two = { hermite: OPEN[3].hermite.slice(0, 2), tangents: OPEN[3].tangents.slice(0, 2) };
    for (const [stroke, made] of [
        [{ polyline: LINE.slice(0, 3) }, { polyline: LINE.slice(0, 3), closed: true }],
        [
            { catmull_rom: LINE, alpha: 0.5 },
            { catmull_rom: LINE, alpha: 0.5, closed: true },
        ],
        [{ bspline: LINE }, { bspline: LINE, closed: true }],
        [{ bezier: CURVE }, { bezier: [...CURVE, CURVE[6], CURVE[0], CURVE[0]] }],
        [OPEN[4], { path: `${OPEN[4].path} L 3 4` }],
        // As the pen does at a click on the first point.
        [two, { hermite: [...two.hermite, two.hermite[0]], tangents: [...two.tangents, two.tangents[0]] }],
        [{ segment: LINE.slice(0, 2) }, null],
        [{ polyline: LINE.slice(0, 2) }, null],
        [{ bezier: [LINE[0], LINE[0], LINE[1], LINE[1]] }, null],
    ]) {
        const design = designOf([stroke]);
        const ends = anchors(stroke).map(({ node }) => ref(0, node));
        const before = JSON.stringify(design);
        for (const nodes of [[], [ends[0], ends.at(-1)], [ends.at(-1), ends[0]], [ends[0]]]) {
            const joined = joinSelected(design, { strokes: [{ site: 1, stroke: 0 }], nodes });
            assert.deepEqual(joined && joined.design.site[1].strokes, made && [made], JSON.stringify([stroke, nodes]));
        }
        assert.equal(JSON.stringify(design), before);
    }
});

test("ends that meet become one where a stroke is closed", () => {
    const nearly = { polyline: [...LINE, [1.2, 2.1]] };
    const selection = { strokes: [{ site: 1, stroke: 0 }], nodes: [] };
    const closed = (reach) => joinSelected(designOf([nearly]), selection, reach).design.site[1].strokes[0];
    assert.deepEqual(closed(0.5), { polyline: LINE, closed: true });
    assert.deepEqual(closed(0.1), { ...nearly, closed: true });
    const there = designOf([{ polyline: [...LINE, LINE[0]] }]);
    assert.deepEqual(joinSelected(there, selection).design.site[1].strokes, [{ polyline: LINE, closed: true }]);
    // Enlarged by its place, the ends are farther apart than they are written.
    const large = designOf([{ ...nearly, scale: 10 }]);
    assert.deepEqual(joinSelected(large, selection, 0.5).design.site[1].strokes, [
        { ...nearly, scale: 10, closed: true },
    ]);
});

test("why nothing is joined is said of what is selected", () => {
    const design = designOf([{ polyline: LINE }, { catmull_rom: LINE }, { segment: [LINE[0], LINE[1]] }]);
    const why = (...strokes) => whyNotJoined(design, { strokes, nodes: [] });
    assert.match(why(ref(0), ref(1)), /^Curves through points, .* join no others/);
    assert.match(why(ref(0), { site: 0, stroke: 0 }), /^These strokes are of two sites/);
    for (const some of [[], [ref(2)], [ref(0), ref(1), ref(2)]]) assert.match(why(...some), /^Select an open stroke/);
});
