/** Undo and redo: through whatever edits, each design comes back with the same bytes. */

import assert from "node:assert/strict";
import { test } from "node:test";

import * as edits from "../../../voronoi_tiles/studio/page/model/design.js";
import { History } from "../../../voronoi_tiles/studio/page/model/history.js";
import {
    deleteNodes,
    insertNode,
    moveNodes,
    nodesOf,
    penStroke,
    pullHandles,
    toggleSmooth,
} from "../../../voronoi_tiles/studio/page/model/nodes.js";
import { cubicsOf, placementOf } from "../../../voronoi_tiles/studio/page/model/strokes.js";
import { setGroup } from "../../../voronoi_tiles/studio/page/model/regroup.js";
import { PLACEMENTS, STROKES, allStrokes, frozen, random } from "./helpers.js";

/** How many random stories are told; the slow test asks for 10,000. */
const STORIES = Number(process.env.VORONOI_TILES_STORIES ?? 250);

const square = [
    [0, 0],
    [0.5, 0],
    [0.5, 0.5],
    [0, 0.5],
];
const identity = { name: "x,y", w: [1, 0, 0, 1], t: [0, 0] };
const TABLES = frozen({
    groups: [
        {
            name: "p1",
            free: ["a", "b", "angle"],
            angle: null,
            operations: [identity],
            region: [
                [0, 0],
                [1, 0],
                [1, 1],
                [0, 1],
            ],
        },
        {
            name: "p4",
            free: ["a"],
            angle: 90,
            region: square,
            operations: [
                identity,
                ...[
                    [-1, 0, 0, -1],
                    [0, -1, 1, 0],
                    [0, 1, -1, 0],
                ].map((w) => ({ name: "", w, t: [0, 0] })),
            ],
        },
    ],
});

const START = frozen({
    schema: 1,
    group: "p1",
    cell: { a: 60, b: 50, angle: 75 },
    site: [{ strokes: [] }],
    unknown: [1],
});

/** A random edit of a design: what it makes of it. */
function edited(design, chance) {
    const pick = (list) => list[Math.floor(chance() * list.length)];
    const point = () => [60 * chance() - 20, 50 * chance() - 10];
    const refs = allStrokes(design);
    const ref = refs.length ? pick(refs) : null;
    const site = Math.floor(chance() * design.site.length);
    const ofStroke = (change) => {
        if (!ref) return design;
        const stroke = edits.strokeAt(design, ref);
        const placement = placementOf(design.site[ref.site], stroke);
        const nodes = nodesOf(stroke, placement);
        return nodes.length ? edits.replaceStroke(design, ref, change(stroke, placement, pick(nodes))) : design;
    };
    const choices = [
        () => edits.addStroke(design, site, { ...pick(STROKES), ...pick(PLACEMENTS)[1] }),
        () =>
            edits.addStroke(
                design,
                site,
                penStroke(
                    [0, 1, 2].map(() => ({ at: point(), in: point(), out: point() })),
                    placementOf(design.site[site], {}),
                ),
            ),
        () =>
            edits.moveStrokes(
                design,
                refs.filter(() => chance() < 0.5),
                point(),
            ),
        () =>
            edits.removeStrokes(
                design,
                refs.filter(() => chance() < 0.3),
            ),
        () =>
            ofStroke((stroke, placement, { node }) =>
                moveNodes(stroke, placement, [{ node, to: point() }], { alone: chance() < 0.5 }),
            ),
        () => ofStroke((stroke, placement, { node }) => pullHandles(stroke, placement, node, point())),
        () => ofStroke((stroke, _, { node }) => toggleSmooth(stroke, node)),
        () => ofStroke((stroke, _, { node }) => deleteNodes(stroke, [node], { cut: chance() < 0.5 })),
        () => ofStroke((stroke) => insertNode(stroke, Math.floor((chance() * cubicsOf(stroke).length) / 8), chance())),
        () => edits.setCell(design, { a: 30 + 60 * chance(), extra: chance() < 0.5 ? 1 : undefined }),
        () => edits.setUnits(design, pick(["mm", "cm", "in"]), chance() < 0.5),
        () => (chance() < 0.3 ? setGroup(design, pick(["p1", "p4"]), TABLES).design : design),
        () => (design.site.length < 3 ? edits.addSite(design) : edits.removeSite(design, site)),
        () => edits.renameSite(design, site, pick(["bird", "fish", "Vögel"])),
        () => edits.withSite(design, site, (old) => ({ ...old, ...pick(PLACEMENTS)[0] })),
    ];
    return frozen(pick(choices)());
}

test(`${STORIES} random stories of edits, undo and redo come back to the same bytes`, () => {
    let taken = 0;
    for (let story = 0; story < STORIES; story++) {
        const chance = random(story + 1);
        const history = new History(START);
        // What must be there, in the simplest way: the texts of all designs, and where we are.
        let texts = [JSON.stringify(START)];
        let now = 0;
        let merging = false;
        for (let step = 0; step < 25; step++) {
            const what = chance();
            if (what < 0.6) {
                const before = history.design;
                const design = edited(before, chance);
                const merge = chance() < 0.2 ? "nudge" : undefined;
                history.push(design, merge);
                if (design !== before) {
                    if (!(merging && merge)) now++;
                    texts = [...texts.slice(0, now), JSON.stringify(design)];
                    merging = merge !== undefined;
                    taken++;
                }
            } else if (what < 0.85) {
                history.undo();
                now = Math.max(0, now - 1);
                merging = false;
            } else {
                history.redo();
                now = Math.min(texts.length - 1, now + 1);
                merging = false;
            }
            assert.equal(JSON.stringify(history.design), texts[now], `story ${story}, step ${step}`);
            assert.deepEqual([history.canUndo, history.canRedo], [now > 0, now < texts.length - 1]);
        }
        while (history.canUndo) assert.equal(JSON.stringify(history.undo()), texts[--now]);
        assert.equal(history.design, START);
        while (history.canRedo) assert.equal(JSON.stringify(history.redo()), texts[++now]);
        assert.equal(now, texts.length - 1);
    }
    assert.ok(taken > 8 * STORIES);
});

test("edits of one kind in a row are one step, unless undo or another edit comes between", () => {
    const [one, two, three, four] = [1, 2, 3, 4].map((a) => ({ ...START, cell: { a } }));
    const history = new History(START);
    history.push(one, "nudge");
    history.push(two, "nudge");
    assert.equal(history.undo(), START);
    assert.equal(history.redo(), two);
    history.push(three, "nudge");
    history.push(three, "nudge");
    assert.equal(history.undo(), two);
    history.push(four, "other");
    history.push(one, "nudge");
    assert.equal(history.canRedo, false);
    assert.deepEqual([history.undo(), history.undo(), history.undo(), history.undo()], [four, two, START, START]);
});
