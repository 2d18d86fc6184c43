// @ts-check
// The letters that take tools: each has one of its own, until the user gives it another.

import { TOOLS } from "./toolbox.js";

/** @typedef {Readonly<Record<string, string>>} Letters those that the user has given, by the names of the tools */

/** The letters that do something else. @type {Letters} */
export const COMMAND_LETTERS = { e: "toggle-elements", g: "toggle-grid", k: "toggle-copies", j: "join" };

/**
 * What was kept of the letters, as far as it makes sense.
 * @param {any} kept
 * @returns {Letters}
 */
export function lettersOf(kept) {
    /** @type {Record<string, string>} */
    const given = {};
    for (const tool of TOOLS) {
        const letter = kept?.[tool.name];
        if (typeof letter === "string" && !letterProblem(tool, letter, given)) {
            given[tool.name] = letter;
        }
    }
    return given;
}

/**
 * The letter of a tool, a small one.
 * @param {import("./tool.js").Tool} tool
 * @param {Letters} given
 */
export const letterOf = (tool, given) => given[tool.name] ?? tool.key;

/**
 * Why a tool cannot have a letter, null where it can.
 * @param {import("./tool.js").Tool} tool
 * @param {string} letter
 * @param {Letters} given
 * @returns {string | null}
 */
export function letterProblem(tool, letter, given) {
    if (!/^[\p{Ll}\p{Lo}\p{Nd}]$/u.test(letter)) {
        return "Give one letter or digit.";
    }
    const shown = letter.toUpperCase();
    if (letter in COMMAND_LETTERS) {
        return `${shown} does something else, as the lists here say.`;
    }
    const other = TOOLS.find((one) => one !== tool && letterOf(one, given) === letter);
    return other ? `${shown} is the letter of “${other.title}”: give that another one first.` : null;
}
