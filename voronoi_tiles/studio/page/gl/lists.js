// @ts-check
/**
 * Which elements can matter in each block of an image of the plane: exact candidate lists.
 *
 * At a point c let D_X be the distance of copy X, m1 and m2 the smallest two. Distances are 1-Lipschitz, and so are m1
 * and m2: within radius r of c a copy can be nearest, or nearest of another copy than the nearest, only if
 * D_X <= m2 + 2r, and it can come within `band` of the nearest only if D_X <= m1 + 2r + band. Of a copy's elements
 * those are left out that are farther everywhere in the disc than the one, e, that is nearest at c: an element's
 * distance is convex, so at least d + g.(p - c) with its gradient g at c, and that of e is at most
 * D + G.(p - c) + r^2 / 2D; so where d - D > |g - G| r + r^2 / 2D.
 *
 * The plane is periodic: lists are made for parts of one cell, and a block takes those of the part that its centre
 * falls into when it is moved by whole cells. Everything here is float64, in the units of the drawing; what goes to
 * the shader is counted in pixels from the centre of its block, where float32 suffices however far away that is.
 */

import { gather, grown, square } from "./pattern.js";

/** @typedef {import("./pattern.js").Elements} Elements */
/** @typedef {import("./pattern.js").Pattern} Pattern */
/** @typedef {import("./pattern.js").Point} Point */
/**
 * @typedef {object} Frame A grid of samples: sample (i, j) at origin + i u + j v, lengths in pixels of 1 / scale.
 * @property {Point} origin
 * @property {Point} u
 * @property {Point} v
 * @property {number} width
 * @property {number} height
 * @property {number} scale
 */

/** Keeps what rounding would drop; far above float64 and far below what costs time. */
const SLACK = 1 + 1e-9;
/** Rounds of loops in one run of a shader, all together, after which Mesa's software renderer ends them in silence. */
const ROUNDS = 65535;
/** Elements of a site from which the first bound is taken, at most. */
const FEW = 48;
let reals = new Float64Array(4 * 1024);
let runEnds = new Int32Array(1024);
let nearest = new Float64Array(1024);

/**
 * Of a list of elements, keep what can matter within a radius of (cx, cy).
 * @param {Elements} elements
 * @param {Int32Array} list Its entries from `first` up to `last`.
 * @param {number} first
 * @param {number} last
 * @param {number} cx
 * @param {number} cy
 * @param {number} radius
 * @param {number} band
 * @param {Int32Array} kept Takes them, from entry `end` on; long enough for all.
 * @param {number} end
 * @returns {number} The new end.
 */
function keep(elements, list, first, last, cx, cy, radius, band, kept, end) {
    const { ends, copy } = elements;
    const size = last - first;
    if (runEnds.length < size) {
        reals = new Float64Array(8 * size);
        runEnds = new Int32Array(2 * size);
        nearest = new Float64Array(2 * size);
    }
    let runs = 0;
    let m1 = Infinity;
    let m2 = Infinity;
    for (let k = 0; k < size;) {
        const name = copy[list[first + k]];
        let least = Infinity;
        for (; k < size && copy[list[first + k]] === name; k++) {
            const e = 4 * list[first + k];
            let x = cx - ends[e];
            let y = cy - ends[e + 1];
            const hx = ends[e + 2];
            const hy = ends[e + 3];
            let share = (x * hx + y * hy) / Math.max(hx * hx + hy * hy, 1e-300);
            share = share > 1 ? 1 : share < -1 ? -1 : share;
            x -= share * hx;
            y -= share * hy;
            const distance = Math.sqrt(x * x + y * y);
            reals[4 * k] = distance;
            reals[4 * k + 1] = x;
            reals[4 * k + 2] = y;
            if (distance < least) least = distance;
        }
        if (least < m1) {
            m2 = m1;
            m1 = least;
        } else if (least < m2) m2 = least;
        nearest[runs] = least;
        runEnds[runs++] = k;
    }
    const far = Math.max(m2, m1 + band) * SLACK + 2 * radius * SLACK;
    const beyond = 2 * radius * SLACK;
    for (let run = 0, start = 0; run < runs; start = runEnds[run++]) {
        const least = nearest[run];
        if (!(least <= far)) continue;
        const stop = runEnds[run];
        let winner = start;
        while (reals[4 * winner] !== least) winner++;
        const scale = least > 0 ? 1 / least : 1;
        const gx = reals[4 * winner + 1] * scale;
        const gy = reals[4 * winner + 2] * scale;
        const bend = least > 0 ? (radius * radius) / (2 * least) : Infinity;
        for (let k = start; k < stop; k++) {
            const distance = reals[4 * k];
            const excess = distance - least - (SLACK - 1) * (distance + radius);
            if (excess > beyond) continue;
            // |g - G| r >= excess - bend, times the distance, and squared where the right side is positive.
            const behind = excess > bend ? (excess - bend) * distance : 0;
            const tx = reals[4 * k + 1] - gx * distance;
            const ty = reals[4 * k + 2] - gy * distance;
            if ((tx * tx + ty * ty) * radius * radius >= behind * behind) kept[end++] = list[first + k];
        }
    }
    return end;
}

