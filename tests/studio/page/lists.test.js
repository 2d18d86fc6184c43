// The candidate lists against brute force over all copies: whoever is nearest, second nearest or nearly as near is in.

import assert from "node:assert/strict";
import test from "node:test";

import { BlockLists, CellLists, blockRadius } from "../../../voronoi_tiles/studio/page/gl/lists.js";
import { Pattern, reducedBasis } from "../../../voronoi_tiles/studio/page/gl/pattern.js";

/** How many samples of a frame are looked at; the slow test asks for more. */
const SAMPLES = Number(process.env.VORONOI_TILES_SAMPLES ?? 2);

/** Numbers in [0, 1), the same in every run (Park and Miller 1988). */
function dice(seed) {
    let state = seed;
    return () => (state = (state * 48271) % 2147483647) / 2147483647;
}

const turn = (degrees, b = [0, 0]) => ({
    a: [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)],
    b,
    conj: false,
});
const HEXAGONAL = { a: [60, 0], b: [-30, 30 * Math.sqrt(3)] };
const GROUPS = {
    p1: { lattice: { a: [40, 0], b: [13, 29] }, motions: [turn(0)] },
    "p1 narrow": { lattice: { a: [9, 0], b: [70, 31] }, motions: [turn(0)], around: 60 },
    pg: { lattice: { a: [50, 0], b: [0, 30] }, motions: [turn(0), { a: [-1, 0], b: [0, 15], conj: true }] },
    p4: { lattice: { a: [60, 0], b: [0, 60] }, motions: [0, 90, 180, 270].map((degrees) => turn(degrees)) },
    p6: { lattice: HEXAGONAL, motions: [0, 60, 120, 180, 240, 300].map((degrees) => turn(degrees)) },
};

/** Segments and points about a place, some of them far from the others. */
function strokes(random, count, size) {
    const segments = new Float64Array(4 * count);
    for (let k = 0; k < count; k++) {
        const [x, y] = [30 + size * (random() - 0.5), 10 + size * (random() - 0.5)];
        const length = k % 4 === 3 ? 0 : size / 3;
        segments.set([x, y, x + length * (random() - 0.5), y + length * (random() - 0.5)], 4 * k);
    }
    return segments;
}

const distance = (x, y, mx, my, hx, hy) => {
    const share = ((x - mx) * hx + (y - my) * hy) / Math.max(hx * hx + hy * hy, 1e-300);
    const t = Math.max(-1, Math.min(1, share));
    return Math.hypot(x - mx - t * hx, y - my - t * hy);
};

/** Distances of all copies from (x, y) by name, out of enough cells about it. */
function brute({ lattice: { a, b }, motions, around = 6 }, sites, x, y) {
    const det = a[0] * b[1] - a[1] * b[0];
    const i0 = Math.round((x * b[1] - y * b[0]) / det);
    const j0 = Math.round((a[0] * y - a[1] * x) / det);
    const all = new Map();
    sites.forEach((segments, site) =>
        motions.forEach((m, motion) => {
            for (let i = i0 - around; i <= i0 + around; i++) {
                for (let j = j0 - 6; j <= j0 + 6; j++) {
                    let least = Infinity;
                    for (let k = 0; k < segments.length; k += 4) {
                        const image = [0, 2].map((end) => {
                            const [u, v] = [segments[k + end], (m.conj ? -1 : 1) * segments[k + end + 1]];
                            return [
                                m.a[0] * u - m.a[1] * v + m.b[0] + i * a[0] + j * b[0],
                                m.a[0] * v + m.a[1] * u + m.b[1] + i * a[1] + j * b[1],
                            ];
                        });
                        const [[x0, y0], [x1, y1]] = image;
                        const element = [(x0 + x1) / 2, (y0 + y1) / 2, (x1 - x0) / 2, (y1 - y0) / 2];
                        least = Math.min(least, distance(x, y, ...element));
                    }
                    all.set([site, motion, i, j].join(), least);
                }
            }
        }),
    );
    return all;
}

/** Distances of the copies in the list of a sample's block from the sample, by name; in units. */
function listed(lists, cell, frame, block, column, row) {
    const home = Math.floor(row / block) * lists.columns + Math.floor(column / block);
    const [across, up] = [(column % block) - block / 2, (row % block) - block / 2];
    const [first, runs, i, j] = lists.blocks.subarray(4 * home, 4 * home + 4);
    const x = (across * frame.u[0] + up * frame.v[0]) * frame.scale;
    const y = (across * frame.u[1] + up * frame.v[1]) * frame.scale;
    const { rows } = cell.pattern.basis;
    const found = new Map();
    for (let run = first; run < first + runs; run++) {
        const [start, size, copy] = lists.runs.subarray(4 * run, 4 * run + 3);
        const [placement, s, t] = cell.elements.copies.slice(3 * copy, 3 * copy + 3);
        const [p, q] = [s + i, t + j];
        const { site, motion } = cell.pattern.placements[placement];
        const name = [site, motion, p * rows[0][0] + q * rows[1][0], p * rows[0][1] + q * rows[1][1]].join();
        assert(!found.has(name), "a copy has one run");
        let least = Infinity;
        for (let k = start; k < start + size; k++) {
            least = Math.min(least, distance(x, y, ...lists.elements.subarray(4 * k, 4 * k + 4)));
        }
        found.set(name, least / frame.scale);
    }
    return found;
}

