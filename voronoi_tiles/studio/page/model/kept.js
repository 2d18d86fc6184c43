// @ts-check
/** Gives the value that was made last while its causes stay the same, each by identity. @template T */
export class Kept {
    /** @type {unknown[] | null} */
    #causes = null;
    /** @type {T | undefined} */
    #value;

    /**
     * @param {unknown[]} causes
     * @param {() => T} make
     * @returns {T}
     */
    get(causes, make) {
        const same = this.#causes?.length === causes.length && causes.every((cause, k) => cause === this.#causes?.[k]);
        if (!same) {
            this.#causes = null;
            this.#value = make();
            this.#causes = causes;
        }
        return /** @type {T} */ (this.#value);
    }
}
