// @ts-check
/**
 * Strokes as cubic Bezier pieces, placed, and their flattening into segments.
 *
 * The curves are those of `voronoi_tiles.designs.strokes`. What cannot be drawn yet, such as a point that is repeated,
 * is left out: the server says what is wrong with it.
 */

import { pathCubics } from "./pathdata.js";
import { IDENTITY, apply, compose, factorOf, inverse, minus, plus, same, scaled, unitAt } from "./plane.js";
import { mapped } from "./segments.js";

/** @import { Point } from "./plane.js" */
/** @import { Stroke, StrokeKind } from "./design.js" */
/** @typedef {Readonly<import("./plane.js").Similarity>} Placement where a stroke is laid */
/** @typedef {Readonly<import("./design.js").Placed>} Placed */

/** @type {readonly StrokeKind[]} The kinds of strokes, each the name of a stroke's own key. */
export const KINDS = Object.freeze([
    "point",
    "segment",
    "polyline",
    "bezier",
    "hermite",
    "catmull_rom",
    "bspline",
    "circle",
    "path",
    "file",
]);

/** Pieces of a circle: 12 keep to 1e-6 of the radius, and the group's turns and mirrors map them onto each other. */
const CIRCLE_PIECES = 12;

/** How often a piece is halved at most: enough for the largest window. */
const HALVINGS_MAX = 16;

/** The kind of a stroke. @type {(stroke: Stroke) => StrokeKind} */
export const kindOf = (stroke) => KINDS.find((kind) => stroke[kind] !== undefined) ?? "point";

/**
 * The points that a stroke's own key lists; none for kinds that have no list, and where something in it is no point.
 * @type {(stroke: Stroke) => Point[]}
 */
export function pointsOf(stroke) {
    const own = stroke[kindOf(stroke)];
    return Array.isArray(own) && typeof own[0] === "number" ? pointsIn([own]) : pointsIn(own);
}

/** A list if all in it are points, else none. @type {(list: unknown) => Point[]} */
function pointsIn(list) {
    const isPoint = (/** @type {unknown} */ item) => Array.isArray(item) && item.length === 2;
    return Array.isArray(list) && list.every(isPoint) ? list : [];
}

/** The tangents of a `hermite` stroke, one for each point. @type {(stroke: Stroke) => Point[]} */
export function tangentsOf(stroke) {
    const tangents = pointsIn(stroke.tangents);
    return pointsOf(stroke).map((_, k) => tangents[k] ?? [0, 0]);
}

/**
 * What `mirror`, `scale`, `rotate` and `translate` of a table do, in this order about the origin.
 * @param {Placed} table
 * @returns {Placement}
 */
export function placementIn({ mirror = false, scale = 1, rotate = 0, translate = [0, 0] }) {
    return { a: scaled(unitAt(rotate), mirror ? -scale : scale), b: translate, conj: mirror };
}

/**
 * The placement of a stroke: by its own keys, then by its site's.
 * @param {Placed} site
 * @param {Placed} stroke
 * @returns {Placement}
 */
export const placementOf = (site, stroke) => compose(placementIn(site), placementIn(stroke));

/** The point of a stroke that is placed there. @type {(placement: Placement, at: Point) => Point} */
export const unplace = (placement, at) => (placement === IDENTITY ? at : apply(inverse(placement), at));

/**
 * A stroke's cubic pieces where it is placed, 8 numbers each; a straight one is p, p, q, q and a point p, p, p, p.
 *
 * All are exact but circles and arcs of ellipses, which are within 1e-6 of their radius. What cannot be drawn, as it
 * has no points yet or numbers that are none, has no pieces.
 * @param {Stroke} stroke
 * @param {Placement} [placement]
 * @param {string} [resolved] the path data of the drawing that a stroke of kind `file` names
 * @returns {Float64Array}
 */
export function cubicsOf(stroke, placement = IDENTITY, resolved = "") {
    const placed = mapped(placement, ownCubics(stroke, resolved));
    if (!placed.every(Number.isFinite)) return new Float64Array(0);
    if (kindOf(stroke) !== "circle" || !placed.length) return placed;
    // A circle is not turned with its centre: its joints have to fit the mirrors of the group.
    return Float64Array.from(circleCubics(apply(placement, pointsOf(stroke)[0]), radiusOf(stroke, placement)));
}

/**
 * The radius of a circle where it is placed.
 * @param {Stroke} stroke
 * @param {Placement} placement
 * @returns {number}
 */
export const radiusOf = (stroke, placement) => (stroke.radius ?? 0) * factorOf(placement);

