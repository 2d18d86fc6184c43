// @ts-check
// The tools whose stroke is one gesture: points, circles and freehand curves.

import { addStroke } from "../model/design.js";
import { fit } from "../model/freehand.js";
import { distance, tidyProduct } from "../model/plane.js";
import { rounded } from "../model/snapping.js";
import { placementOf, unplace } from "../model/strokes.js";
import { colours, path } from "../view/marks.js";

/** @import { Hands, Point, Tool } from "./tool.js" */

/**
 * Add a stroke to the site in hand, whose coordinates are the site's own.
 * @param {Hands} hands
 * @param {(unplaced: (at: Point) => Point, factor: number) => any} make
 * @param {"edit" | "preview"} [how]
 */
function add(hands, make, how = "edit") {
    const { store } = hands;
    const { site } = store.state;
    const change = (/** @type {any} */ design) => {
        const placement = placementOf(design.site[site], {});
        const stroke = make((at) => unplace(placement, at), 1 / Math.hypot(...placement.a));
        return stroke ? addStroke(design, site, stroke) : design;
    };
    if (how === "preview") {
        store.preview(change);
    } else {
        store.edit(change);
        const count = store.settled.site[site].strokes.length;
        store.set({ selection: { strokes: [{ site, stroke: count - 1 }], nodes: [] } });
    }
}

/** @type {Tool} */
export const point = {
    name: "point",
    key: "d",
    other: ".",
    title: "Point",
    icon: "point",
    cursor: "crosshair",
    draws: true,
    help: "Click where an isolated point shall be.",
    up(touch, hands) {
        add(hands, (unplaced) => ({ point: unplaced(touch.at) }));
    },
};

/** @type {Point | null} */
let middle = null;

/**
 * The radius of a circle whose rim is at a touch.
 * @param {Point} centre
 * @param {import("./tool.js").Touch} touch
 * @param {Hands} hands
 */
const radiusTo = (centre, { at }, { camera }) => rounded([distance(at, centre), 0], 1 / camera.scale)[0];

/** @param {Hands} hands @param {Point} centre @param {number} radius @param {"preview"} [how] */
const addCircle = (hands, centre, radius, how) =>
    add(hands, (unplaced, factor) => ({ circle: unplaced(centre), radius: tidyProduct(radius, factor) }), how);

/** @type {Tool} */
export const circle = {
    name: "circle",
    key: "o",
    title: "Circle",
    icon: "circle",
    cursor: "crosshair",
    draws: true,
    help: "Drag from the middle to the rim, or click both.",
    down(touch, hands) {
        if (middle) {
            this.up?.(touch, hands);
            middle = null;
            return;
        }
        middle = touch.at;
    },
    move(touch, hands) {
        if (!middle) {
            return;
        }
        const centre = middle;
        const radius = radiusTo(centre, touch, hands);
        if (radius > touch.reach / 4) {
            addCircle(hands, centre, radius, "preview");
        }
    },
    up(touch, hands) {
        // A click without a drag: the rim is clicked next.
        const centre = middle;
        const radius = centre ? radiusTo(centre, touch, hands) : 0;
        if (centre && radius > touch.reach / 2) {
            middle = null;
            addCircle(hands, centre, radius);
        }
    },
    cancel(hands) {
        const had = middle !== null;
        middle = null;
        hands.store.cancel();
        return had;
    },
    leave() {
        middle = null;
    },
};

/** @type {Point[]} */
let trail = [];

/** @type {Tool} */
export const freehand = {
    name: "freehand",
    key: "b",
    title: "Freehand",
    icon: "freehand",
    cursor: "crosshair",
    help: "Draw while the button is held: what is drawn becomes few smooth curves.",
    down(touch) {
        trail = [touch.raw];
    },
    move(touch, hands, held) {
        if (held && trail.length) {
            trail = [...trail, ...touch.trail];
            hands.redraw();
        }
    },
    up(touch, hands) {
        const drawn = trail;
        trail = [];
        const length = drawn.slice(1).reduce((sum, at, k) => sum + distance(at, drawn[k]), 0);
        if (length > touch.reach) {
            add(hands, (unplaced, factor) => fit(drawn.map(unplaced), (2 / hands.camera.scale) * factor));
        }
        hands.redraw();
    },
    cancel() {
        const had = trail.length > 0;
        trail = [];
        return had;
    },
    draw(context, { camera }) {
        if (trail.length > 1) {
            context.strokeStyle = colours().accent;
            context.lineWidth = 2;
            path(context, ...trail.map((at) => camera.toScreen(at)));
            context.stroke();
            context.lineWidth = 1;
        }
    },
};
