// @ts-check
// All tools, and the way of pointers and keys to the one in hand.

import { isSameStroke } from "../model/design.js";
import { between, distance } from "../model/plane.js";
import { rounded, snap } from "../model/snapping.js";
import { elementsIn } from "../model/symmetry.js";
import { circle, freehand, point } from "./shapes.js";
import { hand, zoom } from "./look.js";
import { POINT_TOOLS } from "./points.js";
import { select } from "./select.js";
import { trace } from "./trace.js";

/** @import { Hands, Point, Tool, Touch } from "./tool.js" */

/** @type {Tool[]} */
export const TOOLS = [select, ...POINT_TOOLS, circle, point, freehand, hand, zoom];

/** Where another kind begins. */
export const BREAKS = new Set(["pen", "hand"]);

const MOUSE_REACH = 10;
const TOUCH_REACH = 22;

/** The share of the reach within which points are drawn to others. */
const SNAPS = 0.7;

/** How far apart ends are that meet; pixels. */
export const MEETS = MOUSE_REACH * SNAPS;

/** @type {Record<string, Tool>} */
const byName = Object.fromEntries(TOOLS.map((tool) => [tool.name, tool]));

export class Toolbox {
    #hands;
    #canvas;
    /** @type {Tool | null} the tool that Space or the middle button has put aside */
    #aside = null;
    #held = false;
    #space = false;
    #current = "select";
    /** @type {Map<number, Point>} fingers */
    #fingers = new Map();
    /** @type {import("../model/snapping.js").Snapped | null} */
    snapped = null;
    /** @type {Point | null} */
    #cross = null;

