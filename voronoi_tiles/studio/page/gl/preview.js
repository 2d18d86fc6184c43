// @ts-check
/** The live picture of the tessellation in a canvas, by WebGL2: drawn at once, and exactly when it rests. */

import { Painter } from "./painter.js";

/** @typedef {import("./painter.js").Point} Point */
/** @typedef {import("./painter.js").Scene} Scene */
/** @typedef {"drawn" | "settled" | "refused" | "lost" | "restored"} State Refused: too many strokes to draw. */
/**
 * @typedef {object} Figures Milliseconds of one picture, the median and the 95th percentile.
 * @property {number} median
 * @property {number} p95
 * @property {number | null} card Of these the graphics card's, median; null where it does not tell.
 */

/** How long nothing has to change before the exact picture is drawn; milliseconds. */
const REST = 120;
/** Device pixels along the side of a pixel of what is drawn at once where the processor draws. */
const COARSE = 3;
/** Renderers in which the processor does the graphics card's work, by their names. */
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render|apple paravirtual/i;

export class Preview {
    #gl;
    #exact;
    #changed;
    #frame = 0;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    #timer;
    /** @type {Scene | null} */
    #scene = null;
    /** @type {Painter | null} Null while the context is lost. */
    #painter;

    /** Why there is no preview by WebGL2 here, in words; empty where there is one. */
    static missing() {
        if (typeof WebGL2RenderingContext === "undefined") return "this browser has no WebGL2";
        const gl = document.createElement("canvas").getContext("webgl2");
        if (!gl) return "WebGL2 is switched off, or the driver of this machine's graphics is not trusted";
        gl.getExtension("WEBGL_lose_context")?.loseContext();
        return "";
    }

    /** Whether this browser has WebGL2. */
    static get available() {
        return Preview.missing() === "";
    }

