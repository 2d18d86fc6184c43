// @ts-check
// The picture to trace in the hand: it is moved, and by its corners made larger and turned. The panel has it as numbers.

import { distance, minus, plus } from "../model/plane.js";
import { rounded } from "../model/snapping.js";
import { cornersOf, pulled } from "../model/tracing.js";

/**
 * @typedef {import("./tool.js").Point} Point
 * @typedef {import("./tool.js").Tool} Tool
 * @typedef {import("../store.js").Store} Store
 * @typedef {import("../store.js").Trace} Trace
 * @typedef {Trace & {at: Point, image: ImageBitmap}} Shown
 */

/** @type {{laid: Shown, from: Point, corner: boolean} | null} */
let drag = null;

/**
 * The picture as it lies, null where there is none.
 * @param {Store} store
 */
const shownIn = ({ state: { trace } }) => /** @type {Shown | null} */ (trace.image && trace.at ? trace : null);

/**
 * Change where the picture lies, or what is shown of it.
 * @param {Store} store
 * @param {Partial<Trace>} patch
 */
export const setTrace = (store, patch) => store.set({ trace: { ...store.state.trace, ...patch } });

/** @type {Tool} */
export const trace = {
    name: "trace",
    key: "",
    title: "Move the picture",
    icon: "hand",
    cursor: "move",
    help: "Drag the picture, or a corner to turn it and make it larger (Shift: larger alone). Arrows move it, Esc ends.",
    down(touch, { store }) {
        const laid = shownIn(store);
        const corner = laid && cornersOf(laid, laid.image).find((at) => distance(at, touch.raw) <= touch.reach);
        drag = laid && { laid, from: corner ?? touch.raw, corner: !!corner };
    },
    move(touch, { store, camera }, held) {
        if (held && drag) {
            const { laid, from, corner } = drag;
            const at = rounded(plus(laid.at, minus(touch.raw, from)), 1 / camera.scale);
            store.set({ trace: corner ? pulled(laid, from, touch.raw, touch.shift) : { ...laid, at } });
        }
    },
    up() {
        drag = null;
    },
    nudge(by, { store }) {
        const laid = shownIn(store);
        setTrace(store, { at: laid && plus(laid.at, by) });
    },
    cancel({ store }) {
        store.set({ trace: drag?.laid ?? { ...store.state.trace, moves: false } });
        drag = null;
        return true;
    },
    draw(context, { camera, store }) {
        const laid = shownIn(store);
        const corners = laid ? cornersOf(laid, laid.image).map((at) => camera.toScreen(at)) : [];
        const style = getComputedStyle(document.documentElement);
        context.strokeStyle = style.getPropertyValue("--accent");
        context.fillStyle = style.getPropertyValue("--panel");
        context.beginPath();
        corners.forEach((at, k) => context[k ? "lineTo" : "moveTo"](...at));
        context.closePath();
        context.stroke();
        for (const [x, y] of corners) {
            context.fillRect(x - 5, y - 5, 10, 10);
            context.strokeRect(x - 5, y - 5, 10, 10);
        }
    },
};
