// @ts-check
// The one state of the page, and the way of every change: an edit gives a new design, which is kept in the history,
// sent to the server and drawn. Panels and views subscribe to the keys that they show.

import { History } from "./model/history.js";
import { UNLAID } from "./model/tracing.js";

/** @import { Design, NodeRef, Ref } from "./model/design.js" */
/** @import { Outline, Product, Refusal } from "./link.js" */
/**
 * @typedef {{strokes: readonly Ref[], nodes: readonly NodeRef[]}} Selection
 * @typedef {{message: string, remedy: string, quiet?: boolean}} Trouble quiet: nothing is wrong
 * @typedef {import("./model/tracing.js").Laid & {image: ImageBitmap | null, moves: boolean}} Trace moves: whether the pointer has it
 * @typedef {object} State
 * @property {Design} design what is drawn, as it is seen: during a drag not yet in the history
 * @property {number} revision counts the changes of `design`
 * @property {number} begun the first revision of this design: answers to earlier ones are of another
 * @property {string} file the name of the design's file
 * @property {boolean} saved whether the file holds this design
 * @property {Selection} selection
 * @property {string} tool the name of the tool in hand
 * @property {number} site the site that new strokes go to
 * @property {any} tables what the server says of groups, options and formats
 * @property {Outline | null} exact the last outlines that came
 * @property {number} proved the last revision whose outlines are proved
 * @property {Refusal | null} refusal why the design has none, null where it has
 * @property {Product | null} product the last job's result
 * @property {Refusal | null} jobRefusal
 * @property {boolean} jobPending whether a newer product is waited for
 * @property {Record<string, any>} job the options of the job that differ from their defaults
 * @property {import("./model/solids.js").Solid | null} solid the last one that came
 * @property {Refusal | null} solidRefusal why there is none of what is drawn
 * @property {boolean} solidPending whether a newer one is waited for
 * @property {Record<string, any>} solidJob the options of the solid's job that differ from their defaults
 * @property {number} apart by which share of their distance neighbours of the solid are pulled away
 * @property {boolean} turnsSolids whether they can be turned here: whether there is WebGL
 * @property {"mm" | "cm" | "in"} unit in which lengths are shown
 * @property {{elements: boolean, cell: boolean, grid: boolean, copies: boolean, region: boolean, colours: boolean, edges: boolean, art: boolean}} shown
 * @property {"" | "light" | "dark"} theme empty: as the system is
 * @property {import("./tools/letters.js").Letters} letters of tools, where the user has given them others
 * @property {Trace} trace a picture that is traced
 * @property {boolean} connected
 * @property {boolean} behind whether the exact outlines do not follow what is drawn, or not closely
 * @property {boolean} dragging whether `design` is still in the hand
 * @property {readonly [number, number] | null} pointer where in the drawing it is
 * @property {Trouble | null} trouble what else there is to say, until it is closed; where quiet, until the next change
 */

/** @typedef {{keys: readonly string[], tell: (state: State) => void, calm: boolean}} Listener */

/** How often calm listeners are told while something is dragged; milliseconds. */
const CALM_MS = 125;

/** @type {Readonly<Selection>} */
export const NOTHING = Object.freeze({ strokes: [], nodes: [] });

/** @type {Readonly<Trace>} */
export const NO_TRACE = Object.freeze({ ...UNLAID, image: null, moves: false });

/**
 * The factor from the drawing's units, before the design's scale, to those in which lengths are shown.
 * @type {(state: Pick<State, "design" | "tables" | "unit">) => number}
 */
export function shownFactor({ design, tables, unit }) {
    return (tables.units[design.units ?? "mm"] * (design.scale ?? 1)) / tables.units[unit];
}

export class Store {
    /** @type {State} */
    #state;
    /** @type {Set<Listener>} */
    #listeners = new Set();
    /** @type {Set<Listener>} calm ones that are to be told */
    #waiting = new Set();
    #calm = 0;
    /** @type {Set<string>} */
    #changed = new Set();
    #history;
    /** @type {Design | null} what the file holds, as far as it is known */
    #kept = null;

    /** @param {State} state */
    constructor(state) {
        this.#state = Object.freeze({ ...state });
        this.#history = new History(state.design);
    }

    get state() {
        return this.#state;
    }

