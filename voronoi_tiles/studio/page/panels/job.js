// @ts-check
// The job: all that `voronoi-tiles export` offers, made from the server's table of options, common ones first.

import { button, deferred, field, inLabels, labelOf, lengthField, make, refill } from "./elements.js";

/** @import { Context } from "./panels.js" */
/** @import { State } from "../store.js" */
/** @typedef {{name: string, kind: string, default: any, help: string, words?: string[], shown?: string}} Option */

/** @type {[string, string[]][]} the options under headings; those that no heading names stand under the last */
const HEADINGS = [
    ["Sheet", ["sheet", "margin", "fit", "pieces"]],
    ["Cut", ["kerf", "edges", "gap", "tabs", "fillet"]],
    ["Target", ["preset", "curves", "accuracy", "dxf_version", "stroke", "feed", "power"]],
    ["Place", ["rotate", "offset", "frame", "layout", "grain", "count", "sheets"]],
    ["Engrave", ["labels", "label_height", "art", "marks", "bar"]],
    ["Colours", ["colours", "into", "pack", "stock", "only_colour"]],
    ["More", []],
];

const KEY = "job-";

export class JobPanel extends HTMLElement {
    /** @type {Context} */
    // @ts-expect-error set by connect, before anything else
    #context;
    /** @type {Set<string>} headings that are open */
    #open = new Set(["Sheet", "Cut", "Target"]);

    /** @param {Context} context */
    connect(context) {
        this.#context = context;
        context.store.subscribe(
            ["tables", "job", "jobRefusal", "unit"],
            deferred(() => this.#fill(context.store.state), this),
        );
    }

    /** @param {State} state */
    #fill(state) {
        const { tables, job, jobRefusal } = state;
        if (!tables) {
            return;
        }
        const named = new Set(HEADINGS.flatMap(([, names]) => names));
        const options = /** @type {Option[]} */ (tables.job);
        const bad = jobRefusal?.error;
        refill(
            this,
            [
                make(
                    "p",
                    { class: "note" },
                    "What is made of the tiles. Without a sheet one of each tile is cut, as a closed contour.",
                ),
                bad &&
                    !options.some(({ name }) => name === bad.key) &&
                    make("p", { class: "error", role: "alert" }, inLabels(`${bad.message} ${bad.remedy}`)),
                ...HEADINGS.map(([title, names]) => {
                    const own = names.length
                        ? names.flatMap((name) => options.filter((option) => option.name === name))
                        : options.filter(({ name }) => !named.has(name));
                    const fields = own.map((option) => this.#field(option, job[option.name], state));
                    const wrong = own.some(({ name }) => name === bad?.key);
                    return fields.length
                        ? make(
                              "details",
                              {
                                  ".open": this.#open.has(title) || wrong,
                                  ontoggle: (/** @type {Event} */ event) => {
                                      this.#open[
                                          /** @type {HTMLDetailsElement} */ (event.target).open ? "add" : "delete"
                                      ](title);
                                  },
                              },
                              make("summary", { "data-key": `heading ${title}` }, title),
                              ...fields,
                          )
                        : null;
                }).filter((node) => node !== null),
                make(
                    "p",
                    { class: "group" },
                    button("Export", null, { class: "first", "data-key": "export", "data-command": "export" }),
                    button("Test piece for the kerf", null, { "data-key": "coupon", "data-command": "coupon" }),
                    Object.keys(job).length > 0 &&
                        button("Reset", () => this.#context.store.set({ job: {} }), {
                            class: "quiet",
                            "data-key": "reset",
                        }),
                ),
            ].filter(Boolean),
        );
    }

    /** @param {string} name @param {any} value undefined: the default */
    #set(name, value) {
        const { store } = this.#context;
        const { job, tables } = store.state;
        const { [name]: _, ...rest } = job;
        const usual = tables.job.find((/** @type {Option} */ option) => option.name === name).default;
        store.set({ job: value === undefined || value === usual ? rest : { ...rest, [name]: value } });
    }

    /**
     * @param {Option} option
     * @param {any} value
     * @param {State} state
     */
    #field(option, value, { tables, unit, jobRefusal }) {
        const { name, kind, words } = option;
        const bad = jobRefusal?.error.key === name && jobRefusal.error;
        const said = {
            help: inLabels(option.help),
            ...(bad ? { error: inLabels(`${bad.message} ${bad.remedy}`) } : {}),
        };
        const label = labelOf(name);
        const key = KEY + name;
        const now = value ?? option.default;
        const choices = name === "preset" ? tables.presets.map((/** @type {any} */ preset) => preset.name) : words;
        if (kind === "flag") {
            const input = make("input", {
                type: "checkbox",
                "data-key": key,
                ".checked": Boolean(now),
                onchange: (/** @type {Event} */ event) =>
                    this.#set(name, /** @type {HTMLInputElement} */ (event.target).checked || undefined),
            });
            return field(label, input, said);
        }
        if (choices?.length) {
            const select = make("select", {
                "data-key": key,
                onchange: (/** @type {Event} */ event) =>
                    this.#set(name, /** @type {HTMLSelectElement} */ (event.target).value || undefined),
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
                (length) => this.#set(name, length * mm),
                { "data-key": key, placeholder: "automatic" },
                () => this.#set(name, undefined),
            );
            return field(`${label}, ${unit}`, input, said);
        }
        const input = make("input", {
            type: "text",
            spellcheck: "false",
            "data-key": key,
            ".defaultValue":
                now === null || now === undefined ? "" : Array.isArray(now) ? now.join(" x ") : String(now),
            placeholder: option.shown || "automatic",
            onchange: () => {
                const text = input.value.trim();
                input.defaultValue = input.value;
                const isNumber = (kind === "angle" || kind === "number") && Number.isFinite(Number(text));
                this.#set(name, text === "" ? undefined : isNumber ? Number(text) : text);
            },
        });
        return field(label, input, said);
    }
}
