// @ts-check
// What the browser keeps for the page from one time to the next.

import { lettersOf } from "./tools/letters.js";

const NAME = "voronoi_tiles studio";

/** How the page looks: nothing of the design. @type {(keyof import("./store.js").State)[]} */
const HABITS = ["unit", "theme", "shown", "letters"];

/** What the browser keeps for this page under a name. @type {(name: string) => any} */
export function kept(name) {
    try {
        return JSON.parse(localStorage.getItem(name) ?? "{}");
    } catch {
        return {};
    }
}

/**
 * How the page looked last time, as far as that makes sense. What it did not have then is as it is without habits.
 * @param {import("./store.js").State["shown"]} shown
 */
export function habits(shown) {
    const own = Object.fromEntries(
        Object.entries(kept(NAME) ?? {}).filter(([key]) => /** @type {string[]} */ (HABITS).includes(key)),
    );
    return { ...own, shown: { ...shown, ...own.shown }, letters: lettersOf(own.letters) };
}

/** Keep how the page looks. @param {import("./store.js").Store} store */
export function keepHabits(store) {
    store.subscribe(HABITS, (state) =>
        localStorage.setItem(NAME, JSON.stringify(Object.fromEntries(HABITS.map((key) => [key, state[key]])))),
    );
}