/** Look at some samples of a frame: what its lists miss of what matters fails. */
function check(group, sites, frame, block, band, random) {
    const pattern = new Pattern(
        reducedBasis(group.lattice),
        group.motions,
        sites.map((segments) => ({ segments, cosets: group.motions.map((_, k) => k) })),
    );
    const count = (frame.width * frame.height) / block ** 2;
    const cell = new CellLists(pattern, blockRadius(frame, block), band, count);
    const lists = new BlockLists();
    lists.fill(cell, frame, block);
    assert.equal(lists.counts.blocks, Math.ceil(frame.width / block) * Math.ceil(frame.height / block));
    for (let n = 0; n < SAMPLES; n++) {
        // Every other one at a block's corner, where it is farthest from the centre that its list was made for.
        const [column, row] = [frame.width, frame.height].map((side) =>
            n % 2 ? Math.floor(random() * side) : block * Math.floor((random() * side) / block),
        );
        const x = frame.origin[0] + column * frame.u[0] + row * frame.v[0];
        const y = frame.origin[1] + column * frame.u[1] + row * frame.v[1];
        const all = [...brute(group, sites, x, y)].sort((p, q) => p[1] - q[1]);
        const found = listed(lists, cell, frame, block, column, row);
        const needed = Math.max(all[1][1], all[0][1] + band * 0.999);
        for (const [name, true_distance] of all) {
            if (true_distance > needed) break;
            // Float32, of numbers of some hundred pixels.
            assert(found.has(name), `copy ${name} is missing at ${[column, row]}`);
            assert(Math.abs(found.get(name) - true_distance) < 1e-4, `${name}: ${found.get(name)}, ${true_distance}`);
        }
        for (const [name, listed_distance] of found) assert(listed_distance >= all[0][1] - 1e-4, name);
    }
    return { cell, lists };
}

for (const [name, group] of Object.entries(GROUPS)) {
    test(`lists of windows and cells hold all that matters at ${SAMPLES} samples: ${name}`, () => {
        const random = dice(7 + name.length);
        for (const [count, size] of [
            [1, 5],
            [9, 20],
            [30, 90],
        ]) {
            const sites = [strokes(random, count, size), strokes(random, 2, 4)].slice(0, count === 9 ? 2 : 1);
            for (const pixels of [0.2, 3]) {
                const frame = {
                    origin: [1000 * (random() - 0.5), 1000 * (random() - 0.5)],
                    u: [1 / pixels, 0],
                    v: [0, 1 / pixels],
                    width: 100,
                    height: 50,
                    scale: pixels,
                };
                check(group, sites, frame, 16, 4 / pixels, random);
                check(group, sites, { ...frame, width: 40, height: 40 }, 4, 60 / pixels, random);
            }
            const { p, q } = reducedBasis(group.lattice);
            const skew = {
                origin: [p[0] / 80 + q[0] / 60, p[1] / 80 + q[1] / 60],
                u: [p[0] / 40, p[1] / 40],
                v: [q[0] / 30, q[1] / 30],
                width: 40,
                height: 30,
                scale: 40 / Math.hypot(...p),
            };
            check(group, sites, skew, 8, 0.5, random);
        }
    });
}

test("lists are short: they are no lists of everything", () => {
    const random = dice(3);
    const frame = { origin: [-90, -70], u: [0.3, 0], v: [0, 0.3], width: 600, height: 400, scale: 1 / 0.3 };
    const { cell, lists } = check(GROUPS.p6, [strokes(random, 24, 20)], frame, 16, 0.6, random);
    assert(cell.elements.count > 1000);
    const each = lists.counts.elements / lists.counts.blocks;
    assert(each < 40, `${each} in a block`);
});

test("the shortest basis spans the lattice it is made of", () => {
    const random = dice(11);
    for (let n = 0; n < 200; n++) {
        const a = [10 * random() - 5, 10 * random() - 5];
        const b = [300 * random() - 150, 10 * random() - 5];
        const found = reducedBasis({ a, b });
        const det = a[0] * b[1] - a[1] * b[0];
        if (!(det > 0)) {
            assert.equal(found, null);
            continue;
        }
        const { p, q, rows } = found;
        assert.equal(rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0], 1);
        [p, q].forEach((vector, k) =>
            vector.forEach((part, axis) =>
                assert(Math.abs(part - rows[k][0] * a[axis] - rows[k][1] * b[axis]) < 1e-9 * Math.hypot(...b)),
            ),
        );
        const [pp, qq, pq] = [p[0] ** 2 + p[1] ** 2, q[0] ** 2 + q[1] ** 2, p[0] * q[0] + p[1] * q[1]];
        assert(pp <= qq * (1 + 1e-12) && 2 * Math.abs(pq) <= pp * (1 + 1e-12), "no shorter one");
    }
});

test("what is no drawing has no pattern, and elements that are not finite are left out", () => {
    for (const lattice of [
        { a: [1, 0], b: [2, 0] },
        { a: [0, 1], b: [1, 0] },
        { a: [1, 0], b: [NaN, 1] },
    ]) {
        assert.equal(reducedBasis(lattice), null);
    }
    const basis = reducedBasis(GROUPS.p4.lattice);
    const site = (...numbers) => [{ segments: Float64Array.from(numbers), cosets: [0] }];
    assert(new Pattern(basis, GROUPS.p4.motions, site()).empty);
    assert(new Pattern(basis, GROUPS.p4.motions, site(NaN, 0, 1, 1)).empty);
    const half = new Pattern(basis, GROUPS.p4.motions, site(NaN, 0, 1, 1, 0, 0, 1, 1));
    assert.equal(half.placements[0].elements.length, 4);
    assert.deepEqual(new Pattern(basis, GROUPS.p4.motions, []).placements, []);
});
