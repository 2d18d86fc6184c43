// @ts-check
// Group and cell: the 17 groups as pictures of this drawing, the cell's free lengths, and what the window shows.

import { setCell, setUnits } from "../model/design.js";
import { shownFactor } from "../store.js";
import { setGroup } from "../model/regroup.js";
import { groupOf } from "../model/symmetry.js";
import { drawThumbnail } from "../view/thumbnail.js";
import { above, deferred, field, lengthField, make, refill } from "./elements.js";
import { tracePart } from "./trace.js";

/** @import { Context } from "./panels.js" */
/** @import { State } from "../store.js" */

/** @type {[keyof State["shown"], string][]} */
const SHOWN = [
    ["colours", "Coloured tiles"],
    ["edges", "Exact edges"],
    ["art", "Art"],
    ["copies", "Copies of the strokes (K)"],
    ["elements", "Mirrors, glides, centres (E)"],
    ["cell", "Cell"],
    ["region", "One asymmetric unit"],
    ["grid", "Grid (G)"],
];

const THUMBNAIL = 72;
const ASK_MS = 400;

/** What a group is called, and what it does. @param {{name: string, title: string}} group */
const inWords = ({ name, title }) => `${name}: ${title}`;

export class SymmetryPanel extends HTMLElement {
    /** @type {Context} */
    // @ts-expect-error set by connect, before anything else
    #context;
    #heading = make("h2", {}, "Group");
    #groups = make("div", { class: "groups", role: "radiogroup", "aria-label": "Wallpaper group" });
    #cell = make("div");
    #shown = make("div");
    #note = make("p", { class: "note", role: "status" });
    #timer = 0;
    /** @type {any} the design that the thumbnails are of */
    #pictured = null;
    /** @type {string[]} the groups whose pictures are still to be asked for */
    #waiting = [];
    /** @type {{rev: number, group: string, design: any}} the last picture that was asked for; they are numbered */
    #asked = { rev: 0, group: "", design: null };
    /** @type {{from: any, made: any, note: string} | null} the design before groups were tried, what the last one made of it */
    #tried = null;

    /** @param {Context} context */
    connect(context) {
        this.#context = context;
        const { store, link } = context;
        this.replaceChildren(
            this.#heading,
            this.#groups,
            this.#note,
            make("h2", {}, "Cell"),
            this.#cell,
            make("h2", {}, "Show"),
            this.#shown,
            make("h2", {}, "Picture to trace"),
            tracePart(context),
        );
        store.subscribe(
            ["tables", "design", "unit", "dragging", "exact", "site"],
            deferred(() => this.#fill(store.state)),
        );
        store.subscribe(["shown"], (state) => this.#fillShown(state));
        link.on("thumbnail", (message) => this.#answered(message));
        link.on("refused", (message) => this.#answered(message));
        link.on("opened", () => {
            this.#pictured = null; // what was asked for before a connection was lost is not answered
            this.#ask();
        });
        new IntersectionObserver(() => this.#ask()).observe(this);
    }

    /** @param {State} state */
    #fill(state) {
        if (!state.tables || state.dragging) {
            return;
        }
        if (!this.#groups.children.length) {
            this.#groups.append(...state.tables.groups.map((/** @type {any} */ group) => this.#thumbnail(group)));
        }
        for (const button of this.#groups.children) {
            const on = button.dataset.group === state.design.group;
            button.setAttribute("aria-checked", String(on));
            button.tabIndex = on ? 0 : -1;
        }
        this.#note.textContent = this.#tried?.made === state.design ? this.#tried.note : "";
        this.#heading.textContent = `Group ${inWords(groupOf(state.design, state.tables))}`;
        refill(this.#cell, this.#cellFields(state));
        clearTimeout(this.#timer);
        this.#timer = window.setTimeout(() => this.#ask(), ASK_MS);
    }

    /** @param {any} group */
    #thumbnail(group) {
        return make(
            "button",
            {
                role: "radio",
                "data-group": group.name,
                title: inWords(group),
                "aria-label": inWords(group),
                onclick: () => this.#choose(group.name),
                onkeydown: (/** @type {KeyboardEvent} */ event) => this.#step(event),
            },
            make("canvas", { width: THUMBNAIL, height: THUMBNAIL, "aria-hidden": "true" }),
            make("span", {}, group.name),
        );
    }

    /** @param {KeyboardEvent} event */
    #step(event) {
        const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
        if (step) {
            const all = [...this.#groups.children];
            const next = all[(all.indexOf(event.currentTarget) + step + all.length) % all.length];
            all.forEach((one) => {
                one.tabIndex = one === next ? 0 : -1;
            });
            next.focus();
            event.preventDefault();
            event.stopPropagation();
        }
    }

    /**
     * The design that groups are tried on. Who looks at several sees each made of the one before the first: what one had
     * to move is not kept.
     */
    get #origin() {
        const { settled } = this.#context.store;
        return this.#tried?.made === settled ? this.#tried.from : settled;
    }

    /**
     * A design in a group: what its picture shows, and what a click on that gives.
     * @param {import("../model/design.js").Design} from
     * @param {string} name
     */
    #inGroup(from, name) {
        const { tables, exact } = this.#context.store.state;
        return setGroup(from, name, tables, exact?.resolved);
    }

    /** @param {string} name */
    #choose(name) {
        const { store } = this.#context;
        const from = this.#origin;
        const { design, note } = this.#inGroup(from, name);
        store.edit(() => design);
        this.#tried = { from, made: store.settled, note };
    }

    /** Ask for pictures of this drawing in all groups, where they are looked at. */
    #ask() {
        const { tables, dragging } = this.#context.store.state;
        if (tables && !dragging && this.checkVisibility() && this.#pictured !== this.#origin) {
            this.#pictured = this.#origin;
            this.#waiting = tables.groups.map((/** @type {any} */ group) => group.name);
            this.#askNext();
        }
    }

    /** Ask for the next picture: one at a time, so that neither end has much to do at once. */
    #askNext() {
        const group = this.#waiting.shift();
        if (group) {
            const { design } = this.#inGroup(this.#pictured, group);
            this.#asked = { rev: this.#asked.rev + 1, group, design };
            if (!this.#context.link.send({ type: "thumbnail", rev: this.#asked.rev, design })) {
                this.#pictured = null;
            }
        }
    }

