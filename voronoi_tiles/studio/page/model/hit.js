// @ts-check
/** What is under the pointer, or in a box: strokes and nodes. */

import { apply, distance, inverse } from "./plane.js";
import { nearestOn } from "./nearest.js";
import { imagesIn } from "./lattice.js";
import { boxOf } from "./segments.js";

/** @import { Point } from "./plane.js" */
/** @import { NodeRef, Ref } from "./design.js" */
/** @import { Node } from "./nodes.js" */
/** @import { Motion } from "./symmetry.js" */
/** @import { Lattice } from "./lattice.js" */
/** @typedef {import("./plane.js").Box} Box left, bottom, right, top */

/** @typedef {Node & {ref: Ref}} OwnedNode a node with the reference of its stroke */
/** @typedef {{ref: Ref, cubics: Float64Array}} Drawn a stroke with its pieces where it is placed */

/**
 * Which of two nodes at one place is taken: handles hide under their anchors.
 * @type {Readonly<Record<string, number>>}
 */
const ORDER = { in: 0, out: 0, radius: 0, anchor: 1, centre: 1 };

/**
 * The node that is nearest to a point, null where none is within reach. Of two at one place the handle is taken, and of
 * two such the later one, which is drawn above the other.
 * @template {OwnedNode} T
 * @param {readonly T[]} nodes
 * @param {Point} at
 * @param {number} reach
 * @returns {T | null}
 */
export function nearestNode(nodes, at, reach) {
    /** @type {T | null} */
    let best = null;
    for (const node of nodes) {
        const away = distance(node.at, at);
        const least = best ? distance(best.at, at) : reach;
        const isAbove = !best || ORDER[node.role] <= ORDER[best.role];
        if (away < least || (away === least && isAbove)) best = node;
    }
    return best;
}

/**
 * The stroke that is nearest to a point, and where; null where none is within reach. Of two at one place the later one.
 * @template {Drawn} T
 * @param {readonly T[]} entries
 * @param {Point} at
 * @param {number} reach
 * @returns {({ref: Ref} & import("./nearest.js").Nearest) | null}
 */
export function nearestStroke(entries, at, reach) {
    /** @type {({ref: Ref} & import("./nearest.js").Nearest) | null} */
    let best = null;
    for (const { ref, cubics } of entries) {
        const found = nearestOn(cubics, at, best ? best.distance : reach);
        if (found) best = { ref, ...found };
    }
    return best;
}

/**
 * The stroke whose copy is nearest to a point, with the number of the motion that makes it; null where none is within
 * reach. `at` is the place on the stroke itself, `distance` that from the copy.
 * @param {readonly Drawn[]} entries
 * @param {readonly Motion[]} motions
 * @param {Lattice} lattice
 * @param {Point} at
 * @param {number} reach
 * @returns {({ref: Ref, motion: number} & import("./nearest.js").Nearest) | null}
 */
export function nearestCopy(entries, motions, lattice, at, reach) {
    const [left, bottom, right, top] = boxOf(entries.flatMap(({ cubics }) => [...cubics]));
    if (!(left <= right)) return null;
    const box = /** @type {Box} */ ([left - reach, bottom - reach, right + reach, top + reach]);
    // The copies are moved onto the strokes, and the point with them.
    const hits = motions.flatMap((map, motion) =>
        imagesIn(lattice, apply(inverse(map), at), box).flatMap((image) => {
            const hit = nearestStroke(entries, image, reach);
            return hit ? [{ ...hit, motion }] : [];
        }),
    );
    return hits.length ? hits.reduce((best, hit) => (hit.distance < best.distance ? hit : best)) : null;
}

/** Whether a point is in a box, its border included. @type {(box: Box, at: Point) => boolean} */
const isIn = ([x0, y0, x1, y1], [x, y]) => x0 <= x && x <= x1 && y0 <= y && y <= y1;

/**
 * The strokes whose control points are all in a box, and so the curves.
 * @type {(entries: readonly Drawn[], box: Box) => Ref[]}
 */
export function strokesIn(entries, box) {
    const isInside = (/** @type {Drawn} */ { cubics }) =>
        cubics.length > 0 && cubics.every((_, k) => k % 2 || isIn(box, [cubics[k], cubics[k + 1]]));
    return entries.filter(isInside).map(({ ref }) => ref);
}

/** The nodes in a box. @type {(nodes: readonly OwnedNode[], box: Box) => NodeRef[]} */
export function nodesIn(nodes, box) {
    return nodes
        .filter(({ at }) => isIn(box, at))
        .map(({ ref, node }) => ({ site: ref.site, stroke: ref.stroke, node }));
}
