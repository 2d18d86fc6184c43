/** Nodes of strokes: where they are, and what becomes of a stroke whose nodes move, come and go. */

import assert from "node:assert/strict";
import { test } from "node:test";

import {
    asBezier,
    deleteNodes,
    insertNode,
    moveNodes,
    nearestOn,
    nodesOf,
    penStroke,
    pullHandles,
    toggleSmooth,
} from "../../../voronoi_tiles/studio/page/model/nodes.js";
import { pointOn } from "../../../voronoi_tiles/studio/page/model/nearest.js";
import { cubicsOf, kindOf, placementOf } from "../../../voronoi_tiles/studio/page/model/strokes.js";
import { PLACEMENTS, STROKES, assertNear, frozen, random } from "./helpers.js";

const cases = STROKES.flatMap((drawn) =>
    PLACEMENTS.map(([site, keys]) => {
        const stroke = frozen({ ...drawn, ...keys, unknown: 7 });
        return { stroke, placement: placementOf(site, stroke), what: JSON.stringify([site, stroke]) };
    }),
);

const at = (nodes, number) => nodes.find(({ node }) => node === number)?.at;

/** Points all along a curve. */
function samples(cubics, count = 12) {
    return Array.from({ length: (cubics.length / 8) * count + 1 }, (_, k) =>
        pointOn(
            cubics,
            Math.min(Math.floor(k / count), cubics.length / 8 - 1),
            k === (cubics.length / 8) * count ? 1 : (k % count) / count,
        ),
    );
}

/** Fail where a curve has a point that is not on another one. */
function assertOn(cubics, other, what, near = 1e-9) {
    for (const point of samples(cubics)) assert.ok(nearestOn(other, point).distance <= near, `${what}: ${point}`);
}

test("anchors lie on their curves, and are numbered as the points are listed", () => {
    for (const { stroke, placement, what } of cases) {
        const nodes = nodesOf(stroke, placement);
        assert.equal(new Set(nodes.map(({ node }) => node)).size, nodes.length, what);
        for (const { node, role, at: place, of } of nodes) {
            if (role === "anchor" && kindOf(stroke) !== "bspline") {
                assert.ok(nearestOn(cubicsOf(stroke, placement), place).distance < 1e-9, what);
                assert.equal(of, node);
            } else if (role !== "anchor")
                assert.ok(["anchor", "centre"].includes(nodes.find((other) => other.node === of).role));
        }
    }
    const roles = (k) =>
        nodesOf(STROKES[k])
            .map(({ node, role, of, smooth }) => `${node}${role[0]}${of}${smooth ? "~" : ""}`)
            .join(" ");
    assert.equal(roles(4), "0a0 1o0 2i3~ 3a3~ 4o3~ 5i6 6a6");
    assert.equal(roles(5), "0a0~ 1o0~ 2i3~ 3a3~ 4o3~ 5i0~");
    assert.equal(roles(6), "0a0 1o0 2i3~ 3a3~ 4o3~ 5i6 6a6");
    assert.equal(roles(12), "0c0~ 1r0~");
    assert.deepEqual(nodesOf({ file: "leaf.svg" }), []);
});

test("a node that is moved is where it was moved to, and nothing but its handles goes along", () => {
    for (const { stroke, placement, what } of cases) {
        const nodes = nodesOf(stroke, placement);
        for (const { node, role, at: from } of nodes) {
            const to = [from[0] + 0.7, from[1] - 0.45];
            const moved = moveNodes(stroke, placement, [{ node, to }], {});
            const after = nodesOf(moved, placement);
            assert.equal(moved.unknown, 7);
            assert.equal(kindOf(moved), kindOf(stroke));
            if (role === "radius") {
                assertNear(at(after, 0), at(nodes, 0), 1e-9, what);
                const size = Math.hypot(to[0] - at(nodes, 0)[0], to[1] - at(nodes, 0)[1]);
                assertNear(at(after, 1), [at(nodes, 0)[0] + size, at(nodes, 0)[1]], 1e-9, what);
                continue;
            }
            assertNear(at(after, node), to, 1e-9, `${what} node ${node}`);
            for (const other of nodes.filter((one) => one.node !== node)) {
                const goesAlong = other.of === node;
                const turns =
                    other.role !== "anchor" &&
                    role !== "anchor" &&
                    other.of === nodes.find((one) => one.node === node).of;
                const expected = goesAlong ? [other.at[0] + 0.7, other.at[1] - 0.45] : other.at;
                if (!turns) assertNear(at(after, other.node), expected, 1e-9, `${what} node ${node}, ${other.node}`);
            }
        }
    }
});

