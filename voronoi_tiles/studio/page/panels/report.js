// @ts-check
// What the job comes to, and what preflight finds: each finding with its place on the sheet.

import { shown } from "../model/lengths.js";
import { make, refill } from "./elements.js";

/**
 * @typedef {import("./panels.js").Context} Context
 * @typedef {import("../store.js").State} State
 */

/** @param {number} seconds */
const duration = (seconds) => {
  const whole = Math.round(seconds);
  return whole < 60 ? `${whole} s` : `${Math.floor(whole / 60)} min ${String(whole % 60).padStart(2, "0")} s`;
};

export class ReportPanel extends HTMLElement {
  /** @type {Context} */
  // @ts-expect-error set by connect, before anything else
  #context;

  /** @param {Context} context */
  connect(context) {
    this.#context = context;
    context.store.subscribe(["product", "jobRefusal", "refusal", "unit", "tables", "revision"], (state) => this.#fill(state));
  }

  /** @param {State} state */
  #fill({ product, jobRefusal, refusal, unit, tables, revision }) {
    if (!tables) {
      return;
    }
    const bad = refusal?.error ?? jobRefusal?.error;
    if (bad || !product) {
      refill(this, [bad ? make("p", { class: "error", role: "alert" }, `${bad.message}. ${bad.remedy}`) : make("p", { class: "note" }, "The report comes in a moment.")]);
      return;
    }
    const { report, findings, notes } = product;
    const mm = tables.units[unit];
    const length = (/** @type {number} */ size) => `${shown(size / mm, unit)} ${unit}`;
    const metres = (/** @type {number} */ size) => `${(size / 1000).toFixed(2)} m`;
    const rows = [
      ["Size", `${length(report.page.width)} x ${length(report.page.height)}`],
      ["Pieces", `${report.pieces.count}${report.pieces.whole === report.pieces.count ? "" : `, ${report.pieces.whole} whole`}`],
      ["Used", `${(100 * report.use.share).toFixed(1)} %`],
      ["Cut", `${metres(report.cut.length)}, ${report.cut.pierces} pierces`],
      ["Travel", metres(report.cut.travel)],
      ["Time", duration(report.time)],
    ];
    refill(this, [
      make("h2", {}, "Report"),
      make("dl", { class: product.rev < revision ? "figures old" : "figures" }, ...rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)])),
      make("p", { class: "note" }, `At ${report.speeds.cut} mm/s to cut, ${report.speeds.travel} to travel, ${report.speeds.pierce} s a pierce.`),
      make("h2", {}, findings.length ? `Preflight: ${findings.length} ${findings.length === 1 ? "finding" : "findings"}` : "Preflight"),
      findings.length ? make("ol", {}, ...findings.map((finding, k) => this.#finding(finding, k))) : make("p", {}, "Nothing would spoil the cut."),
      ...notes.map((note) => make("p", { class: "note" }, note)),
    ]);
  }

  /**
   * @param {import("../link.js").Product["findings"][number]} finding
   * @param {number} k
   */
  #finding({ severity, message, at }, k) {
    return make(
      "li",
      { class: `finding ${severity}` },
      make("strong", {}, severity),
      make("span", {}, message),
      at && make("button", { type: "button", class: "quiet", "data-key": `finding ${k}`, onclick: () => document.dispatchEvent(new CustomEvent("studio-finding", { detail: at })) }, "Show"),
    );
  }
}
