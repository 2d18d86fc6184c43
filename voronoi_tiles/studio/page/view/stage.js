// @ts-check
// The drawing's window: the live picture below, the exact outlines and the overlay above it, each drawn when it changes.

import { Preview, watchSize } from "../gl/preview.js";
import { boxOf, entriesOf, segmentsOf } from "../scene.js";
import { isSameStroke } from "../model/design.js";
import { Kept } from "../model/kept.js";
import { cosets, latticeOf, motionsOf } from "../model/symmetry.js";
import { Camera } from "./camera.js";
import { Outlines, fillCopies, strokeCopies } from "./outlines.js";
import { drawOverlay } from "./overlay.js";
import { Morph } from "./morph.js";
import { FLAT, roundedScale } from "./paths.js";
import { drawTrace } from "./trace.js";

/**
 * @typedef {import("../store.js").Store} Store
 * @typedef {import("../store.js").State} State
 * @typedef {import("../tools/toolbox.js").Toolbox} Toolbox
 */

/** Outlines that the server makes this fast follow the pointer; milliseconds. */
const QUICK_MS = 50;

export class Stage {
    camera = new Camera();
    #store;
    /** of the overlay, and below it of outlines with the picture to trace: over the live picture, or of whole tiles */
    #contexts;
    /** @type {Kept<void>} what the canvas of outlines or tiles shows */
    #drawn = new Kept();
    /** @type {Preview | null} */
    #preview = null;
    #frame = 0;
    #fitted = false;
    /** @type {Toolbox | null} */
    toolbox = null;
    /** @type {import("../tools/tool.js").Hands | null} */
    hands = null;
    /** @type {Map<string, {lattice: import("../model/symmetry.js").Lattice, motions: import("../model/symmetry.js").Motion[]}>} */
    #symmetries = new Map();
    /** @type {{design: any, resolved: any, scale: number, sites: any[]} | null} */
    #sites = null;
    /** @type {State["exact"]} the outlines that were drawn last */
    shownExact = null;
    #paths = new Outlines();
    #artPaths = new Outlines();
    /** @type {Kept<{path: string, operations: readonly number[]}[]>} */
    #artTiles = new Kept();
    /** @type {any} what the preview has drawn last */
    #previewed = null;
    /** @type {any} the sites that the preview could not draw */
    #tooMuch = null;
    /** @type {any} the last colouring that came */
    #colouring = null;
    #morph = new Morph();

