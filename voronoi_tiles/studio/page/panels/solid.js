// @ts-check
// The solid: what it comes to and whether it is proved, how it is looked at, how it stands, and its files.

import { flat, setSolid, standing } from "../model/design.js";
import { tidyProduct } from "../model/plane.js";
import { boxOf } from "../scene.js";
import { shownFactor } from "../store.js";
import { above, button, deferred, field, figures, inLabels, lengthField, make, mark, refill } from "./elements.js";
import { optionField, withOption } from "./options.js";

/** @import { Context } from "./panels.js" */
/** @import { State } from "../store.js" */
/** @import { Option } from "./options.js" */

/** The options of a solid's job that a design with a [solid] has. */
const OF_LOFTS = ["clearance", "chamfer", "accuracy"];
/** The options that are for prisms, under headings. @type {[string, string[]][]} */
const HEADINGS = [
    ["Print", ["height", "clearance", "chamfer", "accuracy"]],
    ["Bed", ["sheet", "margin", "rotate", "gap", "colours"]],
];
/** By how much strokes turn in a solid that is new; degrees. */
const TURN = 30;

export class SolidPanel extends HTMLElement {
    /** @type {Context} */
    // @ts-expect-error set by connect, before anything else
    #context;
    #said = make("div");
    #fields = make("div");

    /** @param {Context} context */
    connect(context) {
        this.#context = context;
        const { store } = context;
        const apart = make("input", {
            type: "range",
            min: 0,
            max: 1,
            step: 0.01,
            ".value": store.state.apart,
            oninput: () => store.set({ apart: apart.valueAsNumber }),
        });
        const look = (/** @type {string} */ label, /** @type {string} */ command) =>
            button(label, null, { "data-command": command });
        this.append(
            this.#said,
            make("h2", {}, "View"),
            field("Apart", apart, { help: "Neighbours are pulled away; at the left end they fill the slab." }),
            make(
                "p",
                { class: "group" },
                look("At an angle", "look-first"),
                look("From above", "look-above"),
                look("From the front", "look-front"),
            ),
            this.#fields,
        );
        store.subscribe(
            ["solid", "solidRefusal", "solidPending", "unit", "tables", "turnsSolids"],
            ({ tables }) => tables && this.#say(),
        );
        const fill = deferred(() => store.state.tables && this.checkVisibility() && this.#fill(), this.#fields);
        store.subscribe(["tables", "design", "solidJob", "solidRefusal", "unit"], fill, { calm: true });
        new ResizeObserver(fill).observe(this.#said); // it is looked at: nobody has filled it meanwhile
    }

    /** Say what there is. */
    #say() {
        const { solid, solidRefusal, solidPending, unit, tables, turnsSolids, design } = this.#context.store.state;
        const mm = tables.units[unit];
        const bad = solidRefusal?.error;
        const length = (/** @type {number} */ size) => (size / mm).toFixed(unit === "mm" ? 2 : 3);
        const rows = (solid?.tiles ?? []).flatMap(({ site, size, volume, triangles }, _, all) => [
            [all.length > 1 ? `${site}` : "Size", `${size.map(length).join(" x ")} ${unit}`],
            ["Volume", `${(volume / 1000).toPrecision(4)} cm³`],
            ["Triangles", triangles.toLocaleString("en")],
        ]);
        const hidden = solid && solid.count > solid.pieces.length;
        const isOld = solidPending || bad;
        this.#said.replaceChildren(
            ...[
                make("h2", {}, design.solid ? "Loft" : "Prism"),
                bad && make("p", { class: "error", role: "alert" }, inLabels(`${bad.message} ${bad.remedy}`)),
                figures(rows, isOld),
                make(
                    "p",
                    { class: "note proof", role: "status", "data-state": isOld ? "old" : solid ? "proved" : "" },
                    bad
                        ? `What is shown is ${solid?.coarse && solid.rev === solidRefusal.rev ? "a coarse one." : "the last that there was."}`
                        : isOld
                          ? solid?.coarse
                              ? "A coarse one; the exact one follows."
                              : "The solid follows."
                          : solid && `proved: ${solid.proved}`,
                ),
                ...(solid?.notes ?? []).map((note) => make("p", { class: "note" }, inLabels(note))),
                hidden &&
                    make("p", { class: "note" }, `${solid.pieces.length} of ${solid.count} pieces are shown here.`),
                !turnsSolids &&
                    make(
                        "p",
                        { class: "note" },
                        "This browser has no WebGL, which turns solids: shown is the program's own picture.",
                    ),
            ].filter(Boolean),
        );
    }

