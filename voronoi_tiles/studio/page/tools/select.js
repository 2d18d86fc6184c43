// @ts-check
// Select, move and edit: strokes, and the nodes and handles of those that are selected.

import { addStroke, isSameNode, isSameStroke, moveStrokes, removeStrokes, replaceStroke } from "../model/design.js";
import { joinNodes, shownEnds } from "../model/joining.js";
import { nearestCopy, nearestNode, nearestStroke, nodesIn, strokesIn } from "../model/hit.js";
import { deleteNodes, insertNode, moveNodes, pullHandles, toggleSmooth } from "../model/nodes.js";
import { distance, minus, plus } from "../model/plane.js";
import { rounded } from "../model/snapping.js";
import { entriesOf, nodeRef, shownNodes } from "../scene.js";
import { NOTHING } from "../store.js";
import { colours } from "../view/marks.js";

/** @import { Point, Tool } from "./tool.js" */
/** @import { Design, NodeRef, Ref } from "../model/design.js" */
/** @import { Node } from "../model/nodes.js" */
/** @import { Entry } from "../scene.js" */

/** @param {Ref} ref */
const bare = ({ site, stroke }) => ({ site, stroke });

/**
 * Change the strokes that nodes belong to, each with those of its own.
 * @param {Design} design
 * @param {readonly NodeRef[]} nodes
 * @param {(stroke: any, entry: Entry, nodes: number[]) => any} change
 * @returns {Design}
 */
function changeNodes(design, nodes, change) {
    for (const entry of entriesOf(design)) {
        const own = nodes.filter((node) => isSameStroke(node, entry.ref)).map((node) => node.node);
        if (own.length) {
            design = replaceStroke(
                design,
                entry.ref,
                change(design.site[entry.ref.site].strokes[entry.ref.stroke], entry, own),
            );
        }
    }
    return design;
}

/**
 * A design with the selection moved: its nodes where some are selected, else its strokes.
 * @param {Design} design
 * @param {import("../store.js").Selection} selection
 * @param {Point} by
 * @param {boolean} [alone] whether a smooth node's other handle stays
 * @returns {Design}
 */
export function moved(design, { strokes, nodes }, by, alone = false) {
    if (!nodes.length) {
        return moveStrokes(design, strokes, by);
    }
    return changeNodes(design, nodes, (stroke, entry, own) => {
        const moves = entry.nodes
            .filter((node) => own.includes(node.node))
            .map(({ node, at }) => ({ node, to: plus(at, by) }));
        return moveNodes(stroke, entry.placement, moves, { alone });
    });
}

/**
 * A design without what is selected. Where nodes are, the curve heals over them, or is cut there.
 * @type {(design: Design, selection: import("../store.js").Selection, cut?: boolean) => Design}
 */
export function without(design, { strokes, nodes }, cut = false) {
    if (!nodes.length) {
        return removeStrokes(design, strokes);
    }
    /** @type {Ref[]} */
    const gone = [];
    for (const entry of entriesOf(design)) {
        const own = nodes.filter((node) => isSameStroke(node, entry.ref)).map((node) => node.node);
        if (own.length) {
            const [first, ...rest] = deleteNodes(design.site[entry.ref.site].strokes[entry.ref.stroke], own, { cut });
            if (first) {
                design = replaceStroke(design, entry.ref, first);
            } else {
                gone.push(entry.ref);
            }
            for (const part of rest) {
                design = addStroke(design, entry.ref.site, part);
            }
        }
    }
    return gone.length ? removeStrokes(design, gone) : design;
}

/**
 * What is selected after a click on one thing: it alone, or what was selected where it is among that; with Shift what
 * was selected, with it or without it.
 * @template Thing
 * @param {readonly Thing[]} selected
 * @param {Thing} one
 * @param {(one: Thing, other: Thing) => boolean} same
 * @param {boolean} shift
 * @returns {readonly Thing[]}
 */
function clicked(selected, one, same, shift) {
    if (selected.some((other) => same(other, one))) {
        return shift ? selected.filter((other) => !same(other, one)) : selected;
    }
    return shift ? [...selected, one] : [one];
}

