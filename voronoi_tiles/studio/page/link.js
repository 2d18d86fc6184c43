// @ts-check
// The live connection to the server: designs go out with a revision, the next when the last one's answer has come; what
// comes back is for the newest, or it is left. A lost connection is made again, and the design sent anew.

import { unpacked } from "./model/solids.js";

/** @import { Store } from "./store.js" */
/** @import { Design } from "./model/design.js" */
/**
 * @typedef {object} Tile a tile as the server has computed it; lengths in the design's units, after its scale
 * @property {string} site
 * @property {string} path SVG path data of its rings, y up
 * @property {number} edges
 * @property {number} neighbours
 * @property {number} width
 * @property {number} height
 * @property {number} copies in a cell
 * @property {number[]} operations one of the group's for each copy, as indices
 * @typedef {object} Outline the exact tiles of a revision
 * @property {number} rev
 * @property {boolean} proved else its proof comes after it, where that is quick enough
 * @property {import("./store.js").Trouble | null} unfit what does not fit of what stands above the drawing
 * @property {number} scale
 * @property {Tile[]} tiles
 * @property {Record<string, string>} [resolved] path data of strokes that are files, by "site.stroke"
 * @property {any} [colouring]
 * @property {{paths: Record<string, string>, trouble: import("./store.js").Trouble | null} | null} art path data by
 *     sites, and why there are none of one; of the design as it was at rest last
 * @property {number} ms
 * @property {Design} design that it is of
 * @property {number | undefined} after the revision of the one before
 * @typedef {object} Refusal
 * @property {number} rev
 * @property {string} lane
 * @property {{message: string, remedy: string, key?: string, at?: [number, number]}} error
 * @typedef {object} Product what a job comes to
 * @property {number} rev
 * @property {any} report
 * @property {{width: number, height: number} | null} sheet millimetres
 * @property {{width: number, height: number}} page millimetres
 * @property {number} found how many findings there are; at most a thousand are sent
 * @property {{name: string, kind: string, colour: string, path: string}[]} layers millimetres, y down
 * @property {{severity: string, kind: string, message: string, at: [number, number] | null, layer?: string}[]} findings
 * @property {string[]} notes
 * @property {number} ms
 */

const MESSAGE_MAX = 1 << 20;
const TOO_LARGE = {
    message: "This design is larger than the studio sends.",
    remedy: "Take strokes out, or cut it by the command line.",
};
const REST_MS = 60;
/** For how long outlines may stay away until they are said to be behind what is drawn. */
const BEHIND_MS = 100;
/** After this long an answer is no longer waited for. */
const ANSWER_MS = 1000;
const JOB_MS = 150;
const TAKEN_OVER = 4001;
/** Lanes whose messages have numbers of their own in the place of revisions. */
const OWN_NUMBERS = new Set(["thumbnail", "solid", "new"]);
const AGAIN_MS = [200, 500, 1000, 2000, 5000];

export class Link {
    #store;
    /** @type {WebSocket | null} */
    #socket = null;
    #tries = 0;
    #rest = 0;
    #jobTimer = 0;
    /** @type {any} the job that was sent last */
    #jobSent = null;
    #late = 0;
    /** @type {Outline | null} the last outlines that came */
    #newest = null;
    #sent = { revision: -1, rest: false };
    /** @type {{rev: number, at: number} | null} what was sent while it was dragged, and has no answer yet */
    #asked = null;
    /** @type {Map<number, Design>} what was sent, by its revision, until an answer to a later one has come */
    #designs = new Map();
    #asksJobs = false;
    /** the design's folder and file, once the page has it */
    home = "";
    /** pixels a unit: what is dragged is flattened to a quarter of a pixel */
    scale = 8;
    /** @type {Map<string, ((message: any) => void)[]>} */
    #heard = new Map();
    #left = false;
    /** @type {{isMeant: (message: any) => boolean, done: (message: any) => void}[]} who waits for a message */
    #awaited = [];

