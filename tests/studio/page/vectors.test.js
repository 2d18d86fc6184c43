/**
 * The page's model against Python's, by the file that VORONOI_TILES_VECTORS names: see tests/helpers/page_vectors.py.
 */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { distance } from "../../../voronoi_tiles/studio/page/model/plane.js";
import { cubicsOf, flatten, placementOf } from "../../../voronoi_tiles/studio/page/model/strokes.js";
import { cosets, elementsIn, latticeOf, motionsOf } from "../../../voronoi_tiles/studio/page/model/symmetry.js";

const file = process.env.VORONOI_TILES_VECTORS;
const options = {
    skip: file ? false : "VORONOI_TILES_VECTORS names no file; tests/studio/test_page_model.py writes one",
};
const vectors = file ? JSON.parse(readFileSync(file, "utf8")) : {};

/** How near numbers must be; relative to the size of what is compared. */
const NEAR = 1e-12;

/** Fail where two lists of numbers differ by more than NEAR of the largest. */
function assertNear(found, expected, what) {
    assert.equal(found.length, expected.length, `${what}: ${found.length} numbers, not ${expected.length}`);
    const size = expected.reduce((most, value) => Math.max(most, Math.abs(value)), 1);
    expected.forEach((value, k) => {
        const error = Math.abs(found[k] - value) / size;
        assert.ok(error <= NEAR, `${what}: number ${k} is ${found[k]}, not ${value}`);
    });
}

/** The numbers of points and vectors of points, in an order that does not depend on theirs. */
function sorted(rows) {
    const key = (row) => row.map((value) => Math.round(value * 1e6) / 1e6 + 0);
    const before = (one, other) => {
        const k = key(one).findIndex((value, index) => value !== key(other)[index]);
        return k < 0 ? 0 : key(one)[k] - key(other)[k];
    };
    return rows.sort(before).flat();
}

/** The ends of a line, the lower one first. */
const ends = ([p, q]) => (sorted([p, q])[0] === p[0] && sorted([p, q])[1] === p[1] ? [...p, ...q] : [...q, ...p]);

test("strokes are Python's curves where they are placed", options, () => {
    const kinds = new Set();
    for (const { site, stroke, resolved, cubics } of vectors.strokes) {
        const found = [...cubicsOf(stroke, placementOf(site, stroke), resolved)];
        const isJoint = (_, k) => k % 8 < 2 || k === cubics.length - 2 || k === cubics.length - 1;
        const isCircle = "circle" in stroke;
        // A circle of 12 curves and the polygon of 12 sides have their joints in common.
        assertNear(
            isCircle ? found.filter(isJoint) : found,
            isCircle ? cubics.filter(isJoint) : cubics,
            JSON.stringify(stroke),
        );
        kinds.add(Object.keys(stroke)[0]);
    }
    assert.equal(kinds.size, 10);
});

test("circles are within a millionth of their radius", options, () => {
    for (const { site, stroke } of vectors.strokes.filter(({ stroke }) => "circle" in stroke)) {
        const placement = placementOf(site, stroke);
        const centre = cubicsOf({ point: stroke.circle }, placement);
        const radius = stroke.radius * Math.hypot(...placement.a);
        const segments = flatten(cubicsOf(stroke, placement), 1e-7 * radius);
        for (let k = 0; k < segments.length; k += 2) {
            const error = distance([segments[k], segments[k + 1]], [centre[0], centre[1]]) / radius - 1;
            assert.ok(Math.abs(error) < 1e-6, `${error}`);
        }
    }
});

test("curves are flattened to the segments that Python makes", options, () => {
    for (const { cubics, tolerance, segments } of vectors.flattened) {
        assertNear(flatten(Float64Array.from(cubics), tolerance), segments, `within ${tolerance}`);
    }
});

test("lattices and motions of all groups are Python's", options, () => {
    assert.equal(vectors.groups.length, 17);
    for (const { group, cell, lattice, motions } of vectors.groups) {
        const design = { schema: 1, group, cell, site: [] };
        const found = latticeOf(design, vectors.tables);
        assertNear([...found.a, ...found.b], [...lattice.a, ...lattice.b], group);
        const numbers = (list) => list.flatMap(({ a, b, conj }) => [...a, ...b, Number(conj)]);
        assertNear(numbers(motionsOf(design, vectors.tables)), numbers(motions), group);
    }
});

test("symmetry elements of all groups are where Python places them", options, () => {
    const centres = (list) => sorted(list.map(({ at, order }) => [...at, order]));
    for (const { group, cell, elements } of vectors.groups) {
        for (const expected of elements) {
            const found = elementsIn({ schema: 1, group, cell, site: [] }, vectors.tables, expected.box);
            assertNear(centres(found.centres), centres(expected.centres), `centres of ${group}`);
            for (const kind of /** @type {const} */ (["mirrors", "glides"])) {
                assertNear(sorted(found[kind].map(ends)), sorted(expected[kind].map(ends)), `${kind} of ${group}`);
            }
        }
    }
});

test("copies of sites in special positions are counted once, as the engine does", options, () => {
    const counts = new Set();
    for (const { group, cell, sites } of vectors.groups) {
        const design = { schema: 1, group, cell, site: [] };
        const [motions, lattice] = [motionsOf(design, vectors.tables), latticeOf(design, vectors.tables)];
        for (const { strokes, operations } of sites) {
            const segments = strokes.flatMap((stroke) => [...flatten(cubicsOf(stroke), 0.2)]);
            assert.deepEqual(cosets(motions, lattice, segments), operations, `${group}: ${JSON.stringify(strokes)}`);
            counts.add(motions.length / operations.length);
        }
    }
    assert.deepEqual(
        [...counts].sort((p, q) => p - q),
        [1, 2, 3, 4, 6, 8, 12],
    );
});
