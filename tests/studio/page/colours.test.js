// Colours of tiles: different also to eyes that confuse them, the same in every translate of the period.

import assert from "node:assert/strict";
import test from "node:test";

import { PALETTE_SIZE, colourAt, coloursOf, tileColour } from "../../../voronoi_tiles/studio/page/gl/colours.js";

// What eyes without one kind of cones see, on linear light (Machado, Oliveira and Fernandes 2009, severity 1).
const EYES = {
    all: [1, 0, 0, 0, 1, 0, 0, 0, 1],
    protanopia: [0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998],
    deuteranopia: [0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.01182, 0.04294, 0.968881],
    tritanopia: [1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.3039],
};
// To cone responses, and their roots to OKLab (Ottosson 2020).
const CONES = [
    [0.4122214708, 0.5363325363, 0.0514459929],
    [0.2119034982, 0.6806995451, 0.1073969566],
    [0.0883024619, 0.2817188376, 0.6299787005],
].flat();
const LAB = [
    [0.2104542553, 0.793617785, -0.0040720468],
    [1.9779984951, -2.428592205, 0.4505937099],
    [0.0259040371, 0.7827717662, -0.808675766],
].flat();
const times = (m, v) => [0, 3, 6].map((k) => m[k] * v[0] + m[k + 1] * v[1] + m[k + 2] * v[2]);

/** How a colour looks to some eyes: lightness, and two hues. */
function seen(colour, eyes) {
    const light = colour.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
    return times(
        LAB,
        times(CONES, times(EYES[eyes], light)).map((part) => Math.cbrt(Math.max(part, 0))),
    );
}

/** The smallest difference between two of the first colours, to the eyes that see it least. */
function difference(count, dark) {
    let least = Infinity;
    for (const eyes of Object.keys(EYES)) {
        const looks = Array.from({ length: count }, (_, k) => seen(tileColour(k, dark), eyes));
        for (const [i, one] of looks.entries()) {
            for (const other of looks.slice(0, i)) {
                least = Math.min(least, Math.hypot(...one.map((part, k) => part - other[k])));
            }
        }
    }
    return least;
}

for (const dark of [false, true]) {
    test(`tiles can be told apart by all eyes, ${dark ? "dark" : "light"}`, () => {
        // 0.02 is about what can just be seen; four colours suffice for nearly all tessellations.
        assert(difference(4, dark) > 0.08, String(difference(4, dark)));
        assert(difference(PALETTE_SIZE, dark) > 0.02, String(difference(PALETTE_SIZE, dark)));
        const lightness = Array.from({ length: PALETTE_SIZE }, (_, k) => seen(tileColour(k, dark), "all")[0]);
        assert(dark ? Math.max(...lightness) < 0.6 : Math.min(...lightness) > 0.6, String(lightness));
        assert.notDeepEqual(tileColour(PALETTE_SIZE, dark), tileColour(0, dark));
    });
}

test("a colouring counts in the lattice's vectors, whatever the basis", () => {
    const colour = [0, 1, 2].map((k) => [0, 1, 2, 3, 4].map((x) => [k + x, 7 * x]));
    const colouring = {
        rows: [
            [1, 3],
            [2, 1],
        ],
        m: 5,
        n: 2,
        colour,
    };
    const basis = [
        [2, 1],
        [-1, 0],
    ];
    const colours = coloursOf(colouring, 3, basis);
    for (let i = -7; i < 7; i++) {
        for (let j = -7; j < 7; j++) {
            const [s, t] = [i * basis[0][0] + j * basis[1][0], i * basis[0][1] + j * basis[1][1]];
            const place = [(((s + 3 * t) % 5) + 5) % 5, (((2 * s + t) % 2) + 2) % 2];
            for (let k = 0; k < 3; k++) assert.equal(colourAt(colours, k, i, j), colour[k][place[0]][place[1]]);
            for (const [across, up] of [
                [colours.period[0], 0],
                [0, colours.period[1]],
            ]) {
                assert.equal(colourAt(colours, 1, i + across, j + up), colourAt(colours, 1, i, j));
            }
        }
    }
    assert(colours.period[0] * colours.period[1] <= 100);
});

test("without a colouring that fits, colours go by site and motion, and translates that are neighbours differ", () => {
    const basis = [
        [1, 0],
        [0, 1],
    ];
    const around = [
        [1, 0],
        [0, 1],
        [1, 1],
        [1, -1],
        [-1, 0],
        [0, -1],
        [-1, -1],
        [-1, 1],
    ];
    for (const placements of [1, 2]) {
        const colours = coloursOf(null, placements, basis);
        for (const [i, j] of around) {
            for (let k = 0; k < placements; k++) {
                assert.notEqual(colourAt(colours, 0, 0, 0), colourAt(colours, k, i, j));
            }
        }
    }
    const unfit = {
        rows: [
            [1, 0],
            [0, 1],
        ],
        m: 1,
        n: 1,
        colour: [[[0]], [[0]]],
    };
    for (const colouring of [undefined, unfit, { ...unfit, m: 2 }]) {
        const colours = coloursOf(colouring, 6, basis);
        assert.deepEqual(
            [0, 1, 2, 3, 4, 5].map((k) => colourAt(colours, k, 3, -5)),
            [0, 1, 2, 3, 4, 5],
        );
        assert.deepEqual(colours.period, [1, 1]);
    }
});
