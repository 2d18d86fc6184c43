// @ts-check
/**
 * SVG path data as cubic Bezier pieces, all commands. Source: SVG 1.1, 8.3 and F.6.
 *
 * The server reads the same data strictly, and says which character is wrong; here as much is drawn as is in order.
 */

import { conjugate, minus, plus, same, scaled, times, unitAt } from "./plane.js";

/** @import { Point } from "./plane.js" */

/**
 * The arc z(s) = (start + end) / 2 + across sin(s) + out (cos(s) - cos(half)), -half <= s <= half, of an ellipse.
 * @typedef {object} Arc
 * @property {Point} start
 * @property {Point} end
 * @property {Point} across a half diameter along the chord
 * @property {Point} out the conjugate one, to the middle of the arc
 * @property {number} half half the angle on the unit circle whose image the ellipse is, radians
 */

/** @typedef {(start: Point, first: Point, second: Point, end: Point) => void} Draw takes a cubic piece */

/** How far cubics may be from an arc; relative to the larger radius: less than a pixel of any window shows. */
export const ARC_SHARE = 1e-6;

/** Radii that are smaller are none; in the coordinates' unit. */
const RADIUS_MIN = 1e-100;

/** What each command takes: n a number, f a flag. @type {Readonly<Record<string, string>>} */
const ARGUMENTS = { M: "nn", L: "nn", H: "n", V: "n", C: "nnnnnn", S: "nnnn", Q: "nnnn", T: "nn", A: "nnnffnn", Z: "" };

const COMMAND = /[\s]*([MmLlHhVvCcSsQqTtAaZz])/y;
const NUMBER = /[\s,]*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)/y;
const FLAG = /[\s,]*([01])/y;

/**
 * The drawn pieces of path data in their order, 8 numbers each; straight ones are p, p, q, q.
 * @type {(data: string) => number[]}
 */
export function pathCubics(data) {
    /** @type {number[]} */
    const cubics = [];
    drawPath(data, (start, first, second, end) => {
        const still = same(start, first) && same(start, second) && same(start, end);
        if (!still) cubics.push(...start, ...first, ...second, ...end);
    });
    return cubics;
}

/** Draw path data, up to the first character that breaks the grammar. @param {string} data @param {Draw} draw */
function drawPath(data, draw) {
    /** @type {Point} */
    let here = [0, 0];
    let start = here;
    let bent = ""; // the kind of the curve before, and the control point next to its end
    let control = here;
    const line = (/** @type {Point} */ end) => draw(here, here, end, end);
    for (const { letter, values } of commands(data)) {
        const command = letter.toUpperCase();
        const origin = /** @type {Point} */ (letter === command ? [0, 0] : here);
        const at = (/** @type {number} */ k) => plus([values[k], values[k + 1]], origin);
        let end = here;
        let kind = "";
        switch (command) {
            case "M":
                end = start = at(0);
                break;
            case "Z":
                end = start;
                line(end);
                break;
            case "H":
                end = [values[0] + origin[0], here[1]];
                line(end);
                break;
            case "V":
                end = [here[0], values[0] + origin[1]];
                line(end);
                break;
            case "L":
                end = at(0);
                line(end);
                break;
            case "A":
                end = at(5);
                drawArc(draw, here, end, values);
                break;
            case "C":
            case "S": {
                const smooth = command === "S";
                const first = smooth ? mirrored(here, bent === "C" ? control : here) : at(0);
                kind = "C";
                control = at(smooth ? 0 : 2);
                end = at(smooth ? 2 : 4);
                draw(here, first, control, end);
                break;
            }
            case "Q":
            case "T": {
                const smooth = command === "T";
                kind = "Q";
                control = smooth ? mirrored(here, bent === "Q" ? control : here) : at(0);
                end = at(smooth ? 0 : 2);
                draw(here, raised(here, control), raised(end, control), end);
                break;
            }
        }
        bent = kind;
        here = end;
    }
}

/**
 * The commands of path data, each with the numbers that it takes once; what follows a move are lines.
 * @param {string} data
 * @returns {Generator<{letter: string, values: number[]}>}
 */
