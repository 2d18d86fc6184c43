// @ts-check
// The page's wiring: the store, the connection, the stage, the tools and the panels know of each other here alone.

import { Link } from "./link.js";
import { copied, siteNames } from "./model/design.js";
import { joinSelected, whyNotJoined } from "./model/joining.js";
import { shown } from "./model/lengths.js";
import { inUnits, laidOf } from "./model/tracing.js";
import { NOTHING, NO_TRACE, Store, shownFactor } from "./store.js";
import { BREAKS, MEETS, TOOLS, Toolbox } from "./tools/toolbox.js";
import { listen } from "./tools/keys.js";
import { letterOf, lettersOf } from "./tools/letters.js";
import { SheetView } from "./view/sheet.js";
import { Stage } from "./view/stage.js";
import { clipboard } from "./clipboard.js";
import { announce } from "./panels/announce.js";
import { dialogs } from "./panels/dialogs.js";
import { make } from "./panels/elements.js";
import { connectPanels } from "./panels/panels.js";

/** @param {string} id */
const element = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

/** @type {any} */
const EMPTY = { schema: 1, group: "p4", cell: { a: 60 }, site: [{ strokes: [] }] };

/** What the page keeps from one time to the next: how it looks, and nothing of the design. */
const HABITS = ["unit", "theme", "shown", "letters"];

/** The design's file, under which its job is kept, and where the picture to trace lies: it holds neither. */
let home = "";

/**
 * What the browser keeps for this page under a name.
 * @param {string} name
 * @returns {any}
 */
function kept(name) {
    try {
        return JSON.parse(localStorage.getItem(name) ?? "{}");
    } catch {
        return {};
    }
}

/** How the page looked last time, as far as that makes sense. */
function habits() {
    const found = kept("voronoi_tiles studio") ?? {};
    const own = Object.fromEntries(Object.entries(found).filter(([key]) => HABITS.includes(key)));
    return { ...own, letters: lettersOf(own.letters) };
}

const store = new Store({
    design: EMPTY,
    revision: 0,
    begun: 0,
    file: "",
    saved: true,
    selection: NOTHING,
    tool: "select",
    site: 0,
    tables: null,
    exact: null,
    refusal: null,
    product: null,
    jobRefusal: null,
    jobPending: false,
    job: {},
    unit: "mm",
    shown: { elements: true, cell: true, grid: false, copies: true, region: false, colours: true, edges: true },
    theme: "",
    trace: NO_TRACE,
    connected: true,
    dragging: false,
    pointer: null,
    trouble: null,
    ...habits(),
});

const stage = new Stage(
    /** @type {HTMLCanvasElement} */ (element("picture")),
    /** @type {HTMLCanvasElement} */ (element("overlay")),
    store,
);
const sheet = new SheetView(/** @type {HTMLCanvasElement} */ (element("sheet")), store);
const link = new Link(store);

/** @type {import("./tools/tool.js").Hands} */
const hands = {
    store,
    entries: () => stage.entries(),
    symmetry: () => stage.symmetry(),
    camera: stage.camera,
    redraw: () => stage.redraw(),
    take(tool) {
        store.set({ tool, trace: { ...store.state.trace, moves: false } });
        if (sheet.visible) {
            openTab(/** @type {HTMLButtonElement} */ (element("tab-drawing")));
        }
    },
    hint(text) {
        element("hint").textContent = text;
        element("hint").hidden = !text;
    },
};
const toolbox = new Toolbox(/** @type {HTMLCanvasElement} */ (element("overlay")), hands);
Object.assign(stage, { hands, toolbox });
store.subscribe(["dragging"], () => {
    link.scale = stage.camera.scale;
});

// --- commands -----------------------------------------------------------------------------------------------------

/** @param {keyof import("./store.js").State["shown"]} name */
const toggle = (name) => store.set({ shown: { ...store.state.shown, [name]: !store.state.shown[name] } });

const middle = () => /** @type {[number, number]} */ ([stage.camera.size[0] / 2, stage.camera.size[1] / 2]);

/** @param {number} factor */
const zoomBy = (factor) => {
    if (sheet.visible) {
        sheet.zoom(factor);
        return;
    }
    stage.camera.zoomAt(middle(), factor);
    stage.redraw();
};

/** @type {{rev: number, design: import("./model/design.js").Design | null}} what was sent to be saved */
let saving = { rev: -1, design: null };

/** Whether the user has said that what is drawn is to go over what others have made of the file. */
let keepsMine = false;

/** @param {boolean} [over] whether to write over that; a backup of it is kept */
function save(over = keepsMine) {
    const [rev, design] = [store.state.revision, store.settled];
    if (link.send({ type: "save", rev, design, over })) {
        saving = { rev, design };
    }
}

