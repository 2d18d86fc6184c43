// @ts-check
// The job: all that `voronoi-tiles export` offers, made from the server's table of options, common ones first.

import { button, deferred, inLabels, make, refill } from "./elements.js";
import { optionField, withOption } from "./options.js";

/** @import { Context } from "./panels.js" */
/** @import { State } from "../store.js" */
/** @import { Option } from "./options.js" */

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
        const { store } = this.#context;
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
                    const fields = own.map((option) =>
                        optionField(option, job[option.name], state, {
                            of: "job",
                            error: bad,
                            set: (name, value) => store.set({ job: withOption(store.state.job, options, name, value) }),
                        }),
                    );
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
}
