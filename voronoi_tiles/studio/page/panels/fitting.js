// @ts-check
// Designs whose tiles come near to an outline: its file is dropped or chosen, and they are shown as they are found.

import { messagesOf, withArt, withFit } from "../model/fits.js";
import { showDialog } from "./dialog.js";
import { button, byId, field, inLabels, make, said } from "./elements.js";
import { post } from "./exchange.js";

/** @import { Fit } from "../model/fits.js" */
/**
 * @typedef {object} Search
 * @property {File | null} file
 * @property {readonly Fit[]} fits what it has found, the nearest first
 * @property {number} done the share of it that is done
 * @property {AbortController | null} running what gives it up
 * @property {string} failed
 * @property {readonly string[]} notes on what was taken for what
 */

/** @type {Readonly<Search>} */
const NONE = { file: null, fits: [], done: 0, running: null, failed: "", notes: [] };

const MEANS =
    "A closed line in an SVG or DXF file: an animal, a leaf. What else is drawn, eyes and feathers, goes with it as art. Choose its file, or drop it here.";
const LOST = "The connection to the studio's server is lost: look again when it is back.";

/** A drag that is not heard of for so long is over, or elsewhere; ms. Browsers tell of one three times a second or more. */
const GONE_MS = 800;

/** @param {number} count */
const counted = (count) => `${count || "No"} design${count === 1 ? "" : "s"}`;

/** What there is to say of a search. @type {(search: Search) => string} */
function stateOf({ file, fits, running, failed, done }) {
    if (!file || (failed && !fits.length)) {
        return "";
    }
    if (running) {
        return fits.length ? `${counted(fits.length)} so far` : `Looking for tiles near to ${file.name}`;
    }
    if (done < 1 || failed) {
        return `Stopped: ${counted(fits.length).toLowerCase()} found`;
    }
    return fits.length
        ? `${counted(fits.length)}, the nearest first: a click takes one, and undo leads back`
        : "No tile came out in one piece: look in other groups";
}

/**
 * The dialog for an outline: `open` opens it, with a file to look for at once or without, and `isOpen` says that it is.
 * @param {object} context
 * @param {import("../store.js").Store} context.store
 * @param {(design: any) => void} context.begin takes a design
 * @param {(message: string) => void} context.say
 */
