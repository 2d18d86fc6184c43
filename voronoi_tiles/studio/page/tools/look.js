// @ts-check
// The tools that move the window: hand and zoom.

/** @import { Tool } from "./tool.js" */

/** @type {[number, number] | null} */
let last = null;

/** @type {Tool} */
export const hand = {
    name: "hand",
    key: "h",
    title: "Move the window",
    icon: "hand",
    cursor: "grab",
    help: "Drag the drawing. With any tool: hold Space, or drag with the middle button.",
    down(touch) {
        last = touch.screen;
    },
    move(touch, hands, held) {
        if (held && last) {
            hands.camera.pan(touch.screen[0] - last[0], touch.screen[1] - last[1]);
            last = touch.screen;
            hands.redraw();
        }
    },
    up() {
        last = null;
    },
};

/** @type {Tool} */
export const zoom = {
    name: "zoom",
    key: "z",
    title: "Zoom",
    icon: "zoom",
    cursor: "zoom-in",
    help: "Click to come nearer, with Alt to go away. With any tool: the wheel.",
    down(touch, hands) {
        hands.camera.zoomAt(touch.screen, touch.alt ? 1 / 1.6 : 1.6);
        hands.redraw();
    },
};
