// @ts-check
// What a design looks like in the drawing: each stroke's curves and nodes, kept as long as stroke and site are the same.

import { isSameStroke } from "./model/design.js";
import { kindOf, cubicsOf, flatten, placementOf } from "./model/strokes.js";
import { nodesOf } from "./model/nodes.js";

/** @import { Design, Ref } from "./model/design.js" */
/** @import { Placement } from "./model/strokes.js" */
/** @import { Node } from "./model/nodes.js" */
/**
 * @typedef {[number, number]} Point
 * @typedef {object} Entry a stroke as it is drawn
 * @property {Ref} ref
 * @property {string} kind
 * @property {Placement} placement
 * @property {Float64Array} cubics 8 numbers a piece
 * @property {Node[]} nodes
 */

/** @type {WeakMap<object, WeakMap<object, {resolved: string | undefined, entry: Omit<Entry, "ref">}>>} */
const kept = new WeakMap();

/**
 * @param {any} site
 * @param {any} stroke
 * @param {string | undefined} resolved
 */
function entryOf(site, stroke, resolved) {
    let strokes = kept.get(site);
    if (!strokes) {
        kept.set(site, (strokes = new WeakMap()));
    }
    const found = strokes.get(stroke);
    if (found && found.resolved === resolved) {
        return found.entry;
    }
    const placement = placementOf(site, stroke);
    const entry = {
        kind: kindOf(stroke),
        placement,
        cubics: cubicsOf(stroke, placement, resolved),
        nodes: nodesOf(stroke, placement),
    };
    strokes.set(stroke, { resolved, entry });
    return entry;
}

/**
 * The strokes of a design, site after site.
 * @param {Design} design
 * @param {Record<string, string>} [resolved] path data of strokes that are files, by "site.stroke"
 * @returns {Entry[]}
 */
export function entriesOf(design, resolved = {}) {
    return design.site.flatMap((site, i) =>
        site.strokes.map((stroke, k) => ({
            ...entryOf(site, stroke, resolved[`${i}.${k}`]),
            ref: { site: i, stroke: k },
        })),
    );
}

/**
 * The segments of each site's strokes, 4 numbers each, within a tolerance of the curves.
 * @param {Design} design
 * @param {Entry[]} entries
 * @param {number} tolerance in units
 * @returns {Float64Array[]}
 */
export function segmentsOf(design, entries, tolerance) {
    return design.site.map((_, i) => {
        const parts = entries.filter((entry) => entry.ref.site === i).map((entry) => flatten(entry.cubics, tolerance));
        const all = new Float64Array(parts.reduce((sum, part) => sum + part.length, 0));
        let at = 0;
        for (const part of parts) {
            all.set(part, at);
            at += part.length;
        }
        return all;
    });
}

/**
 * The box around some strokes, or null where there is none.
 * @type {(entries: readonly Entry[]) => [number, number, number, number] | null}
 */
export function boxOf(entries) {
    const box = /** @type {[number, number, number, number]} */ ([Infinity, Infinity, -Infinity, -Infinity]);
    for (const { cubics } of entries) {
        for (let k = 0; k < cubics.length; k += 2) {
            box[0] = Math.min(box[0], cubics[k]);
            box[1] = Math.min(box[1], cubics[k + 1]);
            box[2] = Math.max(box[2], cubics[k]);
            box[3] = Math.max(box[3], cubics[k + 1]);
        }
    }
    return box[0] <= box[2] ? box : null;
}

/**
 * The nodes that can be seen, each with its stroke: those of selected strokes.
 * @param {Pick<import("./tools/tool.js").Hands, "entries" | "store">} hands
 */
export function shownNodes({ entries, store }) {
    const { strokes } = store.state.selection;
    return entries()
        .filter((entry) => strokes.some((ref) => isSameStroke(ref, entry.ref)))
        .flatMap((entry) => entry.nodes.map((node) => ({ ...node, ref: entry.ref })));
}

/**
 * The reference of such a node.
 * @param {{ref: Ref, node: number}} shown
 * @returns {import("./model/design.js").NodeRef}
 */
export const nodeRef = ({ ref, node }) => ({ site: ref.site, stroke: ref.stroke, node });
