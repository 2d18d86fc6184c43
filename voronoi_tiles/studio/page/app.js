// @ts-check
// The page's wiring: the store, the connection, the stage, the tools and the panels know of each other here alone.

import { Link } from "./link.js";
import { copied } from "./model/design.js";
import { joinSelected, whyNotJoined } from "./model/joining.js";
import { NOTHING, NO_TRACE, Store } from "./store.js";
import { BREAKS, MEETS, TOOLS, Toolbox } from "./tools/toolbox.js";
import { listen } from "./tools/keys.js";
import { letterOf } from "./tools/letters.js";
import { SheetView } from "./view/sheet.js";
import { SolidView } from "./view/solid.js";
import { Stage } from "./view/stage.js";
import { clipboard } from "./clipboard.js";
import { SolidLink } from "./solids.js";
import { OpenedFile } from "./file.js";
import { habits, keepHabits } from "./habits.js";
import { announce } from "./panels/announce.js";
import { byId } from "./panels/elements.js";
import { post } from "./panels/exchange.js";
import { help } from "./panels/help.js";
import { incoming } from "./panels/incoming.js";
import { outgoing } from "./panels/outgoing.js";
import { connectPanels } from "./panels/panels.js";
import { showStatus } from "./panels/status.js";

/** @type {any} */
const EMPTY = { schema: 1, group: "p4", cell: { a: 60 }, site: [{ strokes: [] }] };

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
    proved: -1,
    refusal: null,
    product: null,
    jobRefusal: null,
    jobPending: false,
    job: {},
    solid: null,
    solidRefusal: null,
    solidPending: false,
    solidJob: {},
    apart: 0.2,
    turnsSolids: true,
    unit: "mm",
    theme: "",
    trace: NO_TRACE,
    connected: true,
    behind: false,
    dragging: false,
    pointer: null,
    trouble: null,
    ...habits({
        elements: true,
        cell: true,
        grid: false,
        copies: true,
        region: false,
        colours: true,
        edges: true,
        art: true,
    }),
});

const stage = new Stage(
    /** @type {HTMLCanvasElement} */ (byId("picture")),
    /** @type {HTMLCanvasElement} */ (byId("overlay")),
    store,
);
const sheet = new SheetView(/** @type {HTMLCanvasElement} */ (byId("sheet")), store);
const link = new Link(store);
const solids = new SolidLink(store, link);
/** The longer side of a picture of solids; pixels. A larger one takes seconds. */
const PICTURE = 640;
const solidView = new SolidView(/** @type {HTMLCanvasElement} */ (byId("solid")), store, async (signal) => {
    const { settled: design, state } = store;
    const asked = { design, job: { ...state.solidJob, format: "png", size: PICTURE } };
    return (await post("solid", JSON.stringify(asked), { signal })).blob();
});

/** @type {import("./tools/tool.js").Hands} */
const hands = {
    store,
    entries: () => stage.entries(),
    symmetry: () => stage.symmetry(),
    camera: stage.camera,
    redraw: () => stage.redraw(),
    take(tool) {
        store.set({ tool, trace: { ...store.state.trace, moves: false } });
        if (sheet.visible || solidView.visible) {
            openTab(/** @type {HTMLButtonElement} */ (byId("tab-drawing")));
        }
    },
    hint(text) {
        byId("hint").textContent = text;
        byId("hint").hidden = !text;
    },
};
const toolbox = new Toolbox(/** @type {HTMLCanvasElement} */ (byId("overlay")), hands);
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
    const above = [sheet, solidView].find((view) => view.visible);
    if (above) {
        above.zoom(factor);
        return;
    }
    stage.camera.zoomAt(middle(), factor);
    stage.redraw();
};

const file = new OpenedFile(store, link, stage);
const ask = { ...incoming({ store, link, stage, file }), ...outgoing({ store }) };