/** @type {{kind: "" | "nodes" | "strokes" | "box" | "pull", from: Point, to: Point, moved: boolean, node: any, add: boolean}} */
const still = { kind: "", from: [0, 0], to: [0, 0], moved: false, node: null, add: false };
let drag = still;

/** The axis that a drag keeps to while Shift is held. @param {Point} by @returns {Point} */
const onAxis = ([dx, dy]) => (Math.abs(dx) > Math.abs(dy) ? [dx, 0] : [0, dy]);

/** @type {Tool} */
export const select = {
    name: "select",
    key: "v",
    title: "Select",
    icon: "select",
    cursor: "default",
    help: "Click a stroke, drag its points (ends of lines and pen curves join). Double click puts in a point, or smooths a corner.",
    down(touch, hands) {
        const { store } = hands;
        const { selection } = store.state;
        const node = nearestNode(shownNodes(hands), touch.raw, touch.reach);
        if (node) {
            const nodes = clicked(selection.nodes, nodeRef(node), isSameNode, touch.shift);
            store.set({ selection: { strokes: selection.strokes, nodes } });
            drag = { ...still, kind: touch.alt && node.role === "anchor" ? "pull" : "nodes", from: node.at, node };
            return;
        }
        const { motions, lattice } = hands.symmetry();
        const own = nearestStroke(hands.entries(), touch.raw, touch.reach);
        const hit = own ?? nearestCopy(hands.entries(), motions, lattice, touch.raw, touch.reach);
        if (hit) {
            const ref = bare(hit.ref);
            const strokes = clicked(selection.strokes, ref, isSameStroke, touch.shift);
            // With Shift the ends that are selected stay so, and the one that is clicked is another: J joins them.
            const kept = touch.shift
                ? selection.nodes.filter((node) => strokes.some((one) => isSameStroke(one, node)))
                : [];
            const ends = kept.length && strokes.includes(ref) ? shownEnds(store.settled, ref) : [];
            const shown = ends.map((node) => ({ ...node, ref }));
            const end = nearestNode(shown, touch.raw, touch.reach);
            store.set({ selection: { strokes, nodes: end ? [...kept, nodeRef(end)] : kept }, site: ref.site });
            // A copy leads to its stroke, which is dragged by itself.
            drag = own ? { ...still, kind: "strokes", from: touch.raw } : still;
            return;
        }
        if (!touch.shift) {
            store.set({ selection: NOTHING });
        }
        drag = { ...still, kind: "box", from: touch.raw, to: touch.raw, add: touch.shift };
    },
    move(touch, hands, held) {
        if (!held || !drag.kind) {
            return;
        }
        const { store } = hands;
        const place = drag.kind === "strokes" ? touch.raw : touch.at;
        drag = { ...drag, to: drag.kind === "box" ? touch.raw : place };
        const far = distance(drag.to, drag.from) > touch.reach / 4;
        if (!drag.moved && !far) {
            return;
        }
        drag.moved = true;
        if (drag.kind === "box") {
            hands.redraw();
            return;
        }
        let by = minus(drag.to, drag.from);
        const { snapped } = touch;
        const onto = drag.kind === "nodes" ? snapped?.onto : null;
        if (touch.shift && !onto) {
            by = onAxis(by);
        }
        if (drag.kind !== "nodes" || !snapped) {
            by = rounded(by, 1 / hands.camera.scale);
        }
        if (drag.kind === "pull") {
            const { node } = drag;
            store.preview((design) =>
                changeNodes(design, [nodeRef(node)], (stroke, entry) =>
                    pullHandles(stroke, entry.placement, node.node, rounded(touch.raw, 1 / hands.camera.scale)),
                ),
            );
        } else {
            const { strokes, nodes } = store.state.selection;
            const selection = { strokes, nodes: drag.kind === "nodes" ? nodes : [] };
            store.preview((design) =>
                onto && isSameStroke(onto, drag.node.ref)
                    ? (joinNodes(design, nodeRef(drag.node), onto)?.design ?? design)
                    : moved(design, selection, by, touch.alt),
            );
        }
    },
    joins(at, reach, { store }) {
        const { nodes } = store.state.selection;
        const { kind, node, from } = drag;
        if (kind !== "nodes" || node.role !== "anchor" || nodes.length !== 1) {
            return null;
        }
        // Who moves a node a little in a crowd does not mean to join it.
        const isNear = (/** @type {Node} */ other) =>
            other.role === "anchor" && distance(other.at, at) <= reach && distance(other.at, from) > reach;
        const near = entriesOf(store.settled)
            .flatMap((entry) => entry.nodes.filter(isNear).map((other) => ({ ...other, ref: entry.ref })))
            .filter((other) => joinNodes(store.settled, nodes[0], nodeRef(other)));
        const onto = nearestNode(near, at, reach);
        return onto && { at: onto.at, kind: "join", label: "joins", onto: nodeRef(onto) };
    },
    up(touch, hands) {
        const { store } = hands;
        const { kind, moved: far, node } = drag;
        if (kind === "box" && far) {
            const [x, y] = [drag.from, touch.raw];
            const box = /** @type {import("../model/plane.js").Box} */ ([
                Math.min(x[0], y[0]),
                Math.min(x[1], y[1]),
                Math.max(x[0], y[0]),
                Math.max(x[1], y[1]),
            ]);
            const old = drag.add ? store.state.selection : NOTHING;
            const nodes = nodesIn(shownNodes(hands), box);
            const strokes = strokesIn(hands.entries(), box).filter(
                (ref) => !old.strokes.some((other) => isSameStroke(other, ref)),
            );
            store.set({
                selection:
                    nodes.length && old.strokes.length
                        ? { strokes: old.strokes, nodes: [...old.nodes, ...nodes] }
                        : { strokes: [...old.strokes, ...strokes], nodes: [] },
            });
        } else if (far && store.state.dragging) {
            const onto = kind === "nodes" && touch.snapped?.onto;
            const joined = onto && joinNodes(store.settled, nodeRef(node), onto);
            if (joined) {
                store.edit(() => joined.design, { selection: { strokes: [joined.ref], nodes: [] } });
            } else {
                const { design } = store.state;
                store.edit(() => design);
            }
        }
        drag = still;
        hands.redraw();
    },
    twice(touch, hands) {
        const { store } = hands;
        const node = nearestNode(shownNodes(hands), touch.raw, touch.reach);
        if (node && node.role === "anchor") {
            store.edit((design) => changeNodes(design, [nodeRef(node)], (stroke) => toggleSmooth(stroke, node.node)));
            return;
        }
        const hit = nearestStroke(hands.entries(), touch.raw, touch.reach);
        if (hit) {
            store.edit(
                (design) =>
                    replaceStroke(
                        design,
                        bare(hit.ref),
                        // As finely that a straight line stays one to the eye.
                        insertNode(
                            design.site[hit.ref.site].strokes[hit.ref.stroke],
                            hit.piece,
                            hit.t,
                            touch.reach / 1000,
                        ),
                    ),
                { selection: { strokes: [bare(hit.ref)], nodes: [] } },
            );
        }
    },
    cancel(hands) {
        const { store } = hands;
        if (drag.kind && drag.moved) {
            drag = still;
            store.cancel();
            return true;
        }
        const { selection } = store.state;
        if (selection.nodes.length || selection.strokes.length) {
            store.set({ selection: selection.nodes.length ? { strokes: selection.strokes, nodes: [] } : NOTHING });
            return true;
        }
        return false;
    },
    draw(context, { camera }) {
        if (drag.kind === "box" && drag.moved) {
            const [a, b] = [camera.toScreen(drag.from), camera.toScreen(drag.to)];
            context.strokeStyle = colours().accent;
            context.setLineDash([4, 3]);
            context.strokeRect(a[0], a[1], b[0] - a[0], b[1] - a[1]);
            context.setLineDash([]);
        }
    },
};
