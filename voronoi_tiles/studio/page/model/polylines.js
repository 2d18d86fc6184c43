// @ts-check
/** Segments that follow each other as polylines of few points. */

/** @import { Point } from "./plane.js" */

/**
 * Polylines within a tolerance of segments, 4 numbers each: one for each run of segments that join.
 *
 * The points are some of the segments' own, and all others are within the tolerance of the polyline. Source: Sklansky
 * and Gonzalez, "Fast polygonal approximation of digitized curves", Pattern Recognition 12, 1980: from a point, the cone
 * of the rays that pass all that follow near enough.
 * @type {(segments: ArrayLike<number>, tolerance: number) => Point[][]}
 */
export function polylines(segments, tolerance) {
    /** @type {Point[][]} */
    const found = [];
    /** @type {Cone | null} */
    let cone = null;
    for (let k = 0; k < segments.length; k += 4) {
        const [x0, y0, x1, y1] = [segments[k], segments[k + 1], segments[k + 2], segments[k + 3]];
        if (!cone || x0 !== segments[k - 2] || y0 !== segments[k - 1]) {
            found.push([[x0, y0]]);
            cone = new Cone(x0, y0, tolerance);
        }
        const points = found[found.length - 1];
        if (!cone.narrow(x1, y1)) {
            cone = new Cone(x0, y0, tolerance);
            cone.narrow(x1, y1);
            points.push([x1, y1]);
        } else if (points.length > 1) {
            points[points.length - 1] = [x1, y1];
        } else {
            points.push([x1, y1]);
        }
    }
    return found;
}

/** The directions from a point in which a ray passes all points so far within a tolerance, none of them ahead of the last. */
class Cone {
    #x;
    #y;
    #tolerance;
    #middle = 0;
    #low = -Infinity;
    #high = Infinity;
    #reach = 0;

    /**
     * @param {number} x
     * @param {number} y
     * @param {number} tolerance
     */
    constructor(x, y, tolerance) {
        this.#x = x;
        this.#y = y;
        this.#tolerance = tolerance;
    }

    /**
     * Whether the segment to a point can stand for all so far; it is then one of them.
     * @param {number} x
     * @param {number} y
     */
    narrow(x, y) {
        const [dx, dy] = [x - this.#x, y - this.#y];
        const reach = Math.hypot(dx, dy);
        // Nearer than what was passed, the segment would end before it.
        if (reach < this.#reach) return false;
        if (reach <= this.#tolerance) return true;
        let angle = Math.atan2(dy, dx);
        if (this.#reach === 0) this.#middle = angle;
        angle -= this.#middle;
        angle -= 2 * Math.PI * Math.round(angle / (2 * Math.PI));
        if (angle < this.#low || angle > this.#high) return false;
        const half = Math.asin(this.#tolerance / reach);
        this.#low = Math.max(this.#low, angle - half);
        this.#high = Math.min(this.#high, angle + half);
        this.#reach = reach;
        return true;
    }
}
