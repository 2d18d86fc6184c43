// @ts-check
/**
 * The nodes of strokes: what is dragged, and what becomes of the stroke.
 *
 * A node is known by its number: that of the point in the stroke's list; for `hermite` and `path`, as for `bezier`,
 * that of the control point in the chains of cubic pieces; a circle has its centre, 0, and its rim, 1. A handle that
 * lies on its anchor is no node. Nodes are in the drawing's coordinates, strokes before their placement.
 */

import { asBezier, chainsOf, isClosed, strokesOf } from "./chains.js";
import { mapPoints } from "./design.js";
import { IDENTITY, apply, cross, dot, inverse, length, minus, plus, same, scaled, tidySum, turned } from "./plane.js";
import { kindOf, pointsOf, radiusOf, unplace } from "./strokes.js";

export { asBezier } from "./chains.js";
export { deleteNodes, insertNode } from "./reshaping.js";
export { nearestOn } from "./nearest.js";

/** @typedef {import("./plane.js").Point} Point */
/** @typedef {import("./chains.js").Chain} Chain */
/** @typedef {import("./design.js").Stroke} Stroke */
/** @typedef {import("./strokes.js").Placement} Placement */

/**
 * @typedef {object} Node
 * @property {number} node its number
 * @property {"anchor" | "in" | "out" | "centre" | "radius"} role
 * @property {Point} at
 * @property {number} of the number of its anchor, or of a circle's centre; its own for these
 * @property {boolean} smooth whether the curve has one tangent at its anchor
 */

/** @typedef {Readonly<{node: number, to: Point}>} Move */

/** The sine of an angle that is none, between the two handles of a smooth anchor. */
const STRAIGHT = 1e-6;

/**
 * The nodes of a stroke where it is placed, in the order of their numbers.
 *
 * @param {Stroke} stroke
 * @param {Placement} [placement]
 * @returns {Node[]}
 */
export function nodesOf(stroke, placement = IDENTITY) {
    const kind = kindOf(stroke);
    switch (kind) {
        case "file":
            return [];
        case "circle":
            return circleNodes(stroke, placement);
        case "bezier":
        case "hermite":
        case "path":
            return chainNodes(chainsOf(stroke), placement);
        default: {
            const smooth = kind === "catmull_rom" || kind === "bspline";
            return pointsOf(stroke).map((at, node) => ({
                node,
                role: "anchor",
                at: apply(placement, at),
                of: node,
                smooth,
            }));
        }
    }
}

/**
 * The nodes of a circle; its rim's is to the right, as a circle is not turned.
 *
 * @type {(s: Stroke, p: Placement) => Node[]}
 */
function circleNodes(stroke, placement) {
    return pointsOf(stroke).flatMap((own) => {
        const at = apply(placement, own);
        const rim = plus(at, [radiusOf(stroke, placement), 0]);
        return [
            { node: 0, role: "centre", at, of: 0, smooth: true },
            { node: 1, role: "radius", at: rim, of: 0, smooth: true },
        ];
    });
}

/**
 * The nodes of chains.
 *
 * @param {Chain[]} chains
 * @param {Placement} placement
 * @returns {Node[]}
 */
function chainNodes(chains, placement) {
    let first = 0;
    return chains.flatMap((chain) => {
        const offset = first;
        first += chain.length;
        return chain.flatMap((own, k) => {
            const anchor = anchorOf(chain, k);
            if (k % 3 === 0 ? k !== anchor : same(own, chain[anchor])) return [];
            const role = /** @type {const} */ (["anchor", "out", "in"])[k % 3];
            const at = apply(placement, own);
            return [{ node: offset + k, role, at, of: offset + anchor, smooth: isSmooth(chain, anchor) }];
        });
    });
}

/**
 * The number of a control point's anchor; the last one of a closed chain is the first.
 *
 * @type {(chain: Chain, k: number) => number}
 */
function anchorOf(chain, k) {
    const anchor = 3 * Math.round(k / 3);
    return anchor === chain.length - 1 && isClosed(chain) ? 0 : anchor;
}

/**
 * The numbers of the handles before and after an anchor, -1 for one that there is not.
 *
 * @type {(c: Chain, k: number) => [number, number]}
 */
function handlesOf(chain, anchor) {
    const closed = isClosed(chain);
    const before = anchor > 0 ? anchor - 1 : closed ? chain.length - 2 : -1;
    return [before, anchor < chain.length - 1 ? anchor + 1 : -1];
}

/**
 * Whether both handles of an anchor are there, and point opposite ways.
 *
 * @type {(chain: Chain, anchor: number) => boolean}
 */
function isSmooth(chain, anchor) {
    const [before, after] = handlesOf(chain, anchor).map((k) => (k < 0 ? null : minus(chain[k], chain[anchor])));
    if (!before || !after) return false;
    const sizes = length(before) * length(after);
    return sizes > 0 && dot(before, after) < 0 && Math.abs(cross(before, after)) <= STRAIGHT * sizes;
}

