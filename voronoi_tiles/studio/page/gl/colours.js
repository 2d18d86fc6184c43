// @ts-check
/** Which colour a copy has: from a colouring of the server, in which neighbours differ, or by site and motion. */

/** @typedef {import("./pattern.js").Basis} Basis */
/** @typedef {[number, number, number]} Colour Red, green, blue, 0 to 1. */
/**
 * @typedef {object} Colouring Copy (placement, i, j) has the colour at its place in a repeat of some cells.
 * @property {[[number, number], [number, number]]} rows The place is rows (i, j)^T modulo m and n.
 * @property {number} m
 * @property {number} n
 * @property {number[][][]} colour Numbers from 0, by placement and place.
 */
/**
 * @typedef {object} Colours A colouring over some basis, flat.
 * @property {[number, number, number, number]} rows
 * @property {number} m
 * @property {number} n
 * @property {number[]} colour
 * @property {[number, number]} period How many cells along both vectors make all repeat.
 */

// The "light" scheme for filled areas of P. Tol, "Colour Schemes" (SRON/EPS/TN/09-002), without olive: different also
// to eyes that confuse colours, the first ones most. The dark ones have the same hues at 0.62 of the lightness (OKLab).
const LIGHT = ["77aadd", "ee8866", "eedd88", "99ddff", "ffaabb", "bbcc33", "44bb99", "dddddd"].map(parsed);
const DARK = ["265885", "90330f", "837316", "327695", "964b5d", "616c00", "00674a", "737373"].map(parsed);

/**
 * @param {string} hex
 * @returns {Colour}
 */
function parsed(hex) {
    const value = Number.parseInt(hex, 16);
    return [(value >> 16) / 255, ((value >> 8) & 255) / 255, (value & 255) / 255];
}

/** Colours of the palette; further ones are the same, darker from round to round. */
export const PALETTE_SIZE = LIGHT.length;

/**
 * Colour number k of tiles.
 * @param {number} k
 * @param {boolean} dark
 * @returns {Colour}
 */
export function tileColour(k, dark) {
    const [r, g, b] = (dark ? DARK : LIGHT)[k % PALETTE_SIZE];
    const left = Math.max(0.4, 1 - 0.2 * Math.floor(k / PALETTE_SIZE));
    return [left * r, left * g, left * b];
}

/**
 * What is drawn around tiles: borders, strokes, and what belongs to nobody because copies touch.
 * @param {boolean} dark
 * @returns {{border: Colour, stroke: Colour, nobody: Colour, background: Colour}}
 */
export function inks(dark) {
    const nobody = dark ? 0.3 : 0.6;
    return {
        border: dark ? [0.07, 0.07, 0.09] : [0.15, 0.13, 0.16],
        stroke: dark ? [0.95, 0.95, 0.97] : [0.15, 0.13, 0.16],
        nobody: [nobody, nobody, nobody],
        background: dark ? [0.11, 0.11, 0.13] : [1, 1, 1],
    };
}

/**
 * The colours of all copies, (i, j) counted in a basis. A colouring that is not of these placements is left out.
 * @param {Colouring | null | undefined} colouring Counts (i, j) in the lattice's own vectors.
 * @param {number} placements
 * @param {[[number, number], [number, number]]} basis The basis' integers over those vectors.
 * @returns {Colours}
 */
export function coloursOf(colouring, placements, basis) {
    const known = colouring && fits(colouring, placements) ? colouring : bySite(placements);
    const [[a, b], [c, d]] = known.rows;
    const [p, q] =
        known === colouring
            ? basis
            : [
                  [1, 0],
                  [0, 1],
              ];
    /** @type {[number, number, number, number]} */
    const rows = [a * p[0] + b * p[1], a * q[0] + b * q[1], c * p[0] + d * p[1], c * q[0] + d * q[1]];
    const { m, n } = known;
    return {
        rows,
        m,
        n,
        colour: known.colour.flat(2),
        period: [together(turns(rows[0], m), turns(rows[2], n)), together(turns(rows[1], m), turns(rows[3], n))],
    };
}

/**
 * The number of a copy's colour.
 * @param {Colours} colours
 * @param {number} placement
 * @param {number} i
 * @param {number} j
 */
export function colourAt({ rows, m, n, colour }, placement, i, j) {
    const x = modulo(rows[0] * i + rows[1] * j, m);
    const y = modulo(rows[2] * i + rows[3] * j, n);
    return colour[(placement * m + x) * n + y];
}

/**
 * @param {Colouring} colouring
 * @param {number} placements
 */
function fits({ m, n, colour }, placements) {
    return (
        colour.length === placements &&
        colour.every((columns) => columns.length === m && columns.every((places) => places.length === n))
    );
}

/**
 * One colour for each placement. Where there are one or two, many neighbours are translates of each other: those of
 * i + 2j modulo 4 differ from all eight about them, in a basis whose cells are compact.
 * @param {number} placements
 * @returns {Colouring}
 */
function bySite(placements) {
    const m = placements > 2 ? 1 : 4;
    const colour = Array.from({ length: placements }, (_, k) => Array.from({ length: m }, (_, x) => [k * m + x]));
    return {
        rows: [
            [1, 2],
            [0, 0],
        ],
        m,
        n: 1,
        colour,
    };
}

/**
 * The remainder that is not negative.
 * @param {number} value
 * @param {number} by
 */
export function modulo(value, by) {
    return ((value % by) + by) % by;
}

/**
 * How often a step is taken until it is 0 modulo `by`.
 * @param {number} step
 * @param {number} by
 */
function turns(step, by) {
    return by / divisor(modulo(step, by), by);
}

/**
 * The least common multiple.
 * @param {number} x
 * @param {number} y
 */
function together(x, y) {
    return (x / divisor(x, y)) * y;
}

/**
 * The greatest common divisor; of 0 and y it is y.
 * @param {number} x
 * @param {number} y
 * @returns {number}
 */
function divisor(x, y) {
    return x === 0 ? y : divisor(y % x, x);
}