    /**
     * Throws an Error where WebGL2 is missing or refuses the shaders.
     * @param {HTMLCanvasElement} canvas Its size on the page is CSS's; its width and height are set here.
     * @param {string} exact The text of exact.glsl.
     * @param {{changed?: (state: State) => void}} [options]
     */
    constructor(canvas, exact, { changed = () => {} } = {}) {
        const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false, stencil: false });
        if (!gl) throw new Error(Preview.missing() || "the browser has no further context of WebGL2");
        this.#gl = gl;
        this.#exact = exact;
        this.#changed = changed;
        /** Who draws: the graphics card, or what stands in for it. */
        this.renderer = rendererOf(gl);
        /** Whether that is the processor: what is drawn at once is coarser then. */
        this.software = SOFTWARE.test(this.renderer);
        this.#painter = new Painter(gl, exact);
        canvas.addEventListener("webglcontextlost", this.#lost);
        canvas.addEventListener("webglcontextrestored", this.#restored);
    }

    /**
     * Draw at once, and exactly when nothing has changed for a while.
     * @param {Scene} scene
     */
    draw(scene) {
        this.#scene = scene;
        this.#wait();
        if (!this.#painter) return;
        // From the next frame on: where frames take longer than the rest, each would be followed by an exact picture.
        this.#frame = requestAnimationFrame(() => {
            this.#timer = setTimeout(() => this.settle(), REST);
        });
        this.#paint(this.#painter, this.#coarse, false);
    }

    /** Draw the last scene exactly, now. */
    settle() {
        this.#wait();
        if (!this.#scene || !this.#painter) return;
        this.#paint(this.#painter, 1, true);
    }

    /**
     * Who owns each pixel's middle, see Painter.labels; null where there is nothing to draw.
     * @param {Scene} scene
     * @param {"exact" | "cell"} how
     */
    labels(scene, how) {
        return this.#painter && this.#painter.labels(scene, how);
    }

    /**
     * The time of pictures: of those that are drawn at once while strokes are dragged or the window is moved, and exact
     * ones. Each is waited for, by reading a pixel.
     * @param {Scene} scene
     * @param {number} [count]
     * @returns {Promise<{renderer: string, software: boolean, dragged: Figures, moved: Figures, exact: Figures}>}
     */
    async bench(scene, count = 60) {
        const { renderer, software } = this;
        // New arrays are a new drawing; a new centre is not.
        const { camera, sites } = scene;
        const dragged = () => ({
            ...scene,
            sites: sites.map((site) => ({ ...site, segments: site.segments.slice() })),
        });
        const moved = (/** @type {number} */ k) => {
            /** @type {Point} */
            const centre = [camera.centre[0] + k / camera.scale, camera.centre[1]];
            return { ...scene, camera: { ...camera, centre } };
        };
        return {
            renderer,
            software,
            dragged: await this.#timed(count, (painter) => painter.paint(dragged(), this.#coarse, false)),
            moved: await this.#timed(count, (painter, k) => painter.paint(moved(k), this.#coarse, false)),
            exact: await this.#timed(Math.ceil(count / 6), (painter) => painter.paint(dragged(), 1, true)),
        };
    }

    /**
     * Draw the scene and say so.
     * @param {Painter} painter
     * @param {number} coarse
     * @param {boolean} exactly
     */
    #paint(painter, coarse, exactly) {
        const scene = /** @type {Scene} */ (this.#scene);
        try {
            painter.paint(scene, coarse, exactly);
        } catch (error) {
            if (!(error instanceof RangeError)) throw error;
            this.#wait();
            painter.clear(scene);
            this.#changed("refused");
            return;
        }
        this.#changed(exactly ? "settled" : "drawn");
    }

    /** Have no exact picture follow. */
    #wait() {
        cancelAnimationFrame(this.#frame);
        clearTimeout(this.#timer);
    }

    /** Device pixels along the side of a pixel of what is drawn at once. */
    get #coarse() {
        return this.software ? COARSE : 1;
    }

    /**
     * @param {number} count
     * @param {(painter: Painter, k: number) => void} paint
     * @returns {Promise<Figures>}
     */
    async #timed(count, paint) {
        const gl = this.#gl;
        const timer = gl.getExtension("EXT_disjoint_timer_query_webgl2");
        const pixel = new Uint8Array(4);
        const times = [];
        const queries = [];
        for (let k = -3; k < count && this.#painter; k++) {
            const start = performance.now();
            const query = timer && k >= 0 ? gl.createQuery() : null;
            if (query) gl.beginQuery(timer.TIME_ELAPSED_EXT, query);
            paint(this.#painter, k);
            if (query) gl.endQuery(timer.TIME_ELAPSED_EXT);
            gl.bindFramebuffer(gl.FRAMEBUFFER, null);
            gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
            if (k < 0) continue; // the first ones compile and allocate
            times.push(performance.now() - start);
            if (query) queries.push(query);
        }
        await new Promise((done) => setTimeout(done, 200)); // results come between tasks
        const known = queries.filter((query) => gl.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE));
        const disjoint = timer && gl.getParameter(timer.GPU_DISJOINT_EXT);
        const card = known.map((query) => gl.getQueryParameter(query, gl.QUERY_RESULT) / 1e6);
        for (const query of queries) gl.deleteQuery(query);
        return {
            median: quantile(times, 0.5),
            p95: quantile(times, 0.95),
            card: card.length && !disjoint ? quantile(card, 0.5) : null,
        };
    }

    #lost = (/** @type {Event} */ event) => {
        event.preventDefault(); // or it would never be restored
        this.#wait();
        this.#painter = null;
        this.#changed("lost");
    };

    #restored = () => {
        this.#painter = new Painter(this.#gl, this.#exact);
        this.#changed("restored");
        if (this.#scene) this.draw(this.#scene);
    };
}

/**
 * Say an element's size whenever it changes: in CSS pixels, and in the device pixels that it really covers.
 * @param {Element} element
 * @param {(size: {size: Point, ratio: number, pixels: Point}) => void} changed
 * @returns {() => void} Ends it.
 */
export function watchSize(element, changed) {
    const observer = new ResizeObserver((entries) => {
        const { contentRect, devicePixelContentBoxSize: boxes } = entries[entries.length - 1];
        const ratio = window.devicePixelRatio;
        const { width, height } = contentRect;
        /** @type {Point} */
        let pixels = [Math.round(width * ratio), Math.round(height * ratio)];
        const box = boxes?.[0];
        // Where a browser plays another device, it may say the pixels of its own.
        if (box && Math.abs(box.inlineSize - width * ratio) <= 1 && Math.abs(box.blockSize - height * ratio) <= 1) {
            pixels = [box.inlineSize, box.blockSize];
        }
        if (width > 0 && height > 0) changed({ size: [width, height], ratio, pixels });
    });
    try {
        observer.observe(element, { box: "device-pixel-content-box" });
    } catch {
        observer.observe(element); // browsers that do not know device pixels
    }
    return () => observer.disconnect();
}

/**
 * @param {WebGL2RenderingContext} gl
 * @returns {string}
 */
function rendererOf(gl) {
    const info = gl.getExtension("WEBGL_debug_renderer_info");
    return String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}

/**
 * @param {number[]} values Not empty.
 * @param {number} share
 */
function quantile(values, share) {
    const sorted = values.slice().sort((x, y) => x - y);
    return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
}
