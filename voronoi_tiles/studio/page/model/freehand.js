// @ts-check
/**
 * What is drawn by a free hand as few smooth curves.
 *
 * Source: Schneider, "An algorithm for automatically fitting digitized curves", Graphics Gems, 1990: cubics by least
 * squares, their parameters improved by Newton's method, divided where the curve is farthest away.
 */

import { between, distance, dot, minus, plus, same, scaled, unit } from "./plane.js";
import { pointOn } from "./nearest.js";
import { rounded } from "./snapping.js";

/** @import { Point } from "./plane.js" */
/** @import { Stroke } from "./design.js" */
/** @typedef {[Point, Point, Point, Point]} Cubic */

/** How often parameters are improved before a curve is divided. */
const ROUNDS = 4;

/** Where the hand turns by more within a few accuracies, it draws a corner; the cosine. */
const CORNER = Math.cos((50 * Math.PI) / 180);

/**
 * The stroke through the points of a hand, null where they are all the same.
 *
 * The curve is within about `accuracy` of all points, and the points of it: corners stay corners. It is closed where it
 * ends within three accuracies of where it began, after a way that is long beside that.
 * @type {(points: readonly Point[], accuracy: number) => Stroke | null}
 */
export function fit(points, accuracy) {
    const trail = thinned(points, accuracy / 4);
    if (trail.length < 2) return null;
    const closed = closes(trail, accuracy) ? [...trail.slice(0, -1), trail[0]] : trail;
    const ends = closed.filter((point, k) => k === 0 || !same(point, closed[k - 1]));
    const corners = [0, ...cornersOf(ends, 4 * accuracy), ends.length - 1];
    const cubics = corners.slice(1).flatMap((last, k) => fitted(ends.slice(corners[k], last + 1), accuracy));
    const chain = [cubics[0][0], ...cubics.flatMap((cubic) => cubic.slice(1))];
    return { bezier: chain.map((point) => rounded(point, accuracy / 30)) };
}

/**
 * The points that are at least so far from the one before, and the last one.
 * @type {(points: readonly Point[], least: number) => Point[]}
 */
function thinned(points, least) {
    /** @type {Point[]} */
    const kept = [];
    for (const point of points) {
        if (!kept.length || distance(point, kept[kept.length - 1]) >= least) kept.push(point);
    }
    const last = points[points.length - 1];
    if (kept.length > 1 && !same(kept[kept.length - 1], last)) kept[kept.length - 1] = last;
    return kept;
}

/** Whether a trail comes back to its beginning. @type {(trail: Point[], accuracy: number) => boolean} */
function closes(trail, accuracy) {
    return distance(trail[0], trail[trail.length - 1]) <= 3 * accuracy && way(trail) > 20 * accuracy;
}

/** The length of the way along points. @type {(points: Point[]) => number} */
const way = (points) => points.slice(1).reduce((sum, point, k) => sum + distance(point, points[k]), 0);

/**
 * The numbers of the points at which a trail has a corner: the sharpest of each run of sharp ones.
 * @param {Point[]} trail
 * @param {number} reach how far along it, before and after, its directions are taken
 * @returns {number[]}
 */
function cornersOf(trail, reach) {
    const cosines = trail.map((point, k) => {
        const before = chordFrom(trail, k, -1, reach);
        const after = chordFrom(trail, k, 1, reach);
        // Too near to an end to tell.
        if (!before || !after) return 1;
        return dot(minus(point, before), minus(after, point)) / (distance(point, before) * distance(after, point));
    });
    /** @type {number[]} */
    const corners = [];
    cosines.forEach((cosine, k) => {
        if (cosine >= CORNER) return;
        const last = corners.at(-1);
        const isNew = last === undefined || distance(trail[k], trail[last]) > reach;
        if (isNew) corners.push(k);
        else if (cosine < cosines[last]) corners[corners.length - 1] = k;
    });
    return corners;
}

/**
 * The first point at a distance from another, along a trail; null where there is none.
 * @type {(trail: Point[], from: number, step: 1 | -1, reach: number) => Point | null}
 */
function chordFrom(trail, from, step, reach) {
    for (let k = from + step; k >= 0 && k < trail.length; k += step) {
        if (distance(trail[k], trail[from]) >= reach) return trail[k];
    }
    return null;
}

/**
 * Cubics through a smooth run of points; they meet with one tangent.
 * @type {(points: Point[], accuracy: number) => Cubic[]}
 */
function fitted(points, accuracy) {
    const last = points.length - 1;
    return fitRun(
        points,
        unit(endTangent(points, 0, 1, accuracy)),
        unit(endTangent(points, last, -1, accuracy)),
        accuracy,
    );
}

/**
 * The direction in which a run leaves one of its ends, taken over some accuracies.
 * @type {(points: Point[], from: number, step: 1 | -1, accuracy: number) => Point}
 */
