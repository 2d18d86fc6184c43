// @ts-check
/** The exact outlines of all copies in the window, by Path2D; filled they are the picture where WebGL2 is missing. */

import { colourAt, coloursOf, inks, tileColour } from "../gl/colours.js";
import { reducedBasis } from "../gl/pattern.js";

/** @typedef {import("../gl/colours.js").Colouring} Colouring */
/** @typedef {import("../gl/pattern.js").Lattice} Lattice */
/** @typedef {import("../gl/pattern.js").Motion} Motion */
/** @typedef {import("../gl/pattern.js").Point} Point */
/** @typedef {{path: string, operations: readonly number[]}} Tile Path data; the motions that take it to its copies. */
/** @typedef {{centre: Point, scale: number, size: Point, ratio: number}} Camera */
/**
 * @typedef {object} Style
 * @property {number} [scale] What the tiles' paths are larger by than the drawing.
 * @property {number} [line] Width in CSS pixels, 0 for none; 1.5 where nothing is said.
 * @property {string} [colour] Of the line.
 * @property {number[]} [dash] CSS pixels.
 * @property {number} [opacity] Of the line.
 * @property {Colouring | boolean | null} [fill] Fill the tiles: true for colours by site and motion.
 * @property {boolean} [dark]
 */

/** Most copies that are drawn: of more one could see nothing but lines. */
const MOST = 6000;

/** @typedef {{path: Path2D, centre: Point, radius: number}} Shape A path, and a circle about it. */

/** @type {Map<string, Shape>} Of the paths that were drawn last. */
let known = new Map();

/**
 * Draw the copies of tiles that meet the window. The context's transform and styles are as before.
 * @param {CanvasRenderingContext2D} context
 * @param {Camera} camera
 * @param {Lattice} lattice
 * @param {readonly Motion[]} motions
 * @param {readonly Tile[]} tiles In the order of the sites.
 * @param {Style} [style]
 * @returns {number} How many copies were drawn; 0 also where they are too many.
 */
export function drawOutlines(context, camera, lattice, motions, tiles, style = {}) {
    const basis = reducedBasis(lattice);
    if (!basis) return 0;
    const { scale = 1, line = 1.5, dash = [], opacity = 1, fill = null, dark = false } = style;
    const shapes = new Map(tiles.map(({ path }) => [path, known.get(path) ?? shapeOf(path)]));
    known = shapes;
    const placements = tiles.flatMap(({ path, operations }) => operations.map((k) => ({ path, motion: motions[k] })));
    const colours = coloursOf(typeof fill === "object" ? fill : null, placements.length, basis.rows);
    const [width, height] = camera.size;
    /** @type {{shape: Path2D, matrix: DOMMatrix, colour: number}[]} */
    const copies = [];
    for (const [placement, { path, motion }] of placements.entries()) {
        const { path: shape, centre, radius } = /** @type {Shape} */ (shapes.get(path));
        const { a, b, conj } = motion;
        const sign = conj ? -1 : 1;
        const [x, y] = [centre[0] / scale, (sign * centre[1]) / scale];
        const middle = [a[0] * x - a[1] * y + b[0], a[0] * y + a[1] * x + b[1]];
        for (const [i, j] of near(basis, camera, [middle[0], middle[1]], radius / scale + line / camera.scale)) {
            if (copies.length === MOST) return 0;
            const shift = [b[0] + i * basis.p[0] + j * basis.q[0], b[1] + i * basis.p[1] + j * basis.q[1]];
            const k = camera.scale / scale;
            copies.push({
                shape,
                // To CSS pixels, y down.
                matrix: new DOMMatrix([
                    k * a[0],
                    -k * a[1],
                    -k * sign * a[1],
                    -k * sign * a[0],
                    width / 2 + camera.scale * (shift[0] - camera.centre[0]),
                    height / 2 - camera.scale * (shift[1] - camera.centre[1]),
                ]),
                colour: fill ? colourAt(colours, placement, i, j) : -1,
            });
        }
    }
    context.save();
    const ratio = new DOMMatrix([camera.ratio, 0, 0, camera.ratio, 0, 0]);
    if (fill) {
        for (const { shape, matrix, colour } of copies) {
            context.setTransform(ratio.multiply(matrix));
            context.fillStyle = css(tileColour(colour, dark));
            context.fill(shape, "evenodd");
        }
    }
    if (line > 0) {
        // In one stroke: lines that two copies share are not darker than others.
        const all = new Path2D();
        for (const { shape, matrix } of copies) all.addPath(shape, matrix);
        context.setTransform(ratio);
        context.lineWidth = line;
        context.lineJoin = "round";
        context.setLineDash(dash);
        context.globalAlpha = opacity;
        context.strokeStyle = style.colour ?? css(inks(dark).border);
        context.stroke(all);
    }
    context.restore();
    return copies.length;
}

