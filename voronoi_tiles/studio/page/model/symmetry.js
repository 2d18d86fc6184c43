// @ts-check
/**
 * The group of a design acting on its drawing: the lattice, the motions, the symmetry elements.
 *
 * Everything about the groups comes from the server's tables; here it is laid over the cell. All coordinates are the
 * drawing's: before the `scale` of the design.
 */

import { apply, compose, cross, distance, dot, length, minus, nearestUnit, plus, scaled, unitAt } from "./plane.js";

/** @typedef {import("./plane.js").Point} Point */
/** @typedef {import("./plane.js").Similarity} Motion a motion of the group */
/** @typedef {import("./plane.js").Box} Box */
/** @typedef {import("./design.js").Design} Design */

/** @typedef {{a: Point, b: Point}} Lattice all i a + j b with integers i, j; b to the left of a, which lies along x */

/** @typedef {{name: string, w: [number, number, number, number], t: Point}} Operation in fractional coordinates */
/** @typedef {{through: Point, along: Point}} TableLine a mirror or glide line in fractional coordinates */

/**
 * A wallpaper group as the server describes it; coordinates are fractional.
 *
 * @typedef {object} GroupTable
 * @property {string} name
 * @property {number} order
 * @property {string} system
 * @property {("a" | "b" | "angle")[]} free the keys of the cell that the group leaves free
 * @property {number | null} angle the angle that it fixes, degrees
 * @property {Operation[]} operations the identity first
 * @property {{at: Point, order: number}[]} centres
 * @property {TableLine[]} mirrors
 * @property {TableLine[]} glides
 * @property {Point[]} region the corners of one asymmetric unit
 */

/** @typedef {{groups: GroupTable[]}} Tables what the page needs of the server's tables here */
/** @typedef {{at: Point, order: number}} Centre */
/** @typedef {[Point, Point]} Line both ends of the piece of a line that is in a box */
/** @typedef {{centres: Centre[], mirrors: Line[], glides: Line[]}} Elements */

/** How near a site must be to its image to be the same; relative to the cell or the site, whichever is larger. */
const SAME_POINT = 1e-11;

/** How far outside a box counts as on its border, in ulps of its largest coordinate. */
const BORDER = 64 * 2 ** -52;

/** The sine of an angle that is none. */
const PARALLEL = 4 * 2 ** -52;

/** So many cells in a box are too small to be looked at one by one. */
const CELLS_MAX = 2500;

/**
 * The table of a design's group; that of p1 for a group that there is not.
 *
 * @param {Design} design
 * @param {Tables} tables
 * @returns {GroupTable}
 */
export function groupOf(design, tables) {
    return tables.groups.find((group) => group.name === design.group) ?? tables.groups[0];
}

/**
 * The lattice of a design. What the cell lacks is taken from a square.
 *
 * @param {Design} design
 * @param {Tables} tables
 * @returns {Lattice}
 */
export function latticeOf({ group, cell }, tables) {
    const { free, angle } = groupOf(/** @type {Design} */ ({ group }), tables);
    const side = free.includes("b") ? (cell.b ?? cell.a) : cell.a;
    return { a: [cell.a, 0], b: scaled(unitAt(angle ?? cell.angle ?? 90), side) };
}

/** The area of the cell. @type {(lattice: Lattice) => number} */
export const cellArea = ({ a, b }) => cross(a, b);

/** The point of fractional coordinates. @type {(lattice: Lattice, at: Point) => Point} */
export const cartesian = ({ a, b }, [x, y]) => plus(scaled(a, x), scaled(b, y));

/** The fractional coordinates of a point. @type {(lattice: Lattice, z: Point) => Point} */
export const fractional = ({ a, b }, z) => scaled([cross(z, b), cross(a, z)], 1 / cross(a, b));

/**
 * The image of a point under the lattice that is in the cell at the origin.
 *
 * @param {Lattice} lattice
 * @param {Point} z
 * @returns {Point}
 */
export function fold(lattice, z) {
    const [x, y] = fractional(lattice, z);
    return minus(z, cartesian(lattice, [Math.floor(x), Math.floor(y)]));
}

/** The image of a point under a motion. @type {(motion: Motion, at: Point) => Point} */
export const moved = apply;

/**
 * The cells that can meet a box, by the integers i and j of their corners i a + j b.
 *
 * @param {Lattice} lattice
 * @param {Box} box
 * @returns {[number, number][]}
 */
