// @ts-check
/** A picture that is traced: where it lies in the drawing. It is no part of the design. */

import { MILLIMETRES } from "./lengths.js";
import { conjugate, dot, length, minus, plus, scaled, times, unitAt } from "./plane.js";

/** @import { Point } from "./plane.js" */
/** @typedef {{width: number, height: number}} Picture pixels */
/**
 * @typedef {object} Laid where a picture lies
 * @property {Point | null} at its middle, before the design's scale; null: not laid yet
 * @property {number} width likewise
 * @property {import("./design.js").Unit} units of both
 * @property {number} turn degrees, counterclockwise
 * @property {number} opacity
 */

/** A picture before it is laid. @type {Readonly<Laid>} */
export const UNLAID = Object.freeze({ at: null, width: 0, units: "mm", turn: 0, opacity: 0.4 });

/**
 * The same place in other units, as when those of the design are changed.
 * @template {Laid} T
 * @param {T} laid
 * @param {import("./design.js").Unit} units
 * @returns {T}
 */
export function inUnits(laid, units) {
    if (laid.units === units || !(units in MILLIMETRES)) return laid;
    const factor = MILLIMETRES[laid.units] / MILLIMETRES[units];
    return { ...laid, at: laid.at && scaled(laid.at, factor), width: laid.width * factor, units };
}

/** What was kept of where a picture lies, as far as it makes sense. @type {(kept: any) => Partial<Laid>} */
export function laidOf(kept) {
    const { at, width, units, turn, opacity } = kept ?? {};
    const numbers = [at?.[0], at?.[1], width, turn, opacity];
    const isWhole = numbers.every(Number.isFinite) && width > 0 && units in MILLIMETRES;
    return isWhole ? { at: [at[0], at[1]], width, units, turn, opacity: Math.min(1, Math.max(0, opacity)) } : {};
}

/** The least width; units. */
const WIDTH_MIN = 1e-3;

/**
 * The corners of a picture, counterclockwise, the lower left one first.
 * @type {(laid: Laid & {at: Point}, picture: Picture) => Point[]}
 */
export function cornersOf({ at, width, turn }, picture) {
    const [x, y] = [width / 2, (width * picture.height) / picture.width / 2];
    const corners = /** @type {Point[]} */ ([
        [-x, -y],
        [x, -y],
        [x, y],
        [-x, y],
    ]);
    return corners.map((corner) => plus(at, times(unitAt(turn), corner)));
}

/**
 * A picture turned and made larger about its middle, so that a point of it comes to another place; with `straight` it
 * is not turned.
 * @template {Laid & {at: Point}} T
 * @param {T} laid
 * @param {Point} from not its middle
 * @param {Point} to
 * @param {boolean} [straight]
 * @returns {T}
 */
export function pulled(laid, from, to, straight = false) {
    const [old, now] = [minus(from, laid.at), minus(to, laid.at)];
    const factor = scaled(times(now, conjugate(old)), 1 / dot(old, old));
    const larger = straight ? Math.abs(factor[0]) : length(factor);
    const turn = straight ? laid.turn : laid.turn + (Math.atan2(factor[1], factor[0]) * 180) / Math.PI;
    return {
        ...laid,
        width: Math.max(WIDTH_MIN, Number((laid.width * larger).toPrecision(5))),
        turn: Number((turn - 360 * Math.round(turn / 360)).toFixed(2)) + 0,
    };
}
