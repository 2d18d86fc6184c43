// @ts-check
// Keys: what the page does, and what the help shows beside the tools' letters.

import { isSameNode } from "../model/design.js";
import { nodeRef, shownNodes } from "../scene.js";
import { COMMAND_LETTERS, letterOf } from "./letters.js";
import { moved, without } from "./select.js";
import { TOOLS } from "./toolbox.js";
import { NOTHING } from "../store.js";

/** @import { Hands } from "./tool.js" */
/** @import { Toolbox } from "./toolbox.js" */
/** @typedef {{keys: string, does: string}} Row */

/** @type {{title: string, rows: Row[]}[]} */
export const HELP = [
    {
        title: "Drawing",
        rows: [
            { keys: "Enter, Esc, double click", does: "end the stroke" },
            { keys: "Click on its first point", does: "close it" },
            { keys: "Backspace, Ctrl+Z", does: "take back the last point" },
            {
                keys: "Drag with the pen",
                does: "a tangent; Shift keeps to 15 degrees, Alt breaks it, Space moves its point",
            },
            { keys: "Shift+click", does: "a point at a multiple of 15 degrees from the last" },
            {
                keys: "Arrows, Enter",
                does: "move the cross hair by 0.1, with Shift by 1, with Ctrl+Shift by 10 units, place a point",
            },
            { keys: "Ctrl+Enter, Esc", does: "end the stroke of such points" },
            { keys: "Ctrl", does: "do not snap to symmetry elements, points or the grid" },
        ],
    },
    {
        title: "Editing",
        rows: [
            { keys: "Shift+click", does: "select more" },
            { keys: "Double click", does: "put a point onto a stroke; make a point smooth, or a corner" },
            { keys: "Alt+drag", does: "pull handles out of a point; move one handle alone" },
            { keys: "Shift+drag", does: "along an axis" },
            { keys: "Arrows", does: "move by 0.1, with Shift by 1, with Ctrl+Shift by 10 units" },
            { keys: "Tab, Shift+Tab", does: "the next point, the one before" },
            {
                keys: "J",
                does: "join two selected ends, or the nearest of two selected strokes, by a line where they are apart; close the one selected",
            },
            { keys: "Drag an end onto another", does: "join them; a point onto the next one takes it out" },
            { keys: "Delete, Shift+Delete", does: "take out: the curve heals; or is cut there" },
            { keys: "Ctrl+A, Ctrl+D", does: "select all, double" },
            { keys: "Ctrl+C, Ctrl+X, Ctrl+V", does: "copy, cut, paste strokes, as SVG" },
        ],
    },
    {
        title: "Window",
        rows: [
            { keys: "Wheel, + and -", does: "zoom" },
            { keys: "Space or middle button, drag", does: "move the window" },
            { keys: "Ctrl+0, Shift+1, Shift+2", does: "fit the cell, all strokes, the selection" },
            { keys: "E, G, K", does: "show symmetry elements, the grid, copies of the strokes" },
            { keys: "3", does: "show the solid; the drawing again" },
            { keys: "Drag the solid, arrows", does: "turn it; with Shift, or by two fingers, move it" },
        ],
    },
    {
        title: "File",
        rows: [
            { keys: "Ctrl+S, Ctrl+Shift+S", does: "save, download the design's file" },
            { keys: "Ctrl+E", does: "export" },
            { keys: "Ctrl+Z, Ctrl+Shift+Z, Ctrl+Y", does: "undo, redo" },
            { keys: "?", does: "this list" },
        ],
    },
];

/** @type {Record<string, [number, number]>} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** Whether keys belong to what has the focus: a field in which one types. @param {EventTarget | null} target */
function types(target) {
    return target instanceof HTMLElement && (target.isContentEditable || target.matches("input, select, textarea"));
}

/**
 * Listen to keys.
 * @param {Hands} hands
 * @param {Toolbox} toolbox
 * @param {HTMLCanvasElement} canvas
 * @param {(command: string) => void} run
 */