/** @type {Record<string, () => void>} */
const COMMANDS = {
    undo() {
        if (!toolbox.tool.undo?.(hands)) {
            store.undo();
        }
    },
    redo() {
        if (!toolbox.tool.redo?.(hands)) {
            store.redo();
        }
    },
    save: () => file.save(),
    "save-as": () => void ask.saveAs(),
    export: () => ask.export(),
    open: () => ask.open(),
    "fit-outline": () => ask.fit(),
    new: () => ask.begin(),
    gallery: () => void ask.gallery(),
    coupon: () => ask.coupon(),
    "download-solid": () => ask.solid(),
    "toggle-solid"() {
        const opens = !solidView.visible;
        openTab(/** @type {HTMLButtonElement} */ (byId(opens ? "tab-solid" : "tab-drawing")));
        (opens ? solidView : byId("overlay")).focus();
    },
    "look-first": () => solidView.lookFrom(),
    "look-above": () => solidView.lookFrom({ turn: 0, tilt: 90 }),
    "look-front": () => solidView.lookFrom({ turn: 0, tilt: 0 }),
    share: () => ask.share(),
    help: () => help(store),
    theme: () => store.set({ theme: stage.dark ? "light" : "dark" }),
    "zoom-in": () => zoomBy(1.4),
    "zoom-out": () => zoomBy(1 / 1.4),
    fit() {
        const above = [sheet, solidView].find((view) => view.visible);
        if (above) {
            above.fit();
        } else {
            stage.fit("cell");
        }
    },
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
            store.edit(() => joined.design, { selection: { strokes: [joined.ref], nodes: [] } });
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
            store.edit((design) => copied(design, strokes, by).design);
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
listen(hands, toolbox, /** @type {HTMLCanvasElement} */ (byId("overlay")), run);
clipboard(hands);
announce(hands, toolbox, byId("overlay"), byId("in-hand"));

// --- tools and tabs -----------------------------------------------------------------------------------------------

for (const tool of TOOLS) {
    if (BREAKS.has(tool.name)) {
        byId("tools").append(document.createElement("hr"));
    }
    const button = document.createElement("button");
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
    store.subscribe(["tool"], (state) => button.setAttribute("aria-pressed", String(state.tool === tool.name)));
    button.addEventListener("click", () => hands.take(tool.name));
    byId("tools").append(button);
}

const tabs = /** @type {HTMLButtonElement[]} */ ([...document.querySelectorAll("[role=tab]")]);

/** @param {HTMLButtonElement} chosen */
function openTab(chosen) {
    for (const tab of tabs) {
        const on = tab === chosen;
        tab.setAttribute("aria-selected", String(on));
        tab.tabIndex = on ? 0 : -1;
        byId(tab.getAttribute("aria-controls") ?? "").hidden = !on;
    }
    const jobs = chosen.id === "tab-job" || chosen.id === "tab-report";
    link.askJobs(jobs);
    sheet.show(jobs);
    const solid = chosen.id === "tab-solid";
    solids.ask(solid);
    solidView.show(solid);
    byId("hint").hidden = jobs || solid;
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

// --- the beginning ------------------------------------------------------------------------------------------------

toolbox.pointed = (pointer) => store.set({ pointer });
store.subscribe(["theme"], ({ theme }) => {
    document.documentElement.dataset.theme = theme;
});
showStatus(store);
keepHabits(store);
file.listen(ask, () => openTab(/** @type {HTMLButtonElement} */ (byId("tab-drawing"))));

/** What a script in the page may ask: where a point of the drawing is on it, and what is drawn. */
const face = {
    design: () => store.state.design,
    solid: () => ({ look: solidView.look, ...store.state.solid }),
    toPage(/** @type {[number, number]} */ at) {
        const box = byId("overlay").getBoundingClientRect();
        const [x, y] = stage.camera.toScreen(at);
        return [box.left + x, box.top + y];
    },
};

connectPanels({
    store,
    link,
    stage,
    run,
    openTab: (name) => openTab(/** @type {HTMLButtonElement} */ (byId(`tab-${name}`))),
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
