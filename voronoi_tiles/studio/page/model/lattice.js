// @ts-check
/** Lattices of the plane: their cells, and the images of points under them. */

import { apply, cross, dot, length, minus, plus, scaled } from "./plane.js";

/** @import { Box, Point, Similarity } from "./plane.js" */

/** @typedef {{a: Point, b: Point}} Lattice all i a + j b with integers i, j; b to the left of a, which lies along x */

/** @typedef {{p: Point, q: Point, rows: [Point, Point]}} Basis another basis, and its integers over a and b */

/** How far outside a box counts as on its border, in ulps of its largest coordinate. */
const BORDER = 64 * 2 ** -52;

/** The sine of an angle that is none. */
const PARALLEL = 4 * 2 ** -52;

/** The area of the cell. @type {(lattice: Lattice) => number} */
export const cellArea = ({ a, b }) => cross(a, b);

/** The point of fractional coordinates. @type {(lattice: Lattice, at: Point) => Point} */
export const cartesian = ({ a, b }, [x, y]) => plus(scaled(a, x), scaled(b, y));

/** The fractional coordinates of a point. @type {(lattice: Lattice, z: Point) => Point} */
export const fractional = ({ a, b }, z) => scaled([cross(z, b), cross(a, z)], 1 / cross(a, b));

/**
 * The image of a point under the lattice that is in the cell at the origin.
 * @type {(lattice: Lattice, z: Point) => Point}
 */
export function fold(lattice, z) {
    const [x, y] = fractional(lattice, z);
    return minus(z, cartesian(lattice, [Math.floor(x), Math.floor(y)]));
}

/**
 * The shortest basis of a lattice, |p| <= |q|, q to the left of p. Source: Lagrange, Gauss.
 * @type {(lattice: Lattice) => Basis}
 */
export function reduced({ a, b }) {
    let [p, q] = [a, b];
    /** @type {[Point, Point]} */
    let [one, other] = [
        [1, 0],
        [0, 1],
    ];
    const turn = () => {
        [p, q] = [q, scaled(p, -1)];
        [one, other] = [other, scaled(one, -1)];
    };
    if (length(p) > length(q)) turn();
    // Each step shortens q by a factor, or is the last.
    for (let step = 0; step < 2000; step++) {
        const times = Math.round(dot(p, q) / dot(p, p));
        q = minus(q, scaled(p, times));
        other = minus(other, scaled(one, times));
        if (length(p) <= length(q)) break;
        turn();
    }
    return { p, q, rows: [one, other] };
}

/**
 * The images of a point under the lattice in a box, its border included.
 *
 * They stand in rows along the shorter vector of the reduced basis, so that few rows have none.
 * @type {(lattice: Lattice, point: Point, box: Box) => Point[]}
 */
export function imagesIn(lattice, point, box) {
    const { p: u, q: v } = reduced(lattice);
    const margin = marginOf(box);
    const [low, high] = across(box, u, margin);
    const own = cross(u, point);
    const step = cross(u, v);
    /** @type {Point[]} */
    const images = [];
    for (let row = Math.ceil((low - own) / step); row <= Math.floor((high - own) / step); row++) {
        const start = plus(point, scaled(v, row));
        const [first, last] = clip(box, start, u, margin, margin);
        for (let k = Math.ceil(first); k <= Math.floor(last); k++) images.push(plus(start, scaled(u, k)));
    }
    return images;
}

/**
 * All images of a point under the group in a box.
 * @type {(motions: Similarity[], lattice: Lattice, point: Point, box: Box) => Point[]}
 */
export function orbitIn(motions, lattice, point, box) {
    return motions.flatMap((motion) => imagesIn(lattice, apply(motion, point), box));
}

/** The length that counts as nothing in a box. @type {(box: Box) => number} */
export const marginOf = (box) => BORDER * Math.max(...box.map(Math.abs));

/**
 * The least and the greatest cross product of a direction with a point of a box.
 * @type {(box: Box, direction: Point, margin: number) => [number, number]}
 */
export function across([x0, y0, x1, y1], [dx, dy], margin) {
    const slack = margin * Math.hypot(dx, dy);
    const [ys, xs] = [
        [dx * y0, dx * y1],
        [dy * x0, dy * x1],
    ];
    return [Math.min(...ys) - Math.max(...xs) - slack, Math.max(...ys) - Math.min(...xs) + slack];
}

/**
 * The range of s in which start + s direction is at most `slack` outside a box; first > last where it never is.
 *
 * What runs along a side may be outside by the margin.
 * @type {(box: Box, start: Point, direction: Point, margin: number, slack: number) => [number, number]}
 */
export function clip(box, start, direction, margin, slack) {
    let [first, last] = [-Infinity, Infinity];
    for (const side of [0, 1]) {
        const [low, high, from, step] = [box[side], box[side + 2], start[side], direction[side]];
        if (Math.abs(step) <= PARALLEL * length(direction)) {
            if (from < low - margin || from > high + margin) last = -Infinity;
        } else {
            const ends = [(low - slack - from) / step, (high + slack - from) / step];
            first = Math.max(first, Math.min(...ends));
            last = Math.min(last, Math.max(...ends));
        }
    }
    return [first, last];
}