    /**
     * @param {HTMLCanvasElement} canvas that pointers and keys come to
     * @param {Hands} hands
     */
    constructor(canvas, hands) {
        this.#canvas = canvas;
        this.#hands = hands;
        canvas.addEventListener("pointerdown", (event) => this.#down(event));
        canvas.addEventListener("pointermove", (event) => this.#move(event));
        canvas.addEventListener("pointerup", (event) => this.#up(event));
        canvas.addEventListener("pointercancel", (event) => this.#lost(event));
        canvas.addEventListener("pointerleave", () => this.#away());
        canvas.addEventListener("dblclick", (event) => this.tool.twice?.(this.#touch(event), this.#hands));
        canvas.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
        canvas.addEventListener("contextmenu", (event) => event.preventDefault());
        hands.store.subscribe(["tool"], (state) => this.#take(state.tool));
        let moves = false;
        hands.store.subscribe(["trace"], (state) => {
            if (state.trace.moves !== moves) {
                moves = state.trace.moves;
                this.#show();
            }
        });
    }

    get tool() {
        const { image, moves } = this.#hands.store.state.trace;
        return this.#aside ? byName.hand : image && moves ? trace : byName[this.#current];
    }

    /** @returns {Point | null} the keyboard's cross hair, in the drawing */
    get cross() {
        return this.#cross;
    }

    set cross(at) {
        const had = this.#cross;
        this.#cross = at;
        if (!at !== !had) {
            this.#hint();
        }
    }

    /** Say what the tool in hand waits for: where there is a cross hair, Enter has another use. */
    #hint() {
        const { help } = this.tool;
        this.#hands.hint(this.#cross ? help.replace("Enter ends", "Enter places a point, Ctrl+Enter ends") : help);
    }

    /** @param {string} name */
    #take(name) {
        if (name !== this.#current) {
            byName[this.#current].leave?.(this.#hands);
            this.#hands.store.cancel();
        }
        this.#current = name;
        this.#show();
    }

    /** Show what the tool in hand waits for. */
    #show() {
        this.#cross = null;
        this.#hint();
        this.#canvas.style.cursor = this.tool.cursor;
        this.#hands.redraw();
    }

    /** Hold the hand tool while Space is down. @param {boolean} on */
    borrow(on) {
        this.#space = on;
        if (on !== (this.#aside !== null) && !this.#held) {
            this.#aside = on ? byName[this.#current] : null;
            this.#canvas.style.cursor = this.tool.cursor;
        }
    }

    /** @param {PointerEvent | MouseEvent} event @returns {Point} */
    #screen(event, box = this.#canvas.getBoundingClientRect()) {
        return [event.clientX - box.left, event.clientY - box.top];
    }

    /** @param {PointerEvent | MouseEvent} event @returns {Touch} */
    #touch(event) {
        const touch = "pointerType" in event && event.pointerType === "touch";
        const past = "getCoalescedEvents" in event ? event.getCoalescedEvents() : [];
        const box = this.#canvas.getBoundingClientRect();
        const trail = (past.length ? past : [event]).map((one) => this.#hands.camera.toDrawing(this.#screen(one, box)));
        return this.#touchAt(this.#screen(event, box), {
            shift: event.shiftKey,
            alt: event.altKey,
            ctrl: event.ctrlKey || event.metaKey,
            touch,
            trail,
        });
    }

    /**
     * @param {Point} screen
     * @param {Pick<Touch, "shift" | "alt" | "ctrl" | "touch" | "trail">} how
     * @returns {Touch}
     */
    #touchAt(screen, how) {
        const { camera } = this.#hands;
        const raw = camera.toDrawing(screen);
        const reach = (how.touch ? TOUCH_REACH : MOUSE_REACH) / camera.scale;
        this.snapped = how.ctrl ? null : this.#snap(raw, reach);
        return {
            at: this.snapped?.at ?? rounded(raw, 1 / camera.scale),
            raw,
            snapped: this.snapped,
            screen,
            reach,
            space: this.#space,
            ...how,
        };
    }

    /** @param {Point} at @param {number} reach */
    #snap(at, reach) {
        const { store, entries } = this.#hands;
        const { design, tables, shown, tool, selection } = store.state;
        if (
            !tables ||
            (tool === "select" && !this.#held) ||
            tool === "freehand" ||
            tool === "hand" ||
            tool === "zoom"
        ) {
            return null;
        }
        const joint = this.tool.joins?.(at, reach * SNAPS, this.#hands);
        if (joint) {
            return joint;
        }
        const near = /** @type {[number, number, number, number]} */ ([
            at[0] - reach,
            at[1] - reach,
            at[0] + reach,
            at[1] + reach,
        ]);
        const chosen = tool === "select" ? selection.strokes : [];
        const nodes = entries()
            .filter(({ ref }) => !store.state.dragging || !chosen.some((other) => isSameStroke(other, ref)))
            .flatMap((entry) => entry.nodes.filter((node) => node.role === "anchor").map((node) => node.at));
        return snap(at, {
            elements: elementsIn(design, tables, near),
            nodes: tool === "select" ? nodes : [],
            grid: shown.grid ? 1 : null,
            reach: reach * SNAPS,
        });
    }

    /** @param {PointerEvent} event */
    #down(event) {
        this.#canvas.setPointerCapture(event.pointerId);
        this.#canvas.focus({ preventScroll: true });
        this.cross = null;
        if (event.pointerType === "touch") {
            this.#fingers.set(event.pointerId, this.#screen(event));
            if (this.#fingers.size === 2) {
                // What the first finger has begun was no drawing.
                if (this.#held && this.tool.undo) {
                    this.tool.undo(this.#hands);
                } else {
                    this.tool.cancel?.(this.#hands);
                }
                this.#held = false;
                return;
            }
        }
        if (event.button === 1) {
            this.borrow(true);
        } else if (event.button !== 0) {
            return;
        }
        this.#held = true;
        this.tool.down?.(this.#touch(event), this.#hands);
    }

    /** @param {PointerEvent} event */
    #move(event) {
        const old = this.#fingers.get(event.pointerId);
        if (old && this.#fingers.size === 2) {
            this.#pinch(event, old);
            return;
        }
        const touch = this.#touch(event);
        this.tool.move?.(touch, this.#hands, this.#held);
        this.#hands.redraw();
        this.pointed?.(touch.at);
    }

    /** @type {((at: Point | null) => void) | null} */
    pointed = null;

    /** Two fingers move and zoom the window. @param {PointerEvent} event @param {Point} old */
    #pinch(event, old) {
        const now = this.#screen(event);
        const [other] = [...this.#fingers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
        const before = distance(old, other);
        this.#fingers.set(event.pointerId, now);
        this.#hands.camera.pan((now[0] - old[0]) / 2, (now[1] - old[1]) / 2);
        if (before > 0) {
            this.#hands.camera.zoomAt(between(now, other, 0.5), distance(now, other) / before);
        }
        this.#hands.redraw();
    }

    /** @param {PointerEvent} event */
    #up(event) {
        this.#fingers.delete(event.pointerId);
        if (!this.#held) {
            return;
        }
        const touch = this.#touch(event);
        this.#held = false;
        this.tool.up?.(touch, this.#hands);
        if (!this.tool.draws) {
            this.snapped = null;
        }
        if (event.button === 1) {
            this.borrow(false);
        }
        this.#hands.redraw();
    }

    /** @param {PointerEvent} event */
    #lost(event) {
        this.#fingers.delete(event.pointerId);
        this.#held = false;
        this.tool.cancel?.(this.#hands);
    }

    #away() {
        this.snapped = null;
        this.pointed?.(null);
        if (!this.#held && this.tool.draws) {
            this.#hands.store.cancel();
        }
        this.#hands.redraw();
    }

    /** @param {WheelEvent} event */
    #wheel(event) {
        event.preventDefault();
        const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
        if (event.shiftKey && !event.ctrlKey) {
            this.#hands.camera.pan(-(event.deltaX || event.deltaY) * lines, 0);
        } else {
            this.#hands.camera.zoomAt(
                this.#screen(event),
                Math.exp(-event.deltaY * lines * (event.ctrlKey ? 0.01 : 0.0015)),
            );
        }
        this.#hands.redraw();
    }

    /**
     * Move the cross hair of a drawing tool by units of the drawing, to a multiple of the larger step.
     * @param {number} dx
     * @param {number} dy
     */
    moveCross(dx, dy) {
        const { camera } = this.#hands;
        const [left, bottom, right, top] = camera.box;
        const [x, y] = this.cross ?? camera.centre;
        const step = Math.max(Math.abs(dx), Math.abs(dy));
        const to = (/** @type {number} */ value, /** @type {number} */ by) =>
            by ? Math.round((value + by) / step) * step : value;
        const screen = camera.toScreen([
            Math.min(Math.max(to(x, dx), left), right),
            Math.min(Math.max(to(y, dy), bottom), top),
        ]);
        const touch = this.#touchAt(screen, { shift: false, alt: false, ctrl: true, touch: false, trail: [] });
        this.cross = touch.raw;
        this.tool.move?.(touch, this.#hands, false);
        this.pointed?.(touch.at);
        this.#hands.redraw();
    }

    placeAtCross() {
        const { camera } = this.#hands;
        const screen = this.cross
            ? camera.toScreen(this.cross)
            : /** @type {Point} */ ([camera.size[0] / 2, camera.size[1] / 2]);
        const touch = this.#touchAt(screen, { shift: false, alt: false, ctrl: false, touch: false, trail: [] });
        this.cross = touch.raw;
        this.tool.down?.(touch, this.#hands);
        this.tool.up?.(touch, this.#hands);
        this.#hands.redraw();
    }
}
