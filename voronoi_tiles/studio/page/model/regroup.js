// @ts-check
/** Another group for the same drawing: its cell, and the drawing laid into that where its copies would touch. */

import { between, cross, dot, fixed, length, minus, plus, scaled, tidyPlus, tidyProduct, unit } from "./plane.js";
import { groupOf, latticeOf, regionOf } from "./symmetry.js";
import { copiesTouch, segmentsOf } from "./touching.js";

/** @import { Point } from "./plane.js" */
/** @import { Cell, Design, Site } from "./design.js" */
/** @import { Tables } from "./symmetry.js" */

/** The share of an asymmetric unit's width that is left free along each of its sides. */
const BORDER = 0.06;

/** How often the size of the drawing is halved in on. */
const STEPS = 40;

/**
 * A design in another group, and what was done to it in words, "" for nothing.
 *
 * The side a stays, and the others where the group leaves them free; what it frees is as it was. The drawing stays
 * where it is; but where its copies would touch, or lie in each other, it is laid into one asymmetric unit, smaller if
 * need be, by the `scale` and `translate` of its sites: there no copies meet.
 * @param {Design} design
 * @param {string} name
 * @param {Tables} tables
 * @param {Readonly<Record<string, string>>} [resolved] the path data of strokes that are files, by "site.stroke"
 * @returns {{design: Design, note: string}}
 */
export function setGroup(design, name, tables, resolved = {}) {
    if (design.group === name || !tables.groups.some((group) => group.name === name)) return { design, note: "" };
    const renamed = { ...design, group: name, cell: cellFor(design, name, tables) };
    const notes = [cellNote(design.cell, renamed.cell)];
    if (!copiesTouch(renamed, tables, resolved)) return { design: renamed, note: notes.join("") };
    const fitted = laidIn(renamed, regionOf(renamed, tables), resolved);
    if (fitted) notes.push(fitted.note);
    return { design: fitted?.design ?? renamed, note: notes.filter(Boolean).join(" ") };
}

/** The cell of a design in another group. @type {(design: Design, name: string, tables: Tables) => Cell} */
function cellFor(design, name, tables) {
    const { free } = groupOf({ ...design, group: name }, tables);
    const { a, b } = latticeOf(design, tables);
    const { b: _b, angle: _angle, ...others } = design.cell;
    const side = design.cell.b ?? length(b);
    const angle =
        design.cell.angle ?? groupOf(design, tables).angle ?? (Math.atan2(cross(a, b), dot(a, b)) * 180) / Math.PI;
    return { ...others, ...(free.includes("b") ? { b: side } : {}), ...(free.includes("angle") ? { angle } : {}) };
}

/** What became of the keys of the cell. @type {(before: Cell, after: Cell) => string} */
function cellNote(before, after) {
    const gone = ["b", "angle"].filter((key) => key in before && !(key in after));
    const come = /** @type {const} */ (["b", "angle"]).filter((key) => key in after && !(key in before));
    return [
        ...(come.length ? [`Free now: ${come.map((key) => `${key} = ${after[key]}`).join(", ")}.`] : []),
        ...(gone.length ? [`Fixed now: ${gone.join(" and ")}.`] : []),
    ].join(" ");
}

/**
 * A design with its drawing laid into a convex region, as large as it fits but no larger than it is; null where there
 * is nothing to lay.
 * @param {Design} design
 * @param {Point[]} region its corners, counterclockwise
 * @param {Readonly<Record<string, string>>} resolved
 * @returns {{design: Design, note: string} | null}
 */
function laidIn(design, region, resolved) {
    const points = design.site.flatMap((_, k) => pointsIn(segmentsOf(design, k, resolved)));
    if (!points.length) return null;
    const sides = region.map((corner, k) => {
        const along = minus(region[(k + 1) % region.length], corner);
        const outward = unit([along[1], -along[0]]);
        const reach = Math.max(...points.map((point) => dot(outward, point)));
        const width = Math.max(...region.map((point) => dot(outward, minus(corner, point))));
        return { outward, reach, limit: dot(outward, corner) - BORDER * width };
    });
    const far = 2 * Math.max(...[...points, ...region].map(length));
    const plane = /** @type {Point[]} */ ([
        [-far, -far],
        [far, -far],
        [far, far],
        [-far, far],
    ]);
    /** Where the origin of the drawing can be laid, at a size. @type {(size: number) => Point[]} */
    const room = (size) =>
        sides.reduce((left, { outward, reach, limit }) => clipped(left, outward, limit - size * reach), plane);
    const size = room(1).length ? 1 : Number((0.99 * largest((middle) => room(middle).length > 0)).toPrecision(3));
    const shift = shortened(middleOf(room(size)), design.cell.a);
    const percent = Number((100 * size).toPrecision(3));
    const done = size === 1 ? "moved" : `moved and made smaller (${percent} %)`;
    const note = `The drawing was ${done}: in ${design.group} its copies would touch where it was.`;
    return { design: { ...design, site: design.site.map((site) => laid(site, size, shift)) }, note };
}

/** The largest size below 1 that fits, found by halving. @type {(fits: (size: number) => boolean) => number} */
function largest(fits) {
    let [low, high] = [0, 1];
    for (let step = 0; step < STEPS; step++) {
        const middle = (low + high) / 2;
        [low, high] = fits(middle) ? [middle, high] : [low, middle];
    }
    return low;
}

/** A site made larger about the origin, and then moved. @type {(site: Site, size: number, shift: Point) => Site} */
function laid(site, size, shift) {
    const larger = size === 1 ? {} : { scale: tidyProduct(site.scale ?? 1, size) };
    return { ...site, ...larger, translate: tidyPlus(scaled(site.translate ?? [0, 0], size), shift) };
}

/** The ends of segments. @type {(segments: Float64Array) => Point[]} */
function pointsIn(segments) {
    return Array.from({ length: segments.length / 2 }, (_, k) => [segments[2 * k], segments[2 * k + 1]]);
}

/** A point to about a thousandth of a length. @type {(point: Point, size: number) => Point} */
function shortened(point, size) {
    return fixed(point, Math.max(0, 3 - Math.floor(Math.log10(size))));
}

/** The mean of a polygon's corners. @type {(polygon: Point[]) => Point} */
const middleOf = (polygon) => scaled(polygon.reduce(plus, [0, 0]), 1 / polygon.length);

/**
 * The part of a convex polygon where the product with a direction is at most a limit; no corners where there is none.
 * @type {(polygon: Point[], direction: Point, limit: number) => Point[]}
 */
function clipped(polygon, direction, limit) {
    const beyond = polygon.map((point) => dot(direction, point) - limit);
    return polygon.flatMap((point, k) => {
        const next = (k + 1) % polygon.length;
        const inside = beyond[k] <= 0 ? [point] : [];
        const crosses = beyond[k] < 0 !== beyond[next] < 0 && beyond[k] !== 0 && beyond[next] !== 0;
        const t = beyond[k] / (beyond[k] - beyond[next]);
        return crosses ? [...inside, between(point, polygon[next], t)] : inside;
    });
}
