// @ts-check
// The options of jobs, as the server's table has them: a field for each, and a job with one of them changed.

import { field, inLabels, labelOf, lengthField, make } from "./elements.js";

/** @import { State } from "../store.js" */
/** @typedef {{name: string, kind: string, default: any, help: string, words?: string[], shown?: string}} Option */
/**
 * @typedef {object} Use
 * @property {string} of what the job is called in data-key, before the name of the option
 * @property {import("../link.js").Refusal["error"] | null | undefined} error what is wrong with the job
 * @property {(name: string, value: any) => void} set undefined: the default
 */

/**
 * A job with another value of an option; those that are as usual are left out.
 * @param {Record<string, any>} job
 * @param {readonly Option[]} options
 * @param {string} name
 * @param {any} value undefined: the default
 */
export function withOption(job, options, name, value) {
    const { [name]: _, ...rest } = job;
    const usual = options.find((option) => option.name === name)?.default;
    return value === undefined || value === usual ? rest : { ...rest, [name]: value };
}

/**
 * The field of an option, with what is wrong with it and what it means.
 * @param {Option} option
 * @param {any} value undefined: the default
 * @param {Pick<State, "tables" | "unit">} state
 * @param {Use} use
 * @returns {HTMLElement}
 */
export function optionField(option, value, { tables, unit }, { of, error, set }) {
    const { name, kind, words } = option;
    const bad = error?.key === name && error;
    const said = {
        help: inLabels(option.help),
        ...(bad ? { error: inLabels(`${bad.message} ${bad.remedy}`) } : {}),
    };
    const label = labelOf(name);
    const key = `${of}-${name}`;
    const now = value ?? option.default;
    const choices = name === "preset" ? tables.presets.map((/** @type {any} */ preset) => preset.name) : words;
    if (kind === "flag") {
        const input = make("input", {
            type: "checkbox",
            "data-key": key,
            ".checked": Boolean(now),
            onchange: (/** @type {Event} */ event) =>
                set(name, /** @type {HTMLInputElement} */ (event.target).checked || undefined),
        });
        return field(label, input, said);
    }
    if (choices?.length) {
        const select = make("select", {
            "data-key": key,
            onchange: (/** @type {Event} */ event) =>
                set(name, /** @type {HTMLSelectElement} */ (event.target).value || undefined),
        });
        const shown = option.default === null ? ["", ...choices] : choices;
        select.append(
            ...shown.map((/** @type {string} */ word) =>
                make(
                    "option",
                    { value: word === option.default ? "" : word, ".selected": word === (now ?? "") },
                    word || "automatic",
                ),
            ),
        );
        return field(label, select, said);
    }
    if (kind === "length") {
        const mm = tables.units[unit];
        const input = lengthField(
            now === null ? null : Number(now) / mm,
            unit,
            (length) => set(name, length * mm),
            { "data-key": key, placeholder: "automatic" },
            () => set(name, undefined),
        );
        return field(`${label}, ${unit}`, input, said);
    }
    const input = make("input", {
        type: "text",
        spellcheck: "false",
        "data-key": key,
        ".defaultValue": now === null || now === undefined ? "" : Array.isArray(now) ? now.join(" x ") : String(now),
        placeholder: option.shown || "automatic",
        onchange: () => {
            const text = input.value.trim();
            input.defaultValue = input.value;
            const isNumber = (kind === "angle" || kind === "number") && Number.isFinite(Number(text));
            set(name, text === "" ? undefined : isNumber ? Number(text) : text);
        },
    });
    return field(label, input, said);
}
