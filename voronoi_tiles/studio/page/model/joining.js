// @ts-check
/** A node laid onto another: what closes a stroke, makes one of two, or takes the node out. */

import { chainsOf, isClosed, numbered, strokesOf, withKind } from "./chains.js";
import { isSameNode, isSameStroke, mapPoints, removeStrokes, replaceStroke, strokeAt } from "./design.js";
import { nodesOf } from "./nodes.js";
import { apply, compose, distance, inverse, minus, same, tidyPlus } from "./plane.js";
import { deleteNodes } from "./reshaping.js";
import { kindOf, placementIn, placementOf, pointsOf, tangentsOf } from "./strokes.js";

/** @import { Point } from "./plane.js" */
/** @import { Design, NodeRef, Ref, Stroke } from "./design.js" */
/** @typedef {{strokes: readonly Ref[], nodes: readonly NodeRef[]}} Selection */

/** @typedef {{anchors: number[], closed: boolean}} Run the numbers of the anchors along a curve */
/** @typedef {{design: Design, ref: Ref}} Joined the design, and the stroke that was made */

/** The fewest points of a closed stroke whose points are listed. */
const LEAST_CLOSED = 3;

/** Whether a stroke is made of lines from point to point. @type {(stroke: Stroke) => boolean} */
const isStraight = (stroke) => ["segment", "polyline"].includes(kindOf(stroke));

/** Whether a stroke's own pieces are Bezier curves. @type {(stroke: Stroke) => boolean} */
const isChain = (stroke) => ["bezier", "hermite", "path"].includes(kindOf(stroke));

/**
 * The curves of a stroke as runs of anchors; none for points, circles and drawings.
 * @type {(stroke: Stroke) => Run[]}
 */
function runsOf(stroke) {
    if (isChain(stroke)) {
        return numbered(chainsOf(stroke)).map(({ chain, offset }) => {
            const closed = isClosed(chain);
            const count = (chain.length - 1) / 3 + (closed ? 0 : 1);
            return { anchors: Array.from({ length: count }, (_, k) => offset + 3 * k), closed };
        });
    }
    if (!isStraight(stroke) && !["catmull_rom", "bspline"].includes(kindOf(stroke))) return [];
    return [{ anchors: pointsOf(stroke).map((_, k) => k), closed: stroke.closed ?? false }];
}

/**
 * The design after one node was laid onto another of the same site; null where that joins nothing.
 *
 * An end laid onto the other end of its stroke closes it; onto the end of another stroke, the two become one, which
 * keeps the place and the keys of that other one: a `polyline` of straight strokes, else a `bezier`. With `bridged` a
 * line leads from end to end of the two instead. A node laid onto its neighbour is taken out. The shapes stay, but where
 * the node was moved.
 * @param {Design} design
 * @param {NodeRef} from what is laid
 * @param {NodeRef} onto what stays where it is
 * @param {boolean} [bridged]
 * @returns {Joined | null}
 */
export function joinNodes(design, from, onto, bridged = false) {
    const [stroke, other] = [strokeAt(design, from), strokeAt(design, onto)];
    if (!stroke || !other || from.site !== onto.site) return null;
    const alone = isSameStroke(from, onto);
    const made = alone
        ? joinedWithin(stroke, from.node, onto.node)
        : joinedTo(stroke, from.node, other, onto.node, bridged);
    if (!made) return null;
    const replaced = replaceStroke(design, onto, made);
    const shift = !alone && from.stroke < onto.stroke ? 1 : 0;
    return {
        design: alone ? replaced : removeStrokes(replaced, [from]),
        ref: { site: onto.site, stroke: onto.stroke - shift },
    };
}

/**
 * A stroke with one of its nodes laid onto another: closed, or without the node; null where neither can be.
 * @type {(stroke: Stroke, from: number, onto: number) => Stroke | null}
 */