export function cellsIn(lattice, [x0, y0, x1, y1]) {
    const corners = /** @type {Point[]} */ ([[x0, y0], [x1, y0], [x0, y1], [x1, y1]]);
    const [left, bottom, right, top] = boxOf(corners.flatMap((corner) => fractional(lattice, corner)));
    /** @type {[number, number][]} */
    const cells = [];
    for (let j = Math.floor(bottom); j <= top; j++) {
        for (let i = Math.floor(left); i <= right; i++) cells.push([i, j]);
    }
    return cells;
}

/**
 * The motions of the group in one cell, the identity first: those of its table's operations, in their order.
 *
 * @param {Design} design
 * @param {Tables} tables
 * @returns {Motion[]}
 */
export function motionsOf(design, tables) {
    const lattice = latticeOf(design, tables);
    return groupOf(design, tables).operations.map(({ w, t }) => ({
        a: nearestUnit(cartesian(lattice, [w[0], w[2]])),
        b: cartesian(lattice, t),
        conj: w[0] * w[3] - w[1] * w[2] < 0,
    }));
}

/**
 * The shortest basis of a lattice, |a| <= |b|. Source: Lagrange, Gauss.
 *
 * @param {Lattice} lattice
 * @returns {Lattice}
 */
export function reduced({ a, b }) {
    let [u, v] = length(a) > length(b) ? [b, scaled(a, -1)] : [a, b];
    // Each step shortens v by a factor, or is the last.
    for (let step = 0; step < 2000; step++) {
        v = minus(v, scaled(u, Math.round(dot(u, v) / dot(u, u))));
        if (length(u) <= length(v)) break;
        [u, v] = [v, scaled(u, -1)];
    }
    return { a: u, b: v };
}

/**
 * The images of a point under the lattice in a box, its border included.
 *
 * They stand in rows along the shorter vector of the reduced basis, so that few rows have none.
 *
 * @param {Lattice} lattice
 * @param {Point} point
 * @param {Box} box
 * @returns {Point[]}
 */
