// @ts-check
// What lies over the picture: the cell, symmetry elements, the grid, strokes and their nodes, and what a tool shows.

import { Kept } from "../model/kept.js";
import { reducedBasis } from "../gl/pattern.js";
import { apply, minus, plus } from "../model/plane.js";
import { isSameNode, isSameStroke } from "../model/design.js";
import { cartesian } from "../model/lattice.js";
import { elementsIn, regionOf } from "../model/symmetry.js";
import { boxOf, nodeRef, shownNodes } from "../scene.js";
import { colours, line, path, ring } from "./marks.js";
import { near } from "./outlines.js";
import { roundedScale, screenPath } from "./paths.js";

/** @import { Hands, Point } from "../tools/tool.js" */
/** @import { Toolbox } from "../tools/toolbox.js" */
/** @typedef {CanvasRenderingContext2D} Context */

const COPIES_MAX = 300;

/**
 * A rotation centre of an order, as the International Tables draw it, added to a path.
 * @param {Path2D} path
 * @param {Point} at
 * @param {number} order
 */
function centre(path, [x, y], order) {
    const r = order === 2 ? 5 : 6;
    if (order === 2) {
        path.moveTo(x + 3, y);
        path.ellipse(x, y, 3, r, 0, 0, 2 * Math.PI);
    } else {
        for (let k = 0; k < order; ++k) {
            const turn = (2 * Math.PI * k) / order - Math.PI / 2 + (order === 4 ? Math.PI / 4 : 0);
            path[k ? "lineTo" : "moveTo"](x + r * Math.cos(turn), y + r * Math.sin(turn));
        }
        path.closePath();
    }
}

/** @typedef {{centres: Path2D, mirrors: Path2D, glides: Path2D}} Elements paths in the window */
/** @type {Kept<Elements | null>} the same while strokes are dragged */
const keptElements = new Kept();

/**
 * The symmetry elements in the window, null where they are too many.
 * @param {Hands} hands
 * @returns {Elements | null}
 */
function elementPaths({ store, camera }) {
    const { design, tables } = store.state;
    const found = elementsIn(design, tables, camera.box);
    if (found.mirrors.length + found.glides.length > 400 || found.centres.length > 1500) {
        return null;
    }
    const lines = (/** @type {(readonly [Point, Point])[]} */ pairs) => {
        const path = new Path2D();
        for (const [from, to] of pairs) {
            path.moveTo(...camera.toScreen(from));
            path.lineTo(...camera.toScreen(to));
        }
        return path;
    };
    const centres = new Path2D();
    for (const { at, order } of found.centres) {
        centre(centres, camera.toScreen(at), order);
    }
    return { centres, mirrors: lines(found.mirrors), glides: lines(found.glides) };
}

/**
 * @param {Context} context
 * @param {Hands} hands
 * @param {ReturnType<typeof colours>} colour
 */
function symmetry(context, hands, colour) {
    const { store, camera } = hands;
    const { design, tables, shown } = store.state;
    const { lattice } = hands.symmetry();
    const elements = keptElements.get([lattice, tables, camera.scale, ...camera.box], () => elementPaths(hands));
    if (!elements) {
        return;
    }
    if (shown.region) {
        const region = regionOf(design, tables);
        context.globalAlpha = 0.1;
        context.fillStyle = colour.accent;
        path(context, ...region.map((at) => camera.toScreen(at)));
        context.fill();
        context.globalAlpha = 1;
    }
    context.strokeStyle = colour.accent;
    context.globalAlpha = 0.75;
    context.stroke(elements.mirrors);
    context.setLineDash([7, 5]);
    context.stroke(elements.glides);
    context.setLineDash([]);
    context.globalAlpha = 1;
    context.fillStyle = colour.accent;
    context.strokeStyle = colour.panel;
    context.fill(elements.centres);
    context.stroke(elements.centres);
}

/**
 * @param {Context} context
 * @param {Hands} hands
 * @param {ReturnType<typeof colours>} colour
 */
