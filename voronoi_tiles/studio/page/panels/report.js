// @ts-check
// What the job comes to, and what preflight finds: each finding with its place on the sheet.

import { shown } from "../model/lengths.js";
import { Kept } from "../model/kept.js";
import { button, figures, inLabels, make, refill } from "./elements.js";

/** @import { Context } from "./panels.js" */
/** @import { State } from "../store.js" */
/** @typedef {import("../link.js").Product["findings"][number]} Finding */

/** @param {number} seconds */
const duration = (seconds) => {
    const whole = Math.round(seconds);
    return whole < 60 ? `${whole} s` : `${Math.floor(whole / 60)} min ${String(whole % 60).padStart(2, "0")} s`;
};

export class ReportPanel extends HTMLElement {
    /** @type {Context} */
    // @ts-expect-error set by connect, before anything else
    #context;
    /** @type {Kept<void>} what is shown */
    #filled = new Kept();

    /** @param {Context} context */
    connect(context) {
        this.#context = context;
        context.store.subscribe(
            ["product", "jobRefusal", "refusal", "unit", "tables", "revision", "jobPending"],
            (state) => this.#fill(state),
            { calm: true },
        );
    }

    /** @param {State} state */
    #fill({ product, jobRefusal, refusal, unit, tables, revision, jobPending }) {
        if (!tables) {
            return;
        }
        const bad = refusal?.error ?? jobRefusal?.error ?? null;
        const isOld = product !== null && (product.rev < revision || jobPending);
        this.#filled.get([bad, product, isOld, unit, tables], () => this.#show(bad, product, isOld, unit, tables));
    }

    /**
     * @param {import("../link.js").Refusal["error"] | null} bad
     * @param {State["product"]} product
     * @param {boolean} isOld
     * @param {State["unit"]} unit
     * @param {any} tables
     */
    #show(bad, product, isOld, unit, tables) {
        if (bad || !product) {
            refill(this, [
                bad
                    ? make("p", { class: "error", role: "alert" }, inLabels(`${bad.message} ${bad.remedy}`))
                    : make("p", { class: "note" }, "The report comes in a moment."),
            ]);
            return;
        }
        const { report, findings, notes } = product;
        const mm = tables.units[unit];
        const length = (/** @type {number} */ size) => `${shown(size / mm, unit)} ${unit}`;
        const metres = (/** @type {number} */ size) => `${(size / 1000).toFixed(2)} m`;
        const rows = [
            ["Size", `${length(report.page.width)} x ${length(report.page.height)}`],
            [
                "Pieces",
                `${report.pieces.count}${report.pieces.whole === report.pieces.count ? "" : `, ${report.pieces.whole} whole`}`,
            ],
            ["Used", `${(100 * report.use.share).toFixed(1)} %`],
            [
                "Cut",
                `${metres(report.cut.length)}, ${report.cut.pierces} ${report.cut.pierces === 1 ? "pierce" : "pierces"}`,
            ],
            ["Travel", metres(report.cut.travel)],
            ["Time", duration(report.time)],
        ];
        refill(this, [
            make("h2", {}, "Report"),
            figures(rows, isOld),
            make(
                "p",
                { class: "note" },
                `At ${report.speeds.cut} mm/s to cut, ${report.speeds.travel} to travel, ${report.speeds.pierce} s a pierce.`,
            ),
            make(
                "h2",
                {},
                product.found
                    ? `Preflight: ${product.found} ${product.found === 1 ? "finding" : "findings"}`
                    : "Preflight",
            ),
            product.found
                ? make("ol", {}, ...alike(findings).map((same, k) => this.#finding(same, k)))
                : make("p", {}, "Nothing would spoil the cut."),
            ...notes.map((note) => make("p", { class: "note" }, inLabels(note))),
        ]);
    }

    /**
     * One line for findings of a kind, whose places are shown one after the other.
     * @param {Finding[]} same
     * @param {number} k
     */
    #finding(same, k) {
        const { severity, message } = same[0];
        const places = same.map(({ at }) => at).filter((at) => at !== null);
        let next = 0;
        const show = () => {
            document.dispatchEvent(new CustomEvent("studio-finding", { detail: places[next] }));
            next = (next + 1) % places.length;
        };
        return make(
            "li",
            { class: `finding ${severity}` },
            make("strong", {}, severity),
            make("span", {}, same.length > 1 ? `${message} And ${same.length - 1} more of this kind.` : message),
            places.length > 0 &&
                button(places.length > 1 ? "Show next" : "Show", show, { class: "quiet", "data-key": `finding ${k}` }),
        );
    }
}

/**
 * Findings by their severity and kind, in the order in which they come.
 * @type {(findings: Finding[]) => Finding[][]}
 */
function alike(findings) {
    /** @type {Map<string, Finding[]>} */
    const groups = new Map();
    for (const finding of findings) {
        const key = `${finding.severity} ${finding.kind}`;
        groups.set(key, [...(groups.get(key) ?? []), finding]);
    }
    return [...groups.values()];
}