/**
 * The cells by which a circle is moved into the window.
 * @param {import("../gl/pattern.js").Basis} basis
 * @param {Camera} camera
 * @param {Point} middle
 * @param {number} radius
 * @returns {Generator<Point>}
 */
function* near({ p, q }, { centre, scale, size }, middle, radius) {
    const [across, up] = [size[0] / scale / 2 + radius, size[1] / scale / 2 + radius];
    const [x, y] = [centre[0] - middle[0], centre[1] - middle[1]];
    const det = p[0] * q[1] - p[1] * q[0];
    const [s, t] = [(x * q[1] - y * q[0]) / det, (p[0] * y - p[1] * x) / det];
    const wide = (across * Math.abs(q[1]) + up * Math.abs(q[0])) / det;
    const high = (across * Math.abs(p[1]) + up * Math.abs(p[0])) / det;
    for (let i = Math.ceil(s - wide); i <= s + wide; i++) {
        for (let j = Math.ceil(t - high); j <= t + high; j++) {
            const [dx, dy] = [i * p[0] + j * q[0] - x, i * p[1] + j * q[1] - y];
            if (Math.abs(dx) <= across && Math.abs(dy) <= up) yield [i, j];
        }
    }
}

/**
 * @param {string} data
 * @returns {Shape}
 */
function shapeOf(data) {
    const [x0, y0, x1, y1] = boxOf(data);
    /** @type {Point} */
    const centre = [(x0 + x1) / 2, (y0 + y1) / 2];
    return { path: new Path2D(data), centre, radius: Math.hypot(x1 - x0, y1 - y0) / 2 };
}

/** How many numbers follow each command of path data, those in capitals, that count from the origin. */
const NUMBERS = /** @type {Record<string, number>} */ ({ M: 2, L: 2, H: 1, V: 1, C: 6, S: 4, Q: 4, T: 2, A: 7, Z: 0 });

/**
 * A box about path data of absolute commands: that of all their points, larger by the radii of arcs.
 * @param {string} data Throws a SyntaxError for commands in small letters.
 * @returns {[number, number, number, number]}
 */
export function boxOf(data) {
    let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
    let room = 0;
    for (const [, command, rest] of data.matchAll(/([A-DF-Za-df-z])([^A-DF-Za-df-z]*)/g)) {
        const size = NUMBERS[command];
        if (size === undefined) throw new SyntaxError(`path data with "${command}": only absolute commands are drawn`);
        const numbers = (rest.match(/[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?/gi) ?? []).map(Number);
        for (let k = 0; k + size <= numbers.length && size > 0; k += size) {
            const part = numbers.slice(k, k + size);
            if (command === "A") room = Math.max(room, 2 * part[0], 2 * part[1]);
            const points = command === "A" ? part.slice(5) : part;
            points.forEach((value, n) => {
                const upward = command === "V" || (command !== "H" && n % 2);
                if (upward) [y0, y1] = [Math.min(y0, value), Math.max(y1, value)];
                else [x0, x1] = [Math.min(x0, value), Math.max(x1, value)];
            });
        }
    }
    return [x0 - room, y0 - room, x1 + room, y1 + room];
}

/**
 * A colour as CSS writes it.
 * @param {import("../gl/colours.js").Colour} colour
 */
function css(colour) {
    return `rgb(${colour.map((part) => Math.round(255 * part)).join(" ")})`;
}
