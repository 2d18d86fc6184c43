// @ts-check
// What a tool is, and what it is given to work with.

/** @import { Store } from "../store.js" */
/** @import { Entry } from "../scene.js" */
/**
 * @typedef {[number, number]} Point
 * @typedef {object} Touch a pointer's place, or the keyboard's cross hair
 * @property {Point} at in the drawing, snapped
 * @property {Point} raw in the drawing, as it is
 * @property {import("../model/snapping.js").Snapped | null} snapped what drew it there
 * @property {Point} screen in pixels of the page
 * @property {boolean} shift
 * @property {boolean} alt
 * @property {boolean} ctrl
 * @property {boolean} space whether Space is held, which moves what is being placed
 * @property {boolean} touch whether a finger, which hits less exactly
 * @property {number} reach how far away something is still hit; units
 * @property {Point[]} trail where the pointer has been since the last event, raw, the newest last
 * @typedef {object} Hands what tools work on
 * @property {Store} store
 * @property {() => Entry[]} entries the strokes as they are drawn
 * @property {import("../view/camera.js").Camera} camera
 * @property {() => {motions: import("../model/symmetry.js").Motion[], lattice: import("../model/lattice.js").Lattice}} symmetry
 * @property {() => void} redraw
 * @property {(tool: string) => void} take take a tool, and see the drawing
 * @property {(text: string) => void} hint say what the tool waits for
 * @typedef {object} Tool
 * @property {string} name
 * @property {string} key the letter that takes it, until the user gives it another
 * @property {string} [other] another key that does
 * @property {string} title
 * @property {string} icon
 * @property {string} cursor
 * @property {string} help what it waits for
 * @property {boolean} [draws] whether it places points, so that arrow keys move a cross hair
 * @property {(touch: Touch, hands: Hands) => void} [down]
 * @property {(touch: Touch, hands: Hands, held: boolean) => void} [move] also with no button held
 * @property {(touch: Touch, hands: Hands) => void} [up]
 * @property {(touch: Touch, hands: Hands) => void} [twice] a double click
 * @property {(at: Point, reach: number, hands: Hands) => import("../model/snapping.js").Snapped | null} [joins] the node that what is
 *   held would be joined to: the pointer is drawn to that before all else
 * @property {(by: Point, hands: Hands) => void} [nudge] arrow keys move what it has
 * @property {(key: string, event: KeyboardEvent, hands: Hands) => boolean} [key_down] whether the key was for it
 * @property {(hands: Hands) => boolean} [undo] take back its own last step; whether there was one
 * @property {(hands: Hands) => boolean} [redo] take it again; likewise
 * @property {(hands: Hands) => void} [leave] it is laid down: end what was begun
 * @property {(hands: Hands) => boolean} [cancel] Escape; whether there was something to end
 * @property {(context: CanvasRenderingContext2D, hands: Hands) => void} [draw] in pixels of the page
 */

export {};
