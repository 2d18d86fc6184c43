// @ts-check
// The tools that place one point after another: the pen (tangents as handles), curves through points, B-splines, lines.
// Each point is a step of the history, so undo goes point by point, while a stroke is drawn and after.

import { addStroke, replaceStroke } from "../model/design.js";
import { penStroke } from "../model/nodes.js";
import { distance, length, minus, plus, scaled } from "../model/plane.js";
import { rounded } from "../model/snapping.js";
import { placementOf, unplace } from "../model/strokes.js";
import { NOTHING } from "../store.js";
import { colours, line as drawLine, ring } from "../view/marks.js";

/** @import { Hands, Point, Tool, Touch } from "./tool.js" */
/**
 * @typedef {{at: Point, in: Point, out: Point}} Placed a point with its handles, as vectors from it
 * @typedef {(points: Placed[], closed: boolean, placement: any) => any} Maker
 */

const NONE = /** @type {Point} */ ([0, 0]);

const STEP = Math.PI / 12;

/** A vector turned to the nearest multiple of 15 degrees. @type {(vector: Point) => Point} */
function onAngle([x, y]) {
    const [size, turn] = [Math.hypot(x, y), Math.round(Math.atan2(y, x) / STEP) * STEP];
    return [size * Math.cos(turn), size * Math.sin(turn)];
}

/**
 * A maker of strokes that are a list of points under a key.
 * @param {string} key
 * @param {number} least the fewest points
 * @param {number} leastClosed the same of a closed one
 * @returns {Maker}
 */
function listed(key, least, leastClosed) {
    return (points, closed, placement) => {
        if (points.length < (closed ? leastClosed : least)) {
            return null;
        }
        const at = points.map((point) => unplace(placement, point.at));
        return closed ? { [key]: at, closed: true } : { [key]: at };
    };
}

/** @type {Maker} */
function line(points, closed, placement) {
    if (!closed && points.length === 2) {
        return { segment: points.map((point) => unplace(placement, point.at)) };
    }
    return listed("polyline", 3, 3)(points, closed, placement);
}

/** @type {Maker} */
function pen(points, closed, placement) {
    const all = closed ? [...points, points[0]] : points;
    return all.length < 2 ? null : penStroke(all, placement);
}

