// @ts-check
// What comes into the page: files and links that are opened or dropped, examples, and what others make of the file.

import { paste } from "../clipboard.js";
import { sharedDesign } from "../sharing.js";
import { NOTHING } from "../store.js";
import { moveStrokes } from "../model/design.js";
import { rounded } from "../model/snapping.js";
import { placementOf } from "../model/strokes.js";
import { regionOf } from "../model/symmetry.js";
import { boxOf, entriesOf } from "../scene.js";
import { drawThumbnail } from "../view/thumbnail.js";
import { showDialog } from "./dialog.js";
import { field, make, said } from "./elements.js";
import { post } from "./exchange.js";
import { fitting, outlinePlace } from "./fitting.js";

/** The side of an example's picture; CSS pixels. */
const EXAMPLE = 140;

/**
 * Take files and links that are dropped and pasted; the dialogs for what comes, each a function that opens it.
 * @param {Pick<import("./panels.js").Context, "store" | "link" | "stage"> & {file: import("../file.js").OpenedFile}} context
 */
export function incoming({ store, link, stage, file: opened }) {
    const cancel = { label: "Cancel" };

    /** @param {string} message @param {boolean} [quiet] */
    const say = (message, quiet = false) => store.set({ trouble: { message, remedy: "", quiet } });

    /** @param {any} design that takes the place of what is drawn; undo leads back */
    const begin = (design) => {
        store.edit(() => design, { selection: NOTHING });
        store.set({ site: 0 });
        stage.fit();
    };

    /** Take what another program has made of the file. */
    const reload = () => link.send({ type: "reload" });

    /** @param {File} file */
    const take = async (file) => {
        const units = encodeURIComponent(store.state.design.units ?? "mm");
        const address = `drop?name=${encodeURIComponent(file.name)}&units=${units}`;
        const { design, job, strokes, notes } = await (
            await post(address, file, { type: "application/octet-stream" })
        ).json();
        if (design) {
            begin(design);
            store.set({ job: job ?? store.state.job });
        } else {
            paste(store, trueSize(strokes), 0);
        }
        if (notes?.length) {
            say(notes.join(" "), true);
        }
    };

    /**
     * Strokes of a drawing in its own size, in the middle of one asymmetric unit, where its copies are least in the way.
     * @param {any[]} strokes in the design's units, before any placement
     */
    const trueSize = (strokes) => {
        const { design, tables, site } = store.state;
        const placement = placementOf(design.site[site], {});
        const scale = Number((1 / ((design.scale ?? 1) * Math.hypot(...placement.a))).toPrecision(12));
        const scaled = strokes.map((stroke) =>
            scale === 1 ? stroke : { ...stroke, scale: (stroke.scale ?? 1) * scale },
        );
        const box = boxOf(entriesOf({ ...design, site: [{ ...design.site[site], strokes: scaled }] }));
        if (!box) {
            return scaled;
        }
        const region = regionOf(design, tables);
        const middle = [0, 1].map((axis) => region.reduce((sum, at) => sum + at[axis], 0) / region.length);
        const by = /** @type {[number, number]} */ (
            rounded([middle[0] - (box[0] + box[2]) / 2, middle[1] - (box[1] + box[3]) / 2], 1 / stage.camera.scale)
        );
        const refs = scaled.map((_, stroke) => ({ site, stroke }));
        const alone = design.site.map((one, i) => (i === site ? { ...one, strokes: scaled } : one));
        return [...moveStrokes({ ...design, site: alone }, refs, by).site[site].strokes];
    };

    /** @param {File | undefined} file */
    const tryTake = (file) => {
        if (file) {
            take(file).catch((error) => say(error.message));
        }
    };
    document.addEventListener("dragover", (event) => event.preventDefault());
    const fits = fitting({ store, begin, say: (message) => say(message, true) });
    const isOutline = outlinePlace();
    document.addEventListener("drop", (event) => {
        event.preventDefault();
        const file = event.dataTransfer?.files[0];
        if (file && (fits.isOpen() || isOutline(event))) {
            fits.open(file);
        } else {
            tryTake(file);
        }
    });
    document.addEventListener("studio-drop", (event) => tryTake(/** @type {CustomEvent} */ (event).detail));

    /** Take the design in a link. @param {string} text */
    const takeLink = (text) => begin(sharedDesign(text, store.state.tables.limits));

    /** Open a link that holds a design. @param {string} text */
    const openLink = (text) => {
        try {
            takeLink(text);
        } catch (error) {
            say(said(error));
        }
    };
    document.addEventListener("studio-link", (event) => openLink(/** @type {CustomEvent} */ (event).detail));

    return {
        openLink,
        fit: () => fits.open(),

        async gallery() {
            const list = make("ul", { class: "gallery" });
            const hint = "Or close this, and go on with what is drawn: undo leads back to it.";
            const { box, failed } = showDialog(
                "Begin with an example",
                [make("p", { class: "note" }, hint), list],
                [{ label: "Close" }],
            );
            const answer = await fetch("examples.json").catch(() => null);
            if (!answer?.ok) {
                failed.textContent = "The examples do not come: the server does not answer.";
                return;
            }
            const examples = await answer.json();
            if (box.open) {
                const looks = { side: EXAMPLE, dark: stage.dark };
                list.append(
                    ...examples.map((/** @type {any} */ { group, title, design, tiles }) => {
                        const canvas = make("canvas", { "aria-hidden": true });
                        drawThumbnail(canvas, design, tiles, store.state.tables, looks);
                        const onclick = () => {
                            begin(design);
                            box.close();
                        };
                        const name = make("span", {}, make("strong", {}, group), `: ${title}`);
                        return make("li", {}, make("button", { onclick }, canvas, name));
                    }),
                );
            }
        },

        begin() {
            const { file, saved } = store.state;
            const name = make("input", { type: "text", autocomplete: "off" });
            const kept = `What is not saved of ${file} is kept as a copy, which is offered when it is opened again.`;
            const run = async () => {
                const { revision: rev } = store.state;
                const asked = { type: "new", rev, design: store.settled, name: name.value };
                const message = link.send(asked) ? await link.next(({ begun, lane }) => begun || lane === "new") : null;
                if (message?.error) {
                    throw new Error(`${message.error.message} ${message.error.remedy}`);
                }
                if (!message) {
                    throw new Error("There is no connection to the studio's server: try again later.");
                }
            };
            showDialog(
                "New design",
                [
                    make("p", {}, `It goes into a file beside ${file}, which the first save writes.`),
                    saved ? "" : make("p", { class: "note" }, kept),
                    field("Name", name, { help: "Without one, the next name that is free" }),
                ],
                // Until it is there, what is drawn or saved would be of neither.
                [{ label: "Begin", first: true, whole: true, run }, cancel],
            );
        },

        open() {
            const input = make("input", {
                type: "file",
                accept: ".toml,.json,.svg,.svgz,.dxf,.pdf,.lbrn2,.gcode,.nc",
                onchange: () => input.closest("dialog").querySelector("button.first").click(),
            });
            const address = make("input", { type: "text", autocomplete: "off", spellcheck: "false" });
            const means =
                "A design (TOML or JSON) takes the place of what is drawn; undo leads back. So does an SVG, DXF, PDF, LightBurn or G-code file that was exported from here, with the job that it was made of. Another SVG, DXF or G-code drawing becomes strokes of the site in hand.";
            const run = async () => {
                const file = input.files?.[0];
                if (!file && !address.value) {
                    throw new Error("Choose a file, or paste a link.");
                }
                await (file ? take(file) : takeLink(address.value));
            };
            showDialog(
                "Open",
                [make("p", {}, means), field("File", input), field("Or a link from Share", address)],
                [{ label: "Open", first: true, run }, cancel],
            );
        },

        /** @param {{recovery: {design: any, at: string}, saved: boolean}} message */
        recover({ recovery: { design, at }, saved }) {
            const age = saved ? "It is newer than the file." : "It was never saved.";
            showDialog(
                "Something was not saved",
                [make("p", {}, `There is a copy of what was drawn last, at ${new Date(at).toLocaleString()}. ${age}`)],
                [
                    { label: "Take the copy", first: true, run: () => begin(design) },
                    { label: saved ? "Stay with the file" : "Begin anew" },
                ],
            );
        },

        /** @param {{design: any, note: string}} message */
        conflict({ design, note }) {
            const means =
                "What is drawn here takes its place if you keep it; what was there stays beside it as a backup.";
            showDialog(
                "The file has changed",
                [make("p", {}, note), make("p", {}, means)],
                [
                    { label: "Keep mine", first: true, run: () => opened.save(true) },
                    ...(design ? [{ label: "Take theirs", run: reload }] : []),
                    cancel,
                ],
            );
        },

        /** @param {{design: any, note: string}} message */
        changed({ design, note }) {
            if (design && store.state.saved) {
                reload();
                return;
            }
            store.keep(null);
            const means =
                "If you keep yours, the next save writes it there, and what is there now stays beside it as a backup.";
            showDialog(
                "The file has changed outside",
                [make("p", {}, note), make("p", { class: "note" }, means)],
                [
                    ...(design ? [{ label: "Take theirs", first: true, run: reload }] : []),
                    { label: "Keep mine", run: () => opened.keepMine() },
                ],
            );
        },
    };
}
