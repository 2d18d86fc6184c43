// @ts-check
// The solid, over the drawing while its panel is looked at: turned by the pointer, the wheel, two fingers or keys. Where
// there is no WebGL, the program's own picture of it stands there.

import { watchSize } from "../gl/preview.js";
import { SolidPainter } from "../gl/solid.js";
import { FIRST_LOOK, Look } from "../model/solids.js";

/** @typedef {import("../store.js").Store} Store */

/** How far it turns; degrees a pixel of the pointer's way, and a key. */
const TURN = 0.4;
const STEP = 7.5;
/** How far keys move it; pixels. */
const SHIFT = 40;
/** The part of the window that it takes where nobody has made it larger. */
const FILLED = 0.94;

export class SolidView {
    #canvas;
    /** @type {HTMLImageElement | null} what is shown where there is no WebGL */
    #picture = null;
    #store;
    #drawn;
    #look = new Look();
    #painter;
    #frame = 0;
    #ratio = 1;
    /** Whether it is as large as the window holds, until somebody zooms. */
    #fits = true;
    /** @type {Map<number, [number, number]>} where pointers are that are down */
    #pointers = new Map();
    /** @type {AbortController | null} gives up the picture that is waited for */
    #asking = null;
    /** @type {any} the solid that the painter has */
    #shown = null;

