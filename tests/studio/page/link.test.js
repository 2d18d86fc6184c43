/** When outlines that come from the server are behind what is drawn. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { Link } from "../../../voronoi_tiles/studio/page/link.js";
import { Store } from "../../../voronoi_tiles/studio/page/store.js";

const DESIGN = { schema: 1, group: "p4", cell: { a: 60 }, site: [{ strokes: [{ point: [1, 2] }] }] };

test("outlines are behind when none has come for a while, and not because none was needed", async (context) => {
    const { timers } = context.mock;
    timers.enable({ apis: ["setTimeout"] });
    Object.assign(globalThis, { window: globalThis, WebSocket: { OPEN: 1 } }); // there is no connection
    const store = new Store({ design: DESIGN, revision: 0, begun: 0, exact: { rev: 0 }, behind: false });
    new Link(store);
    const change = () => store.preview((design) => ({ ...design }));
    const come = (/** @type {number} */ rev) => store.set({ exact: { rev } });
    /** Whether they are behind after so many milliseconds. */
    const after = async (/** @type {number} */ ms) => {
        await null;
        timers.tick(ms);
        await null;
        await null;
        return store.state.behind;
    };

    assert.equal(await after(5000), false);
    change();
    assert.equal(await after(90), false);
    assert.equal(await after(10), true);
    change();
    assert.equal(await after(0), true);
    come(2);
    assert.equal(await after(5000), false);
    change();
    for (let rev = 3; rev < 10; rev++) {
        change(); // there is always something that they do not show
        assert.equal(await after(90), false);
        come(rev);
    }
    assert.equal(await after(90), false);
    assert.equal(await after(10), true);
});

test("what is wrong with a job is said until it changes, and not of the next", async (context) => {
    const { timers } = context.mock;
    timers.enable({ apis: ["setTimeout"] });
    /** @type {EventTarget & {send: (text: string) => void, readyState: number}} */
    let socket;
    /** @type {string[]} */
    const sent = [];
    class Socket extends EventTarget {
        static OPEN = 1;
        readyState = 1;
        /** @param {string} text */
        send(text) {
            sent.push(JSON.parse(text).type);
        }
        constructor() {
            super();
            socket = this;
        }
    }
    Object.assign(globalThis, { window: globalThis, WebSocket: Socket, location: { host: "here" } });
    const store = new Store({ design: DESIGN, revision: 0, begun: 0, job: {}, exact: null, refusal: null });
    const link = new Link(store);
    link.connect();
    link.askJobs(true);
    const come = (/** @type {object} */ message) => {
        const data = JSON.stringify({ lane: "job", rev: 0, ...message });
        socket.dispatchEvent(Object.assign(new Event("message"), { data }));
    };
    /** Change the job, and send it or not. */
    const change = async (/** @type {object} */ job, /** @type {number} */ ms) => {
        store.set({ job });
        await null;
        timers.tick(ms);
        await null;
    };

    await change({ margin: 400 }, 200);
    come({ type: "refused", error: { message: "too wide" } });
    assert.equal(store.state.jobRefusal?.error.message, "too wide");
    await change({ margin: 5 }, 10);
    assert.equal(store.state.jobRefusal, null);
    come({ type: "refused", error: { message: "too wide" } }); // of the job that was sent before
    assert.equal(store.state.jobRefusal, null);
    await change({ margin: 5 }, 200);
    come({ type: "product" });
    assert.deepEqual([store.state.jobRefusal, store.state.jobPending], [null, false]);
    sent.length = 0;
    link.sendNow(); // to a server that has come again
    timers.tick(200);
    assert.deepEqual(sent, ["job"]);
});
