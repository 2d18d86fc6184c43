// @ts-check
/** Nodes put into strokes and taken out of them. */

import { asBezier, chainsOf, isClosed, numbered, pieces, strokesOf, withKind } from "./chains.js";
import { between, length, minus, plus, same, scaled } from "./plane.js";
import { pointOn } from "./nearest.js";
import { rounded } from "./snapping.js";
import { cubicsOf, kindOf, pointsOf, tangentsOf } from "./strokes.js";

/** @import { Point } from "./plane.js" */
/** @import { Chain } from "./chains.js" */
/** @import { Stroke } from "./design.js" */

/** The fewest points that a listed kind needs, open and closed. @type {Readonly<Record<string, [number, number]>>} */
const LEAST = { segment: [2, 2], polyline: [2, 3], catmull_rom: [2, 3], bspline: [4, 3] };

/**
 * A stroke with a node more at the parameter t of one of its pieces.
 *
 * Straight lines and Bezier curves keep their shape, and `hermite` ones too, as `bezier`; curves through points get one
 * more. Points, circles and drawings stay as they are.
 * @param {Stroke} stroke
 * @param {number} piece
 * @param {number} t
 * @param {number} [pixel] what a listed point is rounded by, as one that is placed is; 0: not at all
 * @returns {Stroke}
 */
export function insertNode(stroke, piece, t, pixel = 0) {
    const kind = kindOf(stroke);
    switch (kind) {
        case "point":
        case "circle":
        case "file":
            return stroke;
        case "bezier":
        case "hermite":
        case "path": {
            const found = kind === "hermite" ? asBezier(stroke)[0] : stroke;
            return (found && strokesOf(found, splitChains(chainsOf(found), piece, t))[0]) ?? stroke;
        }
        default: {
            const points = [...pointsOf(stroke)];
            const cubics = cubicsOf(stroke);
            if (8 * piece >= cubics.length) return stroke;
            // The piece k of a B-spline is near its points k + 1 and k + 2.
            const place = (piece + (kind === "bspline" ? 2 : 1)) % (points.length + 1);
            const at = pointOn(cubics, piece, t);
            points.splice(place, 0, pixel ? rounded(at, pixel) : at);
            return kind === "segment" ? withKind(stroke, "polyline", points) : { ...stroke, [kind]: points };
        }
    }
}

/**
 * Chains with one piece divided (de Casteljau).
 * @param {Chain[]} chains
 * @param {number} piece its number among those of all chains
 * @param {number} t
 * @returns {Chain[]}
 */
function splitChains(chains, piece, t) {
    let first = 0;
    return chains.map((chain) => {
        const at = piece - first;
        const count = (chain.length - 1) / 3;
        first += count;
        if (at < 0 || at >= count) return chain;
        const [p, q, r, s] = chain.slice(3 * at, 3 * at + 4);
        const [pq, qr, rs] = [between(p, q, t), between(q, r, t), between(r, s, t)];
        const [pqr, qrs] = [between(pq, qr, t), between(qr, rs, t)];
        // A line stays one.
        const isLine = same(p, q) && same(r, s);
        const middle = between(pqr, qrs, t);
        const inner = isLine ? [p, middle, middle, middle, s] : [pq, pqr, middle, qrs, rs];
        return [...chain.slice(0, 3 * at + 1), ...inner, ...chain.slice(3 * at + 3)];
    });
}

/**
 * What is left of a stroke without some of its nodes: usually one stroke.
 *
 * The curve heals over an anchor; with `cut` its pieces at the anchor go as well. A handle goes back into its anchor.
 * What has too few points left for its kind becomes a polyline; with fewer than two points nothing is left.
 * @type {(stroke: Stroke, nodes: readonly number[], how?: {cut?: boolean}) => Stroke[]}
 */
export function deleteNodes(stroke, nodes, { cut = false } = {}) {
    const gone = new Set(nodes);
    const kind = kindOf(stroke);
    switch (kind) {
        case "point":
        case "circle":
            return gone.has(0) ? [] : [stroke];
        case "file":
            return [stroke];
        case "hermite":
            if (!cut && nodes.every((node) => node % 3 === 0)) return healedHermite(stroke, gone);
            return asBezier(stroke).flatMap((bezier) => deleteNodes(bezier, nodes, { cut }));
        case "bezier":
        case "path":
            return strokesOf(stroke, withoutNodes(chainsOf(stroke), gone, cut));
        default:
            return cut ? cutPoints(stroke, gone) : listed(stroke, kept(pointsOf(stroke), gone), stroke.closed ?? false);
    }
}

/** The items of a list whose numbers are not among some. @type {<T>(list: readonly T[], gone: Set<number>) => T[]} */
const kept = (list, gone) => list.filter((_, k) => !gone.has(k));

/**
 * A stroke of a listed kind with other points, or what can be made of them.
 * @type {(stroke: Stroke, points: Point[], closed: boolean) => Stroke[]}
 */
function listed(stroke, points, closed) {
    const kind = kindOf(stroke);
    if (points.length < 2) return [];
    const [open, round] = LEAST[kind];
    const { closed: _, ...others } = stroke;
    if (closed && points.length >= round) return [{ ...stroke, [kind]: points }];
    if (points.length >= open) return [{ ...others, [kind]: points }];
    return [withKind(stroke, "polyline", points)];
}

/**
 * The parts of a listed stroke between points that are cut out.
 * @type {(stroke: Stroke, gone: Set<number>) => Stroke[]}
 */
