// @ts-check
// The dialogs: export, gallery, help, share, opening files, and what to do when a file has changed or was left unsaved.

import { HELP } from "../tools/keys.js";
import { paste } from "../clipboard.js";
import { linkOf, sharedDesign } from "../sharing.js";
import { NOTHING } from "../store.js";
import { moveStrokes } from "../model/design.js";
import { rounded } from "../model/snapping.js";
import { placementOf } from "../model/strokes.js";
import { regionOf } from "../model/symmetry.js";
import { boxOf, entriesOf } from "../scene.js";
import { drawThumbnail } from "../view/thumbnail.js";
import { showDialog } from "./dialog.js";
import { field, make } from "./elements.js";
import { download, nameOf, post } from "./exchange.js";
import { lettersPart } from "./letters.js";

/**
 * @typedef {object} Context
 * @property {import("../store.js").Store} store
 * @property {import("../link.js").Link} link
 * @property {import("../view/stage.js").Stage} stage
 * @property {import("../file.js").OpenedFile} file
 */

/** The side of an example's picture; CSS pixels. */
const EXAMPLE = 140;

/**
 * The dialogs of the page, each a function that opens it.
 * @param {HTMLElement} home
 * @param {Context} context
 */
export function dialogs(home, { store, link, stage, file: opened }) {
    /** @param {string} title @param {(Node | string)[]} content @param {import("./dialog.js").Action[]} actions */
    const open = (title, content, actions) => showDialog(home, title, content, actions);

    const close = { label: "Close" };
    const cancel = { label: "Cancel" };

    /** @param {string} message @param {boolean} [quiet] */
    const say = (message, quiet = false) => store.set({ trouble: { message, remedy: "", quiet } });

    /** @param {any} design that takes the place of what is drawn; undo leads back */
    const begin = (design) => {
        store.edit("open", () => design, { selection: NOTHING });
        store.set({ site: 0 });
        stage.fit();
    };

    /** Take what another program has made of the file. */
    const reload = () => link.send({ type: "reload" });

    /** @param {File} file */
    const take = async (file) => {
        const { design } = store.state;
        const units = encodeURIComponent(design.units ?? "mm");
        const answer = await (
            await post(`drop?name=${encodeURIComponent(file.name)}&units=${units}`, file, {
                type: "application/octet-stream",
            })
        ).json();
        if (answer.design) {
            begin(answer.design);
            store.set({ job: answer.job ?? store.state.job });
        } else {
            paste(store, trueSize(answer.strokes), 0);
        }
        if (answer.notes?.length) {
            say(answer.notes.join(" "), true);
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
    document.addEventListener("drop", (event) => {
        event.preventDefault();
        tryTake(event.dataTransfer?.files[0]);
    });
    document.addEventListener("studio-drop", (event) => tryTake(/** @type {CustomEvent} */ (event).detail));

    /**
     * Open a link that holds a design.
     * @param {string} text
     */
    const openLink = (text) => {
        try {
            begin(sharedDesign(text, store.state.tables.limits));
        } catch (error) {
            say(error instanceof Error ? error.message : String(error));
        }
    };
    document.addEventListener("studio-link", (event) => openLink(/** @type {CustomEvent} */ (event).detail));

    return {
        openLink,

        export() {
            const { tables, job, file } = store.state;
            /** @type {HTMLInputElement | null} */
            const unread = document.querySelector("job-panel input:invalid");
            if (unread) {
                const label = unread.labels?.[0].textContent;
                store.set({
                    trouble: {
                        message: `${label}, under Job, cannot be read: ${unread.value || "it is empty"}`,
                        remedy: "Mend it there, or press Escape in it, and export again.",
                    },
                });
                return;
            }
            const stem = file.replace(/\.[^.]*$/, "") || "tiles";
            const name = make("input", { type: "text", ".value": stem, autocomplete: "off" });
            const format = make(
                "select",
                {},
                ...tables.formats.map((/** @type {string} */ one) =>
                    make("option", { value: one }, one === "lbrn2" ? "LightBurn (lbrn2)" : one),
                ),
            );
            const { picture, seconds } = tables.limits;
            const bounds = make("p", { class: "note" });
            const bound = () => {
                bounds.textContent =
                    (format.value === "png"
                        ? `A picture of the plane, ${picture} pixels on its longer side; voronoi-tiles render makes larger ones. `
                        : "") +
                    `What takes longer than ${seconds} s is given up; voronoi-tiles export has no such limit.`;
            };
            format.addEventListener("change", bound);
            bound();
            const what = Object.keys(job).length
                ? Object.entries(job)
                      .map(([key, value]) => `${key} ${Array.isArray(value) ? value.join(" x ") : value}`)
                      .join(", ")
                : "no options: the exact tiles, one of each";
            open(
                "Export",
                [
                    field("Format", format),
                    field("Name", name),
                    make("p", { class: "note" }, `The job: ${what}.`),
                    bounds,
                ],
                [
                    {
                        label: "Download",
                        first: true,
                        run: async (signal) => {
                            const answer = await post(
                                "export",
                                JSON.stringify({
                                    design: store.settled,
                                    job: { ...store.state.job, format: format.value },
                                    name: name.value,
                                }),
                                { signal },
                            );
                            download(await answer.blob(), nameOf(answer, `${name.value}.${format.value}`));
                        },
                    },
                    cancel,
                ],
            );
        },

        coupon() {
            const thickness = make("input", { type: "text", ".value": "3mm" });
            open(
                "A test piece that shows the kerf",
                [
                    make(
                        "p",
                        {},
                        "Cut it once in your material: how well its slots fit says how wide your laser cuts.",
                    ),
                    field("Thickness of the material", thickness),
                ],
                [
                    {
                        label: "Download",
                        first: true,
                        run: async (signal) => {
                            const answer = await post("coupon", JSON.stringify({ thickness: thickness.value }), {
                                signal,
                            });
                            download(await answer.blob(), nameOf(answer, "coupon.svg"));
                        },
                    },
                    cancel,
                ],
            );
        },

        async gallery() {
            const list = make("ul", { class: "gallery" });
            const { box, said } = open(
                "Begin with an example",
                [
                    make("p", { class: "note" }, "Or close this, and go on with what is drawn: undo leads back to it."),
                    list,
                ],
                [close],
            );
            const answer = await fetch("examples.json").catch(() => null);
            if (!answer?.ok) {
                said.textContent = "The examples do not come: the server does not answer.";
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
                        return make("li", {}, make("button", { type: "button", onclick }, canvas, name));
                    }),
                );
            }
        },

        begin() {
            const { file, saved } = store.state;
            const name = make("input", { type: "text", autocomplete: "off" });
            const kept = `What is not saved of ${file} is kept as a copy, which is offered when it is opened again.`;
            open(
                "New design",
                [
                    make("p", {}, `It goes into a file beside ${file}, which the first save writes.`),
                    saved ? "" : make("p", { class: "note" }, kept),
                    field("Name", name, { help: "Without one, the next name that is free" }),
                ],
                [
                    {
                        label: "Begin",
                        first: true,
                        // Until it is there, what is drawn or saved would be of neither.
                        whole: true,
                        async run() {
                            const { revision: rev } = store.state;
                            const asked = { type: "new", rev, design: store.settled, name: name.value };
                            const message = link.send(asked)
                                ? await link.next(({ begun, lane }) => begun || lane === "new")
                                : null;
                            if (message?.error) {
                                throw new Error(`${message.error.message} ${message.error.remedy}`);
                            }
                            if (!message) {
                                throw new Error("There is no connection to the studio's server: try again later.");
                            }
                        },
                    },
                    cancel,
                ],
            );
        },

        open() {
            const input = make("input", {
                type: "file",
                accept: ".toml,.json,.svg,.svgz,.dxf,.pdf,.lbrn2,.gcode,.nc",
                onchange: () => input.closest("dialog").querySelector("button.first").click(),
            });
            const address = make("input", { type: "text", autocomplete: "off", spellcheck: "false" });
            open(
                "Open",
                [
                    make(
                        "p",
                        {},
                        "A design (TOML or JSON) takes the place of what is drawn; undo leads back. So does an SVG, DXF, PDF, LightBurn or G-code file that was exported from here, with the job that it was made of. Another SVG, DXF or G-code drawing becomes strokes of the site in hand.",
                    ),
                    field("File", input),
                    field("Or a link from Share", address),
                ],
                [
                    {
                        label: "Open",
                        first: true,
                        run: async () => {
                            const file = input.files?.[0];
                            if (!file && !address.value) {
                                throw new Error("Choose a file, or paste a link.");
                            }
                            await (file ? take(file) : begin(sharedDesign(address.value, store.state.tables.limits)));
                        },
                    },
                    cancel,
                ],
            );
        },

        share() {
            const address = make("textarea", {
                readonly: true,
                rows: 4,
                "aria-label": "Link",
                ".value": linkOf(store.settled),
            });
            open(
                "Share",
                [
                    make(
                        "p",
                        {},
                        "The link holds the whole design after its #, which browsers do not send. In another studio it opens under Open, or pasted onto the drawing; the file suits everybody.",
                    ),
                    address,
                ],
                [
                    { label: "Copy the link", first: true, run: () => navigator.clipboard.writeText(address.value) },
                    { label: "Download the file", run: () => this.saveAs() },
                    close,
                ],
            );
            address.select();
        },

        async saveAs() {
            const answer = await post("toml", JSON.stringify({ design: store.settled }));
            download(await answer.blob(), nameOf(answer, store.state.file || "design.toml"));
        },

        help() {
            const columns = HELP.map(({ title, rows }) =>
                make(
                    "section",
                    {},
                    make("h3", {}, title),
                    make(
                        "dl",
                        { class: "keys" },
                        ...rows.flatMap(({ keys, does }) => [
                            make("dt", {}, make("kbd", {}, keys)),
                            make("dd", {}, does),
                        ]),
                    ),
                ),
            );
            const { box } = open("Keys", [make("div", { class: "help" }, lettersPart(store), ...columns)], [close]);
            // Not in the field of a letter, where the next key would give a tool another one.
            box.querySelector("footer button")?.focus({ preventScroll: true });
        },

        /** @param {{recovery: {design: any, at: string}, saved: boolean}} message */
        recover({ recovery: { design, at }, saved }) {
            open(
                "Something was not saved",
                [
                    make(
                        "p",
                        {},
                        `There is a copy of what was drawn last, at ${new Date(at).toLocaleString()}. ${saved ? "It is newer than the file." : "It was never saved."}`,
                    ),
                ],
                [
                    { label: "Take the copy", first: true, run: () => begin(design) },
                    { label: saved ? "Stay with the file" : "Begin anew" },
                ],
            );
        },

        /** @param {{design: any, note?: string}} message */
        conflict({ design, note }) {
            open(
                "The file has changed",
                [
                    make("p", {}, note ?? "Another program has written the design's file."),
                    make(
                        "p",
                        {},
                        "What is drawn here takes its place if you keep it; what was there stays beside it as a backup.",
                    ),
                ],
                [
                    {
                        label: "Keep mine",
                        first: true,
                        run: () => opened.save(true),
                    },
                    ...(design ? [{ label: "Take theirs", run: reload }] : []),
                    cancel,
                ],
            );
        },

        /** @param {{design: any, note?: string}} message */
        changed({ design, note }) {
            if (design && store.state.saved) {
                reload();
                return;
            }
            store.keep(null);
            open(
                "The file has changed outside",
                [
                    make("p", {}, note ?? "Another program has written the design's file."),
                    make(
                        "p",
                        { class: "note" },
                        "If you keep yours, the next save writes it there, and what is there now stays beside it as a backup.",
                    ),
                ],
                [
                    ...(design ? [{ label: "Take theirs", first: true, run: reload }] : []),
                    { label: "Keep mine", run: () => opened.keepMine() },
                ],
            );
        },
    };
}
