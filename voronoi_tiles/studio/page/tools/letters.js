// @ts-check
// The letters that take tools: each has one of its own, until the user gives it another.

import { TOOLS } from "./toolbox.js";

/** @typedef {Readonly<Record<string, string>>} Letters those that the user has given, by the names of the tools */

/** The letters that do something else. @type {Letters} */
export const COMMAND_LETTERS = {
    e: "toggle-elements",
    g: "toggle-grid",
    k: "toggle-copies",
    j: "join",
    3: "toggle-solid",
};

/** What was kept of the letters, as far as it makes sense. @type {(kept: any) => Letters} */
export function lettersOf(kept) {
    /** @type {Letters} */
    let given = {};
    for (const tool of TOOLS) {
        const letter = kept?.[tool.name];
        if (typeof letter === "string" && !letterProblem(letter)) {
            given = withLetter(tool, letter, given);
        }
    }
    return given;
}

/** The letter of a tool, a small one. @param {import("./tool.js").Tool} tool @param {Letters} given */
export const letterOf = (tool, given) => given[tool.name] ?? tool.key;

/** Why no tool can have a letter, null where one can. @type {(letter: string) => string | null} */
export function letterProblem(letter) {
    if (!/^[\p{Ll}\p{Lo}\p{Nd}]$/u.test(letter)) {
        return "Give one letter or digit.";
    }
    return letter in COMMAND_LETTERS ? `${letter.toUpperCase()} does something else, as the lists here say.` : null;
}

/**
 * The letters after a tool was given one; another tool that had it gets the one that this tool had.
 * @type {(tool: import("./tool.js").Tool, letter: string, given: Letters) => Letters}
 */
export function withLetter(tool, letter, given) {
    const other = TOOLS.find((one) => letterOf(one, given) === letter);
    return { ...given, ...(other && { [other.name]: letterOf(tool, given) }), [tool.name]: letter };
}
