// @ts-check
/** Another group for the same drawing: its cell, and the drawing laid into that where its copies would touch. */

import { between, cross, dot, length, minus, plus, scaled, tidyProduct, tidySum } from "./plane.js";
import { cubicsOf, flatten, placementOf } from "./strokes.js";
import {
    boxOf,
    cellArea,
    cosets,
    groupOf,
    latticeOf,
    mapped,
    motionsOf,
    reduced,
    regionOf,
    segmentDistance,
} from "./symmetry.js";

/** @typedef {import("./plane.js").Point} Point */
/** @typedef {import("./design.js").Cell} Cell */
/** @typedef {import("./design.js").Design} Design */
/** @typedef {import("./design.js").Site} Site */
/** @typedef {import("./symmetry.js").Lattice} Lattice */
/** @typedef {import("./symmetry.js").Motion} Motion */
/** @typedef {import("./symmetry.js").Tables} Tables */

/** How far apart copies must be to stay; relative to a. */
const APART = 2e-3;

/** The share of an asymmetric unit's width that is left free along each of its sides. */
const BORDER = 0.06;

/** How exactly strokes are flattened to look for copies that touch; relative to a. */
const FLATTENING = 1e-3;

/** How often the size of the drawing is halved in on. */
const STEPS = 40;

/**
 * A design in another group, and what was done to it in words, "" for nothing.
 *
 * The side a stays, and the others where the group leaves them free; what it frees is as it was. The drawing stays
 * where it is; but where its copies would touch, or lie in each other, it is laid into one asymmetric unit, smaller if
 * need be, by the `scale` and `translate` of its sites: there no copies meet.
 *
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

/**
 * The cell of a design in another group.
 *
 * @param {Design} design
 * @param {string} name
 * @param {Tables} tables
 * @returns {Cell}
 */
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
 * Whether copies of a design's sites touch, or nearly so.
 *
 * @param {Design} design
 * @param {Tables} tables
 * @param {Readonly<Record<string, string>>} [resolved]
 * @returns {boolean}
 */
export function copiesTouch(design, tables, resolved = {}) {
    const lattice = latticeOf(design, tables);
    const motions = motionsOf(design, tables);
    const sites = design.site.map((_, k) => segmentsOf(design, k, resolved)).filter((segments) => segments.length);
    const apart = APART * length(lattice.a);
    const copies = sites.map((segments) => cosets(motions, lattice, segments).map((k) => mapped(motions[k], segments)));
    return sites.some((segments, one) =>
        copies
            .slice(one)
            .some((images, other) =>
                images.some((image, k) => imageTouches(segments, image, lattice, apart, other === 0 && k === 0)),
            ),
    );
}

/**
 * A site's segments, coarse.
 *
 * @type {(d: Design, k: number, resolved: Readonly<Record<string, string>>) => Float64Array}
 */
function segmentsOf(design, k, resolved) {
    const site = design.site[k];
    const parts = site.strokes.map((stroke, n) => [
        ...flatten(cubicsOf(stroke, placementOf(site, stroke), resolved[`${k}.${n}`]), FLATTENING * design.cell.a),
    ]);
    return Float64Array.from(parts.flat());
}

/**
 * Whether segments are nearer than `apart` to a translate of an image of theirs, or of another site's.
 *
 * @param {Float64Array} segments
 * @param {Float64Array} image
 * @param {Lattice} lattice
 * @param {number} apart
 * @param {boolean} isItself whether the image is the segments, so that the zero translation does not count
 * @returns {boolean}
 */
function imageTouches(segments, image, lattice, apart, isItself) {
    const [left, bottom, right, top] = boxOf(segments);
    const box = boxOf(image);
    // Translations t with which the image's box, moved by t, meets that of the segments.
    const window = /** @type {const} */ ([
        left - box[2] - apart,
        bottom - box[3] - apart,
        right - box[0] + apart,
        top - box[1] + apart,
    ]);
    return translationsIn(lattice, [...window]).some((t) => {
        if (isItself && t[0] === 0 && t[1] === 0) return false;
        return segmentsTouch(segments, mapped({ a: [1, 0], b: t, conj: false }, image), apart);
    });
}

/** The vectors of a lattice in a box. @type {(lattice: Lattice, box: import("./plane.js").Box) => Point[]} */
function translationsIn(lattice, [x0, y0, x1, y1]) {
    const { a, b } = reduced(lattice);
    const middle = /** @type {Point} */ ([(x0 + x1) / 2, (y0 + y1) / 2]);
    const reach = Math.hypot(x1 - x0, y1 - y0) / 2;
    const height = cellArea({ a, b }) / length(a);
    const width = cellArea({ a, b }) / length(b);
    const [s, t] = [cross(middle, b) / cross(a, b), cross(a, middle) / cross(a, b)];
    /** @type {Point[]} */
    const found = [];
    for (let j = Math.ceil(t - reach / height); j <= t + reach / height; j++) {
        for (let i = Math.ceil(s - reach / width); i <= s + reach / width; i++) {
            const [x, y] = plus(scaled(a, i), scaled(b, j));
            if (x0 <= x && x <= x1 && y0 <= y && y <= y1) found.push([x, y]);
        }
    }
    return found;
}

/**
 * Whether some segments come near others.
 *
 * @type {(some: Float64Array, others: Float64Array, apart: number) => boolean}
 */
function segmentsTouch(some, others, apart) {
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
 *
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

/**
 * A design with its drawing laid into a convex region, as large as it fits but no larger than it is; null where there
 * is nothing to lay.
 *
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
        const outward = scaled(/** @type {Point} */ ([along[1], -along[0]]), 1 / length(along));
        const reach = Math.max(...points.map((point) => dot(outward, point)));
        const width = Math.max(...region.map((point) => dot(outward, minus(corner, point))));
        return { outward, reach, limit: dot(outward, corner) - BORDER * width };
    });
    const far = 2 * Math.max(...[...points, ...region].map(length));
    const plane = /** @type {Point[]} */ ([[-far, -far], [far, -far], [far, far], [-far, far]]);
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
    const [x, y] = site.translate ?? [0, 0];
    const larger = size === 1 ? {} : { scale: tidyProduct(site.scale ?? 1, size) };
    return { ...site, ...larger, translate: [tidySum(x * size, shift[0]), tidySum(y * size, shift[1])] };
}

/** The ends of segments. @type {(segments: Float64Array) => Point[]} */
function pointsIn(segments) {
    return Array.from({ length: segments.length / 2 }, (_, k) => [segments[2 * k], segments[2 * k + 1]]);
}

/** A point to about a thousandth of a length. @type {(point: Point, size: number) => Point} */
function shortened([x, y], size) {
    const digits = Math.max(0, 3 - Math.floor(Math.log10(size)));
    return [Number(x.toFixed(digits)) + 0, Number(y.toFixed(digits)) + 0];
}

/** The mean of a polygon's corners. @type {(polygon: Point[]) => Point} */
const middleOf = (polygon) => scaled(polygon.reduce(plus, [0, 0]), 1 / polygon.length);

/**
 * The part of a convex polygon where the product with a direction is at most a limit; no corners where there is none.
 *
 * @param {Point[]} polygon
 * @param {Point} direction
 * @param {number} limit
 * @returns {Point[]}
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
