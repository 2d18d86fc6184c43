// @ts-check
/**
 * The nodes of strokes: what is dragged, and what becomes of the stroke.
 *
 * A node is known by its number: that of the point in the stroke's list; for `hermite` and `path`, as for `bezier`,
 * that of the control point in the chains of cubic pieces; a circle has its centre, 0, and its rim, 1. A handle that
 * lies on its anchor is no node. Nodes are in the drawing's coordinates, strokes before their placement.
 */

import { anchorOf, asBezier, chainsOf, handlesOf, isClosed, isSmooth, numbered, strokesOf } from "./chains.js";
import { mapPoints } from "./design.js";
import {
    IDENTITY,
    apply,
    inverse,
    length,
    minus,
    plus,
    same,
    scaled,
    tidyPlus,
    tidySum,
    turned,
    unit,
} from "./plane.js";
import { kindOf, pointsOf, radiusOf, tangentsOf } from "./strokes.js";

export { asBezier } from "./chains.js";
export { penStroke, pullHandles, toggleSmooth } from "./handles.js";
export { nearestOn } from "./nearest.js";
export { deleteNodes, insertNode } from "./reshaping.js";

/** @import { Point } from "./plane.js" */
/** @import { Chain } from "./chains.js" */
/** @import { Stroke } from "./design.js" */
/** @import { Placement } from "./strokes.js" */

/**
 * @typedef {object} Node
 * @property {number} node its number
 * @property {"anchor" | "in" | "out" | "centre" | "radius"} role
 * @property {Point} at
 * @property {number} of the number of its anchor, or of a circle's centre; its own for these
 * @property {boolean} smooth whether the curve has one tangent at its anchor
 */

/** @typedef {Readonly<{node: number, to: Point}>} Move */

/**
 * The nodes of a stroke where it is placed, in the order of their numbers.
 * @type {(stroke: Stroke, placement?: Placement) => Node[]}
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

/** The nodes of chains. @type {(chains: Chain[], placement: Placement) => Node[]} */
function chainNodes(chains, placement) {
    return numbered(chains).flatMap(({ chain, offset }) =>
        chain.flatMap((own, k) => {
            const anchor = anchorOf(chain, k);
            if (k % 3 === 0 ? k !== anchor : same(own, chain[anchor])) return [];
            const role = /** @type {const} */ (["anchor", "out", "in"])[k % 3];
            const at = apply(placement, own);
            return [{ node: offset + k, role, at, of: offset + anchor, smooth: isSmooth(chain, anchor) }];
        }),
    );
}

/**
 * A stroke with some nodes moved.
 *
 * An anchor takes its handles along. A handle of a smooth anchor turns the opposite one; with `alone` it does not, and
 * a `hermite` stroke, whose points have one tangent each, becomes a `bezier`.
 * @type {(stroke: Stroke, placement: Placement, moves: readonly Move[], how?: {alone?: boolean}) => Stroke}
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
const shifted = (point, shift) => (shift ? tidyPlus(point, shift) : point);

/**
 * A circle with its centre moved, or its rim moved to a point.
 * @type {(stroke: Stroke, placement: Placement, moves: readonly Move[]) => Stroke}
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
 * @type {(stroke: Stroke, shifts: Map<number, Point>) => Stroke}
 */
function movedHermite(stroke, shifts) {
    const points = pointsOf(stroke);
    const tangents = tangentsOf(stroke);
    const last = points.length - 1;
    const closed = isClosed(points);
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
    return isClosed(points) && !isClosed(tangents);
}

/**
 * A stroke of chains with some nodes moved.
 * @type {(stroke: Stroke, shifts: Map<number, Point>, alone: boolean) => Stroke}
 */
function movedChains(stroke, shifts, alone) {
    const chains = numbered(chainsOf(stroke)).map(({ chain, offset }) =>
        movedChain(chain, (k) => shifts.get(offset + k), alone),
    );
    return strokesOf(stroke, chains)[0] ?? stroke;
}

/**
 * A chain with some points moved.
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
 * @type {(anchor: Point, handle: Point, size: number) => Point}
 */
function opposite(anchor, handle, size) {
    return plus(anchor, scaled(unit(minus(anchor, handle)), size));
}
