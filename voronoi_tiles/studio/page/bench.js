// @ts-check
// Loaded by ?bench alone: how old exact outlines are when they are drawn, how many come, what a frame of the preview takes.

/**
 * @typedef {object} Figures
 * @property {number[]} ages milliseconds from a change of the design to its exact outline on the screen
 * @property {number} proved how many of the outlines were proved
 * @property {number} frames frames that were drawn
 * @property {number[]} rests milliseconds from the last change of a drag to its proved outline, at full tolerance
 * @property {number[]} jobs milliseconds from the last change to the report and the findings of its sheet
 */

const TIMES_MAX = 100_000;

/**
 * Measure, and show it in the page.
 * @param {{store: import("./store.js").Store, stage: import("./view/stage.js").Stage}} page
 * @returns {{figures: () => Figures, reset: () => void, preview: () => any}}
 */
export function bench({ store, stage }) {
    /** @type {Map<number, number>} when a revision was made */
    const made = new Map();
    let revision = -1;
    let reported = -1;
    /** @type {Figures} */
    let figures = { ages: [], proved: 0, frames: 0, rests: [], jobs: [] };

    store.subscribe(["revision"], (state) => {
        revision = state.revision;
        made.set(revision, performance.now());
        if (made.size > TIMES_MAX) {
            made.delete([...made.keys()][0]);
        }
    });
    store.subscribe(["proved"], () => {
        figures.proved += 1;
    });
    store.subscribe(["exact"], ({ exact }) => {
        const start = exact ? made.get(exact.rev) : undefined;
        if (!exact || start === undefined) {
            return;
        }
        const { rev, proved } = exact;
        const drawn = () => {
            const age = performance.now() - start;
            figures.ages.push(age);
            if (proved && rev === revision && !store.state.dragging) {
                figures.rests.push(age);
            }
        };
        // The stage has drawn it, or draws it in the next frame, before what is asked for now.
        if (stage.shownExact === exact) {
            drawn();
        } else {
            requestAnimationFrame(drawn);
        }
    });
    store.subscribe(["product"], ({ product }) => {
        const start = product && made.get(product.rev);
        if (product && start && product.rev !== reported) {
            reported = product.rev;
            figures.jobs.push(performance.now() - start);
        }
    });
    const count = () => {
        figures.frames += 1;
        requestAnimationFrame(count);
    };
    requestAnimationFrame(count);

    const shown = document.createElement("p");
    shown.id = "bench";
    document.querySelector(".status")?.prepend(shown);
    setInterval(() => {
        const { ages } = figures;
        const sorted = [...ages].sort((a, b) => a - b);
        const at = (/** @type {number} */ share) =>
            sorted.length ? sorted[Math.floor(share * (sorted.length - 1))].toFixed(1) : "-";
        shown.textContent = `${ages.length} outlines, age ${at(0.5)} ms, p95 ${at(0.95)} ms`;
    }, 500);

    return {
        figures: () => figures,
        reset() {
            figures = { ages: [], proved: 0, frames: 0, rests: [], jobs: [] };
        },
        preview: () => stage.bench(),
    };
}