/** A stroke's pieces before it is placed. @type {(stroke: Stroke, resolved: string) => number[]} */
function ownCubics(stroke, resolved) {
    const kind = kindOf(stroke);
    if (kind === "path") return pathCubics(stroke.path ?? "");
    if (kind === "file") return pathCubics(resolved);
    const points = pointsOf(stroke);
    if (!points.length) return [];
    if (points.length === 1 && kind !== "circle") return chain([points[0], points[0]]);
    switch (kind) {
        case "bezier":
            return bezierCubics(points);
        case "hermite":
            return hermiteCubics(points, pointsIn(stroke.tangents));
        case "catmull_rom":
            return catmullRomCubics(points, stroke.alpha ?? 0.5, stroke.closed ?? false);
        case "bspline":
            return bsplineCubics(points, stroke.closed ?? false);
        case "circle":
            return circleCubics(points[0], stroke.radius ?? 0);
        default:
            return chain(stroke.closed && points.length > 2 ? [...points, points[0]] : points);
    }
}

/** Straight pieces from point to point. @type {(points: Point[]) => number[]} */
function chain(points) {
    return points.slice(1).flatMap((end, k) => [...points[k], ...points[k], ...end, ...end]);
}

/**
 * The pieces of a chain of 3 n + 1 control points; what is left over is none yet.
 * @type {(points: Point[]) => number[]}
 */
function bezierCubics(points) {
    const cubics = [];
    for (let k = 0; k + 3 < points.length; k += 3) cubics.push(...points.slice(k, k + 4).flat());
    return cubics;
}

/**
 * The cubic Hermite curve through points with a tangent at each.
 * @type {(points: Point[], tangents: Point[]) => number[]}
 */
function hermiteCubics(points, tangents) {
    /** @type {Point} */
    const none = [0, 0];
    return points.slice(1).flatMap((end, k) => {
        const first = plus(points[k], scaled(tangents[k] ?? none, 1 / 3));
        const second = minus(end, scaled(tangents[k + 1] ?? none, 1 / 3));
        return [...points[k], ...first, ...second, ...end];
    });
}

/**
 * The Catmull-Rom curve, its knots |distance|^alpha apart. Sources: Barry and Goldman 1988; Yuksel et al. 2011.
 * @type {(given: Point[], alpha: number, closed: boolean) => number[]}
 */
function catmullRomCubics(given, alpha, closed) {
    const points = given.filter((point, k) => k === 0 || !same(point, given[k - 1]));
    if (closed && points.length > 1 && same(points[0], points[points.length - 1])) points.pop();
    const count = points.length;
    if (count < 2) return chain([points[0], points[0]]);
    const ring = closed
        ? [points[count - 1], ...points, points[0], points[1 % count]]
        : [reflected(points[0], points[1]), ...points, reflected(points[count - 1], points[count - 2])];
    const steps = ring.slice(1).map((point, k) => Math.pow(Math.hypot(...minus(point, ring[k])), alpha));
    const tangents = ring.slice(1, -1).map((point, k) => {
        const before = scaled(minus(point, ring[k]), 1 / steps[k]);
        const after = scaled(minus(ring[k + 2], point), 1 / steps[k + 1]);
        return minus(plus(before, after), scaled(minus(ring[k + 2], ring[k]), 1 / (steps[k] + steps[k + 1])));
    });
    return tangents.slice(1).flatMap((tangent, k) => {
        const [start, end, step] = [ring[k + 1], ring[k + 2], steps[k + 1]];
        const first = plus(start, scaled(tangents[k], step / 3));
        return [...start, ...first, ...minus(end, scaled(tangent, step / 3)), ...end];
    });
}

/** The reflection of one point in another. @type {(centre: Point, point: Point) => Point} */
const reflected = (centre, point) => minus(scaled(centre, 2), point);

/**
 * The uniform cubic B-spline of control points; an open one starts near the second. Fewer than 4 make none (3 closed).
 * @type {(points: Point[], closed: boolean) => number[]}
 */
function bsplineCubics(points, closed) {
    if (points.length < (closed ? 3 : 4)) return [];
    const ring = closed ? [...points, ...points.slice(0, 3)] : points;
    const knots = ring.slice(2).map((point, k) => scaled(plus(plus(ring[k], point), scaled(ring[k + 1], 4)), 1 / 6));
    return knots.slice(1).flatMap((end, k) => {
        const first = between3(ring[k + 1], ring[k + 2]);
        const second = between3(ring[k + 2], ring[k + 1]);
        const piece = [knots[k], first, second, end];
        return piece.every((point) => same(point, end)) ? [] : piece.flat();
    });
}

/** The point a third of the way. @type {(near: Point, far: Point) => Point} */
const between3 = (near, far) => scaled(plus(scaled(near, 2), far), 1 / 3);

