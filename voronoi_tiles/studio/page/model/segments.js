// @ts-check
/** Segments, 4 numbers each: x0, y0, x1, y1; a point is one whose ends are equal. */

import { apply, cross, minus } from "./plane.js";

/** @import { Box, Point, Similarity } from "./plane.js" */

/**
 * The images of points, two numbers each: of segments, or of the control points of pieces.
 * @type {(map: Readonly<Similarity>, numbers: ArrayLike<number>) => Float64Array}
 */
export function mapped(map, numbers) {
    const image = new Float64Array(numbers.length);
    for (let k = 0; k < numbers.length; k += 2) {
        const z = apply(map, [numbers[k], numbers[k + 1]]);
        image[k] = z[0];
        image[k + 1] = z[1];
    }
    return image;
}

/** The smallest box around points, two numbers each. @type {(numbers: ArrayLike<number>) => Box} */
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
 * The distance of a point from the segment whose numbers begin at k.
 * @type {(z: Point, segments: ArrayLike<number>, k: number) => number}
 */
export function segmentDistance([x, y], segments, k) {
    const [x0, y0] = [segments[k], segments[k + 1]];
    const [dx, dy] = [segments[k + 2] - x0, segments[k + 3] - y0];
    const square = dx * dx + dy * dy;
    const t = square ? Math.min(1, Math.max(0, ((x - x0) * dx + (y - y0) * dy) / square)) : 0;
    return Math.hypot(x - x0 - t * dx, y - y0 - t * dy);
}

/**
 * Whether a point is near one of some segments.
 * @type {(z: Point, segments: ArrayLike<number>, near: number) => boolean}
 */
export function isNear(z, segments, near) {
    for (let k = 0; k < segments.length; k += 4) {
        if (segmentDistance(z, segments, k) <= near) return true;
    }
    return false;
}

/**
 * Whether some segments come near others.
 * @type {(some: Float64Array, others: Float64Array, apart: number) => boolean}
 */
export function segmentsTouch(some, others, apart) {
    for (let i = 0; i < some.length; i += 4) {
        for (let j = 0; j < others.length; j += 4) {
            if (boxesApart(some, i, others, j) > apart) continue;
            if (segmentsCross(some, i, others, j)) return true;
            const nearest = Math.min(
                segmentDistance([some[i], some[i + 1]], others, j),
                segmentDistance([some[i + 2], some[i + 3]], others, j),
                segmentDistance([others[j], others[j + 1]], some, i),
                segmentDistance([others[j + 2], others[j + 3]], some, i),
            );
            if (nearest <= apart) return true;
        }
    }
    return false;
}

/**
 * How far the boxes of two segments are apart along an axis.
 * @type {(p: Float64Array, i: number, q: Float64Array, j: number) => number}
 */
function boxesApart(p, i, q, j) {
    const along = (/** @type {number} */ k) =>
        Math.max(
            Math.min(p[i + k], p[i + k + 2]) - Math.max(q[j + k], q[j + k + 2]),
            Math.min(q[j + k], q[j + k + 2]) - Math.max(p[i + k], p[i + k + 2]),
        );
    return Math.max(along(0), along(1));
}

/** Whether two segments cross. @type {(p: Float64Array, i: number, q: Float64Array, j: number) => boolean} */
function segmentsCross(p, i, q, j) {
    const [a, b, c, d] = /** @type {Point[]} */ ([
        [p[i], p[i + 1]],
        [p[i + 2], p[i + 3]],
        [q[j], q[j + 1]],
        [q[j + 2], q[j + 3]],
    ]);
    const side = (/** @type {Point} */ from, /** @type {Point} */ to, /** @type {Point} */ at) =>
        cross(minus(to, from), minus(at, from));
    return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}
