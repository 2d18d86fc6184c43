/** What a free hand draws: few curves, near all its points. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { fit } from "../../../voronoi_tiles/studio/page/model/freehand.js";
import { nearestOn } from "../../../voronoi_tiles/studio/page/model/nearest.js";
import { cubicsOf } from "../../../voronoi_tiles/studio/page/model/strokes.js";
import { assertNear, random } from "./helpers.js";

/** The stroke of a trail, its pieces, and how far the trail's points are from it at most. */
function drawn(trail, accuracy) {
    const stroke = fit(trail, accuracy);
    const cubics = cubicsOf(stroke);
    const away = Math.max(...trail.map((point) => nearestOn(cubics, point).distance));
    return { stroke, pieces: cubics.length / 8, away };
}

const trailOf = (count, point) => Array.from({ length: count + 1 }, (_, k) => point(k / count));

test("smooth trails become few curves within the accuracy", () => {
    const chance = random(3);
    const trails = {
        line: [trailOf(50, (t) => [30 * t, 10 * t]), 1],
        wave: [trailOf(200, (t) => [60 * t, 8 * Math.sin(9 * t)]), 6],
        spiral: [trailOf(300, (t) => [(5 + 20 * t) * Math.cos(9 * t), (5 + 20 * t) * Math.sin(9 * t)]), 9],
        shaky: [trailOf(200, (t) => [60 * t + 0.1 * chance(), 20 * t * t + 0.1 * chance()]), 3],
    };
    for (const [name, [trail, most]] of Object.entries(trails)) {
        const { pieces, away } = drawn(trail, 0.3);
        assert.ok(away <= 0.33, `${name}: ${away}`);
        assert.ok(pieces <= most, `${name}: ${pieces} pieces`);
    }
});

test("pieces meet with one tangent, but in corners", () => {
    const trail = trailOf(300, (t) => [60 * t, 8 * Math.sin(9 * t)]);
    const { bezier } = fit(trail, 0.1);
    assert.ok(bezier.length > 7);
    for (let k = 3; k < bezier.length - 1; k += 3) {
        const [[x, y], [p, q], [u, v]] = [bezier[k], bezier[k - 1], bezier[k + 1]];
        const cosine = ((x - p) * (u - x) + (y - q) * (v - y)) / (Math.hypot(x - p, y - q) * Math.hypot(u - x, v - y));
        assert.ok(cosine > 0.99, `${cosine}`);
    }
});

test("corners stay corners", () => {
    const corners = [
        [0, 0],
        [30, 0],
        [30, 30],
        [5, 12],
    ];
    const trail = corners
        .slice(1)
        .flatMap((end, k) => trailOf(40, (t) => corners[k].map((value, n) => value + t * (end[n] - value))));
    const { stroke, pieces, away } = drawn(trail, 0.3);
    assert.equal(pieces, 3);
    assert.ok(away <= 0.33);
    for (const corner of corners)
        assert.ok(stroke.bezier.some((point) => Math.hypot(point[0] - corner[0], point[1] - corner[1]) < 0.1));
});

test("a trail that comes back is closed", () => {
    const trail = trailOf(200, (t) => [20 * Math.cos(6.25 * t), 20 * Math.sin(6.25 * t)]);
    const { stroke, pieces } = drawn(trail, 0.3);
    assert.deepEqual(stroke.bezier[0], stroke.bezier.at(-1));
    assert.ok(pieces <= 6, `${pieces}`);
});

test("two points are a line, and one is nothing", () => {
    assertNear(
        fit(
            [
                [0, 0],
                [9, 3],
            ],
            0.3,
        ).bezier.flat(),
        [0, 0, 3, 1, 6, 2, 9, 3],
    );
    assert.equal(
        fit(
            [
                [1, 1],
                [1, 1],
                [1.01, 1],
            ],
            0.3,
        ),
        null,
    );
    assert.equal(fit([], 0.3), null);
});

test("any scribble is fitted, with numbers", () => {
    const chance = random(5);
    for (let round = 0; round < 25; round++) {
        let [x, y] = [0, 0];
        const trail = trailOf(5 + Math.floor(200 * chance()), () => [(x += 4 * chance() - 2), (y += 4 * chance() - 2)]);
        const { stroke, away } = drawn(trail, 0.5);
        assert.ok(stroke.bezier.flat().every(Number.isFinite));
        assert.ok(away <= 0.75, `${away}`);
    }
});
