/** What a search for designs says, as it comes over the wire, and the order of what it finds. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { messagesOf, withArt, withFit } from "../../../voronoi_tiles/studio/page/model/fits.js";
import { random } from "./helpers.js";

/** A stream of bytes in parts that end where they are cut. @type {(bytes: Uint8Array, cuts: number[]) => ReadableStream} */
function streamOf(bytes, cuts) {
    const ends = [...cuts, bytes.length];
    return new ReadableStream({
        start(controller) {
            ends.reduce((begin, end) => (controller.enqueue(bytes.slice(begin, end)), end), 0);
            controller.close();
        },
    });
}

/** @param {AsyncIterable<any>} messages */
async function all(messages) {
    const found = [];
    for await (const message of messages) found.push(message);
    return found;
}

test("messages are whole wherever the stream is cut, within a letter, too", async () => {
    const sent = [{ type: "outline", notes: ["Flügel, 鳥"] }, { type: "progress", done: 0.25 }, { type: "done" }];
    const bytes = new TextEncoder().encode(sent.map((one) => `${JSON.stringify(one)}\n`).join(""));
    for (let cut = 0; cut <= bytes.length; cut++) {
        assert.deepEqual(await all(messagesOf(streamOf(bytes, [cut]))), sent);
    }
    const each = Array.from(bytes.slice(1), (_, k) => k + 1);
    assert.deepEqual(await all(messagesOf(streamOf(bytes, each))), sent);
});

test("what a stream that breaks off has half said is not heard", async () => {
    const bytes = new TextEncoder().encode('{"type":"progress"}\n{"type":"do');
    assert.deepEqual(await all(messagesOf(streamOf(bytes, []))), [{ type: "progress" }]);
});

test("the nearest design is the first, in whatever order they come", () => {
    const dice = random(5);
    for (let round = 0; round < 50; round++) {
        let fits = [];
        for (let k = 0; k < 8; k++) {
            const fit = { overlap: Math.round(dice() * 5) / 5, number: k };
            const { fits: next, place } = withFit(fits, fit);
            assert.equal(next[place], fit);
            assert.deepEqual(
                next.filter((one) => one !== fit),
                fits,
            );
            fits = next;
        }
        for (let k = 1; k < fits.length; k++) {
            const [before, after] = [fits[k - 1], fits[k]];
            // Of equal ones the first that came stays first: a list that is read does not jump.
            assert.ok(before.overlap > after.overlap || before.number < after.number);
        }
    }
});

test("a design takes its art, and is not changed in place", () => {
    const design = Object.freeze({ group: "p2", site: Object.freeze([Object.freeze({ strokes: [] })]) });
    const art = { file: "bird-art.svg", scale: 1 };
    assert.deepEqual(withArt(design, art), { group: "p2", site: [{ strokes: [], art }] });
});