function grid(context, { camera }, colour) {
    let step = 1;
    while (step * camera.scale < 12) {
        step *= 10;
    }
    const [x0, y0, x1, y1] = camera.box;
    context.strokeStyle = colour.line;
    for (const [first, last, axis] of [
        [x0, x1, 0],
        [y0, y1, 1],
    ]) {
        for (let k = Math.ceil(first / step); k <= last / step; ++k) {
            context.globalAlpha = k % 10 ? 0.35 : 0.9;
            const from = camera.toScreen(axis ? [x0, k * step] : [k * step, y0]);
            line(context, from, camera.toScreen(axis ? [x1, k * step] : [k * step, y1]));
        }
    }
    context.globalAlpha = 1;
}

/** @type {Kept<Path2D[]>} the strokes, and their copies below: the same while outlines come */
const keptPaths = new Kept();
/** @type {Kept<Path2D>} */
const keptCopies = new Kept();

/**
 * The copies of strokes in the window; none where they are too many.
 * @param {import("../scene.js").Entry[]} entries
 * @param {Path2D[]} paths of these
 * @param {import("../model/symmetry.js").Motion[]} motions
 * @param {import("../model/lattice.js").Lattice} lattice
 * @param {import("./camera.js").Camera} camera
 */
function copiesOf(entries, paths, motions, lattice, camera) {
    const [once, copies] = [new Path2D(), new Path2D()];
    const [basis, box] = [reducedBasis(lattice), boxOf(entries)];
    if (!basis || !box) {
        return copies;
    }
    paths.forEach((path) => once.addPath(path));
    const [x0, y0, x1, y1] = box;
    let count = 0;
    for (const motion of motions) {
        const { a, b, conj } = motion;
        const sign = conj ? -1 : 1;
        const middle = apply(motion, [(x0 + x1) / 2, (y0 + y1) / 2]);
        for (const at of near(basis, camera, middle, Math.hypot(x1 - x0, y1 - y0) / 2)) {
            if (count++ === COPIES_MAX) {
                return new Path2D();
            }
            const [x, y] = plus(b, cartesian({ a: basis.p, b: basis.q }, at));
            copies.addPath(once, new DOMMatrix([a[0], a[1], -sign * a[1], sign * a[0], x, y]));
        }
    }
    return copies;
}

/**
 * The copies of the strokes, faint, and the strokes themselves, two-toned so that they show on any colour.
 * @param {Context} context
 * @param {Hands} hands
 * @param {import("../model/symmetry.js").Motion[]} motions
 * @param {import("../model/lattice.js").Lattice} lattice
 * @param {ReturnType<typeof colours>} colour
 */
function strokes(context, hands, motions, lattice, colour) {
    const { camera, store, entries } = hands;
    const { selection, shown, site } = store.state;
    const all = entries();
    const pixel = 1 / camera.scale;
    const finest = roundedScale(camera.scale);
    const paths = keptPaths.get([finest, ...all.map(({ cubics }) => cubics)], () =>
        all.map(({ cubics }) => screenPath(cubics, finest)),
    );
    context.save();
    context.lineCap = context.lineJoin = "round";
    if (shown.copies) {
        camera.apply(context);
        context.globalAlpha = 0.3;
        context.strokeStyle = colour.text;
        context.lineWidth = pixel;
        context.stroke(
            keptCopies.get([paths, motions, lattice, ...camera.box], () =>
                copiesOf(all, paths, motions, lattice, camera),
            ),
        );
        context.globalAlpha = 1;
    }
    camera.apply(context);
    for (const [k, entry] of all.entries()) {
        const own = paths[k];
        const chosen = selection.strokes.some((ref) => isSameStroke(ref, entry.ref));
        context.strokeStyle = colour.panel;
        context.lineWidth = (entry.kind === "point" ? 8 : 4.5) * pixel;
        context.stroke(own);
        context.globalAlpha = entry.ref.site === site || all.length < 2 ? 1 : 0.8;
        context.strokeStyle = chosen ? colour.accent : colour.text;
        context.lineWidth = (entry.kind === "point" ? 6 : chosen ? 2.6 : 2) * pixel;
        context.stroke(own);
        context.globalAlpha = 1;
    }
    context.restore();
}