/** @type {(what: Pick<Tool, "name" | "key" | "title" | "icon" | "help"> & {make: Maker, handles?: boolean}) => Tool} */
function pointTool({ make, handles = false, ...what }) {
    /** @type {Placed[]} */
    let points = [];
    let closed = false;
    /** @type {any} the design with the stroke as far as it is drawn; another one: somebody else has edited */
    let expected = null;
    /** @type {import("../model/design.js").Ref | null} */
    let ref = null;
    /** @type {Point | null} where the pointer is */
    let pointer = null;
    let broken = false;
    let pulling = false;
    let grabbed = NONE;
    let reach = 0;

    /**
     * Where a pointer places the next point: with Shift at a multiple of 15 degrees from the last.
     * @param {Touch} touch
     * @returns {Point}
     */
    const placeOf = (touch) => {
        const last = points.at(-1);
        if (!touch.shift || !last) {
            return touch.at;
        }
        return rounded(plus(last.at, onAngle(minus(touch.raw, last.at))), touch.reach / 1000);
    };

    /** @param {Hands} hands */
    const forget = (hands) => {
        hands.store.cancel();
        points = [];
        closed = false;
        ref = null;
        expected = null;
        pulling = false;
        hands.redraw();
    };

    /** @param {Hands} hands */
    const check = (hands) => {
        if (points.length && hands.store.settled !== expected) {
            points = [];
            ref = null;
            pulling = false;
        }
    };

    /**
     * The design with the stroke through some points.
     * @param {any} design
     * @param {Placed[]} through
     * @param {Hands} hands
     */
    const withStroke = (design, through, hands) => {
        const site = ref ? ref.site : hands.store.state.site;
        const stroke = make(through, closed, placementOf(design.site[site], {}));
        if (!stroke) {
            return design;
        }
        return ref ? replaceStroke(design, ref, stroke) : addStroke(design, site, stroke);
    };

    /** @param {Hands} hands */
    const commit = (hands) => {
        const { store } = hands;
        const site = ref ? ref.site : store.state.site;
        const before = store.settled;
        store.edit((design) => withStroke(design, points, hands));
        if (!ref && store.settled !== before) {
            ref = { site, stroke: store.settled.site[site].strokes.length - 1 };
        }
        expected = store.settled;
    };

    /** @param {Hands} hands */
    const finish = (hands) => {
        const done = ref;
        forget(hands);
        if (done) {
            hands.store.set({ selection: { strokes: [done], nodes: [] } });
        }
    };

    return {
        ...what,
        cursor: "crosshair",
        draws: true,
        down(touch, hands) {
            check(hands);
            reach = touch.reach;
            const first = points[0];
            const closes = points.length > 1 && distance(touch.raw, first.at) <= touch.reach;
            if (closes && make(points, true, placementOf(hands.store.settled.site[hands.store.state.site], {}))) {
                closed = true;
                commit(hands);
                finish(hands);
                return;
            }
            const last = points.at(-1);
            if (closes || (last && distance(touch.raw, last.at) <= touch.reach / 3)) {
                return;
            }
            const at = placeOf(touch);
            grabbed = touch.raw;
            hands.store.cancel();
            if (!points.length) {
                hands.store.set({ selection: NOTHING });
                expected = hands.store.settled;
            }
            points = [...points, { at, in: NONE, out: NONE }];
            pulling = true;
            broken = false;
            if (!handles) {
                commit(hands);
            }
        },
        move(touch, hands, held) {
            check(hands);
            pointer = placeOf(touch);
            if (held && pulling && handles) {
                let last = points[points.length - 1];
                if (touch.space) {
                    const at = rounded(plus(last.at, minus(touch.raw, grabbed)), 1 / hands.camera.scale);
                    last = { ...last, at };
                    points = [...points.slice(0, -1), last];
                    grabbed = touch.raw;
                    hands.store.preview((design) => withStroke(design, points, hands));
                    hands.redraw();
                    return;
                }
                grabbed = touch.raw;
                let pull = minus(touch.raw, last.at);
                if (length(pull) < touch.reach / 3) {
                    return;
                }
                if (touch.shift) {
                    pull = onAngle(pull);
                }
                pull = rounded(pull, 1 / hands.camera.scale);
                broken ||= touch.alt;
                const placed = {
                    at: last.at,
                    in: broken ? last.in : scaled(pull, -1),
                    out: pull,
                };
                points = [...points.slice(0, -1), placed];
                hands.store.preview((design) => withStroke(design, points, hands));
            } else if (points.length) {
                const [last, at] = [points[points.length - 1], pointer];
                if (distance(at, last.at) > touch.reach / 4) {
                    hands.store.preview((design) =>
                        withStroke(design, [...points, { at, in: NONE, out: NONE }], hands),
                    );
                }
            }
            hands.redraw();
        },
        up(touch, hands) {
            const last = points.at(-1);
            if (pulling && handles && last) {
                commit(hands);
            } else if (pulling && last && distance(touch.raw, last.at) > touch.reach) {
                // Who drags has drawn from one point to the next.
                points = [...points, { at: placeOf(touch), in: NONE, out: NONE }];
                commit(hands);
            }
            pulling = false;
        },
        twice(_touch, hands) {
            finish(hands);
        },
        key_down(key, _event, hands) {
            if (!points.length) {
                return false;
            }
            if (key === "Enter") {
                finish(hands);
                return true;
            }
            if (key === "Backspace" || key === "Delete") {
                this.undo?.(hands);
                return true;
            }
            return false;
        },
        undo(hands) {
            check(hands);
            if (!points.length) {
                return false;
            }
            hands.store.cancel();
            const through = points.slice(0, -1);
            const site = hands.store.settled.site[ref ? ref.site : hands.store.state.site];
            // The point that the pen still pulls at is no step yet.
            const had = ref !== null && !(pulling && handles);
            pulling = false;
            const has = make(through, false, placementOf(site, {})) !== null;
            points = through;
            if (had) {
                hands.store.undo();
                if (!has) {
                    ref = null;
                }
            }
            expected = hands.store.settled;
            hands.redraw();
            return true;
        },
        cancel(hands) {
            if (!points.length) {
                return false;
            }
            finish(hands);
            return true;
        },
        leave(hands) {
            if (points.length) {
                finish(hands);
            }
        },
        draw(context, { camera, store }) {
            if (!points.length || (store.settled !== expected && expected)) {
                return;
            }
            const { accent, panel, quiet } = colours();
            const ends = pointer ? [...points.map((p) => p.at), pointer] : points.map((p) => p.at);
            context.setLineDash([3, 3]);
            context.strokeStyle = quiet;
            drawLine(context, ...ends.slice(-2).map((at) => camera.toScreen(at)));
            context.setLineDash([]);
            context.strokeStyle = accent;
            const last = points[points.length - 1];
            if (length(last.out) > 0) {
                drawLine(context, ...[last.in, last.out].map((handle) => camera.toScreen(plus(last.at, handle))));
            }
            for (const [k, { at }] of points.entries()) {
                const closes = k === 0 && points.length > 1 && pointer && distance(pointer, at) <= reach;
                context.fillStyle = k ? panel : accent;
                ring(context, camera.toScreen(at), closes ? 7 : 4);
                context.fill();
                context.stroke();
            }
        },
    };
}

/** @type {Tool[]} */
export const POINT_TOOLS = [
    pointTool({
        name: "pen",
        key: "p",
        title: "Pen",
        icon: "pen",
        help: "Click for a corner, drag for a smooth point with a tangent. Enter ends the curve, a click on its first point closes it.",
        make: pen,
        handles: true,
    }),
    pointTool({
        name: "curve",
        key: "c",
        title: "Curve through points",
        icon: "curve",
        help: "Click the points that a smooth curve (Catmull-Rom) runs through. Enter ends it, a click on the first point closes it.",
        make: listed("catmull_rom", 2, 3),
    }),
    pointTool({
        name: "spline",
        key: "s",
        title: "B-spline",
        icon: "spline",
        help: "Click the control points of a B-spline, four or more. Enter ends it, a click on the first point closes it.",
        make: listed("bspline", 4, 3),
    }),
    pointTool({
        name: "line",
        key: "l",
        title: "Line",
        icon: "line",
        help: "Click the corners of a line. Enter ends it, a click on the first point closes it.",
        make: line,
    }),
];