test("all nodes together move the curve as it is", () => {
    for (const { stroke, placement, what } of cases) {
        const moves = nodesOf(stroke, placement).map(({ node, at: [x, y] }) => ({ node, to: [x + 3, y - 2] }));
        const moved = cubicsOf(moveNodes(stroke, placement, moves, {}), placement);
        assertNear(
            [...moved],
            [...cubicsOf(stroke, placement)].map((value, k) => value + (k % 2 ? -2 : 3)),
            1e-9,
            what,
        );
    }
});

test("numbers that do not change are written as before, and those that do without dust", () => {
    const stroke = frozen({
        bezier: [
            [0.1, 0.7],
            [1.1, 2],
            [3.3, 4.4],
            [5.000001, 6],
        ],
    });
    assert.deepEqual(moveNodes(stroke, placementOf({}, {}), [{ node: 0, to: [0.1 + 0.2, 0.7] }], {}), {
        bezier: [
            [0.3, 0.7],
            [1.3, 2],
            [3.3, 4.4],
            [5.000001, 6],
        ],
    });
    const hermite = frozen({
        hermite: [
            [0.1, 0.7],
            [1.1, 2],
        ],
        tangents: [
            [1.1, 2.3],
            [0.7, 0.1],
        ],
    });
    assert.deepEqual(moveNodes(hermite, placementOf({}, {}), [{ node: 3, to: [1.4, 2] }], {}), {
        hermite: [
            [0.1, 0.7],
            [1.4, 2],
        ],
        tangents: [
            [1.1, 2.3],
            [0.7, 0.1],
        ],
    });
});

test("a handle of a smooth anchor turns the opposite one, which keeps its length; alone it does not", () => {
    const stroke = STROKES[4];
    const turned = moveNodes(stroke, placementOf({}, {}), [{ node: 2, to: [7, 4] }], {});
    assertNear(turned.bezier[4], [7, 1 - Math.hypot(2, 3)]);
    assert.deepEqual(
        moveNodes(stroke, placementOf({}, {}), [{ node: 2, to: [7, 4] }], { alone: true }).bezier[4],
        [9, -2],
    );
    const corner = moveNodes(stroke, placementOf({}, {}), [{ node: 2, to: [7, 4] }], { alone: true });
    assert.deepEqual(moveNodes(corner, placementOf({}, {}), [{ node: 4, to: [9, 9] }], {}).bezier[2], [7, 4]);
    // Two handles on one side are a cusp.
    const cusp = frozen({
        bezier: [
            [0, 0],
            [1, 1],
            [4, 4],
            [5, 0],
            [4, 4],
            [8, 1],
            [9, 0],
        ],
    });
    assert.equal(nodesOf(cusp).find(({ node }) => node === 3).smooth, false);
    assert.deepEqual(moveNodes(cusp, placementOf({}, {}), [{ node: 2, to: [3, 3] }], {}).bezier[4], [4, 4]);
    // Round the seam of a closed chain.
    assertNear(moveNodes(STROKES[5], placementOf({}, {}), [{ node: 1, to: [0, 5] }], {}).bezier[5], [
        0,
        -Math.hypot(2, 3),
    ]);
});