function joinedWithin(stroke, from, onto) {
    const run = runsOf(stroke).find(({ anchors }) => anchors.includes(from) && anchors.includes(onto));
    if (!run || from === onto) return null;
    const last = run.anchors.length - 1;
    const apart = Math.abs(run.anchors.indexOf(from) - run.anchors.indexOf(onto));
    if (apart === 1 || (run.closed && apart === last)) {
        const left = deleteNodes(stroke, [from]);
        return left.length === 1 ? left[0] : null;
    }
    if (run.closed || apart !== last) return null;
    if (kindOf(stroke) === "hermite") {
        const to = pointsOf(stroke)[onto / 3];
        return mapPoints(stroke, (point, k) => (3 * k === from ? to : point));
    }
    if (isChain(stroke)) {
        const chains = numbered(chainsOf(stroke)).map(({ chain, offset }) => {
            const [end, to] = [from - offset, onto - offset];
            if (!chain[end] || !chain[to]) return chain;
            const inward = end ? end - 1 : 1;
            return chain.map((point, k) =>
                k === end ? chain[to] : k === inward ? carried(point, chain[end], chain[to]) : point,
            );
        });
        return strokesOf(stroke, chains)[0];
    }
    const points = pointsOf(stroke).filter((_, k) => k !== from);
    return points.length < LEAST_CLOSED ? null : { ...stroke, [kindOf(stroke)]: points, closed: true };
}

/** A handle that goes along with its anchor. @type {(handle: Point, from: Point, to: Point) => Point} */
const carried = (handle, from, to) => (same(handle, from) ? to : tidyPlus(handle, minus(to, from)));

/**
 * Two strokes of a site as one, the end of the first laid onto that of the second, or `bridged`; null where they cannot
 * be, and where a line would lead there and back.
 * @type {(stroke: Stroke, from: number, other: Stroke, onto: number, bridged: boolean) => Stroke | null}
 */
function joinedTo(stroke, from, other, onto, bridged) {
    if (![stroke, other].every((one) => isStraight(one) || isChain(one))) return null;
    const ends = [endsOf(stroke), endsOf(other)];
    if (!ends[0].includes(from) || !ends[1].includes(onto)) return null;
    const straight = isStraight(stroke) && isStraight(other);
    const map = compose(inverse(placementIn(other)), placementIn(stroke));
    const [moving, kept] = [stroke, other].map((one) => [...(straight ? pointsOf(one) : chainsOf(one)[0])]);
    // From the start of the one that stays, through where they meet, to the end of the one that comes.
    if (from) moving.reverse();
    if (!onto) kept.reverse();
    const laid = moving.map((point) => apply(map, point));
    const joint = kept[kept.length - 1];
    const meets = straight ? [] : [carried(laid[1], laid[0], joint), laid[2], laid[3]];
    const bridge = straight ? [laid[0]] : [joint, laid[0], ...laid.slice(0, 4)];
    if ((straight || !bridged) && same(laid[straight ? 1 : 3], joint)) return null;
    if (bridged && straight && same(kept[kept.length - 2], laid[0])) return null;
    const points = [...kept, ...(bridged ? bridge : meets), ...laid.slice(straight ? 1 : 4)];
    if (!onto) points.reverse();
    const made = withKind(other, straight ? "polyline" : "bezier", points);
    return straight && isClosed(points) && points.length > LEAST_CLOSED
        ? { ...made, polyline: points.slice(0, -1), closed: true }
        : made;
}

/**
 * A stroke whose end leads back to its start, all points as they are: on a line, but as its kind has it where that runs
 * through points; null where that would be a line there and back.
 * @param {Stroke} stroke open, of one curve
 * @returns {Stroke | null}
 */
function closedStroke(stroke) {
    const kind = kindOf(stroke);
    const points = pointsOf(stroke);
    if (!isChain(stroke)) return points.length < LEAST_CLOSED ? null : { ...stroke, closed: true };
    const [chain] = chainsOf(stroke);
    const [start, end] = [chain[0], chain[chain.length - 1]];
    if (chain.length === 4 && same(start, chain[1]) && same(chain[2], end)) return null;
    if (kind === "hermite") {
        const tangents = tangentsOf(stroke);
        return { ...stroke, hermite: [...points, points[0]], tangents: [...tangents, tangents[0]] };
    }
    return strokesOf(stroke, [[...chain, end, start, start]])[0];
}