/**
 * A stroke with some nodes moved.
 *
 * An anchor takes its handles along. A handle of a smooth anchor turns the opposite one; with `alone` it does not, and
 * a `hermite` stroke, whose points have one tangent each, becomes a `bezier`.
 *
 * @param {Stroke} stroke
 * @param {Placement} placement
 * @param {readonly Move[]} moves
 * @param {{alone?: boolean}} [how]
 * @returns {Stroke}
 */
export function moveNodes(stroke, placement, moves, { alone = false } = {}) {
    const kind = kindOf(stroke);
    if (kind === "circle") return movedCircle(stroke, placement, moves);
    const nodes = new Map(nodesOf(stroke, placement).map((node) => [node.node, node]));
    const back = inverse(placement);
    // By how much each goes: so a coordinate that does not change keeps its digits.
    const shifts = new Map();
    for (const { node, to } of moves) {
        const from = nodes.get(node)?.at;
        if (from) shifts.set(node, turned(back, minus(to, from)));
    }
    switch (kind) {
        case "bezier":
        case "path":
            return movedChains(stroke, shifts, alone);
        case "hermite":
            return (alone || hasSeam(stroke)) && moves.some(({ node }) => node % 3)
                ? movedChains(asBezier(stroke)[0], shifts, alone)
                : movedHermite(stroke, shifts);
        default:
            return mapPoints(stroke, (point, k) => shifted(point, shifts.get(k)));
    }
}

/** A point moved by a vector, if there is one. @type {(point: Point, shift: Point | undefined) => Point} */
const shifted = (point, shift) => (shift ? [tidySum(point[0], shift[0]), tidySum(point[1], shift[1])] : point);

/**
 * A circle with its centre moved, or its rim moved to a point.
 *
 * @param {Stroke} stroke
 * @param {Placement} placement
 * @param {readonly Move[]} moves
 * @returns {Stroke}
 */
function movedCircle(stroke, placement, moves) {
    const [own] = pointsOf(stroke);
    const centreTo = moves.find(({ node }) => node === 0)?.to;
    const rimTo = moves.find(({ node }) => node === 1)?.to;
    const old = apply(placement, own);
    const circle = centreTo ? shifted(own, turned(inverse(placement), minus(centreTo, old))) : own;
    const wanted = rimTo && length(minus(rimTo, centreTo ?? old)) / length(placement.a);
    // Sums, so that a rim that goes with its centre leaves the radius as it is written.
    const radius = wanted ? tidySum(stroke.radius ?? 0, wanted - (stroke.radius ?? 0)) : stroke.radius;
    return { ...stroke, circle, radius };
}

/**
 * A `hermite` stroke with some nodes moved: a handle is a third of the tangent, before the point its opposite.
 *
 * @param {Stroke} stroke
 * @param {Map<number, Point>} shifts
 * @returns {Stroke}
 */
function movedHermite(stroke, shifts) {
    const points = pointsOf(stroke);
    const tangents = tangentsOf(stroke);
    const last = points.length - 1;
    const closed = last > 0 && same(points[0], points[last]);
    const anchor = (/** @type {number} */ k) => shifts.get(closed && k === last ? 0 : 3 * k);
    /** @type {Point[]} */
    const newTangents = tangents.map((tangent, k) => {
        // In a closed curve the handle before the first point is the one before the last.
        const [before, after] = closed && (k === 0 || k === last) ? [3 * last - 1, 1] : [3 * k - 1, 3 * k + 1];
        const own = anchor(k) ?? [0, 0];
        const [backward, forward] = [shifts.get(before), shifts.get(after)];
        const longer = forward ? minus(forward, own) : backward ? minus(own, backward) : /** @type {Point} */ ([0, 0]);
        return same(longer, [0, 0]) ? tangent : shifted(tangent, scaled(longer, 3));
    });
    return { ...mapPoints(stroke, (point, k) => shifted(point, anchor(k))), tangents: newTangents };
}

/** Whether a closed `hermite` stroke has a corner where its ends meet. @type {(stroke: Stroke) => boolean} */
function hasSeam(stroke) {
    const [points, tangents] = [pointsOf(stroke), tangentsOf(stroke)];
    const last = points.length - 1;
    return last > 0 && same(points[0], points[last]) && !same(tangents[0], tangents[last]);
}

/** The tangents of a `hermite` stroke, one for each point. @type {(stroke: Stroke) => Point[]} */
const tangentsOf = (stroke) => pointsOf(stroke).map((_, k) => stroke.tangents?.[k] ?? [0, 0]);

/**
 * A stroke of chains with some nodes moved.
 *
 * @param {Stroke} stroke
 * @param {Map<number, Point>} shifts
 * @param {boolean} alone
 * @returns {Stroke}
 */
function movedChains(stroke, shifts, alone) {
    let first = 0;
    const chains = chainsOf(stroke).map((chain) => {
        const offset = first;
        first += chain.length;
        const shiftOf = (/** @type {number} */ k) => shifts.get(offset + k);
        return movedChain(chain, shiftOf, alone);
    });
    return strokesOf(stroke, chains)[0] ?? stroke;
}

/**
 * A chain with some points moved.
 *
 * @param {Chain} chain
 * @param {(k: number) => Point | undefined} shiftOf by how much, for those that are moved
 * @param {boolean} alone
 * @returns {Chain}
 */