const ask = dialogs(element("dialogs"), {
    store,
    link,
    stage,
    save,
    keepMine() {
        keepsMine = true;
    },
});

/** @type {Record<string, () => void>} */
const COMMANDS = {
    undo() {
        if (!toolbox.tool.undo?.(hands)) {
            store.undo();
        }
    },
    redo: () => store.redo(),
    save: () => save(),
    "save-as": () => void ask.saveAs(),
    export: () => ask.export(),
    open: () => ask.open(),
    new: () => ask.begin(),
    gallery: () => void ask.gallery(),
    coupon: () => ask.coupon(),
    share: () => ask.share(),
    help: () => ask.help(),
    theme: () => store.set({ theme: stage.dark ? "light" : "dark" }),
    "zoom-in": () => zoomBy(1.4),
    "zoom-out": () => zoomBy(1 / 1.4),
    fit: () => (sheet.visible ? sheet.fit() : stage.fit("cell")),
    "fit-all": () => stage.fit("all"),
    "fit-selection": () => stage.fit("selection"),
    "toggle-elements": () => toggle("elements"),
    "toggle-grid": () => toggle("grid"),
    "toggle-copies": () => toggle("copies"),
    "select-all": () =>
        store.set({ tool: "select", selection: { strokes: stage.entries().map((entry) => entry.ref), nodes: [] } }),
    join() {
        const { selection, dragging } = store.state;
        if (dragging) {
            return;
        }
        const joined = joinSelected(store.settled, selection, MEETS / stage.camera.scale);
        if (joined) {
            store.edit("join", () => joined.design, { selection: { strokes: [joined.ref], nodes: [] } });
        } else {
            const remedy = whyNotJoined(store.settled, selection);
            store.set({ trouble: { message: "Nothing here can be joined.", remedy, quiet: true } });
        }
    },
    double() {
        const { selection } = store.state;
        const strokes = selection.strokes.map((ref) => ({
            site: ref.site,
            stroke: store.settled.site[ref.site].strokes[ref.stroke],
        }));
        if (strokes.length) {
            const by = 12 / stage.camera.scale;
            store.edit("double", (design) => copied(design, strokes, by).design);
        }
    },
};

/** @param {string} command */
function run(command) {
    COMMANDS[command]?.();
}

document.addEventListener("click", (event) => {
    const button = event.target instanceof Element && event.target.closest("[data-command]");
    if (button instanceof HTMLElement && button.dataset.command) {
        run(button.dataset.command);
    }
});
listen(hands, toolbox, /** @type {HTMLCanvasElement} */ (element("overlay")), run);
clipboard(hands);
announce(hands, toolbox, element("overlay"), element("in-hand"));

// --- tools and tabs -----------------------------------------------------------------------------------------------

for (const tool of TOOLS) {
    if (BREAKS.has(tool.name)) {
        element("tools").append(document.createElement("hr"));
    }
    const button = document.createElement("button");
    button.type = "button";
    button.dataset.tool = tool.name;
    button.setAttribute("aria-label", tool.title);
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    const use = document.createElementNS("http://www.w3.org/2000/svg", "use");
    use.setAttribute("href", `#i-${tool.icon}`);
    svg.append(use);
    const letter = document.createElement("kbd");
    letter.setAttribute("aria-hidden", "true");
    store.subscribe(["letters"], ({ letters }) => {
        const key = letterOf(tool, letters);
        letter.textContent = key.toUpperCase();
        button.title = `${tool.title} (${key.toUpperCase()})`;
        button.setAttribute("aria-keyshortcuts", key);
    });
    button.append(svg, letter);
    button.addEventListener("click", () => hands.take(tool.name));
    element("tools").append(button);
}

const tabs = /** @type {HTMLButtonElement[]} */ ([...document.querySelectorAll("[role=tab]")]);

/** @param {HTMLButtonElement} chosen */
function openTab(chosen) {
    for (const tab of tabs) {
        const on = tab === chosen;
        tab.setAttribute("aria-selected", String(on));
        tab.tabIndex = on ? 0 : -1;
        element(tab.getAttribute("aria-controls") ?? "").hidden = !on;
    }
    const jobs = chosen.id === "tab-job" || chosen.id === "tab-report";
    link.askJobs(jobs);
    sheet.show(jobs);
    element("hint").hidden = jobs;
}

for (const [k, tab] of tabs.entries()) {
    tab.addEventListener("click", () => openTab(tab));
    tab.addEventListener("keydown", (event) => {
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (step) {
            const next = tabs[(k + step + tabs.length) % tabs.length];
            openTab(next);
            next.focus();
        }
    });
}

// --- what the page says -------------------------------------------------------------------------------------------

store.subscribe(["tool"], ({ tool }) => {
    for (const button of document.querySelectorAll("[data-tool]")) {
        button.setAttribute("aria-pressed", String(/** @type {HTMLElement} */ (button).dataset.tool === tool));
    }
});