function endTangent(points, from, step, accuracy) {
    const towards = chordFrom(points, from, step, 3 * accuracy) ?? points[step > 0 ? points.length - 1 : 0];
    const [x, y] = minus(towards, points[from]);
    return x || y ? [x, y] : minus(points[from + step], points[from]);
}

/**
 * Cubics through a run of points that leave it in two directions, which point into the run.
 * @type {(points: Point[], leaving: Point, arriving: Point, accuracy: number) => Cubic[]}
 */
function fitRun(points, leaving, arriving, accuracy) {
    const [start, end] = [points[0], points[points.length - 1]];
    if (points.length === 2) return [straight(start, end, leaving, arriving)];
    let places = chordLengths(points);
    let worst = { error: Infinity, index: points.length >> 1 };
    for (let round = 0; round < ROUNDS; round++) {
        const cubic = leastSquares(points, places, leaving, arriving);
        worst = farthest(cubic, points, places);
        if (worst.error <= accuracy) return [cubic];
        if (worst.error > 16 * accuracy) break; // no parameters help there
        places = points.map((point, k) => improved(cubic, point, places[k]));
    }
    const { index } = worst;
    const through = unit(minus(points[index - 1], points[index + 1]));
    const back = same(through, [0, 0]) ? unit(minus(points[index - 1], points[index])) : through;
    return [
        ...fitRun(points.slice(0, index + 1), leaving, back, accuracy),
        ...fitRun(points.slice(index), scaled(back, -1), arriving, accuracy),
    ];
}

/**
 * A cubic with handles a third of its length.
 * @type {(start: Point, end: Point, leaving: Point, arriving: Point) => Cubic}
 */
function straight(start, end, leaving, arriving) {
    const third = distance(start, end) / 3;
    return [start, plus(start, scaled(leaving, third)), plus(end, scaled(arriving, third)), end];
}

/** The share of the way at which each point is. @type {(points: Point[]) => number[]} */
function chordLengths(points) {
    const sums = [0];
    for (let k = 1; k < points.length; k++) sums.push(sums[k - 1] + distance(points[k], points[k - 1]));
    return sums.map((sum) => sum / sums[sums.length - 1]);
}

/**
 * The cubic with given end directions that is nearest to points at given parameters.
 * @type {(points: Point[], places: number[], leaving: Point, arriving: Point) => Cubic}
 */
function leastSquares(points, places, leaving, arriving) {
    const [start, end] = [points[0], points[points.length - 1]];
    let [c00, c01, c11, x0, x1] = [0, 0, 0, 0, 0];
    points.forEach((point, k) => {
        const [t, s] = [places[k], 1 - places[k]];
        const [one, other] = [scaled(leaving, 3 * s * s * t), scaled(arriving, 3 * s * t * t)];
        const rest = minus(point, between(start, end, s * t * t * 3 + t * t * t));
        c00 += dot(one, one);
        c01 += dot(one, other);
        c11 += dot(other, other);
        x0 += dot(one, rest);
        x1 += dot(other, rest);
    });
    const determinant = c00 * c11 - c01 * c01;
    const [first, second] = [(x0 * c11 - x1 * c01) / determinant, (c00 * x1 - c01 * x0) / determinant];
    const [least, most] = [1e-3 * distance(start, end), 2 * way(points)];
    // Handles that would point the wrong way, or none at all; or that points which are nearly on a line leave open.
    if (![first, second].every((size) => size > least && size < most)) return straight(start, end, leaving, arriving);
    return [start, plus(start, scaled(leaving, first)), plus(end, scaled(arriving, second)), end];
}

/**
 * The point that is farthest from its place on a cubic, but for the ends.
 * @type {(cubic: Cubic, points: Point[], places: number[]) => {error: number, index: number}}
 */
function farthest(cubic, points, places) {
    const flat = Float64Array.from(cubic.flat());
    return points.slice(1, -1).reduce(
        (worst, point, k) => {
            const error = distance(pointOn(flat, 0, places[k + 1]), point);
            return error > worst.error ? { error, index: k + 1 } : worst;
        },
        { error: 0, index: 1 },
    );
}

/**
 * A step of Newton's method towards the parameter of the point nearest to another.
 * @type {(cubic: Cubic, point: Point, t: number) => number}
 */
function improved(cubic, point, t) {
    const away = minus(pointOn(Float64Array.from(cubic.flat()), 0, t), point);
    const legs = [0, 1, 2].map((k) => scaled(minus(cubic[k + 1], cubic[k]), 3));
    const bends = [0, 1].map((k) => scaled(minus(legs[k + 1], legs[k]), 2));
    const first = between(between(legs[0], legs[1], t), between(legs[1], legs[2], t), t);
    const second = between(bends[0], bends[1], t);
    const slope = dot(first, first) + dot(away, second);
    const next = slope > 0 ? t - dot(away, first) / slope : t;
    return Math.min(1, Math.max(0, next));
}
