// @ts-check
// The solid follows the design while it is looked at: asked for when the design rests, the newest request alone.

/** @import { Store } from "./store.js" */
/** @import { Link } from "./link.js" */

/** How long nothing has to change before a solid is asked for; milliseconds. */
const REST_MS = 250;

export class SolidLink {
    #store;
    #link;
    #timer = 0;
    #wanted = false;
    /** The number of the last request; answers to earlier ones are left. */
    #number = 0;
    /** The last that was answered. */
    #answered = 0;
    /** @type {any} what was asked for last: the design and the job, once more where the connection was lost */
    #asked = null;

    /** @param {Store} store @param {Link} link */
    constructor(store, link) {
        this.#store = store;
        this.#link = link;
        store.subscribe(["begun"], () => {
            this.#answered = ++this.#number;
            this.#asked = null;
            store.set({ solid: null, solidRefusal: null });
        });
        store.subscribe(["connected"], ({ connected }) => {
            this.#asked = connected ? this.#asked : null;
        });
        store.subscribe(["design", "dragging", "solidJob", "connected"], () => this.#schedule());
        link.on("solid", (message) => {
            if (message.rev === this.#number) {
                this.#answered = message.coarse ? this.#answered : message.rev;
                store.set({ solid: message, solidRefusal: null, solidPending: message.coarse });
            }
        });
        link.on("refused", (message) => {
            if (message.lane === "solid" && message.rev === this.#number) {
                this.#answered = message.rev;
                store.set({ solidRefusal: message, solidPending: false });
            }
        });
    }

    /** @param {boolean} wanted whether solids are looked at */
    ask(wanted) {
        this.#wanted = wanted;
        this.#schedule();
    }

    #schedule() {
        const { design, solidJob } = this.#store.state;
        if (!this.#wanted || (this.#asked?.design === design && this.#asked.job === solidJob)) {
            clearTimeout(this.#timer); // what was changed has been changed back
            this.#store.set({ solidPending: this.#wanted && this.#number !== this.#answered });
            return;
        }
        this.#store.set({ solidPending: true });
        clearTimeout(this.#timer);
        this.#timer = window.setTimeout(() => this.#send(), REST_MS);
    }

    #send() {
        const { design, solidJob: job, dragging, tables, file } = this.#store.state;
        const isOpen = tables !== null && file !== "";
        if (!dragging && isOpen && this.#link.send({ type: "solid", rev: ++this.#number, design, job })) {
            this.#asked = { design, job };
        }
    }
}
