// @ts-check
/** The exact outlines of all copies in the window, by Path2D; filled they are the picture where WebGL2 is missing. */

import { colourAt, coloursOf, inks, tileColour } from "../gl/colours.js";
import { reducedBasis } from "../gl/pattern.js";
import { cartesian, cellArea, fractional } from "../model/lattice.js";
import { Kept } from "../model/kept.js";
import { pathCubics } from "../model/pathdata.js";
import { apply, minus, plus } from "../model/plane.js";
import { boxOf } from "../model/segments.js";
import { roundedScale, screenPath } from "./paths.js";

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

/** @typedef {{path: Path2D, scale: number, centre: Point, radius: number}} Shape A path for a scale, and a circle about it. */

/** @typedef {{count: number, parts: Map<number, Path2D>, all: Path2D}} Copies Of each colour, and together; CSS pixels. */

/** The outlines of one canvas: while strokes move under them, their paths stay. */
export class Outlines {
    /** @type {Map<string, Shape>} Of the paths that were drawn last. */
    #shapes = new Map();
    /** @type {Kept<Copies | null>} */
    #copies = new Kept();

    /**
     * The copies of tiles that meet the window; null where they are too many, and where there is no cell.
     * @param {Camera} camera
     * @param {Lattice} lattice
     * @param {readonly Motion[]} motions
     * @param {readonly Tile[]} tiles In the order of the sites.
     * @param {Style} [style]
     * @returns {Copies | null}
     */
    copies(camera, lattice, motions, tiles, { scale = 1, line = 1.5, fill = null } = {}) {
        const causes = [lattice, motions, tiles, scale, line, fill, camera.scale, ...camera.centre, ...camera.size];
        return this.#copies.get(causes, () => {
            const basis = reducedBasis(lattice);
            return basis && this.#placed(basis, camera, motions, tiles, { scale, line, fill });
        });
    }

    /**
     * @param {import("../gl/pattern.js").Basis} basis
     * @param {Camera} camera
     * @param {readonly Motion[]} motions
     * @param {readonly Tile[]} tiles
     * @param {{scale: number, line: number, fill: Style["fill"]}} style
     * @returns {Copies | null}
     */
    #placed(basis, camera, motions, tiles, { scale, line, fill }) {
        const finest = roundedScale(camera.scale) / scale;
        this.#shapes = new Map(
            tiles.map(({ path }) => {
                const shape = this.#shapes.get(path);
                return [path, shape?.scale === finest ? shape : shapeOf(path, finest)];
            }),
        );
        const placements = tiles.flatMap(({ path, operations }) =>
            operations.map((k) => ({ path, motion: motions[k] })),
        );
        const colours = coloursOf(typeof fill === "object" ? fill : null, placements.length, basis.rows);
        const [width, height] = camera.size;
        const k = camera.scale / scale;
        /** @type {Copies} */
        const copies = { count: 0, parts: new Map(), all: new Path2D() };
        for (const [placement, { path, motion }] of placements.entries()) {
            const { path: shape, centre, radius } = /** @type {Shape} */ (this.#shapes.get(path));
            const { a, b, conj } = motion;
            const sign = conj ? -1 : 1;
            const middle = apply(motion, [centre[0] / scale, centre[1] / scale]);
            for (const [i, j] of near(basis, camera, middle, radius / scale + line / camera.scale)) {
                if (copies.count++ === MOST) return null;
                const colour = fill ? colourAt(colours, placement, i, j) : -1;
                const part = copies.parts.get(colour) ?? new Path2D();
                copies.parts.set(colour, part);
                const [x, y] = minus(plus(b, cartesian({ a: basis.p, b: basis.q }, [i, j])), camera.centre);
                const [e, f] = [width / 2 + camera.scale * x, height / 2 - camera.scale * y];
                // To CSS pixels, y down.
                part.addPath(shape, new DOMMatrix([k * a[0], -k * a[1], -k * sign * a[1], -k * sign * a[0], e, f]));
            }
        }
        for (const part of copies.parts.values()) copies.all.addPath(part);
        return copies;
    }
}