    /**
     * @param {HTMLCanvasElement} picture
     * @param {HTMLCanvasElement} overlay
     * @param {Store} store
     */
    constructor(picture, overlay, store) {
        this.#store = store;
        this.#picture = picture;
        // Drawn by the processor: where WebGL is software, Chromium would draw lines by it too, four times slower.
        const contextOf = (/** @type {HTMLCanvasElement} */ canvas, alpha = true) =>
            /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { willReadFrequently: true, alpha }));
        const below = (/** @type {string} */ id, alpha = true) => {
            const canvas = Object.assign(document.createElement("canvas"), { id, ariaHidden: "true", hidden: true });
            overlay.before(canvas);
            return contextOf(canvas, alpha);
        };
        // Tiles cover the window: to mix them with what lies below would take a millisecond in each frame.
        this.#contexts = { overlay: contextOf(overlay), outlines: below("outlines"), tiles: below("tiles", false) };
        watchSize(overlay, ({ size, ratio, pixels }) => {
            Object.assign(this.camera, { size, ratio, pixels });
            if (!this.#fitted) {
                this.fit();
            }
            this.redraw();
        });
        store.subscribe(
            ["design", "refusal", "selection", "shown", "tables", "theme", "dragging", "trace", "behind"],
            () => this.redraw(),
        );
        // What has come is drawn at once, for the screen's next picture, unless the other one is drawn then in any case.
        store.subscribe(["exact"], ({ exact }) => {
            if (!this.#frame || this.#picture.hidden) {
                this.#drawTiles();
            }
            if (Object.keys(exact?.resolved ?? {}).length) {
                this.redraw(); // strokes that are files
            }
        });
        this.#system.addEventListener("change", () => this.redraw());
    }

    #picture;
    #system = matchMedia("(prefers-color-scheme: dark)");

    /**
     * Draw the picture by WebGL, with the raster stage's shader.
     * @param {string} shader
     */
    usePreview(shader) {
        if (Preview.available) {
            this.#preview = new Preview(this.#picture, shader, {
                changed: (state) => state === "restored" && this.redraw(),
            });
        }
        this.#picture.hidden = !this.#preview;
        this.redraw();
    }

    /** The frame times of the preview, and what draws it; null without WebGL. */
    bench() {
        const { lattice, motions } = this.symmetry();
        return this.#drawPicture(lattice, motions) ? this.#preview?.bench(this.#previewed) : null;
    }

    get dark() {
        const { theme } = this.#store.state;
        return theme ? theme === "dark" : this.#system.matches;
    }

    /** The strokes as they are drawn. */
    entries() {
        const { design, exact } = this.#store.state;
        return entriesOf(design, exact?.resolved);
    }

    /**
     * The lattice and the motions of a design's group, the same objects while group and cell are.
     * @param {import("../model/design.js").Design} [design] the one that is drawn
     */
    symmetry(design = this.#store.state.design) {
        const { tables } = this.#store.state;
        const key = JSON.stringify([design.group, design.cell]);
        const found = this.#symmetries.get(key) ?? {
            lattice: latticeOf(design, tables),
            motions: motionsOf(design, tables),
        };
        // The last two are kept: what is drawn, and what the exact outlines on the screen are of.
        this.#symmetries.delete(key);
        this.#symmetries.set(key, found);
        if (this.#symmetries.size > 2) {
            this.#symmetries.delete([...this.#symmetries.keys()][0]);
        }
        return found;
    }

    /** What the preview draws of each site, the same objects while strokes, symmetry and the scale of the window are. */
    #scene() {
        const { design, exact } = this.#store.state;
        const { lattice, motions } = this.symmetry();
        const old = this.#sites;
        const scale = roundedScale(this.camera.scale);
        if (!old || old.design !== design || old.resolved !== exact?.resolved || old.scale !== scale) {
            const segments = segmentsOf(design, this.entries(), FLAT / scale);
            const sites = segments
                .map((part) => ({ segments: part, cosets: cosets(motions, lattice, part) }))
                .filter((site) => site.segments.length);
            this.#sites = { design, resolved: exact?.resolved, scale, sites };
        }
        return this.#sites?.sites ?? [];
    }

    redraw() {
        this.#frame ||= requestAnimationFrame(() => {
            this.#frame = 0;
            this.#drawTiles();
            this.#drawStrokes();
        });
    }

    /** Whether there is something to draw, and where. */
    get #isReady() {
        return this.#store.state.tables && this.#store.state.design && this.camera.size[0] >= 2;
    }

    /** Draw the tiles: the live picture, or the exact outlines for it. */
    #drawTiles() {
        if (!this.#isReady) {
            return;
        }
        const { state } = this.#store;
        const { lattice, motions } = this.symmetry();
        this.#colouring = state.exact?.colouring ?? this.#colouring;
        const hasPicture = state.shown.colours && !this.#outlinesDo(state) && this.#drawPicture(lattice, motions);
        if (this.#picture.hidden === hasPicture) {
            this.#picture.hidden = !hasPicture;
        }
        this.#drawOutlines(state, state.shown.colours && !hasPicture);
        this.shownExact = state.exact;
    }

    /** Draw what lies over the tiles. */
    #drawStrokes() {
        if (!this.#isReady || !this.hands || !this.toolbox) {
            return;
        }
        const scene = { design: this.#store.state.design, ...this.symmetry(), entries: this.entries() };
        const seen = this.#morph.at(scene, performance.now());
        const hands = { ...this.hands, entries: () => seen.entries };
        drawOverlay(this.#cleared(this.#contexts.overlay), hands, this.toolbox, seen.motions, seen.lattice);
        if (seen.moves) {
            this.redraw();
        }
    }

    /**
     * A canvas to draw on, in the size of the window, and empty, but for that of tiles, which cover it.
     * @param {CanvasRenderingContext2D} context
     */
    #cleared(context) {
        const [width, height] = this.#pixels;
        if (context.canvas.width !== width || context.canvas.height !== height) {
            Object.assign(context.canvas, { width, height });
        }
        context.setTransform(1, 0, 0, 1, 0, 0);
        if (context !== this.#contexts.tiles) {
            context.clearRect(0, 0, width, height);
        }
        return context;
    }

    /** Width and height of the canvases. */
    get #pixels() {
        return this.camera.size.map((side) => Math.round(side * this.camera.ratio));
    }

    /**
     * Draw the exact outlines and the picture to trace, if they have changed.
     * @param {State} state
     * @param {boolean} filled whether the outlines are the picture
     */
    #drawOutlines(state, filled) {
        const { camera } = this;
        const outlines = this.#outlines(state, filled);
        const art = this.#art(state);
        const looks = [outlines, art].flatMap((drawn) => (drawn ? Object.values(drawn.style).flat() : []));
        const shown = [outlines?.copies, art?.copies, ...looks];
        const causes = [...shown, state.trace, camera.scale, ...camera.centre, ...this.#pixels];
        this.#drawn.get(causes, () => {
            const { outlines: lines, tiles } = this.#contexts;
            tiles.canvas.hidden = !outlines?.style.fill;
            lines.canvas.hidden = !tiles.canvas.hidden;
            const context = this.#cleared(tiles.canvas.hidden ? lines : tiles);
            if (outlines?.style.fill) {
                fillCopies(context, camera, outlines.copies, outlines.style);
            }
            drawTrace(context, camera, state.trace);
            if (outlines?.style.line) {
                strokeCopies(context, camera, outlines.copies, outlines.style);
            }
            if (art) {
                strokeCopies(context, camera, art.copies, art.style);
            }
        });
    }

    /**
     * Whether the exact outlines, filled, do for a live picture: they are of what is drawn, or follow it closely, and
     * the processor that makes them would draw the other picture as well, several times slower.
     * @param {State} state
     */
    #outlinesDo({ exact, refusal, revision, behind }) {
        return (
            exact !== null &&
            !refusal &&
            Boolean(this.#preview?.software) &&
            (exact.rev === revision || (!behind && exact.ms < QUICK_MS))
        );
    }

    /**
     * Draw the live picture; false where there is no WebGL, or more than it can draw: the outlines are the picture then.
     * @param {import("../model/symmetry.js").Lattice} lattice
     * @param {import("../model/symmetry.js").Motion[]} motions
     */
    #drawPicture(lattice, motions) {
        const sites = this.#scene();
        if (!this.#preview || !sites.length || this.#tooMuch === sites) {
            return false;
        }
        const style = { dark: this.dark, border: 0, strokes: 0 };
        this.#previewed = { lattice, motions, sites, camera: this.camera, colouring: this.#colouring, style };
        try {
            this.#preview.draw(this.#previewed);
        } catch (error) {
            console.warn(error);
            this.#tooMuch = sites;
            return false;
        }
        return true;
    }

    /**
     * The exact outlines: whole lines where they are of what is drawn, grey and dashed where that has none.
     * @param {State} state
     * @param {boolean} filled whether they are the picture
     */
    #outlines({ exact, refusal, shown }, filled) {
        if (!exact) {
            return null;
        }
        const { lattice, motions } = this.symmetry(exact.design);
        const colours = getComputedStyle(document.documentElement);
        const style = {
            scale: exact.scale,
            dark: this.dark,
            // Lines of one pixel are quick where the processor draws.
            line: !shown.edges ? 0 : refusal || this.#preview?.software ? 1 : 1.6,
            colour: colours.getPropertyValue(refusal ? "--quiet" : "--text").trim(),
            ...(refusal ? { dash: [5, 4], opacity: 0.7 } : {}),
            fill: filled ? (this.#colouring ?? true) : null,
        };
        const copies = this.#paths.copies(this.camera, lattice, motions, exact.tiles, style);
        return copies && { copies, style };
    }

    /** The art on all copies of the tiles; null where there is none. @param {State} state */
    #art({ exact, shown }) {
        const paths = Object.entries(exact?.art?.paths ?? {});
        if (!exact || !shown.art || !paths.length) {
            return null;
        }
        const found = paths.flatMap(([site, path]) => {
            const operations = exact.tiles[Number(site)]?.operations;
            return operations ? [{ path, operations }] : [];
        });
        // Outlines come with every step of the pointer; what is drawn in them stays.
        const tiles = this.#artTiles.get(
            [exact.art, JSON.stringify(found.map((tile) => tile.operations))],
            () => found,
        );
        const { lattice, motions } = this.symmetry(exact.design);
        const colour = getComputedStyle(document.documentElement).getPropertyValue("--text").trim();
        const style = { scale: exact.scale, line: 0.8, colour, dark: this.dark };
        const copies = this.#artPaths.copies(this.camera, lattice, motions, tiles, style);
        return copies && { copies, style };
    }

    /** @param {"cell" | "all" | "selection"} what */
    fit(what = "cell") {
        const { design, tables, selection } = this.#store.state;
        if (!design || !tables || this.camera.size[0] < 2) {
            return;
        }
        this.#fitted = true;
        const { a, b } = this.symmetry().lattice;
        const corners = [[0, 0], a, b, [a[0] + b[0], a[1] + b[1]]];
        const xs = corners.map((at) => at[0]);
        const ys = corners.map((at) => at[1]);
        const cell = [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
        const entries = this.entries().filter(
            ({ ref }) => what !== "selection" || selection.strokes.some((other) => isSameStroke(other, ref)),
        );
        this.camera.fit((what === "cell" ? null : boxOf(entries)) ?? cell, what === "cell" ? 0.55 : 0.72);
        this.redraw();
    }
}