    /** @param {{type: string, rev: number, lane?: string, tiles?: any, error?: {message: string}}} message */
    #answered({ type, rev, lane, tiles, error }) {
        const { group, design } = this.#asked;
        if (rev !== this.#asked.rev || (type === "refused" && lane !== "thumbnail")) {
            return;
        }
        const button = [...this.#groups.children].find((one) => one.dataset.group === group);
        button.classList.toggle("refused", !tiles);
        button.title = error ? `${group}: ${error.message}` : (button.getAttribute("aria-label") ?? group);
        if (tiles) {
            const { store, stage } = this.#context;
            const looks = { side: THUMBNAIL, dark: stage.dark };
            drawThumbnail(button.querySelector("canvas"), design, tiles, store.state.tables, looks);
        }
        this.#askNext();
    }

    /** @param {State} state */
    #cellFields(state) {
        const { store } = this.#context;
        const { design, tables, unit } = state;
        const group = groupOf(design, tables);
        const factor = shownFactor(state);
        /** @type {Node[]} */
        const fields = [];
        for (const name of /** @type {const} */ (["a", "b"])) {
            if (name === "a" || group.free.includes("b")) {
                const input = lengthField(
                    /** @type {any} */ (design.cell)[name] * factor,
                    unit,
                    (value) => store.edit((old) => setCell(old, { [name]: value / factor })),
                    { "data-key": name },
                );
                fields.push(field(`Side ${name}, ${unit}`, input));
            }
        }
        if (group.free.includes("angle")) {
            const input = make("input", {
                type: "number",
                step: "any",
                "data-key": "angle",
                ".value": design.cell.angle ?? 90,
                onchange: (/** @type {Event} */ event) =>
                    store.edit((old) =>
                        setCell(old, { angle: /** @type {HTMLInputElement} */ (event.target).valueAsNumber }),
                    ),
            });
            fields.push(field("Angle, degrees", input));
        }
        fields.push(...this.#sizeFields(factor));
        const units = make("select", {
            "data-key": "units",
            onchange: (/** @type {Event} */ event) =>
                store.edit((old) => setUnits(old, /** @type {any} */ (event.target).value, true)),
        });
        units.append(
            ...Object.keys(tables.units).map((name) =>
                make("option", { ".selected": name === (design.units ?? "mm") }, name),
            ),
        );
        fields.push(field("Units of the file", units, { help: "The design's numbers are converted: its size stays." }));
        return fields;
    }

    /**
     * The tile's width and height: what is given scales the whole design.
     * @param {number} factor from the drawing's units to those that are shown
     * @returns {Node[]}
     */
    #sizeFields(factor) {
        const { store } = this.#context;
        const { exact, design, unit, site } = store.state;
        const tile = exact?.tiles[site];
        if (!exact || !tile || exact.design !== design) {
            return [];
        }
        const scale = factor / (design.scale ?? 1);
        return /** @type {const} */ (["width", "height"]).map((name) =>
            field(
                `Tile ${name}, ${unit}`,
                lengthField(
                    tile[name] * scale,
                    unit,
                    (wanted) => {
                        const times = (((design.scale ?? 1) * above(wanted)) / (tile[name] * scale)).toPrecision(12);
                        store.edit((old) => ({ ...old, scale: Number(times) }));
                    },
                    { "data-key": name },
                ),
                name === "height" ? { help: "Either scales the whole design, cell and strokes." } : {},
            ),
        );
    }

    /** @param {State} state */
    #fillShown({ shown }) {
        const { store } = this.#context;
        refill(
            this.#shown,
            SHOWN.map(([name, label]) =>
                make(
                    "label",
                    { class: "check" },
                    make("input", {
                        type: "checkbox",
                        "data-key": name,
                        ".checked": shown[name],
                        onchange: (/** @type {Event} */ event) =>
                            store.set({
                                shown: {
                                    ...store.state.shown,
                                    [name]: /** @type {HTMLInputElement} */ (event.target).checked,
                                },
                            }),
                    }),
                    label,
                ),
            ),
        );
    }
}
