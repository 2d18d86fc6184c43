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

/** A page's end of a connection: what it is told, and the types of what it has sent. @param {Store} store */
function connected(store) {
    /** @type {string[]} */
    const sent = [];
    class Socket extends EventTarget {
        static OPEN = 1;
        readyState = Socket.OPEN;
        /** @param {string} text */
        send(text) {
            sent.push(JSON.parse(text).type);
        }
        /** @param {object} message */
        static come(message) {
            socket.dispatchEvent(Object.assign(new Event("message"), { data: JSON.stringify(message) }));
        }
        constructor() {
            super();
            socket = this;
        }
    }
    /** @type {Socket} */
    let socket;
    Object.assign(globalThis, { window: globalThis, WebSocket: Socket, location: { host: "here" } });
    const link = new Link(store);
    link.connect();
    return { link, sent, come: Socket.come };
}

test("an outline is proved once its proof has come", async (context) => {
    context.mock.timers.enable({ apis: ["setTimeout"] });
    const store = new Store({ design: DESIGN, revision: 5, begun: 3, exact: null, proved: -1, refusal: null });
    const { come } = connected(store);
    const seen = () => [store.state.exact?.rev, store.state.exact?.after, store.state.proved];

    come({ type: "outline", rev: 2, proved: true }); // of the design before
    assert.deepEqual(seen(), [undefined, undefined, -1]);
    come({ type: "outline", rev: 3, proved: false });
    assert.deepEqual(seen(), [3, undefined, -1]);
    come({ type: "proof", rev: 3 });
    assert.deepEqual(seen(), [3, undefined, 3]);
    come({ type: "outline", rev: 4, proved: false });
    assert.deepEqual(seen(), [4, 3, 3]);
    come({ type: "outline", rev: 5, proved: true });
    assert.deepEqual(seen(), [5, 4, 5]);
});

test("what is wrong with a job is said until it changes, and not of the next", async (context) => {
    const { timers } = context.mock;
    timers.enable({ apis: ["setTimeout"] });
    const store = new Store({ design: DESIGN, revision: 0, begun: 0, job: {}, exact: null, refusal: null });
    const { link, sent, come: told } = connected(store);
    link.askJobs(true);
    const come = (/** @type {object} */ message) => told({ lane: "job", rev: 0, ...message });
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
