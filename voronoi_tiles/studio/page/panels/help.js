// @ts-check
// The help: all keys, and the tools' letters, which are changed there.

import { letterOf, letterProblem, withLetter } from "../tools/letters.js";
import { TOOLS } from "../tools/toolbox.js";
import { HELP } from "../tools/keys.js";
import { showDialog } from "./dialog.js";
import { button, make } from "./elements.js";

/** Show all keys. @param {import("../store.js").Store} store */
export function help(store) {
    const columns = HELP.map(({ title, rows }) =>
        make(
            "section",
            {},
            make("h3", {}, title),
            make(
                "dl",
                { class: "keys" },
                ...rows.flatMap(({ keys, does }) => [make("dt", {}, make("kbd", {}, keys)), make("dd", {}, does)]),
            ),
        ),
    );
    const content = make("div", { class: "help" }, lettersPart(store), ...columns);
    const { box } = showDialog("Keys", [content], [{ label: "Close" }]);
    // Not in the field of a letter, where the next key would give a tool another one.
    box.querySelector("footer button")?.focus({ preventScroll: true });
}

/** The tools with their letters, as a part of the help. @type {(store: import("../store.js").Store) => HTMLElement} */
function lettersPart(store) {
    const fields = TOOLS.map((tool) => {
        const shown = () => letterOf(tool, store.state.letters).toUpperCase();
        const input = make("input", {
            type: "text",
            class: "letter",
            maxlength: 1,
            autocomplete: "off",
            "aria-label": `Letter of ${tool.title}`,
            ".value": shown(),
            onfocus: () => input.select(),
            oninput() {
                const letter = input.value.toLowerCase();
                const problem = letterProblem(letter);
                said.textContent = problem ?? "";
                input.setAttribute("aria-invalid", String(problem !== null));
                if (!problem) {
                    store.set({ letters: withLetter(tool, letter, store.state.letters) });
                    showAll();
                }
            },
            onblur: () => show(),
        });
        const show = () => {
            input.value = shown();
            input.removeAttribute("aria-invalid");
        };
        return { tool, input, show };
    });
    const showAll = () => fields.forEach(({ show }) => show());
    const said = make("p", { class: "error", role: "alert" });
    const reset = button("Reset the letters", () => {
        store.set({ letters: {} });
        showAll();
        said.textContent = "";
    });
    return make(
        "section",
        {},
        make("h3", {}, "Tools"),
        make("p", { class: "note" }, "Type over a letter to change it; a tool that has the new one gets the old one."),
        make(
            "dl",
            { class: "keys" },
            ...fields.flatMap(({ tool, input }) => [make("dt", {}, input), make("dd", {}, tool.title)]),
        ),
        said,
        reset,
    );
}
