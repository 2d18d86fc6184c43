// @ts-check
/**
 * The group of a design acting on its drawing: the lattice, the motions, the symmetry elements.
 *
 * Everything about the groups comes from the server's tables; here it is laid over the cell. All coordinates are the
 * drawing's: before the `scale` of the design.
 */

import { across, cartesian, cellArea, clip, imagesIn, marginOf } from "./lattice.js";
import { apply, length, nearestUnit, plus, scaled, unitAt } from "./plane.js";

export { cosets } from "./copies.js";
export { fold, orbitIn } from "./lattice.js";

/** @import { Box, Point } from "./plane.js" */
/** @typedef {import("./lattice.js").Lattice} Lattice */
/** @import { Design } from "./design.js" */
/** @typedef {import("./plane.js").Similarity} Motion a motion of the group */

/** @typedef {{name: string, w: [number, number, number, number], t: Point}} Operation in fractional coordinates */
/** @typedef {{through: Point, along: Point}} TableLine a mirror or glide line in fractional coordinates */

/**
 * A wallpaper group as the server describes it; coordinates are fractional.
 * @typedef {object} GroupTable
 * @property {string} name
 * @property {string} title what it does, in words
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

/** So many cells in a box are too small to be looked at one by one. */
const CELLS_MAX = 2500;

/**
 * The table of a design's group; that of p1 for a group that there is not.
 * @type {(design: Design, tables: Tables) => GroupTable}
 */
export function groupOf(design, tables) {
    return tables.groups.find((group) => group.name === design.group) ?? tables.groups[0];
}

/**
 * The lattice of a design. What the cell lacks is taken from a square.
 * @type {(design: Design, tables: Tables) => Lattice}
 */
export function latticeOf({ group, cell }, tables) {
    const { free, angle } = groupOf(/** @type {Design} */ ({ group }), tables);
    const side = free.includes("b") ? (cell.b ?? cell.a) : cell.a;
    return { a: [cell.a, 0], b: scaled(unitAt(angle ?? cell.angle ?? 90), side) };
}

/** The image of a point under a motion. @type {(motion: Motion, at: Point) => Point} */
export const moved = apply;

/**
 * The motions of the group in one cell, the identity first: those of its table's operations, in their order.
 * @type {(design: Design, tables: Tables) => Motion[]}
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
 * The symmetry elements of a design's group in a box; none where the box has too many cells to show them.
 * @type {(design: Design, tables: Tables, box: Box) => Elements}
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

/** One asymmetric unit of a design's group: its corners. @type {(design: Design, tables: Tables) => Point[]} */
export function regionOf(design, tables) {
    const lattice = latticeOf(design, tables);
    return groupOf(design, tables).region.map((corner) => cartesian(lattice, corner));
}

/**
 * The pieces in a box of a line and its images under the lattice.
 * @param {Lattice} lattice
 * @param {TableLine} line its direction is a shortest lattice vector p a + q b
 * @param {Box} box
 * @returns {Line[]}
 */
function linesIn(lattice, { through, along: [p, q] }, box) {
    const along = cartesian(lattice, [p, q]);
    const margin = marginOf(box);
    // The cross product of `along` with the points of a line is -det times q x - p y, to which a translation adds an
    // integer.
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
 * @type {(p: number, q: number) => [number, number]}
 */
function unitStep(p, q) {
    for (let i = 0; p !== 0 && i < Math.abs(p); i++) {
        if ((q * i - 1) % p === 0) return [i, (q * i - 1) / p];
    }
    return [q, 0];
}
