// @ts-check
// Strokes go to the clipboard as an SVG drawing, and come from it as SVG of any program.

import { copied, isSameStroke } from "./model/design.js";
import { without } from "./tools/select.js";
import { NOTHING } from "./store.js";

/**
 * The SVG of some strokes, with the strokes themselves in a data attribute, so that they come back as they are.
 * @param {readonly import("./scene.js").Entry[]} entries
 * @param {any[]} strokes
 */
function svgOf(entries, strokes) {
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    const paths = entries.map(({ cubics }) => {
        let data = "";
        for (let k = 0; k < cubics.length; k += 8) {
            const c = [...cubics.subarray(k, k + 8)].map((value, n) => (n % 2 ? -value : value));
            c.forEach((value, n) => {
                box[n % 2] = Math.min(box[n % 2], value);
                box[2 + (n % 2)] = Math.max(box[2 + (n % 2)], value);
            });
            const again = k > 0 && cubics[k] === cubics[k - 2] && cubics[k + 1] === cubics[k - 1];
            data += `${again ? "" : `M ${c[0]} ${c[1]} `}C ${c.slice(2).join(" ")} `;
        }
        return `<path d="${data.trim()}" fill="none" stroke="black" stroke-width="0.2"/>`;
    });
    const [width, height] = [Math.max(box[2] - box[0], 1), Math.max(box[3] - box[1], 1)];
    const hold = new DOMParser().parseFromString('<svg xmlns="http://www.w3.org/2000/svg"/>', "image/svg+xml");
    hold.documentElement.setAttribute("data-voronoi-tiles", JSON.stringify(strokes));
    const attribute = new XMLSerializer().serializeToString(hold).match(/data-voronoi-tiles="[^"]*"/)?.[0] ?? "";
    return `<svg xmlns="http://www.w3.org/2000/svg" ${attribute} width="${width}mm" height="${height}mm" viewBox="${box[0]} ${box[1]} ${width} ${height}">${paths.join("")}</svg>`;
}

/**
 * The strokes in a text from the clipboard: ours, or null where it is another's SVG, or none.
 * @type {(text: string) => any[] | null}
 */
function ownStrokes(text) {
    const root = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
    const held = root.getAttribute("data-voronoi-tiles");
    try {
        const strokes = held ? JSON.parse(held) : null;
        return Array.isArray(strokes) && strokes.every((stroke) => stroke && typeof stroke === "object")
            ? strokes
            : null;
    } catch {
        return null;
    }
}

/** Listen to copy, cut and paste over the drawing. @param {import("./tools/tool.js").Hands} hands */
export function clipboard({ store, entries, camera }) {
    const typing = () => document.activeElement?.matches("input, select, textarea") ?? false;

    for (const kind of /** @type {const} */ (["copy", "cut"])) {
        document.addEventListener(kind, (event) => {
            const { selection } = store.state;
            if (typing() || !selection.strokes.length || !event.clipboardData) {
                return;
            }
            const chosen = entries().filter(({ ref }) => selection.strokes.some((other) => isSameStroke(other, ref)));
            const strokes = chosen.map(({ ref }) => store.settled.site[ref.site].strokes[ref.stroke]);
            const svg = svgOf(chosen, strokes);
            event.clipboardData.setData("image/svg+xml", svg);
            event.clipboardData.setData("text/plain", svg);
            event.preventDefault();
            if (kind === "cut") {
                store.edit((design) => without(design, { strokes: selection.strokes, nodes: [] }), {
                    selection: NOTHING,
                });
            }
        });
    }

    document.addEventListener("paste", (event) => {
        const data = event.clipboardData;
        const text = data?.getData("image/svg+xml") || data?.getData("text/plain") || "";
        if (typing()) {
            return;
        }
        if (text.includes("#design=")) {
            event.preventDefault();
            document.dispatchEvent(new CustomEvent("studio-link", { detail: text }));
            return;
        }
        if (!text.includes("<svg")) {
            return;
        }
        event.preventDefault();
        const own = ownStrokes(text);
        if (own) {
            paste(store, own, 12 / camera.scale);
        } else {
            document.dispatchEvent(
                new CustomEvent("studio-drop", { detail: new File([text], "pasted.svg", { type: "image/svg+xml" }) }),
            );
        }
    });
}

/**
 * Add strokes to the site in hand, a little beside where they were, and select them.
 * @param {import("./store.js").Store} store
 * @param {any[]} strokes
 * @param {number} by units
 */
export function paste(store, strokes, by) {
    const { site } = store.state;
    const placed = strokes.map((stroke) => ({ site, stroke }));
    const { design, refs } = copied(store.settled, placed, by);
    store.edit(() => design, { selection: { strokes: refs, nodes: [] } });
}