test("hermite strokes have one tangent a point until a handle is moved alone", () => {
    for (const stroke of [STROKES[6], STROKES[7]]) {
        const placement = placementOf({ rotate: 30 }, {});
        const out = nodesOf(stroke, placement).find(({ node }) => node === 4);
        const to = [out.at[0] + 1, out.at[1] + 2];
        const both = nodesOf(moveNodes(stroke, placement, [{ node: 4, to }], {}), placement);
        const anchor = at(both, 3);
        assertNear(at(both, 2), [2 * anchor[0] - to[0], 2 * anchor[1] - to[1]]);
        const broken = moveNodes(stroke, placement, [{ node: 4, to }], { alone: true });
        assert.equal(kindOf(broken), "bezier");
        assert.equal(broken.tangents, undefined);
        const nodes = nodesOf(broken, placement);
        assertNear(at(nodes, 4), to);
        assertNear(at(nodes, 2), at(nodesOf(stroke, placement), 2));
    }
});

test("closed curves stay closed", () => {
    const placement = placementOf({}, {});
    for (const stroke of [STROKES[5], STROKES[7]]) {
        for (const node of [0, 1, 3]) {
            const moved = moveNodes(stroke, placement, [{ node, to: [-1, -1] }], {});
            const points = moved.bezier ?? moved.hermite;
            assert.deepEqual(points[0], points.at(-1));
            if (moved.tangents) assert.deepEqual(moved.tangents[0], moved.tangents.at(-1));
        }
    }
    const seam = frozen({
        ...STROKES[7],
        tangents: [
            [3, -6],
            [1, 4],
            [-5, 1],
            [2, 2],
        ],
    });
    const moved = moveNodes(seam, placement, [{ node: 1, to: [2, 2] }], {});
    assertNear(at(nodesOf(moved), 1), [2, 2]);
    assertNear(at(nodesOf(moved), 8), at(nodesOf(seam), 8));
});

test("a node put in keeps the shape of lines and Bezier curves, and lies on all others", () => {
    for (const stroke of STROKES) {
        const cubics = cubicsOf(stroke);
        for (let piece = 0; piece < cubics.length / 8; piece++) {
            const place = pointOn(cubics, piece, 0.3);
            const more = insertNode(stroke, piece, 0.3);
            if (["point", "circle"].includes(kindOf(stroke))) {
                assert.equal(more, stroke);
                continue;
            }
            const what = `${JSON.stringify(stroke)} piece ${piece}`;
            assert.ok(
                nodesOf(more).some((node) => Math.hypot(node.at[0] - place[0], node.at[1] - place[1]) < 1e-9),
                what,
            );
            if (["catmull_rom", "bspline"].includes(kindOf(stroke))) {
                assert.equal(nodesOf(more).length, nodesOf(stroke).length + 1);
                const order = nodesOf(more)
                    .map((node) => nearestOn(cubics, node.at))
                    .map((near) => near.piece + near.t);
                if (!stroke.closed)
                    assert.deepEqual(
                        order,
                        [...order].sort((p, q) => p - q),
                        what,
                    );
            } else {
                assertOn(cubicsOf(more), cubics, what);
                assertOn(cubics, cubicsOf(more), what);
            }
        }
    }
});

test("a node that is put in and taken out leaves the curve as it was", () => {
    for (const stroke of [STROKES[2], STROKES[3], STROKES[4], STROKES[5]]) {
        for (const t of [0.2, 0.5, 0.8]) {
            const more = insertNode(stroke, 1, t);
            const node = kindOf(stroke) === "polyline" ? 2 : 6;
            const [back, ...others] = deleteNodes(more, [node], {});
            assert.equal(others.length, 0);
            assertNear([...cubicsOf(back)], [...cubicsOf(stroke)], 1e-9, JSON.stringify(stroke));
        }
    }
});

test("deleting heals: the other nodes stay", () => {
    for (const stroke of STROKES) {
        const anchors = nodesOf(stroke).filter(({ role }) => role === "anchor");
        if (anchors.length < 3) continue;
        for (const gone of anchors) {
            const left = deleteNodes(stroke, [gone.node], {});
            assert.equal(left.length, 1, JSON.stringify(stroke));
            const found = left.flatMap((one) => nodesOf(one)).filter(({ role }) => role === "anchor");
            const stays = anchors.filter((node) => node !== gone);
            const key = (node) => node.at.map((value) => value.toFixed(9)).join();
            assert.deepEqual(
                new Set(found.map(key)),
                new Set(stays.map(key)),
                `${JSON.stringify(stroke)} ${gone.node}`,
            );
        }
    }
});

