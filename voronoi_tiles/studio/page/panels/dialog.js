// @ts-check
// The frame of a dialog: its buttons, what is being done, and what went wrong.

import { button, byId, inLabels, make, said } from "./elements.js";

/**
 * @typedef {object} Action a button of a dialog; it closes the dialog, and what fails is said in it
 * @property {string} label
 * @property {boolean} [first] whether it is the one that one is here for
 * @property {boolean} [whole] whether it cannot be given up once it has begun
 * @property {(signal: AbortSignal) => unknown} [run]
 */

/**
 * Show a dialog in the place of the one before.
 * @param {string} title
 * @param {(Node | string)[]} content
 * @param {Action[]} actions the last closes without doing anything, and gives up what one before it is doing
 */
export function showDialog(title, content, actions) {
    const failed = make("p", { class: "error", role: "alert" });
    const working = make("p", { class: "note", role: "status" });
    const stop = new AbortController();
    const buttons = actions.map(({ label, first, whole, run }) => {
        const act = async () => {
            if (box.ariaBusy && (run || box.dataset.whole)) {
                return;
            }
            try {
                failed.textContent = "";
                const done = run?.(stop.signal);
                if (done instanceof Promise) {
                    box.ariaBusy = "true";
                    box.dataset.whole = whole ? "yes" : "";
                    working.replaceChildren(make("progress", { "aria-hidden": true }), " Working");
                    await done;
                }
                box.close();
            } catch (error) {
                failed.textContent = inLabels(said(error));
            } finally {
                box.ariaBusy = null;
                working.textContent = "";
            }
        };
        return button(label, act, { class: first ? "first" : "" });
    });
    const box = make(
        "dialog",
        {
            "aria-labelledby": "dialog-title",
            oncancel: (/** @type {Event} */ event) => box.ariaBusy && box.dataset.whole && event.preventDefault(),
            onclose: () => {
                stop.abort();
                box.remove();
            },
        },
        make("h2", { id: "dialog-title" }, title),
        ...content,
        failed,
        working,
        make("footer", {}, ...buttons),
    );
    byId("dialogs").replaceChildren(box);
    box.showModal();
    box.scrollTop = 0;
    return { box, failed };
}
