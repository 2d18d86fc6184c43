/** What is under the pointer, and what the pointer is drawn to. */

import assert from "node:assert/strict";
import { test } from "node:test";

import {
    nearestCopy,
    nearestNode,
    nearestStroke,
    nodesIn,
    strokesIn,
} from "../../../voronoi_tiles/studio/page/model/hit.js";
import { nodesOf } from "../../../voronoi_tiles/studio/page/model/nodes.js";
import { rounded, snap } from "../../../voronoi_tiles/studio/page/model/snapping.js";
import { cubicsOf } from "../../../voronoi_tiles/studio/page/model/strokes.js";
import { assertNear } from "./helpers.js";

const strokes = [
    {
        bezier: [
            [0, 0],
            [2, 3],
            [5, 4],
            [7, 1],
        ],
    },
    {
        polyline: [
            [0, 0],
            [10, 0],
            [10, 10],
        ],
    },
    { point: [20, 20] },
    { path: "" },
];
const entries = strokes.map((stroke, k) => ({ ref: { site: 0, stroke: k }, cubics: cubicsOf(stroke) }));
const nodes = strokes.flatMap((stroke, k) => nodesOf(stroke).map((node) => ({ ...node, ref: { site: 0, stroke: k } })));

test("the nearest stroke is found, with its piece, and of two at one place the upper one", () => {
    const hit = nearestStroke(entries, [10.2, 5], 0.5);
    assert.deepEqual([hit.ref.stroke, hit.piece], [1, 1]);
    assertNear([...hit.at, hit.distance], [10, 5, 0.2], 1e-6);
    assert.equal(nearestStroke(entries, [10.2, 5], 0.1), null);
    assert.equal(nearestStroke(entries, [20.1, 20], 0.5).ref.stroke, 2);
    const twice = [entries[1], { ...entries[1], ref: { site: 1, stroke: 0 } }];
    assert.deepEqual(nearestStroke(twice, [5, 0.1], 1).ref, { site: 1, stroke: 0 });
});

test("a copy leads to its stroke, and to the motion that makes it", () => {
    const mirror = { a: [-1, 0], b: [0, 0], conj: true };
    const quarter = { a: [0, 1], b: [0, 0], conj: false };
    const motions = [{ a: [1, 0], b: [0, 0], conj: false }, mirror, quarter];
    const lattice = { a: [60, 0], b: [0, 60] };
    const own = nearestCopy(entries, motions, lattice, [10.2, 5], 0.5);
    assert.deepEqual([own.ref.stroke, own.motion], [1, 0]);
    for (const [i, j] of [
        [0, 0],
        [3, -2],
        [-1, 4],
    ]) {
        const at = [-10.2 + 60 * i, 5 + 60 * j];
        const hit = nearestCopy(entries, motions, lattice, at, 0.5);
        assert.deepEqual([hit.ref.stroke, hit.piece, hit.motion], [1, 1, 1]);
        assertNear([...hit.at, hit.distance], [10, 5, 0.2], 1e-6);
        assert.equal(nearestCopy(entries, motions, lattice, at, 0.1), null);
    }
    const turned = nearestCopy(entries, motions, lattice, [115, 10.2], 0.5);
    assert.deepEqual([turned.ref.stroke, turned.piece, turned.motion], [1, 1, 2]);
    assert.equal(nearestCopy([], motions, lattice, [0, 0], 1), null);
});

test("the nearest node is found, of two at one place the upper one, and handles above anchors", () => {
    assert.deepEqual(nearestNode(nodes, [2.1, 3.1], 0.5).role, "out");
    assert.equal(nearestNode(nodes, [2.1, 3.1], 0.1), null);
    assert.deepEqual(nearestNode(nodes, [0, 0], 1).ref.stroke, 1);
    const [anchor, handle] = [
        { ...nodes[0], at: [1, 1] },
        { ...nodes[1], at: [1, 1] },
    ];
    assert.equal(nearestNode([handle, anchor], [1, 1.1], 1), handle);
    assert.equal(nearestNode([anchor, handle], [1, 1.1], 1), handle);
});

test("a box holds the strokes and nodes that are inside", () => {
    assert.deepEqual(
        strokesIn(entries, [-1, -1, 11, 11]).map(({ stroke }) => stroke),
        [0, 1],
    );
    assert.deepEqual(
        strokesIn(entries, [0, 0, 7, 4]).map(({ stroke }) => stroke),
        [0],
    );
    assert.deepEqual(nodesIn(nodes, [9, -1, 21, 21]), [
        { site: 0, stroke: 1, node: 1 },
        { site: 0, stroke: 1, node: 2 },
        { site: 0, stroke: 2, node: 0 },
    ]);
});

const elements = {
    centres: [{ at: [30, 30], order: 4 }],
    mirrors: [
        [
            [15, -50],
            [15, 50],
        ],
        [
            [-50, 7],
            [50, 7],
        ],
    ],
    glides: [
        [
            [0, 20],
            [10, 30],
        ],
    ],
};

test("points come before lines, where lines cross before one of them, and the grid last", () => {
    const to = { elements, nodes: [[30.5, 30]], grid: 5, reach: 1 };
    assert.deepEqual(snap([30.1, 30], to), { at: [30, 30], kind: "centre", label: "centre of quarter turns" });
    assert.deepEqual(snap([30.4, 30], to), { at: [30.5, 30], kind: "node", label: "point" });
    assert.deepEqual(snap([0.2, 0.3], to), { at: [0, 0], kind: "origin", label: "origin" });
    assert.deepEqual(snap([15.5, 7.5], to), { at: [15, 7], kind: "mirror", label: "mirrors" });
    assert.deepEqual(snap([15.5, 20.2], to), { at: [15, 20.2], kind: "mirror", label: "mirror" });
    const glide = snap([5.5, 24.5], { ...to, grid: null });
    assert.deepEqual(glide.at, [5, 25]);
    assert.equal(glide.kind, "glide");
    assert.deepEqual(snap([40.4, 40.4], to), { at: [40, 40], kind: "grid", label: "grid" });
    assert.equal(snap([42.5, 42.5], to), null);
    assert.equal(snap([40.4, 40.4], { ...to, grid: null }), null);
    assert.equal(snap([3, 3], { reach: 1 }), null);
});

test("points of the grid, and what a hand draws, are written short", () => {
    assert.deepEqual(snap([0.31, 0.69], { grid: 0.1, reach: 0.1 }).at, [0.3, 0.7]);
    assert.deepEqual(rounded([12.3456789, -0.0049], 0.02), [12.35, 0]);
    assert.deepEqual(rounded([12345.678, 7], 30), [12350, 10]);
});
