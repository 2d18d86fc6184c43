// @ts-check
// The sheet as it is cut, true to size, with its dimensions and the places of findings; over the drawing while the
// job or the report is looked at.

import { shown } from "../model/lengths.js";
import { minus, plus, scaled, unit } from "../model/plane.js";
import { Camera } from "./camera.js";
import { colours, line, ring } from "./marks.js";

/** @import { Point } from "../model/plane.js" */
/** @import { Store } from "../store.js" */

const RULER = 26;

export class SheetView {
    #canvas;
    #store;
    #camera = new Camera();
    #frame = 0;
    /** @type {any} the size that the window was fitted to */
    #fitted = null;
    /** @type {[number, number] | null} the finding that is looked at */
    #finding = null;
    /** @type {{product: any, paths: {path: Path2D, colour: string, kind: string}[]} | null} */
    #paths = null;

    /** @param {HTMLCanvasElement} canvas @param {Store} store */
    constructor(canvas, store) {
        this.#canvas = canvas;
        this.#store = store;
        store.subscribe(["product", "unit", "theme", "jobRefusal", "jobPending"], () => this.redraw());
        new ResizeObserver(() => {
            this.#fitted = null;
            this.redraw();
        }).observe(canvas);
        /** @type {[number, number] | null} */
        let last = null;
        canvas.addEventListener("pointerdown", (event) => {
            canvas.setPointerCapture(event.pointerId);
            last = [event.clientX, event.clientY];
        });
        canvas.addEventListener("pointermove", (event) => {
            if (last && event.buttons) {
                this.#camera.pan(event.clientX - last[0], event.clientY - last[1]);
                last = [event.clientX, event.clientY];
                this.redraw();
            }
        });
        canvas.addEventListener(
            "wheel",
            (event) => {
                event.preventDefault();
                const box = canvas.getBoundingClientRect();
                this.#camera.zoomAt(
                    [event.clientX - box.left, event.clientY - box.top],
                    Math.exp(-event.deltaY * 0.0015),
                );
                this.redraw();
            },
            { passive: false },
        );
        canvas.addEventListener("keydown", (event) => {
            const arrow = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
            if (arrow) {
                this.#camera.pan(arrow[0] * 40, arrow[1] * 40);
                this.redraw();
                event.preventDefault();
            }
        });
        document.addEventListener("studio-finding", (event) => {
            this.#finding = /** @type {CustomEvent} */ (event).detail;
            if (this.#finding) {
                this.#camera.centre = [this.#finding[0], -this.#finding[1]];
                this.#camera.scale = Math.max(this.#camera.scale, 24);
            }
            this.redraw();
        });
    }

    /** @param {number} factor */
    zoom(factor) {
        this.#camera.zoomAt([this.#camera.size[0] / 2, this.#camera.size[1] / 2], factor);
        this.redraw();
    }

    fit() {
        this.#fitted = null;
        this.redraw();
    }

    get visible() {
        return !this.#canvas.hidden;
    }

    /** @param {boolean} on */
    show(on) {
        this.#canvas.hidden = !on;
        this.redraw();
    }

    redraw() {
        this.#frame ||= requestAnimationFrame(() => {
            this.#frame = 0;
            this.#draw();
        });
    }

    #draw() {
        const { product, jobPending, jobRefusal } = this.#store.state;
        const canvas = this.#canvas;
        if (canvas.hidden) {
            return;
        }
        const camera = this.#camera;
        Object.assign(camera, { size: [canvas.clientWidth, canvas.clientHeight], ratio: devicePixelRatio });
        const [width, height] = [
            Math.round(canvas.clientWidth * camera.ratio),
            Math.round(canvas.clientHeight * camera.ratio),
        ];
        if (canvas.width !== width || canvas.height !== height) {
            Object.assign(canvas, { width, height });
        }
        const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
        const { bad, edge, ground, text, warn } = colours();
        context.setTransform(1, 0, 0, 1, 0, 0);
        context.fillStyle = ground;
        context.fillRect(0, 0, width, height);
        if (!product) {
            return;
        }
        const { page } = product;
        const key = `${page.width} ${page.height}`;
        if (this.#fitted !== key) {
            this.#fitted = key;
            camera.fit([0, -page.height, page.width, 0], 0.8);
            // Beside it the dimensions have room.
            const [across, up] = [
                (camera.size[0] - 4 * RULER) / page.width,
                (camera.size[1] - 4 * RULER) / page.height,
            ];
            camera.scale = Math.max(Math.min(camera.scale, across, up), camera.scale / 4);
        }
        if (this.#paths?.product !== product) {
            this.#paths = {
                product,
                paths: product.layers.map((layer) => ({ ...layer, path: new Path2D(layer.path) })),
            };
        }
        // The file's y runs down.
        const k = camera.scale * camera.ratio;
        const [x0, y0] = camera.toScreen([0, 0]);
        context.setTransform(k, 0, 0, k, x0 * camera.ratio, y0 * camera.ratio);
        context.fillStyle = "#fff";
        context.fillRect(0, 0, page.width, page.height);
        // What is not yet of the newest drawing and job, or is no more, is pale.
        context.globalAlpha = jobPending || jobRefusal ? 0.35 : 1;
        context.lineWidth = 1.3 / camera.scale;
        context.lineJoin = "round";
        for (const { path, colour } of this.#paths?.paths ?? []) {
            context.strokeStyle = colour;
            context.stroke(path);
        }
        context.globalAlpha = 1;
        context.setTransform(camera.ratio, 0, 0, camera.ratio, 0, 0);
        context.strokeStyle = edge;
        context.strokeRect(x0, y0, page.width * camera.scale, page.height * camera.scale);
        this.#dimensions(context, page, text);
        for (const finding of product.findings) {
            const chosen =
                finding.at && this.#finding && finding.at[0] === this.#finding[0] && finding.at[1] === this.#finding[1];
            // Remarks are many and harmless: a ring is drawn around the one that is looked at.
            if (finding.at && (chosen || finding.severity !== "info")) {
                context.strokeStyle = finding.severity === "error" ? bad : warn;
                context.lineWidth = chosen ? 3 : 1.5;
                ring(context, camera.toScreen([finding.at[0], -finding.at[1]]), chosen ? 11 : 7);
                context.stroke();
            }
        }
    }

    /**
     * The sheet's width and height, as on a drawing.
     * @param {CanvasRenderingContext2D} context
     * @param {{width: number, height: number}} page
     * @param {string} colour
     */
    #dimensions(context, page, colour) {
        const { unit: shownIn, tables } = this.#store.state;
        const mm = tables?.units[shownIn] ?? 1;
        const [x0, y0] = this.#camera.toScreen([0, 0]);
        const [x1, y1] = this.#camera.toScreen([page.width, -page.height]);
        context.strokeStyle = context.fillStyle = colour;
        context.lineWidth = 1;
        context.font = "12px system-ui, sans-serif";
        context.textAlign = "center";
        const measured = (/** @type {Point} */ from, /** @type {Point} */ to) => {
            line(context, from, to);
            const [u, v] = scaled(unit(minus(to, from)), 4);
            // Strokes across both ends.
            for (const at of [from, to]) {
                line(context, minus(at, [v, u]), plus(at, [v, u]));
            }
        };
        measured([x0, y1 + RULER / 2], [x1, y1 + RULER / 2]);
        context.fillText(`${shown(page.width / mm, shownIn)} ${shownIn}`, (x0 + x1) / 2, y1 + RULER + 5);
        measured([x0 - RULER / 2, y0], [x0 - RULER / 2, y1]);
        context.save();
        context.translate(x0 - RULER / 2 - 7, (y0 + y1) / 2);
        context.rotate(-Math.PI / 2);
        context.fillText(`${shown(page.height / mm, shownIn)} ${shownIn}`, 0, 0);
        context.restore();
    }
}
