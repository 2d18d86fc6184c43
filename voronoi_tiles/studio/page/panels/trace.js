// @ts-check
// A picture to trace, under the drawing: it stays in the page, and in no file; where it lies is kept for each design.

import { latticeOf } from "../model/symmetry.js";
import { length, plus, scaled } from "../model/plane.js";
import { shownFactor } from "../store.js";
import { lay, setTrace } from "../tools/trace.js";
import { above, button, deferred, field, lengthField, make, refill } from "./elements.js";

/** The controls of the picture. @type {(context: import("./panels.js").Context) => HTMLElement} */
export function tracePart({ store }) {
    const strength = make("input", {
        type: "range",
        min: 0,
        max: 1,
        step: 0.05,
        oninput: () => setTrace(store, { opacity: strength.valueAsNumber }),
    });
    const file = make("input", {
        type: "file",
        accept: "image/png,image/jpeg,image/webp,image/gif,image/svg+xml",
        "aria-label": "Picture to trace",
        onchange: async () => {
            const chosen = file.files?.[0];
            if (!chosen) {
                return;
            }
            try {
                const image = await createImageBitmap(chosen);
                const { trace, design, tables } = store.state;
                const { a, b } = latticeOf(design, tables);
                setTrace(store, { image, at: trace.at ?? scaled(plus(a, b), 0.5), width: trace.width || length(a) });
            } catch {
                store.set({
                    trouble: {
                        message: `${chosen.name} is no picture that this browser reads.`,
                        remedy: "Take a PNG or JPEG.",
                    },
                });
            }
        },
    });
    const place = make("div");
    const more = make("div", {}, field("Strength", strength), place);
    const fill = () => {
        const { trace, unit, tables } = store.state;
        more.hidden = !trace.image;
        if (!trace.image || !trace.at || !tables) {
            file.value = "";
            return;
        }
        strength.value = trace.opacity;
        const factor = shownFactor(store.state);
        const at = trace.at;
        const coordinate = (/** @type {0 | 1} */ axis) =>
            lengthField(
                at[axis] * factor,
                unit,
                (value) => lay(store, { at: axis ? [at[0], value / factor] : [value / factor, at[1]] }),
                { "aria-label": `Middle of the picture, ${"xy"[axis]}`, "data-key": `picture ${axis}` },
            );
        const width = lengthField(trace.width * factor, unit, (value) => lay(store, { width: above(value) / factor }), {
            "data-key": "picture width",
        });
        const turn = make("input", {
            type: "number",
            step: "any",
            "data-key": "picture turn",
            ".value": trace.turn,
            onchange: () => Number.isFinite(turn.valueAsNumber) && lay(store, { turn: turn.valueAsNumber }),
        });
        refill(place, [
            make("div", { class: "field point" }, make("span", {}, "Middle"), coordinate(0), coordinate(1)),
            field(`Picture width, ${unit}`, width),
            field("Picture turn, degrees", turn),
            make(
                "p",
                { class: "group" },
                button("Move picture", () => setTrace(store, { moves: !store.state.trace.moves }), {
                    id: "move-picture",
                    "data-key": "move picture",
                    "aria-pressed": trace.moves,
                    title: "Drag it, or a corner of it; arrows move it",
                }),
                button("Take out", () => setTrace(store, { image: null, moves: false }), { "data-key": "no picture" }),
            ),
        ]);
    };
    store.subscribe(["trace", "unit", "tables", "design"], deferred(fill), { calm: true });
    return make("div", {}, file, more);
}