test("deleting all or too many nodes leaves what can be drawn", () => {
    for (const stroke of STROKES) {
        const all = nodesOf(stroke).map(({ node }) => node);
        assert.deepEqual(deleteNodes(stroke, all, {}), [], JSON.stringify(stroke));
        assert.deepEqual(deleteNodes(stroke, all, { cut: true }), [], JSON.stringify(stroke));
        assert.deepEqual(deleteNodes(stroke, [], {}).length, 1);
    }
    assert.deepEqual(
        deleteNodes(
            {
                bspline: [
                    [0, 0],
                    [1, 2],
                    [3, 1],
                    [4, 4],
                ],
            },
            [1],
            {},
        ),
        [
            {
                polyline: [
                    [0, 0],
                    [3, 1],
                    [4, 4],
                ],
            },
        ],
    );
    assert.deepEqual(deleteNodes(STROKES[3], [1], {}), [
        {
            polyline: [
                [1, 2],
                [3, 9],
            ],
        },
    ]);
    assert.deepEqual(deleteNodes(STROKES[1], [1], {}), []);
    assert.deepEqual(deleteNodes(STROKES[12], [1], {}), [STROKES[12]]);
    assert.deepEqual(deleteNodes({ file: "leaf.svg" }, [0], {}), [{ file: "leaf.svg" }]);
});

test("cutting takes the pieces at a node as well", () => {
    assert.deepEqual(
        deleteNodes(
            {
                polyline: [
                    [0, 0],
                    [1, 0],
                    [2, 0],
                    [3, 0],
                    [4, 0],
                ],
                rotate: 5,
            },
            [2],
            { cut: true },
        ),
        [
            {
                polyline: [
                    [0, 0],
                    [1, 0],
                ],
                rotate: 5,
            },
            {
                polyline: [
                    [3, 0],
                    [4, 0],
                ],
                rotate: 5,
            },
        ],
    );
    assert.deepEqual(deleteNodes(STROKES[3], [1], { cut: true }), [
        {
            polyline: [
                [3, 9],
                [1, 2],
            ],
        },
    ]);
    assert.deepEqual(deleteNodes(STROKES[4], [0], { cut: true }), [{ bezier: STROKES[4].bezier.slice(3) }]);
    assert.deepEqual(deleteNodes(STROKES[5], [0], { cut: true }), []);
    const ring = {
        bezier: [
            [0, 0],
            [1, 1],
            [2, 1],
            [3, 0],
            [4, 0],
            [4, 1],
            [4, 2],
            [3, 3],
            [1, 3],
            [0, 0],
        ],
    };
    assert.deepEqual(deleteNodes(ring, [6], { cut: true }), [{ bezier: ring.bezier.slice(0, 4) }]);
    assert.deepEqual(deleteNodes(ring, [0], { cut: true }), [{ bezier: ring.bezier.slice(3, 7) }]);
    const runs = deleteNodes({ path: "M0 0L1 0L2 0L3 0L4 0M9 9L8 8" }, [6], { cut: true });
    assert.deepEqual(runs, [{ path: "M 0 0 L 1 0 M 3 0 L 4 0 M 9 9 L 8 8" }]);
});

test("a handle that is deleted goes back into its anchor", () => {
    assert.deepEqual(deleteNodes(STROKES[4], [2], {})[0].bezier[2], [7, 1]);
    assert.deepEqual(
        nodesOf(deleteNodes(STROKES[6], [4], {})[0]).map(({ node }) => node),
        [0, 1, 2, 3, 5, 6],
    );
});