store.subscribe(["file", "saved"], ({ file, saved }) => {
    element("file").textContent = file || "no design";
    element("saved").dataset.state = saved ? "saved" : "unsaved";
    element("saved").textContent = saved ? "saved" : "not saved";
    document.title = `${saved ? "" : "* "}${file || "studio"} - voronoi_tiles`;
});

store.subscribe(["revision", "dragging"], () => {
    for (const [command, can] of /** @type {const} */ ([
        ["undo", store.canUndo],
        ["redo", store.canRedo],
    ])) {
        /** @type {HTMLButtonElement} */ (document.querySelector(`[data-command=${command}]`)).disabled = !can;
    }
});

/** Of outlines that are this many changes behind while something is dragged, the page says so. */
const BEHIND = 8;

/** @param {import("./store.js").State} state @returns {[string, string]} */
function proofOf({ exact, refusal, revision, connected, dragging }) {
    if (!connected) {
        return ["behind", "no connection"];
    }
    if (refusal) {
        return ["refused", "no tile"];
    }
    if (!exact || exact.rev < revision - (dragging ? BEHIND : 0)) {
        return ["behind", "exact tile follows"];
    }
    return exact.proved ? ["proved", "proved"] : ["proving", "exact, proof follows"];
}

store.subscribe(
    ["exact", "refusal", "revision", "connected", "dragging"],
    (state) => {
        const [name, text] = proofOf(state);
        element("exact").dataset.state = name;
        element("exact").textContent = text;
        document.documentElement.dataset.exact = `${name} ${state.exact?.rev ?? -1} ${state.revision}`;
    },
    { calm: true },
);

store.subscribe(
    ["exact", "refusal", "unit", "tables", "design"],
    ({ exact, refusal, unit, tables, design }) => {
        if (!exact || !tables || refusal) {
            element("measure").textContent = "";
            return;
        }
        const mm = tables.units[design.units ?? "mm"];
        const parts = exact.tiles.slice(0, 3).map((tile) => {
            const [width, height] = [tile.width, tile.height].map((side) =>
                ((side * mm) / tables.units[unit]).toFixed(unit === "mm" ? 2 : 3),
            );
            const neighbours = `${tile.neighbours} ${tile.neighbours === 1 ? "neighbour" : "neighbours"}`;
            return `${exact.tiles.length > 1 ? `${tile.site}: ` : ""}${width} x ${height} ${unit}, ${neighbours}, ${tile.copies} in a cell`;
        });
        element("measure").textContent = parts.join("; ") + (exact.tiles.length > 3 ? "; ..." : "");
    },
    { calm: true },
);

toolbox.pointed = (pointer) => store.set({ pointer });
store.subscribe(
    ["pointer", "unit", "tables", "design"],
    (state) => {
        const { pointer, unit, tables } = state;
        const parts = tables && pointer?.map((part) => shown(part * shownFactor(state), unit));
        element("pointer").textContent = parts ? `${parts.join(", ")} ${unit}` : "";
    },
    { calm: true },
);

const LOST = {
    message: "The connection to the studio's server is lost.",
    remedy: "The page tries again; what is drawn stays here. If the server was stopped, start it again: voronoi-tiles studio.",
};

/**
 * Why there is no tile, in the page's words where it knows what to do here.
 * @param {import("./store.js").State} state
 * @returns {import("./store.js").Trouble | null}
 */
function whyNoTile({ design, refusal }) {
    const bare = design.site.findIndex((site) => !site.strokes.length);
    if (!refusal || bare < 0) {
        return refusal?.error ?? null;
    }
    const what = design.site.length > 1 ? `${siteNames(design)[bare]} has no stroke yet` : "Nothing is drawn yet";
    return { message: what, remedy: "Take the pen or another tool and draw.", quiet: true };
}

store.subscribe(["refusal", "trouble", "connected"], (state) => {
    const { trouble, connected } = state;
    const said = [connected ? null : LOST, trouble, connected ? whyNoTile(state) : null].filter((one) => one !== null);
    const banner = element("banner");
    banner.hidden = !said.length;
    banner.classList.toggle(
        "quiet",
        said.every((one) => "quiet" in one && one.quiet),
    );
    banner.replaceChildren(
        ...said.map((one) => {
            const strong = make(
                "strong",
                {},
                one.message
                    .replace(/[.?!]?$/, (end) => end || ".")
                    .replace(/^[a-z]+ /, (word) => word[0].toUpperCase() + word.slice(1)),
            );
            const close =
                one === trouble &&
                make(
                    "button",
                    { type: "button", class: "quiet", onclick: () => store.set({ trouble: null }) },
                    "Close",
                );
            return make("div", {}, make("p", {}, strong, ` ${one.remedy}`), close);
        }),
    );
});

