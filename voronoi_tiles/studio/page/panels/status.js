// @ts-check
// What the page says around the drawing: the file, whether its tile is proved, sizes, what is wrong.

import { siteNames } from "../model/design.js";
import { shown } from "../model/lengths.js";
import { shownFactor } from "../store.js";
import { stepIn } from "../tools/trace.js";
import { button, byId, make } from "./elements.js";

/** @param {import("../store.js").State} state @returns {[string, string]} */
function proofOf({ exact, proved, refusal, revision, connected, behind, dragging }) {
    if (!connected) {
        return ["behind", "no connection"];
    }
    if (refusal) {
        return ["refused", "no tile"];
    }
    if (!exact || (exact.rev < revision && (behind || !dragging))) {
        return ["behind", "exact tile follows"];
    }
    // While something is dragged, the proof of the last outline may be on its way.
    if (proved !== exact.rev && !(dragging && proved === exact.after)) {
        return ["proving", "exact, proof follows"];
    }
    if (exact.unfit) {
        return ["refused", "proved, but it cannot stand"];
    }
    return ["proved", exact.art?.trouble ? "proved, but without its art" : "proved"];
}

const LOST = {
    message: "The connection to the studio's server is lost.",
    remedy: "The page tries again; what is drawn stays here. If the server was stopped, start it again: voronoi-tiles studio.",
};

/**
 * Why there is no tile, in the page's words where it knows what to do here; or why there is no solid.
 * @type {(state: import("../store.js").State) => import("../store.js").Trouble | null}
 */
function whyNoTile({ design, refusal, exact }) {
    const bare = design.site.findIndex((site) => !site.strokes.length);
    if (!refusal || bare < 0) {
        return refusal?.error ?? exact?.unfit ?? exact?.art?.trouble ?? null;
    }
    const what = design.site.length > 1 ? `${siteNames(design)[bare]} has no stroke yet` : "Nothing is drawn yet";
    return { message: what, remedy: "Take the pen or another tool and draw.", quiet: true };
}

/** Say it, now and after every change. @param {import("../store.js").Store} store */
export function showStatus(store) {
    store.subscribe(["file", "saved"], ({ file, saved }) => {
        byId("file").textContent = file || "no design";
        byId("saved").dataset.state = saved ? "saved" : "unsaved";
        byId("saved").textContent = saved ? "saved" : "not saved";
        document.title = `${saved ? "" : "* "}${file || "studio"} - voronoi_tiles`;
    });

    store.subscribe(
        ["revision", "dragging", "trace"],
        ({ trace: { moves } }) => {
            for (const [command, can] of /** @type {const} */ ([
                ["undo", store.canUndo || (moves && stepIn(store, "past"))],
                ["redo", store.canRedo || (moves && stepIn(store, "future"))],
            ])) {
                /** @type {HTMLButtonElement} */ (document.querySelector(`[data-command=${command}]`)).disabled = !can;
            }
        },
        { calm: true },
    );

    store.subscribe(
        ["exact", "proved", "refusal", "revision", "connected", "behind", "dragging"],
        (state) => {
            const [name, text] = proofOf(state);
            byId("exact").dataset.state = name;
            byId("exact").textContent = text;
            document.documentElement.dataset.exact = `${name} ${state.exact?.rev ?? -1} ${state.revision}`;
        },
        { calm: true },
    );

    store.subscribe(
        ["exact", "refusal", "unit", "tables", "design"],
        ({ exact, refusal, unit, tables, design }) => {
            if (!exact || !tables || refusal) {
                byId("measure").textContent = "";
                return;
            }
            const mm = tables.units[design.units ?? "mm"];
            const parts = exact.tiles.slice(0, 3).map((tile) => {
                const [width, height] = [tile.width, tile.height].map((side) =>
                    ((side * mm) / tables.units[unit]).toFixed(unit === "mm" ? 2 : 3),
                );
                const neighbours = `${tile.neighbours} ${tile.neighbours === 1 ? "neighbour" : "neighbours"}`;
                return `${exact.tiles.length > 1 ? `${tile.site}: ` : ""}${width} x ${height} ${unit}, ${neighbours}, ${tile.copies} in a cell`;
            });
            byId("measure").textContent = parts.join("; ") + (exact.tiles.length > 3 ? "; ..." : "");
        },
        { calm: true },
    );

    store.subscribe(
        ["pointer", "unit", "tables", "design"],
        (state) => {
            const { pointer, unit, tables } = state;
            const parts = tables && pointer?.map((part) => shown(part * shownFactor(state), unit));
            byId("pointer").textContent = parts ? `${parts.join(", ")} ${unit}` : "";
        },
        { calm: true },
    );

    store.subscribe(["refusal", "trouble", "connected", "exact"], (state) => {
        const { trouble, connected } = state;
        const said = [connected ? null : LOST, trouble, connected ? whyNoTile(state) : null].filter(
            (one) => one !== null,
        );
        const banner = byId("banner");
        banner.hidden = !said.length;
        banner.classList.toggle(
            "quiet",
            said.every((one) => "quiet" in one && one.quiet),
        );
        banner.replaceChildren(
            ...said.map((one) => {
                const strong = make(
                    "strong",
                    {},
                    one.message
                        .replace(/[.?!]?$/, (end) => end || ".")
                        .replace(/^[a-z]+ /, (word) => word[0].toUpperCase() + word.slice(1)),
                );
                const close =
                    one === trouble && button("Close", () => store.set({ trouble: null }), { class: "quiet" });
                return make("div", {}, make("p", {}, strong, ` ${one.remedy}`), close);
            }),
        );
    });

    store.subscribe(["unit"], ({ unit }) => {
        /** @type {HTMLSelectElement} */ (byId("unit")).value = unit;
    });
    byId("unit").addEventListener("change", (event) => {
        store.set({ unit: /** @type {any} */ (event.target).value });
    });
}
