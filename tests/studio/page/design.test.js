/** Edits of designs: what they change, and that they change nothing else. */

import assert from "node:assert/strict";
import { test } from "node:test";

import * as edits from "../../../voronoi_tiles/studio/page/model/design.js";
import { cubicsOf, placementOf } from "../../../voronoi_tiles/studio/page/model/strokes.js";
import { allStrokes, assertNear, frozen } from "./helpers.js";

const DESIGN = frozen({
    schema: 1,
    group: "p1",
    units: "mm",
    scale: 1.5,
    cell: { a: 60, b: 50, angle: 75, note: "kept" },
    site: [
        {
            name: "bird",
            tolerance: 0.01,
            rotate: 30,
            scale: 2,
            translate: [1, 2],
            strokes: [
                {
                    segment: [
                        [5, 3],
                        [25, 11],
                    ],
                },
                { circle: [0.1, 0.2], radius: 2, weight: 3 },
                { path: "M 1 1 L 2 3" },
                {
                    hermite: [
                        [0, 0],
                        [4, 0],
                    ],
                    tangents: [
                        [3, 6],
                        [3, -6],
                    ],
                    mirror: true,
                    rotate: 10,
                },
            ],
            art: { file: "face.svg", translate: [25.4, 0] },
        },
        { strokes: [{ point: [1, 2] }] },
    ],
    unknown: { kept: true },
});

const drawn = (design, site, stroke) => [
    ...cubicsOf(design.site[site].strokes[stroke], placementOf(design.site[site], design.site[site].strokes[stroke])),
];

test("strokes are added, replaced and removed, and the rest is shared", () => {
    const more = edits.addStroke(DESIGN, 1, { point: [3, 4] });
    assert.deepEqual(more.site[1].strokes, [{ point: [1, 2] }, { point: [3, 4] }]);
    assert.equal(more.site[0], DESIGN.site[0]);
    assert.equal(more.unknown, DESIGN.unknown);
    const two = edits.replaceStroke(DESIGN, { site: 0, stroke: 1 }, [{ point: [0, 0] }, { point: [1, 1] }]);
    assert.deepEqual(
        two.site[0].strokes.map((stroke) => Object.keys(stroke)[0]),
        ["segment", "point", "point", "path", "hermite"],
    );
    const gone = [
        { site: 1, stroke: 0 },
        { site: 0, stroke: 0 },
        { site: 0, stroke: 2 },
        { site: 0, stroke: 0 },
    ];
    assert.deepEqual(
        edits.removeStrokes(DESIGN, gone).site.map((site) => site.strokes.length),
        [2, 0],
    );
    assert.equal(edits.addStroke(DESIGN, 7, { point: [3, 4] }), DESIGN);
    assert.equal(allStrokes(DESIGN).length, 5);
});

test("strokes move by the vector, however they and their sites are placed", () => {
    const moved = edits.moveStrokes(DESIGN, allStrokes(DESIGN), [0.3, -7]);
    for (const { site, stroke } of allStrokes(DESIGN)) {
        assertNear(
            drawn(moved, site, stroke),
            drawn(DESIGN, site, stroke).map((value, k) => value + (k % 2 ? -7 : 0.3)),
        );
    }
    const keys = moved.site[0].strokes.map((stroke) => Object.keys(stroke).join());
    assert.deepEqual(keys, [
        "segment",
        "circle,radius,weight",
        "path,translate",
        "hermite,tangents,mirror,rotate,translate",
    ]);
});

test("what moves there and back is written as before", () => {
    const plain = frozen({
        ...DESIGN,
        site: [
            {
                strokes: [
                    {
                        polyline: [
                            [0.1, 1000.7],
                            [12.345678, -0.003],
                            [1e-9, 7],
                        ],
                    },
                ],
            },
        ],
    });
    let design = plain;
    for (const step of [0.1, 0.2, 33.3, -0.7])
        design = edits.moveStrokes(design, [{ site: 0, stroke: 0 }], [step, 0.3]);
    assert.equal(design.site[0].strokes[0].polyline[1][0], 45.245678);
    for (const step of [0.1, 0.2, 33.3, -0.7])
        design = edits.moveStrokes(design, [{ site: 0, stroke: 0 }], [-step, -0.3]);
    assert.deepEqual(design, plain);
});

test("sites are added, renamed and removed", () => {
    const more = edits.addSite(edits.addSite(edits.renameSite(DESIGN, 0, " site3 ")));
    assert.deepEqual(edits.siteNames(more), ["site3", "site2", "site4", "site5"]);
    assert.deepEqual(edits.siteNames(edits.removeSite(more, 0)), ["site1", "site4", "site5"]);
    assert.equal(edits.nameProblem(more, 2, "site2"), "Another site has the name “site2”.");
    assert.equal(edits.nameProblem(more, 1, "site2"), null);
    for (const name of ["", "  ", "a\nb", "a\u200bb", "x".repeat(101)])
        assert.notEqual(edits.nameProblem(more, 0, name), null);
    assert.equal(edits.nameProblem(more, 0, "Vögel 7"), null);
});

test("a cell takes and loses keys", () => {
    assert.deepEqual(edits.setCell(DESIGN, { a: 61, b: undefined }).cell, { a: 61, angle: 75, note: "kept" });
});

test("units change by name alone, or with all lengths so that the size stays", () => {
    assert.deepEqual(edits.setUnits(DESIGN, "in", false), { ...DESIGN, units: "in" });
    const inches = edits.setUnits(DESIGN, "in", true);
    assertNear([inches.site[0].tolerance], [0.01 / 25.4]);
    assert.deepEqual(inches.site[0].art, { file: "face.svg", translate: [1, 0] });
    assert.equal(inches.scale, 1.5);
    for (const { site, stroke } of allStrokes(DESIGN)) {
        assertNear(
            drawn(inches, site, stroke).map((value) => value * 25.4),
            drawn(DESIGN, site, stroke),
        );
    }
    assert.deepEqual(edits.setUnits(edits.setUnits(DESIGN, "cm", true), "mm", true).cell, DESIGN.cell);
    assert.equal(edits.setUnits(DESIGN, "mm", true), DESIGN);
});

test("a drawing in a file keeps its size in other units", () => {
    const design = frozen({ ...DESIGN, site: [{ strokes: [{ file: "leaf.svg", translate: [10, 20] }] }] });
    assert.deepEqual(edits.setUnits(design, "cm", true).site[0].strokes, [{ file: "leaf.svg", translate: [1, 2] }]);
});