    /**
     * Change some keys. Whoever listens to one of them is told once, when what runs now has ended.
     * @param {Partial<State>} patch
     */
    set(patch) {
        /** @type {Record<string, unknown>} */
        const old = /** @type {any} */ (this.#state);
        const keys = Object.entries(patch)
            .filter(([key, value]) => old[key] !== value)
            .map(([key]) => key);
        if (!keys.length) {
            return;
        }
        this.#state = Object.freeze({ ...this.#state, ...patch });
        if (!this.#changed.size) {
            queueMicrotask(() => this.#tell());
        }
        keys.forEach((key) => this.#changed.add(key));
    }

    #tell() {
        const changed = this.#changed;
        this.#changed = new Set();
        for (const listener of this.#listeners) {
            if (!listener.keys.some((key) => changed.has(key))) {
                continue;
            }
            if (listener.calm && this.#state.dragging) {
                this.#waiting.add(listener);
                this.#calm ||= setTimeout(() => this.#tellCalm(), CALM_MS);
            } else {
                this.#waiting.delete(listener);
                listener.tell(this.#state);
            }
        }
        if (!this.#state.dragging) {
            this.#tellCalm();
        }
    }

    #tellCalm() {
        clearTimeout(this.#calm);
        this.#calm = 0;
        const waiting = [...this.#waiting];
        this.#waiting.clear();
        waiting.forEach(({ tell }) => tell(this.#state));
    }

    /**
     * Call a function now and after every change of one of the keys.
     * @param {readonly (keyof State)[]} keys
     * @param {(state: State) => void} tell
     * @param {{calm?: boolean}} [how] calm: of changes while something is dragged it is told a few times a second alone
     * @returns {() => void} ends it
     */
    subscribe(keys, tell, { calm = false } = {}) {
        const listener = { keys, tell, calm };
        this.#listeners.add(listener);
        tell(this.#state);
        return () => {
            this.#listeners.delete(listener);
            this.#waiting.delete(listener);
        };
    }

    /**
     * Change the design, a step of the history. Changes of one `merge` that follow each other are one step.
     * @param {(design: Design) => Design} change
     * @param {{merge?: string, selection?: Selection}} [more]
     */
    edit(change, more = {}) {
        const design = change(this.#history.design);
        if (design === this.#history.design && !this.#state.dragging) {
            return;
        }
        this.#history.push(design, more.merge);
        this.#show(design, { dragging: false, ...(more.selection ? { selection: more.selection } : {}) });
    }

    /**
     * Show a design that is still in the hand: made of the one before the drag, and not in the history.
     * @param {(design: Design) => Design} change
     */
    preview(change) {
        this.#show(change(this.#history.design), { dragging: true });
    }

    /** Take back what is in the hand. */
    cancel() {
        if (this.#state.dragging) {
            this.#show(this.#history.design, { dragging: false });
        }
    }

    /** The design before what is in the hand. */
    get settled() {
        return this.#history.design;
    }

    get canUndo() {
        return this.#history.canUndo;
    }

    get canRedo() {
        return this.#history.canRedo;
    }

    /** Take back the last step, or what is in the hand. */
    undo() {
        if (this.#state.dragging) {
            this.cancel();
        } else if (this.#history.canUndo) {
            this.#show(this.#history.undo(), { selection: NOTHING });
        }
    }

    redo() {
        if (!this.#state.dragging && this.#history.canRedo) {
            this.#show(this.#history.redo(), { selection: NOTHING });
        }
    }

    /** Know what the file holds; undo and redo lead back to it. @param {Design | null} design null: nothing of ours */
    keep(design) {
        this.#kept = design;
        this.set({ saved: this.#history.design === design });
    }

    /** Begin with another design: a new history. @param {Design} design @param {Partial<State>} patch */
    open(design, patch) {
        this.#history = new History(design);
        this.#kept = null;
        const none = { exact: null, refusal: null, product: null, jobRefusal: null };
        const begun = this.#state.revision + 1;
        this.#show(design, { selection: NOTHING, site: 0, dragging: false, begun, ...none, ...patch });
    }

    /** @param {Design} design @param {Partial<State>} patch */
    #show(design, patch) {
        const site = Math.min(this.#state.site, design.site.length - 1);
        const saved = this.#history.design === this.#kept;
        // What was only said is of the design before.
        const trouble = this.#state.trouble?.quiet && !patch.dragging ? null : this.#state.trouble;
        this.set({ design, revision: this.#state.revision + 1, site, saved, trouble, ...patch });
    }
}
