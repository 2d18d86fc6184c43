// @ts-check
/** Strokes as chains of cubic Bezier pieces, before they are placed: anchors and handles, and strokes made of them. */

import { cross, dot, length, minus, same } from "./plane.js";
import { cubicsOf, kindOf } from "./strokes.js";

/** @import { Point } from "./plane.js" */
/** @import { Stroke } from "./design.js" */

/** @typedef {Point[]} Chain 3 n + 1 control points; it is closed where the last is the first */

/** Whether points, two at least, end where they begin. @type {(points: readonly Point[]) => boolean} */
export const isClosed = (points) => points.length > 1 && same(points[0], points[points.length - 1]);

/**
 * Chains with the numbers of their first control points among those of all.
 * @type {(chains: Chain[]) => {chain: Chain, offset: number}[]}
 */
export function numbered(chains) {
    let end = 0;
    return chains.map((chain) => ({ chain, offset: (end += chain.length) - chain.length }));
}

/**
 * The chains of a stroke: one, but for path data with several moves.
 * @param {Stroke} stroke
 * @param {string} [resolved] the path data of a file
 * @returns {Chain[]}
 */
export function chainsOf(stroke, resolved) {
    const cubics = cubicsOf(stroke, undefined, resolved);
    /** @type {Chain[]} */
    const chains = [];
    for (let k = 0; k < cubics.length; k += 8) {
        const points = /** @type {Chain} */ ([0, 2, 4, 6].map((n) => [cubics[k + n], cubics[k + n + 1]]));
        const last = chains.at(-1);
        if (last && same(last[last.length - 1], points[0])) last.push(...points.slice(1));
        else chains.push(points);
    }
    return chains;
}

/**
 * The strokes that are the chains of another one: one of kind `path` where it was one, else a `bezier` each.
 *
 * Keys that place it, and unknown ones, are kept.
 * @type {(stroke: Stroke, chains: Chain[]) => Stroke[]}
 */
export function strokesOf(stroke, chains) {
    if (kindOf(stroke) === "path") return chains.length ? [{ ...stroke, path: pathData(chains) }] : [];
    return chains.map((chain) => withKind(stroke, "bezier", chain));
}

/**
 * A stroke of another kind, with what does not belong to that left out.
 * @type {(stroke: Stroke, kind: "segment" | "polyline" | "bezier", points: Point[]) => Stroke}
 */
export function withKind(stroke, kind, points) {
    const own = new Set([kindOf(stroke), "tangents", "alpha", "closed", "radius", "layer", "id"]);
    const others = Object.entries(stroke).filter(([key]) => !own.has(key));
    return { [kind]: points, ...Object.fromEntries(others) };
}

/**
 * A stroke as strokes of kind `bezier`: one for each of its chains.
 * @param {Stroke} stroke
 * @param {string} [resolved] the path data of a file
 * @returns {Stroke[]}
 */
export function asBezier(stroke, resolved) {
    if (kindOf(stroke) === "bezier") return [stroke];
    return chainsOf(stroke, resolved).map((chain) => withKind(stroke, "bezier", chain));
}

/**
 * Chains as SVG path data: lines where both inner control points are on their ends.
 * @type {(chains: Chain[]) => string}
 */
function pathData(chains) {
    return chains.map((chain) => `M ${chain[0].join(" ")}${pieces(chain).map(command).join("")}`).join(" ");
}

/** A piece as a command. @type {(piece: Point[]) => string} */
function command([start, first, second, end]) {
    const isLine = same(start, first) && same(second, end);
    return isLine ? ` L ${end.join(" ")}` : ` C ${[first, second, end].flat().join(" ")}`;
}

/** The pieces of a chain, 4 control points each. @type {(chain: Chain) => Point[][]} */
export function pieces(chain) {
    return Array.from({ length: (chain.length - 1) / 3 }, (_, k) => chain.slice(3 * k, 3 * k + 4));
}

/** The sine of an angle that is none, between the two handles of a smooth anchor. */
const STRAIGHT = 1e-6;

/**
 * The number of a control point's anchor; the last one of a closed chain is the first.
 * @type {(chain: Chain, k: number) => number}
 */
export function anchorOf(chain, k) {
    const anchor = 3 * Math.round(k / 3);
    return anchor === chain.length - 1 && isClosed(chain) ? 0 : anchor;
}

/**
 * The numbers of the handles before and after an anchor, -1 for one that there is not.
 * @type {(c: Chain, k: number) => [number, number]}
 */
export function handlesOf(chain, anchor) {
    const closed = isClosed(chain);
    const before = anchor > 0 ? anchor - 1 : closed ? chain.length - 2 : -1;
    return [before, anchor < chain.length - 1 ? anchor + 1 : -1];
}

/**
 * Whether both handles of an anchor are there, and point opposite ways.
 * @type {(chain: Chain, anchor: number) => boolean}
 */
export function isSmooth(chain, anchor) {
    const [before, after] = handlesOf(chain, anchor).map((k) => (k < 0 ? null : minus(chain[k], chain[anchor])));
    if (!before || !after) return false;
    const sizes = length(before) * length(after);
    return sizes > 0 && dot(before, after) < 0 && Math.abs(cross(before, after)) <= STRAIGHT * sizes;
}
