// @ts-check
/** The copies of a site under a group: each once, also of a site that some motions map onto itself. */

import { cartesian, fractional } from "./lattice.js";
import { compose, distance, length, minus, plus } from "./plane.js";
import { boxOf, isNear, mapped } from "./segments.js";

/** @import { Point } from "./plane.js" */
/** @import { Lattice } from "./lattice.js" */
/** @typedef {import("./plane.js").Similarity} Motion a motion of the group */

/** How near a site must be to its image to be the same; relative to the cell or the site, whichever is larger. */
const SAME_POINT = 1e-11;

/**
 * The numbers of the motions that make the copies of a site in one cell, each copy once; the first is the identity's.
 *
 * Those that map the site onto itself, with a translation of the lattice, make no new copies.
 * @param {Motion[]} motions
 * @param {Lattice} lattice
 * @param {ArrayLike<number>} segments the site's, 4 numbers each
 * @returns {number[]}
 */
export function cosets(motions, lattice, segments) {
    const stabilizer = stabilizerOf(motions, lattice, segments);
    const covered = new Set();
    /** @type {number[]} */
    const representatives = [];
    motions.forEach((motion, k) => {
        if (covered.has(k)) return;
        representatives.push(k);
        if (stabilizer.length > 1) {
            for (const element of stabilizer) covered.add(numberOf(compose(motion, element), motions, lattice));
        }
    });
    return representatives;
}

/**
 * The motions that map a site onto itself, the identity first.
 * @param {Motion[]} motions
 * @param {Lattice} lattice
 * @param {ArrayLike<number>} segments the site's, 4 numbers each
 * @returns {Motion[]}
 */
function stabilizerOf(motions, lattice, segments) {
    const [identity, ...others] = motions;
    if (!segments.length) return [identity];
    const [left, bottom, right, top] = boxOf(segments);
    const middle = /** @type {Point} */ ([(left + right) / 2, (bottom + top) / 2]);
    const size = Math.max(length(lattice.a), length(lattice.b), right - left, top - bottom);
    const close = SAME_POINT * size;
    const maps = others.flatMap((motion) => {
        const isTranslation = !motion.conj && motion.a[0] === 1;
        // The boxes of a site and its image must be the same, up to a translation.
        const image = mapped(motion, segments);
        const box = boxOf(image);
        const centre = /** @type {Point} */ ([(box[0] + box[2]) / 2, (box[1] + box[3]) / 2]);
        const shift = latticeVector(lattice, minus(middle, centre));
        if (isTranslation || distance(plus(centre, shift), middle) > close) return [];
        const map = { ...motion, b: plus(motion.b, shift) };
        return liesOn(mapped(map, segments), segments, close) ? [map] : [];
    });
    return [identity, ...maps];
}

/** The lattice vector that is nearest to a vector, if it is near one. @type {(lattice: Lattice, v: Point) => Point} */
function latticeVector(lattice, v) {
    const [x, y] = fractional(lattice, v);
    return cartesian(lattice, [Math.round(x), Math.round(y)]);
}

/**
 * The number of a motion, up to translations of the lattice.
 * @type {(motion: Motion, motions: Motion[], lattice: Lattice) => number}
 */
function numberOf(motion, motions, lattice) {
    const near = SAME_POINT ** 0.5;
    return motions.findIndex(({ a, b, conj }) => {
        const apart = minus(motion.b, b);
        const rest = distance(apart, latticeVector(lattice, apart));
        return conj === motion.conj && distance(a, motion.a) < near && rest < near * length(lattice.a);
    });
}

/**
 * Whether the ends and the middles of some segments lie on others.
 *
 * Ends alone would take two sides of a triangle for the third; how the others are divided does not matter.
 * @type {(some: ArrayLike<number>, others: ArrayLike<number>, close: number) => boolean}
 */
function liesOn(some, others, close) {
    for (let k = 0; k < some.length; k += 4) {
        const [x0, y0, x1, y1] = [some[k], some[k + 1], some[k + 2], some[k + 3]];
        for (const point of /** @type {Point[]} */ ([
            [x0, y0],
            [(x0 + x1) / 2, (y0 + y1) / 2],
            [x1, y1],
        ])) {
            if (!isNear(point, others, close)) return false;
        }
    }
    return true;
}
