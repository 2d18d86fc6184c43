/** What the tests of the page's model share. */

import assert from "node:assert/strict";

/** A value that cannot be changed, all through: an edit that changed it would fail. */
export function frozen(value) {
    if (typeof value === "object" && value !== null) Object.values(Object.freeze(value)).forEach(frozen);
    return value;
}

/** Fail where lists of numbers differ by more than rounding leaves. */
export function assertNear(found, expected, near = 1e-9, what = "") {
    assert.equal(found.length, expected.length, what);
    expected.forEach((value, k) =>
        assert.ok(Math.abs(found[k] - value) <= near, `${what}: ${found[k]} is not ${value} (${k})`),
    );
}

/** Random numbers from 0 to 1 that a seed determines (mulberry32). */
export function random(seed) {
    let state = seed >>> 0;
    return () => {
        state = (state + 0x6d2b79f5) >>> 0;
        let mixed = Math.imul(state ^ (state >>> 15), state | 1);
        mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
        return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
    };
}

/** One stroke of every kind that has nodes, closed ones too, in no placement. */
export const STROKES = frozen([
    { point: [3, 4.5] },
    {
        segment: [
            [1, 2],
            [7, 5],
        ],
    },
    {
        polyline: [
            [1, 2],
            [7, 5],
            [3, 9],
            [-2, 4],
        ],
    },
    {
        polyline: [
            [1, 2],
            [7, 5],
            [3, 9],
        ],
        closed: true,
    },
    {
        bezier: [
            [0, 0],
            [2, 3],
            [5, 4],
            [7, 1],
            [9, -2],
            [12, 0],
            [13, 3],
        ],
    },
    {
        bezier: [
            [0, 0],
            [2, 3],
            [5, 4],
            [7, 1],
            [9, -2],
            [-2, -3],
            [0, 0],
        ],
    },
    {
        hermite: [
            [0, 0],
            [4, 1],
            [9, -3],
        ],
        tangents: [
            [3, 6],
            [4.5, -1.5],
            [0.3, 6],
        ],
    },
    {
        hermite: [
            [0, 0],
            [4, 1],
            [2, 5],
            [0, 0],
        ],
        tangents: [
            [3, -6],
            [1, 4],
            [-5, 1],
            [3, -6],
        ],
    },
    {
        catmull_rom: [
            [0, 0],
            [4, 1],
            [2, 5],
            [7, 7],
        ],
        alpha: 0.5,
    },
    {
        catmull_rom: [
            [0, 0],
            [4, 1],
            [2, 5],
        ],
        closed: true,
    },
    {
        bspline: [
            [0, 0],
            [4, 1],
            [2, 5],
            [7, 7],
            [9, 3],
        ],
    },
    {
        bspline: [
            [0, 0],
            [4, 1],
            [2, 5],
            [7, 7],
        ],
        closed: true,
    },
    { circle: [3, -2], radius: 2.5 },
    { path: "M 0 0 L 4 1 C 5 2 6 6 7 3 Q 9 1 11 4 Z m 20 0 a 3 2 10 0 1 5 2" },
]);

/** Placements: the keys of a site and of a stroke. */
export const PLACEMENTS = frozen([
    [{}, {}],
    [{ rotate: 30, translate: [5, -2] }, { scale: 0.5 }],
    [
        { mirror: true, scale: 3, rotate: 17 },
        { mirror: true, rotate: -50, translate: [1, 1] },
    ],
]);

/** The references of all strokes, in the order of the design. @param {any} design */
export function allStrokes(design) {
    return design.site.flatMap((site, k) => site.strokes.map((_, stroke) => ({ site: k, stroke })));
}