    /** @param {Store} store */
    constructor(store) {
        this.#store = store;
        store.subscribe(["revision", "dragging"], () => this.#schedule());
        store.subscribe(["job"], () => {
            store.set({ jobRefusal: null }); // it was the last job's
            this.#scheduleJob();
        });
        store.subscribe(["revision", "exact"], () => this.#follow());
    }

    /** Call a function with every message of a type. @param {string} type @param {(message: any) => void} tell */
    on(type, tell) {
        this.#heard.set(type, [...(this.#heard.get(type) ?? []), tell]);
    }

    /**
     * The next message that is meant; null where the connection is lost before.
     * @param {(message: any) => boolean} isMeant
     * @returns {Promise<any>}
     */
    next(isMeant) {
        return new Promise((done) => this.#awaited.push({ isMeant, done }));
    }

    /** Leave the server, and do not come again. */
    leave() {
        this.#left = true;
        this.#socket?.close();
    }

    /** @param {any} message null: there will be none */
    #answerNext(message) {
        const answered = this.#awaited.filter(({ isMeant }) => !message || isMeant(message));
        this.#awaited = this.#awaited.filter((one) => !answered.includes(one));
        answered.forEach(({ done }) => done(message));
    }

    connect() {
        const again = this.home ? `?again=${encodeURIComponent(this.home)}` : "";
        const socket = new WebSocket(`ws://${location.host}/ws${again}`);
        this.#socket = socket;
        socket.binaryType = "arraybuffer";
        socket.addEventListener("open", () => {
            this.#tries = 0;
            this.#sent = { revision: -1, rest: false };
            this.#asked = null;
            this.#store.set({ connected: true });
        });
        socket.addEventListener("message", ({ data }) =>
            this.#receive(typeof data === "string" ? JSON.parse(data) : unpacked(data)),
        );
        socket.addEventListener("close", (event) => {
            this.#socket = null;
            this.#answerNext(null);
            if (this.#left) {
                return; // the page says why: it is no connection that is lost
            }
            if (event.code === TAKEN_OVER) {
                this.#store.set({
                    trouble: {
                        message: "The studio is open in another tab.",
                        remedy: "Go on there, or load this page again to go on here.",
                    },
                });
                return;
            }
            this.#store.set({ connected: false });
            setTimeout(() => this.connect(), AGAIN_MS[Math.min(this.#tries++, AGAIN_MS.length - 1)]);
        });
    }

    /**
     * Send a message; false where there is no connection, or it is too large.
     * @param {Record<string, unknown>} message
     */
    send(message) {
        if (this.#socket?.readyState !== WebSocket.OPEN) {
            return false;
        }
        const text = JSON.stringify(message);
        if (text.length > MESSAGE_MAX) {
            const { revision: rev } = this.#store.state;
            this.#store.set(
                message.type === "design"
                    ? { refusal: { rev, lane: "outline", error: TOO_LARGE } }
                    : { trouble: TOO_LARGE },
            );
            return false;
        }
        this.#socket.send(text);
        return true;
    }

    /** Send the design as it is, at once, and soon the job: what was asked before may have been lost. */
    sendNow() {
        this.#send(!this.#store.state.dragging);
        this.#scheduleJob();
    }

    /** @param {boolean} wanted whether report and findings are looked at */
    askJobs(wanted) {
        this.#asksJobs = wanted;
        if (wanted) {
            this.#scheduleJob();
        }
    }

    #schedule() {
        if (!this.#asked || performance.now() - this.#asked.at > ANSWER_MS) {
            this.#send(false);
        }
        clearTimeout(this.#rest);
        this.#rest = window.setTimeout(() => this.#send(true), REST_MS);
        this.#scheduleJob();
    }

    /** See whether outlines follow what is drawn: for a while after each, and after the first change without them. */
    #follow() {
        const { exact, revision } = this.#store.state;
        const isCurrent = exact?.rev === revision;
        if (isCurrent || exact !== this.#newest) {
            clearTimeout(this.#late);
            this.#late = 0;
            this.#newest = exact;
            this.#store.set({ behind: false });
        }
        if (!isCurrent) {
            this.#late ||= window.setTimeout(() => this.#store.set({ behind: true }), BEHIND_MS);
        }
    }

    /** @param {boolean} rest whether the pointer rests: the answer is to be proved, at full tolerance */
    #send(rest) {
        const { design, revision } = this.#store.state;
        if (revision === this.#sent.revision && (this.#sent.rest || !rest)) {
            return;
        }
        const coarse = rest ? {} : { tolerance: 0.25 / this.scale };
        if (design && this.send({ type: "design", rev: revision, design, rest, ...coarse })) {
            this.#sent = { revision, rest };
            this.#asked = rest ? this.#asked : { rev: revision, at: performance.now() };
            this.#designs.set(revision, design);
        }
    }

    /** An answer has come: what has changed meanwhile goes out. @param {number} rev */
    #answered(rev) {
        if (this.#asked && rev >= this.#asked.rev) {
            this.#asked = null;
            this.#send(false);
        }
    }

    /** @param {number} rev */
    #forget(rev) {
        for (const old of this.#designs.keys()) {
            if (old < rev) {
                this.#designs.delete(old);
            }
        }
    }

    #scheduleJob() {
        clearTimeout(this.#jobTimer);
        if (this.#asksJobs) {
            this.#store.set({ jobPending: true });
        }
        this.#jobTimer = window.setTimeout(() => {
            const { design, revision, job, dragging } = this.#store.state;
            if (this.#asksJobs && design && !dragging) {
                this.#jobSent = job;
                this.send({ type: "job", rev: revision, design, job });
            }
        }, JOB_MS);
    }

    /** @param {any} message */
    #receive(message) {
        const { exact, refusal, revision, begun, product, job } = this.#store.state;
        const isOfJob = job === this.#jobSent && message.rev === revision;
        const isOfDesign = message.type === "outline" || message.type === "product" || message.type === "refused";
        if (isOfDesign && message.rev < begun && !OWN_NUMBERS.has(message.lane)) {
            return;
        }
        if (message.type === "outline" || (message.type === "refused" && message.lane === "outline")) {
            this.#answered(message.rev);
        }
        switch (message.type) {
            case "outline":
                if (!exact || message.rev >= exact.rev) {
                    const design = this.#designs.get(message.rev) ?? this.#store.state.design;
                    this.#store.set({
                        exact: { ...message, design, after: exact?.rev, art: message.art ?? exact?.art ?? null },
                        refusal: refusal && refusal.rev > message.rev ? refusal : null,
                        ...(message.proved ? { proved: message.rev } : {}),
                    });
                    this.#forget(message.rev);
                }
                break;
            case "proof":
                this.#store.set({ proved: message.rev });
                break;
            case "refused":
                if (message.lane === "outline" && (!exact || message.rev >= exact.rev)) {
                    this.#store.set({ refusal: message });
                } else if (message.lane === "job" && isOfJob) {
                    this.#store.set({ jobRefusal: message, jobPending: false });
                }
                break;
            case "product":
                if (!product || message.rev >= product.rev) {
                    this.#store.set({ product: message, jobRefusal: null, jobPending: !isOfJob });
                }
                break;
            case "trouble":
                this.#store.set({ trouble: message });
                break;
        }
        this.#heard.get(message.type)?.forEach((tell) => tell(message));
        this.#answerNext(message);
    }
}
