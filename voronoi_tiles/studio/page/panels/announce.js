// @ts-check
// What a screen reader is told while the keyboard moves things: which point is in hand, and where.

import { isSameNode, isSameStroke } from "../model/design.js";
import { shown } from "../model/lengths.js";
import { nodeRef, shownNodes } from "../scene.js";
import { shownFactor } from "../store.js";
import { ROLES } from "./strokes.js";

/** So long after the last key; ms. A key that is held down is followed by one announcement, where it ends. */
const REST_MS = 300;

/**
 * Say what is in hand after keys on the drawing.
 * @param {import("../tools/tool.js").Hands} hands
 * @param {import("../tools/toolbox.js").Toolbox} toolbox
 * @param {HTMLElement} canvas that has the focus while the keyboard draws
 * @param {HTMLElement} region that is live
 */
export function announce(hands, toolbox, canvas, region) {
    let timer = 0;
    canvas.addEventListener("keydown", () => {
        clearTimeout(timer);
        timer = window.setTimeout(() => {
            region.textContent = inHand(hands, toolbox.cross);
        }, REST_MS);
    });
}

/**
 * The selected point, or the cross hair of a drawing tool, in words; "" for neither.
 * @param {import("../tools/tool.js").Hands} hands
 * @param {readonly [number, number] | null} cross
 */
function inHand(hands, cross) {
    const { state } = hands.store;
    const place = (/** @type {readonly [number, number]} */ at) =>
        ["x", "y"]
            .map((name, axis) => `${name} ${shown(at[axis] * shownFactor(state), state.unit)} ${state.unit}`)
            .join(", ");
    if (state.trace.moves && state.trace.at) {
        return `Picture, ${place(state.trace.at)}`;
    }
    if (cross) {
        return `Cross hair, ${place(cross)}`;
    }
    const { nodes } = state.selection;
    if (nodes.length !== 1) {
        return nodes.length ? `${nodes.length} points` : "";
    }
    const own = shownNodes(hands).filter(({ ref }) => isSameStroke(ref, nodes[0]));
    const index = own.findIndex((node) => isSameNode(nodeRef(node), nodes[0]));
    const node = own[index];
    return node ? `${ROLES[node.role]} ${index + 1} of ${own.length}, ${place(node.at)}` : "";
}
