// @ts-check
/** The drawing as a periodic set of elements, segments and points, in float64 and the units of the drawing. */

import { cellArea, reduced } from "../model/lattice.js";

/** @typedef {import("../model/plane.js").Point} Point */
/** @typedef {import("../model/plane.js").Similarity} Motion */
/** @typedef {import("../model/lattice.js").Basis} Basis */
/** @typedef {import("../model/lattice.js").Lattice} Lattice */
/** @typedef {{segments: Float64Array, cosets: number[]}} Site Segments x0, y0, x1, y1; motions that differ on it. */

/** Most elements about a cell. Beyond, a picture takes seconds: there is none. */
const MOST = 2_000_000;

/**
 * The shortest basis of a lattice; null where it has no area.
 * @param {Lattice} lattice
 * @returns {Basis | null}
 */
export function reducedBasis(lattice) {
    const isOne = cellArea(lattice) > 0 && [...lattice.a, ...lattice.b].every(Number.isFinite);
    return isOne ? reduced(lattice) : null;
}

/** The copies of sites: those that are no translates of each other, and the lattice. */
export class Pattern {
    /**
     * @param {Basis} basis
     * @param {Motion[]} motions
     * @param {Site[]} sites Elements that are not finite are left out.
     */
    constructor(basis, motions, sites) {
        const { p, q } = basis;
        this.basis = basis;
        this.det = p[0] * q[1] - p[1] * q[0];
        /** Site and motion of each placement, in the order of the sites and their cosets; and its elements. */
        this.placements = sites.flatMap(({ segments, cosets }, site) =>
            cosets.map((motion) => ({ site, motion, elements: moved(segments, motions[motion]) })),
        );
        /** No point lies farther from a copy of some node than half the diagonal, the next copy another p away. */
        this.reach = Math.hypot(...p, ...q) / 2 + Math.hypot(...p);
    }

    /** Whether there is nothing to draw. */
    get empty() {
        return this.placements.every(({ elements }) => elements.length === 0);
    }

    /**
     * A point in the basis.
     * @param {number} x
     * @param {number} y
     * @returns {Point}
     */
    fractional(x, y) {
        const { p, q } = this.basis;
        return [(x * q[1] - y * q[0]) / this.det, (p[0] * y - p[1] * x) / this.det];
    }
}

/**
 * Elements as middle and half vector: mx, my, hx, hy of each.
 * @param {Float64Array} segments
 * @param {Motion} motion
 */
function moved(segments, { a, b, conj }) {
    const sign = conj ? -1 : 1;
    const elements = new Float64Array(segments.length);
    let n = 0;
    for (let k = 0; k + 3 < segments.length; k += 4) {
        const mx = (segments[k] + segments[k + 2]) / 2;
        const my = (sign * (segments[k + 1] + segments[k + 3])) / 2;
        const hx = (segments[k + 2] - segments[k]) / 2;
        const hy = (sign * (segments[k + 3] - segments[k + 1])) / 2;
        if (!Number.isFinite(mx + my + hx + hy)) continue;
        elements[n++] = a[0] * mx - a[1] * my + b[0];
        elements[n++] = a[0] * my + a[1] * mx + b[1];
        elements[n++] = a[0] * hx - a[1] * hy;
        elements[n++] = a[0] * hy + a[1] * hx;
    }
    return elements.subarray(0, n);
}

/** Copies of elements: mx, my, hx, hy of each and its copy, those of a copy together; a copy is placement, i, j. */
export class Elements {
    constructor() {
        this.count = 0;
        this.ends = new Float64Array(4096);
        this.copy = new Int32Array(1024);
        /** @type {number[]} */
        this.copies = [];
    }

    /**
     * @param {number} mx
     * @param {number} my
     * @param {number} hx
     * @param {number} hy
     * @param {number} copy
     */
    add(mx, my, hx, hy, copy) {
        if (this.count === this.copy.length) {
            this.ends = grown(this.ends, 8 * this.count);
            this.copy = grown(this.copy, 2 * this.count);
        }
        const k = 4 * this.count;
        this.ends[k] = mx;
        this.ends[k + 1] = my;
        this.ends[k + 2] = hx;
        this.ends[k + 3] = hy;
        this.copy[this.count++] = copy;
    }
}

/**
 * The copies of elements within a reach of a point.
 * @param {Pattern} pattern
 * @param {Point} centre
 * @param {number} reach
 * @param {number} [most] Only so many elements of each site, evenly chosen.
 */
export function gather(pattern, [cx, cy], reach, most = Infinity) {
    const { p, q } = pattern.basis;
    const found = new Elements();
    pattern.placements.forEach(({ elements }, placement) => {
        const step = 4 * Math.max(1, Math.ceil(elements.length / 4 / most));
        let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
        for (let k = 0; k < elements.length; k += 4) {
            const [across, up] = [Math.abs(elements[k + 2]), Math.abs(elements[k + 3])];
            x0 = Math.min(x0, elements[k] - across);
            x1 = Math.max(x1, elements[k] + across);
            y0 = Math.min(y0, elements[k + 1] - up);
            y1 = Math.max(y1, elements[k + 1] + up);
        }
        if (!(x1 >= x0)) return;
        // The translates of the circle about all of them that come near.
        const room = reach + Math.hypot(x1 - x0, y1 - y0) / 2;
        const [s, t] = pattern.fractional(cx - (x0 + x1) / 2, cy - (y0 + y1) / 2);
        const width = (room * Math.hypot(...q)) / pattern.det;
        const height = (room * Math.hypot(...p)) / pattern.det;
        for (let i = Math.ceil(s - width); i <= s + width; i++) {
            for (let j = Math.ceil(t - height); j <= t + height; j++) {
                const [dx, dy] = [i * p[0] + j * q[0], i * p[1] + j * q[1]];
                const copy = found.copies.length / 3;
                const before = found.count;
                for (let k = 0; k < elements.length; k += step) {
                    const mx = elements[k] + dx;
                    const my = elements[k + 1] + dy;
                    const hx = elements[k + 2];
                    const hy = elements[k + 3];
                    if (square(cx - mx, cy - my, hx, hy) <= reach * reach) found.add(mx, my, hx, hy, copy);
                }
                if (found.count > before) found.copies.push(placement, i, j);
                if (found.count > MOST) throw new RangeError(`more than ${MOST} copies of strokes lie about the cell`);
            }
        }
    });
    return found;
}

/**
 * The square of the distance of a point from a segment, that leads (x, y) away from its middle.
 * @param {number} x
 * @param {number} y
 * @param {number} hx
 * @param {number} hy
 */
export function square(x, y, hx, hy) {
    const share = Math.max(-1, Math.min(1, (x * hx + y * hy) / Math.max(hx * hx + hy * hy, 1e-300)));
    const dx = x - share * hx;
    const dy = y - share * hy;
    return dx * dx + dy * dy;
}

/**
 * A longer array of the same kind with the same beginning.
 * @template {Int32Array | Float32Array | Float64Array} T
 * @param {T} array
 * @param {number} length
 * @returns {T}
 */
export function grown(array, length) {
    const longer = /** @type {T} */ (new /** @type {any} */ (array.constructor)(length));
    longer.set(array);
    return longer;
}