export function fitting({ store, begin, say }) {
    /** @type {Search} */
    let search = NONE;
    /** @type {HTMLDialogElement | null} */
    let box = null;
    /** Show what has changed. @type {(found?: {fit: Fit, place: number}) => void} */
    let show = () => {};
    /** @type {Fit | null} what is being taken */
    let taken = null;
    const options = { groups: "", mirrored: true, symmetric: false };

    const isOpen = () => Boolean(box?.open && box.isConnected);

    /** Look for designs, and give up what was looked for before. @param {File} file */
    const look = async (file) => {
        search.running?.abort();
        const stop = new AbortController();
        /** @type {Search} */
        const mine = { ...NONE, file, running: stop };
        search = mine;
        show();
        try {
            const { drop } = store.state.tables.limits;
            if (file.size > drop) {
                throw new Error(`${file.name} is larger than ${drop >> 20} MiB. Take the outline alone.`);
            }
            const asked = {
                name: file.name,
                groups: options.groups,
                mirrored: options.mirrored ? "yes" : "no",
                symmetric: options.symmetric ? "yes" : "no",
            };
            const more = { type: "application/octet-stream", signal: stop.signal };
            const answer = await post(`fits?${new URLSearchParams(asked)}`, file, more);
            await follow(/** @type {ReadableStream<Uint8Array>} */ (answer.body), mine);
        } catch (error) {
            mine.failed = stop.signal.aborted ? "" : error instanceof TypeError ? LOST : said(error);
        }
        mine.running = null;
        if (search === mine) {
            show();
        }
    };

    /** Take what a search says. @param {ReadableStream<Uint8Array>} stream @param {Search} mine */
    const follow = async (stream, mine) => {
        let ended = false;
        for await (const message of messagesOf(stream)) {
            if (message.type === "failed") {
                throw new Error(`${message.error.message} ${message.error.remedy}`);
            }
            const found = message.type === "fit" ? withFit(mine.fits, message) : null;
            mine.fits = found?.fits ?? mine.fits;
            mine.notes = message.type === "outline" ? message.notes : mine.notes;
            ended ||= message.type === "done";
            mine.done = ended ? 1 : (message.done ?? mine.done);
            if (search === mine) {
                show(found ? { fit: message, place: found.place } : undefined);
            }
        }
        if (!ended) {
            throw new Error(LOST);
        }
    };

    /** Take a design in the place of what is drawn. @param {Fit} fit */
    const take = async (fit) => {
        if (taken) {
            return; // a double click
        }
        taken = fit;
        let { design } = fit;
        const notes = [...fit.notes];
        if (fit.art) {
            try {
                const art = await (await post("fits/art", JSON.stringify({ number: fit.number }))).json();
                design = withArt(design, art);
                notes.unshift(`What else is drawn is its art, in ${art.file}: it is engraved with the tiles.`);
            } catch (error) {
                notes.unshift(`It comes without its art: ${said(error)}`);
            }
        }
        begin(design);
        taken = null;
        box?.close();
        if (notes.length) {
            say(notes.join(" "));
        }
    };

    /** @param {Fit} fit */
    const itemOf = (fit) => {
        const picture = make("img", { src: `data:image/svg+xml,${encodeURIComponent(fit.picture)}`, alt: "" });
        const nearness = `overlap ${fit.overlap.toFixed(3)}, within ${Number(fit.distance.toPrecision(2))} mm`;
        const figures = `: ${nearness}, ${fit.corners} corners${fit.symmetric ? ", symmetric" : ""}`;
        const name = make("span", {}, make("strong", {}, fit.group), figures);
        return make("li", {}, make("button", { onclick: () => void take(fit) }, picture, name));
    };

    return {
        isOpen,

        /** @param {File} [file] */
        open(file) {
            if (file && isOpen()) {
                void look(file);
                return;
            }
            const again = () => search.file && void look(search.file);
            const input = make("input", {
                type: "file",
                accept: ".svg,.svgz,.dxf",
                onchange: () => input.files[0] && void look(input.files[0]),
            });
            const groups = make("input", {
                type: "text",
                autocomplete: "off",
                spellcheck: "false",
                placeholder: "all",
                ".value": options.groups,
                onchange() {
                    options.groups = groups.value;
                    again();
                },
            });
            /** A box to tick for an option. @param {"mirrored" | "symmetric"} name */
            const tick = (name) => {
                const ticked = make("input", {
                    type: "checkbox",
                    ".checked": options[name],
                    onchange() {
                        options[name] = ticked.checked;
                        again();
                    },
                });
                return ticked;
            };
            const where = make(
                "details",
                { open: Boolean(options.groups) || !options.mirrored || options.symmetric },
                make("summary", {}, "Where to look"),
                field("Groups", groups, { help: "As p2, pgg; empty: all but those whose tile no stroke changes" }),
                field("Mirrored copies", tick("mirrored"), { help: "Without them for material with a good side" }),
                field("Symmetric tiles alone", tick("symmetric"), {
                    help: "Tiles that are their own mirror images, as the outline must be",
                }),
            );
            const progress = make("progress", { max: 1, "aria-label": "The search" });
            const state = make("p", { role: "status" });
            const notes = make("p", { class: "note" });
            const list = make("ul", { class: "gallery fits" });
            const act = button("", () => (search.running ? search.running.abort() : again()));
            /** @type {Search | null} */
            let listed = null;
            const shown = showDialog(
                "Tiles near to an outline",
                [
                    make("p", {}, MEANS),
                    field("File of the outline", input),
                    where,
                    make("div", { class: "search" }, progress, state, act),
                    notes,
                    list,
                ],
                [{ label: "Close" }],
            );
            box = shown.box;
            show = (found) => {
                progress.hidden = !search.running;
                progress.value = search.done;
                act.hidden = !search.file;
                act.textContent = search.running ? "Stop" : "Look again";
                const now = stateOf(search);
                if (state.textContent !== now) {
                    state.textContent = now; // again, it would be read again
                }
                shown.failed.textContent = inLabels(search.failed);
                notes.textContent = search.notes.join(" ");
                if (listed !== search) {
                    listed = search;
                    list.replaceChildren(...search.fits.map(itemOf));
                } else if (found) {
                    list.insertBefore(itemOf(found.fit), list.children[found.place] ?? null);
                }
            };
            shown.box.addEventListener("close", () => search.running?.abort());
            show();
            if (file) {
                void look(file);
            }
        },
    };
}

/**
 * Files that are dragged over the page are shown the place for outlines. A function that says whether a drop is in it.
 * @returns {(event: Event) => boolean}
 */
export function outlinePlace() {
    const place = byId("outline-place");
    const isIn = (/** @type {Event} */ event) => event.target instanceof Node && place.contains(event.target);
    let timer = 0;
    const hide = () => {
        place.hidden = true;
    };
    document.addEventListener("dragover", (event) => {
        place.hidden = !event.dataTransfer?.types.includes("Files");
        place.classList.toggle("over", isIn(event));
        clearTimeout(timer);
        timer = window.setTimeout(hide, GONE_MS);
    });
    document.addEventListener("drop", hide);
    return isIn;
}