/** The nodes at both ends of an open stroke of one curve, the first 0; none of others. @type {(s: Stroke) => number[]} */
function endsOf(stroke) {
    const [run, ...others] = runsOf(stroke);
    const last = run?.anchors[run.anchors.length - 1];
    return last && !run.closed && !others.length ? [0, last] : [];
}

/**
 * The nodes at both ends of an open stroke of one curve, the first one first; none of others.
 * @param {Design} design
 * @param {Ref} ref
 */
export function shownEnds(design, { site, stroke }) {
    const found = strokeAt(design, { site, stroke });
    const numbers = found ? endsOf(found) : [];
    const shown = found && numbers.length ? nodesOf(found, placementOf(design.site[site], found)) : [];
    return shown.filter(({ node }) => numbers.includes(node)).map((node) => ({ ...node, site, stroke }));
}

/**
 * The design with an open stroke closed; null where it cannot be. Ends that meet become one.
 * @param {Design} design
 * @param {Ref} ref
 * @param {number} reach how far apart ends are that meet
 * @returns {Joined | null}
 */
function closeStroke(design, ref, reach) {
    const [start, end] = shownEnds(design, ref);
    if (!start) return null;
    const met = distance(start.at, end.at) <= reach ? joinNodes(design, end, start) : null;
    const { site, stroke } = ref;
    const made = closedStroke(design.site[site].strokes[stroke]);
    return met ?? (made && { design: replaceStroke(design, ref, made), ref: { site, stroke } });
}

/**
 * The design with what is selected joined: two nodes; else one stroke closed, or of two strokes the ends that are nearest
 * to each other, of one that has an end selected that end. Null where nothing can be, and of more strokes.
 * @param {Design} design
 * @param {Selection} selection
 * @param {number} [reach] how far apart ends are of which one is laid onto the other: from others a line leads there
 * @returns {Joined | null}
 */
export function joinSelected(design, { strokes, nodes }, reach = 0) {
    const isChosen = (/** @type {NodeRef} */ end) => nodes.some((node) => isSameNode(node, end));
    if (nodes.length === 2) {
        const isOne = shownEnds(design, nodes[0]).filter(isChosen).length === 2;
        if (isOne) return closeStroke(design, nodes[0], reach);
        const [from, onto] = nodes.map((node) => shownEnds(design, node).find(isChosen));
        const isFar = from && onto && !isSameStroke(from, onto) && distance(from.at, onto.at) > reach;
        return joinNodes(design, nodes[0], nodes[1], isFar);
    }
    if (strokes.length === 1) return closeStroke(design, strokes[0], reach);
    if (strokes.length !== 2) return null;
    const [onto, from] = strokes.map((ref) => {
        const ends = shownEnds(design, ref);
        return ends.some(isChosen) ? ends.filter(isChosen) : ends;
    });
    return onto
        .flatMap((to) => from.map((end) => ({ end, to, apart: distance(end.at, to.at) })))
        .sort((one, other) => one.apart - other.apart)
        .reduce(
            (found, { end, to, apart }) => found ?? joinNodes(design, end, to, apart > reach),
            /** @type {Joined | null} */ (null),
        );
}

/** Why `joinSelected` joins nothing, and what to do. @type {(design: Design, selection: Selection) => string} */
export function whyNotJoined(design, { strokes, nodes }) {
    const refs = nodes.length === 2 ? nodes : strokes;
    if (refs.length === 2 && refs[0].site !== refs[1].site) {
        return "These strokes are of two sites: the list of strokes has a field that gives one to the other's site.";
    }
    const joins = (/** @type {Stroke | undefined} */ stroke) => stroke && (isStraight(stroke) || isChain(stroke));
    if (refs.length === 2 && !refs.every((ref) => joins(strokeAt(design, ref)))) {
        return "Curves through points, B-splines, circles, points and drawings join no others: lines, pen curves and SVG paths do.";
    }
    return "Select an open stroke of three points or more, or two open strokes of one site, or an end of each with Shift.";
}