store.subscribe(["theme"], ({ theme }) => {
    document.documentElement.dataset.theme = theme;
});

store.subscribe(["unit"], ({ unit }) => {
    /** @type {HTMLSelectElement} */ (element("unit")).value = unit;
});
element("unit").addEventListener("change", (event) => {
    store.set({ unit: /** @type {any} */ (event.target).value });
});

store.subscribe(["job"], ({ job }) => {
    if (home) {
        localStorage.setItem(`voronoi_tiles job ${home}`, JSON.stringify(job));
    }
});

store.subscribe(["design"], ({ trace, design }) => store.set({ trace: inUnits(trace, design.units ?? "mm") }));

store.subscribe(
    ["trace"],
    ({ trace }) => {
        if (home && trace.at) {
            const { image: _, moves: __, ...laid } = trace;
            localStorage.setItem(`voronoi_tiles trace ${home}`, JSON.stringify(laid));
        }
    },
    { calm: true },
);

store.subscribe(["unit", "theme", "shown", "letters"], (state) => {
    localStorage.setItem(
        "voronoi_tiles studio",
        JSON.stringify(Object.fromEntries(HABITS.map((key) => [key, /** @type {any} */ (state)[key]]))),
    );
});

window.addEventListener("beforeunload", (event) => {
    if (!store.state.saved && !store.state.connected) {
        event.preventDefault();
    }
});

// --- the beginning ------------------------------------------------------------------------------------------------

/** @param {string | undefined} text what there is to know, and nothing is wrong @returns {import("./store.js").Trouble | null} */
const note = (text) => (text ? { message: text, remedy: "", quiet: true } : null);

link.on("opened", (message) => {
    keepsMine = false;
    const found = `${message.folder}/${message.file}`;
    if (message.again) {
        link.sendNow();
        return;
    }
    if (home && home !== found && !message.begun) {
        link.leave();
        store.set({
            trouble: {
                message: `The studio draws ${message.file} now, begun in another page.`,
                remedy: `Load this page again to go on there. What was drawn here until the connection was lost is kept, and offered when ${store.state.file} is opened again.`,
            },
        });
        return;
    }
    const trouble = note(message.note);
    if (home === found) {
        // What others have made of the file was asked for: undo leads back.
        store.edit("take theirs", () => message.design, { selection: NOTHING });
        store.set({ file: message.file, trouble });
    } else {
        store.open(message.design, { file: message.file, trouble });
        openTab(/** @type {HTMLButtonElement} */ (element("tab-drawing")));
        stage.fit();
        home = link.home = found;
        const trace = { ...NO_TRACE, ...laidOf(kept(`voronoi_tiles trace ${home}`)) };
        store.set({ job: kept(`voronoi_tiles job ${home}`), trace });
    }
    store.keep(message.saved ? message.design : null);
    const shared = openShared();
    if (message.recovery) {
        ask.recover(message);
    } else if (!shared && !message.saved) {
        void ask.gallery();
    }
});
link.on("saved", (message) => {
    keepsMine = false;
    store.set({ file: message.file, trouble: note(message.note) });
    if (message.rev === saving.rev) {
        store.keep(saving.design);
    }
});
link.on("conflict", (message) => ask.conflict(message));
link.on("changed", (message) => {
    keepsMine = false;
    ask.changed(message);
});
link.on("failed", (message) => store.set({ trouble: message.error }));

/**
 * Take the design in the address, where a link was opened: it was never sent to a server.
 * @returns {boolean} whether there was one
 */
function openShared() {
    const { hash } = location;
    const shared = Boolean(store.state.file) && hash.startsWith("#design=");
    if (shared) {
        history.replaceState(null, "", location.pathname + location.search);
        ask.openLink(hash);
    }
    return shared;
}
window.addEventListener("hashchange", openShared);

/** What a script in the page may ask: where a point of the drawing is on it, and what is drawn. */
const face = {
    design: () => store.state.design,
    toPage(/** @type {[number, number]} */ at) {
        const box = element("overlay").getBoundingClientRect();
        const [x, y] = stage.camera.toScreen(at);
        return [box.left + x, box.top + y];
    },
};

connectPanels({
    store,
    link,
    stage,
    run,
    openTab: (name) => openTab(/** @type {HTMLButtonElement} */ (element(`tab-${name}`))),
});
const [tables, shader] = await Promise.all([
    fetch("tables.json").then((answer) => answer.json()),
    fetch("gl/exact.glsl").then((answer) => answer.text()),
]);
store.set({ tables });
stage.usePreview(shader);
link.connect();
const measured = new URLSearchParams(location.search).has("bench")
    ? (await import("./bench.js")).bench({ store, stage })
    : null;
Object.assign(window, { studio: { ...face, bench: measured } });