export function imagesIn(lattice, point, box) {
    const { a: u, b: v } = reduced(lattice);
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
 *
 * @param {Motion[]} motions
 * @param {Lattice} lattice
 * @param {Point} point
 * @param {Box} box
 * @returns {Point[]}
 */
export function orbitIn(motions, lattice, point, box) {
    return motions.flatMap((motion) => imagesIn(lattice, apply(motion, point), box));
}

/**
 * The symmetry elements of a design's group in a box; none where the box has too many cells to show them.
 *
 * @param {Design} design
 * @param {Tables} tables
 * @param {Box} box
 * @returns {Elements}
 */
export function elementsIn(design, tables, box) {
    const lattice = latticeOf(design, tables);
    const group = groupOf(design, tables);
    const cells = ((box[2] - box[0]) * (box[3] - box[1])) / cellArea(lattice);
    if (!(cells <= CELLS_MAX)) return { centres: [], mirrors: [], glides: [] };
    return {
        centres: group.centres.flatMap(({ at, order }) =>
            imagesIn(lattice, cartesian(lattice, at), box).map((image) => ({ at: image, order })),
        ),
        mirrors: group.mirrors.flatMap((line) => linesIn(lattice, line, box)),
        glides: group.glides.flatMap((line) => linesIn(lattice, line, box)),
    };
}

/**
 * One asymmetric unit of a design's group: its corners.
 *
 * @param {Design} design
 * @param {Tables} tables
 * @returns {Point[]}
 */
export function regionOf(design, tables) {
    const lattice = latticeOf(design, tables);
    return groupOf(design, tables).region.map((corner) => cartesian(lattice, corner));
}

/**
 * The pieces in a box of a line and its images under the lattice.
 *
 * @param {Lattice} lattice
 * @param {TableLine} line its direction is a shortest lattice vector p a + q b
 * @param {Box} box
 * @returns {Line[]}
 */
function linesIn(lattice, { through, along: [p, q] }, box) {
    const along = cartesian(lattice, [p, q]);
    const margin = marginOf(box);
    // The cross product of `along` with the points of a line is -det times q x - p y; translations add integers to that.
    const [low, high] = across(box, along, margin);
    const area = cellArea(lattice);
    const own = q * through[0] - p * through[1];
    const [i, j] = unitStep(p, q);
    /** @type {Line[]} */
    const lines = [];
    for (let k = Math.ceil(-high / area - own); k <= Math.floor(-low / area - own); k++) {
        const start = cartesian(lattice, [through[0] + k * i, through[1] + k * j]);
        const [first, last] = clip(box, start, along, margin, 0);
        // A line that touches a corner has no length.
        if ((last - first) * length(along) > 4 * margin) {
            lines.push([plus(start, scaled(along, first)), plus(start, scaled(along, last))]);
        }
    }
    return lines;
}

/**
 * Small integers i and j with q i - p j = 1; p and q have no common divisor.
 *
 * @param {number} p
 * @param {number} q
 * @returns {[number, number]}
 */
function unitStep(p, q) {
    for (let i = 0; p !== 0 && i < Math.abs(p); i++) {
        if ((q * i - 1) % p === 0) return [i, (q * i - 1) / p];
    }
    return [q, 0];
}

/** The length that counts as nothing in a box. @type {(box: Box) => number} */
const marginOf = (box) => BORDER * Math.max(...box.map(Math.abs));

/**
 * The least and the greatest cross product of a direction with a point of a box.
 *
 * @param {Box} box
 * @param {Point} direction
 * @param {number} margin
 * @returns {[number, number]}
 */
function across([x0, y0, x1, y1], [dx, dy], margin) {
    const slack = margin * Math.hypot(dx, dy);
    const [ys, xs] = [[dx * y0, dx * y1], [dy * x0, dy * x1]];
    return [Math.min(...ys) - Math.max(...xs) - slack, Math.max(...ys) - Math.min(...xs) + slack];
}

/**
 * The range of s in which start + s direction is at most `slack` outside a box; first > last where it never is.
 *
 * What runs along a side may be outside by the margin.
 *
 * @param {Box} box
 * @param {Point} start
 * @param {Point} direction
 * @param {number} margin
 * @param {number} slack
 * @returns {[number, number]}
 */
function clip(box, start, direction, margin, slack) {
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

/**
 * The numbers of the motions that make the copies of a site in one cell, each copy once; the first is the identity's.
 *
 * Those that map the site onto itself, with a translation of the lattice, make no new copies.
 *
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
 *
 * @param {Motion[]} motions
 * @param {Lattice} lattice
 * @param {ArrayLike<number>} segments the site's, 4 numbers each
 * @returns {Motion[]}
 */
export function stabilizerOf(motions, lattice, segments) {
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
 *
 * @param {Motion} motion
 * @param {Motion[]} motions
 * @param {Lattice} lattice
 * @returns {number}
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
 * The images of segments, 4 numbers each.
 *
 * @param {Motion} motion
 * @param {ArrayLike<number>} segments
 * @returns {Float64Array}
 */
export function mapped(motion, segments) {
    const image = new Float64Array(segments.length);
    for (let k = 0; k < segments.length; k += 2) {
        const z = apply(motion, [segments[k], segments[k + 1]]);
        image[k] = z[0];
        image[k + 1] = z[1];
    }
    return image;
}

/**
 * The smallest box around points, two numbers each.
 *
 * @param {ArrayLike<number>} numbers
 * @returns {Box}
 */
export function boxOf(numbers) {
    /** @type {Box} */
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    for (let k = 0; k < numbers.length; k++) {
        const side = k % 2;
        box[side] = Math.min(box[side], numbers[k]);
        box[side + 2] = Math.max(box[side + 2], numbers[k]);
    }
    return box;
}

/**
 * Whether the ends and the middles of some segments lie on others.
 *
 * Ends alone would take two sides of a triangle for the third; how the others are divided does not matter.
 *
 * @param {ArrayLike<number>} some
 * @param {ArrayLike<number>} others
 * @param {number} close
 * @returns {boolean}
 */
function liesOn(some, others, close) {
    for (let k = 0; k < some.length; k += 4) {
        const [x0, y0, x1, y1] = [some[k], some[k + 1], some[k + 2], some[k + 3]];
        for (const point of /** @type {Point[]} */ ([[x0, y0], [(x0 + x1) / 2, (y0 + y1) / 2], [x1, y1]])) {
            if (!isNear(point, others, close)) return false;
        }
    }
    return true;
}

/**
 * Whether a point is near one of some segments.
 *
 * @type {(z: Point, segments: ArrayLike<number>, near: number) => boolean}
 */
function isNear(z, segments, near) {
    for (let k = 0; k < segments.length; k += 4) {
        if (segmentDistance(z, segments, k) <= near) return true;
    }
    return false;
}

/**
 * The distance of a point from the segment whose numbers begin at k.
 *
 * @param {Point} z
 * @param {ArrayLike<number>} segments
 * @param {number} k
 * @returns {number}
 */
export function segmentDistance([x, y], segments, k) {
    const [x0, y0] = [segments[k], segments[k + 1]];
    const [dx, dy] = [segments[k + 2] - x0, segments[k + 3] - y0];
    const square = dx * dx + dy * dy;
    const t = square ? Math.min(1, Math.max(0, ((x - x0) * dx + (y - y0) * dy) / square)) : 0;
    return Math.hypot(x - x0 - t * dx, y - y0 - t * dy);
}
