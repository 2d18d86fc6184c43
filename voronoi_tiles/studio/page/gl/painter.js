// @ts-check
/**
 * What the preview draws, for one life of a WebGL2 context.
 *
 * Quickly: the image of one cell, coloured to one period of the colouring, tiles the window. A cell that is larger than
 * the window is not drawn, but the window itself. Exactly: the window, sample by sample.
 */

import { coloursOf, inks, modulo, tileColour } from "./colours.js";
import { Kept } from "../model/kept.js";
import { BlockLists, CellLists, blockRadius } from "./lists.js";
import { Pattern, reducedBasis } from "./pattern.js";
import { fragmentShaders } from "./shaders.js";
import { Program, RenderTarget, Table } from "./texture.js";

/** @typedef {import("./colours.js").Colour} Colour */
/** @typedef {import("./colours.js").Colouring} Colouring */
/** @typedef {import("./lists.js").Frame} Frame */
/** @typedef {import("./pattern.js").Lattice} Lattice */
/** @typedef {import("./pattern.js").Motion} Motion */
/** @typedef {import("./pattern.js").Point} Point */
/** @typedef {import("./pattern.js").Site} Site */
/** @typedef {import("./shaders.js").ShaderName} ShaderName */
/**
 * @typedef {object} Camera
 * @property {Point} centre The middle of the window.
 * @property {number} scale CSS pixels for each unit.
 * @property {Point} size CSS pixels.
 * @property {number} ratio Device pixels for each CSS pixel.
 * @property {Point} [pixels] Device pixels, where they are known; else size times ratio, rounded.
 */
/**
 * @typedef {object} Style Widths in CSS pixels, 0 for none.
 * @property {boolean} [dark]
 * @property {number} [border] 1.5 where nothing is said.
 * @property {Colour} [borderColour]
 * @property {number} [strokes] 0 where nothing is said.
 * @property {Colour} [strokeColour]
 * @property {number} [strokeOpacity] 0.4 where nothing is said.
 */
/**
 * @typedef {object} Scene What is drawn. What is the same object as last time is taken as unchanged.
 * @property {Lattice} lattice
 * @property {Motion[]} motions
 * @property {Site[]} sites
 * @property {Camera} camera
 * @property {Colouring | null} [colouring]
 * @property {Style} [style]
 */
/**
 * @typedef {object} View The grid of pixels that is drawn.
 * @property {number} width
 * @property {number} height
 * @property {Point} corner The lower left corner of the window.
 * @property {Point} step The width and height of a pixel, in units.
 * @property {number} perCss Pixels for each CSS pixel.
 */
/** @typedef {{width: number, height: number, labels: Int32Array}} Labels Of each pixel, the lowest row first. */

/** Samples along the side of a block of the window, and most blocks: larger windows have larger blocks. */
const BLOCK = 16;
const BLOCKS_MAX = 8000;
/** Texels along the side of a block of a cell. */
const CELL_BLOCK = 5;
/** Texels of a small cell along the geometric mean of its sides, at least; it is reduced by mipmaps. */
const TEXELS_MIN = 64;
/** Longest side of the image of a cell or period; texels. */
const TEXELS_MAX = 4096;
/** A cell whose shorter side has fewer pixels is tiled also where it is to be exact: it is no larger than a block. */
const EXACT_FROM = 32;
/** What is measured beside borders at least, so that touching copies are found; pixels. */
const BAND_MIN = 0.1;

/** The tables of block lists, and the copies that they name. */
class ListTables {
    /** @param {WebGL2RenderingContext} gl */
    constructor(gl) {
        this.blocks = new Table(gl, "integers");
        this.runs = new Table(gl, "integers");
        this.elements = new Table(gl, "floats");
        this.copies = new Table(gl, "integers");
        this.columns = 0;
        /** Placement, i, j of each copy. */
        this.names = new Int32Array(0);
    }

