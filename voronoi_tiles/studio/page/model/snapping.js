// @ts-check
/** Points that the pointer is drawn to: symmetry elements, nodes, the grid. */

import { cross, distance, dot, fixed, length, minus, plus, scaled } from "./plane.js";

/** @import { Point } from "./plane.js" */
/** @import { Elements, Line } from "./symmetry.js" */
/** @typedef {"node" | "centre" | "origin" | "mirror" | "glide" | "grid" | "join"} SnapKind */
/** @typedef {{at: Point, kind: SnapKind, label: string, onto?: import("./design.js").NodeRef}} Snapped onto: a node that is joined */

/** @type {Readonly<Record<number, string>>} */
const CENTRES = {
    2: "centre of half turns",
    3: "centre of third turns",
    4: "centre of quarter turns",
    6: "centre of sixth turns",
};

/**
 * @typedef {object} Attractions
 * @property {Elements} [elements] those near the point
 * @property {readonly Point[]} [nodes]
 * @property {number | null} [grid] the distance of its lines
 * @property {number} reach
 */

/**
 * The point that a point is drawn to, null where nothing is within reach.
 *
 * Single points come first, the nearest of them; then where two lines cross, then lines, then the grid.
 * @type {(at: Point, to: Attractions) => Snapped | null}
 */
export function snap(at, { elements = { centres: [], mirrors: [], glides: [] }, nodes = [], grid = null, reach }) {
    /** @type {Snapped[]} */
    const points = [
        ...nodes.map((node) => ({ at: node, kind: /** @type {const} */ ("node"), label: "point" })),
        ...elements.centres.map(({ at: centre, order }) => ({
            at: centre,
            kind: /** @type {const} */ ("centre"),
            label: CENTRES[order] ?? "centre",
        })),
        { at: [0, 0], kind: "origin", label: "origin" },
    ];
    const lines = [
        ...elements.mirrors.map((line) => ({ line, kind: /** @type {const} */ ("mirror"), label: "mirror" })),
        ...elements.glides.map((line) => ({ line, kind: /** @type {const} */ ("glide"), label: "glide line" })),
    ];
    const feet = lines.map(({ line, kind, label }) => ({ at: footOn(line, at), kind, label }));
    const near = lines.filter((_, k) => distance(feet[k].at, at) <= reach);
    const crossings = near.flatMap(({ line, kind, label }, k) =>
        near.slice(k + 1).flatMap((other) => {
            const crossing = crossingOf(line, other.line);
            return crossing
                ? [{ at: crossing, kind, label: label === other.label ? `${label}s` : `${label}, ${other.label}` }]
                : [];
        }),
    );
    const gridded = grid ? [{ at: onGrid(at, grid), kind: /** @type {const} */ ("grid"), label: "grid" }] : [];
    for (const choices of [points, crossings, feet, gridded]) {
        const found = nearest(choices, at, reach);
        if (found) return { ...found, at: tidy(found.at) };
    }
    return null;
}

/** A point without what rounding leaves beyond 14 digits of its larger coordinate. @type {(at: Point) => Point} */
function tidy(at) {
    const digits = 13 - Math.floor(Math.log10(Math.max(Math.abs(at[0]), Math.abs(at[1]), 1e-9)));
    return fixed(at, Math.max(0, digits));
}

/**
 * The nearest within reach; of two the first.
 * @type {(choices: Snapped[], at: Point, reach: number) => Snapped | null}
 */
function nearest(choices, at, reach) {
    /** @type {Snapped | null} */
    let best = null;
    for (const choice of choices) {
        const away = distance(choice.at, at);
        if (away <= reach && !(best && distance(best.at, at) <= away)) best = choice;
    }
    return best;
}

/** The point of a line that is nearest to a point. @type {(line: Line, at: Point) => Point} */
function footOn([start, end], at) {
    const along = minus(end, start);
    return plus(start, scaled(along, dot(minus(at, start), along) / dot(along, along)));
}

/** Where two lines cross. @type {(one: Line, other: Line) => Point | null} */
function crossingOf([start, end], [start2, end2]) {
    const [along, other] = [minus(end, start), minus(end2, start2)];
    const sine = cross(along, other);
    if (Math.abs(sine) <= 1e-9 * length(along) * length(other)) return null;
    return plus(start, scaled(along, cross(minus(start2, start), other) / sine));
}

/** The nearest point of a grid, without what binary fractions leave. @type {(at: Point, grid: number) => Point} */
const onGrid = ([x, y], grid) => [onMultiple(x, grid), onMultiple(y, grid)];

/** The nearest multiple of a number. @type {(value: number, step: number) => number} */
const onMultiple = (value, step) => Number((Math.round(value / step) * step).toPrecision(15)) + 0;

/**
 * A point with no more digits than a pixel is worth: what a hand draws is written short.
 * @param {Point} at
 * @param {number} pixel the size of a pixel in the drawing
 * @returns {Point}
 */
export const rounded = (at, pixel) => onGrid(at, 10 ** Math.floor(Math.log10(pixel)));
