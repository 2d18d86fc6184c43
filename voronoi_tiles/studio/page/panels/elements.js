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
 * A label and its control, side by side.
 * @param {string} label
 * @param {HTMLElement} control
 * @param {string} [title]
 */
export function field(label, control, title) {
    control.id ||= `field-${++count}`;
    return make("div", { class: "field", title }, make("label", { for: control.id }, label), control);
}

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
 */
export function deferred(run) {
    let timer = 0;
    return () => {
        timer ||= window.setTimeout(() => {
            timer = 0;
            run();
        });
    };
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
