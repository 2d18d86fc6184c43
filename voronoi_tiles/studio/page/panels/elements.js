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

/**
 * A list of figures: a name and a value each; greyed where they are not of what is drawn now.
 * @param {string[][]} rows
 * @param {unknown} isOld
 */
export const figures = (rows, isOld) =>
    make(
        "dl",
        { class: isOld ? "figures old" : "figures" },
        ...rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]),
    );

/** An element of the page. @param {string} id */
export const byId = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

/**
 * A button; what it does may be given by `data-command`.
 * @param {string} label
 * @param {((event: MouseEvent) => void) | null} onclick
 * @param {Record<string, any>} [attributes]
 */
export const button = (label, onclick, attributes = {}) =>
    make("button", onclick ? { ...attributes, onclick } : attributes, label);

/** What is said of an error. @param {unknown} error */
export const said = (error) => (error instanceof Error ? error.message : String(error));

let count = 0;

/**
 * A label and its control, side by side; below them what is wrong with it, and what it means.
 * @param {string} label
 * @param {HTMLElement} control
 * @param {{help?: string, error?: string}} [more]
 */
export function field(label, control, { help, error } = {}) {
    const id = (control.id ||= `field-${++count}`);
    const means = help && make("p", { class: "note", id: `${id}-help` }, help);
    const box = make("div", { class: "field" }, make("label", { for: id }, label), control, means);
    if (means) {
        control.setAttribute("aria-describedby", means.id);
    }
    if (error) {
        mark(control, error);
    }
    return box;
}

/**
 * Say below a control what is wrong with it; without a text, nothing is.
 * @param {HTMLElement} control
 * @param {string | null} [error]
 */
export function mark(control, error) {
    const id = `${(control.id ||= `field-${++count}`)}-error`;
    const said = (control.getAttribute("aria-describedby") ?? "").replace(id, "").trim();
    document.getElementById(id)?.remove();
    if (error) {
        control.after(make("p", { class: "error", role: "alert", id }, error));
    }
    control.setAttribute("aria-invalid", String(Boolean(error)));
    control.setAttribute("aria-describedby", `${error ? id : ""} ${said}`.trim());
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
 * A field for a text. What is refused stays in it, `:invalid`, with the reason below it; Escape takes it back.
 * @param {string} old
 * @param {(text: string) => void} take may throw what is wrong with it
 * @param {Record<string, any>} [attributes]
 * @returns {HTMLInputElement}
 */
export function textField(old, take, attributes = {}) {
    const input = make("input", {
        type: "text",
        spellcheck: "false",
        autocomplete: "off",
        ...attributes,
        // What is typed differs from it: undo is the field's own until then, the drawing's else.
        ".defaultValue": old,
        onchange() {
            try {
                if (input.value !== input.defaultValue) {
                    take(input.value);
                }
                input.defaultValue = input.value;
                refuse(input, "");
            } catch (error) {
                refuse(input, said(error));
            }
        },
        onkeydown(/** @type {KeyboardEvent} */ event) {
            if (event.key === "Escape") {
                input.value = input.defaultValue;
                refuse(input, "");
            }
        },
    });
    return input;
}

/** @param {HTMLInputElement} input @param {string} error why what is in it is refused, "" where it is not */
function refuse(input, error) {
    input.setCustomValidity(error);
    mark(input, error);
}

/**
 * A field for a length, which takes arithmetic and units: "12.5mm + 1/4in".
 * @param {number | null} value millimetres, or in `unit`
 * @param {string} unit what it is shown in, and what a bare number means
 * @param {(value: number) => void} change called with the number in `unit`; may throw what is wrong with it
 * @param {Record<string, any>} [attributes]
 * @param {() => void} [empty] called where nothing is left in it; without this it needs a length
 */
export function lengthField(value, unit, change, attributes = {}, empty) {
    const read = (/** @type {string} */ text) => {
        if (empty && !text.trim()) {
            empty();
        } else {
            change(evaluate(text, unit));
        }
    };
    return textField(value === null ? "" : shown(value, unit), read, { inputmode: "decimal", ...attributes });
}

/** A length that is above zero. Throws an Error for people. @param {number} length */
export function above(length) {
    if (length > 0) {
        return length;
    }
    throw new Error("This has to be above zero.");
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
 * Replace what an element holds and keep the focus on the control of the same data-key. A text that was refused stays
 * in its field with the reason, unless that is of something else by now.
 * @param {HTMLElement} parent
 * @param {Node[]} children
 */
export function refill(parent, children) {
    const unread = /** @type {HTMLInputElement[]} */ ([...parent.querySelectorAll("input[type=text]:invalid")]);
    const active = document.activeElement;
    const key = active instanceof HTMLElement && parent.contains(active) ? active.dataset.key : undefined;
    const scroll = parent.parentElement?.scrollTop ?? 0;
    parent.replaceChildren(...children);
    /** @param {string} name */
    const control = (name) =>
        /** @type {HTMLElement | null} */ (parent.querySelector(`[data-key="${CSS.escape(name)}"]`));
    for (const { dataset, defaultValue, value, validationMessage } of unread) {
        const again = control(dataset.key ?? "");
        if (again instanceof HTMLInputElement && again.defaultValue === defaultValue) {
            again.value = value;
            refuse(again, validationMessage);
        }
    }
    if (key) {
        const again = control(key);
        again?.focus();
        if (again instanceof HTMLInputElement && again.type === "text") {
            again.select();
        }
    }
    if (parent.parentElement) {
        parent.parentElement.scrollTop = scroll;
    }
}