test("a smooth anchor becomes a corner, and a corner smooth", () => {
    const corner = toggleSmooth(STROKES[4], 3);
    assert.deepEqual(corner.bezier.slice(2, 5), [
        [7, 1],
        [7, 1],
        [7, 1],
    ]);
    assert.equal(nodesOf(toggleSmooth(corner, 3)).find(({ node }) => node === 3).smooth, true);
    const hermite = toggleSmooth(STROKES[6], 3);
    assert.deepEqual(hermite.tangents, [
        [3, 6],
        [0, 0],
        [0.3, 6],
    ]);
    const again = toggleSmooth(hermite, 3);
    assert.equal(kindOf(again), "hermite");
    assert.ok(nodesOf(again).find(({ node }) => node === 3).smooth);
    const line = toggleSmooth(
        {
            polyline: [
                [0, 0],
                [3, 3],
                [6, 0],
            ],
            rotate: 9,
        },
        1,
    );
    assertNear(line.bezier.flat(), [0, 0, 0, 0, 3 - Math.SQRT2, 3, 3, 3, 3 + Math.SQRT2, 3, 6, 0, 6, 0]);
    assert.equal(line.rotate, 9);
    const straight = {
        polyline: [
            [0, 0],
            [3, 0],
            [0, 0],
        ],
    };
    assert.ok(nodesOf(toggleSmooth(straight, 1)).find(({ node }) => node === 3).smooth);
    assert.deepEqual(toggleSmooth(STROKES[8], 1), STROKES[8]);
    const path = toggleSmooth(STROKES[13], 3);
    assert.ok(nodesOf(path).find(({ node }) => node === 3).smooth);
    assert.equal(kindOf(path), "path");
});

test("handles are pulled out of anchors to both sides", () => {
    for (const [k, node] of [
        [1, 0],
        [1, 1],
        [2, 1],
        [3, 0],
        [4, 3],
        [4, 6],
        [5, 0],
        [6, 3],
        [6, 6],
        [7, 0],
        [13, 0],
    ]) {
        for (const [site, keys] of PLACEMENTS) {
            const stroke = frozen({ ...STROKES[k], ...keys });
            const placement = placementOf(site, stroke);
            const anchor = at(nodesOf(stroke, placement), node);
            const to = [anchor[0] + 1, anchor[1] + 2];
            const pulled = pullHandles(stroke, placement, node, to);
            const nodes = nodesOf(pulled, placement);
            const places = nodes.filter(({ role }) => role === "in" || role === "out").map((one) => one.at);
            const has = (place) => places.some((one) => Math.hypot(one[0] - place[0], one[1] - place[1]) < 1e-9);
            assert.ok(has(to), JSON.stringify(stroke));
            const isEnd = [
                [1, 0],
                [1, 1],
                [4, 6],
                [6, 6],
            ].some(([one, other]) => one === k && other === node);
            assert.equal(has([anchor[0] - 1, anchor[1] - 2]), !isEnd, JSON.stringify([stroke, node]));
        }
    }
});

test("the pen draws hermite while handles are even, then bezier, of one shape", () => {
    const even = [
        { at: [0, 0], in: [0, 0], out: [1, 2] },
        { at: [5, 1], in: [-1, 1], out: [1, -1] },
        { at: [9, 0], in: [0, 0], out: [0, 0] },
    ];
    const broken = even.map((point, k) => (k === 1 ? { ...point, in: [-1, 2] } : point));
    for (const [site] of PLACEMENTS) {
        const placement = placementOf(site, {});
        for (const [points, kind] of [
            [even, "hermite"],
            [broken, "bezier"],
        ]) {
            const stroke = penStroke(points, placement);
            assert.equal(kindOf(stroke), kind);
            const expected = [
                0,
                0,
                1,
                2,
                ...[0, 1].map((k) => points[1].at[k] + points[1].in[k]),
                5,
                1,
                5,
                1,
                6,
                0,
                9,
                0,
                9,
                0,
            ];
            assertNear([...cubicsOf(stroke, placement)], expected);
        }
    }
    const closed = penStroke([even[0], even[1], { ...even[0], in: [-1, -2] }], placementOf({}, {}));
    assert.deepEqual(closed.hermite[0], closed.hermite[2]);
    assert.equal(penStroke([even[0], even[1], even[0]], placementOf({}, {})).bezier.length, 7);
});

