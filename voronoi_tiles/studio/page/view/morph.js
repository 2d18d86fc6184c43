// @ts-check
// The way of strokes and copies from one group to another: for a quarter of a second, and for the eye alone.

import { between, conjugate, scaled, times } from "../model/plane.js";

/** @import { Motion } from "../model/symmetry.js" */
/**
 * @typedef {object} Scene what is drawn of strokes
 * @property {import("../model/design.js").Design} design
 * @property {import("../model/lattice.js").Lattice} lattice
 * @property {Motion[]} motions the copies in a cell
 * @property {import("../scene.js").Entry[]} entries
 */

const LASTS_MS = 250;

export class Morph {
    /** @type {Scene | null} what was to be seen last */
    #last = null;
    /** @type {{from: Scene, start: number} | null} */
    #way = null;

    /**
     * What is drawn of a scene now: it comes from the one before where that had another group, and any other change of
     * the design ends this. `moves`: there is more to come.
     * @param {Scene} scene
     * @param {number} now milliseconds
     * @returns {Scene & {moves: boolean}}
     */
    at(scene, now) {
        const last = this.#last;
        if (scene.design !== last?.design) {
            const comes = last && isRegrouped(last, scene) && !matchMedia("(prefers-reduced-motion: reduce)").matches;
            this.#way = comes ? { from: last, start: now } : null;
        }
        this.#last = scene;
        const share = this.#way ? (now - this.#way.start) / LASTS_MS : 1;
        if (!this.#way || share >= 1) {
            return { ...scene, moves: false };
        }
        return { ...mixed(this.#way.from, scene, share * share * (3 - 2 * share)), moves: true };
    }
}

/** Whether scenes are of the same strokes in different groups. @type {(one: Scene, other: Scene) => boolean} */
const isRegrouped = (one, other) =>
    one.design.group !== other.design.group &&
    one.entries.length === other.entries.length &&
    one.entries.every(({ cubics }, k) => cubics.length === other.entries[k].cubics.length);

/** The scene a share of the way to another of the same strokes. @type {(from: Scene, to: Scene, share: number) => Scene} */
export function mixed(from, to, share) {
    const sideOf = (/** @type {"a" | "b"} */ name) => between(from.lattice[name], to.lattice[name], share);
    return {
        ...to,
        lattice: { a: sideOf("a"), b: sideOf("b") },
        motions: to.motions.map((motion, k) => {
            const alike = from.motions.filter(({ conj }) => conj === motion.conj);
            const others = alike.length ? alike : from.motions;
            return mixedMotion(others[k % others.length], motion, share);
        }),
        entries: to.entries.map((entry, k) => {
            const old = from.entries[k].cubics;
            return { ...entry, cubics: entry.cubics.map((value, n) => value + (1 - share) * (old[n] - value)) };
        }),
    };
}

/** A motion on the way; to become mirrored it shrinks to a point. @type {(m: Motion, n: Motion, t: number) => Motion} */
function mixedMotion(from, to, share) {
    const b = between(from.b, to.b, share);
    if (from.conj !== to.conj) {
        const [near, size] = share < 0.5 ? [from, 1 - 2 * share] : [to, 2 * share - 1];
        return { ...near, a: scaled(near.a, size), b };
    }
    const turn = times(to.a, conjugate(from.a));
    const angle = share * Math.atan2(turn[1], turn[0]);
    return { ...to, a: times(from.a, [Math.cos(angle), Math.sin(angle)]), b };
}