    /**
     * @param {HTMLCanvasElement} canvas
     * @param {Store} store
     * @param {(signal: AbortSignal) => Promise<Blob>} drawn the program's own picture of what is drawn
     */
    constructor(canvas, store, drawn) {
        this.#canvas = canvas;
        this.#store = store;
        this.#drawn = drawn;
        this.#painter = SolidPainter.of(canvas, () => this.redraw());
        store.set({ turnsSolids: this.#painter !== null });
        if (!this.#painter) {
            this.#picture = Object.assign(new Image(), {
                id: "solid-picture",
                alt: "The solid and its neighbours, pulled apart",
                hidden: true,
            });
            canvas.after(this.#picture);
        }
        store.subscribe(["solid", "apart", "solidPending", "solidRefusal"], () => this.redraw());
        watchSize(canvas, ({ ratio, pixels: [width, height] }) => {
            this.#ratio = ratio;
            Object.assign(canvas, { width, height });
            this.#draw(); // at once: a canvas of another size is empty
        });
        canvas.addEventListener("pointerdown", (event) => {
            canvas.setPointerCapture(event.pointerId);
            this.#pointers.set(event.pointerId, [event.clientX, event.clientY]);
        });
        for (const name of /** @type {const} */ (["pointerup", "pointercancel", "lostpointercapture"])) {
            canvas.addEventListener(name, (event) => this.#pointers.delete(event.pointerId));
        }
        canvas.addEventListener("pointermove", (event) => this.#move(event));
        canvas.addEventListener(
            "wheel",
            (event) => {
                event.preventDefault();
                this.zoom(Math.exp(-event.deltaY * 0.0015), this.#place([event.clientX, event.clientY]));
            },
            { passive: false },
        );
        canvas.addEventListener("keydown", (event) => {
            const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
            if (!arrow || event.ctrlKey || event.metaKey || event.altKey) {
                return;
            }
            event.preventDefault();
            if (event.shiftKey) {
                this.#pan(arrow[0] * SHIFT, arrow[1] * SHIFT);
            } else {
                this.#look.roll(arrow[0] * STEP, -arrow[1] * STEP);
            }
            this.redraw();
        });
    }

    get visible() {
        return !(this.#picture ?? this.#canvas).hidden;
    }

    /** @param {boolean} on */
    show(on) {
        (this.#picture ?? this.#canvas).hidden = !on;
        this.redraw();
    }

    focus() {
        this.#canvas.focus({ preventScroll: true });
    }

    /** @param {number} factor @param {readonly [number, number]} [at] what stays where it is, from the middle, y up */
    zoom(factor, at = [0, 0]) {
        this.#look.zoomAt(factor, at);
        this.#fits = false;
        this.redraw();
    }

    /** As large as the window holds. */
    fit() {
        this.#fits = true;
        this.redraw();
    }

    /** Look at it from a side; without one as at first. @param {{turn: number, tilt: number}} [side] degrees */
    lookFrom(side = FIRST_LOOK) {
        Object.assign(this.#look, side);
        this.fit();
    }

    /** How it is looked at, for scripts. */
    get look() {
        const { turn, tilt, scale, pan } = this.#look;
        return { turn, tilt, scale, pan, ratio: this.#ratio };
    }

    redraw() {
        this.#frame ||= requestAnimationFrame(() => {
            this.#frame = 0;
            this.#draw();
        });
    }

    /** @param {PointerEvent} event */
    #move(event) {
        const before = this.#pointers.get(event.pointerId);
        if (!before) {
            return;
        }
        const now = /** @type {[number, number]} */ ([event.clientX, event.clientY]);
        const other = [...this.#pointers].find(([id]) => id !== event.pointerId)?.[1];
        this.#pointers.set(event.pointerId, now);
        const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
        if (other) {
            const far = (/** @type {[number, number]} */ at) => Math.hypot(at[0] - other[0], at[1] - other[1]);
            this.#pan(dx / 2, -dy / 2);
            if (far(before) > 0 && far(now) > 0) {
                this.zoom(far(now) / far(before), this.#place([(now[0] + other[0]) / 2, (now[1] + other[1]) / 2]));
            }
        } else if (event.shiftKey || event.buttons & 6) {
            this.#pan(dx, -dy);
        } else {
            this.#look.roll(dx * TURN, dy * TURN);
        }
        this.redraw();
    }

    /** @param {number} right pixels @param {number} up pixels */
    #pan(right, up) {
        const { pan } = this.#look;
        this.#look.pan = [pan[0] + right, pan[1] + up];
        this.#fits = false;
    }

    /** A place of the page from the middle of the window, y up. @param {[number, number]} at @returns {[number, number]} */
    #place([x, y]) {
        const { left, top, width, height } = this.#canvas.getBoundingClientRect();
        return [x - left - width / 2, top + height / 2 - y];
    }

    #draw() {
        const { solid, apart, solidPending, solidRefusal } = this.#store.state;
        // What is coarse is right as far as it goes, whether the exact one comes or not.
        const isRight = solid?.coarse && (solidRefusal?.rev ?? solid.rev) === solid.rev;
        const isOld = (solidRefusal !== null || solidPending) && !isRight;
        (this.#picture ?? this.#canvas).classList.toggle("old", isOld);
        if (!this.visible) {
            return;
        }
        if (!this.#painter) {
            void this.#draws(/** @type {HTMLImageElement} */ (this.#picture));
            return;
        }
        if (solid !== this.#shown) {
            this.#shown = solid;
            this.#painter.show(solid);
        }
        const canvas = this.#canvas;
        if (this.#fits) {
            this.#look.pan = [0, 0];
            const [level, up] = this.#painter.reach(apart);
            const tilt = (this.#look.tilt * Math.PI) / 180;
            // The same from all sides: it does not grow while it is turned about the vertical.
            const high = level * Math.abs(Math.sin(tilt)) + up * Math.cos(tilt);
            this.#look.scale =
                (FILLED / 2) * Math.min(canvas.clientWidth / (level || 1), canvas.clientHeight / (high || 1));
        }
        this.#painter.paint(this.#look, apart, this.#ratio);
    }

    /** Have the server draw it, where that is another solid than before. @param {HTMLImageElement} image */
    async #draws(image) {
        const { solid } = this.#store.state;
        if (!solid || solid.coarse || solid === this.#shown) {
            return;
        }
        this.#shown = solid;
        this.#asking?.abort();
        this.#asking = new AbortController();
        try {
            const picture = await this.#drawn(this.#asking.signal);
            URL.revokeObjectURL(image.src);
            image.src = URL.createObjectURL(picture);
        } catch {
            // Given up for a newer one; or refused, as the solid is then, which the panel says.
        }
    }
}