    /**
     * @param {BlockLists} lists
     * @param {CellLists} cell
     */
    write(lists, cell) {
        this.blocks.write(lists.blocks, lists.counts.blocks);
        this.runs.write(lists.runs, lists.counts.runs);
        this.elements.write(lists.elements, lists.counts.elements);
        this.columns = lists.columns;
        this.names = Int32Array.from(cell.elements.copies);
        const count = this.names.length / 3;
        const records = new Int32Array(4 * count);
        for (let k = 0; k < count; k++) records.set(this.names.subarray(3 * k, 3 * k + 3), 4 * k);
        this.copies.write(records, count);
    }
}

export class Painter {
    #gl;
    #shaders;
    /** @type {Map<ShaderName, Program>} */
    #programs = new Map();
    #lists = new BlockLists();
    #cellTables;
    #windowTables;
    #cellImage;
    #periodImage;
    #colourTable;
    /** @type {Kept<Pattern | null>} */
    #pattern = new Kept();
    /** @type {Kept<ReturnType<typeof coloursOf>>} */
    #colours = new Kept();
    /** @type {Kept<CellLists>} */
    #windowCell = new Kept();
    /** @type {Kept<object>} */
    #cellDrawn = new Kept();
    /** @type {Kept<void>} */
    #periodDrawn = new Kept();

    /**
     * Throws an Error where the shaders do not compile.
     * @param {WebGL2RenderingContext} gl
     * @param {string} exact The text of exact.glsl.
     */
    constructor(gl, exact) {
        this.#gl = gl;
        this.#shaders = fragmentShaders(exact);
        for (const name of /** @type {ShaderName[]} */ (["look", "exact", "colour", "tile"])) this.#program(name);
        this.#cellTables = new ListTables(gl);
        this.#windowTables = new ListTables(gl);
        this.#cellImage = new RenderTarget(gl, "integers");
        this.#periodImage = new RenderTarget(gl, "colours");
        this.#colourTable = new Table(gl, "bytes");
    }

    /**
     * Draw a scene into the canvas, which gets its size. Throws a RangeError where too many strokes lie about a cell.
     * @param {Scene} scene
     * @param {number} coarse Device pixels along the side of a pixel that is drawn.
     * @param {boolean} exactly
     */
    paint(scene, coarse, exactly) {
        const view = viewOf(scene.camera, coarse);
        const { canvas } = this.#gl;
        if (canvas.width !== view.width) canvas.width = view.width;
        if (canvas.height !== view.height) canvas.height = view.height;
        const pattern = this.#patternOf(scene);
        if (!pattern) {
            this.clear(scene);
            return;
        }
        const [across, up] = cellSize(pattern, view);
        const direct = exactly ? across >= EXACT_FROM : across * up > view.width * view.height;
        if (direct) this.#paintWindow(scene, pattern, view);
        else this.#paintTiled(scene, pattern, view);
    }

    /**
     * Draw a scene's background alone.
     * @param {Scene} scene
     */
    clear({ style }) {
        const gl = this.#gl;
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.clearColor(...inks(style?.dark ?? false).background, 1);
        gl.clear(gl.COLOR_BUFFER_BIT);
    }

