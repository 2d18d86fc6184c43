// @ts-check
// Small pieces that panels and dialogs are made of.

import { evaluate, shown } from "../model/lengths.js";

/**
 * An element with attributes, properties that begin with a dot, listeners that begin with "on", and children.
 * @param {string} tag
 * @param {Record<string, any>} [attributes]
 * @param {...(Node | string | null | undefined | false)} children
 * @returns {any}
 */
export function make(tag, attributes = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith("on")) {
            element.addEventListener(name.slice(2), value);
        } else if (name.startsWith(".")) {
            /** @type {any} */ (element)[name.slice(1)] = value;
        } else if (name.startsWith("aria-") && typeof value === "boolean") {
            element.setAttribute(name, String(value));
        } else if (value !== false && value !== null && value !== undefined) {
            element.setAttribute(name, value === true ? "" : String(value));
        }
    }
    element.append(
        ...children
            .filter((child) => child !== null && child !== undefined && child !== false)
            .map((child) => /** @type {Node | string} */ (child)),
    );
    return element;
}

let count = 0;

/**
 * A label and its control, side by side; below them what is wrong with it, and what it means.
 * @param {string} label
 * @param {HTMLElement} control
 * @param {{help?: string, error?: string}} [more]
 */
export function field(label, control, { help, error } = {}) {
    const id = (control.id ||= `field-${++count}`);
    const wrong = error && make("p", { class: "error", role: "alert", id: `${id}-error` }, error);
    const means = help && make("p", { class: "note", id: `${id}-help` }, help);
    const said = [wrong, means].filter(Boolean).map((one) => one.id);
    if (said.length) {
        control.setAttribute("aria-describedby", said.join(" "));
    }
    if (wrong) {
        control.setAttribute("aria-invalid", "true");
    }
    return make("div", { class: "field" }, make("label", { for: id }, label), control, wrong, means);
}

/** The label of an option of a job. @param {string} name */
export const labelOf = (name) => name.replaceAll("_", " ").replace(/^./, (letter) => letter.toUpperCase());

/**
 * What Python says of the options of a job, with their labels in the place of its arguments in backquotes.
 * @param {string} text as "Use `fit='whole'`."
 */
export const inLabels = (text) =>
    text.replace(/`(\w+)(?:='?([^'`]+)'?)?`/g, (_, name, value) =>
        value && value !== "True" ? `${labelOf(name)}: ${value}` : labelOf(name),
    );

/**
 * A field for a length, which takes arithmetic and units: "12.5mm + 1/4in".
 * @param {number | null} value millimetres, or in `unit`
 * @param {string} unit what it is shown in, and what a bare number means
 * @param {(value: number) => void} change called with the number in `unit`
 * @param {Record<string, any>} [attributes]
 * @returns {HTMLInputElement}
 */
export function lengthField(value, unit, change, attributes = {}) {
    const input = make("input", {
        type: "text",
        inputmode: "decimal",
        spellcheck: "false",
        autocomplete: "off",
        ...attributes,
        // What is typed differs from it: undo is the field's own until then, the drawing's else.
        ".defaultValue": value === null ? "" : shown(value, unit),
    });
    const old = input.value;
    const read = () => {
        if (input.value === old) {
            return;
        }
        try {
            change(evaluate(input.value, unit));
            input.defaultValue = input.value;
            input.setCustomValidity("");
        } catch (error) {
            input.setCustomValidity(error instanceof Error ? error.message : String(error));
            input.reportValidity();
        }
    };
    input.addEventListener("change", read);
    input.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => {
        if (event.key === "Escape") {
            input.value = old;
            input.setCustomValidity("");
        }
    });
    return input;
}

/**
 * A function that runs another one soon, once for all calls until then: the browser has moved the focus by that time,
 * which controls that are made anew would lose.
 * @param {() => void} run
 * @param {HTMLElement} [home] while a text is being typed in it, `run` waits for its end
 */
export function deferred(run, home) {
    let timer = 0;
    const soon = () => {
        timer ||= window.setTimeout(() => {
            timer = 0;
            const field = document.activeElement;
            const typed =
                field instanceof HTMLInputElement && field.type === "text" && field.value !== field.defaultValue;
            if (typed && home?.contains(field)) {
                field.addEventListener("blur", soon, { once: true });
            } else {
                run();
            }
        });
    };
    return soon;
}

/**
 * Replace what an element holds and keep the focus on the control of the same data-key.
 * @param {HTMLElement} parent
 * @param {Node[]} children
 */
export function refill(parent, children) {
    const active = document.activeElement;
    const key = active instanceof HTMLElement && parent.contains(active) ? active.dataset.key : undefined;
    const scroll = parent.parentElement?.scrollTop ?? 0;
    parent.replaceChildren(...children);
    if (key) {
        const again = /** @type {HTMLElement | null} */ (parent.querySelector(`[data-key="${CSS.escape(key)}"]`));
        again?.focus();
        if (again instanceof HTMLInputElement && again.type === "text") {
            again.select();
        }
    }
    if (parent.parentElement) {
        parent.parentElement.scrollTop = scroll;
    }
}