test("any stroke is Bezier chains of the same shape", () => {
    for (const { stroke, placement, what } of cases) {
        const chains = asBezier(stroke);
        // A circle's own pieces are not turned, and have to be compared before it is placed.
        const by = kindOf(stroke) === "circle" ? undefined : placement;
        assertNear(
            chains.flatMap((chain) => [...cubicsOf(chain, by)]),
            [...cubicsOf(stroke, by)],
            1e-9,
            what,
        );
        assert.ok(chains.every((chain) => chain.unknown === 7 && kindOf(chain) === "bezier"));
    }
});

test("the nearest point of a curve is nearer than all that are sampled", () => {
    const chance = random(7);
    for (let k = 0; k < 300; k++) {
        const cubics = Float64Array.from({ length: 24 }, () => 10 * chance());
        const place = [12 * chance() - 1, 12 * chance() - 1];
        const found = nearestOn(cubics, place);
        assert.ok(Math.abs(Math.hypot(found.at[0] - place[0], found.at[1] - place[1]) - found.distance) < 1e-12);
        assertNear(pointOn(cubics, found.piece, found.t), found.at, 1e-12);
        const least = Math.min(...samples(cubics, 400).map(([x, y]) => Math.hypot(x - place[0], y - place[1])));
        assert.ok(found.distance <= least + 1e-9, `${found.distance} ${least}`);
        assert.equal(nearestOn(cubics, place, found.distance * 0.999), null);
    }
    assert.equal(nearestOn(new Float64Array(0), [0, 0]), null);
});

/** The digits behind the point that a number is written with. */
const digits = (value) => (String(value).split(".")[1] ?? "").length;

test("what the pen and pulled handles make is written as short as what they are made of", () => {
    const own = placementOf({}, {});
    for (let k = 1; k < 200; k++) {
        const [x, y] = [(7 * k + 1) / 10, (3 * k - 50) / 10];
        const points = [
            { at: [5.3, 0.1], in: [-x, -y], out: [x, y] },
            { at: [y, x], in: [-0.7, -x], out: [0.7, x] },
            { at: [30.7, 8.9], in: [-y, 0.3], out: [y, -0.3] },
        ];
        const drawn = penStroke(points, own);
        const broken = penStroke([points[0], { ...points[1], in: [x, 0.9] }, points[2]], own);
        const to = [(7 * k + 4) / 10, y];
        const pulled = pullHandles(drawn, own, 3, to);
        const corner = pullHandles({ polyline: points.map(({ at: place }) => place) }, own, 1, [x, y]);
        for (const stroke of [drawn, broken, pulled, corner])
            for (const value of Object.values(stroke).flat(2)) assert.ok(digits(value) <= 1, JSON.stringify(stroke));
        assertNear(drawn.tangents[0], [3 * x, 3 * y], 1e-12);
        assertNear(pulled.tangents[1], [3 * (to[0] - y), 3 * (y - x)], 1e-12);
    }
});

test("a point that is put into a line or a curve through points is written short where that is asked for", () => {
    for (const kind of ["segment", "polyline", "catmull_rom", "bspline"]) {
        const points = [
            [1, 2],
            [7, 5],
            [3, 9],
            [-2, 4],
        ].slice(0, kind === "segment" ? 2 : 4);
        const stroke = { [kind]: points };
        const [exact, short] = [0, 1e-3].map((pixel) => insertNode(stroke, 0, 1 / 3, pixel));
        const [at, to] = [exact, short].map((one) => one[kindOf(one)].find((point) => !points.includes(point)));
        assert.ok(to.every((value) => digits(value) <= 3));
        assertNear(to, at, 5.1e-4);
        assert.equal(exact[kindOf(exact)].length, short[kindOf(short)].length);
    }
});