/**
 * Fill the window with the colours of copies, all of which cover it: that of one is everywhere where no other is. The
 * context's transform and styles are as before.
 * @param {CanvasRenderingContext2D} context
 * @param {Camera} camera
 * @param {Copies} copies
 * @param {Style} style
 */
export function fillCopies(context, { ratio, size }, { parts }, { dark = false }) {
    context.save();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    for (const [k, [colour, part]] of [...parts].entries()) {
        context.fillStyle = css(tileColour(colour, dark));
        if (k) context.fill(part, "evenodd");
        else context.fillRect(0, 0, ...size);
    }
    context.restore();
}

/**
 * Draw the lines of copies. The context's transform and styles are as before.
 * @param {CanvasRenderingContext2D} context
 * @param {Camera} camera
 * @param {Copies} copies
 * @param {Style} style
 */
export function strokeCopies(context, { ratio }, { all }, style) {
    const { line = 1.5, dash = [], opacity = 1, dark = false, colour = css(inks(dark).border) } = style;
    context.save();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.lineWidth = line;
    context.lineJoin = "round";
    context.setLineDash(dash);
    context.globalAlpha = opacity;
    context.strokeStyle = colour;
    // In one stroke: lines that two copies share are not darker than others.
    context.stroke(all);
    context.restore();
}

/**
 * Draw the copies of tiles that meet the window, once.
 * @param {CanvasRenderingContext2D} context
 * @param {Camera} camera
 * @param {Lattice} lattice
 * @param {readonly Motion[]} motions
 * @param {readonly Tile[]} tiles In the order of the sites.
 * @param {Style} [style]
 * @returns {number} How many copies were drawn; 0 also where they are too many.
 */
export function drawOutlines(context, camera, lattice, motions, tiles, style = {}) {
    const copies = new Outlines().copies(camera, lattice, motions, tiles, style);
    if (copies && style.fill) fillCopies(context, camera, copies, style);
    if (copies && style.line !== 0) strokeCopies(context, camera, copies, style);
    return copies?.count ?? 0;
}

/**
 * The cells by which a circle is moved into the window.
 * @param {import("../gl/pattern.js").Basis} basis
 * @param {Camera} camera
 * @param {Point} middle
 * @param {number} radius
 * @returns {Generator<Point>}
 */
export function* near({ p, q }, { centre, scale, size }, middle, radius) {
    const [across, up] = [size[0] / scale / 2 + radius, size[1] / scale / 2 + radius];
    const lattice = { a: p, b: q };
    const away = minus(centre, middle);
    const [s, t] = fractional(lattice, away);
    const det = cellArea(lattice);
    const wide = (across * Math.abs(q[1]) + up * Math.abs(q[0])) / det;
    const high = (across * Math.abs(p[1]) + up * Math.abs(p[0])) / det;
    for (let i = Math.ceil(s - wide); i <= s + wide; i++) {
        for (let j = Math.ceil(t - high); j <= t + high; j++) {
            const [dx, dy] = minus(cartesian(lattice, [i, j]), away);
            if (Math.abs(dx) <= across && Math.abs(dy) <= up) yield [i, j];
        }
    }
}

/**
 * @param {string} data
 * @param {number} scale
 * @returns {Shape}
 */
function shapeOf(data, scale) {
    const cubics = pathCubics(data);
    const [x0, y0, x1, y1] = boxOf(cubics);
    /** @type {Point} */
    const centre = [(x0 + x1) / 2, (y0 + y1) / 2];
    return {
        path: screenPath(Float64Array.from(cubics), scale),
        scale,
        centre,
        radius: Math.hypot(x1 - x0, y1 - y0) / 2,
    };
}

/**
 * A colour as CSS writes it.
 * @param {import("../gl/colours.js").Colour} colour
 */
function css(colour) {
    return `rgb(${colour.map((part) => Math.round(255 * part)).join(" ")})`;
}
