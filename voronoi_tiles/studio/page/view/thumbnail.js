// @ts-check
/** A design as a small picture: its exact tiles, about two cells of them. */

import { cellArea } from "../model/lattice.js";
import { latticeOf, motionsOf } from "../model/symmetry.js";
import { Camera } from "./camera.js";
import { drawOutlines } from "./outlines.js";

/** How many cells' widths there are across. */
const CELLS = 1.7;

/**
 * @param {HTMLCanvasElement} canvas Square.
 * @param {import("../model/design.js").Design} design
 * @param {import("./outlines.js").Tile[]} tiles As the server has computed them of it.
 * @param {import("../model/symmetry.js").Tables} tables
 * @param {{side: number, dark: boolean}} looks The side in CSS pixels.
 */
export function drawThumbnail(canvas, design, tiles, tables, { side, dark }) {
    const lattice = latticeOf(design, tables);
    const camera = new Camera();
    Object.assign(camera, { size: [side, side], ratio: devicePixelRatio });
    const across = CELLS * Math.sqrt(cellArea(lattice));
    camera.fit([0, 0, across, across], 1);
    canvas.width = canvas.height = side * camera.ratio;
    // Drawn by the processor: a surface of the graphics processor for each of so many small pictures costs more.
    const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { willReadFrequently: true }));
    const style = { scale: design.scale ?? 1, fill: true, dark, line: side / 100 };
    drawOutlines(context, camera, lattice, motionsOf(design, tables), tiles, style);
}
