// @ts-check
// Where the window looks: from the drawing's coordinates, y up, to pixels of the page, y down.

/** @typedef {[number, number]} Point */

const SCALE_MIN = 1e-3;
const SCALE_MAX = 1e6;

export class Camera {
    /** @type {Point} the point in the window's middle */
    centre = [0, 0];
    /** pixels a unit */
    scale = 8;
    /** @type {Point} pixels of the page */
    size = [1, 1];
    /** pixels of the screen for one of the page */
    ratio = 1;

    /** @param {Point} at @returns {Point} */
    toScreen([x, y]) {
        return [
            this.size[0] / 2 + (x - this.centre[0]) * this.scale,
            this.size[1] / 2 - (y - this.centre[1]) * this.scale,
        ];
    }

    /** @param {Point} at @returns {Point} */
    toDrawing([x, y]) {
        return [
            this.centre[0] + (x - this.size[0] / 2) / this.scale,
            this.centre[1] - (y - this.size[1] / 2) / this.scale,
        ];
    }

    /** The window in the drawing, [x0, y0, x1, y1]. @returns {[number, number, number, number]} */
    get box() {
        const [x, y] = [this.size[0] / 2 / this.scale, this.size[1] / 2 / this.scale];
        return [this.centre[0] - x, this.centre[1] - y, this.centre[0] + x, this.centre[1] + y];
    }

    /** Zoom so that what is at a point of the page stays there. @param {Point} at @param {number} factor */
    zoomAt(at, factor) {
        const before = this.toDrawing(at);
        this.scale = Math.min(SCALE_MAX, Math.max(SCALE_MIN, this.scale * factor));
        const after = this.toDrawing(at);
        this.centre = [this.centre[0] + before[0] - after[0], this.centre[1] + before[1] - after[1]];
    }

    /** Move the drawing by pixels of the page. @param {number} dx @param {number} dy */
    pan(dx, dy) {
        this.centre = [this.centre[0] - dx / this.scale, this.centre[1] + dy / this.scale];
    }

    /**
     * Show a box of the drawing, as large as it fits.
     * @param {readonly number[]} box [x0, y0, x1, y1]
     * @param {number} [share] of the window that it fills
     */
    fit([x0, y0, x1, y1], share = 0.72) {
        const [width, height] = [Math.max(x1 - x0, 1e-9), Math.max(y1 - y0, 1e-9)];
        this.centre = [(x0 + x1) / 2, (y0 + y1) / 2];
        this.scale = Math.min(SCALE_MAX, share * Math.min(this.size[0] / width, this.size[1] / height));
    }

    /** Make a canvas context draw in the drawing's coordinates. @param {CanvasRenderingContext2D} context */
    apply(context) {
        const k = this.scale * this.ratio;
        const [x, y] = [this.size[0] / 2, this.size[1] / 2];
        context.setTransform(k, 0, 0, -k, x * this.ratio - this.centre[0] * k, y * this.ratio + this.centre[1] * k);
    }
}