    /**
     * Who owns each pixel's middle: site, motion, and the cells i, j of the lattice that it is moved by; null where
     * there is nothing to draw. For tests: `how` tells the way that they are found.
     * @param {Scene} scene
     * @param {"exact" | "cell"} how
     * @returns {Labels | null}
     */
    labels(scene, how) {
        const view = viewOf(scene.camera, 1);
        const pattern = this.#patternOf(scene);
        if (!pattern) return null;
        const image = new RenderTarget(this.#gl, "integers");
        image.resize(view.width, view.height);
        const { home, place } = folded(pattern, view);
        let tables;
        if (how === "exact") {
            tables = this.#windowTables;
            this.#look("look", scene, pattern, view).fill(image);
        } else {
            tables = this.#cellTables;
            this.#drawCell(scene, pattern, view);
            const program = this.#program("fold");
            this.#placed(program, place, [1, 1]);
            program.textures({ cell_image: this.#cellImage });
            program.fill(image);
        }
        const seen = image.read();
        const [[a, b], [c, d]] = pattern.basis.rows;
        const labels = new Int32Array(seen.length);
        for (let k = 0; k < seen.length; k += 4) {
            const [placement, i, j] = tables.names.subarray(3 * seen[k], 3 * seen[k] + 3);
            const x = i + ((seen[k + 1] << 16) >> 16) + home[0];
            const y = j + (seen[k + 1] >> 16) + home[1];
            const { site, motion } = pattern.placements[placement];
            labels.set([site, motion, x * a + y * c, x * b + y * d], k);
        }
        return { width: view.width, height: view.height, labels };
    }

    /**
     * @param {Scene} scene
     * @returns {Pattern | null} Null where there is nothing to draw.
     */
    #patternOf({ lattice, motions, sites }) {
        const causes = [...lattice.a, ...lattice.b, motions, ...sites.flatMap((site) => [site.segments, site.cosets])];
        return this.#pattern.get(causes, () => {
            const basis = reducedBasis(lattice);
            const pattern = basis && new Pattern(basis, motions, sites);
            return pattern && !pattern.empty ? pattern : null;
        });
    }

