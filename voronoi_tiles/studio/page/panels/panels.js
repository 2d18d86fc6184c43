// @ts-check
// The panels beside the drawing, as custom elements, and what they are given.

import { StrokePanel } from "./strokes.js";
import { SymmetryPanel } from "./symmetry.js";
import { JobPanel } from "./job.js";
import { ReportPanel } from "./report.js";
import { SolidPanel } from "./solid.js";

/**
 * @typedef {object} Context what panels work with
 * @property {import("../store.js").Store} store
 * @property {import("../link.js").Link} link
 * @property {import("../view/stage.js").Stage} stage
 * @property {(command: string) => void} run
 * @property {(name: "drawing" | "symmetry" | "job" | "report" | "solid") => void} openTab
 */

/** @type {[string, new () => HTMLElement & {connect: (context: Context) => void}][]} */
const PANELS = [
    ["stroke-panel", StrokePanel],
    ["symmetry-panel", SymmetryPanel],
    ["job-panel", JobPanel],
    ["report-panel", ReportPanel],
    ["solid-panel", SolidPanel],
];

/** @param {Context} context */
export function connectPanels(context) {
    for (const [name, panel] of PANELS) {
        customElements.define(name, panel);
        for (const element of document.querySelectorAll(name)) {
            /** @type {InstanceType<typeof panel>} */ (element).connect(context);
        }
    }
}