/** Lists for side x side parts of the cell of the basis: good for discs of `radius` whose centres are in the part. */
export class CellLists {
    /**
     * @param {Pattern} pattern Not empty.
     * @param {number} radius
     * @param {number} band
     * @param {number} discs About how many discs the lists will serve in each cell.
     */
    constructor(pattern, radius, band, discs) {
        const { p, q } = pattern.basis;
        this.pattern = pattern;
        this.radius = radius;
        this.band = band;
        /** How far the corners of the cell are from its middle. */
        const diagonal = Math.max(Math.hypot(p[0] + q[0], p[1] + q[1]), Math.hypot(p[0] - q[0], p[1] - q[1])) / 2;
        /** @type {Point} */
        const centre = [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2];
        const reach = pattern.reach + diagonal + radius + band;
        const some = gather(pattern, centre, reach, FEW);
        const near = new Float64Array(some.copies.length / 3).fill(Infinity);
        for (let k = 0; k < some.count; k++) {
            const e = 4 * k; // no array of the four: there are thousands
            const [x, y] = [centre[0] - some.ends[e], centre[1] - some.ends[e + 1]];
            const distance = Math.sqrt(square(x, y, some.ends[e + 2], some.ends[e + 3]));
            near[some.copy[k]] = Math.min(near[some.copy[k]], distance);
        }
        near.sort();
        const enough = Math.max(near[1], near[0] + band) + 2 * (diagonal + radius);
        this.elements = gather(pattern, centre, Math.min(reach, enough * SLACK));

        this.side = 1;
        this.list = Int32Array.from({ length: this.elements.count }, (_, k) => k);
        this.start = Int32Array.of(0, this.elements.count);
        // Parts that are smaller than what they serve, or serve few, are not worth their making.
        for (const side of [4, 16]) {
            if (4 * side * side > 3 * discs || diagonal / side < radius / 2) break;
            this.#split(side, diagonal / side + radius);
        }
    }

    /**
     * Make the lists of smaller parts, of those of the parts that they lie in.
     * @param {number} side
     * @param {number} radius
     */
    #split(side, radius) {
        const { p, q } = this.pattern.basis;
        const start = new Int32Array(side * side + 1);
        let list = new Int32Array(4096);
        let end = 0;
        for (let j = 0, part = 0; j < side; j++) {
            for (let i = 0; i < side; i++, part++) {
                const parent = Math.floor((j * this.side) / side) * this.side + Math.floor((i * this.side) / side);
                const [first, last] = [this.start[parent], this.start[parent + 1]];
                if (list.length < end + last - first) list = grown(list, 2 * (end + last - first));
                const [s, t] = [(i + 0.5) / side, (j + 0.5) / side];
                const [x, y] = [s * p[0] + t * q[0], s * p[1] + t * q[1]];
                end = keep(this.elements, this.list, first, last, x, y, radius, this.band, list, end);
                start[part + 1] = end;
            }
        }
        this.side = side;
        this.list = list;
        this.start = start;
    }
}