function* commands(data) {
    let position = 0;
    const next = (/** @type {RegExp} */ pattern) => {
        pattern.lastIndex = position;
        const match = pattern.exec(data);
        if (match) position = pattern.lastIndex;
        return match ? match[1] : null;
    };
    for (let first = true; ; first = false) {
        let letter = next(COMMAND);
        if (letter === null || (first && letter !== "M" && letter !== "m")) return;
        const wanted = ARGUMENTS[letter.toUpperCase()];
        for (let count = 0; ; count++) {
            const values = [];
            for (const kind of wanted) {
                const text = next(kind === "f" ? FLAG : NUMBER);
                if (text === null) break;
                values.push(Number(text));
            }
            const whole = values.length === wanted.length;
            if (!whole && (count === 0 || values.length)) return; // broken
            if (!whole) break;
            yield { letter, values };
            if (!wanted) break;
            if (letter === "M") letter = "L";
            if (letter === "m") letter = "l";
        }
    }
}

/** The image of a control point in the joint between two curves. @type {(joint: Point, control: Point) => Point} */
const mirrored = (joint, control) => plus(joint, minus(joint, control));

/** A cubic's control point beside the end `point` of a quadratic. @type {(point: Point, control: Point) => Point} */
const raised = (point, control) => [(point[0] + 2 * control[0]) / 3, (point[1] + 2 * control[1]) / 3];

/**
 * Draw an elliptical arc as cubics, or the line that it is.
 * @param {Draw} draw
 * @param {Point} start
 * @param {Point} end
 * @param {number[]} values the numbers of the command A
 */
function drawArc(draw, start, end, [rx, ry, degrees, large, sweep]) {
    const arc = same(start, end) ? null : arcBetween(start, end, Math.abs(rx), Math.abs(ry), degrees, !!large, !!sweep);
    if (!arc) {
        draw(start, start, end, end);
        return;
    }
    const count = cubicCount(arc.half);
    const handle = (4 / 3) * Math.tan(arc.half / (2 * count));
    let here = start;
    let leaving = scaled(arcTangent(arc, -arc.half), handle);
    for (let k = 1; k <= count; k++) {
        const s = (arc.half * (2 * k - count)) / count;
        const there = k === count ? end : arcPoint(arc, s);
        const arriving = scaled(arcTangent(arc, s), handle);
        draw(here, plus(here, leaving), minus(there, arriving), there);
        [here, leaving] = [there, arriving];
    }
}

/**
 * How many cubics stay within ARC_SHARE of an arc's larger radius. Source: Goldapp, "Approximation of circular arcs by
 * cubic polynomials", 1991.
 * @type {(half: number) => number}
 */
function cubicCount(half) {
    const cosine = Math.cos(Math.PI / 8); // the least, for a quarter
    const step = 4 * Math.pow((ARC_SHARE * cosine ** 2 * 27) / 4, 1 / 6);
    return Math.ceil((2 * half) / step);
}

/**
 * The arc between two points as SVG gives it, null where it is a line; the points differ.
 * @param {Point} start
 * @param {Point} end
 * @param {number} rx
 * @param {number} ry
 * @param {number} degrees
 * @param {boolean} large
 * @param {boolean} sweep
 * @returns {Arc | null}
 */
function arcBetween(start, end, rx, ry, degrees, large, sweep) {
    if (Math.min(rx, ry) < RADIUS_MIN) return null;
    const turn = unitAt(degrees);
    const chord = times(scaled(minus(end, start), 0.5), conjugate(turn));
    const onCircle = /** @type {Point} */ ([chord[0] / rx, chord[1] / ry]);
    const h = Math.hypot(...onCircle); // half the chord of the unit circle, the sine of half the angle
    if (h < RADIUS_MIN) return null;
    const along = scaled(onCircle, 1 / h);
    let half = large ? Math.PI - Math.asin(Math.min(h, 1)) : Math.asin(Math.min(h, 1));
    if (h >= 1) {
        [rx, ry, half] = [rx * h, ry * h, Math.PI / 2];
    }
    const onEllipse = (/** @type {Point} */ z) => times(turn, [rx * z[0], ry * z[1]]);
    return { start, end, across: onEllipse(along), out: onEllipse(times(along, [0, sweep ? -1 : 1])), half };
}

/** The point z(s) of an arc. @type {(arc: Arc, s: number) => Point} */
function arcPoint(arc, s) {
    // cos(s) - cos(half) as a product, free of cancellation.
    const height = 2 * Math.sin((arc.half - s) / 2) * Math.sin((arc.half + s) / 2);
    const middle = scaled(plus(arc.start, arc.end), 0.5);
    return plus(middle, plus(scaled(arc.across, Math.sin(s)), scaled(arc.out, height)));
}

/** The derivative of z at s. @type {(arc: Arc, s: number) => Point} */
const arcTangent = (arc, s) => minus(scaled(arc.across, Math.cos(s)), scaled(arc.out, Math.sin(s)));