    /**
     * Draw the samples of the window.
     * @param {Scene} scene
     * @param {Pattern} pattern
     * @param {View} view
     */
    #paintWindow(scene, pattern, view) {
        const program = this.#look("exact", scene, pattern, view);
        this.#shade(program, scene, pattern, view, folded(pattern, view).home, this.#windowTables, 3);
        program.fill(null, view.width, view.height);
    }

    /**
     * Tile the window from the image of a cell.
     * @param {Scene} scene
     * @param {Pattern} pattern
     * @param {View} view
     */
    #paintTiled(scene, pattern, view) {
        const drawn = this.#drawCell(scene, pattern, view);
        const { home, place } = folded(pattern, view);
        const { period } = this.#coloursOf(scene, pattern);
        const { width, height } = this.#cellImage;
        const [across, up] = [width * period[0], height * period[1]];
        const small = TEXELS_MIN ** 2 > cellSize(pattern, view).reduce((x, y) => x * y);
        const worth = across * up <= (view.width * view.height) / 2 || small;
        if (!worth || Math.max(across, up) > TEXELS_MAX) {
            const program = this.#program("colour");
            this.#placed(program, place, [1, 1]);
            program.textures({ cell_image: this.#cellImage });
            this.#shade(program, scene, pattern, view, home, this.#cellTables, 1);
            program.fill(null, view.width, view.height);
            return;
        }
        this.#periodDrawn.get([drawn, view.perCss, scene.colouring, JSON.stringify(scene.style)], () => {
            const program = this.#program("colour");
            this.#placed(program, { corner: [0, 0], perColumn: [1 / width, 0], perRow: [0, 1 / height] }, [1, 1]);
            program.textures({ cell_image: this.#cellImage });
            this.#shade(program, scene, pattern, view, [0, 0], this.#cellTables, 1);
            this.#periodImage.resize(across, up);
            program.fill(this.#periodImage);
            this.#periodImage.smooth(small);
        });
        const program = this.#program("tile");
        const [x, y] = [modulo(home[0], period[0]), modulo(home[1], period[1])];
        this.#placed(program, { ...place, corner: [place.corner[0] + x, place.corner[1] + y] }, period);
        program.textures({ period_image: this.#periodImage });
        program.fill(null, view.width, view.height);
    }

    /**
     * Draw the image of a cell, where it is another than last time.
     * @param {Scene} scene
     * @param {Pattern} pattern
     * @param {View} view
     * @returns {object} The same one for the same image.
     */
    #drawCell(scene, pattern, view) {
        const band = bandOf(scene, pattern, view);
        return this.#cellDrawn.get([pattern, view.step[0], band], () => {
            const { p, q } = pattern.basis;
            const [across, up] = cellSize(pattern, view);
            const dense = Math.max(1, TEXELS_MIN / Math.sqrt(across * up));
            const width = Math.min(TEXELS_MAX, Math.ceil(across * dense));
            const height = Math.min(TEXELS_MAX, Math.ceil(up * dense));
            /** @type {Frame} */
            const frame = {
                origin: [(p[0] / width + q[0] / height) / 2, (p[1] / width + q[1] / height) / 2],
                u: [p[0] / width, p[1] / width],
                v: [q[0] / height, q[1] / height],
                width,
                height,
                scale: 1 / view.step[0],
            };
            const blocks = (width * height) / CELL_BLOCK ** 2;
            const cell = new CellLists(pattern, blockRadius(frame, CELL_BLOCK), band * view.step[0], blocks);
            this.#lists.fill(cell, frame, CELL_BLOCK);
            this.#cellTables.write(this.#lists, cell);
            const program = this.#listed("look", this.#cellTables, frame, CELL_BLOCK, band);
            this.#cellImage.resize(width, height);
            program.fill(this.#cellImage);
            return {};
        });
    }

    /**
     * Prepare a program that looks at the samples of the window.
     * @param {"look" | "exact"} name
     * @param {Scene} scene
     * @param {Pattern} pattern
     * @param {View} view
     */
    #look(name, scene, pattern, view) {
        const { p, q } = pattern.basis;
        const { home } = folded(pattern, view);
        const [x, y] = view.step;
        /** @type {Frame} */
        const frame = {
            origin: [
                view.corner[0] + x / 2 - home[0] * p[0] - home[1] * q[0],
                view.corner[1] + y / 2 - home[0] * p[1] - home[1] * q[1],
            ],
            u: [x, 0],
            v: [0, y],
            width: view.width,
            height: view.height,
            scale: 1 / x,
        };
        const [across] = cellSize(pattern, view);
        let block = BLOCK;
        while (block > 4 && across < 8 * block) block /= 2;
        while (view.width * view.height > BLOCKS_MAX * block * block) block *= 2;
        const band = bandOf(scene, pattern, view);
        const [radius, near] = [blockRadius(frame, block), band * x];
        const make = () => new CellLists(pattern, radius, near, Infinity);
        const cell = this.#windowCell.get([pattern, radius, near], make);
        this.#lists.fill(cell, frame, block);
        this.#windowTables.write(this.#lists, cell);
        return this.#listed(name, this.#windowTables, frame, block, band);
    }

    /**
     * Prepare a program that reads lists.
     * @param {"look" | "exact"} name
     * @param {ListTables} tables
     * @param {Frame} frame
     * @param {number} block
     * @param {number} band
     */
    #listed(name, tables, { u, v, scale }, block, band) {
        const program = this.#program(name);
        program.numbers("u", u[0] * scale, u[1] * scale);
        program.numbers("v", v[0] * scale, v[1] * scale);
        program.integers("block", block);
        program.integers("columns", tables.columns);
        program.numbers("band", band);
        program.textures({ block_table: tables.blocks, run_table: tables.runs, element_table: tables.elements });
        return program;
    }

    /**
     * Tell a program how copies are coloured.
     * @param {Program} program
     * @param {Scene} scene
     * @param {Pattern} pattern
     * @param {View} view
     * @param {Point} home The cell that cells are counted from.
     * @param {ListTables} tables
     * @param {number} unit The first texture unit that is free.
     */
    #shade(program, scene, pattern, view, home, tables, unit) {
        const {
            dark = false,
            border = 1.5,
            borderColour,
            strokes = 0,
            strokeColour,
            strokeOpacity = 0.4,
        } = scene.style ?? {};
        const ink = inks(dark);
        const { rows, m, n, period } = this.#coloursOf(scene, pattern);
        const half = (/** @type {number} */ width) => (width > 0 ? (width * view.perCss) / 2 : -1);
        program.integers("rows", ...rows);
        program.integers("repeat", m, n);
        program.integers("home_cell", modulo(home[0], period[0]), modulo(home[1], period[1]));
        program.numbers("border", ...(borderColour ?? ink.border), half(border));
        program.numbers("stroke", ...(strokeColour ?? ink.stroke), half(strokes));
        program.numbers("stroke_opacity", strokeOpacity);
        program.numbers("nobody", ...ink.nobody);
        program.textures({ copy_table: tables.copies, colour_table: this.#colourTable }, unit);
    }

    /**
     * The colours of a pattern's copies, which are in the colour table from now on.
     * @param {Scene} scene
     * @param {Pattern} pattern
     */
    #coloursOf({ colouring, style }, pattern) {
        const dark = style?.dark ?? false;
        return this.#colours.get([pattern, colouring, dark], () => {
            const colours = coloursOf(colouring, pattern.placements.length, pattern.basis.rows);
            const records = Uint8Array.from(
                colours.colour.flatMap((k) => [...tileColour(k, dark).map((part) => Math.round(255 * part)), 255]),
            );
            this.#colourTable.write(records, colours.colour.length);
            return colours;
        });
    }

    /**
     * Tell a program where its pixels lie.
     * @param {Program} program
     * @param {{corner: Point, perColumn: Point, perRow: Point}} place In cells.
     * @param {Point} unit Cells that count as 1.
     */
    #placed(program, { corner, perColumn, perRow }, [m, n]) {
        program.numbers("corner", corner[0] / m, corner[1] / n);
        program.numbers("per_column", perColumn[0] / m, perColumn[1] / n);
        program.numbers("per_row", perRow[0] / m, perRow[1] / n);
    }

    /**
     * A program, in use.
     * @param {ShaderName} name
     */
    #program(name) {
        let program = this.#programs.get(name);
        if (!program) this.#programs.set(name, (program = new Program(this.#gl, this.#shaders[name])));
        program.use();
        return program;
    }
}

