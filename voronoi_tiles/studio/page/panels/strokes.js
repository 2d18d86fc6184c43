// @ts-check
// The list of sites, strokes and points, as numbers: all that can be done by dragging can be done here.

import {
    addSite,
    addStroke,
    copied,
    isSameNode,
    isSameStroke,
    moveStrokes,
    nameProblem,
    removeSite,
    removeStrokes,
    renameSite,
    replaceStroke,
    siteNames,
} from "../model/design.js";
import { joinSelected } from "../model/joining.js";
import { moveNodes } from "../model/nodes.js";
import { NOTHING, shownFactor } from "../store.js";
import { button, lengthField, make, refill, textField } from "./elements.js";

/** @import { Context } from "./panels.js" */
/** @import { State } from "../store.js" */
/** @import { Entry } from "../scene.js" */

/** @type {Record<string, string>} what kinds of strokes are called */
const NAMES = {
    point: "Point",
    segment: "Line",
    polyline: "Line",
    bezier: "Pen curve",
    hermite: "Pen curve",
    catmull_rom: "Curve through points",
    bspline: "B-spline",
    circle: "Circle",
    path: "SVG path",
    file: "Drawing",
};

/** @type {Record<string, string>} what roles of nodes are called */
export const ROLES = { anchor: "Point", in: "Handle before", out: "Handle after", centre: "Middle", radius: "Rim" };

const NODES_MAX = 60;

export class StrokePanel extends HTMLElement {
    /** @type {Context} */
    // @ts-expect-error set by connect, before anything else
    #context;
    #shown = { design: /** @type {any} */ (null), selection: /** @type {any} */ (null), unit: "", site: -1 };

    /** @param {Context} context */
    connect(context) {
        this.#context = context;
        context.store.subscribe(["design", "selection", "unit", "site", "tables", "dragging"], (state) =>
            this.#fill(state),
        );
    }

    /** @param {State} state */
    #fill(state) {
        const { design, selection, unit, site, tables, dragging } = state;
        const old = this.#shown;
        // While something is dragged the list stays: it would be made anew for each frame.
        if (
            !tables ||
            dragging ||
            (old.design === design && old.selection === selection && old.unit === unit && old.site === site)
        ) {
            return;
        }
        this.#shown = { design, selection, unit, site };
        const entries = this.#context.stage.entries();
        refill(this, [
            ...design.site.flatMap((_, i) => this.#site(state, entries, i)),
            make(
                "p",
                {},
                button("Add a site", () => this.#addSite(), { "data-key": "add site" }),
            ),
            make(
                "p",
                { class: "note" },
                "A site is one tile; its strokes may cross and branch. The tools at the left draw into the site that is marked.",
            ),
        ]);
    }

    /** The factor from the drawing's units to those that are shown. */
    get #factor() {
        return shownFactor(this.#context.store.state);
    }

    #addSite() {
        const { store } = this.#context;
        store.edit((design) => addSite(design), { selection: NOTHING });
        store.set({ site: store.state.design.site.length - 1 });
    }

