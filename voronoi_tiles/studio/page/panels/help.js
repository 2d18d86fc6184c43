// @ts-check
// The tools' letters in the help, where they are changed.

import { letterOf, letterProblem, withLetter } from "../tools/letters.js";
import { TOOLS } from "../tools/toolbox.js";
import { make } from "./elements.js";

/**
 * The tools with their letters, as a part of the help.
 * @param {import("../store.js").Store} store
 * @returns {HTMLElement}
 */
export function lettersPart(store) {
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
    const reset = make(
        "button",
        {
            type: "button",
            onclick() {
                store.set({ letters: {} });
                showAll();
                said.textContent = "";
            },
        },
        "Reset the letters",
    );
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