export function listen(hands, toolbox, canvas, run) {
    const { store } = hands;

    /** @param {string} key */
    const withCtrl = (key, /** @type {KeyboardEvent} */ event) => {
        const commands = {
            z: event.shiftKey ? "redo" : "undo",
            y: "redo",
            s: event.shiftKey ? "save-as" : "save",
            e: "export",
            0: "fit",
            a: "select-all",
            d: "double",
        };
        const command = /** @type {Record<string, string>} */ (commands)[key];
        const edited =
            event.target instanceof HTMLInputElement
                ? event.target.value !== event.target.defaultValue
                : types(event.target);
        if (!command || (types(event.target) && !"se".includes(key) && !("zy".includes(key) && !edited))) {
            return false;
        }
        run(command);
        return true;
    };

    /** @param {KeyboardEvent} event */
    const onCanvas = (event) => {
        const arrow = ARROWS[event.key];
        const by = 0.1 * (event.shiftKey ? (event.ctrlKey ? 100 : 10) : 1);
        const { selection } = store.state;
        if (arrow && toolbox.tool.nudge) {
            toolbox.tool.nudge([arrow[0] * by, arrow[1] * by], hands);
            return true;
        }
        if (arrow && (selection.strokes.length || selection.nodes.length) && store.state.tool === "select") {
            const name = `nudge ${JSON.stringify(selection)}`;
            store.edit((design) => moved(design, selection, [arrow[0] * by, arrow[1] * by]), { merge: name });
            return true;
        }
        if (arrow && toolbox.tool.draws) {
            toolbox.moveCross(arrow[0] * by, arrow[1] * by);
            return true;
        }
        if (arrow) {
            hands.camera.pan(-arrow[0] * 40, arrow[1] * 40);
            hands.redraw();
            return true;
        }
        const ends = event.ctrlKey || event.metaKey;
        if (toolbox.tool.draws && (event.key === " " || (event.key === "Enter" && !ends)) && toolbox.cross) {
            toolbox.placeAtCross();
            return true;
        }
        if (event.key === "Tab" && store.state.tool === "select" && selection.strokes.length) {
            const nodes = shownNodes(hands);
            const now = nodes.findIndex((node) => selection.nodes.some((ref) => isSameNode(ref, nodeRef(node))));
            const next = now + (event.shiftKey ? -1 : 1);
            if (next < 0 || next >= nodes.length) {
                return false;
            }
            store.set({
                selection: {
                    strokes: selection.strokes,
                    nodes: [nodeRef(nodes[next])],
                },
            });
            return true;
        }
        return false;
    };

    /** @param {KeyboardEvent} event */
    const plain = (event) => {
        const moves =
            store.state.trace.moves &&
            event.target instanceof HTMLElement &&
            event.target.id === "move-picture" &&
            ARROWS[event.key];
        if ((event.target === canvas || moves) && onCanvas(event)) {
            return true;
        }
        if (event.key === "Escape") {
            const said = store.state.trouble?.quiet ?? false;
            if (said) {
                store.set({ trouble: null });
            }
            return toolbox.tool.cancel?.(hands) || said;
        }
        if (toolbox.tool.key_down?.(event.key, event, hands)) {
            return true;
        }
        const { selection } = store.state;
        if (
            (event.key === "Delete" || event.key === "Backspace") &&
            (selection.strokes.length || selection.nodes.length)
        ) {
            store.edit((design) => without(design, selection, event.shiftKey), {
                selection: selection.nodes.length ? { strokes: selection.strokes, nodes: [] } : NOTHING,
            });
            return true;
        }
        if (event.shiftKey && (event.code === "Digit1" || event.code === "Digit2")) {
            run(event.code === "Digit1" ? "fit-all" : "fit-selection");
            return true;
        }
        const command = /** @type {Record<string, string>} */ ({
            "?": "help",
            "+": "zoom-in",
            "=": "zoom-in",
            "-": "zoom-out",
            ...COMMAND_LETTERS,
        })[event.key];
        if (command) {
            run(command);
            return true;
        }
        const { letters } = store.state;
        const tool = TOOLS.find((one) => letterOf(one, letters) === event.key.toLowerCase() || one.other === event.key);
        if (tool && !event.shiftKey) {
            hands.take(tool.name);
            canvas.focus({ preventScroll: true });
            return true;
        }
        return false;
    };

    document.addEventListener("keydown", (event) => {
        if (document.querySelector("dialog[open]") || event.isComposing) {
            return;
        }
        if (event.key === " " && event.target === canvas && !toolbox.cross) {
            toolbox.borrow(true);
            event.preventDefault();
            return;
        }
        const ctrl = event.ctrlKey || event.metaKey;
        const done =
            ctrl && !ARROWS[event.key] && event.key !== "Enter"
                ? withCtrl(event.key.toLowerCase(), event)
                : !types(event.target) && plain(event);
        if (done) {
            event.preventDefault();
        }
    });
    document.addEventListener("keyup", (event) => {
        if (event.key === " ") {
            toolbox.borrow(false);
        }
    });
    window.addEventListener("blur", () => toolbox.borrow(false));
}