/**
 * @param {Context} context
 * @param {Hands} hands
 * @param {ReturnType<typeof colours>} colour
 */
function nodes(context, hands, colour) {
    const { camera, store } = hands;
    const { selection } = store.state;
    const shown = shownNodes(hands);
    context.strokeStyle = colour.accent;
    context.beginPath();
    for (const node of shown) {
        if (node.role === "in" || node.role === "out" || node.role === "radius") {
            const anchor = shown.find((other) => other.node === node.of && other.ref === node.ref);
            if (anchor) {
                context.moveTo(...camera.toScreen(anchor.at));
                context.lineTo(...camera.toScreen(node.at));
            }
        }
    }
    context.stroke();
    const [others, chosen] = [new Path2D(), new Path2D()];
    for (const node of shown) {
        const [x, y] = camera.toScreen(node.at);
        const marks = selection.nodes.some((ref) => isSameNode(ref, nodeRef(node))) ? chosen : others;
        if (node.role === "anchor" && !node.smooth) {
            marks.rect(x - 4, y - 4, 8, 8);
        } else {
            const radius = node.role === "anchor" || node.role === "centre" ? 4.5 : 3.5;
            marks.moveTo(x + radius, y);
            marks.arc(x, y, radius, 0, 2 * Math.PI);
        }
    }
    for (const marks of [others, chosen]) {
        context.fillStyle = marks === chosen ? colour.accent : colour.panel;
        context.fill(marks);
        context.stroke(marks);
    }
}

/**
 * Draw all that lies over the picture.
 * @param {Context} context
 * @param {Hands} hands
 * @param {Toolbox} toolbox
 * @param {import("../model/symmetry.js").Motion[]} motions
 * @param {import("../model/lattice.js").Lattice} lattice
 */
export function drawOverlay(context, hands, toolbox, motions, lattice) {
    const { camera, store } = hands;
    const { shown, refusal } = store.state;
    const colour = colours();
    context.setTransform(camera.ratio, 0, 0, camera.ratio, 0, 0);
    context.lineWidth = 1;
    if (shown.grid) {
        grid(context, hands, colour);
    }
    if (shown.cell) {
        const { a, b } = lattice;
        context.strokeStyle = colour.quiet;
        path(context, ...[minus(a, a), a, plus(a, b), b].map((at) => camera.toScreen(at)));
        context.closePath();
        context.stroke();
    }
    if (shown.elements) {
        symmetry(context, hands, colour);
    }
    strokes(context, hands, motions, lattice, colour);
    nodes(context, hands, colour);
    if (refusal?.error.at) {
        context.strokeStyle = colour.bad;
        context.lineWidth = 2.5;
        ring(context, camera.toScreen(refusal.error.at), 12);
        context.stroke();
        context.lineWidth = 1;
    }
    toolbox.tool.draw?.(context, hands);
    if (toolbox.snapped && (toolbox.tool.draws || toolbox.snapped.kind === "join")) {
        const [x, y] = camera.toScreen(toolbox.snapped.at);
        context.strokeStyle = colour.accent;
        context.strokeRect(x - 6, y - 6, 12, 12);
        context.fillStyle = colour.text;
        context.font = "12px system-ui, sans-serif";
        context.fillText(toolbox.snapped.label, x + 11, y - 9);
    }
    if (toolbox.cross) {
        const [x, y] = camera.toScreen(toolbox.cross);
        context.strokeStyle = colour.text;
        line(context, [x - 12, y], [x + 12, y]);
        line(context, [x, y - 12], [x, y + 12]);
    }
}