    /** Make the fields anew. */
    #fill() {
        const { store } = this.#context;
        const { state } = store;
        const { design, tables, solidJob: job } = state;
        const options = /** @type {Option[]} */ (tables.solid);
        const error = state.solidRefusal?.error;
        const one = (/** @type {Option} */ option) =>
            optionField(option, job[option.name], state, {
                of: "solid",
                error,
                set: (name, value) => store.set({ solidJob: withOption(store.state.solidJob, options, name, value) }),
            });
        const parts = HEADINGS.map(([title, names]) => ({
            title,
            own: options.filter(({ name }) => names.includes(name) && (!design.solid || OF_LOFTS.includes(name))),
        })).filter(({ own }) => own.length);
        refill(
            this.#fields,
            [
                ...(design.solid ? this.#standing(state) : this.#flat()),
                ...parts.flatMap(({ title, own }) => [make("h2", {}, title), ...own.map(one)]),
                make(
                    "p",
                    { class: "group" },
                    button("Download", null, {
                        class: "first",
                        "data-key": "download",
                        "data-command": "download-solid",
                    }),
                    Object.keys(job).length > 0 &&
                        button("Reset", () => store.set({ solidJob: {} }), { class: "quiet", "data-key": "reset" }),
                ),
            ].filter(Boolean),
        );
    }

    /** How a flat design comes to stand. @returns {HTMLElement[]} */
    #flat() {
        const { store, stage } = this.#context;
        const stand = () => {
            const box = boxOf(stage.entries()) ?? [0, 0, 0, 0];
            const about = /** @type {[number, number]} */ (
                [0, 1].map((axis) => Number(((box[axis] + box[axis + 2]) / 2).toPrecision(4)))
            );
            store.edit((old) => standing(old, TURN, about));
        };
        return [
            make("h2", {}, "On the way up"),
            make(
                "p",
                { class: "note" },
                "The strokes stay as they are: straight walls. Let them turn, and tiles hook into each other in height, too.",
            ),
            make("p", { class: "group" }, button("Let the strokes move", stand, { "data-key": "stand" })),
        ];
    }

    /**
     * How the strokes move on the way up: the design's own keys.
     * @param {State} state
     * @returns {HTMLElement[]}
     */
    #standing(state) {
        const { store } = this.#context;
        const { design, unit } = state;
        const solid = /** @type {NonNullable<typeof design.solid>} */ (design.solid);
        const factor = shownFactor(state);
        /** @param {Partial<typeof solid>} patch */
        const change = (patch) => store.edit((old) => setSolid(old, patch));
        const own = (/** @type {number} */ value) => tidyProduct(value, 1 / factor);
        const bad = state.solidRefusal?.error;
        /** @param {"turn" | "scale" | "layers"} name @param {string} label @param {number} usual @param {string} [help] */
        const number = (name, label, usual, help) => {
            const input = make("input", {
                type: "number",
                step: name === "layers" ? 1 : "any",
                "data-key": name,
                ".defaultValue": solid[name] ?? usual,
                onchange: () => {
                    const value = input.valueAsNumber;
                    if (Number.isFinite(value)) {
                        change({ [name]: value === usual ? undefined : value });
                    }
                },
            });
            return { name, box: field(label, input, { help }), input };
        };
        /** @param {"shift" | "about"} name @param {string} label */
        const point = (name, label) => {
            const at = solid[name] ?? [0, 0];
            const [x, y] = [0, 1].map((axis) =>
                lengthField(
                    at[axis] * factor,
                    unit,
                    (value) => {
                        const to = /** @type {[number, number]} */ (
                            at.map((old, k) => (k === axis ? own(value) : old))
                        );
                        change({ [name]: to[0] || to[1] ? to : undefined });
                    },
                    { "data-key": `${name} ${"xy"[axis]}`, "aria-label": `${label}, ${"xy"[axis]}` },
                ),
            );
            return {
                name,
                box: make("div", { class: "field point" }, make("span", {}, `${label}, ${unit}`), x, y),
                input: y,
            };
        };
        const height = lengthField(solid.height * factor, unit, (value) => change({ height: own(above(value)) }), {
            "data-key": "solid height",
        });
        const rows = [
            { name: "height", box: field(`Height, ${unit}`, height), input: height },
            number("turn", "Turn at the top, degrees", 0),
            number("scale", "Scale at the top", 1),
            point("shift", "Shift at the top"),
            point("about", "Turn and scale about"),
            number(
                "layers",
                "Layers",
                state.tables.layers,
                "At so many heights tiles are exact, at least: there are more where walls take more.",
            ),
        ];
        for (const { name, input } of rows) {
            if (bad?.key === `solid.${name}`) {
                mark(input, bad.message);
            }
        }
        return [
            make("h2", {}, "On the way up"),
            ...rows.map(({ box }) => box),
            make(
                "p",
                { class: "note" },
                design.key?.length
                    ? `${design.key.length} ${design.key.length === 1 ? "key drawing" : "key drawings"} of the file: they are changed there.`
                    : "",
            ),
            make(
                "p",
                { class: "group" },
                button("Straight walls", () => store.edit(flat), {
                    class: "quiet",
                    "data-key": "flat",
                    title: "Take all that moves out of the design",
                }),
            ),
        ];
    }
}