function movedChain(chain, shiftOf, alone) {
    const moved = chain.map((point, k) => shifted(point, shiftOf(k) ?? shiftOf(anchorOf(chain, k))));
    if (alone) return moved;
    for (let anchor = 0; anchor < chain.length; anchor += 3) {
        const [before, after] = handlesOf(chain, anchor);
        if (!isSmooth(chain, anchor) || !shiftOf(before) === !shiftOf(after)) continue;
        const [held, other] = shiftOf(before) ? [before, after] : [after, before];
        const size = length(minus(chain[other], chain[anchor]));
        moved[other] = opposite(moved[anchor], moved[held], size);
    }
    return moved;
}

/**
 * The point opposite to a handle, at a distance from the anchor.
 *
 * @param {Point} anchor
 * @param {Point} handle
 * @param {number} size
 * @returns {Point}
 */
function opposite(anchor, handle, size) {
    const direction = minus(anchor, handle);
    const own = length(direction);
    return own ? plus(anchor, scaled(direction, size / own)) : anchor;
}

/**
 * A stroke with one anchor's handles pulled out to a point of the drawing, the other one opposite.
 *
 * Straight lines become a `bezier`; curves through points alone, circles and drawings stay as they are.
 *
 * @param {Stroke} stroke
 * @param {Placement} placement
 * @param {number} node
 * @param {Point} to
 * @returns {Stroke}
 */
export function pullHandles(stroke, placement, node, to) {
    const handle = unplace(placement, to);
    return withAnchor(stroke, node, (chain, anchor) => {
        const [before, after] = handlesOf(chain, anchor);
        const other = minus(scaled(chain[anchor], 2), handle);
        // At the end of an open chain the handle before is the one in the hand.
        return after < 0 ? [handle, null] : [before < 0 ? null : other, handle];
    });
}

/**
 * A stroke with a smooth anchor made a corner, its handles gone; or a corner smooth.
 *
 * Straight lines become a `bezier`; curves through points alone, circles and drawings stay as they are.
 *
 * @param {Stroke} stroke
 * @param {number} node
 * @returns {Stroke}
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
 *
 * @param {Chain} chain
 * @param {number} anchor
 * @returns {[Point | null, Point | null]}
 */
function smoothHandles(chain, anchor) {
    const at = chain[anchor];
    const [before, after] = handlesOf(chain, anchor);
    const previous = before < 0 ? at : chain[before - 2];
    const next = after < 0 ? at : chain[after + 2];
    const along = minus(next, previous);
    // A chain that turns back: across.
    const direction = same(along, [0, 0]) ? /** @type {Point} */ ([at[1] - next[1], next[0] - at[0]]) : along;
    const unit = scaled(direction, 1 / (length(direction) || 1));
    const size = (/** @type {number} */ handle, /** @type {Point} */ neighbour) =>
        length(minus(chain[handle], at)) || length(minus(neighbour, at)) / 3;
    return [
        before < 0 ? null : plus(at, scaled(unit, -size(before, previous))),
        after < 0 ? null : plus(at, scaled(unit, size(after, next))),
    ];
}

/**
 * A stroke with the handles of one anchor set, before and after it; null leaves one as it is.
 *
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
    let offset = 0;
    const wanted = straight ? 3 * node : node;
    const chains = chainsOf(found);
    const index = chains.findIndex((chain) => {
        if (wanted < offset + chain.length) return true;
        offset += chain.length;
        return false;
    });
    if (index < 0) return stroke;
    const chain = chains[index];
    const anchor = anchorOf(chain, wanted - offset);
    const numbers = handlesOf(chain, anchor);
    const places = handles(chain, anchor);
    if (kind === "hermite") return withTangent(stroke, anchor / 3, chain[anchor], places);
    const changed = [...chain];
    numbers.forEach((number, side) => {
        const place = places[side];
        if (number >= 0 && place) changed[number] = place;
    });
    return strokesOf(found, chains.map((old) => (old === chain ? changed : old)))[0];
}

/**
 * A `hermite` stroke with the tangent at one point taken from its handles.
 *
 * @param {Stroke} stroke
 * @param {number} index
 * @param {Point} at
 * @param {[Point | null, Point | null]} handles
 * @returns {Stroke}
 */
function withTangent(stroke, index, at, [before, after]) {
    const points = pointsOf(stroke);
    const isTwin = (/** @type {number} */ k) => index === 0 && k === points.length - 1 && same(points[k], points[0]);
    const tangent = after ? scaled(minus(after, at), 3) : scaled(minus(at, before ?? at), 3);
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
 *
 * @param {readonly PenPoint[]} points
 * @param {Placement} placement
 * @returns {Stroke}
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
        const tangents = own.map(({ before, after }, k) => scaled(k < last ? after : scaled(before, -1), 3));
        return { hermite: own.map(({ at }) => at), tangents };
    }
    const chain = own.flatMap(({ at, before, after }) => [plus(at, before), at, plus(at, after)]);
    return { bezier: chain.slice(1, -1) };
}
