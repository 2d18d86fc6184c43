/**
 * Strokes as curves: what can be drawn of them, and their segments. The numbers are compared with Python's elsewhere.
 */

import assert from "node:assert/strict";
import { test } from "node:test";

import { nearestOn, pointOn } from "../../../voronoi_tiles/studio/page/model/nearest.js";
import { apply } from "../../../voronoi_tiles/studio/page/model/plane.js";
import { pathCubics } from "../../../voronoi_tiles/studio/page/model/pathdata.js";
import {
    KINDS,
    cubicsOf,
    flatten,
    kindOf,
    placementOf,
    unplace,
} from "../../../voronoi_tiles/studio/page/model/strokes.js";
import { segmentDistance } from "../../../voronoi_tiles/studio/page/model/segments.js";
import { PLACEMENTS, STROKES, assertNear, random } from "./helpers.js";

test("every kind is known by its key", () => {
    for (const kind of KINDS) assert.equal(kindOf({ rotate: 3, [kind]: [] }), kind);
});

test("what cannot be drawn has no pieces, and nothing is thrown", () => {
    const broken = [
        {},
        { point: [] },
        { point: "x" },
        { segment: [] },
        { polyline: [[1], [2, 3]] },
        { polyline: [null, null] },
        {
            bezier: [
                [0, 0],
                [1, NaN],
                [2, 2],
                [3, 3],
            ],
        },
        { bezier: 7 },
        {
            bspline: [
                [0, 0],
                [1, 1],
                [2, 0],
            ],
        },
        { circle: [], radius: 3 },
        { circle: [0, 0], radius: "x" },
        { path: 5 },
        { path: "L 3 4" },
        { path: "" },
        { file: "a.svg" },
        {
            segment: [
                [0, 0],
                [1, 1],
            ],
            scale: NaN,
        },
        {
            segment: [
                [0, 0],
                [1, 1],
            ],
            translate: ["x", 0],
        },
        {
            hermite: [
                ["a", "b"],
                [1, 1],
            ],
        },
    ];
    for (const stroke of broken)
        assert.equal(cubicsOf(stroke, placementOf({}, stroke)).length, 0, JSON.stringify(stroke));
    assert.equal(
        cubicsOf({
            hermite: [
                [0, 0],
                [1, 1],
            ],
            tangents: "x",
        }).length,
        8,
    );
    assert.equal(flatten(new Float64Array(0), 1).length, 0);
});

test("strokes that are begun are drawn as far as they go", () => {
    for (const kind of ["polyline", "bezier", "hermite", "catmull_rom", "bspline"]) {
        assert.deepEqual([...cubicsOf({ [kind]: [[3, 4]] })], [3, 4, 3, 4, 3, 4, 3, 4]);
    }
    assert.equal(
        cubicsOf({
            bezier: [
                [0, 0],
                [1, 1],
                [2, 2],
                [3, 3],
                [4, 4],
            ],
        }).length,
        8,
    );
    assert.equal(
        cubicsOf({
            catmull_rom: [
                [0, 0],
                [0, 0],
                [2, 2],
            ],
        }).length,
        8,
    );
    assert.equal(
        cubicsOf({
            catmull_rom: [
                [0, 0],
                [0, 0],
            ],
            closed: true,
        }).length,
        8,
    );
});

test("path data are drawn up to the first character that is out of place", () => {
    for (const [data, pieces] of [
        ["M 0 0 L 1 1 L 2", 1],
        ["M0 0L1 1x L2 2", 1],
        ["M0 0 1 1 2 2Z!", 3],
        ["M0 0A1 1 0 2 0 3 3", 0],
        ["x", 0],
        ["M", 0],
    ]) {
        assert.equal(pathCubics(data).length / 8, pieces, data);
    }
});

test("a place is undone", () => {
    for (const [site, stroke] of PLACEMENTS) {
        const placement = placementOf(site, stroke);
        assertNear(unplace(placement, apply(placement, [3.7, -1.2])), [3.7, -1.2], 1e-12);
    }
});

test("segments and curves are within the tolerance of each other, however wild the curve", () => {
    const chance = random(11);
    for (let round = 0; round < 60; round++) {
        const cubics =
            round < STROKES.length ? cubicsOf(STROKES[round]) : Float64Array.from({ length: 16 }, () => 20 * chance());
        for (const tolerance of [1, 0.03]) {
            const segments = flatten(cubics, tolerance);
            for (let k = 0; k <= 200; k++) {
                const point = pointOn(cubics, Math.floor((k / 201) * (cubics.length / 8)), ((17 * k) / 200) % 1);
                const away = Array.from({ length: segments.length / 4 }, (_, n) =>
                    segmentDistance(point, segments, 4 * n),
                );
                assert.ok(Math.min(...away) <= tolerance * (1 + 1e-9), `round ${round}`);
            }
            for (let k = 0; k < segments.length; k += 4) {
                const middle = [(segments[k] + segments[k + 2]) / 2, (segments[k + 1] + segments[k + 3]) / 2];
                assert.ok(nearestOn(cubics, middle).distance <= tolerance * (1 + 1e-9), `round ${round}`);
            }
        }
    }
});