function cutPoints(stroke, gone) {
    const points = pointsOf(stroke);
    if (!points.some((_, k) => gone.has(k))) return [stroke];
    // A closed one begins behind a point that is cut out.
    const start = stroke.closed ? points.findIndex((_, k) => gone.has(k)) : 0;
    /** @type {Point[][]} */
    const runs = [[]];
    for (let k = 0; k < points.length; k++) {
        const index = (start + k) % points.length;
        if (gone.has(index)) runs.push([]);
        else runs[runs.length - 1].push(points[index]);
    }
    return runs.flatMap((run) => listed(stroke, run, false));
}

/**
 * A `hermite` stroke without some of its points; the last one of a closed one is its first.
 * @type {(stroke: Stroke, gone: Set<number>) => Stroke[]}
 */
function healedHermite(stroke, gone) {
    const [points, tangents] = [pointsOf(stroke), tangentsOf(stroke)];
    const last = points.length - 1;
    const closed = isClosed(points);
    const stays = points.flatMap((_, k) => (gone.has(3 * k) || (closed && k === last) ? [] : [k]));
    if (stays.length < 2) return [];
    const ring = closed && stays.length > 2 ? [...stays, stays[0]] : stays;
    return [{ ...stroke, hermite: ring.map((k) => points[k]), tangents: ring.map((k) => tangents[k]) }];
}

/**
 * Chains without some of their control points, which are numbered through all of them.
 * @type {(chains: Chain[], gone: Set<number>, cut: boolean) => Chain[]}
 */
function withoutNodes(chains, gone, cut) {
    return numbered(chains).flatMap(({ chain, offset }) => {
        const has = (/** @type {number} */ k) => gone.has(offset + k);
        const whole = chain.map((point, k) => (k % 3 && has(k) ? chain[3 * Math.round(k / 3)] : point));
        const anchors = new Set(chain.flatMap((_, k) => (k % 3 === 0 && has(k) ? [k / 3] : [])));
        if (!anchors.size) return [whole];
        const closed = isClosed(chain);
        const ring = closed ? rotated(whole, behindAny(anchors, whole, cut)) : { chain: whole, from: 0 };
        const count = (chain.length - 1) / 3;
        const isGone = (/** @type {number} */ anchor) => anchors.has(closed ? (ring.from + anchor) % count : anchor);
        return cut ? cutChain(ring.chain, isGone) : healedChain(ring.chain, isGone, closed);
    });
}

/**
 * The anchor at which a closed chain is opened: one that is cut out, else one that stays.
 * @type {(a: Set<number>, c: Chain, cut: boolean) => number}
 */
function behindAny(anchors, chain, cut) {
    const count = (chain.length - 1) / 3;
    const numbers = Array.from({ length: count }, (_, k) => k);
    return Math.max(
        0,
        numbers.findIndex((k) => anchors.has(k) === cut),
    );
}

/**
 * A closed chain that begins at another anchor, and that anchor.
 * @type {(chain: Chain, from: number) => {chain: Chain, from: number}}
 */
function rotated(chain, from) {
    const ring = chain.slice(0, -1);
    const turned = [...ring.slice(3 * from), ...ring.slice(0, 3 * from)];
    return { chain: [...turned, turned[0]], from };
}

/**
 * The runs of pieces that end at no anchor that is gone.
 * @type {(chain: Chain, isGone: (k: number) => boolean) => Chain[]}
 */
function cutChain(chain, isGone) {
    /** @type {Chain[]} */
    const runs = [];
    let open = false;
    pieces(chain).forEach((piece, k) => {
        const stays = !isGone(k) && !isGone(k + 1);
        if (stays && open) runs[runs.length - 1].push(...piece.slice(1));
        else if (stays) runs.push(piece);
        open = stays;
    });
    return runs;
}

/**
 * A chain whose pieces at each anchor that is gone have become one.
 * @type {(chain: Chain, isGone: (anchor: number) => boolean, closed: boolean) => Chain[]}
 */
function healedChain(chain, isGone, closed) {
    /** @type {Point[][]} */
    const merged = [];
    let pending = false; // whether the last piece ends at an anchor that is gone
    pieces(chain).forEach((piece, k) => {
        if (pending) merged.push(joined(/** @type {Point[]} */ (merged.pop()), piece));
        else if (!isGone(k)) merged.push(piece);
        pending = isGone(k + 1) && merged.length > 0;
    });
    // An open chain ends at the last anchor that stays.
    if (pending) merged.pop();
    if (!merged.length || (closed && isGone(0))) return [];
    return [[merged[0][0], ...merged.flatMap((piece) => piece.slice(1))]];
}

/**
 * One piece in the place of two: the inverse of a division, where they came from one.
 * @type {(before: Point[], after: Point[]) => Point[]}
 */
function joined([start, first, incoming, middle], [, outgoing, last, end]) {
    const [left, right] = [length(minus(middle, incoming)), length(minus(outgoing, middle))];
    const [chordLeft, chordRight] = [length(minus(middle, start)), length(minus(end, middle))];
    const t = left && right ? left / (left + right) : chordLeft / (chordLeft + chordRight || 1);
    const share = Math.min(0.95, Math.max(0.05, t));
    const handle = (/** @type {Point} */ from, /** @type {Point} */ to, /** @type {number} */ by) =>
        plus(from, scaled(minus(to, from), 1 / by));
    return [start, handle(start, first, share), handle(end, last, 1 - share), end];
}
