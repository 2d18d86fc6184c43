/** Lattices and orbits. Groups, elements and copies are compared with Python's elsewhere. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { apply, compose, inverse, unitAt } from "../../../voronoi_tiles/studio/page/model/plane.js";
import { cosets } from "../../../voronoi_tiles/studio/page/model/copies.js";
import {
    cartesian,
    cellArea,
    fold,
    imagesIn,
    orbitIn,
    reduced,
} from "../../../voronoi_tiles/studio/page/model/lattice.js";
import {
    elementsIn,
    latticeOf,
    motionsOf,
    moved,
    regionOf,
} from "../../../voronoi_tiles/studio/page/model/symmetry.js";
import { assertNear, random } from "./helpers.js";

const operation = (w, t = [0, 0]) => ({ name: "", w, t });
const TABLES = {
    groups: [
        {
            name: "p1",
            free: ["a", "b", "angle"],
            angle: null,
            centres: [],
            mirrors: [],
            glides: [],
            operations: [operation([1, 0, 0, 1])],
            region: [
                [0, 0],
                [1, 0],
                [1, 1],
                [0, 1],
            ],
        },
        {
            name: "pm",
            free: ["a", "b"],
            angle: 90,
            centres: [],
            glides: [],
            mirrors: [
                { through: [0, 0], along: [0, 1] },
                { through: [0.5, 0], along: [0, 1] },
            ],
            operations: [operation([1, 0, 0, 1]), operation([-1, 0, 0, 1])],
            region: [
                [0, 0],
                [0.5, 0],
                [0.5, 1],
                [0, 1],
            ],
        },
    ],
};
const design = (group, cell) => ({ schema: 1, group, cell, site: [] });
const BOX = [-70, -35, 95, 120];
const isIn = ([x, y]) => x >= BOX[0] && x <= BOX[2] && y >= BOX[1] && y <= BOX[3];

test("similarities compose and are undone", () => {
    const chance = random(2);
    for (let k = 0; k < 50; k++) {
        const map = () => ({ a: [chance() + 0.1, chance()], b: [chance(), chance()], conj: chance() < 0.5 });
        const [one, other, z] = [map(), map(), [chance(), chance()]];
        assertNear(apply(compose(one, other), z), apply(one, apply(other, z)), 1e-13);
        assertNear(apply(inverse(one), apply(one, z)), z, 1e-12);
    }
    assert.deepEqual([0, 90, -180, 450, 720].map(unitAt), [
        [1, 0],
        [0, 1],
        [-1, 0],
        [0, 1],
        [1, 0],
    ]);
});

test("skew and turned-over lattices: images, cells and folding agree with counting", () => {
    for (const cell of [
        { a: 60, b: 50, angle: 75 },
        { a: 20, b: 90, angle: 12 },
        { a: 40, b: 11, angle: 160 },
    ]) {
        const lattice = latticeOf(design("p1", cell), TABLES);
        const point = [3.3, -1.7];
        const all = [];
        for (let i = -60; i <= 60; i++) {
            for (let j = -60; j <= 60; j++) all.push(cartesian(lattice, [i, j]).map((value, k) => value + point[k]));
        }
        const key = (list) =>
            list
                .filter(isIn)
                .map((at) => at.map((value) => value.toFixed(6)).join())
                .sort();
        assert.deepEqual(key(imagesIn(lattice, point, BOX)), key(all));
        for (const at of all) assertNear(fold(lattice, at), fold(lattice, point), 1e-7);
        const short = reduced(lattice);
        assertNear([cellArea({ a: short.p, b: short.q })], [cellArea(lattice)], 1e-9);
        const square = ([x, y]) => x * x + y * y;
        const [one, other] = [1, -1].map((sign) => short.q.map((value, k) => value + sign * short.p[k]));
        assert.ok(square(short.p) <= square(short.q) && square(short.q) <= Math.min(square(one), square(other)));
    }
});

test("orbits are the images under all motions", () => {
    const own = design("pm", { a: 60, b: 50 });
    const [lattice, motions] = [latticeOf(own, TABLES), motionsOf(own, TABLES)];
    const orbit = orbitIn(motions, lattice, [7, 5], [-10, 0, 70, 49]);
    assert.deepEqual(
        orbit.map(([x, y]) => [x, y]).sort((p, q) => p[0] - q[0]),
        [
            [-7, 5],
            [7, 5],
            [53, 5],
            [67, 5],
        ],
    );
    assert.deepEqual(moved(motions[1], [7, 5]), [-7, 5]);
    assertNear(regionOf(own, TABLES).flat(), [0, 0, 30, 0, 30, 50, 0, 50]);
});

test("a cell that lacks what its group frees is that of a square, and an unknown group is the first", () => {
    assert.deepEqual(latticeOf(design("p1", { a: 60 }), TABLES), { a: [60, 0], b: [0, 60] });
    assert.deepEqual(motionsOf(design("p5", { a: 60 }), TABLES).length, 1);
});

test("too many cells have no elements to show", () => {
    const own = design("pm", { a: 1, b: 1 });
    assert.equal(elementsIn(own, TABLES, [0.1, 0.1, 49, 49]).mirrors.length, 98);
    assert.deepEqual(elementsIn(own, TABLES, [0, 0, 60, 60]), { centres: [], mirrors: [], glides: [] });
});

test("what is an ulp outside a box is on its border", () => {
    const own = design("pm", { a: 60, b: 50 });
    for (const box of [
        [7, 1, 30 - 2 ** -48, 49],
        [30 + 2 ** -48, 1, 40, 49],
    ]) {
        assert.equal(elementsIn(own, TABLES, box).mirrors.length, 1);
        assert.equal(imagesIn(latticeOf(own, TABLES), [30, 5], box).length, 1);
        assert.equal(imagesIn(latticeOf(own, TABLES), [30 + 1e-9, 5], [7, 1, 30, 49]).length, 0);
    }
});

test("a site that its mirror maps onto itself has one copy, however its lines are divided", () => {
    const own = design("pm", { a: 60, b: 50 });
    const [lattice, motions] = [latticeOf(own, TABLES), motionsOf(own, TABLES)];
    assert.deepEqual(cosets(motions, lattice, [-5, 3, 5, 3]), [0]);
    assert.deepEqual(cosets(motions, lattice, [-5, 3, 1, 3, 1, 3, 5, 3]), [0]);
    assert.deepEqual(cosets(motions, lattice, [25, 3, 35, 3]), [0]);
    assert.deepEqual(cosets(motions, lattice, [-5, 3, 5, 3.001]), [0, 1]);
    // The ends of two sides are those of the third, but the middles are not.
    assert.deepEqual(cosets(motions, lattice, [-5, 0, 5, 0, 5, 0, 0, 9]), [0, 1]);
    assert.deepEqual(cosets(motions, lattice, []), [0, 1]);
});