/**
 * @param {Camera} camera
 * @param {number} coarse
 * @returns {View}
 */
function viewOf({ centre, scale, size, ratio, pixels }, coarse) {
    const [across, up] = pixels ?? [Math.round(size[0] * ratio), Math.round(size[1] * ratio)];
    const [width, height] = [Math.max(1, Math.ceil(across / coarse)), Math.max(1, Math.ceil(up / coarse))];
    return {
        width,
        height,
        corner: [centre[0] - size[0] / scale / 2, centre[1] - size[1] / scale / 2],
        step: [size[0] / scale / width, size[1] / scale / height],
        perCss: width / size[0],
    };
}

/**
 * The cell that the window's corner lies in, the corner's place in it, and what pixels add to that; in cells.
 * @param {Pattern} pattern
 * @param {View} view
 */
function folded(pattern, { corner, step }) {
    const [s, t] = pattern.fractional(...corner);
    /** @type {Point} */
    const home = [Math.floor(s), Math.floor(t)];
    /** @type {Point} */
    const within = [s - home[0], t - home[1]];
    const place = { corner: within, perColumn: pattern.fractional(step[0], 0), perRow: pattern.fractional(0, step[1]) };
    return { home, place };
}

/**
 * The sides of the reduced cell in pixels, the shorter one first.
 * @param {Pattern} pattern
 * @param {View} view
 */
function cellSize({ basis: { p, q } }, { step }) {
    return [Math.hypot(...p) / step[0], Math.hypot(...q) / step[0]];
}

/**
 * How much farther than the nearest copy another one may be whose border is drawn; pixels. The next copy is never
 * farther than a cell's shorter side.
 * @param {Scene} scene
 * @param {Pattern} pattern
 * @param {View} view
 */
function bandOf({ style }, pattern, view) {
    const border = style?.border ?? 1.5;
    return border > 0 ? Math.min(border * view.perCss + 1, cellSize(pattern, view)[0]) : BAND_MIN;
}
