// @ts-check
// Curves as the screen shows them: polylines within a quarter of a pixel, which are drawn several times faster.

import { polylines } from "../model/polylines.js";
import { flatten } from "../model/strokes.js";

/** Pixels of the page that strokes and outlines, as they are drawn, are off by at most. */
export const FLAT = 0.25;

/**
 * The scale for which paths at a scale are made: the same one while the window is zoomed a little.
 * @param {number} scale pixels of the page for each unit
 */
export const roundedScale = (scale) => 2 ** Math.ceil(Math.log2(scale));

/**
 * The path of cubic pieces, 8 numbers each, in their coordinates. What is smaller than a quarter of a pixel is a dot.
 * @param {Float64Array} cubics
 * @param {number} scale pixels of the page for each unit, at most
 */
export function screenPath(cubics, scale) {
    const path = new Path2D();
    for (const points of polylines(flatten(cubics, FLAT / 2 / scale), FLAT / 2 / scale)) {
        points.forEach(([x, y], k) => path[k ? "lineTo" : "moveTo"](x, y));
    }
    return path;
}
