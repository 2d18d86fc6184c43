// @ts-check
// The picture to trace in the hand: it is moved, and by its corners made larger and turned. The panel has it as numbers.

import { distance, minus, plus } from "../model/plane.js";
import { rounded } from "../model/snapping.js";
import { cornersOf, inUnits, pulled } from "../model/tracing.js";
import { colours, path } from "../view/marks.js";

/** @import { Point, Tool } from "./tool.js" */
/** @import { Store, Trace } from "../store.js" */
/** @typedef {Trace & {at: Point, image: ImageBitmap}} Shown */

/** @type {{laid: Shown, from: Point, corner: boolean} | null} */
let drag = null;

/** The picture as it lies, null where there is none. @param {Store} store */
const shownIn = ({ state: { trace } }) => /** @type {Shown | null} */ (trace.image && trace.at ? trace : null);

/** Change where the picture lies, or what is shown of it. @param {Store} store @param {Partial<Trace>} patch */
export const setTrace = (store, patch) => store.set({ trace: { ...store.state.trace, ...patch } });

/** @type {{past: Shown[], future: Shown[], nudges: boolean}} where the picture lay before, and before undo */
const steps = { past: [], future: [], nudges: false };

/**
 * Lay the picture elsewhere: a step of its own history, which is no part of the drawing's.
 * @param {Store} store
 * @param {Partial<Trace>} patch
 * @param {Shown | null} [from] where it lay before, where that has been shown already
 * @param {boolean} [nudges] whether steps of this kind that follow each other are one
 */
export function lay(store, patch, from = shownIn(store), nudges = false) {
    if (from && !(nudges && steps.nudges)) {
        Object.assign(steps, { past: [...steps.past, from], future: [] });
    }
    steps.nudges = nudges;
    setTrace(store, patch);
}

/**
 * The step that undo or redo goes to, null where there is none of this picture.
 * @param {Store} store
 * @param {"past" | "future"} list
 */
export function stepIn({ state }, list) {
    const step = steps[list].at(-1);
    return step && step.image === state.trace.image ? step : null;
}

/** @type {(store: Store, from: "past" | "future", to: "past" | "future") => boolean} whether there was a step to go */
function go(store, from, to) {
    const [step, now] = [stepIn(store, from), shownIn(store)];
    if (!step || !now) {
        return false;
    }
    Object.assign(steps, { [from]: steps[from].slice(0, -1), [to]: [...steps[to], now], nudges: false });
    const { at, width, turn } = inUnits(step, now.units);
    setTrace(store, { at, width, turn });
    return true;
}

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
    up(_touch, { store }) {
        const place = (/** @type {Trace} */ { at, width, turn }) => String([at, width, turn]);
        if (drag && place(drag.laid) !== place(store.state.trace)) {
            lay(store, {}, drag.laid);
        }
        drag = null;
    },
    nudge(by, { store }) {
        const laid = shownIn(store);
        lay(store, { at: laid && plus(laid.at, by) }, laid, true);
    },
    undo: (hands) => (drag ? trace.cancel?.(hands) : go(hands.store, "past", "future")) ?? false,
    redo: ({ store }) => go(store, "future", "past"),
    cancel({ store }) {
        store.set({ trace: drag?.laid ?? { ...store.state.trace, moves: false } });
        drag = null;
        return true;
    },
    draw(context, { camera, store }) {
        const laid = shownIn(store);
        const corners = laid ? cornersOf(laid, laid.image).map((at) => camera.toScreen(at)) : [];
        const { accent, panel } = colours();
        context.strokeStyle = accent;
        context.fillStyle = panel;
        path(context, ...corners);
        context.closePath();
        context.stroke();
        for (const [x, y] of corners) {
            context.fillRect(x - 5, y - 5, 10, 10);
            context.strokeRect(x - 5, y - 5, 10, 10);
        }
    },
};
