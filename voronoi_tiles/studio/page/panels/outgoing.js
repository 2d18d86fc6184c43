// @ts-check
// What leaves the page: exported files, the test piece, links, and the design's own file.

import { linkOf } from "../sharing.js";
import { showDialog } from "./dialog.js";
import { field, make } from "./elements.js";
import { download, nameOf, post } from "./exchange.js";

/** A choice among formats of files. @param {string[]} formats */
const formatField = (formats) =>
    make(
        "select",
        {},
        ...formats.map((one) => make("option", { value: one }, one === "lbrn2" ? "LightBurn (lbrn2)" : one)),
    );

/**
 * The dialogs for what leaves the page, each a function that opens it.
 * @param {Pick<import("./panels.js").Context, "store">} context
 */
export function outgoing({ store }) {
    const cancel = { label: "Cancel" };

    /** @param {string} path @param {object} asked @param {string} name @param {AbortSignal} [signal] gives it up */
    const fetched = async (path, asked, name, signal) => {
        const answer = await post(path, JSON.stringify(asked), { signal });
        download(await answer.blob(), nameOf(answer, name));
    };

    const saveAs = () => fetched("toml", { design: store.settled }, store.state.file || "design.toml");

    return {
        saveAs,

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
            const format = formatField(tables.formats);
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
            const options = Object.entries(job).map(
                ([key, value]) => `${key} ${Array.isArray(value) ? value.join(" x ") : value}`,
            );
            const what = options.join(", ") || "no options: the exact tiles, one of each";
            /** @param {AbortSignal} signal */
            const run = (signal) => {
                const asked = {
                    design: store.settled,
                    job: { ...store.state.job, format: format.value },
                    name: name.value,
                };
                return fetched("export", asked, `${name.value}.${format.value}`, signal);
            };
            showDialog(
                "Export",
                [
                    field("Format", format),
                    field("Name", name),
                    make("p", { class: "note" }, `The job: ${what}.`),
                    bounds,
                ],
                [{ label: "Download", first: true, run }, cancel],
            );
        },

        solid() {
            const { tables, solidJob, file } = store.state;
            const stem = file.replace(/\.[^.]*$/, "") || "tiles";
            const name = make("input", { type: "text", ".value": stem, autocomplete: "off" });
            const format = formatField(tables.solids);
            /** @param {AbortSignal} signal */
            const run = (signal) => {
                const job = { ...solidJob, format: format.value };
                const asked = { design: store.settled, job, name: name.value };
                return fetched("solid", asked, `${name.value}.${format.value}`, signal);
            };
            const means = "3mf: an object for each piece, in its colour. stl: all in one. png: a picture.";
            showDialog(
                "Download the solids",
                [field("Format", format, { help: means }), field("Name", name)],
                [{ label: "Download", first: true, run }, cancel],
            );
        },

        coupon() {
            const { tables, job } = store.state;
            const thickness = make("input", { type: "text", ".value": "3mm" });
            const format = formatField(tables.coupon);
            /** @param {AbortSignal} signal */
            const run = (signal) => {
                const { preset, feed, power } = job;
                const asked = { thickness: thickness.value, format: format.value, preset, feed, power };
                return fetched("coupon", asked, `coupon.${format.value}`, signal);
            };
            showDialog(
                "A test piece that shows the kerf",
                [
                    make(
                        "p",
                        {},
                        "Cut it once in your material: which plug just holds in its hole says how wide your laser cuts.",
                    ),
                    field("Thickness of the material", thickness),
                    field("Format", format, { help: "Preset, feed and power are those of the job." }),
                ],
                [{ label: "Download", first: true, run }, cancel],
            );
        },

        share() {
            const address = make("textarea", {
                readonly: true,
                rows: 4,
                "aria-label": "Link",
                ".value": linkOf(store.settled),
            });
            const means =
                "The link holds the whole design after its #, which browsers do not send. In another studio it opens under Open, or pasted onto the drawing; the file suits everybody.";
            showDialog(
                "Share",
                [make("p", {}, means), address],
                [
                    { label: "Copy the link", first: true, run: () => navigator.clipboard.writeText(address.value) },
                    { label: "Download the file", run: saveAs },
                    { label: "Close" },
                ],
            );
            address.select();
        },
    };
}
