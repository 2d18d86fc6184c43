// @ts-check
/** The point of a curve that is nearest to another one. */

/** @import { Point } from "./plane.js" */

/**
 * @typedef {{piece: number, t: number, at: Point, distance: number}} Nearest on which piece, where on it, how far away
 */

/** Places on each piece that the search begins with. */
const SAMPLES = 24;

/** Steps of the golden section: enough for 1e-11 of a piece. */
const STEPS = 48;

const GOLDEN = (Math.sqrt(5) - 1) / 2;

/**
 * The nearest point of cubic pieces, 8 numbers each; null where there are none, or all are farther than `reach`.
 *
 * Each piece is sampled, and the distance made least about every sample that is nearer than its neighbours.
 * @type {(cubics: Float64Array, at: Point, reach?: number) => Nearest | null}
 */
export function nearestOn(cubics, at, reach = Infinity) {
    /** @type {Nearest | null} */
    let best = null;
    for (let piece = 0; 8 * piece < cubics.length; piece++) {
        const limit = best ? best.distance : reach;
        if (boxDistance(cubics, piece, at) > limit) continue;
        const found = nearestOnPiece(cubics, piece, at);
        if (found.distance <= limit && !(best && found.distance === best.distance)) best = found;
    }
    return best;
}

/** The nearest point of one piece. @type {(cubics: Float64Array, piece: number, at: Point) => Nearest} */
function nearestOnPiece(cubics, piece, at) {
    const distanceAt = (/** @type {number} */ t) => {
        const [x, y] = pointOn(cubics, piece, t);
        return Math.hypot(x - at[0], y - at[1]);
    };
    const samples = Array.from({ length: SAMPLES + 1 }, (_, k) => distanceAt(k / SAMPLES));
    const lows = samples.flatMap((away, k) =>
        away <= (samples[k - 1] ?? away) && away <= (samples[k + 1] ?? away) ? [k] : [],
    );
    const found = lows.map((k) =>
        leastBetween(distanceAt, Math.max(0, k - 1) / SAMPLES, Math.min(SAMPLES, k + 1) / SAMPLES),
    );
    // An end is met exactly.
    const t = [0, 1, ...found].reduce((p, q) => (distanceAt(p) <= distanceAt(q) ? p : q));
    return { piece, t, at: pointOn(cubics, piece, t), distance: distanceAt(t) };
}

/**
 * Where a function is least in an interval in which it falls and then rises.
 * @type {(f: (t: number) => number, low: number, high: number) => number}
 */
function leastBetween(f, low, high) {
    let [one, other] = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let [left, right] = [f(one), f(other)];
    for (let step = 0; step < STEPS; step++) {
        if (left <= right) {
            [high, other, right] = [other, one, left];
            one = high - GOLDEN * (high - low);
            left = f(one);
        } else {
            [low, one, left] = [one, other, right];
            other = low + GOLDEN * (high - low);
            right = f(other);
        }
    }
    return (low + high) / 2;
}

/** The point at a parameter of a piece. @type {(cubics: Float64Array, piece: number, t: number) => Point} */
export function pointOn(cubics, piece, t) {
    const [s, k] = [1 - t, 8 * piece];
    const [a, b, c, d] = [s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t];
    return [
        a * cubics[k] + b * cubics[k + 2] + c * cubics[k + 4] + d * cubics[k + 6],
        a * cubics[k + 1] + b * cubics[k + 3] + c * cubics[k + 5] + d * cubics[k + 7],
    ];
}

/**
 * The distance of a point from the box around the control points of a piece, inside which it lies.
 * @type {(cubics: Float64Array, piece: number, at: Point) => number}
 */
function boxDistance(cubics, piece, at) {
    const away = [0, 1].map((axis) => {
        const values = [0, 2, 4, 6].map((k) => cubics[8 * piece + k + axis]);
        return Math.max(Math.min(...values) - at[axis], at[axis] - Math.max(...values), 0);
    });
    return Math.hypot(away[0], away[1]);
}
