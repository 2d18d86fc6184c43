// @ts-check
/** The handles of anchors: pulled out, taken back, made even, and as the pen draws them. */

import { anchorOf, asBezier, chainsOf, handlesOf, isClosed, isSmooth, numbered, strokesOf } from "./chains.js";
import { inverse, length, minus, plus, same, scaled, tidyMinus, tidyPlus, tidyScaled, turned, unit } from "./plane.js";
import { kindOf, pointsOf, tangentsOf, unplace } from "./strokes.js";

/** @import { Point } from "./plane.js" */
/** @import { Chain } from "./chains.js" */
/** @import { Stroke } from "./design.js" */
/** @import { Placement } from "./strokes.js" */

/**
 * A stroke with one anchor's handles pulled out to a point of the drawing, the other one opposite.
 *
 * Straight lines become a `bezier`; curves through points alone, circles and drawings stay as they are.
 * @type {(stroke: Stroke, placement: Placement, node: number, to: Point) => Stroke}
 */
export function pullHandles(stroke, placement, node, to) {
    const handle = unplace(placement, to);
    return withAnchor(stroke, node, (chain, anchor) => {
        const [before, after] = handlesOf(chain, anchor);
        const other = tidyMinus(scaled(chain[anchor], 2), handle);
        // At the end of an open chain the handle before is the one in the hand.
        return after < 0 ? [handle, null] : [before < 0 ? null : other, handle];
    });
}

/**
 * A stroke with a smooth anchor made a corner, its handles gone; or a corner smooth.
 *
 * Straight lines become a `bezier`; curves through points alone, circles and drawings stay as they are.
 * @type {(stroke: Stroke, node: number) => Stroke}
 */
export function toggleSmooth(stroke, node) {
    return withAnchor(stroke, node, (chain, anchor) => {
        const at = chain[anchor];
        const [before, after] = handlesOf(chain, anchor);
        const hasHandles = [before, after].some((k) => k >= 0 && !same(chain[k], at));
        if (isSmooth(chain, anchor) || (hasHandles && (before < 0 || after < 0))) return [at, at];
        return smoothHandles(chain, anchor);
    });
}

/**
 * Handles of an anchor that make it smooth: along the line from the anchor before to the one after, a third of the way
 * to each long; handles that are there keep their lengths.
 * @type {(chain: Chain, anchor: number) => [Point | null, Point | null]}
 */
function smoothHandles(chain, anchor) {
    const at = chain[anchor];
    const [before, after] = handlesOf(chain, anchor);
    const previous = before < 0 ? at : chain[before - 2];
    const next = after < 0 ? at : chain[after + 2];
    const along = minus(next, previous);
    // A chain that turns back: across.
    const direction = same(along, [0, 0]) ? /** @type {Point} */ ([at[1] - next[1], next[0] - at[0]]) : along;
    const forward = unit(direction);
    const size = (/** @type {number} */ handle, /** @type {Point} */ neighbour) =>
        length(minus(chain[handle], at)) || length(minus(neighbour, at)) / 3;
    return [
        before < 0 ? null : plus(at, scaled(forward, -size(before, previous))),
        after < 0 ? null : plus(at, scaled(forward, size(after, next))),
    ];
}

/**
 * A stroke with the handles of one anchor set, before and after it; null leaves one as it is.
 * @param {Stroke} stroke
 * @param {number} node
 * @param {(chain: Chain, anchor: number) => [Point | null, Point | null]} handles
 * @returns {Stroke}
 */
function withAnchor(stroke, node, handles) {
    const kind = kindOf(stroke);
    const straight = kind === "segment" || kind === "polyline";
    const found = straight ? asBezier(stroke)[0] : stroke;
    if (!found || !(straight || kind === "bezier" || kind === "hermite" || kind === "path")) return stroke;
    const wanted = straight ? 3 * node : node;
    const chains = chainsOf(found);
    const held = numbered(chains).find(({ chain, offset }) => wanted < offset + chain.length);
    if (!held) return stroke;
    const { chain, offset } = held;
    const anchor = anchorOf(chain, wanted - offset);
    const numbers = handlesOf(chain, anchor);
    const places = handles(chain, anchor);
    if (kind === "hermite") return withTangent(stroke, anchor / 3, chain[anchor], places);
    const changed = [...chain];
    numbers.forEach((number, side) => {
        const place = places[side];
        if (number >= 0 && place) changed[number] = place;
    });
    return strokesOf(
        found,
        chains.map((old) => (old === chain ? changed : old)),
    )[0];
}

/**
 * A `hermite` stroke with the tangent at one point taken from its handles.
 * @type {(stroke: Stroke, index: number, at: Point, handles: [Point | null, Point | null]) => Stroke}
 */
function withTangent(stroke, index, at, [before, after]) {
    const points = pointsOf(stroke);
    const isTwin = (/** @type {number} */ k) => index === 0 && k === points.length - 1 && isClosed(points);
    const tangent = tidyScaled(after ? tidyMinus(after, at) : tidyMinus(at, before ?? at), 3);
    return { ...stroke, tangents: tangentsOf(stroke).map((old, k) => (k === index || isTwin(k) ? tangent : old)) };
}

/**
 * @typedef {object} PenPoint a point with its handles, as vectors from it, in the drawing
 * @property {Point} at
 * @property {Point} in
 * @property {Point} out
 */

/**
 * The stroke of the pen: `hermite` while the handles of each point are opposite and as long, else `bezier`.
 * @type {(points: readonly PenPoint[], placement: Placement) => Stroke}
 */
export function penStroke(points, placement) {
    const back = inverse(placement);
    const own = points.map((point) => ({
        at: unplace(placement, point.at),
        before: turned(back, point.in),
        after: turned(back, point.out),
    }));
    const last = own.length - 1;
    const isEven = points.every((point, k) => k === 0 || k === last || same(point.in, scaled(point.out, -1)));
    const closes = last > 0 && same(points[0].at, points[last].at);
    if (isEven && (!closes || same(points[last].in, scaled(points[0].out, -1)))) {
        const tangents = own.map(({ before, after }, k) => tidyScaled(k < last ? after : scaled(before, -1), 3));
        return { hermite: own.map(({ at }) => at), tangents };
    }
    const chain = own.flatMap(({ at, before, after }) => [tidyPlus(at, before), at, tidyPlus(at, after)]);
    return { bezier: chain.slice(1, -1) };
}
