// @ts-check
/** What undo and redo go back and forth through: whole designs, which share what an edit has not changed. */

/** @import { Design } from "./design.js" */

/**
 * A step: the design after an edit.
 * @typedef {object} Step
 * @property {Design} design
 * @property {string} [merge] edits of one that follow each other are one step
 */

export class History {
    /** @type {Step[]} */
    #steps;
    #at = 0;
    /** Whether the next edit may be one with the last. */
    #open = false;

    /** Begin with a design. @param {Design} design */
    constructor(design) {
        this.#steps = [{ design }];
    }

    /** The design as it is now. */
    get design() {
        return this.#steps[this.#at].design;
    }

    /** Whether there is an edit to take back. */
    get canUndo() {
        return this.#at > 0;
    }

    /** Whether there is an edit to make again. */
    get canRedo() {
        return this.#at + 1 < this.#steps.length;
    }

    /**
     * Take an edited design as the present one; what had been taken back is gone.
     *
     * Edits of one `merge` that follow each other, with neither undo nor redo between, are one step. The same design
     * again is no step.
     * @param {Design} design
     * @param {string} [merge]
     */
    push(design, merge) {
        if (design === this.design) return;
        const joins = this.#open && merge !== undefined && this.#steps[this.#at].merge === merge;
        if (!joins) this.#at++;
        this.#steps.splice(this.#at, Infinity, { design, merge });
        this.#open = true;
    }

    /** Take the last edit back, if there is one. @returns {Design} the present design */
    undo() {
        return this.#go(-1);
    }

    /** Make the edit again that was taken back last, if there is one. @returns {Design} the present design */
    redo() {
        return this.#go(1);
    }

    /** Go some steps, and no farther than there are any. @param {number} by @returns {Design} */
    #go(by) {
        this.#at = Math.min(this.#steps.length - 1, Math.max(0, this.#at + by));
        this.#open = false;
        return this.design;
    }
}
