/** Polylines of few points, against the distance of every point that they leave out. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { polylines } from "../../../voronoi_tiles/studio/page/model/polylines.js";
import { random } from "./helpers.js";

/** @typedef {[number, number]} Point */

/** Segments from each point to the next. @param {Point[]} points */
const joined = (points) => Float64Array.from(points.slice(1).flatMap((point, k) => [...points[k], ...point]));

/** How far a point is from a segment, by its nearest of many points. @type {(z: Point, a: Point, b: Point) => number} */
function apart([x, y], [x0, y0], [x1, y1]) {
    const [dx, dy] = [x1 - x0, y1 - y0];
    const along = dx || dy ? ((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy) : 0;
    const t = Math.min(1, Math.max(0, along));
    return Math.hypot(x - x0 - t * dx, y - y0 - t * dy);
}

/** @type {Record<string, (next: () => number) => Point[]>} */
const KINDS = {
    "a wave": () => Array.from({ length: 300 }, (_, k) => [k / 10, 5 * Math.sin(k / 20)]),
    "a circle": () =>
        Array.from({ length: 200 }, (_, k) => [Math.cos((k * Math.PI) / 100), Math.sin((k * Math.PI) / 100)]),
    "a line there and back": () => [
        [0, 0],
        [5, 0],
        [1, 0.01],
        [3, 0],
    ],
    "what is smaller than the tolerance": () => [
        [0, 0],
        [0.01, 0],
        [0, 0.02],
        [0, 0],
    ],
    "a walk": (next) => {
        /** @type {Point[]} */
        const points = [[0, 0]];
        for (let k = 0; k < 200; k++) {
            const [x, y] = points[k];
            points.push([x + (next() - 0.5) / 5, y + (next() - 0.5) / 5]);
        }
        return points;
    },
};

for (const [name, make] of Object.entries(KINDS)) {
    test(`of ${name} all is within the tolerance, and its ends stay`, () => {
        for (let seed = 1; seed < 20; seed++) {
            const points = make(random(seed));
            for (const tolerance of [0.003, 0.05]) {
                const [line, ...more] = polylines(joined(points), tolerance);
                assert.equal(more.length, 0);
                assert.deepEqual(line[0], points[0]);
                assert.deepEqual(line.at(-1), points.at(-1));
                let piece = 0;
                for (const point of points) {
                    // In their order: what was passed is not come back to.
                    while (piece < line.length - 2 && apart(point, line[piece], line[piece + 1]) > tolerance * 1.000001)
                        piece += 1;
                    const off = apart(point, line[piece], line[piece + 1]);
                    assert.ok(off <= tolerance * 1.000001, `${point} is ${off} away`);
                }
            }
        }
    });
}

test("a smooth curve needs few points, and a straight line two", () => {
    const wave = KINDS["a wave"](() => 0);
    assert.ok(polylines(joined(wave), 0.05)[0].length < 40);
    const straight = /** @type {Point[]} */ (Array.from({ length: 50 }, (_, k) => [k, 2 * k]));
    assert.deepEqual(polylines(joined(straight), 1e-9), [[straight[0], straight[49]]]);
});

test("segments that do not join are polylines of their own, and points dots", () => {
    assert.deepEqual(polylines(Float64Array.of(0, 0, 1, 0, 5, 5, 5, 5, 7, 7, 8, 8), 0.1), [
        [
            [0, 0],
            [1, 0],
        ],
        [
            [5, 5],
            [5, 5],
        ],
        [
            [7, 7],
            [8, 8],
        ],
    ]);
});