/** A circle that begins and ends to the right of its centre. @type {(centre: Point, radius: number) => number[]} */
function circleCubics(centre, radius) {
    const step = 360 / CIRCLE_PIECES;
    const handle = (4 / 3) * Math.tan(Math.PI / (2 * CIRCLE_PIECES));
    const joints = Array.from({ length: CIRCLE_PIECES + 1 }, (_, k) => unitAt(k * step));
    return joints.slice(1).flatMap((end, k) => {
        const [x, y] = joints[k];
        const first = /** @type {Point} */ ([x - handle * y, y + handle * x]);
        const second = /** @type {Point} */ ([end[0] + handle * end[1], end[1] - handle * end[0]]);
        return [joints[k], first, second, end].flatMap((point) => plus(centre, scaled(point, radius)));
    });
}

/**
 * The segments of pieces that stay within `tolerance` of them, 4 numbers each: x0, y0, x1, y1.
 *
 * Pieces are halved (de Casteljau) until each is proven flat, as `voronoi_tiles.designs.strokes.flatten` does; a point
 * is a segment whose ends are equal.
 * @type {(cubics: Float64Array, tolerance: number) => Float64Array}
 */
export function flatten(cubics, tolerance) {
    /** @type {number[]} */
    const segments = [];
    for (let k = 0; k + 7 < cubics.length; k += 8) {
        flattenPiece(/** @type {Piece} */ (/** @type {unknown} */ (cubics.subarray(k, k + 8))), tolerance, 0, segments);
    }
    return Float64Array.from(segments);
}

/** @typedef {[number, number, number, number, number, number, number, number]} Piece a cubic by its control points */

/**
 * Append the segments of one piece, which has been halved `depth` times.
 * @param {Piece} piece
 * @param {number} tolerance
 * @param {number} depth
 * @param {number[]} segments
 */
function flattenPiece(piece, tolerance, depth, segments) {
    if (depth === HALVINGS_MAX || isFlat(piece, tolerance)) {
        segments.push(piece[0], piece[1], piece[6], piece[7]);
        return;
    }
    const [first, second] = halves(piece);
    flattenPiece(first, tolerance, depth + 1, segments);
    flattenPiece(second, tolerance, depth + 1, segments);
}

/** The two halves of a piece. @type {(piece: Piece) => [Piece, Piece]} */
function halves([x0, y0, x1, y1, x2, y2, x3, y3]) {
    const xa = (x0 + x1) / 2,
        ya = (y0 + y1) / 2;
    const xb = (x1 + x2) / 2,
        yb = (y1 + y2) / 2;
    const xc = (x2 + x3) / 2,
        yc = (y2 + y3) / 2;
    const xd = (xa + xb) / 2,
        yd = (ya + yb) / 2;
    const xe = (xb + xc) / 2,
        ye = (yb + yc) / 2;
    const x = (xd + xe) / 2,
        y = (yd + ye) / 2;
    return [
        [x0, y0, xa, ya, xd, yd, x, y],
        [x, y, xe, ye, xc, yc, x3, y3],
    ];
}

/**
 * Whether a piece and its chord are proven to be within `tolerance` of each other.
 *
 * The bound is that of `voronoi_tiles.designs.strokes`: 3/4 of the larger distance of the inner control points from
 * their places on the evenly run chord; only across the chord where they project into it, and 4/9 of that on different
 * sides.
 * @type {(piece: Piece, tolerance: number) => boolean}
 */
function isFlat([x0, y0, x1, y1, x2, y2, x3, y3], tolerance) {
    const cx = x3 - x0,
        cy = y3 - y0;
    if (cx === 0 && cy === 0) return x0 === x1 && x1 === x2 && y0 === y1 && y1 === y2;
    const off = Math.max(
        square(x1 - (2 * x0 + x3) / 3, y1 - (2 * y0 + y3) / 3),
        square(x2 - (2 * x3 + x0) / 3, y2 - (2 * y3 + y0) / 3),
    );
    if (0.5625 * off <= tolerance * tolerance) return true;
    const sx = x1 - x0,
        sy = y1 - y0,
        ex = x2 - x3,
        ey = y2 - y3;
    const inside =
        sx * cx + sy * cy >= 0 &&
        ex * cx + ey * cy <= 0 &&
        (x2 - x0) * cx + (y2 - y0) * cy >= 0 &&
        (x3 - x1) * cx + (y3 - y1) * cy >= 0;
    if (!inside) return false;
    const h1 = sx * cy - sy * cx,
        h2 = ex * cy - ey * cx;
    const across = (h1 * h2 < 0 ? 4 / 9 : 0.75) * Math.max(Math.abs(h1), Math.abs(h2));
    return across <= tolerance * Math.sqrt(square(cx, cy));
}

/** The square of a length. @type {(x: number, y: number) => number} */
const square = (x, y) => x * x + y * y;
