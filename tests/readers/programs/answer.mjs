// @ts-check
/**
 * What the script of every program prints: what that program has read of a file, in millimetres, y up.
 */

import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

/** Points for each curve; a count. */
export const SAMPLES = 128;

/** A pixel of CSS, the user unit of a page without a size; millimetres. */
export const PX = 25.4 / 96;

/** The text of the file that is to be read. */
export const text = readFileSync(process.argv[2], "utf-8");

/**
 * The millimetres of a page's user unit, by its width and its viewBox.
 * @param {string} svg
 */
export function userUnit(svg) {
    const [, size, unit] = /** @type {RegExpExecArray} */ (/<svg[^>]* width="([\d.]+)(mm|px|)"/.exec(svg));
    const [, width] = /** @type {RegExpExecArray} */ (/viewBox="\S+ \S+ (\S+) /.exec(svg));
    return (Number(size) * (unit === "mm" ? 1 : PX)) / Number(width);
}

/**
 * Points along a curve whose parameter goes from 0 to 1, without its start.
 * @param {(t: number) => [number, number]} curve
 * @returns {[number, number][]}
 */
export function sampled(curve) {
    return Array.from({ length: SAMPLES }, (_, k) => curve((k + 1) / SAMPLES));
}

/**
 * Print what a package has read: points in its own unit, and whether it takes a contour for closed.
 * @param {string} name the package
 * @param {{ points: [number, number][], closed: boolean }[]} contours
 * @param {{ scale?: number, down?: boolean, entities?: string[], size?: [number, number], area?: number }} more
 *     millimetres of a unit; whether y goes down; what the package calls what it read; what it says itself, mm and mm2
 */
export function answer(name, contours, { scale = 1, down = false, entities = [], size, area } = {}) {
    const kept = contours.filter(({ points }) => points.length);
    /** @type {Record<string, number>} */
    const counts = {};
    for (const entity of entities) counts[entity] = (counts[entity] ?? 0) + 1;
    const place = dirname(fileURLToPath(import.meta.url));
    const home = process.env.READERS_MODULES ?? join(place, "..", "node_modules");
    console.log(
        JSON.stringify({
            version: JSON.parse(readFileSync(join(home, name, "package.json"), "utf-8")).version,
            contours: kept.map(({ points }) => points.map(([x, y]) => [scale * x, (down ? -scale : scale) * y])),
            closed: kept.map(({ closed }) => closed),
            entities: counts,
            size: size ?? null,
            area: area ?? null,
            counted: true,
        }),
    );
}