    /**
     * @param {State} state
     * @param {Entry[]} entries
     * @param {number} i
     * @returns {Node[]}
     */
    #site(state, entries, i) {
        const { store } = this.#context;
        const name = siteNames(state.design)[i];
        const rename = (/** @type {string} */ text) => {
            const problem = nameProblem(store.settled, i, text);
            if (problem) {
                throw new Error(problem);
            }
            store.edit((design) => renameSite(design, i, text));
        };
        const field = textField(name, rename, { "aria-label": `Name of site ${i + 1}`, "data-key": `name ${i}` });
        const draw = make("input", {
            type: "radio",
            name: "site",
            "aria-label": `Draw into site ${name}`,
            "data-key": `draw ${i}`,
            ".checked": state.site === i,
            onchange: () => store.set({ site: i }),
        });
        const takeOut = () => {
            store.set({ site: 0 });
            store.edit((design) => removeSite(design, i), { selection: NOTHING });
        };
        const remove = button("Take out", takeOut, {
            class: "quiet",
            "data-key": `remove site ${i}`,
            "aria-label": `Take out site ${name}`,
            ".disabled": state.design.site.length < 2,
        });
        const own = entries.filter((entry) => entry.ref.site === i);
        return [
            make("div", { class: "site" }, draw, field, remove),
            own.length
                ? make("ul", { class: "strokes" }, ...own.map((entry) => this.#stroke(state, entry)))
                : make("p", { class: "note" }, "No stroke yet: take the pen and draw."),
        ];
    }

    /** @param {State} state @param {Entry} entry */
    #stroke(state, entry) {
        const { store } = this.#context;
        const { ref } = entry;
        const chosen = state.selection.strokes.some((other) => isSameStroke(other, ref));
        const label = `${NAMES[entry.kind] ?? "Stroke"} ${ref.stroke + 1}`;
        /** @param {MouseEvent} event */
        const choose = ({ shiftKey, ctrlKey, metaKey }) => {
            const more = shiftKey || ctrlKey || metaKey;
            const others = more ? state.selection.strokes.filter((other) => !isSameStroke(other, ref)) : [];
            store.set({
                selection: { strokes: more && chosen ? others : [...others, ref], nodes: [] },
                site: ref.site,
                tool: "select",
            });
        };
        const attributes = {
            class: "stroke",
            "aria-expanded": chosen,
            "data-key": `stroke ${ref.site} ${ref.stroke}`,
        };
        return make("li", {}, button(label, choose, attributes), chosen && this.#points(state, entry, label));
    }

    /**
     * @param {State} state
     * @param {Entry} entry
     * @param {string} label
     */
    #points(state, entry, label) {
        const { store } = this.#context;
        const { ref } = entry;
        const { strokes, nodes: points } = state.selection;
        const key = `${ref.site} ${ref.stroke}`;
        const takeOut = () => store.edit((design) => removeStrokes(design, [ref]), { selection: NOTHING });
        const nodes = entry.nodes.slice(0, NODES_MAX);
        const shown = nodes.map((node, k) => {
            const at = /** @type {[number, number]} */ (node.at);
            const coordinate = (/** @type {0 | 1} */ axis) =>
                lengthField(
                    at[axis] * this.#factor,
                    state.unit,
                    (value) => {
                        const to = /** @type {[number, number]} */ ([...at]);
                        to[axis] = value / this.#factor;
                        const moves = [{ node: node.node, to }];
                        store.edit((design) =>
                            replaceStroke(
                                design,
                                ref,
                                moveNodes(design.site[ref.site].strokes[ref.stroke], entry.placement, moves),
                            ),
                        );
                    },
                    {
                        "aria-label": `${label}, ${ROLES[node.role] ?? node.role} ${k + 1}, ${"xy"[axis]}`,
                        "data-key": `${key} ${node.node} ${axis}`,
                    },
                );
            const has = points.some((other) => isSameNode(other, { ...ref, node: node.node }));
            return make(
                "li",
                { class: has ? "point chosen" : "point" },
                make("span", { class: node.role === "anchor" ? "" : "note" }, ROLES[node.role] ?? node.role),
                coordinate(0),
                coordinate(1),
            );
        });
        return make(
            "div",
            { class: "points" },
            make("ol", {}, ...shown),
            entry.nodes.length > NODES_MAX &&
                make("p", { class: "note" }, `and ${entry.nodes.length - NODES_MAX} more`),
            this.#move(state, entry),
            make(
                "p",
                { class: "group" },
                button("Double", () => this.#double(entry), { "data-key": `double ${key}` }),
                button("Take out", takeOut, { "data-key": `delete ${key}` }),
                joinSelected(state.design, state.selection) &&
                    button(strokes.length > 1 || points.length === 2 ? "Join" : "Close", null, {
                        "data-command": "join",
                        "data-key": `join ${key}`,
                        title: "The two ends that are selected, or those of the selected strokes that are nearest (J)",
                    }),
                state.design.site.length > 1 && this.#otherSite(state, entry),
            ),
        );
    }

    /** Fields that move the whole stroke. @param {State} state @param {Entry} entry */
    #move(state, entry) {
        const by = (/** @type {0 | 1} */ axis) =>
            lengthField(
                0,
                state.unit,
                (value) => {
                    const step = /** @type {[number, number]} */ ([0, 0]);
                    step[axis] = value / this.#factor;
                    this.#context.store.edit((design) => moveStrokes(design, [entry.ref], step));
                },
                {
                    "aria-label": `Move by ${"xy"[axis]}`,
                    "data-key": `by ${entry.ref.site} ${entry.ref.stroke} ${axis}`,
                },
            );
        return make("div", { class: "point" }, make("span", {}, "Move by"), by(0), by(1));
    }

    /** @param {Entry} entry */
    #double({ ref }) {
        const { store, stage } = this.#context;
        const by = 12 / stage.camera.scale;
        const { design, refs } = copied(
            store.settled,
            [{ site: ref.site, stroke: store.settled.site[ref.site].strokes[ref.stroke] }],
            by,
        );
        store.edit(() => design, { selection: { strokes: refs, nodes: [] } });
    }

    /** Where the stroke goes: another site. @param {State} state @param {Entry} entry */
    #otherSite(state, { ref }) {
        const options = state.design.site.map((_, i) =>
            make("option", { value: i, ".selected": i === ref.site }, siteNames(state.design)[i]),
        );
        const choose = make("select", {
            "aria-label": "Site of the stroke",
            onchange: (/** @type {Event} */ event) => {
                const to = Number(/** @type {HTMLSelectElement} */ (event.target).value);
                this.#context.store.edit(
                    (design) => removeStrokes(addStroke(design, to, design.site[ref.site].strokes[ref.stroke]), [ref]),
                    { selection: NOTHING },
                );
            },
        });
        choose.append(...options);
        return choose;
    }
}