/** The lists of an image's blocks as the shader reads them; one object serves many images, its arrays only grow. */
export class BlockLists {
    constructor() {
        this.columns = 0;
        /** Four numbers of each block: first run, runs, and the cells (i, j) that its copies are moved by. */
        this.blocks = new Int32Array(4096);
        /** Four numbers of each run: first element, elements, copy, 0. */
        this.runs = new Int32Array(4096);
        /** Four numbers of each element: middle from the block's centre, half vector, in pixels. */
        this.elements = new Float32Array(16384);
        this.counts = { blocks: 0, runs: 0, elements: 0 };
        this.kept = new Int32Array(1024);
    }

    /**
     * Make the lists of a frame's blocks. Block (I, J) has its samples about its own, number block / 2 both ways.
     * @param {CellLists} cell Of a radius not below `blockRadius(frame, block)`.
     * @param {Frame} frame
     * @param {number} block Samples along a block's side.
     */
    fill(cell, frame, block) {
        const { pattern, elements, list, start, side, band } = cell;
        const { p, q } = pattern.basis;
        const { origin, u, v, scale } = frame;
        const radius = blockRadius(frame, block);
        const rows = Math.ceil(frame.height / block);
        this.columns = Math.ceil(frame.width / block);
        if (this.blocks.length < 4 * rows * this.columns) this.blocks = new Int32Array(4 * rows * this.columns);
        let [at, runs, count] = [0, 0, 0];
        for (let row = 0; row < rows; row++) {
            for (let column = 0; column < this.columns; column++, at += 4) {
                const [i, j] = [(column + 0.5) * block, (row + 0.5) * block];
                const x = origin[0] + i * u[0] + j * v[0];
                const y = origin[1] + i * u[1] + j * v[1];
                const [s, t] = pattern.fractional(x, y);
                const [across, up] = [Math.floor(s), Math.floor(t)];
                // Rounding can make of a fraction just below 1 the side itself.
                const part =
                    Math.min(Math.floor((t - up) * side), side - 1) * side +
                    Math.min(Math.floor((s - across) * side), side - 1);
                const [cx, cy] = [x - across * p[0] - up * q[0], y - across * p[1] - up * q[1]];
                const [first, last] = [start[part], start[part + 1]];
                if (this.kept.length < last - first) this.kept = new Int32Array(2 * (last - first));
                const size = keep(elements, list, first, last, cx, cy, radius, band, this.kept, 0);
                if (this.elements.length < 4 * (count + size)) this.elements = grown(this.elements, 8 * (count + size));
                if (this.runs.length < 4 * (runs + size)) this.runs = grown(this.runs, 8 * (runs + size));
                const before = runs;
                for (let k = 0, name = -1; k < size; k++, count++) {
                    const e = this.kept[k];
                    if (elements.copy[e] !== name) {
                        name = elements.copy[e];
                        this.runs[4 * runs] = count;
                        this.runs[4 * runs + 1] = 0;
                        this.runs[4 * runs + 2] = name;
                        runs++;
                    }
                    this.runs[4 * runs - 3]++;
                    this.elements[4 * count] = (elements.ends[4 * e] - cx) * scale;
                    this.elements[4 * count + 1] = (elements.ends[4 * e + 1] - cy) * scale;
                    this.elements[4 * count + 2] = elements.ends[4 * e + 2] * scale;
                    this.elements[4 * count + 3] = elements.ends[4 * e + 3] * scale;
                }
                // Both of the shader's passes go through all; a round each for a loop's beginning and end.
                if (2 * size + 5 * (runs - before) > ROUNDS) throw new RangeError("too many strokes lie about a point");
                this.blocks[at] = before;
                this.blocks[at + 1] = runs - before;
                this.blocks[at + 2] = across;
                this.blocks[at + 3] = up;
            }
        }
        this.counts = { blocks: at / 4, runs, elements: count };
    }
}

/**
 * How far a block's samples are from its centre at most, in units.
 * @param {Frame} frame
 * @param {number} block
 */
export function blockRadius({ u, v }, block) {
    const [sum, difference] = [Math.hypot(u[0] + v[0], u[1] + v[1]), Math.hypot(u[0] - v[0], u[1] - v[1])];
    return (block / 2) * Math.max(sum, difference);
}
