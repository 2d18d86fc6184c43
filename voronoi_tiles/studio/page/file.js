// @ts-check
// The design's file: opened, saved, changed by others; and what the browser keeps beside it.

import { kept } from "./habits.js";
import { inUnits, laidOf } from "./model/tracing.js";
import { NOTHING, NO_TRACE } from "./store.js";

/** @param {string | undefined} text what there is to know, and nothing is wrong @returns {import("./store.js").Trouble | null} */
const note = (text) => (text ? { message: text, remedy: "", quiet: true } : null);

export class OpenedFile {
    #store;
    #link;
    #stage;
    /** Where it lies, once it is opened: its jobs and the picture to trace, which it does not hold, are kept under that. */
    #home = "";
    /** @type {{rev: number, design: import("./model/design.js").Design | null}} what was sent to be saved */
    #saving = { rev: -1, design: null };
    /** Whether the user has said that what is drawn is to go over what others have made of the file. */
    #keepsMine = false;

    /**
     * @param {import("./store.js").Store} store
     * @param {import("./link.js").Link} link
     * @param {import("./view/stage.js").Stage} stage
     */
    constructor(store, link, stage) {
        this.#store = store;
        this.#link = link;
        this.#stage = stage;
        store.subscribe(["job"], ({ job }) => this.#keep("job", job));
        store.subscribe(["solidJob"], ({ solidJob }) => this.#keep("solid", solidJob));
        store.subscribe(["design"], ({ trace, design }) => store.set({ trace: inUnits(trace, design.units ?? "mm") }));
        store.subscribe(
            ["trace"],
            ({ trace }) => {
                if (trace.at) {
                    const { image: _, moves: __, ...laid } = trace;
                    this.#keep("trace", laid);
                }
            },
            { calm: true },
        );
        window.addEventListener("beforeunload", (event) => {
            if (!store.state.saved && !store.state.connected) {
                event.preventDefault();
            }
        });
    }

    /** @param {"job" | "solid" | "trace"} what @param {object} value */
    #keep(what, value) {
        if (this.#home) {
            localStorage.setItem(`voronoi_tiles ${what} ${this.#home}`, JSON.stringify(value));
        }
    }

    /** @param {boolean} [over] whether to write over what others have made of it; a backup of that is kept */
    save(over = this.#keepsMine) {
        const [rev, design] = [this.#store.state.revision, this.#store.settled];
        if (this.#link.send({ type: "save", rev, design, over })) {
            this.#saving = { rev, design };
        }
    }

    /** The next save goes over what others have made of the file. */
    keepMine() {
        this.#keepsMine = true;
    }

    /**
     * Follow what the server says of the file.
     * @param {ReturnType<typeof import("./panels/incoming.js").incoming>} ask
     * @param {() => void} seeDrawing
     */
    listen(ask, seeDrawing) {
        const [store, link] = [this.#store, this.#link];
        /**
         * Take the design in the address, where a link was opened: it was never sent to a server.
         * @returns {boolean} whether there was one
         */
        const openShared = () => {
            const { hash } = location;
            const shared = Boolean(store.state.file) && hash.startsWith("#design=");
            if (shared) {
                history.replaceState(null, "", location.pathname + location.search);
                ask.openLink(hash);
            }
            return shared;
        };
        window.addEventListener("hashchange", openShared);
        link.on("opened", (message) => {
            this.#keepsMine = false;
            if (message.again) {
                link.sendNow();
            } else if (this.#open(message, seeDrawing)) {
                const shared = openShared();
                if (message.recovery) {
                    ask.recover(message);
                } else if (!shared && !message.saved) {
                    void ask.gallery();
                }
            }
        });
        link.on("saved", (message) => {
            this.#keepsMine = false;
            store.set({ file: message.file, trouble: note(message.note) });
            if (message.rev === this.#saving.rev) {
                store.keep(this.#saving.design);
            }
        });
        link.on("conflict", (message) => ask.conflict(message));
        link.on("changed", (message) => {
            this.#keepsMine = false;
            ask.changed(message);
        });
        link.on("failed", (message) => store.set({ trouble: message.error }));
    }

    /**
     * Take the design that the server has opened.
     * @param {any} message
     * @param {() => void} seeDrawing
     * @returns {boolean} whether it was for this page
     */
    #open({ folder, file, begun, note: said, design, saved }, seeDrawing) {
        const [store, link] = [this.#store, this.#link];
        const found = `${folder}/${file}`;
        const trouble = note(said);
        if (this.#home && this.#home !== found && !begun) {
            link.leave();
            store.set({
                trouble: {
                    message: `The studio draws ${file} now, begun in another page.`,
                    remedy: `Load this page again to go on there. What was drawn here until the connection was lost is kept, and offered when ${store.state.file} is opened again.`,
                },
            });
            return false;
        }
        if (this.#home === found) {
            // What others have made of the file was asked for: undo leads back.
            store.edit(() => design, { selection: NOTHING });
            store.set({ file, trouble });
        } else {
            store.open(design, { file, trouble });
            seeDrawing();
            this.#stage.fit();
            this.#home = link.home = found;
            const trace = { ...NO_TRACE, ...laidOf(kept(`voronoi_tiles trace ${found}`)) };
            const [job, solidJob] = ["job", "solid"].map((what) => kept(`voronoi_tiles ${what} ${found}`));
            store.set({ job, solidJob, trace });
        }
        store.keep(saved ? design : null);
        return true;
    }
}
